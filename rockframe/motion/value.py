"""The immutable data of a ground motion: samples, name, metadata and history."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from functools import partial
from types import MappingProxyType
from typing import Any, Final, TypeVar

import numpy as np

from rockframe.arguments import checked_text
from rockframe.errors import ComponentError, short_repr
from rockframe.motion.display import display_name, motion_html
from rockframe.signals import Motion
from rockframe.signals.integrals import ground_path
from rockframe.signals.motion import absolute_peak, knots_of
from rockframe.suggestions import Immutable, suggests_names
from rockframe.units import ACCELERATION, LENGTH, TIME, VELOCITY, Quantity, quantity

UNNAMED: Final = "unnamed motion"

MotionType = TypeVar("MotionType", bound="MotionValue")
"""The class of a motion, kept by constructors and operations."""


class GroundComponent(StrEnum):
    """The component of a motion to which a function applies."""

    HORIZONTAL = "horizontal"
    VERTICAL = "vertical"


@suggests_names
class MotionValue(Immutable):
    """A motion in SI units with a name, metadata and a history; immutable.

    Parameters
    ----------
    si : Motion
        The motion itself.
    name : str, optional
        Name for titles and messages.
    metadata : mapping, optional
        Strings and numbers: event, station, unit as read, ...
    history : iterable of str, optional
        One sentence per processing step.
    recipe : mapping, optional
        Constructor and arguments of an analytic motion, and the operations on it since.

    Raises
    ------
    ComponentError
        A metadata value is neither a string nor a number.
    """

    __slots__ = {
        "history": "One sentence per processing step.",
        "metadata": "Strings and numbers: event, station, unit as read, ...",
        "name": "Name for titles and messages.",
        "recipe": "Constructor and arguments of an analytic motion, and later operations.",
        "si": "The motion in SI units.",
    }

    si: Motion
    name: str
    metadata: Mapping[str, str | float | int]
    history: tuple[str, ...]
    recipe: Mapping[str, Any] | None

    def __init__(
        self,
        si: Motion,
        *,
        name: str = UNNAMED,
        metadata: Mapping[str, str | float | int] | None = None,
        history: tuple[str, ...] = (),
        recipe: Mapping[str, Any] | None = None,
    ) -> None:
        entries: dict[str, Any] = {
            key: value.item() if isinstance(value, np.integer | np.floating) else value
            for key, value in dict(metadata or {}).items()
        }
        for key, value in entries.items():
            if isinstance(value, bool) or not isinstance(value, str | int | float):
                msg = (
                    f"GroundMotion: metadata {key!r} must be a string or a number, "
                    f"got {short_repr(value)}"
                )
                raise ComponentError(msg)
        values = {
            "si": si,
            "name": one_line(checked_text(name, owner=type(self).__name__, name="name")) or UNNAMED,
            "metadata": MappingProxyType(entries),
            "history": tuple(map(_OneLine, history)),
            "recipe": None if recipe is None else MappingProxyType(dict(recipe)),
        }
        for key, value in values.items():
            object.__setattr__(self, key, value)

    @property
    def sha256(self) -> str:
        """Digest of time step, samples and pieces: the identity of what is simulated."""
        return self.si.digest

    @property
    def time_step(self) -> Quantity:
        """Time between samples [s]."""
        return quantity(self.si.time_step, TIME)

    @property
    def duration(self) -> Quantity:
        """Time from the first to the last sample [s]."""
        return quantity(self.si.duration, TIME)

    @property
    def acceleration(self) -> Quantity:
        """Horizontal acceleration of the ground, a copy of the samples [m s^-2]."""
        return quantity(self.si.horizontal.samples.copy(), ACCELERATION)

    @property
    def vertical_acceleration(self) -> Quantity | None:
        """Vertical acceleration of the ground, upwards, or None [m s^-2]."""
        vertical = self.si.vertical
        return None if vertical is None else quantity(vertical.samples.copy(), ACCELERATION)

    @property
    def velocity(self) -> Quantity:
        """Horizontal velocity of the ground at the samples, from rest [m s^-1]."""
        return quantity(knots_of(ground_path(self.si.horizontal)[0]), VELOCITY)

    @property
    def displacement(self) -> Quantity:
        """Horizontal displacement of the ground at the samples, from rest [m]."""
        return quantity(knots_of(ground_path(self.si.horizontal)[1]), LENGTH)

    @property
    def peak_acceleration(self) -> Quantity:
        """Greatest absolute horizontal acceleration, between samples too [m s^-2]."""
        return quantity(self.si.peak, ACCELERATION)

    @property
    def peak_velocity(self) -> Quantity:
        """Greatest absolute horizontal velocity from rest, between samples too [m s^-1]."""
        return quantity(absolute_peak(ground_path(self.si.horizontal)[0]), VELOCITY)

    def __len__(self) -> int:
        return int(self.si.horizontal.samples.size)

    def __repr__(self) -> str:
        vertical = "" if self.si.vertical is None else ", with vertical"
        return (
            f"<{type(self).__name__} {display_name(self.name, self.history)!r}: "
            f"{len(self)} samples at "
            f"{self.si.time_step:.6g} s, {self.si.duration:.6g} s long, "
            f"peak {self.si.peak:.5g} m/s^2{vertical}>"
        )

    def _repr_html_(self) -> str:
        title = f"{type(self).__name__}: {display_name(self.name, self.history)}"
        return motion_html(title, self.si, self.metadata)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MotionValue):
            return NotImplemented
        mine = (self.sha256, self.name, dict(self.metadata), self.history)
        return mine == (other.sha256, other.name, dict(other.metadata), other.history)

    def __hash__(self) -> int:
        return hash(self.sha256)

    def __reduce__(self) -> tuple[Any, ...]:
        named = {
            "name": self.name,
            "metadata": dict(self.metadata),
            "history": self.history,
            "recipe": None if self.recipe is None else dict(self.recipe),
        }
        return partial(type(self), **named), (self.si,)


def replaced(motion: MotionType, **changes: Any) -> MotionType:
    """Return a motion with other values of some of its attributes."""
    values = {name: getattr(motion, name) for name in MotionValue.__slots__}
    return type(motion)(**{**values, **changes})


def one_line(text: str) -> str:
    """Return a text on one line, without letters that cannot be printed."""
    if not text.isprintable():
        text = "".join(letter if letter.isprintable() else " " for letter in text)
    return " ".join(text.split())


class _OneLine(str):
    """A sentence of a history on one line; a copy is not processed again."""

    __slots__ = ()

    def __new__(cls, text: str) -> _OneLine:
        return text if isinstance(text, cls) else super().__new__(cls, one_line(text))
