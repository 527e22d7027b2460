"""``rockframe report``: a page on a run or a study."""

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.files.tables import arguments_of
from rockframe.command.shared import Outputs, read_result
from rockframe.command.streams import STANDARD_INPUT_NAME, STREAM
from rockframe.command.typed_calls import (
    CODES,
    call_typed,
    parse_check,
    target_from,
    values_by_name,
)
from rockframe.errors import ComponentError, FileError, SchemaError, StudyError
from rockframe.motion import GroundMotion
from rockframe.reports import report
from rockframe.reports.checks import CodeCheck
from rockframe.reports.motions import available_motions
from rockframe.reports.page import FILE_KIND
from rockframe.reports.project import CHECKS, project_of_result
from rockframe.simulation.system import System
from rockframe.studies import case, open_study
from rockframe.studies.sweeps.case import NOT_GIVEN
from rockframe.suites import TargetSpectrum, read_suite

_CHECK_OPTION: Final = "--check"


def execute_report(arguments: argparse.Namespace, answer: Answer) -> int:
    """Write the page."""
    path = arguments.output
    if path is None and arguments.dataset == STREAM:
        words = "a result from the standard input has no name; name the report with -o report.html"
        raise FileError(STANDARD_INPUT_NAME, words)
    source = Path(arguments.dataset)
    is_store = source.expanduser().is_dir()
    dataset = open_study(arguments.dataset) if is_store else read_result(arguments.dataset)
    if path is None:
        if is_store:  # its name may contain points, or be '.' or '..'
            source = source if source.name.strip(".") else source.resolve()
            source = source.with_name(f"{source.name}.nc")
        path = arguments.output = str(source.with_suffix(".html"))
    outputs = Outputs(arguments, [arguments.dataset], answer, output=FILE_KIND)
    records = arguments.motions
    motions = None if records is None else read_suite(records[0] if len(records) == 1 else records)
    if arguments.case is not None:
        dataset = _simulate_case(dataset, arguments, motions)
        motions = None  # a case holds its motion
    outputs.save_by(
        path, FILE_KIND, ".html", "Report",
        lambda source: _write_report(dataset, source, arguments, motions),
    )  # fmt: skip
    return 0


def _write_report(
    dataset: xr.Dataset,
    place: Path,
    arguments: argparse.Namespace,
    motions: Mapping[str, GroundMotion] | None,
) -> None:
    motion = None if arguments.motion is None else GroundMotion.read(arguments.motion)
    target = None if arguments.target is None else target_from(arguments.target, "--target")
    checks = _code_checks(dataset, arguments.check or (), motion or motions, target)
    if checks and "motions_json" not in dataset.attrs:  # a run, checked under further motions
        motions = None
    report(
        dataset,
        place,
        title=arguments.title,
        units=values_by_name(arguments.units or (), "--units", "force=kN") or None,
        motion=motion,
        motions=motions,
        target=target,
        checks=checks,
        certify=not arguments.no_certificate,
        overwrite=arguments.overwrite,
    )


def _code_checks(
    dataset: xr.Dataset, typed: Any, motions: object, target: TargetSpectrum | None
) -> list[CodeCheck]:
    """Check the scene of a result by codes, under its motions or by a spectrum."""
    # checks that were typed replace those in the file of the scene
    listed = project_of_result(None, dataset, _CHECK_OPTION).checks
    required = bool(typed)  # others are left out without motions, which the report mentions
    typed = typed or [parse_check(text, CHECKS) for text in listed]
    if not typed:
        return []
    try:
        system = System.from_dataset(dataset)
    except SchemaError as problem:
        if not required:
            return []
        msg = (
            f"{_CHECK_OPTION}: the result does not hold the scene that is to be checked ({problem})"
        )
        raise ComponentError(msg) from problem
    motions_of_result = available_motions(dataset, motions, _CHECK_OPTION)
    if not motions_of_result and system.motion is not None:
        motions_of_result = {system.motion.name: system.motion}
    checks: list[CodeCheck] = []
    for words in typed:
        demand = motions_of_result or (target if words[0] == "circolare_2019" else None)
        if demand is None and words[0] == "circolare_2019":
            if not required:
                continue
            msg = (
                f"{_CHECK_OPTION}: circolare_2019 needs the motions of the result, by --motions or "
                "--motion, or a spectrum, by --target"
            )
            raise ComponentError(msg)
        checks.append(call_typed(CODES, words, _CHECK_OPTION, system, demand))
    return checks


def _simulate_case(
    dataset: xr.Dataset, arguments: argparse.Namespace, motions: object
) -> xr.Dataset:
    """Simulate the case of a study that was named."""
    if "axes_json" not in dataset.attrs:
        words = f"found --case {' '.join(arguments.case)}; expected a study, which has axes"
        raise FileError(arguments.dataset, words)
    values = values_by_name(arguments.case, "--case", "scale=2")
    strange = [name for name in values if name in arguments_of(case)]
    if strange:
        words = f"--case: there is no axis {strange[0]!r}; records are given by --motions"
        raise FileError(arguments.dataset, words)
    try:
        selected = case(dataset, motions=motions, **values)
    except StudyError as problem:
        words = str(problem).replace(NOT_GIVEN, "must be given, by --motions")
        raise FileError(arguments.dataset, words.removeprefix("case: ")) from problem
    again = selected.simulate()
    again.encoding["source"] = str(Path(arguments.dataset).expanduser())
    return again
