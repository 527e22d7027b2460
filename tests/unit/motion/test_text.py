"""Text of one or two columns: separators, headers, units, uneven times."""

import numpy as np
import pytest
from unit.motion.motion_files import G, numbers

from rockframe.errors import ComponentError, RecordError, RecordWarning, UnitsError
from rockframe.motion import GroundMotion

COUNT = 40
VALUES = numbers(COUNT)
STEP = 0.005


def table(separator=",", header="", decimal=".", values=VALUES, step=STEP, form="{:.3f}"):
    lines = [
        f"{form.format(k * step)}{separator}{value:.7f}".replace(".", decimal)
        for k, value in enumerate(values)
    ]
    return header + "\n".join(lines) + "\n"


def expect(motion, factor=G, values=VALUES, step=STEP):
    assert motion.si.time_step == step
    assert motion.si.horizontal.samples.tolist() == (np.asarray(values) * factor).tolist()


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", "  ", ", ", " ; ", ",\t"])
@pytest.mark.parametrize("header", ["", "time (s), acceleration (g)\n", "# made up\n% by hand\n\n"])
def test_two_columns(write, separator, header):
    expect(GroundMotion.read(write(table(separator, header), "r.csv"), unit="g"))


@pytest.mark.parametrize("separator", [";", "\t", "  "])
def test_unambiguous_decimal_commas_are_read(write, separator):
    path = write(table(separator, decimal=","), "r.csv")
    expect(GroundMotion.read(path, unit="g"))


def test_decimal_commas_in_one_column_of_a_semicolon_file(write):
    text = "".join(f"{value:.7f};\n".replace(".", ",") for value in VALUES)
    expect(GroundMotion.read(write(text, "r.csv"), unit="g", time_step="0.005 s"))


@pytest.mark.parametrize("arguments", [{}, {"time_step": "0.005 s"}])
def test_ambiguous_decimal_commas_are_refused(write, arguments):
    text = "".join(f"{value:.7f}\n".replace(".", ",") for value in VALUES)
    with pytest.raises(RecordError, match="comma may be a decimal sign or a separator") as caught:
        GroundMotion.read(write(text, "r.csv"), unit="g", **arguments)
    assert caught.value.line == 1


def test_comma_between_decimal_commas_is_refused(write):
    with pytest.raises(RecordError, match="comma may be a decimal sign"):
        GroundMotion.read(write(table(",", decimal=","), "r.csv"), unit="g")


def test_two_decimal_signs_are_refused(write):
    lines = table(";", decimal=",").split("\n")
    lines[7] = lines[7].replace(",", ".")
    with pytest.raises(RecordError, match="a point in line 8; expected one decimal sign"):
        GroundMotion.read(write("\n".join(lines), "r.csv"), unit="g")


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_line_ends_and_byte_order_mark(write, mark, end):
    text = table(header="time (s), acceleration (g)\n").replace("\n", end)
    expect(GroundMotion.read(write(mark + text.encode(), "r.csv")))


@pytest.mark.parametrize(
    ("header", "factor"),
    [
        ("time (s),acceleration (g)\n", G),
        ("Time [s],Acceleration [cm/s^2]\n", 0.01),
        ("t [s],a [m/s²]\n", 1.0),
        ("t (sec),a (CM/SEC**2)\n", 0.01),
        ("time,acceleration\ns,gal\n", 0.01),
        ("# units: mm/s/s\n", 0.001),
        ("# Units = Gal\ntime,acceleration\n", 0.01),
        ("# acceleration in units of g.\n", G),
        ("# made up (CWB), 1999\n# t (s), a (m s-2)\n", 1.0),
        ("time (s),mg\n# units: mg\n", 1e-3 * G),
    ],
)
def test_unit_of_the_header(write, header, factor):
    scale = 1.0 if factor == G else np.round(5.0 / factor)
    values = np.round(VALUES * scale, 7)
    motion = GroundMotion.read(write(table(header=header, values=values), "r.csv"))
    expect(motion, factor, values)


def test_no_unit_anywhere(write):
    with pytest.raises(RecordError, match=r"no unit of the samples.*unit='g'"):
        GroundMotion.read(write(table(header="time, acceleration\n"), "r.csv"))


def test_unknown_unit_of_the_header(write):
    path = write(table(header="# made up\ntime [s],acceleration [V]\n"), "r.csv")
    with pytest.raises(RecordError, match="unknown unit 'V'") as caught:
        GroundMotion.read(path)
    assert caught.value.line == 2
    expect(GroundMotion.read(path, unit="g"))


@pytest.mark.parametrize("unit", ["V", "counts", "mm/s^9"])
def test_unknown_unit_is_refused_despite_known_one_in_header(write, unit):
    path = write(table(header=f"# made from (gal)\ntime [s],acceleration [{unit}]\n"), "r.csv")
    with pytest.raises(RecordError, match="the unknown unit") as caught:
        GroundMotion.read(path)
    assert caught.value.line == 2
    expect(GroundMotion.read(path, unit="g"))
    for header in ("# units: g\ntime, acc (corrected)\n", "# units: V/g\ntime [s],acc [g]\n"):
        expect(GroundMotion.read(write(table(header=header), "r.csv")))


def test_two_units_of_the_header(write):
    path = write(table(header="# from (gal)\ntime [s],acceleration [g]\n"), "r.csv")
    with pytest.raises(RecordError, match=r"the units 'g' and 'gal' \(line 1\)") as caught:
        GroundMotion.read(path)
    assert caught.value.line == 2
    expect(GroundMotion.read(path, unit="g"))


def test_header_unit_and_other_argument(write):
    path = write(table(header="time [s],acceleration [m/s^2]\n"), "r.csv")
    with pytest.warns(RecordWarning, match=r"line 1.*'m/s\^2'.*'g'"):
        expect(GroundMotion.read(path, unit="g"))


@pytest.mark.parametrize("unit", ["kg", "cm/s", "nonsense", "", "5", "-1 m/s^2", "s", "degC"])
def test_argument_that_is_no_acceleration_unit(write, unit):
    with pytest.raises(UnitsError, match=r"unit needs the unit of an acceleration.*unit='g'"):
        GroundMotion.read(write(table(), "r.csv"), unit=unit)


@pytest.mark.parametrize(
    ("unit", "factor"),
    [
        *((unit, G) for unit in ("g", "G", "g_0")),
        *((unit, 0.01) for unit in ("gal", "Gal", "cm/s2", "cm/s/s", "CM/SEC2", "cm s**-2")),
        *((unit, 1.0) for unit in ("m/s2", "m s^-2", "meter/s^2")),
        *((unit, 0.001) for unit in ("mm/s^2", "mm/s²")),
        ("ft/s^2", 0.3048),
    ],
)
@pytest.mark.filterwarnings("ignore:.*peak acceleration")
def test_argument_units(write, unit, factor):
    expect(GroundMotion.read(write(table(), "r.csv"), unit=unit), factor)


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("time (s),velocity (cm/s)\n", "velocity"),
        ("time (s),x (cm/s)\n", "a velocity in cm/s"),
        ("time (s),displacement\n", "displacement"),
        ("acceleration (g),time (s)\n", "time first"),
        ("acc,t\n", "time first"),
        ("time (min),acceleration (g)\n", "'min' of the times"),
    ],
)
def test_columns_of_other_quantities_are_refused(write, header, words):
    with pytest.raises(RecordError, match=words) as caught:
        GroundMotion.read(write(table(header=header), "r.csv"), unit="g")
    assert caught.value.line == 1


@pytest.mark.parametrize(("unit", "words"), [("cm/s", "a velocity"), ("cm", "a displacement")])
def test_unit_in_comment_is_not_applied_to_other_quantity(write, unit, words):
    path = write(table(header=f"# peak of 0.3 (g)\ntime (s),x ({unit})\n"), "r.csv")
    with pytest.raises(RecordError, match=f"{words} in {unit}"):
        GroundMotion.read(path)


def test_times_in_milliseconds(write):
    path = write(table(header="time (ms),acceleration (g)\n", step=5.3, form="{:.1f}"), "r.csv")
    expect(GroundMotion.read(path), step=0.0053)


def test_one_column_needs_a_time_step(write):
    path = write("".join(f"{value:.7f}\n" for value in VALUES), "r.txt")
    with pytest.raises(RecordError, match=r"one column and no times.*time_step='0\.005 s'"):
        GroundMotion.read(path, unit="g")
    expect(GroundMotion.read(path, unit="g", time_step="5 ms"))


@pytest.mark.parametrize("step", ["0 s", "-0.01 s"])
def test_time_step_that_is_not_positive(write, step):
    path = write("0.1\n0.2\n", "r.txt")
    with pytest.raises(ComponentError, match="time_step must be greater than zero"):
        GroundMotion.read(path, unit="g", time_step=step)


def test_absurd_time_step(write):
    path = write("0.1\n0.2\n", "r.txt")
    with pytest.raises(RecordError, match=r"time step of 60\.0 s"):
        GroundMotion.read(path, unit="g", time_step="1 min")


def test_time_step_argument_must_agree_with_the_times(write):
    path = write(table(), "r.csv")
    with pytest.raises(RecordError, match=r"expected the 0\.01 s given by"):
        GroundMotion.read(path, unit="g", time_step="0.01 s")


def test_times_that_do_not_start_at_zero(write):
    lines = table().split("\n")[10:]
    motion = GroundMotion.read(write("\n".join(lines), "r.csv"), unit="g")
    expect(motion, values=VALUES[10:])
    assert motion.metadata["start_time"] == 0.05


@pytest.mark.parametrize(
    ("step", "form"),
    [
        (0.005, "{:.3f}"),
        (0.005, "{!r}"),
        (0.005, "{:.8E}"),
        (0.0025, "{:.6g}"),
        (1.0 / 128.0, "{:.4f}"),
        (1.0 / 64.0, "{:.3f}"),
        (1.0 / 200.0, "{:.17g}"),
        (0.01, "{:.2f}"),
        (0.02, "{:.2f}"),
        (0.1, "{:g}"),
    ],
)
@pytest.mark.parametrize("count", [50, 6000])
def test_rounded_times_are_even(write, step, form, count):
    values = np.tile(VALUES, count // COUNT + 1)[:count]
    motion = GroundMotion.read(write(table(values=values, step=step, form=form), "r.csv"), unit="g")
    digit = 1e-3 if form in {"{:.3f}", "{:.4f}", "{:.6g}"} else 1e-9
    assert motion.si.time_step == pytest.approx(step, abs=2.0 * digit / count, rel=1e-12)
    if step in {0.005, 0.01, 0.02, 0.1}:
        assert motion.si.time_step == step


def uneven(change):
    lines = table(header="# made up\n").split("\n")
    change(lines)
    return "\n".join(lines)


def _swap(lines):
    lines[21], lines[22] = lines[22], lines[21]


def _gap(lines):
    del lines[21]


def _double(lines):
    lines[21] = lines[20]


def _digit(lines):
    lines[21] = lines[21].replace("0.100,", "0.101,")


def _fine_jitter(lines):
    for k in range(1, len(lines) - 1):
        time, value = lines[k].split(",")
        lines[k] = f"{float(time) + (2e-8 if k == 21 else 0.0):.12f},{value}"


@pytest.mark.parametrize("change", [_swap, _gap, _double, _digit, _fine_jitter])
def test_uneven_times_are_refused_at_their_line(write, change):
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(write(uneven(change), "r.csv"), unit="g")
    assert caught.value.line == 22
    assert "uniform time step" in caught.value.expected
    assert "after" in caught.value.found


@pytest.mark.parametrize("step", [0.01, 1.0])
def test_a_missing_sample_is_not_taken_for_rounding(write, step):
    # the last printed digit equals the time step itself
    lines = table(step=step, form="{:.2f}" if step < 1.0 else "{:.0f}").split("\n")
    del lines[20]
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(write("\n".join(lines), "r.csv"), unit="g")
    assert caught.value.line == 21


def test_drifting_times_are_refused(write):
    text = "".join(
        f"{k * STEP * (1.0 + 1e-4 * k):.9f},{value:.7f}\n" for k, value in enumerate(VALUES)
    )
    with pytest.raises(RecordError, match="uniform time step"):
        GroundMotion.read(write(text, "r.csv"), unit="g")


@pytest.mark.parametrize(
    "field", ["abc", "NaN", "inf", "1e999", "***", "1_0", "", "1.0.0", "0x1p3", "٣"]
)
@pytest.mark.parametrize("row", [0, 5, COUNT - 1])
def test_a_field_that_is_no_finite_number_is_refused_at_its_line(write, field, row):
    lines = table().split("\n")
    lines[row] = lines[row].split(",")[0] + "," + field
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(write("\n".join(lines), "r.csv"), unit="g")
    # after an empty field in the first row, the second row is the exception
    assert caught.value.line in ({1, 2} if (field, row) == ("", 0) else {row + 1})


@pytest.mark.parametrize("field", ["nan", "***", "12.3x", "-inf", "1_0"])
def test_a_damaged_first_row_is_not_taken_for_a_header(write, field):
    lines = [field, *(f"{value:.7f}" for value in VALUES)]
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(write("\n".join(lines), "r.txt"), unit="g", time_step="0.01 s")
    assert caught.value.line == 1


def test_rows_of_different_length(write):
    lines = table().split("\n")
    lines[8] += ",7"
    with pytest.raises(RecordError, match=r"3 fields.*expected 2 fields, as in line 1") as caught:
        GroundMotion.read(write("\n".join(lines), "r.csv"), unit="g")
    assert caught.value.line == 9


def test_too_many_columns_are_refused(write):
    text = "".join(f"{k * STEP:.3f}" + ",0.1" * 12 + "\n" for k in range(COUNT))
    with pytest.raises(RecordError, match=r"13 columns; expected at most 12") as caught:
        GroundMotion.read(write(text, "r.csv"), unit="g")
    assert caught.value.line == 1


def test_text_after_numbers_is_refused(write):
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(write(table() + "the end\n", "r.csv"), unit="g")
    assert caught.value.line == COUNT + 1


def test_too_long_header_is_refused(write):
    text = "word\n" * 21 + table()
    with pytest.raises(RecordError, match="at most 20 header lines"):
        GroundMotion.read(write(text, "r.csv"), unit="g", format="text")


def test_single_row_is_refused(write):
    with pytest.raises(RecordError, match="at least two samples"):
        GroundMotion.read(write("0.0,0.1\n", "r.csv"), unit="g")


def test_cut_inside_the_last_number(write):
    with pytest.raises(RecordError, match="inside a number") as caught:
        GroundMotion.read(write(table().rstrip()[:-3], "r.csv"), unit="g")
    assert caught.value.line == COUNT


def test_component_of_file_without_component_name_is_refused(write):
    with pytest.raises(RecordError, match="no name of the component"):
        GroundMotion.read(write(table(), "r.csv"), unit="g", component="N")


def test_d_exponents(write):
    text = table().replace("\n", "D+00\n")
    expect(GroundMotion.read(write(text, "r.csv"), unit="g"))
