"""The runs of the cases of a job, side by side where they can, else one after the other."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from rockframe.simulation.run import respond
from rockframe.studies.sweeps.cases_of_job import CasesOfJob
from rockframe.studies.sweeps.side_by_side import Finished, run_side_by_side


@dataclass(frozen=True)
class Failed:
    """A case without a run.

    Parameters
    ----------
    case : int
        Its number in the job.
    problem : Exception
        Why.
    """

    case: int
    problem: Exception


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
    if patience is not None:
        for finished in run_side_by_side(cases, which, stopped, patience):
            alone.discard(finished.case)
            yield finished
    for case in sorted(alone):
        if stopped():
            return
        try:
            system, said, plan = cases.planned(case)
            response = respond(system, plan)
            yield Finished(case, system, response.trajectory, said, response)
        except Exception as problem:  # whatever it is, it is this case's alone
            yield Failed(case, problem)
