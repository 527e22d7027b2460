"""Runs near and far from the boundary, and certificates of artificial runs."""

from functools import cache

import rockframe as rf
from rockframe.simulation.certify.certificate import (
    certify,
)
from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.simulation.plan import plan_run

BLOCK = rf.Block.from_size(radius="5 m", slenderness=5, mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
SYSTEM = rf.System(BLOCK, PADS)
PULSE = rf.GroundMotion.sine_pulse("-3 m/s^2", "1 Hz")
NAMES = (
    "verdict_converged",
    "verdict_robust",
    "verdict_margin",
    "verdict_flip_scale",
    "peak_error_estimate",
    "peak_sensitivity",
)


def certified(motion=PULSE, system=SYSTEM, certify=True, **arguments):
    arguments = {"free_vibration": "4 s", **arguments} if motion is not None else arguments
    return system.simulate(motion, certify=certify, **arguments)


def falls(scale, system=SYSTEM):
    run = system.simulate(PULSE.scaled(scale), free_vibration="4 s", outputs=None)
    return bool(run.overturned)


@cache
def edge(low=1.0, high=8.0):
    """Find the scale at which the verdict changes."""
    assert falls(high)
    assert not falls(low)
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if falls(middle) else (middle, high)
    return 0.5 * (low + high)


def artificial_run(overturns):
    """Return a run whose verdict is a function of scene and plan; None means unfinished."""

    def run(system, plan):
        verdict = overturns(system, plan)
        clearances = (1.0, 1.0) if verdict else (0.5,)
        return RunSummary(verdict, 0.1 + plan.accuracy.rtol, clearances, 1.0, 0, 0.001)

    return run


def plan_of(rtol=1e-4):
    return plan_run(
        SYSTEM.assembly,
        PULSE,
        duration=None,
        free_vibration=None,
        initial=None,
        accuracy=rf.Accuracy(rtol=rtol),
        output_step=None,
        outputs=(),
        overturning="stop",
    )


def certificate_of(overturns, rtol=1e-4):
    run, plan = artificial_run(overturns), plan_of(rtol)
    return certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(), run)
