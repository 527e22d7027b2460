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
