"""Work against precision of rockframe, of SciPy's solvers in the five scenes, and of OpenSees.

``python tests/benchmarks/work_precision.py`` measures everything and writes
``docs/data/work_precision.json``, from which the manual draws its figure. It takes some
twenty minutes, nearly all of them in SciPy. Names of scenes, or ``opensees``, as arguments measure
these alone and leave the rest of the file as it is; ``rockframe`` measures rockframe alone in all
scenes and keeps the earlier points of SciPy.

Time is processor time of a whole call, from arguments to histories every 0.02 s. Error is the
largest error of the rotation at these instants over its peak, against rockframe at a tolerance of
1e-12, which the hand-written programs confirm (``disagreement``).

SciPy integrates the hand-written programs of the tests. Each method is used in two ways: it
restarts at every sample of the motion, where the ground's acceleration has a kink, or steps through
the samples, at most ten at a time, and leaves the kinks to the error control. Both restart at
changes of contact, which are found on the dense output of each step.
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from benchmarks.five_scenes import OUTPUT_STEP, Scene, motion, scenes
from benchmarks.timing import cost, machine
from reference_models.monoliths import stepper

import rockframe as rf

DATA = Path(__file__).parents[2] / "docs" / "data" / "work_precision.json"
EXACT = rf.Accuracy(rtol=1e-12)
LEVELS = ("fast", "standard", "reference")
TOLERANCES = tuple(10.0**-power for power in range(2, 12))
REPEATS = 15
PATIENCE = 100.0
"""Time of a run [s] beyond which SciPy gets no tighter tolerance in that way."""
FEW = 2.0
"""Time of a run [s] up to which it is repeated."""

AT_SAMPLES, THROUGH = "begun anew at samples", "through the samples"
SAMPLES_AT_ONCE = 10
SCIPY = {
    ("RK45", AT_SAMPLES): (1e-2, 1e-5, 1e-9, 1e-11),
    ("RK45", THROUGH): (1e-2, 1e-3, 1e-4, 1e-6),
    ("DOP853", AT_SAMPLES): (1e-2, 1e-6, 1e-11),
    ("DOP853", THROUGH): (1e-2, 1e-3, 1e-4, 1e-6),
    ("LSODA", AT_SAMPLES): (1e-3, 1e-6, 1e-9),
    ("LSODA", THROUGH): (1e-2, 1e-3, 1e-5, 1e-7),
    ("Radau", AT_SAMPLES): (1e-2, 1e-4, 1e-7),
    ("Radau", THROUGH): (1e-2, 1e-3, 1e-4, 1e-5),
}


def error(rotation: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest error of a rotation over its peak; infinite if a run ended early."""
    if rotation.shape != exact.shape or not np.isfinite(rotation).all():
        return float("inf")
    return float(np.abs(rotation - exact).max() / np.abs(exact).max())


def ours(system: rf.System, excitation: rf.GroundMotion, exact: np.ndarray) -> Iterator[dict]:
    """Measure rockframe at its levels and over tolerances, with and without histories."""
    settings = {level: level for level in LEVELS}
    settings |= {f"rtol {rtol:g}": rf.Accuracy(rtol=rtol) for rtol in TOLERANCES}
    for name, accuracy in settings.items():

        def run(accuracy=accuracy, **other):
            return system.simulate(excitation, accuracy=accuracy, overturning="continue", **other)

        result = run(output_step=f"{OUTPUT_STEP} s")
        yield {
            "program": "rockframe",
            "setting": name,
            "time": cost(lambda run=run: run(output_step=f"{OUTPUT_STEP} s"), REPEATS),
            "time_without_histories": cost(lambda run=run: run(outputs=None), REPEATS),
            "error": error(result["rotation"].to_numpy(), exact),
            "steps": int(result.attrs["solver_steps"]),
        }


def by_scipy(scene: Scene, exact: np.ndarray) -> Iterator[dict]:
    """Measure SciPy's methods, each in both ways."""
    si = motion().si
    times = np.arange(len(exact)) * OUTPUT_STEP
    for (method, way), tolerances in SCIPY.items():
        for rtol in tolerances:
            arguments = {
                "time_step": si.time_step, "acceleration": si.horizontal.samples,
                "duration": float(times[-1]), "sample_times": times,
                "rtol": rtol, "atol": 1e-3 * rtol, "method": method,
                "restart_every_knot": way == AT_SAMPLES,
                "max_step": SAMPLES_AT_ONCE * si.time_step, "overturning": "continue",
            }  # fmt: skip
            rotations: list[np.ndarray] = []

            def run(arguments=arguments, rotations=rotations):
                rotations.append(scene.by_hand(**arguments))

            row = {"program": "SciPy", "method": method, "way": way, "setting": f"rtol {rtol:g}"}
            try:
                time = cost(run, 1)
            except (RuntimeError, ValueError, FloatingPointError) as trouble:
                yield row | {"time": None, "error": None, "trouble": str(trouble)[:80]}
                continue
            if time < FEW:
                time = min(time, cost(run, 2))
            yield row | {"time": time, "error": error(rotations[-1], exact)}
            if time > PATIENCE:
                break


def measure(name: str, before: list[dict] | None = None) -> dict:
    """Measure one scene; or rockframe alone, added to points measured before."""
    scene = scenes()[name]
    run = {"output_step": f"{OUTPUT_STEP} s", "overturning": "continue"}
    answer = scene.system.simulate(motion(), accuracy=EXACT, **run)
    exact = answer["rotation"].to_numpy()
    points = list(ours(scene.system, motion(), exact))
    theirs = by_scipy(scene, exact) if before is None else before
    for point in theirs:
        print(name, point, flush=True)
        points.append(point)
    return {
        "restraint": str(scene.system.restraint),
        "verdict": answer.attrs["verdict"],
        "peak": float(answer["peak_relative_rotation"]),
        "impacts": int(answer["impact_count"]),
        "events": int(answer.sizes["event"]),
        "disagreement": min(
            (point["error"] for point in points if point["program"] == "SciPy" and point["error"]),
            default=None,
        ),
        "points": points,
    }


def time_of_stepping_alone() -> dict:
    """Time SciPy's RK45 on equations without cost, with the least number of steps of both ways.

    This is the cost of SciPy's own Python code, without events and output.
    """
    excitation = motion()
    step, count = excitation.si.time_step, len(excitation) - 1
    nothing, start = np.zeros(8), np.ones(8)

    def run(starts: int, length: float) -> None:
        for i in range(starts):
            solver = stepper(
                lambda t, z: nothing, i * length, start, (i + 1) * length,
                max_step=SAMPLES_AT_ONCE * step, rtol=1e-3, atol=1e-6, method="RK45",
            )  # fmt: skip
            while solver.status == "running":
                solver.step()

    return {
        AT_SAMPLES: cost(lambda: run(count, step), 5),
        THROUGH: cost(lambda: run(1, count * step), 5),
    }


def stored() -> dict:
    """Read the stored measurements."""
    return json.loads(DATA.read_text()) if DATA.is_file() else {"scenes": {}}


def store(data: dict) -> None:
    """Write the data."""
    DATA.parent.mkdir(exist_ok=True)
    here = {name: value for name, value in machine().items() if value != "not installed"}
    data["machine"] = data.get("machine", {}) | here
    DATA.write_text(json.dumps(data, indent=1) + "\n")


def main(wanted: list[str]) -> None:
    """Measure the requested scenes, by default all."""
    if wanted == ["rockframe"]:
        data = stored()
        for name, found in data["scenes"].items():
            theirs = [point for point in found["points"] if point["program"] == "SciPy"]
            data["scenes"][name] = measure(name, theirs)
        store(data)
        return
    for name in wanted or [*scenes(), "opensees"]:
        if name == "opensees":
            from benchmarks.opensees_comparison import compare

            found = compare()
            store(stored() | {"opensees": found})
            continue
        found = measure(name)
        data = stored()
        data["stepping_alone"] = time_of_stepping_alone()
        data["scenes"][name] = found
        data["motion"] = {"description": repr(motion()), "output_step": OUTPUT_STEP}
        store(data)


if __name__ == "__main__":
    main(sys.argv[1:])
