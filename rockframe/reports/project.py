"""The project of a report: its subject, author, conclusion and assumptions."""

import datetime
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, cast

import xarray as xr

from rockframe.arguments import json_attribute
from rockframe.errors import ComponentError, did_you_mean, short_repr
from rockframe.reports import page

PROJECT_ATTRIBUTE: Final = "project_json"
"""Attribute of a result in which the command line stores the project of a scene's file."""
ENTRIES: Final = {
    "object": "Object",
    "place": "Place",
    "number": "Number",
    "date": "Date",
    "author": "Author",
    "checked_by": "Checked by",
}
CONCLUSION: Final = "conclusion"
ASSUMPTIONS: Final = "assumptions"
CHECKS: Final = "checks"
"""Checks by codes for the command line to make, as typed with ``--check``."""


@dataclass(frozen=True)
class Project:
    """What a report says besides the results."""

    lines: tuple[tuple[str, str], ...] = ()
    conclusion: str = ""
    assumptions: tuple[str, ...] = ()
    checks: tuple[str, ...] = ()

    def block(self) -> Iterator[str]:
        """Return the lines at the head of a report."""
        if self.lines:
            yield f'<div class="sheet">{page.parameter_table(self.lines)}</div>'

    def conclusion_banner(self) -> Iterator[str]:
        """Return the conclusion, which precedes all verdicts."""
        if self.conclusion:
            yield page.banner("Conclusion", self.conclusion, "")

    def missing_checks_banner(self) -> Iterator[str]:
        """Mention requested checks in a report that has none."""
        if self.checks:
            words = "; pass checks=, or the motions to 'rockframe report'."
            yield page.banner("Not checked", f"Requested: {'; '.join(self.checks)}{words}", "doubt")


def project_of_result(value: object, dataset: xr.Dataset, owner: str) -> Project:
    """Read a project, or that of the result if none is given."""
    if value is None:
        value = json_attribute(dataset, PROJECT_ATTRIBUTE, dict, owner=owner, default="{}")
    return read_project(value, owner)


def read_project(value: object, owner: str) -> Project:
    """Read a project from a mapping."""
    known = (*ENTRIES, CONCLUSION, ASSUMPTIONS, CHECKS)
    if not isinstance(value, Mapping):
        msg = (
            f"{owner}: project must be a mapping with any of {', '.join(known)}, got "
            f"{short_repr(value)}"
        )
        raise ComponentError(msg)
    values = cast("Mapping[Any, Any]", value)
    for name in values:
        if name not in known:
            called = f"{short_repr(name)}{did_you_mean(name, known)}"
            msg = f"{owner}: project has no entry {called}; known are {', '.join(known)}"
            raise ComponentError(msg)
    assumptions, checks = (
        _read_texts(values.get(entry, ()), entry, owner) for entry in (ASSUMPTIONS, CHECKS)
    )
    return Project(
        tuple((title, _read_text(values[name], name, owner)) for name, title in ENTRIES.items()
              if name in values),
        _read_text(values.get(CONCLUSION, ""), CONCLUSION, owner),
        assumptions,
        checks,
    )  # fmt: skip


def project_json(values: Mapping[str, object], owner: str) -> str:
    """Write a project in JSON, as results keep it."""
    read_project(values, owner)
    return json.dumps(values, default=str)


def _read_texts(value: object, name: str, owner: str) -> tuple[str, ...]:
    if not isinstance(value, list | tuple):
        msg = f"{owner}: {name} must be a list of texts, got {short_repr(value)}"
        raise ComponentError(msg)
    return tuple(_read_text(text, name, owner) for text in value)


def _read_text(value: object, name: str, owner: str) -> str:
    if isinstance(value, datetime.date):  # TOML has dates
        return value.isoformat()
    if isinstance(value, str | int):
        return str(value)
    msg = f"{owner}: {name} of the project must be text, got {short_repr(value)}"
    raise ComponentError(msg)
