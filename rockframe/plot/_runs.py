"""The runs of a figure: one, or several to compare, and the window of time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import xarray as xr

from rockframe.errors import ComponentError, short_repr
from rockframe.motion.display import motion_words
from rockframe.plot._axes import line_colour, line_style, unique_labels
from rockframe.plot._checks import checked_run
from rockframe.results.outcome import verdict_of
from rockframe.results.variables.variable import flag_words, unit_suffix_of
from rockframe.studies.sweeps.axes import described_axes
from rockframe.units import TIME, QuantityLike, to_si
from rockframe.units.display import DisplayUnits

Window: TypeAlias = tuple[QuantityLike | None, QuantityLike | None] | None
RunsLike: TypeAlias = xr.Dataset | Sequence[xr.Dataset] | Mapping[Any, xr.Dataset]


@dataclass(frozen=True)
class Run:
    """A run with its label, colour and dashes; a single run has no label."""

    dataset: xr.Dataset
    label: str | None
    colour: str
    style: Any

    @property
    def time(self) -> Any:
        """Times of the samples [s]."""
        return self.dataset["time"].to_numpy()

    def nearest(self, times: np.ndarray) -> np.ndarray:
        """Return the samples that are nearest to times [s]."""
        after = np.clip(np.searchsorted(self.time, times), 1, self.time.size - 1)
        before = after - 1
        return np.where(times - self.time[before] <= self.time[after] - times, before, after)


def read_runs(value: object, function: str, window: Window) -> list[Run]:
    """Read one or several runs, and cut out the window that is drawn."""
    limits = read_window(window, function)
    names, values = _labelled_runs(value)
    labels: list[Any] = [None] if names is None else unique_labels(names)
    runs = [checked_run(run, function) for run in values]
    return [
        Run(within_window(run, limits, function), label, line_colour(number), line_style(number))
        for number, (label, run) in enumerate(zip(labels, runs, strict=True))
    ]


def read_window(window: object, function: str, name: str = "window") -> tuple[float, float]:
    """Read a window of times or of periods; an end that is not given is infinite [s]."""
    if window is None:
        return -np.inf, np.inf
    owner = f"rf.plot.{function}"
    ends = list(window) if isinstance(window, tuple | list) else []
    if len(ends) != 2:
        msg = (
            f"{owner}: {name} must be a pair of times, such as ('2 s', '8 s'), or None for an open "
            f"end, got {short_repr(window)}"
        )
        raise ComponentError(msg)
    start, end = (
        none if time is None else to_si(time, TIME.like("('2 s', '8 s')"), owner=owner, name=name)
        for time, none in zip(ends, (-np.inf, np.inf), strict=True)
    )  # fmt: skip
    if start >= end:
        msg = f"{owner}: {name} must end after it starts, got {short_repr(window)}"
        raise ComponentError(msg)
    return start, end


def runs_title(runs: list[Run], units: DisplayUnits) -> str:
    """Return the title of a figure: the verdict of one run, or the common motion of several."""
    if len(runs) == 1:
        return verdict_of_case(runs[0].dataset, units)
    motions = {motion_words(run.dataset.attrs) for run in runs}
    return motions.pop() if len(motions) == 1 else ""


def verdict_of_case(run: xr.Dataset, units: DisplayUnits) -> str:
    """Return the verdict on a run, also on a case of a sweep, whose attribute covers all cases."""
    if "axes_json" not in run.attrs:
        return units.convert_text(str(run.attrs.get("verdict", "")))
    overturned = verdict_of(run)
    if overturned is None:
        words = flag_words(run["status"].attrs)[run["status"].item()]
        text = f"no verdict, {words.replace('_', ' ')}"
    elif overturned:
        text = f"overturned at {float(run['overturning_time']):.4g} s"
    else:
        share = 100.0 * float(run["peak_relative_rotation"])
        peak = f"peak rotation {float(run['peak_rotation']):.4g} rad"
        text = f"did not overturn, {peak}, {share:.3g} % of the overturning angle"
    return units.convert_text(f"{_case_label(run)}: {text}")


def _case_label(run: xr.Dataset) -> str:
    """Name the case of a sweep by its coordinates."""
    axes = [axis.name for axis in described_axes(run, owner="rf.plot")]
    names = [name for name in ("motion", *axes) if name in run.coords and not run[name].dims]
    labels = [(name.replace("_", " "), run[name].item(), run[name].attrs) for name in names]
    words = [
        f"{name} {f'{value:.6g}' if isinstance(value, float) else value}{unit_suffix_of(attrs)}"
        for name, value, attrs in labels
    ]
    return ", ".join(words) or "case of a sweep"


def _labelled_runs(value: Any) -> tuple[list[str] | None, list[Any]]:
    """Return the labels of several runs, and the runs; a single one has no label."""
    keyed = isinstance(value, Mapping) and not isinstance(value, xr.Dataset)
    runs: list[Any] = []
    if keyed:
        runs = [*value.values()]
    elif isinstance(value, list | tuple):
        runs = [*value]
    if not runs or not all(isinstance(run, xr.Dataset) for run in runs):
        return None, [value]
    if keyed:
        return [str(key) for key in value], runs
    cases = [_case_label(run) if "axes_json" in run.attrs else "" for run in runs]
    attributes = ("motion", "model", "accuracy")
    for names in [
        cases,
        *([str(run.attrs.get(attribute, "")) for run in runs] for attribute in attributes),
    ]:
        if len(set(names)) == len(runs):
            return names, runs
    return [f"run {number}" for number, _ in enumerate(runs, start=1)], runs


def within_window(
    histories: xr.Dataset, limits: tuple[float, float], function: str, of: str = "run"
) -> xr.Dataset:
    """Cut out a window of time, with the events in it."""
    if not np.isfinite(limits).any():
        return histories
    time = histories["time"].to_numpy()
    inside = np.flatnonzero((time >= limits[0]) & (time <= limits[1]))
    if inside.size < 2:
        msg = (
            f"rf.plot.{function}: the window holds {inside.size} of the {of}'s samples, which go "
            f"from {time[0]:.6g} s to {time[-1]:.6g} s; expected two at least"
        )
        raise ComponentError(msg)
    part = histories.isel(time=slice(int(inside[0]), int(inside[-1]) + 1))
    if "event_time" in part:
        times = part["event_time"].to_numpy()
        part = part.isel(event=np.flatnonzero((times >= limits[0]) & (times <= limits[1])))
    return part
