"""Tendons through bodies, :eq:`eq-tendon`, loads on them, and several links in one scene."""

import math

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe.command.files.scenes import read_scene
from rockframe.compiled.bound import structure_of
from rockframe.errors import AssemblyError, ComponentError, StudyError
from rockframe.simulation.certify.perturbations import parameters

WEIGHT, GRAVITY = 1e6, 9.80665
BLOCK = rf.Block(width="2 m", height="8 m", mass=f"{WEIGHT / GRAVITY!r} kg")
TENDON = rf.Tendon(stiffness="2.5 MN/m", preload="0.2 MN")  # E A = 20 MN over 8 m
LOAD = rf.Load(at=("-1 m", "4 m"), vertical="50 kN", horizontal="5 kN")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
PULSE = rf.GroundMotion.sine_pulse(amplitude="5 m/s^2", frequency="1 Hz")
ANGLES = np.array([0.01, 0.05, 0.1, 0.15])


def moments(*parts, angles=ANGLES):
    return rf.System(*parts).moment_rotation((angles, "rad")).restoring_moment.values


def test_moments_of_a_central_tendon_match_closed_form():
    known = [1184947.7, 1123719.0, 1045004.1, 964051.7]
    np.testing.assert_allclose(moments(BLOCK, TENDON), known, rtol=1e-7)
    b, ea, preload = 1.0, 20e6, 0.2e6
    added = preload * b * np.cos(0.5 * ANGLES) + ea * b**2 / 8.0 * np.sin(ANGLES)
    np.testing.assert_allclose(moments(BLOCK, TENDON) - moments(BLOCK), added, rtol=1e-12)


@pytest.mark.parametrize("base", ["pads", "soil"])
def test_uplift_angle_includes_loads_on_the_base(base):
    """An end lifts when the rotation of the base reaches the settlement under weight and load."""
    bases = {"pads": rf.TwoSpringSupport(stiffness="40 MN/m", damping_ratio=0.1),
             "soil": rf.WinklerSoil(stiffness="40 MPa", damping_ratio=0.1)}  # fmt: skip
    floor = rf.Load(at=("0 m", "8 m"), vertical="400 kN")
    system = rf.System(BLOCK, bases[base], floor)
    angle = math.asin((WEIGHT + 4e5) / (2.0 * 40e6) / 1.0)  # both have 80 MN/m in total
    assert float(system.equilibrium().uplift_angle) == pytest.approx(angle, rel=1e-9)
    around = angle * np.array([-1.0001, -0.9999, 0.9999, 1.0001])
    contact = system.moment_rotation((around, "rad")).held_contact_state.values
    assert (contact != 0).tolist() == [True, False, False, True]
    sides = rf.System(BLOCK, bases[base], floor.replace(horizontal="20 kN"))
    assert float(sides.equilibrium().uplift_angle) == pytest.approx(angle, rel=1e-9)


def test_uplift_angle_of_a_loaded_upper_body_is_undefined():
    stack = rf.Stack(rf.Block(width="1 m", height="3 m", mass="2 t"), BLOCK, interfaces=[PADS])
    free, loaded = (
        rf.System(stack, PADS, LOAD.replace(at=("0 m", "2 m"), on_body=body)) for body in (2, 1)
    )
    bare = rf.System(stack, PADS).setting.uplift_angle
    assert free.setting.uplift_angle == bare
    assert math.isnan(loaded.setting.uplift_angle)


def test_preload_defaults_to_zero():
    slack, tie = rf.Tendon(stiffness="2.5 MN/m"), TENDON.replace(preload="0 N")
    np.testing.assert_array_equal(moments(BLOCK, tie), moments(BLOCK, slack))


def test_moments_of_an_eccentric_tendon_match_closed_form():
    at, preload = 0.3, 0.2e6
    for side in (1.0, -1.0):
        lever = 1.0 - side * at
        angles = side * ANGLES
        added = moments(BLOCK, TENDON.replace(at=f"{at} m"), angles=angles)
        added -= moments(BLOCK, angles=angles)
        expected = preload * lever * np.cos(0.5 * ANGLES) + 2.5e6 * lever**2 * np.sin(ANGLES)
        np.testing.assert_allclose(added, side * expected, rtol=1e-12)


def test_tendon_raises_uplift_acceleration_and_energy_balances():
    system = rf.System(BLOCK, TENDON)
    rest = system.equilibrium()
    np.testing.assert_allclose(rest.static_left_reaction, 0.5 * (WEIGHT + 0.2e6))
    for share, starts in ((0.999, False), (1.001, True)):
        level = 0.25 * GRAVITY * 1.2 * share
        motion = rf.GroundMotion.from_arrays(([0.0, level, level, 0.0], "m/s^2"), time_step="0.2 s")
        run = system.simulate(motion)
        assert (float(run.peak_rotation) > 0.0) is starts
    run = system.simulate(PULSE, free_vibration="1 s", accuracy="reference", outputs=("energy",))
    mirrored = system.simulate(PULSE.scaled(-1.0), free_vibration="1 s", accuracy="reference")
    assert float(run.energy_residual) < 1e-8
    np.testing.assert_allclose(mirrored.rotation, -run.rotation, rtol=0, atol=1e-9)


def test_moment_of_a_load_matches_closed_form_and_energy_balances():
    x, y, down, right = -2.0, 4.0, 50e3, 5e3  # from the right corner
    sine, cosine = np.sin(ANGLES), np.cos(ANGLES)
    turning = down * (x * cosine + y * sine) + right * (-x * sine + y * cosine)
    added = moments(BLOCK, LOAD) - moments(BLOCK)
    np.testing.assert_allclose(added, -turning, rtol=1e-10)
    run = rf.System(BLOCK, LOAD).simulate(PULSE, free_vibration="1 s", outputs=("energy",))
    assert float(run.energy_residual) < 1e-8
    assert "restrainer" not in run.dims


@pytest.mark.parametrize("base", [(), (PADS,)], ids=["rigid", "pads"])
def test_links_of_all_kinds_share_compiled_code(base):
    tie = rf.Restrainer(on=("-1 m", "6 m"), to=("-3 m", "6 m"), stiffness="1 MN/m")
    load = rf.Load(at=("0 m", "4 m"), horizontal="1 kN")
    wall = rf.RearWall(side="left", stiffness="2 MN/m", gap="5 mm")
    systems = [
        rf.System(BLOCK, *base, *links).assembly.model.system
        for links in ((tie,), (load,), (wall,), (wall, load, tie))
    ]
    assert len({structure_of(system) for system in systems}) == 1
    # states of each law: four of a tie, two of a wall, one of a load
    assert [one.modes() / systems[1].modes() for one in systems] == [4, 1, 2, 8]


@pytest.mark.parametrize(
    ("force", "words"),
    [
        ({"vertical": f"{-2.0 * WEIGHT!r} N"}, "restrainers lift body 1 off its rigid base"),
        ({"vertical": f"{-BLOCK.si.mass * GRAVITY!r} N"}, "restrainers lift body 1 off"),
        ({"horizontal": "1 MN"}, "restrainers tip body 1 to the right, off its rigid base"),
    ],
)
def test_loads_that_lift_or_tip_a_body_at_rest_are_refused(force, words):
    with pytest.raises(AssemblyError, match=words):
        rf.System(BLOCK, rf.Load(at=("0 m", "8 m"), **force))


def test_work_of_a_load_is_potential_energy_with_restrainers():
    slack = rf.Restrainer(on=("-1 m", "6 m"), to=("-3 m", "6 m"), stiffness="1 MN/m", slack="9 m")
    with plain_python():
        without, combined = (
            rf.System(BLOCK, LOAD, *links).simulate(PULSE, duration="0.8 s", outputs=("energy",))
            for links in ((), (slack,))
        )
    assert float(abs(without.potential_energy).max()) > 1.0
    np.testing.assert_allclose(combined.potential_energy, without.potential_energy, atol=1e-6)


def test_a_mass_at_a_point_is_a_part_of_the_body():
    # a point mass in the block's centre, without inertia
    heavy = BLOCK.replace(
        mass=f"{float(BLOCK.mass.m_as('kg')) + 5e3!r} kg", shape_factor=None,
        inertia=f"{float(BLOCK.si.inertia)!r} kg*m^2",
    )  # fmt: skip
    mass = rf.Load(at=("0 m", "4 m"), moving_mass="5 t")
    runs = [
        rf.System(*parts).simulate(PULSE, free_vibration="1 s", accuracy="reference")
        for parts in ((heavy,), (BLOCK, mass))
    ]
    np.testing.assert_allclose(runs[1].rotation, runs[0].rotation, rtol=0, atol=1e-10)


def test_sweep_of_moving_mass_may_include_zero():
    system = rf.System(BLOCK, rf.Load(at=("0 m", "8 m"), moving_mass="5 t"))
    runs = rf.sweep(system, PULSE, moving_mass=["0 t", "5 t"], outputs=None, progress=False)
    for parts, peak in zip(((BLOCK,), system.parts.structural()), runs.peak_rotation, strict=True):
        alone = rf.System(*parts).simulate(PULSE, outputs=None)
        assert peak.item() == pytest.approx(float(alone.peak_rotation), rel=1e-6)


def test_tendon_on_pads_equals_an_anchored_restrainer():
    tie = rf.Restrainer(
        on=("0.2 m", "0 m"), to=("0.2 m", "-2 m"), stiffness="2.5 MN/m", preload="0.2 MN"
    )
    runs = [
        rf.System(BLOCK, PADS, one, LOAD).simulate(PULSE, free_vibration="1 s", outputs=("energy",))
        for one in (tie, TENDON.replace(at="0.2 m", depth="2 m"))
    ]
    np.testing.assert_array_equal(runs[0].rotation, runs[1].rotation)
    assert float(runs[0].energy_residual) < 1e-8
    with pytest.raises(AssemblyError, match="is bent at a base that gives way"):
        rf.System(BLOCK, PADS, TENDON)
    with pytest.raises(ComponentError, match="is not below its strength"):
        TENDON.replace(strength="0.1 MN")
    with pytest.raises(ComponentError, match="give vertical, horizontal or moving_mass"):
        rf.Load(at=("0 m", "1 m"))


def test_sweep_axes_distinguish_several_links():
    tie = rf.Restrainer(
        on=("-1 m", "6 m"), to=("-3 m", "6 m"), stiffness="1 MN/m", slack="5 mm", name="upper"
    )
    scene = rf.System(BLOCK, tie, TENDON, LOAD)
    assert rf.System.from_dict(scene.to_dict()) == scene
    runs = rf.sweep(
        scene, motions={"pulse": PULSE}, free_vibration="1 s",
        axes={"upper.stiffness": ([0.01, 1.0], "MN/m"), "Tendon.preload": (["0.1 MN", "0.2 MN"])},
    )  # fmt: skip
    assert dict(runs.sizes) == {"upper.stiffness": 2, "Tendon.preload": 2, "motion": 1}
    changed = tie.replace(stiffness="0.01 MN/m"), TENDON.replace(preload="0.2 MN"), LOAD
    alone = rf.System(BLOCK, *changed).simulate(PULSE, free_vibration="1 s")
    assert runs.peak_rotation[0, 1, 0].item() == alone.peak_rotation.item()
    varied = [name for name, _ in parameters(scene.assembly)]
    assert varied[3:] == [
        "stiffness of upper", "slack of upper", "stiffness of restrainer 2",
        "preload of restrainer 2", "vertical of load 3", "horizontal of load 3",
    ]  # fmt: skip
    both = rf.System(BLOCK, tie, tie.replace(name="lower", to=("-4 m", "6 m")))
    with pytest.raises(StudyError, match=r"'upper\.stiffness' or 'lower\.stiffness'"):
        rf.sweep(both, motions={"pulse": PULSE}, axes={"stiffness": ([1.0], "MN/m")})


def test_scene_file_may_contain_several_links(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(
        """
[block]
width = "2 m"
height = "8 m"
mass = "100 t"

[[restrainer]]
on = ["-1 m", "6 m"]
to = ["-3 m", "6 m"]
stiffness = "1 MN/m"
name = "upper"

[[restrainer]]
type = "Tendon"
stiffness = "2.5 MN/m"
preload = "0.2 MN"
"""
    )
    found = read_scene(path).system
    assert [type(one).__name__ for one in found.parts.links] == ["Restrainer", "Tendon"]
    assert found.parts.links[0].name == "upper"
