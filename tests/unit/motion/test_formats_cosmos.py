"""COSMOS v1.20: fixed width, milliseconds, markers of unknown values, several channels."""

import numpy as np
import pytest
from unit.motion.format_samples import COUNT, VALUES, cosmos, cosmos_block
from unit.motion.motion_files import G

from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion

NORTH = VALUES["N"]


def read(write, text, **options):
    return GroundMotion.read(write(text, "r.V2c"), **options)


def expect(motion, values=NORTH, factor=0.01, step=0.01):
    assert motion.si.time_step == step
    np.testing.assert_allclose(
        motion.si.horizontal.samples, np.asarray(values) * factor, rtol=1e-13
    )


def test_metadata_are_read_from_header(write):
    metadata = read(write, cosmos(), component="N").metadata
    assert metadata["event"] == "Made Up Earthquake of Fri Nov 30, 2018 17:29 UTC"
    assert metadata["event_time"] == "2018/11/30 17:29:29 UTC"
    assert metadata["station"] == "XX-MADE"
    assert metadata["station_name"] == "XXXX Made Up River"
    assert metadata["record_time"] == "2018/11/30 17:29:39.137 UTC"
    assert metadata["channel"] == 1
    assert metadata["unit_as_read"] == "cm/sec2"


@pytest.mark.parametrize(
    ("milliseconds", "step"), [(5.0, 0.005), (20.0, 0.02), (3.90625, 0.00390625)]
)
def test_the_time_step_is_real_header_62_in_milliseconds(write, milliseconds, step):
    expect(read(write, cosmos_block("acceleration", NORTH, milliseconds=milliseconds)), step=step)


def test_the_length_may_be_one_step_less(write):
    expect(read(write, cosmos_block("acceleration", NORTH, length=0.6)))


@pytest.mark.parametrize("milliseconds", [0.01, 1000.0])
def test_time_step_that_contradicts_length_is_refused(write, milliseconds):
    # 0.01 is written by programs that take the unit of the header for seconds
    text = cosmos_block("acceleration", NORTH, milliseconds=milliseconds, length=0.61)
    with pytest.raises(RecordError, match=r"real headers 62, 63.*in milliseconds") as caught:
        read(write, text)
    assert caught.value.line == 38


@pytest.mark.parametrize("milliseconds", [-999.0, 0.0, -5.0])
def test_an_unknown_or_impossible_time_step_is_refused(write, milliseconds):
    with pytest.raises(RecordError, match=r"sample interval|time step of") as caught:
        read(write, cosmos_block("acceleration", NORTH, milliseconds=milliseconds))
    assert caught.value.line == 38


def test_missing_value_marker_is_taken_from_header(write):
    text = cosmos_block("acceleration", NORTH, milliseconds=-777.0)
    text = text.replace("-999, -999.00", "-777, -777.00").replace("    -999", "    -777")
    with pytest.raises(RecordError, match="no sample interval"):
        read(write, text)


@pytest.mark.parametrize(
    ("unit", "code", "factor"),
    [
        ("cm/sec2(04)", 4, 0.01),
        ("cm/s^2 (4)", 4, 0.01),
        ("cm/s^2", 4, 0.01),
        ("g(02)", 2, G),
        ("gal(10)", 10, 0.01),
        ("mg(11)", 11, 1e-3 * G),
        (" (10)", 10, 0.01),
    ],
)
def test_units(write, unit, code, factor):
    values = np.round(NORTH / 300.0, 3) if factor == G else NORTH
    expect(read(write, cosmos_block("acceleration", values, unit=unit, code=code)), values, factor)


def test_unit_that_contradicts_unit_code_is_refused(write):
    text = cosmos_block("acceleration", NORTH, unit="cm/sec2(02)")
    with pytest.raises(RecordError, match=r"'cm/sec2' with the code 2, which is g"):
        read(write, text)
    with pytest.warns(RecordWarning, match="'cm/sec2', but unit='mg'"):
        expect(read(write, text, unit="mg"), factor=1e-3 * G)


@pytest.mark.parametrize(("unit", "code"), [("counts(50)", 50), ("volts(51)", 51)])
def test_counts_without_a_unit_are_refused(write, unit, code):
    with pytest.raises(RecordError, match=r"unknown unit '(counts|volts)'.*argument unit"):
        read(write, cosmos_block("acceleration", NORTH, unit=unit, code=code))


def test_a_file_of_velocities_is_refused(write):
    text = cosmos_block("velocity", NORTH, quantity=2, unit="cm/sec(05)", code=5)
    with pytest.raises(RecordError, match="only 'Corrected velocity'; expected an acceleration"):
        read(write, text)


def test_a_quantity_code_that_is_no_acceleration_is_refused(write):
    with pytest.raises(RecordError, match=r"an angular velocity \(code 11\)") as caught:
        read(write, cosmos_block("acceleration", NORTH, quantity=11))
    assert caught.value.line == 15


@pytest.mark.parametrize(
    ("layout", "form"),
    [
        ("8F10.3", "{:10.3f}"),
        ("1E15.6", "{:15.6e}"),
        ("10F9.3", "{:9.3f}"),
        ("1F15.6E", "{:15.6E}"),
    ],
)
def test_layouts(write, layout, form):
    expect(read(write, cosmos_block("acceleration", NORTH, layout=layout, form=form)))


@pytest.mark.filterwarnings("ignore:.*lie around an offset")
def test_adjoining_numbers_are_split_by_width(write):
    values = np.round(-100.0 - abs(NORTH), 3)
    text = cosmos_block("acceleration", values, layout="8F8.3", form="{:8.3f}")
    assert "-1" in text.split("Format=(8F8.3)\n")[1].split("\n")[0][8:10]
    expect(read(write, text), values)


@pytest.mark.parametrize(
    ("azimuth", "chan", "scnl", "name", "direction"),
    [
        (90, "  3: 90 Deg", "", "90 Deg", 90.0),
        (360, "  ?:Other  ", "MADE.HNN.XX.--", "HNN", 360.0),
        (-999, "  3: 45 Deg", "", "45 Deg", 45.0),
        (-999, "  ?:Other  ", "MADE.HNE.XX.--", "HNE", 90.0),
        (-999, "  ?:Other  ", "MADE.HN1.XX.--", "HN1", None),
        (0, "  ?:Other  ", "MADE.HN2.XX.10", "HN2", None),
        (-999, "  ?:Other  ", "", "channel ?", None),
    ],
)
def test_names_and_directions(write, azimuth, chan, scnl, name, direction):
    metadata = read(
        write, cosmos_block("acceleration", NORTH, azimuth=azimuth, chan=chan, scnl=scnl)
    ).metadata
    assert metadata["component"] == name
    assert metadata.get("azimuth") == direction


@pytest.mark.parametrize("azimuth", [0, 360, 400])
def test_a_channel_code_with_z_is_vertical_whatever_its_azimuth(write, azimuth):
    text = cosmos_block("acceleration", NORTH, azimuth=azimuth, scnl="MADE.BNZ.XX.--")
    with pytest.warns(RecordWarning, match="BNZ is vertical"):
        read(write, text)
    motion = read(write, text, component="XX.MADE.--.BNZ")
    assert motion.metadata["component"] == "BNZ"


def test_one_text_line_more_than_announced(write):
    text = cosmos_block("acceleration", NORTH).replace("Hypocenter:", "One more\nHypocenter:")
    expect(read(write, text))


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("100 Integer-header", "100 whole-number", 14, "announces the integer header"),
        ("100 Real-header", "100 real numbers", 25, "announces the real header"),
        ("on  10 lines", "on  99999 lines", None, "announces the integer header|integer header"),
        ("100 Integer-header", "9999 Integer-header", 14, "9999 values on 10 lines of 10"),
        ("on  20 lines", "on 9999 lines", 25, "100 values on 9999 lines of 5"),
        ("with 13 text", "with 99 text", None, "announces the integer header"),
        ("acceleration pts", "acceleration numbers", 48, "acceleration pts"),
        ("   61 acceleration", "62 acceleration", 56, "characters"),
        ("(8F10.3)", "(0F0.0)", 48, "a layout of 0 numbers"),
        ("(10I8)", "(0I0)", 14, "values on 10 lines of 0"),
    ],
)
def test_headers_that_are_refused(write, old, new, line, words):
    text = cosmos_block("acceleration", NORTH)
    assert old in text
    with pytest.raises(RecordError, match=words) as caught:
        read(write, text.replace(old, new, 1))
    assert line is None or caught.value.line == line


@pytest.mark.parametrize(
    ("count", "words"),
    [(999999999, "999999999 or more numbers"), (1, "1 samples announced"), (0, "0 samples")],
)
def test_absurd_numbers_of_samples_are_refused(write, count, words):
    with pytest.raises(RecordError, match=words) as caught:
        read(write, cosmos_block("acceleration", NORTH, count=count))
    assert caught.value.line == 48


@pytest.mark.parametrize(
    ("reported", "field"),
    [("*", "*" * 10), ("nan", "NaN".rjust(10)), ("", " " * 10), ("_", "1_0".rjust(10))],
)
def test_a_field_that_is_no_number_is_refused_at_its_line(write, reported, field):
    lines = cosmos_block("acceleration", NORTH).split("\n")
    assert lines[47].strip().startswith(f"{COUNT} acceleration")
    lines[50] = lines[50][:20] + field + lines[50][30:]
    with pytest.raises(RecordError, match="expected a number") as caught:
        read(write, "\n".join(lines))
    assert caught.value.line == 51
    assert reported.strip("_") in caught.value.found.lower()


def test_d_exponents(write):
    text = cosmos_block("acceleration", NORTH, layout="1E15.6", form="{:15.6E}")
    head, body = text.split("(1E15.6)\n")
    expect(read(write, head + "(1E15.6)\n" + body.replace("E+", "D+").replace("E-", "D-")))


@pytest.mark.parametrize("cut", [1, 5, 11, 300])
def test_a_file_that_was_cut_short_is_refused(write, cut):
    text = cosmos_block("acceleration", NORTH)
    text = text[: text.index("End-of-data")].rstrip("\n")
    with pytest.raises(RecordError, match=r"end of the file|characters"):
        read(write, text[:-cut])
