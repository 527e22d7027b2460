"""A block that slips on pads or a bed: limits, symmetry, energies, and warnings."""

import numpy as np
import pytest
from benchmarks.random_parts import draw_scene
from plain_python import plain_python

import rockframe as rf
from rockframe.dynamics.chain import model
from rockframe.dynamics.chain.rigid_friction import SlippingRigidChain
from rockframe.dynamics.coulomb import ImpulseResponse, coulomb_impulse
from rockframe.dynamics.protocol import IMPACT_LOSS, Start
from rockframe.errors import AssemblyError, ComponentError
from rockframe.solve.workspace import Status

pytestmark = [pytest.mark.wide, pytest.mark.analytical, pytest.mark.filterwarnings("ignore")]

BLOCK = rf.Block(width="1 m", height="3 m", mass="1 t")
PADS = rf.TwoSpringSupport(frequency_ratio=12, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="2 MPa", damping_ratio=0.1)
BASES = pytest.mark.parametrize("base", [PADS, SOIL], ids=["pads", "soil"])
TIMES = np.arange(0.0, 1.01, 0.05)
ACROSS, UP = 3.4 * np.sin(9.0 * TIMES), 2.0 * np.sin(14.0 * TIMES)


def motion(sign=1.0):
    return rf.GroundMotion.from_arrays(
        (sign * ACROSS, "m/s^2"), "0.05 s", vertical=(UP, "m/s^2")
    )  # fmt: skip


def run(base, *, sign=1.0, accuracy="standard", **options):
    return rf.System(BLOCK, base, **options).simulate(
        motion(sign), free_vibration="0.3 s", accuracy=accuracy, outputs=("energy",)
    )


def flags(found):
    meanings = str(found.contact_state.attrs["flag_meanings"]).split()
    return dict(zip(meanings, found.contact_state.attrs["flag_values"], strict=True))


@BASES
def test_frictionless_block_slips_by_ground_displacement(base):
    found = run(base.replace(friction=0.0))
    ground = motion().si.horizontal.samples
    step = 0.05  # linear between samples: velocity and displacement of the ground by parts
    speed = np.concatenate([[0.0], np.cumsum(0.5 * step * (ground[1:] + ground[:-1]))])
    place = np.cumsum(step * speed[:-1] + step**2 * (ground[:-1] / 3.0 + ground[1:] / 6.0))
    np.testing.assert_allclose(
        found.slip.sel(time=1.0, method="nearest"), -place[-1], rtol=0.0, atol=1e-9
    )
    assert abs(found.rotation).max() < 1e-12


@BASES
@pytest.mark.parametrize("rule", ["contact-state", "leading-corner"])
def test_slip_is_zero_at_start_in_flight(base, rule):
    system = rf.System(BLOCK, base.replace(friction=0.3), restraint=rule)
    above = rf.InitialState(rotation="0.1 rad", vertical_displacement="0.3 m")
    found = system.simulate(motion(), initial=above, duration="0.3 s")
    assert found.contact_state[0] == flags(found)["flight"]
    assert found.slip[0] == pytest.approx(0.0, abs=1e-15)


@BASES
def test_peak_slip_excludes_final_flight(base):
    fast = np.arange(60) < 30
    across, up = np.where(fast, 5.0, 0.0), np.where(fast, 0.0, -40.0)  # then the ground falls away
    thrown = rf.GroundMotion.from_arrays(
        (across, "m/s^2"), "0.01 s", vertical=(up, "m/s^2")
    )  # fmt: skip
    system = rf.System(BLOCK.replace(height="1 m"), base.replace(friction=0.3))
    found = system.simulate(thrown, output_step="1 ms")
    flies = (found.contact_state == flags(found)["flight"]).to_numpy()
    slips = abs(found.slip).to_numpy()
    assert flies[-1]
    assert slips[-1] > 2.0 * slips[~flies].max()
    assert found.peak_slip == pytest.approx(slips[~flies].max(), rel=0.01)


@BASES
@pytest.mark.parametrize("rule", ["contact-state", "leading-corner"])
def test_infinite_friction_converges_to_held_base(base, rule):
    # a held point changes before the restitution of an impact, a slipping one within it
    if base is PADS and rule == "contact-state":
        base = base.replace(restitution=1.0)
    held = run(base, restraint=rule, accuracy="reference")
    far = {}
    for friction in (1e4, 1e8):
        found = run(base.replace(friction=friction), restraint=rule, accuracy="reference")
        far[friction] = abs(found.rotation - held.rotation).max().item() / held.peak_rotation.item()
        assert found.attrs["verdict"].startswith("Did not slide")
    assert far[1e4] < 1e-4
    assert far[1e8] < 1e-8


@BASES
def test_mirror_images_are_the_same(base):
    one, other = (run(base.replace(friction=0.1), sign=sign) for sign in (1.0, -1.0))
    assert one.peak_slip > 1e-3
    np.testing.assert_allclose(one.slip, -other.slip, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(one.rotation, -other.rotation, rtol=0.0, atol=1e-14)


@BASES
def test_energies_balance_with_the_work_of_friction(base):
    found = run(base.replace(friction=0.15, kinetic_friction=0.1), accuracy="reference")
    assert found.peak_slip > 1e-3
    assert found.energy_residual < 1e-8
    assert (np.diff(found.dissipated_energy) >= -1e-9 * found.dissipated_energy.max().item()).all()


def test_run_reports_slip_and_its_events():
    found = run(PADS.replace(friction=0.25))
    assert found.attrs["verdict"].startswith("Slid 0.")
    kinds = found.event_kind.attrs["flag_meanings"].split()
    values = found.event_kind.attrs["flag_values"]
    kinds_met = {kinds[list(values).index(one)] for one in found.event_kind.values}
    assert {"slip", "stick"} <= kinds_met
    assert found.slip[-1] == found.residual_slip
    assert abs(found.slip).max() <= found.peak_slip * (1.0 + 1e-12)
    assert "mu_k" in rf.System(BLOCK, PADS.replace(friction=0.25)).describe()


def test_slip_refuses_small_rotation_and_checked_friction_holds():
    pads = PADS.replace(friction=0.25)
    with pytest.raises(AssemblyError, match="finite"):
        rf.System(BLOCK, pads, rotation="small")
    assert not rf.System(BLOCK, pads, sliding="checked").setting.slides
    assert list(rf.model_ladder(rf.System(BLOCK, pads)))[-2:] == ["two pads", "two pads, sliding"]
    with pytest.raises(ComponentError, match="at most the friction at rest"):
        PADS.replace(kinetic_friction=0.2)


def test_coulomb_impulse_dissipates_for_any_friction():
    rng = np.random.default_rng(5)
    for _ in range(300):
        root = rng.normal(size=(2, 2))
        matrix = root @ root.T + 0.01 * np.eye(2)
        before = np.array([rng.normal(), -rng.random()])  # along, normal
        share = rng.random()
        answers = ImpulseResponse(matrix[1, 1], matrix[1, 0], matrix[0, 1], matrix[0, 0])
        friction = rng.choice([0.0, rng.random(), 3.0])
        impulse = np.array(coulomb_impulse(answers, before[0], share * before[1], friction))
        after = before + matrix @ impulse
        np.testing.assert_allclose(after[1], (1.0 - share) * before[1], atol=1e-12)
        assert abs(impulse[0]) <= friction * impulse[1] + 1e-12
        inverse = np.linalg.inv(matrix)
        assert after @ inverse @ after <= before @ inverse @ before + 1e-12


STATUE = rf.Block(width="0.6 m", height="1.8 m", mass="0.5 t")
PLINTH = rf.Block(width="1 m", height="1 m", mass="1.5 t")
PULSE = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1.5 Hz")


@pytest.mark.parametrize("eccentricity", ["0 m", "0.1 m"])
def test_simultaneous_landing_obeys_restitution_and_friction_cone(eccentricity):
    """Each by its own speed, both impulses in the friction cone; or one, which lifts the other.

    Both are simultaneous, so that a block that falls flat stays flat.
    """
    block, rng, singles = BLOCK.replace(eccentricity=eccentricity), np.random.default_rng(7), 0
    for friction in (0.1, 0.3, 0.6, np.inf):
        frictions = {"friction": min(friction, 1e9), "kinetic_friction": min(friction, 0.6)}
        model = rf.System(block, PADS.replace(restitution=0.3, **frictions)).setting.compile()
        system, (full, rest, memory) = model.system, model.initial(Start())
        mode, part = system.with_slip_sense(full, 0, 1.0), system.on_base(0)
        for slips in (0.0, *rng.normal(size=30)):
            state = rest.copy()
            state[3:] = 0.2 * rng.normal() * (slips != 0.0), -1.0, slips
            before, initial = part.body.base_line_at(system.state_of(0, state)), state.copy()
            lost = memory[IMPACT_LOSS]
            system.strike(0, True, True, mode, state, memory)
            after = part.body.base_line_at(system.state_of(0, state))
            excess = np.array([
                after.left_speed - 0.3 * before.left_speed,
                after.right_speed - 0.3 * before.right_speed,
            ])  # fmt: skip
            _, press, along = state[3:] - initial[3:]
            assert abs(along) <= min(friction, 0.6) * press * (1.0 + 1e-12) + 1e-15
            assert memory[IMPACT_LOSS] > lost
            assert excess.min() == pytest.approx(0.0, abs=1e-12)
            singles += excess.max() > 1e-9
            if slips == 0.0 and eccentricity == "0 m":
                np.testing.assert_allclose(state[3:], [0.0, -0.3, 0.0], atol=1e-14)
    assert 0 < singles < 60


def stacked(upper, lower, pads=PADS):
    stack = rf.Stack(STATUE, PLINTH, interfaces=[pads.replace(friction=upper)])
    return rf.System(stack, SOIL.replace(friction=lower)).simulate(
        PULSE, free_vibration="0.2 s", accuracy="reference", outputs=("energy",)
    )


@pytest.mark.long
@pytest.mark.parametrize("frictions", [(0.2, 0.25), (0.2, 1.0), (1.0, 0.2)])
def test_stack_slip_stays_within_friction_cone(frictions):
    found = stacked(*frictions)
    assert found.energy_residual < 1e-8
    for k, friction in enumerate(frictions):
        one = found.isel(body=k)
        along, normal = one.body_horizontal_reaction, one.body_vertical_reaction
        weight = abs(normal).max().item()
        assert (abs(along) <= friction * abs(normal) + 1e-9 * weight).all()
        rate = np.gradient(one.body_slip, one.time)
        slips = (abs(rate) > 0.05) & (normal > 0.01 * weight)
        if friction < 0.3:  # friction opposes the slip fully
            assert slips.any()
            assert (np.sign(along)[slips] == -np.sign(rate)[slips]).mean() > 0.9
    np.testing.assert_allclose(
        found.peak_body_slip, abs(found.body_slip).max("time"), rtol=0.05, atol=1e-6
    )
    assert "body 2" in found.attrs["verdict"]


@pytest.mark.long
def test_stack_with_infinite_friction_is_held():
    pads = PADS.replace(restitution=1.0)
    held, found = stacked(None, None, pads), stacked(1e8, 1e8, pads)
    far = abs(found.body_rotation - held.body_rotation).max().item()
    assert far < 1e-7 * held.peak_rotation.item()


@pytest.mark.long
@pytest.mark.parametrize(("upper", "lower"), [(0.2, None), (None, 0.25)])
def test_held_base_matches_infinite_friction_in_mixed_stack(upper, lower):
    pads = PADS.replace(restitution=1.0)
    held = stacked(upper, lower, pads)
    found = stacked(upper or 1e8, lower or 1e8, pads)
    for name in ("body_rotation", "body_slip"):
        most = abs(held[name]).max().item()
        assert most > 1e-3
        assert abs(found[name] - held[name]).max().item() < 1e-6 * most


@pytest.mark.long
def test_general_and_compliant_slipping_chains_agree(monkeypatch):
    one = stacked(0.2, 0.25)
    monkeypatch.setattr(model, "SlippingChain", SlippingRigidChain)
    other = stacked(0.2, 0.25)
    np.testing.assert_array_equal(one.event_kind, other.event_kind)
    for name in ("body_rotation", "body_slip"):
        np.testing.assert_allclose(one[name], other[name], rtol=0.0, atol=1e-12)


def test_checked_friction_in_stack_is_refused():
    stack = rf.Stack(STATUE, PLINTH, interfaces=[PADS.replace(friction=0.3)])
    with pytest.raises(AssemblyError, match="is computed"):
        rf.System(stack, SOIL.replace(friction=0.3), sliding="checked")


def two_bodies(**friction):
    """Run two bodies on compliant bases after a jump of the ground that makes both slip."""
    jump = rf.GroundMotion.from_arrays((np.full(7, 1.5), "m/s^2"), "0.05 s")
    plinth = rf.Block(width="1.5 m", height="2 m", mass="3 t")
    stack = rf.Stack(BLOCK, plinth, interfaces=[PADS.replace(frequency_ratio=20, **friction)])
    soil = SOIL.replace(stiffness="20 MPa", **friction)
    with plain_python():
        found = rf.System(stack, soil).simulate(jump, duration="0.3 s", second_look=False)
    assert found.status.item() == 0
    return found


@pytest.mark.parametrize("friction", [1e-12, 1e-8, 1e-6])
def test_tiny_friction_approaches_frictionless_slip(friction):
    none, some = (two_bodies(friction=one).body_slip for one in (0.0, friction))
    assert float(abs(none).max()) > 0.05
    np.testing.assert_allclose(some, none, rtol=0.0, atol=friction)


@pytest.mark.parametrize(
    "friction", [1e5, 1e15, *(pytest.param(one, marks=pytest.mark.long) for one in (1e7, 1e9))]
)
def test_arbitrarily_large_friction_holds(friction):
    held, slippery = (two_bodies(**options).rotation for options in ({}, {"friction": friction}))
    np.testing.assert_allclose(slippery, held, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(("number", "ends"), [(189, "0.1 s"), (169, "0.13 s"), (174, "0.13 s")])
def test_large_friction_does_not_chatter_from_rounding(number, ends):
    """Each body once slipped and stuck endlessly when its friction reached the limit."""
    random_system, shake = draw_scene("friction on pads", np.random.default_rng(number))
    block = random_system.parts["block"]
    width, height = block.si.width, block.si.height
    below = rf.Block(
        width=f"{1.4 * width} m", height=f"{max(height, 1.1 * width)} m", mass="3 t"
    )  # fmt: skip
    pads = PADS.replace(frequency_ratio=20, friction=1e5)
    stack = rf.Stack(block, below, interfaces=[pads])
    with plain_python():
        found = rf.System(stack, pads).simulate(
            shake, duration=ends, outputs=None, second_look=False
        )
    assert int(found.status) == Status.COMPLETED


@BASES
def test_a_squat_block_slides_where_its_base_has_friction(base):
    squat = rf.Block(width="2 m", height="1 m", mass="4 t")
    system = rf.System(squat, base.replace(friction=0.2))
    found = system.simulate(motion(), free_vibration="0.3 s", outputs=("energy",))
    assert found.status.item() == 0
    assert float(found.energy_residual) < 1e-6
    assert float(found.peak_slip) > 0.01


def test_squat_block_has_zero_restitution_on_pads():
    squat = rf.Block(width="2 m", height="1 m", mass="4 t")
    assert squat.maximum_restitution == pytest.approx(-0.2)
    system = rf.System(squat, PADS.replace(friction=0.3))
    assert set(system.setting.support.restitution) == {0.0}
    with pytest.raises(AssemblyError, match="cannot rock"):
        rf.System(squat, PADS)
    assert not any("eps_max" in one for one in system.setting.cautions())
    # released at a tilt it comes to rest, where rebounding corners bounce endlessly
    tilted = rf.InitialState(rotation="0.2 rad")
    found = system.simulate(initial=tilted, duration="3 s", outputs=("energy",))
    assert found.status.item() == 0
    assert float(found.energy_residual) < 1e-6
    assert abs(found.rotation[-1]) < 1e-3


@pytest.mark.parametrize(
    ("number", "ends"),
    [
        pytest.param(733, "0.76 s", marks=pytest.mark.long),
        pytest.param(379, "1.88 s", marks=pytest.mark.long),
        (1318, "1.74 s"),
        (358, "2.05 s"),
    ],
)
def test_corners_of_squat_bodies_do_not_chatter_from_rounding(number, ends):
    """Each once landed and separated endlessly when it touched its pad while rising."""
    system, motion = draw_scene("stack of squat bodies", np.random.default_rng(number))
    with plain_python():
        found = system.simulate(
            motion, duration=ends, accuracy="fast", outputs=None, second_look=False
        )
    assert int(found.status) <= Status.TOPPLED


def test_body_with_negligible_slip_does_not_chatter():
    """It once slipped to either side at the middle and a corner, while its end left and landed."""
    system, motion = draw_scene("stack of squat bodies", np.random.default_rng(2412))
    with plain_python():
        found = system.simulate(motion, duration="0.36 s", outputs=("energy",))
    assert int(found.status) <= Status.TOPPLED
    assert float(found.energy_residual) < 1e-8


def test_overturning_at_instant_of_another_event_ends_run():
    """State and mode were once those after the preceding landing, and the run ended."""
    system, motion = draw_scene("stack of squat bodies", np.random.default_rng(840))
    with plain_python():
        found = system.simulate(motion, accuracy="fast", outputs=None, second_look=False)
    assert int(found.status) == Status.OVERTURNED
    assert found.event_time[-1] == found.event_time[-2] == found.overturning_time


@pytest.mark.long
def test_bounces_and_slips_end_at_huge_friction():
    """A body once separated and was held endlessly while the body below slipped."""
    system, motion = draw_scene("stack with friction of any size", np.random.default_rng(650))
    found = system.simulate(motion, duration="1.03 s", outputs=("energy",), second_look=False)
    assert int(found.status) <= Status.TOPPLED
    assert float(found.energy_residual) < 1e-8
