"""Random blocks before walls, in the package and in an independent program.

``python tests/benchmarks/walls.py 300`` prints how many agree, and the worst of them.
"""

import sys
import warnings
from pathlib import Path

from rockframe.errors import RockframeWarning

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from reference_models.walls import compare


def main(count: int) -> None:
    """Compare scenes 0 to `count`."""
    warnings.simplefilter("ignore", RockframeWarning)
    worst, other, apart, impacts = 0.0, [], [], 0
    for seed in range(count):
        difference, ours, theirs = compare(seed)
        worst = max(worst, difference)
        impacts += int(ours.impact_count)
        if bool(ours.overturned) != theirs.overturned:
            other.append(seed)
        if difference > 1e-6 or abs(int(ours.impact_count) - len(theirs.impacts)) > 1:
            apart.append(seed)
    print(f"{count} scenes, {impacts} impacts, worst difference {worst:.1e} of theta")
    print(f"other verdict: {other}; difference above 1e-6, or other impacts: {apart}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 300)
