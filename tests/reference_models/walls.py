"""Random blocks before walls, in the package and in an independent program."""

import numpy as np
from reference_models.monoliths import wall_block

import rockframe as rf

GRAVITY = 9.80665


def draw_scene(seed):
    """Return a random block, wall, motion and start."""
    rng = np.random.default_rng(seed)
    height = rng.uniform(1.0, 12.0)
    width, height_share = height / rng.uniform(1.6, 14.0), rng.uniform(0.4, 0.6)
    block = rf.Block(
        width=f"{width} m", height=f"{height} m", mass="2 t",
        shape_factor=rng.uniform(2.5, 4.0), centre_height=f"{height_share * height} m",
        eccentricity=f"{rng.uniform(-0.1, 0.1) * width} m",
    )  # fmt: skip
    wall = rf.RearWall(side=rng.choice(["left", "right"]), restitution=rng.uniform(-0.85, 0.0))
    count, step = 60, 0.04
    bell = np.hanning(rng.integers(5, 25))
    noise = np.convolve(rng.normal(size=count + 30), bell, "same")[:count]
    uplift = GRAVITY * width / height
    noise *= uplift * rng.uniform(0.8, 4.0) / np.abs(noise).max()
    start = rng.choice([0.0, 0.0, rng.uniform(0.05, 0.8)])
    return block, wall, noise, step, start


def compare(seed):
    """Return the largest difference of rotation over theta, and both runs."""
    block, wall, noise, step, start = draw_scene(seed)
    system = rf.System(block, wall)
    corner = system.setting.body
    side = 1.0 if str(wall.side) == "left" else -1.0
    distance = corner.right if side > 0.0 else corner.left
    theta = np.arctan2(distance, corner.centre_height)
    motion = rf.GroundMotion.from_arrays((noise, "m/s^2"), f"{step} s")
    initial = rf.InitialState(rotation=f"{side * start * theta} rad") if start else None
    ours = system.simulate(motion, initial=initial, accuracy="reference", second_look=False)
    theirs = wall_block.simulate(
        theta, np.hypot(distance, corner.centre_height), corner.gyration_square_about(distance),
        float(wall.restitution), side * noise, step, gravity=GRAVITY, start=(start * theta, 0.0),
    )  # fmt: skip
    known = ~np.isnan(theirs.rotation)
    count = min(int(known.sum()), ours.sizes["time"])
    difference = np.abs(side * ours.rotation.to_numpy()[:count] - theirs.rotation[:count]).max()
    return difference / theta, ours, theirs
