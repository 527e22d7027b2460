"""``rockframe map``: the pulses that overturn a scene."""

import argparse
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.files.scenes import SceneDescription, read_scene
from rockframe.command.files.tables import arguments_of
from rockframe.command.plot import PICTURE_KIND, finish_analysis
from rockframe.command.shared import (
    Outputs,
    analysis_kind,
    arguments_accepted_by,
    parse_numbers,
    part_names,
    run_analysis,
    run_from,
    store_from,
)
from rockframe.errors import ComponentError
from rockframe.motion import GroundMotion
from rockframe.motion.description import CONSTRUCTORS
from rockframe.shared_arguments import suggestion
from rockframe.studies import overturning_map
from rockframe.studies.limit_states import overturns

_RESULT_KIND: Final = analysis_kind("a map of overturning", "impacts_before_overturning")
_DEFAULT_PULSE: Final = "sine_pulse"
_AXES: Final = ("amplitude", "frequency")
_CONSTRUCTOR_KEYS: Final = ("type", "constructor")


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Run pulses of all amplitudes and frequencies, and report which of them overturn."""
    found = read_scene(arguments.scene)
    outputs = Outputs(arguments, found.files, answer, output=_RESULT_KIND, picture=PICTURE_KIND)
    values: dict[str, Any] = {
        "store": store_from(arguments),
        **arguments_accepted_by(overturning_map, run_from(found.run, arguments)),
        "amplitude": parse_numbers(arguments.amplitude, "--amplitude", "1:10:0.5 m/s^2"),
        "frequency": parse_numbers(arguments.frequency, "--frequency", "0.5:4:0.25 Hz"),
    }
    pulse, words = _pulse(found, arguments.pulse)
    dataset = run_analysis(overturning_map, found, pulse, values, arguments)
    answer.add_result("Verdict", dataset.attrs["verdict"])
    answer.add_context("Scene", f"{part_names(found.system)} ({dataset.attrs['model']})")
    answer.add_context("Pulse", words)
    answer.add_text("\n".join(_boundary_lines(dataset)))
    return finish_analysis(dataset, arguments, answer, outputs)


def _pulse(found: SceneDescription, name: str | None) -> tuple[Any, str]:
    """Return the pulse that was typed, else that of the scene, and its name."""
    known = [one for one in CONSTRUCTORS if _has_axes(one)]
    if name is not None and name not in known:
        listed = f"{suggestion(name, known)} There are {', '.join(known)}"
        msg = f"--pulse: {name!r} is no pulse of an amplitude and a frequency alone{listed}"
        raise ComponentError(msg)
    motion = found.motion
    described = {} if motion is None else motion.to_dict()
    if name is None and set(_AXES) <= set(described):
        others = {
            key: value
            for key, value in described.items()
            if key not in (*_AXES, *_CONSTRUCTOR_KEYS)
        }
        words = str(described["constructor"]).replace("_", " ")
        return motion, ", ".join([words, *(f"{key}: {value:g}" for key, value in others.items())])
    name = name or _DEFAULT_PULSE
    return getattr(GroundMotion, name), name.replace("_", " ")


def _has_axes(name: str) -> bool:
    """Whether a constructor needs only an amplitude and a frequency."""
    taken = arguments_of(getattr(GroundMotion, name))
    return set(_AXES) <= set(taken) and not any(
        needed for one, needed in taken.items() if one not in _AXES
    )


def _boundary_lines(dataset: xr.Dataset) -> list[str]:
    """Write the boundaries of overturning for each frequency."""
    unit = dataset["amplitude"].attrs["units"]
    lines = [f"  frequency [Hz]   boundaries of overturning [{unit}]"]
    for number, frequency in enumerate(dataset["frequency"].to_numpy()):
        one = dataset.isel(frequency=number)
        ends = zip(one["amplitude_above"].to_numpy(), one["impacts_above"].to_numpy(), strict=True)
        text = [f"{at:.4g} {_boundary_label(impacts)}" for at, impacts in ends if at == at]
        overturned = overturns(one).to_numpy()
        missing = int(np.isnan(overturned).sum())
        verdict = "overturns" if (overturned == 1.0).any() else "stands"
        text = text or [f"none: {verdict} throughout" if missing < overturned.size else "none"]
        text += [f"{missing} of {overturned.size} without a verdict"] if missing else []
        lines.append(f"  {frequency:<16.4g} {', '.join(text)}")
    return lines


def _boundary_label(impacts: float) -> str:
    if impacts != impacts:
        return "stands"
    return f"overturns after {impacts:.0f} impact{'' if impacts == 1 else 's'}"
