"""Making a user's own base known: where it belongs, and what it shows."""

from collections.abc import Sequence
from typing import Any, Final

import pint

from rockframe.errors import ComponentError, shown
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.variable import TIME, Variable
from rockframe.system.own_base import OwnBase
from rockframe.system.slots import add_kind
from rockframe.units import Unit

_OWNER: Final = "register"
SLOTS: Final = ("pads", "soil")
"""Slots that bases of users' own can fill."""


def register(kind: type[OwnBase], *, columns: Sequence[Variable] = ()) -> None:
    """Make a base of your own known, so that it stands in scenes as pads or soil do.

    Parameters
    ----------
    kind : type of OwnBase
        Its class, with ``slot`` and ``support``.
    columns : sequence of Variable, optional
        Histories that it shows and that no other base has, over ``time``.

    Raises
    ------
    ComponentError
        What is not as it must be, every fault at once; nothing is registered then.
    """
    faults = [*_faults_of(kind), *(fault for row in columns for fault in _faults_in(row))]
    names = [getattr(row, "name", None) for row in columns]
    faults += [f"two columns are called {name!r}" for name in {*names} if names.count(name) > 1]
    if faults:
        msg = f"{_OWNER}: {'; '.join(faults)}"
        raise ComponentError(msg)
    add_kind(kind)
    SCHEMA.update({row.name: row for row in columns})


def _faults_of(kind: Any) -> list[str]:
    if not (isinstance(kind, type) and issubclass(kind, OwnBase)):
        return [f"expected a class derived from OwnBase, got {shown(kind)}"]
    faults: list[str] = []
    if kind.slot not in SLOTS:
        known = " or ".join(repr(slot) for slot in SLOTS)
        faults.append(f"{kind.__name__}.slot must be {known}, got {shown(kind.slot)}")
    if kind.support is OwnBase.support:
        faults.append(f"{kind.__name__} has no method support(load)")
    return faults


def _faults_in(row: Any) -> list[str]:
    if not isinstance(row, Variable):
        return [f"columns must be Variables, got {shown(row)}"]
    faults: list[str] = []
    if not row.name.isidentifier():
        faults.append(f"a column is called {row.name!r}; expected a name such as 'left_set'")
    if row.dims != TIME:
        faults.append(f"column {row.name!r} needs the dimensions {TIME}, got {row.dims}")
    if SCHEMA.get(row.name, row) != row:
        faults.append(f"there is a variable {row.name!r} of another meaning")
    if row.unit is not None and not isinstance(row.unit, Unit):
        try:
            pint.get_application_registry().parse_units(row.unit)
        except Exception:  # whatever pint makes of it
            faults.append(f"column {row.name!r} has the unit {row.unit!r}, which pint cannot read")
    return faults
