"""The rigid ground that a block stands on when nothing else is given."""

from enum import StrEnum
from typing import ClassVar, Literal, TypeAlias

from rockframe.components.base import Component
from rockframe.components.parameters import (
    Choice,
    Ratio,
    SIValues,
    check_frictions,
    friction_at_rest,
    friction_of_slip,
)
from rockframe.units import UNIT_INTERVAL, RatioLike


class Impact(StrEnum):
    """Whether a corner that strikes slips as far as friction lets it, or is held."""

    COULOMB = "coulomb"
    STICK = "stick"


ImpactLike: TypeAlias = Impact | Literal["coulomb", "stick"]


class RigidGround(Component):
    """Rigid ground under a block, which rocks on it (Housner's model) and may slide.

    A scene with a block alone stands on rigid ground that holds it; this part is needed only
    to choose a restitution or a friction.

    Raises
    ------
    UnitsError
        Not a pure ratio.
    ComponentError
        `restitution` is outside (0, 1], a coefficient of friction is negative, or
        `kinetic_friction` is given without `friction` or above it.

    Examples
    --------
    >>> import rockframe as rf
    >>> low = rf.Block(width="2 m", height="1 m", mass="5 t")
    >>> pulse = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")
    >>> run = rf.System(low, rf.RigidGround(friction=0.3)).simulate(pulse, accuracy="fast")
    >>> run.attrs["verdict"].split(":")[0]
    'Slid 0.0338 m to the right and back, did not overturn'
    """

    noun: ClassVar[str] = "base"

    restitution = Ratio(
        UNIT_INTERVAL,
        doc="Ratio of the angular velocities after and before an impact that does not slip; the "
        "block's eps_max, Eq. (4), unless given.",
        default=None,
        example="0.9",
    )
    friction = friction_at_rest("the block")
    kinetic_friction = friction_of_slip()
    impact = Choice(
        Impact.COULOMB,
        doc="Whether a corner that strikes slips as far as kinetic friction lets it, or is held.",
    )

    def __init__(
        self,
        *,
        restitution: RatioLike | None = None,
        friction: RatioLike | None = None,
        kinetic_friction: RatioLike | None = None,
        impact: ImpactLike = Impact.COULOMB,
    ) -> None:
        super().__init__(
            restitution=restitution,
            friction=friction,
            kinetic_friction=kinetic_friction,
            impact=impact,
        )

    def _numbers(self, given: SIValues) -> SIValues:
        return check_frictions("RigidGround", given)
