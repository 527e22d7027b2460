"""Every scene that can be assembled, small enough to run the whole battery over each."""

from itertools import product

import numpy as np

import rockframe as rf

RULES = ("contact-state", "leading-corner", "centre")


def block():
    return rf.Block(width="2.4 m", height="9.6 m", mass="50 t")


def pads(**changed):
    return rf.TwoSpringSupport(**{"frequency_ratio": 20, "damping_ratio": 0.1, **changed})


def two_spring(rule, rotation):
    return lambda **options: rf.System(
        block(), pads(), restraint=rule, rotation=rotation, **options
    )


def rigid_ground(rotation):
    return lambda **options: rf.System(
        block(), rf.RigidGround(restitution=0.85), rotation=rotation, **options
    )


SCENES = {
    **{f"rigid ground, {rotation}": rigid_ground(rotation) for rotation in ("finite", "small")},
    **{
        f"two-spring, {rule}, {rotation}": two_spring(rule, rotation)
        for rule, rotation in product(RULES, ("finite", "small"))
    },
}
"""Makers of systems by name; each takes further options."""

MODELS = {name: name.split(",")[0] for name in SCENES}


def pulse(vertical=False):
    motion = rf.GroundMotion.sine_pulse("-5 m/s^2", "1 Hz")
    if not vertical:
        return motion
    return motion.with_vertical(rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz"))


def record(vertical=False):
    """A sampled motion with a step that is no short binary fraction."""
    rng = np.random.default_rng(3)
    across = np.convolve(rng.normal(size=180), np.ones(25), mode="same")
    across *= 5.5 / np.abs(across).max()
    upwards = rng.normal(size=180)
    return rf.GroundMotion.from_arrays(
        (across, "m/s^2"),
        "0.01 s",
        vertical=(upwards, "m/s^2") if vertical else None,
        name="noise",
    )


MOTIONS = {
    "pulse": lambda: pulse(),
    "pulse and vertical": lambda: pulse(vertical=True),
    "record": lambda: record(),
    "record and vertical": lambda: record(vertical=True),
}
