"""The motions in a report: metadata of their records, spectra, and the target."""

import json
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
from rockframe.reports.values import column_head, number_in
from rockframe.results.schema import SCHEMA
from rockframe.studies.sweeps.case import known_motions
from rockframe.suites import MotionSuite, TargetSpectrum
from rockframe.suites.candidates import default_periods
from rockframe.suites.columns import column_value, is_missing
from rockframe.suites.scaling import compared_target
from rockframe.units import Unit
from rockframe.units.display import DisplayUnits, display_units, with_superscripts

OF_RECORDS: Final = (
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
_DISTANCES: Final = display_units({"length": "km"}, owner="report")
_PERIODS: Final = (np.geomspace(0.05, 5.0, 80), str(Unit.SECOND))


@dataclass(frozen=True)
class Aim:
    """A target spectrum, and the periods at which motions are compared with it."""

    target: TargetSpectrum
    periods: Numbers  # increasing [s]

    @property
    def ends(self) -> tuple[str, str]:
        """The shortest and the longest period."""
        first, last = (f"{one!r} {Unit.SECOND}" for one in self.periods[[0, -1]].tolist())
        return first, last


def aim_of(value: object, motions: object, owner: str) -> Aim | None:
    """Read a target, or take that of a suite that was scaled to one."""
    if value is None:
        carried = motions.target if isinstance(motions, MotionSuite) else None
        return None if carried is None else Aim(carried, np.geomspace(*carried.limits, 40))
    if isinstance(value, TargetSpectrum):
        return Aim(value, default_periods(value))
    if isinstance(value, xr.Dataset) and "target_spectral_acceleration" in value:
        target = compared_target(value)
        if target is not None:
            return Aim(target, value["period"].to_numpy())
    msg = (
        f"{owner}: target must be a TargetSpectrum, or the result of suite.scaling_to or "
        f"suite.selection_for for one at several periods, got {short_repr(value)}"
    )
    raise ComponentError(msg)


def motions_of(dataset: xr.Dataset, value: object, owner: str) -> dict[str, GroundMotion]:
    """Return available motions of a study: those given, else those in the dataset or process."""
    named = _named(value, owner)
    if "motions_json" not in dataset.attrs:
        return named
    found = known_motions(dataset, value)
    digests = {str(one.get("sha256")) for one in json.loads(dataset.attrs["motions_json"]) if one}
    held = {motion.sha256 for motion in found.values()} | digests
    strange = [label for label, motion in named.items() if motion.sha256 not in held]
    if strange:
        msg = f"{owner}: the study has no motion with the samples of {strange[0]!r}"
        raise ComponentError(msg)
    return found


def _named(value: object, owner: str) -> dict[str, GroundMotion]:
    """Read a motion, or several."""
    if value is None:
        return {}
    several = [value] if isinstance(value, GroundMotion) else value
    if not is_iterable(several) or isinstance(several, str):
        msg = f"{owner}: motions must be a GroundMotion, or several, got {short_repr(value)}"
        raise ComponentError(msg)
    return dict(MotionSuite(cast("Iterable[GroundMotion]", several)))


def spectra_section(
    motions: Mapping[str, GroundMotion], aim: Aim | None, units: DisplayUnits
) -> Iterator[str]:
    """Return the spectra of motions with a target, and what is known of each motion."""
    damping = 0.05 if aim is None else aim.target.damping_ratio
    if aim is not None:
        name = with_superscripts(units.convert_text(aim.target.name))
        yield page.paragraph(
            f"Target: {name}. Compared at {aim.periods.size} periods from {aim.periods[0]:.4g} s "
            f"to {aim.periods[-1]:.4g} s, {100.0 * damping:g} % damping."
        )
    drawn = plot.suite(
        motions, _PERIODS, damping,
        target=None if aim is None else aim.target,
        compared=None if aim is None else aim.ends,
        average="mean", named=False, units=units.words, title=" ",
    )  # fmt: skip
    behind = "" if aim is None else ", and the target; the band is where they are compared"
    several = len(motions) > 1
    words = f"Response spectr{'a of the motions' if several else 'um of the motion'}"
    words += f" at {100.0 * damping:g} % damping{', their mean' * several}{behind}."
    yield page.picture(drawn, words)
    misfits: Numbers | None = None
    if aim is not None:
        # scale factors of one, for the misfit of each motion as it is
        found = MotionSuite(motions).scaling_to(
            aim.target, periods=(aim.periods, str(Unit.SECOND)), bounds=(1.0, 1.0)
        )
        misfits = found["spectral_misfit"].to_numpy()
        if len(motions) > 1:
            spectra = found["scaled_spectral_acceleration"].mean("motion")
            over = spectra / found["target_spectral_acceleration"]
            yield page.paragraph(_of_the_mean(over.to_numpy(), aim.periods))
    yield _records(motions, misfits, units)


def _of_the_mean(over: Numbers, periods: Numbers) -> str:
    """Write the range of the ratio of the mean spectrum to the target."""
    least, most = int(over.argmin()), int(over.argmax())
    return (
        f"The mean of the motions is {over[least]:.3g} to {over[most]:.3g} times the target, least "
        f"at {periods[least]:.3g} s and greatest at {periods[most]:.3g} s."
    )


def _records(
    motions: Mapping[str, GroundMotion], misfits: Numbers | None, units: DisplayUnits
) -> str:
    """Return a table with a row for each motion, with what is known of its record."""
    known = {
        name: values for name in OF_RECORDS
        if not all(map(is_missing, values := [column_value(name, one) for one in motions.values()]))
    }  # fmt: skip
    if misfits is not None:
        known["spectral_misfit"] = misfits.tolist()
    rows = [
        [label, *(_cell(name, values[place], units) for name, values in known.items())]
        for place, label in enumerate(motions)
    ]
    return page.columns(rows, ["motion", *(_head(name, units) for name in known)])


def record_rows(motion: GroundMotion, units: DisplayUnits) -> list[tuple[str, str]]:
    """Return what is known of the record of a motion, without its peak."""
    found = ((name, column_value(name, motion)) for name in OF_RECORDS[:-1])
    return [
        (_head(name, units), _cell(name, value, units))
        for name, value in found
        if not is_missing(value)
    ]


def _head(name: str, units: DisplayUnits) -> str:
    return column_head(name, str(SCHEMA[name].unit or Unit.ONE), _of(name, units))


def _of(name: str, units: DisplayUnits) -> DisplayUnits:
    """Return the units of a column: distances are in km, in whichever unit lengths are shown."""
    return _DISTANCES if SCHEMA[name].unit is Unit.METRE else units


def _cell(name: str, value: Any, units: DisplayUnits) -> str:
    if is_missing(value):
        return "-"
    unit = SCHEMA[name].unit
    return str(value) if unit is None else number_in(float(value), str(unit), _of(name, units))
