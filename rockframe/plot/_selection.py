"""Spectra of a set of motions and the target spectrum to which they are fitted."""

from typing import Final

import numpy as np
import xarray as xr

from rockframe.plot._axes import (
    BLUE,
    GREY,
    VERMILLION,
    add_legend,
    axis_label,
    grid,
    label_log_ticks,
    unique_labels,
)
from rockframe.plot._checks import draws, figure_data
from rockframe.plot._panels import AxesLike, Panels, make_sheet
from rockframe.units.display import UnitsLike

_MAX_NAMED: Final = 50
_MAX_NAME_LENGTH: Final = 34


@draws(
    "a set of motions and its target",
    "suite.selection_for(target, 11)",
    ("scaled_spectral_acceleration", "target_spectral_acceleration"),
    (
        "target_standard_deviation",
        "set_median_acceleration",
        "set_standard_deviation",
        "scale_factor",
        "spectral_misfit",
    ),
    ax="two Axes",
    title="the target and the number of motions",
)
def selection(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Panels:
    """Draw the scaled spectra of a set, their median and spread, and the target.

    The left panel shows the accelerations, the right one the misfit of each motion, in the order
    of the set.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of :meth:`rockframe.MotionSuite.scaling_to` or
        :meth:`rockframe.MotionSuite.selection_for`.

    Returns
    -------
    Panels
        Dashed lines are one standard deviation of the logarithm above and below.

    Examples
    --------
    >>> import rockframe as rf
    >>> motions = {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
    >>> suite = rf.MotionSuite(motions)
    >>> found = suite.scaling_to(rf.TargetSpectrum.eurocode_8("0.2 g_0"), bounds=None)
    >>> [axes.get_xlabel() for axes in rf.plot.selection(found)]
    ['period [s]', 'misfit of the logarithm [-]']
    """
    dataset = figure_data(dataset, "selection", units)
    count = dataset.sizes["motion"]
    sheet = make_sheet(
        ax, "selection", ("spectra", "misfits"), (8.6, max(4.0, min(9.0, 1.0 + 0.16 * count))),
        lambda figure: figure.subplots(1, 2, width_ratios=[1.7, 1.0]),
    )  # fmt: skip
    drawn = dataset.isel(period=np.flatnonzero(dataset["period"].to_numpy() > 0.0))
    period = drawn["period"].to_numpy()
    spectra, misfits = sheet.panels
    for place in range(count):
        words = "motions" if place == 0 else None
        one = drawn["scaled_spectral_acceleration"].isel(motion=place)
        spectra.plot(period, one, color=GREY, alpha=0.6, linewidth=0.6, label=words)
    for name, colour, words in (
        ("set_median", BLUE, "median"),
        ("target_spectral", VERMILLION, "target"),
    ):
        middle = drawn[f"{name}_acceleration"].to_numpy()
        spread = drawn[f"{name.split('_')[0]}_standard_deviation"].to_numpy()
        spectra.plot(period, middle, color=colour, linewidth=1.8, label=words)
        if spread.any():
            for sign in (-1.0, 1.0):
                edge = middle * np.exp(sign * spread)
                spectra.plot(period, edge, color=colour, linewidth=1.0, linestyle="--")
    unit = dataset["scaled_spectral_acceleration"].attrs["units"]
    spectra.set(xscale="log", yscale="log", xlabel="period [s]")
    spectra.set_ylabel(axis_label("pseudo-spectral acceleration", unit))
    add_legend(spectra)
    labels = unique_labels(map(str, dataset["motion"].to_numpy()), _MAX_NAME_LENGTH)
    factors = dataset["scale_factor"].to_numpy()
    misfits.barh(range(count), dataset["spectral_misfit"], color=GREY, alpha=0.7)
    misfits.set(xlabel="misfit of the logarithm [-]", ylim=(count - 0.5, -0.5))
    if count <= _MAX_NAMED:
        words = [f"{name}, $\\times${f:.3g}" for name, f in zip(labels, factors, strict=True)]
        misfits.set_yticks(range(count), words, fontsize="x-small")
    for panel in sheet.panels:
        grid(panel)
    label_log_ticks(spectra)
    sheet.set_title(f"{count} motions; {dataset.attrs['target']}", title)
    return sheet.panels
