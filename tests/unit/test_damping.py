"""The damping ratio of a base, and the location of its warning."""

import pickle
import warnings

import pytest

import rockframe as rf
from rockframe.errors import ModelWarning

pytestmark = pytest.mark.unit


def test_damping_warning_points_at_the_calling_line():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=10)
        rf.WinklerSoil.from_subgrade_modulus("20 MN/m^3", depth="4 m", damping_ratio=10)
    assert [one.filename for one in caught] == [__file__] * 2


def test_damping_ratio_above_one_warns():
    words = r"TwoSpringSupport: damping_ratio = 10 is 1000 % of critical; was '10 %' meant\?"
    with pytest.warns(ModelWarning, match=words):
        pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=10)
    assert pads.si.damping_ratio == 10.0
    with pytest.warns(ModelWarning, match=r"WinklerSoil: damping_ratio = 1\.5 is 150 % of"):
        rf.WinklerSoil(stiffness="9 MPa", damping_ratio="150 %")
    # no warning at 1, and none a second time: pytest would raise it
    rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=1)
    assert pickle.loads(pickle.dumps(pads)) == pads  # noqa: S301


def test_soil_damping_follows_from_its_ratio():
    """c0 over the base is 2 xi sqrt(k m), for the vertical motion of the total mass."""
    block = rf.Block(width="4 m", height="10 m", mass="100 t")
    cap = rf.CushionCap(width="5 m", height="1 m", mass="60 t")
    for parts, width, mass in (((), 4.0, 1e5), ((cap,), 5.0, 1.6e5)):
        soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
        words = rf.System(block, *parts, soil).describe()
        critical = 2.0 * (width * 9e6 * mass) ** 0.5
        assert f"9e+06 Pa, {0.2 * critical / width:.6g} Pa s" in words
