"""``rockframe run``, ``certify``, ``describe`` and ``template``: one scene."""

import argparse
from dataclasses import replace
from textwrap import fill
from typing import Final

import numpy as np
import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.files.parts import toml_tables
from rockframe.command.files.scenes import read_scene
from rockframe.command.files.templates import TEMPLATES, all_keys_template
from rockframe.command.shared import (
    RUN_KIND,
    Outputs,
    motion_summary,
    part_names,
    scene_from,
    simulate_scene,
    typed_options,
)
from rockframe.errors import ComponentError
from rockframe.motion.display import display_name, motion_words
from rockframe.results.variables.runs import RunStatus
from rockframe.simulation.run_arguments import PROVED, Certification
from rockframe.system.setting import describe

_FINISHED_STATUSES: Final = (RunStatus.COMPLETED, RunStatus.OVERTURNED, RunStatus.TOPPLED)


def execute_run(arguments: argparse.Namespace, answer: Answer) -> int:
    """Simulate, and report the verdict."""
    scene = scene_from(arguments)
    outputs = Outputs(arguments, scene.files, answer, output=RUN_KIND)
    response = simulate_scene(scene)
    answer.add_context("Scene", f"{part_names(scene.system)} ({response.attrs['model']})")
    answer.add_context("Motion", motion_words(response.attrs))
    answer.add_result("Verdict", response.attrs["verdict"])
    for name in ("certificate", "proof"):
        if name in response.attrs:
            answer.add_result(name.capitalize(), response.attrs[name])
    return _finish_run(response, answer, outputs)


def _finish_run(response: xr.Dataset, answer: Answer, outputs: Outputs) -> int:
    """Report the numbers of a run, write its result, and return the exit code."""
    answer.add_numbers(response)
    outputs.write_result(response)
    return 0 if is_finished(response) else 1


def is_finished(response: xr.Dataset) -> bool:
    """Whether a run, or each run of a study, was finished."""
    return bool(np.isin(response["status"], _FINISHED_STATUSES).all())


def execute_certify(arguments: argparse.Namespace, answer: Answer) -> int:
    """Simulate with all runs of the certificate, and report their outcome."""
    scene = scene_from(arguments)
    outputs = Outputs(arguments, scene.files, answer, output=RUN_KIND)
    certification = _certification_of(scene.run.get("certify"), arguments)
    response = simulate_scene(scene, certify=certification)
    answer.add_result("Verdict", response.attrs["verdict"])
    kind = "proof" if certification == PROVED else "certificate"
    sentence = response.attrs[kind]
    answer.add_text(fill(f"{kind.capitalize()}: {sentence}", 100), **{kind: sentence})
    if certification != PROVED:
        checks = {
            "verdict_converged": "at higher accuracy",
            "verdict_robust": "with slightly changed parameters",
        }
        for name, words in checks.items():
            answer.add_text(f"  same verdict {words}: {'yes' if bool(response[name]) else 'no'}")
        count = int(response.attrs["certificate_runs"])
        answer.add_text(f"  further runs: {count}", certificate_runs=count)
    return _finish_run(response, answer, outputs)


def _certification_of(of_file: object, arguments: argparse.Namespace) -> Certification | str:
    """Return the settings of the certificate; options replace those of the file."""
    typed = typed_options(arguments, "nudge", "reach", "runs")
    if arguments.proved and typed:
        name, value = next(iter(typed.items()))
        msg = f"--{name} {value:g} is for a certificate by further runs, which --proved replaces"
        raise ComponentError(msg)
    if arguments.proved or (of_file == PROVED and not typed):
        return PROVED
    return replace(of_file if isinstance(of_file, Certification) else Certification(), **typed)


def execute_template(arguments: argparse.Namespace, answer: Answer) -> int:
    """Print a file to begin with."""
    text = all_keys_template() if arguments.kind == "all" else TEMPLATES[arguments.kind]
    answer.add_text(text.removesuffix("\n"), text=text)
    return 0


def execute_describe(arguments: argparse.Namespace, answer: Answer) -> int:
    """Describe the scene of a file."""
    scene = read_scene(arguments.scene)
    assembly = scene.system.assembly
    tables = [(head, ", ".join(keys)) for head, keys in toml_tables(assembly.parts.structural())]
    described = describe(assembly.setting, assembly.parts, tables)
    motion = "none"
    if scene.motion is not None:
        name = display_name(scene.motion.name, scene.motion.history)
        vertical = "" if scene.motion.si.vertical is None else ", with vertical"
        motion = f"{name}: {motion_summary(scene.motion)}{vertical}"
    answer.add_text(
        f"{described}\nMotion:\n  {motion}",
        model=assembly.setting.model,
        parts=[type(part).__name__ for part in assembly.parts.structural()],
        motion=motion,
        description=described,
    )
    return 0
