"""Numbers in text: free format, fixed width, and long files read in pieces."""

import numpy as np
import pytest
from unit.motion.motion_files import at2, rows

from rockframe.errors import RecordError
from rockframe.motion import GroundMotion
from rockframe.records import numbers
from rockframe.records.numbers import FixedWidth, free_format
from rockframe.records.reader import source_of

# negative numbers fill their width, so that no blank separates them
FULL = -np.round(np.linspace(0.11, 0.99, 83) * 10.0 ** np.tile([-1, -4, -9], 28)[:83], 11)
FORMS = {"exponent": "{:13.6E}", "D exponent": "{:13.6E}", "no exponent": "{:9.6f}"}


def text(form: str, per_line: int) -> str:
    written = rows(FULL, per_line, FORMS[form])
    return written.replace("E", "D") if form == "D exponent" else written


def printed(form: str) -> list[float]:
    return [float(FORMS[form].format(value)) for value in FULL]


def source(content: str):
    return source_of("r.txt", content.encode())


@pytest.mark.parametrize("per_line", [1, 5, 8])
@pytest.mark.parametrize("form", FORMS)
class TestNumbersThatTouch:
    def test_in_free_format(self, form, per_line):
        assert free_format(source(text(form, per_line)), 0).tolist() == printed(form)

    @pytest.mark.parametrize("at_once", [1, 30, 100])
    def test_in_pieces_of_a_long_file(self, form, per_line, at_once, monkeypatch):
        monkeypatch.setattr(numbers, "_CHUNK", at_once)
        assert free_format(source(text(form, per_line)), 0).tolist() == printed(form)

    def test_in_fixed_width(self, form, per_line):
        width = len(FORMS[form].format(-0.1))
        content = source(text(form, per_line))
        numbers = FixedWidth(width, per_line).read(content, 0, FULL.size)
        assert numbers.tolist() == printed(form)

    @pytest.mark.filterwarnings("ignore::rockframe.errors.RecordWarning")
    def test_of_an_at2_file(self, form, per_line, tmp_path):
        path = tmp_path / "r.AT2"
        body = at2(f"NPTS= {FULL.size}, DT= .01", FULL, per_line=per_line, form=FORMS[form])
        path.write_text(body.replace("E-", "D-") if form == "D exponent" else body)
        samples = GroundMotion.read(path).si.horizontal.samples
        assert samples.tolist() == (np.array(printed(form)) * 9.80665).tolist()


def test_fixed_width_numbers_need_no_separator():
    values = np.array([12.3456, 98.7654, 0.0001, 55.5555, 10.0])
    content = source(
        "head\n" + "".join(f"--{row}" for row in rows(values, 2, "{:7.4f}").splitlines(True))
    )
    assert FixedWidth(7, 2, indent=2).read(content, 1, 5).tolist() == values.tolist()
    with pytest.raises(RecordError, match="14: 2 numbers of 7 characters"):
        FixedWidth(7, 2).read(source("12.345698.7654\n12.34569.7654\n1.0\n"), 0, 5)


@pytest.mark.parametrize("last", ["5", ".5"])
def test_line_end_separates_numbers(last):
    """Even if the joined text would be a number: 23, and 4E-15."""
    numbers = free_format(source(f"1.5 2\n3 4E-1\n\n{last}\n"), 0).tolist()
    assert numbers == [1.5, 2.0, 3.0, 0.4, float(last)]
