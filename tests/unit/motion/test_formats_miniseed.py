"""miniSEED: advice if ObsPy is missing, instrument response, damaged files."""

import importlib.util
import io
import itertools
import subprocess
import sys
import tracemalloc

import numpy as np
import pytest
from processor_time import processor_time
from unit.motion.binary_samples import miniseed, station_xml
from unit.motion.format_samples import COUNT, COUNTS

from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion
from rockframe.records.miniseed import _rate

needs_obspy = pytest.mark.skipif(
    importlib.util.find_spec("obspy") is None, reason="ObsPy is not installed"
)


def compressed(counts, channel: str) -> bytes:
    """Records of 512 bytes of one channel, as ObsPy writes them."""
    from obspy import Trace

    header = {"network": "XX", "station": "MADE", "channel": channel, "sampling_rate": 100.0}
    file = io.BytesIO()
    trace = Trace(np.asarray(counts, dtype=np.int32), header)
    trace.write(file, format="MSEED", encoding="STEIM2", reclen=512)
    return file.getvalue()


@pytest.mark.parametrize("name", ["r.mseed", "r.txt", "r"])
@pytest.mark.parametrize("arguments", [{}, {"unit": "g"}, {"format": "miniseed"}])
def test_missing_obspy_error_names_extra_to_install(write, monkeypatch, name, arguments):
    monkeypatch.setitem(sys.modules, "obspy", None)
    with pytest.raises(RecordError, match=r"no ObsPy.*pip install 'rockframe\[records\]'"):
        GroundMotion.read(write(miniseed(), name), **arguments)


def test_text_is_no_miniseed(write):
    with pytest.raises(RecordError, match=r"begins with b'time,a'"):
        GroundMotion.read(write("time,a", "r.mseed"), format="miniseed")


def test_station_xml_is_not_the_record(write):
    with pytest.raises(RecordError, match="StationXML, which describes an instrument"):
        GroundMotion.read(write(station_xml(), "r.xml"))


def test_obspy_is_not_imported_for_other_formats(write):
    before = "obspy" in sys.modules
    GroundMotion.read(write("0.00,1\n0.01,2\n", "r.csv"), unit="m/s^2")
    assert ("obspy" in sys.modules) == before


@needs_obspy
class TestWithObspy:
    def test_counts_are_converted_with_neighbouring_response_file(self, write):
        write(station_xml(), "r.xml")
        motion = GroundMotion.read(write(miniseed(), "r.mseed"))
        expected = (COUNTS - COUNTS.mean()) / 4e5
        np.testing.assert_allclose(motion.si.horizontal.samples, expected, rtol=1e-12, atol=1e-18)
        assert motion.si.time_step == 0.01
        assert motion.metadata["component"] == "HNE"
        assert motion.metadata["azimuth"] == 90.0
        assert motion.metadata["sensitivity"] == 4e5
        assert motion.metadata["offset_removed"] == pytest.approx(COUNTS.mean())
        assert motion.metadata["response_file"] == "r.xml"
        assert motion.metadata["unit_as_read"] == "counts"
        assert (motion.metadata["network"], motion.metadata["station"]) == ("XX", "MADE")
        assert "divided by the sensitivity of 400000 counts per m/s^2 (r.xml)" in motion.history[1]

    @pytest.mark.parametrize("name", ["r.StationXML.xml", "XX.MADE.xml", "all-XX.MADE.2018.XML"])
    def test_response_file_is_found_by_name(self, write, name):
        write(station_xml(), name)
        assert len(GroundMotion.read(write(miniseed(), "r.mseed"))) == COUNT

    def test_unrelated_neighbouring_files_are_ignored(self, write):
        write(station_xml(), "other.xml")
        with pytest.raises(RecordError, match="counts, and no response"):
            GroundMotion.read(write(miniseed(), "r.mseed"))

    def test_ambiguous_response_files_are_refused(self, write):
        write(station_xml(), "r.xml")
        other = write(station_xml(sensitivity=1e5), "XX.MADE.xml")
        path = write(miniseed(), "r.mseed")
        with pytest.raises(
            RecordError, match=r"several files with the response: XX\.MADE\.xml, r\.xml"
        ):
            GroundMotion.read(path)
        motion = GroundMotion.read(path, response=other)
        assert motion.metadata["sensitivity"] == 1e5

    def test_response_argument_is_read_and_checked(self, write, tmp_path):
        folder = tmp_path / "elsewhere"
        folder.mkdir()
        response = folder / "anything"
        response.write_text(station_xml(), encoding="utf-8")
        path = write(miniseed(), "r.mseed")
        assert len(GroundMotion.read(path, response=response)) == COUNT
        response.write_text("no xml", encoding="utf-8")
        with pytest.raises(RecordError, match="no StationXML that can be read"):
            GroundMotion.read(path, response=response)
        response.write_text(station_xml(channels=(("HNZ", 0, -90),)), encoding="utf-8")
        with pytest.raises(RecordError, match=r"the response of XX\.MADE\.\.HNE"):
            GroundMotion.read(path, response=response)
        with pytest.raises(RecordError, match="no such file"):
            GroundMotion.read(path, response=folder / "nothing")

    def test_counts_without_response_or_unit_are_refused(self, write):
        with pytest.raises(RecordError, match=r"counts, and no response.*argument unit"):
            GroundMotion.read(write(miniseed(), "r.mseed"))

    @pytest.mark.filterwarnings("ignore:.*lie around an offset")
    def test_unit_argument_overrides_response_file(self, write):
        write(station_xml(), "r.xml")
        motion = GroundMotion.read(write(miniseed(COUNTS // 100), "r.mseed"), unit="gal")
        assert motion.si.horizontal.samples.tolist() == pytest.approx(
            (COUNTS // 100 * 0.01).tolist()
        )
        assert "as requested" in motion.history[1]

    def test_unit_and_response_exclude_each_other(self, write):
        response = write(station_xml(), "r.xml")
        with pytest.raises(RecordError, match="the arguments unit and response"):
            GroundMotion.read(write(miniseed(), "r.mseed"), unit="g", response=response)

    @pytest.mark.parametrize(
        ("xml", "words"),
        [
            (station_xml(units="M/S"), "input unit 'M/S'; expected .* accelerometer"),
            (station_xml(sensitivity=0.0), "sensitivity of 0.0"),
        ],
    )
    def test_responses_without_acceleration_are_refused(self, write, xml, words):
        write(xml, "r.xml")
        with pytest.raises(RecordError, match=words):
            GroundMotion.read(write(miniseed(), "r.mseed"))

    def test_seismometer_channel_does_not_affect_accelerometer(self, write):
        channels = (("HNE", 90, 0), ("HHE", 90, 0))
        xml = station_xml(channels=channels)
        before, after = xml.split('code="HHE"')
        write(before + 'code="HHE"' + after.replace("M/S**2", "M/S"), "r.xml")
        data = b"".join(miniseed(channel=name) for name, *_ in channels)
        path = write(data, "r.mseed")
        assert GroundMotion.read(path, component="HNE").metadata["component"] == "HNE"
        with pytest.raises(RecordError, match="input unit 'M/S'"):
            GroundMotion.read(path, component="HHE")

    def test_response_from_other_epoch_is_ignored(self, write):
        write(station_xml().replace("2010-01-01", "2020-01-01"), "r.xml")
        with pytest.raises(RecordError, match="counts, and no response"):
            GroundMotion.read(write(miniseed(), "r.mseed"))

    def test_external_xml_entities_are_not_resolved(self, write, tmp_path):
        secret = tmp_path / "secret"
        secret.write_text("7", encoding="ascii")
        head, body = station_xml().split("\n", 1)
        entity = f'<!DOCTYPE z [<!ENTITY a SYSTEM "{secret.as_uri()}">]>'
        write(f"{head}\n{entity}\n{body.replace('400000.0', '&a;')}", "r.xml")
        with pytest.raises(RecordError, match=r"with a sensitivity of +counts"):
            GroundMotion.read(write(miniseed(), "r.mseed"))

    def test_oversized_response_is_refused(self, write):
        response = write(station_xml().ljust(9 * 2**20), "given")
        with pytest.raises(RecordError, match="found 9 MiB; expected StationXML of at most 8 MiB"):
            GroundMotion.read(write(miniseed(), "r.mseed"), response=response)

    def test_channels_of_one_file(self, write):
        channels = (("HNE", 90, 0), ("HNZ", 0, -90), ("HN1", 30, 0))
        write(station_xml(channels=channels), "r.xml")
        data = b"".join(
            miniseed(COUNTS + 7 * k, channel=name) for k, (name, *_) in enumerate(channels)
        )
        path = write(data, "r.mseed")
        with pytest.raises(RecordError, match=r"3 components: .*'HN1' \(30°\)"):
            GroundMotion.read(path)
        assert GroundMotion.read(path, component="30").metadata["component"] == "HN1"
        both = GroundMotion.read(path, component=("XX.MADE..HNE", "Z"))
        assert both.metadata["vertical_component"] == "HNZ"
        np.testing.assert_allclose(both.si.vertical.samples, both.si.horizontal.samples, atol=1e-15)

    def test_records_that_follow_one_another(self, write):
        write(station_xml(), "r.xml")
        data = miniseed(COUNTS[:50].repeat(2)) + miniseed(COUNTS, start=1)
        assert len(GroundMotion.read(write(data, "r.mseed"))) == 100 + COUNT

    def test_a_gap_is_refused(self, write):
        write(station_xml(), "r.xml")
        data = miniseed() + miniseed(start=2)
        with pytest.raises(RecordError, match=r"a gap of 1\.39 s before 2018"):
            GroundMotion.read(write(data, "r.mseed"))

    def test_two_sampling_rates_are_refused(self, write):
        write(station_xml(), "r.xml")
        data = miniseed() + miniseed(start=2, rate=50)
        with pytest.raises(RecordError, match="sampling rates of 100 Hz and 50 Hz"):
            GroundMotion.read(write(data, "r.mseed"))

    @pytest.mark.parametrize("cut", [40, 100, 300])
    def test_a_part_of_a_record_is_refused(self, write, cut):
        write(station_xml(), "r.xml")
        with pytest.raises(RecordError):
            GroundMotion.read(write(miniseed()[:cut], "r.mseed"))

    def test_too_many_channels_are_refused(self, write):
        letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
        codes = ["".join(code) for code in itertools.product(letters[:5], letters, letters)]
        data = b"".join(miniseed(channel=code) for code in codes[:1001])
        with pytest.raises(RecordError, match="more than 1000 channels"):
            GroundMotion.read(write(data, "r.mseed"), unit="gal")

    def test_overlapping_pieces_are_refused_quickly(self, write):
        path = write(miniseed(COUNTS[:4]) * 70_000, "r.mseed")

        def refused():
            with pytest.raises(RecordError, match="more than 2000 pieces"):
                GroundMotion.read(path, unit="gal")

        tracemalloc.start()
        try:
            assert processor_time(refused, 1.0) < 1.0
            assert tracemalloc.get_traced_memory()[1] < 100e6
        finally:
            tracemalloc.stop()

    @pytest.mark.filterwarnings("ignore:.*lie around an offset")
    def test_many_contiguous_pieces_are_joined(self, write):
        counts = np.tile(COUNTS[:50], 2)
        pieces = b"".join(
            miniseed(counts[:50], start=k // 2, tenths=5000 * (k % 2)) for k in range(100)
        )
        assert len(GroundMotion.read(write(pieces, "r.mseed"), unit="mgal")) == 5000

    @pytest.mark.wide
    def test_obspy_output_does_not_reach_terminal(self, write):
        # a length of 10^9 samples and truncated data cause errors in callbacks of the library
        code = (
            "import sys; from rockframe.motion import GroundMotion\n"
            "from rockframe.errors import RecordError\n"
            "hook = sys.unraisablehook\n"
            "for path in sys.argv[1:]:\n"
            "    try: GroundMotion.read(path, unit='gal')\n"
            "    except RecordError: pass\n"
            "assert sys.unraisablehook is hook"
        )
        paths: list[str] = []
        for place, byte in itertools.product((30, 39, 44, 46, 52, 53, 54), (0, 1, 7, 255)):
            data = bytearray(miniseed() * 2)
            data[place] = byte
            paths.append(str(write(bytes(data), f"{place}_{byte}.mseed")))
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", code, *paths],
            capture_output=True,
            text=True,
            check=True,
        )
        assert done.stderr == ""
        assert done.stdout == ""

    @pytest.mark.parametrize("output", ["None", "", "COUNTS", "counts"])
    def test_missing_output_unit_means_counts(self, write, output):
        xml = station_xml(sensitivity=1e3).replace("COUNTS", output)
        path = write(miniseed(), "r.mseed")
        motion = GroundMotion.read(path, response=write(xml, "given.xml"))
        assert motion.metadata["sensitivity"] == 1e3

    def test_corrupt_steim_compression_is_refused(self, write):
        # a wrong difference shifts all later samples
        data = bytearray(compressed(np.arange(400) // 3, "HNE") + compressed(np.arange(400), "HNN"))
        data[103] ^= 1
        path = write(bytes(data), "r.mseed")
        with pytest.raises(RecordError, match=r"Steim2 samples of XX\.MADE\.\.HNE that end at"):
            GroundMotion.read(path, component="HNE", unit="mgal")
        other = GroundMotion.read(path, component="HNN", unit="mgal")
        np.testing.assert_allclose(other.si.horizontal.samples, 1e-5 * np.arange(400))

    @pytest.mark.filterwarnings("ignore:.*lie around an offset")
    def test_trailing_bytes_that_are_no_record_warn(self, write):
        data = miniseed() + b"?" * 512
        with pytest.warns(RecordWarning, match=r"\b512 bytes that are no miniSEED record are not"):
            GroundMotion.read(write(data, "r.mseed"), unit="mgal")

    def test_an_output_in_volts_is_refused(self, write):
        xml = station_xml().replace("COUNTS", "V")
        with pytest.raises(RecordError, match="expected counts per acceleration"):
            GroundMotion.read(write(miniseed(), "r.mseed"), response=write(xml, "given.xml"))


@pytest.mark.parametrize(
    ("factor", "multiplier", "rate"),
    [
        # the examples of the SEED manual 2.4: 330, 330.6 and one sample in a minute, and others
        (33, 10, 330.0),
        (330, 1, 330.0),
        (3306, -10, 330.6),
        (-60, 1, 1.0 / 60.0),
        (-6, -10, 1.0 / 60.0),
        (-10, 2, 0.2),
        (50, 0, 50.0),
    ],
)
def test_rate_follows_from_factor_and_multiplier(factor, multiplier, rate):
    assert _rate(factor, multiplier) == pytest.approx(rate, rel=1e-12)
