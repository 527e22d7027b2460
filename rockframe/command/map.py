"""``rockframe map``: the pulses that overturn a scene."""

import argparse
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.files.scenes import Described, read_scene
from rockframe.command.files.tables import arguments_of
from rockframe.command.plot import PICTURE, concluded
from rockframe.command.run import finished
from rockframe.command.shared import (
    Outputs,
    analysed,
    analysis_kind,
    run_from,
    store_from,
    system_words,
    taken_by,
    values_of,
)
from rockframe.errors import ComponentError
from rockframe.motion import GroundMotion
from rockframe.motion.description import CONSTRUCTORS
from rockframe.shared_arguments import suggestion
from rockframe.studies import overturning_map
from rockframe.studies.limit_states import overturns

_RESULT: Final = analysis_kind("a map of overturning", "impacts_before_overturning")
_USUAL: Final = "sine_pulse"
_AXES: Final = ("amplitude", "frequency")
_KIND: Final = ("type", "constructor")


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Run pulses of all amplitudes and frequencies, and report which of them overturn."""
    found = read_scene(arguments.scene)
    outputs = Outputs(arguments, found.files, answer, output=_RESULT, picture=PICTURE)
    values: dict[str, Any] = {
        "store": store_from(arguments),
        **taken_by(overturning_map, run_from(found.run, arguments)),
        "amplitude": values_of(arguments.amplitude, "--amplitude", "1:10:0.5 m/s^2"),
        "frequency": values_of(arguments.frequency, "--frequency", "0.5:4:0.25 Hz"),
    }
    pulse, words = _pulse(found, arguments.pulse)
    dataset = analysed(overturning_map, found, pulse, values, arguments)
    answer.says("Verdict", dataset.attrs["verdict"])
    answer.subject("Scene", f"{system_words(found.system)} ({dataset.attrs['model']})")
    answer.subject("Pulse", words)
    answer.text("\n".join(_lines(dataset)))
    concluded(dataset, arguments, answer, outputs)
    return 0 if finished(dataset) else 1


def _pulse(found: Described, name: str | None) -> tuple[Any, str]:
    """Return the pulse that was typed, else that of the scene, and its name."""
    known = [one for one in CONSTRUCTORS if _has_axes(one)]
    if name is not None and name not in known:
        listed = f"{suggestion(name, known)} There are {', '.join(known)}"
        msg = f"--pulse: {name!r} is no pulse of an amplitude and a frequency alone{listed}"
        raise ComponentError(msg)
    motion = found.motion
    described = {} if motion is None else motion.to_dict()
    if name is None and set(_AXES) <= set(described):
        others = {key: value for key, value in described.items() if key not in (*_AXES, *_KIND)}
        words = str(described["constructor"]).replace("_", " ")
        return motion, ", ".join([words, *(f"{key}: {value:g}" for key, value in others.items())])
    name = name or _USUAL
    return getattr(GroundMotion, name), name.replace("_", " ")


def _has_axes(name: str) -> bool:
    """Whether a constructor needs only an amplitude and a frequency."""
    taken = arguments_of(getattr(GroundMotion, name))
    return set(_AXES) <= set(taken) and not any(
        needed for one, needed in taken.items() if one not in _AXES
    )


def _lines(dataset: xr.Dataset) -> list[str]:
    """Write the boundaries of overturning for each frequency."""
    unit = dataset["amplitude"].attrs["units"]
    lines = [f"  frequency [Hz]   boundaries of overturning [{unit}]"]
    for number, frequency in enumerate(dataset["frequency"].to_numpy()):
        one = dataset.isel(frequency=number)
        ends = zip(one["amplitude_above"].to_numpy(), one["impacts_above"].to_numpy(), strict=True)
        text = [f"{at:.4g} {_way(impacts)}" for at, impacts in ends if at == at]
        falls = overturns(one).to_numpy()
        lacking = int(np.isnan(falls).sum())
        ways = "overturns" if (falls == 1.0).any() else "stands"
        text = text or [f"none: {ways} throughout" if lacking < falls.size else "none"]
        text += [f"{lacking} of {falls.size} without a verdict"] if lacking else []
        lines.append(f"  {frequency:<16.4g} {', '.join(text)}")
    return lines


def _way(impacts: float) -> str:
    if impacts != impacts:
        return "stands"
    return f"overturns after {impacts:.0f} impact{'' if impacts == 1 else 's'}"
