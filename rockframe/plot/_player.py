"""A page that plays a run, drawn by the browser from numbers."""

import base64
import json
import re
import zlib
from collections.abc import Callable, Iterator, Sequence
from html import escape
from importlib import resources
from pathlib import Path
from typing import Any, Final, NamedTuple, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_text
from rockframe.motion.display import motion_words
from rockframe.plot._artists import CONTACT_COLOUR, SOIL_COLOUR
from rockframe.plot._axes import BLUE, GREEN, ORANGE, VERMILLION, figure_units
from rockframe.plot._checks import RUN, checked_run, draws
from rockframe.plot._layout import Layout
from rockframe.plot._response import (
    BODY_SLIP,
    CAP_SLIP,
    CONTACT_COLOURS,
    SLIP,
    contact_strips,
    rotation_in,
)
from rockframe.plot._runs import Window, read_runs, verdict_of_case
from rockframe.plot._scene import SceneHistory
from rockframe.results.outcome import MIN_REPORTED_SLIP
from rockframe.results.variables.variable import flag_words
from rockframe.signals.arrays import Array
from rockframe.suggestions import suggests_names
from rockframe.units import ACCELERATION, ANGLE, LENGTH
from rockframe.units.display import UnitsLike, with_superscripts
from rockframe.version import __version__
from rockframe.writing import FileKind, generator_tag, write_file

_FRAMES_PER_SECOND: Final = 25.0
_MAX_FRAMES: Final = 900
"""Largest number of instants of a page; the browser interpolates between them."""
_TRACE_INTERVALS: Final = 700
"""Number of intervals of time; of each, a trace has the least and the largest value."""
_MAX_SLIP_TRACES: Final = 4
"""Largest number of traces of slip."""
_ROUNDING: Final = 1e-9
"""Ends of a trace below this share of its range are rounding, and set to zero."""
_STEP_COUNT: Final = 30000
"""Steps between the least and the largest number of a kind in a page."""
_MISSING: Final = -32768
_TEMPLATE: Final = "player.html"
_TITLE: Final = "player"
FILE_KIND: Final = FileKind.marked(
    "a player", (".html", ".htm"), generator_tag(_TITLE), generator_tag("animation")
)
_FRAME_HEIGHT: Final = 640
"""Height of the player in a notebook [pixels]."""


class _Layer(NamedTuple):
    """One thing that is drawn."""

    name: str
    shape: str  # name of the function that draws it in the page
    colour: str  # "ink" is that of the page's text, "soft" that of its background
    fill: float  # opacity [1]
    points: Array  # at all instants, shape (instants, points, 2) [m]


@suggests_names
class Player:
    """A page that plays a run, a few tens of kilobytes in size.

    Notebooks show it; :meth:`save` writes it to a file that needs no other file and no network.

    Parameters
    ----------
    html : str
        The page.
    length : float
        Duration of the run in the page [s].

    Examples
    --------
    >>> import tempfile
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
    >>> player = rf.plot.player(run)
    >>> player.save(f"{tempfile.mkdtemp()}/run.html").name, player.to_html()[:15]
    ('run.html', '<!doctype html>')
    """

    def __init__(self, html: str, length: float) -> None:
        self._html, self._length = html, length

    def save(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write the page to a file.

        Parameters
        ----------
        path : str or Path
            A file whose name ends in ``.html``.
        overwrite : bool, optional
            Whether to replace an existing file that is not a player written by this method.

        Returns
        -------
        Path

        Raises
        ------
        FileError
            Another ending, or a file that cannot be written or is not replaced.
        """
        return write_file(path, FILE_KIND, self._html, overwrite=overwrite)

    def to_html(self) -> str:
        """Return the page.

        Returns
        -------
        str
        """
        return self._html

    def _repr_html_(self) -> str:
        style = f"width:100%;height:{_FRAME_HEIGHT}px;border:0"
        return f'<iframe title="player" style="{style}" srcdoc="{escape(self._html)}"></iframe>'

    def __repr__(self) -> str:
        return f"<player of {self._length:.1f} s, {len(self._html) / 1e3:.0f} kB; save('run.html')>"


@draws(RUN, title="the verdict")
def player(
    run: xr.Dataset,
    *,
    window: Window = None,
    magnify: float = 1.0,
    rotation: str | None = None,
    units: UnitsLike = None,
    title: str | None = None,
) -> Player:
    """Make a page that plays a run: the scene above histories of rotation, slip and the ground.

    The page has a button to play, a slider, a choice of speeds, a cursor in the histories that
    follows the pointer, and a strip of contact states. The browser draws it from the numbers. It
    is therefore made in a fraction of a second, while an :func:`animation` is drawn frame by
    frame.

    Returns
    -------
    Player

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
    >>> player = rf.plot.player(run, title="A block")
    >>> "A block" in player.to_html()
    True
    >>> player.save("run.html")  # doctest: +SKIP
    """
    run = checked_run(run, "player")
    (shown_run,) = read_runs(run, "player", window)
    axis_units = figure_units(units, "player")
    unit = axis_units.unit_or_relative(ANGLE, rotation=axis_units.rotation_unit(rotation))
    ground = axis_units.axis_unit(ACCELERATION)
    history = SceneHistory(shown_run.dataset, "player", magnify, axis_units)
    start, end = float(shown_run.time[0]), float(shown_run.time[-1])
    count = int(np.clip(1 + round((end - start) * _FRAMES_PER_SECOND), 2, _MAX_FRAMES))
    samples = shown_run.nearest(np.linspace(start, end, count))
    store = _PackedNumbers()
    layers = _layers(history, samples, store)
    of_body = " of body 1" if "body" in shown_run.dataset.dims else ""
    label = _label_with_unit(f"rotation{of_body}", "-" if unit is None else unit.words)
    length = axis_units.axis_unit(LENGTH)
    traces = [
        _trace_data(rotation_in(unit, shown_run.dataset["rotation"], shown_run.dataset),
                    label, BLUE, store),
        *(_trace_data(length.of(slip), _label_with_unit(name, length.words), ORANGE, store)
          for name, slip in _largest_slips(shown_run.dataset)),
        _trace_data(ground.of(shown_run.dataset["ground_acceleration"]),
               _label_with_unit("ground acceleration", ground.words), "ink", store),
    ]  # fmt: skip
    sentence = (
        verdict_of_case(run, axis_units.reader)
        if title is None
        else checked_text(title, owner="rf.plot.player", name="title")
    )
    data = {
        "times": [round(float(time), 6) for time in shown_run.time[samples]],
        "layers": layers,
        "traces": traces,
        "strips": [
            _strip_data(state, words) for state, words in contact_strips([shown_run]).values()
        ],
        "colours": CONTACT_COLOURS,
        "pressed": CONTACT_COLOUR,
        "magnify": float(magnify),
        "length": {"words": with_superscripts(length.words), "size": length.size},
        "levels": _STEP_COUNT,
        "nowhere": _MISSING,
        "numbers": store.packed(),
    }
    html = _fill_template(sentence, motion_words(run.attrs), data)
    return Player(html, end - start)


class _PackedNumbers:
    """Columns of numbers as integer multiples of steps, one after another."""

    def __init__(self) -> None:
        self._columns: list[np.ndarray] = []

    def add(self, values: np.ndarray, low: float, high: float) -> int:
        """Add columns, with NaN for missing values, and give the place of the first."""
        step = (high - low) / _STEP_COUNT or 1.0
        integers = np.where(np.isnan(values), _MISSING, np.rint((values - low) / step))
        before = sum(column.size for column in self._columns)
        self._columns.append(integers.astype(np.int64).T.ravel())
        return before

    def packed(self) -> str:
        """Return the differences of neighbours as compressed text."""
        integers = np.concatenate(self._columns)
        steps = np.diff(integers, prepend=0).astype("<i2")  # modulo 2**16, as the page adds them up
        # first all low bytes, then all high bytes: these are mostly equal, and compress well
        halves = steps.view(np.uint8).reshape(-1, 2).T.tobytes()
        return base64.b64encode(zlib.compress(halves, 9)).decode()


def _layers(history: SceneHistory, shown_at: np.ndarray, store: _PackedNumbers) -> dict[str, Any]:
    """Return everything that is drawn, at all instants."""
    placements = [history.placement_at(int(place)) for place in shown_at]
    layouts = [history.builder.layout_at(at) for at in placements]
    layers = [*_part_layers(history, layouts)]
    layers += [
        _Layer(name, "point", GREEN, 1.0,
               np.array([history.builder.points_at(at, np.array([place])) for at in placements]))
        for name, place in history.points.items()
    ]  # fmt: skip
    corners = np.concatenate([layer.points for layer in layers if layer.shape != "ground"], axis=1)
    low, high = np.nanmin(corners, axis=(0, 1)), np.nanmax(corners, axis=(0, 1))
    reach = max(history.builder.reach, 1.08 * float(max(-low[0], high[0])))
    depth, air = 0.3 * history.builder.reach, 0.06 * float(high[1] - low[1])
    left, bottom = -reach, min(float(low[1]), 0.0) - depth
    width, height = 2.0 * reach, float(high[1]) + air - bottom
    listed = list[dict[str, Any]]()
    for name, shape, colour, fill, points in layers:
        if shape == "ground":  # from one edge of the drawing to the other
            points[:, 0, 0], points[:, -1, 0] = left, left + width
        columns = (points - (left, bottom)).reshape(len(layouts), -1)
        listed.append({
            "name": name, "shape": shape, "colour": colour, "fill": fill,
            "points": points.shape[1], "first": store.add(columns, 0.0, max(width, height)),
        })  # fmt: skip
    pads = np.array([layout.pads_in_contact for layout in layouts], np.float64)
    pressed = store.add(pads, 0.0, 1.0) if layouts[0].pads else None
    return {"left": left, "bottom": bottom, "width": width, "height": height, "pressed": pressed,
            "list": listed}  # fmt: skip


def _part_layers(history: SceneHistory, layouts: Sequence[Layout]) -> Iterator[_Layer]:
    """Return the parts of a scene and their contacts, from the back to the front."""
    upright, first = history.builder.layout_at(history.upright), layouts[0]

    def still(points: Array) -> Array:
        return np.repeat(points[None], len(layouts), axis=0)

    def moving(points_of: Callable[[Layout], Any]) -> Array:
        return np.array([points_of(layout) for layout in layouts])

    def each(name: str, shape: str, colour: str, fill: float) -> Iterator[_Layer]:
        for places in zip(*(getattr(layout, name) for layout in layouts), strict=True):
            yield _Layer(name, shape, colour, fill, np.array(places))

    if first.soil is None:
        yield _Layer("ground", "ground", "soft", 0.35, moving(lambda layout: layout.ground))
    else:
        yield _Layer("soil", "ground", SOIL_COLOUR, 0.35, moving(_surface_corners))
    for outline in upright.bodies:
        yield _Layer("at rest", "dashes", "soft", 0.0, still(outline))
    for wall in upright.walls:
        yield _Layer("wall", "outline", "soft", 0.35, still(wall))
    if first.cap is not None:
        yield _Layer("cap", "outline", ORANGE, 0.3, moving(lambda layout: layout.cap))
    yield from each("lower_bodies", "outline", ORANGE, 0.25)
    yield from each("beds", "outline", SOIL_COLOUR, 0.5)
    yield from each("pads", "outline", "soft", 0.7)
    yield from each("frame_parts", "outline", BLUE, 0.25)
    fill = 0.08 if first.members else 0.25
    yield _Layer("block", "outline", BLUE, fill, moving(lambda layout: layout.block))
    yield from each("members", "outline", BLUE, 0.3)
    yield from each("restrainers", "line", VERMILLION, 0.0)
    for k in range(len(first.loads)):
        yield _Layer("load", "point", GREEN, 1.0, moving(lambda layout, k=k: layout.loads[[k]]))
    yield _Layer("centre of mass", "cross", "ink", 1.0, moving(lambda layout: layout.centres))
    for contacts in zip(*(layout.contacts for layout in layouts), strict=True):
        ends = np.array([contact[[0, -1]] for contact in contacts])  # a point's coincide
        yield _Layer("contact", "contact", CONTACT_COLOUR, 0.0, ends)


def _largest_slips(run: xr.Dataset) -> list[tuple[str, xr.DataArray]]:
    """Return the slips of the bodies that slid farthest, with their names."""
    slips = {SLIP: run[SLIP]} if SLIP in run else {}
    if BODY_SLIP in run:
        slips = {
            f"slip of body {int(slip.body)}": slip for slip in run[BODY_SLIP].transpose("body", ...)
        }
    elif CAP_SLIP in run:
        slips |= {"slip of the cap": run[CAP_SLIP]}
    largest = {name: float(np.abs(slip).max()) for name, slip in slips.items()}
    names = sorted(
        (name for name in largest if largest[name] >= MIN_REPORTED_SLIP), key=largest.__getitem__
    )
    return [(name, slip) for name, slip in slips.items() if name in names[-_MAX_SLIP_TRACES:]]


def _surface_corners(layout: Layout) -> Array:
    """Return the corners of the surface of the soil, which is straight between them."""
    surface = cast("Array", layout.soil)
    bend = int(np.argmax(np.abs(np.diff(surface[:, 1], 2)[2:-2]))) + 3
    return surface[[0, 1, 2, bend, -3, -2, -1]]


def _label_with_unit(words: str, unit: str) -> str:
    return f"{words} [{with_superscripts(unit)}]"


def _trace_data(
    values: np.ndarray, label: str, colour: str, store: _PackedNumbers
) -> dict[str, Any]:
    """Return the least and the largest value in equal intervals of time."""
    edges = np.linspace(0, values.size, min(_TRACE_INTERVALS, values.size) + 1).astype(int)
    least = np.minimum.reduceat(values, edges[:-1])
    most = np.maximum.reduceat(values, edges[:-1])
    low, high = min(0.0, float(least.min())), max(0.0, float(most.max()))
    rounding = _ROUNDING * (high - low)
    low, high = (end if abs(end) > rounding else 0.0 for end in (low, high))
    first = store.add(np.column_stack([least, most]), low, high)
    return {"label": label, "colour": colour, "first": first, "parts": least.size, "low": low,
            "high": high}  # fmt: skip


def _strip_data(state: xr.DataArray, words: str) -> dict[str, Any]:
    """Return the instants at which contact changes, and the state after each."""
    values, time = state.to_numpy(), state["time"].to_numpy()
    changes = np.flatnonzero(np.diff(values, prepend=values[0] - 1))
    names = flag_words(state.attrs)
    return {"words": words, "times": [round(float(time[k]), 6) for k in changes],
            "states": [names[int(values[k])] for k in changes]}  # fmt: skip


def _fill_template(sentence: str, motion: str, data: dict[str, Any]) -> str:
    # otherwise "</script>" in a text would end the script
    written = json.dumps(data, separators=(",", ":")).replace("</", "<\\/")
    page = resources.files("rockframe.plot").joinpath(_TEMPLATE).read_text(encoding="utf-8")
    filled = {"GENERATOR": generator_tag(_TITLE, __version__), "TITLE": escape(sentence or "A run"),
              "MOTION": escape(motion), "DATA": written}  # fmt: skip
    return re.sub(r"@(\w+)@", lambda match: filled[match[1]], page)
