"""The plan of a run: its arguments, checked against the system and one another.

Also the requested outputs, and the start: at rest, from an initial state, or from the end of
another run.
"""

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final, Literal, TypeAlias, Unpack, cast

import numpy as np
import xarray as xr

from rockframe.arguments import is_iterable, json_attribute, read_attribute
from rockframe.components import InitialState
from rockframe.dynamics.protocol import Ending, Start
from rockframe.errors import AssemblyError, ComponentError, RockframeError, did_you_mean, short_repr
from rockframe.motion import GroundMotion
from rockframe.motion.pair import motion_hint
from rockframe.results.diagnostics import DIAGNOSTICS, Diagnostic
from rockframe.results.forces import SOIL_FRICTION_COLUMNS, has_friction_limit
from rockframe.results.outcome import verdict_of
from rockframe.results.points import BodyPoint
from rockframe.results.schema import ENERGIES, GROUPS, ON_REQUEST, SCHEMA, SCHEMA_VERSION
from rockframe.results.variables.requests import POINT_TIME
from rockframe.results.variables.variable import TIME as OVER_TIME
from rockframe.simulation.run_arguments import PROVED, Certification, RunArguments
from rockframe.solve.accuracy import Accuracy, AccuracyLevel, accuracy_of
from rockframe.solve.bookkeeping import SAMPLE_TOLERANCE
from rockframe.solve.integrate import STILL_INTERVAL
from rockframe.system.assembly import Assembly
from rockframe.system.options import Overturning, read_option
from rockframe.units import (
    LENGTH,
    POSITIVE,
    TIME,
    TIME_STEP,
    Measure,
    QuantityLike,
    quantity_text,
    to_si,
)

POINTS_EXAMPLE: Final = 'points={"roof": ("0 m", "18 m")}'


def outputs_as_list(outputs: object) -> list[object]:
    """Return the argument ``outputs`` as a list."""
    if outputs is None:
        return []
    if is_iterable(outputs) and not isinstance(outputs, str | Mapping):
        return list(outputs)
    return [outputs]


def read_outputs(
    outputs: object, points: object, faults: list[str]
) -> tuple[tuple[str, ...], tuple[Diagnostic, ...]]:
    """Read ``outputs``: give variables and diagnostics in the order of their tables."""
    names: set[str] = set()
    diagnostics: set[str] = set()
    for value in outputs_as_list(outputs):
        name = value if isinstance(value, str) else ""
        dims = SCHEMA[name].dims if name in SCHEMA else ()
        if dims == POINT_TIME:
            if not points:
                faults.append(f"{name!r} is of points, and there are none; give {POINTS_EXAMPLE}")
        elif name in GROUPS:
            names.update(GROUPS[name])
        elif name in DIAGNOSTICS:
            diagnostics.add(name)
        elif name in ON_REQUEST or dims == OVER_TIME:
            names.add(name)
        else:
            known = (*GROUPS, *ON_REQUEST, *DIAGNOSTICS)
            words = ", ".join(map(repr, known))
            found = (
                f"outputs has no {short_repr(value)}; every run has its response, and on request "
                f"{words}{did_you_mean(value, known)}"
            )
            if "time" in dims:
                found = (
                    f"outputs need not name {name!r}: a single run has it anyway, if its scene "
                    "has; a sweep keeps histories over time alone, and at points, and "
                    "rf.case(...).simulate() gives the others"
                )
            faults.append(found)
    requested = tuple(name for name in ON_REQUEST if name in names)
    return requested, tuple(
        diagnostic for name, diagnostic in DIAGNOSTICS.items() if name in diagnostics
    )


OUTPUT_REQUIREMENTS: Final = {
    "toe_pressure": (("toe_pressure",), "a WinklerSoil"),
    "soil_friction_demand": (SOIL_FRICTION_COLUMNS, "a CushionCap between block and WinklerSoil"),
}
"""Columns and parts that an output needs, for outputs that not all scenes have."""


def missing_output_faults(system: Assembly, names: Iterable[str]) -> list[str]:
    """Return a fault for each requested output that the scene does not have."""
    depend = [name for name in names if name in OUTPUT_REQUIREMENTS]
    if not depend:
        return []
    columns = {column.name for column in system.model.columns}
    of_stack = " and no Stack" if system.model.shows_bodies else ""
    return [
        f"there is no {name!r} in this scene; it needs {OUTPUT_REQUIREMENTS[name][1]}{of_stack}"
        for name in depend
        if not columns.issuperset(OUTPUT_REQUIREMENTS[name][0])
    ]


def read_body_points(
    value: object, faults: list[str], *, owner: str = "simulate"
) -> tuple[BodyPoint, ...]:
    """Read the argument ``points``: names and places on the body; add what is wrong to faults."""
    if value is None:
        return ()
    if not isinstance(value, Mapping):
        faults.append(f"points must name places, such as {POINTS_EXAMPLE}, got {short_repr(value)}")
        return ()
    points: list[BodyPoint] = []
    for name, place in value.items():
        if not (isinstance(name, str) and name.strip()):
            faults.append(f"points needs names, such as {POINTS_EXAMPLE}, got {short_repr(name)}")
        elif not (isinstance(place, tuple | list) and len(place) == 2):
            faults.append(
                f"point {name!r} needs two lengths, to the right of the middle of the base and "
                f"above it, such as {POINTS_EXAMPLE}, got {short_repr(place)}"
            )
        else:
            try:
                x, y = (
                    to_si(coordinate, LENGTH, owner=owner, name=f"points[{name!r}]")
                    for coordinate in place
                )
                points.append(BodyPoint(name, x, y))
            except RockframeError as problem:
                faults.append(str(problem))
    return tuple(points)


END_STATE: Final = "end_state"
"""The attribute that holds the end of a run, so that a later run can begin with it."""


InitialCondition: TypeAlias = InitialState | Ending
"""An initial state, or the end of another run of the same system."""


_INITIAL: Final = "initial"


def start_of(initial: InitialCondition) -> Start | Ending:
    """Return a beginning as the integrator takes it."""
    return initial if isinstance(initial, Ending) else Start(**vars(initial.si))


def read_continuation(dataset: xr.Dataset, system: Assembly, faults: list[str]) -> InitialCondition:
    """Read the end of a run from its dataset; add to faults if no run can continue from it."""
    attributes: Mapping[str, Any] = cast("Mapping[str, Any]", dataset.attrs)
    if END_STATE not in attributes or "system_json" not in attributes:
        faults.append("initial is a dataset that holds no end of a run; expected one of simulate()")
        return InitialState()
    if attributes.get("schema_version") != SCHEMA_VERSION:
        faults.append(
            f"initial is the end of a run of rockframe {attributes.get('rockframe_version')}, "
            "which kept states in another way; run it again"
        )
    ending = json_attribute(dataset, END_STATE, _read_ending, owner=_INITIAL)
    time = read_attribute(dataset, "overturning_time", float, owner=_INITIAL, default=math.nan)
    passed = not math.isnan(time)
    if json_attribute(dataset, "system_json", dict, owner=_INITIAL) != system.to_dict():
        faults.append("initial is the end of a run of another system")
    elif (ending.state.size, ending.memory.size) != (
        system.model.scales.size, len(system.model.memory),
    ):  # fmt: skip
        faults.append(f"initial has an attribute {END_STATE!r} that lacks numbers; it is damaged")
    elif passed and not _returned_within_limit(dataset, system, ending):
        faults.append("initial is the end of a run that overturned")
    elif cut := _cut_words(dataset):
        faults.append(cut)
    return ending if faults else _with_reset_peaks(ending, system)


def _read_ending(stored: Mapping[str, Any]) -> Ending:
    """Read what :func:`ending_as_json` returned."""
    return Ending(
        int(stored["mode"]),
        np.array(stored["state"], dtype=np.float64),
        np.array(stored["memory"], dtype=np.float64),
    )


def _cut_words(dataset: xr.Dataset) -> str:
    """Say that the last histories of a run were cut off; empty if they were not."""
    (name,) = OVER_TIME
    if name not in dataset.coords:
        known = [key for key in map(str, dataset.data_vars) if key in SCHEMA]
        histories = [key for key in known if SCHEMA[key].dims == OVER_TIME]
        lost = any(name not in dataset[key].dims for key in histories)
        words = "initial is a part of a run, whose time has been dropped: give all of it"
        return words if lost else ""
    if dataset[name].attrs.get("units") != "s":
        return ""
    times = np.atleast_1d(dataset[name])[-2:].tolist()
    spacings = json_attribute(dataset, "run_json", _spacings, owner=_INITIAL, default="{}")
    spacings += np.diff(times).tolist()  # longer in histories of which every nth time is kept
    end = read_attribute(dataset, "solver_end_time", float, owner=_INITIAL)
    last = max(times, default=0.0)
    # the end may be between two output times
    if not spacings or end - last < (1.0 - SAMPLE_TOLERANCE) * max(spacings):
        return ""
    shorter = f", or simulate one with duration='{last:.10g} s'" if last > 0.0 else ""
    return (
        f"initial is a part of a run, up to {last:.10g} s; a run is continued from its end, at "
        f"{end:.10g} s: give all of it{shorter}"
    )


def _spacings(arguments: Mapping[str, Any]) -> list[float]:
    """Return the output step of a run, if it was given [s]."""
    step = _read_time("output_step", arguments.get("output_step"), TIME_STEP)
    return [] if step is None else [step]


def _with_reset_peaks(ending: Ending, system: Assembly) -> Ending:
    """Reset the peak slips in the memory, but not the slip itself."""
    if not system.setting.slides:
        return ending
    memory = ending.memory.copy()
    peaks = [k for k, name in enumerate(system.model.memory) if name.startswith("peak_slip_")]
    memory[peaks] = 0.0
    start = replace(ending, memory=memory)
    slips = system.setting.slips_of(start)  # of the highest bodies, as far as they can slip
    sides = [side for slip in slips for side in (slip.left, slip.right)]
    memory[peaks[: len(sides)]] = sides
    return start


def _returned_within_limit(dataset: xr.Dataset, system: Assembly, ending: Ending) -> bool:
    """Whether a run passed the overturning angle but ended within it without overturning."""
    rotation = system.model.rotation_in(ending.state)
    within = abs(rotation) < system.setting.overturning_angles.on_side_of(rotation)
    return within and "status" in dataset and verdict_of(dataset) is False


def ending_as_json(ending: Ending) -> dict[str, Any]:
    """Return the end of a run as plain values."""
    return {"mode": ending.mode, "state": ending.state.tolist(), "memory": ending.memory.tolist()}


MAX_SAMPLES = 1e8
"""Largest number of samples of the histories of a run: some ten gigabytes."""
_STILL_GROUND_OUTPUT_STEP: Final = 0.005
"""Spacing of the histories of a run without a ground motion [s]."""
_REST: Final = InitialState()


@dataclass(frozen=True, kw_only=True)
class _Requested:
    """The arguments of a run other than its length and its start; numbers in SI units."""

    accuracy: Accuracy
    accuracy_name: str
    output_step: float | None
    histories: bool
    requested: tuple[str, ...]
    diagnostics: tuple[Diagnostic, ...]
    points: tuple[BodyPoint, ...]
    stop_at_overturning: bool

    def _shared_dict(self) -> dict[str, Any]:
        """Return these arguments as :meth:`rockframe.System.simulate` takes them, fit for JSON."""
        return {
            "accuracy": vars(self.accuracy),
            "output_step": _time_text(self.output_step),
            "outputs": [*self.requested, *(diagnostic.name for diagnostic in self.diagnostics)]
            if self.histories
            else None,
            "points": {
                point.name: [quantity_text(coordinate, LENGTH) for coordinate in (point.x, point.y)]
                for point in self.points
            },
            "overturning": str(
                Overturning.STOP if self.stop_at_overturning else Overturning.CONTINUE
            ),
        }


@dataclass(frozen=True, kw_only=True)
class RunRequest(_Requested):
    """The arguments of a run before they meet a system and a motion; numbers in SI units."""

    duration: float | None
    free_vibration: float | None
    initial: "InitialState | xr.Dataset"

    def to_dict(self) -> dict[str, Any]:
        """Return all arguments as :meth:`rockframe.System.simulate` takes them, fit for JSON."""
        return {
            "duration": _time_text(self.duration),
            "free_vibration": _time_text(self.free_vibration),
            "initial": None if isinstance(self.initial, xr.Dataset) else self.initial.to_dict(),
            **self._shared_dict(),
        }


@dataclass(frozen=True, kw_only=True)
class Plan(_Requested):
    """A run's arguments, checked and in SI units.

    The run has samples if `output_step` is not None: they are needed for histories, for peaks at
    points, and to check the friction that a base was given.
    """

    motion: GroundMotion | None
    duration: float
    initial: InitialCondition

    @property
    def energies(self) -> tuple[str, ...]:
        """Names of the energies among the requested outputs."""
        return tuple(name for name in self.requested if name in ENERGIES)

    @property
    def interval(self) -> float:
        """Time between samples of the motion, or the interval used for still ground [s]."""
        return STILL_INTERVAL if self.motion is None else self.motion.si.time_step

    @property
    def has_vertical_motion(self) -> bool:
        """Whether the motion has a vertical component."""
        return self.motion is not None and self.motion.si.vertical is not None

    def without_outputs(self) -> "Plan":
        """Return the same run without samples."""
        return replace(self, output_step=None, requested=(), diagnostics=(), points=())

    def to_json(self) -> str:
        """Return the plan as JSON, without the motion."""
        initial = (
            {"type": "Continuation", "ending": ending_as_json(self.initial)}
            if isinstance(self.initial, Ending)
            else self.initial.to_dict()
        )
        own = {"duration": _time_text(self.duration), "initial": initial}
        return json.dumps({**own, **self._shared_dict()})


def _time_text(value: float | None) -> str | None:
    return None if value is None else quantity_text(value, TIME)


def plan_run(
    system: Assembly, motion: GroundMotion | None, **requested: Unpack[RunArguments]
) -> Plan:
    """Check the arguments of a run against the system and one another."""
    faults: list[str] = []
    motion = system.parts.motion if motion is None else motion
    if not isinstance(motion, GroundMotion | None):  # pyright: ignore[reportUnnecessaryIsInstance]
        fault = f"motion must be a GroundMotion, got {short_repr(motion)}{motion_hint(motion)}"
        raise AssemblyError([fault])
    arguments = read_arguments(faults, **requested)
    plan = resolve_plan(arguments, system, motion, faults)
    if faults:
        raise AssemblyError(faults)
    return plan


def read_arguments(faults: list[str], **options: Unpack[RunArguments]) -> RunRequest:
    """Read those arguments of a run that need neither system nor motion."""
    duration = _read_time("duration", options.get("duration"))
    free_vibration = _read_time("free_vibration", options.get("free_vibration"))
    if duration is not None and free_vibration is not None:
        faults.append("give duration or free_vibration, not both: each fixes the run's length")
    output_step = _read_time("output_step", options.get("output_step"), TIME_STEP)
    outputs, points = options.get("outputs", ()), options.get("points")
    accuracy = options.get("accuracy", AccuracyLevel.STANDARD)
    value = options.get("overturning", Overturning.STOP)
    overturning = read_option(Overturning, value, "overturning", faults)
    initial = _read_initial(options.get("initial"), faults)
    requested, diagnostics = read_outputs(outputs, points, faults)
    return RunRequest(
        duration=duration,
        free_vibration=free_vibration,
        initial=initial,
        accuracy=accuracy_of(accuracy),
        accuracy_name=str(accuracy) if isinstance(accuracy, str) else "own",
        output_step=output_step,
        histories=outputs is not None,
        requested=requested,
        diagnostics=diagnostics,
        points=read_body_points(points, faults),
        stop_at_overturning=overturning is Overturning.STOP,
    )


def resolve_plan(
    arguments: RunRequest, system: Assembly, motion: GroundMotion | None, faults: list[str]
) -> Plan:
    """Combine the arguments of a run with its system and its motion."""
    initial = _initial_condition(system, arguments.initial, faults)
    length = run_length(arguments, motion)
    if not length:
        faults.append("nothing to simulate: give a motion, or a duration for a still ground")
    step = None
    if arguments.histories or arguments.points or has_friction_limit(system):
        step = arguments.output_step
        if step is None:
            step = default_output_step(motion)
        if length / step > MAX_SAMPLES:
            faults.append(
                f"the histories would have {length / step:.3g} samples ({length:.6g} s in steps of "
                f"{step:.6g} s); give a longer output_step, or outputs=None without points and "
                "friction"
            )
    faults += missing_output_faults(system, arguments.requested)
    options = {name: getattr(arguments, name) for name in _Requested.__annotations__}
    options["output_step"] = step
    return Plan(motion=motion, duration=length, initial=initial, **options)


def _read_time(name: str, value: QuantityLike | None, measure: Measure = TIME) -> float | None:
    if value is None:
        return None
    return to_si(value, measure, owner="simulate", name=name, condition=POSITIVE)


def _read_initial(value: object, faults: list[str]) -> "InitialState | xr.Dataset":
    if value is None or isinstance(value, InitialState | xr.Dataset):
        return _REST if value is None else value
    hint = ""
    if isinstance(value, str | tuple):
        hint = f"; write InitialState(rotation={value!r}), if that is its rotation"
    faults.append(
        f"initial must be an InitialState or the result of a run, got {short_repr(value)}{hint}"
    )
    return _REST


def _initial_condition(
    system: Assembly, value: "InitialState | xr.Dataset", faults: list[str]
) -> InitialCondition:
    """Return the start of the run; add to faults what does not fit the system."""
    if isinstance(value, xr.Dataset):
        return read_continuation(value, system, faults)
    start = value.si
    vertical_start = start.vertical_displacement is not None or start.vertical_velocity != 0.0
    rotation = system.setting.rest_rotation if start.rotation is None else start.rotation
    faults += system.setting.start_faults(rotation, vertical_start)
    faults += system.setting.faults_of_velocity(rotation, start.angular_velocity)
    theta = system.setting.overturning_angles.on_side_of(rotation)
    if abs(rotation) >= theta:
        faults.append(
            f"initial rotation {rotation:.6g} rad is not below the overturning angle "
            f"{theta:.6g} rad"
        )
    return value


def default_output_step(motion: GroundMotion | None) -> float:
    """Return the default spacing of histories [s]."""
    return _STILL_GROUND_OUTPUT_STEP if motion is None else motion.si.time_step


def run_length(arguments: RunRequest, motion: GroundMotion | None) -> float:
    """Return the length of a run under a motion; 0 without a motion and a duration [s]."""
    if arguments.duration is not None:
        return arguments.duration
    return (0.0 if motion is None else motion.si.duration) + (arguments.free_vibration or 0.0)


def read_certification(value: object) -> Certification | Literal["proved"] | None:
    """Read the argument ``certify`` of a run."""
    if value is False:
        return None
    if isinstance(value, str) and value == PROVED:
        return PROVED
    if value is True:
        return Certification()
    if isinstance(value, Certification):
        return value
    wanted = f"True, False, {PROVED!r} or a Certification(...)"
    msg = f"simulate: certify must be {wanted}, got {short_repr(value)}"
    raise ComponentError(msg)
