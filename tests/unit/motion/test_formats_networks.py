"""Features specific to ESM, K-NET and KiK-net, GeoNet and Taiwan's CWA."""

import numpy as np
import pytest
from unit.motion.format_samples import (
    COUNT,
    COUNTS,
    VALUES,
    cwa,
    esm,
    geonet,
    geonet_component,
    knet,
)
from unit.motion.motion_files import rows

from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion

GAL_PER_COUNT = 3920.0 / 6182761.0


class TestEsm:
    def read(self, write, text, **options):
        return GroundMotion.read(write(text, "r.ASC"), **options)

    def test_metadata_are_read_from_header(self, write):
        metadata = self.read(write, esm()).metadata
        assert metadata["event"] == "MADE UP"
        assert metadata["event_time"] == "20190728_160908"
        assert (metadata["network"], metadata["station"]) == ("XX", "MADE")
        assert metadata["station_name"] == "Some: Place"
        assert metadata["record_time"] == "20190728_160919.870"
        assert metadata["baseline_correction"] == "BASELINE REMOVED"
        assert (metadata["component"], metadata["azimuth"]) == ("HNE", 90.0)

    @pytest.mark.parametrize("component", ["HNE", "E", "90"])
    def test_component_is_chosen_by_code_or_direction(self, write, component):
        assert len(self.read(write, esm(), component=component)) == COUNT

    @pytest.mark.parametrize("kind", ["VELOCITY", "DISPLACEMENT", "ACCELERATION RESPONSE SPECTRUM"])
    def test_other_quantities_are_refused(self, write, kind):
        with pytest.raises(RecordError, match=f"DATA_TYPE '{kind}'; expected an acceleration"):
            self.read(write, esm(DATA_TYPE=kind), unit="g")

    @pytest.mark.parametrize(
        ("changed", "words"),
        [
            ({"SAMPLING_INTERVAL_S": ""}, "no value of 'SAMPLING_INTERVAL_S'"),
            ({"SAMPLING_INTERVAL_S": "0"}, "time step of 0.0 s"),
            ({"SAMPLING_INTERVAL_S": "1e999"}, "overflows"),
            ({"SAMPLING_INTERVAL_S": "five"}, "'five'; expected a number"),
            ({"NDATA": ""}, "no value of 'NDATA'"),
            ({"NDATA": "-61"}, "NDATA '-61'"),
            ({"NDATA": "99999999999999999999"}, "NDATA '99999999999999999999'"),
            ({"NDATA": "999999999"}, "after 61 samples; expected 999999999"),
            ({"UNITS": "cm/s"}, "a velocity in cm/s"),
            ({"UNITS": ""}, "no unit"),
        ],
    )
    def test_headers_that_are_refused(self, write, changed, words):
        with pytest.raises(RecordError, match=words):
            self.read(write, esm(**changed))

    def test_a_number_of_samples_that_disagrees_a_little(self, write):
        with pytest.warns(RecordWarning, match="NDATA declares 63 samples, but the file holds 61"):
            motion = self.read(write, esm(NDATA="63"))
        assert (motion.metadata["declared_samples"], motion.metadata["counted_samples"]) == (63, 61)

    def test_cut_inside_the_last_number(self, write):
        with pytest.raises(RecordError, match=r"inside a number \(61 of 61 samples\)"):
            self.read(write, esm().rstrip()[:-2])


class TestKnet:
    def read(self, write, text, name="r.EW", **options):
        return GroundMotion.read(write(text, name), **options)

    def test_counts_are_converted_and_offset_removed(self, write):
        motion = self.read(write, knet())
        expected = (COUNTS - COUNTS.mean()) * GAL_PER_COUNT * 0.01
        np.testing.assert_allclose(motion.si.horizontal.samples, expected, rtol=1e-12, atol=1e-15)
        assert abs(motion.si.horizontal.samples.mean()) < 1e-15
        assert motion.metadata["offset_removed"] == pytest.approx(COUNTS.mean())
        assert motion.metadata["gal_per_count"] == GAL_PER_COUNT
        assert "scale_factor" not in motion.metadata  # of scaled motions only
        sentence = motion.history[1]
        assert "scale factor 3920(gal)/6182761" in sentence
        assert f"less their mean of {COUNTS.mean():.9g} counts" in sentence
        assert "gal)" in sentence

    def test_times_are_in_japan_time_without_trigger_delay(self, write):
        metadata = self.read(write, knet()).metadata
        assert (
            metadata["event_time"]
            == "2018/01/24 19:51:00".replace("/", "-").replace(" ", "T") + "+09:00"
        )
        assert metadata["record_time"] == "2018-01-24T19:51:22+09:00"
        assert metadata["station"] == "MADE01"

    @pytest.mark.parametrize(
        ("direction", "name", "component", "place"),
        [
            ("N-S", "N-S", "N", None),
            ("E-W", "E-W", "E", None),
            ("U-D", "U-D", "U", None),
            ("1", "NS1", "N", "borehole"),
            ("2", "EW1", "EW1", "borehole"),
            ("3", "UD1", "U", "borehole"),
            ("4", "NS2", "channel 4", "surface"),
            ("5", "EW2", "5", "surface"),
            ("6", "UD2", "UD2", "surface"),
        ],
    )
    def test_directions(self, write, direction, name, component, place):
        metadata = self.read(write, knet(**{"Dir.": direction}), component=component).metadata
        assert metadata["component"] == name
        assert metadata.get("sensor_location") == place

    @pytest.mark.parametrize("rate", ["100Hz", "100 Hz", "200HZ", "50"])
    def test_rates(self, write, rate):
        hertz = float(rate.upper().removesuffix("HZ"))
        text = knet(**{"Sampling Freq(Hz)": rate, "Duration Time(s)": str(COUNT / hertz)})
        assert self.read(write, text).si.time_step == 1.0 / hertz

    @pytest.mark.parametrize(
        ("changed", "words"),
        [
            ({"Scale Factor": ""}, "no value of 'Scale Factor'"),
            ({"Scale Factor": "3920(gal)/0"}, "a scale factor of '3920.gal./0'"),
            ({"Scale Factor": "3920/6182761"}, "such as 3920.gal./6182761"),
            ({"Scale Factor": "1e300(gal)/1e-300"}, "a scale factor of"),
            ({"Sampling Freq(Hz)": "0Hz"}, "a sampling rate of 0.0 Hz"),
            ({"Sampling Freq(Hz)": "fast"}, "expected a number"),
            ({"Duration Time(s)": "1e12"}, "a duration of '1e12' s"),
            ({"Duration Time(s)": "999999"}, "after 61 samples; expected 99999900"),
            ({"Duration Time(s)": ""}, "no value of 'Duration Time"),
            ({"Dir.": ""}, "no value of 'Dir.'"),
        ],
    )
    def test_headers_that_are_refused(self, write, changed, words):
        with pytest.raises(RecordError, match=words):
            self.read(write, knet(**changed))

    def test_counts_that_are_not_whole_are_refused(self, write):
        text = knet().replace(str(COUNTS[9]), "1234.5", 1)
        with pytest.raises(RecordError, match=r"1234\.5 as sample 10; expected counts") as caught:
            self.read(write, text)
        assert caught.value.line == 19

    def test_a_peak_that_disagrees_is_warned_about(self, write):
        with pytest.warns(RecordWarning, match="the header gives a peak of 99 gal"):
            self.read(write, knet(**{"Max. Acc. (gal)": "99.000"}))

    def test_the_other_spelling_of_the_peak(self, write):
        text = knet().replace("Max. Acc. (gal)   ", "Max Acc. (gal)    ")
        self.read(write, text)
        with pytest.warns(RecordWarning, match="gives a peak of"):
            self.read(write, text.replace("Max Acc. (gal)    ", "Max Acc. (gal)    9"))

    def test_cut_inside_the_last_number(self, write):
        with pytest.raises(RecordError, match="inside a number"):
            self.read(write, knet(COUNTS[:40] - 20000).rstrip()[:-2])


class TestGeonet:
    def read(self, write, text, name="r.V2A", **options):
        return GroundMotion.read(write(text, name), **options)

    def test_metadata_are_read_from_header(self, write):
        metadata = self.read(write, geonet(), component="S74E").metadata
        assert metadata["event"] == "6 km south of Nowhere"
        assert metadata["event_time"] == "2018 February 12 21:15:54 UT"
        assert metadata["record_time"] == "2018-02-12T21:15:17.000Z"
        assert (metadata["station"], metadata["station_name"]) == ("MADE", "Made Up Council")
        assert metadata["azimuth"] == 106.0
        assert metadata["unit_as_read"] == "mm/s^2"

    @pytest.mark.parametrize("corrected", [True, False])
    @pytest.mark.parametrize(("component", "key"), [("S16W", "N"), ("106", "E"), ("Up", "U")])
    def test_every_component(self, write, corrected, component, key):
        motion = self.read(write, geonet(corrected=corrected), component=component)
        expected = np.round(10.0 * VALUES[key], 1) * 1e-3
        np.testing.assert_allclose(motion.si.horizontal.samples, expected, rtol=1e-12)

    @pytest.mark.parametrize(
        ("old", "new", "words"),
        [
            (
                "Number of points  61",
                "Number of points  62",
                "61 accelerations in the integers, 62",
            ),
            ("data at 0.020 sec", "data at 0.005 sec", "one time step"),
            ("0.0200", "0.0000", "time step of 0.0 s"),
            ("0.0200", "   two", "'two'; expected a number"),
            ("Component S16W", "Component      ", "expected the component 'S16W'"),
            ("Corrected accelerogram", "Improved accelerogram", "Corrected accelerogram"),
        ],
    )
    def test_headers_that_are_refused(self, write, old, new, words):
        text = geonet_component(VALUES["N"], name="S16W", azimuth=16)
        assert old in text
        with pytest.raises(RecordError, match=words):
            self.read(write, text.replace(old, new, 1), format="geonet", component="S16W")

    @pytest.mark.parametrize("place", [4, 5])
    def test_impossible_counts_of_skipped_values_are_refused(self, write, place):
        lines = geonet().split("\n")
        for number, words in ((99999999, "end of the file in component 1"), (-1, "none or more")):
            changed = list(lines)
            row = changed[19]
            changed[19] = row[: 8 * place] + f"{number:8d}" + row[8 * place + 8 :]
            with pytest.raises(RecordError, match=words):
                self.read(write, "\n".join(changed), component="S16W")

    @pytest.mark.parametrize("from_end", [4, 5])
    def test_a_line_that_is_missing_in_the_last_component(self, write, from_end):
        # its last accelerations would be taken from the velocities that follow
        lines = geonet().rstrip("\n").split("\n")
        del lines[-from_end - 1]
        with pytest.raises(RecordError, match=r"found the end of the file in component 3"):
            self.read(write, "\n".join(lines) + "\n", component="Up")

    def test_vertical_axis_of_unknown_sense_warns(self, write):
        text = geonet().replace("Component Up    Some", "Component Vert. Vertical")
        with pytest.warns(RecordWarning, match="upwards or downwards; upwards is assumed"):
            motion = self.read(write, text, component=("S16W", "V"))
        assert motion.metadata["vertical_component"] == "Vert."

    def test_unknown_text_after_component_is_refused(self, write):
        text = geonet_component(VALUES["N"], name="S16W", azimuth=196) + "something else\n"
        with pytest.raises(RecordError, match="'something else'; expected 'Corrected"):
            self.read(write, text)


class TestCwa:
    def read(self, write, text, **options):
        return GroundMotion.read(
            write(text, "r.dat"), component=options.pop("component", "N"), **options
        )

    def test_metadata_are_read_from_header(self, write):
        metadata = self.read(write, cwa()).metadata
        assert metadata["event_time"] == "2018/02/06-23:50:42 (GMT+08)"
        assert metadata["record_time"] == "2018/02/06-23:50:29.000 (GMT+08)"
        assert (metadata["station"], metadata["station_name"]) == ("MADE", "Made Up")
        assert metadata["unit_as_read"] == "gal"
        assert metadata["baseline_correction"] == "DCoffset(corr)"

    def test_columns_follow_the_header(self, write):
        text = cwa(sequence="Time N(+); E(+); U(+)")
        motion = self.read(write, text, component="N")
        np.testing.assert_allclose(motion.si.horizontal.samples, VALUES["U"] * 0.01, rtol=1e-12)

    @pytest.mark.filterwarnings("ignore:.*lie around an offset")
    def test_columns_that_touch(self, write):
        table = np.column_stack(
            [0.02 * np.arange(COUNT), *(-99_900.0 + VALUES[key] for key in "UNE")]
        )
        head = cwa().split("     0.000")[0]
        text = head + rows(table.ravel(), 4, "{:10.3f}")
        assert "0-99" in text
        with pytest.warns(RecordWarning, match="peak acceleration"):
            motion = self.read(write, text, component="E")
        np.testing.assert_allclose(motion.si.horizontal.samples, table[:, 3] * 0.01, rtol=1e-9)

    @pytest.mark.parametrize(
        ("options", "words"),
        [
            ({"rate": "100"}, r"the time 0\.02 s in row 2; expected 0\.01 s"),
            ({"rate": "0"}, "a sampling rate of 0.0 Hz"),
            ({"rate": "often"}, "'often'; expected a number"),
            ({"layout": "3F10.3"}, "the layout '3F10.3'; expected 4 columns"),
            ({"layout": "free"}, "the layout 'free'"),
            ({"layout": "4F0.0"}, "a layout of 4 numbers of 0 characters"),
            ({"layout": "4F12.3"}, "characters"),
            ({"sequence": "U(+); N(+)"}, "expected the time, then the components"),
            ({"sequence": "Time U(+); N(+)"}, "the layout '4F10.3'; expected 3 columns"),
        ],
    )
    def test_headers_that_are_refused(self, write, options, words):
        with pytest.raises(RecordError, match=words):
            self.read(write, cwa(**options))

    def test_the_header_alone(self, write):
        with pytest.raises(RecordError, match="0 rows of numbers"):
            self.read(write, cwa().split("     0.000")[0])

    def test_a_length_that_disagrees(self, write):
        text = cwa().replace(f"#RecordLength(sec): {COUNT / 50}", "#RecordLength(sec): 120")
        with pytest.raises(RecordError, match="after 61 samples; expected 6000"):
            self.read(write, text)

    def test_a_missing_row_is_refused_at_its_line(self, write):
        lines = cwa().split("\n")
        del lines[20]
        with pytest.raises(RecordError, match=r"the time 0\.12 s in row 6") as caught:
            self.read(write, "\n".join(lines))
        assert caught.value.line == 21
