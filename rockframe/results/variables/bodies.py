"""Variables of all bodies of a stack."""

from typing import Final

from rockframe.dynamics.events import ContactState
from rockframe.results.variables.variable import EVENT, Variable, counting, flag
from rockframe.units import Unit

BODY: Final = ("body",)
BODY_TIME: Final = ("body", "time")

BODIES: Final = (
    counting("body", "number of a body of a stack, from the top down"),
    Variable("body_rotation", BODY_TIME, Unit.RADIAN, "rotation of each body, clockwise"),
    Variable("body_angular_velocity", BODY_TIME, Unit.RADIAN_PER_SECOND, "its rate, of each body"),
    Variable(
        "body_horizontal_displacement",
        BODY_TIME,
        Unit.METRE,
        "horizontal displacement of each centre of mass from rest, relative to the ground",
    ),
    Variable(
        "body_vertical_displacement",
        BODY_TIME,
        Unit.METRE,
        "vertical displacement of each centre of mass from rest, relative to the ground",
    ),
    Variable(
        "body_rotation_on_base", BODY_TIME, Unit.RADIAN, "rotation of each body on the one below"
    ),
    Variable(
        "body_horizontal_reaction",
        BODY_TIME,
        Unit.NEWTON,
        "force of what each body stands on, along that, to the right",
    ),
    Variable(
        "body_vertical_reaction",
        BODY_TIME,
        Unit.NEWTON,
        "force of what each body stands on, normal to that, upwards",
    ),
    flag("body_contact_state", BODY_TIME, "part of the base of each body that bears", ContactState),
    Variable("peak_body_rotation", BODY, Unit.RADIAN, "greatest rotation of each body"),
    Variable(
        "event_body", EVENT, Unit.ONE, "number of the body whose contact changed", dtype="int64"
    ),
)
"""What a run of a stack has beside that of its highest body."""

OF_EACH: Final = {
    "body_rotation": "rotation",
    "body_angular_velocity": "angular_velocity",
    "body_horizontal_displacement": "horizontal_displacement",
    "body_vertical_displacement": "vertical_displacement",
    "body_rotation_on_base": "rotation_on_base",
    "body_horizontal_reaction": "horizontal_reaction",
    "body_vertical_reaction": "vertical_reaction",
}
"""Histories of all bodies, and the columns of each that they are made of."""
