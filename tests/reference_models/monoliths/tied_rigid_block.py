"""A block on rigid ground with ties, by SciPy: one equation for the rotation, written by hand.

Per unit mass. Rotating about the corner s (+1 right, -1 left), with theta = atan(b/h),

    (I + R^2) alpha'' = -R [(g + a_y) sin(theta s - alpha) + a_x cos(theta s - alpha)]
                        - sum T dl/dalpha,

and an impact leaves e = 1 - 2 b^2/(I + R^2) of the rate. Each tie is a `ties.Tie`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from .ties import KINDS, PRESSED, YIELDING, Tie

REST = 1e-10
STOPPED = 1e-12
RTOL, ATOL = 1e-12, 1e-14


@dataclass
class Result:
    """Samples and events; `lifted` if the bearing corner would have had to pull."""

    rotation: np.ndarray
    events: list[tuple[float, str]] = field(default_factory=list)
    lifted: bool = False
    overturned: bool = False


@dataclass
class Block:
    """A block with ties."""

    b: float
    h: float
    inertia: float
    gravity: float
    ties: Sequence[Tie]
    side: int = 1

    def __post_init__(self) -> None:
        self.theta, self.radius = math.atan2(self.b, self.h), math.hypot(self.b, self.h)
        self.about = self.inertia + self.radius**2

    def place(self, alpha: float, rate: float) -> tuple[list[float], float, float]:
        """Return rotation, rise and shift with their rates and their derivatives by alpha."""
        lean, s = self.theta * self.side - alpha, self.side
        up, along = self.radius * math.sin(lean), self.radius * math.cos(lean)
        x, y = s * self.b - up, along - self.h
        return [alpha, y, x, rate, up * rate, along * rate], up, along

    def pulls(self, alpha: float, rate: float) -> tuple[float, float]:
        """Return the ties' moment on the rotation, and their force upwards."""
        z, up, along = self.place(alpha, rate)
        moment = lift = 0.0
        for tie in self.ties:
            length, way, speed, _ = tie.length(z)
            pull = tie.tension(length, speed)
            moment -= pull * (way[0] + up * way[1] + along * way[2])
            lift -= pull * way[1]
        return moment, lift

    def swing(self, alpha: float, rate: float, ax: float, ay: float) -> float:
        """Return the angular acceleration."""
        _, up, along = self.place(alpha, rate)
        moment = -(self.gravity + ay) * up - ax * along
        return (moment + self.pulls(alpha, rate)[0]) / self.about

    def press(self, alpha: float, rate: float, ax: float, ay: float) -> float:
        """Return the force of the bearing corner."""
        _, up, along = self.place(alpha, rate)
        rise = up * self.swing(alpha, rate, ax, ay) - along * rate**2
        return self.gravity + ay + rise - self.pulls(alpha, rate)[1]

    def holds(self, ax: float, ay: float) -> float:
        """Return least restoring acceleration of both corners, at rest; negative if it starts."""
        restoring = []
        for side in (1, -1):
            self.side = side
            restoring.append(-side * self.swing(0.0, 0.0, ax, ay))
        self.side = 1 if restoring[0] < restoring[1] else -1
        return min(restoring)


def simulate(
    block: Block, acceleration: Sequence[float], time_step: float, rotation: float, times,
    limit: float = math.inf, longest_step: float = 0.01,
) -> Result:  # fmt: skip
    """Follow a block from a rotation through a piecewise linear motion.

    Two passages through zero within one step are not detected.
    """
    result = Result(np.full(len(times), np.nan))
    duration, last = float(times[-1]), len(acceleration) - 1

    def ground(t: float) -> float:
        i = min(int(t / time_step), last)
        if i == last:
            return 0.0
        return acceleration[i] + (t / time_step - i) * (acceleration[i + 1] - acceleration[i])

    block.side = 1 if rotation >= 0.0 else -1
    for tie in block.ties:
        tie.begin(block.h, block.place(rotation, 0.0)[0])
    t, alpha, rate = 0.0, rotation, 0.0
    resting = rotation == 0.0 and block.holds(ground(0.0), 0.0) >= 0.0
    knots = [time_step * i for i in range(len(acceleration)) if time_step * i < duration]
    edges = [*knots[1:], duration]
    while t < duration:
        end = next(edge for edge in edges if edge > t)
        if resting:
            t, resting = _rest(block, ground, t, end, result, times)
            alpha = rate = 0.0
            continue
        t, alpha, rate, resting = _rock(
            block, ground, t, end, alpha, rate, result, times, limit, longest_step
        )
        if result.overturned:
            break
    return result


def _rest(block, ground, t, end, result, times):
    """Rest until the block starts; loads are linear in time within an interval."""
    edge = end - 1e-13 * max(1.0, end)
    first, final = block.holds(ground(t), 0.0), block.holds(ground(edge), 0.0)
    start = end
    if first < 0.0 or final < 0.0:
        low, high = t, edge
        if first < 0.0:
            high = t
        while high - low > 1e-15 * max(1.0, high):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            low, high = (middle, high) if block.holds(ground(middle), 0.0) >= 0 else (low, middle)
        start = high
        result.events.append((start, "uplift"))
        block.holds(ground(start), 0.0)
    result.rotation[(times >= t) & (times <= start)] = 0.0
    return start, start >= end


def _rock(block, ground, t, end, alpha, rate, result, times, limit, longest_step):
    """Rock until the next event or the end of an interval."""
    a0, a1 = ground(t), ground(end - 1e-13 * max(1.0, end))
    span = max(end - 1e-13 - t, 1e-300)

    def ax(at: float) -> float:
        return a0 + (at - t) / span * (a1 - a0)

    guards, names = [], []

    def add(name, function, direction):
        function.terminal, function.direction = True, direction
        guards.append(function)
        names.append(name)

    side = block.side
    add(("impact", None), lambda _, z: z[0], -side)
    add(("overturned", None), lambda _, z: limit - side * z[0], -1)
    for tie in block.ties:
        for guard in tie.guards(0):
            assert guard.kind in KINDS

            def value(at, z, tie=tie, kind=guard.kind):
                length, _, speed, _ = tie.length(block.place(z[0], z[1])[0])
                return tie.value(kind, length, speed, 0.0)[0]

            add((guard.kind, tie), value, -1)

    def slope(at, z):
        return [z[1], block.swing(z[0], z[1], ax(at), 0.0)]

    run = solve_ivp(
        slope, (t, end), [alpha, rate], method="DOP853", rtol=RTOL, atol=ATOL, events=guards,
        dense_output=True, max_step=longest_step,
    )  # fmt: skip
    stop = float(run.t[-1])
    some = (times >= t) & (times <= stop)
    result.rotation[some] = run.sol(times[some])[0] if some.any() else 0.0
    for at, z in zip(run.t, run.y.T, strict=True):
        result.lifted |= block.press(z[0], z[1], ax(at), 0.0) < 0.0
    alpha, rate = (float(one) for one in run.y[:, -1])
    if run.status != 1:
        return end, alpha, rate, False
    which = next(i for i, one in enumerate(run.t_events) if len(one))
    kind, tie = names[which]
    result.events.append((stop, kind))
    result.overturned = kind == "overturned"
    if result.overturned:
        return stop, alpha, rate, False
    if tie is not None:
        place = block.place(alpha, rate)[0]
        tie.switch(kind, place)
        # a block that stops reverses all yielding ties at once
        for other in block.ties if kind == "turn" else ():
            if other.state in (YIELDING, PRESSED) and abs(other.length(place)[2]) < STOPPED:
                other.switch("turn", place)
                result.events.append((stop, "turn"))
        return stop, alpha, rate, False
    rate *= 1.0 - 2.0 * block.b**2 / block.about
    block.side = -side
    alpha = 0.0
    for one in block.ties:
        if one.turned(block.place(alpha, rate)[0]):
            one.switch("turn", block.place(alpha, rate)[0])
            result.events.append((stop, "turn"))
    restoring = side * block.swing(0.0, 0.0, ground(stop), 0.0)
    if restoring > 0.0 and rate**2 < 2.0 * restoring * REST * block.theta:
        keep = block.side
        if block.holds(ground(stop), 0.0) >= 0.0:
            return stop, 0.0, 0.0, True
        block.side = keep
    return stop, alpha, rate, False
