"""A study in a TOML file: a scene, motions, and axes or a table of cases."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from glob import glob
from pathlib import Path
from typing import Any, Final

from rockframe.command.files.scenes import (
    AXES,
    CASES,
    PROJECT,
    RUN,
    SceneDescription,
    build_motion,
    build_run_objects,
    build_scene,
    import_modules,
    project_from_table,
    read_scene,
    scene_keys,
)
from rockframe.command.files.tables import (
    TomlFile,
    arguments_of,
    call_with_table,
    check_table,
    key_in_message,
    read_columns,
)
from rockframe.errors import FileError, RockframeError, StudyError, short_repr
from rockframe.motion import GroundMotion
from rockframe.simulation.system import System
from rockframe.studies import sweep
from rockframe.suites import read_suite

SCENE: Final = "scene"
MOTIONS: Final = "motions"
STORE: Final = "store"
OUTPUT: Final = "output"
SWEEP: Final = "sweep"
KNOWN: Final = "known"
KEYS: Final = (SCENE, MOTIONS, AXES, CASES, STORE, OUTPUT, SWEEP)
"""Keys of the file of a study, besides the tables of its scene."""
_NOT_SWEEP_KEYS: Final = (SCENE, MOTIONS, AXES, CASES, STORE, "executor", "progress")
_RUN_ARGUMENTS: Final = ("duration", "free_vibration", "initial", "accuracy", "output_step",
                    "overturning")  # fmt: skip
"""Arguments of a run that its study takes over from the file of the scene."""

Motions = Mapping[str, GroundMotion] | Sequence[GroundMotion] | GroundMotion | None


@dataclass(frozen=True)
class StudyDescription:
    """What the file of a study describes."""

    system: System  # the scene
    motions: Motions  # as :func:`rockframe.sweep` takes them
    arguments: dict[str, Any]  # further arguments of :func:`rockframe.sweep`
    store: Path | None  # folder of finished cases
    output: Path | None  # file of the results
    files: tuple[Path, ...]  # all files and folders that were read
    project: str  # the project in JSON, as results keep it
    source: TomlFile  # the file of the study

    def at_lines(self, problem: StudyError) -> FileError:
        """Return the faults of a study with the lines of its file."""
        arguments = {name: self.source.values.get(name) for name in (AXES, SWEEP)}
        tables = {name: table for name, table in arguments.items() if isinstance(table, dict)}
        if CASES in self.arguments:
            heads = map(str, self.arguments[CASES].columns)
            tables[CASES] = {head.partition(" [")[0].strip(): None for head in heads}
        for words in problem.faults:
            places = [key_in_message(words, (name,), table) for name, table in tables.items()]
            self.source.add_fault(max(places, key=len, default=(CASES,)), words)
        return self.source.error()


def read_study(path: str | Path, *, needs_axes: bool = True) -> StudyDescription:
    """Read the file of a study; unless `needs_axes`, it may be a scene alone."""
    file = TomlFile.read(path)
    import_modules(file)  # before the keys are checked: its parts may add tables
    for name in file.values:
        if name not in (*KEYS, *scene_keys()):
            file.add_unknown_key((), name, (*KEYS, *scene_keys()))
    scene = _read_scene(file)
    motions = _read_motions(file)
    arguments = _read_sweep(file) | _read_axes(file)
    store, output = (_read_path(file, name) for name in (STORE, OUTPUT))
    if needs_axes and AXES not in file.values and CASES not in file.values:
        file.add_fault((), "a study needs [axes], such as scale = [0.5, 1.0, 1.5], or cases")
    if scene is None or not file.is_valid:
        raise file.error()
    run_arguments = {name: value for name, value in scene.run.items() if name in _RUN_ARGUMENTS}
    motions_used = scene.motion if motions is None else motions
    files = (*file.files, *scene.files)
    return StudyDescription(
        scene.system, motions_used, run_arguments | arguments, store, output, files,
        scene.project, file,
    )  # fmt: skip


def sweep_keys() -> dict[str, bool]:
    """Return the keys of the table of a sweep, and whether each is needed."""
    return arguments_of(sweep, without=_NOT_SWEEP_KEYS)


def _read_scene(file: TomlFile) -> SceneDescription | None:
    name = file.values.get(SCENE)
    if name is None:
        return build_scene(file)
    inner = [key for key in file.values if key in scene_keys() and key != PROJECT]
    for key in inner:
        where = "; arguments of the runs of a study belong in [sweep]" if key == RUN else ""
        words = (
            f"[{key}] and scene = {short_repr(name)} are both given; give only one of them{where}"
        )
        file.add_fault((key,), words)
    if not isinstance(name, str):
        file.add_fault((SCENE,), f"scene must be the path of a file, got {short_repr(name)}")
        return None
    try:
        scene = read_scene(file.path_relative_to(name))
    except FileError as problem:
        file.add_fault((SCENE,), f"the scene has faults\n{problem}")
        return None
    if PROJECT in file.values:  # the project of the study replaces that of the scene
        return replace(scene, project=project_from_table(file, file.values[PROJECT]))
    return scene


def _read_motions(file: TomlFile) -> Motions:
    """Read motions: a list of files, folders and patterns, or of tables."""
    value = file.values.get(MOTIONS)
    if value is None:
        return None
    where = (MOTIONS,)
    items: list[Any] = value if isinstance(value, list) else [value]
    if items and all(isinstance(item, dict) for item in items):
        motions = [build_motion(file, (MOTIONS, number), item) for number, item in enumerate(items)]
        return [motion for motion in motions if motion is not None]
    if not items or not all(isinstance(item, str) for item in items):
        words = 'motions must be a list of files, folders or patterns such as ["records/*.AT2"]'
        file.add_fault(where, f"{words}, or of tables [[motions]]; got {short_repr(value)}")
        return None
    paths: list[str] = []
    for item in items:
        path = str(file.path_of(item))
        matching = sorted(glob(path)) if any(mark in item for mark in "*?[") else [path]
        file.files += map(Path, matching)
        if not matching:
            file.add_fault(where, f"no file matches {item!r} in {str(file.path.parent)!r}")
        paths += matching
    if not file.is_valid:
        return None
    suite = call_with_table(file, where, lambda: read_suite(paths), {})
    return None if suite is None else dict(suite.items())


def _read_axes(file: TomlFile) -> dict[str, Any]:
    arguments: dict[str, Any] = {}
    if AXES in file.values:
        axes = file.table((AXES,), file.values[AXES]) or {}
        arguments[AXES] = {name: _read_axis(file, name, given) for name, given in axes.items()}
    if CASES in file.values:
        name = file.values[CASES]
        try:
            arguments[CASES] = read_columns(file.path_relative_to(str(name)))
        except (OSError, ValueError) as problem:
            file.add_fault((CASES,), f"{name}: the table cannot be read ({problem})")
    return arguments


def _read_axis(file: TomlFile, name: str, value: object) -> Any:
    """Return the values of an axis: a list, or a table of values and their unit."""
    if not isinstance(value, dict):
        return value
    where = (AXES, name)
    table = file.table(where, value) or {}
    if table and not {"values", "unit"}.intersection(table):
        written = f'"{name}.{next(iter(table))}" = [...]'
        file.add_fault(where, f"write the axis of a part in quotation marks: {written}")
        return []
    if check_table(file, where, table, {"values": True, "unit": True}):
        return (table["values"], table["unit"])
    return []


def _read_sweep(file: TomlFile) -> dict[str, Any]:
    table = file.table((SWEEP,), file.values.get(SWEEP, {}))
    if table is None or not check_table(file, (SWEEP,), table, sweep_keys()):
        return {}
    if KNOWN in table:  # stores, relative to the folder of the file
        paths = table[KNOWN] if isinstance(table[KNOWN], list) else [table[KNOWN]]
        table[KNOWN] = [file.path_of(path) if isinstance(path, str) else path for path in paths]
    try:
        return build_run_objects(file, (SWEEP,), table)
    except RockframeError as problem:
        file.add_fault((SWEEP,), str(problem))
        return {}


def _read_path(file: TomlFile, name: str) -> Path | None:
    value = file.values.get(name)
    if value is None:
        return None
    if not isinstance(value, str) or not value:
        file.add_fault((name,), f"{name} must be a path, got {short_repr(value)}")
        return None
    return file.path_of(value)
