"""A member of a building: what Eqs. (22) and (23) sum over."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import pint

from rockframe.components.base import Component, SIProperty, with_unit
from rockframe.errors import ComponentError, shown
from rockframe.units import (
    DENSITY,
    INERTIA,
    LENGTH,
    MASS,
    NOT_NEGATIVE,
    POSITIVE,
    Measure,
    QuantityLike,
    quantity,
    to_si,
)


@dataclass(frozen=True)
class MemberSI:
    """A member in SI units; its size is None where only its inertia is known."""

    mass: float
    x: float
    y: float
    inertia: float
    width: float | None
    height: float | None
    depth: float | None

    @property
    def volume(self) -> float | None:
        """Volume, or None where a size is unknown [m^3]."""
        if self.width is None or self.height is None or self.depth is None:
            return None
        return self.width * self.height * self.depth

    def distance(self, height: float) -> float:
        """Distance L of the member's centre from O, half way up a building [m]."""
        return math.hypot(self.x, self.y - 0.5 * height)


class Member(Component[MemberSI]):
    """A column, beam, slab, wall, ... of a building, seen in the plane of rocking.

    Parameters
    ----------
    name : str
        What it is called in :meth:`FrameEquivalent.members_table`.
    mass : str or Quantity, optional
        Mass m_i [kg].
    density : str or Quantity, optional
        Mass per volume, instead of `mass`; needs all three sizes [kg m^-3].
    x : str or Quantity
        Horizontal position of its centre of mass, from the middle of the
        building's base, to the right [m].
    y : str or Quantity
        Height of its centre of mass above the base [m].
    width, height : str or Quantity, optional
        Size of a rectangular member in the plane of rocking, horizontal and
        vertical [m].
    inertia : str or Quantity, optional
        Moment of inertia I_i about its own centre of mass, about the axis
        perpendicular to the plane of rocking; instead of `width` and `height`,
        for a member that is no upright rectangle [kg m^2].
    depth : str or Quantity, optional
        Size of a rectangular member perpendicular to the plane of rocking.
        Only its volume depends on it [m].
    kind : str, optional
        Such as ``"column"``; members of one kind can be looked at together.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range; not exactly one of `mass` and `density`, or
        of the size and `inertia`, is given; no name.

    Notes
    -----
    A rectangle has I_i = m_i (width^2 + height^2)/12 about its own centre.
    ``inertia="0 kg*m^2"`` makes a point mass.

    Examples
    --------
    >>> tank = Member(name="tank", mass="4 t", x="1 m", y="17 m", width="2 m", height="1.5 m")
    >>> round(tank.inertia.m_as("kg*m^2"), 1)
    2083.3
    """

    noun: ClassVar[str] = "member"

    mass = SIProperty(MASS, "Mass m_i.")
    x = SIProperty(LENGTH, "Horizontal position of the centre, from the middle of the base.")
    y = SIProperty(LENGTH, "Height of the centre above the base.")
    inertia = SIProperty(INERTIA, "Moment of inertia I_i about the member's own centre.")

    def __init__(
        self,
        *,
        name: str,
        mass: QuantityLike | None = None,
        density: QuantityLike | None = None,
        x: QuantityLike,
        y: QuantityLike,
        width: QuantityLike | None = None,
        height: QuantityLike | None = None,
        inertia: QuantityLike | None = None,
        depth: QuantityLike | None = None,
        kind: str | None = None,
    ) -> None:
        _check_words(name, kind)
        owner = f"Member {name!r}"
        given = {"width": width, "height": height, "depth": depth, "inertia": inertia}
        _check_combination(owner, {"mass": mass, "density": density, **given})
        size = {
            word: None if value is None else to_si(value, LENGTH, owner=owner, name=word,
                                                   condition=POSITIVE)
            for word, value in given.items() if word != "inertia"
        }  # fmt: skip
        place = {
            word: to_si(value, LENGTH, owner=owner, name=word)
            for word, value in (("x", x), ("y", y))
        }
        per_volume = kilograms = turning = None
        if density is not None:
            per_volume = to_si(density, DENSITY, owner=owner, name="density", condition=POSITIVE)
        if mass is not None:
            kilograms = to_si(mass, MASS, owner=owner, name="mass", condition=POSITIVE)
        if inertia is not None:
            turning = to_si(inertia, INERTIA, owner=owner, name="inertia", condition=NOT_NEGATIVE)
        self._fill(name, kind, (kilograms, per_volume, turning), place, size)

    def _fill(
        self,
        name: str,
        kind: str | None,
        heft: tuple[float | None, float | None, float | None],
        place: Mapping[str, float],
        size: Mapping[str, float | None],
    ) -> None:
        mass, density, inertia = heft
        self._freeze(
            _si(f"Member {name!r}", mass, density, inertia, place, size),
            {
                "name": name,
                "kind": kind,
                "mass": with_unit(mass, MASS),
                "density": with_unit(density, DENSITY),
                **{word: with_unit(value, LENGTH) for word, value in {**place, **size}.items()},
                "inertia": with_unit(inertia, INERTIA),
            },
        )

    @classmethod
    def box(
        cls,
        name: str,
        kind: str,
        density: float,
        centre: tuple[float, float],
        size: tuple[float, float, float],
    ) -> Self:
        """Make a rectangular member from SI numbers, without reading them as texts first.

        Parameters
        ----------
        name, kind : str
            What it is.
        density : float
            Mass per volume [kg m^-3].
        centre : tuple of float
            Coordinates x and y [m].
        size : tuple of float
            Width, height and depth, all positive [m].

        Returns
        -------
        Member
        """
        member = object.__new__(cls)
        (x, y), (width, height, depth) = centre, size
        sizes = {"width": width, "height": height, "depth": depth}
        member._fill(name, kind, (None, density, None), {"x": x, "y": y}, sizes)
        return member

    @property
    def name(self) -> str:
        """Name of the member."""
        return str(self._arguments["name"])

    @property
    def kind(self) -> str | None:
        """Kind of member, if one was given."""
        kind = self._arguments.get("kind")
        return None if kind is None else str(kind)

    @property
    def width(self) -> pint.Quantity[Any] | None:
        """Horizontal size in the plane of rocking, if known [m]."""
        return _known(self.si.width, LENGTH)

    @property
    def height(self) -> pint.Quantity[Any] | None:
        """Vertical size, if known [m]."""
        return _known(self.si.height, LENGTH)

    @property
    def depth(self) -> pint.Quantity[Any] | None:
        """Size perpendicular to the plane of rocking, if known [m]."""
        return _known(self.si.depth, LENGTH)


def _known(value: float | None, measure: Measure) -> pint.Quantity[Any] | None:
    return None if value is None else quantity(value, measure)


def _check_words(name: object, kind: object) -> None:
    if not isinstance(name, str) or not name.strip():
        msg = f"Member: name must be a text that is not empty, got {shown(name)}"
        raise ComponentError(msg)
    if kind is not None and (not isinstance(kind, str) or not kind.strip()):
        msg = f"Member {name!r}: kind must be a text that is not empty, or None, got {shown(kind)}"
        raise ComponentError(msg)


def _check_combination(owner: str, values: dict[str, object]) -> None:
    given = {word for word, value in values.items() if value is not None}
    rules = (
        (("mass" in given) is not ("density" in given), "give mass or density, exactly one"),
        (
            "density" not in given or {"width", "height", "depth"} <= given,
            "density needs width, height and depth",
        ),
        (
            given & {"width", "height", "inertia"} in ({"width", "height"}, {"inertia"}),
            "give width and height, or inertia (0 kg*m^2 for a point mass)",
        ),
        (not {"depth", "inertia"} <= given, "depth goes with width and height, not with inertia"),
    )
    for holds, rule in rules:
        if not holds:
            found = ", ".join(sorted(given)) or "none of them"
            msg = f"{owner}: {rule}; {found} given"
            raise ComponentError(msg)


def _si(
    owner: str,
    mass: float | None,
    density: float | None,
    inertia: float | None,
    place: Mapping[str, float],
    size: Mapping[str, float | None],
) -> MemberSI:
    width, height, depth = (size[word] or 0.0 for word in ("width", "height", "depth"))
    if mass is None:
        mass = (density or 0.0) * width * height * depth
    if inertia is None:
        inertia = mass * (width * width + height * height) / 12.0
    if not (0.0 < mass < math.inf and inertia < math.inf):
        msg = (
            f"{owner}: a mass of {mass:.4g} {MASS.unit} and a moment of inertia of {inertia:.4g} "
            f"{INERTIA.unit} are beyond what a computer's numbers can hold"
        )
        raise ComponentError(msg)
    return MemberSI(mass=mass, inertia=inertia, **place, **size)  # type: ignore[arg-type]
