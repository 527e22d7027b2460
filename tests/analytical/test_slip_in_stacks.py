"""Sliding bodies of a stack on rigid bases: closed forms, limits, balances, and refusals."""

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe.dynamics.chain.impact import write_trial_data
from rockframe.dynamics.chain.motion import set_inertia_loads
from rockframe.dynamics.events import FLIGHT, EventKind
from rockframe.errors import AssemblyError, ModelWarning
from rockframe.system.assembly import assemble

pytestmark = pytest.mark.analytical

GRAVITY = 9.80665
STATUE = rf.Block(width="0.5 m", height="1.5 m", mass="300 kg")
PLINTH = rf.Block(width="1 m", height="0.6 m", mass="1500 kg")  # too squat to rock alone
SLAB = rf.Block(width="3 m", height="0.3 m", mass="2 t")
PLATE = rf.Block(width="1 m", height="0.2 m", mass="1 t")
PADS = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
ENDLESS = rf.RigidGround(friction=1e9, kinetic_friction=1.2, impact="stick")


def ground(friction: float, kinetic: float | None = None, **options) -> rf.RigidGround:
    return rf.RigidGround(friction=friction, kinetic_friction=kinetic, **options)


def noise(seed: int, peak: float, mirrored: float = 1.0) -> rf.GroundMotion:
    rng, time = np.random.default_rng(seed), np.arange(0.0, 3.0, 0.01)
    waves = sum(
        rng.normal() * np.sin(2.0 * np.pi * rng.uniform(0.5, 4.0) * time + rng.uniform(0.0, 6.0))
        for _ in range(6)
    )
    return rf.GroundMotion.from_arrays(
        (mirrored * peak * waves / abs(waves).max(), "m/s^2"), "0.01 s"
    )


def run_of(interfaces, base, motion, *links, bodies=(STATUE, PLINTH), offset=0.0, **options):
    stack = rf.Stack(*bodies, interfaces=interfaces, offsets=[f"{offset} m"])
    options = {"accuracy": "reference", "free_vibration": "1 s", "second_look": False} | options
    return rf.System(stack, base, *links).simulate(motion, **options)


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize(
    ("between", "below", "reported"),
    [
        ((0.5, 0.3), (0.42, 0.4), True),  # both bases slip, or the lower one: 0.4 g < 0.5 g
        ((0.35, 0.3), (0.42, 0.4), False),  # friction cannot hold the upper plate at 0.4 g
        ((0.3, 0.3), (0.4, 0.4), False),
    ],
)
def test_ambiguous_slip_after_jump_is_in_cautions(between, below, reported):
    jump = rf.GroundMotion.from_arrays((np.full(11, 0.6 * GRAVITY), "m/s^2"), "0.01 s")
    with plain_python():
        found = run_of(
            [ground(*between)], ground(*below), jump, bodies=(PLATE, PLATE), free_vibration=None
        )
    assert ("there are 2 ways to bear and to slip" in found.attrs["cautions"]) == reported
    assert (found.body_slip[:, -1] < 0.0).all()


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_two_plates_that_slide_in_closed_form(direction):
    upper, lower, strong, length = 0.1, 0.3, direction * 5.0, 0.4
    steady = rf.GroundMotion.from_arrays((np.full(41, strong), "m/s^2"), "0.01 s")
    with plain_python():  # these equations take the longest to compile
        found = run_of(
            [ground(0.2, upper)], ground(0.35, lower), steady, bodies=(PLATE, SLAB),
            free_vibration=None,
        )  # fmt: skip
    one, two = 1000.0, 2000.0
    of_upper = direction * upper * GRAVITY  # absolute accelerations
    of_lower = direction * GRAVITY * (lower * (one + two) - upper * one) / two
    rates = of_upper - of_lower, of_lower - strong
    assert found.body_slip.values[:, -1] == pytest.approx(
        [0.5 * rate * length**2 for rate in rates], rel=1e-9
    )
    assert found.peak_body_rotation.max().item() == 0.0


def test_sticking_body_rides_on_sliding_body():
    steady = rf.GroundMotion.from_arrays((np.full(41, 5.0), "m/s^2"), "0.01 s")
    with plain_python():
        found = run_of([ground(0.4)], ground(0.3, 0.25), steady, free_vibration=None)
    slip = 0.5 * (0.25 * GRAVITY - 5.0) * 0.4**2
    assert found.body_slip.values[:, -1] == pytest.approx([0.0, slip], rel=1e-9, abs=1e-12)


@pytest.mark.long
@pytest.mark.parametrize(
    ("seed", "static", "kinetic"), [(5, 0.36, 0.25), (8, 0.36, 0.25), (6, 0.38, 0.36)]
)
def test_wide_lower_body_acts_as_ground(seed, static, kinetic):
    """In these runs no slip stops and reverses within an impact, where the laws differ."""
    floor, shaken = ground(static, kinetic), noise(seed, 6.0)
    wide = rf.Block(width="4 m", height="1 m", mass="30 t")
    found = run_of([floor], rf.RigidGround(), shaken, bodies=(STATUE, wide))
    plan = {"accuracy": "reference", "free_vibration": "1 s", "second_look": False}
    alone = rf.System(STATUE, floor).simulate(shaken, **plan)
    assert alone.peak_slip.item() > 5e-3
    assert alone.peak_rotation.item() > 5e-3
    assert alone.impact_count.item() == found.impact_count.item() > 3
    assert found.peak_body_slip.values[0] == pytest.approx(alone.peak_slip.item(), rel=1e-9)
    assert found.peak_rotation.item() == pytest.approx(alone.peak_rotation.item(), rel=1e-9)


@pytest.mark.long
def test_infinite_friction_prevents_slip():
    shaken = noise(3, 5.0)
    found = run_of([ENDLESS], ENDLESS, shaken)
    held = run_of([rf.RigidGround()], rf.RigidGround(), shaken)
    assert held.attrs["corners_held_without_pressing"] == 0
    assert held.impact_count.item() > 5
    np.testing.assert_allclose(
        found.body_rotation, held.body_rotation, atol=1e-9 * held.peak_rotation.item()
    )
    assert found.peak_body_slip.max().item() < 1e-9


@pytest.mark.long
@pytest.mark.parametrize(
    ("joint", "base"),
    [
        (ground(0.36, 0.3), ground(0.5, 0.3)),
        (ground(0.36, 0.3), PADS),
        (ground(0.36, 0.3), PADS.replace(friction=0.5)),
        (PADS.replace(friction=0.36, restitution=0.8), ground(0.5, 0.3)),
    ],
)
def test_energy_balances_and_mirrored_motion_mirrors_response(joint, base):
    one = run_of([joint], base, noise(5, 6.0), offset=0.05)
    other = run_of([joint], base, noise(5, 6.0, mirrored=-1.0), offset=-0.05)
    assert one.peak_body_slip.values[0] > 1e-3
    assert one.peak_rotation.item() > 1e-3
    assert one.impact_count.item() > 3
    assert abs(one.energy_residual.item()) < 1e-8
    np.testing.assert_allclose(
        one.body_rotation, -other.body_rotation, atol=1e-7 * one.peak_rotation.item()
    )
    np.testing.assert_allclose(one.body_slip, -other.body_slip, atol=1e-7)


@pytest.mark.long
def test_sticking_impacts_rock_more_and_slip_less():
    shaken = noise(4, 6.0)
    slides, sticks = (
        run_of([ground(0.34, 0.3, impact=law)], ground(0.8), shaken) for law in ("coulomb", "stick")
    )
    assert slides.impact_count.item() > 20
    assert sticks.impact_count.item() > 20
    # bodies held in impacts rock more and slip less
    assert sticks.peak_rotation.item() > 100.0 * slides.peak_rotation.item()
    assert sticks.peak_body_slip.values[0] < slides.peak_body_slip.values[0]


def test_restrainers_limit_slip():
    shaken, joint = noise(3, 6.0).window("0 s", "0.5 s"), ground(0.3)
    loose = {"on": ("0.5 m", "0.6 m"), "to": ("1.5 m", "0.6 m"), "on_body": 2}
    never = rf.Restrainer(**loose, stiffness="1 MN/m", slack="100 m")
    tight = rf.Restrainer(**loose, stiffness="5 MN/m", compression=True)
    with plain_python():
        free, slack, held = (
            run_of([joint], ground(0.2), shaken, *links, free_vibration=None)
            for links in ((), (never,), (tight,))
        )
    np.testing.assert_allclose(slack.body_slip, free.body_slip, atol=1e-9)
    assert abs(held.energy_residual.item()) < 1e-8
    assert held.peak_body_slip.values[1] < 0.1 * free.peak_body_slip.values[1]
    assert held.peak_body_slip.values[0] > 1e-3


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
def test_leaving_the_ground_as_friction_gives_way_is_an_event():
    # two bodies rock; the ground falls beneath them, and friction gives way before they are free
    falls = np.where(np.arange(31) < 15, 0.0, -12.0)
    motion = rf.GroundMotion.from_arrays(
        (np.full(31, 3.5), "m/s^2"), "0.01 s", vertical=(falls, "m/s^2")
    )
    bodies = [
        rf.Block(width="0.85 m", height="3.2 m", mass="3.2 t"),
        rf.Block(width="1.1 m", height="3.6 m", mass="3 t"),
    ]
    with plain_python():
        found = run_of(
            [ground(0.5, 0.4)], ground(1.06, 0.7), motion, bodies=bodies, free_vibration=None,
            output_step="1 ms",
        )  # fmt: skip
    kinds = [EventKind(kind) for kind in found.event_kind.values]
    assert kinds == [EventKind.UPLIFT, EventKind.UPLIFT, EventKind.SEPARATION]
    flies = found.time.values[(found.body_contact_state.values == FLIGHT).all(axis=0)]
    assert 0.0 < flies[0] - found.event_time.values[-1] < 1e-3


def test_load_beyond_friction_warns():
    pulled = rf.Load(at=("0 m", "0.3 m"), horizontal="4 kN", on_body=2)
    with pytest.warns(ModelWarning, match="body 2 slides under its restrainers and loads"):
        rf.System(rf.Stack(STATUE, PLINTH, interfaces=[ground(0.3)]), ground(0.2), pulled)


def test_slip_beyond_edge_warns():
    steady = rf.GroundMotion.from_arrays((np.full(81, 5.0), "m/s^2"), "0.01 s")
    with pytest.warns(ModelWarning, match="beyond the edge of body 2"):
        found = run_of([ground(0.2)], rf.RigidGround(), steady, free_vibration=None)
    assert found.peak_body_slip.values[0] > 0.25


def test_incompatible_parts_are_refused():
    stack = rf.Stack(STATUE, PLINTH, interfaces=[ground(0.3)])
    with pytest.raises(AssemblyError, match="body 1: with a kinetic friction of 2"):
        rf.System(stack.replace(interfaces=[ground(2.0)]))
    tendon = rf.Tendon(stiffness="1 MN/m", preload="10 kN")
    with pytest.raises(AssemblyError, match="a block that slides shears it"):
        rf.System(stack, tendon)


def test_description_lists_friction_of_each_base():
    system = rf.System(
        rf.Stack(STATUE, PLINTH, interfaces=[ground(0.3, 0.2, impact="stick")]), rf.RigidGround()
    )
    text = system.describe()
    assert "0.3, 0.2, held in impacts" in text
    assert "base 2: friction at rest, and of slip" in text
    assert EventKind.SLIP in set(system.simulate(noise(5, 6.0)).event_kind.values.tolist())


@pytest.mark.parametrize("corners", [0b1101, 0b1110, 0b1111])
@pytest.mark.parametrize("slip", [2.0, -2.0])
def test_trial_impact_loss_equals_kinetic_energy_lost(corners, slip):
    stack = rf.Stack(STATUE, PLINTH, interfaces=[ground(0.3)])
    system = assemble((stack, ground(0.4))).setting.contact_model().system
    state, flying = np.zeros(12), system.with_bearing_corners(0, 0, 0)
    # the upper body lands rotating, and both slip
    state[6:] = 0.7, -0.4, 0.0, 0.0, slip, -0.5 * slip
    kinetic = system.energies(flying, state).kinetic
    set_inertia_loads(system, 0.0, 0.0, system.workspace())
    write_trial_data(system, True, state)
    found = system.try_corners(flying, corners, 0b1111, True, 0.0, state)
    assert [system.trial_sense(k) for k in range(2)] == [np.sign(slip), -np.sign(slip)]
    system.change_velocities(state)
    assert found.loss == pytest.approx(kinetic - system.energies(flying, state).kinetic, rel=1e-12)


def test_verdict_lists_the_bodies_that_did_not_slide_once():
    column, still = [PLATE] * 3, rf.GroundMotion.sine_pulse("0.1 m/s^2", "1 Hz")
    for below, motion, words in (
        (1.0, still, "No body slid, did not overturn"),
        (0.2, noise(1, 4.0), "Body 3 slid 0.0"),
    ):
        stack = rf.Stack(*column, interfaces=ground(1.0))
        verdict = rf.System(stack, ground(below)).simulate(motion).attrs["verdict"]
        assert verdict.startswith(words), verdict
    assert ", body 1 and body 2 did not slide, did not overturn" in verdict
