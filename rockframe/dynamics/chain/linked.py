"""Links between points of bodies, or between a body and the ground: their loads and events.

Links load the bodies, :eq:`eq-link-loads`; the equations of the bodies are otherwise unchanged.
"""

from collections.abc import Callable, Sequence
from typing import Any

from rockframe.compiled import Vector, inlined, kernel, numbers_in, view_of
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.link_points import DisplacedPoint, LinkPoints
from rockframe.dynamics.chain.link_rows import (
    DIRECTION_X,
    DIRECTION_Y,
    FIRST_BODY,
    GROUND,
    LINK_COLUMNS,
    LINK_FORCE_X,
    LINK_FORCE_Y,
    PLACE_VALUE,
    POSE_STRIDE,
    REST_ENERGY,
    SECOND_BODY,
    STATE_COUNT,
    ChainLink,
    link_row,
    padded_state_count,
)
from rockframe.dynamics.chain.rows import BODY_STRIDE
from rockframe.dynamics.links import GUARDS
from rockframe.dynamics.protocol import (
    LAST_EVENT,
    LINK_LOSS,
    MAX_MODES,
    Energies,
    Ground,
    Guards,
    Slope,
)
from rockframe.dynamics.several_laws import combined_law, law_prototypes
from rockframe.errors import AssemblyError


class LinkMechanics(LinkPoints):
    """Loads, guards, events, energies and columns of links. A mixin of systems."""

    __slots__ = ()

    # methods of the system of the bodies; poses are written after the kinematics of `workspace`,
    # which energies and columns leave there
    moving_in: Callable[[int], int]
    workspace: Callable[[], Vector]
    write_poses: Callable[[int, Vector, Vector], None]
    write_kinematics_and_poses: Callable[[int, Vector, Vector], None]
    forces_from_slope: Callable[[int, Vector, Slope, Ground], None]  # writes accelerations
    guards_of_bodies: Callable[[int, Vector, Slope, Ground], Guards]
    switch_body: Callable[[int, int, Vector, Ground, Vector], int]
    reset_event: Callable[[Vector], None]
    energies_of_bodies: Callable[[int, Vector], Energies]
    observe_bodies: Callable[[int, Vector, Slope, Ground, Vector], Vector]

    @kernel
    def apply_link_forces(self, mode: int, state: Vector, work: Vector) -> float:
        """Load all bodies by their links, :eq:`eq-link-loads`; return the power these dissipate."""
        poses, out, lost = self.poses(), self.slopes(), 0.0
        self.write_poses(mode, state, work)
        for k in range(self.body_count):
            poses[k * POSE_STRIDE + LINK_FORCE_X] = poses[k * POSE_STRIDE + LINK_FORCE_Y] = 0.0
        for i in range(self.link_count):
            row, law, link_state, own = self.link(i, mode, state)
            count = law.variables()
            rates = view_of(out, self.coordinates() + i * count, count)
            if law.idles(link_state):
                for j in range(count):
                    rates[j] = 0.0
                continue
            first, second = self.end_points(row, work)
            link = self.link_kinematics(row, first, second)
            force = law.force(link_state, link.stretch, own)
            lost += law.power(link_state, link.stretch, own)
            self.add_point_force(
                int(row[FIRST_BODY]), first, -force * link.x, -force * link.y, work, poses
            )
            self.add_point_force(
                int(row[SECOND_BODY]), second, force * link.x, force * link.y, work, poses
            )
            law.rates(link_state, link.stretch, own, rates)
        return lost

    @inlined
    def add_point_force(
        self, k: int, point: DisplacedPoint, x: float, y: float, work: Vector, poses: Vector
    ) -> None:
        """Add a force on a point of a body, or of the ground."""
        if k != GROUND:
            i, j = k * BODY_STRIDE, k * POSE_STRIDE
            work[i + at.LOAD_X] += x
            work[i + at.LOAD_Y] += y
            work[i + at.LOAD_MOMENT] += x * point.arm_y - y * point.arm_x
            poses[j + LINK_FORCE_X] += x
            poses[j + LINK_FORCE_Y] += y

    @inlined
    def resultant_of_links(self, k: int) -> tuple[float, float]:
        """Return the last resultant of links on a body, to the right and up, per reference mass."""
        poses, j = self.poses(), k * POSE_STRIDE
        return poses[j + LINK_FORCE_X], poses[j + LINK_FORCE_Y]

    @kernel
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return the guards of the bodies, then of each link in turn, and their rates."""
        guards, idle = self.guards_of_bodies(mode, state, slope, ground), self.all_idle(mode)
        work, values, changes = self.workspace(), self.guard_workspace(0), self.guard_workspace(1)
        if idle and self.moving_in(mode) == 0:
            for i in range(self.body_guard_count(), len(values)):
                values[i], changes[i] = 1.0, 0.0
            return guards
        if idle:
            self.write_kinematics_and_poses(mode, state, work)
        else:
            self.forces_from_slope(mode, state, slope, ground)
        for i in range(self.link_count):
            row, law, link_state, own = self.link(i, mode, state)
            link, first = self.link_stretch(row, work, idle), self.body_guard_count() + GUARDS * i
            for which in range(GUARDS):
                value, change = law.guard(which, link_state, link, own)
                values[first + which], changes[first + which] = value, change
        return guards

    @inlined
    def all_idle(self, mode: int) -> bool:
        """Whether it is known, without asking each link, that none acts in a mode."""
        return False

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; return the new mode."""
        return self.switch_body_or_link(mode, guard, state, ground, memory)

    @kernel
    def switch_body_or_link(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch of a body or of a link; return the new mode."""
        link_of_event, body_guards = len(memory) - 1, self.body_guard_count()
        if guard < body_guards:
            memory[link_of_event] = 0.0
            return self.switch_body(mode, guard, state, ground, memory)
        self.reset_event(memory)
        i = (guard - body_guards) // GUARDS
        row, law, link_state, own = self.link(i, mode, state)
        work = self.workspace()
        self.write_kinematics_and_poses(mode, state, work)
        which = guard - body_guards - GUARDS * i
        event = law.switch(which, link_state, self.stretch_now(row, work), own)
        memory[LAST_EVENT] = event.event
        memory[LINK_LOSS] += event.lost
        memory[link_of_event] = i + 1.0
        return mode + int(row[PLACE_VALUE]) * (event.state - link_state)

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Return the energies of all bodies, bases and links."""
        energies, work = self.energies_of_bodies(mode, state), self.workspace()
        self.write_poses(mode, state, work)
        gravity, elastic, change = energies.gravity, energies.elastic, energies.from_rest
        for i in range(self.link_count):
            row, law, link_state, own = self.link(i, mode, state)
            stored = law.energy(link_state, self.stretch_now(row, work), own)
            # loads and walls have a fixed direction; a load has one state, a wall two
            if (row[DIRECTION_X] != 0.0 or row[DIRECTION_Y] != 0.0) and row[STATE_COUNT] <= 1.0:
                gravity += stored
            else:
                elastic += stored
                change += stored - row[REST_ENERGY]
        return Energies(energies.kinetic, gravity, elastic, change)

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> Vector:
        """Return columns of the bodies, then those of each link, and the moment of all links."""
        out, work = self.observe_bodies(mode, state, slope, ground, memory), self.workspace()
        moment = 0.0
        for i in range(self.link_count):
            row, law, link_state, own = self.link(i, mode, state)
            first, second = self.end_points(row, work)
            link = self.link_kinematics(row, first, second)
            j = self.body_column_count() + LINK_COLUMNS * i
            force = law.force(link_state, link.stretch, own)
            out[j], out[j + 1] = force, link.stretch.elongation
            out[j + 2] = law.shown(link_state)
            if row[FIRST_BODY] == 0.0:
                moment -= force * (link.x * first.arm_y - link.y * first.arm_x)
            if row[SECOND_BODY] == 0.0:
                moment += force * (link.x * second.arm_y - link.y * second.arm_x)
        out[self.columns() - 1] = moment
        return out

    def store_rest_energies(self, mode: int, state: Vector) -> None:
        """Write the energies of links at rest to their rows: energies are changes from these."""
        work = self.workspace()
        self.write_kinematics_and_poses(mode, state, work)
        for i in range(self.link_count):
            row, law, link_state, own = self.link(i, mode, state)
            row[REST_ENERGY] = law.energy(link_state, self.stretch_now(row, work), own)

    @kernel
    def start_links(self, mode: int, state: Vector) -> int:
        """Return the mode with the states in which links start; sets their variables."""
        work = self.workspace()
        self.write_kinematics_and_poses(mode, state, work)
        for i in range(self.link_count):
            row, law, was, own = self.link(i, mode, state)
            starts = law.starting(self.stretch_now(row, work), own)
            mode += int(row[PLACE_VALUE]) * (starts - was)
        return mode


def link_law_and_rows(
    links: Sequence[ChainLink], modes: int, bodies: int
) -> tuple[Any, list[Vector]]:
    """Return one law for all links, whose numbers are placeholders, and the row of each link.

    `modes` is the number of modes of the bodies without links.
    """
    laws = [link.numbers.law for link in links]
    kinds = law_prototypes(laws)
    own = [combined_law(kinds, law) for law in laws]
    rows, value = list[Vector](), modes
    for link, numbers in zip(links, own, strict=True):
        rows.append(link_row(link, numbers, value))
        value *= padded_state_count(link.numbers.law.states())
    if value > MAX_MODES:
        msg = f"{len(links)} links are more than {bodies} bodies can have"
        raise AssemblyError([msg])
    return own[0].with_numbers(numbers_in(own[0]).tolist()), rows
