"""The datasets that figures are drawn from, and messages on anything else."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from inspect import signature
from os import PathLike
from textwrap import fill, indent
from typing import Any, Final, TypeVar, cast

import numpy as np
import xarray as xr

from rockframe.arguments import json_attribute
from rockframe.errors import RockframeWarning, SchemaError, first_along
from rockframe.motion import GroundMotion
from rockframe.results.schema import in_units_of_schema, labels_in_unit
from rockframe.shared_arguments import (
    Argument,
    completed_docstring,
    with_raises_section,
    with_section,
)
from rockframe.simulation.system import System
from rockframe.studies.sweeps.case import SweepCase, system_of_case
from rockframe.suggestions import with_hints
from rockframe.units import POSITIVE, Unit, to_ratio
from rockframe.units.display import KINDS as SHOWN_KINDS
from rockframe.units.display import UnitsLike, display_units

FigureFunction = TypeVar("FigureFunction", bound=Callable[..., Any])


@dataclass(frozen=True)
class DatasetKind:
    """A kind of dataset that a function draws."""

    name: str  # in messages
    call: str  # the call that gives it
    identifying: tuple[str, ...]  # variables by which it is recognised
    required: tuple[str, ...] = ()  # further variables that are drawn
    along: tuple[str, ...] = ()  # dimensions along which they are drawn

    @property
    def description(self) -> str:
        """Its name, and the call that gives it."""
        return f"{self.name}, as {self.call} gives it" if self.call else self.name


RUN: Final = DatasetKind(
    "the result of one run with histories",
    "system.simulate(motion)",
    ("rotation", "time", "overturned"),
    (
        "ground_acceleration",
        "relative_rotation",
        "contact_state",
        "overturning_angle",
        "uplift_angle",
    ),
)
KINDS: Final[dict[str, DatasetKind]] = {}
"""Kinds recognised by their variables, by the function that draws them."""
_REQUIRED_DATA: Final[dict[str, str]] = {}
"""The kind that each function draws, in words."""
SWEEP_ATTRIBUTE: Final = "axes_json"
"""Attribute of sweeps and of their cases."""
_RUN_SCALARS: Final = ("overturned", "peak_rotation")
_UNDRAWN_KINDS: Final = (
    # (variables, their name in messages, how to draw them); the first match counts
    (RUN.identifying, "the result of a run", "rf.plot.response draws it"),
    (
        _RUN_SCALARS,
        "the result of a run without histories",
        "simulate with outputs=() instead of None",
    ),
    (
        ("pseudo_spectral_acceleration",),
        "response spectra",
        "rf.plot.spectra draws them from the motion itself",
    ),
    (
        ("fourier_amplitude",),
        "a Fourier spectrum",
        "rf.plot.spectra draws it from the motion itself",
    ),
    (
        ("ground_velocity",),
        "velocity and displacement of the ground",
        "rf.plot.motion draws them from the motion itself",
    ),
)


_UNITS_DOC: Final = (
    "Units by quantity, such as ``{'acceleration': 'g', 'force': 'kN'}``: of "
    f"{', '.join(SHOWN_KINDS)}. An argument for the unit of a single axis overrides it; "
    "dimensionless values remain as they are."
)


def draws(
    data: str | DatasetKind, call: str = "", known: tuple[str, ...] = (),
    needed: tuple[str, ...] = (), *, along: tuple[str, ...] = (), ax: str = "Axes", title: str = "",
) -> Callable[[FigureFunction], FigureFunction]:  # fmt: skip
    """Register what a figure is drawn from, for a dataset by a `DatasetKind`.

    Add to the docstring the arguments that figures share, what is returned, and errors. The words
    `ax` and `title` describe the Axes and the default title in the manual.
    """
    kind = data if isinstance(data, DatasetKind) else DatasetKind(data, call, known, needed, along)
    default_title = f"; {title} unless given" if title else ""
    in_figure = "" if ax == "Axes" else " A figure or subfigure gets new panels."
    shared = {
        "dataset": Argument(
            None, "xarray.Dataset", f"Result of :func:`rockframe.{call[3:].partition('(')[0]}`."
        ),
        "run": Argument(None, "xarray.Dataset", "A result with histories."),
        "window": Argument(
            None,
            "(str or Quantity or None, str or Quantity or None), optional",
            "Start and end of what is drawn; the whole run unless given [s].",
        ),
        "magnify": Argument(
            None, "float, optional", "Factor of displacements in the drawing of the scene [1]."
        ),
        "rotation": Argument(
            None,
            "str, optional",
            "Unit of the history, as for :func:`rockframe.plot.response`; degrees unless given.",
        ),
        "units": Argument(None, "mapping of str to str, optional", _UNITS_DOC),
        "ax": Argument(
            None, f"{ax}, optional", f"Axes to draw in; a new figure unless given.{in_figure}"
        ),
        "title": Argument(None, "str, optional", f"Title of the figure{default_title}."),
    }
    mismatch = (
        f"The dataset is not {kind.name}; the message names the function that draws what was given."
    )
    raises = f"SchemaError\n{indent(fill(mismatch, 88), '    ')}"
    if kind is RUN:
        raises += (
            "\nUnitsError, ComponentError\n    An argument that cannot be read or is out of range, "
            "such as a window without samples."
        )

    def decorate(drawing: FigureFunction) -> FigureFunction:
        name, text = drawing.__name__, drawing.__doc__ or ""
        text = completed_docstring(text, signature(drawing).parameters, shared)
        drawn = "matplotlib.axes.Axes" if ax == "Axes" else "Panels"
        text = with_section(text, "Returns", drawn, ("Raises", "Notes", "Examples"))
        _REQUIRED_DATA[name] = kind.description
        if known:
            KINDS[name] = kind
        if known or kind is RUN:
            text = with_raises_section(text, raises)
        drawing.__doc__ = text
        return with_hints()(drawing)

    return decorate


def _function_for(dataset: xr.Dataset) -> str | None:
    """Return the function of the most special kind: a cloud has a fragility's variables, too."""
    matches = [
        (len(kind.identifying), name)
        for name, kind in KINDS.items()
        if _has_variables(dataset, kind.identifying)
    ]
    return max(matches)[1] if matches else None


def figure_function_name(dataset: xr.Dataset) -> str:
    """Return the function that draws a dataset."""
    if (function := _function_for(dataset)) is not None:
        return function
    if _has_variables(dataset, ("relative_rotation", "time", "contact_state")):
        return "response"
    if "peak_relative_rotation" in dataset and dataset["peak_relative_rotation"].ndim > 0:
        return "sweep"
    known = "known are results of runs, sweeps, studies and comparisons"
    what, way = _describe_undrawn(dataset) or ("this dataset", known)
    msg = f"no function of rf.plot draws {what}; {way}"
    raise SchemaError(msg)


def checked_run(value: object, function: str) -> xr.Dataset:
    """Return the result of one run with histories up to its end; raise on anything else."""
    owner = f"rf.plot.{function}"
    value = in_units_of_schema(_checked_kind(value, function, RUN), owner=owner)
    value = value.assign_coords(
        time=labels_in_unit(value["time"], Unit.SECOND, owner=owner).variable
    )
    for name in (*RUN.identifying, *RUN.required):
        if value[name].dtype.kind not in "fiub":
            raise _mismatch_error(function, f"one whose {name!r} holds no numbers")
    more = [str(name) for name in value["relative_rotation"].dims if name != "time"]
    if more:
        way = f"pick one, for example with {first_along('dataset', more[0])}"
        raise _mismatch_error(function, f"several runs over {', '.join(more)}; {way}")
    # histories of a case of a sweep have NaN up to the length of the longest case
    samples = np.flatnonzero(~np.isnan(value["relative_rotation"].to_numpy()))
    if not len(samples):
        raise _mismatch_error(function, "a case without a result")
    if samples[-1] < 1:
        way = "simulate for longer, or with a shorter output_step"
        raise _mismatch_error(function, f"one of a single instant; {way}")
    return value.isel(time=slice(int(samples[-1]) + 1))


def figure_data(value: object, function: str, units: UnitsLike = None) -> xr.Dataset:
    """Return the dataset that a function draws, in the chosen units; raise on anything else."""
    dataset = _checked_kind(value, function, KINDS[function])
    return display_units(units, owner=f"rf.plot.{function}").convert_dataset(dataset)


def _checked_kind(value: object, function: str, kind: DatasetKind) -> xr.Dataset:
    if not isinstance(value, xr.Dataset) or not _has_variables(value, kind.identifying):
        raise SchemaError(mismatch_message(function, value))
    needed = (*kind.identifying, *kind.required)
    missing = ", ".join(repr(name) for name in needed if name not in value.variables)
    if missing:
        raise _mismatch_error(function, f"one that lacks {missing}; give it the whole dataset")
    check_along(value, function, kind.along)
    return value


def check_along(dataset: xr.Dataset, function: str, dims: Sequence[str], least: int = 1) -> None:
    """Refuse a dataset without values, or with too few, along some dimensions."""
    for dim in dims:
        count = dataset.sizes.get(dim, 0)
        if 0 < count < least:
            raise _mismatch_error(function, f"one with {count} value along {dim!r}")
        if not count:
            what = f"one without values along {dim!r}; to draw a single one, pick it with a list"
            raise _mismatch_error(function, f"{what}, for example dataset.isel({dim}=[0])")


def _mismatch_error(function: str, what: str) -> SchemaError:
    return SchemaError(f"rf.plot.{function} needs {_required_data(function)}, got {what}")


def read_positive(value: object, function: str, name: str) -> float:
    """Read a number greater than zero."""
    return to_ratio(value, owner=f"rf.plot.{function}", name=name, condition=POSITIVE, example="2")


def system_of_run(run: xr.Dataset, function: str) -> System:
    """Build the system of a run, without its motion."""
    text = run.attrs.get("system_json")
    of_function = SWEEP_ATTRIBUTE in run.attrs and "function" in run.attrs
    if not isinstance(text, str) and not of_function:
        msg = (
            f"rf.plot.{function}: the dataset has no attribute 'system_json'; expected the result "
            "of simulate() with its attributes"
        )
        raise SchemaError(msg)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RockframeWarning)  # issued already by the run
        if SWEEP_ATTRIBUTE in run.attrs:
            return system_of_case(run, owner=f"rf.plot.{function}")
        owner = f"rf.plot.{function}"
        return json_attribute(run, "system_json", System.from_dict, owner=owner)


def mismatch_message(function: str, value: object) -> str:
    """Write what a function draws, what was given, and how the latter can be drawn."""
    return str(_mismatch_error(function, "; ".join(filter(None, _describe_value(function, value)))))


def _describe_value(function: str, value: object) -> tuple[str, str]:
    """Describe what was given, and how it can be drawn."""
    if isinstance(value, str | PathLike):
        name = str(cast("object", value))
        of_motions = function in ("motion", "spectra")
        opened = "rf.GroundMotion.read" if of_motions else "xr.open_dataset"
        return f"{name!r}", f"open the file first: rf.plot.{function}({opened}({name!r}))"
    if isinstance(value, GroundMotion):
        return f"a GroundMotion, {value.name!r}", "rf.plot.motion and rf.plot.spectra draw it"
    if isinstance(value, System):
        way = "rf.plot.scene draws it, rf.plot.response(system.simulate(motion)) its response"
        return "a System", way
    if isinstance(value, xr.DataArray):
        return f"a DataArray, {value.name!r}", "a figure is drawn from the whole Dataset"
    if isinstance(value, SweepCase):
        return "a case of a sweep", "rf.plot.response(case.simulate()) draws its response"
    if not isinstance(value, xr.Dataset):
        return f"{value!r}" if value is None else f"a value of type {type(value).__name__}", ""
    if (drawing := _function_for(value)) is not None:
        return f"a Dataset with {KINDS[drawing].name}", f"rf.plot.{drawing} draws it"
    if "overturned" in value and value["overturned"].ndim > 0:
        way = "rf.plot.sweep draws it"
        if SWEEP_ATTRIBUTE in value.attrs and _required_data(function) == RUN.description:
            way += ", rf.case(dataset, ...).simulate() runs one of them with histories"
        return "a Dataset with many runs", way
    if (undrawn := _describe_undrawn(value)) is not None:
        return undrawn
    title = value.attrs.get("title")
    return "a Dataset" + (f" with the title {title!r}" if title else " of another kind"), ""


def _describe_undrawn(dataset: xr.Dataset) -> tuple[str, str] | None:
    """Describe a dataset that no function draws, and what is drawn instead."""
    for names, what, way in _UNDRAWN_KINDS:
        if not _has_variables(dataset, names):
            continue
        if names == _RUN_SCALARS and SWEEP_ATTRIBUTE in dataset.attrs:
            what = "a case of a sweep without the histories of its response"
            way = "rf.case(dataset).simulate() runs the case with them"
        return f"a Dataset with {what}", way
    return None


def _required_data(function: str) -> str:
    """Name what a function draws; all others draw runs, as in notebooks."""
    return _REQUIRED_DATA.get(function, RUN.description)


def _has_variables(dataset: xr.Dataset, names: tuple[str, ...]) -> bool:
    return all(name in dataset.variables for name in names)


def overturning_angles(dataset: xr.Dataset) -> tuple[float, float]:
    """Return the overturning angles to the left and to the right [rad]."""
    # in a sweep those of both sides are NaN for a case whose body is symmetric
    least = dataset["overturning_angle"]
    left, right = (dataset.get(f"{side}_overturning_angle", least) for side in ("left", "right"))
    return float(left.fillna(least)), float(right.fillna(least))
