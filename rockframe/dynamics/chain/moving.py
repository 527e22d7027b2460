"""Motion of a chain of bodies: accelerations, energies, and responses to impulses.

Equations :eq:`eq-chain`; forces and energies are per unit of the reference mass.
"""

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, BODY_DOF, ROTATION, VERTICAL
from rockframe.dynamics.body import Attitude
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.motion import (
    FREE,
    add_constraint,
    coriolis_along,
    coriolis_normal,
    forget_trial,
    input_power,
    load_bodies,
    place_bodies,
    press_at,
    solve_motion,
    write_direction,
    write_relative,
)
from rockframe.dynamics.chain.rows import (
    CONSTRAINT,
    HALF_OF_BITS,
    PLACES,
    SOLVED_FOR,
    Rows,
)
from rockframe.dynamics.on_base import Mode, VelocityChange
from rockframe.dynamics.protocol import HELD_PLACE, Energies, Ground, Slope
from rockframe.dynamics.trigonometry import versine


class MovingBodies(Rows):
    """Equations of motion of stacked bodies. A mixin of systems."""

    __slots__ = ()

    @kernel
    def variables(self) -> int:
        """Return 0: pads and beds have no variables of their own."""
        return 0

    @kernel
    def moving_in(self, mode: int) -> int:
        """Return how many coordinates move: none at rest, else all but a held lowest one."""
        if self.moving_bodies(mode) == 0:
            return 0
        lowest = self.body_count - 1
        free = self.on_base(lowest).is_free(self.body_mode(mode, lowest))
        return BODY_DOF * self.body_count - (0 if free else 1)

    @inlined
    def moving_bodies(self, mode: int) -> int:
        """Return how many bodies, from the top, may move: all, as none rests on a rigid base."""
        return self.body_count

    @kernel
    def relaxation_in(self, mode: int) -> float:
        """Return the fastest rate at which a sliding end returns to its level [s^-1]."""
        fastest = 0.0
        for k in range(self.body_count):
            if not self.is_slippery(k):
                fastest = max(fastest, self.on_base(k).relaxation_in(self.body_mode(mode, k)))
        return fastest

    @inlined
    def base_variable_index(self, k: int) -> int:
        """Return the index in the state of the own variables of bases, which have none here."""
        return 2 * BODY_DOF * self.body_count

    @kernel
    def constrain(self, moving: int, mode: int, state: Vector, room: Vector) -> int:
        """Write the constraints of the first `moving` bodies in a mode; give their number."""
        count, rows = 0, self.constraints()
        for k in range(moving):
            standing = self.body_mode(mode, k)
            count = self.add_corners(k, count, mode, state, True, room, rows)
            count = self.hold_or_slide(k, count, standing, state, room, rows)
        return count

    @inlined
    def is_rigid(self, k: int) -> bool:
        """Whether a body stands on a rigid base: none does here."""
        return False

    @inlined
    def is_slippery(self, k: int) -> bool:
        """Whether a body may slip on a deformable base, by its friction: none does here."""
        return False

    @inlined
    def load_by_friction(self, k: int, mode: int, room: Vector) -> None:
        """Load a body that slips on a deformable base by its friction: none slips here."""

    @inlined
    def hold_or_slide(
        self, k: int, count: int, standing: Mode, state: Vector, room: Vector, rows: Vector
    ) -> int:
        """Add the constraint of a body's held point, or of its sliding end; return the count."""
        i = k * PLACES
        room[i + at.THRUST] = room[i + at.DRAG]
        if room[i + at.HELD] != FREE:
            wanted = coriolis_along(i, room) + room[i + at.DRIFT]
            add_constraint(self, count, k, 1.0, 0.0, -room[i + at.REACH], wanted, room, rows)
            count += 1
        elif standing.slides and not self.is_rigid(k) and not self.is_slippery(k):
            self.let_slide(k, count, standing, state, room, rows)
            count += 1
        return count

    @inlined
    def add_corners(
        self, k: int, count: int, mode: int, state: Vector, moves: bool, room: Vector, rows: Vector
    ) -> int:
        """Add the constraints of corners on a rigid base: there are none here."""
        return count

    @inlined
    def band(self) -> int:
        """Return the half-width of the band of the matrix: those farther apart share no body."""
        return 1

    @inlined
    def stand_still(self, room: Vector, out: Vector) -> None:
        """Set the accelerations of bodies in full contact with a rigid base to zero: none here."""

    @kernel
    def let_slide(
        self, k: int, which: int, standing: Mode, state: Vector, room: Vector, rows: Vector
    ) -> None:
        """Add the constraint that keeps a sliding end at its base, :eq:`eq-sliding-contact`."""
        i, part, body = k * PLACES, self.on_base(k), self.state_of(k, state)
        a = i + at.ATTITUDE
        attitude = Attitude(room[a], room[a + 1], room[a + 2])
        line = part.body.base_line(body, attitude)
        left = part.base.is_held(standing.contact, True)
        on_left, on_right = part.body.end_accelerations(attitude, body.angular_velocity, 0.0, 0.0)
        bend, speed = (on_left, line.left_speed) if left else (on_right, line.right_speed)
        lever = line.left_lever if left else line.right_lever
        sinking = bend + part.base.following_rate() * speed
        wanted = -coriolis_normal(i, room) - sinking
        add_constraint(self, which, k, 0.0, 1.0, lever, wanted, room, rows)
        holds = which * CONSTRAINT + at.HOLDS
        write_direction(self, k, 1.0, 0.0, -room[i + at.REACH], holds, room, rows)
        rows[which * CONSTRAINT + at.UNSYMMETRIC] = 1.0

    @kernel
    def solve(self, moving: int, count: int, room: Vector) -> None:
        """Solve for the forces of constraints, and the accelerations of bodies and coordinates."""
        rows = self.constraints()
        forget_trial(self, room)
        solve_motion(self, moving, 0, count, self.band(), room, rows, self.matrix())
        for which in range(count):  # the last constraint of a body is the one along its base
            first = which * CONSTRAINT
            room[int(rows[first + at.BODY]) * PLACES + at.THRUST] = rows[first + at.FORCE]
        write_relative(self, room, self.slopes())
        self.stand_still(room, self.slopes())

    @kernel
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> Vector:
        """Return the accelerations of all coordinates, then the powers dissipated and supplied."""
        return self.accelerate_first(self.body_count, mode, state, ground)

    @kernel
    def find_forces(self, mode: int, state: Vector, ground: Ground) -> Vector:
        """Return what `accelerate` gives, leave all forces, and note for which mode and state."""
        found = self.accelerate_first(self.body_count, mode, state, ground)
        note = self.solved_room()
        note[0], note[2], note[3] = mode >> HALF_OF_BITS, ground.x, ground.y
        note[1] = mode - (mode >> HALF_OF_BITS << HALF_OF_BITS)
        for i in range(2 * self.coordinates()):
            note[SOLVED_FOR + i] = state[i]
        self.places()[(self.body_count - 1) * PLACES + at.SOLVED] = 1.0
        return found

    @kernel
    def forces_stand(self, mode: int, state: Vector, ground: Ground) -> bool:
        """Whether the forces in the workspace are those of this mode, state and ground."""
        note, solved = self.solved_room(), (self.body_count - 1) * PLACES + at.SOLVED
        # variables of links are not noted
        stand = (self.places()[solved] != 0.0) & (self.variables() == 0)
        high = mode >> HALF_OF_BITS
        stand &= (note[0] == high) & (note[1] == mode - (high << HALF_OF_BITS))
        stand &= (note[2] == ground.x) & (note[3] == ground.y)
        for i in range(2 * self.coordinates()):
            stand &= note[SOLVED_FOR + i] == state[i]
        return bool(stand)

    @kernel
    def accelerate_first(self, moving: int, mode: int, state: Vector, ground: Ground) -> Vector:
        """Return accelerations and powers; bodies from number `moving` on rest on the ground."""
        room, out = self.places(), self.slopes()
        place_bodies(self, mode, state, room)
        load_bodies(self, ground.x, self.number(0, at.GRAVITY) + ground.y, room)
        dissipated = supplied = 0.0
        for k in range(self.body_count):
            i, mass = k * PLACES, self.number(k, at.MASS)
            part, body = self.on_base(k), self.state_of(k, state)
            a = i + at.ATTITUDE
            line = part.body.base_line(body, Attitude(room[a], room[a + 1], room[a + 2]))
            base = part.base.force(self.contact_with_force(k, mode), line, ())
            dissipated += base.dissipated
            room[i + at.PRESS] = base.upward
            press_at(self, k, base.upward, base.moment, room)
            self.load_by_friction(k, mode, room)
            supplied -= mass * (ground.x * room[i + at.SPEED_X] + ground.y * room[i + at.SPEED_Y])
        dissipated += self.pull(mode, state, room)
        self.solve(moving, self.constrain(moving, mode, state, room), room)
        for k in range(self.body_count):
            i = k * PLACES
            if self.body_mode(mode, k).slides:
                slip = room[i + at.SWAY] - room[i + at.REACH] * room[i + at.RATE]
                dissipated -= room[i + at.THRUST] * slip
        powers = BODY_DOF * self.body_count + self.variables()
        out[powers], out[powers + 1] = dissipated, supplied
        return out

    @kernel
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Return power dissipated, of the slope, and that of the ground at the state's rates."""
        dissipated = slope[BODY_DOF * self.body_count + self.variables()]
        return dissipated, input_power(self, state, ground, self.places())

    @inlined
    def contact_with_force(self, k: int, mode: int) -> int:
        """Return the contact by which the force of a body's base is computed."""
        standing = self.body_mode(mode, k)
        if self.is_slippery(k):  # its base presses whether the body slips or not
            return standing.contact
        return self.on_base(k).contact_with_force(standing)

    @inlined
    def pull(self, mode: int, state: Vector, room: Vector) -> float:
        """Load bodies by their links; return the power these dissipate: there are none here."""
        return 0.0

    @inlined
    def pulled_x(self, k: int) -> float:
        """Return the last resultant of links on a body, to the right: there are none here."""
        return 0.0

    @inlined
    def pulled_y(self, k: int) -> float:
        """Return the last resultant of links on a body, upwards: there are none here."""
        return 0.0

    @kernel
    def forces_from(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> None:
        """Write the bodies' accelerations and the forces at their bases, from a slope.

        The slope has no horizontal acceleration of a lowest body that is held: it follows from its
        rotation.
        """
        room = self.places()
        place_bodies(self, mode, state, room)
        self.pull(mode, state, room)
        x = y = angular = 0.0
        for k in range(self.body_count - 1, -1, -1):
            i, first = k * PLACES, BEFORE_HORIZONTAL * k
            along = slope[self.horizontal_of(k)]
            if room[i + at.HELD] != FREE:
                along = room[i + at.REACH] * slope[first + ROTATION] + room[i + at.DRIFT]
            along += coriolis_along(i, room) + room[i + at.ARM] * angular
            normal = slope[first + VERTICAL] - coriolis_normal(i, room)
            normal -= room[i + at.ACROSS] * angular
            sine, cosine = room[i + at.SINE], room[i + at.COSINE]
            x, y = x + along * cosine + normal * sine, y - along * sine + normal * cosine
            angular += slope[first + ROTATION]
            room[i + at.X], room[i + at.Y], room[i + at.ROTATION] = x, y, angular
        force_x = force_y = 0.0
        for k in range(self.body_count):
            i, mass = k * PLACES, self.number(k, at.MASS)
            force_x += mass * (room[i + at.X] + ground.x) - self.pulled_x(k)
            force_y += mass * (room[i + at.Y] + self.number(k, at.GRAVITY) + ground.y)
            force_y -= self.pulled_y(k)
            sine, cosine = room[i + at.SINE], room[i + at.COSINE]
            room[i + at.THRUST] = cosine * force_x - sine * force_y
            room[i + at.PRESS] = sine * force_x + cosine * force_y

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Return the energies of all bodies and bases."""
        return self.energies_of_bodies(mode, state)

    @kernel
    def energies_of_bodies(self, mode: int, state: Vector) -> Energies:
        """Return energies of all bodies and bases; leaves the bodies' places in the workspace."""
        room = self.places()
        place_bodies(self, mode, state, room)
        kinetic = gravity = elastic = change = rise = rate = 0.0
        for k in range(self.body_count - 1, -1, -1):
            i, mass = k * PLACES, self.number(k, at.MASS)
            body = self.standing_state(k, self.body_mode(mode, k), state)
            x, y = room[i + at.SPEED_X], room[i + at.SPEED_Y]
            rate += body.angular_velocity
            kinetic += 0.5 * (mass * (x * x + y * y) + self.number(k, at.INERTIA) * rate * rate)
            rise = self.rise_of(k, rise, body.vertical, room)
            gravity += mass * self.number(k, at.GRAVITY) * rise
            stored, more = self.on_base(k).elastic_energy(body, ())
            elastic += stored
            change += more
        return Energies(kinetic, gravity, elastic, change)

    @inlined
    def rise_of(self, k: int, below: float, vertical: float, room: Vector) -> float:
        """Return rise of a centre of mass, from that of the body below, without cancellation."""
        i = k * PLACES
        sine, cosine = room[i + at.SINE], room[i + at.COSINE]
        fixed = room[i + at.ARM] - vertical if k + 1 < self.body_count else 0.0
        return (
            below + vertical * cosine - room[i + at.ACROSS] * sine - fixed * versine(sine, cosine)
        )

    @kernel
    def centre_position(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return the place of a body's centre of mass along the body below, or along the ground."""
        if k + 1 < self.body_count:
            return state[self.horizontal_of(k)]
        part, body = self.on_base(k), self.state_of(k, state)
        attitude = part.body.attitude(body.rotation)
        return part.horizontal_position(
            self.body_mode(mode, k), body, attitude, memory[HELD_PLACE + k]
        )

    @kernel
    def response(
        self, k: int, mode: int, impulse: float, moment: float, slip: float, state: Vector
    ) -> VelocityChange:
        """Return the changes of velocities by an impulse of a base, or by a hold that stops a slip.

        The changes of all velocities are in the room for slopes until the next solution.
        """
        room, out = self.places(), self.slopes()
        place_bodies(self, mode, state, room)
        load_bodies(self, 0.0, 0.0, room)
        press_at(self, k, impulse, moment, room)
        self.answer(k, mode, slip, state)
        first = BEFORE_HORIZONTAL * k
        thrust = room[k * PLACES + at.THRUST]
        return VelocityChange(out[first + ROTATION], out[first + VERTICAL], thrust, ())

    @kernel
    def answer(self, k: int, mode: int, slip: float, state: Vector) -> None:
        """Solve for changes of velocities by impulses in the loads, or a hold that stops `slip`."""
        room, rows, count = self.places(), self.constraints(), 0
        for j in range(self.body_count):
            i = j * PLACES
            room[i + at.RISE] = room[i + at.SWAY] = room[i + at.FRAME_RATE] = 0.0
            count = self.add_corners(j, count, mode, state, False, room, rows)
            if room[i + at.HELD] != FREE:
                wanted = -slip if j == k else 0.0
                add_constraint(self, count, j, 1.0, 0.0, -room[i + at.REACH], wanted, room, rows)
                count += 1
            else:
                room[i + at.THRUST] = 0.0
        self.solve(self.body_count, count, room)

    @kernel
    def respond(self, k: int, mode: int, response: VelocityChange, state: Vector) -> None:
        """Change the velocities by the last response."""
        self.take_answer(state)

    @inlined
    def take_answer(self, state: Vector) -> None:
        """Change the velocities by the last response to impulses."""
        self.add_slopes(state)

    @inlined
    def add_slopes(self, state: Vector) -> None:
        """Add the room for slopes to the velocities; held points keep their constraint exactly."""
        out, room, n = self.slopes(), self.places(), self.coordinates()
        for i in range(n):
            state[n + i] += out[i]
        for j in range(self.body_count):
            if room[j * PLACES + at.HELD] != FREE:
                rate = room[j * PLACES + at.REACH] * state[n + BEFORE_HORIZONTAL * j + ROTATION]
                state[n + self.horizontal_of(j)] = rate

    @kernel
    def velocities(self, state: Vector) -> Vector:
        """Return a copy of all velocities, in a room that the next call overwrites."""
        out, n = self.velocity_room(), self.coordinates()
        for i in range(n):
            out[i] = state[n + i]
        return out

    @kernel
    def end_accelerations(
        self, k: int, mode: int, state: Vector, ground: Ground
    ) -> tuple[float, float]:
        """Return the accelerations of the left and right end away from the body below."""
        slope, first = self.find_forces(mode, state, ground), BEFORE_HORIZONTAL * k
        body = self.state_of(k, state)
        return self.on_base(k).end_accelerations_at(
            body, slope[first + VERTICAL], slope[first + ROTATION]
        )

    @kernel
    def incipient_rotation(self, k: int, mode: int, state: Vector, ground: Ground) -> float:
        """Return the sign of the rotation that will follow; at rest it is a guess."""
        if ground.x != 0.0:
            return -ground.x
        if self.body_count == 1:
            return self.on_base(k).base.tilt(self.body_mode(mode, k).contact)
        other = state[BEFORE_HORIZONTAL * (k - 1) + ROTATION] if k > 0 else 0.0
        if k == 0:
            other = -state[self.coordinates() + BEFORE_HORIZONTAL + ROTATION]
        return other if other != 0.0 else 1.0
