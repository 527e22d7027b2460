"""A block of chosen slenderness on rigid ground, and quantities read from its response."""

import itertools
import math

import numpy as np
import pytest
from scipy.optimize import brentq

import rockframe as rf
from rockframe.errors import ModelWarning

RADIUS = 5.0
GRAVITY = 9.80665
P = math.sqrt(0.75 * GRAVITY / RADIUS)
"""Housner's frequency parameter of a solid rectangle [rad/s]."""


def rigid_block(theta, restitution=None, rotation="finite", radius=RADIUS):
    """Assemble a solid rectangle of a given angle on rigid ground."""
    block = rf.Block.from_size(
        radius=f"{radius!r} m", slenderness=1.0 / math.tan(theta), mass="50 t"
    )
    if restitution is None:
        return rf.System(block, rotation=rotation)
    ground = rf.RigidGround(restitution=restitution)
    if restitution <= block.maximum_restitution:
        return rf.System(block, ground, rotation=rotation)
    with pytest.warns(ModelWarning, match="eps_max"):
        return rf.System(block, ground, rotation=rotation)


def free(system, share, periods, **options):
    """Release a block from a share of its overturning angle, for p t = `periods`."""
    theta = system.setting.overturning_angle
    return system.simulate(
        duration=f"{periods / P!r} s",
        initial=rf.InitialState(rotation=f"{share * theta!r} rad"),
        accuracy="reference",
        **options,
    )


def impact_times(response):
    """Return p t of the impacts."""
    return P * response.event_time.values[response.event_kind.values == 2]


def peaks_between_impacts(response):
    """Return the largest |alpha|/theta of each rock after an impact.

    The samples nearest to the peak and a parabola through rotation and rate
    leave an error of fourth order in the output step.
    """
    time = response.time.values
    size = np.abs(response.relative_rotation.values)
    rate = response.angular_velocity.values / response.overturning_angle.item()
    rate = np.sign(response.rotation.values) * rate
    edges = [*response.event_time.values[response.event_kind.values == 2], time[-1]]
    found = []
    for start, end in itertools.pairwise(edges):
        inside = np.flatnonzero((time > start) & (time < end))
        turning = inside[:-1][(rate[inside[:-1]] > 0.0) & (rate[inside[1:]] <= 0.0)]
        for i in turning:
            step = time[i + 1] - time[i]
            share = rate[i] / (rate[i] - rate[i + 1])
            found.append(size[i] + 0.5 * rate[i] * share * step)
    return np.array(found)


def half_sine_threshold(ratio):
    """Return the amplitude over g theta of a half sine that overturns, its ratio to p given."""

    def excess(psi):
        left = ratio * math.sin(psi) - math.cos(psi)
        return left - math.exp(-(math.pi - psi) / ratio)

    return 1.0 / math.sin(brentq(excess, 1e-9, 0.5 * math.pi, xtol=1e-15, rtol=1e-14))


def one_sine_threshold(ratio):
    """Return that of one sine that overturns without an impact."""

    def excess(psi):
        left = math.cos(psi) - ratio * math.sin(psi)
        return left - math.exp(-(2.0 * math.pi - psi) / ratio)

    return 1.0 / math.sin(brentq(excess, 1e-9, 0.5 * math.pi, xtol=1e-15, rtol=1e-14))


BANDS = {
    2: [(1.225179, 2.314403)],
    4: [(1.795442, 4.850111)],
    6: [(5.164159, 7.669873)],
}
"""Amplitudes that overturn after impacts with restitution 0.9."""
