"""Compare the package's chains of bodies with the reference model in random scenes.

python tests/reference_models/stacks/compare.py --scenes 300 300 100 60 --seed 77 --bodies 2 3 5 8
python tests/reference_models/stacks/compare.py --seed 77 --bodies 3 --replay 17
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve()
ROOT = HERE.parents[3]
if __package__ in (None, ""):
    sys.path.insert(0, str(HERE.parents[2]))
    sys.path.append(str(ROOT))

from reference_models.maximal.motions import have_records  # noqa: E402
from reference_models.stacks.comparison import compared  # noqa: E402
from reference_models.stacks.contact import OVERTURNED  # noqa: E402
from reference_models.stacks.random_scenes import draw, tied  # noqa: E402

AGREES = 1e-6


def main() -> None:
    """Run the comparison that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, nargs="+", default=[300], help="for each number")
    parser.add_argument("--seed", type=int, default=77)
    parser.add_argument("--bodies", type=int, nargs="+", default=[2, 3, 5, 8])
    parser.add_argument("--ties", action="store_true", help="with ties between random points")
    parser.add_argument("--replay", type=int, nargs="+", help="numbers of scenes to repeat")
    parser.add_argument("--json", type=Path, default=ROOT / "docs" / "data" / "chain_oracle.json")
    given = parser.parse_args()
    if not have_records():
        print("no recorded motions (set ROCKFRAME_RECORDS): sums of sines in their place")
    tables = []
    counts = given.scenes * (len(given.bodies) if len(given.scenes) == 1 else 1)
    for bodies, count in zip(given.bodies, counts, strict=True):
        tables.append(_table(bodies, given.seed, given.replay or range(count), given.ties))
        print(tables[-1], flush=True)
    if not given.replay:
        given.json.write_text(json.dumps(tables, indent=1) + "\n")


def _drawn(bodies: int, seed: int, number: int, ties: bool):
    rng = np.random.default_rng([seed, bodies, number])
    scene = draw(rng, bodies)
    return tied(scene, rng) if ties else scene


def _table(bodies: int, seed: int, numbers, ties: bool) -> dict:
    found = [compared(_drawn(bodies, seed, one, ties)) for one in numbers]
    differences = np.array([one.difference for one in found])
    return {
        "bodies": bodies,
        "seed": seed,
        "records": have_records(),
        "scenes": len(found),
        "agree": int(np.sum(differences < AGREES)),
        "median": float(f"{np.median(differences):.1e}"),
        "worst": float(f"{differences.max():.1e}"),
        "uplifting": sum(len(one.reference.events) > 0 for one in found),
        "overturning": sum(one.reference.status == OVERTURNED for one in found),
        "events": sum(len(one.reference.events) for one in found),
        "beyond": [int(numbers[i]) for i in np.flatnonzero(differences >= AGREES)],
    }


if __name__ == "__main__":
    main()
