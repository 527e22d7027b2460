"""Count how many patterns are admissible after random impacts.

python tests/reference_models/rigid_pair/count_impacts.py --draws 20000 --seed 5
"""

import argparse
import math
import sys
from collections import Counter
from pathlib import Path

import numpy as np

if __package__ in (None, ""):
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from reference_models.rigid_pair.choices import ALL, complementary, strike
from reference_models.rigid_pair.pair import ENDS, SIGN, Body, Pair, Pattern, Phase

KINDS = (
    "together", "upper alone", "lower under a rocking upper one",
    "upper on a rocking lower one",
)  # fmt: skip


def draw_pair(rng: np.random.Generator) -> Pair:
    """Draw two bodies, the upper one wholly on the lower one."""
    width = float(rng.uniform(0.5, 2.0))
    height = width * math.exp(rng.uniform(math.log(0.5), math.log(6.0)))
    lower = Body.uniform(width, height, width * height)
    other = width * float(rng.uniform(0.3, 1.0))
    height = other * math.exp(rng.uniform(math.log(0.5), math.log(6.0)))
    dense = math.exp(rng.uniform(math.log(0.2), math.log(5.0)))
    upper = Body.uniform(other, height, dense * other * height)
    return Pair(lower, upper, float(rng.uniform(-0.5, 0.5)) * (width - other))


def draw_impact(rng: np.random.Generator, kind: str, tilt: float = 0.3):
    """Draw a pair and its six places and velocities just before an impact.

    Returns
    -------
    tuple
        Pair, places, velocities and the ends that touch.
    """
    while True:
        pair = draw_pair(rng)
        end, other = (ENDS[int(rng.integers(2))] for _ in range(2))
        back = -SIGN[other]
        if kind == "together":
            pattern, rates, touching, angles = Pattern(end, "both"), [-SIGN[end]], ALL, (0.0,)
        elif kind == "upper alone":
            pattern, rates, touching, angles = Pattern("both", other), [back], ALL, (0.0,)
        elif kind.startswith("lower"):
            pattern, touching = Pattern(end, other), {"ground": ENDS, "joint": (other,)}
            rates = [-SIGN[end], float(rng.uniform(-3.0, 3.0))]
            angles = (0.0, SIGN[other] * float(rng.uniform(0.0, tilt)))
        else:
            pattern, touching = Pattern(end, other), {"ground": (end,), "joint": ENDS}
            rates = list(rng.uniform(-1.0, 1.0, 2))
            angles = (SIGN[end] * float(rng.uniform(0.0, tilt)),) * 2
            if (rates[1] - rates[0]) * back <= 0.0:
                continue
        phase = Phase(pair, pattern, pair.offset)
        place = phase.placed(np.array(angles))
        speed = phase.motions(place[2], place[5])[0] @ np.array(rates)
        return pair, place, speed, touching


def count_impacts(rng: np.random.Generator, kind: str, draws: int) -> dict:
    """Count the admissible patterns of impacts of a kind.

    Returns
    -------
    dict
        Numbers of impacts by their number of admissible patterns; how many single patterns solve
        the linear complementarity problem; and the share of energy lost by the rules otherwise.
    """
    numbers, same = Counter[int](), 0
    for _ in range(draws):
        pair, place, speed, touching = draw_impact(rng, kind)
        outcome = strike(pair, pair.offset, place, speed, touching)
        numbers[outcome.admissible] += 1
        if outcome.admissible == 1:
            seats = Phase(pair, Pattern("both", "both"), pair.offset).seats
            other = complementary(seats, pair.masses, place, speed, touching)[1]
            same += bool(np.max(np.abs(other - outcome.motion)) < 1e-8 * np.max(np.abs(speed)))
    return {"admissible": dict(sorted(numbers.items())), "single as complementary": same}


def main() -> None:
    """Print the counts requested on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=20000)
    parser.add_argument("--seed", type=int, default=5)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    for kind in KINDS:
        print(kind, count_impacts(rng, kind, options.draws // 4), flush=True)


if __name__ == "__main__":
    main()
