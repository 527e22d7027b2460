"""Random scenes of two rigid blocks: bodies, offsets, pulses and recorded motions."""

import math
import os
import re
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .ground import Piece, harmonic, pieces_of, still
from .pair import GRAVITY, Body, Pair, Pattern, Phase

RECORDS = ("NIS090.AT2", "PEERSMD_IMPVALL_IELC180.AT2")
_VARIABLE = "ROCKFRAME_RECORDS"
_BESIDE = Path(__file__).resolve().parents[4] / "shared" / "records"
FREE = 2.0
"""Still ground after a motion [s]."""


class Scene(NamedTuple):
    """A pair and a motion, a dictionary with the kind of motion under ``form``."""

    pair: Pair
    motion: dict[str, Any]


def records_available() -> bool:
    """Tell whether the recorded motions are available."""
    return all((_folder() / name).is_file() for name in RECORDS)


def _folder() -> Path:
    return Path(os.environ.get(_VARIABLE, _BESIDE))


@cache
def _samples(name: str) -> tuple[float, np.ndarray]:
    """Read step and values of a file with four header lines, in any unit of acceleration."""
    lines = (_folder() / name).read_text(encoding="latin-1").splitlines()
    for i, line in enumerate(lines[:6]):
        step = re.search(r"DT\s*=\s*([0-9.]+)", line) or re.search(r"([0-9]*\.[0-9]+)\s+NPTS", line)
        if step or re.fullmatch(r"\s*[0-9]+\s+[0-9.]+\s*(NPTS, DT)?\s*", line):
            time_step = float(step.group(1)) if step else float(line.split()[1])
            values = " ".join(lines[i + 1 :]).split()
            return time_step, np.array([float(one) for one in values])
    msg = f"{name} states no time step"
    raise ValueError(msg)


def log_between(rng: np.random.Generator, low: float, high: float) -> float:
    """Draw a number with a uniformly distributed logarithm."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def draw(rng: np.random.Generator) -> Scene:
    """Draw two stacked bodies and a motion that may uplift them.

    Widths are 0.5 to 2 m below and a share of that above; slenderness is 0.8 to 6. In one scene
    of three a body is not uniform or not symmetric.
    """
    while True:
        pair = draw_pair(rng, (0.5, 2.0), (0.8, 6.0), (0.4, 1.0), 0.8)
        phase = Phase(pair, Pattern("both", "both"), pair.offset)
        place = phase.placed(np.zeros(0))
        at_rest = phase.pressures(place, phase.needed(np.zeros(6), 0.0, 0.0))
        if min(at_rest.values()) > 0.05 * GRAVITY * pair.upper.mass:
            break
    return Scene(pair, _motion(rng, pair))


def draw_pair(
    rng: np.random.Generator,
    widths: tuple[float, float],
    slenderness: tuple[float, float],
    shares: tuple[float, float],
    most_aside: float,
) -> Pair:
    """Draw a lower body of a given width, a narrower upper one, and its offset."""
    bodies, width = [], float(rng.uniform(*widths))
    for _ in range(2):
        height = width * log_between(rng, *slenderness)
        mass = 2000.0 * width * height * log_between(rng, 0.5, 2.0)
        body = Body.uniform(width, height, mass)
        if rng.random() < 1.0 / 3.0:
            level = height * float(rng.uniform(0.4, 0.55))
            beside = width * float(rng.uniform(-0.08, 0.08))
            heavier = float(rng.uniform(0.7, 1.1))
            body = Body(mass, body.inertia * heavier, 0.5 * width, level, height - level, beside)
        bodies.append(body)
        width *= float(rng.uniform(*shares))
    lower, upper = bodies
    spare = lower.half_width - upper.half_width
    aside = rng.uniform(-most_aside, most_aside) if rng.random() < 0.6 else 0.0
    return Pair(lower, upper, spare * float(aside))


def _motion(rng: np.random.Generator, pair: Pair) -> dict[str, Any]:
    """Draw a motion scaled by the tipping acceleration and the rocking frequency of the bodies."""
    (_, one), (_, two) = pair.limits
    peak = GRAVITY * math.tan(min(one, two)) * log_between(rng, 0.9, 5.0)
    vertical = 0.5 * peak if rng.random() < 0.3 else 0.0
    vertical = min(vertical, 0.7 * GRAVITY) * float(rng.uniform(0.3, 1.0))
    choice = rng.random()
    form = "sine" if choice < 0.4 else "cosine" if choice < 0.7 else "record"
    made: dict[str, Any] = {"form": form, "peak": peak, "vertical": vertical}
    if form == "record":
        return made | {
            "which": int(rng.integers(2)),
            "length": 6.0,
            "lead": float(rng.uniform(0.2, 0.8)),
        }
    sign = 1.0 if rng.random() < 0.5 else -1.0
    size = math.hypot(pair.lower.half_width, pair.lower.below + pair.upper.below)
    pace = math.sqrt(0.75 * GRAVITY / size)
    frequency = round(pace * log_between(rng, 1.0, 6.0) / (2.0 * math.pi), 3)
    cycles = float(rng.choice([0.5, 1.0, 1.5]))
    return made | {"peak": sign * peak, "frequency": frequency, "cycles": cycles}


def record_of(motion: dict[str, Any]) -> tuple[float, np.ndarray, np.ndarray]:
    """Return step and samples of a recorded motion, across and upwards [s], [m/s²]."""
    step, across = _samples(RECORDS[motion["which"]])
    _, up = _samples(RECORDS[1 - motion["which"]])
    last = min(across.size, up.size) - 1
    count = min(round(motion["length"] / step), last)
    strongest = int(np.argmax(np.abs(across)))
    first = max(0, min(last - count, strongest - int(motion["lead"] * count)))
    cut = slice(first, first + count + 1)
    return (
        step,
        across[cut] * (motion["peak"] / np.max(np.abs(across[cut]))),
        up[cut] * (motion["vertical"] / np.max(np.abs(up[cut]))),
    )


def pieces_for(motion: dict[str, Any]) -> tuple[list[Piece], float]:
    """Return the pieces of a motion and of still ground after it, and its least period [s]."""
    if motion["form"] == "record":
        step, across, up = record_of(motion)
        pieces = pieces_of(step, across, up)
        return [*pieces, still(pieces[-1].stop, pieces[-1].stop + FREE)], math.inf
    phase = 0.5 * math.pi if motion["form"] == "cosine" else 0.0
    return harmonic(
        motion["peak"], motion["vertical"], motion["frequency"], motion["cycles"], phase, FREE
    ), 1.0 / motion["frequency"]
