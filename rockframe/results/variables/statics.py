"""Variables of a system without motion: held at an angle, at rest, moving a little."""

from typing import Final

from rockframe.dynamics.events import ContactState
from rockframe.results.variables.variable import ANGLE, MODE, Variable, counting, flag
from rockframe.units import Unit

MODE_BODY: Final = ("mode", "body")

HELD: Final = (
    Variable("angle", ANGLE, Unit.RADIAN, "rotation at which the body is held"),
    Variable(
        "restoring_moment",
        ANGLE,
        Unit.NEWTON_METRE,
        "couple that holds the body: base moment less the weight's about the middle of the base",
    ),
    Variable(
        "base_moment",
        ANGLE,
        Unit.NEWTON_METRE,
        "moment of the base's vertical reactions about its middle, against the rotation",
    ),
    Variable(
        "held_vertical_displacement",
        ANGLE,
        Unit.METRE,
        "vertical displacement of the centre of mass from rest, while held",
    ),
    flag("held_contact_state", ANGLE, "corner that bears while held", ContactState),
    Variable("held_left_reaction", ANGLE, Unit.NEWTON, "reaction at the left corner while held"),
    Variable("held_right_reaction", ANGLE, Unit.NEWTON, "reaction at the right corner while held"),
    Variable("held_soil_reaction", ANGLE, Unit.NEWTON, "vertical reaction of the soil while held"),
    Variable("held_contact_length", ANGLE, Unit.METRE, "length that bears on the soil while held"),
    Variable(
        "held_cap_rotation", ANGLE, Unit.RADIAN, "rotation of the cap while the block is held"
    ),
)
"""Quasi-static states over the angle at which the body is held."""

REST: Final = (
    Variable("pad_settlement", (), Unit.METRE, "settlement of the pads under the weight"),
    Variable("soil_settlement", (), Unit.METRE, "settlement of the soil under the weight"),
    Variable("static_left_reaction", (), Unit.NEWTON, "reaction at the left corner at rest"),
    Variable("static_right_reaction", (), Unit.NEWTON, "reaction at the right corner at rest"),
    Variable("static_soil_reaction", (), Unit.NEWTON, "reaction of the soil at rest"),
    Variable("uplift_moment", (), Unit.NEWTON_METRE, "base moment at which contact is first lost"),
    Variable(
        "soil_uplift_moment",
        (),
        Unit.NEWTON_METRE,
        "moment of the soil's reaction at which the cap first loses contact",
    ),
)
"""Scalars of a system at rest."""

MODES: Final = (
    counting("mode", "number of the mode, from slow to fast"),
    Variable("angular_frequency", MODE, Unit.RADIAN_PER_SECOND, "angular frequency, undamped"),
    Variable("frequency", MODE, Unit.HERTZ, "cyclic frequency, undamped"),
    Variable("period", MODE, Unit.SECOND, "period, undamped"),
    Variable("damping_ratio", MODE, Unit.ONE, "damping ratio"),
    Variable(
        "vertical_displacement_shape", MODE, Unit.ONE, "share of the vertical displacement [m]"
    ),
    Variable("rotation_shape", MODE, Unit.ONE, "share of the rotation [rad]"),
    Variable("cap_vertical_displacement_shape", MODE, Unit.ONE, "share of the cap's rise [m]"),
    Variable("cap_rotation_shape", MODE, Unit.ONE, "share of the cap's rotation [rad]"),
    Variable(
        "body_rotation_shape",
        MODE_BODY,
        Unit.ONE,
        "share of each body's rotation on its base [rad]",
    ),
    Variable(
        "body_vertical_displacement_shape",
        MODE_BODY,
        Unit.ONE,
        "share of each body's rise on its base [m]",
    ),
)
"""Modes of small motion."""
