"""A block on two pads of chosen ratios, with its constants computed by hand."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

import rockframe as rf


@dataclass(frozen=True)
class Pads:
    """Block and pads per unit mass, from the paper's Eqs. (1), (6)-(8)."""

    radius: float = 5.0
    slenderness: float = 4.0
    beta: float = 20.0
    damping_ratio: float = 0.1
    gravity: float = 9.80665
    mu: float = 3.0
    mass: float = 5e4

    @property
    def theta(self):
        return math.atan(1.0 / self.slenderness)

    @property
    def b(self):
        return self.radius * math.sin(self.theta)

    @property
    def h(self):
        return self.radius * math.cos(self.theta)

    @property
    def inertia(self):
        return self.radius**2 / self.mu

    @property
    def omega(self):
        return math.sqrt(self.mu / (1.0 + self.mu) * self.gravity / self.radius)

    @property
    def omega_v(self):
        return self.beta * self.omega

    @property
    def k(self):
        return 0.5 * self.omega_v**2

    @property
    def c(self):
        return self.damping_ratio * self.omega_v

    @property
    def delta(self):
        return 0.5 * self.gravity / self.k

    @property
    def eps_max(self):
        return (1.0 + self.mu * math.cos(2.0 * self.theta)) / (1.0 + self.mu)

    @property
    def rocking_inertia(self):
        return self.inertia + self.h**2

    @property
    def omega_r(self):
        stiffness = 2.0 * self.k * self.b**2 - self.gravity * self.h
        return math.sqrt(stiffness / self.rocking_inertia)

    @property
    def rocking_damping(self):
        """Coefficient of the rotation's rate."""
        return 2.0 * self.c * self.b**2 / self.rocking_inertia

    def system(self, restitution=None, **options):
        block = rf.Block.from_size(
            radius=f"{self.radius!r} m",
            slenderness=self.slenderness,
            mass=f"{self.mass!r} kg",
            shape_factor=self.mu,
        )
        pads = rf.TwoSpringSupport(
            frequency_ratio=self.beta,
            damping_ratio=self.damping_ratio,
            restitution=restitution,
        )
        return rf.System(block, pads, gravity=f"{self.gravity!r} m/s^2", **options)


def oscillator(frequency, damping, force, step, start=(0.0, 0.0)):
    """Solve x'' + damping x' + frequency^2 x = force exactly for a piecewise linear force.

    The step matrix of (x, x', force, slope of the force) is a matrix exponential.
    """
    matrix = np.zeros((4, 4))
    matrix[0, 1] = 1.0
    matrix[1] = [-(frequency**2), -damping, 1.0, 0.0]
    matrix[2, 3] = 1.0
    ahead = expm(matrix * step)[:2]
    out = np.empty((len(force), 2))
    out[0] = start
    for i in range(len(force) - 1):
        slope = (force[i + 1] - force[i]) / step
        out[i + 1] = ahead @ [*out[i], force[i], slope]
    return out[:, 0], out[:, 1]


def rough_record(count, step, peak, seed):
    """Return a record with content at all frequencies, from rest to rest."""
    rng = np.random.default_rng(seed)
    samples = rng.normal(size=count)
    samples[:5] *= np.linspace(0.0, 1.0, 5)
    samples[-5:] *= np.linspace(1.0, 0.0, 5)
    return peak * samples / np.abs(samples).max()


def zero_crossings(time, value, rate):
    """Return the times at which a sampled oscillation crosses zero, to fourth order."""
    found = []
    for i in np.flatnonzero(value[:-1] * value[1:] < 0.0):
        h = time[i + 1] - time[i]
        x0, x1, v0, v1 = value[i], value[i + 1], h * rate[i], h * rate[i + 1]
        cubic = [2.0 * (x0 - x1) + v0 + v1, 3.0 * (x1 - x0) - 2.0 * v0 - v1, v0, x0]
        roots = np.roots(cubic)
        real = roots[np.abs(roots.imag) < 1e-9].real
        found.append(time[i] + h * real[(real >= 0.0) & (real <= 1.0)][0])
    return np.array(found)
