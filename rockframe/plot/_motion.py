"""Motions over time: acceleration, velocity, displacement; the strongest pulse in the velocity."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, cast

import numpy as np
import xarray as xr

from rockframe.errors import ComponentError
from rockframe.measures import velocity_and_displacement
from rockframe.motion import GroundMotion, VelocityPulse
from rockframe.motion.description import display_name
from rockframe.plot._axes import (
    BLUE,
    GREEN,
    GREY,
    VERMILLION,
    DisplayUnit,
    axis_label,
    colour_of,
    grid,
    ink,
    key,
    labels_of_names,
    style_of,
    units_of,
    zero_line,
)
from rockframe.plot._checks import draws, refuse
from rockframe.plot._panels import Axes, AxesLike, Panels, sheet
from rockframe.plot._runs import Window, window_of
from rockframe.units import ACCELERATION, LENGTH, VELOCITY
from rockframe.units.display import UnitsLike

MotionsLike: TypeAlias = GroundMotion | Sequence[GroundMotion] | Mapping[Any, GroundMotion]


@dataclass(frozen=True)
class Drawn:
    """A motion with its label, colour and dashes; a single motion has no label."""

    motion: GroundMotion
    label: str | None
    colour: str
    style: Any


def motions_title(values: list[Drawn]) -> str:
    """Return the title of a figure: the name of a single motion, otherwise none."""
    if len(values) != 1:
        return ""
    (one,) = values
    return display_name(one.motion.name, one.motion.history)


def drawn_motions(value: object, function: str) -> list[Drawn]:
    """Read one or several motions."""
    labelled: dict[str, Any] = {}
    if isinstance(value, Mapping):
        labelled = {str(key): one for key, one in value.items()}
    elif isinstance(value, list | tuple):
        names = [
            display_name(str(getattr(one, "name", "")), getattr(one, "history", ()))
            for one in value
        ]
        alike = len(set(names)) < len(names)
        labelled = {
            f"{name} ({number})" if alike else name: one
            for number, (name, one) in enumerate(zip(names, value, strict=True), start=1)
        }
    if labelled and all(isinstance(one, GroundMotion) for one in labelled.values()):
        return [
            Drawn(one, label, colour_of(number), style_of(number))
            for number, (label, one) in enumerate(
                zip(labels_of_names(labelled), labelled.values(), strict=True)
            )
        ]
    if not isinstance(value, GroundMotion):
        raise ComponentError(refuse(function, value))
    return [Drawn(value, None, colour_of(0), "-")]


_ROWS: Final = ("acceleration", "velocity", "displacement")


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
    data = drawn_motions(motion, "motion")
    cut = window_of(window, "motion")
    chosen = units_of(units, "motion")
    shown_in = (
        chosen.of(ACCELERATION, acceleration=acceleration),
        chosen.of(VELOCITY, velocity=velocity),
        chosen.of(LENGTH, displacement=displacement),
    )
    found = [_part(velocity_and_displacement(one.motion), cut) for one in data]
    upwards = None
    if len(data) == 1 and data[0].motion.si.vertical is not None:
        upwards = _part(velocity_and_displacement(data[0].motion, component="vertical"), cut)
    on = sheet(ax, "motion", _ROWS, (7.2, 5.4), lambda figure: figure.subplots(3, 1, sharex=True))
    colours = (ink(), BLUE, GREEN)
    for axes, name, unit, colour in zip(on.panels, _ROWS, shown_in, colours, strict=True):
        if upwards is not None:
            values = unit.of(upwards[f"vertical_ground_{name}"])
            axes.plot(upwards["time"], values, color=GREY, lw=0.8, label="vertical")
        for one, history in zip(data, found, strict=True):
            single = one.label is None
            axes.plot(
                history["time"], unit.of(history[f"ground_{name}"]), linestyle=one.style, lw=0.8,
                color=colour if single else one.colour, label=one.label or "horizontal",
            )  # fmt: skip
            if single:
                _mark_peak(axes, history, f"ground_{name}", unit, colour)
        zero_line(axes)
        axes.set_ylabel(axis_label(f"{name}\n", unit.words))
        axes.margins(y=0.15)
        axes.set_xlim(
            min(float(history["time"][0]) for history in found),
            max(float(history["time"][-1]) for history in found),
        )
    if upwards is not None:
        key(on.axes)
    elif len(data) > 1:
        on.legend(*on.axes.get_legend_handles_labels(), fontsize="small")
    on.panels[-1].set_xlabel("time [s]")
    if on.own is not None:
        on.own.align_ylabels(on.panels)
    on.entitle(motions_title(data), title)
    return on.panels


def _part(history: xr.Dataset, cut: tuple[float, float]) -> xr.Dataset:
    return history.sel(time=slice(*cut)) if np.isfinite(cut).any() else history


def _mark_peak(axes: Axes, dataset: xr.Dataset, name: str, unit: DisplayUnit, colour: Any) -> None:
    values = unit.of(dataset[name])
    place = int(np.argmax(np.abs(values)))
    time, peak = float(dataset["time"][place]), float(values[place])
    axes.plot([time], [peak], marker="o", markersize=4.0, color=colour)
    late = place > 0.8 * values.size
    beside, side = (-6.0, "right") if late else (6.0, "left")
    axes.annotate(
        f"{abs(peak):.3g}", (time, peak), xytext=(beside, 0.0), textcoords="offset points", ha=side,
        va="bottom" if peak > 0.0 else "top", fontsize="small", color=colour,
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
        raise ComponentError(refuse("velocity_pulse", pulse))
    unit = units_of(units, "velocity_pulse").of(VELOCITY)
    on = sheet(
        ax, "velocity_pulse", ("the motion", "the residual motion"), (8.0, 4.6),
        lambda figure: figure.subplots(2, 1, sharex=True, sharey=True),
    )  # fmt: skip
    on.entitle(f"{pulse.extracted.name}: {pulse}", title)
    above, below = on.panels
    extracted, residual = (
        velocity_and_displacement(motion) for motion in (pulse.extracted, pulse.residual)
    )
    time = extracted["time"].to_numpy() - float(pulse.lead.m_as("s"))
    of_pulse = unit.of(extracted["ground_velocity"])
    left = unit.of(residual["ground_velocity"])
    above.plot(time, of_pulse + left, color=GREY, linewidth=1.0, label="motion")
    words = f"pulse, $T_p$ = {pulse.period.m_as('s'):.3g} s"
    above.plot(time, of_pulse, color=VERMILLION, linewidth=1.8, label=words)
    below.plot(time, left, color=BLUE, linewidth=1.0, label="residual motion")
    reach = 1.1 * max(float(np.abs(of_pulse + left).max()), float(np.abs(left).max()))
    for axes in (above, below):
        axes.axhline(0.0, color="0.8", linewidth=0.5, zorder=0)
        axes.set(ylabel=axis_label("ground\nvelocity", unit.words), xlim=(time[0], time[-1]))
        axes.set_ylim(-reach, reach)
        grid(axes)
    on.name_lines()
    below.set_xlabel("time [s]")
    return on.panels
