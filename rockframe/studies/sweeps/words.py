"""A sweep in words: its verdict, its warnings, and the grouping of similar texts."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import ModelWarning, SolverWarning, warn
from rockframe.results.forces import count_slides
from rockframe.results.joining import CASE_COUNT
from rockframe.results.outcome import MIN_REPORTED_SLIP, PEAK_SLIPS, overturned_from_status
from rockframe.results.schema import with_variables
from rockframe.results.variables.runs import RunStatus
from rockframe.results.variables.studies import MESSAGE, REPEATED, VERDICT_CHANGED
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.run import NONE
from rockframe.studies.sweeps.axes import OWNER

SCREENING_VARIABLES: Final = (REPEATED, VERDICT_CHANGED)
"""Additional variables of the cases of a screened sweep."""
_BROKEN: Final = "broken_restrainer_count"
MAX_SIMILAR_TEXTS: Final = 16
"""Most texts differing only in their numbers that are reported one by one."""
_NUMBER: Final = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.]*\w)")


def cases_verdict(dataset: xr.Dataset) -> str:
    """Describe the outcomes of the cases of a dataset; for a whole result as in its attribute."""
    text, total = str(dataset.attrs.get("verdict", "")), dataset.attrs.get(CASE_COUNT)
    if total is None or "status" not in dataset:
        return text
    status = dataset["status"]
    count = status.size
    if status.dtype.kind not in "iu":
        if MESSAGE not in dataset or dataset[MESSAGE].dims != status.dims:  # such as a mean
            return text
        count = int(status.notnull().sum())  # `where` and `reindex` leave gaps
    if count == total:  # a lazily read dataset has no verdict before
        return text or whole_verdict(dataset)
    some = f"{count} of the {total} cases of the sweep"
    return cases_sentence(dataset, f"Of {some if count < total else f'{count} cases'}")


def whole_verdict(dataset: xr.Dataset) -> str:
    """Describe the outcomes of all cases of a sweep, in words that stay true for a part of it."""
    count = dataset["status"].size
    subject = "Of 1 case" if count == 1 else f"Of all {count} cases"
    return cases_sentence(dataset, f"{subject} of the sweep")


def cases_sentence(runs: xr.Dataset, subject: str) -> str:
    """Describe the outcomes of cases in one sentence, counted in parts that fit in memory."""
    counts, farthest = Counter[str](), 0.0
    for part in _stored_parts(runs):
        slips = slips_of_cases(part)
        farthest = slips.max(initial=farthest, where=slips > MIN_REPORTED_SLIP)
        counts.update(_counts(part, slips))
    text = f"{subject} {counts['overturned']} overturned and {counts['stood']} did not"
    if counts["would slide"] + counts["would hold"]:
        text += f"; {counts['would slide']} would slide and {counts['would hold']} would not"
    if counts["slid"]:
        text += f"; {counts['slid']} slid, by {farthest:.3g} m at most"
    if counts["broke"]:
        text += f"; in {counts['broke']} a restrainer broke"
    missing = counts["cases"] - counts["not run"] - counts["overturned"] - counts["stood"]
    if missing:
        text += f"; {missing} have no result"
    if counts["not run"]:
        text += f"; {counts['not run']} have not been run"
    if counts["screened"]:
        again = (
            f"{counts[REPEATED]} near a change of the verdict were run again with adaptive steps"
        )
        text += f"; {again}, which changed {counts[VERDICT_CHANGED]}"
    return f"{text}."


def _counts(runs: xr.Dataset, slips: AnyArray) -> dict[str, int]:
    """Count cases by outcome."""
    status = runs["status"].to_numpy()
    overturned = overturned_from_status(status)
    which: dict[str, Any] = {
        "overturned": overturned == 1.0,
        "stood": overturned == 0.0,
        "not run": status == RunStatus.NOT_RUN,
        "slid": slips > MIN_REPORTED_SLIP,
    }
    if _BROKEN in runs:
        which["broke"] = runs[_BROKEN] > 0
    if REPEATED in runs:
        which["screened"] = runs[REPEATED].notnull()
        which |= {name: runs[name] == 1.0 for name in SCREENING_VARIABLES}
    counts = {name: int(np.count_nonzero(some)) for name, some in which.items()}
    if "would_slide" in runs:
        slides = count_slides(runs["would_slide"].to_numpy())
        counts |= dict(zip(("would slide", "would hold"), slides, strict=True))
    return counts | {"cases": int(np.count_nonzero(~np.isnan(status)))}


def _stored_parts(runs: xr.Dataset) -> Iterator[xr.Dataset]:
    """Cut a dataset into the parts that are stored together."""
    status = runs["status"]
    lengths = status.encoding.get("preferred_chunks", {})
    cuts = [
        [slice(k, k + step) for k in range(0, size, step)]
        for size, step in ((n, lengths.get(dim) or max(n, 1)) for dim, n in status.sizes.items())
    ]
    for part in product(*cuts):
        yield runs.isel(dict(zip(status.dims, part, strict=True)))


def slips_of_cases(runs: xr.Dataset) -> AnyArray:
    """Return the largest slip of each case, over all bodies [m]."""
    most = np.full(runs["status"].shape, np.nan)
    for slips in (runs[name] for name in PEAK_SLIPS if name in runs):
        other_dims = [dim for dim in slips.dims if dim not in runs["status"].dims]
        most = np.fmax(most, slips.max(other_dims).to_numpy())
    return most


def mark_not_screened(runs: xr.Dataset) -> xr.Dataset:
    """Report that a sweep to be screened was run by tolerance, which costs less."""
    missing = np.isnan(runs["peak_rotation"].to_numpy())
    none = np.where(missing, np.nan, 0.0) if missing.any() else np.zeros(missing.shape)
    dims = tuple(map(str, runs["peak_rotation"].dims))
    text = str(runs.attrs["verdict"]).removesuffix(".")
    words = "all ran at 'standard', which costs less here than 'screen'"
    runs = with_variables(runs, dict.fromkeys(SCREENING_VARIABLES, none), over=dims)
    return runs.assign_attrs(verdict=f"{text}; {words}.")


def warn_of_missing_results(dataset: xr.Dataset, histories: Iterable[str]) -> None:
    """Warn of cases without a result, of cautions, and of histories that no scene has."""
    status = dataset["status"].to_numpy().ravel()
    message = dataset[MESSAGE].to_numpy().ravel()
    missing = np.isnan(dataset["peak_rotation"].to_numpy().ravel())
    not_run = status == RunStatus.NOT_RUN
    failed = missing & ~not_run
    for which, kind, words in (
        (failed, SolverWarning, "have no result"),
        (not_run, SolverWarning, "have not been run"),
        (~missing & (message != NONE), ModelWarning, "have a result to be careful with"),
    ):
        if which.any():
            text, number = _most_frequent(message[which].tolist())
            reason = "" if text == NONE else f"; message of {number} of them: {text}"
            count = f"{int(which.sum())} of {len(status)} cases"
            warn(f"{OWNER}: {count} {words} (status, message){reason}", kind)
    absent = [name for name in histories if name not in dataset]
    if absent and not missing.all():
        named = ", ".join(map(repr, absent))
        warn(f"{OWNER}: outputs names {named}, which no scene of the cases has", ModelWarning)


def _most_frequent(texts: Sequence[str]) -> tuple[str, int]:
    """Return the most frequent text and its count; texts that differ only in numbers are one."""
    alike: dict[tuple[str, ...], Counter[str]] = {}
    for text, count in Counter(texts).items():
        alike.setdefault(tuple(_NUMBER.split(text)), Counter())[text] = count
    words, counts = max(alike.items(), key=lambda item: item[1].total())
    return _text_with_ranges(words, counts), counts.total()


def merge_similar_texts(
    texts: Sequence[str], message: AnyArray
) -> tuple[tuple[str, ...], AnyArray]:
    """Report texts that differ only in their numbers as one, if there are more than a few."""
    alike: dict[tuple[str, ...], list[int]] = {}
    for place, text in enumerate(texts):
        alike.setdefault(tuple(_NUMBER.split(text)), []).append(place)
    merged: dict[str, int] = {}
    places = np.empty(len(texts), dtype=message.dtype)
    one_for = {
        place: _text_with_ranges(words, [texts[k] for k in several])
        for words, several in alike.items()
        if len(several) > MAX_SIMILAR_TEXTS
        for place in several
    }
    for place, text in enumerate(texts):
        places[place] = merged.setdefault(one_for.get(place, text), len(merged))
    return tuple(merged), places[message]


def _text_with_ranges(words: Sequence[str], texts: Iterable[str]) -> str:
    columns: Any = zip(*(_NUMBER.findall(text) for text in texts), strict=True)
    ranges = [sorted(set(column), key=float) for column in columns]
    spans = [
        numbers[0] if len(numbers) == 1 else f"{numbers[0]} to {numbers[-1]}" for numbers in ranges
    ]
    return words[0] + "".join(map("".join, zip(spans, words[1:], strict=True)))
