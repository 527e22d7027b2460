"""How far a run is from another; NaN where one of them was cut off before its verdict."""

import numpy as np
import xarray as xr

from rockframe.results.outcome import verdict_of


def verdicts_agree(run: xr.Dataset, reference: xr.Dataset) -> bool:
    """Tell whether two runs have verdicts, and the same."""
    return verdict_of(run) is not None and verdict_of(run) == verdict_of(reference)


def relative_peak_error(run: xr.Dataset, reference: xr.Dataset) -> float:
    """Compare peak rotations, relative to that of the reference."""
    if _cut_off(run, reference):
        return float("nan")
    peak = float(reference["peak_rotation"])
    return _relative(abs(float(run["peak_rotation"]) - peak), peak)


def history_error(run: xr.Dataset, reference: xr.Dataset) -> float:
    """Compare rotations along time, as far as both go, relative to the reference's peak."""
    if _cut_off(run, reference):
        return float("nan")
    one, other = (data["rotation"].to_numpy() for data in (run, reference))
    times = [data["time"].to_numpy() for data in (run, reference)]
    count = min(one.size, other.size)
    while count > 0 and times[0][count - 1] != times[1][count - 1]:
        count -= 1  # the instant at which a run ended is no common sample
    peak = float(np.max(np.abs(other[:count]), initial=0.0))
    return _relative(float(np.max(np.abs(one[:count] - other[:count]), initial=0.0)), peak)


def event_time_error(run: xr.Dataset, reference: xr.Dataset) -> float:
    """Compare the times of events [s]; NaN if the runs have other events."""
    if _cut_off(run, reference):
        return float("nan")
    if not np.array_equal(run["event_kind"].to_numpy(), reference["event_kind"].to_numpy()):
        return float("nan")
    difference = run["event_time"].to_numpy() - reference["event_time"].to_numpy()
    return float(np.max(np.abs(difference), initial=0.0))


def _cut_off(*runs: xr.Dataset) -> bool:
    return any(verdict_of(run) is None for run in runs)


def _relative(difference: float, scale: float) -> float:
    if difference == 0.0:
        return 0.0
    return difference / scale if scale > 0.0 else float("inf")
