"""What stands on a base: a body, and how it is held."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Final

from rockframe.components.block_numbers import BlockSI
from rockframe.signals.slope import Slope
from rockframe.system.bodies import OverturningAngles, SupportedBody, body_of_block
from rockframe.system.options import Options
from rockframe.system.restraints import restraint_code

if TYPE_CHECKING:
    from rockframe.dynamics.body import Body


_KEPT: Final = 64
"""Blocks whose loads are kept at hand, for sweeps that change the base under them."""


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
    def gravity(self) -> float:
        """Acceleration of gravity [m s^-2]."""
        return self.options.gravity

    @cached_property
    def slope(self) -> Slope:
        """The base line in its gravity."""
        return self.options.slope

    @property
    def weight(self) -> float:
        """Weight of the body, as far as it presses on the base [N]."""
        return self.body.mass * self.slope.normal_gravity

    @property
    def thrust(self) -> float:
        """Force along the base that keeps the body at rest from sliding [N]."""
        return self.body.mass * self.slope.along_gravity

    @cached_property
    def overturning_angles(self) -> OverturningAngles:
        """Rotations at which the centre of mass stands above an end of the base."""
        return self.body.overturning_angles.on_slope(self.slope, small=self.options.small)

    @cached_property
    def rigid_body(self) -> "Body":
        """The body as the equations take it, per unit of its own mass."""
        return self.law(self.body.mass)

    def law(self, mass: float) -> "Body":
        """Give the body as the equations take it, per unit of some mass [kg]."""
        from rockframe.dynamics.alone_model import rigid_body

        return rigid_body(
            left=self.body.left,
            right=self.body.right,
            height=self.body.centre_height,
            inertia=self.body.inertia / mass,
            restraint=restraint_code(self.options.restraint),
            small_rotation=self.options.small,
            gravity=self.slope.normal_gravity,
        )


@lru_cache(maxsize=_KEPT)
def load_of(block: BlockSI, options: Options) -> BaseLoad:
    """Give a block as a load; the same one for all scenes that differ in their bases alone."""
    return BaseLoad(body_of_block(block), options)
