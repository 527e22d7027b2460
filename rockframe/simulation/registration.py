"""Registration of users' own bases, links, scenes, columns of results and diagnostics."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, cast

from rockframe.arguments import checked_list
from rockframe.components import Block, Component
from rockframe.errors import raise_faults, short_repr
from rockframe.results.diagnostics import DIAGNOSTICS, Diagnostic, add_diagnostic
from rockframe.results.schema import GROUPS, SCHEMA
from rockframe.results.variables.variable import EVENT, TIME, Variable
from rockframe.suggestions import with_hints
from rockframe.system.assembly import add_scene, scene_of_same_parts
from rockframe.system.links import OwnLink
from rockframe.system.own_base import OwnAnswers, OwnBase
from rockframe.system.own_scene import OwnScene
from rockframe.system.parts import (
    BUILTIN_SLOTS,
    RESTRAINER,
    PartKind,
    add_part_class,
    slot_of_class,
)
from rockframe.units import Unit, unit_registry

_OWNER: Final = "register"
USER_BASE_SLOTS: Final = ("pads", "soil")
"""Slots that bases of users' own can fill."""
_RUN_DIMENSIONS: Final = (*TIME, *EVENT)
"""Dimensions that every run has."""


@with_hints()
def register(
    kind: "type[OwnBase] | type[OwnScene] | type[OwnLink] | Diagnostic | Callable[..., Any]",
    *,
    columns: Sequence[Variable] = (),
    name: str | None = None,
    unit: Unit | str | None = None,
    long_name: str | None = None,
) -> None:
    """Register a user-defined base, link, scene or diagnostic.

    Parameters
    ----------
    kind : type of OwnBase, type of OwnScene, type of OwnLink, Diagnostic or callable
        The class of a link, with ``law``, to be used in scenes as a Restrainer; the class of a
        base, with ``slot`` and ``support``, to be used in scenes as pads or soil; the class of a
        scene, with its parts and its own equations; or a function of the state, which becomes a
        :class:`~rockframe.extension.Diagnostic`.
    columns : sequence of Variable, optional
        Variables of results that only this base or scene has: over ``time``, over ``event``, over
        its own dimensions, or without dimensions. Each own dimension needs a column with its
        name that contains the labels.
    name, unit, long_name : str, optional
        For a function: the name of the diagnostic, by default that of the function; the unit of
        the numbers that it returns; and their meaning, by default the first line of its
        docstring.

    Raises
    ------
    ComponentError
        The argument does not have the required form; all faults are listed, and nothing is
        registered.

    Examples
    --------
    >>> import numpy as np
    >>> import rockframe as rf
    >>> def roof_drift(state):
    ...     return state["horizontal_displacement"] + 2.0 * np.sin(state["rotation"])
    >>> rf.register(roof_drift, unit="m", long_name="displacement of the middle of the roof")
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> round(float(system.simulate(pulse, outputs=["roof_drift"]).peak_roof_drift), 3)
    0.184
    """
    columns = checked_list(columns, owner=_OWNER, name="columns", of="Variables")
    if isinstance(kind, Diagnostic) or (callable(kind) and not isinstance(kind, type)):
        _register_diagnostic(kind, columns, name, unit, long_name)
        return
    faults = [
        *_class_faults(kind),
        *(fault for row in columns for fault in _column_faults(row, columns)),
    ]
    names = [getattr(row, "name", None) for row in columns]
    faults += [f"two columns are called {name!r}" for name in {*names} if names.count(name) > 1]
    faults += [
        f"{what} is for functions of the state"
        for what, argument in (("name", name), ("unit", unit), ("long_name", long_name))
        if argument is not None
    ]
    rows = [row for row in columns if isinstance(row, Variable)]
    scalars = [row.name for row in rows if row.dims != TIME]
    if scalars and getattr(kind, "answers", None) is OwnAnswers.answers:
        faults.append(
            f"{kind.__name__} has no method answers(histories, before, after), which gives "
            f"{' and '.join(map(repr, scalars))}"
        )
    raise_faults(_OWNER, faults)
    if issubclass(kind, OwnBase):
        add_part_class(kind, PartKind(kind.slot, kind.support))
    elif issubclass(kind, OwnLink):
        add_part_class(kind, PartKind(RESTRAINER))
    else:
        add_scene(kind)
        for slot, part in kind.made_of.items():
            if slot not in BUILTIN_SLOTS:
                add_part_class(part, PartKind(slot))
    SCHEMA.update({row.name: row for row in columns})


def _register_diagnostic(
    value: "Diagnostic | Callable[..., Any]",
    columns: Sequence[Variable],
    name: str | None,
    unit: Unit | str | None,
    long_name: str | None,
) -> None:
    faults = ["columns are for bases and scenes"] if columns else []
    if isinstance(value, Diagnostic):
        if (name, unit, long_name) != (None, None, None):
            faults.append("a Diagnostic has its name, unit and long_name itself")
    else:
        words = (value.__doc__ or "").strip().split("\n")[0].rstrip(".")
        called = name if name is not None else getattr(value, "__name__", "")
        value = Diagnostic(
            value, called, cast("str", unit), words if long_name is None else long_name
        )
    faults += _diagnostic_faults(value)
    raise_faults(_OWNER, faults)
    add_diagnostic(value)


def _class_faults(kind: Any) -> list[str]:
    if isinstance(kind, type) and issubclass(kind, OwnBase):
        return _base_faults(kind)
    if isinstance(kind, type) and issubclass(kind, OwnScene):
        return _scene_faults(kind)
    if isinstance(kind, type) and issubclass(kind, OwnLink):
        return [] if kind.law is not OwnLink.law else [f"{kind.__name__} has no method law(mass)"]
    return [
        "expected a class derived from OwnBase or OwnScene, or from OwnLink, a Diagnostic or a "
        f"function, got {short_repr(kind)}"
    ]


def _base_faults(kind: type[OwnBase]) -> list[str]:
    faults: list[str] = []
    if kind.slot not in USER_BASE_SLOTS:
        known = " or ".join(repr(slot) for slot in USER_BASE_SLOTS)
        faults.append(f"{kind.__name__}.slot must be {known}, got {short_repr(kind.slot)}")
    if kind.support is OwnBase.support:
        faults.append(f"{kind.__name__} has no method support(load)")
    return faults


def _scene_faults(kind: type[OwnScene]) -> list[str]:
    missing = getattr(kind, "__abstractmethods__", frozenset())
    faults = [
        f"{kind.__name__} has no {_REQUIRED_MEMBERS[name]}"
        for name in _REQUIRED_MEMBERS
        if name in missing
    ]
    made_of: Any = kind.made_of
    if not (isinstance(made_of, Mapping) and made_of):
        return [
            *faults,
            f"{kind.__name__}.made_of must name slots and classes of parts, such as "
            f"{{'block': Block, 'floor': Floor}}, got {short_repr(made_of)}",
        ]
    of_parts = [fault for row in made_of.items() for fault in _part_faults(kind.__name__, *row)]
    if of_parts:
        return [*faults, *of_parts]
    if not any(issubclass(part, Block) for part in made_of.values()):
        faults.append(f"{kind.__name__} has no Block among its parts, of which the response is")
    if not set(made_of) - set(BUILTIN_SLOTS):
        faults.append(
            f"{kind.__name__} is made of rockframe's own parts alone, like a built-in scene; "
            "add a part of your own"
        )
    twin = scene_of_same_parts(kind)
    if twin is not None:
        faults.append(f"{kind.__name__} is made of the same parts as {twin}")
    return faults


_REQUIRED_MEMBERS: Final = {
    "model": "name model, such as model = 'slide-rock'",
    "contact_model": "method contact_model(), which gives its equations",
    "words": "method words(), the text of describe()",
}
"""What the class of a scene must define."""


def _part_faults(owner: str, slot: Any, part: Any) -> list[str]:
    """Say what is wrong with a part of a scene and its slot."""
    where = f"{owner}.made_of[{slot!r}]"
    if not (isinstance(slot, str) and slot.isidentifier()):
        return [f"{where}: a slot is called by a name such as 'floor'"]
    if not (isinstance(part, type) and issubclass(part, Component)):
        return [f"{where} must be a class of components, got {short_repr(part)}"]
    fills = slot_of_class(part)
    if fills is not None and fills != slot:
        return [f"{where}: {part.__name__} fills the slot {fills!r}"]
    if fills is None and slot in BUILTIN_SLOTS:
        return [f"{where}: the slot is one of rockframe's own parts; give {part.__name__} another"]
    return []


def _column_faults(row: Any, columns: Sequence[Any]) -> list[str]:
    if not isinstance(row, Variable):
        return [f"columns must be Variables, got {short_repr(row)}"]
    faults = _name_faults(row.name, "a column")
    labels = {
        column.name
        for column in columns
        if isinstance(column, Variable) and column.dims == (column.name,)
    }
    faults += [
        f"column {row.name!r} over {row.dims}: nothing labels {dim!r}; declare a column {dim!r} "
        f"over ({dim!r},)"
        for dim in row.dims
        if dim not in _RUN_DIMENSIONS and dim not in labels
    ]
    if SCHEMA.get(row.name, row) != row:
        faults.append(f"there is a variable {row.name!r} of another meaning")
    return [*faults, *_unit_faults(row.unit, f"column {row.name!r}")]


def _diagnostic_faults(value: Diagnostic) -> list[str]:
    name = cast("Any", value.name)
    if not isinstance(name, str):
        return [f"the name of a diagnostic must be a word, got {short_repr(name)}"]
    faults = _name_faults(name, "a diagnostic")
    if not callable(value.function):
        faults.append(f"diagnostic {name!r} needs a function, got {short_repr(value.function)}")
    if not isinstance(cast("Any", value.long_name), str) or not value.long_name:
        faults.append(f"diagnostic {name!r} needs a long_name, or a docstring")
    if cast("Any", value.unit) is None:
        faults.append(f"diagnostic {name!r} needs a unit, such as 'm', or '1'")
    taken = (
        [row.name for row in value.rows if row.name in SCHEMA] if name not in DIAGNOSTICS else []
    )
    taken += [name] if name in GROUPS else []
    faults += [f"there is a variable {taken_name!r} of another meaning" for taken_name in taken]
    return [*faults, *_unit_faults(value.unit, f"diagnostic {name!r}")]


def _name_faults(name: str, what: str) -> list[str]:
    fault = f"{what} is called {name!r}; expected one such as 'left_set'"
    return [] if name.isidentifier() else [fault]


def _unit_faults(unit: Any, owner: str) -> list[str]:
    if unit is None or isinstance(unit, Unit):
        return []
    try:
        unit_registry().parse_units(unit)
    except Exception:  # whatever pint makes of it
        return [f"{owner} has the unit {unit!r}, which pint cannot read"]
    return []
