"""Quasi-static states: a body held at a rotation in vertical equilibrium."""

import math
from dataclasses import dataclass, field

from rockframe.system.options import Rotation


@dataclass(frozen=True)
class Statics:
    """A body held at a rotation, in SI units.

    Parameters
    ----------
    vertical_displacement : float
        Of the centre of mass from rest.
    base_moment : float
        Of the base's vertical reactions about the middle of the base, against the rotation.
    restoring_moment : float
        Couple that holds the body at the rotation: the base moment less the weight's
        moment about the middle of the base.
    contact_state : str
        Name of the contact state.
    reactions : dict of str to float
        Forces and lengths of the base by their names in the results' schema.
    """

    vertical_displacement: float
    base_moment: float
    restoring_moment: float
    contact_state: str
    reactions: dict[str, float] = field(default_factory=dict[str, float])


def sine_cosine_rise(
    half_height: float, kinematics: Rotation, rotation: float
) -> tuple[float, float, float]:
    """Give sin a, cos a and h(1 - cos a), or their small-rotation forms, :eq:`eq-kinematics`."""
    if kinematics is Rotation.SMALL:
        return rotation, 1.0, 0.5 * half_height * rotation**2
    return math.sin(rotation), math.cos(rotation), 2.0 * half_height * math.sin(0.5 * rotation) ** 2
