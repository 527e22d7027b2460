"""One body on a base: its system, and its model."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from rockframe.case_arrays import atan2, hypot, sqrt
from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import Guards, Variables
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.bodies import BODY_DOF, ROTATION, VERTICAL, StateAccess
from rockframe.dynamics.body import CENTRE, Body, BodyState
from rockframe.dynamics.body_statics import equilibrium_pose, standing_body
from rockframe.dynamics.on_base import (
    BODY_GUARDS,
    IDLE_GUARDS,
    SLIDING_BIT,
    BodyOnBase,
    Mode,
    VelocityChange,
)
from rockframe.dynamics.pads import ROUNDING
from rockframe.dynamics.protocol import (
    BODY_COLUMNS,
    HELD_PLACE,
    MEMORY,
    ContactModel,
    Energies,
    Ground,
    Slope,
    Start,
)
from rockframe.dynamics.switching import lift_per_slip, switch_mode

HORIZONTAL: Final = 2
BASE_VARIABLES: Final = 2 * BODY_DOF
"""Indices in the state, see :mod:`rockframe.dynamics.bodies`; the base's own variables follow."""


class SingleBodyNumbers(NamedTuple):
    """The data of a system of one body: the body on its base."""

    part: BodyOnBase


class SingleBody(StateAccess, SingleBodyNumbers):
    """One body on a base, per unit mass: a system."""

    __slots__ = ()

    @inlined
    def bodies(self) -> int:
        """Return the number of bodies."""
        return 1

    @kernel
    def variables(self) -> int:
        """Return the number of variables of first order: the base's own."""
        return self.part.base.variables()

    @kernel
    def guards(self) -> int:
        """Return the number of guards."""
        return self.part.guards()

    @kernel
    def modes(self) -> int:
        """Return the number of modes."""
        return self.part.modes()

    @inlined
    def moving_in(self, mode: int) -> int:
        """Return the number of coordinates that move: all, or all but a held horizontal one."""
        return BODY_DOF if self.part.is_free(self.part.mode_of(mode)) else HORIZONTAL

    @inlined
    def contact_state_of(self, mode: int, k: int) -> int:
        """Return the contact state."""
        return self.part.contact_state(self.part.mode_of(mode))

    @inlined
    def relaxation_in(self, mode: int) -> float:
        """Return the rate at which a sliding end follows the base [s^-1]."""
        return self.part.relaxation_in(self.part.mode_of(mode))

    @inlined
    def base_variable_index(self, k: int) -> int:
        """Return the index in the state of the base's own variables."""
        return BASE_VARIABLES

    @inlined
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> tuple[float, ...]:
        """Return accelerations, rates of the base's own variables, and powers."""
        own_mode = self.part.mode_of(mode)
        body, own = self.state_of(0, state), self.part.base.read(state, BASE_VARIABLES)
        rates = self.part.rates_in(own_mode, body, own, ground)
        accelerations = (rates.rotation, rates.vertical, rates.horizontal)
        return accelerations + rates.own_rates + (rates.dissipated, rates.supplied)

    @kernel
    def some_end_slides(self, mode: int) -> bool:
        """Whether an end slides."""
        return self.part.mode_of(mode).slides

    @inlined
    def without_sliding(self, mode: int) -> int:
        """Return a mode without its sliding."""
        return mode & ~SLIDING_BIT

    @inlined
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return all guards, and their rates, :eq:`eq-guards`."""
        own_mode, body = self.part.mode_of(mode), self.state_of(0, state)
        sliding = IDLE_GUARDS
        if own_mode.slides:
            push = slope[HORIZONTAL] + ground.x
            sliding = self.part.sliding_guards(
                own_mode, body, slope[ROTATION], slope[HORIZONTAL], push,
                lift_per_slip(self, self.part, 0, mode, state),
            )  # fmt: skip
        own = self.part.base.read(state, BASE_VARIABLES)
        return self.part.guards_with(own_mode, body, own, slope[VERTICAL], slope[ROTATION], sliding)

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; return the new mode."""
        return switch_mode(self, self.part, 0, guard, mode, state, ground, memory)

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Return kinetic, gravity and elastic energy, and the elastic energy less that at rest."""
        body = self.state_of(0, state)
        elastic, change = self.part.elastic_energy(body, self.part.base.read(state, BASE_VARIABLES))
        kinetic = self.part.kinetic_energy(self.part.mode_of(mode), body)
        return Energies(kinetic, self.part.body.gravity * body.vertical, elastic, change)

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> tuple[float, ...]:
        """Return motion and reactions, :eq:`eq-reactions`, and the base's columns."""
        own_mode, body = self.part.mode_of(mode), self.state_of(0, state)
        attitude = self.part.body.attitude(body.rotation)
        shear = slope[HORIZONTAL] + ground.x
        return (
            body.rotation,
            body.angular_velocity,
            body.vertical,
            body.vertical_velocity,
            self.centre_position(0, mode, state, memory),
            shear,
            self.part.horizontal_velocity(own_mode, body, attitude),
            slope[ROTATION],
            slope[HORIZONTAL],
            slope[VERTICAL],
            shear,
            slope[VERTICAL] + self.part.body.gravity + ground.y,
        ) + self.part.base_columns(own_mode, body, self.part.base.read(state, BASE_VARIABLES))

    @kernel
    def body_mode(self, mode: int, k: int) -> Mode:
        """Return contact, held point and sliding of the body in a mode."""
        return self.part.mode_of(mode)

    @kernel
    def with_body_mode(self, mode: int, k: int, part: Mode) -> int:
        """Return the number of a mode of the body."""
        return self.part.number_of(part)

    @kernel
    def centre_position(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return x of the centre of mass: about the held point, or free."""
        body = self.state_of(k, state)
        return self.part.horizontal_position(self.part.mode_of(mode), body, memory[HELD_PLACE])

    @kernel
    def response(
        self, k: int, mode: int, impulse: float, moment: float, slip: float, state: Vector
    ) -> VelocityChange:
        """Return the changes of velocities by an impulse, or by a hold that stops a slip."""
        attitude = self.part.body.attitude(state[ROTATION])
        return self.part.response_in(self.part.mode_of(mode), attitude, impulse, moment, slip)

    @kernel
    def velocities(self, state: Vector) -> tuple[float, ...]:
        """Return all velocities."""
        return state[BODY_DOF], state[BODY_DOF + 1], state[BODY_DOF + 2]

    @kernel
    def end_accelerations(
        self, k: int, mode: int, state: Vector, ground: Ground
    ) -> tuple[float, float]:
        """Return the upward accelerations of the left and right end of the base in a mode."""
        body, own = self.state_of(0, state), self.part.base.read(state, BASE_VARIABLES)
        rates = self.part.rates_in(self.part.mode_of(mode), body, own, ground)
        return self.part.end_accelerations_at(body, rates.vertical, rates.rotation)

    @kernel
    def incipient_rotation(self, k: int, mode: int, state: Vector, ground: Ground) -> float:
        """Return the sign of the rotation that the ground, or else the contact, will cause."""
        if ground.x != 0.0:
            return -ground.x
        return self.part.base.tilt(self.part.mode_of(mode).contact)


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
    """Return the body of the equations; at small rotation the rules of restraint coincide."""
    return Body(
        height=height,
        left=left,
        right=right,
        inertia=inertia,
        gravity=gravity,
        angle=atan2(0.5 * (left + right), height),
        restraint=CENTRE if small_rotation else restraint,
        small=small_rotation,
    )


def single_body(
    name: str, body: Body, base: BaseNumbers, mass: float, rest_rotation: float = 0.0
) -> ContactModel:
    """Assemble the model of a body on a base, per unit of its own mass [kg]."""
    part = BodyOnBase(body, base.law)
    vertical = sqrt(base.vertical_stiffness)
    rocking = sqrt(base.rotational_stiffness / (body.inertia + body.height**2))
    fastest = max(vertical, rocking)
    size, rate = radius_of(body), rocking_rate(body)
    sizes = np.array([body.angle, base.settlement, size * body.angle])
    # changes of the coordinates by the rounding of a height
    width = 0.5 * (body.left + body.right)
    sensitivities = np.array([width / (body.inertia + body.height**2), 1.0, 1.0])
    return ContactModel(
        name=name,
        system=SingleBody(part),
        rotation_limits=(atan2(body.left, body.height), atan2(body.right, body.height)),
        rotation_weights=np.array([1.0, 0.0, 0.0]),
        scales=np.concatenate([
            sizes, sizes * np.array([rate, vertical, rate]), base.variable_scales,
        ]),
        guard_tolerance=guard_tolerances(base),
        columns=(*BODY_COLUMNS, *base.columns),
        memory=MEMORY,
        mass=mass,
        fastest_frequency=fastest,
        damping_rate=base.damping_time * fastest**2,
        energy_scale=body.gravity * size * body.angle,
        initial=partial(_initial, part, rest_rotation),
        rounding=rounding_estimate(
            size, base.settlement, sensitivities, fastest, len(base.variable_scales)
        ),
    )  # fmt: skip


def radius_of(body: Body) -> float:
    """Return the distance from the ends of the base to the centre of mass, their mean [m]."""
    return hypot(0.5 * (body.left + body.right), body.height)


def eccentricity_of(body: Body) -> float:
    """Return the distance of the centre of mass to the right of the middle of the base [m]."""
    return 0.5 * (body.left - body.right)


def rocking_rate(body: Body) -> float:
    """Return the rate of rocking about a corner [s^-1]."""
    radius = radius_of(body)
    return sqrt(body.gravity * radius / (radius**2 + body.inertia))


def guard_tolerances(base: BaseNumbers) -> Vector:
    """Return the rounding noise of the guards of a body: those of both ends, then its own."""
    return np.concatenate([base.end_tolerance, base.end_tolerance, np.full(BODY_GUARDS, ROUNDING)])


def rounding_estimate(
    size: float, settlement: float, sensitivities: Vector, fastest: float, variables: int
) -> Callable[[float], Vector]:
    """Return a function of the rotation that estimates the rounding noise of each state variable.

    The heights of the base's ends are differences of terms as large as the settlement and the
    tilt. The base reacts to their rounding, so that the body moves by as much.
    """
    factors = np.concatenate([sensitivities, fastest * sensitivities, np.zeros(variables)])

    def noise(rotation: float) -> Vector:
        # an error estimate is a small part of the terms that it is computed from
        return 0.02 * ROUNDING * (settlement + size * abs(rotation)) * factors

    return noise


def starting_state(part: BodyOnBase, start: Start, own: Variables) -> tuple[BodyState, Mode]:
    """Return placement, rates and mode of a body at the start of a run, whose rotation is known.

    It is in vertical equilibrium unless the start specifies its height.
    """
    body, base, rotation = part.body, part.base, start.rotation or 0.0
    height = start.vertical_displacement
    if height is None:
        pose = equilibrium_pose(standing_body(part), rotation, body.gravity)
        height = pose.state.vertical
    state = BodyState(rotation, height, 0.0, start.angular_velocity, start.vertical_velocity, 0.0)
    return state, part.mode_for_contact(base.starting(body.base_line_at(state), own), state)


def _initial(part: BodyOnBase, rest_rotation: float, stated: Start) -> tuple[int, Vector, Vector]:
    """Return mode, state and memory at the start of a run; at rest unless stated otherwise."""
    start = stated if stated.rotation is not None else replace(stated, rotation=rest_rotation)
    own = np.zeros(part.base.variables())
    body, mode = starting_state(part, start, part.base.read(own, 0))
    # the held point starts where it is when the body rests, so that x = 0 there
    pin = part.initial_pin(mode, body)
    x = 0.0
    if part.is_free(mode):
        x = pin + part.body.about_pin(pin, part.body.attitude(body.rotation))
    places = (body.rotation, body.vertical, x)
    rates = (body.angular_velocity, body.vertical_velocity, 0.0)
    memory = np.array([pin if k == HELD_PLACE else 0.0 for k in range(len(MEMORY))])
    return part.number_of(mode), np.array([*places, *rates, *own]), memory
