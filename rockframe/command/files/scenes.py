"""A scene in a TOML file: tables for the parts, the system's options, the motion and the run."""

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any, Final

from rockframe.command.files.parts import CONSTRUCTOR, MODULES, build_parts, part_slots
from rockframe.command.files.tables import (
    KeyPath,
    TomlFile,
    arguments_of,
    call_with_table,
    check_table,
    table_title,
)
from rockframe.command.typed_calls import parse_check
from rockframe.components import Component, InitialState
from rockframe.components.registry import registered_classes
from rockframe.errors import AssemblyError, RockframeError, did_you_mean, short_repr
from rockframe.motion import GroundMotion
from rockframe.motion.description import CONSTRUCTORS, OPERATIONS
from rockframe.reports.project import CHECKS, project_json
from rockframe.simulation.plan import read_arguments, read_certification
from rockframe.simulation.run_arguments import Certification
from rockframe.simulation.system import System
from rockframe.solve.accuracy import Accuracy
from rockframe.suggestions import hints_of
from rockframe.system.parts import slot_of_class

_FILE_KEY: Final = "file"
MOTIONS: Final = (*CONSTRUCTORS, "example")
"""Constructors of motions that files may name; ``example`` gives a record of the package."""
_OPERATIONS: Final = "operations"
_RESPONSE: Final = "response"


def motion_keys() -> dict[str, bool]:
    """Return the keys of a motion from a file, and whether each is needed."""
    arguments = arguments_of(GroundMotion.read, without=("path",))
    return {_FILE_KEY: True, **arguments, _OPERATIONS: False}


def build_motion(file: TomlFile, where: KeyPath, value: object) -> GroundMotion | None:
    """Build the motion that a table describes."""
    table = file.table(where, value)
    if table is None:
        return None
    operations, motion = table.pop(_OPERATIONS, []), None
    if CONSTRUCTOR in table and _FILE_KEY not in table:
        motion = _construct_motion(file, where, table)
    elif _FILE_KEY not in table:
        ways = (
            f"{_FILE_KEY!r}, the path of a record, or {CONSTRUCTOR!r}, one of {', '.join(MOTIONS)}"
        )
        file.add_fault(where, f"[{table_title(where)}] lacks {ways}")
    elif check_table(file, where, {**table}, motion_keys()):
        motion = _read_record(file, where, table)
    return None if motion is None else _apply_operations(file, where, motion, operations)


def _read_record(file: TomlFile, where: KeyPath, table: dict[str, Any]) -> GroundMotion | None:
    name = table.pop(_FILE_KEY)
    if not isinstance(name, str):
        file.add_fault(
            (*where, _FILE_KEY), f"file must be the path of a record, got {short_repr(name)}"
        )
        return None
    component = table.get("component")
    if isinstance(component, list):  # TOML has no tuples
        table["component"] = tuple(component)
    if isinstance(table.get(_RESPONSE), str):
        table[_RESPONSE] = file.path_relative_to(table[_RESPONSE])
    read = partial(GroundMotion.read, file.path_relative_to(name))
    return call_with_table(file, where, read, table)


def _construct_motion(file: TomlFile, where: KeyPath, table: dict[str, Any]) -> GroundMotion | None:
    constructor = table.pop(CONSTRUCTOR)
    if constructor not in MOTIONS:
        known = ", ".join(MOTIONS)
        near = did_you_mean(str(constructor), MOTIONS)
        words = f"constructor must be one of {known}, got {short_repr(constructor)}{near}"
        file.add_fault((*where, CONSTRUCTOR), words)
        return None
    function = getattr(GroundMotion, constructor)
    if not check_table(file, where, table, arguments_of(function)):
        return None
    return call_with_table(file, where, function, table)


def _apply_operations(
    file: TomlFile, where: KeyPath, motion: GroundMotion, operations: object
) -> GroundMotion | None:
    """Apply a list of operations to a motion, each a table with one key."""
    where = (*where, _OPERATIONS)
    if not isinstance(operations, list):
        words = "operations must be a list such as [{ scaled = { factor = 1.5 } }]"
        file.add_fault(where, f"{words}, got {short_repr(operations)}")
        return None
    processed: GroundMotion | None = motion
    for number, operation in enumerate(operations):
        here = (*where, number)
        if not isinstance(operation, dict) or len(operation) != 1:
            words = "an operation is written { scaled = { factor = 1.5 } }"
            file.add_fault(here, f"{words}, got {short_repr(operation)}")
            return None
        ((name, value),) = operation.items()
        if processed is None:
            return None
        processed = _apply_operation(file, (*here, str(name)), processed, value)
    return processed


def _apply_operation(
    file: TomlFile, where: KeyPath, motion: GroundMotion, value: object
) -> GroundMotion | None:
    name = str(where[-1])
    if name not in OPERATIONS:
        file.add_unknown_key(where[:-1], name, OPERATIONS)
        return None
    table = file.table(where, value)
    if table is None:
        return None
    arguments: Mapping[str, bool] = arguments_of(getattr(motion, name))
    if not check_table(file, where, table, arguments):
        return None
    if isinstance(table.get("other"), dict):
        other = build_motion(file, (*where, "other"), table["other"])
        if other is None:
            return None
        table["other"] = other
    return call_with_table(file, where, getattr(motion, name), table)


OPTIONS: Final = "system"
MOTION: Final = "motion"
RUN: Final = "run"
PROJECT: Final = "project"
AXES: Final = "axes"
CASES: Final = "cases"
"""What only a study has, one of them."""


def scene_keys() -> tuple[str, ...]:
    """Return the keys of the file of a scene."""
    return (MODULES, *part_slots(), OPTIONS, MOTION, RUN, PROJECT)


@dataclass(frozen=True)
class SceneDescription:
    """What the file of a scene describes."""

    system: System  # the parts, without the motion
    motion: GroundMotion | None
    run: dict[str, Any]  # further arguments of :meth:`rockframe.System.simulate`
    files: tuple[Path, ...]  # all files that were read
    project: str  # the project in JSON, as results keep it


def read_scene(path: str | Path) -> SceneDescription:
    """Read the file of a scene."""
    file = TomlFile.read(path)
    for name in file.values.keys() & {AXES, CASES}:
        words = "belongs to a study, which 'rockframe study' runs; give the file of a scene"
        file.add_fault((name,), f"{name!r} {words}")
        raise file.error()
    import_modules(file)  # before the keys are checked: its parts may add tables
    for name in file.values:
        if name not in scene_keys():
            _add_unknown_table(file, name)
    scene = build_scene(file)
    if scene is None or not file.is_valid:
        raise file.error()
    return scene


def build_scene(file: TomlFile) -> SceneDescription | None:
    """Build what the tables of a file describe."""
    given = file.values
    parts = [
        part for slot in part_slots() if slot in given
        for part in build_parts(file, slot, given[slot])
    ]  # fmt: skip
    motion = build_motion(file, (MOTION,), given[MOTION]) if MOTION in given else None
    run = _run_from_table(file, given[RUN]) if RUN in given else {}
    project = project_from_table(file, given[PROJECT]) if PROJECT in given else ""
    options = file.table((OPTIONS,), given.get(OPTIONS, {}))
    known = arguments_of(System.__init__, without=("parts",))
    hints = hints_of(System.simulate)  # for keys that belong to the parts or to the run
    if options is None or not check_table(file, (OPTIONS,), options, known, hints=hints):
        return None
    if not file.is_valid:
        return None
    system = call_with_table(file, (OPTIONS,), lambda **values: System(*parts, **values), options)
    if system is None:
        return None
    return SceneDescription(system, motion, run, tuple(file.files), project)


def run_keys() -> dict[str, bool]:
    """Return the keys of the table of a run, and whether each is needed."""
    return arguments_of(System.simulate, without=("motion",))


def build_run_objects(file: TomlFile, where: KeyPath, table: dict[str, Any]) -> dict[str, Any]:
    """Build the objects that inner tables of the table of a run describe."""
    objects = dict(table)
    for name, kind in _RUN_CLASSES.items():
        inner = objects.get(name)
        if not isinstance(inner, dict):
            continue
        here = (*where, name)
        value = file.table(here, inner) or {}
        declared = kind.declared() if issubclass(kind, Component) else {}
        if check_table(file, here, value, arguments_of(kind), declared):
            objects[name] = call_with_table(file, here, kind, value)
        if not isinstance(objects[name], kind):  # its fault has been noted
            del objects[name]
    return objects


_RUN_CLASSES: Final[Mapping[str, type]] = {
    "initial": InitialState,
    "accuracy": Accuracy,
    "certify": Certification,
}
"""Classes of the objects that inner tables of the table of a run describe."""


def _run_from_table(file: TomlFile, argument: object) -> dict[str, Any]:
    table = file.table((RUN,), argument)
    hints = hints_of(System.simulate)
    if table is None:
        return {}
    check_table(file, (RUN,), table, run_keys(), hints=hints)
    known = {name: value for name, value in table.items() if name in run_keys()}
    arguments = build_run_objects(file, (RUN,), known)
    call_with_table(file, (RUN,), _read_arguments, arguments)
    return arguments


def project_from_table(file: TomlFile, value: object) -> str:
    """Read the description of the project for reports."""
    table = file.table((PROJECT,), value)
    if table is None:
        return ""
    return call_with_table(file, (PROJECT,), _read_project, table) or ""


def _read_project(**values: Any) -> str:
    """Read a project and its checks by codes, before there is a result."""
    text = project_json(values, PROJECT)
    for check in values.get(CHECKS, ()):
        parse_check(str(check), CHECKS)
    return text


def _read_arguments(**values: Any) -> None:
    """Check the arguments of a run before it begins, so that faults have their lines."""
    read_certification(values.pop("certify", False))
    faults: list[str] = []
    read_arguments(faults, **values)
    if faults:
        raise AssemblyError(faults)


def _add_unknown_table(file: TomlFile, name: str) -> None:
    letters = name.replace("_", "").casefold()
    for word, kind in registered_classes().items():
        slot = slot_of_class(kind)
        if word.casefold() == letters and slot is not None:
            words = f'a {word} is written [{slot}] with type = "{word}"'
            file.add_fault((name,), f"unknown key {name!r}; {words}")
            return
    file.add_unknown_key((), name, scene_keys())


def import_modules(file: TomlFile) -> None:
    """Import the files in which users declare their own parts."""
    value = file.values.get(MODULES, [])
    if not isinstance(value, list):
        file.add_fault(
            (MODULES,), f'modules must be a list such as ["mine.py"], got {short_repr(value)}'
        )
        return
    for name in value:
        try:
            _import_module(file, str(name))
        except RockframeError as problem:
            file.add_fault((MODULES,), f"{name}: {problem}")
        except Exception as problem:  # code of users may raise anything
            words = f"{name} cannot be imported ({type(problem).__name__}: {problem})"
            file.add_fault((MODULES,), words)


def _import_module(file: TomlFile, name: str) -> None:
    if not name.endswith(".py"):
        import_module(name)
        return
    path = file.path_relative_to(name)
    stem = path.stem
    if stem in sys.modules:
        loaded = getattr(sys.modules[stem], "__file__", None)
        if loaded is None or path.read_bytes() != Path(loaded).read_bytes():
            msg = f"{stem} is another module already, {loaded or 'a built-in one'}: rename the file"
            raise ImportError(msg)
        return
    spec = spec_from_file_location(stem, path)
    if spec is None or spec.loader is None:
        raise ImportError(name)
    module = module_from_spec(spec)
    sys.modules[stem] = module  # classes are found by the names of their modules
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[stem]
        raise
