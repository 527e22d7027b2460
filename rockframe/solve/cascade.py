"""Two models in series, Eq. (20): the response of the first shakes the second.

The first is a block and its cap as one body on a bed; the middle of the cap's top is
the ground of the second, page "Cap and soil" of the manual.
"""

import math
from dataclasses import dataclass

from rockframe.dynamics.protocol import ContactModel, Start
from rockframe.solve.accuracy import Accuracy
from rockframe.solve.carrying import HALVES, carry, carrying_step
from rockframe.solve.ground_table import Ground
from rockframe.solve.integrate import integrate
from rockframe.solve.layout import Status
from rockframe.solve.total import summarise
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
    overturning_rate : float
        Rate of the total rotation at overturning; NaN if it does not overturn [rad s^-1].
    """

    first: Trajectory
    second: Trajectory
    carried: Ground
    summary: Summary
    overturning_rate: float


def integrate_cascade(
    cascade: Cascade,
    start: Start,
    ground: Ground,
    accuracy: Accuracy,
    *,
    duration: float,
    output_step: float | None,
    stop_at_overturning: bool = True,
    with_work: bool = False,
) -> CascadeRun:
    """Integrate both stages, with the arguments of :func:`rockframe.solve.integrate.integrate`.

    The first stage starts at rest, the second as `start` tells.

    Returns
    -------
    CascadeRun
        Ended where the total rotation reaches the overturning angle of the second
        stage, if asked.
    """
    step = carrying_step(cascade.first, ground)
    fine = step / HALVES
    whole = step * math.ceil(duration / step - 1e-9)

    def run(
        model: ContactModel, begin: Start, shaking: Ground, length: float, every: float | None
    ) -> Trajectory:
        return integrate(
            model,
            begin,
            shaking,
            accuracy,
            duration=length,
            output_step=every,
            stop_at_overturning=False,
            with_work=with_work and every is not None,
            keep_end=True,
        )

    first = run(cascade.first, Start(), ground, whole, fine)
    carried = carry(cascade.first, first, ground, cascade.top, step)
    second = run(cascade.second, start, carried, min(duration, first.end_time), fine)
    summary, rate = summarise(cascade, first, second, stop_at_overturning=stop_at_overturning)
    end = summary.end_time
    every = 0 if output_step is None else round(output_step / fine)
    if output_step is None:
        first, second = first.without_histories(), second.without_histories()
    elif summary.status is Status.COMPLETED and math.isclose(every * fine, output_step):
        last = math.floor(end / output_step * (1.0 + 1e-12))
        first, second = first.thinned(every, last), second.thinned(every, last)
    else:  # once more, at the output times and up to the end
        first = run(cascade.first, Start(), ground, end, output_step)
        second = run(cascade.second, start, carried, end, output_step)
    return CascadeRun(first, second, carried, summary, rate)
