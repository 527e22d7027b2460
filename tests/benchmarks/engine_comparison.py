"""MuJoCo compared with rockframe on two pads: histories and costs.

``python tests/benchmarks/engine_comparison.py`` runs all cases, prints a table and writes
``docs/data/engines.json``; it takes half an hour, nearly all of it in MuJoCo. Parts of
names as arguments run the cases that contain them and leave the rest of the file as it is.

Each case runs in MuJoCo at four steps in two ways: fixed steps, and steps cut where contact
changes. Difference is the largest one of the rotation every 0.004 s over its peak, against
rockframe at a tolerance of 1e-12. Time is processor time of a whole run.
"""

import json
import math
import sys
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

import mujoco
import numpy as np
from benchmarks.engine_pads import Pads
from benchmarks.timing import cost, machine
from records import record_path

import rockframe as rf
from rockframe.errors import ModelWarning

DATA = Path(__file__).parents[2] / "docs" / "data" / "engines.json"
B, H, MASS, GRAVITY = 2.0, 9.0, 99e3, 9.80665
FREQUENCY_RATIO = 40.0
EXACT = rf.Accuracy(rtol=1e-12)
LEVELS = ("fast", "standard")
REPEATS = 5
OUTPUT_STEP = 4e-3
STEPS = (8e-4, 4e-4, 2e-4, 1e-4)
PULSE_LENGTH = 0.512
"""Length of the half sine [s], a whole number of the longest steps."""
RECORD = "ElCentro1940_Peknold.AT2"


@dataclass(frozen=True)
class Case:
    """A motion and its strength, the pads' damping ratio, the restraint rule, and a duration.

    ``size`` is the peak of the pulse in units of gravity, or the factor of the record;
    ``seconds`` is the duration, by default that of the record.
    """

    motion: str
    size: float
    damping_ratio: float
    restraint: str = "centre"
    seconds: float | None = None

    @property
    def length(self) -> float:
        """Length of the run [s]."""
        if self.seconds is not None:
            return self.seconds
        return 4.0 if self.motion == "half sine" else record().duration.m_as("s")


CASES = {
    "half sine, full contact": Case("half sine", 0.02, 0.10),
    "half sine, uplift, no dashpots": Case("half sine", 0.35, 0.0),
    "half sine, uplift": Case("half sine", 0.35, 0.10),
    "half sine, uplift, leading corner": Case("half sine", 0.35, 0.10, "leading-corner"),
    "half sine, uplift, contact state": Case("half sine", 0.35, 0.10, "contact-state"),
    "El Centro, full contact": Case("El Centro", 0.05, 0.10),
    "El Centro, uplift, no dashpots": Case("El Centro", 1.0, 0.0),
    "El Centro, uplift": Case("El Centro", 1.0, 0.10),
    "El Centro, uplift, strong dashpots": Case("El Centro", 3.0, 2.0, seconds=12.0),
    "El Centro, uplift, leading corner": Case("El Centro", 1.0, 0.10, "leading-corner"),
    "El Centro, uplift, contact state": Case("El Centro", 1.0, 0.10, "contact-state"),
    "El Centro, no dashpots, leading corner": Case("El Centro", 1.0, 0.0, "leading-corner"),
    "El Centro, no dashpots, contact state": Case("El Centro", 1.0, 0.0, "contact-state"),
}


@cache
def record() -> rf.GroundMotion:
    """Return the record of El Centro, 1940."""
    return rf.GroundMotion.read(record_path(RECORD))


def excitation(case: Case) -> tuple[rf.GroundMotion, Callable[[float], float]]:
    """Return the ground's acceleration as rockframe takes it, and as a function of time."""
    if case.motion == "half sine":
        peak = case.size * GRAVITY

        def pulse(time: float) -> float:
            inside = time < PULSE_LENGTH
            return peak * math.sin(math.pi * time / PULSE_LENGTH) if inside else 0.0

        return rf.GroundMotion.half_sine_pulse(f"{peak!r} m/s^2", f"{PULSE_LENGTH} s"), pulse
    motion = record().scaled(case.size)
    samples, step = [*motion.si.horizontal.samples.tolist(), 0.0], motion.si.time_step
    last = len(samples) - 2

    def between_samples(time: float) -> float:
        place = time / step
        before = min(int(place), last)
        return samples[before] + (place - before) * (samples[before + 1] - samples[before])

    return motion, between_samples


def by_rockframe(case: Case, accuracy: rf.Accuracy | str = EXACT):
    """Run a case in rockframe; a landing corner keeps its speed."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # restitution 1 is intended
        pads = rf.TwoSpringSupport(
            frequency_ratio=FREQUENCY_RATIO, damping_ratio=case.damping_ratio, restitution=1.0
        )
        block = rf.Block(width=f"{2 * B} m", height=f"{2 * H} m", mass=f"{MASS} kg")
        system = rf.System(block, pads, restraint=case.restraint)
        return system.simulate(
            excitation(case)[0],
            duration=f"{case.length!r} s",
            output_step=f"{OUTPUT_STEP} s",
            accuracy=accuracy,
        )


def by_engine(case: Case, step: float, *, meet_changes: bool) -> np.ndarray:
    """Run a case in MuJoCo; return the rotation at every output time."""
    vertical = FREQUENCY_RATIO * math.sqrt(0.75 * GRAVITY / math.hypot(B, H))
    pads = Pads(
        half_width=B,
        half_height=H,
        mass=MASS,
        inertia=MASS * (B**2 + H**2) / 3.0,
        stiffness=0.5 * MASS * vertical**2,
        damping=case.damping_ratio * MASS * vertical,
        gravity=GRAVITY,
        acceleration=excitation(case)[1],
        step=step,
        restraint=case.restraint,
        meet_changes=meet_changes,
    )
    return pads.run(round(case.length / OUTPUT_STEP), round(OUTPUT_STEP / step))


def difference(found: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest difference of two histories over the peak."""
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def order(differences: list[float]) -> list[float]:
    """Return the order of each halving of the step."""
    return [math.log2(a / b) for a, b in pairwise(differences)]


def measure(case: Case) -> dict:
    """Run a case in both programs; return differences and times."""
    answer = by_rockframe(case)
    exact = answer["rotation"].to_numpy()
    kinds = answer["event_kind"]
    back = kinds.attrs["flag_meanings"].split().index("reengagement")
    points = []
    for level in LEVELS:
        found = by_rockframe(case, level)["rotation"].to_numpy()
        spent = cost(lambda level=level: by_rockframe(case, level), REPEATS)
        row = {"program": "rockframe", "setting": level}
        points.append(row | {"difference": difference(found, exact), "time": spent})
    for meet_changes in (False, True):
        for step in STEPS:
            found = []

            def run(step=step, meet_changes=meet_changes, found=found) -> None:
                found.append(by_engine(case, step, meet_changes=meet_changes))

            spent = cost(run, 1)
            row = {"program": "MuJoCo", "step": step, "meet_changes": meet_changes}
            points.append(row | {"difference": difference(found[0], exact), "time": spent})
    return {
        "motion": case.motion,
        "size": case.size,
        "damping_ratio": case.damping_ratio,
        "restraint": case.restraint,
        "length": case.length,
        "peak": float(answer["peak_relative_rotation"]),
        "impacts": int(answer["impact_count"]),
        "returns": int((kinds == kinds.attrs["flag_values"][back]).sum()),
        "flights": int(answer["flight_count"]),
        "flight_time": float(answer["flight_time"]),
        "points": points,
    }


def lines(name: str, found: dict) -> Iterator[str]:
    """Return the rows of a case in the table."""
    yield (
        f"{name}: peak {found['peak']:.4f} of the overturning angle, {found['impacts']} impacts, "
        f"{found['returns']} returns without one, {found['flights']} flights of together "
        f"{found['flight_time']:.3g} s"
    )
    for point in found["points"]:
        if point["program"] == "rockframe":
            yield (
                f"  rockframe {point['setting']}: {point['difference']:.0e}, "
                f"{1e3 * point['time']:.1f} ms"
            )
    for meet_changes, way in ((False, "as they fall"), (True, "cut at changes")):
        row = [one for one in found["points"] if one.get("meet_changes") is meet_changes]
        cells = (
            f"{1e3 * one['step']:g} ms {one['difference']:.1e} {one['time']:.1f} s" for one in row
        )
        orders = " ".join(f"{one:.1f}" for one in order([one["difference"] for one in row]))
        yield f"  MuJoCo, steps {way}: {'; '.join(cells)}; order {orders}"


def main(wanted: list[str]) -> None:
    """Run the requested cases, by default all."""
    for name, case in CASES.items():
        if wanted and not any(part in name for part in wanted):
            continue
        found = measure(case)
        print(*lines(name, found), sep="\n", flush=True)
        data = json.loads(DATA.read_text()) if DATA.is_file() else {"cases": {}}
        here = {key: value for key, value in machine().items() if value != "not installed"}
        data["machine"] = here | {"mujoco": mujoco.__version__}
        data["output_step"] = OUTPUT_STEP
        data["cases"][name] = found
        data["cases"] = {one: data["cases"][one] for one in CASES if one in data["cases"]}
        DATA.write_text(json.dumps(data, indent=1) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
