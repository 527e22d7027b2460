"""Every scene that can be assembled, small enough for tests that cover all of them."""

import math
from itertools import product

import numpy as np

import rockframe as rf

RULES = ("contact-state", "leading-corner", "centre")


def block():
    return rf.Block(width="2.4 m", height="9.6 m", mass="50 t")


def pads(**changed):
    return rf.TwoSpringSupport(**{"frequency_ratio": 20, "damping_ratio": 0.1, **changed})


def cap(**changed):
    return rf.CushionCap(**{"width": "3.2 m", "height": "0.4 m", "mass": "10 t", **changed})


def soil(separation="displacement", **changed):
    arguments = {"stiffness": "30 MPa", "damping_ratio": 0.1, "separation": separation}
    return rf.WinklerSoil(**{**arguments, **changed})


def two_spring(rule, rotation):
    return lambda **options: rf.System(
        block(), pads(), restraint=rule, rotation=rotation, **options
    )


def rigid_ground(rotation):
    return lambda **options: rf.System(
        block(), rf.RigidGround(restitution=0.85), rotation=rotation, **options
    )


def on_soil(rule, rotation, separation):
    return lambda **options: rf.System(
        block(), soil(separation), restraint=rule, rotation=rotation, **options
    )


def one_body(rule, rotation, separation):
    return lambda **options: rf.System(
        block(), cap(), soil(separation), restraint=rule, rotation=rotation, **options
    )


def stacked(coupling, rule, rotation, separation):
    return lambda **options: rf.System(
        block(), pads(), cap(), soil(separation),
        coupling=coupling, restraint=rule, rotation=rotation, **options,
    )  # fmt: skip


# each rule, kinematics and separation occurs in some scene of each model
_SOIL = (
    ("contact-state", "finite", "displacement"),
    ("leading-corner", "finite", "pressure"),
    ("centre", "small", "displacement"),
)

SCENES = {
    **{f"rigid ground, {rotation}": rigid_ground(rotation) for rotation in ("finite", "small")},
    **{
        f"two-spring, {rule}, {rotation}": two_spring(rule, rotation)
        for rule, rotation in product(RULES, ("finite", "small"))
    },
    **{f"Winkler, {', '.join(kind)}": on_soil(*kind) for kind in _SOIL},
    "Winkler, contact-state, finite, pressure, cap": one_body(
        "contact-state", "finite", "pressure"
    ),
    **{f"coupled, {', '.join(kind)}": stacked("coupled", *kind) for kind in _SOIL},
    **{f"cascade, {', '.join(kind)}": stacked("cascade", *kind) for kind in _SOIL[:2]},
}
"""Makers of systems by name; each takes further options."""

MODELS = {name: name.split(",")[0] for name in SCENES}
ON_PADS = ("two-spring", "coupled", "cascade")
"""Models of a block on two pads."""
ON_SOIL = ("Winkler", "coupled", "cascade")
STACKED = ("coupled", "cascade")
"""Models of a block on pads on a cap on soil."""


def has_cap(scene):
    return MODELS[scene] in STACKED or scene.endswith(", cap")


def overturning_angle(scene):
    """Return that of the block, or of block and cap where they are one body [rad]."""
    if not scene.endswith(", cap"):
        return math.atan(0.25)
    return math.atan(1.6 / ((50.0 * (0.4 + 4.8) + 10.0 * 0.2) / 60.0))


def pulse(vertical=False):
    motion = rf.GroundMotion.sine_pulse("-5 m/s^2", "1 Hz")
    if not vertical:
        return motion
    return motion.with_vertical(rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz"))


def record(vertical=False):
    """Return a sampled motion whose time step is not a short binary fraction."""
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
