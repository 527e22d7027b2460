"""Two bodies in a pattern: equations, guards and changes of the pattern."""

import numpy as np
from reference_models.rigid_pair.ground import Piece
from reference_models.rigid_pair.pair import ENDS, SIGN
from reference_models.rigid_pair.simulate import LEVEL, RESTING

from .choices import Ended, Outcome, Touch, follow, strike
from .contacts import (
    INTERFACES,
    STANDING,
    Bearing,
    Pattern,
    height,
    middle_slips,
    on_top,
    tidied,
    upright_places,
)
from .events import STATE, Event, OffTheTopError, Run, named

GONE = 1e-13
"""Threshold of guards; also the speed below which nothing slips [m/s]."""
MOST, SPAN = 200, 1e-3
"""A run ends by chatter after so many events within a span, in units of the bodies' slowness."""


class MovingPair:
    """Two moving bodies."""

    compliant: dict = {}  # noqa: RUF012  interfaces that give way: there are none

    def __init__(self, pair, frictions, output, accuracy, longest):
        self.pair, self.frictions, self.accuracy = pair, frictions, accuracy
        self.pattern = STANDING
        self.state = np.zeros(STATE)
        self.state[:6] = upright_places(pair)
        self.now, self.step, self.longest = 0.0, 0.01 * pair.slowness, longest
        self.slow = RESTING / pair.slowness
        self.lost, self.largest = 0.0, 0.0
        self.least = np.full(STATE, 1e-14)  # absolute tolerances
        self.least[14:] *= pair.gravity * pair.weights @ self.state[:6]
        self.floor: dict = {}  # initial values of gaps that begin at zero up to rounding
        self.pulled = False  # whether contacts are held although they do not press
        self.run = Run(output, np.full((output.size, 6), np.nan), np.full((output.size, 2), np.nan))
        self.shown = 0
        self.piece: Piece
        self.start = 0.0

    # states -------------------------------------------------------------------------------------

    @property
    def place(self):
        """Six places."""
        return self.state[:6]

    @property
    def speed(self):
        """Six velocities."""
        return self.state[6:12]

    def touching(self, pattern=None):
        """Return the ends that bear."""
        return dict(zip(INTERFACES, (one.ends for one in pattern or self.pattern), strict=True))

    def touch(self, place, speed, touching=None) -> Touch:
        """Return the contacts at a state."""
        touching = touching or self.touching()
        return Touch(self.pair, self.frictions, place, speed, touching)

    def forces(self, t, state):
        """Return the contacts, and accelerations and forces of the pattern."""
        touch = self.touch(state[:6], state[6:12])
        fall = touch.fall(self.piece.across(t), self.piece.up(t))
        return touch, touch.solve(self.pattern, fall, turning=True)

    def slip_rates(self, touch: Touch, state) -> list[float]:
        """Return the velocities of slip; in flight those of the middles of the bases."""
        rates = []
        for i, bearing in enumerate(self.pattern):
            if not bearing.ends:
                rates.append(middle_slips(self.pair, state[:6], state[6:12])[i])
            elif bearing.slip:
                rates.append(touch.along(INTERFACES[i], bearing.ends[0], state[6:12], False))
            else:
                rates.append(0.0)
        return rates

    def slopes(self, t, state):
        """Return the derivative of the state."""
        touch, answer = self.forces(t, state)
        speed, slips = state[6:12], self.slip_rates(touch, state)
        burnt = [
            -answer.friction.get(key, 0.0) * rate
            for key, rate in zip(INTERFACES, slips, strict=True)
        ]
        masses, (ax, ay) = self.pair.masses, (self.piece.across(t), self.piece.up(t))
        work = -masses[0] * (ax * speed[0] + ay * speed[1])
        work -= masses[3] * (ax * speed[3] + ay * speed[4])
        work += self.power(touch, speed)
        return np.concatenate([speed, answer.motion, slips, [work], burnt])

    def power(self, touch: Touch, speed) -> float:
        """Return the power of compliant bases, here zero."""
        return 0.0

    def tidied(self, state):
        """Return a state without drift by rounding."""
        state = state.copy()
        state[:6] = tidied(self.pair, self.pattern, state[:6])
        state[6:12] = self.projected(self.pattern, state[:6], state[6:12])
        return state

    def projected(self, pattern: Pattern, place, speed):
        """Project velocities on the constraints of a pattern, without friction where it slips."""
        touch = self.touch(place, speed, self.touching(pattern))
        rows = []
        for key, bearing in zip(INTERFACES, pattern, strict=True):
            if key not in self.compliant:
                rows += [touch.contacts[key, end].normal for end in bearing.ends]
            if bearing.ends and bearing.slip == 0:
                rows.append(touch.contacts[key, bearing.ends[0]].along)
        if not rows:
            return speed
        if len(rows) == 6:
            return np.zeros(6)
        rows = np.array(rows)
        size = 1.0 / np.sqrt((rows * rows) @ touch.inverse)
        rows = rows * size[:, None]
        answer = rows * touch.inverse
        return speed - answer.T @ np.linalg.solve(rows @ answer.T, rows @ speed)

    # guards -------------------------------------------------------------------------------------

    def guards(self, t, state) -> dict:
        """Return the guards."""
        pair, guards, place = self.pair, {}, state[:6]
        touch, answer = self.forces(t, state)
        scale = pair.gravity * pair.upper.mass
        if self.pulled:
            guards["let", "go", ""] = -1.0 if self._next_outcome(t, state) else 1.0
        for name, push in answer.normal.items():
            if not self.pulled and name[0] not in self.compliant:
                guards["press", *name] = push / scale
        rates = self.slip_rates(touch, state)
        for key, bearing, rate in zip(INTERFACES, self.pattern, rates, strict=True):
            if bearing.slip:
                guards["slip", key, ""] = bearing.slip * rate
            elif bearing.ends and not self.pulled and not self.frictions[key].holds:
                most = self.frictions[key].static * answer.pressed(key)
                for end, way in SIGN.items():
                    guards["grip", key, end] = (most - way * answer.friction[key]) / scale
        self._add_gaps(guards, place)
        for name, value in guards.items():
            if name[0] == "gap":
                guards[name] -= self.floor.setdefault(name, max(-1e-9, min(value, 0.0)))
        for name, angle, (left, right) in zip(
            ("lower", "upper"), (place[2], place[5]), pair.limits, strict=True
        ):
            guards["overturn", name, "left"] = angle - left
            guards["overturn", name, "right"] = right - angle
        return guards

    def _add_gaps(self, guards, place):
        """Add gaps between ends and surfaces, and distances of the upper ends from the edges."""
        angles = {"ground": place[2], "joint": place[5] - place[2]}
        for key, bearing in zip(INTERFACES, self.pattern, strict=True):
            if len(bearing.ends) == 1 and key not in self.compliant:
                (end,) = bearing.ends
                other = ENDS[end == "left"]
                guards["gap", key, other] = SIGN[end] * angles[key]
        half = self.pair.lower.half_width
        for end in ENDS:
            if not self.pattern.ground.ends and "ground" not in self.compliant:
                guards["gap", "ground", end] = height(self.pair, place, end) / half
            if self.pattern.joint.ends and not self.pattern.joint.slip:
                continue
            along, above = on_top(self.pair, place, end)
            if not self.pattern.joint.ends and "joint" not in self.compliant:
                guards["gap", "joint", end] = above / half
            if not self.compliant:
                guards["off", "joint", end] = 1.0 - abs(along) / half + 1e-9

    # changes ------------------------------------------------------------------------------------

    def note(self, kind, where, end, before, outcome: Outcome | None = None, admissible=1):
        """Store an event."""
        lost, others = 0.0, ()
        if outcome is not None:
            admissible, lost, others = outcome.admissible, outcome.lost, outcome.others
        self.run.events.append(
            Event(self.now, kind, where, end, before, self.pattern, admissible, lost, others)
        )

    def take(self, pattern: Pattern):
        """Enter a pattern."""
        self.pattern, self.floor, self.pulled = pattern, {}, False
        self.state = self.tidied(self.state)

    def _next_outcome(self, t, state, ended: Ended | None = None) -> Outcome | None:
        """Return the pattern consistent with the forces."""
        before, moving = self.pattern, {}
        touch = self.touch(state[:6], state[6:12])
        for key, bearing in zip(INTERFACES, before, strict=True):
            moving[key] = 0
            if bearing.slip:
                rate = touch.along(key, bearing.ends[0], state[6:12], False)
                moving[key] = bearing.slip if bearing.slip * rate > GONE else 0
        return follow(touch, before, moving, self.piece.across(t), self.piece.up(t), ended)

    def settle(self, ended: Ended | None = None):
        """Open, slip and hold contacts as the forces require."""
        outcome = self._next_outcome(self.now, self.state, ended)
        if outcome is None:
            # no pattern is admissible: hold touching contacts, though they do not press
            if not self.pulled:
                self.pulled = True
                key, end = ("", "") if ended is None else ended
                self.note("held", key, end, self.pattern, admissible=0)
            return
        before, pulled = self.pattern, self.pulled
        if outcome.pattern == before and not pulled and outcome.admissible == 1:
            return
        self.take(outcome.pattern)
        self.note(*named(before, outcome.pattern), before, outcome)

    def stop_slip(self, key):
        """End a slip: it sticks or reverses."""
        before = self.pattern
        bearing = before[INTERFACES.index(key)]
        held = before._replace(**{key: bearing._replace(slip=0)})
        self.state[6:12] = self.projected(held, self.place, self.speed)
        self.settle()
        if self.pattern == before:
            msg = f"a slip neither ends nor reverses at {self.now} s"
            raise ArithmeticError(msg)

    def hit(self, key, end):
        """Close an end by an impact."""
        before = self.pattern
        touching = self.touching()
        # compliant bases take no part in impacts
        touching = {one: () if one in self.compliant else touching[one] for one in INTERFACES}
        if touching[key]:
            touching[key] = ENDS
        else:
            k = (2, 5)[key == "joint"]
            angle, rate = self.place[k], self.speed[k]
            if key == "joint":
                angle, rate = angle - self.place[2], rate - self.speed[2]
            level = abs(angle) < LEVEL and abs(rate) < 1e3 * self.slow
            touching[key] = ENDS if level else (end,)
        closed = Pattern(*(Bearing(touching[one], 1) for one in INTERFACES))
        high = self.pair.gravity * self.pair.weights @ self.place
        self.state[:6] = tidied(self.pair, closed, self.place)
        if not before[INTERFACES.index(key)].ends and len(touching[key]) == 2:
            # lowered from a negligible height
            self.lost += high - self.pair.gravity * self.pair.weights @ self.place
        outcome = strike(self.pair, self.frictions, self.place, self.speed, touching)
        self.lost += outcome.lost
        self.state[6:12] = outcome.answer.motion
        self.take(outcome.pattern)
        self.note("impact", key, end, before, outcome)
        self._rest()
        self.settle()

    def _rest(self):
        """Close contacts that reopen so slowly that impacts would be endless."""
        tiny = []
        angles = {"ground": self.place[2], "joint": self.place[5] - self.place[2]}
        rates = {"ground": self.speed[2], "joint": self.speed[5] - self.speed[2]}
        for key, bearing in zip(INTERFACES, self.pattern, strict=True):
            flat = abs(angles[key]) < 1e-15 and key not in self.compliant
            if len(bearing.ends) == 1 and abs(rates[key]) < self.slow and flat:
                tiny.append(key)
        across, up = self.piece.across(self.now), self.piece.up(self.now)
        before = self.pattern
        for some in [tiny] if len(tiny) < 2 else [tiny, tiny[:1], tiny[1:]]:
            if not some:
                return
            closed = {key: before[INTERFACES.index(key)]._replace(ends=ENDS) for key in some}
            pattern = before._replace(**closed)
            # the sum of normal impulses and friction of many small bounces
            touch = self.touch(self.place, self.speed, self.touching(pattern))
            speed = touch.solve(pattern, self.speed, turning=False).motion
            touch = self.touch(self.place, speed, self.touching(pattern))
            moving = dict(zip(INTERFACES, (one.slip for one in pattern), strict=True))
            outcome = follow(touch, pattern, moving, across, up)
            if outcome is None or self.touching(outcome.pattern) != self.touching(pattern):
                continue
            masses = self.pair.masses
            lost = 0.5 * float(masses @ self.speed**2 - masses @ speed**2)
            self.state[6:12] = speed
            self.lost += lost
            self.take(pattern)
            self.note("rest", "+".join(some), "", before, outcome._replace(lost=lost))
            return

    def answer(self, name) -> bool:
        """Carry out an event; tell whether the run continues."""
        kind, key, end = name
        if kind == "overturn":
            self.run.overturned = True
            self.note("overturning", key, end, self.pattern)
            return False
        if kind == "off":
            raise OffTheTopError(self.now, self.run)
        if kind == "press":
            self.settle(Ended(key, end))
        elif kind == "grip":
            self.settle(Ended(key))
        elif kind == "let":
            self.settle()
        elif kind == "slip":
            self.stop_slip(key)
        else:
            self.hit(key, end)
        return not self.chatters()

    def chatters(self) -> bool:
        """Tell whether events are endless, in ever smaller motions."""
        events = self.run.events
        if len(events) < MOST or self.now - events[-MOST].time > SPAN * self.pair.slowness:
            return False
        self.note("chatter", "", "", self.pattern, admissible=0)
        return True
