"""A stack of bodies, one on top of another."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Self

from rockframe.arguments import checked_list
from rockframe.components.base import Component
from rockframe.components.block import Block
from rockframe.components.block_numbers import BlockSI
from rockframe.components.parameters import SIValues
from rockframe.components.registry import component_from_dict
from rockframe.errors import ComponentError, raise_faults, short_repr, unexpected_argument
from rockframe.units import (
    LENGTH,
    Quantity,
    QuantityLike,
    quantity,
    quantity_text,
    to_ratio,
    to_si,
)

MAX_BODIES: Final = 15
"""Most bodies in a stack: the combined contact states of more exceed the range of integers."""
_OFFSET: Final = "offset"


@dataclass(frozen=True)
class StackSI:
    """A stack in SI units, from the top down."""

    bodies: tuple[BlockSI, ...]  # the bodies
    # distance of the middle of each base to the right of that of the body below; zero for the
    # lowest body [m]
    offsets: tuple[float, ...]


class Stack(Component[StackSI]):
    """A stack of blocks, each with its own base on the top of the block below.

    Parameters
    ----------
    *bodies : Block
        At least two bodies, from the top down, such as statue and plinth or drums of a column.
    interfaces : Component or sequence of Component
        The bases between the bodies, from the top down, one fewer than the bodies: each is a
        :class:`TwoSpringSupport`, a :class:`WinklerSoil` or a :class:`RigidGround`; or one base
        for all of them. The base of the lowest body is a part of the system. Frequency ratio and
        damping ratio of a base refer to all bodies above it as one body.
    offsets : sequence of str or pint.Quantity, optional
        Horizontal distance from the middle of the base of the body below to that of each body but
        the lowest, positive to the right [m]; zero unless given.

    Raises
    ------
    ComponentError
        There are too few or too many bodies; the number of interfaces is not one less; or a base
        reaches beyond the top of the body below.
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

    noun: ClassVar[str] = "stack"

    def __init__(
        self,
        *bodies: Block,
        interfaces: Component | Sequence[Component],
        offsets: Sequence[QuantityLike] | None = None,
    ) -> None:
        self._set_parts(bodies, interfaces, offsets)
        self._warn()

    def _set_parts(self, bodies: Sequence[Any], interfaces: object, offsets: object) -> None:
        """Check the arguments and store them."""
        if isinstance(interfaces, Component):
            interfaces = [interfaces] * max(len(bodies) - 1, 0)
        interfaces = checked_list(interfaces, owner="Stack", name="interfaces", of="bases")
        distances = None if offsets is None else [
            to_si(offset, LENGTH, owner="Stack", name=f"offsets[{i}]") for i, offset in
            enumerate(checked_list(offsets, owner="Stack", name="offsets", of="lengths"))
        ]  # fmt: skip
        faults = [
            f"a body of a stack is a Block, got {short_repr(body)}"
            for body in bodies
            if not isinstance(body, Block)
        ]
        faults += [
            f"an interface is a base such as TwoSpringSupport, got {short_repr(interface)}"
            for interface in interfaces
            if not isinstance(interface, Component) or isinstance(interface, Block)
        ]
        if not 2 <= len(bodies) <= MAX_BODIES:
            faults.append(f"it has 2 to {MAX_BODIES} bodies, got {len(bodies)}")
        if len(interfaces) != len(bodies) - 1:
            faults.append(
                f"{len(bodies)} bodies have {max(len(bodies) - 1, 0)} interfaces between them, got "
                f"{len(interfaces)}; the base of the lowest body is a part of the system"
            )
        if distances is not None and len(distances) != len(bodies) - 1:
            faults.append(
                f"offsets needs {max(len(bodies) - 1, 0)} values, one for each body but the "
                f"lowest, got {len(distances)}"
            )
        raise_faults("Stack", faults)
        distances = [0.0] * (len(bodies) - 1) if distances is None else distances
        sizes = tuple(body.si for body in bodies)
        _check_overhang(sizes, distances)
        values = SIValues(
            bodies=tuple(bodies), interfaces=tuple(interfaces), offsets=tuple(distances)
        )
        object.__setattr__(self, "given", values)
        object.__setattr__(self, "si", StackSI(sizes, (*distances, 0.0)))

    @property
    def bodies(self) -> tuple[Block, ...]:
        """The bodies, from the top down."""
        bodies: tuple[Block, ...] = self.given.bodies
        return bodies

    @property
    def interfaces(self) -> tuple[Component, ...]:
        """The bases between the bodies, from the top down."""
        interfaces: tuple[Component, ...] = self.given.interfaces
        return interfaces

    @property
    def offsets(self) -> tuple[Quantity, ...]:
        """Distance of each base but the lowest to the right of that of the body below [m]."""
        return tuple(quantity(offset, LENGTH) for offset in self.given.offsets)

    def cautions(self) -> list[str]:
        """Return the warnings about unusual values of bodies and interfaces.

        Returns
        -------
        list of str
        """
        return [text for part in (*self.bodies, *self.interfaces) for text in part.cautions()]

    def parameters(self) -> tuple[str, ...]:
        """Name the numbers of bodies and interfaces, and the offsets, other than zero.

        Returns
        -------
        tuple of str
            For example "height of body 1", "stiffness of interface 1" and "offset of body 1", from
            the top down.
        """
        names = [
            f"{name} of {kind} {k}"
            for kind, parts in (("body", self.bodies), ("interface", self.interfaces))
            for k, part in enumerate(parts, 1)
            for name in part.parameters()
        ]
        offsets = (f"{_OFFSET} of body {k}" for k, one in enumerate(self.given.offsets, 1) if one)
        return (*names, *offsets)

    def with_scaled(self, name: str, factor: float) -> Self:
        """Build a stack with one number of a body or an interface, or an offset, multiplied.

        Parameters
        ----------
        name : str
            One of :meth:`parameters`.
        factor : float
            Ratio of the new value to the old one [1].

        Returns
        -------
        Stack

        Raises
        ------
        ComponentError
            No such parameter, its new value is out of range, or a base would reach beyond the
            body below.
        """
        self._check_name(name, self.parameters())
        own, _, place = name.partition(" of ")
        kind, _, k = place.partition(" ")
        bodies, interfaces = list(self.bodies), list(self.interfaces)
        offsets = list(self.offsets)
        if own == _OFFSET:
            offsets[int(k) - 1] *= to_ratio(factor, owner="Stack", name="factor", example="1.1")
        else:
            parts: list[Any] = bodies if kind == "body" else interfaces
            parts[int(k) - 1] = parts[int(k) - 1].with_scaled(own, factor)
        part = object.__new__(type(self))
        part._set_parts(bodies, interfaces, offsets)
        return part

    def replace(self, **changes: Any) -> Self:
        """Build a stack with other bodies, interfaces or offsets.

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
        values = {"bodies": self.bodies, "interfaces": self.interfaces,
                 "offsets": self._arguments()["offsets"]}  # fmt: skip
        for name in changes:
            if name not in values:
                call = f"{type(self).__name__}.replace()"
                raise unexpected_argument(call, name, values)
        bodies, interfaces, offsets = (changes.get(name, old) for name, old in values.items())
        checked = checked_list(bodies, owner="Stack", name="bodies", of="blocks")
        return type(self)(*checked, interfaces=interfaces, offsets=offsets)

    def _arguments(self) -> dict[str, Any]:
        return {
            "bodies": [body.to_dict() for body in self.bodies],
            "interfaces": [interface.to_dict() for interface in self.interfaces],
            "offsets": [quantity_text(offset, LENGTH) for offset in self.given.offsets],
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
        """Build the stack from the result of :meth:`to_dict`, without warnings.

        Parameters
        ----------
        arguments : mapping
            Descriptions of bodies and interfaces, and offsets.

        Returns
        -------
        Stack

        Raises
        ------
        SchemaError, ComponentError, UnitsError
            As for its parts, and as the constructor.
        """
        described = cls._arguments_from(arguments)
        part = object.__new__(cls)
        bodies, interfaces = (
            [
                component_from_dict(description)
                for description in checked_list(
                    described.get(name, ()), owner="Stack.from_dict", name=name, of="descriptions"
                )
            ]
            for name in ("bodies", "interfaces")
        )
        part._set_parts(bodies, interfaces, described.get("offsets"))
        return part


def _check_overhang(bodies: Sequence[BlockSI], offsets: Sequence[float]) -> None:
    """Refuse a base that reaches beyond the top of the body below."""
    for i, (offset, upper, lower) in enumerate(zip(offsets, bodies, bodies[1:], strict=False)):
        reach = abs(offset) + upper.half_width
        if reach > lower.half_width * (1.0 + 1e-12) or not math.isfinite(reach):
            msg = (
                f"Stack: the base of body {i + 1} from the top reaches {reach:.6g} m from the "
                f"middle of the body below, whose top ends at {lower.half_width:.6g} m"
            )
            raise ComponentError(msg)
