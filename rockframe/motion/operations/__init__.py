"""The processing steps of a ground motion; each returns a new one and says what it did."""

from typing import Final

from rockframe.motion.operations.combining import CombiningOperations
from rockframe.motion.operations.correcting import CorrectingOperations
from rockframe.motion.operations.scaling import ScalingOperations
from rockframe.motion.operations.timing import TimeOperations

OPERATIONS: Final = (
    "window",
    "scaled",
    "resampled",
    "filtered",
    "baseline_corrected",
    "with_vertical",
    "rotated",
)
"""Names of the steps, as recipes tell them."""


class MotionOperations(
    TimeOperations, ScalingOperations, CorrectingOperations, CombiningOperations
):
    """A motion that can be cut, scaled, resampled, filtered, corrected and combined."""

    __slots__ = ()
