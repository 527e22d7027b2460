"""A set of states on pads, followed from the start of a motion to a proved verdict."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from rockframe.proof.balls import ZERO, Ball, Matrix, Row, ball, bits, matrix_product
from rockframe.proof.pads.flow import Curve, StateSet, Step, enclose_step
from rockframe.proof.pads.law import (
    SIZE,
    ContactChange,
    Contacts,
    Dual,
    GroundAcceleration,
    Guard,
    PadBalls,
    arm,
    change_contact,
    corner_motion,
    guard_value,
    guards_of,
    independent_duals,
    rate_of_change,
    rotation_terms,
    state_rates,
)
from rockframe.proof.pads.series import ROUND_UP, Series, StepTooLong, enclose_motion
from rockframe.proof.problem import GroundPiece, PiecewiseGround, Undecided, require

_MAX_STEP_HALVINGS: Final = 30
_PIECES: Final = 16
_MAX_HALVINGS: Final = 40
_MAX_CHANGES: Final = 6
"""Largest number of changes of contact at one instant; with more a proof is given up."""
_GRID: Final = np.linspace(0.0, 1.0, 4 * _PIECES + 1)
_LOST_BITS: Final = 16.0
_MAX_RADIUS: Final = 1e-3
"""Radius of a set, over the weights, beyond which a proof is given up."""

Callback = Callable[[int, Contacts, Row], None]
"""A function called with the number of a knot, the contacts and the enclosure there."""


@dataclass
class PadProver:
    """A set of states that is followed through a motion; its fields change."""

    pads: PadBalls
    ground: PiecewiseGround
    contacts: Contacts  # contacts, at first those at the start
    states: StateSet  # at first those at the start
    weights: Any  # typical sizes of the state's numbers, powers of two
    step_length: float  # [s]
    settling_time: float = 60.0  # time after the record in which the block has to calm down [s]
    callback: Callback | None = None  # called with each enclosure at a knot
    k: int = 0  # number of the last knot
    offset: Ball = ZERO  # time since it [s]
    zero_guards: tuple[Guard, ...] = ()  # guards that have just become zero
    margin: int = 16  # of the series, in bits below the precision
    impacts: int = 0
    largest_radius: float = 0.0  # largest radius of a rotation so far [rad]
    # from when to when it passes the overturning angle
    overturning_time: tuple[Ball, Ball] | None = None

    @property
    def time(self) -> Ball:
        """Time from the first sample [s]."""
        return self.ground.time(self.k, self.offset)

    def overturns(self) -> bool:
        """Follow the set until it is proved whether it overturns, and when.

        Raises `Undecided` if that cannot be proved.
        """
        state = self.states.box(self.weights)
        for guard in guards_of(self.contacts):
            require(
                guard_value(self.pads, guard, state) > 0,
                "the contacts at the start are not resolved",
            )
        ground = self.ground
        last = ground.count + self.settling_time / ground.still_step
        while self.overturning_time is None:
            if self.k >= ground.count and self._is_safe():
                return False
            if self.k > last:
                msg = "the motion after the record goes on for too long"
                raise Undecided(msg)
            self._to_next_knot()
        return True

    def _to_next_knot(self) -> None:
        """Follow the set to the next knot, or until the block has overturned."""
        depth, parts = 0, 0
        while True:
            left = self.ground.length(self.k) - self.offset
            if not parts:
                parts = max(1, round(float(left) / self.step_length + 0.4)) << depth
            ground = self.ground.ground(self.k).at(self.offset)
            h = left if parts == 1 else left / parts
            try:
                done = self._advance(ground, h)
            except StepTooLong:
                depth, parts = depth + 1, 0
                if depth > _MAX_STEP_HALVINGS:
                    msg = "a contact that hardly changes is not resolved"
                    raise Undecided(msg) from None
                continue
            if self.overturning_time is not None:
                return
            if not done:
                depth, parts = 0, 0
                continue
            parts -= 1
            if parts == 0:
                break
            self.offset = self.offset + h
            if depth:
                depth, parts = depth - 1, 0
        self.k, self.offset = self.k + 1, ZERO
        radius = self.states.radii(self.weights)[0]
        self.largest_radius = max(self.largest_radius, float(radius))
        if self.callback is not None:
            self.callback(self.k, self.contacts, self.states.box(self.weights))
        require(
            self.states.radius() < _MAX_RADIUS,
            "the enclosure has become as wide as the motion itself",
        )

    def _advance(self, ground: GroundPiece, h: Ball) -> bool:
        """Make a step, or a part of it up to a change of contact; give whether it was whole."""
        pads, contacts = self.pads, self.contacts
        sizes = tuple(float(weight) for weight in self.weights)
        course = enclose_motion(pads, contacts, ground, self.states.centre, h, sizes, self.margin)
        self._set_margin(course.left_out, sizes)
        made = enclose_step(pads, contacts, course, self.states, self.weights, guards_of(contacts))
        guard, place = self._first_guard(made)
        share = ball(1)
        if guard is not None:
            share = _root(_series(pads, guard, made), place)
        until = min(float(share), 1.0)
        for key, (value, change) in made.curves.items():
            starts_at_zero, ends_at_zero = key in self.zero_guards, key == guard
            if not _positive(
                value, change, until, starts_at_zero=starts_at_zero, ends_at_zero=ends_at_zero
            ):
                raise StepTooLong
        states = self.states.image(
            made.image(share), made.derivative(until), made.error, self.weights
        )
        if guard is None:
            self.states, self.zero_guards = states, ()
            return True
        self._apply_change(ground, h * share, states, guard, made.rate / float(h))
        return False

    def _set_margin(self, left_out: Series, sizes: tuple[float, ...]) -> None:
        """Choose the margin of the next series from the remainders of this one."""
        rests = zip(left_out[:SIZE], sizes, strict=True)
        lost = max(float(remainder) / size for remainder, size in rests) * 2.0 ** bits()
        if lost > _LOST_BITS:
            self.margin = min(self.margin + 8, 96)
        elif lost < 1.0 / _LOST_BITS:
            self.margin = max(self.margin - 4, 8)

    def _first_guard(self, made: Step) -> tuple[Guard | None, float]:
        """Estimate which guard is the first to fall to zero, and where; this proves nothing."""
        which, first = None, 2.0
        for guard, (value, change) in made.curves.items():
            if value.size == 0.0:
                continue
            seen = np.polynomial.polynomial.polyval(_GRID, value.coefficients)
            below = seen <= 0.0
            if guard in self.zero_guards:
                begin = 1
                slope = np.polynomial.polynomial.polyval(_GRID, change.coefficients)
                while begin < below.size and slope[begin] > 0.0 and below[begin]:
                    begin += 1
                below[:begin] = False
            at = np.nonzero(below)[0]
            if at.size == 0:
                continue
            i = int(at[0])
            low, high = float(_GRID[max(i - 1, 0)]), float(_GRID[i])
            for _ in range(50):
                middle = 0.5 * (low + high)
                if np.polynomial.polynomial.polyval(middle, value.coefficients) > 0.0:
                    low = middle
                else:
                    high = middle
            if high < first:
                which, first = guard, high
        return which, first

    def _apply_change(
        self, ground: GroundPiece, h: Ball, states: StateSet, guard: Guard, rate: float
    ) -> None:
        """Map a set through a change of contact of all its members, :eq:`eq-proof-pads-event`."""
        change = self._enclose_change(ground, h, states.box(self.weights), guard, rate)
        centre = self._enclose_change(ground, h, states.centre, guard, rate)
        self.offset = self.offset + h
        if guard.kind == "limit":
            at = self.time + change.delay
            self.overturning_time = at, at
            return
        middle = np.array([[float(entry) for entry in row] for row in change.slope])
        radii = np.array([[float(entry.rad()) for entry in row] for row in change.slope])
        scale = self.weights[None, :] / self.weights[:, None]
        self.states = states.image(
            centre.image, middle * scale, radii * scale * ROUND_UP, self.weights
        )
        self.contacts, self.zero_guards = change.after.contacts, change.after.zero_guards
        self.impacts += change.after.impacts

    def _enclose_change(
        self, shaking: GroundPiece, h: Ball, box: Row, guard: Guard, rate: float
    ) -> "_EnclosedChange":
        """Enclose the image of a box whose members reach the zero of a guard near one time."""
        pads, contacts = self.pads, self.contacts
        value = guard_value(pads, guard, independent_duals(box))
        falling = rate_of_change(
            value, state_rates(pads, contacts, independent_duals(box), self._ground_at(shaking, h))
        )
        require(falling < 0, "a contact that changes as it hardly moves")
        reach = 2.0 * float(value.value.abs_upper()) / float(falling.abs_lower()) + 1e-60
        window = ball(0, reach)
        ground = self._ground_at(shaking, h + window)
        wide = _inflated(
            lambda at: state_rates(pads, contacts, at, ground), box, window, self.weights
        )
        at = independent_duals(wide)
        before = state_rates(pads, contacts, at, ground)
        guarded = guard_value(pads, guard, at)
        falling = rate_of_change(guarded, before)
        require(falling < 0, "a contact that changes as it hardly moves")
        delay = -value.value / falling
        require(window.contains(delay), "the time of a change of contact is not enclosed")
        others = [other for other in guards_of(contacts) if other != guard]
        self._confirm_guards(others, self.zero_guards, at, before)
        met = [a + delay * b.value for a, b in zip(box, before, strict=True)]
        met = [a.intersection(b) for a, b in zip(met, wide, strict=True)]
        if guard.kind == "limit":
            return _EnclosedChange(delay, met, [], ContactChange([], contacts, (), 0))
        after = self._after_further_changes(
            change_contact(pads, contacts, guard, independent_duals(met), ground), ground
        )
        image = [component.value for component in after.state]
        back = _inflated(
            lambda at: state_rates(pads, after.contacts, at, ground), image, window, self.weights
        )
        at = independent_duals(back)
        later = state_rates(pads, after.contacts, at, ground)
        self._confirm_guards(guards_of(after.contacts), after.zero_guards, at, later)
        image = [a - delay * b.value for a, b in zip(image, later, strict=True)]
        slope = _saltation(after, before, later, guarded, falling)
        swing = reach * max(rate, _norm(later, self.weights), _norm(before, self.weights))
        near = ball(0, np.expm1(swing) * ROUND_UP + 1e-60)
        slope = self._widened(slope, near)
        return _EnclosedChange(delay, image, slope, after)

    def _after_further_changes(
        self, after: ContactChange, ground: GroundAcceleration
    ) -> ContactChange:
        """Carry out further changes of contact that follow at the same instant."""
        for _ in range(_MAX_CHANGES):
            state = [component.value for component in after.state]
            waiting = [
                further
                for further in guards_of(after.contacts)
                if further not in after.zero_guards and guard_value(self.pads, further, state) < 0
            ]
            if not waiting:
                return after
            if len(waiting) > 1:
                msg = "several contacts change at one instant"
                raise Undecided(msg)
            count = after.impacts
            after = change_contact(self.pads, after.contacts, waiting[0], after.state, ground)
            after = after._replace(impacts=count + after.impacts)
        msg = "contacts that change without end at one instant"
        raise Undecided(msg)

    def _ground_at(self, ground: GroundPiece, time: Ball) -> GroundAcceleration:
        """Return the ground at a time from now, a ball, which may be in both intervals [s]."""
        left = self.ground.length(self.k) - self.offset
        acceleration = ground.at(time)
        if not time < left:
            acceleration = acceleration.union(self.ground.ground(self.k + 1).at(time - left))
        return GroundAcceleration(acceleration.along[0], acceleration.normal[0])

    def _confirm_guards(
        self, guards: list[Guard], zero_guards: tuple[Guard, ...], at: list[Dual], rates: list[Dual]
    ) -> None:
        """Prove that guards are positive, or rise from zero, while members change one by one."""
        for guard in guards:
            value = guard_value(self.pads, guard, at)
            require(
                value.value > 0 or (guard in zero_guards and rate_of_change(value, rates) > 0),
                "the contacts about a change are not resolved",
            )

    def _widened(self, slope: Matrix, near: Ball) -> Matrix:
        """Widen a derivative by the motion of members between their change and the centre's."""
        scale = [ball(float(weight)) for weight in self.weights]
        beside = [
            [ball(int(i == j)) + near * scale[i] / scale[j] for j in range(SIZE)]
            for i in range(SIZE)
        ]
        return matrix_product(beside, matrix_product(slope, beside))

    def _is_safe(self) -> bool:
        """Prove by energy that the block stands for ever, :eq:`eq-proof-pads-energy`."""
        pads, state = self.pads, self.states.box(self.weights)
        lossy = all(restitution <= 1 for restitution in pads.restitutions)
        require(lossy, "a restitution above 1 may raise the energy")
        rotation, rate, height, speed, sway = state
        if not self.contacts.in_flight:
            sway = arm(pads, self.contacts, rotation) * rate
        energy = (pads.inertia * rate * rate + speed * speed + sway * sway) / 2
        energy = energy + pads.gravity * height
        for left in (True, False):
            depth = pads.rest - corner_motion(pads, left, state).level
            energy = energy + pads.stiffness * depth.nonnegative_part() ** 2 / 2
        sunk = pads.gravity / pads.stiffness
        for left in (True, False):
            limit = -pads.limits[0] if left else pads.limits[1]
            at = rotation_terms(pads, limit)
            below = at.rise + at.sine * (pads.left if left else -pads.right)
            crest = pads.gravity * (pads.rest - below - sunk / 2)
            if not energy < crest:
                return False
        return bool(-pads.limits[0] < rotation and rotation < pads.limits[1])


@dataclass
class _EnclosedChange:
    """A change of contact of a box of states."""

    delay: Ball  # time of the change of each member, from now [s]
    image: Row  # states after it
    slope: Matrix  # derivative of these by the states before
    after: ContactChange


def _inflated(rates: Callable[[list[Any]], list[Any]], box: Row, window: Ball, weights: Any) -> Row:
    """Enclose all states that a box passes through in a window of time [s]."""
    grown = box
    for _ in range(12):
        flow = [component.value for component in rates(independent_duals(grown))]
        reached = [a + window * b for a, b in zip(box, flow, strict=True)]
        if all(a.contains(b) for a, b in zip(grown, reached, strict=True)):
            return reached
        grown = [
            a + (b - a) * ball(0, 1.5) + ball(0, 1e-70 * float(w))
            for a, b, w in zip(box, reached, weights, strict=True)
        ]
    msg = "what happens about a change of contact is not enclosed"
    raise Undecided(msg)


def _saltation(
    after: ContactChange, before: list[Any], later: list[Any], guarded: Any, falling: Ball
) -> Matrix:
    """Return the saltation matrix: the derivative of a change by the state, at one fixed time."""
    reset = [component.slope for component in after.state]
    speeds = [component.value for component in before]
    jump = [
        component.value - sum((a * b for a, b in zip(row, speeds, strict=True)), ZERO)
        for component, row in zip(later, reset, strict=True)
    ]
    return [
        [row[j] + jump[i] * guarded.slope[j] / falling for j in range(SIZE)]
        for i, row in enumerate(reset)
    ]


def _norm(rates: list[Any], weights: Any) -> float:
    """Bound the norm of the weighted derivative of the field."""
    sizes = np.array([[float(derivative.abs_upper()) for derivative in row.slope] for row in rates])
    return float((sizes * weights[None, :] / weights[:, None]).sum(axis=1).max()) * ROUND_UP


def _positive(
    value: Curve, change: Curve, until: float, *, starts_at_zero: bool, ends_at_zero: bool
) -> bool:
    """Prove that a guard is positive up to a share, except where it begins or ends at zero."""
    of, slopes = value.coefficients, change.coefficients
    powers = np.arange(of.size)
    curvature = float((np.abs(of) * powers * np.maximum(powers - 1, 0)).sum()) * ROUND_UP
    slope_change = float((np.abs(slopes) * powers).sum()) * ROUND_UP
    derivative = (of * powers)[1:]
    edges = [(until * i / _PIECES, until * (i + 1) / _PIECES, 0) for i in range(_PIECES)]
    lost = 1e-14 * (value.size + change.size)
    down = until
    while edges:  # from the last piece to the first
        begin, end, depth = edges.pop()
        middle, half = 0.5 * (begin + end), 0.5 * (end - begin) * ROUND_UP
        tilt = abs(float(np.polynomial.polynomial.polyval(middle, derivative)))
        least = float(np.polynomial.polynomial.polyval(middle, of)) - half * (
            tilt + half * curvature
        )
        if least > value.error + lost:
            continue
        rise = float(np.polynomial.polynomial.polyval(middle, slopes))
        away = half * slope_change + change.error + lost
        if starts_at_zero and begin == 0.0 and rise > away:
            continue
        if ends_at_zero and end == down and rise < -away:
            down = begin  # from here on it falls all the way to its zero
            continue
        if depth == _MAX_HALVINGS:
            return False
        edges += [(begin, middle, depth + 1), (middle, end, depth + 1)]
    return True


def _series(pads: PadBalls, guard: Guard, made: Step) -> Row:
    """Return the series of a guard over a step."""
    series, i = made.course.series, int(not guard.left)
    if guard.kind == "limit":
        sign = 1 if guard.left else -1
        first, *others = series.rotation
        return [pads.limits[i] + sign * first, *(sign * term for term in others)]
    if guard.kind in ("depth", "gap"):
        sign = 1 if guard.kind == "gap" else -1
        first, *others = series.levels[i]
        return [sign * (first - pads.rest), *(sign * term for term in others)]
    if guard.kind == "rise":
        return series.speeds[i]
    sign = -1 if guard.kind == "slack" else 1
    return [sign * force for force in series.forces[i]]


def _root(series: Row, place: float) -> Ball:
    """Estimate where a series comes to zero, from a first guess; this proves nothing."""
    at = ball(place)
    for _ in range(8):
        value, slope = ZERO, ZERO
        for coefficient in reversed(series):
            slope = slope * at + value
            value = value * at + coefficient.mid()
        if not float(slope.mid()):
            break
        at = (at - value.mid() / slope.mid()).mid()
    if not abs(float(at) - place) < 1e-6:
        at = ball(place)
    if not 0 < at < 1:
        raise StepTooLong
    return at
