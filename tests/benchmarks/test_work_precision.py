"""A small part of the measurement of work against precision, and agreement of the other programs.

Run with ``python -m pytest tests/benchmarks -m benchmarks -s``. The whole measurement is
``tests/benchmarks/work_precision.py``.
"""

import numpy as np
import pytest
from benchmarks.five_scenes import OUTPUT_STEP, motion, scenes
from benchmarks.opensees_pads import opensees
from benchmarks.timing import cost
from benchmarks.work_precision import EXACT, SAMPLES_AT_ONCE, error

SECONDS = 4.0
RUN = {"output_step": f"{OUTPUT_STEP} s"}


@pytest.mark.parametrize("name", scenes())
def test_work_and_error_against_scipy(name):
    """RK45 with a loose tolerance, through the samples: SciPy's cheapest run."""
    scene, excitation = scenes()[name], motion().window("0 s", f"{SECONDS} s")
    exact = scene.system.simulate(excitation, accuracy=EXACT, **RUN)["rotation"].to_numpy()
    step = excitation.si.time_step
    options = {
        "time_step": step, "acceleration": excitation.si.horizontal.samples, "duration": SECONDS,
        "sample_times": np.arange(len(exact)) * OUTPUT_STEP, "max_step": SAMPLES_AT_ONCE * step,
        "rtol": 1e-3, "atol": 1e-6, "method": "RK45", "restart_every_knot": False,
    }  # fmt: skip
    rotations = []
    yours = cost(lambda: rotations.append(scene.by_hand(**options)), 1)
    mine = cost(lambda: scene.system.simulate(excitation, accuracy="fast", **RUN), 5)
    ours = scene.system.simulate(excitation, accuracy="fast", **RUN)["rotation"].to_numpy()
    print(
        f"\n  {name}: rockframe {1e3 * mine:.1f} ms, error {error(ours, exact):.0e}; SciPy "
        f"{1e3 * yours:.0f} ms, error {error(rotations[0], exact):.0e}; ratio {yours / mine:.0f}"
    )
    assert yours > mine
    assert error(ours, exact) < error(rotations[0], exact)


def test_work_and_error_against_opensees():
    try:
        ops = opensees()
    except ImportError as reason:
        pytest.skip(f"OpenSees is not available: {reason}")
    from benchmarks.opensees_comparison import CASES, arguments, excitation, system
    from benchmarks.opensees_pads import simulate

    ops.logFile("/dev/null", "-noEcho")
    damping_ratio, factor = CASES["undamped, with uplift"]
    record = excitation(factor).window("0 s", f"{SECONDS} s")
    scene, options = system(damping_ratio), arguments(damping_ratio, record)
    exact = scene.simulate(record, accuracy=EXACT, **RUN)["rotation"].to_numpy()
    errors = [
        error(simulate(ops, **options, steps_per_sample=count), exact) for count in (2, 8, 32)
    ]
    yours = cost(lambda: simulate(ops, **options, steps_per_sample=1), 3)
    mine = cost(lambda: scene.simulate(record, accuracy="fast", **RUN), 5)
    print(f"\n  OpenSees at finer and finer steps: errors {errors}")
    print(f"  at the motion's step {1e3 * yours:.0f} ms; rockframe {1e3 * mine:.1f} ms")
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 1e-4
    assert mine < yours
