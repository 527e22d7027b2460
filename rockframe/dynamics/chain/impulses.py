"""Impulses in an event: of rigid bases, and of a deformable base on which an end lands.

First the corners that bear on rigid bases react to the impulse of the landing as constraints. If
this takes tension or more than friction, all impulses of the event are undone and found again, the
rigid bases in compression only, the impulse of the landing scaled so that its end gets the speed
that restitution leaves it.
"""

import math
from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corner_guards import CornerGuards
from rockframe.dynamics.chain.impact import (
    LEFT_ONLY,
    NOISE,
    RIGHT_ONLY,
    find_bearing_corners,
    solve_trial,
)
from rockframe.dynamics.chain.motion import (
    add_base_load,
    add_tangential_load,
    set_inertia_loads,
    write_kinematics,
    write_relative_accelerations,
)
from rockframe.dynamics.chain.rows import BODY_STRIDE, CONSTRAINT_STRIDE
from rockframe.dynamics.switching import end_speed

MAX_BISECTIONS: Final = 60
"""Most steps of a bisection for the scale of a landing impulse: above the bits of a float."""
MAX_LANDING_SCALE: Final = 1e3
"""Largest scale of a landing impulse; if more is needed the impulse stays unscaled."""


SLIP_TOLERANCE: Final = 1e-9
"""Velocity of slip, over the velocities along the base, that counts as none [1]."""


class LandingScales(NamedTuple):
    """Factors of a landing impulse: of the whole, and of its friction in addition [1]."""

    normal: float
    tangential: float


class LandingSpeeds(NamedTuple):
    """Velocities after new impulses: of an end, less the target, and of slip."""

    excess: float
    slip: float  # velocity of slip, positive in the sense of the friction


class RigidImpulses(CornerGuards):
    """Stacked bodies that get impulses from rigid bases in an event. A mixin of systems."""

    __slots__ = ()

    @kernel
    def apply_response(self, state: Vector) -> None:
        """Change the velocities by the last response, and add up the impulses of rigid bases."""
        self.add_velocity_changes(state)
        work, rows = self.workspace(), self.constraints()
        for j in range(self.body_count):
            i, last = j * BODY_STRIDE, -1
            for side in range(2):
                which = int(work[i + at.LEFT_CONSTRAINT + side])
                if which >= 0:
                    work[i + at.LEFT_IMPULSE + side] += rows[which * CONSTRAINT_STRIDE + at.FORCE]
                    self.add_constraint_impulse(j, which, work, rows)
                    last = which
            # the constraint along the base comes behind those of the corners
            if last >= 0 and self.trial_sense(j) == 0.0:
                self.add_constraint_impulse(j, last + 1, work, rows)

    @kernel
    def add_constraint_impulse(self, k: int, which: int, work: Vector, rows: Vector) -> None:
        """Add the impulse of a rigid base's constraint to the totals of the bodies it acts on."""
        first = which * CONSTRAINT_STRIDE
        force, direction = rows[first + at.FORCE], first + at.FORCE_DIRECTION
        for body in range(k, min(k + 2, self.body_count)):
            i = body * BODY_STRIDE + at.IMPULSE_X
            for j in range(3):
                work[i + j] += force * rows[direction + j]
            direction += 3

    @kernel
    def scale_impulses(self, share: float) -> None:
        """Multiply the impulses of all bases in this event by a factor."""
        work = self.workspace()
        for k in range(self.body_count):
            for j in range(at.IMPULSE_COUNT):
                work[k * BODY_STRIDE + at.LEFT_IMPULSE + j] *= share

    @inlined
    def needs_new_impulses(self, closed: int, mode: int) -> bool:
        """Whether impulses must be found again: in tension, or none at a closed corner."""
        return self.has_tension_impulse() or closed != self.bearing_corners(mode)

    @kernel
    def has_tension_impulse(self) -> bool:
        """Whether the impulse of a corner on a rigid base in this event is one of tension."""
        work, least, all_of_them = self.workspace(), 0.0, 0.0
        for k in range(self.body_count):
            for side in range(2):
                impulse = work[k * BODY_STRIDE + at.LEFT_IMPULSE + side]
                least, all_of_them = min(least, impulse), all_of_them + abs(impulse)
        return least < -NOISE * all_of_them

    @kernel
    def change_velocities(self, state: Vector) -> None:
        """Change the velocities by the last solution for impulses, which is in the workspace."""
        work = self.workspace()
        for k in range(self.body_count):
            i = k * BODY_STRIDE
            work[i + at.NORMAL_RATE] = work[i + at.TANGENTIAL_RATE] = 0.0
            work[i + at.FRAME_ROTATION_RATE] = 0.0
        write_relative_accelerations(self, work, self.slopes())
        self.add_velocity_changes(state)

    @inlined
    def record_impulse(self, k: int, normal: float, moment: float, along: float) -> None:
        """Add to the impulses of a deformable base on its body as an end lands."""
        work, i = self.workspace(), k * BODY_STRIDE
        work[i + at.LANDING_NORMAL] += normal
        work[i + at.LANDING_MOMENT] += moment
        work[i + at.LANDING_TANGENTIAL] += along

    @kernel
    def undo_impulses(self, k: int, scales: LandingScales, mode: int, state: Vector) -> None:
        """Undo the impulses of rigid bases, and scale the landing impulse on a body."""
        work = self.workspace()
        write_kinematics(self, mode, state, work)
        for j in range(self.body_count):
            i = j * BODY_STRIDE
            work[i + at.LOAD_X] = -work[i + at.IMPULSE_X]
            work[i + at.LOAD_Y] = -work[i + at.IMPULSE_Y]
            work[i + at.LOAD_MOMENT] = -work[i + at.IMPULSE_MOMENT]
        i, off = k * BODY_STRIDE, scales.normal - 1.0
        normal, moment = off * work[i + at.LANDING_NORMAL], off * work[i + at.LANDING_MOMENT]
        add_base_load(self, k, normal, moment, work)
        off = scales.normal * scales.tangential - 1.0
        add_tangential_load(self, k, off * work[i + at.LANDING_TANGENTIAL], work)
        solve_trial(self, mode, 0, 0, False, True, 0.0, state)
        self.change_velocities(state)

    @kernel
    def landing_scales(
        self, k: int, ends: int, mode: int, closed: int, state: Vector
    ) -> LandingScales:
        """Return factors of a landing impulse, and of its friction, with new impulses elsewhere.

        One end gets the speed that restitution prescribes, and none a higher one. Friction does
        not reverse the slip.
        """
        work, i = self.workspace(), k * BODY_STRIDE
        if work[i + at.LANDING_NORMAL] <= 0.0 and work[i + at.LANDING_TANGENTIAL] == 0.0:
            return LandingScales(1.0, 1.0)
        opposed = self.slip_along_friction(k, mode, state) <= 0.0
        low, high, share = 0.0, math.inf, 1.0
        for _ in range(MAX_BISECTIONS):
            scales = LandingScales(
                share, self.friction_scale(k, opposed, share, mode, closed, state)
            )
            excess = self.try_landing(k, ends, scales, mode, closed, state).excess
            if excess > 0.0:
                high = share
            else:
                low = share
            if excess == 0.0:
                break
            share = 0.5 * (low + high) if high < math.inf else 2.0 * share
            if share > MAX_LANDING_SCALE:
                low = 1.0
                break
        return LandingScales(low, self.friction_scale(k, opposed, low, mode, closed, state))

    @kernel
    def friction_scale(
        self, k: int, opposed: bool, press: float, mode: int, closed: int, state: Vector
    ) -> float:
        """Return the factor of friction for a factor `press` of the landing impulse.

        Friction must oppose the slip. The factor is 1 if it did not in the first solution
        (`opposed` is false). The slip is linear in it as long as the same corners bear.
        """
        if not opposed or self.workspace()[k * BODY_STRIDE + at.LANDING_TANGENTIAL] == 0.0:
            return 1.0
        low, high = 0.0, 1.0
        at_high = self.try_landing(k, 0, LandingScales(press, high), mode, closed, state).slip
        if at_high <= 0.0:
            return high
        at_low = self.try_landing(k, 0, LandingScales(press, low), mode, closed, state).slip
        for _ in range(MAX_BISECTIONS):
            if at_low >= 0.0:
                break
            share = low - (high - low) * at_low / (at_high - at_low)
            slip = self.try_landing(k, 0, LandingScales(press, share), mode, closed, state).slip
            if slip > 0.0:
                high, at_high, at_low = share, slip, 0.5 * at_low
            else:
                low, at_low, at_high = share, slip, 0.5 * at_high
        return low

    @kernel
    def try_landing(
        self, k: int, ends: int, scales: LandingScales, mode: int, closed: int, state: Vector
    ) -> LandingSpeeds:
        """Return velocities with a scaled landing impulse and new others; restores the state."""
        part, n, before = self.on_base(k), self.coordinates(), self.velocities(state)
        left, noise_left = end_speed(part, True, self.state_of(k, state))
        right, noise_right = end_speed(part, False, self.state_of(k, state))
        self.undo_impulses(k, scales, mode, state)
        write_kinematics(self, mode, state, self.workspace())
        set_inertia_loads(self, 0.0, 0.0, self.workspace())
        find_bearing_corners(self, mode, closed, 0, closed, 0, state)
        self.change_velocities(state)
        left_after, more_left = end_speed(part, True, self.state_of(k, state))
        right_after, more_right = end_speed(part, False, self.state_of(k, state))
        rises, least = -math.inf, 0.0
        if ends & LEFT_ONLY != 0:
            rises, least = left_after - left, noise_left + more_left
        if ends & RIGHT_ONLY != 0 and right_after - right > rises:
            rises, least = right_after - right, noise_right + more_right
        if abs(rises) <= least:
            rises = 0.0
        speeds = LandingSpeeds(rises, self.slip_along_friction(k, mode, state))
        for i in range(n):
            state[n + i] = before[i]
        return speeds

    @kernel
    def slip_along_friction(self, k: int, mode: int, state: Vector) -> float:
        """Return the velocity of slip, positive in the sense of the friction of the landing."""
        body = self.state_of(k, state)
        reach = self.on_base(k).body.reach_about(self.body_mode(mode, k).pivot, body.rotation)
        about, sway = reach.derivative * body.angular_velocity, body.horizontal_velocity
        slip, along = sway - about, self.workspace()[k * BODY_STRIDE + at.LANDING_TANGENTIAL]
        if along == 0.0 or abs(slip) <= SLIP_TOLERANCE * (abs(sway) + abs(about)):
            return 0.0
        return math.copysign(slip, along * slip)
