"""The one table of variables: name, unit, dimension and meaning of everything in a result."""

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Final

import numpy as np

from rockframe.dynamics.protocol import ContactState, EventKind
from rockframe.solve.layout import Status
from rockframe.units import Unit


class Direction(IntEnum):
    """Side towards which a block overturned; clockwise is right."""

    LEFT = -1
    NONE = 0
    RIGHT = 1


@dataclass(frozen=True)
class Variable:
    """A row of the table.

    Parameters
    ----------
    name : str
        Name in the dataset.
    dims : tuple of str
        ``("time",)``, ``("event",)`` or none.
    unit : Unit or None
        None for flags and truth values.
    long_name : str
        Meaning.
    flags : type of IntEnum, optional
        Values and meanings of an integer flag.
    dtype : str
        Type in the dataset.
    """

    name: str
    dims: tuple[str, ...]
    unit: Unit | None
    long_name: str
    flags: type[IntEnum] | None = None
    dtype: str = "float64"

    def attributes(self) -> dict[str, Any]:
        """Give the CF attributes."""
        attributes: dict[str, Any] = {"long_name": self.long_name}
        if self.unit is not None:
            attributes["units"] = str(self.unit)
        if self.flags is not None:
            members = sorted(self.flags, key=int)
            attributes["flag_values"] = np.array([int(m) for m in members], dtype=self.dtype)
            attributes["flag_meanings"] = " ".join(m.name.lower() for m in members)
        return attributes


_T: Final = ("time",)
_E: Final = ("event",)
_A: Final = ("angle",)
_M: Final = ("mode",)


def _flag(name: str, dims: tuple[str, ...], words: str, kind: type[IntEnum]) -> Variable:
    return Variable(name, dims, None, words, kind, "int8")


def _count(name: str, words: str) -> Variable:
    return Variable(name, (), Unit.ONE, words, dtype="int64")


def _number(name: str, words: str) -> Variable:
    return Variable(name, (name,), Unit.ONE, words, dtype="int64")


_ROWS: Final = (
    Variable("time", _T, Unit.SECOND, "time from the start of the run"),
    # response
    Variable("rotation", _T, Unit.RADIAN, "rotation of the block, clockwise positive"),
    Variable("angular_velocity", _T, Unit.RADIAN_PER_SECOND, "rate of the rotation"),
    Variable(
        "vertical_displacement",
        _T,
        Unit.METRE,
        "vertical displacement of the centre of mass from rest, relative to the ground, upwards",
    ),
    Variable(
        "vertical_velocity", _T, Unit.METRE_PER_SECOND, "rate of the vertical displacement"
    ),
    Variable(
        "horizontal_displacement",
        _T,
        Unit.METRE,
        "horizontal displacement of the centre of mass relative to the ground, to the right",
    ),
    Variable("relative_rotation", _T, Unit.ONE, "rotation over the overturning angle"),
    Variable(
        "relative_vertical_displacement",
        _T,
        Unit.ONE,
        "vertical displacement over the settlement under the weight",
    ),
    _flag("contact_state", _T, "corner that bears", ContactState),
    Variable(
        "ground_acceleration", _T, Unit.METRE_PER_SECOND_SQUARED, "horizontal ground acceleration"
    ),
    Variable(
        "vertical_ground_acceleration",
        _T,
        Unit.METRE_PER_SECOND_SQUARED,
        "vertical ground acceleration, upwards",
    ),
    Variable("left_reaction", _T, Unit.NEWTON, "reaction of the base at the left corner"),
    Variable("right_reaction", _T, Unit.NEWTON, "reaction of the base at the right corner"),
    # soil and cap
    Variable("soil_reaction", _T, Unit.NEWTON, "vertical reaction of the soil"),
    Variable("contact_length", _T, Unit.METRE, "length of the base that bears on the soil"),
    Variable("cap_rotation", _T, Unit.RADIAN, "rotation of the cap, clockwise positive"),
    Variable("cap_angular_velocity", _T, Unit.RADIAN_PER_SECOND, "rate of the cap's rotation"),
    Variable(
        "cap_vertical_displacement",
        _T,
        Unit.METRE,
        "vertical displacement of the cap's centre from rest, relative to the ground, upwards",
    ),
    Variable(
        "cap_vertical_velocity",
        _T,
        Unit.METRE_PER_SECOND,
        "rate of the cap's vertical displacement",
    ),
    _flag("soil_contact_state", _T, "end of the base that bears on the soil", ContactState),
    Variable("rotation_on_cap", _T, Unit.RADIAN, "rotation of the block relative to the cap"),
    Variable(
        "vertical_displacement_on_cap",
        _T,
        Unit.METRE,
        "displacement of the block's centre of mass from rest relative to the cap, along its axis",
    ),
    Variable(
        "cap_acceleration",
        _T,
        Unit.METRE_PER_SECOND_SQUARED,
        "absolute horizontal acceleration of the middle of the cap's top",
    ),
    Variable(
        "cap_vertical_acceleration",
        _T,
        Unit.METRE_PER_SECOND_SQUARED,
        "absolute vertical acceleration of the middle of the cap's top",
    ),
    # energies, on request
    Variable("kinetic_energy", _T, Unit.JOULE, "kinetic energy relative to the ground"),
    Variable("potential_energy", _T, Unit.JOULE, "gravity energy from rest"),
    Variable("elastic_energy", _T, Unit.JOULE, "energy of the compressed springs"),
    Variable("dissipated_energy", _T, Unit.JOULE, "energy burnt by the dashpots so far"),
    Variable("impact_energy", _T, Unit.JOULE, "energy lost in impacts so far"),
    Variable(
        "repinning_energy",
        _T,
        Unit.JOULE,
        "energy lost in changes of the horizontal restraint so far",
    ),
    Variable("input_energy", _T, Unit.JOULE, "relative energy put in by the ground so far"),
    # events
    Variable("event_time", _E, Unit.SECOND, "time of the event"),
    _flag("event_kind", _E, "kind of the event", EventKind),
    _flag("contact_state_before", _E, "corner that bore before the event", ContactState),
    _flag("contact_state_after", _E, "corner that bears after the event", ContactState),
    _flag("soil_contact_state_before", _E, "end that bore on the soil before", ContactState),
    _flag("soil_contact_state_after", _E, "end that bears on the soil after", ContactState),
    Variable("event_rotation", _E, Unit.RADIAN, "rotation at the event"),
    Variable(
        "angular_velocity_before",
        _E,
        Unit.RADIAN_PER_SECOND,
        "rate of the rotation before the event",
    ),
    Variable(
        "angular_velocity_after",
        _E,
        Unit.RADIAN_PER_SECOND,
        "rate of the rotation after the event",
    ),
    # scalars
    Variable("overturned", (), None, "whether the rotation reached the overturning angle",
             dtype="bool"),
    Variable("overturning_time", (), Unit.SECOND, "time of overturning, NaN if none"),
    _flag("overturning_direction", (), "side towards which the block overturned", Direction),
    Variable("peak_rotation", (), Unit.RADIAN, "largest absolute rotation"),
    Variable(
        "peak_relative_rotation", (), Unit.ONE, "largest absolute rotation over overturning angle"
    ),
    Variable("first_uplift_time", (), Unit.SECOND, "time contact is first lost, NaN if never"),
    _count("impact_count", "number of impacts"),
    Variable("flight_time", (), Unit.SECOND, "time without any contact"),
    _count("flight_count", "number of flights"),
    Variable(
        "energy_residual", (), Unit.ONE, "largest energy imbalance over the largest energy term"
    ),
    _flag("status", (), "how the run ended", Status),
    Variable("overturning_angle", (), Unit.RADIAN, "rotation of unstable equilibrium, theta"),
    Variable(
        "uplift_angle",
        (),
        Unit.RADIAN,
        "rotation of the block on its base at which contact is first lost at rest",
    ),
    # quasi-static states over the angle at which the body is held
    Variable("angle", _A, Unit.RADIAN, "rotation at which the body is held"),
    Variable(
        "restoring_moment",
        _A,
        Unit.NEWTON_METRE,
        "couple that holds the body: base moment less the weight's about the middle of the base",
    ),
    Variable(
        "base_moment",
        _A,
        Unit.NEWTON_METRE,
        "moment of the base's vertical reactions about its middle, against the rotation",
    ),
    Variable(
        "held_vertical_displacement",
        _A,
        Unit.METRE,
        "vertical displacement of the centre of mass from rest, while held",
    ),
    _flag("held_contact_state", _A, "corner that bears while held", ContactState),
    Variable("held_left_reaction", _A, Unit.NEWTON, "reaction at the left corner while held"),
    Variable("held_right_reaction", _A, Unit.NEWTON, "reaction at the right corner while held"),
    Variable("held_soil_reaction", _A, Unit.NEWTON, "vertical reaction of the soil while held"),
    Variable("held_contact_length", _A, Unit.METRE, "length that bears on the soil while held"),
    Variable("held_cap_rotation", _A, Unit.RADIAN, "rotation of the cap while the block is held"),
    # rest
    Variable("pad_settlement", (), Unit.METRE, "settlement of the pads under the weight"),
    Variable("soil_settlement", (), Unit.METRE, "settlement of the soil under the weight"),
    Variable("static_left_reaction", (), Unit.NEWTON, "reaction at the left corner at rest"),
    Variable("static_right_reaction", (), Unit.NEWTON, "reaction at the right corner at rest"),
    Variable("static_soil_reaction", (), Unit.NEWTON, "reaction of the soil at rest"),
    Variable(
        "uplift_moment", (), Unit.NEWTON_METRE, "base moment at which contact is first lost"
    ),
    Variable(
        "soil_uplift_moment",
        (),
        Unit.NEWTON_METRE,
        "moment of the soil's reaction at which the cap first loses contact",
    ),
    # modes of small motion
    _number("mode", "number of the mode, from slow to fast"),
    Variable("angular_frequency", _M, Unit.RADIAN_PER_SECOND, "angular frequency, undamped"),
    Variable("frequency", _M, Unit.HERTZ, "cyclic frequency, undamped"),
    Variable("period", _M, Unit.SECOND, "period, undamped"),
    Variable("damping_ratio", _M, Unit.ONE, "damping ratio"),
    Variable("vertical_displacement_shape", _M, Unit.ONE, "share of the vertical displacement [m]"),
    Variable("rotation_shape", _M, Unit.ONE, "share of the rotation [rad]"),
    Variable("cap_vertical_displacement_shape", _M, Unit.ONE, "share of the cap's rise [m]"),
    Variable("cap_rotation_shape", _M, Unit.ONE, "share of the cap's rotation [rad]"),
)  # fmt: skip

SCHEMA: Final = {row.name: row for row in _ROWS}
"""All variables by name."""

COORDINATES: Final = ("time", "angle", "mode")
"""Variables that label a dimension."""

ENERGIES: Final = (
    "kinetic_energy",
    "potential_energy",
    "elastic_energy",
    "dissipated_energy",
    "impact_energy",
    "repinning_energy",
    "input_energy",
)
"""Histories that are computed only on request."""

SCHEMA_VERSION: Final = 1
