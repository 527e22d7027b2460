"""Functions that the operations share: the resulting motion, and checks of a second motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Final

from rockframe.errors import ComponentError, RecordWarning, warn
from rockframe.motion.value import MotionType, MotionValue
from rockframe.records import same_start, time_after
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import Array

SAME_STEP: Final = 1e-9
"""Relative difference up to which two time steps count as equal [1]."""

_SPECTRUM_METADATA: Final = (
    "spectral_misfit", "largest_spectral_misfit", "mean_spectral_misfit", "target_reached",
)  # fmt: skip
"""Metadata on the misfit of a spectrum, which operations that change the spectrum drop."""

_RECORD_START: Final = "record_time"
_FILE_START: Final = "start_time"
"""Time of the first sample in the column of times of the file [s]."""

VERTICAL_PREFIX: Final = "vertical_"
"""Prefix of the metadata of a vertical component."""

_DROPPED_NOTE: Final = "the analytic pieces between samples are replaced by straight lines"


def derived_motion(
    motion: MotionType,
    si: Motion,
    *steps: str,
    operation: Mapping[str, Any] | None = None,
    metadata: Mapping[str, Any] | None = None,
    same_spectrum: bool = False,
) -> MotionType:
    """Return the result of an operation as a motion; metadata that are None are left out."""
    recipe = None
    if motion.recipe is not None and operation is not None:
        operations = [*motion.recipe.get("operations", ()), dict(operation)]
        recipe = {**motion.recipe, "operations": operations}
    lost: tuple[str, ...] = () if same_spectrum else _SPECTRUM_METADATA
    if lost and si.vertical is not motion.si.vertical:
        lost += tuple(f"{VERTICAL_PREFIX}{name}" for name in _SPECTRUM_METADATA)
    added: dict[str, Any] = {k: value for k, value in motion.metadata.items() if k not in lost}
    added |= metadata or {}
    return type(motion)(
        si,
        name=motion.name,
        metadata={key: value for key, value in added.items() if value is not None},
        history=(*motion.history, *steps),
        recipe=recipe,
    )


def dropped_pieces_note(si: Motion) -> tuple[str, ...]:
    """Return the sentence that processing drops the analytic pieces, if there are any."""
    return (_DROPPED_NOTE,) if si.analytic else ()


def map_samples(
    si: Motion, change: Callable[[Signal], Array], time_step: float | None = None
) -> Motion:
    """Change the samples of both components; analytic pieces between them are dropped."""
    step = si.time_step if time_step is None else time_step

    def changed(signal: Signal) -> Signal:
        return replace(signal, time_step=step, samples=change(signal), polynomials=None)

    return si.each(changed)


def checked_other_motion(other: object, si: Motion, owner: str) -> MotionValue:
    """Check a second motion that is to be combined with the first."""
    if not isinstance(other, MotionValue):
        msg = f"{owner}: other needs a GroundMotion, got {type(other).__name__}"
        raise ComponentError(msg)
    theirs = other.si
    if not math.isclose(theirs.time_step, si.time_step, rel_tol=SAME_STEP):
        msg = (
            f"{owner}: time steps differ, {si.time_step!r} s and {theirs.time_step!r} s; "
            f"resample one, for example other.resampled('{si.time_step!r} s')"
        )
        raise ComponentError(msg)
    return other


def shifted_start_times(motion: MotionValue, seconds: float) -> dict[str, str | float]:
    """Return the known start times in the metadata, moved by some seconds."""
    shifted: dict[str, str | float] = {}
    for prefix in ("", VERTICAL_PREFIX) if seconds != 0.0 else ():
        if f"{prefix}{_RECORD_START}" in motion.metadata:
            shifted[f"{prefix}{_RECORD_START}"] = time_after(
                motion.metadata[f"{prefix}{_RECORD_START}"], seconds
            )
        first = motion.metadata.get(f"{prefix}{_FILE_START}")
        if isinstance(first, int | float):
            shifted[f"{prefix}{_FILE_START}"] = first + seconds
    return shifted


def cleared_vertical_metadata(motion: MotionValue) -> dict[str, None]:
    """Return the metadata of a vertical component that the result no longer has, as None."""
    return {key: None for key in motion.metadata if key.startswith(VERTICAL_PREFIX)}


def warn_of_other_start(motion: MotionValue, other: MotionValue, owner: str) -> None:
    """Warn if the files of two motions state different starts."""
    starts = motion.metadata.get(_RECORD_START), other.metadata.get(_RECORD_START)
    if not same_start(*starts, motion.si.time_step):
        words = (
            f"{owner}: {motion.name} starts at {starts[0]}, {other.name} at {starts[1]}; their "
            "first samples are taken as simultaneous: cut both with window() to one start"
        )
        warn(words, RecordWarning)
