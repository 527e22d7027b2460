"""Blocks held at a rotation on rigid ground, on pads, and on pads, cap and soil."""

import math
from functools import cache

import numpy as np
import pytest
from analytical.pads import Pads
from analytical.soil import accelerations, at_rest, energies

import rockframe as rf
from rockframe.dynamics.bed import both_contacts
from rockframe.dynamics.pads import CLEAR, CORNER
from rockframe.dynamics.protocol import Start
from rockframe.dynamics.stacked import (
    COORDINATES,
    HORIZONTAL,
    LOWER,
    LOWER_ROTATION,
    LOWER_VERTICAL,
    ROTATION,
    VERTICAL,
)
from rockframe.errors import AssemblyError, ComponentError, UnitsError

pytestmark = pytest.mark.analytical

RULES = ("contact-state", "leading-corner", "centre")
GRAVITY = 9.80665


def held(system, angle):
    return system.moment_rotation(([angle], "rad")).isel(angle=0)


# rigid ground -----------------------------------------------------------------------------------


@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize(("width", "height"), [(2.4, 9.6), (3.0, 3.0)])
def test_restoring_moment_and_reactions_on_rigid_ground(width, height, rotation):
    block = rf.Block(width=f"{width} m", height=f"{height} m", mass="50 t")
    system = rf.System(block, rotation=rotation)
    weight, b, h = 50e3 * GRAVITY, 0.5 * width, 0.5 * height
    theta, radius = math.atan2(b, h), math.hypot(b, h)
    model = system.setting.compile()
    for angle in (1e-12, 0.3 * theta, -0.7 * theta, 0.999 * theta):
        state = held(system, angle)
        side, lean = math.copysign(1.0, angle), abs(angle)
        if rotation == "finite":
            moment = side * weight * (b * math.cos(lean) - h * math.sin(lean))
            rise = b * math.sin(lean) - h * (1.0 - math.cos(lean))
            levelled = side * weight * b * math.cos(lean)
        else:
            moment = side * weight * radius * (theta - lean)
            rise = radius * (theta * lean - 0.5 * lean**2)
            levelled = side * weight * radius * theta
        assert state.restoring_moment.item() == pytest.approx(moment, rel=1e-11)
        assert state.held_vertical_displacement.item() == pytest.approx(rise, rel=1e-11)
        assert state.base_moment.item() == pytest.approx(levelled, rel=1e-11)
        reactions = [state.held_left_reaction.item(), state.held_right_reaction.item()]
        assert reactions == pytest.approx([0.0, weight][:: 1 if side > 0.0 else -1], rel=1e-14)
        assert state.held_contact_state.item() == (2 if side > 0.0 else 1)
        mode, start, _ = model.initial(Start(angle))
        turn = accelerations(model, mode, start)[0]
        corner_inertia = 50e3 * radius**2 * 4.0 / 3.0
        assert turn == pytest.approx(-moment / corner_inertia, rel=1e-11)
    upright = held(system, 0.0)
    assert upright.restoring_moment.item() == 0.0
    assert upright.held_left_reaction.item() == upright.held_right_reaction.item() == 0.5 * weight
    assert upright.held_contact_state.item() == 0


def test_a_block_on_rigid_ground_has_no_modes():
    system = rf.System(rf.Block(width="2 m", height="8 m", mass="50 t"))
    with pytest.raises(AssemblyError, match="rocks"):
        system.frequencies()
    rest = system.equilibrium()
    half = 0.5 * 50e3 * GRAVITY
    assert rest.static_left_reaction.item() == rest.static_right_reaction.item() == half
    assert rest.uplift_angle.item() == 0.0
    assert rest.uplift_moment.item() == pytest.approx(2.0 * half, rel=1e-12)


# pads --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize("pads", [Pads(), Pads(slenderness=1.2, beta=12.0, mu=2.7, gravity=1.62)])
def test_on_pads(pads, rotation, rule):
    system = pads.system(rotation=rotation, restraint=rule)
    model = system.setting.compile()
    small = rotation == "small"
    weight = pads.mass * pads.gravity
    uplift = pads.delta / pads.b if small else math.asin(pads.delta / pads.b)
    rest = system.equilibrium()
    assert rest.uplift_angle.item() == pytest.approx(uplift, rel=1e-13)
    level = 1.0 if small else math.cos(uplift)
    assert rest.uplift_moment.item() == pytest.approx(weight * pads.b * level, rel=1e-12)
    assert rest.pad_settlement.item() == pytest.approx(pads.delta, rel=1e-13)
    for share in (0.5, -0.999, 1.001, -3.0, 8.0):
        angle = share * uplift
        state = held(system, angle)
        sine, cosine = (angle, 1.0) if small else (math.sin(angle), math.cos(angle))
        rise = pads.h * (0.5 * angle**2 if small else 1.0 - math.cos(angle))
        lifted = abs(share) > 1.0
        moment = 2.0 * pads.mass * pads.k * pads.b**2 * sine * cosine
        middle = 0.0
        if lifted:
            moment = math.copysign(weight * pads.b, angle) * cosine
            middle = abs(pads.b * sine) - pads.delta
        assert state.base_moment.item() == pytest.approx(moment, rel=1e-12)
        restoring = moment - weight * pads.h * sine
        assert state.restoring_moment.item() == pytest.approx(restoring, rel=1e-9)
        height = state.held_vertical_displacement.item()
        assert height == pytest.approx(middle - rise, abs=1e-13)
        reactions = state.held_left_reaction.item() + state.held_right_reaction.item()
        assert reactions == pytest.approx(weight, rel=1e-14)
        pin = {"centre": 0.0, "leading-corner": 1.0, "contact-state": float(lifted)}[rule]
        reach = pads.h
        if not small:
            reach *= cosine
            reach += pin * math.copysign(pads.b, angle) * sine
        _, _, turn = at_rest(model, angle, height)
        assert abs(turn[1]) < 1e-11 * pads.gravity
        inertia = pads.mass * (pads.inertia + reach**2)
        assert turn[0] == pytest.approx(-restoring / inertia, rel=1e-9)


# block, pads, cap and soil ------------------------------------------------------------------------

STACKS = {
    "firm": {"soil": "20 MPa", "beta": 20, "cap": ("3.2 m", "0.8 m", "15 t")},
    "soft": {"soil": "5 MPa", "beta": 30, "cap": ("3.6 m", "0.5 m", "30 t")},
    "narrow": {"soil": "30 MPa", "beta": 10, "cap": ("2.4 m", "1.2 m", "8 t")},
    "plate": {"soil": "12 MPa", "beta": 20, "cap": ("2.8 m", "0 m", "5 t")},
}
B, H, M = 1.2, 4.8, 50e3
ANGLES = (1e-4, -0.004, 0.0137, 0.02, -0.04, 0.12, 0.24)


def stack(name, **options):
    parts = STACKS[name]
    width, height, mass = parts["cap"]
    return rf.System(
        rf.Block(width=f"{2 * B} m", height=f"{2 * H} m", mass=f"{M} kg"),
        rf.TwoSpringSupport(frequency_ratio=parts["beta"], damping_ratio=0.1),
        rf.CushionCap(width=width, height=height, mass=mass),
        rf.WinklerSoil(stiffness=parts["soil"], damping_ratio=0.2),
        **options,
    )


@cache
def held_stack(name, angle, rotation, rule):
    """Return a held stack, cached."""
    return Held(name, angle, rotation, rule)


class Held:
    """A stack held at a rotation, with coordinates computed from its published results."""

    def __init__(self, name, angle, rotation, rule):
        self.system = stack(name, rotation=rotation, restraint=rule)
        self.setting = self.system.setting
        self.state = held(self.system, angle)
        cap, soil = self.setting.cap, self.setting.lower.support
        self.small = rotation == "small"
        self.phi = self.state.held_cap_rotation.item()
        self.psi = angle - self.phi
        left, right = self.state.held_left_reaction.item(), self.state.held_right_reaction.item()
        # the corner that bears more gives the settlement of the block on its pads
        bears, side = (right, -1.0) if right >= left else (left, 1.0)
        k = self.setting.upper.support.stiffness
        level = 0.5 * M * GRAVITY / k - bears / k
        self.r = level - side * B * self.sine(self.psi) - H * self.versine(self.psi)
        # the bearing end of the cap: a triangle or a trapezium of pressure
        self.weight = (M + cap.mass) * GRAVITY
        width = 2.0 * cap.half_width
        length = self.state.held_contact_length.item()
        tilt = abs(self.sine(self.phi))
        pressed = self.weight / (length * soil.stiffness) + 0.5 * length * tilt
        sunk = self.weight / (width * soil.stiffness) - pressed
        self.rise = sunk + cap.half_width * tilt - cap.half_height * self.versine(self.phi)
        lifted = abs(right - left) >= (right + left) * (1.0 - 1e-12)
        raised = length < width * (1.0 - 1e-12)
        pins = {
            "centre": (0.0, 0.0),
            "leading-corner": (1.0, 1.0),
            "contact-state": (float(lifted), float(raised)),
        }
        self.block_pin, self.cap_pin = pins["centre" if self.small else rule]
        self.block_pin *= math.copysign(B, self.psi)
        self.cap_pin *= math.copysign(cap.half_width, self.phi)

    def sine(self, angle):
        return angle if self.small else math.sin(angle)

    def versine(self, angle):
        return 0.5 * angle**2 if self.small else 2.0 * math.sin(0.5 * angle) ** 2

    def about(self, pin, height, angle):
        """Return the horizontal distance of the centre of mass from the point held at `pin`."""
        return height * angle if self.small else height * np.sin(angle) - pin * np.cos(angle)

    def places(self, q):
        """Return the centres of mass of cap and block; q may be complex."""
        rise, phi, r, psi = q
        cap = self.setting.cap
        x = self.about(self.cap_pin, cap.half_height, phi)
        along = self.block_pin + self.about(self.block_pin, H, psi)
        arm = cap.half_height + H + r
        return (
            np.array([x, rise]),
            np.array([
                x + arm * np.sin(phi) + along * np.cos(phi),
                rise + arm * np.cos(phi) - along * np.sin(phi),
            ]),
        )  # fmt: skip

    def mass_matrix(self):
        q = np.array([self.rise, self.phi, self.r, self.psi], dtype=complex)
        total = np.zeros((4, 4))
        cap, block = self.setting.cap, self.setting.upper.support.load.body
        for body, mass in ((0, cap.mass), (1, M)):
            slopes = np.empty((2, 4))
            for i in range(4):
                moved = q.copy()
                moved[i] += 1e-30j
                slopes[:, i] = self.places(moved)[body].imag / 1e-30
            total += mass * slopes.T @ slopes
        total[1, 1] += cap.inertia
        total += block.inertia * np.outer([0, 1, 0, 1], [0, 1, 0, 1])
        return total

    def moves(self):
        """Return mode and state of the equations of motion at rest in this position."""
        model = self.setting.compile()
        system = model.system
        x = np.zeros(2 * COORDINATES)
        x[LOWER_VERTICAL], x[LOWER_ROTATION] = self.rise, self.phi
        x[VERTICAL], x[ROTATION] = self.r, self.psi
        x[HORIZONTAL] = self.block_pin + self.about(self.block_pin, H, self.psi)
        free = [
            int(self.state[f"held_{side}_reaction"].item() <= 0.0) for side in ("left", "right")
        ]
        whole = self.state.held_contact_length.item() >= 2.0 * self.setting.cap.half_width
        ends = [int(not whole and self.phi > 0.0), int(not whole and self.phi < 0.0)]
        states = system.states_in(x)
        block = system.upper.mode_for_contact(
            CLEAR * free[0] + CORNER * CLEAR * free[1], states.upper
        )
        cap = system.lower.mode_for_contact(both_contacts(*ends), states.lower)
        return model, system.with_body_mode(system.upper.number_of(block), LOWER, cap), x


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize("name", STACKS)
def test_released_stack_accelerates_by_holding_couple(name, rotation, rule):
    """After release, M q'' is minus the couple, which does work on phi + psi only."""
    for angle in ANGLES:
        one = held_stack(name, angle, rotation, rule)
        model, mode, x = one.moves()
        order = [LOWER_VERTICAL, LOWER_ROTATION, VERTICAL, ROTATION]
        found = one.mass_matrix() @ accelerations(model, mode, x)[order]
        couple = one.state.restoring_moment.item()
        scale = np.array([one.weight, one.weight * H, one.weight, one.weight * H])
        np.testing.assert_allclose(
            found / scale, np.array([0.0, -couple, 0.0, -couple]) / scale, atol=1e-11
        )


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize("name", STACKS)
def test_forces_and_moments_of_held_stack_balance(name, rotation, rule):
    """Forces by hand: weights against the soil, the block's weight against the pads."""
    for angle in ANGLES:
        one = held_stack(name, angle, rotation, rule)
        state, cap = one.state, one.setting.cap
        assert state.held_soil_reaction.item() == pytest.approx(one.weight, rel=1e-13)
        pads = state.held_left_reaction.item() + state.held_right_reaction.item()
        assert pads == pytest.approx(M * GRAVITY * math.cos(one.phi), rel=1e-12)
        # both weights about the middle of the cap's base, which lies h_c sin(phi) behind
        q = [one.rise, one.phi, one.r, one.psi]
        centre, block = one.places(q)
        base = centre[0] - cap.half_height * one.sine(one.phi)
        lean = GRAVITY * (cap.mass * (centre[0] - base) + M * (block[0] - base))
        expected = state.base_moment.item() - lean
        if rotation == "finite":
            assert state.restoring_moment.item() == pytest.approx(
                expected, rel=1e-9, abs=1e-9 * one.weight
            )
        _, rest = one.places([0.0, 0.0, 0.0, 0.0])
        height = state.held_vertical_displacement.item()
        assert height == pytest.approx(block[1] - rest[1], abs=1e-12)
        assert 0.0 < one.phi / angle < 1.0
        length = state.held_contact_length.item()
        assert 0.0 < length <= 2.0 * cap.half_width


@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize("name", STACKS)
def test_the_couple_on_a_stack_is_the_slope_of_its_energy(name, rotation):
    def stored(angle):
        model, mode, x = Held(name, angle, rotation, "centre").moves()
        _, gravity, _, elastic = energies(model, mode, x)
        return M * (gravity + elastic)

    for angle in (0.002, -0.03, 0.15):
        step = 1e-4 * abs(angle)
        slope = (stored(angle + step) - stored(angle - step)) / (2.0 * step)
        couple = held(stack(name, rotation=rotation, restraint="centre"), angle).restoring_moment
        assert slope == pytest.approx(couple.item(), rel=1e-6)


@pytest.mark.parametrize("name", STACKS)
def test_small_rotation_stiffness_of_stack_is_series_of_pads_and_soil(name):
    system = stack(name)
    _, _, stiffness = _matrices(system)
    # the block is held: phi, r and Y are free
    free = stiffness[1, 1]
    # in block rotation alpha = phi + psi: eliminate phi at given alpha
    k_aa = stiffness[3, 3]
    k_ap = stiffness[1, 3] - stiffness[3, 3]
    k_pp = free - 2.0 * stiffness[1, 3] + stiffness[3, 3]
    expected = k_aa - k_ap**2 / k_pp
    angle = 1e-7
    state = held(system, angle)
    assert state.restoring_moment.item() / angle == pytest.approx(expected, rel=1e-6)
    assert state.held_cap_rotation.item() / angle == pytest.approx(-k_ap / k_pp, rel=1e-6)


def _matrices(system):
    block, cap = system.setting.upper.support.load.body, system.setting.cap
    pads, soil = system.setting.upper.support.stiffness, system.setting.lower.support.stiffness
    lifting = GRAVITY * (cap.mass * cap.half_height + block.mass * (2 * cap.half_height + H))
    k = np.zeros((4, 4))
    k[1, 1] = soil * cap.half_width**3 / 1.5 - lifting
    k[3, 3] = 2.0 * pads * B**2 - GRAVITY * block.mass * H
    k[1, 3] = k[3, 1] = -GRAVITY * block.mass * H
    return None, None, k


@pytest.mark.parametrize("coupling", ["coupled", "cascade"])
def test_the_static_state_does_not_depend_on_the_coupling(coupling):
    one = stack("soft").moment_rotation(([0.01, -0.1], "rad"))
    other = stack("soft", coupling=coupling).moment_rotation(([0.01, -0.1], "rad"))
    for name in one.data_vars:
        np.testing.assert_array_equal(one[name].values, other[name].values)


def scenes():
    block = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
    squat = rf.Block(width="4 m", height="4 m", mass="50 t")
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    cap = rf.CushionCap(width="4.5 m", height="0.5 m", mass="12 t")
    soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
    for body in (block, squat):
        yield (body,)
        yield (body, pads)
        yield (body, soil)
        yield (body, cap, soil)
        yield (body, pads, cap, soil)


@pytest.mark.parametrize("parts", list(scenes()))
@pytest.mark.parametrize("rotation", ["small", "finite"])
def test_static_state_exists_for_all_rotations_below_right_angle(parts, rotation):
    system = rf.System(*parts, rotation=rotation)
    angles = np.linspace(-1.5, 1.5, 61)
    state = system.moment_rotation((angles, "rad"))
    for name, row in state.items():
        assert np.isfinite(row.values).all(), name
    # quantities odd in the rotation
    for name in ("restoring_moment", "base_moment", "held_cap_rotation"):
        if name in state:
            np.testing.assert_allclose(state[name], -state[name][::-1], rtol=1e-9, atol=1e-6)
    height = state.held_vertical_displacement
    np.testing.assert_allclose(height, height[::-1], rtol=1e-9, atol=1e-12)
    if "held_left_reaction" in state:
        np.testing.assert_allclose(
            state.held_left_reaction, state.held_right_reaction[::-1], rtol=1e-9, atol=1e-6
        )
    if rotation == "finite":
        beyond = np.abs(angles) > 1.05 * system.equilibrium().overturning_angle.item()
        assert (state.restoring_moment.values * angles < 0.0)[beyond].all()


@pytest.mark.parametrize("parts", list(scenes()))
def test_upright_state_needs_no_holding_couple(parts):
    state = held(rf.System(*parts), 0.0)
    for name in ("restoring_moment", "base_moment", "held_vertical_displacement"):
        assert state[name].item() == 0.0
        assert not np.signbit(state[name].item()), f"{name} is written -0.0"
    assert state.held_contact_state.item() == 0


def test_angles_come_in_any_unit_and_shape():
    system = stack("firm")
    one = system.moment_rotation(([0.0, 1.0, -2.0], "deg"))
    other = system.moment_rotation([f"{math.radians(x)!r} rad" for x in (0.0, 1.0, -2.0)])
    np.testing.assert_allclose(one.restoring_moment, other.restoring_moment, rtol=1e-13)
    np.testing.assert_allclose(one.angle, np.radians([0.0, 1.0, -2.0]), rtol=1e-15)
    for bad in (0.1, [0.1], ([0.1], "m"), "0.1", "1 m", None):
        with pytest.raises(UnitsError, match="angles"):
            system.moment_rotation(bad)
    with pytest.raises(ComponentError, match="angles"):
        system.moment_rotation("nan rad")
