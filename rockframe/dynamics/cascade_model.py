"""Assembly of a cascade from the models of its two bodies."""

from collections.abc import Callable

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics import cascade as model
from rockframe.dynamics.cascade_switches import switch
from rockframe.dynamics.protocol import ROTATION_LIMIT, ContactModel, Start


def cascade(
    first: ContactModel, second: ContactModel, *, top: float, cap_centre: float
) -> ContactModel:
    """Assemble the model of a block on the cap of a body on a bed.

    Parameters
    ----------
    first : ContactModel
        Block and cap as one body, :func:`rockframe.dynamics.winkler_model.winkler`.
    second : ContactModel
        The block on its pads, :func:`rockframe.dynamics.two_spring_model.two_spring`.
    top, cap_centre : float
        Heights of the cap's top and of its centre above the first body's centre of mass [m].

    Returns
    -------
    ContactModel
    """
    ratio = first.mass / second.mass
    p = np.concatenate([first.parameters, second.parameters, [ratio, top, cap_centre]])
    p[ROTATION_LIMIT] = second.parameters[ROTATION_LIMIT]
    modes = np.arange(model.MODES)
    of_first, of_second = modes // model.BLOCK_MODES, modes % model.BLOCK_MODES
    sways = np.maximum(first.active[of_first], second.active[of_second])

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        bed_mode, resting, own = first.initial(Start())
        block_mode, state, memory = second.initial(start)
        mode = block_mode + model.BLOCK_MODES * bed_mode
        return mode, _in_turn(resting, state), np.concatenate([memory, own])

    return ContactModel(
        name="cascade",
        accelerate=model.accelerate,
        guard=model.guard,
        switch=switch,
        energy=model.energy,
        observe=model.observe,
        active=2 * sways,
        contact=second.contact[of_second],
        soil_contact=first.contact[of_first],
        parameters=p,
        scales=_in_turn(first.scales, second.scales),
        rotation_weights=_in_turn(first.rotation_weights, second.rotation_weights),
        # without the limits of both, and with that of their sum
        guard_tolerance=np.concatenate(
            [second.guard_tolerance[:-1], first.guard_tolerance[:-1], second.guard_tolerance[-1:]]
        ),
        relaxation=second.relaxation[of_second],
        columns=model.COLUMNS,
        fastest_frequency=max(first.fastest_frequency, second.fastest_frequency),
        damping_rate=max(first.damping_rate, second.damping_rate),
        rounding=_rounding(first, second),
        energy_scale=second.energy_scale,
        mass=second.mass,
        initial=initial,
    )


def _in_turn(first: Vector, second: Vector) -> Vector:
    """Give the elements of two arrays in turn."""
    return np.stack([first, second], axis=1).ravel()


def _rounding(first: ContactModel, second: ContactModel) -> Callable[[float], Vector] | None:
    own, other = first.rounding, second.rounding
    if own is None or other is None:
        return None

    def noise(rotation: float) -> Vector:
        return _in_turn(own(0.0), other(rotation))

    return noise
