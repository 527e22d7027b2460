"""A run and its continuation equal one uninterrupted run."""

import json
import math
import warnings
from functools import cache

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import AssemblyError

BLOCK = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
CAP = rf.CushionCap(height="0.5 m", mass="10 t")
SOIL = rf.WinklerSoil(stiffness="12 MPa", damping_ratio=0.1)
SCENES = {
    "rigid ground": rf.System(BLOCK),
    "pads": rf.System(BLOCK, PADS),
    "pads, leading corner": rf.System(BLOCK, PADS, restraint="leading-corner"),
    "soil": rf.System(BLOCK, SOIL),
    "cap and soil": rf.System(BLOCK, CAP, SOIL),
    "coupled": rf.System(BLOCK, PADS, CAP, SOIL),
    "cascade": rf.System(BLOCK, PADS, CAP, SOIL, coupling="cascade"),
}
STEP = 0.01


def record():
    """Return smooth noise, horizontal and vertical, that uplifts and drops every scene."""
    rng = np.random.default_rng(11)
    across, upwards = (
        np.convolve(rng.normal(size=800), np.hanning(25) / 12.0, "same") for _ in range(2)
    )
    scaled = [values / np.abs(values).max() for values in (across, upwards)]
    return rf.GroundMotion.from_arrays(
        (0.5 * scaled[0], "g_0"), f"{STEP} s", (0.4 * scaled[1], "g_0")
    )


MOTION = record()


@cache
def unbroken_run(name):
    """Run a scene without interruption, once and on demand."""
    return SCENES[name].simulate(MOTION, accuracy="reference")


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize(
    "at", [0.01, 1.37, *(pytest.param(at, marks=pytest.mark.long) for at in (3.0, 5.55))]
)
def test_a_record_split_in_two_gives_the_same_response(name, at):
    system, unbroken = SCENES[name], unbroken_run(name)
    assert not bool(unbroken.overturned)
    first = system.simulate(MOTION.window(end=f"{at} s"), accuracy="reference")
    second = system.simulate(MOTION.window(f"{at} s"), initial=first, accuracy="reference")
    place = round(at / STEP)
    for variable in ("rotation", "vertical_displacement", "horizontal_displacement"):
        scale = float(np.abs(unbroken[variable]).max())
        both = np.concatenate([first[variable].values, second[variable].values[1:]])
        assert both == pytest.approx(unbroken[variable].values, abs=2e-7 * scale)
        # no jump between the runs
        assert second[variable].values[0] == first[variable].values[-1]
    events = np.concatenate([first.event_time, second.event_time + place * STEP])
    assert events == pytest.approx(unbroken.event_time.values, abs=1e-7)
    states = [name for name in unbroken if name.endswith(("contact_state_before", "state_after"))]
    assert len(states) in (2, 4)  # of the block, and of a cap
    for name in states:
        assert [*first[name].values, *second[name].values] == unbroken[name].values.tolist()
    assert float(second.energy_residual) <= 1e-8


def test_end_state_survives_netcdf_round_trip(tmp_path):
    system = SCENES["coupled"]
    first = system.simulate(MOTION.window(end="3 s"))
    first.to_netcdf(tmp_path / "first.nc")
    with xr.open_dataset(tmp_path / "first.nc") as stored:
        later = system.simulate(MOTION.window("3 s"), initial=stored)
    now = system.simulate(MOTION.window("3 s"), initial=first)
    xr.testing.assert_equal(later, now)


def test_run_can_be_continued_without_motion():
    system = SCENES["pads"]
    first = system.simulate(MOTION.window(end="3 s"))
    calm = system.simulate(initial=first, duration="5 s")
    free = system.simulate(MOTION.window(end="3 s"), free_vibration="5 s")
    assert float(calm.rotation[-1]) == pytest.approx(float(free.rotation[-1]), abs=1e-8)
    again = system.simulate(initial=calm, duration="1 s")
    assert float(again.rotation[0]) == float(calm.rotation[-1])


def test_a_continued_run_can_be_certified():
    first = SCENES["pads"].simulate(MOTION.window(end="3 s"))
    run = SCENES["pads"].simulate(MOTION.window("3 s"), initial=first, certify=True)
    assert bool(run.verdict_converged)
    # the start of a continuation cannot be scaled
    free = SCENES["pads"].simulate(initial=first, duration="1 s", certify=True)
    assert math.isnan(free.verdict_margin)


@pytest.mark.parametrize("name", ["pads", "cascade"])
def test_continued_run_records_its_initial_state(name):
    first = SCENES[name].simulate(MOTION.window(end="3 s"))
    run = SCENES[name].simulate(initial=first, duration="0.1 s")
    assert json.loads(run.run_json)["initial"]["ending"] == json.loads(first.end_state)


def test_invalid_continuations_are_refused():
    system = SCENES["pads"]
    with pytest.raises(AssemblyError, match="holds no end of a run"):
        system.simulate(MOTION, initial=MOTION.to_dataset())
    for name in ("end_state", "system_json"):
        part = unbroken_run("pads").copy()
        del part.attrs[name]
        with pytest.raises(AssemblyError, match="holds no end of a run"):
            system.simulate(MOTION, initial=part)
    with pytest.raises(AssemblyError, match="end of a run of another system"):
        system.simulate(MOTION, initial=unbroken_run("soil"))
    fallen = system.simulate(MOTION.scaled(20.0))
    assert bool(fallen.overturned)
    with pytest.raises(AssemblyError, match="end of a run that overturned"):
        system.simulate(MOTION, initial=fallen)
    with pytest.raises(AssemblyError, match="InitialState or the result of a run, got 3"):
        system.simulate(MOTION, initial=3)


@pytest.mark.parametrize(
    ("part", "words"),
    [
        (lambda whole: whole.sel(time=slice(0.0, 3.0)), "up to 3 s; .* duration='3 s'"),
        (lambda whole: whole.sel(time=3.0, method="nearest"), "up to 3 s; .* duration='3 s'"),
        (lambda whole: whole.isel(time=slice(None, -1)), "up to 7.98 s; .* at 7.99 s"),
        (lambda whole: whole.isel(time=slice(None, None, 7)).isel(time=slice(-1)), "up to"),
        (lambda whole: whole.isel(time=[0]), "up to 0 s; .* give all of it$"),
        (lambda whole: whole.isel(time=[]), "up to 0 s; .* give all of it$"),
        (lambda whole: whole.isel(time=3, drop=True), "whose time has been dropped"),
    ],
)
def test_a_part_of_a_run_is_not_continued_from_the_end_of_the_whole(part, words):
    """A selection in time keeps the attributes of the run, and its end with them."""
    with pytest.raises(AssemblyError, match=rf"a part of a run, {words}"):
        SCENES["pads"].simulate(MOTION, initial=part(unbroken_run("pads")), duration="0.1 s")


def test_parts_that_reach_the_end_of_a_run_are_continued():
    system, whole = SCENES["pads"], unbroken_run("pads")
    options = {"duration": "0.1 s", "outputs": None}
    expected = system.simulate(MOTION, initial=whole, **options)
    for part in (whole.sel(time=slice(3.0, None)), whole.isel(time=slice(None, None, 7)),
                 whole.isel(time=-1), whole.drop_dims("time")):  # fmt: skip
        assert system.simulate(MOTION, initial=part, **options).end_state == expected.end_state
    rare = system.simulate(MOTION, output_step="0.7 s")
    assert rare.time[-1] < rare.solver_end_time
    system.simulate(MOTION, initial=rare, **options)


def test_run_that_returned_from_beyond_overturning_angle_continues():
    """With overturning="continue" as one run; runs that overturned or fell flat are refused."""
    system = rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"))
    pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    arguments = {"overturning": "continue", "outputs": None, "accuracy": "reference"}
    first = system.simulate(pulse.scaled(3.68), duration="6 s", **arguments)
    unbroken = system.simulate(pulse.scaled(3.68), duration="9 s", **arguments)
    assert bool(first.overturned)  # the angle was passed
    rest = system.simulate(initial=first, duration="3 s", **arguments)
    ends = [json.loads(run.end_state)["state"] for run in (unbroken, rest)]
    np.testing.assert_allclose(*ends, atol=1e-9)
    for scale, duration in ((3.74, "9 s"), (3.74, "3 s"), (3.68, "1.5 s")):
        run = system.simulate(pulse.scaled(scale), duration=duration, **arguments)
        with pytest.raises(AssemblyError, match="end of a run that overturned"):
            system.simulate(initial=run, duration="3 s", **arguments)


def test_units_do_not_matter():
    """The same scene in other units responds alike, to rounding."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        other = rf.System(
            rf.Block.from_size(radius="500 cm", slenderness=4, mass="50000 kg"),
            rf.TwoSpringSupport(frequency_ratio=20, damping_ratio="10 %"),
        )
    run = other.simulate(MOTION, accuracy="reference")
    assert run.rotation.values == pytest.approx(unbroken_run("pads").rotation.values, abs=1e-9)


@pytest.mark.parametrize(
    "base", ["ground", "pads", "stack", pytest.param("cap", marks=pytest.mark.wide)]
)
def test_peak_slip_of_continued_run_excludes_first_run(base):
    block = rf.Block(width="1 m", height="2 m", mass="4 t")
    statue, pads = rf.Block(width="0.5 m", height="1 m", mass="1 t"), PADS.replace(friction=0.25)
    parts = {
        "ground": (block, rf.RigidGround(friction=0.25)),
        "pads": (block, pads),
        "cap": (block, pads, CAP.replace(width="2 m", mass="4 t"), SOIL),
        "stack": (rf.Stack(statue, block.replace(height="0.6 m"), interfaces=[PADS]), pads),
    }[base]
    system = rf.System(*parts)
    pulse = rf.GroundMotion.sine_pulse("-6 m/s^2", "1 Hz")
    first = system.simulate(pulse, free_vibration="1 s")
    second = system.simulate(pulse.scaled(0.5), initial=first, free_vibration="1 s")
    slips = first.get("body_slip", first.slip), second.get("body_slip", second.slip)
    peak = float(second.get("peak_body_slip", second.peak_slip).max())
    assert float(abs(slips[0]).max()) > 1.2 * peak
    assert peak == pytest.approx(float(abs(slips[1]).max()), rel=1e-3)
