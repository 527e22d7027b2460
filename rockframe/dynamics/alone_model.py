"""Assembly of the model of one body on a base: sizes and initial state."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.alone import HORIZONTAL, Alone
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.bodies import DEGREES, ROTATION, VERTICAL
from rockframe.dynamics.body import Body, BodyState
from rockframe.dynamics.on_base import BODY_GUARDS, Mode, OnBase
from rockframe.dynamics.pads import ROUNDING
from rockframe.dynamics.protocol import BODY_COLUMNS, HELD_PLACE, MEMORY, ContactModel, Start
from rockframe.dynamics.restraint import CENTRE
from rockframe.dynamics.statics import link_of, settled


def rigid_body(
    *,
    left: float,
    right: float,
    height: float,
    inertia: float,
    restraint: int,
    small_rotation: bool,
    gravity: float,
) -> Body:
    """Give a body as the equations take it.

    Parameters
    ----------
    left, right : float
        From the foot of the centre of mass to the ends of the base [m].
    height : float
        h, of the centre of mass above the base [m].
    inertia : float
        I_O over the mass that all is measured by [m^2].
    restraint : int
        A rule of :mod:`rockframe.dynamics.restraint`; at small rotation the rules coincide.
    small_rotation : bool
        Whether the kinematics are expanded to second order.
    gravity : float
        Acceleration of gravity [m s^-2].

    Returns
    -------
    Body
    """
    return Body(
        height=height,
        left=left,
        right=right,
        inertia=inertia,
        gravity=gravity,
        angle=math.atan2(0.5 * (left + right), height),
        restraint=CENTRE if small_rotation else restraint,
        small=small_rotation,
    )


def alone(
    name: str, body: Body, base: BaseNumbers, mass: float, rest_rotation: float = 0.0
) -> ContactModel:
    """Assemble the model of a body on a base.

    Parameters
    ----------
    name : str
        Name of the model.
    body : Body
        Per unit of its own mass.
    base : BaseNumbers
        Under the body.
    mass : float
        Of the body [kg].
    rest_rotation : float
        Of the body at rest, :meth:`rockframe.dynamics.statics.Chain.rest` [rad].

    Returns
    -------
    ContactModel
    """
    part = OnBase(body, base.law)
    vertical = math.sqrt(base.vertical_stiffness)
    rocking = math.sqrt(base.rotational_stiffness / (body.inertia + body.height**2))
    fastest = max(vertical, rocking)
    return ContactModel(
        name=name,
        system=Alone(part),
        rotation_limits=(math.atan2(body.left, body.height), math.atan2(body.right, body.height)),
        rotation_weights=np.array([1.0, 0.0, 0.0]),
        scales=np.concatenate([*_sizes(body, base, vertical), base.variable_scales]),
        guard_tolerance=part_tolerance(base),
        columns=(*BODY_COLUMNS, *base.columns),
        memory=MEMORY,
        mass=mass,
        fastest_frequency=fastest,
        damping_rate=base.damping_time * fastest**2,
        energy_scale=body.gravity * radius_of(body) * body.angle,
        initial=_starting(part, rest_rotation),
        rounding=rounding_at(
            radius_of(body), base.settlement, _answers(body), fastest, len(base.variable_scales)
        ),
    )


def radius_of(body: Body) -> float:
    """Give the distance from the ends of the base to the centre of mass, their mean [m]."""
    return math.hypot(0.5 * (body.left + body.right), body.height)


def eccentricity_of(body: Body) -> float:
    """Give how far the centre of mass is to the right of the middle of the base [m]."""
    return 0.5 * (body.left - body.right)


def rocking_rate(body: Body) -> float:
    """Give the rate of rocking about a corner [s^-1]."""
    radius = radius_of(body)
    return math.sqrt(body.gravity * radius / (radius**2 + body.inertia))


def part_tolerance(base: BaseNumbers) -> Vector:
    """Give the rounding noise of the guards of a body: of both ends, and of the body's own."""
    return np.concatenate([base.end_tolerance, base.end_tolerance, np.full(BODY_GUARDS, ROUNDING)])


def _sizes(body: Body, base: BaseNumbers, vertical_frequency: float) -> tuple[Vector, Vector]:
    sway, rate = radius_of(body) * body.angle, rocking_rate(body)
    sizes = np.array([body.angle, base.settlement, sway])
    return sizes, sizes * np.array([rate, vertical_frequency, rate])


def _answers(body: Body) -> Vector:
    """Give how the coordinates answer the rounding of a height."""
    width = 0.5 * (body.left + body.right)
    return np.array([width / (body.inertia + body.height**2), 1.0, 1.0])


def rounding_at(
    size: float, settlement: float, answers: Vector, fastest: float, variables: int
) -> Callable[[float], Vector]:
    """Estimate the rounding noise of everything in the state, by the rotation.

    The heights of the base's ends are differences of terms as large as the settlement and
    the tilt; what the base answers to their rounding moves the body to and fro by as much.
    """
    all_answers = np.concatenate([answers, fastest * answers, np.zeros(variables)])

    def noise(rotation: float) -> Vector:
        # an error estimate is a small part of what it is made of
        return 0.02 * ROUNDING * (settlement + size * abs(rotation)) * all_answers

    return noise


def starting_state(part: OnBase, start: Start, own: tuple[float, ...]) -> tuple[BodyState, Mode]:
    """Give placement, rates and mode of a body at the start of a run, whose rotation is known.

    Unless the start says otherwise it is in vertical equilibrium.
    """
    body, base, rotation = part.body, part.base, start.rotation or 0.0
    height = start.vertical_displacement
    if height is None:
        height = settled(link_of(part, own=own), rotation, body.gravity).state.vertical
    state = BodyState(rotation, height, 0.0, start.angular_velocity, start.vertical_velocity, 0.0)
    return state, part.standing(base.starting(body.base_line_at(state), own), state)


def at_rotation(start: Start, rest_rotation: float) -> Start:
    """Give a start whose rotation is known: that at rest, unless it says otherwise."""
    return start if start.rotation is not None else replace(start, rotation=rest_rotation)


def _starting(part: OnBase, rest_rotation: float) -> Callable[[Start], tuple[int, Vector, Vector]]:
    def initial(given: Start) -> tuple[int, Vector, Vector]:
        start = at_rotation(given, rest_rotation)
        state = np.zeros(2 * DEGREES + part.base.variables())
        memory = np.zeros(len(MEMORY))
        body, mode = starting_state(part, start, part.base.read(state, 2 * DEGREES))
        state[[ROTATION, VERTICAL, DEGREES + ROTATION, DEGREES + VERTICAL]] = (
            body.rotation, body.vertical, body.angular_velocity, body.vertical_velocity,
        )  # fmt: skip
        # the held point starts where it is when the body rests, so that x = 0 there
        pin = part.body.pin(mode.pivot)
        memory[HELD_PLACE] = pin
        if part.is_free(mode):
            state[HORIZONTAL] = pin + part.body.about_pin(pin, body.rotation)
        return part.number_of(mode), state, memory

    return initial
