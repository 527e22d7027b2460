"""A block with Coulomb friction on two pads or on a bed, by SciPy; mass one.

Shares nothing with the package. The state is (x, y, a, x', y', a') of the centre of mass, from
its position upright under the weight; clockwise rotations are positive. The point of the base
selected by the restraint rule is held by a force within the friction cone, or slips against a
force on its edge. The forces of pads and bed follow from their compression.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from . import ties

MOST_EVENTS = 500
GAUSS = list(zip(*np.polynomial.legendre.leggauss(3), strict=True))
"""Nodes and weights."""


@dataclass
class Pads:
    """Two springs and dashpots, each with the contact of its corner."""

    stiffness: float
    damping: float
    restitution: float
    sunk: float = 0.0
    contact: dict = field(default_factory=lambda: {"L": "touching", "R": "touching"})

    def held(self, side):
        return self.contact[side] in ("touching", "engaging")

    def pressed(self, side, level, speed):
        """Return the force law of the pad, and its rate for an acceleration of the corner."""
        return self.stiffness * (self.sunk - level) - self.damping * speed

    def forces(self, block, z):
        pairs = []
        for side in "LR":
            level, speed, lever = block.corner(side, z)
            if self.contact[side] == "touching":
                pairs.append((self.pressed(side, level, speed), lever))
        return pairs

    def guards(self, block, z):
        guards = {}
        for side in "LR":
            level, speed, _ = block.corner(side, z)
            force, gap, now = (
                self.pressed(side, level, speed),
                level - self.sunk,
                self.contact[side],
            )
            if now == "touching":
                guards["leave", side] = force
            elif now == "clear":
                guards["land", side] = gap
            else:
                guards["clear", side] = -gap
                guards["turn", side] = -force if now in ("relaxing", "engaging") else force
                if now == "leaving":
                    guards["back", side] = speed
        return guards

    def switch(self, block, kind, side, z):
        """Return the event of a fallen guard, or None."""
        now = self.contact[side]
        if kind == "leave" or (kind == "clear" and now == "engaging"):
            below = kind == "leave" and self.damping > 0.0
            self.contact[side] = "relaxing" if below else "clear"
            return "SEPARATION"
        if kind == "clear":
            self.contact[side] = "clear"
            return None
        if kind == "land":
            self.contact[side] = "touching"
            return "IMPACT"
        if kind == "turn" and now in ("engaging", "leaving"):
            self.contact[side] = "touching" if now == "engaging" else "relaxing"
            return None
        self.contact[side] = "touching"
        return "REENGAGEMENT"

    def starting(self, level, speed, side):
        if level >= self.sunk:
            return "clear"
        return "touching" if self.pressed(side, level, speed) > 0.0 else "relaxing"

    def wait(self, block, event, side, z, a):
        """Delay a change that the new motion would undo at once."""
        _, speed, _ = block.corner(side, z)
        rate = -self.stiffness * speed - self.damping * block.corner_acceleration(side, z, a)
        if event == "SEPARATION" and rate > 0.0 and self.contact[side] == "relaxing":
            self.contact[side] = "leaving"
        if event == "REENGAGEMENT" and rate <= 0.0:
            self.contact[side] = "engaging"

    def eps(self):
        return self.restitution


@dataclass
class Bed:
    """Springs and dashpots along the base; parts above the unloaded level are free."""

    stiffness: float
    damping: float
    width: float
    sunk: float = 0.0
    contact: dict = field(default_factory=lambda: {"L": "touching", "R": "touching"})

    def held(self, side):
        return self.contact[side] == "touching"

    def forces(self, block, z):
        """By Gauss's rule over the bearing part, where all integrands are polynomials."""
        (l0, s0, m0), (l1, s1, m1) = block.corner("L", z), block.corner("R", z)
        u0, u1 = self.sunk - l0, self.sunk - l1
        first, last = 0.0, 1.0
        if not self.held("L"):
            first = u0 / (u0 - u1) if u0 != u1 else 1.0
        if not self.held("R"):
            last = u0 / (u0 - u1) if u0 != u1 else 0.0
        if last <= first or not (self.held("L") or self.held("R")):
            return []
        pairs = []
        for node, weight in GAUSS:
            p = first + 0.5 * (last - first) * (1.0 + node)
            pressure = self.stiffness * (u0 + p * (u1 - u0)) - self.damping * (s0 + p * (s1 - s0))
            pairs.append(
                (0.5 * weight * (last - first) * self.width * pressure, m0 + p * (m1 - m0))
            )
        return pairs

    def guards(self, block, z):
        return {
            ("end", side): (1.0 if self.held(side) else -1.0)
            * (self.sunk - block.corner(side, z)[0])
            for side in "LR"
        }

    def switch(self, block, kind, side, z):
        was = self.contact[side]
        self.contact[side] = "clear" if was == "touching" else "touching"
        return "SEPARATION" if was == "touching" else "REENGAGEMENT"

    def starting(self, level, speed, side):
        return "touching" if level < self.sunk else "clear"

    def wait(self, block, event, side, z, a):
        pass

    def eps(self):
        return 1.0


@dataclass
class Block:
    """The block, its base, and the ground's acceleration along and normal to that."""

    half: float
    height: float  # of the centre of mass
    inertia: float
    static: float
    kinetic: float
    gravity: float
    rule: str
    base: object
    times: np.ndarray
    along: np.ndarray
    normal: np.ndarray
    limits: tuple  # rotations to the left and to the right at which it overturns
    longest: float
    slip: int = 0  # 0 where it is held
    side: int = 0  # of the leading corner
    offset: float = 0.0
    events: list = field(default_factory=list)
    tied: list = field(default_factory=list)  # a `ties.Tie` each

    def seen_by_ties(self, z):
        """Rotation, height and place as ties have them, and their rates."""
        return z[2], z[1], z[0], z[5], z[4], z[3]

    def ground(self, t, piece):
        share = (t - self.times[piece]) / (self.times[piece + 1] - self.times[piece])
        return tuple(
            one[piece] + share * (one[piece + 1] - one[piece]) for one in (self.along, self.normal)
        )

    def corner(self, side, z):
        """Level above the upright position, speed and lever of a corner."""
        d = self.half if side == "R" else -self.half
        c, s = math.cos(z[2]), math.sin(z[2])
        lever = self.height * s - d * c
        return z[1] + self.height * (1.0 - c) - d * s, z[4] + lever * z[5], lever

    def corner_acceleration(self, side, z, a):
        d = self.half if side == "R" else -self.half
        c, s = math.cos(z[2]), math.sin(z[2])
        return a[1] + (self.height * s - d * c) * a[2] + (self.height * c + d * s) * z[5] ** 2

    def flies(self):
        return not (self.base.held("L") or self.base.held("R"))

    def point(self):
        """Distance of the held (or slipping) point to the right of the middle."""
        if self.flies() or self.rule == "centre":
            return 0.0
        if self.rule == "leading-corner":
            return self.side * self.half
        return self.half * (int(self.base.held("R")) - int(self.base.held("L"))) * 1.0

    def arm(self, z):
        e, c, s = self.point(), math.cos(z[2]), math.sin(z[2])
        return self.height * c + e * s, e * c - self.height * s

    def place(self, z):
        """Of that point, along the ground."""
        e = self.point()
        return z[0] - self.height * math.sin(z[2]) + e * math.cos(z[2])

    def slip_speed(self, z):
        return z[3] - self.arm(z)[0] * z[5]

    def motion(self, z, ground):
        """Return the accelerations, the force along the base and the force that presses it."""
        forces = self.base.forces(self, z)
        pressing = sum(one for one, _ in forces)
        moment = sum(one * lever for one, lever in forces)
        turning, lift, across = ties.forces(self.tied, self.seen_by_ties(z), math)
        up, moment = pressing - self.gravity - ground[1] + lift, moment + turning
        if self.flies():
            return (across - ground[0], up, moment / self.inertia), 0.0, 0.0
        r, bend = self.arm(z)
        if self.slip:
            h = -self.slip * self.kinetic * max(pressing, 0.0)
            return (h + across - ground[0], up, (moment - r * h) / self.inertia), h, pressing
        # x'' = r a'' + bend a'^2, x'' = H - ground, I a'' = moment - r H
        matrix = np.array([[1.0, -r, 0.0], [1.0, 0.0, -1.0], [0.0, self.inertia, r]])
        x, turning, h = np.linalg.solve(matrix, [bend * z[5] ** 2, across - ground[0], moment])
        return (x, up, turning), h, pressing

    def guards(self, z, ground):
        guards = self.base.guards(self, z) | ties.guards_of(self.tied, self.seen_by_ties(z))
        if self.rule == "leading-corner" and self.side and not self.flies():
            guards["pivot", ""] = self.side * z[2]
        if self.flies():
            return guards
        if self.slip:
            # rounding must not end a slip that starts
            guards["slip", ""] = self.slip * self.slip_speed(z) + 1e-14
        else:
            _, h, pressing = self.motion(z, ground)
            guards["hold", ""] = self.static * max(pressing, 0.0) - abs(h)
        return guards

    def decide(self, z, ground, lets_go=False):
        """Hold the point, or let it slip."""
        if self.flies():
            self.slip = 0
            return
        speed = self.slip_speed(z)
        if abs(speed) > 1e-13 * (1.0 + abs(z[3])):
            self.slip = int(math.copysign(1, speed))
            return
        z[3] -= speed
        self.slip = 0
        _, h, pressing = self.motion(z, ground)
        if lets_go or abs(h) > self.static * max(pressing, 0.0) + 1e-10:
            self.slip = -int(math.copysign(1, h))

    def impulse(self, side, z):
        """Reduce the speed of a corner by stepping through the impulse (Routh)."""
        _, speed, lever = self.corner(side, z)
        if speed >= 0.0:
            return
        goal = self.base.eps() * speed
        r = self.arm(z)[0]
        inverse = np.array([1.0, 1.0, 1.0 / self.inertia])
        normal, tangent = np.array([0.0, 1.0, lever]), np.array([1.0, 0.0, -r])
        v = np.array(z[3:])
        for _ in range(3):
            slip, sink = tangent @ v, normal @ v - goal
            moves = abs(slip) > 1e-13
            if moves:
                ratio = -self.kinetic * math.copysign(1, slip)
            else:
                ratio = -(tangent * inverse @ normal) / (tangent * inverse @ tangent)
                ratio = min(max(ratio, -self.kinetic), self.kinetic)
            push = inverse * (normal + ratio * tangent)
            ends = -sink / (normal @ push) if normal @ push > 0.0 else math.inf
            stops = -slip / (tangent @ push) if moves else math.inf
            if not 0.0 < stops < ends:
                v = v + ends * push
                break
            v = v + stops * push
            v -= inverse * tangent * (tangent @ v) / (tangent * inverse @ tangent)
        z[3:] = v

    def tie_ends(self, i, kind, z, ground, t):
        """Change the state of a tie."""
        tie = self.tied[i]
        self.events.append((t, ties.event_of(tie, kind)))
        tie.switch(kind, self.seen_by_ties(z))
        if tie.state == ties.BROKEN:
            self.decide(z, ground)

    def fell(self, kind, side, z, ground, t):
        """Carry out the change of a fallen guard."""
        was, before = self.slip, self.place(z)
        if kind in ("hold", "slip"):
            if kind == "slip":
                z[3] -= self.slip_speed(z)
            self.decide(z, ground, lets_go=kind == "hold")
            if self.slip != was:
                name = "STICK" if not self.slip else "SLIP" if not was else "SLIP_REVERSAL"
                self.events.append((t, name))
            return
        if kind == "pivot":
            z[2], self.side, event = 0.0, -self.side, "PIVOT_CHANGE"
        else:
            flew = self.flies()
            event = self.base.switch(self, kind, side, z)
            if kind in ("land", "clear", "end"):
                z[1] += self.base.sunk - self.corner(side, z)[0]
            if event is None:
                return
            if self.rule == "leading-corner" and flew:
                self.side = int(math.copysign(1, z[2]))
        self.offset += before - self.place(z)
        if event == "IMPACT" and self.base.eps() < 1.0:
            self.impulse(side, z)
        self.decide(z, ground)
        if kind != "pivot" and not self.flies():
            self.base.wait(self, event, side, z, self.motion(z, ground)[0])
        self.events.append((t, event))

    def simulate(self, z, duration, rtol=1e-11):
        """Integrate from a state at rest; return peaks of rotation and slip, and the events."""
        z = np.array(z, dtype=float)
        self.side = 0 if z[2] == 0.0 else int(math.copysign(1, z[2]))
        for tie in self.tied:
            tie.begin(self.height, self.seen_by_ties(z))
        for one in "LR":
            self.base.contact[one] = self.base.starting(*self.corner(one, z)[:2], one)
        self.offset = -self.place(z)
        t, piece, peak, peak_slip, overturned = 0.0, 0, abs(z[2]), 0.0, False
        self.slip, pieces = 0, 0
        while t < duration - 1e-12 and not overturned:
            while self.times[piece + 1] <= t + 1e-13:
                piece += 1
            ground = self.ground(t, piece)
            if self.rule == "leading-corner" and not self.side:
                lean = z[2] or z[5] or -ground[0] or -(self.along[piece + 1] - ground[0])
                self.side = int(math.copysign(1, lean))
                self.offset = -self.place(z)
            # an impulse, or a jump of the ground, may have taken a guard beyond zero
            for name in (
                ("leave", "L"),
                ("leave", "R"),
                ("turn", "L"),
                ("turn", "R"),
                ("hold", ""),
            ):
                if self.guards(z, ground).get(name, 1.0) < -1e-9:
                    self.fell(*name, z, ground, t)
            end = min(self.times[piece + 1], duration)
            names = list(self.guards(z, self.ground(t, piece)))

            last = [None, {}]

            def event(name, piece=piece, last=last):
                def guard(time, state):
                    at = time, *state
                    if at != last[0]:  # all event functions are evaluated at the same points
                        last[:] = at, self.guards(state, self.ground(time, piece))
                    return last[1][name]

                guard.terminal, guard.direction = True, -1.0
                return guard

            def limit(time, state):
                return self.limits[int(state[2] > 0.0)] - abs(state[2])

            limit.terminal, limit.direction = True, -1.0

            def rate(time, state, piece=piece):
                return [*state[3:], *self.motion(state, self.ground(time, piece))[0]]

            ran = solve_ivp(
                rate, (t, end), z, method="DOP853", rtol=rtol, atol=1e-14, max_step=self.longest,
                first_step=min(end - t, 1e-9), dense_output=True,
                events=[*map(event, names), limit],
            )  # fmt: skip
            turns = np.flatnonzero(ran.y[5, :-1] * ran.y[5, 1:] < 0.0)
            for i in turns:
                inside = np.linspace(ran.t[i], ran.t[i + 1], 41)
                values = np.abs(ran.sol(inside)[2])
                k = int(np.clip(values.argmax(), 1, 39))
                fit = np.polyfit(inside[k - 1 : k + 2] - inside[k], values[k - 1 : k + 2], 2)
                peak = max(peak, float(fit[2] - fit[1] ** 2 / (4.0 * fit[0])))
            peak = max(peak, float(np.abs(ran.y[2]).max()))
            t, z = float(ran.t[-1]), ran.y[:, -1].copy()
            if not self.flies():
                peak_slip = max(peak_slip, abs(self.offset + self.place(z)))
            if ran.status == 1:
                hit = next(k for k, times in enumerate(ran.t_events) if len(times))
                if hit == len(names):
                    overturned = True
                    self.events.append((t, "OVERTURNING"))
                    break
                if names[hit][0] == "tie":
                    self.tie_ends(*names[hit][1:], z, self.ground(t, piece), t)
                else:
                    self.fell(*names[hit], z, self.ground(t, piece), t)
                if not self.flies():  # it may have landed
                    peak_slip = max(peak_slip, abs(self.offset + self.place(z)))
                turned = ties.turn_others(self.tied, self.seen_by_ties(z))
                self.events += [(t, one) for one in turned]
            pieces += 1
            if pieces > MOST_EVENTS:
                msg = "too many events"
                raise RuntimeError(msg)
        return {"peak": peak, "peak_slip": peak_slip, "slip": self.offset + self.place(z),
                "events": self.events, "overturned": overturned}  # fmt: skip
