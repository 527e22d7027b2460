"""Rigid ground under a body of a stack: what it is called, and the law of its equations."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockframe.components import RigidGround
from rockframe.system.load import Load
from rockframe.system.support import BaseWords, Support
from rockframe.system.words import uplift_words

if TYPE_CHECKING:
    from rockframe.dynamics.base_numbers import BaseNumbers
    from rockframe.dynamics.body import Body

NO_VERTICAL_START = (
    "InitialState: vertical_displacement and vertical_velocity need a base that gives way; on "
    "rigid ground they follow from the rotation"
)


@dataclass(frozen=True)
class RigidBase(Support):
    """A rigid base."""

    @property
    def model(self) -> str:
        """Name of the model."""
        return "rigid"

    @property
    def settlement(self) -> float:
        """Zero [m]."""
        return 0.0

    @property
    def uplift_angle(self) -> float:  # type: ignore[override]
        """Zero: any rotation lifts a corner [rad]."""
        return 0.0

    def law(self, body: "Body", mass: float, load_mass: float) -> "BaseNumbers":
        """Give the base as the equations take it."""
        from rockframe.dynamics.base_numbers import rigid_numbers

        return rigid_numbers(body)

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Refuse a vertical start: the base leaves no vertical freedom."""
        return [NO_VERTICAL_START] if has_vertical_start else []

    def uplift_accelerations(self) -> tuple[float, float]:
        """Ground accelerations at which all above rocks about its left and right corner [m s^-2].

        Equation :eq:`eq-rigid-together`.
        """
        body = self.load.body
        left, right = body.left / body.centre_height, body.right / body.centre_height
        return self.load.gravity * left, self.load.gravity * right

    def words(self) -> BaseWords:
        """Tell the base in words."""
        left, right = self.uplift_accelerations()
        starts = f"{left:.4g} m s^-2"
        if left != right:
            starts = f"{left:.4g} m s^-2 to the left, {right:.4g} m s^-2 to the right"
        return BaseWords(
            law="corners held by forces on rigid bases",
            equations=[],
            uplift=("uplift angle", uplift_words(self.uplift_angle)),
            numbers=[("rigid, all above rocks as one at xg'' of", starts)],
            left_out=["elasticity of the contacts"],
        )


def rigid_under(part: RigidGround, load: Load) -> RigidBase:
    """Give a rigid base under a body."""
    return RigidBase(load)
