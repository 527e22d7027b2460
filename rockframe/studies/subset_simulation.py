"""Small probabilities of limit states with random parameters and motions: subset simulation."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from typing import Any, Final, Unpack

import numpy as np
import xarray as xr

from rockframe.arguments import checked_integer
from rockframe.errors import (
    ComponentError,
    ModelWarning,
    SolverWarning,
    StudyError,
    collected_warnings,
    short_repr,
    warn,
)
from rockframe.results.joining import concat
from rockframe.results.schema import build_dataset, with_variables
from rockframe.results.table import head
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.shared_arguments import with_shared_arguments
from rockframe.signals.arrays import Array
from rockframe.simulation.system import System
from rockframe.studies.conditional_sampling import (
    Level,
    family_shares,
    sample_weights,
    subset_bounds,
    subset_levels,
    subset_probability,
    subset_variation,
)
from rockframe.studies.confidence import BOUND_SUFFIXES, read_confidence
from rockframe.studies.limit_states import (
    LIMITS_ATTRIBUTE,
    OVERTURNING,
    LimitState,
    demands,
    limit_states,
    states_json,
)
from rockframe.studies.line_scan import INTERRUPTED_ENDING, SweepRounds, sweep_rounds
from rockframe.studies.probability import (
    SAMPLING_ATTRIBUTE,
    RandomParameter,
    check_drawn,
    read_correlation,
    read_spread,
)
from rockframe.studies.sweeps.arguments import SweepArguments
from rockframe.studies.sweeps.motions import MotionsLike
from rockframe.studies.sweeps.scenes import motions_of_study, scene_of
from rockframe.system.options import PointsLike
from rockframe.units import Condition, RatioLike, to_ratio

_OWNER: Final = "subset_simulation"
_SHARE: Final = Condition("from 0.01 to 0.5", lambda value: 0.01 <= value <= 0.5)
_MIN_CHAINS: Final = 5
"""Least number of chains of a level."""
_MAX_CASES: Final = 10_000_000
_MAX_LEVELS: Final = 50
_MIN_FAMILIES: Final = 5
"""Number of families below which the coefficient of variation is itself uncertain."""
_REFERENCES: Final = (
    "Au and Beck (2001), Probabilistic Eng. Mech. 16, 263-277; Papaioannou et al. (2015), "
    "Probabilistic Eng. Mech. 41, 89-103"
)
_TABLE_ATTRIBUTES: Final = ("axes_json", "study_sha256")
"""Attributes with the columns of a table, and the name by which this process knows it."""


@with_shared_arguments(SweepArguments)
def subset_simulation(
    system: System | Callable[..., System],
    motions: MotionsLike | None = None,
    *,
    spread: Mapping[str, Any],
    correlation: Mapping[tuple[str, str], RatioLike] | Array | None = None,
    limit: object = OVERTURNING,
    cases: int = 1000,
    share: RatioLike = 0.1,
    levels: int = 10,
    seed: int = 0,
    confidence: RatioLike = 0.95,
    points: PointsLike | None = None,
    **run: Unpack[SweepArguments],
) -> xr.Dataset:
    """Estimate a small probability that a limit state is exceeded, by subset simulation.

    Parameters
    ----------
    system : System or callable
        The scene, as for :func:`rockframe.sweep`.
    motions : GroundMotion, or sequence or mapping of them, optional
        Each case has one of them, all equally probable. By default the motion among the parts of
        the system.
    spread : mapping of str to distribution
        Distributions of the random parameters, as for :func:`rockframe.probability_of_overturning`.
    correlation : mapping of (str, str) to float, or array, optional
        Correlation of the normal scores of parameters, as for that function [1].
    limit : str, float or tuple, optional
        The limit state: ``"overturning"``, a peak rotation relative to the overturning angle, or a
        variable of runs and its limit, ``("peak_slip", "5 cm")``, as for
        :func:`rockframe.fragility`.
    cases : int, optional
        Number of samples in each level.
    share : float, optional
        Share of the samples of a level from which the chains of the next one start [1].
    levels : int, optional
        Maximum number of levels.
    seed : int, optional
        Seed of the random numbers: equal seeds draw equal cases.
    confidence : float, optional
        Confidence level of the bounds [1].
    points : mapping of str to (str or Quantity, str or Quantity), optional
        Points of the body, for a limit state at one of them, as for :func:`rockframe.sweep` [m].

    Returns
    -------
    xarray.Dataset
        ``exceedance_probability``, its bounds and ``coefficient_of_variation``; ``run_count``,
        ``left_out_count`` of runs without a verdict, and ``family_count``. Over ``sampling_level``:
        ``demand_threshold``, ``conditional_probability``, ``acceptance_rate`` and ``chain_count``.
        Over ``case``, for all samples: the results of the sweep, ``demand``, ``sample_level``, and
        ``sample_weight``, with which the samples represent the whole distribution [1].

    Raises
    ------
    UnitsError, ComponentError
        An argument is out of range, or has a wrong unit or none; or the response does not tell how
        near a run is to the limit state, as with uplift.
    StudyError
        A parameter is unknown, with all faults listed; or as for :func:`rockframe.sweep`.

    Warns
    -----
    SolverWarning, ModelWarning
        As :func:`rockframe.sweep` does.
    ModelWarning
        No sample exceeds the limit state, so that there is only an upper bound; or the samples that
        exceed it descend from fewer than five samples of the first level.

    Notes
    -----
    Au and Beck (2001), with the conditional sampling of Papaioannou et al. (2015),
    :eq:`eq-conditional-candidate`. The samples of a level are those of chains that begin at the
    samples of the previous level with the greatest demand; all chains advance together, in one
    sweep. The demand is the response over its limit, infinite where the block has overturned. If
    many samples have the same demand, such as blocks that stay at rest, a threshold lies above or
    below all of them, and the share of the level differs from `share`.

    The coefficient of variation measures how unequally the samples of the first level are
    represented at the end, :eq:`eq-subset-variation`. It thus includes the correlation of samples
    in a chain, of chains of one origin, and of levels. Where it was compared with the scatter of
    repeated estimates, of probabilities from 1e-3 to 1e-6 by 500 samples or more in each level, its
    root mean square was within 5 %; that of single estimates varies by a third, and is infinite if
    all samples that exceed descend from one of the first level. It cannot account for a region of
    failure that no sample of the first levels comes near; rocking may have several, and the path to
    overturning may pass through motions of smaller rotation. Another `seed` or more `cases` show
    whether this is so. Cases without a verdict are left out, and never accepted.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> found = rf.subset_simulation(
    ...     system,
    ...     rf.GroundMotion.sine_pulse("2.2 m/s^2", "1.5 Hz"),
    ...     spread={"scale": ("lognormal", 1.0, 0.2), "width": ("normal", "0.5 m", "0.02 m")},
    ...     cases=200,
    ...     free_vibration="4 s",
    ... )
    >>> 1e-5 < found.exceedance_probability.item() < 1e-2
    True
    """
    scene = scene_of(system)
    spreads = read_spread(spread, scene, owner=_OWNER)
    matrix = read_correlation(correlation, [parameter.name for parameter in spreads], owner=_OWNER)
    state = _read_limit(limit)
    count = checked_integer(cases, owner=_OWNER, name="cases", lowest=10, highest=_MAX_CASES)
    fraction = to_ratio(share, owner=_OWNER, name="share", condition=_SHARE, example="0.1")
    if round(fraction * count) < _MIN_CHAINS:
        msg = (
            f"{_OWNER}: share {fraction:g} of {count} cases are {round(fraction * count)} chains; "
            f"expected {_MIN_CHAINS} at least: draw more cases"
        )
        raise ComponentError(msg)
    max_levels = checked_integer(levels, owner=_OWNER, name="levels", lowest=1, highest=_MAX_LEVELS)
    first = checked_integer(seed, owner=_OWNER, name="seed", lowest=0)
    nominal = read_confidence(confidence, owner=_OWNER)
    named = motions_of_study(motions, scene)
    check_drawn({"samples": 2.0 + len(spreads)}, count * max_levels, owner=_OWNER)
    requested = {**run, "points": points}
    with sweep_rounds(system, named, requested, owner=_OWNER) as rounds:
        sampler = _Sampler(rounds, spreads, matrix, list(named or ()), state)
        rng, greatest = np.random.default_rng(first), np.inf if state.rotation == 1.0 else 1.0
        sampled, completed = list[Level](), True
        try:
            sampled.extend(
                subset_levels(
                    sampler.demand, sampler.size, greatest,
                    count=count, share=fraction, max_levels=max_levels, rng=rng,
                )
            )  # fmt: skip
        except KeyboardInterrupt:
            completed = False
            message = f"{_OWNER}: interrupted at level {len(sampled) + 1}{rounds.advice}"
            if not sampled:
                raise StudyError(message) from None
            warn(message, SolverWarning)
    if sampler.warnings and completed:
        warn(f"{_OWNER}: in further rounds: {sampler.warnings[0]}", ModelWarning)
    dataset = _subset_dataset(sampler, sampled, nominal, completed=completed)
    if completed:
        _warn_of_uncertain_probability(dataset)
    return dataset.assign_attrs({
        "title": "Subset simulation of a rocking system",
        "references": f"{dataset.attrs['references']}; {_REFERENCES}",
        "limit_state": state.name,
        LIMITS_ATTRIBUTE: states_json([state]),
        SAMPLING_ATTRIBUTE: "subset simulation",
        "seed": first,
        "share": fraction,
        "confidence": nominal,
        "verdict": _sentence(dataset, state, nominal, len(named or ()), completed=completed),
    })  # fmt: skip


def _read_limit(argument: object) -> LimitState:
    """Read the limit state, which must have a demand that grows towards it."""
    if not isinstance(argument, str | int | float | tuple):
        msg = (
            f"{_OWNER}: limit must be one limit state: 'overturning', a peak rotation over the "
            f"overturning angle, or ('peak_slip', '5 cm') and the like, got {short_repr(argument)}"
        )
        raise ComponentError(msg)
    state = limit_states([argument], owner=_OWNER, name="limit")[0]
    if not (state.rotation > 0.0 or state.value > 0.0):
        msg = (
            f"{_OWNER}: limit {state.name!r} is met or not, and no response shows how near it is; "
            "give 'overturning', a peak rotation over the overturning angle such as 0.1, or a "
            "variable of runs and a value above zero"
        )
        raise ComponentError(msg)
    return state


class _Sampler:
    """Transforms normal scores to parameters, runs the cases, and collects the results."""

    def __init__(
        self, rounds: SweepRounds, spreads: Sequence[RandomParameter], matrix: Array | None,
        names: Sequence[str], state: LimitState,
    ) -> None:  # fmt: skip
        self.warnings: list[str] = []  # warnings beyond the first level
        self.runs: list[xr.Dataset] = []
        self._rounds, self._spreads, self._names, self._state = rounds, spreads, names, state
        self._cholesky = np.eye(len(spreads)) if matrix is None else np.linalg.cholesky(matrix)

    @property
    def size(self) -> int:
        """Length of a sample: the number of parameters, and one more for several motions."""
        return len(self._spreads) + (len(self._names) > 1)

    def demand(self, part: str, scores: Array) -> Array:
        """Run samples, a row of normal scores each; give their demands."""
        table = self._table(scores)
        with collected_warnings() if self.runs else nullcontext([]) as warned:
            runs, completed = self._rounds.sweep(part, table, {}, follow_up=bool(self.runs))
        self.warnings += warned
        if not completed:
            raise KeyboardInterrupt
        # if a function makes the motion, the sweep has a dimension for it
        self.runs.append(runs.isel({MOTION: 0}) if MOTION in runs.dims else runs)
        return demands(self.runs[-1], self._state).to_numpy()

    def _table(self, scores: Array) -> dict[str, Any]:
        """Return the cases of samples, :eq:`eq-gaussian-copula`."""
        from scipy.special import ndtr

        count = len(self._spreads)
        normal = scores[:, :count] @ self._cholesky.T
        # each from the probability of its own tail, which loses no digits
        beyond = ndtr(-np.abs(normal))
        table: dict[str, Any] = {
            head(parameter.name, parameter.unit): np.where(
                score > 0.0, parameter.distribution.isf(tail), parameter.distribution.ppf(tail)
            )
            for parameter, score, tail in zip(self._spreads, normal.T, beyond.T, strict=True)
        }
        if self._names:
            several = len(self._names)
            place = ndtr(scores[:, count]) * several if several > 1 else np.zeros(len(scores))
            number = np.minimum(place.astype(int), several - 1)
            table[MOTION] = np.array(self._names, dtype=object)[number]
        return table


def _subset_dataset(
    sampler: _Sampler, levels: Sequence[Level], confidence: float, *, completed: bool
) -> xr.Dataset:
    """Return a dataset of the samples of all levels with their runs, and of the probability."""
    first = sampler.runs[0]
    origins = np.concatenate([level.origins for level in levels])
    samples = concat(sampler.runs, CASE).isel({CASE: origins})
    samples = samples.assign_coords({CASE: (CASE, np.arange(len(origins)), first[CASE].attrs)})
    lower, upper = subset_bounds(levels, confidence)
    of_levels = build_dataset(
        {
            "sampling_level": np.arange(1, len(levels) + 1),
            "demand_threshold": np.array([level.threshold for level in levels]),
            "conditional_probability": np.array([level.share for level in levels]),
            "acceptance_rate": np.array([level.acceptance for level in levels]),
            "chain_count": np.array([level.chains for level in levels]),
            "exceedance_probability": subset_probability(levels) if completed else np.nan,
            "exceedance_probability_lower_bound": lower if completed else 0.0,
            "exceedance_probability_upper_bound": upper,
            "coefficient_of_variation": subset_variation(levels) if completed else np.nan,
            "run_count": sum(level.runs for level in levels),
            "left_out_count": sum(level.left_out for level in levels),
            "family_count": int((family_shares(levels) > 0.0).sum()),
        },
        {},
        source="subset simulation by event-driven runs",
    )
    lengths = [len(level.demands) for level in levels]
    of_samples = {
        "demand": np.concatenate([level.demands for level in levels]),
        "sample_level": np.repeat(of_levels["sampling_level"], lengths),
        "sample_weight": np.concatenate(sample_weights(levels)),
    }
    attributes = {name: first.attrs[name] for name in _TABLE_ATTRIBUTES}
    samples = samples.assign(of_levels.data_vars).assign_coords(of_levels.coords)
    samples = with_variables(samples, of_samples, over=(CASE,))
    return samples.assign_attrs({**attributes, "source": of_levels.attrs["source"]})


def _warn_of_uncertain_probability(dataset: xr.Dataset) -> None:
    """Warn if the probability has only an upper bound, or is uncertain."""
    families, levels = int(dataset["family_count"]), dataset.sizes["sampling_level"]
    if families == 0:
        last = dataset["demand"].where(dataset["sample_level"] == levels, drop=True)
        least, most = float(last.min()), float(last.max())
        why = f"the greatest demand is {most:.3g}; allow more levels"
        if least == most:
            why = f"all samples of the last demand {most:.3g}, so that none leads on"
        msg = f"{_OWNER}: no sample exceeds the limit state, after {levels} levels: {why}"
        warn(msg, ModelWarning)
    elif families < _MIN_FAMILIES:
        warn(
            f"{_OWNER}: all samples that exceed descend from {families} of the first level, so "
            "that the coefficient of variation is hardly known; draw more cases",
            ModelWarning,
        )


def _sentence(
    dataset: xr.Dataset, state: LimitState, confidence: float, motions: int, *, completed: bool
) -> str:
    """Return the verdict in words: the probability, and the number of runs."""
    outcome = "Overturns" if state.rotation == 1.0 else f"Exceeds {state.name}"
    probability, lower, upper = (
        float(dataset[f"exceedance_probability{end}"]) for end in BOUND_SUFFIXES
    )
    if probability > 0.0:
        text = (
            f"{outcome} with probability {probability:.2e}, from {lower:.2e} to {upper:.2e} with "
            f"confidence {confidence:g}, coefficient of variation "
            f"{float(dataset['coefficient_of_variation']):.2g}"
        )
    else:
        text = f"{outcome} with a probability below {upper:.2e} with confidence {confidence:g}"
    levels = dataset.sizes["sampling_level"]
    text += f", by {int(dataset['run_count'])} runs in {levels} level{'s' * (levels > 1)}"
    if motions > 1:
        text += f" under these {motions} motions"
    missing = int(dataset["left_out_count"])
    if missing:
        text += f"; {missing} without a verdict are left out"
    return f"{text}." if completed else f"{text}{INTERRUPTED_ENDING}"
