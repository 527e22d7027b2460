"""Empirical distributions, sensitivities of overturning, and fragilities."""

from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import SchemaError, first_along
from rockframe.plot._axes import (
    COLOURS,
    figure_units,
    grid,
    intensity_label,
    limit_state_label,
    line_colour,
    line_style,
    text_colour,
    unique_labels,
    value_label,
    variable_label,
)
from rockframe.plot._checks import draws, figure_data
from rockframe.plot._panels import Axes, AxesLike, Panels, Sheet, make_sheet, make_single_panel
from rockframe.results.outcome import overturns
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.studies.fragility.words import measures_of, verdict_of_fragility
from rockframe.studies.sweeps.labelling import cases_verdict
from rockframe.units.display import UnitsLike, with_superscripts


@draws(
    "an ensemble",
    "rf.ensemble_statistics(runs)",
    ("ordered_value", "cumulative_probability"),
    along=("rank",),
)
def ensemble(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Axes:
    """Draw an empirical distribution with its bands.

    The dark band has the bounds at each single value, the light one the simultaneous bounds.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> runs = rf.sweep(system, pulse, scale=[0.8, 1.0, 1.1])
    >>> found = rf.ensemble_statistics(runs, "peak_rotation", pooled=["scale"])
    >>> rf.plot.ensemble(found).get_xlabel()
    'peak rotation [rad]'
    """
    data = figure_data(dataset, "ensemble", units)
    sheet = make_single_panel(ax, "ensemble", (5.6, 3.9))
    axes = sheet.axes
    values = data["ordered_value"].rename(str(data.attrs["variable"]))
    for name, alpha, words in (
        ("simultaneous", 0.12, "bounds everywhere at once"),
        ("cumulative_probability", 0.25, "bounds at each value"),
    ):
        low, high = _bounds(data, name)
        label = words if np.isfinite(low).any() else None
        axes.fill_between(
            values, low, high, step="post", color=COLOURS[0], alpha=alpha, lw=0.0, label=label
        )
    axes.step(values, data["cumulative_probability"], where="post", color=COLOURS[0])
    axes.set(xlabel=variable_label(values), ylabel="share of the ensemble [-]", ylim=(0.0, 1.02))
    return sheet.finish(with_superscripts(str(data.attrs["verdict"])), title)


@draws(
    "a sample",
    "rf.probability_of_overturning(system, motions, ...)",
    ("overturning_probability", "first_order_index"),
    along=("case", "parameter"),
    ax="two Axes",
    title="the verdict",
)
def probability(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Panels:
    """Draw the sensitivity of the verdict to parameters.

    The left panel shows first-order indices. The right one shows, for the parameter with the
    largest index, the shares that overturned in groups of cases.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> spread = {"width": ("uniform", "0.7 m", "0.9 m")}
    >>> found = rf.probability_of_overturning(system, pulse, spread=spread, cases=40)
    >>> [axes.get_xlabel() for axes in rf.plot.probability(found)]
    ['first-order index [-]', 'width [m]']
    """
    data = figure_data(dataset, "probability", units)
    sheet = make_sheet(ax, "probability", ("indices", "shares"), (7.6, 3.6), ncols=2)
    left, right = sheet.panels
    names = [str(name).replace("_", " ") for name in data["parameter"].to_numpy()]
    indices = data["first_order_index"].fillna(0.0).to_numpy()
    left.barh(names[::-1], indices[::-1], color=COLOURS[0])
    left.set(xlabel="first-order index [-]", xlim=(0.0, None), ylim=(-0.6, len(names) - 0.4))
    if data["first_order_index"].isnull().all():
        left.set_xticks([])
        left.text(0.5, 0.5, "all verdicts are alike", ha="center", transform=left.transAxes)
    first = data[str(data["parameter"].to_numpy()[0])]
    verdict = overturns(data).to_numpy()
    decided = ~np.isnan(verdict)
    values, verdict = first.to_numpy()[decided], verdict[decided]
    if first.dtype.kind == "f":
        groups = min(_MAX_GROUPS, values.size)
        cuts = np.quantile(values, np.linspace(0.0, 1.0, groups + 1))
        place = np.clip(np.searchsorted(cuts, values, side="right") - 1, 0, groups - 1)
        right.stairs(_shares(verdict, place, groups), cuts, fill=True, color=COLOURS[1], alpha=0.6)
        right.set(xlabel=variable_label(first))
    else:
        labels, place = np.unique(values.astype(str), return_inverse=True)
        shares = _shares(verdict, place, len(labels))
        right.bar(range(len(labels)), shares, color=COLOURS[1], alpha=0.6)
        right.set(xlabel="motion")
        if len(labels) <= _MAX_NAMED:
            ticks = unique_labels(labels, 20)
            right.set_xticks(range(len(labels)), ticks, rotation=90, fontsize="x-small")
    right.set(ylabel="share that overturns [-]", ylim=(0.0, 1.02))
    for axes in sheet.panels:
        grid(axes)
    sentence = figure_units(units, "probability").reader.convert_text(cases_verdict(dataset))
    sheet.set_title(sentence, title)
    return sheet.panels


def _bounds(dataset: xr.Dataset, name: str) -> Any:
    """Return the lower and the upper bound of a variable."""
    return np.stack([dataset[f"{name}_{end}_bound"].to_numpy() for end in ("lower", "upper")])


def _shares(verdicts: Any, groups: Any, count: int) -> Any:
    """Return the shares that overturned in groups, NaN in one that equal values leave empty."""
    sizes = np.bincount(groups, minlength=count)
    overturned = np.bincount(groups, weights=verdicts, minlength=count)
    return np.divide(overturned, sizes, out=np.full(count, np.nan), where=sizes > 0)


@draws(
    "a subset simulation",
    "rf.subset_simulation(system, motions, ...)",
    ("demand", "sample_weight", "demand_threshold"),
    along=("case", "sampling_level"),
    title="the verdict",
)
def subset_simulation(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Axes:
    """Draw the probability that the demand reaches a value, level by level.

    Dotted lines are the thresholds of the levels. The probability of the limit state, with its
    bounds, is drawn at the limit, or at the right if the limit is infinite.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> spread = {"scale": ("lognormal", 1.5, 0.4)}
    >>> found = rf.subset_simulation(system, pulse, spread=spread, limit=0.5, cases=100)
    >>> rf.plot.subset_simulation(found).get_ylabel()
    'probability of reaching it [-]'
    """
    data = figure_data(dataset, "subset_simulation", units)
    sheet = make_single_panel(ax, "subset_simulation", (6.0, 4.1))
    axes = sheet.axes
    drawn = data["demand"].notnull().to_numpy()
    demand = data["demand"].to_numpy()[drawn]
    order = np.argsort(-demand, kind="stable")
    demand, level = demand[order], data["sample_level"].to_numpy()[drawn][order]
    reached = np.cumsum(data["sample_weight"].to_numpy()[drawn][order])
    finite = np.isfinite(demand)
    # the last of several samples with equal demand has the weight of all of them
    last = np.flatnonzero(finite & np.append(demand[1:] != demand[:-1], True))
    for number in data["sampling_level"].to_numpy():
        of_level = last[level[last] == number]
        # near a threshold there are samples of both levels
        axes.plot(
            demand[of_level], reached[of_level], ".", ms=3.5, color=line_colour(int(number) - 1)
        )
    for threshold in data["demand_threshold"].to_numpy():
        if np.isfinite(threshold):
            axes.axvline(threshold, color=text_colour(), lw=0.8, ls=":")
    limit = float(data["demand_threshold"][-1])
    largest = float(demand[finite].max(initial=0.0)) or 1.0
    plotted_at = limit if np.isfinite(limit) else 1.08 * largest
    probability = float(data[_PROBABILITY])
    bounds = _bounds(data, _PROBABILITY)
    if probability > 0.0:
        errors = np.abs(bounds - probability)[:, None]
        axes.errorbar(
            plotted_at, probability, yerr=errors, fmt="D", ms=5.0, capsize=3.0, color=text_colour()
        )
    else:
        axes.plot(plotted_at, bounds[1], "v", ms=6.0, color=text_colour())
    axes.set(
        yscale="log", xlabel="response over its limit [-]", xlim=(0.0, None),
        ylabel="probability of reaching it [-]",
    )  # fmt: skip
    return sheet.finish(with_superscripts(str(data.attrs["verdict"])), title)


_MAX_GROUPS: Final = 12
"""Groups of cases by the value of a parameter."""
_MAX_NAMED: Final = 30
"""Motions whose names stand below their bars."""
_PROBABILITY: Final = "exceedance_probability"
_CONTOUR_LEVELS: Final = (0.05, 0.16, 0.5, 0.84, 0.95)
_MAX_STRUCTURES: Final = 12
"""Largest number of structures that colours and dashes can distinguish."""
_FITTED_STATUSES: Final = (FragilityStatus.FITTED, FragilityStatus.SEPARATED)


@draws(
    "a fragility",
    "rf.fragility(runs)",
    ("exceedance_probability", "fragility_status"),
    ax="Axes, or one for each limit state",
    title="the verdict",
)
def fragility(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Axes | Panels:
    """Draw the probability that limit states are exceeded.

    Over one measure there is a curve for each limit state, with its band if it has bounds, and the
    counted shares with the bounds of Clopper and Pearson. Several structures have a panel for each
    limit state, with a curve for each structure. Over two measures there are contours of the
    probability, in a panel for each limit state that has a fit.

    Returns
    -------
    matplotlib.axes.Axes, or Panels
        Panels for two measures and for several structures.

    Raises
    ------
    SchemaError
        The dataset is not a fragility; the message names the function that draws what was given.
        Or it has more structures than a figure shows: twelve, or one over two measures.

    Examples
    --------
    >>> import rockframe as rf
    >>> counts = {"intensity": ([2, 4, 8], "m/s^2"), "exceeded": [1, 6, 19], "trials": 20}
    >>> rf.plot.fragility(rf.fragility(counts, "PGA"), units={"acceleration": "g"}).get_xlabel()
    'peak ground acceleration [g]'
    """
    data = figure_data(dataset, "fragility", units)
    if "limit_state" not in data.dims:
        data = data.expand_dims("limit_state")
    alone = [dim for dim, size in data["fragility_status"].sizes.items() if size == 1]
    data = data.isel({dim: 0 for dim in alone if dim != "limit_state"})
    measures = measures_of(data)
    if not measures:
        msg = "rf.plot.fragility needs a fragility over intensities, got one at a single intensity"
        raise SchemaError(msg)
    states = [data.isel(limit_state=k) for k in range(data.sizes["limit_state"])]
    structures = [str(dim) for dim in states[0]["fragility_status"].dims]
    count = int(np.prod([data.sizes[dim] for dim in structures]))
    max_count = 1 if len(measures) > 1 else _MAX_STRUCTURES
    if count > max_count:
        msg = (
            f"rf.plot.fragility: found {count} structures, by {', '.join(structures)}; a figure "
            f"shows {max_count}: pick some, for example with "
            f"{first_along('fragility', structures[0])}"
        )
        raise SchemaError(msg)
    if len(measures) == 1 and not structures:
        sheet = make_single_panel(ax, "fragility", (6.0, 4.1))
        _draw_curves(
            sheet.axes, [(limit_state_label(state), state) for state in states], measures[0]
        )
    elif structures:
        sheet = _limit_state_panels(ax, states)
        for axes, state in zip(sheet.panels, states, strict=True):
            _draw_curves(axes, _labelled_structures(state, structures), measures[0])
            axes.set_title(limit_state_label(state))
    else:
        fitted = FragilityStatus.FITTED
        drawn = [state for state in states if int(state["fragility_status"]) == fitted] or states[
            -1:
        ]
        sheet = _limit_state_panels(ax, drawn)
        for axes, state in zip(sheet.panels, drawn, strict=True):
            _draw_contours(axes, state, measures)
    if len(measures) == 1:
        sheet.add_common_legend()
    sheet.set_title(with_superscripts(verdict_of_fragility(data)), title)
    return sheet.axes if len(measures) == 1 and not structures else sheet.panels


def _limit_state_panels(ax: AxesLike, states: list[xr.Dataset]) -> Sheet:
    """Return a panel for each limit state."""
    names = [limit_state_label(state) for state in states]
    return make_sheet(ax, "fragility", names, (0.8 + 3.6 * len(names), 3.8), ncols=len(names))


def _labelled_structures(state: xr.Dataset, structures: list[str]) -> list[tuple[str, xr.Dataset]]:
    """Return each structure with its label."""
    labelled: list[tuple[str, xr.Dataset]] = []
    for place in np.ndindex(*(state.sizes[dim] for dim in structures)):
        part = state.isel(dict(zip(structures, place, strict=True)))
        words = [
            f"{str(name).replace('_', ' ')} {value_label(part[name])}"
            for name in state.coords
            if set(state[name].dims) & set(structures)
        ]
        labelled.append((", ".join(words), part))
    return labelled


def _draw_curves(axes: Axes, named: list[tuple[str, xr.Dataset]], measure: str) -> None:
    for number, (name, curve) in enumerate(named):
        colour, dashes = line_colour(number), line_style(number)
        along = curve[measure].to_numpy()
        if int(curve["fragility_status"]) in _FITTED_STATUSES:
            axes.fill_between(
                along, *_bounds(curve, _PROBABILITY), color=colour, alpha=0.15, linewidth=0.0
            )
            separated = int(curve["fragility_status"]) == FragilityStatus.SEPARATED
            words = f"{name}: separated" if separated else name
            axes.plot(
                along, curve[_PROBABILITY].to_numpy(), color=colour, linestyle=dashes, label=words
            )
        else:
            axes.plot([], [], color=colour, label=f"{name}: no fit")
        fraction = curve["stripe_fraction"].to_numpy()
        errors = np.abs(_bounds(curve, "stripe_fraction") - fraction)
        errors[:, curve["stripe_trials"].to_numpy() < 2] = np.nan  # no bounds from a single trial
        # side by side, since limit states are counted at the same intensities
        intensity = curve["stripe_intensity"].to_numpy() * 1.012 ** (
            number - 0.5 * (len(named) - 1)
        )
        axes.errorbar(
            intensity, fraction, yerr=errors, fmt="o", color=colour, ms=3.0, lw=0.8, alpha=0.7
        )
    axes.set_xlabel(intensity_label(named[0][1][measure], named[0][1]))
    axes.set(ylabel="probability of exceedance [-]", ylim=(-0.02, 1.02), xlim=(0.0, None))
    grid(axes)


def _draw_contours(axes: Axes, state: xr.Dataset, measures: list[str]) -> None:
    across, up = measures
    drawn = state[across], state[up], state[_PROBABILITY].transpose(up, across)
    axes.contourf(*drawn, levels=np.linspace(0.0, 1.0, 21), cmap="Blues", alpha=0.5)
    lines = axes.contour(*drawn, levels=_CONTOUR_LEVELS, colors=COLOURS[0], linewidths=0.9)
    for label in axes.clabel(lines, fontsize="small", fmt="%.2f", inline_spacing=2, colors="black"):
        label.set_bbox({"facecolor": "white", "alpha": 0.85, "edgecolor": "none", "pad": 0.6})
        label.set_rotation(0.0)
    axes.set(xlabel=intensity_label(state[across], state), title=limit_state_label(state))
    axes.set_ylabel(intensity_label(state[up], state))
