"""Sliding blocks with ties: limits, closed forms, symmetry, energies, and warnings."""

import math

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import AssemblyError

pytestmark = [pytest.mark.wide, pytest.mark.analytical, pytest.mark.filterwarnings("ignore")]

BLOCK = rf.Block(width="1 m", height="3 m", mass="1 t")
LOW = rf.Block(width="2 m", height="1 m", mass="1 t")
GROUND = rf.RigidGround()
PADS = rf.TwoSpringSupport(frequency_ratio=12, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="2 MPa", damping_ratio=0.1)
BASES = pytest.mark.parametrize("base", [GROUND, PADS, SOIL], ids=["ground", "pads", "soil"])
TIMES = np.arange(0.0, 1.01, 0.05)
ACROSS, UP = 3.8 * np.sin(9.0 * TIMES), 2.0 * np.sin(14.0 * TIMES)
GRAVITY = 9.80665


def ties(sign=1.0, **changed):
    """Return a slack tie at mid-height and a yielding anchor on either side."""
    upper = rf.Restrainer(
        on=(f"{-0.5 * sign} m", "2 m"), to=(f"{-1.2 * sign} m", "2 m"), name="upper",
        **{"stiffness": "60 kN/m", "slack": "5 mm", "damping": "200 N s/m", **changed},
    )  # fmt: skip
    anchor = rf.Restrainer(
        on=(f"{0.5 * sign} m", "0.1 m"), to=(f"{0.7 * sign} m", "0 m"), stiffness="90 kN/m",
        strength="1.2 kN", brittle=False, name="anchor",
    )  # fmt: skip
    return upper, anchor


def run(base, *others, sign=1.0, block=BLOCK, accuracy="reference", **options):
    motion = rf.GroundMotion.from_arrays(
        (sign * ACROSS, "m/s^2"), "0.05 s", vertical=(UP, "m/s^2")
    )  # fmt: skip
    return rf.System(block, base, *others, **options).simulate(
        motion, free_vibration="0.3 s", accuracy=accuracy, outputs=("energy",)
    )


def event_kinds(found):
    names = found.event_kind.attrs["flag_meanings"].split()
    return [names[kind - 1] for kind in found.event_kind.values]


@pytest.mark.long
@BASES
def test_infinite_friction_holds_base(base):
    """Up to rounding; equations on rigid ground and simultaneous events differ."""
    endless = {"friction": 1e9}
    if base is GROUND:
        endless |= {"kinetic_friction": 0.5, "impact": "stick"}
    held = run(base, *ties(), restraint="leading-corner")
    far = run(base.replace(**endless), *ties(), restraint="leading-corner")
    assert held.peak_rotation > 1e-3
    assert far.attrs["verdict"].startswith("Did not slide")
    assert abs(far.rotation - held.rotation).max() < 1e-11 * held.peak_rotation
    # up to rest, after which a tie without slack is taut or slack by rounding
    last = event_kinds(held).index("rest") if "rest" in event_kinds(held) else None
    first = [one.event_time.values[:last] for one in (far, held)]
    np.testing.assert_allclose(*first, rtol=0.0, atol=1e-8)
    assert sorted(event_kinds(far)[:last]) == sorted(event_kinds(held)[:last])


@pytest.mark.long
@BASES
@pytest.mark.parametrize("stiffness", ["60 kN/m", "1 GN/m"])
def test_slack_tie_changes_nothing(base, stiffness):
    base = base.replace(friction=0.15, kinetic_friction=0.12)
    free = run(base)
    slack = run(base, ties(slack="100 m", damping=None, stiffness=stiffness)[0])
    assert free.peak_slip > 1e-3
    for name in ("slip", "rotation"):
        assert abs(slack[name] - free[name]).max() <= 1e-12 * abs(free[name]).max()
    assert event_kinds(slack) == event_kinds(free)
    assert slack.peak_restrainer_force == 0.0


@BASES
def test_mirror_images_are_the_same(base):
    one, other = (
        run(base.replace(friction=0.1), *ties(sign), sign=sign, accuracy="standard")
        for sign in (1.0, -1.0)
    )
    assert one.peak_slip > 1e-3
    np.testing.assert_allclose(one.slip, -other.slip, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(one.rotation, -other.rotation, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(one.restrainer_force, other.restrainer_force, rtol=0.0, atol=1e-6)


@BASES
def test_energy_balances_with_ties_and_friction(base):
    found = run(base.replace(friction=0.15, kinetic_friction=0.1), *ties())
    assert found.peak_slip > 1e-3
    assert {"slip", "restrainer_taut", "restrainer_yield"} <= set(event_kinds(found))
    assert found.energy_residual < 1e-8
    assert (np.diff(found.dissipated_energy) >= -1e-9 * found.dissipated_energy.max().item()).all()
    assert found.elastic_energy.max() > found.elastic_energy[0]


def bar(stiffness, **changed):
    """Return a bar at the centre of mass of the low block, which stays level."""
    at = {"on": ("1 m", "0.5 m"), "to": ("3 m", "0.5 m")}
    return rf.Restrainer(stiffness=f"{stiffness!r} N/m", compression=True, **at, **changed)


def steady(acceleration, duration=2.0):
    count = round(duration / 0.02) + 1
    return rf.GroundMotion.from_arrays((np.full(count, acceleration), "m/s^2"), "0.02 s")


def test_tied_slide_shows_coulomb_decay():
    """Each half cycle ends 2 mu g/omega^2 closer to the balance of spring and push."""
    stiffness, friction, push = 2e4, 0.1, 6.0
    rate, grip = math.sqrt(stiffness / 1e3), friction * GRAVITY
    system = rf.System(LOW, rf.RigidGround(friction=friction), bar(stiffness))
    found = system.simulate(steady(-push, 2.5), duration="2.5 s", accuracy="reference")
    turns = found.event_kind.values == rf.dynamics.events.EventKind.SLIP_REVERSAL
    half = math.pi / rate
    expected = half * np.arange(1, 1 + turns.sum())
    np.testing.assert_allclose(found.event_time.values[turns], expected, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(found.peak_slip, 2.0 * (push - grip) / rate**2, rtol=1e-9)
    # from the balance: push - grip, less 2 grip at each reversal, until friction holds
    swing, place, sense = (push - grip) / rate**2, 0.0, 1.0
    while True:
        place += sense * 2.0 * swing
        sense, left = -sense, abs(rate**2 * place - push)
        if left <= grip:
            break
        swing = (left - grip) / rate**2
    np.testing.assert_allclose(found.residual_slip, place, rtol=1e-9)


def test_slip_before_and_after_tie_fracture_in_closed_form():
    stiffness, friction, push, strength = 5e4, 0.2, 5.0, 1.5e3
    system = rf.System(
        LOW, rf.RigidGround(friction=friction),
        bar(stiffness, strength=f"{strength!r} N", brittle=True),
    )  # fmt: skip
    found = system.simulate(steady(-push, 0.5), duration="0.4 s", accuracy="reference")
    ((breaks,),) = (found.event_time.values[np.array(event_kinds(found)) == "restrainer_fracture"],)
    rate, pull = math.sqrt(stiffness / 1e3), push - friction * GRAVITY
    broken_at = strength / stiffness
    when = math.acos(1.0 - broken_at * rate**2 / pull) / rate
    speed = pull / rate * math.sin(rate * when)
    np.testing.assert_allclose(breaks, when, rtol=1e-9)
    after = 0.4 - when
    np.testing.assert_allclose(
        found.residual_slip, broken_at + speed * after + 0.5 * pull * after**2, rtol=1e-9
    )


def test_tie_fractures_after_uplift_time_of_free_block():
    """A tie that presses the block on its corner increases friction until it breaks."""
    tie = rf.Restrainer(
        on=("0.4 m", "3 m"), to=("0.4 m", "-2 m"), stiffness="400 kN/m", preload="4 kN",
        strength="5 kN", brittle=True,
    )  # fmt: skip
    ground = rf.RigidGround(friction=0.37, kinetic_friction=0.3)
    found = rf.System(BLOCK, ground, tie).simulate(
        steady(-6.5, 0.6), duration="0.6 s", accuracy="reference", outputs=("energy", "reaction")
    )
    assert event_kinds(found) == ["uplift", "restrainer_fracture", "slip"]
    _, broken, slides = found.event_time.values
    assert slides == broken
    needed = abs(found.base_shear / found.vertical_reaction)
    assert needed.sel(time=slice(0.0, broken)).max() < 0.32
    assert (found.slip.sel(time=slice(0.0, broken)) == 0.0).all()
    np.testing.assert_allclose(needed.sel(time=slice(broken + 1e-9, None)), 0.3, rtol=1e-12)
    assert found.slip[-1] > 0.1
    assert found.energy_residual < 1e-8


@pytest.mark.parametrize("stiffness", [1e6, 1e8])
def test_very_stiff_tie_holds_sliding_corner(stiffness):
    """Within half the slip that a spring of that stiffness allows."""
    start = rf.InitialState(rotation="0.1 rad")
    options = {"duration": "0.15 s", "initial": start, "accuracy": "reference"}
    held = rf.System(BLOCK, rf.RigidGround(friction=10.0, kinetic_friction=0.5)).simulate(**options)
    stiff = rf.Restrainer(
        on=("0.5 m", "0 m"), to=("1.5 m", "0 m"), stiffness=f"{stiffness!r} N/m", compression=True
    )
    found = rf.System(BLOCK, rf.RigidGround(friction=0.0), stiff).simulate(**options)
    shear = abs(held.base_shear).max().item()
    assert 0.0 < found.peak_slip < 3.0 * shear / stiffness
    assert abs(found.rotation - held.rotation).max() < 30.0 * shear / stiffness
    assert found.energy_residual < 1e-8


def test_preload_beyond_friction_warns():
    pulls = rf.Restrainer(
        on=("-0.5 m", "0.5 m"), to=("-2 m", "0.5 m"), stiffness="10 kN/m", preload="2 kN"
    )
    with pytest.warns(rf.errors.ModelWarning, match="at rest it needs a friction of 0.2039, and"):
        weak = rf.System(BLOCK, rf.RigidGround(friction=0.15), pulls)
    found = weak.simulate(duration="1 s", accuracy="reference")
    assert found.residual_slip < -0.01
    assert "Slid" in found.attrs["verdict"]
    strong = rf.System(BLOCK, rf.RigidGround(friction=0.25), pulls).simulate(duration="1 s")
    assert strong.peak_slip == 0.0


def test_sliding_block_with_wall_and_load():
    wall = rf.RearWall(side="left", stiffness="2 MN/m", damping="10 kN s/m", gap="10 mm")
    load = rf.Load(at=("0.1 m", "3 m"), vertical="2 kN", horizontal="0.2 kN")
    found = run(rf.RigidGround(friction=0.2), wall, load)
    assert found.peak_slip > 1e-3
    assert found.peak_restrainer_force > 0.0
    assert found.energy_residual < 1e-8
    heavier = rf.Load(at=("0 m", "1.5 m"), moving_mass="1 t")
    alone = run(rf.RigidGround(friction=0.2), heavier)
    assert "restrainer" not in alone.dims
    assert alone.peak_slip > 1e-3


def stack_with_ties(friction, joint_friction, **changed):
    """Return two blocks with ties to each other and to the ground."""
    joint = rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.2, friction=joint_friction)
    upper = rf.Block(width="0.8 m", height="1.5 m", mass="500 kg")
    stack = rf.Stack(upper, BLOCK.replace(height="1 m"), interfaces=[joint.replace(**changed)])
    tie = rf.Restrainer(
        on=("-0.4 m", "1 m"), to=("-1 m", "1 m"), on_body=1, to_body=2, stiffness="30 kN/m",
        slack="2 mm",
    )  # fmt: skip
    to_ground = rf.Restrainer(
        on=("0.5 m", "0.9 m"), to=("1.5 m", "0.9 m"), on_body=2, stiffness="200 kN/m"
    )
    return {"block": stack}, (PADS.replace(friction=friction, **changed), tie, to_ground)


def test_a_stack_slides_with_ties():
    block, parts = stack_with_ties(0.3, 0.2)
    found = run(*parts, **block)
    assert (abs(found.body_slip).max("time") > 1e-4).all()
    assert found.energy_residual < 1e-8


@pytest.mark.long
def test_infinite_friction_holds_bases_of_stack():
    """Restitution is one, since it acts differently on bases held by friction and on held ones."""
    bare, held = (
        run(*parts, restraint="leading-corner", **block)
        for block, parts in (
            stack_with_ties(friction, friction, restitution=1.0) for friction in (None, 1e9)
        )
    )
    # up to a flight, after which a body with friction comes to rest only after a while
    apart = abs(held.rotation - bare.rotation).sel(time=slice(0.0, 1.1)).max()
    assert apart < 1e-12 * bare.peak_rotation


def test_unsupported_combinations_are_refused():
    bent = rf.Tendon(stiffness="5 MN/m", preload="2 kN")
    with pytest.raises(AssemblyError, match="shears it there: give the depth"):
        rf.System(BLOCK, rf.RigidGround(friction=0.5), bent).describe()
    deep = rf.Tendon(stiffness="5 MN/m", preload="2 kN", depth="1 m")
    assert "slip" in rf.System(BLOCK, rf.RigidGround(friction=0.5), deep).describe()
    with pytest.raises(AssemblyError, match="may jam"):
        rf.System(BLOCK, rf.RigidGround(friction=1.5), *ties()).describe()
    with pytest.raises(AssemblyError, match="rotation='finite'"):
        rf.System(BLOCK, rf.RigidGround(friction=0.5), *ties(), rotation="small").describe()


@BASES
def test_checked_friction_holds_and_reports_would_slide(base):
    scene = rf.System(BLOCK, base.replace(friction=0.05), *ties(), sliding="checked")
    found = scene.simulate(duration="1 s", motion=rf.GroundMotion.from_arrays(
        (ACROSS, "m/s^2"), "0.05 s"
    ))  # fmt: skip
    assert bool(found.would_slide)
    assert "slip" not in found


@pytest.mark.parametrize("seed", [1, 2])
def test_block_coming_to_rest_while_sliding_gains_no_energy(seed):
    """Bounces transmit the remaining vertical momentum, which limits friction."""
    rng = np.random.default_rng(seed)
    across = 5.0 * np.convolve(rng.normal(size=100), np.ones(6) / 6.0**0.5, "same")
    motion = rf.GroundMotion.from_arrays(
        (across, "m/s^2"), "0.02 s", vertical=(3.0 * rng.normal(size=100), "m/s^2")
    )
    block = rf.Block(width="0.5 m", height="1.5 m", mass="1 t")
    tie = rf.Restrainer(
        on=("-0.25 m", "1.2 m"), to=("-1 m", "1.2 m"), stiffness="300 kN/m", slack="2 mm",
        damping="2 kN*s/m",
    )  # fmt: skip
    ground = rf.RigidGround(friction=0.36, kinetic_friction=0.25)
    found = rf.System(block, ground, tie).simulate(
        motion, outputs=("energy",), output_step="1 ms", second_look=False
    )
    assert event_kinds(found).count("rest") > 2
    assert np.diff(found.impact_energy.to_numpy()).min() >= -1e-14 * found.kinetic_energy.max()
