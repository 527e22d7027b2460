"""Joining runs into one dataset: attributes of single runs do not describe all."""

import itertools

import numpy as np
import pint
import pytest
import xarray as xr
from plain_python import plain_python

import rockframe as rf
from rockframe.errors import SchemaError, SolverWarning
from rockframe.results.joining import RUN_ATTRIBUTES

pytestmark = pytest.mark.unit

BLOCK = rf.Block(width="0.8 m", height="4 m", mass="2 t")
SYSTEM = rf.System(BLOCK, rf.RigidGround())
PULSE = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
CAUTION = "the motion is not one to trust"
STANDS, FALLS = 2.5, 9.0


def run(scale, motion=PULSE, **options):
    return SYSTEM.simulate(motion.scaled(scale), free_vibration="3 s", **options)


@pytest.fixture(scope="module")
def runs():
    return {scale: run(scale) for scale in (2.0, STANDS, FALLS, 10.0)}


def row(runs, *scales):
    return [runs[scale] for scale in scales]


def run_attributes(dataset):
    return RUN_ATTRIBUTES & set(dataset.attrs)


def test_run_attributes_list_matches_attributes_that_differ_between_runs():
    optional = {"history", "run_json", "motion_sha256", "motion_json", "motion_history"}
    with pytest.warns(SolverWarning):
        cut = run(STANDS, accuracy=rf.Accuracy(rtol=1e-7, max_steps=40), certify=True)
    others = [
        run(STANDS, accuracy=1e-7, certify=rf.Certification(runs=60)),
        run(FALLS, accuracy=1e-7, certify=rf.Certification(runs=61)),
        cut,
    ]
    attributes = [set(other.attrs) for other in others]
    assert attributes[0] == attributes[1] == attributes[2]
    differing = {
        name
        for name in attributes[0]
        if any(not np.array_equal(others[0].attrs[name], other.attrs[name]) for other in others)
    }
    settings = {"accuracy", "certificate_nudge", "certificate_reach", "certificate_resolution"}
    # no run is proved or has fixed steps, and no scene is a stack on rigid bases
    only_of_stacks = {
        "impacts_of_several_modes",
        "impacts_of_no_mode",
        "corners_held_without_pressing",
    }
    only_of_proofs = {"proof", "proof_bits", "proof_verdict"}
    absent = {"solver_substeps"} | only_of_stacks | only_of_proofs
    assert differing - optional - settings == RUN_ATTRIBUTES - absent


def test_concat_never_retains_attributes_of_one_run(runs):
    """None, all or some runs overturn; joined in one step or two, also through files."""
    rows = [row(runs, 2.0, STANDS), row(runs, FALLS, 10.0), row(runs, STANDS, FALLS)]
    for chosen in (*rows, [runs[STANDS]], [runs[STANDS]] * 2, [runs[FALLS]] * 2):
        assert not run_attributes(rf.concat(chosen, "scale"))
    for chosen in itertools.permutations(rows):
        nested = rf.concat([rf.concat(part, "scale") for part in chosen], "case")
        assert not run_attributes(nested)
        assert nested.sizes == {"case": 3, "scale": 2}
        overturned = [one.overturned.item() for part in chosen for one in part]
        assert nested.overturned.values.ravel().tolist() == overturned
        assert nested.overturned.dtype == bool
        deeper = rf.concat([nested, nested], "system")
        assert not run_attributes(deeper)
        longer = rf.concat([nested, nested], "case")
        assert longer.sizes == {"case": 6, "scale": 2}
        assert not run_attributes(longer)


def test_concat_drops_run_attributes_left_by_xarray(runs):
    """A row of standing runs joined with a row of some overturned ones once kept its verdict."""
    plain = [
        xr.concat(
            [one.drop_dims(["time", "event"]) for one in part],
            "scale",
            data_vars="all",
            combine_attrs="drop_conflicts",
        )
        for part in (row(runs, STANDS, FALLS), row(runs, 2.0, STANDS))
    ]
    assert plain[1].attrs["overturned"] == 0
    assert "overturned" not in plain[0].attrs
    fault = xr.concat(plain, "case", data_vars="all", combine_attrs="drop_conflicts")
    assert fault.attrs["overturned"] == 0
    assert fault.overturned.any()
    assert not run_attributes(rf.concat(plain, "case"))


def test_xarray_concat_drops_conflicting_run_attributes(runs):
    """Every run has all attributes, so that differences conflict."""
    assert runs[STANDS].attrs["cautions"] == runs[FALLS].attrs["cautions"] == "none"
    warned = runs[STANDS].assign_attrs(cautions=CAUTION)
    for chosen in (row(runs, STANDS, FALLS), [runs[STANDS], warned], [warned, runs[FALLS]]):
        bare = [one.drop_dims(["time", "event"]) for one in chosen]
        joined = xr.concat(bare, "run", data_vars="all", combine_attrs="drop_conflicts")
        kept = RUN_ATTRIBUTES & set(joined.attrs)
        assert "solver_substeps" in kept
        for name in kept:
            values = {str(one.attrs[name]) for one in chosen}
            assert len(values) == 1, name
        assert ("cautions" in joined.attrs) == all(
            one.attrs["cautions"] == "none" for one in chosen
        )


def test_concat_keeps_cautions_of_single_runs_as_messages(runs):
    warned = runs[STANDS].assign_attrs(cautions=CAUTION)
    for chosen in ([warned, runs[2.0]], [runs[2.0], warned], [warned, warned]):
        assert "cautions" not in rf.concat(chosen).attrs
        joined = rf.concat(chosen, "scale", [1.0, 2.0])
        assert joined.message.values.tolist() == [one.attrs["cautions"] for one in chosen]
        assert rf.table(joined).message.tolist() == joined.message.values.tolist()
        grid = rf.concat([joined, joined], "width", [1, 2])
        assert grid.message.dims == grid.status.dims
        assert grid.message.values.tolist() == 2 * [joined.message.values.tolist()]
    with pytest.warns(SolverWarning):
        cut = run(STANDS, accuracy=rf.Accuracy(rtol=1e-7, max_steps=40))
    assert cut.attrs["cautions"].startswith("Not finished")


def test_concat_preserves_shared_attributes(runs):
    joined = rf.concat(runs.values(), "scale", list(runs))
    assert joined.scale.values.tolist() == list(runs)
    for name in ("Conventions", "system_json", "model", "motion", "solver_rtol", "run_json"):
        assert joined.attrs[name] == runs[STANDS].attrs[name]
    assert "motion_sha256" not in joined.attrs
    assert "4 joined along 'scale'" in joined.attrs["history"]
    assert rf.System.from_dataset(joined) == SYSTEM
    for name, values in joined.data_vars.items():
        assert values.attrs.keys() == runs[STANDS][name].attrs.keys()
        assert values.dtype == runs[STANDS][name].dtype
        np.testing.assert_array_equal(values, [one[name] for one in runs.values()])
    elsewhere = rf.System(BLOCK, rf.RigidGround(), gravity="3.7 m/s^2").simulate(PULSE)
    mixed = rf.concat([runs[STANDS], elsewhere])
    assert "system_json" not in mixed.attrs
    with pytest.raises(SchemaError, match="system_json"):
        rf.System.from_dataset(mixed)


def test_scales_of_one_motion_are_told_apart(runs):
    name = runs[STANDS].attrs["motion"]
    names = [f"2 times {name}", f"2.5 times {name}"]
    for dim in ("motion", "run"):
        assert rf.concat(row(runs, 2.0, STANDS), dim).motion.values.tolist() == names
    assert "motion" not in rf.concat(row(runs, 2.0, STANDS), "scale", [2.0, STANDS]).coords


def test_different_motions_become_a_coordinate(runs, tmp_path):
    other = run(STANDS, rf.GroundMotion.sine_pulse("1 m/s^2", "2 Hz"))
    names = [one.attrs["motion"] for one in (runs[STANDS], other)]
    along = rf.concat([runs[STANDS], other])
    named = rf.concat({"first": runs[STANDS], "second": other})
    assert named.run.values.tolist() == ["first", "second"]
    xr.testing.assert_identical(named.drop_vars("run").drop_attrs(), along.drop_attrs())
    assert along.motion.dims == ("run",)
    assert along.motion.values.tolist() == names
    assert "motion" not in along.attrs
    rows = [rf.concat([one, one], "scale", [1.0, 2.0]) for one in (runs[STANDS], other)]
    grid = rf.concat(rows, "motion")
    assert grid.sizes == {"motion": 2, "scale": 2}
    assert grid.motion.values.tolist() == names
    grid.to_netcdf(tmp_path / "study.nc")
    with xr.open_dataset(tmp_path / "study.nc") as again:
        xr.testing.assert_identical(again.load(), grid)
        for name, values in rf.concat([again, again], "case").isel(case=0).data_vars.items():
            xr.testing.assert_identical(values, grid[name])


def test_labels_of_quantities_are_refused(runs):
    labels = pint.get_application_registry().Quantity([3.0, 9.0], "m/s^2")
    for quantities in (labels, list(labels)):
        with pytest.raises(SchemaError, match=r"labels with a unit come as xr\.DataArray"):
            rf.concat(row(runs, STANDS, FALLS), "amplitude", quantities)


def test_labels_may_have_a_unit(runs):
    labels = xr.DataArray([3.0, 9.0], attrs={"units": "m s^-2", "long_name": "amplitude"})
    joined = rf.concat(row(runs, STANDS, FALLS), "amplitude", labels)
    assert joined.amplitude.attrs == labels.attrs
    placed = [one.assign_coords(scale=scale) for scale, one in runs.items()]
    assert rf.concat(placed, "scale").scale.values.tolist() == list(runs)


def test_histories_are_joined_only_at_equal_times(runs):
    both = rf.concat(row(runs, 2.0, STANDS), "scale", histories=True)
    assert both.rotation.dims == ("scale", "time")
    assert both.contact_state.dtype == np.int8
    with pytest.raises(SchemaError, match="do not fit one another"):
        rf.concat(row(runs, STANDS, FALLS), "scale", histories=True)


def test_measures_and_spectra_can_be_joined():
    motions = [PULSE, rf.GroundMotion.sine_pulse("2 m/s^2", "3 Hz")]
    measures = rf.concat([rf.intensity_measures(motion) for motion in motions], "motion")
    assert measures.motion.values.tolist() == [motion.name for motion in motions]
    spectra = rf.concat([rf.response_spectrum(m, ["0.5 s", "1 s"]) for m in motions], "motion")
    assert spectra.spectral_displacement.dims == ("motion", "damping_ratio", "period")


def test_invalid_concat_arguments_are_refused(runs):
    one = runs[STANDS]
    joined = rf.concat([one, one], "scale", [1, 2])
    for unjoinable, options, words in (
        ([], {}, "found no runs"),
        (one, {}, "expected a list of datasets"),
        ("run.nc", {}, "expected a list of datasets"),
        ([one, "run.nc"], {}, "open a file with xr.open_dataset first"),
        ([one, one], {"dim": "time"}, "dim must be the name of a dimension"),
        ([one, one], {"dim": 3}, "dim must be the name of a dimension"),
        ([one, one], {"labels": [1, 2, 3]}, "found 3 labels for 2 runs along 'run'"),
        ([one, joined], {"dim": "scale"}, "1 of 2 datasets have the dimension 'scale'"),
        ([joined, joined.assign_coords(scale=[1, 3])], {}, "do not fit one another"),
        ([one, rf.measures.velocity_and_displacement(PULSE)], {}, "share no variables"),
    ):
        with pytest.raises(SchemaError, match=words):
            rf.concat(unjoinable, **options)


CABINET = rf.System(rf.Block(width="0.5 m", height="2 m", mass="300 kg"))
SWEEP_OPTIONS = {"free_vibration": "2 s", "scale": [0.5, 1.0, 2.0]}


def sweep_of(widths, *pulses):
    """Sweep over widths, under pulses of given frequencies."""
    motions = {f"{f} Hz": rf.GroundMotion.sine_pulse("3 m/s^2", f"{f} Hz") for f in pulses or (1,)}
    return rf.sweep(CABINET, motions, width=(widths, "m"), **SWEEP_OPTIONS)


@pytest.mark.parametrize("dim", ["width", "motion"])
def test_sweeps_differing_along_one_dimension_join_into_a_sweep(dim, tmp_path):
    if dim == "width":
        parts = [sweep_of([0.4, 0.5]), sweep_of([0.6])]
        single_sweep = sweep_of([0.4, 0.5, 0.6])
    else:
        parts = [sweep_of([0.5], 1), sweep_of([0.5], 0.5, 2)]
        single_sweep = sweep_of([0.5], 1, 0.5, 2)
    joined = rf.concat(parts, dim)
    assert joined.rockframe.verdict == single_sweep.verdict
    assert joined.attrs["study_sha256"] not in [one.attrs["study_sha256"] for one in parts]
    for name in ("motion_names", "motions_json", "axes_json", "case_count", "system_json"):
        assert joined.attrs[name] == single_sweep.attrs[name]
    last = {"width": 0.6} if dim == "width" else {"motion": "2 Hz"}
    case = rf.case(joined, scale=2.0, **last).simulate(outputs=None)
    assert case.peak_rotation.item() == joined.peak_rotation.sel(scale=2.0, **last).item()
    pooled = ["width"] if dim == "width" else []
    found, same = (rf.fragility(one, "PGA", pooled=pooled) for one in (joined, single_sweep))
    np.testing.assert_array_equal(found.median_intensity, same.median_intensity)
    joined.to_netcdf(tmp_path / "joined.nc")
    with xr.open_dataset(tmp_path / "joined.nc") as again:
        assert again.rockframe.verdict == single_sweep.verdict


def test_sweeps_differing_otherwise_do_not_join_into_a_sweep():
    one = sweep_of([0.4, 0.5])
    pulse = {"1 Hz": rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")}
    worn = rf.sweep(CABINET, pulse, width=["0.4 m", "0.5 m"], restitution=[0.7], **SWEEP_OPTIONS)
    worn = worn.isel(restitution=0, drop=True)
    longer = rf.sweep(CABINET, pulse, width=["0.6 m"], **{**SWEEP_OPTIONS, "free_vibration": "1 s"})
    stronger = {"1 Hz": rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")}  # of the same name
    stronger = rf.sweep(CABINET, stronger, width=["0.6 m"], **SWEEP_OPTIONS)
    others = {
        "width": [sweep_of([0.5, 0.6]), longer, stronger],
        "base": [worn],
    }  # fmt: skip
    for dim, several in others.items():
        for other in several:
            joined = rf.concat([one, other], dim)
            assert "case_count" not in joined.attrs
            with pytest.raises(SchemaError, match="differ along one axis"):
                rf.case(joined, width=0.4, scale=1.0)


def test_restrainers_missing_from_a_run_become_gaps(tmp_path):
    def tied(*names):
        ties = [rf.Tendon(stiffness="1 MN/m", name=name) for name in names]
        return rf.System(BLOCK, *ties).simulate(PULSE)

    with plain_python():
        runs = [tied("west"), tied("west", "east"), tied("east")]
    joined = rf.concat(runs, histories=True)
    assert joined.restrainer.values.tolist() == ["west", "east"]
    present = [[True, False], [True, True], [False, True]]
    assert joined.peak_restrainer_force.notnull().values.tolist() == present
    assert joined.restrainer_state.notnull().all("time").values.tolist() == present
    assert joined.restrainer_state.dtype == joined.restrainer_state.flag_values.dtype == float
    joined.to_netcdf(tmp_path / "joined.nc")
    xr.testing.assert_identical(xr.load_dataset(tmp_path / "joined.nc"), joined)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")
def test_joined_sweeps_with_gaps_equal_the_whole_sweep(tmp_path):
    def drums(count):
        joint = rf.RigidGround(friction=0.4)
        return rf.System(rf.Stack(*[BLOCK] * count, interfaces=[joint] * (count - 1)), joint)

    def swept(*counts):
        options = {"accuracy": "fast", "outputs": ["rotation"], "duration": "0.2 s"}
        return rf.sweep(drums, PULSE, count=counts, **options)

    with plain_python():
        parts, single_sweep = [swept(2), swept(3, 1)], swept(2, 3, 1)
    joined = rf.concat(parts, "count", histories=True)
    for name in ("overturned", "peak_body_slip", "peak_body_rotation", "rotation", "status"):
        xr.testing.assert_identical(joined[name], single_sweep[name])
        flags = single_sweep[name].attrs.get("flag_values", single_sweep[name].values[:0])
        assert joined[name].attrs.get("flag_values", flags).dtype == flags.dtype
    assert np.isnan(joined.overturned[2, 0])  # a stack of one body is refused
    assert rf.case(joined, count=3, scene=drums).system == drums(3)


def test_numbers_in_several_units_are_not_joined():
    """They would be in one array without a unit."""
    one, two = run(STANDS), run(FALLS)
    turned = one.assign(peak_rotation=np.rad2deg(one.peak_rotation).assign_attrs(units="deg"))
    with pytest.raises(SchemaError, match="concat: peak_rotation is in deg and rad; put it into"):
        rf.concat([turned, two], "run")
    wide = [rf.sweep(SYSTEM, PULSE, width=[width], progress=False) for width in ("0.8 m", "0.9 m")]
    wide[0] = wide[0].assign_coords(width=("width", [800.0], {"units": "mm"}))
    with pytest.raises(SchemaError, match="concat: width is in mm and m; put it into one unit"):
        rf.concat(wide, "width")
