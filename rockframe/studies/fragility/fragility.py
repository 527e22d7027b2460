"""Fragility of runs, of dynamic analyses and of counts: the public function."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_choice, checked_list, checked_name, is_iterable
from rockframe.errors import ComponentError, SchemaError, short_repr
from rockframe.results.forces import share_words
from rockframe.results.schema import with_labels, with_variables
from rockframe.studies.confidence import read_confidence
from rockframe.studies.fragility.labelling import BoundSettings, fragility_dataset
from rockframe.studies.fragility.likelihood import Bands, Fit
from rockframe.studies.fragility.ordered import ordered_fits
from rockframe.studies.fragility.trials import (
    StructureTrials,
    Trials,
    attributes_of_system,
    flatten_like,
    motion_numbers,
    structures_of,
    trials_of_capacities,
    trials_of_runs,
)
from rockframe.studies.fragility.words import fragility_sentences, pooled_attribute
from rockframe.studies.intensities import Intensity, PeriodLike, measure_of_runs, period_attribute
from rockframe.studies.limit_states import (
    LimitState,
    check_runs,
    exceeds,
    labels_of_states,
    limit_states,
    states_of,
)
from rockframe.studies.sweeps.axes import read_in_unit_of
from rockframe.studies.sweeps.motions import SCALE, MotionsLike
from rockframe.suggestions import with_hints
from rockframe.units import RatioLike

_OWNER: Final = "fragility"
_COLUMNS: Final = ("intensity", "exceeded", "trials")
_CAPACITIES: Final = "capacities"
_COMMON: Final = "common"
_MAX_JACKKNIFE_MOTIONS: Final = 80
"""Motions up to which each is left out in turn; with more the sandwich has equal coverage."""


@with_hints()
def fragility(
    runs: xr.Dataset | dict[str, Any],
    intensity: str | xr.DataArray | Sequence[str | xr.DataArray] = "PGA",
    *,
    limits: Iterable[object] | None = None,
    period: PeriodLike | None = None,
    motions: MotionsLike | None = None,
    pooled: Iterable[str] = (),
    trials: str = "runs",
    dispersion: str = "each",
    bands: str | None = None,
    confidence: RatioLike = 0.95,
) -> xr.Dataset:
    """Fit lognormal capacities to runs by maximum likelihood, one for each structure.

    Parameters
    ----------
    runs : xarray.Dataset or dict
        Result of :func:`rockframe.sweep` or :func:`rockframe.incremental_dynamic_analysis`. Or
        counts, such as those of tests: ``"intensity"``, values with a unit such as ``([0.2, 0.3],
        "g_0")``; ``"exceeded"``, the number of trials that exceeded the limit state at each; and
        ``"trials"``, the number of trials at each.
    intensity : str, DataArray, or two of them
        Intensity measure: ``"PGA"``, ``"PGV"``, ``"PGD"``, ``"CAV"``, ``"SA"``, ``"Sa_avg"``,
        ``"PGV/PGA"``, or a name of :func:`rockframe.intensity_measures` or
        :func:`rockframe.response_spectrum`; the name of a coordinate or variable of the runs; or a
        DataArray of other values along dimensions of the runs, with a name and ``units``. Two
        measures give a fragility over both.
    limits : iterable, optional
        Limit states before overturning, in order: ``"uplift"``, and peak rotations relative to the
        overturning angle. The default is uplift, or the limit states of a dynamic analysis [1]. Or
        a limit on any scalar of the runs that grows with severity: its name and a value with a
        unit, such as ``("peak_slip", "5 cm")`` or ``("broken_restrainer_count", 1)``, and third, if
        the scalar has several points, bodies or restrainers, the label of one. Overturning exceeds
        each of them.
    period : str or Quantity, or several, optional
        Period of the oscillator of a spectral intensity; for ``"Sa_avg"`` the periods over which
        the spectrum is averaged, such as ``(numpy.linspace(0.2, 3, 57), "s")`` [s].
    motions : GroundMotion, or sequence or mapping of them, optional
        The records of the sweep; required if neither the dataset nor this process has them.
    pooled : iterable of str, optional
        Axes of the sweep, or columns of its table (``"case"`` for all), whose values are treated as
        one structure. Its dispersion then includes their differences.
    trials : {"runs", "capacities"}, optional
        Data of the fit: the verdicts of all runs; or the capacities of a dynamic analysis, the
        least scales found to exceed under each motion, above which a block may stand again. The
        former does not depend on the spacing of the scales.
    dispersion : {"each", "common"}, optional
        Whether each limit state has its own dispersion, so that extrapolated curves may cross, or
        all share one, by the likelihood of ordered verdicts of runs, :eq:`eq-fragility-ordered`, so
        that they cannot cross. A common dispersion requires limit states that include one another.
    bands : {"profile", "jackknife", "sandwich"}, optional
        Source of the confidence bounds: the profile of the likelihood, which assumes independent
        runs; fits that leave out each motion in turn; or the sandwich covariance with the runs of
        one motion as a cluster. If motions were run more than once, or with a common dispersion,
        the default is ``"jackknife"``, or ``"sandwich"`` for more than 80 motions. Otherwise, as
        for capacities and counts, it is ``"profile"``, or ``"sandwich"`` for two measures. Neither
        two measures nor a common dispersion have a profile.
    confidence : float, optional
        Nominal confidence level of all bounds [1]. The measured coverage with few motions is in
        :ref:`coverage of bounds <coverage>`; the verdict says when it is lower than nominal.

    Returns
    -------
    xarray.Dataset
        Over ``limit_state`` and the axes of the sweep that change neither motion nor intensity,
        with one curve for each combination: ``median_intensity``, ``dispersion``, their bounds and
        standard errors, and ``fragility_status``. Also over the intensity:
        ``exceedance_probability`` and its bounds. Over ``stripe``: the counts, with bounds of
        Clopper and Pearson. Two measures give the coefficients of the fit instead of median and
        dispersion; counts give the same variables without ``limit_state``. The attribute
        ``verdict`` is a summary in words.

    Raises
    ------
    ComponentError
        An argument is out of range or names an unknown measure, or each run has a different
        structure.
    SchemaError
        The dataset is not the result of a sweep.
    StudyError
        The motions must be given, or are not those of the sweep.

    Notes
    -----
    A capacity C is lognormal with median theta and dispersion beta. A run of intensity x exceeds
    the limit state if C < x, with probability Phi(ln(x / theta) / beta), :eq:`eq-fragility-curve`,
    Baker (2015). The fit maximizes the likelihood, :eq:`eq-fragility-likelihood`. If no fit exists,
    ``fragility_status`` gives the reason and the values are NaN: no run exceeded, all did, those
    that did are separated from those that did not, so that beta would be zero, or exceedances
    become rarer with the intensity. If they are separated, the median is in the middle of the gap
    and the dispersion is 0, which maximizes the likelihood; bounds are then given only for counts
    and for motions that were run once each. With fewer than five motions there are no bounds. Runs
    without a verdict are left out, ``left_out_count``.

    Rows of a table of cases that differ only in motion and scale are of one structure, which
    ``case`` labels by the first of them.

    Capacities of a dynamic analysis may be censored: only an upper bound is known if the least
    scale already exceeded, only a lower bound if none did. Censored capacities enter the likelihood
    with the probability of their range. If all are censored on the same side, there are neither fit
    nor bounds.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> motions = [rf.GroundMotion.stochastic(6.5, "10 km", seed=k) for k in range(8)]
    >>> runs = rf.sweep(system, motions, scale=[0.5, 1, 2, 4], accuracy="fast")
    >>> found = rf.fragility(runs, "PGA")
    >>> found.limit_state.values.tolist()
    ['uplift', 'overturning']

    Counts of Baker (2015):

    >>> levels = ([0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0], "g_0")
    >>> counts = {"intensity": levels, "exceeded": [0, 0, 0, 4, 6, 13, 12, 16], "trials": 40}
    >>> round(float(rf.fragility(counts, "PGA").dispersion), 3)
    0.429
    """
    if isinstance(runs, dict):
        arguments = {"limits": limits, "motions": motions, "pooled": pooled or None}
        given = [name for name, value in arguments.items() if value is not None]
        return _fit_counts(runs, intensity, period, bands, confidence, given)
    runs = check_runs(runs, owner=_OWNER)
    listed = _listed_measures(intensity)
    pooled_axes = checked_list(pooled, owner=_OWNER, name="pooled", of="names")
    structures = structures_of(runs, pooled_axes, listed, owner=_OWNER)
    kinds = "runs", _CAPACITIES
    of_capacities = checked_name(trials, kinds, owner=_OWNER, name="trials") == _CAPACITIES
    if of_capacities and "capacity_scale" not in runs:
        msg = f"{_OWNER}: capacities are those of rf.incremental_dynamic_analysis, found a sweep"
        raise SchemaError(msg)
    if of_capacities and SCALE not in runs.dims:
        msg = f"{_OWNER}: found a dynamic analysis at one scale; expected one with all its scales"
        raise SchemaError(msg)
    states = _read_states(runs, limits)
    measures = [measure_of_runs(runs, measure, period, motions, owner=_OWNER) for measure in listed]
    names = [str(measure.name) for measure in measures]
    if len(set(names)) < len(names):
        msg = f"{_OWNER}: the two intensity measures are one, {names[0]}; give another"
        raise ComponentError(msg)
    if ambiguous := [name for name in names if name in structures.groups]:
        msg = (
            f"{_OWNER}: the structures differ along {ambiguous[0]}, which is also the name of the "
            "intensity measure; give the intensity as a DataArray of another name"
        )
        raise ComponentError(msg)
    verdicts = [exceeds(runs, state) for state in states]
    sizes = [(len(np.unique(motion_numbers(structure))), structure.size)
             for structure in structures.parts(verdicts[-1])]  # fmt: skip
    repeated = not of_capacities and any(motions < count for motions, count in sizes)
    of_runs = Bands.JACKKNIFE if max(sizes)[0] <= _MAX_JACKKNIFE_MOTIONS else Bands.SANDWICH
    ways = "each", _COMMON
    common = checked_name(dispersion, ways, owner=_OWNER, name="dispersion") == _COMMON
    if common and (of_capacities or len(measures) > 1 or bands == "profile"):
        msg = (
            f"{_OWNER}: a common dispersion is fitted to runs, over one measure, with bands by "
            "'jackknife' or 'sandwich'"
        )
        raise ComponentError(msg)
    default_bands = of_runs if repeated or common else Bands.PROFILE
    settings = BoundSettings(
        _read_bands(bands, default_bands, len(measures)), read_confidence(confidence, owner=_OWNER)
    )
    by_motion = settings.bands is not Bands.PROFILE and (repeated or common)
    parts = zip(*(structures.parts(array) for array in (*verdicts, *measures)), strict=True)
    samples: list[StructureTrials] = []
    fits: list[Fit] | None = [] if common else None
    analyses = structures.parts(runs if of_capacities else runs[[]])
    for part, analysis in zip(parts, analyses, strict=True):
        state_verdicts, along = part[: len(states)], part[len(states) :]
        if fits is not None:
            fits += _fit_ordered(state_verdicts, along[0], states, settings.bands)
        for state, verdict in zip(states, state_verdicts, strict=True):
            if of_capacities:
                of_state = analysis
                if "limit_state" in analysis.dims:
                    of_state = analysis.sel(limit_state=state.name)
                samples.append(trials_of_capacities(of_state, verdict.notnull(), along))
            else:
                samples.append(trials_of_runs(verdict, along, by_motion=by_motion))
    sizes_of_results = dict(zip(structures.groups, structures.shape, strict=True))
    sizes_of_results["limit_state"] = len(states)
    dataset = fragility_dataset(
        samples, sizes_of_results,
        [(str(measure.name), dict(measure.attrs)) for measure in measures], settings,
        {"trials": trials, "dispersions": dispersion, **pooled_attribute(pooled_axes),
         **period_attribute(runs, listed, period, owner=_OWNER)}, fits,
    )  # fmt: skip
    dataset = with_labels(dataset, structures.coordinates)
    dataset = with_variables(dataset, labels_of_states(states))
    if of_capacities:
        below = np.array([int((~sample.trials.has_lower).sum()) for sample in samples])
        below = below.reshape(tuple(sizes_of_results.values()))
        dataset = with_variables(dataset, {"below_scan_count": below}, over=tuple(sizes_of_results))
    dataset.attrs["verdict"] = (
        f"{fragility_sentences(dataset)}{_sliding_sentence(runs, of_capacities=of_capacities)}"
    )
    changed = bool(structures.coordinates or pooled_axes)
    return dataset.assign_attrs(attributes_of_system(runs, changed=changed))


def _fit_counts(
    counts: Mapping[Any, Any],
    measure: object,
    period: PeriodLike | None,
    bands: str | None,
    confidence: RatioLike,
    given: Sequence[str],
) -> xr.Dataset:
    """Fit a capacity to counts: intensities, and how many of how many trials exceeded there."""
    if set(counts) != set(_COLUMNS) or given or not isinstance(measure, str):
        names = ", ".join(map(short_repr, [*counts, *given])) or "none"
        msg = (
            f"{_OWNER}: counts have {', '.join(map(repr, _COLUMNS))} and go with one name of a "
            f"measure, without limits, motions and pooled; found {names} and {short_repr(measure)}"
        )
        raise ComponentError(msg)
    intensity, exceeded, trials = (counts[name] for name in _COLUMNS)
    which = Intensity.read(measure, period, owner=_OWNER)
    unit = which.attributes()["units"]
    values = read_in_unit_of(which.name, unit, intensity, "intensity", owner=_OWNER)
    over = np.asarray(exceeded, dtype=np.float64)
    count = np.broadcast_to(np.asarray(trials, dtype=np.float64), values.shape)
    if (
        over.shape != values.shape
        or np.any(values <= 0.0)
        or not np.all((over >= 0.0) & (over <= count))
        or not all(np.array_equal(numbers, np.round(numbers)) for numbers in (over, count))
    ):
        msg = (
            f"{_OWNER}: expected intensities above zero and for each of them a number of "
            f"exceedances from 0 to that of the trials, got {short_repr(exceeded)} of "
            f"{short_repr(trials)}"
        )
        raise ComponentError(msg)
    settings = BoundSettings(
        _read_bands(bands, Bands.PROFILE, 1), read_confidence(confidence, owner=_OWNER)
    )
    counted_trials = Trials.from_verdicts(np.log(values)[:, None], over, count)
    # the runs: at each intensity first those that exceeded, then the others
    times = np.column_stack([over, count - over]).astype(int).ravel()
    verdicts = np.repeat(np.tile([1.0, 0.0], len(values)), times)
    runs = np.repeat(np.repeat(values, 2), times)[:, None], verdicts
    dataset = fragility_dataset(
        [StructureTrials(counted_trials, runs, 0, len(verdicts))],
        {"limit_state": 1}, [(which.name, which.attributes())], settings,
        {"trials": "trials", **period_attribute(None, [measure], period, owner=_OWNER)},
    ).isel(limit_state=0)  # fmt: skip
    return dataset.assign_attrs(verdict=fragility_sentences(dataset))


def _read_states(runs: xr.Dataset, limits: Iterable[object] | None) -> tuple[LimitState, ...]:
    if "capacity_scale" not in runs:
        return limit_states(("uplift",) if limits is None else limits, owner=_OWNER)
    known = states_of(runs)
    if limits is None:
        return known
    states = limit_states(limits, owner=_OWNER)
    names = [state.name for state in known]
    missing = [state.name for state in states if state.name not in names]
    if missing:
        msg = (
            f"{_OWNER}: the dynamic analysis has no limit state {', '.join(missing)}: name it "
            f"among the limits of the analysis, which has {', '.join(names)}"
        )
        raise ComponentError(msg)
    return states


def _fit_ordered(
    verdicts: Sequence[xr.DataArray],
    measure: xr.DataArray,
    states: Sequence[LimitState],
    bands: Bands,
) -> list[Fit]:
    """Fit all limit states of a structure with one dispersion."""
    rows = np.stack([verdict.to_numpy().ravel().astype(np.float64) for verdict in verdicts])
    intensity = flatten_like(measure, verdicts[0]).astype(np.float64)
    is_valid = ~np.isnan(rows).any(axis=0) & (intensity > 0.0) & np.isfinite(intensity)
    names = [state.name for state in states]
    motions = motion_numbers(verdicts[0])[is_valid]
    return ordered_fits(np.log(intensity[is_valid]), rows[:, is_valid], motions, names, bands)


def _sliding_sentence(runs: xr.Dataset, *, of_capacities: bool) -> str:
    """Say in how many runs friction would not hold the block; nothing if no friction was given."""
    if "would_slide" not in runs:
        return ""
    which = "runs of the scan" if of_capacities else "runs"
    words = share_words(runs["would_slide"].to_numpy(), runs=which)
    return f" {words[0].upper()}{words[1:]}; these count as if it were held." if words else ""


def _listed_measures(value: object) -> list[object]:
    if isinstance(value, str | xr.DataArray):
        return [value]
    listed = list(value) if is_iterable(value) else []
    if len(listed) not in (1, 2):
        msg = f"{_OWNER}: intensity needs one measure, or two, got {short_repr(value)}"
        raise ComponentError(msg)
    return listed


def _read_bands(value: str | None, default: Bands, measures: int) -> Bands:
    if value is None:
        return default if measures == 1 or default is not Bands.PROFILE else Bands.SANDWICH
    bands = checked_choice(Bands, value, owner=_OWNER, name="bands")
    if bands is Bands.PROFILE and measures > 1:
        msg = f"{_OWNER}: bands by profile are those of one intensity measure; use 'jackknife'"
        raise ComponentError(msg)
    return bands
