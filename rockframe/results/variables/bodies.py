"""Variables of all bodies of a stack, and of all restrainers."""

from typing import Final

from rockframe.dynamics.events import ContactState, LinkState
from rockframe.results.variables.variable import EVENT, Variable, count, counting, flag
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
    Variable("body_slip", BODY_TIME, Unit.METRE, "slip of each body on what it stands on"),
    flag("body_contact_state", BODY_TIME, "part of the base of each body that bears", ContactState),
    Variable("peak_body_rotation", BODY, Unit.RADIAN, "greatest rotation of each body"),
    Variable("peak_body_slip", BODY, Unit.METRE, "largest absolute slip of each body"),
    Variable(
        "event_body", EVENT, Unit.ONE, "number of the body whose contact changed", dtype="int64"
    ),
)
"""What a run of a stack has beside that of its highest body."""

OF_EACH_BODY: Final = {
    "body_rotation": "rotation",
    "body_angular_velocity": "angular_velocity",
    "body_horizontal_displacement": "horizontal_displacement",
    "body_vertical_displacement": "vertical_displacement",
    "body_rotation_on_base": "rotation_on_base",
    "body_horizontal_reaction": "horizontal_reaction",
    "body_vertical_reaction": "vertical_reaction",
}
"""Histories of all bodies, and the columns of each that they are made of."""


RESTRAINER: Final = ("restrainer",)
RESTRAINER_TIME: Final = ("restrainer", "time")

RESTRAINERS: Final = (
    Variable("restrainer", RESTRAINER, None, "name of the restrainer", dtype="str"),
    Variable(
        "restrainer_force",
        RESTRAINER_TIME,
        Unit.NEWTON,
        "force with which each restrainer pulls its points together",
    ),
    Variable(
        "restrainer_elongation",
        RESTRAINER_TIME,
        Unit.METRE,
        "elongation of each restrainer from where it was given",
    ),
    flag("restrainer_state", RESTRAINER_TIME, "state of each restrainer", LinkState),
    Variable(
        "peak_restrainer_force",
        RESTRAINER,
        Unit.NEWTON,
        "largest absolute force of each restrainer up to overturning",
    ),
    Variable(
        "event_restrainer",
        EVENT,
        Unit.ONE,
        "number of the restrainer that changed, 0 at events of bodies",
        dtype="int64",
    ),
    Variable(
        "static_restrainer_force", RESTRAINER, Unit.NEWTON, "force of each restrainer at rest"
    ),
    Variable(
        "static_restrainer_elongation",
        RESTRAINER,
        Unit.METRE,
        "elongation of each restrainer at rest from where it was given",
    ),
)
"""What a scene with restrainers has beside others."""

RESTRAINER_SCALARS: Final = (count("broken_restrainer_count", "number of restrainers that broke"),)

OF_EACH_LINK: Final = ("restrainer_force", "restrainer_elongation", "restrainer_state")
"""Histories of all restrainers, and the columns of each that they are made of."""
