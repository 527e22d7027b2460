"""Drawing of a scene: the places of its parts, and the artists that follow them over time."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from textwrap import wrap
from typing import Any, Final

import numpy as np

from rockframe.components import Component, Load
from rockframe.notebook import readable_arguments
from rockframe.plot._axes import (
    BLUE,
    GREEN,
    GREY,
    METRES,
    ORANGE,
    VERMILLION,
    DisplayUnit,
    as_label,
    ink,
    measured_in,
)
from rockframe.plot._panels import NO_BREAK, Axes
from rockframe.results.points import Placement
from rockframe.signals.arrays import Array
from rockframe.system.geometry import Geometry, LinkedPoints
from rockframe.system.links import link_labels
from rockframe.system.parts import Parts
from rockframe.units.display import DisplayUnits, with_superscripts

_PAD_WIDTH: Final = 0.17
"""Width of a pad over that of the base."""
_PAD_THICKNESS: Final = 0.06
_LEAST_THICKNESS: Final = 0.15
"""Least thickness of a compressed pad over that at rest, at any magnification."""
_SPRINGS: Final = 81
"""Number of points of the surface of the soil beneath a base."""
_NOWHERE: Final = np.full((1, 2), np.nan)


@dataclass(frozen=True)
class Layout:
    """A scene in the coordinates of the drawing [m]."""

    block: Array  # outline
    cap: Array | None  # outline
    members: tuple[Array, ...]  # of a frame
    centres: Array  # centres of mass of the bodies, the block's first
    pads: tuple[Array, ...]  # left and right, or none
    pads_bear: tuple[bool, ...]  # whether each of them is in contact
    soil: Array | None  # its surface, from the left edge of the drawing to the right one
    # contacts of each base, or of each end of pads: a point, shape (1, 2), or a line; else NaN
    touching: tuple[Array, ...]
    ground: Array  # surface of rigid ground, where there is no soil
    lower: tuple[Array, ...]  # outlines of the bodies of a stack beneath the block
    ties: tuple[Array, ...]  # both ends of each restrainer, shape (2, 2); NaN once it broke
    others: tuple[Array, ...]  # outlines of a frame's other columns and of its beam

    @property
    def bodies(self) -> tuple[Array, ...]:
        """Outlines of all bodies."""
        return (self.block, *self.others, *self.lower, *(() if self.cap is None else (self.cap,)))


@dataclass(frozen=True)
class Drawer:
    """Lays out a scene for drawing."""

    geometry: Geometry  # of the scene
    magnify: float = 1.0  # factor of displacements [1]
    least_reach: float = 0.0  # least half width of the ground in the drawing [m]

    @property
    def pad_thickness(self) -> float:
        """Thickness with which pads are drawn; those of the equations have none [m]."""
        sink = self.geometry.pad_settlement
        if sink is None:
            return 0.0
        return max(2.0 * _PAD_THICKNESS * self.geometry.half_width, 3.0 * self.magnify * sink)

    @property
    def reach(self) -> float:
        """Half width of the ground in the drawing [m]."""
        size = max(2.0 * self.geometry.base_half_width, 0.5 * self.geometry.height)
        return max(self.geometry.base_half_width + 0.6 * size, self.least_reach)

    def lay_out(self, at: Placement) -> Layout:
        """Lay out a scene at an instant."""
        geometry, lift = self.geometry, self._lift(at)
        block = self._moved(at.block, geometry.block) + lift
        level = geometry.base_position
        members = tuple(self._moved(at.block, one + level) + lift for one in geometry.members)
        centres = self._moved(at.block, np.array([geometry.centre]) + level) + lift
        outline = geometry.cap_outline
        cap = None if outline is None else self._moved(at.cap, outline)
        pads, bear = self._pads(at)
        soil, touching = self._soil(at)
        columns = tuple(block + np.array([x, 0.0]) for x in geometry.columns)
        others: tuple[Array, ...] = ()
        if geometry.beam is not None:
            block, others = columns[0], (*columns[1:], self._moved(at.beam, geometry.beam))
            moves = (at.values["horizontal_displacement"], at.values["vertical_displacement"])
            centres = np.array([geometry.response_centre]) + self.magnify * np.array([moves])
        floor = 0.0 if geometry.stacked else -self.pad_thickness
        ground = np.array([(-self.reach, floor), (self.reach, floor)])
        lower = tuple(
            self._moved(partial(at.lower, k), one.outline) for k, one in enumerate(geometry.lower)
        )
        of_lower = [
            self._moved(partial(at.lower, k), np.array([one.centre]))
            for k, one in enumerate(geometry.lower)
        ]
        if geometry.stacked and geometry.cap is not None:
            of_lower.append(self._moved(at.cap, np.array([(0.0, 0.5 * geometry.cap[1])])))
        centres = np.vstack([centres, *of_lower])
        if pads:
            touching += tuple(
                one[k : k + 1] if at.bearing()[k] else _NOWHERE
                for one in columns or (block,)
                for k in (0, 1)
            )
        else:
            on_rigid = [block, *lower][: None if soil is None else -1]
            touching += tuple(
                _contact(one, at.bearing_of(k))
                for k, body in enumerate(on_rigid)
                for one in columns or (body,)
            )
        ties = tuple(
            np.full((2, 2), np.nan) if number in at.broken else self._tie(at, one)
            for number, one in enumerate(geometry.links)
        )
        laid_out = (block, cap, members, centres, pads, bear, soil, touching, ground)
        return self._inclined(Layout(*laid_out, lower, ties, others))

    def _tie(self, at: Placement, tie: LinkedPoints) -> Array:
        """Lay out a restrainer, from one body to another or to the ground."""
        ends = list[Array]()
        for point, k in zip(tie.points, tie.bodies, strict=True):
            place = at.block if k == 0 else partial(at.lower, k - 1)
            if self.geometry.columns:  # tendons of a frame end in the beam
                place = at.beam
            ends.append(point if k < 0 else self._moved(place, point[None])[0])
        return np.array(ends)

    def points(self, at: Placement, places: Array) -> Array:
        """Lay out points of the body to which results refer, from the middle of its base."""
        geometry = self.geometry
        below = geometry.base_position if geometry.stacked or geometry.lower else np.zeros(2)
        drawn = self._moved(at.block, places + below) + self._lift(at)
        if geometry.columns:  # points of a column are drawn on the first column
            beside = np.where(places[:, 1:] > geometry.height, 0.0, geometry.columns[0])
            drawn = drawn + beside * np.array([1.0, 0.0])
        return self._turned(drawn)

    def _moved(self, place: object, points: Array) -> Array:
        moved: Array = place(points)  # type: ignore[operator]
        return points + self.magnify * (moved - points)

    def _lift(self, at: Placement) -> Array:
        """Return the displacement of the block in the drawing by the thickness of pads on a cap."""
        if not self.geometry.stacked:
            return np.zeros(2)
        angle = self.magnify * at.cap_rotation
        return self.pad_thickness * np.array([np.sin(angle), np.cos(angle)])

    def _pads(self, at: Placement) -> tuple[tuple[Array, ...], tuple[bool, ...]]:
        geometry, thick = self.geometry, self.pad_thickness
        if geometry.pad_settlement is None:
            return (), ()
        half, level = geometry.half_width, geometry.base_level if geometry.stacked else 0.0
        width = 2.0 * _PAD_WIDTH * half
        base = self._moved(at.block, np.array([(-half, level), (half, level)])) + self._lift(at)
        free = self.magnify * geometry.pad_settlement
        found: list[Array] = []
        for side in (-1.0, 1.0):
            outer, inner = side * half, side * (half - width)
            feet = np.array([(outer, level), (inner, level)])
            feet = self._moved(at.cap, feet) if geometry.stacked else feet - (0.0, thick)
            along = (feet[0] - feet[1]) * side / width
            normal = np.array([-along[1], along[0]])
            # heights of the block's base above the feet, up to that of a free pad
            shares = (0.5 * (x / half + 1.0) for x in (outer, inner))  # along the base at rest
            heights = [float((base[0] + share * (base[1] - base[0]) - foot) @ normal)
                       for share, foot in zip(shares, feet, strict=True)]  # fmt: skip
            tops = [
                foot + normal * min(max(height, _LEAST_THICKNESS * thick), thick + free)
                for height, foot in zip(heights, feet, strict=True)
            ]
            found.append(np.array([feet[0], feet[1], tops[1], tops[0]]))
        return tuple(found), at.bearing()

    def _soil(self, at: Placement) -> tuple[Array | None, tuple[Array, ...]]:
        """Return the surface of the soil, which follows the base up to its free level."""
        geometry = self.geometry
        if geometry.soil_settlement is None:
            return None, ()
        half, free = geometry.base_half_width, self.magnify * geometry.soil_settlement
        ends = np.array([(-half, 0.0), (half, 0.0)])
        place = at.block if geometry.cap is None else at.cap
        if geometry.lower:
            place = partial(at.lower, len(geometry.lower) - 1)
        left, right = self._moved(place, ends)
        share = np.linspace(0.0, 1.0, _SPRINGS)[:, None]
        base = left + share * (right - left)
        bears = at.bearing_of(len(geometry.lower))
        if geometry.cap is not None:
            bears = at.bearing("soil_contact_state")
        flies = not any(bears)
        below = np.full(_SPRINGS, False) if flies else base[:, 1] <= free
        surface = np.column_stack([base[:, 0], np.where(below, base[:, 1], free)])
        edges = [
            np.array([(min(-self.reach, surface[0, 0]), free), (surface[0, 0], free)]),
            surface,
            np.array([(surface[-1, 0], free), (max(self.reach, surface[-1, 0]), free)]),
        ]
        return np.vstack(edges), (surface[below] if below.any() else _NOWHERE,)

    def _turned(self, points: Array) -> Array:
        """Rotate points by the inclination of the base, which rises to the right."""
        sine, cosine = np.sin(self.geometry.inclination), np.cos(self.geometry.inclination)
        return points @ np.array([(cosine, sine), (-sine, cosine)])

    def _inclined(self, found: Layout) -> Layout:
        def turned(part: Any) -> Any:
            if isinstance(part, tuple):
                return tuple(map(turned, part))
            return self._turned(part) if isinstance(part, np.ndarray) else part

        return Layout(**{name: turned(part) for name, part in vars(found).items()})


def _contact(outline: Array, bears: tuple[bool, bool]) -> Array:
    """Return the part of a rigid base that bears: the whole, an end, or none."""
    if all(bears):
        return outline[:2]
    return outline[[bears.index(True)]] if any(bears) else _NOWHERE


CONTACT: Final = VERMILLION
SOIL: Final = "#a6794f"
_DEPTH: Final = 0.3
"""Depth of the ground in the drawing, over half its width."""


class SceneArtist:
    """The artists of a scene, which follow it over time."""

    def __init__(
        self,
        axes: Axes,
        drawer: Drawer,
        names: Mapping[str, str] | None = None,
        length: DisplayUnit = METRES,
    ) -> None:
        self.axes, self.drawer, self._names = axes, drawer, names or {}
        self._artists: dict[str, Any] = {}
        self._marked: dict[str, Array] = {}
        axes.set_aspect("equal")
        measured_in(axes, length)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)

    def frame(self, shown: Iterable[Placement]) -> None:
        """Set limits that hold the scene, and the points that are marked, at all instants."""
        wall = self.drawer.geometry.wall
        shown_parts = [] if wall is None else [wall]
        for at in shown:
            one = self.drawer.lay_out(at)
            shown_parts += (one.block, one.ground, *one.lower, *one.ties, *one.others)
            shown_parts += (self.drawer.points(at, place) for place in self._marked.values())
        corners = np.vstack(shown_parts)
        low, high = np.nanmin(corners, axis=0), np.nanmax(corners, axis=0)
        widest = float(max(-low[0], high[0]))
        if widest > self.drawer.reach:
            self.drawer = replace(self.drawer, least_reach=1.08 * widest)
        reach, depth = self.drawer.reach, _DEPTH * self.drawer.reach
        self.axes.set_xlim(-reach, reach)
        self.axes.set_ylim(low[1] - depth, high[1] + 0.06 * (high[1] - low[1]))

    def rest(self, at: Placement) -> None:
        """Draw the bodies at rest behind everything."""
        from matplotlib.patches import Polygon

        for outline in self.drawer.lay_out(at).bodies:
            dashed = Polygon(outline, fill=False, edgecolor=GREY, linestyle="--", linewidth=0.8)
            self.axes.add_patch(dashed).set_zorder(1)

    def mark(self, points: Mapping[str, tuple[float, ...]]) -> None:
        """Set the points of the body that are marked, by their names."""
        self._marked = {name: np.array([place]) for name, place in points.items()}

    def draw(self, at: Placement) -> None:
        """Draw all artists, or move them."""
        found = self.drawer.lay_out(at)
        self._ground(found)
        if self.drawer.geometry.wall is not None:
            wall = self._polygon("wall", self.drawer.geometry.wall, GREY, 2)
            wall.set(hatch="///")
        if found.cap is not None:
            self._polygon("cap", found.cap, ORANGE, 3)
        for number, body in enumerate(found.lower):
            self._polygon(f"stack {number}", body, ORANGE, 3, alpha=0.22)
        for number, (pad, bears) in enumerate(zip(found.pads, found.pads_bear, strict=True)):
            artist = self._polygon(f"pads {number}", pad, GREY, 3)
            artist.set(facecolor=CONTACT if bears else GREY, alpha=0.75)
        self._polygon("block", found.block, BLUE, 4, alpha=0.08 if found.members else 0.22)
        for number, member in enumerate(found.members):
            self._polygon(f"member {number}", member, BLUE, 4, alpha=0.3)
        for number, other in enumerate(found.others):
            self._polygon(f"other {number}", other, BLUE, 4, alpha=0.22)
        for number, ends in enumerate(found.ties):
            self._line(
                f"tie {number}", ends, color=VERMILLION, linewidth=1.4, zorder=5, marker="."
            )  # which shows one without a length
        self._dots("centre", found.centres, marker="P", color=ink(), markersize=6.0)
        self._touching(found)
        for name, place in self._marked.items():
            self._point(name, self.drawer.points(at, place))

    def legend(self) -> None:
        """Write the names of the parts next to the drawing."""
        handles = [
            (self._artists[key], words)
            for slot, words in self._names.items()
            for key in (slot, f"{slot} 0")
            if key in self._artists
        ]
        self.axes.legend(
            *zip(*handles, strict=True), loc="center left", bbox_to_anchor=(1.02, 0.5),
            frameon=False, fontsize="small",
        )  # fmt: skip

    def _ground(self, found: Layout) -> None:
        floor = self.axes.get_ylim()[0]
        surface = found.ground if found.soil is None else found.soil
        band = np.vstack([surface, [(surface[-1, 0], floor), (surface[0, 0], floor)]])
        if found.soil is not None:
            self._polygon("soil", band, SOIL, 2, alpha=0.3)
            return
        artist = self._polygon("ground", band, GREY, 2, alpha=0.35)
        artist.set(hatch="///", linewidth=0.0)
        self._line("surface", found.ground, color=ink(), linewidth=1.0, zorder=2)

    def _touching(self, found: Layout) -> None:
        dots = [one for one in found.touching if len(one) == 1]
        lines = [one for one in found.touching if len(one) > 1]
        self._dots("touching", np.vstack(dots or [_NOWHERE]), color=CONTACT, markersize=6.0)
        apart = [part for one in lines for part in (one, _NOWHERE)] or [_NOWHERE]
        self._line(
            "bearing", np.vstack(apart), color=CONTACT, linewidth=3.0, zorder=5,
            solid_capstyle="butt",
        )  # fmt: skip

    def _point(self, name: str, place: Array) -> None:
        self._dots(f"point {name}", place, color=GREEN, marker="D", markersize=4.5)
        key = f"name of {name}"
        if key not in self._artists:
            self._artists[key] = self.axes.annotate(
                as_label(name), (0.0, 0.0), xytext=(5, 3), textcoords="offset points",
                fontsize="small", zorder=7,
            )  # fmt: skip
        self._artists[key].xy = tuple(place[0])

    def _polygon(
        self, key: str, corners: Array, colour: str, order: int, alpha: float = 0.35
    ) -> Any:
        from matplotlib.colors import to_rgba
        from matplotlib.patches import Polygon

        if key not in self._artists:
            face = to_rgba(colour, alpha)
            shape = Polygon(corners, facecolor=face, edgecolor=colour, linewidth=1.2, zorder=order)
            self._artists[key] = self.axes.add_patch(shape)
        self._artists[key].set_xy(corners)
        return self._artists[key]

    def _dots(self, key: str, places: Array, **style: Any) -> None:
        self._line(key, places, **{"linestyle": "none", "marker": "o", "zorder": 6, **style})

    def _line(self, key: str, places: Array, **style: Any) -> None:
        if key not in self._artists:
            (self._artists[key],) = self.axes.plot([], [], **style)
        self._artists[key].set_data(places[:, 0], places[:, 1])


_LETTERS: Final = 32
"""Longest line on a body of a stack, or on a load [characters]."""
_DRAWN: Final = ("name", "on", "to", "on_body", "to_body", "depth")
"""Arguments of links that the drawing shows, and which the names omit."""


def part_labels(parts: Parts, geometry: Geometry, units: DisplayUnits) -> dict[str, str]:
    """Return the names of the parts of a scene, with their parameters, by their slots."""
    found: dict[str, list[str]] = {}
    for slot in ("block", "wall", "pads", "cap", "soil"):
        part = parts.components.get(slot)
        if part is not None:
            found[slot] = [type(part).__name__, *_numbers(part, units)]
    if parts.frame is not None:
        column = [f"column {one}" for one in _numbers(parts.frame.column, units)]
        found["block"] = [type(parts.frame).__name__, *column, *_numbers(parts.frame, units)]
    if parts.stack is not None:
        bases = [*parts.stack.interfaces, None]
        for k, (body, base) in enumerate(zip(parts.stack.bodies, bases, strict=True)):
            lines = [f"body {k + 1}: {type(body).__name__}", *_in_lines(_numbers(body, units))]
            if base is not None:
                lines += _in_lines([f"on {type(base).__name__}", *_numbers(base, units)])
            found[f"stack {k - 1}" if k else "block"] = lines
    if parts.stack is not None and "pads" in found:  # pads are not drawn below a stack
        found["ground"] = found.pop("pads")
    elif geometry.soil_settlement is None:
        found["ground"] = ["rigid ground", *_numbers(parts.components.get("ground"), units)]
    for number, (name, link) in enumerate(zip(link_labels(parts.links), parts.links, strict=True)):
        lines = [as_label(name), *_numbers(link, units, _DRAWN)]
        if number < len(geometry.links):
            found[f"tie {number}"] = lines[:1] if link is parts.wall else lines
        elif isinstance(link, Load):  # not drawn, therefore listed with its body
            body = link.si.on_body - 1
            found[f"stack {body - 1}" if body else "block"] += _in_lines(lines)
    words = {slot: with_superscripts("\n   ".join(lines)) for slot, lines in found.items()}
    return {**words, "centre": "centre of mass", "touching": "contact"}


def _in_lines(words: Sequence[str]) -> list[str]:
    whole = ", ".join(words).replace(" ", NO_BREAK).replace(f",{NO_BREAK}", ", ")
    return [line.replace(NO_BREAK, " ") for line in wrap(whole, _LETTERS)]


def _numbers(part: Component | None, units: DisplayUnits, without: Sequence[str] = ()) -> list[str]:
    """Write the parameters of a part, in the reader's units if these are chosen."""
    if part is None:
        return []
    arguments = {name: one for name, one in part.to_dict().items() if name not in without}
    found = readable_arguments({name: one for name, one in arguments.items() if one != "0.0 N"})
    for name, one in arguments.items():
        sentence = units.convert_text(str(one))
        if sentence != str(one):
            found[name.replace("_", " ")] = sentence
    return [f"{name} {words}" for name, words in found.items()]
