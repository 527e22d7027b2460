"""Arguments of analytic motions, read by their names, in SI units."""

from __future__ import annotations

from typing import Any, Final

from rockframe.arguments import whole_number
from rockframe.errors import ComponentError, shown
from rockframe.motion.pulses import impulse_duration
from rockframe.units import (
    ACCELERATION,
    ANGLE,
    FREQUENCY,
    PERIOD,
    POSITIVE,
    VELOCITY,
    Condition,
    Measure,
    Unit,
    to_ratio,
    to_si,
)  # fmt: skip

_MEASURES: Final[dict[str, tuple[Measure, Condition | None, str]]] = {
    # of each parameter that is a quantity; and the word before it, where its unit leaves a doubt
    "amplitude": (ACCELERATION, None, ""),
    "velocity": (VELOCITY, None, ""),
    "frequency": (FREQUENCY, POSITIVE, ""),
    "period": (PERIOD, POSITIVE, ""),
    "duration": (PERIOD, POSITIVE, ""),
    "interval": (PERIOD, POSITIVE, "interval "),
    "pulse_duration": (PERIOD, POSITIVE, "impulses of "),
    "phase": (ANGLE, None, "phase "),
}
_SPELLED: Final = {
    Unit.METRE_PER_SECOND_SQUARED: "m/s^2",
    Unit.METRE_PER_SECOND: "m/s",
}
_HIGHEST_ORDER: Final = 1000


class ArgumentReader:
    """Reads the arguments of one call, and remembers what it has read."""

    def __init__(self, owner: str, cycles: Condition) -> None:
        self.owner = owner
        self.numbers: dict[str, Any] = {}  # in SI units, for the formula
        self.recipe: dict[str, Any] = {}  # for the way back from plain values
        self.short: list[str] = []
        self.exact: list[str] = []
        self._cycles = cycles

    def read(self, name: str, value: Any) -> None:
        """Read the argument of a name."""
        owner = self.owner
        if name in _MEASURES:
            self._read_quantity(name, value, *_MEASURES[name])
        elif name == "cycles":
            number = to_ratio(value, owner=owner, name=name, condition=self._cycles, example="2")
            self._keep(name, number, number, f"{name}: {number:.6g}", f"{name}: {number!r}")
        elif name == "order":
            order = whole_number(value, owner=owner, name=name, lowest=1, highest=_HIGHEST_ORDER)
            self._keep(name, order, order, *[f"{name}: {order}"] * 2)
        elif isinstance(value, bool):
            self._keep(name, value, value, *[name if value else f"not {name}"] * 2)
        else:
            msg = f"{owner}: {name} must be True or False, got {shown(value)}"
            raise ComponentError(msg)

    def _read_quantity(
        self, name: str, value: Any, measure: Measure, condition: Condition | None, words: str
    ) -> None:
        number = None
        if value is not None or name not in ("phase", "pulse_duration"):
            number = to_si(value, measure, owner=self.owner, name=name, condition=condition)
        if name == "pulse_duration":
            number = impulse_duration(self.owner, number, self.numbers["interval"])
        if number is None:  # left to the formula, and not told
            return
        unit = _SPELLED.get(measure.unit, str(measure.unit))
        kept = f"{number!r} {measure.unit}"
        self._keep(name, number, kept, f"{words}{number:.6g} {unit}", f"{words}{number!r} {unit}")

    def _keep(self, name: str, number: Any, kept: Any, short: str, exact: str) -> None:
        self.numbers[name] = number
        self.recipe[name] = kept
        self.short.append(short)
        self.exact.append(exact)
