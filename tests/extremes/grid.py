"""Write the table of the page "Extremes": cases, failures and worst numbers of every subject.

From the root of the repository: ``python tests/extremes/grid.py docs/validation_extremes.txt``.
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from extremes.bounds import RESIDUAL, judge
from extremes.scenes import SUBJECTS, scenes

HEAD = ("subject", "runs", "failures", *(f"imbalance, {a}" for a in RESIDUAL), "steps")


def rows(count: int) -> Iterator[tuple[str, ...]]:
    """Run all scenes; return a row per subject."""
    for subject in SUBJECTS:
        failures, steps = 0, 0.0
        worst = dict.fromkeys(RESIDUAL, 0.0)
        for scene in scenes(subject, count):
            for accuracy, bound in RESIDUAL.items():
                verdict = judge(scene, accuracy)
                failures += bool(verdict.failures)
                for failure in verdict.failures:
                    sys.stderr.write(f"{subject}, {accuracy}: {failure}\n  {scene}\n")
                worst[accuracy] = max(worst[accuracy], verdict.residual * bound)
                steps = max(steps, verdict.steps / verdict.allowed)
        sizes = (f"{size:.1e}" for size in worst.values())
        yield subject, str(2 * count), str(failures), *sizes, f"{steps:.0%}"


def main() -> None:
    """Write the table to a file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--scenes", type=int, default=100, help="per subject")
    options = parser.parse_args()
    lines = [HEAD, ("---",) * len(HEAD), *rows(options.scenes)]
    text = "".join(f"| {' | '.join(line)} |\n" for line in lines)
    options.file.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
