"""Parts of a user's module."""

from dataclasses import dataclass
from typing import NamedTuple

import rockframe as rf
from rockframe import extension as ext
from rockframe.components import Component, Parameter, Ratio
from rockframe.units import FORCE, LENGTH, NOT_NEGATIVE, POSITIVE


class Stop(Component):
    """A stop that breaks."""

    noun = "stop"

    gap: Parameter = Parameter(LENGTH, NOT_NEGATIVE, doc="Distance before it is touched.")
    strength: Parameter = Parameter(FORCE, POSITIVE, doc="Force at which it breaks.")
    friction: Ratio[float] = Ratio(NOT_NEGATIVE, doc="Coefficient of friction.", default=0.3)


class BreakingPads(rf.TwoSpringSupport):
    """Pads that break."""

    strength: Parameter = Parameter(FORCE, POSITIVE, doc="Force at which a pad breaks.")


class HeavyBlock(rf.Block):
    """A block under another name, without additions."""


class RoundedBlock(rf.Block):
    """A block with round corners, whose parameter has the name of a property of blocks."""

    radius: Parameter = Parameter(LENGTH, POSITIVE, doc="Radius of the corners.")


SHARES = {"pads": 1.0, 2: "which numba has no type for"}


@ext.point_law
class TabulatedPad(NamedTuple):
    """An elastic pad whose law reads a dictionary of mixed keys, so that it cannot be compiled."""

    stiffness: float
    damping: float

    def spring(self, point, own):
        return SHARES["pads"] * self.stiffness * point.pressed

    def energy(self, point, own):
        return 0.5 * self.stiffness * point.pressed**2

    def force(self, state, point, own):
        return self.spring(point, own) + self.damping * point.speed

    def force_rate(self, state, point, own):
        return self.stiffness * point.speed + self.damping * point.acceleration

    def power(self, state, point, own):
        return self.damping * point.speed**2

    def return_rate(self):
        return self.stiffness / self.damping


@dataclass(frozen=True)
class TabulatedSupport(ext.PadSupport):
    model = "tabulated pads"

    def law(self, body, mass, load_mass):
        elastic = super().law(body, mass, load_mass)
        return ext.pads_over(TabulatedPad(self.stiffness / mass, self.damping / mass), elastic)


class TabulatedPads(ext.OwnBase):
    """Pads whose law cannot be compiled."""

    slot = "pads"
    frequency_ratio = ext.Ratio(ext.POSITIVE, doc="Vertical over rocking frequency.")
    damping_ratio = ext.DampingRatio(doc="Vertical damping ratio.")

    def simpler(self):
        beta, xi = self.si.frequency_ratio, self.si.damping_ratio
        return (rf.TwoSpringSupport(frequency_ratio=beta, damping_ratio=xi),)

    def support(self, load):
        pads = ext.pads_under(*self.simpler(), load)
        return TabulatedSupport(load, pads.stiffness, pads.damping, pads.restitution)
