"""Drawing of a scene: the places of its parts, and the artists that follow them over time."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from textwrap import wrap
from typing import Any, Final

import numpy as np

from rockframe.components import Component, Load, RearWall
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
    set_length_unit,
    text_colour,
)
from rockframe.plot._panels import NO_BREAK, Axes
from rockframe.results.points import Placement
from rockframe.signals.arrays import Array
from rockframe.system.geometry import Geometry, LinkedPoints
from rockframe.system.parts import Parts
from rockframe.units.display import DisplayUnits, with_superscripts

_PAD_WIDTH: Final = 0.17
"""Width of a pad over that of the base."""
_PAD_THICKNESS: Final = 0.06
_MIN_THICKNESS: Final = 0.15
"""Least thickness of a compressed pad over that at rest, at any magnification."""
_SURFACE_POINTS: Final = 81
"""Number of points of the surface of the soil beneath a base."""
_NO_POINT: Final = np.full((1, 2), np.nan)


@dataclass(frozen=True)
class Layout:
    """A scene in the coordinates of the drawing [m]."""

    block: Array  # outline
    cap: Array | None  # outline
    members: tuple[Array, ...]  # of a frame
    centres: Array  # centres of mass of the bodies, the block's first
    pads: tuple[Array, ...]  # left and right, or none
    pads_in_contact: tuple[bool, ...]  # whether each of them is in contact
    soil: Array | None  # its surface, from the left edge of the drawing to the right one
    # contacts of each base, or of each end of pads: a point, shape (1, 2), or a line; else NaN
    contacts: tuple[Array, ...]
    ground: Array  # surface of rigid ground, where there is no soil
    lower_bodies: tuple[Array, ...]  # outlines of the bodies of a stack beneath the block
    restrainers: tuple[Array, ...]  # both ends of each restrainer, shape (2, 2); NaN once it broke
    frame_parts: tuple[Array, ...]  # outlines of a frame's other columns and of its beam

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

    def layout_at(self, placement: Placement) -> Layout:
        """Lay out a scene at an instant."""
        geometry, lift = self.geometry, self._pad_offset(placement)
        block = self._displaced(placement.block, geometry.block) + lift
        level = geometry.base_position
        members = tuple(
            self._displaced(placement.block, member + level) + lift for member in geometry.members
        )
        centres = self._displaced(placement.block, np.array([geometry.centre]) + level) + lift
        outline = geometry.cap_outline
        cap = None if outline is None else self._displaced(placement.cap, outline)
        pads, in_contact = self._pad_outlines(placement)
        soil, contacts = self._soil_surface(placement)
        columns = tuple(block + np.array([x, 0.0]) for x in geometry.columns)
        frame_parts: tuple[Array, ...] = ()
        if geometry.beam is not None:
            beam = self._displaced(placement.beam, geometry.beam)
            block, frame_parts = columns[0], (*columns[1:], beam)
            components = ("horizontal_displacement", "vertical_displacement")
            displacement = np.array([[placement.values[name] for name in components]])
            centres = np.array([geometry.response_centre]) + self.magnify * displacement
        floor = 0.0 if geometry.stacked else -self.pad_thickness
        ground = np.array([(-self.reach, floor), (self.reach, floor)])
        lower = tuple(
            self._displaced(partial(placement.lower, k), body.outline)
            for k, body in enumerate(geometry.lower)
        )
        of_lower = [
            self._displaced(partial(placement.lower, k), np.array([body.centre]))
            for k, body in enumerate(geometry.lower)
        ]
        if geometry.stacked and geometry.cap is not None:
            of_lower.append(
                self._displaced(placement.cap, np.array([(0.0, 0.5 * geometry.cap[1])]))
            )
        centres = np.vstack([centres, *of_lower])
        if pads:
            contacts += tuple(
                column[k : k + 1] if placement.bearing()[k] else _NO_POINT
                for column in columns or (block,)
                for k in (0, 1)
            )
        else:
            rigid_bases = [block, *lower][: None if soil is None else -1]
            contacts += tuple(
                _contact_points(column, placement.bearing_of(k))
                for k, body in enumerate(rigid_bases)
                for column in columns or (body,)
            )
        restrainers = tuple(
            np.full((2, 2), np.nan)
            if number in placement.broken
            else self._restrainer_ends(placement, link)
            for number, link in enumerate(geometry.links)
        )
        fields = (block, cap, members, centres, pads, in_contact, soil, contacts, ground)
        return self._rotated_layout(Layout(*fields, lower, restrainers, frame_parts))

    def _restrainer_ends(self, placement: Placement, tie: LinkedPoints) -> Array:
        """Lay out a restrainer, from one body to another or to the ground."""
        ends = list[Array]()
        for point, k in zip(tie.points, tie.bodies, strict=True):
            transform = placement.block if k == 0 else partial(placement.lower, k - 1)
            if self.geometry.columns:  # tendons of a frame end in the beam
                transform = placement.beam
            ends.append(point if k < 0 else self._displaced(transform, point[None])[0])
        return np.array(ends)

    def points_at(self, placement: Placement, places: Array) -> Array:
        """Lay out points of the body to which results refer, from the middle of its base."""
        geometry = self.geometry
        below = geometry.base_position if geometry.stacked or geometry.lower else np.zeros(2)
        drawn = self._displaced(placement.block, places + below) + self._pad_offset(placement)
        if geometry.columns:  # points of a column are drawn on the first column
            beside = np.where(places[:, 1:] > geometry.height, 0.0, geometry.columns[0])
            drawn = drawn + beside * np.array([1.0, 0.0])
        return self._rotated(drawn)

    def _displaced(self, transform: object, points: Array) -> Array:
        displaced: Array = transform(points)  # type: ignore[operator]
        return points + self.magnify * (displaced - points)

    def _pad_offset(self, placement: Placement) -> Array:
        """Return the displacement of the block in the drawing by the thickness of pads on a cap."""
        if not self.geometry.stacked:
            return np.zeros(2)
        angle = self.magnify * placement.cap_rotation
        return self.pad_thickness * np.array([np.sin(angle), np.cos(angle)])

    def _pad_outlines(self, placement: Placement) -> tuple[tuple[Array, ...], tuple[bool, ...]]:
        geometry, thick = self.geometry, self.pad_thickness
        if geometry.pad_settlement is None:
            return (), ()
        half, level = geometry.half_width, geometry.base_level if geometry.stacked else 0.0
        width = 2.0 * _PAD_WIDTH * half
        base = self._displaced(
            placement.block, np.array([(-half, level), (half, level)])
        ) + self._pad_offset(placement)
        free = self.magnify * geometry.pad_settlement
        outlines: list[Array] = []
        for side in (-1.0, 1.0):
            outer, inner = side * half, side * (half - width)
            feet = np.array([(outer, level), (inner, level)])
            feet = self._displaced(placement.cap, feet) if geometry.stacked else feet - (0.0, thick)
            along = (feet[0] - feet[1]) * side / width
            normal = np.array([-along[1], along[0]])
            # heights of the block's base above the feet, up to that of a free pad
            shares = (0.5 * (x / half + 1.0) for x in (outer, inner))  # along the base at rest
            heights = [float((base[0] + share * (base[1] - base[0]) - foot) @ normal)
                       for share, foot in zip(shares, feet, strict=True)]  # fmt: skip
            tops = [
                foot + normal * min(max(height, _MIN_THICKNESS * thick), thick + free)
                for height, foot in zip(heights, feet, strict=True)
            ]
            outlines.append(np.array([feet[0], feet[1], tops[1], tops[0]]))
        return tuple(outlines), placement.bearing()

    def _soil_surface(self, placement: Placement) -> tuple[Array | None, tuple[Array, ...]]:
        """Return the surface of the soil, which follows the base up to its free level."""
        geometry = self.geometry
        if geometry.soil_settlement is None:
            return None, ()
        half, free = geometry.base_half_width, self.magnify * geometry.soil_settlement
        ends = np.array([(-half, 0.0), (half, 0.0)])
        transform = placement.block if geometry.cap is None else placement.cap
        if geometry.lower:
            transform = partial(placement.lower, len(geometry.lower) - 1)
        left, right = self._displaced(transform, ends)
        share = np.linspace(0.0, 1.0, _SURFACE_POINTS)[:, None]
        base = left + share * (right - left)
        bearing = placement.bearing_of(len(geometry.lower))
        if geometry.cap is not None:
            bearing = placement.bearing("soil_contact_state")
        separated = not any(bearing)
        below = np.full(_SURFACE_POINTS, False) if separated else base[:, 1] <= free
        surface = np.column_stack([base[:, 0], np.where(below, base[:, 1], free)])
        edges = [
            np.array([(min(-self.reach, surface[0, 0]), free), (surface[0, 0], free)]),
            surface,
            np.array([(surface[-1, 0], free), (max(self.reach, surface[-1, 0]), free)]),
        ]
        return np.vstack(edges), (surface[below] if below.any() else _NO_POINT,)

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


def _contact_points(outline: Array, in_contact: tuple[bool, bool]) -> Array:
    """Return the part of a rigid base in contact: the whole, an end, or none."""
    if all(in_contact):
        return outline[:2]
    return outline[[in_contact.index(True)]] if any(in_contact) else _NO_POINT


CONTACT_COLOUR: Final = VERMILLION
SOIL_COLOUR: Final = "#a6794f"
_GROUND_DEPTH: Final = 0.3
"""Depth of the ground in the drawing, over half its width."""


class SceneArtist:
    """The artists of a scene, which follow it over time."""

    def __init__(
        self,
        axes: Axes,
        builder: LayoutBuilder,
        names: Mapping[str, str] | None = None,
        length: DisplayUnit = METRES,
    ) -> None:
        self.axes, self.builder, self._legend_names = axes, builder, names or {}
        self._artists: dict[str, Any] = {}
        self._points: dict[str, Array] = {}
        axes.set_aspect("equal")
        set_length_unit(axes, length)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)

    def set_limits(self, placements: Iterable[Placement]) -> None:
        """Set limits that contain the scene and the marked points at all instants."""
        shown_parts = list(self.builder.geometry.walls)
        for placement in placements:
            layout = self.builder.layout_at(placement)
            shown_parts += (layout.block, layout.ground, *layout.lower_bodies)
            shown_parts += (*layout.restrainers, *layout.frame_parts)
            places = self._points.values()
            shown_parts += (self.builder.points_at(placement, place) for place in places)
        corners = np.vstack(shown_parts)
        low, high = np.nanmin(corners, axis=0), np.nanmax(corners, axis=0)
        widest = float(max(-low[0], high[0]))
        if widest > self.builder.reach:
            self.builder = replace(self.builder, least_reach=1.08 * widest)
        reach, depth = self.builder.reach, _GROUND_DEPTH * self.builder.reach
        self.axes.set_xlim(-reach, reach)
        self.axes.set_ylim(low[1] - depth, high[1] + 0.06 * (high[1] - low[1]))

    def draw_at_rest(self, placement: Placement) -> None:
        """Draw the bodies at rest behind everything."""
        from matplotlib.patches import Polygon

        for outline in self.builder.layout_at(placement).bodies:
            dashed = Polygon(outline, fill=False, edgecolor=GREY, linestyle="--", linewidth=0.8)
            self.axes.add_patch(dashed).set_zorder(1)

    def set_points(self, points: Mapping[str, tuple[float, ...]]) -> None:
        """Set the points of the body that are marked, by their names."""
        self._points = {name: np.array([place]) for name, place in points.items()}

    def draw(self, placement: Placement) -> None:
        """Draw all artists, or move them."""
        layout = self.builder.layout_at(placement)
        self._draw_ground(layout)
        for number, wall in enumerate(self.builder.geometry.walls):
            self._draw_polygon(f"wall {number}", wall, GREY, 2).set(hatch="///")
        if layout.cap is not None:
            self._draw_polygon("cap", layout.cap, ORANGE, 3)
        for number, body in enumerate(layout.lower_bodies):
            self._draw_polygon(f"stack {number}", body, ORANGE, 3, alpha=0.22)
        for number, pad in enumerate(layout.pads):
            artist = self._draw_polygon(f"pads {number}", pad, GREY, 3)
            pressed = layout.pads_in_contact[number]
            artist.set(facecolor=CONTACT_COLOUR if pressed else GREY, alpha=0.75)
        self._draw_polygon("block", layout.block, BLUE, 4, alpha=0.08 if layout.members else 0.22)
        for number, member in enumerate(layout.members):
            self._draw_polygon(f"member {number}", member, BLUE, 4, alpha=0.3)
        for number, outline in enumerate(layout.frame_parts):
            self._draw_polygon(f"other {number}", outline, BLUE, 4, alpha=0.22)
        for number, ends in enumerate(layout.restrainers):
            self._draw_line(
                f"tie {number}", ends, color=VERMILLION, linewidth=1.4, zorder=5, marker="."
            )  # which shows one without a length
        self._draw_dots("centre", layout.centres, marker="P", color=text_colour(), markersize=6.0)
        self._draw_contacts(layout)
        for name, place in self._points.items():
            self._draw_point(name, self.builder.points_at(placement, place))

    def draw_legend(self) -> None:
        """Write the names of the parts next to the drawing."""
        handles = [
            (self._artists[key], words)
            for slot, words in self._legend_names.items()
            for key in (slot, f"{slot} 0")
            if key in self._artists
        ]
        self.axes.legend(
            *zip(*handles, strict=True), loc="center left", bbox_to_anchor=(1.02, 0.5),
            frameon=False, fontsize="small",
        )  # fmt: skip

    def _draw_ground(self, layout: Layout) -> None:
        floor = self.axes.get_ylim()[0]
        surface = layout.ground if layout.soil is None else layout.soil
        band = np.vstack([surface, [(surface[-1, 0], floor), (surface[0, 0], floor)]])
        if layout.soil is not None:
            self._draw_polygon("soil", band, SOIL_COLOUR, 2, alpha=0.3)
            return
        artist = self._draw_polygon("ground", band, GREY, 2, alpha=0.35)
        artist.set(hatch="///", linewidth=0.0)
        self._draw_line("surface", layout.ground, color=text_colour(), linewidth=1.0, zorder=2)

    def _draw_contacts(self, layout: Layout) -> None:
        dots = [contact for contact in layout.contacts if len(contact) == 1]
        lines = [contact for contact in layout.contacts if len(contact) > 1]
        points = np.vstack(dots or [_NO_POINT])
        self._draw_dots("touching", points, color=CONTACT_COLOUR, markersize=6.0)
        apart = [part for line in lines for part in (line, _NO_POINT)] or [_NO_POINT]
        self._draw_line(
            "bearing", np.vstack(apart), color=CONTACT_COLOUR, linewidth=3.0, zorder=5,
            solid_capstyle="butt",
        )  # fmt: skip

    def _draw_point(self, name: str, place: Array) -> None:
        self._draw_dots(f"point {name}", place, color=GREEN, marker="D", markersize=4.5)
        key = f"name of {name}"
        if key not in self._artists:
            self._artists[key] = self.axes.annotate(
                as_label(name), (0.0, 0.0), xytext=(5, 3), textcoords="offset points",
                fontsize="small", zorder=7,
            )  # fmt: skip
        self._artists[key].xy = tuple(place[0])

    def _draw_polygon(
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

    def _draw_dots(self, key: str, places: Array, **style: Any) -> None:
        self._draw_line(key, places, **{"linestyle": "none", "marker": "o", "zorder": 6, **style})

    def _draw_line(self, key: str, places: Array, **style: Any) -> None:
        if key not in self._artists:
            (self._artists[key],) = self.axes.plot([], [], **style)
        self._artists[key].set_data(places[:, 0], places[:, 1])


_LINE_LENGTH: Final = 32
"""Longest line on a body of a stack, or on a load [characters]."""
_DRAWN_ARGUMENTS: Final = ("name", "on", "to", "on_body", "to_body", "depth")
"""Arguments of links that the drawing shows, and which the names omit."""


def part_labels(parts: Parts, geometry: Geometry, units: DisplayUnits) -> dict[str, str]:
    """Return the names of the parts of a scene, with their parameters, by their slots."""
    labels: dict[str, list[str]] = {}
    for slot in ("block", "pads", "cap", "soil"):
        part = parts.components.get(slot)
        if part is not None:
            labels[slot] = [type(part).__name__, *_parameter_texts(part, units)]
    for number, wall in enumerate(parts.walls):
        title = type(wall).__name__
        if len(parts.walls) > 1:
            names = [name for name, link in parts.named_links if isinstance(link, RearWall)]
            title = f"{as_label(names[number])}: {title}"
        labels[f"wall {number}"] = [title, *_parameter_texts(wall, units, ("name",))]
    if parts.frame is not None:
        column = [f"column {text}" for text in _parameter_texts(parts.frame.column, units)]
        frame_texts = _parameter_texts(parts.frame, units)
        labels["block"] = [type(parts.frame).__name__, *column, *frame_texts]
    if parts.stack is not None:
        bases = [*parts.stack.interfaces, None]
        for k, (body, base) in enumerate(zip(parts.stack.bodies, bases, strict=True)):
            parameters = _wrapped_lines(_parameter_texts(body, units))
            lines = [f"body {k + 1}: {type(body).__name__}", *parameters]
            if base is not None:
                lines += _wrapped_lines(
                    [f"on {type(base).__name__}", *_parameter_texts(base, units)]
                )
            labels[f"stack {k - 1}" if k else "block"] = lines
    if parts.stack is not None and "pads" in labels:  # pads are not drawn below a stack
        labels["ground"] = labels.pop("pads")
    elif geometry.soil_settlement is None:
        labels["ground"] = [
            "rigid ground",
            *_parameter_texts(parts.components.get("ground"), units),
        ]
    for number, (name, link) in enumerate(parts.named_links):
        lines = [as_label(name), *_parameter_texts(link, units, _DRAWN_ARGUMENTS)]
        if number < len(geometry.links):
            labels[f"tie {number}"] = lines[:1] if isinstance(link, RearWall) else lines
        elif isinstance(link, Load):  # not drawn, therefore listed with its body
            body = link.si.on_body - 1
            labels[f"stack {body - 1}" if body else "block"] += _wrapped_lines(lines)
    words = {slot: with_superscripts("\n   ".join(lines)) for slot, lines in labels.items()}
    return {**words, "centre": "centre of mass", "touching": "contact"}


def _wrapped_lines(words: Sequence[str]) -> list[str]:
    text = ", ".join(words).replace(" ", NO_BREAK).replace(f",{NO_BREAK}", ", ")
    return [line.replace(NO_BREAK, " ") for line in wrap(text, _LINE_LENGTH)]


def _parameter_texts(
    part: Component | None, units: DisplayUnits, without: Sequence[str] = ()
) -> list[str]:
    """Write the parameters of a part, in the reader's units if these are chosen."""
    if part is None:
        return []
    arguments = {name: argument for name, argument in part.to_dict().items() if name not in without}
    texts = readable_arguments(
        {name: argument for name, argument in arguments.items() if argument != "0.0 N"}
    )
    for name, argument in arguments.items():
        sentence = units.convert_text(str(argument))
        if sentence != str(argument):
            texts[name.replace("_", " ")] = sentence
    return [f"{name} {words}" for name, words in texts.items()]
