"""Scenes to scale: at rest, and at an instant of a run."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_bool
from rockframe.dynamics.events import LinkState
from rockframe.errors import ComponentError, SchemaError, short_repr
from rockframe.plot._artists import SceneArtist, part_labels
from rockframe.plot._axes import FigureUnits, figure_units
from rockframe.plot._checks import (
    RUN,
    checked_run,
    draws,
    mismatch_message,
    read_positive,
    system_of_run,
)
from rockframe.plot._layout import LayoutBuilder
from rockframe.plot._panels import Axes, AxesLike, make_single_panel
from rockframe.plot._response import BODY_CONTACT_STATE
from rockframe.results.points import UPRIGHT, Placement
from rockframe.simulation.plan import read_body_points
from rockframe.simulation.system import System
from rockframe.system.geometry import Geometry, geometry_of
from rockframe.units import ANGLE, LENGTH, TIME, QuantityLike, to_si
from rockframe.units.display import UnitsLike, unit_suffix

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PLACEMENT_HISTORIES: Final = (
    "rotation",
    "horizontal_displacement",
    "vertical_displacement",
    "contact_state",
    "cap_rotation",
    "cap_angular_velocity",
    "cap_vertical_displacement",
    "cap_slip",
    "soil_contact_state",
)
"""Histories that give the places of a scene's parts; those of the cap only where there is one."""
_BODY_HISTORIES: Final = (
    "body_rotation", "body_horizontal_displacement", "body_vertical_displacement",
)  # fmt: skip
"""The same for all bodies of a stack."""
_LEGEND_MARGIN: Final = 0.2  # [in]
_RESTRAINER_STATE: Final = "restrainer_state"
_BROKEN_COUNT: Final = "broken_restrainer_count"


@draws("a System")
def scene(
    system: System,
    *,
    points: Mapping[str, tuple[QuantityLike, QuantityLike]] | None = None,
    legend: bool = True,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Axes:
    """Draw a scene to scale, upright and at rest.

    Parameters
    ----------
    system : System
        The scene.
    points : mapping of str to (str or Quantity, str or Quantity), optional
        Points to mark, as for :meth:`rockframe.System.simulate` [m].
    legend : bool, optional
        Whether the parts and their parameters are listed next to the drawing.

    Returns
    -------
    matplotlib.axes.Axes
        To scale, in metres or in the unit of lengths in `units`, with the middle of the lowest
        base at the origin. A block is always drawn as the rectangle of its width and height, and a
        frame with its members. Pads, and beds between bodies, which
        have no thickness in the equations, are drawn with one.

    Raises
    ------
    ComponentError
        Not a system.
    UnitsError
        A point has no unit.

    Examples
    --------
    >>> import rockframe as rf
    >>> block = rf.Block(width="0.8 m", height="4 m", mass="2 t")
    >>> axes = rf.plot.scene(rf.System(block), points={"top": ("0 m", "4 m")})
    >>> axes.get_xlabel()
    '[m]'
    """
    if not isinstance(cast("object", system), System):
        raise ComponentError(mismatch_message("scene", system))
    builder = LayoutBuilder(geometry_of(system.assembly))
    placement = Placement(builder.geometry, UPRIGHT, system.restraint)
    with_legend = checked_bool(legend, owner="rf.plot.scene", name="legend")
    faults: list[str] = []
    marked = read_body_points(points, faults, owner="rf.plot.scene")
    if faults:
        msg = f"rf.plot.scene: {'; '.join(faults)}"
        raise ComponentError(msg)
    sheet = make_single_panel(ax, "scene", figure_size(builder, wide=with_legend))
    axis_units = figure_units(units, "scene")
    names = part_labels(system.parts, builder.geometry, axis_units.reader)
    artist = SceneArtist(sheet.axes, builder, names, axis_units.axis_unit(LENGTH))
    artist.set_points({point.name: (point.x, point.y) for point in marked})
    artist.set_limits([placement])
    artist.draw(placement)
    if with_legend:
        artist.draw_legend()
    sheet.set_title("", title)
    if with_legend and sheet.own_figure is not None:
        for _ in range(2):  # the layout makes room for the legend iteratively
            sheet.panels.figure.draw_without_rendering()
            if ax is None:
                _fit_height_to_legend(sheet.axes)
    return sheet.axes


@draws(RUN, title="time and rotation")
def state(
    run: xr.Dataset,
    time: QuantityLike | None = None,
    *,
    magnify: float = 1.0,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Axes:
    """Draw a scene to scale at an instant of a run, with its contacts.

    Parameters
    ----------
    time : str or Quantity, optional
        The instant; the nearest sample is drawn. By default the instant of the largest rotation
        over the overturning angle [s].

    Returns
    -------
    matplotlib.axes.Axes
        As for :func:`scene`, relative to the ground, :eq:`eq-scene-places`; the bodies at rest are
        dashed. Contact has its own colour: points and lines of bases in contact, and compressed
        pads. A broken restrainer is not drawn.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
    >>> axes = rf.plot.state(run, "0.8 s")
    >>> axes.get_title()
    ''
    """
    run = checked_run(run, "state")
    axis_units = figure_units(units, "state")
    history = SceneHistory(run, "state", magnify, axis_units)
    sample = history.nearest_sample(time)
    placement = history.placement_at(sample)
    sheet = make_single_panel(ax, "state", figure_size(history.builder, wide=False))
    artist = SceneArtist(sheet.axes, history.builder, length=axis_units.axis_unit(LENGTH))
    artist.set_points(history.points)
    artist.set_limits([placement, history.upright])
    artist.draw_at_rest(history.upright)
    artist.draw(placement)
    sheet.set_title(history.caption(sample), title)
    return sheet.axes


class SceneHistory:
    """A run as a scene that moves."""

    def __init__(
        self, run: xr.Dataset, function: str, magnify: object, units: FigureUnits | None = None
    ) -> None:
        self.function = function
        self.angle = (units or figure_units(None, function)).axis_unit(ANGLE, "deg")
        number = read_positive(magnify, function, "magnify")
        self.system = system_of_run(run, function)
        self.builder = LayoutBuilder(geometry_of(self.system.assembly), number)
        self.run = run
        self.time = run["time"].to_numpy()
        needed = (
            *_PLACEMENT_HISTORIES[:4],
            *((*_BODY_HISTORIES, BODY_CONTACT_STATE) if self.geometry.lower else ()),
        )
        if self.geometry.links and run.get(_BROKEN_COUNT, 0) > 0:
            needed += (_RESTRAINER_STATE,)
        missing = [name for name in needed if name not in run]
        if missing:
            msg = (
                f"rf.plot.{function}: the run lacks {', '.join(map(repr, missing))}; a case of a "
                "sweep has all histories if it is run alone, rf.case(runs, ...).simulate()"
            )
            raise SchemaError(msg)
        self._broken = None
        if _RESTRAINER_STATE in run:
            states = run[_RESTRAINER_STATE].transpose("time", "restrainer").to_numpy()
            self._broken = states == LinkState.BROKEN
        self._columns = {name: run[name].to_numpy() for name in _PLACEMENT_HISTORIES if name in run}

    @property
    def geometry(self) -> Geometry:
        """Geometry of the scene."""
        return self.builder.geometry

    @property
    def upright(self) -> Placement:
        """The scene at rest."""
        return Placement(self.geometry, UPRIGHT, self.system.restraint)

    @property
    def points(self) -> dict[str, tuple[float, ...]]:
        """Points of the run's histories, by their names [m]."""
        if "point" not in self.run.dims:
            return {}
        names = self.run["point"].to_numpy()
        places = zip(self.run["point_x"].to_numpy(), self.run["point_y"].to_numpy(), strict=True)
        return {str(name): (float(x), float(y)) for name, (x, y) in zip(names, places, strict=True)}

    def placement_at(self, sample: int) -> Placement:
        """Return the scene at a sample."""
        values = {name: float(column[sample]) for name, column in self._columns.items()}
        bodies = contacts = None
        if self.geometry.lower:
            bodies = np.column_stack(
                [self.run[name].to_numpy()[:, sample] for name in _BODY_HISTORIES]
            )
            contacts = self.run[BODY_CONTACT_STATE].to_numpy()[:, sample]
        broken = frozenset[int]()
        if self._broken is not None:
            broken = frozenset(np.flatnonzero(self._broken[sample]).tolist())
            if self.geometry.columns:  # in each column there are all tendons
                all_broke = 0 < self.run.sizes["restrainer"] == len(broken)
                broken = frozenset(range(len(self.geometry.links)) if all_broke else ())
        return Placement(self.geometry, values, self.system.restraint, bodies, broken, contacts)

    def nearest_sample(self, time: object) -> int:
        """Find the sample nearest to a time, or that of the largest rotation."""
        if time is None:
            return int(np.argmax(np.abs(self.run["relative_rotation"].to_numpy())))
        owner = f"rf.plot.{self.function}"
        when = to_si(time, TIME, owner=owner, name="time")
        slack = 1e-9 * (self.time[-1] - self.time[0])
        if not self.time[0] - slack <= when <= self.time[-1] + slack:
            msg = (
                f"{owner}: the run goes from {self.time[0]:.6g} s to {self.time[-1]:.6g} s, got "
                f"time={short_repr(time)}"
            )
            raise ComponentError(msg)
        return int(np.argmin(np.abs(self.time - when)))

    def caption(self, sample: int) -> str:
        """Write the time and rotation of a sample."""
        angle = float(self.angle.of(self._columns["rotation"][sample])) + 0.0  # no negative zero
        share = abs(float(self.run["relative_rotation"][sample]))
        rotation = f"{angle:.3g}{unit_suffix(self.angle.words)}"
        of_body = " of body 1" if "body" in self.run.dims else ""
        text = (
            f"{self.time[sample]:.3f} s: {rotation}, {100.0 * share:.3g} % of overturning{of_body}"
        )
        factor = self.builder.magnify
        return text if factor == 1.0 else f"{text}; displacements times {factor:g}"


def _fit_height_to_legend(axes: Axes) -> None:
    """Make a figure higher if the names of many parts do not fit."""
    legend, figure = axes.get_legend(), cast("Figure", axes.figure)
    if legend is not None:
        needed = legend.get_window_extent().height / figure.dpi + _LEGEND_MARGIN
        figure.set_figheight(max(figure.get_figheight(), needed))


def figure_size(builder: LayoutBuilder, *, wide: bool) -> tuple[float, float]:
    """Return the size of a figure for a scene [in]."""
    geometry = builder.geometry
    tall = (geometry.base_level + geometry.height) / (2.0 * builder.reach)
    return (5.6 if wide else 4.2), float(np.clip(3.6 * tall, 3.2, 5.6))
