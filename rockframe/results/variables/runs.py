"""Variables of a run: histories, energies, events and scalars; of answers that need no run."""

from enum import IntEnum
from typing import Final

from rockframe.dynamics.events import ContactState, EventKind
from rockframe.results.variables.variable import (
    AFTER_END,
    ANGLE,
    EVENT,
    MODE,
    TIME,
    Variable,
    count,
    counting,
    flag,
    number,
    whether,
)
from rockframe.solve.workspace import Status
from rockframe.units import Unit


class Direction(IntEnum):
    """Side towards which a block overturned; clockwise is right."""

    LEFT = -1
    NONE = 0
    RIGHT = 1


class RunStatus(IntEnum):
    """How a run ended, :class:`rockframe.solve.workspace.Status`; or why a case has none."""

    COMPLETED = Status.COMPLETED
    OVERTURNED = Status.OVERTURNED
    TOPPLED = Status.TOPPLED
    STEP_LIMIT = Status.STEP_LIMIT
    STEP_TOO_SMALL = Status.STEP_TOO_SMALL
    CHATTER = Status.CHATTER
    REFUSED = 6
    NOT_RUN = 7


HISTORIES: Final = (
    Variable("time", TIME, Unit.SECOND, "time from the start of the run"),
    # response
    Variable("rotation", TIME, Unit.RADIAN, "rotation of the block, clockwise positive"),
    Variable("angular_velocity", TIME, Unit.RADIAN_PER_SECOND, "rate of the rotation"),
    Variable(
        "vertical_displacement",
        TIME,
        Unit.METRE,
        "vertical displacement of the centre of mass from rest, relative to the ground, upwards",
    ),
    Variable("vertical_velocity", TIME, Unit.METRE_PER_SECOND, "rate of the vertical displacement"),
    Variable(
        "horizontal_displacement",
        TIME,
        Unit.METRE,
        "horizontal displacement of the centre of mass relative to the ground, to the right",
    ),
    number("relative_rotation", "rotation over the overturning angle", TIME),
    number(
        "relative_vertical_displacement",
        "vertical displacement over the settlement under the weight",
        TIME,
    ),
    flag("contact_state", TIME, "corner that bears", ContactState),
    Variable(
        "ground_acceleration", TIME, Unit.METRE_PER_SECOND_SQUARED, "horizontal ground acceleration"
    ),
    Variable(
        "vertical_ground_acceleration",
        TIME,
        Unit.METRE_PER_SECOND_SQUARED,
        "vertical ground acceleration, upwards",
    ),
    Variable(
        "base_shear",
        TIME,
        Unit.NEWTON,
        "horizontal force of the ground on what stands on it, to the right",
    ),
    Variable("left_reaction", TIME, Unit.NEWTON, "reaction of the base at the left corner"),
    Variable("right_reaction", TIME, Unit.NEWTON, "reaction of the base at the right corner"),
    # soil and cap
    Variable("soil_reaction", TIME, Unit.NEWTON, "vertical reaction of the soil"),
    Variable("contact_length", TIME, Unit.METRE, "length of the base that bears on the soil"),
    Variable("cap_rotation", TIME, Unit.RADIAN, "rotation of the cap, clockwise positive"),
    Variable("cap_angular_velocity", TIME, Unit.RADIAN_PER_SECOND, "rate of the cap's rotation"),
    Variable(
        "cap_vertical_displacement",
        TIME,
        Unit.METRE,
        "vertical displacement of the cap's centre from rest, relative to the ground, upwards",
    ),
    Variable(
        "cap_vertical_velocity",
        TIME,
        Unit.METRE_PER_SECOND,
        "rate of the cap's vertical displacement",
    ),
    flag("soil_contact_state", TIME, "end of the base that bears on the soil", ContactState),
    Variable("rotation_on_cap", TIME, Unit.RADIAN, "rotation of the block relative to the cap"),
    Variable(
        "vertical_displacement_on_cap",
        TIME,
        Unit.METRE,
        "displacement of the block's centre of mass from rest relative to the cap, along its axis",
    ),
    Variable(
        "cap_acceleration",
        TIME,
        Unit.METRE_PER_SECOND_SQUARED,
        "absolute horizontal acceleration of the middle of the cap's top",
    ),
    Variable(
        "cap_vertical_acceleration",
        TIME,
        Unit.METRE_PER_SECOND_SQUARED,
        "absolute vertical acceleration of the middle of the cap's top",
    ),
)
"""Over time, wherever the scene has them."""

MOTION_AFTER_END: Final = (
    Variable(
        "ground_acceleration_after_end",
        AFTER_END,
        Unit.METRE_PER_SECOND_SQUARED,
        "samples of the horizontal ground acceleration that follow those of the histories",
    ),
    Variable(
        "vertical_ground_acceleration_after_end",
        AFTER_END,
        Unit.METRE_PER_SECOND_SQUARED,
        "samples of the vertical ground acceleration that follow those of the histories, upwards",
    ),
)
ENERGY_HISTORIES: Final = (
    Variable("kinetic_energy", TIME, Unit.JOULE, "kinetic energy relative to the ground"),
    Variable("potential_energy", TIME, Unit.JOULE, "gravity energy from rest"),
    Variable("elastic_energy", TIME, Unit.JOULE, "energy of the compressed springs"),
    Variable("dissipated_energy", TIME, Unit.JOULE, "energy dissipated by the base so far"),
    Variable("impact_energy", TIME, Unit.JOULE, "energy lost in impacts so far"),
    Variable(
        "repinning_energy",
        TIME,
        Unit.JOULE,
        "energy lost in changes of the horizontal restraint so far",
    ),
    Variable("input_energy", TIME, Unit.JOULE, "relative energy put in by the ground so far"),
)
"""Over time, only on request."""

EVENTS_AND_SCALARS: Final = (
    # events
    Variable("event_time", EVENT, Unit.SECOND, "time of the event"),
    flag("event_kind", EVENT, "kind of the event", EventKind),
    flag("contact_state_before", EVENT, "corner that bore before the event", ContactState),
    flag("contact_state_after", EVENT, "corner that bears after the event", ContactState),
    flag("soil_contact_state_before", EVENT, "end that bore on the soil before", ContactState),
    flag("soil_contact_state_after", EVENT, "end that bears on the soil after", ContactState),
    Variable("event_rotation", EVENT, Unit.RADIAN, "rotation at the event"),
    Variable(
        "angular_velocity_before",
        EVENT,
        Unit.RADIAN_PER_SECOND,
        "rate of the rotation before the event",
    ),
    Variable(
        "angular_velocity_after",
        EVENT,
        Unit.RADIAN_PER_SECOND,
        "rate of the rotation after the event",
    ),
    # scalars
    whether("overturned", "whether the rotation reached the overturning angle"),
    Variable("overturning_time", (), Unit.SECOND, "time of overturning, NaN if none"),
    flag("overturning_direction", (), "side towards which the block overturned", Direction),
    Variable("peak_rotation", (), Unit.RADIAN, "largest absolute rotation"),
    number(
        "peak_relative_rotation",
        "largest rotation over the overturning angle of its side, of the body that came closest",
    ),
    Variable("first_uplift_time", (), Unit.SECOND, "time contact is first lost, NaN if never"),
    count("impact_count", "number of impacts, those that end in rest among them"),
    Variable("flight_time", (), Unit.SECOND, "time without any contact"),
    count("flight_count", "number of flights"),
    number("energy_residual", "largest energy imbalance over the largest energy term"),
    flag("status", (), "how the run ended", RunStatus),
    Variable(
        "overturning_angle",
        (),
        Unit.RADIAN,
        "rotation of unstable equilibrium, theta, on the side where it is less",
    ),
    Variable("left_overturning_angle", (), Unit.RADIAN, "rotation to the left that overturns"),
    Variable("right_overturning_angle", (), Unit.RADIAN, "rotation to the right that overturns"),
    Variable("left_peak_rotation", (), Unit.RADIAN, "largest rotation to the left"),
    Variable("right_peak_rotation", (), Unit.RADIAN, "largest rotation to the right"),
    Variable("rest_rotation", (), Unit.RADIAN, "rotation at rest, under the weight alone"),
    Variable(
        "uplift_angle",
        (),
        Unit.RADIAN,
        "rotation of the block on its base at which contact is first lost at rest",
    ),
)
"""Over events, and one for the run."""

CERTIFICATE: Final = (
    whether(
        "verdict_converged",
        "whether runs by finer means have the same verdict, by more than they differ",
    ),
    whether(
        "verdict_robust", "whether runs with a parameter or the scale nudged have the same verdict"
    ),
    number(
        "verdict_margin",
        "largest relative change of the motion's scale up to which no other verdict was found",
    ),
    number(
        "verdict_flip_scale",
        "scale of the motion nearest to 1 that was found to change the verdict, NaN if none",
    ),
    Variable(
        "peak_error_estimate",
        (),
        Unit.RADIAN,
        "three times the largest difference of the peak rotation from a run by finer means",
    ),
    Variable(
        "peak_sensitivity",
        (),
        Unit.RADIAN,
        "largest difference of the peak rotation from that of a run with a nudged parameter",
    ),
)
"""How sure the verdict is, on request."""

PROOF: Final = (
    whether("verdict_proved", "whether the verdict is proved"),
    Variable(
        "proved_overturning_earliest",
        (),
        Unit.SECOND,
        "time before which it is proved not to have overturned, NaN unless it is proved to",
    ),
    Variable(
        "proved_overturning_latest",
        (),
        Unit.SECOND,
        "time by which it is proved to have overturned, NaN unless it is",
    ),
    Variable(
        "proof_width", (), Unit.RADIAN, "greatest radius of the rotations that a proof encloses"
    ),
)
"""What is proved of the verdict, on request."""


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
    number("damping_ratio", "damping ratio", MODE),
    number("vertical_displacement_shape", "share of the vertical displacement [m]", MODE),
    number("rotation_shape", "share of the rotation [rad]", MODE),
    number("cap_vertical_displacement_shape", "share of the cap's rise [m]", MODE),
    number("cap_rotation_shape", "share of the cap's rotation [rad]", MODE),
    number("body_rotation_shape", "share of each body's rotation on its base [rad]", MODE_BODY),
    number(
        "body_vertical_displacement_shape", "share of each body's rise on its base [m]", MODE_BODY
    ),
)
"""Modes of small motion."""
