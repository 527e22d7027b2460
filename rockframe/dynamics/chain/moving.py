"""Motion of a chain of bodies: accelerations, energies, and responses to impulses.

Equations :eq:`eq-chain`; forces and energies are per unit of the reference mass.
"""

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, BODY_DOF, ROTATION, VERTICAL
from rockframe.dynamics.body import Attitude
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.motion import (
    FREE,
    add_base_load,
    add_constraint,
    input_power,
    normal_coriolis,
    reset_elimination,
    set_inertia_loads,
    solve_motion,
    tangential_coriolis,
    write_jacobian,
    write_kinematics,
    write_relative_accelerations,
)
from rockframe.dynamics.chain.rows import (
    BODY_STRIDE,
    CONSTRAINT_STRIDE,
    HALF_OF_BITS,
    INPUTS_BEFORE_STATE,
    ChainArray,
)
from rockframe.dynamics.on_base import Mode, VelocityChange
from rockframe.dynamics.protocol import HELD_PLACE, Energies, Ground, Slope
from rockframe.dynamics.trigonometry import versine


class MovingBodies(ChainArray):
    """Equations of motion of stacked bodies. A mixin of systems."""

    __slots__ = ()

    @kernel
    def variables(self) -> int:
        """Return 0: pads and beds have no variables of their own."""
        return 0

    @kernel
    def moving_in(self, mode: int) -> int:
        """Return how many coordinates move: none at rest, else all but a held lowest one."""
        if self.moving_body_count(mode) == 0:
            return 0
        lowest = self.body_count - 1
        free = self.on_base(lowest).is_free(self.body_mode(mode, lowest))
        return BODY_DOF * self.body_count - (0 if free else 1)

    @inlined
    def moving_body_count(self, mode: int) -> int:
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
    def write_constraints(self, moving: int, mode: int, state: Vector, work: Vector) -> int:
        """Write the constraints of the first `moving` bodies in a mode; return their number."""
        count, rows = 0, self.constraints()
        for k in range(moving):
            body_mode = self.body_mode(mode, k)
            count = self.add_corner_constraints(k, count, mode, state, True, work, rows)
            count = self.add_hold_or_slide(k, count, body_mode, state, work, rows)
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
    def apply_friction_load(self, k: int, mode: int, work: Vector) -> None:
        """Load a body that slips on a deformable base by its friction: none slips here."""

    @inlined
    def add_hold_or_slide(
        self, k: int, count: int, body_mode: Mode, state: Vector, work: Vector, rows: Vector
    ) -> int:
        """Add the constraint of a body's held point, or of its sliding end; return the count."""
        i = k * BODY_STRIDE
        work[i + at.TANGENTIAL_FORCE] = work[i + at.FRICTION_LOAD]
        if work[i + at.HOLD_STATE] != FREE:
            prescribed = tangential_coriolis(i, work) + work[i + at.PIVOT_CENTRIPETAL]
            arm = work[i + at.PIVOT_ARM]
            add_constraint(self, count, k, 1.0, 0.0, -arm, prescribed, work, rows)
            count += 1
        elif body_mode.slides and not self.is_rigid(k) and not self.is_slippery(k):
            self.add_sliding_constraint(k, count, body_mode, state, work, rows)
            count += 1
        return count

    @inlined
    def add_corner_constraints(
        self, k: int, count: int, mode: int, state: Vector, moves: bool, work: Vector, rows: Vector
    ) -> int:
        """Add the constraints of corners on a rigid base: there are none here."""
        return count

    @inlined
    def half_bandwidth(self) -> int:
        """Return the half-width of the band of the matrix: those farther apart share no body."""
        return 1

    @inlined
    def complete_solution(self, work: Vector, out: Vector) -> None:
        """Set the accelerations of bodies in full contact with a rigid base to zero: none here."""

    @kernel
    def add_sliding_constraint(
        self, k: int, which: int, body_mode: Mode, state: Vector, work: Vector, rows: Vector
    ) -> None:
        """Add the constraint that keeps a sliding end at its base, :eq:`eq-sliding-contact`."""
        i, part, body = k * BODY_STRIDE, self.on_base(k), self.state_of(k, state)
        a = i + at.ATTITUDE
        attitude = Attitude(work[a], work[a + 1], work[a + 2])
        line = part.body.base_line(body, attitude)
        left = part.base.is_held(body_mode.contact, True)
        on_left, on_right = part.body.end_accelerations(attitude, body.angular_velocity, 0.0, 0.0)
        bend, speed = (on_left, line.left_speed) if left else (on_right, line.right_speed)
        lever = line.left_lever if left else line.right_lever
        sinking = bend + part.base.following_rate() * speed
        prescribed = -normal_coriolis(i, work) - sinking
        add_constraint(self, which, k, 0.0, 1.0, lever, prescribed, work, rows)
        direction = which * CONSTRAINT_STRIDE + at.FORCE_DIRECTION
        write_jacobian(self, k, 1.0, 0.0, -work[i + at.PIVOT_ARM], direction, work, rows)
        rows[which * CONSTRAINT_STRIDE + at.UNSYMMETRIC] = 1.0

    @kernel
    def solve(self, moving: int, count: int, work: Vector) -> None:
        """Solve for the forces of constraints, and the accelerations of bodies and coordinates."""
        rows = self.constraints()
        reset_elimination(self, work)
        band, matrix = self.half_bandwidth(), self.constraint_matrix()
        solve_motion(self, moving, 0, count, band, work, rows, matrix)
        for which in range(count):  # the last constraint of a body is the one along its base
            first = which * CONSTRAINT_STRIDE
            i = int(rows[first + at.CONSTRAINED_BODY]) * BODY_STRIDE
            work[i + at.TANGENTIAL_FORCE] = rows[first + at.FORCE]
        write_relative_accelerations(self, work, self.slopes())
        self.complete_solution(work, self.slopes())

    @kernel
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> Vector:
        """Return the accelerations of all coordinates, then the powers dissipated and supplied."""
        return self.accelerate_bodies(self.body_count, mode, state, ground)

    @kernel
    def find_forces(self, mode: int, state: Vector, ground: Ground) -> Vector:
        """Return what `accelerate` does, with forces of all bodies and the inputs they are for."""
        slope = self.accelerate_bodies(self.body_count, mode, state, ground)
        note = self.solved_inputs()
        note[0], note[2], note[3] = mode >> HALF_OF_BITS, ground.x, ground.y
        note[1] = mode - (mode >> HALF_OF_BITS << HALF_OF_BITS)
        for i in range(2 * self.coordinates()):
            note[INPUTS_BEFORE_STATE + i] = state[i]
        self.workspace()[(self.body_count - 1) * BODY_STRIDE + at.FORCES_VALID] = 1.0
        return slope

    @kernel
    def forces_are_valid(self, mode: int, state: Vector, ground: Ground) -> bool:
        """Whether the forces in the workspace are those of this mode, state and ground."""
        note, solved = self.solved_inputs(), (self.body_count - 1) * BODY_STRIDE + at.FORCES_VALID
        # variables of links are not noted
        valid = (self.workspace()[solved] != 0.0) & (self.variables() == 0)
        high = mode >> HALF_OF_BITS
        valid &= (note[0] == high) & (note[1] == mode - (high << HALF_OF_BITS))
        valid &= (note[2] == ground.x) & (note[3] == ground.y)
        for i in range(2 * self.coordinates()):
            valid &= note[INPUTS_BEFORE_STATE + i] == state[i]
        return bool(valid)

    @kernel
    def accelerate_bodies(self, moving: int, mode: int, state: Vector, ground: Ground) -> Vector:
        """Return accelerations and powers; bodies from number `moving` on rest on the ground."""
        work, out = self.workspace(), self.slopes()
        write_kinematics(self, mode, state, work)
        set_inertia_loads(self, ground.x, self.row_value(0, at.GRAVITY) + ground.y, work)
        dissipated = supplied = 0.0
        for k in range(self.body_count):
            i, mass = k * BODY_STRIDE, self.row_value(k, at.MASS)
            part, body = self.on_base(k), self.state_of(k, state)
            a = i + at.ATTITUDE
            line = part.body.base_line(body, Attitude(work[a], work[a + 1], work[a + 2]))
            base = part.base.force(self.contact_with_force(k, mode), line, ())
            dissipated += base.dissipated
            work[i + at.NORMAL_FORCE] = base.upward
            add_base_load(self, k, base.upward, base.moment, work)
            self.apply_friction_load(k, mode, work)
            supplied -= mass * (ground.x * work[i + at.SPEED_X] + ground.y * work[i + at.SPEED_Y])
        dissipated += self.apply_link_forces(mode, state, work)
        self.solve(moving, self.write_constraints(moving, mode, state, work), work)
        for k in range(self.body_count):
            i = k * BODY_STRIDE
            if self.body_mode(mode, k).slides:
                about = work[i + at.PIVOT_ARM] * work[i + at.ROTATION_RATE]
                slip = work[i + at.TANGENTIAL_RATE] - about
                dissipated -= work[i + at.TANGENTIAL_FORCE] * slip
        powers = BODY_DOF * self.body_count + self.variables()
        out[powers], out[powers + 1] = dissipated, supplied
        return out

    @kernel
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Return power dissipated, of the slope, and that of the ground at the state's rates."""
        dissipated = slope[BODY_DOF * self.body_count + self.variables()]
        return dissipated, input_power(self, state, ground, self.workspace())

    @inlined
    def contact_with_force(self, k: int, mode: int) -> int:
        """Return the contact by which the force of a body's base is computed."""
        body_mode = self.body_mode(mode, k)
        if self.is_slippery(k):  # its base presses whether the body slips or not
            return body_mode.contact
        return self.on_base(k).contact_with_force(body_mode)

    @inlined
    def apply_link_forces(self, mode: int, state: Vector, work: Vector) -> float:
        """Load bodies by their links; return the power these dissipate: there are none here."""
        return 0.0

    @inlined
    def resultant_of_links(self, k: int) -> tuple[float, float]:
        """Return the last resultant of links on a body, right and up: there are none here."""
        return 0.0, 0.0

    @kernel
    def forces_from_slope(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> None:
        """Write the bodies' accelerations and the forces at their bases, from a slope.

        The slope has no horizontal acceleration of a lowest body that is held: it follows from its
        rotation.
        """
        work = self.workspace()
        write_kinematics(self, mode, state, work)
        self.apply_link_forces(mode, state, work)
        x = y = angular = 0.0
        for k in range(self.body_count - 1, -1, -1):
            i, first = k * BODY_STRIDE, BEFORE_HORIZONTAL * k
            along = slope[self.horizontal_of(k)]
            if work[i + at.HOLD_STATE] != FREE:
                along = work[i + at.PIVOT_ARM] * slope[first + ROTATION]
                along += work[i + at.PIVOT_CENTRIPETAL]
            along += tangential_coriolis(i, work) + work[i + at.NORMAL] * angular
            normal = slope[first + VERTICAL] - normal_coriolis(i, work)
            normal -= work[i + at.TANGENTIAL] * angular
            sine, cosine = work[i + at.SINE], work[i + at.COSINE]
            x, y = x + along * cosine + normal * sine, y - along * sine + normal * cosine
            angular += slope[first + ROTATION]
            work[i + at.ACCELERATION_X], work[i + at.ACCELERATION_Y] = x, y
            work[i + at.ANGULAR_ACCELERATION] = angular
        force_x = force_y = 0.0
        for k in range(self.body_count):
            i, mass = k * BODY_STRIDE, self.row_value(k, at.MASS)
            links_x, links_y = self.resultant_of_links(k)
            force_x += mass * (work[i + at.ACCELERATION_X] + ground.x) - links_x
            vertical = work[i + at.ACCELERATION_Y] + self.row_value(k, at.GRAVITY) + ground.y
            force_y += mass * vertical
            force_y -= links_y
            sine, cosine = work[i + at.SINE], work[i + at.COSINE]
            work[i + at.TANGENTIAL_FORCE] = cosine * force_x - sine * force_y
            work[i + at.NORMAL_FORCE] = sine * force_x + cosine * force_y

    @kernel
    def energies_of_bodies(self, mode: int, state: Vector) -> Energies:
        """Return energies of all bodies and bases; leaves the bodies' places in the workspace."""
        work = self.workspace()
        write_kinematics(self, mode, state, work)
        kinetic = gravity = elastic = change = rise = rate = 0.0
        for k in range(self.body_count - 1, -1, -1):
            i, mass = k * BODY_STRIDE, self.row_value(k, at.MASS)
            body = self.constrained_state(k, self.body_mode(mode, k), state)
            x, y = work[i + at.SPEED_X], work[i + at.SPEED_Y]
            rate += body.angular_velocity
            kinetic += 0.5 * (mass * (x * x + y * y) + self.row_value(k, at.INERTIA) * rate * rate)
            rise = self.rise_of(k, rise, body.vertical, work)
            gravity += mass * self.row_value(k, at.GRAVITY) * rise
            stored, more = self.on_base(k).elastic_energy(body, ())
            elastic += stored
            change += more
        return Energies(kinetic, gravity, elastic, change)

    energies = energies_of_bodies  # of systems with links: of these, too

    @inlined
    def rise_of(self, k: int, below: float, vertical: float, work: Vector) -> float:
        """Return rise of a centre of mass, from that of the body below, without cancellation."""
        i = k * BODY_STRIDE
        sine, cosine = work[i + at.SINE], work[i + at.COSINE]
        fixed = work[i + at.NORMAL] - vertical if k + 1 < self.body_count else 0.0
        return (
            below
            + vertical * cosine
            - work[i + at.TANGENTIAL] * sine
            - fixed * versine(sine, cosine)
        )

    @kernel
    def centre_position(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return the place of a body's centre of mass along the body below, or along the ground."""
        if k + 1 < self.body_count:
            return state[self.horizontal_of(k)]
        body_mode, body = self.body_mode(mode, k), self.state_of(k, state)
        return self.on_base(k).horizontal_position(body_mode, body, memory[HELD_PLACE + k])

    @kernel
    def response(
        self, k: int, mode: int, impulse: float, moment: float, slip: float, state: Vector
    ) -> VelocityChange:
        """Return the changes of velocities by an impulse of a base, or by a hold that stops a slip.

        The changes of all velocities are in `slopes` until the next solution.
        """
        work, out = self.workspace(), self.slopes()
        write_kinematics(self, mode, state, work)
        set_inertia_loads(self, 0.0, 0.0, work)
        add_base_load(self, k, impulse, moment, work)
        self.solve_response(k, mode, slip, state)
        first = BEFORE_HORIZONTAL * k
        thrust = work[k * BODY_STRIDE + at.TANGENTIAL_FORCE]
        return VelocityChange(out[first + ROTATION], out[first + VERTICAL], thrust, ())

    @kernel
    def solve_response(self, k: int, mode: int, slip: float, state: Vector) -> None:
        """Solve for changes of velocities by impulses in the loads, or a hold that stops `slip`."""
        work, rows, count = self.workspace(), self.constraints(), 0
        for j in range(self.body_count):
            i = j * BODY_STRIDE
            work[i + at.NORMAL_RATE] = work[i + at.TANGENTIAL_RATE] = 0.0
            work[i + at.FRAME_ROTATION_RATE] = 0.0
            count = self.add_corner_constraints(j, count, mode, state, False, work, rows)
            if work[i + at.HOLD_STATE] != FREE:
                prescribed = -slip if j == k else 0.0
                arm = work[i + at.PIVOT_ARM]
                add_constraint(self, count, j, 1.0, 0.0, -arm, prescribed, work, rows)
                count += 1
            else:
                work[i + at.TANGENTIAL_FORCE] = 0.0
        self.solve(self.body_count, count, work)

    @kernel
    def respond(self, k: int, mode: int, response: VelocityChange, state: Vector) -> None:
        """Change the velocities by the last response."""
        self.apply_response(state)

    @inlined
    def add_velocity_changes(self, state: Vector) -> None:
        """Add the changes in `slopes` to the velocities; held points remain held exactly."""
        out, work, n = self.slopes(), self.workspace(), self.coordinates()
        for i in range(n):
            state[n + i] += out[i]
        for j in range(self.body_count):
            if work[j * BODY_STRIDE + at.HOLD_STATE] != FREE:
                arm = work[j * BODY_STRIDE + at.PIVOT_ARM]
                rate = state[n + BEFORE_HORIZONTAL * j + ROTATION]
                state[n + self.horizontal_of(j)] = arm * rate

    apply_response = add_velocity_changes  # with rigid bases, their impulses are added up, too

    @kernel
    def velocities(self, state: Vector) -> Vector:
        """Return a copy of all velocities, which the next call overwrites."""
        out, n = self.velocity_workspace(), self.coordinates()
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
