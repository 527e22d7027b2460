"""Combination of the components of ground motions."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Final, cast

import numpy as np

from rockframe.errors import ComponentError, RecordWarning, warn
from rockframe.motion.display import display_name
from rockframe.motion.operations.derived import (
    VERTICAL_PREFIX,
    checked_other_motion,
    cleared_vertical_metadata,
    derived_motion,
    warn_of_other_start,
)
from rockframe.motion.operations.scaling import scaled_signal
from rockframe.motion.processing.samples import padded
from rockframe.motion.value import MotionType, MotionValue
from rockframe.records import DOWNWARDS, SENSE, UPWARDS
from rockframe.records import VERTICAL as EITHER
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import Array
from rockframe.signals.motion import COEFFICIENTS, VERTICAL
from rockframe.suggestions import with_hints
from rockframe.units import ANGLE, QuantityLike, degrees_text, to_si

_RIGHT_ANGLE_TOLERANCE: Final = 1.0  # degree; agencies round azimuths to whole degrees
_ROUNDING: Final = 1e-15


@with_hints()
def with_vertical(motion: MotionType, other: MotionValue | None) -> MotionType:
    """Add a vertical component: the horizontal component of another motion, positive upwards.

    Parameters
    ----------
    other : GroundMotion or None
        Motion of the same time step; the shorter of the two is padded with zeros, to the first of
        which a straight line leads from the last sample of a record. If its file calls it
        positive downwards (``metadata["positive"]``, as for a component ``DWN``), its sign is
        reversed. None removes the vertical component.

    Returns
    -------
    GroundMotion
        Its vertical acceleration is positive upwards.

    Raises
    ------
    ComponentError
        Not a motion, or another time step.

    Warns
    -----
    RecordWarning
        The file of `other` does not state whether it is positive upwards or downwards; or the
        files state different starts.

    Examples
    --------
    >>> import rockframe as rf
    >>> across, up = (rf.GroundMotion.sine_pulse(f"{a} m/s^2", "2 Hz") for a in (3, 1))
    >>> print(across.with_vertical(up).vertical_acceleration.max().round(3))
    1.0 meter / second ** 2
    >>> across.with_vertical(up).with_vertical(None).sha256 == across.sha256
    True
    """
    owner, si = f"{type(motion).__name__}.with_vertical", motion.si
    if other is None:
        if si.vertical is None:
            return motion
        return derived_motion(
            motion, Motion(si.horizontal, None), "vertical component left out",
            operation={"with_vertical": {"other": None}},
            metadata=cleared_vertical_metadata(motion),
            same_spectrum=True,
        )  # fmt: skip
    theirs = checked_other_motion(other, si, owner).si
    warn_of_other_start(motion, other, owner)
    count = max(len(motion), len(other))
    upwards = replace(padded(theirs.horizontal, count), time_step=si.time_step, name=VERTICAL)
    verb = "vertical component" if si.vertical is None else "vertical component replaced:"
    steps = [f"{verb} {_identity(other)}"]
    sense = other.metadata.get(SENSE)
    if sense == DOWNWARDS:
        upwards = scaled_signal(upwards, -1.0)
        named = other.metadata.get("component", other.name)
        steps.append(f"component {named} turned over: positive upwards")
    elif sense == EITHER:
        words = (
            f"{owner}: the file of {other.name} does not say whether it is positive upwards or "
            "downwards; upwards is assumed"
        )
        warn(words, RecordWarning)
    for label, component in (("horizontal", motion), ("vertical", other)):
        if len(component) < count:
            steps.append(f"{label} component padded with {count - len(component)} zeros")
    result = Motion(padded(si.horizontal, count), upwards)
    added: dict[str, Any] = cleared_vertical_metadata(motion)
    added |= {
        f"{VERTICAL_PREFIX}{key}": value
        for key, value in other.metadata.items()
        if not key.startswith(VERTICAL_PREFIX)
    }
    if sense is not None:
        added[f"{VERTICAL_PREFIX}{SENSE}"] = UPWARDS
    known = None if other.recipe is None else dict(other.recipe)
    operation = None if known is None else {"with_vertical": {"other": known}}
    return derived_motion(
        motion, result, *steps, operation=operation, metadata=added, same_spectrum=True
    )


@with_hints()
def rotated(
    motion: MotionType,
    other: MotionValue,
    angle: QuantityLike | None = None,
    *,
    azimuth: QuantityLike | None = None,
) -> MotionType:
    """Compute the horizontal acceleration in another direction.

    Parameters
    ----------
    other : GroundMotion
        The horizontal component at a right angle to this one, of the same time step; the shorter
        of the two is padded with zeros, to the first of which a straight line leads from the last
        sample of a record.
    angle : str or Quantity, optional
        Angle from this component towards the other one [rad].
    azimuth : str or Quantity, optional
        Azimuth instead of `angle`, clockwise from north, for components with an ``azimuth`` in
        their metadata [rad].

    Returns
    -------
    GroundMotion
        With the vertical component of this motion, if it has one.

    Raises
    ------
    UnitsError
        Not an angle.
    ComponentError
        Both or neither of `angle` and `azimuth` given; not a motion, or another time step;
        `azimuth` given, but missing in the metadata of a component; or components that are not
        at a right angle.

    Warns
    -----
    RecordWarning
        The files state different starts.

    Notes
    -----
    ``a cos(angle) + a_other sin(angle)``.

    Examples
    --------
    >>> import rockframe as rf
    >>> north, east = (rf.GroundMotion.sine_pulse(f"{a} m/s^2", "2 Hz") for a in (3, 4))
    >>> print(north.rotated(east, "53.1301 deg").peak_acceleration.round(3))
    5.0 meter / second ** 2
    """
    owner, si = f"{type(motion).__name__}.rotated", motion.si
    theirs = checked_other_motion(other, si, owner).si
    if (angle is None) == (azimuth is None):
        msg = f"{owner}: give either angle or azimuth, for example angle='30 deg'"
        raise ComponentError(msg)
    warn_of_other_start(motion, other, owner)
    own, clockwise = _azimuths(motion, other, owner)
    metadata: dict[str, str | float | None] = {}
    if azimuth is None:
        turn = to_si(cast("QuantityLike", angle), ANGLE, owner=owner, name="angle")
        target = math.radians(own) + clockwise * turn
    else:
        target = to_si(azimuth, ANGLE, owner=owner, name="azimuth")
        if math.isnan(own):
            msg = f"{owner}: the metadata of both components must have an azimuth; give angle"
            raise ComponentError(msg)
        turn = clockwise * (target - math.radians(own))
    metadata["azimuth"] = None if math.isnan(own) else math.degrees(target) % 360.0
    count = max(len(motion), len(other))
    mine, partner = padded(si.horizontal, count), padded(theirs.horizontal, count)
    along, across = _direction(turn)
    pieces = None
    if mine.analytic or partner.analytic:
        pieces = along * _polynomials(mine)
        pieces += across * _polynomials(partner)
    turned = Signal(si.time_step, along * mine.samples + across * partner.samples, pieces)
    result = Motion(turned, None if si.vertical is None else padded(si.vertical, count))
    steps = [f"rotated by {degrees_text(turn, 9)} towards {_identity(other)}"]
    for label, component in (("this", motion), ("the other", other)):
        if len(component) < count:
            steps.append(f"{label} component padded with {count - len(component)} zeros")
    if _scale(motion) != _scale(other):  # no factor is that of both
        metadata["scale_factor"] = None
    known = None if other.recipe is None else dict(other.recipe)
    operation = None
    if known is not None:
        operation = {"rotated": {"other": known, "angle": f"{turn!r} {ANGLE.unit}"}}
    metadata["component"] = " and ".join(
        str(component.metadata.get("component", component.name)) for component in (motion, other)
    )
    metadata["component"] += f" rotated by {degrees_text(turn, 6)}"
    return derived_motion(motion, result, *steps, operation=operation, metadata=metadata)


def _identity(other: MotionValue) -> str:
    """Name the other motion, what was done to it, and its digest."""
    return f"{display_name(other.name, other.history)} (sha256 {other.sha256[:12]})"


def _scale(motion: MotionValue) -> float:
    """Return the absolute product of all scalings [1]."""
    factor = motion.metadata.get("scale_factor")
    return abs(factor) if isinstance(factor, int | float) else 1.0


def _azimuths(motion: MotionValue, other: MotionValue, owner: str) -> tuple[float, float]:
    """Return the azimuth [degree], and 1 if the other component is clockwise from it, else -1.

    The azimuth is NaN if that of a component is not known.
    """
    azimuths = [component.metadata.get("azimuth") for component in (motion, other)]
    degrees = [float(value) for value in azimuths if isinstance(value, int | float)]
    if len(degrees) < len(azimuths):
        return math.nan, 1.0
    own, theirs = degrees
    apart = (theirs - own) % 360.0
    for right, sign in ((90.0, 1.0), (270.0, -1.0)):
        if abs(apart - right) <= _RIGHT_ANGLE_TOLERANCE:
            return own, sign
    msg = f"{owner}: azimuths of {own:.6g}° and {theirs:.6g}° are not at a right angle"
    raise ComponentError(msg)


def _direction(turn: float) -> tuple[float, float]:
    """Return cosine and sine, exact at multiples of a right angle."""
    quarters = turn / (0.5 * math.pi)
    nearest = round(quarters)
    if abs(quarters - nearest) <= _ROUNDING:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[nearest % 4]
    return math.cos(turn), math.sin(turn)


def _polynomials(signal: Signal) -> Array:
    polynomials = np.zeros((signal.samples.size - 1, COEFFICIENTS))
    polynomials[:, : signal.pieces.shape[1]] = signal.pieces
    return polynomials
