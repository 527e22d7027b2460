"""Random blocks that slide and rock: against a reference model, and many runs that must finish.

Run as ``python tests/benchmarks/sliding.py`` with the repository on the path; writes
docs/data/sliding.json.
"""

import argparse
import json
import sys
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests")]

from reference_models.sliding import (  # noqa: E402
    compare,
    draw,
    draw_on_base,
    draw_tied,
    draw_tied_on_base,
    draw_walled,
    draw_walled_on_base,
)

import rockframe as rf  # noqa: E402
from rockframe.errors import AssemblyError  # noqa: E402

SEED = 30
CASES, SCALES = 200, 20  # of each scene, and scales among them
AGREES = 1e-6  # of the overturning angle, and of the peak slip or a millimetre


def compare_scenes(count, draw, seed):
    """Compare scenes with the reference model."""
    comparisons, refused, endless = {}, [], []
    for k in range(count):
        try:
            comparisons[k] = compare(draw(np.random.default_rng([seed, k])))
        except AssemblyError:  # bases are too soft to stand on
            refused.append(k)
        except RuntimeError:  # the reference alternates endlessly between two modes
            endless.append(k)
    return summary(comparisons, refused, endless)


def summary(comparisons, refused, endless):
    """Summarise the agreement of scenes, and list those that the reference does not finish."""
    numbers, comparisons = list(comparisons), list(comparisons.values())
    same = [
        [kind for _, kind in comparison["ours"]] == [kind for _, kind in comparison["theirs"]]
        for comparison in comparisons
    ]
    differences = [
        max(comparison["peak"], comparison["slip"] / max(comparison["slips"], 1e-3))
        for comparison in comparisons
    ]
    return {
        "scenes": len(comparisons),
        "refused": refused,
        **({"without end in the reference": endless} if endless else {}),
        "agree": sum(
            comparison and far <= AGREES for comparison, far in zip(same, differences, strict=True)
        ),
        "events in the same order": sum(same),
        "median": float(f"{np.median(differences):.2g}"),
        "worst": float(f"{max(differences):.2g}"),
        "worst energy balance": float(
            f"{max(comparison['balance'] for comparison in comparisons):.2g}"
        ),
        "slide": sum(comparison["slips"] > 0.0 for comparison in comparisons),
        "rock": sum(comparison["rotates"] > 0.0 for comparison in comparisons),
        "fly": sum(comparison["flies"] for comparison in comparisons),
        "overturn": sum(comparison["overturned"] for comparison in comparisons),
        "events": sum(len(comparison["ours"]) for comparison in comparisons),
        "beyond": [
            k
            for k, comparison, far in zip(numbers, same, differences, strict=True)
            if not (comparison and far <= AGREES)
        ],
    }


def draw_rough_motion(rng, size):
    """Draw a motion with jumps, high frequencies, or upward throws."""
    count = int(rng.integers(50, 250))
    width = int(rng.choice([1, 1, 5, 20]))
    across, upwards = (
        np.convolve(rng.normal(size=count), np.ones(width) / width, "same") * width**0.5
        for _ in "xy"
    )
    if rng.random() < 0.2:
        across = size * np.sign(across) * np.ones(count)  # a rectangle up to its end
    up = float(rng.choice([0.0, 0.3, 1.5])) * 9.81 * upwards
    vertical = {"vertical": (up, "m/s^2")} if up.any() else {}
    return rf.GroundMotion.from_arrays((size * across, "m/s^2"), "0.02 s", **vertical)


def draw_rough_scene(rng):
    """Draw a scene and arguments of a run that only has to finish."""
    scene = draw(rng)
    friction = scene.system.parts.ground.si
    ground = {"friction": friction.friction, "kinetic_friction": friction.kinetic_friction}
    chance = rng.random()
    if chance < 0.05:
        ground = {"friction": 0.0}
    elif chance < 0.1:
        ground = {"friction": 1e6, "kinetic_friction": 0.9}
    if rng.random() < 0.2:
        ground["restitution"] = float(rng.uniform(0.3, 1.0))
    if rng.random() < 0.2:
        ground["impact"] = "stick"
    block = scene.system.parts.block
    slope = "0 rad" if not ground["friction"] else scene.system.inclination
    system = rf.System(block, rf.RigidGround(**ground), inclination=slope)
    least = min(block.si.left, block.si.right) / block.si.centre_height
    size = float(rng.uniform(0.3, 4.0)) * min(least, max(friction.friction, 0.2)) * 9.81
    arguments = {"accuracy": str(rng.choice(["fast", "standard"])), "free_vibration": "2 s"}
    if scene.rotation:
        arguments["initial"] = rf.InitialState(rotation=f"{scene.rotation!r} rad")
    if rng.random() < 0.3:
        arguments["overturning"] = "continue"
    return system, draw_rough_motion(rng, size), arguments


def run_to_the_end(count):
    """Sweep scenes at `fast` and `standard`, and count how their runs end."""
    ends, levels, worst, failed = Counter(), Counter(), {}, []
    for k in range(count // CASES):
        system, motion, arguments = draw_rough_scene(np.random.default_rng([SEED + 1, k]))
        level = arguments["accuracy"]
        friction = system.parts.ground.si
        most = friction.friction if friction.kinetic_friction is None else friction.kinetic_friction
        runs = rf.sweep(
            system, motion, scale=np.geomspace(0.2, 3.0, SCALES),
            kinetic_friction=np.unique(np.linspace(0.0, most, CASES // SCALES)), **arguments,
        )  # fmt: skip
        names = str(runs.status.attrs["flag_meanings"]).split()
        values = list(runs.status.attrs["flag_values"])
        counts = Counter(names[values.index(one)] for one in runs.status.to_numpy().ravel())
        ends.update(counts)
        levels[level] += int(runs.status.size)
        worst[level] = max(worst.get(level, 0.0), float(runs.energy_residual.max()))
        if set(counts) - {"completed", "overturned", "toppled"}:
            failed.append(k)
    return {
        "runs": sum(levels.values()),
        "of them at": dict(levels),
        "ended as": dict(ends),
        "worst energy balance": {level: float(f"{one:.2g}") for level, one in worst.items()},
        "to be looked at": failed,
    }


def main():
    """Run all comparisons and write their results."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--on-bases", type=int, default=60, help="scenes on pads and beds")
    parser.add_argument("--tied", type=int, default=200, help="scenes on rigid ground with ties")
    parser.add_argument("--tied-on-bases", type=int, default=100, help="on pads and beds")
    parser.add_argument("--walled", type=int, default=300, help="before elastic walls")
    parser.add_argument("--walled-on-bases", type=int, default=300, help="on pads and beds")
    parser.add_argument("--runs", type=int, default=20_000)
    parser.add_argument("--json", type=Path, default=ROOT / "docs" / "data" / "sliding.json")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    # results not requested are kept
    results = json.loads(options.json.read_text()) if options.json.exists() else {}
    results |= {"seed": SEED}
    parts = {
        "until the end": (options.runs, run_to_the_end, ()),
        "against a monolith": (options.scenes, compare_scenes, (draw, SEED)),
        "on pads and beds": (options.on_bases, compare_scenes, (draw_on_base, SEED + 1)),
        "with ties": (options.tied, compare_scenes, (draw_tied, SEED + 10)),
        "with ties on pads and beds": (
            options.tied_on_bases, compare_scenes, (draw_tied_on_base, SEED + 11),
        ),
        "before elastic walls": (options.walled, compare_scenes, (draw_walled, SEED + 20)),
        "before elastic walls on pads and beds": (
            options.walled_on_bases, compare_scenes, (draw_walled_on_base, SEED + 21),
        ),
    }  # fmt: skip
    for name, (count, run, arguments) in parts.items():
        if count:
            results[name] = run(count, *arguments)
            text = json.dumps(results, indent=1, default=int)  # counts of NumPy among them
            options.json.write_text(text + "\n", encoding="utf-8")
            print(json.dumps({name: results[name]}, indent=1, default=int), flush=True)


if __name__ == "__main__":
    main()
