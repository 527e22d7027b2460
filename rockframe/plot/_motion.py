"""Motions over time: acceleration, velocity, displacement; the strongest pulse in the velocity."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, cast

import numpy as np
import xarray as xr

from rockframe.errors import ComponentError
from rockframe.measures import velocity_and_displacement
from rockframe.motion import GroundMotion, VelocityPulse
from rockframe.motion.display import display_name
from rockframe.plot._axes import (
    BLUE,
    GREEN,
    GREY,
    VERMILLION,
    DisplayUnit,
    add_legend,
    axis_label,
    figure_units,
    grid,
    line_colour,
    line_style,
    text_colour,
    unique_labels,
    zero_line,
)
from rockframe.plot._checks import draws, mismatch_message
from rockframe.plot._panels import Axes, AxesLike, Panels, make_sheet
from rockframe.plot._runs import Window, read_window, within_window
from rockframe.units import ACCELERATION, LENGTH, VELOCITY
from rockframe.units.display import UnitsLike

MotionsLike: TypeAlias = GroundMotion | Sequence[GroundMotion] | Mapping[Any, GroundMotion]


@dataclass(frozen=True)
class LabelledMotion:
    """A motion with its label, colour and dashes; a single motion has no label."""

    motion: GroundMotion
    label: str | None
    colour: str
    style: Any


def motions_title(values: list[LabelledMotion]) -> str:
    """Return the title of a figure: the name of a single motion, otherwise none."""
    if len(values) != 1:
        return ""
    (labelled,) = values
    return display_name(labelled.motion.name, labelled.motion.history)


def labelled_motions(value: object, function: str) -> list[LabelledMotion]:
    """Read one or several motions."""
    motions: list[Any] = [value]
    if isinstance(value, Mapping | list | tuple) and value:
        motions = [*value.values()] if isinstance(value, Mapping) else [*value]
    if not all(isinstance(ground_motion, GroundMotion) for ground_motion in motions):
        raise ComponentError(mismatch_message(function, value))
    labels: list[Any] = [None]
    if isinstance(value, Mapping):
        labels = unique_labels(map(str, value))
    elif isinstance(value, list | tuple):
        names = [display_name(motion.name, motion.history) for motion in motions]
        if len(set(names)) < len(names):
            names = [f"{name} ({number})" for number, name in enumerate(names, start=1)]
        labels = unique_labels(names)
    return [
        LabelledMotion(ground_motion, label, line_colour(number), line_style(number))
        for number, (label, ground_motion) in enumerate(zip(labels, motions, strict=True))
    ]


_QUANTITIES: Final = ("acceleration", "velocity", "displacement")


@draws("a GroundMotion", ax="three Axes", title="the motion's name")
def motion(
    motion: MotionsLike,
    *,
    window: Window = None,
    acceleration: str | None = None,
    velocity: str | None = None,
    displacement: str | None = None,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Panels:
    """Draw acceleration, velocity and displacement of the ground over time.

    Parameters
    ----------
    motion : GroundMotion, or sequence or mapping of them
        The motion, or several to compare. The vertical component of a single motion is drawn
        behind the horizontal one; for several only the horizontal components are drawn. The ground
        starts from rest, and nothing is corrected.
    window : (str or Quantity or None, str or Quantity or None), optional
        Start and end of what is drawn; the whole motion unless given [s].
    acceleration, velocity, displacement : str, optional
        Units, such as ``"g_0"``, ``"cm/s"`` and ``"cm"``.

    Returns
    -------
    Panels
        Three panels. For a single motion the peaks of the drawn histories are marked.

    Raises
    ------
    ComponentError
        Not a ground motion, or not three Axes.
    UnitsError
        A unit of another kind.

    Examples
    --------
    >>> import rockframe as rf
    >>> record = rf.GroundMotion.example("loma-prieta")
    >>> panels = rf.plot.motion(record, units={"acceleration": "g"})
    >>> panels[-1].get_xlabel()
    'time [s]'
    """
    data = labelled_motions(motion, "motion")
    limits = read_window(window, "motion")
    axis_units = figure_units(units, "motion")
    row_units = (
        axis_units.axis_unit(ACCELERATION, acceleration=acceleration),
        axis_units.axis_unit(VELOCITY, velocity=velocity),
        axis_units.axis_unit(LENGTH, displacement=displacement),
    )

    def history_of(curve: LabelledMotion, component: str = "horizontal") -> xr.Dataset:
        history = velocity_and_displacement(curve.motion, component=component)
        return within_window(history, limits, "motion", "motion")

    histories = [history_of(curve) for curve in data]
    vertical_history = None
    if len(data) == 1 and data[0].motion.si.vertical is not None:
        vertical_history = history_of(data[0], "vertical")
    sheet = make_sheet(ax, "motion", _QUANTITIES, (7.2, 5.4), nrows=3, sharex=True)
    colours = (text_colour(), BLUE, GREEN)
    for axes, name, unit, colour in zip(sheet.panels, _QUANTITIES, row_units, colours, strict=True):
        if vertical_history is not None:
            values = unit.of(vertical_history[f"vertical_ground_{name}"])
            axes.plot(vertical_history["time"], values, color=GREY, lw=0.8, label="vertical")
        for curve, history in zip(data, histories, strict=True):
            single = curve.label is None
            axes.plot(
                history["time"], unit.of(history[f"ground_{name}"]), linestyle=curve.style, lw=0.8,
                color=colour if single else curve.colour, label=curve.label or "horizontal",
            )  # fmt: skip
            if single:
                _mark_peak(axes, history, f"ground_{name}", unit, colour)
        zero_line(axes)
        axes.set_ylabel(axis_label(f"{name}\n", unit.words))
        axes.margins(y=0.15)
        axes.set_xlim(
            min(float(history["time"][0]) for history in histories),
            max(float(history["time"][-1]) for history in histories),
        )
    if vertical_history is not None:
        add_legend(sheet.axes)
    elif len(data) > 1:
        sheet.add_legend(*sheet.axes.get_legend_handles_labels(), fontsize="small")
    sheet.panels[-1].set_xlabel("time [s]")
    if sheet.own_figure is not None:
        sheet.own_figure.align_ylabels(sheet.panels)
    sheet.set_title(motions_title(data), title)
    return sheet.panels


def _mark_peak(axes: Axes, dataset: xr.Dataset, name: str, unit: DisplayUnit, colour: Any) -> None:
    values = unit.of(dataset[name])
    sample = int(np.argmax(np.abs(values)))
    time, peak = float(dataset["time"][sample]), float(values[sample])
    axes.plot([time], [peak], marker="o", markersize=4.0, color=colour)
    near_end = sample > 0.8 * values.size
    offset, alignment = (-6.0, "right") if near_end else (6.0, "left")
    axes.annotate(
        f"{abs(peak):.3g}", (time, peak), xytext=(offset, 0.0), textcoords="offset points",
        ha=alignment, va="bottom" if peak > 0.0 else "top", fontsize="small", color=colour,
    )  # fmt: skip


@draws(
    "a VelocityPulse, as motion.velocity_pulse() gives it",
    ax="two Axes",
    title="the name of the motion, period and verdict",
)
def velocity_pulse(
    pulse: VelocityPulse[GroundMotion],
    *,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Panels:
    """Draw the velocity of a motion with its pulse, and the residual velocity below.

    Parameters
    ----------
    pulse : VelocityPulse
        Result of :meth:`rockframe.GroundMotion.velocity_pulse`.

    Returns
    -------
    Panels
        The time axis is that of the motion; the ground at rest before it has negative times.

    Raises
    ------
    ComponentError
        Not a velocity pulse, or not two Axes.

    Examples
    --------
    >>> import rockframe as rf
    >>> motion = rf.GroundMotion.type_a_pulse("0.5 m/s", "2 s")
    >>> panels = rf.plot.velocity_pulse(motion.velocity_pulse())
    >>> panels[-1].get_xlabel()
    'time [s]'
    """
    if not isinstance(cast("object", pulse), VelocityPulse):
        raise ComponentError(mismatch_message("velocity_pulse", pulse))
    unit = figure_units(units, "velocity_pulse").axis_unit(VELOCITY)
    sheet = make_sheet(
        ax, "velocity_pulse", ("the motion", "the residual motion"), (8.0, 4.6),
        nrows=2, sharex=True, sharey=True,
    )  # fmt: skip
    sheet.set_title(f"{pulse.extracted.name}: {pulse}", title)
    above, below = sheet.panels
    extracted, residual = (
        velocity_and_displacement(motion) for motion in (pulse.extracted, pulse.residual)
    )
    time = extracted["time"].to_numpy() - float(pulse.lead.m_as("s"))
    pulse_velocity = unit.of(extracted["ground_velocity"])
    residual_velocity = unit.of(residual["ground_velocity"])
    above.plot(time, pulse_velocity + residual_velocity, color=GREY, linewidth=1.0, label="motion")
    words = f"pulse, $T_p$ = {pulse.period.m_as('s'):.3g} s"
    above.plot(time, pulse_velocity, color=VERMILLION, linewidth=1.8, label=words)
    below.plot(time, residual_velocity, color=BLUE, linewidth=1.0, label="residual motion")
    limit = 1.1 * max(
        float(np.abs(pulse_velocity + residual_velocity).max()),
        float(np.abs(residual_velocity).max()),
    )
    for axes in (above, below):
        axes.axhline(0.0, color="0.8", linewidth=0.5, zorder=0)
        axes.set(ylabel=axis_label("ground\nvelocity", unit.words), xlim=(time[0], time[-1]))
        axes.set_ylim(-limit, limit)
        grid(axes)
    sheet.add_common_legend()
    below.set_xlabel("time [s]")
    return sheet.panels
