"""Sliding and slide-rock on rigid ground against closed forms, limits and mirror images."""

import math

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe.dynamics.events import EventKind
from rockframe.dynamics.protocol import IMPACT_LOSS, LAST_EVENT, Ground
from rockframe.dynamics.slide_motion import (
    DOF,
    FLIGHT_RIGHT,
    HELD,
    NORMAL_FORCE,
    ON_LEFT,
    ON_RIGHT,
    ROTATION,
    SLIDE_MEMORY,
    SLIP,
    SLIP_STATES,
    TIPPING_LEFT,
    TO_LEFT,
    TO_RIGHT,
    Loads,
)
from rockframe.errors import AssemblyError, ComponentError, ModelWarning

pytestmark = pytest.mark.analytical

GRAVITY = 9.80665
LOW = rf.Block(width="1 m", height="1.2 m", mass="2 t")
SQUAT = rf.Block(width="2 m", height="1 m", mass="5 t")
SLENDER = rf.Block(width="1 m", height="4 m", mass="10 t")
HISTORIES = (
    "rotation", "angular_velocity", "horizontal_displacement", "vertical_displacement",
    "horizontal_acceleration", "left_reaction", "right_reaction", "base_shear", "impact_energy",
)  # fmt: skip
MIRRORED = {"rotation", "slip", "slip_velocity", "horizontal_displacement"}


@pytest.fixture(scope="module", autouse=True)
def _in_plain_python():
    with plain_python():
        yield


def standing(block, friction, kinetic=None, **options):
    return rf.System(block, rf.RigidGround(friction=friction, kinetic_friction=kinetic), **options)


def noise(sign=1.0, size=5.0):
    """Return a motion with content at all frequencies, or its mirror image."""
    rng = np.random.default_rng(12)
    across, upwards = (np.convolve(rng.normal(size=150), np.ones(5) / 5, "same") for _ in "xy")
    return rf.GroundMotion.from_arrays(
        (sign * size * across, "m/s^2"), "0.02 s", vertical=(2.0 * upwards, "m/s^2")
    )


def slid(yields, motion, block=LOW):
    """Return the run of a low block that slides beyond an acceleration."""
    return standing(block, yields / GRAVITY).simulate(
        motion, duration="2 s", accuracy="reference", outputs="energy"
    )


@pytest.mark.parametrize(
    ("amplitude", "yields", "length", "distance"),
    [(2.0, 1.0, 0.5, 0.25), (4.0, 1.0, 0.5, 1.5), (3.0, 2.0, 1.0, 0.75)],
)
@pytest.mark.parametrize("block", [LOW, SQUAT])
def test_newmarks_block_under_a_rectangular_pulse(amplitude, yields, length, distance, block):
    """D = a t0^2/2 (a/ay - 1); it stops at a t0/ay."""
    count = round(length / 0.01) + 1
    motion = rf.GroundMotion.from_arrays((np.full(count, amplitude), "m/s^2"), "0.01 s")
    run = standing(block, yields / GRAVITY).simulate(
        motion, duration="2.5 s", accuracy="reference", outputs="energy"
    )
    assert float(run.residual_slip) == pytest.approx(-distance, rel=1e-9)
    assert float(run.peak_slip) == pytest.approx(distance, rel=1e-9)
    assert float(run.residual_displacement) == pytest.approx(-distance, rel=1e-9)
    assert run.event_kind.values.tolist() == [EventKind.SLIP, EventKind.STICK]
    assert float(run.event_time[-1]) == pytest.approx(amplitude * length / yields, rel=1e-9)
    # the weight times the friction, over the slip
    work = block.si.mass * yields * distance
    assert float(run.dissipated_energy[-1]) == pytest.approx(work, rel=1e-9)
    assert float(run.energy_residual) <= 1e-11
    words = f"Slid {distance:.3g} m to the left, did not overturn"
    assert run.attrs["verdict"].startswith(words)


@pytest.mark.parametrize(
    ("yields", "amplitude", "length", "distance", "stops"),
    [
        (1.0, 2.0, 0.5, 0.06910393133, 0.67730766723),
        (1.0, 4.0, 0.5, 0.51765711574, 1.29323952806),
        (2.0, 3.0, 1.0, 0.16398904236, 1.06562562818),
        (2.5, 3.0, 1.0, 0.03934749046, 0.87975233812),
    ],
)
def test_newmarks_block_under_half_a_sine(yields, amplitude, length, distance, stops):
    motion = rf.GroundMotion.half_sine_pulse(f"{amplitude} m/s^2", f"{length} s")
    run = slid(yields, motion)
    assert float(run.residual_slip) == pytest.approx(-distance, rel=1e-9)
    assert float(run.event_time[-1]) == pytest.approx(stops, rel=1e-9)
    assert float(run.peak_rotation) == 0.0


@pytest.mark.parametrize("restitution", [None, 0.8])
def test_infinite_friction_gives_housner_block(restitution):
    options = {
        "accuracy": "reference", "free_vibration": "1 s",
        "outputs": ["energy", "acceleration", "reaction"],
    }  # fmt: skip
    ground = rf.RigidGround(friction=1e6, kinetic_friction=1.0, restitution=restitution)
    ours = rf.System(SLENDER, ground).simulate(noise(), **options)
    housner = rf.System(SLENDER, rf.RigidGround(restitution=restitution))
    housner = housner.simulate(noise(), **options)
    assert int(ours.impact_count) == int(housner.impact_count) > 3
    for name in HISTORIES:
        size = float(np.abs(housner[name]).max())
        np.testing.assert_allclose(ours[name], housner[name], rtol=0.0, atol=1e-10 * size)
    assert (ours.slip == 0.0).all()
    assert ours.attrs["verdict"].startswith("Did not slide, did not overturn")


def test_frictionless_block_stays_in_place_as_ground_moves():
    """The centre of mass moves opposite to the ground by the same distance, without rocking."""
    pulse = rf.GroundMotion.sine_pulse(amplitude="6 m/s^2", frequency="1 Hz")
    run = standing(SLENDER, 0.0).simulate(pulse, accuracy="reference")
    period = 1.0
    moved = -6.0 * period * period / (2.0 * math.pi)
    assert float(run.residual_slip) == pytest.approx(moved, rel=1e-9)
    assert float(run.peak_rotation) == 0.0


@pytest.mark.parametrize(
    "friction",
    [
        (0.27, 0.27),
        (0.26, 0.2),
        *(pytest.param(one, marks=pytest.mark.long) for one in ((0.3, 0.3), (0.2, 0.15))),
    ],
)
def test_mirror_symmetry_energy_balance_and_friction_cone(friction):
    run, mirrored = (
        standing(SLENDER, *friction).simulate(
            noise(sign), free_vibration="1 s", accuracy="reference",
            outputs=["energy", "reaction"],
        )
        for sign in (1.0, -1.0)
    )  # fmt: skip
    assert float(run.energy_residual) <= 1e-8
    assert float(run.dissipated_energy[-1]) > 0.0
    ratio = np.abs(run.horizontal_reaction / run.vertical_reaction)
    assert float(ratio.max()) <= friction[0] * (1.0 + 1e-9)
    for name in MIRRORED:
        np.testing.assert_array_equal(run[name], -mirrored[name])
    np.testing.assert_array_equal(run.event_kind, mirrored.event_kind)


@pytest.mark.parametrize("slenderness", [2.0, 4.0, 8.0])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.9, 1.1])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_impacts_after_rocking_about_a_held_corner(slenderness, share, side):
    """eq-slide-through below 3 t/(4 + t^2), Housner's impact above."""
    t = 1.0 / slenderness
    friction = share * 3.0 * t / (4.0 + t * t)
    block = rf.Block(width="1 m", height=f"{slenderness} m", mass="1 t")
    system = standing(block, friction).assembly.model.system
    state, memory = np.zeros(2 * DOF), np.zeros(len(SLIDE_MEMORY))
    state[DOF + ROTATION] = -0.3 * side
    corner, other = (1, 2) if side > 0.0 else (2, 1)
    mode = system.rock_over(SLIP_STATES * corner, state, Ground(0.0, 0.0), memory)
    rate, slip = state[DOF + ROTATION], state[DOF + SLIP]
    if share > 1.0:
        assert rate == pytest.approx(-0.3 * side * block.maximum_restitution, rel=1e-12)
        assert slip == 0.0
    else:
        under = 1.0 + 4.0 * t * t - 3.0 * friction * t
        after = (1.0 - 2.0 * t * t + 3.0 * friction * t) / under
        slips = 2.0 * t * (3.0 * t - 4.0 * friction - friction * t * t) / under
        assert rate == pytest.approx(-0.3 * side * after, rel=1e-12)
        assert slip == pytest.approx(-0.3 * side * slips * 0.5 * slenderness, rel=1e-9)
    assert mode // SLIP_STATES == other
    assert memory[IMPACT_LOSS] > 0.0


def test_slip_that_stops_within_impact_reverses_or_sticks():
    """The result equals that of the impulse in a thousand parts."""
    rng = np.random.default_rng(4)
    system = standing(SLENDER, 0.1).assembly.model.system
    reversed_ones = 0
    for _ in range(40):
        friction, slip, sinking = rng.uniform(0.02, 0.5), rng.uniform(-0.3, 0.3), -rng.uniform(0, 1)
        one = system._replace(impulsive=friction)
        ahead, above = rng.choice([-0.5, 0.5]), 2.0
        along, normal = one.impact_impulses(ahead, above, 1.0, slip, sinking)
        u, n, x, y, start = slip, sinking, 0.0, 0.0, math.copysign(1.0, slip)
        part = normal / 20000.0
        while n < 0.0:
            held = -u / part + ahead * above / one.inertia
            held /= 1.0 + above * above / one.inertia
            ratio = min(max(held, -friction), friction)
            u += part * (ratio * (1.0 + above**2 / one.inertia) - ahead * above / one.inertia)
            n += part * (1.0 + ahead**2 / one.inertia - ratio * ahead * above / one.inertia)
            x, y = x + ratio * part, y + part
        assert (x, y) == pytest.approx((along, normal), abs=2e-4 * (1.0 + normal))
        reversed_ones += abs(u) > 1e-3 and u * start < 0.0
    assert reversed_ones > 3


def test_sticking_impacts_match_housner_for_any_friction():
    ground = rf.RigidGround(friction=0.05, impact="stick")
    system = rf.System(SLENDER, ground).assembly.model.system
    state, memory = np.zeros(2 * DOF), np.zeros(len(SLIDE_MEMORY))
    state[DOF + ROTATION] = -0.3
    system.rock_over(SLIP_STATES, state, Ground(0.0, 0.0), memory)
    assert state[DOF + ROTATION] == pytest.approx(-0.3 * SLENDER.maximum_restitution, rel=1e-12)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_tipping_guard_prevails_over_rounding(side):
    """For kinetic friction b/h the centre of pressure is at the corner, up to rounding."""
    system = standing(SLENDER, 0.9, 0.25).assembly.model.system
    system = system._replace(kinetic=system.kinetic * (1.0 - 1e-15))
    state, memory = np.zeros(2 * DOF), np.zeros(len(SLIDE_MEMORY))
    state[DOF + SLIP] = 0.1 * side
    slips = TO_RIGHT if side > 0.0 else TO_LEFT
    guard, corner = (NORMAL_FORCE, ON_RIGHT) if side > 0.0 else (TIPPING_LEFT, ON_LEFT)
    assert (
        system.switch(slips, guard, state, Ground(0.0, 0.0), memory) == SLIP_STATES * corner + slips
    )


@pytest.mark.parametrize("slips", [HELD, TO_RIGHT, TO_LEFT])
def test_corner_separates_despite_rounding_of_its_force(slips):
    """At its event, a force of one last bit neither holds nor presses the corner."""
    friction = math.inf if slips == HELD else 0.3
    system = standing(SLENDER, 0.3).assembly.model.system
    system = system._replace(static=friction)
    state, memory = np.zeros(2 * DOF), np.zeros(len(SLIDE_MEMORY))
    state[ROTATION], state[DOF + ROTATION] = 0.02, 0.5
    state[DOF + SLIP] = {HELD: 0.0, TO_RIGHT: 0.1, TO_LEFT: -0.1}[slips]
    mode, across = SLIP_STATES * ON_RIGHT + slips, 5.0
    forces = [
        system.contact(mode, state, Loads(across, weight, 0.0)).normal for weight in (0.0, 1.0)
    ]
    weight = -forces[0] / (forces[1] - forces[0]) + 1e-9
    ground = Ground(across, weight - system.gravity)
    assert 0.0 < system.contact(mode, state, system.loads(mode, state, ground)).normal < 1e-8
    assert system.switch(mode, NORMAL_FORCE, state, ground, memory) == SLIP_STATES * FLIGHT_RIGHT
    assert memory[LAST_EVENT] == EventKind.SEPARATION


def kinds_under(acceleration, friction, kinetic=None):
    """Name the first event of a block of t = 0.25 under a constant acceleration, in g."""
    motion = rf.GroundMotion.from_arrays((np.full(3, -acceleration * GRAVITY), "m/s^2"), "0.01 s")
    run = standing(SLENDER, friction, kinetic).simulate(motion)
    end = {"slip": abs(float(run.slip[-1])) > 0.0, "rock": float(run.peak_rotation) > 0.0}
    return tuple(name for name, found in end.items() if found)


def needed(a, t=0.25):
    """Return mu_rock, eq-slide-start."""
    return (a + 4.0 * a * t * t + 3.0 * t) / (4.0 + t * t + 3.0 * a * t)


@pytest.mark.parametrize("acceleration", [0.3, 0.6, 1.0])
def test_thresholds_from_rest(acceleration):
    least = needed(acceleration)
    for friction, found in (
        (0.999 * 0.25, ("slip",)),
        (1.001 * 0.25, ("slip", "rock")),
        (0.999 * least, ("slip", "rock")),
        (1.001 * least, ("rock",)),
    ):
        assert kinds_under(acceleration, friction) == found
    assert needed(1.0) == pytest.approx(0.415584, abs=1e-6)


@pytest.mark.parametrize(("acceleration", "friction"), [(0.249, 0.5), (0.199, 0.2)])
def test_block_below_thresholds_stays_at_rest(acceleration, friction):
    assert kinds_under(acceleration, friction) == ()


def test_friction_above_jamming_bound_is_refused():
    for block in (SLENDER, LOW, SQUAT):
        standing(block, 1e6, 1.333)
        with pytest.raises(AssemblyError, match=r"below 1\.33333"):
            standing(block, 1.334)


def test_a_squat_block_needs_friction():
    with pytest.raises(AssemblyError, match="On RigidGround"):
        rf.System(SQUAT)
    with pytest.raises(AssemblyError, match="cannot rock"):
        standing(SQUAT, 0.3, sliding="checked")
    run = standing(SQUAT, 1.2).simulate(
        initial=rf.InitialState(rotation="0.1 rad"), duration="2 s", accuracy="reference",
        outputs="energy",
    )  # fmt: skip
    assert int(run.impact_count) == 1
    assert float(run.rotation[-1]) == 0.0
    assert float(run.energy_residual) <= 1e-9


def test_a_block_thrown_up_flies_and_lands():
    motion = rf.GroundMotion.from_arrays(
        (np.full(60, 2.0), "m/s^2"), "0.01 s", vertical=(np.full(60, -15.0), "m/s^2")
    )
    run = standing(SLENDER, 0.5).simulate(motion, duration="2 s", accuracy="reference")
    assert run.event_kind.values[0] == EventKind.SEPARATION
    assert float(run.flight_time) > 0.6
    assert float(run.vertical_displacement.max()) > 0.5 * (15.0 - GRAVITY) * 0.6**2
    assert float(run.energy_residual) <= 1e-8


def test_block_sliding_down_slope_by_its_weight_warns():
    with pytest.warns(ModelWarning, match="slides by its own weight"):
        system = standing(LOW, 0.3, inclination="0.4 rad")
    run = system.simulate(duration="1 s", accuracy="reference")
    down = GRAVITY * (math.sin(0.4) - 0.3 * math.cos(0.4))
    assert float(run.residual_slip) == pytest.approx(-0.5 * down, rel=1e-9)


def test_inconsistent_friction_and_kinematics_are_refused():
    for options in ({"kinetic_friction": 0.3}, {"friction": 0.2, "kinetic_friction": 0.3}):
        with pytest.raises(ComponentError, match="kinetic_friction"):
            rf.RigidGround(**options)
    with pytest.raises(AssemblyError, match="sliding='checked'"):
        standing(SLENDER, 0.3, rotation="small")


def test_system_survives_result_and_run_continues(tmp_path):
    system = standing(SLENDER, 0.26, 0.2, sliding="computed")
    run = system.simulate(noise(), accuracy="reference")
    run.to_netcdf(tmp_path / "run.nc")
    again = rf.System.from_dataset(run)
    assert again.parts.ground == system.parts.ground
    checked = standing(SLENDER, 0.26, sliding="checked")
    assert rf.System.from_dict(checked.to_dict()) == checked
    assert "sliding='checked'" in repr(checked)
    continuous = system.simulate(noise(), free_vibration="1 s", accuracy="reference")
    continued = system.simulate(initial=run, duration="1 s", accuracy="reference")
    assert float(continued.residual_slip) == pytest.approx(
        float(continuous.residual_slip), abs=1e-9
    )
