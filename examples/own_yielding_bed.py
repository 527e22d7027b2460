"""Soil that yields: a user's own bed of springs, in one file.

Usage: python examples/own_yielding_bed.py [--folder results]

The soil is a bed of springs without tension, elastic up to its strength and plastic beyond, with a
residual settlement. Prints the moment of a rotated wall on it and that in closed form, and the
residual settlements after a ground motion; writes own_yielding_bed.nc.
"""

import argparse
import math
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import rockframe as rf
from rockframe import extension as ext

SPRINGS = 20
LOOK_AHEAD = 1e-6  # time ahead of the guards, over a period of vibration
YIELDING = 1  # state of a spring


@ext.point_law
class YieldingSpring(NamedTuple):
    """A spring that yields beside a dashpot, per unit length and mass, with a plastic set."""

    stiffness: float
    damping: float
    strength: float

    def variables(self):
        return 1

    def states(self):
        return 2  # elastic, yielding

    def sunk(self, own):
        return own[0]

    def rates(self, state, point, own):
        return (point.speed if state == YIELDING else 0.0,)

    def spring(self, point, own):
        return self.stiffness * (point.pressed - own[0])

    def energy(self, point, own):
        return 0.5 * self.spring(point, own) ** 2 / self.stiffness

    def force(self, state, point, own):
        return self.spring(point, own) + self.damping * point.speed

    def force_rate(self, state, point, own):
        elastic = 0.0 if state == YIELDING else self.stiffness * point.speed
        return elastic + self.damping * point.acceleration

    def power(self, state, point, own):
        """Return the power dissipated by dashpot and yielding."""
        by_yielding = self.spring(point, own) * point.speed if state == YIELDING else 0.0
        return self.damping * point.speed**2 + by_yielding

    def return_rate(self):
        return self.stiffness / self.damping if self.damping > 0.0 else 0.0

    def guard(self, state, point, own):
        """Guard the margin to yielding, or, while the spring yields, its rate of compression."""
        look_ahead = LOOK_AHEAD * math.sqrt(point.settlement)  # as long as g is near 1 to 10 m/s^2
        if state == YIELDING:
            scale = look_ahead / point.settlement
            return scale * point.speed, scale * point.acceleration
        # just after yielding ends the speed is rounding, and the acceleration decides
        predicted_rate = self.stiffness * (point.speed + look_ahead * point.acceleration)
        return 1.0 - self.spring(point, own) / self.strength, -predicted_rate / self.strength

    def settle(self, state, point, own):
        """Correct the integrated set, so that the force is the strength."""
        own[0] = max(own[0], point.pressed - self.strength / self.stiffness)

    def seen(self, state, point, own):
        return (own[0],)


@dataclass(frozen=True)
class YieldingSupport(ext.Support):
    """A yielding bed under a body; its statics follow from the law."""

    stiffness: float  # k0 [Pa]
    damping: float  # c0 [Pa s]
    strength: float  # q_u [N/m]
    settlement_name = "soil_settlement"

    @property
    def model(self):
        return "yielding bed"

    def law(self, body, mass, load_mass):
        spring = YieldingSpring(self.stiffness / mass, self.damping / mass, self.strength / mass)
        places = [(i + 0.5) / SPRINGS for i in range(SPRINGS)]
        lengths = [(body.left + body.right) / SPRINGS] * SPRINGS
        return ext.springs_under(
            body, spring, places, lengths, load=load_mass / mass,
            columns=(ext.Column("left_soil_set"), ext.Column("right_soil_set")),
            variable_scales=[self.load.weight / self.stiffness / sum(lengths)],
        )  # fmt: skip

    def words(self):
        return ext.BaseWords(
            law="springs that yield",
            equations=[("spring", "0 <= k0 (u - z) <= q_u, u the compression, z the set")],
            uplift=("uplift angle", f"{self.uplift_angle:.6g} rad"),
            numbers=[("springs", str(SPRINGS)), ("stiffness k0", f"{self.stiffness:.6g} Pa"),
                     ("strength q_u", f"{self.strength:.6g} N/m")],
            left_out=["horizontal springs"], body="body", end="end",
        )  # fmt: skip


class YieldingSoil(ext.OwnBase):
    """A bed of springs that yield, by three dimensionless numbers."""

    slot = "soil"
    settlement: ext.Ratio = ext.Ratio(
        ext.POSITIVE, doc="Elastic settlement under the weight over b."
    )
    load: ext.Ratio = ext.Ratio(
        ext.UNIT_INTERVAL, doc="Weight over the strength of the whole bed, n."
    )
    damping_ratio: ext.DampingRatio = ext.DampingRatio(doc="Of vertical vibration.")

    def support(self, load):
        half_width, weight = load.body.half_width, load.weight
        stiffness = weight / (2.0 * half_width**2 * self.si.settlement)
        critical = math.sqrt(2.0 * half_width * stiffness * load.body.mass) / half_width
        strength = 0.5 * weight / half_width / self.si.load
        return YieldingSupport(load, stiffness, self.si.damping_ratio * critical, strength)


rf.register(YieldingSoil, columns=[
    ext.Variable("left_soil_set", ext.TIME, ext.Unit.METRE, "residual settlement at the left"),
    ext.Variable("right_soil_set", ext.TIME, ext.Unit.METRE, "residual settlement at the right"),
])  # fmt: skip


def moment(n: float, phi: float) -> float:
    """Return M/(N_u b) of a strip at a rotation phi = k0 b alpha/q_u under n = N/N_u."""
    uplifts, yields = phi > n, phi > 1.0 - n
    if uplifts and (n <= 0.5 and phi <= 0.25 / n):
        return n * (1.0 - 2.0 / 3.0 * math.sqrt(n / phi))
    if not (uplifts or yields):
        return phi / 3.0
    if not uplifts or (n > 0.5 and phi <= 0.25 / (1.0 - n)):  # the same, with 1 - n in place of n
        return (1.0 - n) * (1.0 - 2.0 / 3.0 * math.sqrt((1.0 - n) / phi))
    return n * (1.0 - n) - 1.0 / (48.0 * phi**2)


def main() -> None:
    """Rotate a wall on yielding soil statically, and simulate its response to a pulse."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--folder", default=".", help="where the results are written")
    file = Path(parser.parse_args().folder) / "own_yielding_bed.nc"
    wall = rf.Block(width="2 m", height="6 m", mass="30 t")
    soil = YieldingSoil(settlement=0.005, load=0.3, damping_ratio=0.05)
    system = rf.System(wall, soil, rotation="small")
    n, weight, b = 0.3, 30e3 * 9.80665, 1.0
    print("k0 b a/q_u   M/(N_u b)   in closed form")
    for phi in (0.2, 0.5, 1.0, 4.0):
        rotation = phi * 0.005 / n  # alpha = phi q_u/(k0 b)
        held = system.setting.supports[0].held_at(rotation)
        print(f"{phi:10.1f}  {held.base_moment / (weight / n * b):10.5f}  {moment(n, phi):15.5f}")
    pulse = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")
    response = rf.System(wall, soil).simulate(pulse, free_vibration="3 s", outputs=["energy"])
    print(response.attrs["verdict"])
    for side in ("left", "right"):
        print(f"Set at the {side}: {1e3 * float(response[f'{side}_soil_set'][-1]):.2f} mm")
    print(f"Energies balance within {float(response.energy_residual):.1e}")
    response.to_netcdf(file)


if __name__ == "__main__":
    main()
