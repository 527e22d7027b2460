"""Ground motions of both programs, built from one description."""

import os
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import rockframe as rf

from . import excitation
from .simulate import Excitation

RECORDS = ("NIS090.AT2", "PEERSMD_IMPVALL_IELC180.AT2")
_VARIABLE = "ROCKFRAME_RECORDS"
_BESIDE = Path(__file__).resolve().parents[4] / "shared" / "records"


def records_available() -> bool:
    """Tell whether the recorded motions are available."""
    return all((_folder() / name).is_file() for name in RECORDS)


def _folder() -> Path:
    return Path(os.environ.get(_VARIABLE, _BESIDE))


@cache
def _samples(name: str) -> tuple[float, np.ndarray]:
    si = rf.GroundMotion.read(_folder() / name).si
    return si.time_step, si.horizontal.samples


def build_motions(
    motion: dict[str, Any], factor: float = 1.0
) -> tuple[rf.GroundMotion | None, Excitation]:
    """Build a motion for rockframe and for the reference model.

    Parameters
    ----------
    motion : dict
        As drawn; its ``form`` is the key of one of the builders.
    factor : float
        Factor on all accelerations.

    Returns
    -------
    tuple
        A `GroundMotion`, or None for still ground, and a `Excitation`.
    """
    form = motion["form"]
    if form == "still":
        return None, Excitation.still()
    if form in ("sine", "cosine", "ricker", "odd ricker"):
        return _pulse(motion, factor)
    samples = _record(motion) if form == "record" else _sines(motion)
    step, across, upwards = samples[0], factor * samples[1], factor * samples[2]
    motion_built = rf.GroundMotion.from_arrays(
        (across, "m/s^2"), f"{step!r} s", vertical=(upwards, "m/s^2")
    )
    return motion_built, Excitation.record(step, across, upwards)


def _pulse(motion: dict[str, Any], factor: float) -> tuple[rf.GroundMotion, Excitation]:
    form, scale = motion["form"], motion["scale"]
    peaks = [factor * motion["peak"], factor * motion["vertical"]]
    made = []
    for peak in peaks:
        size = f"{peak!r} m/s^2"
        if form == "sine":
            made.append(rf.GroundMotion.sine_pulse(size, f"{scale!r} Hz", motion["cycles"]))
        elif form == "cosine":
            made.append(rf.GroundMotion.cosine_pulse(size, f"{scale!r} Hz", motion["cycles"]))
        else:
            odd = form == "odd ricker"
            made.append(rf.GroundMotion.ricker_wavelet(size, f"{scale!r} s", antisymmetric=odd))
        if motion["vertical"] == 0.0:
            break
    motion_built = made[0] if len(made) == 1 else made[0].with_vertical(made[1])
    kind = {"ricker": excitation.RICKER, "odd ricker": excitation.RICKER_ODD}.get(
        form, excitation.HARMONIC
    )
    phase = 0.5 * np.pi if form == "cosine" else 0.0
    step, intervals = motion_built.si.time_step, motion_built.si.horizontal.samples.size - 1
    return motion_built, Excitation.pulse(kind, step, intervals, scale, phase, *peaks)


def _record(motion: dict[str, Any]) -> tuple[float, np.ndarray, np.ndarray]:
    step, values = _samples(RECORDS[motion["which"]])
    _, others = _samples(RECORDS[1 - motion["which"]])
    count = round(motion["length"] / step)
    strongest = int(np.argmax(np.abs(values)))
    first = max(0, min(values.size - count - 1, strongest - int(motion["lead"] * count)))
    across = values[first : first + count + 1]
    across = across * (motion["peak"] / np.max(np.abs(across)))
    upwards = others[first : first + count + 1]
    upwards = upwards * (motion["vertical"] / np.max(np.abs(upwards)))
    return step, across, upwards


def _sines(motion: dict[str, Any]) -> tuple[float, np.ndarray, np.ndarray]:
    step = motion["step"]
    count = round(motion["length"] / step)
    t = step * np.arange(count + 1)
    envelope = np.sin(np.pi * t / t[-1])
    sums = []
    for key, peak in (("waves", motion["peak"]), ("vertical waves", motion["vertical"])):
        total = np.zeros_like(t)
        for size, frequency, phase in motion[key]:
            total += size * np.sin(2.0 * np.pi * (frequency * t + phase))
        total *= envelope
        sums.append(total * (peak / np.max(np.abs(total))))
    return step, sums[0], sums[1]
