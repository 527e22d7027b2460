"""A body held at a rotation on a bed: uplift, moment and contact length in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest
from analytical.soil import Bed, at_rest, energies

import rockframe as rf

pytestmark = pytest.mark.analytical

RULES = ("contact-state", "leading-corner", "centre")
SEPARATIONS = ("displacement", "pressure")
BEDS = [
    Bed(),
    Bed(half_width=0.9, half_height=1.1, stiffness=400.0, mu=2.6, mass=1e3),
    Bed(half_width=3.0, half_height=12.0, stiffness=900.0, gravity=1.62),
]
RATIOS = {1.0: 0.333333, 2.0: 0.528595, 4.0: 0.666667, 10.0: 0.789181, 100.0: 0.933333}
"""Moment over m g b at rotations over that of uplift, as printed."""


def held(system, angles):
    return system.moment_rotation((list(angles), "rad"))


def numerical_bed(bed, sine, cosine):
    """Integrate a bed of 20 000 strips that carries the weight, numerically."""
    s = (np.arange(20000) + 0.5) / 10000.0 * bed.half_width - bed.half_width

    def force(middle):
        pressed = np.maximum(bed.delta - (middle - s * sine), 0.0)
        return bed.stiffness * pressed * 1e-4 * bed.half_width

    low, high = -10.0 * bed.half_width, 10.0 * bed.half_width
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if force(middle).sum() > bed.gravity else (low, middle)
    share = force(middle)
    return middle, float((share * s).sum() * cosine), float((share > 0.0).mean())


# closed forms ---------------------------------------------------------------------------------


@pytest.mark.parametrize("bed", BEDS)
def test_uplift_begins_at_a_third_of_the_weight_times_half_the_width(bed):
    for rotation in ("small", "finite"):
        system = bed.system(rotation=rotation)
        rest = system.equilibrium()
        ratio = bed.delta / bed.half_width
        angle = ratio if rotation == "small" else math.asin(ratio)
        level = 1.0 if rotation == "small" else math.cos(angle)
        assert rest.uplift_angle.item() == pytest.approx(angle, rel=1e-14)
        third = bed.weight * bed.half_width / 3.0
        assert rest.uplift_moment.item() == pytest.approx(third * level, rel=1e-12)
        assert rest.soil_settlement.item() == pytest.approx(bed.delta, rel=1e-14)
        assert rest.static_soil_reaction.item() == pytest.approx(bed.weight, rel=1e-14)
        for factor, lifted in ((1.0 - 1e-9, False), (1.0 + 1e-9, True)):
            state = held(system, [factor * angle, -factor * angle])
            states = state.held_contact_state.values.tolist()
            assert states == ([2, 1] if lifted else [0, 0])


@pytest.mark.parametrize("bed", BEDS)
@pytest.mark.parametrize(("ratio", "printed"), RATIOS.items())
def test_moment_and_contact_length_after_uplift(bed, ratio, printed):
    system = bed.system(rotation="small")
    uplift = bed.delta / bed.half_width
    for side in (1.0, -1.0):
        state = held(system, [side * ratio * uplift]).isel(angle=0)
        moment = state.base_moment.item() / (bed.weight * bed.half_width)
        assert moment == pytest.approx(side * (1.0 - 2.0 / 3.0 / math.sqrt(ratio)), rel=1e-12)
        assert abs(moment) == pytest.approx(printed, abs=6e-7)
        length = state.held_contact_length.item() / (2.0 * bed.half_width)
        assert length == pytest.approx(1.0 / math.sqrt(ratio), rel=1e-12)
        assert state.held_soil_reaction.item() == pytest.approx(bed.weight, rel=1e-14)
        lean = bed.weight * bed.half_height * side * ratio * uplift
        assert state.restoring_moment.item() == pytest.approx(
            state.base_moment.item() - lean, rel=1e-9, abs=1e-12 * bed.weight
        )


@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize("bed", BEDS)
def test_moment_before_uplift_is_that_of_full_contact(bed, rotation):
    system = bed.system(rotation=rotation)
    shares = np.array([-0.99, -0.4, -1e-9, 0.0, 1e-12, 0.3, 0.999])
    angles = shares * bed.delta / bed.half_width
    state = held(system, angles)
    turning = angles if rotation == "small" else np.sin(angles) * np.cos(angles)
    expected = bed.mass * bed.stiffness * bed.half_width**3 / 1.5 * turning
    np.testing.assert_allclose(state.base_moment, expected, rtol=1e-13)
    np.testing.assert_array_equal(state.held_contact_length, 2.0 * bed.half_width)
    rise = 0.5 * angles**2 if rotation == "small" else 1.0 - np.cos(angles)
    height = -bed.half_height * rise
    np.testing.assert_allclose(state.held_vertical_displacement, height, atol=1e-15)


@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize("bed", BEDS)
def test_against_many_strips(bed, rotation):
    system = bed.system(rotation=rotation)
    for angle in (0.5 * bed.delta / bed.half_width, 0.02, 0.2, 0.6):
        sine, cosine = (angle, 1.0) if rotation == "small" else (math.sin(angle), math.cos(angle))
        rise = 0.5 * angle**2 if rotation == "small" else 1.0 - math.cos(angle)
        middle, moment, share = numerical_bed(bed, sine, cosine)
        state = held(system, [angle]).isel(angle=0)
        found = state.held_vertical_displacement.item() + bed.half_height * rise
        assert found == pytest.approx(middle, abs=1e-8 * bed.half_width)
        assert state.base_moment.item() == pytest.approx(bed.mass * moment, rel=1e-6)
        length = state.held_contact_length.item() / (2.0 * bed.half_width)
        assert length == pytest.approx(share, abs=2e-4)


def test_moment_vanishes_at_overturning_angle_on_firm_soil():
    firm = replace(Bed(), stiffness=1e7)
    theta = math.atan(firm.half_width / firm.half_height)
    low, high = 0.9 * theta, theta
    for _ in range(60):
        middle = 0.5 * (low + high)
        back = held(firm.system(), [middle]).restoring_moment.item() > 0.0
        low, high = (middle, high) if back else (low, middle)
    # the contact is 2 sqrt(b delta/sin theta) long, and its force acts at a third of that from
    # the end
    short = 2.0 / 3.0 * math.sqrt(firm.half_width * firm.delta / math.sin(theta))
    assert middle == pytest.approx(
        math.atan((firm.half_width - short) / firm.half_height), rel=1e-6
    )


def test_block_and_cap_stand_as_one_body():
    block = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
    cap = rf.CushionCap(width="3.2 m", height="0.7 m", mass="16 t")
    soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.15)
    system = rf.System(block, cap, soil, rotation="small")
    weight = 66e3 * 9.80665
    settled = weight / (3.2 * 9e6)
    rest = system.equilibrium()
    assert rest.soil_settlement.item() == pytest.approx(settled, rel=1e-14)
    assert rest.uplift_moment.item() == pytest.approx(weight * 1.6 / 3.0, rel=1e-12)
    height = (50e3 * 5.5 + 16e3 * 0.35) / 66e3
    assert rest.overturning_angle.item() == pytest.approx(math.atan(1.6 / height), rel=1e-13)
    angle = 4.0 * settled / 1.6
    state = held(system, [angle]).isel(angle=0)
    assert state.base_moment.item() == pytest.approx(weight * 1.6 * 2.0 / 3.0, rel=1e-12)
    lean = weight * height * angle
    assert state.restoring_moment.item() == pytest.approx(state.base_moment.item() - lean, rel=1e-9)


# the equations of motion at rest ------------------------------------------------------------------


@pytest.mark.parametrize("separation", SEPARATIONS)
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize("bed", BEDS)
def test_the_equations_of_motion_balance_at_the_static_state(bed, rotation, rule, separation):
    """A held body that is released only rotates, accelerated by the moment."""
    system = replace(bed, separation=separation).system(rotation=rotation, restraint=rule)
    model = system.setting.compile()
    uplift = bed.delta / bed.half_width
    for angle in (0.5 * uplift, -uplift, 2.0 * uplift, -4.0 * uplift, 10.0 * uplift, 0.3):
        state = held(system, [angle]).isel(angle=0)
        height = state.held_vertical_displacement.item()
        _, _, turn = at_rest(model, angle, height)
        assert abs(turn[1]) < 1e-11 * bed.gravity
        lifted = abs(angle) > uplift
        pin = {"centre": 0.0, "leading-corner": 1.0, "contact-state": float(lifted)}[rule]
        reach = bed.half_height
        if rotation == "finite":
            reach *= math.cos(angle)
            reach += pin * math.copysign(bed.half_width, angle) * math.sin(angle)
        inertia = bed.mass * (bed.inertia + reach**2)
        expected = -state.restoring_moment.item() / inertia
        assert turn[0] == pytest.approx(expected, rel=1e-9, abs=1e-11)
        # the run also starts there
        _, equilibrium, _ = at_rest(model, angle, None)
        assert equilibrium[1] == pytest.approx(height, rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize("bed", BEDS)
def test_the_moment_is_the_slope_of_the_energy(bed, rotation):
    """The work of the holding couple, without equations of motion."""
    system = bed.system(rotation=rotation)
    model = system.setting.compile()

    def stored(angle):
        mode, state, _ = at_rest(model, angle, None)
        _, gravity, _, elastic = energies(model, mode, state)
        return bed.mass * (gravity + elastic)

    uplift = bed.delta / bed.half_width
    for angle in (0.3 * uplift, 1.5 * uplift, -3.0 * uplift, 0.25, -0.5):
        step = 1e-4 * abs(angle)
        slope = (stored(angle + step) - stored(angle - step)) / (2.0 * step)
        moment = held(system, [angle]).restoring_moment.item()
        assert slope == pytest.approx(moment, rel=1e-6, abs=1e-7 * bed.weight * bed.half_width)


@pytest.mark.parametrize("rotation", ["small", "finite"])
def test_moment_vanishes_at_neutral_soil_stiffness(rotation):
    """On soil just stiff enough the upright body is in neutral equilibrium up to second order."""
    bed = Bed()
    limit = 1.5 * bed.gravity * bed.half_height / bed.half_width**3
    neutral = replace(bed, stiffness=limit * (1.0 + 1e-12))
    system = neutral.system(rotation=rotation)
    moment = held(system, [1e-4]).restoring_moment.item()
    assert abs(moment) < 1e-7 * bed.weight * bed.half_height * 1e-4


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("bed", BEDS)
def test_a_run_starts_in_vertical_equilibrium(bed, rule):
    system = bed.system(restraint=rule)
    for share in (0.3, -0.999, 1.001, -3.0):
        angle = share * bed.delta / bed.half_width
        response = system.simulate(
            duration="1 ms", initial=rf.InitialState(rotation=f"{angle!r} rad")
        ).isel(time=0)
        state = held(system, [angle]).isel(angle=0)
        for name, static in {
            "soil_reaction": "held_soil_reaction",
            "contact_length": "held_contact_length",
            "contact_state": "held_contact_state",
        }.items():
            assert response[name].item() == pytest.approx(state[static].item(), rel=1e-11), name


def test_accelerations_of_a_block_at_rest_vanish():
    for bed in BEDS:
        model = bed.system().setting.compile()
        _, _, turn = at_rest(model, 0.0, None)
        assert turn[0] == turn[2] == 0.0
        assert abs(turn[1]) < 1e-15 * bed.gravity
