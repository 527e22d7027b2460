"""The motions in a report: metadata of their records, spectra, and the target."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rockframe import plot
from rockframe.arguments import is_iterable
from rockframe.errors import ComponentError, short_repr
from rockframe.motion import GroundMotion
from rockframe.reports import page
from rockframe.reports.values import column_title, format_number
from rockframe.results.joining import described_motions
from rockframe.results.schema import SCHEMA
from rockframe.studies.sweeps.case import known_motions
from rockframe.suites import MotionSuite, TargetSpectrum
from rockframe.suites.candidates import default_periods
from rockframe.suites.columns import column_value, is_missing
from rockframe.suites.scaling import compared_periods, compared_target
from rockframe.units import Unit
from rockframe.units.display import DisplayUnits, display_units, with_superscripts

RECORD_COLUMNS: Final = (
    "event",
    "magnitude",
    "station",
    "component",
    "rupture_distance",
    "scale_factor",
    "peak_ground_acceleration",
)
"""Columns of a suite that the table of records shows if they are known, in this order."""
Numbers: TypeAlias = NDArray[np.float64]
_DISTANCE_UNITS: Final = display_units({"length": "km"}, owner="report")


@dataclass(frozen=True)
class TargetComparison:
    """A target spectrum, and the periods at which motions are compared with it."""

    target: TargetSpectrum
    periods: Numbers  # increasing [s]

    @property
    def period_range(self) -> tuple[str, str]:
        """The shortest and the longest period."""
        first, last = (f"{period!r} {Unit.SECOND}" for period in self.periods[[0, -1]].tolist())
        return first, last


def read_target(value: object, motions: object, owner: str) -> TargetComparison | None:
    """Read a target, or take that of a suite that was scaled to one."""
    if value is None:
        carried = motions.target if isinstance(motions, MotionSuite) else None
        if carried is None:
            return None
        return TargetComparison(carried, np.geomspace(*carried.limits, 40))
    if isinstance(value, TargetSpectrum):
        return TargetComparison(value, default_periods(value))
    if isinstance(value, xr.Dataset) and "target_spectral_acceleration" in value:
        target = compared_target(value)
        if target is not None:
            return TargetComparison(target, compared_periods(value))
    msg = (
        f"{owner}: target must be a TargetSpectrum, or the result of suite.scaling_to or "
        f"suite.selection_for for one at several periods, got {short_repr(value)}"
    )
    raise ComponentError(msg)


def available_motions(dataset: xr.Dataset, value: object, owner: str) -> dict[str, GroundMotion]:
    """Return available motions of a study: those given, else those in the dataset or process."""
    named = _read_motions(value, owner)
    if "motions_json" not in dataset.attrs:
        return named
    available = known_motions(dataset, value, owner=owner)
    described = described_motions(dataset, owner=owner).values()
    digests = {str(description.get("sha256")) for description in described if description}
    digests |= {motion.sha256 for motion in available.values()}
    unknown = [label for label, motion in named.items() if motion.sha256 not in digests]
    if unknown:
        msg = f"{owner}: the study has no motion with the samples of {unknown[0]!r}"
        raise ComponentError(msg)
    return available


def _read_motions(value: object, owner: str) -> dict[str, GroundMotion]:
    """Read a motion, or several."""
    if value is None:
        return {}
    several = [value] if isinstance(value, GroundMotion) else value
    if not is_iterable(several) or isinstance(several, str):
        msg = f"{owner}: motions must be a GroundMotion, or several, got {short_repr(value)}"
        raise ComponentError(msg)
    return dict(MotionSuite(cast("Iterable[GroundMotion]", several)))


def spectra_section(
    motions: Mapping[str, GroundMotion], comparison: TargetComparison | None, units: DisplayUnits
) -> Iterator[str]:
    """Return the spectra of motions with a target, and what is known of each motion."""
    damping = 0.05 if comparison is None else comparison.target.damping_ratio
    if comparison is not None:
        name = with_superscripts(units.convert_text(comparison.target.name))
        yield page.paragraph(
            f"Target: {name}. Compared at {comparison.periods.size} periods from "
            f"{comparison.periods[0]:.4g} s to {comparison.periods[-1]:.4g} s, "
            f"{100.0 * damping:g} % damping."
        )
    figure = plot.suite(
        motions, damping_ratio=damping,
        target=None if comparison is None else comparison.target,
        compared=None if comparison is None else comparison.period_range,
        average="mean", named=False, units=units.words, title=" ",
    )  # fmt: skip
    comparison_words = (
        "" if comparison is None else ", and the target; the band is where they are compared"
    )
    several = len(motions) > 1
    words = f"Response spectr{'a of the motions' if several else 'um of the motion'}"
    words += f" at {100.0 * damping:g} % damping{', their mean' * several}{comparison_words}."
    yield page.captioned_figure(figure, words)
    misfits: Numbers | None = None
    if comparison is not None:
        # scale factors of one, for the misfit of each motion as it is
        scaling = MotionSuite(motions).scaling_to(
            comparison.target, periods=(comparison.periods, str(Unit.SECOND)), bounds=(1.0, 1.0)
        )
        misfits = scaling["spectral_misfit"].to_numpy()
        if len(motions) > 1:
            spectra = scaling["scaled_spectral_acceleration"].mean("motion")
            ratios = (spectra / scaling["target_spectral_acceleration"]).to_numpy()
            least, greatest = (comparison.periods[k] for k in (ratios.argmin(), ratios.argmax()))
            yield page.paragraph(
                f"The mean of the motions is {ratios.min():.3g} to {ratios.max():.3g} times the "
                f"target, least at {least:.3g} s and greatest at {greatest:.3g} s."
            )
    yield _record_table(motions, misfits, units)


def _record_table(
    motions: Mapping[str, GroundMotion], misfits: Numbers | None, units: DisplayUnits
) -> str:
    """Return a table with a row for each motion, with what is known of its record."""
    columns = {
        name: values for name in RECORD_COLUMNS
        if not all(
            map(is_missing, values := [column_value(name, motion) for motion in motions.values()])
        )
    }  # fmt: skip
    if misfits is not None:
        columns["spectral_misfit"] = misfits.tolist()
    rows = [
        [label, *(_cell(name, values[place], units) for name, values in columns.items())]
        for place, label in enumerate(motions)
    ]
    return page.number_table(rows, ["motion", *(_column_title(name, units) for name in columns)])


def record_rows(motion: GroundMotion, units: DisplayUnits) -> list[tuple[str, str]]:
    """Return what is known of the record of a motion, without its peak."""
    columns = ((name, column_value(name, motion)) for name in RECORD_COLUMNS[:-1])
    return [
        (_column_title(name, units), _cell(name, value, units))
        for name, value in columns
        if not is_missing(value)
    ]


def _column_title(name: str, units: DisplayUnits) -> str:
    return column_title(name, str(SCHEMA[name].unit or Unit.ONE), _column_units(name, units))


def _column_units(name: str, units: DisplayUnits) -> DisplayUnits:
    """Return the units of a column: distances are in km, in whichever unit lengths are shown."""
    return _DISTANCE_UNITS if SCHEMA[name].unit is Unit.METRE else units


def _cell(name: str, value: Any, units: DisplayUnits) -> str:
    if is_missing(value):
        return "-"
    unit = SCHEMA[name].unit
    if unit is None:
        return str(value)
    return format_number(float(value), str(unit), _column_units(name, units))
