"""Stacks on rigid bases: initial states, results, and comparison with pads and soil."""

import math

import numpy as np
import pytest
import xarray as xr
from benchmarks.columns_of_drums import draw_scene as draw_column
from benchmarks.random_parts import draw_scene
from plain_python import plain_python

import rockframe as rf
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.impact import NearbySubsets, next_subset
from rockframe.dynamics.events import IMPACT, ContactState, EventKind
from rockframe.dynamics.protocol import IMPACT_LOSS, Ground, Start
from rockframe.dynamics.switching import end_speed
from rockframe.errors import AssemblyError, ModelWarning
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate
from rockframe.solve.workspace import Status

pytestmark = pytest.mark.wide

STATUE = rf.Block(width="0.5 m", height="1.8 m", mass="900 kg")
PLINTH = rf.Block(width="0.9 m", height="1 m", mass="2200 kg")
COLUMN = rf.Block(width="0.5 m", height="3 m", mass="3 t")
HEAD = rf.Block(width="0.5 m", height="0.4 m", mass="300 kg")
RIGID = rf.RigidGround()
PADS = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2)
PULSE = rf.GroundMotion.sine_pulse(amplitude="-5 m/s^2", frequency="2 Hz")
PLAN = {"free_vibration": "1 s", "second_look": False}
GRAVITY = 9.80665
FULL = int(ContactState.FULL)


def on_rigid(upper, lower, **options):
    return rf.System(rf.Stack(upper, lower, interfaces=[RIGID], **options), RIGID)


def shaken(peak: float, frequency: float = 1.0) -> rf.GroundMotion:
    return rf.GroundMotion.sine_pulse(amplitude=f"{peak} m/s^2", frequency=f"{frequency} Hz")


@pytest.fixture(scope="module")
def run():
    return on_rigid(STATUE, PLINTH).simulate(PULSE, outputs=["energy"], **PLAN)


def test_a_stack_alone_stands_on_rigid_ground():
    stack = rf.Stack(STATUE, PLINTH, interfaces=[RIGID])
    assert (
        rf.System(stack).describe().split("Contact")[1:]
        == (rf.System(stack, RIGID).describe().split("Contact")[1:])
    )
    assert "by projection" in rf.System(stack).describe()


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
def test_lowest_body_uplifts_at_its_own_threshold_below_airborne_bodies():
    """They do not press the lowest body, whose end lifts when its own force vanishes."""
    stack = rf.Stack(
        rf.Block(width="0.6 m", height="0.34 m", mass="634 kg"),
        rf.Block(width="0.89 m", height="0.33 m", mass="2526 kg"),
        rf.Block(width="0.95 m", height="0.31 m", mass="2177 kg"),
        interfaces=[RIGID, RIGID],
    )
    pulse = rf.GroundMotion.sine_pulse(amplitude="33.7 m/s^2", frequency="2.57 Hz", cycles=3)
    run = rf.System(stack, RIGID).simulate(pulse, duration="0.46 s")
    assert int(run.status) == Status.COMPLETED
    # on level ground it uplifts alone at a ground acceleration of b/h g
    width, height = 0.95, 0.31
    alone = (run.event_kind == EventKind.UPLIFT) & (run.event_body == 3) & (run.event_time > 0.4)
    (time,) = run.event_time.values[alone.values]
    omega = 2.0 * math.pi * 2.57
    assert 33.7 * abs(math.sin(omega * time)) == pytest.approx(GRAVITY * width / height, rel=1e-6)


def joint_uplift_acceleration(upper, lower) -> float:
    """Return the acceleration at which two centred blocks rock as one."""
    one, two = lower.si, upper.si
    moment = one.mass * one.half_height + two.mass * (2.0 * one.half_height + two.half_height)
    return GRAVITY * (one.mass + two.mass) * one.half_width / moment


@pytest.mark.parametrize("direction", [1.0, -1.0])
@pytest.mark.parametrize(("upper", "lower", "first"), [(STATUE, PLINTH, 1), (HEAD, COLUMN, 2)])
def test_first_uplift_of_a_two_body_stack_matches_closed_form(upper, lower, first, direction):
    alone = GRAVITY * upper.si.half_width / upper.si.half_height
    starts = alone if first == 1 else joint_uplift_acceleration(upper, lower)
    assert starts < (joint_uplift_acceleration(upper, lower) if first == 1 else alone)
    system = on_rigid(upper, lower)
    assert system.simulate(shaken(0.999 * starts), duration="0.5 s").sizes["event"] == 0
    found = system.simulate(shaken(1.01 * direction * starts), duration="0.35 s")
    assert found.event_kind[0] == EventKind.UPLIFT
    assert found.event_body[0] == first
    # the ground moves to one side, the body to the other
    moved = found.body_rotation.to_numpy()[first - 1]
    assert -direction * moved[np.abs(moved) > 0.0][0] > 0.0
    when = float(found.event_time[0])
    assert 1.01 * math.sin(2.0 * math.pi * when) == pytest.approx(1.0, abs=1e-6)


def test_jointly_rocking_bodies_equal_one_block():
    united = rf.Block(width="0.5 m", height="3.4 m", mass="3.4 t")
    parts = [rf.Block(width="0.5 m", height="1.7 m", mass="1.7 t")] * 2
    motion = shaken(1.1 * GRAVITY * 0.5 / 3.4, 0.5)
    one = rf.System(united).simulate(motion, duration="2 s", accuracy="reference")
    both = on_rigid(*parts).simulate(motion, duration="2 s", accuracy="reference")
    until = float(one.event_time[1])  # they may separate at the first impact
    early = one.time < until
    assert np.abs(one.rotation)[early].max() > 1e-3
    assert np.abs((both.rotation - one.rotation)[early]).max() < 1e-9


def test_a_run_shows_forces_and_balances(run, tmp_path):
    assert run.sizes["body"] == 2
    assert float(run.energy_residual) < 1e-8
    weights = GRAVITY * np.array([900.0, 3100.0])
    assert np.allclose(run.body_vertical_reaction[:, 0], weights, rtol=1e-12)
    lost = run.impact_energy.to_numpy()
    assert (np.diff(lost) >= -1e-12 * lost[-1]).all()
    assert lost[-1] > 0.0
    balance = run.kinetic_energy + run.potential_energy + run.impact_energy - run.input_energy
    assert np.abs(balance - balance[0]).max() < 1e-7 * float(run.input_energy.max())
    full = (run.body_contact_state == FULL).all("body")
    assert np.abs(run.body_rotation_on_base.where(full, 0.0)).max() == 0.0
    assert run.attrs["impacts_of_several_modes"] == 0
    run.to_netcdf(tmp_path / "stack.nc")
    with xr.open_dataset(tmp_path / "stack.nc") as stored:
        assert rf.System.from_dataset(stored).parts.stack == rf.System.from_dataset(run).parts.stack


def test_runs_of_mirrored_motions_are_mirrored(run):
    mirror = on_rigid(STATUE, PLINTH).simulate(PULSE.scaled(-1.0), **PLAN)
    assert np.abs(mirror.body_rotation + run.body_rotation).max() < 1e-9


def test_rocking_dies_out():
    system = on_rigid(HEAD, PLINTH)
    with pytest.warns(ModelWarning, match="2 modes: taken is that which loses the least"):
        run = system.simulate(
            None, duration="6 s", initial=rf.InitialState(rotation="0.3 rad"), accuracy="standard"
        )
    assert run.attrs["impacts_of_several_modes"] == 1
    assert "one of several motions" in run.attrs["cautions"]
    assert int(EventKind.REST) in run.event_kind
    assert (run.body_contact_state[:, -1] == FULL).all()
    assert not np.any(run.body_rotation[:, -1])


def test_vertical_motion_makes_bodies_fly():
    hop = shaken(0.5, 4.0).with_vertical(shaken(-25.0, 4.0))
    run = on_rigid(STATUE, PLINTH).simulate(hop, **PLAN)
    assert (run.body_contact_state == int(ContactState.FLIGHT)).any("time").any()
    assert float(run.energy_residual) < 1e-6


@pytest.mark.parametrize(
    ("interface", "base"), [(RIGID, PADS), (RIGID, SOIL), (PADS, RIGID), (SOIL, RIGID)]
)
def test_rigid_bases_beside_others(interface, base):
    system = rf.System(rf.Stack(STATUE, PLINTH, interfaces=[interface], offsets=["2 cm"]), base)
    still = system.simulate(None, duration="0.3 s", accuracy="reference")
    assert np.abs(still.rotation - still.rotation[0]).max() < 1e-10
    run = system.simulate(PULSE, outputs=["energy"], **PLAN)
    assert int(run.status) != 5
    assert float(run.energy_residual) < 1e-5
    assert {1, 2} >= set(run.event_body.to_numpy())
    assert system.frequencies().sizes["body"] == 1
    lean = float(system.equilibrium().rest_rotation) + 1e-4
    assert system.moment_rotation([f"{lean} rad"]).restoring_moment.item() > 0.0


def test_statics_on_rigid_bases():
    system = on_rigid(STATUE, PLINTH)
    held = system.moment_rotation(["0 rad", "1e-9 rad", "0.1 rad", "-0.1 rad"])
    weight = 900.0 * GRAVITY
    arms = 0.25 * math.cos(0.1) - 0.9 * math.sin(0.1)
    expected = [0.0, 0.25 * weight, arms * weight, -arms * weight]
    assert np.allclose(held.restoring_moment, expected, rtol=1e-8)
    assert held.held_contact_state.to_numpy().tolist() == [0, 2, 2, 1]
    assert system.equilibrium().uplift_angle == 0.0
    with pytest.raises(AssemblyError, match="rigid bases have no small motion"):
        system.frequencies()


def test_sweeps_of_rigid_stacks():
    def scene(height):
        return on_rigid(STATUE.replace(height=f"{height} m"), PLINTH)

    runs = rf.sweep(scene, motions=[PULSE], height=[1.5, 1.8], duration="1 s")
    alone = [scene(h).simulate(PULSE, duration="1 s", second_look=False)
             for h in (1.5, 1.8)]  # fmt: skip
    found = runs.peak_rotation.to_numpy().ravel().tolist()
    assert found == [float(one.peak_rotation) for one in alone]


@pytest.mark.parametrize("count", [3, 5])
def test_columns_of_drums(count):
    drums = [rf.Block(width=f"{0.6 + 0.05 * k} m", height="0.8 m", mass="1 t")
             for k in range(count)]  # fmt: skip
    system = rf.System(rf.Stack(*drums, interfaces=[RIGID] * (count - 1)))
    run = system.simulate(shaken(4.0, 1.5), duration="0.45 s")
    assert run.sizes["event"] > 0
    assert float(run.energy_residual) < 1e-7


@pytest.mark.parametrize(("count", "duration"), [(6, "0.5 s"), (8, "0.4 s")])
def test_columns_of_many_drums_run_and_balance_their_energies(count, duration):
    drum = rf.Block(width="1 m", height="0.8 m", mass="1 t")
    column = rf.Stack(*[drum] * count, interfaces=[rf.RigidGround()] * (count - 1))
    pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1.5 Hz")
    system, options = rf.System(column), {"duration": duration, "outputs": ("energy",)}
    run = system.simulate(pulse, **options)
    assert float(run.energy_residual) < 1e-8
    assert run.sizes["body"] == count
    assert float(run.peak_rotation) > 1e-3
    if count == 6:
        other = system.simulate(pulse.scaled(-1.0), **options)
        np.testing.assert_allclose(other.rotation, -run.rotation, rtol=0, atol=1e-10)


def test_more_links_than_can_be_numbered_are_refused():
    drum = rf.Block(width="1 m", height="0.8 m", mass="1 t")
    column = rf.Stack(*[drum] * 12, interfaces=[rf.RigidGround()] * 11)
    tie = rf.Restrainer(on=("-0.5 m", "0 m"), to=("-2 m", "0 m"), stiffness="1 MN/m")
    with pytest.raises(AssemblyError, match="8 links are more than 12 bodies can have"):
        _ = rf.System(column, *[tie] * 8).simulate(duration="0.1 s")


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize(
    ("number", "ends"),
    [
        (19, "0.43 s"),  # decaying bounces while friction on soil slips and sticks in turn
        (5998, "0.32 s"),  # a corner whose impacts overcome friction on pads
        # two corners that throw each other up
        pytest.param(483, "0.32 s", marks=pytest.mark.long),
        (1284, "0.02 s"),  # a base held by any force under one that slips
        (5678, "0.6 s"),  # two opposite slips that start at once
        # a corner that bears again because the released one would not press
        pytest.param(5699, "1.1 s", marks=pytest.mark.long),
        (6897, "0.89 s"),  # two corners of which either pulls, and returns, without the other
        (7278, "0.302 s"),  # an end of a pad that keeps waiting while a corner elsewhere separates
        # a hold that separates a corner below instead of lifting its own end
        pytest.param(1234, "1.845 s", marks=pytest.mark.long),
        (6946, "0.73 s"),  # a base that slips more the more it is held back
        # an ending slip after which a corner is held without pressing
        pytest.param(9364, "1.188 s", marks=pytest.mark.long),
        (3184, "0.24 s"),  # a corner held without pressing, other than the one that separates
        (2972, "2.4 s"),  # bounces on a pad by rounding
        (5525, "0.22 s"),  # corners of one base, closed by rates of rounding
        (4018, "0.08 s"),  # a corner that returns from below its base
    ],
)
def test_contact_changes_terminate(number, ends):
    """Each run once stopped early, by endless contact changes or an inadmissible force."""
    system, motion = draw_scene("stack of mixed bases", np.random.default_rng(number))
    with plain_python():
        found = system.simulate(
            motion, duration=ends, accuracy="fast", outputs=None, second_look=False
        )
    assert int(found.status) == Status.COMPLETED


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
def test_light_drum_does_not_alternate_between_slip_and_stick():
    """A nearly weightless drum would slip and stick in turn: it tilts as it begins to slip."""
    system, motion = draw_column(142)
    found = system.simulate(motion, duration="0.12 s", outputs=None)
    assert int(found.status) == Status.COMPLETED


@pytest.mark.long  # no other test compiles the equations of six and seven drums
@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize(
    ("number", "ends"),
    [(217, "1.4 s"), (163, "0.32 s"), (315, "0.65 s")],
    ids=["a set far from that with sticking", "small bounces of drums that slip", "a slip jams"],
)
def test_drum_columns_complete_previously_failing_runs(number, ends):
    """Eleven closed corners and more, slips ended by small bounces, and missing forces."""
    system, motion = draw_column(number)
    found = system.simulate(
        motion, duration=ends, accuracy="standard", outputs=None, second_look=False
    )
    assert int(found.status) == Status.COMPLETED


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize(("number", "ends", "most"), [(684, "0.5 s", 1e-5), (434, "0.53 s", 1e-3)])
def test_onset_of_slip_preserves_velocity(number, ends, most):
    """A held body begins to slip when another body on pads changes its contact."""
    system, motion = draw_scene("stack of mixed bases", np.random.default_rng(number))
    with plain_python():
        found = system.simulate(
            motion, duration=ends, accuracy="fast", outputs=None, second_look=False
        )
    assert float(found.energy_residual) < most


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
def test_body_beyond_friction_limit_is_not_held():
    """It cannot slip with the bearing corners; two of them separate."""
    system, motion = draw_scene("stack of mixed bases", np.random.default_rng(4852))
    found = system.simulate(motion, duration="1.31 s", accuracy="fast", outputs=None)
    assert int(found.status) == Status.COMPLETED


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
def test_a_pad_that_catches_up_creates_no_energy():
    """The end in contact does not slide by a force that makes a corner below pull."""
    system, motion = draw_scene("stack of mixed bases", np.random.default_rng(1835))
    with plain_python():
        found = system.simulate(
            motion, duration="0.66 s", accuracy="fast", outputs=None, second_look=False
        )
    assert float(found.energy_residual) < 1e-4


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
def test_stack_in_joint_free_fall_lands_without_rotation():
    """The ground falls faster four times; rates of 1e-29 once made the upper block bounce."""
    system, motion = draw_scene("stack of mixed bases", np.random.default_rng(326))
    with plain_python():
        found = system.simulate(
            motion, duration="1.15 s", accuracy="fast", outputs=None, second_look=False
        )
    assert float(found.peak_rotation) < 1e-15


@pytest.mark.parametrize("most", [0, 1, 3, 8])
def test_sets_near_one_are_found_from_the_highest_down(most):
    near = NearbySubsets(0b110110111, 0b010010101, most)
    found, some = [], next_subset(near.closed, near)
    while some >= 0:
        found.append(some)
        some = next_subset(some - 1, near)
    subsets = [one for one in range(near.closed, -1, -1) if one & ~near.closed == 0]
    assert found == [one for one in subsets if (one ^ near.reference).bit_count() <= most]


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
def test_several_sets_at_a_change_of_slip_are_no_modes_of_an_impact():
    system, motion = draw_scene("stack of mixed bases", np.random.default_rng(38))
    with plain_python():
        found = system.simulate(motion, accuracy="fast", outputs=None, second_look=False)
    caution = "and there are 2 ways to bear and to slip then: taken is one with body 1 in full"
    assert caution in found.attrs["cautions"]
    assert found.attrs["impacts_of_several_modes"] == 0


@pytest.mark.parametrize(
    ("plate", "ground", "joint", "rule"),
    [  # height [m] and mass [kg] of a plate, friction below and above it
        ((0.6, 14.0), 0.27, None, "centre"),
        ((0.5, 3.0), None, 0.6, "leading-corner"),
        ((0.5, 20.0), 0.76, None, "leading-corner"),
    ],
)
def test_landing_on_pads_above_a_light_body_creates_no_energy(plate, ground, joint, rule):
    """The impulse that stops the landing body exceeds what the light one can transmit."""
    height, mass = plate
    lower = rf.Block(width="0.6 m", height=f"{height} m", mass=f"{mass} kg")
    pads = rf.TwoSpringSupport(
        frequency_ratio=40, damping_ratio=0.0, restitution=0.001, friction=joint
    )
    stack = rf.Stack(STATUE, lower, interfaces=[pads])
    system = rf.System(stack, rf.RigidGround(friction=ground), restraint=rule)
    rng = np.random.default_rng(2)
    across = 4.0 * np.convolve(rng.normal(size=100), np.ones(6) / 6.0**0.5, "same")
    upwards = 2.0 * rng.normal(size=100)
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), "0.02 s", vertical=(upwards, "m/s^2"))
    run = system.simulate(motion, outputs=["energy"], output_step="1 ms")
    taken = (run.impact_energy + run.repinning_energy).to_numpy()
    assert np.diff(taken).min() > -1e-9 * float(np.abs(run.input_energy).max())
    assert run.energy_residual < 1e-6


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")  # of impacts without a mode
@pytest.mark.parametrize(
    ("mass", "rule", "seed"),
    [(10.0, "leading-corner", 11), (40.0, "contact-state", 3), (10.0, "centre", 6)],
)
def test_holding_after_flight_above_a_light_body_creates_no_energy(mass, rule, seed):
    """The impulse that stops the slip of a landing body exceeds what a light one can transmit."""
    tall = rf.Block(width="1.6 m", height="5.7 m", mass="1500 kg")
    plate = rf.Block(width="2.2 m", height="1.5 m", mass=f"{mass} kg")
    pads = rf.TwoSpringSupport(frequency_ratio=90, damping_ratio=0.0)
    stack = rf.Stack(tall, plate, interfaces=[pads])
    system = rf.System(stack, rf.RigidGround(), restraint=rule)
    rng = np.random.default_rng(seed)
    across = 5.0 * np.convolve(rng.normal(size=150), np.ones(6) / 6.0**0.5, "same")
    upwards = 5.0 * rng.normal(size=150)
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), "0.02 s", vertical=(upwards, "m/s^2"))
    run = system.simulate(motion, outputs=["energy"], output_step="1 ms", second_look=False)
    taken = (run.impact_energy + run.repinning_energy).to_numpy()
    assert np.diff(taken).min() > -1e-9 * float(np.abs(run.input_energy).max())
    assert run.energy_residual < 1e-6


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize("number", [122, 123])
def test_coming_to_rest_while_slipping_creates_no_energy(number):
    """The end of bounces may pull; friction does not act then, since it would drive the slip."""
    system, motion = draw_scene("stack of mixed bases", np.random.default_rng(number))
    run = system.simulate(motion, outputs=["energy"], accuracy="fast", second_look=False)
    taken = (run.impact_energy + run.repinning_energy).to_numpy()
    assert np.diff(taken).min() > -1e-10 * float(run.kinetic_energy.max())


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize("seed", [2, 9])
def test_short_slip_reversed_by_an_impact_is_opposed_by_friction(seed):
    """On pads beneath two heavy bodies: friction in its former direction would drive the slip."""
    upper = rf.Block(width="0.9 m", height="3 m", mass="1860 kg")
    middle = rf.Block(width="1.2 m", height="3.9 m", mass="315 kg")
    plate = rf.Block(width="1.7 m", height="0.95 m", mass="6 kg")
    joints = [
        rf.RigidGround(friction=0.3), rf.RigidGround(friction=0.38, kinetic_friction=0.27),
    ]  # fmt: skip
    pads = rf.TwoSpringSupport(
        frequency_ratio=47, damping_ratio=0.0, friction=0.46, kinetic_friction=0.32
    )
    stack = rf.Stack(upper, middle, plate, interfaces=joints, offsets=["2 cm", "1 cm"])
    rng = np.random.default_rng(seed)
    across = 4.0 * np.convolve(rng.normal(size=100), np.ones(6) / 6.0**0.5, "same")
    upwards = 5.0 * rng.normal(size=100)
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), "0.02 s", vertical=(upwards, "m/s^2"))
    run = rf.System(stack, pads, restraint="centre").simulate(
        motion, outputs=["energy"], output_step="1 ms", second_look=False
    )
    taken = (run.impact_energy + run.repinning_energy).to_numpy()
    assert np.diff(taken).min() > -1e-9 * float(run.kinetic_energy.max())


def sliding_upon_a_landing_body(restitution):
    """Return the model of a body that slips on one that lands on pads, and its events."""
    upper = rf.Block(width="0.6 m", height="2 m", mass="15 kg")
    lower = rf.Block(width="0.8 m", height="0.65 m", mass="25 kg")
    pads = rf.TwoSpringSupport(
        frequency_ratio=60, damping_ratio=0.0, restitution=restitution, friction=0.6
    )
    stack = rf.Stack(upper, lower, interfaces=[rf.RigidGround(friction=0.2)])
    model = rf.System(stack, pads, restraint="leading-corner").setting.compile()
    rng = np.random.default_rng(0)
    across = 3.0 * np.convolve(rng.normal(size=100), np.ones(6) / 6.0**0.5, "same")
    upwards = 5.0 * rng.normal(size=100)
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), "0.02 s", vertical=(upwards, "m/s^2"))
    run = integrate(
        model, Start(), motion.si, accuracy_of("standard"), duration=2.0, output_step=None,
        stop_at_overturning=True,
    )  # fmt: skip
    return model.system, run.events


@pytest.mark.parametrize("restitution", [0.001, 0.3])
def test_landing_beneath_a_sliding_body_obeys_restitution(restitution):
    """Whatever share of the impulse the body above takes, more or less than before."""
    system, events = sliding_upon_a_landing_body(restitution)
    base, landings = system.on_base(1), 0
    for i in np.flatnonzero(events.kind == IMPACT):
        contact = system.body_mode(int(events.mode_before[i]), 1).contact
        before, after = (
            system.state_of(1, one[i]) for one in (events.state_before, events.state_after)
        )
        line = base.body.base_line_at(before)
        for left in (True, False):
            speed, _ = end_speed(base, left, before)
            comes = not base.base.is_held(contact, left) and speed < -1e-3
            if comes and abs(base.base.level(left, line, ())) < 1e-9:
                ratio = end_speed(base, left, after)[0] / speed
                assert ratio == pytest.approx(restitution, abs=1e-5), events.time[i]
                landings += 1
    assert landings > 20


@pytest.mark.parametrize("restitution", [0.001, 0.3])
def test_impulse_on_a_body_above_a_landing_obeys_friction_limit(restitution):
    """Where no corner closes, all impulses are rounding and must not stop a slip."""
    system, events = sliding_upon_a_landing_body(restitution)

    def velocity(mode, state):
        system.energies(int(mode), state)
        return np.array([system.workspace()[one] for one in (at.SPEED_X, at.SPEED_Y)])

    blows = 0
    for i in np.flatnonzero(events.kind == IMPACT):
        change = velocity(events.mode_after[i], events.state_after[i])
        change -= velocity(events.mode_before[i], events.state_before[i])
        turned = system.state_of(1, events.state_before[i]).rotation
        sine, cosine = math.sin(turned), math.cos(turned)
        along, normal = change @ (cosine, -sine), change @ (sine, cosine)
        assert abs(along) <= 0.2 * max(normal, 0.0) + 1e-4, events.time[i]
        blows += normal > 1e-3
    assert blows > 20


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("above", [1.0, -1.0])
def test_ending_a_short_slip_loses_only_its_own_energy(sense, above):
    """The slip ends at once, before friction above can change."""
    light = rf.Block(width="1 m", height="0.65 m", mass="25 kg")
    joint, pads = rf.RigidGround(friction=0.2), rf.TwoSpringSupport(
        frequency_ratio=60, damping_ratio=0.1, friction=0.6
    )  # fmt: skip
    stack = rf.Stack(STATUE, light, interfaces=[joint], offsets=["0.15 m"])
    model = rf.System(stack, pads, restraint="centre").setting.compile()
    system, (mode, state, memory) = model.system, model.initial(Start())
    mode = system.with_slip_sense(system.with_slip_sense(mode, 0, above), 1, sense)
    rate = system.coordinates() + system.horizontal_of(1)
    state[system.coordinates() + system.horizontal_of(0)], state[rate] = above, 1e-6 * sense
    kinetic = system.energies(mode, state).kinetic
    new = system.end_short_slip(1, mode, state, Ground(0.0, 0.0), memory)
    assert not system.body_mode(new, 1).slides
    assert kinetic - system.energies(new, state).kinetic == pytest.approx(
        memory[IMPACT_LOSS], rel=1e-3
    )
    assert 0.0 < memory[IMPACT_LOSS] < 1e-12
