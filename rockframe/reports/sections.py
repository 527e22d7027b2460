"""The sections of a report on a run."""

import json
import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from importlib.metadata import version
from platform import python_version
from typing import Any, Final

import xarray as xr

from rockframe import plot
from rockframe.components import Component, component_from_dict
from rockframe.components.parameters import Declared
from rockframe.errors import RockframeError
from rockframe.measures import intensity_measures
from rockframe.motion import GroundMotion
from rockframe.motion.display import display_name, motion_words
from rockframe.plot._checks import RUN
from rockframe.plot._response import SLIP_HISTORIES, has_slid, history_names
from rockframe.reports import page
from rockframe.reports.limits import (
    GENERAL,
    STUDY_WITHOUT_CERTIFICATE,
    WITH_CERTIFICATE,
    WITHOUT_CERTIFICATE,
    model_limits,
)
from rockframe.reports.motions import TargetComparison, record_rows, spectra_section
from rockframe.reports.values import extreme_rows, format_value, scalar_rows
from rockframe.results.outcome import MIN_REPORTED_SLIP, verdict_of
from rockframe.results.variables.runs import CERTIFICATE, PROOF
from rockframe.simulation.certify.certificate import NEAR_WORDS
from rockframe.simulation.system import System
from rockframe.studies.sweeps.labelling import cautions_of_result, slips_of_cases
from rockframe.units import ACCELERATION, Unit, to_si
from rockframe.units.display import DisplayUnits, with_superscripts
from rockframe.version import __version__

_LIBRARIES: Final = ("numpy", "scipy", "xarray")
_CERTIFICATE_VARIABLES: Final = [row.name for row in (*CERTIFICATE, *PROOF)]
_NUMBERS_START: Final = re.compile(r": |, after ")
"""Ends of the part of a verdict before its numbers."""
_MAX_PANELS: Final = 4
"""Largest number of histories in one figure, which then fits on a page."""
_DRAWN_HISTORIES: Final = frozenset({
    "ground_acceleration", "vertical_ground_acceleration", "rotation", "relative_rotation",
    "angular_velocity", "vertical_displacement", "relative_vertical_displacement",
    "vertical_velocity", "horizontal_displacement", "cap_rotation", "cap_angular_velocity",
    "cap_vertical_displacement", "cap_vertical_velocity", "rotation_on_cap",
    "vertical_displacement_on_cap",
})  # fmt: skip
"""Histories in the first figure, and those that follow from them."""
_PROVENANCE: Final = (
    # (attribute, label)
    ("source", "computed by"),
    ("history", "when"),
    ("model", "model"),
    ("restraint", "horizontal restraint"),
    ("kinematics", "rotations"),
    ("coupling", "coupling"),
    ("accuracy", "accuracy"),
    ("solver_method", "method"),
    ("solver_rtol", "tolerance of a step"),
    ("solver_steps", "steps"),
    ("solver_rejected_steps", "steps made again"),
    ("solver_end_time", "end of the run [s]"),
    ("schema_version", "version of the schema"),
    ("references", "equations"),
)


def outcome_banner(dataset: xr.Dataset, units: DisplayUnits) -> str:
    """Return the verdict; its title says whether the body slid."""
    title, kind = page.BANNERS[verdict_of(dataset)]
    words = units.convert_text(str(dataset.attrs.get("verdict", "")))
    slid = float(slips_of_cases(dataset)) >= MIN_REPORTED_SLIP
    if "peak_slip" in dataset and words:
        title = _NUMBERS_START.split(words)[0]
    elif bool(dataset.get("would_slide", False)):
        slid, title = True, f"{title}, but would slide"
    return page.banner(title, words, "doubt" if slid and kind == "good" else kind)


def verdict_section(dataset: xr.Dataset, reason: str, units: DisplayUnits) -> Iterator[str]:
    """Return the verdict, its proof or certificate, and cautions."""
    yield outcome_banner(dataset, units)
    if "proof" in dataset.attrs:
        proved = bool(dataset["verdict_proved"])
        title = f"The verdict is {'' if proved else 'not '}proved"
        words = units.convert_text(str(dataset.attrs["proof"]))
        yield page.banner(title, words, "good" if proved else "doubt")
    if "certificate" in dataset.attrs:
        holds = all(bool(dataset[name]) for name in _CERTIFICATE_VARIABLES[:2] if name in dataset)
        words = units.convert_text(str(dataset.attrs["certificate"]))
        near = words.startswith(NEAR_WORDS)
        text = f"holds{', but near a boundary' * near}" if holds else "is in doubt"
        title = f"Certificate: the verdict {text}"
        yield page.banner(title, words, "good" if holds and not near else "doubt")
    elif "proof" not in dataset.attrs:
        yield page.banner("No certificate", reason or "none was requested.", "doubt")
    if cautions := cautions_of_result(dataset):
        yield page.care_banner(units.convert_text("; ".join(cautions)))


def scene_section(dataset: xr.Dataset, system: System | None, units: DisplayUnits) -> Iterator[str]:
    """Return the parts with their parameters, and the model."""
    if system is not None:
        with suppress(RockframeError):  # a base of a user's own cannot be drawn
            drawn = plot.scene(system, units=units.words)
            yield page.captioned_figure(drawn, "The scene, to scale.")
        for part in system.parts.structural():
            yield from _part_tables(type(part).__name__, part, units)
        yield page.subtitle("Options")
        yield page.parameter_table(
            (name, _format_value(value, units))
            for name, value in system.options.to_dict().items()
            if name != "coupling" or system.assembly.scene.coupling is not None
        )
    yield page.subtitle("Model")
    # runs keep the description of their model, analyses do not
    text = "not described" if system is None else system.describe()
    yield page.preformatted(units.convert_text(str(dataset.attrs.get("model_description", text))))


def motion_section(
    dataset: xr.Dataset,
    motion: GroundMotion | None,
    units: DisplayUnits,
    comparison: TargetComparison | None = None,
) -> Iterator[str]:
    """Return the motion, its measures and its figure, and its spectrum with a target."""
    attributes = dict(dataset.attrs)
    if "motion" in attributes:
        attributes["motion"] = motion_words(attributes)
    entries = (
        ("motion", "name"),
        ("motion_history", "made from"),
        ("motion_samples", "samples"),
        ("motion_time_step", "time step [s]"),
        ("motion_sha256", "digest (SHA-256)"),
    )
    pairs = [(words, str(attributes[name])) for name, words in entries if name in attributes]
    yield page.parameter_table([*pairs, *([] if motion is None else record_rows(motion, units))])
    if motion is None:
        return
    has_vertical = motion.si.vertical is not None  # of which nothing is shown
    yield page.subtitle(f"Measures{' of the horizontal component' * has_vertical}")
    measures = intensity_measures(motion)
    threshold = to_si(measures.attrs["threshold"], ACCELERATION, owner="", name="")
    in_words = format_value(xr.DataArray(threshold, attrs={"units": str(ACCELERATION.unit)}), units)
    yield page.parameter_table(
        (words.replace("the threshold", in_words), value)
        for words, value in scalar_rows(measures, units=units)
    )
    yield page.captioned_figure(
        plot.spectra(motion, units=units.words),
        f"History of the {'horizontal ' * has_vertical}ground acceleration, its response spectra "
        "at 5 % damping and its Fourier spectrum.",
    )
    if comparison is not None:
        yield page.subtitle("Spectrum and target")
        name = display_name(motion.name, motion.history)
        yield from spectra_section({name: motion}, comparison, units)


def response_section(dataset: xr.Dataset, units: DisplayUnits) -> Iterator[str]:
    """Return the scalars of a run, and figures of its histories."""
    if dataset.sizes.get("time", 0) > 1 and {*RUN.identifying, *RUN.required} <= {
        *dataset.variables
    }:
        angle = units.chosen.get(Unit.RADIAN)
        yield page.captioned_figure(
            plot.response(dataset, rotation=None if angle else "relative", units=units.words),
            "From the top: ground acceleration; rotation"
            f"{'' if angle else ' over the overturning angle'}; vertical displacement; "
            f"{'slip; ' if has_slid(dataset) else ''}and contact states.",
        )
        yield from _history_figures(dataset, units)
    else:
        yield page.paragraph("The result has no histories of the motion to draw.", kind="soft")
    names = [str(name) for name in dataset.data_vars if str(name) not in _CERTIFICATE_VARIABLES]
    yield page.parameter_table(scalar_rows(dataset, names, units))
    if any(name in dataset for name in _CERTIFICATE_VARIABLES):
        yield page.subtitle("Certificate")
        yield page.parameter_table(scalar_rows(dataset, _CERTIFICATE_VARIABLES, units))


def _history_figures(dataset: xr.Dataset, units: DisplayUnits) -> Iterator[str]:
    """Return figures and extremes of forces, accelerations and other requested histories."""
    beside = [name for name in history_names(dataset) if name not in _DRAWN_HISTORIES]
    below = [name for name in beside if name not in SLIP_HISTORIES or not has_slid(dataset)]
    for start in range(0, len(below), _MAX_PANELS):
        names = below[start : start + _MAX_PANELS]
        drawn = plot.response(dataset, panels=tuple(names), units=units.words, title=" ")
        words = ", ".join(name.replace("_", " ") for name in names)
        yield page.captioned_figure(drawn, f"{words[0].upper()}{words[1:]}, over time.")
    if beside:
        yield page.subtitle("Least and greatest values over time")
        rows = extreme_rows(dataset, beside, units)
        yield page.number_table(rows, ("", "unit", "least", "greatest"))


def limits_section(
    dataset: xr.Dataset, system: System | None, assumptions: Sequence[str] = (), *, study: bool
) -> Iterator[str]:
    """Return the assumptions, and what the model neglects."""
    parts = None if system is None else system.parts
    slides = system is not None and system.setting.slides
    left_out = [
        (limit.title, limit.study_meaning if study and limit.study_meaning else limit.meaning)
        for limit in model_limits(parts, slides=slides)
    ]
    study_or_run = WITH_CERTIFICATE if "certificate" in dataset.attrs else WITHOUT_CERTIFICATE
    *general, sensitive = GENERAL
    if "proof" not in dataset.attrs:  # the proof says that of its own verdict
        sensitive = f"{sensitive} {STUDY_WITHOUT_CERTIFICATE if study else study_or_run}"
    if assumptions:
        yield page.subtitle("Assumptions")
        yield page.numbered_list(assumptions)
        yield page.subtitle("What the model neglects")
    yield page.numbered_list([*general, sensitive, *left_out])


def provenance_section(dataset: xr.Dataset, file: str) -> Iterator[str]:
    """Return the provenance of the numbers, from which they can be computed again."""
    attributes = dataset.attrs
    pairs = [(words, str(attributes[name])) for name, words in _PROVENANCE if name in attributes]
    versions = ", ".join(f"{name} {version(name)}" for name in _LIBRARIES)
    environment = f"rockframe {__version__}, Python {python_version()}, {versions}"
    yield page.parameter_table(
        [*([("file", file)] if file else []), *pairs, ("page written by", environment)]
    )
    for name, words in (("system_json", "System"), ("run_json", "Run")):
        if name in attributes:
            yield page.subtitle(f"{words}, to be built again")
            yield page.preformatted(_indented(str(attributes[name])))


def _part_tables(title: str, part: Component, units: DisplayUnits) -> Iterator[str]:
    """Return a part with its parameters, and the parts of which it consists."""
    yield page.subtitle(title)
    yield page.parameter_table(_parameter_rows(part, units))
    described: dict[str, Any] = dict(part.to_dict())
    for name, value in described.items():
        which = {"bodies": "Body"}.get(name, name.removesuffix("s").capitalize())
        for number, inner_part in enumerate(_inner_parts(value), 1):
            named = f"{which} {number}" if isinstance(value, list) else name.capitalize()
            title = f"{named}: {inner_part['type']}"
            yield from _part_tables(title, component_from_dict(inner_part), units)


def _inner_parts(value: object) -> list[Any]:
    """Return the description of a part in an argument of a part, or those of several."""
    several = value if isinstance(value, list) else [value]
    return [item for item in several if isinstance(item, dict)]


def _parameter_rows(part: Component, units: DisplayUnits) -> list[tuple[str, str, str]]:
    """Return the parameters of a part as they were given, with their meanings."""
    declared = part.declared()
    return [
        (
            name.replace("_", " "),
            _format_value(value, units),
            _meaning(declared[name]) if name in declared else "",
        )
        for name, value in part.to_dict().items()
        if name != "type" and not _inner_parts(value)
    ]


def _meaning(argument: Declared[Any, Any, Any]) -> str:
    words, condition = argument.words.split(" [")[0].rstrip("."), argument.condition
    return words if condition is None else words.removesuffix(f"; {condition.words}")


def _format_value(value: object, units: DisplayUnits) -> str:
    """Write a number with its unit, in six digits; the numbers of a list with commas."""
    if isinstance(value, list):
        return ", ".join(_format_value(item, units) for item in value)
    number, blank, unit = units.convert_text(str(value)).partition(" ")
    try:
        return f"{float(number):.6g}{blank}{with_superscripts(unit)}"
    except ValueError:
        return units.convert_text(str(value))


def _indented(text: str) -> str:
    try:
        return json.dumps(json.loads(text), indent=1)
    except ValueError:
        return text
