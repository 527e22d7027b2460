"""What is drawn of a scene at an instant: polygons, pads, soil and points of contact."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Final

import numpy as np

from rockframe.dynamics.events import ContactState
from rockframe.results.placement import Placement
from rockframe.signals.arrays import Array
from rockframe.system.geometry import Geometry, LinkedPoints

_PAD_WIDTH: Final = 0.17
"""Over that of the base."""
_PAD_THICKNESS: Final = 0.06
_LEAST_THICKNESS: Final = 0.15
"""Of a pressed pad, over that of a pad at rest, however much the drawing magnifies."""
_SPRINGS: Final = 81
"""Places at which the surface of the soil is drawn beneath a base."""


@dataclass(frozen=True)
class Layout:
    """A scene in the coordinates of the drawing [m]."""

    block: Array  # outlines; None where there is no cap
    cap: Array | None
    members: tuple[Array, ...]  # of a frame
    centre: Array  # the block's centre of mass
    pads: tuple[Array, ...]  # left and right one, or none
    pads_bear: tuple[bool, ...]  # whether each of them bears
    soil: Array | None  # its surface, from the left edge of the drawing to the right one
    touching: tuple[Array, ...]  # where contact is: points, shape (1, 2), and lines
    ground: Array  # surface of rigid ground, where there is no soil
    lower: tuple[Array, ...] = ()  # outlines of the bodies of a stack beneath the block
    ties: tuple[Array, ...] = ()  # both ends of each restrainer, shape (2, 2)
    others: tuple[Array, ...] = ()  # outlines of a frame's other columns and of its beam


@dataclass(frozen=True)
class Drawer:
    """Lays scenes out for drawing."""

    geometry: Geometry  # of the scene
    magnify: float = 1.0  # by which displacements are multiplied [1]
    least_reach: float = 0.0  # half the width of the ground that is drawn at least [m]

    @property
    def pad_thickness(self) -> float:
        """With which pads are drawn; those of the equations have none [m]."""
        sink = self.geometry.pads_sink
        if sink is None:
            return 0.0
        return max(2.0 * _PAD_THICKNESS * self.geometry.half_width, 3.0 * self.magnify * sink)

    @property
    def reach(self) -> float:
        """Half the width of the ground that is drawn [m]."""
        size = max(2.0 * self.geometry.base_half_width, 0.5 * self.geometry.height)
        return max(self.geometry.base_half_width + 0.6 * size, self.least_reach)

    def widened(self, width: float) -> "Drawer":
        """Give one that draws the ground as far as the drawing reaches [m]."""
        return replace(self, least_reach=width)

    def lay_out(self, at: Placement) -> Layout:
        """Lay out a scene at an instant."""
        geometry, lift = self.geometry, self._lift(at)
        block = self._moved(at.block, geometry.block) + lift
        level = geometry.place
        members = tuple(self._moved(at.block, one + level) + lift for one in geometry.members)
        centre = self._moved(at.block, np.array([geometry.centre]) + level)[0] + lift
        outline = geometry.cap_outline
        cap = None if outline is None else self._moved(at.cap, outline)
        pads, bear = self._pads(at)
        soil, touching = self._soil(at)
        columns = tuple(block + np.array([x, 0.0]) for x in geometry.columns)
        others: tuple[Array, ...] = ()
        if geometry.beam is not None:
            block, others = columns[0], (*columns[1:], self._moved(at.beam, geometry.beam))
            moves = (at.values["horizontal_displacement"], at.values["vertical_displacement"])
            centre = np.array(geometry.moved) + self.magnify * np.array(moves)
        ends = tuple(
            one[k : k + 1] for one in columns or (block,) for k in (0, 1) if at.bearing()[k]
        )
        if pads:
            touching = (*touching, *ends)
        elif soil is None:
            touching = tuple(one[:2] for one in columns or (block,)) if all(at.bearing()) else ends
        floor = 0.0 if geometry.stacked else -self.pad_thickness
        ground = np.array([(-self.reach, floor), (self.reach, floor)])
        found = Layout(block, cap, members, centre, pads, bear, soil, touching, ground)
        lower = tuple(
            self._moved(partial(at.lower, k), one.outline) for k, one in enumerate(geometry.lower)
        )
        ties = tuple(self._tie(at, one) for one in geometry.ties)
        return self._inclined(replace(found, lower=lower, ties=ties, others=others))

    def _tie(self, at: Placement, tie: LinkedPoints) -> Array:
        """Lay out a restrainer, from one body to another or to the ground."""
        ends = list[Array]()
        for point, k in zip(tie.points, tie.bodies, strict=True):
            place = at.block if k == 0 else partial(at.lower, k - 1)
            ends.append(point if k < 0 else self._moved(place, point[None])[0])
        return np.array(ends)

    def points(self, at: Placement, places: Array) -> Array:
        """Lay out points of the body that results are of, from the middle of its base."""
        geometry = self.geometry
        below = geometry.place if geometry.stacked or geometry.lower else np.zeros(2)
        drawn = self._moved(at.block, places + below) + self._lift(at)
        if geometry.columns:  # points of a column are drawn on the first
            beside = np.where(places[:, 1:] > geometry.height, 0.0, geometry.columns[0])
            drawn = drawn + beside * np.array([1.0, 0.0])
        return self._turned(drawn)

    def _moved(self, place: object, points: Array) -> Array:
        moved: Array = place(points)  # type: ignore[operator]
        return points + self.magnify * (moved - points)

    def _lift(self, at: Placement) -> Array:
        """Give by how much pads between cap and block raise the block."""
        if not self.geometry.stacked:
            return np.zeros(2)
        angle = self.magnify * at.cap_rotation
        return self.pad_thickness * np.array([np.sin(angle), np.cos(angle)])

    def _pads(self, at: Placement) -> tuple[tuple[Array, ...], tuple[bool, ...]]:
        geometry, thick = self.geometry, self.pad_thickness
        if geometry.pads_sink is None:
            return (), ()
        half, level = geometry.half_width, geometry.level if geometry.stacked else 0.0
        width = 2.0 * _PAD_WIDTH * half
        base = self._moved(at.block, np.array([(-half, level), (half, level)])) + self._lift(at)
        free = self.magnify * geometry.pads_sink
        found: list[Array] = []
        for side in (-1.0, 1.0):
            outer, inner = side * half, side * (half - width)
            feet = np.array([(outer, level), (inner, level)])
            feet = self._moved(at.cap, feet) if geometry.stacked else feet - (0.0, thick)
            along = (feet[0] - feet[1]) * side / width
            normal = np.array([-along[1], along[0]])
            # heights of the block's base above the feet, up to that of a free pad
            heights = [float((_on(base, x, half) - foot) @ normal)
                       for x, foot in zip((outer, inner), feet, strict=True)]  # fmt: skip
            tops = [
                foot + normal * min(max(height, _LEAST_THICKNESS * thick), thick + free)
                for height, foot in zip(heights, feet, strict=True)
            ]
            found.append(np.array([feet[0], feet[1], tops[1], tops[0]]))
        return tuple(found), at.bearing()

    def _soil(self, at: Placement) -> tuple[Array | None, tuple[Array, ...]]:
        """Give the surface of the soil, which follows the base up to its free level."""
        geometry = self.geometry
        if geometry.bed_sinks is None:
            return None, ()
        half, free = geometry.base_half_width, self.magnify * geometry.bed_sinks
        ends = np.array([(-half, 0.0), (half, 0.0)])
        place = at.block if geometry.cap is None else at.cap
        if geometry.lower:
            place = partial(at.lower, len(geometry.lower) - 1)
        left, right = self._moved(place, ends)
        share = np.linspace(0.0, 1.0, _SPRINGS)[:, None]
        base = left + share * (right - left)
        name = "soil_contact_state" if geometry.cap is not None else "contact_state"
        flies = at.values.get(name) == ContactState.FLIGHT
        below = np.full(_SPRINGS, False) if flies else base[:, 1] <= free
        surface = np.column_stack([base[:, 0], np.where(below, base[:, 1], free)])
        edges = [
            np.array([(min(-self.reach, surface[0, 0]), free), (surface[0, 0], free)]),
            surface,
            np.array([(surface[-1, 0], free), (max(self.reach, surface[-1, 0]), free)]),
        ]
        touching = (surface[below],) if below.any() else ()
        return np.vstack(edges), touching

    def _turned(self, points: Array) -> Array:
        """Turn the base line up to the right."""
        sine, cosine = np.sin(self.geometry.inclination), np.cos(self.geometry.inclination)
        return points @ np.array([(cosine, sine), (-sine, cosine)])

    def _inclined(self, found: Layout) -> Layout:
        turn = self._turned
        return Layout(
            block=turn(found.block),
            cap=None if found.cap is None else turn(found.cap),
            members=tuple(turn(one) for one in found.members),
            centre=turn(found.centre),
            pads=tuple(turn(one) for one in found.pads),
            pads_bear=found.pads_bear,
            soil=None if found.soil is None else turn(found.soil),
            touching=tuple(turn(one) for one in found.touching),
            ground=turn(found.ground),
            lower=tuple(turn(one) for one in found.lower),
            ties=tuple(turn(one) for one in found.ties),
            others=tuple(turn(one) for one in found.others),
        )


def _on(base: Array, x: float, half: float) -> Array:
    """Give the point of a base line at a place along it at rest."""
    share = 0.5 * (x / half + 1.0)
    return base[0] + share * (base[1] - base[0])
