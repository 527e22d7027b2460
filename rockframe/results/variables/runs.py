"""Variables of a run: histories, energies, events and scalars; also of statics, without a run."""

from enum import IntEnum
from typing import Final

from rockframe.dynamics.events import ContactState, EventKind
from rockframe.results.variables.variable import AFTER_END, ANGLE, EVENT, MODE, TIME, rows_over
from rockframe.solve.workspace import Status


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


HISTORIES: Final = rows_over(
    TIME,
    time="time from the start of the run [s]",
    rotation="rotation of the block, clockwise positive [rad]",
    angular_velocity="rate of the rotation [rad s^-1]",
    vertical_displacement="vertical displacement of the centre of mass from rest, relative to the "
    "ground, upwards [m]",
    vertical_velocity="rate of the vertical displacement [m s^-1]",
    horizontal_displacement="horizontal displacement of the centre of mass relative to the ground, "
    "to the right [m]",
    relative_rotation="rotation over the overturning angle",
    relative_vertical_displacement="vertical displacement over the settlement under the weight",
    contact_state=("corner that bears", ContactState),
    ground_acceleration="horizontal ground acceleration [m s^-2]",
    vertical_ground_acceleration="vertical ground acceleration, upwards [m s^-2]",
    base_shear="horizontal force of the ground on all bodies above it, to the right [N]",
    left_reaction="reaction of the base at the left corner [N]",
    right_reaction="reaction of the base at the right corner [N]",
    # soil and cap
    soil_reaction="vertical reaction of the soil [N]",
    contact_length="length of the base that bears on the soil [m]",
    cap_rotation="rotation of the cap, clockwise positive [rad]",
    cap_angular_velocity="rate of the cap's rotation [rad s^-1]",
    cap_vertical_displacement="vertical displacement of the cap's centre from rest, relative to "
    "the ground, upwards [m]",
    cap_vertical_velocity="rate of the cap's vertical displacement [m s^-1]",
    soil_contact_state=("end of the base that bears on the soil", ContactState),
    rotation_on_cap="rotation of the block relative to the cap [rad]",
    vertical_displacement_on_cap="displacement of the block's centre of mass from rest relative to "
    "the cap, along its axis [m]",
    cap_acceleration="absolute horizontal acceleration of the middle of the cap's top [m s^-2]",
    cap_vertical_acceleration="absolute vertical acceleration of the middle of the cap's top "
    "[m s^-2]",
)
"""Histories, as far as the scene has them."""

MOTION_AFTER_END: Final = rows_over(
    AFTER_END,
    ground_acceleration_after_end="samples of the horizontal ground acceleration that follow those "
    "of the histories [m s^-2]",
    vertical_ground_acceleration_after_end="samples of the vertical ground acceleration that "
    "follow those of the histories, upwards [m s^-2]",
)
ENERGY_HISTORIES: Final = rows_over(
    TIME,
    kinetic_energy="kinetic energy relative to the ground [J]",
    potential_energy="gravity energy from rest [J]",
    elastic_energy="energy of the compressed springs [J]",
    dissipated_energy="energy dissipated by the base so far [J]",
    impact_energy="energy lost in impacts so far [J]",
    repinning_energy="energy lost in changes of the horizontal restraint so far [J]",
    input_energy="relative energy put in by the ground so far [J]",
)
"""Histories of energies, only on request."""

EVENTS_AND_SCALARS: Final = (
    *rows_over(
        EVENT,
        event_time="time of the event [s]",
        event_kind=("kind of the event", EventKind),
        contact_state_before=("corner that bore before the event", ContactState),
        contact_state_after=("corner that bears after the event", ContactState),
        soil_contact_state_before=("end that bore on the soil before", ContactState),
        soil_contact_state_after=("end that bears on the soil after", ContactState),
        event_rotation="rotation at the event [rad]",
        angular_velocity_before="rate of the rotation before the event [rad s^-1]",
        angular_velocity_after="rate of the rotation after the event [rad s^-1]",
    ),
    *rows_over(
        (),
        overturned=("whether the rotation reached the overturning angle", bool),
        overturning_time="time of overturning, NaN if none [s]",
        overturning_direction=("side towards which the block overturned", Direction),
        peak_rotation="largest absolute rotation [rad]",
        peak_relative_rotation="largest rotation over the overturning angle of its side, of the "
        "body that came closest",
        first_uplift_time="time contact is first lost, NaN if never [s]",
        impact_count=("number of impacts, those that end in rest among them", int),
        flight_time="time without any contact [s]",
        flight_count=("number of flights", int),
        energy_residual="largest energy imbalance over the largest energy term",
        status=("how the run ended", RunStatus),
        overturning_angle="rotation of unstable equilibrium, theta, on the side where it is less "
        "[rad]",
        left_overturning_angle="rotation to the left that overturns [rad]",
        right_overturning_angle="rotation to the right that overturns [rad]",
        left_peak_rotation="largest rotation to the left [rad]",
        right_peak_rotation="largest rotation to the right [rad]",
        rest_rotation="rotation at rest, under the weight alone [rad]",
        uplift_angle="rotation of the block on its base at which contact is first lost at rest "
        "[rad]",
    ),
)
"""Variables over events, and scalars of the run."""

CERTIFICATE: Final = rows_over(
    (),
    verdict_converged=(
        "whether runs of higher accuracy have the same verdict, with a margin of more than their "
        "differences",
        bool,
    ),
    verdict_robust=(
        "whether runs with a parameter or the scale slightly changed have the same verdict",
        bool,
    ),
    verdict_margin="largest relative change of the motion's scale up to which no other verdict was "
    "found",
    verdict_flip_scale="scale of the motion nearest to 1 that was found to change the verdict, NaN "
    "if none",
    peak_error_estimate="three times the largest difference of the peak rotation from a run "
    "of higher accuracy [rad]",
    peak_sensitivity="largest difference of the peak rotation from that of a run with a "
    "slightly changed parameter [rad]",
)
"""Certificate: how sure the verdict is, on request."""

PROOF: Final = rows_over(
    (),
    verdict_proved=("whether the verdict is proved", bool),
    proved_overturning_earliest="time before which the block is proved not to overturn, NaN unless "
    "it is proved to overturn [s]",
    proved_overturning_latest="time by which the block is proved to have overturned, NaN unless it "
    "is proved to overturn [s]",
    proof_width="greatest radius of the rotations that a proof encloses [rad]",
)
"""Proof of the verdict, on request."""


MODE_BODY: Final = ("mode", "body")

HELD: Final = rows_over(
    ANGLE,
    angle="rotation at which the body is held [rad]",
    restoring_moment="couple that holds the body: base moment less the weight's about the middle "
    "of the base [N m]",
    base_moment="moment of the base's vertical reactions about its middle, against the rotation "
    "[N m]",
    held_vertical_displacement="vertical displacement of the centre of mass from rest, while held "
    "[m]",
    held_contact_state=("corner that bears while held", ContactState),
    held_left_reaction="reaction at the left corner while held [N]",
    held_right_reaction="reaction at the right corner while held [N]",
    held_soil_reaction="vertical reaction of the soil while held [N]",
    held_contact_length="length that bears on the soil while held [m]",
    held_cap_rotation="rotation of the cap while the block is held [rad]",
)
"""Quasi-static states over the angle at which the body is held."""

REST: Final = rows_over(
    (),
    pad_settlement="settlement of the pads under the weight [m]",
    soil_settlement="settlement of the soil under the weight [m]",
    static_left_reaction="reaction at the left corner at rest [N]",
    static_right_reaction="reaction at the right corner at rest [N]",
    static_soil_reaction="reaction of the soil at rest [N]",
    uplift_moment="base moment at which contact is first lost [N m]",
    soil_uplift_moment="moment of the soil's reaction at which the cap first loses contact [N m]",
)
"""Scalars of a system at rest."""

MODES: Final = (
    *rows_over(
        MODE,
        mode=("number of the mode, from slow to fast", int),
        angular_frequency="angular frequency, undamped [rad s^-1]",
        frequency="cyclic frequency, undamped [Hz]",
        period="period, undamped [s]",
        damping_ratio="damping ratio",
        vertical_displacement_shape="share of the vertical displacement [m] [1]",
        rotation_shape="share of the rotation [rad] [1]",
        cap_vertical_displacement_shape="share of the cap's rise [m] [1]",
        cap_rotation_shape="share of the cap's rotation [rad] [1]",
    ),
    *rows_over(
        MODE_BODY,
        body_rotation_shape="share of each body's rotation on its base [rad] [1]",
        body_vertical_displacement_shape="share of each body's rise on its base [m] [1]",
    ),
)
"""Modes of small motion."""
