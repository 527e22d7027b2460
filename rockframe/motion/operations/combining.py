"""Joining components of a ground motion."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, Self, cast

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion.operations.base import ProcessedMotion, other_motion
from rockframe.motion.processing.sampling import padded
from rockframe.motion.samples import COEFFICIENTS, Array, MotionSI
from rockframe.motion.value import MotionValue
from rockframe.units import ANGLE, to_si

if TYPE_CHECKING:
    from rockframe.motion.quantities import QuantityLike

_RIGHT_ANGLE_TOLERANCE: Final = 1.0  # degrees; agencies round azimuths to whole ones
_ROUNDING: Final = 1e-15


class CombiningOperations(ProcessedMotion):
    """A motion that can be joined with another component."""

    __slots__ = ()

    def with_vertical(self, other: MotionValue) -> Self:
        """Add a vertical motion: the horizontal component of another one, upwards.

        Parameters
        ----------
        other : GroundMotion
            Of the same time step; the shorter of the two is padded with zeros.

        Returns
        -------
        GroundMotion

        Raises
        ------
        ComponentError
            Not a motion, or another time step.
        """
        owner, si = f"{type(self).__name__}.with_vertical", self.si
        theirs = other_motion(other, si, owner).si
        count = max(len(self), len(other))
        across, pieces = padded(si.acceleration, si.pieces, count)
        upwards, vertical_pieces = padded(theirs.acceleration, theirs.pieces, count)
        verb = "vertical component" if si.vertical is None else "vertical component replaced:"
        steps = [f"{verb} {other.name} (sha256 {other.sha256[:12]})"]
        for label, motion in (("horizontal", self), ("vertical", other)):
            if len(motion) < count:
                steps.append(f"{label} component padded with {count - len(motion)} zeros")
        result = MotionSI(si.time_step, across, upwards, pieces, vertical_pieces)
        about = {f"vertical_{key}": value for key, value in other.metadata.items()}
        known = None if other._recipe is None else dict(other._recipe)
        operation = None if known is None else {"with_vertical": {"other": known}}
        return self._next(result, *steps, operation=operation, metadata=about)

    def rotated(
        self,
        other: MotionValue,
        angle: QuantityLike | None = None,
        *,
        azimuth: QuantityLike | None = None,
    ) -> Self:
        """Give the horizontal acceleration in another direction.

        Parameters
        ----------
        other : GroundMotion
            The horizontal component at a right angle to this one, of the same time
            step; the shorter of the two is padded with zeros.
        angle : str or Quantity, optional
            From this component towards the other one [rad].
        azimuth : str or Quantity, optional
            Instead of `angle`: clockwise from north, for components whose
            metadata tell their own ``azimuth`` [rad].

        Returns
        -------
        GroundMotion
            With this motion's vertical component, if it has one.

        Raises
        ------
        UnitsError
            Not an angle.
        ComponentError
            Both or neither of `angle` and `azimuth` given; not a motion, or another time
            step; an azimuth that a component lacks, or components that are not at a right
            angle.

        Notes
        -----
        ``a cos(angle) + a_other sin(angle)``.
        """
        owner, si = f"{type(self).__name__}.rotated", self.si
        theirs = other_motion(other, si, owner).si
        if (angle is None) == (azimuth is None):
            msg = f"{owner}: give either angle or azimuth, for example angle='30 deg'"
            raise ComponentError(msg)
        metadata: dict[str, str | float] = {}
        if azimuth is None:
            turn = to_si(cast("QuantityLike", angle), ANGLE, owner=owner, name="angle")
        else:
            target = to_si(azimuth, ANGLE, owner=owner, name="azimuth")
            turn = self._turn_to(target, other, owner)
            metadata["azimuth"] = math.degrees(target) % 360.0
        count = max(len(self), len(other))
        mine, my_pieces = padded(si.acceleration, si.pieces, count)
        partner, partner_pieces = padded(theirs.acceleration, theirs.pieces, count)
        upwards, vertical_pieces = si.vertical, si.vertical_pieces
        if upwards is not None:
            upwards, vertical_pieces = padded(upwards, vertical_pieces, count)
        along, across = _direction(turn)
        pieces = None
        if my_pieces is not None or partner_pieces is not None:
            pieces = along * _as_pieces(mine, my_pieces)
            pieces += across * _as_pieces(partner, partner_pieces)
        result = MotionSI(
            si.time_step, along * mine + across * partner, upwards, pieces, vertical_pieces
        )
        steps = [
            f"rotated by {math.degrees(turn):.9g} degrees towards {other.name} "
            f"(sha256 {other.sha256[:12]})"
        ]
        for label, motion in (("this", self), ("the other", other)):
            if len(motion) < count:
                steps.append(f"{label} component padded with {count - len(motion)} zeros")
        known = None if other._recipe is None else dict(other._recipe)
        operation = None
        if known is not None:
            operation = {"rotated": {"other": known, "angle": f"{turn!r} {ANGLE.unit}"}}
        metadata["component"] = " and ".join(
            str(motion.metadata.get("component", motion.name)) for motion in (self, other)
        )
        metadata["component"] += f" rotated by {math.degrees(turn):.6g} degrees"
        return self._next(result, *steps, operation=operation, metadata=metadata)

    def _turn_to(self, target: float, other: MotionValue, owner: str) -> float:
        known = [motion.metadata.get("azimuth") for motion in (self, other)]
        degrees = [value for value in known if isinstance(value, int | float)]
        if len(degrees) < len(known):
            msg = f"{owner}: the metadata of both components must tell their azimuth; give angle"
            raise ComponentError(msg)
        own, theirs = degrees
        apart = (theirs - own) % 360.0
        for right, sign in ((90.0, 1.0), (270.0, -1.0)):
            if abs(apart - right) <= _RIGHT_ANGLE_TOLERANCE:
                return sign * (target - math.radians(own))
        msg = f"{owner}: azimuths of {own:.6g} and {theirs:.6g} degrees are not at a right angle"
        raise ComponentError(msg)


def _direction(turn: float) -> tuple[float, float]:
    """Give cosine and sine, exact at the right angles."""
    quarters = turn / (0.5 * math.pi)
    nearest = round(quarters)
    if abs(quarters - nearest) <= _ROUNDING:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[nearest % 4]
    return math.cos(turn), math.sin(turn)


def _as_pieces(samples: Array, pieces: Array | None) -> Array:
    if pieces is not None:
        return pieces
    lines = np.zeros((samples.size - 1, COEFFICIENTS))
    lines[:, 0], lines[:, 1] = samples[:-1], np.diff(samples)
    return lines
