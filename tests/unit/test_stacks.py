"""Stacks: the part, its scenes, and results of its bodies."""

import pickle

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.components import stack
from rockframe.dynamics.events import ContactState
from rockframe.dynamics.protocol import MAX_MODES
from rockframe.errors import AssemblyError, ComponentError, RockframeError, UnitsError
from rockframe.simulation.certify.perturbations import parameters
from rockframe.system.assembly import assemble

STATUE = rf.Block(width="0.5 m", height="1.8 m", mass="900 kg")
PLINTH = rf.Block(width="0.9 m", height="1 m", mass="2200 kg")
JOINT = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
GROUND = rf.TwoSpringSupport(frequency_ratio=30, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2)
PULSE = rf.GroundMotion.sine_pulse(amplitude="-3 m/s^2", frequency="1.5 Hz")
STACK = rf.Stack(STATUE, PLINTH, interfaces=[JOINT])
SLIPPERY = rf.Stack(STATUE, PLINTH, interfaces=[JOINT.replace(friction=0.5)])
TALLEST = rf.Stack(*[PLINTH] * 12, interfaces=[JOINT] * 11)
PLAN = {"free_vibration": "1 s", "accuracy": "fast", "second_look": False}


@pytest.fixture(scope="module")
def run():
    plan = PLAN | {"accuracy": "standard"}
    return rf.System(STACK, GROUND).simulate(PULSE, outputs=["energy"], **plan)


def test_stack_attributes_and_round_trips():
    stack = rf.Stack(STATUE, PLINTH, interfaces=[JOINT], offsets=["2 cm"])
    assert stack.bodies == (STATUE, PLINTH)
    assert stack.interfaces == (JOINT,)
    assert [one.to("cm").magnitude for one in stack.offsets] == [2.0]
    drums = (PLINTH, PLINTH, PLINTH)
    assert rf.Stack(*drums, interfaces=JOINT) == rf.Stack(*drums, interfaces=[JOINT, JOINT])
    with pytest.raises(UnitsError, match=r"offsets\[0\] needs a length with a unit"):
        stack.replace(offsets=([0.1], "m"))
    assert rf.Stack.from_dict(stack.to_dict()) == stack
    assert pickle.loads(pickle.dumps(stack)) == stack  # noqa: S301
    assert stack != STACK
    assert len({stack, STACK, rf.Stack(STATUE, PLINTH, interfaces=[JOINT])}) == 2
    assert "offsets=['0.02 m']" in repr(stack)
    with pytest.raises(AttributeError, match="immutable"):
        stack.bodies = ()


def test_a_stack_is_changed_by_copying():
    stack = rf.Stack(STATUE, PLINTH, interfaces=[JOINT], offsets=["2 cm"])
    assert stack.replace() == stack
    assert stack.replace(offsets=None) == STACK
    assert stack.replace(bodies=(STATUE, PLINTH.replace(mass="3 t"))).bodies[1] != PLINTH
    other = JOINT.replace(frequency_ratio=70)
    assert stack.replace(interfaces=[other]).interfaces == (other,)
    with pytest.raises(TypeError, match="interface"):
        stack.replace(interface=[other])


@pytest.mark.parametrize(
    ("bodies", "options", "words"),
    [
        ((STATUE,), {"interfaces": []}, "2 to 15 bodies, got 1"),
        ((STATUE, PLINTH), {"interfaces": []}, "1 interfaces between them, got 0"),
        ((STATUE, JOINT), {"interfaces": [JOINT]}, "a body of a stack is a Block, got Two"),
        ((STATUE, PLINTH), {"interfaces": [PLINTH]}, "an interface is a base"),
        ((STATUE, PLINTH), {"interfaces": [JOINT], "offsets": []}, "each body but the lowest"),
        ((PLINTH, STATUE), {"interfaces": [JOINT]}, "base of body 1 from the top reaches 0.45 m"),
        ((STATUE, PLINTH), {"interfaces": [JOINT], "offsets": ["0.21 m"]}, "reaches 0.46 m"),
    ],
)
def test_invalid_stack_is_refused(bodies, options, words):
    with pytest.raises(ComponentError, match=words):
        rf.Stack(*bodies, **options)


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ((STACK, GROUND, SOIL), "give one of them"),
        ((STACK, STATUE, GROUND), "a Stack and a Block are both given"),
        ((STACK, rf.CushionCap(height="1 m", mass="1 t"), SOIL), "as its lowest body"),
        ((TALLEST, rf.RigidGround()), "the contacts of 12 bodies on these bases have"),
        ((STACK, rf.RigidGround(restitution=0.9)), "restitution must not be given"),
        ((STACK, GROUND, rf.RigidGround()), "both given"),
    ],
)
def test_parts_that_do_not_fit_a_stack_are_refused(parts, words):
    with pytest.raises(AssemblyError, match=words):
        rf.System(*parts)


@pytest.mark.parametrize("slips", [{}, {"friction": 0.4}])
def test_mode_number_encodes_the_mode_of_each_body(slips):
    ground = rf.RigidGround(**slips)
    bed = rf.WinklerSoil(stiffness="1 GPa", damping_ratio=0.1)
    three = rf.Stack(STATUE, PLINTH, PLINTH, interfaces=[JOINT, bed])
    system = assemble((three, ground)).model.system
    rng = np.random.default_rng(3)
    for mode in rng.integers(0, system.modes(), 500).tolist():
        parts = [system.body_mode(mode, k) for k in range(3)]
        for k, part in enumerate(parts):
            other = system.with_body_mode(mode, k, system.body_mode(int(rng.integers(mode + 1)), k))
            assert [system.body_mode(other, j) for j in range(3) if j != k] == [
                one for j, one in enumerate(parts) if j != k
            ]
            assert system.with_body_mode(other, k, part) == mode


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize(("slips", "count"), [({}, stack.MAX_BODIES), ({"friction": 0.6}, 12)])
def test_many_drums_rock(slips, count):
    joint, widths = rf.RigidGround(**slips), 0.97 ** np.arange(count - 1, -1, -1)
    drums = [rf.Block(width=f"{width} m", height="0.9 m", mass="2 t") for width in widths]
    system = rf.System(rf.Stack(*drums, interfaces=joint), joint)
    pulse = rf.GroundMotion.sine_pulse("3 m/s^2", "1.5 Hz")
    run = system.simulate(pulse, duration="0.5 s", second_look=False)
    assert run.status == 0
    assert run.peak_rotation > 0.01
    assert run.energy_residual < 1e-6


@pytest.mark.parametrize(
    ("base", "most"),
    [
        (rf.RigidGround(), stack.MAX_BODIES),
        (rf.RigidGround(friction=0.6), 12),
        (rf.TwoSpringSupport(stiffness="20 MN/m", damping_ratio=0.1), 8),
        (rf.TwoSpringSupport(stiffness="20 MN/m", damping_ratio=0.1, friction=0.6), 7),
        (rf.WinklerSoil(stiffness="900 MPa", damping_ratio=0.1), 13),
        (rf.WinklerSoil(stiffness="900 MPa", damping_ratio=0.1, friction=0.6), 11),
    ],
)
def test_as_many_bodies_as_mode_numbers_suffice_for(base, most):
    drum = rf.Block(width="1 m", height="0.9 m", mass="2 t")
    system = rf.System(rf.Stack(*[drum] * most, interfaces=base), base)
    assert system.assembly.model.system.modes() <= MAX_MODES
    with pytest.raises(RockframeError, match=r"numbered|2 to 15 bodies"):
        rf.System(rf.Stack(*[drum] * (most + 1), interfaces=base), base).describe()


def test_no_slope_under_a_stack():
    with pytest.raises(AssemblyError, match="level ground"):
        rf.System(STACK, GROUND, inclination="2 deg").describe()


def test_a_run_shows_all_bodies(run, tmp_path):
    assert run.sizes["body"] == 2
    assert run.body.to_numpy().tolist() == [1, 2]
    for name in ("rotation", "horizontal_displacement", "vertical_displacement"):
        assert (run[f"body_{name}"][0] == run[name]).all()
    assert (run.body_contact_state[0] == run.contact_state).all()
    relative = run.body_rotation[0] - run.body_rotation[1]
    assert np.allclose(relative, run.body_rotation_on_base[0], atol=1e-15)
    assert np.allclose(run.body_rotation[1], run.body_rotation_on_base[1], atol=1e-15)
    weights = 9.80665 * np.array([900.0, 3100.0])
    assert np.allclose(run.body_vertical_reaction[:, 0], weights, rtol=1e-9)
    peaks = np.abs(run.body_rotation).max("time")
    assert (run.peak_body_rotation >= peaks - 1e-15).all()
    assert float(run.peak_body_rotation[0]) == pytest.approx(float(run.peak_rotation), rel=1e-4)
    assert set(run.event_body.to_numpy()) == {1, 2}
    run.to_netcdf(tmp_path / "stack.nc")
    with xr.open_dataset(tmp_path / "stack.nc") as stored:
        again = rf.System.from_dataset(stored)
    assert again.parts.stack == STACK
    assert float(run.energy_residual) < 1e-6


def test_body_outputs_need_not_be_requested(run):
    assert "body_rotation" in run
    with pytest.raises(AssemblyError, match="need not name 'body_rotation': a single run has it"):
        rf.System(STACK, GROUND).simulate(PULSE, outputs=["body_rotation"], **PLAN)


def test_event_body_is_the_body_whose_contact_changes(run):
    contacts = run.body_contact_state.to_numpy()
    after = np.searchsorted(run.time, run.event_time)
    assert (np.diff(after) > 1).all()  # so that samples show each event alone
    changed = [(contacts[:, k - 1] != contacts[:, k]).nonzero()[0].tolist() for k in after]
    assert changed == [[body - 1] for body in run.event_body.to_numpy()]
    assert len(changed) > 5


def test_overturning_of_a_lower_body_overturns_the_stack():
    # a slender column under a squat block, whose own overturning angle is much greater
    squat = rf.Block(width="1 m", height="0.8 m", mass="2 t")
    column = rf.Block(width="1 m", height="6 m", mass="9 t")
    system = rf.System(rf.Stack(squat, column, interfaces=[JOINT]), GROUND)
    run = system.simulate(PULSE.scaled(3.0), free_vibration="4 s", second_look=False)
    assert bool(run.overturned)
    at_end = np.abs(run.body_rotation[:, -1].to_numpy())
    assert at_end[0] < 0.5 * float(run.overturning_angle)
    assert run.event_body[-1] == 1
    standing = system.simulate(PULSE, free_vibration="1 s", second_look=False)
    angle = np.arctan2(0.5, (2.0 * 6.4 + 9.0 * 3.0) / 11.0)  # of both as one body
    share = float(standing.peak_body_rotation[1]) / angle
    assert float(standing.peak_relative_rotation) == pytest.approx(share, rel=1e-6)
    assert (
        f" of body 1, a lower body {100.0 * share:.3g} % of its own;" in standing.attrs["verdict"]
    )
    onwards = system.simulate(duration="0.5 s", initial=standing, second_look=False)
    assert (
        float(onwards.peak_relative_rotation) >= abs(float(standing.body_rotation[1, -1])) / angle
    )


def test_offsets_lean_a_stack_at_rest():
    leaning = rf.System(rf.Stack(STATUE, PLINTH, interfaces=[JOINT], offsets=["5 cm"]), GROUND)
    rest = float(leaning.equilibrium().rest_rotation)
    assert rest > 0.0
    still = leaning.simulate(None, duration="0.5 s", accuracy="reference")
    assert np.abs(still.rotation - rest).max() < 1e-12
    mirror = rf.System(rf.Stack(STATUE, PLINTH, interfaces=[JOINT], offsets=["-5 cm"]), GROUND)
    assert float(mirror.equilibrium().rest_rotation) == pytest.approx(-rest, rel=1e-12)


def test_modes_of_a_stack():
    modes = rf.System(STACK, SOIL).frequencies()
    assert modes.body_rotation_shape.dims == ("mode", "body")
    assert modes.sizes["mode"] == 4
    assert (modes.frequency > 0.0).all()
    held = rf.System(STACK, GROUND).moment_rotation(["0.001 rad", "0.01 rad"])
    assert (held.restoring_moment > 0.0).all()


def test_sweeps_of_stacks():
    system = rf.System(STACK, GROUND)
    plan = {name: PLAN[name] for name in ("free_vibration", "accuracy")}
    runs = rf.sweep(system, motions=[PULSE], damping_ratio=[0.1, 0.2], **plan)
    alone = [
        rf.System(STACK, GROUND.replace(damping_ratio=xi)).simulate(PULSE, **PLAN)
        for xi in (0.1, 0.2)
    ]
    found = runs.peak_rotation.to_numpy().ravel().tolist()
    assert found == [float(one.peak_rotation) for one in alone]


def test_models_of_a_stack():
    ladder = rf.model_ladder(rf.System(STACK, SOIL))
    assert list(ladder) == ["stack on soil, small rotations", "stack on soil"]


@pytest.mark.parametrize("base", [rf.RigidGround(friction=0.5), GROUND])
def test_models_of_a_stack_that_slides(base):
    stone = rf.RigidGround(friction=0.4, impact="stick")
    ladder = rf.model_ladder(rf.System(rf.Stack(STATUE, PLINTH, interfaces=[stone]), base))
    where = "stack on two pads" if base is GROUND else "stack on rigid ground"
    assert list(ladder) == [f"{where}, small rotations", where, f"{where}, sliding"]
    assert [one.describe().split("\n")[0] for one in ladder.values()] == [
        "Model: stack", "Model: stack", "Model: stack-sliding",
    ]  # fmt: skip


def test_strong_vertical_motion_gives_flight_states():
    hop = rf.GroundMotion.sine_pulse(amplitude="2 m/s^2", frequency="4 Hz").with_vertical(
        rf.GroundMotion.sine_pulse(amplitude="-25 m/s^2", frequency="4 Hz")
    )
    run = rf.System(STACK, GROUND).simulate(hop, **PLAN)
    assert (run.body_contact_state == int(ContactState.FLIGHT)).any("time").any()


def test_every_stack_parameter_can_be_scaled():
    names = STACK.parameters()
    assert {"height of body 1", "mass of body 2", "damping ratio of interface 1"} <= {
        name.replace("_", " ") for name in names
    }
    for name in names:
        changed = STACK.with_scaled(name, 0.99)
        assert changed != STACK
        assert changed.offsets == STACK.offsets
    higher = STACK.with_scaled("height of body 2", 1.1)
    assert higher.bodies == (STATUE, PLINTH.with_scaled("height", 1.1))
    with pytest.raises(ComponentError, match="no parameter is called 'offsets'"):
        STACK.with_scaled("offsets", 2.0)


def test_offsets_of_a_stack_are_scaled_one_by_one():
    drums = rf.Stack(STATUE, PLINTH, PLINTH, interfaces=JOINT, offsets=["2 cm", "0 m"])
    assert "offset of body 2" not in drums.parameters()
    changed = drums.with_scaled("offset of body 1", 0.5)
    assert changed == drums.replace(offsets=["1 cm", "0 m"])
    assert drums.with_scaled("mass of body 1", 2.0).offsets == drums.offsets


@pytest.mark.parametrize("joint", [JOINT, rf.RigidGround()])
def test_certificate_varies_all_stack_parameters(joint):
    stack = rf.Stack(STATUE, PLINTH, interfaces=[joint], offsets=["1 cm"])
    assert "offset of body 1" in stack.parameters()
    scenes = dict(parameters(rf.System(stack, GROUND).assembly))
    assert {f"{name.replace('_', ' ')} of the stack" for name in stack.parameters()} < set(scenes)
    changed = scenes["height of body 1 of the stack"](1e-3)
    assert changed.setting.bodies[0].centre_height == pytest.approx(0.9 * 1.001, rel=1e-12)


@pytest.mark.parametrize("masses", [(1e-9, 1.0, 1e9), (1e9, 1.0, 1e-9), (1e9, 1e-9, 1e9)])
def test_extreme_mass_ratios_have_finite_frequencies(masses):
    blocks = [rf.Block(width="1 m", height="2 m", mass=f"{one} t") for one in masses]
    pads = rf.TwoSpringSupport(frequency_ratio=20.0, damping_ratio=0.1)
    model = rf.System(rf.Stack(*blocks, interfaces=[pads, pads]), pads).setting.compile()
    # of the upper body alone on its pads
    alone = rf.System(blocks[0], pads).setting.compile()
    assert alone.fastest_frequency * (1.0 - 1e-9) <= model.fastest_frequency < np.inf


def test_body_peaks_cover_the_whole_run():
    push = rf.GroundMotion.sine_pulse(amplitude="-6 m/s^2", frequency="1 Hz")
    found = rf.System(STACK, GROUND).simulate(push, overturning="continue", **PLAN)
    assert float(found.peak_rotation) > 1.2 * float(found.overturning_angle)
    assert float(found.peak_body_rotation[0]) == pytest.approx(float(found.peak_rotation), rel=1e-4)
    assert (found.peak_body_rotation >= np.abs(found.body_rotation).max("time") - 1e-15).all()
