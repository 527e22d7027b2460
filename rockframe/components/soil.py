"""The Winkler bed that stands for the soil."""

from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar, Self

from rockframe.arguments import one_of_words
from rockframe.components.base import Component, with_unit
from rockframe.components.damping import damping_ratio as read_damping_ratio
from rockframe.components.pads import one_of
from rockframe.units import (
    BED_DAMPING,
    BED_STIFFNESS,
    LENGTH,
    NOT_NEGATIVE,
    POSITIVE,
    SUBGRADE_MODULUS,
    QuantityLike,
    RatioLike,
    to_si,
)


class Separation(StrEnum):
    """Where the bed lets go of the base."""

    DISPLACEMENT = "displacement"
    PRESSURE = "pressure"


@dataclass(frozen=True)
class WinklerSoilSI:
    """A bed in SI units; of damping and damping ratio one is given, the other None."""

    stiffness: float
    damping: float | None
    damping_ratio: float | None
    separation: Separation


class WinklerSoil(Component[WinklerSoilSI]):
    """A bed of springs and dashpots side by side that take no tension.

    Parameters
    ----------
    stiffness : str or Quantity
        k0, stiffness of the bed per length of base in the plane of rocking: the
        subgrade modulus times the base's depth out of the plane [Pa].
    damping : str or Quantity, optional
        c0, damping coefficient per length of base [Pa s].
    damping_ratio : float, optional
        Damping ratio of the vertical motion, instead of `damping`:
        2 b c0 = 2 xi_s sqrt(2 b k0 m), with all mass that the bed carries [1].
    separation : {"displacement", "pressure"}
        Where the base and the bed part: above the level of the unloaded bed, as
        in the paper; or also where the dashpots would have to pull.

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
    >>> soil.si.stiffness
    80000000.0
    """

    noun: ClassVar[str] = "soil"

    def __init__(
        self,
        *,
        stiffness: QuantityLike,
        damping: QuantityLike | None = None,
        damping_ratio: RatioLike | None = None,
        separation: Separation | str = Separation.DISPLACEMENT,
    ) -> None:
        owner = "WinklerSoil"
        one_of(owner, damping=damping, damping_ratio=damping_ratio)
        k = to_si(stiffness, BED_STIFFNESS, owner=owner, name="stiffness", condition=POSITIVE)
        c = xi = None
        if damping is not None:
            c = to_si(damping, BED_DAMPING, owner=owner, name="damping", condition=NOT_NEGATIVE)
        if damping_ratio is not None:
            xi = read_damping_ratio(damping_ratio, owner=owner)
        rule = one_of_words(Separation, separation, owner=owner, name="separation")
        self._freeze(
            WinklerSoilSI(k, c, xi, rule),
            {
                "stiffness": with_unit(k, BED_STIFFNESS),
                "damping": with_unit(c, BED_DAMPING),
                "damping_ratio": xi,
                "separation": str(rule) if rule is not Separation.DISPLACEMENT else None,
            },
        )

    @classmethod
    def from_subgrade_modulus(
        cls,
        modulus: QuantityLike,
        *,
        depth: QuantityLike,
        damping: QuantityLike | None = None,
        damping_ratio: RatioLike | None = None,
        separation: Separation | str = Separation.DISPLACEMENT,
    ) -> Self:
        """Build the bed from the soil's subgrade modulus.

        Parameters
        ----------
        modulus : str or Quantity
            Pressure per settlement [Pa m^-1].
        depth : str or Quantity
            Depth of the base out of the plane of rocking [m].
        damping, damping_ratio, separation
            As for :class:`WinklerSoil`.

        Returns
        -------
        WinklerSoil

        Raises
        ------
        UnitsError, ComponentError
            As for :class:`WinklerSoil`.
        """
        owner = f"{cls.__name__}.from_subgrade_modulus"
        per_area = to_si(modulus, SUBGRADE_MODULUS, owner=owner, name="modulus", condition=POSITIVE)
        metres = to_si(depth, LENGTH, owner=owner, name="depth", condition=POSITIVE)
        return cls(
            stiffness=f"{per_area * metres!r} {BED_STIFFNESS.unit}",
            damping=damping,
            damping_ratio=damping_ratio,
            separation=separation,
        )

    @property
    def separation(self) -> Separation:
        """Where the bed lets go of the base."""
        return self.si.separation
