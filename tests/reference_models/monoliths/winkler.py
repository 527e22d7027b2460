"""A rigid body on a Winkler bed, integrated independently.

Signs: x right, y up, rotation clockwise (the left end rises). The state is (alpha, y, x,
alpha', y', x', work of the dashpots, work of the ground); works and energies are per unit
mass until the result is written. No closed forms are used: the bearing part of the base follows
from the depth and the pressure at its two ends, both linear along the base, and force, moment and
power are integrated over it by Gauss-Legendre quadrature.

An end of the base is TOUCHING (it bears), RELAXING (below its unloaded level, but its own
dashpot would pull: the pressure rule only) or CLEAR (above). Both ends bear: "full"; one:
"left" or "right"; nothing bears anywhere: "flight". Under the pressure rule a stretch that
reaches neither end may bear: the body then stays held by the end that bore last, or by its lower
end after a flight.

Re-pinning changes the rates a little, and with them the pressures. An end that has just left
may thus have a slightly positive pressure: it re-engages only after its pressure has been
negative, or when it stops rising. An end that has just re-engaged may have a slightly negative
pressure: it stays, and may leave once its pressure has been positive or it has reached its
unloaded level. This concerns only the held point; the bearing part always follows from depth and
pressure.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from . import SIMULTANEOUS, Drive, Guard, crossings, polish, stepper

TOUCHING, RELAXING, CLEAR = "touching", "relaxing", "clear"
GAUSS = tuple(
    (float(s), float(w)) for s, w in zip(*np.polynomial.legendre.leggauss(3), strict=True)
)
"""Three points: every integrand here is at most quadratic along the base."""
RULES = ("contact-state", "leading-corner", "centre")
ORDER = ("topple", "side", "leave", "slip", "clear", "engage", "settle", "land", "cut")
SUBDIVISIONS = 8
CASCADE = 60
CHATTER = 80
TINY = 1e-300


class ChatterError(RuntimeError):
    """Endless contact changes.

    With the body held as in full contact an end pulls, held by the other end it presses, so that
    each re-pinning undoes the last. Then no motion obeys the rules. This needs a rotation of about
    0.1 and a correspondingly soft bed.
    """


@dataclass
class Event:
    """One change of contact or of the leading corner, or an overturning.

    ``before`` and ``after`` are (alpha, y, x, alpha', y', x').
    """

    time: float
    kind: str
    corners: str
    contact_before: str
    contact_after: str
    before: tuple[float, ...]
    after: tuple[float, ...]
    repinning_loss: float = 0.0


@dataclass
class Result:
    """Samples, events and energy balance of one run.

    Samples after the end of the run are NaN, the contact there is an empty string. At the
    instant of an event the samples are those after it. Energies are in joules.
    """

    time: np.ndarray
    rotation: np.ndarray
    vertical: np.ndarray
    horizontal: np.ndarray
    rotation_rate: np.ndarray
    vertical_rate: np.ndarray
    horizontal_rate: np.ndarray
    contact_length: np.ndarray
    contact: np.ndarray
    events: list[Event] = field(default_factory=list)
    peak_rotation: float = 0.0
    flight_time: float = 0.0
    flight_count: int = 0
    overturned: bool = False
    overturning_time: float | None = None
    end_time: float = 0.0
    dashpot_work: float = 0.0
    input_work: float = 0.0
    repinning_loss: float = 0.0
    initial_energy: float = 0.0
    final_energy: float = 0.0
    energy_residual: float = 0.0


# the bed ------------------------------------------------------------------------------------


class End(NamedTuple):
    """One end of the base: depth, derivatives of its rise, and pressure if in contact."""

    depth: float
    rate: float
    pressure: float
    arm: float
    bend: float


class Bed:
    """Springs and dashpots spread along the base; contact by depth, or by depth and pressure."""

    def __init__(
        self, *, half_width, height, stiffness, damping, settlement, separation, finite=True
    ):
        if separation not in ("displacement", "pressure"):
            msg = f"unknown separation {separation!r}"
            raise ValueError(msg)
        self.b, self.h = half_width, height
        self.k, self.c, self.delta = stiffness, damping, settlement
        # without dashpots the two rules coincide
        self.by_pressure = separation == "pressure" and damping > 0.0
        self.finite = finite
        self.end = {"L": TOUCHING, "R": TOUCHING}
        self.pressed = {"L": True, "R": True}
        self.cross_positive = False
        self.bounds: tuple[str, str] | None = ("end", "end")

    def frame(self, alpha, y, xp=math):
        """Return the middle of the base, and the terms of the rises and levers of its points."""
        if self.finite:
            sine, cosine = xp.sin(alpha), xp.cos(alpha)
            return y + self.h * (1.0 - cosine), sine, cosine, sine
        return y + 0.5 * self.h * alpha * alpha, alpha, 1.0, 0.0

    def ends(self, alpha, y, alpha_dot, y_dot, xp=math) -> dict[str, End]:
        middle, sine, cosine, lean = self.frame(alpha, y, xp)
        out = {}
        for name, s in (("L", -self.b), ("R", self.b)):
            arm = self.h * sine - s * cosine
            rate = y_dot + arm * alpha_dot
            depth = self.delta - (middle - s * sine)
            pressure = self.k * depth - self.c * rate
            out[name] = End(depth, rate, pressure, arm, self.h * cosine + s * lean)
        return out

    def root(self, left, right, xp=math):
        """Find where a linear quantity vanishes, kept near the base during trial steps."""
        gap = left - right
        if xp is math:
            return self.b * min(2.0, max(-2.0, (left + right) / (gap or TINY)))
        return self.b * np.clip((left + right) / np.where(gap == 0.0, TINY, gap), -2.0, 2.0)

    def place(self, bounds, ends, xp=math):
        """Return the coordinates of a stretch of the base from the kinds of its two bounds."""
        left, right = ends["L"], ends["R"]
        at = {"level": (left.depth, right.depth), "pressure": (left.pressure, right.pressure)}
        low, high = (
            side * self.b if kind == "end" else self.root(*at[kind], xp)
            for kind, side in zip(bounds, (-1.0, 1.0), strict=True)
        )
        return low, high

    def below(self) -> tuple[str, str] | None:
        """Return the bounds of the stretch below the unloaded level."""
        left, right = (self.end[name] != CLEAR for name in "LR")
        if not (left or right):
            return None
        return "end" if left else "level", "end" if right else "level"

    def sum_up(self, bounds, ends, alpha, y, alpha_dot, y_dot, xp=math):
        """Integrate pressure, its moment, and the powers of dashpots and of released springs."""
        low, high = self.place(bounds, ends, xp)
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        up, sine, cosine, _ = self.frame(alpha, y, xp)
        lift = moment = viscous = relaxing = 0.0
        for node, weight in GAUSS:
            s, share = middle + half * node, half * weight
            arm = self.h * sine - s * cosine
            rate = y_dot + arm * alpha_dot
            elastic = self.k * (self.delta - up + s * sine)
            force = share * (elastic - self.c * rate)
            lift = lift + force
            moment = moment + force * arm
            viscous = viscous + share * self.c * rate * rate
            relaxing = relaxing + share * elastic * rate
        return lift, moment, viscous, relaxing

    def resultants(self, ends, alpha, y, alpha_dot, y_dot, xp=math):
        """Return lift, moment about the centre of mass, and power of the dashpots."""
        lift = moment = dissipated = 0.0 * alpha
        motion = (alpha, y, alpha_dot, y_dot, xp)
        below = self.below()
        if self.bounds is not None:
            lift, moment, dissipated, relaxing = self.sum_up(self.bounds, ends, *motion)
            dissipated = dissipated - relaxing if self.by_pressure else dissipated
        if self.by_pressure and below is not None:
            dissipated = dissipated + self.sum_up(below, ends, *motion)[3]
        return lift, moment, dissipated

    def energy(self, alpha, y):
        """Integrate the energy of all springs that are below their unloaded level."""
        ends = self.ends(alpha, y, 0.0, 0.0)
        left, right = (ends[name].depth > 0.0 for name in "LR")
        if not (left or right):
            return 0.0
        low, high = self.place(("end" if left else "level", "end" if right else "level"), ends)
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        up, sine, *_ = self.frame(alpha, y)
        depths = [(self.delta - up + (middle + half * s) * sine, half * w) for s, w in GAUSS]
        return sum(0.5 * self.k * share * depth * depth for depth, share in depths)

    def rest(self, alpha, weight):
        """Find the y at which the bed, at rest under this rotation, carries the weight."""

        def excess(y):
            ends = self.ends(alpha, y, 0.0, 0.0)
            left, right = (ends[name].depth > 0.0 for name in "LR")
            if not (left or right):
                return -weight
            bounds = ("end" if left else "level", "end" if right else "level")
            return self.sum_up(bounds, ends, alpha, y, 0.0, 0.0)[0] - weight

        up, sine, *_ = self.frame(alpha, 0.0)
        tip = self.b * abs(sine)
        return brentq(
            excess,
            -up - tip - self.delta * (1.0 + weight / (2.0 * self.b * self.k * self.delta)),
            self.delta - up + tip,
            xtol=1e-16,
            rtol=1e-15,
        )

    # the bearing part under the pressure rule ------------------------------------------------
    def cross(self, ends, accelerations):
        """Return the quantity whose sign orders two roots (see ``read``), and its rate."""
        left, right = ends["L"], ends["R"]
        value = left.depth * right.pressure - right.depth * left.pressure
        rate = (
            -left.rate * right.pressure
            + left.depth * self.pressure_rate(right, accelerations["R"])
            + right.rate * left.pressure
            - right.depth * self.pressure_rate(left, accelerations["L"])
        )
        return value, rate

    def pressure_rate(self, end, acceleration):
        return -self.k * end.rate - self.c * acceleration

    def read(self, ends, accelerations) -> None:
        """Find the bearing part and its bounds, valid until a sign changes."""
        if not self.by_pressure:
            self.bounds = self.below()
            return
        for name in "LR":
            rate = self.pressure_rate(ends[name], accelerations[name])
            self.pressed[name] = _positive(ends[name].pressure, rate)
        self.cross_positive = _positive(*self.cross(ends, accelerations))
        deep_left, deep_right = (self.end[name] != CLEAR for name in "LR")
        press_left, press_right = self.pressed["L"], self.pressed["R"]
        self.bounds = None
        if not (deep_left or deep_right) or not (press_left or press_right):
            return
        # with depth and pressure d and p at the ends, the roots compare as d_L p_R and d_R p_L
        low = high = "end"
        if not (deep_left and press_left):
            low = "level" if press_left else "pressure"
            if not (deep_left or press_left):
                low = "pressure" if self.cross_positive else "level"
        if not (deep_right and press_right):
            high = "level" if press_right else "pressure"
            if not (deep_right or press_right):
                high = "level" if self.cross_positive else "pressure"
        if low != "end" and high != "end" and self.cross_positive != deep_left:
            return
        self.bounds = (low, high)

    def cut_guards(self) -> list[Guard]:
        if not self.by_pressure:
            return []
        guards = [Guard("cut", name, strict=False) for name in "LR"]
        if self.pressed["L"] != self.pressed["R"] and CLEAR in self.end.values():
            guards.append(Guard("cut", "X", strict=False))
        return guards

    def cut_value(self, where, ends, accelerations):
        """Return the quantity whose change of sign changes the bounds, and its rate."""
        if where == "X":
            value, rate = self.cross(ends, accelerations)
            sign = 1.0 if self.cross_positive else -1.0
        else:
            value = ends[where].pressure
            rate = self.pressure_rate(ends[where], accelerations[where])
            sign = 1.0 if self.pressed[where] else -1.0
        return sign * value, sign * rate


def _positive(value, rate) -> bool:
    """Return the sign that a quantity is about to have."""
    if abs(value) <= SIMULTANEOUS * abs(rate):
        return bool(rate > 0.0)
    return bool(value > 0.0)


# time integration ---------------------------------------------------------------------------


class March:
    """Steps, contact changes and samples of a model on a bed; subclasses supply the mechanics.

    Subclasses define ``rhs``, ``guard_values``, ``set_guards``, ``due``, ``switch``, ``energies``,
    ``tilt``, ``sample``, ``in_flight`` and ``wake``. The last two entries of its state are the
    works of the dashpots and of the ground.
    """

    def __init__(self, theta: float, gravity: float, restraint: str) -> None:
        if restraint not in RULES:
            msg = f"unknown restraint {restraint!r}"
            raise ValueError(msg)
        self.theta, self.g, self.restraint = theta, gravity, restraint
        self.guards: list[Guard] = []
        self.events: list = []
        self.losses = {"repin": 0.0, "impact": 0.0}
        self.limit = theta
        self.stop_at_theta = True
        self.overturning_time: float | None = None
        self.ended = False
        self.peak = 0.0
        self.largest = self.worst = 0.0
        self.flight: dict[str, float] = {}
        self.watch: Callable | None = None
        self.ground_x: Callable = lambda t: 0.0 * t
        self.ground_y: Callable = lambda t: 0.0 * t

    def audit(self, z) -> None:
        terms = self.energies(z)
        parts = (*terms, z[-2], z[-1], *self.losses.values())
        self.largest = max(self.largest, *(abs(one) for one in parts))
        balance = sum(terms) + z[-2] + sum(self.losses.values())
        self.worst = max(self.worst, abs(balance - self.energy_start - z[-1]))

    def topple(self, t) -> None:
        """Record that the limit of rotation is reached: first theta, then a right angle."""
        if self.overturning_time is None:
            self.overturning_time = float(t)
        self.ended = self.ended or self.stop_at_theta or self.limit > self.theta
        self.limit = 0.5 * math.pi

    def march(self, z, drive, samples, *, period, max_step, rtol, atol, method="DOP853"):
        """Integrate over all pieces of the ground motion; return the end time and state."""
        samples = np.asarray(samples, dtype=float)
        if np.any(np.diff(samples) < 0.0):
            msg = "sample_times must not decrease"
            raise ValueError(msg)
        self.table: list = []

        def record(now, state):
            while len(self.table) < samples.size and samples[len(self.table)] <= now:
                self.table.append(self.sample(state(samples[len(self.table)])))

        self.energy_start = float(sum(self.energies(z)))
        self.peak = abs(self.tilt(z)[0])
        now, started = 0.0, False
        for start, stop, self.ground_x, self.ground_y in drive.pieces():
            now = start
            if not started:
                started = True
                self.audit(z)
                sign = "+" if self.tilt(z)[0] > 0.0 else "-"
                changes = [("topple", sign)] if self.peak >= self.theta else []
                self.switch(0.0, z, changes + self.due(0.0, z))
                self.audit(z)
                record(0.0, lambda _, z=z: z)
            while now < stop and not self.ended:
                solver = stepper(
                    self.rhs, now, z, stop,
                    max_step=max_step, rtol=rtol, atol=atol, method=method,
                )  # fmt: skip
                while solver.status == "running":
                    trouble = solver.step()
                    if solver.status == "failed":
                        msg = f"integration failed at t = {now!r}: {trouble}"
                        raise RuntimeError(msg)
                    dense = solver.dense_output()
                    times = np.linspace(solver.t_old, solver.t, SUBDIVISIONS + 1)
                    states = dense(times)
                    if self.wake(states):
                        now, z = solver.t_old, dense(solver.t_old)
                        break
                    pairs = self.guard_values(times, states, np)
                    hits = crossings(
                        self.guards,
                        [np.broadcast_to(one[0], times.shape) for one in pairs],
                        [np.broadcast_to(one[1], times.shape) for one in pairs],
                        times,
                        lambda i, t, dense=dense: self.guard_values(t, dense(t))[i],
                    )
                    first = min((hit for hit in hits if hit is not None), default=None)
                    reached = solver.t if first is None else first
                    self.follow(dense, times, solver.t_old, reached)
                    if self.watch is not None:
                        self.watch(self, solver.t_old, reached, dense)
                    if first is None:
                        now, z = solver.t, solver.y.copy()
                        self.audit(z)
                        record(now, dense)
                        continue
                    long_ago = self.events[-CHATTER].time if len(self.events) >= CHATTER else None
                    if long_ago is not None and first - long_ago < period / 100.0:
                        msg = f"contact chatters at t = {float(first)!r}"
                        raise ChatterError(msg)
                    if len(self.table) < samples.size and samples[len(self.table)] < first:
                        record(np.nextafter(first, -np.inf), dense)
                    now, z = first, dense(first).copy()
                    self.audit(z)
                    changes = []
                    for guard, hit, (value, rate) in zip(
                        self.guards, hits, self.guard_values(first, z), strict=True
                    ):
                        own = hit is not None and hit <= first + SIMULTANEOUS
                        near = guard.strict and rate < 0.0 and value <= SIMULTANEOUS * -rate
                        if own or near:
                            changes.append((guard.kind, guard.where))
                    self.switch(first, z, changes)
                    self.audit(z)
                    break
                if now >= stop:
                    break
            if self.ended:
                break
        if len(self.table) < samples.size and samples[len(self.table)] <= now:
            record(now, lambda _, z=z: z)
        return now, z

    def follow(self, dense, times, start, reached) -> None:
        """Record the largest rotation and the flight time of the rest of a step."""
        inside = np.append(times[times < reached], reached)
        swing = self.tilt(dense(inside))[1]
        turns = np.nonzero(swing[:-1] * swing[1:] < 0.0)[0]
        tops = [polish(lambda t: self.tilt(dense(t))[1], inside[j], inside[j + 1]) for j in turns]
        for top in (*tops, reached):
            self.peak = max(self.peak, abs(float(self.tilt(dense(top))[0])))
        for name in self.in_flight():
            self.flight[name] = self.flight.get(name, 0.0) + reached - start

    def columns(self, samples):
        """Turn the samples into arrays, NaN or empty after the end of the run."""
        count, width = len(samples), len(self.sample_start)
        table = []
        for column in range(width):
            word = isinstance(self.sample_start[column], str)
            values = np.full(count, "" if word else np.nan, dtype="U6" if word else float)
            values[: len(self.table)] = [row[column] for row in self.table]
            table.append(values)
        return table

    @property
    def energy_residual(self) -> float:
        return float(self.worst / self.largest) if self.largest > 0.0 else 0.0


# the body -----------------------------------------------------------------------------------


class _Run(March):
    def __init__(self, bed, inertia, theta, gravity, restraint):
        super().__init__(theta, gravity, restraint)
        self.bed, self.inertia = bed, inertia
        self.b, self.h = bed.b, bed.h
        self.side = 0
        self.contact = "flight"
        self.grace: set[str] = set()
        self.kept = False

    # kinematics -----------------------------------------------------------------------------
    def eccentricity(self) -> float:
        if self.restraint == "leading-corner":
            return self.b * self.side
        if self.restraint == "contact-state":
            return {"full": 0.0, "right": self.b, "left": -self.b}[self.contact]
        return 0.0

    def lever(self, alpha, xp=math):
        """First and second derivative of x with respect to the rotation."""
        if not self.bed.finite:
            return self.h, 0.0
        e, sine, cosine = self.eccentricity(), xp.sin(alpha), xp.cos(alpha)
        return self.h * cosine + e * sine, e * cosine - self.h * sine

    def motion(self, t, z, xp=math):
        """Accelerations, the ends and their accelerations, and the power dissipated."""
        alpha, y, _, alpha_dot, y_dot = z[:5]
        ends = self.bed.ends(alpha, y, alpha_dot, y_dot, xp)
        lift, moment, dissipated = self.bed.resultants(ends, alpha, y, alpha_dot, y_dot, xp)
        ax, ay = self.ground_x(t), self.ground_y(t)
        y_acc = lift - (self.g + ay)
        if self.contact == "flight":
            alpha_acc, x_acc = 0.0 * alpha, -ax
        else:
            first, second = self.lever(alpha, xp)
            alpha_acc = (moment - first * ax - first * second * alpha_dot**2) / (
                self.inertia + first**2
            )
            x_acc = first * alpha_acc + second * alpha_dot**2
        accelerations = {
            name: y_acc + end.arm * alpha_acc + end.bend * alpha_dot**2
            for name, end in ends.items()
        }
        return (alpha_acc, y_acc, x_acc), ends, accelerations, dissipated

    def rhs(self, t, z):
        z = z.tolist()  # plain floats: several times as fast as NumPy's own
        (alpha_acc, y_acc, x_acc), *_, dissipated = self.motion(t, z)
        alpha_dot, y_dot = z[3], z[4]
        x_dot = z[5] if self.contact == "flight" else self.lever(z[0])[0] * alpha_dot
        work = -(self.ground_x(t) * x_dot + self.ground_y(t) * y_dot)
        return [alpha_dot, y_dot, x_dot, alpha_acc, y_acc, x_acc, dissipated, work]

    def energies(self, z):
        alpha, y, _, alpha_dot, y_dot, x_dot = z[:6]
        if self.contact != "flight":
            x_dot = self.lever(alpha)[0] * alpha_dot
        kinetic = 0.5 * (self.inertia * alpha_dot**2 + y_dot**2 + x_dot**2)
        return kinetic, self.g * y, self.bed.energy(alpha, y)

    def tilt(self, z):
        return z[0], z[3]

    def in_flight(self):
        return ["body"] if self.contact == "flight" else []

    def wake(self, states) -> bool:
        """Choose the leading corner at the first sign of a rotation."""
        if self.restraint != "leading-corner" or self.side or not states[0].any():
            return False
        self.side = int(np.sign(states[0][np.nonzero(states[0])[0][0]]))
        self.set_guards()
        return True

    def sample(self, z):
        alpha, y, x, alpha_dot, y_dot, x_dot = (float(one) for one in z[:6])
        if self.contact != "flight":
            x_dot = self.lever(alpha)[0] * alpha_dot
        length = 0.0
        if self.bed.bounds is not None:
            low, high = self.bed.place(self.bed.bounds, self.bed.ends(alpha, y, alpha_dot, y_dot))
            length = high - low
        return alpha, y, x, alpha_dot, y_dot, x_dot, length, self.contact

    # guards ---------------------------------------------------------------------------------
    def set_guards(self):
        """Set the guards of the present state, unarmed until they have been positive."""
        guards = []
        for name in "LR":
            if self.bed.end[name] == TOUCHING:
                guards.append(Guard("leave", name, strict=name not in self.grace))
                if name in self.grace:
                    guards.append(Guard("slip", name, strict=False))
            elif self.bed.end[name] == RELAXING:
                guards.append(Guard("clear", name))
                guards.append(Guard("engage", name, strict=False))
                guards.append(Guard("settle", name))
            else:
                guards.append(Guard("land", name))
        guards += self.bed.cut_guards()
        if self.restraint == "leading-corner" and self.side:
            guards.append(Guard("side", ""))
        guards.append(Guard("topple", "+", strict=False))
        guards.append(Guard("topple", "-", strict=False))
        self.guards = guards

    def bearing(self, end, acceleration):
        """Return the guard of a bearing end and its rate."""
        if self.bed.by_pressure:
            return end.pressure, self.bed.pressure_rate(end, acceleration)
        return end.depth, -end.rate

    def guard_values(self, t, z, xp=math):
        z = z.tolist() if xp is math else z
        _, ends, accelerations, _ = self.motion(t, z, xp)
        alpha, alpha_dot = z[0], z[3]
        out = []
        for guard in self.guards:
            if guard.kind == "side":
                out.append((self.side * alpha, self.side * alpha_dot))
            elif guard.kind == "topple":
                sign = 1.0 if guard.where == "+" else -1.0
                out.append((self.limit - sign * alpha, -sign * alpha_dot))
            elif guard.kind == "cut":
                out.append(self.bed.cut_value(guard.where, ends, accelerations))
            else:
                end, acceleration = ends[guard.where], accelerations[guard.where]
                force, force_rate = self.bearing(end, acceleration)
                out.append(
                    {
                        "leave": (force, force_rate),
                        "clear": (end.depth, -end.rate),
                        "slip": (end.depth, -end.rate),
                        "engage": (-force, -force_rate),
                        "settle": (end.rate, acceleration),
                        "land": (-end.depth, end.rate),
                    }[guard.kind]
                )
        return out

    # switches -------------------------------------------------------------------------------
    def read(self, t, z):
        """Find the bearing part, twice, as the rates depend on it where a sign is in doubt."""
        for _ in range(2 if self.bed.by_pressure else 1):
            _, ends, accelerations, _ = self.motion(t, z)
            self.bed.read(ends, accelerations)

    def held(self, z) -> str:
        """Name the contact by the bearing ends, or by a bearing stretch between them."""
        left, right = (self.bed.end[name] == TOUCHING for name in "LR")
        if left and right:
            return "full"
        if left or right:
            return "left" if left else "right"
        if self.bed.bounds is not None:
            if self.contact in ("left", "right"):
                return self.contact
            return "right" if z[0] > 0.0 else "left"
        below = any(state != CLEAR for state in self.bed.end.values())
        return self.contact if self.kept and below else "flight"

    def repin(self, z, horizontal):
        """Project the momentum on the constraint of the present contact; return the loss."""
        alpha, alpha_dot = z[0], z[3]
        if self.contact == "flight":
            z[5] = horizontal
            return 0.0
        first = self.lever(alpha)[0]
        new = (self.inertia * alpha_dot + first * horizontal) / (self.inertia + first**2)
        before = self.inertia * alpha_dot**2 + horizontal**2
        z[3], z[5] = new, first * new
        return 0.5 * (before - (self.inertia + first**2) * new**2)

    def due(self, t, z, before=None, just_left=()):
        """List the changes of contact that are due in the present state.

        ``before`` holds the pressures before a jump of the rates: an end that the jump takes from
        pull to pressure bears at once, unless it has just left.
        """
        changes = []
        _, ends, accelerations, _ = self.motion(t, z)
        for name, end in ends.items():
            state = self.bed.end[name]
            force, force_rate = self.bearing(end, accelerations[name])
            margin = SIMULTANEOUS * abs(force_rate)
            if state == TOUCHING:
                if name in self.grace and force < -margin:
                    continue
                if force < -margin or (force <= margin and force_rate < 0.0):
                    changes.append(("leave", name))
            elif state == RELAXING:
                if end.rate > 0.0 and end.depth <= SIMULTANEOUS * end.rate:
                    changes.append(("clear", name))
                elif end.rate <= 0.0:
                    changes.append(("settle", name))
                elif before and before[name] <= 0.0 < force - margin and name not in just_left:
                    changes.append(("engage", name))
            elif end.rate < 0.0 and -end.depth <= SIMULTANEOUS * -end.rate:
                changes.append(("land", name))
        if not changes and self.held(z) != self.contact:
            changes.append(("cut", ""))
        return changes

    def switch(self, t, z, changes):
        """Carry out the changes that fired, and those that follow at the same instant."""
        _, ends, accelerations, _ = self.motion(t, z)
        self.grace = {
            name for name in self.grace if self.bearing(ends[name], accelerations[name])[0] <= 0.0
        }
        self.kept = self.kept and self.bed.bounds is None
        just_left: set[str] = set()
        for _ in range(CASCADE):
            before = {name: end.pressure for name, end in self.motion(t, z)[1].items()}
            for kind in ORDER:
                chosen = [name for what, name in changes if what == kind]
                if not chosen:
                    continue
                names = "" if kind == "cut" else "".join(chosen)
                was, old = self.contact, _span(z)
                horizontal = z[5] if was == "flight" else self.lever(z[0])[0] * z[3]
                event = Event(float(t), kind, names, was, was, old, old)
                if kind == "topple":
                    self.topple(t)
                elif kind == "side":
                    self.side = -self.side
                else:
                    self.change(kind, names, z, just_left)
                    self.read(t, z)
                    self.contact = self.held(z)
                    if self.contact != was:
                        event.repinning_loss = self.repin(z, horizontal)
                        self.losses["repin"] += event.repinning_loss
                        alone = TOUCHING not in self.bed.end.values()
                        self.kept = self.kept or (was == "flight" and alone)
                        self.read(t, z)
                    event.contact_after, event.after = self.contact, _span(z)
                if kind != "cut" or self.contact != was:
                    self.events.append(event)
            changes = self.due(t, z, before, just_left)
            if not changes:
                break
        else:
            msg = f"contact does not settle at t = {float(t)!r}"
            raise ChatterError(msg)
        self.read(t, z)
        self.set_guards()

    def change(self, kind, names, z, just_left):
        """Return the new states of the named ends."""
        for name in names:
            self.grace.discard(name)
            if kind in ("engage", "settle"):
                self.grace.add(name)
            if kind in ("leave", "slip"):
                just_left.add(name)
                end = self.bed.ends(z[0], z[1], z[3], z[4])[name]
                below = self.bed.by_pressure and end.depth > SIMULTANEOUS * abs(end.rate)
                self.bed.end[name] = RELAXING if below else CLEAR
            else:
                self.bed.end[name] = CLEAR if kind == "clear" else TOUCHING


def _span(z):
    return tuple(float(one) for one in z[:6])


def simulate(
    *,
    half_width: float,
    half_height: float,
    shape_factor: float | None = None,
    inertia: float | None = None,
    mass: float = 1.0,
    bed_stiffness: float,
    bed_damping: float = 0.0,
    separation: str = "displacement",
    restraint: str = "contact-state",
    rotation: str = "finite",
    gravity: float = 9.80665,
    time_step: float | None = None,
    acceleration: Sequence[float] | Callable[[float], float] | None = None,
    vertical: Sequence[float] | Callable[[float], float] | None = None,
    breakpoints: Sequence[float] = (),
    duration: float,
    initial: Sequence[float | None] = (0.0, None, 0.0, 0.0),
    sample_times: Sequence[float] = (),
    rtol: float = 1e-12,
    atol: float = 1e-14,
    overturning: str = "stop",
    restart_every_knot: bool = True,
    steps_per_period: float = 40.0,
    max_step: float | None = None,
    method: str = "DOP853",
    watch: Callable | None = None,
) -> Result:
    """Integrate a body on a Winkler bed from ``initial`` = (alpha, y, alpha', y').

    ``half_height`` is the height of the centre of mass; its inertia is given either as
    ``inertia`` about that centre or as the shape factor. Stiffness and damping are per unit
    length of the base. An initial y of None is that of vertical equilibrium at rest under the
    initial rotation. A start with contact has ``x = h sin(alpha) + e (1 - cos(alpha))``; a
    start in flight has x with ``e = 0`` and no horizontal speed. ``watch(run, start, stop,
    dense)`` is called with every step, cut at a change of contact.
    """
    if (shape_factor is None) == (inertia is None):
        msg = "give either shape_factor or inertia"
        raise ValueError(msg)
    if rotation not in ("finite", "small"):
        msg = f"unknown rotation {rotation!r}"
        raise ValueError(msg)
    if overturning not in ("stop", "continue"):
        msg = f"unknown overturning {overturning!r}"
        raise ValueError(msg)
    b, h = half_width, half_height
    bed = Bed(
        half_width=b,
        height=h,
        stiffness=bed_stiffness / mass,
        damping=bed_damping / mass,
        settlement=mass * gravity / (2.0 * b * bed_stiffness),
        separation=separation,
        finite=rotation == "finite",
    )
    gyration = (b * b + h * h) / shape_factor if inertia is None else inertia / mass
    run = _Run(bed, gyration, math.atan2(b, h), gravity, restraint)
    run.stop_at_theta = overturning == "stop"
    run.watch = watch
    drive = Drive(
        acceleration=acceleration,
        vertical=vertical,
        time_step=time_step,
        breakpoints=breakpoints,
        duration=duration,
        restart_every_knot=restart_every_knot,
    )
    period = 2.0 * math.pi * math.sqrt(mass / (2.0 * b * bed_stiffness))
    if max_step is None:
        max_step = period / steps_per_period
        if not restart_every_knot and time_step is not None:
            max_step = min(max_step, time_step)

    # the start
    alpha, y, alpha_dot, y_dot = initial
    y = bed.rest(alpha, gravity) if y is None else y
    z = np.array([alpha, y, 0.0, alpha_dot, y_dot, 0.0, 0.0, 0.0], dtype=float)
    run.side = int(np.sign(alpha) or np.sign(alpha_dot))
    for name, end in bed.ends(*z[:2], *z[3:5]).items():
        bears = end.pressure > 0.0 or not bed.by_pressure
        below = TOUCHING if bears else RELAXING
        bed.end[name] = below if end.depth > 0.0 else CLEAR
    run.read(0.0, z)
    run.contact = run.held(z)
    run.read(0.0, z)
    z[2] = h * (math.sin(alpha) if bed.finite else alpha)
    if run.contact != "flight":
        if bed.finite:
            z[2] += run.eccentricity() * (1.0 - math.cos(alpha))
        z[5] = run.lever(alpha)[0] * alpha_dot
    run.sample_start = run.sample(z)
    begun_in_flight = run.contact == "flight"
    now, z = run.march(
        z,
        drive,
        sample_times,
        period=period,
        max_step=max_step,
        rtol=rtol,
        atol=atol,
        method=method,
    )

    return Result(
        np.asarray(sample_times, dtype=float),
        *run.columns(sample_times),
        events=run.events,
        peak_rotation=float(run.peak),
        flight_time=float(run.flight.get("body", 0.0)),
        flight_count=begun_in_flight
        + sum(
            event.contact_after == "flight" and event.contact_before != "flight"
            for event in run.events
        ),
        overturned=run.overturning_time is not None,
        overturning_time=run.overturning_time,
        end_time=float(now),
        dashpot_work=mass * float(z[6]),
        input_work=mass * float(z[7]),
        repinning_loss=mass * float(run.losses["repin"]),
        initial_energy=mass * run.energy_start,
        final_energy=mass * float(sum(run.energies(z))),
        energy_residual=run.energy_residual,
    )
