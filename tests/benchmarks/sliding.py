"""Random blocks that slide and rock: against a program of their own, and many that only must end.

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


def against_monolith(count, draw, seed):
    """Compare scenes with the reference model."""
    found, refused, endless = {}, [], []
    for k in range(count):
        try:
            found[k] = compare(draw(np.random.default_rng([seed, k])))
        except AssemblyError:  # bases too soft to stand on
            refused.append(k)
        except RuntimeError:  # the reference goes to and fro between two modes
            endless.append(k)
    return summary(found, refused, endless)


def summary(found, refused, endless):
    """Tell how scenes agree, by their numbers; and which the reference does not end."""
    numbers, found = list(found), list(found.values())
    same = [
        [kind for _, kind in one["ours"]] == [kind for _, kind in one["theirs"]] for one in found
    ]
    apart = [max(one["peak"], one["slip"] / max(one["slips"], 1e-3)) for one in found]
    return {
        "scenes": len(found),
        "refused": refused,
        **({"without end in the reference": endless} if endless else {}),
        "agree": sum(one and far <= AGREES for one, far in zip(same, apart, strict=True)),
        "events in the same order": sum(same),
        "median": float(f"{np.median(apart):.2g}"),
        "worst": float(f"{max(apart):.2g}"),
        "worst energy balance": float(f"{max(one['balance'] for one in found):.2g}"),
        "slide": sum(one["slips"] > 0.0 for one in found),
        "rock": sum(one["rotates"] > 0.0 for one in found),
        "fly": sum(one["flies"] for one in found),
        "overturn": sum(one["overturned"] for one in found),
        "events": sum(len(one["ours"]) for one in found),
        "beyond": [
            k
            for k, one, far in zip(numbers, same, apart, strict=True)
            if not (one and far <= AGREES)
        ],
    }


def rough_motion(rng, size):
    """A motion that jumps, rattles, or throws the block up."""
    count = int(rng.integers(50, 250))
    width = int(rng.choice([1, 1, 5, 20]))
    across, upwards = (
        np.convolve(rng.normal(size=count), np.ones(width) / width, "same") * width**0.5
        for _ in "xy"
    )
    if rng.random() < 0.2:
        across = size * np.sign(across) * np.ones(count)  # as a rectangle, to its end
    up = float(rng.choice([0.0, 0.3, 1.5])) * 9.81 * upwards
    vertical = {"vertical": (up, "m/s^2")} if up.any() else {}
    return rf.GroundMotion.from_arrays((size * across, "m/s^2"), "0.02 s", **vertical)


def rough(rng):
    """Draw a scene and a run of it that need only end."""
    scene = draw(rng)
    given = scene.system.parts.ground.si
    ground = {"friction": given.friction, "kinetic_friction": given.kinetic_friction}
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
    size = float(rng.uniform(0.3, 4.0)) * min(least, max(given.friction, 0.2)) * 9.81
    asked = {"accuracy": str(rng.choice(["fast", "standard"])), "free_vibration": "2 s"}
    if scene.rotation:
        asked["initial"] = rf.InitialState(rotation=f"{scene.rotation!r} rad")
    if rng.random() < 0.3:
        asked["overturning"] = "continue"
    return system, rough_motion(rng, size), asked


def until_the_end(count):
    """Sweep scenes at `fast` and `standard`, and count how their runs end."""
    ends, levels, worst, failed = Counter(), Counter(), {}, []
    for k in range(count // CASES):
        system, motion, asked = rough(np.random.default_rng([SEED + 1, k]))
        level = asked["accuracy"]
        given = system.parts.ground.si
        most = given.friction if given.kinetic_friction is None else given.kinetic_friction
        runs = rf.sweep(
            system, motion, scale=np.geomspace(0.2, 3.0, SCALES),
            kinetic_friction=np.unique(np.linspace(0.0, most, CASES // SCALES)), **asked,
        )  # fmt: skip
        names = str(runs.status.attrs["flag_meanings"]).split()
        values = list(runs.status.attrs["flag_values"])
        found = Counter(names[values.index(one)] for one in runs.status.to_numpy().ravel())
        ends.update(found)
        levels[level] += int(runs.status.size)
        worst[level] = max(worst.get(level, 0.0), float(runs.energy_residual.max()))
        if set(found) - {"completed", "overturned", "toppled"}:
            failed.append(k)
    return {
        "runs": sum(levels.values()),
        "of them at": dict(levels),
        "ended as": dict(ends),
        "worst energy balance": {level: float(f"{one:.2g}") for level, one in worst.items()},
        "to be looked at": failed,
    }


def main():
    """Run both, and write what came out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--on-bases", type=int, default=60, help="scenes on pads and beds")
    parser.add_argument("--tied", type=int, default=200, help="scenes on rigid ground with ties")
    parser.add_argument("--tied-on-bases", type=int, default=100, help="on pads and beds")
    parser.add_argument("--walled", type=int, default=300, help="before elastic walls")
    parser.add_argument("--walled-on-bases", type=int, default=300, help="on pads and beds")
    parser.add_argument("--runs", type=int, default=20_000)
    parser.add_argument("--json", type=Path, default=ROOT / "docs" / "data" / "sliding.json")
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    # what is not asked for stays
    found = json.loads(given.json.read_text()) if given.json.exists() else {}
    found |= {"seed": SEED}
    parts = {
        "until the end": (given.runs, until_the_end, ()),
        "against a monolith": (given.scenes, against_monolith, (draw, SEED)),
        "on pads and beds": (given.on_bases, against_monolith, (draw_on_base, SEED + 1)),
        "with ties": (given.tied, against_monolith, (draw_tied, SEED + 10)),
        "with ties on pads and beds": (
            given.tied_on_bases, against_monolith, (draw_tied_on_base, SEED + 11),
        ),
        "before elastic walls": (given.walled, against_monolith, (draw_walled, SEED + 20)),
        "before elastic walls on pads and beds": (
            given.walled_on_bases, against_monolith, (draw_walled_on_base, SEED + 21),
        ),
    }  # fmt: skip
    for name, (count, run, arguments) in parts.items():
        if count:
            found[name] = run(count, *arguments)
            text = json.dumps(found, indent=1, default=int)  # counts of NumPy among them
            given.json.write_text(text + "\n", encoding="utf-8")
            print(json.dumps({name: found[name]}, indent=1, default=int), flush=True)


if __name__ == "__main__":
    main()
