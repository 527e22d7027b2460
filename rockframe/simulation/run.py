"""One run: the integration and the dataset."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final, TypeAlias

import numpy as np
import xarray as xr

from rockframe.errors import ModelWarning, RockframeWarning, SolverWarning, warn
from rockframe.motion import GroundMotion
from rockframe.results.dataset import build_dataset
from rockframe.results.forces import friction_words
from rockframe.results.outcome import Generic, event_columns, peak_of, scalars, verdict
from rockframe.results.slope import felt_ground, slope_attributes
from rockframe.results.variables.runs import Direction
from rockframe.signals import Motion
from rockframe.simulation.answers import Answers, answers_of, ground_at
from rockframe.simulation.audit import doubtful, unbalanced
from rockframe.simulation.beginning import end_attributes, start_of
from rockframe.simulation.beside import Beside, what_showed
from rockframe.simulation.certificate import certify
from rockframe.simulation.certification import Certification
from rockframe.simulation.end_in_motion import STILL_MOVING, may_overturn_later
from rockframe.simulation.plan import Plan
from rockframe.simulation.provenance import motion_attributes
from rockframe.solve.integrate import STILL_INTERVAL, integrate
from rockframe.solve.trajectory import Summary, Trajectory
from rockframe.system.assembly import Assembly

ADAPTIVE = "Dormand-Prince 5(4) from sample to sample, with event location"
FIXED = "Nystrom method of order 3 in fixed sub-steps from sample to sample, with event location"
_LEAVES: Final = (
    "the block would leave the rigid ground, which this model cannot show; put it on a "
    "TwoSpringSupport to follow its flight"
)
NONE: Final = "none"
"""What is said where there is nothing to be cautious of."""
TENSION: Final = 1e-9
"""Share of the largest reaction below which a pull is rounding."""

Caution: TypeAlias = tuple[type[RockframeWarning], str]
"""A warning's kind and text."""


def felt_motion(system: Assembly, plan: Plan) -> Motion | None:
    """Give the motion as the integrator takes it: on a slope along and normal to the base."""
    motion, slope = None if plan.motion is None else plan.motion.si, system.options.slope
    if slope.level:
        return motion
    return slope.felt(motion, duration=plan.duration, interval=STILL_INTERVAL)


@dataclass(frozen=True)
class Response:
    """A run before it is labelled: what became of it, and what its samples tell."""

    system: Assembly
    plan: Plan
    trajectory: Trajectory
    answers: Answers

    @cached_property
    def events(self) -> dict[str, Generic]:
        """The table of events, by its names in the schema."""
        return event_columns(self.system.model, self.trajectory)

    @cached_property
    def scalars(self) -> dict[str, Generic | float | int | bool]:
        """All scalars, and peaks at points, by their names in the schema."""
        return {**scalars(self.trajectory, self.system.setting), **self.answers.scalars}

    @cached_property
    def in_motion(self) -> bool:
        """Whether the body stood with the energy to overturn later."""
        return may_overturn_later(self.system, self.trajectory)

    def beside(self) -> Beside:
        """Tell what a certificate asks of the run."""
        share = peak_of(self.trajectory, self.system.setting.overturning_angles).share
        return what_showed(
            self.trajectory, self.events, share, self.plan.duration, in_motion=self.in_motion
        )

    def cautions(self) -> list[Caution]:
        """Give what is to be warned of."""
        summary, plan = self.trajectory, self.plan
        audit = unbalanced(
            self.system, plan, summary, self.beside, lambda other: beside(self.system, other)
        )
        return [
            *_unfinished(self.system, summary),
            *([(SolverWarning, STILL_MOVING)] if self.in_motion else []),
            *([] if audit is None else [(SolverWarning, audit)]),
            *_lost_weight(self.system, plan.motion),
            *_pulling(self.system, self.answers.values, summary.overturning_time),
            *((ModelWarning, text) for text in self.answers.slips),
        ]


def run(system: Assembly, plan: Plan, certification: Certification | None = None) -> xr.Dataset:
    """Integrate as planned and label the result.

    Parameters
    ----------
    system : Assembly
        The checked scene.
    plan : Plan
        The checked arguments.
    certification : Certification, optional
        What to try, to tell how sure the verdict is.

    Returns
    -------
    xarray.Dataset
    """
    response = respond(system, plan)
    summary = response.trajectory
    attributes = _attributes(system, plan, summary)
    attributes |= end_attributes(summary.ending)
    if summary.status.finished:
        attributes["verdict"] = f"{attributes['verdict']}{friction_words(response.answers.scalars)}"
    cautions = response.cautions()
    for kind, text in cautions:
        warn(text, kind)
    # said of every run: what only some datasets say, xarray.concat would take for all
    every = [*system.cautions, *(text for _, text in cautions)]
    attributes["cautions"] = "; ".join(every) or NONE
    certificate: dict[str, float | bool] = {}
    if certification is not None:
        found = certify(system, plan, response.beside(), certification, beside)
        certificate = found.values()
        attributes |= found.attributes()
    values = {
        **response.events, **response.answers.values, **response.answers.points,
        **response.scalars, **certificate,
    }  # fmt: skip
    return build_dataset(values, attributes)


def outcome(system: Assembly, plan: Plan) -> Summary:
    """Integrate as planned, and give only what became of the run.

    Parameters
    ----------
    system : Assembly
        The checked scene.
    plan : Plan
        The checked arguments; without histories it is cheapest.

    Returns
    -------
    Summary
    """
    return respond(system, plan).trajectory


def beside(system: Assembly, plan: Plan) -> Beside:
    """Integrate as planned, and tell what a certificate asks of the run.

    Parameters
    ----------
    system : Assembly
        The checked scene.
    plan : Plan
        The checked arguments.

    Returns
    -------
    Beside
    """
    return respond(system, plan).beside()


def respond(system: Assembly, plan: Plan) -> Response:
    """Integrate as planned.

    Parameters
    ----------
    system : Assembly
        The checked scene.
    plan : Plan
        The checked arguments.

    Returns
    -------
    Response
    """
    trajectory = integrate(
        system.model, start_of(plan.initial), felt_motion(system, plan), plan.accuracy,
        duration=plan.duration, output_step=plan.output_step,
        stop_at_overturning=plan.stop_at_overturning, with_work=bool(plan.energies),
    )  # fmt: skip
    sampled = plan.output_step is not None
    answers = answers_of(system, plan, trajectory) if sampled else Answers()
    return Response(system, plan, trajectory, answers)


def _attributes(system: Assembly, plan: Plan, summary: Summary) -> dict[str, str | float | int]:
    coupling = {"coupling": str(system.options.coupling)} if system.scene.coupling else {}
    return {
        "verdict": _verdict(system, summary),
        "overturned": int(bool(summary.overturned)),
        "overturning_time": summary.overturning_time,
        "overturning_direction": Direction(summary.overturning_direction).name.lower(),
        "model": system.setting.model,
        "restraint": str(system.options.restraint),
        "kinematics": str(system.options.rotation),
        **slope_attributes(system.options.slope),
        **coupling,
        "model_description": system.description,
        "accuracy": plan.accuracy_name,
        "solver_method": ADAPTIVE if plan.accuracy.substeps is None else FIXED,
        "solver_rtol": plan.accuracy.rtol or math.nan,
        "solver_substeps": summary.substeps,
        "solver_steps": summary.step_count,
        "solver_rejected_steps": summary.rejected_count,
        "solver_end_time": summary.end_time,
        **motion_attributes(plan.motion),
        "system_json": system.json,
        "run_json": plan.to_json(),
    }


def nothing_to_say(system: Assembly, summary: Summary) -> bool:
    """Whether a run with fixed steps has come to an end, with its energies in balance."""
    return summary.status.finished and summary.energy_residual <= doubtful(system)


def _verdict(system: Assembly, summary: Summary) -> str:
    end = system.model.rotation_in(summary.ending.state)
    return verdict(summary, system.setting, end=end)


def _unfinished(system: Assembly, summary: Summary) -> Iterator[Caution]:
    if not summary.status.finished:
        yield SolverWarning, _verdict(system, summary)


def _lost_weight(system: Assembly, motion: GroundMotion | None) -> Iterator[Caution]:
    slope = system.options.slope
    if system.setting.settlement is not None or motion is None:
        return
    if slope.level and motion.si.vertical is None:
        return
    moved, _ = felt_ground(ground_at(motion, motion.si.horizontal.times), slope)
    lowest = float(np.min(moved[:, 1]))
    if lowest < -slope.normal_gravity:
        which = "vertical" if slope.level else "normal"
        found = f"the {which} ground acceleration falls to {lowest:.4g} m s^-2, beyond gravity"
        yield ModelWarning, f"{found}: {_LEAVES}"


def _pulling(
    system: Assembly, values: Mapping[str, Generic], overturning_time: float
) -> Iterator[Caution]:
    if system.setting.settlement is not None or "left_reaction" not in values:
        return
    stands = ~(values["time"] > overturning_time)  # how a block falls is another matter
    reaction = (values["left_reaction"] + values["right_reaction"])[stands]
    lowest = float(np.min(reaction))
    if lowest < -TENSION * float(np.max(np.abs(reaction))):
        when = float(values["time"][np.argmin(reaction)])
        found = (
            f"the ground would have to pull at the bearing corner, with {-lowest:.4g} N at "
            f"{when:.4g} s"
        )
        yield ModelWarning, f"{found}: {_LEAVES}"
