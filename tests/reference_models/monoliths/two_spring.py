"""A rocking block on two corner springs and dashpots, integrated independently.

Mass is one. Signs: x right, y up, rotation clockwise (the left corner rises). The state is
(alpha, y, x, alpha', y', x', work of the dashpots, work of the ground).

Each corner is TOUCHING (force ``k (delta - y_I) - c y_I'``), RELAXING (free, but its spring
is still below its free length) or CLEAR (above it). A corner in contact leaves when its force
falls through zero; a clear one lands, with an impact, when it falls through its free length; a
relaxing one re-engages, without an impact, when its force would rise through zero or when it
stops rising.

Re-pinning changes the corner speeds a little, and with them ``k (delta - y_I) - c y_I'``. Just
after a separation the expression may thus be slightly positive: the corner does not re-engage.
Just after re-engagement the force may be slightly negative: the corner stays, and may leave once
its force has been positive or its spring has reached its free length. If it left at once, the two
re-pinnings would alternate hundreds of times at one instant and dissipate the horizontal
momentum. ``peak_tension`` is the largest such pull.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from . import SIMULTANEOUS, Drive, Guard, crossings, polish, stepper, ties

TOUCHING, RELAXING, CLEAR = "touching", "relaxing", "clear"
SUBDIVISIONS = 8
CASCADE = 60
CHATTER = 80


class ChatterError(RuntimeError):
    """Endless contact changes: at zero force the pinned and the free motion disagree.

    A block in contact is held at its base however small the contact force is. Far beyond the
    overturning angle the constraint may take the force through zero while free flight restores it
    at once. Then no motion obeys the rules.
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
    impact_loss: float = 0.0
    impulses: tuple[float, float] = (0.0, 0.0)
    struck: bool = False


@dataclass
class Result:
    """Samples, events and energy balance of one run.

    Samples after the end of the run are NaN, the contact there is an empty string. At the
    instant of an event the samples are those after it. ``impact_count`` counts the instants at
    which a landing corner came down, ``landing_count`` all landings.
    """

    time: np.ndarray
    rotation: np.ndarray
    vertical: np.ndarray
    horizontal: np.ndarray
    rotation_rate: np.ndarray
    vertical_rate: np.ndarray
    horizontal_rate: np.ndarray
    contact: np.ndarray
    events: list[Event] = field(default_factory=list)
    peak_rotation: float = 0.0
    impact_count: int = 0
    landing_count: int = 0
    flight_time: float = 0.0
    flight_count: int = 0
    peak_tension: float = 0.0
    overturned: bool = False
    overturning_time: float | None = None
    end_time: float = 0.0
    dashpot_work: float = 0.0
    input_work: float = 0.0
    impact_loss: float = 0.0
    repinning_loss: float = 0.0
    initial_energy: float = 0.0
    final_energy: float = 0.0
    energy_residual: float = 0.0
    ties: list[ties.Tie] = field(default_factory=list)


class _Run:
    def __init__(
        self,
        half_width,
        half_height,
        shape_factor,
        frequency_ratio,
        damping_ratio,
        restitution,
        restraint,
        rotation,
        gravity,
    ):
        if restraint not in ("contact-state", "leading-corner", "centre"):
            msg = f"unknown restraint {restraint!r}"
            raise ValueError(msg)
        if rotation not in ("finite", "small"):
            msg = f"unknown rotation {rotation!r}"
            raise ValueError(msg)
        b, h = half_width, half_height
        radius = math.hypot(b, h)
        self.b, self.h, self.g = b, h, gravity
        self.theta = math.atan2(b, h)
        self.inertia = radius**2 / shape_factor
        omega = math.sqrt(shape_factor / (1.0 + shape_factor) * gravity / radius)
        omega_v = frequency_ratio * omega
        self.k = omega_v**2 / 2.0
        self.c = damping_ratio * omega_v
        self.delta = gravity / (2.0 * self.k)
        self.vertical_period = 2.0 * math.pi / omega_v
        self.eps = restitution
        if self.eps is None:
            cosine = math.cos(2.0 * self.theta)
            self.eps = (1.0 + shape_factor * cosine) / (1.0 + shape_factor)
        if not 0.0 < self.eps <= 1.0:
            msg = f"restitution {self.eps} is outside (0, 1]"
            raise ValueError(msg)
        self.restraint = restraint
        self.finite = rotation == "finite"
        self.side = 0
        self.corner = {"L": TOUCHING, "R": TOUCHING}
        self.contact = "full"
        self.guards: list[Guard] = []
        self.ties: list[ties.Tie] = []
        self.grace: set[str] = set()
        self.limit = self.theta
        self.ground_x: Callable = lambda t: 0.0 * t
        self.ground_y: Callable = lambda t: 0.0 * t

    # kinematics -----------------------------------------------------------------------------
    def set_corner(self, name: str, state: str) -> None:
        self.corner[name] = state
        left, right = (self.corner[one] == TOUCHING for one in "LR")
        one_sided = "left" if left else "right"
        self.contact = one_sided if left != right else ("full" if left else "flight")

    def eccentricity(self) -> float:
        if self.restraint == "leading-corner":
            return self.b * self.side
        if self.restraint == "contact-state":
            return {"full": 0.0, "right": self.b, "left": -self.b}[self.contact]
        return 0.0

    def lever(self, alpha, xp=math):
        """First and second derivative of x with respect to the rotation."""
        if not self.finite:
            return self.h, 0.0
        e, sine, cosine = self.eccentricity(), xp.sin(alpha), xp.cos(alpha)
        return self.h * cosine + e * sine, e * cosine - self.h * sine

    def corners(self, alpha, y, xp=math):
        """Return for L and R the rise, its derivative in the rotation, and the second one."""
        b, h = self.b, self.h
        if not self.finite:
            middle = y + 0.5 * h * alpha * alpha
            return {
                "L": (middle + b * alpha, h * alpha + b, h),
                "R": (middle - b * alpha, h * alpha - b, h),
            }
        sine, cosine = xp.sin(alpha), xp.cos(alpha)
        middle = y + h * (1.0 - cosine)
        return {
            "L": (middle + b * sine, h * sine + b * cosine, h * cosine - b * sine),
            "R": (middle - b * sine, h * sine - b * cosine, h * cosine + b * sine),
        }

    def motion(self, t, z, xp=math):
        """Accelerations, and for each corner (rise, rate, force expression, lever)."""
        alpha, y, _, alpha_dot, y_dot = z[:5]
        ends = {}
        lift = moment = 0.0 * alpha
        for name, (rise, arm, bend) in self.corners(alpha, y, xp).items():
            rate = y_dot + arm * alpha_dot
            force = self.k * (self.delta - rise) - self.c * rate
            ends[name] = (rise, rate, force, arm, bend)
            if self.corner[name] == TOUCHING:
                lift = lift + force
                moment = moment + force * arm
        ax, ay = self.ground_x(t), self.ground_y(t)
        turn, up, across = ties.forces(self.ties, z, xp)
        ax = ax - across
        y_acc = lift + up - (self.g + ay)
        if self.contact == "flight":
            alpha_acc, x_acc = turn / self.inertia + 0.0 * alpha, -ax
        else:
            first, second = self.lever(alpha, xp)
            alpha_acc = (moment + turn - first * ax - first * second * alpha_dot**2) / (
                self.inertia + first**2
            )
            x_acc = first * alpha_acc + second * alpha_dot**2
        return alpha_acc, y_acc, x_acc, ends, ax, ay

    def rhs(self, t, z):
        alpha_acc, y_acc, x_acc, ends, *_ = self.motion(t, self.whole(z))
        ax, ay = self.ground_x(t), self.ground_y(t)
        alpha_dot, y_dot = z[3], z[4]
        x_dot = z[5] if self.contact == "flight" else self.lever(z[0])[0] * alpha_dot
        dissipated = 0.0
        for name, (rise, rate, *_) in ends.items():
            if self.corner[name] == TOUCHING:
                dissipated += self.c * rate * rate
            elif self.corner[name] == RELAXING:
                dissipated += self.k * (self.delta - rise) * rate
        for tie in self.ties:
            dissipated += tie.lost_power(tie.length(self.whole(z))[2])
        work = -(ax * x_dot + ay * y_dot)
        return [alpha_dot, y_dot, x_dot, alpha_acc, y_acc, x_acc, dissipated, work]

    def whole(self, z, xp=math):
        """Return the state with the horizontal speed of a held body."""
        if not self.ties or self.contact == "flight":
            return z
        return [*z[:5], self.lever(z[0], xp)[0] * z[3], *z[6:]]

    # energy ---------------------------------------------------------------------------------
    def energies(self, z):
        alpha, y, _, alpha_dot, y_dot, x_dot = z[:6]
        if self.contact != "flight":
            x_dot = self.lever(alpha)[0] * alpha_dot
        kinetic = 0.5 * (self.inertia * alpha_dot**2 + y_dot**2 + x_dot**2)
        springs = 0.0
        for rise, *_ in self.corners(alpha, y).values():
            springs += 0.5 * self.k * max(0.0, self.delta - rise) ** 2
        springs += sum(tie.stored(z) for tie in self.ties)
        return kinetic, self.g * y, springs

    # guards ---------------------------------------------------------------------------------
    def set_guards(self):
        """Set the guards of the present state, unarmed until they have been positive."""
        guards = []
        for name in "LR":
            if self.corner[name] == TOUCHING:
                guards.append(Guard("leave", name, strict=name not in self.grace))
                if name in self.grace:
                    guards.append(Guard("slip", name, strict=False))
            elif self.corner[name] == RELAXING:
                guards.append(Guard("clear", name))
                guards.append(Guard("engage", name, strict=False))
                guards.append(Guard("settle", name))
            else:
                guards.append(Guard("land", name))
        if self.restraint == "leading-corner" and self.side:
            guards.append(Guard("side", ""))
        guards += [guard for i, tie in enumerate(self.ties) for guard in tie.guards(i)]
        guards.append(Guard("topple", "+", strict=False))
        guards.append(Guard("topple", "-", strict=False))
        self.guards = guards

    def guard_values(self, t, z, xp=math):
        z = self.whole(z, xp)
        alpha_acc, y_acc, x_acc, ends, *_ = self.motion(t, z, xp)
        alpha, alpha_dot = z[0], z[3]
        out = []
        for guard in self.guards:
            if guard.kind == "side":
                out.append((self.side * alpha, self.side * alpha_dot))
            elif guard.kind == "topple":
                sign = 1.0 if guard.where == "+" else -1.0
                out.append((self.limit - sign * alpha, -sign * alpha_dot))
            elif guard.kind in ties.KINDS:
                tie = self.ties[int(guard.where)]
                length, way, rate, bend = tie.length(z, xp)
                acc = way[0] * alpha_acc + way[1] * y_acc + way[2] * x_acc + bend
                out.append(tie.value(guard.kind, length, rate, acc))
            else:
                rise, rate, force, arm, bend = ends[guard.where]
                acc = y_acc + arm * alpha_acc + bend * alpha_dot**2
                force_rate = -self.k * rate - self.c * acc
                out.append(
                    {
                        "leave": (force, force_rate),
                        "clear": (self.delta - rise, -rate),
                        "slip": (self.delta - rise, -rate),
                        "engage": (-force, -force_rate),
                        "settle": (rate, acc),
                        "land": (rise - self.delta, rate),
                    }[guard.kind]
                )
        return out

    # switches -------------------------------------------------------------------------------
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

    def strike(self, z, names):
        """Apply the impulses of a landing; return the loss, the impulses, and whether any acted."""
        alpha, y = z[0], z[1]
        ends = self.corners(alpha, y)
        falling = [name for name in names if z[4] + ends[name][1] * z[3] < 0.0]
        if not falling:
            return 0.0, (0.0, 0.0), False
        first = self.lever(alpha)[0]
        swing = self.inertia + first**2
        before = z[4] ** 2 + swing * z[3] ** 2
        impulse = {"L": 0.0, "R": 0.0}
        if len(falling) == 2:
            # two impulses at two corners determine both velocities
            wanted = np.array([-(1.0 - self.eps) * z[4], -(1.0 - self.eps) * swing * z[3]])
            matrix = np.array([[1.0, 1.0], [ends["L"][1], ends["R"][1]]])
            impulse["L"], impulse["R"] = (float(one) for one in np.linalg.solve(matrix, wanted))
            z[3], z[4] = self.eps * z[3], self.eps * z[4]
        else:
            (name,) = falling
            arm = ends[name][1]
            speed = z[4] + arm * z[3]
            impulse[name] = float(-(1.0 - self.eps) * speed / (1.0 + arm**2 / swing))
            z[4] += impulse[name]
            z[3] += impulse[name] * arm / swing
        z[5] = first * z[3]
        after = z[4] ** 2 + swing * z[3] ** 2
        return 0.5 * (before - after), (impulse["L"], impulse["R"]), True

    def due(self, t, z):
        """List the changes of contact that are due in the present state."""
        z = self.whole(z)
        changes = [("turn", str(i)) for i, tie in enumerate(self.ties) if tie.turned(z)]
        alpha_acc, y_acc, _, ends, *_ = self.motion(t, z)
        for name, (rise, rate, force, arm, bend) in ends.items():
            state = self.corner[name]
            acc = y_acc + arm * alpha_acc + bend * z[3] ** 2
            if state == TOUCHING:
                force_rate = -self.k * rate - self.c * acc
                margin = SIMULTANEOUS * abs(force_rate)
                if name in self.grace and force < -margin:
                    continue
                if force < -margin or (force <= margin and force_rate < 0.0):
                    changes.append(("leave", name))
            elif state == RELAXING:
                if rate > 0.0 and self.delta - rise <= SIMULTANEOUS * rate:
                    changes.append(("clear", name))
                elif rate <= 0.0:
                    changes.append(("settle", name))
            elif rate < 0.0 and rise - self.delta <= SIMULTANEOUS * -rate:
                changes.append(("land", name))
        return changes


def _span(z):
    return tuple(float(one) for one in z[:6])


def simulate(
    *,
    half_width: float,
    half_height: float,
    shape_factor: float,
    frequency_ratio: float,
    damping_ratio: float,
    restitution: float | None = None,
    restraint: str = "contact-state",
    rotation: str = "finite",
    gravity: float = 9.80665,
    time_step: float | None = None,
    acceleration: Sequence[float] | Callable[[float], float] | None = None,
    vertical: Sequence[float] | Callable[[float], float] | None = None,
    breakpoints: Sequence[float] = (),
    duration: float,
    initial: Sequence[float] = (0.0, 0.0, 0.0, 0.0),
    sample_times: Sequence[float] = (),
    rtol: float = 1e-12,
    atol: float = 1e-14,
    overturning: str = "stop",
    restart_every_knot: bool = True,
    steps_per_period: float = 40.0,
    max_step: float | None = None,
    method: str = "DOP853",
    tied: Sequence[ties.Tie] = (),
) -> Result:
    """Integrate a block on two springs from ``initial`` = (alpha, y, alpha', y').

    A sampled acceleration is linear between its samples and zero after the last. A function
    of time is smooth between the given breakpoints. A start with a corner in contact has
    ``x = h sin(alpha) + e (1 - cos(alpha))``; a start in flight has x with ``e = 0`` and no
    horizontal speed.
    """
    run = _Run(
        half_width,
        half_height,
        shape_factor,
        frequency_ratio,
        damping_ratio,
        restitution,
        restraint,
        rotation,
        gravity,
    )
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
        max_step = run.vertical_period / steps_per_period
        if not restart_every_knot and time_step is not None:
            max_step = min(max_step, time_step)

    samples = np.asarray(sample_times, dtype=float)
    if np.any(np.diff(samples) < 0.0):
        msg = "sample_times must not decrease"
        raise ValueError(msg)
    table = np.full((6, samples.size), np.nan)
    contact = np.full(samples.size, "", dtype="U6")
    events: list[Event] = []
    losses = {"repin": 0.0, "impact": 0.0}
    largest = worst = flight = tension = 0.0
    overturned: float | None = None
    ended = False

    # the start
    alpha, y, alpha_dot, y_dot = (float(one) for one in initial)
    z = np.array([alpha, y, 0.0, alpha_dot, y_dot, 0.0, 0.0, 0.0])
    run.side = int(np.sign(alpha) or np.sign(alpha_dot))
    for name, (rise, _, force, *_) in run.motion(0.0, z)[3].items():
        below = TOUCHING if force > 0.0 else RELAXING
        run.set_corner(name, below if rise < run.delta else CLEAR)
    z[2] = run.h * (math.sin(alpha) if run.finite else alpha)
    if run.contact != "flight":
        if run.finite:
            z[2] += run.eccentricity() * (1.0 - math.cos(alpha))
        z[5] = run.lever(alpha)[0] * alpha_dot
    for tie in tied:
        tie.begin(run.h, run.whole(z))
    run.ties = list(tied)
    energy_start = sum(run.energies(z))
    peak = abs(alpha)

    def audit(now):
        nonlocal largest, worst
        terms = run.energies(now)
        broken = sum(tie.loss for tie in run.ties)
        parts = (*terms, now[6], now[7], losses["repin"], losses["impact"], broken)
        largest = max(largest, *(abs(one) for one in parts))
        balance = sum(terms) + now[6] + losses["repin"] + losses["impact"] + broken
        worst = max(worst, abs(balance - energy_start - now[7]))

    def switch(t, z, changes):
        """Carry out the changes that fired, and those that follow at the same instant."""
        nonlocal overturned, ended, tension
        run.grace.clear()
        for _ in range(CASCADE):
            for kind, name in changes:
                if kind in ties.KINDS:
                    run.ties[int(name)].switch(kind, run.whole(z))
                    was, span = run.contact, _span(z)
                    events.append(Event(float(t), kind, name, was, was, span, span))
            order = ("topple", "side", "leave", "slip", "clear", "engage", "settle", "land")
            for kind in order:
                names = "".join(name for what, name in changes if what == kind)
                if not names:
                    continue
                was, before = run.contact, _span(z)
                horizontal = z[5] if was == "flight" else run.lever(z[0])[0] * z[3]
                event = Event(float(t), kind, names, was, was, before, before)
                if kind == "topple":
                    if overturned is None:
                        overturned = t
                    ended = ended or overturning == "stop" or run.limit > run.theta
                    run.limit = 0.5 * math.pi
                elif kind == "side":
                    run.side = -run.side
                else:
                    for name in names:
                        run.grace.discard(name)
                        if kind in ("engage", "settle"):
                            run.grace.add(name)
                        if kind in ("leave", "slip"):
                            rise, arm, _ = run.corners(z[0], z[1])[name]
                            margin = SIMULTANEOUS * abs(z[4] + arm * z[3])
                            below = run.delta - rise > margin
                            run.set_corner(name, RELAXING if below else CLEAR)
                        else:
                            run.set_corner(name, CLEAR if kind == "clear" else TOUCHING)
                    if run.contact != was:
                        event.repinning_loss = run.repin(z, horizontal)
                        losses["repin"] += event.repinning_loss
                    if kind == "land":
                        event.impact_loss, event.impulses, event.struck = run.strike(z, names)
                        losses["impact"] += event.impact_loss
                    event.contact_after, event.after = run.contact, _span(z)
                events.append(event)
            changes = run.due(t, z)
            if not changes:
                ends = run.motion(t, z)[3]
                tension = max(tension, *(-ends[name][2] for name in run.grace), 0.0)
                break
        else:
            msg = f"contact does not settle at t = {float(t)!r}"
            raise ChatterError(msg)
        run.set_guards()

    next_sample = 0

    def record(now, state):
        nonlocal next_sample
        while next_sample < samples.size and samples[next_sample] <= now:
            t = samples[next_sample]
            values = state(t)
            table[:, next_sample] = values[:6]
            if run.contact != "flight":
                table[5, next_sample] = run.lever(values[0])[0] * values[3]
            contact[next_sample] = run.contact
            next_sample += 1

    def record_before(now, state):
        """Record the samples strictly before an event; the others follow after it."""
        if next_sample < samples.size and samples[next_sample] < now:
            record(np.nextafter(now, -np.inf), state)

    now = 0.0
    started = False
    begun_in_flight = run.contact == "flight"
    for start, stop, ground_x, ground_y in drive.pieces():
        run.ground_x, run.ground_y = ground_x, ground_y
        now = start
        if not started:
            started = True
            audit(z)
            beyond = abs(alpha) >= run.theta
            changes = [("topple", "+" if alpha > 0.0 else "-")] if beyond else []
            switch(0.0, z, changes + run.due(0.0, z))
            audit(z)
            record(0.0, lambda _, z=z: z)
        while now < stop and not ended:
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
                states = dense(times)
                if run.restraint == "leading-corner" and run.side == 0 and states[0].any():
                    run.side = int(np.sign(states[0][np.nonzero(states[0])[0][0]]))
                    run.set_guards()
                    now, z = solver.t_old, dense(solver.t_old)
                    break
                pairs = run.guard_values(times, states, np)
                hits = crossings(
                    run.guards,
                    [np.broadcast_to(one[0], times.shape) for one in pairs],
                    [np.broadcast_to(one[1], times.shape) for one in pairs],
                    times,
                    lambda i, t, dense=dense: run.guard_values(t, dense(t))[i],
                )
                first = min((hit for hit in hits if hit is not None), default=None)
                reached = solver.t if first is None else first
                # the largest rotation of the rest of the step
                inside = np.append(times[times < reached], reached)
                swing = dense(inside)[3]
                for j in np.nonzero(swing[:-1] * swing[1:] < 0.0)[0]:
                    top = polish(lambda t, dense=dense: dense(t)[3], inside[j], inside[j + 1])
                    peak = max(peak, abs(float(dense(top)[0])))
                peak = max(peak, abs(float(dense(reached)[0])))
                if run.contact == "flight":
                    flight += reached - solver.t_old
                if first is None:
                    audit(solver.y)
                    now, z = solver.t, solver.y.copy()
                    record(now, dense)
                    continue
                long_ago = events[-CHATTER].time if len(events) >= CHATTER else -math.inf
                if first - long_ago < run.vertical_period / 100.0:
                    msg = f"contact chatters at t = {float(first)!r}"
                    raise ChatterError(msg)
                record_before(first, dense)
                now, z = first, dense(first).copy()
                audit(z)
                changes = []
                for guard, hit, (value, rate) in zip(
                    run.guards, hits, run.guard_values(first, z), strict=True
                ):
                    own = hit is not None and hit <= first + SIMULTANEOUS
                    near = guard.strict and rate < 0.0 and value <= SIMULTANEOUS * -rate
                    if own or near:
                        changes.append((guard.kind, guard.where or "-"))
                switch(first, z, changes)
                audit(z)
                break
            if now >= stop:
                break
        if ended:
            break
    if next_sample < samples.size and samples[next_sample] <= now:
        record(now, lambda _, z=z: z)

    final = sum(run.energies(z))
    landings = [event for event in events if event.kind == "land"]
    return Result(
        time=samples,
        rotation=table[0],
        vertical=table[1],
        horizontal=table[2],
        rotation_rate=table[3],
        vertical_rate=table[4],
        horizontal_rate=table[5],
        contact=contact,
        events=events,
        peak_rotation=peak,
        impact_count=sum(event.struck for event in landings),
        landing_count=len(landings),
        flight_time=float(flight),
        flight_count=begun_in_flight
        + sum(
            event.contact_after == "flight" and event.contact_before != "flight" for event in events
        ),
        peak_tension=tension,
        overturned=overturned is not None,
        overturning_time=None if overturned is None else float(overturned),
        end_time=float(now),
        dashpot_work=float(z[6]),
        input_work=float(z[7]),
        impact_loss=losses["impact"],
        repinning_loss=losses["repin"],
        initial_energy=energy_start,
        final_energy=final,
        energy_residual=worst / largest if largest > 0.0 else 0.0,
        ties=run.ties,
    )
