"""Spectra of sets of motions: each of them, their median and their spread."""

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from rockframe.plot._axes import BLUE, GREY, VERMILLION, axis_label, grid, key, plain_ticks
from rockframe.plot._motions import drawn_motions, motions_title
from rockframe.plot._panels import single
from rockframe.plot._units import unit_of
from rockframe.units import ACCELERATION

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.axes import Axes

    from rockframe.motion.quantities import ArrayLike
    from rockframe.plot._motions import MotionsLike
    from rockframe.plot._panels import AxesLike
    from rockframe.suites import TargetSpectrum
    from rockframe.units import QuantityLike, RatioLike

_MOST_NAMED: Final = 6
_PERIODS: Final = (np.geomspace(0.05, 5.0, 80), "s")


def suite(
    motions: "MotionsLike",
    periods: "ArrayLike | Iterable[QuantityLike]" = _PERIODS,
    damping_ratio: "RatioLike" = 0.05,
    *,
    component: str = "horizontal",
    target: "TargetSpectrum | None" = None,
    acceleration: str = "g_0",
    ax: "AxesLike" = None,
    title: str | None = None,
) -> "Axes":
    """Draw the response spectra of a set of motions, with their median and spread.

    Parameters
    ----------
    motions : MotionSuite, or sequence or mapping of GroundMotion
        The set.
    periods : (sequence, unit), Quantity or sequence of str, optional
        Natural periods; 80 from 0.05 s to 5 s unless given [s].
    damping_ratio : float, optional
        Of the oscillators [1].
    component : {"horizontal", "vertical"}, optional
        Which acceleration.
    target : TargetSpectrum, optional
        Drawn beside them.
    acceleration : str, optional
        Unit.
    ax : Axes, optional
        What is drawn in; a new figure unless given.
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.axes.Axes
        Pseudo-spectral accelerations on logarithmic axes. Median and spread are those of the
        logarithms; the band reaches one standard deviation to both sides. Up to six motions have a
        line in the legend.

    Raises
    ------
    UnitsError, ComponentError
        As for :func:`rockframe.measures.response_spectrum`.
    """
    from rockframe.measures import response_spectrum

    given = drawn_motions(motions, "suite")
    unit = unit_of(acceleration, ACCELERATION, function="suite", name="acceleration")
    named = {one.label or motions_title(given): one.motion for one in given}
    found = response_spectrum(named, periods, damping_ratio, component=component)
    found = found.isel(period=np.flatnonzero(found["period"].to_numpy() > 0.0))
    values = unit.of(
        found["pseudo_spectral_acceleration"].squeeze("damping_ratio").transpose("motion", ...)
    )
    period = found["period"].to_numpy()
    on = single(ax, "suite", (6.0, 4.3))
    few = len(given) <= _MOST_NAMED
    for place, (label, one) in enumerate(zip(named, given, strict=True)):
        words: Any = label if few else ("motions" if place == 0 else None)
        on.axes.plot(
            period, values[place], label=words, linewidth=0.9 if few else 0.6,
            color=one.colour if few else GREY, linestyle=one.style if few else "-",
            alpha=0.8 if few else 0.5,
        )  # fmt: skip
    if len(given) > 1:
        _draw_spread(on.axes, period, values)
    if target is not None:
        low, high = target.limits
        known = period[(period >= low) & (period <= high)]
        wanted = target.at((known, "s"))
        on.axes.plot(known, unit.of(wanted), color=VERMILLION, linewidth=1.8, label="target")
    on.axes.set(
        xscale="log", yscale="log", xlabel="period [s]",
        ylabel=axis_label("pseudo-spectral acceleration", unit.words),
    )  # fmt: skip
    on.axes.set_xlim(period[0], period[-1])
    plain_ticks(on.axes)
    grid(on.axes)
    key(on.axes, frameon=False)
    count = len(given)
    damping = float(found["damping_ratio"].to_numpy().ravel()[0])
    usual = f"{count} motion{'s' if count > 1 else ''}; damping {100.0 * damping:g} %"
    on.entitle(usual, title)
    return on.axes


def _draw_spread(axes: "Axes", period: Any, values: Any) -> None:
    logarithms = np.log(values)
    median, spread = np.exp(logarithms.mean(axis=0)), logarithms.std(axis=0, ddof=1)
    low, high = median * np.exp(-spread), median * np.exp(spread)
    axes.fill_between(period, low, high, color=BLUE, alpha=0.15, linewidth=0.0)
    axes.plot(period, median, color=BLUE, linewidth=1.8, label="median")
