"""The layout of a scene: where its parts are in a drawing, at an instant."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np

from rockframe.results.points import Placement
from rockframe.signals.arrays import Array
from rockframe.system.geometry import BodyWall, Geometry, LinkedPoints

_MIN_THICKNESS: Final = 0.15
"""Least thickness of a compressed pad over that at rest, at any magnification."""
_SURFACE_POINTS: Final = 81
"""Number of points of the surface of the soil beneath a base."""
NO_POINT: Final = np.full((1, 2), np.nan)


@dataclass(frozen=True)
class Layout:
    """A scene in the coordinates of the drawing [m]."""

    block: Array  # outline
    cap: Array | None  # outline
    members: tuple[Array, ...]  # of a frame
    centres: Array  # centres of mass of the bodies, the block's first
    pads: tuple[Array, ...]  # of each base of pads left and right, from the top down
    pads_in_contact: tuple[bool, ...]  # whether each of them is in contact
    beds: tuple[Array, ...]  # outlines of beds between bodies
    soil: Array | None  # its surface, from the left edge of the drawing to the right one
    # contacts of each base, or of each end of pads: a point, shape (1, 2), or a line; else NaN
    contacts: tuple[Array, ...]
    ground: Array  # surface of rigid ground, where there is no soil
    lower_bodies: tuple[Array, ...]  # outlines of the bodies of a stack beneath the block
    restrainers: tuple[Array, ...]  # points of each restrainer, shape (points, 2); NaN if broken
    loads: Array  # points of loads
    frame_parts: tuple[Array, ...]  # outlines of a frame's other columns and of its beam
    walls: tuple[Array, ...]  # outlines

    @property
    def bodies(self) -> tuple[Array, ...]:
        """Outlines of all bodies."""
        cap = () if self.cap is None else (self.cap,)
        return (self.block, *self.frame_parts, *self.lower_bodies, *cap)


@dataclass(frozen=True)
class LayoutBuilder:
    """Lays out a scene for drawing."""

    geometry: Geometry  # of the scene
    magnify: float = 1.0  # factor of displacements [1]
    least_reach: float = 0.0  # least half width of the ground in the drawing [m]

    @property
    def reach(self) -> float:
        """Half width of the ground in the drawing [m]."""
        size = max(2.0 * self.geometry.base_half_width, 0.5 * self.geometry.height)
        return max(self.geometry.base_half_width + 0.6 * size, self.least_reach)

    @property
    def _floor(self) -> float:
        """Height of rigid ground, which is below the lowest pads [m]."""
        return -self.geometry.thickness(len(self.geometry.bases) - 1, self.magnify)

    def layout_at(self, placement: Placement) -> Layout:
        """Lay out a scene at an instant."""
        geometry, level = self.geometry, self.geometry.base_position
        moved = partial(self._moved, placement)
        block = moved(0, geometry.block)
        centres = moved(0, np.array([geometry.centre]) + level)
        columns = tuple(block + np.array([x, 0.0]) for x in geometry.columns)
        frame_parts: tuple[Array, ...] = ()
        if geometry.beam is not None:
            beam = self._displaced(placement.beam, geometry.beam)
            block, frame_parts = columns[0], (*columns[1:], beam)
            components = ("horizontal_displacement", "vertical_displacement")
            displacement = np.array([[placement.values[name] for name in components]])
            centres = np.array([geometry.response_centre]) + self.magnify * displacement
        lower = tuple(moved(k, body.outline) for k, body in enumerate(geometry.lower, 1))
        of_lower = [moved(k, np.array([body.centre])) for k, body in enumerate(geometry.lower, 1)]
        outline = geometry.cap_outline
        if geometry.stacked and geometry.cap is not None:
            of_lower.append(moved(1, np.array([(0.0, 0.5 * geometry.cap[1])])))
        pads, in_contact, beds = list[Array](), list[bool](), list[Array]()
        soil, contacts = self._soil_surface(placement)
        for k, base in enumerate(geometry.bases[: None if soil is None else -1]):
            bearing = self._bearing(placement, k)
            layers, bases = self._layers(placement, k)
            if base.slot == "soil":
                beds += layers
                contacts.append(bases[0] if any(bearing) and len(bases[0]) else NO_POINT)
            elif base.slot == "pads":
                pads += layers
                in_contact += bearing
                ends = zip(bases, bearing, strict=True)
                contacts += [line[:1] if bears else NO_POINT for line, bears in ends]
            else:
                contacts += [
                    _contact_points(body, bearing) for body in columns or (((block, *lower))[k],)
                ]
        layout = Layout(
            block=block,
            cap=None if outline is None else moved(int(geometry.stacked), outline),
            members=tuple(moved(0, member + level) for member in geometry.members),
            centres=np.vstack([centres, *of_lower]),
            pads=tuple(pads),
            pads_in_contact=tuple(in_contact),
            beds=tuple(beds),
            soil=soil,
            contacts=tuple(contacts),
            ground=np.array([(-self.reach, self._floor), (self.reach, self._floor)]),
            lower_bodies=lower,
            restrainers=tuple(
                np.full_like(link.points, np.nan)
                if number in placement.broken
                else self._restrainer_points(placement, link)
                for number, link in enumerate(geometry.links)
            ),
            loads=np.vstack(
                [
                    np.empty((0, 2)),
                    *(moved(load.bodies[0], load.points[:1]) for load in geometry.loads),
                ]
            ),
            frame_parts=frame_parts,
            walls=tuple(map(self._wall_outline, geometry.walls, geometry.wall_places)),
        )
        return self._rotated_layout(layout)

    def _restrainer_points(self, placement: Placement, link: LinkedPoints) -> Array:
        """Lay out a restrainer, from one body to another or to the ground."""
        if link.wall is not None:
            return link.points + self._wall_offset(link.wall)
        if self.geometry.columns:  # tendons of a frame end in the beam
            beam = self._displaced(placement.beam, link.points[:1])
            return np.vstack([beam, link.points[1:]])
        return np.vstack([
            point if k < 0 else self._moved(placement, k, point)
            for point, k in zip(link.points[:, None], link.bodies, strict=True)
        ])  # fmt: skip

    def _wall_offset(self, place: BodyWall) -> Array:
        """Return by how much a wall is moved, so that magnified displacements close its gap."""
        gap = np.array([(self.magnify - 1.0) * place.gap, 0.0])
        return gap + self.geometry.lift(place.body, self.magnify)

    def _wall_outline(self, wall: Array, place: BodyWall) -> Array:
        outline = wall + self._wall_offset(place)
        if place.body == len(self.geometry.bases) - 1:  # it stands on the ground
            outline[outline[:, 1] == 0.0, 1] = self._floor
        return outline

    def points_at(self, placement: Placement, places: Array) -> Array:
        """Lay out points of the body to which results refer, from the middle of its base."""
        geometry = self.geometry
        below = geometry.base_position if geometry.stacked or geometry.lower else np.zeros(2)
        drawn = self._moved(placement, 0, places + below)
        if geometry.columns:  # points of a column are drawn on the first column
            beside = np.where(places[:, 1:] > geometry.height, 0.0, geometry.columns[0])
            drawn = drawn + beside * np.array([1.0, 0.0])
        return self._rotated(drawn)

    def _displaced(self, transform: Callable[[Array], Array], points: Array) -> Array:
        return points + self.magnify * (transform(points) - points)

    def _moved(self, placement: Placement, k: int, points: Array) -> Array:
        """Return points of body `k`, counted from 0 at the top, above all pads and beds below."""
        if k == 0:
            transform = placement.block
        else:
            transform = partial(placement.lower, k - 1) if self.geometry.lower else placement.cap
        lift = np.zeros(2)
        for base in range(k, len(self.geometry.bases) - 1):
            normal = _normal(self._moved(placement, base + 1, _UNIT_BASE))
            lift += self.geometry.thickness(base, self.magnify) * normal
        return self._displaced(transform, points) + lift

    def _bearing(self, placement: Placement, k: int) -> tuple[bool, bool]:
        """Return whether the left and whether the right end of the base of body `k` bears."""
        if self.geometry.stacked and k == 1:
            return placement.bearing("soil_contact_state")
        return placement.bearing_of(k)

    def _layers(self, placement: Placement, k: int) -> tuple[list[Array], list[Array]]:
        """Return the outlines of the pads or of the bed under a body, and the base above each."""
        geometry, base = self.geometry, self.geometry.bases[k]
        thick, free = geometry.thickness(k, self.magnify), self.magnify * base.settlement
        if not thick:
            return [], []
        ends = np.array(base.place) + np.array([(-base.half_width, 0.0), (base.half_width, 0.0)])
        left, right = self._moved(placement, k, ends)
        lowest = k == len(geometry.bases) - 1
        feet = ends - (0.0, thick) if lowest else self._moved(placement, k + 1, ends)
        normal = _normal(feet)
        outlines, lines = list[Array](), list[Array]()
        for share in base.shares:
            along = np.linspace(*share, _SURFACE_POINTS if base.slot == "soil" else 2)[:, None]
            foot, line = feet[0] + along * (feet[1] - feet[0]), left + along * (right - left)
            heights = (line - foot) @ normal
            # heights of the body's base above the feet, up to that of a free pad
            tops = np.clip(heights, _MIN_THICKNESS * thick, thick + free)
            outlines.append(np.vstack([foot, (foot + tops[:, None] * normal)[::-1]]))
            lines.append(line[heights <= thick + free] if base.slot == "soil" else line)
        return outlines, lines

    def _soil_surface(self, placement: Placement) -> tuple[Array | None, list[Array]]:
        """Return the surface of the soil, which follows the base up to its free level."""
        geometry, k = self.geometry, len(self.geometry.bases) - 1
        if not geometry.on_soil:
            return None, []
        half, free = geometry.base_half_width, self.magnify * geometry.bases[k].settlement
        left, right = self._moved(placement, k, np.array([(-half, 0.0), (half, 0.0)]))
        share = np.linspace(0.0, 1.0, _SURFACE_POINTS)[:, None]
        base = left + share * (right - left)
        separated = not any(self._bearing(placement, k))
        below = np.full(_SURFACE_POINTS, False) if separated else base[:, 1] <= free
        surface = np.column_stack([base[:, 0], np.where(below, base[:, 1], free)])
        edges = [
            np.array([(min(-self.reach, surface[0, 0]), free), (surface[0, 0], free)]),
            surface,
            np.array([(surface[-1, 0], free), (max(self.reach, surface[-1, 0]), free)]),
        ]
        return np.vstack(edges), [surface[below] if below.any() else NO_POINT]

    def _rotated(self, points: Array) -> Array:
        """Rotate points by the inclination of the base, which rises to the right."""
        sine, cosine = np.sin(self.geometry.inclination), np.cos(self.geometry.inclination)
        return points @ np.array([(cosine, sine), (-sine, cosine)])

    def _rotated_layout(self, layout: Layout) -> Layout:
        def rotated(part: Any) -> Any:
            if isinstance(part, tuple):
                return tuple(map(rotated, part))
            return self._rotated(part) if isinstance(part, np.ndarray) else part

        return Layout(**{name: rotated(part) for name, part in vars(layout).items()})


_UNIT_BASE: Final = np.array([(0.0, 0.0), (1.0, 0.0)])


def _normal(base: Array) -> Array:
    """Return the direction normal to a base line, upwards."""
    across, up = (base[1] - base[0]) / np.hypot(*(base[1] - base[0]))
    return np.array([-up, across])


def _contact_points(outline: Array, in_contact: tuple[bool, bool]) -> Array:
    """Return the part of a rigid base in contact: the whole, an end, or none."""
    if all(in_contact):
        return outline[:2]
    return outline[[in_contact.index(True)]] if any(in_contact) else NO_POINT
