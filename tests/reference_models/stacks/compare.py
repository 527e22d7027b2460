"""Compare rockframe's chains of bodies with the reference model in random scenes.

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

from reference_models.maximal.motions import records_available  # noqa: E402
from reference_models.stacks.comparison import compare_scene  # noqa: E402
from reference_models.stacks.contact import OVERTURNED  # noqa: E402
from reference_models.stacks.random_scenes import draw, with_ties  # noqa: E402

AGREES = 1e-6


def main() -> None:
    """Run the comparison requested on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, nargs="+", default=[300], help="for each number")
    parser.add_argument("--seed", type=int, default=77)
    parser.add_argument("--bodies", type=int, nargs="+", default=[2, 3, 5, 8])
    parser.add_argument("--ties", action="store_true", help="with ties between random points")
    parser.add_argument("--replay", type=int, nargs="+", help="numbers of scenes to repeat")
    parser.add_argument("--json", type=Path, default=ROOT / "docs" / "data" / "chain_oracle.json")
    options = parser.parse_args()
    if not records_available():
        print("no recorded motions (set ROCKFRAME_RECORDS): sums of sines instead")
    tables = []
    counts = options.scenes * (len(options.bodies) if len(options.scenes) == 1 else 1)
    for bodies, count in zip(options.bodies, counts, strict=True):
        tables.append(_table(bodies, options.seed, options.replay or range(count), options.ties))
        print(tables[-1], flush=True)
    if not options.replay:
        options.json.write_text(json.dumps(tables, indent=1) + "\n")


def _draw_scene(bodies: int, seed: int, number: int, ties: bool):
    rng = np.random.default_rng([seed, bodies, number])
    scene = draw(rng, bodies)
    return with_ties(scene, rng) if ties else scene


def _table(bodies: int, seed: int, numbers, ties: bool) -> dict:
    comparisons = [
        compare_scene(_draw_scene(bodies, seed, comparison, ties)) for comparison in numbers
    ]
    differences = np.array([comparison.difference for comparison in comparisons])
    return {
        "bodies": bodies,
        "seed": seed,
        "records": records_available(),
        "scenes": len(comparisons),
        "agree": int(np.sum(differences < AGREES)),
        "median": float(f"{np.median(differences):.1e}"),
        "worst": float(f"{differences.max():.1e}"),
        "uplifting": sum(len(comparison.reference.events) > 0 for comparison in comparisons),
        "overturning": sum(comparison.reference.status == OVERTURNED for comparison in comparisons),
        "events": sum(len(comparison.reference.events) for comparison in comparisons),
        "beyond": [int(numbers[i]) for i in np.flatnonzero(differences >= AGREES)],
    }


if __name__ == "__main__":
    main()
