"""Units chosen by the reader, in which numbers are shown instead of SI units."""

import math
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from rockframe.errors import ComponentError, UnitsError, did_you_mean, short_repr
from rockframe.units import kinds
from rockframe.units.kinds import Measure
from rockframe.units.reading import to_si
from rockframe.units.spelling import DEGREE, PLAIN_POWERS, SUPERSCRIPT_POWERS

if TYPE_CHECKING:
    import xarray as xr

_DISPLAY_SYMBOLS: Final = {"g_0": "g", **dict.fromkeys(("deg", "degree", "degrees"), DEGREE)}
_PINT_SYMBOLS: Final = {("g", kinds.ACCELERATION): "g_0"}
"""Meaning of a unit symbol that has another meaning elsewhere: ``g`` is also the gram."""
_DENOMINATOR: Final = re.compile(r"\s*/\s*([^\W\d_]+)(?:\^(\d+))?")
_NUMBER: Final = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
_UNIT_SPELLINGS: Final = {
    "m/s^2": "m s^-2", "m/s": "m s^-1", "rad/s": "rad s^-1", "N/m": "N m^-1",
    "N s/m": "N s m^-1",
}  # fmt: skip
"""Spellings of units in descriptions of models."""
_UNITS: Final = "|".join(
    sorted(
        map(re.escape, [*_UNIT_SPELLINGS, *map(str, list(kinds.Unit)[1:])]), key=len, reverse=True
    )
)
_QUANTITY: Final = re.compile(
    rf"(?<![\w.])(?:\((?P<across>{_NUMBER}), (?P<up>{_NUMBER})\)|"
    rf"(?:(?P<first>{_NUMBER}) (?P<word>to|and) )?(?P<last>{_NUMBER})) (?P<unit>{_UNITS})"
    # followed by the same quantity in another unit
    rf"(?![\w^/])(?: \({_NUMBER} ?(?:g|deg|°)\))?"
)
_DIGITS: Final = 4
"""Significant digits of most numbers in sentences."""
_SENTENCES: Final = ("verdict",)
"""Attributes of datasets whose texts contain numbers with units."""
UnitsLike: TypeAlias = Mapping[str, str] | None
"""Units by kind of quantity, such as ``{"force": "kN"}``."""
KINDS: Final[Mapping[str, Measure]] = {
    "length": kinds.LENGTH,
    "mass": kinds.MASS,
    "angle": kinds.ANGLE,
    "angular_velocity": kinds.ANGULAR_VELOCITY,
    "velocity": kinds.VELOCITY,
    "acceleration": kinds.ACCELERATION,
    "force": kinds.FORCE,
    "moment": kinds.MOMENT,
    "energy": kinds.ENERGY,
    "stiffness": kinds.STIFFNESS,
}
"""Kinds of quantities for which a reader can choose a unit."""


@dataclass(frozen=True)
class DisplayUnit:
    """A unit in which numbers are shown."""

    words: str  # spelling after numbers, for :func:`unit_suffix`
    size: float  # value of one unit in the SI unit

    def of(self, values: Any) -> npt.NDArray[np.float64]:
        """Convert values from the SI unit to this one."""
        return np.asarray(values, np.float64) / self.size


def unit_suffix(unit: str) -> str:
    """Write a unit to follow a number: after a space, degrees without one; none for 1."""
    if unit in ("", kinds.Unit.ONE):
        return ""
    return unit if unit.startswith(DEGREE) else f" {unit}"  # ISO 80000-1: 4.7°, but 5 °C


def display_unit(value: object, measure: Measure, *, owner: str, name: str) -> DisplayUnit:
    """Read the unit in which numbers of a kind are shown."""
    if not isinstance(value, str):
        msg = (
            f"{owner}: {name} must be a unit, such as {str(measure.unit)!r}, got "
            f"{short_repr(value)}"
        )
        raise ComponentError(msg)
    read = _PINT_SYMBOLS.get((value, measure), value)
    try:
        size = to_si(f"1 {read}", measure, owner=owner, name=name)
    except UnitsError as problem:  # its words are on a value, and end with an example of one
        words = str(problem).partition("; write for example ")[0]
        like = "" if "such as" in words else f"; write for example {str(measure.unit)!r}"
        raise UnitsError(words.replace(f"'1 {read}'", repr(value), 1) + like) from problem
    return DisplayUnit(_canonical_spelling(value), size)


def _canonical_spelling(unit: str) -> str:
    """Spell a unit as in datasets: ``m s^-2`` for ``m/s^2`` and ``m/s**2``."""
    plain = unit.strip().replace("**", "^").replace("*", " ")
    plain = _DENOMINATOR.sub(lambda part: f" {part[1]}^-{part[2] or 1}", plain)
    return " ".join(_DISPLAY_SYMBOLS.get(part, part) for part in plain.split())


@dataclass(frozen=True)
class DisplayUnits:
    """The units that a reader has chosen; all others are SI units."""

    # by the SI unit
    chosen: Mapping[str, DisplayUnit] = field(default_factory=dict[str, DisplayUnit])
    words: Mapping[str, str] = field(default_factory=dict[str, str])  # argument of the reader

    def of(self, unit: str) -> DisplayUnit:
        """Return the unit in which values in an SI unit, or in that of a user, are shown."""
        return self.chosen.get(unit) or self._instead_of(unit) or DisplayUnit(unit, 1.0)

    def _instead_of(self, unit: str) -> DisplayUnit | None:
        """Return the chosen unit for values that a user has converted to another one, or None."""
        is_shown = any(unit == shown.words for shown in self.chosen.values())
        if is_shown or unit in (*kinds.Unit, "g"):  # the gram, or the acceleration of gravity
            return None
        for kind in KINDS.values():
            shown = self.chosen.get(str(kind.unit))
            # an energy and a moment, which pint does not tell apart
            other = kinds.MOMENT if "J" in unit else kinds.ENERGY
            if shown is not None and kind is not other:
                with suppress(UnitsError):
                    size = to_si(f"1 {unit}", kind, owner="units", name="unit")
                    return DisplayUnit(shown.words, shown.size / size)
        return None

    def chosen_unit(self, measure: Measure) -> DisplayUnit | None:
        """Return the unit that was chosen for a kind, or None."""
        return self.chosen.get(str(measure.unit))

    def convert_dataset(self, dataset: "xr.Dataset") -> "xr.Dataset":
        """Return a dataset with its values and their attributes ``units`` in these units."""
        converted: dict[str, Any] = {}
        for name, values in dataset.variables.items():
            current = str(values.attrs.get("units"))
            unit = self.chosen.get(current) or self._instead_of(current)
            if unit is not None and values.dtype.kind in "fiu":
                attributes = {**values.attrs, "units": unit.words}
                converted[str(name)] = (values.dims, unit.of(values.to_numpy()), attributes)
        coords = {name: converted.pop(name) for name in list(converted) if name in dataset.coords}
        texts = {name: self.convert_text(str(dataset.attrs[name])) for name in _SENTENCES
                if name in dataset.attrs}  # fmt: skip
        # levels of a stacked dimension can be replaced only while they are no index
        levels = {dim: dataset.indexes[dim].names for dim in dataset.dims
                  if dim in dataset.indexes and dataset.indexes[dim].nlevels > 1}  # fmt: skip
        flat = dataset.reset_index(list(levels)).assign(converted).assign_attrs(texts)
        return flat.assign_coords(coords).set_index(levels)

    def convert_text(self, text: str) -> str:
        """Convert the quantities in a text from SI units to these units."""
        return _QUANTITY.sub(self._converted_match, text) if self.chosen else text

    def _converted_match(self, match: "re.Match[str]") -> str:
        """Convert one number with its unit, a range of two, or a pair of coordinates."""
        unit = self.chosen.get(_UNIT_SPELLINGS.get(match["unit"], match["unit"]))
        if unit is None:
            return match[0]
        across, up, first, last = (
            "" if match[name] is None else _converted_number(match[name], unit.size)
            for name in ("across", "up", "first", "last")
        )
        numbers = f"({across}, {up})" if across else last
        before = f"{first} {match['word']} " if first else ""
        return f"{before}{numbers}{unit_suffix(unit.words)}"


def _converted_number(number: str, size: float) -> str:
    """Convert a number to a unit of some size, without more digits than are significant.

    The conversion of a rounded number costs one digit, unless the size is a power of ten. A number
    of one or two digits may be exact and is written with four.
    """
    count = len(re.sub(r"e.*|\D", "", number).lstrip("0"))
    exact = float(f"1e{round(math.log10(size))}") == size  # a power of ten
    digits = max(_DIGITS, count) if exact or count < _DIGITS - 1 else max(_DIGITS - 1, count - 1)
    value = f"{float(number) / size:.{digits}g}"
    return np.format_float_positional(float(value), trim="-") if "e+" in value else value


def display_units(value: object, *, owner: str) -> DisplayUnits:
    """Read units by kind of quantity, such as ``{"force": "kN"}``."""
    if value is None:
        return DisplayUnits()
    example = "such as units={'force': 'kN', 'angle': 'deg'}"
    if not isinstance(value, Mapping):
        msg = f"{owner}: units must be a mapping, {example}, got {short_repr(value)}"
        raise ComponentError(msg)
    chosen = dict[str, DisplayUnit]()
    for name, unit in cast("Mapping[Any, Any]", value).items():
        if name not in KINDS:
            found = f"found {short_repr(name)}{did_you_mean(name, KINDS)}"
            known = f"known are {', '.join(KINDS)}; times stay in s, and frequencies in Hz"
            msg = f"{owner}: units belong to kinds of quantities, {example}; {found}; {known}"
            raise ComponentError(msg)
        kind = KINDS[name]
        chosen[str(kind.unit)] = display_unit(unit, kind, owner=owner, name=f"units[{name!r}]")
    return DisplayUnits(chosen, dict(cast("Mapping[str, str]", value)))


_SUPERSCRIPTS: Final = str.maketrans(PLAIN_POWERS, SUPERSCRIPT_POWERS)


def with_superscripts(text: str) -> str:
    """Write the powers of units in a text as superscript characters."""
    return re.sub(r"(?<=[^\W\d_])\^(-?\d+)", lambda power: power[1].translate(_SUPERSCRIPTS), text)
