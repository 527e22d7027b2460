"""Blocks thrown up: parabolas, landings by the impulse equations, bouncing in closed form."""

import math

import numpy as np
import pytest
from analytical.pads import Pads
from overdamping import overdamped
from scipy.optimize import brentq

import rockframe as rf
from rockframe.errors import ModelWarning

pytestmark = pytest.mark.analytical

PADS = Pads()
RULES = ("contact-state", "leading-corner", "centre")
FULL, LEFT, RIGHT, FLIGHT = range(4)
SEPARATION, IMPACT = 1, 2


def thrown(pads, start, duration, motion=None, restitution=None, **options):
    """Release a block above its pads from (alpha, its rate, y, its rate)."""
    alpha, spin, y, speed = start
    return pads.system(restitution=restitution, **options).simulate(
        motion,
        duration=f"{duration!r} s",
        initial=rf.InitialState(
            rotation=f"{alpha!r} rad",
            angular_velocity=f"{spin!r} rad/s",
            vertical_displacement=f"{y!r} m",
            vertical_velocity=f"{speed!r} m/s",
        ),
        output_step=f"{duration / 200.0!r} s",
        accuracy="reference",
        outputs="energy",
    )


def heights(pads, alpha, y):
    """Return heights of the left and the right corner above their rest positions."""
    middle = y + pads.h * (1.0 - math.cos(alpha))
    return middle + pads.b * math.sin(alpha), middle - pads.b * math.sin(alpha)


def place_at(alpha, rule):
    """Return the horizontal position in flight, about the point held in full contact."""
    point = math.copysign(PADS.b, alpha) if rule == "leading-corner" else 0.0
    return PADS.h * math.sin(alpha) + point * (1.0 - math.cos(alpha))


def landing(pads, start):
    """Return time and side of the first landing of a free parabola."""
    alpha, spin, y, speed = start

    def gap(t):
        fallen = y + speed * t - 0.5 * pads.gravity * t * t
        return min(heights(pads, alpha + spin * t, fallen)) - pads.delta

    fine = np.linspace(0.0, 3.0, 3001)
    below = np.flatnonzero(np.array([gap(t) for t in fine]) < 0.0)[0]
    time = brentq(gap, fine[below - 1], fine[below], xtol=1e-15, rtol=1e-15)
    return time, RIGHT if alpha + spin * time > 0.0 else LEFT


THROWS = [
    # alpha, rate, y, its rate
    (0.0, 0.3, 0.10, 1.0),
    (0.0, -0.3, 0.10, 1.0),
    (0.05, -0.4, 0.20, 2.0),
    (-0.05, 0.05, 0.15, 0.0),
    (0.1, 0.0, 0.40, -1.0),
]


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("start", THROWS)
def test_flight_is_a_parabola(start, rule):
    alpha, spin, y, speed = start
    time, side = landing(PADS, start)
    response = thrown(PADS, start, time + 1e-4, restraint=rule)
    t = response.time.values[response.time.values < time]
    flying = response.isel(time=slice(0, len(t)))
    assert (flying.contact_state.values == FLIGHT).all()
    fallen = y + speed * t - 0.5 * PADS.gravity * t**2
    np.testing.assert_allclose(flying.vertical_displacement.values, fallen, atol=1e-13)
    rate = speed - PADS.gravity * t
    np.testing.assert_allclose(flying.vertical_velocity.values, rate, atol=1e-12)
    np.testing.assert_allclose(flying.rotation.values, alpha + spin * t, atol=1e-14)
    np.testing.assert_allclose(flying.angular_velocity.values, spin, atol=1e-12)
    x = flying.horizontal_displacement.values
    np.testing.assert_allclose(x, place_at(alpha, rule), atol=1e-14)
    assert (flying.left_reaction.values == 0.0).all()
    assert (flying.right_reaction.values == 0.0).all()
    assert response.event_time.values[0] == pytest.approx(time, abs=1e-12)
    assert response.event_kind.values[0] == IMPACT
    assert response.contact_state_before.values[0] == FLIGHT
    assert response.contact_state_after.values[0] == side
    assert response.flight_time.item() == pytest.approx(time, abs=1e-12)
    assert response.flight_count.item() == 1
    assert response.first_uplift_time.item() == 0.0
    assert response.energy_residual.item() < 1e-12


def test_flight_over_accelerating_ground_in_closed_form():
    """Relative to the ground, of acceleration (a + s t), the block falls by the double integral."""
    start = (0.02, 0.1, 0.3, 1.0)
    across, upwards = np.array([1.0, 4.0]), np.array([-2.0, 3.0])
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), "0.4 s", vertical=(upwards, "m/s^2"))
    response = thrown(PADS, start, 0.3, motion)
    t = response.time.values
    assert (response.contact_state.values == FLIGHT).all()
    slope = np.diff(across).item() / 0.4
    x = PADS.h * math.sin(0.02) - 0.5 * across[0] * t**2 - slope * t**3 / 6.0
    np.testing.assert_allclose(response.horizontal_displacement.values, x, atol=1e-12)
    slope = np.diff(upwards).item() / 0.4
    y = 0.3 + t - 0.5 * (PADS.gravity + upwards[0]) * t**2 - slope * t**3 / 6.0
    np.testing.assert_allclose(response.vertical_displacement.values, y, atol=1e-12)
    np.testing.assert_allclose(response.rotation.values, 0.02 + 0.1 * t, atol=1e-13)


def reach(pads, alpha, e):
    return pads.h * math.cos(alpha) + e * math.sin(alpha)


@pytest.mark.parametrize("restitution", [1.0, 0.6, pytest.param(0.05, marks=pytest.mark.long)])
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("start", THROWS)
def test_landing_on_one_corner(start, rule, restitution):
    """The momentum is projected on the new restraint before the corner is slowed."""
    alpha, spin, _, speed = start
    time, side = landing(PADS, start)
    if restitution > PADS.eps_max:
        with pytest.warns(ModelWarning, match="eps_max"):
            response = thrown(PADS, start, time + 1e-4, restitution=1.0, restraint=rule)
    else:
        response = thrown(PADS, start, time + 1e-4, restitution=restitution, restraint=rule)
    alpha += spin * time
    speed -= PADS.gravity * time
    e = 0.0 if rule == "centre" else PADS.b * math.copysign(1.0, alpha)
    x = reach(PADS, alpha, e)
    inertia = PADS.inertia + x * x
    held = PADS.inertia * spin / inertia  # the centre of mass moved vertically
    lever = PADS.h * math.sin(alpha) - math.copysign(PADS.b, alpha) * math.cos(alpha)
    corner = speed + lever * held
    impulse = -(1.0 - restitution) * corner / (1.0 + lever**2 / inertia)
    after = held + impulse * lever / inertia
    assert corner < 0.0
    assert response.event_rotation.values[0] == pytest.approx(alpha, abs=1e-13)
    assert response.angular_velocity_before.values[0] == pytest.approx(spin, abs=1e-14)
    assert response.angular_velocity_after.values[0] == pytest.approx(after, abs=1e-12)
    slip = x * held
    repinning = 0.5 * (PADS.inertia * spin**2 - PADS.inertia * held**2 - slip**2)
    impact = -impulse * corner - 0.5 * impulse**2 * (1.0 + lever**2 / inertia)
    assert response.repinning_energy.values[-1] == pytest.approx(
        PADS.mass * repinning, rel=1e-9, abs=1e-9
    )
    assert response.impact_energy.values[-1] == pytest.approx(
        PADS.mass * impact, rel=1e-9, abs=1e-9
    )
    assert (np.sign(alpha) > 0.0) == (side == RIGHT)


def flat_drop_events(pads, height, restitution, bounces):
    """Return times at which a block dropped flat on undamped pads lands and leaves."""
    times = []
    speed = math.sqrt(2.0 * pads.gravity * height)
    now = speed / pads.gravity
    for _ in range(bounces):
        times.append(now)
        speed *= restitution
        amplitude = math.hypot(pads.delta, speed / pads.omega_v)
        phase = math.acos(pads.delta / amplitude)
        now += 2.0 * (math.pi - phase) / pads.omega_v
        times.append(now)
        now += 2.0 * speed / pads.gravity
    return np.array(times)


@pytest.mark.parametrize("restitution", [0.9, 0.5])
@pytest.mark.parametrize("rule", RULES)
def test_bouncing_flat_on_undamped_pads(restitution, rule):
    pads = Pads(damping_ratio=0.0)
    height = 0.1
    expected = flat_drop_events(pads, height, restitution, 4)
    response = thrown(
        pads,
        (0.0, 0.0, pads.delta + height, 0.0),
        float(expected[-1]) + 1e-3,
        restitution=restitution,
        restraint=rule,
    )
    together = response.event_time.values
    found = together[np.concatenate([[True], np.diff(together) > 1e-9])]
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    assert (response.rotation.values == 0.0).all()
    assert (response.angular_velocity.values == 0.0).all()
    landed = 0.5 * (response.contact_state.values != FLIGHT).mean()
    assert landed > 0.0
    flights = np.diff(np.concatenate([[0.0], expected]))[::2].sum()
    assert response.flight_time.item() == pytest.approx(flights + 1e-3, rel=1e-9)
    assert response.flight_count.item() == 5
    assert response.impact_count.item() == 4
    fallen = pads.mass * pads.gravity * height
    lost = fallen * (1.0 - restitution**8)
    assert response.impact_energy.values[-1] == pytest.approx(lost, rel=1e-9)
    assert response.energy_residual.item() < 1e-10


def test_lossless_flat_bounce_returns_to_its_height():
    pads = Pads(damping_ratio=0.0)
    height = 0.05
    with pytest.warns(ModelWarning, match="eps_max"):
        response = thrown(pads, (0.0, 0.0, pads.delta + height, 0.0), 3.0, restitution=1.0)
    flying = response.isel(time=np.flatnonzero(response.contact_state.values == FLIGHT))
    assert flying.time.values[-1] > 2.0
    y = flying.vertical_displacement.values - pads.delta
    summit = y + 0.5 * flying.vertical_velocity.values**2 / pads.gravity
    np.testing.assert_allclose(summit, height, rtol=1e-8)
    assert response.impact_energy.values[-1] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("xi", [0.05, 0.3])
def test_block_leaves_damped_pads_when_reaction_falls_to_zero(xi):
    """After an upward impulse at rest, the reaction k(delta - y) - c y' falls through zero."""
    pads = Pads(damping_ratio=xi)
    speed = 1.5 * pads.omega_v * pads.delta
    response = thrown(pads, (0.0, 0.0, 0.0, speed), 0.05)
    damped = xi * pads.omega_v
    turning = math.sqrt(pads.omega_v**2 - damped**2)

    def state(t):
        fade = math.exp(-damped * t)
        y = speed / turning * fade * math.sin(turning * t)
        return y, fade * speed * math.cos(turning * t) - damped * y

    def push(t):
        y, rate = state(t)
        return pads.k * (pads.delta - y) - pads.c * rate

    time = brentq(push, 0.0, 1.0 / pads.omega_v, xtol=1e-16)
    assert push(0.0) > 0.0
    assert response.event_time.values[0] == pytest.approx(time, abs=1e-11)
    assert response.event_kind.values[0] == SEPARATION
    assert response.contact_state_after.values[-1] == FLIGHT
    assert response.first_uplift_time.item() == pytest.approx(time, abs=1e-11)
    y0, rate0 = state(time)
    t = response.time.values
    flying = t > time
    fallen = y0 + rate0 * (t - time) - 0.5 * pads.gravity * (t - time) ** 2
    np.testing.assert_allclose(
        response.vertical_displacement.values[flying], fallen[flying], atol=1e-10
    )
    assert (response.contact_state.values[flying] == FLIGHT).all()


@overdamped
@pytest.mark.parametrize("xi", [0.3, 2.0])
def test_kick_above_dashpot_limit_starts_flight_at_once(xi):
    pads = Pads(damping_ratio=xi)
    speed = 1.01 * pads.k * pads.delta / pads.c
    response = thrown(pads, (0.0, 0.0, 0.0, speed), 0.02)
    assert response.contact_state.values[0] == FLIGHT
    t = response.time.values
    fallen = speed * t - 0.5 * pads.gravity * t**2
    catches = response.event_time.values
    flying = t < (catches[0] if len(catches) else 1.0)
    assert flying.sum() > 1
    np.testing.assert_allclose(
        response.vertical_displacement.values[flying], fallen[flying], atol=1e-13
    )


@overdamped
def test_overdamped_pad_regains_contact_without_impact():
    """Overdamped pads lag after a weak impulse, and touch again while the block still rises."""
    pads = Pads(damping_ratio=2.0)
    speed = 1.01 * pads.k * pads.delta / pads.c
    response = thrown(pads, (0.0, 0.0, 0.0, speed), 0.5)

    def push(t):
        y = speed * t - 0.5 * pads.gravity * t * t
        return pads.k * (pads.delta - y) - pads.c * (speed - pads.gravity * t)

    time = brentq(push, 0.0, 0.1)
    assert speed - pads.gravity * time > 0.0
    assert response.event_time.values[0] == pytest.approx(time, abs=1e-12)
    assert set(response.event_kind.values.tolist()) == {3}
    assert response.impact_count.item() == 0
    assert response.flight_time.item() == pytest.approx(time, abs=1e-12)
    assert response.energy_residual.item() < 1e-9


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_initial_position_is_continuous_between_contact_and_flight(rule, side):
    """The position of a released body does not jump when its speed makes it leave its pads."""
    angle, places = side * 0.02, []
    for above in (-1e-9, 1e-9):  # of the leading end above its pad
        low = PADS.delta - heights(PADS, angle, 0.0)[0 if side < 0.0 else 1]
        y = low + above
        run = thrown(PADS, (angle, 0.0, y, 0.0), 0.01, restraint=rule)
        places.append(float(run.horizontal_displacement[0]))
        bears = LEFT if side < 0.0 else RIGHT
        assert int(run.contact_state[0]) == (FLIGHT if above > 0.0 else bears)
    assert places[1] == pytest.approx(place_at(angle, rule), abs=1e-14)
    if rule != "contact-state":  # that rule holds the bearing corner
        assert places[0] == pytest.approx(places[1], abs=1e-14)


# stacked bodies ------------------------------------------------------------------------


UPPER = rf.Block(width="0.5 m", height="1.8 m", mass="900 kg")
LOWER = rf.Block(width="0.9 m", height="1 m", mass="2200 kg")


def dropped(accuracy, restitution, **friction):
    """Run two bodies thrown up by the ground, including their landings."""
    pads = rf.TwoSpringSupport(
        frequency_ratio=40, damping_ratio=0.0, restitution=restitution, **friction
    )
    upwards = np.array([0.0, -13.0, -21.0, -9.0, 5.0, *np.zeros(8)])
    motion = rf.GroundMotion.from_arrays(
        (0.0 * upwards, "m/s^2"), "0.05 s", vertical=(upwards, "m/s^2")
    )
    stack = rf.Stack(UPPER, LOWER, interfaces=[rf.RigidGround(**friction)])
    return rf.System(stack, pads).simulate(
        motion, duration="0.4 s", accuracy=accuracy, second_look=False
    )


@pytest.mark.filterwarnings("ignore:.*one of several motions:rockframe.errors.ModelWarning")
@pytest.mark.parametrize("restitution", [pytest.param(0.1, marks=pytest.mark.long), 0.6])
@pytest.mark.parametrize(
    "friction",
    [
        pytest.param({}, id="held"),
        pytest.param({"friction": 0.5}, id="friction", marks=pytest.mark.long),
    ],
)
def test_bodies_in_joint_free_fall_land_together(restitution, friction):
    """Without a force between them, contact is at any touching corner; all take the impact.

    As one body that lands flat, they leave again at their own time without rotation.
    """
    runs = [dropped(one, restitution, **friction) for one in ("standard", "reference")]
    for run in runs:
        assert run.impact_count >= 1
        assert np.abs(run.body_rotation).max() < 1e-12
    times = [np.unique(run.event_time.to_numpy().round(7)) for run in runs]
    np.testing.assert_allclose(times[0], times[1], atol=2e-7)


@pytest.mark.filterwarnings("ignore:.*one of several motions:rockframe.errors.ModelWarning")
@pytest.mark.parametrize("accuracy", ["fast", "standard"])
@pytest.mark.parametrize("peak", [-13.0, -21.0])
def test_separation_time_does_not_depend_on_friction(accuracy, peak):
    """Friction without contact force stays zero, which does not indicate when it vanished."""
    falls = rf.GroundMotion.from_arrays(
        (np.zeros(4), "m/s^2"), "0.1 s", vertical=(np.array([0.0, peak, peak, peak]), "m/s^2")
    )
    left = []
    for friction in ({}, {"friction": 0.5}):
        pads = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.0, **friction)
        stack = rf.Stack(UPPER, LOWER, interfaces=[rf.RigidGround(**friction)])
        run = rf.System(stack, pads).simulate(falls, accuracy=accuracy, second_look=False)
        assert run.energy_residual < 1e-5
        left.append(float(run.event_time[0]))
    assert left[1] == pytest.approx(left[0], abs=1e-9)
