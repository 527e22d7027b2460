"""Geometry of a scene, upright and at rest: positions and outlines of parts; notebook drawings."""

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from rockframe.components import Component, FrameEquivalent, RearWall, RockingFrame, Stack, Tendon
from rockframe.components.block_numbers import BlockSI
from rockframe.components.frame_members import member_outlines
from rockframe.components.rocking_frame import column_positions, frame_outlines
from rockframe.motion.display import display_name
from rockframe.notebook import Polygon, html_summary, readable_arguments, rectangle, shapes_svg
from rockframe.signals.arrays import Array
from rockframe.system.assembly import Assembly
from rockframe.system.rocking_frame import TendonFrameSetting
from rockframe.system.setting import Setting
from rockframe.system.stack import StackSetting
from rockframe.units import degrees_text


class LowerBody(NamedTuple):
    """A body of a stack; places are from the middle of the lowest base [m]."""

    outline: Array
    centre: tuple[float, float]  # its centre of mass, with masses on it


class LinkedPoints(NamedTuple):
    """The two points of a restrainer, from the middle of the lowest base [m], and their bodies."""

    points: Array
    bodies: tuple[int, int]  # counted from 0 at the top; -1 is the ground


@dataclass(frozen=True)
class Geometry:
    """Sizes and places of parts, from the middle of the lowest base, :eq:`eq-scene-places` [m]."""

    outline: Array  # outline of the block, from the middle of its own base
    half_width: float  # half the width of the block's base
    centre: tuple[float, float]  # the block's centre of mass, from the middle of its own base
    # centre of mass of the body whose motion results give, from the middle of the lowest base: of
    # the block, of block and cap where these are one body, or of the block with masses on it
    response_centre: tuple[float, float]
    small_rotation: bool  # whether the kinematics are expanded in the rotation
    inclination: float = 0.0  # angle by which the base line rises to the right [rad]
    members: tuple[Array, ...] = ()  # outlines of a frame's members, from the block's base
    cap: tuple[float, float] | None = None  # half the width of the cap, and its height
    # settlements of pads and of soil under the weight, where the scene has them
    pad_settlement: float | None = None
    soil_settlement: float | None = None
    stacked: bool = False  # whether there are pads between block and cap
    lower: tuple[LowerBody, ...] = ()  # bodies of a stack beneath the block, from the top down
    beside: float = 0.0  # distance of the middle of the block's base to the right of the lowest one
    links: tuple[LinkedPoints, ...] = ()  # points that restrainers link
    # places of the columns under a beam, to the right of the middle; the block is one column
    columns: tuple[float, ...] = ()
    beam: Array | None = None  # outline of the beam on the columns
    walls: tuple[Array, ...] = ()  # outlines of walls beside bodies

    @property
    def base_level(self) -> float:
        """Height of the block's base above the lowest base [m]."""
        if self.lower:
            return float(self.lower[0].outline[:, 1].max())
        return 0.0 if self.cap is None else self.cap[1]

    @property
    def base_position(self) -> Array:
        """The middle of the block's base, shape (2,) [m]."""
        return np.array([self.beside, self.base_level])

    @property
    def height(self) -> float:
        """Height of the block [m]."""
        return float(self.outline[:, 1].max())

    @property
    def base_half_width(self) -> float:
        """Half the width of the lowest base, from its middle to the right end [m]."""
        if self.lower:
            return float(self.lower[-1].outline[:, 0].max())
        if self.columns:
            return self.columns[-1] + self.half_width
        return self.half_width if self.cap is None else self.cap[0]

    @property
    def block(self) -> Array:
        """Outline of the block, from the middle of the lowest base [m]."""
        return self.outline + self.base_position

    @property
    def cap_outline(self) -> Array | None:
        """Outline of the cap, from the middle of its base [m]."""
        return None if self.cap is None else _rectangle(*self.cap)


def _rectangle(half_width: float, height: float, x: float = 0.0, y: float = 0.0) -> Array:
    return np.array(rectangle(half_width, height, x, y))


def geometry_of(scene: Assembly) -> Geometry:
    """Return the geometry of a scene; bases between the bodies of a stack are not drawn."""
    parts, setting, block = scene.parts, scene.setting, scene.parts.block_si
    cap, frame = None if parts.cap is None else parts.cap_si, parts.frame
    members = parts.block.members if isinstance(parts.block, FrameEquivalent) else ()
    body, sinks = setting.body, [support.settlement for support in setting.supports]
    bodies, places = (block,), [(0.0, 0.0)]
    moving = setting.bodies if isinstance(setting, StackSetting) else ()
    if parts.stack is not None:
        bodies = parts.stack.si.bodies
        for under, offset in zip(bodies[:0:-1], parts.stack.si.offsets[-2::-1], strict=True):
            places.insert(0, (places[0][0] + offset, places[0][1] + under.height))
    beside, level = places[0]
    if setting.stacked and cap is not None:
        level = 2.0 * cap.half_height
    return Geometry(
        outline=_rectangle(block.half_width, block.height),
        members=tuple(map(np.array, member_outlines(members))),
        half_width=block.half_width,
        centre=(block.eccentricity, block.centre_height),
        beside=beside,
        response_centre=(beside + body.eccentricity, level + body.centre_height),
        cap=None if cap is None else (cap.half_width, 2.0 * cap.half_height),
        pad_settlement=None if parts.pads is None or parts.stack is not None else sinks[0],
        soil_settlement=None if parts.soil is None else sinks[-1],
        stacked=setting.stacked,
        lower=tuple(
            LowerBody(_rectangle(under.half_width, under.height, x, y),
                      (x + body.eccentricity, y + body.centre_height))
            for under, body, (x, y) in zip(bodies[1:], moving[1:], places[1:], strict=True)
        ),
        inclination=scene.options.inclination,
        small_rotation=scene.options.small,
        links=_linked_points(setting),
        columns=() if frame is None else tuple(column_positions(frame.si)),
        beam=None if frame is None else np.array(frame_outlines(frame.si)[-1]),
        walls=tuple(
            _wall_outline(wall, bodies[wall.si.on_body - 1], places[wall.si.on_body - 1])
            for wall in parts.walls
        ),
    )  # fmt: skip


def _wall_outline(wall: RearWall, body: BlockSI, place: tuple[float, float]) -> Array:
    """Return the outline of a wall in drawings: as high and as thick as its body.

    `place` is the middle of the body's base, from the middle of the lowest one.
    """
    beside = wall.direction * (2.0 * body.half_width + (wall.given.gap or 0.0))
    return _rectangle(body.half_width, body.height, place[0] + beside, place[1])


def _linked_points(setting: Setting) -> tuple[LinkedPoints, ...]:
    """Return the points that restrainers link."""
    if isinstance(setting, TendonFrameSetting):  # along the axis of each column
        top = setting.frame.column.height + setting.frame.beam_height
        axes = column_positions(setting.frame)
        return tuple(LinkedPoints(np.array([(x, top), (x, 0.0)]), (0, -1)) for x in axes)
    if not isinstance(setting, StackSetting):
        return ()
    linked: list[LinkedPoints] = []
    for link in setting.links[: len(setting.link_names)]:
        points = np.array(link.ends)
        if isinstance(link.part, Tendon):  # from the top of its body through it
            points[0, 1] += setting.bodies[link.on].centre_height + setting.tops[link.on]
        linked.append(LinkedPoints(points, (link.on, link.to)))
    return tuple(linked)


_PAD_THICKNESS: Final = 0.06
"""Thickness of pads in drawings, over the width of the base."""


def system_html(scene: Assembly, name: str) -> str:
    """Return a drawing and the numbers of a scene as HTML."""
    setting, options = scene.setting, scene.options
    rows = {"model": setting.model}
    pieces = [piece for part in scene.parts.structural() for piece in _named_parts(part)]
    for number, (words, part) in enumerate(pieces):
        alike = [other for other, _ in pieces[: number + 1]].count(words)
        numbers = readable_arguments(part.to_dict())
        text = ", ".join(f"{label} {value}" for label, value in numbers.items())
        rows[words if alike == 1 else f"{words} {alike}"] = text
    left, right = setting.overturning_angles
    to_left, to_right = (degrees_text(side) for side in (left, right))
    both = f"{to_left} to the left, {to_right} to the right"
    rows["overturning angle"] = to_left if left == right else both
    if np.isfinite(setting.uplift_angle):
        rows["uplift angle"] = degrees_text(setting.uplift_angle)
    if options.inclination:
        rows["inclination"] = degrees_text(options.inclination)
    if scene.parts.motion is not None:
        motion = scene.parts.motion
        rows["motion"] = display_name(motion.name, motion.history)
    return html_summary(name, rows, shapes_svg(scene_polygons(geometry_of(scene))))


def _named_parts(part: Component) -> list[tuple[str, Component]]:
    """Return the bodies and bases of which a part consists, then the part, each with its name."""
    named: list[tuple[str, Component]] = [(type(part).__name__, part)]
    if isinstance(part, RockingFrame):
        return [("column", part.column), *named]
    if not isinstance(part, Stack):
        return named
    bodies = [(f"body {k}", body) for k, body in enumerate(part.bodies, 1)]
    bases = [(f"beneath body {k}", base) for k, base in enumerate(part.interfaces, 1)]
    return [*bodies, *bases, *named]


def scene_polygons(geometry: Geometry) -> list[Polygon]:
    """Return the shapes of a scene's parts, upright and at rest, from back to front."""
    half, width = geometry.base_half_width, 2.0 * geometry.half_width
    pad = 0.0 if geometry.pad_settlement is None else _PAD_THICKNESS * width
    lift = np.array([0.0, pad])
    below = 0.0 if geometry.stacked else pad
    reach, depth = 1.7 * half, 0.5 * half
    band = _rectangle(reach, depth, y=-depth - below)
    polygons = [("ground" if geometry.soil_settlement is None else "soil", band)]
    polygons += [("ground", wall) for wall in geometry.walls]
    if geometry.cap_outline is not None:
        polygons.append(("cap", geometry.cap_outline))
    polygons += [("cap", body.outline) for body in geometry.lower]
    raised = lift if geometry.stacked else np.zeros(2)
    if pad:
        level = geometry.base_level if geometry.stacked else -pad
        for side in (-0.83, 0.83):
            place = side * geometry.half_width
            polygons.append(("pad", _rectangle(0.17 * geometry.half_width, pad, place, level)))
    if geometry.beam is not None:
        polygons += [("member", geometry.block + np.array([x, 0.0])) for x in geometry.columns]
        polygons.append(("member", geometry.beam))
    else:
        polygons.append(("block", geometry.block + raised))
    base = geometry.base_position
    polygons += [("member", member + base + raised) for member in geometry.members]
    centres = [np.array([geometry.centre]) + base + raised]
    centres += [np.array([body.centre]) for body in geometry.lower]
    if geometry.stacked and geometry.cap is not None:
        centres.append(np.array([(0.0, 0.5 * geometry.cap[1])]))
    sine, cosine = np.sin(geometry.inclination), np.cos(geometry.inclination)
    along_base = np.array([(cosine, sine), (-sine, cosine)])
    return [
        Polygon(tone, [(float(x), float(y)) for x, y in points @ along_base])
        for tone, points in (*polygons, *(("block", centre) for centre in centres))
    ]
