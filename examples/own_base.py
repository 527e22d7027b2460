"""Pads that yield: a user's own base, in one file.

Usage: python examples/own_base.py [--folder results]

Each pad is a bilinear spring beside a dashpot: when its force reaches a strength it yields, with
a plastic set. Prints the response of a block on such pads, alone and on a cap on soil, and a
comparison with simpler bases; writes own_base.nc.
"""

import argparse
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import xarray as xr

import rockframe as rf
from rockframe import extension as ext

LOOK_AHEAD = 1e-6  # time ahead of the guards, over a period of vibration
YIELDING = 1  # state of a pad


@ext.point_law
class YieldingPad(NamedTuple):
    """A bilinear spring beside a dashpot, per unit mass; its variable is the plastic set."""

    stiffness: float
    damping: float
    strength: float  # force at which the pad yields at first
    hardening: float  # stiffness of the yielding pad over its elastic stiffness

    def variables(self):
        return 1

    def states(self):
        return 2  # elastic, yielding

    def sunk(self, own):
        return own[0]

    def rates(self, state, point, own):
        return ((1.0 - self.hardening) * point.speed if state == YIELDING else 0.0,)

    def spring(self, point, own):
        return self.stiffness * (point.pressed - own[0])

    def energy(self, point, own):
        return 0.5 * self.spring(point, own) ** 2 / self.stiffness

    def force(self, state, point, own):
        return self.spring(point, own) + self.damping * point.speed

    def force_rate(self, state, point, own):
        (set_rate,) = self.rates(state, point, own)
        return self.stiffness * (point.speed - set_rate) + self.damping * point.acceleration

    def power(self, state, point, own):
        """Return the power dissipated by dashpot and yielding."""
        (set_rate,) = self.rates(state, point, own)
        return self.damping * point.speed**2 + self.spring(point, own) * set_rate

    def return_rate(self):
        return self.stiffness / self.damping if self.damping > 0.0 else 0.0

    def yielding_set(self, point):
        """Return the set with which the force would be on the hardening branch."""
        return (1.0 - self.hardening) * (point.pressed - self.strength / self.stiffness)

    def guard(self, state, point, own):
        """Guard the margin to yielding, or, while the pad yields, its rate of compression."""
        look_ahead = LOOK_AHEAD / math.sqrt(2.0 * self.stiffness)
        if state == YIELDING:
            return look_ahead * point.speed / point.settlement, (
                look_ahead * point.acceleration / point.settlement
            )
        # just after yielding ends the speed is rounding, and the acceleration decides
        predicted_rate = (1.0 - self.hardening) * (point.speed + look_ahead * point.acceleration)
        margin = own[0] - self.yielding_set(point)
        return margin / point.settlement, -predicted_rate / point.settlement

    def settle(self, state, point, own):
        """Correct the integrated set, so that the force is on the hardening branch."""
        own[0] = max(own[0], self.yielding_set(point))

    def seen(self, state, point, own):
        return (own[0],)


@dataclass(frozen=True)
class YieldingSupport(ext.PadSupport):
    """Yielding pads under a block: their numbers, equations and words."""

    strength: float  # over the weight
    hardening: float

    @property
    def model(self):
        return "yielding pads"

    def law(self, body, mass, load_mass):
        elastic = super().law(body, mass, load_mass)
        strength = self.strength * self.load.weight / mass
        pad = YieldingPad(self.stiffness / mass, self.damping / mass, strength, self.hardening)
        columns = ext.Column("left_set"), ext.Column("right_set")
        scales = [elastic.settlement]
        return ext.pads_over(pad, elastic, columns=columns, variable_scales=scales)

    def start_faults(self, rotation, has_vertical_start):
        largest = max(self.held_at(rotation).reactions.values())
        yields = has_vertical_start or largest > self.strength * self.load.weight
        message = "InitialState: a run on YieldingPads starts in equilibrium, before any yields"
        return [message] if yields else []

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
    frequency_ratio: ext.Ratio = ext.Ratio(
        ext.POSITIVE, doc="Vertical over rocking frequency, Eq. (8)."
    )
    damping_ratio: ext.DampingRatio = ext.DampingRatio(doc="Vertical damping ratio, Eq. (7b).")
    strength: ext.Ratio = ext.Ratio(
        ext.POSITIVE, doc="Force at which a pad yields, over the weight."
    )
    hardening: ext.Ratio = ext.Ratio(
        ext.UNIT_INTERVAL, doc="Stiffness after yielding over that before."
    )

    def simpler(self):
        beta, xi = self.si.frequency_ratio, self.si.damping_ratio
        return (rf.TwoSpringSupport(frequency_ratio=beta, damping_ratio=xi),)

    def support(self, load):
        pads = ext.pads_under(*self.simpler(), load)
        numbers = pads.stiffness, pads.damping, pads.restitution
        return YieldingSupport(load, *numbers, self.si.strength, self.si.hardening)

    def misfits(self, parts):
        message = "YieldingPads yield under the weight alone; give a strength above 0.5, not "
        return [] if self.si.strength > 0.5 else [f"{message}{self.si.strength:.6g}"]


rf.register(YieldingPads, columns=[
    ext.Variable("left_set", ext.TIME, ext.Unit.METRE, "plastic set of the left pad"),
    ext.Variable("right_set", ext.TIME, ext.Unit.METRE, "plastic set of the right pad"),
])  # fmt: skip


def main() -> None:
    """Simulate a block on yielding pads, alone and on a cap on soil; compare."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
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
