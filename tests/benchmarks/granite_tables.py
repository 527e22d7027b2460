"""The tables of the page "Granite blocks on a shake table", and the numbers of its figures."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from benchmarks import granite_fit as fit
from benchmarks.granite_bench import Bench, Study
from benchmarks.granite_blocks import Shaking, block_of, overturns
from benchmarks.granite_programme import BAND, read_programme
from scipy.stats import spearmanr

from rockframe.constants import STANDARD_GRAVITY

EDGES = np.array([0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0])
BANDS = {
    "0.1 to 25 Hz": BAND,
    "0.05 to 25 Hz": {"low": "0.05 Hz", "high": "25 Hz"},
    "0.2 to 25 Hz": {"low": "0.2 Hz", "high": "25 Hz"},
    "0.1 Hz and above": {"low": "0.1 Hz"},
    "as recorded": None,
}
Studies = dict[int, Study]


class Report:
    """Collects tables, each between two marks, and the numbers of the figures."""

    def __init__(self) -> None:
        self.text = ""
        self.numbers: dict[str, object] = {}

    def add(self, mark: str, head: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
        """Add a table and print it."""
        lines = [head, ("---",) * len(head), *rows]
        part = "".join(f"| {' | '.join(line)} |\n" for line in lines)
        print(f"{mark}\n{part}", flush=True)
        self.text += f"<!-- {mark} -->\n\n{part}\n<!-- end of {mark} -->\n\n"

    def write(self, folder: Path) -> None:
        """Write the tables and the numbers."""
        (folder / "validation_granite.txt").write_text(self.text.rstrip() + "\n", encoding="utf-8")
        text = json.dumps(self.numbers, indent=1)
        (folder / "data" / "granite.json").write_text(text + "\n", encoding="utf-8")


def between(low: float, high: float) -> str:
    """Format an interval."""
    return f"{low:.3f} to {high:.3f}"


def scored(
    score: fit.Score, predicted: np.ndarray, fell: np.ndarray, drawn: list[np.ndarray]
) -> str:
    """Format a score and its interval."""
    low, high = fit.interval(score, predicted, fell, drawn)
    return f"{score(predicted, fell):.3f} ({between(low, high)})"


def fits(bench: Bench, studies: Studies, report: Report) -> None:
    """Report the fitted blocks and their uncertainty."""
    rows, kept = [], {}
    names = {"radius": "$R_0$ [m]", "angle": r"$\theta$ [rad]", "restitution": r"$\varepsilon$"}
    for specimen, study in studies.items():
        search = study.search
        best, ensemble = search.best(), search.ensemble()
        others = [search.best(motion) for motion in bench.motions]
        for field, name in names.items():
            folds = [getattr(one.shape, field) for one in others]
            drawn = np.quantile([getattr(one, field) for one in ensemble], [0.05, 0.95])
            value = getattr(best.shape, field)
            folded = between(min(folds), max(folds))
            rows.append((str(specimen), name, f"{value:.3f}", folded, between(*drawn)))
        spreads = [one.spread for one in others]
        folded = between(min(spreads), max(spreads))
        rows.append((str(specimen), "$s$", f"{best.spread:.3f}", folded, ""))
        block = block_of(best.shape).parts.block
        greatest = f"{block.maximum_restitution:.3f}"
        rows.append((str(specimen), r"$\varepsilon_{max}$, Eq. (4)", greatest, "", ""))
        losses = -search.without(None).max(axis=(1, 2)) / len(bench.groups)
        kept[str(specimen)] = {
            "shape": best.shape._asdict(),
            "ensemble": [list(one) for one in ensemble],
            "log_loss_of_pairs": losses.round(4).tolist(),
        }
        report.numbers["pairs"] = search.pairs.round(5).tolist()
    report.numbers["specimens"] = kept
    head = (
        "specimen",
        "",
        "fitted",
        "least and greatest without one motion",
        "5 to 95 %, ensemble",
    )
    report.add("fits", head, rows)


def regressions(bench: Bench, studies: Studies, report: Report) -> None:
    """Report the coefficients of the regressions."""
    rows = []
    for specimen, study in studies.items():
        coefficients = fit.regression(bench.features, study.fell)
        rows.append((str(specimen), *(f"{one:.3f}" for one in coefficients)))
    report.add("regressions", ("specimen", "$b_0$", "$b_1$", "$b_2$"), rows)


def confusion(bench: Bench, studies: Studies, report: Report) -> None:
    """Report how many verdicts were right."""
    rows = []
    every: dict[str, list[np.ndarray]] = {}
    for specimen, study in studies.items():
        said = {
            "block, all tests": study.seen.said,
            "block, held out": study.held_out.said,
            "ensemble, held out": study.held_out.ensemble > 0.5,
            "regression, all tests": study.seen.regressed > 0.5,
            "regression, held out": study.held_out.regressed > 0.5,
        }
        for name, verdict in said.items():
            every.setdefault(name, []).append(verdict)
            rows.append(_confusion_row(str(specimen), name, verdict, study.fell, bench.drawn))
    fell = np.concatenate([study.fell for study in studies.values()])
    drawn = [np.concatenate([tests, tests + len(bench.groups)]) for tests in bench.drawn]
    both = {name: np.concatenate(verdicts) for name, verdicts in every.items()}
    rows += [_confusion_row("both", name, said, fell, drawn) for name, said in both.items()]
    head = (
        "specimen", "by", "fell, as predicted", "fell, predicted to stand",
        "stood, predicted to fall", "stood, as predicted", "accuracy", "balanced accuracy",
    )  # fmt: skip
    report.add("confusion", head, rows)
    held = [f"{name}, held out" for name in ("block", "ensemble", "regression")]
    rows = [
        (
            name, f"{fit.accuracy(both[name], fell) - fit.accuracy(both[held[2]], fell):.3f}",
            between(*fit.interval(fit.accuracy, both[name], fell, drawn, both[held[2]])),
        )
        for name in held[:2]
    ]  # fmt: skip
    report.add("leads", ("both specimens", "accuracy less the regression's", "95 %"), rows)


def _confusion_row(
    specimen: str, name: str, said: np.ndarray, fell: np.ndarray, drawn: list[np.ndarray]
) -> tuple[str, ...]:
    scores = (scored(one, said, fell, drawn) for one in (fit.accuracy, fit.balanced_accuracy))
    return specimen, name, *map(str, fit.Confusion.of(said, fell)), *scores


def probabilities(bench: Bench, studies: Studies, report: Report) -> None:
    """Report scores of the probabilities of held-out tests."""
    rows = []
    scores = (fit.log_loss, fit.brier)
    for specimen, study in studies.items():
        held, fell = study.held_out, study.fell
        chances = {
            "block with scatter": held.chances,
            "ensemble": held.of_ensemble,
            "regression": held.regressed,
            "share of the others that fell": bench.share_of_others(fell),
        }
        for name, one in chances.items():
            cells = (scored(score, one, fell, bench.drawn) for score in scores)
            rows.append((str(specimen), name, *cells))
        for name in ("block with scatter", "ensemble"):
            less = (
                between(*fit.interval(score, chances[name], fell, bench.drawn, held.regressed))
                for score in scores
            )
            rows.append((str(specimen), f"{name} less regression", *less))
    report.add("probabilities", ("specimen", "by", "log-loss", "Brier score"), rows)


def calibration(studies: Studies, report: Report) -> None:
    """Report predicted and observed shares of fallen specimens in held-out tests."""
    fell = np.concatenate([study.fell for study in studies.values()])
    rows = []
    for name, words in (("ensemble", "ensemble"), ("regressed", "regression")):
        chances = [getattr(study.held_out, name) for study in studies.values()]
        bins = fit.calibration(np.concatenate(chances), fell, EDGES)
        report.numbers[name] = [one._asdict() for one in bins]
        rows += [
            (
                words, str(one.tests), f"{one.predicted:.3f}", str(one.fell),
                f"{one.observed:.3f}", between(one.low, one.high),
            )
            for one in bins
        ]  # fmt: skip
    head = ("by", "tests", "predicted share", "fell", "observed share", "95 %")
    report.add("calibration", head, rows)


def errors(bench: Bench, studies: Studies, report: Report) -> None:
    """Report the wrong verdicts on held-out tests."""
    rows = []
    for specimen, study in studies.items():
        held, fell = study.held_out, study.fell
        wrong = held.said != fell
        angle = study.search.best().shape.angle
        unlifted = fell & (bench.peak <= STANDARD_GRAVITY * math.tan(angle))
        motions, counts = np.unique(bench.programme.names[wrong], return_counts=True)
        order = np.argsort(-counts, kind="stable")[:3]
        worst = ", ".join(f"{motions[k].split('_')[0]} ({counts[k]})" for k in order)
        counted = (
            wrong.sum(), ((held.regressed > 0.5) != fell).sum(),
            fit.fewest_errors(bench.peak, bench.groups, fell), unlifted.sum(),
        )  # fmt: skip
        trend = spearmanr(bench.programme.numbers, fell - held.ensemble)
        told = f"{trend.statistic:.2f} ({trend.pvalue:.2f})"
        rows.append((str(specimen), *map(str, counted), told, worst))
    head = (
        "specimen", "block, held out", "regression, held out",
        "bound on the PGA for each motion, with hindsight",
        r"fell though PGA $\le g\tan\theta$",
        "rank correlation of number and residual ($p$)", "most errors of the block",
    )  # fmt: skip
    report.add("errors", head, rows)


def bands(path: Path, bench: Bench, studies: Studies, report: Report) -> None:
    """Report how verdicts depend on the band of the recordings, without a new fit of the blocks."""
    rows = []
    for name, band in BANDS.items():
        other = bench if band is BAND else Bench.of(read_programme(path, band))
        cells = []
        for study in studies.values():
            said = overturns(study.search.best().shape, other.shakings)
            regressed = other.regressed(study.fell) > 0.5
            cells += [
                str((said != study.seen.said).sum()),
                f"{fit.accuracy(said, study.fell):.3f}",
                f"{fit.accuracy(regressed, study.fell):.3f}",
            ]
        rows.append((name, *cells))
    head = ["band"]
    for one in studies:
        head += [f"specimen {one}: verdicts changed", "accuracy", "regression, held out"]
    report.add("bands", head, rows)


def accuracy(bench: Bench, studies: Studies, report: Report) -> None:
    """Report how many verdicts change with the accuracy of the runs."""
    finer = [Shaking.by(motion, "standard") for motion in bench.programme.motions]
    rows = []
    for specimen, study in studies.items():
        drawn = study.search.ensemble()
        changed = [(overturns(s, finer) != overturns(s, bench.shakings)).sum() for s in drawn]
        own = (overturns(study.search.best().shape, finer) != study.seen.said).sum()
        runs = len(drawn) * len(finer)
        rows.append((str(specimen), f"{own} of {len(finer)}", f"{sum(changed)} of {runs}"))
    report.add("accuracy", ("specimen", "fitted block", "ensemble"), rows)
