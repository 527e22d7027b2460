"""How probable overturning is where parameters and motions are spread."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, Unpack

import numpy as np
import xarray as xr

from rockframe.arguments import one_of_words, whole_number
from rockframe.errors import StudyError
from rockframe.results.dataset import build_dataset
from rockframe.results.outcome import Generic
from rockframe.results.variables.studies import MOTION
from rockframe.shared_arguments import takes
from rockframe.studies.confidence import clopper_pearson, read_level
from rockframe.studies.limit_states import overturns
from rockframe.studies.lines import head
from rockframe.studies.spread import Sampling, drawn, ranked, read_spread
from rockframe.studies.sweeps.arguments import SweepArguments
from rockframe.studies.sweeps.memory import check_memory
from rockframe.studies.sweeps.motions import named_motions
from rockframe.studies.sweeps.scenes import own_motion, scene_of
from rockframe.studies.sweeps.sweep import sweep

if TYPE_CHECKING:
    from collections.abc import Callable

    from rockframe.motion import GroundMotion
    from rockframe.simulation.system import System
    from rockframe.units import RatioLike

_OWNER: Final = "probability_of_overturning"
SAMPLED: Final = "sampling"
"""Attribute that tells how cases were drawn."""
_MOST_CASES: Final = 1_000_000_000


@takes(SweepArguments)
def probability_of_overturning(
    system: "System | Callable[..., System]",
    motions: "GroundMotion | Mapping[str, GroundMotion] | Sequence[GroundMotion] | None" = None,
    *,
    spread: Mapping[str, Any],
    cases: int = 1000,
    sampling: str = Sampling.LATIN,
    seed: int = 0,
    confidence: "RatioLike" = 0.95,
    **run: Unpack[SweepArguments],
) -> xr.Dataset:
    """Draw parameters and motions, and count how many cases overturn.

    Parameters
    ----------
    system : System or callable
        The scene, as for :func:`rockframe.sweep`.
    motions : GroundMotion, or sequence or mapping of them, optional
        Each case has one of them, all equally probable; the one among the parts of the system
        unless given.
    spread : mapping of str to distribution
        By the names of axes (:func:`rockframe.sweep`), ``scale`` among them:
        ``("normal", mean, standard deviation)``, ``("lognormal", median, standard deviation of
        the logarithm)``, ``("uniform", least, greatest)``, with units; or a frozen distribution
        of ``scipy.stats`` in SI units, and the unit: ``(scipy.stats.triang(0.5), "m")``.
    cases : int, optional
        How many are drawn.
    sampling : {"latin", "random", "sobol"}, optional
        A Latin hypercube, independent numbers, or a scrambled Sobol sequence, for which
        `cases` had best be a power of two.
    seed : int, optional
        Of the random numbers: the same one draws the same cases.
    confidence : float, optional
        Of the bounds [1].

    Returns
    -------
    xarray.Dataset
        The sweep over ``case``, with ``overturning_probability``, its bounds, and
        ``verdict_count``; and over ``parameter``, what matters most first:
        ``first_order_index``, ``verdict_distance`` and ``chance_probability`` [1].

    Raises
    ------
    UnitsError, ComponentError
        An argument is out of range, or has a wrong unit or none.
    StudyError
        No such parameter, with every fault found; or as for :func:`rockframe.sweep`.

    Notes
    -----
    The bounds are those of Clopper and Pearson for independent cases. Latin hypercubes
    and Sobol sequences vary less, so that the bounds are wide for them: of a Latin hypercube
    the variance is at most n/(n-1) times that of independent cases (Owen, 1997). They say
    nothing of whether the motions stand for those to come. The first-order index is the share
    of the variance of the verdict that would be gone if the parameter were known; what several
    parameters do together is in none of them. Cases without a verdict are left out.

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
    count = whole_number(cases, owner=_OWNER, name="cases", lowest=2, highest=_MOST_CASES)
    way = one_of_words(Sampling, sampling, owner=_OWNER, name="sampling")
    first = whole_number(seed, owner=_OWNER, name="seed", lowest=0)
    level = read_level(confidence, owner=_OWNER)
    own = own_motion(scene) if motions is None else motions
    named = None if own is None else named_motions(own)
    wrong = check_memory(
        {"numbers that are drawn": 1.0 + len(spreads)}, count, "draw fewer cases", owner=_OWNER
    )
    if wrong:
        raise StudyError(*wrong)
    cube = drawn(spreads, count, way, first)
    several = 1 if named is None else len(named)
    number = np.minimum((cube[:, 0] * several).astype(int), several - 1)
    # neighbours share their motion
    order = np.argsort(number, kind="stable")
    cube, number = cube[order], number[order]
    table: dict[str, Any] = {
        head(one.name, one.unit): one.distribution.ppf(column)
        for one, column in zip(spreads, cube.T[1:], strict=True)
    }
    if named is not None:
        table[MOTION] = np.array(list(named), dtype=object)[number]
    runs = sweep(
        system,
        named,
        cases=table,
        **run,
    )
    found = _counted(runs, [one.name for one in spreads], several=several > 1, level=level)
    return found.assign_attrs(
        title="Probability of overturning",
        seed=first,
        confidence=level,
        **{SAMPLED: str(way)},
    )


def _counted(runs: xr.Dataset, names: Sequence[str], *, several: bool, level: float) -> xr.Dataset:
    """Add the probability, and what it depends on."""
    verdict = overturns(runs).squeeze().to_numpy()
    known = ~np.isnan(verdict)
    falls, count = int(np.nansum(verdict)), int(known.sum())
    lower, upper = clopper_pearson(np.array(falls), np.array(count), level)
    columns: dict[str, Generic] = {name: runs[name].to_numpy()[known] for name in names}
    if several:
        columns[MOTION] = runs[MOTION].to_numpy()[known].astype(str)
    order = ranked(columns, verdict[known])
    share = falls / count if count else np.nan
    added = build_dataset(
        {
            "overturning_probability": share,
            "overturning_probability_lower_bound": lower,
            "overturning_probability_upper_bound": upper,
            "verdict_count": count,
            "parameter": np.array(list(order), dtype=object),
            "first_order_index": np.array([one.first_order for one in order.values()]),
            "verdict_distance": np.array([one.distance for one in order.values()]),
            "chance_probability": np.array([one.chance for one in order.values()]),
        },
        {},
    )
    most = next(iter(order), "")
    said = f"Overturns with probability {share:.3g}, from {float(lower):.3g} to {float(upper):.3g}"
    said += f" with confidence {level:g}, by {count} cases"
    if several:
        # the bounds are those of further cases of the same motions
        said += f" under these {len(np.unique(columns[MOTION]))} motions"
    lacking = len(verdict) - count
    if lacking:
        said += f"; {lacking} without a verdict are left out"
    if most and not np.isnan(order[most].first_order):
        said += f"; {most} matters most"
    return runs.assign(added.data_vars).assign_coords(added.coords).assign_attrs(verdict=f"{said}.")
