"""Runs a scene through rockframe's public interface."""

import warnings
from dataclasses import replace

import numpy as np

import rockframe as rf

from .layout import LIMIT
from .motions import build_motions
from .scene import Scene, parameters

RTOL = 1e-12
TIGHT = rf.Accuracy(rtol=RTOL)


def system_of(scene: Scene) -> rf.System:
    """Assemble the scene."""
    block = _block_of(scene)
    parts = [block]
    restitution = {} if scene.restitution is None else {"restitution": scene.restitution}
    if scene.kind == "rigid":
        parts.append(rf.RigidGround(**restitution))
    if scene.kind in ("pads", "cascade", "coupled"):
        parts.append(
            rf.TwoSpringSupport(frequency_ratio=scene.beta, damping_ratio=scene.xi, **restitution)
        )
    if scene.kind in ("bed", "cascade", "coupled"):
        parts.append(
            rf.WinklerSoil(
                stiffness=_in(scene.soil_stiffness, "Pa"),
                damping_ratio=scene.soil_xi,
                separation=scene.separation,
            )
        )
        if scene.has_cap:
            parts.append(
                rf.CushionCap(
                    width=_in(scene.cap_width, "m"),
                    height=_in(scene.cap_height, "m"),
                    mass=_in(scene.cap_mass, "kg"),
                )
            )
    options = {"coupling": scene.kind} if scene.kind in ("cascade", "coupled") else {}
    if scene.inclination != 0.0:
        options["inclination"] = _in(scene.inclination, "rad")
    return rf.System(
        *parts, restraint=scene.rule, rotation="small" if scene.small else "finite", **options
    )


def _block_of(scene: Scene) -> rf.Block:
    width, height, mass = (
        _in(2.0 * scene.half_width, "m"),
        _in(2.0 * scene.half_height, "m"),
        _in(scene.mass, "kg"),
    )
    if scene.eccentricity == 0.0:
        return rf.Block(width=width, height=height, mass=mass, shape_factor=scene.shape_factor)
    return rf.Block(
        width=width,
        height=_in(3.0 * scene.half_height, "m"),
        mass=mass,
        inertia=_in(scene.inertia, "kg m^2"),
        centre_of_mass=(_in(scene.half_height, "m"), _in(scene.eccentricity, "m")),
    )


def run_program(scene: Scene, factor: float = 1.0, accuracy: str | rf.Accuracy = TIGHT):
    """Run the scene with rockframe; `factor` multiplies motion and start."""
    motion, _ = build_motions(scene.motion, factor)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        system = system_of(scene)
        limit = parameters(scene, RTOL)[LIMIT]
        leans = scene.eccentricity != 0.0 or scene.inclination != 0.0
        explicit_start = scene.told or scene.start != 0.0 or not leans
        initial = rf.InitialState(
            rotation=_in(factor * scene.start * limit, "rad") if explicit_start else None,
            angular_velocity=_in(factor * scene.start_rate * scene.frequency * limit, "rad/s"),
        )
        options = {"initial": initial, "accuracy": accuracy}
        if motion is None:
            return system.simulate(duration=_in(scene.free, "s"), output_step="0.01 s", **options)
        return system.simulate(motion, free_vibration=_in(scene.free, "s"), **options)


def scaled_start(scene: Scene, factor: float) -> Scene:
    """Return the scene with a start that is larger by a factor."""
    return replace(scene, start=factor * scene.start, start_rate=factor * scene.start_rate)


def _in(value: float, unit: str) -> str:
    return f"{float(value)!r} {unit}"


def rows_at(times: np.ndarray, run) -> np.ndarray:
    """Return the row of a run at each output time, -1 for none."""
    have = run.time.values
    rows = np.searchsorted(have, times - 1e-9)
    rows = np.minimum(rows, have.size - 1)
    return np.where(np.abs(have[rows] - times) < 1e-9, rows, -1)
