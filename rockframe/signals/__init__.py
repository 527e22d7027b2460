"""Ground motions as SI arrays: integrals, durations, response of oscillators, transforms."""

from rockframe.signals.motion import Motion as Motion
from rockframe.signals.motion import Signal as Signal
