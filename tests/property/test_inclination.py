"""Inclined bases: mirror images, the level limit, energy balances, file round trips."""

import json
import math

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import AssemblyError

pytestmark = pytest.mark.property

PADS = rf.TwoSpringSupport(frequency_ratio=25, damping_ratio=0.1)
CAP = rf.CushionCap(height="0.3 m", mass="2 t", width="1.6 m")
SOIL = rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1)
SCENES = {
    "rigid ground": ((), {}),
    "rigid ground, small": ((), {"rotation": "small"}),
    "pads": ((PADS,), {}),
    "pads, small": ((PADS,), {"rotation": "small"}),
    "pads, leading corner": ((PADS,), {"restraint": "leading-corner"}),
    "soil": ((SOIL,), {}),
    "one body": ((CAP, SOIL), {}),
    "coupled": ((PADS, CAP, SOIL), {}),
    "cascade": ((PADS, CAP, SOIL), {"coupling": "cascade"}),
    # stiff friction: the block does not slide
    "coupled, with friction": ((PADS.replace(friction=2.0), CAP, SOIL), {}),
}
RECORD = rf.GroundMotion.sine_pulse("-3.2 m/s^2", "1.6 Hz").with_vertical(
    rf.GroundMotion.sine_pulse("2 m/s^2", "1.6 Hz")
)
MIRRORED = rf.GroundMotion.sine_pulse("3.2 m/s^2", "1.6 Hz").with_vertical(
    rf.GroundMotion.sine_pulse("2 m/s^2", "1.6 Hz")
)
OUTPUTS = ("energy", "acceleration", "reaction", "friction_demand")

TURNED_ROUND = (
    "rotation",
    "horizontal_displacement",
    "base_shear",
    "horizontal_reaction",
    "absolute_horizontal_acceleration",
    "event_rotation",
    "cap_acceleration",
)


def block(eccentricity=0.0):
    return rf.Block(width="0.8 m", height="3 m", mass="5 t", eccentricity=f"{eccentricity} m")


def scene(name, inclination=None, eccentricity=0.0):
    parts, options = SCENES[name]
    return rf.System(block(eccentricity), *parts, inclination=inclination, **options)


@pytest.fixture(scope="module", params=SCENES)
def name(request):
    return request.param


@pytest.fixture(scope="module")
def system(name):
    return scene(name, "3 deg", 0.04)


@pytest.fixture(scope="module")
def response(system):
    return system.simulate(RECORD, free_vibration="1 s", outputs=OUTPUTS, accuracy="reference")


def assert_close(values, expected, name):
    """Compare to nine digits: rest is found by a search, whose last bits are not mirrored."""
    size = np.abs(expected[np.isfinite(expected)]).max()
    np.testing.assert_allclose(values, expected, rtol=1e-9, atol=1e-9 * size, err_msg=name)


def test_mirrored_scene_gives_mirrored_response(name, response):
    other = scene(name, "-3 deg", -0.04).simulate(
        MIRRORED, free_vibration="1 s", outputs=OUTPUTS, accuracy="reference"
    )
    for one in TURNED_ROUND:
        if one in response:
            assert_close(other[one].values, -response[one].values, one)
    for one in ("vertical_displacement", "friction_demand", "potential_energy", "input_energy",
                "event_time", "overturning_angle"):  # fmt: skip
        assert_close(other[one].values, response[one].values, one)
    for one in ("overturning_angle", "peak_rotation"):
        mirrored = response[f"right_{one}"].item()
        assert other[f"left_{one}"].item() == pytest.approx(mirrored, rel=1e-9)


def test_energy_balances_on_slope(system, response):
    assert not response.overturned.item()
    assert response.first_uplift_time.item() > 0.0
    stored = response.kinetic_energy + response.potential_energy + response.elastic_energy
    lost = response.dissipated_energy + response.impact_energy + response.repinning_energy
    balance = (stored + lost - response.input_energy).values
    size = float(response.kinetic_energy.max())
    assert np.abs(balance - balance[0]).max() < 1e-6 * size
    # the ground does no work once still, though gravity along the base continues
    still = response.time.values > RECORD.si.duration + 1e-9
    assert np.ptp(response.horizontal_displacement.values[still]) > 1e-6
    if system.setting.model != "cascade":  # its second stage is excited by the first
        assert np.ptp(response.input_energy.values[still]) < 1e-7 * size


def test_block_stays_at_rest_on_still_slope(system):
    run = system.simulate(duration="1 s", outputs=("energy",))
    rest = system.equilibrium().rest_rotation.item()
    assert rest == run.rotation.values[0]
    theta = run.overturning_angle.item()
    np.testing.assert_allclose(run.rotation.values, rest, atol=1e-10 * theta)
    for one in ("left_reaction", "right_reaction", "soil_reaction"):
        at_rest = system.equilibrium()
        if one in run and f"static_{one}" in at_rest:
            force = at_rest[f"static_{one}"].item()
            np.testing.assert_allclose(run[one].values, force, rtol=1e-8)
    if system.setting.model != "cascade":  # moment_rotation takes a cascade as coupled
        held = system.moment_rotation(([rest], "rad")).restoring_moment.item()
        assert abs(held) < 1e-9 * 5e3 * 9.81 * 3.0


def test_zero_inclination_equals_level_base(name):
    plain, level = scene(name), scene(name, "0 deg")
    assert plain == level
    assert plain.to_dict() == level.to_dict()
    assert plain.describe() == level.describe()
    assert level.setting.compile().rotation_limits == plain.setting.compile().rotation_limits
    runs = [one.simulate(RECORD, outputs=OUTPUTS) for one in (plain, level)]
    xr.testing.assert_identical(runs[0].drop_attrs(), runs[1].drop_attrs())
    assert runs[0].attrs["axes"] == "horizontal and vertical"


def test_tiny_inclination_converges_to_level_base(name):
    level = scene(name, None, 0.04).simulate(RECORD, accuracy="reference")
    almost = scene(name, "1e-9 deg", 0.04).simulate(RECORD, accuracy="reference")
    theta = level.overturning_angle.item()
    np.testing.assert_allclose(almost.rotation.values, level.rotation.values, atol=1e-6 * theta)


def test_inclination_survives_dict_and_netcdf_round_trip(system, response, tmp_path):
    assert rf.System.from_dict(json.loads(json.dumps(system.to_dict()))) == system
    assert f"{system.inclination.m_as('deg'):.6g}" == "3"
    assert "inclination=" in repr(system)
    path = tmp_path / "run.nc"
    response.to_netcdf(path)
    with xr.open_dataset(path) as read:
        again = rf.System.from_dataset(read)
        assert again.options == system.options
        assert read.attrs["inclination"] == f"{math.radians(3.0)!r} rad"
        assert "higher on the right" in read.attrs["axes"]


def test_run_on_slope_can_be_continued(system):
    fine = {"accuracy": 1e-10, "output_step": "10 ms"}
    whole = system.simulate(RECORD, duration="2 s", **fine)
    first = system.simulate(RECORD, duration="1 s", **fine)
    rest = system.simulate(duration="1 s", initial=first, **fine)
    theta = whole.overturning_angle.item()
    assert abs(rest.rotation.values[-1] - whole.rotation.values[-1]) < 1e-6 * theta
    other = scene("pads", "1 deg")
    with pytest.raises(AssemblyError, match="another system"):
        other.simulate(duration="1 s", initial=first)
