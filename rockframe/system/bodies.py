"""Rigid bodies that scenes put on a base: a block, or a block and its cap as one."""

import math
from dataclasses import dataclass

from rockframe.components.block import BlockSI
from rockframe.components.cap import CushionCapSI


@dataclass(frozen=True)
class Body:
    """A rigid body with a straight base, in SI units."""

    half_width: float  # of the base, b
    centre_height: float  # of the centre of mass above the base, h
    mass: float
    inertia: float  # about the centre of mass
    shape_factor: float  # mu

    @property
    def overturning_angle(self) -> float:
        """Rotation at which the centre of mass stands above the end of the base [rad]."""
        return math.atan2(self.half_width, self.centre_height)

    @property
    def least_friction(self) -> float:
        """b/h: with less, the base slides before an end of it lifts [1]."""
        return self.half_width / self.centre_height

    @property
    def radius(self) -> float:
        """R0, from an end of the base to the centre of mass [m]."""
        return math.hypot(self.half_width, self.centre_height)

    def frequency_at(self, gravity: float) -> float:
        """Angular frequency omega of Eq. (6) under a given gravity [rad s^-1]."""
        mu = self.shape_factor
        return math.sqrt(mu / (1.0 + mu) * gravity / self.radius)

    @property
    def maximum_restitution(self) -> float:
        """eps_max = (1 + mu cos 2 theta)/(1 + mu), Eq. (4)."""
        mu = self.shape_factor
        return (1.0 + mu * math.cos(2.0 * self.overturning_angle)) / (1.0 + mu)

    @property
    def base_inertia(self) -> float:
        """About the middle of the base [kg m^2]."""
        return self.inertia + self.mass * self.centre_height**2


@dataclass(frozen=True)
class Cap:
    """A cap under a building, in SI units."""

    half_width: float
    half_height: float
    mass: float
    inertia: float


def body_of(block: BlockSI) -> Body:
    """Give a block as a body."""
    return Body(block.half_width, block.half_height, block.mass, block.inertia, block.shape_factor)


def cap_under(block: BlockSI, cap: CushionCapSI) -> Cap:
    """Give a cap in the size it has under a block."""
    width = cap.width if cap.width is not None else block.width
    return Cap(0.5 * width, 0.5 * cap.height, cap.mass_at(width), cap.inertia_at(width))


def one_body(block: BlockSI, cap: Cap) -> Body:
    """Give block and cap as one body, :eq:`eq-one-body`."""
    mass = block.mass + cap.mass
    block_height = 2.0 * cap.half_height + block.half_height
    height = (block.mass * block_height + cap.mass * cap.half_height) / mass
    inertia = (
        block.inertia
        + block.mass * (block_height - height) ** 2
        + cap.inertia
        + cap.mass * (height - cap.half_height) ** 2
    )
    shape_factor = mass * (cap.half_width**2 + height**2) / inertia
    return Body(cap.half_width, height, mass, inertia, shape_factor)
