"""Systems as notebooks show them: the scene to scale, and its numbers."""

from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.notebook import Polygon, arguments_in_words, card, drawing
from rockframe.signals.arrays import Array
from rockframe.system.geometry import Geometry, geometry_of, rectangle

if TYPE_CHECKING:
    from rockframe.system.assembly import Assembly

_PAD: Final = 0.06
"""Thickness with which pads are drawn, over the width of the base."""


def system_html(scene: "Assembly", name: str) -> str:
    """Give drawing and numbers of a scene as HTML."""
    setting, options = scene.setting, scene.options
    rows = {"model": setting.model}
    for part in scene.parts.structural():
        numbers = arguments_in_words(part.to_dict())
        rows[type(part).__name__] = ", ".join(f"{one} {value}" for one, value in numbers.items())
    left, right = setting.overturning_angles
    to_left, to_right = (f"{np.degrees(side):.4g}°" for side in (left, right))
    both = f"{to_left} to the left, {to_right} to the right"
    rows["overturning angle"] = to_left if left == right else both
    if np.isfinite(setting.uplift_angle):
        rows["uplift angle"] = f"{np.degrees(setting.uplift_angle):.4g}°"
    if options.inclination:
        rows["inclination"] = f"{np.degrees(options.inclination):.4g}°"
    if scene.parts.motion is not None:
        rows["motion"] = scene.parts.motion.name
    return card(name, rows, drawing(shapes_of(geometry_of(scene))))


def shapes_of(geometry: Geometry) -> list[Polygon]:
    """Give the parts of a scene, upright and at rest, from back to front."""
    half, width = geometry.base_half_width, 2.0 * geometry.half_width
    pad = 0.0 if geometry.pads_sink is None else _PAD * width
    lift = np.array([0.0, pad])
    below = 0.0 if geometry.stacked else pad
    reach, depth = 1.7 * half, 0.5 * half
    band = rectangle(reach, depth, y=-depth - below)
    found = [("ground" if geometry.bed_sinks is None else "soil", band)]
    if geometry.wall is not None:
        found.append(("ground", geometry.wall))
    if geometry.cap_outline is not None:
        found.append(("cap", geometry.cap_outline))
    found += [("cap", one.outline) for one in geometry.lower]
    raised = lift if geometry.stacked else np.zeros(2)
    if pad:
        level = geometry.level if geometry.stacked else -pad
        for side in (-0.83, 0.83):
            place = side * geometry.half_width
            found.append(("pad", rectangle(0.17 * geometry.half_width, pad, place, level)))
    if geometry.beam is not None:
        found += [("member", geometry.block + np.array([x, 0.0])) for x in geometry.columns]
        found.append(("member", geometry.beam))
    else:
        found.append(("block", geometry.block + raised))
    level_up = geometry.place
    found += [("member", member + level_up + raised) for member in geometry.members]
    centre = np.array([geometry.centre]) + level_up + raised
    return [
        Polygon(tone, [(float(x), float(y)) for x, y in _turned(points, geometry)])
        for tone, points in (*found, ("block", centre))
    ]


def _turned(points: Array, geometry: Geometry) -> Array:
    """Turn the base line up to the right."""
    sine, cosine = np.sin(geometry.inclination), np.cos(geometry.inclination)
    return points @ np.array([(cosine, sine), (-sine, cosine)])
