"""What the processing steps share."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from rockframe.errors import ComponentError
from rockframe.motion.samples import Array, MotionSI
from rockframe.motion.value import MotionValue

if TYPE_CHECKING:
    from collections.abc import Callable

SAME_STEP: Final = 1e-9
"""Relative difference up to which two time steps are the same."""

_DROPPED: Final = "the analytic pieces between samples are replaced by straight lines"


class ProcessedMotion(MotionValue):
    """A motion that says what its processing loses."""

    __slots__ = ()

    def _drop_note(self) -> tuple[str, ...]:
        analytic = self.si.pieces is not None or self.si.vertical_pieces is not None
        return (_DROPPED,) if analytic else ()


def replaced(
    si: MotionSI,
    change: Callable[[Array, Array | None], Array],
    time_step: float | None = None,
) -> MotionSI:
    """Change the samples of all components alike; pieces between samples are dropped.

    Parameters
    ----------
    si : MotionSI
        The motion.
    change : callable
        New samples from old ones and their pieces.
    time_step : float, optional
        The new one; the old one unless given [s].

    Returns
    -------
    MotionSI
    """
    vertical = None if si.vertical is None else change(si.vertical, si.vertical_pieces)
    step = si.time_step if time_step is None else time_step
    return MotionSI(step, change(si.acceleration, si.pieces), vertical)


def other_motion(other: object, si: MotionSI, owner: str) -> MotionValue:
    """Check the motion that another one is to be combined with.

    Parameters
    ----------
    other : object
        What the user gave.
    si : MotionSI
        The motion itself.
    owner : str
        Class and method, for the message.

    Returns
    -------
    MotionValue

    Raises
    ------
    ComponentError
        Not a motion, or of another time step.
    """
    if not isinstance(other, MotionValue):
        msg = f"{owner}: other needs a GroundMotion, got {type(other).__name__}"
        raise ComponentError(msg)
    theirs = other.si
    if not math.isclose(theirs.time_step, si.time_step, rel_tol=SAME_STEP):
        msg = (
            f"{owner}: time steps differ, {si.time_step!r} s and {theirs.time_step!r} s; "
            f"resample one, for example other.resampled('{si.time_step!r} s')"
        )
        raise ComponentError(msg)
    return other
