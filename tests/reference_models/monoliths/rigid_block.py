"""Housner's rigid block on rigid ground, integrated independently.

Mass is one. Signs: x right, y up, rotation clockwise. The state is (alpha, alpha', work of
the ground). With s the sign of the rotation,

    alpha'' = -omega^2 [(1 + a_y/g) sin(theta s - alpha) + (a_x/g) cos(theta s - alpha)]

and for small rotation sine and cosine become their argument and one. At alpha = 0 the rate is
multiplied by the restitution.

A block at rest starts when the equation of motion at alpha = 0 drives it away from zero on either
side: |a_x| > (g + a_y) tan(theta), or theta itself for small rotation. It comes to
rest after an impact when the equation holds it on both sides and its remaining rate would lift it
by less than ``rest_rotation`` times theta.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from . import Drive, Guard, crossings, polish, stepper

SUBDIVISIONS = 8


@dataclass
class Event:
    """An impact, a start, a rest or an overturning; states are (alpha, alpha')."""

    time: float
    kind: str
    before: tuple[float, float]
    after: tuple[float, float]
    loss: float = 0.0


@dataclass
class Result:
    """Samples, events and energy balance of one run.

    Samples after the end of the run are NaN; at the instant of an event they are those after
    it. ``state`` is "rocking", "rest" or, after the end, an empty string.
    """

    time: np.ndarray
    rotation: np.ndarray
    rotation_rate: np.ndarray
    vertical: np.ndarray
    horizontal: np.ndarray
    state: np.ndarray
    events: list[Event] = field(default_factory=list)
    peak_rotation: float = 0.0
    impact_count: int = 0
    overturned: bool = False
    overturning_time: float | None = None
    end_time: float = 0.0
    input_work: float = 0.0
    impact_loss: float = 0.0
    initial_energy: float = 0.0
    final_energy: float = 0.0
    energy_residual: float = 0.0


class _Run:
    def __init__(self, half_width, half_height, shape_factor, restitution, rotation, gravity):
        if rotation not in ("finite", "small"):
            msg = f"unknown rotation {rotation!r}"
            raise ValueError(msg)
        self.g = gravity
        self.radius = math.hypot(half_width, half_height)
        self.theta = math.atan2(half_width, half_height)
        self.corner_inertia = self.radius**2 * (1.0 + 1.0 / shape_factor)
        self.omega = math.sqrt(shape_factor / (1.0 + shape_factor) * gravity / self.radius)
        self.eps = restitution
        if self.eps is None:
            cosine = math.cos(2.0 * self.theta)
            self.eps = (1.0 + shape_factor * cosine) / (1.0 + shape_factor)
        if not 0.0 < self.eps <= 1.0:
            msg = f"restitution {self.eps} is outside (0, 1]"
            raise ValueError(msg)
        self.finite = rotation == "finite"
        self.threshold = math.tan(self.theta) if self.finite else self.theta
        self.half_width, self.half_height = half_width, half_height
        self.side = 1
        self.limit = self.theta
        self.guards: list[Guard] = []
        self.ground_x: Callable = lambda t: 0.0 * t
        self.ground_y: Callable = lambda t: 0.0 * t

    def levers(self, alpha, xp=math):
        """Derivatives of x and y of the centre of mass with respect to the rotation."""
        left = self.theta * self.side - alpha
        if self.finite:
            return self.radius * xp.cos(left), self.radius * xp.sin(left)
        return self.radius, self.radius * left

    def place(self, alpha):
        """Return x and y of the centre of mass from its position at rest."""
        side = 1.0 if alpha >= 0.0 else -1.0
        left = self.theta - abs(alpha)
        if self.finite:
            x = side * (self.half_width - self.radius * math.sin(left))
            return x, self.radius * math.cos(left) - self.half_height
        return self.radius * alpha, self.radius * (self.theta * abs(alpha) - 0.5 * alpha**2)

    def swing(self, t, alpha, xp=math):
        along, up = self.levers(alpha, xp)
        ax, ay = self.ground_x(t), self.ground_y(t)
        return -((self.g + ay) * up + ax * along) / self.corner_inertia

    def rhs(self, t, z):
        along, up = self.levers(z[0])
        ax, ay = self.ground_x(t), self.ground_y(t)
        acceleration = -((self.g + ay) * up + ax * along) / self.corner_inertia
        return [z[1], acceleration, -(ax * along + ay * up) * z[1]]

    def energy(self, z):
        return 0.5 * self.corner_inertia * z[1] ** 2 + self.g * self.place(z[0])[1]

    def held(self, t) -> float:
        """Positive while a block at alpha = 0 without rate stays there."""
        return (self.g + self.ground_y(t)) * self.threshold - abs(self.ground_x(t))

    def guard_values(self, t, z, xp=math):
        return [
            (self.side * z[0], self.side * z[1]),
            (self.limit - z[0], -z[1]),
            (self.limit + z[0], z[1]),
        ]

    def set_guards(self):
        self.guards = [
            Guard("impact", "", strict=False),
            Guard("topple", "+", strict=False),
            Guard("topple", "-", strict=False),
        ]


def simulate(
    *,
    half_width: float,
    half_height: float,
    shape_factor: float,
    restitution: float | None = None,
    rotation: str = "finite",
    gravity: float = 9.80665,
    time_step: float | None = None,
    acceleration: Sequence[float] | Callable[[float], float] | None = None,
    vertical: Sequence[float] | Callable[[float], float] | None = None,
    breakpoints: Sequence[float] = (),
    duration: float,
    initial: Sequence[float] = (0.0, 0.0),
    sample_times: Sequence[float] = (),
    rtol: float = 1e-12,
    atol: float = 1e-14,
    overturning: str = "stop",
    restart_every_knot: bool = True,
    steps_per_period: float = 200.0,
    max_step: float | None = None,
    method: str = "DOP853",
    rest_rotation: float = 1e-9,
) -> Result:
    """Integrate a rigid block on rigid ground from ``initial`` = (alpha, alpha')."""
    run = _Run(half_width, half_height, shape_factor, restitution, rotation, gravity)
    if overturning not in ("stop", "continue"):
        msg = f"unknown overturning {overturning!r}"
        raise ValueError(msg)
    drive = Drive(
        acceleration=acceleration,
        vertical=vertical,
        time_step=time_step,
        breakpoints=breakpoints,
        duration=duration,
        restart_every_knot=restart_every_knot,
    )
    if max_step is None:
        max_step = 2.0 * math.pi / run.omega / steps_per_period
        if not restart_every_knot and time_step is not None:
            max_step = min(max_step, time_step)

    samples = np.asarray(sample_times, dtype=float)
    if np.any(np.diff(samples) < 0.0):
        msg = "sample_times must not decrease"
        raise ValueError(msg)
    table = np.full((4, samples.size), np.nan)
    labels = np.full(samples.size, "", dtype="U7")
    events: list[Event] = []
    lost = largest = worst = 0.0
    overturned: float | None = None
    ended = False

    z = np.array([float(initial[0]), float(initial[1]), 0.0])
    resting = not z[:2].any()
    run.side = int(np.sign(z[0]) or np.sign(z[1]) or 1)
    peak = abs(float(z[0]))
    energy_start = run.energy(z)

    def audit(now):
        nonlocal largest, worst
        kinetic = 0.5 * run.corner_inertia * now[1] ** 2
        height = run.g * run.place(now[0])[1]
        largest = max(largest, kinetic, abs(height), lost, abs(now[2]))
        worst = max(worst, abs(kinetic + height + lost - energy_start - now[2]))

    next_sample = 0

    def record(now, state):
        nonlocal next_sample
        while next_sample < samples.size and samples[next_sample] <= now:
            values = state(samples[next_sample])
            x, y = run.place(values[0])
            table[:, next_sample] = (values[0], values[1], y, x)
            labels[next_sample] = "rest" if resting else "rocking"
            next_sample += 1

    def note(t, kind, before, loss=0.0):
        events.append(Event(float(t), kind, before, (float(z[0]), float(z[1])), float(loss)))

    def topple(t, state):
        nonlocal overturned, ended
        if overturned is None:
            overturned = t
        ended = ended or overturning == "stop" or run.limit > run.theta
        run.limit = 0.5 * math.pi
        note(t, "topple", state)

    def first_lift(start, stop):
        """Return the time at which a resting block starts within a smooth piece, or None."""
        if run.held(start) < 0.0:
            return start
        count = max(2, math.ceil((stop - start) / max_step) * SUBDIVISIONS + 1)
        grid = np.linspace(start, stop, count)
        room = (run.g + run.ground_y(grid)) * run.threshold - np.abs(run.ground_x(grid))
        below = np.nonzero(room[1:] < 0.0)[0]
        if below.size == 0:
            return None
        return polish(run.held, grid[below[0]], grid[below[0] + 1])

    now = 0.0
    run.set_guards()
    if peak >= run.theta:
        topple(0.0, (float(z[0]), float(z[1])))
    for start, stop, ground_x, ground_y in drive.pieces():
        run.ground_x, run.ground_y = ground_x, ground_y
        now = start
        while now < stop and not ended:
            if resting:
                lift = first_lift(now, stop)
                still = stop if lift is None else np.nextafter(lift, -np.inf)
                record(still, lambda _, z=z: z)
                now = stop if lift is None else lift
                if lift is None or lift >= stop:
                    break
                resting = False
                # ground acceleration to the right tilts the block to the left
                run.side = -1 if run.ground_x(now) > 0.0 else 1
                note(now, "start", (0.0, 0.0))
                run.set_guards()
            solver = stepper(
                run.rhs, now, z, stop, max_step=max_step, rtol=rtol, atol=atol, method=method
            )
            while solver.status == "running":
                trouble = solver.step()
                if solver.status == "failed":
                    msg = f"integration failed at t = {now!r}: {trouble}"
                    raise RuntimeError(msg)
                dense = solver.dense_output()
                times = np.linspace(solver.t_old, solver.t, SUBDIVISIONS + 1)
                pairs = run.guard_values(times, dense(times))
                hits = crossings(
                    run.guards,
                    [one[0] for one in pairs],
                    [one[1] for one in pairs],
                    times,
                    lambda i, t, dense=dense: run.guard_values(t, dense(t))[i],
                )
                first = min((hit for hit in hits if hit is not None), default=None)
                reached = solver.t if first is None else first
                inside = np.append(times[times < reached], reached)
                rates = dense(inside)[1]
                for j in np.nonzero(rates[:-1] * rates[1:] < 0.0)[0]:
                    top = polish(lambda t, dense=dense: dense(t)[1], inside[j], inside[j + 1])
                    peak = max(peak, abs(float(dense(top)[0])))
                peak = max(peak, abs(float(dense(reached)[0])))
                if first is None and not run.guards[0].armed:
                    msg = f"the block does not rise on the side chosen at t = {now!r}"
                    raise RuntimeError(msg)
                if first is None:
                    now, z = solver.t, solver.y.copy()
                    audit(z)
                    record(now, dense)
                    continue
                if next_sample < samples.size and samples[next_sample] < first:
                    record(np.nextafter(first, -np.inf), dense)
                now, z = first, dense(first).copy()
                audit(z)
                before = (float(z[0]), float(z[1]))
                fired = run.guards[hits.index(first)].kind
                if fired == "topple":
                    topple(now, before)
                else:
                    loss = 0.5 * run.corner_inertia * (1.0 - run.eps**2) * z[1] ** 2
                    z[0], z[1] = 0.0, run.eps * z[1]
                    lost += loss
                    run.side = 1 if z[1] > 0.0 else -1
                    note(now, "impact", before, loss)
                    back = -run.side * run.swing(now, 0.0)
                    if run.held(now) > 0.0 and 0.5 * z[1] ** 2 / back < rest_rotation * run.theta:
                        left = 0.5 * run.corner_inertia * z[1] ** 2
                        before = (0.0, float(z[1]))
                        lost += left
                        z[1] = 0.0
                        resting = True
                        note(now, "rest", before, left)
                audit(z)
                run.set_guards()
                break
        if ended:
            break
    if next_sample < samples.size and samples[next_sample] <= now:
        record(now, lambda _, z=z: z)

    return Result(
        time=samples,
        rotation=table[0],
        rotation_rate=table[1],
        vertical=table[2],
        horizontal=table[3],
        state=labels,
        events=events,
        peak_rotation=peak,
        impact_count=sum(event.kind == "impact" for event in events),
        overturned=overturned is not None,
        overturning_time=None if overturned is None else float(overturned),
        end_time=float(now),
        input_work=float(z[2]),
        impact_loss=float(lost),
        initial_energy=energy_start,
        final_energy=run.energy(z),
        energy_residual=worst / largest if largest > 0.0 else 0.0,
    )
