"""Bodies upon one another."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Self

from rockframe.arguments import several
from rockframe.components.base import Component
from rockframe.components.block import Block
from rockframe.components.block_numbers import BlockSI
from rockframe.components.parameters import SIValues
from rockframe.components.registry import component_from_dict
from rockframe.errors import ComponentError, shown, unexpected_argument
from rockframe.units import LENGTH, Quantity, QuantityLike, quantity, to_si

MOST_BODIES: Final = 12
"""Bodies of a stack: of more, contacts have more combinations than can be numbered."""


@dataclass(frozen=True)
class StackSI:
    """A stack in SI units, from the top down."""

    bodies: tuple[BlockSI, ...]  # the bodies
    # how far the middle of each body's base is to the right of that of the body below; zero of the
    # lowest [m]
    offsets: tuple[float, ...]


class Stack(Component):
    """Blocks upon one another, each on a base of its own on the top of the block below.

    Parameters
    ----------
    *bodies : Block
        From the top down, two at least: statue and plinth, drums of a column.
    interfaces : sequence of Component
        The bases between them, from the top down, one less than bodies: each a
        :class:`TwoSpringSupport`, a :class:`WinklerSoil` or a :class:`RigidGround`. What the
        lowest body stands on is a part of the system. Frequency and damping ratios of a base are
        those of all that it carries, as one body.
    offsets : sequence of str or pint.Quantity, optional
        How far the middle of the base of each body but the lowest is to the right of that of the
        body below [m]; none unless given.

    Raises
    ------
    ComponentError
        There are too few or too many bodies, not one interface between each two of them, or a
        base or an offset reaches beyond the top of the body below.
    UnitsError
        An offset has the wrong unit, or none.

    Examples
    --------
    >>> import rockframe as rf
    >>> statue = rf.Block(width="0.5 m", height="1.8 m", mass="900 kg")
    >>> plinth = rf.Block(width="0.9 m", height="1 m", mass="2200 kg")
    >>> joint = rf.TwoSpringSupport(frequency_ratio=60, damping_ratio=0.1)
    >>> rf.Stack(statue, plinth, interfaces=[joint]).bodies[1] == plinth
    True
    """

    si: StackSI
    noun: ClassVar[str] = "stack"

    def __init__(
        self,
        *bodies: Block,
        interfaces: Sequence[Component],
        offsets: Sequence[QuantityLike] | None = None,
    ) -> None:
        self._keep(bodies, interfaces, offsets)
        self._warn()

    def _keep(self, bodies: Sequence[Any], interfaces: object, offsets: object) -> None:
        """Check what is given, and keep it."""
        interfaces = several(interfaces, owner="Stack", name="interfaces", of="bases")
        beside = None if offsets is None else [
            to_si(one, LENGTH, owner="Stack", name=f"offsets[{i}]") for i, one in
            enumerate(several(offsets, owner="Stack", name="offsets", of="lengths"))
        ]  # fmt: skip
        faults = [
            f"a body of a stack is a Block, got {shown(one)}"
            for one in bodies
            if not isinstance(one, Block)
        ]
        faults += [
            f"an interface is a base such as TwoSpringSupport, got {shown(one)}"
            for one in interfaces
            if not isinstance(one, Component) or isinstance(one, Block)
        ]
        if not 2 <= len(bodies) <= MOST_BODIES:
            faults.append(f"it has 2 to {MOST_BODIES} bodies, got {len(bodies)}")
        if len(interfaces) != len(bodies) - 1:
            faults.append(
                f"{len(bodies)} bodies have {max(len(bodies) - 1, 0)} interfaces between them, got "
                f"{len(interfaces)}; what the lowest body stands on is a part of the system"
            )
        if beside is not None and len(beside) != len(bodies) - 1:
            faults.append(
                f"offsets are those of all bodies but the lowest: {max(len(bodies) - 1, 0)}, got "
                f"{len(beside)}"
            )
        if faults:
            msg = f"Stack: {'; '.join(faults)}"
            raise ComponentError(msg)
        beside = [0.0] * (len(bodies) - 1) if beside is None else beside
        _refuse_overhang([one.si for one in bodies], beside)
        given = SIValues(bodies=tuple(bodies), interfaces=tuple(interfaces), offsets=tuple(beside))
        object.__setattr__(self, "given", given)
        object.__setattr__(self, "si", StackSI(tuple(one.si for one in bodies), (*beside, 0.0)))

    @property
    def bodies(self) -> tuple[Block, ...]:
        """The bodies, from the top down."""
        found: tuple[Block, ...] = self.given.bodies
        return found

    @property
    def interfaces(self) -> tuple[Component, ...]:
        """The bases between them, from the top down."""
        found: tuple[Component, ...] = self.given.interfaces
        return found

    @property
    def offsets(self) -> tuple[Quantity, ...]:
        """How far each body but the lowest stands to the right of the body below [m]."""
        return tuple(quantity(one, LENGTH) for one in self.given.offsets)

    def cautions(self) -> list[str]:
        """Say what is unusual about bodies and interfaces.

        Returns
        -------
        list of str
        """
        return [text for one in (*self.bodies, *self.interfaces) for text in one.cautions()]

    def parameters(self) -> tuple[str, ...]:
        """Name the numbers of bodies and interfaces other than zero.

        Returns
        -------
        tuple of str
            As "height of body 1" and "stiffness of interface 1", from the top down.
        """
        return tuple(
            f"{name} of {kind} {k}"
            for kind, parts in (("body", self.bodies), ("interface", self.interfaces))
            for k, part in enumerate(parts, 1)
            for name in part.parameters()
        )

    def with_scaled(self, name: str, factor: float) -> Self:
        """Build a stack of which one number of a body or an interface is larger or smaller.

        Parameters
        ----------
        name : str
            One of :meth:`parameters`.
        factor : float
            New value over old [1].

        Returns
        -------
        Stack

        Raises
        ------
        ComponentError
            No such parameter, or its new value is out of range, or a body is then wider than what
            it stands on.
        """
        self._check_name(name, self.parameters())
        own, _, place = name.partition(" of ")
        kind, _, k = place.partition(" ")
        bodies, interfaces = list(self.bodies), list(self.interfaces)
        parts: list[Any] = bodies if kind == "body" else interfaces
        parts[int(k) - 1] = parts[int(k) - 1].with_scaled(own, factor)
        part = object.__new__(type(self))
        part._keep(bodies, interfaces, self._arguments()["offsets"])
        return part

    def replace(self, **changes: Any) -> Self:
        """Build a stack of which the bodies, the interfaces or the offsets are others.

        Parameters
        ----------
        **changes
            `bodies`, `interfaces` and `offsets`, each as a sequence from the top down.

        Returns
        -------
        Stack

        Raises
        ------
        TypeError, UnitsError, ComponentError
            As the constructor.
        """
        given = {"bodies": self.bodies, "interfaces": self.interfaces,
                 "offsets": self._arguments()["offsets"]}  # fmt: skip
        for name in changes:
            if name not in given:
                call = f"{type(self).__name__}.replace()"
                raise unexpected_argument(call, name, given)
        bodies, interfaces, offsets = (changes.get(name, old) for name, old in given.items())
        kept = several(bodies, owner="Stack", name="bodies", of="blocks")
        return type(self)(*kept, interfaces=interfaces, offsets=offsets)

    def _arguments(self) -> dict[str, Any]:
        return {
            "bodies": [one.to_dict() for one in self.bodies],
            "interfaces": [one.to_dict() for one in self.interfaces],
            "offsets": [f"{one!r} m" for one in self.given.offsets],
        }

    def __hash__(self) -> int:
        return hash((type(self), self.bodies, self.interfaces, self.given.offsets))

    def __repr__(self) -> str:
        bodies = ", ".join(map(repr, self.bodies))
        offsets = f", offsets={self._arguments()['offsets']}" if any(self.given.offsets) else ""
        return f"Stack({bodies}, interfaces={list(self.interfaces)!r}{offsets})"

    def _repr_html_(self) -> str:
        return f"<pre>{self!r}</pre>"

    @classmethod
    def from_dict(cls, arguments: Mapping[str, Any]) -> Self:
        """Build the stack that :meth:`to_dict` described, without warnings.

        Parameters
        ----------
        arguments : mapping
            Bodies and interfaces as they describe themselves, and offsets.

        Returns
        -------
        Stack

        Raises
        ------
        SchemaError, ComponentError, UnitsError
            As those of its parts, and as the constructor.
        """
        described = cls._described(arguments)
        part = object.__new__(cls)
        bodies, interfaces = (
            [
                component_from_dict(one)
                for one in several(
                    described.get(name, ()), owner="Stack.from_dict", name=name, of="descriptions"
                )
            ]
            for name in ("bodies", "interfaces")
        )
        part._keep(bodies, interfaces, described.get("offsets"))
        return part


def _refuse_overhang(bodies: Sequence[BlockSI], offsets: Sequence[float]) -> None:
    """Refuse a base that is not on the top of the body below."""
    for i, (offset, upper, lower) in enumerate(zip(offsets, bodies, bodies[1:], strict=False)):
        reach = abs(offset) + upper.half_width
        if reach > lower.half_width * (1.0 + 1e-12) or not math.isfinite(reach):
            msg = (
                f"Stack: the base of body {i + 1} from the top reaches {reach:.6g} m from the "
                f"middle of the body below, whose top ends at {lower.half_width:.6g} m"
            )
            raise ComponentError(msg)
