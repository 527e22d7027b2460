"""Ground motions: records, analytic pulses and their processing."""

from rockframe.motion.ground_motion import GroundMotion
from rockframe.motion.pair import HorizontalPair
from rockframe.motion.readers import formats, register, unregister

__all__ = ["GroundMotion", "HorizontalPair", "formats", "register", "unregister"]


def __dir__() -> list[str]:
    return [*__all__]
