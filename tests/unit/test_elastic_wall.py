"""Elastic walls on all bases: an independent equation, limits, energy, symmetry."""

import math
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rockframe as rf
from rockframe.errors import AssemblyError, ComponentError
from rockframe.reports.limits import model_limits
from rockframe.system.geometry import geometry_of
from rockframe.system.rear_wall import equivalent_wall

BLOCK = rf.Block(width="1 m", height="4 m", mass="4 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="60 MPa", damping_ratio=0.2)
PULSE = rf.GroundMotion.sine_pulse("4 m/s^2", "1.2 Hz")
BASES = {"rigid": (), "pads": (PADS,), "soil": (SOIL,)}


@pytest.mark.parametrize("base", list(BASES))
def test_distant_wall_has_no_effect(base):
    plan = {"free_vibration": "0.5 s"}
    far = rf.RearWall(stiffness="2 MN/m", damping="20 kN*s/m", gap="100 m")
    with_wall = rf.System(BLOCK, *BASES[base], far).simulate(PULSE, **plan)
    without = rf.System(BLOCK, *BASES[base]).simulate(PULSE, **plan)
    scale = float(without.peak_rotation)
    assert scale > 1e-3
    np.testing.assert_allclose(with_wall.rotation, without.rotation, rtol=0.0, atol=1e-6 * scale)


@pytest.mark.parametrize(
    ("base", "accuracy", "most"), [("pads", "reference", 1e-8), ("soil", "standard", 1e-5)]
)
def test_wall_limits_rotation_and_preserves_energy_balance(base, accuracy, most):
    wall = rf.RearWall(side="left", stiffness="2 MN/m", damping="10 kN*s/m", gap="5 mm")
    plan = {"free_vibration": "0.2 s", "outputs": ("energy",), "accuracy": accuracy}
    run = rf.System(BLOCK, *BASES[base], wall).simulate(PULSE, **plan)
    free = rf.System(BLOCK, *BASES[base]).simulate(PULSE, free_vibration="0.2 s")
    assert float(free.rotation.min()) < 1.5 * float(run.rotation.min()) < 0.0
    assert float(run.energy_residual) < most
    assert str(run.restrainer[0].item()) == "wall"
    assert float(run.restrainer_force.min()) > -1e5
    assert float(run.peak_restrainer_force[0]) > 1e3
    mirrored = rf.System(BLOCK, *BASES[base], wall.replace(side="right"))
    other = mirrored.simulate(PULSE.scaled(-1.0), **(plan | {"outputs": None}))
    assert float(other.peak_rotation) == pytest.approx(float(run.peak_rotation), rel=1e-9)


@pytest.mark.parametrize("sides", [("left",), ("left", "right")], ids=" and ".join)
def test_rocking_against_walls_matches_reference_solution(sides):
    """Housner's block whose upper corners meet a spring on each side with a wall, at gaps."""
    b, h, mass, stiffness, gravity = 0.5, 2.0, 4000.0, 4e5, 9.80665
    gaps = {"left": 0.01, "right": 0.025}
    radius, theta = math.hypot(b, h), math.atan2(b, h)
    inertia, rebound = 4.0 / 3.0 * mass * radius**2, 1.0 - 1.5 * math.sin(theta) ** 2

    def slope(_, z, side):
        wall = "left" if side < 0.0 else "right"  # the body leans to this side
        pressed = max(side * 2.0 * h * math.sin(z[0]) - gaps[wall], 0.0) if wall in sides else 0.0
        moment = -mass * gravity * radius * math.sin(side * theta - z[0])
        return z[1], (moment - side * stiffness * pressed * 2.0 * h * math.cos(z[0])) / inertia

    def lands(_, z, side):
        return side * z[0]

    lands.terminal, lands.direction = True, -1
    times, found = np.arange(0.0, 1.6001, 0.01), np.zeros(161)
    now, state, side = 0.0, np.array([0.1, 0.0]), 1.0
    while now < 1.6:
        run = solve_ivp(
            slope, (now, 1.6), state, method="DOP853", rtol=1e-11, atol=1e-13, events=lands,
            args=(side,), dense_output=True, max_step=0.002,
        )  # fmt: skip
        inside = (times >= now) & (times <= run.t[-1])
        found[inside] = run.sol(times[inside])[0]
        now, side = run.t[-1], -side
        state = np.array([side * 1e-16, rebound * run.y[1, -1]])
    walls = [
        rf.RearWall(side=side, stiffness=f"{stiffness} N/m", gap=f"{gaps[side]} m")
        for side in sides
    ]
    ours = rf.System(BLOCK, *walls).simulate(
        initial=rf.InitialState(rotation="0.1 rad"), duration="1.6 s", output_step="0.01 s",
        accuracy="reference",
    )  # fmt: skip
    assert found.min() < -0.003
    assert (ours.peak_restrainer_force > 1e3).all()
    np.testing.assert_allclose(ours.rotation, found, rtol=0.0, atol=1e-7 * theta)


def test_block_between_walls_keeps_its_energy_and_mirrors():
    left = rf.RearWall(stiffness="2 MN/m", damping="10 kN*s/m", gap="5 mm")
    right = rf.RearWall(side="right", stiffness="1 MN/m", gap="12 mm", height="3 m")
    plan = {"free_vibration": "0.5 s", "accuracy": "reference"}
    run = rf.System(BLOCK, PADS, left, right).simulate(PULSE, outputs=("energy",), **plan)
    mirrored = (left.replace(side="right"), right.replace(side="left"))
    other = rf.System(BLOCK, PADS, *mirrored).simulate(PULSE.scaled(-1.0), **plan)
    assert (run.peak_restrainer_force > 1e3).all()
    assert float(run.energy_residual) < 1e-8
    np.testing.assert_allclose(other.rotation, -run.rotation, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(other.restrainer_force, run.restrainer_force, rtol=1e-6, atol=1e-3)


def test_a_second_wall_that_is_not_reached_changes_nothing():
    wall = rf.RearWall(stiffness="2 MN/m", damping="10 kN*s/m", gap="5 mm")
    far = wall.replace(side="right", gap="100 m")
    one, two = (
        rf.System(BLOCK, PADS, *walls).simulate(PULSE, free_vibration="0.5 s")
        for walls in ([wall], [wall, far])
    )
    np.testing.assert_allclose(two.rotation, one.rotation, rtol=0.0, atol=1e-9)
    assert float(two.peak_restrainer_force[1]) == 0.0


def test_several_walls_have_names_and_all_are_elastic():
    left = rf.RearWall(stiffness="1 MN/m")
    right = left.replace(side="right")
    plinth = rf.Block(width="2 m", height="1 m", mass="9 t")
    stack = rf.Stack(BLOCK, plinth, interfaces=[rf.RigidGround()])
    tie = rf.Restrainer(on=("0 m", "3 m"), to=("3 m", "3 m"), stiffness="1 kN/m")
    stop = left.replace(on_body=2, name="stop")
    system = rf.System(stack, left, stop, tie, right)
    names = [name for name, _ in system.parts.named_links]
    assert names == ["wall 1", "stop", "wall 2", "restrainer 4"]
    assert rf.System.from_dict(system.to_dict()) == system
    outlines = geometry_of(system.assembly).walls
    assert [tuple(outline.min(axis=0)) for outline in outlines] == [
        (-1.5, 1.0), (-3.0, 0.0), (0.5, 1.0)
    ]  # fmt: skip
    rf.plot.scene(system)
    runs = rf.sweep(system, PULSE, axes={"wall_2.gap": (["1", "9"], "mm"), "stop.gap": ["2 mm"]})
    parts = rf.case(runs, **{"wall_2.gap": "9 mm", "stop.gap": "2 mm"}).system.parts
    assert [str(wall.gap) for wall in parts.walls] == ["None", "0.002 meter", "0.009 meter"]
    assert list(rf.model_ladder(rf.System(BLOCK, left, right)))[-1] == "rigid ground with walls"
    for walls in ([rf.RearWall(), right], [rf.RearWall(), rf.RearWall(side="right")]):
        with pytest.raises(AssemblyError, match=r"another RearWall are both given.*each wall a"):
            rf.System(BLOCK, *walls)
    with pytest.raises(AssemblyError, match="two links are called 'stop'"):
        rf.System(BLOCK, left.replace(name="stop"), right.replace(name="stop"))


@pytest.mark.parametrize(
    ("arguments", "share"),
    [
        ({}, 0.411765),  # 1 - 1.5 cos^2 theta, of the wall alone
        ({"restitution": "newton", "wall_restitution": 0.3}, 0.3),
        ({"restitution": -0.6}, 0.6),
    ],
)
def test_suggested_elastic_wall_has_the_rebound_of_the_rigid_wall(arguments, share):
    pads = rf.TwoSpringSupport(frequency_ratio=10, damping_ratio=0.05)
    stiff = rf.RearWall(**arguments)
    with pytest.raises(AssemblyError, match="takes no impulse") as refused:
        rf.System(BLOCK, pads, stiff)
    stiffness, damping = re.findall(r"'([^']*) N", str(refused.value))
    wall = rf.RearWall(stiffness=f"{stiffness} N/m", damping=f"{damping} N*s/m")
    # the second peak of a vibration on the pads, without uplift, with and without the wall
    start = rf.InitialState(rotation=f"{0.5 * rf.System(BLOCK, pads).setting.uplift_angle} rad")
    peaks = list[float]()
    for parts in ((BLOCK, pads), (BLOCK, pads, wall)):
        run = rf.System(*parts).simulate(initial=start, duration="0.95 s", output_step="0.001 s")
        peaks.append(float(abs(run.rotation.sel(time=slice(0.5, None))).max()))
    assert peaks[1] / peaks[0] == pytest.approx(share, abs=5e-4)


def test_wall_with_zero_restitution_has_critical_damping():
    found = equivalent_wall(rf.RearWall(restitution=0), BLOCK.si)
    mass = (BLOCK.si.inertia + BLOCK.si.mass * BLOCK.si.centre_height**2) / BLOCK.si.height**2
    assert found.rebound == 0.0
    assert found.damping == pytest.approx(2.0 * math.sqrt(found.stiffness * mass))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"gap": "1 mm"}, "give a stiffness"),
        ({"stiffness": "1 MN/m", "restitution": -0.3}, "not both"),
    ],
)
def test_invalid_elastic_wall_is_refused(arguments, words):
    with pytest.raises(ComponentError, match=words):
        rf.RearWall(**arguments)


def test_elastic_wall_is_described_and_survives_dict_round_trip():
    wall = rf.RearWall(stiffness="1 MN/m", gap="1 cm", height="3 m")
    system = rf.System(BLOCK, PADS, wall)
    assert "acts while touched" in system.describe()
    assert rf.System.from_dict(system.to_dict()) == system
    rf.plot.scene(system)


def test_wall_of_a_stack_body_is_drawn_at_that_body():
    plinth = rf.Block(width="2 m", height="1 m", mass="9 t")
    stack = rf.Stack(BLOCK, plinth, interfaces=[rf.RigidGround()], offsets=["10 cm"])
    wall = rf.RearWall(side="right", stiffness="1 MN/m", gap="5 cm")
    for number, lowest in ((1, (0.65, 1.0)), (2, (1.05, 0.0))):
        scene = rf.System(stack, wall.replace(on_body=number))
        assert geometry_of(scene.assembly).walls[0].min(axis=0) == pytest.approx(lowest)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"stiffness": "1 MN/m", "height": "40 m"}, "above the top of body 1 at 4 m"),
        ({"on_body": 2}, "there is no body 2"),
    ],
)
def test_a_wall_that_misses_its_body_is_refused(arguments, words):
    with pytest.raises(AssemblyError, match=words):
        rf.System(BLOCK, rf.RearWall(**arguments))


def test_wall_and_tendon_at_the_edge_allow_scaled_blocks():
    wall = rf.RearWall(stiffness="1 MN/m", height="4 m")
    tendon = rf.Tendon(stiffness="1 MN/m", at="0.5 m")
    for size in BLOCK.parameters():
        rf.System(BLOCK.with_scaled(size, 0.999), wall, tendon)


def test_elastic_wall_repr_omits_restitution():
    wall = rf.RearWall(stiffness="2 MN/m", gap="5 mm")
    assert "restitution" not in repr(wall)
    assert rf.RearWall.from_dict(wall.to_dict()) == wall
    assert rf.RearWall.from_dict({**wall.to_dict(), "restitution": "sorrentino"}) == wall
    assert "restitution='newton'" in repr(rf.RearWall(restitution="newton", wall_restitution=0.2))


def test_only_a_rigid_wall_has_the_limits_of_instantaneous_impacts():
    elastic = rf.RearWall(stiffness="2 MN/m", gap="5 mm")
    for wall, has_limit in ((rf.RearWall(), True), (elastic, False)):
        limits = model_limits(rf.System(BLOCK, wall).parts)
        assert ("Walls" in [limit.title for limit in limits]) is has_limit


def test_free_decay_before_an_elastic_wall_is_fitted():
    """A rigid wall leaves one side of the swings; an elastic one, out of reach, leaves both."""
    wall = rf.RearWall(stiffness="2 MN/m", gap="1 m")
    start = rf.InitialState(rotation="0.1 rad")
    run = rf.System(BLOCK, PADS, wall).simulate(initial=start, duration="3 s", output_step="5 ms")
    other = rf.System(BLOCK, PADS.replace(damping_ratio=0.15), wall)
    fit = rf.fit_free_decay(other, measured=run.rotation, parameters="damping_ratio")
    assert fit.fitted_value.item() == pytest.approx(PADS.si.damping_ratio, rel=1e-3)
