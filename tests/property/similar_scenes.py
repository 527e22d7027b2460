"""Random scenes of every kind with motion and arguments, for runs in another size."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
from benchmarks import random_parts, tied_runs
from extremes import scenes
from property.scenarios import GRAVITY, RULES
from reference_models import sliding

import rockframe as rf


def usual(base, rng):
    """Draw a block on a base, or on pads, cap and soil."""
    scene = replace(scenes.usual(rng), base=base)
    start = scene.start * math.atan(1.0 / scene.slenderness)
    arguments = {
        "duration": f"{scene.duration!r} s",
        "initial": rf.InitialState(rotation=f"{start!r} rad"),
        "overturning": "continue" if scene.continues else "stop",
    }
    return scene.system, scene.motion, arguments


def of_part(part, rng):
    """Draw walls, frames, tendons, stacks; some are on pads that are too soft."""
    while True:
        try:
            return *random_parts.draw_scene(part, rng), {}
        except rf.errors.AssemblyError:
            continue


def slides(draw, rng):
    """Draw a block that slides and rocks."""
    scene = draw(rng)
    start = rf.InitialState(rotation=f"{scene.rotation!r} rad")
    return scene.system, scene.motion, {"free_vibration": "1.0 s", "initial": start}


def tied(rng):
    """Draw one to three blocks with ties; some ties prevent a position of rest."""
    while True:
        try:
            system, motion, arguments = tied_runs.draw_scene(int(rng.integers(1_000_000)))
        except rf.errors.RockframeError:
            continue
        return system, motion, {name: one for name, one in arguments.items() if name != "accuracy"}


def held(rng):
    """Draw a leaning block with tendons, loads, ties that break and walls, or a cap under it."""
    while True:
        try:
            return _held(rng)
        except rf.errors.AssemblyError:  # its loads make it fall
            continue


def _held(rng):
    width = float(rng.uniform(0.4, 3.0))
    height, mass = width * float(rng.uniform(1.0, 6.0)), float(10.0 ** rng.uniform(1.0, 5.0))
    weight, theta = GRAVITY * mass, math.atan(width / height)
    size = {"width": f"{width!r} m", "height": f"{height!r} m", "mass": f"{mass!r} kg"}
    eccentricity = float(rng.uniform(-0.1, 0.1)) * width
    block = rf.Block(**size, centre_of_mass=(f"{0.4 * height!r} m", f"{eccentricity!r} m"))
    if rng.random() < 0.3:
        block = rf.FrameEquivalent(**size, shape_factor=float(rng.uniform(1.0, 3.0)))
    on = str(rng.choice(["rigid", "pads", "soil", "cap"]))
    sink = width * 10.0 ** float(rng.uniform(-3.5, -2.0))
    pads = rf.TwoSpringSupport(
        stiffness=f"{0.5 * weight / sink!r} N/m", restitution=float(rng.uniform(0.2, 1.0)),
        damping=f"{0.05 * mass * math.sqrt(GRAVITY / sink)!r} N s m^-1",
    )  # fmt: skip
    soil = rf.WinklerSoil(
        stiffness=f"{weight / sink / width!r} Pa", separation=str(rng.choice(scenes.SEPARATIONS)),
        damping=f"{0.1 * mass * math.sqrt(GRAVITY / sink) / width!r} Pa s",
    )  # fmt: skip
    cap = rf.CushionCap(
        width=f"{1.2 * width!r} m", height=f"{0.1 * width!r} m", mass=f"{0.2 * mass!r} kg"
    )
    ground = rf.RigidGround(restitution=float(rng.uniform(0.4, 0.9)))
    parts = {"rigid": [ground], "pads": [pads], "soil": [soil], "cap": [cap, soil]}[on]
    options = {"restraint": str(rng.choice(RULES))} if on != "rigid" else {}
    stiffness = f"{weight / height * 10.0 ** float(rng.uniform(-1.0, 2.5))!r} N/m"
    side, up = float(rng.choice([-0.5, 0.5])) * width, 0.8 * height
    level, depth = ("0 m", "0 m") if on == "rigid" else ("0 m", f"{height!r} m")
    links = [
        rf.Tendon(stiffness=stiffness, preload=f"{0.3 * weight!r} N", depth=depth),
        rf.Tendon(stiffness=stiffness, strength=f"{0.5 * weight!r} N", at=f"{0.2 * side!r} m",
                  depth=depth, brittle=bool(rng.random() < 0.5)),
        rf.Load(at=(f"{0.2 * side!r} m", f"{up!r} m"), vertical=f"{0.3 * weight!r} N",
                horizontal=f"{0.01 * weight!r} N"),
        rf.Load(at=(f"{0.2 * side!r} m", f"{up!r} m"), moving_mass=f"{0.2 * mass!r} kg"),
        rf.RearWall(stiffness=stiffness, gap=f"{0.01 * width!r} m"),
        rf.Restrainer(on=(f"{side!r} m", f"{up!r} m"), to=(f"{3.0 * side!r} m", level),
                      stiffness=stiffness, breaking_elongation=f"{0.05 * width!r} m"),
    ]  # fmt: skip
    which = rng.permutation(len(links))[: int(rng.integers(0, 3))] if on != "cap" else []
    if not len(which):
        options["inclination"] = f"{0.2 * theta * float(rng.uniform(-1.0, 1.0))!r} rad"
        options["rotation"] = str(rng.choice(scenes.ROTATIONS))
    system = rf.System(block, *parts, *(links[i] for i in which), **options)
    across = np.convolve(rng.normal(size=60), np.ones(5) / 5.0**0.5, "same")
    across *= GRAVITY * width / height * float(rng.uniform(0.3, 2.0))
    upwards = GRAVITY * float(rng.choice([0.3, 1.2])) * rng.normal(size=60)
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), "0.02 s", vertical=(upwards, "m/s^2"))
    start = {"rotation": f"{0.5 * theta * float(rng.uniform(-1.0, 1.0))!r} rad"}
    if on == "pads":
        start["vertical_velocity"] = "0.1 m/s"
    arguments = {"free_vibration": "1.0 s", "points": {"top": ("0.2 m", f"{height!r} m")},
             "output_step": "0.01 s"}  # fmt: skip
    if rng.random() < 0.5:
        arguments["initial"] = rf.InitialState(**start)
    return system, motion, arguments


DRAWN = {
    **{base: partial(usual, base) for base in scenes.BASES},
    **{part: partial(of_part, part) for part in random_parts.PARTS},
    "slides": partial(slides, sliding.draw),
    "slides on a base": partial(slides, sliding.draw_on_base),
    "slides with ties": partial(slides, sliding.draw_tied),
    "slides with ties on a base": partial(slides, sliding.draw_tied_on_base),
    "slides before a wall": partial(slides, sliding.draw_walled),
    "slides before a wall on a base": partial(slides, sliding.draw_walled_on_base),
    "ties": tied,
    "held": held,
}
"""Functions by kind that draw a scene: system, motion and arguments of its run."""
