"""Ensembles: empirical distributions, and what overturning depends on."""

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from rockframe.plot._axes import COLOURS, grid, label_of
from rockframe.plot._checks import check_study
from rockframe.plot._panels import Panels, sheet, single
from rockframe.results.outcome import overturns
from rockframe.studies.sweeps.words import cases_verdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rockframe.plot._panels import AxesLike


def ensemble(dataset: xr.Dataset, *, ax: "AxesLike" = None, title: str | None = None) -> "Axes":
    """Draw an empirical distribution with its bands.

    Dark, the bounds that hold at each value; light, those that hold everywhere at once.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.ensemble_statistics`.
    ax : Axes, optional
        What is drawn in; a new figure unless given.
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    SchemaError
        The dataset is no ensemble.
    """
    given = check_study(dataset, "ensemble")
    on = single(ax, "ensemble", (5.6, 3.9))
    axes = on.axes
    values = given["ordered_value"].rename(str(given.attrs["variable"]))
    for names, alpha in (
        (("simultaneous_lower_bound", "simultaneous_upper_bound"), 0.12),
        (("cumulative_probability_lower_bound", "cumulative_probability_upper_bound"), 0.25),
    ):
        low, high = (given[name].to_numpy() for name in names)
        axes.fill_between(
            values, low, high, step="post", color=COLOURS[0], alpha=alpha, linewidth=0.0
        )
    axes.step(values, given["cumulative_probability"], where="post", color=COLOURS[0])
    axes.set(xlabel=label_of(values), ylabel="share of the ensemble [-]", ylim=(0.0, 1.02))
    grid(axes)
    on.entitle(str(given.attrs["verdict"]), title)
    return axes


def probability(
    dataset: xr.Dataset, *, ax: "AxesLike" = None, title: str | None = None
) -> "Panels":
    """Draw what the verdict depends on, and how the share that overturns goes with it.

    Left, first-order indices; right, for the parameter that matters most, the shares that
    overturned in groups of cases.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.probability_of_overturning`.
    ax : two Axes, optional
        What is drawn in; a new figure unless given.
    title : str, optional
        Title of the figure; the verdict unless given.

    Returns
    -------
    Panels

    Raises
    ------
    SchemaError
        The dataset is no such sample.
    """
    given = check_study(dataset, "probability")
    names = ("indices", "shares")
    on = sheet(ax, "probability", names, (7.6, 3.6), lambda figure: figure.subplots(1, 2))
    left, right = on.panels
    names = [str(name).replace("_", " ") for name in given["parameter"].to_numpy()]
    left.barh(names[::-1], given["first_order_index"].to_numpy()[::-1], color=COLOURS[0])
    left.set(xlabel="first-order index [-]", xlim=(0.0, None))
    first = given[str(given["parameter"].to_numpy()[0])]
    verdict = overturns(given).to_numpy()
    known = ~np.isnan(verdict)
    if first.dtype.kind == "f":
        cuts = np.quantile(first.to_numpy()[known], np.linspace(0.0, 1.0, 13))
        place = np.clip(np.searchsorted(cuts, first.to_numpy()[known], side="right") - 1, 0, 11)
        shares = [verdict[known][place == k].mean() for k in range(12)]
        right.stairs(shares, cuts, fill=True, color=COLOURS[1], alpha=0.6)
        right.set(xlabel=label_of(first))
    else:
        labels, place = np.unique(first.to_numpy()[known].astype(str), return_inverse=True)
        right.bar(
            range(len(labels)),
            [verdict[known][place == k].mean() for k in range(len(labels))],
            color=COLOURS[1],
            alpha=0.6,
        )
        right.set(xlabel="motion")
    right.set(ylabel="share that overturns [-]", ylim=(0.0, 1.02))
    for axes in on.panels:
        grid(axes)
    on.entitle(cases_verdict(given), title)
    return on.panels
