"""``rockframe certify``: how sure a verdict is."""

import argparse
from textwrap import fill

from rockframe.command.answer import Answer
from rockframe.command.run import finished
from rockframe.command.shared import RUN, Outputs, given_of, scene_from, simulated
from rockframe.simulation.run_arguments import PROVED, Certification


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Simulate, with all runs beside it, and say what they showed."""
    found = scene_from(arguments)
    outputs = Outputs(arguments, found.files, answer, output=RUN)
    wanted = PROVED
    if not arguments.proved:
        wanted = Certification(**given_of(arguments, "nudge", "reach", "runs"))
    response = simulated(found, certify=wanted)
    answer.says("Verdict", response.attrs["verdict"])
    kind = "proof" if arguments.proved else "certificate"
    told = response.attrs[kind]
    answer.text(fill(f"{kind.capitalize()}: {told}", 100), **{kind: told})
    if not arguments.proved:
        sure = {"verdict_converged": "by finer means", "verdict_robust": "with nudged parameters"}
        for name, words in sure.items():
            answer.text(f"  the same {words}: {'yes' if bool(response[name]) else 'no'}")
        count = int(response.attrs["certificate_runs"])
        answer.text(f"  runs beside it: {count}", certificate_runs=count)
    answer.numbers(response)
    outputs.result(response)
    return 0 if finished(response) else 1
