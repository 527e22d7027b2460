"""Random scenes for the tables of certificates, each near the boundary of its verdict.

Scenes are drawn from ranges used in practice, with a ground motion: noise as a record, linear
between samples, or a sine as a record or as an analytic pulse. Its strength is relative to an edge:
a scale of the motion at which the verdict changes, found by increasing the scale and bisected.
"""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from extremes.scenes import GRAVITY, shake, usual

import rockframe as rf
from rockframe.errors import ModelWarning, RockframeError, RockframeWarning
from rockframe.simulation.plan import Plan, plan_run
from rockframe.simulation.run import compute_response

TIME_STEPS = (0.005, 0.01, 0.02)
FREE = 2.0
SAMPLES = 201
STEP_UP = 1.13
STRONGEST = 40.0
HALVINGS = 60
TIGHT = rf.Accuracy(rtol=1e-12)


@dataclass(frozen=True)
class Case:
    """A system, its motion at the edge of its verdict, and the duration."""

    number: int
    base: str
    system: rf.System
    motion: rf.GroundMotion
    duration: float

    def plan(self, scale: float = 1.0, accuracy="standard", motion=None) -> Plan:
        """Plan a run without histories."""
        motion = self.motion if motion is None else motion
        return plan_run(
            self.system.assembly,
            motion.scaled(scale),
            duration=f"{self.duration!r} s",
            free_vibration=None,
            initial=None,
            accuracy=accuracy,
            output_step=None,
            outputs=None,
            overturning="stop",
        )

    def summary(self, scale: float = 1.0, accuracy="standard", motion=None):
        """Run and return the summary."""
        return compute_response(self.system.assembly, self.plan(scale, accuracy, motion)).trajectory

    def certified(self, scale: float = 1.0, accuracy="standard", certify=True):
        """Run with a certificate."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RockframeWarning)
            return self.system.simulate(
                self.motion.scaled(scale),
                duration=f"{self.duration!r} s",
                accuracy=accuracy,
                outputs=None,
                certify=certify,
            )


def edge(case: Case, accuracy=TIGHT) -> float | None:
    """Find the first scale at which the verdict changes as the scale increases."""
    low = 0.02
    if case.summary(low, "standard").overturned is not False:
        return None
    high = low
    while True:
        high *= STEP_UP
        if high > STRONGEST:
            return None
        fell = case.summary(high, "standard").overturned
        if fell is None:
            return None
        if fell:
            break
        low = high
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        fell = case.summary(middle, accuracy).overturned
        if fell is None:
            return None
        low, high = (low, middle) if fell else (middle, high)
    return 0.5 * (low + high)


def draw(rng: np.random.Generator) -> tuple[str, rf.System, rf.GroundMotion, float] | None:
    """Draw a scene and its ground motion, before its strength is known."""
    scene = replace(usual(rng), start=0.0, continues=False)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)
            system = scene.system
    except RockframeError:
        return None
    step = float(rng.choice(TIME_STEPS))
    kind = str(rng.choice(["noise", "noise", "sine record", "pulse"]))
    frequency = float(scene.omega / 2.0 / np.pi * 10.0 ** rng.uniform(-0.3, 0.7))
    cycles = float(rng.choice([0.5, 1.0, 2.5]))
    vertical = float(rng.choice([0.0, 0.5]))
    if kind == "pulse":
        amplitude = f"{0.2 * GRAVITY!r} m/s^2"
        motion = rf.GroundMotion.sine_pulse(amplitude, f"{frequency!r} Hz", cycles)
    else:
        across, up = shake("noise", SAMPLES, rng)
        if kind == "sine record":
            across = np.sin(2.0 * np.pi * frequency * step * np.arange(SAMPLES))
        up = (vertical * 0.2 * GRAVITY * up, "m/s^2") if vertical else None
        motion = rf.GroundMotion.from_arrays(
            (0.2 * GRAVITY * across, "m/s^2"), f"{step!r} s", vertical=up
        )
    return scene.base, system, motion, min(motion.si.duration, 4.0) + FREE


def cases(count: int, seed: int = 0) -> Iterator[Case]:
    """Return the first cases of an infinite fixed list; scale 1 is an edge of each."""
    found, number = 0, 0
    while found < count:
        drawn = draw(np.random.default_rng([seed, number]))
        number += 1
        if drawn is None:
            continue
        case = Case(number - 1, *drawn)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RockframeWarning)
            scale = edge(case)
        if scale is None:
            continue
        found += 1
        yield replace(case, motion=case.motion.scaled(scale))
