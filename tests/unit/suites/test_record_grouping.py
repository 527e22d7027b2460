"""Components are grouped into records by station, sensor and time, or a warning says why not."""

from contextlib import nullcontext

import numpy as np
import pytest
from records import record_path
from unit.motion.binary_samples import asdf, miniseed, station_xml
from unit.motion.motion_files import at2

import rockframe as rf
from rockframe.errors import RecordError, RecordWarning
from rockframe.records import known_formats

UNUSUAL = "ignore:.*(usual|worth a look).*:rockframe.errors.RecordWarning"
SWAYS = np.round(100.0 * np.sin(0.4 * np.arange(100)) * np.hanning(100)).astype(int)
CHANNELS = ("HNE", "HNN", "HNZ")


@pytest.fixture
def station(tmp_path):
    """Write miniSEED files of one station, and read them as a suite."""

    def read(*files, warning=None):
        for number, (channel, options) in enumerate(files):
            data = miniseed(SWAYS, channel=channel, **options)
            (tmp_path / f"{number}.{channel}.mseed").write_bytes(data)
        with pytest.warns(RecordWarning, match=warning) if warning else nullcontext():
            return rf.read_suite(tmp_path, unit="gal")

    return read


def channel_files(channels=CHANNELS, **options):
    return [(channel, options) for channel in channels]


def axes(suite):
    return [motion.metadata.get("axis") for motion in (*suite.values(), *suite.verticals.values())]


class TestMiniseed:
    def test_location_of_two_hyphens_is_empty(self, station, tmp_path):
        suite = station(*channel_files(location="--"))
        (pair,) = suite.pairs.values()
        assert pair.vertical is not None
        assert "sensor_location" not in pair.first.metadata
        (tmp_path / "XX.MADE.xml").write_text(station_xml(sensitivity=400.0))
        assert rf.GroundMotion.read(tmp_path / "0.HNE.mseed").metadata["component"] == "HNE"

    def test_two_sensors_of_a_station_are_two_records(self, station):
        suite = station(*channel_files(location="D0"), *channel_files(location="D1"))
        assert sorted(axes(suite)) == ["H1", "H1", "H2", "H2", "V", "V"]
        locations = {pair.first.metadata["sensor_location"] for pair in suite.pairs.values()}
        assert locations == {"D0", "D1"}

    def test_starts_within_tenth_of_time_step_form_pair(self, station):
        suite = station(("HNE", {}), ("HNN", {"tenths": 1}), ("HNZ", {"tenths": 10}))
        assert axes(suite) == ["H1", "H2", "V"]
        assert len(suite.pairs) == 1

    def test_starts_further_apart_warn(self, station):
        suite = station(
            ("HNE", {}), ("HNN", {"tenths": 11}), warning="first starts at .*, second at"
        )
        assert not suite.pairs
        assert axes(suite) == [None, None]

    def test_later_vertical_component_is_omitted_with_warning(self, station):
        files = (("HNE", {}), ("HNN", {}), ("HNZ", {"tenths": 50}))
        suite = station(*files, warning="without its vertical component: .*vertical at")
        (pair,) = suite.pairs.values()
        assert pair.vertical is None
        with pytest.warns(RecordWarning, match="no motion has a vertical component"):
            assert all(motion.si.vertical is None for motion in suite.with_verticals().values())

    def test_two_earthquakes_at_one_station_are_two_records(self, station):
        suite = station(*channel_files(), *channel_files(start=40))
        assert len(suite.pairs) == 2
        assert all(pair.vertical is not None for pair in suite.pairs.values())

    def test_single_component_sensors_are_not_paired(self, station):
        files = (("HNE", {"location": "00"}), ("HNN", {"location": "10"}))
        suite = station(*files, warning="not put together .sensor locations '00', '10'")
        assert not suite.pairs

    def test_instruments_at_same_location_are_separate_records(self, station):
        suite = station(*channel_files(), *channel_files(("BNE", "BNN", "BNZ")))
        assert len(suite.pairs) == 2
        assert {p.first.metadata["component"][:2] for p in suite.pairs.values()} == {"HN", "BN"}


@pytest.mark.filterwarnings(UNUSUAL)
class TestAsDownloaded:
    @pytest.mark.parametrize(
        ("names", "unit", "pairs"),
        [
            ([f"nga_east/RSN10590_ComalTX11-10-20_IU.CCM.BH{k}.00.AT2" for k in "12Z"], None, 1),
            ([f"alaska/NP.8040.D{n}.HN{k}.mseed" for n in "01" for k in "ENZ"], "nm/s^2", 2),
            ([f"wvp2/CI.WVP2..HN{k}.mseed" for k in "ENZ"], None, 1),
            ([f"UW.ALCT.--.HN{k}.MSEED" for k in "12Z"], "mm/s^2", 1),
        ],
    )
    def test_pairs_with_their_verticals(self, names, unit, pairs):
        suite = rf.read_suite([record_path(f"more2/{name}") for name in names], unit=unit)
        assert len(suite.pairs) == pairs
        assert all(pair.vertical is not None for pair in suite.pairs.values())
        assert len(suite) == 2 * pairs

    def test_nanometres_per_second_squared(self):
        name = "kogs/SL.KOGS..HN{}__20200322T052358Z__20200322T052533Z.mseed"
        suite = rf.read_suite([record_path(f"more2/{name.format(k)}") for k in "ENZ"])
        (remark,) = suite.remarks  # the starts differ by 0.12 s
        assert "first starts at 2020-03-22T05:23:57.204538Z" in remark
        peak = max(float(motion.peak_acceleration.m_as("g_0")) for motion in suite.values())
        assert 1e-3 < peak < 0.1

    def test_a_zip_of_zips(self):
        suite = rf.read_suite(record_path("more2/cesmd_test.zip"))
        assert (len(suite), len(suite.verticals), len(suite.pairs)) == (33, 9, 11)
        assert not suite.unread


class TestWorkspace:
    @pytest.fixture
    def channels(self):
        return (("HHE", "E"), ("HNE", "E"), ("HNN", "N"), ("HNZ", "U"))

    def test_readable_channels_are_read_and_others_reported(self, tmp_path, channels):
        (tmp_path / "w.h5").write_bytes(asdf(tmp_path, channels=channels))
        (tmp_path / "made.h5").unlink()
        (tmp_path / "a.csv").write_text("time (s),acc (g)\n0,0\n0.01,0.1\n0.02,0\n")
        with pytest.warns(RecordWarning, match="1 file not read .*'HHE'"):
            suite = rf.read_suite(tmp_path)
        ((path, reason),) = suite.unread.items()
        assert "'HHE'" in path
        assert "no unit" in reason
        assert list(suite) == ["a", "w HNE", "w HNN"]
        assert len(suite.pairs) == 1

    def test_pair_is_read_from_workspace(self, tmp_path, channels):
        path = tmp_path / "w.h5"
        path.write_bytes(asdf(tmp_path, channels=channels[1:]))
        pair = rf.HorizontalPair.read(path)
        assert pair.vertical is not None
        path.write_bytes(asdf(tmp_path, channels=channels))
        with pytest.raises(RecordError, match=r"'HHE'.*no unit"):
            rf.HorizontalPair.read(path)

    def test_pieces_of_channel_are_refused_as_motions(self, tmp_path, channels):
        path = tmp_path / "w.h5"
        path.write_bytes(asdf(tmp_path, channels=channels[1:], pieces=2))
        with pytest.raises(RecordError, match=r"2 pieces of XX\.MADE\.--\.HNE made_default"):
            rf.read_suite(path)
        component = "XX.MADE.--.HNE__2018-01-24T10:51:00__2018-01-24T10:51:02__made_default"
        assert len(rf.GroundMotion.read(path, component=component)) == 61

    @pytest.mark.filterwarnings(UNUSUAL)
    def test_downloaded_workspace_is_read(self):
        path = record_path("more2/workspace.h5")
        with pytest.warns(RecordWarning, match="6 files not read .*input unit 'M/S'"):
            suite = rf.read_suite(path)
        assert (len(suite), len(suite.verticals), len(suite.pairs)) == (4, 2, 2)
        assert all(pair.vertical is not None for pair in suite.pairs.values())
        with pytest.raises(RecordError, match="'M/S'"):
            rf.HorizontalPair.read(path)


class TestOneBadFile:
    GOOD = at2("NPTS= 300, DT= .01", 0.1 * np.sin(0.3 * np.arange(300)))

    @pytest.mark.parametrize(
        "fault", [RuntimeError("NetCDF: Not a valid ID"), KeyError("x"), MemoryError()]
    )
    @pytest.mark.parametrize("where", ["read", "recognises"])
    def test_does_not_stop_reading_of_folder(self, tmp_path, monkeypatch, fault, where):
        (tmp_path / "good.AT2").write_text(self.GOOD)
        (tmp_path / "bad.txt").write_text("0.0\n1.0\n")

        def failing(*_):
            raise fault

        entry = known_formats.TEXT
        monkeypatch.setattr(known_formats, "TEXT", type(entry)(**{**vars(entry), where: failing}))
        with pytest.warns(RecordWarning, match=f"1 file not read .*{type(fault).__name__}"):
            suite = rf.read_suite(tmp_path)
        assert list(suite) == ["good"]
        ((path, reason),) = suite.unread.items()
        assert path.endswith("bad.txt")
        assert f"{type(fault).__name__}" in reason
        assert "this is an error in rockframe" in reason
