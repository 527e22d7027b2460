"""Blocks with an eccentric centre of mass, in closed form."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import rockframe as rf
from rockframe.errors import AssemblyError, ModelWarning

pytestmark = pytest.mark.analytical

G = 9.80665
MASS, INERTIA = 50e3, 500e3
B, H, E = 1.2, 4.0, 0.3
WEIGHT = MASS * G
BLOCK = rf.Block(
    width="2.4 m",
    height="9.6 m",
    mass="50 t",
    inertia="500000 kg m^2",
    centre_of_mass=("4 m", "0.3 m"),
)
PADS = rf.TwoSpringSupport(stiffness="16 MN/m", damping="200 kN s/m")
CAP = rf.CushionCap(width="3.2 m", height="0.4 m", mass="10 t")
SOIL = rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1)
K, K0 = 16e6, 30e6
SCENES = {
    "rigid ground": (BLOCK,),
    "pads": (BLOCK, PADS),
    "soil": (BLOCK, SOIL),
    "one body": (BLOCK, CAP, SOIL),
    "coupled": (BLOCK, PADS, CAP, SOIL),
    "cascade": (BLOCK, PADS, CAP, SOIL),
}
PULSE = rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz").with_vertical(
    rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
)
RIGHT, LEFT = 1, -1
TOPPLED = 2


def scene(name, **options):
    if name == "cascade":
        options["coupling"] = "cascade"
    return rf.System(*SCENES[name], **options)


class Corner:
    """A corner of the block, by its distance from the foot of the centre of mass."""

    def __init__(self, side):
        self.side = side
        self.distance = B - side * E
        self.theta = math.atan(self.distance / H)
        self.radius = math.hypot(self.distance, H)
        self.inertia = INERTIA + MASS * self.radius**2
        self.p = math.sqrt(WEIGHT * self.radius / self.inertia)

    @property
    def restitution(self):
        """Restitution of an impact on this corner, from rotation about the other one."""
        other = Corner(-self.side)
        # the centre of mass has the velocity (H, -distance) per rate about the other corner
        transferred = INERTIA + MASS * (H * H - self.distance * other.distance)
        return transferred / self.inertia


def rectangle(acceleration, duration):
    return rf.GroundMotion.from_arrays(
        (np.full(2, acceleration), "m/s^2"), f"{float(duration)!r} s"
    )


def shaken(acceleration, duration, **options):
    """Shake the linearised block towards the side of the acceleration's sign."""
    return scene("rigid ground", rotation="small").simulate(
        rectangle(-acceleration, duration),
        free_vibration="40 s",
        accuracy="reference",
        outputs=None,
        **options,
    )


# rigid ground -----------------------------------------------------------------------------------


def test_uplift_to_either_side():
    for rotation in ("small", "finite"):
        system = scene("rigid ground", rotation=rotation)
        for side in (LEFT, RIGHT):
            corner = Corner(side)
            uplift = G * (corner.theta if rotation == "small" else math.tan(corner.theta))
            for factor, lifts in ((1.0 - 1e-9, False), (1.0 + 1e-9, True)):
                response = system.simulate(rectangle(-side * uplift * factor, 1.0))
                assert (response.sizes["event"] > 0) == lifts
            assert np.sign(response.rotation.values[-1]) == side
            # a long pulse overturns every block that it lifts
            toppled = system.simulate(rectangle(-side * uplift * (1.0 + 1e-6), 60.0))
            assert toppled.overturning_direction.item() == side


@pytest.mark.parametrize(("side", "word"), [(LEFT, "left"), (RIGHT, "right")])
def test_relative_rotation_uses_overturning_angle_of_its_side(side, word):
    uplift = G * math.tan(Corner(side).theta)
    run = scene("rigid ground").simulate(rectangle(-side * 1.3 * uplift, 0.4))
    assert run.overturned.item() == 0
    rotation = run.rotation.values
    assert side * rotation[-1] > 0.0
    expected = rotation / Corner(side).theta
    np.testing.assert_allclose(run.relative_rotation, expected, rtol=1e-12)
    peak = np.abs(expected).max()
    assert run.peak_relative_rotation.item() == pytest.approx(peak, rel=1e-9)
    assert f"{100.0 * peak:.3g} % of the overturning angle to the {word};" in run.attrs["verdict"]


def test_overturning_by_a_rectangular_pulse_to_either_side():
    """(A/theta - 1)(exp(p t) - 1) = 1, with angle and frequency of the pivot corner."""
    for side in (LEFT, RIGHT):
        corner = Corner(side)
        for length in (0.4, 1.0, 3.0):
            threshold = G * corner.theta / (1.0 - math.exp(-length))
            above, below = (
                shaken(side * threshold * factor, length / corner.p, overturning="continue")
                for factor in (1.0 + 1e-7, 1.0 - 1e-7)
            )
            assert above.status.item() == TOPPLED
            assert above.overturning_direction.item() == side
            assert above.impact_count.item() == 0
            assert below.impact_count.item() > 0
            peak = (below.left_peak_rotation, below.right_peak_rotation)[side == RIGHT]
            assert peak.item() < corner.theta


def test_critical_scales_to_either_side():
    """By energy: s (s - 1) = share/(2 cosh p t - 2), of the energy that overturns to that side."""
    system = scene("rigid ground", rotation="small")
    left, right = Corner(LEFT), Corner(RIGHT)
    # falling back from the left it overturns to the right before it does so to the left
    back = (right.p * right.theta / (right.restitution * left.p * left.theta)) ** 2
    for side, share in ((LEFT, back), (RIGHT, 1.0)):
        corner = Corner(side)
        pulse = rectangle(-side * G * corner.theta, 1.5 / corner.p)
        found = rf.critical_scale(
            system, pulse, bracket_width=1e-8, free_vibration="30 s", accuracy="reference"
        )
        assert found.uplift_scale.item() == pytest.approx(1.0, rel=1e-12)
        threshold = 0.5 + math.sqrt(0.25 + 0.5 * share / (math.cosh(1.5) - 1.0))
        assert found.critical_scale.item() == pytest.approx(threshold, rel=1e-7)
        assert found.sizes["flip"] == 1


def test_swing_back_from_far_side_overturns_to_near_side():
    """By energy: a swing from rest at a0, an impact, and a swing up to theta."""
    left, right = Corner(LEFT), Corner(RIGHT)
    needed = (right.p * right.theta / (right.restitution * left.p)) ** 2
    start = left.theta - math.sqrt(left.theta**2 - needed)
    assert 0.2 < start / left.theta < 0.9
    system = scene("rigid ground", rotation="small")
    for factor, falls in ((1.0 - 1e-6, False), (1.0 + 1e-6, True)):
        response = system.simulate(
            duration="60 s",
            initial=rf.InitialState(rotation=f"{-start * factor!r} rad"),
            accuracy="reference",
        )
        assert response.overturned.item() == falls
        if falls:
            assert response.impact_count.item() == 1
            assert response.overturning_direction.item() == RIGHT
        else:
            assert response.right_peak_rotation.item() == pytest.approx(right.theta, rel=2e-3)
            assert response.left_peak_rotation.item() == pytest.approx(start, rel=2e-6)
            assert response.peak_relative_rotation.item() == pytest.approx(
                response.right_peak_rotation.item() / right.theta, rel=1e-12
            )


def test_free_rocking():
    """Housner's quarter periods about either corner, and the speeds after impacts."""
    for side, share in ((LEFT, 0.1), (RIGHT, 0.6)):
        now = Corner(side)
        response = scene("rigid ground", rotation="small").simulate(
            duration="14 s",
            initial=rf.InitialState(rotation=f"{side * share * now.theta!r} rad"),
            accuracy="reference",
        )
        impacts = response.event_kind.values == 2
        times = response.event_time.values[impacts]
        before = response.angular_velocity_before.values[impacts]
        after = response.angular_velocity_after.values[impacts]
        assert times.size > 8
        expected = math.acosh(1.0 / (1.0 - share)) / now.p
        speed = now.p * now.theta * math.sqrt(1.0 - (1.0 - share) ** 2)
        for i in range(times.size):
            assert times[i] == pytest.approx(expected, rel=1e-8)
            assert before[i] == pytest.approx(-now.side * speed, rel=1e-7)
            now = Corner(-now.side)
            speed *= now.restitution
            assert after[i] == pytest.approx(now.side * speed, rel=1e-7)
            expected += 2.0 / now.p * math.atanh(speed / (now.p * now.theta))
        # a full cycle retains the product of both
        product = Corner(LEFT).restitution * Corner(RIGHT).restitution
        np.testing.assert_allclose(before[2:] / before[:-2], product, rtol=1e-8)


def test_impact_energy_loss_in_closed_form():
    response = scene("rigid ground").simulate(
        duration="5 s", initial=rf.InitialState(rotation="-0.2 rad"), outputs="energy",
        output_step="1 ms", accuracy="reference",
    )  # fmt: skip
    impacts = response.event_kind.values == 2
    before = response.angular_velocity_before.values[impacts]
    lost, side = 0.0, LEFT
    for speed in before:
        old, new = Corner(side), Corner(-side)
        lost += 0.5 * (old.inertia - new.restitution**2 * new.inertia) * speed**2
        side = -side
    assert response.impact_energy.values[-1] == pytest.approx(lost, rel=1e-9)
    # the gravity barrier to the left
    barrier = WEIGHT * Corner(LEFT).radius * (
        math.cos(Corner(LEFT).theta - 0.2) - math.cos(Corner(LEFT).theta)
    )  # fmt: skip
    assert response.potential_energy.values[0] == pytest.approx(barrier, rel=1e-12)


def test_position_of_fallen_block():
    """The height of its centre of mass is then its distance from the corner."""
    for side in (LEFT, RIGHT):
        corner = Corner(side)
        response = scene("rigid ground").simulate(
            rectangle(-side * 8.0, 1.0), free_vibration="10 s", overturning="continue"
        )
        assert response.status.item() == TOPPLED
        assert response.rotation.values[-1] == pytest.approx(side * 0.5 * math.pi, rel=1e-9)
        fallen = response.vertical_displacement.values[-1]
        assert fallen == pytest.approx(corner.distance - H, rel=1e-9)
        aside = response.horizontal_displacement.values[-1]
        assert aside == pytest.approx(side * (corner.distance + H), rel=1e-9)
        peaks = response.left_peak_rotation.item(), response.right_peak_rotation.item()
        assert peaks[side == RIGHT] == pytest.approx(0.5 * math.pi, rel=1e-9)
        assert peaks[side == LEFT] < 1e-12


def test_reactions_at_rest_on_rigid_ground():
    for rotation in ("finite", "small"):
        system = scene("rigid ground", rotation=rotation)
        rest = system.equilibrium()
        response = system.simulate(rectangle(0.5, 1.0))
        left, right = response.left_reaction.values, response.right_reaction.values
        np.testing.assert_allclose(left + right, WEIGHT, rtol=1e-14)
        if rotation == "finite":
            # moments about the foot of the centre of mass
            turning = right * (B - E) - left * (B + E)
            pushed = -MASS * H * response.ground_acceleration.values
            np.testing.assert_allclose(turning, pushed, atol=1e-9 * WEIGHT)
        still = system.simulate(duration="0.1 s")
        for side in ("left", "right"):
            static = rest[f"static_{side}_reaction"].item()
            assert still[f"{side}_reaction"].values == pytest.approx(static, rel=1e-14)
    rest = scene("rigid ground").equilibrium()
    assert rest.static_left_reaction.item() == pytest.approx(WEIGHT * (B - E) / (2 * B))


# rest on pads and soil ------------------------------------------------------------------------


def assert_at_rest(system, rotation, vertical):
    """Check that an undisturbed run stays at its initial equilibrium."""
    rest = system.equilibrium()
    assert rest.rest_rotation.item() == pytest.approx(rotation, rel=1e-12)
    response = system.simulate(duration="3 s", points={"left": ("-1.2 m", "0 m")})
    np.testing.assert_allclose(response.rotation, rotation, rtol=1e-11)
    np.testing.assert_allclose(response.vertical_displacement, vertical, rtol=1e-10, atol=1e-16)
    assert response.sizes["event"] == 0
    assert response.residual_rotation.item() == pytest.approx(rotation, rel=1e-11)
    return rest, response


def test_tilted_rest_on_pads():
    """Forces and moments by two linear equations, in y + h a^2/2 and a."""
    matrix = np.array([[2.0 * K, 2.0 * K * E], [2.0 * K * E, K * ((B + E) ** 2 + (B - E) ** 2)]])
    matrix[1, 1] -= WEIGHT * H
    delta = 0.5 * WEIGHT / K
    level, angle = np.linalg.solve(matrix, [0.0, 2.0 * K * delta * E])
    rest, response = assert_at_rest(
        scene("pads", rotation="small"), angle, level - 0.5 * H * angle**2
    )
    left = K * (delta - level - (B + E) * angle)
    assert rest.static_left_reaction.item() == pytest.approx(left, rel=1e-12)
    assert rest.static_right_reaction.item() == pytest.approx(WEIGHT - left, rel=1e-12)
    np.testing.assert_allclose(response.left_reaction, left, rtol=1e-10)
    # the middle of the base has not moved, its left end has risen
    assert response.residual_settlement.item() == pytest.approx(0.0, abs=1e-15)
    corner = response.sel(point="left")
    np.testing.assert_allclose(corner.point_vertical_displacement, B * angle, rtol=1e-10)
    np.testing.assert_allclose(corner.point_vertical_acceleration, 0.0, atol=1e-10)


def test_tilted_rest_on_pads_by_finite_rotation():
    delta = 0.5 * WEIGHT / K

    def residual(angle):
        sine, cosine = math.sin(angle), math.cos(angle)
        return B * B * sine * cosine / delta - H * sine - E * cosine

    angle = brentq(residual, 0.0, 0.05, xtol=1e-16)
    rise = -H * (1.0 - math.cos(angle)) - E * math.sin(angle)
    _, response = assert_at_rest(scene("pads"), angle, rise)
    corner = response.sel(point="left")
    np.testing.assert_allclose(corner.point_vertical_displacement, B * math.sin(angle), rtol=1e-10)
    assert response.residual_settlement.item() == pytest.approx(0.0, abs=1e-15)


def test_tilted_rest_on_soil():
    """Full contact, and, on softer soil, a triangle of pressure under part of the base."""
    full = WEIGHT * E / (K0 * (2.0 * B) ** 3 / 12.0 - WEIGHT * H)
    delta = WEIGHT / (2.0 * B * K0)
    assert B * full < delta
    rest, response = assert_at_rest(
        scene("soil", rotation="small"), full, -0.5 * H * full**2 - E * full
    )
    assert rest.static_soil_reaction.item() == pytest.approx(WEIGHT, rel=1e-13)
    np.testing.assert_allclose(response.contact_length, 2.0 * B, rtol=1e-14)
    far = rf.Block(
        width="2.4 m", height="9.6 m", mass="50 t", centre_of_mass=("4 m", "-0.55 m")
    )  # fmt: skip
    length = 2.0 * B * math.sqrt(delta / B)  # times 1/sqrt(rotation)
    part = brentq(
        lambda a: (B - 0.55 - length / math.sqrt(a) / 3.0) - H * a, delta / B, 0.04, xtol=1e-17
    )
    raised = (math.sqrt(B * part) - math.sqrt(delta)) ** 2
    system = rf.System(far, SOIL, rotation="small")
    _, response = assert_at_rest(system, -part, raised - 0.5 * H * part**2 - 0.55 * part)
    np.testing.assert_allclose(response.contact_length, length / math.sqrt(part), rtol=1e-10)
    assert response.residual_settlement.item() == pytest.approx(-raised, rel=1e-9)


def test_a_base_that_is_too_soft_is_refused():
    """The moment of pads is greatest when a corner lifts, at a = delta/b, with lever b - h a."""
    limit = WEIGHT * H / (2.0 * B * (B - E))
    for factor, holds in ((1.02, True), (0.98, False)):
        pads = rf.TwoSpringSupport(stiffness=f"{limit * factor!r} N/m", damping_ratio=0.1)
        if holds:
            with pytest.warns(ModelWarning, match="at rest the body leans by"):
                system = rf.System(BLOCK, pads, rotation="small")
            lean = system.equilibrium().rest_rotation.item()
            assert lean == pytest.approx(E / (B * B * 2.0 * limit * factor / WEIGHT - H))
        else:
            with pytest.raises(AssemblyError, match="falls to the right by its own weight"):
                rf.System(BLOCK, pads, rotation="small")


# statics ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("slope", ["0 deg", "1 deg"])
def test_runs_and_sweeps_report_rotation_at_rest(slope):
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    motion = rf.GroundMotion.sine_pulse("0.1 m/s^2", "1 Hz")
    leaning = rf.System(BLOCK, pads, inclination=slope)
    lean = leaning.equilibrium().rest_rotation.item()
    assert lean != 0.0
    assert leaning.simulate(motion).rest_rotation.item() == lean
    assert rf.sweep(leaning, motion, scale=[0.5, 1.0]).rest_rotation.values.tolist() == [[lean]] * 2
    plain = rf.System(rf.Block(width="1 m", height="4 m", mass="4 t"))
    run = plain.simulate(motion)
    assert "rest_rotation" not in run
    runs = rf.sweep(plain, motion, scale=[0.5, 1.0])
    assert np.isnan(runs.rest_rotation).all()
    found = rf.critical_scale(plain, motion, largest=0.5, scales=5, runs=5)
    for peaks in (run.peak_rotation, runs.peak_rotation, found.peak_rotation):  # nothing moves
        assert (peaks == 0.0).all()
        assert not np.signbit(peaks).any()


def test_moments_vanish_at_rest():
    for name in SCENES:
        for rotation in ("finite", "small"):
            system = scene(name, rotation=rotation)
            rest = system.equilibrium().rest_rotation.item()
            state = system.moment_rotation(([rest, 0.0], "rad"))
            moment = state.restoring_moment.values
            if name == "rigid ground":
                np.testing.assert_array_equal(moment, 0.0)
                continue
            # a cascade leans less: its upper stage stands on a level cap
            share = 0.04 if name == "cascade" else 1e-12
            assert abs(moment[0]) < share * WEIGHT * E
            assert moment[1] == pytest.approx(-WEIGHT * E, rel=1e-13)


def test_restoring_moment_is_slope_of_potential_energy():
    for name in ("rigid ground", "pads"):
        for rotation in ("finite", "small"):
            system = scene(name, rotation=rotation)
            for angle in (-0.15, -0.05, -0.004, 0.002, 0.07, 0.3):
                step = 1e-5 * abs(angle)
                state = system.moment_rotation(([angle - step, angle, angle + step], "rad"))
                energy = WEIGHT * state.held_vertical_displacement.values
                if name == "pads":
                    forces = state.held_left_reaction.values, state.held_right_reaction.values
                    energy = energy + sum(force**2 for force in forces) / (2.0 * K)
                slope = (energy[2] - energy[0]) / (2.0 * step)
                assert slope == pytest.approx(state.restoring_moment.values[1], rel=1e-5)
    finite = scene("rigid ground").equilibrium()
    edges = -finite.left_overturning_angle.item(), finite.right_overturning_angle.item()
    for name in ("rigid ground", "pads", "soil"):
        state = scene(name).moment_rotation((edges, "rad"))
        # little more than one end bears
        bound = 1e-12 if name != "soil" else 0.2
        assert np.abs(state.restoring_moment.values).max() < bound * WEIGHT * B


# forces ---------------------------------------------------------------------------------------


def test_reactions_follow_from_newtons_law():
    for name in SCENES:
        for rotation in ("finite", "small"):
            response = scene(name, rotation=rotation).simulate(
                PULSE, free_vibration="1 s", outputs=("acceleration", "reaction")
            )
            joint = name == "one body"
            mass = 60e3 if joint else MASS
            force = mass * response.absolute_horizontal_acceleration.values
            press = mass * (response.absolute_vertical_acceleration.values + G)
            tilt = response.cap_rotation.values if name == "coupled" else 0.0
            s, c = np.sin(tilt), np.cos(tilt)
            force, press = c * force - s * press, s * force + c * press
            if name != "cascade":  # the total of a cascade is a sum of two motions
                for found, expected in (("horizontal", force), ("vertical", press)):
                    np.testing.assert_allclose(
                        response[f"{found}_reaction"], expected, atol=1e-9 * mass * G
                    )
            reaction = response.soil_reaction if "soil_reaction" in response and name in (
                "soil", "one body"
            ) else response.left_reaction + response.right_reaction  # fmt: skip
            np.testing.assert_allclose(response.vertical_reaction, reaction, atol=1e-9 * mass * G)


def test_base_overturning_moment_is_that_of_pad_reactions():
    """The horizontal reaction at the held middle has no lever about it."""
    for rotation in ("finite", "small"):
        system = scene("pads", restraint="centre", rotation=rotation)
        response = system.simulate(PULSE, free_vibration="1 s", outputs="reaction")
        arm = B * (np.cos(response.rotation) if rotation == "finite" else 1.0)
        expected = arm * (response.right_reaction - response.left_reaction)
        np.testing.assert_allclose(
            response.base_overturning_moment, expected, atol=1e-8 * WEIGHT * B
        )


def test_base_overturning_moment_is_that_of_bearing_corner():
    response = scene("rigid ground").simulate(PULSE, free_vibration="1 s", outputs="reaction")
    rotation, state = response.rotation.values, response.contact_state.values
    side = np.select([state == 1, state == 2], [-1.0, 1.0], np.nan)
    press, push = response.vertical_reaction.values, response.horizontal_reaction.values
    expected = side * B * (np.cos(rotation) * press + np.sin(rotation) * push)
    rocks = ~np.isnan(side)
    assert {-1.0, 1.0} <= set(side[rocks].tolist())
    np.testing.assert_allclose(
        response.base_overturning_moment.values[rocks], expected[rocks], atol=1e-9 * WEIGHT * B
    )


def test_bearing_corner_does_not_move():
    points = {"right": ("1.2 m", "0 m"), "left": ("-1.2 m", "0 m"), "top": ("0.37 m", "9.6 m")}
    response = scene("rigid ground").simulate(PULSE, points=points)
    for name, state in (("right", 2), ("left", 1)):
        bears = response.contact_state.values == state
        assert bears.any()
        corner = response.sel(point=name).isel(time=bears)
        assert np.abs(corner.point_horizontal_displacement).max() < 1e-14
        assert np.abs(corner.point_vertical_displacement).max() < 1e-14
        np.testing.assert_allclose(
            corner.point_horizontal_acceleration, corner.ground_acceleration, atol=1e-12
        )
    assert response.point_x.values.tolist() == [1.2, -1.2, 0.37]
    assert response.point_y.values.tolist() == [0.0, 0.0, 9.6]


# initial states and certificates ------------------------------------------------------------------


def test_runs_start_from_rest_rotation_or_initial_state():
    for name in SCENES:
        system = scene(name)
        lean = system.equilibrium().rest_rotation.item()
        plain = system.simulate(PULSE)
        moving = system.simulate(PULSE, initial=rf.InitialState(angular_velocity="0.02 rad/s"))
        upright = system.simulate(PULSE, initial=rf.InitialState(rotation="0 rad"))
        explicit = system.simulate(PULSE, initial=rf.InitialState(rotation=f"{lean!r} rad"))
        assert plain.rotation.values[0] == moving.rotation.values[0] == pytest.approx(lean)
        assert moving.angular_velocity.values[0] == pytest.approx(0.02)
        assert upright.rotation.values[0] == 0.0
        np.testing.assert_allclose(
            explicit.rotation.values[:20], plain.rotation.values[:20], atol=1e-6
        )
        # in two parts: the second run continues the first
        first = system.simulate(PULSE.window(end="0.4 s"), accuracy="reference")
        second = system.simulate(
            PULSE.window("0.4 s"), free_vibration="0.3 s", initial=first, accuracy="reference"
        )
        continuous = system.simulate(PULSE, free_vibration="0.3 s", accuracy="reference")
        both = np.concatenate([first.rotation.values, second.rotation.values[1:]])
        np.testing.assert_allclose(
            both, continuous.rotation.values[: both.size], atol=2e-7 * np.abs(both).max()
        )
        early = max(first.right_peak_rotation.item(), second.right_peak_rotation.item())
        assert early == pytest.approx(continuous.right_peak_rotation.item(), rel=1e-6)


def test_certified_margin_is_that_of_overturning_side():
    """The margin of a verdict belongs to the threshold of the overturning side."""
    for side in (LEFT, RIGHT):
        corner = Corner(side)
        threshold = G * corner.theta / (1.0 - math.exp(-1.0))
        certified = scene("rigid ground", rotation="small").simulate(
            rectangle(-side * 1.05 * threshold, 1.0 / corner.p), free_vibration="30 s", certify=True
        )
        assert certified.overturning_direction.item() == side
        assert certified.verdict_converged.item()
        assert certified.verdict_robust.item()
        if side == RIGHT:
            flip = certified.verdict_flip_scale.item()
            assert flip == pytest.approx(1.0 / 1.05, rel=2e-3)


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
def test_restitution_that_adds_energy_is_in_cautions():
    """Landing at an unchanged rate on the corner farther from the centre of mass adds energy."""
    about_left, about_right = (INERTIA + MASS * (H**2 + s**2) for s in (B + E, B - E))
    most = (about_right / about_left) ** 0.5

    def run(restitution):
        system = rf.System(BLOCK, rf.RigidGround(restitution=restitution))
        start = rf.InitialState(rotation="0.1 rad")
        return system.simulate(initial=start, duration="4 s", outputs=["energy"])

    gains, loses = run(1.0), run(0.999 * most)
    assert np.diff(gains.impact_energy).min() < 0.0
    assert np.diff(loses.impact_energy).min() >= 0.0
    message = (
        "impacts on the left corner, about which the block has more inertia than about the other"
    )
    assert (
        f"{message} one, give energy with a restitution above {most:.6g}" in gains.attrs["cautions"]
    )
    assert "on the right corner" not in gains.attrs["cautions"]
    assert "give energy" not in loses.attrs["cautions"]
