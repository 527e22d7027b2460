"""A wall behind a body, which then rocks to one side."""

from enum import StrEnum
from typing import Any, ClassVar, Final, Literal

from rockframe.arguments import one_of_words
from rockframe.components.link import BODY, Link
from rockframe.components.parameters import Choice, Count, Declared, Parameter, Ratio, SIValues
from rockframe.errors import ComponentError
from rockframe.units import (
    DAMPING,
    LENGTH,
    NOT_NEGATIVE,
    POSITIVE,
    STIFFNESS,
    THICKNESS,
    Condition,
    Measure,
    QuantityLike,
    RatioLike,
    Unit,
    to_ratio,
)


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


_OF_SPRING: Final = ("damping", "gap", "height")


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

    def write(self, value: WallImpact | float) -> float | str | None:
        """Write the word, or the number; nothing for the usual law, which elastic walls lack."""
        if value is self.default:
            return None
        return str(value) if isinstance(value, WallImpact) else value


class RearWall(Link):
    """A wall behind a body, against which it rocks to one side: stiff, or elastic.

    A stiff one, on rigid ground, touches the body all along its height while that stands. The body
    rocks away about its front corner; when it comes back, base and wall are struck, and it rocks
    away again with a share of its speed, :eq:`eq-wall-impact`. Given a `stiffness` the wall is
    elastic, on any base: a spring and a dashpot that press on the rear face at a height while they
    are touched, behind a gap.

    Raises
    ------
    UnitsError
        Not a pure ratio.
    ComponentError
        A value is out of range, `wall_restitution` is given without ``restitution="newton"``, or
        not with it, or an elastic wall with a restitution.

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

    stiffness = Parameter(
        STIFFNESS, POSITIVE, doc="Of an elastic wall; it is stiff unless given.", default=None
    )
    damping = Parameter(
        DAMPING, NOT_NEGATIVE, doc="Of an elastic wall, while touched; none unless given.",
        default=None,
    )  # fmt: skip
    gap = Parameter(
        THICKNESS.like("5 mm"), NOT_NEGATIVE,
        doc="Between the body that stands and an elastic wall; none unless given.", default=None,
    )  # fmt: skip
    height = Parameter(
        LENGTH, POSITIVE,
        doc="Above its base at which a body touches an elastic wall; its top unless given.",
        default=None,
    )  # fmt: skip
    on_body = Count(doc="Number of the body, from the top down.", default=BODY)

    def __init__(
        self,
        *,
        side: SideLike = WallSide.LEFT,
        restitution: WallImpactLike = WallImpact.SORRENTINO,
        wall_restitution: RatioLike | None = None,
        stiffness: QuantityLike | None = None,
        damping: QuantityLike | None = None,
        gap: QuantityLike | None = None,
        height: QuantityLike | None = None,
        on_body: int = BODY,
    ) -> None:
        super().__init__(
            side=side, restitution=restitution, wall_restitution=wall_restitution,
            stiffness=stiffness, damping=damping, gap=gap, height=height, on_body=on_body,
        )  # fmt: skip

    @property
    def elastic(self) -> bool:
        """Whether it gives way."""
        return self.given.stiffness is not None

    @property
    def direction(self) -> float:
        """Sign of the side on which it stands, 1 for the right."""
        return -1.0 if self.given.side is WallSide.LEFT else 1.0

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
        of_spring = [name for name in _OF_SPRING if getattr(given, name) is not None]
        if of_spring and given.stiffness is None:
            msg = f"RearWall: {' and '.join(of_spring)} goes with a stiffness"
            raise ComponentError(msg)
        if given.stiffness is not None and given.restitution is not WallImpact.SORRENTINO:
            msg = "RearWall: give restitution or stiffness, not both; an elastic wall throws back"
            raise ComponentError(msg)
        return SIValues(**vars(given), name="wall")
