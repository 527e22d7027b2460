"""The rigid block."""

from collections.abc import Collection, Mapping
from typing import Any, ClassVar, Final, Self, cast

from rockframe.arguments import checked_mapping
from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.block_numbers import (
    BlockSI,
    block_numbers,
    inertia_warnings,
    width_from_radius,
)
from rockframe.components.parameters import (
    DERIVED,
    Declared,
    Derived,
    Parameter,
    Ratio,
    SIValues,
    checked_si,
)
from rockframe.components.shapes import outline, parts
from rockframe.errors import ComponentError, ModelWarning, short_repr, warn
from rockframe.notebook import Polygon, rectangle
from rockframe.suggestions import Constructor
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
    quantity,
    quantity_text,
    to_ratio,
    to_si,
)

_SIZES: Final = frozenset({"width", "height", "mass"})
"""Parameters on which a moment of inertia depends."""
_SIDES: Final = ("width", "height")


class _SizeParameters:
    """Quantities that determine width and height together, as in :meth:`Block.from_size`."""

    radius = Parameter(LENGTH, POSITIVE, doc="R0, distance from a corner to the centre of mass.")
    slenderness = Ratio(POSITIVE, doc="Height over width, H/B.", example="4")


_SIZE_PARAMETERS: Final = {
    name: value for name, value in vars(_SizeParameters).items() if isinstance(value, Declared)
}


class Block(Component[BlockSI]):
    """A rigid rectangular block, or a body that rocks like one.

    Other Parameters
    ----------------
    centre_of_mass : pair of str or Quantity, optional
        `centre_height` and `eccentricity` together, such as ``("0.7 m", "0.05 m")`` [m].

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
        No body within the rectangle of width and height can have the given `shape_factor`
        or `inertia`, :eq:`eq-greatest-inertia`; it is used as given.

    Notes
    -----
    A block rocks only while the greatest restitution, Eq. (4), is positive; for
    a solid rectangle that is H/B > sqrt(2)/2, Eq. (5).

    The moment of inertia about the centre of mass is that of the solid rectangle, wherever the
    centre of mass is, unless `inertia` or `shape_factor` is given. :meth:`from_outline`,
    :meth:`from_parts` and :meth:`cylinder` compute both.

    Examples
    --------
    >>> block = Block(width="2.4254 m", height="9.7014 m", mass="50 t")
    >>> round(block.overturning_angle.m_as("rad"), 4)
    0.245
    >>> print(block.replace(mass="60 t").mass.to("t"))
    60.0 metric_ton
    """

    noun: ClassVar[str] = "body"
    alternatives: ClassVar[tuple[OneOf, ...]] = (OneOf("shape_factor", "inertia", required=False),)

    width: Parameter = Parameter(LENGTH, POSITIVE, doc="Base width B.")
    height: Parameter = Parameter(LENGTH, POSITIVE, doc="Height H.")
    mass: Parameter = Parameter(MASS, POSITIVE, doc="Mass m.")
    shape_factor: Ratio[Derived] = Ratio(
        POSITIVE,
        doc="mu = m R0^2 / I_O; 3, the solid rectangle's, unless given.",
        default=DERIVED,
        example="3",
    )
    inertia: Parameter[Derived] = Parameter(
        INERTIA,
        POSITIVE,
        doc="Moment of inertia about the centre of mass I_O, instead of `shape_factor`.",
        default=DERIVED,
    )
    centre_height: Parameter[Derived] = Parameter(
        LENGTH.like("1.8 m"),
        POSITIVE,
        doc="Height of the centre of mass above the base; H/2 unless given.",
        default=DERIVED,
    )
    eccentricity: Parameter[Derived] = Parameter(
        LENGTH.like("0.1 m"),
        doc="Distance of the centre of mass to the right of the middle of the base; 0 unless "
        "given.",
        default=DERIVED,
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
            centre_height, eccentricity = self._read_centre_of_mass(
                centre_of_mass, centre_height, eccentricity
            )
        super().__init__(
            width=width, height=height, mass=mass, shape_factor=shape_factor, inertia=inertia,
            centre_height=centre_height, eccentricity=eccentricity,
        )  # fmt: skip

    @classmethod
    def _read_centre_of_mass(
        cls, value: object, height: object, eccentricity: object
    ) -> tuple[QuantityLike, QuantityLike]:
        """Read the position of the centre of mass: height above the base, and eccentricity."""
        if height is not None or eccentricity is not None:
            words = "gives centre_height and eccentricity; give it alone"
        elif isinstance(value, tuple | list) and len(cast("tuple[object, ...]", value)) == 2:
            return cast("tuple[QuantityLike, QuantityLike]", value)
        else:
            words = (
                "needs two lengths, the height above the base and the distance to the right of its "
                f"middle, such as ('0.7 m', '0.05 m'); got {short_repr(value)}"
            )
        msg = f"{cls.__name__}: centre_of_mass {words}"
        raise ComponentError(msg)

    @property
    def centre_of_mass(self) -> tuple[Quantity, Quantity]:
        """Height of the centre of mass above the base, and its eccentricity to the right [m]."""
        return self.centre_height, self.eccentricity

    def replace(self, **changes: Any) -> Self:
        """Build a block with some parameters changed.

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
            The block has a given `inertia`, as blocks from shapes do, and either `width`,
            `height` or `mass` is changed without `inertia` or `shape_factor`, or `height` is
            changed without a given `centre_height`.

        Examples
        --------
        >>> block = Block(width="0.8 m", height="4 m", mass="2 t")
        >>> print(block.replace(centre_of_mass=("1.5 m", "0.05 m")).eccentricity)
        0.05 meter
        """
        if "centre_of_mass" in changes:
            changes["centre_height"], changes["eccentricity"] = self._read_centre_of_mass(
                changes.pop("centre_of_mass"),
                changes.get("centre_height"),
                changes.get("eccentricity"),
            )
        block = super().replace(**changes)
        same = {name for name in _SIZES if getattr(block.si, name) == getattr(self.si, name)}
        if unchanged := self.left_behind(changes.keys() - same):
            values = " and ".join(
                f"{name}, {getattr(self.si, name):.4g} {self._declared[name].unit}"
                for name in unchanged
            )
            ways = ", and ".join(unchanged).replace("inertia", "inertia or shape_factor")
            msg = (
                f"{type(self).__name__}.replace: kept from the old size and mass: {values}; give "
                f"{ways}, too"
            )
            warn(msg, ModelWarning)
        return block

    @classmethod
    def varied(cls) -> Mapping[str, Declared[Any, Any, Any]]:
        """Return the declarations of all parameters, and of `radius` and `slenderness`.

        Returns
        -------
        mapping

        Examples
        --------
        >>> set(Block.varied()) - set(Block.declared()) == {"radius", "slenderness"}
        True
        """
        return {**super().varied(), **_SIZE_PARAMETERS}

    def too_many(self, changed: Collection[str]) -> tuple[str, ...]:
        """Name changed quantities that together overdetermine width and height.

        Parameters
        ----------
        changed : collection of str
            Names of changed quantities.

        Returns
        -------
        tuple of str

        Examples
        --------
        >>> block = Block(width="0.8 m", height="4 m", mass="2 t")
        >>> block.too_many(["radius", "width", "mass"])
        ('radius', 'width')
        """
        named = [name for name in (*_SIZE_PARAMETERS, *_SIDES) if name in changed]
        sides = sum(name in _SIDES for name in named)
        twice = sides == 2 and "slenderness" in named
        return tuple(named) if twice or ("radius" in named and sides) else ()

    def with_si(self, values: Mapping[str, Any]) -> Self:
        """Build a block with some parameters changed, without warnings.

        Parameters
        ----------
        values : mapping of str to float
            Numbers in SI units by the names of parameters. A `slenderness` leaves the `radius`
            unchanged, or the side that is given with it. A `radius` leaves the slenderness
            unchanged.

        Returns
        -------
        Block

        Raises
        ------
        ComponentError
            A value is out of range, or does not fit the others.

        Examples
        --------
        >>> block = Block(width="0.8 m", height="4 m", mass="2 t")
        >>> print(block.with_si({"slenderness": 4.0, "width": 1.0}).height)
        4.0 meter
        """
        example = "{'width': 0.8}"
        values = checked_mapping(values, owner="Block.with_si", name="values", example=example)
        sizes = {
            name: checked_si(parameter, values[name], type(self).__name__)
            for name, parameter in _SIZE_PARAMETERS.items()
            if name in values
        }
        if not sizes:
            return super().with_si(values)
        others = {name: value for name, value in values.items() if name not in _SIZE_PARAMETERS}
        return super().with_si({**others, **self._width_and_height(sizes, others)})

    def _width_and_height(
        self, sizes: Mapping[str, Any], others: Mapping[str, Any]
    ) -> dict[str, Any]:
        """Compute width and height from radius and slenderness, or from a side and slenderness.

        The radius is the distance to the centre of mass, whose given height does not change.
        """
        ratio = sizes.get("slenderness", self.slenderness)
        if "width" in others:
            return {"height": ratio * others["width"]}
        if "height" in others:
            return {"width": others["height"] / ratio}
        radius = sizes.get("radius", self.si.radius)
        centre = others.get("centre_height", self.given.centre_height)
        width = width_from_radius(type(self).__name__, radius, ratio, centre)
        return {"width": width, "height": ratio * width}

    def left_behind(self, changed: Collection[str]) -> tuple[str, ...]:
        """Name given parameters that depend on changed ones, but would keep their values.

        A given `inertia` depends on `width`, `height` and `mass`. A `centre_height` that is given
        with it depends on `height`.

        Parameters
        ----------
        changed : collection of str
            Names of changed parameters.

        Returns
        -------
        tuple of str
            ``"inertia"``, ``"centre_height"``, both or none.

        Examples
        --------
        >>> block = Block(width="0.8 m", height="4 m", mass="2 t", inertia="2800 kg*m^2")
        >>> block.left_behind(["width"]), block.left_behind(["width", "inertia"])
        (('inertia',), ())
        """
        super().left_behind(changed)
        if self.given.inertia is None:
            return ()
        if any(name in changed for name in _SIZE_PARAMETERS):
            changed = {*changed, *_SIDES}
        unchanged: list[str] = []
        if _SIZES.intersection(changed) and not {"inertia", "shape_factor"}.intersection(changed):
            unchanged.append("inertia")
        centred = self.given.centre_height is None or "centre_height" in changed
        if "height" in changed and not centred:
            unchanged.append("centre_height")
        return tuple(unchanged)

    def _numbers(self, numbers: SIValues) -> BlockSI:
        return block_numbers(numbers, type(self).__name__)

    def _cautions(self) -> list[str]:
        given = self.given.shape_factor is not None or self.given.inertia is not None
        return [*super()._cautions(), *(self._inertia_cautions() if given else [])]

    def _inertia_cautions(self) -> list[str]:
        """Warn of a given inertia that no body within the rectangle can have."""
        return inertia_warnings(self.si)

    def _shapes(self) -> list[Polygon]:
        si = self.si
        centre = [(si.eccentricity, si.centre_height)]
        return [Polygon("block", rectangle(si.half_width, si.height)), Polygon("block", centre)]

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

        Examples
        --------
        >>> stone = {"depth": "0.5 m", "density": "2.5 t/m^3"}
        >>> print(Block.from_density(width="1 m", height="4 m", **stone).mass)
        5000.0 kilogram
        """
        owner = f"{cls.__name__}.from_density"
        volume = 1.0
        for name, value in (("width", width), ("height", height), ("depth", depth)):
            volume *= to_si(value, LENGTH, owner=owner, name=name, condition=POSITIVE)
        per_volume = to_si(density, DENSITY, owner=owner, name="density", condition=POSITIVE)
        mass = quantity_text(per_volume * volume, MASS)
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
        """Build a block from the parameters R0 and H/B of the paper.

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

        Examples
        --------
        >>> print(Block.from_size(radius="5 m", slenderness=4, mass="50 t").width.round(4))
        2.4254 meter
        """
        owner = f"{cls.__name__}.from_size"
        metres = to_si(radius, LENGTH, owner=owner, name="radius", condition=POSITIVE)
        ratio = to_ratio(
            slenderness, owner=owner, name="slenderness", condition=POSITIVE, example="4"
        )
        width = width_from_radius(owner, metres, ratio)
        return cls(
            width=quantity_text(width, LENGTH),
            height=quantity_text(width * ratio, LENGTH),
            mass=mass,
            shape_factor=shape_factor,
        )

    # constructors from shapes are functions with their own documentation; their first argument
    # is the class

    from_outline = Constructor(outline.from_outline)
    cylinder = Constructor(outline.cylinder)
    from_parts = Constructor(parts.from_parts)

    @property
    def radius(self) -> Quantity:
        """R0, distance from an end of the base to the point h above its middle [m]."""
        return quantity(self.si.radius, LENGTH)

    @property
    def overturning_angle(self) -> Quantity:
        """Theta = arctan(b/h), Eq. (1); the lesser of both sides [rad]."""
        return quantity(self.si.overturning_angle, ANGLE)

    @property
    def frequency(self) -> Quantity:
        """Angular frequency omega under standard gravity, Eq. (6) [rad s^-1]."""
        return quantity(self.si.frequency, ANGULAR_VELOCITY)

    @property
    def slenderness(self) -> float:
        """Height over width, H/B [1]."""
        return self.si.height / self.si.width

    @property
    def maximum_restitution(self) -> float:
        """eps_max of Eq. (4); the lesser of both corners [1]."""
        return self.si.maximum_restitution
