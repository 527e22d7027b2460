"""The motion of a pair that slides and rocks, from event to event."""

import math
from collections.abc import Sequence

import numpy as np
from reference_models.rigid_pair.ground import Piece
from reference_models.rigid_pair.pair import Pair
from reference_models.rigid_pair.simulate import first_event
from scipy.integrate import DOP853
from scipy.optimize import brentq

from .choices import Frictions
from .compliant_bases import CompliantBases, CompliantPair
from .contacts import STANDING, middle_slips
from .events import Run
from .moving_pair import GONE, MovingPair
from .random_scenes import Scene, pieces_for


class _Running(MovingPair):
    """A run in progress."""

    # time ---------------------------------------------------------------------------------------

    def show(self, until, state_at):
        """Fill in the output times up to now."""
        times = self.run.time
        while self.shown < times.size and times[self.shown] <= until:
            state = state_at(times[self.shown])
            self.run.place[self.shown], self.run.slip[self.shown] = state[:6], state[12:14]
            self.shown += 1

    def peak(self, state):
        """Update the greatest rotations and slips."""
        run = self.run
        run.peaks = np.maximum(run.peaks, np.abs(state[[2, 5]]))
        run.peak_slips = np.maximum(run.peak_slips, np.abs(state[12:14]))

    def energy(self):
        """Return kinetic energy and that of gravity [J]."""
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
        """Tell whether the pattern allows no motion."""
        return self.pattern == STANDING

    def wait(self, stop):
        """Stay at rest until the ground moves a body, or to the end."""
        state = self.state

        def kept(t):
            return {k: v for k, v in self.guards(t, state).items() if k[0] in ("press", "grip")}

        sample_times = np.linspace(self.now, stop, 2 if self.piece.linear else 101)
        end, name, low = stop, None, kept(sample_times[0])
        for i in range(1, sample_times.size):
            high = kept(sample_times[i])
            fired = [k for k, v in high.items() if v < 0.0]
            if fired:
                times = {
                    k: sample_times[i - 1]
                    if low[k] <= 0.0
                    else brentq(
                        lambda t, k=k: kept(t)[k],
                        sample_times[i - 1],
                        sample_times[i],
                        xtol=1e-15,
                        rtol=1e-15,
                    )
                    for k in fired
                }
                name = min(fired, key=lambda k: times[k])
                end = times[name]
                break
            low = high
        self.show(end, lambda t: state)
        self.now = end
        return name

    def advance(self, stop):
        """Integrate up to the first event or to `stop`; return the event."""
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
                hit, again = first_event(
                    self.guards, solver, dense, armed, self.pair.slowness, GONE
                )
                if again:
                    # a guard that began at zero is negative: repeat with shorter steps
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

    def _peaks(self, start, end, dense):
        """Find the greatest rotations and slips within a step."""
        first, last = dense(start), dense(end)
        self.peak(last)
        tops = [k for k in (8, 11) if first[k] * last[k] < 0.0]
        extrema = [brentq(lambda t, k=k: dense(t)[k], start, end, xtol=1e-15) for k in tops]
        for i, bearing in enumerate(self.pattern):
            if not bearing.ends:
                rate = lambda t, i=i: middle_slips(self.pair, dense(t)[:6], dense(t)[6:12])[i]  # noqa: E731
                if rate(start) * rate(end) < 0.0:
                    extrema.append(brentq(rate, start, end, xtol=1e-15))
        for top in extrema:
            self.peak(dense(top))


class _CompliantRunning(CompliantPair, _Running):
    """A run with compliant bases."""


def simulate(scene: Scene, output_step: float = 0.01, **options) -> Run:
    """Simulate a scene, by `simulate_pair`."""
    pieces, period = pieces_for(scene.motion)
    options["quickest"] = min(period, options.get("quickest", period))
    return simulate_pair(scene.pair, scene.frictions, pieces, output_step, **options)


def simulate_pair(
    pair: Pair,
    frictions: Frictions,
    pieces: Sequence[Piece],
    output_step: float,
    *,
    accuracy: float = 1e-11,
    quickest: float = math.inf,
    start: tuple | None = None,
    compliant: CompliantBases | None = None,
    rule: str = "contact-state",
) -> Run:
    """Simulate two stacked bodies.

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
    compliant : dict, optional
        Pads or beds instead of rigid bases; `quickest` includes their period.
    rule : str
        Restraint rule of these bases.

    Returns
    -------
    Run

    Raises
    ------
    ValueError
        The upper base does not lie within the top of the lower body.
    OffTheTopError
        The upper base leaves the top.
    """
    if abs(pair.offset) + pair.upper.half_width > pair.lower.half_width * (1.0 + 1e-12):
        msg = "the upper base must lie within the top of the lower body"
        raise ValueError(msg)
    stop = pieces[-1].stop
    output = np.arange(math.floor(stop / output_step * (1.0 + 1e-12)) + 1) * output_step
    longest = min(0.04 * pair.slowness, 0.02 * quickest)
    kind = _CompliantRunning if compliant else _Running
    now = kind(pair, frictions, output, accuracy, longest)
    if compliant:
        now.set_compliant_bases(compliant, rule)
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
    """Store the results of a run at its end."""
    run = now.run
    run.end, run.final = now.now, now.state
    run.energies = {
        "change": now.energy() - now.start, "work": float(now.state[14]), "impacts": now.lost,
        "ground": float(now.state[15]), "joint": float(now.state[16]),
    }  # fmt: skip
    run.imbalance /= max(now.largest, 1e-300)
    run.time, run.place = output[: now.shown], run.place[: now.shown]
    run.slip = run.slip[: now.shown]
