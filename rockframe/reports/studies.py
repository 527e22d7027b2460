"""The sections of a report on many runs, or on an analysis of them."""

import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
import xarray as xr

from rockframe import plot
from rockframe.errors import RockframeError, RockframeWarning, SchemaError, StudyError
from rockframe.motion import GroundMotion
from rockframe.plot._checks import figure_function_name
from rockframe.reports import page
from rockframe.reports.cases import (
    capacity_table,
    case_tables,
    label_texts,
    label_values,
    order_from_worst,
)
from rockframe.reports.project import Project
from rockframe.reports.values import format_value, scalar_rows
from rockframe.results.outcome import MIN_REPORTED_SLIP, overturned_from_status
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.simulation.system import System
from rockframe.studies import case, fragility
from rockframe.studies.sweeps.axes import Changes, described_axes
from rockframe.studies.sweeps.case import NOT_GIVEN, system_of_case
from rockframe.studies.sweeps.labelling import (
    cases_verdict,
    cautions_of_result,
    slips_of_cases,
)
from rockframe.studies.verdicts import verdict_of_study
from rockframe.units.display import DisplayUnits, with_superscripts


def verdict_sections(
    dataset: xr.Dataset, about: Project, units: DisplayUnits, by_codes: Sequence[str] = ()
) -> Iterator[str]:
    """Return the verdicts of the cases and of codes, the figure, and the numbers."""
    sentence = verdict_of_study(dataset)
    verdict = [*about.conclusion_banner()]
    if sentence:
        verdict.append(_banner(dataset, units.convert_text(sentence)))
    fit = _capacity_fit(dataset)
    if fit:
        verdict.append(page.banner("Fit", with_superscripts(units.convert_text(fit)), ""))
    if cautions := cautions_of_result(dataset):
        verdict.append(page.care_banner(units.convert_text("; ".join(cautions))))
    yield page.section("Verdict", [*verdict, *by_codes])
    scalars = scalar_rows(dataset, units=units)
    for title, pieces in (
        ("Figure", _figure(dataset, units)),
        ("Capacities", capacity_table(dataset, units)),
        ("Cases", case_tables(dataset, units) if _is_sweep(dataset) else ()),
        ("Numbers", [page.parameter_table(scalars)] if scalars else ()),
        ("Limit states", _limit_state_table(dataset, units)),
    ):
        elements = [*pieces]
        if elements:
            yield page.section(title, elements)


def worst_case(
    dataset: xr.Dataset, motions: Mapping[str, GroundMotion], units: DisplayUnits
) -> tuple[str, tuple[xr.Dataset, System] | None]:
    """Simulate the case of a sweep that comes nearest to overturning, or overturns first.

    Gives a sentence on it, or on why it cannot be simulated; an empty one if there are no cases.
    """
    order = order_from_worst(dataset) if _is_sweep(dataset) else np.array([])
    if not order.size:
        return "", None
    place = int(order[0])
    labels = label_values(dataset, place)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RockframeWarning)  # the dataset has them
            worst = case(dataset, motions=motions or None, **labels)
            run = worst.simulate(outputs=())
    except RockframeError as problem:  # such as without its motions
        reason = str(problem).replace(NOT_GIVEN, f"{NOT_GIVEN} or, in a shell, by --motions")
        return f"Not simulated again; {reason}.", None
    shown_as = label_texts(dataset, place, units)
    named = ", ".join(f"{name.replace('_', ' ')} {reason}" for name, reason in shown_as.items())
    system = worst.system if worst.motion is None else with_motion(worst.system, worst.motion)
    return f"Simulated again: {named}." if named else "Simulated again.", (run, system)


def varied_parameters_sentence(dataset: xr.Dataset) -> str:
    """Write which values of the scene differ among the cases; an empty text if none do."""
    axes = described_axes(dataset, owner="report")
    names = [axis.name.replace("_", " ") for axis in axes if axis.changes is not Changes.MOTION]
    if not names:
        return ""
    return f"Values of the scene from which the cases differ in: {', '.join(names)}."


def simulated_case(dataset: xr.Dataset, motions: Any) -> xr.Dataset:
    """Simulate a case selected from a sweep; return it unchanged without its motion."""
    try:
        return case(dataset, motions=motions).simulate(outputs=())
    except (SchemaError, StudyError):
        if motions is not None:
            raise
    system = system_of_case(dataset, owner="report").assembly.json
    single = dataset.assign_attrs(system_json=system, verdict=cases_verdict(dataset))
    del single.attrs["axes_json"]  # it is a run of its own now
    return single


def with_motion(system: System, motion: GroundMotion) -> System:
    """Return a system with a motion of its own."""
    options: dict[str, Any] = dict(system.options.to_dict())
    return System(*system.parts.structural(), motion, **options)


def is_study(dataset: xr.Dataset) -> bool:
    """Whether a dataset has many runs, or is an analysis of them."""
    try:
        return _is_sweep(dataset) or figure_function_name(dataset) != "response"
    except SchemaError:
        return False


def _capacity_fit(dataset: xr.Dataset) -> str:
    """Describe the lognormal fit to the capacities of a dynamic analysis; empty without one."""
    measure = dataset.attrs.get("intensity")
    if "capacity_scale" not in dataset or measure not in dataset:
        return ""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RockframeWarning)  # on what the sentence says, too
            fit = fragility(dataset, str(measure), trials="capacities")
    except RockframeError:  # such as of a part of an analysis
        return ""
    fitted = (fit["fragility_status"] == FragilityStatus.FITTED).any()
    return str(fit.attrs["verdict"]) if fitted else ""


def _is_sweep(dataset: xr.Dataset) -> bool:
    needed = ("status", "peak_relative_rotation", "overturning_time")
    return all(name in dataset and dataset[name].dims for name in needed)


def _banner(dataset: xr.Dataset, sentence: str) -> str:
    if "status" not in dataset:
        return page.banner("Result", with_superscripts(sentence), "")
    overturned = overturned_from_status(dataset["status"].to_numpy())
    slid = _sliding_words(dataset)
    if (overturned == 1.0).any():
        return page.banner(f"Some cases overturned{slid}", sentence, "bad")
    if (overturned == 0.0).all():
        return page.banner(f"No case overturned{slid}", sentence, "doubt" if slid else "good")
    return page.banner("Not all cases have a result", sentence, "doubt")


def _sliding_words(dataset: xr.Dataset) -> str:
    """Write whether cases slid, or would slide; an empty text if none did."""
    if (slips_of_cases(dataset) >= MIN_REPORTED_SLIP).any():
        return ", some slid"
    would = dataset.get("would_slide")
    return ", some would slide" if would is not None and bool((would == 1.0).any()) else ""


def _figure(dataset: xr.Dataset, units: DisplayUnits) -> Iterator[str]:
    """Draw a dataset with the function for its kind, if there is one."""
    with suppress(RockframeError):
        drawn = getattr(plot, figure_function_name(dataset))(dataset, units=units.words)
        yield page.captioned_figure(drawn, str(dataset.attrs.get("title", "The study")) + ".")


def _limit_state_table(dataset: xr.Dataset, units: DisplayUnits) -> Iterator[str]:
    """Return all numbers of a fragility: a row for each, with a column for each limit state."""
    dim = "limit_state"
    if dim not in dataset.dims:
        return
    rows = list[list[str]]()
    for name, values in dataset.data_vars.items():
        if values.dims == (dim,):
            words = str(values.attrs.get("long_name", name))
            rows.append([words, *(format_value(values.isel({dim: k}), units)
                                  for k in range(dataset.sizes[dim]))])  # fmt: skip
    heads = [units.convert_text(str(label)) for label in dataset[dim].to_numpy()]
    yield page.number_table(rows, ["", *heads])
