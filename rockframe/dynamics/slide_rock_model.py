"""Assembly of the model of a block that slides and rocks on rigid ground with friction."""

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.protocol import ContactModel, Start
from rockframe.dynamics.slide_motion import (
    COLUMNS,
    FULL,
    HELD,
    ON_LEFT,
    ON_RIGHT,
    REMEMBERED,
    SLIPS,
)
from rockframe.dynamics.slide_rock import SlideRock
from rockframe.many import atan2, hypot, sqrt


def ill_posed_friction(inertia: float, square: float) -> float:
    """Return the least coefficient at which a slipping corner may jam, :eq:`eq-slide-painleve`.

    `inertia` is that about the centre of mass over the mass [m^2]; `square` is the square of the
    distance between the centre of mass and the corner [m^2].
    """
    ratio = inertia / square
    return 2.0 * sqrt(ratio * (1.0 + ratio))


def impulse_lever(*, restitution: float, own: float, width: float, about_foot: float) -> float:
    """Return the lever of the impulse as a block rocks onto its other corner, :eq:`eq-slide-lever`.

    It is over the distance `own` of the striking corner from the foot of the centre of mass [m];
    `about_foot` is the inertia about that foot over the mass [m^2].
    """
    lost = 1.0 - restitution
    return lost * about_foot / (own * (width - lost * own))


def slide_rock(system: SlideRock, *, mass: float) -> ContactModel:
    """Assemble the model of a block that slides and rocks, from its mass [kg]."""
    gravity = system.gravity
    least = min(system.left, system.right)
    angle, radius = atan2(least, system.height), hypot(least, system.height)
    frequency = sqrt(gravity * radius / (system.inertia + radius * radius))
    size = np.array([angle, least, least])

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        rotation, rate = start.rotation or 0.0, start.angular_velocity
        leans = rotation or rate
        bears = FULL if leans == 0.0 else ON_RIGHT if leans > 0.0 else ON_LEFT
        state = np.array([rotation, 0.0, 0.0, rate, 0.0, 0.0])
        return SLIPS * bears + HELD, state, np.zeros(len(REMEMBERED))

    return ContactModel(
        name="sliding on rigid ground",
        system=system,
        rotation_limits=(angle, angle),
        rotation_weights=np.array([1.0, 0.0, 0.0]),
        scales=np.concatenate([size, frequency * size]),
        guard_tolerance=np.array([1e-15, 1e-15, *(1e-14,) * 4]),
        columns=COLUMNS,
        memory=REMEMBERED,
        mass=mass,
        fastest_frequency=frequency,
        damping_rate=0.0,
        energy_scale=gravity * radius * angle,
        initial=initial,
    )
