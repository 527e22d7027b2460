"""What a check by a code gives: numbers with their formulas and clauses, and verdicts."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from html import escape
from os import PathLike
from pathlib import Path
from typing import Any, Final, cast

from rockframe.arguments import one_of_names
from rockframe.errors import ComponentError, shown
from rockframe.measures.common import check_some
from rockframe.motion import GroundMotion
from rockframe.notebook import card, number_with_unit
from rockframe.proposals import proposing
from rockframe.reports import page
from rockframe.simulation.system import System
from rockframe.system.rigid_ground import RigidGroundSetting
from rockframe.units import QuantityLike, Unit
from rockframe.writing import FileKind, generator, write_file

_KIND: Final = FileKind.marked("a report", (".html", ".htm"), generator("report"))
_SAID: Final = {True: ("satisfied", "good"), False: ("not satisfied", "bad")}


@proposing
@dataclass(frozen=True)
class CheckedLine:
    """A number of a check.

    Parameters
    ----------
    symbol : str
        What it is called in the clause.
    value : float
        In the unit.
    unit : Unit
        SI.
    words : str
        What it is, and its formula.
    source : str
        Clause and number of the formula; or where else it is from.
    """

    symbol: str
    value: float
    unit: Unit
    words: str
    source: str

    def written(self) -> str:
        """Give the number with its unit.

        Returns
        -------
        str
        """
        unit = "" if self.unit is Unit.ONE else str(self.unit)
        return number_with_unit(self.value, unit)


@proposing
@dataclass(frozen=True)
class CheckedVerdict:
    """What a check says.

    Parameters
    ----------
    title : str
        What is checked.
    passed : bool
        Whether it is satisfied.
    words : str
        Demand and capacity.
    source : str
        Clause.
    """

    title: str
    passed: bool
    words: str
    source: str


@proposing
@dataclass(frozen=True)
class CodeCheck:
    """A check by a code of practice.

    Parameters
    ----------
    title : str
        Of its page.
    code : str
        The code, with its year.
    lines : mapping of str to tuple of CheckedLine
        The numbers, by the sections of the check.
    verdicts : tuple of CheckedVerdict
        What follows.
    notes : tuple of str
        What the check leaves out.
    """

    title: str
    code: str
    lines: Mapping[str, tuple[CheckedLine, ...]]
    verdicts: tuple[CheckedVerdict, ...]
    notes: tuple[str, ...] = field(default=())

    def value(self, symbol: str) -> float:
        """Give a number by its symbol.

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
            No number has that symbol.
        """
        found = {one.symbol: one.value for several in self.lines.values() for one in several}
        return found[one_of_names(symbol, found, owner="CodeCheck.value", name="symbol")]

    @property
    def passed(self) -> dict[str, bool]:
        """Whether each check is satisfied, by its title."""
        return {one.title: one.passed for one in self.verdicts}

    def __str__(self) -> str:
        text = [f"{self.title} ({self.code})"]
        for title, several in self.lines.items():
            text.append(f"{title}:")
            wide = max(len(one.symbol) for one in several)
            text += [
                f"  {one.symbol:<{wide}}  {one.written():<16}  {one.words} [{one.source}]"
                for one in several
            ]
        text += [
            f"{one.title}: {_SAID[one.passed][0]}; {one.words} [{one.source}]"
            for one in self.verdicts
        ]
        return "\n".join([*text, *(f"Left out: {one}" for one in self.notes)])

    def _repr_html_(self) -> str:
        rows = {one.title: f"{_SAID[one.passed][0]}; {one.words}" for one in self.verdicts}
        return card(escape(self.title), rows)

    def report(self, path: "str | PathLike[str]", *, overwrite: bool = False) -> Path:
        """Write the check as one HTML page that needs no other file.

        Parameters
        ----------
        path : str or path
            Of the file; its name ends in ``.html``. A report that is there is replaced.
        overwrite : bool, optional
            Whether a file that is there is replaced though it is no report.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        FileError
            The file cannot be written, its name has another ending, or it is there already and
            no report.
        """
        body = [f"<h1>{escape(self.title)}</h1>", page.paragraph(self.code, kind="soft")]
        for one in self.verdicts:
            said, kind = _SAID[one.passed]
            body.append(page.banner(f"{one.title}: {said}", f"{one.words} [{one.source}]", kind))
        head = ("", "value", "", "source")
        body += [
            page.section(title, [page.rows([_cells(one) for one in several], head=head)])
            for title, several in self.lines.items()
        ]
        if self.notes:
            body.append(page.section("Left out", [page.items(self.notes)]))
        content = page.page(self.title, body).encode()
        return write_file(path, _KIND, content, overwrite=overwrite)


def _cells(one: CheckedLine) -> tuple[str, str, str, str]:
    return one.symbol, one.written(), one.words, one.source


def rocking_block(system: object, owner: str) -> RigidGroundSetting:
    """Give the setting of a block that rocks on rigid ground; refuse all else."""
    if not isinstance(system, System):
        msg = f"{owner}: system needs a System, got {shown(system)}"
        raise ComponentError(msg)
    setting = system.setting
    level = system.options.slope.level
    if not isinstance(setting, RigidGroundSetting) or system.parts.block is None or not level:
        msg = f"{owner}: the check is of a block on level rigid ground, got {setting.model}"
        raise ComponentError(msg)
    return setting


def read_motions(given: object, owner: str) -> dict[str, GroundMotion]:
    """Take a motion, or several by their labels."""
    several = {given.name: given} if isinstance(given, GroundMotion) else given
    if not isinstance(several, Mapping):
        msg = f"{owner}: expected a GroundMotion or several by their labels, got {shown(given)}"
        raise ComponentError(msg)
    motions = cast("Mapping[str, GroundMotion]", several)
    check_some(motions, owner=owner)
    for label, motion in motions.items():
        if not isinstance(cast("Any", motion), GroundMotion):
            msg = f"{owner}: {label!r} needs a GroundMotion, got {shown(motion)}"
            raise ComponentError(msg)
    return {str(label): motion for label, motion in motions.items()}


def peaks_of(
    system: System, motions: Mapping[str, GroundMotion], free_vibration: QuantityLike
) -> dict[str, tuple[float, bool]]:
    """Give the peak rotation under each motion, and whether it overturned."""
    found: dict[str, tuple[float, bool]] = {}
    for label, motion in motions.items():
        run = system.simulate(motion, outputs=None, free_vibration=free_vibration)
        found[label] = float(run.peak_rotation), bool(run.overturned)
    return found
