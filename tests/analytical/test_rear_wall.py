"""One-sided rocking before a wall: closed forms, limits, studies, figures and files."""

import json
import math

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import AssemblyError, RockframeError
from rockframe.plot._layout import LayoutBuilder
from rockframe.simulation.certify.perturbations import parameters
from rockframe.system.geometry import geometry_of

FACADE = rf.Block(width="0.3 m", height="3 m", mass="1.6 t")
PULSE = rf.GroundMotion.sine_pulse("-2.4 m/s^2", "1.2 Hz")
GRAVITY = "9.81 m/s^2"


def released(share, wall=None, **options):
    """Release a façade from a share of its overturning angle."""
    system = rf.System(FACADE, wall or rf.RearWall(), gravity=GRAVITY, **options)
    rotation = share * system.setting.overturning_rotations[0]
    return system, system.simulate(
        initial=rf.InitialState(rotation=f"{rotation!r} rad"), duration="3 s",
        accuracy="reference", outputs=("energy",),
    )  # fmt: skip


def test_impacts_of_three_metre_facade():
    system, run = released(0.5)
    assert system.setting.rebound == pytest.approx(-0.4708451705, abs=1e-10)
    times = [0.596292379, 0.988605500, 1.164795505, 1.246950582, 1.285550844]
    rates = [0.190591551, 0.089739111, 0.042253227, 0.019894728, 0.009367337]
    np.testing.assert_allclose(run.event_time[:5], times, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(-run.angular_velocity_before[:5], rates, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(
        run.angular_velocity_after[:5] / run.angular_velocity_before[:5], system.setting.rebound
    )
    assert float(run.energy_residual) < 1e-8
    assert run.event_kind[-1] == 6  # rest
    lost = run.impact_energy[-1] / (run.kinetic_energy + run.potential_energy)[0]
    assert float(lost) == pytest.approx(1.0, rel=1e-9)
    assert not bool(run.overturned)
    # the wall, not friction, takes the impulses
    assert float(run.peak_impulsive_friction_demand) == 0.0


def test_the_impulse_of_base_and_wall_is_the_change_of_momentum():
    system, _ = released(0.5)
    run = system.simulate(
        initial=rf.InitialState(rotation="0.05 rad"), duration="1 s", outputs=("impulse",)
    )
    (struck, *_) = np.flatnonzero(run.event_kind.to_numpy() == 2)
    jump = (run.angular_velocity_after - run.angular_velocity_before)[struck].item()
    # about the pivot corner, the centre of mass at half the height moves horizontally
    impulse = run.event_horizontal_impulse[struck].item()
    assert impulse == pytest.approx(1600.0 * 1.5 * jump, rel=1e-9)
    # a share of the impulse that friction alone could not transmit
    assert abs(impulse) > 5.0 * abs(run.event_vertical_impulse[struck].item())
    assert "with that of a stiff wall" in run.event_horizontal_impulse.long_name


@pytest.mark.parametrize(
    ("slenderness", "ratio"),
    [(2, -0.098000), (4, -0.342306), (6, -0.422961), (8, -0.455165), (10, -0.470845)],
)
def test_rebound_ratio_in_closed_form(slenderness, ratio):
    block = rf.Block(width="1 m", height=f"{slenderness} m", mass="1 t")
    rebound = rf.System(block, rf.RearWall()).setting.rebound
    square = 1.0 / (1.0 + slenderness**2)
    exact = (1.0 - 1.5 * square) ** 2 * (1.0 - 1.5 * (1.0 - square))
    assert rebound == pytest.approx(exact, rel=1e-13)
    assert rebound == pytest.approx(ratio, abs=6e-7)


def test_newton_law_and_numeric_restitution():
    wall = rf.RearWall(restitution="newton", wall_restitution=0.3)
    base = FACADE.si.maximum_restitution
    assert rf.System(FACADE, wall).setting.rebound == pytest.approx(-0.3 * base**2)
    own = rf.System(FACADE, wall, rf.RigidGround(restitution=0.8)).setting.rebound
    assert own == pytest.approx(-0.3 * 0.64)
    assert rf.System(FACADE, rf.RearWall(restitution=-0.2)).setting.rebound == -0.2
    stopped = released(0.3, rf.RearWall(restitution=0))[1]
    assert int(stopped.impact_count) == 1
    assert stopped.event_kind.to_numpy().tolist() == [6]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"restitution": "newton"}, "needs wall_restitution"),
        ({"wall_restitution": 0.3}, "goes with restitution"),
        ({"restitution": 0.4}, "from -1 to 0"),
        ({"side": "behind"}, "left"),
    ],
)
def test_invalid_wall_is_refused(arguments, words):
    with pytest.raises(RockframeError, match=words):
        rf.RearWall(**arguments)


def test_wall_refuses_incompatible_parts_and_states():
    squat = rf.Block(width="1 m", height="1.3 m", mass="1 t")
    with pytest.raises(AssemblyError, match="does not rebound"):
        rf.System(squat, rf.RearWall())
    rf.System(squat, rf.RearWall(restitution=0))
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    with pytest.raises(AssemblyError, match="a wall stands behind a Block on rigid ground"):
        rf.System(FACADE, rf.RearWall(), pads)
    floor = rf.Load(at=("0 m", "3 m"), moving_mass="1 t")
    with pytest.raises(AssemblyError, match="nothing else holds: give the wall a stiffness and a"):
        rf.System(FACADE, rf.RearWall(), floor)
    rf.System(FACADE, rf.RearWall(stiffness="2 MN/m", damping="3 kN*s/m"), floor)
    with pytest.raises(AssemblyError, match="level ground"):
        rf.System(FACADE, rf.RearWall(), inclination="1 deg")
    system = rf.System(FACADE, rf.RearWall(side="right"))
    with pytest.raises(AssemblyError, match="into the RearWall"):
        system.simulate(duration="1 s", initial=rf.InitialState(rotation="0.01 rad"))
    inwards = rf.InitialState(angular_velocity="1 rad/s")
    with pytest.raises(AssemblyError, match="at no rotation is into the RearWall"):
        system.simulate(duration="1 s", initial=inwards)
    with pytest.raises(AssemblyError, match="into the RearWall"):
        system.moment_rotation(["0.01 rad"])


def test_small_rotation_decay_in_closed_form():
    system, run = released(0.4, rotation="small")
    omega, e, share, time = system.setting.body.frequency_at(9.81), system.setting.rebound, 0.4, 0.0
    for k, found in enumerate(run.event_time.to_numpy()[:6]):
        swing = math.acosh(1.0 / (1.0 - share)) / omega
        time += swing if k == 0 else 2.0 * swing
        assert found == pytest.approx(time, abs=1e-9)
        share = 1.0 - math.sqrt(1.0 - e * e * (1.0 - (1.0 - share) ** 2))


def test_walls_on_left_and_right_give_mirrored_response():
    eccentric = FACADE.replace(eccentricity="0.02 m")
    plan = {"free_vibration": "3 s", "outputs": ("reaction", "energy")}
    left = rf.System(eccentric, rf.RearWall(side="left")).simulate(PULSE, **plan)
    mirrored = FACADE.replace(eccentricity="-0.02 m")
    right = rf.System(mirrored, rf.RearWall(side="right")).simulate(PULSE.scaled(-1.0), **plan)
    assert float(left.peak_rotation) > 0.0
    np.testing.assert_array_equal(left.rotation, -right.rotation)
    np.testing.assert_array_equal(left.left_reaction, right.right_reaction)
    np.testing.assert_array_equal(left.base_shear, -right.base_shear)


def test_lossless_wall_conserves_energy():
    _, run = released(0.5, rf.RearWall(restitution=-1))
    energy = run.kinetic_energy + run.potential_energy
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)
    assert int(run.impact_count) >= 3


def test_wall_changes_nothing_before_first_impact():
    plan = {"free_vibration": "3 s", "accuracy": "reference"}
    before = rf.System(FACADE, rf.RearWall()).simulate(PULSE, **plan)
    free = rf.System(FACADE).simulate(PULSE, **plan)
    first = before.event_time[before.event_kind == 2][0].item()
    assert 0.0 < float(before.first_uplift_time) < first
    same = before.time < first
    np.testing.assert_array_equal(before.rotation[same], free.rotation[: int(same.sum())])
    # in the other direction the wall holds the block
    held = rf.System(FACADE, rf.RearWall(side="right")).simulate(PULSE, duration="0.4 s")
    assert float(held.peak_rotation) == 0.0


def test_reactions_of_block_leaning_on_wall():
    steady = rf.GroundMotion.from_arrays(([2.0, 2.0], "m/s^2"), "0.5 s")
    run = rf.System(FACADE, rf.RearWall(), gravity=GRAVITY).simulate(
        steady, outputs=("reaction", "friction_demand")
    )
    # moments about the rear corner: m a h = m g b + F H
    thrust = 1600.0 * (2.0 * 1.5 - 9.81 * 0.15) / 3.0
    np.testing.assert_allclose(run.base_shear, 1600.0 * 2.0 - thrust, rtol=1e-12)
    np.testing.assert_allclose(run.left_reaction, 1600.0 * 9.81, rtol=1e-12)
    np.testing.assert_allclose(run.right_reaction, 0.0, atol=1e-9)
    # the rear corner bears the whole weight, whatever the wall takes at the top
    np.testing.assert_allclose(run.base_overturning_moment, -1600.0 * 9.81 * 0.15, rtol=1e-12)


def test_wall_in_statics_studies_figures_and_files(tmp_path):
    system = rf.System(FACADE, rf.RearWall(side="right"))
    free = rf.System(FACADE)
    left, right = system.setting.uplift_accelerations
    assert (left, right) == (free.setting.uplift_accelerations[0], math.inf)
    assert system.setting.overturning_energy == pytest.approx(free.setting.overturning_energy)
    assert 'law "sorrentino"' in system.describe()
    found = rf.critical_scale(
        system, PULSE, largest=2.0, scales=10, runs=10, free_vibration="2 s", progress=False
    )
    assert float(found.critical_scale) > 1.0
    runs = rf.sweep(
        rf.System(FACADE, rf.RearWall(restitution=-0.2)), motions=[PULSE],
        restitution=[-0.4, -0.1], accuracy="fast", progress=False,
    )  # fmt: skip
    assert runs.peak_rotation.shape == (2, 1)
    assembly = rf.System(FACADE, rf.RearWall(restitution=-0.2)).assembly
    assert [name for name, _ in parameters(assembly)][-1] == "restitution of the wall"
    described = json.loads(json.dumps(system.to_dict()))
    assert rf.System.from_dict(described) == system
    run = system.simulate(PULSE, free_vibration="1 s")
    run.to_netcdf(tmp_path / "wall.nc")
    with xr.open_dataset(tmp_path / "wall.nc") as read:
        assert rf.System.from_dataset(read).parts.wall == rf.RearWall(side="right")
    (wall,) = LayoutBuilder(geometry_of(system.assembly)).geometry.walls
    np.testing.assert_allclose(wall[:, 0].min(), 0.15)
    rf.plot.state(run)
    assert list(rf.model_ladder(system)) == [
        "rigid ground, small rotations", "rigid ground",
        "rigid ground and wall, small rotations", "rigid ground and wall",
    ]  # fmt: skip
