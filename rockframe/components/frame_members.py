"""A member of a building, over which Eqs. (22) and (23) sum, and the table of members."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Self

import xarray as xr

from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.parameters import DERIVED, Derived, Parameter, SIValues, Text
from rockframe.components.shapes.standing import PlaneMass
from rockframe.constants import CONVENTIONS
from rockframe.errors import ComponentError
from rockframe.notebook import rectangle
from rockframe.units import (
    DENSITY,
    INERTIA,
    LENGTH,
    MASS,
    NOT_NEGATIVE,
    POSITIVE,
    Unit,
)
from rockframe.version import __version__


@dataclass(frozen=True)
class MemberSI(PlaneMass):
    """A member in SI units; its size is None if only its inertia is known."""

    width: float | None
    height: float | None
    depth: float | None

    def distance(self, height: float) -> float:
        """Distance L of the member's centre from O, half way up a building [m]."""
        return math.hypot(self.x, self.y - 0.5 * height)


class Member(Component[MemberSI]):
    """A column, beam, slab or wall of a building, seen in the plane of rocking.

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
    alternatives: ClassVar[tuple[OneOf, ...]] = (
        OneOf("mass", "density"),
        OneOf(("width", "height", "depth"), "inertia"),
    )

    name: Text = Text(doc="Name in :meth:`FrameEquivalent.members_table`.")
    kind: Text[None] = Text(
        doc='Kind, such as ``"column"``, by which members can be grouped.', default=None
    )
    mass: Parameter[Derived] = Parameter(MASS, POSITIVE, doc="Mass m_i.", default=DERIVED)
    density: Parameter[None] = Parameter(
        DENSITY,
        POSITIVE,
        doc="Mass per volume, instead of `mass`; needs all three sizes.",
        default=None,
    )
    x: Parameter = Parameter(
        LENGTH,
        doc="Horizontal position of its centre of mass, from the middle of the building's base, "
        "to the right.",
    )
    y: Parameter = Parameter(LENGTH, doc="Height of its centre of mass above the base.")
    width: Parameter[None] = Parameter(
        LENGTH,
        POSITIVE,
        doc="Horizontal size of a rectangular member in the plane of rocking.",
        default=None,
    )
    height: Parameter[None] = Parameter(
        LENGTH, POSITIVE, doc="Vertical size of a rectangular member.", default=None
    )
    depth: Parameter[None] = Parameter(
        LENGTH,
        POSITIVE,
        doc="Size of a rectangular member perpendicular to the plane of rocking. Only its volume "
        "depends on it.",
        default=None,
    )
    inertia: Parameter[Derived] = Parameter(
        INERTIA,
        NOT_NEGATIVE,
        doc="Moment of inertia I_i about its own centre of mass, about the axis perpendicular to "
        "the plane of rocking; instead of `width` and `height`, for a member that is no upright "
        "rectangle.",
        default=DERIVED,
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
        """Make a rectangular member from numbers in SI units, without conversion.

        Parameters
        ----------
        name, kind : str
            Name and kind.
        density : float
            Mass per volume [kg m^-3].
        centre : tuple of float
            Coordinates x and y [m].
        size : tuple of float
            Width, height and depth, all positive [m].

        Returns
        -------
        Member

        Examples
        --------
        >>> import rockframe as rf
        >>> rf.Member.box("C1", "column", 2500.0, (0.0, 2.0), (0.4, 4.0, 0.4)).name
        'C1'
        """
        member = object.__new__(cls)
        (x, y), (width, height, depth) = centre, size
        values = {"name": name, "kind": kind, "density": density, "x": x, "y": y}
        values |= {"width": width, "height": height, "depth": depth, "mass": None, "inertia": None}
        member._set_values(values)
        return member

    @classmethod
    def _owner(cls, values: Mapping[str, object]) -> str:
        name = values["name"]
        return f"Member {name!r}" if isinstance(name, str) and name.strip() else "Member"

    def _check(self, values: Mapping[str, object], owner: str) -> None:
        words = ("mass", "density", "width", "height", "depth", "inertia")
        present = {word for word in words if values[word] is not None}
        rules = (
            (
                ("mass" in present) is not ("density" in present),
                "give mass or density, exactly one",
            ),
            (
                "density" not in present or {"width", "height", "depth"} <= present,
                "density needs width, height and depth",
            ),
            (
                present & {"width", "height", "inertia"} in ({"width", "height"}, {"inertia"}),
                "give width and height, or inertia (0 kg*m^2 for a point mass)",
            ),
            (
                not {"depth", "inertia"} <= present,
                "depth goes with width and height, not with inertia",
            ),
        )
        for holds, rule in rules:
            if not holds:
                found = ", ".join(sorted(present)) or "none of them"
                msg = f"{owner}: {rule}; got {found}"
                raise ComponentError(msg)

    def _numbers(self, numbers: SIValues) -> MemberSI:
        sizes = numbers.width, numbers.height, numbers.depth
        width, height, depth = (size or 0.0 for size in sizes)
        mass, inertia = numbers.mass, numbers.inertia
        if mass is None:
            mass = numbers.density * width * height * depth
        if inertia is None:
            inertia = mass * (width * width + height * height) / 12.0
        if not (0.0 < mass < math.inf and inertia < math.inf):
            msg = (
                f"Member {numbers.name!r}: a mass of {mass:.4g} {MASS.unit} and a moment of "
                f"inertia of {inertia:.4g} {INERTIA.unit} are out of the range of floating-point "
                "numbers"
            )
            raise ComponentError(msg)
        return MemberSI(mass, numbers.x, numbers.y, inertia, *sizes)


def member_outlines(members: Iterable[Member]) -> list[list[tuple[float, float]]]:
    """Return the corners of the members whose sizes are known [m]."""
    return [
        rectangle(0.5 * numbers.width, numbers.height, numbers.x, numbers.y - 0.5 * numbers.height)
        for numbers in (member.si for member in members)
        if numbers.width is not None and numbers.height is not None
    ]


_COLUMNS: Final = {
    "mass": (Unit.KILOGRAM, "mass"),
    "volume": (Unit.CUBIC_METRE, "volume"),
    "x": (Unit.METRE, "horizontal position of the centre, from the middle of the base"),
    "y": (Unit.METRE, "height of the centre above the base"),
    "width": (Unit.METRE, "horizontal size in the plane of rocking"),
    "height": (Unit.METRE, "vertical size"),
    "depth": (Unit.METRE, "size perpendicular to the plane of rocking"),
    "inertia": (Unit.KILOGRAM_METRE_SQUARED, "moment of inertia about the member's own centre"),
    "distance": (Unit.METRE, "distance of the centre from O, the middle of the building"),
    "inertia_about_middle": (
        Unit.KILOGRAM_METRE_SQUARED,
        "moment of inertia about O, the middle of the building",
    ),
}


def make_members_table(
    members: Sequence[Member], height: float, attributes: dict[str, float | None]
) -> xr.Dataset:
    """Return a table of the members of a building of some height [m], with sums as attributes."""
    variables: dict[str, Any] = {}
    rows = [_row(member.si, height) for member in members]
    for name, (unit, words) in _COLUMNS.items():
        column = [math.nan if row[name] is None else row[name] for row in rows]
        variables[name] = ("member", column, {"long_name": words, "units": str(unit)})
    labels = {
        "member": ("member", [member.name for member in members], {"long_name": "name"}),
        "kind": ("member", [member.kind or "" for member in members], {"long_name": "kind"}),
    }
    known = {name: value for name, value in attributes.items() if value is not None}
    return xr.Dataset(
        variables,
        coords=labels,
        attrs={
            "Conventions": CONVENTIONS,
            "title": "Members of a building and their part in its inertia",
            # without the time: equal frames have equal tables
            "history": f"computed by rockframe {__version__}",
            "source": f"rockframe {__version__}, geometry of the members",
            "comment": "Numbers in these attributes are in SI units.",
            **known,
        },
    )


def _row(si: MemberSI, height: float) -> dict[str, float | None]:
    distance = si.distance(height)
    about_middle = si.inertia + si.mass * distance**2
    volume = None
    if si.width is not None and si.height is not None and si.depth is not None:
        volume = si.width * si.height * si.depth
    own = {"volume": volume, "distance": distance, "inertia_about_middle": about_middle}
    return {**vars(si), **own}
