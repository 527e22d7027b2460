"""Free-decay tests: accepted data, fitted parameters, invalid arguments."""

import math

import numpy as np
import pandas as pd
import pint
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, ModelWarning, UnitsError
from rockframe.identification.measured import History, read_history, swings_of
from rockframe.identification.prediction import release_response
from rockframe.results.schema import SCHEMA
from rockframe.solve.accuracy import accuracy_of

pytestmark = pytest.mark.unit

BLOCK = rf.Block(width="0.3 m", height="1.2 m", mass="200 kg")
TRUTH = rf.System(BLOCK, rf.RigidGround(restitution=0.9), rotation="small", gravity="9.8 m/s^2")
START = rf.System(BLOCK, rotation="small", gravity="9.8 m/s^2")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
PEAKS = ([6.0, 4.57, 3.56, 2.79, 2.22, 1.77], "deg")


@pytest.fixture(scope="module")
def run():
    return TRUTH.simulate(
        duration="3 s", initial=rf.InitialState(rotation="-0.1 rad"), output_step="0.02 s"
    )


@pytest.fixture(scope="module")
def fit(run):
    return rf.fit_free_decay(START, run.rotation)


def test_fit_recovers_parameters_of_simulated_run(fit, run):
    assert float(fit.fitted_value.sel(parameter="restitution")) == pytest.approx(0.9, rel=1e-6)
    assert float(fit.initial_rotation) == pytest.approx(-0.1, rel=1e-6)
    assert float(fit.release_time) == pytest.approx(0.0, abs=1e-6)
    np.testing.assert_allclose(fit.rotation_residual, 0.0, atol=1e-7)
    np.testing.assert_array_equal(fit.time, run.time)


def test_measured_data_accept_equivalent_forms(fit, run):
    time, rotation = run.time.to_numpy(), run.rotation.to_numpy()
    labelled = xr.DataArray(
        np.degrees(rotation),
        coords={"t": ("t", 1e3 * time, {"units": "ms"})},
        dims="t",
        attrs={"units": "degree"},
    )
    pair = ((time.tolist(), "s"), (1e3 * rotation, "mrad"))
    table = pd.DataFrame({"time [ms]": 1e3 * time, "rotation [deg]": np.degrees(rotation)})
    for measured in (labelled, pair, table):
        refit = rf.fit_free_decay(START, measured)
        np.testing.assert_allclose(refit.fitted_value, fit.fitted_value, rtol=1e-8)
        np.testing.assert_allclose(refit.measured_rotation, rotation, rtol=1e-12)


@pytest.mark.parametrize("attributes", [{}, {"units": "rad"}])
def test_the_unit_of_a_quantity_is_its_own(attributes):
    """Also within a DataArray whose attribute is of another unit."""
    degrees = pint.get_application_registry().Quantity(np.array([6.0, 5.0]), "deg")
    times = {"time": ("time", [0.0, 0.5], {"units": "s"})}
    found = read_history(xr.DataArray(degrees, times, "time", attrs=attributes))
    np.testing.assert_allclose(found.rotation, np.radians([6.0, 5.0]), rtol=1e-15)


def test_dataset_follows_schema_and_survives_netcdf_round_trip(fit, tmp_path):
    for name, variable in fit.variables.items():
        if name not in ("parameter", "unknown", "other_unknown"):
            assert variable.dims == SCHEMA[name].dims, name
            assert variable.attrs.get("units") == SCHEMA[name].attributes().get("units"), name
    assert fit.attrs["title"] == "Free-decay test"
    assert fit.attrs["verdict"].startswith("Restitution 0.")
    assert list(fit.unknown.values) == [
        "restitution", "initial_rotation", "release_time", "gauge_offset",
    ]  # fmt: skip
    np.testing.assert_allclose(np.diag(fit.correlation), 1.0)
    fit.to_netcdf(tmp_path / "found.nc")
    with xr.open_dataset(tmp_path / "found.nc") as stored:
        xr.testing.assert_identical(stored.load(), fit)


def test_fitted_system_differs_only_in_parameters(fit):
    system = rf.System.from_dataset(fit)
    restitution = system.parts.ground.restitution
    assert restitution == float(fit.fitted_value[0])
    assert system == rf.System(
        BLOCK, rf.RigidGround(restitution=restitution), rotation="small", gravity="9.8 m/s^2"
    )


def test_ambiguous_parameter_name_raises():
    soil = rf.WinklerSoil(stiffness="2 MPa", damping_ratio=0.2)
    system = rf.System(BLOCK, PADS, rf.CushionCap(height="0.1 m", mass="100 kg"), soil)
    with pytest.raises(ComponentError, match=r"'TwoSpringSupport\.damping_ratio', 'Winkler"):
        rf.fit_free_decay(system, peaks=PEAKS, parameters="damping_ratio")


def test_known_circumstances_are_not_fitted(run):
    fit = rf.fit_free_decay(START, run.rotation, circumstances=())
    assert list(fit.unknown.values) == ["restitution"]
    assert float(fit.initial_rotation) == float(run.rotation[0])
    assert math.isnan(float(fit.gauge_offset_error))
    assert float(fit.gauge_offset) == 0.0


def test_unidentifiable_parameter_warns():
    system = rf.System(BLOCK, PADS)
    released = rf.InitialState(rotation=f"{0.5 * system.setting.uplift_angle!r} rad")
    run = system.simulate(duration="3 s", initial=released, output_step="0.02 s")
    with pytest.warns(ModelWarning, match="does not tell restitution"):
        fit = rf.fit_free_decay(system, run.rotation, ("damping_ratio", "restitution"))
    assert float(fit.fitted_value[0]) == pytest.approx(0.1, rel=1e-5)
    assert math.isnan(float(fit.standard_error[1]))


def test_wrong_time_unit_warns(run):
    with pytest.warns(ModelWarning):
        fit = rf.fit_free_decay(START, ((run.time.values, "ms"), (run.rotation.values, "rad")))
    assert np.isnan(fit.correlation).any()


def test_release_response_agrees_with_simulation():
    system = rf.System(BLOCK, PADS)
    run = system.simulate(
        duration="3 s", initial=rf.InitialState(rotation="0.1 rad"), output_step="1.7 ms"
    )
    motion = release_response(system.assembly, 0.1, 3.0, accuracy_of("standard"))
    np.testing.assert_allclose(motion.at(run.time.to_numpy()), run.rotation, atol=2e-8)
    times, sizes = motion.peaks()
    assert times[0] == 0.0
    assert sizes[0] == 0.1
    np.testing.assert_allclose(np.abs(motion.at(times)), sizes, atol=1e-9)
    assert np.all(np.diff(sizes) < 0.0)


def test_swings_of_a_noisy_record():
    time = np.arange(0.0, 6.0, 0.01)
    clean = 0.1 * np.exp(-0.2 * time) * np.cos(2.0 * math.pi * time)
    noise = 1e-3 * np.random.default_rng(0).normal(size=time.size)
    swings = swings_of(History(time, clean + noise))
    assert swings.crossing == pytest.approx(0.25, abs=0.01)
    np.testing.assert_allclose(swings.peaks.time[1:], 0.5 * np.arange(1, 12), atol=0.02)
    np.testing.assert_array_equal(swings.peaks.sides, (-1.0) ** np.arange(12))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_swings_are_about_the_reading_at_rest(side):
    """A decaying vibration in closed form, read with an offset."""
    time, rate, frequency = np.arange(0.0, 10.0, 0.01), 0.4, 2.0 * math.pi
    curve = side * 0.1 * np.exp(-rate * time) * np.cos(frequency * time)
    found = swings_of(History(time, curve + 0.02))
    assert found.offset == pytest.approx(0.02, abs=2e-4)
    assert found.crossing == pytest.approx(0.25, abs=2e-3)
    # the eleventh swing is the last above a tenth of the first, and may be incomplete
    when = 0.5 * np.arange(1, 11) - math.atan(rate / frequency) / frequency
    np.testing.assert_allclose(found.peaks.time[1:], when, rtol=0.0, atol=1e-3)
    peaks = side * 0.1 * np.exp(-rate * when) * np.cos(frequency * when)
    np.testing.assert_allclose(found.peaks.rotation[1:], 0.02 + peaks, rtol=0.0, atol=1e-4)
    assert found.peaks.rotation[0] == side * 0.1 + 0.02
    np.testing.assert_array_equal(found.peaks.sides, side * (-1.0) ** np.arange(1 + when.size))


TIME = np.arange(0.0, 3.0, 0.02)
SWING = 0.1 * np.cos(2.0 * math.pi * TIME)


def history(rotation=SWING, time=TIME):
    return ((time, "s"), (rotation, "rad"))


def changed(values, index, value):
    copy = values.copy()
    copy[index] = value
    return copy


def test_times_of_peaks_count_as_data_from_any_start():
    start = rf.InitialState(rotation="0.1 rad")
    run = TRUTH.simulate(duration="4 s", initial=start, output_step="1 ms")
    swings = swings_of(History(run.time.to_numpy(), run.rotation.to_numpy()))
    rotation, times = swings.peaks.rotation[:3], np.append(0.0, swings.peaks.time[1:3])
    # six data tell three unknowns
    found = rf.fit_free_decay(START, peaks=((times + 100.0, "s"), (rotation, "rad")))
    assert found.release_time.item() == pytest.approx(100.0, abs=1e-3)
    differences = found.measured_peak_time - found.fitted_peak_time
    np.testing.assert_array_equal(found.peak_time_residual, differences)
    for kind, residual in (("time", differences), ("rotation", found.peak_rotation_residual)):
        size = np.sqrt((residual**2).mean()).item()
        assert found[f"{kind}_rms_residual"].item() == pytest.approx(size, rel=1e-12)
    given = rf.fit_free_decay(
        START,
        peaks=((times + 100.0, "s"), (rotation, "rad")),
        circumstances="initial_rotation",
    )
    assert given.release_time.item() == 100.0
    np.testing.assert_allclose(given.fitted_value, found.fitted_value, rtol=1e-3)


REFUSED = [
    (
        {"measured": history(changed(SWING, 7, math.nan))},
        "rotation must be finite, got nan at index 7",
    ),
    ({"measured": history(time=changed(TIME, 5, 0.01))}, "times must increase"),
    ({"measured": history(SWING[:-1])}, "150 times and 149 rotations"),
    ({"measured": history(0.3 * SWING / 0.1)}, "not below the overturning angle"),
    ({"measured": history(0.0 * SWING)}, "nothing rocks"),
    ({"measured": history(0.0 * SWING + 0.05)}, "nothing rocks"),
    ({"measured": history(), "parameters": "damping_ratio"}, "no part of the system has"),
    ({"measured": history(), "parameters": ()}, "must name one or more"),
    ({"measured": history(), "peaks": PEAKS}, "got both"),
    ({}, "got neither"),
    ({"measured": history(), "confidence": 1.0}, "above 0 and below 1"),
    ({"measured": history(), "circumstances": "weather"}, "circumstances must be"),
    ({"peaks": ([6.0, 5.0], "deg")}, "2 data do not tell 2 unknowns"),
    ({"peaks": (([0.0], "s"), ([6.0], "deg")), "circumstances": ()}, "found one peak"),
    ({"peaks": ([6.0, -5.0, -4.0, 3.0], "deg")}, "must alternate in sign"),
    ({"peaks": ([6.0, 5.0, 0.0], "deg")}, "none be zero"),
    ({"peaks": ([6.0, 20.0, 3.0], "deg")}, "peak 2 is 0.349066 rad"),
    ({"peaks": ([BLOCK.overturning_angle.m, 0.1, 0.08], "rad")}, "peak 1 is .*, not below the"),
    ({"peaks": ([], "deg")}, "peaks needs a one-dimensional array"),
    ({"measured": history([SWING])}, "rotation needs a one-dimensional array"),
    ({"measured": history(["a"] * len(TIME))}, "rotation needs numbers"),
    ({"peaks": PEAKS, "circumstances": "release_time"}, "without times"),
    ({"peaks": PEAKS, "circumstances": "gauge_offset"}, "without their signs"),
]


def test_invalid_test_data_are_refused():
    for arguments, words in REFUSED:
        with pytest.raises(ComponentError, match=words):
            rf.fit_free_decay(START, **arguments)
    with pytest.raises(ComponentError, match="needs a System, got Block"):
        rf.fit_free_decay(BLOCK, history())
    stiff = rf.TwoSpringSupport(stiffness="500 kN/m", damping_ratio=0.1)
    with pytest.raises(ComponentError, match=r"give TwoSpringSupport.frequency_ratio as a start"):
        rf.fit_free_decay(rf.System(BLOCK, stiff), history(), "frequency_ratio")


@pytest.mark.parametrize(
    "arguments",
    [
        {"measured": (TIME, SWING)},
        {"measured": SWING},
        {"measured": ((TIME, "s"), (SWING, "m"))},
        {"measured": ((TIME, "deg"), (SWING, "s"))},
        {"measured": (SWING, "rad")},
        {"peaks": [6.0, 5.0, 4.0]},
        {"peaks": ([6.0, 5.0, 4.0], "s")},
        {"measured": xr.DataArray(SWING, coords={"time": TIME}, dims="time")},
        {"measured": ((TIME, "s"), (xr.DataArray(SWING, attrs={"units": "rad"}), "deg"))},
        {"measured": ((xr.DataArray(TIME, attrs={"units": "s"}), "ms"), (SWING, "rad"))},
        {"peaks": (xr.DataArray([0.1, 0.08, 0.07], attrs={"units": "rad"}), "deg")},
    ],
)
def test_arrays_need_units(arguments):
    words = (
        r"(time|rotation|measured|peaks) (needs |has the unit '\w+', but '\w+' is given with it)"
    )
    with pytest.raises(UnitsError, match=words):
        rf.fit_free_decay(START, **arguments)


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("first", ["6 deg", "-6 deg", "-12 deg"])
def test_signed_peaks_of_eccentric_block_give_restitution(first, rotation):
    """To the left the rotation may exceed the overturning angle to the right."""
    block = BLOCK.replace(centre_of_mass=("0.6 m", "0.03 m"))
    ground = rf.RigidGround(restitution=0.7 if first.startswith("-12") else 0.85)
    start = rf.InitialState(rotation=first)
    system = rf.System(block, ground, rotation=rotation)
    run = system.simulate(duration="6 s", initial=start, output_step="2 ms")
    assert not run.overturned
    swings = swings_of(History(run.time.to_numpy(), run.rotation.to_numpy()))
    peaks = swings.peaks.rotation[:7]
    fit = rf.fit_free_decay(rf.System(block, rotation=rotation), peaks=(peaks, "rad"))
    assert fit.fitted_value.item() == pytest.approx(ground.restitution, abs=1e-3)
    # on rigid ground the start from :eq:`eq-rigid-decay` is nearly exact
    assert fit.trial_count <= 4
    with pytest.raises(ComponentError, match="without their signs do not tell the sides"):
        rf.fit_free_decay(rf.System(block), peaks=(np.abs(peaks), "rad"))


@pytest.mark.parametrize(
    "ties", [(), (rf.Tendon(stiffness="1 kN/m", preload="0.1 kN", at="0 m"),)], ids=len
)
def test_the_restitution_of_a_frame_is_found_without_its_ground(ties):
    frame = rf.RockingFrame(BLOCK, columns=3, beam_mass="400 kg")
    truth = rf.System(frame, rf.RigidGround(restitution=0.85), *ties)
    start = rf.InitialState(rotation="-0.1 rad")
    run = truth.simulate(duration="2 s", initial=start, output_step="0.02 s")
    fit = rf.fit_free_decay(rf.System(frame, *ties), run.rotation)
    assert fit.fitted_value.item() == pytest.approx(0.85, rel=1e-6)


@pytest.mark.parametrize("data", [{"peaks": ([9.0, 4.0, 2.1], "deg")}, {"measured": "history"}])
def test_a_block_before_a_rigid_wall_is_refused(data, run):
    """All peaks are on one side, but the model gives peaks of both sides."""
    wall = rf.RearWall(side="left", restitution="newton", wall_restitution=0.6)
    arguments = data if "peaks" in data else {"measured": run.rotation}
    with pytest.raises(ComponentError, match="before a rigid RearWall and rocks to one side only"):
        rf.fit_free_decay(rf.System(BLOCK, wall), parameters="wall_restitution", **arguments)


def test_stack_interface_parameter_raises_and_lists_alternatives():
    joint = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
    bodies = [
        rf.Block(width=f"{w} m", height=f"{h} m", mass="900 kg") for w, h in ((0.5, 1.8), (0.9, 1))
    ]
    stack = rf.Stack(*bodies, interfaces=[joint])
    expected = (
        r"'damping_ratio' is a parameter of an interface of the Stack; fitted are those of the "
        r"parts of the system, which are .*'RigidGround\.friction'.*sweep over a function"
    )
    with pytest.raises(rf.errors.ComponentError, match=expected):
        rf.fit_free_decay(
            rf.System(stack, rf.RigidGround(friction=0.9)), history(), "damping_ratio"
        )
