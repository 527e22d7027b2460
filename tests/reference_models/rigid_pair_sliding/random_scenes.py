"""Random scenes of two rigid blocks that slide and rock."""

import math
from typing import Any, NamedTuple

import numpy as np
from reference_models.rigid_pair import random_scenes
from reference_models.rigid_pair.ground import Piece, pieces_of, still
from reference_models.rigid_pair.pair import GRAVITY, Pair
from reference_models.rigid_pair.random_scenes import draw_pair, log_between

from .choices import Frictions
from .contacts import INTERFACES, Friction

FREE = random_scenes.FREE
"""Still ground after a motion [s]."""
STEP = 0.1
"""Time step of noise [s]."""
SAMPLES = 26
NOISE_ON_SPRINGS = 16
"""Number of samples with springs, where runs are slow."""


class Scene(NamedTuple):
    """A pair, the friction under its bodies, and a motion with its kind under ``form``."""

    pair: Pair
    frictions: Frictions
    motion: dict[str, Any]
    bases: dict[str, dict[str, Any]] = {}  # noqa: RUF012  compliant bases, by arguments of the package
    rule: str = "contact-state"

    def mirrored(self) -> "Scene":
        """Return the mirror image of the scene."""
        motion = dict(self.motion)
        if motion["form"] == "noise":
            motion["across"] = [-one for one in motion["across"]]
        else:
            motion["peak"] = -motion["peak"]
        return self._replace(pair=self.pair.mirrored(), motion=motion)


def draw(seed) -> Scene:
    """Draw bodies, friction and a motion that may move them.

    The bodies are those of ``rigid_pair``, the upper one narrower than the lower one by a tenth
    at least, and some too squat to rock. One interface in eight holds, one in six sticks in
    impacts.
    """
    rng = np.random.default_rng(seed)
    pair = None
    while pair is None:
        pair = _pair(rng)
    sides = zip(INTERFACES, pair.limits, strict=True)
    frictions = {key: _friction(rng, math.tan(min(-one, two))) for key, (one, two) in sides}
    return Scene(pair, frictions, _motion(rng, pair, frictions))


def draw_compliant(seed) -> Scene:
    """Draw a scene in which the lower or the upper body stands on pads or on a bed, with friction.

    The bodies are symmetric, so that they are upright at rest. Landings on pads are no impacts.
    """
    rng = np.random.default_rng(seed)
    pair = None
    while pair is None:
        pair = _pair(rng)
    upper, lower = (one._replace(beside=0.0) for one in (pair.upper, pair.lower))
    key = str(rng.choice(INTERFACES))
    pair = Pair(lower, upper, 0.0 if key == "ground" else pair.offset)
    sides = zip(INTERFACES, pair.limits, strict=True)
    frictions = {one: _friction(rng, math.tan(min(-a, b))) for one, (a, b) in sides}
    while math.isinf(frictions[key].static):
        frictions[key] = _friction(rng, 0.3)
    frictions[key] = frictions[key]._replace(stick=False)
    damping = float(rng.choice([0.0, rng.uniform(0.02, 0.4)], p=[0.25, 0.75]))
    base: dict[str, Any] = {"damping_ratio": damping}
    if rng.random() < 0.6:
        base["frequency_ratio"] = float(rng.uniform(8.0, 20.0))
        base["restitution"] = 1.0
    else:
        carried = lower.mass + upper.mass if key == "ground" else upper.mass
        width = 2.0 * (lower if key == "ground" else upper).half_width
        sinks = float(rng.uniform(0.002, 0.01))
        base["stiffness"] = f"{carried * GRAVITY / (width * width * sinks)!r} Pa"
    rule = str(rng.choice(["contact-state", "centre"]))
    motion = _motion(rng, pair, frictions)
    if motion["form"] == "noise":
        motion = {k: v[:NOISE_ON_SPRINGS] if k != "form" else v for k, v in motion.items()}
    return Scene(pair, frictions, motion, {key: base}, rule)


def _pair(rng: np.random.Generator) -> Pair | None:
    pair = draw_pair(rng, (0.6, 2.0), (0.6, 4.0), (0.3, 0.9), 0.6)
    lower, upper = pair.lower, pair.upper
    total = lower.mass + upper.mass
    foot = (lower.mass * lower.beside + upper.mass * (pair.offset + upper.beside)) / total
    stands = abs(foot) < 0.9 * lower.half_width
    return pair if stands else None


def _friction(rng: np.random.Generator, slender: float) -> Friction:
    """Draw a friction, in two cases of three near tipping, so that the body slides and rocks."""
    static = float(rng.uniform(0.15, 0.9))
    if rng.random() < 2.0 / 3.0:
        static = min(max(slender * float(rng.uniform(0.6, 1.6)), 0.15), 0.9)
    kinetic = static * float(rng.choice([1.0, rng.uniform(0.7, 1.0)]))
    holds, sticks = rng.random() < 0.125, bool(rng.random() < 1.0 / 6.0)
    return Friction() if holds else Friction(static, kinetic, sticks)


def _motion(rng: np.random.Generator, pair: Pair, frictions: Frictions) -> dict[str, Any]:
    """Draw a motion scaled by the least acceleration that moves a body."""
    least = min(math.tan(min(-one, two)) for one, two in pair.limits)
    least = min(least, *(f.static for f in frictions.values())) * GRAVITY
    vertical = float(rng.uniform(0.2, 0.7)) * GRAVITY if rng.random() < 0.3 else 0.0
    form = str(rng.choice(["sine", "cosine", "noise"]))
    if form == "noise":
        size = least * log_between(rng, 0.8, 3.0)
        across, up = size * rng.normal(size=SAMPLES), rng.uniform(-1.0, 1.0, SAMPLES) * vertical
        across[0] = across[-1] = up[0] = up[-1] = 0.0
        return {"form": form, "across": across.tolist(), "up": up.tolist()}
    peak = float(rng.choice([-1.0, 1.0])) * least * log_between(rng, 1.0, 5.0)
    size = math.hypot(pair.lower.half_width, pair.lower.below + pair.upper.below)
    pace = math.sqrt(0.75 * GRAVITY / size)
    frequency = round(pace * log_between(rng, 1.0, 6.0) / (2.0 * math.pi), 3)
    cycles = float(rng.choice([0.5, 1.0, 1.5]))
    return {
        "form": form, "peak": peak, "vertical": vertical, "frequency": frequency, "cycles": cycles,
    }  # fmt: skip


def pieces_for(motion: dict[str, Any]) -> tuple[list[Piece], float]:
    """Return the pieces of a motion and of still ground after it, and its least period [s]."""
    if motion["form"] != "noise":
        return random_scenes.pieces_for(motion)
    pieces = pieces_of(STEP, motion["across"], motion["up"])
    return [*pieces, still(pieces[-1].stop, pieces[-1].stop + FREE)], math.inf
