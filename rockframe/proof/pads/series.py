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
from rockframe.proof.pads.law import Contacts, PadBalls, pivot_offset
from rockframe.proof.problem import GroundPiece

MIN_ORDER: Final = 14
MAX_ORDER: Final = 80
ROUND_UP: Final = 1.0 + 1e-9
"""Factor above the rounding error of a sum of products of non-negative doubles."""
_MARGIN: Final = 1.01
"""Factor from the bounds of the polynomials to those that the motion is proved not to reach."""


class StepTooLong(Exception):  # noqa: N818  (a step to be halved, no error)
    """A step that is too long for the series."""


class SeriesNumbers(NamedTuple):
    """Numbers of the block, its pads and its held point, as balls or as bounds."""

    height: Any
    reaches: tuple[Any, Any]  # distances of the left and of the right corner, both positive
    inertia: Any
    stiffness: Any
    damping: Any
    settlement: Any
    pivot_offset: Any  # e, from below the centre of mass to the held point


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


def cauchy_product(a: list[Any], b: list[Any]) -> Any:
    """Return the last coefficient of the product of two series of the same length."""
    return sum(map(mul, a, b[::-1]))


def recursion(
    numbers: SeriesNumbers, contacts: Contacts, small: bool, start: Series,
    ground: tuple[list[Any], ...], h: Any, minus: int, enough: Any,
) -> Series:  # fmt: skip
    """Return series from their first coefficients; `minus` is -1, or 1 for their bounds.

    `enough` is called with the order and the series, and returns whether they are long enough.
    """
    series = start
    rotation, rate, height, speed, sway, sine, cosine = start[:7]
    (up_left, up_right), (by_left, by_right), (on_left, on_right) = start[7:10]
    inertia, arm = start.inertia, start.arm
    normals, alongs = ground
    centre_height, (reach_left, reach_right) = numbers.height, numbers.reaches
    stiff, damped = numbers.stiffness, numbers.damping
    in_flight = contacts.in_flight
    slopes: list[Any] = []  # of the rate
    arms_rate: list[Any] = []
    pushes: list[Any] = []
    levers: tuple[list[Any], list[Any]] = ([], [])
    corners = (
        (0, contacts.left, reach_left, up_left, by_left, on_left),
        (1, contacts.right, minus * reach_right, up_right, by_right, on_right),
    )
    k = 0
    while True:
        cosine_rate = rise = 0
        if small:
            sine_rate = cauchy_product(rotation, rate)
            rise = cauchy_product(rotation, rotation) * centre_height / 2
        else:
            sine_rate, cosine_rate = cauchy_product(sine, rate), cauchy_product(cosine, rate)
        normal = normals[k] if k < len(normals) else 0
        upward, moment = minus * normal, 0
        for i, contact, reach, levels, speeds, forces in corners:
            if small:
                if k:
                    levels.append(height[k] + rise + reach * rotation[k])
                speeds.append(speed[k] + centre_height * sine_rate + reach * rate[k])
            else:
                if k:
                    levels.append(height[k] + minus * centre_height * cosine[k] + reach * sine[k])
                speeds.append(speed[k] + centre_height * sine_rate + reach * cosine_rate)
            if contact == CLEAR:
                continue
            if k or not forces:
                depth = minus * levels[k] + (0 if k else numbers.settlement)
                forces.append(stiff * depth + minus * damped * speeds[k])
            if contact == TOUCHING:
                upward = upward + forces[k]
                if not small:
                    levers[i].append(centre_height * sine[k] + reach * cosine[k])
                    moment = moment + cauchy_product(forces, levers[i])
                else:
                    moment = (
                        moment
                        + centre_height * cauchy_product(forces, rotation)
                        + reach * forces[k]
                    )
        along = alongs[k] if k < len(alongs) else 0
        if in_flight:
            angular_acceleration = 0 * rate[0]
            sway.append(minus * h * along / (k + 1))
        elif small:
            angular_acceleration = (moment + minus * centre_height * along) / inertia[0]
        else:
            if k:
                arm.append(centre_height * cosine[k] + numbers.pivot_offset * sine[k])
                inertia.append(cauchy_product(arm, arm))
            arms_rate.append(numbers.pivot_offset * cosine_rate + minus * centre_height * sine_rate)
            pushes.append(along + cauchy_product(arms_rate, rate))
            angular_acceleration = moment + minus * cauchy_product(arm, pushes)
            if k:
                angular_acceleration = angular_acceleration + minus * sum(
                    map(mul, slopes, inertia[:0:-1])
                )
            angular_acceleration = angular_acceleration / inertia[0]
        slopes.append(angular_acceleration)
        share = h / (k + 1)
        rotation.append(share * rate[k])
        rate.append(share * angular_acceleration)
        height.append(share * speed[k])
        speed.append(share * upward)
        if not small:
            sine.append(share * cosine_rate)
            cosine.append(minus * share * sine_rate)
        k += 1
        if enough(k, series):
            return series


class PadMotion(NamedTuple):
    """A motion from a point over a step h, with bounds of the remainders of its series."""

    h: Ball
    along: Row  # ground acceleration along the base
    series: Series
    left_out: Series  # bounds of the remainders


def enclose_motion(
    pads: PadBalls, contacts: Contacts, ground_piece: GroundPiece, start: Row, h: Ball,
    sizes_of: tuple[float, ...], margin: int,
) -> PadMotion:  # fmt: skip
    """Enclose the motion from a point, :eq:`eq-proof-pads-majorant`.

    The series end where their coefficients, over the typical sizes `sizes_of`, are `margin` bits
    below the precision. Raises `StepTooLong` if the step must be halved.
    """
    offset = pivot_offset(pads, contacts) if not (contacts.in_flight or pads.small) else 0 * h
    numbers = SeriesNumbers(
        pads.height, (pads.left, pads.right), pads.inertia, pads.stiffness, pads.damping,
        pads.rest, offset,
    )  # fmt: skip
    ground = tuple(
        [coefficient * h**k for k, coefficient in enumerate(row)]
        for row in (ground_piece.normal, ground_piece.along)
    )
    least = 2.0 ** -(bits() + margin)
    first, second = least * sizes_of[1], least * sizes_of[3]

    def enough(k: int, so_far: Series) -> bool:
        if k < MIN_ORDER:
            return False
        if k >= MAX_ORDER:
            raise StepTooLong
        fast, sunk = abs(float(so_far.rate[k])), abs(float(so_far.speed[k]))
        return fast < first and sunk < second and abs(float(so_far.rate[k - 1])) < first * 16

    series = recursion(
        numbers,
        contacts,
        pads.small,
        _initial_series(pads, contacts, start, offset),
        ground,
        h,
        -1,
        enough,
    )
    order = len(series.rotation) - 1
    sizes = [_map_corners(_size, row) for row in series]
    # bounds that the motion is to be proved not to reach
    most = [_map_corners(lambda size: size * _MARGIN + 1e-200, size) for size in sizes]
    inertia = series.inertia
    least_inertia = float(inertia[0].lower()) / ROUND_UP
    inertia_change = sum(float(coefficient.abs_upper()) for coefficient in inertia[1:]) * ROUND_UP
    low = (least_inertia - inertia_change * _MARGIN) * 0.999
    if not low > 0:
        raise StepTooLong
    bounds = Series(
        [most[0]], [most[1]], [most[2]], [most[3]], [most[4]], [min(1.0, most[5])], [1.0],
        ([0.0], [0.0]), ([], []), tuple([force] for force in most[9]), [low],
        [float(numbers.height) * ROUND_UP + abs(float(offset)) * ROUND_UP * min(1.0, most[5])],
    )  # fmt: skip
    bounded_numbers = SeriesNumbers(*(_map_corners(_bound, number) for number in numbers))
    grounds = tuple(_taylor_bounds(row) for row in ground)
    counts = [len(row) for row in bounds]
    ended = recursion(
        bounded_numbers, contacts, pads.small, bounds, grounds, _bound(h), 1, lambda k, _: k > order
    )  # fmt: skip
    grown = zip(ended, counts, strict=True)
    left_out = Series(
        *(
            _map_corners(_last_bound, row) if isinstance(row, tuple) or len(row) > count else 0.0
            for row, count in grown
        )
    )
    _confirm_bounds(sizes, most, left_out, inertia_change, least_inertia - low)
    return PadMotion(h, ground[1], series, left_out)


def _taylor_bounds(row: Row) -> list[float]:
    """Bound the Taylor coefficients of a polynomial about all points of the step."""
    sizes = [_bound(coefficient) for coefficient in row]
    return [
        sum(math.comb(j, k) * size for j, size in enumerate(sizes)) * ROUND_UP
        for k in range(len(sizes))
    ]


def _initial_series(pads: PadBalls, contacts: Contacts, start: Row, offset: Ball) -> Series:
    """Return the first coefficients of the series from a state."""
    rotation, rate, height, speed, sway = start
    if pads.small:
        sine, cosine = rotation, rotation * 0 + 1
        rise, arm = rotation * rotation * pads.height / 2, pads.height
    else:
        sine, cosine = rotation.sin(), rotation.cos()
        rise, arm = pads.height * (1 - cosine), pads.height * cosine + offset * sine
    levels = height + rise + pads.left * sine, height + rise - pads.right * sine
    return Series(
        [rotation], [rate], [height], [speed], [sway], [sine], [cosine],
        ([levels[0]], [levels[1]]), ([], []), ([], []), [pads.inertia + arm * arm], [arm],
    )  # fmt: skip


def _map_corners(work: Callable[[Any], float], value: Any) -> Any:
    """Return what a function makes of one thing, or of that of each corner."""
    return tuple(map(work, value)) if isinstance(value, tuple) else work(value)


def _bound(value: Ball) -> float:
    """Bound the absolute value of a ball by a double."""
    return float(abs(value).upper()) * ROUND_UP


def _size(series: Row) -> float:
    """Bound the absolute value of a polynomial over the step."""
    return sum(float(coefficient.abs_upper()) for coefficient in series) * ROUND_UP


def _last_bound(bounds: list[float]) -> float:
    """Return the last coefficient of bounds, rounded upwards."""
    return float(bounds[-1]) * ROUND_UP if bounds else 0.0


def _confirm_bounds(
    sizes: list[Any], most: list[Any], left_out: Series, inertia_change: float, low: float
) -> None:
    """Prove that the motion reaches no bound: then all of them hold; raise TooLong otherwise."""
    firsts = zip(sizes, most, left_out, strict=True)
    pairs = [triple for i, triple in enumerate(firsts) if i in (0, 1, 2, 3, 5)]
    pairs += zip(sizes[9], most[9], left_out.forces, strict=True)
    for size, bound, remainder in pairs:
        if size and not size + remainder < bound:
            raise StepTooLong
    if not inertia_change + left_out.inertia < low:
        raise StepTooLong
