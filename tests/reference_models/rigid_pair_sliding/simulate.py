"""The motion of a pair that slides and rocks, from event to event."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from reference_models.rigid_pair.ground import Piece
from reference_models.rigid_pair.pair import ENDS, SIGN, Pair
from reference_models.rigid_pair.simulate import LEVEL, LOOKS, MOST_EVENTS, RESTING
from scipy.integrate import DOP853
from scipy.optimize import brentq

from .choices import Ended, Frictions, Outcome, Touch, follow, strike
from .contacts import (
    INTERFACES,
    STANDING,
    Bearing,
    Pattern,
    height,
    middle_slips,
    on_top,
    standing,
    tidied,
)
from .drawing import Scene, pieces_for

GONE = 1e-13
"""From which value a guard counts; in m/s the speed of what no longer slips."""
STATE = 17
"""Six places, six velocities, slips of ground and joint, work of the ground, of both frictions."""


class OffTheTopError(RuntimeError):
    """An end of the upper base leaves the top of the lower body. ``run`` is what was before."""

    def __init__(self, time: float, run: "Run"):
        super().__init__(f"the upper base leaves the top of the lower body at {time} s")
        self.time, self.run = time, run


@dataclass(frozen=True)
class Event:
    """A change of the pattern.

    ``kind`` is "uplift", "flight", "impact", "rest", "slip", "stick", "reversal" or "overturning";
    "held" where contacts stay that do not press, as no pattern is admissible, and "same" where
    such ones press again, or where a pattern goes on that is not the only one. ``where`` is the
    interface that it is about, or the body that overturns; ``end`` the end that opens or closes.
    """

    time: float
    kind: str
    where: str
    end: str
    before: Pattern
    after: Pattern
    admissible: int = 1
    lost: float = 0.0
    others: tuple[Pattern, ...] = ()


@dataclass
class Run:
    """What a run gives; of the lower body or the ground first, then of the upper one or the joint.

    ``displacement`` is that of the centres of mass across; ``slip`` that of the end that bears
    along the surface, in flight of the middle of the base.
    """

    time: np.ndarray
    place: np.ndarray
    slip: np.ndarray
    events: list[Event] = field(default_factory=list)
    peaks: np.ndarray = field(default_factory=lambda: np.zeros(2))
    peak_slips: np.ndarray = field(default_factory=lambda: np.zeros(2))
    overturned: bool = False
    end: float = 0.0
    energies: dict[str, float] = field(default_factory=dict)
    imbalance: float = 0.0
    final: np.ndarray = field(default_factory=lambda: np.zeros(STATE))

    @property
    def rotation(self) -> np.ndarray:
        """Absolute rotations, clockwise [rad]."""
        return self.place[:, [2, 5]]

    @property
    def displacement(self) -> np.ndarray:
        """Displacements of the centres of mass across [m]."""
        return self.place[:, [0, 3]] - self.place[0, [0, 3]]

    @property
    def unique_until(self) -> float:
        """Time of the first event after which motion is not unique [s]."""
        return next((one.time for one in self.events if one.admissible != 1), math.inf)


class _Running:
    """A run as it goes."""

    def __init__(self, pair, frictions, output, accuracy, longest):
        self.pair, self.frictions, self.accuracy = pair, frictions, accuracy
        self.pattern = STANDING
        self.state = np.zeros(STATE)
        self.state[:6] = standing(pair)
        self.now, self.step, self.longest = 0.0, 0.01 * pair.slowness, longest
        self.slow = RESTING / pair.slowness
        self.lost, self.largest = 0.0, 0.0
        self.least = np.full(STATE, 1e-14)  # absolute tolerances
        self.least[14:] *= pair.gravity * pair.weights @ self.state[:6]
        self.floor: dict = {}  # of gaps that begin at zero but for rounding
        self.pulled = False  # contacts are held that do not press
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
        """Give the ends that bear."""
        return dict(zip(INTERFACES, (one.ends for one in pattern or self.pattern), strict=True))

    def touch(self, place, speed, touching=None) -> Touch:
        """Give the contacts as they are."""
        touching = touching or self.touching()
        return Touch(self.pair, self.frictions, place, speed, touching)

    def forces(self, t, state):
        """Give the contacts, and accelerations and forces of the pattern."""
        touch = self.touch(state[:6], state[6:12])
        fall = touch.fall(self.piece.across(t), self.piece.up(t))
        return touch, touch.solve(self.pattern, fall, turning=True)

    def slip_rates(self, touch: Touch, state) -> list[float]:
        """Give the velocities of slip; in flight those of the middles of the bases."""
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
        """Give the derivative of the state."""
        touch, answer = self.forces(t, state)
        speed, slips = state[6:12], self.slip_rates(touch, state)
        burnt = [
            -answer.friction.get(key, 0.0) * rate
            for key, rate in zip(INTERFACES, slips, strict=True)
        ]
        masses, (ax, ay) = self.pair.masses, (self.piece.across(t), self.piece.up(t))
        work = -masses[0] * (ax * speed[0] + ay * speed[1])
        work -= masses[3] * (ax * speed[3] + ay * speed[4])
        return np.concatenate([speed, answer.motion, slips, [work], burnt])

    def tidied(self, state):
        """Give a state without what steps add to it by rounding."""
        state = state.copy()
        state[:6] = tidied(self.pair, self.pattern, state[:6])
        state[6:12] = self.projected(self.pattern, state[:6], state[6:12])
        return state

    def projected(self, pattern: Pattern, place, speed):
        """Stop what a pattern holds, without friction where it slips."""
        touch = self.touch(place, speed, self.touching(pattern))
        rows = []
        for key, bearing in zip(INTERFACES, pattern, strict=True):
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
        """Give what must stay positive."""
        pair, found, place = self.pair, {}, state[:6]
        touch, answer = self.forces(t, state)
        scale = pair.gravity * pair.upper.mass
        if self.pulled:
            found["let", "go", ""] = -1.0 if self._followed(t, state) else 1.0
        for name, push in answer.normal.items():
            if not self.pulled:
                found["press", *name] = push / scale
        rates = self.slip_rates(touch, state)
        for key, bearing, rate in zip(INTERFACES, self.pattern, rates, strict=True):
            if bearing.slip:
                found["slip", key, ""] = bearing.slip * rate
            elif bearing.ends and not self.pulled and not self.frictions[key].holds:
                most = self.frictions[key].static * answer.pressed(key)
                for end, way in SIGN.items():
                    found["grip", key, end] = (most - way * answer.friction[key]) / scale
        self._add_gaps(found, place)
        for name, value in found.items():
            if name[0] == "gap":
                found[name] -= self.floor.setdefault(name, max(-1e-9, min(value, 0.0)))
        for name, angle, (left, right) in zip(
            ("lower", "upper"), (place[2], place[5]), pair.limits, strict=True
        ):
            found["overturn", name, "left"] = angle - left
            found["overturn", name, "right"] = right - angle
        return found

    def _add_gaps(self, found, place):
        """Add how far ends are from their surfaces, and those of the upper base from the edges."""
        angles = {"ground": place[2], "joint": place[5] - place[2]}
        for key, bearing in zip(INTERFACES, self.pattern, strict=True):
            if len(bearing.ends) == 1:
                (end,) = bearing.ends
                other = ENDS[end == "left"]
                found["gap", key, other] = SIGN[end] * angles[key]
        half = self.pair.lower.half_width
        for end in ENDS:
            if not self.pattern.ground.ends:
                found["gap", "ground", end] = height(self.pair, place, end) / half
            if self.pattern.joint.ends and not self.pattern.joint.slip:
                continue
            along, above = on_top(self.pair, place, end)
            if not self.pattern.joint.ends:
                found["gap", "joint", end] = above / half
            found["off", "joint", end] = 1.0 - abs(along) / half + 1e-9

    # changes ------------------------------------------------------------------------------------

    def note(self, kind, where, end, before, outcome: Outcome | None = None, admissible=1):
        """Keep an event."""
        if len(self.run.events) >= MOST_EVENTS:
            msg = f"too many events, at {self.now} s"
            raise RuntimeError(msg)
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

    def _followed(self, t, state, ended: Ended | None = None) -> Outcome | None:
        """Give the pattern that the forces ask for."""
        before, moving = self.pattern, {}
        touch = self.touch(state[:6], state[6:12])
        for key, bearing in zip(INTERFACES, before, strict=True):
            moving[key] = 0
            if bearing.slip:
                rate = touch.along(key, bearing.ends[0], state[6:12], False)
                moving[key] = bearing.slip if bearing.slip * rate > GONE else 0
        return follow(touch, before, moving, self.piece.across(t), self.piece.up(t), ended)

    def settle(self, ended: Ended | None = None):
        """Let contacts open, slip and hold as the forces demand."""
        found = self._followed(self.now, self.state, ended)
        if found is None:
            # no pattern does: hold what touches, though it does not press
            if not self.pulled:
                self.pulled = True
                key, end = ("", "") if ended is None else ended
                self.note("held", key, end, self.pattern, admissible=0)
            return
        before, pulled = self.pattern, self.pulled
        if found.pattern == before and not pulled and found.admissible == 1:
            return
        self.take(found.pattern)
        self.note(*_change(before, found.pattern), before, found)

    def stop_slip(self, key):
        """Bring a slip to its end, and let it stick or turn round."""
        before = self.pattern
        bearing = before[INTERFACES.index(key)]
        held = before._replace(**{key: bearing._replace(slip=0)})
        self.state[6:12] = self.projected(held, self.place, self.speed)
        self.settle()
        if self.pattern == before:
            msg = f"a slip neither ends nor turns round, at {self.now} s"
            raise ArithmeticError(msg)

    def hit(self, key, end):
        """Let an end close by an impact."""
        before = self.pattern
        touching = self.touching()
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
            # laid down from hardly any height
            self.lost += high - self.pair.gravity * self.pair.weights @ self.place
        outcome = strike(self.pair, self.frictions, self.place, self.speed, touching)
        self.lost += outcome.lost
        self.state[6:12] = outcome.answer.motion
        self.take(outcome.pattern)
        self.note("impact", key, end, before, outcome)
        self._rest()
        self.settle()

    def _rest(self):
        """Close contacts that reopen so slowly that impacts would have no end."""
        tiny = []
        angles = {"ground": self.place[2], "joint": self.place[5] - self.place[2]}
        rates = {"ground": self.speed[2], "joint": self.speed[5] - self.speed[2]}
        for key, bearing in zip(INTERFACES, self.pattern, strict=True):
            if len(bearing.ends) == 1 and abs(rates[key]) < self.slow and abs(angles[key]) < 1e-15:
                tiny.append(key)
        across, up = self.piece.across(self.now), self.piece.up(self.now)
        before = self.pattern
        for some in [tiny] if len(tiny) < 2 else [tiny, tiny[:1], tiny[1:]]:
            if not some:
                return
            closed = {key: before[INTERFACES.index(key)]._replace(ends=ENDS) for key in some}
            pattern = before._replace(**closed)
            # of many small bounces normal impulses and friction add up to these
            touch = self.touch(self.place, self.speed, self.touching(pattern))
            speed = touch.solve(pattern, self.speed, turning=False).motion
            touch = self.touch(self.place, speed, self.touching(pattern))
            moving = dict(zip(INTERFACES, (one.slip for one in pattern), strict=True))
            found = follow(touch, pattern, moving, across, up)
            if found is None or self.touching(found.pattern) != self.touching(pattern):
                continue
            masses = self.pair.masses
            lost = 0.5 * float(masses @ self.speed**2 - masses @ speed**2)
            self.state[6:12] = speed
            self.lost += lost
            self.take(pattern)
            self.note("rest", "+".join(some), "", before, found._replace(lost=lost))
            return

    # time ---------------------------------------------------------------------------------------

    def show(self, until, state_at):
        """Fill in the output times up to now."""
        times = self.run.time
        while self.shown < times.size and times[self.shown] <= until:
            state = state_at(times[self.shown])
            self.run.place[self.shown], self.run.slip[self.shown] = state[:6], state[12:14]
            self.shown += 1

    def peak(self, state):
        """Keep the greatest rotations and slips."""
        run = self.run
        run.peaks = np.maximum(run.peaks, np.abs(state[[2, 5]]))
        run.peak_slips = np.maximum(run.peak_slips, np.abs(state[12:14]))

    def energy(self):
        """Give kinetic energy and that of gravity [J]."""
        return self.pair.energy(self.place, self.speed)

    def audit(self):
        """Compare the energy with the work of the ground, friction and the losses."""
        work, burnt = float(self.state[14]), float(self.state[15:17].sum())
        change = self.energy() - self.start
        kinetic = 0.5 * float(self.pair.masses @ self.speed**2)
        self.largest = max(self.largest, abs(change), abs(work), burnt, self.lost, kinetic)
        gap = abs(change + self.lost + burnt - work)
        self.run.imbalance = max(self.run.imbalance, gap)

    def rests(self) -> bool:
        """Tell whether nothing can move in the pattern."""
        return self.pattern == STANDING

    def wait(self, stop):
        """Stay at rest up to the time at which the ground moves something, or to the end."""
        state = self.state

        def kept(t):
            return {k: v for k, v in self.guards(t, state).items() if k[0] in ("press", "grip")}

        looks = np.linspace(self.now, stop, 2 if self.piece.linear else 101)
        end, name, low = stop, None, kept(looks[0])
        for i in range(1, looks.size):
            high = kept(looks[i])
            fired = [k for k, v in high.items() if v < 0.0]
            if fired:
                times = {
                    k: looks[i - 1] if low[k] <= 0.0 else brentq(
                        lambda t, k=k: kept(t)[k], looks[i - 1], looks[i], xtol=1e-15, rtol=1e-15
                    )
                    for k in fired
                }  # fmt: skip
                name = min(fired, key=lambda k: times[k])
                end = times[name]
                break
            low = high
        self.show(end, lambda t: state)
        self.now = end
        return name

    def advance(self, stop):
        """Integrate up to the first event or to `stop`; give the event."""
        armed: dict = {}
        cut = 1.0
        while self.now < stop:
            solver = DOP853(
                self.slopes, self.now, self.state, stop, max_step=self.longest * cut,
                rtol=self.accuracy, atol=self.least,
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
                kept = dict(armed)
                hit, again = self._first(solver, dense, armed)
                if again:
                    # a guard that began at zero is negative: look more closely
                    armed = kept
                    cut *= 0.125
                    break
                cut = 1.0
                end = solver.t if hit is None else hit[0]
                self._peaks(solver.t_old, end, dense)
                self.show(end if hit is None else np.nextafter(end, -np.inf), dense)
                self.now = end
                self.state = self.tidied(solver.y if hit is None else dense(end))
                self.audit()
                if hit is not None:
                    return hit[1]
                solver.y = self.state
                solver.f = self.slopes(solver.t, solver.y)
                if solver.max_step < self.longest and solver.status == "running":
                    break
        return None

    def _first(self, solver, dense, armed):
        """Give time and name of the first guard that fires in a step; or tell to step again."""
        looks = np.linspace(solver.t_old, solver.t, LOOKS + 1)
        for i in range(LOOKS + 1):
            values = self.guards(looks[i], solver.y if i == LOOKS else dense(looks[i]))
            fired = []
            for name, value in values.items():
                if value > GONE:
                    armed[name] = True
                elif value < 0.0 and armed.get(name):
                    fired.append(name)
                elif value < -1e-12 and i:
                    if solver.t - solver.t_old < 1e-10 * self.pair.slowness:
                        return (solver.t, name), False
                    return None, True
            if fired and i == 0:
                return (solver.t_old, fired[0]), False
            if fired:
                found = [
                    (brentq(lambda t, n=n: self.guards(t, dense(t))[n], looks[i - 1], looks[i],
                            xtol=1e-15, rtol=1e-15), n)
                    for n in fired
                ]  # fmt: skip
                return min(found), False
        return None, False

    def _peaks(self, start, end, dense):
        """Find the greatest rotations and slips within a step."""
        one, two = dense(start), dense(end)
        self.peak(two)
        tops = [k for k in (8, 11) if one[k] * two[k] < 0.0]
        found = [brentq(lambda t, k=k: dense(t)[k], start, end, xtol=1e-15) for k in tops]
        for i, bearing in enumerate(self.pattern):
            if not bearing.ends:
                rate = lambda t, i=i: middle_slips(self.pair, dense(t)[:6], dense(t)[6:12])[i]  # noqa: E731
                if rate(start) * rate(end) < 0.0:
                    found.append(brentq(rate, start, end, xtol=1e-15))
        for top in found:
            self.peak(dense(top))

    def answer(self, name) -> bool:
        """Do what an event asks for; tell whether the run goes on."""
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
        return True


def _change(before: Pattern, after: Pattern) -> tuple[str, str, str]:
    """Name a change without an impact: what, in which interface, and of which end."""
    both = list(zip(INTERFACES, before, after, strict=True))
    for key, one, two in both:
        gone = [end for end in one.ends if end not in two.ends]
        if gone:
            kind = "uplift" if two.ends else "flight"
            return kind, key, gone[0] if len(gone) == 1 else ""
    for key, one, two in both:
        if one.slip and one.slip != two.slip:
            return ("reversal" if two.slip else "stick"), key, ""
    for key, one, two in both:
        if one != two:
            return "slip", key, ""
    return "same", "", ""


def simulate(scene: Scene, output_step: float = 0.01, **options) -> Run:
    """Simulate a scene, by `simulate_pair`."""
    pieces, period = pieces_for(scene.motion)
    return simulate_pair(
        scene.pair, scene.frictions, pieces, output_step, quickest=period, **options
    )


def simulate_pair(
    pair: Pair,
    frictions: Frictions,
    pieces: Sequence[Piece],
    output_step: float,
    *,
    accuracy: float = 1e-11,
    quickest: float = math.inf,
    start: tuple | None = None,
) -> Run:
    """Simulate two bodies that stand on one another.

    Parameters
    ----------
    pair : Pair
    frictions : dict
        A `Friction` of the ground and of the joint.
    pieces : sequence of Piece
        Ground motion.
    output_step : float
        [s]
    accuracy : float
        Relative tolerance of a step.
    quickest : float
        Least period of the ground motion [s].
    start : tuple, optional
        Pattern, six places and six velocities at the start.

    Returns
    -------
    Run

    Raises
    ------
    ValueError
        The upper base does not stand within the top of the lower body.
    OffTheTopError
        It leaves it.
    """
    if abs(pair.offset) + pair.upper.half_width > pair.lower.half_width * (1.0 + 1e-12):
        msg = "the upper base must stand within the top of the lower body"
        raise ValueError(msg)
    stop = pieces[-1].stop
    output = np.arange(math.floor(stop / output_step * (1.0 + 1e-12)) + 1) * output_step
    longest = min(0.04 * pair.slowness, 0.02 * quickest)
    now = _Running(pair, frictions, output, accuracy, longest)
    now.piece = pieces[0]
    if start is not None:
        now.pattern = start[0]
        now.state[:6], now.state[6:12] = start[1], start[2]
        now.state = now.tidied(now.state)
        now.peak(now.state)
    now.start = now.energy()
    try:
        _go(now, pieces)
    finally:
        _finish(now, output)
    return now.run


def _go(now: _Running, pieces: Sequence[Piece]) -> None:
    """Run through the pieces of the ground motion."""
    before = np.full(2, np.inf)
    for piece in pieces:
        now.piece = piece
        values = np.array([piece.across(piece.start), piece.up(piece.start)])
        if np.any(np.abs(values - before) > 1e-9 * now.pair.gravity):
            now.settle()  # the ground acceleration jumps here
        before = np.array([piece.across(piece.stop), piece.up(piece.stop)])
        while now.now < piece.stop:
            name = now.wait(piece.stop) if now.rests() else now.advance(piece.stop)
            if name is not None and not now.answer(name):
                return


def _finish(now: _Running, output) -> None:
    """Keep what the end of a run gives."""
    run = now.run
    run.end, run.final = now.now, now.state
    run.energies = {
        "change": now.energy() - now.start, "work": float(now.state[14]), "impacts": now.lost,
        "ground": float(now.state[15]), "joint": float(now.state[16]),
    }  # fmt: skip
    run.imbalance /= max(now.largest, 1e-300)
    run.time, run.place = output[: now.shown], run.place[: now.shown]
    run.slip = run.slip[: now.shown]
