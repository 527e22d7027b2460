"""The two viscoelastic pads under the corners."""

from typing import ClassVar

from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.parameters import (
    DampingRatio,
    Parameter,
    Ratio,
    SIValues,
    check_frictions,
    friction_at_rest,
    friction_of_slip,
)
from rockframe.units import (
    DAMPING,
    NOT_NEGATIVE,
    POSITIVE,
    STIFFNESS,
    UNIT_INTERVAL,
    QuantityLike,
    RatioLike,
)


class TwoSpringSupport(Component):
    """Two equal Kelvin-Voigt pads, one under each corner, that take no tension.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, not exactly one of `frequency_ratio` and `stiffness`, and one of
        `damping_ratio` and `damping`, is given, or `kinetic_friction` without `friction` or above
        it.

    Warns
    -----
    ModelWarning
        `damping_ratio` is above 1, more than critical: per cent may have been meant.

    Notes
    -----
    k = m omega_v^2 / 2 and c = xi m omega_v per pad, Eq. (7); with the two pads
    together xi is the damping ratio of the vertical motion.

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
        OneOf("frequency_ratio", "stiffness"),
        OneOf("damping_ratio", "damping"),
    )

    frequency_ratio = Ratio(
        POSITIVE,
        doc="beta = omega_v / omega, vertical over rocking frequency, Eq. (8).",
        default=None,
        example="20",
    )
    stiffness = Parameter(
        STIFFNESS,
        POSITIVE,
        doc="Stiffness k of one pad, instead of `frequency_ratio`.",
        default=None,
    )
    damping_ratio = DampingRatio(doc="Vertical damping ratio xi, Eq. (7b).")
    damping = Parameter(
        DAMPING,
        NOT_NEGATIVE,
        doc="Damping coefficient c of one pad, instead of `damping_ratio`.",
        default=None,
    )
    restitution = Ratio(
        UNIT_INTERVAL,
        doc="Ratio eps of a landing corner's speeds after and before the impact, Eq. (2); "
        "eps_max, Eq. (4), unless given.",
        default=None,
        example="0.9",
    )

    friction = friction_at_rest("the block")
    kinetic_friction = friction_of_slip()

    def __init__(
        self,
        *,
        frequency_ratio: RatioLike | None = None,
        stiffness: QuantityLike | None = None,
        damping_ratio: RatioLike | None = None,
        damping: QuantityLike | None = None,
        restitution: RatioLike | None = None,
        friction: RatioLike | None = None,
        kinetic_friction: RatioLike | None = None,
    ) -> None:
        super().__init__(
            frequency_ratio=frequency_ratio,
            stiffness=stiffness,
            damping_ratio=damping_ratio,
            damping=damping,
            restitution=restitution,
            friction=friction,
            kinetic_friction=kinetic_friction,
        )

    def _numbers(self, given: SIValues) -> SIValues:
        return check_frictions("TwoSpringSupport", given)
