"""Taylor's series of a block on pads over a step, with bounds of the remainders.

One recursion gives the coefficients and, with all signs positive, their bounds: lemma
:eq:`eq-proof-pads-majorant` of the manual.
"""

import math
from collections.abc import Callable
from operator import mul
from typing import Any, Final, NamedTuple

from rockframe.dynamics.pads import CLEAR, TOUCHING
from rockframe.proof.balls import Ball, Row, bits
from rockframe.proof.pads.law import PadBalls, Standing, pin
from rockframe.proof.problem import GroundPiece

LOWEST: Final = 14
HIGHEST: Final = 80
UPWARDS: Final = 1.0 + 1e-9
"""Factor above the rounding error of a sum of products of non-negative doubles."""
_ROOM: Final = 1.01
"""Factor from the bounds of the polynomials to those that the motion is proved not to reach."""


class TooLong(Exception):  # noqa: N818  (a step to be halved, no error)
    """A step that is too long for the series."""


class SeriesNumbers(NamedTuple):
    """Numbers of the block, its pads and its held point, as balls or as bounds."""

    height: Any
    reaches: tuple[Any, Any]  # distances of the left and of the right corner, both positive
    inertia: Any
    stiffness: Any
    damping: Any
    settlements: tuple[Any, Any]
    pin: Any  # e, from below the centre of mass to the held point


class Series(NamedTuple):
    """Lists of coefficients of powers of the share of a step; or a bound for each list."""

    rotation: Any
    rate: Any
    height: Any
    speed: Any
    sway: Any  # horizontal velocity of a block that flies
    sine: Any
    cosine: Any
    levels: Any  # heights of both corners
    speeds: Any
    forces: Any  # forces of both pads, if they touched
    inertia: Any  # I_O/m + x'^2
    arm: Any  # x'


def product(a: list[Any], b: list[Any]) -> Any:
    """Return the last coefficient of the product of two series of the same length."""
    return sum(map(mul, a, b[::-1]))


def recursion(
    shape: SeriesNumbers, standing: Standing, small: bool, start: Series,
    ground: tuple[list[Any], ...], h: Any, minus: int, enough: Any,
) -> Series:  # fmt: skip
    """Return series from their first coefficients; `minus` is -1, or 1 for their bounds.

    `enough` is called with the order and the series, and returns whether they are long enough.
    """
    found = start
    rotation, rate, height, speed, sway, sine, cosine = start[:7]
    (up_left, up_right), (by_left, by_right), (on_left, on_right) = start[7:10]
    inertia, arm = start.inertia, start.arm
    weights, alongs = ground
    tall, (reach_left, reach_right) = shape.height, shape.reaches
    stiff, damped = shape.stiffness, shape.damping
    free = standing.flies
    slopes: list[Any] = []  # of the rate
    arms_rate: list[Any] = []
    pushes: list[Any] = []
    levers: tuple[list[Any], list[Any]] = ([], [])
    corners = (
        (0, standing.left, reach_left, up_left, by_left, on_left),
        (1, standing.right, minus * reach_right, up_right, by_right, on_right),
    )
    k = 0
    while True:
        kept = risen = 0
        if small:
            turned = product(rotation, rate)
            risen = product(rotation, rotation) * tall / 2
        else:
            turned, kept = product(sine, rate), product(cosine, rate)
        weight = weights[k] if k < len(weights) else 0
        upward, moment = minus * weight, 0
        for i, contact, reach, levels, speeds, forces in corners:
            if small:
                if k:
                    levels.append(height[k] + risen + reach * rotation[k])
                speeds.append(speed[k] + tall * turned + reach * rate[k])
            else:
                if k:
                    levels.append(height[k] + minus * tall * cosine[k] + reach * sine[k])
                speeds.append(speed[k] + tall * turned + reach * kept)
            if contact == CLEAR:
                continue
            if k or not forces:
                depth = minus * levels[k] + (0 if k else shape.settlements[i])
                forces.append(stiff * depth + minus * damped * speeds[k])
            if contact == TOUCHING:
                upward = upward + forces[k]
                if not small:
                    levers[i].append(tall * sine[k] + reach * cosine[k])
                    moment = moment + product(forces, levers[i])
                else:
                    moment = moment + tall * product(forces, rotation) + reach * forces[k]
        along = alongs[k] if k < len(alongs) else 0
        if free:
            turning = 0 * rate[0]
            sway.append(minus * h * along / (k + 1))
        elif small:
            turning = (moment + minus * tall * along) / inertia[0]
        else:
            if k:
                arm.append(tall * cosine[k] + shape.pin * sine[k])
                inertia.append(product(arm, arm))
            arms_rate.append(shape.pin * kept + minus * tall * turned)
            pushes.append(along + product(arms_rate, rate))
            turning = moment + minus * product(arm, pushes)
            if k:
                turning = turning + minus * sum(map(mul, slopes, inertia[:0:-1]))
            turning = turning / inertia[0]
        slopes.append(turning)
        share = h / (k + 1)
        rotation.append(share * rate[k])
        rate.append(share * turning)
        height.append(share * speed[k])
        speed.append(share * upward)
        if not small:
            sine.append(share * kept)
            cosine.append(minus * share * turned)
        k += 1
        if enough(k, found):
            return found


class PadCourse(NamedTuple):
    """A motion from a point over a step h, with bounds of the remainders of its series."""

    h: Ball
    along: Row  # ground acceleration along the base
    series: Series
    left_out: Series  # bounds of the remainders


def course(
    pads: PadBalls, standing: Standing, shaking: GroundPiece, start: Row, h: Ball,
    sizes_of: tuple[float, ...], margin: int,
) -> PadCourse:  # fmt: skip
    """Enclose the motion from a point, :eq:`eq-proof-pads-majorant`.

    The series end where their coefficients, over the typical sizes `sizes_of`, are `margin` bits
    below the precision. Raises `TooLong` if the step must be halved.
    """
    held = pin(pads, standing) if not (standing.flies or pads.small) else 0 * h
    shape = SeriesNumbers(
        pads.height, (pads.left, pads.right), pads.inertia, pads.stiffness, pads.damping,
        pads.settlements, held,
    )  # fmt: skip
    ground = tuple(
        [one * h**k for k, one in enumerate(row)] for row in (shaking.weight, shaking.along)
    )
    least = 2.0 ** -(bits() + margin)
    first, second = least * sizes_of[1], least * sizes_of[3]

    def enough(k: int, so_far: Series) -> bool:
        if k < LOWEST:
            return False
        if k >= HIGHEST:
            raise TooLong
        fast, sunk = abs(float(so_far.rate[k])), abs(float(so_far.speed[k]))
        return fast < first and sunk < second and abs(float(so_far.rate[k - 1])) < first * 16

    found = recursion(
        shape, standing, pads.small, _first(pads, standing, start, held), ground, h, -1, enough
    )
    order = len(found.rotation) - 1
    sizes = [_in_each(_size, one) for one in found]
    # bounds that the motion is to be proved not to reach
    most = [_in_each(lambda size: size * _ROOM + 1e-200, size) for size in sizes]
    inertia = found.inertia
    least_inertia = float(inertia[0].lower()) / UPWARDS
    swing = sum(float(one.abs_upper()) for one in inertia[1:]) * UPWARDS
    low = (least_inertia - swing * _ROOM) * 0.999
    if not low > 0:
        raise TooLong
    bounds = Series(
        [most[0]], [most[1]], [most[2]], [most[3]], [most[4]], [min(1.0, most[5])], [1.0],
        ([0.0], [0.0]), ([], []), tuple([one] for one in most[9]), [low],
        [float(shape.height) * UPWARDS + abs(float(held)) * UPWARDS * min(1.0, most[5])],
    )  # fmt: skip
    upper = SeriesNumbers(*(_in_each(_bound, one) for one in shape))
    grounds = tuple(_anywhere(row) for row in ground)
    counts = [len(one) for one in bounds]
    ended = recursion(
        upper, standing, pads.small, bounds, grounds, _bound(h), 1, lambda k, _: k > order
    )  # fmt: skip
    grown = zip(ended, counts, strict=True)
    left_out = Series(
        *(
            _in_each(_last, one) if isinstance(one, tuple) or len(one) > count else 0.0
            for one, count in grown
        )
    )
    _confirm_bounds(sizes, most, left_out, swing, least_inertia - low)
    return PadCourse(h, ground[1], found, left_out)


def _anywhere(row: Row) -> list[float]:
    """Bound the Taylor coefficients of a polynomial about all points of the step."""
    sizes = [_bound(one) for one in row]
    return [
        sum(math.comb(j, k) * one for j, one in enumerate(sizes)) * UPWARDS
        for k in range(len(sizes))
    ]


def _first(pads: PadBalls, standing: Standing, start: Row, held: Ball) -> Series:
    """Return the first coefficients of the series from a state."""
    rotation, rate, height, speed, sway = start
    if pads.small:
        sine, cosine = rotation, rotation * 0 + 1
        rise, arm = rotation * rotation * pads.height / 2, pads.height
    else:
        sine, cosine = rotation.sin(), rotation.cos()
        rise, arm = pads.height * (1 - cosine), pads.height * cosine + held * sine
    levels = height + rise + pads.left * sine, height + rise - pads.right * sine
    return Series(
        [rotation], [rate], [height], [speed], [sway], [sine], [cosine],
        ([levels[0]], [levels[1]]), ([], []), ([], []), [pads.inertia + arm * arm], [arm],
    )  # fmt: skip


def _in_each(work: Callable[[Any], float], one: Any) -> Any:
    """Return what a function makes of one thing, or of that of each corner."""
    return tuple(map(work, one)) if isinstance(one, tuple) else work(one)


def _bound(one: Ball) -> float:
    """Bound the absolute value of a ball by a double."""
    return float(abs(one).upper()) * UPWARDS


def _size(series: Row) -> float:
    """Bound the absolute value of a polynomial over the step."""
    return sum(float(each.abs_upper()) for each in series) * UPWARDS


def _last(bounds: list[float]) -> float:
    """Return the last coefficient of bounds, rounded upwards."""
    return float(bounds[-1]) * UPWARDS if bounds else 0.0


def _confirm_bounds(
    sizes: list[Any], most: list[Any], left_out: Series, swing: float, low: float
) -> None:
    """Prove that the motion reaches no bound: then all of them hold; raise TooLong otherwise."""
    firsts = zip(sizes, most, left_out, strict=True)
    pairs = [one for i, one in enumerate(firsts) if i in (0, 1, 2, 3, 5)]
    pairs += zip(sizes[9], most[9], left_out.forces, strict=True)
    for size, bound, rest in pairs:
        if size and not size + rest < bound:
            raise TooLong
    if not swing + left_out.inertia < low:
        raise TooLong
