"""Outcomes of random columns of drums, many thrown upwards or falling with their ground.

Run from the root, with ``PYTHONPATH=.``: ``python tests/benchmarks/columns_of_drums.py``; writes
docs/data/columns_of_drums.json.
"""

import argparse
import json
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

import rockframe as rf

DATA = Path(__file__).resolve().parents[2] / "docs" / "data" / "columns_of_drums.json"
SEED = 77
GRAVITY = 9.80665
RUNS = 500
COMPLETE = 2  # the last status of finished runs: completed, overturned, toppled


def draw_scene(number):
    """Draw three to seven drums, half of their joints with friction, and a motion."""
    rng = np.random.default_rng([SEED, number])
    count, width, drums, height = int(rng.integers(3, 8)), float(rng.uniform(0.6, 1.6)), [], 0.0
    foot = width
    for _ in range(count):
        tall = width * float(rng.uniform(0.75, 1.8))
        size = {"width": f"{width!r} m", "height": f"{tall!r} m"}
        drums.insert(0, rf.Block(**size, mass=f"{2000 * width * tall!r} kg"))
        height += tall
        width *= float(rng.uniform(0.9, 1.0))
    joints = [
        rf.RigidGround(**({} if rng.random() < 0.5 else {"friction": float(rng.uniform(0.3, 0.9))}))
        for _ in range(count)
    ]
    across = noise(rng, int(rng.integers(5, 25)))
    across *= float(rng.uniform(0.5, 4.0)) * GRAVITY * foot / height
    upwards = str(rng.choice(["none", "some", "weightless", "weightless"]))
    vertical = {}
    if upwards != "none":
        most = 0.5 if upwards == "some" else float(rng.uniform(0.95, 1.3))
        up = most * GRAVITY * noise(rng, int(rng.integers(3, 15)))
        vertical = {"vertical": (up, "m/s^2")}
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), time_step="0.04 s", **vertical)
    return rf.System(rf.Stack(*drums, interfaces=joints[:-1]), joints[-1]), motion


def noise(rng, width):
    """Draw noise of a peak of 1, smoothed over so many of its 80 samples."""
    smoothed = np.convolve(rng.normal(size=80), np.hanning(width), "same")
    return smoothed / np.abs(smoothed).max()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--replay", type=int, nargs="+")
    parser.add_argument("--json", type=Path, default=DATA)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    ends, worst, unsettled, start = Counter(), 0.0, [], time.monotonic()
    for number in options.replay or range(options.runs):
        system, motion = draw_scene(number)
        run = system.simulate(motion, accuracy="standard", outputs=("energy",))
        ends[f"status {int(run.status)}"] += 1
        worst = max(worst, float(run.energy_residual))
        if int(run.status) > COMPLETE:
            unsettled.append(number)
            print(number, run.attrs["verdict"], flush=True)
    summary = {
        "seed": SEED, "runs": sum(ends.values()), "ends": dict(ends),
        "worst energy balance": float(f"{worst:.2g}"), "to be looked at": unsettled,
    }  # fmt: skip
    print(json.dumps(summary, indent=1), f"{time.monotonic() - start:.0f} s")
    if not options.replay:
        options.json.write_text(json.dumps(summary, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
