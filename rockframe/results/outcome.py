"""A finished run in plain values: what the dataset is built from."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockframe.dynamics.protocol import IMPACT_LOSS, REPINNING_LOSS, SILENT, ContactModel
from rockframe.results.schema import Direction
from rockframe.solve.layout import Status
from rockframe.solve.observe import energies_of, memory_at_outputs, observe_trajectory
from rockframe.solve.trajectory import Trajectory

Values = Mapping[str, "NDArray[np.generic] | float | int | bool"]

FORCES = ("left_reaction", "right_reaction")


@dataclass(frozen=True)
class Scales:
    """Angles and lengths by which a response is made relative, in SI units."""

    overturning_angle: float
    uplift_angle: float
    settlement: float | None


def histories(
    model: ContactModel,
    run: Trajectory,
    scales: Scales,
    ground: NDArray[np.float64],
    *,
    has_vertical_motion: bool,
) -> dict[str, NDArray[np.generic]]:
    """Give the histories of a run by their names in the schema.

    Parameters
    ----------
    model : ContactModel
        The equations.
    run : Trajectory
        The run.
    scales : Scales
        For the relative response.
    ground : ndarray, shape (samples, 2)
        Ground acceleration at the output times.
    has_vertical_motion : bool
        Whether the motion has a vertical component.

    Returns
    -------
    dict of str to ndarray
    """
    observed = observe_trajectory(model, run, ground)
    values: dict[str, NDArray[np.generic]] = {
        name: model.mass * column if name in FORCES else column for name, column in observed.items()
    }
    values["relative_rotation"] = observed["rotation"] / scales.overturning_angle
    if scales.settlement is not None:
        values["relative_vertical_displacement"] = (
            observed["vertical_displacement"] / scales.settlement
        )
    values["contact_state"] = model.contact[run.mode].astype(np.int8)
    values["ground_acceleration"] = ground[:, 0].copy()
    if has_vertical_motion:
        values["vertical_ground_acceleration"] = ground[:, 1].copy()
    return values


def energy_histories(model: ContactModel, run: Trajectory) -> dict[str, NDArray[np.generic]]:
    """Give the energies at the output times by their names in the schema [J]."""
    stored = model.mass * energies_of(model, run)
    memory, row = memory_at_outputs(run)
    lost = model.mass * memory[row]
    work = model.mass * run.work
    return {
        "kinetic_energy": stored[:, 0].copy(),
        "potential_energy": stored[:, 1].copy(),
        "elastic_energy": stored[:, 2].copy(),
        "dissipated_energy": work[:, 0].copy(),
        "impact_energy": lost[:, IMPACT_LOSS].copy(),
        "repinning_energy": lost[:, REPINNING_LOSS].copy(),
        "input_energy": work[:, 1].copy(),
    }


def event_columns(model: ContactModel, run: Trajectory) -> dict[str, NDArray[np.generic]]:
    """Give the table of events by its names in the schema."""
    events, size, weights = run.events, len(model.rotation_weights), model.rotation_weights
    shown = events.kind != SILENT
    return {
        "event_time": events.time[shown],
        "event_kind": events.kind[shown].astype(np.int8),
        "contact_state_before": model.contact[events.mode_before[shown]].astype(np.int8),
        "contact_state_after": model.contact[events.mode_after[shown]].astype(np.int8),
        "event_rotation": events.state_after[shown, :size] @ weights,
        "angular_velocity_before": events.state_before[shown, size:] @ weights,
        "angular_velocity_after": events.state_after[shown, size:] @ weights,
    }


def scalars(run: Trajectory, scales: Scales) -> dict[str, float | int | bool]:
    """Give the scalars of a run by their names in the schema."""
    return {
        "overturned": not math.isnan(run.overturning_time),
        "overturning_time": run.overturning_time,
        "overturning_direction": run.overturning_direction,
        "peak_rotation": run.peak_rotation,
        "peak_relative_rotation": run.peak_rotation / scales.overturning_angle,
        "first_uplift_time": run.first_uplift_time,
        "impact_count": run.impact_count,
        "flight_time": run.flight_time,
        "flight_count": run.flight_count,
        "energy_residual": run.energy_residual,
        "status": int(run.status),
        "overturning_angle": scales.overturning_angle,
        "uplift_angle": scales.uplift_angle,
    }


_ENDINGS = {
    Status.STEP_LIMIT: "the limit of steps was reached",
    Status.STEP_TOO_SMALL: "no step was small enough for the accuracy asked for",
    Status.CHATTER: "contact changes followed one another without end",
}


def verdict(run: Trajectory, scales: Scales) -> str:
    """Say in one sentence what became of the block."""
    impacts = f"{run.impact_count} impact{'' if run.impact_count == 1 else 's'}"
    if not math.isnan(run.overturning_time):
        side = Direction(run.overturning_direction).name.lower()
        text = f"Overturned to the {side} at {run.overturning_time:.3f} s, after {impacts}"
        if run.status is Status.TOPPLED:
            text += f"; fell flat at {run.end_time:.3f} s"
    else:
        share = 100.0 * run.peak_rotation / scales.overturning_angle
        text = (
            f"Did not overturn: peak rotation {run.peak_rotation:.4g} rad, "
            f"{share:.3g} % of the overturning angle; {impacts}"
        )
        if math.isnan(run.first_uplift_time):
            text += ", no uplift"
    if run.flight_time > 0.0:
        text += f", {run.flight_time:.3g} s in flight"
    if run.status in _ENDINGS:
        text += f". Not finished: stopped at {run.end_time:.6g} s, because {_ENDINGS[run.status]}"
    return text + "."
