"""Suites: mapping of motions, table, selection, operations, storage."""

import copy
import pickle

import numpy as np
import pytest
import xarray as xr
from unit.suites.downloads import STATIONS, download, packed

import rockframe as rf
from rockframe.errors import (
    ComponentError,
    RecordError,
    RecordWarning,
    SchemaError,
    UnitsError,
)

SUITE = rf.read_suite(packed(download()))
PULSES = [rf.GroundMotion.sine_pulse("1 m/s^2", f"{f} Hz") for f in (1, 2, 4)]
PULSE_SUITE = rf.MotionSuite({"slow": PULSES[0], "fast": PULSES[1]})


def labels(number: int) -> list[str]:
    return [f"RSN{number}_MADE_S{number}{end}" for end in ("000", "090")]


def test_it_is_a_mapping_in_order():
    assert list(SUITE) == [name for station in STATIONS for name in labels(station.number)]
    assert len(SUITE) == 6
    assert SUITE[labels(6)[0]] is next(iter(SUITE.values()))
    assert "RSN6_MADE_S6-UP" not in SUITE
    assert dict(SUITE) == SUITE
    assert "6 motions" in repr(SUITE)
    assert "2 vertical components" in repr(SUITE)
    assert pickle.loads(pickle.dumps(SUITE)) == SUITE  # noqa: S301
    assert copy.deepcopy(SUITE) == SUITE


def test_suite_is_built_from_valid_motions_only():
    suite = rf.MotionSuite(PULSES)
    assert [motion.name for motion in suite.values()] == list(suite)
    assert "1 motion:" in repr(suite.only([PULSES[0].name]))
    for motions, words in {
        "record.AT2": "motions must be several motions, got 'record.AT2'; rf.read_suite",
        (): "found no motions",
        (PULSES[0], PULSES[0]): "two motions are called",
        (PULSES[0], 3.0): "needs a GroundMotion, got 3.0",
    }.items():
        with pytest.raises(ComponentError, match=words):
            rf.MotionSuite(motions)
    with pytest.raises(ComponentError, match="must be several motions"):
        rf.MotionSuite(PULSES[0])
    with pytest.raises(ComponentError, match="names a motion and a vertical component"):
        rf.MotionSuite({"a": PULSES[0]}, verticals={"a": PULSES[0]})


def test_the_table():
    table = SUITE.table
    assert list(table.index) == list(SUITE)
    assert table.index.name == "motion"
    assert table["magnitude"].tolist() == [6.95, 6.95, 7.36, 7.36, 5.6, 5.6]
    assert table["rupture_distance [m]"].tolist()[:2] == [7090.0, 7090.0]
    assert np.isnan(table["shear_wave_velocity_30 [m s^-1]"].tolist()[-1])
    assert table["axis"].tolist() == ["H1", "H2"] * 3
    assert table["azimuth [rad]"].tolist()[:2] == pytest.approx([0.0, np.pi / 2])
    peaks = [motion.si.peak for motion in SUITE.values()]
    assert table["peak_ground_acceleration [m s^-2]"].tolist() == peaks
    assert table["source_file"].tolist()[0] == "RSN6_MADE_S6000.AT2"
    assert "magnitude" not in PULSE_SUITE.table
    mixed = rf.MotionSuite([*SUITE.only(labels(6)).values(), PULSES[0]]).table
    assert mixed["event"].tolist()[-1] == ""
    assert np.isnan(mixed["magnitude"].tolist()[-1])


def test_selecting():
    chosen = {
        (6, 14): {"magnitude": (6, 8)},
        (6, 78): {"event": "valley-02"},
        (14,): {"rupture_distance": ("50 km", None)},
        (6,): {"rupture_distance": (None, "20 km"), "magnitude": (6.5, None)},
        (6, 14, 78): {"year": 1940},
        (14, 78): {"record_sequence_number": [14, 78, 99]},
        (78,): {"magnitude": lambda value: value < 6},
        (14, 6): {"shear_wave_velocity_30": (None, "600 m/s")},
    }
    for numbers, criteria in chosen.items():
        expected = {name for number in numbers for name in labels(number)}
        selected = SUITE.select(**criteria)
        assert set(selected) == expected, criteria
        assert {motion.metadata["record"] for motion in selected.verticals.values()} <= {
            f"RSN{number}" for number in numbers
        }
        assert selected.unread == SUITE.unread
    east = SUITE.select(azimuth="90 deg")
    assert list(east) == [labels(station.number)[1] for station in STATIONS]
    assert set(SUITE.select(axis="H2")) == set(east)
    assert len(SUITE.select(source_file="RSN6_MADE_S6000.AT2")) == 1
    with pytest.raises(UnitsError, match="rupture_distance needs a length with a unit, got 20"):
        SUITE.select(rupture_distance=(None, 20))
    with pytest.raises(ComponentError, match="no column 'mag'; known are"):
        SUITE.select(mag=(6, 8))
    with pytest.raises(ComponentError, match=r"no motion has magnitude=\(8, 9\)"):
        SUITE.select(magnitude=(8, 9))
    with pytest.raises(ComponentError, match="a range of two"):
        SUITE.select(magnitude=(8, 9, 10))
    with pytest.raises(ComponentError, match=r"event needs a range of words, .* got \(1, 2\)"):
        SUITE.select(event=(1, 2))


def test_sorting_and_picking():
    by_size = SUITE.sort("magnitude")
    assert [motion.metadata["magnitude"] for motion in by_size.values()] == [
        5.6,
        5.6,
        6.95,
        6.95,
        7.36,
        7.36,
    ]
    by_number = SUITE.sort("record_sequence_number")  # not as texts
    assert [*dict.fromkeys(motion.metadata["record"] for motion in by_number.values())] == [
        "RSN6", "RSN14", "RSN78",
    ]  # fmt: skip
    falling = SUITE.sort("shear_wave_velocity_30", descending=True)
    assert [motion.metadata["record"] for motion in falling.values()][::2] == [
        "RSN14",
        "RSN6",
        "RSN78",
    ]
    assert next(iter(SUITE.sort("event"))) in labels(14)
    assert list(SUITE.only(labels(14)[::-1])) == labels(14)[::-1]
    with pytest.raises(ComponentError, match="no motion 'x'"):
        SUITE.only(["x"])
    with pytest.raises(ComponentError, match="no column"):
        SUITE.sort("size")


def test_changed_applies_to_all_motions():
    doubled = SUITE.changed(lambda motion: motion.scaled(2))
    for before, after in ((SUITE, doubled), (SUITE.verticals, doubled.verticals)):
        for label in before:
            np.testing.assert_array_equal(
                after[label].si.horizontal.samples, 2.0 * before[label].si.horizontal.samples
            )
    with pytest.raises(ComponentError, match="needs a GroundMotion"):
        SUITE.changed(lambda motion: motion.name)


def test_measures_of_a_suite_are_those_of_its_motions():
    periods = ([0.2, 1.0], "s")
    block = rf.Block(width="1 m", height="4 m", mass="1 t")
    for function, arguments in (
        (rf.intensity_measures, {"block": block}),
        (rf.response_spectrum, {"periods": periods, "damping_ratios": (0.02, 0.05)}),
        (rf.average_spectral_acceleration, {"periods": periods}),
    ):
        measures = getattr(SUITE, function.__name__)(**arguments)
        xr.testing.assert_identical(
            measures.drop_attrs(), function(dict(SUITE), **arguments).drop_attrs()
        )
        assert measures["motion"].to_numpy().tolist() == list(SUITE)
        for label, motion in SUITE.items():
            alone = function(motion, **arguments)
            row = measures.sel(motion=label)
            for name in alone.data_vars:
                assert row[name].dims == alone[name].dims
                np.testing.assert_array_equal(row[name], alone[name])
                assert row[name].attrs == alone[name].attrs
    rotated = SUITE.rotated_spectrum(periods)
    assert rotated["motion"].to_numpy().tolist() == list(SUITE.pairs)
    alone = rf.rotated_spectrum(SUITE.pairs["RSN14"], periods)
    name = "median_rotated_acceleration"
    np.testing.assert_array_equal(rotated.sel(motion="RSN14")[name], alone[name])
    assert "vertical_to_horizontal_ratio" not in rotated  # one of them has no vertical
    assert "vertical_to_horizontal_ratio" in SUITE.only(labels(14)).rotated_spectrum(periods)


def test_a_table_of_measures():
    table = rf.table(SUITE.intensity_measures())
    assert list(table.index) == list(SUITE)


def test_suite_survives_netcdf_round_trip(tmp_path):
    floor = rf.GroundMotion.stochastic(6, "20 km", seed=1, vertical=0.6)
    mixed = rf.MotionSuite(
        {
            "pulse": PULSES[0],
            "both": floor,
            "upright": PULSES[0].with_vertical(PULSES[0].scaled(0.5)),
        },
        verticals={"V": PULSES[2]},
        unread={"x.AT2": "empty"},
        remarks=["odd"],
    )
    named = rf.MotionSuite(dict.fromkeys(("b", "a / 第1", "10", "9", " x ", ""), floor))
    for suite in (SUITE, mixed, PULSE_SUITE, named):
        path = tmp_path / "suite.nc"
        suite.to_dataset().to_netcdf(path)
        with xr.open_dataset(path) as stored:
            reopened = rf.MotionSuite.from_dataset(stored.load())
        for other in (
            reopened,
            rf.read_suite(path),
            rf.MotionSuite.from_dataset(suite.to_dataset()),
        ):
            assert list(other) == list(suite)
            for originals, restored_motions in ((suite, other), (suite.verticals, other.verticals)):
                for label, motion in originals.items():
                    restored = restored_motions[label]
                    assert restored == motion
                    assert restored.sha256 == motion.sha256
                    assert dict(restored.metadata) == dict(motion.metadata)
                    assert restored.history == motion.history
                    assert restored.recipe == motion.recipe
            assert dict(other.unread) == dict(suite.unread)
            assert other.remarks == suite.remarks
        path.unlink()


def test_unnamed_motions_take_labels_as_names():
    former = PULSE_SUITE.to_dataset().drop_vars("motion_name")
    assert [motion.name for motion in rf.MotionSuite.from_dataset(former).values()] == [
        "slow",
        "fast",
    ]


def test_a_dataset_that_was_changed_is_refused(tmp_path):
    dataset = SUITE.to_dataset()
    for change, words in (
        (lambda one: one.assign(acceleration=2.0 * one.acceleration), "that were changed since"),
        (lambda one: one.assign(sample_count=one.sample_count + 1), "its counts add up to 3208"),
        (lambda one: one.drop_vars("metadata"), "there is no 'metadata'"),
        (lambda one: one.assign_attrs(unread="["), r"cannot be read \(Expecting value"),
        (lambda one: one.assign_attrs(kind="other"), "found 'Suite of ground motions'"),
        (lambda one: SUITE["RSN6_MADE_S6000"].to_dataset(), "found 'Ground motion RSN6_MADE_S60"),
    ):
        with pytest.raises(SchemaError, match=words):
            rf.MotionSuite.from_dataset(change(dataset.copy()))
    dataset.assign(acceleration=2.0 * dataset.acceleration).to_netcdf(tmp_path / "x.nc")
    with pytest.raises(RecordError, match="changed since"):
        rf.read_suite(tmp_path / "x.nc")
    with pytest.raises(SchemaError, match="open a file"):
        rf.MotionSuite.from_dataset("x.nc")


def test_runs_over_a_suite():
    """Functions of mappings of motions accept a suite."""
    system = rf.System(rf.Block(width="0.4 m", height="2 m", mass="100 kg"))
    runs = rf.concat(
        [system.simulate(motion, outputs=None) for motion in SUITE.values()], "motion", list(SUITE)
    )
    assert runs.sizes["motion"] == len(SUITE)


def test_missing_vertical_components_warn():
    target = rf.TargetSpectrum.eurocode_8("0.2 g_0")
    scaled = SUITE.scaled_to(target, bounds=None)
    with pytest.warns(RecordWarning, match="no motion has a vertical component; set them beside"):
        scaled.with_verticals()
    before = SUITE.with_verticals().scaled_to(target, bounds=None)
    assert before[labels(6)[0]].vertical_acceleration is not None
    assert before.with_verticals()[labels(6)[0]] == before[labels(6)[0]]


def test_target_survives_dataset_round_trip():
    target = rf.TargetSpectrum.eurocode_8("0.2 g_0", "B", damping_ratio=0.03)
    periods = (np.geomspace(0.2, 3.0, 12), "s")
    scaled = SUITE.scaled_to(target.with_deviation(0.3), bounds=None, periods=periods)
    formula = rf.MotionSuite(PULSES, target=target)
    for suite in (scaled, formula):
        restored = rf.MotionSuite.from_dataset(suite.to_dataset()).target
        assert (restored.name, restored.damping_ratio) == (suite.target.name, 0.03)
        assert restored.at(periods) == pytest.approx(suite.target.at(periods), rel=1e-3)
        assert (
            restored.deviations_at(periods[0]).tolist()
            == suite.target.deviations_at(periods[0]).tolist()
        )
    restored = rf.MotionSuite.from_dataset(scaled.to_dataset()).target
    assert restored.limits == pytest.approx((0.2, 3.0))
    assert restored.at(periods) == pytest.approx(scaled.target.at(periods), rel=1e-14)
    assert rf.MotionSuite.from_dataset(SUITE.to_dataset()).target is None
