"""Maps of overturning, and spectra over the size of the block."""

from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.plot._axes import (
    BLUE,
    GREEN,
    PALE_BLUE,
    PEAK_CAP,
    PURPLE,
    SKY,
    VERMILLION,
    figure_units,
    grid,
    intensity_label,
    label_log_ticks,
    unique_labels,
    variable_label,
)
from rockframe.plot._checks import draws, figure_data
from rockframe.plot._panels import Axes, AxesLike, Panels, Sheet, make_sheet, make_single_panel
from rockframe.results.outcome import overturns
from rockframe.units import ACCELERATION
from rockframe.units.display import UnitsLike

_MAX_NAMED: Final = 8
"""Largest number of motions that are named in the legend."""
MAP_COLOURS: Final = (PALE_BLUE, VERMILLION, BLUE, SKY, PURPLE, GREEN)
"""Colours of runs that stand, and of those that overturn after no, one and more impacts."""


@draws(
    "a map",
    "rf.overturning_map(system, pulse, ...)",
    ("impacts_before_overturning", "amplitude_above", "amplitude"),
    along=("amplitude", "frequency"),
)
def overturning_map(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Axes:
    """Draw which pulses overturn, after how many impacts, and the boundaries between them.

    Returns
    -------
    matplotlib.axes.Axes
        On rigid ground the axes are the amplitude divided by that of uplift, and the frequency
        divided by the frequency parameter of the block, unless `units` has a unit of
        accelerations.

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

    data = figure_data(dataset, "overturning_map", units)
    in_units = figure_units(units, "overturning_map").reader.chosen_unit(ACCELERATION) is not None
    relative = "relative_peak_ground_acceleration" in data.coords and not in_units
    across = data["relative_pulse_frequency" if relative else "frequency"]
    up = data["relative_peak_ground_acceleration" if relative else "amplitude"]
    impact_count = int(data.attrs["impacts_told_apart"])
    count = data["impacts_before_overturning"].transpose("amplitude", "frequency")
    colours = [MAP_COLOURS[min(k, len(MAP_COLOURS) - 1)] for k in range(impact_count + 2)]
    sheet = make_single_panel(ax, "overturning_map", (6.0, 4.3))
    axes = sheet.axes
    decided = overturns(data).transpose(*count.dims).notnull()
    axes.pcolormesh(
        across, up, count.fillna(-1.0).where(decided), cmap=ListedColormap(colours), vmin=-1.5,
        vmax=impact_count + 0.5, shading="nearest",
    )  # fmt: skip
    middle = 0.5 * (data["amplitude_below"] + data["amplitude_above"])
    size = float(up[-1] / data["amplitude"][-1])
    for number in range(data.sizes.get("boundary", 0)):
        axes.plot(across, size * middle.isel(boundary=number), ".", color="black", ms=2.0)
    axes.set(
        xlabel=r"frequency over the block's, $\omega_p/p$ [-]"
        if relative
        else variable_label(across),
        ylabel=r"peak acceleration over that of uplift [-]" if relative else variable_label(up),
    )
    words = ["stands", *(_impact_label(k, impact_count) for k in range(impact_count + 1))]
    patches = [Patch(color=colour, label=text) for colour, text in zip(colours, words, strict=True)]
    if not decided.all():
        words.append("no verdict")
        patches.append(Patch(facecolor="none", edgecolor="0.6", label=words[-1]))
    sheet.add_legend(patches, words, columns=2, fontsize="small")
    sheet.set_title("Overturning; dots are boundaries found by bisection", title)
    return axes


@draws(
    "a spectrum",
    "rf.rocking_spectrum(system, motions, ...)",
    ("peak_relative_rotation", "rocking_period"),
    along=("rocking_period",),
    ax="Axes, one for each slenderness",
)
def rocking_spectrum(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Panels:
    """Draw peak rotations over the size of the block, with a panel for each slenderness.

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
    data = figure_data(dataset, "rocking_spectrum", units)
    peaks = data["peak_relative_rotation"].clip(max=PEAK_CAP)
    sheet = _draw_by_slenderness(ax, "rocking_spectrum", peaks, ylim=(0.0, 1.06))
    for axes in sheet.panels:
        axes.axhline(PEAK_CAP, color="0.5", lw=0.8, ls=":")
    sheet.axes.set_ylabel(r"peak of $|\alpha|/\theta$ [-]")
    if data.sizes.get("motion", 1) <= _MAX_NAMED:
        sheet.add_common_legend()
    sheet.set_title("Rocking spectrum", title)
    return sheet.panels


@draws(
    "a spectrum",
    "rf.overturning_spectrum(system, ...)",
    ("capacity_intensity", "rocking_period"),
    along=("rocking_period",),
    ax="Axes, one for each slenderness",
)
def overturning_spectrum(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Panels:
    """Draw the least intensity that overturns over the size of the block, on logarithmic axes.

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
    data = figure_data(dataset, "overturning_spectrum", units)
    measure = data["capacity_intensity"].rename(str(data.attrs["intensity"]))
    sheet = _draw_by_slenderness(ax, "overturning_spectrum", measure, yscale="log")
    sheet.axes.set_ylabel(intensity_label(measure, data))
    if data.sizes.get("motion", 1) <= _MAX_NAMED:
        sheet.add_common_legend()
    sheet.set_title("Least intensity that overturns", title)
    return sheet.panels


def _impact_label(count: int, counted: int) -> str:
    text = "after 1 impact" if count == 1 else f"after {count} impacts"
    text = "without an impact" if count == 0 else text
    return f"overturns {text}{' or more' if count == counted else ''}"


def _draw_by_slenderness(ax: AxesLike, function: str, values: xr.DataArray, **style: Any) -> Sheet:
    """Draw a line for each motion over the size of the block, in a panel for each slenderness."""
    from matplotlib import colormaps

    values = values.expand_dims(
        [dim for dim in ("slenderness", "motion") if dim not in values.dims]
    )

    names = [f"H/B = {float(value):.3g}" for value in values["slenderness"]]
    sheet = make_sheet(
        ax, function, names, (1.2 + 3.2 * len(names), 3.9), ncols=len(names), sharey=True
    )
    motions = unique_labels(map(str, values["motion"].to_numpy()))
    colours = colormaps["viridis"](np.linspace(0.1, 0.85, len(motions)))
    for place, axes in enumerate(sheet.panels):
        for number, (label, colour) in enumerate(zip(motions, colours, strict=True)):
            curve = values.isel(slenderness=place, motion=number)
            axes.plot(curve["rocking_period"], curve, color=colour, lw=1.0, label=label)
        axes.set(xscale="log", xlabel=r"$2\pi/p$ [s]", title=names[place], **style)
        grid(axes)
        label_log_ticks(axes)
    return sheet
