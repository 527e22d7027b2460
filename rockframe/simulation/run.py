"""One run: integration as planned, then the labelled dataset with its cautions."""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final, Literal, TypeAlias

import numpy as np
import xarray as xr

from rockframe.compiled import compiling_for
from rockframe.dynamics.chain.rigid import RigidChain
from rockframe.errors import ModelWarning, RockframeWarning, SolverWarning, warn
from rockframe.motion import GroundMotion
from rockframe.results.forces import friction_words, sliding_cautions
from rockframe.results.outcome import (
    broken_links,
    event_columns,
    ground_on_slope,
    peak_share,
    scalars,
    slope_attributes,
    verdict,
)
from rockframe.results.schema import Results, build_dataset, schema_row
from rockframe.results.variables.runs import Direction
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.certify.certificate import certify
from rockframe.simulation.certify.run_summary import RunSummary, run_summary
from rockframe.simulation.certify.second_look import doubts, peak_error, second_look
from rockframe.simulation.plan import END_STATE, Plan, ending_as_json, start_of
from rockframe.simulation.provenance import motion_after_end, motion_attributes
from rockframe.simulation.run_arguments import PROVED, Certification
from rockframe.simulation.run_outputs import RunOutputs, compute_or_note, compute_outputs, ground_at
from rockframe.simulation.run_proof import prove_run
from rockframe.simulation.soundness import (
    STILL_MOVING,
    doubtful_residual,
    energy_caution,
    may_overturn_later,
    nonunique_motions,
)
from rockframe.solve.accuracy import LEVELS, AccuracyLevel
from rockframe.solve.integrate import STILL_INTERVAL, integrate
from rockframe.solve.trajectory import Summary, Trajectory
from rockframe.system.assembly import Assembly

ADAPTIVE_METHOD = "Dormand-Prince 5(4) from sample to sample, with event location"
FIXED_METHOD = (
    "Nystrom method of order 3 in fixed sub-steps from sample to sample, with event location"
)
_SEPARATES: Final = "the block would leave the rigid ground, which this model cannot show"
NONE: Final = "none"
"""Value of the attribute `cautions` where there are none."""
_SAMPLED_OUTPUTS: Final = "histories, and the peaks of forces and at points,"
_REPEATED_RUN: Final = "a second run with more steps"
_FRICTION_CHECK: Final = "whether the base has the friction that is needed"
_SEPARATION_CHECK: Final = "whether the block would leave the ground"
TENSION_TOLERANCE: Final = 1e-9
"""Share of the largest reaction below which a tensile reaction is rounding."""

Caution: TypeAlias = tuple[type[RockframeWarning], str]
"""A warning's kind and text."""


@dataclass(frozen=True)
class Response:
    """A run before it is labelled: its trajectory, and what follows from its samples.

    If something fails after the integration it is left out and named in `missing`, so that the run
    is not lost.
    """

    system: Assembly
    plan: Plan
    trajectory: Trajectory
    outputs: RunOutputs
    missing: list[str] = field(default_factory=list[str])

    @cached_property
    def events(self) -> dict[str, AnyArray]:
        """The table of events, by its names in the schema."""
        return event_columns(self.system.model, self.trajectory)

    @cached_property
    def scalars(self) -> dict[str, AnyArray | float | int | bool]:
        """All scalars, and peaks at points, by their names in the schema."""
        scalars = run_scalars(self.system, self.trajectory, self.missing)
        return {**scalars, **self.outputs.scalars}

    @cached_property
    def in_motion(self) -> bool:
        """Whether the body has not overturned, but has the energy to do so later."""
        return in_motion(self.system, self.trajectory, self.missing)

    @cached_property
    def nonunique_motions(self) -> tuple[dict[str, int], list[str]]:
        """Counts of events after which motion is not unique, and cautions about them."""
        model = self.system.model
        if not isinstance(model.system, RigidChain):
            return {}, []
        return nonunique_motions(model, model.system, self.trajectory)

    def summary(self) -> RunSummary:
        """Return the summary of the run that certificates are made from."""
        run, setting, checks = self.trajectory, self.system.setting, self.outputs.sliding_checks
        slips = [slip.peak for slip in setting.slips_of(run.ending)]
        return run_summary(
            run, self.events, peak_share(run, setting.overturning_angles), self.plan.duration,
            in_motion=self.in_motion, slip=max(slips, default=math.nan),
            slides=float(any(check.slides for check in checks)) if checks else math.nan,
        )  # fmt: skip

    def cautions(self) -> list[Caution]:
        """Return the warnings about the run."""
        summary, plan, missing = self.trajectory, self.plan, self.missing
        setting = self.system.setting
        moving = [STILL_MOVING] if self.in_motion else []
        audit = compute_or_note(
            lambda: energy_caution(
                self.system, plan, summary, self.summary,
                lambda other: compute_summary(self.system, other),
            ),
            None, "whether another run agrees with this one", missing,
        )  # fmt: skip
        values, falls = self.outputs.values, summary.overturning_time
        separating = [] if setting.flies else compute_or_note(
            lambda: list(_separation_cautions(self.system, plan.motion, values, falls)),
            [], _SEPARATION_CHECK, missing,
        )  # fmt: skip
        sliding = compute_or_note(
            lambda: sliding_cautions(self.outputs.sliding_checks), [], _FRICTION_CHECK, missing
        )
        _ = self.scalars  # computed first: what fails is added to `missing`
        cut_off = [] if summary.status.finished else [verdict(summary, setting, self.system.model)]
        beyond = setting.beyond_edges(summary.ending)
        of_model = [*self.nonunique_motions[1], *beyond, *separating, *sliding]
        return [
            *((SolverWarning, text) for text in (*cut_off, *moving, *filter(None, [audit]))),
            *((ModelWarning, text) for text in of_model),
            *((SolverWarning, text) for text in missing),
        ]


def in_motion(system: Assembly, summary: Summary, missing: list[str]) -> bool:
    """Whether a body that has not overturned may do so later; False where that is unknown."""
    what = "whether the body still has the energy to overturn"
    return compute_or_note(lambda: may_overturn_later(system, summary), False, what, missing)


def run_scalars(
    system: Assembly, summary: Summary, missing: list[str]
) -> dict[str, AnyArray | float | int | bool]:
    """Return the scalars of a run by their names in the schema, without those of its samples."""
    setting = system.setting
    uplift = compute_or_note(lambda: setting.uplift_angle, math.nan, "the uplift angle", missing)
    values = scalars(summary, setting, uplift_angle=uplift)
    if system.model.links:
        values["broken_restrainer_count"] = len(broken_links(system.model, summary.ending))
    return values


def run(
    system: Assembly,
    plan: Plan,
    certification: Certification | Literal["proved"] | None = None,
    *,
    repeat_run: bool = False,
) -> xr.Dataset:
    """Integrate as planned and label the result."""
    for column in () if system.model.selects else system.model.columns:
        schema_row(column.name)  # before the run
    proof = prove_run(system, plan, owner="simulate") if certification == PROVED else None
    response = compute_response(system, plan)
    missing, attributes = response.missing, _attributes(response)
    of_scene = compute_or_note(
        lambda: system.cautions, [], "what is unusual about the scene", missing
    )
    cautions, before = response.cautions(), len(missing)
    values = {**response.events, **response.scalars}
    if repeat_run and certification is None and plan.accuracy == LEVELS[AccuracyLevel.FAST]:
        values["peak_error_estimate"], doubted = _second_look(response)
        cautions += [(SolverWarning, text) for text in doubted]
    if proof is not None:
        overturned, end_time = response.summary().overturned, response.trajectory.end_time
        frequency = system.setting.body.frequency_at(system.setting.gravity)
        values |= proof.values(overturned, end_time)
        attributes |= proof.attributes()
        objections = proof.objections(overturned, end_time, frequency)
        cautions += [(SolverWarning, text) for text in objections]
    for kind, text in cautions:
        warn(text, kind)
    if isinstance(certification, Certification):
        certificate = compute_or_note(
            lambda: certify(system, plan, response.summary(), certification, compute_summary),
            None, "the certificate", missing,
        )  # fmt: skip
        if certificate is None:
            attributes["certificate"] = "Not known."
        else:
            values |= certificate.values()
            attributes |= certificate.attributes()
    dataset = _dataset(values, attributes, response)
    late = missing[before:]
    for text in late:
        warn(text, SolverWarning)
    every = [*of_scene, *(text for _, text in cautions), *late]
    dataset.attrs["cautions"] = "; ".join(every) or NONE
    return dataset


def _second_look(response: Response) -> tuple[float, list[str]]:
    """Return the error of the peak from a second run with more steps, and the doubts it raises."""
    system, plan, run = response.system, response.plan, response.trajectory

    def found() -> tuple[float, list[str]]:
        second = compute_response(system, second_look(system, plan)).trajectory
        return peak_error(run, second), list(doubts(system.setting, plan, run, second))

    return compute_or_note(found, (math.nan, []), _REPEATED_RUN, response.missing)


def _dataset(
    values: Results, attributes: Mapping[str, str | float | int], response: Response
) -> xr.Dataset:
    """Return the dataset of a run; without what follows from its samples if that fails."""
    outputs, motion = response.outputs, response.plan.motion
    of_samples = {**outputs.values, **outputs.points}
    dataset = compute_or_note(
        lambda: build_dataset(
            {**values, **of_samples, **motion_after_end(motion, of_samples)}, attributes
        ),
        None, _SAMPLED_OUTPUTS, response.missing,
    )  # fmt: skip
    return build_dataset(values, attributes) if dataset is None else dataset


def compute_summary(system: Assembly, plan: Plan) -> RunSummary:
    """Integrate as planned, and give the summary of the run that certificates are made from."""
    return compute_response(system, plan).summary()


def compute_response(system: Assembly, plan: Plan) -> Response:
    """Integrate as planned; give the run before it is labelled."""
    sampled = plan.output_step is not None
    # a run without histories is sampled at its start and end only
    output_step = plan.duration if sampled and not plan.histories else plan.output_step
    missing: list[str] = []
    outputs = RunOutputs()
    motion, slope = None if plan.motion is None else plan.motion.si, system.options.slope
    if not slope.level:  # along and normal to the base
        motion = slope.resolved(motion, duration=plan.duration, interval=STILL_INTERVAL)
    with compiling_for(f"a run ({system.setting.model})"):
        trajectory = integrate(
            system.model, start_of(plan.initial), motion, plan.accuracy,
            duration=plan.duration, output_step=output_step,
            stop_at_overturning=plan.stop_at_overturning, with_work=bool(plan.energies),
            keep_steps=sampled,
        )  # fmt: skip
        if sampled:
            outputs = compute_or_note(
                lambda: compute_outputs(system, plan, trajectory, missing),
                outputs,
                _SAMPLED_OUTPUTS,
                missing,
            )
    return Response(system, plan, trajectory, outputs, missing)


def _attributes(response: Response) -> dict[str, str | float | int]:
    system, plan, missing = response.system, response.plan, response.missing
    summary = response.trajectory
    friction = ""
    if summary.status.finished and not system.setting.slides:
        outputs = response.outputs
        friction = compute_or_note(
            lambda: friction_words(outputs.scalars, outputs.sliding_checks),
            "", _FRICTION_CHECK, missing,
        )  # fmt: skip
    description = compute_or_note(lambda: system.description, "", "the words of the model", missing)
    coupling = {"coupling": str(system.options.coupling)} if system.scene.coupling else {}
    return {
        "verdict": f"{verdict(summary, system.setting, system.model)}{friction}",
        "overturned": int(summary.reached_limit),
        "overturning_time": summary.overturning_time,
        "overturning_direction": Direction(summary.overturning_direction).name.lower(),
        "model": system.setting.model,
        "restraint": str(system.options.restraint),
        "kinematics": str(system.options.rotation),
        **slope_attributes(system.options.slope),
        **coupling,
        "model_description": description,
        "accuracy": plan.accuracy_name,
        "solver_method": ADAPTIVE_METHOD if plan.accuracy.substeps is None else FIXED_METHOD,
        "solver_rtol": plan.accuracy.rtol or math.nan,
        "solver_substeps": summary.substeps,
        "solver_steps": summary.step_count,
        "solver_rejected_steps": summary.rejected_count,
        "solver_end_time": summary.end_time,
        **compute_or_note(
            lambda: motion_attributes(plan.motion), {}, "the motion's origin", missing
        ),
        "system_json": compute_or_note(lambda: system.json, "", "the parts as text", missing),
        "run_json": compute_or_note(plan.to_json, "", "the arguments as text", missing),
        END_STATE: json.dumps(ending_as_json(summary.ending)),
        **response.nonunique_motions[0],
        # an attribute of every run: otherwise xarray.concat would extend it from a few runs to all
        "cautions": NONE,
    }


def has_no_cautions(system: Assembly, summary: Summary) -> bool:
    """Whether a run with fixed steps is finished, with its energies in balance."""
    return summary.status.finished and summary.energy_residual <= doubtful_residual(system)


def _separation_cautions(
    system: Assembly,
    motion: GroundMotion | None,
    values: Mapping[str, AnyArray],
    overturning_time: float,
) -> Iterator[str]:
    """Warn of a block that would lift off the ground, where the equations do not allow flight."""
    slope, links = system.options.slope, bool(system.setting.link_names)
    # a link may press the block on: then reactions tell, where there are histories of them
    by_motion = motion is not None and not (links and "left_reaction" in values)
    if motion is not None and by_motion and not (slope.level and motion.si.vertical is None):
        moved, _ = ground_on_slope(ground_at(motion, motion.si.horizontal.times), slope)
        lowest = float(np.min(moved[:, 1]))
        if lowest < -slope.normal_gravity:
            which = "vertical" if slope.level else "normal"
            found = f"the {which} ground acceleration falls to {lowest:.4g} m s^-2, beyond gravity"
            unless = "unless links press it on, " if links else ""
            yield f"{found}: {unless}{_SEPARATES}{system.setting.flight_advice}"
    if "left_reaction" not in values:
        return
    stands = ~(values["time"] > overturning_time)  # the fall after overturning does not count
    reaction = (values["left_reaction"] + values["right_reaction"])[stands]
    lowest = float(np.min(reaction))
    if lowest < -TENSION_TOLERANCE * float(np.max(np.abs(reaction))):
        when = float(values["time"][np.argmin(reaction)])
        found = (
            f"the ground would have to pull at the bearing corner, with {-lowest:.4g} N at "
            f"{when:.4g} s"
        )
        yield f"{found}: {_SEPARATES}{system.setting.flight_advice}"
