"""Ground motions: records, analytic pulses and their processing."""

from rockframe.motion.ground_motion import GroundMotion as GroundMotion
from rockframe.motion.readers import formats as formats
from rockframe.motion.readers import register as register
from rockframe.motion.readers import unregister as unregister
from rockframe.motion.samples import MotionSI as MotionSI
