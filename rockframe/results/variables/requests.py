"""Variables of a run that are given on request, and scalars that follow from them."""

from typing import Final

from rockframe.results.variables.variable import EVENT, TIME, Variable, number, whether
from rockframe.units import Unit

POINT: Final = ("point",)
POINT_TIME: Final = ("point", "time")

ACCELERATIONS: Final = (
    Variable(
        "angular_acceleration", TIME, Unit.RADIAN_PER_SECOND_SQUARED, "second rate of the rotation"
    ),
    Variable(
        "horizontal_acceleration",
        TIME,
        Unit.METRE_PER_SECOND_SQUARED,
        "horizontal acceleration of the centre of mass relative to the ground, to the right",
    ),
    Variable(
        "vertical_acceleration",
        TIME,
        Unit.METRE_PER_SECOND_SQUARED,
        "vertical acceleration of the centre of mass relative to the ground, upwards",
    ),
    Variable(
        "absolute_horizontal_acceleration",
        TIME,
        Unit.METRE_PER_SECOND_SQUARED,
        "absolute horizontal acceleration of the centre of mass, to the right",
    ),
    Variable(
        "absolute_vertical_acceleration",
        TIME,
        Unit.METRE_PER_SECOND_SQUARED,
        "absolute vertical acceleration of the centre of mass, upwards",
    ),
)
"""The group ``"acceleration"``."""

REACTIONS: Final = (
    Variable(
        "horizontal_reaction",
        TIME,
        Unit.NEWTON,
        "force of the base on the body, along the plane that the base stands on, to the right",
    ),
    Variable(
        "vertical_reaction",
        TIME,
        Unit.NEWTON,
        "force of the base on the body, normal to the plane that the base stands on, upwards",
    ),
    Variable(
        "base_overturning_moment",
        TIME,
        Unit.NEWTON_METRE,
        "moment of the base's reactions about the middle of the base, against the rotation",
    ),
)
"""The group ``"reaction"``."""

IMPULSES: Final = (
    Variable(
        "event_horizontal_impulse",
        EVENT,
        Unit.NEWTON_SECOND,
        "horizontal impulse of the base on the body at the event, to the right",
    ),
    Variable(
        "event_vertical_impulse",
        EVENT,
        Unit.NEWTON_SECOND,
        "vertical impulse of the base on the body at the event, upwards",
    ),
)
"""The group ``"impulse"``."""

OTHERS: Final = (
    Variable(
        "horizontal_velocity",
        TIME,
        Unit.METRE_PER_SECOND,
        "horizontal velocity of the centre of mass relative to the ground, to the right",
    ),
    number(
        "friction_demand",
        "coefficient of friction that keeps the body from sliding on its base",
        TIME,
    ),
    number(
        "soil_friction_demand",
        "coefficient of friction that keeps the cap from sliding on the soil",
        TIME,
    ),
    Variable(
        "toe_pressure",
        TIME,
        Unit.NEWTON_PER_METRE,
        "greater force of the soil per length of the base at the ends of the bearing part",
    ),
)
"""On request one by one."""

POINTS: Final = (
    Variable("point", POINT, None, "name of a point of the body", dtype="str"),
    Variable("point_x", POINT, Unit.METRE, "place of the point, to the right of the base's middle"),
    Variable("point_y", POINT, Unit.METRE, "height of the point above the base at rest"),
    Variable(
        "point_horizontal_displacement",
        POINT_TIME,
        Unit.METRE,
        "horizontal displacement of the point from rest relative to the ground, to the right",
    ),
    Variable(
        "point_vertical_displacement",
        POINT_TIME,
        Unit.METRE,
        "vertical displacement of the point from rest relative to the ground, upwards",
    ),
    Variable(
        "point_horizontal_acceleration",
        POINT_TIME,
        Unit.METRE_PER_SECOND_SQUARED,
        "absolute horizontal acceleration of the point, to the right",
    ),
    Variable(
        "point_vertical_acceleration",
        POINT_TIME,
        Unit.METRE_PER_SECOND_SQUARED,
        "absolute vertical acceleration of the point, upwards",
    ),
)
"""Of points that are named."""

POINT_PEAKS: Final = tuple(
    Variable(
        f"peak_{row.name}",
        POINT,
        row.unit,
        f"largest {'' if 'absolute' in row.long_name else 'absolute '}"
        f"{row.long_name.split(',')[0]} up to overturning",
    )
    for row in POINTS
    if row.dims == POINT_TIME
)
"""Of points, in runs with samples."""

SLIPS: Final = (
    Variable("slip", TIME, Unit.METRE, "slip of the base, to the right"),
    Variable("slip_velocity", TIME, Unit.METRE_PER_SECOND, "rate of the slip"),
    Variable("event_slip", EVENT, Unit.METRE, "slip of the base at the event"),
    Variable("residual_slip", (), Unit.METRE, "slip of the base at the end of the run"),
    Variable("peak_slip", (), Unit.METRE, "largest absolute slip of the base while it bears"),
    Variable("cap_slip", TIME, Unit.METRE, "slip of the cap on the soil, to the right"),
    Variable("residual_cap_slip", (), Unit.METRE, "slip of the cap at the end of the run"),
    Variable("peak_cap_slip", (), Unit.METRE, "largest absolute slip of the cap while it bears"),
    Variable(
        "residual_displacement",
        (),
        Unit.METRE,
        "horizontal displacement of the centre of mass at the end of the run, to the right",
    ),
)
"""Of scenes in which a body slides; the slip is that of the corner that bears."""

FORCE_SCALARS: Final = (
    number("peak_friction_demand", "largest friction demand up to overturning"),
    Variable("peak_friction_demand_time", (), Unit.SECOND, "time of the largest friction demand"),
    Variable(
        "peak_friction_demand_duration",
        (),
        Unit.SECOND,
        "time in all with a friction demand above half its peak, or above 1 where that is less",
    ),
    number(
        "peak_impulsive_friction_demand",
        "largest ratio of horizontal and vertical impulses of impacts",
    ),
    Variable("peak_base_shear", (), Unit.NEWTON, "largest absolute base shear up to overturning"),
    Variable("residual_rotation", (), Unit.RADIAN, "rotation at the end of the run"),
    Variable(
        "residual_settlement",
        (),
        Unit.METRE,
        "how much lower than at rest the middle of the base stands at the end of the run",
    ),
    Variable(
        "peak_settlement",
        (),
        Unit.METRE,
        "how much lower than at rest the middle of the base stands at most, up to overturning",
    ),
    whether(
        "would_slide", "whether the friction demand exceeds the coefficient that a base was given"
    ),
    Variable("sliding_time", (), Unit.SECOND, "time from which on it does, NaN if it never does"),
    Variable("sliding_duration", (), Unit.SECOND, "time in all for which it does"),
)
"""Of runs with histories, or points; the last three of scenes to which friction was given."""
