"""The arguments of a run, checked against the system and one another."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import xarray as xr

from rockframe.components import InitialState
from rockframe.errors import AssemblyError, shown
from rockframe.motion import GroundMotion
from rockframe.results.points import Point
from rockframe.results.schema import ENERGIES
from rockframe.simulation.asked import lacking, names_of, points_of
from rockframe.simulation.beginning import Beginning, continuation_of
from rockframe.solve.accuracy import Accuracy, accuracy_of
from rockframe.system.assembly import Assembly
from rockframe.system.options import AccuracyLike, Overturning, OverturningLike, read_option
from rockframe.units import LENGTH, POSITIVE, TIME, TIME_STEP, QuantityLike, to_si

MOST_SAMPLES = 1e8
"""Samples of the histories beyond which a run is refused: some ten gigabytes."""
STILL_GROUND_OUTPUT_STEP = 0.005
"""Spacing of the histories of a run without a ground motion [s]."""


@dataclass(frozen=True)
class Plan:
    """A run's arguments, checked and in SI units."""

    motion: GroundMotion | None
    duration: float
    initial: Beginning
    accuracy: Accuracy
    accuracy_name: str
    output_step: float | None
    requested: tuple[str, ...]
    points: tuple[Point, ...]
    stop_at_overturning: bool

    @property
    def energies(self) -> tuple[str, ...]:
        """Energies among what is requested."""
        return tuple(name for name in self.requested if name in ENERGIES)

    def to_json(self) -> str:
        """Give the plan as JSON, without the motion."""
        return json.dumps(
            {
                "duration": f"{self.duration!r} {TIME.unit}",
                "initial": self.initial.to_dict(),
                "accuracy": vars(self.accuracy),
                "output_step": self.output_step and f"{self.output_step!r} {TIME.unit}",
                "outputs": list(self.requested),
                "points": {
                    point.name: [f"{each!r} {LENGTH.unit}" for each in (point.x, point.y)]
                    for point in self.points
                },
                "overturning": "stop" if self.stop_at_overturning else "continue",
            }
        )


def plan_run(
    system: Assembly,
    motion: GroundMotion | None,
    *,
    duration: QuantityLike | None,
    free_vibration: QuantityLike | None,
    initial: "InitialState | xr.Dataset | None",
    accuracy: AccuracyLike,
    output_step: QuantityLike | None,
    outputs: Sequence[str] | None,
    points: Mapping[str, tuple[QuantityLike, QuantityLike]] | None = None,
    overturning: OverturningLike,
) -> Plan:
    """Check the arguments of a run against the system and one another.

    Returns
    -------
    Plan

    Raises
    ------
    AssemblyError
        With every fault found.
    """
    faults: list[str] = []
    motion = system.parts.motion if motion is None else motion
    _check_kind(motion, GroundMotion, "motion", faults)
    if faults:
        raise AssemblyError(faults)
    beginning = _beginning(system, initial, faults)
    length = _length(motion, duration, free_vibration, faults)
    step = motion.si.time_step if motion is not None else STILL_GROUND_OUTPUT_STEP
    if output_step is not None:
        step = to_si(
            output_step, TIME_STEP, owner="simulate", name="output_step", condition=POSITIVE
        )
    if outputs is None:
        step = None
    if step is not None and length / step > MOST_SAMPLES:
        faults.append(
            f"the histories would have {length / step:.3g} samples ({length:.6g} s in steps of "
            f"{step:.6g} s); give a longer output_step, or outputs=None"
        )
    course = read_option(Overturning, overturning, "overturning", faults)
    requested, named = names_of(outputs, faults), points_of(points, faults)
    faults += lacking(system, requested)
    if faults:
        raise AssemblyError(faults)
    settings = accuracy_of(accuracy)
    return Plan(
        motion=motion,
        duration=length,
        initial=beginning,
        accuracy=settings,
        accuracy_name=str(accuracy) if isinstance(accuracy, str) else "own",
        output_step=step,
        requested=requested,
        points=named,
        stop_at_overturning=course is Overturning.STOP,
    )


def _beginning(system: Assembly, given: object, faults: list[str]) -> Beginning:
    """Read the argument ``initial``; note what does not fit the system."""
    if isinstance(given, xr.Dataset):
        return continuation_of(given, system, faults)
    if given is None:
        return InitialState()
    if not isinstance(given, InitialState):
        faults.append(f"initial must be an InitialState or the result of a run, got {shown(given)}")
        return InitialState()
    start = given.si
    vertical_start = start.vertical_displacement is not None or start.vertical_velocity != 0.0
    rotation = system.setting.rest_rotation if start.rotation is None else start.rotation
    faults += system.setting.start_faults(rotation, vertical_start)
    theta = system.setting.overturning_angles.on_side_of(rotation)
    if abs(rotation) >= theta:
        faults.append(
            f"initial rotation {rotation:.6g} rad is not below the overturning angle "
            f"{theta:.6g} rad"
        )
    return given


def _check_kind(value: object, kind: type, name: str, faults: list[str]) -> None:
    if value is not None and not isinstance(value, kind):
        faults.append(f"{name} must be a {kind.__name__}, got {shown(value)}")


def _length(
    motion: GroundMotion | None,
    duration: QuantityLike | None,
    free_vibration: QuantityLike | None,
    faults: list[str],
) -> float:
    if duration is not None and free_vibration is not None:
        faults.append("give duration or free_vibration, not both: each fixes the run's length")
    length = 0.0 if motion is None else motion.si.duration
    if duration is not None:
        return to_si(duration, TIME, owner="simulate", name="duration", condition=POSITIVE)
    if free_vibration is not None:
        return length + to_si(
            free_vibration, TIME, owner="simulate", name="free_vibration", condition=POSITIVE
        )
    if motion is None:
        faults.append("nothing to simulate: give a motion, or a duration for a still ground")
    return length
