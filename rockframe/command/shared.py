"""Shared by commands: reads the scene, motion and run that were typed, and writes files."""

import argparse
import csv
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import closing, suppress
from dataclasses import replace
from functools import partial
from math import floor
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.arguments import READING_OPTIONS
from rockframe.command.files.scenes import SceneDescription, read_scene
from rockframe.command.files.tables import arguments_of
from rockframe.command.streams import (
    STANDARD_INPUT_NAME,
    STREAM,
    StandardInput,
    TerminalProgressBar,
    open_input,
)
from rockframe.command.typed_calls import parse_value
from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import (
    ComponentError,
    FileError,
    ModelWarning,
    RecordError,
    SolverError,
    short_repr,
    warn,
)
from rockframe.motion import GroundMotion
from rockframe.reports.project import PROJECT_ATTRIBUTE
from rockframe.results.table import head_of
from rockframe.results.variables.variable import unit_suffix_of
from rockframe.simulation.system import System
from rockframe.solve.accuracy import accuracy_of
from rockframe.studies.intensities import PERIOD_ATTRIBUTE, measure_words
from rockframe.studies.sweeps.chunk import SCREEN
from rockframe.studies.sweeps.labelling import cautions_of_result
from rockframe.suites import MotionSuite, read_suite
from rockframe.units import Unit
from rockframe.writing import Content, FileKind, checked_path, write_file

if TYPE_CHECKING:
    import pandas as pd

_RESULT_HINT: Final = "name a file that 'rockframe run' or 'study' wrote with -o"
_NO_MOTION: Final = (
    "there is no motion; name a record with --motion, or describe one in the file, in [motion]"
)
_SCREENING_COMMANDS: Final = ("fragility", "ida", "map")
"""Commands whose runs are those of sweeps, which may screen."""
_MAX_VALUES: Final = 100_000
_MAX_HEADER_SIZE: Final = 65536
"""Largest part of the first line of a table that is read [bytes]."""


def motion_from(path: str, arguments: argparse.Namespace) -> GroundMotion:
    """Read the file of a motion with the options for reading."""
    return GroundMotion.read(open_input(path, "a record"), **reading_options(arguments))


def suite_from(paths: Sequence[str], arguments: argparse.Namespace) -> MotionSuite:
    """Read all records of files, archives and folders."""
    files = [open_input(path, "a record") for path in paths]
    value = files[0] if len(files) == 1 else files
    return read_suite(value, unit=arguments.unit, time_step=arguments.time_step)


def motions_from(arguments: argparse.Namespace) -> Mapping[str, GroundMotion]:
    """Read the component of each file that is named, else all components."""
    paths = arguments.files
    if arguments.component is not None:
        motions = [motion_from(path, arguments) for path in paths]
        return {f"{number}: {motion.name}": motion for number, motion in enumerate(motions, 1)}
    try:
        return suite_from(paths, arguments)
    except RecordError:
        if len(paths) > 1 or paths[0] == STREAM:
            raise
        with suppress(RecordError):  # a file of a vertical component alone, read with a warning
            motion = motion_from(paths[0], arguments)
            return {motion.name: motion}
        raise


def scene_from(arguments: argparse.Namespace, *, needs_motion: bool = False) -> SceneDescription:
    """Read the scene; options replace its motion and arguments of its run."""
    scene = read_scene(arguments.scene)
    motion, files = scene.motion, scene.files
    if arguments.motion is None:
        refuse_reading_options(arguments, "name one with --motion")
    else:
        motion = motion_from(arguments.motion, arguments)
        files += (Path(arguments.motion),)
    if needs_motion and motion is None:
        raise FileError(arguments.scene, _NO_MOTION)
    if arguments.scale is not None:
        if motion is None:
            words = f"--scale {arguments.scale:g} multiplies a motion, and {_NO_MOTION}"
            raise FileError(arguments.scene, words)
        motion = motion.scaled(arguments.scale)
    return replace(scene, motion=motion, run=run_from(scene.run, arguments), files=files)


def refuse_reading_options(arguments: argparse.Namespace, advice: str) -> None:
    """Refuse options on how a record is read, where no record is named."""
    for option in READING_OPTIONS:
        value = getattr(arguments, option.attribute, None)
        if value is not None:
            msg = f"{option.name} {value}: this says how a record is read; {advice}"
            raise ComponentError(msg)


def check_format(arguments: argparse.Namespace) -> None:
    """Refuse a format together with the name of a file, whose ending gives the format."""
    if arguments.format is not None and arguments.output != STREAM:
        msg = (
            f"--format {arguments.format}: this option is for the standard output, -o -; the "
            f"format of a file follows from its ending, here {arguments.output}"
        )
        raise ComponentError(msg)


def run_from(of_file: Mapping[str, Any], arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the arguments of a run: those of a file, replaced by options that were typed."""
    run = {**of_file, **typed_options(arguments, "duration", "free_vibration")}
    if arguments.accuracy is not None:
        run["accuracy"] = _read_accuracy(arguments.accuracy, arguments.command)
    if arguments.duration is not None and arguments.free_vibration is None:
        run.pop("free_vibration", None)
    if arguments.free_vibration is not None and arguments.duration is None:
        run.pop("duration", None)
    return run


def arguments_accepted_by(function: Callable[..., Any], run: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of a run that an analysis takes too."""
    known = arguments_of(function)
    return {name: value for name, value in run.items() if name in known}


def reading_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the typed options on how a record is read."""
    return typed_options(arguments, *(option.attribute for option in READING_OPTIONS))


def typed_options(arguments: argparse.Namespace, *names: str) -> dict[str, Any]:
    """Return the options that were typed, by their names."""
    values = {name: getattr(arguments, name) for name in names}
    return {name: value for name, value in values.items() if value is not None}


def store_from(arguments: argparse.Namespace) -> Path | None:
    """Return the folder of the store that was typed; refuse an empty name, the current folder."""
    if arguments.store == "":
        msg = "found no name of a folder after --store; expected one, such as --store kept"
        raise ComponentError(msg)
    return None if arguments.store is None else Path(arguments.store).expanduser()


def parse_numbers(words: str, option: str, example: str) -> tuple[list[float], str]:
    """Read numbers but zero, listed or from:to:step, with a unit where the example has one."""
    numbers, _, unit = words.strip().partition(" ")
    unit = unit.strip()
    try:
        if ":" not in numbers:
            values = [float(number) for number in numbers.split(",")]
        else:
            values = _range_values(*map(float, numbers.split(":")))
        if (" " in example) != bool(unit):
            raise ValueError
    except (TypeError, ValueError, ZeroDivisionError):
        with_unit = " followed by their unit" if " " in example else " without a unit"
        msg = (
            f"{option}: expected numbers{with_unit}, as from:to:step, such as '{example}', or "
            f"listed with commas, decimals with a point; got {short_repr(words)}"
        )
        raise ComponentError(msg) from None
    if 0.0 in values:
        msg = (
            f"{option}: expected numbers other than zero, got {', '.join(f'{x:g}' for x in values)}"
            f" from {short_repr(words)}; commas separate numbers, decimals have a point, as in 0.5"
        )
        raise ComponentError(msg)
    return values, unit


def _range_values(start: float, end: float, step: float) -> list[float]:
    count = (end - start) / step
    if not 0.0 <= count <= _MAX_VALUES:
        raise ValueError
    # a step such as 0.1 has no exact binary form
    return [round(start + k * step, 12) for k in range(1 + floor(count + 1e-9))]


def simulate_scene(scene: SceneDescription, **more: Any) -> xr.Dataset:
    """Simulate what a file describes."""
    return with_project(scene.system.simulate(scene.motion, **{**scene.run, **more}), scene.project)


def run_analysis(
    analysis: Callable[..., xr.Dataset],
    description: Any,
    motions: object,
    values: Mapping[str, Any],
    arguments: argparse.Namespace,
) -> xr.Dataset:
    """Analyse what a file describes, with a progress bar."""
    with closing(TerminalProgressBar(arguments.command, enabled=not arguments.quiet)) as bar:
        dataset = analysis(description.system, motions, **values, progress=bar)
    return with_project(dataset, description.project)


def with_project(dataset: xr.Dataset, project: str) -> xr.Dataset:
    """Keep the project of the scene's file in a result."""
    return dataset.assign_attrs({PROJECT_ATTRIBUTE: project}) if project else dataset


def intensity_text(value: xr.DataArray, of: xr.Dataset) -> str:
    """Write an intensity measure: its name, value and unit; of an acceleration also in g."""
    name = measure_words(str(value.name), of.attrs.get(PERIOD_ATTRIBUTE))
    return f"{name} {amount_text(float(value), value.attrs)}"


def amount_text(value: float, attributes: Mapping[Any, Any]) -> str:
    """Write a number with its unit; of an acceleration also in g."""
    text = f"{value:.4g}{unit_suffix_of(attributes)}"
    if attributes.get("units") == Unit.METRE_PER_SECOND_SQUARED:
        text += f" ({value / STANDARD_GRAVITY:.3g} g)"
    return text


class Outputs:
    """The files that a command writes, and those that it must not overwrite."""

    def __init__(
        self,
        arguments: argparse.Namespace,
        read: Iterable[str | Path],
        answer: Answer,
        **kinds: FileKind,  # of the files that options name, checked before the work begins
    ) -> None:
        self._write_options: dict[str, Any] = {"overwrite": arguments.overwrite, "read": list(read)}
        self._answer = answer
        self._stream_format: str | None = getattr(arguments, "format", None)
        self._named_files = {name: (getattr(arguments, name), kind) for name, kind in kinds.items()}
        for path, kind in self._named_files.values():
            self.check(path, kind)

    def check(self, path: str | Path | None, kind: FileKind) -> None:
        """Raise if a file must not be written."""
        if path is not None and str(path) == STREAM:
            self._answer.reserve_stdout(self._stream_format or kind.suffixes[0])
        elif path is not None:
            checked_path(path, kind, **self._write_options)

    def write(self, path: str | Path | None, kind: FileKind, title: str, content: Content) -> None:
        """Write a file, if one was named, and report it."""
        if path is None:
            return
        if str(path) == STREAM:
            save = partial(write_file, kind=kind, content=content)
            self._answer.data = _saved_bytes(save, kind.suffixes[0])
            return
        write_file(path, kind, content, **self._write_options)
        self._answer.add_file(title, path)

    def write_result(self, dataset: xr.Dataset) -> None:
        """Write a result to the file of ``--output``, if there is one, and report it."""
        self.write(*self._named_files["output"], "Results", dataset.to_netcdf)

    def save_by(
        self,
        path: str | Path,
        kind: FileKind,
        ending: str,
        title: str,
        save: Callable[[Path], object],
    ) -> None:
        """Write by a function of a path to a file, or to the standard output; report the file."""
        if str(path) == STREAM:
            self._answer.data = _saved_bytes(save, ending)
            return
        checked_path(path, kind, **self._write_options)
        save(Path(path))
        self._answer.add_file(title, path)

    def write_table(self, values: "pd.DataFrame") -> None:
        """Write a table to the file of ``--csv``, if there is one, and report it."""
        self.write(*self._named_files["csv"], "Table", lambda part: values.to_csv(part))


def _saved_bytes(save: Callable[[Path], object], ending: str) -> bytes:
    """Return the bytes of a file whose name has an ending."""
    with TemporaryDirectory() as folder:
        part = Path(folder) / f"file{ending}"
        save(part)
        return part.read_bytes()


def is_result(path: str) -> bool:
    """Whether a path is that of a result or of a store, not of a scene."""
    place = Path(path).expanduser()
    return place.suffix.lower() == ".nc" or place.is_dir()


def read_result(path: str) -> xr.Dataset:
    """Read a result, and repeat its cautions."""
    dataset = _read_result(path)
    for text in cautions_of_result(dataset):
        warn(text, ModelWarning)
    return dataset


def _read_result(path: str) -> xr.Dataset:
    if path == STREAM:
        with TemporaryDirectory() as folder:
            copy = Path(folder) / "result.nc"
            copy.write_bytes(StandardInput.read_for("a result").getvalue())
            return _open_result(copy, STANDARD_INPUT_NAME)
    return _open_result(Path(path).expanduser(), path)


def _open_result(place: Path, path: str) -> xr.Dataset:
    if not place.is_file():
        fault = "this is a folder" if place.is_dir() else "there is no such file"
        raise FileError(path, f"{fault}; {_RESULT_HINT}")
    try:
        with xr.open_dataset(place) as dataset:
            return dataset.load()
    except MemoryError:
        raise
    except Exception as problem:  # damaged files raise exceptions that are not documented
        raise FileError(path, f"this is no netCDF file; {_RESULT_HINT}") from problem


def result_kind(words: str, *, axes: bool) -> FileKind:
    """Return the kind of file of results, of one run or of a study with axes."""

    def fits(dataset: xr.Dataset) -> bool:
        known = {*dataset.attrs}
        return _is_computed(dataset) and "run_json" in known and axes == ("axes_json" in known)

    return dataset_kind(words, fits)


def _is_computed(dataset: xr.Dataset) -> bool:
    return str(dataset.attrs.get("source", "")).startswith("rockframe ")


def dataset_kind(words: str, fits: Callable[[xr.Dataset], bool]) -> FileKind:
    """Return a kind of netCDF file, recognised by its contents."""

    def is_own(path: Path) -> bool:
        try:
            with xr.open_dataset(path, decode_cf=False) as dataset:
                return fits(dataset)
        except Exception:  # whatever the libraries raise on files of other formats
            return False

    return FileKind(words, (".nc",), is_own)


def table_kind(words: str, *names: str, also: Iterable[str] = ()) -> FileKind:
    """Return kind of table in CSV, recognised by heads of columns that only rockframe writes."""
    heads = (*also, *map(head_of, names))

    def is_own(path: Path) -> bool:
        with path.open("rb") as file:
            head = file.readline(_MAX_HEADER_SIZE).decode("utf-8", "replace")
        columns = next(csv.reader([head]), [])
        return all(head in columns for head in heads)

    return FileKind(words, (".csv",), is_own)


def analysis_kind(words: str, *names: str) -> FileKind:
    """Return the kind of file of an analysis, recognised by its variables."""
    return dataset_kind(
        words, lambda dataset: _is_computed(dataset) and {*names} <= {*dataset.variables}
    )


RUN_KIND: Final = result_kind("the result of a run", axes=False)
STUDY_KIND: Final = result_kind("the result of a study", axes=True)


def motion_summary(motion: GroundMotion) -> str:
    """Write the number of samples, the time step, the length and the peak of a motion."""
    peak = motion.peak_acceleration.to("m/s^2").magnitude
    return (
        f"{len(motion)} samples at {motion.si.time_step:g} s, {motion.si.duration:g} s long, "
        f"peak {peak:.4g} m/s^2 ({peak / STANDARD_GRAVITY:.3g} g)"
    )


def part_names(system: System) -> str:
    """Name the parts of a system in one line."""
    return ", ".join(type(part).__name__ for part in system.parts.structural())


def _read_accuracy(text: str, command: str) -> str | float:
    if text == SCREEN and command in _SCREENING_COMMANDS:
        return text
    value = parse_value(text)
    try:
        accuracy_of(value, owner="--accuracy")
    except SolverError as problem:
        words = str(problem).replace(" or an Accuracy(...)", "")
        words = re.sub("^Accuracy: ", "--accuracy: ", words)
        words = words.replace("--accuracy: accuracy ", "--accuracy ")  # the name once
        raise ComponentError(words) from problem
    return value
