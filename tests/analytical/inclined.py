"""Reference solutions of blocks on inclined bases by SciPy, in horizontal and vertical axes.

The ground's points, the corners and the centre of mass are vectors to the right and upwards;
gravity acts downwards. Rotations are those of the block in space, clockwise.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root

G = 9.80665
TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}
REST = 1e-10
"""Share of the overturning angle below which a rebound is taken for rest."""


@dataclass(frozen=True)
class Stone:
    """A block whose centre of mass is at `offset` from the middle of its base."""

    half_width: float
    height: float  # of the centre of mass
    mass: float
    inertia: float  # about the centre of mass
    offset: float = 0.0

    def relative_to(self, point, rotation):
        """Return the centre of mass relative to a point of the base, in a rotated block."""
        right, up = self.offset - point, self.height
        s, c = math.sin(rotation), math.cos(rotation)
        return np.array([c * right + s * up, c * up - s * right])


def clockwise(arm, force):
    """Return the moment of a force."""
    return arm[1] * force[0] - arm[0] * force[1]


def rocking(stone, inclination, ground, end, times):
    """Return rotations relative to the ground, at given times, of a block that starts at rest.

    `ground(t)` is the acceleration of the ground, horizontal and vertical.
    """
    level = -inclination  # the ground rises to the right: anticlockwise
    corners = {1: stone.half_width, -1: -stone.half_width}
    theta = math.atan2(stone.half_width - abs(stone.offset), stone.height)

    def load(time):
        return -stone.mass * (ground(time) + np.array([0.0, G]))

    def polar(side):
        arm = stone.relative_to(corners[side], level)
        return stone.inertia + stone.mass * (arm @ arm)

    def tipping(time, side):
        """Return the moment about a corner at rest, towards its side."""
        return side * clockwise(stone.relative_to(corners[side], level), load(time))

    def next_start(time):
        """Return when and to which side a block at rest begins to uplift."""
        found = []
        for side in (1, -1):
            fine = np.arange(time, end, 1e-3)
            values = np.array([tipping(t, side) for t in fine])
            tips = np.flatnonzero(values > 0.0)
            if tips.size:
                i = tips[0]
                edge = fine[i] if i == 0 else brentq(tipping, fine[i - 1], fine[i], args=(side,),
                                                     xtol=1e-15)  # fmt: skip
                found.append((edge, side))
        return min(found, default=(end, 0))

    out = np.zeros(len(times))
    time, side, state = *next_start(0.0), np.array([level, 0.0])
    while time < end and side != 0:
        arm_inertia = polar(side)

        def slope(t, z, side=side, arm_inertia=arm_inertia):
            return [z[1], clockwise(stone.relative_to(corners[side], z[0]), load(t)) / arm_inertia]

        def landing(t, z, side=side):
            return side * (z[0] - level)

        landing.terminal, landing.direction = True, -1
        run = solve_ivp(slope, (time, end), state, events=landing, dense_output=True,
                        max_step=0.02, **TIGHT)  # fmt: skip
        inside = (times >= time) & (times <= run.t[-1])
        out[inside] = run.sol(times[inside])[0] - level
        time, state = run.t[-1], run.y[:, -1]
        if run.status != 1:
            break
        old, new = (stone.relative_to(corners[s], level) for s in (side, -side))
        side = -side
        rate = state[1] * (stone.inertia + stone.mass * (old @ new)) / polar(side)
        restoring = -tipping(time, side) / polar(side)
        state = np.array([level, rate])
        if restoring > 0.0 and rate**2 / (2.0 * restoring) < REST * theta:
            time, side = next_start(time)
            state = np.array([level, 0.0])
    return out


@dataclass(frozen=True)
class OnPads:
    """A block on two inclined pads, with the middle of its base held along the slope."""

    stone: Stone
    inclination: float
    stiffness: float
    damping: float

    @property
    def axes(self):
        """Return the directions along the slope, upwards, and normal to it."""
        s, c = math.sin(self.inclination), math.cos(self.inclination)
        return np.array([c, s]), np.array([-s, c])

    def placed(self, place, velocity):
        """Return corners and middle of the base relative to the centre of mass, and their rates.

        `place` is that of the centre of mass on the unloaded pads, and the rotation in space.
        """
        stone = self.stone
        points = (-stone.half_width, stone.half_width, 0.0)
        arms = [-stone.relative_to(point, place[2]) for point in points]
        # a clockwise rate turns (x, y) to (y, -x)
        turning = [velocity[:2] + velocity[2] * np.array([arm[1], -arm[0]]) for arm in arms]
        return arms, turning

    def pad(self, place, velocity, corner):
        """Return the compression of a pad at a corner, and the rate at which the corner rises."""
        _, normal = self.axes
        arms, rates = self.placed(place, velocity)
        return -normal @ (place[:2] + arms[corner]), normal @ rates[corner]

    def pull(self, place, velocity, corner):
        """Return the force of a pad in contact."""
        depth, rate = self.pad(place, velocity, corner)
        return self.stiffness * depth - self.damping * rate

    def accelerations(self, time, place, velocity, touching, ground):
        """Solve Newton's and Euler's equations with the thrust that holds the middle."""
        stone, (along, normal) = self.stone, self.axes
        arms, _ = self.placed(place, velocity)
        force = -stone.mass * (ground(time) + np.array([0.0, G]))
        moment = 0.0
        for corner in (0, 1):
            if touching[corner]:
                press = self.pull(place, velocity, corner) * normal
                force = force + press
                moment += clockwise(arms[corner], press)
        middle = arms[2]
        # unknown: accelerations (x, y, rotation) and the thrust along the slope
        matrix = np.zeros((4, 4))
        matrix[0, 0] = matrix[1, 1] = stone.mass
        matrix[2, 2] = stone.inertia
        matrix[:2, 3], matrix[2, 3] = -along, -clockwise(middle, along)
        matrix[3, :2], matrix[3, 2] = along, along @ np.array([middle[1], -middle[0]])
        right = np.array([*force, moment, (along @ middle) * velocity[2] ** 2])
        return np.linalg.solve(matrix, right)

    def rest(self):
        """Return where the block is at rest, both pads bearing."""
        along, _ = self.axes

        def residual(place):
            found = self.accelerations(0.0, place, np.zeros(3), (True, True),
                                       lambda t: np.zeros(2))  # fmt: skip
            held = along @ (place[:2] + self.placed(place, np.zeros(3))[0][2])
            return [found[1], found[2], held]

        guess = np.array([*self.stone.relative_to(0.0, -self.inclination), -self.inclination])
        return root(residual, guess, tol=1e-13).x

    def response(self, ground, end, times):
        """Return rotation, and displacements along and off the slope, from rest."""
        start, touching = self.rest(), [True, True]
        time, state = 0.0, np.concatenate([start, np.zeros(3)])
        out = np.zeros((len(times), 3))
        switches = 0
        while time < end:

            def slope(t, z):
                found = self.accelerations(t, z[:3], z[3:], touching, ground)
                return [*z[3:], *found[:3]]

            def guard(corner):
                def leaving(t, z):
                    return self.pull(z[:3], z[3:], corner)

                def landing(t, z):
                    return -self.pad(z[:3], z[3:], corner)[0]

                event = leaving if touching[corner] else landing
                event.terminal, event.direction = True, -1
                return event

            run = solve_ivp(slope, (time, end), state, events=[guard(0), guard(1)],
                            dense_output=True, max_step=0.02, **TIGHT)  # fmt: skip
            inside = (times >= time) & (times <= run.t[-1])
            out[inside] = run.sol(times[inside])[:3].T
            time, state = run.t[-1], run.y[:, -1]
            if run.status != 1:
                break
            corner = 0 if run.t_events[0].size else 1
            touching[corner] = not touching[corner]
            assert any(touching), "the block flies"
            switches += 1
        along, normal = self.axes
        moved = out[:, :2] - start[:2]
        return out[:, 2] + self.inclination, moved @ along, moved @ normal, switches
