"""Cost of one run with histories, compared with the compiled loop alone.

Run from the root, with ``PYTHONPATH=.``, ``ROCKFRAME_COMPILE=wait``, and glibc's
``MALLOC_TRIM_THRESHOLD_`` and ``MALLOC_MMAP_THRESHOLD_`` of a gigabyte, so that memory is reused
between runs: ``python tests/benchmarks/one_run.py``. Writes docs/data/one_run.json. Loop, runs
without and runs with histories alternate, so that other work on the machine affects all alike; each
number is the least processor time of all rounds, a ratio that over the loop's.
"""

import json
import time
import warnings
from collections import defaultdict
from collections.abc import Callable
from contextlib import ExitStack
from functools import wraps
from pathlib import Path
from unittest.mock import patch

import numpy as np

import rockframe as rf
from rockframe.dynamics.protocol import Start
from rockframe.simulation import run, run_outputs
from rockframe.solve import integrate
from rockframe.solve.accuracy import LEVELS

DATA = Path(__file__).resolve().parents[2] / "docs" / "data" / "one_run.json"
ROUNDS = 40
SHOWN = ("fast", "standard")
STEP, SAMPLES, FADE = 0.005, 12_000, 1000
PARTS = {
    "columns": (run_outputs, "_ObservedRun"),
    "peaks": (run_outputs, "force_peaks"),
    "dataset": (run, "build_dataset"),
}
"""Separately timed parts: model outputs along steps and at samples, peaks between these, and the
labelled dataset."""


def motion(peak: float) -> rf.GroundMotion:
    """Return a minute of noise in samples of 5 ms that fades at its end."""
    noise = np.convolve(np.random.default_rng(1).normal(size=SAMPLES), np.hanning(61), "same")
    noise[-FADE:] *= np.linspace(1.0, 0.0, FADE)
    return rf.GroundMotion.from_arrays(
        (peak * noise / abs(noise).max(), "m/s^2"), time_step=f"{STEP} s"
    )


def scenes() -> dict[str, tuple[rf.System, float]]:
    """Return scenes by name, with peaks of motions that rock but do not overturn them."""
    block = rf.Block(width="1 m", height="4 m", mass="2 t")
    return {
        "rigid ground": (rf.System(block), 2.9),
        "pads": (
            rf.System(block, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)), 2.9,
        ),
        "soil": (rf.System(block, rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)), 1.2),
    }  # fmt: skip


class Spent:
    """Processor time spent in functions, by their names [s]."""

    def __init__(self) -> None:
        self.times: dict[str, float] = defaultdict(float)

    def timed(self, name: str, function: Callable[..., object]) -> Callable[..., object]:
        """Return a function whose processor time is accumulated."""

        @wraps(function)
        def call(*arguments, **options):
            start = time.process_time()
            try:
                return function(*arguments, **options)
            finally:
                self.times[name] += time.process_time() - start

        return call


def measured(system: rf.System, ground: rf.GroundMotion, level: str) -> dict[str, float]:
    """Return the least times of the loop, of runs and of their parts [ms]."""
    spent, model = Spent(), system.assembly.model

    def loop() -> None:
        integrate.integrate(
            model, Start(), ground.si, LEVELS[level], duration=(SAMPLES - 1) * STEP,
            output_step=None,
        )  # fmt: skip

    def simulate(**options) -> None:
        system.simulate(ground, accuracy=level, second_look=False, **options)

    ways = {
        "loop": loop,
        "without histories": lambda: simulate(outputs=None),
        "with histories": simulate,
    }
    least = defaultdict[str, float](lambda: 1e9)
    with ExitStack() as stack:
        timed = {"loop": (integrate, "advance")}
        for name, (place, function) in {**timed, **PARTS}.items():
            call = spent.timed(name, getattr(place, function))
            stack.enter_context(patch.object(place, function, call))
        for _ in range(ROUNDS):
            for way, function in ways.items():
                for _ in range(2):  # the second call finds its code and its memory
                    spent.times.clear()
                    start = time.process_time()
                    function()
                    duration = time.process_time() - start
                if way == "loop":
                    duration = spent.times["loop"]
                least[way] = min(least[way], duration)
                if way == "with histories":
                    for name in PARTS:
                        least[name] = min(least[name], spent.times[name])
    shown = system.simulate(ground, accuracy=level, second_look=False)
    if int(shown.overturned):
        print("overturns")
    counts = {"steps": shown.attrs["solver_steps"], "impacts": int(shown.impact_count)}
    times = {f"{name} [ms]": round(1e3 * each, 3) for name, each in least.items()}
    ratios = {
        f"{name}, ratio": round(least[name] / least["loop"], 2) for name in ways if name != "loop"
    }
    return {**counts, **times, **ratios}


def main() -> None:
    """Measure all, and write it."""
    warnings.simplefilter("ignore")
    table: dict[str, dict[str, dict[str, float]]] = {}
    for name, (system, peak) in scenes().items():
        table[name] = {level: measured(system, motion(peak), level) for level in SHOWN}
        print(name, json.dumps(table[name], indent=1), flush=True)
    DATA.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
