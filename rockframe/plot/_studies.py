"""Results of studies over one or two axes: sweeps, critical scales, sequences, fitted tests."""

from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.errors import ComponentError, SchemaError, did_you_mean, short_repr
from rockframe.plot._axes import (
    BLUE,
    GREY,
    VERMILLION,
    axis_label,
    colour_of,
    grid,
    ink,
    key,
    label_of,
    label_of_value,
    labels_of_names,
    style_of,
    units_of,
    zero_line,
)
from rockframe.plot._checks import drawable, draws, refuse
from rockframe.plot._panels import Axes, AxesLike, Panels, sheet, single
from rockframe.results.outcome import overturns
from rockframe.results.variables.studies import Outcome
from rockframe.studies.sweeps.words import cases_verdict
from rockframe.units import ANGLE
from rockframe.units.display import UnitsLike, display_units

_MOST_AXES: Final = 2
"""Largest number of dimensions in a figure of a sweep."""
_MOST_LINES: Final = 12
_MOST_LETTERS: Final = 28
"""Of a name below an axis."""
_PANELS: Final = ("histories", "residual")


@draws(
    "a critical scale",
    "rf.critical_scale(system, motion)",
    ("critical_scale", "scale_above", "outcome", "peak_rotation"),
    title="the verdict",
)
def critical_scale(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Axes:
    """Draw the peak rotation over the scale of a motion, and where the verdict changes.

    Returns
    -------
    matplotlib.axes.Axes
        Scales that overturn are shaded; a line marks the least of them.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> axes = rf.plot.critical_scale(rf.critical_scale(system, pulse, largest=3))
    >>> axes.get_xlabel()
    'scale of the motion [-]'
    """
    data = drawable(dataset, "critical_scale", units)
    scale, outcome = data["scale"].to_numpy(), data["outcome"].to_numpy()
    reader = units_of(units, "critical_scale").reader
    angles = reader.chosen_unit(ANGLE) is not None
    relative = "peak_relative_rotation" in data and not angles
    name = "peak_relative_rotation" if relative else "peak_rotation"
    peak = data[name].to_numpy()
    on = single(ax, "critical_scale", (6.4, 3.6))
    ends = np.append(data["scale_above"].to_numpy(), scale.max())
    falls = data["overturns_above"].to_numpy().astype(bool)
    for number in np.flatnonzero(falls):
        on.axes.axvspan(ends[number], ends[number + 1], color=VERMILLION, alpha=0.15, linewidth=0.0)
    for value, colour, words, marker in (
        (Outcome.STANDS, BLUE, "stands", "o"),
        (Outcome.OVERTURNS, VERMILLION, "overturns", "X"),
    ):
        chosen = outcome == value
        on.axes.plot(scale[chosen], peak[chosen], marker, markersize=3.5, color=colour, label=words)
    least = float(data["critical_scale"])
    if np.isfinite(least):
        on.axes.axvline(least, color=ink(), linestyle=":", linewidth=1.0, label=f"{least:.4g}")
    on.axes.set(xlabel="scale of the motion [-]", ylabel=label_of(data[name]))
    on.axes.set_ylim(bottom=0.0)
    grid(on.axes)
    key(on.axes)
    on.entitle(reader.convert_text(cases_verdict(dataset)), title)
    return on.axes


@draws("the result of a sweep, as rf.sweep(system, motions, ...) gives it")
def sweep(
    runs: xr.Dataset,
    variable: str = "peak_relative_rotation",
    *,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Axes:
    """Draw a scalar of many runs over one or two of their axes.

    Over one axis it is a line. Over two axes, one of which has 12 values at most, it is a line for
    each value of the second axis or for each motion; over two longer axes it is a map of colours.

    Parameters
    ----------
    runs : xarray.Dataset
        Result of :func:`rockframe.sweep`, :func:`rockframe.concat` or
        :func:`rockframe.earthquake_sequences`, with two dimensions at most. Select two of more
        dimensions, for example with ``runs.isel(motion=0)``.
    variable : str, optional
        Name of the scalar, such as ``"peak_rotation"`` or ``"overturned"``.

    Returns
    -------
    matplotlib.axes.Axes
        Crosses mark the runs that overturned, whichever scalar is drawn. Motions are points without
        a line.

    Raises
    ------
    SchemaError
        Not a dataset, no such variable, or more than two dimensions.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> runs = rf.sweep(system, pulse, scale=[1, 1.2], width=["0.8 m", "1 m"])
    >>> axes = rf.plot.sweep(runs, "peak_rotation")
    >>> axes.get_xlabel(), axes.get_ylabel()
    ('scale [-]', 'peak rotation [rad]')
    """
    if not isinstance(cast("object", runs), xr.Dataset) or not runs.data_vars:
        raise SchemaError(refuse("sweep", runs))
    data = _without_single_values(runs, variable)
    data = display_units(units, owner="rf.plot.sweep").convert_dataset(data)
    values = _values(data, variable)
    fell = overturns(data) == 1 if "status" in data else None
    fell = None if fell is None or set(fell.dims) != set(values.dims) else fell
    dims = sorted((str(dim) for dim in values.dims), key=lambda dim: _is_axis(data, dim))
    on = single(ax, "sweep", (6.4, 4.2))
    if len(dims) == 1 or min(values.sizes.values()) <= _MOST_LINES:
        # lines along the longest axis that has numbers
        along = max(dims, key=lambda dim: (_is_axis(data, dim), values.sizes[dim]))
        others = [dim for dim in dims if dim != along]
        _draw_lines(on.axes, data, values, fell, along, others)
    else:
        _draw_map(on.axes, data, values.transpose(*dims), fell, dims)
    sentence = display_units(units, owner="rf.plot.sweep").convert_text(cases_verdict(runs))
    on.entitle(sentence or str(data.attrs.get("title", "")), title)
    return on.axes


@draws(
    "a fit",
    "rf.fit_free_decay(system, measured)",
    ("fitted_value", "parameter", "initial_rotation"),
    ax="two Axes",
    title="the verdict",
)
def free_decay(
    dataset: xr.Dataset,
    *,
    rotation: str | None = None,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Panels:
    """Draw a test of free decay, the system that was fitted to it, and the residual.

    Parameters
    ----------
    rotation : str, optional
        Unit of rotations; degrees unless given.

    Returns
    -------
    Panels
        Histories and residual; only peaks are drawn if the test has no histories.

    Raises
    ------
    SchemaError
        The dataset is not such a fit.
    UnitsError
        A unit of another kind.

    Examples
    --------
    >>> import rockframe as rf
    >>> block = rf.Block(width="0.8 m", height="4 m", mass="2 t")
    >>> system = rf.System(block, rf.RigidGround(restitution=0.9))
    >>> start = rf.InitialState(rotation="0.05 rad")
    >>> measured = system.simulate(duration="3 s", initial=start).rotation
    >>> panels = rf.plot.free_decay(rf.fit_free_decay(system, measured))
    >>> panels[0].get_ylabel()
    'rotation [°]'
    """
    data = drawable(dataset, "free_decay")
    chosen = units_of(units, "free_decay")
    unit = chosen.of(ANGLE, "deg", rotation=rotation)
    histories = "measured_rotation" in data
    if histories:
        names = ("measured_rotation", "fitted_rotation", "rotation_residual")
        times = [data["time"].to_numpy()] * 3
    else:
        names = ("measured_peak_rotation", "fitted_peak_rotation", "peak_rotation_residual")
        place = data["measured_peak_rotation"].dims[0]
        counted = np.arange(1, data.sizes[place] + 1)
        timed = "measured_peak_time" in data
        measured = data["measured_peak_time"].to_numpy() if timed else counted
        fitted = data["fitted_peak_time"].to_numpy() if timed else counted
        times = [measured, fitted, measured]
    on = sheet(
        ax, "free_decay", _PANELS, (7.2, 4.4),
        lambda figure: figure.subplots(2, 1, sharex=True, height_ratios=(2.2, 1)),
    )  # fmt: skip
    above, below = on.panels
    dots = "-" if histories else "o"
    above.plot(times[0], unit.of(data[names[0]]), dots, color=ink(), lw=1.4, label="measured")
    style = "--" if histories else "x"
    above.plot(times[1], unit.of(data[names[1]]), style, color=VERMILLION, lw=1.0, label="fitted")
    below.plot(times[2], unit.of(data[names[2]]), dots, color=GREY, lw=0.8, markersize=3.0)
    for axes, words in ((above, "rotation"), (below, "measured\nless fitted")):
        zero_line(axes)
        axes.set_ylabel(axis_label(words, unit.words))
        grid(axes)
    below.set_xlabel("time [s]" if histories or "measured_peak_time" in data else "peak")
    key(above)
    on.entitle(chosen.reader.convert_text(str(data.attrs.get("verdict", ""))), title)
    return on.panels


def _without_single_values(dataset: xr.Dataset, variable: object) -> xr.Dataset:
    """Leave out axes of one value, such as a single motion, if there are too many axes."""
    if not isinstance(variable, str) or variable not in dataset.data_vars:
        return dataset
    sizes = dataset[variable].sizes
    if len(sizes) <= _MOST_AXES or max(sizes.values()) == 1:
        return dataset
    return dataset.isel({dim: 0 for dim, size in sizes.items() if size == 1})


def _values(dataset: xr.Dataset, variable: object) -> xr.DataArray:
    if not isinstance(variable, str) or variable not in dataset.data_vars:
        known = ", ".join(
            repr(str(name)) for name, one in dataset.data_vars.items() if 0 < one.ndim < 3
        )
        near = did_you_mean(variable, map(str, dataset.data_vars))
        msg = f"rf.plot.sweep: the runs have no {short_repr(variable)}{near}; they have {known}"
        raise SchemaError(msg)
    values = dataset[variable]
    if not 1 <= values.ndim <= _MOST_AXES:
        names = [str(dim) for dim in values.dims]
        as_label = next((name for name in reversed(names) if name.isidentifier()), "scale")
        msg = (
            f"rf.plot.sweep draws over one or two axes, {variable!r} has {values.ndim} "
            f"({', '.join(names) or 'none'}); choose from the others, for example with "
            f"runs.isel({as_label}=0)"
        )
        raise SchemaError(msg)
    if values.dtype.kind not in "fiub":
        msg = f"rf.plot.sweep: {variable!r} holds no numbers"
        raise ComponentError(msg)
    return values


def _is_axis(dataset: xr.Dataset, dim: str) -> bool:
    """Whether the coordinate of a dimension has numbers."""
    return dim in dataset.coords and dataset[dim].dtype.kind in "fiu"


def _along(dataset: xr.Dataset, dim: str) -> tuple[Any, str]:
    """Return the places along a dimension, and its label."""
    if _is_axis(dataset, dim):
        return dataset[dim].to_numpy(), label_of(dataset[dim])
    return np.arange(dataset.sizes[dim]), dim.replace("_", " ")


def _draw_lines(
    axes: Axes, dataset: xr.Dataset, values: xr.DataArray, fell: Any, along: str,
    others: list[str],
) -> None:  # fmt: skip
    places, words = _along(dataset, along)
    across, crosses = others[0] if others else "", list[tuple[Any, Any]]()
    for number in range(values.sizes.get(across, 1)):
        one = {across: number} if others else {}
        line = values.isel(one).to_numpy().astype(np.float64)
        label = None
        if others:
            known = across in dataset.coords
            text = label_of_value(dataset[across][number]) if known else str(number)
            named = across == "motion" or text.startswith(across)
            label = text if named else f"{across.replace('_', ' ')} {text}"
        axes.plot(
            places, line, marker="o", markersize=3.0, color=colour_of(number), linewidth=1.0,
            linestyle=style_of(number // 6) if _is_axis(dataset, along) else "none", label=label,
        )  # fmt: skip
        down = np.zeros(line.shape, bool) if fell is None else fell.isel(one).to_numpy()
        crosses.append((places[down], line[down]))
    if any(across.size for across, _ in crosses):
        both = np.concatenate(crosses, axis=1)
        axes.plot(*both, "x", color=ink(), markersize=6.0, label="overturned")
    if not _is_axis(dataset, along) and along in dataset.coords:
        names = labels_of_names(map(str, dataset[along].to_numpy()), _MOST_LETTERS)
        axes.set_xticks(places, names, rotation=30, ha="right", fontsize="small")
    elif places.dtype.kind in "iu":  # earthquakes and bodies are counted in integers
        axes.locator_params(axis="x", integer=True)
    axes.set(xlabel=words, ylabel=label_of(values))
    grid(axes)
    key(axes)


def _draw_map(
    axes: Axes, dataset: xr.Dataset, values: xr.DataArray, fell: Any, dims: list[str]
) -> None:
    (up, up_words), (across, across_words) = (_along(dataset, dim) for dim in dims)
    mesh = axes.pcolormesh(
        across, up, values.to_numpy().astype(np.float64), cmap="viridis", shading="nearest"
    )
    if fell is not None and fell.any():
        rows, columns = np.nonzero(fell.transpose(*dims).to_numpy())
        axes.plot(across[columns], up[rows], "x", color=VERMILLION, ms=3.0, label="overturned")
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), fontsize="small", frameon=False)
    axes.set(xlabel=across_words, ylabel=up_words)
    axes.figure.colorbar(mesh, ax=axes, label=label_of(values))
