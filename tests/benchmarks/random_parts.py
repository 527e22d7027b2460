"""Random scenes of walls, frames, tendons, friction and stacks; every run must reach a verdict.

Run from the root, with ``PYTHONPATH=.``:
``python tests/benchmarks/random_parts.py --json docs/data/random_parts.json``; `--parts` for some.
"""

import argparse
import json
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

import rockframe as rf
from rockframe.errors import AssemblyError

GRAVITY = 9.80665
COMPLETE = 2  # the last status of finished runs: completed, overturned, toppled
PARTS = (
    "stiff wall", "frame", "frame with tendons", "friction on pads", "friction on soil",
    "elastic wall on rigid ground", "elastic wall on pads", "stack of mixed bases",
    "stack of squat bodies", "stack with friction of any size",
)  # fmt: skip
BASES = ("rigid ground", "pads", "soil")
RUNS = 10_000
NOT_UNIQUE = ("impacts_of_several_modes", "impacts_of_no_mode", "corners_held_without_pressing")


def draw_base(on, friction, rng):
    """Return a random base, with friction or without."""
    if on == "rigid ground":
        return rf.RigidGround(**friction)
    if on == "pads":
        return rf.TwoSpringSupport(
            frequency_ratio=rng.uniform(8.0, 40.0), damping_ratio=rng.uniform(0.0, 0.4), **friction
        )
    stiffness = f"{10.0 ** rng.uniform(5.5, 8.0)} Pa"
    return rf.WinklerSoil(stiffness=stiffness, damping_ratio=rng.uniform(0.0, 0.4), **friction)


def draw_friction(width, height, rng):
    """Return random coefficients, half of them near the limit between sliding and rocking."""
    static = rng.choice([rng.uniform(0.02, 1.0), width / height * rng.uniform(0.6, 1.5)])
    return {"friction": static, "kinetic_friction": min(static * rng.uniform(0.5, 1.0), 0.6)}


def draw_wall(width, height, rng):
    """Return a random elastic wall behind a block of 2 t."""
    stiffness = 2e3 * GRAVITY / height * 10.0 ** rng.uniform(0.0, 4.0)
    side, damped = str(rng.choice(["left", "right"])), rng.random() < 0.7
    damping = rng.uniform(0.0, 0.3) * np.sqrt(stiffness * 2e3) * damped
    gap = width * rng.choice([0.0, 10.0 ** rng.uniform(-4.0, -1.0)])
    return rf.RearWall(
        side=side, stiffness=f"{stiffness} N/m", damping=f"{damping} N s/m", gap=f"{gap} m",
        height=f"{height * rng.uniform(0.2, 1.0)} m",
    )  # fmt: skip


def draw_stack(width, height, rng, counts=(2, 2, 3), kinds=BASES, friction=None):
    """Return stacked blocks, each with its own kind of base."""
    shares = rng.dirichlet(np.full(int(rng.choice(counts)), 4.0))
    blocks, bases = [], []
    for share in shares:  # from the ground up
        blocks.insert(0, rf.Block(
            width=f"{width} m", height=f"{max(share * height, 0.75 * width)} m",
            mass=f"{2e3 * share} kg",
        ))  # fmt: skip
        slips = friction
        if slips is None:
            slips = draw_friction(width, height, rng) if rng.random() < 0.7 else {}
        on = str(rng.choice([one for one in kinds if one != "soil" or not bases]))
        bases.insert(0, draw_base(on, slips, rng))
        width *= rng.uniform(0.5, 1.0)
    body = rf.Stack(*blocks, interfaces=bases[:-1]) if len(blocks) > 1 else blocks[0]
    return rf.System(body, bases[-1])


def draw_squat_stack(rng):
    """Return a stack of two or three bodies with friction, most of them too squat to rock."""
    width, blocks, bases = rng.uniform(0.5, 3.0), [], []
    for _ in range(int(rng.choice([2, 2, 3]))):  # from the ground up
        low, high = (0.1, 0.7) if rng.random() < 0.7 else (0.75, 4.0)
        height = width * rng.uniform(low, high)
        blocks.insert(0, rf.Block(
            width=f"{width} m", height=f"{height} m", mass=f"{2e3 * width * height} kg"
        ))  # fmt: skip
        kinds = ["rigid ground", "pads"] if bases else ["rigid ground", "pads", "soil"]
        static = 10.0 ** rng.uniform(-2.0, 0.3)
        friction = {
            "friction": static, "kinetic_friction": min(static * rng.uniform(0.5, 1.0), 0.6)
        }  # fmt: skip
        bases.insert(0, draw_base(str(rng.choice(kinds)), friction, rng))
        width *= rng.uniform(0.4, 1.0)
    return rf.System(rf.Stack(*blocks, interfaces=bases[:-1]), bases[-1])


def draw_scene(part, rng):
    """Return a random scene of a part, and a motion."""
    height = rng.uniform(1.0, 12.0)
    width = height / rng.uniform(1.6, 12.0)
    block = rf.Block(width=f"{width} m", height=f"{height} m", mass="2 t")
    if part == "stiff wall":
        side = str(rng.choice(["left", "right"]))
        system = rf.System(block, rf.RearWall(side=side, restitution=rng.uniform(-1.0, 0.0)))
    elif part == "stack of mixed bases":
        system = draw_stack(width, height, rng)
    elif part == "stack of squat bodies":
        system = draw_squat_stack(rng)
    elif part == "stack with friction of any size":
        friction = {"friction": 10.0 ** rng.uniform(-12.0, 12.0)}
        system = draw_stack(width, height, rng, (1, 2, 3), BASES[1:], friction)
    elif " on " in part:
        what, on = part.split(" on ")
        slides = what == "friction" or rng.random() < 0.5
        friction = draw_friction(width, height, rng) if slides else {}
        walls = [draw_wall(width, height, rng)] if what == "elastic wall" else []
        system = rf.System(block, draw_base(on, friction, rng), *walls)
    else:
        columns = int(rng.integers(2, 6))
        frame = rf.RockingFrame(block, columns=columns, beam_mass=f"{rng.uniform(0.0, 40.0)} t")
        weight = 2e3 * GRAVITY
        stiffness = weight / width * 10.0 ** rng.uniform(-3.0, 2.0)
        preload = weight * rng.choice([0.0, rng.uniform(0.01, 2.0)])
        tendon_options = {"preload": f"{preload} N"} if preload else {}
        if rng.random() < 0.6:
            tendon_options |= {"strength": f"{preload + weight * rng.uniform(0.01, 1.0)} N"}
            tendon_options["brittle"] = bool(rng.random() < 0.5)
        tendons = [rf.Tendon(stiffness=f"{stiffness} N/m", **tendon_options)]
        system = rf.System(frame, *(tendons if part == "frame with tendons" else []))
    noise = np.convolve(rng.normal(size=80), np.hanning(rng.integers(5, 25)), "same")
    noise *= GRAVITY * width / height * rng.uniform(0.8, 5.0) / np.abs(noise).max()
    if not (" on " in part or part.startswith("stack")) or rng.random() < 0.5:
        return system, rf.GroundMotion.from_arrays((noise, "m/s^2"), time_step="0.04 s")
    up = (rng.uniform(0.1, 1.5) * GRAVITY * rng.normal(size=80), "m/s^2")
    motion = rf.GroundMotion.from_arrays((noise, "m/s^2"), time_step="0.04 s", vertical=up)
    return system, motion


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=RUNS, help="of each part and accuracy")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--seconds", type=float, default=np.inf, help="of each part and accuracy")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    # results of other parts are kept
    known = options.json is not None and options.json.exists()
    table = json.loads(options.json.read_text(encoding="utf-8")) if known else {}
    for part in options.parts:
        for accuracy in ("fast", "standard"):
            start, ends, worst, count = time.monotonic(), Counter(), 0.0, 0
            unsure = Counter()
            while count < options.runs and time.monotonic() < start + options.seconds:
                try:
                    system, motion = draw_scene(part, np.random.default_rng(count))
                    run = system.simulate(motion, accuracy=accuracy, outputs=("energy",))
                    ends[f"status {int(run.status)}"] += 1
                    if int(run.status) > COMPLETE:
                        print(part, accuracy, count, run.attrs["verdict"], flush=True)
                    worst = max(worst, float(run.energy_residual))
                    unsure += Counter({name: run.attrs.get(name, 0) > 0 for name in NOT_UNIQUE})
                except AssemblyError:  # the pads are too soft to stand on
                    ends["refused"] += 1
                except Exception as fault:
                    ends[type(fault).__name__] += 1
                    print(part, accuracy, count, fault, flush=True)
                count += 1
            table[f"{part}, {accuracy}"] = {
                "runs": count, "ends": dict(ends), "worst energy balance": float(f"{worst:.2g}"),
                **({"runs that tell of": dict(unsure)} if unsure else {}),
            }  # fmt: skip
            if options.json:
                options.json.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(table, indent=1))


if __name__ == "__main__":
    main()
