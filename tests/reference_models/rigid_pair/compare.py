"""Compare the package's rigid blocks upon one another with the reference model in random scenes.

python tests/reference_models/rigid_pair/compare.py --scenes 300 --seed 11
python tests/reference_models/rigid_pair/compare.py --seed 11 --replay 17
"""

import argparse
import json
import math
import sys
from collections import Counter
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve()
ROOT = HERE.parents[3]
if __package__ in (None, ""):
    sys.path.insert(0, str(HERE.parents[2]))
    sys.path.append(str(ROOT))

from reference_models.rigid_pair.comparing import Compared, compared  # noqa: E402
from reference_models.rigid_pair.drawing import draw, have_records  # noqa: E402

AGREES = 1e-6


def table_of(seed: int, numbers) -> dict:
    """Compare scenes and count."""
    found = {}
    for one in numbers:
        found[one] = compared(draw(np.random.default_rng([seed, one])))
        tell(one, found[one])
    each = list(found.values())
    unique = np.array([one.difference(one.reference.unique_until) for one in each])
    runs = [one.reference for one in each]
    lasting = [one for one in each if one.lasts]
    impacts = np.sum([one.impacts for one in each], axis=0)
    causes = Counter(
        f"{event.kind}, {event.admissible} admissible"
        for run in runs
        for event in [next((e for e in run.events if e.admissible != 1), None)]
        if event is not None
    )
    return {
        "seed": seed,
        "records": have_records(),
        "scenes": len(each),
        "uplifting": sum(len(run.events) > 0 for run in runs),
        "overturning": sum(run.overturned for run in runs),
        "in flight": sum(any("none" in e.after for e in run.events) for run in runs),
        "events": sum(len(run.events) for run in runs),
        "worst energy balance": float(f"{max(run.imbalance for run in runs):.0e}"),
        "agree while unique": int(np.sum(unique < AGREES)),
        "agree to the end": sum(one.difference() < AGREES for one in each),
        "median": float(f"{np.median(unique):.1e}"),
        "worst": float(f"{unique.max():.1e}"),
        "beyond": [name for name, one in zip(found, unique, strict=True) if one >= AGREES],
        "impacts": int(impacts[0]),
        "impacts found in both": int(impacts[1]),
        "unique to the end": sum(math.isinf(run.unique_until) for run in runs),
        "no longer unique by": dict(causes),
        "end early": [name for name, one in found.items() if not one.lasts],
        "verdicts": len(lasting),
        "verdicts agree": sum(one.same_verdict for one in lasting),
    }


def tell(number: int, one: Compared) -> None:
    """Print a line on a scene that differs, or ends early."""
    unique = one.reference.unique_until
    differences = one.difference(unique), one.difference()
    if max(differences) >= AGREES or not one.lasts or not one.same_verdict:
        print(
            number, " ".join(f"{size:.1e}" for size in differences), f"unique to {unique:.6g} s;",
            f"ends {one.reference.end:.6g} {one.run.end_time:.6g} s;",
            one.reference.overturned, bool(one.run.overturned), flush=True,
        )  # fmt: skip


def main() -> None:
    """Run the comparison that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--replay", type=int, nargs="+", help="numbers of scenes to repeat")
    parser.add_argument(
        "--json", type=Path, default=ROOT / "docs" / "data" / "rigid_pair_oracle.json"
    )
    given = parser.parse_args()
    if not have_records():
        print("no recorded motions (set ROCKFRAME_RECORDS)")
        return
    table = table_of(given.seed, given.replay or range(given.scenes))
    print(json.dumps(table, indent=1))
    if not given.replay:
        given.json.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
