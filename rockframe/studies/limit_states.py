"""Limit states of a rocking body, and which runs exceed them."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_dataset
from rockframe.errors import ComponentError, SchemaError, shown
from rockframe.results.outcome import overturns
from rockframe.results.variables.runs import RunStatus
from rockframe.units import Condition, to_ratio

UPLIFT: Final = "uplift"
OVERTURNING: Final = "overturning"
_SHARE: Final = Condition("above 0 and below 1", lambda value: 0.0 < value < 1.0)
_NEEDED: Final = ("status", "peak_relative_rotation", "first_uplift_time", "overturned")
_TOLD: Final = ("run_json", "axes_json", "motions_json", "motion_names", "study_sha256")
"""Attributes of a sweep."""


@dataclass(frozen=True)
class LimitState:
    """What is asked of a run."""

    rotation: float  # peak rotation over the overturning angle: 0 is uplift, 1 overturning [1]

    @property
    def name(self) -> str:
        """Its label."""
        named = {0.0: UPLIFT, 1.0: OVERTURNING}
        return named.get(self.rotation, f"rotation {self.rotation:g}")


def limit_states(given: Iterable[object], *, owner: str) -> tuple[LimitState, ...]:
    """Read the argument ``limits``."""
    if isinstance(given, str | int | float):
        given = [given]
    found = {1.0}
    for one in given:
        if one == UPLIFT:
            found.add(0.0)
        elif one != OVERTURNING:
            found.add(
                to_ratio(
                    cast("Any", one), owner=owner, name="limits", condition=_SHARE, example="0.5"
                )
            )
    return tuple(LimitState(one) for one in sorted(found))


def check_runs(given: object, *, owner: str) -> xr.Dataset:
    """Refuse what is not the result of a sweep."""
    runs = checked_dataset(given, owner=owner)
    missing = [name for name in _NEEDED if name not in runs]
    if missing or not set(_TOLD) <= set(runs.attrs):
        what = f"a dataset without {', '.join(missing)}" if missing else "joined runs"
        what = what if missing or "end_state" not in runs.attrs else "a single run"
        msg = (
            f"{owner}: found {what}, which is no sweep; expected the result of rf.sweep, with its "
            "attributes"
        )
        raise SchemaError(msg)
    return runs


def exceeds(runs: xr.Dataset, state: LimitState) -> xr.DataArray:
    """Tell which runs exceed a limit state."""
    overturned = overturns(runs)
    if state.rotation == 1.0:
        return overturned
    beyond = (
        runs["first_uplift_time"].notnull()
        if state.rotation == 0.0
        else runs["peak_relative_rotation"] >= state.rotation
    )
    known = runs["peak_relative_rotation"].notnull()
    return (beyond | (runs["overturned"] == 1)).astype(float).where(known)


def interrupted(runs: xr.Dataset) -> bool:
    """Tell whether some cases have not been run."""
    return bool(np.any(runs["status"].to_numpy() == RunStatus.NOT_RUN))


def check_names(given: object, known: Iterable[str], *, owner: str, name: str) -> str:
    """Read an argument that is one of some names."""
    listed = list(known)
    if isinstance(given, str) and given in listed:
        return given
    msg = f"{owner}: {name} must be one of {', '.join(listed)}, got {shown(given)}"
    raise ComponentError(msg)
