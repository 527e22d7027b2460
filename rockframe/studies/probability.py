"""Probability of overturning with random parameters and motions, by drawn cases."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final, NamedTuple, Unpack, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_choice, checked_integer
from rockframe.errors import (
    ComponentError,
    RockframeError,
    StudyError,
    collected_warnings,
    short_repr,
)
from rockframe.results.outcome import overturns
from rockframe.results.schema import with_variables
from rockframe.results.table import head
from rockframe.results.variables.studies import MOTION
from rockframe.shared_arguments import with_shared_arguments
from rockframe.signals.arrays import AnyArray, Array
from rockframe.simulation.system import System
from rockframe.studies.confidence import clopper_pearson, normal_scores, read_confidence
from rockframe.studies.sweeps.arguments import SweepArguments
from rockframe.studies.sweeps.axes import Axis
from rockframe.studies.sweeps.motions import MotionsLike, full_name
from rockframe.studies.sweeps.planning import check_memory
from rockframe.studies.sweeps.scenes import SweptScene, motions_of_study, scene_of
from rockframe.studies.sweeps.sweep import sweep
from rockframe.units import POSITIVE, Condition, Measure, RatioLike, Unit, read_number, to_ratio


class Sampling(StrEnum):
    """Method of sampling."""

    LATIN = "latin"
    RANDOM = "random"
    SOBOL = "sobol"


_CORRELATION: Final = Condition("between -1 and 1", lambda value: -1.0 < value < 1.0)
_DISTRIBUTIONS: Final = {
    "normal": "('normal', mean, standard deviation)",
    "lognormal": "('lognormal', median, standard deviation of the logarithm)",
    "uniform": "('uniform', least, greatest)",
}


@dataclass(frozen=True)
class RandomParameter:
    """A random parameter: its axis, its unit and its distribution."""

    name: str  # of the axis
    unit: str  # of its values
    distribution: Any  # in that unit


def read_spread(value: object, scene: SweptScene, *, owner: str) -> tuple[RandomParameter, ...]:
    """Read the argument ``spread``."""
    if not isinstance(value, Mapping) or not value:
        expected = "must give distributions by names of parameters"
        msg = f"{owner}: spread {expected}, got {short_repr(value)}"
        raise ComponentError(msg)
    parameters: list[RandomParameter] = []
    faults: list[str] = []
    for name, distribution in cast("Mapping[Any, Any]", value).items():
        try:
            parameters.append(_read_parameter(str(name), distribution, scene, owner))
        except RockframeError as problem:
            faults.append(str(problem))
    if faults:
        raise StudyError(*faults)
    return tuple(parameters)


def read_correlation(argument: object, names: Sequence[str], *, owner: str) -> Array | None:
    """Read the argument ``correlation``: a matrix in the order of the parameters, or its pairs."""
    if argument is None:
        return None
    size = len(names)
    if isinstance(argument, Mapping):
        matrix = np.eye(size)
        for pair, value in cast("Mapping[Any, Any]", argument).items():
            two = pair if isinstance(pair, tuple) else (pair,)
            two = tuple(name if name in names else full_name(name) for name in two)
            if len(two) != 2 or two[0] == two[1] or not set(two) <= set(names):
                msg = (
                    f"{owner}: correlation needs pairs of two of {', '.join(names)}, "
                    f"got {short_repr(pair)}"
                )
                raise ComponentError(msg)
            i, j = (names.index(name) for name in two)
            matrix[i, j] = matrix[j, i] = to_ratio(
                value, owner=owner, name="correlation", condition=_CORRELATION, example="0.5"
            )
    else:
        try:
            matrix = np.asarray(argument, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):  # not a matrix of numbers
            matrix = np.empty(0)
    alike = matrix.shape == (size, size) and np.array_equal(matrix, matrix.T)
    if not alike or not np.allclose(np.diag(matrix), 1.0, rtol=0.0, atol=1e-12):
        msg = (
            f"{owner}: correlation must be a symmetric matrix of {size} rows with ones on its "
            f"diagonal, in the order of {', '.join(names)}, got {short_repr(argument)}"
        )
        raise ComponentError(msg)
    if float(np.linalg.eigvalsh(matrix)[0]) <= 0.0:
        msg = f"{owner}: no parameters have this correlation, which is not positive definite"
        raise ComponentError(msg)
    return matrix


def impose_correlation(cube: Array, matrix: Array, *, stratified: bool) -> Array:
    """Impose a correlation of normal scores on a sample, :eq:`eq-gaussian-copula`."""
    from scipy.special import ndtr

    normal = normal_scores(cube) @ np.linalg.cholesky(matrix).T
    if not stratified:
        return np.asarray(ndtr(normal), dtype=np.float64)
    # each value stays, in another order (Iman and Conover, 1982)
    order = np.argsort(np.argsort(normal, axis=0, kind="stable"), axis=0, kind="stable")
    return np.take_along_axis(np.sort(cube, axis=0), order, axis=0)


def check_drawn(numbers: Mapping[str, float], cases: int, *, owner: str) -> None:
    """Refuse to draw more cases than the memory holds."""
    if faults := check_memory(numbers, cases, "draw fewer cases", owner=owner):
        raise StudyError(*faults)


def draw_sample(
    spreads: tuple[RandomParameter, ...], count: int, sampling: Sampling, seed: int
) -> Array:
    """Draw a sample from the unit cube: a column for each parameter, and one for the motion."""
    from scipy.stats import qmc

    size = 1 + len(spreads)
    rng = np.random.default_rng(seed)
    if sampling is Sampling.RANDOM:
        return rng.random((count, size))
    engine = qmc.LatinHypercube if sampling is Sampling.LATIN else qmc.Sobol
    return np.asarray(engine(size, rng=rng).random(count), dtype=np.float64)


def _read_parameter(name: str, value: Any, scene: SweptScene, owner: str) -> RandomParameter:
    from scipy import stats

    parts = list(value) if isinstance(value, tuple | list) else [value]
    if hasattr(parts[0], "ppf"):
        return _read_frozen(name, parts, scene, owner)
    if parts[0] not in _DISTRIBUTIONS or len(parts) != 3:
        known = ", ".join(_DISTRIBUTIONS.values())
        msg = (
            f"{owner}: {name} needs {known}, or a distribution of scipy.stats and its unit, "
            f"got {short_repr(value)}"
        )
        raise ComponentError(msg)
    kind, first, second = parts
    axis = _axis_of(scene, name, first, owner)
    start = float(axis.values[0])
    if kind == "lognormal":
        log = to_ratio(second, owner=owner, name=name, condition=POSITIVE, example="0.2")
        if start <= 0.0:
            msg = f"{owner}: {name} needs a median above zero, got {short_repr(first)}"
            raise ComponentError(msg)
        return RandomParameter(axis.name, str(axis.unit), stats.lognorm(s=log, scale=start))
    end = float(_axis_of(scene, name, second, owner).values[0])
    kind_of, width = (stats.norm, end) if kind == "normal" else (stats.uniform, end - start)
    if not width > 0.0:
        wrong = "standard deviation above zero" if kind == "normal" else "greatest above the least"
        msg = f"{owner}: {name} needs a {wrong}, got {short_repr(second)}"
        raise ComponentError(msg)
    return RandomParameter(axis.name, str(axis.unit), kind_of(loc=start, scale=width))


def _read_frozen(name: str, parts: list[Any], scene: SweptScene, owner: str) -> RandomParameter:
    """Read a distribution of scipy.stats, with the unit of its values."""
    distribution, unit = parts[0], (parts[1] if len(parts) > 1 else "")
    middle = float(distribution.ppf(0.5))
    axis = _axis_of(scene, name, f"{middle!r} {unit}" if unit else middle, owner)
    if unit:
        measure = Measure("a value", Unit(str(axis.unit)), f"1 {unit}")
        if read_number(f"1 {unit}", measure, owner=owner, name=name) != 1.0:
            expected = "of pure ratios" if axis.unit == Unit.ONE else f"in {axis.unit}"
            msg = f"{owner}: {name} needs a distribution {expected}, got one in {unit}"
            raise ComponentError(msg)
    return RandomParameter(axis.name, str(axis.unit), distribution)


def _axis_of(scene: SweptScene, name: str, value: Any, owner: str) -> Axis:
    """Read one value as the axis of its name does."""
    with collected_warnings():  # a standard deviation may be an unusual value
        axis = scene.axis(name, [value])
    if axis.unit is None:
        msg = f"{owner}: {name} has words for values, which have no distribution"
        raise ComponentError(msg)
    return axis


_BINS: Final = 20
_MIN_BIN_SIZE: Final = 20
"""Least number of cases in a bin."""


class Sensitivity(NamedTuple):
    """Sensitivity of the verdict to a parameter."""

    # first-order index: variance of the share that overturns given the parameter, over that of the
    # verdict, less its expectation without any dependence [1]
    first_order: float = np.nan
    # greatest difference between the parameter's distributions for the two verdicts; NaN where
    # values are words [1]
    distribution_distance: float = np.nan
    p_value: float = np.nan  # p-value of the uneven shares if the parameter had no influence [1]


def rank_parameters(columns: Mapping[str, AnyArray], verdict: Array) -> dict[str, Sensitivity]:
    """Return the sensitivity of the verdict to each parameter, the greatest first."""
    sensitivities = {name: _sensitivity(values, verdict) for name, values in columns.items()}
    return dict(sorted(sensitivities.items(), key=lambda item: -item[1].first_order))


def _sensitivity(values: AnyArray, verdict: Array) -> Sensitivity:
    # the index is the correlation ratio of groups of equal size, minus its expectation without
    # dependence (the adjusted ratio, Kelley 1935): a first-order Sobol index from given data,
    # within the width of the groups; the distance is that of Hornberger and Spear (1981)
    from scipy.stats import chi2_contingency, ks_2samp

    count = len(verdict)
    falls = float(verdict.sum())
    if falls in (0.0, float(count)):
        return Sensitivity()
    numbers = values.dtype.kind != "U"
    if numbers:
        order = np.argsort(np.argsort(values, kind="stable"), kind="stable")
        groups = max(1, min(_BINS, count // _MIN_BIN_SIZE))
        group = order * groups // count
    else:
        group = np.unique(values, return_inverse=True)[1]
    size = np.bincount(group).astype(np.float64)
    overturned = np.bincount(group, weights=verdict)
    groups = len(size)
    if groups < 2 or groups >= count:
        return Sensitivity()
    share = falls / count
    squares = float((size * (overturned / size - share) ** 2).sum())
    between = squares / (count * share * (1.0 - share))
    index = 1.0 - (1.0 - between) * (count - 1.0) / (count - groups)
    test: Any = chi2_contingency(np.stack([overturned, size - overturned]), correction=False)
    difference: Any = ks_2samp(values[verdict == 1.0], values[verdict == 0.0]) if numbers else None
    distance = np.nan if difference is None else float(difference.statistic)
    return Sensitivity(max(index, 0.0), distance, float(test.pvalue))


_OWNER: Final = "probability_of_overturning"
SAMPLING_ATTRIBUTE: Final = "sampling"
"""Attribute that records how cases were drawn."""
_MAX_CASES: Final = 1_000_000_000


@with_shared_arguments(SweepArguments)
def probability_of_overturning(
    system: System | Callable[..., System],
    motions: MotionsLike | None = None,
    *,
    spread: Mapping[str, Any],
    correlation: Mapping[tuple[str, str], RatioLike] | Array | None = None,
    cases: int = 1000,
    sampling: str = Sampling.LATIN,
    seed: int = 0,
    confidence: RatioLike = 0.95,
    **run: Unpack[SweepArguments],
) -> xr.Dataset:
    """Draw parameters and motions, and count how many cases overturn.

    Parameters
    ----------
    system : System or callable
        The scene, as for :func:`rockframe.sweep`.
    motions : GroundMotion, or sequence or mapping of them, optional
        Each case has one of them, all equally probable. By default the motion among the parts of
        the system.
    spread : mapping of str to distribution
        Distributions by names of axes (:func:`rockframe.sweep`), ``scale`` among them:
        ``("normal", mean, standard deviation)``, ``("lognormal", median, standard deviation of
        the logarithm)``, ``("uniform", least, greatest)``, with units; or a frozen distribution
        of ``scipy.stats`` in SI units, and the unit: ``(scipy.stats.triang(0.5), "m")``.
    correlation : mapping of (str, str) to float, or array, optional
        Correlation of the normal scores of parameters, by pairs, ``{("width", "height"): 0.7}``, or
        a matrix in the order of `spread`; for normal distributions it is that of the parameters,
        for lognormal ones that of their logarithms. By default the parameters are uncorrelated [1].
    cases : int, optional
        Number of cases that are drawn.
    sampling : {"latin", "random", "sobol"}, optional
        A Latin hypercube, independent numbers, or a scrambled Sobol sequence, for which `cases`
        should be a power of two.
    seed : int, optional
        Seed of the random numbers: equal seeds draw equal cases.
    confidence : float, optional
        Confidence level of the bounds [1].

    Returns
    -------
    xarray.Dataset
        The sweep over ``case``, with ``overturning_probability``, its bounds, and
        ``verdict_count``; and over ``parameter``, the most influential first:
        ``first_order_index``, ``verdict_distance`` and ``chance_probability`` [1].

    Raises
    ------
    UnitsError, ComponentError
        An argument is out of range, or has a wrong unit or none.
    StudyError
        A parameter is unknown, with all faults listed; or as for :func:`rockframe.sweep`.

    Notes
    -----
    The bounds are those of Clopper and Pearson for independent cases. Latin hypercubes and Sobol
    sequences vary less, so the bounds are wide for them: the variance of a Latin hypercube is at
    most n/(n-1) times that of independent cases (Owen, 1997). The bounds do not account for whether
    the motions represent future ones. Correlated parameters have a Gaussian copula,
    :eq:`eq-gaussian-copula`: each keeps its distribution; the order of a Latin hypercube changes,
    but not its strata. The index of a parameter then includes the influence of those correlated
    with it. The first-order index is the share of the variance of the verdict that would vanish if
    the parameter were known; interactions of several parameters are in none of them. Cases without
    a verdict are left out.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> found = rf.probability_of_overturning(
    ...     system,
    ...     rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz"),
    ...     spread={"width": ("normal", "0.5 m", "0.05 m"), "scale": ("lognormal", 1.0, 0.4)},
    ...     cases=200,
    ...     free_vibration="5 s",
    ... )
    >>> found.parameter.values[0].item()
    'scale'
    """
    scene = scene_of(system)
    spreads = read_spread(spread, scene, owner=_OWNER)
    matrix = read_correlation(correlation, [parameter.name for parameter in spreads], owner=_OWNER)
    count = checked_integer(cases, owner=_OWNER, name="cases", lowest=2, highest=_MAX_CASES)
    method = checked_choice(Sampling, sampling, owner=_OWNER, name="sampling")
    start_seed = checked_integer(seed, owner=_OWNER, name="seed", lowest=0)
    level = read_confidence(confidence, owner=_OWNER)
    named = motions_of_study(motions, scene)
    check_drawn({"numbers that are drawn": 1.0 + len(spreads)}, count, owner=_OWNER)
    cube = draw_sample(spreads, count, method, start_seed)
    if matrix is not None:
        cube[:, 1:] = impose_correlation(cube[:, 1:], matrix, stratified=method is Sampling.LATIN)
    several = 1 if named is None else len(named)
    number = np.minimum((cube[:, 0] * several).astype(int), several - 1)
    # neighbours share their motion
    order = np.argsort(number, kind="stable")
    cube, number = cube[order], number[order]
    table: dict[str, Any] = {
        head(parameter.name, parameter.unit): parameter.distribution.ppf(column)
        for parameter, column in zip(spreads, cube.T[1:], strict=True)
    }
    if named is not None:
        table[MOTION] = np.array(list(named), dtype=object)[number]
    runs = sweep(system, named, cases=table, **run)
    names = [parameter.name for parameter in spreads]
    dataset = _with_probability(runs, names, several=several > 1, level=level)
    return dataset.assign_attrs(
        title="Probability of overturning",
        seed=start_seed,
        confidence=level,
        **{SAMPLING_ATTRIBUTE: str(method)},
    )


def _with_probability(
    runs: xr.Dataset, names: Sequence[str], *, several: bool, level: float
) -> xr.Dataset:
    """Add the probability, and what it depends on."""
    verdict = overturns(runs).squeeze().to_numpy()
    known = ~np.isnan(verdict)
    falls, count = int(np.nansum(verdict)), int(known.sum())
    lower, upper = clopper_pearson(np.array(falls), np.array(count), level)
    columns: dict[str, AnyArray] = {name: runs[name].to_numpy()[known] for name in names}
    if several:
        columns[MOTION] = runs[MOTION].to_numpy()[known].astype(str)
    sensitivities = rank_parameters(columns, verdict[known])
    share = falls / count if count else np.nan
    indices, distances, p_values = np.transpose([*sensitivities.values()])
    added = {
        "overturning_probability": share,
        "overturning_probability_lower_bound": lower,
        "overturning_probability_upper_bound": upper,
        "verdict_count": count,
        "parameter": np.array(list(sensitivities), dtype=object),
        "first_order_index": indices,
        "verdict_distance": distances,
        "chance_probability": p_values,
    }
    strongest = next(iter(sensitivities), "")
    text = f"Overturns with probability {share:.3g}, from {float(lower):.3g} to {float(upper):.3g}"
    text += f" with confidence {level:g}, by {count} cases"
    if several:
        # the bounds hold for further cases of the same motions
        text += f" under these {len(np.unique(columns[MOTION]))} motions"
    missing = len(verdict) - count
    if missing:
        text += f"; {missing} without a verdict are left out"
    if strongest and not np.isnan(sensitivities[strongest].first_order):
        text += f"; {strongest} matters most"
    return with_variables(runs, added).assign_attrs(verdict=f"{text}.")
