"""Random scenes for the property tests, in ranges used in practice.

R0 0.5 to 20 m, H/B 1 to 8, beta 8 to 60, xi 0 to 0.5, every restraint rule, finite and
small rotation; sine pulses of 0.2 to 1.5 g and 0.5 to 4 Hz, with a vertical pulse of up to
half of that or without. Pads that cannot hold the block upright are excluded.

On soil: a rocking stiffness of 1.3 to 100 times the least for stability, damping ratio
0 to 0.5, both rules of separation; caps of 1 to 1.6 times the block's width, 0 to 0.2 times
its height and 0.01 to 0.5 times its mass.
"""

from dataclasses import dataclass, replace

import numpy as np
from hypothesis import strategies as st

import rockframe as rf

GRAVITY = 9.80665
RULES = ("contact-state", "leading-corner", "centre")


@dataclass(frozen=True)
class Scenario:
    """A scene and its ground motion; `sign` mirrors both."""

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
        arguments = {"free_vibration": f"{self.free!r} s", "initial": self.initial, **options}
        return self.system.simulate(self.motion, **arguments)


CASE = Scenario(
    base="contact-state",
    radius=5.0,
    slenderness=4.0,
    beta=20.0,
    xi=0.1,
    rotation="finite",
    peak=0.5,
    frequency=1.0,
    cycles=1.0,
    vertical=0.3,
)
"""A scene on pads, to be changed in one respect."""


def _tidy(low, high):
    # decimal fractions: short in a report, never subnormal
    return st.integers(round(1000 * low), round(1000 * high)).map(lambda n: n / 1000.0)


def _ranges(starts):
    beginning = st.just(0.0) | _tidy(-0.6, 0.6) if starts else st.just(0.0)
    return {
        "radius": _tidy(0.5, 20.0),
        "slenderness": _tidy(1.0, 8.0),
        "beta": _tidy(8.0, 60.0),
        "xi": st.just(0.0) | _tidy(0.0, 0.5),
        "rotation": st.sampled_from(["finite", "small"]),
        "peak": _tidy(0.2, 1.5),
        "frequency": _tidy(0.5, 4.0),
        "cycles": st.sampled_from([0.5, 1.0, 2.5]),
        "vertical": st.just(0.0) | _tidy(-0.5, 0.5),
        "start": beginning,
        "rate": beginning,
    }


def scenarios(bases=("rigid", *RULES), starts=True):
    """Return random scenes on the named bases."""
    built = st.builds(
        Scenario,
        base=st.sampled_from(bases),
        **_ranges(starts),
    )
    return built.filter(Scenario.stands_upright)


# on soil ----------------------------------------------------------------------------------

SOIL_SCENES = ("soil", "cap and soil", "coupled", "cascade")
SEPARATIONS = ("displacement", "pressure")


@dataclass(frozen=True)
class SoilScenario(Scenario):
    """A scene on soil; `base` is the restraint rule, beta and xi are those of the pads."""

    scene: str = "soil"  # one of SOIL_SCENES
    firmness: float = 4.0  # (2/3) k0 b^3 over m g h of all bodies on the soil
    soil_xi: float = 0.1
    separation: str = "displacement"
    cap_width: float = 1.2  # over the block's
    cap_height: float = 0.05
    cap_mass: float = 0.2

    @property
    def block(self):
        return rf.Block.from_size(
            radius=f"{self.radius!r} m",
            slenderness=self.slenderness,
            mass=f"{self.mass!r} kg",
        )

    @property
    def cap(self):
        size = self.block.si
        return rf.CushionCap(
            width=f"{self.cap_width * size.width!r} m",
            height=f"{self.cap_height * size.height!r} m",
            mass=f"{self.cap_mass * self.mass!r} kg",
        )

    @property
    def soil(self):
        size, lifting = self.block.si, 0.5 * self.block.si.height * self.mass
        width = size.width
        if self.scene != "soil":
            width *= self.cap_width
            lifting += self.mass * self.cap_height * size.height * (1.0 + 0.5 * self.cap_mass)
        stiffness = 12.0 * self.firmness * lifting * GRAVITY / width**3
        return rf.WinklerSoil(
            stiffness=f"{stiffness!r} Pa",
            damping_ratio=self.soil_xi,
            separation=self.separation,
        )

    @property
    def system(self):
        parts = [self.block, self.soil]
        if self.scene != "soil":
            parts.append(self.cap)
        if self.scene in ("coupled", "cascade"):
            parts.append(rf.TwoSpringSupport(frequency_ratio=self.beta, damping_ratio=self.xi))
        options = {"coupling": self.scene} if self.scene in ("coupled", "cascade") else {}
        return rf.System(*parts, restraint=self.base, rotation=self.rotation, **options)

    def stands_upright(self):
        """Whether soil and pads in series hold the block, with a margin."""
        flexibility = 1.0 / self.firmness
        if self.scene in ("coupled", "cascade"):
            tangent = 1.0 / self.slenderness
            sine = tangent / np.hypot(1.0, tangent)
            flexibility += 1.0 / (0.75 * self.beta**2 * sine * tangent)
        return flexibility < 0.8


def soil_scenarios(scenes=SOIL_SCENES, separations=SEPARATIONS, starts=True):
    """Return random scenes on soil."""
    built = st.builds(
        SoilScenario,
        scene=st.sampled_from(scenes),
        base=st.sampled_from(RULES),
        **_ranges(starts),
        firmness=_tidy(1.3, 10.0) | _tidy(10.0, 100.0),
        soil_xi=st.just(0.0) | _tidy(0.0, 0.5),
        separation=st.sampled_from(separations),
        cap_width=st.just(1.0) | _tidy(1.0, 1.6),
        cap_height=st.just(0.0) | _tidy(0.0, 0.2),
        cap_mass=_tidy(0.01, 0.5),
    )
    return built.filter(SoilScenario.stands_upright)
