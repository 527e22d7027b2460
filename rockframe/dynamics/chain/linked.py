"""Links between points of bodies, or between a body and the ground: their loads and events.

Links load the bodies, :eq:`eq-link-loads`; the equations of the bodies are otherwise unchanged.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, numbers_in, view_of
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.link_points import LinkPoints, Moved
from rockframe.dynamics.chain.link_rows import (
    ALONG_X,
    ALONG_Y,
    GROUND,
    LIES,
    LINK_COLUMNS,
    ON,
    PLACE_VALUE,
    PULLED_X,
    PULLED_Y,
    STATES,
    STORED,
    TO,
    ChainLink,
    numbers_of_link,
    room_of_states,
)
from rockframe.dynamics.chain.rows import PLACES
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


class Linked(LinkPoints):
    """Loads, guards, events, energies and columns of links. A mixin of systems."""

    __slots__ = ()

    @kernel
    def pull(self, mode: int, state: Vector, room: Vector) -> float:
        """Load all bodies by their links, :eq:`eq-link-loads`; return the power these dissipate."""
        lies, out, lost = self.lies(), self.slopes(), 0.0
        self.lay(mode, state, room)
        for k in range(self.body_count):
            lies[k * LIES + PULLED_X] = lies[k * LIES + PULLED_Y] = 0.0
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            law, standing = self.law_of(row), self.link_state(mode, row)
            each = law.variables()
            rates = view_of(out, self.coordinates() + i * each, each)
            if law.idles(standing):
                for j in range(each):
                    rates[j] = 0.0
                continue
            on, to = self.points_of(row, room)
            link = self.drawn(row, on, to)
            force = law.force(standing, link.stretch, own)
            lost += law.power(standing, link.stretch, own)
            self.load_point(int(row[ON]), on, -force * link.x, -force * link.y, room, lies)
            self.load_point(int(row[TO]), to, force * link.x, force * link.y, room, lies)
            law.rates(standing, link.stretch, own, rates)
        return lost

    @inlined
    def load_point(
        self, k: int, point: Moved, x: float, y: float, room: Vector, lies: Vector
    ) -> None:
        """Add a force on a point of a body, or of the ground."""
        if k != GROUND:
            i, j = k * PLACES, k * LIES
            room[i + at.LOAD_X] += x
            room[i + at.LOAD_Y] += y
            room[i + at.LOAD_MOMENT] += x * point.arm_y - y * point.arm_x
            lies[j + PULLED_X] += x
            lies[j + PULLED_Y] += y

    @inlined
    def pulled_x(self, k: int) -> float:
        """Return the last resultant of links on a body, to the right, over the reference mass."""
        return float(self.lies()[k * LIES + PULLED_X])

    @inlined
    def pulled_y(self, k: int) -> float:
        """Return the last resultant of links on a body, upwards, over the reference mass."""
        return float(self.lies()[k * LIES + PULLED_Y])

    @kernel
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return the guards of the bodies, then of each link in turn, and their rates."""
        found, idle = self.guards_of_bodies(mode, state, slope, ground), self.all_idle(mode)
        room, values, changes = self.places(), self.guard_room(0), self.guard_room(1)
        if idle and self.moving_in(mode) == 0:
            for i in range(self.own_guards(), len(values)):
                values[i], changes[i] = 1.0, 0.0
            return found
        if idle:
            self.set_out(mode, state, room)
        else:
            self.forces_from(mode, state, slope, ground)
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            law, standing = self.law_of(row), self.link_state(mode, row)
            link, first = self.watched(row, room, idle), self.own_guards() + GUARDS * i
            for which in range(GUARDS):
                value, change = law.guard(which, standing, link, own)
                values[first + which], changes[first + which] = value, change
        return found

    @inlined
    def all_idle(self, mode: int) -> bool:
        """Whether it is known, without asking each link, that none acts in a mode."""
        return False

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; return the new mode."""
        return self.switch_one(mode, guard, state, ground, memory)

    @kernel
    def switch_one(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch of a body or of a link; return the new mode."""
        place, first = self.link_place(), self.own_guards()
        if guard < first:
            memory[place] = 0.0
            return self.switch_body(mode, guard, state, ground, memory)
        self.begin_event(memory)
        i = (guard - first) // GUARDS
        row, own, room = self.row_of_link(i), self.of_link(i, state), self.places()
        self.set_out(mode, state, room)
        on, to = self.points_of(row, room)
        standing, value = self.link_state(mode, row), int(row[PLACE_VALUE])
        found = self.law_of(row).switch(
            guard - first - GUARDS * i, standing, self.drawn(row, on, to).stretch, own
        )
        memory[LAST_EVENT] = found.event
        memory[LINK_LOSS] += found.lost
        memory[place] = i + 1.0
        return mode + value * (found.state - standing)

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Return the energies of all bodies, bases and links."""
        found, room = self.energies_of_bodies(mode, state), self.places()
        self.lay(mode, state, room)
        gravity, elastic, change = found.gravity, found.elastic, found.from_rest
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            on, to = self.points_of(row, room)
            stored = self.law_of(row).energy(
                self.link_state(mode, row), self.drawn(row, on, to).stretch, own
            )
            # loads and walls have a fixed direction; a load has one state, a wall two
            if (row[ALONG_X] != 0.0 or row[ALONG_Y] != 0.0) and row[STATES] <= 1.0:
                gravity += stored
            else:
                elastic += stored
                change += stored - row[STORED]
        return Energies(found.kinetic, gravity, elastic, change)

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> Vector:
        """Return columns of the bodies, then those of each link, and the moment of all links."""
        out, room = self.observe_bodies(mode, state, slope, ground, memory), self.places()
        moment = 0.0
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            law, standing = self.law_of(row), self.link_state(mode, row)
            on, to = self.points_of(row, room)
            link = self.drawn(row, on, to)
            j, force = self.own_columns() + LINK_COLUMNS * i, law.force(standing, link.stretch, own)
            out[j], out[j + 1] = force, link.stretch.elongation
            out[j + 2] = law.shown(standing)
            if row[ON] == 0.0:
                moment -= force * (link.x * on.arm_y - link.y * on.arm_x)
            if row[TO] == 0.0:
                moment += force * (link.x * to.arm_y - link.y * to.arm_x)
        out[self.columns() - 1] = moment
        return out

    def keep_energies(self, mode: int, state: Vector) -> None:
        """Write the energies of links at rest to their rows: energies are changes from these."""
        room = self.places()
        self.set_out(mode, state, room)
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            stretched = self.drawn(row, *self.points_of(row, room)).stretch
            law = self.law_of(row)
            row[STORED] = law.energy(self.link_state(mode, row), stretched, own)

    @kernel
    def start_links(self, mode: int, state: Vector) -> int:
        """Return the mode with the states in which links start; sets their variables."""
        room = self.places()
        self.set_out(mode, state, room)
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            on, to = self.points_of(row, room)
            found = self.law_of(row).starting(self.drawn(row, on, to).stretch, own)
            mode += int(row[PLACE_VALUE]) * (found - self.link_state(mode, row))
        return mode


def rows_of_links(links: Sequence[ChainLink], modes: int, bodies: int) -> tuple[Any, list[Vector]]:
    """Return one law for all links, whose numbers are placeholders, and the row of each link.

    `modes` is the number of modes of the bodies without links.
    """
    laws = [one.numbers.law for one in links]
    kinds = law_prototypes(laws)
    own = [combined_law(kinds, law) for law in laws]
    rows, value = list[Vector](), modes
    for one, each in zip(links, own, strict=True):
        rows.append(numbers_of_link(one, each, value))
        value *= room_of_states(one.numbers.law.states())
    if value > MAX_MODES:
        msg = f"{len(links)} links are more than {bodies} bodies can have"
        raise AssemblyError([msg])
    return own[0].with_numbers(numbers_in(own[0]).tolist()), rows


def with_room(system: Any, filled: Vector) -> Any:
    """Return a system with its workspace, added as zeros behind the filled part of its array."""
    return system._replace(
        rows=np.concatenate([filled, np.zeros(system.behind_room() - len(filled))])
    )
