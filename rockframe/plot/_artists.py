"""The artists of a drawn scene, which are moved from one instant to the next."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from rockframe.notebook import arguments_in_words
from rockframe.plot._axes import BLUE, GREEN, GREY, ORANGE, VERMILLION, ink
from rockframe.plot._layout import Drawer, Layout
from rockframe.results.placement import Placement
from rockframe.signals.arrays import Array
from rockframe.system.geometry import Geometry
from rockframe.system.parts import Parts

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CONTACT: Final = VERMILLION
_SOIL: Final = "#a6794f"
_DEPTH: Final = 0.3
"""Of the ground that is drawn, over half its width."""


class SceneArtist:
    """A drawing that follows a scene."""

    def __init__(
        self, axes: "Axes", drawer: Drawer, names: Mapping[str, str] | None = None
    ) -> None:
        self.axes, self.drawer, self._names = axes, drawer, names or {}
        self._artists: dict[str, Any] = {}
        self._marked: dict[str, Array] = {}
        axes.set_aspect("equal")
        axes.set(xlabel="[m]", ylabel="[m]")
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)

    def frame(self, shown: Iterable[Placement]) -> None:
        """Set limits that hold the scene at all instants."""
        found = [self.drawer.lay_out(at) for at in shown]
        shown_parts = [
            part
            for one in found
            for part in (one.block, one.ground, *one.lower, *one.ties, *one.others)
        ]
        corners = np.vstack(shown_parts)
        low, high = corners.min(axis=0), corners.max(axis=0)
        widest = float(max(-low[0], high[0]))
        if widest > self.drawer.reach:
            self.drawer = self.drawer.widened(1.08 * widest)
        reach, depth = self.drawer.reach, _DEPTH * self.drawer.reach
        self.axes.set_xlim(-reach, reach)
        self.axes.set_ylim(low[1] - depth, high[1] + 0.06 * (high[1] - low[1]))

    def rest(self, at: Placement) -> None:
        """Draw the block at rest behind everything."""
        from matplotlib.patches import Polygon

        found = self.drawer.lay_out(at)
        for outline in (found.block, *found.others):
            dashed = Polygon(outline, fill=False, edgecolor=GREY, linestyle="--", linewidth=0.8)
            self.axes.add_patch(dashed).set_zorder(1)

    def mark(self, points: Mapping[str, tuple[float, ...]]) -> None:
        """Name the points of the body that are to be marked."""
        self._marked = {name: np.array([place]) for name, place in points.items()}

    def draw(self, at: Placement) -> None:
        """Draw, or move, all artists."""
        found = self.drawer.lay_out(at)
        self._ground(found)
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
            self._line(f"tie {number}", ends, color=VERMILLION, linewidth=1.4, zorder=5)
        self._dots("centre", found.centre[None], marker="P", color=ink(), markersize=6.0)
        self._touching(found)
        for name, place in self._marked.items():
            self._point(name, self.drawer.points(at, place))

    def legend(self) -> None:
        """Name the parts beside the drawing."""
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
            self._polygon("soil", band, _SOIL, 2, alpha=0.3)
            return
        artist = self._polygon("ground", band, GREY, 2, alpha=0.35)
        artist.set(hatch="///", linewidth=0.0)
        self._line("surface", found.ground, color=ink(), linewidth=1.0, zorder=2)

    def _touching(self, found: Layout) -> None:
        dots = [one for one in found.touching if len(one) == 1]
        lines = [one for one in found.touching if len(one) > 1]
        nowhere = np.full((1, 2), np.nan)
        self._dots("touching", np.vstack(dots or [nowhere]), color=CONTACT, markersize=6.0)
        apart = [part for one in lines for part in (one, nowhere)] or [nowhere]
        self._line(
            "bearing", np.vstack(apart), color=CONTACT, linewidth=3.0, zorder=5,
            solid_capstyle="butt",
        )  # fmt: skip

    def _point(self, name: str, place: Array) -> None:
        self._dots(f"point {name}", place, color=GREEN, marker="D", markersize=4.5)
        key = f"name of {name}"
        if key not in self._artists:
            self._artists[key] = self.axes.annotate(
                name, (0.0, 0.0), xytext=(5, 3), textcoords="offset points", fontsize="small",
                zorder=7,
            )  # fmt: skip
        self._artists[key].xy = tuple(place[0])

    def _polygon(
        self, key: str, corners: Array, colour: str, order: int, alpha: float = 0.35
    ) -> Any:
        from matplotlib.colors import to_rgba
        from matplotlib.patches import Polygon

        if key not in self._artists:
            self._artists[key] = self.axes.add_patch(
                Polygon(
                    corners,
                    closed=True,
                    facecolor=to_rgba(colour, alpha),
                    edgecolor=colour,
                    linewidth=1.2,
                    zorder=order,
                )
            )
        self._artists[key].set_xy(corners)
        return self._artists[key]

    def _dots(self, key: str, places: Array, **style: Any) -> None:
        self._line(key, places, **{"linestyle": "none", "marker": "o", "zorder": 6, **style})

    def _line(self, key: str, places: Array, **style: Any) -> None:
        if key not in self._artists:
            (self._artists[key],) = self.axes.plot([], [], **style)
        self._artists[key].set_data(places[:, 0], places[:, 1])


def part_labels(parts: Parts, geometry: Geometry) -> dict[str, str]:
    """Give what the parts of a scene are called, with their numbers, by their slots."""
    found: dict[str, str] = {}
    lower = () if parts.stack is None else parts.stack.bodies
    named = {slot: parts.components().get(slot) for slot in ("block", "pads", "cap", "soil")}
    if parts.frame is not None:
        named["block"] = parts.frame
    named |= {f"stack {k - 1}" if k else "block": body for k, body in enumerate(lower)}
    for slot, part in named.items():
        if part is not None:
            numbers = [
                f"{name} {value}" for name, value in arguments_in_words(part.to_dict()).items()
            ]
            found[slot] = "\n   ".join([type(part).__name__, *numbers])
    if geometry.bed_sinks is None:
        found["ground"] = "rigid ground"
    return {**found, "centre": "centre of mass", "touching": "contact"}
