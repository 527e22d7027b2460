"""Print the tables of certificates on the page "Speed against accuracy".

From the root of the repository: ``python tests/benchmarks/certificates.py --scenes 300``.
Scenes: :mod:`benchmarks.certified_scenes`.
"""

import argparse
import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks.certified_scenes import Case, cases

import rockframe as rf
from rockframe.errors import RockframeWarning
from rockframe.simulation.certify.perturbations import divide_intervals, parameters
from rockframe.simulation.run import compute_response

DISTANCES = tuple(10.0**-k for k in range(2, 8))
NUDGES = 12
SCALES = 1501
REACH = 0.5
TRUTH = rf.Accuracy(rtol=1e-13, steps_per_period=150.0)
TRUTH_CUT = 16
ROUNDING = 1e-12
"""Share of the overturning angle below which an error of a peak is rounding."""


def clean(run) -> bool:
    """Whether a certificate vouches for the verdict."""
    return bool(run.verdict_converged) and bool(run.verdict_robust)


def strength(case: Case) -> float:
    """Return a scale at a given distance from the boundary, to either side."""
    return float(np.random.default_rng([7, case.number]).uniform(0.6, 1.6))


def contradictions(case: Case, scale: float, fell: bool, count: int = NUDGES) -> int:
    """Count contradictions by random nudges within the stated margins, and by a tight run."""
    rng = np.random.default_rng([11, case.number])
    every = list(parameters(case.system.assembly))
    plan = case.plan(scale)
    total = int(case.summary(scale, TRUTH.__class__(rtol=1e-13)).overturned != fell)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RockframeWarning)
        for _ in range(count):
            _, scene_at = every[int(rng.integers(len(every)))]
            scene = scene_at(float(rng.uniform(-1e-3, 1e-3)))
            total += (
                scene is not None and compute_response(scene, plan).trajectory.overturned != fell
            )
    return total


@dataclass
class Row:
    """Counts at one distance from the boundary."""

    scenes: int = 0
    clean: int = 0
    contradicted: int = 0


def at_the_boundary(pool: Iterator[Case]) -> Iterator[tuple[float, Row]]:
    """Certify near the boundary; count clean certificates and their contradictions."""
    rows = {distance: Row() for distance in DISTANCES}
    for number, case in enumerate(pool):
        distance = DISTANCES[number % len(DISTANCES)]
        scale = 1.0 + (distance if (number // len(DISTANCES)) % 2 else -distance)
        run = case.certified(scale)
        row = rows[distance]
        row.scenes += 1
        if clean(run):
            row.clean += 1
            row.contradicted += contradictions(case, scale, bool(run.overturned)) > 0
    yield from rows.items()


def verdicts(case: Case, scale: float) -> np.ndarray:
    """Return the verdicts of a dense scan over the reach; -1 where a run is not finished."""
    changes = np.linspace(-REACH, REACH, SCALES)
    verdicts_found = [case.summary(scale * (1.0 + change)).overturned for change in changes]
    return np.array([-1 if fell is None else int(fell) for fell in verdicts_found])


def true_margin(fell: bool, scanned: np.ndarray) -> float:
    """Return the distance of the nearest other verdict of a dense scan."""
    changes = np.abs(np.linspace(-REACH, REACH, SCALES))
    return float(changes[scanned != int(fell)].min(initial=REACH))


def peak_error(case: Case, scale: float, run) -> tuple[float, float]:
    """Return the error of a peak, and its estimate, over the overturning angle."""
    motion = divide_intervals(case.motion, TRUTH_CUT) if case.base == "cascade" else case.motion
    exact = case.summary(scale, TRUTH, motion)
    theta = float(run.overturning_angle)
    error = abs(exact.peak_rotation - float(run.peak_rotation)) / theta
    return error, float(run.peak_error_estimate) / theta


def flattered(error: float, estimate: float) -> bool:
    """Whether an estimate is more than ten times too small."""
    return error > 10.0 * estimate and error > ROUNDING


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=300)
    count = parser.parse_args().scenes
    print("distance | scenes | clean | contradicted")
    for distance, row in at_the_boundary(cases(count)):
        print(f"{distance:.0e} | {row.scenes} | {row.clean} | {row.contradicted}")
    total = true = nudged = peaks = flattering = 0
    runs, shares = [], []
    for case in cases(count):
        scale = strength(case)
        run = case.certified(scale)
        runs.append(run.attrs["certificate_runs"])
        fell = bool(run.overturned)
        if not fell:
            peaks += 1
            flattering += flattered(*peak_error(case, scale, run))
        if clean(run):
            margin, nearest = float(run.verdict_margin), true_margin(fell, verdicts(case, scale))
            total += 1
            true += nearest >= margin * (1.0 - 1e-12)
            shares.append(margin / nearest)
            nudged += contradictions(case, scale, fell) > 0
    print(f"scenes {count}, clean {total}, margins true {true}, contradicted by nudges {nudged}")
    quantiles = ", ".join(f"{q:.2f}" for q in np.quantile(shares, (0.1, 0.25, 0.5)))
    print(f"margin over the distance scanned, 10 %, 25 %, 50 % of the scenes: {quantiles}")
    print(f"peaks {peaks}, estimates more than ten times too small {flattering}")
    print(f"runs of a certificate: mean {np.mean(runs):.0f}, most {max(runs)}")


if __name__ == "__main__":
    main()
