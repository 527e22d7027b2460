"""A rocking frame against separate bodies for its columns and beam."""

import numpy as np
import pytest
from reference_models.monoliths.column_frame import Bodies

import rockframe as rf
from rockframe.dynamics.protocol import Ground, Start

GRAVITY = 9.80665


def scenes(count):
    rng = np.random.default_rng(41)
    for _ in range(count):
        height = rng.uniform(2.0, 12.0)
        width, mass = height / rng.uniform(1.6, 9.0), rng.uniform(5.0, 90.0)
        column = rf.Block(
            width=f"{width} m", height=f"{height} m", mass=f"{mass} t",
            shape_factor=rng.uniform(2.3, 5.0), centre_height=f"{height * rng.uniform(0.4, 0.6)} m",
        )  # fmt: skip
        number = int(rng.integers(2, 5))
        yield rng, column, number, rng.choice([0.0, 0.3, 1.0, 4.0, 20.0]) * number * mass


def test_accelerations_reactions_and_impacts_match_separate_bodies():
    for rng, column, number, beam in scenes(60):
        si = column.si
        bodies = Bodies(
            number, si.half_width, si.height, si.centre_height, si.mass, si.inertia, 1e3 * beam
        )
        frame = rf.RockingFrame(column, columns=number, beam_mass=f"{beam} t")
        model = rf.System(frame).assembly.model
        theta = min(model.rotation_limits)
        angle, rate = rng.uniform(-0.9, 0.9) * theta, rng.normal() * model.fastest_frequency * theta
        side = np.sign(angle)
        ground = Ground(*rng.normal(size=2))
        mode, state, memory = 1 if side > 0.0 else 2, np.array([angle, rate]), np.zeros(6)
        slope = model.system.accelerate(mode, state, ground)
        found, feet = bodies.acceleration(angle, rate, side, ground, GRAVITY)
        assert slope[0] == pytest.approx(found, rel=1e-12, abs=1e-12)
        names = [one.name for one in model.columns]
        seen = dict(
            zip(names, model.system.observe(mode, state, slope, ground, memory), strict=True)
        )
        total = number * si.mass + 1e3 * beam
        forces = [total * seen["horizontal_reaction"], total * seen["vertical_reaction"]]
        np.testing.assert_allclose(forces, feet, rtol=1e-11, atol=1e-11 * total * GRAVITY)
        # energies, and the works of ground and gravity
        energies = model.system.energies(mode, state)
        moving = bodies.velocities(angle, rate, side)
        assert total * energies.kinetic == pytest.approx(0.5 * moving**2 @ bodies.mass, rel=1e-12)
        rise = (bodies.places_of(angle, side) - bodies.places_of(0.0, side))[1::3]
        lifted = GRAVITY * rise @ bodies.mass[1::3]
        assert total * energies.gravity == pytest.approx(lifted, rel=1e-9)
        landed = bodies.after_impact(-side * abs(rate), side)
        restitution = rf.System(frame).setting.restitution.left
        assert landed == pytest.approx(-side * abs(rate) * restitution, rel=1e-12)


def test_tendon_forces_match_separate_bodies():
    for rng, column, number, beam in scenes(40):
        si = column.si
        bodies = Bodies(
            number, si.half_width, si.height, si.centre_height, si.mass, si.inertia, 1e3 * beam
        )
        total = number * si.mass + 1e3 * beam
        stiffness, preload = rng.uniform(0.1, 5.0, 2) * total * GRAVITY / number
        tendon = rf.Tendon(stiffness=f"{stiffness} N/m", preload=f"{preload} N")
        frame = rf.RockingFrame(column, columns=number, beam_mass=f"{beam} t")
        system = rf.System(frame, tendon)
        model = system.assembly.model
        theta = min(model.rotation_limits)
        angle, rate = rng.uniform(-0.9, 0.9) * theta, rng.normal() * theta
        side = np.sign(angle)
        ground = Ground(*rng.normal(size=2))
        mode, state, memory = model.initial(Start(rotation=angle, angular_velocity=rate))
        slope = model.system.accelerate(mode, state, ground).copy()
        seen = dict(zip(
            [one.name for one in model.columns],
            model.system.observe(mode, state, slope, ground, memory), strict=True,
        ))  # fmt: skip
        force = total * seen["restrainer_force"]
        loads, longer = bodies.tied(angle, side, force)
        assert seen["restrainer_elongation"] == pytest.approx(longer, rel=1e-11)
        assert force == pytest.approx(preload + stiffness * longer, rel=1e-11)
        found, feet = bodies.acceleration(angle, rate, side, ground, GRAVITY, loads)
        assert slope[0] == pytest.approx(found, rel=1e-11, abs=1e-11)
        forces = [total * seen["horizontal_reaction"], total * seen["vertical_reaction"]]
        np.testing.assert_allclose(forces, feet, rtol=1e-10, atol=1e-11 * total * GRAVITY)
        # static moment that holds the frame at this rotation
        still, _ = bodies.acceleration(angle, 0.0, side, Ground(0.0, 0.0), GRAVITY, loads)
        held = system.moment_rotation([f"{angle} rad"]).restoring_moment.item()
        corner = model.system.rocking.right.inertia * total
        assert held == pytest.approx(-still * corner, rel=1e-10)


def test_points_of_columns_and_beam_match_separate_bodies():
    _, column, number, beam = next(scenes(1))
    si = column.si
    bodies = Bodies(
        number, si.half_width, si.height, si.centre_height, si.mass, si.inertia, 1e3 * beam
    )
    frame = rf.RockingFrame(column, columns=number, beam_mass=f"{beam} t")
    centre, deck = si.centre_height, 1.1 * si.height
    run = rf.System(frame).simulate(
        duration="3 s", initial=rf.InitialState(rotation=f"{0.5 * si.overturning_angle} rad"),
        points={"centre": ("0 m", f"{centre} m"), "deck": ("0 m", f"{deck} m")},
        output_step="0.1 s",
    )  # fmt: skip
    angles = run.rotation.to_numpy()
    assert angles.min() < 0.0 < angles.max()
    for k, angle in enumerate(angles):
        side = np.sign(angle)
        moved = bodies.places_of(angle, side) - bodies.places_of(0.0, side)
        for name, at in (("centre", 0), ("deck", 3 * number)):
            point = run.isel(point=["centre", "deck"].index(name), time=k)
            shown = [point.point_horizontal_displacement, point.point_vertical_displacement]
            np.testing.assert_allclose(shown, moved[at : at + 2], atol=1e-12)
