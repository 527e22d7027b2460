"""Ground motions in numbers: integrals, durations, oscillators, transforms; SI arrays only."""

from rockframe.signals.motion import Motion as Motion
from rockframe.signals.motion import Signal as Signal
