"""The dataset of a sweep: its cases, as far as they have been run, with labels and in words."""

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import read_attribute
from rockframe.errors import ModelWarning, SolverWarning, warn
from rockframe.results.forces import count_slides
from rockframe.results.joining import CASE_COUNT
from rockframe.results.outcome import MIN_REPORTED_SLIP, PEAK_SLIPS, overturned_from_status
from rockframe.results.points import BodyPoint, point_labels
from rockframe.results.schema import (
    SCHEMA,
    build_dataset,
    labels_in_unit,
    with_variables,
    without_fill_values,
)
from rockframe.results.variables.bodies import BODY, RESTRAINER
from rockframe.results.variables.requests import POINT_PEAKS
from rockframe.results.variables.runs import EVENTS_AND_SCALARS, RunStatus
from rockframe.results.variables.studies import (
    CASE,
    CAUTIONS,
    MESSAGE,
    MOTION,
    REPEATED,
    VERDICT_CHANGED,
)
from rockframe.results.variables.variable import TIME
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.run import NONE
from rockframe.studies.sweeps.axes import OWNER, Grid
from rockframe.studies.sweeps.chunk import DRIVER, SCREEN, CaseResults, CollectedResults, Driver
from rockframe.studies.sweeps.scenes import SystemScene
from rockframe.studies.sweeps.study import Histories, Study

COMMON_SCALARS: Final = tuple(
    row.name for row in EVENTS_AND_SCALARS if not row.dims and row.name != "status"
)
"""Scalars that every run has."""
ALONE: Final = "each case alone"
SIDE_BY_SIDE: Final = (
    "cases side by side in lanes; alone those that are not finished, or whose energies, friction "
    "or ground need a closer look"
)
"""How cases were run."""


@dataclass(frozen=True, eq=False)
class SweepLabels:
    """All that describes a sweep except its results."""

    grid: Grid  # the cases
    motions: tuple[str, ...]  # names
    histories: Histories | None  # what is kept beside scalars
    points: tuple[BodyPoint, ...]  # at which there are peaks, and histories if they are kept
    attributes: Mapping[str, str | float | int]  # of the dataset


def sweep_labels(study: Study) -> SweepLabels:
    """Return the labels of a sweep."""
    arguments = study.arguments
    scene, grid = study.scene, study.grid
    attributes: dict[str, str | float | int] = {
        "accuracy": SCREEN if study.screened else arguments.accuracy_name,
        "run_json": json.dumps(arguments.to_dict()),
        "axes_json": json.dumps([axis.to_dict() for axis in (*grid.axes, *grid.columns)]),
        "motions_json": json.dumps(
            [None if motion is None else motion.to_dict() for motion in study.motions.values()]
        ),
        "motion_names": json.dumps(list(study.motions)),
        "study_sha256": study.digest,
    }
    if names := study.restrainers:
        attributes["restrainer_names"] = json.dumps(names)
    if study.period is not None:
        attributes["spectral_period"] = study.period
    if isinstance(scene, SystemScene):
        attributes["model"] = scene.assembly.setting.model
        attributes["system_json"] = scene.assembly.json
    else:
        attributes["function"] = scene.name
    return SweepLabels(grid, tuple(study.motions), study.histories, arguments.points, attributes)


def sweep_dataset(labels: SweepLabels, results: Iterable[tuple[range, CaseResults]]) -> xr.Dataset:
    """Label the results."""
    grid = labels.grid
    collected = CollectedResults(grid.count)  # in the order of running, with gaps
    for cases, part in results:
        collected.put_rows(slice(cases.start, cases.stop), part)
    rows = collected.rows()
    few, message = merge_similar_texts(rows.texts, rows.message)
    gaps = np.full((grid.count, len(labels.points)), np.nan)
    scalars = {
        name: gaps if SCHEMA[name].dims else np.full(grid.count, np.nan)
        for name in scalar_names(labels)
    }
    driver = _driver_words(rows.scalars.get(DRIVER, np.empty(0)))
    scalars |= rows.scalars
    rows.scalars.clear()  # arranged values need not be in memory twice
    values = {
        name: grid.in_dimension_order(scalars.pop(name)) for name in SCHEMA if name in scalars
    }
    values["status"] = grid.in_dimension_order(rows.status)
    # as objects, each text is stored once
    texts = np.array(few, dtype=object)[grid.in_dimension_order(message)]
    messages = xr.Variable(tuple(grid.sizes), texts, SCHEMA[MESSAGE].attributes())
    runs = build_dataset(values, {}, over=tuple(grid.sizes))
    attributes = {
        "verdict": whole_verdict(runs),
        CASE_COUNT: grid.count,
        "driver": driver,
        **labels.attributes,
    }
    dataset = dataset_without_results(labels, attributes).assign(runs.data_vars)
    if rows.histories:
        histories = {
            name: grid.in_dimension_order(rows.histories.pop(name))
            for name in SCHEMA
            if name in rows.histories
        }
        dataset = with_variables(dataset, histories, over=tuple(grid.sizes))
    return with_coordinates(dataset, labels, messages)


def scalar_names(labels: SweepLabels) -> tuple[str, ...]:
    """Return scalars, and peaks at points, that all cases have, also before any has been run."""
    screened = SCREENING_VARIABLES if labels.attributes["accuracy"] == SCREEN else ()
    peaks = tuple(row.name for row in POINT_PEAKS) if labels.points else ()
    return COMMON_SCALARS + screened + peaks


def dataset_without_results(
    labels: SweepLabels, attributes: Mapping[str, str | float | int]
) -> xr.Dataset:
    """Return the dataset of a sweep without its results."""
    sizes = labels.grid.sizes
    around: dict[str, Any] = {}
    if MOTION in sizes:
        around[MOTION] = np.array(labels.motions, dtype=object)
    if CASE in sizes:
        around[CASE] = np.arange(sizes[CASE])
    if labels.histories is not None:
        around[TIME[0]] = labels.histories.step * np.arange(labels.histories.count)
    if labels.points:
        around |= point_labels(labels.points)
    return build_dataset(around, attributes, title="Sweep of a rocking system")


def with_coordinates(dataset: xr.Dataset, labels: SweepLabels, message: xr.Variable) -> xr.Dataset:
    """Add the axes, and the messages of the cases."""
    grid, axes = labels.grid, dict[str, xr.Variable]()
    for axis in (*grid.axes, *grid.columns):
        words = axis.values.dtype.kind == "U"
        values = axis.values.astype(object) if words else axis.values
        dim = axis.name if axis in grid.axes else CASE
        axes[axis.name] = xr.Variable(dim, values, axis.attributes())
    if grid.motion_column is not None:
        names = np.array(labels.motions, dtype=object)[grid.motion_column]
        axes[MOTION] = xr.Variable(CASE, names, SCHEMA[MOTION].attributes())
    dataset = dataset.assign_coords({**axes, MESSAGE: message})
    # the numbers of bodies, and the names of restrainers, that results are of
    coordinates: dict[str, Any] = {}
    if (count := dataset.sizes.get(BODY[0])) is not None:
        coordinates[BODY[0]] = 1 + np.arange(count)
    if (count := dataset.sizes.get(RESTRAINER[0])) is not None:
        names = json.loads(str(labels.attributes.get("restrainer_names", "[]")))
        if len(names) != count:
            names = [str(k + 1) for k in range(count)]
        coordinates[RESTRAINER[0]] = np.array(names, dtype=object)
    return without_fill_values(with_variables(dataset, coordinates))


def _driver_words(drivers: AnyArray) -> str:
    """Say how cases were run, from a `Driver` for each; NaN for those without a result."""
    words = SIDE_BY_SIDE if (drivers == Driver.IN_LANES).any() else ALONE
    as_python = int((drivers == Driver.AS_PYTHON).sum())
    if not as_python:
        return words
    which = "" if as_python == int(np.isfinite(drivers).sum()) else f" {as_python} of them"
    return f"{words},{which} in plain Python"


SCREENING_VARIABLES: Final = (REPEATED, VERDICT_CHANGED)
"""Additional variables of the cases of a screened sweep."""
_BROKEN: Final = "broken_restrainer_count"
MAX_SIMILAR_TEXTS: Final = 16
"""Most texts differing only in their numbers that are reported one by one."""
_NUMBER: Final = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.]*\w)")


def cases_verdict(dataset: xr.Dataset) -> str:
    """Describe the outcomes of the cases of a dataset; for a whole result as in its attribute."""
    text = str(dataset.attrs.get("verdict", ""))
    if CASE_COUNT not in dataset.attrs or "status" not in dataset:
        return text
    total = read_attribute(dataset, CASE_COUNT, int, owner="the verdict")
    status = dataset["status"]
    whole = status.dtype.kind in "iu"  # `where` and `reindex` leave gaps
    if not whole and (MESSAGE not in dataset or dataset[MESSAGE].dims != status.dims):
        return text  # such as of a mean
    count = status.size if whole else int(status.notnull().sum())
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
        text += f"; {counts[REPEATED]} near a change of the verdict were run again with adaptive "
        text += f"steps, which changed {counts[VERDICT_CHANGED]}"
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
    for name in (name for name in PEAK_SLIPS if name in runs):
        slips = labels_in_unit(runs[name], SCHEMA[name].unit, owner=OWNER)
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
            texts = Counter[str](message[which].tolist())
            several = max(_alike(texts), key=lambda alike: sum(texts[one] for one in alike))
            text, number = _text_with_ranges(several), sum(texts[one] for one in several)
            reason = "" if text == NONE else f"; message of {number} of them: {text}"
            count = f"{int(which.sum())} of {len(status)} cases"
            warn(f"{OWNER}: {count} {words} (status, message){reason}", kind)
    absent = [name for name in histories if name not in dataset]
    if absent and not missing.all():
        named = ", ".join(map(repr, absent))
        warn(f"{OWNER}: outputs names {named}, which no scene of the cases has", ModelWarning)


def cautions_of_result(dataset: xr.Dataset) -> list[str]:
    """Return why a result is to be used with care: of the whole, then of how many of its cases."""
    of_whole = str(dataset.attrs.get(CAUTIONS, NONE))
    found = [] if of_whole == NONE else [of_whole]
    if MESSAGE not in dataset.coords:
        return found
    size, texts = dataset[MESSAGE].size, Counter[str]()
    for part in _stored_parts(dataset) if "status" in dataset else [dataset]:
        # cases that `where` and `reindex` leave out have none
        texts.update(text for text in part[MESSAGE].to_numpy().ravel() if isinstance(text, str))
    del texts[NONE]
    if size == 1:
        return [*found, *texts]
    counts = [
        (sum(texts[text] for text in several), _text_with_ranges(several))
        for several in _alike(texts)
    ]
    counts.sort(key=lambda counted: -counted[0])
    return [*found, *(f"{count} of {size} cases: {text}" for count, text in counts)]


def cautions_attribute(runs: xr.Dataset) -> dict[str, str]:
    """Return the attribute with the cautions of runs, for what is computed from them."""
    cautions = cautions_of_result(runs)
    return {CAUTIONS: "; ".join(cautions)} if cautions else {}


def _alike(texts: Iterable[str]) -> Iterable[list[str]]:
    """Group texts that differ only in their numbers."""
    alike: dict[tuple[str, ...], list[str]] = {}
    for text in texts:
        alike.setdefault(tuple(_NUMBER.split(text)), []).append(text)
    return alike.values()


def merge_similar_texts(
    texts: Sequence[str], message: AnyArray
) -> tuple[tuple[str, ...], AnyArray]:
    """Report texts that differ only in their numbers as one, if there are more than a few."""
    one_for: dict[str, str] = {}
    for several in _alike(texts):
        if len(several) > MAX_SIMILAR_TEXTS:
            one_for |= dict.fromkeys(several, _text_with_ranges(several))
    merged: dict[str, int] = {}
    places = [merged.setdefault(one_for.get(text, text), len(merged)) for text in texts]
    return tuple(merged), np.array(places, dtype=message.dtype)[message]


def _text_with_ranges(alike: Sequence[str]) -> str:
    words = _NUMBER.split(alike[0])
    columns: Any = zip(*(_NUMBER.findall(text) for text in alike), strict=True)
    ranges = [sorted(set(column), key=float) for column in columns]
    spans = [of[0] if len(of) == 1 else f"{of[0]} to {of[-1]}" for of in ranges]
    return words[0] + "".join(map("".join, zip(spans, words[1:], strict=True)))
