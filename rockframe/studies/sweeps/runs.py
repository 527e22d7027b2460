"""The runs of the cases of a job, side by side where they can, else one after the other."""

from collections.abc import Callable, Iterator, Sequence

from rockframe.errors import PLEASE_REPORT
from rockframe.simulation.run import respond
from rockframe.studies.sweeps.cases_of_job import CasesOfJob
from rockframe.studies.sweeps.side_by_side import Failed, Finished, run_side_by_side


def each_run(
    cases: CasesOfJob,
    which: Sequence[int],
    stopped: Callable[[], bool],
    patience: float | None,
) -> Iterator[Finished | Failed]:
    """Run cases.

    Parameters
    ----------
    cases : CasesOfJob
        All cases of a job.
    which : sequence of int
        Those to run.
    stopped : callable
        Whether to leave off; asked between cases.
    patience : float or None
        Longest time to compile what lanes need [s]; None lets no cases run in lanes.

    Yields
    ------
    Finished or Failed
        In any order; not all where it was left off.
    """
    alone = set(which)
    faults: dict[int, Exception] = {}
    if patience is not None:
        for found in run_side_by_side(cases, which, stopped, patience):
            if isinstance(found, Failed):
                faults[found.case] = found.problem
            else:
                alone.discard(found.case)
                yield found
    for case in sorted(alone):
        if stopped():
            return
        try:
            system, said, plan = cases.planned(case)
            response = respond(system, plan)
            if case in faults:  # that it alone does not have
                said = [*said, _not_beside_others(faults[case])]
            yield Finished(case, system, response.trajectory, said, response)
        except Exception as problem:  # whatever it is, it is this case's alone
            yield Failed(case, problem)


def _not_beside_others(problem: Exception) -> str:
    """Say of a case that ran alone why it did not run in a lane."""
    kind = type(problem).__name__
    return f"its run beside others failed ({kind}: {problem}), and it ran alone: {PLEASE_REPORT}"
