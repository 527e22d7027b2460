"""A bed of soil in words."""

from typing import TYPE_CHECKING

from rockframe.components.soil import Separation
from rockframe.system.support import BaseWords
from rockframe.system.words import uplift_words

if TYPE_CHECKING:
    from rockframe.system.soil import BedSupport

_SEPARATION = {
    Separation.DISPLACEMENT: "above the level of the unloaded bed",
    Separation.PRESSURE: "above the level of the unloaded bed, and where the dashpots would pull",
}


def soil_words(bed: "BedSupport") -> BaseWords:
    """Tell a bed under a body.

    Parameters
    ----------
    bed : BedSupport
        Its numbers.

    Returns
    -------
    BaseWords
    """
    one_sided = (
        "Eq. (19), corrected: inertia I_O + m (h + b a)^2 and its a'^2 term in (19b), (19e), "
        "(19f), (19h); resultants over the part in contact"
    )
    if bed.load.options.small:
        one_sided = (
            "Eq. (19), corrected: (19e), (19f), (19h); inertia I_M and heights to second "
            "order, so that energies balance"
        )
    return BaseWords(
        law="soil's resultants as in Eqs. (18) and (19)",
        equations=[
            ("full", "Eq. (18) at small rotation; at finite rotation the same bed with "
             "x' = h cos(a), and its resultants over the whole base"),
            ("left, right", one_sided),
            ("flight", "free fall and constant rotation rate"),
            ("contact", f"without impact law; the base parts from the bed "
             f"{_SEPARATION[bed.separation]}"),
        ],
        uplift=("uplift angle, arcsin(delta/b)", uplift_words(bed.uplift_angle)),
        numbers=_numbers(bed),
        left_out=["yielding of the soil", "impact on the soil"],
        body="body",
        end="end",
    )  # fmt: skip


def _numbers(bed: "BedSupport") -> list[tuple[str, str]]:
    body = bed.load.body
    return [
        ("mass on the soil", f"{body.mass:.6g} kg, centre {body.centre_height:.6g} m above it"),
        ("soil stiffness k0, damping c0", f"{bed.stiffness:.6g} Pa, {bed.damping:.6g} Pa s"),
        ("settlement delta", f"{bed.settlement:.6g} m"),
        *bed.vibrations("vertical vibration, Eq. (18a)", "rocking in full contact, Eq. (18b)"),
    ]
