"""A wall behind a body, which then rocks to one side."""

from enum import StrEnum
from typing import Any, ClassVar, Literal

from rockframe.arguments import one_of_words
from rockframe.components.base import Component
from rockframe.components.parameters import Choice, Declared, Ratio
from rockframe.components.values import SIValues
from rockframe.errors import ComponentError
from rockframe.units import Condition, Measure, RatioLike, Unit, to_ratio


class WallSide(StrEnum):
    """Where a wall is."""

    LEFT = "left"
    RIGHT = "right"


class WallImpact(StrEnum):
    """What becomes of the angular velocity at an impact on base and wall."""

    SORRENTINO = "sorrentino"
    NEWTON = "newton"


SideLike = WallSide | Literal["left", "right"]
WallImpactLike = WallImpact | Literal["sorrentino", "newton"] | RatioLike
REBOUND = Condition("from -1 to 0", lambda value: -1.0 <= value <= 0.0)
SHARE = Condition("from 0 to 1", lambda value: 0.0 <= value <= 1.0)


class _Impact(Declared[Any, Any]):
    """The parameter that is the name of a law, or the ratio itself."""

    written_as = '{"sorrentino", "newton"} or float'
    annotation = WallImpactLike
    measure: Measure

    def __init__(self, *, doc: str, default: WallImpact) -> None:
        measure = Measure("a pure ratio", Unit.ONE, "-0.4")
        super().__init__(measure, REBOUND, doc=doc, default=default)

    def read(self, given: object, owner: str) -> WallImpact | float:
        """Take the word, or the number."""
        if isinstance(given, str) and given in list(WallImpact):
            return one_of_words(WallImpact, given, owner=owner, name=self.name)
        return to_ratio(
            given, owner=owner, name=self.name, condition=self.condition,
            example=f'"{WallImpact.SORRENTINO}", "{WallImpact.NEWTON}" or -0.4',
        )  # fmt: skip

    def write(self, value: WallImpact | float) -> float | str:
        """Write the word, or the number."""
        return str(value) if isinstance(value, WallImpact) else value


class RearWall(Component):
    """A stiff wall behind a body on rigid ground, against which it rocks to one side only.

    Body and wall touch all along the body's height while it stands. It rocks away from the wall
    about its front corner; when it comes back, base and wall are struck, and it rocks away again
    with a share of its speed, :eq:`eq-wall-impact`.

    Raises
    ------
    UnitsError
        Not a pure ratio.
    ComponentError
        A value is out of range, or `wall_restitution` is given without ``restitution="newton"``,
        or not with it.

    Examples
    --------
    >>> import rockframe as rf
    >>> facade = rf.Block(width="0.3 m", height="3 m", mass="1.6 t")
    >>> wall = rf.RearWall(side="left")
    >>> round(rf.System(facade, wall).setting.rebound, 6)
    -0.470845
    """

    noun: ClassVar[str] = "wall"

    side = Choice(WallSide.LEFT, doc="Where the wall is; the body rocks to the other side.")
    restitution = _Impact(
        doc="Ratio of the angular velocities after and before an impact: a law, "
        '"sorrentino" (impacts on the base, on the wall and on the base again) or "newton" (the '
        "same with a coefficient of the wall); or the ratio itself, zero or negative.",
        default=WallImpact.SORRENTINO,
    )
    wall_restitution = Ratio(
        SHARE,
        doc='Coefficient of the wall, of the law "newton"; 0 for a wall that stops the body.',
        default=None,
        example="0.3",
    )

    def __init__(
        self,
        *,
        side: SideLike = WallSide.LEFT,
        restitution: WallImpactLike = WallImpact.SORRENTINO,
        wall_restitution: RatioLike | None = None,
    ) -> None:
        super().__init__(side=side, restitution=restitution, wall_restitution=wall_restitution)

    def _numbers(self, given: SIValues) -> SIValues:
        newton = given.restitution is WallImpact.NEWTON
        if newton == (given.wall_restitution is None):
            words = (
                'restitution="newton" needs wall_restitution, for example wall_restitution=0.3'
                if newton
                else 'wall_restitution goes with restitution="newton"'
            )
            msg = f"RearWall: {words}"
            raise ComponentError(msg)
        return given
