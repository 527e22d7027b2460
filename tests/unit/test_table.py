"""Results as tables: headings with units, words for flags, labels that distinguish runs."""

import runpy
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError
from rockframe.results.schema import SCHEMA

pytestmark = pytest.mark.unit

SYSTEM = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"), rf.RigidGround())
PULSE = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
SCALES = [2.0, 2.5, 9.0]


def run(motion=PULSE, **options):
    return SYSTEM.simulate(motion, free_vibration="3 s", **options)


@pytest.fixture(scope="module")
def runs():
    return [run(PULSE.scaled(scale)) for scale in SCALES]


@pytest.fixture(scope="module")
def study(runs):
    return rf.concat(runs, "scale", SCALES)


def word(values):
    attributes = values.attrs
    return attributes["flag_meanings"].split()[
        attributes["flag_values"].tolist().index(values.item())
    ]


def check_row(row, response):
    """Compare a row with the scalars of its run, one by one."""
    for name, values in response.data_vars.items():
        if values.dims:
            continue
        unit = values.attrs.get("units", "1")
        found = row[name if unit == "1" else f"{name} [{unit}]"]
        if SCHEMA[name].flags:
            assert found == word(values), name
        else:
            np.testing.assert_array_equal(found, values.item(), err_msg=name)


def test_cautions_of_runs_are_a_column(runs):
    warned = runs[0].assign_attrs(cautions="not one to trust")
    assert rf.table(warned).message.tolist() == ["not one to trust"]
    assert rf.table([warned, runs[1]]).message.tolist() == ["not one to trust", "none"]
    assert "message" not in rf.table(warned, "events")
    assert rf.table(warned).index.names == ["motion"]
    single = rf.concat([warned, runs[1]], "scale", SCALES[:2]).isel(scale=0)
    assert rf.table(single).message.tolist() == ["not one to trust"]
    assert "message" not in rf.table(single).index.names


def test_points_and_restrainers_have_separate_columns():
    tie = rf.Restrainer(
        on=("-0.4 m", "4 m"), to=("-2 m", "4 m"), stiffness="1 MN/m", name="strap"
    )  # fmt: skip
    tied = rf.System(*SYSTEM.parts.structural()[:1], tie)
    found = rf.sweep(
        tied, PULSE, scale=SCALES[:2], points={"top": ("0 m", "4 m")}, free_vibration="1 s"
    )
    table = rf.table(found, units={"force": "kN"})
    assert len(table) == 2
    for head, name, label in (
        ("peak_restrainer_force strap [kN]", "peak_restrainer_force", {"restrainer": "strap"}),
        ("peak_point_horizontal_acceleration top [m s^-2]",
         "peak_point_horizontal_acceleration", {"point": "top"}),
    ):  # fmt: skip
        size = 1e3 if "kN" in head else 1.0
        expected = found[name].sel(label).to_numpy().ravel() / size
        assert table[head].to_numpy() == pytest.approx(expected)
    alone = rf.table(found[["peak_restrainer_force"]])
    assert alone.index.names == ["scale", "motion", "restrainer"]


def test_a_run_is_a_row_of_its_scalars(runs):
    for response in runs:
        table = rf.table(response)
        scalars = sum(not values.dims for values in response.data_vars.values())
        assert table.shape == (1, scalars + 1)  # the message
        assert table.index.tolist() == [response.attrs["motion"]]
        assert table.index.name == "motion"
        check_row(table.iloc[0], response)
        assert table.overturned.dtype == bool
        assert table.impact_count.dtype == np.int64
    assert rf.table(runs[2])["overturning_direction"].item() in ("left", "right")
    assert rf.table(runs[0])["overturning_direction"].item() == "none"
    assert "peak_rotation [rad]" in rf.table(runs[0])


def test_joined_runs_have_their_dimensions_as_index(runs, study):
    table = rf.table(study)
    assert table.index.name == "scale"
    for scale, response in zip(SCALES, runs, strict=True):
        check_row(table.loc[scale], response)
    rows = [study, study.isel(scale=slice(None, None, -1)).assign_coords(scale=SCALES)]
    grid = rf.table(rf.concat(rows, "case", ["up", "down"]))
    assert grid.index.names == ["case", "scale"]
    assert len(grid) == 6
    check_row(grid.loc[("down", 9.0)], runs[0])
    check_row(grid.loc[("up", 9.0)], runs[2])
    assert grid.overturned.dtype == bool
    with_unit = study.assign_coords(scale=("scale", SCALES, {"units": "m s^-2"}))
    assert rf.table(with_unit).index.name == "scale [m s^-2]"
    named = study.assign_coords(kind=("scale", ["a", "b", "c"]), place="here")
    assert rf.table(named).kind.tolist() == ["a", "b", "c"]
    stacked = rf.concat(rows, "case", ["up", "down"]).stack(both=("case", "scale"))
    assert len(rf.table(stacked)) == 6


def test_listed_runs_have_distinct_indices(runs):
    other = run(rf.GroundMotion.sine_pulse("2 m/s^2", "2 Hz"))
    different = rf.table([runs[0], other])
    assert different.index.tolist() == [runs[0].attrs["motion"], other.attrs["motion"]]
    same = rf.table(one for one in runs)
    assert same.index.names == ["motion", "run"]
    assert same.index.get_level_values("run").tolist() == [0, 1, 2]
    assert len(same.loc[runs[0].attrs["motion"]]) == 3
    placed = [one.assign_coords(scale=s) for one, s in zip(runs, SCALES, strict=True)]
    scaled = rf.table(placed)
    assert scaled.index.names == ["motion", "scale"]
    assert scaled.index.get_level_values("scale").tolist() == SCALES
    assert rf.table(placed[1]).index.names == ["motion", "scale"]
    named = rf.table(dict(zip(("low", "middle", "high"), runs, strict=True)))
    assert named.index.tolist() == ["low", "middle", "high"]
    nameless = rf.table([SYSTEM.equilibrium(), SYSTEM.equilibrium()])
    assert nameless.index.tolist() == [0, 1]
    for table in (same, scaled, named):
        for row, response in zip((table.iloc[i] for i in range(3)), runs, strict=True):
            check_row(row, response)


def test_histories_and_events_are_separate_tables(runs):
    response = runs[2]
    histories = rf.table(response, "histories")
    assert histories.index.name == "time [s]"
    assert len(histories) == response.sizes["time"]
    np.testing.assert_array_equal(histories["rotation [rad]"], response.rotation)
    assert set(histories.contact_state) <= {"full", "left", "right", "flight"}
    assert histories.shape[1] == sum(v.dims == ("time",) for v in response.data_vars.values())
    events = rf.table(response, "events")
    assert len(events) == response.sizes["event"]
    assert events.event_kind.iloc[-1] == "overturning"
    np.testing.assert_array_equal(events["event_time [s]"], response.event_time)
    both = rf.table(runs, "histories")
    assert len(both) == sum(one.sizes["time"] for one in runs)
    assert both.index.names == ["motion", "run", "time [s]"]
    assert rf.table(dict(zip(SCALES, runs, strict=True)), "events").loc[9.0].equals(events)


def test_joined_histories_end_where_their_runs_end(runs):
    """Padding of joined runs is not a row, however they were joined."""
    bare = [one.drop_dims("event") for one in runs]
    joined = xr.concat(bare, "scale", data_vars="all", join="outer").assign_coords(scale=SCALES)
    table = rf.table(joined, "histories")
    assert len(table) == sum(one.sizes["time"] for one in runs)
    for scale, response in zip(SCALES, runs, strict=True):
        np.testing.assert_array_equal(table.loc[scale]["rotation [rad]"], response.rotation)
        words = rf.table(response, "histories").contact_state
        assert table.loc[scale].contact_state.tolist() == words.tolist()


def test_values_of_only_some_runs_are_missing_in_others(runs):
    certified = run(PULSE.scaled(2.0), certify=rf.Certification(runs=60))
    table = rf.table([runs[0], certified])
    assert pd.isna(table.verdict_converged.iloc[0])
    assert table.verdict_converged.iloc[1] is True
    joined = xr.concat(
        [one.drop_dims(["time", "event"]) for one in (runs[0], certified)], "run", data_vars="all"
    )
    found = rf.table(joined).verdict_converged
    assert found.dtype == "boolean"
    assert found.tolist() == [pd.NA, certified.verdict_converged.item()]


def test_table_survives_csv_round_trip(study, tmp_path):
    for dataset, index in ((study, "scale"), (rf.concat([study] * 2, "case"), ["case", "scale"])):
        table = rf.table(dataset)
        table.to_csv(tmp_path / "study.csv")
        again = pd.read_csv(tmp_path / "study.csv", index_col=index)
        pd.testing.assert_frame_equal(again, table, check_exact=True)


def test_table_of_a_reopened_dataset_is_equal(study, tmp_path):
    study.to_netcdf(tmp_path / "study.nc")
    with xr.open_dataset(tmp_path / "study.nc") as again:
        pd.testing.assert_frame_equal(rf.table(again), rf.table(study))


def test_frequencies_spectra_and_measures_become_tables():
    modes = rf.table(rf.System(SYSTEM.parts.block, rf.TwoSpringSupport(
        frequency_ratio=20, damping_ratio=0.1)).frequencies())  # fmt: skip
    assert modes.index.tolist() == [1, 2]
    assert "period [s]" in modes
    spectrum = rf.table(rf.response_spectrum(PULSE, ["0.5 s", "1 s"], damping_ratios=(0.02, 0.05)))
    assert spectrum.index.names == ["damping_ratio", "period [s]"]
    assert len(spectrum) == 4
    measures = rf.table([rf.intensity_measures(PULSE), rf.intensity_measures(PULSE.scaled(2.0))])
    ratio = measures["peak_ground_acceleration [m s^-2]"]
    assert ratio.iloc[1] == 2.0 * ratio.iloc[0]


def test_variables_of_other_dimensions_have_separate_rows():
    """Rows are added, not multiplied by unrelated dimensions."""
    labels = {"quantile": [0.1, 0.9], "scale": np.arange(5.0), "response_level": [0.1, 0.2, 0.3]}
    curves = xr.Dataset(
        {
            "response_fractile": (("quantile", "scale"), np.ones((2, 5))),
            "overturned_count": ("scale", np.arange(5)),
            "intensity_fractile": (("quantile", "response_level"), np.ones((2, 3))),
        },
        labels,
    )
    table = rf.table(curves)
    assert len(table) == 2 * 5 + 2 * 3
    assert set(table.index.names) == {"quantile", "scale", "response_level"}
    counts = table["overturned_count"].dropna()
    assert counts.groupby("scale").first().tolist() == list(range(5))
    alone = rf.table(curves[["intensity_fractile"]])
    assert alone.index.names == ["quantile", "response_level"]


def test_means_of_runs_are_numbers(study):
    """Truth values and flags that are averaged keep their attributes, but are words no more."""
    with xr.set_options(keep_attrs=True):
        means = rf.table(study.expand_dims(site=2).mean("scale"))
        same = rf.table(study.expand_dims(site=2).mean("site"))
    share = float(study.overturned.mean())
    assert 0.0 < share < 1.0
    assert means["overturned"].tolist() == [share, share]
    assert means["status"].tolist() == [float(study.status.mean())] * 2
    assert same["status"].tolist() == ["completed", "completed", "overturned"]
    assert same["overturned"].tolist() == [False, False, True]


@pytest.mark.filterwarnings("error::FutureWarning")
def test_stacked_sweeps_are_tables_and_fragilities_in_any_unit():
    """xarray refuses to replace a level of an index, and warns when one of several is deleted."""
    motions = {"one": PULSE, "two": PULSE.scaled(1.5)}
    options = {"width": ["0.6 m", "0.8 m"], "free_vibration": "3 s", "progress": False}
    runs = rf.sweep(SYSTEM, motions, scale=[1, 2, 9], **options)
    stacked = runs.stack(case=("scale", "width", "motion"))
    units = {"angle": "deg", "length": "cm"}
    expected = rf.table(runs, units=units)
    found = rf.table(stacked, units=units)
    assert found.index.names == ["scale", "width [cm]", "motion"]
    pd.testing.assert_frame_equal(found, expected, check_exact=True)
    medians = rf.fragility(stacked, "PGA", limits=[]).median_intensity
    np.testing.assert_allclose(medians, rf.fragility(runs, "PGA", limits=[]).median_intensity)


def test_invalid_table_arguments_are_refused(runs, study):
    for dataset, options, words in (
        ("run.nc", (), "open a file with xr.open_dataset first"),
        (3, (), "expected a dataset"),
        ([], (), "found no runs"),
        ([runs[0], runs[0].rotation], (), "expected a dataset"),
        (study, ("histories",), "holds no histories; a run with outputs=None"),
        (study, ("events",), "holds no events; rf.concat keeps none"),
        (rf.measures.velocity_and_displacement(PULSE), (), "holds no scalars"),
        ([runs[0], study], (), "different dimensions"),
    ):
        with pytest.raises(SchemaError, match=words):
            rf.table(dataset, *options)
    with pytest.raises(ComponentError, match="'scalars' or 'histories' or 'events'"):
        rf.table(runs[0], "everything")


def test_csv_example_writes_its_tables(tmp_path, monkeypatch, capsys):
    script = Path(__file__).resolve().parents[2] / "examples" / "study_to_csv.py"
    monkeypatch.setattr(sys, "argv", [script.name, "--folder", str(tmp_path)])
    runpy.run_path(str(script), run_name="__main__")
    table = pd.read_csv(tmp_path / "study.csv", index_col=["damping_ratio", "scale"])
    assert f"{table.overturned.sum()} of 12 runs overturned" in capsys.readouterr().out
    with xr.open_dataset(tmp_path / "study.nc") as study:
        pd.testing.assert_frame_equal(rf.table(study), table, check_exact=True)
        assert "overturned" not in study.attrs
