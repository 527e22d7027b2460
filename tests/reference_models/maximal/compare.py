"""Compare rockframe with the reference model in random scenes.

python tests/reference_models/maximal/compare.py --scenes 1000 --seed 1 [--only pads]
python tests/reference_models/maximal/compare.py --seed 1 --only pads --replay 17 23
python tests/reference_models/maximal/compare.py --scenes 340 --seed 12 \\
    --variants plain eccentric inclined --levels tight standard fast
"""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve()
ROOT = HERE.parents[3]
if __package__ in (None, ""):
    sys.path.insert(0, str(HERE.parents[2]))
    sys.path.append(str(ROOT))

from reference_models.maximal.comparison import LEVELS, Outcome, compare  # noqa: E402
from reference_models.maximal.motions import records_available  # noqa: E402
from reference_models.maximal.random_scenes import VARIANTS  # noqa: E402
from reference_models.maximal.scene import KINDS  # noqa: E402

DATA = ROOT / "docs" / "data"
LABELS = ("agrees", "chaos", "sensitive", "by tolerance", "disagrees", "apart")


def main() -> None:
    """Run the comparison requested on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="number of the first scene")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--replay", type=int, nargs="+", help="numbers of scenes to repeat")
    parser.add_argument("--limit", type=float, help="of agreement, instead of the level's")
    parser.add_argument("--variants", nargs="+", choices=VARIANTS, default=[VARIANTS[0]])
    parser.add_argument("--levels", nargs="+", choices=LEVELS, default=["tight"])
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    if not records_available():
        print("no recorded motions (set ROCKFRAME_RECORDS): sums of sines instead")
    tables = []
    for variant in options.variants:
        for kind in options.only:
            tables += _compare_kind(kind, variant, options)
    if not options.replay:
        usual = options.variants == [VARIANTS[0]] and options.levels == ["tight"]
        path = options.json or DATA / f"maximal_oracle{'' if usual else '_levels'}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(tables, indent=1) + "\n")


def _compare_kind(kind: str, variant: str, options: argparse.Namespace) -> list[dict]:
    """Compare scenes of one kind, and give a table for each level."""
    numbers = options.replay or range(options.first, options.first + options.scenes)
    start_time = time.perf_counter()
    scenes = [_compare_scene(kind, number, variant, options) for number in numbers]
    print(f"{kind} {variant}: {time.perf_counter() - start_time:.0f} s")
    tables = []
    for outcomes in zip(*scenes, strict=True):
        tables.append(_summary(kind, variant, options, outcomes))
        print("   ", _line(tables[-1]), flush=True)
        for outcome in outcomes:
            if outcome.label != "agrees" or options.replay:
                print("       ", _describe(outcome), flush=True)
    print("    scenes with:", ", ".join(f"{k} {v}" for k, v in tables[-1]["seen"].items()))
    return tables


def _compare_scene(
    kind: str, number: int, variant: str, options: argparse.Namespace
) -> list[Outcome]:
    try:
        return compare(kind, options.seed, number, variant, options.levels, options.limit)
    except Exception as problem:  # a scene that breaks a program is reported too
        words = f"{type(problem).__name__}: {problem}"
        return [
            Outcome(
                kind, options.seed, number, level, "disagrees", 1.0, 1.0, 0.0, 1.0, (False, False),
                (-1, -1), note=words,
            )
            for level in options.levels
        ]  # fmt: skip


def _summary(
    kind: str, variant: str, options: argparse.Namespace, outcomes: Sequence[Outcome]
) -> dict:
    agreeing = [o for o in outcomes if o.label == "agrees"]
    level = outcomes[0].level
    table = {"kind": kind, "variant": variant, "level": level, "seed": options.seed}
    table |= {"records": records_available(), "scenes": len(outcomes)}
    table |= {label: sum(o.label == label for o in outcomes) for label in LABELS}
    table["worst_agreeing"] = max(
        (max(o.difference, o.rise_difference) for o in agreeing), default=0
    )
    table["overturned"] = sum(o.overturned[1] for o in outcomes)
    table["verdicts_differ"] = [o.number for o in outcomes if o.overturned[0] != o.overturned[1]]
    table["verdicts_told"] = [
        o.number for o in outcomes if o.overturned[0] != o.overturned[1] and o.told
    ]
    far = [o for o in outcomes if o.peak_difference > 0.05]
    table["peaks_far"] = [o.number for o in far]
    table["peaks_far_told"] = [o.number for o in far if o.told]
    table["told"] = sum(o.told for o in outcomes)
    table["limit"] = options.limit or LEVELS[level].agrees
    seen = [name for o in outcomes for name in o.seen]
    table["seen"] = {name: seen.count(name) for name in sorted(set(seen))}
    table["beyond"] = [o.plain() for o in outcomes if o.label not in ("agrees", "apart")]
    return table


def _line(table: dict) -> str:
    counts = "  ".join(f"{label} {table[label]}" for label in LABELS)
    return (
        f"{table['kind']} {table['variant']} {table['level']}: scenes {table['scenes']}  {counts}  "
        f"worst agreeing {table['worst_agreeing']:.1e}  overturned {table['overturned']}  "
        f"verdicts differ {len(table['verdicts_differ'])} (told {len(table['verdicts_told'])})  "
        f"peaks off by 5 % {len(table['peaks_far'])} (told {len(table['peaks_far_told'])})"
    )


def _describe(outcome: Outcome) -> str:
    growth = " ".join(f"{value:.1e}" for value in outcome.growth)
    return (
        f"{outcome.level} {outcome.kind} --seed {outcome.seed} --replay {outcome.number}: "
        f"{outcome.label}, rotation {outcome.difference:.1e}, "
        f"rise {outcome.rise_difference:.1e}, from {outcome.first:.3f} s, "
        f"overturned {outcome.overturned}, status {outcome.status}, growth {growth} "
        f"{outcome.note} seen {', '.join(outcome.seen)}"
    )


if __name__ == "__main__":
    main()
