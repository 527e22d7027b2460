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
from rockframe.results.joining import CASE_COUNT
from rockframe.results.outcome import Generic
from rockframe.results.schema import with_variables
from rockframe.results.variables.studies import MESSAGE, MOTION
from rockframe.shared_arguments import with_shared_arguments
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import Array
from rockframe.signals.motion import COEFFICIENTS
from rockframe.simulation.certify.perturbations import cut
from rockframe.simulation.run import NONE
from rockframe.simulation.system import System, check_system
from rockframe.studies.limit_states import overturns
from rockframe.studies.sweeps.arguments import SequenceArguments
from rockframe.studies.sweeps.sweep import sweep
from rockframe.units import NOT_NEGATIVE, TIME, QuantityLike, to_si

_OWNER: Final = "earthquake_sequences"
_SAME_STEP: Final = 1e-9
"""Relative difference up to which two time steps are the same."""
_MOST_PARTS: Final = 64
"""Most parts into which an interval is divided for a common time step."""
NUMBER: Final = "earthquake"


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
        to the end of the pause after that earthquake, NaN beyond the last earthquake. Over
        ``sequence``: ``overturning_earthquake``, the number of the earthquake that overturned the
        block, 0 if none did, and ``pause`` [s].

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
    rest = to_si(pause, TIME, owner=_OWNER, name="pause", condition=NOT_NEGATIVE)
    named = _sequences(sequences)
    joined = {
        name: list(accumulate(each, lambda first, second: _joined(first, second, rest)))
        for name, each in named.items()
    }
    longest = max(len(each) for each in joined.values())
    motions = {
        f"{name}, {number}": _joined(motion, None, rest)
        for name, each in joined.items()
        for number, motion in enumerate(each, start=1)
    }
    there = np.arange(longest) < np.array([[len(each)] for each in joined.values()])
    arranged = _arranged(sweep(system, motions, **run), there)
    fell = overturns(arranged).transpose("sequence", NUMBER).to_numpy() == 1.0
    labels = {
        "sequence": np.array(list(joined), dtype=object),
        NUMBER: np.arange(1, longest + 1),
        "overturning_earthquake": np.where(fell.any(axis=1), fell.argmax(axis=1) + 1, 0),
        "pause": np.array([_pause(each[0], rest) for each in named.values()]),
    }
    found = with_variables(arranged, labels)
    of_all = "1 sequence" if len(joined) == 1 else f"all {len(joined)} sequences"
    verdict = f"Of {of_all} {int(fell.any(axis=1).sum())} overturned."
    return found.assign_attrs(title="Earthquakes in sequence", verdict=verdict)


def _sequences(value: object) -> dict[str, list[GroundMotion]]:
    """Read the sequences, and check that their motions fit."""
    if isinstance(value, Mapping):
        named = with_string_keys(cast("Mapping[Any, Any]", value), owner=_OWNER)
    elif is_iterable(value) and not isinstance(value, str):
        listed = list(value)
        if len(listed) > 1 and all(isinstance(one, GroundMotion) for one in listed):
            msg = (
                f"{_OWNER}: found {len(listed)} motions in a row; expected a row of sequences: put "
                "brackets around the motions that follow one another, [[main, aftershock]]"
            )
            raise ComponentError(msg)
        named = {f"sequence {number}": each for number, each in enumerate(listed, start=1)}
    else:
        named = {}
    found: dict[str, list[GroundMotion]] = {}
    for name, each in named.items():
        motions = [each] if isinstance(each, GroundMotion) else checked_list(
            each, owner=_OWNER, name=repr(name), of="GroundMotions"
        )  # fmt: skip
        if not motions or not all(isinstance(one, GroundMotion) for one in motions):
            msg = f"{_OWNER}: {name!r} needs GroundMotions in their order, got {short_repr(each)}"
            raise ComponentError(msg)
        found[name] = motions
    if not found:
        msg = f"{_OWNER}: found {short_repr(value)}; expected sequences of GroundMotions"
        raise ComponentError(msg)
    return {name: _of_one_step(each) for name, each in found.items()}


def _of_one_step(motions: list[GroundMotion]) -> list[GroundMotion]:
    """Divide the intervals of motions, so that all have one time step; each stays as it is."""
    steps = [one.si.time_step for one in motions]
    least = min(steps)
    ratios = [Fraction(step / least).limit_denominator(_MOST_PARTS) for step in steps]
    common = math.lcm(*(one.denominator for one in ratios))  # parts of the least step
    parts = [int(one * common) for one in ratios]
    fits = [
        math.isclose(step, count * least / common, rel_tol=_SAME_STEP)
        for step, count in zip(steps, parts, strict=True)
    ]
    if not all(fits) or max(parts) > _MOST_PARTS:
        msg = (
            f"{_OWNER}: the motions have time steps from {least!r} s to {max(steps)!r} s, which "
            f"have no common part; resample them, for example motion.resampled('{least!r} s')"
        )
        raise ComponentError(msg)
    return [
        one if count == 1 else cut(one, count) for one, count in zip(motions, parts, strict=True)
    ]


def _joined(first: GroundMotion, second: GroundMotion | None, rest: float) -> GroundMotion:
    """Join motions, or put still ground after one."""
    if second is None and rest == 0.0:
        return first
    still = _steps(first, rest)
    both = [one for one in (first, second) if one is not None]
    horizontal = _after([one.si.horizontal for one in both], still)
    vertical = None
    if any(one.si.vertical is not None for one in both):
        vertical = _after([one.si.vertical or _level(one.si.horizontal) for one in both], still)
    return GroundMotion(Motion(horizontal, vertical), name=", then ".join(one.name for one in both))


def _steps(motion: GroundMotion, rest: float) -> int:
    """Return the number of time steps in which the ground stands still."""
    return max(1, round(rest / motion.si.time_step))


def _pause(motion: GroundMotion, rest: float) -> float:
    """Return the pause in a sequence; exactly the given one where it is whole time steps."""
    found = _steps(motion, rest) * motion.si.time_step
    return rest if math.isclose(found, rest, rel_tol=_SAME_STEP) else found


def _level(horizontal: Signal) -> Signal:
    """Return a vertical component that is zero, of the length of the horizontal one."""
    still = np.zeros(horizontal.samples.size)
    return replace(horizontal, samples=still, polynomials=None, name="vertical")


def _after(signals: Sequence[Signal], still: int) -> Signal:
    """Put intervals of still ground after a signal, and then another one, if there is one."""
    first, *others = signals
    samples = [first.samples, np.zeros(still - len(others)), *(one.samples for one in others)]
    pieces = [_six(first.pieces), np.zeros((still, COEFFICIENTS))]
    pieces += [_six(one.pieces) for one in others]
    return Signal(first.time_step, np.concatenate(samples), np.concatenate(pieces), first.name)


def _six(pieces: Array) -> Array:
    return np.pad(pieces, ((0, 0), (0, COEFFICIENTS - pieces.shape[1])))


def _arranged(runs: xr.Dataset, there: Generic) -> xr.Dataset:
    """Return the runs with dimensions of sequence and earthquake instead of motion."""
    found: dict[str, xr.Variable] = {}
    gaps = not there.all()
    for name, one in runs.data_vars.items():
        if one.dims != (MOTION,):
            continue
        values = np.full(there.shape, np.nan) if gaps else np.empty(there.shape, dtype=one.dtype)
        values[there] = one.to_numpy()
        attributes = dict(one.attrs)
        if gaps and "flag_values" in attributes:
            attributes["flag_values"] = attributes["flag_values"].astype(np.float64)
        found[str(name)] = xr.Variable(("sequence", NUMBER), values, attributes)
    words = np.full(there.shape, NONE, dtype=object)
    words[there] = runs[MESSAGE].to_numpy()
    texts = xr.Variable(("sequence", NUMBER), words, runs[MESSAGE].attrs)
    attributes = {name: one for name, one in runs.attrs.items() if name != CASE_COUNT}
    return xr.Dataset(found, coords={MESSAGE: texts}, attrs=attributes)
