"""A fragility in words: what was fitted, what was left out, and what its bounds are."""

from collections.abc import Iterator
from typing import Final

import xarray as xr

from rockframe.results.outcome import Generic
from rockframe.results.variables.analyses import LIMIT_STATE, FragilityStatus
from rockframe.signals.arrays import Array
from rockframe.studies.fragility.coverage import words_of_bounds
from rockframe.studies.fragility.likelihood import Bands
from rockframe.studies.intensities import PERIOD_OF, in_words

POOLED: Final = "pooled"
"""Attribute that tells which structures were taken for one."""
_DIGITS: Final = (4, 3)
"""Of medians and of dispersions."""


def sentences(fragility: xr.Dataset) -> str:
    """Tell what was fitted to the last limit state, what was left out, and what bounds are.

    Parameters
    ----------
    fragility : xarray.Dataset
        Or part of it, such as that of one structure.

    Returns
    -------
    str
    """
    last = fragility.isel({dim: -1 for dim in LIMIT_STATE if dim in fragility.dims})
    status = last["fragility_status"].to_numpy().ravel()
    fitted = status == FragilityStatus.FITTED
    said = [_fit(last, status, fitted)]
    if fitted.any():
        independent, trials = (
            last[f"{name}_count"].to_numpy().ravel()[fitted] for name in ("independent", "trial")
        )
        bands, kind = Bands[last.attrs["bands"].upper()], last.attrs["trials"]
        said += words_of_bounds(
            bands, last.attrs["confidence"], independent, trials,
            kind="trials" if kind == "trials" else "motions", measures=len(measures_of(last)),
        )  # fmt: skip
    return " ".join([*said, *_below_scan(last), *_left_out(last)])


def measures_of(fragility: xr.Dataset) -> list[str]:
    """Give the intensity measures of a fragility."""
    status = fragility["fragility_status"].dims
    return [str(dim) for dim in fragility["exceedance_probability"].dims if dim not in status]


def _fit(last: xr.Dataset, status: Generic, fitted: Generic) -> str:
    """Tell the fit of one structure, or the range of several."""
    names = measures_of(last)
    over = " and ".join(in_words(name, last.attrs.get(PERIOD_OF)) for name in names)
    state = str(last["limit_state"].item()) if "limit_state" in last.coords else "what was counted"
    by = ", ".join(map(str, last["fragility_status"].dims))
    aside = [f"{len(status)} structures by {by}"] if len(status) > 1 else []
    aside += [f"pooled over {last.attrs[POOLED]}"] if POOLED in last.attrs else []
    head = f"{state} ({'; '.join(aside)})" if aside else state
    if not fitted.any():
        why = ", ".join(dict.fromkeys(_why(one) for one in status))
        return f"Against {head} no lognormal capacity fits over {over}: {why}.{_separation(last)}"
    rest = f"; to {int((~fitted).sum())} of them none fits" if not fitted.all() else ""
    if len(names) > 1:
        return f"Capacity against {head} fitted over {over}{rest}."
    unit = _unit(last)
    median, dispersion = (
        _range(last[name].to_numpy().ravel()[fitted], digits)
        for name, digits in zip(("median_intensity", "dispersion"), _DIGITS, strict=True)
    )
    return f"Capacity against {head}: median {over} {median}{unit}, dispersion {dispersion}{rest}."


def _unit(last: xr.Dataset) -> str:
    unit = str(last["median_intensity"].attrs.get("units", "1"))
    return "" if unit == "1" else f" {unit}"


def _why(status: int) -> str:
    return FragilityStatus(status).name.lower().replace("_", " ")


def _range(values: Array, digits: int) -> str:
    least, most = float(values.min()), float(values.max())
    if len(values) == 1:
        return f"{least:.{digits}g}"
    return f"from {least:.{digits}g} to {most:.{digits}g}"


def _separation(last: xr.Dataset) -> str:
    """Tell what is known of one structure whose trials an intensity parts."""
    status = last["fragility_status"].to_numpy().ravel()
    if list(status) != [FragilityStatus.SEPARATED] or "separation_lower_intensity" not in last:
        return ""
    low, high = (last[f"separation_{end}_intensity"].item() for end in ("lower", "upper"))
    return (
        f" None exceeded up to {low:.4g}{_unit(last)}, all did from {high:.4g} on: so the "
        "dispersion is not known, only that it may be small, and there are no bounds."
    )


def _below_scan(last: xr.Dataset) -> Iterator[str]:
    """Tell how many capacities a scan that starts too high does not part from zero."""
    below = int(last["below_scan_count"].sum()) if "below_scan_count" in last else 0
    if below:
        known = int(last["trial_count"].sum())
        yield f"{below} of {known} capacities are only known to lie at or below the least scale."


def _left_out(last: xr.Dataset) -> Iterator[str]:
    lacking, count = (int(last[f"{name}_count"].sum()) for name in ("left_out", "trial"))
    if lacking:
        yield (
            f"{lacking} of {lacking + count} {last.attrs['trials']} are left out: they have no "
            "verdict, or no intensity above zero."
        )
