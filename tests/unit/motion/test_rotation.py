"""Rotation of two horizontal components."""

import numpy as np
import pytest

from rockframe.errors import ComponentError, UnitsError
from rockframe.motion import GroundMotion

RNG = np.random.default_rng(3)
ONE, OTHER, UP = RNG.normal(size=(3, 50))
STEP = 0.02


def motion(values, name, azimuth=None, vertical=None, step=STEP):
    up = None if vertical is None else (vertical, "m/s^2")
    record = GroundMotion.from_arrays((values, "m/s^2"), f"{step} s", up, name=name)
    metadata = {} if azimuth is None else {"azimuth": azimuth, "component": name}
    return GroundMotion(record.si, name=name, metadata=metadata, history=record.history)


@pytest.mark.parametrize("degrees", [0.0, 30.0, 45.0, -120.0, 400.0])
def test_the_component_at_an_angle(degrees):
    turned = motion(ONE, "one").rotated(motion(OTHER, "other"), f"{degrees} deg")
    angle = np.radians(degrees)
    expected = np.cos(angle) * ONE + np.sin(angle) * OTHER
    assert turned.si.horizontal.samples == pytest.approx(expected, abs=1e-14)
    assert "towards other" in turned.history[-1]


@pytest.mark.parametrize(
    ("degrees", "expected"), [(0, ONE), (90, OTHER), (180, -ONE), (270, -OTHER), (-90, -OTHER)]
)
def test_right_angles_are_exact(degrees, expected):
    turned = motion(ONE, "one").rotated(motion(OTHER, "other"), f"{degrees} deg")
    assert turned.si.horizontal.samples.tolist() == expected.tolist()


def test_rotation_keeps_the_energy_of_the_pair():
    one, other = motion(ONE, "one"), motion(OTHER, "other")
    along = one.rotated(other, "0.7 rad").si.horizontal.samples
    across = one.rotated(other, f"{0.7 + np.pi / 2!r} rad").si.horizontal.samples
    assert along @ along + across @ across == pytest.approx(ONE @ ONE + OTHER @ OTHER, rel=1e-14)


def test_the_vertical_component_stays():
    turned = motion(ONE, "one", vertical=UP).rotated(motion(OTHER[:30], "other"), "10 deg")
    assert turned.si.vertical.samples.tolist() == UP.tolist()
    assert turned.history[-1] == "the other component padded with 20 zeros"


def test_the_vertical_component_is_padded_with_the_horizontal_ones():
    turned = motion(ONE[:30], "one", vertical=UP[:30]).rotated(motion(OTHER, "other"), "10 deg")
    assert turned.si.vertical.samples.tolist() == [*UP[:30], *[0.0] * 20]
    assert turned.history[-1] == "this component padded with 20 zeros"


def test_the_components_are_named():
    turned = motion(ONE, "H1", 0).rotated(motion(OTHER, "H2", 90), azimuth="-30 deg")
    assert turned.metadata["component"] == "H1 and H2 rotated by -30°"
    assert turned.metadata["azimuth"] == pytest.approx(330.0)


@pytest.mark.parametrize(("theirs", "accepted"), [(91, True), (89, True), (92, False), (88, False)])
def test_azimuths_may_deviate_one_degree_from_right_angle(theirs, accepted):
    """Agencies round azimuths to whole degrees."""
    one, other = motion(ONE, "H1", 0), motion(OTHER, "H2", theirs)
    if accepted:
        one.rotated(other, azimuth="30 deg")
    else:
        with pytest.raises(ComponentError, match="are not at a right angle"):
            one.rotated(other, azimuth="30 deg")


@pytest.mark.parametrize(("own", "theirs", "sign"), [(0, 90, 1), (90, 0, -1), (306, 36, 1)])
def test_rotation_to_azimuth(own, theirs, sign):
    """The component in direction `azimuth` follows from two with known azimuths."""
    one, other = motion(ONE, "H1", own), motion(OTHER, "H2", theirs)
    turned = one.rotated(other, azimuth="60 deg")
    angle = sign * np.radians(60.0 - own)
    expected = np.cos(angle) * ONE + np.sin(angle) * OTHER
    assert turned.si.horizontal.samples == pytest.approx(expected, abs=1e-14)
    assert turned.metadata["azimuth"] == pytest.approx(60.0)
    # a rotation to its own azimuth leaves a component unchanged
    assert one.rotated(other, azimuth=f"{own} deg").si.horizontal.samples.tolist() == ONE.tolist()
    assert (
        other.rotated(one, azimuth=f"{theirs} deg").si.horizontal.samples.tolist() == OTHER.tolist()
    )


def test_pulses_stay_analytic():
    one = GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    other = GroundMotion.sine_pulse("2 m/s^2", "1 Hz").window("0 s", "0.5 s")
    turned = one.rotated(other, "60 deg")
    time = np.linspace(0.0, 1.0, 901)
    sine = np.sin(2.0 * np.pi * time)
    expected = 0.5 * sine + np.sqrt(3.0) * np.where(time < 0.5, sine, 0.0)
    assert turned.si.at(time) == pytest.approx(expected, abs=1e-11)
    assert GroundMotion.from_dict(turned.to_dict()) == turned


def test_rotation_combines_pulse_with_record():
    pulse = GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    lines = motion(RNG.normal(size=len(pulse)), "lines", step=pulse.si.time_step)
    time = np.linspace(0.0, 1.0, 333)
    for one, other in ((pulse, lines), (lines, pulse)):
        turned = one.rotated(other, "1 rad")
        expected = np.cos(1.0) * one.si.at(time) + np.sin(1.0) * other.si.at(time)
        assert turned.si.at(time) == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({}, ComponentError, "give either angle or azimuth"),
        ({"angle": "1 rad", "azimuth": "1 rad"}, ComponentError, "give either angle or azimuth"),
        ({"angle": 30}, UnitsError, "angle needs an angle"),
        ({"azimuth": "30 deg"}, ComponentError, "must have an azimuth"),
    ],
)
def test_rotations_that_are_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        motion(ONE, "one").rotated(motion(OTHER, "other", 90.0), **arguments)


def test_invalid_second_component_raises():
    with pytest.raises(ComponentError, match="needs a GroundMotion"):
        motion(ONE, "one").rotated(OTHER, "30 deg")
    with pytest.raises(ComponentError, match=r"time steps differ"):
        motion(ONE, "one").rotated(motion(OTHER, "other", step=0.01), "30 deg")
    with pytest.raises(ComponentError, match="0° and 60° are not at a right angle"):
        motion(ONE, "one", 0).rotated(motion(OTHER, "other", 60), azimuth="30 deg")
