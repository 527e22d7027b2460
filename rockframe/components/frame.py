"""A frame building as an equivalent rigid block, Eqs. (21) to (23)."""

import json
from collections.abc import Iterable, Mapping
from typing import Any, ClassVar, Self

import xarray as xr

from rockframe.components.alternatives import OneOf, changed_arguments
from rockframe.components.block import Block
from rockframe.components.frame_building import Building, make_building
from rockframe.components.frame_members import Member, make_members_table, member_outlines
from rockframe.components.frame_regular import INFILL_THICKNESS, SLAB_THICKNESS, RegularFrame
from rockframe.components.parameters import DERIVED, Derived, Ratio
from rockframe.errors import ComponentError, SchemaError, short_repr
from rockframe.notebook import Polygon
from rockframe.units import LENGTH, POSITIVE, Quantity, QuantityLike, RatioLike, quantity

_MIN_SHAPE_FACTOR = 1.0 - 1e-9  # a shape factor derived from an inertia is rounded


class FrameEquivalent(Block):
    """A frame building as its equivalent rigid block; it can replace a block in any scene.

    It is built from the equivalent parameters, as in Table 2 of the paper, or by
    :meth:`from_members` from the members of the building.

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
        The shape factor is below 1. In the plane all mass lies within R0 of the centre, so that
        :eq:`eq-frame-shape-factor` gives 1 or more. The value is used nevertheless, as Table 2
        has one below 1.

    Notes
    -----
    Width B' = B_x and height H' = H are those of the building, Eq. (21); the mass is that
    of all members together. The shape factor 3 of a solid rectangle is not assumed, as a frame is
    hollow.

    Examples
    --------
    >>> frame = FrameEquivalent(width="4 m", height="9 m", mass="45.8 t", shape_factor=1.153)
    >>> round(frame.overturning_angle.m_as("rad"), 3)
    0.418
    """

    alternatives: ClassVar[tuple[OneOf, ...]] = (
        *Block.alternatives,  # at most one of them; and one at least:
        OneOf(
            "shape_factor", "inertia",
            hint="a frame is hollow, so that the solid rectangle's 3 is not assumed",
        ),
    )  # fmt: skip

    shape_factor: Ratio[Derived] = Ratio(
        POSITIVE, doc="mu of Eq. (22).", default=DERIVED, example="2.5"
    )

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
        """Build the equivalent block of a building from its members.

        Give either `members`, or the dimensions of a regular frame, which are those of
        :class:`RegularFrame`.

        Parameters
        ----------
        members : iterable of Member or of mappings, optional
            All members; a mapping holds the arguments of a :class:`Member`.
        width : str or Quantity
            Width B_x of the building in the plane of rocking [m].
        height : str or Quantity, optional
            Height H of the building; `storey_heights` determine it, too [m].
        depth : str or Quantity, optional
            Depth B_y, perpendicular to the plane of rocking; that of a regular frame is `width`
            unless given. With `members` only the space proportion depends on it [m].
        storeys : int, optional
            Number of storeys of equal height.
        storey_heights : sequence of str or Quantity, or str, optional
            Height of every storey from the lowest up, instead of `storeys` and
            `height` [m].
        column_width, column_depth : str or Quantity, optional
            Sizes of the columns, in and perpendicular to the plane of rocking; square unless
            `column_depth` is given [m].
        beam_height, beam_width : str or Quantity, optional
            Sizes of the edge beams; the height includes the slab [m].
        slab_thickness : str or Quantity
            Thickness of the slabs [m].
        infill_thickness : str, Quantity or None
            Thickness of the infill walls; None for no walls [m].
        density : str or Quantity, optional
            Mass per volume of all members of a regular frame [kg m^-3].
        centre_of_mass : {"members", "middle"}, optional
            ``"members"``, the default for a list of members: the centre of mass of the members,
            with its height and eccentricity. ``"middle"``, the default for a regular frame: the
            middle of the outline at half the height, as in the paper.

        Returns
        -------
        FrameEquivalent

        Raises
        ------
        UnitsError
            A value has the wrong unit, or none.
        ComponentError
            Arguments are missing, exclude one another or do not fit; a member reaches beyond the
            outline of the building; two members have the same name; or together they fill more
            than the building.

        Warns
        -----
        ModelWarning
            With ``"middle"``: the centre of mass of the members lies more than H/10 above or
            below H/2, or more than B/10 to one side of the middle.

        Notes
        -----
        With ``"middle"`` the shape factor is :eq:`eq-frame-shape-factor`, with the moment of
        inertia about O, the middle of the outline at half the height. The centre of mass of a
        building with heavy floors lies higher (:attr:`centre_of_mass_height`): by 2.5 to 5.7 % of
        H in the frames of the paper, and by up to 12 % without their walls. If it is 10 % of H
        higher, the tangent of the real overturning angle is one sixth less than tan(theta); above
        10 % a warning is issued. With ``"members"`` the shape factor is
        :eq:`eq-frame-about-centre`. The space proportion is :eq:`eq-frame-space-proportion`.

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
        frame = cls._from_arguments(
            members, width=width, height=height, depth=depth, slab_thickness=slab_thickness,
            infill_thickness=infill_thickness, storeys=storeys, storey_heights=storey_heights,
            column_width=column_width, column_depth=column_depth, beam_height=beam_height,
            beam_width=beam_width, density=density, centre_of_mass=centre_of_mass,
        )  # fmt: skip
        frame._warn()
        return frame

    @classmethod
    def from_density(cls, **sizes: Any) -> Self:
        """Raise an error: a frame does not fill its outline, so its density gives no mass.

        Parameters
        ----------
        **sizes : object
            Arguments of :meth:`Block.from_density`.

        Returns
        -------
        FrameEquivalent
            It never returns.

        Raises
        ------
        ComponentError
            Always.
        """
        msg = (
            f"{cls.__name__}.from_density: outline and density do not give the mass of a frame, "
            f"which is hollow; use {cls.__name__}.from_members(...), or give the mass"
        )
        raise ComponentError(msg)

    @classmethod
    def from_dict(cls, arguments: Mapping[str, float | str]) -> Self:
        """Build the frame from the result of :meth:`to_dict`, with its members.

        Parameters
        ----------
        arguments : mapping
            Arguments of the constructor, or of :meth:`from_members`.

        Returns
        -------
        FrameEquivalent

        Raises
        ------
        SchemaError
            The members are not readable.
        ComponentError
            The mapping describes a component of another class.
        TypeError, UnitsError, ComponentError
            As the constructor.

        Examples
        --------
        >>> import rockframe as rf
        >>> frame = rf.FrameEquivalent(width="4 m", height="12 m", mass="80 t", shape_factor=2.5)
        >>> rf.FrameEquivalent.from_dict(frame.to_dict()) == frame
        True
        """
        values = cls._arguments_from(arguments)
        if not {"members", "density"} & set(values):
            return super().from_dict(values)
        if "members" in values:
            try:
                values["members"] = json.loads(values["members"])
            except (TypeError, ValueError) as problem:
                msg = f"found members {short_repr(values['members'])}; expected a list in JSON"
                raise SchemaError(msg) from problem
        return cls._from_arguments(**values)

    def replace(self, **changes: Any) -> Self:
        """Build a frame with some parameters changed.

        Parameters
        ----------
        **changes
            Arguments of the constructor, or of :meth:`from_members` if it built the frame.

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
        return type(self).from_members(
            **changed_arguments(arguments, changes, RegularFrame.alternatives)
        )

    def parameters(self) -> tuple[str, ...]:
        """Name the numbers of the equivalent block other than zero.

        Returns
        -------
        tuple of str
            A frame built from members has these numbers, too. Scaling one of them gives a frame
            with equivalent parameters, without members.

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
        """Members of the frame; none if it was built from equivalent parameters."""
        return () if self._building is None else self._building.members

    def _shapes(self) -> list[Polygon]:
        members = member_outlines(self.members)
        return [*super()._shapes(), *(Polygon("member", outline) for outline in members)]

    @property
    def depth(self) -> Quantity | None:
        """Depth B_y, perpendicular to the plane of rocking, if known [m]."""
        depth = None if self._building is None else self._building.depth
        return None if depth is None else quantity(depth, LENGTH)

    @property
    def space_proportion(self) -> float | None:
        """Space proportion chi, Eq. (23); None if the depth or a volume is unknown [1]."""
        return None if self._building is None else self._building.space_proportion

    @property
    def centre_of_mass_height(self) -> Quantity | None:
        """Height of the centre of mass of the members; the model uses `centre_height` [m]."""
        if self._building is None:
            return None
        return quantity(self._building.centre_of_mass[1], LENGTH)

    def members_table(self) -> xr.Dataset:
        """Return a table of mass, position, size and moment of inertia of all members.

        Returns
        -------
        xarray.Dataset
            Dimension ``member``, labelled by name and ``kind``. ``inertia`` is about the centre
            of mass of the member, ``inertia_about_middle`` about O, the middle of the outline at
            half the height. Unknown values are NaN. The attributes contain the sums.

        Raises
        ------
        ComponentError
            The frame was built from equivalent parameters, without members.

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
                "FrameEquivalent: there are no members, as the frame was built from its "
                "equivalent parameters; use FrameEquivalent.from_members(...)"
            )
            raise ComponentError(msg)
        return make_members_table(
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
    def _from_arguments(
        cls, members: object = None, *, centre_of_mass: object = None, **dimensions: Any
    ) -> Self:
        owner = f"{cls.__name__}.from_members"
        building = make_building(members, centre_of_mass, dimensions, owner)
        frame = object.__new__(cls)
        frame._set_arguments(building.block_arguments(owner))
        object.__setattr__(frame, "_building", building)
        return frame

    def _cautions(self) -> list[str]:
        return super()._cautions() if self._building is None else self._building.cautions()

    def _inertia_cautions(self) -> list[str]:
        si = self.si
        in_the_middle = si.centre_height == 0.5 * si.height and si.eccentricity == 0.0
        if not in_the_middle:
            return super()._inertia_cautions()
        if si.shape_factor >= _MIN_SHAPE_FACTOR:
            return []
        return [
            f"a shape factor of {si.shape_factor:.4g} is not physical: in the plane of "
            "rocking all mass lies within R0 of the centre, so that Eq. (22) gives 1 or more; "
            "the value is used as given",
        ]

    def _arguments(self) -> dict[str, float | str]:
        return super()._arguments() if self._building is None else dict(self._building.arguments)

    def _plain_arguments(self) -> dict[str, Any]:
        """Return the arguments of :meth:`from_members`, members as a list."""
        values: dict[str, Any] = self._arguments()
        return values | ({"members": json.loads(values["members"])} if "members" in values else {})

    def __repr__(self) -> str:
        if self._building is None:
            return super().__repr__()
        words = ", ".join(f"{name}={value!r}" for name, value in self._plain_arguments().items())
        return f"{type(self).__name__}.from_members({words})"
