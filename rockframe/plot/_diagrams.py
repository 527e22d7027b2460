"""Phase diagrams, moment-rotation diagrams and the energy balance of runs."""

from typing import Final

import numpy as np
import xarray as xr

from rockframe.errors import SchemaError
from rockframe.plot._axes import (
    COLOURS,
    GREY,
    DisplayUnit,
    add_legend,
    axis_label,
    figure_units,
    grid,
    line_colour,
    text_colour,
    zero_line,
)
from rockframe.plot._checks import (
    RUN,
    SWEEP_ATTRIBUTE,
    draws,
    mismatch_message,
    overturning_angles,
    read_positive,
    system_of_run,
)
from rockframe.plot._panels import Axes, AxesLike, make_single_panel
from rockframe.plot._response import rotation_in
from rockframe.plot._runs import Run, RunsLike, Window, read_runs, runs_title
from rockframe.results.schema import ENERGIES, SCHEMA
from rockframe.simulation.system import System
from rockframe.units import ANGLE
from rockframe.units.display import UnitsLike
from rockframe.units.kinds import ENERGY, MOMENT

_STATE_ENERGIES: Final = ("kinetic_energy", "potential_energy", "elastic_energy")
_ZOOM_RATIO: Final = 0.2
"""Peak over the rotation of unstable equilibrium below which a phase diagram omits the latter."""
_ANGLE_COUNT: Final = 401
"""Number of rotations at which a body is held for a curve of moments."""


@draws(RUN, title="the verdict")
def phase(
    runs: RunsLike,
    *,
    window: Window = None,
    rotation: str | None = None,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Axes:
    """Draw the angular velocity over the rotation.

    Parameters
    ----------
    runs : xarray.Dataset, or sequence or mapping of them
        A result with histories; or several to compare, as for :func:`rockframe.plot.response`.
    rotation : str, optional
        Unit of rotations, such as ``"deg"``, and of angular velocities per second; or
        ``"relative"``, the default: over the overturning angle.

    Returns
    -------
    matplotlib.axes.Axes
        A dot marks the start of each run; crosses mark the rotations of unstable equilibrium if
        the runs come near them.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> run = system.simulate(pulse, free_vibration="2 s")
    >>> axes = rf.plot.phase(run, rotation="deg")
    >>> axes.get_xlabel()
    'rotation [°]'
    >>> axes.figure.savefig("phase.png")  # doctest: +SKIP
    """
    data = read_runs(runs, "phase", window)
    axis_units = figure_units(units, "phase")
    unit = axis_units.unit_or_relative(ANGLE, rotation=rotation)
    sheet = make_single_panel(ax, "phase", (5.6, 4.4))
    reach, end = 0.0, np.inf
    for run in data:
        across = rotation_in(unit, run.dataset["rotation"], run.dataset)
        left, right = overturning_angles(run.dataset)
        up = run.dataset["angular_velocity"].to_numpy()
        up = up / np.where(across < 0.0, left, right) if unit is None else unit.of(up)
        sheet.axes.plot(across, up, color=run.colour, ls=run.style, lw=0.9, label=run.label)
        sheet.axes.plot(across[:1], up[:1], "o", color=run.colour, markersize=5.0)
        ends = rotation_in(unit, np.array([-left, right]), run.dataset)
        sheet.axes.plot(ends, [0.0, 0.0], "x", color=text_colour(), markersize=6.0)
        reach, end = max(reach, float(np.abs(across).max())), min(end, float(np.abs(ends).min()))
    if 0.0 < reach < _ZOOM_RATIO * end:  # otherwise the data would be almost a vertical line
        sheet.axes.set_xlim(-1.1 * reach, 1.1 * reach)
    _draw_zero_lines(sheet.axes)
    words = r"rotation $\alpha/\theta$ [-]", axis_label(r"rate $\dot\alpha/\theta$", "s^-1")
    if unit is not None:
        rate = axis_label("rate of the rotation", f"{unit.words} s^-1")
        words = axis_label("rotation", unit.words), rate
    sheet.axes.set(xlabel=words[0], ylabel=words[1])
    if len(data) > 1:
        add_legend(sheet.axes)
    sheet.set_title(runs_title(data, axis_units.reader), title)
    return sheet.axes


@draws(RUN, title="the verdict of a run")
def moment_rotation(
    given: System | RunsLike,
    *,
    largest: float = 1.2,
    window: Window = None,
    rotation: str | None = None,
    moment: str | None = None,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Axes:
    """Draw the moment of the base over the rotation, in static equilibrium or in runs.

    Parameters
    ----------
    given : System, or xarray.Dataset, or sequence or mapping of them
        A system, whose base moment is drawn in vertical equilibrium by
        :meth:`rockframe.System.moment_rotation`; or a result of that method; or runs with
        ``outputs=("base_overturning_moment",)``. For a single run of one body the moment in
        equilibrium is dashed.
    largest : float, optional
        Largest rotation of a system, over the overturning angle of the side [1].
    window : (str or Quantity or None, str or Quantity or None), optional
        Start and end of runs in the figure; the whole runs unless given [s].
    rotation, moment : str, optional
        Units; degrees and kN m unless given.

    Returns
    -------
    matplotlib.axes.Axes
        The rotations of a run of a block on a cap are those relative to the cap; of a stack those
        of the uppermost body relative to the body below.

    Raises
    ------
    SchemaError
        Neither a system nor runs with histories of the moment.
    UnitsError, ComponentError
        A unit of another kind, or a window without samples.

    Examples
    --------
    >>> import rockframe as rf
    >>> pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"), pads)
    >>> axes = rf.plot.moment_rotation(system)
    >>> axes.get_xlabel()
    'rotation [°]'
    """
    axis_units = figure_units(units, "moment_rotation")
    angle_unit = axis_units.axis_unit(ANGLE, "deg", rotation=rotation)
    moment_unit = axis_units.axis_unit(MOMENT, "kN*m", moment=moment)
    if isinstance(given, System):
        given = _static_moments(given, largest)
    if isinstance(given, xr.Dataset) and "base_moment" in given and "angle" in given.dims:
        sheet = make_single_panel(ax, "moment_rotation", (5.6, 4.2))
        for name, words, colour, style in (
            ("base_moment", "of the base", COLOURS[0], "-"),
            ("restoring_moment", "that holds the body", COLOURS[1], "--"),
        ):
            angles, moments = angle_unit.of(given["angle"]), moment_unit.of(given[name])
            sheet.axes.plot(angles, moments, style, color=colour, label=words)
        add_legend(sheet.axes, title="moment", title_fontsize="small")
        sheet.set_title("", title)
    else:
        runs = read_runs(given, "moment_rotation", window)
        _require_variables(runs, ("base_overturning_moment",), "moment_rotation")
        sheet = make_single_panel(ax, "moment_rotation", (5.6, 4.2))
        if len(runs) == 1 and _rotation_on_support(runs[0].dataset).name == "rotation":
            _draw_equilibrium_moment(sheet.axes, runs[0], angle_unit, moment_unit)
        for run in runs:
            sheet.axes.plot(
                angle_unit.of(_rotation_on_support(run.dataset)),
                moment_unit.of(run.dataset["base_overturning_moment"]),
                color=run.colour, linestyle=run.style, linewidth=0.9, label=run.label,
            )  # fmt: skip
        add_legend(sheet.axes)
        sheet.set_title(runs_title(runs, axis_units.reader), title)
    _draw_zero_lines(sheet.axes)
    sheet.axes.set_xlabel(axis_label("rotation", angle_unit.words))
    sheet.axes.set_ylabel(axis_label("moment of the base", moment_unit.words))
    return sheet.axes


@draws(RUN, title="the verdict")
def energies(
    run: xr.Dataset,
    *,
    window: Window = None,
    energy: str | None = None,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Axes:
    """Draw the energy balance of a run.

    Parameters
    ----------
    run : xarray.Dataset
        A result with ``outputs=("energy",)``.
    energy : str, optional
        Unit; kJ unless given.

    Returns
    -------
    matplotlib.axes.Axes
        Stacked areas are the changes of energies since the start, and the losses; a line is the
        input. The balance holds if the areas above zero minus those below it reach the line.

    Raises
    ------
    SchemaError
        Not the result of a single run with energies.
    UnitsError, ComponentError
        A unit of another kind, or a window without samples.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> run = system.simulate(pulse, free_vibration="2 s", outputs=("energy",))
    >>> axes = rf.plot.energies(run, energy="kJ")
    >>> axes.get_ylabel()
    'energy [kJ]'
    >>> axes.figure.savefig("energies.png")  # doctest: +SKIP
    """
    data = read_runs(run, "energies", None)
    if len(data) > 1:
        raise SchemaError(mismatch_message("energies", run))
    _require_variables(data, ENERGIES, "energies")
    axis_units = figure_units(units, "energies")
    unit = axis_units.axis_unit(ENERGY, "kJ", energy=energy)
    whole_run = data[0].dataset
    changes = {
        name: unit.of(whole_run[name] - (whole_run[name][0] if name in _STATE_ENERGIES else 0.0))
        for name in ENERGIES
    }
    (part,) = read_runs(run, "energies", window)
    first = int(np.searchsorted(whole_run["time"], part.time[0]))
    window_slice = slice(first, first + part.time.size)
    sheet = make_single_panel(ax, "energies", (7.2, 3.9))
    order = [name for name in ENERGIES if name != "input_energy"]
    areas = [name for name in reversed(order) if np.any(changes[name] != 0.0)]
    names = {name: name.removesuffix("_energy").replace("_", " ") for name in ENERGIES}
    colours = {name: line_colour(number) for number, name in enumerate(order)}
    # energies below zero, such as that of gravity of a leaning body, are stacked below zero
    for sign in (1.0, -1.0):
        below = np.zeros(part.time.size)
        for name in areas:
            values = sign * np.maximum(sign * changes[name][window_slice], 0.0)
            if sign < 0.0 and not values.any():
                continue
            sheet.axes.fill_between(
                part.time, below, below + values, color=colours[name], alpha=0.6, linewidth=0.0,
                label=names[name] if sign > 0.0 else None,
            )  # fmt: skip
            below = below + values
    energy_input = changes["input_energy"][window_slice]
    sheet.axes.plot(part.time, energy_input, color=text_colour(), linewidth=1.1, label="input")
    zero_line(sheet.axes)
    sheet.axes.set(xlabel="time [s]", ylabel=axis_label("energy", unit.words))
    sheet.axes.set_xlim(part.time[0], part.time[-1])
    sheet.add_legend(*sheet.axes.get_legend_handles_labels(), columns=4)
    sheet.set_title(runs_title(data, axis_units.reader), title)
    return sheet.axes


def _static_moments(system: System, largest: float) -> xr.Dataset:
    left, right = system.setting.overturning_angles
    largest = read_positive(largest, "moment_rotation", "largest")
    wall = system.parts.rigid_wall
    if wall is not None:  # the body is held to the other side only
        left, right = (left, 0.0) if wall.direction > 0.0 else (0.0, right)
    angles = np.linspace(-largest * left, largest * right, _ANGLE_COUNT)
    return system.moment_rotation((angles, str(ANGLE.unit)))


def _rotation_on_support(run: xr.Dataset) -> xr.DataArray:
    """Return the rotation of the body relative to its support."""
    if "body" in run.dims:
        return run["body_rotation_on_base"].isel(body=0)
    return run["rotation_on_cap" if "rotation_on_cap" in run else "rotation"]


def _draw_equilibrium_moment(
    axes: Axes, run: Run, angle_unit: DisplayUnit, moment_unit: DisplayUnit
) -> None:
    """Draw the moment in equilibrium over the range of rotations of a run."""
    system = system_of_run(run.dataset, "moment_rotation")
    rotation = run.dataset["rotation"].to_numpy()
    angles = np.linspace(rotation.min(), rotation.max(), _ANGLE_COUNT)
    equilibrium = system.moment_rotation((angles, str(ANGLE.unit)))
    rotations = angle_unit.of(equilibrium["angle"])
    moments = moment_unit.of(equilibrium["base_moment"])
    axes.plot(rotations, moments, "--", color=GREY, linewidth=1.2, label="in equilibrium")


def _require_variables(runs: list[Run], names: tuple[str, ...], function: str) -> None:
    for run in runs:
        missing = [name for name in names if name not in run.dataset]
        if missing:
            requested = "energy" if missing[0] in ENERGIES else missing[0]
            text = SCHEMA[missing[0]].long_name
            call = f"system.simulate(motion, outputs=({requested!r},))"
            if SWEEP_ATTRIBUTE in run.dataset.attrs:
                call = f"rf.case(dataset).simulate(outputs=({requested!r},))"
            msg = (
                f"rf.plot.{function} needs {missing[0]!r}, the {text}, which runs have on request: "
                f"{call}"
            )
            raise SchemaError(msg)


def _draw_zero_lines(axes: Axes) -> None:
    grid(axes)
    zero_line(axes)
    axes.axvline(0.0, color=GREY, alpha=0.6, linewidth=0.5, zorder=0)
