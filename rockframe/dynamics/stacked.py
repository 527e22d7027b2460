"""Two bodies, one on the other: their modes, states and guards.

The upper body stands on a base on the lower one, the lower one on a base on the ground. The number
of a mode is that of the upper body plus its number of modes times that of the lower body.
"""

from typing import Any, Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import Guards
from rockframe.dynamics.bodies import BODY_DOF, ROTATION, VERTICAL, StateAccess
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.events import (
    PIVOT_CHANGE,
    SEPARATION,
    SILENT,
    SOIL_CONTACT,
    SOIL_PIVOT_CHANGE,
    SOIL_SEPARATION,
)
from rockframe.dynamics.on_base import SLIDING_BIT, BodyOnBase, Mode, SlidingGuards
from rockframe.dynamics.protocol import BODY_COLUMNS, LAST_EVENT, Column, Slope

UPPER: Final = 0
LOWER: Final = 1
"""Numbers of the bodies."""

# indices in the state after rotation and height of the upper body, see rockframe.dynamics.bodies
LOWER_ROTATION: Final = 2
LOWER_VERTICAL: Final = 3
HORIZONTAL: Final = 4
LOWER_HORIZONTAL: Final = 5
COORDINATES: Final = 2 * BODY_DOF

COLUMNS: Final = (
    *BODY_COLUMNS,
    Column("cap_rotation"),
    Column("cap_angular_velocity"),
    Column("cap_vertical_displacement"),
    Column("cap_vertical_velocity"),
    Column("rotation_on_cap"),
    Column("vertical_displacement_on_cap"),
)


CONTACTS: Final = ("contact_state", "soil_contact_state")
"""Names of the contact states of both bodies."""


class Modes(NamedTuple):
    """Modes of both bodies."""

    upper: Mode
    lower: Mode


class States(NamedTuple):
    """Placement and rates of both bodies, each relative to its base."""

    upper: BodyState
    lower: BodyState


class Stacked(StateAccess):
    """Access to modes, states and guards of two bodies. A mixin of named tuples with both."""

    __slots__ = ()
    upper: BodyOnBase
    lower: BodyOnBase

    @inlined
    def bodies(self) -> int:
        """Return the number of bodies."""
        return 2

    @kernel
    def variables(self) -> int:
        """Return the number of variables of first order: those of both bases."""
        return self.upper.base.variables() + self.lower.base.variables()

    @kernel
    def guards(self) -> int:
        """Return the number of guards: of the upper body, then of the lower one."""
        return self.upper.guards() + self.lower.guards()

    @kernel
    def modes(self) -> int:
        """Return the number of modes."""
        return self.upper.modes() * self.lower.modes()

    @inlined
    def contact_state_of(self, mode: int, k: int) -> int:
        """Return the contact state of a body."""
        modes = self.modes_in(mode)
        if k == UPPER:
            return self.upper.contact_state(modes.upper)
        return self.lower.contact_state(modes.lower)

    @inlined
    def relaxation_in(self, mode: int) -> float:
        """Return the rate at which a sliding end follows its base, the larger of both [s^-1]."""
        modes = self.modes_in(mode)
        return max(self.upper.relaxation_in(modes.upper), self.lower.relaxation_in(modes.lower))

    @inlined
    def modes_in(self, mode: int) -> Modes:
        """Read a mode from its number."""
        count = self.upper.modes()
        return Modes(self.upper.mode_of(mode % count), self.lower.mode_of(mode // count))

    @inlined
    def states_in(self, state: Vector) -> States:
        """Read placement and rates of both bodies."""
        return States(self.state_of(UPPER, state), self.state_of(LOWER, state))

    @inlined
    def base_variable_index(self, k: int) -> int:
        """Return the index in the state of a base's own variables."""
        return 2 * COORDINATES + (0 if k == UPPER else self.upper.base.variables())

    @inlined
    def upper_own(self, state: Vector) -> Any:
        """Read the variables of the upper base."""
        return self.upper.base.read(state, self.base_variable_index(UPPER))

    @inlined
    def lower_own(self, state: Vector) -> Any:
        """Read the variables of the lower base."""
        return self.lower.base.read(state, self.base_variable_index(LOWER))

    @kernel
    def body_mode(self, mode: int, k: int) -> Mode:
        """Return contact, held point and sliding of a body in a mode."""
        modes = self.modes_in(mode)
        return modes.upper if k == UPPER else modes.lower

    @kernel
    def with_body_mode(self, mode: int, k: int, part: Mode) -> int:
        """Return the mode of both bodies with another mode of one."""
        count = self.upper.modes()
        if k == UPPER:
            return mode - mode % count + self.upper.number_of(part)
        return mode % count + count * self.lower.number_of(part)

    @kernel
    def velocities(self, state: Vector) -> tuple[float, ...]:
        """Return all velocities."""
        n = COORDINATES
        return state[n], state[n + 1], state[n + 2], state[n + 3], state[n + 4], state[n + 5]

    @kernel
    def some_end_slides(self, mode: int) -> bool:
        """Whether an end of either body slides."""
        modes = self.modes_in(mode)
        return modes.upper.slides or modes.lower.slides

    @inlined
    def without_sliding(self, mode: int) -> int:
        """Return a mode without the sliding of either body."""
        count = self.upper.modes()
        return (mode % count & ~SLIDING_BIT) + count * (mode // count & ~SLIDING_BIT)

    @inlined
    def guards_of_both(
        self, modes: Modes, state: Vector, slope: Slope, upper: SlidingGuards, lower: SlidingGuards
    ) -> Guards:
        """Return the guards of both bodies, with those of ends that slide, and their rates."""
        states = self.states_in(state)
        above = self.upper.guards_with(
            modes.upper,
            states.upper,
            self.upper_own(state),
            slope[VERTICAL],
            slope[ROTATION],
            upper,
        )
        below = self.lower.guards_with(
            modes.lower, states.lower, self.lower_own(state), slope[LOWER_VERTICAL],
            slope[LOWER_ROTATION], lower,
        )  # fmt: skip
        return Guards(above.values + below.values, above.changes + below.changes)

    @kernel
    def columns_of_bases(self, mode: int, state: Vector) -> tuple[float, ...]:
        """Return the columns of both bases."""
        modes, states = self.modes_in(mode), self.states_in(state)
        above = self.upper.base_columns(modes.upper, states.upper, self.upper_own(state))
        return above + self.lower.base_columns(modes.lower, states.lower, self.lower_own(state))


@kernel
def name_soil_event(memory: Vector) -> None:
    """Rename the last event to the kind that it has for the lower body, on soil."""
    event = int(memory[LAST_EVENT])
    if event == PIVOT_CHANGE:
        memory[LAST_EVENT] = SOIL_PIVOT_CHANGE
    elif event == SEPARATION:
        memory[LAST_EVENT] = SOIL_SEPARATION
    elif event != SILENT:
        memory[LAST_EVENT] = SOIL_CONTACT
