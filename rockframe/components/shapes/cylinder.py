"""A circular cylinder, solid or hollow, that rocks on its rim."""

import math
from collections.abc import Mapping
from typing import Final

from rockframe.components.alternatives import OneOf
from rockframe.components.shapes.masses import PlaneMass
from rockframe.components.shapes.standing import ShapedBody, Stance, shaped_body
from rockframe.errors import ComponentError
from rockframe.units import DENSITY, LENGTH, MASS, POSITIVE, THICKNESS, Measure, to_si

_MASS_WAYS: Final = OneOf("mass", "density")


def cylinder_body(given: Mapping[str, object], owner: str) -> ShapedBody:
    """Find mass and inertia of a cylinder, :eq:`eq-cylinder-inertia`."""

    def positive(name: str, measure: Measure) -> float:
        return to_si(given[name], measure, owner=owner, name=name, condition=POSITIVE)

    outer, height, inner = 0.5 * positive("diameter", LENGTH), positive("height", LENGTH), 0.0
    if given["wall_thickness"] is not None:
        thickness = positive("wall_thickness", THICKNESS)
        if thickness >= outer:
            msg = (
                f"{owner}: wall_thickness must be less than half the diameter, {outer:.6g} m, got "
                f"{thickness:.6g} m; a solid cylinder is given without it"
            )
            raise ComponentError(msg)
        inner = outer - thickness
    _MASS_WAYS.check(given, owner)
    if given["mass"] is not None:
        mass = positive("mass", MASS)
    else:
        area = math.pi * (outer - inner) * (outer + inner)
        mass = positive("density", DENSITY) * (area * height)
    inertia = mass * (3.0 * (outer * outer + inner * inner) + height * height) / 12.0
    whole = PlaneMass(mass, 0.0, 0.5 * height, inertia)
    return shaped_body(whole, Stance(-outer, outer, 0.0), height, (), owner)
