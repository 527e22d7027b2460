"""Restitution of a scene: the user's, or the greatest one."""

from typing import NamedTuple

ROUNDING = 1e-12
"""Excess over the greatest restitution that is taken for rounding."""


class Restitutions(NamedTuple):
    """Ratios of speeds after and before an impact, by the corner that lands."""

    left: float
    right: float

    def words(self) -> str:
        """Write them; one number where they are equal."""
        if self.left == self.right:
            return f"{self.left:.6g}"
        return f"{self.left:.6g} (onto the left corner), {self.right:.6g} (onto the right one)"


def resolve_restitution(given: float | None, greatest: Restitutions) -> Restitutions:
    """Give the restitutions of a scene: eps_max of Eq. (4) unless the user chose one."""
    return greatest if given is None else Restitutions(given, given)


def restitution_cautions(chosen: Restitutions, greatest: Restitutions) -> list[str]:
    """Warn of a restitution above eps_max, Eq. (4)."""
    excess, most, restitution = max(
        (one - limit, limit, one) for one, limit in zip(chosen, greatest, strict=True)
    )
    if excess <= ROUNDING:
        return []
    return [
        f"restitution {restitution:.6g} exceeds eps_max = {most:.6g} of Eq. (4), the greatest "
        "of a rigid block that rolls over from corner to corner without bouncing"
    ]
