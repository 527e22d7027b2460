"""Random scenes of blocks on pads."""

import math
from dataclasses import replace

import numpy as np
from reference_models.maximal.random_scenes import draw_log, draw_motion

from .scene import GRAVITY, RULES, Body, Pads, Scene, Tie, centre_of

SOFTEST = 0.6
"""Largest ratio of the weight to the weight that tips the stack on its pads."""


def draw(
    rng: np.random.Generator,
    count: int = 3,
    offsets: bool = False,
    slenderness: tuple[float, float] = (2.0, 6.0),
) -> Scene:
    """Draw stacked blocks on pads, and a motion.

    About half of stacks of three blocks uplift and some overturn. Widths are 0.5 to 2 m and do
    not increase upwards.

    Parameters
    ----------
    rng : numpy.random.Generator
    count : int
        Number of blocks.
    offsets : bool
        Whether blocks are offset from the middle of those below.
    slenderness : tuple of float
        Range of height over width. Squat blocks fly, and slide as they land.

    Returns
    -------
    Scene
        Its motion is one for `maximal.motions.build_motions`.
    """
    rule = RULES[0] if rng.random() < 0.7 else RULES[1 + int(rng.integers(2))]
    while True:
        bodies = _blocks(rng, count, offsets, slenderness)
        bases = _pads(rng, bodies)
        if softness(bodies, bases) < SOFTEST:
            break
    starts = rng.random() < 0.2
    still = starts and rng.random() < 0.3
    threshold, size = _threshold(bodies)
    motion = draw_motion(
        draw_log(rng, 0.1, 1.0) * threshold, math.sqrt(0.75 * GRAVITY / size), rng, still
    )
    rotation = None
    if starts:
        top = bodies[0]
        rotation = float(rng.uniform(-0.5, 0.5)) * math.atan(top.half_width / top.height)
    return Scene(
        tuple(bodies), tuple(bases), rule, rotation, free=float(round(rng.uniform(1.0, 3.0), 3)),
        motion=motion,
    )  # fmt: skip


def with_ties(scene: Scene, rng: np.random.Generator) -> Scene:
    """Return the scene with one to three ties or bars, between bodies or to the ground."""
    count, ties = len(scene.bodies), []
    for _ in range(int(rng.integers(1, 4))):
        on = int(rng.integers(count))
        others = [None, *(k for k in range(count) if k != on)]
        to = others[int(rng.integers(len(others)))]
        body, side = scene.bodies[on], 1.0 if rng.random() < 0.5 else -1.0
        point = (side * body.half_width, float(rng.uniform(-1.0, 1.0)) * body.height)
        if to is None:
            x, y = centre_of(scene, on)
            to_point = (
                x + point[0] * float(rng.uniform(1.5, 3.0)),
                y * float(rng.uniform(0.0, 1.0)),
            )
        else:
            lower = scene.bodies[to]
            to_point = (-side * lower.half_width, float(rng.uniform(-1.0, 1.0)) * lower.height)
        weight = GRAVITY * sum(one.mass for one in scene.bodies)
        stiffness = weight / body.height * 10.0 ** float(rng.uniform(-0.5, 1.5))
        slack = None if rng.random() < 0.3 else 1e-3 * body.half_width * float(rng.uniform(1, 20))
        damping = 0.02 * math.sqrt(stiffness * body.mass) if rng.random() < 0.5 else 0.0
        ties.append(Tie(on, point, to, to_point, stiffness, damping, slack))
    return replace(scene, ties=tuple(ties))


def _blocks(
    rng: np.random.Generator, count: int, offsets: bool, slenderness: tuple[float, float]
) -> list[Body]:
    bodies: list[Body] = []
    width = float(rng.uniform(0.5, 2.0))
    for _ in range(count):
        if bodies:  # from the ground up
            width = float(rng.uniform(max(0.5, 0.6 * width), width))
        height = width * float(rng.uniform(*slenderness))
        mass = 2000.0 * width * height
        inertia = mass * (width**2 + height**2) / 12.0
        offset = 0.05 * width * float(rng.uniform(-1.0, 1.0)) if offsets and bodies else 0.0
        half = 0.5 * height
        bodies.insert(0, Body(mass, inertia, 0.5 * width, half, half, offset))
    return bodies


def _pads(rng: np.random.Generator, bodies: list[Body]) -> list[Pads]:
    """Draw pads by the ratio of the vertical frequency to the rocking frequency of the block."""
    carried, pads = 0.0, []
    for body in bodies:
        carried += body.mass
        radius = math.hypot(body.half_width, body.height)
        fast = draw_log(rng, 10.0, 60.0) * math.sqrt(0.75 * GRAVITY / radius)
        share, eps = float(rng.uniform(0.02, 0.2)), float(rng.uniform(0.2, 0.95))
        pads.append(Pads(0.5 * carried * fast**2, share * carried * fast, eps))
    return pads


def _above(bodies: list[Body], k: int) -> tuple[float, float]:
    """Return mass of a body and all above it, and the height of their centre over its base."""
    mass = rise = base = 0.0
    for body in bodies[k::-1]:
        mass += body.mass
        rise += body.mass * (base + body.height)
        base += body.height + body.top
    return mass, rise / mass


def softness(bodies: list[Body], bases: list[Pads]) -> float:
    """Return an upper bound of the ratio of the weight to the tipping weight, by Dunkerley."""
    total = 0.0
    for k, (body, pads) in enumerate(zip(bodies, bases, strict=True)):
        mass, level = _above(bodies, k)
        total += mass * GRAVITY * level / (2.0 * pads.stiffness * body.half_width**2)
    return total


def _threshold(bodies: list[Body]) -> tuple[float, float]:
    """Return the acceleration that uplifts the weakest base, and the radius of what rocks."""
    thresholds = []
    for k, body in enumerate(bodies):
        level = _above(bodies, k)[1]
        thresholds.append((GRAVITY * body.half_width / level, math.hypot(body.half_width, level)))
    return min(thresholds)
