"""Speed, as ratios measured in one run.

Run with ``python -m pytest tests/benchmarks -m benchmarks -s``. Each test prints what it
measured and asserts the required ratio.
"""

import ctypes
import math
import os
import shutil
import subprocess
import sys
import time
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from reference_models.monoliths import two_spring as monolith

import rockframe as rf
from rockframe.dynamics.protocol import Start
from rockframe.signals import Motion
from rockframe.solve.accuracy import LEVELS
from rockframe.solve.integrate import integrate

STEP = 0.005
COUNT = 12_001  # 60 s
REPEATS = 15
BLOCK = {"radius": "5 m", "slenderness": 4, "mass": "1 t"}
BETA, XI = 20, 0.1


def motion(peak: float, count: int = COUNT, seed: int = 1) -> np.ndarray:
    noise = np.random.default_rng(seed).normal(size=count)
    smooth = np.convolve(noise, np.ones(40) / 40.0, "same")
    return peak * smooth / np.abs(smooth).max()


def system() -> rf.System:
    pads = rf.TwoSpringSupport(frequency_ratio=BETA, damping_ratio=XI)
    return rf.System(rf.Block.from_size(**BLOCK), pads)


def best(function, repeats: int = REPEATS) -> float:
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def say(text: str) -> None:
    print(f"\n  {text}")


@pytest.fixture(scope="module")
def c_loop(tmp_path_factory):
    compiler = shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler for the yardstick")
    library = tmp_path_factory.mktemp("c") / "loop.so"
    source = Path(__file__).with_name("two_spring_loop.c")
    command = [compiler, "-O2", "-shared", "-fPIC", "-o", str(library), str(source), "-lm"]
    subprocess.run(command, check=True)
    loaded = ctypes.CDLL(str(library))
    loaded.integrate.restype = ctypes.c_long
    return loaded


class LoopInC:
    """The same block, motion and accuracy in plain C."""

    def __init__(self, library: ctypes.CDLL) -> None:
        self.library = library
        # so weak that the block stays in full contact, the only state of the loop in C
        self.weak = motion(0.3)
        self.model = system().setting.compile()
        body, pads = self.model.system.part
        self.block = (ctypes.c_double * 7)(
            body.gravity, body.height, body.right, body.inertia, pads.law.stiffness,
            pads.law.damping, pads.rest,
        )  # fmt: skip

    def run(self) -> tuple[int, np.ndarray, float]:
        settings, number = LEVELS["standard"], ctypes.c_double
        state, reference = np.zeros(4), 1e-6 * self.model.scales[[0, 1, 3, 4]]
        out, work = np.empty((COUNT, 4)), np.zeros(2)
        lowest, peak = number(1e9), number(0.0)
        max_step = 2.0 * math.pi / self.model.fastest_frequency / settings.steps_per_period
        steps = self.library.integrate(
            self.block, self.weak.ctypes.data_as(ctypes.c_void_p), ctypes.c_long(COUNT),
            number(STEP), number(settings.rtol), number(settings.floor), number(max_step),
            *(a.ctypes.data_as(ctypes.c_void_p) for a in (state, reference, out, work)),
            ctypes.byref(lowest), ctypes.byref(peak),
        )  # fmt: skip
        return steps, out, lowest.value


@pytest.fixture(scope="module")
def loop_in_c(c_loop):
    return LoopInC(c_loop)


def ratio_of(ours, theirs) -> tuple[float, float]:
    """Return the least times of two functions called alternately [ms]."""
    pairs = []
    for _ in range(40):
        start = time.perf_counter()
        theirs()
        middle = time.perf_counter()
        ours()
        pairs.append((1e3 * (time.perf_counter() - middle), 1e3 * (middle - start)))
    mine, yours = (min(column) for column in zip(*pairs, strict=True))
    return mine, yours


def test_against_a_c_loop(loop_in_c):
    model, ground = loop_in_c.model, Motion.of_samples(STEP, loop_in_c.weak)
    duration = (COUNT - 1) * STEP

    def ours():
        return integrate(
            model, Start(), ground, LEVELS["standard"], duration=duration, output_step=STEP
        )

    run, (steps, out, lowest) = ours(), loop_in_c.run()
    assert lowest > 0.0
    np.testing.assert_allclose(run.state[:, 0], out[:, 0], rtol=0.0, atol=1e-6 * abs(out).max())
    mine, yours = ratio_of(ours, loop_in_c.run)
    say(
        f"60 s record: {mine:.2f} ms ({run.step_count} steps), loop in C {yours:.2f} ms "
        f"({steps} steps), ratio {mine / yours:.2f}"
    )
    assert mine / yours < 2.0


def test_a_run_with_all_histories_against_a_c_loop(loop_in_c):
    record = rf.GroundMotion.from_arrays((loop_in_c.weak, "m/s^2"), f"{STEP} s")
    scene = system()
    histories = scene.simulate(record)
    assert histories.sizes["time"] == COUNT
    mine, yours = ratio_of(lambda: scene.simulate(record), loop_in_c.run)
    say(
        f"60 s record: {len(histories.data_vars)} variables in {mine:.2f} ms, loop in C "
        f"{yours:.2f} ms, ratio {mine / yours:.2f}"
    )
    assert mine / yours < 2.25  # 2.1 on an idle machine, as this was written


def test_whole_simulation_against_scipy():
    # 60 s of a motion with uplift and impacts; the monolith at the same error or better
    count = COUNT
    samples = motion(3.0, count)
    record = rf.GroundMotion.from_arrays((samples, "m/s^2"), f"{STEP} s")
    scene = system()
    reference = scene.simulate(record, accuracy="reference")
    assert int(reference.impact_count) > 0
    result = scene.simulate(record)
    error = float(abs(result.rotation - reference.rotation).max())
    mine = best(lambda: scene.simulate(record, outputs=None))
    block = rf.Block.from_size(**BLOCK)
    options = {
        "half_width": 0.5 * block.width.m_as("m"), "half_height": 0.5 * block.height.m_as("m"),
        "shape_factor": 3.0, "frequency_ratio": BETA, "damping_ratio": XI, "time_step": STEP,
        "acceleration": samples, "duration": (count - 1) * STEP,
        "sample_times": result.time.to_numpy(),
    }  # fmt: skip
    for rtol in (1e-4, 1e-6, 1e-8):
        start = time.perf_counter()
        other = monolith.simulate(**options, rtol=rtol, atol=rtol * 1e-3)
        yours = time.perf_counter() - start
        its_error = float(np.abs(other.rotation - reference.rotation.to_numpy()).max())
        say(
            f"SciPy at rtol {rtol:g}: {yours:.3f} s, error {its_error:.1e} rad; rockframe "
            f"{1e3 * mine:.2f} ms, error {error:.1e} rad; ratio {yours / mine:.0f}"
        )
        if its_error <= 10.0 * error:
            break
    assert yours / mine > 500.0


def fresh(code: str, **environment: str) -> list[float]:
    # a process finds files of earlier ones on disk, also Python's bytecode
    options = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True,
        env=options | environment,
    )  # fmt: skip
    return [float(word) for word in done.stdout.split()]


def test_import():
    code = "import time; t = time.perf_counter(); import {}; print(time.perf_counter() - t)"
    mine = min(fresh(code.format("rockframe"))[0] for _ in range(5))
    others = min(fresh(code.format("xarray, pint"))[0] for _ in range(5))
    say(f"import rockframe {mine:.3f} s; import xarray, pint {others:.3f} s")
    assert mine < 0.7


def test_first_simulation_time_with_filled_cache():
    scene = (
        "import time; t0 = time.perf_counter(); import rockframe as rf; t1 = time.perf_counter();"
        "s = rf.System(rf.Block(width='1 m', height='4 m', mass='1 t'),"
        " rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1));"
        "s.simulate(rf.GroundMotion.sine_pulse(), duration='2 s', outputs=None);"
        "print(t1 - t0, time.perf_counter() - t1)"
    )
    libraries = (
        "import time; t = time.perf_counter(); import xarray, pint;"
        "pint.get_application_registry().Quantity('1 m'); print(time.perf_counter() - t)"
    )
    fresh(scene)
    loading, first = min((fresh(scene) for _ in range(5)), key=sum)
    needed = min(fresh(libraries)[0] for _ in range(5))
    say(f"import {loading:.3f} s, then first simulation {first:.3f} s; of the two, the import of "
        f"xarray and pint, with its registry, takes {needed:.3f} s")  # fmt: skip
    assert loading < 0.7
    assert first < 0.5


def test_memory_does_not_grow_with_the_record():
    scene = system()

    def held(count: int) -> int:
        record = rf.GroundMotion.from_arrays((motion(0.3, count), "m/s^2"), f"{STEP} s")
        scene.simulate(record, outputs=None)
        tracemalloc.start()
        scene.simulate(record, outputs=None)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return peak

    short, long = held(2_000), held(200_000)
    say(f"peak memory of a run without histories: {short} bytes for 10 s, {long} for 1000 s")
    assert long < short + 200_000


def test_without_compilation():
    code = (
        "import time, numpy as np, rockframe as rf;"
        f"a = np.random.default_rng(1).normal(size={COUNT});"
        "a = np.convolve(a, np.ones(40) / 40, 'same'); a *= 3.0 / abs(a).max();"
        f"m = rf.GroundMotion.from_arrays((a, 'm/s^2'), '{STEP} s');"
        "s = rf.System(rf.Block.from_size(radius='5 m', slenderness=4, mass='1 t'),"
        " rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1));"
        "t = time.perf_counter(); s.simulate(m); print(time.perf_counter() - t)"
    )
    plain = fresh(code, ROCKFRAME_COMPILE="0")[0]
    say(f"60 s record without compilation: {plain:.2f} s")
    assert plain < 8.0
