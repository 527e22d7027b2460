"""Variables of a run that are given on request, and scalars that follow from them."""

from typing import Final

from rockframe.results.variables.variable import EVENT, TIME, Variable, rows_over

POINT: Final = ("point",)
POINT_TIME: Final = ("point", "time")

ACCELERATIONS: Final = rows_over(
    TIME,
    angular_acceleration="second rate of the rotation [rad s^-2]",
    horizontal_acceleration="horizontal acceleration of the centre of mass relative to the ground, "
    "to the right [m s^-2]",
    vertical_acceleration="vertical acceleration of the centre of mass relative to the ground, "
    "upwards [m s^-2]",
    absolute_horizontal_acceleration="absolute horizontal acceleration of the centre of mass, to "
    "the right [m s^-2]",
    absolute_vertical_acceleration="absolute vertical acceleration of the centre of mass, upwards "
    "[m s^-2]",
)
"""The group ``"acceleration"``."""

REACTIONS: Final = rows_over(
    TIME,
    horizontal_reaction="force of the base on the body, along the plane that the base stands on, "
    "to the right [N]",
    vertical_reaction="force of the base on the body, normal to the plane that the base stands on, "
    "upwards [N]",
    base_overturning_moment="moment of the base's reactions about the middle of the base, against "
    "the rotation [N m]",
)
"""The group ``"reaction"``."""

IMPULSES: Final = rows_over(
    EVENT,
    event_horizontal_impulse="horizontal impulse of the base on the body at the event, to the "
    "right; with that of a stiff wall [N s]",
    event_vertical_impulse="vertical impulse of the base on the body at the event, upwards [N s]",
)
"""The group ``"impulse"``."""

OTHERS: Final = rows_over(
    TIME,
    horizontal_velocity="horizontal velocity of the centre of mass relative to the ground, to the "
    "right [m s^-1]",
    friction_demand="coefficient of friction that keeps the body from sliding on its base",
    soil_friction_demand="coefficient of friction that keeps the cap from sliding on the soil",
    toe_pressure="greater force of the soil per length of the base at the ends of the bearing part "
    "[N m^-1]",
)
"""Variables that are requested one by one."""

POINT_LABELS: Final = rows_over(
    POINT,
    point=("name of a point of the body", str),
    point_x="place of the point, to the right of the base's middle [m]",
    point_y="height of the point above the base at rest [m]",
)

POINTS: Final = (
    *POINT_LABELS,
    *rows_over(
        POINT_TIME,
        point_horizontal_displacement="horizontal displacement of the point from rest relative to "
        "the ground, to the right [m]",
        point_vertical_displacement="vertical displacement of the point from rest relative to the "
        "ground, upwards [m]",
        point_horizontal_acceleration="absolute horizontal acceleration of the point, to the right "
        "[m s^-2]",
        point_vertical_acceleration="absolute vertical acceleration of the point, upwards [m s^-2]",
    ),
)
"""Variables of the points that users name."""

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
"""Peaks at the points that users name."""

SLIPS: Final = (
    *rows_over(
        TIME,
        slip="slip of the base, to the right [m]",
        slip_velocity="rate of the slip [m s^-1]",
    ),
    *rows_over(EVENT, event_slip="slip of the base at the event [m]"),
    *rows_over(
        (),
        residual_slip="slip of the base at the end of the run [m]",
        peak_slip="largest absolute slip of the base while it bears [m]",
    ),
    *rows_over(TIME, cap_slip="slip of the cap on the soil, to the right [m]"),
    *rows_over(
        (),
        residual_cap_slip="slip of the cap at the end of the run [m]",
        peak_cap_slip="largest absolute slip of the cap while it bears [m]",
        residual_displacement="horizontal displacement of the centre of mass at the end of the "
        "run, to the right; it lasts if the body is at rest then [m]",
    ),
)
"""Variables of scenes in which a body slides; the slip is that of the corner that bears."""

FORCE_SCALARS: Final = rows_over(
    (),
    peak_friction_demand="largest friction demand up to overturning",
    peak_friction_demand_time="time of the largest friction demand [s]",
    peak_friction_demand_duration="total time with a friction demand above half its peak, or above "
    "1 if the peak is beyond 2 [s]",
    peak_impulsive_friction_demand="largest ratio of impulses along and normal to the base, of "
    "impacts",
    peak_base_shear="largest absolute base shear up to overturning [N]",
    residual_rotation="rotation at the end of the run; it lasts if the body is at rest then [rad]",
    residual_settlement="displacement of the middle of the base below its place at rest, at the "
    "end of the run; it lasts if the body is at rest then [m]",
    peak_settlement="largest displacement of the middle of the base below its place at rest, up to "
    "overturning [m]",
    would_slide=("whether the friction demand exceeds the coefficient of friction of a base", bool),
    sliding_time="first time at which the friction demand exceeds the coefficient of friction, NaN "
    "if none [s]",
    sliding_duration="total time in which the friction demand exceeds the coefficient of friction "
    "[s]",
)
"""Scalars of runs with histories or points; the last three need a base with a given friction."""
