"""Two models in series, Eq. (20): the response of the first shakes the second.

The first is a block and its cap as one body on a bed; the middle of the cap's top is
the ground of the second, page "Cap and soil" of the manual.
"""

import math
from dataclasses import dataclass

from rockframe.dynamics.protocol import ContactModel, Ending, Start
from rockframe.solve.accuracy import Accuracy
from rockframe.solve.carrying import HALVES, carry, carrying_step
from rockframe.solve.ground_table import Ground
from rockframe.solve.integrate import integrate
from rockframe.solve.layout import Status
from rockframe.solve.substeps import finer
from rockframe.solve.total import Reach, summarise
from rockframe.solve.trajectory import Summary, Trajectory


@dataclass(frozen=True)
class Cascade:
    """Two stages.

    Parameters
    ----------
    first : ContactModel
        Block and cap as one body.
    second : ContactModel
        The block on the cap.
    top : float
        Height of the cap's top above the centre of mass of the first stage [m].
    """

    first: ContactModel
    second: ContactModel
    top: float


@dataclass(frozen=True)
class CascadeRun:
    """A run of both stages, with the same output times.

    Parameters
    ----------
    first, second : Trajectory
        The stages.
    carried : Ground
        Absolute acceleration of the cap's top, the ground of the second stage.
    summary : Summary
        Of the total rotation, and of the second stage's contact.
    reaches : list of Reach
        Overturning and the fall that ends a run, of the total rotation.
    """

    first: Trajectory
    second: Trajectory
    carried: Ground
    summary: Summary
    reaches: list[Reach]


def integrate_cascade(
    cascade: Cascade,
    start: Start | tuple[Ending, ...],
    ground: Ground,
    accuracy: Accuracy,
    *,
    duration: float,
    output_step: float | None,
    stop_at_overturning: bool = True,
    with_work: bool = False,
) -> CascadeRun:
    """Integrate both stages, with the arguments of :func:`rockframe.solve.integrate.integrate`.

    The first stage starts at rest, the second as `start` tells; or both where those of
    another run ended.

    Returns
    -------
    CascadeRun
        Ended where the total rotation reaches the overturning angle of the second
        stage, if asked.
    """
    begin_first, begin_second = (Start(), start) if isinstance(start, Start) else start
    step = carrying_step(cascade.first, ground)
    fine = step / HALVES
    whole = step * math.ceil(duration / step - 1e-9)
    fitting = finer(accuracy, round(ground.interval / step))

    def run(
        model: ContactModel,
        begin: Start | Ending,
        shaking: Ground,
        settings: Accuracy,
        length: float,
        every: float | None,
        *,
        keep_end: bool = False,
    ) -> Trajectory:
        return integrate(
            model,
            begin,
            shaking,
            settings,
            duration=length,
            output_step=every,
            stop_at_overturning=False,
            with_work=with_work and every is not None,
            keep_end=keep_end,
        )

    first = run(cascade.first, begin_first, ground, accuracy, whole, fine)
    carried = carry(cascade.first, first, ground, cascade.top, step)
    length = whole if first.status is Status.COMPLETED else first.end_time
    second = run(cascade.second, begin_second, carried, fitting, length, fine)
    summary, reaches = summarise(
        cascade, first, second, duration=duration, stop_at_overturning=stop_at_overturning
    )
    end, completed = summary.end_time, summary.status is Status.COMPLETED
    every = 0 if output_step is None else round(output_step / fine)
    if output_step is None:
        first, second = first.without_histories(), second.without_histories()
    elif completed and math.isclose(every * fine, output_step) and math.isclose(whole, end):
        last = math.floor(end / output_step * (1.0 + 1e-12))
        first = first.thinned(every, last, output_step)
        second = second.thinned(every, last, output_step)
    else:  # once more, at the output times and up to the end
        keep = not completed
        first = run(cascade.first, begin_first, ground, accuracy, end, output_step, keep_end=keep)
        second = run(
            cascade.second, begin_second, carried, fitting, end, output_step, keep_end=keep
        )
    return CascadeRun(first, second, carried, summary, reaches)
