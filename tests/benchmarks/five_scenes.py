"""The five scenes of speed measurements, for rockframe and for hand-written SciPy programs."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from reference_models.monoliths import cascade, coupled, rigid_block, two_spring, winkler

import rockframe as rf

GRAVITY = 9.80665
OUTPUT_STEP = 0.02
BLOCK = {"half_width": 2.0, "half_height": 9.0, "shape_factor": 3.0}
MASS = 99e3
CAP = {"cap_half_width": 2.0, "cap_half_height": 0.45, "cap_mass": 36e3}
PADS = {"frequency_ratio": 40.0, "damping_ratio": 0.10}
SOIL = {"bed_stiffness": 9e6, "bed_damping": 2.2e5}


@dataclass(frozen=True)
class Scene:
    """A scene, and a function that integrates it with SciPy and gives the rotation."""

    system: rf.System
    by_hand: Callable[..., np.ndarray]


@cache
def motion() -> rf.GroundMotion:
    """Return eight seconds of strong motion; contact changes in every scene."""
    record = rf.GroundMotion.stochastic(
        6.8, "5 km", seed=29, stress_drop="20 MPa", source="one corner"
    )
    return record.scaled(2.4).window("5 s", "13 s")


def scenes() -> dict[str, Scene]:
    """Return the five by name.

    The cascade holds the middle of the base in every contact state, so that the speed of the cap's
    top does not jump and its acceleration describes all of its motion.
    """
    block = rf.Block(width="4 m", height="18 m", mass="99 t")
    pads = rf.TwoSpringSupport(**PADS)
    cap = rf.CushionCap(height="0.9 m", mass="36 t")
    soil = rf.WinklerSoil(stiffness="9 MPa", damping="220 kPa*s")
    return {
        "rigid ground": Scene(rf.System(block), _rigid),
        "pads": Scene(rf.System(block, pads), _pads),
        "soil": Scene(rf.System(block, soil), _soil),
        "cascade": Scene(
            rf.System(block, pads, cap, soil, coupling="cascade", restraint="centre"), _cascade
        ),
        "coupled": Scene(rf.System(block, pads, cap, soil), _coupled),
    }


def _rigid(**run) -> np.ndarray:
    return rigid_block.simulate(**BLOCK, gravity=GRAVITY, **run).rotation


def _pads(**run) -> np.ndarray:
    return two_spring.simulate(**BLOCK, **PADS, gravity=GRAVITY, **run).rotation


def _soil(**run) -> np.ndarray:
    start = (0.0, None, 0.0, 0.0)
    return winkler.simulate(
        **BLOCK, **SOIL, mass=MASS, gravity=GRAVITY, initial=start, **run
    ).rotation


def _coupled(**run) -> np.ndarray:
    return coupled.simulate(
        **BLOCK, **CAP, **PADS, **SOIL, mass=MASS, gravity=GRAVITY, **run
    ).rotation


def _cascade(**run) -> np.ndarray:
    h, h_c, m_c = BLOCK["half_height"], CAP["cap_half_height"], CAP["cap_mass"]
    b, total = BLOCK["half_width"], MASS + m_c
    centre = (MASS * (2.0 * h_c + h) + m_c * h_c) / total
    inertia = (
        MASS * (b**2 + h**2) / 3.0 + MASS * (2.0 * h_c + h - centre) ** 2
        + m_c * (b**2 + h_c**2) / 3.0 + m_c * (centre - h_c) ** 2
    )  # fmt: skip
    body = {"half_width": b, "half_height": centre, "mass": total, "inertia": inertia, **SOIL}
    rule = {"gravity": GRAVITY, "restraint": "centre"}
    rotation, _, _ = cascade.simulate(
        body={**body, **rule, "initial": (0.0, None, 0.0, 0.0)},
        block={**BLOCK, **PADS, **rule},
        top=2.0 * h_c - centre,
        **run,
    )
    return rotation
