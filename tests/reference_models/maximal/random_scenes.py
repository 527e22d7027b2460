"""Random scenes."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from .layout import LIMIT, RULES
from .motions import RECORDS, records_available
from .rest import NoRestError, rest_of
from .scene import GRAVITY, KINDS, Scene, parameters
from .starting import rest_on_slope

LARGEST_LEAN = 0.6
LEAST_SHARE = 1e-3
VARIANTS = ("plain", "eccentric", "inclined")


def draw(kind: str, seed: int, number: int, variant: str = "plain") -> Scene:
    """Draw a scene; the same seed and number give the same scene.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    seed, number : int
    variant : str
        One of `VARIANTS`: unchanged, with an eccentric centre of mass, or on an inclined base, half
        of these eccentric too.

    Returns
    -------
    Scene
    """
    rng = np.random.default_rng([seed, number, KINDS.index(kind)])
    while True:
        scene = _body(kind, rng)
        if _is_stable(scene):
            break
    starts = rng.random() < 0.2
    scene = replace(
        scene,
        motion=draw_motion(
            GRAVITY / scene.slenderness,
            scene.frequency,
            rng,
            still=starts and rng.random() < 0.5,
        ),
        free=float(round(rng.uniform(1.0, 3.0), 3)),
        start=float(rng.uniform(-0.6, 0.6)) if starts else 0.0,
        start_rate=float(rng.uniform(-0.4, 0.4)) if starts and rng.random() < 0.5 else 0.0,
    )
    if scene.motion["form"] == "still":
        scene = replace(scene, free=float(round(rng.uniform(3.0, 6.0), 3)))
    if variant == "plain":
        return scene
    others = np.random.default_rng([seed, number, KINDS.index(kind), VARIANTS.index(variant)])
    if variant == "eccentric":
        return _with_eccentricity(scene, others)
    scene = replace(scene, small=False)  # the reference model has exact kinematics on slopes
    return _with_inclination(
        _with_eccentricity(scene, others) if others.random() < 0.5 else scene, others
    )


def _with_inclination(scene: Scene, rng: np.random.Generator) -> Scene:
    """Incline the base while the body still rests with all of its bases in full contact."""
    side = 1.0 if rng.random() < 0.5 else -1.0
    share = float(rng.uniform(0.02, 0.6))
    told = bool(rng.random() < 0.15)
    level = replace(scene, inclination=0.0)
    while True:
        inclined = replace(level, inclination=side * share * min(level.limits()), told=told)
        if scene.kind == "rigid" or _rests_on_slope(inclined):
            return inclined
        share *= 0.7
        if share < LEAST_SHARE:  # an end of the base is raised by the eccentricity alone
            level, share = replace(level, eccentricity=0.0), 100.0 * share


def _rests_on_slope(scene: Scene) -> bool:
    p = parameters(scene, 1e-13)
    try:
        rest = rest_on_slope(scene, p)
    except NoRestError:
        return False
    return abs(rest.lower_angle + rest.angle) < LARGEST_LEAN * p[LIMIT]


def _with_eccentricity(scene: Scene, rng: np.random.Generator) -> Scene:
    """Move the centre of mass sideways while the supports still carry it."""
    side = 1.0 if rng.random() < 0.5 else -1.0
    share = float(rng.uniform(0.02, 0.8 if scene.kind == "rigid" else 0.6))
    # scenes without initial rotation sometimes start upright explicitly
    told = bool(rng.random() < 0.15)
    while True:
        eccentric = replace(scene, eccentricity=side * share * scene.half_width, told=told)
        if scene.kind == "rigid" or _leans_little(eccentric):
            return eccentric
        share *= 0.7


def _leans_little(scene: Scene) -> bool:
    p = parameters(scene, 1e-13)
    try:
        rest = rest_of(scene, p)
    except NoRestError:
        return False
    return abs(rest.lower_angle + rest.angle) < LARGEST_LEAN * p[LIMIT]


def draw_log(rng: np.random.Generator, low: float, high: float) -> float:
    """Draw a number with a uniformly distributed logarithm."""
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def _body(kind: str, rng: np.random.Generator) -> Scene:
    radius, slenderness = draw_log(rng, 0.3, 15.0), draw_log(rng, 1.0, 8.0)
    mu = float(rng.uniform(2.6, 3.2)) if rng.random() < 0.7 else 3.0
    scene = Scene(
        kind=kind,
        rule=RULES[rng.integers(3)],
        radius=radius,
        slenderness=slenderness,
        mass=1e4 * radius**2,
        shape_factor=mu,
        beta=draw_log(rng, 8.0, 80.0),
        xi=0.0 if rng.random() < 0.15 else float(rng.uniform(0.0, 0.6)),
        small=bool(rng.random() < 0.1),
        soil_xi=0.0 if rng.random() < 0.15 else float(rng.uniform(0.0, 0.6)),
        separation="pressure" if rng.random() < 0.3 else "displacement",
    )
    if rng.random() < 0.4:
        scene = replace(scene, restitution=float(rng.uniform(0.2, 1.0)) * scene.eps)
    if kind in ("pads", "rigid"):
        return scene
    cap = kind != "bed" or rng.random() < 0.5
    if cap:
        scene = replace(
            scene,
            cap=True,
            cap_width=2.0 * scene.half_width * float(rng.uniform(1.0, 1.6)),
            cap_height=2.0 * scene.half_height * float(rng.uniform(0.01, 0.2)),
            cap_mass=scene.mass * draw_log(rng, 0.03, 0.6),
        )
    mass, _, b, level = scene.one_body()
    firmness = draw_log(rng, 1.4, 100.0)
    return replace(scene, soil_stiffness=1.5 * firmness * mass * GRAVITY * level / b**3)


def _is_stable(scene: Scene) -> bool:
    """Tell whether soil and pads in series hold the block, with a margin."""
    soft = 0.0
    if scene.kind in ("pads", "cascade", "coupled"):
        b, h = scene.half_width, scene.half_height
        fast = scene.beta * scene.frequency
        soft += GRAVITY * h / (fast * b) ** 2
    if scene.kind in ("bed", "cascade", "coupled"):
        mass, _, b, level = scene.one_body()
        soft += 1.5 * mass * GRAVITY * level / (scene.soil_stiffness * b**3)
    return soft < 0.8


def draw_motion(
    threshold: float, frequency: float, rng: np.random.Generator, still: bool
) -> dict[str, Any]:
    """Draw a motion from the uplift acceleration and the rocking frequency of the bodies."""
    vertical = float(rng.uniform(0.05, 0.7)) * GRAVITY if rng.random() < 0.5 else 0.0
    sign = 1.0 if rng.random() < 0.5 else -1.0
    kind = rng.random()
    pace = frequency / (2.0 * math.pi)
    scale = pace * draw_log(rng, 0.8, 8.0)
    peak = sign * threshold * draw_log(rng, 0.8, 2.2) * max(1.0, 0.4 * scale / pace)
    cycles = float(rng.choice([0.5, 1.0, 1.5, 2.5, 4.0]))
    waves = [_waves(rng), _waves(rng)]
    length, lead = float(rng.uniform(3.0, 7.0)), float(rng.uniform(0.1, 0.6))
    which, step = int(rng.integers(len(RECORDS))), float(rng.choice([0.005, 0.01, 0.02]))
    if still:
        return {"form": "still"}
    if kind < 0.35:
        names = ("sine", "cosine", "ricker", "odd ricker")
        form = names[int(kind / 0.35 * 4.0)]
        if form.endswith("ricker"):
            scale = 1.0 / scale
        return {
            "form": form, "peak": peak, "vertical": vertical, "scale": scale, "cycles": cycles,
        }  # fmt: skip
    size = sign * threshold * draw_log(rng, 1.0, 3.5)
    if kind < 0.6 and records_available():
        return {
            "form": "record", "which": which, "length": length, "lead": lead, "peak": size,
            "vertical": vertical,
        }  # fmt: skip
    return {
        "form": "sines", "step": step, "length": length, "peak": size, "vertical": vertical,
        "waves": waves[0], "vertical waves": waves[1],
    }  # fmt: skip


def _waves(rng: np.random.Generator) -> list[tuple[float, float, float]]:
    return [
        (float(rng.uniform(0.3, 1.0)), draw_log(rng, 0.3, 8.0), float(rng.random()))
        for _ in range(6)
    ]
