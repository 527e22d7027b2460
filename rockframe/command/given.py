"""What commands share: the scene, motion and run that were typed, and files that are written."""

import argparse
from pathlib import Path
from typing import Any

import xarray as xr

from rockframe.command.files.scenes import Described, read_scene
from rockframe.errors import ComponentError, FileError, SolverError
from rockframe.motion import GroundMotion
from rockframe.simulation.system import System
from rockframe.solve.accuracy import accuracy_of


def motion_from(path: str, arguments: argparse.Namespace) -> GroundMotion:
    """Read the file of a motion as the options for reading say."""
    step = {} if arguments.time_step is None else {"time_step": arguments.time_step}
    return GroundMotion.read(path, component=arguments.component, unit=arguments.unit, **step)


def scene_from(arguments: argparse.Namespace) -> Described:
    """Read the scene, with the motion and the arguments of the run that options give instead.

    Parameters
    ----------
    arguments : argparse.Namespace
        Of ``run`` or ``certify``.

    Returns
    -------
    Described
    """
    found = read_scene(arguments.scene)
    motion = found.motion
    if arguments.motion is not None:
        motion = motion_from(arguments.motion, arguments)
    if arguments.scale is not None and motion is not None:
        motion = motion.scaled(arguments.scale)
    run = found.run | _run_options(arguments)
    if arguments.duration is not None:
        run.pop("free_vibration", None)
    if arguments.free_vibration is not None and arguments.duration is None:
        run.pop("duration", None)
    return Described(found.system, motion, run)


def simulated(found: Described, **more: Any) -> xr.Dataset:
    """Simulate what a file describes."""
    return found.system.simulate(found.motion, **{**found.run, **more})


def check_folder(path: str | None) -> None:
    """Refuse a file that cannot be written, before the work and not after it.

    Raises
    ------
    FileError
        Its folder is not there, or it is a folder itself.
    """
    if path is None:
        return
    place = Path(path).expanduser()
    if place.is_dir():
        raise FileError(path, [(None, "this is a folder; name a file in it")])
    if not place.parent.is_dir():
        raise FileError(path, [(None, f"there is no folder {str(place.parent)!r}")])


def opened(path: str) -> xr.Dataset:
    """Read a result.

    Raises
    ------
    FileError
        There is none, or it is no netCDF file.
    """
    place = Path(path).expanduser()
    if not place.is_file():
        raise FileError(path, [(None, "there is no such file")])
    try:
        with xr.open_dataset(place) as dataset:
            return dataset.load()
    except (OSError, ValueError) as problem:
        words = "this is no netCDF file; give what 'rockframe run' or 'study' has written with -o"
        raise FileError(path, [(None, words)]) from problem


def written(dataset: xr.Dataset, path: str | None) -> None:
    """Write a result, if a file was named, and say so."""
    if path is not None:
        dataset.to_netcdf(Path(path).expanduser())
        print(f"Results: {path}")


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
