"""Random scenes of walls, frames and tendons: none may end otherwise than by its verdict.

Run from the root, with ``PYTHONPATH=.``:
``python tests/benchmarks/random_parts.py --runs 10000 --json docs/data/random_parts.json``.
"""

import argparse
import json
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

import rockframe as rf

GRAVITY = 9.80665
PARTS = ("stiff wall", "frame", "frame with tendons")


def drawn(part, rng):
    """Give a random scene of a part, and a motion."""
    height = rng.uniform(1.0, 12.0)
    width = height / rng.uniform(1.6, 12.0)
    block = rf.Block(width=f"{width} m", height=f"{height} m", mass="2 t")
    if part == "stiff wall":
        side = str(rng.choice(["left", "right"]))
        system = rf.System(block, rf.RearWall(side=side, restitution=rng.uniform(-1.0, 0.0)))
    else:
        columns = int(rng.integers(2, 6))
        frame = rf.RockingFrame(block, columns=columns, beam_mass=f"{rng.uniform(0.0, 40.0)} t")
        weight = 2e3 * GRAVITY
        stiffness = weight / width * 10.0 ** rng.uniform(-3.0, 2.0)
        preload = weight * rng.choice([0.0, rng.uniform(0.01, 2.0)])
        given = {"preload": f"{preload} N"} if preload else {}
        if rng.random() < 0.6:
            given |= {"strength": f"{preload + weight * rng.uniform(0.01, 1.0)} N"}
            given["brittle"] = bool(rng.random() < 0.5)
        tendons = [rf.Tendon(stiffness=f"{stiffness} N/m", **given)]
        system = rf.System(frame, *(tendons if part == "frame with tendons" else []))
    noise = np.convolve(rng.normal(size=80), np.hanning(rng.integers(5, 25)), "same")
    noise *= GRAVITY * width / height * rng.uniform(0.8, 5.0) / np.abs(noise).max()
    return system, rf.GroundMotion.from_arrays((noise, "m/s^2"), time_step="0.04 s")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=2000)
    parser.add_argument("--seconds", type=float, default=np.inf, help="of each part and accuracy")
    parser.add_argument("--json", type=Path)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    table = {}
    for part in PARTS:
        for accuracy in ("fast", "standard"):
            begun, ends, worst, count = time.monotonic(), Counter(), 0.0, 0
            while count < given.runs and time.monotonic() < begun + given.seconds:
                system, motion = drawn(part, np.random.default_rng(count))
                try:
                    run = system.simulate(motion, accuracy=accuracy, outputs=("energy",))
                    ends[f"status {int(run.status)}"] += 1
                    worst = max(worst, float(run.energy_residual))
                except Exception as fault:
                    ends[type(fault).__name__] += 1
                    print(part, accuracy, count, fault, flush=True)
                count += 1
            table[f"{part}, {accuracy}"] = {
                "runs": count, "ends": dict(ends), "worst energy balance": float(f"{worst:.2g}"),
            }  # fmt: skip
    if given.json:
        given.json.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(table, indent=1))


if __name__ == "__main__":
    main()
