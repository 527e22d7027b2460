"""Results of studies over one or two axes: sweeps, critical scales, sequences, fitted tests."""

from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.errors import ComponentError, SchemaError, did_you_mean, first_along, short_repr
from rockframe.plot._axes import (
    BLUE,
    GREY,
    VERMILLION,
    add_legend,
    axis_label,
    figure_units,
    grid,
    line_colour,
    line_style,
    text_colour,
    unique_labels,
    value_label,
    variable_label,
    zero_line,
)
from rockframe.plot._checks import draws, figure_data, mismatch_message
from rockframe.plot._panels import Axes, AxesLike, Panels, make_sheet, make_single_panel
from rockframe.results.outcome import overturns
from rockframe.results.variables.studies import Outcome
from rockframe.studies.sweeps.labelling import cases_verdict
from rockframe.units import ANGLE
from rockframe.units.display import UnitsLike, display_units

_MAX_AXES: Final = 2
"""Largest number of dimensions in a figure of a sweep."""
_MAX_LINES: Final = 12
_MAX_NAME_LENGTH: Final = 28
"""Of a name below an axis."""
_PANELS: Final = ("histories", "residual")


@draws(
    "a critical scale",
    "rf.critical_scale(system, motion)",
    ("critical_scale", "scale_above", "outcome", "peak_rotation"),
    along=("scale",),
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
    data = figure_data(dataset, "critical_scale", units)
    scale, outcome = data["scale"].to_numpy(), data["outcome"].to_numpy()
    reader = figure_units(units, "critical_scale").reader
    relative = "peak_relative_rotation" in data and reader.chosen_unit(ANGLE) is None
    peak = data["peak_relative_rotation" if relative else "peak_rotation"]
    sheet = make_single_panel(ax, "critical_scale", (6.4, 3.6))
    bounds = np.append(data["scale_above"].to_numpy(), scale.max())
    for number in np.flatnonzero(data["overturns_above"].to_numpy().astype(bool)):
        sheet.axes.axvspan(
            bounds[number], bounds[number + 1], color=VERMILLION, alpha=0.15, linewidth=0.0
        )
    for value, colour, words, marker in (
        (Outcome.STANDS, BLUE, "stands", "o"),
        (Outcome.OVERTURNS, VERMILLION, "overturns", "X"),
    ):
        chosen = outcome == value
        sheet.axes.plot(
            scale[chosen],
            peak.to_numpy()[chosen],
            marker,
            markersize=3.5,
            color=colour,
            label=words,
        )
    least = float(data["critical_scale"])
    if np.isfinite(least):
        sheet.axes.axvline(
            least, color=text_colour(), linestyle=":", linewidth=1.0, label=f"{least:.4g}"
        )
    sheet.axes.set(xlabel="scale of the motion [-]", ylabel=variable_label(peak))
    sheet.axes.set_ylim(bottom=0.0)
    grid(sheet.axes)
    add_legend(sheet.axes)
    sheet.set_title(reader.convert_text(cases_verdict(dataset)), title)
    return sheet.axes


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
        raise SchemaError(mismatch_message("sweep", runs))
    shown_in = display_units(units, owner="rf.plot.sweep")
    data = shown_in.convert_dataset(_checked_runs(runs, variable))
    values = data[variable]
    overturned = xr.zeros_like(values, dtype=bool)
    if "status" in data and set(data["status"].dims) == set(values.dims):
        overturned = overturns(data) == 1
    dims = sorted((str(dim) for dim in values.dims), key=lambda dim: _is_numeric_axis(data, dim))
    sheet = make_single_panel(ax, "sweep", (6.4, 4.2))
    if len(dims) == 1 or min(values.sizes.values()) <= _MAX_LINES:
        # lines along the longest axis that has numbers
        along = max(dims, key=lambda dim: (_is_numeric_axis(data, dim), values.sizes[dim]))
        other_dims = [dim for dim in dims if dim != along]
        _draw_lines(sheet.axes, data, values, overturned, along, other_dims)
    else:
        _draw_map(sheet.axes, data, values.transpose(*dims), overturned, dims)
    sentence = shown_in.convert_text(cases_verdict(runs))
    sheet.set_title(sentence or str(data.attrs.get("title", "")), title)
    return sheet.axes


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
    data = figure_data(dataset, "free_decay")
    axis_units = figure_units(units, "free_decay")
    unit = axis_units.axis_unit(ANGLE, "deg", rotation=rotation)
    histories = "measured_rotation" in data
    if histories:
        names = ("measured_rotation", "fitted_rotation", "rotation_residual")
        times = [data["time"].to_numpy()] * 3
    else:
        names = ("measured_peak_rotation", "fitted_peak_rotation", "peak_rotation_residual")
        measured = fitted = np.arange(1, data["measured_peak_rotation"].size + 1)
        if "measured_peak_time" in data:
            measured, fitted = data["measured_peak_time"], data["fitted_peak_time"]
        times = [measured, fitted, measured]
    sheet = make_sheet(
        ax, "free_decay", _PANELS, (7.2, 4.4),
        nrows=2, sharex=True, height_ratios=(2.2, 1),
    )  # fmt: skip
    above, below = sheet.panels
    dots = "-" if histories else "o"
    above.plot(
        times[0], unit.of(data[names[0]]), dots, color=text_colour(), lw=1.4, label="measured"
    )
    style = "--" if histories else "x"
    above.plot(times[1], unit.of(data[names[1]]), style, color=VERMILLION, lw=1.0, label="fitted")
    below.plot(times[2], unit.of(data[names[2]]), dots, color=GREY, lw=0.8, markersize=3.0)
    for axes, words in ((above, "rotation"), (below, "measured\nless fitted")):
        zero_line(axes)
        axes.set_ylabel(axis_label(words, unit.words))
        grid(axes)
    below.set_xlabel("time [s]" if histories or "measured_peak_time" in data else "peak")
    add_legend(above)
    sheet.set_title(axis_units.reader.convert_text(str(data.attrs.get("verdict", ""))), title)
    return sheet.panels


def _checked_runs(dataset: xr.Dataset, variable: object) -> xr.Dataset:
    """Check the scalar to be drawn; leave out axes of one value if there are too many axes."""
    if not isinstance(variable, str) or variable not in dataset.data_vars:
        variables = ", ".join(
            repr(str(name)) for name, array in dataset.data_vars.items() if 0 < array.ndim < 3
        )
        near = did_you_mean(variable, map(str, dataset.data_vars))
        msg = f"rf.plot.sweep: the runs have no {short_repr(variable)}; they have {variables}{near}"
        raise SchemaError(msg)
    sizes = dataset[variable].sizes
    if len(sizes) > _MAX_AXES and max(sizes.values()) > 1:
        dataset = dataset.isel({dim: 0 for dim, size in sizes.items() if size == 1})
    values = dataset[variable]
    if not 1 <= values.ndim <= _MAX_AXES:
        names = [str(dim) for dim in values.dims]
        way = (
            f"choose from the others, for example with {first_along('runs', names[-1])}, or draw "
            f"a mean over one, runs.mean({names[-1]!r})"
            if names
            else "rf.case gives a single case, to be simulated and drawn by rf.plot.response"
        )
        msg = (
            f"rf.plot.sweep draws over one or two axes, {variable!r} has {values.ndim} "
            f"({', '.join(names) or 'none'}); {way}"
        )
        raise SchemaError(msg)
    if values.dtype.kind not in "fiub":
        msg = f"rf.plot.sweep: {variable!r} holds no numbers"
        raise ComponentError(msg)
    return dataset


def _is_numeric_axis(dataset: xr.Dataset, dim: str) -> bool:
    """Whether the coordinate of a dimension has numbers."""
    return dim in dataset.coords and dataset[dim].dtype.kind in "fiu"


def _axis_values(dataset: xr.Dataset, dim: str) -> tuple[Any, str]:
    """Return the places along a dimension, and its label."""
    if _is_numeric_axis(dataset, dim):
        return dataset[dim].to_numpy(), variable_label(dataset[dim])
    return np.arange(dataset.sizes[dim]), dim.replace("_", " ")


def _draw_lines(
    axes: Axes, dataset: xr.Dataset, values: xr.DataArray, overturned: xr.DataArray, x_dim: str,
    other_dims: list[str],
) -> None:  # fmt: skip
    places, words = _axis_values(dataset, x_dim)
    line_dim, crosses = other_dims[0] if other_dims else "", list[tuple[Any, Any]]()
    for number in range(values.sizes.get(line_dim, 1)):
        selected = {line_dim: number} if other_dims else {}
        line = values.isel(selected).to_numpy().astype(np.float64)
        label = None
        if other_dims:
            labelled = line_dim in dataset.coords
            text = value_label(dataset[line_dim][number]) if labelled else str(number)
            named = line_dim == "motion" or text.startswith(line_dim)
            label = text if named else f"{line_dim.replace('_', ' ')} {text}"
        axes.plot(
            places, line, marker="o", markersize=3.0, color=line_colour(number), linewidth=1.0,
            linestyle=line_style(number) if _is_numeric_axis(dataset, x_dim) else "none",
            label=label,
        )  # fmt: skip
        crossed = overturned.isel(selected).to_numpy()
        crosses.append((places[crossed], line[crossed]))
    if any(line_dim.size for line_dim, _ in crosses):
        points = np.concatenate(crosses, axis=1)
        axes.plot(*points, "x", color=text_colour(), markersize=6.0, label="overturned")
    if not _is_numeric_axis(dataset, x_dim) and x_dim in dataset.coords:
        names = unique_labels(map(str, dataset[x_dim].to_numpy()), _MAX_NAME_LENGTH)
        axes.set_xticks(places, names, rotation=30, ha="right", fontsize="small")
    elif places.dtype.kind in "iu":  # earthquakes and bodies are counted in integers
        axes.locator_params(axis="x", integer=True)
    axes.set(xlabel=words, ylabel=variable_label(values))
    grid(axes)
    add_legend(axes)


def _draw_map(
    axes: Axes, dataset: xr.Dataset, values: xr.DataArray, overturned: xr.DataArray,
    dims: list[str],
) -> None:  # fmt: skip
    (up, up_words), (across, across_words) = (_axis_values(dataset, dim) for dim in dims)
    mesh = axes.pcolormesh(
        across, up, values.to_numpy().astype(np.float64), cmap="viridis", shading="nearest"
    )
    if overturned.any():
        rows, columns = np.nonzero(overturned.transpose(*dims).to_numpy())
        axes.plot(across[columns], up[rows], "x", color=VERMILLION, ms=3.0, label="overturned")
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), fontsize="small", frameon=False)
    axes.set(xlabel=across_words, ylabel=up_words)
    axes.figure.colorbar(mesh, ax=axes, label=variable_label(values))
