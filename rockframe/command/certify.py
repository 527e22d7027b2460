"""``rockframe certify``: how sure a verdict is."""

import argparse
from textwrap import fill

from rockframe.command.run import finished
from rockframe.command.shared import RUN, Outputs, scene_from, simulated
from rockframe.simulation.run_arguments import PROVED, Certification


def execute(arguments: argparse.Namespace) -> int:
    """Simulate, with all runs beside it, and say what they showed."""
    found = scene_from(arguments)
    outputs = Outputs(arguments, found.files)
    outputs.check(arguments.output, RUN)
    if arguments.proved:
        response = simulated(found, certify=PROVED)
        print(f"Verdict: {response.attrs['verdict']}")
        print(fill(f"Proof: {response.attrs['proof']}", 100))
        outputs.result(arguments.output, RUN, response)
        return 0 if finished(response) else 1
    given = {name: getattr(arguments, name) for name in ("nudge", "reach", "runs")}
    wanted = Certification(**{name: value for name, value in given.items() if value is not None})
    response = simulated(found, certify=wanted)
    print(f"Verdict: {response.attrs['verdict']}")
    print(fill(f"Certificate: {response.attrs['certificate']}", 100))
    sure = {"verdict_converged": "by finer means", "verdict_robust": "with nudged parameters"}
    for name, words in sure.items():
        print(f"  the same {words}: {'yes' if bool(response[name]) else 'no'}")
    print(f"  runs beside it: {response.attrs['certificate_runs']}")
    outputs.result(arguments.output, RUN, response)
    return 0 if finished(response) else 1
