"""Ties between points of bodies and the ground, tendons, loads, and a wall behind a body."""

from enum import StrEnum
from typing import Any, ClassVar, Final, Literal

from rockframe.arguments import one_of_words
from rockframe.components.base import Component
from rockframe.components.parameters import (
    Choice,
    Count,
    Declared,
    Flag,
    Parameter,
    Place,
    Ratio,
    SIValues,
    Text,
)
from rockframe.errors import ComponentError
from rockframe.units import (
    DAMPING,
    FORCE,
    LENGTH,
    MASS,
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

BODY: Final = 1
"""The body that a link is on unless another is named."""


class Link(Component):
    """What acts on a point of a body; bodies are counted from the top down.

    Examples
    --------
    >>> import rockframe as rf
    >>> load = rf.Load(at=("-0.1 m", "3 m"), vertical="10 kN", on_body=2)
    >>> isinstance(load, Link), load.parameters()
    (True, ('vertical',))
    """

    noun: ClassVar[str] = "link"

    def parameters(self) -> tuple[str, ...]:
        """Name the arguments that are numbers other than zero, with a unit or without.

        Returns
        -------
        tuple of str
        """
        return tuple(one for one in super().parameters() if one not in ("on_body", "to_body"))


def _on_body() -> Count[int]:
    return Count(doc="Number of the body, from the top down.", default=BODY)


def _to_body() -> Count[None]:
    return Count(
        doc="Number of the body of the other point; the ground, or a wall that moves with it, "
        "unless given.",
        default=None,
    )


def _name() -> Text[None]:
    return Text(doc="What results call it; by its number unless given.", default=None)


class PointLink(Link):
    """A link between two points: where it is; classes derived from it say how it pulls.

    Points are given where the bodies stand upright under their weight: from the middle of the
    base of their body to the right, and above it; on the ground, or a wall that moves with it,
    from the middle of the lowest base. Bodies are counted from the top down.

    Examples
    --------
    >>> import rockframe as rf
    >>> tie = rf.Restrainer(on=("-0.5 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="2 MN/m")
    >>> isinstance(tie, PointLink), tie.parameters()
    (True, ('stiffness',))
    """

    on = Place(doc="The point of the body.")
    to = Place(doc="The other point.")
    on_body = _on_body()
    to_body = _to_body()
    name = _name()


class Restrainer(PointLink):
    """A tie, an anchor or a bar between two points: a spring beside a dashpot.

    It pulls only, with a force that grows from where it becomes taut, yields or breaks at its
    strength, and with `compression` pushes likewise. One that yields keeps what it was stretched
    by, and hangs slack sooner. The dashpot acts both ways, taut or slack, until the tie breaks.
    Points are given where the bodies stand upright under their weight: from the middle of the
    base of their body to the right, and above it; on the ground, or a wall that moves with it,
    from the middle of the lowest base.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, `slack` is given with `preload` or `compression`, or `preload`
        is not below `strength`.

    Examples
    --------
    >>> import rockframe as rf
    >>> tie = rf.Restrainer(
    ...     on=("-0.5 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="2 MN/m", strength="20 kN"
    ... )
    >>> tie.replace(slack="5 mm").slack.to("mm")
    <Quantity(5.0, 'millimeter')>
    """

    noun: ClassVar[str] = "restrainer"

    stiffness = Parameter(STIFFNESS, POSITIVE, doc="Force over elongation.")
    slack = Parameter(
        THICKNESS.like("5 mm"),
        NOT_NEGATIVE,
        doc="Elongation at which it becomes taut; none unless given.",
        default=None,
    )
    preload = Parameter(
        FORCE,
        NOT_NEGATIVE,
        doc="Force with which it pulls while the bodies stand upright under their weight alone; "
        "none unless given.",
        default=None,
    )
    strength = Parameter(
        FORCE, POSITIVE, doc="Greatest force of its spring; without end unless given.", default=None
    )
    brittle = Flag(doc="Whether it breaks at its strength, or yields.", default=True)
    breaking_elongation = Parameter(
        THICKNESS.like("50 mm"),
        POSITIVE,
        doc="Elongation at which it breaks, in the place of a strength; none unless given.",
        default=None,
    )
    damping = Parameter(
        DAMPING, NOT_NEGATIVE, doc="Of the dashpot; none unless given.", default=None
    )
    compression = Flag(doc="Whether it pushes as it pulls.", default=False)

    def __init__(
        self,
        *,
        on: tuple[QuantityLike, QuantityLike],
        to: tuple[QuantityLike, QuantityLike],
        stiffness: QuantityLike,
        slack: QuantityLike | None = None,
        preload: QuantityLike | None = None,
        strength: QuantityLike | None = None,
        brittle: bool = True,
        breaking_elongation: QuantityLike | None = None,
        damping: QuantityLike | None = None,
        compression: bool = False,
        on_body: int = BODY,
        to_body: int | None = None,
        name: str | None = None,
    ) -> None:
        super().__init__(
            on=on, to=to, stiffness=stiffness, slack=slack, preload=preload, strength=strength,
            brittle=brittle, breaking_elongation=breaking_elongation, damping=damping,
            compression=compression, on_body=on_body,
            to_body=to_body, name=name,
        )  # fmt: skip

    def _numbers(self, given: SIValues) -> Any:
        faults = list[str]()
        if given.slack and given.preload:
            faults.append("a tie with slack has no preload: give one of them")
        if given.breaking_elongation and (given.strength or not given.brittle):
            faults.append("one that breaks at an elongation has no strength: give one of them")
        if given.breaking_elongation and given.breaking_elongation <= (given.slack or 0.0):
            faults.append("it would break, by breaking_elongation, before its slack is taken up")
        if given.slack and given.compression:
            faults.append("a bar that pushes has no slack: give slack or compression")
        if faults:
            msg = f"Restrainer: {'; '.join(faults)}"
            raise ComponentError(msg)
        _refuse_preload("Restrainer", given)
        return given


class Tendon(Link):
    """A tendon through a body, tensioned between its top and what it stands on.

    It leaves the body at a point of its base and goes on into the ground, or into the body below,
    where it is bent over the edges of its duct as the base lifts there: it is longer by how far
    both edges are apart. Anchored at a depth in a wide duct it is straight from there to the edge.
    It yields or breaks at its strength. With a :class:`~rockframe.RockingFrame` it is one of each
    column, along the axis of that and into the beam.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or `preload` is not below `strength`.

    Examples
    --------
    >>> import rockframe as rf
    >>> rf.Tendon(stiffness="5 MN/m", preload="200 kN").preload.to("kN")
    <Quantity(200.0, 'kilonewton')>
    """

    noun: ClassVar[str] = "tendon"

    stiffness = Parameter(STIFFNESS, POSITIVE, doc="Force over elongation, E A over its length.")
    preload = Parameter(
        FORCE,
        NOT_NEGATIVE,
        doc="Force while the bodies stand upright under their weight alone; none unless given.",
        default=None,
    )
    at = Parameter(
        LENGTH.like("0 m"),
        doc="Its place in the base, to the right of the middle.", default="0 m",
    )  # fmt: skip
    depth = Parameter(
        LENGTH, NOT_NEGATIVE,
        doc="How far below the base it is held, in a duct that is wide; on pads and soil it must "
        "be given.", default="0 m",
    )  # fmt: skip
    strength = Parameter(
        FORCE, POSITIVE, doc="Greatest force; without end unless given.", default=None
    )
    brittle = Flag(doc="Whether it breaks at its strength, or yields.", default=False)
    on_body = _on_body()
    name = _name()

    def __init__(
        self,
        *,
        stiffness: QuantityLike,
        preload: QuantityLike | None = None,
        at: QuantityLike = "0 m",
        depth: QuantityLike = "0 m",
        strength: QuantityLike | None = None,
        brittle: bool = False,
        on_body: int = BODY,
        name: str | None = None,
    ) -> None:
        super().__init__(
            stiffness=stiffness, preload=preload, at=at, depth=depth, strength=strength,
            brittle=brittle, on_body=on_body, name=name,
        )  # fmt: skip

    def _numbers(self, given: SIValues) -> Any:
        _refuse_preload("Tendon", given)
        return given


class Load(Link):
    """Forces that stay as they are, at a point that moves with a body, or a mass there.

    Such as a floor that bears on a façade, or the thrust of a vault. The point is given where the
    bodies stand upright under their weight: from the middle of the base of its body to the right,
    and above it.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or none is given.

    Examples
    --------
    >>> import rockframe as rf
    >>> rf.Load(at=("-0.1 m", "3 m"), vertical="10 kN").vertical.to("kN")
    <Quantity(10.0, 'kilonewton')>
    """

    noun: ClassVar[str] = "load"

    at = Place(doc="Its point.")
    vertical = Parameter(FORCE, doc="Force downwards; none unless given.", default="0 N")
    horizontal = Parameter(FORCE, doc="Force to the right; none unless given.", default="0 N")
    moving_mass = Parameter(
        MASS, NOT_NEGATIVE,
        doc="Mass at the point, a part of the body, with its weight; none unless given.",
        default=None,
    )  # fmt: skip
    on_body = _on_body()
    name = _name()

    def __init__(
        self,
        *,
        at: tuple[QuantityLike, QuantityLike],
        vertical: QuantityLike = "0 N",
        horizontal: QuantityLike = "0 N",
        moving_mass: QuantityLike | None = None,
        on_body: int = BODY,
        name: str | None = None,
    ) -> None:
        super().__init__(
            at=at, vertical=vertical, horizontal=horizontal, moving_mass=moving_mass,
            on_body=on_body, name=name,
        )  # fmt: skip

    def _numbers(self, given: SIValues) -> Any:
        if not (given.vertical or given.horizontal) and given.moving_mass is None:
            msg = "Load: give vertical, horizontal or moving_mass"
            raise ComponentError(msg)
        return given


def _refuse_preload(owner: str, given: SIValues) -> None:
    """Refuse a preload that is not below the strength."""
    if given.preload and given.strength and given.preload >= given.strength:
        msg = (
            f"{owner}: its preload, {given.preload:.6g} N, is not below its strength, "
            f"{given.strength:.6g} N"
        )
        raise ComponentError(msg)


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
    elastic, on any base: a spring and a dashpot that act on the rear face at a height while they
    are touched, behind a gap; before the spring is unloaded the dashpot may pull.

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
