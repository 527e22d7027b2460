"""A cascade in plain values: both stages, and their sum."""

import numpy as np

from rockframe.dynamics.protocol import EventKind
from rockframe.results.outcome import (
    Array,
    Generic,
    Scales,
    cap_histories,
    energy_histories,
    event_columns,
    histories,
)
from rockframe.solve.cascade import Cascade, CascadeRun
from rockframe.solve.ground_table import ground_at
from rockframe.solve.total import Reach
from rockframe.solve.trajectory import Trajectory

SUMMED = (
    "rotation",
    "angular_velocity",
    "vertical_displacement",
    "vertical_velocity",
    "horizontal_displacement",
)
ON_THE_SOIL = {
    EventKind.SEPARATION: EventKind.SOIL_SEPARATION,
    EventKind.REENGAGEMENT: EventKind.SOIL_CONTACT,
    EventKind.PIVOT_CHANGE: EventKind.SOIL_PIVOT_CHANGE,
}
"""What an event of the first stage is called in the cascade."""


def cascade_histories(
    cascade: Cascade, run: CascadeRun, scales: Scales, ground: Array
) -> dict[str, Generic]:
    """Give the histories of both stages and of their sum, Eq. (20), by their names."""
    first = histories(cascade.first, run.first, ground)
    carried = ground_at(run.carried, run.second.time)
    second = histories(cascade.second, run.second, carried)
    total = {name: first[name] + second[name] for name in SUMMED}
    return {
        **second,
        **total,
        **cap_histories(first, scales),
        "soil_reaction": first["soil_reaction"],
        "contact_length": first["contact_length"],
        "rotation_on_cap": second["rotation"],
        "vertical_displacement_on_cap": second["vertical_displacement"],
        "cap_acceleration": carried[:, 0].copy(),
        "cap_vertical_acceleration": carried[:, 1].copy(),
    }


def cascade_energies(cascade: Cascade, run: CascadeRun) -> dict[str, Generic]:
    """Give the sums of the energies of both stages, each relative to its own ground [J]."""
    first = energy_histories(cascade.first, run.first)
    second = energy_histories(cascade.second, run.second)
    return {name: first[name] + second[name] for name in first}


def cascade_events(cascade: Cascade, run: CascadeRun) -> dict[str, Generic]:
    """Give the events of both stages in the order of time, with the total overturning."""
    end = run.summary.end_time
    first, second = (
        _until(event_columns(model, stage), end)
        for model, stage in ((cascade.first, run.first), (cascade.second, run.second))
    )
    kinds = {int(own): int(soil) for own, soil in ON_THE_SOIL.items()}
    first["event_kind"] = np.array([kinds[int(kind)] for kind in first["event_kind"]], np.int8)
    for side in ("before", "after"):
        name = f"contact_state_{side}"
        first[f"soil_{name}"], second[name] = first[name], second[name]
        first[name] = _state_at(cascade.second.contact, run.second, first["event_time"])
        second[f"soil_{name}"] = _state_at(cascade.first.contact, run.first, second["event_time"])
    merged = {name: np.concatenate([first[name], second[name]]) for name in second}
    for reach in run.reaches:
        _add_reach(merged, reach, cascade, run)
    order = np.argsort(merged["event_time"], kind="stable")
    return {name: column[order] for name, column in merged.items()}


def _until(events: dict[str, Generic], end: float) -> dict[str, Generic]:
    """Leave out what one stage alone would call overturning, and what came later."""
    own_end = (int(EventKind.OVERTURNING), int(EventKind.TOPPLED))
    kept = (events["event_time"] <= end) & ~np.isin(events["event_kind"], own_end)
    return {name: column[kept] for name, column in events.items()}


def _state_at(contact: Generic, run: Trajectory, time: Generic) -> Generic:
    """Give the contact state of a stage at events of the other one."""
    modes = np.concatenate([[run.start_mode], run.events.mode_after])
    return contact[modes[np.searchsorted(run.events.time, time, side="right")]].astype(np.int8)


def _add_reach(events: dict[str, Generic], reach: Reach, cascade: Cascade, run: CascadeRun) -> None:
    time = np.array([reach.time])
    block = _state_at(cascade.second.contact, run.second, time)
    soil = _state_at(cascade.first.contact, run.first, time)
    row = {
        "event_time": time,
        "event_kind": np.array([int(reach.kind)], np.int8),
        "contact_state_before": block,
        "contact_state_after": block,
        "soil_contact_state_before": soil,
        "soil_contact_state_after": soil,
        "event_rotation": np.array([reach.rotation]),
        "angular_velocity_before": np.array([reach.rate]),
        "angular_velocity_after": np.array([reach.rate]),
    }
    for name in events:
        events[name] = np.concatenate([events[name], row[name]])
