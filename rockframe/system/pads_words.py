"""Two pads in words."""

from typing import TYPE_CHECKING

from rockframe.system.support import BaseWords
from rockframe.system.words import uplift_words

if TYPE_CHECKING:
    from rockframe.system.pads import PadSupport


def pads_words(pads: "PadSupport") -> BaseWords:
    """Tell two pads under a block.

    Parameters
    ----------
    pads : PadSupport
        Their numbers.

    Returns
    -------
    BaseWords
    """
    return BaseWords(
        law="pad forces as in Eqs. (12) and (15)",
        equations=[
            ("full", "Eq. (12), corrected: 2 zeta sin(a)/(beta omega) in (12a); sin(2a)/2, "
             "beta^2 omega^4/g and 2 zeta/(beta omega) in (12b)"),
            ("left", "Eq. (15), upper signs, corrected: [cos(theta) - cos(theta + a) + ...] in "
             "(15a); the sign of the bearing corner and omega^4 in (15b)"),
            ("right", "Eq. (15), lower signs, with the same corrections"),
            ("flight", "free fall and constant rotation rate (left out by the paper)"),
            ("impact", f"a landing corner keeps {pads.restitution.words()} of its speed, "
             "Eqs. (2)-(4) with the corner inertia for the printed I_O"),
        ],
        uplift=("uplift angle, Eq. (16)", uplift_words(pads.uplift_angle)),
        numbers=_numbers(pads),
        left_out=["tension in the pads"],
    )  # fmt: skip


def _numbers(pads: "PadSupport") -> list[tuple[str, str]]:
    omega = pads.load.body.frequency_at(pads.load.gravity)
    return [
        ("rocking frequency omega, Eq. (6)", f"{omega:.6g} rad/s"),
        ("frequency ratio beta, Eq. (8)", f"{pads.vertical_frequency / omega:.6g}"),
        ("pad stiffness k, damping c", f"{pads.stiffness:.6g} N/m, {pads.damping:.6g} N s/m"),
        ("settlement delta", f"{pads.settlement:.6g} m"),
        *pads.vibrations("vertical vibration", "rocking vibration in full contact"),
        ("restitution eps", pads.restitution.words()),
    ]
