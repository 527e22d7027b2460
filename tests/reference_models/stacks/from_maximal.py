"""Scenes of the reference model ``maximal``, of one or two bodies, as stacks."""

from reference_models.maximal import layout as at
from reference_models.maximal.rest import rest_of
from reference_models.maximal.scene import Scene as Known
from reference_models.maximal.scene import parameters

from .scene import Bed, Body, Pads, Scene


def as_stack(scene: Known) -> Scene:
    """Return a scene of finite rotation on pads, a bed that parts by displacement, or both."""
    p = parameters(scene, 1e-13)
    bodies: list[Body] = []
    bases: list[Pads | Bed] = []
    if scene.kind != "bed":
        h, e = scene.half_height, scene.eccentricity
        bodies.append(Body(scene.mass, scene.inertia, scene.half_width, h, h, 0.0, e))
        bases.append(Pads(p[at.STIFFNESS], p[at.DAMPING], scene.rebounds()))
    if scene.kind != "pads":
        width, height, e = p[at.LOWER_HALF_WIDTH], p[at.LOWER_HEIGHT], p[at.LOWER_ECCENTRICITY]
        mass, inertia = p[at.LOWER_MASS], p[at.LOWER_INERTIA]
        # the rotation of the block decides the overturning of both
        limit = None if scene.kind == "bed" else float("inf")
        bodies.append(Body(mass, inertia, width, height, p[at.TOP], 0.0, e, limit))
        bases.append(Bed(p[at.BED_STIFFNESS], p[at.BED_DAMPING]))
    angle, rate = scene.start * p[at.LIMIT], scene.start_rate * scene.frequency * p[at.LIMIT]
    if scene.kind == "coupled":  # that model states the rotation relative to the ground
        angle -= rest_of(scene, p).lower_angle
    explicit_start = scene.told or scene.start != 0.0 or scene.eccentricity == 0.0
    return Scene(
        tuple(bodies), tuple(bases), scene.rule, angle if explicit_start else None, rate, scene.free
    )
