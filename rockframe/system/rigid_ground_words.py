"""Rigid ground in words."""

from typing import TYPE_CHECKING

from rockframe.system.options import Rotation
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
    rocking = "a'' = -omega^2 [(1 + yg''/g) sin(theta s - a) + (xg''/g) cos(theta s - a)]"
    if scene.rotation is Rotation.SMALL:
        rocking = "small rotation: a'' = -omega^2 [(1 + yg''/g) (theta s - a) + xg''/g]"
    omega = scene.block.frequency_at(scene.gravity)
    return Words(
        equations=[
            ("full", f"at rest until |xg''| exceeds (g + yg'') tan(theta), "
             f"{scene.uplift_acceleration:.4g} m s^-2 without vertical motion"),
            ("left, right", f"{rocking}, s = sgn(a) (Housner; Eq. (6) for omega)"),
            ("impact", f"a' after = {scene.restitution:.6g} a' before, at a = 0 (Eq. (4) is the "
             "greatest value)"),
        ],
        restraint="the bearing corner does not slide (the restraint options make no difference)",
        uplift=[("uplift angle", "0 rad: any rotation lifts a corner")],
        numbers=[
            ("rocking frequency omega, Eq. (6)", f"{omega:.6g} rad/s"),
            ("restitution eps", f"{scene.restitution:.6g}"),
        ],
        left_out=[
            "sliding",
            "elasticity of block and ground",
            "flight (a vertical ground acceleration beyond gravity would need it)",
        ],
    )  # fmt: skip
