"""``rockframe report``: a page on a run or a study."""

import argparse
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.files.tables import arguments_of
from rockframe.command.shared import Outputs, read_result
from rockframe.command.streams import INPUT, STREAM
from rockframe.command.typed_calls import CODES, called, check_of, target_from, values_by_name
from rockframe.errors import ComponentError, FileError, SchemaError
from rockframe.motion import GroundMotion
from rockframe.reports import report
from rockframe.reports.checks import CodeCheck
from rockframe.reports.motions import motions_of
from rockframe.reports.project import ATTRIBUTE, CHECKS
from rockframe.simulation.system import System
from rockframe.studies import case, open_study
from rockframe.suites import TargetSpectrum, read_suite

_CHECK: Final = "--check"


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Write the page."""
    path = arguments.output
    if path is None and arguments.dataset == STREAM:
        words = "a result from the standard input has no name; name the report with -o report.html"
        raise FileError(INPUT, words)
    place = Path(arguments.dataset)
    folder = place.expanduser().is_dir()
    dataset = open_study(arguments.dataset) if folder else read_result(arguments.dataset)
    if path is None:
        if folder:  # its name may contain points, or be '.' or '..'
            place = place if place.name.strip(".") else place.resolve()
            place = place.with_name(f"{place.name}.nc")
        path = str(place.with_suffix(".html"))
    records = arguments.motions
    motions = None if records is None else read_suite(records[0] if len(records) == 1 else records)
    if arguments.case is not None:
        dataset, motions = _case_of(dataset, arguments, motions), None  # a case holds its motion
    outputs = Outputs(arguments, [arguments.dataset], answer)
    outputs.written_by(
        path, ".html", "Report", lambda place: _write(dataset, place, arguments, motions)
    )
    return 0


def _write(
    dataset: xr.Dataset,
    place: Path,
    arguments: argparse.Namespace,
    motions: Mapping[str, GroundMotion] | None,
) -> None:
    motion = None if arguments.motion is None else GroundMotion.read(arguments.motion)
    target = None if arguments.target is None else target_from(arguments.target, "--target")
    checks = _checks(dataset, arguments.check or (), motion or motions, target)
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


def _checks(
    dataset: xr.Dataset, typed: Any, motions: object, target: TargetSpectrum | None
) -> list[CodeCheck]:
    """Check the scene of a result by codes, under its motions or by a spectrum.

    Checks that were typed replace those in the file of the scene. The latter are left out where
    the motions are missing; the report mentions this.
    """
    run_options = json.loads(str(dataset.attrs.get(ATTRIBUTE, "{}"))).get(CHECKS, ())
    required = bool(typed)
    typed = typed or [check_of(one, CHECKS) for one in run_options]
    if not typed:
        return []
    try:
        system = System.from_dataset(dataset)
    except SchemaError as problem:
        if not required:
            return []
        msg = f"{_CHECK}: the result does not hold the scene that is to be checked ({problem})"
        raise ComponentError(msg) from problem
    held = motions_of(dataset, motions, _CHECK)
    if not held and system.motion is not None:
        held = {system.motion.name: system.motion}
    found: list[CodeCheck] = []
    for words in typed:
        demand = held or (target if words[0] == "circolare_2019" else None)
        if demand is None and words[0] == "circolare_2019":
            if not required:
                continue
            msg = (
                f"{_CHECK}: circolare_2019 needs the motions of the result, by --motions or "
                "--motion, or a spectrum, by --target"
            )
            raise ComponentError(msg)
        found.append(called(CODES, words, _CHECK, system, demand))
    return found


def _case_of(dataset: xr.Dataset, arguments: argparse.Namespace, motions: object) -> xr.Dataset:
    """Simulate the case of a study that was named."""
    if "axes_json" not in dataset.attrs:
        words = f"found --case {' '.join(arguments.case)}; expected a study, which has axes"
        raise FileError(arguments.dataset, words)
    values = values_by_name(arguments.case, "--case", "scale=2")
    strange = [name for name in values if name in arguments_of(case)]
    if strange:
        words = f"--case: there is no axis {strange[0]!r}; records are given by --motions"
        raise FileError(arguments.dataset, words)
    found = case(dataset, motions=motions, **values)
    again = found.simulate()
    again.encoding["source"] = str(Path(arguments.dataset).expanduser())
    return again
