"""Scaling a ground motion."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion.operations.following import following
from rockframe.motion.processing.samples import say_coarse
from rockframe.motion.value import Made
from rockframe.proposals import hinted
from rockframe.records import DOWNWARDS, SENSE, UPWARDS
from rockframe.signals.integrals import ground_path
from rockframe.signals.motion import greatest
from rockframe.signals.spectra import (
    DAMPING_RATIO,
    check_cost,
    pseudo_spectra,
    spectral_peaks,
)
from rockframe.units import (
    ACCELERATION,
    PERIOD,
    POSITIVE,
    TIME,
    VELOCITY,
    QuantityLike,
    RatioLike,
    to_ratio,
    to_si,
)

if TYPE_CHECKING:
    from rockframe.signals import Motion, Signal

_OPPOSITE: Final = {UPWARDS: DOWNWARDS, DOWNWARDS: UPWARDS}
_USUAL_DAMPING: Final = 0.05


@hinted()
def scaled(
    motion: Made,
    factor: RatioLike | None = None,
    *,
    peak: QuantityLike | None = None,
    peak_velocity: QuantityLike | None = None,
    spectral_acceleration: QuantityLike | None = None,
    period: QuantityLike | None = None,
    damping_ratio: RatioLike | None = None,
) -> Made:
    """Multiply the motion, both components alike.

    Give one of `factor`, `peak`, `peak_velocity` and `spectral_acceleration`.

    Parameters
    ----------
    factor : float, optional
        Factor; negative mirrors the motion [1].
    peak : str or Quantity, optional
        The peak horizontal acceleration to reach [m s^-2].
    peak_velocity : str or Quantity, optional
        The peak horizontal velocity to reach, from rest at the start [m s^-1].
    spectral_acceleration : str or Quantity, optional
        The pseudo-spectral acceleration to reach at `period`, horizontally
        [m s^-2].
    period : str or Quantity, optional
        Of the oscillator of `spectral_acceleration` [s].
    damping_ratio : float, optional
        Of that oscillator; 0.05 unless given [1].

    Returns
    -------
    GroundMotion

    Raises
    ------
    UnitsError
        Not a ratio, an acceleration, a velocity or a time.
    ComponentError
        None or several given, `period` or `damping_ratio` without
        `spectral_acceleration` or the other way round, a value out of range, or a motion
        without any acceleration, which nothing can scale to a target.

    Warns
    -----
    RecordWarning
        `period` is shorter than ten time steps of a record.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.sine_pulse("3 m/s^2", "2 Hz")
    >>> pulse.scaled(2).peak_acceleration, pulse.scaled(peak="0.5 g_0").peak_acceleration.to("g_0")
    (<Quantity(6.0, 'meter / second ** 2')>, <Quantity(0.5, 'standard_gravity')>)
    """
    owner = f"{type(motion).__name__}.scaled"
    targets = {
        "factor": factor,
        "peak": peak,
        "peak_velocity": peak_velocity,
        "spectral_acceleration": spectral_acceleration,
    }
    given = {name: value for name, value in targets.items() if value is not None}
    if len(given) != 1:
        msg = f"{owner}: give one of {', '.join(targets)}, for example peak='0.3 g_0'"
        raise ComponentError(msg)
    if (period is None) != (spectral_acceleration is None) or (
        damping_ratio is not None and spectral_acceleration is None
    ):
        msg = f"{owner}: spectral_acceleration and period go together (and damping_ratio)"
        raise ComponentError(msg)
    if factor is not None:
        ratio = to_ratio(factor, owner=owner, name="factor", example="2")
        return _times(motion, ratio, f"scaled by {ratio!r}", {"factor": ratio})
    across = motion.si.horizontal
    if peak is not None:
        target = _peak(across, peak, owner)
    elif peak_velocity is not None:
        target = _peak_velocity(across, peak_velocity, owner)
    else:
        target = _spectral(across, spectral_acceleration, period, damping_ratio, owner)
    if target.present <= 0.0:
        msg = f"{owner}: the motion has no horizontal acceleration, so nothing to scale"
        raise ComponentError(msg)
    ratio = target.wanted / target.present
    return _times(motion, ratio, f"scaled by {ratio!r} to {target.words}", target.arguments)


def multiplied(motion: Motion, ratio: float) -> Motion:
    """Multiply the accelerations of both components."""

    def times(signal: Signal) -> Signal:
        with np.errstate(over="ignore"):
            pieces = None if signal.polynomials is None else signal.polynomials * ratio
            return replace(signal, samples=signal.samples * ratio, polynomials=pieces)

    return motion.each(times)


def _times(motion: Made, ratio: float, step: str, given: dict[str, float | str]) -> Made:
    added: dict[str, str] = {}
    sense = motion.metadata.get(SENSE)
    if ratio < 0.0 and sense in _OPPOSITE:  # mirrored: what was positive upwards is so downwards
        added[SENSE] = _OPPOSITE[str(sense)]
    operation = {"scaled": given}
    return following(
        motion, multiplied(motion.si, ratio), step, operation=operation, metadata=added
    )


class _Target(NamedTuple):
    wanted: float
    present: float
    words: str
    arguments: dict[str, float | str]


def _peak(across: Signal, given: QuantityLike, owner: str) -> _Target:
    wanted = to_si(given, ACCELERATION, owner=owner, name="peak", condition=POSITIVE)
    words = f"a peak of {wanted:.9g} {ACCELERATION.unit}"
    arguments: dict[str, float | str] = {"peak": f"{wanted!r} {ACCELERATION.unit}"}
    return _Target(wanted, greatest(across.pieces), words, arguments)


def _peak_velocity(across: Signal, given: QuantityLike, owner: str) -> _Target:
    wanted = to_si(given, VELOCITY, owner=owner, name="peak_velocity", condition=POSITIVE)
    words = f"a peak velocity of {wanted:.9g} {VELOCITY.unit}"
    arguments: dict[str, float | str] = {"peak_velocity": f"{wanted!r} {VELOCITY.unit}"}
    return _Target(wanted, greatest(ground_path(across)[0]), words, arguments)


def _spectral(
    across: Signal,
    given: QuantityLike | None,
    period: QuantityLike | None,
    damping_ratio: RatioLike | None,
    owner: str,
) -> _Target:
    name = "spectral_acceleration"
    wanted = to_si(given, ACCELERATION, owner=owner, name=name, condition=POSITIVE)
    seconds = to_si(period, PERIOD, owner=owner, name="period", condition=POSITIVE)
    damping = to_ratio(
        _USUAL_DAMPING if damping_ratio is None else damping_ratio,
        owner=owner,
        name="damping_ratio",
        condition=DAMPING_RATIO,
    )
    periods = np.array([seconds])
    check_cost(across, periods, owner=owner)
    say_coarse([across], seconds, owner=owner)
    displacement = spectral_peaks(across, periods, damping)[:, 0]
    words = (
        f"a pseudo-spectral acceleration of {wanted:.9g} {ACCELERATION.unit} at "
        f"{seconds:.9g} s, damping ratio {damping:.9g}"
    )
    arguments: dict[str, float | str] = {
        name: f"{wanted!r} {ACCELERATION.unit}",
        "period": f"{seconds!r} {TIME.unit}",
        "damping_ratio": damping,
    }
    return _Target(
        wanted, float(pseudo_spectra(across, periods, displacement)[1][0]), words, arguments
    )
