"""Parts and runs with one argument chosen by a test."""

import pint
import pytest

import rockframe as rf
from rockframe.errors import RockframeError

SIZE = {"width": "2 m", "height": "8 m", "mass": "50 t"}
PADS = {"frequency_ratio": 20, "damping_ratio": 0.1}


def make_block(**changed):
    return rf.Block(**{**SIZE, **changed})


def make_pads(**changed):
    arguments = dict(PADS)
    if "stiffness" in changed:
        del arguments["frequency_ratio"]
    if "damping" in changed:
        del arguments["damping_ratio"]
    return rf.TwoSpringSupport(**{**arguments, **changed})


def make_system(**changed):
    return rf.System(make_block(), **changed)


def make_pulse(**changed):
    return rf.GroundMotion.sine_pulse(**changed)


def run(**changed):
    return make_system().simulate(make_pulse(), **changed)


FOREIGN = pint.UnitRegistry(cache_folder=None)


def refusal(maker, **arguments):
    with pytest.raises(RockframeError) as caught:
        maker(**arguments)
    return str(caught.value)
