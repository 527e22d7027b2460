"""Runs that end while the standing block can still overturn."""

import math
from contextlib import nullcontext

import numpy as np
import pytest

import rockframe as rf
from rockframe.compiled import COMPILED
from rockframe.errors import ModelWarning, SolverWarning
from rockframe.simulation.soundness import max_stored_energy
from rockframe.studies.sweeps import study

BLOCK = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
PULSE = rf.GroundMotion.sine_pulse("4 m/s^2", "1.5 Hz")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.05)
SOIL = rf.WinklerSoil(stiffness="5 MPa", damping_ratio=0.1)
CAP = rf.CushionCap(height="0.1 m", mass="100 kg", width="0.6 m")
STILL_MOVING = "still has the energy to overturn"


def rise():
    """Return the energy to overturn on rigid ground, m g R (1 - cos theta)."""
    radius = math.hypot(0.25, 1.0)
    return 400.0 * 9.80665 * radius * (1.0 - math.cos(math.atan2(0.25, 1.0)))


def test_overturning_energy_on_rigid_ground_is_the_rise_of_the_mass_centre():
    setting = rf.System(BLOCK).assembly.setting
    assert setting.overturning_energy == pytest.approx(rise(), rel=1e-12)
    assert setting.stored_energy(-setting.overturning_angle) == pytest.approx(rise())


@pytest.mark.parametrize("parts", [[PADS], [SOIL], [PADS, CAP, SOIL]], ids=len)
def test_flexible_bases_reduce_the_overturning_energy(parts):
    setting = rf.System(BLOCK, *parts).assembly.setting
    assert 0.3 * rise() < setting.overturning_energy < rise()


def test_overturning_energy_is_that_of_the_weaker_side():
    leaning = rf.System(BLOCK, inclination="2 deg").assembly.setting
    radius, left, right = math.hypot(0.25, 1.0), *leaning.overturning_angles
    to_sides = [400.0 * 9.80665 * radius * (1.0 - math.cos(angle)) for angle in (left, right)]
    assert leaning.overturning_energy == pytest.approx(min(to_sides), rel=1e-9)


def test_run_ending_in_motion_warns():
    system = rf.System(BLOCK)
    with pytest.warns(SolverWarning, match=STILL_MOVING):
        short = system.simulate(PULSE)
    assert not short.overturned
    assert STILL_MOVING in short.attrs["cautions"]
    long = system.simulate(PULSE, free_vibration="3 s")
    assert long.overturned
    assert long.attrs["cautions"] == "none"


def test_continued_run_ending_in_mid_fall_warns(monkeypatch):
    monkeypatch.setattr(study, "COMPILING_SHARE", math.inf)  # lanes in any case
    system, strong = rf.System(BLOCK), PULSE.scaled(3.0)
    with pytest.warns(SolverWarning, match=STILL_MOVING):
        short = system.simulate(strong, overturning="continue")
    assert short.attrs["verdict"].startswith("Passed the overturning angle")
    assert "is beyond it at the end" in short.attrs["verdict"]
    with pytest.warns(ModelWarning, match=STILL_MOVING):
        runs = rf.sweep(system, strong, scale=np.linspace(0.9, 1.1, 20), overturning="continue")
    assert ("side by side" in runs.attrs["driver"]) is COMPILED
    long = system.simulate(strong, free_vibration="3 s", overturning="continue")
    assert "fell flat" in long.attrs["verdict"]
    assert long.attrs["cautions"] == "none"


def test_body_held_by_a_tie_beyond_overturning_does_not_warn():
    tie = rf.Restrainer(on=("0.25 m", "2 m"), to=("2 m", "2 m"), stiffness="500 kN/m",
                        slack="70 cm", strength="3 kN", brittle=False)  # fmt: skip
    system = rf.System(BLOCK, tie)
    start = rf.InitialState(rotation="-0.24 rad", angular_velocity="-0.3 rad/s")
    run = system.simulate(duration="4 s", initial=start, overturning="continue")
    assert "is beyond it at the end" in run.attrs["verdict"]
    assert run.attrs["cautions"] == "none"


def test_falling_lower_body_of_a_stack_warns():
    """The slender body carries a squat one, which is far from its own overturning angle."""
    squat = rf.Block(width="0.6 m", height="0.5 m", mass="300 kg")
    slender = rf.Block(width="0.7 m", height="3 m", mass="3 t")
    pads = rf.TwoSpringSupport(frequency_ratio=30, damping_ratio=0.1)
    system = rf.System(rf.Stack(squat, slender, interfaces=[pads]), pads)
    push, plan = (
        rf.GroundMotion.sine_pulse("4 m/s^2", "0.8 Hz"),
        {"outputs": None},
    )
    with pytest.warns(SolverWarning, match=STILL_MOVING):
        run = system.simulate(push, free_vibration="0.45 s", **plan)
    assert run.attrs["verdict"].startswith("Did not overturn")
    with pytest.warns(SolverWarning, match=STILL_MOVING):
        run = system.simulate(duration="0.6 s", initial=run, overturning="continue", **plan)
    assert "is beyond it at the end" in run.attrs["verdict"]
    assert float(run.peak_rotation) < 0.5 * float(run.overturning_angle)


@pytest.mark.parametrize("parts", [[], [PADS], [SOIL], [PADS, CAP, SOIL]], ids=len)
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_end_in_motion_warning_follows_the_energy_bound(parts, share):
    """A block released with the rotation rate of that energy, and examined at once."""
    system = rf.System(BLOCK, *parts)
    setting = system.assembly.setting
    body, rotation = setting.body, 0.0
    about = body.base_inertia  # about the middle of the base, held by pads and soil
    if not parts:
        about, rotation = body.inertia + body.mass * body.radius**2, 1e-9  # about a corner
    rate = math.sqrt(2.0 * share * setting.overturning_energy / about)
    start = rf.InitialState(rotation=f"{rotation!r} rad", angular_velocity=f"{rate!r} rad/s")
    with pytest.warns(SolverWarning, match=STILL_MOVING) if share > 1.0 else nullcontext():
        system.simulate(duration="1 ms", initial=start, outputs=None)


def test_sweep_warns_of_cases_ending_in_motion():
    with pytest.warns(ModelWarning, match=STILL_MOVING):
        runs = rf.sweep(rf.System(BLOCK), PULSE, scale=[0.2, 1.0], progress=False)
    messages = runs.message.to_numpy().ravel()
    assert messages[0] == "none"
    assert STILL_MOVING in messages[1]


def test_critical_scale_warns_of_runs_ending_in_motion():
    system = rf.System(BLOCK)
    with pytest.warns(SolverWarning, match=STILL_MOVING):
        found = rf.critical_scale(system, PULSE, scales=10, runs=20, progress=False)
    assert STILL_MOVING in found.attrs["cautions"]


def test_certificate_of_a_run_ending_in_motion_is_limited_to_its_end():
    with pytest.warns(SolverWarning, match=STILL_MOVING):
        found = rf.System(BLOCK).simulate(PULSE, certify=True)
    assert found.attrs["certificate"].startswith("To the end of the run, where it can still")


def pedestal(height, width="1 m", stiffness="5 MPa"):
    """A block on pads on a tall cap, which has no equilibrium at large held rotations."""
    return rf.System(
        rf.Block(width="1 m", height="2 m", mass="4 t"),
        rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),
        rf.CushionCap(height=height, width=width, density="2400 kg/m^3", depth="1 m"),
        rf.WinklerSoil(stiffness=stiffness, damping_ratio=0.2),
    )


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize(
    ("height", "stiffness"),
    [
        ("3 m", "1 MPa"),
        ("1 m", "5 MPa"),
        *(
            pytest.param(*one, marks=pytest.mark.long)
            for one in (("1 m", "1 MPa"), ("2 m", "1 MPa"), ("2 m", "5 MPa"), ("3 m", "5 MPa"))
        ),
    ],
)
def test_overturning_energy_exists_for_stacks_on_soft_soil(height, stiffness):
    setting = pedestal(height, stiffness=stiffness).assembly.setting
    rigid = 4e3 * 9.80665 * math.hypot(0.5, 1.0) * (1.0 - math.cos(setting.overturning_angle))
    assert 0.0 <= setting.overturning_energy < rigid


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
def test_cap_on_soft_soil_rotates_more_than_the_block():
    setting = pedestal("1 m", stiffness="1 MPa").assembly.setting
    angle = setting.overturning_angle
    far = setting.statics(angle)
    assert far.restoring_moment < 0.0  # it must be pulled back
    assert angle < far.reactions["cap_rotation"] < 1.01 * angle


def test_overturning_energy_without_equilibrium_uses_the_reached_range(monkeypatch):
    setting = pedestal("0.5 m").assembly.setting
    energy, held = setting.overturning_energy, type(setting).curve

    def loses_equilibrium(self, rotations):
        far = 0.5 * setting.overturning_angle
        states = zip(rotations, held(self, rotations), strict=True)
        return [None if abs(rotation) > far else state for rotation, state in states]

    monkeypatch.setattr(type(setting), "curve", loses_equilibrium)
    on_the_way = pedestal("0.5 m").assembly.setting.overturning_energy
    assert 0.5 * energy < on_the_way < energy


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize("amplitude", ["1 m/s^2", pytest.param("3 m/s^2", marks=pytest.mark.long)])
def test_run_of_a_stack_on_soft_soil_is_completed(amplitude):
    pulse = rf.GroundMotion.sine_pulse(amplitude, "1 Hz")
    found = pedestal("2 m").simulate(pulse, outputs=None)
    assert found.attrs["verdict"]
    runs = rf.sweep(pedestal("2 m"), pulse, scale=[0.5, 1.0], progress=False)
    assert (runs.peak_rotation > 0.0).all()


TALL = rf.Block(width="0.5 m", height="2 m", mass="400 kg", eccentricity="0.05 m")


@pytest.mark.parametrize("share", [-0.9, -0.3, 0.3, 0.9])
@pytest.mark.parametrize(
    "system",
    [
        rf.System(BLOCK), rf.System(BLOCK, PADS), rf.System(TALL, SOIL),
        rf.System(BLOCK, PADS, CAP, SOIL), rf.System(BLOCK, CAP, SOIL),
        rf.System(BLOCK, PADS, CAP, SOIL, coupling="cascade"),
        rf.System(rf.Stack(TALL, BLOCK, interfaces=[PADS]), PADS),
        rf.System(BLOCK, PADS, inclination="5 deg"),
        rf.System(BLOCK, PADS, rf.Load(at=("0 m", "2 m"), vertical="4 kN")),
    ],
)  # fmt: skip
def test_stored_energy_does_not_exceed_its_bound(system, share):
    rotation = share * system.assembly.setting.overturning_angle
    stored = system.assembly.setting.stored_energy(rotation)
    assert stored <= max_stored_energy(system.assembly, rotation) * (1.0 + 1e-9)


def test_stored_energy_bound_is_infinite_on_slopes_under_loads_and_before_walls():
    """There more energy is stored than by the weight alone, without bound."""
    level = max_stored_energy(rf.System(BLOCK, PADS).assembly, 0.01)
    for system, rotation in (
        (rf.System(BLOCK, PADS, inclination="5 deg"), -0.01),
        (rf.System(BLOCK, PADS, inclination="5 deg"), 0.01),
        (rf.System(BLOCK, PADS, rf.Load(at=("0 m", "2 m"), vertical="9 kN")), 0.01),
        (rf.System(BLOCK, rf.RearWall(side="left", stiffness="2 MN/m", gap="5 mm")), -0.01),
        (rf.System(BLOCK, rf.RearWall(side="left", restitution=-0.4)), 0.01),
    ):
        assert max_stored_energy(system.assembly, rotation) == math.inf
    assert 0.0 < level < math.inf
