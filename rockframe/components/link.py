"""Links: ties between points of bodies and the ground, tendons, loads, and a wall behind a body."""

from enum import StrEnum
from typing import Any, ClassVar, Final, Literal

from rockframe.arguments import checked_choice
from rockframe.components.base import Component
from rockframe.components.parameters import (
    Choice,
    Count,
    Declared,
    Flag,
    Parameter,
    Position,
    Ratio,
    SIValues,
    Text,
)
from rockframe.errors import ComponentError, raise_faults
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
    RatioLike,
    Unit,
    to_ratio,
)

DEFAULT_BODY: Final = 1
"""Number of the body that a link acts on by default."""


class Link(Component):
    """A part that acts on a point of a body; bodies are numbered from the top down.

    Examples
    --------
    >>> import rockframe as rf
    >>> load = rf.Load(at=("-0.1 m", "3 m"), vertical="10 kN", on_body=2)
    >>> isinstance(load, Link), load.parameters()
    (True, ('vertical',))
    """

    noun: ClassVar[str] = "link"

    def parameters(self) -> tuple[str, ...]:
        """Name the arguments that are numbers other than zero, without those of bodies.

        Returns
        -------
        tuple of str
        """
        return tuple(name for name in super().parameters() if name not in ("on_body", "to_body"))


def _body_parameter() -> Count[int]:
    return Count(doc="Number of the body, from the top down.", default=DEFAULT_BODY)


def _name_parameter() -> Text[None]:
    return Text(doc="Name in results; its number unless given.", default=None)


class PointLink(Link):
    """A link between two points; a class derived from it defines its force.

    Coordinates of points refer to all bodies upright and at rest under their weight, and are
    measured to the right of the middle of the base of the body and upwards from it. Those of a
    point of the ground, or of a wall that moves with it, are measured from the middle of the
    lowest base. Bodies are numbered from the top down.

    Examples
    --------
    >>> import rockframe as rf
    >>> tie = rf.Restrainer(on=("-0.5 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="2 MN/m")
    >>> isinstance(tie, PointLink), tie.parameters()
    (True, ('stiffness',))
    """

    on: Position = Position(doc="The point of the body.")
    to: Position = Position(doc="The other point.")
    on_body: Count[int] = _body_parameter()
    to_body: Count[None] = Count(
        doc="Number of the body of the other point; the ground, or a wall that moves with it, "
        "unless given.",
        default=None,
    )
    name: Text[None] = _name_parameter()


class Restrainer(PointLink):
    """A tie, an anchor or a bar between two points: a spring and a dashpot in parallel.

    The spring takes tension only, unless `compression` is set. Its force grows linearly from the
    elongation at which it becomes taut. It yields or breaks at its strength. A tie that has
    yielded keeps its plastic elongation, and becomes slack earlier. The dashpot acts in both
    directions, taut or slack, until the tie breaks. Coordinates of points refer to all bodies
    upright and at rest under their weight, and are measured to the right of the middle of the
    base of the body and upwards from it. Those of a point of the ground, or of a wall that moves
    with it, are measured from the middle of the lowest base.

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
    >>> print(tie.replace(slack="5 mm").slack.to("mm"))
    5.0 millimeter
    """

    noun: ClassVar[str] = "restrainer"

    stiffness: Parameter = Parameter(STIFFNESS, POSITIVE, doc="Force over elongation.")
    slack: Parameter[None] = Parameter(
        THICKNESS.like("5 mm"),
        NOT_NEGATIVE,
        doc="Elongation at which it becomes taut; none unless given.",
        default=None,
    )
    preload: Parameter[None] = Parameter(
        FORCE,
        NOT_NEGATIVE,
        doc="Tension while the bodies stand upright under their weight alone; none unless given.",
        default=None,
    )
    strength: Parameter[None] = Parameter(
        FORCE, POSITIVE, doc="Greatest force of its spring; unlimited unless given.", default=None
    )
    brittle: Flag = Flag(doc="Whether it breaks at its strength, or yields.", default=True)
    breaking_elongation: Parameter[None] = Parameter(
        THICKNESS.like("50 mm"),
        POSITIVE,
        doc="Elongation at which it breaks, in place of a strength; none unless given.",
        default=None,
    )
    damping: Parameter[None] = Parameter(
        DAMPING, NOT_NEGATIVE,
        doc="Damping coefficient of the dashpot; none unless given.", default=None,
    )  # fmt: skip
    compression: Flag = Flag(doc="Whether it takes compression as it takes tension.", default=False)

    def _numbers(self, numbers: SIValues) -> Any:
        faults = list[str]()
        if numbers.slack and numbers.preload:
            faults.append("a tie with slack has no preload: give one of them")
        if numbers.breaking_elongation and (numbers.strength or not numbers.brittle):
            faults.append("a tie that breaks at an elongation has no strength: give one of them")
        if numbers.breaking_elongation and numbers.breaking_elongation <= (numbers.slack or 0.0):
            faults.append("breaking_elongation must exceed the slack, or it breaks before it pulls")
        if numbers.slack and numbers.compression:
            faults.append("a bar that pushes has no slack: give slack or compression")
        raise_faults("Restrainer", faults)
        return _check_preload("Restrainer", numbers)


class Tendon(Link):
    """A tendon through a body, tensioned between its top and the ground or the body below.

    It leaves the body at a point of its base and continues into the ground, or into the body
    below. Where the base lifts off, it is deflected at the edges of both ducts, and its elongation
    is the distance of the edges. If it is anchored at a depth in a wide duct, it is straight from
    the anchorage to the edge in the base. It yields or breaks at its strength. In a
    :class:`~rockframe.RockingFrame` each column has such a tendon, along its axis and into the
    beam.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or `preload` is not below `strength`.

    Examples
    --------
    >>> import rockframe as rf
    >>> print(rf.Tendon(stiffness="5 MN/m", preload="200 kN").preload.to("kN"))
    200.0 kilonewton
    """

    noun: ClassVar[str] = "tendon"

    stiffness: Parameter = Parameter(
        STIFFNESS, POSITIVE, doc="Force over elongation, E A over its length."
    )
    preload: Parameter[None] = Parameter(
        FORCE,
        NOT_NEGATIVE,
        doc="Force while the bodies stand upright under their weight alone; none unless given.",
        default=None,
    )
    at: Parameter[str] = Parameter(
        LENGTH.like("0 m"),
        doc="Place in the base, to the right of the middle.", default="0 m",
    )  # fmt: skip
    depth: Parameter[str] = Parameter(
        LENGTH, NOT_NEGATIVE,
        doc="Depth of its anchorage below the base, in a wide duct; on pads and soil it must be "
        "given.", default="0 m",
    )  # fmt: skip
    strength: Parameter[None] = Parameter(
        FORCE, POSITIVE, doc="Greatest force; unlimited unless given.", default=None
    )
    brittle: Flag = Flag(doc="Whether it breaks at its strength, or yields.", default=False)
    on_body: Count[int] = _body_parameter()
    name: Text[None] = _name_parameter()

    def _numbers(self, numbers: SIValues) -> Any:
        return _check_preload("Tendon", numbers)


class Load(Link):
    """Constant forces at a point that moves with a body, or a mass at this point.

    Examples are a floor that rests on a façade, and the thrust of a vault. Coordinates of the
    point refer to all bodies upright and at rest under their weight, and are measured to the
    right of the middle of the base of the body and upwards from it.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or none is given.

    Examples
    --------
    >>> import rockframe as rf
    >>> print(rf.Load(at=("-0.1 m", "3 m"), vertical="10 kN").vertical.to("kN"))
    10.0 kilonewton
    """

    noun: ClassVar[str] = "load"

    at: Position = Position(doc="Point of the body.")
    vertical: Parameter[str] = Parameter(
        FORCE, doc="Force downwards; none unless given.", default="0 N"
    )
    horizontal: Parameter[str] = Parameter(
        FORCE, doc="Force to the right; none unless given.", default="0 N"
    )
    moving_mass: Parameter[None] = Parameter(
        MASS, NOT_NEGATIVE,
        doc="Mass at the point, a part of the body, with its weight; none unless given.",
        default=None,
    )  # fmt: skip
    on_body: Count[int] = _body_parameter()
    name: Text[None] = _name_parameter()

    def _numbers(self, numbers: SIValues) -> Any:
        if not (numbers.vertical or numbers.horizontal) and numbers.moving_mass is None:
            msg = "Load: give vertical, horizontal or moving_mass"
            raise ComponentError(msg)
        return numbers


def _check_preload(owner: str, numbers: SIValues) -> SIValues:
    """Refuse a preload that is not below the strength."""
    if numbers.preload and numbers.strength and numbers.preload >= numbers.strength:
        msg = (
            f"{owner}: its preload, {numbers.preload:.6g} N, is not below its strength, "
            f"{numbers.strength:.6g} N"
        )
        raise ComponentError(msg)
    return numbers


class WallSide(StrEnum):
    """Side of the body on which a wall is."""

    LEFT = "left"
    RIGHT = "right"


class WallImpact(StrEnum):
    """Law of the angular velocity after an impact on base and wall."""

    SORRENTINO = "sorrentino"
    NEWTON = "newton"


SideLike = WallSide | Literal["left", "right"]
WallImpactLike = WallImpact | Literal["sorrentino", "newton"] | RatioLike
REBOUND_RANGE = Condition("from -1 to 0", lambda value: -1.0 <= value <= 0.0)
RESTITUTION_RANGE = Condition("from 0 to 1", lambda value: 0.0 <= value <= 1.0)


_ELASTIC_PARAMETERS: Final = ("damping", "gap", "height", "name")


class _ReboundParameter(Declared[Any, WallImpactLike, WallImpact]):
    """A parameter that is the name of a law, or a ratio."""

    written_as = '{"sorrentino", "newton"} or float'
    annotation = WallImpactLike
    measure: Measure

    def __init__(self, *, doc: str, default: WallImpact) -> None:
        measure = Measure("a pure ratio", Unit.ONE, "-0.4")
        super().__init__(measure, REBOUND_RANGE, doc=doc, default=default)

    def read(self, value: object, owner: str) -> WallImpact | float:
        """Read the name of a law, or a number."""
        if isinstance(value, str) and value in list(WallImpact):
            return checked_choice(WallImpact, value, owner=owner, name=self.name)
        return to_ratio(
            value, owner=owner, name=self.name, condition=self.condition,
            example=f'"{WallImpact.SORRENTINO}", "{WallImpact.NEWTON}" or -0.4',
        )  # fmt: skip

    def write(self, value: WallImpact | float) -> float | str | None:
        """Write the law or the number; None for the default, which elastic walls lack."""
        if value is self.default:
            return None
        return str(value) if isinstance(value, WallImpact) else value


class RearWall(Link):
    """A wall behind a body, so that it rocks to one side only: rigid or elastic.

    A rigid wall needs rigid ground, and touches the upright body along its whole height. The body
    rocks away from it about its front corner. When it returns, it strikes base and wall, and
    rebounds with a fraction of its angular velocity, :eq:`eq-wall-impact`. With a `stiffness` the
    wall is elastic, on any base: behind a gap, a spring and a dashpot act on the rear face at a
    given height during contact, which ends when the spring is unloaded.

    Raises
    ------
    UnitsError
        Not a pure ratio.
    ComponentError
        A value is out of range; only one of `wall_restitution` and ``restitution="newton"`` is
        given; or an elastic wall has a restitution.

    Examples
    --------
    >>> import rockframe as rf
    >>> facade = rf.Block(width="0.3 m", height="3 m", mass="1.6 t")
    >>> wall = rf.RearWall(side="left")
    >>> round(rf.System(facade, wall).setting.rebound, 6)
    -0.470845
    """

    noun: ClassVar[str] = "wall"

    side: Choice[WallSide, SideLike] = Choice(
        WallSide.LEFT, doc="Side of the wall; the body rocks to the other side."
    )
    restitution: _ReboundParameter = _ReboundParameter(
        doc="Ratio of the angular velocities after and before an impact: a law, "
        '"sorrentino" (impacts on the base, on the wall and on the base again) or "newton" (the '
        "same with a coefficient of the wall); or the ratio itself, zero or negative.",
        default=WallImpact.SORRENTINO,
    )
    wall_restitution: Ratio[None] = Ratio(
        RESTITUTION_RANGE,
        doc='Coefficient of the wall, of the law "newton"; 0 for a wall that stops the body.',
        default=None,
        example="0.3",
    )

    stiffness: Parameter[None] = Parameter(
        STIFFNESS,
        POSITIVE,
        doc="Stiffness of an elastic wall; the wall is rigid unless given.",
        default=None,
    )
    damping: Parameter[None] = Parameter(
        DAMPING, NOT_NEGATIVE,
        doc="Damping coefficient of an elastic wall during contact; none unless given.",
        default=None,
    )  # fmt: skip
    gap: Parameter[None] = Parameter(
        THICKNESS.like("5 mm"), NOT_NEGATIVE,
        doc="Distance from the upright body to an elastic wall; none unless given.", default=None,
    )  # fmt: skip
    height: Parameter[None] = Parameter(
        LENGTH, POSITIVE,
        doc="Height above its base at which a body touches an elastic wall; its top unless given.",
        default=None,
    )  # fmt: skip
    on_body: Count[int] = _body_parameter()
    name: Text[None] = Text(
        doc="Name of an elastic wall in results; wall unless given, with a number where several "
        "have none.",
        default=None,
    )

    @property
    def elastic(self) -> bool:
        """Whether the wall is elastic, not rigid."""
        return self.given.stiffness is not None

    @property
    def direction(self) -> float:
        """Sign of its side: 1 for the right, -1 for the left."""
        return -1.0 if self.given.side is WallSide.LEFT else 1.0

    def _numbers(self, numbers: SIValues) -> SIValues:
        newton = numbers.restitution is WallImpact.NEWTON
        if newton == (numbers.wall_restitution is None):
            words = (
                'restitution="newton" needs wall_restitution, for example wall_restitution=0.3'
                if newton
                else 'wall_restitution goes with restitution="newton"'
            )
            msg = f"RearWall: {words}"
            raise ComponentError(msg)
        elastic = [name for name in _ELASTIC_PARAMETERS if getattr(numbers, name) is not None]
        if elastic and numbers.stiffness is None:
            msg = f"RearWall: give a stiffness with {' and '.join(elastic)}, for an elastic wall"
            raise ComponentError(msg)
        if numbers.stiffness is not None and numbers.restitution is not WallImpact.SORRENTINO:
            msg = "RearWall: give restitution or stiffness, not both; a spring has no restitution"
            raise ComponentError(msg)
        return numbers
