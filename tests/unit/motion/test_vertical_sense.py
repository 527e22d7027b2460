"""Vertical components of motions are positive upwards, whatever the sign in the file."""

import numpy as np
import pytest
from unit.motion.dialect_samples import VALUES, sac
from unit.motion.format_samples import csmip_channel, cwa, smc
from unit.motion.motion_files import EVENT, at2, numbers

from rockframe.errors import RecordWarning
from rockframe.motion import GroundMotion

COUNT = 61
POINTS = f"NPTS= {COUNT}, DT= .01 SEC"


def pair(write, name: str):
    """A horizontal component of one file with the named vertical component of another."""
    values = numbers(COUNT)
    level = GroundMotion.read(write(at2(POINTS, values), "h.AT2"))
    event = EVENT.replace(", 67", f", {name}")
    path = write(at2(POINTS, 0.5 * values, event=event), "v.AT2")
    return level, GroundMotion.read(path, component=name), 0.5 * values * 9.80665


@pytest.mark.parametrize(
    ("name", "sign"),
    [
        *((name, -1.0) for name in ("DWN", "DOWN", "DN", "D")),
        *((name, 1.0) for name in ("UP", "U")),
    ],
)
def test_component_name_sets_sign_of_vertical_component(write, name, sign):
    level, vertical, values = pair(write, name)
    motion = level.with_vertical(vertical)
    np.testing.assert_allclose(motion.si.vertical.samples, sign * values, rtol=1e-6)
    turned = f"component {name} turned over: positive upwards"
    assert (turned in motion.history) == (sign < 0.0)
    assert motion.metadata["vertical_positive"] == "up"
    assert motion.metadata["vertical_component"] == name


@pytest.mark.parametrize("name", ["V", "VERT", "VER"])
def test_component_name_without_sense_warns(write, name):
    level, vertical, values = pair(write, name)
    with pytest.warns(RecordWarning, match="does not say whether it is positive upwards"):
        motion = level.with_vertical(vertical)
    np.testing.assert_allclose(motion.si.vertical.samples, values, rtol=1e-6)


@pytest.mark.parametrize(
    ("text", "name", "component"),
    [
        (cwa(sequence="Time U(-); N(+); E(+)"), "r.dat", "-U"),
        (csmip_channel(2, VALUES["U"], channel=1, name="DOWN"), "r.V2", "DOWN"),
        (smc(VALUES["U"], slope=180, name=""), "r.smc", "DOWN"),
    ],
    ids=["cwa", "csmip", "smc"],
)
def test_file_header_sets_sign_of_vertical_component(write, text, name, component):
    path = write(text, name)
    vertical = GroundMotion.read(path, component=component)
    assert vertical.metadata["positive"] == "down"
    upwards = GroundMotion.read(path, component="U")
    assert upwards.metadata["positive"] == "up"
    np.testing.assert_array_equal(upwards.si.horizontal.samples, -vertical.si.horizontal.samples)
    level = GroundMotion.from_arrays((VALUES["N"], "m/s^2"), f"{vertical.si.time_step!r} s")
    both = [level.with_vertical(motion).si.vertical.samples for motion in (vertical, upwards)]
    np.testing.assert_array_equal(both[0], both[1])


def test_vertical_sign_is_independent_of_mirroring(write):
    path = write(sac(VALUES["U"], incidence=180.0, channel="HNZ"), "r.sac")
    down = GroundMotion.read(path, component="HNZ", unit="gal")
    level = GroundMotion.from_arrays((VALUES["N"], "m/s^2"), "0.01 s")
    expected = level.with_vertical(down).si.vertical.samples
    halved = down.scaled(0.5).scaled(2.0)
    for mirrored in (down.scaled(-1.0), down.scaled(-2.0).scaled(0.5), halved):
        vertical = level.with_vertical(mirrored).si.vertical.samples
        np.testing.assert_allclose(vertical, expected, rtol=1e-14)


def test_analytic_vertical_component_keeps_its_sign():
    pulse = GroundMotion.sine_pulse()
    both = pulse.with_vertical(pulse.scaled(-0.5))
    assert both.si.vertical.samples.min() == pytest.approx(-0.5 * pulse.si.horizontal.samples.max())
    assert "vertical_positive" not in both.metadata


def test_vertical_component_can_be_removed():
    both = GroundMotion.example("waipukurau", component=("S74E", "Up"))
    alone = both.with_vertical(None)
    assert alone.si.vertical is None
    assert alone.sha256 == GroundMotion.example("waipukurau", component="S74E").sha256
    assert not [key for key in alone.metadata if key.startswith("vertical")]
    assert alone.with_vertical(None) is alone
