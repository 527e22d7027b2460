"""A block on two springs on top of a body on a Winkler bed, integrated in sequence.

The body, block and cap in one, responds to the ground. The acceleration of its top is taken from
the dense solution, in polynomials of fourth degree that end where it is not smooth, and excites
the block on its springs. The speed of the top must not jump, as it does where the held point
changes with the contact: an acceleration cannot represent a jump.
"""

from __future__ import annotations

import itertools

import numpy as np

from . import Pieces, two_spring, winkler


def simulate(
    *,
    body: dict,
    block: dict,
    top: float,
    time_step: float,
    acceleration,
    duration: float,
    sample_times,
    restart_every_knot: bool = True,
    **settings,
):
    """Integrate both; return the total rotation at the samples and both results.

    ``body`` and ``block`` are arguments of :func:`winkler.simulate` and
    :func:`two_spring.simulate`, ``top`` is the height of the cap's top above the body's centre
    of mass, ``settings`` those of the integration.
    """
    across, up = Pieces(), Pieces()
    samples = np.arange(len(acceleration)) * time_step

    def watch(run, start, stop, dense):
        inside = samples[(samples > start + 1e-12) & (samples < stop - 1e-12)]
        edges = [start, *inside, stop]
        for left, right in itertools.pairwise(edges):
            if right <= left:
                continue
            times = left + (right - left) * Pieces.NODES
            states = dense(times)
            (turn, rise, slide), *_ = run.motion(times, states, np)
            sine, cosine, rate = np.sin(states[0]), np.cos(states[0]), states[3]
            ground_x, ground_y = run.ground_x(times), run.ground_y(times)
            across.add(left, right, slide + top * (cosine * turn - sine * rate**2) + ground_x)
            up.add(left, right, rise - top * (sine * turn + cosine * rate**2) + ground_y)

    common = {
        "duration": duration,
        "sample_times": sample_times,
        "overturning": "continue",
        "restart_every_knot": restart_every_knot,
        **settings,
    }
    first = winkler.simulate(
        **body, time_step=time_step, acceleration=acceleration, watch=watch, **common
    )
    # the acceleration of the top has a kink at each contact change of the body
    changes = [event.time for event in first.events]
    second = two_spring.simulate(
        **block, acceleration=across, vertical=up, breakpoints=changes, **common
    )
    return first.rotation + second.rotation, first, second
