"""What a case of a sweep costs beside a loop of single runs, on one processor.

Usage: python tests/benchmarks/sweeps.py [record]

Prints milliseconds of processor time per case, the least of several rounds, and their ratios. The
record is a file; without one the motion has the length of El Centro and is drawn from a model.
"""

import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import rockframe as rf

CASES, ROUNDS = 300, 5


def main() -> None:
    """Time both, for a parameter and for the scale of the motion."""
    block = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
    system = rf.System(block, pads)
    if len(sys.argv) > 1:
        motion = rf.GroundMotion.read(sys.argv[1])
    else:
        motion = rf.GroundMotion.stochastic(6.5, "10 km", seed=4, time_step="0.02 s")
    print(motion)
    ratios, scales = np.linspace(0.05, 0.5, CASES), np.linspace(0.1, 2.0, CASES)
    for accuracy in ("fast", "standard"):
        options = {"outputs": None, "accuracy": accuracy}

        def parameter(options=options):
            for ratio in ratios.tolist():
                rf.System(block, pads.replace(damping_ratio=ratio)).simulate(motion, **options)

        def scale(options=options):
            for factor in scales.tolist():
                system.simulate(motion.scaled(factor), **options)

        with ThreadPoolExecutor(1) as one:
            for name, loop, axis in (("parameter", parameter, {"damping_ratio": ratios}),
                                     ("scale", scale, {"scale": scales})):  # fmt: skip

                def swept(options=options, axis=axis, one=one):
                    rf.sweep(system, motion, **axis, **options, executor=one)

                single, many = spent(loop, swept)
                print(f"{accuracy}, {name}: loop {single:.2f} ms, sweep {many:.2f} ms a case, "
                      f"ratio {single / many:.1f}")  # fmt: skip


def spent(*works) -> list[float]:
    """Give the processor time of a case, of several ways that take turns [ms]."""
    for work in works:
        work()
    times = [[_once(work) for work in works] for _ in range(ROUNDS)]
    return [1e3 * min(column) / CASES for column in zip(*times, strict=True)]


def _once(work) -> float:
    begun = time.process_time()
    work()
    return time.process_time() - begun


if __name__ == "__main__":
    main()
