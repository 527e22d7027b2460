"""Dynamic analyses, maps of overturning, and spectra over the size of the block."""

from typing import TYPE_CHECKING, Final

import numpy as np
import xarray as xr

from rockframe.plot._axes import (
    BLUE,
    COLOURS,
    ORANGE,
    SKY,
    STANDS,
    VERMILLION,
    colour_steps,
    grid,
    label_of,
    label_of_intensity,
    plain_ticks,
    units_of,
)
from rockframe.plot._checks import drawable, draws
from rockframe.plot._panels import Panels, Sheet, sheet, single
from rockframe.results.outcome import overturns
from rockframe.studies.sweeps.words import cases_verdict
from rockframe.units import ACCELERATION

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rockframe.plot._panels import AxesLike
    from rockframe.units.shown import UnitsLike

_MOST_NAMED: Final = 8
"""Motions with a line in the legend."""
_WAYS: Final = (VERMILLION, BLUE, SKY, ORANGE, "0.6")
_CAPPED: Final = 1.0
"""Peaks over the overturning angle that are drawn alike."""


@draws("dynamic_analysis", ax="two Axes", title="the verdict")
def dynamic_analysis(
    dataset: xr.Dataset,
    *,
    units: "UnitsLike" = None,
    ax: "AxesLike" = None,
    title: str | None = None,
) -> "Panels":
    """Draw peak rotations over the intensity, and the share of motions that overturned.

    Left, a line for each motion, and a mark where it first overturns; hollow marks where the
    verdict changes again. Right, the share of motions whose capacity is below an intensity, for
    each limit state.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.incremental_dynamic_analysis`.

    Returns
    -------
    Panels
    """
    given = drawable(dataset, "dynamic_analysis", units)
    name = str(given.attrs.get("intensity", "scale"))
    intensity = given[name].broadcast_like(given["peak_relative_rotation"])
    on = sheet(
        ax, "dynamic_analysis", ("peaks", "shares"), (7.6, 3.7),
        lambda figure: figure.subplots(1, 2, width_ratios=(1.4, 1)),
    )  # fmt: skip
    left, right = on.panels
    colours = colour_steps(given["motion"])
    last = given.isel(limit_state=-1)
    for number, colour in enumerate(colours):
        one, along = given.isel(motion=number), intensity.isel(motion=number)
        peak = one["peak_relative_rotation"].clip(max=_CAPPED)
        label = str(one["motion"].item()) if given.sizes["motion"] <= _MOST_NAMED else None
        left.plot(along, peak, color=colour, lw=0.9, label=label)
        flips = last.isel(motion=number)["scale_above"].to_numpy()
        places = _at(flips[~np.isnan(flips)], one["scale"].to_numpy(), along.to_numpy())
        left.plot(places[:1], np.full(len(places[:1]), _CAPPED), "o", color=colour, ms=4)
        rest = places[1:]
        left.plot(rest, np.full(len(rest), _CAPPED), "o", mfc="none", color=colour, ms=3)
    left.set(
        xlabel=label_of_intensity(given[name], given),
        ylabel=r"peak of $|\alpha|/\theta$ [-]",
        ylim=(0.0, 1.06),
    )
    left.set_xlim(left=0.0)
    if given.sizes["motion"] <= _MOST_NAMED:
        left.legend(frameon=False, fontsize="small")
    most = 0.0
    for number, state in enumerate(given["limit_state"].to_numpy()):
        capacity = given["capacity_scale"].isel(limit_state=number).to_numpy()
        places = [
            float(_at(np.array([scale]), given["scale"].to_numpy(), along)[0])
            for scale, along in zip(capacity, intensity.transpose("motion", "scale").to_numpy(),
                                    strict=True)
            if np.isfinite(scale)
        ]  # fmt: skip
        ordered = np.sort(np.array([0.0, *places]))
        most = max(most, float(ordered[-1]))
        shares = np.arange(len(ordered)) / max(1, len(capacity))
        colour = COLOURS[number % len(COLOURS)]
        right.step(ordered, shares, where="post", color=colour, label=str(state))
    right.set(
        xlabel=label_of_intensity(given[name], given),
        ylabel="share of the motions [-]",
        ylim=(0.0, 1.02),
    )
    right.set_xlim(0.0, 1.15 * most if most > 0.0 else left.get_xlim()[1])
    right.legend(frameon=False, fontsize="small")
    for axes in on.panels:
        grid(axes)
    on.entitle(cases_verdict(given), title)
    return on.panels


@draws("overturning_map")
def overturning_map(
    dataset: xr.Dataset,
    *,
    units: "UnitsLike" = None,
    ax: "AxesLike" = None,
    title: str | None = None,
) -> "Axes":
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
    on.legend(patches, words, ncols=2)
    on.entitle("What overturns: dots are boundaries that were halved", title)
    return axes


@draws("rocking_spectrum", ax="Axes, one for each slenderness")
def rocking_spectrum(
    dataset: xr.Dataset,
    *,
    units: "UnitsLike" = None,
    ax: "AxesLike" = None,
    title: str | None = None,
) -> "Panels":
    """Draw peak rotations over the size of the block, a panel for each slenderness.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.rocking_spectrum`.

    Returns
    -------
    Panels
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
    units: "UnitsLike" = None,
    ax: "AxesLike" = None,
    title: str | None = None,
) -> "Panels":
    """Draw the least intensity that overturns over the size of the block, on logarithmic axes.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.overturning_spectrum`.

    Returns
    -------
    Panels
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


def _sheet(ax: "AxesLike", function: str, given: xr.Dataset) -> Sheet:
    names = [f"H/B = {float(value):.3g}" for value in given["slenderness"]]
    return sheet(
        ax, function, names, (1.2 + 3.2 * len(names), 3.9),
        lambda figure: figure.subplots(1, len(names), sharey=True),
    )  # fmt: skip


def _lines(axes: "Axes", values: xr.DataArray) -> None:
    for number, colour in enumerate(colour_steps(values["motion"])):
        one = values.isel(motion=number)
        label = str(one["motion"].item())
        axes.plot(one["rocking_period"], one, color=colour, lw=1.0, label=label)
    grid(axes)


def _finish(on: Sheet, given: xr.Dataset) -> None:
    for axes in on.panels:
        plain_ticks(axes)
    if given.sizes["motion"] <= _MOST_NAMED:
        on.legend(*on.axes.get_legend_handles_labels(), fontsize="small", ncols=2)
