"""Spectra of motions, laid out as in Fig. 21 of the paper, and of sets of motions."""

from collections.abc import Iterable
from enum import StrEnum
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_bool, checked_choice
from rockframe.errors import ComponentError, short_repr
from rockframe.measures import fourier_spectrum, response_spectrum, velocity_and_displacement
from rockframe.motion.quantities import ArrayLike
from rockframe.plot._axes import (
    BLUE,
    GREY,
    PALE_BLUE,
    VERMILLION,
    DisplayUnit,
    add_legend,
    axis_label,
    figure_units,
    grid,
    label_log_ticks,
    line_colour,
    line_style,
    text_colour,
    unique_labels,
    zero_line,
)
from rockframe.plot._checks import draws, figure_data
from rockframe.plot._motion import LabelledMotion, MotionsLike, labelled_motions, motions_title
from rockframe.plot._panels import Axes, AxesLike, Panels, make_sheet, make_single_panel
from rockframe.plot._runs import Window, read_window, within_window
from rockframe.suites import TargetSpectrum
from rockframe.suites.target import check_target
from rockframe.units import ACCELERATION, VELOCITY, QuantityLike, RatioLike
from rockframe.units.display import UnitsLike

_RESOLUTION: Final = "0.05 Hz"  # for short pulses; long records have a finer resolution
_VARIABLE_PREFIX: Final = {"horizontal": "", "vertical": "vertical_"}
_PANELS: Final = ("history", "response", "fourier")


@draws("a GroundMotion", ax="three Axes", title="the motion's name")
def spectra(
    motion: MotionsLike,
    periods: ArrayLike | Iterable[QuantityLike] | None = None,
    damping_ratios: Iterable[RatioLike] | RatioLike = (0.05,),
    *,
    component: str = "horizontal",
    window: Window = None,
    acceleration: str | None = None,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Panels:
    """Draw a motion over time, its response spectra and its Fourier spectrum.

    Parameters
    ----------
    motion : GroundMotion, or sequence or mapping of them
        The motion, or several to compare.
    periods, damping_ratios : optional
        As for :func:`rockframe.measures.response_spectrum` [s], [1].
    component : {"horizontal", "vertical"}, optional
        Component of the motion.
    window : (str or Quantity or None, str or Quantity or None), optional
        Start and end of the history that is drawn; spectra are those of the whole motion [s].
    acceleration : str, optional
        Unit of accelerations, such as ``"g"``.

    Returns
    -------
    Panels
        History, response spectra of the pseudo-spectral acceleration, and Fourier spectra.

    Raises
    ------
    UnitsError, ComponentError
        As for :func:`rockframe.measures.response_spectrum`; or not three Axes.

    Examples
    --------
    >>> import rockframe as rf
    >>> panels = rf.plot.spectra(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
    >>> panels[0].get_xlabel()
    'time [s]'
    """
    data = labelled_motions(motion, "spectra")
    limits = read_window(window, "spectra")
    axis_units = figure_units(units, "spectra")
    unit = axis_units.axis_unit(ACCELERATION, acceleration=acceleration)
    amplitude = axis_units.axis_unit(VELOCITY)
    results = [
        (
            within_window(
                velocity_and_displacement(curve.motion, component=component),
                limits, "spectra", "motion",
            ),
            response_spectrum(curve.motion, periods, damping_ratios, component=component),
            fourier_spectrum(curve.motion, resolution=_RESOLUTION, component=component),
        )
        for curve in data
    ]  # fmt: skip
    sheet = make_sheet(
        ax, "spectra", _PANELS, (7.2, 5.4),
        mosaic=[["history", "history"], ["response", "fourier"]], height_ratios=[1.0, 1.7],
    )  # fmt: skip
    history, response, fourier = sheet.panels
    highest = 0.0
    for curve, (part, spectrum, transform) in zip(data, results, strict=True):
        colour = text_colour() if curve.label is None else curve.colour
        values = unit.of(part[f"{_VARIABLE_PREFIX[str(component)]}ground_acceleration"])
        history.plot(part["time"], values, color=colour, linewidth=0.8, label=curve.label)
        zero_line(history)
        _draw_response_spectra(response, spectrum, unit, curve)
        values = amplitude.of(transform["fourier_amplitude"])
        highest = max(highest, float(values.max()))
        fourier.semilogx(transform["frequency"][1:], values[1:], color=colour, linewidth=0.7)
    history.set_xlim(
        min(float(part["time"][0]) for part, _, _ in results),
        max(float(part["time"][-1]) for part, _, _ in results),
    )
    history.set(xlabel="time [s]", ylabel=axis_label("acceleration\n", unit.words))
    response.set(xlabel="period [s]", ylabel=axis_label("pseudo-spectral acceleration", unit.words))
    response.set_ylim(bottom=0.0)
    if len(data) == 1:
        add_legend(response, title="damping", title_fontsize="small")
    if highest > 0.0:
        fourier.set_yscale("log")
        fourier.set_ylim(1e-4 * highest, 2.0 * highest)
    fourier.set(xlabel="frequency [Hz]", ylabel=axis_label("Fourier amplitude", amplitude.words))
    for axes in (response, fourier):
        label_log_ticks(axes, "x")
        grid(axes)
    if len(data) > 1:
        sheet.add_legend(*response.get_legend_handles_labels(), fontsize="small")
    sheet.set_title(motions_title(data), title)
    return sheet.panels


def _draw_response_spectra(
    axes: Axes, dataset: xr.Dataset, unit: DisplayUnit, curve: LabelledMotion
) -> None:
    drawn = dataset.sel(period=dataset["period"] > 0.0)
    ratios = dataset["damping_ratio"].to_numpy().tolist()
    for place, ratio in enumerate(ratios):
        damping = f"{100.0 * ratio:g} %"
        label = damping
        if curve.label is not None:
            label = curve.label if len(ratios) == 1 else f"{curve.label}, {damping}"
        values = unit.of(drawn["pseudo_spectral_acceleration"].isel(damping_ratio=place))
        colour = line_colour(place) if curve.label is None else curve.colour
        axes.semilogx(
            drawn["period"], values, color=colour, ls=line_style(place), lw=1.2, label=label
        )


class Average(StrEnum):
    """The average of a set."""

    MEDIAN = "median"
    MEAN = "mean"


_SUITE_OWNER: Final = "rf.plot.suite"
_MAX_NAMED: Final = 6
_PERIODS: Final = (np.geomspace(0.05, 5.0, 80), "s")


@draws("a set of GroundMotions")
def suite(
    motions: MotionsLike,
    periods: ArrayLike | Iterable[QuantityLike] = _PERIODS,
    damping_ratio: RatioLike = 0.05,
    *,
    component: str = "horizontal",
    target: TargetSpectrum | None = None,
    compared: Window = None,
    average: str = Average.MEDIAN,
    named: bool | None = None,
    acceleration: str | None = None,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Axes:
    """Draw the response spectra of a set of motions, with their median and spread, or their mean.

    Parameters
    ----------
    motions : MotionSuite, or sequence or mapping of GroundMotion
        The set.
    periods : (sequence, unit), Quantity or sequence of str, optional
        Natural periods; 80 from 0.05 s to 5 s unless given [s].
    damping_ratio : float, optional
        Damping ratio of the oscillators [1].
    component : {"horizontal", "vertical"}, optional
        Component of the motions.
    target : TargetSpectrum, optional
        Target spectrum, drawn at the periods for which it is defined.
    compared : (str or Quantity or None, str or Quantity or None), optional
        Shortest and longest period of the comparison with the target, which are shaded [s].
    average : {"median", "mean"}, optional
        The median of the set with its spread; or the mean, which codes use.
    named : bool, optional
        Whether each motion has its colour and its label in the legend; by default up to six
        motions.
    acceleration : str, optional
        Unit of accelerations; g unless given.

    Returns
    -------
    matplotlib.axes.Axes
        Pseudo-spectral accelerations on logarithmic axes. Median and spread are those of the
        logarithms; the band reaches one standard deviation above and below.

    Raises
    ------
    UnitsError, ComponentError
        As for :func:`rockframe.measures.response_spectrum`.

    Examples
    --------
    >>> import rockframe as rf
    >>> motions = {f"{f} Hz": rf.GroundMotion.sine_pulse("2.2 m/s^2", f"{f} Hz") for f in (1, 2)}
    >>> target = rf.TargetSpectrum.eurocode_8("0.3 g_0")
    >>> axes = rf.plot.suite(rf.MotionSuite(motions), target=target)
    >>> axes.get_ylabel()
    'pseudo-spectral acceleration [g]'
    """
    data = labelled_motions(motions, "suite")
    if target is not None:
        check_target(target, owner=_SUITE_OWNER)
    shown_average = checked_choice(Average, average, owner=_SUITE_OWNER, name="average")
    comparison = read_window(compared, "suite", "compared")
    unit = figure_units(units, "suite").axis_unit(ACCELERATION, "g", acceleration=acceleration)
    labelled = {curve.label or motions_title(data): curve.motion for curve in data}
    dataset = response_spectrum(labelled, periods, damping_ratio, component=component)
    dataset = dataset.sel(period=dataset["period"] > 0.0)
    if dataset.sizes["damping_ratio"] != 1:
        msg = f"{_SUITE_OWNER}: damping_ratio must be one number, got {short_repr(damping_ratio)}"
        raise ComponentError(msg)
    if not dataset.sizes["period"]:
        msg = f"{_SUITE_OWNER}: found no period above zero in {short_repr(periods)}"
        raise ComponentError(msg)
    damping = float(dataset["damping_ratio"].item())
    values = unit.of(
        dataset["pseudo_spectral_acceleration"].squeeze("damping_ratio").transpose("motion", ...)
    )
    period = dataset["period"].to_numpy()
    sheet = make_single_panel(ax, "suite", (6.0, 4.3))
    label_each = (
        len(data) <= _MAX_NAMED
        if named is None
        else checked_bool(named, owner=_SUITE_OWNER, name="named")
    )
    for place, (label, curve) in enumerate(zip(labelled, data, strict=True)):
        words: Any = label if label_each else ("motions" if place == 0 else None)
        sheet.axes.plot(
            period, values[place], label=words, linewidth=0.9 if label_each else 0.6,
            color=curve.colour if label_each else GREY,
            linestyle=curve.style if label_each else "-", alpha=0.8 if label_each else 0.5,
        )  # fmt: skip
    if len(data) > 1 and shown_average is Average.MEDIAN:
        _draw_spread(sheet.axes, period, values)
    elif len(data) > 1:
        sheet.axes.plot(period, values.mean(axis=0), color=BLUE, linewidth=1.8, label="mean")
    if target is not None:
        low, high = target.limits
        target_period = period[(period >= low) & (period <= high)]
        target_values = unit.of(target.at((target_period, "s")))
        words = "target"
        if not np.isclose(target.damping_ratio, damping):
            words = f"target, {100.0 * target.damping_ratio:g} % damping"
        sheet.axes.plot(target_period, target_values, color=VERMILLION, linewidth=1.8, label=words)
    sheet.axes.set(
        xscale="log", yscale="log", xlabel="period [s]",
        ylabel=axis_label("pseudo-spectral acceleration", unit.words),
    )  # fmt: skip
    sheet.axes.set_xlim(period[0], period[-1])
    if np.isfinite(comparison).any():
        low, high = np.clip(comparison, period[0], period[-1])
        sheet.axes.axvspan(low, high, color=PALE_BLUE, zorder=-1)
    label_log_ticks(sheet.axes)
    grid(sheet.axes)
    add_legend(sheet.axes)
    count = len(data)
    usual = f"{count} motion{'s' if count > 1 else ''}; damping {100.0 * damping:g} %"
    sheet.set_title(usual, title)
    return sheet.axes


def _draw_spread(axes: Axes, period: Any, values: Any) -> None:
    logarithms = np.log(values)
    median, spread = np.exp(logarithms.mean(axis=0)), logarithms.std(axis=0, ddof=1)
    low, high = median * np.exp(-spread), median * np.exp(spread)
    axes.fill_between(period, low, high, color=BLUE, alpha=0.15, linewidth=0.0)
    axes.plot(period, median, color=BLUE, linewidth=1.8, label="median")


_MAX_NAMED_BARS: Final = 50
"""Motions whose names stand beside their bars."""
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
        ncols=2, width_ratios=[1.7, 1.0],
    )  # fmt: skip
    drawn = dataset.sel(period=dataset["period"] > 0.0)
    period = drawn["period"].to_numpy()
    spectra, misfits = sheet.panels
    for place in range(count):
        words = "motions" if place == 0 else None
        spectrum = drawn["scaled_spectral_acceleration"].isel(motion=place)
        spectra.plot(period, spectrum, color=GREY, alpha=0.6, linewidth=0.6, label=words)
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
    if count <= _MAX_NAMED_BARS:
        words = [f"{name}, $\\times${f:.3g}" for name, f in zip(labels, factors, strict=True)]
        misfits.set_yticks(range(count), words, fontsize="x-small")
    for panel in sheet.panels:
        grid(panel)
    label_log_ticks(spectra)
    sheet.set_title(f"{count} motions; {dataset.attrs['target']}", title)
    return sheet.panels
