"""A rocking block on two bilinear pads with plastic set, integrated independently.

Mass is one. Signs: x right, y up, rotation clockwise (the left corner rises). The state is
(alpha, y, x, alpha', y', x', z_L, z_R): the sets z are those of the pads.

A pad is compressed by u, from its unloaded level before the run. Its spring pushes with
``k (u - z)``, its dashpot beside it with ``c u'``. The spring yields where its force reaches
``F + H z`` with ``H = r k / (1 - r)``; as the pad sinks further the force stays on that line,
``k (u' - z') = H z'``, so that ``z' = (1 - r) u'`` and the stiffness is r k. Once the pad
sinks no further it unloads with the stiffness k.

A touching corner leaves where the force of its pad falls through zero. It is then relaxing (its
pad follows it, and the spring feeds the dashpot), and touches again where that force would be
positive; above the unloaded level, ``u = z``, it is clear, and lands on that level with an impact.
A corner slowed down by its own re-pinning (leaving), or sped up by it (engaging), bears no force
until the sign of its pad's force is right again. Corners that would slide raise an error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from . import SIMULTANEOUS, Drive, Guard, crossings, stepper

TOUCHING, ENGAGING, RELAXING, LEAVING, CLEAR = range(5)
HELD = (TOUCHING, ENGAGING)
SUBDIVISIONS = 8
ROUNDS = 40
DT = SIMULTANEOUS


class BeyondError(RuntimeError):
    """A motion outside this model: a corner slides, or contact changes endlessly."""


@dataclass
class Result:
    """Samples and events."""

    rotation: np.ndarray
    vertical: np.ndarray
    horizontal: np.ndarray
    left_set: np.ndarray
    right_set: np.ndarray
    events: list[tuple[float, str, str]] = field(default_factory=list)
    overturned: bool = False

    def count(self, kind: str) -> int:
        """Return the number of events of a kind."""
        return sum(what == kind for _, what, _ in self.events)


@dataclass
class _Corner:
    """One corner at one instant: compression, rates upwards, force of the spring and of the pad."""

    u: np.ndarray
    rate: np.ndarray
    acceleration: np.ndarray
    set: np.ndarray
    spring: np.ndarray
    force: np.ndarray
    force_rate: np.ndarray


class _Block:
    def __init__(
        self, half_width, half_height, frequency_ratio, damping_ratio, strength, hardening,
        restitution, restraint, gravity,
    ):  # fmt: skip
        if restraint not in ("centre", "contact-state"):
            msg = f"unknown restraint {restraint!r}"
            raise ValueError(msg)
        self.b, self.h, self.g, self.r = half_width, half_height, gravity, hardening
        square = half_width**2 + half_height**2
        self.inertia = square / 3.0
        self.theta = math.atan2(half_width, half_height)
        omega_v = frequency_ratio * math.sqrt(0.75 * gravity / math.sqrt(square))
        self.k, self.c = 0.5 * omega_v**2, damping_ratio * omega_v
        self.delta = 0.5 * gravity / self.k
        self.period = 2.0 * math.pi / omega_v
        self.strength = strength * gravity
        greatest = 0.25 * (1.0 + 3.0 * math.cos(2.0 * self.theta))
        self.eps = greatest if restitution is None else restitution
        self.follows_contact = restraint == "contact-state"
        self.state = {"L": TOUCHING, "R": TOUCHING}
        self.yields = {"L": False, "R": False}
        self.guards: list[Guard] = []
        self.events: list[tuple[float, str, str]] = []
        self.ground_x = self.ground_y = lambda t: 0.0 * t

    # motion -----------------------------------------------------------------------------------
    @property
    def flies(self):
        return not any(state in HELD for state in self.state.values())

    def held_point(self):
        """Return e, or None in flight."""
        if self.flies:
            return None
        left, right = (self.state[name] in HELD for name in "LR")
        return 0.0 if left == right or not self.follows_contact else self.b * (right - left)

    def lever(self, alpha, e, xp=math):
        """First and second derivative of x by the rotation, about the held point."""
        sine, cosine = xp.sin(alpha), xp.cos(alpha)
        return self.h * cosine + e * sine, e * cosine - self.h * sine

    def corner(self, name, alpha, xp=math):
        """Rise of a corner less that of the centre of mass, and its derivatives by the rotation."""
        b, sine, cosine = (self.b if name == "L" else -self.b), xp.sin(alpha), xp.cos(alpha)
        h = self.h
        return h * (1.0 - cosine) + b * sine, h * sine + b * cosine, h * cosine - b * sine

    def motion(self, t, q, xp=math):
        """Return the accelerations (alpha, y, x), and both corners."""
        alpha, y, _, alpha_dot, y_dot, _, *sets = q
        ends, upward, moment = {}, 0.0 * alpha, 0.0 * alpha
        for name, plastic in zip("LR", sets, strict=True):
            rise, arm, _ = self.corner(name, alpha, xp)
            u, rate = self.delta - y - rise, y_dot + arm * alpha_dot
            spring = self.k * (u - plastic)
            force = spring - self.c * rate
            ends[name] = u, rate, plastic, spring, force
            if self.state[name] == TOUCHING:
                upward = upward + force
                moment = moment + force * arm
        ground_x, ground_y = self.ground_x(t), self.ground_y(t)
        y_acc = upward - self.g - ground_y
        e = self.held_point()
        if e is None:
            alpha_acc, x_acc = 0.0 * alpha, -ground_x
        else:
            # x = x(alpha) turns the horizontal reaction H = x'' + x_g'' into a moment, -x_1 H
            x_1, x_2 = self.lever(alpha, e, xp)
            push = x_1 * (ground_x + x_2 * alpha_dot**2)
            alpha_acc = (moment - push) / (self.inertia + x_1**2)
            x_acc = x_1 * alpha_acc + x_2 * alpha_dot**2
        corners = {}
        for name, (u, rate, plastic, spring, force) in ends.items():
            _, arm, bend = self.corner(name, alpha, xp)
            acceleration = y_acc + arm * alpha_acc + bend * alpha_dot**2
            soft = self.r if self.yields[name] else 1.0
            force_rate = -soft * self.k * rate - self.c * acceleration
            corners[name] = _Corner(u, rate, acceleration, plastic, spring, force, force_rate)
        return (alpha_acc, y_acc, x_acc), corners

    def slope(self, t, q):
        (alpha_acc, y_acc, x_acc), corners = self.motion(t, q)
        e = self.held_point()
        x_dot = q[5] if e is None else self.lever(q[0], e)[0] * q[3]
        flow = [-(1.0 - self.r) * corners[name].rate if self.yields[name] else 0.0 for name in "LR"]
        return [q[3], q[4], x_dot, alpha_acc, y_acc, x_acc, *flow]

    # guards -----------------------------------------------------------------------------------
    def set_guards(self):
        kinds = {
            TOUCHING: ("leave",),
            ENGAGING: ("clear", "press"),
            RELAXING: ("clear", "engage"),
            LEAVING: ("clear", "relax", "settle"),
            CLEAR: ("land",),
        }
        self.guards = [Guard("topple", side, strict=False) for side in "+-"]
        for name in "LR":
            own = kinds[self.state[name]]
            if self.state[name] == TOUCHING:
                own = (*own, "unload" if self.yields[name] else "yield")
            self.guards += [Guard(kind, name, strict=False) for kind in own]

    def guard_values(self, t, q, xp=math):
        _, corners = self.motion(t, q, xp)
        guards = []
        for guard in self.guards:
            if guard.kind == "topple":
                sign = 1.0 if guard.where == "+" else -1.0
                guards.append((self.theta - sign * q[0], -sign * q[3]))
                continue
            end = corners[guard.where]
            guards.append(
                {
                    "leave": (end.force, end.force_rate),
                    "relax": (end.force, end.force_rate),
                    "engage": (-end.force, -end.force_rate),
                    "press": (-end.force, -end.force_rate),
                    "settle": (end.rate, end.acceleration),
                    "clear": (end.u - end.set, -end.rate),
                    "land": (end.set - end.u, end.rate),
                    "yield": (self.slack(end), self.k * end.rate),
                    "unload": (-end.rate, -end.acceleration),
                }[guard.kind]
            )
        return guards

    def slack(self, end):
        """Return the distance of the spring's force from its yield line."""
        return self.strength + self.r * self.k / (1.0 - self.r) * end.set - end.spring

    def due(self, t, q):
        """List the changes that are due in a state."""
        changes = []
        _, corners = self.motion(t, q)
        for name, end in corners.items():
            state, falls = self.state[name], end.force + DT * end.force_rate < 0.0
            if state == TOUCHING:
                near = abs(end.force) <= DT * abs(end.force_rate)
                on_line = self.slack(end) <= DT * self.k * abs(end.rate)
                sinks = end.rate + DT * end.acceleration < 0.0
                if falls and (near or end.force < 0.0):
                    changes.append(("leave", name))
                elif self.yields[name] and end.rate > DT * abs(end.acceleration):
                    changes.append(("unload", name))
                elif not self.yields[name] and on_line and sinks:
                    changes.append(("yield", name))
            elif state in (RELAXING, LEAVING):
                if end.rate > 0.0 and end.u - end.set <= DT * end.rate:
                    changes.append(("clear", name))
                elif state == RELAXING and end.force > DT * abs(end.force_rate):
                    changes.append(("engage", name))
        return changes

    # jumps ------------------------------------------------------------------------------------
    def repin(self, q, sway):
        """Stop the slip of the newly held point by a horizontal impulse there."""
        e = self.held_point()
        if e is None:
            q[5] = sway
            return
        x_1, _ = self.lever(q[0], e)
        q[3] = (self.inertia * q[3] + x_1 * sway) / (self.inertia + x_1**2)
        q[5] = x_1 * q[3]

    def strike(self, q, name):
        """Multiply the speed of a landing corner by eps."""
        _, arm, _ = self.corner(name, q[0])
        x_1, _ = self.lever(q[0], self.held_point())
        inertia = self.inertia + x_1**2
        speed = q[4] + arm * q[3]
        if speed >= 0.0:
            return
        impulse = -(1.0 - self.eps) * speed / (1.0 + arm**2 / inertia)
        q[3] += impulse * arm / inertia
        q[4] += impulse
        q[5] = x_1 * q[3]

    def change(self, t, q, kind, name):
        """Carry out one change."""
        self.events.append((t, kind, name))
        if kind in ("yield", "unload"):
            self.yields[name] = kind == "yield"
            return
        old, flew = self.held_point(), self.flies
        sway = q[5] if flew else self.lever(q[0], old)[0] * q[3]
        other = "R" if name == "L" else "L"
        _, corners = self.motion(t, q)
        end = corners[name]
        if kind == "leave":
            self.yields[name] = False
            below = self.c > 0.0 and end.u - end.set > DT * abs(end.rate)
            self.state[name] = RELAXING if below else CLEAR
            if self.state[other] in (ENGAGING, LEAVING):
                self.state[other] = RELAXING
        else:
            self.state[name] = {"clear": CLEAR, "relax": RELAXING}.get(kind, TOUCHING)
            if kind in ("land", "engage", "settle") and self.state[other] == LEAVING:
                self.state[other] = RELAXING
        now = self.held_point()
        if now != old:
            speed = end.rate
            self.repin(q, sway)
            _, corners = self.motion(t, q)
            end = corners[name]
            if flew and end.rate > max(speed, 0.0):
                msg = f"the corner that comes down at {t} is lifted as the block is held"
                raise BeyondError(msg)
            if kind == "leave" and self.state[name] == RELAXING and end.force > 0.0:
                self.state[name] = LEAVING
        if kind == "leave" and self.flies and not flew:
            presses = -self.k * end.rate - self.c * end.acceleration > 0.0
            if presses and self.state[name] != CLEAR:
                msg = f"the corner that leaves at {t} would be pressed at once in flight"
                raise BeyondError(msg)
        if kind == "land":
            if abs(corners[other].u - corners[other].set) < 1e-9 * self.delta:
                msg = f"both corners land at {t}"
                raise BeyondError(msg)
            self.strike(q, name)
        elif kind in ("engage", "settle") and end.force < 0.0 and now != old:
            self.state[name] = ENGAGING

    def switch(self, t, q, changes):
        """Carry out the changes that fired, and those that follow at the same instant."""
        for _ in range(ROUNDS):
            for kind, name in changes:
                if kind == "topple":
                    return True
                self.change(t, q, kind, name)
            changes = self.due(t, q)[:1]
            if not changes:
                self.set_guards()
                return False
        msg = f"contact does not settle at {t}"
        raise BeyondError(msg)


def simulate(
    *, half_width, half_height, frequency_ratio, damping_ratio, strength, hardening,
    duration, sample_times, restitution=None, restraint="centre", gravity=9.80665,
    time_step=None, acceleration=None, vertical=None, breakpoints=(), rtol=1e-12, atol=1e-14,
    steps_per_period=40.0,
) -> Result:  # fmt: skip
    """Integrate a block that starts at rest; strength is over the weight.

    A sampled acceleration is linear between its samples and zero after the last. A function
    of time is smooth between the given breakpoints.
    """
    run = _Block(
        half_width, half_height, frequency_ratio, damping_ratio, strength, hardening, restitution,
        restraint, gravity,
    )  # fmt: skip
    drive = Drive(
        acceleration=acceleration, vertical=vertical, time_step=time_step,
        breakpoints=breakpoints, duration=duration, restart_every_knot=True,
    )  # fmt: skip
    samples = np.asarray(sample_times, dtype=float)
    table = np.full((8, samples.size), np.nan)
    filled, overturned, now, q = 0, False, 0.0, np.zeros(8)
    run.set_guards()
    for start, stop, run.ground_x, run.ground_y in drive.pieces():
        now = start
        while now < stop and not overturned:
            solver = stepper(
                run.slope, now, q, stop, max_step=run.period / steps_per_period, rtol=rtol,
                atol=atol,
            )  # fmt: skip
            while solver.status == "running":
                solver.step()
                if solver.status == "failed":
                    msg = f"integration failed at {now}"
                    raise RuntimeError(msg)
                dense = solver.dense_output()
                times = np.linspace(solver.t_old, solver.t, SUBDIVISIONS + 1)
                pairs = run.guard_values(times, dense(times), np)
                hits = crossings(
                    run.guards, [one[0] for one in pairs], [one[1] for one in pairs], times,
                    lambda i, t, dense=dense: run.guard_values(t, dense(t))[i],
                )  # fmt: skip
                first = min((hit for hit in hits if hit is not None), default=None)
                now = solver.t if first is None else first
                while filled < samples.size and (
                    samples[filled] < now or (first is None and samples[filled] == now)
                ):
                    table[:, filled] = dense(samples[filled])
                    filled += 1
                if first is None:
                    q = solver.y.copy()
                    continue
                q = dense(first).copy()
                guards = zip(run.guards, hits, strict=True)
                changes = [(one.kind, one.where) for one, hit in guards if hit == first]
                overturned = run.switch(first, q, changes)
                break
        if overturned:
            break
    if filled < samples.size and not overturned:
        table[:, filled:] = q[:, None]
    return Result(*table[:3], *table[6:], events=run.events, overturned=overturned)
