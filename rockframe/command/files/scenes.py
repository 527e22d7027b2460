"""A scene in a TOML file: tables for the parts, the system's options, the motion and the run."""

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from inspect import getmembers, ismethod
from pathlib import Path
from typing import Any, Final

from rockframe.arguments import hints_of
from rockframe.command.files.tables import Place, TomlFile, arguments_of, checked, made
from rockframe.components import Component, InitialState
from rockframe.components.registry import kinds
from rockframe.errors import AssemblyError, RockframeError, shown
from rockframe.motion import GroundMotion
from rockframe.motion.description import CONSTRUCTORS, OPERATIONS
from rockframe.reports.project import project_json
from rockframe.simulation.plan import read_arguments
from rockframe.simulation.run_arguments import Certification, certification_of
from rockframe.simulation.system import System
from rockframe.solve.accuracy import Accuracy, AccuracyLevel
from rockframe.system.options import Overturning
from rockframe.system.parts import RESTRAINER, slot_of_kind, slots, usual_kind

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


TYPE: Final = "type"
CONSTRUCTOR: Final = "constructor"
MODULES: Final = "modules"
OPTIONS: Final = "system"
MOTION: Final = "motion"
RUN: Final = "run"
PROJECT: Final = "project"
_OF_ALL: Final = ("from_dict", "declared")
"""Class methods of all components, which are no way to describe one."""


def part_slots() -> tuple[str, ...]:
    """Give the tables of parts."""
    return tuple(slot for slot in slots() if slot != MOTION)


def keys() -> tuple[str, ...]:
    """Give what a file of a scene may hold."""
    return (MODULES, *part_slots(), OPTIONS, MOTION, RUN, PROJECT)


@dataclass(frozen=True)
class Described:
    """What a file describes."""

    system: System  # the parts, without the motion
    motion: GroundMotion | None  # of the ground
    # further arguments of :meth:`rockframe.System.simulate`
    run: dict[str, Any] = field(default_factory=dict)
    files: tuple[Path, ...] = ()  # all files that it was read from
    project: str = ""  # what reports say of it, as results keep it


def read_scene(path: str | Path) -> Described:
    """Read the file of a scene."""
    file = TomlFile.read(path)
    import_modules(file)  # whose parts may have tables of their own
    for name in file.values:
        if name not in keys():
            _unknown_table(file, name)
    found = described_scene(file)
    file.check()
    if found is None:  # without a fault there is a system
        raise AssertionError
    return found


def described_scene(file: TomlFile) -> Described | None:
    """Build what the tables of a file describe."""
    given = file.values
    parts = [
        part for slot in part_slots() if slot in given
        for part in described_parts(file, slot, given[slot])
    ]  # fmt: skip
    motion = described_motion(file, (MOTION,), given[MOTION]) if MOTION in given else None
    run = _run_of(file, given[RUN]) if RUN in given else {}
    project = _project_of(file, given[PROJECT]) if PROJECT in given else ""
    options = file.table((OPTIONS,), given.get(OPTIONS, {}))
    known = arguments_of(System.__init__, without=("parts",))
    hints = hints_of(System.simulate)  # of what belongs to the parts or to the run
    if options is None or not checked(file, (OPTIONS,), options, known, hints=hints):
        return None
    if not file.sound:
        return None
    system = made(file, (OPTIONS,), lambda **rest: System(*parts, **rest), options)
    return None if system is None else Described(system, motion, run, tuple(file.files), project)


def described_parts(file: TomlFile, slot: str, given: object) -> list[Component | None]:
    """Build the part that a table describes, or those of an array of tables."""
    if slot != RESTRAINER or not isinstance(given, list):
        return [described_part(file, slot, given)]
    tables: list[object] = given
    return [described_part(file, slot, one, (i,)) for i, one in enumerate(tables)]


def described_part(
    file: TomlFile, slot: str, given: object, number: tuple[int, ...] = ()
) -> Component | None:
    """Build the part that a table describes; `number` is its own in an array of tables."""
    where: Place = (slot, *number)
    table = file.table(where, given)
    if table is None:
        return None
    kind = _kind_of(file, slot, table.pop(TYPE, None))
    if kind is None:
        return None
    constructor = table.pop(CONSTRUCTOR, None)
    if constructor is None:
        function: Callable[..., Component] = kind
        declared = kind.declared()
    else:
        ways = constructors(kind)
        if constructor not in ways:
            known = ", ".join(ways) or "none but the usual one"
            file.fault(
                (*where, CONSTRUCTOR),
                f"constructors of {kind.__name__} are {known}; got {shown(constructor)}",
            )
            return None
        function, declared = ways[constructor], {}
    known_keys = arguments_of(function)
    unknown = [name for name in table if name not in known_keys]
    if not checked(file, where, table, known_keys, declared, hints_of(kind.__init__)):
        _say_ways(file, where, kind, unknown)
        return None
    return made(file, where, function, table)


def classes_in(slot: str) -> dict[str, type[Component]]:
    """Give the classes of parts that a table may describe, the usual one first."""
    usual = usual_kind(slot)
    fitting = {name: kind for name, kind in kinds().items() if slot_of_kind(kind) == slot}
    return {usual.__name__: fitting[usual.__name__], **fitting}


def constructors(kind: type[Component]) -> dict[str, Callable[..., Component]]:
    """Give the ways to build a component beside its own constructor, by their names."""
    return {
        name: one
        for name, one in getmembers(kind, ismethod)
        if not name.startswith("_") and name not in _OF_ALL
    }


def run_keys() -> dict[str, bool]:
    """Give the keys of the table of a run, and whether each is needed."""
    return arguments_of(System.simulate, without=("motion",))


def described_run(file: TomlFile, where: Place, table: dict[str, Any]) -> dict[str, Any]:
    """Build the objects that tables inside a table of a run stand for."""
    found = dict(table)
    for name, kind in _OBJECTS.items():
        inner = found.get(name)
        if not isinstance(inner, dict):
            continue
        here = (*where, name)
        given = file.table(here, inner) or {}
        declared = kind.declared() if issubclass(kind, Component) else {}
        if checked(file, here, given, arguments_of(kind), declared):
            found[name] = made(file, here, kind, given)
    return found


_OBJECTS: Final[Mapping[str, type]] = {
    "initial": InitialState,
    "accuracy": Accuracy,
    "certify": Certification,
}
"""Classes of what a table inside that of a run describes."""


def _run_of(file: TomlFile, given: object) -> dict[str, Any]:
    table = file.table((RUN,), given)
    hints = hints_of(System.simulate)
    if table is None or not checked(file, (RUN,), table, run_keys(), hints=hints):
        return {}
    arguments = described_run(file, (RUN,), table)
    made(file, (RUN,), _read_arguments, arguments)
    return arguments


def _project_of(file: TomlFile, given: object) -> str:
    table = file.table((PROJECT,), given)
    if table is None:
        return ""
    return made(file, (PROJECT,), lambda **rest: project_json(rest, PROJECT), table) or ""


def _read_arguments(**given: Any) -> None:
    """Read the arguments of a run before there is one, so that faults have their line."""
    usual: dict[str, Any] = {
        "accuracy": AccuracyLevel.STANDARD,
        "outputs": (),
        "overturning": Overturning.STOP,
    }
    certification_of(given.pop("certify", False))
    faults: list[str] = []
    read_arguments(faults, **(usual | given))
    if faults:
        raise AssemblyError(faults)


def _kind_of(file: TomlFile, slot: str, name: object) -> type[Component] | None:
    known = classes_in(slot)
    if name is None:
        return next(iter(known.values()))
    if isinstance(name, str) and name in known:
        return known[name]
    of_own = (
        f'; a class of your own is found once its file is named at the top, {MODULES} = ["mine.py"]'
    )
    file.fault((slot, TYPE), f"type must be {' or '.join(known)}, got {shown(name)}{of_own}")
    return None


def _say_ways(file: TomlFile, where: Place, kind: type[Component], unknown: list[str]) -> None:
    """Say which other constructors take the keys that this one does not know."""
    for name in unknown:
        ways = [way for way, one in constructors(kind).items() if name in arguments_of(one)]
        if ways:
            file.fault(
                (*where, name),
                f"{name!r} goes with {CONSTRUCTOR} = {' or '.join(map(repr, ways))}".replace(
                    "'", '"'
                ),
            )


def _unknown_table(file: TomlFile, name: str) -> None:
    kind = kinds().get(name)
    slot = None if kind is None else slot_of_kind(kind)
    if slot is None:
        file.unknown((), name, keys())
    else:
        words = f'a {name} is written [{slot}] with type = "{name}"'
        file.fault((name,), f"unknown key {name!r}; {words}")


def import_modules(file: TomlFile) -> None:
    """Import the files in which users declare their own parts."""
    given = file.values.get(MODULES, [])
    if not isinstance(given, list):
        file.fault((MODULES,), f'modules must be a list such as ["mine.py"], got {shown(given)}')
        return
    for name in given:  # pyright: ignore[reportUnknownVariableType]
        try:
            _import(file, str(name))  # pyright: ignore[reportUnknownArgumentType]
        except RockframeError as problem:
            file.fault((MODULES,), f"{name}: {problem}")
        except Exception as problem:  # code of others: whatever it raises
            words = f"{name} cannot be imported ({type(problem).__name__}: {problem})"
            file.fault((MODULES,), words)


def _import(file: TomlFile, name: str) -> None:
    if not name.endswith(".py"):
        import_module(name)
        return
    path = file.beside(name)
    stem = path.stem
    if stem in sys.modules:
        return
    spec = spec_from_file_location(stem, path)
    if spec is None or spec.loader is None:
        raise ImportError(name)
    module = module_from_spec(spec)
    sys.modules[stem] = module  # classes are told by the names of their modules
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[stem]
        raise
