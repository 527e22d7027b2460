"""Studies larger than memory are read lazily, and are announced before they begin."""

import tracemalloc

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from interrupting import Interrupting
from stored_sweep import as_bytes

import rockframe as rf
from rockframe.errors import ComponentError, SolverWarning, StudyError
from rockframe.results.variables.runs import RunStatus
from rockframe.studies.sweeps import labelling, lazy_dataset, planning, sweep
from rockframe.studies.sweeps.store import Store, read_shapes

pytestmark = pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")

BLOCK = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
SYSTEM = rf.System(BLOCK)
NOISE = np.random.default_rng(5).normal(size=400)


def record(count, size):
    return rf.GroundMotion.from_arrays((size * NOISE[:count], "m/s^2"), "0.01 s", name="noise")


MOTIONS = {
    "weak": rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz"),
    "10": record(400, 2.0),
    "9": record(150, 5.0),
    "a": rf.GroundMotion.half_sine_pulse("6 m/s^2", "0.4 s"),
}
TABLE = pd.DataFrame({"motion": ["a", "10", "weak", "9", "a"], "scale": [1.0, 1.2, 0.9, 2.0, 1.5]})


def on_a_grid(**run):
    # the lowest block cannot rock, and has no result
    return rf.sweep(
        SYSTEM, MOTIONS, height=["2 m", "0.2 m", "1 m"], scale=[1.0, 0.5, 1.5, 0.7], chunk=7, **run
    )


def with_histories(**run):
    return rf.sweep(
        SYSTEM, MOTIONS, scale=[0.8, 0.2], height=["1 m", "2 m"], chunk=3, outputs=["rotation"],
        output_step="0.01 s", points={"top": ("0 m", "2 m"), "a": ("0 m", "1 m")}, **run,
    )  # fmt: skip


def of_a_table(**run):
    return rf.sweep(SYSTEM, MOTIONS, cases=TABLE, height=["2 m", "1 m"], chunk=3, **run)


def screened(**run):
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    on_pads = rf.System(SYSTEM.parts.block, pads)
    return rf.sweep(on_pads, MOTIONS, scale=[1.0, 0.5], **{**run, "accuracy": "screen"})


STUDIES = [on_a_grid, with_histories, of_a_table, screened]


@pytest.fixture(params=[True, False], ids=["with dask", "without"])
def has_dask(request, monkeypatch):
    if request.param:
        pytest.importorskip("dask", reason="dask is not installed")
    else:
        monkeypatch.setattr(lazy_dataset, "find_spec", lambda _: None)
    return request.param


def assert_equal_lazily(lazy, in_memory):
    """Compare both, except that missing values make floats of other numbers."""
    assert set(lazy.variables) == set(in_memory.variables)
    for name, expected in in_memory.variables.items():
        found = lazy.variables[name]
        assert found.dims == expected.dims, name
        assert found.attrs["long_name"] == expected.attrs["long_name"]
        assert found.attrs.get("units") == expected.attrs.get("units")
        if expected.dtype.kind in "OU":
            assert found.values.tolist() == expected.values.tolist()
        else:
            numbers = expected.values.astype(found.dtype)
            np.testing.assert_array_equal(found.values, numbers, err_msg=name)


@pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")
@pytest.mark.parametrize("run", STUDIES)
def test_lazily_opened_study_equals_the_stored_one(run, tmp_path, has_dask, monkeypatch):
    monkeypatch.setattr(lazy_dataset, "_BLOCK_SIZE", 1)
    counted, counts = [], labelling._counts
    monkeypatch.setattr(labelling, "_counts", lambda *a: counted.append(a[0].sizes) or counts(*a))
    in_memory = run(accuracy="fast", store=tmp_path / "study")
    lazy = rf.open_study(tmp_path / "study", lazy=True)
    assert (lazy.chunks != {}) == has_dask
    assert_equal_lazily(lazy, in_memory)
    attrs = {
        name: one for name, one in in_memory.attrs.items() if name not in ("verdict", "driver")
    }
    assert lazy.attrs == attrs
    counted.clear()
    assert lazy.rockframe.verdict == in_memory.rockframe.verdict == in_memory.verdict
    assert len(counted) > 1 or run is screened  # read in parts
    rng = np.random.default_rng(1)
    for _ in range(20):  # any selection, along one dimension or along all
        key = {
            dim: [rng.integers(-size, size).item(), rng.integers(-size, size, 3),
                  slice(*sorted(rng.integers(0, size + 1, 2).tolist())), slice(None, None, -1)]
            [rng.integers(4)]
            for dim, size in in_memory.sizes.items()
            if rng.random() < 0.7
        }  # fmt: skip
        assert_equal_lazily(lazy.isel(key), in_memory.isel(key))
    last = dict.fromkeys(lazy.status.dims, -1)
    assert_equal_lazily(lazy.isel(last), in_memory.isel(last))
    first = {str(lazy.status.dims[0]): 0}
    assert lazy.isel(first).rockframe.verdict == in_memory.isel(first).rockframe.verdict
    assert len(rf.table(lazy)) == len(rf.table(in_memory))


@pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")
def test_only_used_chunks_are_read(tmp_path, monkeypatch, has_dask):
    in_memory = on_a_grid(store=tmp_path / "study")
    lazy_dataset._rows.cache_clear()
    read, plain = [], Store.get
    monkeypatch.setattr(Store, "get", lambda self, one: read.append(one.number) or plain(self, one))
    lazy = rf.open_study(tmp_path / "study", lazy=True)
    part = lazy.isel(motion=1, scale=0)
    assert lazy.sizes["height"] == 3
    assert not read
    np.testing.assert_array_equal(
        part.peak_rotation, in_memory.isel(motion=1, scale=0).peak_rotation
    )
    # motions change slowest, so that neighbouring cases are those of a motion
    chunks = len(list((tmp_path / "study").glob("chunk-*")))
    assert 1 <= len(set(read)) <= (chunks if has_dask else 2)
    assert len(read) == len(set(read))


@pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")
def test_missing_chunks_appear_as_gaps(tmp_path, has_dask):
    on_a_grid(store=tmp_path / "study")
    (tmp_path / "study" / "chunk-000002.arrays").unlink()
    lazy_dataset._rows.cache_clear()
    in_memory, lazy = (rf.open_study(tmp_path / "study", lazy=one) for one in (False, True))
    assert_equal_lazily(lazy, in_memory)
    assert int((lazy.status == RunStatus.NOT_RUN).sum()) == 7
    assert lazy.rockframe.verdict == in_memory.verdict
    on_a_grid(store=tmp_path / "study")
    assert (
        lazy_dataset.lazy_dataset(Store.open(tmp_path / "study")).status.max() < RunStatus.NOT_RUN
    )


@pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")
def test_a_folder_that_is_not_found_again_is_no_gap(tmp_path, monkeypatch, has_dask):
    monkeypatch.chdir(tmp_path)
    in_memory, lazy = on_a_grid(store="study"), rf.open_study("study", lazy=True)
    monkeypatch.chdir("/")  # what is read later is where it was
    assert_equal_lazily(lazy, in_memory)
    lazy_dataset._rows.cache_clear()
    (tmp_path / "study").rename(tmp_path / "moved")
    with pytest.raises(StudyError, match="found no study"):
        lazy.peak_rotation.load()
    of_a_table(store=tmp_path / "study")
    (tmp_path / "study" / "chunk-000001.arrays").unlink()
    with pytest.raises(StudyError, match="another study"):
        lazy.status.isel(motion=1, scale=0).load()


@pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")
def test_damaged_chunks_raise_when_read(tmp_path):
    on_a_grid(store=tmp_path / "study")
    file = tmp_path / "study" / "chunk-000001.arrays"
    content = bytearray(file.read_bytes())
    content[-3] ^= 1
    file.write_bytes(content)
    lazy_dataset._rows.cache_clear()
    lazy = rf.open_study(tmp_path / "study", lazy=True)
    with pytest.raises(StudyError, match=r"chunk-000001.arrays: damaged"):
        lazy.peak_rotation.mean().compute()
    file.write_bytes(content[:100])
    with pytest.raises(StudyError, match=r"chunk-000001.arrays: damaged"):
        rf.open_study(tmp_path / "study", lazy=True)
    with pytest.raises(StudyError, match="damaged"):
        read_shapes(file)
    with pytest.raises(ComponentError, match="lazy must be True or False"):
        rf.open_study(tmp_path / "study", lazy="yes")


def test_with_dask_statistics_stream(tmp_path, monkeypatch):
    dask = pytest.importorskip("dask", reason="dask is not installed")
    scales = np.linspace(0.05, 0.1, 200)
    few = {"scale": scales, "duration": "3 s", "output_step": "1 ms", "outputs": ["rotation"]}
    in_memory = rf.sweep(SYSTEM, MOTIONS, **few, chunk=10, store=tmp_path / "study")
    size = in_memory.rotation.nbytes
    assert size > 1e7
    monkeypatch.setattr(lazy_dataset, "_BLOCK_SIZE", 10)
    lazy = rf.open_study(tmp_path / "study", lazy=True)
    assert max(lazy.rotation.data.chunksize[:2]) == 10
    lazy_dataset._rows.cache_clear()
    tracemalloc.start()
    try:
        with dask.config.set(scheduler="synchronous"):
            found = np.abs(lazy.rotation).max().compute().item()
        taken = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert found == np.abs(in_memory.rotation).max().item()
    assert taken < 0.5 * size
    with dask.config.set(scheduler="synchronous"):
        # xarray would need the longest of all lazily read texts
        numbers = lazy.drop_vars(["rotation", "message"])
        numbers.to_netcdf(tmp_path / "whole.nc")
    with xr.open_dataset(tmp_path / "whole.nc") as read:
        assert_equal_lazily(read, numbers)


@pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")
def test_lazy_blocks_follow_the_execution_order(tmp_path):
    on_a_grid(store=tmp_path / "study", accuracy="fast", progress=False)
    grid = Store.open(tmp_path / "study").labels().grid
    assert grid.order == ("motion", "scale", "height")
    for most, expected in ((1, (1, 1, 1)), (2, (1, 1, 2)), (7, (1, 2, 3)), (30, (2, 4, 3))):
        assert tuple(lazy_dataset.block_lengths(grid, most).values())[::-1] == expected
    numbers = grid.case_numbers((slice(None), slice(None), slice(None)))
    assert numbers.shape == tuple(grid.sizes.values())
    assert (grid.in_dimension_order(np.arange(grid.count)) == numbers).all()


def test_study_larger_than_memory_is_read_from_its_store(tmp_path, monkeypatch):
    scales = np.linspace(0.1, 1, 100)
    in_memory = rf.sweep(SYSTEM, MOTIONS["weak"], scale=scales, free_vibration="5 s")
    monkeypatch.setattr(planning, "available_memory", lambda: 2e4)
    message = r"100 cases need about 0.058 MB of memory .* 0.02 MB are available; "
    with pytest.raises(StudyError, match=f"{message}run fewer cases or give a store, from which"):
        rf.sweep(SYSTEM, MOTIONS["weak"], scale=scales, free_vibration="5 s")
    with pytest.warns(SolverWarning, match=f"{message}they are read from the store"):
        runs = rf.sweep(
            SYSTEM, MOTIONS["weak"], scale=scales, free_vibration="5 s", store=tmp_path / "study"
        )
    assert_equal_lazily(runs, in_memory)
    assert "verdict" not in runs.attrs
    assert runs.rockframe.verdict == in_memory.verdict
    monkeypatch.undo()
    again = rf.sweep(
        SYSTEM, MOTIONS["weak"], scale=scales, free_vibration="5 s", store=tmp_path / "study"
    )
    assert as_bytes(again) == as_bytes(in_memory)  # the same study, independent of available memory


def test_an_interrupted_study_that_does_not_fit_is_not_read(tmp_path, monkeypatch):
    monkeypatch.setattr(planning, "available_memory", lambda: 2e4)
    monkeypatch.setattr(Store, "get", lambda *_: pytest.fail("it has been read"))
    stopped = Interrupting(2)
    with pytest.warns(SolverWarning) as caught:
        runs = rf.sweep(
            SYSTEM, MOTIONS["weak"], scale=np.linspace(0.1, 1, 100), free_vibration="5 s",
            store=tmp_path / "study", chunk=30, executor=stopped,
        )  # fmt: skip
    assert any("interrupted; 60 of 100 cases have been run, and are kept" in str(one.message)
               for one in caught)  # fmt: skip
    assert runs.status.size == 100


def test_study_estimated_to_take_days_warns(monkeypatch, tmp_path):
    monkeypatch.setattr(sweep, "_DAY", 1e-5)
    for store, ways in ((None, "no store: with one"), (tmp_path / "study", "jobs on it share")):
        with pytest.warns(SolverWarning, match=rf"8 cases take about .* days with .* {ways}"):
            on = rf.sweep(SYSTEM, MOTIONS, scale=[1.0, 0.5], accuracy="fast", store=store)
        assert on.status.size == 8
