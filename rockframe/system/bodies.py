"""Bodies on a base: sizes, inertia and restitution, block and cap as one body, and their load."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.case_arrays import CaseArray, atan2, tan
from rockframe.components import Component
from rockframe.components.bases import CushionCapSI
from rockframe.components.block_numbers import BlockSI, BodyGeometry, maximum_restitutions
from rockframe.components.shapes.standing import PlaneMass
from rockframe.dynamics.body import Body
from rockframe.dynamics.chain.link_rows import LINK_MOMENT
from rockframe.dynamics.single_body import rigid_body
from rockframe.signals.arrays import Array
from rockframe.system.options import RESTRAINT_CODES, Options

ROUNDING = 1e-12
"""Excess over the greatest restitution that counts as rounding error."""


class Restitutions(NamedTuple):
    """Coefficients of restitution of a landing on the left and on the right corner."""

    left: float
    right: float

    def words(self) -> str:
        """Return the coefficients in words; one number where they are equal."""
        if self.left == self.right:
            return f"{self.left:.6g}"
        return f"{self.left:.6g} (onto the left corner), {self.right:.6g} (onto the right one)"


class BaseFriction(NamedTuple):
    """Coefficients of static, kinetic and impulsive friction; infinite where a base holds."""

    static: float
    kinetic: float
    impulsive: float

    def row(self, base: str = "") -> tuple[str, str]:
        """Return a name for the coefficients, after that of their base, and the coefficients."""
        sticks = ", held in impacts" if math.isinf(self.impulsive) else ""
        words = f"{self.static:.6g}, {self.kinetic:.6g}{sticks}"
        return f"{base}friction at rest, and of slip", "held" if math.isinf(self.static) else words


NO_SLIP: Final = BaseFriction(math.inf, math.inf, math.inf)
"""Friction of a base on which nothing slips."""


def base_restitution(base: Component | None, greatest: Restitutions) -> Restitutions:
    """Return the restitutions on a base: eps_max of Eq. (4) unless the user chose one."""
    value = None if base is None else base.si.restitution
    return greatest if value is None else Restitutions(value, value)


def restitution_cautions(chosen: Restitutions, greatest: Restitutions) -> list[str]:
    """Warn of a restitution above eps_max, Eq. (4)."""
    excess, maximum, restitution = max(
        (one - max(limit, 0.0), limit, one) for one, limit in zip(chosen, greatest, strict=True)
    )
    if excess <= ROUNDING:
        return []
    return [
        f"restitution {restitution:.6g} exceeds eps_max = {maximum:.6g} of Eq. (4), the greatest "
        "of a rigid block that rolls over from corner to corner without bouncing"
    ]


@dataclass(frozen=True)
class SupportedBody(BodyGeometry):
    """A rigid body with a straight base, in SI units."""

    half_width: float  # half the width of the base, b
    centre_height: float  # height of the centre of mass above the base, h
    mass: float
    inertia: float  # about the centre of mass
    shape_factor: float  # mu
    eccentricity: float = 0.0  # e_c, centre of mass to the right of the middle of the base

    @cached_property
    def overturning_angles(self) -> "OverturningAngles":
        """Rotations at which the centre of mass stands above an end of the base."""
        return OverturningAngles(
            atan2(self.left, self.centre_height), atan2(self.right, self.centre_height)
        )

    @cached_property
    def maximum_restitution(self) -> Restitutions:
        """eps_max of impacts on either end, Eq. (4) or :eq:`eq-eccentric-impact`."""
        return Restitutions(*maximum_restitutions(self))

    @property
    def base_ratio(self) -> float:
        """Half the width of a single base over b; 1 unless the body stands for several [1]."""
        return 1.0

    def base_moment(
        self, values: Mapping[str, Any], sine: Array, cosine: Array, *, small: bool
    ) -> Array:
        """Return the moment of the base about its middle, :eq:`eq-base-moment` [N m]."""
        beside, lift = self.eccentricity * cosine, self.eccentricity * sine
        if small:  # widths to first order
            lift = np.zeros_like(sine)
        moment = (self.centre_height * sine + beside) * values["vertical_reaction"]
        moment = moment - (self.centre_height * cosine - lift) * values["horizontal_reaction"]
        # in a cascade, the acceleration of the second stage alone
        angular = values.get("angular_acceleration_on_base", values["angular_acceleration"])
        moment = moment - self.inertia * angular
        return moment + values[LINK_MOMENT] if LINK_MOMENT in values else moment

    def base_settlement(self, rotation: Array, rise: Array, *, small: bool) -> Array:
        """Return the settlement of the middle of the base from rest, :eq:`eq-settlement` [m]."""
        half, beside = 0.5 * rotation, self.eccentricity * rotation
        if not small:
            half = np.sin(half)
            beside = self.eccentricity * np.sin(rotation) if self.eccentricity != 0.0 else beside
        return -rise - beside - 2.0 * self.centre_height * half**2

    def relative_to_centre(
        self, x: Array, y: Array, values: Mapping[str, Any]
    ) -> tuple[Array, Array]:
        """Return x and y of points from the centre of mass, not from the middle of the base [m]."""
        return x - self.eccentricity, y - self.centre_height

    def mass_at(self, x: float = 0.0, y: float = 0.0) -> PlaneMass:
        """Return the mass of the body with the middle of its base at x and y [m]."""
        return PlaneMass(self.mass, x + self.eccentricity, y + self.centre_height, self.inertia)

    @property
    def base_inertia(self) -> float:
        """Moment of inertia about the point of the base below the centre of mass [kg m^2]."""
        return self.inertia + self.mass * self.centre_height**2

    def gyration_square_about(self, distance: float) -> float:
        """Return inertia over mass about a point of the base [m^2].

        `distance` is from the point below the centre of mass. About a corner of a symmetric body
        it is R0^2 (1 + 1/mu).
        """
        square = self.radius**2 * (1.0 + 1.0 / self.shape_factor)
        return square + (distance - self.half_width) * (distance + self.half_width)


@dataclass(frozen=True)
class CornerSupportedBody(SupportedBody):
    """A body on the corners of its base on rigid ground, with other forces, as of a wall."""

    @property
    def contact_half_width(self) -> float:
        """Half the width of the base in contact [m]."""
        return self.half_width

    def base_moment(
        self, values: Mapping[str, Any], sine: Array, cosine: Array, *, small: bool
    ) -> Array:
        """Return the moment of the base about its middle, of the corner reactions [N m]."""
        shift = values["right_reaction"] - values["left_reaction"]
        lift = 0.0 if small else values["horizontal_reaction"] * np.abs(sine)
        return self.contact_half_width * (shift * cosine + lift)

    def base_settlement(self, rotation: Array, rise: Array, *, small: bool) -> Array:
        """Return the settlement of the middle of the base, zero or negative about a corner [m]."""
        return -self.contact_half_width * np.abs(rotation if small else np.sin(rotation))


class OverturningAngles(NamedTuple):
    """Rotations of unstable equilibrium to either side, positive; the lesser is theta [rad]."""

    left: float
    right: float

    def on_side_of(self, rotation: float) -> float:
        """Return the overturning angle of the side to which a body is rotated."""
        return self.left if rotation < 0.0 else self.right


@dataclass(frozen=True)
class Cap:
    """A cap under a building, in SI units."""

    half_width: float
    half_height: float
    mass: float
    inertia: float


def block_body(block: BlockSI, kind: type[SupportedBody] = SupportedBody) -> SupportedBody:
    """Return a block as a body."""
    return kind(
        block.half_width, block.centre_height, block.mass, block.inertia, block.shape_factor,
        block.eccentricity,
    )  # fmt: skip


def block_cap(block: BlockSI, cap: CushionCapSI) -> Cap:
    """Return a cap in SI units; it is as wide as the block unless its width is given."""
    width = cap.width if cap.width is not None else block.width
    return Cap(0.5 * width, 0.5 * cap.height, cap.mass_at(width), cap.inertia_at(width))


def block_with_cap(block: BlockSI, cap: Cap) -> SupportedBody:
    """Return block and cap as one body, :eq:`eq-one-body`."""
    upper = block_body(block).mass_at(0.0, 2.0 * cap.half_height)
    lower = PlaneMass(cap.mass, 0.0, cap.half_height, cap.inertia)
    return combine_masses(cap.half_width, (upper, lower))


def combine_masses(half_width: float, masses: Sequence[PlaneMass]) -> SupportedBody:
    """Return rigidly connected masses, placed from the middle of a base, as one body on it."""
    # sums without math.fsum, since a mass may have a value in each of many cases
    mass = sum((placed.mass for placed in masses), 0.0)
    beside = sum((placed.mass * placed.x for placed in masses), 0.0) / mass
    height = sum((placed.mass * placed.y for placed in masses), 0.0) / mass
    inertia = 0.0
    for placed in masses:
        inertia = (
            inertia
            + placed.inertia
            + placed.mass * ((placed.y - height) ** 2 + (placed.x - beside) ** 2)
        )
    shape_factor = mass * (half_width**2 + height**2) / inertia
    return SupportedBody(half_width, height, mass, inertia, shape_factor, beside)


_CACHED_LOADS: Final = 64
"""Size of the cache of loads, for sweeps that change only the base under a block."""


@dataclass(frozen=True)
class BaseLoad:
    """A body on a base, with the options of its system.

    Parameters
    ----------
    body : SupportedBody
        In SI units.
    options : Options
        Restraint, kinematics, and gravity.
    """

    body: SupportedBody
    options: Options

    @property
    def weight(self) -> float:
        """Component of the body's weight normal to the base [N]."""
        return self.body.mass * self.options.slope.normal_gravity

    @property
    def thrust(self) -> float:
        """Tangential force of the base that balances the weight of the body at rest [N]."""
        return self.body.mass * self.options.slope.along_gravity

    @cached_property
    def overturning_angles(self) -> OverturningAngles:
        """Overturning angles of the body from its base line, :eq:`eq-incline-overturning`."""
        (left, right), i = self.body.overturning_angles, self.options.inclination
        i = tan(i) if self.options.small else i
        return OverturningAngles(left - i, right + i)

    @cached_property
    def rigid_body(self) -> Body:
        """The body as the equations take it, per unit of its own mass."""
        return self.law(self.body.mass)

    def law(self, mass: float) -> Body:
        """Return the body as the equations take it, per unit of a reference mass [kg]."""
        return rigid_body(
            left=self.body.left,
            right=self.body.right,
            height=self.body.centre_height,
            inertia=self.body.inertia / mass,
            restraint=RESTRAINT_CODES[self.options.restraint],
            small_rotation=self.options.small,
            gravity=self.options.slope.normal_gravity,
        )


def load_of(block: BlockSI, options: Options) -> BaseLoad:
    """Return a block as a load; one object for all scenes that differ only in their bases."""
    numbers = (*vars(block).values(), options.gravity, options.inclination)
    if any(isinstance(number, CaseArray) for number in numbers):
        return BaseLoad(block_body(block), options)
    return _cached_load(block, options)


@lru_cache(maxsize=_CACHED_LOADS)
def _cached_load(block: BlockSI, options: Options) -> BaseLoad:
    return BaseLoad(block_body(block), options)
