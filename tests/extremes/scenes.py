"""Scenes with extreme parameters, one pool per subject.

A scene is drawn from ranges used in practice, except for the parameter that its subject makes
extreme. Runs last for some swings of the block, but no longer than PERIODS of the fastest
motion, so that the hardest bases cost as much as the softest.
"""

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

import rockframe as rf
from rockframe.errors import ModelWarning

GRAVITY = 9.80665
RULES = ("contact-state", "leading-corner", "centre")
SEPARATIONS = ("displacement", "pressure")
ROTATIONS = ("finite", "small")
BASES = ("rigid", "pads", "soil", "coupled", "cascade")
PERIODS = 300
SAMPLES = 201


@dataclass(frozen=True)
class Scene:
    """A block, its base and its ground motion, in SI units or as ratios."""

    base: str = "pads"
    radius: float = 5.0
    slenderness: float = 4.0
    mass: float = 5e4
    frequency_ratio: float = 20.0
    damping_ratio: float = 0.1
    restitution: float | None = None
    soil_ratio: float = 15.0  # vertical frequency on the soil over that of rocking
    soil_damping: float = 0.15
    cap_share: float = 0.2  # of the block's mass
    restraint: str = "contact-state"
    separation: str = "displacement"
    rotation: str = "finite"
    signal: str = "noise"
    peak: float = 0.3  # of the horizontal acceleration over gravity
    vertical: float = 0.0  # of the vertical one
    time_step: float = 0.01
    start: float = 0.0  # initial rotation over the overturning angle
    continues: bool = False
    seed: int = 0

    @property
    def omega(self) -> float:
        """Frequency parameter of rocking [rad/s]."""
        return float(np.sqrt(0.75 * GRAVITY / self.radius))

    @property
    def system(self) -> rf.System:
        block = rf.Block.from_size(
            radius=f"{self.radius!r} m", slenderness=self.slenderness, mass=f"{self.mass!r} kg"
        )
        pads = rf.TwoSpringSupport(
            frequency_ratio=self.frequency_ratio,
            damping_ratio=self.damping_ratio,
            restitution=self.restitution,
        )
        breadth = 2.0 * self.radius / float(np.hypot(1.0, self.slenderness))
        cap_mass = self.cap_share * self.mass
        carried = self.mass + (cap_mass if self.base in ("coupled", "cascade") else 0.0)
        width = 1.1 * breadth if self.base in ("coupled", "cascade") else breadth
        soil = rf.WinklerSoil(
            stiffness=f"{carried * (self.soil_ratio * self.omega) ** 2 / width!r} Pa",
            damping_ratio=self.soil_damping,
            separation=self.separation,
        )
        cap = rf.CushionCap(
            width=f"{width!r} m", height=f"{0.1 * width!r} m", mass=f"{cap_mass!r} kg"
        )
        parts = {"rigid": (), "pads": (pads,), "soil": (soil,)}.get(self.base, (pads, cap, soil))
        options = {} if self.base == "rigid" else {"restraint": self.restraint}
        if self.base in ("coupled", "cascade"):
            options["coupling"] = self.base
        return rf.System(block, *parts, rotation=self.rotation, **options)

    @property
    def duration(self) -> float:
        """Length of the run [s]."""
        fastest = {
            "rigid": 1.0,
            "pads": self.frequency_ratio,
            "soil": self.soil_ratio,
        }.get(self.base, self.soil_ratio + 3.0 * self.frequency_ratio)
        periods = 2.0 * np.pi * PERIODS / (max(fastest, 1.0) * self.omega)
        return float(min(20.0 / self.omega, periods, SAMPLES * self.time_step * 2.0))

    @property
    def motion(self) -> rf.GroundMotion:
        rng = np.random.default_rng(self.seed)
        across, up = shake(self.signal, SAMPLES, rng)
        scale = GRAVITY * np.array([self.peak, self.vertical])
        return rf.GroundMotion.from_arrays(
            (across * scale[0], "m/s^2"),
            f"{self.time_step!r} s",
            vertical=(up * scale[1], "m/s^2"),
        )

    def run(self, accuracy: str):
        """Simulate; warnings about the validity of the model are no failure."""
        theta = float(np.arctan(1.0 / self.slenderness))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)
            return self.system.simulate(
                self.motion,
                duration=f"{self.duration!r} s",
                initial=rf.InitialState(rotation=f"{self.start * theta!r} rad"),
                overturning="continue" if self.continues else "stop",
                accuracy=accuracy,
                outputs=None,
                second_look=False,
            )


def shake(kind: str, count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Return the horizontal and the vertical shape of a ground motion, at most one in size."""
    time = np.linspace(0.0, 1.0, count)
    up = np.sin(2.0 * np.pi * 7.0 * time)
    if kind == "constant":
        return np.full(count, float(rng.choice([-1.0, 1.0]))), np.ones(count)
    if kind == "step":
        return np.where(time < 0.5, 1.0, -1.0) * float(rng.choice([-1.0, 1.0])), up
    if kind == "still":
        return np.zeros(count), up
    noise = np.convolve(rng.normal(size=count), np.ones(7) / 7.0, "same")
    return noise / np.abs(noise).max(), rng.uniform(-1.0, 1.0, size=count)


def usual(rng: np.random.Generator) -> Scene:
    """Draw a scene from ranges used in practice."""
    return Scene(
        base=str(rng.choice(BASES)),
        radius=float(10.0 ** rng.uniform(-0.3, 1.3)),
        slenderness=float(rng.uniform(1.5, 8.0)),
        frequency_ratio=float(rng.uniform(8.0, 60.0)),
        damping_ratio=float(rng.choice([0.0, 0.05, 0.2])),
        soil_ratio=float(rng.uniform(5.0, 30.0)),
        soil_damping=float(rng.choice([0.0, 0.1, 0.3])),
        cap_share=float(10.0 ** rng.uniform(-2.0, 0.3)),
        restraint=str(rng.choice(RULES)),
        separation=str(rng.choice(SEPARATIONS)),
        rotation=str(rng.choice(ROTATIONS)),
        peak=float(rng.uniform(0.2, 1.0)),
        vertical=float(rng.choice([0.0, 0.5])),
        start=float(rng.choice([0.0, 0.5, -0.7])),
        continues=bool(rng.integers(2)),
        seed=int(rng.integers(1000)),
    )


Extreme = Callable[[Scene, np.random.Generator], Scene]


def _log(low: float, high: float) -> Callable[[np.random.Generator], float]:
    return lambda rng: float(10.0 ** rng.uniform(np.log10(low), np.log10(high)))


def _with(**draws: Callable[[np.random.Generator], object]) -> Extreme:
    return lambda scene, rng: replace(scene, **{k: draw(rng) for k, draw in draws.items()})


def _fixed(value: object) -> Callable[[np.random.Generator], object]:
    return lambda rng: value


def _one_of(*values: object) -> Callable[[np.random.Generator], object]:
    return lambda rng: values[int(rng.integers(len(values)))]


SUBJECTS: dict[str, Extreme] = {
    "frequency ratio of the pads, 1.5 to 10 000": _with(
        base=_one_of("pads", "pads", "coupled"), frequency_ratio=_log(1.5, 1e4)
    ),
    "damping ratio of the pads, 0 to 5": _with(
        base=_one_of("pads", "coupled"), damping_ratio=_one_of(0.0, 1e-3, 0.4, 1.0, 2.5, 5.0)
    ),
    "slenderness, 0.75 to 50": _with(slenderness=_log(0.75, 50.0)),
    "size, 1 cm to 1 km": _with(radius=_log(1e-2, 1e3), time_step=_log(1e-3, 0.1)),
    "mass, 1 g to 1 000 000 t": _with(mass=_log(1e-3, 1e9)),
    "peak acceleration, 1e-6 g to 20 g": _with(peak=_log(1e-6, 20.0)),
    "time step, 0.1 ms to 0.1 s": _with(time_step=_log(1e-4, 0.1)),
    "soil stiffness over ten decades": _with(
        base=_one_of("soil", "coupled", "cascade"), soil_ratio=_log(0.1, 1e4)
    ),
    "constant acceleration": _with(signal=_fixed("constant"), peak=_log(0.01, 3.0)),
    "a step at the start": _with(signal=_fixed("step"), peak=_log(0.01, 3.0)),
    "release at 0.999999 of overturning": _with(
        signal=_fixed("still"), start=_one_of(0.999999, -0.999999)
    ),
    "contact that grazes": _with(
        base=_one_of("pads", "soil", "coupled"),
        signal=_fixed("constant"),
        # weightless up to rounding, or to a millionth
        vertical=_one_of(-1.0, -0.999999, -1.000001),
        peak=_one_of(0.0, 1e-6, 1e-3),
        start=_one_of(0.0, 1e-9, 1e-3),
    ),
    "landings at the same instant": _with(
        base=_one_of("pads", "soil", "coupled"),
        signal=_fixed("still"),
        vertical=_one_of(1.5, 3.0),
        start=_one_of(0.0, 1e-14, 1e-11, 1e-8),
        slenderness=_one_of(0.9, 2.0, 6.0),
    ),
    "vertical acceleration beyond gravity": _with(
        base=_one_of("pads", "soil", "coupled", "cascade"), vertical=_one_of(1.1, 2.0, 5.0)
    ),
    "repeated tiny bounces": _with(
        base=_one_of("rigid", "pads", "soil", "coupled"),
        peak=_one_of(0.0, 1e-3),
        restitution=_one_of(0.05, 0.3, 0.7),
        damping_ratio=_fixed(0.0),
        frequency_ratio=_log(100.0, 2000.0),
        start=_one_of(0.3, -0.8),
        vertical=_one_of(0.0, 1.2),
    ),
    "a slender block that falls flat and bounces": _with(
        base=_one_of("pads", "soil", "coupled"),
        slenderness=_log(8.0, 50.0),
        frequency_ratio=_log(10.0, 1000.0),
        soil_ratio=_log(10.0, 1000.0),
        time_step=_fixed(0.05),
        start=_one_of(0.999999, -0.9),
        continues=_fixed(True),
    ),
    "restraint and separation rules, finite and small": _with(
        base=_one_of("pads", "soil", "coupled"), vertical=_one_of(0.8, 1.5)
    ),
    "coupled and cascade": _with(
        base=_one_of("coupled", "cascade"), cap_share=_log(1e-3, 10.0), peak=_log(0.05, 5.0)
    ),
}


def scenes(subject: str, count: int) -> Iterator[Scene]:
    """Return the first scenes of a subject's infinite fixed list."""
    for number in range(count):
        rng = np.random.default_rng([list(SUBJECTS).index(subject), number])
        yield SUBJECTS[subject](usual(rng), rng)
