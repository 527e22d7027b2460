"""Cost of a case of a sweep, alone and in lanes, compared with a loop of single runs.

Usage: python tests/benchmarks/sweeps.py [record]

Prints milliseconds of processor time per case on one processor, the least of several rounds, and
the ratios; then cases per second of a sweep on all processors; then, of 10 000 cases, which share
of the processor time is spent outside the compiled loops (planning, building scenes, labels), and
how much faster two threads are than one. Then the same for random tables, in which every case has
its own scene and scale, with scenes assembled together and one by one; the share of cases outside
lanes; and the time to plan a table of a million cases. The record is a file; without one the motion
has the length of El Centro and is drawn from a model.
"""

import math
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import numpy as np

import rockframe as rf
from rockframe.studies.sweeps import chunk, lanes, study
from rockframe.studies.sweeps.chunk import DRIVER, Driver, run_chunk
from rockframe.studies.sweeps.planning import plan_study

CASES, ROUNDS, MANY = 600, 5, 10_000
BLOCK = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
SYSTEM = rf.System(BLOCK, PADS)
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping="220 kPa*s")
TABLES = {
    "pads": ((PADS,), {"frequency_ratio": (15.0, 30.0), "damping_ratio": (0.05, 0.2)}),
    "rigid ground": ((), {}),
    "soil": ((SOIL,), {"stiffness [MPa]": (5.0, 20.0), "damping [kPa*s]": (50.0, 300.0)}),
}
"""Scenes of random tables, and what varies in them beside width, height and scale."""
DRAWN = 2_000
PLANNED = 1_000_000


def main() -> None:
    """Time all variants for a parameter, for the scale of the motion, and for a grid of both."""
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
            text = ", ".join(f"{way} {each:.3f} ms" for way, each in times.items())
            ratio = times["loop"] / list(times.values())[-1]
            print(f"{accuracy}, {name}: {text} a case; {ratio:.1f} times")
    axes = {"damping_ratio": np.linspace(0.05, 0.5, 10), "scale": np.linspace(0.1, 2.0, MANY // 10)}
    for accuracy in ("fast", "standard"):
        rates = [rate(motion, axes, accuracy) for _ in range(3)]
        print(f"{accuracy}: {max(rates):.0f} cases a second on all processors")
    grids = {"grid": axes, "damping ratio": {"damping_ratio": np.linspace(0.05, 0.5, MANY)}}
    for name, axes in grids.items():
        print(f"fast, {name}: {share(motion, axes):.0%} of the processor time outside the lanes")
        print(f"fast, {name}: {gain(motion, axes):.2f} times as fast with two threads as with one")
    for name in TABLES:
        for accuracy in ("fast", "standard", "screen"):
            print(f"{accuracy}, random table on {name}: {monte_carlo(motion, name, accuracy)}")
    start = time.process_time()
    plan_study(SYSTEM, motion, {}, table("pads", PLANNED), accuracy="fast")
    print(f"a table of {PLANNED} cases is planned in {time.process_time() - start:.2f} s")
    print(f"load of the machine meanwhile: {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")


study.COMPILING_SHARE = math.inf  # lanes are compiled in the first round


def costs(motion, axes, accuracy) -> dict[str, float]:
    """Return the processor time of a case for several variants in turn [ms]."""
    options = {"outputs": None, "accuracy": accuracy}

    def loop():
        for ratio in axes.get("damping_ratio", [0.1]):
            system = rf.System(BLOCK, PADS.replace(damping_ratio=float(ratio)))
            for factor in axes.get("scale", [1.0]):
                moved = motion if factor == 1.0 else motion.scaled(float(factor))
                system.simulate(moved, **options, second_look=False)

    def swept(fewest):
        study.MIN_CASES_IN_LANES = fewest
        with ThreadPoolExecutor(1) as one:
            rf.sweep(SYSTEM, motion, axes=axes, **options, executor=one, progress=False)

    ways = {"loop": loop, "sweep": lambda: swept(10**9), "in lanes": lambda: swept(1)}
    for work in ways.values():
        work()
    rounds = [[_once(work) for work in ways.values()] for _ in range(ROUNDS)]
    least = [1e3 * min(column) / CASES for column in zip(*rounds, strict=True)]
    return dict(zip(ways, least, strict=True))


def rate(motion, axes, accuracy) -> float:
    """Return the cases a second of a whole sweep, from the call to the labelled dataset [s^-1]."""
    study.MIN_CASES_IN_LANES = 1
    start = time.perf_counter()
    rf.sweep(SYSTEM, motion, axes=axes, accuracy=accuracy, progress=False)
    return MANY / (time.perf_counter() - start)


def table(name, count) -> dict[str, np.ndarray]:
    """Draw a table of cases."""
    rng = np.random.default_rng(1)
    spreads = {"Block.width [m]": (1.5, 3.0), "Block.height [m]": (7.0, 12.0), "scale": (0.3, 2.0)}
    spreads |= TABLES[name][1]
    return {column: rng.uniform(*bounds, count) for column, bounds in spreads.items()}


def monte_carlo(motion, name, accuracy) -> str:
    """Report the cost of a case of a random table [ms], and the share outside lanes."""
    study.MIN_CASES_IN_LANES = 1
    system, cases = rf.System(BLOCK, *TABLES[name][0]), table(name, DRAWN)
    run_assembled_together = chunk.run_assembled_together
    ways = {"together": run_assembled_together, "one by one": lambda *_: iter(())}
    least = dict.fromkeys(ways, math.inf)
    job = plan_study(system, motion, {}, cases, accuracy=accuracy).job(range(DRAWN))
    inside = math.inf
    try:
        for _ in range(ROUNDS):
            for way, run in ways.items():
                chunk.run_assembled_together = run
                with _loops_timed() as spent:
                    least[way] = min(least[way], _once(lambda: run_chunk(job)))
                inside = min(inside, spent[0]) if way == "together" else inside
        chunk.run_assembled_together = run_assembled_together
        alone = 1.0 - float(np.mean(run_chunk(job).scalars[DRIVER] == Driver.IN_LANES))
    finally:
        chunk.run_assembled_together = run_assembled_together
    text = ", ".join(f"{way} {1e3 * seconds / DRAWN:.3f} ms" for way, seconds in least.items())
    return f"{text} a case, {1e3 * inside / DRAWN:.3f} ms in lanes; {alone:.1%} outside lanes"


@contextmanager
def _loops_timed():
    """Return the processor time that is spent in lanes [s]."""
    inside = [0.0]
    loops = lanes.integrate_lanes

    def timed(*arguments):
        start = time.thread_time()
        try:
            return loops(*arguments)
        finally:
            inside[0] += time.thread_time() - start

    lanes.integrate_lanes = timed
    try:
        yield inside
    finally:
        lanes.integrate_lanes = loops


def share(motion, axes) -> float:
    """Return the share of a sweep's processor time that is not spent in compiled loops."""
    with _loops_timed() as inside:
        total = _once(lambda: _swept(motion, axes, threads=1))
    return 1.0 - inside[0] / total


def gain(motion, axes) -> float:
    """Return the speed-up of two threads over one, by least wall times of alternating rounds."""
    times = {1: [], 2: []}
    for _ in range(ROUNDS):
        for threads, taken in times.items():
            start = time.perf_counter()
            _swept(motion, axes, threads)
            taken.append(time.perf_counter() - start)
    return min(times[1]) / min(times[2])


def _swept(motion, axes, threads) -> None:
    study.MIN_CASES_IN_LANES = 1
    with ThreadPoolExecutor(threads) as pool:
        rf.sweep(SYSTEM, motion, axes=axes, accuracy="fast", executor=pool, progress=False)


def _once(work) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


if __name__ == "__main__":
    main()
