"""Two blocks, one on a rigid base and one on pads or a bed, with friction or not.

The forces of pads and beds follow from the positions of the bodies. Friction there is a force along
the surface at the point held by the restraint rule: a bound of the holding force, or a load.
Impacts occur at rigid bases only.
"""

import math

import numpy as np
from reference_models.monoliths.slipping_block import Bed, Pads
from reference_models.rigid_pair.pair import ENDS

from .choices import Touch
from .contacts import INTERFACES, Bearing, Contact, Pattern, contact, height, on_top
from .moving_pair import MovingPair

HELD = "held"
"""Name of the held or slipping point of a compliant interface, instead of its ends."""
SIDES = {"left": "L", "right": "R"}

CompliantBases = dict[str, Pads | Bed]


def interpolated(one: Contact, other: Contact, share: float) -> Contact:
    """Return the contact of a point between two ends, which is linear in its place."""
    along, normal, turns = (
        [(1.0 - share) * a + share * b for a, b in zip(left_row, right_row, strict=True)]
        for left_row, right_row in zip(one, other, strict=True)
    )
    return Contact(along, normal, (turns[0], turns[1]))


class View:
    """A base in the form that pads and beds use: levels, speeds and levers of its ends."""

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
        """Return the normal acceleration of an end."""
        row = self.rows["left" if side == "L" else "right"]
        return float(np.dot(row.normal, accelerations)) + row.turns[1]


class CompliantTouch(Touch):
    """All contacts at one instant, with the loads of compliant bases."""

    def __init__(
        self, pair, frictions, place, speed, touching, compliant: CompliantBases, rule: str
    ):
        rigid = {key: () if key in compliant else touching[key] for key in INTERFACES}
        super().__init__(pair, frictions, place, speed, rigid)
        self.touching, self.load, self.pressing = touching, np.zeros(6), {}
        for key, base in compliant.items():
            view = View(pair, place, speed, key)
            forces = base.forces(view, None)
            self.pressing[key] = max(sum(force for force, _ in forces), 0.0)
            for force, share in forces:
                row = interpolated(view.rows["left"], view.rows["right"], share)
                self.load += force * np.array(row.normal)
            left, right = base.held("L"), base.held("R")
            share = 0.5 if rule == "centre" or left == right else float(right)
            self.contacts[key, HELD] = interpolated(view.rows["left"], view.rows["right"], share)

    def fall(self, across, up):
        """Return the accelerations under the loads, without constraints."""
        return super().fall(across, up) + self.inverse * self.load

    def solve(self, pattern, motion, turning, hooked=()):
        """Add friction where bodies slip; hold the others."""
        keys = [key for key in self.pressing if self.touching[key] and turning]
        hooked = list(hooked)
        for key in keys:
            bearing = pattern[INTERFACES.index(key)]
            if not bearing.ends:
                raise np.linalg.LinAlgError  # a touching compliant base always bears
            row = np.array(self.contacts[key, HELD].along)
            if bearing.slip:
                drag = -bearing.slip * self.frictions[key].kinetic * self.pressing[key]
                motion = motion + self.inverse * drag * row
            else:
                hooked.append(key)
        rigid_pattern = Pattern(
            *(Bearing() if key in self.pressing else one
              for key, one in zip(INTERFACES, pattern, strict=True))
        )  # fmt: skip
        answer = super().solve(rigid_pattern, motion, turning, tuple(hooked))
        for key in keys:
            bearing = pattern[INTERFACES.index(key)]
            answer.normal[key, HELD] = self.pressing[key]
            if bearing.slip:
                drag = -bearing.slip * self.frictions[key].kinetic * self.pressing[key]
                answer.friction[key] = drag
        return answer


class CompliantPair(MovingPair):
    """Two moving bodies, some on compliant bases."""

    compliant: CompliantBases
    rule: str

    def set_compliant_bases(self, compliant: CompliantBases, rule: str) -> None:
        """Set the compliant bases, compressed by their weights."""
        self.compliant, self.rule = compliant, rule
        self.pattern = self.with_points(self.pattern)

    def with_points(self, pattern: Pattern, slips=None) -> Pattern:
        """Return the pattern in which compliant bases bear at their held points."""
        bearings = []
        for key, bearing in zip(INTERFACES, pattern, strict=True):
            if key in self.compliant:
                base = self.compliant[key]
                bears = base.held("L") or base.held("R")
                slip = (slips or {}).get(key, bearing.slip)
                bearing = Bearing((HELD,), slip) if bears else Bearing()
            bearings.append(bearing)
        return Pattern(*bearings)

    def rigid_pattern(self, pattern: Pattern) -> Pattern:
        """Return the pattern of rigid bases alone."""
        return Pattern(
            *(Bearing() if key in self.compliant else one
              for key, one in zip(INTERFACES, pattern, strict=True))
        )  # fmt: skip

    def touch(self, place, speed, touching=None):
        """Return the contacts at a state."""
        touching = touching or self.touching()
        return CompliantTouch(
            self.pair, self.frictions, place, speed, touching, self.compliant, self.rule
        )

    def power(self, touch, speed) -> float:
        """Return the power of springs and dashpots."""
        return float(touch.load @ speed)

    def tidied(self, state):
        """Return a state without drift by rounding."""
        pattern, self.pattern = self.pattern, self.rigid_pattern(self.pattern)
        corrected = super().tidied(state)
        self.pattern = pattern
        corrected[6:12] = self.projected(pattern, corrected[:6], corrected[6:12])
        return corrected

    def guards(self, t, state):
        """Return the guards."""
        guards, scale = super().guards(t, state), self.pair.gravity * self.pair.upper.mass
        for key, base in self.compliant.items():
            view = View(self.pair, state[:6], state[6:12], key)
            for (what, side), value in base.guards(view, None).items():
                force = what in ("leave", "turn")
                guards["pad", key, (what, side)] = value / (scale if force else base.sunk)
        return guards

    def take(self, pattern):
        """Enter a pattern; after an impact compliant bases slip as the velocities say."""
        completed = self.with_points(pattern)
        touch, slips = self.touch(self.place, self.speed, self.touching(completed)), {}
        for key in self.compliant:
            i = INTERFACES.index(key)
            if completed[i].ends and not pattern[i].ends:
                rate = touch.along(key, HELD, self.speed, False)
                slow = 1e-13 * (1.0 + float(np.abs(self.speed).max()))
                slips[key] = int(math.copysign(1, rate)) if abs(rate) > slow else 0
        super().take(self.with_points(pattern, slips))

    def hit(self, key, end):
        """Close an end by an impact, after which pads may engage or separate at once."""
        super().hit(key, end)
        for base in self.compliant.values():
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
        """End small bounces, also those that alternately release and hold a base."""
        super()._rest()
        rates = {"ground": self.speed[2], "joint": self.speed[5] - self.speed[2]}
        (rigid,) = set(INTERFACES) - set(self.compliant)
        (key,) = self.compliant
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
        """Change the contact of an end on a pad or bed."""
        base, before = self.compliant[key], self.pattern
        event = base.switch(View(self.pair, self.place, self.speed, key), what, side, None)
        if event is None:
            return
        self.take(self.rigid_pattern(before))
        self.note(f"pad {event.lower()}", key, side, before)
        self.settle()
        if self.pattern[INTERFACES.index(key)].ends:
            view = View(self.pair, self.place, self.speed, key)
            _, answer = self.forces(self.now, self.state)
            base.wait(view, event, side, None, answer.motion)

    def answer(self, name):
        """Carry out an event; tell whether the run continues."""
        kind, key, end = name
        if kind != "pad":
            return super().answer(name)
        self.pad(key, *end)
        return not self.chatters()
