"""Sequences of earthquakes: response after each, starting from the state after those before."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import accumulate
from typing import Any, Final, Unpack, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_list, is_iterable, with_string_keys
from rockframe.errors import ComponentError, short_repr
from rockframe.motion import GroundMotion
from rockframe.motion.display import display_name
from rockframe.motion.pair import motion_hint
from rockframe.results.joining import CASE_COUNT
from rockframe.results.outcome import overturns
from rockframe.results.schema import with_variables
from rockframe.results.variables.studies import MESSAGE, MOTION
from rockframe.shared_arguments import with_shared_arguments
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import AnyArray
from rockframe.signals.motion import COEFFICIENTS
from rockframe.simulation.certify.perturbations import divide_intervals
from rockframe.simulation.run import NONE
from rockframe.simulation.system import System, check_system
from rockframe.studies.sweeps.arguments import SequenceArguments
from rockframe.studies.sweeps.sweep import sweep
from rockframe.units import NOT_NEGATIVE, TIME, QuantityLike, to_si

_OWNER: Final = "earthquake_sequences"
_STEP_TOLERANCE: Final = 1e-9
"""Relative difference up to which two time steps are the same."""
_MAX_SUBDIVISIONS: Final = 64
"""Most parts into which an interval is divided for a common time step."""
EARTHQUAKE: Final = "earthquake"


@with_shared_arguments(SequenceArguments)
def earthquake_sequences(
    system: System,
    sequences: Mapping[str, Sequence[GroundMotion]] | Sequence[Sequence[GroundMotion]],
    *,
    pause: QuantityLike = "20 s",
    **run: Unpack[SequenceArguments],
) -> xr.Dataset:
    """Run earthquakes in sequence, each from the state in which the previous one left the system.

    Parameters
    ----------
    system : System
        The scene.
    sequences : mapping of str to sequence of GroundMotion, or sequence of sequences
        Earthquakes in order, such as a main shock and its aftershocks. If their time steps differ,
        intervals are divided, down to a 64th; this does not change the motions.
    pause : str or Quantity, optional
        Duration of still ground after each earthquake [s], in whole time steps of its sequence, and
        at least one between two motions. The actual pause is in the result.

    Returns
    -------
    xarray.Dataset
        Over ``sequence`` and ``earthquake``: the scalars of the run from the start of the sequence
        to the end of the pause after that earthquake, NaN beyond the last earthquake; of bodies
        that may slide also the slip of each, ``peak_body_slip``. Over
        ``sequence``: ``overturning_earthquake``, the number of the earthquake that overturned the
        block, 0 if none did, NaN if a run without a verdict leaves it unknown, and ``pause`` [s].

    Raises
    ------
    UnitsError, ComponentError
        There are no motions, the time steps of a sequence have no common part, or `pause` has a
        wrong unit or none.
    StudyError
        As for :func:`rockframe.sweep`.

    Notes
    -----
    The motions are joined, with their polynomials and zeros between them. Each row of the result is
    a run from the start of its sequence, so that no state is lost in between. On rigid ground, on
    pads and on soil, a block that has come to rest retains only its slip and the yielding and
    breaking of its ties; a user-defined base may retain more.

    Peaks and verdicts are those of runs that continue one another by ``initial``, to the accuracy
    of integration; the number of impacts may be another one. How many tiny bounces precede rest
    follows from rounding, and times are rounded otherwise after a longer time: under one of 180
    pairs of stochastic motions a block had 290 instead of 260 impacts, and 247 to 309 under the
    second motion scaled by 1 + 1e-14.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> shock = rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
    >>> found = rf.earthquake_sequences(system, {"growing": [shock, shock.scaled(3)]})
    >>> found.overturning_earthquake.item()
    2
    """
    check_system(system, _OWNER)
    pause_time = to_si(pause, TIME, owner=_OWNER, name="pause", condition=NOT_NEGATIVE)
    named = _read_sequences(sequences)
    joined = {
        name: list(accumulate(sequence, lambda first, second: _join(first, second, pause_time)))
        for name, sequence in named.items()
    }
    longest = max(len(sequence) for sequence in joined.values())
    motions = {
        f"{name}, {number}": _join(motion, None, pause_time)
        for name, sequence in joined.items()
        for number, motion in enumerate(sequence, start=1)
    }
    exists = np.arange(longest) < np.array([[len(sequence)] for sequence in joined.values()])
    arranged = _unstack_sequences(sweep(system, motions, **run), exists)
    verdicts = overturns(arranged).transpose("sequence", EARTHQUAKE).to_numpy()
    overturned = (verdicts == 1.0).any(axis=1)
    # after which earthquake the verdict of a sequence is decided, or not known
    decisive = (verdicts == 1.0) | (np.isnan(verdicts) & exists)
    first = decisive.argmax(axis=1)
    number = np.where(decisive.any(axis=1), first + 1.0, 0.0)
    number[np.isnan(verdicts[np.arange(len(first)), first])] = np.nan
    labels = {
        "sequence": np.array(list(joined), dtype=object),
        EARTHQUAKE: np.arange(1, longest + 1),
        "overturning_earthquake": number,
        "pause": np.array([_actual_pause(sequence[0], pause_time) for sequence in named.values()]),
    }
    dataset = with_variables(arranged, labels)
    of_all = "1 sequence" if len(joined) == 1 else f"all {len(joined)} sequences"
    text = f"Of {of_all} {int(overturned.sum())} overturned"
    if unknown := int((np.isnan(number) & ~overturned).sum()):
        text += f"; {unknown} {'has' if unknown == 1 else 'have'} no verdict"
    return dataset.assign_attrs(title="Earthquakes in sequence", verdict=f"{text}.")


def _read_sequences(value: object) -> dict[str, list[GroundMotion]]:
    """Read the sequences, and check that their motions fit."""
    if isinstance(value, Mapping):
        named = with_string_keys(cast("Mapping[Any, Any]", value), owner=_OWNER)
    elif is_iterable(value) and not isinstance(value, str):
        listed = list(value)
        if len(listed) > 1 and all(isinstance(motion, GroundMotion) for motion in listed):
            msg = (
                f"{_OWNER}: found {len(listed)} motions in a row; expected a row of sequences: put "
                "brackets around the motions that follow one another, [[main, aftershock]]"
            )
            raise ComponentError(msg)
        named = {f"sequence {number}": sequence for number, sequence in enumerate(listed, start=1)}
    else:
        named = {}
    if not named:
        msg = f"{_OWNER}: found {short_repr(value)}; expected sequences of GroundMotions"
        raise ComponentError(msg)
    sequences: dict[str, list[GroundMotion]] = {}
    for name, sequence in named.items():
        given = [sequence] if isinstance(sequence, GroundMotion) else sequence
        motions = checked_list(given, owner=_OWNER, name=repr(name), of="GroundMotions")
        if not motions or not all(isinstance(motion, GroundMotion) for motion in motions):
            wrong = [motion for motion in motions if not isinstance(motion, GroundMotion)]
            found = f"{short_repr(sequence)}{motion_hint(wrong[0]) if wrong else ''}"
            msg = f"{_OWNER}: {name!r} needs GroundMotions in their order, got {found}"
            raise ComponentError(msg)
        sequences[name] = motions
    return {name: _with_common_step(motions) for name, motions in sequences.items()}


def _with_common_step(motions: list[GroundMotion]) -> list[GroundMotion]:
    """Divide the intervals of motions, so that all have one time step; each stays as it is."""
    steps = [motion.si.time_step for motion in motions]
    least = min(steps)
    ratios = [Fraction(step / least).limit_denominator(_MAX_SUBDIVISIONS) for step in steps]
    common = math.lcm(*(ratio.denominator for ratio in ratios))  # parts of the least step
    parts = [int(ratio * common) for ratio in ratios]
    fits = [
        math.isclose(step, count * least / common, rel_tol=_STEP_TOLERANCE)
        for step, count in zip(steps, parts, strict=True)
    ]
    if not all(fits) or max(parts) > _MAX_SUBDIVISIONS:
        msg = (
            f"{_OWNER}: the motions have time steps from {least!r} s to {max(steps)!r} s, which "
            f"have no common part; resample them, for example motion.resampled('{least!r} s')"
        )
        raise ComponentError(msg)
    return [
        motion if count == 1 else divide_intervals(motion, count)
        for motion, count in zip(motions, parts, strict=True)
    ]


def _join(first: GroundMotion, second: GroundMotion | None, pause_time: float) -> GroundMotion:
    """Join motions, or put still ground after one."""
    if second is None and pause_time == 0.0:
        return first
    still = _pause_steps(first, pause_time)
    motions = [first] if second is None else [first, second]
    horizontal = _concatenate([motion.si.horizontal for motion in motions], still)
    vertical = None
    if any(motion.si.vertical is not None for motion in motions):
        components = [motion.si.vertical or _still(motion.si.horizontal) for motion in motions]
        vertical = _concatenate(components, still)
    name = ", then ".join(display_name(motion.name, motion.history) for motion in motions)
    return GroundMotion(Motion(horizontal, vertical), name=name)


def _pause_steps(motion: GroundMotion, pause_time: float) -> int:
    """Return the number of time steps in which the ground stands still."""
    return max(1, round(pause_time / motion.si.time_step))


def _actual_pause(motion: GroundMotion, pause_time: float) -> float:
    """Return the pause in a sequence; exactly the given one where it is whole time steps."""
    pause = _pause_steps(motion, pause_time) * motion.si.time_step
    return pause_time if math.isclose(pause, pause_time, rel_tol=_STEP_TOLERANCE) else pause


def _still(horizontal: Signal) -> Signal:
    """Return a vertical component that is zero, of the length of the horizontal one."""
    zeros = np.zeros(horizontal.samples.size)
    return replace(horizontal, samples=zeros, polynomials=None, name="vertical")


def _concatenate(signals: Sequence[Signal], still: int) -> Signal:
    """Put intervals of still ground after a signal, and then another one, if there is one."""
    first, *later = signals
    samples = [first.samples, np.zeros(still - len(later)), *(signal.samples for signal in later)]
    every = [first.pieces, np.zeros((still, COEFFICIENTS)), *(signal.pieces for signal in later)]
    pieces = [np.pad(of, ((0, 0), (0, COEFFICIENTS - of.shape[1]))) for of in every]
    return Signal(first.time_step, np.concatenate(samples), np.concatenate(pieces), first.name)


def _unstack_sequences(runs: xr.Dataset, exists: AnyArray) -> xr.Dataset:
    """Return the runs with dimensions of sequence and earthquake instead of motion."""
    variables: dict[str, xr.Variable] = {}
    gaps = not exists.all()
    for name, array in runs.data_vars.items():
        if MOTION not in array.dims:
            continue
        variable = array.variable.transpose(MOTION, ...)
        shape = (*exists.shape, *variable.shape[1:])
        values = np.full(shape, np.nan) if gaps else np.empty(shape, variable.dtype)
        values[exists] = variable.to_numpy()
        attributes = dict(variable.attrs)
        if gaps and "flag_values" in attributes:
            attributes["flag_values"] = attributes["flag_values"].astype(np.float64)
        dims = ("sequence", EARTHQUAKE, *variable.dims[1:])
        variables[str(name)] = xr.Variable(dims, values, attributes)
    words = np.full(exists.shape, NONE, dtype=object)
    words[exists] = runs[MESSAGE].to_numpy()
    texts = xr.Variable(("sequence", EARTHQUAKE), words, runs[MESSAGE].attrs)
    attributes = {name: value for name, value in runs.attrs.items() if name != CASE_COUNT}
    others = {name: of for name, of in runs.coords.items() if MOTION not in of.dims}
    return xr.Dataset(variables, coords={**others, MESSAGE: texts}, attrs=attributes)
