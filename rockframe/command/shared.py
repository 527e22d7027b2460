"""What commands share: the scene, motion and run that were typed, and files that are written."""

import argparse
import csv
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import xarray as xr

from rockframe.command.files.scenes import Described, read_scene
from rockframe.errors import ComponentError, FileError, SolverError
from rockframe.motion import GroundMotion
from rockframe.reports.project import ATTRIBUTE
from rockframe.results.table import head_of
from rockframe.simulation.system import System
from rockframe.solve.accuracy import accuracy_of
from rockframe.writing import Content, FileKind, checked_path, write_file

if TYPE_CHECKING:
    import pandas as pd

_OF_RESULTS: Final = "give what 'rockframe run' or 'study' has written with -o"
_LONGEST_HEAD: Final = 65536
"""Most of the first line of a table that is read [bytes]."""


def motion_from(path: str, arguments: argparse.Namespace) -> GroundMotion:
    """Read the file of a motion as the options for reading say."""
    step = {} if arguments.time_step is None else {"time_step": arguments.time_step}
    return GroundMotion.read(path, component=arguments.component, unit=arguments.unit, **step)


def scene_from(arguments: argparse.Namespace) -> Described:
    """Read the scene, with the motion and the arguments of the run that options give instead."""
    found = read_scene(arguments.scene)
    motion, files = found.motion, found.files
    if arguments.motion is not None:
        motion = motion_from(arguments.motion, arguments)
        files += (Path(arguments.motion),)
    if arguments.scale is not None and motion is not None:
        motion = motion.scaled(arguments.scale)
    run = found.run | _run_options(arguments)
    if arguments.duration is not None and arguments.free_vibration is None:
        run.pop("free_vibration", None)
    if arguments.free_vibration is not None and arguments.duration is None:
        run.pop("duration", None)
    return replace(found, motion=motion, run=run, files=files)


def simulated(found: Described, **more: Any) -> xr.Dataset:
    """Simulate what a file describes."""
    return with_project(found.system.simulate(found.motion, **{**found.run, **more}), found.project)


def with_project(dataset: xr.Dataset, project: str) -> xr.Dataset:
    """Let a result keep what its file says of the project."""
    return dataset.assign_attrs({ATTRIBUTE: project}) if project else dataset


class Outputs:
    """The files that a command writes, and those that it must not write over."""

    def __init__(self, arguments: argparse.Namespace, read: Iterable[str | Path]) -> None:
        self._given: dict[str, Any] = {"overwrite": arguments.overwrite, "read": list(read)}

    def check(self, path: str | Path | None, kind: FileKind) -> None:
        """Refuse a file that must not be written, before the work and not after it."""
        if path is not None:
            checked_path(path, kind, **self._given)

    def write(self, path: str | Path | None, kind: FileKind, title: str, content: Content) -> None:
        """Write a file, if one was named, and say so."""
        if path is not None:
            write_file(path, kind, content, **self._given)
            print(f"{title}: {path}")

    def result(self, path: str | Path | None, kind: FileKind, dataset: xr.Dataset) -> None:
        """Write a result, if a file was named, and say so."""
        self.write(path, kind, "Results", dataset.to_netcdf)

    def table(self, path: str | None, kind: FileKind, values: "pd.DataFrame") -> None:
        """Write a table, if a file was named, and say so."""
        self.write(path, kind, "Table", lambda part: values.to_csv(part))


def read_result(path: str) -> xr.Dataset:
    """Read a result."""
    place = Path(path).expanduser()
    if not place.is_file():
        found = "this is a folder" if place.is_dir() else "there is no such file"
        raise FileError(path, [(None, f"{found}; {_OF_RESULTS}")])
    try:
        with xr.open_dataset(place) as dataset:
            return dataset.load()
    except (OSError, ValueError) as problem:
        raise FileError(path, [(None, f"this is no netCDF file; {_OF_RESULTS}")]) from problem


def result_kind(words: str, *, axes: bool) -> FileKind:
    """Give the kind of file of results, of one run or along axes."""

    def is_own(path: Path) -> bool:
        try:
            with xr.open_dataset(path, decode_cf=False) as found:
                attributes: dict[Any, Any] = dict(found.attrs)
        except Exception:  # whatever the libraries raise of files that are none
            return False
        computed = str(attributes.get("source", "")).startswith("rockframe ")
        return computed and "run_json" in attributes and axes == ("axes_json" in attributes)

    return FileKind(words, (".nc",), is_own)


def table_kind(words: str, *names: str) -> FileKind:
    """Give the kind of table in CSV whose head has variables as only rockframe writes them."""

    def is_own(path: Path) -> bool:
        with path.open("rb") as file:
            head = file.readline(_LONGEST_HEAD).decode("utf-8", "replace")
        columns = next(csv.reader([head]), [])
        return all(head_of(name) in columns for name in names)

    return FileKind(words, (".csv",), is_own)


RUN: Final = result_kind("the result of a run", axes=False)
STUDY: Final = result_kind("the result of a study", axes=True)


def printed(values: Any) -> str:
    """Set a table of pandas in columns, numbers with four digits."""
    return values.to_string(float_format=lambda value: f"{value:.4g}")


def system_words(system: System) -> str:
    """Name the parts of a system in a line."""
    return ", ".join(type(part).__name__ for part in system.parts.structural())


def _run_options(arguments: argparse.Namespace) -> dict[str, Any]:
    given: dict[str, Any] = {
        name: getattr(arguments, name)
        for name in ("duration", "free_vibration")
        if getattr(arguments, name) is not None
    }
    if arguments.accuracy is not None:
        given["accuracy"] = _accuracy(arguments.accuracy)
    return given


def _accuracy(text: str) -> str | float:
    try:
        given: str | float = float(text)
    except ValueError:
        given = text
    try:
        accuracy_of(given)
    except SolverError as problem:
        msg = f"--accuracy: {problem}"
        raise ComponentError(msg) from problem
    return given
