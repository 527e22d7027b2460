"""Restitution of a scene: the user's, or the greatest one."""

ROUNDING = 1e-12
"""Excess over the greatest restitution that is taken for rounding."""


def resolve_restitution(given: float | None, greatest: float) -> float:
    """Give the restitution of a scene: eps_max of Eq. (4) unless the user chose one."""
    return greatest if given is None else given


def restitution_cautions(restitution: float, greatest: float) -> list[str]:
    """Warn of a restitution above eps_max, Eq. (4)."""
    if restitution <= greatest + ROUNDING:
        return []
    return [
        f"restitution {restitution:.6g} exceeds eps_max = {greatest:.6g} of Eq. (4), the greatest "
        "of a rigid block that rolls over from corner to corner without bouncing"
    ]
