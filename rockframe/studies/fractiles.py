"""Fractile curves of scaled motions: response given intensity, and intensity given response."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_list
from rockframe.errors import ComponentError, StudyError, short_repr
from rockframe.motion.quantities import ArrayLike
from rockframe.results.outcome import overturns
from rockframe.results.schema import build_dataset, with_labels, with_variables
from rockframe.results.variables.studies import MOTION
from rockframe.results.variables.variable import unit_of, unit_suffix_of
from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.confidence import read_shares
from rockframe.studies.fragility.trials import attributes_of_system
from rockframe.studies.intensities import PeriodLike, measure_of_runs, period_attribute
from rockframe.studies.limit_states import check_runs, scalar_of
from rockframe.studies.sweeps.motions import SCALE, MotionsLike
from rockframe.suggestions import with_hints
from rockframe.units import Measure, RatioLike, Unit, to_ratio, to_si_values

_OWNER: Final = "fractile_curves"
_REFERENCES: Final = "Vamvatsikos and Cornell (2004), Earthquake Spectra 20, 523-553"
_CURVE_POINTS: Final = 201
"""Number of intensities, and of levels of the response, of the curves by default."""
_LEVEL_DIM: Final = "response_level"


@with_hints()
def fractile_curves(
    runs: xr.Dataset,
    intensity: str | xr.DataArray = SCALE,
    response: str = "peak_relative_rotation",
    *,
    label: str | None = None,
    period: PeriodLike | None = None,
    motions: MotionsLike | None = None,
    fractiles: Sequence[RatioLike] = (0.16, 0.5, 0.84),
    levels: ArrayLike | None = None,
) -> xr.Dataset:
    """Summarize scaled motions: fractiles of the response at an intensity, and of the intensity.

    Parameters
    ----------
    runs : xarray.Dataset
        Result of :func:`rockframe.incremental_dynamic_analysis`, or of a sweep over the scale and
        motions.
    intensity : str or DataArray, optional
        Measure, as for :func:`rockframe.fragility`. The default is the scale of the motion.
    response : str, optional
        The scalar of the runs that is the response.
    label : str, optional
        Point, body or restrainer whose response is used, if there are several.
    period : str or Quantity, or several, optional
        Period of a spectral intensity [s].
    motions : GroundMotion, or sequence or mapping of them, optional
        The records; required if neither the dataset nor this process has them.
    fractiles : sequence of float, optional
        Shares of the motions [1].
    levels : (sequence, unit), Quantity or sequence of float, optional
        Increasing levels of the response. By default from the least response to the greatest.

    Returns
    -------
    xarray.Dataset
        Over the intensity: ``motion_response`` of each motion, ``response_fractile`` over
        ``quantile``, and ``overturned_count``. Over ``response_level``: ``intensity_fractile``, the
        intensity at which that share of the motions first reaches the level, and
        ``unreached_count``, the number of motions that do not. The response of a block that
        overturned is infinite, and so is the intensity of a motion that never reaches the level.
        The attribute ``verdict`` is a summary in words.

    Raises
    ------
    ComponentError, UnitsError
        An argument is out of range, has a wrong unit, or names an unknown measure or scalar.
    SchemaError
        The dataset is not the result of a sweep.
    StudyError
        The runs have axes other than the scale and motions, or their intensities have no common
        range.

    Notes
    -----
    Vamvatsikos and Cornell (2004), :eq:`eq-fractiles`. The response to a motion is interpolated
    linearly between its runs. Between a run that stands and one that overturns it is constant up to
    the scale at which the verdict changes: the bracket of a dynamic analysis, or the run that
    overturned in a sweep. Curves begin at the greatest of the motions' least intensities, and end
    at the least of their greatest intensities. A fractile is the least value that at least that
    share of the motions does not exceed, so that infinite values count like any other. If the first
    run of a motion already reaches a level, its intensity is used there as an upper bound.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> motions = [rf.GroundMotion.stochastic(6.5, "10 km", seed=k) for k in range(5)]
    >>> runs = rf.sweep(system, motions, scale=[1, 2, 3, 4], accuracy="fast")
    >>> curves = rf.fractile_curves(runs, "PGA")
    >>> dict(curves.response_fractile.sizes)
    {'quantile': 3, 'peak_ground_acceleration': 201}
    """
    runs = check_runs(runs, owner=_OWNER)
    shares = read_shares(fractiles, "fractiles", owner=_OWNER)
    measure = measure_of_runs(runs, intensity, period, motions, owner=_OWNER)
    values = scalar_of(runs, response, label, owner=_OWNER)
    curves = _response_curves(runs, measure, abs(values))
    low = max(float(curve.intensities[0]) for curve in curves)
    high = min(float(curve.intensities[-1]) for curve in curves)
    if not low < high:
        msg = (
            f"{_OWNER}: the motions have no range of {measure.name} in common: from {low:.4g} all "
            f"have been run, up to {high:.4g}; give them more scales"
        )
        raise StudyError(msg)
    intensities = np.linspace(low, high, _CURVE_POINTS)
    requested = _read_levels(levels, values, curves)
    responses = np.stack([curve.response_at(intensities) for curve in curves])
    reached = np.stack([curve.first_intensities(requested) for curve in curves])
    name = str(measure.name)
    title = "Fractile curves of scaled motions"
    dataset = build_dataset(
        {}, {"references": _REFERENCES}, title=title, source="runs of scaled motions"
    )
    for variable, value, over in (
        ("motion_response", responses, (MOTION, name)),
        ("response_fractile", fractiles_of(responses, shares), ("quantile", name)),
        ("overturned_count", np.isinf(responses).sum(axis=0), (name,)),
        ("intensity_fractile", fractiles_of(reached, shares), ("quantile", _LEVEL_DIM)),
        ("unreached_count", np.isinf(reached).sum(axis=0), (_LEVEL_DIM,)),
    ):
        dataset = with_variables(dataset, {variable: value}, over=over)
    names = np.array([curve.name for curve in curves], dtype=object)
    dataset = with_variables(dataset, {MOTION: names, "quantile": shares})
    dataset = with_labels(dataset, {name: (name, intensities, measure.attrs)})
    dataset = with_variables(dataset, {_LEVEL_DIM: requested})
    for variable in ("motion_response", "response_fractile", _LEVEL_DIM):
        dataset[variable].attrs["units"] = unit_of(values.attrs)
    dataset["intensity_fractile"].attrs["units"] = unit_of(measure.attrs)
    attributes = period_attribute(runs, [intensity], period, owner=_OWNER)
    return dataset.assign_attrs(
        {**attributes_of_system(runs), "intensity": name, **attributes,
         "response": response if label is None else f"{response} {label}",
         "verdict": _sentence(curves, low, high, measure, overturns(runs).size)}
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class _ResponseCurve:
    """The response of a motion along its intensity."""

    name: str
    intensities: Array  # intensities of all runs with a verdict, ascending
    # breakpoints of the response where the block stands: intensities and values
    points: Array
    values: Array
    overturning: tuple[tuple[float, float], ...]  # ranges where it overturns, ends included

    def response_at(self, intensities: Array) -> Array:
        """Return the response at intensities, infinite where the block overturns."""
        responses = np.interp(intensities, self.points, self.values)
        for first, last in self.overturning:
            responses[(intensities >= first) & (intensities <= last)] = np.inf
        return responses

    def first_intensities(self, levels: Array) -> Array:
        """Return the least intensities at which levels are reached; infinite where they are not."""
        highest = np.maximum.accumulate(self.values)
        place = np.searchsorted(highest, levels, side="left")
        intensities = np.full(levels.shape, self.overturning[0][0] if self.overturning else np.inf)
        for k, (level, right) in enumerate(zip(levels, place, strict=True)):
            if right == len(highest):
                continue
            reached = self.points[right]
            if right > 0:
                ends = self.values[right - 1 : right + 1]
                reached = np.interp(level, ends, self.points[right - 1 : right + 1])
            intensities[k] = min(intensities[k], reached)
        return intensities


def _response_curves(
    runs: xr.Dataset, measure: xr.DataArray, values: xr.DataArray
) -> list[_ResponseCurve]:
    """Return the response curve of each motion."""
    verdict = overturns(runs)
    wide = [str(dim) for dim, size in verdict.sizes.items() if size > 1 and dim != MOTION]
    if len(wide) != 1 or MOTION not in verdict.dims:
        what = " and ".join(map(str, verdict.sizes))
        msg = (
            f"{_OWNER}: found runs over {what}; expected motions, and one scale of them: pick a "
            "value of anything else"
        )
        raise StudyError(msg)
    axis = wide[0]
    other_dims = [dim for dim in verdict.dims if dim not in (MOTION, axis)]

    def rows(array: xr.DataArray) -> Array:
        laid = array.broadcast_like(verdict).isel(dict.fromkeys(other_dims, 0))
        return laid.transpose(MOTION, axis).to_numpy().astype(np.float64)

    intensities, responses, falls = rows(measure), rows(values), rows(verdict)
    names = runs[MOTION].to_numpy().astype(str)
    curves: list[_ResponseCurve] = []
    for k, name in enumerate(names):
        known = ~np.isnan(falls[k]) & np.isfinite(intensities[k])
        known &= (falls[k] == 1.0) | np.isfinite(responses[k])
        if not known.any():
            msg = f"{_OWNER}: no run under {name} has a verdict"
            raise StudyError(msg)
        order = np.argsort(intensities[k], kind="stable")
        order = order[known[order]]
        ranges = _overturning_ranges(runs, k, intensities[k], axis)
        curves.append(
            _response_curve(
                name, intensities[k][order], responses[k][order], falls[k][order] == 1.0, ranges
            )
        )
    return curves


def _overturning_ranges(
    runs: xr.Dataset, motion: int, intensities: Array, dim: str
) -> list[tuple[float, float]] | None:
    """Return the ranges that overturn, by the brackets of a dynamic analysis; None for a sweep."""
    if dim != SCALE or not all(name in runs for name in ("scale_above", "exceeds_above")):
        return None
    last = runs.isel({"limit_state": -1, MOTION: motion}, missing_dims="ignore").squeeze()
    above, below, after = (
        last[name].to_numpy() for name in ("scale_above", "scale_below", "exceeds_above")
    )
    known = ~np.isnan(above)
    scales = np.log(runs[SCALE].to_numpy())
    rising = np.argsort(scales)

    def intensity_at(scale: float) -> float:  # measures are powers of the scale
        return float(np.exp(np.interp(np.log(scale), scales[rising], np.log(intensities[rising]))))

    ranges: list[tuple[float, float]] = []
    start = None if not known.any() or after[known][0] == 1.0 else float(intensities.min())
    for low, high, exceeds in zip(below[known], above[known], after[known], strict=True):
        if exceeds == 1.0:
            start = intensity_at(high)
        elif start is not None:
            ranges.append((start, intensity_at(low)))
            start = None
    return [*ranges, (start, np.inf)] if start is not None else ranges


def _response_curve(
    name: str,
    intensities: Array,
    values: Array,
    overturned: AnyArray,
    ranges: list[tuple[float, float]] | None,
) -> _ResponseCurve:
    """Return the curve through runs of ascending intensity, some of which may have overturned."""
    if not ranges:  # from the first of neighbours that overturned to the last
        edges = np.diff(np.concatenate([[False], overturned, [False]]).astype(int))
        firsts, lasts = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
        ranges = [
            (float(intensities[i]), float(intensities[j]) if j + 1 < len(intensities) else np.inf)
            for i, j in zip(firsts, lasts, strict=True)
        ]
    stands = ~overturned
    x, y = intensities[stands].tolist(), values[stands].tolist()
    for first, last in ranges if any(stands) else ():
        # constant from the last standing run to the fall, and from its end to the next one
        before, after = np.searchsorted(intensities[stands], [first, last], side="right")
        if before > 0:
            x.append(first)
            y.append(values[stands][before - 1])
        if np.isfinite(last) and after < stands.sum():
            x.append(last)
            y.append(values[stands][after])
    order = np.argsort(x, kind="stable")
    points, responses = np.array(x)[order], np.array(y)[order]
    if not len(points):
        points, responses = intensities[:1], np.array([np.inf])
    return _ResponseCurve(name, intensities, points, responses, tuple(ranges))


def fractiles_of(rows: Array, shares: Array) -> Array:
    """Return least values up to which at least these shares of the rows lie, :eq:`eq-fractiles`."""
    place = np.ceil(len(rows) * shares - 1e-9).astype(int) - 1
    return np.sort(rows, axis=0)[np.clip(place, 0, len(rows) - 1)]


def _read_levels(value: Any, values: xr.DataArray, curves: Sequence[_ResponseCurve]) -> Array:
    """Read the levels of the response, or give those from the least to the greatest."""
    if value is None:
        every = np.concatenate([curve.values for curve in curves])
        every = every[np.isfinite(every)]
        ends = (float(every.min()), float(every.max())) if len(every) else (0.0, 1.0)
        return np.linspace(*ends, _CURVE_POINTS + 1)[1:]  # every motion has reached the least
    unit = unit_of(values.attrs)
    if unit == Unit.ONE:
        listed = checked_list(value, owner=_OWNER, name="levels", of="numbers")
        levels = np.array([to_ratio(level, owner=_OWNER, name="levels") for level in listed])
    else:
        measure = Measure("a response", Unit(unit), f"1 {unit}")
        levels = np.array(to_si_values(value, measure, owner=_OWNER, name="levels"))
    if not len(levels) or not (np.diff(levels) > 0.0).all():
        msg = f"{_OWNER}: levels must be one or more, and increase, got {short_repr(value)}"
        raise ComponentError(msg)
    return levels


def _sentence(
    curves: Sequence[_ResponseCurve], low: float, high: float, measure: xr.DataArray, count: int
) -> str:
    """Return the verdict in words: how many motions overturned, from where half, and of what."""
    falls = [
        [(max(first, low), last) for first, last in of if last >= low and first <= high]
        for of in (curve.overturning for curve in curves)
    ]
    unit = unit_suffix_of(measure.attrs)
    motions = f"{len(curves)} motion{'s' if len(curves) > 1 else ''}"
    text = f"Of {motions} {sum(map(bool, falls))} overturned at some "
    text += f"{str(measure.name).replace('_', ' ')} from {low:.4g} to {high:.4g}{unit}"
    # the number of overturned motions grows only where one begins to overturn
    for begin in sorted(first for ranges in falls for first, _ in ranges):
        fell = sum(any(first <= begin <= last for first, last in ranges) for ranges in falls)
        if fell >= 0.5 * len(curves):
            text += f", {'half of them' if len(curves) > 1 else 'first'} at {begin:.4g}{unit}"
            break
    missing = count - sum(len(curve.intensities) for curve in curves)
    if missing:
        verb = "is" if missing == 1 else "are"
        reason = "without a verdict, intensity or response"
        text += f". {missing} of {count} runs {verb} left out, {reason}"
    return f"{text}."
