"""Parts as a user's own module defines them."""

import rockframe as rf
from rockframe.components import Component, Parameter, Ratio
from rockframe.units import FORCE, LENGTH, NOT_NEGATIVE, POSITIVE


class Stop(Component):
    """A stop that breaks."""

    noun = "stop"

    gap = Parameter(LENGTH, NOT_NEGATIVE, doc="Distance before it is touched.")
    strength = Parameter(FORCE, POSITIVE, doc="Force at which it breaks.")
    friction = Ratio(NOT_NEGATIVE, doc="Coefficient of friction.", default=0.3)


class BreakingPads(rf.TwoSpringSupport):
    """Pads that break."""

    strength = Parameter(FORCE, POSITIVE, doc="Force at which a pad breaks.")


class HeavyBlock(rf.Block):
    """A block of another name, with nothing of its own."""


class RoundedBlock(rf.Block):
    """A block with round corners, of which the parameter is called like a property of blocks."""

    radius = Parameter(LENGTH, POSITIVE, doc="Radius of the corners.")
