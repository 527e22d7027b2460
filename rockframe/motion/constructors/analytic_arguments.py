"""Constructors of analytic motions from formulas; the arguments are converted to SI units."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import signature
from typing import Any, Final, TypeVar, cast

from rockframe.arguments import checked_integer
from rockframe.errors import ComponentError, short_repr
from rockframe.motion.pulses import impulse_duration
from rockframe.shared_arguments import with_raises_section
from rockframe.signals import Motion
from rockframe.suggestions import with_hints
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

Constructor = TypeVar("Constructor", bound=Callable[..., Any])

PULSES: Final[list[str]] = []
"""Names of the constructors, in the order in which they are declared."""

_RAISES: Final = """\
UnitsError
    A wrong unit, or none.
ComponentError
    Not finite, or a frequency, period or length that is not positive."""
_MEASURES: Final[dict[str, tuple[Measure, Condition | None, str]]] = {
    # quantity, range, and the word before the value in names where the unit is ambiguous
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
    """Reader of the arguments of one call, with the numbers and texts read so far."""

    def __init__(self, owner: str, cycles: Condition) -> None:
        self.owner = owner
        self.numbers: dict[str, Any] = {}  # in SI units, for the formula
        self.recipe: dict[str, Any] = {}  # for the description of the motion
        self.short: list[str] = []
        self.exact: list[str] = []
        self._cycles = cycles

    def read(self, name: str, value: Any) -> None:
        """Read the argument of this name."""
        owner = self.owner
        if name in _MEASURES:
            self._read_quantity(name, value, *_MEASURES[name])
        elif name == "cycles":
            number = to_ratio(value, owner=owner, name=name, condition=self._cycles, example="2")
            self._store(name, number, number, f"{name}: {number:.6g}", f"{name}: {number!r}")
        elif name == "order":
            order = checked_integer(value, owner=owner, name=name, lowest=1, highest=_HIGHEST_ORDER)
            self._store(name, order, order, *[f"{name}: {order}"] * 2)
        elif isinstance(value, bool):
            self._store(name, value, value, *[name if value else f"not {name}"] * 2)
        else:
            msg = f"{owner}: {name} must be True or False, got {short_repr(value)}"
            raise ComponentError(msg)

    def _read_quantity(
        self, name: str, value: Any, measure: Measure, condition: Condition | None, words: str
    ) -> None:
        number = None
        if value is not None or name not in ("phase", "pulse_duration"):
            number = to_si(value, measure, owner=self.owner, name=name, condition=condition)
        if name == "pulse_duration":
            number = impulse_duration(self.owner, number, self.numbers["interval"])
        if number is None:  # the formula has a default, which is not recorded
            return
        unit = _SPELLED.get(measure.unit, str(measure.unit))
        written = f"{number!r} {measure.unit}"
        self._store(
            name, number, written, f"{words}{number:.6g} {unit}", f"{words}{number!r} {unit}"
        )

    def _store(self, name: str, number: Any, written: Any, short: str, exact: str) -> None:
        self.numbers[name] = number
        self.recipe[name] = written
        self.short.append(short)
        self.exact.append(exact)


def pulse_constructor(
    title: str, formula: Callable[..., Motion], cycles: Condition = POSITIVE
) -> Callable[[Constructor], Constructor]:
    """Make a constructor from a formula, whose arguments are converted to SI units.

    Name, history and recipe of the motion state them.
    """

    def decorate(declared: Constructor) -> Constructor:
        own = signature(declared)
        declared.__qualname__ = declared.__name__  # as messages name it
        PULSES.append(declared.__name__)
        checked = with_hints()(declared)

        @wraps(checked)
        def construct(kind: type[Any], *items: Any, **named: Any) -> Any:
            checked(kind, *items, **named)  # raises the error of missing or unknown arguments
            values = own.bind(kind, *items, **named)
            values.apply_defaults()
            reader = ArgumentReader(f"{kind.__name__}.{declared.__name__}", cycles)
            for name in list(own.parameters)[1:]:
                reader.read(name, values.arguments[name])
            return kind(
                formula(reader.owner, **reader.numbers),
                name=", ".join([title, *reader.short]),
                history=(f"{title}: {', '.join(reader.exact)}",),
                recipe={"constructor": declared.__name__, **reader.recipe},
            )

        construct.__doc__ = with_raises_section(declared.__doc__ or "", _RAISES)
        return cast("Constructor", construct)

    return decorate
