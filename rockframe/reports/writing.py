"""``report``: a page on a run or a study, to keep or to print."""

import warnings
from collections.abc import Iterable, Mapping
from html import escape
from os import PathLike
from pathlib import Path
from typing import Final, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_bool, checked_dataset, checked_text
from rockframe.errors import (
    ComponentError,
    RecordWarning,
    RockframeError,
    RockframeWarning,
    SchemaError,
    short_repr,
    warn,
)
from rockframe.motion import GroundMotion
from rockframe.plot._fonts import warn_of_letters_once
from rockframe.reports import page, sections, studies
from rockframe.reports.checks import CodeCheck, check_section, read_checks, verdict_banners
from rockframe.reports.motions import (
    TargetComparison,
    available_motions,
    read_target,
    spectra_section,
)
from rockframe.reports.project import Project, project_of_result
from rockframe.results.outcome import check_no_means, verdict_of
from rockframe.results.variables.runs import CERTIFICATE
from rockframe.simulation.provenance import arguments_of_run
from rockframe.simulation.system import System
from rockframe.suggestions import with_hints
from rockframe.suites import TargetSpectrum
from rockframe.units.display import DisplayUnits, display_units
from rockframe.writing import checked_path, write_file

_OWNER: Final = "report"


@warn_of_letters_once
@with_hints()
def report(
    response: xr.Dataset,
    path: "str | PathLike[str]",
    *,
    title: str | None = None,
    project: Mapping[str, object] | None = None,
    units: Mapping[str, str] | None = None,
    motion: GroundMotion | None = None,
    motions: GroundMotion | Iterable[GroundMotion] | Mapping[str, GroundMotion] | None = None,
    target: TargetSpectrum | xr.Dataset | None = None,
    checks: CodeCheck | Iterable[CodeCheck] = (),
    certify: bool = True,
    overwrite: bool = False,
) -> Path:
    """Write a page on a run or a study: one HTML file that needs no other file and no network.

    Parameters
    ----------
    response : xarray.Dataset
        The result of one run; or of a sweep over motions or axes, a fragility, a critical scale
        or another analysis; also one read back from a file. A case that was picked out of a sweep
        is simulated again if its motion is available.
    path : str or path
        The file; its name ends in ``.html``. An existing report is replaced. Browsers print it to
        PDF, on sheets of A4.
    title : str, optional
        Title of the page; the model unless given.
    project : mapping of str to str, optional
        Subject of the report: ``object``, ``place``, ``number``, ``date``, ``author``,
        ``checked_by``; ``conclusion``, a sentence at the head of the verdict; ``assumptions``, a
        list of texts; and ``checks``, those for the command line to make. By default the table
        ``[project]`` in the file of the scene.
    units : mapping of str to str, optional
        Units of all numbers by quantity, such as ``{"force": "kN", "angle": "deg"}``: length,
        mass, angle, angular_velocity, velocity, acceleration, force, moment, energy, stiffness.
        SI units unless given.
    motion : GroundMotion, optional
        The motion of the run, for its certificate, its measures and its figure, if the dataset
        does not hold its samples.
    motions : GroundMotion, or iterable or mapping of them, optional
        The motions of a study, such as a suite, for their spectra and for the worst case, if
        neither the dataset nor this process has them.
    target : TargetSpectrum or xarray.Dataset, optional
        Target of the spectra of the motions; or the result of
        :meth:`rockframe.MotionSuite.scaling_to` or :meth:`rockframe.MotionSuite.selection_for` for
        a target, with the periods of the comparison. By default the target to which `motions`
        were scaled.
    checks : CodeCheck, or iterable of them, optional
        Checks by codes (:mod:`rockframe.codes`): their verdicts follow that of the run, their
        numbers and clauses are in a section each.
    certify : bool, optional
        Whether a run without a certificate is certified first, if the dataset holds its motion;
        that takes 100 to 200 runs.
    overwrite : bool, optional
        Whether to replace an existing file that is not a report.

    Returns
    -------
    Path
        The file. For a run it shows the verdict with its certificate, the scene, the motion and its
        measures, all scalars, all histories, limits of validity, and provenance. For a sweep it
        shows all cases in a table with mean and largest values, a figure, and the worst case as a
        run; for other analyses the figure and numbers. For a study it also shows the available
        records, with their spectra and the target.

    Raises
    ------
    SchemaError
        Not a dataset, or not one of rockframe.
    ComponentError
        An argument is invalid: a title that is not text, an unknown entry of the project,
        motions that are not those of the study, units, a target or checks of another type, or
        `certify` or `overwrite` that is not True or False.
    UnitsError
        A unit of another kind.
    FileError
        The file cannot be written, its name has another ending, it exists and is not a report, or
        the result was read from it.

    Warns
    -----
    RockframeWarning
        There is a target, but no motion is available whose spectrum could be compared with it.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="1 m", height="4 m", mass="10 t"))
    >>> response = system.simulate(rf.GroundMotion.sine_pulse("-3 m/s^2", "2 Hz"))
    >>> rf.report(response, Path(tempfile.mkdtemp()) / "report.html", certify=False).name
    'report.html'
    """
    dataset = checked_dataset(response, owner=_OWNER)
    _check_dataset(dataset)
    # dimensions that xarray stacked: make their levels ordinary coordinates
    stacked = [
        dim for dim, index in dataset.indexes.items() if dim in dataset.dims and index.nlevels > 1
    ]
    dataset = dataset.reset_index(stacked)
    checked_bool(certify, owner=_OWNER, name="certify")
    value = "" if title is None else checked_text(title, owner=_OWNER, name="title")
    if motion is not None and not isinstance(cast("object", motion), GroundMotion):
        msg = f"{_OWNER}: motion must be a GroundMotion, got {short_repr(motion)}"
        raise ComponentError(msg)
    about = project_of_result(project, dataset, _OWNER)
    chosen = display_units(units, owner=_OWNER)
    comparison = read_target(target, motions, _OWNER)
    checked = read_checks(checks, _OWNER)
    by_codes = [banner for check in checked for banner in verdict_banners(check, chosen)]
    by_codes = by_codes or [*about.missing_checks_banner()]
    source = str(dataset.encoding.get("source", ""))
    read = [source] if source else []
    # checked before the certificate, which takes a while
    checked_path(path, page.FILE_KIND, overwrite=overwrite, read=read)
    run, picked = _is_run(dataset), "axes_json" in dataset.attrs  # picked out of a sweep
    if motion is not None and not run:
        msg = f"{_OWNER}: found motion=, which is for a run; a study takes motions="
        raise ComponentError(msg)
    if motions is not None and run and not picked and not read_target(None, motions, _OWNER):
        msg = f"{_OWNER}: found motions=, which is for a study; a run takes motion="
        raise ComponentError(msg)
    if run and picked:
        dataset = studies.simulated_case(dataset, motions if motion is None else motion)
        motion = None  # the run has its own motion, which is scaled
    if _is_run(dataset):
        model = str(dataset.attrs["model"])
        heading = value or f"Rocking response, {model} model"
        system = _system_of(dataset, motion)
        _warn_of_unused_target(target, None if system is None else system.motion, "motion")
        dataset, reason = _with_certificate(dataset, system) if certify else (dataset, "")
        verdict = sections.verdict_section(dataset, reason, chosen)
        body = [page.section("Verdict", [*about.conclusion_banner(), *verdict, *by_codes])]
        body += _run_sections(dataset, system, about, chosen, comparison)
    else:
        heading = value or str(dataset.attrs.get("title", "Study"))
        available = available_motions(dataset, motions, _OWNER)
        _warn_of_unused_target(target, available, "motions")
        body = [*studies.verdict_sections(dataset, about, chosen, by_codes)]
        if available:
            spectra = spectra_section(available, comparison, chosen)
            body.append(page.section("Ground motions", spectra))
        body += _study_sections(dataset, available, about, chosen)
    body += [check_section(check, chosen) for check in checked]
    made = str(dataset.attrs.get("history", "")).splitlines()[-1:]
    content = [
        "<header>",
        f"<h1>{escape(heading)}</h1>",
        *(page.paragraph(text, kind="soft") for text in made),
        "</header>",
        *about.block(),
        *body,
        page.section("Provenance", sections.provenance_section(dataset, Path(source).name)),
    ]
    written = page.html_page(heading, content)
    return write_file(path, page.FILE_KIND, written, overwrite=overwrite, read=read)


def _warn_of_unused_target(target: object, available: object, name: str) -> None:
    """Warn of a target without spectra to compare, since no motion is available."""
    if target is not None and not available:
        msg = f"{_OWNER}: no motion is available to compare with the target; pass it by {name}="
        warn(msg, RockframeWarning)


def _run_sections(
    dataset: xr.Dataset,
    system: System | None,
    about: Project,
    units: DisplayUnits,
    comparison: TargetComparison | None = None,
    *,
    study: bool = False,
) -> list[str]:
    """Return the sections on a run that follow its verdict."""
    motion = None if system is None else system.motion
    limits = sections.limits_section(dataset, system, about.assumptions, study=study)
    return [
        page.section("Response", sections.response_section(dataset, units)),
        page.section("Scene", sections.scene_section(dataset, system, units)),
        page.section("Ground motion", sections.motion_section(dataset, motion, units, comparison)),
        page.section("Limits of validity", limits),
    ]


def _study_sections(
    dataset: xr.Dataset, motions: Mapping[str, GroundMotion], about: Project, units: DisplayUnits
) -> list[str]:
    """Return the sections on a study that follow its motions: its worst case, or its scene."""
    words, worst = studies.worst_case(dataset, motions, units)
    if worst is not None:
        run, system = worst
        inner = [page.paragraph(words), sections.outcome_banner(run, units)]
        body = [page.section("The worst case in full", inner)]
        return [*body, *_run_sections(run, system, about, units, study=True)]
    body = [page.section("The worst case", [page.paragraph(words)])] if words else []
    system = _system_of(dataset, None)
    if system is not None:
        differs = studies.varied_parameters_sentence(dataset)
        intro = [page.paragraph(differs)] if differs else []
        scene = [*intro, *sections.scene_section(dataset, system, units)]
        body.append(page.section("Scene", scene))
    limits = sections.limits_section(dataset, system, about.assumptions, study=True)
    return [*body, page.section("Limits of validity", limits)]


def _check_dataset(dataset: xr.Dataset) -> None:
    """Raise on a dataset that is not the result of a run or of a study."""
    if not _is_run(dataset) and not studies.is_study(dataset):
        title = dataset.attrs.get("title", "without a title")
        msg = (
            f"{_OWNER}: found a dataset ({title}) that is no result of a run or of a study; "
            "expected that of system.simulate(motion), rf.sweep(...) or another analysis"
        )
        raise SchemaError(msg)
    if "status" in dataset:
        check_no_means(dataset, owner=_OWNER)


def _is_run(dataset: xr.Dataset) -> bool:
    """Whether a dataset is the result of one run."""
    needed = ("overturned", "status", "peak_rotation")
    described = "model" in dataset.attrs or "axes_json" in dataset.attrs  # a case of a sweep
    return described and all(name in dataset and not dataset[name].dims for name in needed)


def _system_of(dataset: xr.Dataset, motion: GroundMotion | None) -> System | None:
    """Return the system of a result with its motion; None if the result does not describe it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RecordWarning)  # the page mentions them
            system = System.from_dataset(dataset)
    except SchemaError:
        return None
    if motion is None:
        return system
    digest = dataset.attrs.get("motion_sha256", motion.sha256)
    if digest != motion.sha256 or dataset.attrs.get("motion") == "none":
        msg = (
            f"{_OWNER}: found a motion ({motion.name}) whose samples are not those of the run "
            f"({dataset.attrs.get('motion')}); expected the motion of the run"
        )
        raise SchemaError(msg)
    return studies.with_motion(system, motion)


_SAME_OUTCOME: Final = 1e-3
"""Relative difference up to which runs of other versions and machines are the same."""


def _with_certificate(dataset: xr.Dataset, system: System | None) -> tuple[xr.Dataset, str]:
    """Add the certificate to a result, by running it again with all runs of a certificate."""
    if "certificate" in dataset.attrs or "proof" in dataset.attrs:
        return dataset, ""
    if system is None:
        return dataset, "the dataset does not describe its system."
    if system.motion is None and dataset.attrs.get("motion") != "none":
        return dataset, (
            "the dataset does not hold the samples of its motion; pass it by motion= or --motion, "
            "or simulate with certify=True or with 'rockframe certify'."
        )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RockframeWarning)  # the dataset has them
            repeated = system.simulate(**arguments_of_run(dataset), outputs=None, certify=True)
    except RockframeError as problem:
        return dataset, f"{problem}."
    if verdict_of(repeated) != verdict_of(dataset) or not _same_outcome(repeated, dataset):
        return dataset, "a repeated run differs; another version or machine made the result."
    certificate = {
        name: value for name, value in repeated.attrs.items() if str(name).startswith("certificate")
    }
    names = [row.name for row in CERTIFICATE if row.name in repeated]
    return dataset.assign({name: repeated[name] for name in names}).assign_attrs(certificate), ""


def _same_outcome(run: xr.Dataset, repeated: xr.Dataset) -> bool:
    """Whether peaks and times of overturning are equal but for rounding."""
    return all(
        np.isclose(run[name], repeated[name], rtol=_SAME_OUTCOME, atol=0.0, equal_nan=True)
        for name in ("peak_rotation", "overturning_time")
    )
