"""Print the table of missed flips on the page "Critical scale".

From the root of the repository: ``python tests/benchmarks/critical_scales.py``. Dense scans, of
`DENSE` scales up to `LARGEST`, are the reference; scans with fewer runs read their runs from them.
Records are omitted where the folder of records is missing.
"""

import math
import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks.certified_scenes import cases
from records import records_folder

import rockframe as rf
from rockframe.errors import RockframeWarning
from rockframe.signals.motion import absolute_peak
from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.simulation.plan import plan_run
from rockframe.simulation.run import compute_summary
from rockframe.studies.flips import scan_scales

DENSE = 2048
LARGEST = 4.0
WIDTH = 1e-3
STRATEGIES = ((80, 80), (160, 160), (320, 320), (640, 640), (80, 200), (80, 400), (80, 800))
RECORDS = (
    "ElCentro1940_Peknold.AT2",
    "RSN763_LOMAP_GIL067.AT2",
    "PEERSMD_CHICHI_TCU128-N.AT2",
    "NIS090.AT2",
)
PULSES = ((2, 1.0), (4, 1.0), (6, 1.0), (3, 2.5), (5, 4.0))
"""Frequency over the block's, and cycles."""
PADS = rf.TwoSpringSupport(frequency_ratio=30, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)


def systems(*, on_soil: bool) -> Iterator[tuple[rf.System, float]]:
    """Return blocks on rigid ground, pads and soil, with their frequency."""
    for radius in (1.0, 2.5):
        block = rf.Block.from_size(radius=f"{radius} m", slenderness=4, mass="50 t")
        bases = [(), (PADS,), (SOIL,)] if on_soil and radius == 1.0 else [(), (PADS,)]
        for base in bases:
            yield rf.System(block, *base), block.si.frequency_at(9.80665)


def scenes() -> Iterator[tuple[str, rf.System, rf.GroundMotion]]:
    """Return all scenes by their kind."""
    for name in RECORDS:
        path = records_folder() / name
        if path.is_file():
            motion = rf.GroundMotion.read(path).scaled(peak="4 m/s^2")
            for system, _ in systems(on_soil=True):
                yield "records", system, motion
    for system, frequency in systems(on_soil=False):
        for ratio, cycles in PULSES:
            hertz = f"{ratio * frequency / (2.0 * math.pi)!r} Hz"
            yield (
                "sines",
                system,
                rf.GroundMotion.sine_pulse(f"{1.47 * ratio} m/s^2", hertz, cycles),
            )
    for case in cases(24):
        yield "random", case.system, case.motion


@dataclass(frozen=True)
class Dense:
    """All runs of a scene, and the index of the run at uplift."""

    kind: str
    runs: list[RunSummary]
    start: int

    @property
    def first(self) -> int:
        """Index of the first run that overturns."""
        return [run.overturned for run in self.runs].index(True)

    def flips(self) -> set[int]:
        """Return the indices of runs after which the verdict changes."""
        pairs = enumerate(pairwise(self.runs))
        return {k for k, (one, other) in pairs if one.overturned != other.overturned}


def dense(kind: str, system: rf.System, motion: rf.GroundMotion) -> Dense:
    """Run at all scales."""
    plan = plan_run(
        system.assembly, motion, duration=None, free_vibration="10 s", initial=None,
        accuracy="standard", output_step=None, outputs=None, overturning="stop",
    )  # fmt: skip
    scales = LARGEST * np.arange(DENSE + 1) / DENSE
    runs = [
        compute_summary(system.assembly, replace(plan, motion=motion.scaled(scale)))
        for scale in scales.tolist()
    ]
    start = 0
    if not system.parts.signature & {"pads", "soil"} and motion.si.vertical is None:
        uplift = system.setting.uplift_acceleration / absolute_peak(motion.si.horizontal.pieces)
        start = int(uplift / LARGEST * DENSE)
    return Dense(kind, runs, start)


def scan(truth: Dense, scales: int, most: int) -> tuple[int, float, int, bool]:
    """Return flips found, delay of the first one, number of runs, and largest scale scanned."""
    row = np.unique(np.round(np.linspace(truth.start, DENSE, scales))).tolist()
    found = scan_scales(lambda place: truth.runs[round(place)], row, max_runs=most, width=WIDTH)
    brackets = [(flip.below - 1.0, flip.above + 1.0) for flip in found.flips()]
    hits = sum(any(low <= k < high for low, high in brackets) for k in truth.flips())
    first = next((place for place, run in found.runs.items() if run.overturned), math.inf)
    late = max(0.0, (first - truth.first - 1.0) / max(truth.first, 1))
    return (
        hits,
        0.0 if late <= WIDTH else late,
        len(found.runs),
        found.resolved_up_to >= truth.first,
    )


def main() -> None:
    """Print the table."""
    warnings.simplefilter("ignore", RockframeWarning)
    known = [dense(*scene) for scene in scenes()]
    known = [one for one in known if any(run.overturned for run in one.runs)]
    print(
        "scenes | first scales, runs | flips found | least scale found | latest | runs | followed"
    )
    for kind in dict.fromkeys(one.kind for one in known):
        group = [one for one in known if one.kind == kind]
        flips = sum(len(one.flips()) for one in group)
        for scales, most in STRATEGIES:
            rows = [scan(one, scales, most) for one in group]
            right = sum(late == 0.0 for _, late, _, _ in rows)
            followed = [late == 0.0 for _, late, _, far in rows if far]
            print(
                f"{kind} | {scales}, {most} | {sum(hits for hits, *_ in rows)} of {flips} | "
                f"{right} of {len(group)} | {100.0 * max(late for _, late, _, _ in rows):.1f} % | "
                f"{np.mean([runs for _, _, runs, _ in rows]):.0f} | "
                f"{sum(followed)} of {len(followed)}",
                flush=True,
            )


if __name__ == "__main__":
    main()
