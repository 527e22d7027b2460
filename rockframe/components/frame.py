"""The frame building as an equivalent rigid block, Eqs. (21) to (23)."""

import json
import warnings
from collections.abc import Iterable, Mapping
from typing import Any, Self

import pint
import xarray as xr

from rockframe.components.block import Block
from rockframe.components.frame_building import listed_building, regular_building
from rockframe.components.frame_members import Member
from rockframe.components.frame_outline import Outline, outline_cautions
from rockframe.components.frame_regular import INFILL_THICKNESS, SLAB_THICKNESS
from rockframe.components.frame_table import members_table
from rockframe.errors import ComponentError, ModelWarning, SchemaError, shown
from rockframe.units import (
    LENGTH,
    MASS,
    QuantityLike,
    RatioLike,
    quantity,
)

_LEAST_SHAPE_FACTOR = 1.0 - 1e-9  # a shape factor derived from an inertia is rounded


class FrameEquivalent(Block):
    """A frame building as the rigid block that rocks like it; stands wherever a block does.

    Built from the equivalent parameters, as in the paper's Table 2, or by
    :meth:`from_members` from what the building consists of.

    Parameters
    ----------
    width : str or Quantity
        Width B' = B_x in the plane of rocking, Eq. (21) [m].
    height : str or Quantity
        Height H' = H, Eq. (21); the centre of mass is taken at H/2 [m].
    mass : str or Quantity
        Mass of all members together [kg].
    shape_factor : float
        mu of Eq. (22) [1].
    inertia : str or Quantity
        Moment of inertia about the centre of mass I_O, instead of
        `shape_factor` [kg m^2].

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, not exactly one of `shape_factor` and
        `inertia` is given, or the frame is so squat that it cannot rock.

    Warns
    -----
    ModelWarning
        The shape factor is below 1. In the plane all mass lies within R0 of
        the centre, so that :eq:`eq-frame-shape-factor` gives 1 or more. The
        value is used as given, for Table 2 has such a one.

    Notes
    -----
    A solid rectangle's shape factor, 3, is not assumed: a frame is hollow.

    Examples
    --------
    >>> frame = FrameEquivalent(width="4 m", height="9 m", mass="45.8 t", shape_factor=1.153)
    >>> round(frame.overturning_angle.m_as("rad"), 3)
    0.418
    """

    _members: tuple[Member, ...]
    _outline: Outline | None

    def __init__(
        self,
        *,
        width: QuantityLike,
        height: QuantityLike,
        mass: QuantityLike,
        shape_factor: RatioLike | None = None,
        inertia: QuantityLike | None = None,
    ) -> None:
        self._set_parameters(width, height, mass, shape_factor, inertia)
        if self.si.shape_factor < _LEAST_SHAPE_FACTOR:
            msg = (
                f"FrameEquivalent: a shape factor of {self.si.shape_factor:.4g} is not physical: "
                "in the plane of rocking all mass lies within R0 of the centre, so that Eq. (22) "
                "gives 1 or more; the value is used as given"
            )
            warnings.warn(msg, ModelWarning, stacklevel=2)

    @classmethod
    def from_members(
        cls,
        members: Iterable[Member | Mapping[str, Any]] | None = None,
        *,
        width: QuantityLike,
        height: QuantityLike | None = None,
        depth: QuantityLike | None = None,
        storeys: RatioLike | None = None,
        storey_heights: Iterable[QuantityLike] | None = None,
        column_width: QuantityLike | None = None,
        column_depth: QuantityLike | None = None,
        beam_height: QuantityLike | None = None,
        beam_width: QuantityLike | None = None,
        slab_thickness: QuantityLike = SLAB_THICKNESS,
        infill_thickness: QuantityLike | None = INFILL_THICKNESS,
        density: QuantityLike | None = None,
    ) -> Self:
        """Build the equivalent of a building from what it consists of.

        Either give `members`, or the measures of a regular frame, which are
        those of :class:`RegularFrame`.

        Parameters
        ----------
        members : iterable of Member or of mappings, optional
            All members; a mapping holds the arguments of a :class:`Member`.
        width : str or Quantity
            Width B_x of the building in the plane of rocking [m].
        height : str or Quantity, optional
            Height H of the building; follows from `storey_heights` [m].
        depth : str or Quantity, optional
            Depth B_y, perpendicular to the plane of rocking; a regular frame's
            is `width` unless given. With `members` only the space proportion
            depends on it [m].
        storeys : int, optional
            Number of storeys of equal height.
        storey_heights : sequence of str or Quantity, or str, optional
            Height of every storey from the lowest up, instead of `storeys` and
            `height` [m].
        column_width, column_depth : str or Quantity, optional
            Columns, in and perpendicular to the plane; square unless
            `column_depth` is given [m].
        beam_height, beam_width : str or Quantity, optional
            Edge beams; the height includes the slab [m].
        slab_thickness : str or Quantity
            Slabs [m].
        infill_thickness : str, Quantity or None
            Infill walls; None for no walls [m].
        density : str or Quantity, optional
            Mass per volume of all members of a regular frame [kg m^-3].

        Returns
        -------
        FrameEquivalent

        Raises
        ------
        UnitsError
            A value has the wrong unit, or none.
        ComponentError
            Arguments are missing, exclude one another or do not fit; a member
            reaches beyond the building's outline; two have the same name; or
            together they fill more than the building.

        Warns
        -----
        ModelWarning
            The centre of mass lies more than H/10 above or below H/2, or more
            than B/10 beside the middle.

        Notes
        -----
        Shape factor :eq:`eq-frame-shape-factor`, space proportion
        :eq:`eq-frame-space-proportion`. The inertia is about O, half way up the
        middle of the building, where the block's centre of mass is taken to
        be. That of a building with heavy floors lies higher
        (:attr:`centre_of_mass_height`): by 2.5 to 5.7 % of H in the paper's
        frames, by up to 12 % without their walls. At 10 % of H the real
        building overturns at a slope a sixth below tan(theta); from there on a
        warning says so.

        Examples
        --------
        >>> frame = FrameEquivalent.from_members(
        ...     storeys=3,
        ...     width="4 m",
        ...     height="9 m",
        ...     column_width="0.25 m",
        ...     beam_height="0.30 m",
        ...     beam_width="0.25 m",
        ...     density="2500 kg/m^3",
        ... )
        >>> round(frame.shape_factor, 3), round(frame.space_proportion, 3)
        (2.774, 0.127)
        """
        frame = cls._of_members(
            members,
            width=width,
            height=height,
            depth=depth,
            slab_thickness=slab_thickness,
            infill_thickness=infill_thickness,
            storeys=storeys,
            storey_heights=storey_heights,
            column_width=column_width,
            column_depth=column_depth,
            beam_height=beam_height,
            beam_width=beam_width,
            density=density,
        )
        for caution in outline_cautions(frame._outline, frame._members):
            warnings.warn(f"FrameEquivalent: {caution}", ModelWarning, stacklevel=2)
        return frame

    @classmethod
    def from_density(cls, **sizes: Any) -> Self:
        """Refuse: a frame does not fill its outline, so that its density gives no mass.

        Raises
        ------
        ComponentError
            Always.
        """
        msg = (
            f"{cls.__name__}.from_density: a frame is hollow, its outline and density do not give "
            f"its mass; use {cls.__name__}.from_members(...), or give the mass"
        )
        raise ComponentError(msg)

    @classmethod
    def from_dict(cls, arguments: Mapping[str, float | str]) -> Self:
        """Build the frame that :meth:`to_dict` described, members included.

        Raises
        ------
        SchemaError
            The members are not readable.
        """
        # Nothing is warned about twice: the warnings came when the frame was new.
        given: dict[str, Any] = dict(arguments)
        if "members" in given:
            try:
                given["members"] = json.loads(given["members"])
            except (TypeError, ValueError) as problem:
                msg = f"found members {shown(given['members'])}; expected a list in JSON"
                raise SchemaError(msg) from problem
        if "members" in given or "density" in given:
            return cls._of_members(**given)
        frame = object.__new__(cls)
        frame._set_parameters(**given)
        return frame

    @property
    def members(self) -> tuple[Member, ...]:
        """Members that the frame was built from; none if it was built from its parameters."""
        return self._members

    @property
    def depth(self) -> pint.Quantity[Any] | None:
        """Depth B_y, perpendicular to the plane of rocking, if known [m]."""
        depth = None if self._outline is None else self._outline.depth
        return None if depth is None else quantity(depth, LENGTH)

    @property
    def space_proportion(self) -> float | None:
        """Chi of Eq. (23), None where the depth or a member's volume is unknown [1]."""
        return None if self._outline is None else self._outline.space_proportion(self._members)

    @property
    def centre_of_mass_height(self) -> pint.Quantity[Any] | None:
        """Height of the members' centre of mass; the model takes H/2 instead [m]."""
        if self._outline is None:
            return None
        return quantity(self._outline.centre_of_mass(self._members)[1], LENGTH)

    def members_table(self) -> xr.Dataset:
        """Give one row for each member: mass, place, size, inertia.

        Returns
        -------
        xarray.Dataset
            Dimension ``member``, labelled by name and ``kind``. ``inertia`` is about the
            member's own centre, ``inertia_about_middle`` about O, where the
            latter's sum is m R0^2/mu. What is unknown is NaN. The attributes
            hold the sums.

        Raises
        ------
        ComponentError
            The frame was built from its parameters and knows no members.
        """
        if self._outline is None:
            msg = (
                "FrameEquivalent: there are no members to show, for the frame was built from its "
                "equivalent parameters; use FrameEquivalent.from_members(...)"
            )
            raise ComponentError(msg)
        return members_table(
            self._members,
            self.si.height,
            {
                "width": self.si.width,
                "height": self.si.height,
                "depth": self._outline.depth,
                "mass": self.si.mass,
                "shape_factor": self.si.shape_factor,
                "space_proportion": self.space_proportion,
                "centre_of_mass_height": self._outline.centre_of_mass(self._members)[1],
            },
        )

    @classmethod
    def _of_members(cls, members: object = None, **measures: Any) -> Self:
        owner = f"{cls.__name__}.from_members"
        if members is None:
            building = regular_building(measures, owner)
        else:
            building = listed_building(members, measures, owner)
        outline = building.outline
        outline.check(building.members, owner)
        mass = sum(member.si.mass for member in building.members)
        frame = object.__new__(cls)
        frame._set_parameters(
            width=f"{outline.width!r} {LENGTH.unit}",
            height=f"{outline.height!r} {LENGTH.unit}",
            mass=f"{mass!r} {MASS.unit}",
            shape_factor=outline.shape_factor(building.members),
        )
        frame._freeze(frame.si, building.arguments)
        frame._keep(building.members, outline)
        return frame

    def _set_parameters(
        self,
        width: QuantityLike,
        height: QuantityLike,
        mass: QuantityLike,
        shape_factor: RatioLike | None = None,
        inertia: QuantityLike | None = None,
    ) -> None:
        if shape_factor is None and inertia is None:
            msg = (
                f"{type(self).__name__}: give shape_factor or inertia, neither was given; a frame "
                "is hollow, so that the solid rectangle's 3 is not assumed"
            )
            raise ComponentError(msg)
        super().__init__(
            width=width, height=height, mass=mass, shape_factor=shape_factor, inertia=inertia
        )
        self._keep((), None)

    def _keep(self, members: tuple[Member, ...], outline: Outline | None) -> None:
        object.__setattr__(self, "_members", members)
        object.__setattr__(self, "_outline", outline)

    def __eq__(self, other: object) -> bool:
        # A block compares the arguments of its subclasses too; a frame is no plain block.
        return type(other) is type(self) and self._arguments == other._arguments

    __hash__ = Block.__hash__

    def __repr__(self) -> str:
        if self._outline is None:
            return super().__repr__()
        given: dict[str, Any] = dict(self._arguments)
        if "members" in given:
            given["members"] = json.loads(given["members"])
        words = ", ".join(f"{name}={value!r}" for name, value in given.items())
        return f"{type(self).__name__}.from_members({words})"
