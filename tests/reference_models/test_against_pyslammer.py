"""A block that slides downhill, against pySLAMMER's rigid block."""

import math

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf

pyslammer = pytest.importorskip("pyslammer")
pytestmark = [
    pytest.mark.reference_models,
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]
NAMES = ("Northridge_1994_PAC-175", "Coalinga_1983_PVB-045", "Nisqually_2001_UNR-058")
"""Return the records that pySLAMMER contains."""

GRAVITY = 9.80665
SLOPE, FRICTION = 0.2, 0.3
FINER = 30
"""Subdivision of each interval of the record, as pySLAMMER's slips begin and end at samples. With a
much finer one its slips below 1e-5 m/s would matter."""


def downhill(samples, step):
    """Return a motion along the slope without a normal component."""
    c, s = math.cos(SLOPE), math.sin(SLOPE)
    return rf.GroundMotion.from_arrays(
        (c * samples, "m/s^2"), f"{step!r} s", vertical=(s * samples, "m/s^2")
    )


@pytest.fixture(scope="module")
def records():
    return pyslammer.sample_ground_motions()


@pytest.mark.parametrize(
    "name", [NAMES[0], *(pytest.param(name, marks=pytest.mark.long) for name in NAMES[1:])]
)
def test_slip_down_a_slope(name, records):
    one = records[name]
    samples, step = np.asarray(one.accel), float(one.dt)
    along = samples * (3.0 / np.abs(samples).max())
    block = rf.Block(width="2 m", height="1 m", mass="1 t")
    system = rf.System(block, rf.RigidGround(friction=FRICTION), inclination=f"{SLOPE} rad")
    with plain_python():
        run = system.simulate(downhill(along, step), accuracy="reference", outputs=None)
    coarse = step * np.arange(len(along))
    fine = np.linspace(0.0, coarse[-1], FINER * (len(along) - 1) + 1)
    yields = FRICTION * math.cos(SLOPE) - math.sin(SLOPE)
    finer = {"accel": np.interp(fine, coarse, along) / GRAVITY, "dt": step / FINER, "name": name}
    theirs = pyslammer.RigidAnalysis(yields, finer).max_sliding_disp
    assert float(run.peak_rotation) == 0.0
    assert -float(run.residual_slip) == pytest.approx(theirs, rel=1e-4)
