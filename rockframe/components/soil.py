"""The Winkler bed that stands for the soil."""

from enum import StrEnum
from typing import ClassVar, Literal, Self, TypeAlias

from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.parameters import (
    Choice,
    DampingRatio,
    Parameter,
    SIValues,
    check_frictions,
    friction_at_rest,
    friction_of_slip,
)
from rockframe.proposals import hinted
from rockframe.units import (
    BED_DAMPING,
    BED_STIFFNESS,
    LENGTH,
    NOT_NEGATIVE,
    POSITIVE,
    SUBGRADE_MODULUS,
    Quantity,
    QuantityLike,
    RatioLike,
    quantity,
    to_si,
)


class Separation(StrEnum):
    """Where the bed lets go of the base."""

    DISPLACEMENT = "displacement"
    PRESSURE = "pressure"


SeparationLike: TypeAlias = Separation | Literal["displacement", "pressure"]


class WinklerSoil(Component):
    """A bed of springs and dashpots side by side that take no tension.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or not exactly one of `damping` and
        `damping_ratio` is given.

    Warns
    -----
    ModelWarning
        `damping_ratio` is above 1, more than critical: per cent may have been meant.

    Examples
    --------
    >>> soil = WinklerSoil.from_subgrade_modulus("20 MN/m^3", depth="4 m", damping_ratio=0.2)
    >>> soil.stiffness.to("MPa")
    <Quantity(80.0, 'megapascal')>
    """

    noun: ClassVar[str] = "soil"
    alternatives: ClassVar[tuple[OneOf, ...]] = (OneOf("damping", "damping_ratio"),)

    stiffness = Parameter(
        BED_STIFFNESS,
        POSITIVE,
        doc="k0, stiffness of the bed per length of base in the plane of rocking: the subgrade "
        "modulus times the base's depth out of the plane.",
    )
    damping = Parameter(
        BED_DAMPING,
        NOT_NEGATIVE,
        doc="c0, damping coefficient per length of base.",
        default=None,
    )
    damping_ratio = DampingRatio(
        doc="Damping ratio of the vertical motion, instead of `damping`: "
        "2 b c0 = 2 xi_s sqrt(2 b k0 m), with all mass that the bed carries.",
    )
    separation = Choice(
        Separation.DISPLACEMENT,
        doc="Where the base and the bed part: above the level of the unloaded bed, as in the "
        "paper; or also where the dashpots would have to pull.",
    )

    friction = friction_at_rest("what stands on it")
    kinetic_friction = friction_of_slip()

    _depth: float | None = None

    @hinted(
        subgrade_modulus="WinklerSoil.from_subgrade_modulus('20 MN/m^3', depth='4 m', ...) takes "
        "it, with the depth of the base",
        modulus="WinklerSoil.from_subgrade_modulus('20 MN/m^3', depth='4 m', ...) takes it, with "
        "the depth of the base",
    )
    def __init__(
        self,
        *,
        stiffness: QuantityLike,
        damping: QuantityLike | None = None,
        damping_ratio: RatioLike | None = None,
        separation: SeparationLike = Separation.DISPLACEMENT,
        friction: RatioLike | None = None,
        kinetic_friction: RatioLike | None = None,
    ) -> None:
        super().__init__(
            stiffness=stiffness,
            damping=damping,
            damping_ratio=damping_ratio,
            separation=separation,
            friction=friction,
            kinetic_friction=kinetic_friction,
        )

    def _numbers(self, given: SIValues) -> SIValues:
        return check_frictions("WinklerSoil", given)

    @classmethod
    def from_subgrade_modulus(
        cls,
        modulus: QuantityLike,
        *,
        depth: QuantityLike,
        damping: QuantityLike | None = None,
        damping_ratio: RatioLike | None = None,
        separation: SeparationLike = Separation.DISPLACEMENT,
        friction: RatioLike | None = None,
        kinetic_friction: RatioLike | None = None,
    ) -> Self:
        """Build the bed from the soil's subgrade modulus.

        Parameters
        ----------
        modulus : str or Quantity
            Pressure per settlement [Pa m^-1].
        depth : str or Quantity
            Depth of the base out of the plane of rocking [m].
        damping, damping_ratio, separation, friction, kinetic_friction
            As for :class:`WinklerSoil`.

        Returns
        -------
        WinklerSoil

        Raises
        ------
        UnitsError, ComponentError
            As for :class:`WinklerSoil`.

        Examples
        --------
        >>> import rockframe as rf
        >>> soil = rf.WinklerSoil.from_subgrade_modulus("20 MN/m^3", depth="4 m", damping_ratio=0.2)
        >>> soil.stiffness.to("MPa").round(9)
        <Quantity(80.0, 'megapascal')>
        """
        owner = f"{cls.__name__}.from_subgrade_modulus"
        per_area = to_si(modulus, SUBGRADE_MODULUS, owner=owner, name="modulus", condition=POSITIVE)
        metres = to_si(depth, LENGTH, owner=owner, name="depth", condition=POSITIVE)
        soil = cls(
            stiffness=f"{per_area * metres!r} {BED_STIFFNESS.unit}",
            damping=damping,
            damping_ratio=damping_ratio,
            separation=separation,
            friction=friction,
            kinetic_friction=kinetic_friction,
        )
        object.__setattr__(soil, "_depth", metres)
        return soil

    @property
    def depth(self) -> Quantity | None:
        """Depth of the base out of the plane, where the bed was built with it [m]."""
        return None if self._depth is None else quantity(self._depth, LENGTH)
