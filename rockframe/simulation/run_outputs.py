"""Histories, peaks of forces and motions of points of a run, as far as they are requested."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Final, TypeVar

import numpy as np

from rockframe.compiled import Integers
from rockframe.dynamics.events import IMPACT, REVERSAL, SILENT, SLIP, STICK
from rockframe.dynamics.protocol import BODY_FORCES
from rockframe.errors import words_of
from rockframe.motion import GroundMotion
from rockframe.results.along_steps import FRACTIONS, AlongSteps
from rockframe.results.diagnostics import read_only
from rockframe.results.forces import (
    SETTLEMENT_COLUMNS,
    SOIL_FRICTION_COLUMNS,
    EventStates,
    SlidingCheck,
    force_histories,
    force_peaks,
    friction_demands,
    residual_values,
    sliding_checks,
    sliding_scalars,
)
from rockframe.results.outcome import (
    body_histories,
    cap_histories,
    energy_histories,
    ground_histories,
    ground_on_slope,
    numbered_columns,
    relative_histories,
    without_gravity,
)
from rockframe.results.points import point_histories, point_labels, point_peaks
from rockframe.results.schema import ENERGIES, ON_REQUEST, SCHEMA, checked_results
from rockframe.results.variables.variable import EVENT, TIME
from rockframe.signals.arrays import AnyArray, Array
from rockframe.simulation.plan import Plan
from rockframe.solve.observe import memory_at_outputs, observe_run, observe_states
from rockframe.solve.trajectory import Trajectory
from rockframe.system.assembly import Assembly
from rockframe.system.own_base import OwnAnswers

Result = TypeVar("Result")

SLIP_EVENTS: Final = (SLIP, REVERSAL, STICK)
"""Events at which a base begins to slip, reverses its slip, or is held again."""
MAX_STOPPED_SLIP: Final = 1e-6
"""Longest slip, over the width of the base, that friction stops at once."""


@dataclass(frozen=True)
class RunOutputs:
    """What follows from the samples of a run; empty for a run without samples."""

    # histories, and values at events, by their names in the schema
    values: dict[str, AnyArray] = field(default_factory=dict[str, AnyArray])
    # peaks of forces, residuals at the end of the run, and peaks at points, shape (points,)
    scalars: dict[str, AnyArray | float] = field(default_factory=dict[str, AnyArray | float])
    # names and places of points, names of restrainers
    points: dict[str, AnyArray] = field(default_factory=dict[str, AnyArray])
    # checks of the bases with a given friction that the model holds
    sliding_checks: list[SlidingCheck] = field(default_factory=list[SlidingCheck])


def ground_at(motion: GroundMotion | None, time: Array) -> Array:
    """Return the horizontal and vertical ground accelerations, shape (times, 2) [m s^-2]."""
    still = np.zeros_like(time)
    components = () if motion is None else (motion.si.horizontal, motion.si.vertical)
    accelerations = [still if signal is None else signal.at(time) for signal in components]
    return np.column_stack(accelerations or [still, still])


def compute_outputs(
    system: Assembly, plan: Plan, run: Trajectory, missing: list[str]
) -> RunOutputs:
    """Return what follows from the samples of a run; what cannot be computed is in `missing`."""
    setting, load, model = system.setting, system.setting.load, system.model
    observed = _ObservedRun(system, plan, run)
    values, until_overturning = observed.histories(), observed.events
    overturned = run.overturning_time <= run.end_time
    along = observed.along(run.overturning_time if overturned else math.inf)
    if not along.steps.complete:
        missing.append(
            f"peaks of forces and at points are those until {along.steps.time[-1]:.4g} s: the run "
            "made more steps than are kept"
        )
    if overturned:  # the fall after overturning does not count
        in_time = until_overturning.time <= run.overturning_time
        until_overturning = until_overturning.select(in_time)
    checks = sliding_checks(system, along)
    of_forces, of_settlement = force_peaks(along, until_overturning, load)
    scalars: dict[str, AnyArray | float] = {
        **of_forces, **sliding_scalars(checks), **residual_values(observed.at_the_end(), load),
        **of_settlement,
    }  # fmt: skip
    if model.shows_bodies:
        # peaks of the whole run, as for the peak rotation of the highest body
        every = observed.along(math.inf) if overturned else along
        scalars["peak_body_rotation"] = _absolute_peaks("rotation", model.system.bodies(), every)
    places: dict[str, AnyArray] = {}
    if model.links:
        scalars["peak_restrainer_force"] = _absolute_peaks("restrainer_force", model.links, along)
        places = {"restrainer": np.array(setting.link_names)}
    if plan.points:
        scalars |= point_peaks(plan.points, along, load)
        places |= point_labels(plan.points)
        values |= point_histories(plan.points, values, load)
    visible = run.events.kind != SILENT
    impulses = observed.events.impulses(load.body.mass)
    everything = values | {name: column[visible] for name, column in impulses.items()}
    if "slip" in values:
        everything["event_slip"] = observed.events.after["slip"][visible]
    if plan.energies:
        across = values["horizontal_displacement"]
        everything |= energy_histories(model, run, across, system.options.slope)
    of_users = _user_outputs(observed, values, everything, along, missing)
    scalars |= {name: column for name, column in of_users.items() if not SCHEMA[name].dims}
    everything |= {name: column for name, column in of_users.items() if SCHEMA[name].dims}
    requested = {
        name: column
        for name, column in everything.items()
        if name not in ON_REQUEST or name in plan.requested
    }
    return RunOutputs(requested if plan.histories else {}, scalars, places, checks)


class _ObservedRun:
    """The columns of a model in a run: along the steps, at samples, and around events."""

    def __init__(self, system: Assembly, plan: Plan, run: Trajectory) -> None:
        self.system, self.plan, self.run = system, plan, run
        # whether all columns are needed along the steps, or only those whose peaks are results
        self.whole = bool(plan.points or plan.diagnostics)
        events, slope, count = run.events, system.options.slope, len(run.time)
        ground = ground_at(plan.motion, np.concatenate([run.time, events.time, events.time]))
        moved, resolved = ground_on_slope(ground, slope)
        model, names = system.model, BODY_FORCES + SETTLEMENT_COLUMNS
        names += numbered_columns("restrainer_force", model.links)
        names += SOIL_FRICTION_COLUMNS if system.setting.stacked else ()
        names += numbered_columns("rotation", model.system.bodies()) if model.shows_bodies else ()
        self.columns, columns = observe_run(model, run, None if self.whole else names, resolved)
        columns, last = without_gravity(columns, slope), count + len(events.time)
        self.values, before, after = (
            {name: column[part] for name, column in columns.items()}
            for part in (slice(count), slice(count, last), slice(last, None))
        )
        is_impact = (events.kind == IMPACT) & system.setting.struck_by_base
        self.events = EventStates(events.time, is_impact, before, after)
        # at the samples, horizontal and vertical, and along and normal to the base
        self.ground, self.moved = ground[:count], moved[:count]

    def histories(self) -> dict[str, AnyArray]:
        """Return the histories of a run, without those at points and those that take events."""
        plan, run, setting, model = self.plan, self.run, self.system.setting, self.system.model
        values = dict(self.values)
        # energies are computed apart; other requested values that are no columns follow from these
        if self.whole or set(plan.requested).difference(values, ENERGIES):
            values |= force_histories(values, self.moved, setting.load)
        values |= {
            name: model.contact_states(run.mode, body).astype(np.int8)
            for body, name in enumerate(model.contacts)
        }
        if setting.cap_offset is not None:
            values |= cap_histories(values, setting, setting.cap_offset)
        if model.selects:
            values = body_histories(model, run, values)
        values |= relative_histories(values, setting)
        values |= ground_histories(self.ground, has_vertical_motion=plan.has_vertical_motion)
        values["time"] = run.time
        return values

    def at_the_end(self) -> dict[str, AnyArray]:
        """Return the model's columns at the end of a run, which need not be a sample."""
        run, ending, slope = self.run, self.run.ending, self.system.options.slope
        ground = ground_at(self.plan.motion, np.array([run.end_time]))
        return observe_states(
            self.system.model, np.array([ending.mode]), ending.state[None], ending.memory[None],
            np.zeros(1, dtype=np.int64), ground_on_slope(ground, slope)[1],
        )  # fmt: skip

    def along(self, until: float) -> AlongSteps:
        """Return the quantities along the steps up to a time, from the columns along all steps.

        Steps in which friction stops the small slip left by an impact or a change of the held
        point are left out: there a base that holds takes an impulse instead of a force.
        """
        run, slope, load = self.run, self.system.options.slope, self.system.setting.load
        memory, steps = memory_at_outputs(run)[0], run.kept_steps.until(until)
        columns = {name: column[: len(steps.time)] for name, column in self.columns.items()}
        if STICK in run.events.kind:
            stops = _stopping_events(
                run, self.events, MAX_STOPPED_SLIP * 2.0 * load.body.half_width
            )
            in_time = ~np.isin(steps.memory_row, stops)
            steps = replace(steps, values=steps.values[in_time], codes=steps.codes[in_time])
            columns = {name: column[in_time] for name, column in columns.items()}
        if self.whole:
            moved = steps.ground - np.array([slope.along_gravity, 0.0])
            level = replace(slope, inclination=-slope.inclination)
            ground = np.column_stack(level.rotated(*moved.T))
            columns = self._with_derived(without_gravity(columns, slope), steps.time, ground, moved)
        else:
            columns |= friction_demands(columns, load)

        def inside(which: Integers) -> dict[str, AnyArray]:
            places, length = len(FRACTIONS), steps.length[which]
            time = (steps.time[which] - length)[:, None] + length[:, None] * FRACTIONS
            time, states = time.ravel(), steps.states_inside(which, self.system.model, FRACTIONS)
            ground = ground_at(self.plan.motion, time)
            moved, resolved = ground_on_slope(ground, slope)
            modes, rows = (np.repeat(of[which], places) for of in (steps.mode, steps.memory_row))
            states = states.reshape(-1, states.shape[-1])
            values = observe_states(self.system.model, modes, states, memory, rows, resolved)
            values = without_gravity(values, slope)
            if not self.whole:
                return values | friction_demands(values, load)
            return self._with_derived(values, time, ground, moved)

        return AlongSteps(steps, columns, inside)

    def _with_derived(
        self, columns: dict[str, AnyArray], time: Array, ground: Array, moved: Array
    ) -> dict[str, AnyArray]:
        """Return columns with what follows from them, and with the state that diagnostics take."""
        columns = columns | force_histories(columns, moved, self.system.setting.load)
        return columns | _diagnostic_state(columns, time, ground)


def _user_outputs(
    observed: _ObservedRun,
    values: dict[str, AnyArray],
    everything: dict[str, AnyArray],
    along: AlongSteps,
    missing: list[str],
) -> dict[str, Any]:
    """Return the results of user-defined bases, scenes and diagnostics for a run."""
    plan, system, outputs = observed.plan, observed.system, dict[str, Any]()
    for own in (system.setting, *system.parts.structural()) if plan.histories else ():
        if isinstance(own, OwnAnswers):
            events = observed.events.select(observed.run.events.kind != SILENT)
            sides = [{**side, "time": events.time} for side in (events.before, events.after)]
            sizes = {TIME[0]: len(values["time"]), EVENT[0]: len(events.time)}
            outputs |= compute_or_note(
                lambda own=own, sides=sides, sizes=sizes: checked_results(
                    own.answers(*map(read_only, (everything, *sides))), sizes
                ),
                {}, f"the results of {type(own).__name__}", missing,
            )  # fmt: skip
    for one in plan.diagnostics:
        state = _diagnostic_state(values, observed.run.time, observed.ground)
        history_and_peak = compute_or_note(
            lambda one=one, state=state: (
                one.of(state), along.largest(lambda values: np.abs(one.of(values))[None])[0].item()
            ),
            None, f"the diagnostic {one.name!r}", missing,
        )  # fmt: skip
        if history_and_peak is not None:
            outputs[one.name], outputs[one.rows[1].name] = history_and_peak
    return outputs


def _absolute_peaks(name: str, count: int, along: AlongSteps) -> Array:
    """Return the greatest absolute values of a quantity of all bodies, or of all restrainers."""
    names = numbered_columns(name, count)
    return along.largest(lambda shown: np.abs([shown[name] for name in names]))[0]


def _stopping_events(run: Trajectory, events: EventStates, within: float) -> Integers:
    """Return numbers, from 1, of events whose small slip velocity friction stops `within` [m]."""
    kind = run.events.kind
    changes = ~np.isin(kind[:-1], SLIP_EVENTS) & (kind[1:] == STICK)
    of_caps = ("slip", "cap_slip")
    for name in (one for one in events.after if one in of_caps or one.startswith("slip_of_")):
        changes &= np.abs(events.before[name][1:] - events.after[name][:-1]) < within
    return 1 + np.flatnonzero(changes)


def _diagnostic_state(
    values: dict[str, AnyArray], time: Array, ground: Array
) -> dict[str, AnyArray]:
    """Return the state that diagnostics take: values at some times, and the ground there."""
    known = {name: each for name, each in values.items() if name in SCHEMA}
    return {
        **{name: each for name, each in known.items() if SCHEMA[name].dims == TIME},
        "time": time,
        **ground_histories(ground, has_vertical_motion=True),
    }


def compute_or_note(
    work: Callable[[], Result], default: Result, what: str, missing: list[str]
) -> Result:
    """Compute a further result of a finished run; if that fails, note it and return the default."""
    try:
        return work()
    except (Warning, MemoryError):  # made an error by the user; which says nothing of the run
        raise
    except Exception as problem:
        missing.append(f"{what} could not be computed: {words_of(problem)}")
        return default
