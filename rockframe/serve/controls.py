"""The controls of the page with their ranges, and the file of a scene that they make."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from rockframe.components import Block, Component, TwoSpringSupport, WinklerSoil
from rockframe.errors import did_you_mean, short_repr
from rockframe.motion import GroundMotion
from rockframe.simulation.system import System


@dataclass(frozen=True)
class Control:
    """A number that the page can change."""

    name: str  # in the address of the page
    words: str  # label on the page
    low: float
    high: float
    step: float  # of the slider
    default: float
    unit: str
    group: str  # on the page


CONTROLS: Final = (
    Control("width", "Width", 0.1, 5.0, 0.05, 0.8, "m", "body"),
    Control("height", "Height", 0.2, 20.0, 0.1, 3.2, "m", "body"),
    Control("mass", "Mass", 0.05, 200.0, 0.05, 5.5, "t", "body"),
    Control("pad_stiffness", "Stiffness of one pad", 0.1, 500.0, 0.1, 12.0, "MN/m", "pads"),
    Control("pad_damping", "Damping ratio of the pads", 0.0, 1.0, 0.01, 0.1, "", "pads"),
    Control("soil_stiffness", "Stiffness of the bed", 0.1, 500.0, 0.1, 9.0, "MPa", "soil"),
    Control("soil_damping", "Damping ratio of the bed", 0.0, 1.0, 0.01, 0.2, "", "soil"),
    Control("amplitude", "Amplitude of the pulse", 0.1, 20.0, 0.1, 5.0, "m/s^2", "pulse"),
    Control("frequency", "Frequency of the pulse", 0.1, 10.0, 0.1, 2.0, "Hz", "pulse"),
    Control("scale", "Scale of the motion", 0.1, 10.0, 0.1, 1.0, "", "motion"),
)
BASES: Final = {"ground": "Rigid ground", "pads": "Pads", "soil": "Bed of springs"}
PULSES: Final = {"sine_pulse": "Sine pulse", "cosine_pulse": "Cosine pulse"}
EXAMPLE: Final = "example"
RECORD: Final = "record"
FREE_VIBRATION: Final = "5 s"
"""Time after the motion, in which the body comes to rest or overturns."""


@dataclass(frozen=True)
class NamedRecord:
    """The record of the server, and the keys for reading it in a scene's file."""

    motion: GroundMotion
    keys: Mapping[str, Any]


@dataclass(frozen=True)
class TrialScene:
    """The choices on the page."""

    numbers: Mapping[str, float]
    base: str
    motion: str

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        """Tables of the parts."""
        tables = {"block": {name: self._quantity(name) for name in ("width", "height", "mass")}}
        of_base = {"pads": "pad", "soil": "soil"}
        if self.base in of_base:
            stem = of_base[self.base]
            tables[self.base] = {
                "stiffness": self._quantity(f"{stem}_stiffness"),
                "damping_ratio": self._quantity(f"{stem}_damping"),
            }
        return tables

    def system(self) -> System:
        """Build the scene."""
        kinds: dict[str, type[Component]] = {
            "block": Block, "pads": TwoSpringSupport, "soil": WinklerSoil,
        }  # fmt: skip
        return System(*(kinds[name](**table) for name, table in self.parts.items()))

    def ground_motion(self, record: NamedRecord | None) -> GroundMotion:
        """Make the motion of the ground."""
        if self.motion == RECORD and record is not None:
            motion = record.motion
        elif self.motion == EXAMPLE:
            motion = GroundMotion.example()
        else:
            motion = getattr(GroundMotion, self.motion)(**self._pulse())
        scale = self.numbers["scale"]
        return motion if scale == 1.0 else motion.scaled(scale)

    def toml(self, record: NamedRecord | None) -> str:
        """Write the scene as a file for the command line."""
        if self.motion == RECORD and record is not None:
            motion = dict(record.keys)
        else:
            pulse = self._pulse() if self.motion in PULSES else {}
            motion = {"constructor": self.motion, **pulse}
        lines = ["# rockframe run scene.toml"]
        tables = {**self.parts, "motion": motion, "run": {"free_vibration": FREE_VIBRATION}}
        for name, table in tables.items():
            lines += ["", f"[{name}]"]
            lines += [f"{key} = {_toml_value(value)}" for key, value in table.items()]
            if name == "motion" and self.numbers["scale"] != 1.0:
                factor = _toml_value(self.numbers["scale"])
                lines.append(f"operations = [{{ scaled = {{ factor = {factor} }} }}]")
        return "\n".join(lines) + "\n"

    def _pulse(self) -> dict[str, Any]:
        return {name: self._quantity(name) for name in ("amplitude", "frequency")}

    def _quantity(self, name: str) -> str | float:
        """Write a number for components and files."""
        unit = next(control.unit for control in CONTROLS if control.name == name)
        return f"{self.numbers[name]:.15g} {unit}" if unit else self.numbers[name]


def motion_choices(record: NamedRecord | None) -> dict[str, str]:
    """Return the motions of the page; the record, if there is one, comes first."""
    of_record = {} if record is None else {RECORD: f"Record: {record.motion.name}"}
    return {**of_record, **PULSES, EXAMPLE: "Example record (Loma Prieta 1989)"}


def read_choice(
    values: Mapping[str, str], record: NamedRecord | None
) -> tuple[TrialScene, list[str]]:
    """Read the address of the page; a wrong value is reported and replaced by its default."""
    known = [*(control.name for control in CONTROLS), "base", "motion"]
    faults = [
        f"there is no {short_repr(name)}"
        + (did_you_mean(name, known) or f"; there are {', '.join(known)}")
        for name in values
        if name not in known
    ]
    numbers = dict[str, float]()
    for control in CONTROLS:
        numbers[control.name] = control.default
        if control.name in values:
            try:
                numbers[control.name] = _read_number(control, values[control.name])
            except ValueError as problem:
                faults.append(str(problem))
    words = dict[str, str]()
    for name, choices in (("base", BASES), ("motion", motion_choices(record))):
        words[name] = values.get(name, next(iter(choices)))
        if words[name] not in choices:
            expected = f"{', '.join(choices)}{did_you_mean(words[name], choices)}"
            faults.append(f"{name}: found {short_repr(words[name])}; expected one of {expected}")
            words[name] = next(iter(choices))
    return TrialScene(numbers, words["base"], words["motion"]), faults


def _read_number(control: Control, text: str) -> float:
    unit = f" {control.unit}" if control.unit else ""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not control.low <= value <= control.high:
        msg = (
            f"{control.words}: found {short_repr(text)}; expected a number from {control.low:g} to "
            f"{control.high:g}{unit}"
        )
        raise ValueError(msg)
    return value


def _toml_value(value: object) -> str:
    """Write a value in TOML, whose texts have the escapes of JSON."""
    return json.dumps(value, ensure_ascii=False)
