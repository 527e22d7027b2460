"""One body on a base: what the integrator asks for, and how an impulse changes it."""

from typing import Any, Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import Guards
from rockframe.dynamics.bodies import DEGREES, ROTATION, VERTICAL, InState
from rockframe.dynamics.on_base import IDLE, SLIDES, Mode, OnBase, VelocityChange
from rockframe.dynamics.protocol import HELD_PLACE, Energies, Ground, Slope
from rockframe.dynamics.switching import lift_by_slip, switch_part

HORIZONTAL: Final = 2
"""Place in the state, see :mod:`rockframe.dynamics.bodies`."""


class OnePart(NamedTuple):
    """What a system of one body is made of."""

    part: OnBase


class Alone(InState, OnePart):
    """One body on a base, per unit mass: a system."""

    __slots__ = ()

    @inlined
    def bodies(self) -> int:
        """Give the number of bodies."""
        return 1

    @kernel
    def variables(self) -> int:
        """Give the number of variables of first order: the base's own."""
        return self.part.base.variables()

    @kernel
    def guards(self) -> int:
        """Give the number of guards."""
        return self.part.guards()

    @kernel
    def modes(self) -> int:
        """Give the number of modes."""
        return self.part.modes()

    @inlined
    def moving_in(self, mode: int) -> int:
        """Give how many coordinates move: all, or all but the one that is held."""
        return DEGREES if self.part.is_free(self.part.mode_of(mode)) else HORIZONTAL

    @inlined
    def contact_state_of(self, mode: int, k: int) -> int:
        """Give the contact state."""
        return self.part.shown_contact(self.part.mode_of(mode))

    @inlined
    def relaxation_in(self, mode: int) -> float:
        """Give the rate at which an end that slides follows the base."""
        return self.part.relaxation_in(self.part.mode_of(mode))

    @inlined
    def own_place(self, k: int) -> int:
        """Give the place of the variables of the base's own in the state."""
        return 2 * DEGREES

    @inlined
    def own_in(self, state: Vector) -> Any:
        """Read the variables of the base's own."""
        return self.part.base.read(state, 2 * DEGREES)

    @inlined
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> tuple[float, ...]:
        """Give accelerations, rates of the base's own variables, and powers."""
        standing = self.part.mode_of(mode)
        body, own = self.state_of(0, state), self.own_in(state)
        rates = self.part.rates_in(standing, body, own, ground)
        accelerations = (rates.rotation, rates.vertical, rates.horizontal)
        return accelerations + rates.own_rates + (rates.dissipated, rates.supplied)

    @kernel
    def some_end_slides(self, mode: int) -> bool:
        """Whether an end slides."""
        return self.part.mode_of(mode).slides

    @inlined
    def without_sliding(self, mode: int) -> int:
        """Give a mode without its sliding."""
        return mode & ~SLIDES

    @inlined
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Give all guards, and their rates, :eq:`eq-guards`."""
        standing, body = self.part.mode_of(mode), self.state_of(0, state)
        sliding = IDLE
        if standing.slides:
            push = slope[HORIZONTAL] + ground.x
            sliding = self.part.sliding_guards(
                standing, body, slope[ROTATION], slope[HORIZONTAL], push,
                lift_by_slip(self, self.part, 0, mode, state),
            )  # fmt: skip
        own = self.own_in(state)
        return self.part.guards_with(standing, body, own, slope[VERTICAL], slope[ROTATION], sliding)

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; give the new mode."""
        return switch_part(self, self.part, 0, guard, mode, state, ground, memory)

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Give kinetic, gravity and elastic energy, and elastic less that at rest."""
        body = self.state_of(0, state)
        elastic, change = self.part.elastic_energy(body, self.own_in(state))
        kinetic = self.part.kinetic_energy(self.part.mode_of(mode), body)
        return Energies(kinetic, self.part.body.gravity * body.vertical, elastic, change)

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> tuple[float, ...]:
        """Give motion and reactions, :eq:`eq-reactions`, and what the base shows."""
        standing, body = self.part.mode_of(mode), self.state_of(0, state)
        shear = slope[HORIZONTAL] + ground.x
        return (
            body.rotation,
            body.angular_velocity,
            body.vertical,
            body.vertical_velocity,
            self.place(0, mode, state, memory),
            shear,
            self.part.sway(standing, body, self.part.body.attitude(body.rotation)),
            slope[ROTATION],
            slope[HORIZONTAL],
            slope[VERTICAL],
            shear,
            slope[VERTICAL] + self.part.body.gravity + ground.y,
        ) + self.part.observed_base(standing, body, self.own_in(state))

    @kernel
    def part_mode(self, mode: int, k: int) -> Mode:
        """Give how the body stands."""
        return self.part.mode_of(mode)

    @kernel
    def with_part(self, mode: int, k: int, part: Mode) -> int:
        """Give the mode in which the body stands otherwise."""
        return self.part.number_of(part)

    @kernel
    def place(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Give x of the centre of mass: about the held point, or free."""
        standing = self.part.mode_of(mode)
        return self.part.horizontal_place(standing, self.state_of(k, state), memory[HELD_PLACE])

    @kernel
    def response(
        self, k: int, mode: int, press: float, moment: float, slip: float, state: Vector
    ) -> VelocityChange:
        """Give how the velocities change by an impulse, or as the hold stops a slip."""
        attitude = self.part.body.attitude(state[ROTATION])
        return self.part.response_in(self.part.mode_of(mode), attitude, press, moment, slip)

    @kernel
    def velocities(self, state: Vector) -> tuple[float, ...]:
        """Give all velocities."""
        return state[DEGREES], state[DEGREES + 1], state[DEGREES + 2]

    @kernel
    def end_accelerations(
        self, k: int, mode: int, state: Vector, ground: Ground
    ) -> tuple[float, float]:
        """Give the accelerations of the ends of the base in a mode, upwards."""
        body, own = self.state_of(0, state), self.own_in(state)
        rates = self.part.rates_in(self.part.mode_of(mode), body, own, ground)
        return self.part.end_rises(body, rates.vertical, rates.rotation)

    @kernel
    def tendency(self, k: int, mode: int, state: Vector, ground: Ground) -> float:
        """Give the side to which the ground, or the contact, will rotate the body."""
        if ground.x != 0.0:
            return -ground.x
        return self.part.base.tilt(self.part.mode_of(mode).contact)
