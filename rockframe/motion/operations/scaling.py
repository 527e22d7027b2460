"""Scaling a ground motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple, Self

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion.operations.base import ProcessedMotion
from rockframe.motion.samples import Array, MotionSI
from rockframe.shaking.path import ground_path
from rockframe.shaking.polynomials import greatest
from rockframe.shaking.shaking import Shaking
from rockframe.shaking.spectra import (
    DAMPING_RATIO,
    check_cost,
    pseudo_spectra,
    spectral_peaks,
)
from rockframe.units import ACCELERATION, PERIOD, POSITIVE, TIME, VELOCITY, to_ratio, to_si

if TYPE_CHECKING:
    from rockframe.motion.quantities import QuantityLike, RatioLike

_USUAL_DAMPING: Final = 0.05


class ScalingOperations(ProcessedMotion):
    """A motion that can be made stronger or weaker."""

    __slots__ = ()

    def scaled(
        self,
        factor: RatioLike | None = None,
        *,
        peak: QuantityLike | None = None,
        peak_velocity: QuantityLike | None = None,
        spectral_acceleration: QuantityLike | None = None,
        period: QuantityLike | None = None,
        damping_ratio: RatioLike | None = None,
    ) -> Self:
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
        """
        owner, si = f"{type(self).__name__}.scaled", self.si
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
            return self._times(ratio, f"scaled by {ratio!r}", {"factor": ratio})
        shaking = Shaking.of(si.time_step, si.acceleration, si.pieces)
        if peak is not None:
            target = _peak(shaking, peak, owner)
        elif peak_velocity is not None:
            target = _peak_velocity(shaking, peak_velocity, owner)
        else:
            target = _spectral(shaking, spectral_acceleration, period, damping_ratio, owner)
        if target.present <= 0.0:
            msg = f"{owner}: the motion has no horizontal acceleration, so nothing to scale"
            raise ComponentError(msg)
        ratio = target.wanted / target.present
        return self._times(ratio, f"scaled by {ratio!r} to {target.words}", target.arguments)

    def _times(self, ratio: float, step: str, given: dict[str, float | str]) -> Self:
        si = self.si

        def times(values: Array | None) -> Array | None:
            with np.errstate(over="ignore"):
                return None if values is None else values * ratio

        with np.errstate(over="ignore"):
            larger = si.acceleration * ratio
        pieces = times(si.pieces), times(si.vertical_pieces)
        result = MotionSI(si.time_step, larger, times(si.vertical), *pieces)
        return self._next(result, step, operation={"scaled": given})


class _Target(NamedTuple):
    wanted: float
    present: float
    words: str
    arguments: dict[str, float | str]


def _peak(shaking: Shaking, given: QuantityLike, owner: str) -> _Target:
    wanted = to_si(given, ACCELERATION, owner=owner, name="peak", condition=POSITIVE)
    words = f"a peak of {wanted:.9g} {ACCELERATION.unit}"
    arguments: dict[str, float | str] = {"peak": f"{wanted!r} {ACCELERATION.unit}"}
    return _Target(wanted, greatest(shaking.pieces), words, arguments)


def _peak_velocity(shaking: Shaking, given: QuantityLike, owner: str) -> _Target:
    wanted = to_si(given, VELOCITY, owner=owner, name="peak_velocity", condition=POSITIVE)
    words = f"a peak velocity of {wanted:.9g} {VELOCITY.unit}"
    arguments: dict[str, float | str] = {"peak_velocity": f"{wanted!r} {VELOCITY.unit}"}
    return _Target(wanted, greatest(ground_path(shaking)[0]), words, arguments)


def _spectral(
    shaking: Shaking,
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
    check_cost(shaking, periods, owner=owner)
    displacement = spectral_peaks(shaking, periods, damping)[:, 0]
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
        wanted, float(pseudo_spectra(shaking, periods, displacement)[1][0]), words, arguments
    )
