"""Result of a check by a code: numbers with their formulas and clauses, verdicts, and its page."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from html import escape
from os import PathLike
from pathlib import Path
from typing import Final, cast

from rockframe.arguments import checked_name, is_iterable
from rockframe.errors import ComponentError, short_repr
from rockframe.notebook import html_summary, number_with_unit
from rockframe.reports import page
from rockframe.reports.page import FILE_KIND
from rockframe.suggestions import suggests_names
from rockframe.units import Unit
from rockframe.units.display import (
    DisplayUnits,
    UnitsLike,
    display_units,
    unit_suffix,
    with_superscripts,
)
from rockframe.writing import write_file

_OUTCOMES: Final = {True: ("satisfied", "good"), False: ("not satisfied", "bad")}


@suggests_names
@dataclass(frozen=True)
class CheckedLine:
    """A number of a check.

    Parameters
    ----------
    symbol : str
        Symbol in the clause.
    value : float
        Value in the unit.
    unit : Unit
        SI unit.
    words : str
        Meaning and formula.
    source : str
        Clause and number of the formula, or another source.

    Examples
    --------
    >>> from rockframe.units import Unit
    >>> CheckedLine("M*", 1850.0, Unit.KILOGRAM, "participating mass", "(C8.7.1.4)").written()
    '1.85 t'
    """

    symbol: str
    value: float
    unit: Unit
    words: str
    source: str

    def written(self, units: DisplayUnits | None = None) -> str:
        """Return the number with its unit.

        Parameters
        ----------
        units : DisplayUnits, optional
            Units of a report; SI unless given.

        Returns
        -------
        str
        """
        chosen = None if units is None else units.chosen.get(str(self.unit))
        if chosen is not None:  # no other prefix of the unit
            return f"{self.value / chosen.size:.6g}{unit_suffix(chosen.words)}"
        return number_with_unit(self.value, "" if self.unit is Unit.ONE else str(self.unit))


@suggests_names
@dataclass(frozen=True)
class CheckedVerdict:
    """A verdict of a check.

    Parameters
    ----------
    title : str
        Name of the check.
    passed : bool
        Whether it is satisfied.
    words : str
        Demand and capacity.
    source : str
        Clause.

    Examples
    --------
    >>> CheckedVerdict("Damage", True, "0.03 m is below 0.05 m", "C8.7.1.2").passed
    True
    """

    title: str
    passed: bool
    words: str
    source: str


@suggests_names
@dataclass(frozen=True)
class CodeCheck:
    """A check by a code of practice.

    Parameters
    ----------
    title : str
        Title of its page.
    code : str
        The code, with its year.
    lines : mapping of str to tuple of CheckedLine
        The numbers, by the sections of the check.
    verdicts : tuple of CheckedVerdict
        The verdicts.
    notes : tuple of str
        What the check neglects.
    scene : str
        What was checked, in one line.

    Examples
    --------
    >>> import tempfile
    >>> import rockframe as rf
    >>> cabinet = rf.Block(width="0.6 m", height="1.8 m", mass="300 kg")
    >>> check = rf.codes.asce_7_22(cabinet, spectral_acceleration=1.0, importance=1.5)
    >>> check.value("S_DS"), check.passed["tipping"]
    (1.0, False)
    >>> check.report(f"{tempfile.mkdtemp()}/check.html").name
    'check.html'
    """

    title: str
    code: str
    lines: Mapping[str, tuple[CheckedLine, ...]]
    verdicts: tuple[CheckedVerdict, ...]
    notes: tuple[str, ...] = field(default=())
    scene: str = ""

    def value(self, symbol: str) -> float:
        """Return a number by its symbol.

        Parameters
        ----------
        symbol : str
            As in the clause.

        Returns
        -------
        float
            In its SI unit.

        Raises
        ------
        ComponentError
            No number has this symbol.
        """
        numbers = {line.symbol: line.value for several in self.lines.values() for line in several}
        return numbers[checked_name(symbol, numbers, owner="CodeCheck.value", name="symbol")]

    @property
    def passed(self) -> dict[str, bool]:
        """Whether each check is satisfied, by its title."""
        return {verdict.title: verdict.passed for verdict in self.verdicts}

    def __str__(self) -> str:
        text = [f"{self.title} ({self.code})"]
        for title, several in self.lines.items():
            text.append(f"{title}:")
            wide = max(len(line.symbol) for line in several)
            text += [
                f"  {line.symbol:<{wide}}  {line.written():<16}  {line.words} [{line.source}]"
                for line in several
            ]
        text += [
            f"{verdict.title}: {_OUTCOMES[verdict.passed][0]}; {verdict.words} [{verdict.source}]"
            for verdict in self.verdicts
        ]
        return "\n".join([*text, *(f"Left out: {note}" for note in self.notes)])

    def _repr_html_(self) -> str:
        rows = {
            verdict.title: f"{_OUTCOMES[verdict.passed][0]}; {verdict.words}"
            for verdict in self.verdicts
        }
        return html_summary(escape(self.title), rows)

    def report(
        self, path: "str | PathLike[str]", *, units: UnitsLike = None, overwrite: bool = False
    ) -> Path:
        """Write the check as one HTML page that needs no other file.

        Parameters
        ----------
        path : str or path
            The file; its name ends in ``.html``. An existing report is replaced.
        units : mapping of str to str, optional
            Units by quantity, as for :func:`rockframe.report`.
        overwrite : bool, optional
            Whether to replace an existing file that is not a report.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        FileError
            The file cannot be written, its name has another ending, or it exists and is not a
            report.
        ComponentError, UnitsError
            Units that cannot be read, or are of another kind.
        """
        chosen = display_units(units, owner="CodeCheck.report")
        body = [f"<h1>{escape(self.title)}</h1>", page.paragraph(self.code, kind="soft")]
        body += [*_scene_paragraph(self, chosen), *verdict_banners(self, chosen)]
        body += [page.section(title, [piece]) for title, piece in _tables(self, chosen)]
        content = page.html_page(self.title, body)
        return write_file(path, FILE_KIND, content, overwrite=overwrite)


def verdict_banners(check: CodeCheck, units: DisplayUnits) -> Iterator[str]:
    """Return each verdict with demand, capacity and clause."""
    for verdict in check.verdicts:
        text, kind = _OUTCOMES[verdict.passed]
        words = f"{units.convert_text(verdict.words)} [{verdict.source}]. {check.code}."
        yield page.banner(f"{verdict.title}: {text}", words, kind)


def check_section(check: CodeCheck, units: DisplayUnits) -> str:
    """Return the section on a check of a larger page."""
    pieces = [page.paragraph(f"{check.title}. {check.code}."), *_scene_paragraph(check, units)]
    for title, piece in _tables(check, units):
        pieces += [page.subtitle(title), piece]
    return page.section(f"Check by {check.code.split(',')[0]}", pieces)


def _scene_paragraph(check: CodeCheck, units: DisplayUnits) -> list[str]:
    words = units.convert_text(check.scene)
    return [page.paragraph(f"Checked: {words}.")] if words else []


def _tables(check: CodeCheck, units: DisplayUnits) -> Iterator[tuple[str, str]]:
    """Return titles and tables of the numbers, and of what is neglected."""
    for title, several in check.lines.items():
        cells = [
            (
                line.symbol,
                with_superscripts(line.written(units)),
                units.convert_text(line.words),
                line.source,
            )
            for line in several
        ]
        yield title, page.parameter_table(cells, head=("", "value", "", "source"))
    if check.notes:
        yield "Left out", page.numbered_list(map(units.convert_text, check.notes))


def read_checks(value: object, owner: str) -> list[CodeCheck]:
    """Read a check, or several."""
    several = [value] if isinstance(value, CodeCheck) else value
    if several is None:
        return []
    expected, checks = "one or a list of them", [several]
    if is_iterable(several) and not isinstance(several, str):
        expected, checks = "such as circolare_2019", list(several)
    for check in checks:
        if not isinstance(check, CodeCheck):
            msg = f"{owner}: checks must be of rf.codes, {expected}, got {short_repr(check)}"
            raise ComponentError(msg)
    return cast("list[CodeCheck]", checks)
