"""Scenes and motions of tests that cover all of them."""

from functools import cache

import pytest
from contract.scenes import MOTIONS, SCENES


@pytest.fixture(params=list(SCENES))
def scene(request):
    """Return the name of a scene in SCENES."""
    return request.param


# the other motions run in the long tests
SHORT_MOTIONS = ("pulse and vertical", "record")


@pytest.fixture(
    params=[
        name if name in SHORT_MOTIONS else pytest.param(name, marks=pytest.mark.long)
        for name in MOTIONS
    ]
)
def motion_name(request):
    """Return the name of a motion in MOTIONS."""
    return request.param


@pytest.fixture
def response(scene, motion_name):
    """Return the response of a scene to a motion, with all outputs."""
    return _run(scene, motion_name).copy(deep=True)


@cache
def _run(scene, motion_name):
    return SCENES[scene]().simulate(
        MOTIONS[motion_name](), free_vibration="0.5 s", outputs="energy"
    )
