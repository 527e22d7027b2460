"""A block that slides, rocks and flies on rigid ground, with links: its equations and its model.

Links act on the block as weight and inertia do, :eq:`eq-slide-tied`: motion and switches are those
of :mod:`rockframe.dynamics.slide_motion` and :mod:`rockframe.dynamics.slide_rock`. The
number of the mode includes the state of each link beside bearing and slip.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, put, view_of
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.link_rows import (
    BODY_ROTATION_RATE,
    BODY_SINE,
    BODY_VERSINE,
    DISPLACEMENT_X,
    DISPLACEMENT_Y,
    MOMENT_OF_LINKS,
    ChainLink,
    link_columns,
)
from rockframe.dynamics.chain.linked import LinkMechanics, link_law_and_rows
from rockframe.dynamics.chain.model import (
    link_force_rounding,
    link_guard_tolerance,
    link_scales,
    visible_links,
)
from rockframe.dynamics.chain.returned import with_workspace
from rockframe.dynamics.chain.rows import BODY_STRIDE
from rockframe.dynamics.protocol import ContactModel, Ground, Guards, Slope, Start
from rockframe.dynamics.slide_motion import (
    COLUMNS,
    DOF,
    GUARDS,
    HELD,
    MODES,
    NORMAL_FORCE,
    RISE,
    ROTATION,
    SLIP,
    Loads,
)
from rockframe.dynamics.slide_rock import SlideRock, slide_rock
from rockframe.dynamics.trigonometry import sine_cosine, versine
from rockframe.dynamics.vibrations import greatest_eigenvalue

BLOCK_COLUMNS: Final = len(COLUMNS)
SLIP_COLUMNS: Final = ("slip", "slip_velocity")


class TiedNumbers(NamedTuple):
    """The numbers of a block with links: first those of :class:`SlideRock`."""

    left: float
    right: float
    height: float
    inertia: float
    static: float
    kinetic: float
    impulsive: float
    left_lever: float
    right_lever: float
    gravity: float
    body_count: int  # 1
    link_count: int
    begins_idle: float  # 1 where no link has a force while all are in their first state, else 0
    law: Any  # of the class of all links; its numbers are replaced by those of each link's row
    rows: Vector  # workspace of the block; then rows of the links and their workspace


class TiedSlideRock(TiedNumbers, LinkMechanics, SlideRock):  # pyright: ignore[reportGeneralTypeIssues]
    """A block on rigid ground with friction and links, per unit mass: a system."""

    __slots__ = ()

    @inlined
    def workspace(self) -> Vector:
        """Return the workspace for velocities, loads and accelerations of the block."""
        return view_of(self.rows, 0, BODY_STRIDE)

    @inlined
    def bodies_end(self) -> int:
        """Return the index behind the workspace of the block."""
        return BODY_STRIDE

    @inlined
    def body_guard_count(self) -> int:
        """Return the number of guards of the block."""
        return GUARDS

    @inlined
    def body_column_count(self) -> int:
        """Return the number of columns of the block."""
        return BLOCK_COLUMNS

    @inlined
    def reset_event(self, memory: Vector) -> None:
        """Reset the memory of the last event: only its link, which is set elsewhere."""

    @inlined
    def all_idle(self, mode: int) -> bool:
        """Whether no link has a force in a mode, where this is known without their laws."""
        return mode < MODES and self.begins_idle != 0.0

    @kernel
    def write_poses(self, mode: int, state: Vector, work: Vector) -> None:
        """Write displacement, rotation and velocity of the block."""
        poses, side = self.poses(), self.side(self.bearing_in(mode))
        sine, cosine = sine_cosine(state[ROTATION])
        one_less_cosine = versine(sine, cosine)
        away = side * self.distance(side)
        poses[DISPLACEMENT_X] = state[SLIP] + self.height * sine + away * one_less_cosine
        poses[DISPLACEMENT_Y] = state[RISE] + away * sine - self.height * one_less_cosine
        poses[BODY_SINE], poses[BODY_VERSINE] = sine, one_less_cosine
        poses[BODY_ROTATION_RATE] = state[DOF + ROTATION]
        work[at.SPEED_X], work[at.SPEED_Y] = self.centre_velocity(mode, state)

    @inlined
    def write_kinematics_and_poses(self, mode: int, state: Vector, work: Vector) -> None:
        """Write displacement, rotation and velocity of the block, as :meth:`write_poses`."""
        self.write_poses(mode, state, work)

    @inlined
    def loads_and_link_power(self, mode: int, state: Vector, ground: Ground) -> tuple[Loads, float]:
        """Return loads on the block, :eq:`eq-slide-tied`, and the power that links dissipate."""
        if self.all_idle(mode):
            return Loads(ground.x, self.gravity + ground.y, 0.0), 0.0
        work = self.workspace()
        work[at.LOAD_X] = work[at.LOAD_Y] = work[at.LOAD_MOMENT] = 0.0
        dissipated = self.apply_link_forces(mode, state, work)
        along = ground.x - work[at.LOAD_X]
        weight = self.gravity + ground.y - work[at.LOAD_Y]
        return Loads(along, weight, work[at.LOAD_MOMENT]), dissipated

    @kernel
    def loads(self, mode: int, state: Vector, ground: Ground) -> Loads:
        """Return the loads on the block: weight, inertia, and the forces of links."""
        return self.loads_and_link_power(mode, state, ground)[0]

    @kernel
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> Vector:
        """Return accelerations, rates of the links' variables, and powers."""
        out = self.slopes()
        if self.all_idle(mode):
            for i in range(len(out)):
                out[i] = 0.0
            if mode == HELD:
                return out
        loads, dissipated = self.loads_and_link_power(mode, state, ground)
        slope = self.accelerations(mode, state, ground, loads)
        out[SLIP], out[ROTATION], out[RISE] = slope[SLIP], slope[ROTATION], slope[RISE]
        powers = DOF + self.variables()
        out[powers], out[powers + 1] = slope[DOF] + dissipated, slope[DOF + 1]
        return out

    @kernel
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Return power dissipated, of the slope, and that of the ground at the state's rates."""
        across, up = self.centre_velocity(mode, state)
        return slope[DOF + self.variables()], -ground.x * across - ground.y * up

    @kernel
    def guards_of_bodies(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Write the guards of the block, and their rates."""
        values, changes = self.guard_workspace(0), self.guard_workspace(1)
        guards = self.guards_of_block(mode, state, slope, ground)
        put(guards.values, 0, values)
        put(guards.changes, 0, changes)
        return Guards(values, changes)

    @kernel
    def forces_from_slope(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> None:
        """Write the acceleration of the block, from a slope."""
        work = self.workspace()
        self.write_poses(mode, state, work)
        horizontal, rise = self.centre_acceleration(mode, state, slope)
        work[at.ACCELERATION_X], work[at.ACCELERATION_Y] = horizontal, rise
        work[at.ANGULAR_ACCELERATION] = slope[ROTATION]

    @kernel
    def observe_bodies(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> Vector:
        """Write motion, reactions and slip of the block, and its displacement for links."""
        # links without a force have columns, too
        self.write_kinematics_and_poses(mode, state, self.workspace())
        out = self.column_workspace()
        put(self.columns_of_block(mode, state, slope, ground, memory), 0, out)
        return out


def tied_slide_rock(block: SlideRock, ties: Sequence[ChainLink], *, mass: float) -> ContactModel:
    """Assemble the model of a block that slides and rocks with links, from its mass [kg]."""
    untied = slide_rock(block, mass=mass)
    law, rows = link_law_and_rows(ties, MODES, 1)
    array = np.concatenate([np.zeros(BODY_STRIDE), *rows])
    system: TiedSlideRock = with_workspace(TiedSlideRock(*block, 1, len(ties), 0.0, law, array))
    laws = [system.law_of(system.row_of_link(i)) for i in range(len(ties))]
    system = system._replace(begins_idle=float(all(law.idles(0) for law in laws)))
    upright, at_rest, _ = untied.initial(Start())
    link_variables = np.zeros(system.variables())
    state_at_rest = np.append(at_rest, link_variables)
    system.store_rest_energies(system.start_links(upright, state_at_rest), state_at_rest)

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        mode, state, memory = untied.initial(start)
        state = np.append(state, link_variables)
        return system.start_links(mode, state), state, np.append(memory, 0.0)

    frequency, damping = link_bounds(block, ties)
    block_tolerance = untied.guard_tolerance.copy()
    forces = block_tolerance[NORMAL_FORCE:]
    block_tolerance[NORMAL_FORCE:] = np.maximum(forces, link_force_rounding(ties) / block.gravity)
    visible, own = visible_links(ties), untied.columns
    if block.static == math.inf:  # no columns of slip where there cannot be any
        own = tuple(
            replace(column, name=f"unused_{column.name}") if column.name in SLIP_COLUMNS else column
            for column in own
        )
    return replace(
        untied,
        system=system,
        scales=np.append(untied.scales, link_scales(system, ties)),
        guard_tolerance=np.concatenate([block_tolerance, *map(link_guard_tolerance, ties)]),
        columns=(*own, *link_columns(len(ties), visible), MOMENT_OF_LINKS),
        memory=(*untied.memory, "link_of_event"),
        links=visible,
        selects=True,
        fastest_frequency=math.hypot(untied.fastest_frequency, frequency),
        damping_rate=damping,
        initial=initial,
    )


def link_bounds(block: SlideRock, ties: Sequence[ChainLink]) -> tuple[float, float]:
    """Return bounds of angular frequency and damping rate of a block that links alone hold."""
    stiffness, damping = np.zeros((3, 3)), np.zeros((3, 3))
    for tie in ties:
        sign = 1.0 if tie.on == 0 else -1.0
        x, y = tie.on_point if tie.on == 0 else tie.to_point
        jacobian = sign * np.array([[1.0, 0.0, y], [0.0, 1.0, -x]])
        stiffness += tie.numbers.stiffness * jacobian.T @ jacobian
        damping += tie.numbers.damping * jacobian.T @ jacobian
    root = np.diag([1.0, 1.0, math.sqrt(block.inertia)])
    fastest, damped = (greatest_eigenvalue(matrix, root) for matrix in (stiffness, damping))
    return math.sqrt(max(fastest, 0.0)), max(damped, 0.0)
