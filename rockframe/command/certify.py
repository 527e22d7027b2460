"""``rockframe certify``: how certain a verdict is."""

import argparse
from dataclasses import replace
from textwrap import fill

from rockframe.command.answer import Answer
from rockframe.command.run import is_finished
from rockframe.command.shared import RUN_KIND, Outputs, scene_from, simulate_scene, typed_options
from rockframe.errors import ComponentError
from rockframe.simulation.run_arguments import PROVED, Certification


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Simulate with all runs of the certificate, and report their outcome."""
    found = scene_from(arguments)
    outputs = Outputs(arguments, found.files, answer, output=RUN_KIND)
    certification = _certification_of(found.run.get("certify"), arguments)
    response = simulate_scene(found, certify=certification)
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
    answer.add_numbers(response)
    outputs.write_result(response)
    return 0 if is_finished(response) else 1


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
