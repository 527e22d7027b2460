"""A block with a tendon against an equation written by hand, in random scenes."""

import math

import numpy as np
import pytest

import rockframe as rf

from .monoliths import tendon, tied_rigid_block

GRAVITY = 9.80665
TIME_STEP, DURATION = 0.05, 1.5


def compare(number):
    """Return difference over the peak, energy balance and events of both programs."""
    rng = np.random.default_rng([60, number])
    width = rng.uniform(0.4, 1.5)
    height = width * rng.uniform(1.5, 5.0)
    at = float(rng.choice([0.0, rng.uniform(-0.4, 0.4)])) * width
    stiffness = GRAVITY * width / height**2 * 10.0 ** rng.uniform(0.0, 2.0)
    preload = float(rng.choice([0.0, rng.uniform(0.0, 1.0)])) * GRAVITY
    noise = rng.normal(size=16) * rng.uniform(0.5, 4.0) * GRAVITY * width / height
    acceleration = np.array([0.0, *noise, 0.0])
    start = float(rng.choice([0.0, 1.0]) * rng.uniform(-0.5, 0.5) * math.atan2(width, height))
    system = rf.System(
        rf.Block(width=f"{width!r} m", height=f"{height!r} m", mass="1 kg"),
        rf.Tendon(
            stiffness=f"{stiffness!r} N/m", at=f"{at!r} m",
            preload=f"{preload!r} N" if preload else None,
        ),
    )  # fmt: skip
    run = system.simulate(
        rf.GroundMotion.from_arrays((acceleration, "m/s^2"), f"{TIME_STEP} s"),
        initial=rf.InitialState(rotation=f"{start!r} rad") if start else None,
        accuracy="reference", output_step="10 ms", duration=f"{DURATION} s", outputs=("energy",),
    )  # fmt: skip
    b, h = 0.5 * width, 0.5 * height
    ties = [tendon.Tendon(b + at, b - at, stiffness, preload)]
    block = tendon.Block(b, h, (b * b + h * h) / 3.0, GRAVITY, ties)
    times = np.append(run.time.values, DURATION)
    reference = tied_rigid_block.simulate(
        block, acceleration, TIME_STEP, start, times, limit=block.theta
    )
    ours, theirs = run.rotation.values, reference.rotation[:-1]
    both = ~np.isnan(ours) & ~np.isnan(theirs)
    return {
        "number": number,
        "difference": float(np.abs(ours - theirs)[both].max())
        / max(float(np.abs(ours[both]).max()), 1e-3),
        "energy_residual": float(run.energy_residual),
        "events": len(run.event_time),
        "overturned": (bool(run.overturned), reference.overturned),
    }


@pytest.mark.parametrize("number", [2, 5, 6, 11])
def test_random_blocks_with_a_tendon(number):
    comparison = compare(number)
    assert comparison["difference"] < 1e-9
    assert comparison["energy_residual"] < 1e-9
    assert comparison["overturned"][0] == comparison["overturned"][1]
    assert comparison["events"] > 1


@pytest.mark.parametrize("accuracy", ["standard", "reference"])
@pytest.mark.parametrize("at", ["0 m", "-0.11 m"])
def test_bodies_that_a_tendon_presses_together_rock_as_one(at, accuracy):
    """Until the first impact: in it a joint may open, as the force of a tendon is no impulse."""
    sides = (0.443, 3.294), (0.679, 3.013)  # of the upper and the lower body [m]
    bodies = [
        rf.Block(width=f"{width} m", height=f"{height} m", mass=f"{500 * width * height} kg")
        for width, height in sides
    ]
    (narrow, _), (wide, level) = sides
    top = sides[0][1] + level
    outline = [(-wide, 0.0), (wide, 0.0), (wide, 2.0 * level), (narrow, 2.0 * level)]
    outline += [(narrow, 2.0 * top), (-narrow, 2.0 * top), (-narrow, 2.0 * level)]
    outline += [(-wide, 2.0 * level)]
    corners = 0.5 * np.array(outline)
    joined = rf.System(
        rf.Stack(*bodies, interfaces=[rf.RigidGround()]),
        rf.Tendon(stiffness="70 kN/m", preload="17 kN", at=at),
    )
    mass = bodies[0].mass + bodies[1].mass
    whole = rf.System(rf.Block.from_outline((corners, "m"), mass=mass))
    motion = rf.GroundMotion.sine_pulse("-1.9 m/s^2", "0.6 Hz")
    plan = {"duration": "1.6 s", "accuracy": accuracy}
    single = whole.simulate(motion, **plan)
    until = float(single.event_time[single.event_kind == 2][0])  # the first impact
    parts = joined.simulate(motion, **plan)
    assert 0.3 < until < 1.6
    events = single.event_time.to_numpy()[single.event_time <= until]
    found = parts.event_time.to_numpy()[parts.event_time <= until + 1e-9]
    np.testing.assert_allclose(found, events, rtol=0.0, atol=1e-9)
    np.testing.assert_array_equal(parts.event_body[: len(found)], 2)
    rotation = single.rotation.sel(time=slice(None, until))
    assert abs(rotation).max() > 1e-3
    same = parts.sel(time=slice(None, until))
    np.testing.assert_allclose(same.body_rotation[1], rotation, rtol=0.0, atol=1e-8)
    np.testing.assert_array_equal(same.body_rotation_on_base[0], 0.0)


def draw_stack(number):
    """Return a random stack with a tendon through some of its bodies, and a motion."""
    rng = np.random.default_rng([7, number])
    height = rng.uniform(1.0, 10.0)
    wide = height / rng.uniform(2.0, 8.0)
    shares, weight = rng.dirichlet(np.full(int(rng.choice([2, 2, 3])), 4.0)), 2e3 * GRAVITY
    bodies, links, width = [], [], wide
    for share in shares:  # from the ground up
        bodies.insert(0, rf.Block(
            width=f"{width} m", height=f"{max(share * height, 0.75 * width)} m",
            mass=f"{2e3 * share} kg",
        ))  # fmt: skip
        width *= rng.uniform(0.6, 1.0)
    for place, body in enumerate(bodies, 1):
        if rng.random() < 0.3 and place < len(bodies):
            continue
        preload = weight * rng.choice([0.0, 10.0 ** rng.uniform(-4.0, 0.5)])
        options = {"preload": f"{preload} N"} if preload else {}
        if rng.random() < 0.3:
            options["strength"] = f"{preload + weight * 10.0 ** rng.uniform(-3.0, 0.0)} N"
            options["brittle"] = bool(rng.random() < 0.5)
        links.append(rf.Tendon(
            stiffness=f"{weight / wide * 10.0 ** rng.uniform(-3.0, 2.0)} N/m", on_body=place,
            at=f"{rng.choice([0.0, rng.uniform(-0.4, 0.4)]) * body.si.width} m", **options,
        ))  # fmt: skip
    joints = [rf.RigidGround()] * (len(bodies) - 1)
    noise = np.convolve(rng.normal(size=80), np.hanning(rng.integers(5, 25)), "same")
    noise *= GRAVITY * wide / height * rng.uniform(0.8, 4.0) / np.abs(noise).max()
    motion = rf.GroundMotion.from_arrays((noise, "m/s^2"), time_step="0.04 s")
    return rf.System(rf.Stack(*bodies, interfaces=joints), rf.RigidGround(), *links), motion


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
@pytest.mark.parametrize("number", range(60))
def test_random_stacks_with_tendons_end_alike_at_both_accuracies(number):
    system, motion = draw_stack(number)
    runs = [
        system.simulate(motion, accuracy=accuracy, outputs=("energy",))
        for accuracy in ("standard", "reference")
    ]
    assert int(runs[0].status) == int(runs[1].status) <= 2
    assert float(runs[0].energy_residual) < 1e-5
    assert float(runs[1].energy_residual) < 1e-8
    if int(runs[0].status) == 0:
        assert float(runs[0].peak_rotation) == pytest.approx(float(runs[1].peak_rotation), rel=1e-3)
