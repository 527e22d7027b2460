"""The table of a ground motion: a file, or a constructor, and what is done to it."""

from collections.abc import Mapping
from typing import Any, Final

from rockframe.command.files.calls import arguments_of, checked, made
from rockframe.command.files.lines import Place
from rockframe.command.files.tables import TomlFile
from rockframe.errors import shown
from rockframe.motion import GroundMotion
from rockframe.motion.description import CONSTRUCTORS, OPERATIONS

_FILE: Final = "file"
_CONSTRUCTOR: Final = "constructor"
_OPERATIONS: Final = "operations"


def motion_keys() -> dict[str, bool]:
    """Give the keys of a motion from a file, and whether each is needed."""
    arguments = arguments_of(GroundMotion.read, without=("path",))
    return {_FILE: True, **arguments, _OPERATIONS: False}


def described_motion(file: TomlFile, where: Place, given: object) -> GroundMotion | None:
    """Build the motion that a table describes."""
    table = file.table(where, given)
    if table is None:
        return None
    operations = table.pop(_OPERATIONS, [])
    if _CONSTRUCTOR in table and _FILE not in table:
        motion = _constructed(file, where, table)
    elif checked(file, where, {**table}, motion_keys()):
        motion = _read(file, where, table)
    else:
        motion = None
    return None if motion is None else _operated(file, where, motion, operations)


def _read(file: TomlFile, where: Place, table: dict[str, Any]) -> GroundMotion | None:
    name = table.pop(_FILE)
    if not isinstance(name, str):
        file.fault((*where, _FILE), f"file must be the path of a record, got {shown(name)}")
        return None
    component = table.get("component")
    if isinstance(component, list):  # TOML has no pairs
        table["component"] = tuple(component)  # pyright: ignore[reportUnknownArgumentType]
    return made(file, where, lambda **rest: GroundMotion.read(file.beside(name), **rest), table)


def _constructed(file: TomlFile, where: Place, table: dict[str, Any]) -> GroundMotion | None:
    constructor = table.pop(_CONSTRUCTOR)
    if constructor not in CONSTRUCTORS:
        known = ", ".join(CONSTRUCTORS)
        file.fault(
            (*where, _CONSTRUCTOR), f"constructor must be one of {known}, got {shown(constructor)}"
        )
        return None
    function = getattr(GroundMotion, constructor)
    if not checked(file, where, table, arguments_of(function)):
        return None
    return made(file, where, function, table)


def _operated(
    file: TomlFile, where: Place, motion: GroundMotion, operations: object
) -> GroundMotion | None:
    """Do to a motion what a list of tables with one key each says."""
    where = (*where, _OPERATIONS)
    if not isinstance(operations, list):
        words = "operations must be a list such as [{ scaled = { factor = 1.5 } }]"
        file.fault(where, f"{words}, got {shown(operations)}")
        return None
    found: GroundMotion | None = motion
    for number, one in enumerate(operations):  # pyright: ignore[reportUnknownArgumentType]
        here = (*where, number)
        if not isinstance(one, dict) or len(one) != 1:  # pyright: ignore[reportUnknownArgumentType]
            file.fault(
                here, f"an operation is written {{ scaled = {{ factor = 1.5 }} }}; {shown(one)}"
            )  # pyright: ignore[reportUnknownArgumentType]
            return None
        ((name, given),) = one.items()  # pyright: ignore[reportUnknownVariableType]
        if found is None:
            return None
        found = _done(file, (*here, str(name)), found, given)  # pyright: ignore[reportUnknownArgumentType]
    return found


def _done(file: TomlFile, where: Place, motion: GroundMotion, given: object) -> GroundMotion | None:
    name = str(where[-1])
    if name not in OPERATIONS:
        file.unknown(where[:-1], name, OPERATIONS)
        return None
    table = file.table(where, given)
    if table is None:
        return None
    arguments: Mapping[str, bool] = arguments_of(getattr(motion, name))
    if not checked(file, where, table, arguments):
        return None
    if isinstance(table.get("other"), dict):
        other = described_motion(file, (*where, "other"), table["other"])
        if other is None:
            return None
        table["other"] = other
    return made(file, where, getattr(motion, name), table)
