"""The response over time, laid out as in Figs. 7-15 of the paper.

Events are marked on the rotation, and strips below it show the contact states.
"""

from collections.abc import Callable
from textwrap import wrap
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_bool
from rockframe.dynamics.events import ContactState
from rockframe.errors import ComponentError, did_you_mean, short_repr
from rockframe.plot._axes import (
    BLUE,
    GREEN,
    GREY,
    METRES,
    ORANGE,
    PURPLE,
    VERMILLION,
    DisplayUnit,
    add_legend,
    as_label,
    axis_label,
    figure_units,
    line_colour,
    line_style,
    text_colour,
    zero_line,
)
from rockframe.plot._checks import RUN, draws, overturning_angles
from rockframe.plot._panels import Axes, AxesLike, Panels, make_sheet
from rockframe.plot._runs import Run, RunsLike, Window, read_runs, runs_title
from rockframe.results.outcome import MIN_REPORTED_SLIP
from rockframe.results.variables.variable import flag_words
from rockframe.units import ACCELERATION, ANGLE, LENGTH
from rockframe.units.display import DisplayUnits, UnitsLike

CONTACT_COLOURS: Final = {
    "full": "#ececec",
    "left": "#2a5783",
    "right": "#cc6677",
    "flight": "#ddcc77",
}
"""Colour of each state, by its name in the schema; the colours differ as shades of grey too."""

_COLOUR_COLUMNS: Final = 1 << 14
"""More than the pixels of a figure: the colours within a pixel are then averaged well."""


_LEGEND_DISTANCE: Final = 0.5
"""Distance of the legend from the strip above it [in]."""


def draw_contact(axes: Axes, state: xr.DataArray, name: str) -> None:
    """Draw the contact state as a strip of colours.

    Where states change faster than the figure can show, their colours are averaged over time:
    bars would show only the one that was drawn last.
    """
    time = state["time"].to_numpy()
    colours, ends = mean_colours(state, _COLOUR_COLUMNS)[np.newaxis], (time[0], time[-1], 0.0, 1.0)
    axes.imshow(colours, extent=ends, aspect="auto", interpolation="antialiased")
    axes.set_ylim(0.0, 1.0)
    axes.set_yticks([])
    axes.set_ylabel("\n".join(wrap(name, 26)), rotation=0, ha="right", va="center")


def draw_contact_legend(axes: Axes, state: xr.DataArray) -> None:
    """Write the legend of the colours below the strip."""
    from matplotlib.patches import Patch

    names = flag_words(state.attrs).values()
    height = axes.get_window_extent().height / axes.figure.dpi
    axes.legend(
        handles=[Patch(facecolor=CONTACT_COLOURS[name], label=name) for name in names],
        loc="upper center", bbox_to_anchor=(0.5, -_LEGEND_DISTANCE / height), ncols=len(names),
        fontsize="small", frameon=False,
    )  # fmt: skip


def mean_colours(state: xr.DataArray, columns: int) -> Any:
    """Return the mean colour in equal intervals of time."""
    from matplotlib.colors import to_rgb

    time, values = state["time"].to_numpy(), state.to_numpy()
    edges = np.linspace(time[0], time[-1], columns + 1)
    colours = np.zeros((columns, 3))
    for value, name in flag_words(state.attrs).items():
        duration = np.concatenate([[0.0], np.cumsum(np.diff(time) * (values[:-1] == value))])
        share = np.diff(np.interp(edges, time, duration)) / np.diff(edges)
        colours += share[:, np.newaxis] * np.array(to_rgb(CONTACT_COLOURS[name]))
    return np.clip(colours, 0.0, 1.0)


EVENT_MARKERS: Final = {
    "uplift": ("^", GREEN),
    "separation": ("^", ORANGE),
    "impact": ("o", VERMILLION),
    "reengagement": ("v", BLUE),
    "rest": ("s", GREY),
    "overturning": ("X", VERMILLION),
    "toppled": ("X", GREY),
    "slip": (">", BLUE),
    "stick": ("|", GREY),
    "slip_reversal": ("d", BLUE),
    "restrainer_slack": ("3", GREY),
    "restrainer_taut": ("4", GREEN),
    "restrainer_yield": ("D", ORANGE),
    "restrainer_unloading": ("4", ORANGE),
    "restrainer_fracture": ("P", VERMILLION),
    "soil_separation": ("2", PURPLE),
    "soil_contact": ("1", PURPLE),
}
"""Marker and colour of each kind of event that is drawn, by its name in the schema. Changes of the
horizontal restraint are not drawn: they coincide with a separation or a contact."""


def draw_events(axes: Axes, runs: list[Run], unit: DisplayUnit | None) -> None:
    """Mark events on the history of the rotation, and name them in the legend."""
    labelled: set[str] = set()
    for run in runs:
        dataset = run.dataset
        if "event_kind" not in dataset:
            continue
        rotations = rotation_in(unit, dataset["event_rotation"], dataset)
        times = dataset["event_time"].to_numpy()
        kinds = dataset["event_kind"].to_numpy()
        for value, name in flag_words(dataset["event_kind"].attrs).items():
            of_kind = kinds == value
            if name not in EVENT_MARKERS or not of_kind.any():
                continue
            marker, colour = EVENT_MARKERS[name]
            label = None if name in labelled else name.replace("_", " ")
            labelled.add(name)
            face = "none" if marker in "^v" else colour
            axes.plot(
                times[of_kind], rotations[of_kind], marker, color=colour, markerfacecolor=face,
                markersize=4.5, markeredgewidth=0.9, label=label, zorder=3,
            )  # fmt: skip
    if labelled:
        several = any("event_body" in run.dataset for run in runs)
        add_legend(axes, title="events of all bodies" if several else "", title_fontsize="small")


CONTACT_NAMES: Final = {"contact_state": "pads", "soil_contact_state": "soil"}
"""Histories drawn as strips of contact states, and their names where there are two."""
BODY_CONTACT_STATE: Final = "body_contact_state"
_MAX_STRIPS: Final = 4
"""Largest number of bodies of a stack with a strip of contact states."""
_HEIGHTS: Final = {"ground": 1.0, "rotation": 2.0, "vertical": 1.6, "contact": 0.35}
_MAX_UPLIFT_RATIO: Final = 5.0
"""Uplift angle over the peak rotation above which its line is omitted, to leave room for runs."""
_ZERO_ROTATION: Final = 1e-12
"""Rotations below this are rounding [rad]."""
_MAX_NAME_LENGTH: Final = 24
"""Longest name of a point or a restrainer [characters]."""
SLIP: Final = "slip"
BODY_SLIP: Final = "body_slip"
CAP_SLIP: Final = "cap_slip"
SLIP_HISTORIES: Final = (SLIP, BODY_SLIP, CAP_SLIP)
"""Histories of slip; one panel shows those that a run has."""
_ROTATION_ON_CAP: Final = "rotation_on_cap"


@draws(RUN, ax="sequence of Axes, one for each panel", title="the verdict")
def response(
    runs: RunsLike,
    *,
    panels: str | tuple[str, ...] | None = None,
    window: Window = None,
    rotation: str | None = None,
    vertical: str | None = None,
    acceleration: str | None = None,
    events: bool = False,
    units: UnitsLike = None,
    ax: AxesLike = None,
    title: str | None = None,
) -> Panels:
    """Draw rotation, vertical displacement and contact states over time.

    Parameters
    ----------
    runs : xarray.Dataset, or sequence or mapping of them
        A result with histories; or several to compare. The keys of a mapping are the labels;
        the runs of a list are labelled by their motions, models or accuracies, or else numbered.
    panels : str or tuple of str, optional
        Panels to draw: ``"ground"``, ``"rotation"``, ``"vertical"``, ``"contact"``, and any
        history of the runs by its name, such as ``"base_shear"``; these four unless given, and
        the slip if a body slid. Contact is a strip for each run; for a single run one for each
        body of a stack, of four at most, and for each base of a block on a cap.
    rotation : str, optional
        Unit of rotations, such as ``"deg"`` or ``"rad"``; or ``"relative"``, the default: over the
        overturning angle, with degrees on the right.
    vertical : str, optional
        Unit of vertical displacements, such as ``"mm"``; or ``"relative"``, the default: on a
        deformable base over the settlement under the weight, with millimetres on the right.
    acceleration : str, optional
        Unit of the ground acceleration, such as ``"g"``.
    events : bool, optional
        Whether events are marked on the rotation.

    Returns
    -------
    Panels
        Their ``figure`` is one of :mod:`matplotlib.pyplot`. Where contact changes faster than the
        figure can show, the strip has the colours of the states averaged over time.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> run = system.simulate(pulse, free_vibration="2 s")
    >>> axes = rf.plot.response(run, panels="rotation", rotation="deg")
    >>> axes[0].get_ylabel()
    'rotation [°]'
    >>> axes.figure.savefig("rotation.png")  # doctest: +SKIP
    """
    data = read_runs(runs, "response", window)
    axis_units = figure_units(units, "response")
    shown_in = {
        "ground": axis_units.axis_unit(ACCELERATION, acceleration=acceleration),
        "rotation": axis_units.unit_or_relative(ANGLE, rotation=rotation),
        "vertical": axis_units.unit_or_relative(LENGTH, vertical=vertical),
    }
    marked = checked_bool(events, owner="rf.plot.response", name="events")
    strips = contact_strips(data)
    names = [
        name
        for panel in (default_panels(data) if panels is None else _read_panels(panels, data))
        for name in (strips if panel == "contact" else {panel: None})
    ]
    heights = [
        _HEIGHTS["contact" if name in strips else name] if name in {*strips, *_HEIGHTS} else 1.3
        for name in names
    ]

    sheet = make_sheet(
        ax, "response", names, (8.0, 1.0 + 1.15 * sum(heights)),
        choice=True, nrows=len(names), sharex=True, height_ratios=heights,
    )  # fmt: skip
    drawn = dict(zip(names, sheet.panels, strict=True))
    for name, axes in drawn.items():
        if name in strips:
            state, words = strips[name]
            draw_contact(axes, state, words)
        elif name not in _PANEL_FUNCTIONS:
            _draw_history(axes, data, name, axis_units.reader)
        else:
            _PANEL_FUNCTIONS[name](axes, data, shown_in[name])
    if marked and "rotation" in drawn:
        draw_events(drawn["rotation"], data, shown_in["rotation"])
    below = [axes for name, axes in drawn.items() if name in strips]
    if below:
        draw_contact_legend(below[-1], next(iter(strips.values()))[0])
    sheet.panels[-1].set_xlabel("time [s]")
    ends = [run.time[[0, -1]] for run in data]
    for axes in sheet.panels:
        axes.set_xlim(min(start for start, _ in ends), max(end for _, end in ends))
    sheet.set_title(runs_title(data, axis_units.reader), title)
    return sheet.panels


def rotation_in(unit: DisplayUnit | None, rotation: Any, run: xr.Dataset) -> Any:
    """Return rotations in a unit; without a unit over the overturning angle of their side."""
    if unit is not None:
        return unit.of(rotation)
    return relative_rotation(rotation, *overturning_angles(run))


def relative_rotation(rotation: Any, left: float, right: float) -> Any:
    """Return rotations over the overturning angle of their side."""
    return np.asarray(rotation) / np.where(np.asarray(rotation) < 0.0, left, right)


def has_slid(run: xr.Dataset) -> bool:
    """Whether any body of a run slid enough for a panel of its slip."""
    slips = (run[name] for name in SLIP_HISTORIES if name in run)
    return any(float(np.abs(slip).max()) >= MIN_REPORTED_SLIP for slip in slips)


def default_panels(runs: list[Run]) -> tuple[str, ...]:
    """Return the default panels of runs."""
    slid = any(has_slid(run.dataset) for run in runs)
    of_bodies = len(runs) == 1 and BODY_SLIP in runs[0].dataset
    *above, contact = _HEIGHTS
    return (*above, *([BODY_SLIP if of_bodies else SLIP] if slid else []), contact)


def _read_panels(panels: object, runs: list[Run]) -> tuple[str, ...]:
    chosen: tuple[object, ...] = tuple(panels) if isinstance(panels, tuple | list) else (panels,)
    histories = list(dict.fromkeys(name for run in runs for name in history_names(run.dataset)))
    known_names = [*_HEIGHTS, *histories]
    unknown = [panel for panel in chosen if not isinstance(panel, str) or panel not in known_names]
    if unknown or not chosen or len(set(chosen)) < len(chosen):
        choices = ", ".join(repr(name) for name in _HEIGHTS)
        wrong = unknown[0] if unknown else panels
        proposal = did_you_mean(wrong, known_names) or "."
        msg = (
            f"rf.plot.response: panels are some of {choices}, and histories of the runs, each "
            f"once, got {short_repr(wrong)}{proposal} They hold {', '.join(map(repr, histories))}"
        )
        raise ComponentError(msg)
    return tuple(map(str, chosen))


def history_names(run: xr.Dataset) -> list[str]:
    """Return the names of the histories of a run, also of those of several points or bodies."""
    return [
        str(name)
        for name, values in run.data_vars.items()
        if values.dims and values.dims[-1] == "time" and "flag_values" not in values.attrs
    ]


def contact_strips(runs: list[Run]) -> dict[str, tuple[xr.DataArray, str]]:
    """Return the strips of contact states with their labels."""
    strips: dict[str, tuple[xr.DataArray, str]] = {}
    for run in runs:
        for owner, state in _contact_states(run.dataset, single=len(runs) == 1).items():
            label = ", ".join(filter(None, (run.label, owner)))
            strips[f"contact of {label}" if label else "contact"] = state, label or "contact"
    return strips


def _contact_states(run: xr.Dataset, *, single: bool) -> dict[str, xr.DataArray]:
    """Return the contact states of a run, by the name of the body or base."""
    if "body" in run.dims:
        if not single or BODY_CONTACT_STATE not in run:
            return {"body 1": run["contact_state"]}
        states = run[BODY_CONTACT_STATE].transpose("body", "time")
        # those that are longest without full contact, of a high stack
        open_count = (states != ContactState.FULL).sum("time").to_numpy()
        bodies = np.sort(np.argsort(-open_count, kind="stable")[:_MAX_STRIPS])
        return {f"body {int(state['body'])}": state for state in states.isel(body=bodies)}
    names = [name for name in CONTACT_NAMES if name in run]
    if _ROTATION_ON_CAP not in run:  # one body: the soil's contact is the only one
        return {"": run[names[0]]}
    return {CONTACT_NAMES[name]: run[name] for name in names}


def _draw_ground(axes: Axes, runs: list[Run], unit: DisplayUnit) -> None:
    across, upwards = "ground_acceleration", "vertical_ground_acceleration"
    ground_motions = [
        run.dataset[[name for name in (across, upwards) if name in run.dataset]] for run in runs
    ]
    all_equal = all(motion.equals(ground_motions[0]) for motion in ground_motions)
    for run in runs[:1] if all_equal else runs:
        for name, style, width in ((upwards, "-" if all_equal else ":", 0.6), (across, "-", 0.8)):
            if name not in run.dataset:
                continue
            colour = run.colour if not all_equal else text_colour() if name == across else GREY
            label = "vertical" if name == upwards else None
            values = unit.of(run.dataset[name])
            axes.plot(run.time, values, style, color=colour, linewidth=width, label=label)
    add_legend(axes)
    axes.set_ylabel(axis_label("ground\n", unit.words))


def _draw_history(axes: Axes, runs: list[Run], name: str, units: DisplayUnits) -> None:
    """Draw any other history, of the runs that have it, with one line for each point."""
    runs = [run for run in runs if name in run.dataset]
    unit = units.of(str(runs[0].dataset[name].attrs.get("units", "1")))
    for run in runs:
        values = run.dataset[name]
        rows = values if values.ndim > 1 else values.expand_dims("row")
        first = str(rows.dims[0])
        for number, row in enumerate(rows):
            part = as_label(str(row[first].item()), _MAX_NAME_LENGTH) if first in row.coords else ""
            label = ", ".join(filter(None, (run.label, part))) or None
            colour = run.colour if len(rows) == 1 else line_colour(number)
            style = run.style if len(runs) > 1 else line_style(number)
            axes.plot(run.time, unit.of(row), color=colour, linestyle=style, linewidth=0.9,
                      label=label)  # fmt: skip
    if name == SLIP and len(runs) == 1 and CAP_SLIP in runs[0].dataset:
        axes.lines[-1].set_label("block")
        cap = unit.of(runs[0].dataset[CAP_SLIP])
        axes.plot(runs[0].time, cap, color=ORANGE, linewidth=0.9, label="cap")
    add_legend(axes)
    zero_line(axes)
    words = "\n".join(wrap(name.replace("_", " "), 16))
    axes.set_ylabel(axis_label(f"{words}\n", unit.words))


def _draw_rotation(axes: Axes, runs: list[Run], unit: DisplayUnit | None) -> None:
    several = len(runs) > 1
    for run in runs:
        dataset = run.dataset
        axes.plot(
            run.time, rotation_in(unit, dataset["rotation"], dataset), color=run.colour,
            linestyle=run.style, linewidth=1.1,
            label=run.label or ("body 1" if "body" in dataset.dims else "block"),
        )  # fmt: skip
        if _ROTATION_ON_CAP in dataset and not several:
            cap = rotation_in(unit, dataset["cap_rotation"], dataset)
            axes.plot(run.time, cap, color=ORANGE, linewidth=0.9, label="cap")
        elif not several and "body" not in dataset.dims:  # of a stack it is that on the base
            _draw_uplift_angles(axes, dataset, unit)
        if bool(dataset["overturned"]):
            colour = run.colour if several else VERMILLION
            axes.axvline(float(dataset["overturning_time"]), color=colour, linestyle=":")
    if axes.get_legend_handles_labels()[1] != ["block"]:
        add_legend(axes)
    zero_line(axes)
    if max(float(np.abs(run.dataset["rotation"]).max()) for run in runs) < _ZERO_ROTATION:
        axes.set_ylim(-1e-3, 1e-3)  # otherwise the axis would show rounding errors
    if unit is not None:
        axes.set_ylabel(axis_label("rotation", unit.words))
        return
    axes.set_ylabel(r"rotation $\alpha/\theta$ [-]")
    angles = {overturning_angles(run.dataset) for run in runs}
    if len(angles) == 1:
        _add_degree_axis(axes, *angles.pop())


def _draw_uplift_angles(axes: Axes, dataset: xr.Dataset, unit: DisplayUnit | None) -> None:
    """Draw the rotations at which contact is first lost, if the run comes near them."""
    uplift, peak = float(dataset["uplift_angle"]), float(np.abs(dataset["rotation"]).max())
    if not (np.isfinite(uplift) and 0.0 < uplift < _MAX_UPLIFT_RATIO * peak):
        return
    drawn = rotation_in(unit, np.array([-uplift, uplift]), dataset)
    for place, label in zip(drawn, (None, "uplift"), strict=True):
        axes.axhline(place, color=GREEN, linewidth=0.7, linestyle="--", label=label)


def _add_degree_axis(axes: Axes, left: float, right: float) -> None:
    """Add degrees on the right of an axis of rotations over the overturning angle."""

    def degrees(share: Any) -> Any:
        share = np.asarray(share, np.float64)
        return np.degrees(share * np.where(share < 0.0, left, right))

    def share(angle: Any) -> Any:
        return relative_rotation(np.radians(np.asarray(angle, np.float64)), left, right)

    axes.secondary_yaxis("right", functions=(degrees, share)).set_ylabel("[°]")


def _draw_vertical(axes: Axes, runs: list[Run], unit: DisplayUnit | None) -> None:
    name = "relative_vertical_displacement"
    over_settlement = unit is None and all(name in run.dataset for run in runs)
    metres = unit or METRES
    for run in runs:
        displacement = run.dataset[name if over_settlement else "vertical_displacement"]
        values = displacement if over_settlement else metres.of(displacement)
        axes.plot(run.time, values, color=run.colour, linestyle=run.style, linewidth=1.1)
    zero_line(axes)
    if not over_settlement:
        of_stack = "\nof body 1" if any("body" in run.dataset.dims for run in runs) else ""
        axes.set_ylabel(axis_label(f"vertical $y${of_stack}", metres.words))
        return
    stacked = any(_ROTATION_ON_CAP in run.dataset for run in runs)  # pads and soil: two settlements
    of_pads = "\n($\\delta$ of the pads)" if stacked else ""
    axes.set_ylabel(rf"vertical $y/\delta$ [-]{of_pads}")
    settlements = {settlement_of_run(run.dataset) for run in runs}
    settlement = settlements.pop()
    if not settlements and settlement > 0.0:
        conversions = (
            lambda y: 1e3 * settlement * np.asarray(y),
            lambda y: np.asarray(y) / (1e3 * settlement),
        )
        axes.secondary_yaxis("right", functions=conversions).set_ylabel("[mm]")


def settlement_of_run(run: xr.Dataset) -> float:
    """Find the settlement by which vertical displacements were divided [m]."""
    relative = run["relative_vertical_displacement"].to_numpy()
    largest = int(np.argmax(np.abs(relative)))
    if relative[largest] == 0.0:
        return 0.0
    return float(f"{float(run['vertical_displacement'][largest]) / float(relative[largest]):.12g}")


_PANEL_FUNCTIONS: Final[dict[str, Callable[..., None]]] = {
    "ground": _draw_ground,
    "rotation": _draw_rotation,
    "vertical": _draw_vertical,
}
