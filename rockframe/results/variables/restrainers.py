"""Variables of restrainers: forces, elongations and states of each."""

from typing import Final

from rockframe.dynamics.events import LinkState
from rockframe.results.variables.variable import EVENT, Variable, count, flag
from rockframe.units import Unit

RESTRAINER: Final = ("restrainer",)
RESTRAINER_TIME: Final = ("restrainer", "time")

RESTRAINERS: Final = (
    Variable("restrainer", RESTRAINER, None, "name of the restrainer", dtype="str"),
    Variable(
        "restrainer_force",
        RESTRAINER_TIME,
        Unit.NEWTON,
        "force with which each restrainer pulls its points together",
    ),
    Variable(
        "restrainer_elongation",
        RESTRAINER_TIME,
        Unit.METRE,
        "elongation of each restrainer from where it was given",
    ),
    flag("restrainer_state", RESTRAINER_TIME, "state of each restrainer", LinkState),
    Variable(
        "peak_restrainer_force",
        RESTRAINER,
        Unit.NEWTON,
        "largest absolute force of each restrainer up to overturning",
    ),
    Variable(
        "event_restrainer",
        EVENT,
        Unit.ONE,
        "number of the restrainer that changed, 0 at events of bodies",
        dtype="int64",
    ),
    Variable(
        "static_restrainer_force", RESTRAINER, Unit.NEWTON, "force of each restrainer at rest"
    ),
    Variable(
        "static_restrainer_elongation",
        RESTRAINER,
        Unit.METRE,
        "elongation of each restrainer at rest from where it was given",
    ),
)
"""What a scene with restrainers has beside others."""

RESTRAINER_SCALARS: Final = (count("broken_restrainer_count", "number of restrainers that broke"),)

OF_EACH: Final = ("restrainer_force", "restrainer_elongation", "restrainer_state")
"""Histories of all restrainers, and the columns of each that they are made of."""
