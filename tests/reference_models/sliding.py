"""Random blocks that slide and rock, in the package and in the reference model."""

import math
from dataclasses import dataclass

import numpy as np
from reference_models.monoliths import slipping_block
from reference_models.monoliths.slide_rock import Block
from reference_models.monoliths.ties import Tie
from reference_models.monoliths.wall import Wall

import rockframe as rf
from rockframe.dynamics.events import EventKind

GRAVITY = 9.80665
STEP, SAMPLES, REST_OF_IT = 0.1, 26, 1.0
SKIPPED = ("OVERTURNING", "TOPPLED")


@dataclass(frozen=True)
class Scene:
    """A system, its motion, its initial rotation and its reference model."""

    system: rf.System
    motion: rf.GroundMotion
    rotation: float
    model: Block


def draw(rng):
    """Draw a scene."""
    width = rng.uniform(0.3, 2.0)
    height = width * math.exp(rng.uniform(math.log(0.5), math.log(6.0)))
    eccentricity = float(rng.choice([0.0, rng.uniform(-0.2, 0.2)])) * width
    rises = float(rng.choice([0.5, rng.uniform(0.3, 0.6)])) * height
    block = rf.Block(
        width=f"{width!r} m", height=f"{height!r} m", mass="1 t",
        centre_of_mass=(f"{rises!r} m", f"{eccentricity!r} m"),
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


def draw_on_base(rng):
    """Draw a scene on pads or on a bed."""
    width = rng.uniform(0.5, 4.0)
    height = width * math.exp(rng.uniform(math.log(1.5), math.log(6.0)))
    block = rf.Block(width=f"{width!r} m", height=f"{height!r} m", mass="1 t")
    slender = width / height
    static = float(rng.choice([rng.uniform(0.05, 1.0), slender * rng.uniform(0.6, 1.5)]))
    kinetic = static * float(rng.choice([1.0, rng.uniform(0.5, 1.0)]))
    friction = {"friction": static, "kinetic_friction": kinetic}
    damping = float(rng.choice([0.0, rng.uniform(0.02, 0.5)], p=[0.2, 0.8]))
    if rng.random() < 0.5:
        eps = {"restitution": float(rng.uniform(0.5, 1.0))} if rng.random() < 0.5 else {}
        base = rf.TwoSpringSupport(
            frequency_ratio=float(rng.uniform(8.0, 30.0)), damping_ratio=damping, **friction, **eps
        )
    else:
        base = rf.WinklerSoil(
            stiffness=f"{float(rng.uniform(0.5, 4.0))!r} MPa", damping_ratio=damping, **friction
        )
    slope = float(rng.choice([0.0, rng.uniform(-0.03, 0.03)], p=[0.8, 0.2]))
    rule = str(rng.choice(["contact-state", "leading-corner", "centre"]))
    size = float(rng.uniform(0.5, 2.5)) * min(slender, static, 1.0) * GRAVITY
    across = size * rng.normal(size=SAMPLES)
    upwards = rng.normal(size=SAMPLES) * float(rng.choice([0.0, 0.3 * size, 0.6 * GRAVITY]))
    across[0] = upwards[0] = across[-1] = upwards[-1] = 0.0
    rotation = float(rng.choice([0.0, 0.0, rng.uniform(-0.5, 0.5) * math.atan(slender)]))
    system = rf.System(block, base, restraint=rule, inclination=f"{slope!r} rad")
    vertical = {"vertical": (upwards, "m/s^2")} if upwards.any() else {}
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), f"{STEP} s", **vertical)
    return Scene(system, motion, rotation, model_on_base(system, motion))


def draw_ties(rng, block):
    """Draw one to three ties of a block of 1 t, and their reference models."""
    body, parts, models = block.si, [], []
    width, rises = body.width, body.centre_height
    for number in range(int(rng.integers(1, 4))):
        side, up = float(rng.choice([-1.0, 1.0])), 2.0 * rises * rng.uniform(0.05, 1.0)
        to_up = up * rng.uniform(-0.5, 1.0)
        stiffness = GRAVITY * width / rises**2 * 10.0 ** rng.uniform(0.0, 2.5)
        stretch, kind, rod = 0.1 * width * rng.uniform(0.1, 1.0), rng.integers(3), rng.random()
        on = (0.5 * side * width, up)
        to = (side * width * rng.uniform(0.6, 1.5), to_up)
        slack = preload = 0.0
        if rod > 0.25:
            slack, preload = stretch * float(rng.choice([1e-2, 0.3])), 0.0
            if rng.random() < 0.3:
                slack, preload = 0.0, float(rng.uniform(0.01, 0.1)) * GRAVITY
        strength = math.inf if kind == 0 else stiffness * stretch + 2.0 * preload
        damping = float(rng.choice([0.0, 0.02])) * math.sqrt(stiffness)
        rest = {
            "slack": f"{slack!r} m" if slack else None,
            "preload": f"{1e3 * preload!r} N" if preload else None,
            "strength": f"{1e3 * strength!r} N" if math.isfinite(strength) else None,
            "damping": f"{1e3 * damping!r} N s/m" if damping else None,
        }
        parts.append(
            rf.Restrainer(
                on=tuple(f"{float(one)!r} m" for one in on),
                to=tuple(f"{float(one)!r} m" for one in to),
                stiffness=f"{1e3 * stiffness!r} N/m",
                brittle=bool(kind == 2) or math.isinf(strength),
                compression=rod <= 0.25, name=f"tie {number}", **rest,
            )
        )  # fmt: skip
        eccentricity = body.eccentricity
        models.append(
            Tie(
                (on[0] - eccentricity, up - rises),
                (to[0] - eccentricity, to_up),
                stiffness,
                damping,
                slack,
                preload,
                strength,
                bool(kind == 2),
                rod <= 0.25,
            )
        )
    return parts, models


def draw_wall(rng, block):
    """Draw an elastic wall behind a block of 1 t, and its reference model."""
    body, side = block.si, float(rng.choice([-1.0, 1.0]))
    up = 2.0 * body.centre_height * rng.uniform(0.3, 1.0)
    stiffness = GRAVITY * body.width / body.centre_height**2 * 10.0 ** rng.uniform(0.5, 3.0)
    damping = float(rng.uniform(0.0, 0.3)) * math.sqrt(stiffness)
    gap = float(rng.uniform(1e-4, 0.05)) * body.width
    part = rf.RearWall(
        side="left" if side < 0.0 else "right", stiffness=f"{1e3 * stiffness!r} N/m",
        damping=f"{1e3 * damping!r} N s/m", gap=f"{gap!r} m", height=f"{float(up)!r} m",
    )  # fmt: skip
    point = (0.5 * side * body.width - body.eccentricity, up - body.centre_height)
    return [part], [Wall(point, (0.0, 0.0), stiffness, damping, gap, side=side)]


def draw_tied(rng, draw=draw, links=draw_ties):
    """Draw a scene on level ground with ties that do not tip the block."""
    scene = None
    while scene is None:
        scene = with_ties(draw(rng), rng, links)
    return scene


def draw_tied_on_base(rng):
    """Draw the same on pads or on a bed."""
    return draw_tied(rng, draw_on_base)


def draw_walled(rng):
    """Draw a scene on level ground with an elastic wall behind the block."""
    return draw_tied(rng, draw, draw_wall)


def draw_walled_on_base(rng):
    """Draw the same on pads or on a bed."""
    return draw_tied(rng, draw_on_base, draw_wall)


def with_ties(without_ties, rng, links=draw_ties):
    """Return a scene with added ties; None on a slope or if they tip the block."""
    if not without_ties.system.options.slope.level:
        return None
    block, *others = without_ties.system.parts.structural()
    parts, models = links(rng, block)
    try:
        system = rf.System(block, *others, *parts, restraint=without_ties.system.restraint)
        system.equilibrium()
    except rf.errors.AssemblyError:
        return None
    model = without_ties.model
    model.tied = models
    return Scene(system, without_ties.motion, without_ties.rotation, model)


def ground_of(system, motion):
    """Return gravity, times, and ground accelerations along and normal to the base."""
    end, slope = STEP * (SAMPLES - 1), system.options.slope
    times = np.append(STEP * np.arange(SAMPLES), [end + 1e-9, end + REST_OF_IT + 1.0])
    across = np.append(motion.si.horizontal.samples, [0.0, 0.0])
    upwards = np.zeros_like(across)
    if motion.si.vertical is not None:
        upwards[: len(motion.si.vertical.samples)] = motion.si.vertical.samples
    c, s = math.cos(slope.inclination), math.sin(slope.inclination)
    gravity = GRAVITY * c
    return gravity, times, c * across + s * upwards + GRAVITY * s, c * upwards - s * across


def model_on_base(system, motion):
    """Return the reference model of a scene on pads or on a bed, per unit mass."""
    gravity, times, along, normal = ground_of(system, motion)
    body, support = system.setting.body, system.setting.support
    mass = body.mass
    if system.parts.pads is not None:
        base = slipping_block.Pads(
            support.stiffness / mass, support.damping / mass, support.restitution.left
        )
        base.sunk = 0.5 * gravity / base.stiffness
        fast = math.sqrt(2.0 * base.stiffness)
    else:
        width = 2.0 * body.half_width
        base = slipping_block.Bed(support.stiffness / mass, support.damping / mass, width)
        base.sunk = gravity / (width * base.stiffness)
        fast = math.sqrt(width * base.stiffness)
    setting = system.setting
    return slipping_block.Block(
        body.half_width, body.centre_height, body.inertia / mass,
        setting.friction.static, setting.friction.kinetic, gravity,
        str(system.restraint), base, times, along, normal,
        tuple(system.setting.overturning_angles),
        longest=0.05 / fast,
    )  # fmt: skip


def model_of(system, motion):
    """Return the reference model of a scene."""
    gravity, times, along, normal = ground_of(system, motion)
    body = system.setting.body
    ground = system.parts.ground.si
    return Block(
        body.left, body.right, body.centre_height, body.inertia / body.mass, ground.friction,
        ground.kinetic_friction, gravity, times, along, normal,
        tuple(system.setting.overturning_angles),
    )  # fmt: skip


def compare(scene):
    """Run both; return the differences of the peaks of rotation and slip, and the events."""
    initial = rf.InitialState(rotation=f"{scene.rotation!r} rad") if scene.rotation else None
    run = scene.system.simulate(
        scene.motion, free_vibration=f"{REST_OF_IT} s", accuracy="reference", initial=initial,
    )  # fmt: skip
    duration = float(run.attrs["solver_end_time"])
    total = STEP * (SAMPLES - 1) + REST_OF_IT
    start = scene.rotation
    if isinstance(scene.model, slipping_block.Block):
        start = np.zeros(6)
        start[1], start[2] = run.vertical_displacement[0], run.rotation[0]
        start[0] = run.horizontal_displacement[0]
    reference = scene.model.simulate(start, total)
    ours = [
        (float(t), EventKind(int(k)).name)
        for t, k in zip(run.event_time.values, run.event_kind.values, strict=True)
        # the reference model unloads yielded ties at the start without an event
        if t > 0.0 or k != EventKind.RESTRAINER_UNLOADING
    ]
    theta = float(run.overturning_angle)
    peak = abs(float(run.peak_rotation) - reference["peak"]) / theta
    slip = abs(float(run.peak_slip) - reference["peak_slip"])
    return {
        "ours": ours,
        "theirs": reference["events"],
        "peak": peak,
        "slip": slip,
        "slips": float(run.peak_slip),
        "overturned": bool(run.overturned),
        "overturned there": reference.get("fell", reference.get("overturned")),
        "end": duration,
        "balance": float(run.energy_residual),
        "rotates": float(run.peak_rotation) / theta,
        "flies": float(run.flight_time) > 0.0,
    }
