"""The artists of a scene, which follow it over time, and the names of its parts."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from textwrap import wrap
from typing import Any, Final

import numpy as np

from rockframe.components import Component, Load, RearWall, Stack
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
from rockframe.plot._layout import NO_POINT, Layout, LayoutBuilder
from rockframe.plot._panels import NO_BREAK, Axes
from rockframe.results.points import Placement
from rockframe.signals.arrays import Array
from rockframe.system.geometry import Geometry
from rockframe.system.parts import Parts
from rockframe.units.display import DisplayUnits, with_superscripts

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
        shown_parts = list[Array]()
        for placement in placements:
            layout = self.builder.layout_at(placement)
            shown_parts += (layout.block, layout.ground, *layout.lower_bodies)
            shown_parts += (*layout.restrainers, *layout.frame_parts, *layout.walls)
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
        for number, wall in enumerate(layout.walls):
            self._draw_polygon(f"wall {number}", wall, GREY, 2).set(hatch="///")
        if layout.cap is not None:
            self._draw_polygon("cap", layout.cap, ORANGE, 3)
        for number, body in enumerate(layout.lower_bodies):
            self._draw_polygon(f"stack {number}", body, ORANGE, 3, alpha=0.22)
        for number, bed in enumerate(layout.beds):
            self._draw_polygon(f"bed {number}", bed, SOIL_COLOUR, 3, alpha=0.5)
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
                f"tie {number}", ends, color=VERMILLION, zorder=5, marker=".",
                linewidth=1.4 if len(ends) > 1 else 0.0,
            )  # fmt: skip
        if len(layout.loads):
            self._draw_dots("loads", layout.loads, marker="v", color=GREEN)
        self._draw_dots("centre", layout.centres, marker="P", color=text_colour(), markersize=6.0)
        self._draw_contacts(layout)
        for name, place in self._points.items():
            self._draw_point(name, self.builder.points_at(placement, place))

    @property
    def moving(self) -> list[Any]:
        """All artists that can move."""
        still = ("ground", "surface", "wall")
        return [one for key, one in self._artists.items() if not key.startswith(still)]

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
        points = np.vstack(dots or [NO_POINT])
        self._draw_dots("touching", points, color=CONTACT_COLOUR, markersize=4.5)
        apart = [part for line in lines for part in (line, NO_POINT)] or [NO_POINT]
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
    loads: dict[int, list[str]] = {}
    for name, link in parts.named_links:
        if isinstance(link, Load):  # listed with its body
            lines = [as_label(name), *_parameter_texts(link, units, _DRAWN_ARGUMENTS)]
            loads.setdefault(link.si.on_body - 1, []).extend(_wrapped_lines(lines))
    if parts.stack is not None:
        labels |= _stack_labels(parts.stack, loads, units)
    elif parts.frame is not None:
        column = [f"column {text}" for text in _parameter_texts(parts.frame.column, units)]
        frame_texts = _parameter_texts(parts.frame, units)
        labels["block"] = [type(parts.frame).__name__, *column, *frame_texts]
    for slot in ("block", "pads", "cap", "soil"):
        part = parts.components.get(slot)
        if part is not None:
            key = "member" if slot == "block" and geometry.members else slot
            of_load = loads.get(0, []) if slot == "block" else []
            labels[key] = [type(part).__name__, *_parameter_texts(part, units), *of_load]
    names = [name for name, link in parts.named_links if isinstance(link, RearWall)]
    for number, wall in enumerate(parts.walls):
        title = type(wall).__name__
        if len(parts.walls) > 1:
            title = f"{as_label(names[number])}: {title}"
        labels[f"wall {number}"] = [title, *_parameter_texts(wall, units, ("name",))]
    if not geometry.on_soil:
        ground = _parameter_texts(parts.components.get("ground"), units)
        labels["ground"] = ["rigid ground", *ground]
    for number, (name, link) in enumerate(parts.named_links[: len(geometry.links)]):
        lines = [as_label(name), *_parameter_texts(link, units, _DRAWN_ARGUMENTS)]
        if isinstance(link, RearWall):
            lines = [f"{as_label(name)}, where it is struck"]
        labels[f"tie {number}"] = lines
    labels["loads"] = ["load"]
    words = {slot: with_superscripts("\n   ".join(lines)) for slot, lines in labels.items()}
    return {**words, "centre": "centre of mass", "touching": "contact"}


def _stack_labels(
    stack: Stack, loads: Mapping[int, list[str]], units: DisplayUnits
) -> dict[str, list[str]]:
    """Return the names of bodies with their bases; equal ones of one colour have one."""
    entries = list[tuple[bool, str, list[str]]]()
    bases = [*stack.interfaces, None]
    for k, (body, base) in enumerate(zip(stack.bodies, bases, strict=True)):
        lines = _wrapped_lines(_parameter_texts(body, units))
        if base is not None:
            lines += _wrapped_lines([f"on {type(base).__name__}", *_parameter_texts(base, units)])
        entries.append((k == 0, type(body).__name__, [*lines, *loads.get(k, [])]))
    labels, number = dict[str, list[str]](), 0
    for (_, kind, lines), equal in groupby(entries):
        last = number + len(list(equal))
        which = f"body {last}" if last == number + 1 else f"bodies {number + 1} to {last}"
        labels[f"stack {number - 1}" if number else "block"] = [f"{which}: {kind}", *lines]
        number = last
    return labels


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
