"""Dynamic analyses, maps of overturning, and spectra over the size of the block."""

from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import SchemaError
from rockframe.plot._axes import (
    BLUE,
    GREEN,
    GREY,
    PURPLE,
    SKY,
    STANDS,
    VERMILLION,
    colour_of,
    colour_steps,
    grid,
    label_of,
    label_of_intensity,
    plain_ticks,
    style_of,
    units_of,
)
from rockframe.plot._checks import drawable, draws
from rockframe.plot._panels import Axes, AxesLike, Panels, Sheet, sheet, single
from rockframe.results.outcome import overturns
from rockframe.studies.dynamic_analysis import verdict_of_analysis
from rockframe.units import ACCELERATION
from rockframe.units.shown import UnitsLike

_MOST_NAMED: Final = 8
"""Motions with a line in the legend."""
_LEAST_FRACTILES: Final = 4
_FRACTILES: Final = (0.16, 0.5, 0.84)
_STYLED: Final = (1, 0, 2)
"""Dashes of each."""
_HEIGHTS: Final = 400
_ROOM: Final = 1.15
"""End of the axis over the highest intensity at which a verdict changes."""
_WAYS: Final = (VERMILLION, BLUE, SKY, PURPLE, GREEN)
MAP_COLOURS: Final = (STANDS, *_WAYS)
"""Of what stands, and of what overturns after none, one and more impacts."""
_CAPPED: Final = 1.0
"""Peaks over the overturning angle that are drawn alike."""


def of_one_structure(given: xr.Dataset) -> xr.Dataset:
    """Give an analysis without the axes of which it has one value; refuse several structures."""
    dims = given["capacity_scale"].dims
    beside = [dim for dim in dims if dim not in ("limit_state", "motion")]
    several = [f"{dim} ({given.sizes[dim]})" for dim in beside if given.sizes[dim] > 1]
    if several:
        msg = (
            f"rf.plot.dynamic_analysis draws one structure, this analysis is of several, by "
            f"{', '.join(several)}; choose one, for example with analysis.isel({beside[0]}=0)"
        )
        raise SchemaError(msg)
    return given.squeeze(beside)


@draws("dynamic_analysis", ax="two Axes", title="the verdict")
def dynamic_analysis(
    dataset: xr.Dataset,
    *,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Panels:
    """Draw the intensity over the peak rotation that it brings, and the share that overturned.

    Left, a line in grey for each motion, up to where it first overturns, with a mark there; hollow
    marks where the verdict changes again. Of four motions or more, fractiles: the peaks below which
    16, 50 and 84 % of the motions stay at an intensity; where one turns level, that share has
    overturned. Fewer motions have a colour each. Right, the share of motions whose capacity is
    below an intensity, for each limit state.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.incremental_dynamic_analysis`.

    Returns
    -------
    Panels

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
    given = of_one_structure(drawable(dataset, "dynamic_analysis", units))
    name = str(given.attrs.get("intensity", "scale"))
    intensity = given[name].broadcast_like(given["peak_relative_rotation"])
    on = sheet(
        ax, "dynamic_analysis", ("peaks", "shares"), (7.6, 4.4),
        lambda figure: figure.subplots(1, 2, width_ratios=(1.4, 1), sharey=True),
    )  # fmt: skip
    left, right = on.panels
    several = given.sizes["motion"] >= _LEAST_FRACTILES
    last, lines = given.isel(limit_state=-1), list[tuple[Any, Any]]()
    highest: list[float] = []
    for number in range(given.sizes["motion"]):
        one, along = given.isel(motion=number), intensity.isel(motion=number).to_numpy()
        flips = last.isel(motion=number)["scale_above"].to_numpy()
        places = _at(flips[~np.isnan(flips)], one["scale"].to_numpy(), along)
        line = _until_flips(along, one["peak_relative_rotation"].to_numpy(), places)
        highest.append(float(places.max(initial=0.0)))
        colour = GREY if several else colour_of(number)
        words = ("motions" if number == 0 else None) if several else str(one["motion"].item())
        left.plot(line[1], line[0], color=colour, lw=0.7, label=words)
        for some, face in ((places[:1], colour), (places[1:], "none")):
            left.plot(np.full(len(some), _CAPPED), some, "o", mfc=face, color=colour, ms=3)
        lines.append(line)
    if several:
        up = np.linspace(0.0, min(along[-1] for along, _ in lines), _HEIGHTS)
        for number, (share, values) in enumerate(_fractiles(lines, up)):
            words, style = f"{100.0 * share:.0f} %", style_of(_STYLED[number])
            left.plot(values, up, color=VERMILLION, ls=style, lw=1.6, label=words)
    left.set(
        xlabel=r"peak of $|\alpha|/\theta$ [-]",
        ylabel=label_of_intensity(given[name], given),
        xlim=(0.0, 1.03),
    )
    # nothing happens above where the last verdict changes, if all motions have overturned
    changes = [place for place in highest if place > 0.0]
    above = _ROOM * max(changes) if len(changes) == len(lines) else np.inf
    left.set_ylim(0.0, min(left.get_ylim()[1], above))
    for number, state in enumerate(given["limit_state"].to_numpy()):
        capacity = given["capacity_scale"].isel(limit_state=number).to_numpy()
        places = [
            float(_at(np.array([scale]), given["scale"].to_numpy(), along)[0])
            for scale, along in zip(capacity, intensity.transpose("motion", "scale").to_numpy(),
                                    strict=True)
            if np.isfinite(scale)
        ]  # fmt: skip
        ordered = np.sort(np.array([0.0, *places]))
        shares = np.arange(len(ordered)) / max(1, len(capacity))
        right.step(shares, ordered, where="pre", color=colour_of(number), label=str(state))
    right.set(xlabel="share of the motions [-]", xlim=(0.0, 1.02), ylim=left.get_ylim())
    if on.own is None:  # the axis of given panels may stand anywhere
        right.set_ylabel(left.get_ylabel())
    for axes in on.panels:
        grid(axes)
    on.name_lines()
    on.entitle(verdict_of_analysis(given), title)
    return on.panels


@draws("fractile_curves", title="the verdict")
def fractile_curves(
    dataset: xr.Dataset,
    *,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Axes:
    """Draw the intensity over the response: runs in grey, and their fractiles.

    Full lines are fractiles of the response at an intensity, broken ones those of the intensity by
    which a level of the response is reached. Where a full line ends in a level one to the right,
    that share of the motions has overturned.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.fractile_curves`.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> motions = {f"{f} Hz": rf.GroundMotion.sine_pulse("2.2 m/s^2", f"{f} Hz") for f in (1, 2)}
    >>> runs = rf.sweep(system, motions, scale=[0.5, 1.0, 2.0])
    >>> rf.plot.fractile_curves(rf.fractile_curves(runs, "PGA")).get_xlabel()
    'peak relative rotation [-]'
    """
    given = drawable(dataset, "fractile_curves", units)
    on = single(ax, "fractile_curves", (6.0, 4.3))
    axes = on.axes
    name = str(given.attrs["intensity"])
    up, levels = given[name].to_numpy(), given["response_level"].to_numpy()
    runs = given["motion_response"].transpose("motion", name).to_numpy()
    finite = runs[np.isfinite(runs)]
    right = _ROOM * max(float(levels[-1]), float(finite.max(initial=0.0)))
    for number, one in enumerate(runs):
        words = "motions" if number == 0 else None
        axes.plot(np.where(np.isfinite(one), one, np.nan), up, color=GREY, lw=0.7, label=words)
        fallen = np.isinf(one)
        starts = np.flatnonzero(fallen[1:] & ~fallen[:-1])
        axes.plot(one[starts], up[starts + 1], "o", color=GREY, ms=3)
    shares = given["quantile"].to_numpy().round(9).tolist()
    for number, share in enumerate(shares):
        colour, words = colour_of(number), f"{100.0 * share:.3g} %"
        # what most responses stay below is what few intensities are below
        rest = round(1.0 - share, 9)
        paired = colour_of(shares.index(rest)) if rest in shares else colour
        one = given.isel(quantile=number)
        of_response = np.minimum(one["response_fractile"].to_numpy(), 2.0 * right)
        axes.plot(of_response, up, color=colour, lw=1.6, label=f"{words} of responses")
        axes.plot(
            levels,
            np.where(np.isfinite(one["intensity_fractile"]), one["intensity_fractile"], np.nan),
            color=paired,
            lw=1.4,
            ls="--",
            label=f"{words} of intensities",
        )
    words = str(given.attrs["response"])
    axes.set(
        xlabel=label_of(given["response_level"].rename(words)),
        ylabel=label_of_intensity(given[name], given),
        xlim=(0.0, right),
        # above where the last motion stands nothing is left to see
        ylim=(0.0, min(up[-1], _ROOM * up[np.isfinite(runs).any(axis=0)].max(initial=up[0]))),
    )
    grid(axes)
    on.name_lines()
    on.entitle(str(given.attrs["verdict"]), title)
    return axes


def _until_flips(along: Any, peaks: Any, flips: Any) -> tuple[Any, Any]:
    """Give intensities and peaks of a motion, with those at which the verdict changes."""
    up = np.concatenate([along, flips])
    order = np.argsort(up, kind="stable")
    return up[order], np.concatenate([peaks.clip(max=_CAPPED), np.full(len(flips), _CAPPED)])[order]


def _fractiles(lines: list[tuple[Any, Any]], up: Any) -> list[tuple[float, Any]]:
    """Give shares of the motions, and the peaks below which these stay at intensities."""
    peaks = np.sort(
        [np.interp(up, np.append(0.0, along), np.append(0.0, peak)) for along, peak in lines],
        axis=0,
    )
    found: list[tuple[float, Any]] = []
    for share in _FRACTILES:
        place = share * (len(lines) - 1)
        below, above = peaks[int(place)], peaks[int(np.ceil(place))]
        # between a peak and a fall nothing lies
        within = below + (place - int(place)) * (above - below)
        found.append((share, np.where(above >= _CAPPED, _CAPPED, within)))
    return found


@draws("overturning_map")
def overturning_map(
    dataset: xr.Dataset,
    *,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Axes:
    """Draw which pulses overturn, after how many impacts, and the boundaries between.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.overturning_map`.

    Returns
    -------
    matplotlib.axes.Axes
        On rigid ground the axes are amplitude over that of uplift and frequency over the block's,
        unless `units` has one of accelerations.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> found = rf.overturning_map(
    ...     system, pulse, amplitude=([2.0, 4.0, 8.0], "m/s^2"), frequency=([0.5, 1.0], "Hz")
    ... )
    >>> rf.plot.overturning_map(found, units={"acceleration": "g"}).get_ylabel()
    'amplitude [g]'
    """
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    given = drawable(dataset, "overturning_map", units)
    asked = units_of(units, "overturning_map").reader.chose(ACCELERATION) is not None
    relative = "relative_pulse_frequency" in given.coords and not asked
    across = given["relative_pulse_frequency" if relative else "frequency"]
    up = given["relative_peak_ground_acceleration" if relative else "amplitude"]
    told = int(given.attrs["impacts_told_apart"])
    count = given["impacts_before_overturning"].transpose("amplitude", "frequency")
    colours = [STANDS, *(_WAYS[min(k, len(_WAYS) - 1)] for k in range(told + 1))]
    on = single(ax, "overturning_map", (6.0, 4.3))
    axes = on.axes
    known = overturns(given).transpose(*count.dims).notnull()
    axes.pcolormesh(
        across,
        up,
        count.fillna(-1.0).where(known),
        cmap=ListedColormap(colours),
        vmin=-1.5,
        vmax=told + 0.5,
        shading="nearest",
    )
    middle = 0.5 * (given["amplitude_below"] + given["amplitude_above"])
    size = float(up[-1] / given["amplitude"][-1])
    for number in range(given.sizes.get("boundary", 0)):
        axes.plot(across, size * middle.isel(boundary=number), ".", color="black", ms=2.0)
    axes.set(
        xlabel=r"frequency over the block's, $\omega_p/p$ [-]" if relative else label_of(across),
        ylabel=r"amplitude over that of uplift [-]" if relative else label_of(up),
    )
    words = ["stands", *(_after(k, told) for k in range(told + 1))]
    patches = [Patch(color=one, label=text) for one, text in zip(colours, words, strict=True)]
    if not known.all():
        words.append("no verdict")
        patches.append(Patch(facecolor="none", edgecolor="0.6", label=words[-1]))
    on.legend(patches, words, columns=2)
    on.entitle("What overturns: dots are boundaries that were halved", title)
    return axes


@draws("rocking_spectrum", ax="Axes, one for each slenderness")
def rocking_spectrum(
    dataset: xr.Dataset,
    *,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Panels:
    """Draw peak rotations over the size of the block, a panel for each slenderness.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.rocking_spectrum`.

    Returns
    -------
    Panels

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> found = rf.rocking_spectrum(system, pulse, periods=([2.0, 3.0], "s"), slenderness=[5.0])
    >>> panels = rf.plot.rocking_spectrum(found)
    >>> panels[0].get_title()
    'H/B = 5'
    """
    given = drawable(dataset, "rocking_spectrum", units)
    on = _sheet(ax, "rocking_spectrum", given)
    for place, axes in enumerate(on.panels):
        one = given.isel(slenderness=place)
        _lines(axes, one["peak_relative_rotation"].clip(max=_CAPPED))
        axes.axhline(_CAPPED, color="0.5", lw=0.8, ls=":")
        axes.set(xscale="log", ylim=(0.0, 1.06), title=f"H/B = {float(one['slenderness']):.3g}")
        axes.set_xlabel(r"$2\pi/p$ [s]")
    on.axes.set_ylabel(r"peak of $|\alpha|/\theta$ [-]")
    _finish(on, given)
    on.entitle("Rocking spectrum", title)
    return on.panels


@draws("overturning_spectrum", ax="Axes, one for each slenderness")
def overturning_spectrum(
    dataset: xr.Dataset,
    *,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Panels:
    """Draw the least intensity that overturns over the size of the block, on logarithmic axes.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.overturning_spectrum`.

    Returns
    -------
    Panels

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> found = rf.overturning_spectrum(
    ...     system, pulse, scale=[1.0, 2.0, 4.0, 8.0], periods=([2.0, 3.0], "s"), slenderness=[5.0]
    ... )
    >>> panels = rf.plot.overturning_spectrum(found, units={"acceleration": "g"})
    >>> panels[0].get_ylabel()
    'peak ground acceleration [g]'
    """
    given = drawable(dataset, "overturning_spectrum", units)
    on = _sheet(ax, "overturning_spectrum", given)
    measure = given["capacity_intensity"].rename(str(given.attrs["intensity"]))
    for place, axes in enumerate(on.panels):
        one = measure.isel(slenderness=place)
        _lines(axes, one)
        axes.set(xscale="log", yscale="log", title=f"H/B = {float(one['slenderness']):.3g}")
        axes.set_xlabel(r"$2\pi/p$ [s]")
    on.axes.set_ylabel(label_of_intensity(measure, given))
    _finish(on, given)
    on.entitle("Least intensity that overturns", title)
    return on.panels


def _at(scales: np.ndarray, known: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Give intensities at scales, of which they are a power."""
    power = np.log(along[-1] / along[0]) / np.log(known[-1] / known[0])
    return along[0] * (scales / known[0]) ** power


def _after(count: int, told: int) -> str:
    words = "after 1 impact" if count == 1 else f"after {count} impacts"
    words = "without an impact" if count == 0 else words
    return f"overturns {words}{' or more' if count == told else ''}"


def _sheet(ax: AxesLike, function: str, given: xr.Dataset) -> Sheet:
    names = [f"H/B = {float(value):.3g}" for value in given["slenderness"]]
    return sheet(
        ax, function, names, (1.2 + 3.2 * len(names), 3.9),
        lambda figure: figure.subplots(1, len(names), sharey=True),
    )  # fmt: skip


def _lines(axes: Axes, values: xr.DataArray) -> None:
    for number, colour in enumerate(colour_steps(values["motion"])):
        one = values.isel(motion=number)
        label = str(one["motion"].item())
        axes.plot(one["rocking_period"], one, color=colour, lw=1.0, label=label)
    grid(axes)


def _finish(on: Sheet, given: xr.Dataset) -> None:
    for axes in on.panels:
        plain_ticks(axes)
    if given.sizes["motion"] <= _MOST_NAMED:
        on.name_lines()
