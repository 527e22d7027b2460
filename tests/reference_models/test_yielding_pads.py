"""Yielding pads, the example of a user's base, against a hand-written integration.

The monolith shares no code with the package, nor with the example. Histories of the rotation
must agree to 1e-7 of the overturning angle, plastic sets to 1e-7 of the settlement.
"""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from reference_models.monoliths import two_spring, yielding_pads
from user_examples import example

import rockframe as rf

AGREEMENT = 1e-7
TIGHT = {"rtol": 1e-10, "atol": 1e-12}  # gives the monoliths an error of about 1e-11
GRAVITY = 9.80665
STEP = 0.02
SMOOTH = np.ones(5) / 5.0


@pytest.fixture(scope="module", autouse=True)
def example_pads():
    with example() as module:
        yield module.YieldingPads


@dataclass(frozen=True)
class Scene:
    """A block on yielding pads, and the motion of the ground."""

    radius: float = 2.0616
    slenderness: float = 4.0
    beta: float = 15.0
    xi: float = 0.05
    strength: float = 0.7
    hardening: float = 0.1
    rule: str = "centre"
    pulse: tuple[float, float] | None = None  # amplitude [m s^-2], frequency [Hz]
    rough: tuple[float, float, int] | None = None  # amplitudes across and upwards, seed
    duration: float = 3.0

    @property
    def block(self):
        return rf.Block.from_size(
            radius=f"{self.radius} m", slenderness=self.slenderness, mass="1 t"
        )

    @property
    def samples(self):
        across, upwards, seed = self.rough
        rng = np.random.default_rng(seed)
        both = [np.convolve(rng.normal(size=101), SMOOTH, "same") for _ in "xy"]
        return across * both[0], upwards * both[1]

    @property
    def motion(self):
        if self.pulse:
            amplitude, frequency = self.pulse
            return rf.GroundMotion.sine_pulse(f"{amplitude} m/s^2", f"{frequency} Hz")
        x, y = self.samples
        return rf.GroundMotion.from_arrays(
            (x, "m/s^2"), time_step=f"{STEP} s", vertical=(y, "m/s^2")
        )

    @property
    def drive(self):
        if not self.pulse:
            x, y = self.samples
            return {"time_step": STEP, "acceleration": x, "vertical": y}
        amplitude, frequency = self.pulse

        def acceleration(t):
            return amplitude * math.sin(2.0 * math.pi * frequency * t) if t <= end else 0.0

        end = 1.0 / frequency
        return {"acceleration": acceleration, "breakpoints": [0.0, end]}

    def monolith(self, times):
        block = self.block
        return yielding_pads.simulate(
            half_width=0.5 * block.width.m_as("m"), half_height=0.5 * block.height.m_as("m"),
            frequency_ratio=self.beta, damping_ratio=self.xi, strength=self.strength,
            hardening=self.hardening, restraint=self.rule, gravity=GRAVITY,
            duration=self.duration, sample_times=times, **TIGHT, **self.drive,
        )  # fmt: skip


SCENES = {
    "yielding without uplift": Scene(
        strength=0.55, hardening=0.3, pulse=(-1.0, 2.0), duration=2.0),
    "pulse": Scene(pulse=(-4.0, 1.0), duration=4.0),
    "pulse, contact-state": Scene(pulse=(-4.0, 1.0), duration=4.0, rule="contact-state"),
    "no dashpots": Scene(
        radius=3.0, slenderness=3.0, xi=0.0, strength=0.8, hardening=0.5, rough=(9.0, 0.0, 26)),
    "across": Scene(
        radius=3.0, slenderness=3.0, beta=10.0, xi=0.2, strength=0.6, hardening=0.5,
        rough=(8.0, 0.0, 43)),
    "with vertical motion, flight": Scene(
        radius=1.627, slenderness=3.515, beta=29.07, strength=0.812, hardening=0.7,
        rough=(9.9, 8.0, 7654)),
    "with vertical motion, contact-state": Scene(
        radius=1.591, slenderness=2.993, beta=8.28, xi=0.6, strength=0.742, hardening=0.3,
        rough=(5.4, 8.0, 78), rule="contact-state"),
    "overturning": Scene(
        radius=3.812, slenderness=5.388, beta=11.91, xi=0.02, strength=0.86, hardening=0.02,
        rough=(2.25, 8.0, 5559), rule="contact-state"),
}  # fmt: skip
HAPPENS = {
    "yielding without uplift": {"yield": 2, "unload": 2, "leave": 0},
    "pulse": {"yield": 2, "leave": 4, "clear": 4, "land": 4},
    "pulse, contact-state": {"yield": 2, "leave": 4, "relax": 2, "clear": 4, "land": 4},
    "no dashpots": {"yield": 4, "leave": 6, "land": 6},
    "across": {"yield": 3, "leave": 3, "clear": 3, "land": 3},
    "with vertical motion, flight": {"yield": 8, "leave": 8, "land": 8},
    "with vertical motion, contact-state": {"yield": 2, "engage": 2, "press": 1, "land": 3},
    "overturning": {"yield": 4, "leave": 2, "land": 2},
}
"""Least number of each scene's characteristic events; none means never."""


SECOND_LOOKS = ("pulse", "across", "with vertical motion, contact-state")


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.long] * (name in SECOND_LOOKS)) for name in SCENES],
)
def test_histories_and_sets(example_pads, name):
    scene = SCENES[name]
    pads = example_pads(
        frequency_ratio=scene.beta, damping_ratio=scene.xi, strength=scene.strength,
        hardening=scene.hardening,
    )  # fmt: skip
    system = rf.System(scene.block, pads, restraint=scene.rule)
    ours = system.simulate(
        scene.motion, duration=f"{scene.duration} s", output_step="0.01 s", accuracy="reference"
    )
    theirs = scene.monolith(ours.time.to_numpy())
    for kind, least in HAPPENS[name].items():
        assert theirs.count(kind) >= least
        assert least or not theirs.count(kind)
    assert bool(ours.overturned) == theirs.overturned == (name == "overturning")
    assert int(ours.impact_count) == theirs.count("land")
    held = ~np.isnan(theirs.rotation) & ~np.isnan(ours.rotation.to_numpy())
    assert held.sum() >= 0.99 * (~np.isnan(ours.rotation)).sum()
    settlement = float(system.equilibrium().pad_settlement)
    sway = np.abs(theirs.horizontal[held]).max()
    for history, other, size in (
        ("rotation", "rotation", float(ours.overturning_angle)),
        ("vertical_displacement", "vertical", settlement),
        ("horizontal_displacement", "horizontal", sway),
        ("left_set", "left_set", settlement),
        ("right_set", "right_set", settlement),
    ):
        difference = np.abs(ours[history].to_numpy() - getattr(theirs, other))[held].max()
        assert difference <= AGREEMENT * size, history
    assert max(theirs.left_set[held][-1], theirs.right_set[held][-1]) > 1e-3 * settlement
    if name == "with vertical motion, flight":
        assert float(ours.flight_time) > 0.3


def test_a_landing_makes_pads_yield():
    """The scenes have corners that land, and yield before they separate again."""
    scene = SCENES["pulse"]
    events = scene.monolith(np.linspace(0.0, scene.duration, 11)).events
    last: dict[str, str] = {}
    count = 0
    for _, kind, corner in events:
        count += kind == "yield" and last.get(corner) == "land"
        if kind in ("land", "leave"):
            last[corner] = kind
    assert count >= 1


@pytest.mark.parametrize("rule", [pytest.param("centre", marks=pytest.mark.long), "contact-state"])
def test_monolith_with_strong_pads_matches_elastic_monolith(rule):
    """The monolith against the one of elastic pads."""
    scene = Scene(radius=3.0, slenderness=3.0, xi=0.05, rough=(9.0, 3.0, 26))
    times = np.linspace(0.0, scene.duration, 301)
    block = scene.block
    options = {
        "half_width": 0.5 * block.width.m_as("m"), "half_height": 0.5 * block.height.m_as("m"),
        "frequency_ratio": scene.beta, "damping_ratio": scene.xi, "restraint": rule,
        "gravity": GRAVITY, "duration": scene.duration, "sample_times": times, **scene.drive,
    }  # fmt: skip
    elastic = two_spring.simulate(shape_factor=3.0, **options)
    ours = yielding_pads.simulate(strength=1e9, hardening=0.1, **options)
    assert ours.count("land") == elastic.landing_count >= 1
    difference = np.nanmax(np.abs(ours.rotation - elastic.rotation))
    assert difference <= 1e-9 * math.atan(1.0 / 3.0)
    assert not ours.left_set.any()
