"""Ground motions: records, analytic pulses and their processing."""

from rockframe.motion.formats import formats as formats
from rockframe.motion.ground_motion import GroundMotion as GroundMotion
from rockframe.motion.samples import MotionSI as MotionSI
