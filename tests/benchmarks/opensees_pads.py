"""The block on two pads in OpenSees, with the middle of its base held.

The block is a frame of five bars that no load stretches noticeably (corotTruss, exact at finite
rotation) between four point masses: at both corners, in the middle of the base, and above it so
that mass, centre of mass and moment of inertia are the block's. OpenSees' corotational beams would
be equivalent in theory, but their angles are rounded to about 1e-9, so that Newton's iteration
fails with stiff beams.

Under each corner stands a vertical spring without tension (ENT); the parallel dashpot (Viscous) is
always attached. rockframe's pad separates when its force, dashpot included, falls to zero. Both
therefore solve the same equations where the pads have no dashpots and restitution is 1, or where
no corner lifts, and as long as the block does not fly, as OpenSees always holds the middle of the
base.
"""

import ctypes
import importlib.util
import math
from pathlib import Path
from types import ModuleType

import numpy as np

STIFF = 1e7
"""Stiffness of the bars over that of a pad: their strain is below the errors compared."""
CONVERGED = 1e-11
"""Change of the unknowns at which Newton's iteration has converged [m, rad]."""
ITERATIONS = 50
LIBRARIES = ("libquadmath.so.0", "libgfortran.so.4", "libblas.so.3", "liblapack.so.3")


def opensees() -> ModuleType:
    """Import OpenSees; raise ImportError if that is impossible.

    Its wheel for Linux contains the libraries it needs, but does not locate them: they are loaded
    first.
    """
    found = importlib.util.find_spec("openseespylinux")
    if found is not None and found.origin is not None:
        folder = Path(found.origin).parent / "lib"
        for name in LIBRARIES:
            if (folder / name).is_file():
                ctypes.CDLL(str(folder / name), mode=ctypes.RTLD_GLOBAL)
    try:
        from openseespy import opensees as ops
    except RuntimeError as error:  # the package's error for a missing library
        msg = f"openseespy is installed but does not load: {error}"
        raise ImportError(msg) from error
    return ops


def simulate(
    ops: ModuleType,
    *,
    half_width: float,
    half_height: float,
    mass: float,
    inertia: float,
    stiffness: float,
    damping: float,
    gravity: float,
    acceleration: np.ndarray,
    time_step: float,
    steps_per_sample: int,
    samples_per_output: int,
    stiff: float = STIFF,
    integrator: tuple = ("Newmark", 0.5, 0.25),
    converged: float = CONVERGED,
) -> np.ndarray:
    """Integrate by Newmark's rule (average acceleration) with Newton's iteration.

    ``inertia`` is about the centre of mass; ``stiffness`` and ``damping`` are those of one pad.

    Returns
    -------
    ndarray
        Rotation, clockwise, at every output.
    """
    b, h = half_width, half_height
    top = _top(b, h, inertia / mass)
    base = mass * (1.0 - h / top)
    masses = {3: 0.5 * base, 4: 0.25 * base, 5: 0.25 * base, 6: mass - base}
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    places = ((-b, 0.0), (b, 0.0), (0.0, 0.0), (-b, 0.0), (b, 0.0), (0.0, top))
    for tag, place in enumerate(places, 1):
        ops.node(tag, *place)
    ops.fix(1, 1, 1)
    ops.fix(2, 1, 1)
    ops.fix(3, 1, 0)
    for tag, share in masses.items():
        ops.mass(tag, share, share)
    ops.uniaxialMaterial("Elastic", 1, stiff * stiffness)
    for tag, ends in enumerate(((4, 3), (3, 5), (6, 3), (6, 4), (6, 5)), 1):
        ops.element("corotTruss", tag, *ends, math.dist(*(places[i - 1] for i in ends)), 1)
    ops.uniaxialMaterial("ENT", 2, stiffness)
    ops.uniaxialMaterial("InitStrainMaterial", 3, 2, -0.5 * mass * gravity / stiffness)
    material = 3
    if damping > 0.0:
        ops.uniaxialMaterial("Viscous", 4, damping, 1.0)
        ops.uniaxialMaterial("Parallel", 5, 3, 4)
        material = 5
    ops.element("zeroLength", 6, 1, 4, "-mat", material, "-dir", 2)
    ops.element("zeroLength", 7, 2, 5, "-mat", material, "-dir", 2)
    # the springs carry the weight from the start
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    for tag, share in masses.items():
        ops.load(tag, 0.0, -share * gravity)
    ops.timeSeries("Path", 2, "-dt", time_step, "-values", *acceleration.tolist())
    ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
    ops.system("BandGeneral")
    ops.numberer("RCM")
    ops.constraints("Plain")
    ops.test("NormDispIncr", converged, ITERATIONS)
    ops.algorithm("Newton")
    ops.integrator(*integrator)
    ops.analysis("Transient")
    outputs = (len(acceleration) - 1) // samples_per_output
    rotation = np.zeros(outputs + 1)
    for row in range(1, outputs + 1):
        failed = ops.analyze(samples_per_output * steps_per_sample, time_step / steps_per_sample)
        _solved(failed, row * samples_per_output * time_step)
        across, up = ops.nodeDisp(6, 1), ops.nodeDisp(6, 2) - ops.nodeDisp(3, 2)
        rotation[row] = math.atan2(across, top + up)
    return rotation


def _top(b: float, h: float, square: float) -> float:
    """Return the height of the upper point mass that gives the right inertia.

    The masses at the base are a half in the middle and a quarter at either corner; `square` is
    the inertia about the centre of mass over the mass.
    """
    half = 0.5 * (h**2 + 0.5 * b**2 - square)
    return h + (math.sqrt(half**2 + square * h**2) - half) / h


def _solved(failed: int, time: float) -> None:
    if failed:
        msg = f"OpenSees did not converge before {time:.4g} s"
        raise RuntimeError(msg)
