"""A regular frame on four columns, and its members."""

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Final

import numpy as np

from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.frame_members import Member
from rockframe.components.parameters import DERIVED, Declared, Derived, Parameter, SIValues
from rockframe.errors import ComponentError
from rockframe.units import (
    DENSITY,
    LENGTH,
    POSITIVE,
    THICKNESS,
    Condition,
    Measure,
    Quantity,
    QuantityLike,
    RatioLike,
    quantity,
    quantity_text,
    to_ratio,
    to_si,
)

SLAB_THICKNESS: Final = "0.12 m"
"""Slab thickness of the paper's frames (section 4.2)."""
INFILL_THICKNESS: Final = "0.15 m"
"""Thickness of the infill walls of the paper's frames (section 4.2)."""

_NO_INFILL: Final = "none"
# the bound keeps a mistyped number from filling the memory
_COUNT: Final = Condition(
    "a whole number from 1 to 1000",
    lambda number: 1.0 <= number <= 1000.0 and number.is_integer(),
)


@dataclass(frozen=True)
class RegularFrameSI:
    """A regular frame in SI units; `infill_thickness` is zero without walls."""

    width: float
    depth: float
    storey_heights: tuple[float, ...]
    levels: tuple[float, ...]
    column_width: float
    column_depth: float
    beam_height: float
    beam_width: float
    slab_thickness: float
    infill_thickness: float
    density: float

    @property
    def storeys(self) -> int:
        """Number of storeys."""
        return len(self.levels)

    @property
    def height(self) -> float:
        """Level of the top of the highest slab [m]."""
        return self.levels[-1]


class StoreyCount(Declared[int, RatioLike, Derived]):
    """A number of storeys."""

    written_as = "int"
    annotation = RatioLike

    def read(self, value: object, owner: str) -> float:
        """Read the number."""
        return to_ratio(value, owner=owner, name=self.name, condition=self.condition, example="3")


class StoreyHeights(Declared[Quantity, Iterable[QuantityLike], Derived]):
    """Heights of storeys: a sequence, or a text with semicolons between them."""

    single = False
    written_as = "sequence of str or Quantity, or str"
    annotation = Iterable[QuantityLike]

    def read(self, value: object, owner: str) -> tuple[float, ...]:
        """Convert every height to SI units."""
        heights: Any = value.split(";") if isinstance(value, str) else value
        try:
            heights = list(heights)
        except TypeError:  # one value; a scalar Quantity even calls itself iterable
            heights = [value]
        if not heights:
            _refuse("storey_heights is empty; give the height of every storey")
        return tuple(
            to_si(height, LENGTH, owner=owner, name=f"{self.name}[{k}]", condition=POSITIVE)
            for k, height in enumerate(heights)
        )

    def write(self, value: tuple[float, ...]) -> str:
        """Write all heights in one text."""
        return "; ".join(quantity_text(height, LENGTH) for height in value)

    def public(self, value: tuple[float, ...]) -> Quantity:
        """Return all heights in one Quantity."""
        return quantity(np.array(value), LENGTH)


class InfillThickness(Declared[Quantity | None, QuantityLike | None, str]):
    """Thickness of walls; None or ``"none"`` for no walls, which is zero in SI units."""

    written_as = "str, Quantity or None"
    annotation = QuantityLike | None
    measure: Measure

    def read(self, value: object, owner: str) -> float:
        """Convert to SI units."""
        if value is None or (isinstance(value, str) and value == _NO_INFILL):
            return 0.0
        return to_si(value, self.measure, owner=owner, name=self.name, condition=self.condition)

    def write(self, value: float) -> str:
        """Write the thickness, or ``"none"``."""
        return quantity_text(value, self.measure) if value else _NO_INFILL

    def public(self, value: float) -> Quantity | None:
        """Return the thickness, or None."""
        return quantity(value, self.measure) if value else None


class RegularFrame(Component[RegularFrameSI]):
    """A building of equal floors on four corner columns, as in the paper's section 4.2.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or the sizes do not fit one another.

    Notes
    -----
    Four columns stand in the corners and are as high as the building. Every storey has a slab over
    the whole plan, except where the columns pass, with its top at the level of the storey. Below
    the slab four edge beams run between the columns, flush with the outer faces; their height
    below it is the beam height less the slab thickness. Every storey has two infill walls in the
    outer planes parallel to the plane of rocking, between the columns, from the slab below to the
    beam above. The volumes add up to :eq:`eq-frame-volume`, which gives the space proportions in
    Table 1 of the paper.

    Examples
    --------
    >>> frame = RegularFrame(
    ...     storeys=3,
    ...     height="9 m",
    ...     width="4 m",
    ...     column_width="0.25 m",
    ...     beam_height="0.30 m",
    ...     beam_width="0.25 m",
    ...     density="2500 kg/m^3",
    ... )
    >>> [member.name for member in frame.members][:2]
    ['column left front', 'column left back']
    """

    noun: ClassVar[str] = "frame"
    alternatives: ClassVar[tuple[OneOf, ...]] = (OneOf(("storeys", "height"), "storey_heights"),)

    storeys: StoreyCount = StoreyCount(
        None, _COUNT, doc="Number of storeys, all equally high.", default=DERIVED
    )
    height: Parameter[Derived] = Parameter(
        LENGTH, POSITIVE, doc="Height H of the building, with `storeys`.", default=DERIVED
    )
    storey_heights: StoreyHeights = StoreyHeights(
        LENGTH,
        POSITIVE,
        doc="Height of every storey from the lowest up, instead of `storeys` and `height`; one "
        "text holds them separated by semicolons.",
        default=DERIVED,
    )
    width: Parameter = Parameter(
        LENGTH, POSITIVE, doc="Plan B_x in the plane of rocking, over the columns' outer faces."
    )
    depth: Parameter[Derived] = Parameter(
        LENGTH,
        POSITIVE,
        doc="Plan B_y perpendicular to it; `width` unless given, as in the paper.",
        default=DERIVED,
    )
    column_width: Parameter = Parameter(
        THICKNESS, POSITIVE, doc="Width of a column in the plane of rocking."
    )
    column_depth: Parameter[Derived] = Parameter(
        THICKNESS,
        POSITIVE,
        doc="Perpendicular to it; `column_width`, a square column, unless given.",
        default=DERIVED,
    )
    beam_height: Parameter = Parameter(
        THICKNESS, POSITIVE, doc="Height of the edge beams, which includes the slab."
    )
    beam_width: Parameter = Parameter(THICKNESS, POSITIVE, doc="Width of the edge beams.")
    slab_thickness: Parameter[str] = Parameter(
        THICKNESS, POSITIVE, doc="Thickness of the slabs.", default=SLAB_THICKNESS
    )
    infill_thickness: InfillThickness = InfillThickness(
        THICKNESS,
        Condition("greater than zero, or None for no walls", POSITIVE.holds),
        doc='Thickness of the infill walls; None (or ``"none"``) for no walls.',
        default=INFILL_THICKNESS,
    )
    density: Parameter = Parameter(DENSITY, POSITIVE, doc="Mass per volume of all members.")

    def _check(self, values: Mapping[str, object], owner: str) -> None:
        of_all = [values[name] is not None for name in ("storeys", "height")]
        one_by_one = values["storey_heights"] is not None
        if not one_by_one and not all(of_all):
            _refuse("give storeys and height, or storey_heights")
        if one_by_one and any(of_all):
            _refuse("storey_heights determines storeys and height; do not give these with it")

    def _set_values(self, values: Mapping[str, object]) -> None:
        square = {
            "depth": values["depth"] or values["width"],
            "column_depth": values["column_depth"] or values["column_width"],
        }
        super()._set_values({**values, **square})

    def _numbers(self, numbers: SIValues) -> RegularFrameSI:
        values = dict(vars(numbers))
        count, total, heights = (values.pop(n) for n in ("storeys", "height", "storey_heights"))
        if heights is None:
            levels = tuple(total * (k / count) for k in range(1, int(count) + 1))
            heights = (total / count,) * int(count)
        else:
            levels = tuple(itertools.accumulate(heights))
        si = RegularFrameSI(storey_heights=heights, levels=levels, **values)
        _check_fit(si)
        return si

    @property
    def members(self) -> tuple[Member, ...]:
        """All members: the columns, then slab, beams and walls of each storey from below."""
        return tuple(_members(self.si))


def _check_fit(si: RegularFrameSI) -> None:
    section = min(si.column_width, si.column_depth)
    rules = (
        # (holds, name, range of its value)
        (2.0 * si.column_width < si.width, "column_width", "less than half the width"),
        (2.0 * si.column_depth < si.depth, "column_depth", "less than half the depth"),
        (si.beam_height >= si.slab_thickness, "beam_height",
         f"slab_thickness ({si.slab_thickness:.6g} m) or more, for it includes the slab"),
        (si.beam_height < min(si.storey_heights), "beam_height",
         f"less than the lowest storey's height ({min(si.storey_heights):.6g} m)"),
        (si.beam_width <= section, "beam_width",
         f"the column's width and depth ({section:.6g} m) or less"),
        (2.0 * si.infill_thickness <= si.depth, "infill_thickness",
         "half the depth or less, for there are two walls"),
    )  # fmt: skip
    plan = f"the plan is {si.width:.6g} m by {si.depth:.6g} m"
    for holds, name, words in rules:
        if not holds:
            _refuse(f"{name} must be {words}, got {getattr(si, name):.6g} m; {plan}")
    if not math.isfinite(si.height):
        _refuse(f"the height of all storeys together must be finite, got {si.height}")


def _refuse(words: str) -> None:
    msg = f"RegularFrame: {words}"
    raise ComponentError(msg)


def _members(si: RegularFrameSI) -> Iterator[Member]:
    sides = (("left", -1.0), ("right", 1.0))
    faces = ("front", "back")

    def member(
        name: str, kind: str, x: float, y: float, size: tuple[float, float, float]
    ) -> Member:
        return Member.box(name, kind, si.density, (x, y), size)

    # distances between the columns, in the plane of rocking and perpendicular to it
    clear_width, clear_depth = si.width - 2.0 * si.column_width, si.depth - 2.0 * si.column_depth
    at_column = 0.5 * (si.width - si.column_width)
    at_beam = 0.5 * (si.width - si.beam_width)
    for side, sign in sides:
        for face in faces:
            size = (si.column_width, si.height, si.column_depth)
            x, y = sign * at_column, 0.5 * si.height
            yield member(f"column {side} {face}", "column", x, y, size)

    drop = si.beam_height - si.slab_thickness
    for number, (level, storey) in enumerate(zip(si.levels, si.storey_heights, strict=True), 1):
        y = level - 0.5 * si.slab_thickness
        size = (clear_width, si.slab_thickness, si.depth)
        yield member(f"slab {number} middle", "slab", 0.0, y, size)
        for side, sign in sides:  # the strips between the columns of one side
            size = (si.column_width, si.slab_thickness, clear_depth)
            yield member(f"slab {number} {side}", "slab", sign * at_column, y, size)
        if drop > 0.0:
            y = level - si.slab_thickness - 0.5 * drop
            for face in faces:
                size = (clear_width, drop, si.beam_width)
                yield member(f"beam {number} {face}", "beam", 0.0, y, size)
            for side, sign in sides:
                size = (si.beam_width, drop, clear_depth)
                yield member(f"beam {number} {side}", "beam", sign * at_beam, y, size)
        if si.infill_thickness > 0.0:
            clear = storey - si.beam_height
            y = level - si.beam_height - 0.5 * clear
            for face in faces:
                size = (clear_width, clear, si.infill_thickness)
                yield member(f"wall {number} {face}", "wall", 0.0, y, size)
