"""The page "Accuracy" describes the levels correctly."""

import numpy as np
import pytest
from pages import DIGITS, numbers_in, table
from records import record_path

import rockframe as rf
from rockframe.errors import SolverError

PAGE = "guide/accuracy.md"
LEVELS = ("fast", "standard", "reference")
BLOCK = rf.Block(width="4.85 m", height="19.4 m", mass="600 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
ON_PADS = rf.System(BLOCK, PADS)
ON_RIGID_GROUND = rf.System(BLOCK)


def test_defaults_and_bounds():
    rows = table(PAGE, "| setting | default | least | greatest |")
    defaults = vars(rf.Accuracy(rtol=1e-6))
    assert {row[0].strip("`") for row in rows} == set(defaults)
    for cell, default, least, greatest in rows:
        name = cell.strip("`")
        if default != "none":
            assert defaults[name] == float(default)
        number = int if name in ("substeps", "max_steps") else float
        low, *with_substeps = least.split(", with `substeps` ")
        _check_bound(name, number(float(low)), -1)
        _check_bound(name, number(float(greatest)), +1)
        for bound in with_substeps:
            _check_bound(name, number(bound), -1, substeps="fewest")


def _check_bound(name, bound, side, **others):
    if not others and name not in ("rtol", "substeps"):
        others = {"rtol": 1e-6}
    rf.Accuracy(**{name: bound}, **others)
    beyond = bound + side if isinstance(bound, int) else bound * (1.0 + side * 1e-6) + side * 1e-300
    with pytest.raises(SolverError, match=f"{name} must lie"):
        rf.Accuracy(**{name: beyond}, **others)


@pytest.mark.parametrize("level", LEVELS)
def test_documented_run_is_reproduced(level):
    head = "| level | steps | rejected | energy residual | relative error of the peak rotation |"
    rows = {name: [float(cell) for cell in cells] for name, *cells in table(PAGE, head)}
    steps, rejected, residual, error = rows[level]
    run, exact = (
        ON_PADS.simulate(
            rf.GroundMotion.sine_pulse(), free_vibration="5 s", outputs=None, accuracy=accuracy
        )
        for accuracy in (level, rf.Accuracy(rtol=1e-12))
    )
    assert run.attrs["solver_steps"] == pytest.approx(steps, rel=0.005)
    assert run.attrs["solver_rejected_steps"] == pytest.approx(rejected, abs=2)
    assert float(run.energy_residual) == pytest.approx(residual, rel=DIGITS)
    off = abs(float(run.peak_rotation / exact.peak_rotation) - 1.0)
    # near rounding only the order of the error is known
    assert off == pytest.approx(error, rel=DIGITS, abs=1e-13)


def overturning_amplitude(system, accuracy, low):
    """Return the amplitude between `low` and a tenth more at which overturning begins [m/s^2]."""

    def overturns(amplitude):
        pulse = rf.GroundMotion.sine_pulse(f"{-amplitude!r} m/s^2")
        run = system.simulate(
            pulse, free_vibration="10 s", outputs=None, accuracy=accuracy, second_look=False
        )
        return bool(run.overturned)

    high = low + 0.1
    assert overturns(high)
    assert not overturns(low)
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (low, middle) if overturns(middle) else (middle, high)
    return high


def test_thresholds_of_overturning():
    pads, rigid = numbers_in(
        PAGE,
        "overturns it, # m/s² on the pads above ($\\beta=20$, $\\xi=0.10$) and # m/s² on rigid",
    )
    fast_pads, fast_rigid = numbers_in(PAGE, "is # too high on pads and # too low on rigid ground")
    pads_off, rigid_off = numbers_in(PAGE, '(`"standard"`: # too high and # too low).')
    for system, value, low, offs in (
        (ON_PADS, pads, 17.6, {"fast": fast_pads, "standard": pads_off}),
        (ON_RIGID_GROUND, rigid, 19.2, {"fast": -fast_rigid, "standard": -rigid_off}),
    ):
        exact = overturning_amplitude(system, "reference", low)
        assert exact == pytest.approx(value, abs=6e-4)
        for level, off in offs.items():
            found = overturning_amplitude(system, level, low) / exact - 1.0
            assert found == pytest.approx(off, rel=DIGITS)


def test_no_smaller_pulse_overturns():
    for system, least in ((ON_PADS, 17.6), (ON_RIGID_GROUND, 19.2)):
        for amplitude in np.arange(0.5, least, 0.5):
            pulse = rf.GroundMotion.sine_pulse(f"{-amplitude} m/s^2")
            run = system.simulate(pulse, free_vibration="10 s", outputs=None, accuracy="fast")
            assert not bool(run.overturned)


def test_fast_on_coarse_records():
    record = rf.GroundMotion.read(record_path("PEERSMD_CHICHI_TCU128-N.AT2"))
    samples = 1.5 * record.window("30 s", "90 s").si.horizontal.samples
    block = rf.Block(width="4 m", height="18 m", mass="99 t")
    on_pads = numbers_in(PAGE, "errors of the history of #, #, # and # on pads")
    on_rigid = numbers_in(PAGE, "with one step per sample, errors are #, #, # and #")
    for system, errors in ((rf.System(block, PADS), on_pads), (rf.System(block), on_rigid)):
        for every, error in zip((1, 2, 4, 8), errors, strict=True):
            motion = rf.GroundMotion.from_arrays((samples[::every], "m/s^2"), f"{0.005 * every} s")
            fast, exact = (
                system.simulate(motion, output_step="5 ms", accuracy=level, overturning="continue")
                for level in ("fast", "reference")
            )
            off = abs(fast.rotation - exact.rotation).max() / exact.peak_rotation
            assert float(off) == pytest.approx(error, rel=DIGITS), (every, system)
    residual, history = numbers_in(
        PAGE, "record at 40 ms the residual is # and the error of the history #. It"
    )
    assert float(fast.energy_residual) == pytest.approx(residual, rel=DIGITS)
    assert float(off) == pytest.approx(history, rel=DIGITS)
