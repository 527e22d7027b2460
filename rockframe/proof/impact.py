"""Impacts of a whole set of states, and the endless series of small ones, as balls."""

import math
from typing import Final, NamedTuple

from flint import arb

from rockframe.proof.flow import ONE, UNIT, StateSet
from rockframe.proof.problem import (
    ZERO,
    Ball,
    BearingCorner,
    Problem,
    Undecided,
    acceleration,
    fastest,
)

SMALL: Final = 1e-3
"""Rates over those of the block at which it is tried to prove that it comes to rest."""
WINDOWS: Final = (1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 5e-3, 2e-2, 5e-2)
"""Times within which the block is tried to be at rest [s]."""


class Reset(NamedTuple):
    """An impact of a box of states: the image, and what its derivative is made of."""

    image: tuple[Ball, Ball]
    delay: Ball
    before: Ball  # rate at the impact
    accelerations: tuple[Ball, Ball]
    stiffness: Ball


def _reset(problem: Problem, side: BearingCorner, k: int, time: Ball, box: list[Ball]) -> Reset:
    """Enclose the image of a box whose members cross zero near one time, :eq:`eq-proof-impact`."""
    other = problem.side(-side.sign)
    if not box[1] * side.sign < 0:
        msg = "an impact that hardly touches the ground"
        raise Undecided(msg)
    reach = float(box[0].abs_upper()) / float(box[1].abs_lower()) * 1.5 + 1e-33
    window = arb(0, reach)
    ground = problem.over(k, time - reach, time + reach)
    most = arb(0, fastest(side, ground).union(fastest(other, ground)).upper())
    rates = box[1] + most * window
    force = acceleration(side, ground, box[0] + window * rates)
    delay = -box[0] / rates
    if not window.contains(delay):
        msg = "the time of an impact is not enclosed"
        raise Undecided(msg)
    before = box[1] + force * delay
    after = other.restitution * before
    back = acceleration(other, ground, -(after + most * window) * window)
    image = (-after * delay + back * delay * delay / 2, after - back * delay)
    return Reset(image, delay, before, (force, back), most)


def impact(problem: Problem, side: BearingCorner, k: int, time: Ball, states: StateSet) -> StateSet:
    """Give the states after the impact of each, as though all had met the ground at one time.

    Raises
    ------
    Undecided
        Not every member is proved to meet the ground once.
    """
    e = problem.side(-side.sign).restitution
    centre = _reset(problem, side, k, time, states.centre)
    whole = _reset(problem, side, k, time, states.box())
    first, second = whole.accelerations
    jump = [[e, ZERO], [(second - e * first) / whole.before, e]]
    growth = float(whole.stiffness.abs_upper()) + 1.0
    swing = arb(0, math.expm1(growth * float(whole.delay.abs_upper())) * 1.000001 + 1e-300)
    near = [[ONE + swing, swing], [swing, ONE + swing]]
    return states.mapped(centre.image, _times(near, _times(jump, near)))


def _times(a: list[list[Ball]], b: list[list[Ball]]) -> list[list[Ball]]:
    return [[a[i][0] * b[0][j] + a[i][1] * b[1][j] for j in (0, 1)] for i in (0, 1)]


def rest_within(problem: Problem, k: int, time: Ball, box: list[Ball]) -> Ball | None:
    """Give a time in which the block is proved to come to rest, :eq:`eq-proof-rest`; None if not.

    Its rotation is near zero, on either side; `time` is counted from a knot.
    """
    sides = problem.right, problem.left
    for length in WINDOWS:
        ground = problem.over(k, time, time + length)
        pulls = [acceleration(one, ground, ZERO) * -one.sign for one in sides]
        if not all(one > 0 for one in pulls):
            return None
        least = arb(min(float(one.lower()) for one in pulls)) / 2
        height = arb(box[0].abs_upper())
        speed = arb(box[1].abs_upper())
        rise = (height + speed * speed / least) * 4
        lean = rise * UNIT
        within = [acceleration(one, ground, one.sign * lean) * -one.sign for one in sides]
        low, high = within[0].union(within[1]).lower(), within[0].union(within[1]).upper()
        if not low >= least:
            continue
        up = height + speed * speed / (2 * low)
        arriving = (2 * high * up).sqrt()
        first = speed / low + (2 * up / low).sqrt()
        spare = max(
            float(one.restitution.abs_upper()) * math.sqrt(float((w.upper() / w.lower()).upper()))
            for one, w in zip(sides, within, strict=True)
        )
        ratio = arb(spare * 1.000001)
        kept = arriving * arb(max(float(one.restitution.abs_upper()) for one in sides)) * 1.000001
        if not (ratio < 1 and kept * kept / (2 * low) < rise and up < rise):
            continue
        total = first + 2 * kept / low / (1 - ratio)
        if total < length:
            return arb(total.upper())
    return None
