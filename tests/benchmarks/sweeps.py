"""What a case of a sweep costs, alone and in lanes, beside a loop of single runs.

Usage: python tests/benchmarks/sweeps.py [record]

Prints milliseconds of processor time per case on one processor, the least of several rounds, and
the ratios; then cases per second of a sweep on all processors; then, of 10 000 cases, which share
of the processor time is spent outside the compiled loops (planning, building scenes, labels), and
how much faster two threads are than one. The record is a file; without one the motion has the
length of El Centro and is drawn from a model.
"""

import math
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import rockframe as rf
from rockframe.studies.sweeps import side_by_side, study, together

CASES, ROUNDS, MANY = 600, 5, 10_000
BLOCK = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
SYSTEM = rf.System(BLOCK, PADS)


def main() -> None:
    """Time all ways, for a parameter, for the scale of the motion, and for a grid of both."""
    if len(sys.argv) > 1:
        motion = rf.GroundMotion.read(sys.argv[1])
    else:
        motion = rf.GroundMotion.stochastic(
            6.5, "10 km", seed=4, time_step="0.02 s", source="one corner"
        )
    print(motion)
    ratios, scales = np.linspace(0.05, 0.5, CASES), np.linspace(0.1, 2.0, CASES)
    grids = {
        "damping ratio": {"damping_ratio": ratios},
        "scale": {"scale": scales},
        "grid": {"damping_ratio": ratios[::60], "scale": scales[::10]},
    }
    for accuracy in ("fast", "standard"):
        for name, axes in grids.items():
            times = costs(motion, axes, accuracy)
            told = ", ".join(f"{way} {each:.3f} ms" for way, each in times.items())
            ratio = times["loop"] / list(times.values())[-1]
            print(f"{accuracy}, {name}: {told} a case; {ratio:.1f} times")
    axes = {"damping_ratio": np.linspace(0.05, 0.5, 10), "scale": np.linspace(0.1, 2.0, MANY // 10)}
    for accuracy in ("fast", "standard"):
        rates = [rate(motion, axes, accuracy) for _ in range(3)]
        print(f"{accuracy}: {max(rates):.0f} cases a second on all processors")
    grids = {"grid": axes, "damping ratio": {"damping_ratio": np.linspace(0.05, 0.5, MANY)}}
    for name, axes in grids.items():
        print(f"fast, {name}: {share(motion, axes):.0%} of the processor time outside the lanes")
        print(f"fast, {name}: {gain(motion, axes):.2f} times as fast with two threads as with one")
    print(f"load of the machine meanwhile: {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")


study.COMPILING_SHARE = math.inf  # lanes are compiled in the first round


def costs(motion, axes, accuracy) -> dict[str, float]:
    """Give the processor time of a case by several ways that take turns [ms]."""
    options = {"outputs": None, "accuracy": accuracy}

    def loop():
        for ratio in axes.get("damping_ratio", [0.1]):
            system = rf.System(BLOCK, PADS.replace(damping_ratio=float(ratio)))
            for factor in axes.get("scale", [1.0]):
                moved = motion if factor == 1.0 else motion.scaled(float(factor))
                system.simulate(moved, **options)

    def swept(fewest):
        study.FEWEST_IN_LANES = fewest
        with ThreadPoolExecutor(1) as one:
            rf.sweep(SYSTEM, motion, axes=axes, **options, executor=one, progress=False)

    ways = {"loop": loop, "sweep": lambda: swept(10**9), "in lanes": lambda: swept(1)}
    for work in ways.values():
        work()
    rounds = [[_once(work) for work in ways.values()] for _ in range(ROUNDS)]
    least = [1e3 * min(column) / CASES for column in zip(*rounds, strict=True)]
    return dict(zip(ways, least, strict=True))


def rate(motion, axes, accuracy) -> float:
    """Give the cases a second of a whole sweep, from the call to the labelled dataset [s^-1]."""
    study.FEWEST_IN_LANES = 1
    begun = time.perf_counter()
    rf.sweep(SYSTEM, motion, axes=axes, accuracy=accuracy, progress=False)
    return MANY / (time.perf_counter() - begun)


def share(motion, axes) -> float:
    """Give the share of a sweep's processor time that is not spent in compiled loops."""
    inside = [0.0]
    loops = side_by_side.integrate_lanes

    def timed(*given):
        begun = time.thread_time()
        try:
            return loops(*given)
        finally:
            inside[0] += time.thread_time() - begun

    side_by_side.integrate_lanes = together.integrate_lanes = timed
    try:
        whole = _once(lambda: _swept(motion, axes, threads=1))
    finally:
        side_by_side.integrate_lanes = together.integrate_lanes = loops
    return 1.0 - inside[0] / whole


def gain(motion, axes) -> float:
    """Give how much faster two threads are than one, by the least wall times of rounds in turns."""
    times = {1: [], 2: []}
    for _ in range(ROUNDS):
        for threads, taken in times.items():
            begun = time.perf_counter()
            _swept(motion, axes, threads)
            taken.append(time.perf_counter() - begun)
    return min(times[1]) / min(times[2])


def _swept(motion, axes, threads) -> None:
    study.FEWEST_IN_LANES = 1
    with ThreadPoolExecutor(threads) as pool:
        rf.sweep(SYSTEM, motion, axes=axes, accuracy="fast", executor=pool, progress=False)


def _once(work) -> float:
    begun = time.process_time()
    work()
    return time.process_time() - begun


if __name__ == "__main__":
    main()
