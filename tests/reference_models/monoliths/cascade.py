"""A block on two springs on the top of a body on a Winkler bed: one after the other.

The body, block and cap in one, answers the ground; the acceleration of its top, taken from
the dense solution in polynomials of fourth degree that end where it is not smooth, is the
ground of the block on its springs. The body's top must not jump: where the held point changes
with the contact, the rates do, and a jump of the top's speed is more than an acceleration can
say.
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
    """Integrate both; give the total rotation at the samples and both results.

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
    # where a contact of the body changes its top's acceleration has a kink
    changes = [event.time for event in first.events]
    second = two_spring.simulate(
        **block, acceleration=across, vertical=up, breakpoints=changes, **common
    )
    return first.rotation + second.rotation, first, second
