"""A regular frame on four columns, taken apart into its members."""

import itertools
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import ClassVar, Final

from rockframe.components.base import Component, SIProperty, with_unit
from rockframe.components.frame_members import Member
from rockframe.errors import ComponentError
from rockframe.units import (
    DENSITY,
    LENGTH,
    POSITIVE,
    THICKNESS,
    Condition,
    QuantityLike,
    RatioLike,
    to_ratio,
    to_si,
)

SLAB_THICKNESS: Final = "0.12 m"
"""Slab thickness of the paper's frames (section 4.2)."""
INFILL_THICKNESS: Final = "0.15 m"
"""Thickness of the infill walls of the paper's frames (section 4.2)."""

_THIN: Final = (
    "column_width",
    "column_depth",
    "beam_height",
    "beam_width",
    "slab_thickness",
    "infill_thickness",
)
_NO_INFILL: Final = "none"
_OR_NONE: Final = Condition("greater than zero, or None for no walls", POSITIVE.holds)
# the bound keeps a slip of the pen from filling the memory
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
    def height(self) -> float:
        """Level of the topmost slab's top [m]."""
        return self.levels[-1]

    @property
    def clear_width(self) -> float:
        """Distance between the columns in the plane of rocking [m]."""
        return self.width - 2.0 * self.column_width

    @property
    def clear_depth(self) -> float:
        """Distance between the columns perpendicular to the plane of rocking [m]."""
        return self.depth - 2.0 * self.column_depth


class RegularFrame(Component[RegularFrameSI]):
    """A building of equal floors on four corner columns, as in the paper's section 4.2.

    Parameters
    ----------
    storeys : int
        Number of storeys, all equally high.
    height : str or Quantity
        Height H of the building, with `storeys` [m].
    storey_heights : sequence of str or Quantity, or str
        Height of every storey from the lowest up, instead of `storeys` and
        `height`; one text holds them separated by semicolons [m].
    width : str or Quantity
        Plan B_x in the plane of rocking, over the columns' outer faces [m].
    depth : str or Quantity, optional
        Plan B_y perpendicular to it; `width` unless given, as in the paper [m].
    column_width : str or Quantity
        Width of a column in the plane of rocking [m].
    column_depth : str or Quantity, optional
        Perpendicular to it; `column_width`, a square column, unless given [m].
    beam_height, beam_width : str or Quantity
        Section of the edge beams. The height includes the slab [m].
    slab_thickness : str or Quantity
        Thickness of the slabs [m].
    infill_thickness : str, Quantity or None
        Thickness of the infill walls; None (or ``"none"``) for no walls [m].
    density : str or Quantity
        Mass per volume of all members [kg m^-3].

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or the sizes do not fit one another.

    Notes
    -----
    Four columns stand in the corners and are as high as the building. Every
    storey ends in a slab over the whole plan, cut out where the columns pass,
    with its top at the storey's level. Four edge beams, flush with the outer
    faces, run between the columns below it, deep by beam height less slab
    thickness. Two infill walls stand in every storey in the outer planes
    parallel to rocking, clear between columns, from the slab below to the beam
    above. The volumes add up to :eq:`eq-frame-volume`, which gives the printed
    space proportions of the paper's Table 1.

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

    width = SIProperty(LENGTH, "Plan B_x in the plane of rocking.")
    depth = SIProperty(LENGTH, "Plan B_y perpendicular to the plane of rocking.")
    height = SIProperty(LENGTH, "Height H.")
    density = SIProperty(DENSITY, "Mass per volume.")

    def __init__(
        self,
        *,
        width: QuantityLike,
        column_width: QuantityLike,
        beam_height: QuantityLike,
        beam_width: QuantityLike,
        density: QuantityLike,
        storeys: RatioLike | None = None,
        height: QuantityLike | None = None,
        storey_heights: Iterable[QuantityLike] | None = None,
        depth: QuantityLike | None = None,
        column_depth: QuantityLike | None = None,
        slab_thickness: QuantityLike = SLAB_THICKNESS,
        infill_thickness: QuantityLike | None = INFILL_THICKNESS,
    ) -> None:
        lengths = {
            name: _length(name, value)
            for name, value in (
                ("width", width),
                ("depth", width if depth is None else depth),
                ("column_width", column_width),
                ("column_depth", column_width if column_depth is None else column_depth),
                ("beam_height", beam_height),
                ("beam_width", beam_width),
                ("slab_thickness", slab_thickness),
            )
        }
        per_volume = to_si(
            density, DENSITY, owner="RegularFrame", name="density", condition=POSITIVE
        )
        infill = 0.0
        if infill_thickness is not None and infill_thickness != _NO_INFILL:
            infill = _length("infill_thickness", infill_thickness, _OR_NONE)
        count, heights, levels = _storeys(storeys, height, storey_heights)
        si = RegularFrameSI(
            storey_heights=heights,
            levels=levels,
            infill_thickness=infill,
            density=per_volume,
            **lengths,
        )
        _check_fit(si)
        texts = [f"{value!r} {LENGTH.unit}" for value in heights]
        self._freeze(
            si,
            {
                "storeys": count,
                "height": None if count is None else with_unit(si.height, LENGTH),
                "storey_heights": "; ".join(texts) if count is None else None,
                **{name: with_unit(value, LENGTH) for name, value in lengths.items()},
                "infill_thickness": with_unit(infill, LENGTH) if infill else _NO_INFILL,
                "density": with_unit(per_volume, DENSITY),
            },
        )

    @property
    def storeys(self) -> int:
        """Number of storeys."""
        return len(self.si.levels)

    @property
    def members(self) -> tuple[Member, ...]:
        """All members: the columns, then slab, beams and walls of each storey upwards."""
        return tuple(_members(self.si))


def _length(name: str, value: object, condition: Condition = POSITIVE) -> float:
    measure = THICKNESS if name in _THIN else LENGTH
    return to_si(value, measure, owner="RegularFrame", name=name, condition=condition)


def _storeys(
    storeys: object, height: object, storey_heights: object
) -> tuple[float | None, tuple[float, ...], tuple[float, ...]]:
    """Give the count (None for unequal storeys), the storeys' heights and their levels."""
    if storey_heights is None:
        if storeys is None or height is None:
            _refuse("give storeys and height, or storey_heights")
        count = to_ratio(
            storeys, owner="RegularFrame", name="storeys", condition=_COUNT, example="3"
        )
        total = _length("height", height)
        levels = tuple(total * (k / count) for k in range(1, int(count) + 1))
        return count, (total / count,) * int(count), levels
    if storeys is not None or height is not None:
        _refuse("storey_heights tells the storeys and the height; give them without it")
    if isinstance(storey_heights, str):
        storey_heights = storey_heights.split(";")
    try:
        given = list(storey_heights)  # type: ignore[call-overload]
    except TypeError:  # one value; a scalar Quantity even calls itself iterable
        given = [storey_heights]
    heights = tuple(_length(f"storey_heights[{k}]", each) for k, each in enumerate(given))
    if not heights:
        _refuse("storey_heights is empty; give the height of every storey")
    return None, heights, tuple(itertools.accumulate(heights))


def _check_fit(si: RegularFrameSI) -> None:
    section = min(si.column_width, si.column_depth)
    rules = (
        # (holds, what must lie below what)
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
        size = (si.clear_width, si.slab_thickness, si.depth)
        yield member(f"slab {number} middle", "slab", 0.0, y, size)
        for side, sign in sides:  # the strips between the columns of one side
            size = (si.column_width, si.slab_thickness, si.clear_depth)
            yield member(f"slab {number} {side}", "slab", sign * at_column, y, size)
        if drop > 0.0:
            y = level - si.slab_thickness - 0.5 * drop
            for face in faces:
                size = (si.clear_width, drop, si.beam_width)
                yield member(f"beam {number} {face}", "beam", 0.0, y, size)
            for side, sign in sides:
                size = (si.beam_width, drop, si.clear_depth)
                yield member(f"beam {number} {side}", "beam", sign * at_beam, y, size)
        if si.infill_thickness > 0.0:
            clear = storey - si.beam_height
            y = level - si.beam_height - 0.5 * clear
            for face in faces:
                size = (si.clear_width, clear, si.infill_thickness)
                yield member(f"wall {number} {face}", "wall", 0.0, y, size)
