"""Columns that rock together under a beam."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Self

from rockframe.components.base import Component
from rockframe.components.block import Block
from rockframe.components.block_numbers import BlockSI
from rockframe.components.parameters import Count, Declared, Missing, Parameter, SIValues
from rockframe.components.registry import component_from_dict
from rockframe.errors import ComponentError, short_repr
from rockframe.notebook import Polygon, rectangle
from rockframe.units import LENGTH, MASS, NOT_NEGATIVE, POSITIVE, QuantityLike

MIN_COLUMNS: Final = 2
"""Fewest columns that keep a beam level."""
SPACING_RATIO: Final = 1.0
"""Default distance of the columns in drawings, over their height [1]."""
BEAM_HEIGHT_RATIO: Final = 0.2
"""Default height of the beam in drawings, over that of the columns [1]."""
_COLUMN_SUFFIX: Final = " of column"


class _BlockParameter(Declared[Block, Block, Missing]):
    """A parameter that is a block."""

    single = False
    written_as = "Block"
    annotation = Block

    def read(self, value: object, owner: str) -> Block:
        """Read a block, or the mapping that describes it."""
        if isinstance(value, Mapping):
            value = component_from_dict({"type": Block.__name__, **value})
        if not isinstance(value, Block):
            msg = f"{owner}: {self.name} must be a Block, got {short_repr(value)}"
            raise ComponentError(msg)
        if value.si.eccentricity != 0.0:
            msg = (
                f"{owner}: the centre of mass of the {self.name} must be above the middle of its "
                f"base, got an eccentricity of {value.si.eccentricity:.6g} m"
            )
            raise ComponentError(msg)
        return value

    def write(self, value: Block) -> Any:
        """Describe the block."""
        return value.to_dict()


@dataclass(frozen=True)
class RockingFrameSI:
    """Columns under a beam in SI units."""

    column: BlockSI  # one column
    columns: int  # number of columns
    beam_mass: float  # mass of the beam [kg]
    spacing: float  # distance between column axes in drawings [m]
    beam_height: float  # height of the beam in drawings [m]


class RockingFrame(Component[RockingFrameSI]):
    """Equal columns that rock together under a rigid beam, like those of a bridge bent.

    The columns stand free on the ground, and the beam lies free on the columns. All columns rotate
    by the same angle, each about a lower corner. The beam rests on their upper corners and stays
    level, :eq:`eq-rocking-frame`.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        The column is not a :class:`Block` with its centre of mass above the middle of its base,
        or there are fewer than two columns.

    Examples
    --------
    >>> import rockframe as rf
    >>> pier = rf.Block(width="1.6 m", height="9.6 m", mass="60 t")
    >>> bent = rf.RockingFrame(pier, columns=3, beam_mass="200 t")
    >>> print(bent.beam_mass.to("t"))
    200.0 metric_ton
    """

    noun: ClassVar[str] = "frame"

    column: _BlockParameter = _BlockParameter(doc="One of the equal columns.")
    columns: Count = Count(doc="Number of columns, at least 2.")
    beam_mass: Parameter = Parameter(MASS, NOT_NEGATIVE, doc="Mass of the beam and of its load.")
    spacing: Parameter[None] = Parameter(
        LENGTH,
        POSITIVE,
        doc="Distance between the axes of columns, for drawings only; their height unless given.",
        default=None,
    )
    beam_height: Parameter[None] = Parameter(
        LENGTH,
        POSITIVE,
        doc="Height of the beam, for drawings only; 0.2 times that of the columns unless given.",
        default=None,
    )

    def __init__(
        self,
        column: Block,
        *,
        columns: int,
        beam_mass: QuantityLike,
        spacing: QuantityLike | None = None,
        beam_height: QuantityLike | None = None,
    ) -> None:
        super().__init__(
            column=column, columns=columns, beam_mass=beam_mass, spacing=spacing,
            beam_height=beam_height,
        )  # fmt: skip

    def _numbers(self, numbers: SIValues) -> RockingFrameSI:
        if numbers.columns < MIN_COLUMNS:
            msg = f"RockingFrame: columns must be {MIN_COLUMNS} or more, got {numbers.columns}"
            raise ComponentError(msg)
        si = numbers.column.si
        spacing = SPACING_RATIO * si.height if numbers.spacing is None else numbers.spacing
        depth = (
            BEAM_HEIGHT_RATIO * si.height if numbers.beam_height is None else numbers.beam_height
        )
        return RockingFrameSI(si, numbers.columns, numbers.beam_mass, spacing, depth)

    def cautions(self) -> list[str]:
        """Return the warnings about unusual values of the column.

        Returns
        -------
        list of str
        """
        return self.given.column.cautions()

    def parameters(self) -> tuple[str, ...]:
        """Name the nonzero numbers on which the motion depends.

        Returns
        -------
        tuple of str
            For example "height of column" and "beam_mass".
        """
        of_column = (f"{name}{_COLUMN_SUFFIX}" for name in self.given.column.parameters())
        return (*of_column, *(["beam_mass"] if self.si.beam_mass else []))

    def with_scaled(self, name: str, factor: float) -> Self:
        """Build a frame with one number multiplied by a factor.

        Parameters
        ----------
        name : str
            One of :meth:`parameters`.
        factor : float
            Ratio of the new value to the old one [1].

        Returns
        -------
        RockingFrame

        Raises
        ------
        ComponentError
            No such parameter, or its new value is out of range.
        """
        self._check_name(name, self.parameters())
        own = name.removesuffix(_COLUMN_SUFFIX)
        if own == name:
            return super().with_scaled(name, factor)
        column = self.given.column.with_scaled(own, factor)
        return self.from_dict({**self._arguments(), "column": column})

    def __repr__(self) -> str:
        arguments = {**self._arguments(), "column": self.given.column}
        column, *others = (f"{name}={value!r}" for name, value in arguments.items())
        return f"RockingFrame({column.removeprefix('column=')}, {', '.join(others)})"

    def __hash__(self) -> int:
        return hash(repr(self))

    def _shapes(self) -> list[Polygon]:
        return [Polygon("member", outline) for outline in frame_outlines(self.si)]


def frame_outlines(si: RockingFrameSI) -> list[list[tuple[float, float]]]:
    """Return the corners of all columns and of the beam, from the middle of the bases [m]."""
    half, height, places = si.column.half_width, si.column.height, column_positions(si)
    beam = rectangle(places[-1] + 2.0 * half, si.beam_height, y=height)
    return [*(rectangle(half, height, x) for x in places), beam]


def column_positions(si: RockingFrameSI) -> list[float]:
    """Return the coordinates of the column axes, to the right of the middle of the frame [m]."""
    return [(k - 0.5 * (si.columns - 1)) * si.spacing for k in range(si.columns)]
