"""Blocks with ties or a tendon on rigid ground against equations written by hand.

Run from the root as ``PYTHONPATH=.:tests python tests/benchmarks/tied_oracle.py``.
"""

import argparse
import json
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
from reference_models import test_tendons
from reference_models.test_tied_rigid_blocks import AGREES, compare

DATA = Path(__file__).resolve().parents[2] / "docs" / "data" / "tied_oracle.json"
SCENES = 340
SHORT = 1e-5
"""Steps of the hand-written equation for scenes that disagree, as it misses two passages through
zero within one step [s]."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=SCENES)
    parser.add_argument("--tendons", type=int, default=300)
    parser.add_argument("--json", type=Path, default=DATA)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    comparisons, left_out, events = [], 0, Counter()
    for number in range(options.scenes):
        comparison = compare(number)
        if comparison is None:  # the corner is lifted, outside of the hand-written equation
            left_out += 1
            continue
        if comparison["difference"] > AGREES:
            print(number, comparison, flush=True)
            comparison = compare(number, longest_step=SHORT) | {"stepped over": True}
        comparisons.append(comparison)
        events += comparison["events"]
    differences = [comparison["difference"] for comparison in comparisons]
    table = {
        "scenes": len(comparisons),
        "left out, lifted": left_out,
        "agree": sum(comparison <= AGREES for comparison in differences),
        "of them by short steps": sum("stepped over" in comparison for comparison in comparisons),
        "median": float(f"{np.median(differences):.2g}"),
        "worst": float(f"{max(differences):.2g}"),
        "verdicts agree": sum(
            comparison["overturned"][0] == comparison["overturned"][1] for comparison in comparisons
        ),
        "overturning": sum(comparison["overturned"][0] for comparison in comparisons),
        "worst energy balance": float(
            f"{max(comparison['energy_residual'] for comparison in comparisons):.2g}"
        ),
        "events": dict(sorted(events.items())),
        "beyond": [
            comparison["number"] for comparison in comparisons if comparison["difference"] > AGREES
        ],
    }
    with_tendon = [test_tendons.compare(number) for number in range(options.tendons)]
    differences = [comparison["difference"] for comparison in with_tendon]
    table["with a tendon"] = {
        "scenes": len(with_tendon),
        "agree": sum(comparison <= AGREES for comparison in differences),
        "median": float(f"{np.median(differences):.2g}"),
        "worst": float(f"{max(differences):.2g}"),
        "verdicts agree": sum(
            comparison["overturned"][0] == comparison["overturned"][1] for comparison in with_tendon
        ),
        "overturning": sum(comparison["overturned"][0] for comparison in with_tendon),
        "events": sum(comparison["events"] for comparison in with_tendon),
    }
    options.json.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(table, indent=1))


if __name__ == "__main__":
    main()
