"""Overturning by pulses that begin and end with a jump, and by impulses, in closed form.

The linearised block, q = alpha/theta, overturns without an impact if it is beyond its
unstable orbit at the end of the pulse:

    -1 + p int_0^inf exp(-p t) A(t) dt > 0,

A the acceleration of the ground over g theta, opposite to the rotation. The integral
starts at uplift.
"""

import math

import numpy as np
import pytest
from analytical.rigid import GRAVITY, P, rigid_block
from scipy.integrate import quad
from scipy.optimize import brentq

import rockframe as rf

pytestmark = pytest.mark.analytical

THETA = 0.1
TOPPLED = 2
UNIT = GRAVITY * THETA


def topples(motion):
    response = rigid_block(THETA, rotation="small").simulate(
        motion,
        free_vibration=f"{30.0 / P!r} s",
        accuracy="reference",
        overturning="continue",
        outputs=None,
    )
    return response.status.item() == TOPPLED and response.impact_count.item() == 0


def straddles(threshold, motion_of):
    """Return whether the block topples a millionth above the threshold, and not below."""
    above, below = (topples(motion_of(threshold * factor)) for factor in (1.0 + 1e-6, 1.0 - 1e-6))
    return above and not below


@pytest.mark.parametrize("ratio", [1.0, 3.0, 6.0])
@pytest.mark.parametrize("cycles", [0.25, 0.4, 0.5])
def test_part_of_a_cosine(ratio, cycles):
    """A ramp of one sample after a jump at the end would move the threshold far more."""

    def weight(angle):  # of the antiderivative of exp(-angle/ratio) cos(angle)
        return math.exp(-angle / ratio) * (math.sin(angle) - math.cos(angle) / ratio)

    end = 2.0 * math.pi * cycles
    threshold = (ratio + 1.0 / ratio) / (weight(end) - weight(0.0))
    frequency = f"{ratio * P / (2.0 * math.pi)!r} Hz"
    assert straddles(
        threshold,
        lambda size: rf.GroundMotion.cosine_pulse(f"{-size * UNIT!r} m/s^2", frequency, cycles),
    )


@pytest.mark.parametrize("ratio", [1.0, 4.0])
def test_type_b(ratio):
    threshold = (1.0 + ratio**2) / (1.0 - math.exp(-2.0 * math.pi / ratio))
    period = 2.0 * math.pi / (ratio * P)
    assert straddles(
        threshold,
        lambda size: rf.GroundMotion.type_b_pulse(
            f"{-size * UNIT / (ratio * P)!r} m/s", f"{period!r} s"
        ),
    )


def lift_off(height):
    """Return the position in an impulse, of peak 15 height/8, at which it reaches g theta."""
    return brentq(lambda u: height * 30.0 * (u * (1.0 - u)) ** 2 - 1.0, 0.0, 0.5, xtol=1e-15)


@pytest.mark.parametrize("interval", [0.5, 2.0])
@pytest.mark.parametrize("parts", [4, 100])
def test_double_impulse(interval, parts):
    """Times are dimensionless, p t; `size` is p V over g theta."""
    length = interval / parts

    def excess(size):
        height, start = size / length, lift_off(size / length)

        def shape(u):
            return height * 30.0 * (u * (1.0 - u)) ** 2 * math.exp(-length * u)

        first = quad(shape, start, 1.0, epsabs=0.0, epsrel=1e-13)[0]
        second = quad(shape, 0.0, 1.0, epsabs=0.0, epsrel=1e-13)[0]
        return length * (first - math.exp(-interval) * second) - math.exp(-length * start)

    threshold = brentq(excess, 1.0, 10.0, xtol=1e-14)
    assert threshold == pytest.approx(1.0 / (1.0 - math.exp(-interval)), rel=2.0 / parts)
    assert straddles(
        threshold,
        lambda size: rf.GroundMotion.double_impulse(
            f"{-size * UNIT / P!r} m/s", f"{interval / P!r} s", f"{length / P!r} s"
        ),
    )


def test_ground_stands_still_after_final_jump():
    motion = rf.GroundMotion.type_b_pulse("0.02 m/s", "1 s")
    response = rigid_block(THETA).simulate(motion, free_vibration="0.5 s", output_step="0.05 s")
    excitation = response.ground_acceleration.sel(time=slice(1.01, None))
    assert len(excitation) > 5
    assert not np.any(excitation)


def test_first_sample_has_contact_state_after_initial_jump():
    block = rf.Block(width="1 m", height="4 m", mass="1 t")
    steady = rf.GroundMotion.from_arrays((np.full(100, -6.0), "m/s^2"), time_step="5 ms")
    run = rf.System(block).simulate(steady)
    assert run.event_time[0] == 0.0
    meanings = run.contact_state.attrs["flag_meanings"].split()
    assert [meanings[one] for one in run.contact_state.values[:2]] == ["right"] * 2
