"""A building on pads on a cap on soil in two stages, Eq. (20), page "Cap and soil" of the manual.

The ground shakes the lower body, which is block and cap as one body on the soil. The middle of its
top shakes the upper body, the block on its pads, which does not act back. Both are integrated
together, with one control of the error for both. Energies are per unit mass of the block.
"""

from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import Guards
from rockframe.dynamics.bodies import ROTATION, VERTICAL
from rockframe.dynamics.on_base import IDLE_GUARDS, BodyOnBase, Rates, VelocityChange
from rockframe.dynamics.protocol import (
    HELD_PLACE,
    IMPACT_LOSS,
    IMPULSIVE_INPUT,
    REPINNING_LOSS,
    Column,
    Energies,
    Ground,
    Slope,
)
from rockframe.dynamics.stacked import COLUMNS as STACK_COLUMNS
from rockframe.dynamics.stacked import (
    COORDINATES,
    HORIZONTAL,
    LOWER,
    LOWER_HORIZONTAL,
    LOWER_ROTATION,
    UPPER,
    Stacked,
    name_soil_event,
)
from rockframe.dynamics.switching import lift_per_slip, mode_after_disturbance, switch_mode

COLUMNS: Final = (
    *STACK_COLUMNS,
    Column("cap_acceleration"),
    Column("cap_vertical_acceleration"),
    # motion of the second stage, from which forces follow; its velocities relative to the ground
    Column("angular_acceleration_on_base"),
    Column("horizontal_velocity_on_base"),
    Column("vertical_velocity_on_base"),
)


class PointMotion(NamedTuple):
    """Velocity and acceleration of a point, relative to the ground."""

    velocity_x: float
    velocity_y: float
    acceleration_x: float
    acceleration_y: float


class Stages(NamedTuple):
    """The two bodies of a cascade, each on its base, and the geometry of the cap."""

    upper: BodyOnBase  # per unit of its own mass, that of the block
    lower: BodyOnBase  # block and cap as one, per unit of its own mass
    mass_ratio: float  # mass of the lower body over that of the block
    top: float  # height of the cap's top above the centre of mass of the lower body [m]
    cap_centre: float  # height of the cap's centre above it [m]
    offset: float  # distance of it to the right of the middle of the cap [m]


class Cascade(Stacked, Stages):
    """Two bodies of which the upper one does not act back: a system."""

    __slots__ = ()

    @inlined
    def moving_in(self, mode: int) -> int:
        """Return the number of coordinates that move: all, or all but both horizontal ones."""
        modes = self.modes_in(mode)
        free = self.upper.is_free(modes.upper) or self.lower.is_free(modes.lower)
        return COORDINATES if free else HORIZONTAL

    @inlined
    def cap_top_motion(
        self, mode: int, state: Vector, angular: float, vertical: float, horizontal: float
    ) -> PointMotion:
        """Return motion of the cap's top by accelerations of the lower body, :eq:`eq-carried`."""
        body = self.state_of(LOWER, state)
        attitude, rate = self.lower.body.attitude(body.rotation), body.angular_velocity
        centre_velocity = self.lower.horizontal_velocity(self.modes_in(mode).lower, body, attitude)
        exact_sine = 0.0 if self.lower.body.small else attitude.sine
        sine, cosine = attitude.sine, attitude.cosine
        exact_cosine = 0.0 if self.lower.body.small else cosine
        return PointMotion(
            centre_velocity + self.top * cosine * rate + self.offset * exact_sine * rate,
            body.vertical_velocity - self.top * sine * rate + self.offset * cosine * rate,
            horizontal
            + self.top * (cosine * angular - exact_sine * rate * rate)
            + self.offset * (exact_sine * angular + exact_cosine * rate * rate),
            vertical
            - self.top * (sine * angular + cosine * rate * rate)
            + self.offset * (cosine * angular - exact_sine * rate * rate),
        )

    @inlined
    def lower_rates(self, mode: int, state: Vector, ground: Ground) -> Rates:
        """Return the accelerations and powers of the lower body."""
        own_mode, body = self.modes_in(mode).lower, self.state_of(LOWER, state)
        return self.lower.rates_in(own_mode, body, self.lower_own(state), ground)

    @inlined
    def ground_of_upper(self, mode: int, state: Vector, below: Rates, ground: Ground) -> Ground:
        """Return the absolute acceleration of the cap's top, the ground of the upper body."""
        top = self.cap_top_motion(mode, state, below.rotation, below.vertical, below.horizontal)
        return Ground(ground.x + top.acceleration_x, ground.y + top.acceleration_y)

    @inlined
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> tuple[float, ...]:
        """Return accelerations of both bodies, rates of their bases' own variables, and powers."""
        modes, states, ratio = self.modes_in(mode), self.states_in(state), self.mass_ratio
        below = self.lower_rates(mode, state, ground)
        on_top = self.ground_of_upper(mode, state, below, ground)
        above = self.upper.rates_in(modes.upper, states.upper, self.upper_own(state), on_top)
        # the horizontal coordinate of a held body stays constant while that of the other moves
        along = above.horizontal if self.upper.is_free(modes.upper) else 0.0
        lower_along = below.horizontal if self.lower.is_free(modes.lower) else 0.0
        return (
            (above.rotation, above.vertical, below.rotation, below.vertical, along, lower_along)
            + above.own_rates
            + below.own_rates
            + (
                ratio * below.dissipated + above.dissipated,
                ratio * below.supplied + above.supplied,
            )
        )

    @inlined
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return the guards of the block on its pads, then of the lower body."""
        modes, states = self.modes_in(mode), self.states_in(state)
        of_upper, of_lower = IDLE_GUARDS, IDLE_GUARDS
        if modes.upper.slides:
            below = self.lower_rates(mode, state, ground)
            push = slope[HORIZONTAL] + self.ground_of_upper(mode, state, below, ground).x
            of_upper = self.upper.sliding_guards(
                modes.upper, states.upper, slope[ROTATION], slope[HORIZONTAL], push,
                lift_per_slip(self, self.upper, UPPER, mode, state),
            )  # fmt: skip
        if modes.lower.slides:
            push = slope[LOWER_HORIZONTAL] + ground.x
            of_lower = self.lower.sliding_guards(
                modes.lower, states.lower, slope[LOWER_ROTATION], slope[LOWER_HORIZONTAL], push,
                lift_per_slip(self, self.lower, LOWER, mode, state),
            )  # fmt: skip
        return self.guards_of_both(modes, state, slope, of_upper, of_lower)

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; return the new mode."""
        count = self.upper.guards()
        if guard < count:
            below = self.lower_rates(mode, state, ground)
            on_top = self.ground_of_upper(mode, state, below, ground)
            new = switch_mode(self, self.upper, UPPER, guard, mode, state, on_top, memory)
        else:
            new = self.switch_lower(mode, guard - count, state, ground, memory)
        if not self.lower.is_free(self.modes_in(new).lower):
            state[COORDINATES + LOWER_HORIZONTAL] = 0.0
        if not self.upper.is_free(self.modes_in(new).upper):
            state[COORDINATES + HORIZONTAL] = 0.0
        return new

    @kernel
    def switch_lower(
        self, mode: int, which: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out a switch of the lower body, and apply its velocity jump to the upper one."""
        lost, struck = memory[REPINNING_LOSS], memory[IMPACT_LOSS]
        before = self.cap_top_motion(mode, state, 0.0, 0.0, 0.0)
        new = switch_mode(self, self.lower, LOWER, which, mode, state, ground, memory)
        memory[REPINNING_LOSS] = lost + self.mass_ratio * (memory[REPINNING_LOSS] - lost)
        memory[IMPACT_LOSS] = struck + self.mass_ratio * (memory[IMPACT_LOSS] - struck)
        name_soil_event(memory)
        after = self.cap_top_motion(new, state, 0.0, 0.0, 0.0)
        self.apply_velocity_jump(
            new, after.velocity_x - before.velocity_x, after.velocity_y - before.velocity_y, state,
            memory,
        )  # fmt: skip
        return mode_after_disturbance(self, self.upper, UPPER, new, state)

    @kernel
    def apply_velocity_jump(
        self, mode: int, jump_x: float, jump_y: float, state: Vector, memory: Vector
    ) -> None:
        """Apply a jump of the velocity of the cap's top to the upper body, :eq:`eq-carried-jump`.

        `jump_x` and `jump_y` are the components of the jump [m s^-1].
        """
        own_mode, body = self.modes_in(mode).upper, self.state_of(UPPER, state)
        attitude = self.upper.body.attitude(body.rotation)
        old_velocity = self.upper.horizontal_velocity(own_mode, body, attitude)
        state[COORDINATES + VERTICAL] -= jump_y
        if self.upper.is_free(own_mode):
            state[COORDINATES + HORIZONTAL] -= jump_x
        else:
            response = self.upper.response_in(own_mode, attitude, 0.0, 0.0, -jump_x)
            state[COORDINATES + ROTATION] += response.rotation
        after = self.state_of(UPPER, state)
        new_velocity = self.upper.horizontal_velocity(own_mode, after, attitude)
        memory[IMPULSIVE_INPUT] -= 0.5 * (
            jump_x * (old_velocity + new_velocity)
            + jump_y * (body.vertical_velocity + after.vertical_velocity)
        )

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Add up the energies of both bodies, each relative to its own ground."""
        modes, states, ratio = self.modes_in(mode), self.states_in(state), self.mass_ratio
        above, above_change = self.upper.elastic_energy(states.upper, self.upper_own(state))
        below, below_change = self.lower.elastic_energy(states.lower, self.lower_own(state))
        kinetic = self.upper.kinetic_energy(modes.upper, states.upper)
        kinetic += ratio * self.lower.kinetic_energy(modes.lower, states.lower)
        height = states.upper.vertical + ratio * states.lower.vertical
        return Energies(
            kinetic, self.upper.body.gravity * height, above + ratio * below,
            above_change + ratio * below_change,
        )  # fmt: skip

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> tuple[float, ...]:
        """Return motion of block and cap, reactions, motion of the cap's top, and both bases."""
        modes, states = self.modes_in(mode), self.states_in(state)
        upper, lower = states
        rates = self.lower_rates(mode, state, ground)
        top = self.cap_top_motion(mode, state, rates.rotation, rates.vertical, rates.horizontal)
        on_top = Ground(ground.x + top.acceleration_x, ground.y + top.acceleration_y)
        above = self.upper.rates_in(modes.upper, upper, self.upper_own(state), on_top)
        on_cap = self.upper.body.attitude(upper.rotation)
        velocity = self.upper.horizontal_velocity(modes.upper, upper, on_cap)
        # a point at a height z above the centre of mass sinks by z (1 - cos) relative to it
        attitude = self.lower.body.attitude(lower.rotation)
        versine = attitude.rise / self.lower.body.height
        total_velocity = velocity + self.lower.horizontal_velocity(modes.lower, lower, attitude)
        return (
            upper.rotation + lower.rotation,
            upper.angular_velocity + lower.angular_velocity,
            upper.vertical + lower.vertical,
            upper.vertical_velocity + lower.vertical_velocity,
            self.centre_position(UPPER, mode, state, memory)
            + self.centre_position(LOWER, mode, state, memory),
            self.mass_ratio * (rates.horizontal + ground.x),
            total_velocity,
            above.rotation + rates.rotation,
            above.horizontal + rates.horizontal,
            above.vertical + rates.vertical,
            above.horizontal + on_top.x,
            above.vertical + self.upper.body.gravity + on_top.y,
            lower.rotation,
            lower.angular_velocity,
            lower.vertical - self.cap_centre * versine + self.offset * attitude.sine,
            lower.vertical_velocity
            + (self.offset * attitude.cosine - self.cap_centre * attitude.sine)
            * lower.angular_velocity,
            upper.rotation,
            upper.vertical,
            on_top.x,
            on_top.y,
            above.rotation,
            velocity + top.velocity_x,
            upper.vertical_velocity + top.velocity_y,
        ) + self.columns_of_bases(mode, state)

    @kernel
    def centre_position(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return x of a centre of mass: about the held point, or free [m]."""
        modes, body, held_at = self.modes_in(mode), self.state_of(k, state), memory[HELD_PLACE + k]
        if k == UPPER:
            return self.upper.horizontal_position(modes.upper, body, held_at)
        return self.lower.horizontal_position(modes.lower, body, held_at)

    @kernel
    def response(
        self, k: int, mode: int, impulse: float, moment: float, slip: float, state: Vector
    ) -> VelocityChange:
        """Return the change of a body's velocities by an impulse, or by the restraint of a slip."""
        modes, rotation = self.modes_in(mode), self.state_of(k, state).rotation
        if k == UPPER:
            attitude = self.upper.body.attitude(rotation)
            return self.upper.response_in(modes.upper, attitude, impulse, moment, slip)
        attitude = self.lower.body.attitude(rotation)
        return self.lower.response_in(modes.lower, attitude, impulse, moment, slip)

    @kernel
    def end_accelerations(
        self, k: int, mode: int, state: Vector, ground: Ground
    ) -> tuple[float, float]:
        """Return the accelerations of the ends of a base; `ground` is the one under this body."""
        modes, body = self.modes_in(mode), self.state_of(k, state)
        if k == UPPER:
            rates = self.upper.rates_in(modes.upper, body, self.upper_own(state), ground)
            return self.upper.end_accelerations_at(body, rates.vertical, rates.rotation)
        rates = self.lower_rates(mode, state, ground)
        return self.lower.end_accelerations_at(body, rates.vertical, rates.rotation)

    @kernel
    def incipient_rotation(self, k: int, mode: int, state: Vector, ground: Ground) -> float:
        """Return the sign of the rotation that the ground under a body, or its contact, begins."""
        if ground.x != 0.0:
            return -ground.x
        if k == UPPER:
            return self.upper.base.tilt(self.modes_in(mode).upper.contact)
        return self.lower.base.tilt(self.modes_in(mode).lower.contact)
