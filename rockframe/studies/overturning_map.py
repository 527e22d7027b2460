"""Which pulses overturn a block: a map over their amplitude and frequency."""

import math
from collections.abc import Callable, Iterable
from typing import Any, Final, Unpack

import numpy as np
import xarray as xr

from rockframe.arguments import checked_function, checked_integer
from rockframe.errors import ComponentError, UnitsError, short_repr
from rockframe.motion import GroundMotion
from rockframe.results.outcome import overturns
from rockframe.results.schema import SCHEMA, with_labels, with_variables
from rockframe.results.variables.studies import MOTION
from rockframe.shared_arguments import with_shared_arguments
from rockframe.signals.arrays import Array
from rockframe.signals.motion import absolute_peak
from rockframe.simulation.system import System, check_system
from rockframe.studies.line_scan import SCAN_SOURCE, VERDICT_DIM, LineScan, read_sorted, read_width
from rockframe.studies.sweeps.arguments import SweepArguments
from rockframe.studies.sweeps.motions import SCALE
from rockframe.system.options import Overturning
from rockframe.system.rigid_ground import RigidGroundSetting
from rockframe.units import ACCELERATION, FREQUENCY, TIME, RatioLike, quantity

_OWNER: Final = "overturning_map"
_EXAMPLE: Final = "lambda a, f: rf.GroundMotion.ricker_wavelet(a, 1 / f)"
_STANDING: Final = -1.0
_MAX_IMPACTS: Final = 1000
_PEAK_TOLERANCE: Final = 1e-6
"""Relative difference up to which peaks of pulses of one amplitude count as equal [1]."""


@with_shared_arguments(SweepArguments, overturning=Overturning.CONTINUE)
def overturning_map(
    system: System,
    pulse: GroundMotion | Callable[..., GroundMotion],
    *,
    amplitude: Any,
    frequency: Any,
    impacts: int = 3,
    bracket_width: RatioLike = 1e-3,
    **run: Unpack[SweepArguments],
) -> xr.Dataset:
    """Run pulses at a grid of amplitudes and frequencies, and find the boundaries of overturning.

    Parameters
    ----------
    system : System
        The scene.
    pulse : GroundMotion or callable
        An analytic pulse with an amplitude and a frequency or a period, which are replaced; or a
        function of amplitude and frequency, as Quantities, that returns a motion, such as
        ``rf.GroundMotion.sine_pulse``. The motion must be proportional to the amplitude.
    amplitude : values with a unit
        Positive amplitudes that are run first: ``([1, 2, 3], "m/s^2")`` [m s^-2].
    frequency : values with a unit
        Cyclic frequencies: ``([0.5, 1, 2], "Hz")`` [Hz].
    impacts : int, optional
        Number of impacts from which modes of overturning are no longer distinguished.
    bracket_width : float, optional
        Width of the brackets of boundaries, relative to their upper end [1].

    Returns
    -------
    xarray.Dataset
        The sweep over ``amplitude`` and ``frequency``, with ``impacts_before_overturning``, NaN
        where the block stands, or where the run has no verdict (``status``). Over ``frequency``:
        ``boundary_count``. Also over ``boundary``: ``amplitude_below`` and ``amplitude_above`` [m
        s^-2], ``impacts_below`` and ``impacts_above``, NaN beyond the last boundary. On rigid
        ground also the coordinates ``relative_pulse_frequency`` and, where all pulses of an
        amplitude have one peak, ``relative_peak_ground_acceleration`` [1]. :func:`rockframe.case`
        returns any case.

    Raises
    ------
    UnitsError, ComponentError
        An argument is out of range, has a wrong unit or none; or the pulse has no amplitude
        and frequency.
    StudyError
        As for :func:`rockframe.sweep`.

    Notes
    -----
    Blocks overturn without an impact, or after one or more (Zhang and Makris, 2001); between the
    two there may be a range of amplitudes at which the block stands. A boundary is therefore where
    the number of impacts before overturning changes. A bracket at whose middle the block stands is
    split into two. Between neighbouring amplitudes of the first runs that overturn in different
    modes, a standing range is found only if a midpoint of the bisection lies in it.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> found = rf.overturning_map(
    ...     system,
    ...     rf.GroundMotion.sine_pulse,
    ...     amplitude=([2, 4, 6], "m/s^2"),
    ...     frequency=([1, 2], "Hz"),
    ...     free_vibration="5 s",
    ... )
    >>> dict(found.impacts_before_overturning.sizes)
    {'amplitude': 3, 'frequency': 2}
    """
    check_system(system, _OWNER)
    amplitudes = read_sorted(amplitude, ACCELERATION, "amplitude", owner=_OWNER)
    frequencies = read_sorted(frequency, FREQUENCY, "frequency", owner=_OWNER)
    most = checked_integer(impacts, owner=_OWNER, name="impacts", lowest=1, highest=_MAX_IMPACTS)
    width = read_width(bracket_width, owner=_OWNER)
    motions = {
        f"{value!r} {FREQUENCY.unit}": _unit_pulse(pulse, value) for value in frequencies.tolist()
    }

    def modes(runs: xr.Dataset) -> xr.DataArray:
        verdict = overturns(runs)
        counted = runs["impact_count"].clip(max=most).astype(float)
        return xr.where(verdict == 0.0, _STANDING, counted).where(verdict.notnull())

    def verdicts(runs: xr.Dataset) -> xr.DataArray:
        return modes(runs).expand_dims(VERDICT_DIM)

    lines = LineScan(system, motions, {}, run, _OWNER, verdicts)
    result = lines.run_scan(amplitudes, width=width)
    counted = modes(result.scan)
    impacts_of_runs = {"impacts_before_overturning": _nan_if_standing(counted.to_numpy())}
    dataset = with_variables(result.scan, impacts_of_runs, over=tuple(map(str, counted.dims)))
    below, above, before, after = result.arrays((len(motions),))
    of_frequencies = {
        "boundary_count": np.isfinite(below).sum(axis=1),
        "amplitude_below": below,
        "amplitude_above": above,
        "impacts_below": _nan_if_standing(before),
        "impacts_above": _nan_if_standing(after),
    }
    dataset = with_variables(dataset, of_frequencies, over=(MOTION,))
    dataset = with_labels(dataset, _labels(system, amplitudes, frequencies, motions.values()))
    dataset = dataset.swap_dims({SCALE: "amplitude", MOTION: "frequency"})
    dataset.attrs |= {
        "title": "Overturning by pulses",
        "source": SCAN_SOURCE,
        "bracket_width": width,
        "impacts_told_apart": most,
    }
    return dataset


def _unit_pulse(pulse: object, frequency: float) -> GroundMotion:
    """Return the pulse of a frequency, with an amplitude of one."""
    if isinstance(pulse, GroundMotion):
        described = pulse.to_dict()
        times = {
            "frequency": f"{frequency!r} {FREQUENCY.unit}",
            "period": f"{1.0 / frequency!r} {TIME.unit}",
        }
        replaced = {name: text for name, text in times.items() if name in described}
        if "amplitude" not in described or not replaced or "operations" in described:
            needed = "an amplitude and a frequency or a period, without operations such as scaled"
            msg = (
                f"{_OWNER}: pulse needs {needed}, got {pulse.name!r}; give a function of "
                f"amplitude and frequency, {_EXAMPLE}"
            )
            raise ComponentError(msg)
        sign = "-" if str(described["amplitude"]).startswith("-") else ""
        replaced["amplitude"] = f"{sign}1 {ACCELERATION.unit}"
        return GroundMotion.from_dict({**described, **replaced})
    if not callable(pulse):
        msg = (
            f"{_OWNER}: pulse must be a GroundMotion or a function such as "
            f"rf.GroundMotion.sine_pulse, or {_EXAMPLE}, got {short_repr(pulse)}"
        )
        raise ComponentError(msg)
    pulse = checked_function(pulse, "amplitude", "frequency", owner=_OWNER, name="pulse")
    try:
        motion = pulse(quantity(1.0, ACCELERATION), quantity(frequency, FREQUENCY))
    except UnitsError as problem:
        msg = (
            f"{_OWNER}: pulse is called with an acceleration and a frequency, as is {_EXAMPLE}; "
            f"{problem}"
        )
        raise UnitsError(msg) from problem
    if not isinstance(motion, GroundMotion):
        msg = f"{_OWNER}: pulse must return a GroundMotion, got {short_repr(motion)}"
        raise ComponentError(msg)
    return motion


def _nan_if_standing(counts: Array) -> Array:
    return np.where(counts == _STANDING, np.nan, counts)


def _labels(
    system: System, levels: Array, frequencies: Array, pulses: Iterable[GroundMotion]
) -> dict[str, Any]:
    """Return the coordinates; on rigid ground also those without a dimension."""
    rows = [("amplitude", SCALE, levels), ("frequency", MOTION, frequencies)]
    setting = system.setting
    if isinstance(setting, RigidGroundSetting):
        uplift = min(setting.uplift_accelerations)
        angular = 2.0 * math.pi * frequencies
        block_frequency = setting.body.frequency_at(system.options.gravity)
        rows.append(("relative_pulse_frequency", MOTION, angular / block_frequency))
        # of amplitude one, which need not be the peak, as in less than a quarter of a sine
        peaks = np.array([absolute_peak(pulse.si.horizontal.pieces) for pulse in pulses])
        if np.ptp(peaks) <= _PEAK_TOLERANCE * peaks.max():
            rows.append(("relative_peak_ground_acceleration", SCALE, levels * peaks[0] / uplift))
    labels = {name: (dim, values, SCHEMA[name].attributes()) for name, dim, values in rows}
    labels["frequency"][2]["long_name"] = "cyclic frequency of the pulse"
    return labels
