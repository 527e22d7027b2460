"""Motions from uneven times, data frames and traces, and arrays with time axes."""

import importlib.util
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from rockframe.errors import ComponentError, RecordError, RecordWarning, UnitsError
from rockframe.motion import GroundMotion

COUNT = 200
STEP = 0.01
TIMES = STEP * np.arange(COUNT)
VALUES = np.random.default_rng(5).standard_normal(COUNT)
UNEVEN = TIMES + np.where(np.arange(COUNT) % 7 == 3, 0.003, 0.0)
DATES = pd.date_range("2020-01-01", periods=COUNT, freq="10ms")


class TestTimesOfAnArray:
    @pytest.mark.parametrize("index", [TIMES, DATES, DATES - DATES[0], DATES.tz_localize("UTC")])
    def test_time_index_must_match_time_step(self, index):
        series = pd.Series(VALUES, index=index)
        motion = GroundMotion.from_arrays((series, "m/s^2"), "0.01 s")
        assert motion.si.horizontal.samples.tolist() == VALUES.tolist()
        with pytest.raises(ComponentError, match=r"has the step 0\.01 s, but time_step is 0\.02 s"):
            GroundMotion.from_arrays((series, "m/s^2"), "0.02 s")
        with pytest.raises(ComponentError, match="time axis of vertical"):
            GroundMotion.from_arrays((VALUES, "m/s^2"), "0.02 s", (series, "m/s^2"))

    def test_integer_index_is_not_read_as_times(self):
        for index in (None, np.arange(5, COUNT + 5)):
            series = pd.Series(VALUES, index=index)
            assert len(GroundMotion.from_arrays((series, "m/s^2"), "0.02 s")) == COUNT

    def test_index_of_two_times_is_read(self):
        series = pd.Series(VALUES[:2], index=TIMES[:2])
        with pytest.raises(ComponentError, match=r"has the step 0\.01 s, but time_step is 0\.02 s"):
            GroundMotion.from_arrays((series, "m/s^2"), "0.02 s")

    def test_an_uneven_index_is_refused(self):
        series = pd.Series(VALUES, index=UNEVEN)
        with pytest.raises(ComponentError, match=r"is not even.*from_times"):
            GroundMotion.from_arrays((series, "m/s^2"), "0.01 s")

    @pytest.mark.parametrize(
        ("axis", "attributes"),
        [
            (TIMES, {}),
            (1e3 * TIMES, {"units": "ms"}),
            (10 * np.arange(COUNT), {"units": "ms"}),
            (TIMES, {"units": "seconds"}),
            (TIMES / 60.0, {"units": "minutes since 2020-02-03 04:05:06"}),
            (DATES.values, {}),
        ],
    )
    def test_a_time_axis_of_any_kind(self, axis, attributes):
        array = xr.DataArray(VALUES, {"time": ("time", axis, attributes)}, attrs={"units": "m/s^2"})
        for acceleration in (array, (array, "m/s^2")):
            assert len(GroundMotion.from_arrays(acceleration, "0.01 s")) == COUNT
            with pytest.raises(ComponentError, match=r"has the step 0\.01 s"):
                GroundMotion.from_arrays(acceleration, "0.02 s")

    @pytest.mark.parametrize(
        "index", [TIMES, DATES, DATES - DATES[0], DATES.tz_localize("UTC").tz_convert("Asia/Tokyo")]
    )
    def test_both_components_must_start_at_once(self, index):
        across, up = (pd.Series(VALUES[9:], index=one) for one in (index[:-9], index[9:]))
        with pytest.raises(ComponentError, match=r"vertical start 0\.09 s after those"):
            GroundMotion.from_arrays((across, "g_0"), "0.01 s", (up, "g_0"))
        with pytest.raises(ComponentError, match=r"vertical start 0\.09 s before those"):
            GroundMotion.from_arrays((up, "g_0"), "0.01 s", (across, "g_0"))
        both = GroundMotion.from_arrays((up, "g_0"), "0.01 s", (2.0 * up, "g_0"))
        assert both.si.vertical.samples.tolist() == (2.0 * both.si.horizontal.samples).tolist()

    @pytest.mark.parametrize("unit", ["ms", "milliseconds since 2020-02-03"])
    def test_starts_in_other_units_or_of_unknown_origin_are_compared_if_known(self, unit):
        label = {"units": "m/s^2"}
        in_seconds = xr.DataArray(VALUES, {"time": ("time", 3.0 + TIMES)}, attrs=label)
        axis = ("time", 1e3 * (3.0 + TIMES), {"units": unit})
        other = xr.DataArray(VALUES, {"time": axis}, attrs=label)
        assert len(GroundMotion.from_arrays(in_seconds, "0.01 s", other)) == COUNT


class TestFromTimes:
    def test_straight_lines_between_the_times(self):
        motion = GroundMotion.from_times((UNEVEN, "s"), (VALUES, "m/s^2"), "0.005 s")
        grid = 0.005 * np.arange(len(motion))
        assert grid[-1] <= UNEVEN[-1] < grid[-1] + 0.005
        expected = [
            VALUES[k] + (VALUES[k + 1] - VALUES[k]) * (t - UNEVEN[k]) / (UNEVEN[k + 1] - UNEVEN[k])
            for t in grid
            for k in [min(np.searchsorted(UNEVEN, t, "right") - 1, COUNT - 2)]
        ]
        np.testing.assert_allclose(motion.si.horizontal.samples, expected, atol=1e-12)
        assert "0.007 s to 0.013 s apart, straight lines between them" in motion.history[0]

    def test_times_since_a_date(self):
        axis = xr.DataArray(UNEVEN / 60.0, attrs={"units": "minutes since 2020-02-03"})
        found, expected = (
            GroundMotion.from_times(times, (VALUES, "m/s^2"), "0.005 s").si.horizontal.samples
            for times in (axis, (UNEVEN, "s"))
        )
        np.testing.assert_allclose(found, expected, atol=1e-10)

    def test_cubic_interpolation_reproduces_cubic(self):
        cubic = 1.0 + UNEVEN - 3.0 * UNEVEN**2 + 0.5 * UNEVEN**3
        motion = GroundMotion.from_times(
            (UNEVEN, "s"), (cubic, "m/s^2"), "4 ms", interpolation="cubic"
        )
        t = 0.004 * np.arange(len(motion))
        expected = 1.0 + t - 3.0 * t**2 + 0.5 * t**3
        np.testing.assert_allclose(motion.si.horizontal.samples, expected, atol=1e-10)

    def test_even_times_preserve_samples(self):
        motion = GroundMotion.from_times(
            (TIMES, "s"), (VALUES, "cm/s^2"), "0.01 s", (-VALUES, "cm/s^2"), name="made up"
        )
        np.testing.assert_allclose(motion.si.horizontal.samples, 0.01 * VALUES, atol=1e-14)
        np.testing.assert_allclose(motion.si.vertical.samples, -0.01 * VALUES, atol=1e-14)
        assert motion.name == "made up"

    def test_dates(self):
        motion = GroundMotion.from_times(DATES, (VALUES, "m/s^2"), "0.01 s")
        np.testing.assert_allclose(motion.si.horizontal.samples, VALUES, atol=1e-6)
        shortest = GroundMotion.from_times(DATES[:2], (VALUES[:2], "m/s^2"), "0.01 s")
        np.testing.assert_allclose(shortest.si.horizontal.samples, VALUES[:2], atol=1e-6)

    @pytest.mark.parametrize(
        "dates", [DATES[:0], DATES[:1], DATES.insert(COUNT, pd.NaT), DATES.values[:, None]]
    )
    def test_dates_that_are_no_times_are_refused(self, dates):
        with pytest.raises(ComponentError, match="needs two or more dates, and none missing"):
            GroundMotion.from_times(dates, (np.zeros(len(dates)), "m/s^2"), "0.01 s")

    def test_time_step_longer_than_intervals_warns(self):
        with pytest.warns(RecordWarning, match="longer than the intervals"):
            GroundMotion.from_times((TIMES, "s"), (VALUES, "m/s^2"), "0.02 s")

    @pytest.mark.parametrize(
        ("times", "values", "step", "words"),
        [
            (TIMES[::-1], VALUES, "0.01 s", "in increasing order"),
            ([0.0], [1.0], "0.01 s", "two or more"),
            ([0.0, np.nan], [1.0, 1.0], "0.01 s", "finite times"),
            (TIMES, VALUES[:-1], "0.01 s", "199 samples at 200 times"),
            (TIMES, [np.nan, *VALUES[1:]], "0.01 s", "one finite sample for each time"),
            (TIMES, VALUES, "1e-9 s", "must give 2 to"),
            (TIMES, VALUES, "3 s", "must give 2 to"),
        ],
    )
    def test_invalid_times_and_samples_raise(self, times, values, step, words):
        with pytest.raises(ComponentError, match=words):
            GroundMotion.from_times((times, "s"), (values, "m/s^2"), step)

    def test_missing_units_and_unknown_interpolation_raise(self):
        with pytest.raises(UnitsError, match="needs an array of times with a unit"):
            GroundMotion.from_times(TIMES, (VALUES, "m/s^2"), "0.01 s")
        with pytest.raises(UnitsError, match=r"times needs a time .* got '1 m'"):
            GroundMotion.from_times((TIMES, "m"), (VALUES, "m/s^2"), "0.01 s")
        with pytest.raises(ComponentError, match="interpolation"):
            GroundMotion.from_times(
                (TIMES, "s"), (VALUES, "m/s^2"), "0.01 s", interpolation="nearest"
            )


FRAME = pd.DataFrame({"t": TIMES, "N": VALUES, "E": 2.0 * VALUES, "DWN": 3.0 * VALUES})


class TestFromFrame:
    @pytest.mark.parametrize("frame", [FRAME, FRAME.assign(t=DATES)])
    def test_columns_and_a_column_of_times(self, frame):
        motion = GroundMotion.from_frame(frame, "gal", "E", time="t")
        np.testing.assert_allclose(motion.si.horizontal.samples, 0.02 * VALUES, rtol=1e-14)
        assert motion.si.time_step == STEP
        assert (motion.metadata["component"], motion.metadata["azimuth"]) == ("E", 90.0)

    @pytest.mark.parametrize("step", [0.005, 0.01, 1.0 / 128.0])
    def test_times_of_single_precision(self, step):
        times = (step * np.arange(60_000)).astype(np.float32)
        frame = pd.DataFrame({"t": times, "N": np.zeros(times.size)})
        assert GroundMotion.from_frame(frame, "gal", "N", time="t").si.time_step == step
        indexed = frame.set_index("t")
        assert GroundMotion.from_frame(indexed, "gal").si.time_step == step
        frame["t"] = np.delete((step * np.arange(60_001)).astype(np.float32), 50_000)
        with pytest.raises(ComponentError, match="not even"):
            GroundMotion.from_frame(frame, "gal", "N", time="t")

    @pytest.mark.parametrize("entry", ["late", [1.0]])
    def test_a_column_of_times_holds_numbers_or_dates(self, entry):
        frame = pd.DataFrame({"t": [0.0, 0.01, entry], "N": [0.0, 1.0, 2.0]})
        with pytest.raises(ComponentError, match="column 't' must hold times"):
            GroundMotion.from_frame(frame, "gal", "N", time="t")

    def test_downward_vertical_column_is_inverted(self):
        motion = GroundMotion.from_frame(FRAME, "gal", "N", "DWN", time="t")
        np.testing.assert_allclose(motion.si.vertical.samples, -0.03 * VALUES, rtol=1e-14)
        assert motion.history[-1] == "component DWN turned over: positive upwards"

    @pytest.mark.parametrize("factor", [1e3, 1e-3])
    def test_times_unlikely_to_be_in_seconds_warn(self, factor):
        frame = pd.DataFrame({"t": factor * TIMES, "acc": VALUES})
        with pytest.warns(RecordWarning, match=r"are they in seconds\?"):
            GroundMotion.from_frame(frame, "gal", "acc", time="t")
        time_step = f"{factor * STEP!r} s"
        motion = GroundMotion.from_frame(frame, "gal", "acc", time="t", time_step=time_step)
        assert motion.si.time_step == pytest.approx(factor * STEP)

    def test_times_in_the_index_or_a_time_step(self):
        only = pd.DataFrame({"acc": VALUES}, index=TIMES)
        assert GroundMotion.from_frame(only, "g").si.time_step == STEP
        counted = pd.DataFrame({"acc": VALUES})
        assert GroundMotion.from_frame(counted, "g", time_step="0.02 s").si.time_step == 0.02
        with pytest.raises(ComponentError, match="the frame has no times"):
            GroundMotion.from_frame(counted, "g")
        with pytest.raises(ComponentError, match=r"step 0\.01 s, but time_step is 0\.02 s"):
            GroundMotion.from_frame(only, "g", time_step="0.02 s")

    @pytest.mark.parametrize(
        ("arguments", "words"),
        [
            ({}, "component must name one of the columns 'N', 'E', 'DWN'"),
            ({"component": "U"}, "component 'U' is none of the columns"),
            ({"component": "N", "vertical": "Z"}, "vertical 'Z' is none of the columns"),
        ],
    )
    def test_columns_that_are_not_there(self, arguments, words):
        with pytest.raises(ComponentError, match=words):
            GroundMotion.from_frame(FRAME, "g", time="t", **arguments)

    def test_other_invalid_arguments_raise(self):
        with pytest.raises(ComponentError, match="needs a pandas DataFrame"):
            GroundMotion.from_frame(VALUES, "g")
        with pytest.raises(UnitsError, match="unit of an acceleration, got 's'"):
            GroundMotion.from_frame(FRAME, "s", "N", time="t")
        with pytest.raises(ComponentError, match=r"not even.*from_times"):
            GroundMotion.from_frame(FRAME.assign(t=UNEVEN), "g", "N", time="t")
        with pytest.raises(ComponentError, match="'x' is none of the columns"):
            GroundMotion.from_frame(FRAME, "g", "N", time="x")
        for name, column in (("time", "t"), ("component", "N")):
            twice = pd.concat([FRAME, FRAME[[column]]], axis=1)
            words = f"{name} must name one column, and several are called '{column}'"
            with pytest.raises(ComponentError, match=words):
                GroundMotion.from_frame(twice, "g", "N", time="t")
        with pytest.raises(ComponentError, match="must hold finite numbers"):
            GroundMotion.from_frame(FRAME.assign(N=np.nan), "g", "N", time="t")


def trace(channel="HNE", values=VALUES, *, start=0.0, rate=100.0, **more):
    """An object with the attributes of an ObsPy trace."""
    stats = {"delta": 1.0 / rate, "sampling_rate": rate, "starttime": start, **more}
    header = SimpleNamespace(**stats)
    header.get = stats.get
    return SimpleNamespace(id=f"XX.MADE..{channel}", data=np.asarray(values), stats=header)


def stream(*traces):
    return SimpleNamespace(traces=list(traces))


class TestFromTrace:
    def test_one_trace(self):
        motion = GroundMotion.from_trace(trace(), "gal")
        np.testing.assert_allclose(motion.si.horizontal.samples, 0.01 * VALUES, rtol=1e-14)
        assert motion.name == "XX.MADE.HNE"
        assert motion.metadata["azimuth"] == 90.0
        assert motion.metadata["unit_as_read"] == "gal"

    def test_a_pair_of_a_stream(self):
        traces = stream(trace("HNN"), trace("HNE"), trace("HNZ", 2.0 * VALUES))
        motion = GroundMotion.from_trace(traces, "gal", ("N", "Z"))
        np.testing.assert_allclose(motion.si.vertical.samples, 0.02 * VALUES, rtol=1e-14)
        with pytest.raises(RecordError, match="3 components"):
            GroundMotion.from_trace(traces, "gal")

    def test_pieces_of_a_channel_are_joined_unless_there_is_a_gap(self):
        whole = GroundMotion.from_trace(trace(), "gal")
        pieces = stream(trace(values=VALUES[:80]), trace(values=VALUES[80:], start=0.8))
        assert GroundMotion.from_trace(pieces, "gal").sha256 == whole.sha256
        pieces = stream(trace(values=VALUES[:80]), trace(values=VALUES[80:], start=0.85))
        with pytest.raises(RecordError, match=r"a gap of 0\.05 s"):
            GroundMotion.from_trace(pieces, "gal")
        masked = np.ma.masked_array(VALUES, VALUES > 1.0)
        gappy = trace()
        gappy.data = masked
        with pytest.raises(RecordError, match="masked samples"):
            GroundMotion.from_trace(gappy, "gal")

    def test_unit_comes_from_argument_or_trace(self):
        with pytest.raises(RecordError, match="no unit of the samples"):
            GroundMotion.from_trace(trace())
        stated = trace(standard={"units": "cm/s^2"})
        assert GroundMotion.from_trace(stated).metadata["unit_as_read"] == "cm/s^2"
        with pytest.warns(RecordWarning, match=r"peak acceleration is .* g"):
            GroundMotion.from_trace(trace(), "g")

    @pytest.mark.parametrize("argument", [3, "path", VALUES, stream(), None])
    def test_invalid_traces_raise(self, argument):
        with pytest.raises(ComponentError, match="needs an ObsPy Trace, or a Stream"):
            GroundMotion.from_trace(argument, "gal")

    @pytest.mark.skipif(importlib.util.find_spec("obspy") is None, reason="ObsPy is not installed")
    @pytest.mark.filterwarnings("ignore::DeprecationWarning")
    def test_obspy_trace_and_stream_are_accepted(self):
        import obspy

        own = obspy.Trace(VALUES, {"network": "XX", "station": "MADE", "channel": "HNE"})
        own.stats.sampling_rate = 100.0
        for traces in (own, obspy.Stream([own])):
            motion = GroundMotion.from_trace(traces, "gal")
            assert motion.sha256 == GroundMotion.from_trace(trace(), "gal").sha256
            assert motion.metadata["record_time"] == "1970-01-01T00:00:00.000000Z"
