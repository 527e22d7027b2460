"""The rigid ground that a block stands on when nothing else is given."""

from dataclasses import dataclass
from typing import ClassVar

from rockframe.components.base import Component
from rockframe.units import UNIT_INTERVAL, RatioLike, to_ratio


@dataclass(frozen=True)
class RigidGroundSI:
    """Restitution of the ground; ``None`` stands for the block's own maximum."""

    restitution: float | None


class RigidGround(Component[RigidGroundSI]):
    """Rigid ground under a rocking block (Housner's model).

    A scene with a block alone stands on rigid ground; this part is needed only
    to choose a restitution.

    Parameters
    ----------
    restitution : float, optional
        Ratio of the angular velocities after and before an impact, above 0 and
        at most 1; the block's eps_max, Eq. (4), unless given [1].

    Raises
    ------
    UnitsError
        Not a pure ratio.
    ComponentError
        Outside (0, 1].
    """

    noun: ClassVar[str] = "base"

    def __init__(self, *, restitution: RatioLike | None = None) -> None:
        ratio = (
            None
            if restitution is None
            else to_ratio(
                restitution,
                owner="RigidGround",
                name="restitution",
                condition=UNIT_INTERVAL,
                example="0.9",
            )
        )
        self._freeze(RigidGroundSI(ratio), {"restitution": ratio})

    @property
    def restitution(self) -> float | None:
        """Restitution, or None for the block's eps_max [1]."""
        return self.si.restitution
