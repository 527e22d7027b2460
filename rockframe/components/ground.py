"""The rigid ground that a block stands on when nothing else is given."""

from typing import ClassVar

from rockframe.components.base import Component
from rockframe.components.parameters import Ratio
from rockframe.components.values import Friction
from rockframe.units import UNIT_INTERVAL, RatioLike


class RigidGround(Component):
    """Rigid ground under a rocking block (Housner's model).

    A scene with a block alone stands on rigid ground; this part is needed only
    to choose a restitution or a friction.

    Raises
    ------
    UnitsError
        Not a pure ratio.
    ComponentError
        `restitution` is outside (0, 1], or `friction` negative.
    """

    noun: ClassVar[str] = "base"

    restitution = Ratio(
        UNIT_INTERVAL,
        doc="Ratio of the angular velocities after and before an impact; the block's eps_max, "
        "Eq. (4), unless given.",
        default=None,
        example="0.9",
    )

    friction = Friction(of="the block")

    def __init__(
        self, *, restitution: RatioLike | None = None, friction: RatioLike | None = None
    ) -> None:
        super().__init__(restitution=restitution, friction=friction)
