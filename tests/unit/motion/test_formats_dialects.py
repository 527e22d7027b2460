"""Dialects of agencies: metadata, checks and refused files."""

import numpy as np
import pytest
from unit.motion import dialect_samples as dialects
from unit.motion.dialect_samples import COUNT, TENTHS, VALUES
from unit.motion.motion_files import G

from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion


def read(write, text, name="record", **options):
    return GroundMotion.read(write(text, name), **options)


def expect(motion, values):
    np.testing.assert_allclose(motion.si.horizontal.samples, values, rtol=1e-12, atol=1e-12)


class TestCsmip:
    def test_processing_remarks_are_not_read_as_event(self, write):
        metadata = read(write, dialects.cgs(), component="E").metadata
        assert metadata["event"] == "Made Up Earthquake"
        assert metadata["event_time"] == "Mon Feb 13, 2012 13:06:45.0 PST"
        assert metadata["station_name"] == "Willow Creek"
        text = dialects.cgs().replace("Made Up Earthquake of 13 Feb 2012", "")
        assert "event" not in read(write, text, component="E").metadata

    @pytest.mark.parametrize("number", ["0", "-5", "1.2.3"])
    def test_invalid_sampling_rate_is_refused(self, write, number):
        text = dialects.cgs(
            points=f"{{count}} Accelerogram points at {number} pts/sec in units of g ."
        )
        with pytest.raises(RecordError, match=r"expected a (rate|time step)|expected 10 numbers"):
            read(write, text, component="E")

    def test_missing_unit_is_taken_from_stated_peak(self, write):
        motion = read(write, dialects.usc(unit=""))
        expect(motion, 0.01 * VALUES["E"])
        assert motion.metadata["unit_as_read"] == "cm/sec/sec"
        assert motion.metadata["event_time"] == "JAN 17, 1994 -1230 GMT"
        assert motion.metadata["station"] == "0061"
        text = dialects.usc(unit="").replace("PEAK ACCELERATION", "SOMETHING")
        with pytest.raises(RecordError, match="no unit of the samples"):
            read(write, text)

    @pytest.mark.parametrize("indent", ["", " "])
    def test_pairs_in_either_indent(self, write, indent):
        motion = read(write, dialects.pairs(indent=indent), component="EW")
        expect(motion, 0.1 * G * TENTHS["E"])
        assert motion.si.time_step == 0.01
        assert motion.metadata["event_time"] == "11/12/2009 23:09:53"
        first = "FILE 1 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:"
        retitled = read(write, dialects.pairs(indent=indent, first=first), component="EW")
        assert retitled.sha256 == motion.sha256

    def test_pairs_at_uneven_times_are_refused(self, write):
        times = 0.01 * np.arange(COUNT)
        times[20] += 0.004
        with pytest.raises(RecordError, match=r"the time 0\.204 after 0\.190, unevenly") as caught:
            read(write, dialects.pairs(times=times), component="EW")
        lines = dialects.pairs(times=times).split("\n")
        assert "0.204" in lines[caught.value.line - 1]

    def test_numeric_event_name_is_ignored(self, write):
        assert "event" not in read(write, dialects.pairs(event="0911131"), component="EW").metadata


class TestBhrc:
    def test_other_volumes_are_refused(self, write):
        with pytest.raises(RecordError, match=r"expected uncorrected accelerations \(volume 1\)"):
            read(write, dialects.bhrc(volume=2), component="L1")

    @pytest.mark.parametrize("rate", [0.0, -1.0])
    def test_sampling_rate_must_be_positive(self, write, rate):
        with pytest.raises(RecordError, match="expected one above zero"):
            read(write, dialects.bhrc(rate=rate), component="L1")

    def test_a_rate_that_contradicts_the_length(self, write):
        with pytest.warns(RecordWarning, match="states a length of 0.61 s, but 61 samples at 0.02"):
            read(write, dialects.bhrc(rate=50.0), component="L1")

    def test_longitudinal_transverse_and_vertical(self, write):
        assert read(write, dialects.bhrc(), component="L1").metadata["azimuth"] == 50.0
        assert read(write, dialects.bhrc(), component="T").metadata["azimuth"] == 140.0
        with pytest.warns(RecordWarning, match="does not say whether V2 is positive upwards"):
            read(write, dialects.bhrc(), component=("L", "V"))


class TestCsmnc:
    @pytest.mark.parametrize("kind", ["CORRECTED VELOCITY", "CORRECTED DISPLACEMENT"])
    def test_other_quantities(self, write, kind):
        with pytest.raises(RecordError, match="expected an acceleration") as caught:
            read(write, dialects.csmnc(kind=kind, unit="CM/SEC"), unit="gal")
        assert caught.value.line == 9

    def test_metadata_are_read_from_header(self, write):
        metadata = read(write, dialects.csmnc()).metadata
        assert metadata["event"] == "MADE UP EARTHQUAKE, SOMEWHERE,CHN"
        assert metadata["event_time"] == "2012-01-03 15:39:57 BTM"
        assert metadata["record_time"] == "2012-01-3 15:39:44.000 BTM"
        assert (metadata["station"], metadata["azimuth"]) == ("65XYZ", 90.0)


class TestUnam:
    def test_signs_of_the_orientations(self, write):
        motion = read(
            write, dialects.unam(orientations="/-V;1/+N90E;2/-N00E;3"), component=("E", "U")
        )
        expect(motion, 0.01 * VALUES["E"])
        np.testing.assert_allclose(motion.si.vertical.samples, -0.01 * VALUES["U"], rtol=1e-12)
        south = read(write, dialects.unam(orientations="/-V/N90E/-N00E"), component="S")
        expect(south, 0.01 * VALUES["N"])  # of the third channel, which is positive to the south
        assert south.metadata["azimuth"] == 180.0

    def test_a_channel_without_a_step(self, write):
        text = dialects.unam().replace("/0.01/0.01/0.01", "/0.01/0.01")
        read(write, text, component="E")
        with pytest.raises(RecordError, match="no sampling interval of channel 3"):
            read(write, text, component="S")


class TestResorce:
    def test_adjoining_numbers_are_split_by_width(self, write):
        text = dialects.resorce()
        assert "E-01-" in text
        expect(read(write, text), 0.01 * VALUES["N"])

    def test_fewer_samples_than_announced_are_refused(self, write):
        with pytest.raises(RecordError, match="expected 71 samples"):
            read(write, dialects.resorce(count=71))

    def test_velocity_unit_is_refused(self, write):
        with pytest.raises(RecordError, match="a velocity in m/s"):
            read(write, dialects.resorce(unit="m/s"))


class TestAfad:
    def test_rows_of_another_length(self, write):
        lines = dialects.afad().split("\n")
        lines[20] = lines[20][:28]
        with pytest.raises(RecordError, match="2 fields; expected 3") as caught:
            read(write, "\n".join(lines), component="E")
        assert caught.value.line == 21

    def test_without_a_unit(self, write):
        text = dialects.afad().replace("RAW PGA VALUES (gal)", "SOMETHING           ")
        with pytest.raises(RecordError, match="no unit of the samples"):
            read(write, text, component="E")
        expect(read(write, text, component="E", unit="gal"), 0.01 * VALUES["E"])


class TestAt2:
    def test_header_and_data_markers_are_accepted(self, write):
        values = np.round(1e-3 * VALUES["N"], 5)
        expect(read(write, dialects.marked_at2(values), "m.AT2"), values * G)
        without = dialects.marked_at2(values, end="")
        expect(read(write, without, "m.AT2"), values * G)

    def test_data_after_end_marker_is_refused(self, write):
        values = np.round(1e-3 * VALUES["N"], 5)
        with pytest.raises(RecordError, match="line 13: found"):
            read(write, dialects.marked_at2(values, end="*** End Data ***\n1.0\n"), "m.AT2")


class TestItaca:
    @pytest.mark.parametrize("kind", ["PROCESSED ACCELERATION", "ACCELERATION"])
    def test_kinds_of_accelerations(self, write, kind):
        expect(read(write, dialects.itaca(DATA_TYPE=kind)), 0.01 * VALUES["E"])

    @pytest.mark.parametrize("kind", ["UNPROCESSED VELOCITY", "ACCELERATION RESPONSE SPECTRUM"])
    def test_other_quantities(self, write, kind):
        with pytest.raises(RecordError, match="expected an acceleration"):
            read(write, dialects.itaca(DATA_TYPE=kind))
