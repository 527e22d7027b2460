"""From the start of a motion to a verdict, by enclosures alone."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from flint import arb

from rockframe.proof.flow import (
    Course,
    StateSet,
    TooLong,
    course,
    narrow,
    point,
    stepped,
)
from rockframe.proof.impact import SMALL, impact, rest_within
from rockframe.proof.problem import ZERO, Ball, BearingCorner, Line, Problem, Undecided

STILL_STEPS: Final = 20_000
"""Steps after the motion beyond which nothing is decided."""
MOST_IMPACTS: Final = 20_000
_HALVINGS: Final = 40
_PLACES: Final = np.linspace(0.0, 1.0, 41)[1:]

Watch = Callable[[int, int, list[Ball]], None]
"""Is told the number of a knot, the side (0 at rest) and the enclosure there."""


@dataclass
class March:
    """The way through a motion; what is found stands in its fields.

    Parameters
    ----------
    problem : Problem
        What is to be proved.
    watch : callable, optional
        Is told every enclosure at a knot.
    """

    problem: Problem
    watch: Watch | None = None
    k: int = 0
    offset: Ball = field(default_factory=lambda: ZERO)
    sign: int = 0
    states: StateSet = field(default_factory=lambda: point(ZERO, ZERO))
    impacts: int = 0
    widest: float = 0.0
    overturning: tuple[Ball, Ball] | None = None

    @property
    def side(self) -> BearingCorner:
        """The corner that bears."""
        return self.problem.side(self.sign)

    @property
    def time(self) -> Ball:
        """Time from the first sample [s]."""
        return self.k * self.problem.step + self.offset

    def decide(self) -> bool:
        """Prove that the block overturns, or that it never does.

        Returns
        -------
        bool
            Whether it overturns.

        Raises
        ------
        Undecided
            Neither is proved.
        """
        while True:
            if self.sign == 0:
                if not self._wait():
                    return False
            elif self._rock():
                return True
            elif self.k >= self.problem.last and self.sign and self._kept():
                return False
            if self.k > self.problem.last + STILL_STEPS or self.impacts > MOST_IMPACTS:
                msg = "the motion after the record goes on for too long"
                raise Undecided(msg)

    def _wait(self) -> bool:
        """Rest until the ground tips the block, :eq:`eq-proof-uplift`; tell whether it does."""
        problem = self.problem
        line, length = problem.line(self.k), problem.step - self.offset
        for sign in (1, -1):
            tangent = problem.side(sign).angle.tan()
            begin, end = (
                line.over(at).weight * tangent + sign * line.over(at).along
                for at in (self.offset, problem.step)
            )
            if begin > 0 and end > 0:
                continue
            if not all(line.over(at).weight > 0 for at in (self.offset, problem.step)):
                msg = "the ground falls away beneath the block at rest"
                raise Undecided(msg)
            if begin > 0 and end < 0:
                share = begin / (begin - end)
                self.offset = self.offset + length * share
            elif not (begin < 0 and end < 0):
                msg = "the ground just reaches what it takes to tip the block"
                raise Undecided(msg)
            self.sign = sign
            self.states = point(ZERO, ZERO)
            self._lift_off()
            return True
        if self.k >= problem.last:
            return False
        self._to_next_knot()
        return True

    def _lift_off(self) -> None:
        """Go on from the instant of uplift, from which the ground tips the block ever more."""
        length = self.problem.step - self.offset
        for _ in range(_HALVINGS):
            try:
                found = course(self.side, self._line(), (ZERO, ZERO), [ZERO, ZERO], length)
            except TooLong:
                length = length / 2
                continue
            self.states = point(*found.end())
            if not found.force < self.side.limit:
                length = length / 2
                continue
            self.offset = self.offset + length
            if not self.offset < self.problem.step:
                self._to_next_knot()
            return
        msg = "the way from rest is not enclosed"
        raise Undecided(msg)

    def _to_next_knot(self) -> None:
        self.k, self.offset = self.k + 1, ZERO
        box = self.states.box()
        self.widest = max(self.widest, float(box[0].rad()))
        if self.watch is not None:
            self.watch(self.k, self.sign, box if self.sign else [ZERO, ZERO])

    def _line(self) -> Line:
        line = self.problem.line(self.k)
        return line._replace(at=line.over(self.offset))

    def _rock(self) -> bool:
        """Rock to the next knot or impact; tell whether the block is proved to overturn."""
        left = self.problem.step - self.offset
        if self._step(left, to_ground=False):
            return self.overturning is not None
        place = self._crossing(left)
        if place is None:
            return self._advance(left, 0, to_ground=False)
        if self._advance(place, 0, to_ground=True):
            return True
        self.states = impact(self.problem, self.side, self.k, self.offset, self.states)
        self.sign, self.impacts = -self.sign, self.impacts + 1
        box = self.states.box()
        if not box[1] * self.sign > 0:
            msg = "an impact after which the direction is not known"
            raise Undecided(msg)
        narrow(self.states, self.side.limit)
        rate = (self.side.rate * self.problem.still.weight).sqrt() * self.side.angle
        if box[1] * self.sign < SMALL * rate:
            time = rest_within(self.problem, self.k, self.offset, box)
            if time is not None:
                self._come_to_rest(time)
        return False

    def _come_to_rest(self, time: Ball) -> None:
        self.sign, self.states = 0, point(ZERO, ZERO)
        end = arb((self.offset + time).upper())
        while end >= self.problem.step:
            end = arb((end - self.problem.step).upper())
            self._to_next_knot()
        self.offset = end

    def _advance(self, length: Ball, depth: int, *, to_ground: bool) -> bool:
        """Go on for a while in as many steps as it takes; tell whether the block overturns."""
        if self._step(length, to_ground=to_ground):
            return self.overturning is not None
        if depth == _HALVINGS:
            msg = "whether the block meets the ground, or its crest, is not resolved"
            raise Undecided(msg)
        half = length / 2
        if self._advance(half, depth + 1, to_ground=False):
            return True
        return self._advance(length - half, depth + 1, to_ground=to_ground)

    def _step(self, h: Ball, *, to_ground: bool) -> bool:
        """Try a step; it is made if its sign and the crest are proved, :eq:`eq-proof-sign`."""
        side, s, line = self.side, self.sign, self._line()
        try:
            after, _, (rotations, rates) = stepped(side, line, self.states, h)
        except TooLong:
            return False
        end, limit = after.box(), side.limit
        up, down = rates * s > 0, rates * s < 0
        if not (rotations * s > 0 or up or (down and (to_ground or end[0] * s > 0))):
            return False
        if not rotations * s < limit:
            if end[0] * s > limit:
                self._overturn(line, h, up=up)
                return True
            if not ((up or down) and self.states.box()[0] * s < limit and end[0] * s < limit):
                return False
        self.states = after
        reached = self.offset + h
        if not reached < self.problem.step and not to_ground:
            self._to_next_knot()
            narrow(self.states, limit)
        else:
            self.offset = reached
        return True

    def _overturn(self, line: Line, h: Ball, *, up: bool) -> None:
        """Narrow the interval in which a rotation that rises reaches the crest."""
        low, high = ZERO, h
        for _ in range(60 if up else 0):
            middle = ((low + high) / 2).mid()
            reached = stepped(self.side, line, self.states, middle)[0].box()[0] * self.sign
            if reached < self.side.limit:
                low = middle
            elif reached > self.side.limit:
                high = middle
            else:
                break
        self.overturning = (self.time + low).lower(), (self.time + high).upper()

    def _crossing(self, left: Ball) -> Ball | None:
        """Guess when the centre of the set meets the ground; nothing is proved by it."""
        side, line, s = self.side, self._line(), self.sign
        length = left.mid()
        for _ in range(_HALVINGS):
            try:
                found = course(side, line, (self.states.centre[0], self.states.centre[1]),
                               self.states.box(), length)  # fmt: skip
                break
            except TooLong:
                length = (length / 2).mid()
        else:
            return None
        return _root(found, s)

    def _kept(self) -> bool:
        """Prove by energy that the block stands for ever, :eq:`eq-proof-energy`."""
        ground, rate = self.problem.still, self.states.box()
        near, far = self.side, self.problem.side(-self.sign)
        needed: list[Ball] = []
        for one in (near, far):
            pull = ground.weight * one.angle.sin() + one.sign * ground.along * one.angle.cos()
            if not pull > 0:
                return False
            crest = one.angle + one.sign * (ground.along / ground.weight).atan()
            needed.append(_height(one, one.limit.union(crest), self.problem))
        now = rate[1] * rate[1] / 2 + _height(near, rate[0] * self.sign, self.problem)
        e, back = far.restitution, near.restitution
        lasting = now < needed[0].lower() and e * e * now < needed[1].lower()
        return bool(lasting and e * back <= 1 and rate[0] * self.sign < near.limit)


def _height(side: BearingCorner, lean: Ball, problem: Problem) -> Ball:
    """Give the energy at a rotation over that at none, for a block that turns on one corner."""
    ground = problem.still

    def at(angle: Ball) -> Ball:
        return ground.weight * angle.cos() - side.sign * ground.along * angle.sin()

    return side.rate * (at(side.angle - lean) - at(side.angle))


def _root(found: Course, s: int) -> Ball | None:
    """Find where a series falls through zero, from the doubles of its coefficients."""
    series = [float(one.mid()) * s for one in found.angle]
    values = np.polyval(series[::-1], _PLACES)
    below = np.nonzero(values <= 0.0)[0]
    start, rate, bend = series[0], series[1], 2.0 * series[2]
    if below.size == 0:
        return None
    first = int(below[0])
    guess = float(_PLACES[first])
    if first == 0 and rate > 0.0:  # a short excursion: by its parabola
        guess = (rate + max(rate * rate - 2.0 * bend * start, 0.0) ** 0.5) / -bend
    else:
        low = float(_PLACES[first - 1]) if first else 0.0
        for _ in range(60):
            middle = 0.5 * (low + guess)
            if np.polyval(series[::-1], middle) > 0.0:
                low = middle
            else:
                guess = middle
    place = arb(guess)
    for _ in range(7):
        value, slope = ZERO, ZERO
        for one in reversed(found.angle):
            slope = slope * place + value
            value = value * place + one
        if not float(slope.mid()):
            break
        place = (place - value.mid() / slope.mid()).mid()
    if not 0.3 * guess < float(place) < 3.0 * guess + 1e-12:
        place = arb(guess)
    return (place * found.length).mid()
