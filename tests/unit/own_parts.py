"""Parts as a user's own module defines them."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import rockframe as rf
from rockframe import extension as ext
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


SHARES = {"pads": 1.0, 2: "which numba has no type for"}


@ext.on_pads
class TabulatedLaw(NamedTuple):
    """Pads whose law reads a dictionary of mixed keys, which cannot be compiled."""

    pads: ext.Pads

    @ext.inlined
    def now(self, own):
        return self.pads

    @ext.inlined
    def force(self, contact, line, own):
        found = self.pads.force(contact, line, own)
        return ext.BaseForce(SHARES["pads"] * found.upward, found.moment, found.dissipated)


@dataclass(frozen=True)
class TabulatedSupport(ext.PadSupport):
    model = "tabulated pads"

    def law(self, body, mass, load_mass):
        elastic = super().law(body, mass, load_mass)
        return replace(elastic, law=TabulatedLaw(elastic.law))


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
