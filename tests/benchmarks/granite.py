"""Write the tables and the numbers of the page "Granite blocks on a shake table".

From the root of the repository: ``python tests/benchmarks/granite.py docs``. The tests are read
from the file named by ``ROCKFRAME_GRANITE``. Running the blocks takes a quarter of an hour; with
``--verdicts`` their verdicts are stored in a file and read from it the next time.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks import granite_fit as fit
from benchmarks import granite_tables as tables
from benchmarks.granite_bench import Bench, Study
from benchmarks.granite_blocks import pairs, verdicts
from benchmarks.granite_programme import SPECIMENS, programme_path, read_programme

from rockframe.errors import RockframeWarning


def run_blocks(bench: Bench, cache: Path | None) -> np.ndarray:
    """Run all blocks with all motions, or read their verdicts, shape (pairs, angles, tests)."""
    if cache is not None and cache.is_file():
        return np.load(cache)
    overturned = np.array([verdicts(pair, bench.shakings) for pair in pairs().tolist()])
    if cache is not None:
        np.save(cache, overturned)
    return overturned


def main() -> None:
    """Run blocks, fit, score and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="of the manual")
    parser.add_argument("--tests", type=Path, default=programme_path())
    parser.add_argument("--verdicts", type=Path, help="file (.npy) of the blocks' verdicts")
    options = parser.parse_args()
    warnings.simplefilter("ignore", RockframeWarning)
    bench = Bench.of(read_programme(options.tests))
    overturned = run_blocks(bench, options.verdicts)
    studies = {}
    for one in SPECIMENS:
        fell = bench.programme.fell[one]
        search = fit.Search.of(pairs(), overturned, bench.groups, fell)
        studies[one] = Study.of(bench, search, fell)
    report = tables.Report()
    tables.fits(bench, studies, report)
    tables.regressions(bench, studies, report)
    tables.confusion(bench, studies, report)
    tables.probabilities(bench, studies, report)
    tables.calibration(studies, report)
    tables.errors(bench, studies, report)
    tables.bands(options.tests, bench, studies, report)
    tables.accuracy(bench, studies, report)
    report.write(options.folder)


if __name__ == "__main__":
    main()
