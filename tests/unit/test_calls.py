"""Calls that do not fit: what is said of them, and in whose name."""

import inspect
import pickle
import re

import pytest

import rockframe as rf

pytestmark = pytest.mark.unit

SIZE = {"width": "2 m", "height": "8 m", "mass": "40 t"}
BLOCK = rf.Block(**SIZE)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            lambda: rf.Block("2 m", "8 m", "40 t"),
            "Block: arguments are given by name; write Block(width=..., height=..., mass=...[",
        ),
        (lambda: rf.Block(width="2 m"), "Block: height and mass are missing; write Block("),
        (lambda: rf.Block(height="2 m", mass="4 t"), "Block: width is missing; write Block("),
        (
            lambda: rf.Block(**SIZE, weight="4 kN"),
            "Block: got an unexpected keyword argument 'weight'; write Block(width=",
        ),
        (lambda: rf.TwoSpringSupport(20, 0.1), "write TwoSpringSupport([frequency_ratio=..., "),
        (lambda: rf.FrameEquivalent("2 m"), "FrameEquivalent: arguments are given by name"),
        (
            lambda: rf.System(block=BLOCK),
            "System: got an unexpected keyword argument 'block'; write System(*parts[, restraint",
        ),
        (rf.GroundMotion, "write GroundMotion.read(path), GroundMotion.from_arrays("),
        (
            lambda: rf.GroundMotion(acceleration=[0.0, 1.0], time_step="0.01 s"),
            "GroundMotion: it is not built by calling it; write GroundMotion.read(path)",
        ),
        (
            lambda: rf.GroundMotion.stochastic(6.5, "5 km"),
            "stochastic() missing 1 required positional argument: 'seed'",
        ),
        (lambda: rf.GroundMotion.sine_pulse(cycle=1), "sine_pulse() got"),
        (lambda: rf.GroundMotion.sine_pulse().resampled(), "resampled() missing"),
        (lambda: rf.System(BLOCK).describe("all"), "System.describe() takes"),
    ],
)
def test_a_call_that_does_not_fit_is_refused_in_the_public_name(call, words):
    with pytest.raises(TypeError, match=re.escape(words)):
        call()


def test_a_path_is_no_motion():
    with pytest.raises(
        rf.ComponentError, match=r"found 'x\.AT2'; write GroundMotion\.read\(path\)"
    ):
        rf.GroundMotion("x.AT2")


@pytest.mark.parametrize("kind", [rf.System, rf.GroundMotion])
def test_a_path_is_no_dataset(kind):
    words = rf"{kind.__name__}\.from_dataset: found 'run\.nc'; .*xr\.open_dataset first"
    with pytest.raises(rf.SchemaError, match=words):
        kind.from_dataset("run.nc")


def test_help_shows_the_constructor():
    assert list(inspect.signature(rf.Block).parameters)[:3] == ["width", "height", "mass"]
    assert next(iter(inspect.signature(rf.System).parameters)) == "parts"
    assert "name" in inspect.signature(rf.GroundMotion).parameters


def test_methods_are_pickled_in_their_public_name():
    for method in (rf.GroundMotion.resampled, rf.GroundMotion.stochastic, rf.System.describe):
        assert pickle.loads(pickle.dumps(method)) == method  # noqa: S301
