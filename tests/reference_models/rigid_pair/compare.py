"""Compare rockframe's stacks of two rigid blocks with the reference model in random scenes.

python tests/reference_models/rigid_pair/compare.py --scenes 300 --seed 11
python tests/reference_models/rigid_pair/compare.py --seed 11 --replay 17
"""

import argparse
import json
import math
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve()
ROOT = HERE.parents[3]
if __package__ in (None, ""):
    sys.path.insert(0, str(HERE.parents[2]))
    sys.path.append(str(ROOT))

from reference_models.rigid_pair import random_scenes  # noqa: E402
from reference_models.rigid_pair.pair import Body  # noqa: E402
from reference_models.rigid_pair.random_scenes import FREE, Scene  # noqa: E402
from reference_models.rigid_pair.simulate import Run, simulate  # noqa: E402

import rockframe as rf  # noqa: E402

AGREES = 1e-6
STEP = 0.01
"""Output step of the compared rotations [s]."""


@dataclass(frozen=True)
class Compared:
    """Both runs, up to the end of the shorter one or of unique motion."""

    reference: Run
    package: Any  # the dataset
    difference: float  # of a rotation, over the largest one
    unique: bool

    @property
    def same_verdict(self) -> bool:
        """Whether both overturn or neither does."""
        return bool(self.package["overturned"]) == self.reference.overturned

    @property
    def impacts(self) -> tuple[int, int]:
        """Impacts with more than a millionth of the greatest loss, and those in both."""
        ours = [e for e in self.reference.events if e.kind == "impact"]
        ours = [e for e in ours if e.time < self.reference.unique_until]
        strongest = max((e.lost for e in ours), default=0.0)
        counted = [e.time for e in ours if e.lost > 1e-6 * strongest]
        theirs = np.append(self.package["event_time"].to_numpy(), -1.0)
        both = sum(bool(np.min(np.abs(theirs - one)) < 1e-6) for one in counted)
        return len(counted), both


def block_of(body: Body) -> rf.Block:
    """Return the package's block."""
    return rf.Block(
        width=f"{2.0 * body.half_width!r} m",
        height=f"{body.below + body.above!r} m",
        mass=f"{body.mass!r} kg",
        inertia=f"{body.inertia!r} kg*m^2",
        centre_of_mass=(f"{body.below!r} m", f"{body.beside!r} m"),
    )


def system_of(scene: Scene) -> rf.System:
    """Return the package's scene."""
    pair = scene.pair
    upper, lower = block_of(pair.upper), block_of(pair.lower)
    stack = rf.Stack(upper, lower, interfaces=[rf.RigidGround()], offsets=[f"{pair.offset!r} m"])
    return rf.System(stack, rf.RigidGround())


def motion_of(motion: dict[str, Any]) -> rf.GroundMotion:
    """Return the package's ground motion."""
    if motion["form"] == "record":
        step, across, up = random_scenes.record_of(motion)
        return rf.GroundMotion.from_arrays((across, "m/s^2"), f"{step!r} s", vertical=(up, "m/s^2"))
    make = getattr(rf.GroundMotion, f"{motion['form']}_pulse")
    made = [
        make(f"{motion[key]!r} m/s^2", f"{motion['frequency']!r} Hz", motion["cycles"])
        for key in ("peak", "vertical")
        if key == "peak" or motion[key]
    ]
    return made[0] if len(made) == 1 else made[0].with_vertical(made[1])


def compare_scene(scene: Scene, accuracy: str = "reference") -> Compared:
    """Run a scene by both programs."""
    pieces, period = random_scenes.pieces_for(scene.motion)
    reference = simulate(scene.pair, pieces, STEP, quickest=period)
    package = system_of(scene).simulate(
        motion_of(scene.motion), free_vibration=f"{FREE!r} s", accuracy=accuracy,
        output_step=f"{STEP!r} s",
    )  # fmt: skip
    ours = reference.place[:, [5, 2]]
    theirs = package["body_rotation"].transpose("time", "body").to_numpy()
    count = min(len(ours), len(theirs))
    until = min(reference.unique_until, reference.end)
    within = reference.time[:count] < until
    apart = np.abs(ours[:count] - theirs[:count])[within]
    largest = float(np.max(np.abs(ours[:count][within]), initial=0.0))
    apart = float(np.nanmax(apart, initial=0.0)) if not np.isnan(apart).any() else math.inf
    # rotations below rounding of positions are no motion
    return Compared(
        reference, package, apart / max(largest, 1e-9), math.isinf(reference.unique_until)
    )


def table_of(seed: int, numbers) -> dict:
    """Compare scenes and return counts."""
    comparisons = {}
    for number in numbers:
        try:
            comparisons[number] = compare_scene(
                random_scenes.draw(np.random.default_rng([seed, number]))
            )
        except Exception as fault:
            fault.add_note(f"scene {number}")
            raise
        print_difference(number, comparisons[number])
    differences = np.array([number.difference for number in comparisons.values()])
    runs = [number.reference for number in comparisons.values()]
    unique = [number for number in comparisons.values() if number.unique]
    impacts = np.sum([number.impacts for number in comparisons.values()], axis=0)
    causes = Counter(
        next(e.kind if e.kind == "held" else f"impact, {e.admissible} admissible"
             for e in run.events if e.admissible != 1)
        for run in runs if math.isfinite(run.unique_until)
    )  # fmt: skip
    return {
        "seed": seed,
        "records": random_scenes.records_available(),
        "scenes": len(comparisons),
        "agree": int(np.sum(differences < AGREES)),
        "median": float(f"{np.median(differences):.1e}"),
        "worst": float(f"{differences.max():.1e}"),
        "uplifting": sum(len(run.events) > 0 for run in runs),
        "overturning": sum(run.overturned for run in runs),
        "in flight": sum(any("none" in e.after for e in run.events) for run in runs),
        "events": sum(len(run.events) for run in runs),
        "impacts": int(impacts[0]),
        "impacts found in both": int(impacts[1]),
        "unique to the end": len(unique),
        "no longer unique by": dict(causes),
        "verdicts agree where unique": sum(number.same_verdict for number in unique),
        "verdicts agree": sum(number.same_verdict for number in comparisons.values()),
        "worst energy balance": float(f"{max(run.imbalance for run in runs):.0e}"),
        "beyond": [number for number, each in comparisons.items() if each.difference >= AGREES],
    }


def print_difference(number: int, comparison: Compared) -> None:
    """Print a line on a scene that differs."""
    if comparison.difference >= AGREES or (comparison.unique and not comparison.same_verdict):
        print(
            number,
            f"{comparison.difference:.1e}",
            "unique" if comparison.unique else comparison.reference.unique_until,
            comparison.reference.overturned,
            bool(comparison.package["overturned"]),
            flush=True,
        )


def main() -> None:
    """Run the comparison requested on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--replay", type=int, nargs="+", help="numbers of scenes to repeat")
    parser.add_argument(
        "--json", type=Path, default=ROOT / "docs" / "data" / "rigid_pair_oracle.json"
    )
    options = parser.parse_args()
    if not random_scenes.records_available():
        print("no recorded motions (set ROCKFRAME_RECORDS)")
        return
    table = table_of(options.seed, options.replay or range(options.scenes))
    print(json.dumps(table, indent=1))
    if not options.replay:
        options.json.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
