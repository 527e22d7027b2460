"""The block in OpenSees: the code of files written by :func:`rockframe.export.to_opensees`.

It needs only numpy and openseespy, because it is copied into that file unchanged.
"""

import csv
import ctypes
import importlib.util
import math
import os
from pathlib import Path
from typing import Any

import numpy as np

LIBRARIES = ("libquadmath.so.0", "libgfortran.so.4", "libblas.so.3", "liblapack.so.3")


def opensees() -> Any:
    """Import OpenSees; its wheel for Linux needs its own libraries to be loaded first."""
    spec = importlib.util.find_spec("openseespylinux")
    if spec is not None and spec.origin is not None:
        for name in LIBRARIES:
            library = Path(spec.origin).parent / "lib" / name
            if library.is_file():
                ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    return importlib.import_module("openseespy.opensees")


def build(ops: Any, arguments: dict[str, Any]) -> tuple[int, int, float]:
    """Build the block on its springs; give the nodes of its axis and the height between them [m].

    The block is a truss of nearly rigid bars, exact at finite rotations. Four point masses give
    its mass, its centre of mass and its moment of inertia. Of the mass at the base a half is in
    the middle, and a quarter at each corner; the rest of the mass is at the top.
    """
    b, h, mass = arguments["half_width"], arguments["centre_height"], arguments["mass"]
    square = arguments["inertia"] / mass
    half = 0.5 * (h**2 + 0.5 * b**2 - square)
    top = h + (math.sqrt(half**2 + square * h**2) - half) / h
    base = mass * (1.0 - h / top)
    springs_at = arguments["springs_at"]
    stiffness = arguments["stiffness"]
    damping = arguments["damping"]
    weight, count = mass * arguments["gravity"], len(springs_at)
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    # the two nodes connected to all others come last, for a narrow profile of the equations
    nodes = list(range(1, count + 1))  # above the springs
    left, right, middle, above = range(count + 1, count + 5)
    places = {tag: (x, 0.0) for tag, x in zip(nodes, springs_at, strict=True)}
    places |= {left: (-b, 0.0), right: (b, 0.0), middle: (0.0, 0.0), above: (0.0, top)}
    for tag, place in places.items():
        ops.node(tag, *place)
    ops.fix(middle, 1, 0)
    masses = {middle: 0.5 * base, left: 0.25 * base, right: 0.25 * base, above: mass - base}
    for tag, share in masses.items():
        ops.mass(tag, share, share)
    ops.uniaxialMaterial("Elastic", 1, arguments["bars_over_springs"] * stiffness * count)
    bars = [(above, middle)]
    bars += [
        (node, tag) for tag in places if tag not in (middle, above) for node in (middle, above)
    ]
    for number, (start, end) in enumerate(bars, 1):
        length = math.dist(places[start], places[end])
        ops.element("corotTruss", number, start, end, length, 1)
    # springs without tension, which carry the weight from the start, and dashpots
    initial_strain = -weight / (count * stiffness)
    if arguments["dashpots"] == "let go" and damping > 0.0:
        ops.uniaxialMaterial("ViscoelasticGap", 2, stiffness, damping, -1e-12)
        ops.uniaxialMaterial("InitStrainMaterial", 5, 2, initial_strain)
    else:
        ops.uniaxialMaterial("ENT", 2, stiffness)
        ops.uniaxialMaterial("InitStrainMaterial", 3, 2, initial_strain)
        ops.uniaxialMaterial("Viscous", 4, max(damping, 1e-12), 1.0)
        ops.uniaxialMaterial("Parallel", 5, 3, 4)
    for number, tag in enumerate(nodes):
        ground = above + 1 + number
        ops.node(ground, *places[tag])
        ops.fix(ground, 1, 1)
        ops.element("zeroLength", len(bars) + 1 + number, ground, tag, "-mat", 5, "-dir", 2)
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    for tag, share in masses.items():
        ops.load(tag, 0.0, -share * arguments["gravity"])
    for direction, name in enumerate(("acceleration", "vertical_acceleration"), 1):
        if arguments[name] is not None:
            values = np.append(arguments[name], 0.0).tolist()
            ops.timeSeries("Path", 1 + direction, "-dt", arguments["time_step"], "-values", *values)
            ops.pattern("UniformExcitation", 1 + direction, direction, "-accel", 1 + direction)
    return middle, above, top


def solve(ops: Any, values: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Integrate by Newmark's rule; give times [s] and rotations, clockwise, [rad]."""
    middle, above, top = build(ops, values)
    ops.system("ProfileSPD")
    ops.numberer("Plain")
    ops.constraints("Plain")
    ops.test("NormDispIncr", values["tolerance"], 30)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    step, steps = values["output_step"], values["steps_per_output"]
    rotation = [0.0]
    for row in range(1, values["outputs"]):
        if not all(step_in_parts(ops, step / steps) for _ in range(steps)):
            print(f"OpenSees did not converge before {row * step:.4g} s")
            break
        sideways, up = ops.nodeDisp(above, 1), ops.nodeDisp(above, 2) - ops.nodeDisp(middle, 2)
        rotation.append(math.atan2(sideways, top + up))
        if abs(rotation[-1]) >= values["overturning_angle"]:
            print(f"OpenSees: overturned after {row * step:.4g} s")
            break
    return step * np.arange(len(rotation)), np.array(rotation)


def step_in_parts(ops: Any, step: float, halvings: int = 10) -> bool:
    """Take a step, or two half steps if Newton's iteration does not converge."""
    if ops.analyze(1, step) == 0:
        return True
    return halvings > 0 and all(step_in_parts(ops, 0.5 * step, halvings - 1) for _ in range(2))


def compare_peaks(values: dict[str, Any], history: Path) -> dict[str, float]:
    """Run OpenSees, write its history and that of rockframe, and compare the peaks."""
    ops = opensees()
    ops.logFile(os.devnull, "-noEcho")  # it prints a message for each impact
    time, rotation = solve(ops, values)
    expected = values["rotation"]
    count = min(rotation.size, expected.size)
    with history.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time [s]", "rotation in OpenSees [rad]", "rotation in rockframe [rad]"])
        rows = zip(time[:count], rotation[:count], expected[:count], strict=True)
        writer.writerows([f"{value:.9g}" for value in row] for row in rows)
    peaks = {"OpenSees": float(np.abs(rotation).max()), "rockframe": values["peak"]}
    size = max(peaks["rockframe"], 1e-6 * values["overturning_angle"])
    apart = float(np.abs(rotation[:count] - expected[:count]).max()) / size
    print(f"rockframe: {values['verdict']}")
    for name, peak in peaks.items():
        share = 100.0 * peak / values["overturning_angle"]
        print(f"peak rotation in {name}: {peak:.6g} rad, {share:.4g} % of the overturning angle")
    print(f"peaks differ by {100.0 * (peaks['OpenSees'] - peaks['rockframe']) / size:+.3g} %")
    print(f"histories differ by {100.0 * apart:.3g} % of the peak at most")
    print(f"history: {history}")
    return peaks | {"largest difference": apart}
