"""What all models of one body on a yielding base share: state, parameters, restraint.

The base is two pads (:mod:`rockframe.dynamics.two_spring`) or a bed of springs
(:mod:`rockframe.dynamics.winkler`). All quantities per unit mass of the body.
"""

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.gliding import (
    NO_LEVER,
    blend,
    is_lifted,
    share_of_loss,
    share_until_lifted,
    speed_noise,
)
from rockframe.dynamics.kinematics import (
    CENTRE,
    PIVOT_CENTRE,
    PIVOT_LEFT,
    PIVOT_RIGHT,
    about_pin,
    end_accelerations,
    leading_pivot,
    pinned_point,
    reach_and_bend,
    sine_cosine_rise,
)
from rockframe.dynamics.protocol import (
    HORIZONTAL_REFERENCE,
    LAST_EVENT,
    PIVOT_CHANGE,
    REPINNING_LOSS,
    ROTATION_LIMIT,
    ROUNDING,
    SILENT,
)

# parameters, after ROTATION_LIMIT
GRAVITY: Final = 1  # g
ANGLE: Final = 2  # theta
HALF_HEIGHT: Final = 3  # h, of the centre of mass above the base
HALF_WIDTH: Final = 4  # b
INERTIA: Final = 5  # I_O/m
RESTRAINT: Final = 6  # a restraint rule
SMALL: Final = 7  # 1 for small rotation
BODY_PARAMETERS: Final = 8

# state
ROTATION: Final = 0
VERTICAL: Final = 1
HORIZONTAL: Final = 2  # a coordinate of its own in flight only
COORDINATES: Final = 3

COLUMNS: Final = (
    "rotation",
    "angular_velocity",
    "vertical_displacement",
    "vertical_velocity",
    "horizontal_displacement",
)

FREE: Final = -1
"""Stands for the pivot of a body in flight, or of one that glides."""

LEFT_SIDE: Final = 1.0
RIGHT_SIDE: Final = -1.0
"""Sides of the base, in levers h sin a +/- b cos a."""


@inlined
def horizontal_velocity(pivot: int, state: Vector, p: Vector, sine: float, cosine: float) -> float:
    """Give dx/dt of the centre of mass: about the pinned point, or free in flight."""
    if pivot == FREE:
        return state[COORDINATES + HORIZONTAL]
    pin = pinned_point(pivot, p[HALF_WIDTH])
    reach, _ = reach_and_bend(p[HALF_HEIGHT], p[SMALL], pin, sine, cosine)
    return reach * state[COORDINATES + ROTATION]


@kernel
def horizontal_position(pivot: int, state: Vector, p: Vector, memory: Vector) -> float:
    """Give x of the centre of mass: about the pinned point, or free in flight."""
    if pivot == FREE:
        return state[HORIZONTAL]
    pin = pinned_point(pivot, p[HALF_WIDTH])
    return memory[HORIZONTAL_REFERENCE] + about_pin(p[HALF_HEIGHT], p[SMALL], pin, state[ROTATION])


class Rates(NamedTuple):
    """How fast the rates of a body and its energies change, per unit mass."""

    rotation: float
    vertical: float
    horizontal: float
    dissipated: float
    supplied: float


@inlined
def move_body(
    pivot: int,
    state: Vector,
    sine: float,
    cosine: float,
    force: float,
    moment: float,
    dissipated: float,
    ground_x: float,
    ground_y: float,
    p: Vector,
) -> Rates:
    """Give the accelerations of :eq:`eq-two-spring`, with the powers.

    `force` and `moment` are the base's vertical force and its generalised force
    on the rotation.
    """
    spin = state[COORDINATES + ROTATION]
    speed = state[COORDINATES + VERTICAL]
    lift = force - p[GRAVITY] - ground_y
    if pivot == FREE:
        supplied = -ground_x * state[COORDINATES + HORIZONTAL] - ground_y * speed
        return Rates(0.0, lift, -ground_x, dissipated, supplied)
    pin = pinned_point(pivot, p[HALF_WIDTH])
    reach, bend = reach_and_bend(p[HALF_HEIGHT], p[SMALL], pin, sine, cosine)
    push = reach * (ground_x + bend * spin * spin)
    turn = (moment - push) / (p[INERTIA] + reach * reach)
    return Rates(turn, lift, 0.0, dissipated, -ground_x * reach * spin - ground_y * speed)


@inlined
def write_rates(rates: Rates, out: Vector) -> None:
    """Write accelerations and powers where the integrator expects them."""
    out[ROTATION] = rates.rotation
    out[VERTICAL] = rates.vertical
    out[HORIZONTAL] = rates.horizontal
    out[COORDINATES] = rates.dissipated
    out[COORDINATES + 1] = rates.supplied


@kernel
def end_rate(side: float, state: Vector, p: Vector) -> tuple[float, float, float]:
    """Give the lever of an end of the base, its speed, and the noise of that."""
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    lever = p[HALF_HEIGHT] * sine + side * p[HALF_WIDTH] * cosine
    speed, spin = state[COORDINATES + VERTICAL], state[COORDINATES + ROTATION]
    return lever, speed + lever * spin, speed_noise(speed, lever, spin)


@kernel
def glide_body(
    pivot: int,
    side: float,
    relaxation: float,
    dissipated: float,
    state: Vector,
    sine: float,
    cosine: float,
    ground_x: float,
    ground_y: float,
    p: Vector,
) -> Rates:
    """Give the accelerations of a body of which one end glides, :eq:`eq-gliding`.

    The end follows what it stands on, which relaxes at the rate `relaxation` without
    pressing. What the hold takes from the slip is added to the power dissipated.
    """
    h, b, small = p[HALF_HEIGHT], p[HALF_WIDTH], p[SMALL]
    spin = state[COORDINATES + ROTATION]
    speed = state[COORDINATES + VERTICAL]
    sway = state[COORDINATES + HORIZONTAL]
    lift = -p[GRAVITY] - ground_y
    left, right = end_accelerations(h, b, small, sine, cosine, spin, lift, 0.0)
    lever = h * sine + side * b * cosine
    free = left if side > 0.0 else right
    turn = -(free + relaxation * (speed + lever * spin)) / lever
    reach, _ = reach_and_bend(h, small, pinned_point(pivot, b), sine, cosine)
    hold = -p[INERTIA] * turn / reach
    dissipated -= hold * (sway - reach * spin)
    return Rates(turn, lift, hold - ground_x, dissipated, -ground_x * sway - ground_y * speed)


@kernel
def glide_guards(
    pivot: int, side: float, state: Vector, accelerations: Vector, ground_x: float, p: Vector
) -> tuple[float, float, float]:
    """Give the guards of the hold that lifts and of the slip, and the rate of the latter."""
    h, b = p[HALF_HEIGHT], p[HALF_WIDTH]
    sine, cosine, _ = sine_cosine_rise(h, p[SMALL], state[ROTATION])
    spin = state[COORDINATES + ROTATION]
    reach, bend = reach_and_bend(h, p[SMALL], pinned_point(pivot, b), sine, cosine)
    upwards = 1.0 if (h * sine + side * b * cosine) * reach > 0.0 else -1.0
    hold = accelerations[HORIZONTAL] + ground_x
    slip = state[COORDINATES + HORIZONTAL] - reach * spin
    change = accelerations[HORIZONTAL] - reach * accelerations[ROTATION] - bend * spin * spin
    if abs(reach) < NO_LEVER * (b + h):
        # with the held point beneath the centre of mass to hold it is not to lift it
        return -upwards * hold / p[GRAVITY], -1.0, 0.0
    scale = upwards / math.sqrt(p[GRAVITY] * (b + h))
    return -upwards * hold / p[GRAVITY], scale * slip, scale * change


@kernel
def kinetic_energy(pivot: int, state: Vector, p: Vector) -> float:
    """Give the kinetic energy relative to the ground, :eq:`eq-energy`."""
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    sway = horizontal_velocity(pivot, state, p, sine, cosine)
    spin = state[COORDINATES + ROTATION]
    speed = state[COORDINATES + VERTICAL]
    return 0.5 * (p[INERTIA] * spin * spin + speed * speed + sway * sway)


@kernel
def limit_guard(state: Vector, p: Vector) -> tuple[float, float]:
    """Give the distance of the rotation from its limit, and its rate."""
    spin = state[COORDINATES + ROTATION]
    rotation = state[ROTATION]
    return p[ROTATION_LIMIT] - abs(rotation), -spin if rotation > 0.0 else spin


@kernel
def repin(old: int, new: int, state: Vector, p: Vector, memory: Vector) -> None:
    """Project the momentum on the horizontal restraint of a new pivot, :eq:`eq-repinning`."""
    position = horizontal_position(old, state, p, memory)
    rotation = state[ROTATION]
    spin = state[COORDINATES + ROTATION]
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], rotation)
    sway = horizontal_velocity(old, state, p, sine, cosine)
    if new == FREE:
        state[HORIZONTAL] = position
        state[COORDINATES + HORIZONTAL] = sway
        return
    pin = pinned_point(new, p[HALF_WIDTH])
    memory[HORIZONTAL_REFERENCE] = position - about_pin(p[HALF_HEIGHT], p[SMALL], pin, rotation)
    reach, _ = reach_and_bend(p[HALF_HEIGHT], p[SMALL], pin, sine, cosine)
    # the constraint's impulse does no work on what it lets through: the loss is
    # that of the slip between the old sway and the new one
    slip = sway - reach * spin
    inertia = p[INERTIA] + reach * reach
    state[COORDINATES + ROTATION] = (p[INERTIA] * spin + reach * sway) / inertia
    memory[REPINNING_LOSS] += 0.5 * p[INERTIA] * slip * slip / inertia


@kernel
def repin_landing(
    new: int, side: float, forceless: float, least: float, state: Vector, p: Vector, memory: Vector
) -> bool:
    """Hold a body out of flight that has come down on one end; give whether it glides.

    The hold's impulse ends where the end has got the speed `forceless`, at which the base
    no longer presses, :eq:`eq-partial-hold`. A speed beyond it below `least` is too small for
    the base to answer.
    """
    _, before, _ = end_rate(side, state, p)
    spin = state[COORDINATES + ROTATION]
    sway = state[COORDINATES + HORIZONTAL]
    reference, lost = memory[HORIZONTAL_REFERENCE], memory[REPINNING_LOSS]
    repin(FREE, new, state, p, memory)
    _, after, noise = end_rate(side, state, p)
    before, after, noise = before - forceless, after - forceless, max(noise, least)
    idle = forceless > 0.0 and after - before <= noise  # no slip to stop: forces decide
    if idle or not is_lifted(before, after, noise):
        return False
    share = share_until_lifted(before, after)
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    held = horizontal_velocity(new, state, p, sine, cosine)
    state[COORDINATES + ROTATION] = blend(spin, state[COORDINATES + ROTATION], share)
    state[COORDINATES + HORIZONTAL] = blend(sway, held, share)
    memory[HORIZONTAL_REFERENCE] = reference
    memory[REPINNING_LOSS] = blend(lost, memory[REPINNING_LOSS], share_of_loss(share))
    set_end_rate(side, forceless, 0.0, 0.0, state, p)
    return True


@kernel
def set_end_rate(
    side: float, rate: float, direction: float, least: float, state: Vector, p: Vector
) -> None:
    """Give an end a speed, or one on the side of it that rounding cannot leave."""
    _, now, noise = end_rate(side, state, p)
    state[COORDINATES + VERTICAL] += rate + direction * max(noise, least) - now


@kernel
def turned_pivot(pivot: int, tilt: float, state: Vector, ground_x: float, memory: Vector) -> int:
    """Give the pivot after the guard of the leading corner has fallen, and note the event.

    Upright and at rest, on still ground, the body turns as the contact tells by `tilt`.
    """
    spin = state[COORDINATES + ROTATION]
    if pivot != PIVOT_CENTRE:
        state[ROTATION] = 0.0
        memory[LAST_EVENT] = PIVOT_CHANGE
        return PIVOT_LEFT if pivot == PIVOT_RIGHT else PIVOT_RIGHT
    memory[LAST_EVENT] = SILENT  # the first lean decides; at rest the ground does
    tendency = -ground_x if ground_x != 0.0 else tilt
    return leading_pivot(state[ROTATION], spin if spin != 0.0 else tendency)


@kernel
def observe_body(pivot: int, state: Vector, memory: Vector, p: Vector, out: Vector) -> None:
    """Write the columns of the body's motion."""
    out[0] = state[ROTATION]
    out[1] = state[COORDINATES + ROTATION]
    out[2] = state[VERTICAL]
    out[3] = state[COORDINATES + VERTICAL]
    out[4] = horizontal_position(pivot, state, p, memory)


def body_parameters(
    size: int,
    *,
    half_width: float,
    half_height: float,
    inertia: float,
    restraint: int,
    small_rotation: bool,
    gravity: float,
) -> Vector:
    """Give an array of parameters with those of the body filled in.

    Parameters
    ----------
    size : int
        Number of parameters of the model.
    half_width, half_height : float
        b, and h of the centre of mass above the base [m].
    inertia : float
        I_O per unit mass [m^2].
    restraint : int
        A rule of :mod:`rockframe.dynamics.kinematics`; at small rotation the rules coincide.
    small_rotation : bool
        Whether the kinematics are expanded to second order.
    gravity : float
        Acceleration of gravity [m s^-2].

    Returns
    -------
    ndarray
    """
    p = np.zeros(size)
    p[ROTATION_LIMIT] = p[ANGLE] = math.atan2(half_width, half_height)
    p[GRAVITY] = gravity
    p[HALF_HEIGHT] = half_height
    p[HALF_WIDTH] = half_width
    p[INERTIA] = inertia
    p[RESTRAINT] = restraint_in_use(restraint, small_rotation)
    p[SMALL] = float(small_rotation)
    return p


def restraint_in_use(restraint: int, small_rotation: bool) -> int:
    """Give the restraint rule, or the simplest where all rules are the same."""
    return CENTRE if small_rotation else restraint


def body_scales(p: Vector, settlement: float, vertical_frequency: float) -> Vector:
    """Give typical sizes of the coordinates and their rates."""
    angle, radius = p[ANGLE], math.hypot(p[HALF_WIDTH], p[HALF_HEIGHT])
    rocking = math.sqrt(p[GRAVITY] * radius / (radius**2 + p[INERTIA]))
    return np.array(
        [
            angle,
            settlement,
            radius * angle,
            angle * rocking,
            settlement * vertical_frequency,
            radius * angle * rocking,
        ]
    )


def body_rounding(p: Vector, settlement: float, fastest: float) -> Callable[[float], Vector]:
    """Estimate the rounding noise of the coordinates and their rates at a rotation.

    The heights of the base's ends are differences of terms as large as the settlement and
    the tilt; what the base answers to their rounding moves the body to and fro by as much.
    """
    turning = p[HALF_WIDTH] / (p[INERTIA] + p[HALF_HEIGHT] ** 2)
    return rounding_at(
        math.hypot(p[HALF_WIDTH], p[HALF_HEIGHT]),
        settlement,
        np.array([turning, 1.0, 1.0]),
        fastest,
    )


def rounding_at(
    size: float, settlement: float, answers: Vector, fastest: float
) -> Callable[[float], Vector]:
    """Give the noise of coordinates and rates by the rotation, from their `answers` to a height."""
    both = np.concatenate([answers, fastest * answers])

    def noise(rotation: float) -> Vector:
        # an error estimate is a small part of what it is made of
        return 0.02 * ROUNDING * (settlement + size * abs(rotation)) * both

    return noise


def energy_scale(p: Vector) -> float:
    """Give a typical energy, by which rounding noise is known."""
    radius = math.hypot(p[HALF_WIDTH], p[HALF_HEIGHT])
    return float(p[GRAVITY] * radius * p[ANGLE])
