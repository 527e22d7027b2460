"""The AT2 reader: every dialect, and every error with its line number."""

import numpy as np
import pytest
from unit.motion.motion_files import EVENT, TITLE, UNIT, G, at2, numbers, rows

from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion

COUNT = 23  # a short last line
VALUES = numbers(COUNT)

DIALECTS = {
    "West1": f"{COUNT}    0.0050    NPTS, DT",
    "SMD": f"NPTS=  {COUNT}, DT= .00500 SEC",
    "West2": f"NPTS=     {COUNT}, DT=   .0050 SEC,                                   ",
    "West2 blanks": f"NPTS=  {COUNT}, DT=   0.005 SEC     ",
    "East": f"NPTS=  {COUNT}, DT=    0.005 SEC",
    "lower case": f"npts= {COUNT}, dt= .005 sec",
    "mixed case": f"NPTS= {COUNT}, dt= .005 SEC",
    "tight": f"NPTS={COUNT},DT=.005",
    "exponent": f"NPTS= {COUNT}, DT= 5.0E-03 SEC",
    "D exponent": f"NPTS= {COUNT}, DT= .5D-02 SEC",
}


def expect(motion, values=VALUES, time_step=0.005):
    assert motion.si.time_step == time_step
    assert motion.si.horizontal.samples.tolist() == (np.asarray(values) * G).tolist()


@pytest.mark.parametrize("dialect", DIALECTS)
def test_points_line(write, dialect):
    motion = GroundMotion.read(write(at2(DIALECTS[dialect], VALUES)))
    expect(motion)
    assert motion.metadata["format"] == "peer-at2"
    assert motion.metadata["component"] == "67"
    assert motion.metadata["event"] == "Made Up"
    assert motion.metadata["date"] == "10/18/1989"


def test_text_quoting_points_line_is_not_recognised(write):
    text = "# Records\n\n| TCU128.AT2 | (`NPTS= 18000, DT= .00500 SEC`) | 0.17 g |\n"
    with pytest.raises(RecordError, match="which no format recognises"):
        GroundMotion.read(write(text, "INDEX.md"), unit="g")


@pytest.mark.parametrize("step", ["10/2000", "5.25 MSEC", "5.0E-0 ms"])
def test_time_step_in_other_notation_is_refused(write, step):
    text = at2(f"NPTS= {COUNT}, DT= {step}", VALUES)
    with pytest.raises(RecordError, match="NPTS= <count>, DT= <seconds> SEC"):
        GroundMotion.read(write(text))


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_line_ends_and_byte_order_mark(write, end, mark):
    text = at2(DIALECTS["West2"], VALUES, end=end)
    expect(GroundMotion.read(write(mark + text.encode())))


def test_blank_lines_in_the_header(write):
    text = "\n".join([TITLE, "", EVENT, "", UNIT, "", DIALECTS["SMD"], "", rows(VALUES)])
    motion = GroundMotion.read(write(text))
    expect(motion)
    assert motion.metadata["event"] == "Made Up"


def test_no_line_end_after_the_last_number(write):
    expect(GroundMotion.read(write(at2(DIALECTS["SMD"], VALUES).rstrip())))


def test_control_z_at_the_end(write):
    expect(GroundMotion.read(write(at2(DIALECTS["SMD"], VALUES) + "\x1a")))


def test_d_exponents(write):
    text = at2(DIALECTS["SMD"], VALUES)
    head, body = text[: text.index("SEC") + 3], text[text.index("SEC") + 3 :]
    expect(GroundMotion.read(write(head + body.replace("E", "D"))))


def test_numbers_run_together_in_fixed_width(write):
    values = np.array([-0.1e-2, -0.2e-2, -0.3e-2, 0.4e-2, -0.5e-2])
    text = "\n".join([TITLE, EVENT, UNIT, "NPTS= 5, DT= .005 SEC", "-.1E-02-.2E-02-.3E-02"])
    expect(GroundMotion.read(write(text + "\n .4E-02-.5E-02\n")), values)


def test_numbers_run_together_without_exponents(write):
    text = "\n".join([TITLE, EVENT, UNIT, "NPTS= 3, DT= .005 SEC", "-0.10000-0.20000-0.30000\n"])
    expect(GroundMotion.read(write(text)), [-0.1, -0.2, -0.3])


@pytest.mark.parametrize(
    "adjoining",
    ["123.45678123.45678", "1.0E-021.0E-02", "0.1234567-103", "1-2.5", "-.1E-02--.2E-02"],
)
def test_ambiguous_adjoining_numbers_are_refused(write, adjoining):
    text = "\n".join([TITLE, EVENT, UNIT, "NPTS= 3, DT= .005 SEC", "0.1 0.1", adjoining + "\n"])
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(write(text))
    assert caught.value.line == 6
    assert adjoining in str(caught.value)


def test_eight_columns_and_a_unit_in_parentheses(write):
    header = [
        "Data for a made-up earthquake",
        "23 points at equal spacing of 0.02 sec, listed as 8F10.5, i.e., 8 points across",
        "The units are (g)",
        "NPTS=  23, DT= .02000 SEC",
    ]
    values = np.round(VALUES, 5)
    text = "\n".join(header) + "\n" + rows(values, 8, "{:10.5f}")
    motion = GroundMotion.read(write(text))
    expect(motion, values, 0.02)
    assert motion.metadata["unit_as_read"] == "g"


@pytest.mark.parametrize(
    ("spelling", "factor"),
    [
        *(("G", G), ("G. FILTER POINTS: HP=0.05 Hz", G), ("G / 10", 0.1 * G)),
        *((spelling, 0.01) for spelling in ("CM/S/S", "CM/SEC2", "CM / S / S")),
    ],
)
def test_unit_of_the_header(write, spelling, factor):
    scale = 100.0 if factor == 0.01 else 1.0
    text = at2(
        DIALECTS["SMD"], VALUES * scale, unit=f"ACCELERATION TIME HISTORY IN UNITS OF {spelling}"
    )
    motion = GroundMotion.read(write(text))
    read = [float(f"{value:.7E}") * factor for value in VALUES * scale]
    assert motion.si.horizontal.samples == pytest.approx(read, rel=1e-15)


def test_other_argument_unit_is_used_and_warned_about(write):
    path = write(at2(DIALECTS["SMD"], VALUES))
    with pytest.warns(RecordWarning, match=r"line 3.*'G'.*'m/s\^2'"):
        motion = GroundMotion.read(path, unit="m/s^2")
    assert motion.si.horizontal.samples.tolist() == VALUES.tolist()


def test_same_argument_unit_is_no_contradiction(write):
    expect(GroundMotion.read(write(at2(DIALECTS["SMD"], VALUES)), unit="g_0"))


@pytest.mark.parametrize(("declared", "counted"), [(COUNT + 2, COUNT), (COUNT - 4, COUNT)])
def test_points_that_disagree_a_little_are_warned_about(write, declared, counted):
    path = write(at2(f"NPTS= {declared}, DT= .005 SEC", VALUES))
    with pytest.warns(RecordWarning, match=f"line 4.*{declared}.*{counted}"):
        motion = GroundMotion.read(path)
    assert len(motion) == counted
    assert motion.metadata["declared_samples"] == declared
    assert motion.metadata["counted_samples"] == counted


def test_points_that_agree_are_not_in_the_metadata(write):
    motion = GroundMotion.read(write(at2(DIALECTS["SMD"], VALUES)))
    assert "declared_samples" not in motion.metadata


def test_a_truncated_file_is_refused_at_its_last_line(write):
    path = write(at2("NPTS= 60, DT= .005 SEC", VALUES))
    with pytest.raises(RecordError, match="after 23 samples; expected 60 samples") as caught:
        GroundMotion.read(path)
    assert caught.value.line == 9


def test_an_absurd_number_of_points_is_not_allocated(write):
    with pytest.raises(RecordError, match="999999999999999"):
        GroundMotion.read(write(at2("NPTS= 999999999999999, DT= .005 SEC", VALUES)))


REFUSED = {
    "no points line": ("NOTHING OF THAT KIND", 1, "NPTS"),
    "zero points": ("NPTS= 0, DT= .005 SEC", 4, "above zero"),
    "negative points": ("NPTS= -23, DT= .005 SEC", 4, "above zero"),
    "fraction of points": ("NPTS= 2.5, DT= .005 SEC", 4, "above zero"),
    "no time step": ("NPTS= 23", 4, "DT="),
    "zero time step": ("NPTS= 23, DT= .000 SEC", 4, "time step of 0.0 s"),
    "negative time step": ("NPTS= 23, DT= -.005 SEC", 4, "time step of -0.005 s"),
    "absurd time step": ("NPTS= 23, DT= 5000 SEC", 4, "time step of 5000.0 s"),
    "infinite time step": ("NPTS= 23, DT= 1E999 SEC", 4, "time step of inf s"),
    "words for numbers": ("NPTS= many, DT= .005 SEC", 4, "many"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_points_lines_that_are_refused(write, case):
    points_line, line, words = REFUSED[case]
    path = write(at2(points_line, VALUES))
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(path)
    assert caught.value.line == line
    assert words in str(caught.value)
    assert f"{path}, line {line}: found" in str(caught.value)
    assert "expected" in str(caught.value)


@pytest.mark.parametrize(
    "field", ["abc", "NaN", "inf", "-Infinity", "1.0e999", "*******", "1_0", "0x10", "1,5", "٣"]
)
def test_a_field_that_is_no_finite_number(write, field):
    lines = at2(DIALECTS["SMD"], VALUES).split("\n")
    lines[6] = lines[6].replace(lines[6].split()[2], field)
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(write("\n".join(lines)))
    assert caught.value.line == 7
    assert field in caught.value.found
    assert "number" in caught.value.expected


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("r.VT2", "VELOCITY TIME SERIES IN UNITS OF CM/S"),
        ("r.DT2", "DISPLACEMENT TIME SERIES IN UNITS OF CM"),
        ("r.AT2", "TIME SERIES IN UNITS OF CM/S"),
        ("r.AT2", "TIME SERIES IN UNITS OF CM"),
    ],
)
@pytest.mark.parametrize("argument", [None, "g"])
def test_velocities_and_displacements_are_refused(write, name, unit, argument):
    path = write(at2(DIALECTS["SMD"], VALUES, unit=unit), name)
    with pytest.raises(RecordError, match=r"(velocity|displacement).*acceleration") as caught:
        GroundMotion.read(path, unit=argument)
    assert caught.value.line == 3


def test_unknown_unit(write):
    path = write(at2(DIALECTS["SMD"], VALUES, unit="ACCELERATION IN UNITS OF FURLONGS"))
    with pytest.raises(RecordError, match="unknown unit 'FURLONGS'") as caught:
        GroundMotion.read(path)
    assert caught.value.line == 3
    expect(GroundMotion.read(path, unit="g"))


def test_no_unit(write):
    path = write(at2(DIALECTS["SMD"], VALUES, unit="ACCELERATION TIME HISTORY"))
    with pytest.raises(RecordError, match=r"no unit.*unit='g'"):
        GroundMotion.read(path)


def test_component_of_file_without_component_name_is_refused(write):
    path = write(at2(DIALECTS["SMD"], VALUES, title="MADE UP", event="NOTHING TO SAY"))
    with pytest.raises(RecordError, match="no name of the component; expected the component '67'"):
        GroundMotion.read(path, component="67")


def test_time_step_argument_must_agree(write):
    path = write(at2(DIALECTS["SMD"], VALUES))
    expect(GroundMotion.read(path, time_step="5 ms"))
    with pytest.raises(RecordError, match=r"time step of 0\.005 s; expected the 0\.01 s"):
        GroundMotion.read(path, time_step="0.01 s")


def test_accelerations_that_overflow(write):
    text = "\n".join([TITLE, EVENT, UNIT, "NPTS= 2, DT= .005 SEC", "1.0E308 1.0E308\n"])
    with pytest.raises(RecordError, match="overflow"):
        GroundMotion.read(write(text))


@pytest.mark.parametrize(
    ("scale", "time_step", "words"),
    [
        (1e-4, ".005", "peak acceleration is 2.*unit g_0 right"),
        (100.0, ".005", "peak acceleration is 20"),
        (0.0, ".005", "peak acceleration is 0 g"),
        (1.0, ".00001", "time step is 1e-05 s"),
        (1.0, ".5", "time step is 0.5 s"),
    ],
)
def test_implausible_peak_or_time_step_warns(write, scale, time_step, words):
    path = write(at2(f"NPTS= {COUNT}, DT= {time_step} SEC", VALUES * scale))
    with pytest.warns(RecordWarning, match=words) as caught:
        GroundMotion.read(path)
    assert len(caught) == 1
    assert caught[0].filename == __file__


@pytest.mark.parametrize(("end", "sense"), [("-UP", "up"), ("_dwn", "down"), ("-VERT", "vertical")])
def test_vertical_component_is_recognised_from_file_name(write, end, sense):
    path = write(at2("NPTS= 50, DT= .01", numbers(50), event="Made Up"), f"RSN6_MADE_S6{end}.AT2")
    with pytest.warns(RecordWarning, match="is vertical"):
        assert GroundMotion.read(path).metadata["positive"] == sense
