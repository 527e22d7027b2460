"""Parameters that are spread: distributions, samples, and which of them matter most."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final, NamedTuple, cast

import numpy as np

from rockframe.errors import ComponentError, RockframeError, StudyError, heard, shown
from rockframe.results.outcome import Generic
from rockframe.signals.arrays import Array
from rockframe.studies.sweeps.axes import Axis
from rockframe.studies.sweeps.scenes import SweptScene
from rockframe.units import POSITIVE, Measure, Unit, to_ratio, to_si


class Sampling(StrEnum):
    """How a sample is drawn."""

    LATIN = "latin"
    RANDOM = "random"
    SOBOL = "sobol"


_KINDS: Final = {
    "normal": "('normal', mean, standard deviation)",
    "lognormal": "('lognormal', median, standard deviation of the logarithm)",
    "uniform": "('uniform', least, greatest)",
}


@dataclass(frozen=True)
class Spread:
    """A parameter that is spread."""

    name: str  # of the axis
    unit: str  # of its values
    distribution: Any  # in that unit


def read_spread(given: object, scene: SweptScene, *, owner: str) -> tuple[Spread, ...]:
    """Read the argument ``spread``."""
    if not isinstance(given, Mapping) or not given:
        msg = f"{owner}: spread must give distributions by names of parameters, got {shown(given)}"
        raise ComponentError(msg)
    found: list[Spread] = []
    faults: list[str] = []
    for name, one in cast("Mapping[Any, Any]", given).items():
        try:
            found.append(_read(str(name), one, scene, owner))
        except RockframeError as problem:
            faults.append(str(problem))
    if faults:
        raise StudyError(*faults)
    return tuple(found)


def drawn(spreads: tuple[Spread, ...], count: int, sampling: Sampling, seed: int) -> Array:
    """Draw a sample from the unit cube: a column for each parameter, and one for the motion."""
    from scipy.stats import qmc

    size = 1 + len(spreads)
    rng = np.random.default_rng(seed)
    if sampling is Sampling.RANDOM:
        return rng.random((count, size))
    engine = qmc.LatinHypercube if sampling is Sampling.LATIN else qmc.Sobol
    return np.asarray(engine(size, rng=rng).random(count), dtype=np.float64)


def _read(name: str, given: Any, scene: SweptScene, owner: str) -> Spread:
    from scipy import stats

    parts = list(given) if isinstance(given, tuple | list) else [given]
    if hasattr(parts[0], "ppf"):
        return _frozen(name, parts, scene, owner)
    if parts[0] not in _KINDS or len(parts) != 3:
        known = ", ".join(_KINDS.values())
        msg = (
            f"{owner}: {name} needs {known}, or a distribution of scipy.stats and its unit, "
            f"got {shown(given)}"
        )
        raise ComponentError(msg)
    kind, first, second = parts
    axis = _axis(scene, name, first, owner)
    start = float(axis.values[0])
    if kind == "lognormal":
        log = to_ratio(second, owner=owner, name=name, condition=POSITIVE, example="0.2")
        if start <= 0.0:
            msg = f"{owner}: {name} needs a median above zero, got {shown(first)}"
            raise ComponentError(msg)
        return Spread(name, str(axis.unit), stats.lognorm(s=log, scale=start))
    width = float(_axis(scene, name, second, owner).values[0])
    if kind == "normal" and width > 0.0:
        return Spread(name, str(axis.unit), stats.norm(loc=start, scale=width))
    if kind == "uniform" and width > start:
        return Spread(name, str(axis.unit), stats.uniform(loc=start, scale=width - start))
    wrong = "standard deviation above zero" if kind == "normal" else "greatest above the least"
    msg = f"{owner}: {name} needs a {wrong}, got {shown(second)}"
    raise ComponentError(msg)


def _frozen(name: str, parts: list[Any], scene: SweptScene, owner: str) -> Spread:
    """Read a distribution of scipy.stats, with the unit of its values."""
    distribution, unit = parts[0], (parts[1] if len(parts) > 1 else "")
    middle = float(distribution.ppf(0.5))
    axis = _axis(scene, name, f"{middle!r} {unit}" if unit else middle, owner)
    if unit and axis.unit != Unit.ONE:
        measure = Measure("a value", Unit(str(axis.unit)), f"1 {unit}")
        size = to_si(f"1 {unit}", measure, owner=owner, name=name)
        if size != 1.0:
            msg = f"{owner}: {name} needs a distribution in {axis.unit}, got one in {unit}"
            raise ComponentError(msg)
    return Spread(name, str(axis.unit), distribution)


def _axis(scene: SweptScene, name: str, value: Any, owner: str) -> Axis:
    """Read one value as the axis of its name does."""
    with heard():  # a width of a distribution is no unusual value
        axis = scene.axis(name, [value])
    if axis.unit is None:
        msg = f"{owner}: {name} has words for values, which have no distribution"
        raise ComponentError(msg)
    return axis


_BINS: Final = 20
_FEWEST: Final = 20
"""Cases in a bin."""


class Matters(NamedTuple):
    """How much a parameter matters."""

    # first-order index: the variance of the share that overturns given the parameter, over that of
    # the verdict, without what chance alone would give [1]
    first_order: float
    # greatest difference of the distributions of the parameter in cases of either verdict; NaN of
    # words [1]
    distance: float
    chance: float  # probability of shares as uneven if the parameter did not matter [1]


def ranked(columns: Mapping[str, Generic], verdict: Array) -> dict[str, Matters]:
    """Tell what matters most, first.

    The index is the correlation ratio of groups of equal size, less its expectation if there
    were no dependence (the adjusted ratio, Kelley 1935): a first-order Sobol index from given
    data, within the width of the groups. The distance is that of Hornberger and Spear (1981).
    """
    found = {name: _matters(values, verdict) for name, values in columns.items()}
    return dict(sorted(found.items(), key=lambda one: -one[1].first_order))


def _matters(values: Generic, verdict: Array) -> Matters:
    from scipy.stats import chi2_contingency, ks_2samp

    count = len(verdict)
    falls = float(verdict.sum())
    if falls in (0.0, float(count)):
        return Matters(np.nan, np.nan, np.nan)
    numbers = values.dtype.kind != "U"
    if numbers:
        order = np.argsort(np.argsort(values, kind="stable"), kind="stable")
        groups = max(1, min(_BINS, count // _FEWEST))
        place = order * groups // count
    else:
        place = np.unique(values, return_inverse=True)[1]
    size = np.bincount(place).astype(np.float64)
    over = np.bincount(place, weights=verdict)
    groups = len(size)
    if groups < 2 or groups >= count:
        return Matters(np.nan, np.nan, np.nan)
    share = falls / count
    between = float((size * (over / size - share) ** 2).sum()) / (count * share * (1.0 - share))
    index = 1.0 - (1.0 - between) * (count - 1.0) / (count - groups)
    test: Any = chi2_contingency(np.stack([over, size - over]), correction=False)
    chance = float(test.pvalue)
    distance = np.nan
    if numbers:
        both: Any = ks_2samp(values[verdict == 1.0], values[verdict == 0.0])
        distance = float(both.statistic)
    return Matters(max(index, 0.0), distance, chance)
