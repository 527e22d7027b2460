"""Random blocks that slide and rock, by the package and by the reference model."""

import math
from dataclasses import dataclass

import numpy as np
from reference_models.monoliths.slide_rock import Block

import rockframe as rf
from rockframe.dynamics.events import EventKind

GRAVITY = 9.80665
STEP, SAMPLES, REST_OF_IT = 0.1, 26, 1.0
SKIPPED = ("OVERTURNING", "TOPPLED")


@dataclass(frozen=True)
class Scene:
    """A system, its motion and its start; the reference model of the same."""

    system: rf.System
    motion: rf.GroundMotion
    rotation: float
    model: Block


def draw(rng):
    """Draw a scene."""
    width = rng.uniform(0.3, 2.0)
    height = width * math.exp(rng.uniform(math.log(0.5), math.log(6.0)))
    beside = float(rng.choice([0.0, rng.uniform(-0.2, 0.2)])) * width
    rises = float(rng.choice([0.5, rng.uniform(0.3, 0.6)])) * height
    block = rf.Block(
        width=f"{width!r} m", height=f"{height!r} m", mass="1 t",
        centre_of_mass=(f"{rises!r} m", f"{beside!r} m"),
    )  # fmt: skip
    slender = min(block.si.left, block.si.right) / rises
    static = float(rng.choice([rng.uniform(0.05, 1.2), slender * rng.uniform(0.7, 1.6)]))
    static = min(static, 1.2)
    kinetic = min(static * float(rng.choice([1.0, rng.uniform(0.5, 1.0)])), 0.9)
    slope = float(rng.choice([0.0, 0.0, 0.0, rng.uniform(-0.05, 0.05)]))
    slope = slope if abs(slope) < 0.5 * min(slender, static) else 0.0
    size = float(rng.uniform(0.5, 2.5)) * min(slender, static, 1.0) * GRAVITY
    across = size * rng.normal(size=SAMPLES)
    upwards = rng.normal(size=SAMPLES) * float(rng.choice([0.0, 0.3 * size, 0.6 * GRAVITY]))
    across[0] = upwards[0] = across[-1] = upwards[-1] = 0.0
    rotation = float(rng.choice([0.0, 0.0, rng.uniform(-0.5, 0.5) * math.atan(slender)]))
    ground = rf.RigidGround(friction=static, kinetic_friction=kinetic)
    system = rf.System(block, ground, inclination=f"{slope!r} rad")
    vertical = {"vertical": (upwards, "m/s^2")} if upwards.any() else {}
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), f"{STEP} s", **vertical)
    return Scene(system, motion, rotation, model_of(system, motion))


def model_of(system, motion):
    """The reference model of a scene."""
    slope, body = system.options.slope, system.setting.body
    end = STEP * (SAMPLES - 1)
    times = np.append(STEP * np.arange(SAMPLES), [end + 1e-9, end + REST_OF_IT + 1.0])
    across = np.append(motion.si.horizontal.samples, [0.0, 0.0])
    upwards = np.zeros_like(across)
    if motion.si.vertical is not None:
        upwards[: len(motion.si.vertical.samples)] = motion.si.vertical.samples
    i = slope.inclination
    c, s = math.cos(i), math.sin(i)
    ground = system.parts.ground.si
    return Block(
        body.left, body.right, body.centre_height, body.inertia / body.mass, ground.friction,
        ground.kinetic_friction, GRAVITY * c, times, c * across + s * upwards + GRAVITY * s,
        c * upwards - s * across, tuple(system.setting.overturning_angles),
    )  # fmt: skip


def compare(scene):
    """Run both: the difference of the peaks over theta and over the peak slip, and the events."""
    initial = rf.InitialState(rotation=f"{scene.rotation!r} rad") if scene.rotation else None
    run = scene.system.simulate(
        scene.motion, free_vibration=f"{REST_OF_IT} s", accuracy="reference", initial=initial,
    )  # fmt: skip
    duration = float(run.attrs["solver_end_time"])
    total = STEP * (SAMPLES - 1) + REST_OF_IT
    found = scene.model.simulate(scene.rotation, total)
    ours = [
        (float(t), EventKind(int(k)).name)
        for t, k in zip(run.event_time.values, run.event_kind.values, strict=True)
    ]
    theta = float(run.overturning_angle)
    peak = abs(float(run.peak_rotation) - found["peak"]) / theta
    slip = abs(float(run.peak_slip) - found["peak_slip"])
    return {
        "ours": ours,
        "theirs": found["events"],
        "peak": peak,
        "slip": slip,
        "slips": float(run.peak_slip),
        "overturned": bool(run.overturned),
        "overturned there": found["fell"],
        "end": duration,
        "balance": float(run.energy_residual),
        "rotates": float(run.peak_rotation) / theta,
        "flies": float(run.flight_time) > 0.0,
    }
