"""The two viscoelastic pads under the corners."""

from dataclasses import dataclass
from typing import ClassVar

from rockframe.components.base import Component, with_unit
from rockframe.components.damping import damping_ratio as read_damping_ratio
from rockframe.errors import ComponentError
from rockframe.units import (
    DAMPING,
    NOT_NEGATIVE,
    POSITIVE,
    STIFFNESS,
    UNIT_INTERVAL,
    QuantityLike,
    RatioLike,
    to_ratio,
    to_si,
)


@dataclass(frozen=True)
class TwoSpringSupportSI:
    """Pads in SI units; of each pair one member is given, the other None."""

    frequency_ratio: float | None
    stiffness: float | None
    damping_ratio: float | None
    damping: float | None
    restitution: float | None


class TwoSpringSupport(Component[TwoSpringSupportSI]):
    """Two equal Kelvin-Voigt pads, one under each corner, that take no tension.

    Parameters
    ----------
    frequency_ratio : float, optional
        beta = omega_v / omega, vertical over rocking frequency, Eq. (8) [1].
    stiffness : str or Quantity, optional
        Stiffness k of one pad, instead of `frequency_ratio` [N m^-1].
    damping_ratio : float, optional
        Vertical damping ratio xi, Eq. (7b) [1].
    damping : str or Quantity, optional
        Damping coefficient c of one pad, instead of `damping_ratio` [N s m^-1].
    restitution : float, optional
        Ratio eps of a landing corner's speeds after and before the impact,
        Eq. (2), above 0 and at most 1; eps_max, Eq. (4), unless given [1].

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or not exactly one of `frequency_ratio` and
        `stiffness`, and one of `damping_ratio` and `damping`, is given.

    Warns
    -----
    ModelWarning
        `damping_ratio` is above 1, more than critical: per cent may have been meant.

    Notes
    -----
    k = m omega_v^2 / 2 and c = xi m omega_v per pad, Eq. (7); with the two pads
    together xi is the damping ratio of the vertical motion.
    """

    noun: ClassVar[str] = "base"

    def __init__(
        self,
        *,
        frequency_ratio: RatioLike | None = None,
        stiffness: QuantityLike | None = None,
        damping_ratio: RatioLike | None = None,
        damping: QuantityLike | None = None,
        restitution: RatioLike | None = None,
    ) -> None:
        owner = "TwoSpringSupport"
        one_of(owner, frequency_ratio=frequency_ratio, stiffness=stiffness)
        one_of(owner, damping_ratio=damping_ratio, damping=damping)
        beta = k = xi = c = eps = None
        if frequency_ratio is not None:
            beta = to_ratio(
                frequency_ratio,
                owner=owner,
                name="frequency_ratio",
                condition=POSITIVE,
                example="20",
            )
        if stiffness is not None:
            k = to_si(stiffness, STIFFNESS, owner=owner, name="stiffness", condition=POSITIVE)
        if damping_ratio is not None:
            xi = read_damping_ratio(damping_ratio, owner=owner)
        if damping is not None:
            c = to_si(damping, DAMPING, owner=owner, name="damping", condition=NOT_NEGATIVE)
        if restitution is not None:
            eps = to_ratio(restitution, owner=owner, name="restitution", condition=UNIT_INTERVAL,
                           example="0.9")  # fmt: skip
        self._freeze(
            TwoSpringSupportSI(beta, k, xi, c, eps),
            {
                "frequency_ratio": beta,
                "stiffness": with_unit(k, STIFFNESS),
                "damping_ratio": xi,
                "damping": with_unit(c, DAMPING),
                "restitution": eps,
            },
        )

    @property
    def restitution(self) -> float | None:
        """Restitution eps, or None for the block's eps_max [1]."""
        return self.si.restitution


def one_of(owner: str, **pair: object) -> None:
    """Refuse to be given both or neither of a pair of arguments."""
    given = [name for name, value in pair.items() if value is not None]
    if len(given) == 1:
        return
    names = " or ".join(pair)
    found = "both were" if given else "neither was"
    msg = f"{owner}: give {names}; {found} given"
    raise ComponentError(msg)
