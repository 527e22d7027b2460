"""Ground motions: records, analytic pulses and their processing."""

from rockframe.motion.ground_motion import GroundMotion
from rockframe.motion.operations.pulses import VelocityPulse
from rockframe.motion.pair import HorizontalPair
from rockframe.records import formats, register, unregister

__all__ = [
    "GroundMotion",
    "HorizontalPair",
    "VelocityPulse",
    "formats",
    "register",
    "unregister",
]


def __dir__() -> list[str]:
    return [*__all__]
