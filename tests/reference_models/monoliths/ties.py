"""A tie between a point of a body and one of the ground, for `two_spring`.

Per unit mass of the body. The tie is SLACK, TAUT, YIELDING, PRESSED (yielding as it is pressed)
or BROKEN; its dashpot acts both ways until it breaks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from . import Guard

CLEAR = 1e-14
STILL = 1e-13
SLACK, TAUT, YIELDING, PRESSED, BROKEN = "slack", "taut", "yielding", "pressed", "broken"


@dataclass
class Tie:
    """Point of the body from its centre of mass, and anchor from the middle of the base at rest."""

    point: tuple[float, float]
    anchor: tuple[float, float]
    stiffness: float
    damping: float = 0.0
    slack: float = 0.0
    preload: float = 0.0
    strength: float = math.inf
    brittle: bool = False
    compression: bool = False
    state: str = SLACK
    set: float = 0.0
    loss: float = 0.0

    def begin(self, height: float, z) -> None:
        """Set the natural length and the initial state."""
        self.set, self.loss = 0.0, 0.0
        dx, dy = self.point[0] - self.anchor[0], self.point[1] + height - self.anchor[1]
        self.height = height
        self.natural = math.hypot(dx, dy) + self.slack - self.preload / self.stiffness
        self.most = self.strength / self.stiffness
        x = self.length(z)[0] - self.natural
        # a tie that yielded on the way to the start begins to unload there
        if x > self.most:
            left = x - self.most + CLEAR * self.natural
            self.state, self.set = (BROKEN, 0.0) if self.brittle else (TAUT, left)
        elif self.compression and x < -self.most:
            left = x + self.most - CLEAR * self.natural
            self.state, self.set = (BROKEN, 0.0) if self.brittle else (TAUT, left)
        else:
            self.state = TAUT if x > 0.0 or self.compression else SLACK

    def length(self, z, xp=math):
        """Return length, its derivatives by rotation, height and place, rate and curvature term."""
        alpha, y, x, alpha_dot, y_dot, x_dot = z[:6]
        sine, cosine = xp.sin(alpha), xp.cos(alpha)
        px, py = self.point
        across, up = px * cosine + py * sine, py * cosine - px * sine
        dx, dy = x + across - self.anchor[0], self.height + y + up - self.anchor[1]
        vx, vy = x_dot + up * alpha_dot, y_dot - across * alpha_dot
        length = xp.sqrt(dx * dx + dy * dy)
        ux, uy = dx / length, dy / length
        rate = ux * vx + uy * vy
        bend = (vx * vx + vy * vy - rate * rate) / length
        bend = bend - (ux * across + uy * up) * alpha_dot**2
        return length, (ux * up - uy * across, uy, ux), rate, bend

    def tension(self, length, rate):
        """Return the force that pulls the body towards the anchor."""
        if self.state == BROKEN:
            return 0.0 * length
        x = {
            SLACK: 0.0 * length,
            TAUT: length - self.natural - self.set,
            YIELDING: self.most + 0.0 * length,
            PRESSED: -self.most + 0.0 * length,
        }[self.state]
        return self.stiffness * x + self.damping * rate

    def stored(self, z) -> float:
        """Return the energy of the spring."""
        if self.state in (SLACK, BROKEN):
            return 0.0
        x = self.most
        if self.state == TAUT:
            x = self.length(z)[0] - self.natural - self.set
        return 0.5 * self.stiffness * x * x

    def lost_power(self, rate: float) -> float:
        """Return the power dissipated by dashpot and yielding."""
        if self.state == BROKEN:
            return 0.0
        sign = {YIELDING: 1.0, PRESSED: -1.0}.get(self.state, 0.0)
        plastic = sign * self.stiffness * self.most * rate if sign else 0.0
        return self.damping * rate * rate + plastic

    def guards(self, number: int) -> list[Guard]:
        """Return the guards of the present state."""
        kinds = {SLACK: ("taut",), YIELDING: ("turn",), PRESSED: ("turn",), BROKEN: ()}
        some = list(kinds.get(self.state, ()))
        if self.state == TAUT:
            some += ["slack"] if not self.compression else []
            some += ["yield"] if math.isfinite(self.most) else []
            some += ["press"] if math.isfinite(self.most) and self.compression else []
        return [Guard(kind, str(number), strict=False) for kind in some]

    def value(self, kind, length, rate, acceleration):
        """Return a guard and its rate."""
        x = length - self.natural - self.set
        if kind == "turn":
            sign = 1.0 if self.state == YIELDING else -1.0
            return sign * rate, sign * acceleration
        return {
            "taut": (-x, -rate),
            "slack": (x, rate),
            "yield": (self.most - x, -rate),
            "press": (self.most + x, rate),
        }[kind]

    def switch(self, kind: str, z) -> None:
        """Change the state."""
        x = self.length(z)[0] - self.natural - self.set
        if kind == "turn":
            sign = 1.0 if self.state == YIELDING else -1.0
            # below its strength by more than rounding, so that it does not yield again
            self.set += x - sign * self.most + sign * CLEAR * self.natural
            self.state = TAUT
        elif kind in ("yield", "press") and self.brittle:
            self.loss += 0.5 * self.stiffness * x * x
            self.state = BROKEN
        else:
            names = {"taut": TAUT, "slack": SLACK, "yield": YIELDING, "press": PRESSED}
            self.state = names[kind]

    def turned(self, z) -> bool:
        """Whether a yielding tie has reversed."""
        sign = {YIELDING: 1.0, PRESSED: -1.0}.get(self.state, 0.0)
        return bool(sign * self.length(z)[2] < -STILL)


KINDS = ("taut", "slack", "yield", "press", "turn")
EVENTS = {
    "slack": "RESTRAINER_SLACK",
    "taut": "RESTRAINER_TAUT",
    "yield": "RESTRAINER_YIELD",
    "press": "RESTRAINER_YIELD",
    "turn": "RESTRAINER_UNLOADING",
}
"""Names in results for the end of a state of an unbroken tie."""


def event_of(tie, kind):
    """Return the name in results for the end of a state, before the switch."""
    return "RESTRAINER_FRACTURE" if kind in ("yield", "press") and tie.brittle else EVENTS[kind]


def turn_others(ties, z):
    """Unload reversed ties; return the event's name in results for each."""
    kinds = []
    for tie in ties:
        if tie.turned(z):
            kinds.append(event_of(tie, "turn"))
            tie.switch("turn", z)
    return kinds


def guards_of(ties, z):
    """Return the guards of all ties at a state of rotation, height and place, and their rates."""
    guards = {}
    for i, tie in enumerate(ties):
        length, _, rate, _ = tie.length(z)
        for guard in tie.guards(i):
            value = tie.value(guard.kind, length, rate, 0.0)[0]
            # a tie that yields as its body stops has not reversed yet
            guards["tie", i, guard.kind] = value + (STILL if guard.kind == "turn" else 0.0)
    return guards


def forces(ties, z, xp=np):
    """Return the generalised forces on rotation, height and place of all ties."""
    forces = [0.0, 0.0, 0.0]
    for tie in ties:
        length, way, rate, _ = tie.length(z, xp)
        pull = tie.tension(length, rate)
        for i in range(3):
            forces[i] = forces[i] - pull * way[i]
    return forces
