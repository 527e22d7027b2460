"""Ties between points of bodies, the ground, or a wall."""

from typing import Any, ClassVar, Final

from rockframe.components.base import Component
from rockframe.components.parameters import Count, Flag, Parameter, Place, Text
from rockframe.components.values import SIValues
from rockframe.errors import ComponentError
from rockframe.units import (
    DAMPING,
    FORCE,
    NOT_NEGATIVE,
    POSITIVE,
    STIFFNESS,
    THICKNESS,
    QuantityLike,
)

BODY: Final = 1
"""The body that a link is on unless another is named."""


class Link(Component):
    """A link between two points: where it is; classes derived from it say how it pulls.

    Points are given where the bodies stand upright under their weight: from the middle of the
    base of their body to the right, and above it; on the ground, or a wall that moves with it,
    from the middle of the lowest base. Bodies are counted from the top down.
    """

    noun: ClassVar[str] = "link"

    on = Place(doc="The point of the body.")
    to = Place(doc="The other point.")
    on_body = Count(doc="Number of the body, from the top down.", default=BODY)
    to_body = Count(
        doc="Number of the body of the other point; the ground, or a wall that moves with it, "
        "unless given.",
        default=None,
    )
    name = Text(doc="What results call it; by its number unless given.", default=None)

    def parameters(self) -> tuple[str, ...]:
        """Name the arguments that are numbers other than zero, with a unit or without.

        Returns
        -------
        tuple of str
        """
        return tuple(one for one in super().parameters() if one not in ("on_body", "to_body"))


class Restrainer(Link):
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
        POSITIVE,
        doc="Force with which it pulls while the bodies stand upright under their weight alone; "
        "none unless given.",
        default=None,
    )
    strength = Parameter(
        FORCE, POSITIVE, doc="Greatest force of its spring; without end unless given.", default=None
    )
    brittle = Flag(doc="Whether it breaks at its strength, or yields.", default=True)
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
        damping: QuantityLike | None = None,
        compression: bool = False,
        on_body: int = BODY,
        to_body: int | None = None,
        name: str | None = None,
    ) -> None:
        super().__init__(
            on=on, to=to, stiffness=stiffness, slack=slack, preload=preload, strength=strength,
            brittle=brittle, damping=damping, compression=compression, on_body=on_body,
            to_body=to_body, name=name,
        )  # fmt: skip

    def _numbers(self, given: SIValues) -> Any:
        faults = list[str]()
        if given.slack and given.preload:
            faults.append("a tie with slack has no preload: give one of them")
        if given.slack and given.compression:
            faults.append("a bar that pushes has no slack: give slack or compression")
        if given.preload and given.strength and given.preload >= given.strength:
            faults.append(
                f"its preload, {given.preload:.6g} N, is not below its strength, "
                f"{given.strength:.6g} N"
            )
        if faults:
            msg = f"Restrainer: {'; '.join(faults)}"
            raise ComponentError(msg)
        return given
