"""Animations of runs: the scene, with the history of the rotation below."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.errors import FileError
from rockframe.plot._artists import CONTACT, SceneArtist
from rockframe.plot._axes import BLUE, GREY, units_of
from rockframe.plot._checks import RUN, above_zero, checked_run, draws
from rockframe.plot._panels import AxesLike, Figure, Panels, sheet
from rockframe.plot._player import KIND, Player, player
from rockframe.plot._response import response, strips_of
from rockframe.plot._runs import Window, runs_of, verdict_of_case
from rockframe.plot._scene import Moving, figure_size
from rockframe.suggestions import suggests_names
from rockframe.units import LENGTH
from rockframe.units.display import UnitsLike
from rockframe.version import __version__
from rockframe.writing import FileKind, checked_path, write_file

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation


_USUAL_FRAMES: Final = 200
"""Largest number of frames unless the speed is given."""
_FRAMED: Final = 60
"""Number of instants from which the limits of the drawing follow."""
_MARK: Final = "animation by rockframe "
_SIGNED: Final = f"{_MARK}{__version__}".encode()
_COMMENT: Final = b"\x21\xfe%c%b\x00" % (len(_SIGNED), _SIGNED)  # a block of GIF89a
_TRAILER: Final = b"\x3b"
"""The last byte of a GIF."""
_PICTURES: Final = FileKind.marked("an animation", (".gif", ".mp4", *KIND.suffixes), _MARK)


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
        Draws a frame by its number.
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
    >>> moving = rf.plot.animation(run)
    >>> moving.save(f"{tempfile.mkdtemp()}/run.html").name, moving.to_html()[:15]
    ('run.html', '<!doctype html>')
    >>> moving.play()  # in a window  # doctest: +SKIP
    >>> moving.close()
    """

    def __init__(
        self,
        panels: Panels,
        draw: Callable[[int], object],
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
        if ending in KIND.suffixes:
            return self._player().save(path, overwrite=overwrite)
        dots = above_zero(dpi, "animation", "dpi")
        # checked before the frames are drawn, which takes a while
        checked_path(path, _PICTURES, overwrite=overwrite)
        if ending == ".mp4" and not FFMpegWriter.isAvailable():
            words = "needs the program ffmpeg, which was not found; '.gif' and '.html' do without"
            raise FileError(str(path), words)

        def write(part: Path) -> None:
            if ending == ".mp4":
                note = {"comment": _SIGNED.decode()}
                writer: Any = FFMpegWriter(fps=cast("Any", self._rate), metadata=note)
                # the height and the width of a film are even
                writer.extra_args = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-f", "mp4"]
                self._animated().save(part, writer=writer, dpi=dots)
                return
            self._animated().save(part, writer=PillowWriter(cast("Any", self._rate)), dpi=dots)
            drawn = part.read_bytes()
            part.write_bytes(drawn.removesuffix(_TRAILER) + _COMMENT + _TRAILER)

        return write_file(path, _PICTURES, write, overwrite=overwrite)

    def to_html(self) -> str:
        """Return the page of :func:`player`.

        Returns
        -------
        str
        """
        return self._player().to_html()

    def play(self) -> None:
        """Play it in the window of ``figure.show()``, as long as this object exists."""
        self._playing = self._animated()

    def close(self) -> None:
        """Close the figure."""
        from matplotlib import pyplot

        pyplot.close(self.figure)

    def _animated(self) -> "FuncAnimation":
        from matplotlib.animation import FuncAnimation

        def draw(number: int) -> list[Any]:
            self._draw(number)
            return []

        return FuncAnimation(
            self.figure, draw, frames=self.times.size, interval=1e3 / self._rate, blit=False
        )

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
    window : (str or Quantity or None, str or Quantity or None), optional
        Start and end of what is shown; the whole run unless given [s].
    speed : float, optional
        Time of the run over that of the animation. Unless given 1, or more if the animation would
        have more than 200 frames [1].
    frames_per_second : float, optional
        Frame rate of the animation [s^-1].
    magnify : float, optional
        Factor of displacements in the drawing of the scene [1].
    rotation : str, optional
        Unit of the history, as for :func:`rockframe.plot.response`; degrees unless given.

    Returns
    -------
    Animation
        Its frames show the nearest samples of the run. The strip at the bottom shows contact
        that changes faster than the frames.

    Raises
    ------
    SchemaError
        Not the result of a single run with histories.
    UnitsError, ComponentError
        A window, speed or factor that cannot be read or is out of range.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
    >>> moving = rf.plot.animation(run)
    >>> moving
    <animation of 21 frames, 1.1 s; save('run.gif')>
    >>> moving.save("run.gif")  # doctest: +SKIP
    """
    run = checked_run(run, "animation")
    (drawn,) = runs_of(run, "animation", window)
    rate = above_zero(frames_per_second, "animation", "frames_per_second")
    length = float(drawn.time[-1] - drawn.time[0])
    fitting = max(1.0, length * rate / _USUAL_FRAMES)
    faster = fitting if speed is None else above_zero(speed, "animation", "speed")
    count = max(2, 1 + round(length * rate / faster))
    times = np.linspace(drawn.time[0], drawn.time[-1], count)
    chosen = units_of(units, "animation")
    trace_in = chosen.rotations(rotation)
    moving = Moving(drawn.dataset, "animation", magnify, chosen)
    shown_at = drawn.nearest(times)
    width, height = figure_size(moving.drawer, wide=False)
    names = ["scene", "rotation", *strips_of([drawn])]
    heights = [height, 1.3, *[0.42] * (len(names) - 2)]
    on = sheet(
        ax, "animation", names, (max(width, 5.4), 0.6 + sum(heights)),
        lambda figure: figure.subplots(len(names), 1, height_ratios=heights),
    )  # fmt: skip
    above, trace, *strips = on.panels
    response(drawn.dataset, panels=("rotation", "contact"), rotation=trace_in, units=units,
             ax=[trace, *strips])  # fmt: skip
    trace.tick_params(labelbottom=False)
    artist = SceneArtist(above, moving.drawer, length=chosen.of(LENGTH))
    spread = shown_at[np.linspace(0, count - 1, min(count, _FRAMED)).astype(int)]
    artist.mark(moving.points)
    artist.frame([moving.upright, *(moving.at(int(place)) for place in spread)])
    artist.rest(moving.upright)
    cursors = [axes.axvline(times[0], color=GREY, linewidth=1.0) for axes in (trace, *strips)]
    line = trace.get_lines()[0]
    across, up = (np.asarray(values, np.float64) for values in line.get_data())
    (dot,) = trace.plot([], [], "o", color=BLUE, markersize=6.0, zorder=5)
    clock = above.set_title("", fontsize="medium")

    def draw(number: int) -> None:
        place = int(shown_at[number])
        artist.draw(moving.at(place))
        now = float(drawn.time[place])
        for cursor in cursors:
            cursor.set_xdata([now, now])
        dot.set_data([across[place]], [up[place]])
        touches = any(moving.at(place).bearing())
        dot.set_color(BLUE if touches else CONTACT)
        clock.set_text(moving.words(place))

    draw(0)
    on.entitle(verdict_of_case(run, chosen.reader), title)
    if ax is None:  # the layout is computed once, not for every frame
        on.panels.figure.canvas.draw()
        on.panels.figure.set_layout_engine("none")
    page = partial(
        player, run, window=window, magnify=magnify, rotation=rotation, units=units, title=title
    )  # fmt: skip
    return Animation(on.panels, draw, rate, drawn.time[shown_at], page)
