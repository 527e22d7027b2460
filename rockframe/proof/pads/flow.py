"""Sets of states of a block on pads, and their images after a step.

The centre of a set is enclosed by balls. The set about it is so small that its derivatives are
computed in doubles, with bounds of their rounding errors. Lemmas :eq:`eq-proof-pads-variation` and
:eq:`eq-proof-set` of the manual.
"""

import math
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.dynamics.pads import TOUCHING
from rockframe.proof.balls import Row, ball, derivative_of, polynomial_value
from rockframe.proof.pads.law import SIZE, Contacts, Guard, PadBalls, pivot_offset
from rockframe.proof.pads.series import ROUND_UP, PadMotion, StepTooLong

Array = Any
DEGREE: Final = 12
"""Degree of the polynomials for derivatives and guards."""
VARIATION_ORDER: Final = 20
_LOST: Final = 1e-13
"""Bound of the rounding error of a sum of products of doubles, over the sum of their sizes."""
_ROTATION, _RATE, _HEIGHT, _SPEED = range(4)


class Curve:
    """A function of the share of a step, from 0 to 1: a polynomial with a bound of its error."""

    __slots__ = ("coefficients", "error", "size")

    def __init__(self, coefficients: Array, error: float) -> None:
        self.coefficients, self.error = coefficients, error
        self.size = (float(np.abs(coefficients).sum()) + error) * ROUND_UP

    def __add__(self, other: "Curve") -> "Curve":
        """Add another one."""
        error = self.error + other.error + _LOST * (self.size + other.size)
        return Curve(self.coefficients + other.coefficients, error)

    def __neg__(self) -> "Curve":
        """Return the opposite."""
        return Curve(-self.coefficients, self.error)

    def __sub__(self, other: "Curve") -> "Curve":
        """Take another one away."""
        return self + (-other)

    def times(self, factor: float) -> "Curve":
        """Return a multiple."""
        return Curve(
            self.coefficients * factor, abs(factor) * self.error + _LOST * abs(factor) * self.size
        )

    def __mul__(self, other: "Curve") -> "Curve":
        """Multiply, and put terms of too high a degree into the error."""
        product = np.convolve(self.coefficients, other.coefficients)
        cut = float(np.abs(product[DEGREE + 1 :]).sum())
        error = cut + self.size * other.error + other.size * self.error
        return Curve(product[: DEGREE + 1], (error + _LOST * self.size * other.size) * ROUND_UP)

    def inverse(self) -> "Curve":
        """Return the reciprocal; its error follows from the product with it, which should be 1."""
        first = 1.0 / float(self.coefficients[0])
        coefficients = np.zeros(DEGREE + 1)
        coefficients[0] = first
        for k in range(1, DEGREE + 1):
            coefficients[k] = -first * float(
                np.dot(self.coefficients[1 : k + 1], coefficients[k - 1 :: -1][:k])
            )
        guess = Curve(coefficients, 0.0)
        product = self * guess
        product.coefficients[0] -= 1.0
        off = (float(np.abs(product.coefficients).sum()) + product.error) * ROUND_UP
        if not off < 0.5:
            raise StepTooLong
        return Curve(coefficients, guess.size * off / (1.0 - off) * ROUND_UP)


def constant_curve(value: float) -> Curve:
    """Return a constant curve."""
    coefficients = np.zeros(DEGREE + 1)
    coefficients[0] = value
    return Curve(coefficients, abs(value) * _LOST)


def curve(series: Row, error: float) -> Curve:
    """Return the curve of a series, within an error."""
    middles = np.array([float(coefficient) for coefficient in series])
    sizes = sum(float(coefficient.abs_upper()) for coefficient in series[DEGREE + 1 :])
    radii = sum(float(coefficient.rad()) for coefficient in series[: DEGREE + 1])
    if middles.size <= DEGREE:
        middles = np.concatenate([middles, np.zeros(DEGREE + 1 - middles.size)])
    leading = middles[: DEGREE + 1]
    lost = _LOST * float(np.abs(leading).sum())
    return Curve(leading, (error + sizes + radii + lost) * ROUND_UP)


class StateSet(NamedTuple):
    """The states centre + weights * (axes @ r), for all r with abs(r) <= spread."""

    centre: Row
    axes: Array
    spread: Array  # not negative

    def radius(self) -> float:
        """Bound the distance of members from the centre, over the weights, in any coordinate."""
        return float((np.abs(self.axes) @ self.spread).max()) * ROUND_UP

    def radii(self, weights: Array) -> Array:
        """Bound the distance of members from the centre in each coordinate."""
        return weights * (np.abs(self.axes) @ self.spread) * ROUND_UP

    def box(self, weights: Array) -> Row:
        """Enclose the states."""
        radii = self.radii(weights).tolist()
        return [
            component + ball(0, radius)
            for component, radius in zip(self.centre, radii, strict=True)
        ]

    def image(self, image: Row, middle: Array, error: Array, weights: Array) -> "StateSet":
        """Return the image of the set from that of the centre, and the weighted derivative.

        The derivative is `middle`, each element within `error`.
        """
        centre = [component.mid() for component in image]
        away = np.array(
            [
                float((component - mid).abs_upper())
                for component, mid in zip(image, centre, strict=True)
            ]
        )
        away = away / weights * ROUND_UP
        mapped_axes = middle @ self.axes
        sizes = np.abs(middle) @ np.abs(self.axes)
        columns = mapped_axes * (self.spread + 1e-290)
        order = np.argsort(-np.abs(columns).sum(axis=0))
        axes = np.linalg.qr(columns[:, order] / (np.abs(columns).max() + 1e-290))[0]
        back = axes.T
        spread = np.abs(back @ mapped_axes) @ self.spread
        spread = spread + np.abs(back) @ (
            (_LOST * sizes + error @ np.abs(self.axes)) @ self.spread + away
        )
        flaw = float(np.abs(back @ axes - np.eye(SIZE)).sum(axis=1).max()) + _LOST
        if not flaw < 1e-10:
            raise StepTooLong
        spread = (spread + 2.0 * flaw * spread.max()) * ROUND_UP
        return StateSet(centre, axes, spread)


def single_state(start: Sequence[float]) -> StateSet:
    """Return the set of one state."""
    return StateSet([ball(component) for component in start], np.eye(SIZE), np.zeros(SIZE))


class Step(NamedTuple):
    """A step of a set."""

    course: PadMotion
    powers: Array  # weighted derivative by the start, coefficients of powers of the share
    error: Array  # bound of the error of that derivative in the step
    rate: float  # bound of the norm of the weighted derivative of the field, times h
    curves: dict[Guard, tuple[Curve, Curve]]  # guards and their derivatives by the share

    def image(self, share: Any) -> Row:
        """Enclose the centre at a share of the step."""
        pairs = zip(self.course.series[:SIZE], self.course.left_out[:SIZE], strict=True)
        return [polynomial_value(series, share) + ball(0, remainder) for series, remainder in pairs]

    def derivative(self, share: float) -> Array:
        """Return the weighted derivative by the start at a share of the step, without its error."""
        total = self.powers[-1]
        for power in self.powers[-2::-1]:
            total = total * share + power
        return total


def enclose_step(
    pads: PadBalls, contacts: Contacts, course: PadMotion, states: StateSet, weights: Array,
    guards: list[Guard],
) -> Step:  # fmt: skip
    """Enclose the image of a set in a step, :eq:`eq-proof-pads-variation`.

    Raises `StepTooLong` if the step must be halved.
    """
    h = float(course.h)
    radius = states.radius()
    tube = 4.0 * radius
    for _ in range(8):
        motion = _motion(pads, course, tube * weights)
        stiff = _stiffness(pads, contacts, motion)
        matrix, error = _weighted(stiff, h, weights)
        rate = float((np.abs(matrix).sum(axis=0) + error).sum(axis=1).max()) * ROUND_UP
        if not rate < 20.0:
            raise StepTooLong
        growth = math.exp(rate) * ROUND_UP
        if growth * radius <= tube:
            break
        tube = 1.5 * growth * radius
    else:
        raise StepTooLong
    powers, defect = _variation(matrix, error)
    off = np.tile((defect.max(axis=0) + _LOST * rate) * growth * ROUND_UP, (SIZE, 1))
    curves = {
        guard: _guard(pads, contacts, guard, course, motion, (tube, rate), weights)
        for guard in guards
    }
    return Step(course, powers, off, rate, curves)


class _Motion(NamedTuple):
    """The motion of all members of a set, as curves."""

    rate: Curve
    sine: Curve
    cosine: Curve
    forces: tuple[Curve | None, Curve | None]  # of the left and of the right pad
    along: Curve  # ground acceleration along the base
    deviations: Array  # bounds of the distances of members from the centre, in each coordinate


def _motion(pads: PadBalls, course: PadMotion, deviations: Array) -> _Motion:
    series, remainder = course.series, course.left_out
    centre_height, wide = float(pads.height), float(pads.left) + float(pads.right)
    d_rotation, d_rate = float(deviations[_ROTATION]), float(deviations[_RATE])
    rate = curve(series.rate, remainder.rate + d_rate)
    if pads.small:
        sine, cosine = curve(series.rotation, remainder.rotation + d_rotation), constant_curve(1.0)
    else:
        sine = curve(series.sine, remainder.sine + d_rotation)
        cosine = curve(series.cosine, remainder.cosine + d_rotation)
    reach = centre_height * (1.0 if not pads.small else sine.size) + wide
    level = float(deviations[_HEIGHT]) + reach * d_rotation
    speed = (
        float(deviations[_SPEED]) + reach * d_rate + (centre_height + wide) * rate.size * d_rotation
    )
    away = (float(pads.stiffness) * level + float(pads.damping) * speed) * ROUND_UP
    left, right = (
        curve(force, left_out + away) if force else None
        for force, left_out in zip(series.forces, remainder.forces, strict=True)
    )
    return _Motion(rate, sine, cosine, (left, right), curve(course.along, 0.0), deviations)


def _stiffness(pads: PadBalls, contacts: Contacts, motion: _Motion) -> dict[tuple[int, int], Curve]:
    """Return the derivatives of both accelerations by the state, by row and column."""
    if contacts.in_flight:
        return {}
    centre_height, stiff, damped = float(pads.height), float(pads.stiffness), float(pads.damping)
    rate, sine, cosine = motion.rate, motion.sine, motion.cosine
    none = constant_curve(0.0)
    upward, moment = [none] * 4, [none] * 4
    load = none
    for left in (True, False):
        if contacts.of(left) != TOUCHING:
            continue
        reach = float(pads.left) if left else -float(pads.right)
        force = motion.forces[not left]
        assert force is not None  # noqa: S101
        lever = sine.times(centre_height) + cosine.times(reach)
        lever_slope = (
            constant_curve(centre_height)
            if pads.small
            else cosine.times(centre_height) - sine.times(reach)
        )
        by_rotation = (lever.times(stiff) + (lever_slope * rate).times(damped)).times(-1.0)
        by = [by_rotation, lever.times(-damped), constant_curve(-stiff), constant_curve(-damped)]
        upward = [a + b for a, b in zip(upward, by, strict=True)]
        by_moment = [
            lever * by_rotation + force * lever_slope,
            *(lever * slope for slope in by[1:]),
        ]
        moment = [a + b for a, b in zip(moment, by_moment, strict=True)]
        load = load + force * lever
    if pads.small:
        inverse = constant_curve(1.0 / (float(pads.inertia) + centre_height * centre_height))
    else:
        offset = float(pivot_offset(pads, contacts))
        arm = cosine.times(centre_height) + sine.times(offset)
        lever_slope = cosine.times(offset) - sine.times(centre_height)
        square = arm * arm
        inverse = (constant_curve(float(pads.inertia)) + square).inverse()
        spin, arm_slope = rate * rate, arm * lever_slope
        push = motion.along + lever_slope * spin
        angular_acceleration = (load - arm * push) * inverse
        moment[_ROTATION] = (
            moment[_ROTATION]
            - lever_slope * push
            + square * spin
            - (arm_slope * angular_acceleration).times(2.0)
        )
        moment[_RATE] = moment[_RATE] - (arm_slope * rate).times(2.0)
    stiffness = {(_SPEED, j): slope for j, slope in enumerate(upward)}
    stiffness.update({(_RATE, j): slope * inverse for j, slope in enumerate(moment)})
    return stiffness


def _weighted(stiff: dict[tuple[int, int], Curve], h: float, weights: Array) -> tuple[Array, Array]:
    """Return the coefficients of the weighted derivative of the field times h, and their errors."""
    matrix, error = np.zeros((DEGREE + 1, SIZE, SIZE)), np.zeros((SIZE, SIZE))
    for (i, j), slope in stiff.items():
        factor = h * weights[j] / weights[i]
        matrix[:, i, j] = slope.coefficients * factor
        error[i, j] = (slope.error + _LOST * slope.size) * factor * ROUND_UP
    for i, j in ((_ROTATION, _RATE), (_HEIGHT, _SPEED)):
        matrix[0, i, j] = h * weights[j] / weights[i]
        error[i, j] = _LOST * matrix[0, i, j]
    return matrix, error


def _variation(matrix: Array, error: Array) -> tuple[Array, Array]:
    """Return a polynomial for the derivative by the start, and its residual in its equation."""
    powers = np.zeros((VARIATION_ORDER + 1, SIZE, SIZE))
    powers[0] = np.eye(SIZE)
    size, sums = np.abs(matrix), np.zeros((SIZE, SIZE))
    for k in range(VARIATION_ORDER):
        count = min(k, DEGREE) + 1
        powers[k + 1] = (matrix[:count] @ powers[k - np.arange(count)]).sum(axis=0) / (k + 1)
        sums += (size[:count] @ np.abs(powers[k - np.arange(count)])).sum(axis=0)
    total = np.abs(powers).sum(axis=0)
    every = size.sum(axis=0) @ total
    cut = np.maximum(every - sums, 0.0)
    return powers, (cut + 10.0 * _LOST * every + error @ total) * ROUND_UP


def _guard(
    pads: PadBalls, contacts: Contacts, guard: Guard, course: PadMotion, motion: _Motion,
    bounds: tuple[float, float], weights: Array,
) -> tuple[Curve, Curve]:  # fmt: skip
    """Return a guard and its derivative by the share, as curves."""
    tube, rate = bounds
    h = float(course.h)
    d_rotation, d_rate, d_height, d_speed = (
        float(deviation) for deviation in motion.deviations[:4]
    )
    series, remainder = course.series, course.left_out
    if guard.kind == "limit":
        limit = float(pads.limits[not guard.left])
        angle = curve(series.rotation, remainder.rotation + d_rotation)
        angle = angle if guard.left else -angle
        value = constant_curve(limit) + angle
        change = curve(series.rate, remainder.rate + d_rate).times(h if guard.left else -h)
        return value, change
    i = int(not guard.left)
    centre_height, wide = float(pads.height), float(pads.left) + float(pads.right)
    spin = motion.rate.size
    reach = (centre_height * motion.sine.size + wide) * ROUND_UP
    level_away = d_height + reach * d_rotation + remainder.levels[i]
    speed_away = (
        d_speed + reach * d_rate + (centre_height + wide) * spin * d_rotation + remainder.speeds[i]
    )
    speed = curve(series.speeds[i], speed_away)
    if guard.kind in ("depth", "gap"):
        level = curve(series.levels[i], level_away) - constant_curve(float(pads.rest))
        sign = 1.0 if guard.kind == "gap" else -1.0
        return level.times(sign), speed.times(sign * h)
    # accelerations of members differ by no more than the rate of change of their distances
    angular_away, falling_away = (float(rate * tube * weights[j] / h) for j in (_RATE, _SPEED))
    order = len(series.speeds[i])
    sizes = (k * float(coefficient.abs_upper()) for k, coefficient in enumerate(series.rate))
    angular_acceleration = (
        angular_away + ROUND_UP * (sum(sizes) + len(series.rate) * remainder.rate) / h
    )
    away = (
        falling_away
        + reach * angular_away
        + (centre_height + wide)
        * (d_rotation * (angular_acceleration + spin * spin) + 2.0 * spin * d_rate)
    )
    slope = curve(
        derivative_of(series.speeds[i]), (order * remainder.speeds[i] + away * h) * ROUND_UP
    )
    if guard.kind == "rise":
        return speed, slope
    stiff, damped = float(pads.stiffness), float(pads.damping)
    force = motion.forces[i]
    assert force is not None  # noqa: S101
    change = speed.times(-stiff * h) - slope.times(damped)
    if guard.kind == "slack":
        return -force, -change
    return force, change
