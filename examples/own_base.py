"""Pads that yield: a base of one's own, in one file.

Usage: python examples/own_base.py [--folder results]

Each pad is a bilinear spring beside a dashpot: where its force reaches a strength it yields, and
keeps a plastic set. Prints what becomes of a block on such pads, alone and on a cap on soil, and
what simpler bases would have told; writes own_base.nc.
"""

import argparse
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

import rockframe as rf
from rockframe import extension as ext

INSTANT = 1e-6  # times the time of a vibration
YIELDING = 1  # state of a pad


class Sets(NamedTuple):
    """Plastic sets of the pads: variables of first order."""

    left: float
    right: float


@ext.on_pads
class YieldingLaw(NamedTuple):
    """Two pads with bilinear springs, per unit mass; all else is as of elastic pads."""

    pads: ext.Pads  # at the start
    strength: float  # force at which a pad yields at first
    hardening: float  # stiffness of a yielding pad over its elastic stiffness

    @ext.kernel
    def states(self):
        return 2  # elastic, yielding

    @ext.kernel
    def variables(self):
        return 2

    @ext.inlined
    def read(self, state, first):
        return Sets(state[first], state[first + 1])

    @ext.inlined
    def now(self, own):
        return ext.sunk_pads(self.pads, own.left, own.right)

    @ext.inlined
    def set_rate(self, contact, left, line):
        """Give the rate at which the set of a yielding pad follows its corner."""
        speed = line.left_speed if left else line.right_speed
        yields = self.state_of_end(contact, left) == YIELDING
        return -(1.0 - self.hardening) * speed if yields else 0.0

    @ext.inlined
    def flow(self, contact, line, own):
        return self.set_rate(contact, True, line), self.set_rate(contact, False, line)

    @ext.inlined
    def force(self, contact, line, own):
        """Give the force of the pads as they are; yielding dissipates, too."""
        found = self.now(own).force(contact % ext.CONTACTS, line, ())
        left = self.level(True, line, own) * self.set_rate(contact, True, line)
        right = self.level(False, line, own) * self.set_rate(contact, False, line)
        dissipated = found.dissipated + self.pads.stiffness * (left + right)
        return ext.BaseForce(found.upward, found.moment, dissipated)

    @ext.kernel
    def yielding_set(self, left, line, own):
        """Give the set with which a pad's force would be on the hardening branch."""
        pressed = self.level(left, line, own) + (own.left if left else own.right)
        return (1.0 - self.hardening) * (pressed - self.strength / self.pads.stiffness)

    @ext.inlined
    def end_guard(self, contact, left, line, acceleration, own):
        """Guard the set that is left until yielding, or the sinking that goes on."""
        speed = line.left_speed if left else line.right_speed
        frequency = math.sqrt(2.0 * self.pads.stiffness)
        if self.state_of_end(contact, left) == YIELDING:
            scale = -frequency * self.pads.rest
            return speed / scale, acceleration / scale
        if not self.pads.touches(contact % ext.CONTACTS, left):
            return 1.0, 0.0
        sunk = own.left if left else own.right
        # where yielding has just ended the speed is rounding: the acceleration tells
        soon = (1.0 - self.hardening) * (speed + INSTANT / frequency * acceleration)
        left_over = sunk - self.yielding_set(left, line, own)
        return left_over / self.pads.rest, soon / self.pads.rest

    @ext.kernel
    def variables_after(self, was, contact, line, own):
        """Put a set that has been integrated beside the hardening branch back on it."""
        left = max(own.left, self.yielding_set(True, line, own))
        return Sets(left, max(own.right, self.yielding_set(False, line, own)))

    @ext.kernel
    def observed(self, contact, line, own):
        left, right = self.now(own).observed(contact % ext.CONTACTS, line, ())
        return left, right, own.left, own.right


@dataclass(frozen=True)
class YieldingSupport(ext.PadSupport):
    """Yielding pads under a block: their numbers, equations and words; elastic at rest."""

    strength: float  # over the weight
    hardening: float
    model = "yielding pads"

    def law(self, body, mass, load_mass):
        elastic = super().law(body, mass, load_mass)
        strength = self.strength * self.load.weight / mass
        return replace(
            elastic,
            law=YieldingLaw(elastic.law, strength, self.hardening),
            columns=(*elastic.columns, ext.Column("left_set"), ext.Column("right_set")),
            end_tolerance=np.append(elastic.end_tolerance, elastic.law.noise()),
            variable_scales=np.full(2, elastic.settlement),
        )

    def start_faults(self, rotation, has_vertical_start):
        most = max(self.held_at(rotation).reactions.values())
        yields = has_vertical_start or most > self.strength * self.load.weight
        told = "InitialState: a run on YieldingPads starts in equilibrium, before any yields"
        return [told] if yields else []

    def words(self):
        set_grows = "the set z grows by (1 - r) u' on k (u - z) = strength + r k z/(1 - r)"
        return replace(
            super().words(),
            law="bilinear pad forces",
            equations=[("pad", "k (u - z) + c u', u the compression"), ("yielding", set_grows)],
            numbers=[("strength of one pad", f"{self.strength * self.load.weight:.6g} N"),
                     ("hardening r", f"{self.hardening:.6g}"), *super().words().numbers],
            left_out=["tension in the pads", "yielding of pads that are held, not moving"],
        )  # fmt: skip


class YieldingPads(ext.OwnBase):
    """Two equal pads with bilinear springs, one under each corner, that take no tension."""

    slot = "pads"
    frequency_ratio = ext.Ratio(ext.POSITIVE, doc="Vertical over rocking frequency, Eq. (8).")
    damping_ratio = ext.DampingRatio(doc="Vertical damping ratio, Eq. (7b).")
    strength = ext.Ratio(ext.POSITIVE, doc="Force at which a pad yields, over the weight.")
    hardening = ext.Ratio(ext.UNIT_INTERVAL, doc="Stiffness after yielding over that before.")

    def simpler(self):
        beta, xi = self.si.frequency_ratio, self.si.damping_ratio
        return (rf.TwoSpringSupport(frequency_ratio=beta, damping_ratio=xi),)

    def support(self, load):
        pads = ext.pads_under(*self.simpler(), load)
        numbers = pads.stiffness, pads.damping, pads.restitution
        return YieldingSupport(load, *numbers, self.si.strength, self.si.hardening)

    def misfits(self, parts):
        told = "YieldingPads yield under the weight alone; give a strength above 0.5, not "
        return [] if self.si.strength > 0.5 else [f"{told}{self.si.strength:.6g}"]


rf.register(YieldingPads, columns=[
    ext.Variable("left_set", ext.TIME, ext.Unit.METRE, "plastic set of the left pad"),
    ext.Variable("right_set", ext.TIME, ext.Unit.METRE, "plastic set of the right pad"),
])  # fmt: skip


def main() -> None:
    """Simulate a block on yielding pads, alone and on a cap on soil; compare."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", default=".", help="where the results are written")
    file = Path(parser.parse_args().folder) / "own_base.nc"
    block = rf.Block(width="1 m", height="4 m", mass="10 t")
    pads = YieldingPads(frequency_ratio=15, damping_ratio=0.05, strength=0.7, hardening=0.1)
    pulse = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")
    system = rf.System(block, pads)
    print(system.describe(), end="\n\n")
    system.simulate(pulse, free_vibration="3 s", outputs=["energy"]).to_netcdf(file)
    with xr.open_dataset(file) as response:
        print(response.attrs["verdict"])
        print(f"Set of the right pad: {1e3 * float(response.right_set[-1]):.2f} mm")
        print("Read back the same:", rf.System.from_dataset(response).parts.pads == pads)
    stack = rf.System(block, pads, rf.CushionCap(height="0.5 m", mass="4 t"),
                      rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2))  # fmt: skip
    print("On cap and soil:", stack.simulate(pulse, free_vibration="3 s").attrs["verdict"])
    print(rf.recommend(rf.tradeoff(system, pulse, free_vibration="3 s", repeats=1), 0.05))


if __name__ == "__main__":
    main()
