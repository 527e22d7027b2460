"""Compare rockframe with the reference model in random scenes.

python tests/reference_models/maximal/compare.py --scenes 1000 --seed 1 [--only pads]
python tests/reference_models/maximal/compare.py --seed 1 --only pads --replay 17 23
"""

import argparse
import json
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve()
ROOT = HERE.parents[3]
if __package__ in (None, ""):
    sys.path.insert(0, str(HERE.parents[2]))
    sys.path.append(str(ROOT))

from reference_models.maximal.comparing import AGREES, Outcome, compare  # noqa: E402
from reference_models.maximal.motions import have_records  # noqa: E402
from reference_models.maximal.scene import KINDS  # noqa: E402

DATA = ROOT / "docs" / "data"
LABELS = ("agrees", "chaos", "sensitive", "disagrees")


def main() -> None:
    """Run the comparison that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="number of the first scene")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--replay", type=int, nargs="+", help="numbers of scenes to repeat")
    parser.add_argument("--limit", type=float, default=AGREES, help="of agreement")
    parser.add_argument("--eccentric", action="store_true", help="centres of mass to the side")
    parser.add_argument("--json", type=Path)
    given = parser.parse_args()
    if not have_records():
        print("no recorded motions (set ROCKFRAME_RECORDS): sums of sines in their place")
    tables = []
    for kind in given.only:
        numbers = given.replay or range(given.first, given.first + given.scenes)
        begun = time.perf_counter()
        outcomes = [_one(kind, number, given) for number in numbers]
        tables.append(_summary(kind, given, outcomes))
        print(_line(tables[-1]), f"{time.perf_counter() - begun:.0f} s", flush=True)
        print("    scenes with:", ", ".join(f"{k} {v}" for k, v in tables[-1]["seen"].items()))
        for outcome in outcomes:
            if outcome.label != "agrees" or given.replay:
                print("   ", _words(outcome), flush=True)
    if not given.replay:
        name = "maximal_oracle_eccentric.json" if given.eccentric else "maximal_oracle.json"
        path = given.json or DATA / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(tables, indent=1) + "\n")


def _one(kind: str, number: int, given: argparse.Namespace) -> Outcome:
    try:
        return compare(kind, given.seed, number, given.eccentric, given.limit)
    except Exception as problem:  # a scene that breaks a program is a finding too
        words = f"{type(problem).__name__}: {problem}"
        return Outcome(
            kind, given.seed, number, "disagrees", 1.0, 1.0, 0.0, (False, False), (-1, -1),
            note=words,
        )  # fmt: skip


def _summary(kind: str, given: argparse.Namespace, outcomes: list[Outcome]) -> dict:
    agreeing = [o for o in outcomes if o.label == "agrees"]
    table = {"kind": kind, "seed": given.seed, "records": have_records(), "scenes": len(outcomes)}
    table |= {label: sum(o.label == label for o in outcomes) for label in LABELS}
    table["worst_agreeing"] = max(
        (max(o.difference, o.rise_difference) for o in agreeing), default=0
    )
    table["overturned"] = sum(o.overturned[1] for o in outcomes)
    table["verdicts_differ"] = [o.number for o in outcomes if o.overturned[0] != o.overturned[1]]
    table["limit"] = given.limit
    seen = [name for o in outcomes for name in o.seen]
    table["seen"] = {name: seen.count(name) for name in sorted(set(seen))}
    table["beyond"] = [o.plain() for o in outcomes if o.label != "agrees"]
    return table


def _line(table: dict) -> str:
    counts = "  ".join(f"{label} {table[label]}" for label in LABELS)
    return (
        f"{table['kind']:8} scenes {table['scenes']}  {counts}  worst agreeing "
        f"{table['worst_agreeing']:.1e}  overturned {table['overturned']}  verdicts differ "
        f"{len(table['verdicts_differ'])}"
    )


def _words(outcome: Outcome) -> str:
    growth = " ".join(f"{value:.1e}" for value in outcome.growth)
    return (
        f"{outcome.kind} --seed {outcome.seed} --replay {outcome.number}: {outcome.label}, "
        f"rotation {outcome.difference:.1e}, rise {outcome.rise_difference:.1e}, from "
        f"{outcome.first:.3f} s, overturned {outcome.overturned}, status {outcome.status}, "
        f"growth {growth} {outcome.note} seen {', '.join(outcome.seen)}"
    )


if __name__ == "__main__":
    main()
