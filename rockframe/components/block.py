"""The rigid block."""

import math
from collections.abc import Collection, Mapping
from typing import Any, ClassVar, Final, Self, cast

from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.block_numbers import (
    BlockSI,
    check_centre,
    check_representable,
    unphysical_inertia,
)
from rockframe.components.parameters import DERIVED, Parameter, Ratio, SIProperty, SIValues
from rockframe.components.shapes.outline import cylinder_body, outline_body
from rockframe.components.shapes.parts import Part, body_of_parts
from rockframe.components.shapes.reading import Place, Points
from rockframe.errors import ComponentError, ModelWarning, shown, warn
from rockframe.notebook import Polygon
from rockframe.units import (
    ANGLE,
    ANGULAR_VELOCITY,
    DENSITY,
    INERTIA,
    LENGTH,
    MASS,
    POSITIVE,
    Quantity,
    QuantityLike,
    RatioLike,
    to_ratio,
    to_si,
)

SOLID_RECTANGLE_SHAPE_FACTOR = 3.0
"""mu of a solid rectangle: I_O = m (B^2 + H^2)/12 = m R0^2/3."""

_SIZES: Final = frozenset({"width", "height", "mass"})
"""What a moment of inertia goes with."""


class Block(Component):
    """A rigid rectangular block, or a body that rocks like one.

    Raises
    ------
    UnitsError
        A dimensional argument has no unit or a unit of the wrong kind.
    ComponentError
        A value is not finite or not positive, or both `shape_factor` and
        `inertia` are given.

    Warns
    -----
    ModelWarning
        The given `shape_factor` or `inertia` is that of no body within the
        rectangle of width and height, :eq:`eq-greatest-inertia`; it is used as given.

    Notes
    -----
    A block rocks only while the greatest restitution, Eq. (4), is positive; for
    a solid rectangle that is H/B > sqrt(2)/2, Eq. (5).

    ``centre_of_mass=("0.7 m", "0.05 m")`` stands for `centre_height` and `eccentricity`
    together. A centre of mass that is not in the middle leaves the moment of inertia about it
    that of the solid rectangle, unless `inertia` or `shape_factor` tells another;
    :meth:`from_outline`, :meth:`from_parts` and :meth:`cylinder` work both out.

    Examples
    --------
    >>> block = Block(width="2.4254 m", height="9.7014 m", mass="50 t")
    >>> round(block.overturning_angle.m_as("rad"), 4)
    0.245
    >>> block.replace(mass="60 t").mass.to("t")
    <Quantity(60.0, 'metric_ton')>
    """

    si: BlockSI
    noun: ClassVar[str] = "body"
    alternatives: ClassVar[tuple[OneOf, ...]] = (OneOf("shape_factor", "inertia", required=False),)

    width = Parameter(LENGTH, POSITIVE, doc="Base width B.")
    height = Parameter(LENGTH, POSITIVE, doc="Height H.")
    mass = Parameter(MASS, POSITIVE, doc="Mass m.")
    shape_factor = Ratio(
        POSITIVE,
        doc="mu = m R0^2 / I_O; 3, the solid rectangle's, unless given.",
        default=DERIVED,
        example="3",
    )
    inertia = Parameter(
        INERTIA,
        POSITIVE,
        doc="Moment of inertia about the centre of mass I_O, instead of `shape_factor`.",
        default=DERIVED,
    )
    centre_height = Parameter(
        LENGTH,
        POSITIVE,
        doc="Height of the centre of mass above the base; H/2 unless given.",
        default=DERIVED,
    )
    eccentricity = Parameter(
        LENGTH,
        doc="How far the centre of mass is to the right of the middle of the base.",
        default=DERIVED,
    )
    radius = SIProperty(LENGTH, "R0, distance from a corner to the centre of mass.")
    overturning_angle = SIProperty(ANGLE, "theta = arctan(B/H), Eq. (1).")
    frequency = SIProperty(
        ANGULAR_VELOCITY, "Angular frequency omega under standard gravity, Eq. (6)."
    )

    def __init__(
        self,
        *,
        width: QuantityLike,
        height: QuantityLike,
        mass: QuantityLike,
        shape_factor: RatioLike | None = None,
        inertia: QuantityLike | None = None,
        centre_of_mass: tuple[QuantityLike, QuantityLike] | None = None,
        centre_height: QuantityLike | None = None,
        eccentricity: QuantityLike | None = None,
    ) -> None:
        if centre_of_mass is not None:
            centre_height, eccentricity = _pair(
                type(self).__name__, centre_of_mass, centre_height, eccentricity
            )
        super().__init__(
            width=width,
            height=height,
            mass=mass,
            shape_factor=shape_factor,
            inertia=inertia,
            centre_height=centre_height,
            eccentricity=eccentricity,
        )

    @property
    def centre_of_mass(self) -> tuple[Quantity, Quantity]:
        """Height above the base, and how far to the right of its middle [m]."""
        return self.centre_height, self.eccentricity

    def replace(self, **changes: Any) -> Self:
        """Build a block of which some parameters are others.

        Parameters
        ----------
        **changes
            Arguments of the constructor.

        Returns
        -------
        Block

        Raises
        ------
        TypeError, UnitsError, ComponentError
            As the constructor.

        Warns
        -----
        ModelWarning
            Of a block that was given its `inertia`, as are those by their shape, `width`,
            `height` or `mass` is changed, but not the `inertia`, nor `shape_factor` in its
            place; or the `height`, but not a `centre_height` that was given.
        """
        if "centre_of_mass" in changes:
            height, beside = changes.get("centre_height"), changes.get("eccentricity")
            place = _pair(type(self).__name__, changes.pop("centre_of_mass"), height, beside)
            changes |= {"centre_height": place[0], "eccentricity": place[1]}
        made = super().replace(**changes)
        behind = self.left_behind(changes)
        if behind:
            left = " and ".join(
                f"{name}, {getattr(self.si, name):.4g} {self._declared[name].unit}"
                for name in behind
            )
            ways = ", and ".join(behind).replace("inertia", "inertia or shape_factor")
            msg = (
                f"{type(self).__name__}.replace: left as it was for the old size and mass: "
                f"{left}; give {ways}, too"
            )
            warn(msg, ModelWarning)
        return made

    def left_behind(self, changed: Collection[str]) -> tuple[str, ...]:
        """Name what would stay as it was given, although it goes with what is changed.

        A given `inertia` goes with `width`, `height` and `mass`; with the inertia of a body
        the height of its centre of mass is given too, and goes with `height`.

        Parameters
        ----------
        changed : collection of str
            Names of parameters that become others.

        Returns
        -------
        tuple of str
            ``"inertia"``, ``"centre_height"``, both or none.
        """
        if self.given.inertia is None:
            return ()
        behind: list[str] = []
        if _SIZES.intersection(changed) and not {"inertia", "shape_factor"}.intersection(changed):
            behind.append("inertia")
        centred = self.given.centre_height is None or "centre_height" in changed
        if "height" in changed and not centred:
            behind.append("centre_height")
        return tuple(behind)

    def _numbers(self, given: SIValues) -> BlockSI:
        owner = type(self).__name__
        height = 0.5 * given.height if given.centre_height is None else given.centre_height
        beside = 0.0 if given.eccentricity is None else given.eccentricity
        check_centre(given.width, given.height, height, beside, owner)
        diagonal = math.hypot(given.width, 2.0 * height)
        mu: float = given.shape_factor or SOLID_RECTANGLE_SHAPE_FACTOR
        if given.inertia is not None:
            mu = given.mass * diagonal * (diagonal / (4.0 * given.inertia))
        elif given.shape_factor is None and height != 0.5 * given.height:
            # the inertia of the rectangle, for want of another
            whole = math.hypot(given.width, given.height)
            mu *= (diagonal / whole) ** 2
        si = BlockSI(given.width, given.height, given.mass, mu, height, beside)
        check_representable(si, type(self).__name__)
        return si

    def _cautions(self) -> list[str]:
        return [*super()._cautions(), *self._unphysical()]

    def _unphysical(self) -> list[str]:
        """Say whether the given inertia is one that no such body has."""
        told = self.given.shape_factor is not None or self.given.inertia is not None
        return unphysical_inertia(self.si) if told else []

    def _shapes(self) -> list[Polygon]:
        half, si = self.si.half_width, self.si
        outline = [(-half, 0.0), (half, 0.0), (half, si.height), (-half, si.height)]
        return [Polygon("block", outline), Polygon("block", [(si.eccentricity, si.centre_height)])]

    @classmethod
    def from_density(
        cls,
        *,
        width: QuantityLike,
        height: QuantityLike,
        depth: QuantityLike,
        density: QuantityLike,
        shape_factor: RatioLike | None = None,
    ) -> Self:
        """Build a solid block from its size and density.

        Parameters
        ----------
        width, height, depth : str or Quantity
            Size; `depth` is perpendicular to the plane of rocking [m].
        density : str or Quantity
            Mass per volume [kg m^-3].
        shape_factor : float, optional
            mu; 3 unless given [1].

        Returns
        -------
        Block

        Raises
        ------
        UnitsError, ComponentError
            As for :class:`Block`.
        """
        owner = f"{cls.__name__}.from_density"
        volume = 1.0
        for name, value in (("width", width), ("height", height), ("depth", depth)):
            volume *= to_si(value, LENGTH, owner=owner, name=name, condition=POSITIVE)
        per_volume = to_si(density, DENSITY, owner=owner, name="density", condition=POSITIVE)
        mass = f"{per_volume * volume!r} {MASS.unit}"
        return cls(width=width, height=height, mass=mass, shape_factor=shape_factor)

    @classmethod
    def from_size(
        cls,
        *,
        radius: QuantityLike,
        slenderness: RatioLike,
        mass: QuantityLike,
        shape_factor: RatioLike | None = None,
    ) -> Self:
        """Build a block from the paper's parameters R0 and H/B.

        Parameters
        ----------
        radius : str or Quantity
            R0, distance from a corner to the centre of mass [m].
        slenderness : float
            Height over width, H/B [1].
        mass : str or Quantity
            Mass [kg].
        shape_factor : float, optional
            mu; 3 unless given [1].

        Returns
        -------
        Block

        Raises
        ------
        UnitsError, ComponentError
            As for :class:`Block`.
        """
        owner = f"{cls.__name__}.from_size"
        metres = to_si(radius, LENGTH, owner=owner, name="radius", condition=POSITIVE)
        ratio = to_ratio(
            slenderness, owner=owner, name="slenderness", condition=POSITIVE, example="4"
        )
        width = 2.0 * metres / math.hypot(1.0, ratio)
        return cls(
            width=f"{width!r} {LENGTH.unit}",
            height=f"{width * ratio!r} {LENGTH.unit}",
            mass=mass,
            shape_factor=shape_factor,
        )

    @classmethod
    def from_outline(
        cls,
        points: Points,
        *,
        unit: str | None = None,
        density: QuantityLike | None = None,
        depth: QuantityLike | None = None,
        mass: QuantityLike | None = None,
    ) -> Self:
        """Build a body from its outline in the plane of rocking.

        Parameters
        ----------
        points : sequence of (x, y), or array with a unit
            Corners of the outline in their order around it, either way round: pairs of
            lengths, a Quantity of shape (n, 2), or such an array and a unit; x to the right,
            y upwards, from any origin. The first need not be repeated [m].
        unit : str, optional
            Of points that are bare numbers.
        density, depth : str or Quantity, optional
            Mass per volume [kg m^-3], and size perpendicular to the plane [m].
        mass : str or Quantity, optional
            Mass, instead of both, spread evenly over the outline [kg].

        Returns
        -------
        Block

        Raises
        ------
        UnitsError
            A coordinate or another value has no unit, or one of the wrong kind.
        ComponentError
            The outline has fewer than three points or no area, crosses or touches itself, or
            stands on a single point; the centre of mass is not above the base; not exactly
            one of mass and density is given; or as for :class:`Block`.

        Warns
        -----
        ModelWarning
            A corner beyond the base would touch the ground before the body overturns; the
            model lets it through.

        Notes
        -----
        The base goes from the leftmost to the rightmost of the lowest corners, so that a body
        on feet stands on these. Heights that differ by 1e-9 of the size or less are one. Mass,
        centre of mass and moment of inertia are exact, :eq:`eq-polygon-inertia`. A base that
        is inclined is refused.

        Examples
        --------
        >>> wall = Block.from_outline(
        ...     [("0 m", "0 m"), ("0.6 m", "0 m"), ("0.2 m", "2 m"), ("0 m", "2 m")],
        ...     density="2400 kg/m^3",
        ...     depth="1 m",
        ... )
        >>> round(wall.mass.m_as("kg"), 6), round(wall.eccentricity.m_as("m"), 4)
        (1920.0, -0.0833)
        """
        given = {"mass": mass, "density": density, "depth": depth}
        places = points if unit is None else (points, unit)
        return outline_body(places, given, f"{cls.__name__}.from_outline").build(cls)

    @classmethod
    def cylinder(
        cls,
        *,
        diameter: QuantityLike,
        height: QuantityLike,
        mass: QuantityLike | None = None,
        density: QuantityLike | None = None,
        wall_thickness: QuantityLike | None = None,
    ) -> Self:
        """Build a circular cylinder that rocks in a plane, such as a drum or a column.

        Parameters
        ----------
        diameter, height : str or Quantity
            Outer size [m].
        mass : str or Quantity, optional
            Mass [kg].
        density : str or Quantity, optional
            Mass per volume, instead of `mass` [kg m^-3].
        wall_thickness : str or Quantity, optional
            Of a tube, open at both ends; solid unless given [m].

        Returns
        -------
        Block

        Raises
        ------
        UnitsError
            A value has no unit, or one of the wrong kind.
        ComponentError
            A value is out of range, not exactly one of mass and density is given, or as for
            :class:`Block`.

        Notes
        -----
        Moment of inertia :eq:`eq-cylinder-inertia`. A real cylinder that comes down on its base
        rolls on along its rim, to a side (Srinivasan and Ruina 2008); the model keeps it in a
        plane, where it rocks from one end of a diameter to the other.

        Examples
        --------
        >>> drum = Block.cylinder(diameter="1 m", height="3 m", density="2700 kg/m^3")
        >>> round(drum.mass.m_as("t"), 3), round(drum.shape_factor, 3)
        (6.362, 3.077)
        """
        given = {
            "diameter": diameter,
            "height": height,
            "mass": mass,
            "density": density,
            "wall_thickness": wall_thickness,
        }
        return cylinder_body(given, f"{cls.__name__}.cylinder").build(cls)

    @classmethod
    def from_parts(cls, parts: Mapping[str, Part], *, base: Place | None = None) -> Self:
        """Build a body from parts that are fixed to one another, such as a cabinet and its load.

        Parameters
        ----------
        parts : mapping of str to mapping
            Every part by its name, told by one of

            - ``width`` and ``height``, for a rectangle, with its mass;
            - ``outline``, as the points of :meth:`from_outline`, with its mass;
            - ``body``, another Block, with its own mass, centre of mass and inertia;
            - ``mass`` alone for a point, or with ``inertia`` about its centre of mass.

            Mass is ``mass``, or ``density`` with ``depth``. ``at=(x, y)`` says where it is: the
            middle of the lower edge of a rectangle or of the base of a body, the origin of an
            outline, the centre of a point. x counts to the right, y from the ground up; both are
            zero unless given.
        base : pair of str or Quantity, optional
            x of its left and of its right end, where a body stands on more or less than the
            parts show, such as legs; unless given it goes from the leftmost to the rightmost
            corner on the ground [m].

        Returns
        -------
        Block

        Raises
        ------
        UnitsError
            A value has no unit, or one of the wrong kind.
        ComponentError
            A part is not told as above, reaches below the ground or stands beyond the base;
            none stands on the ground and no base is given; the centre of mass is not above
            the base; or as for :class:`Block`.

        Warns
        -----
        ModelWarning
            A corner of a part beyond the base would touch the ground before the body
            overturns; the model lets it through.

        Notes
        -----
        Masses add up by :eq:`eq-parts-centre` and :eq:`eq-parts-inertia`. Whether parts overlap
        is not checked: books stand within a bookcase. Of a ``body`` its base and its height are
        known, not its outline.

        Examples
        --------
        >>> bookcase = Block.from_parts(
        ...     {
        ...         "case": {"width": "0.8 m", "height": "1.9 m", "mass": "40 kg"},
        ...         "books": {
        ...             "width": "0.4 m",
        ...             "height": "0.3 m",
        ...             "mass": "25 kg",
        ...             "at": ("0.15 m", "1.5 m"),
        ...         },
        ...         "clock": {"mass": "5 kg", "at": ("-0.3 m", "1.9 m")},
        ...     }
        ... )
        >>> print(f"{bookcase.centre_height:.4f}, {bookcase.eccentricity:.4f}")
        1.2679 meter, 0.0321 meter
        """
        return body_of_parts(parts, base, f"{cls.__name__}.from_parts").build(cls)

    @property
    def slenderness(self) -> float:
        """Height over width, H/B [1]."""
        return self.si.height / self.si.width

    @property
    def maximum_restitution(self) -> float:
        """eps_max of Eq. (4) [1]."""
        return self.si.maximum_restitution


def _pair(
    owner: str, given: object, height: object, eccentricity: object
) -> tuple[QuantityLike, QuantityLike]:
    """Read a place of the centre of mass: height above the base, and eccentricity."""
    if height is not None or eccentricity is not None:
        msg = f"{owner}: centre_of_mass stands for centre_height and eccentricity; give it alone"
        raise ComponentError(msg)
    if isinstance(given, tuple | list) and len(cast("tuple[object, ...]", given)) == 2:
        return cast("tuple[QuantityLike, QuantityLike]", given)
    msg = (
        f"{owner}: centre_of_mass needs two lengths, the height above the base and how far it is "
        f"to the right of the middle, such as ('0.7 m', '0.05 m'); got {shown(given)}"
    )
    raise ComponentError(msg)
