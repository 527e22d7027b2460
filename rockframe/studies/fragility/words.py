"""A fragility in words: what was fitted, what was left out, and how often its bounds hold."""

import math
from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
import xarray as xr

from rockframe.results.schema import SCHEMA, labels_in_unit
from rockframe.results.variables.analyses import LIMIT_STATE, FragilityStatus
from rockframe.results.variables.variable import unit_suffix_of
from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.fragility.likelihood import Bands
from rockframe.studies.intensities import PERIOD_ATTRIBUTE, measure_words
from rockframe.units import Unit

_INTENSITIES: Final = "median_intensity", "stripe_intensity"
_RATIOS: Final = "dispersion", "exceedance_probability"
"""Beginnings of the names of variables in the unit of the measure, and of those that are ratios."""
POOLED_ATTRIBUTE: Final = "pooled"
"""Attribute that names the structures that were treated as one."""


def pooled_attribute(axes: Sequence[str]) -> dict[str, str]:
    """Return the attribute that names the structures that were treated as one, if there are any."""
    return {POOLED_ATTRIBUTE: ", ".join(axes)} if axes else {}


class Coverage(NamedTuple):
    """Shares of simulated samples in which bounds of nominal 95 % held the true value [1]."""

    median: float
    dispersion: float


COVERAGE: Final = {
    Bands.PROFILE: {5: Coverage(0.90, 0.89), 10: Coverage(0.93, 0.93)},
    Bands.JACKKNIFE: {5: Coverage(0.97, 0.99)},
    Bands.SANDWICH: {
        10: Coverage(0.89, 0.80),
        20: Coverage(0.92, 0.87),
        40: Coverage(0.94, 0.91),
        80: Coverage(0.95, 0.92),
    },
}
"""By numbers of independent trials or motions; with fewer than the least there are no bounds, with
the greatest they have nominal coverage. Measured, :ref:`coverage of bounds <coverage>`."""


def enough_trials(bands: Bands, independent: int) -> bool:
    """Tell whether there are enough independent trials for bounds."""
    return independent >= min(COVERAGE[bands])


def fragility_sentences(fragility: xr.Dataset) -> str:
    """Say what was fitted to the last limit state, what was left out, and what bounds are."""
    last = fragility.isel({dim: -1 for dim in LIMIT_STATE if dim in fragility.dims})
    status = last["fragility_status"].to_numpy().ravel()
    fitted = status == FragilityStatus.FITTED
    messages = [_fit_sentence(last, status, fitted)]
    if fitted.any():
        messages += _extrapolation_sentences(last, fitted)
        messages += _near_separation_sentences(last, fitted)
        independent, trials = (
            last[f"{name}_count"].to_numpy().ravel()[fitted] for name in ("independent", "trial")
        )
        bands, kind = Bands(last.attrs["bands"]), last.attrs["trials"]
        messages += bound_sentences(
            bands, last.attrs["confidence"], independent, trials,
            kind="trials" if kind == "trials" else "motions", measures=len(measures_of(last)),
        )  # fmt: skip
    else:
        # as when no run overturns: the last limit state with a fit
        for number in reversed(range(fragility.sizes.get(*LIMIT_STATE, 1) - 1)):
            state = fragility.isel({LIMIT_STATE[0]: number})
            status = state["fragility_status"].to_numpy().ravel()
            fitted = status == FragilityStatus.FITTED
            if fitted.any() or (status == FragilityStatus.SEPARATED).any():
                messages.append(_fit_sentence(state, status, fitted))
                break
    if last.attrs.get("dispersions") == "common":
        messages.append("One dispersion is common to all limit states.")
    known, left_out = (int(last[f"{name}_count"].sum()) for name in ("trial", "left_out"))
    below = int(last["below_scan_count"].sum()) if "below_scan_count" in last else 0
    if below:  # a scan that starts too high does not separate them from zero
        messages.append(
            f"{below} of {known} capacities are only known to lie at or below the least scale."
        )
    if left_out:
        messages.append(
            f"{left_out} of {left_out + known} {last.attrs['trials']} are left out: they have no "
            "verdict, or no intensity above zero."
        )
    return " ".join(messages)


def verdict_of_fragility(dataset: xr.Dataset) -> str:
    """Say what was fitted; for a part of a fragility, what was fitted of that part."""
    text = str(dataset.attrs.get("verdict", ""))
    if "independent_count" not in dataset:  # as of a cloud
        return text
    sentences = fragility_sentences(dataset)
    return text if text.startswith(sentences) else sentences


def measures_of(fragility: xr.Dataset) -> list[str]:
    """Return the intensity measures of a fragility."""
    status = fragility["fragility_status"].dims
    return [str(dim) for dim in fragility["exceedance_probability"].dims if dim not in status]


def in_own_units(fragility: xr.Dataset, measure: str, *, owner: str) -> xr.Dataset:
    """Return intensities and ratios in their units, where a user has put them into others."""
    # the unit of a measure of the user's own is not known
    of_measure = SCHEMA[measure].unit if measure in SCHEMA else None
    units = dict.fromkeys((measure, *_INTENSITIES), of_measure) | dict.fromkeys(_RATIOS, Unit.ONE)
    converted = {
        name: labels_in_unit(fragility[name], unit, owner=owner).variable
        for name in fragility.variables
        for start, unit in units.items()
        if str(name).startswith(start)
    }
    return fragility.assign(converted)


def _fit_sentence(last: xr.Dataset, status: AnyArray, fitted: AnyArray) -> str:
    """Tell the fit of one structure, or the range of several."""
    names = measures_of(last)
    over = " and ".join(measure_words(name, last.attrs.get(PERIOD_ATTRIBUTE)) for name in names)
    state = str(last["limit_state"].item()) if "limit_state" in last.coords else "what was counted"
    by = ", ".join(map(str, last["fragility_status"].dims))
    aside = [f"{len(status)} structures by {by}"] if len(status) > 1 else []
    if POOLED_ATTRIBUTE in last.attrs:
        aside.append(f"pooled over {last.attrs[POOLED_ATTRIBUTE]}")
    head = f"{state} ({'; '.join(aside)})" if aside else state
    if not fitted.any():
        whys = (FragilityStatus(code).name.lower().replace("_", " ") for code in status)
        why = ", ".join(dict.fromkeys(whys))
        text = f"Against {head} no lognormal capacity fits over {over}: {why}."
        return text + _separation_sentence(last)
    note = f"; to {int((~fitted).sum())} of them none fits" if not fitted.all() else ""
    if len(names) > 1:
        return f"Capacity against {head} fitted over {over}{note}."
    unit = unit_suffix_of(last["median_intensity"].attrs)
    median, dispersion = (
        _range_words(last[name].to_numpy().ravel()[fitted], digits)
        for name, digits in (("median_intensity", 4), ("dispersion", 3))
    )
    return f"Capacity against {head}: median {over} {median}{unit}, dispersion {dispersion}{note}."


def _range_words(values: Array, digits: int) -> str:
    least, most = float(values.min()), float(values.max())
    if len(values) == 1:
        return f"{least:.{digits}g}"
    return f"from {least:.{digits}g} to {most:.{digits}g}"


def _separation_sentence(last: xr.Dataset) -> str:
    """Say what is known of one structure whose trials are separated by an intensity."""
    status = last["fragility_status"].to_numpy().ravel()
    if list(status) != [FragilityStatus.SEPARATED] or "separation_lower_intensity" not in last:
        return ""
    low, high = (last[f"separation_{end}_intensity"].item() for end in ("lower", "upper"))
    unit = unit_suffix_of(last["median_intensity"].attrs)
    words = f" None exceeded up to {low:.4g}{unit}, all did from {high:.4g} on: so the "
    words += "dispersion is not known, only that it may be small"
    ends = [
        float(last[f"{name}_bound"].item())
        for name in ("median_intensity_lower", "median_intensity_upper", "dispersion_upper")
    ]
    if any(map(math.isnan, ends)):
        return f"{words}, and there are no bounds."
    least, most, spread = ends
    level = f"{100.0 * last.attrs['confidence']:g} %"
    return (
        f"{words}. By the likelihood of nominal {level} the median lies from {least:.4g} to "
        f"{most:.4g}{unit}, the dispersion is at most {spread:.3g}."
    )


def _extrapolation_sentences(last: xr.Dataset, fitted: AnyArray) -> Iterator[str]:
    """Say how many medians lie beyond all intensities of the runs."""
    names = measures_of(last)
    if len(names) != 1 or "stripe_intensity" not in last:
        return
    # the stripes hold also where a user has cut off a part of the curves
    tried = np.concatenate([last[names[0]].to_numpy(), last["stripe_intensity"].to_numpy()])
    least, most = tried.min(), tried.max()
    medians = last["median_intensity"].to_numpy().ravel()[fitted]
    if count := int(((medians < least) | (medians > most)).sum()):
        which = "The median is" if len(fitted) == 1 else f"The medians of {count} structures are"
        unit = unit_suffix_of(last[names[0]].attrs)
        yield (
            f"{which} extrapolated: the intensities of all {last.attrs['trials']} are from "
            f"{least:.4g} to {most:.4g}{unit}."
        )


def _near_separation_sentences(last: xr.Dataset, fitted: AnyArray) -> Iterator[str]:
    """Say in how many fits a single motion keeps the trials from being separated."""
    if last.attrs["bands"] != Bands.JACKKNIFE or "dispersion" not in last:
        return
    unbounded = np.isnan(last["dispersion_upper_bound"].to_numpy().ravel()[fitted])
    enough = last["independent_count"].to_numpy().ravel()[fitted] >= min(COVERAGE[Bands.JACKKNIFE])
    if count := int((unbounded & enough).sum()):
        of = "" if len(fitted) == 1 else f" of {count} structure{'s' if count > 1 else ''}"
        yield (
            f"There are no bounds{of}: without one of the motions there is no fit, for hardly any "
            "run exceeds below one that does not."
        )


def bound_sentences(
    bands: Bands,
    confidence: float,
    independent: Array,
    trials: Array,
    *,
    kind: str,
    measures: int = 1,
) -> list[str]:
    """Say what is wrong with bounds."""
    known = COVERAGE[bands]
    least, fewest = int(independent.min()), min(known)
    if least < fewest:
        which = "no bounds" if (independent < fewest).all() else "no bounds of some"
        few = f"1 {kind.removesuffix('s')} is" if least == 1 else f"{least} {kind} are"
        return [f"There are {which}: {few} too few, {fewest} are needed."]
    nominal = f"bounds of nominal {100.0 * confidence:g} % are too narrow"
    if bands is Bands.PROFILE and (independent < trials).any():
        return [f"The {nominal}: they take runs under one motion for independent."]
    if least >= max(known):
        return []
    if measures > 1:
        return [f"With {least} {kind} {nominal}."]
    size = max(size for size in known if size <= least)
    median, dispersion = (100.0 * share for share in known[size])
    return [
        f"With {least} {kind} {nominal}: of {size}, those of 95 % held the median in "
        f"{median:.0f} %, the dispersion in {dispersion:.0f} % of simulated samples."
    ]
