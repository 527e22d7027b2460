"""Rigid ground in words."""

import math
from typing import TYPE_CHECKING

from rockframe.system.words import Words

if TYPE_CHECKING:
    from rockframe.system.rigid_ground import RigidGroundSetting


def rigid_ground_words(scene: "RigidGroundSetting") -> Words:
    """Tell a block on rigid ground.

    Parameters
    ----------
    scene : RigidGroundSetting
        Its numbers.

    Returns
    -------
    Words
    """
    lean = "theta s - a" if scene.slope.level else "theta s + i - a"
    rocking = f"a'' = -omega^2 [(1 + yg''/g) sin({lean}) + (xg''/g) cos({lean})]"
    if scene.options.small:
        rocking = "small rotation: a'' = -omega^2 [(1 + yg''/g) (theta s - a) + xg''/g]"
        if not scene.slope.level:
            rocking += ", with gravity g cos(i) in the place of g, and xg'' with g sin(i)"
    return Words(
        equations=[
            ("full", _start_words(scene)),
            ("left, right", f"{rocking}, s = sgn(a) (Housner; Eq. (6) for omega)"),
            ("impact", f"a' after = {scene.restitution.words()} a' before, at a = 0 "
             "(Eq. (4) is the greatest value)"),
        ],
        restraint="the bearing corner does not slide (the restraint options make no difference)",
        uplift=[("uplift angle", "0 rad: any rotation lifts a corner")],
        numbers=[
            ("rocking frequency omega, Eq. (6)", _frequency_words(scene)),
            ("restitution eps", scene.restitution.words()),
        ],
        left_out=[
            "sliding",
            "elasticity of block and ground",
            "flight (a vertical ground acceleration beyond gravity would need it)",
        ],
    )  # fmt: skip


def _start_words(scene: "RigidGroundSetting") -> str:
    """Say when rocking starts."""
    if scene.slope.level:
        return (
            "at rest until |xg''| exceeds (g + yg'') tan(theta), "
            f"{scene.uplift_acceleration:.4g} m s^-2 without vertical motion"
        )
    to_right, to_left = scene.uplift_accelerations
    return (
        "at rest until the resultant of gravity and ground acceleration passes beside a corner: "
        f"without vertical motion at xg'' above {to_right:.4g} m s^-2 to the right, or above "
        f"{to_left:.4g} m s^-2 to the left"
    )


def _frequency_words(scene: "RigidGroundSetting") -> str:
    """Write the frequency of rocking about each corner; one number where they are equal."""
    body = scene.body
    left, right = (
        math.sqrt(
            scene.gravity
            * math.hypot(distance, body.centre_height)
            / body.gyration_square_about(distance)
        )
        for distance in (body.left, body.right)
    )
    if left == right:
        return f"{left:.6g} rad/s"
    return f"about the left corner {left:.6g} rad/s, about the right one {right:.6g} rad/s"
