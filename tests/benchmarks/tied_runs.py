"""Random scenes with restrainers; no run may end by chatter, step limit or error.

Run from the root as ``PYTHONPATH=.:tests python tests/benchmarks/tied_runs.py``; writes
docs/data/tied_runs.json.
"""

import argparse
import json
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

import rockframe as rf
from rockframe.errors import RockframeError

DATA = Path(__file__).resolve().parents[2] / "docs" / "data" / "tied_runs.json"
SEED = 31
GRAVITY = 9.80665


def draw_blocks(rng):
    """Draw one to three blocks, from the top down."""
    blocks, width = [], float(rng.uniform(0.4, 1.5))
    for _ in range(int(rng.choice([1, 1, 1, 2, 2, 3]))):
        height = width * float(rng.uniform(0.7, 5.0))
        blocks.insert(0, (width, height, 2000.0 * width * height))
        width *= float(rng.uniform(0.6, 1.0))
    return blocks


def draw_base(rng, last):
    """Draw the base of a body."""
    kind = rng.choice(["rigid", "rigid", "pads", "soil"] if last else ["rigid", "pads"])
    if kind == "rigid":
        return rf.RigidGround()
    if kind == "pads":
        ratio, damping = float(rng.uniform(10.0, 60.0)), float(rng.uniform(0.0, 0.3))
        return rf.TwoSpringSupport(frequency_ratio=ratio, damping_ratio=damping)
    return rf.WinklerSoil(stiffness=f"{10.0 ** rng.uniform(7.0, 9.0)} Pa", damping_ratio=0.1)


def draw_tie(rng, blocks):
    """Draw a restrainer, of a stiffness from negligible to a million times that."""
    on = int(rng.integers(len(blocks)))
    others = [None, *(k for k in range(len(blocks)) if k != on)]
    to = others[int(rng.integers(len(others)))]
    width, height, _ = blocks[on]
    side = float(rng.choice([-0.5, 0.5]))
    weight = GRAVITY * sum(mass for _, _, mass in blocks)
    stiffness = weight / height * 10.0 ** float(rng.uniform(-1.0, 3.0))
    if rng.random() < 0.1:
        stiffness = weight / height * 1e6
    options = {"stiffness": f"{stiffness!r} N/m"}
    if rng.random() < 0.25:
        options["compression"] = True
    elif rng.random() < 0.5:
        options["slack"] = f"{float(rng.choice([0.0, 1e-9, 1e-3, 1e-2, 1e3])) * width!r} m"
    elif rng.random() < 0.3:
        options["preload"] = f"{0.05 * weight!r} N"
    if rng.random() < 0.5 and "preload" not in options:
        options["strength"] = f"{weight * 10.0 ** float(rng.uniform(-2.0, 1.0))!r} N"
        options["brittle"] = bool(rng.random() < 0.5)
    if rng.random() < 0.4:
        mass = blocks[on][2]
        options["damping"] = f"{0.05 * float(np.sqrt(stiffness * mass))!r} N s/m"
    point = (f"{side * width!r} m", f"{height * float(rng.uniform(0.0, 1.0))!r} m")
    if to is None and rng.random() < 0.2 and "preload" not in options and on == len(blocks) - 1:
        point = other_end = (f"{side * width!r} m", "0 m")  # of no length, under a corner
    elif to is None:
        other_end = (f"{side * 3.0 * width!r} m", f"{height * float(rng.uniform(0.0, 1.0))!r} m")
    else:
        other, up, _ = blocks[to]
        options["to_body"] = to + 1
        other_end = (f"{-side * other!r} m", f"{up * float(rng.uniform(0.0, 1.0))!r} m")
    return rf.Restrainer(on=point, to=other_end, on_body=on + 1, **options)


def draw_motion(rng, size):
    """Draw a motion with jumps, high frequencies, or upward throws."""
    count, width = int(rng.integers(50, 250)), int(rng.choice([1, 1, 5, 20]))
    across, upwards = (
        np.convolve(rng.normal(size=count), np.ones(width) / width, "same") * width**0.5
        for _ in "xy"
    )
    up = float(rng.choice([0.0, 0.3, 1.5])) * GRAVITY * upwards
    vertical = {"vertical": (up, "m/s^2")} if up.any() else {}
    return rf.GroundMotion.from_arrays((size * across, "m/s^2"), "0.02 s", **vertical)


def draw_scene(number):
    """Draw a scene, a motion, and the arguments of its run."""
    rng = np.random.default_rng([SEED, number])
    blocks = draw_blocks(rng)
    parts = [rf.Block(width=f"{w!r} m", height=f"{h!r} m", mass=f"{m!r} kg") for w, h, m in blocks]
    base = draw_base(rng, last=True)
    standing = parts[0]
    if len(parts) > 1:
        under = [draw_base(rng, last=False) for _ in parts[1:]]
        standing = rf.Stack(*parts, interfaces=under)
    ties = [draw_tie(rng, blocks) for _ in range(int(rng.integers(1, 4)))]
    least = min(w / h for w, h, _ in blocks)
    motion = draw_motion(rng, float(rng.uniform(0.3, 3.0)) * least * GRAVITY)
    arguments = {"accuracy": str(rng.choice(["fast", "standard"])), "free_vibration": "1 s"}
    if rng.random() < 0.2 and len(parts) == 1:
        angle = float(rng.uniform(-0.4, 0.4)) * least
        arguments["initial"] = rf.InitialState(rotation=f"{angle!r} rad")
    if rng.random() < 0.3:
        arguments["overturning"] = "continue"
    return rf.System(standing, base, *ties), motion, arguments


def run(number):
    """Run a scene; return its accuracy level, its end and its energy residual."""
    try:
        system, motion, arguments = draw_scene(number)
    except RockframeError as refused:
        return "refused", str(refused).splitlines()[-1], 0.0
    try:
        response = system.simulate(motion, **arguments)
    except RockframeError as refused:
        return "refused", str(refused).splitlines()[-1], 0.0
    status = response.status
    names = str(status.attrs["flag_meanings"]).split()
    ended = names[list(status.attrs["flag_values"]).index(int(status))]
    return arguments["accuracy"], ended, float(response.energy_residual)


def summary(runs, refused):
    """Count runs by their end."""
    balance = {}
    for _, level, _, residual in runs:
        balance.setdefault(level, []).append(residual)
    usual = ("completed", "overturned", "toppled")
    return {
        "seed": SEED,
        "runs": len(runs),
        "of them at": dict(Counter(level for _, level, _, _ in runs)),
        "ended as": dict(Counter(ended for _, _, ended, _ in runs)),
        "refused": dict(refused),
        "median energy balance": {k: float(f"{np.median(v):.2g}") for k, v in balance.items()},
        "worst energy balance": {k: float(f"{max(v):.2g}") for k, v in balance.items()},
        "to be looked at": [number for number, _, ended, _ in runs if ended not in usual],
    }


def main():
    """Run scenes and write their ends."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=2400)
    parser.add_argument("--replay", type=int, nargs="+")
    parser.add_argument("--json", type=Path, default=DATA)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    runs, refused = [], Counter()
    for number in options.replay or range(options.runs):
        try:
            level, ended, residual = run(number)
        except Exception as fault:
            level, ended, residual = "error", f"{type(fault).__name__}: {fault}", 0.0
        if level == "refused":
            refused[ended] += 1
        else:
            runs.append((number, level, ended, residual))
        if runs and summary(runs[-1:], {})["to be looked at"] and level != "refused":
            print(number, level, ended, flush=True)
        if number % 100 == 99 and not options.replay:
            text = json.dumps(summary(runs, refused), indent=1)
            options.json.write_text(text + "\n", encoding="utf-8")
    print(json.dumps(summary(runs, refused), indent=1))


if __name__ == "__main__":
    main()
