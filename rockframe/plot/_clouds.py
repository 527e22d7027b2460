"""Clouds of unscaled motions, and the intensities at which limit states are exceeded."""

import numpy as np
import xarray as xr

from rockframe.errors import SchemaError
from rockframe.plot._axes import (
    COLOURS,
    GREY,
    as_label,
    grid,
    intensity_label,
    label_log_ticks,
    line_colour,
    variable_label,
)
from rockframe.plot._checks import draws, figure_data
from rockframe.plot._panels import Axes, AxesLike, make_single_panel
from rockframe.units.display import UnitsLike, with_superscripts


@draws(
    "a cloud",
    "rf.cloud_analysis(runs)",
    ("cloud_response", "residual_dispersion"),
    title="the verdict",
)
def cloud(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Axes:
    """Draw runs on logarithmic axes, with their regression line and the limit states.

    Light bands reach one and two dispersions from the line. Runs that overturned are drawn above
    all others, runs in which nothing moved below them.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> sizes = ("2 m/s^2", "2.1 m/s^2", "2.3 m/s^2", "2.5 m/s^2")
    >>> motions = {size: rf.GroundMotion.sine_pulse(size, "1 Hz") for size in sizes}
    >>> found = rf.cloud_analysis(rf.sweep(system, motions), "PGA", limits=[0.2])
    >>> rf.plot.cloud(found).get_ylabel()
    'peak relative rotation [-]'
    """
    data = figure_data(dataset, "cloud", units)
    sheet = make_single_panel(ax, "cloud", (6.0, 4.3))
    axes = sheet.axes
    name = str(data.attrs["intensity"])
    intensity, response = (data[f"cloud_{one}"].to_numpy() for one in ("intensity", "response"))
    overturned, at_rest = np.isinf(response), response == 0.0
    finite_response = ~overturned & ~at_rest
    limits = data["response_limit"].to_numpy()
    limits = limits[np.isfinite(limits)]
    shown = np.concatenate([response[finite_response], limits])
    low, high = (shown.min() / 1.6, shown.max() * 1.6) if len(shown) else (0.1, 1.0)
    axes.plot(
        intensity[finite_response], response[finite_response], "o", color=GREY, ms=3.5, label="runs"
    )
    axes.plot(
        intensity[overturned],
        np.full(overturned.sum(), high),
        "^",
        color=COLOURS[1],
        ms=5,
        label="overturned",
    )
    axes.plot(
        intensity[at_rest],
        np.full(at_rest.sum(), low),
        "v",
        color=COLOURS[2],
        ms=5,
        label="at rest",
    )
    x = np.geomspace(intensity.min(), intensity.max(), 101)
    # the line was fitted in SI units; in any units it passes through the mean of the runs
    logs = np.log(intensity[finite_response])
    slope, spread = float(data["regression_slope"]), float(data["residual_dispersion"])
    if np.isfinite(slope):
        log_median = np.log(response[finite_response]).mean() + slope * (np.log(x) - logs.mean())
        axes.plot(x, np.exp(log_median), color=COLOURS[0], lw=1.6, label="median")
        for size in (1.0, 2.0):
            ends = (np.exp(log_median + sign * size * spread) for sign in (-1.0, 1.0))
            axes.fill_between(x, *ends, color=COLOURS[0], alpha=0.12, linewidth=0.0)
    for one in limits:
        axes.axhline(one, color="0.3", lw=0.8, ls=":")
    response_name = data["cloud_response"].rename(str(data.attrs["response"]))
    axes.set(
        xscale="log", yscale="log", ylim=(low / 1.3, high * 1.3),
        xlabel=intensity_label(data[name], data), ylabel=variable_label(response_name),
    )  # fmt: skip
    label_log_ticks(axes)
    grid(axes)
    sheet.add_common_legend()
    sheet.set_title(with_superscripts(str(data.attrs["verdict"])), title)
    return axes


@draws(
    "annual rates",
    "rf.annual_rate(fragility, hazard)",
    ("annual_rate", "rate_share"),
    title="the verdict",
)
def annual_rate(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Axes:
    """Draw the contributions of intensities to the annual rate of limit states.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of :func:`rockframe.annual_rate`, of one structure.

    Examples
    --------
    >>> import rockframe as rf
    >>> counts = {"intensity": ([2, 4, 8], "m/s^2"), "exceeded": [1, 6, 19], "trials": 20}
    >>> hazard = {"intensity": ([0.1, 1.0, 10.0, 100.0], "m/s^2"), "rate": [1.0, 1e-2, 1e-5, 1e-9]}
    >>> rates = rf.annual_rate(rf.fragility(counts, "PGA"), hazard)
    >>> rf.plot.annual_rate(rates).get_ylabel()
    'share of the rate [%]'
    """
    data = figure_data(dataset, "annual_rate", units)
    several = [str(dim) for dim in data["annual_rate"].dims if dim != "limit_state"]
    data = data.isel({dim: 0 for dim in several if data.sizes[dim] == 1})
    wide = [dim for dim in several if dim in data.dims]
    if wide:
        msg = (
            f"rf.plot.annual_rate: found several structures, by {', '.join(wide)}; pick one, for "
            f"example with rates.isel({wide[0]}=0)"
        )
        raise SchemaError(msg)
    if "limit_state" not in data.dims:
        data = data.expand_dims("limit_state")
    sheet = make_single_panel(ax, "annual_rate", (6.0, 4.0))
    axes = sheet.axes
    middle = data["contributing_intensity"]
    logs = np.log(middle.to_numpy())
    step = logs[1] - logs[0]
    edges = np.exp(np.append(logs - 0.5 * step, logs[-1] + 0.5 * step))
    for number in range(data.sizes["limit_state"]):
        one = data.isel(limit_state=number)
        state = (
            as_label(str(one["limit_state"].item())) if "limit_state" in one.coords else "counted"
        )
        rate = float(one["annual_rate"])
        if np.isnan(rate):
            continue
        axes.stairs(
            100.0 * one["rate_share"].to_numpy(), edges, color=line_colour(number), lw=1.4,
            fill=True, alpha=0.35, label=f"{state}: {rate:.3g} a year",
        )  # fmt: skip
    axes.set(
        xscale="log", ylabel="share of the rate [%]",
        xlabel=intensity_label(middle.rename(str(data.attrs["intensity"])), data),
    )  # fmt: skip
    axes.set_ylim(bottom=0.0)
    label_log_ticks(axes)
    grid(axes)
    sheet.add_common_legend()
    sheet.set_title(with_superscripts(str(data.attrs["verdict"])), title)
    return axes
