"""The frame building as an equivalent rigid block, Eqs. (21) to (23)."""

import json
from collections.abc import Iterable, Mapping
from typing import Any, Final, Self

import xarray as xr

from rockframe.components.base import replaced
from rockframe.components.block import Block
from rockframe.components.frame_building import Building, building_of
from rockframe.components.frame_members import Member, members_table
from rockframe.components.frame_regular import INFILL_THICKNESS, SLAB_THICKNESS, RegularFrame
from rockframe.components.parameters import DERIVED, Ratio
from rockframe.errors import ComponentError, SchemaError, shown
from rockframe.notebook import Polygon
from rockframe.units import LENGTH, POSITIVE, Quantity, QuantityLike, RatioLike, quantity

_LEAST_SHAPE_FACTOR = 1.0 - 1e-9  # a shape factor derived from an inertia is rounded


_CORNERS: Final = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))


class FrameEquivalent(Block):
    """A frame building as the rigid block that rocks like it; stands wherever a block does.

    Built from the equivalent parameters, as in the paper's Table 2, or by
    :meth:`from_members` from what the building consists of.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or not exactly one of `shape_factor`
        and `inertia` is given.

    Warns
    -----
    ModelWarning
        The shape factor is below 1. In the plane all mass lies within R0 of
        the centre, so that :eq:`eq-frame-shape-factor` gives 1 or more. The
        value is used as given, for Table 2 has such a one.

    Notes
    -----
    Width B' = B_x and height H' = H are those of the building, Eq. (21); the mass is that
    of all members together. A solid rectangle's shape factor, 3, is not assumed: a frame
    is hollow.

    Examples
    --------
    >>> frame = FrameEquivalent(width="4 m", height="9 m", mass="45.8 t", shape_factor=1.153)
    >>> round(frame.overturning_angle.m_as("rad"), 3)
    0.418
    """

    shape_factor = Ratio(POSITIVE, doc="mu of Eq. (22).", default=DERIVED, example="2.5")

    _building: Building | None = None

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
        centre_of_mass: str | None = None,
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
        centre_of_mass : {"members", "middle"}, optional
            ``"members"`` takes the centre of mass, its height and how far it is beside the
            middle, where the members have it: the default for a list of members.
            ``"middle"`` takes it half way up the middle of the building, as the paper does: the
            default for a regular frame.

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
            With ``"middle"``: the centre of mass lies more than H/10 above or below
            H/2, or more than B/10 beside the middle.

        Notes
        -----
        With ``"middle"``, shape factor :eq:`eq-frame-shape-factor`: the inertia is about O,
        half way up the middle of the building. The centre of mass of a building with heavy
        floors lies higher (:attr:`centre_of_mass_height`): by 2.5 to 5.7 % of H in the paper's
        frames, by up to 12 % without their walls. At 10 % of H the real building overturns at
        a slope a sixth below tan(theta); from there on a warning says so. With ``"members"``,
        shape factor :eq:`eq-frame-about-centre`. Space proportion
        :eq:`eq-frame-space-proportion`.

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
            centre_of_mass=centre_of_mass,
        )
        frame._warn()
        return frame

    @classmethod
    def from_density(cls, **sizes: Any) -> Self:
        """Refuse: a frame does not fill its outline, so that its density gives no mass.

        Parameters
        ----------
        **sizes : object
            As of :meth:`Block.from_density`.

        Returns
        -------
        FrameEquivalent
            None, ever.

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

        Parameters
        ----------
        arguments : mapping
            Of the constructor, or of :meth:`from_members`.

        Returns
        -------
        FrameEquivalent

        Raises
        ------
        SchemaError
            The members are not readable.
        ComponentError
            It describes a component of another class.
        TypeError, UnitsError, ComponentError
            As the constructor.

        Examples
        --------
        >>> import rockframe as rf
        >>> frame = rf.FrameEquivalent(width="4 m", height="12 m", mass="80 t", shape_factor=2.5)
        >>> rf.FrameEquivalent.from_dict(frame.to_dict()) == frame
        True
        """
        given = cls._described(arguments)
        if not {"members", "density"} & set(given):
            return super().from_dict(given)
        if "members" in given:
            try:
                given["members"] = json.loads(given["members"])
            except (TypeError, ValueError) as problem:
                msg = f"found members {shown(given['members'])}; expected a list in JSON"
                raise SchemaError(msg) from problem
        return cls._of_members(**given)

    def replace(self, **changes: Any) -> Self:
        """Build a frame of which some parameters are others.

        Parameters
        ----------
        **changes
            Arguments of the constructor; of :meth:`from_members`, where the frame was built
            by that.

        Returns
        -------
        FrameEquivalent

        Raises
        ------
        TypeError, UnitsError, ComponentError
            As the constructor, or as :meth:`from_members`.
        """
        if self._building is None:
            return super().replace(**changes)
        arguments = self._plain_arguments()
        return type(self).from_members(**replaced(arguments, changes, RegularFrame.alternatives))

    def parameters(self) -> tuple[str, ...]:
        """Name the numbers of the block that the frame stands for, other than zero.

        Returns
        -------
        tuple of str
            Also of a frame that was built from its members; one of which such a number is
            scaled is given by its equivalent parameters.

        Examples
        --------
        >>> import rockframe as rf
        >>> tower = rf.Member.box("tower", "column", 2400.0, (0.0, 4.5), (1.0, 9.0, 1.0))
        >>> rf.FrameEquivalent.from_members([tower], width="1 m", height="9 m").parameters()
        ('width', 'height', 'mass', 'shape_factor', 'centre_height')
        """
        if self._building is None:
            return super().parameters()
        return type(self).from_dict(super()._arguments()).parameters()

    @property
    def members(self) -> tuple[Member, ...]:
        """Members that the frame was built from; none if it was built from its parameters."""
        return () if self._building is None else self._building.members

    def _shapes(self) -> list[Polygon]:
        members = [
            Polygon("member", [(si.x + a * si.width, si.y + b * si.height) for a, b in _CORNERS])
            for si in (member.si for member in self.members)
            if si.width is not None and si.height is not None
        ]
        return [*super()._shapes(), *members]

    @property
    def depth(self) -> Quantity | None:
        """Depth B_y, perpendicular to the plane of rocking, if known [m]."""
        depth = None if self._building is None else self._building.depth
        return None if depth is None else quantity(depth, LENGTH)

    @property
    def space_proportion(self) -> float | None:
        """Chi of Eq. (23), None where the depth or a member's volume is unknown [1]."""
        return None if self._building is None else self._building.space_proportion

    @property
    def centre_of_mass_height(self) -> Quantity | None:
        """Height of the members' centre of mass; `centre_height` is the model's [m]."""
        if self._building is None:
            return None
        return quantity(self._building.centre_of_mass[1], LENGTH)

    def members_table(self) -> xr.Dataset:
        """Give one row for each member: mass, place, size, inertia.

        Returns
        -------
        xarray.Dataset
            Dimension ``member``, labelled by name and ``kind``. ``inertia`` is about the
            member's own centre, ``inertia_about_middle`` about O, half way up
            the middle of the building. What is unknown is NaN. The attributes
            hold the sums.

        Raises
        ------
        ComponentError
            The frame was built from its parameters and knows no members.

        Examples
        --------
        >>> import rockframe as rf
        >>> tower = rf.Member.box("tower", "column", 2400.0, (0.0, 4.5), (1.0, 9.0, 1.0))
        >>> frame = rf.FrameEquivalent.from_members([tower], width="1 m", height="9 m")
        >>> frame.members_table().mass.values.tolist()
        [21600.0]
        """
        building = self._building
        if building is None:
            msg = (
                "FrameEquivalent: there are no members to show, for the frame was built from its "
                "equivalent parameters; use FrameEquivalent.from_members(...)"
            )
            raise ComponentError(msg)
        return members_table(
            building.members,
            self.si.height,
            {
                "width": self.si.width,
                "height": self.si.height,
                "depth": building.depth,
                "mass": self.si.mass,
                "shape_factor": self.si.shape_factor,
                "space_proportion": self.space_proportion,
                "centre_of_mass_height": building.centre_of_mass[1],
                "centre_of_mass_beside_middle": building.centre_of_mass[0],
            },
        )

    @classmethod
    def _of_members(
        cls, members: object = None, *, centre_of_mass: object = None, **measures: Any
    ) -> Self:
        owner = f"{cls.__name__}.from_members"
        building = building_of(members, centre_of_mass, measures, owner)
        frame = object.__new__(cls)
        frame._fill(building.block_arguments(owner))
        object.__setattr__(frame, "_building", building)
        return frame

    def _check(self, given: Mapping[str, object], owner: str) -> None:
        if given["shape_factor"] is None and given["inertia"] is None:
            msg = (
                f"{owner}: give shape_factor or inertia, neither was given; a frame "
                "is hollow, so that the solid rectangle's 3 is not assumed"
            )
            raise ComponentError(msg)
        super()._check(given, owner)

    def _cautions(self) -> list[str]:
        return super()._cautions() if self._building is None else self._building.cautions()

    def _unphysical(self) -> list[str]:
        si = self.si
        in_the_middle = si.centre_height == 0.5 * si.height and si.eccentricity == 0.0
        if not in_the_middle:
            return super()._unphysical()
        if si.shape_factor >= _LEAST_SHAPE_FACTOR:
            return []
        return [
            f"a shape factor of {si.shape_factor:.4g} is not physical: in the plane of "
            "rocking all mass lies within R0 of the centre, so that Eq. (22) gives 1 or more; "
            "the value is used as given",
        ]

    def _arguments(self) -> dict[str, float | str]:
        return super()._arguments() if self._building is None else dict(self._building.arguments)

    def _plain_arguments(self) -> dict[str, Any]:
        """Give the arguments of :meth:`from_members`, members as a list."""
        given: dict[str, Any] = self._arguments()
        return given | ({"members": json.loads(given["members"])} if "members" in given else {})

    def __repr__(self) -> str:
        if self._building is None:
            return super().__repr__()
        words = ", ".join(f"{name}={value!r}" for name, value in self._plain_arguments().items())
        return f"{type(self).__name__}.from_members({words})"
