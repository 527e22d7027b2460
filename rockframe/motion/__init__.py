"""Ground motions: records, analytic pulses and their processing."""

from rockframe.motion.ground_motion import GroundMotion
from rockframe.motion.pair import HorizontalPair
from rockframe.motion.velocity_pulse import VelocityPulse
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
