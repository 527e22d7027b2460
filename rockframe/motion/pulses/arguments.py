"""The arguments of an analytic motion: read once, then told in name, history and recipe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypedDict

from rockframe.arguments import whole_number
from rockframe.errors import ComponentError, shown
from rockframe.units import ANGLE, Condition, Measure, Unit, to_ratio, to_si

if TYPE_CHECKING:
    from rockframe.units import QuantityLike, RatioLike

_SPELLED: Final = {
    Unit.METRE_PER_SECOND_SQUARED: "m/s^2",
    Unit.METRE_PER_SECOND: "m/s",
}


class MotionLabels(TypedDict):
    """What a motion is told about itself besides its samples."""

    name: str
    history: tuple[str, ...]
    recipe: dict[str, Any]


class ArgumentReader:
    """Reader of the arguments of one constructor; remembers what it read."""

    def __init__(self, kind: type, constructor: str, title: str) -> None:
        self.owner = f"{kind.__name__}.{constructor}"
        self._title = title
        self._recipe: dict[str, Any] = {"constructor": constructor}
        self._short: list[str] = []
        self._exact: list[str] = []

    def quantity(
        self,
        name: str,
        value: QuantityLike,
        measure: Measure,
        condition: Condition | None = None,
        *,
        label: str = "",
    ) -> float:
        """Read a quantity."""
        number = to_si(value, measure, owner=self.owner, name=name, condition=condition)
        return self.settled(name, number, measure, label=label)

    def settled(self, name: str, number: float, measure: Measure, *, label: str = "") -> float:
        """Remember a quantity that is in SI units already; parameters as of :meth:`quantity`."""
        unit = _SPELLED.get(measure.unit, str(measure.unit))
        words = f"{label} " if label else ""
        self._remember(
            name,
            f"{number!r} {measure.unit}",
            f"{words}{number:.6g} {unit}",
            f"{words}{number!r} {unit}",
        )
        return number

    def phase(self, value: QuantityLike | None) -> float:
        """Read the argument ``phase``, an angle; zero, and not told, if it is None [rad]."""
        return 0.0 if value is None else self.quantity("phase", value, ANGLE, label="phase")

    def ratio(self, name: str, value: RatioLike, condition: Condition) -> float:
        """Read a pure ratio; parameters and errors as of :meth:`quantity`."""
        number = to_ratio(value, owner=self.owner, name=name, condition=condition, example="2")
        self._remember(name, number, f"{name}: {number:.6g}", f"{name}: {number!r}")
        return number

    def whole(self, name: str, value: object, highest: int) -> int:
        """Read a whole number from 1 to `highest`; ComponentError if it is none."""
        number = whole_number(value, owner=self.owner, name=name, lowest=1, highest=highest)
        self._remember(name, number, f"{name}: {number}", f"{name}: {number}")
        return number

    def switch(self, name: str, value: object) -> bool:
        """Read True or False; ComponentError if it is neither."""
        if not isinstance(value, bool):
            msg = f"{self.owner}: {name} must be True or False, got {shown(value)}"
            raise ComponentError(msg)
        words = name if value else f"not {name}"
        self._remember(name, value, words, words)
        return value

    def labels(self) -> MotionLabels:
        """Tell what was read."""
        return {
            "name": ", ".join([self._title, *self._short]),
            "history": (f"{self._title}: {', '.join(self._exact)}",),
            "recipe": self._recipe,
        }

    def _remember(self, name: str, kept: str | float, short: str, exact: str) -> None:
        self._recipe[name] = kept
        self._short.append(short)
        self._exact.append(exact)
