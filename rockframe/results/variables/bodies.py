"""Variables of all bodies of a stack, and of all restrainers."""

from typing import Final

from rockframe.dynamics.events import ContactState, LinkState
from rockframe.results.variables.variable import EVENT, rows_over

BODY: Final = ("body",)
BODY_TIME: Final = ("body", "time")

BODIES: Final = (
    *rows_over(BODY, body=("number of a body of a stack, from the top down", int)),
    *rows_over(
        BODY_TIME,
        body_rotation="rotation of each body, clockwise [rad]",
        body_angular_velocity="rate of the rotation of each body [rad s^-1]",
        body_horizontal_displacement="horizontal displacement of each centre of mass from rest, "
        "relative to the ground [m]",
        body_vertical_displacement="vertical displacement of each centre of mass from rest, "
        "relative to the ground [m]",
        body_rotation_on_base="rotation of each body on the one below [rad]",
        body_horizontal_reaction="force of its support on each body, along the support, to the "
        "right [N]",
        body_vertical_reaction="force of its support on each body, normal to the support, upwards "
        "[N]",
        body_slip="slip of each body on its support [m]",
        body_contact_state=("part of the base of each body that bears", ContactState),
    ),
    *rows_over(
        BODY,
        peak_body_rotation="greatest rotation of each body [rad]",
        peak_body_slip="largest absolute slip of each body [m]",
    ),
    *rows_over(EVENT, event_body=("number of the body whose contact changed", int)),
)
"""Variables of a run of a stack, beside those of its highest body."""

OF_EACH_BODY: Final = {
    "body_rotation": "rotation",
    "body_angular_velocity": "angular_velocity",
    "body_horizontal_displacement": "horizontal_displacement",
    "body_vertical_displacement": "vertical_displacement",
    "body_rotation_on_base": "rotation_on_base",
    "body_horizontal_reaction": "horizontal_reaction",
    "body_vertical_reaction": "vertical_reaction",
}
"""Histories of all bodies, and the column of each body that they are made of."""


RESTRAINER: Final = ("restrainer",)
RESTRAINER_TIME: Final = ("restrainer", "time")

RESTRAINERS: Final = (
    *rows_over(RESTRAINER, restrainer=("name of the restrainer", str)),
    *rows_over(
        RESTRAINER_TIME,
        restrainer_force="force with which each restrainer pulls its points together, or a wall "
        "presses [N]",
        restrainer_elongation="elongation of each restrainer from its initial length [m]",
        restrainer_state=("state of each restrainer", LinkState),
    ),
    *rows_over(
        RESTRAINER,
        peak_restrainer_force="largest absolute force of each restrainer up to overturning [N]",
    ),
    *rows_over(
        EVENT,
        event_restrainer=("number of the restrainer that changed, 0 at events of bodies", int),
    ),
    *rows_over(
        RESTRAINER,
        static_restrainer_force="force of each restrainer at rest [N]",
        static_restrainer_elongation="elongation of each restrainer at rest from where it was "
        "given [m]",
    ),
)
"""Variables that only scenes with restrainers have."""

RESTRAINER_SCALARS: Final = rows_over(
    (),
    broken_restrainer_count=("number of restrainers that broke", int),
)

OF_EACH_LINK: Final = ("restrainer_force", "restrainer_elongation", "restrainer_state")
"""Histories of all restrainers; the columns of a model have the same names."""
