"""Geometry of a scene, upright and at rest: positions and outlines of parts; notebook drawings."""

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from rockframe.components import (
    Component,
    FrameEquivalent,
    Load,
    RearWall,
    RockingFrame,
    Stack,
    Tendon,
)
from rockframe.components.block_numbers import BlockSI
from rockframe.components.frame_members import member_outlines
from rockframe.components.rocking_frame import column_positions, frame_outlines
from rockframe.motion.display import display_name
from rockframe.notebook import Polygon, html_summary, readable_arguments, rectangle, shapes_svg
from rockframe.signals.arrays import Array
from rockframe.system.assembly import Assembly
from rockframe.system.parts import slot_of_class
from rockframe.system.rocking_frame import TendonFrameSetting
from rockframe.system.setting import Setting
from rockframe.system.stack import StackSetting
from rockframe.units import degrees_text

_PAD_THICKNESS: Final = 0.06
"""Least thickness of pads in drawings, over the width of the base."""
_PAD_SHARE: Final = 0.015
"""The same over the height of the scene."""
_PAD_WIDTH: Final = 0.17
"""Width of a pad in drawings over that of the base."""


class LowerBody(NamedTuple):
    """A body of a stack; places are from the middle of the lowest base [m]."""

    outline: Array
    centre: tuple[float, float]  # its centre of mass, with masses on it


class DrawnBase(NamedTuple):
    """A base under a body."""

    slot: str  # of the part: pads, soil or ground
    place: tuple[float, float]  # its middle, from that of the lowest base [m]
    half_width: float  # [m]
    settlement: float  # under the weight; zero for a rigid base [m]

    @property
    def shares(self) -> tuple[tuple[float, float], ...]:
        """Outer and inner end of each pad, or both ends of a bed, along the base [1]."""
        if self.slot == "soil":
            return ((0.0, 1.0),)
        return ((0.0, _PAD_WIDTH), (1.0, 1.0 - _PAD_WIDTH))


class BodyWall(NamedTuple):
    """The body beside which a wall is, counted from 0 at the top, and the distance to it."""

    body: int
    gap: float  # positive to the right [m]


class LinkedPoints(NamedTuple):
    """The points of a restrainer, from the middle of the lowest base [m], and their bodies."""

    points: Array
    bodies: tuple[int, ...]  # counted from 0 at the top; -1 is the ground
    wall: BodyWall | None = None  # which the points belong to


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
    bases: tuple[DrawnBase, ...] = ()  # from that of the block down
    stacked: bool = False  # whether there are pads between block and cap
    lower: tuple[LowerBody, ...] = ()  # bodies of a stack beneath the block, from the top down
    beside: float = 0.0  # distance of the middle of the block's base to the right of the lowest one
    links: tuple[LinkedPoints, ...] = ()  # points that restrainers link
    loads: tuple[LinkedPoints, ...] = ()  # points on which loads act
    # places of the columns under a beam, to the right of the middle; the block is one column
    columns: tuple[float, ...] = ()
    beam: Array | None = None  # outline of the beam on the columns
    walls: tuple[Array, ...] = ()  # outlines of walls beside bodies
    wall_places: tuple[BodyWall, ...] = ()

    @property
    def on_soil(self) -> bool:
        """Whether the lowest base is a bed of soil."""
        return self.bases[-1].slot == "soil"

    def thickness(self, k: int, magnify: float = 1.0) -> float:
        """Thickness with which pads, and beds between bodies, are drawn; equations have none [m].

        Settlements under them are magnified.
        """
        base = self.bases[k]
        if base.slot == "ground" or (self.on_soil and k == len(self.bases) - 1):
            return 0.0
        least = max(_PAD_THICKNESS * 2.0 * base.half_width, _PAD_SHARE * self.top)
        return max(least, 3.0 * magnify * base.settlement)

    def lift(self, k: int, magnify: float = 1.0) -> Array:
        """Displacement of upright body `k` in drawings by pads and beds between bodies below it."""
        between = range(k, len(self.bases) - 1)
        return np.array([0.0, sum(self.thickness(base, magnify) for base in between)])

    @property
    def top(self) -> float:
        """Height of the block's top above the lowest base [m]."""
        return self.base_level + self.height

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
    """Return the geometry of a scene."""
    parts, setting, block = scene.parts, scene.setting, scene.parts.block_si
    cap, frame = None if parts.cap is None else parts.cap_si, parts.frame
    members = parts.block.members if isinstance(parts.block, FrameEquivalent) else ()
    body = setting.body
    bodies, places = (block,), [(0.0, 0.0)]
    moving = setting.bodies if isinstance(setting, StackSetting) else ()
    if parts.stack is not None:
        bodies = parts.stack.si.bodies
        for under, offset in zip(bodies[:0:-1], parts.stack.si.offsets[-2::-1], strict=True):
            places.insert(0, (places[0][0] + offset, places[0][1] + under.height))
    standing, feet = bodies, places  # on the bases
    if cap is not None:
        standing = (block, cap) if setting.stacked else (cap,)
        feet = [(0.0, 2.0 * cap.half_height), *places] if setting.stacked else places
    beside, level = feet[0]
    links = _linked_points(setting)
    named = len(links) - sum(isinstance(link, Load) for link in parts.links)
    return Geometry(
        outline=_rectangle(block.half_width, block.height),
        members=tuple(map(np.array, member_outlines(members))),
        half_width=block.half_width,
        centre=(block.eccentricity, block.centre_height),
        beside=beside,
        response_centre=(beside + body.eccentricity, level + body.centre_height),
        cap=None if cap is None else (cap.half_width, 2.0 * cap.half_height),
        bases=_drawn_bases(scene, feet, [one.half_width for one in standing]),
        stacked=setting.stacked,
        lower=tuple(
            LowerBody(_rectangle(under.half_width, under.height, x, y),
                      (x + body.eccentricity, y + body.centre_height))
            for under, body, (x, y) in zip(bodies[1:], moving[1:], places[1:], strict=True)
        ),
        inclination=scene.options.inclination,
        small_rotation=scene.options.small,
        links=tuple(links[:named]),
        loads=tuple(links[named:]),
        columns=() if frame is None else tuple(column_positions(frame.si)),
        beam=None if frame is None else np.array(frame_outlines(frame.si)[-1]),
        walls=tuple(
            _wall_outline(wall, bodies[wall.si.on_body - 1], places[wall.si.on_body - 1])
            for wall in parts.walls
        ),
        wall_places=tuple(map(_wall_place, parts.walls)),
    )  # fmt: skip


def _drawn_bases(
    scene: Assembly, places: list[tuple[float, float]], half_widths: list[float]
) -> tuple[DrawnBase, ...]:
    """Return the bases of a scene, from the top down."""
    parts, supports = scene.parts, scene.setting.supports
    given = [parts.pads] if scene.setting.stacked else []
    given += () if parts.stack is None else parts.stack.interfaces
    given.append(parts.soil or (None if scene.setting.stacked else parts.pads))
    slots = ["ground" if part is None else slot_of_class(type(part)) or "ground" for part in given]
    # a scene of a user's own need not have supports
    sinks = [support.settlement for support in supports] or [0.0] * len(slots)
    return tuple(map(DrawnBase, slots, places, half_widths, sinks))


def _wall_place(wall: RearWall) -> BodyWall:
    return BodyWall(wall.si.on_body - 1, wall.direction * (wall.given.gap or 0.0))


def _wall_outline(wall: RearWall, body: BlockSI, place: tuple[float, float]) -> Array:
    """Return the outline of a wall in drawings: as high and as thick as its body.

    `place` is the middle of the body's base, from the middle of the lowest one.
    """
    beside = wall.direction * (2.0 * body.half_width + (wall.given.gap or 0.0))
    return _rectangle(body.half_width, body.height, place[0] + beside, place[1])


def _linked_points(setting: Setting) -> list[LinkedPoints]:
    """Return the points that restrainers link, and those of loads, which are last."""
    if isinstance(setting, TendonFrameSetting):  # along the axis of each column
        top = setting.frame.column.height + setting.frame.beam_height
        axes = column_positions(setting.frame)
        return [LinkedPoints(np.array([(x, top), (x, 0.0)]), (0, -1)) for x in axes]
    if not isinstance(setting, StackSetting):
        return []
    linked: list[LinkedPoints] = []
    for link in setting.links:
        points = np.array(link.ends)
        if isinstance(link.part, RearWall):  # where it is struck
            linked.append(LinkedPoints(points[1:], (-1,), _wall_place(link.part)))
        elif isinstance(link.part, Tendon):  # from the top of its body through it
            top = points[0] + (0.0, setting.bodies[link.on].centre_height + setting.tops[link.on])
            linked.append(LinkedPoints(np.vstack([top, points]), (link.on, link.on, link.to)))
        else:
            linked.append(LinkedPoints(points, (link.on, link.to)))
    return linked


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
    half, lifts = geometry.base_half_width, [*map(geometry.lift, range(len(geometry.bases)))]
    reach, depth = 1.7 * half, 0.5 * half
    below = geometry.thickness(len(lifts) - 1)
    band = _rectangle(reach, depth, y=-depth - below)
    polygons = [("soil" if geometry.on_soil else "ground", band)]
    polygons += [
        ("ground", wall + lifts[place.body])
        for wall, place in zip(geometry.walls, geometry.wall_places, strict=True)
    ]
    if geometry.cap_outline is not None:
        polygons.append(("cap", geometry.cap_outline))
    lower = [*zip(geometry.lower, lifts[1:], strict=False)]
    polygons += [("cap", body.outline + lift) for body, lift in lower]
    for k, (base, lift) in enumerate(zip(geometry.bases, lifts, strict=True)):
        thick, (x, y) = geometry.thickness(k), base.place + lift
        for left, right in base.shares if thick else ():
            middle, width = (left + right - 1.0) * base.half_width, abs(right - left)
            outline = _rectangle(width * base.half_width, thick, x + middle, y - thick)
            polygons.append(("soil" if base.slot == "soil" else "pad", outline))
    raised = lifts[0]
    if geometry.beam is not None:
        polygons += [("member", geometry.block + np.array([x, 0.0])) for x in geometry.columns]
        polygons.append(("member", geometry.beam))
    else:
        polygons.append(("block", geometry.block + raised))
    base = geometry.base_position
    polygons += [("member", member + base + raised) for member in geometry.members]
    centres = [np.array([geometry.centre]) + base + raised]
    centres += [np.array([body.centre]) + lift for body, lift in lower]
    if geometry.stacked and geometry.cap is not None:
        centres.append(np.array([(0.0, 0.5 * geometry.cap[1])]))
    sine, cosine = np.sin(geometry.inclination), np.cos(geometry.inclination)
    along_base = np.array([(cosine, sine), (-sine, cosine)])
    return [
        Polygon(tone, [(float(x), float(y)) for x, y in points @ along_base])
        for tone, points in (*polygons, *(("block", centre) for centre in centres))
    ]
