"""A finished run in plain values by their names in the schema, from which datasets are built.

Histories, events and scalars, the verdict in words, and the components of gravity on a slope.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.case_arrays import maximum
from rockframe.dynamics.events import OVERTURNING, SILENT, TOPPLED, LinkState
from rockframe.dynamics.protocol import (
    IMPACT_LOSS,
    IMPULSIVE_INPUT,
    LINK_LOSS,
    REPINNING_LOSS,
    ContactModel,
    Ending,
    column_of,
)
from rockframe.errors import SchemaError
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.bodies import OF_EACH_BODY, OF_EACH_LINK
from rockframe.results.variables.runs import Direction
from rockframe.signals.arrays import AnyArray, Array
from rockframe.signals.motion import Incline
from rockframe.solve.observe import energies_of, memory_at_outputs
from rockframe.solve.trajectory import Summary, Trajectory
from rockframe.solve.workspace import Status
from rockframe.system.bodies import OverturningAngles
from rockframe.system.setting import Setting, SlipRange
from rockframe.units import ANGLE, angle_words

LARGE_RESIDUAL_SHARE: Final = 0.95
"""Share of the peak slip below which a residual slip is reported together with the peak."""
ZERO_RESIDUAL_SHARE: Final = 1e-9
"""Share of the peak slip below which a residual slip is rounding."""
EQUAL_SHARES: Final = 1e-6
"""Relative difference up to which two bodies count as equally close to overturning."""
MIN_REPORTED_SLIP: Final = 1e-6
"""Least slip that is reported; changes of the held point leave less [m]."""
PEAK_SLIPS: Final = ("peak_slip", "peak_body_slip", "peak_cap_slip")
"""Peak slips of the block, of all bodies of a stack, and of a cap, where a scene has them."""


def peak_share(run: Summary, angles: OverturningAngles) -> float:
    """Return the largest ratio of a peak rotation to the overturning angle of its side and body."""
    share = maximum(run.peak_right / angles.right, run.peak_left / angles.left)
    return maximum(share, run.other_rotation_ratio)


def numbered_columns(name: str, count: int) -> tuple[str, ...]:
    """Name the columns of a quantity of all bodies, or of all restrainers."""
    return tuple(column_of(name, k) for k in range(count))


def body_histories(
    model: ContactModel, run: Trajectory, values: Mapping[str, AnyArray]
) -> dict[str, AnyArray]:
    """Return histories, those of all bodies and of all restrainers stacked in one array each."""
    histories = {name: value for name, value in values.items() if name in SCHEMA}

    def of_each(name: str, count: int) -> AnyArray:
        return np.array([values[column] for column in numbered_columns(name, count)])

    if model.links:
        histories |= {name: of_each(name, model.links) for name in OF_EACH_LINK}
    if not model.shows_bodies:
        return histories
    count = model.system.bodies()
    histories |= {name: of_each(column, count) for name, column in OF_EACH_BODY.items()}
    if "slip" in values:
        histories["body_slip"] = of_each("slip", count)
    histories["body_contact_state"] = np.array(
        [model.contact_states(run.mode, k) for k in range(count)], dtype=np.int8
    )
    histories["body"] = np.arange(count) + 1
    return histories


def broken_links(model: ContactModel, ending: Ending) -> list[int]:
    """Return the numbers of the restrainers that are broken at the end of a run, from 0."""
    system = cast("Any", model.system)
    rows = [system.row_of_link(i) for i in range(model.links)]
    return [
        i for i, row in enumerate(rows) if system.link_state(ending.mode, row) == LinkState.BROKEN
    ]


def relative_histories(values: Mapping[str, AnyArray], setting: Setting) -> dict[str, AnyArray]:
    """Return the rotation over the overturning angle, and vertical displacement over settlement."""
    left, right = setting.overturning_angles
    rotation = values["rotation"]
    limit = np.where(rotation < 0.0, left, right) if left != right else left
    relative: dict[str, AnyArray] = {"relative_rotation": rotation / limit}
    if setting.settlement is not None:
        relative["relative_vertical_displacement"] = (
            values["vertical_displacement"] / setting.settlement
        )
    return relative


def ground_histories(ground: Array, *, has_vertical_motion: bool) -> dict[str, AnyArray]:
    """Return the ground acceleration at the output times."""
    values: dict[str, AnyArray] = {"ground_acceleration": ground[:, 0].copy()}
    if has_vertical_motion:
        values["vertical_ground_acceleration"] = ground[:, 1].copy()
    return values


def sines_cosines(rotation: Array, *, small: bool) -> tuple[Array, Array]:
    """Return the sine and cosine of rotations, or their small-rotation forms."""
    if small:
        return rotation, np.ones_like(rotation)
    return np.sin(rotation), np.cos(rotation)


def cap_histories(
    values: Mapping[str, AnyArray], setting: Setting, offset: float
) -> dict[str, AnyArray]:
    """Return the motion of a cap that is a part of the body, :eq:`eq-carried`."""
    rotation = values["rotation"]
    small, beside = setting.options.small, setting.body.eccentricity
    sine, cosine = sines_cosines(rotation, small=small)
    versine = 0.5 * rotation**2 if small else 2.0 * np.sin(0.5 * rotation) ** 2
    rate = values["angular_velocity"]
    return {
        "cap_rotation": rotation.copy(),
        "cap_angular_velocity": rate.copy(),
        "cap_vertical_displacement": values["vertical_displacement"]
        - offset * versine
        + beside * sine,
        "cap_vertical_velocity": values["vertical_velocity"]
        - offset * sine * rate
        + beside * cosine * rate,
        "soil_contact_state": values["contact_state"].copy(),
    }


def energy_histories(
    model: ContactModel, run: Trajectory, displacement: Array, slope: Incline
) -> dict[str, AnyArray]:
    """Return the energies at the output times by their names in the schema [J].

    The work of gravity along an inclined base, by the displacement along it, counts as potential
    energy, and not as input, :eq:`eq-incline-energy`.
    """
    stored = model.mass * energies_of(model, run)
    memory, row = memory_at_outputs(run)
    lost = model.mass * memory[row]
    work = model.mass * run.work
    energies: dict[str, AnyArray] = {
        "kinetic_energy": stored[:, 0].copy(),
        "potential_energy": stored[:, 1].copy(),
        "elastic_energy": stored[:, 2].copy(),
        "dissipated_energy": work[:, 0] + lost[:, LINK_LOSS],
        "impact_energy": lost[:, IMPACT_LOSS].copy(),
        "repinning_energy": lost[:, REPINNING_LOSS].copy(),
        "input_energy": work[:, 1] + lost[:, IMPULSIVE_INPUT],
    }
    if not slope.level:
        raised = (
            model.mass * slope.along_gravity * (displacement + _carrier_displacement(model, run))
        )
        energies["potential_energy"] = energies["potential_energy"] + raised
        energies["input_energy"] = energies["input_energy"] + (raised - raised[0])
    return energies


def event_columns(model: ContactModel, run: Trajectory) -> dict[str, AnyArray]:
    """Return the table of events by its names in the schema."""
    events, size, weights = run.events, len(model.rotation_weights), model.rotation_weights
    shown = events.kind != SILENT
    contacts: dict[str, AnyArray] = {
        f"{name}_{when}": model.contact_states(modes[shown], body).astype(np.int8)
        for body, name in enumerate(model.contacts)
        for when, modes in (("before", events.mode_before), ("after", events.mode_after))
    }
    overturned = np.isin(events.kind, (OVERTURNING, TOPPLED))  # of the highest body, by no link
    if model.shows_bodies:
        of_event = events.memory[:, model.memory.index("body_of_event")]
        contacts["event_body"] = np.where(overturned, 1, of_event).astype(int)[shown]
    if model.links:
        of_event = events.memory[:, model.memory.index("link_of_event")]
        contacts["event_restrainer"] = np.where(overturned, 0, of_event).astype(int)[shown]
    return {
        "event_time": events.time[shown],
        "event_kind": events.kind[shown].astype(np.int8),
        **contacts,
        "event_rotation": events.state_after[shown, :size] @ weights,
        "angular_velocity_before": events.state_before[shown, size : 2 * size] @ weights,
        "angular_velocity_after": events.state_after[shown, size : 2 * size] @ weights,
    }


def scalars(
    run: Summary, setting: Setting, *, uplift_angle: float
) -> dict[str, AnyArray | float | int | bool]:
    """Return the scalars of a run by their names in the schema, also those of each body."""
    angles = setting.overturning_angles
    # peaks of a body that did not move have no negative zeros
    sides: dict[str, AnyArray | float] = {}
    if setting.leans:
        sides = {
            "left_overturning_angle": angles.left,
            "right_overturning_angle": angles.right,
            "left_peak_rotation": run.peak_left + 0.0,
            "right_peak_rotation": run.peak_right + 0.0,
            "rest_rotation": setting.rest_rotation,
        }
    every = setting.slips_of(run.ending)
    if every:
        sides |= {"peak_slip": every[0].peak + 0.0, "residual_slip": every[0].residual}
    if len(every) > 1 and setting.stacked:
        sides |= {"peak_cap_slip": every[1].peak, "residual_cap_slip": every[1].residual}
    elif len(every) > 1:
        sides["peak_body_slip"] = np.array([slips.peak for slips in every])
    return sides | {
        "overturned": run.reached_limit,
        "overturning_time": run.overturning_time,
        "overturning_direction": run.overturning_direction,
        "peak_rotation": run.peak_rotation + 0.0,
        "peak_relative_rotation": peak_share(run, angles) + 0.0,
        "first_uplift_time": run.first_uplift_time,
        "impact_count": run.impact_count,
        "flight_time": run.flight_time,
        "flight_count": run.flight_count,
        "energy_residual": run.energy_residual,
        "status": int(run.status),
        "overturning_angle": min(angles),
        "uplift_angle": uplift_angle,
    }


def overturns(runs: xr.Dataset) -> xr.DataArray:
    """Return the verdicts of runs, from their status: 1 for overturned, 0 for not, NaN for none."""
    status = runs["status"]
    verdicts = status.copy(data=overturned_from_status(status.to_numpy()), deep=False)
    verdicts.attrs = {}
    return verdicts


def check_no_means(runs: xr.Dataset, *, owner: str) -> None:
    """Refuse means of runs: the mean of two statuses is none, or a third one."""
    status = runs["status"].to_numpy()
    if status.dtype.kind == "f" and np.any(status != np.round(status), where=~np.isnan(status)):
        msg = f"{owner}: found means of runs, which have no verdict; expected the runs themselves"
        raise SchemaError(msg)


def verdict_of(run: xr.Dataset) -> bool | None:
    """Return the verdict of one run, see :func:`overturns`; None if it has none."""
    overturned = float(overturns(run))
    return None if math.isnan(overturned) else bool(overturned)


def overturned_from_status(status: AnyArray) -> Array:
    """Return the verdicts of statuses: 1, 0, or NaN where there is none."""
    verdicts = np.full(np.shape(status), np.nan)
    for member in Status:
        if member.overturned is not None:
            verdicts[status == member] = member.overturned
    return verdicts


_DID_NOT_SLIDE: Final = "Did not slide"
_STOP_REASONS = {
    Status.STEP_LIMIT: "the limit of steps was reached",
    Status.STEP_TOO_SMALL: "no step was small enough for the requested accuracy",
    Status.CHATTER: "contact changes followed one another without end",
}


def verdict(run: Summary, setting: Setting, model: ContactModel) -> str:
    """Describe the outcome for the block in one sentence."""
    of = " of body 1" if model.shows_bodies else ""
    broken = [setting.link_names[i] for i in broken_links(model, run.ending)]
    impacts = f"{run.impact_count} impact{'' if run.impact_count == 1 else 's'}"
    angles = setting.overturning_angles
    share, rotation, side = max(
        (run.peak_right / angles.right, run.peak_right, Direction.RIGHT),
        (run.peak_left / angles.left, run.peak_left, Direction.LEFT),
        key=lambda peak: peak[0],
    )
    peak = f"peak rotation {rotation:.4g} rad, {100.0 * share:.3g} % of the overturning angle{of}"
    if setting.leans and rotation > 0.0:
        peak += f" to the {side.name.lower()}"
    if run.other_rotation_ratio > (1.0 + EQUAL_SHARES) * share:
        peak += f", a lower body {100.0 * run.other_rotation_ratio:.3g} % of its own"
    if run.reached_limit:
        text = f"{_overturning_words(run, setting, model)}, after {impacts}"
    elif not run.status.finished:
        text = f"Not finished: {_stop_words(run)}. Until then no overturning: {peak}; {impacts}"
    else:
        text = f"Did not overturn: {peak}; {impacts}"
    if not run.reached_limit and math.isnan(run.first_uplift_time):
        text += ", no uplift from the pads" if setting.stacked else f", no uplift{of}"
    if run.flight_time > 0.0:
        text += f", {run.flight_time:.3g} s in flight"
    if broken:
        text += f"; {enumeration(broken)} broke"
    if run.reached_limit and not run.status.finished:
        text += f". Not finished: {_stop_words(run)}"
    slid = [_slip_words(slips) for slips in setting.slips_of(run.ending)]
    if len(slid) > 1:
        names = setting.sliding_bodies or [f"body {k}" for k in range(1, len(slid) + 1)]
        held = [names[k] for k, words in enumerate(slid) if words == _DID_NOT_SLIDE]
        several = len(slid) > 2 and len(held) > 1
        slid = [
            f"{names[k]} {words[0].lower()}{words[1:]}"
            for k, words in enumerate(slid)
            if not (several and words == _DID_NOT_SLIDE)
        ]
        if several:
            slid.append(f"{enumeration(held)} did not slide" if slid else "no body slid")
    if slid:
        words = ", ".join([*slid, f"{text[0].lower()}{text[1:]}"])
        text = f"{words[0].upper()}{words[1:]}"
    return text + "."


def enumeration(items: Sequence[str], last: str = "and") -> str:
    """Write items in a row, the last one after a word such as "and"."""
    return ", ".join([*items[:-2], f" {last} ".join(items[-2:])])


def _slip_words(slips: SlipRange) -> str:
    """Describe the slip of a body at the end, and its peak where that is much larger."""
    if slips.peak < MIN_REPORTED_SLIP:
        return _DID_NOT_SLIDE
    most = Direction.RIGHT if slips.right > slips.left else Direction.LEFT
    side = Direction.RIGHT if slips.residual > 0.0 else Direction.LEFT
    if abs(slips.residual) < ZERO_RESIDUAL_SHARE * slips.peak:
        return f"Slid {slips.peak:.3g} m to the {most.name.lower()} and back"
    text = f"Slid {abs(slips.residual):.3g} m to the {side.name.lower()}"
    if abs(slips.residual) < LARGE_RESIDUAL_SHARE * slips.peak:
        side_of_peak = "" if most is side else f"to the {most.name.lower()} "
        text += f" ({slips.peak:.3g} m {side_of_peak}at most)"
    return text


def _overturning_words(run: Summary, setting: Setting, model: ContactModel) -> str:
    """Say when the overturning angle was passed and, if the run went on, how the body ended."""
    angles, side = setting.overturning_angles, Direction(run.overturning_direction)
    end = model.rotation_in(run.ending.state)
    when = f"to the {side.name.lower()} at {run.overturning_time:.3f} s"
    if run.status is Status.TOPPLED:
        last = Direction.RIGHT if end > 0.0 else Direction.LEFT
        flat = f"at {run.end_time:.3f} s"
        if last is side:
            return f"Overturned {when}, and fell flat {flat}"
        return (
            f"Passed the overturning angle {when}, and fell flat to the {last.name.lower()} {flat}"
        )
    if run.status is not Status.COMPLETED:
        return f"Overturned {when}"
    stands = abs(end) < angles.on_side_of(end) and model.other_share_in(run.ending.state) < 1.0
    ends = "stands" if stands else "is beyond it"
    return f"Passed the overturning angle {when}, and {ends} at the end"


def _stop_words(run: Summary) -> str:
    return f"stopped at {run.end_time:.6g} s, because {_STOP_REASONS[run.status]}"


SUPPORT_ACCELERATIONS = ("cap_acceleration",)
"""Accelerations along the base in which a model includes the component of gravity."""


def slope_attributes(slope: Incline) -> dict[str, str]:
    """Return the attributes of a result that describe its axes."""
    axes = "horizontal and vertical"
    if not slope.level:
        side = "right" if slope.inclination > 0.0 else "left"
        axes = (
            f"along and normal to the base, which is inclined by "
            f"{angle_words(abs(slope.inclination))} and higher on the {side}; rotations are "
            "relative to it; ground accelerations are horizontal and vertical"
        )
    return {"inclination": f"{slope.inclination!r} {ANGLE.unit}", "axes": axes}


def ground_on_slope(ground: Array, slope: Incline) -> tuple[Array, Array]:
    """Return the ground's acceleration along and normal to the base, without and with gravity."""
    if slope.level:
        return ground, ground
    moved = np.column_stack(slope.rotated(ground[:, 0], ground[:, 1]))
    return moved, moved + np.array([slope.along_gravity, 0.0])


def without_gravity(shown: Mapping[str, AnyArray], slope: Incline) -> dict[str, AnyArray]:
    """Subtract gravity from the absolute accelerations among a model's columns."""
    return {
        name: values - slope.along_gravity if name in SUPPORT_ACCELERATIONS else values
        for name, values in shown.items()
    }


def _carrier_displacement(model: ContactModel, run: Trajectory) -> Array | float:
    """Return what a lower body adds to the mass-weighted displacement in the work of gravity."""
    from rockframe.dynamics.cascade.system import Cascade
    from rockframe.dynamics.chain.on_cap import OnCap
    from rockframe.dynamics.chain.rows import MASS
    from rockframe.dynamics.coupled.system import Coupled
    from rockframe.dynamics.stacked import LOWER

    system = model.system
    if isinstance(system, Cascade):
        # both stages have their own body, and the displacement is the sum of theirs
        ratio = system.mass_ratio - 1.0
    elif isinstance(system, Coupled):
        ratio = system.cap_mass
    elif isinstance(system, OnCap):
        ratio = system.row_value(LOWER, MASS)
    else:
        return 0.0
    memory, rows = memory_at_outputs(run)
    places = np.array(
        [
            system.centre_position(LOWER, int(mode), state, memory[row])
            for mode, state, row in zip(run.mode, run.state, rows, strict=True)
        ]
    )
    return ratio * places
