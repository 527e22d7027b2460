"""Two blocks of which one base is rigid, and one stands on pads or on a bed, with friction or not.

What pads and beds press with is known from where the bodies are, so that friction there is a force
along the surface at the point that the rule of restraint holds: a bound of the force that holds
it, or a load. In impacts, of rigid bases, it has no part.
"""

import math

import numpy as np
from reference_models.monoliths.slipping_block import Bed, Pads
from reference_models.rigid_pair.pair import ENDS

from .choices import Touch
from .contacts import INTERFACES, Bearing, Contact, Pattern, contact, height, on_top
from .moving_pair import Moving

HELD = "held"
"""In place of the ends of an interface that gives way: the point that is held, or slips."""
SIDES = {"left": "L", "right": "R"}

Giving = dict[str, Pads | Bed]


def mixed(one: Contact, other: Contact, share: float) -> Contact:
    """Return the contact of a point between two ends, which is linear in its place."""
    along, normal, turns = (
        [(1.0 - share) * a + share * b for a, b in zip(first, second, strict=True)]
        for first, second in zip(one, other, strict=True)
    )
    return Contact(along, normal, (turns[0], turns[1]))


class View:
    """A base as pads and beds see it: levels and speeds of its ends; levers are shares of it."""

    def __init__(self, pair, place, speed, key):
        self.rows = {end: contact(pair, place, speed, key, end) for end in ENDS}
        self.speed, self.levels = speed, {}
        for end in ENDS:
            level = on_top(pair, place, end)[1] if key == "joint" else height(pair, place, end)
            self.levels[end] = level

    def corner(self, side, z=None):
        """Level, speed and place of an end, by its first letter."""
        end = "left" if side == "L" else "right"
        return (
            self.levels[end],
            float(np.dot(self.rows[end].normal, self.speed)),
            float(side == "R"),
        )

    def corner_acceleration(self, side, z, accelerations):
        """Return how fast the speed of an end grows."""
        row = self.rows["left" if side == "L" else "right"]
        return float(np.dot(row.normal, accelerations)) + row.turns[1]


class GivingTouch(Touch):
    """All contacts at one instant, with the loads of bases that give way."""

    def __init__(self, pair, frictions, place, speed, touching, giving: Giving, rule: str):
        rigid = {key: () if key in giving else touching[key] for key in INTERFACES}
        super().__init__(pair, frictions, place, speed, rigid)
        self.touching, self.load, self.pressing = touching, np.zeros(6), {}
        for key, base in giving.items():
            view = View(pair, place, speed, key)
            forces = base.forces(view, None)
            self.pressing[key] = max(sum(force for force, _ in forces), 0.0)
            for force, share in forces:
                row = mixed(view.rows["left"], view.rows["right"], share)
                self.load += force * np.array(row.normal)
            left, right = base.held("L"), base.held("R")
            share = 0.5 if rule == "centre" or left == right else float(right)
            self.contacts[key, HELD] = mixed(view.rows["left"], view.rows["right"], share)

    def fall(self, across, up):
        """Return the accelerations of bodies under what presses them, without constraints."""
        return super().fall(across, up) + self.inverse * self.load

    def solve(self, pattern, motion, turning, hooked=()):
        """Add what friction does where bodies slip; hold the others there."""
        keys = [key for key in self.pressing if self.touching[key] and turning]
        hooked = list(hooked)
        for key in keys:
            bearing = pattern[INTERFACES.index(key)]
            if not bearing.ends:
                raise np.linalg.LinAlgError  # what touches is not tried
            row = np.array(self.contacts[key, HELD].along)
            if bearing.slip:
                drag = -bearing.slip * self.frictions[key].kinetic * self.pressing[key]
                motion = motion + self.inverse * drag * row
            else:
                hooked.append(key)
        bare = Pattern(
            *(Bearing() if key in self.pressing else one
              for key, one in zip(INTERFACES, pattern, strict=True))
        )  # fmt: skip
        found = super().solve(bare, motion, turning, tuple(hooked))
        for key in keys:
            bearing = pattern[INTERFACES.index(key)]
            found.normal[key, HELD] = self.pressing[key]
            if bearing.slip:
                drag = -bearing.slip * self.frictions[key].kinetic * self.pressing[key]
                found.friction[key] = drag
        return found


class GivingMoving(Moving):
    """Two bodies as they move, of which some stand on bases that give way."""

    giving: Giving
    rule: str

    def give(self, giving: Giving, rule: str) -> None:
        """Stand on bases that give way, under the weights there."""
        self.giving, self.rule = giving, rule
        self.pattern = self.with_points(self.pattern)

    def with_points(self, pattern: Pattern, slips=None) -> Pattern:
        """Return the pattern in which bases that give way bear at the points that are held."""
        found = []
        for key, bearing in zip(INTERFACES, pattern, strict=True):
            if key in self.giving:
                base = self.giving[key]
                bears = base.held("L") or base.held("R")
                slip = (slips or {}).get(key, bearing.slip)
                bearing = Bearing((HELD,), slip) if bears else Bearing()
            found.append(bearing)
        return Pattern(*found)

    def bare(self, pattern: Pattern) -> Pattern:
        """Return the pattern of rigid bases alone."""
        return Pattern(
            *(Bearing() if key in self.giving else one
              for key, one in zip(INTERFACES, pattern, strict=True))
        )  # fmt: skip

    def touch(self, place, speed, touching=None):
        """Return the contacts as they are."""
        touching = touching or self.touching()
        return GivingTouch(
            self.pair, self.frictions, place, speed, touching, self.giving, self.rule
        )

    def power(self, touch, speed) -> float:
        """Return the power of springs and dashpots."""
        return float(touch.load @ speed)

    def tidied(self, state):
        """Return a state without what steps add to it by rounding."""
        pattern, self.pattern = self.pattern, self.bare(self.pattern)
        found = super().tidied(state)
        self.pattern = pattern
        found[6:12] = self.projected(pattern, found[:6], found[6:12])
        return found

    def guards(self, t, state):
        """Return what must stay positive."""
        found, scale = super().guards(t, state), self.pair.gravity * self.pair.upper.mass
        for key, base in self.giving.items():
            view = View(self.pair, state[:6], state[6:12], key)
            for (what, side), value in base.guards(view, None).items():
                force = what in ("leave", "turn")
                found["pad", key, (what, side)] = value / (scale if force else base.sunk)
        return found

    def take(self, pattern):
        """Enter a pattern; after an impact what gives way slips as the velocities are."""
        found = self.with_points(pattern)
        touch, slips = self.touch(self.place, self.speed, self.touching(found)), {}
        for key in self.giving:
            i = INTERFACES.index(key)
            if found[i].ends and not pattern[i].ends:
                rate = touch.along(key, HELD, self.speed, False)
                slow = 1e-13 * (1.0 + float(np.abs(self.speed).max()))
                slips[key] = int(math.copysign(1, rate)) if abs(rate) > slow else 0
        super().take(self.with_points(pattern, slips))

    def hit(self, key, end):
        """Let an end close by an impact, after which pads may press, or let go, at once."""
        super().hit(key, end)
        for base in self.giving.values():
            for side, now in base.contact.items():
                if now == "leaving":
                    base.contact[side] = "relaxing"
        for _ in range(4):
            guards = self.guards(self.now, self.state).items()
            fallen = [name for name, value in guards if name[0] == "pad" and value < -1e-12]
            if not fallen:
                break
            self.pad(fallen[0][1], *fallen[0][2])

    def _rest(self):
        """Let small bounces end, also such as let a base go and hold it in turn."""
        super()._rest()
        rates = {"ground": self.speed[2], "joint": self.speed[5] - self.speed[2]}
        (rigid,) = set(INTERFACES) - set(self.giving)
        (key,) = self.giving
        bears = self.pattern[INTERFACES.index(rigid)].ends
        bearing = self.pattern[INTERFACES.index(key)]
        if len(bears) != 1 or abs(rates[rigid]) > self.slow or not bearing.slip:
            return
        touch = self.touch(self.place, self.speed)
        if abs(touch.along(key, HELD, self.speed, False)) > self.slow * self.pair.lower.below:
            return
        before = self.speed.copy()
        self.pattern = self.pattern._replace(**{key: bearing._replace(slip=0)})
        self.state[6:12] = self.projected(self.pattern, self.place, before)
        self.lost += 0.5 * float(self.pair.masses @ (before**2 - self.speed**2))
        super()._rest()

    def pad(self, key, what, side):
        """Let an end on a pad or bed leave, land, or change how it presses."""
        base, before = self.giving[key], self.pattern
        event = base.switch(View(self.pair, self.place, self.speed, key), what, side, None)
        if event is None:
            return
        self.take(self.bare(before))
        self.note(f"pad {event.lower()}", key, side, before)
        self.settle()
        if self.pattern[INTERFACES.index(key)].ends:
            view = View(self.pair, self.place, self.speed, key)
            _, answer = self.forces(self.now, self.state)
            base.wait(view, event, side, None, answer.motion)

    def answer(self, name):
        """Do what an event asks for; tell whether the run goes on."""
        kind, key, end = name
        if kind != "pad":
            return super().answer(name)
        self.pad(key, *end)
        return not self.chatters()
