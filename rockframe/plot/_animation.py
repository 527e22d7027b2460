"""Animations of runs: the scene, with the history of the rotation below."""

from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.errors import FileError
from rockframe.plot._artists import CONTACT_COLOUR, SceneArtist
from rockframe.plot._axes import BLUE, GREY, figure_units
from rockframe.plot._checks import RUN, checked_run, draws, read_positive
from rockframe.plot._panels import AxesLike, Figure, Panels, make_sheet
from rockframe.plot._player import FILE_KIND, Player, player
from rockframe.plot._response import contact_strips, response
from rockframe.plot._runs import Window, read_runs, verdict_of_case
from rockframe.plot._scene import SceneHistory, figure_size
from rockframe.suggestions import suggests_names
from rockframe.units import LENGTH
from rockframe.units.display import UnitsLike
from rockframe.version import __version__
from rockframe.writing import FileKind, checked_path, write_file

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.artist import Artist
else:
    Artist = Any


_MAX_FRAMES: Final = 200
"""Largest number of frames unless the speed is given."""
_SAMPLES_FOR_LIMITS: Final = 60
"""Number of instants from which the limits of the drawing follow."""
_SIGNATURE: Final = "animation by rockframe "
_STAMP: Final = f"{_SIGNATURE}{__version__}".encode()
_COMMENT: Final = b"\x21\xfe%c%b\x00" % (len(_STAMP), _STAMP)  # a block of GIF89a
_TRAILER: Final = b"\x3b"
"""The last byte of a GIF."""
FILM_KIND: Final = FileKind.marked(
    "an animation", (".gif", ".mp4", *FILE_KIND.suffixes), _SIGNATURE
)


def check_film_program(ending: str, path: str | Path) -> None:
    """Raise an error if the program that writes films with this ending is missing."""
    from matplotlib.animation import FFMpegWriter

    if ending == ".mp4" and not FFMpegWriter.isAvailable():
        reason = "needs the program ffmpeg, which was not found; '.gif' and '.html' do without"
        raise FileError(str(path), reason)


class _FilmedFigure:
    """A figure for the writers of films; all but the artists that move is drawn once."""

    def __init__(self, figure: Figure, draw: Callable[[int], Iterable[Artist]]) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        self.figure, self.number, self._draw, self._still = figure, 0, draw, None
        self._canvas = FigureCanvasAgg(figure)

    @classmethod
    @contextmanager
    def of(
        cls, figure: Figure, draw: Callable[[int], Iterable[Artist]], pixels: float
    ) -> "Generator[_FilmedFigure]":
        """Draw a figure on a canvas of pixels, and return it to its own canvas."""
        canvas, size, dpi = figure.canvas, tuple(figure.get_size_inches()), figure.dpi
        try:
            filmed = cls(figure, draw)
            figure.dpi = pixels
            yield filmed
        finally:
            for artist in draw(0):
                artist.set_animated(False)
            figure.set_size_inches(size, forward=False)
            figure.set_dpi(dpi)
            figure.set_canvas(canvas)

    def savefig(self, file: Any, **_: Any) -> None:
        """Write a frame as a writer expects it."""
        moving = sorted(self._draw(self.number), key=lambda artist: artist.get_zorder())
        if self._still is None:  # a writer has set the size
            for artist in moving:
                artist.set_animated(True)
            self._canvas.draw()
            self._still = self._canvas.copy_from_bbox(self.figure.bbox)
        self._canvas.restore_region(self._still)
        for artist in moving:
            cast("Any", artist.axes).draw_artist(artist)
        file.write(self._canvas.buffer_rgba())

    def __getattr__(self, name: str) -> Any:
        return getattr(self.figure, name)


@suggests_names
class Animation:
    """A run as an animation.

    Notebooks show it as a :class:`Player`; :meth:`save` writes a film, or the page of the player;
    :meth:`play` shows it in a window.

    Parameters
    ----------
    panels : Panels
        The panels of the figure.
    draw : callable
        Draws a frame by its number, and returns the artists that move.
    rate : float
        Frames per second.
    times : ndarray, shape (frames,)
        Times of the frames in the run [s].
    player : callable
        Makes a player of the same run.

    Examples
    --------
    >>> import tempfile
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
    >>> movie = rf.plot.animation(run)
    >>> movie.save(f"{tempfile.mkdtemp()}/run.html").name, movie.to_html()[:15]
    ('run.html', '<!doctype html>')
    >>> movie.play()  # in a window  # doctest: +SKIP
    >>> movie.close()
    """

    def __init__(
        self,
        panels: Panels,
        draw: Callable[[int], Iterable[Artist]],
        rate: float,
        times: np.ndarray,
        player: Callable[[], Player],
    ) -> None:
        self._draw, self._rate, self._player = draw, rate, player
        self._playing: FuncAnimation | None = None
        self.panels = panels
        self.times = times

    @property
    def figure(self) -> Figure:
        """The figure in which the frames are drawn."""
        return self.panels.figure

    def save(self, path: str | Path, *, dpi: float = 100.0, overwrite: bool = False) -> Path:
        """Write the animation into a file.

        Parameters
        ----------
        path : str or Path
            A file whose name ends in ``.gif``; in ``.mp4``, which needs ffmpeg; or in ``.html``,
            for the page of :func:`player`.
        dpi : float, optional
            Pixels per inch of the frames of a film.
        overwrite : bool, optional
            Whether to replace an existing file that is not an animation written by this method.

        Returns
        -------
        Path

        Raises
        ------
        FileError
            Another ending, a file that cannot be written or is not replaced, or no ffmpeg.
        UnitsError, ComponentError
            `dpi` is not a number above zero.
        """
        from matplotlib.animation import FFMpegWriter, PillowWriter

        ending = Path(str(path)).suffix.lower()
        if ending in FILE_KIND.suffixes:
            return self._player().save(path, overwrite=overwrite)
        pixels = read_positive(dpi, "animation", "dpi")
        # checked before the frames are drawn, which takes a while
        checked_path(path, FILM_KIND, overwrite=overwrite)
        check_film_program(ending, path)

        def write(part: Path) -> None:
            writer: Any = PillowWriter(cast("Any", self._rate))
            if ending == ".mp4":
                note = {"comment": _STAMP.decode()}
                writer = FFMpegWriter(fps=cast("Any", self._rate), metadata=note)
                # the height and the width of a film are even
                writer.extra_args = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-f", "mp4"]
            with (
                _FilmedFigure.of(self.figure, self._draw, pixels) as filmed,
                writer.saving(filmed, part, pixels),
            ):
                for filmed.number in range(self.times.size):
                    writer.grab_frame()
            if ending != ".mp4":
                drawn = part.read_bytes()
                part.write_bytes(drawn.removesuffix(_TRAILER) + _COMMENT + _TRAILER)

        return write_file(path, FILM_KIND, write, overwrite=overwrite)

    def to_html(self) -> str:
        """Return the page of :func:`player`.

        Returns
        -------
        str
        """
        return self._player().to_html()

    def play(self) -> None:
        """Play it in the window of ``figure.show()``, as long as this object exists."""
        self._playing = self._film()

    def close(self) -> None:
        """Close the figure."""
        from matplotlib import pyplot

        pyplot.close(self.figure)

    def _film(self) -> "FuncAnimation":
        from matplotlib.animation import FuncAnimation

        draw = cast("Any", self._draw)
        return FuncAnimation(self.figure, draw, self.times.size, interval=1e3 / self._rate)

    def _repr_html_(self) -> str:
        self.close()  # otherwise the notebook would show the last frame too
        return self._player()._repr_html_()  # pyright: ignore[reportPrivateUsage]

    def __repr__(self) -> str:
        length = self.times.size / self._rate
        return f"<animation of {self.times.size} frames, {length:.1f} s; save('run.gif')>"


@draws(
    RUN,
    ax="sequence of Axes, for the scene, the rotation and each strip of contact",
    title="the verdict",
)
def animation(
    run: xr.Dataset,
    *,
    window: Window = None,
    speed: float | None = None,
    frames_per_second: float = 20.0,
    magnify: float = 1.0,
    rotation: str | None = None,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Animation:
    """Animate a run: the scene to scale with its contacts, above the history of the rotation.

    Parameters
    ----------
    speed : float, optional
        Time of the run over that of the animation. Unless given 1, or more if the animation would
        have more than 200 frames [1].
    frames_per_second : float, optional
        Frame rate of the animation [s^-1].

    Returns
    -------
    Animation
        Its frames show the nearest samples of the run. The strip at the bottom shows contact
        that changes faster than the frames.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
    >>> movie = rf.plot.animation(run)
    >>> movie
    <animation of 21 frames, 1.1 s; save('run.gif')>
    >>> movie.save("run.gif")  # doctest: +SKIP
    """
    run = checked_run(run, "animation")
    (shown_run,) = read_runs(run, "animation", window)
    rate = read_positive(frames_per_second, "animation", "frames_per_second")
    length = float(shown_run.time[-1] - shown_run.time[0])
    needed_speed = max(1.0, length * rate / _MAX_FRAMES)
    playback_speed = needed_speed if speed is None else read_positive(speed, "animation", "speed")
    count = max(2, 1 + round(length * rate / playback_speed))
    times = np.linspace(shown_run.time[0], shown_run.time[-1], count)
    axis_units = figure_units(units, "animation")
    rotation_unit = axis_units.rotation_unit(rotation)
    history = SceneHistory(shown_run.dataset, "animation", magnify, axis_units)
    samples = shown_run.nearest(times)
    width, height = figure_size(history.builder, wide=False)
    names = ["scene", "rotation", *contact_strips([shown_run])]
    heights = [height, 1.3, *[0.42] * (len(names) - 2)]
    sheet = make_sheet(
        ax, "animation", names, (max(width, 5.4), 0.6 + sum(heights)),
        nrows=len(names), height_ratios=heights,
    )  # fmt: skip
    above, trace, *strips = sheet.panels
    response(shown_run.dataset, panels=("rotation", "contact"), rotation=rotation_unit, units=units,
             ax=[trace, *strips])  # fmt: skip
    for axes in (trace, *strips)[:-1]:
        axes.tick_params(labelbottom=False)
    artist = SceneArtist(above, history.builder, length=axis_units.axis_unit(LENGTH))
    for_limits = samples[np.linspace(0, count - 1, min(count, _SAMPLES_FOR_LIMITS)).astype(int)]
    artist.set_points(history.points)
    artist.set_limits(
        [history.upright, *(history.placement_at(int(place)) for place in for_limits)]
    )
    artist.draw_at_rest(history.upright)
    cursors = [axes.axvline(times[0], color=GREY, linewidth=1.0) for axes in (trace, *strips)]
    line = trace.get_lines()[0]
    across, up = (np.asarray(values, np.float64) for values in line.get_data())
    (dot,) = trace.plot([], [], "o", color=BLUE, markersize=6.0, zorder=5)
    clock = above.set_title("", fontsize="medium")

    # drawn over what moves
    over = [spine for axes in sheet.panels for spine in axes.spines.values()]
    over += filter(None, [trace.get_legend()])

    def draw(number: int) -> list[Artist]:
        sample = int(samples[number])
        artist.draw(history.placement_at(sample))
        instant = float(shown_run.time[sample])
        for cursor in cursors:
            cursor.set_xdata([instant, instant])
        dot.set_data([across[sample]], [up[sample]])
        in_contact = any(history.placement_at(sample).bearing())
        dot.set_color(BLUE if in_contact else CONTACT_COLOUR)
        clock.set_text(history.caption(sample))
        return [*artist.moving, *cursors, dot, clock, *over]

    draw(0)
    sheet.set_title(verdict_of_case(run, axis_units.reader), title)
    if ax is None:  # the layout is computed once, not for every frame
        sheet.panels.figure.canvas.draw()
        sheet.panels.figure.set_layout_engine("none")
    page = partial(
        player, run, window=window, magnify=magnify, rotation=rotation, units=units, title=title
    )  # fmt: skip
    return Animation(sheet.panels, draw, rate, shown_run.time[samples], page)
