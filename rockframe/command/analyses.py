"""``rockframe study``, ``critical``, ``ida``, ``fragility`` and ``map``: many runs of a scene."""

import argparse
import re
import shlex
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe import plot
from rockframe.command.answer import Answer
from rockframe.command.figures import PICTURE_KIND, save_figure
from rockframe.command.files.scenes import AXES, CASES, SceneDescription, read_scene
from rockframe.command.files.studies import KNOWN, StudyDescription, read_study
from rockframe.command.files.tables import arguments_of
from rockframe.command.main import INTERRUPTED
from rockframe.command.runs import is_finished
from rockframe.command.shared import (
    STUDY_KIND,
    Outputs,
    amount_text,
    analysis_kind,
    arguments_accepted_by,
    intensity_text,
    is_result,
    parse_numbers,
    part_names,
    read_result,
    refuse_reading_options,
    run_analysis,
    run_from,
    scene_from,
    store_from,
    suite_from,
    table_kind,
    typed_options,
    with_project,
)
from rockframe.command.streams import print_message
from rockframe.command.typed_calls import parse_value
from rockframe.errors import ComponentError, FileError, StudyError
from rockframe.motion import GroundMotion
from rockframe.motion.description import CONSTRUCTORS
from rockframe.motion.display import motion_words
from rockframe.plot._checks import figure_function_name
from rockframe.reports.project import PROJECT_ATTRIBUTE
from rockframe.results.schema import SCHEMA
from rockframe.results.table import table
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.results.variables.runs import RunStatus
from rockframe.results.variables.variable import flag_words
from rockframe.shared_arguments import suggestion
from rockframe.studies import (
    critical_scale,
    fragility,
    incremental_dynamic_analysis,
    open_study,
    overturning_map,
    sweep,
)
from rockframe.studies.limit_states import overturns
from rockframe.studies.sweeps.case import NOT_GIVEN

_STUDY_COLUMNS: Final = ("status", "peak_relative_rotation", "overturned")
"""Variables of each case in the printed table."""
_STUDY_TABLE_KIND: Final = table_kind(
    "the table of a study", "status", "overturned", "peak_rotation"
)


def execute_study(arguments: argparse.Namespace, answer: Answer) -> int:
    """Run a study, or the rest of an interrupted one."""
    study = read_study(arguments.study)
    if arguments.output is None and study.output is not None:
        arguments.output = str(study.output)
    outputs = Outputs(arguments, study.files, answer, output=STUDY_KIND, csv=_STUDY_TABLE_KIND)
    store = store_from(arguments) or study.store
    answer.add_context("Scene", part_names(study.system))
    try:
        given = {"store": store, **study.arguments}
        runs = run_analysis(sweep, study, study.motions, given, arguments)
        answer.add_result("Verdict", runs.attrs["verdict"])
        answer.add_numbers(runs)
        values = table(runs)
        answer.add_table(
            values[[head for head in values if str(head).split(" [")[0] in _STUDY_COLUMNS]]
        )
        outputs.write_table(values)
        outputs.write_result(runs)
    except StudyError as problem:
        raise study.at_lines(problem) from problem
    except KeyboardInterrupt:
        _print_how_to_continue(store, arguments.typed)
        raise
    if (runs["status"] == RunStatus.NOT_RUN).any():
        _print_how_to_continue(store, arguments.typed)
        return INTERRUPTED
    return 0 if is_finished(runs) else 1


def _print_how_to_continue(store: Path | None, typed: list[str]) -> None:
    """Print the command that continues an interrupted study."""
    words = ["rockframe", *typed]
    text = "this command continues it"
    if store is None:
        words += ["--store", "study"]
        text = "without a store all has to be run again; with a store it could continue"
    print_message("rockframe study", f"interrupted; {text}: {shlex.join(words)}")


_CRITICAL_KIND: Final = analysis_kind(
    "the result of a critical scale", "critical_scale", "scale_above"
)
_DEFAULT_INTENSITY: Final = "PGA"
_MAX_FIRST_SCALES: Final = 80
"""Largest number of scales that are tried first."""


def execute_critical(arguments: argparse.Namespace, answer: Answer) -> int:
    """Find the least scale that overturns, and report the intensity at this scale."""
    scene = scene_from(arguments, needs_motion=True)
    outputs = Outputs(arguments, scene.files, answer, output=_CRITICAL_KIND, picture=PICTURE_KIND)
    values: dict[str, Any] = {
        "intensity": _DEFAULT_INTENSITY,
        **typed_options(arguments, "largest", "runs", "intensity", "period"),
        **arguments_accepted_by(critical_scale, scene.run),
    }
    if arguments.runs is not None:
        values["scales"] = max(2, min(arguments.runs, _MAX_FIRST_SCALES))
    dataset = run_analysis(critical_scale, scene, scene.motion, values, arguments)
    answer.add_context("Scene", f"{part_names(scene.system)} ({dataset.attrs['model']})")
    answer.add_context("Motion", motion_words(dataset.attrs))
    answer.add_result("Verdict", dataset.attrs["verdict"])
    measure = dataset[dataset.attrs["intensity"]]
    if bool(measure.notnull()):
        answer.add_result("Shaking", f"{intensity_text(measure, dataset)} at the critical scale")
    return _finish_analysis(dataset, arguments, answer, outputs)


SCALE: Final = "scale"
_NO_MOTIONS: Final = (
    "there are no motions; name records, archives or folders after the scene, or describe motions "
    "in the file"
)
_NUMBER_START: Final = re.compile(r"[-+]?\.?\d")


def _scene_and_motions(arguments: argparse.Namespace) -> StudyDescription:
    """Read a scene or a study; motions, scales and runs that were typed replace those in it."""
    study = read_study(arguments.scene, needs_axes=False)
    if not arguments.records:
        refuse_reading_options(arguments, "name records after the scene")
    else:
        suite = suite_from(arguments.records, arguments)
        files = (*study.files, *map(Path, arguments.records))
        study = replace(study, motions=dict(suite.items()), files=files)
    if study.motions is None:
        raise FileError(arguments.scene, _NO_MOTIONS)
    values = run_from(study.arguments, arguments)
    if arguments.scales is not None:
        scales, _ = parse_numbers(arguments.scales, "--scales", "0.25:4:0.25")
        values[AXES] = {**values.get(AXES, {}), SCALE: scales}
    return replace(study, arguments=values, store=store_from(arguments) or study.store)


def _typed_intensity(arguments: argparse.Namespace, function: Callable[..., Any]) -> dict[str, Any]:
    """Return the intensity and the limit states that were typed."""
    options = typed_options(arguments, "intensity", "period")
    if arguments.limits is not None:
        options["limits"] = [
            _read_limit_state(word.strip()) for word in arguments.limits.split(",")
        ]
    return arguments_accepted_by(function, options)


def _read_limit_state(word: str) -> object:
    """Read a limit state: a rotation, a name, or a variable and its limit."""
    if _NUMBER_START.match(word):
        try:
            return float(word)
        except ValueError:
            msg = f"--limits: expected a number, a name or NAME=VALUE, got {word!r}"
            raise ComponentError(msg) from None
    name, equals, value = word.partition("=")
    if equals:
        return name.strip(), parse_value(value.strip())
    if name in SCHEMA:
        msg = f"--limits: {name} needs a limit, as in 'peak_slip=5 cm'"
        raise ComponentError(msg)
    return word


_IDA_KIND: Final = analysis_kind("the result of a dynamic analysis", "capacity_scale", "flip_count")
_CAPACITY_TABLE_KIND: Final = table_kind(
    "a table of capacities", "limit_state", "motion", "capacity_scale"
)
_CAPACITY_COLUMNS: Final = ("capacity_scale", "flip_count")
"""Variables that are printed for each record."""


def execute_ida(arguments: argparse.Namespace, answer: Answer) -> int:
    """Scale motions until they overturn, and report the capacity under each."""
    study = _scene_and_motions(arguments)
    kinds = {"output": _IDA_KIND, "picture": PICTURE_KIND, "csv": _CAPACITY_TABLE_KIND}
    outputs = Outputs(arguments, study.files, answer, **kinds)
    axes = {**study.arguments.get(AXES, {})}
    if CASES in study.arguments:
        words = "a dynamic analysis has axes, and no table of cases"
        raise FileError(arguments.scene, f"{words}; 'fragility' fits each structure")
    if KNOWN in study.arguments:
        raise FileError(arguments.scene, f"a dynamic analysis takes no {KNOWN!r} stores")
    values: dict[str, Any] = {
        "intensity": _DEFAULT_INTENSITY,
        "store": study.store,
        **arguments_accepted_by(incremental_dynamic_analysis, study.arguments),
        **({SCALE: axes.pop(SCALE)} if SCALE in axes else {}),
        AXES: axes,
        **_typed_intensity(arguments, incremental_dynamic_analysis),
    }
    dataset = run_analysis(incremental_dynamic_analysis, study, study.motions, values, arguments)
    answer.add_result("Verdict", dataset.attrs["verdict"])
    answer.add_context("Scene", part_names(study.system))
    fitted = fragility(dataset, dataset.attrs["intensity"], trials="capacities",
                       **typed_options(arguments, "period"))  # fmt: skip
    answer.add_result("Fit", fitted.attrs["verdict"])
    capacities = table(dataset[list(_CAPACITY_COLUMNS)].drop_vars("rotation_limit"))
    answer.add_table(capacities)
    outputs.write_table(capacities)
    return _finish_analysis(dataset, arguments, answer, outputs)


_FRAGILITY_KIND: Final = analysis_kind("a fragility", "exceedance_probability", "fragility_status")
_MOTION_MISSING: Final = (
    "is not in this result; name the records after it, or the store of the study, which keeps "
    "them, instead of the result"
)
_DEFAULT_SCALES: Final = [0.25 * k for k in range(1, 17)]
"""Scales of the motions, if neither the file nor the command line has any."""


def execute_fragility(arguments: argparse.Namespace, answer: Answer) -> int:
    """Run a scene under many motions, or read finished runs, and fit fragilities."""
    known = is_result(arguments.scene)
    study = None if known else _scene_and_motions(arguments)
    read = [arguments.scene, *arguments.records] if study is None else study.files
    outputs = Outputs(arguments, read, answer, output=_FRAGILITY_KIND, picture=PICTURE_KIND)
    fitted, motions = _typed_intensity(arguments, fragility), None
    if study is None:
        runs = _runs_of_study(arguments)
        motions = suite_from(arguments.records, arguments) if arguments.records else None
    else:
        values: dict[str, Any] = {"store": study.store, **study.arguments}
        if AXES not in values and CASES not in values:
            values[AXES] = {SCALE: _DEFAULT_SCALES}
        try:
            runs = run_analysis(sweep, study, study.motions, values, arguments)
        except StudyError as problem:
            raise study.at_lines(problem) from problem
    try:
        dataset = fragility(runs, motions=motions, **fitted)
    except StudyError as problem:
        if not known or NOT_GIVEN not in str(problem):
            raise
        words = str(problem).removeprefix("fragility: ").replace(NOT_GIVEN, _MOTION_MISSING)
        raise FileError(arguments.scene, words) from problem
    dataset = with_project(dataset, str(runs.attrs.get(PROJECT_ATTRIBUTE, "")))
    answer.add_result("Verdict", dataset.attrs["verdict"])
    if "median_intensity" in dataset and dataset["median_intensity"].dims == ("limit_state",):
        for state, row in dataset.groupby("limit_state", squeeze=False):
            answer.add_text(_limit_state_line(str(state), row.squeeze("limit_state")))
    if study is not None:
        answer.add_context("Scene", part_names(study.system))
    answer.add_context("Runs", str(runs.attrs["verdict"]))
    return _finish_analysis(dataset, arguments, answer, outputs, runs)


def _runs_of_study(arguments: argparse.Namespace) -> xr.Dataset:
    """Read the runs of a study, from its file or its store."""
    more = ["scales", "store", "accuracy", "free_vibration", "duration"]
    if not arguments.records:  # these say how records are read
        more += ["unit", "time_step"]
    if any(getattr(arguments, name) for name in more):
        words = "its runs are finished; scales, a store, an accuracy or durations go with a scene"
        raise FileError(arguments.scene, f"this is a result: {words}")
    if Path(arguments.scene).expanduser().is_dir():
        return open_study(arguments.scene)
    return read_result(arguments.scene)


def _limit_state_line(state: str, row: xr.Dataset) -> str:
    """Write the median and dispersion of a limit state."""
    median, status = row["median_intensity"], row["fragility_status"]
    words = flag_words(status.attrs)[int(status)].replace("_", " ")
    if bool(median.isnull()):
        return f"  {state}: no fit, {words}"
    amount = amount_text(float(median), median.attrs)
    if int(status) != FragilityStatus.FITTED:
        return f"  {state}: median about {amount}, {words}"
    return f"  {state}: median {amount}, dispersion {float(row['dispersion']):.3g}"


_MAP_KIND: Final = analysis_kind("a map of overturning", "impacts_before_overturning")
_DEFAULT_PULSE: Final = "sine_pulse"
_MAP_AXES: Final = ("amplitude", "frequency")
_CONSTRUCTOR_KEYS: Final = ("type", "constructor")


def execute_map(arguments: argparse.Namespace, answer: Answer) -> int:
    """Run pulses of all amplitudes and frequencies, and report which of them overturn."""
    scene = read_scene(arguments.scene)
    outputs = Outputs(arguments, scene.files, answer, output=_MAP_KIND, picture=PICTURE_KIND)
    values: dict[str, Any] = {
        "store": store_from(arguments),
        **arguments_accepted_by(overturning_map, run_from(scene.run, arguments)),
        "amplitude": parse_numbers(arguments.amplitude, "--amplitude", "1:10:0.5 m/s^2"),
        "frequency": parse_numbers(arguments.frequency, "--frequency", "0.5:4:0.25 Hz"),
    }
    pulse, words = _pulse(scene, arguments.pulse)
    dataset = run_analysis(overturning_map, scene, pulse, values, arguments)
    answer.add_result("Verdict", dataset.attrs["verdict"])
    answer.add_context("Scene", f"{part_names(scene.system)} ({dataset.attrs['model']})")
    answer.add_context("Pulse", words)
    answer.add_text("\n".join(_boundary_lines(dataset)))
    return _finish_analysis(dataset, arguments, answer, outputs)


def _pulse(scene: SceneDescription, name: str | None) -> tuple[Any, str]:
    """Return the pulse that was typed, else that of the scene, and its name."""
    known = [constructor for constructor in CONSTRUCTORS if _has_axes(constructor)]
    if name is not None and name not in known:
        listed = f"{suggestion(name, known)} There are {', '.join(known)}"
        msg = f"--pulse: {name!r} is no pulse of an amplitude and a frequency alone{listed}"
        raise ComponentError(msg)
    motion = scene.motion
    if name is None and motion is not None and motion.si.horizontal.polynomials is not None:
        described = motion.to_dict()
        words = [str(described["constructor"]).replace("_", " ")]
        words += [
            f"{key}: {value:g}" if isinstance(value, int | float) else f"{key}: {value}"
            for key, value in described.items()
            if key not in (*_MAP_AXES, "period", *_CONSTRUCTOR_KEYS)
        ]
        return motion, ", ".join(words)
    name = name or _DEFAULT_PULSE
    return getattr(GroundMotion, name), name.replace("_", " ")


def _has_axes(name: str) -> bool:
    """Whether a constructor needs only an amplitude and a frequency."""
    taken = arguments_of(getattr(GroundMotion, name))
    needed = {argument for argument, is_needed in taken.items() if is_needed}
    return needed <= set(_MAP_AXES) <= set(taken)


def _boundary_lines(dataset: xr.Dataset) -> list[str]:
    """Write the boundaries of overturning for each frequency."""
    unit = dataset["amplitude"].attrs["units"]
    lines = [f"  frequency [Hz]   boundaries of overturning [{unit}]"]
    for number, frequency in enumerate(dataset["frequency"].to_numpy()):
        part = dataset.isel(frequency=number)
        ends = zip(part["amplitude_above"].values, part["impacts_above"].values, strict=True)
        text = [f"{at:.4g} {_boundary_label(impacts)}" for at, impacts in ends if at == at]
        overturned = overturns(part).to_numpy()
        missing = int(np.isnan(overturned).sum())
        verdict = "overturns" if (overturned == 1.0).any() else "stands"
        text = text or [f"none: {verdict} throughout" if missing < overturned.size else "none"]
        text += [f"{missing} of {overturned.size} without a verdict"] if missing else []
        lines.append(f"  {frequency:<16.4g} {', '.join(text)}")
    return lines


def _boundary_label(impacts: float) -> str:
    if impacts != impacts:
        return "stands"
    return f"overturns after {impacts:.0f} impact{'' if impacts == 1 else 's'}"


def _finish_analysis(
    dataset: xr.Dataset,
    arguments: argparse.Namespace,
    answer: Answer,
    outputs: Outputs,
    runs: xr.Dataset | None = None,  # that were analysed, unless the dataset has their status
) -> int:
    """Report the numbers of an analysis, write its result and picture, and return the exit code."""
    answer.add_numbers(dataset)
    outputs.write_result(dataset)
    if arguments.picture is not None:
        draw = getattr(plot, figure_function_name(dataset))
        save_figure(draw(dataset), arguments.picture, outputs)
    return 0 if is_finished(dataset if runs is None else runs) else 1
