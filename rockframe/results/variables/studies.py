"""Variables of studies: many runs that answer one question."""

from enum import IntEnum
from typing import Final

from rockframe.results.variables.variable import FLIP, SCALE, Variable, count, flag, number
from rockframe.units import Unit

CASE: Final = "case"
MOTION: Final = "motion"
MESSAGE: Final = "message"
"""Dimensions of sweeps, beside their axes."""
REPEATED: Final = "repeated"
VERDICT_CHANGED: Final = "verdict_changed"
"""What is told of each case of a screened sweep."""


class Outcome(IntEnum):
    """Verdict of a run among others."""

    STANDS = 0
    OVERTURNS = 1
    UNDECIDED = 2


CRITICAL_SCALE: Final = (
    Variable(
        "critical_scale",
        (),
        Unit.ONE,
        "least scale of the motion that was found to overturn the block, NaN if none",
    ),
    Variable(
        "followed_scale",
        (),
        Unit.ONE,
        "scale of the motion up to which no interval between runs shows signs of hidden flips",
    ),
    Variable(
        "largest_gap",
        (),
        Unit.ONE,
        "largest distance between neighbouring scales with a verdict: pairs of flips that are "
        "closer together may be missed",
    ),
    Variable(
        "uplift_scale",
        (),
        Unit.ONE,
        "scale of the motion up to which the block stays at rest, NaN if that needs runs",
    ),
    Variable("scale_below", FLIP, Unit.ONE, "greatest scale of the motion tried before the flip"),
    Variable("scale_above", FLIP, Unit.ONE, "least scale of the motion tried after the flip"),
    Variable(
        "overturns_above",
        FLIP,
        None,
        "whether the block overturns after the flip, and stands before it, or the other way round",
        dtype="bool",
    ),
    Variable("scale", SCALE, Unit.ONE, "factor of the ground motion"),
    flag("outcome", SCALE, "verdict of the run", Outcome),
)
"""Of a motion that is scaled until a block overturns."""

SWEEP: Final = (
    number(CASE, "number of the row in the table of cases"),
    Variable(MOTION, (MOTION,), None, "ground motion", dtype="str"),
    Variable(MESSAGE, (MESSAGE,), None, "what is said of cases, each text once", dtype="str"),
    Variable(
        REPEATED,
        (),
        None,
        "whether the case was run again by tolerance, its verdict at fixed steps being in doubt",
        dtype="bool",
    ),
    Variable(VERDICT_CHANGED, (), None, "whether the case then had another verdict", dtype="bool"),
    count("message_number", "place along message of what is said of the case"),
)
"""Of a sweep, beside the scalars of its runs."""
