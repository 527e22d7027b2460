"""Random scenes for the property tests, in ranges that engineers use.

R0 0.5 to 20 m, H/B 1 to 8, beta 8 to 60, xi 0 to 0.5, every restraint rule, finite and
small rotation; sine pulses of 0.2 to 1.5 g and 0.5 to 4 Hz, with a vertical pulse of up to
half of that or without. Pads that cannot hold the block upright are left out.
"""

from dataclasses import dataclass, replace

import numpy as np
from hypothesis import strategies as st

import rockframe as rf

GRAVITY = 9.80665
RULES = ("contact-state", "leading-corner", "centre")


@dataclass(frozen=True)
class Scenario:
    """A scene and its shaking; `sign` mirrors both."""

    base: str  # "rigid" or a restraint rule
    radius: float
    slenderness: float
    beta: float
    xi: float
    rotation: str
    peak: float  # of the horizontal pulse over gravity
    frequency: float
    cycles: float
    vertical: float  # of the vertical pulse over the horizontal one
    start: float = 0.0  # initial rotation over the overturning angle
    rate: float = 0.0  # initial angular velocity over omega theta
    sign: float = 1.0
    mass: float = 5e4
    free: float = 2.0

    @property
    def mirrored(self):
        return replace(self, sign=-self.sign)

    @property
    def system(self):
        block = rf.Block.from_size(
            radius=f"{self.radius!r} m",
            slenderness=self.slenderness,
            mass=f"{self.mass!r} kg",
        )
        if self.base == "rigid":
            return rf.System(block, rotation=self.rotation)
        pads = rf.TwoSpringSupport(frequency_ratio=self.beta, damping_ratio=self.xi)
        return rf.System(block, pads, restraint=self.base, rotation=self.rotation)

    @property
    def motion(self):
        across = rf.GroundMotion.sine_pulse(
            f"{self.sign * self.peak * GRAVITY!r} m/s^2", f"{self.frequency!r} Hz", self.cycles
        )
        if self.vertical == 0.0:
            return across
        upwards = rf.GroundMotion.sine_pulse(
            f"{self.vertical * self.peak * GRAVITY!r} m/s^2", f"{self.frequency!r} Hz", self.cycles
        )
        return across.with_vertical(upwards)

    @property
    def initial(self):
        theta = np.arctan(1.0 / self.slenderness)
        omega = np.sqrt(0.75 * GRAVITY / self.radius)
        return rf.InitialState(
            rotation=f"{float(self.sign * self.start * theta)!r} rad",
            angular_velocity=f"{float(self.sign * self.rate * omega * theta)!r} rad/s",
        )

    def stands_upright(self):
        """Whether the pads hold the block: 2 k b^2 above m g h."""
        tangent = 1.0 / self.slenderness
        sine = tangent / np.hypot(1.0, tangent)
        return self.base == "rigid" or 0.75 * self.beta**2 * sine * tangent > 1.0

    def run(self, **options):
        given = {"free_vibration": f"{self.free!r} s", "initial": self.initial, **options}
        return self.system.simulate(self.motion, **given)


def _tidy(low, high):
    # decimal fractions: short in a report, and no subnormal curiosities
    return st.integers(round(1000 * low), round(1000 * high)).map(lambda n: n / 1000.0)


def scenarios(bases=("rigid", *RULES), starts=True):
    """Give random scenes on the bases named."""
    built = st.builds(
        Scenario,
        base=st.sampled_from(bases),
        radius=_tidy(0.5, 20.0),
        slenderness=_tidy(1.0, 8.0),
        beta=_tidy(8.0, 60.0),
        xi=st.just(0.0) | _tidy(0.0, 0.5),
        rotation=st.sampled_from(["finite", "small"]),
        peak=_tidy(0.2, 1.5),
        frequency=_tidy(0.5, 4.0),
        cycles=st.sampled_from([0.5, 1.0, 2.5]),
        vertical=st.just(0.0) | _tidy(-0.5, 0.5),
        start=st.just(0.0) | _tidy(-0.6, 0.6) if starts else st.just(0.0),
        rate=st.just(0.0) | _tidy(-0.6, 0.6) if starts else st.just(0.0),
    )
    return built.filter(Scenario.stands_upright)
