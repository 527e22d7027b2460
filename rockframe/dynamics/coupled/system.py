"""A block on a base on a cap on its base, section "Coupled" of the theory manual.

Equations :eq:`eq-coupled`. Each base acts as it does under a single body; held points and
impulses act on both bodies together: :eq:`eq-coupled-impulse`. Per unit mass of the block.
"""

from typing import NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import Guards
from rockframe.dynamics.bodies import ROTATION, VERTICAL
from rockframe.dynamics.body import Attitude
from rockframe.dynamics.coupled.motion import (
    Configuration,
    Forces,
    KnownTerms,
    Pair,
    block_rise,
    block_velocity,
    cap_horizontal_velocity,
    configuration,
    normal_change,
    solve_motion,
    velocity_along_cap,
)
from rockframe.dynamics.coupled.sliding import sliding_end, slip_accelerations
from rockframe.dynamics.on_base import IDLE_GUARDS, VelocityChange
from rockframe.dynamics.protocol import HELD_PLACE, Energies, Ground, Slope
from rockframe.dynamics.stacked import (
    COORDINATES,
    HORIZONTAL,
    LOWER,
    LOWER_HORIZONTAL,
    LOWER_ROTATION,
    LOWER_VERTICAL,
    UPPER,
    Stacked,
    States,
    name_soil_event,
)
from rockframe.dynamics.switching import (
    lift_per_slip,
    mode_after_disturbance,
    recheck_sliding,
    switch_mode,
)


class ContactForces(NamedTuple):
    """Forces on the bodies of a stack, per unit mass of the block."""

    thrust: float  # of the cap on the block, along the cap
    normal: float  # of the cap on the block, along the cap's normal
    base_shear: float  # of the ground on the cap, horizontally


class Coupled(Stacked, Pair):
    """Two bodies, one on the other: a system."""

    __slots__ = ()

    @inlined
    def moving_in(self, mode: int) -> int:
        """Return the number of coordinates that move: all but a held cap's horizontal one."""
        return COORDINATES if self.lower.is_free(self.modes_in(mode).lower) else LOWER_HORIZONTAL

    @inlined
    def attitudes(self, states: States) -> tuple[Attitude, Attitude]:
        """Return the attitudes of block and cap on their bases."""
        upper = self.upper.body.attitude(states.upper.rotation)
        return upper, self.lower.body.attitude(states.lower.rotation)

    @kernel
    def geometry_of(self, mode: int, states: States) -> Configuration:
        """Return the geometry of states, with the held points of a mode."""
        modes, (upper, lower) = self.modes_in(mode), self.attitudes(states)
        return configuration(
            self, modes, states, upper, lower,
            self.upper.is_free(modes.upper), self.lower.is_free(modes.lower),
        )  # fmt: skip

    @inlined
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> tuple[float, ...]:
        """Return accelerations, rates of the bases' own variables, and powers."""
        modes, states = self.modes_in(mode), self.states_in(state)
        upper, lower = self.attitudes(states)
        block_line = self.upper.body.base_line(states.upper, upper)
        cap_line = self.lower.body.base_line(states.lower, lower)
        block_own, cap_own = self.upper_own(state), self.lower_own(state)
        block_contact = self.upper.contact_with_force(modes.upper)
        cap_contact = self.lower.contact_with_force(modes.lower)
        on_block = self.upper.base.force(block_contact, block_line, block_own)
        on_cap = self.lower.base.force(cap_contact, cap_line, cap_own)
        forces = Forces(on_block.upward, on_block.moment, on_cap.upward, on_cap.moment)
        dissipated = on_block.dissipated + on_cap.dissipated
        geometry = configuration(
            self, modes, states, upper, lower,
            self.upper.is_free(modes.upper), self.lower.is_free(modes.lower),
        )  # fmt: skip
        free = geometry
        block_rate, cap_rate = states.upper.angular_velocity, states.lower.angular_velocity
        s, c = geometry.sine, geometry.cosine
        load_y = self.upper.body.gravity + ground.y
        load_along = ground.x * c - load_y * s
        load_normal = ground.x * s + load_y * c
        slip = velocity_along_cap(geometry, states)
        coriolis = (
            2.0 * states.upper.vertical_velocity * cap_rate - geometry.across * cap_rate * cap_rate
        )
        normal = (2.0 * slip + geometry.arm * cap_rate) * cap_rate - load_normal
        known_cap = geometry.cap_reach.second_derivative * cap_rate * cap_rate
        known_block = geometry.block_reach.second_derivative * block_rate * block_rate
        if modes.upper.slides or modes.lower.slides:
            geometry = configuration(
                self, modes, states, upper, lower,
                geometry.block_free and not modes.upper.slides,
                geometry.cap_free and not modes.lower.slides,
            )  # fmt: skip
            slips = slip_accelerations(
                self, modes, states, geometry,
                sliding_end(self.upper, modes.upper, upper, block_line),
                sliding_end(self.lower, modes.lower, lower, cap_line),
                forces,
                KnownTerms(known_cap, known_block + coriolis + load_along, ground.x, load_y),
                normal,
            )  # fmt: skip
            known_cap += slips.cap_horizontal
            known_block += slips.block_along
            dissipated -= slips.power
        motion = solve_motion(
            self,
            geometry,
            forces,
            KnownTerms(known_cap, known_block + coriolis + load_along, ground.x, load_y),
        )
        cap_along = c * motion.cap_horizontal - s * motion.cap_vertical
        lift = forces.normal + normal + normal_change(geometry, motion)
        along = geometry.block_reach.derivative * motion.angular + known_block
        if geometry.block_free:
            along = -load_along - cap_along - geometry.arm * motion.cap_angular - coriolis
        across_speed, up_speed = block_velocity(free, states)
        supplied = -ground.x * (
            across_speed + self.cap_mass * cap_horizontal_velocity(free, states)
        )
        supplied -= ground.y * (up_speed + self.cap_mass * states.lower.vertical_velocity)
        angular, cap_angular = motion.angular, motion.cap_angular
        return (
            (angular, lift, cap_angular, motion.cap_vertical, along, motion.cap_horizontal)
            + self.upper.base.flow(block_contact, block_line, block_own)
            + self.lower.base.flow(cap_contact, cap_line, cap_own)
            + (dissipated, supplied)
        )

    @inlined
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return the guards of the block, then of the cap, and their rates."""
        modes, states = self.modes_in(mode), self.states_in(state)
        of_block, of_cap = IDLE_GUARDS, IDLE_GUARDS
        if modes.upper.slides or modes.lower.slides:
            forces = self.contact_forces(mode, states, slope, ground)
            thrust, base_shear = forces.thrust, forces.base_shear
            if modes.upper.slides:
                of_block = self.upper.sliding_guards(
                    modes.upper, states.upper, slope[ROTATION], slope[HORIZONTAL], thrust,
                    lift_per_slip(self, self.upper, UPPER, mode, state),
                )  # fmt: skip
            if modes.lower.slides:
                of_cap = self.lower.sliding_guards(
                    modes.lower, states.lower, slope[LOWER_ROTATION], slope[LOWER_HORIZONTAL],
                    base_shear, lift_per_slip(self, self.lower, LOWER, mode, state),
                )  # fmt: skip
        return self.guards_of_both(modes, state, slope, of_block, of_cap)

    @kernel
    def contact_forces(
        self, mode: int, states: States, slope: Slope, ground: Ground
    ) -> ContactForces:
        """Return the forces between ground, cap and block, from accelerations, :eq:`eq-coupled`."""
        geometry = self.geometry_of(mode, states)
        s, c, cap_rate = geometry.sine, geometry.cosine, states.lower.angular_velocity
        cap_x = slope[LOWER_HORIZONTAL]
        if not geometry.cap_free:  # the slope has no acceleration of a coordinate that is held
            cap_x = (
                geometry.cap_reach.derivative * slope[LOWER_ROTATION]
                + geometry.cap_reach.second_derivative * cap_rate * cap_rate
            )
        x = cap_x + ground.x
        y = slope[LOWER_VERTICAL] + self.upper.body.gravity + ground.y
        thrust = (
            c * x - s * y + slope[HORIZONTAL] + geometry.arm * slope[LOWER_ROTATION]
            + 2.0 * states.upper.vertical_velocity * cap_rate
            - geometry.across * cap_rate * cap_rate
        )  # fmt: skip
        normal = (
            s * x + c * y + slope[VERTICAL] - geometry.across * slope[LOWER_ROTATION]
            - 2.0 * velocity_along_cap(geometry, states) * cap_rate
            - geometry.arm * cap_rate * cap_rate
        )  # fmt: skip
        return ContactForces(thrust, normal, self.cap_mass * x + c * thrust + s * normal)

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; return the new mode."""
        count = self.upper.guards()
        if guard < count:
            new = switch_mode(self, self.upper, UPPER, guard, mode, state, ground, memory)
            return recheck_sliding(self, self.lower, LOWER, new, state)
        new = switch_mode(self, self.lower, LOWER, guard - count, mode, state, ground, memory)
        name_soil_event(memory)
        return mode_after_disturbance(self, self.upper, UPPER, new, state)

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Return the energies, :eq:`eq-coupled-energy`."""
        states = self.states_in(state)
        geometry = self.geometry_of(mode, states)
        across, up = block_velocity(geometry, states)
        cap_x, cap_y = cap_horizontal_velocity(geometry, states), states.lower.vertical_velocity
        cap_rate = states.lower.angular_velocity
        block_rate = cap_rate + states.upper.angular_velocity
        kinetic = 0.5 * (
            across * across
            + up * up
            + self.upper.body.inertia * block_rate * block_rate
            + self.cap_mass * (cap_x * cap_x + cap_y * cap_y)
            + self.lower.body.inertia * cap_rate * cap_rate
        )
        height = block_rise(geometry, states) + self.cap_mass * states.lower.vertical
        by_upper, upper_change = self.upper.elastic_energy(states.upper, self.upper_own(state))
        by_lower, lower_change = self.lower.elastic_energy(states.lower, self.lower_own(state))
        return Energies(
            kinetic, self.upper.body.gravity * height, by_upper + by_lower,
            upper_change + lower_change,
        )  # fmt: skip

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> tuple[float, ...]:
        """Return motion of block and cap, reactions, and the columns of both bases."""
        states = self.states_in(state)
        geometry = self.geometry_of(mode, states)
        across, up = block_velocity(geometry, states)
        along = (
            geometry.arm * geometry.sine + states.upper.horizontal * geometry.cosine - self.offset
        )
        thrust, normal, base_shear = self.contact_forces(mode, states, slope, ground)
        return (
            states.upper.rotation + states.lower.rotation,
            states.upper.angular_velocity + states.lower.angular_velocity,
            block_rise(geometry, states),
            up,
            self.centre_position(LOWER, mode, state, memory) + along,
            base_shear,
            across,
            slope[ROTATION] + slope[LOWER_ROTATION],
            geometry.cosine * thrust + geometry.sine * normal - ground.x,
            geometry.cosine * normal - geometry.sine * thrust - self.upper.body.gravity - ground.y,
            thrust,
            normal,
            states.lower.rotation,
            states.lower.angular_velocity,
            states.lower.vertical,
            states.lower.vertical_velocity,
            states.upper.rotation,
            states.upper.vertical,
        ) + self.columns_of_bases(mode, state)

    @kernel
    def centre_position(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return the place of a centre of mass: a block's along the cap, a cap's on the ground."""
        if k == UPPER:
            return state[HORIZONTAL]
        body, held_at = self.state_of(LOWER, state), memory[HELD_PLACE + LOWER]
        return self.lower.horizontal_position(self.modes_in(mode).lower, body, held_at)

    @kernel
    def response(
        self, k: int, mode: int, impulse: float, moment: float, slip: float, state: Vector
    ) -> VelocityChange:
        """Return the changes of velocities by an impulse, or by a hold that stops a slip."""
        states = self.states_in(state)
        geometry = self.geometry_of(mode, states)
        if k == UPPER:
            forces, known = Forces(impulse, moment, 0.0, 0.0), KnownTerms(0.0, -slip, 0.0, 0.0)
        else:
            forces, known = Forces(0.0, 0.0, impulse, moment), KnownTerms(-slip, 0.0, 0.0, 0.0)
        motion = solve_motion(self, geometry, forces, known)
        s, c = geometry.sine, geometry.cosine
        normal = forces.normal + normal_change(geometry, motion)
        along = geometry.block_reach.derivative * motion.angular
        if geometry.block_free:
            cap_along = c * motion.cap_horizontal - s * motion.cap_vertical
            along = -cap_along - geometry.arm * motion.cap_angular
        elif k == UPPER:
            along -= slip
        restraint = motion.thrust
        cap_rate, lift = motion.angular, normal
        if k == LOWER:
            restraint = c * motion.thrust + s * forces.normal
            restraint += self.cap_mass * motion.cap_horizontal
            cap_rate, lift = motion.cap_angular, motion.cap_vertical
        cap_along = motion.cap_horizontal if geometry.cap_free else 0.0
        others = (motion.angular, normal, motion.cap_angular, motion.cap_vertical, along, cap_along)
        return VelocityChange(cap_rate, lift, restraint, others)

    @kernel
    def respond(self, k: int, mode: int, response: VelocityChange, state: Vector) -> None:
        """Change the velocities of both bodies by a response."""
        for i in range(COORDINATES):
            state[COORDINATES + i] += response.others[i]
        geometry = self.geometry_of(mode, self.states_in(state))
        if not geometry.block_free:
            held = geometry.block_reach.derivative * state[COORDINATES + ROTATION]
            state[COORDINATES + HORIZONTAL] = held

    @kernel
    def end_accelerations(
        self, k: int, mode: int, state: Vector, ground: Ground
    ) -> tuple[float, float]:
        """Return the accelerations of the left and right end away from the surface beneath them."""
        slope, states = self.accelerate(mode, state, ground), self.states_in(state)
        if k == UPPER:
            return self.upper.end_accelerations_at(states.upper, slope[VERTICAL], slope[ROTATION])
        return self.lower.end_accelerations_at(
            states.lower, slope[LOWER_VERTICAL], slope[LOWER_ROTATION]
        )

    @kernel
    def incipient_rotation(self, k: int, mode: int, state: Vector, ground: Ground) -> float:
        """Return the sign of the rotation that will follow; at rest it is a guess."""
        if ground.x != 0.0:
            return -ground.x
        other = state[ROTATION] if k == LOWER else -state[COORDINATES + LOWER_ROTATION]
        return other if other != 0.0 else 1.0
