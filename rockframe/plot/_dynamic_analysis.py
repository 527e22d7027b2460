"""Dynamic analyses and clouds: the intensity over the response; and rates of limit states."""

from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import SchemaError, first_along
from rockframe.plot._axes import (
    COLOURS,
    GREY,
    PEAK_CAP,
    as_label,
    figure_units,
    grid,
    intensity_label,
    label_log_ticks,
    limit_state_label,
    line_colour,
    line_style,
    text_colour,
    variable_label,
)
from rockframe.plot._checks import check_along, draws, figure_data
from rockframe.plot._panels import (
    Axes,
    AxesLike,
    Panels,
    chosen_panels,
    make_sheet,
    make_single_panel,
)
from rockframe.studies.dynamic_analysis import verdict_of_analysis
from rockframe.studies.fragility.trials import at_scales
from rockframe.studies.hazard import verdict_of_rates
from rockframe.units.display import UnitsLike, with_superscripts

_PANELS: Final = {"peaks": 1.4, "shares": 1.0}
"""Panels, which are side by side, and their relative widths."""
_MIN_FRACTILE_MOTIONS: Final = 4
_FRACTILES: Final = (0.16, 0.5, 0.84)
_FRACTILE_STYLES: Final = (1, 0, 2)
"""Dashes of each fractile, by their numbers."""
_INTENSITY_COUNT: Final = 400
_AXIS_MARGIN: Final = 1.15
"""End of the axis over the highest intensity at which a verdict changes."""
_END_LABEL: Final = "all were run up to here"
_ROUNDING: Final = 1e-9
"""By which the peak of a run that ends at the overturning angle may lie below it."""


def _single_structure(dataset: xr.Dataset, variable: str, function: str, named: str) -> xr.Dataset:
    """Return an analysis without axes of a single value; raise on several structures."""
    dims = [str(dim) for dim in dataset[variable].dims if dim not in ("limit_state", "motion")]
    several = [dim for dim in dims if dataset.sizes[dim] > 1]
    if several:
        counts = ", ".join(f"{dim} ({dataset.sizes[dim]})" for dim in several)
        msg = (
            f"rf.plot.{function}: found several structures, by {counts}; pick one, for example "
            f"with {first_along(named, several[0])}"
        )
        raise SchemaError(msg)
    return dataset.squeeze(dims)


@draws(
    "a dynamic analysis",
    "rf.incremental_dynamic_analysis(system, motions)",
    ("capacity_scale", "flip_count", "peak_relative_rotation", "scale"),
    along=("limit_state", "motion", "scale"),
    ax="Axes, one for each panel",
    title="the verdict",
)
def dynamic_analysis(
    dataset: xr.Dataset,
    *,
    panels: str | tuple[str, ...] | None = None,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Panels:
    """Draw the intensity over the peak rotation, and over the share of motions that overturned.

    The left panel has a grey line for each motion. A filled marker shows where the motion first
    overturns, hollow markers show where the verdict changes again. For four motions or more the
    fractiles are drawn too: the peaks below which 16, 50 and 84 % of the motions stay at an
    intensity. Where one becomes horizontal, only that share still stands. They end at the largest
    intensity up to which all motions were run, a dotted line. Fewer motions have one colour each.
    The right panel shows the share of motions whose capacity is below an intensity, for each limit
    state.

    Parameters
    ----------
    panels : str or tuple of str, optional
        Panels to draw: ``"peaks"``, left, and ``"shares"``, right; both unless given.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> motions = {f"{f} Hz": rf.GroundMotion.sine_pulse("2.2 m/s^2", f"{f} Hz") for f in (1, 2)}
    >>> found = rf.incremental_dynamic_analysis(
    ...     system, motions, scale=[0.5, 1.0, 2.0, 4.0], intensity="PGA"
    ... )
    >>> panels = rf.plot.dynamic_analysis(found, units={"acceleration": "g"})
    >>> panels[0].get_ylabel()
    'peak ground acceleration [g]'
    """
    dataset = figure_data(dataset, "dynamic_analysis")
    check_along(dataset, "dynamic_analysis", ["scale"], least=2)
    dataset = _single_structure(dataset, "capacity_scale", "dynamic_analysis", "analysis")
    data = figure_data(dataset, "dynamic_analysis", units)
    names = chosen_panels(panels, _PANELS, "dynamic_analysis")
    widths = [_PANELS[name] for name in names]
    sheet = make_sheet(
        ax, "dynamic_analysis", names, (0.8 + 2.83 * sum(widths), 4.4),
        choice=True, ncols=len(names), width_ratios=widths, sharey=True,
    )  # fmt: skip
    drawn = dict(zip(names, sheet.panels, strict=True))
    measure = data[str(data.attrs.get("intensity", "scale"))]
    intensity = measure.broadcast_like(data["peak_relative_rotation"])
    flips = _flip_intensities(data, intensity)
    if "peaks" in drawn:
        _draw_peaks(drawn["peaks"], data, intensity, flips)
    if "shares" in drawn:
        _draw_shares(drawn["shares"], data, intensity)
    # if all motions have overturned, nothing changes above the last change of a verdict
    highest = [float(places.max(initial=0.0)) for places in flips]
    above = _AXIS_MARGIN * max(highest) if min(highest) > 0.0 else np.inf
    top = min(max(axes.get_ylim()[1] for axes in sheet.panels), above)
    for axes in sheet.panels:
        axes.set_ylim(0.0, top)
        grid(axes)
    # given panels may be anywhere in a figure, so each has its label
    for axes in sheet.panels if sheet.own_figure is None else sheet.panels[:1]:
        axes.set_ylabel(intensity_label(measure, data))
    sheet.add_common_legend()
    verdict = verdict_of_analysis(dataset)
    sheet.set_title(figure_units(units, "dynamic_analysis").reader.convert_text(verdict), title)
    return sheet.panels


def _flip_intensities(dataset: xr.Dataset, intensity: xr.DataArray) -> list[np.ndarray]:
    """Return the intensities at which the verdict on each motion changes."""
    scales = dataset["scale"].to_numpy()
    above = dataset["scale_above"].isel(limit_state=-1).transpose("motion", ...).to_numpy()
    pairs = zip(above, intensity.transpose("motion", ...).to_numpy(), strict=True)
    return [at_scales(along, scales, flips[~np.isnan(flips)]) for flips, along in pairs]


def _draw_peaks(
    axes: Axes, dataset: xr.Dataset, intensity: xr.DataArray, flips: list[np.ndarray]
) -> None:
    """Draw the peaks of the motions, and the fractiles of four motions or more."""
    several, lines = dataset.sizes["motion"] >= _MIN_FRACTILE_MOTIONS, list[tuple[Any, Any]]()
    for number, places in enumerate(flips):
        curve, along = dataset.isel(motion=number), intensity.isel(motion=number).to_numpy()
        line = _peaks_with_flips(along, curve["peak_relative_rotation"].to_numpy(), places)
        colour = GREY if several else line_colour(number)
        words = "motions" if number == 0 else None
        if not several:
            words = as_label(str(curve["motion"].item()))
        dashes = line_style(0 if several else number)
        axes.plot(line[1], line[0], color=colour, ls=dashes, lw=0.7, label=words)
        for some, face in ((places[:1], colour), (places[1:], "none")):
            axes.plot(np.full(len(some), PEAK_CAP), some, "o", mfc=face, color=colour, ms=3)
        lines.append(line)
    if several:
        up = np.linspace(0.0, min(along[-1] for along, _ in lines), _INTENSITY_COUNT)
        fractiles = _peak_fractiles(lines, up)
        for number, (share, values) in enumerate(fractiles):
            words, style = f"{100.0 * share:.0f} %", line_style(_FRACTILE_STYLES[number])
            axes.plot(values, up, color=text_colour(), ls=style, lw=1.6, label=words)
        if np.min([peaks[-1] for _, peaks in fractiles]) < PEAK_CAP:
            axes.axhline(up[-1], color=text_colour(), ls=":", lw=0.8, label=_END_LABEL)
    axes.set(xlabel=r"peak of $|\alpha|/\theta$ [-]", xlim=(0.0, 1.03))


def _draw_shares(axes: Axes, dataset: xr.Dataset, intensity: xr.DataArray) -> None:
    """Draw the share of the motions whose capacity is below an intensity."""
    scales = dataset["scale"].to_numpy()
    intensities = intensity.transpose("motion", "scale").to_numpy()
    for number, state in enumerate(dataset["limit_state"].to_numpy()):
        capacity = dataset["capacity_scale"].isel(limit_state=number).to_numpy()
        places = [
            at_scales(along, scales, scale)
            for scale, along in zip(capacity, intensities, strict=True)
            if np.isfinite(scale)
        ]
        ordered = np.sort(np.array([0.0, *places]))
        shares = np.arange(len(ordered)) / max(1, len(capacity))
        axes.step(
            shares, ordered, where="pre", color=line_colour(number), ls=line_style(number),
            label=as_label(str(state)),
        )  # fmt: skip
    axes.set(xlabel="share of the motions [-]", xlim=(0.0, 1.02))


def _peaks_with_flips(along: Any, peaks: Any, flips: Any) -> tuple[Any, Any]:
    """Return the intensities and peaks of a motion, also where the verdict changes."""
    up = np.concatenate([along, flips])
    order = np.argsort(up, kind="stable")
    capped = np.where(peaks >= PEAK_CAP - _ROUNDING, PEAK_CAP, peaks)
    return up[order], np.concatenate([capped, np.full(len(flips), PEAK_CAP)])[order]


def _peak_fractiles(lines: list[tuple[Any, Any]], up: Any) -> list[tuple[float, Any]]:
    """Return shares of the motions, and the fractiles of the peaks at intensities."""
    peaks = np.sort(
        [np.interp(up, np.append(0.0, along), np.append(0.0, peak)) for along, peak in lines],
        axis=0,
    )  # NaN, of a run without a result, comes last
    places = np.array(_FRACTILES) * (len(lines) - 1)
    below, above = (peaks[rounded(places).astype(int)] for rounded in (np.floor, np.ceil))
    within = below + (places % 1.0)[:, None] * (above - below)
    # no interpolation between the peak of one motion and overturning under another
    return list(zip(_FRACTILES, np.where(above >= PEAK_CAP, PEAK_CAP, within), strict=True))


@draws(
    "fractile curves",
    "rf.fractile_curves(runs)",
    ("response_fractile", "intensity_fractile", "motion_response"),
    along=("motion", "quantile", "response_level"),
    title="the verdict",
)
def fractile_curves(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Axes:
    """Draw the intensity over the response: runs in grey, and their fractiles.

    Solid lines are fractiles of the response at an intensity, dashed lines fractiles of the
    intensity at which a level of the response is reached. Where a solid line leaves the figure
    horizontally to the right, the runs beyond that fractile have overturned.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> motions = {f"{f} Hz": rf.GroundMotion.sine_pulse("2.2 m/s^2", f"{f} Hz") for f in (1, 2)}
    >>> runs = rf.sweep(system, motions, scale=[0.5, 1.0, 2.0])
    >>> rf.plot.fractile_curves(rf.fractile_curves(runs, "PGA")).get_xlabel()
    'peak relative rotation [-]'
    """
    data = figure_data(dataset, "fractile_curves", units)
    name = str(data.attrs["intensity"])
    check_along(data, "fractile_curves", [name])
    sheet = make_single_panel(ax, "fractile_curves", (6.0, 4.3))
    axes = sheet.axes
    up, levels = data[name].to_numpy(), data["response_level"].to_numpy()
    runs = data["motion_response"].transpose("motion", name).to_numpy()
    finite = runs[np.isfinite(runs)]
    right = _AXIS_MARGIN * max(float(levels[-1]), float(finite.max(initial=0.0)))
    for number, fractile in enumerate(runs):
        words = "motions" if number == 0 else None
        axes.plot(
            np.where(np.isfinite(fractile), fractile, np.nan), up, color=GREY, lw=0.7, label=words
        )
        overturned = np.isinf(fractile)
        starts = np.flatnonzero(overturned[1:] & ~overturned[:-1])
        axes.plot(fractile[starts], up[starts + 1], "o", color=GREY, ms=3)
    shares = data["quantile"].to_numpy().round(9).tolist()
    for number, share in enumerate(shares):
        colour, words = line_colour(number), f"{100.0 * share:.3g} %"
        # a high fractile of the response corresponds to a low one of the intensity
        complement = round(1.0 - share, 9)
        paired = line_colour(shares.index(complement)) if complement in shares else colour
        fractile = data.isel(quantile=number)
        of_response = np.minimum(fractile["response_fractile"].to_numpy(), 2.0 * right)
        axes.plot(of_response, up, color=colour, lw=1.6, label=f"{words} of responses")
        reached = fractile["intensity_fractile"].where(np.isfinite)
        axes.plot(levels, reached, color=paired, lw=1.4, ls="--", label=f"{words} of intensities")
    # nothing is drawn above the intensity at which the last motion overturns
    last = up[np.isfinite(runs).any(axis=0)].max(initial=up[0])
    axes.set(
        xlabel=variable_label(data["response_level"].rename(str(data.attrs["response"]))),
        ylabel=intensity_label(data[name], data),
        xlim=(0.0, right),
        ylim=(0.0, min(up[-1], _AXIS_MARGIN * last)),
    )
    return sheet.finish(with_superscripts(str(data.attrs["verdict"])), title)


@draws(
    "a cloud",
    "rf.cloud_analysis(runs)",
    ("cloud_response", "residual_dispersion", "fragility_status"),
    along=("run",),
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
    intensity, response = (
        data[f"cloud_{quantity}"].to_numpy() for quantity in ("intensity", "response")
    )
    overturned, at_rest = np.isinf(response), response == 0.0
    finite_response = ~overturned & ~at_rest
    limits = data["response_limit"].to_numpy()
    limits = limits[np.isfinite(limits)]
    responses = np.concatenate([response[finite_response], limits])
    low, high = (responses.min() / 1.6, responses.max() * 1.6) if len(responses) else (0.1, 1.0)
    for part, heights, marker, colour, size, words in (
        (finite_response, response, "o", GREY, 3.5, "runs"),
        (overturned, np.full_like(response, high), "^", COLOURS[1], 5, "overturned"),
        (at_rest, np.full_like(response, low), "v", COLOURS[2], 5, "at rest"),
    ):
        axes.plot(intensity[part], heights[part], marker, color=colour, ms=size, label=words)
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
    for number, limit in enumerate(limits):
        words = None if number else "limits"
        axes.axhline(limit, color=text_colour(), lw=0.8, ls=":", label=words)
    response_name = data["cloud_response"].rename(str(data.attrs["response"]))
    axes.set(
        xscale="log", yscale="log", ylim=(low / 1.3, high * 1.3),
        xlabel=intensity_label(data[name], data), ylabel=variable_label(response_name),
    )  # fmt: skip
    label_log_ticks(axes)
    return sheet.finish(with_superscripts(str(data.attrs["verdict"])), title)


@draws(
    "annual rates",
    "rf.annual_rate(fragility, hazard)",
    ("annual_rate", "rate_share"),
    along=("contributing_intensity",),
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
    data = _single_structure(data, "annual_rate", "annual_rate", "rates")
    if "limit_state" not in data.dims:
        data = data.expand_dims("limit_state")
    sheet = make_single_panel(ax, "annual_rate", (6.0, 4.0))
    axes = sheet.axes
    middle = data["contributing_intensity"]
    logs = np.log(middle.to_numpy())
    step = logs[1] - logs[0]
    edges = np.exp(np.append(logs - 0.5 * step, logs[-1] + 0.5 * step))
    for number in range(data.sizes["limit_state"]):
        rates = data.isel(limit_state=number)
        rate = float(rates["annual_rate"])
        if np.isnan(rate):
            continue
        shares, colour = 100.0 * rates["rate_share"].to_numpy(), line_colour(number)
        axes.stairs(shares, edges, color=colour, fill=True, alpha=0.25)
        axes.stairs(
            shares, edges, color=colour, lw=1.4, ls=line_style(number),
            label=f"{limit_state_label(rates)}: {rate:.3g} a year",
        )  # fmt: skip
    axes.set(
        xscale="log", ylabel="share of the rate [%]",
        xlabel=intensity_label(middle.rename(str(data.attrs["intensity"])), data),
    )  # fmt: skip
    axes.set_ylim(bottom=0.0)
    label_log_ticks(axes)
    return sheet.finish(with_superscripts(verdict_of_rates(data)), title)
