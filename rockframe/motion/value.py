"""The immutable data of a ground motion: samples, name, metadata and history."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final, TypeVar

from rockframe.arguments import checked_bool, checked_text
from rockframe.errors import ComponentError, short_repr
from rockframe.motion.quantities import as_quantity
from rockframe.signals import Motion, Signal
from rockframe.signals.integrals import ground_path
from rockframe.signals.motion import absolute_peak, knots_of
from rockframe.suggestions import Immutable, suggests_names
from rockframe.units import ACCELERATION, LENGTH, TIME, VELOCITY, Quantity

UNNAMED: Final = "unnamed motion"

MotionType = TypeVar("MotionType", bound="MotionValue")
"""The class of a motion, kept by constructors and operations."""


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
        entries: dict[str, Any] = dict(metadata or {})
        for key, value in entries.items():
            if isinstance(value, bool) or not isinstance(value, str | int | float):
                msg = (
                    f"GroundMotion: metadata {key!r} must be a string or a number, "
                    f"got {short_repr(value)}"
                )
                raise ComponentError(msg)
        values = {
            "si": si,
            "name": _one_line(checked_text(name, owner=type(self).__name__, name="name"))
            or UNNAMED,
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
        return as_quantity(self.si.time_step, TIME)

    @property
    def duration(self) -> Quantity:
        """Time from the first to the last sample [s]."""
        return as_quantity(self.si.duration, TIME)

    @property
    def acceleration(self) -> Quantity:
        """Horizontal acceleration of the ground, a copy of the samples [m s^-2]."""
        return as_quantity(self.si.horizontal.samples, ACCELERATION)

    @property
    def vertical_acceleration(self) -> Quantity | None:
        """Vertical acceleration of the ground, upwards, or None [m s^-2]."""
        vertical = self.si.vertical
        return None if vertical is None else as_quantity(vertical.samples, ACCELERATION)

    @property
    def velocity(self) -> Quantity:
        """Horizontal velocity of the ground at the samples, from rest [m s^-1]."""
        return as_quantity(knots_of(ground_path(self.si.horizontal)[0]), VELOCITY)

    @property
    def displacement(self) -> Quantity:
        """Horizontal displacement of the ground at the samples, from rest [m]."""
        return as_quantity(knots_of(ground_path(self.si.horizontal)[1]), LENGTH)

    @property
    def peak_acceleration(self) -> Quantity:
        """Greatest absolute horizontal acceleration, between samples too [m s^-2]."""
        return as_quantity(self.si.peak, ACCELERATION)

    @property
    def peak_velocity(self) -> Quantity:
        """Greatest absolute horizontal velocity from rest, between samples too [m s^-1]."""
        return as_quantity(absolute_peak(ground_path(self.si.horizontal)[0]), VELOCITY)

    def __len__(self) -> int:
        return int(self.si.horizontal.samples.size)

    def __repr__(self) -> str:
        from rockframe.motion.description import display_name

        vertical = "" if self.si.vertical is None else ", with vertical"
        return (
            f"<{type(self).__name__} {display_name(self.name, self.history)!r}: "
            f"{len(self)} samples at "
            f"{self.si.time_step:.6g} s, {self.si.duration:.6g} s long, "
            f"peak {self.si.peak:.5g} m/s^2{vertical}>"
        )

    def _repr_html_(self) -> str:
        from rockframe.motion.description import motion_html

        return motion_html(self)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MotionValue):
            return NotImplemented
        mine = (self.sha256, self.name, dict(self.metadata), self.history)
        return mine == (other.sha256, other.name, dict(other.metadata), other.history)

    def __hash__(self) -> int:
        return hash((type(self).__name__, self.sha256))

    def __reduce__(self) -> tuple[Any, ...]:
        recipe = None if self.recipe is None else dict(self.recipe)
        return (
            _rebuild,
            (type(self), self.si, self.name, dict(self.metadata), self.history, recipe),
        )


def _rebuild(
    kind: type[MotionType],
    si: Motion,
    name: str,
    metadata: dict[str, str | float | int],
    history: tuple[str, ...],
    recipe: dict[str, Any] | None,
) -> MotionType:
    return kind(si, name=name, metadata=metadata, history=history, recipe=recipe)


def _one_line(text: str) -> str:
    if not text.isprintable():
        text = "".join(letter if letter.isprintable() else " " for letter in text)
    return " ".join(text.split())


class _OneLine(str):
    """A sentence of a history on one line; a copy is not processed again."""

    __slots__ = ()

    def __new__(cls, text: str) -> _OneLine:
        return text if isinstance(text, cls) else super().__new__(cls, _one_line(text))


def to_dict(motion: MotionValue, *, samples: bool = False) -> dict[str, Any]:
    """Describe the motion: an analytic one completely, a record by its digest.

    Parameters
    ----------
    samples : bool
        Whether the description of a record contains its samples, metadata and history.

    Returns
    -------
    dict
        Values for JSON: constructor and arguments of an analytic motion, with the
        ``operations`` on it since; ``constructor`` is None for a motion that is known by its
        samples only.

    Examples
    --------
    >>> import rockframe as rf
    >>> rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s").to_dict()["constructor"]
    'half_sine_pulse'
    """
    kind = {"type": type(motion).__name__}
    if motion.recipe is not None:
        return {**kind, **motion.recipe}
    known = {**kind, "constructor": None, "name": motion.name, "sha256": motion.sha256}
    if not checked_bool(samples, owner=f"{type(motion).__name__}.to_dict", name="samples"):
        return known
    return {
        **known,
        "metadata": dict(motion.metadata),
        "history": list(motion.history),
        "time_step": motion.si.time_step,
        "horizontal": _signal_as_dict(motion.si.horizontal),
        "vertical": None if motion.si.vertical is None else _signal_as_dict(motion.si.vertical),
    }


def _signal_as_dict(signal: Signal) -> dict[str, list[Any]]:
    arrays = {"samples": signal.samples, "polynomials": signal.polynomials}
    return {name: array.tolist() for name, array in arrays.items() if array is not None}
