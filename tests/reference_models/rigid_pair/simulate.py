"""The motion of a pair under a ground motion, from event to event."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from .choices import Outcome, choose_pattern, complementary, projected, strike, touching_of
from .flight import gaps, shift_after
from .ground import Piece
from .pair import ENDS, SIGN, Pair, Pattern, Phase, turned

RESTING = 1e-6
"""A contact that reopens more slowly than this, in sqrt(g / size), stays closed if it presses."""
LEVEL = 1e-9
"""A base lands with both ends below this angle at a small rate [rad]."""
LOOKS = 4
"""Number of samples of the guards within a step."""
MOST_EVENTS = 20000


def first_event(guards, solver, dense, armed, slowness, gone=1e-13):
    """Return time and name of the first guard that fires in a step, and whether to repeat the step.

    `guards` returns values by names, at a time and in a state; `armed` records which have been
    positive, beyond `gone`.
    """
    sample_times = np.linspace(solver.t_old, solver.t, LOOKS + 1)
    for i in range(LOOKS + 1):
        values = guards(sample_times[i], solver.y if i == LOOKS else dense(sample_times[i]))
        fired = []
        for name, value in values.items():
            if value > gone:
                armed[name] = True
            elif value < 0.0 and armed.get(name):
                fired.append(name)
            elif value < -1e-12 and i:
                if solver.t - solver.t_old < 1e-10 * slowness:
                    return (solver.t, name), False
                return None, True
        if fired and i == 0:
            return (solver.t_old, fired[0]), False
        if fired:
            first, values_before = (
                (sample_times[i], ""),
                guards(sample_times[i - 1], dense(sample_times[i - 1])),
            )
            while fired:  # others may fall and rise again before the first of these
                crossings = [
                    (brentq(lambda t, n=n: guards(t, dense(t))[n], sample_times[i - 1], first[0],
                            xtol=1e-15, rtol=1e-15), n)
                    for n in fired
                ]  # fmt: skip
                first = min(crossings)
                values = guards(first[0], dense(first[0]))
                fired = [
                    name for name, value in values.items()
                    if value < -1e-12 and values_before[name] > 0.0 and name != first[1]
                ]  # fmt: skip
            return first, False
    return None, False


@dataclass(frozen=True)
class Event:
    """A change of the pattern.

    ``kind`` is "uplift", "flight", "impact", "rest" or "overturning"; "held" where contacts stay
    without pressing, as no pattern is admissible, and "pressed" where they press again.
    ``admissible`` is 1 where the continuation is unique; ``gap`` is then the distance of the
    velocities from those of the complementary impulses.
    """

    time: float
    kind: str
    where: str
    before: Pattern
    after: Pattern
    admissible: int = 1
    lost: float = 0.0
    gap: float = 0.0
    others: tuple = ()


@dataclass
class Run:
    """Results of a run; rotations of the lower body, then of the upper one."""

    time: np.ndarray
    place: np.ndarray
    events: list[Event] = field(default_factory=list)
    peaks: np.ndarray = field(default_factory=lambda: np.zeros(2))
    overturned: bool = False
    end: float = 0.0
    energies: tuple = (0.0, 0.0, 0.0, 0.0)
    imbalance: float = 0.0

    @property
    def unique_until(self) -> float:
        """Time of the first event after which motion is not unique [s]."""
        return next(
            (closed_phase.time for closed_phase in self.events if closed_phase.admissible != 1),
            math.inf,
        )


class _Running:
    """A run in progress."""

    def __init__(self, pair: Pair, output: np.ndarray, accuracy: float, longest: float):
        self.pair, self.accuracy = pair, accuracy
        self.phase = Phase(pair, Pattern("both", "both"), pair.offset)
        self.place = self.phase.placed(np.zeros(0))
        self.speed = np.zeros(6)
        self.work = self.lost = 0.0
        self.now, self.step = 0.0, 0.01 * pair.slowness
        self.longest = longest
        self.slow = RESTING / pair.slowness
        self.floor: dict = {}  # initial values of gaps that begin at zero up to rounding
        self.pulled: set = set()  # whether hinges are held although they do not press
        self.run = Run(output, np.full((output.size, 6), np.nan))
        self.shown = 0
        self.start = pair.energy(self.place, self.speed)
        self.largest = 0.0

    # states ---------------------------------------------------------------------------------

    def unpack(self, state):
        """Return positions and velocities of both bodies from the integrated state."""
        n = self.phase.size
        place = self.phase.placed(state[:n])
        jac, _ = self.phase.motions(place[2], place[5])
        return place, jac @ state[n : 2 * n]

    def packed(self):
        """Return the integrated state."""
        phase = self.phase
        q, rates = phase.coordinates(self.place), phase.coordinates(self.speed)
        return np.concatenate([q, rates, [self.work]])

    def slopes(self, t, state):
        """Return the derivative of the state, of which the last is the work of the ground."""
        phase, n = self.phase, self.phase.size
        joint = phase.pattern.joint
        rates = state[n : 2 * n]
        k = phase.of_lower
        first = state[k - 1] if k else 0.0
        rate = rates[k - 1] if k else 0.0
        second, other = (first, rate) if joint == "both" else (state[n - 1], rates[n - 1])
        across, up = self.piece.across(t), self.piece.up(t)
        second_rates, _ = phase.accelerate(first, second, rate, other, across, up)
        jac, _ = phase.motions(first, second)
        masses = phase.masses
        power = -(masses * [across, up, 0.0, across, up, 0.0]) @ (jac @ rates)
        return np.concatenate([rates, second_rates, [power]])

    # guards ---------------------------------------------------------------------------------

    def guards(self, t, state) -> dict:
        """Return the guards."""
        phase = self.phase
        place, speed = self.unpack(state)
        guards = {}
        across, up = self.piece.across(t), self.piece.up(t)
        if phase.pattern != ("none", "none"):
            _, acceleration = phase.accelerate(place[2], place[5], speed[2], speed[5], across, up)
            scale = self.pair.gravity * phase.masses[3]
            needed = phase.needed(acceleration, across, up)
            for name, push in phase.pressures(place, needed).items():
                if name not in self.pulled:
                    guards["press", *name] = push / scale
        if self.pulled:
            guards["let", "go", ""] = (
                1.0 if self._may_open(place, speed, across, up) is None else -1.0
            )
        tilt, relative = place[2], place[5] - place[2]
        if phase.pattern.ground in SIGN:
            guards["gap", "ground", phase.pattern.ground] = SIGN[phase.pattern.ground] * tilt
        elif phase.pattern.ground == "none":
            for end, at in phase.seats.ground.items():
                height = place[1] + turned(tilt, *at)[1]
                guards["gap", "ground", end] = height / self.pair.lower.half_width
        if phase.pattern.joint in SIGN:
            guards["gap", "joint", phase.pattern.joint] = SIGN[phase.pattern.joint] * relative
        elif phase.pattern.joint == "none":
            guards.update(gaps(self.pair, place))
        for name in guards:
            if name[0] == "gap":
                guards[name] -= self.floor.setdefault(name, max(-1e-9, min(guards[name], 0.0)))
        for name, angle, (left, right) in zip(
            ("lower", "upper"), (tilt, place[5]), self.pair.limits, strict=True
        ):
            guards["overturn", name, "left"] = angle - left
            guards["overturn", name, "right"] = right - angle
        return guards

    def _may_open(self, place, speed, across, up):
        """Return the outcome without the pulled hinges, or None if no accelerations allow it."""
        touching = touching_of(self.phase.pattern)
        return choose_pattern(self.phase, place, speed, touching, across, up)

    # changes --------------------------------------------------------------------------------

    def note(self, kind, where, before, outcome: Outcome | None = None, gap=0.0):
        """Store an event."""
        if len(self.run.events) >= MOST_EVENTS:
            msg = f"too many events, at {self.now} s"
            raise RuntimeError(msg)
        admissible = 1 if outcome is None else outcome.admissible
        lost = 0.0 if outcome is None else outcome.lost
        others = (
            () if outcome is None else tuple(closed_phase[0] for closed_phase in outcome.others)
        )
        self.run.events.append(
            Event(self.now, kind, where, before, self.phase.pattern, admissible, lost, gap, others)
        )

    def take(self, pattern: Pattern, shift=None):
        """Enter a pattern."""
        shift = self.phase.shift if shift is None else shift
        anchor = self.phase.anchor
        if pattern.ground != "none":
            end = "left" if pattern.ground == "both" else pattern.ground
            seat = turned(self.place[2], *self.phase.seats.ground[end])
            anchor = self.place[0] + seat[0] - SIGN[end] * self.pair.lower.half_width
        self.phase = Phase(self.pair, pattern, shift, anchor)
        self.pulled, self.floor = set(), {}

    def settle(self, apart=None):
        """Open contacts that the forces do not hold."""
        across, up = self.piece.across(self.now), self.piece.up(self.now)
        phase = self.phase
        touching = touching_of(phase.pattern)
        outcome = choose_pattern(phase, self.place, self.speed, touching, across, up, apart)
        if outcome is None:
            # no pattern is admissible: hold touching contacts, though they do not press
            if not self.pulled:
                self.pulled = {(key, end) for key, ends in touching.items() for end in ends}
                self.note("held", "", phase.pattern, Outcome(phase.pattern, self.speed, 0))
            return
        before = phase.pattern
        if outcome.pattern == before and not self.pulled:
            return
        self.take(outcome.pattern)
        kind = "flight" if "none" in outcome.pattern else "uplift"
        kind = "pressed" if outcome.pattern == before else kind
        self.note(kind, "" if apart is None else apart[0], before, outcome)

    def hit(self, key, end):
        """Close contacts by an impact."""
        before = self.phase.pattern
        touching = dict(touching_of(before))
        shift = self.phase.shift
        if key == "joint" and before.joint == "none":
            kind, end = end.split()
            shift = shift_after(self.pair, self.place, kind, end)
            level = self._is_level(self.place[5] - self.place[2], self.speed[5] - self.speed[2])
            touching["joint"] = ENDS if level else (end,)
        elif key == "ground" and before.ground == "none":
            level = self._is_level(self.place[2], self.speed[2])
            touching["ground"] = ENDS if level else (end,)
        else:
            touching[key] = ENDS
            self.place = self._flush(key)
        outcome = strike(self.pair, shift, self.place, self.speed, touching, self.phase.anchor)
        gap = 0.0
        if outcome.admissible == 1:
            seats = Phase(self.pair, Pattern("both", "both"), shift).seats
            other = complementary(seats, self.pair.masses, self.place, self.speed, touching)[1]
            gap = float(np.max(np.abs(other - outcome.motion)))
        self.lost += outcome.lost
        self.phase.shift = shift
        self.speed = outcome.motion
        self.take(outcome.pattern, shift)
        self.note("impact", key, before, outcome, gap)
        self._rest()
        self.settle()

    def _is_level(self, angle, rate) -> bool:
        """Tell whether a base lands with both ends, up to a negligible rotation."""
        return abs(angle) < LEVEL and abs(rate) < 1e3 * self.slow

    def _flush(self, key):
        """Return the positions with an angle that is zero up to rounding set to zero."""
        place = self.place.copy()
        if key == "ground":
            place[2] = 0.0
        else:
            place[5] = place[2]
        phase = self.phase
        return phase.placed(phase.coordinates(place))

    def _rest(self):
        """Close contacts that reopen so slowly that impacts would be endless."""
        phase, rates = self.phase, self.speed
        tiny = []
        if phase.pattern.ground in SIGN and abs(rates[2]) < self.slow and self.place[2] == 0.0:
            tiny.append("ground")
        level = abs(self.place[5] - self.place[2]) < 1e-15
        if phase.pattern.joint in SIGN and abs(rates[5] - rates[2]) < self.slow and level:
            tiny.append("joint")
        across, up = self.piece.across(self.now), self.piece.up(self.now)
        for some in [tiny] if len(tiny) < 2 else [tiny, tiny[:1], tiny[1:]]:
            if not some:
                return
            pattern = phase.pattern._replace(**dict.fromkeys(some, "both"))
            closed_phase = Phase(self.pair, pattern, phase.shift, phase.anchor)
            speed = projected(closed_phase, self.place, rates)
            _, after = closed_phase.accelerate(
                self.place[2], self.place[5], speed[2], speed[5], across, up
            )
            pushes = closed_phase.pressures(self.place, closed_phase.needed(after, across, up))
            if min(pushes.values()) >= 0.0:
                masses = self.pair.masses
                lost = 0.5 * float(masses @ rates**2 - masses @ speed**2)
                before = phase.pattern
                self.speed = speed
                self.lost += lost
                self.take(pattern)
                self.note("rest", "+".join(some), before, Outcome(pattern, speed, 1, lost))
                return

    # time -----------------------------------------------------------------------------------

    def show(self, until, state_at):
        """Fill in the output times up to now."""
        times = self.run.time
        while self.shown < times.size and times[self.shown] <= until:
            place, _ = self.unpack(state_at(times[self.shown]))
            self.run.place[self.shown] = place
            self.shown += 1

    def peak(self, place):
        """Update the greatest rotations."""
        self.run.peaks = np.maximum(self.run.peaks, np.abs(place[[2, 5]]))

    def audit(self):
        """Compare the energy with the work of the ground and the losses."""
        kinetic = 0.5 * float(self.pair.masses @ self.speed**2)
        energy = self.pair.energy(self.place, self.speed)
        size = max(abs(energy - self.start), abs(self.work), self.lost, kinetic)
        self.largest = max(self.largest, size)
        gap = abs(energy - self.start + self.lost - self.work)
        self.run.imbalance = max(self.run.imbalance, gap)

    def wait(self, stop):
        """Stay at rest until the ground lifts a contact, or to the end."""
        state = self.packed()

        def least(t):
            return min(v for k, v in self.guards(t, state).items() if k[0] == "press")

        sample_times = np.linspace(self.now, stop, 2 if self.piece.linear else 101)
        values = [least(t) for t in sample_times]
        end, name = stop, None
        for i in range(1, sample_times.size):
            if values[i] < 0.0:
                end = sample_times[i - 1]
                if values[i - 1] > 0.0:
                    end = brentq(
                        least, sample_times[i - 1], sample_times[i], xtol=1e-15, rtol=1e-15
                    )
                guards = self.guards(sample_times[i], state)
                # a linear motion may lift two ends within a piece: the first counts
                name = min(
                    (k for k in guards if guards[k] < 0.0),
                    key=lambda k: self._root(k, sample_times[i - 1], sample_times[i], state),
                )
                break
        self.show(end, lambda t: state)
        self.now = end
        return name

    def _root(self, name, low, high, state):
        """Return the time at which a guard vanishes in a constant state."""
        value = lambda t: self.guards(t, state)[name]  # noqa: E731
        return low if value(low) <= 0.0 else brentq(value, low, high, xtol=1e-15, rtol=1e-15)

    def advance(self, stop):
        """Integrate up to the first event or to `stop`; return the event."""
        armed: dict = {}
        cut = 1.0
        while self.now < stop:
            state = self.packed()
            solver = DOP853(
                self.slopes, self.now, state, stop, max_step=self.longest * cut,
                rtol=self.accuracy, atol=1e-14,
                first_step=min(self.step, self.longest, stop - self.now) * cut,
            )  # fmt: skip
            while solver.status == "running":
                solver.step()
                if solver.status == "failed":
                    msg = f"the integration fails at {solver.t} s"
                    raise RuntimeError(msg)
                if solver.t < stop:
                    self.step = solver.step_size
                dense = solver.dense_output()
                hit, again = first_event(self.guards, solver, dense, armed, self.pair.slowness)
                if again:
                    # a guard that began at zero is negative: repeat with shorter steps
                    cut *= 0.125
                    break
                cut = 1.0
                end = solver.t if hit is None else hit[0]
                self._peaks(solver.t_old, end, dense)
                self.show(end if hit is None else np.nextafter(end, -np.inf), dense)
                final = solver.y if hit is None else dense(end)
                self.now = end
                self.place, self.speed = self.unpack(final)
                self.work = float(final[-1])
                self.audit()
                if hit is not None:
                    return hit[1]
                if solver.max_step < self.longest and solver.status == "running":
                    break
        return None

    def _peaks(self, start, end, dense):
        """Find the greatest rotations within a step."""
        _, closed_phase = self.unpack(dense(start))
        place, two = self.unpack(dense(end))
        self.peak(place)
        for k in (2, 5):
            if closed_phase[k] * two[k] < 0.0:
                top = brentq(lambda t, k=k: self.unpack(dense(t))[1][k], start, end, xtol=1e-15)
                self.peak(self.unpack(dense(top))[0])

    def answer(self, name) -> bool:
        """Carry out an event; tell whether the run continues."""
        kind, key, end = name
        if kind == "overturn":
            self.run.overturned = True
            self.note("overturning", key, self.phase.pattern)
            return False
        if kind == "press":
            self.settle((key, end))
        elif kind == "let":
            self.settle()
        else:
            self.hit(key, end)
        return True


def simulate(
    pair: Pair,
    pieces: Sequence[Piece],
    output_step: float,
    *,
    start: tuple[Pattern, Sequence[float], Sequence[float]] | None = None,
    accuracy: float = 1e-12,
    quickest: float = math.inf,
) -> Run:
    """Run a pair under a ground motion.

    Parameters
    ----------
    pair : Pair
    pieces : sequence of Piece
        Consecutive, from time zero.
    output_step : float
        [s]
    start : tuple, optional
        Pattern, its coordinates and their rates; upright and at rest unless given.
    accuracy : float
        Relative tolerance of a step.
    quickest : float
        Least period of the ground motion [s].

    Returns
    -------
    Run
    """
    stop = pieces[-1].stop
    output = np.arange(math.floor(stop / output_step * (1.0 + 1e-12)) + 1) * output_step
    longest = min(0.04 * pair.slowness, 0.02 * quickest)
    now = _Running(pair, output, accuracy, longest)
    if start is not None:
        now.phase = Phase(pair, start[0], pair.offset)
        now.place = now.phase.placed(np.asarray(start[1], dtype=float))
        jac, _ = now.phase.motions(now.place[2], now.place[5])
        now.speed = jac @ np.asarray(start[2], dtype=float)
        now.start = pair.energy(now.place, now.speed)
        now.peak(now.place)
    goes_on, before = True, np.full(2, np.inf)
    for piece in pieces:
        now.piece = piece
        if not goes_on:
            break
        values = np.array([piece.across(piece.start), piece.up(piece.start)])
        if np.any(np.abs(values - before) > 1e-9 * pair.gravity):
            now.settle()  # the ground acceleration jumps here
        before = np.array([piece.across(piece.stop), piece.up(piece.stop)])
        while goes_on and now.now < piece.stop:
            resting = now.phase.size == 0
            name = now.wait(piece.stop) if resting else now.advance(piece.stop)
            if name is not None:
                goes_on = now.answer(name)
    now.run.end = now.now
    now.run.energies = (now.start, pair.energy(now.place, now.speed), now.work, now.lost)
    now.run.imbalance /= max(now.largest, 1e-300)
    now.run.time = output[: now.shown]
    now.run.place = now.run.place[: now.shown]
    return now.run
