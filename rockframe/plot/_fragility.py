"""Fragilities: curves with bands over one measure, contours over two."""

from typing import TYPE_CHECKING, Final

import numpy as np
import xarray as xr

from rockframe.plot._axes import COLOURS, grid, label_of_intensity
from rockframe.plot._given import check_study
from rockframe.plot._panels import Panels, sheet, single
from rockframe.results.variables.analyses import FragilityStatus

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rockframe.plot._panels import AxesLike

_NAME: Final = "exceedance_probability"
_LEVELS: Final = (0.05, 0.16, 0.5, 0.84, 0.95)
_KNOWN: Final = (FragilityStatus.FITTED, FragilityStatus.SEPARATED)


def fragility(
    dataset: xr.Dataset, *, ax: "AxesLike" = None, title: str | None = None
) -> "Axes | Panels":
    """Draw the probability that limit states are exceeded.

    Over one measure, a curve for each limit state with its confidence band, and the shares that
    were counted, with the bounds of Clopper and Pearson. Over two measures, contours of the
    probability, in a panel for each limit state that has a fit.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.fragility`.
    ax : Axes, or one for each limit state, optional
        What is drawn in; a new figure unless given.
    title : str, optional
        Title of the figure; the verdict unless given.

    Returns
    -------
    matplotlib.axes.Axes, or Panels
        The latter over two measures.

    Raises
    ------
    SchemaError
        The dataset is no fragility; the message names the function that draws what was given.
    """
    given = check_study(dataset, "fragility")
    if "limit_state" not in given.dims:
        given = given.expand_dims("limit_state")
    measures = [str(dim) for dim in given[_NAME].dims if dim != "limit_state"]
    states = [given.isel(limit_state=k) for k in range(given.sizes["limit_state"])]
    if len(measures) == 1:
        on = single(ax, "fragility", (6.0, 4.1))
        _curves(on.axes, states, measures[0])
    else:
        fitted = FragilityStatus.FITTED
        drawn = [one for one in states if int(one["fragility_status"]) == fitted] or states[-1:]
        on = sheet(
            ax, "fragility", [_name(one) for one in drawn], (0.8 + 3.6 * len(drawn), 3.8),
            lambda figure: figure.subplots(1, len(drawn)),
        )  # fmt: skip
        for axes, one in zip(on.panels, drawn, strict=True):
            _contours(axes, one, measures)
    on.entitle(str(dataset.attrs.get("verdict", "")), title)
    return on.axes if len(measures) == 1 else on.panels


def _curves(axes: "Axes", states: list[xr.Dataset], measure: str) -> None:
    for number, one in enumerate(states):
        colour = COLOURS[number % len(COLOURS)]
        along = one[measure].to_numpy()
        name = _name(one)
        if int(one["fragility_status"]) in _KNOWN:
            low, high = (one[f"{_NAME}_{end}_bound"].to_numpy() for end in ("lower", "upper"))
            axes.fill_between(along, low, high, color=colour, alpha=0.15, linewidth=0.0)
            axes.plot(along, one[_NAME].to_numpy(), color=colour, label=name)
        else:
            axes.plot([], [], color=colour, label=f"{name}: no fit")
        fraction = one["stripe_fraction"].to_numpy()
        ends = [one[f"stripe_fraction_{end}_bound"].to_numpy() for end in ("lower", "upper")]
        reach = np.abs(np.stack(ends) - fraction)
        # side by side where limit states were counted at one intensity
        place = one["stripe_intensity"].to_numpy() * 1.012 ** (number - 0.5 * (len(states) - 1))
        axes.errorbar(place, fraction, yerr=reach, fmt="o", color=colour, ms=3.0, lw=0.8, alpha=0.7)
    axes.set(
        xlabel=label_of_intensity(states[0][measure], states[0]),
        ylabel="probability of exceedance [-]",
        ylim=(-0.02, 1.02),
    )
    axes.set_xlim(left=0.0)
    axes.legend(frameon=False, fontsize="small", loc="best")
    grid(axes)


def _contours(axes: "Axes", one: xr.Dataset, measures: list[str]) -> None:
    across, up = measures
    surface = one[_NAME].transpose(up, across)
    axes.contourf(
        one[across], one[up], surface, levels=np.linspace(0.0, 1.0, 21), cmap="Blues", alpha=0.8
    )
    lines = axes.contour(
        one[across], one[up], surface, levels=_LEVELS, colors=COLOURS[0], linewidths=0.9
    )
    axes.clabel(lines, fontsize="small", fmt="%.2f")
    axes.set(
        xlabel=label_of_intensity(one[across], one),
        ylabel=label_of_intensity(one[up], one),
        title=_name(one),
    )


def _name(one: xr.Dataset) -> str:
    return str(one["limit_state"].item()) if "limit_state" in one.coords else "counted"
