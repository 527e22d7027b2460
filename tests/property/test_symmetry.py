"""The mirror image of a scene has the mirror image of its response, bit for bit."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from property.scenarios import RULES, Scenario, scenarios

import rockframe as rf

pytestmark = pytest.mark.property

TURNS_ROUND = {
    "rotation",
    "angular_velocity",
    "horizontal_displacement",
    "relative_rotation",
    "ground_acceleration",
    "ground_acceleration_after_end",
    "base_shear",
    "event_rotation",
    "residual_rotation",
    "angular_velocity_before",
    "angular_velocity_after",
    "overturning_direction",
    "cap_rotation",
    "cap_angular_velocity",
    "rotation_on_cap",
    "cap_acceleration",
    "angular_acceleration",
    "horizontal_velocity",
    "horizontal_acceleration",
    "absolute_horizontal_acceleration",
    "horizontal_reaction",
    "base_overturning_moment",
    "event_horizontal_impulse",
    "point_x",
    "point_horizontal_displacement",
    "point_horizontal_acceleration",
    "rest_rotation",
}
SWAPS_CORNERS = {
    f"{of}contact_state{side}" for of in ("", "soil_") for side in ("", "_before", "_after")
}
SWAPPED = np.array([0, 2, 1, 3])
_OF_A_SIDE = (
    "{}_reaction",
    "static_{}_reaction",
    "{}_overturning_angle",
    "{}_peak_rotation",
)
TRADES_PLACES = {
    name.format(side): name.format(other)
    for name in _OF_A_SIDE
    for side, other in (("left", "right"), ("right", "left"))
}


def assert_mirrored(one, other):
    assert one.sizes == other.sizes
    assert set(one.variables) == set(other.variables)
    for name in one.variables:
        mine = one[TRADES_PLACES.get(name, name)].values
        theirs = other[name].values
        if name in TURNS_ROUND:
            mine = -mine
        elif name in SWAPS_CORNERS:
            mine = SWAPPED[mine]
        np.testing.assert_array_equal(theirs, mine, err_msg=name)
    assert one.attrs["overturned"] == other.attrs["overturned"]
    swap = {"none": "none", "left": "right", "right": "left"}
    assert other.attrs["overturning_direction"] == swap[one.attrs["overturning_direction"]]
    for attribute in ("solver_steps", "solver_rejected_steps", "solver_end_time"):
        assert one.attrs[attribute] == other.attrs[attribute]


CASE = {
    "radius": 5.0,
    "slenderness": 4.0,
    "beta": 20.0,
    "xi": 0.1,
    "rotation": "finite",
    "frequency": 1.0,
    "cycles": 1.0,
}


@given(scenarios())
@example(Scenario(base="leading-corner", peak=0.4, vertical=0.0, **CASE))
@example(Scenario(base="leading-corner", peak=0.4, vertical=0.3, start=0.3, **CASE))
@example(Scenario(base="contact-state", peak=1.0, vertical=0.3, rate=-0.5, **CASE))
@example(Scenario(base="centre", peak=1.0, vertical=0.0, **CASE))
@example(Scenario(base="rigid", peak=1.0, vertical=-0.4, **CASE))
@settings(max_examples=120, deadline=None)
def test_mirrored_motion_and_start_give_the_mirrored_response(scenario):
    options = {"output_step": "10 ms", "outputs": "energy", "overturning": "continue"}
    assert_mirrored(scenario.run(**options), scenario.mirrored.run(**options))


@pytest.mark.parametrize("base", ["rigid", *RULES])
@pytest.mark.parametrize("seed", range(3))
def test_a_mirrored_record_gives_the_mirrored_response(base, seed):
    rng = np.random.default_rng(seed)
    samples = np.convolve(rng.normal(size=400), np.ones(7) / 2.0, mode="same")
    samples *= 7.0 / np.abs(samples).max()
    upwards = np.convolve(rng.normal(size=400), np.ones(3) / 3.0, mode="same")
    system = Scenario(base=base, peak=1.0, vertical=0.0, **CASE).system
    one, other = (
        system.simulate(
            rf.GroundMotion.from_arrays(
                (sign * samples, "m/s^2"), "20 ms", vertical=(upwards, "m/s^2")
            ),
            free_vibration="2 s",
            outputs="energy",
        )
        for sign in (1.0, -1.0)
    )
    assert one.peak_relative_rotation.item() > 0.01
    assert one.sizes["event"] > 2
    assert_mirrored(one, other)


@pytest.mark.parametrize("base", RULES)
@pytest.mark.parametrize("xi", [0.0, 0.2])
def test_purely_vertical_motion_causes_no_rotation(base, xi):
    """Under vertical motion with flights the block never rotates."""
    system = Scenario(base=base, peak=1.0, vertical=0.0, **{**CASE, "xi": xi}).system
    t = np.arange(401) * 0.01
    upwards = 15.0 * np.sin(2.0 * np.pi * t)
    response = system.simulate(
        rf.GroundMotion.from_arrays((np.zeros(401), "m/s^2"), "10 ms", vertical=(upwards, "m/s^2"))
    )
    assert response.flight_time.item() > 0.1
    assert response.impact_count.item() > 0
    for name in ("rotation", "angular_velocity", "horizontal_displacement", "event_rotation"):
        assert (response[name].values == 0.0).all(), name
    np.testing.assert_array_equal(response.left_reaction.values, response.right_reaction.values)
    assert set(response.contact_state.values.tolist()) == {0, 3}
