"""Print the table of the page "Accuracy": wrong runs at "fast", and how many report it.

From the root of the repository: ``python tests/benchmarks/fast_verdicts.py``. Random scenes run at
"fast" with the second look and at "reference". Short scenes are those of the pages on extremes
and certificates; long ones have noise and records of up to 25 s, also on stiff pads.
"""

import sys
import time
import warnings
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks.certified_scenes import draw
from extremes.scenes import GRAVITY, shake, usual
from records import records_folder

import rockframe as rf
from rockframe.errors import RockframeWarning
from rockframe.simulation.certify.second_look import MAX_PEAK_ERROR, doubts, second_look
from rockframe.simulation.plan import plan_run
from rockframe.simulation.run import compute_response

RECORDS = (
    "ElCentro1940_Peknold.AT2",
    "RSN763_LOMAP_GIL067.AT2",
    "NIS090.AT2",
    "PEERSMD_CHICHI_TCU128-N.AT2",
)
LONGEST = 25.0
OTHER_FALL = 0.05
"""Relative difference of overturning times beyond which two overturnings differ."""


def short(number):
    """Return a scene, its motion and its arguments."""
    rng = np.random.default_rng([1, number])
    if number % 2 == 0:
        _, system, motion, duration = draw(rng)
        motion = motion.scaled(float(10.0 ** rng.uniform(-0.3, 0.8)))
        return system, motion, {"duration": f"{duration!r} s"}
    scene = usual(rng)
    return scene.system, scene.motion, arguments(scene, scene.duration)


def long(number):
    """Return a scene with many impacts, its motion and its arguments."""
    rng = np.random.default_rng([100, number])
    scene = usual(rng)
    ratio = float(10.0 ** rng.uniform(0.9, 2.2))
    scene = replace(scene, frequency_ratio=ratio, start=float(rng.choice([0.0, 0.0, 0.0, 0.5])))
    theta = float(np.arctan(1.0 / scene.slenderness))
    if number % 2:
        record = rf.GroundMotion.read(records_folder() / RECORDS[int(rng.integers(len(RECORDS)))])
        peak = theta * 9.81 * float(10.0 ** rng.uniform(-0.1, 0.9))
        motion = record.scaled(peak=f"{peak!r} m/s^2")
    else:
        step, count = float(rng.choice([0.005, 0.01, 0.02])), int(rng.choice([800, 2000]))
        across, up = shake("noise", count, rng)
        peak = theta * GRAVITY * float(10.0 ** rng.uniform(0.0, 1.2))
        vertical = (0.3 * peak * up, "m/s^2") if rng.integers(2) else None
        motion = rf.GroundMotion.from_arrays(
            (peak * across, "m/s^2"), f"{step!r} s", vertical=vertical
        )
    return scene.system, motion, arguments(scene, min(motion.si.duration + 2.0, LONGEST))


def arguments(scene, duration):
    """Return duration, initial state and other arguments of a run."""
    start = scene.start * float(np.arctan(1.0 / scene.slenderness))
    return {
        "duration": f"{duration!r} s",
        "initial": rf.InitialState(rotation=f"{start!r} rad"),
        "overturning": "continue" if scene.continues else "stop",
    }


def timed(system, plan):
    """Run; return the trajectory and the time."""
    start = time.perf_counter()
    trajectory = compute_response(system.assembly, plan).trajectory
    return trajectory, time.perf_counter() - start


def judge_fast(system, motion, arguments_of_run):
    """Return the error of a run at "fast", whether it is reported, and the second look's cost."""
    plan = plan_run(system.assembly, motion, accuracy="fast", **arguments_of_run)
    compute_response(
        system.assembly, plan
    )  # what is computed once for a scene is no cost of either
    first, cost = timed(system, plan)
    second, more = timed(system, second_look(system.assembly, plan))
    exact = plan_run(
        system.assembly, motion, accuracy="reference", outputs=None, **arguments_of_run
    )
    truth, _ = timed(system, exact)
    is_reported = bool(list(doubts(system.setting, plan, first, second)))
    if first.overturned != truth.overturned:
        kind = "other verdict"
    elif abs(first.peak_rotation - truth.peak_rotation) > MAX_PEAK_ERROR * truth.peak_rotation:
        kind = "peak off"
    elif first.verdict_direction != truth.verdict_direction or (
        abs(first.verdict_time - truth.verdict_time) > OTHER_FALL * truth.verdict_time
    ):
        kind = "other fall"
    else:
        kind = "right"
    return kind, is_reported, more / cost


def main():
    """Print the table."""
    warnings.simplefilter("ignore", RockframeWarning)
    print("scenes | number | what is wrong | how many | of which told | median cost of the look")
    for name, draw_case, count in (("short", short, 1600), ("long", long, 3000)):
        rows = [judge_fast(*draw_case(number)) for number in range(count)]
        all_kinds, reported = (
            Counter(kind for kind, is_reported, _ in rows if is_reported or k)
            for k in (True, False)
        )
        cost = float(np.median([cost for *_, cost in rows]))
        for kind, of in all_kinds.items():
            print(f"{name} | {count} | {kind} | {of} | {reported[kind]} | {cost:.2f}", flush=True)


if __name__ == "__main__":
    main()
