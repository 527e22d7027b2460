"""Scenes of the model of one or two bodies as stacks."""

from reference_models.maximal import layout as at
from reference_models.maximal.rest import rest_of
from reference_models.maximal.scene import Scene as Known
from reference_models.maximal.scene import parameters

from .scene import Bed, Body, Pads, Scene


def as_stack(known: Known) -> Scene:
    """Return a scene of finite rotation on pads, a bed that parts by displacement, or both."""
    p = parameters(known, 1e-13)
    bodies: list[Body] = []
    bases: list[Pads | Bed] = []
    if known.kind != "bed":
        h, e = known.half_height, known.eccentricity
        bodies.append(Body(known.mass, known.inertia, known.half_width, h, h, 0.0, e))
        bases.append(Pads(p[at.STIFFNESS], p[at.DAMPING], known.rebounds()))
    if known.kind != "pads":
        width, height, e = p[at.LOWER_HALF_WIDTH], p[at.LOWER_HEIGHT], p[at.LOWER_ECCENTRICITY]
        mass, inertia = p[at.LOWER_MASS], p[at.LOWER_INERTIA]
        # the block alone decides whether both overturn
        limit = None if known.kind == "bed" else float("inf")
        bodies.append(Body(mass, inertia, width, height, p[at.TOP], 0.0, e, limit))
        bases.append(Bed(p[at.BED_STIFFNESS], p[at.BED_DAMPING]))
    angle, rate = known.start * p[at.LIMIT], known.start_rate * known.frequency * p[at.LIMIT]
    if known.kind == "coupled":  # it tells the rotation relative to the ground
        angle -= rest_of(known, p).lower_angle
    told = known.told or known.start != 0.0 or known.eccentricity == 0.0
    return Scene(tuple(bodies), tuple(bases), known.rule, angle if told else None, rate, known.free)
