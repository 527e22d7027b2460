"""A block on a Winkler bed of chosen ratios, with its constants computed by hand."""

import math
from dataclasses import dataclass

import numpy as np

import rockframe as rf
from rockframe.dynamics.protocol import Ground, Start

STILL = Ground(0.0, 0.0)


@dataclass(frozen=True)
class Bed:
    """A body on a bed, per unit mass, from the paper's Eq. (18)."""

    half_width: float = 1.2
    half_height: float = 4.8
    stiffness: float = 180.0  # k0/m
    damping_ratio: float = 0.2
    gravity: float = 9.80665
    mu: float = 3.0
    mass: float = 5e4
    separation: str = "displacement"

    @property
    def inertia(self):
        return (self.half_width**2 + self.half_height**2) / self.mu

    @property
    def base_inertia(self):
        return self.inertia + self.half_height**2

    @property
    def weight(self):
        return self.mass * self.gravity

    @property
    def delta(self):
        return self.gravity / (2.0 * self.half_width * self.stiffness)

    @property
    def omega_v(self):
        return math.sqrt(2.0 * self.half_width * self.stiffness)

    @property
    def damping(self):
        """c0/m: the vertical damping ratio is c0 b / (m omega_v)."""
        return self.damping_ratio * self.omega_v / self.half_width

    @property
    def omega_r(self):
        stiffness = self.stiffness * self.half_width**3 / 1.5 - self.gravity * self.half_height
        return math.sqrt(stiffness / self.base_inertia)

    @property
    def rocking_damping(self):
        """Coefficient of the rotation's rate."""
        return self.damping * self.half_width**3 / 1.5 / self.base_inertia

    @property
    def block(self):
        return rf.Block(
            width=f"{2.0 * self.half_width!r} m",
            height=f"{2.0 * self.half_height!r} m",
            mass=f"{self.mass!r} kg",
            shape_factor=self.mu,
        )

    @property
    def soil(self):
        return rf.WinklerSoil(
            stiffness=f"{self.mass * self.stiffness!r} Pa",
            damping_ratio=self.damping_ratio,
            separation=self.separation,
        )

    def system(self, *others, **options):
        return rf.System(
            self.block, self.soil, *others, gravity=f"{self.gravity!r} m/s^2", **options
        )


def at_rest(model, rotation, height):
    """Return the mode and the state of a motionless body, and its accelerations."""
    mode, state, _ = model.initial(Start(rotation, 0.0, height, 0.0))
    return mode, state, accelerations(model, mode, state)


def accelerations(model, mode, state):
    """Evaluate the equations of a model in plain Python, on motionless ground."""
    system = model.system
    return np.array(system.accelerate(int(mode), state, STILL)[: system.coordinates()])


def energies(model, mode, state):
    """Return kinetic, gravity and elastic energy, and elastic energy above rest, per unit mass."""
    return model.system.energies(int(mode), state)
