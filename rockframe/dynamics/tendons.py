"""Columns under a beam with tendons along their axes, :eq:`eq-rocking-frame-tendon`.

The columns rock as without tendons. The gaps below and above each column elongate its tendons,
which pull it upright. All per unit mass of columns and beam.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, put, view_of
from rockframe.dynamics import rigid_ground as frame
from rockframe.dynamics.chain.link_rows import (
    GROUND,
    LINK_COLUMNS,
    PLACE_VALUE,
    REST_ENERGY,
    ChainLink,
    LinkRows,
    link_columns,
    link_row,
    padded_state_count,
)
from rockframe.dynamics.chain.returned import with_workspace
from rockframe.dynamics.links import GUARDS, LinkNumbers, Stretch
from rockframe.dynamics.pads import ROUNDING
from rockframe.dynamics.protocol import (
    LAST_EVENT,
    LINK_LOSS,
    ContactModel,
    Energies,
    Ground,
    Guards,
    OnRigidGround,
    Slope,
    Start,
)
from rockframe.dynamics.trigonometry import sine_cosine

FRAME_COLUMNS: Final = len(frame.COLUMNS)


class FrameTendonNumbers(NamedTuple):
    """The numbers of columns under a beam with tendons."""

    rocking: frame.BlockOnRigidGround
    half_width: float  # b, of a column [m]
    column_count: float  # number of columns; each has all tendons
    body_count: int  # 0: tendons follow the rotation, without poses of bodies
    law: Any  # of the class of all tendons
    link_count: int
    rows: Vector  # rows of the tendons, then the workspace


class FrameWithTendons(FrameTendonNumbers, LinkRows, OnRigidGround):
    """Columns under a beam with tendons: a system."""

    __slots__ = ()

    @kernel
    def coordinates(self) -> int:
        """Return 1, the rotation."""
        return 1

    @inlined
    def moving_in(self, mode: int) -> int:
        """Return 1 while the columns rock, 0 at rest."""
        return self.rocking.moving_in(mode % frame.MODES)

    @inlined
    def contact_state_of(self, mode: int, k: int) -> int:
        """Return the contact state: which corner bears, or both."""
        return self.rocking.contact_state_of(mode % frame.MODES, k)

    @inlined
    def bodies_end(self) -> int:
        """Return 0: no rows of bodies are before those of tendons."""
        return 0

    @inlined
    def body_guard_count(self) -> int:
        """Return the number of guards without tendons."""
        return frame.GUARDS

    @inlined
    def columns(self) -> int:
        """Return the number of columns."""
        return FRAME_COLUMNS + LINK_COLUMNS * self.link_count

    @inlined
    def lever(self, rotation: float) -> float:
        """Return the derivative of the elongation by the rotation, 2 b cos(a/2), unsigned [m]."""
        return 2.0 * self.half_width * sine_cosine(0.5 * rotation)[1]

    @inlined
    def tendon_stretch(self, mode: int, state: Vector, angular_acceleration: float) -> Stretch:
        """Return the elongation 4 b sin(|a|/2) of the tendons, and its rates."""
        side, rate = self.rocking.side(mode % frame.MODES), state[1]
        half = sine_cosine(0.5 * state[0])[0]
        length, lever = 4.0 * self.half_width, self.lever(state[0])
        centripetal = 0.25 * length * half * rate * rate
        return Stretch(
            side * length * half, side * lever * rate,
            side * (lever * angular_acceleration - centripetal), 0.0, ROUNDING * length,
        )  # fmt: skip

    @kernel
    def pull(self, mode: int, state: Vector) -> float:
        """Return the force of all tendons of all columns together."""
        stretch, force = self.tendon_stretch(mode, state, 0.0), 0.0
        for i in range(self.link_count):
            _, law, link_state, own = self.link(i, mode, state)
            force += law.force(link_state, stretch, own)
        return self.column_count * force

    @kernel
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> Vector:
        """Return the acceleration, rates of variables, dashpot power and input power."""
        out, rocking_mode = self.slopes(), mode % frame.MODES
        slope = self.rocking.accelerate(rocking_mode, state, ground)
        for i in range(len(out)):
            out[i] = 0.0
        if rocking_mode == frame.RESTING:
            return out
        restoring = self.pull(mode, state) * self.lever(state[0])
        inertia = self.rocking.corner(rocking_mode).inertia
        stretch, dissipated = self.tendon_stretch(mode, state, 0.0), 0.0
        count = self.law.variables()
        for i in range(self.link_count):
            _, law, link_state, own = self.link(i, mode, state)
            dissipated += law.power(link_state, stretch, own)
            law.rates(link_state, stretch, own, view_of(out, 1 + i * count, count))
        out[0] = slope[0] - self.rocking.side(rocking_mode) * restoring / inertia
        out[1 + self.variables()] = self.column_count * dissipated
        out[2 + self.variables()] = slope[2]
        return out

    @kernel
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Return the two powers of :meth:`accelerate`."""
        rocking_mode = mode % frame.MODES
        if rocking_mode == frame.RESTING:
            return 0.0, 0.0
        stretch, dissipated = self.tendon_stretch(mode, state, 0.0), 0.0
        for i in range(self.link_count):
            _, law, link_state, own = self.link(i, mode, state)
            dissipated += law.power(link_state, stretch, own)
        return self.column_count * dissipated, self.rocking.powers(
            rocking_mode, state, slope, ground
        )[1]

    @kernel
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return the guards of impact and uplift, then those of each tendon."""
        values, changes = self.guard_workspace(0), self.guard_workspace(1)
        rocking_mode = mode % frame.MODES
        guards = self.rocking.guards_in(rocking_mode, state, slope, ground)
        put(guards.values, 0, values)
        put(guards.changes, 0, changes)
        if rocking_mode == frame.RESTING:
            right = self.rocking.right
            height = right.radius * sine_cosine(right.angle)[1]
            restoring = self.pull(mode, state) * self.lever(0.0) / (height * self.rocking.gravity)
            values[frame.UPLIFT_ON_RIGHT] += restoring
            values[frame.UPLIFT_ON_LEFT] += restoring
        stretch = self.tendon_stretch(mode, state, slope[0])
        for i in range(self.link_count):
            _, law, link_state, own = self.link(i, mode, state)
            for which in range(GUARDS):
                j = frame.GUARDS + GUARDS * i + which
                values[j], changes[j] = 1.0, 0.0
                if rocking_mode != frame.RESTING:
                    values[j], changes[j] = law.guard(which, link_state, stretch, own)
        return Guards(values, changes)

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Let columns lift off or land, or change the state of a tendon; return the new mode."""
        rocking_mode, link_of_event = mode % frame.MODES, len(memory) - 1
        memory[link_of_event] = 0.0
        if guard < frame.GUARDS:
            restoring = self.pull(mode, state) * self.lever(0.0) / self.rocking.right.inertia
            new = self.rocking.switch_with_restoring(
                rocking_mode, guard, state, ground, memory, restoring
            )
            return mode - rocking_mode + new
        i = (guard - frame.GUARDS) // GUARDS
        row, law, link_state, own = self.link(i, mode, state)
        which = guard - frame.GUARDS - GUARDS * i
        event = law.switch(which, link_state, self.tendon_stretch(mode, state, 0.0), own)
        memory[LAST_EVENT] = event.event
        memory[LINK_LOSS] += self.column_count * event.lost
        memory[link_of_event] = i + 1.0
        return mode + int(row[PLACE_VALUE]) * (event.state - link_state)

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Return the energies of columns, beam and tendons."""
        energies = self.rocking.energies(mode % frame.MODES, state)
        stretch, stored, at_rest = self.tendon_stretch(mode, state, 0.0), 0.0, 0.0
        for i in range(self.link_count):
            row, law, link_state, own = self.link(i, mode, state)
            stored += law.energy(link_state, stretch, own)
            at_rest += row[REST_ENERGY]
        elastic = self.column_count * stored
        return Energies(
            energies.kinetic, energies.gravity, elastic, elastic - self.column_count * at_rest
        )

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> Vector:
        """Return the columns without tendons, then force, elongation and state of each tendon."""
        out, rocking_mode = self.column_workspace(), mode % frame.MODES
        put(self.rocking.observe(rocking_mode, state, slope, ground, memory), 0, out)
        # the tendons pull the ground up, and the columns press it down by as much
        sine, cosine = sine_cosine(0.5 * state[0])
        pull = self.pull(mode, state)
        out[frame.BASE_SHEAR] += pull * sine
        out[frame.HORIZONTAL_REACTION] += pull * sine
        out[frame.VERTICAL_REACTION] += pull * cosine
        if rocking_mode == frame.ON_LEFT:
            out[frame.LEFT_REACTION] += pull * cosine
        elif rocking_mode == frame.ON_RIGHT:
            out[frame.RIGHT_REACTION] += pull * cosine
        else:
            # reactions differ as the moment does, over the one at which rocking starts with tendons
            left, right = out[frame.LEFT_REACTION], out[frame.RIGHT_REACTION]
            corner = self.rocking.right
            half = corner.radius * sine_cosine(corner.angle)[0]
            limit, share = half * (left + right) + self.lever(0.0) * pull, 0.0
            if limit > 0.0:
                share = half * (left - right) / limit
            out[frame.LEFT_REACTION] = 0.5 * (1.0 + share) * out[frame.VERTICAL_REACTION]
            out[frame.RIGHT_REACTION] = 0.5 * (1.0 - share) * out[frame.VERTICAL_REACTION]
        stretch = self.tendon_stretch(mode, state, 0.0)
        for i in range(self.link_count):
            _, law, link_state, own = self.link(i, mode, state)
            j = FRAME_COLUMNS + LINK_COLUMNS * i
            out[j], out[j + 1] = law.force(link_state, stretch, own), stretch.elongation
            out[j + 2] = law.shown(link_state)
        return out


def frame_with_tendons(
    model: ContactModel, links: Sequence[LinkNumbers], *, half_width: float, columns: int
) -> ContactModel:
    """Return the model of a frame with tendons from the model without them."""
    rows, value = list[Vector](), frame.MODES
    for tendon in links:
        along = ChainLink(0, (0.0, 0.0), GROUND, (0.0, 0.0), (0.0, 0.0), tendon)
        rows.append(link_row(along, tendon.law, value))
        value *= padded_state_count(tendon.law.states())
    rocking: Any = model.system
    array, count = np.concatenate(rows), len(links)
    system: FrameWithTendons = with_workspace(
        FrameWithTendons(rocking, half_width, float(columns), 0, links[0].law, count, array)
    )
    stiffness = columns * sum(tendon.stiffness for tendon in links) * (2.0 * half_width) ** 2
    fastest = math.sqrt(model.fastest_frequency**2 + stiffness / rocking.right.inertia)

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        mode, state, memory = model.initial(start)
        state = np.concatenate([state, np.zeros(system.variables())])
        stretch = system.tendon_stretch(mode, state, 0.0)
        for i in range(count):
            row, law, _, own = system.link(i, mode, state)
            mode += int(row[PLACE_VALUE]) * law.starting(stretch, own)
        return mode, state, np.append(memory, 0.0)

    mode, state, _ = initial(Start())
    stretch = system.tendon_stretch(mode, state, 0.0)
    for i in range(count):
        row, law, link_state, own = system.link(i, mode, state)
        row[REST_ENERGY] = law.energy(link_state, stretch, own)
    return replace(
        model,
        name="rocking frame with tendons",
        system=system,
        scales=np.concatenate([model.scales, *(tendon.variable_scales for tendon in links)]),
        guard_tolerance=np.concatenate([
            model.guard_tolerance, np.full(GUARDS * count, ROUNDING * 4.0 * half_width),
        ]),
        columns=(*model.columns, *link_columns(count, count)),
        memory=(*model.memory, "link_of_event"),
        links=count,
        selects=True,
        fastest_frequency=fastest,
        initial=initial,
    )  # fmt: skip
