"""Refinement of samples and steps changes results by no more than their error.

The same straight lines with more samples, and shorter steps, are the same problem: no result may
depend on them by more than the error of the level of accuracy.
"""

import numpy as np
import pytest

import rockframe as rf

pytestmark = pytest.mark.convergence

BLOCK = rf.Block(width="3 m", height="6 m", mass="40 t")
PADS = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
CAP = rf.CushionCap(height="0.5 m", mass="12 t")
SOIL = rf.WinklerSoil(stiffness="28 MPa", damping_ratio=0.05)
SCENES = {
    "rigid ground": rf.System(BLOCK),
    "pads": rf.System(BLOCK, PADS),
    "soil": rf.System(BLOCK, SOIL),
    "coupled": rf.System(BLOCK, PADS, CAP, SOIL),
    "cascade": rf.System(BLOCK, PADS, CAP, SOIL, coupling="cascade"),
    "soft soil, cascade": rf.System(
        rf.Block(width="4 m", height="6 m", mass="89 t"),
        rf.TwoSpringSupport(frequency_ratio=30, damping_ratio=0.1),
        rf.CushionCap(height="0.5 m", mass="29 t"),
        rf.WinklerSoil(stiffness="8 MPa", damping_ratio=0.05),
        coupling="cascade",
    ),
    "pads that relax": rf.System(
        rf.Block(width="1 m", height="3 m", mass="1000 kg"),
        rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.5),
    ),
}
STEP = 0.02
LINES = {
    "soft soil, cascade": (10.8, 2.5, 0.0),
    "pads that relax": (3.5, 3.0, 7.1),
}
"""Amplitudes [m s^-2] and frequency [Hz] of the motions, across and upwards."""


def motion(name, parts=1):
    across, frequency, upwards = LINES.get(name, (8.4, 1.0, 2.0))
    time = np.arange(201) * STEP
    fine = np.arange(200 * parts + 1) * (STEP / parts)
    x = across * np.sin(2.0 * np.pi * frequency * time)
    y = upwards * np.sin(2.0 * np.pi * (frequency + 2.0) * time)
    return rf.GroundMotion.from_arrays(
        (np.interp(fine, time, x), "m/s^2"),
        f"{STEP / parts!r} s",
        vertical=(np.interp(fine, time, y), "m/s^2"),
    )


def run(name, accuracy, parts=1):
    return SCENES[name].simulate(
        motion(name, parts), accuracy=accuracy, output_step=f"{STEP} s", overturning="continue",
        duration="4 s",
    )  # fmt: skip


def difference(one, other):
    """Return the largest difference of two histories over the peak, before either overturns."""
    end = min(float(one.time[-1]), float(other.time[-1]))
    for each in (one, other):
        if each.overturned:
            end = min(end, float(each.overturning_time))
    rows = int(np.searchsorted(one.time.values, end))
    a, b = one.rotation.values[:rows], other.rotation.values[:rows]
    return np.abs(a - b).max() / np.abs(a).max()


# errors of steps grow through impacts, least on rigid ground
ALLOWED = {"standard": 1e-5, "reference": 1e-8}


@pytest.mark.parametrize("level", list(ALLOWED))
@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.long] * (name == "cascade")) for name in SCENES],
)
def test_resampling_piecewise_linear_motion_changes_nothing(name, level):
    plain = run(name, level)
    for parts in (2, 8, 64):
        assert difference(plain, run(name, level, parts)) < ALLOWED[level], parts


@pytest.mark.parametrize(
    "name",
    # scenes of two bodies take longest
    [
        pytest.param(name, marks=[pytest.mark.long] * (name in ("coupled", "cascade")))
        for name in SCENES
    ],
)
def test_steps_fifty_times_shorter_change_nothing(name):
    plain = run(name, "reference")
    mean = 4.0 / plain.attrs["solver_steps"]
    period = 2.0 * np.pi / SCENES[name].setting.compile().fastest_frequency
    shorter = run(name, rf.Accuracy(rtol=1e-11, steps_per_period=min(50.0 * period / mean, 1e4)))
    assert shorter.attrs["solver_steps"] > 10 * plain.attrs["solver_steps"]
    assert difference(plain, shorter) < ALLOWED["reference"]
    assert shorter.impact_count == plain.impact_count
