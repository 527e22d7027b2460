"""OpenSees compared with rockframe on two pads, middle of the base held: histories and costs."""

import math
import warnings

import numpy as np
from benchmarks.five_scenes import GRAVITY, OUTPUT_STEP, PADS
from benchmarks.opensees_pads import opensees, simulate
from benchmarks.timing import cost

import rockframe as rf
from rockframe.errors import ModelWarning

B, H, MASS = 2.0, 9.0, 99e3
EXACT = rf.Accuracy(rtol=1e-12)
CASES = {
    "undamped, with uplift": (0.0, 2.2),
    "damped, in full contact": (0.10, 0.15),
    "damped, with uplift": (0.10, 2.2),
}
"""Damping ratio, and factor of the motion. Only the first two have the same law in both."""
STEPS_PER_SAMPLE = (1, 2, 4, 8, 16, 32, 64, 128)
TESTS = (1e-6, 1e-8, 1e-10)
"""Changes of the unknowns that end Newton's iteration [m]; the cheapest is reported."""
LEVELS = ("fast", "standard", "reference")
TOLERANCES = tuple(10.0**-power for power in range(2, 12))


def excitation(factor: float) -> rf.GroundMotion:
    """Return the motion of the five scenes with another factor."""
    record = rf.GroundMotion.stochastic(
        6.8, "5 km", seed=29, stress_drop="20 MPa", source="one corner"
    )
    return record.scaled(factor).window("5 s", "13 s")


def system(damping_ratio: float) -> rf.System:
    """Return the scene; without dashpots a landing corner keeps its speed."""
    block = rf.Block(width=f"{2 * B} m", height=f"{2 * H} m", mass=f"{MASS} kg")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # restitution 1 is intended
        restitution = 1.0 if damping_ratio == 0.0 else None
        pads = rf.TwoSpringSupport(
            frequency_ratio=PADS["frequency_ratio"],
            damping_ratio=damping_ratio,
            restitution=restitution,
        )
        return rf.System(block, pads, restraint="centre")


def arguments(damping_ratio: float, motion: rf.GroundMotion) -> dict:
    """Return the arguments of the same scene in OpenSees."""
    vertical = PADS["frequency_ratio"] * math.sqrt(0.75 * GRAVITY / math.hypot(B, H))
    return {
        "half_width": B, "half_height": H, "mass": MASS, "inertia": MASS * (B**2 + H**2) / 3.0,
        "stiffness": 0.5 * MASS * vertical**2, "damping": damping_ratio * MASS * vertical,
        "gravity": GRAVITY, "acceleration": motion.si.horizontal.samples,
        "time_step": motion.si.time_step,
        "samples_per_output": round(OUTPUT_STEP / motion.si.time_step),
    }  # fmt: skip


def compare(steps: tuple[int, ...] = STEPS_PER_SAMPLE, repeats: int = 3) -> dict:
    """Run all cases in both programs; return errors and times."""
    ops = opensees()
    ops.logFile("/dev/null", "-noEcho")
    return {name: _compare(ops, *case, steps, repeats) for name, case in CASES.items()}


def _compare(ops, damping_ratio, factor, steps, repeats) -> dict:
    scene, motion = system(damping_ratio), excitation(factor)
    run = {"output_step": f"{OUTPUT_STEP} s"}
    answer = scene.simulate(motion, accuracy=EXACT, **run)
    exact = answer["rotation"].to_numpy()

    def error(rotation: np.ndarray) -> float:
        return float(np.abs(rotation - exact).max() / np.abs(exact).max())

    points = []
    settings = {level: level for level in LEVELS}
    settings |= {f"rtol {rtol:g}": rf.Accuracy(rtol=rtol) for rtol in TOLERANCES}
    for name, accuracy in settings.items():

        def ours(accuracy=accuracy):
            return scene.simulate(motion, accuracy=accuracy, **run)

        found = ours()
        points.append(
            {
                "program": "rockframe",
                "setting": name,
                "time": cost(ours, 5 * repeats),
                "error": error(found["rotation"].to_numpy()),
                "steps": int(found.attrs["solver_steps"]),
            }
        )
    options = arguments(damping_ratio, motion)
    for count in steps:
        for test in TESTS:

            def theirs(count=count, test=test):
                return simulate(ops, **options, steps_per_sample=count, converged=test)

            row = {
                "program": "OpenSees",
                "setting": f"step {1e3 * options['time_step'] / count:g} ms, test {test:g}",
            }
            try:
                found = theirs()
            except RuntimeError as trouble:
                points.append(row | {"time": None, "error": None, "trouble": str(trouble)})
                continue
            spent = cost(theirs, repeats if count <= max(steps) // 4 else 1)
            points.append(row | {"time": spent, "error": error(found)})
            print(damping_ratio, factor, points[-1], flush=True)
    return {
        "damping_ratio": damping_ratio,
        "factor": factor,
        "verdict": answer.attrs["verdict"],
        "peak": float(answer["peak_relative_rotation"]),
        "impacts": int(answer["impact_count"]),
        "flight_time": float(answer["flight_time"]),
        "points": points,
    }
