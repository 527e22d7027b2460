"""Cost of a run over its length, stiffness of pads, dashpots, number of impacts, and model.

``python tests/benchmarks/cost_model.py`` measures and writes ``docs/data/cost_model.json``, from
which the manual draws its figure. Times are processor times of whole calls without histories,
the least of several.
"""

import json
import math
import sys
import warnings
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from benchmarks.five_scenes import GRAVITY, scenes
from benchmarks.stability import longest_step, rates_on_pads
from benchmarks.timing import cost, machine

import rockframe as rf
from rockframe.errors import ModelWarning

DATA = Path(__file__).parents[2] / "docs" / "data" / "cost_model.json"
LENGTHS = (10.0, 30.0, 100.0, 300.0, 1000.0, 3600.0)
FACTORS = (0.5, 0.7, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4)
LEVELS = ("fast", "standard", "reference")
RATIOS = (1.5, 2.0, 3.0, 6.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1e3, 2e3, 5e3, 1e4)
DAMPING = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
HARD = 1000.0
BLOCKS = {
    "rocks": {"half_width": 2.0, "half_height": 9.0},
    "stands": {"half_width": 2.0, "half_height": 2.0},
}
"""A slender block that rocks, and a squat one that stands even on pads of frequency ratio 1.5."""
SOFTEST = 6.0
"""Frequency ratio below which the slender block does not stand upright."""
WINDOW = ("5 s", "13 s")


def excitation() -> rf.GroundMotion:
    """Return the full, unscaled motion of the five scenes."""
    return rf.GroundMotion.stochastic(
        6.8, "5 km", seed=29, stress_drop="20 MPa", source="one corner"
    )


def measured(system: rf.System, motion: rf.GroundMotion, accuracy, repeats: int) -> dict:
    """Time a run without histories; return its time and counts."""

    def run():
        return system.simulate(motion, accuracy=accuracy, outputs=None, overturning="continue")

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        found = run()
        return {
            "time": cost(run, repeats),
            "steps": int(found.attrs["solver_steps"]),
            "rejected": int(found.attrs["solver_rejected_steps"]),
            "events": int(found.sizes["event"]),
            "impacts": int(found["impact_count"]),
            "end": float(found.attrs["solver_end_time"]),
        }


def over_lengths() -> dict:
    """Repeat the motion until it is long enough, in the five scenes."""
    one = excitation()
    step, samples = one.si.time_step, one.si.horizontal.samples
    rows: dict[str, list[dict]] = {name: [] for name in scenes()}
    for length in LENGTHS:
        count = round(length / step) + 1
        long = rf.GroundMotion.from_arrays((np.resize(samples, count), "m/s^2"), f"{step} s")
        for name, scene in scenes().items():
            repeats = 9 if length <= 100.0 else 3
            row = measured(scene.system, long, "standard", repeats)
            rows[name].append({"length": length, "samples": count, **row})
            print(name, rows[name][-1], flush=True)
    return rows


def over_impacts() -> dict:
    """Scale the motion for different numbers of events in the same length."""
    rows: dict[str, list[dict]] = {name: [] for name in scenes()}
    for factor in FACTORS:
        motion = excitation().scaled(factor)
        for name, scene in scenes().items():
            row = measured(scene.system, motion, "standard", 9)
            if row["end"] > 0.999 * motion.si.time_step * (len(motion) - 1):
                rows[name].append({"factor": factor, "samples": len(motion), **row})
    return rows


def on_pads(
    block: str,
    frequency_ratio: float,
    damping_ratio: float,
    level: str | rf.Accuracy,
    motion: rf.GroundMotion,
) -> dict:
    """Measure a block on pads, and the number of steps that stability requires."""
    size = BLOCKS[block]
    width, height = 2.0 * size["half_width"], 2.0 * size["half_height"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        system = rf.System(
            rf.Block(width=f"{width} m", height=f"{height} m", mass="99 t"),
            rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=damping_ratio),
        )
    rates = rates_on_pads(
        **size, frequency_ratio=frequency_ratio, damping_ratio=damping_ratio, gravity=GRAVITY
    )
    step, count = motion.si.time_step, len(motion) - 1
    stable = longest_step(rates)
    row = measured(system, motion, level, 5 if frequency_ratio <= 1e3 else 3)
    return {
        "block": block,
        "frequency_ratio": frequency_ratio,
        "damping_ratio": damping_ratio,
        "level": level if isinstance(level, str) else "own",
        "samples": count + 1,
        "fastest_rate": max(abs(rate) for rate in rates),
        "stable_step": stable,
        "stable_steps": count * math.ceil(step / stable),
        **row,
    }


def over_limits() -> list[dict]:
    """Loosen the least number of steps per period, on the hardest pads.

    The settings refuse fewer than six; lifting that bound shows the error control alone.
    """
    motion = excitation().scaled(2.0).window(*WINDOW)
    rows = []
    for level, rtol in (("fast", 1e-4), ("standard", 2e-8)):
        for steps_per_period in (20.0, 10.0, 6.0, 4.0, 2.5, 1.0):
            accuracy = rf.Accuracy(rtol=rtol)
            object.__setattr__(accuracy, "steps_per_period", steps_per_period)
            row = on_pads("rocks", RATIOS[-1], 0.1, accuracy, motion)
            rows.append(row | {"level": level, "steps_per_period": steps_per_period})
    return rows


def over_stiffness() -> list[dict]:
    """Harden the pads, at every level."""
    motion = excitation().scaled(2.0).window(*WINDOW)
    return [
        on_pads(block, ratio, 0.1, level, motion)
        for block in BLOCKS
        for level in LEVELS
        for ratio in RATIOS
        if block == "stands" or ratio >= SOFTEST
    ]


def over_damping() -> list[dict]:
    """Damp hard pads until the dashpots' rate is the fastest."""
    motion = excitation().scaled(2.0).window(*WINDOW)
    return [
        on_pads("rocks", HARD, damping, level, motion) for level in LEVELS for damping in DAMPING
    ]


def main() -> None:
    """Measure all and write the data."""
    data = {
        "machine": machine(),
        "lengths": over_lengths(),
        "impacts": over_impacts(),
        "stiffness": over_stiffness(),
        "damping": over_damping(),
        "limits": over_limits(),
    }
    DATA.parent.mkdir(exist_ok=True)
    DATA.write_text(json.dumps(data, indent=1) + "\n")


if __name__ == "__main__":
    main()
