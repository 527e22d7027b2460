"""Bases under bodies: rigid ground, pads, soil, and a cap between building and soil."""

from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar, Literal, Self, TypeAlias

from rockframe.case_arrays import hypot
from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.parameters import (
    Choice,
    DampingRatio,
    Parameter,
    Ratio,
    SIValues,
)
from rockframe.errors import ComponentError
from rockframe.notebook import Polygon, rectangle
from rockframe.units import (
    BED_DAMPING,
    BED_STIFFNESS,
    DAMPING,
    DENSITY,
    LENGTH,
    MASS,
    NOT_NEGATIVE,
    POSITIVE,
    STIFFNESS,
    SUBGRADE_MODULUS,
    THICKNESS,
    UNIT_INTERVAL,
    Quantity,
    QuantityLike,
    RatioLike,
    quantity,
    quantity_text,
    to_si,
)


class Impact(StrEnum):
    """Tangential motion of a corner during an impact: limited by friction, or held."""

    COULOMB = "coulomb"
    STICK = "stick"


ImpactLike: TypeAlias = Impact | Literal["coulomb", "stick"]


def _static_friction(of: str) -> Ratio[None]:
    """Declare a static coefficient of friction under a body."""
    words = f"Coefficient of friction under {of} while it does not slip; without one it is held."
    return Ratio(NOT_NEGATIVE, doc=words, default=None, example="0.5")


def _kinetic_friction() -> Ratio[None]:
    """Declare a kinetic coefficient of friction."""
    words = "Kinetic coefficient of friction, of slip; the static one unless given."
    return Ratio(NOT_NEGATIVE, doc=words, default=None, example="0.45")


def _check_frictions(owner: str, numbers: SIValues) -> SIValues:
    """Refuse a kinetic friction without a static one, or above it."""
    static, kinetic = numbers.friction, numbers.kinetic_friction
    if kinetic is not None and (static is None or kinetic > static):
        found = "is not given" if static is None else f"is {static:.6g}"
        msg = (
            f"{owner}: kinetic_friction must be at most the friction at rest, which {found}; got "
            f"{kinetic:.6g}"
        )
        raise ComponentError(msg)
    return numbers


class RigidGround(Component):
    """Rigid ground under a block, which rocks on it (Housner's model) and may slide.

    A scene of only a block has rigid ground on which it cannot slide. This component is needed
    only to set restitution or friction.

    Raises
    ------
    UnitsError
        Not a pure ratio.
    ComponentError
        `restitution` is outside (0, 1], a coefficient of friction is negative, or
        `kinetic_friction` is given without `friction` or above it.

    Examples
    --------
    >>> import rockframe as rf
    >>> low = rf.Block(width="2 m", height="1 m", mass="5 t")
    >>> pulse = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")
    >>> run = rf.System(low, rf.RigidGround(friction=0.3)).simulate(pulse, accuracy="fast")
    >>> run.attrs["verdict"].split(":")[0]
    'Slid 0.0338 m to the right and back, did not overturn'
    """

    noun: ClassVar[str] = "base"

    restitution: Ratio[None] = Ratio(
        UNIT_INTERVAL,
        doc="Ratio of the angular velocities after and before an impact without slip; the "
        "block's eps_max, Eq. (4), unless given.",
        default=None,
        example="0.9",
    )
    friction: Ratio[None] = _static_friction("the block")
    kinetic_friction: Ratio[None] = _kinetic_friction()
    impact: Choice[Impact, ImpactLike] = Choice(
        Impact.COULOMB,
        doc="Whether a corner slips during its impact against kinetic friction, or is held.",
    )

    def _numbers(self, numbers: SIValues) -> SIValues:
        return _check_frictions("RigidGround", numbers)


class TwoSpringSupport(Component):
    """Two equal Kelvin-Voigt pads, one under each corner, that take no tension.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range; not exactly one of `frequency_ratio` and `stiffness`, and one of
        `damping_ratio` and `damping`, is given; or `kinetic_friction` is given without `friction`
        or above it.

    Warns
    -----
    ModelWarning
        `damping_ratio` is above 1, more than critical: per cent may have been meant.

    Notes
    -----
    k = m omega_v^2 / 2 and c = xi m omega_v per pad, Eq. (7), so that xi is the damping ratio of
    the vertical motion on both pads.

    Examples
    --------
    >>> import rockframe as rf
    >>> pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
    >>> stiff = rf.TwoSpringSupport(stiffness="5 MN/m", damping="20 kN*s/m", friction=0.4)
    >>> stiff.friction
    0.4
    """

    noun: ClassVar[str] = "base"
    alternatives: ClassVar[tuple[OneOf, ...]] = (
        OneOf(
            "frequency_ratio", "stiffness",
            hint="rigid contact with friction or a restitution is RigidGround(...)",
        ),
        OneOf("damping_ratio", "damping"),
    )  # fmt: skip

    frequency_ratio: Ratio[None] = Ratio(
        POSITIVE,
        doc="beta = omega_v / omega, vertical over rocking frequency, Eq. (8).",
        default=None,
        example="20",
    )
    stiffness: Parameter[None] = Parameter(
        STIFFNESS,
        POSITIVE,
        doc="Stiffness k of one pad, instead of `frequency_ratio`.",
        default=None,
    )
    damping_ratio: DampingRatio = DampingRatio(doc="Vertical damping ratio xi, Eq. (7b).")
    damping: Parameter[None] = Parameter(
        DAMPING,
        NOT_NEGATIVE,
        doc="Damping coefficient c of one pad, instead of `damping_ratio`.",
        default=None,
    )
    restitution: Ratio[None] = Ratio(
        UNIT_INTERVAL,
        doc="Ratio eps of a landing corner's speeds after and before the impact, Eq. (2); "
        "eps_max, Eq. (4), unless given.",
        default=None,
        example="0.9",
    )

    friction: Ratio[None] = _static_friction("the block")
    kinetic_friction: Ratio[None] = _kinetic_friction()

    def _numbers(self, numbers: SIValues) -> SIValues:
        return _check_frictions("TwoSpringSupport", numbers)


@dataclass(frozen=True)
class CushionCapSI:
    """A cap in SI units; a width of None means that of the building."""

    width: float | None
    height: float
    mass: float | None
    mass_per_width: float | None

    def mass_at(self, width: float) -> float:
        """Return the mass of a cap of a width [kg]."""
        return self.mass if self.mass is not None else (self.mass_per_width or 0.0) * width

    def inertia_at(self, width: float) -> float:
        """Return the moment of inertia of a solid cap about its centre [kg m^2]."""
        diagonal = hypot(width, self.height)
        return self.mass_at(width) * diagonal * diagonal / 12.0


class CushionCap(Component[CushionCapSI]):
    """A rigid, solid slab that distributes the weight of a building over the soil.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or not exactly one of `mass` and `density`
        (with `depth`) is given.

    Examples
    --------
    >>> cap = CushionCap(height="0.9 m", density="2500 kg/m^3", depth="4 m", width="5 m")
    >>> cap.si.mass_at(5.0)
    45000.0
    """

    noun: ClassVar[str] = "cap"
    alternatives: ClassVar[tuple[OneOf, ...]] = (OneOf("mass", ("density", "depth")),)

    height: Parameter = Parameter(THICKNESS, NOT_NEGATIVE, doc="Height H_c; zero for a thin plate.")
    mass: Parameter[None] = Parameter(
        MASS, NOT_NEGATIVE, doc="Mass m_c; zero for a plate without mass.", default=None
    )
    width: Parameter[None] = Parameter(
        LENGTH,
        POSITIVE,
        doc="Width B_c in the plane of rocking; the building's unless given.",
        default=None,
    )
    density: Parameter[None] = Parameter(
        DENSITY, POSITIVE, doc="Mass per volume, with `depth` instead of `mass`.", default=None
    )
    depth: Parameter[None] = Parameter(
        LENGTH, POSITIVE, doc="Size out of the plane of rocking.", default=None
    )

    def _shapes(self) -> list[Polygon]:
        width = self.si.width
        return [] if width is None else [Polygon("cap", rectangle(0.5 * width, self.si.height))]

    def _numbers(self, numbers: SIValues) -> CushionCapSI:
        by_density = numbers.density is not None
        per_width = numbers.density * numbers.depth * numbers.height if by_density else None
        return CushionCapSI(numbers.width, numbers.height, numbers.mass, per_width)


class Separation(StrEnum):
    """Criterion for the loss of contact between bed and base."""

    DISPLACEMENT = "displacement"
    PRESSURE = "pressure"


SeparationLike: TypeAlias = Separation | Literal["displacement", "pressure"]


class WinklerSoil(Component):
    """A Winkler bed: independent springs and dashpots that take no tension.

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
    >>> print(soil.stiffness.to("MPa"))
    80.0 megapascal
    """

    noun: ClassVar[str] = "soil"
    alternatives: ClassVar[tuple[OneOf, ...]] = (OneOf("damping", "damping_ratio"),)

    stiffness: Parameter = Parameter(
        BED_STIFFNESS,
        POSITIVE,
        doc="k0, stiffness of the bed per length of base in the plane of rocking: the subgrade "
        "modulus times the base's depth out of the plane.",
    )
    damping: Parameter[None] = Parameter(
        BED_DAMPING,
        NOT_NEGATIVE,
        doc="c0, damping coefficient per length of base.",
        default=None,
    )
    damping_ratio: DampingRatio = DampingRatio(
        doc="Damping ratio of the vertical motion, instead of `damping`: "
        "2 b c0 = 2 xi_s sqrt(2 b k0 m), with the whole mass m on the bed.",
    )
    separation: Choice[Separation, SeparationLike] = Choice(
        Separation.DISPLACEMENT,
        doc="Where the base loses contact: above the level of the unloaded bed, as in the "
        "paper; or also where springs and dashpots together would pull.",
    )

    friction: Ratio[None] = _static_friction("what stands on it")
    kinetic_friction: Ratio[None] = _kinetic_friction()

    _depth: float | None = None

    def _numbers(self, numbers: SIValues) -> SIValues:
        return _check_frictions("WinklerSoil", numbers)

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
        """Build the bed from the subgrade modulus of the soil.

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
        >>> print(soil.stiffness.to("MPa").round(9))
        80.0 megapascal
        """
        owner = f"{cls.__name__}.from_subgrade_modulus"
        per_area = to_si(modulus, SUBGRADE_MODULUS, owner=owner, name="modulus", condition=POSITIVE)
        metres = to_si(depth, LENGTH, owner=owner, name="depth", condition=POSITIVE)
        soil = cls(
            stiffness=quantity_text(per_area * metres, BED_STIFFNESS),
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
        """Depth of the base out of the plane, if the bed was built with it, else None [m]."""
        return None if self._depth is None else quantity(self._depth, LENGTH)
