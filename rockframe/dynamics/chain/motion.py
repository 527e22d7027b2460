"""Kinematics of a chain, and accelerations under loads and constraints, :eq:`eq-chain`.

Newton's and Euler's equations of each body in the axes of the ground, with one unknown force for
each constraint: of a held point, of a corner on a rigid surface, of an end that slides. A
constraint touches its own body and the one below, so that the cost grows with the number of bodies
alone. The same equations give changes of velocities under impulses.
"""

from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.rows import (
    BODY_STRIDE,
    CONSTRAINT_STRIDE,
    MAX_CONSTRAINTS,
    ChainArray,
)
from rockframe.dynamics.protocol import Ground
from rockframe.dynamics.trigonometry import sine_cosine

FREE: Final = 0.0  # values of HOLD_STATE in the workspace
HELD: Final = 1.0
NOT_ELIMINATED: Final = -1.0
"""Code of a trial for a body whose constraints have not been eliminated."""


@inlined
def reset_elimination(system: ChainArray, work: Vector) -> None:
    """Mark all constraints as not eliminated: the next solution starts from the beginning."""
    i = (system.body_count - 1) * BODY_STRIDE
    work[i + at.TRIAL_CODE], work[i + at.FORCES_VALID] = NOT_ELIMINATED, 0.0


@kernel
def write_kinematics(system: ChainArray, mode: int, state: Vector, work: Vector) -> None:
    """Write positions and rates of all bodies relative to what they stand on, and velocities."""
    reset_elimination(system, work)
    count, angle, rate, speed_x, speed_y = system.body_count, 0.0, 0.0, 0.0, 0.0
    below = 0.0  # top of the body below above its centre of mass
    sine, cosine = 0.0, 1.0
    for k in range(count - 1, -1, -1):
        i = k * BODY_STRIDE
        part, body_mode = system.on_base(k), system.body_mode(mode, k)
        body = system.constrained_state(k, body_mode, state)
        attitude = part.body.attitude(body.rotation)
        reach = part.body.reach(part.body.pin(body_mode.pivot), attitude)
        free = part.is_free(body_mode)
        work[i + at.ATTITUDE], work[i + at.ATTITUDE + 1] = attitude.sine, attitude.cosine
        work[i + at.ATTITUDE + 2] = attitude.rise
        sway = body.horizontal_velocity if free else reach.derivative * body.angular_velocity
        lowest = k == count - 1
        across = 0.0 if lowest else body.horizontal
        arm = 0.0 if lowest else below + part.body.height + body.vertical
        along, normal = sway + arm * rate, body.vertical_velocity - across * rate
        speed_x = speed_x + along * cosine + normal * sine
        speed_y = speed_y - along * sine + normal * cosine
        work[i + at.SINE], work[i + at.COSINE] = sine, cosine
        work[i + at.TANGENTIAL], work[i + at.NORMAL] = across, arm
        work[i + at.TANGENTIAL_RATE], work[i + at.NORMAL_RATE] = sway, body.vertical_velocity
        work[i + at.PIVOT_ARM] = reach.derivative
        work[i + at.FRAME_ROTATION_RATE], work[i + at.ROTATION_RATE] = rate, body.angular_velocity
        work[i + at.HOLD_STATE] = FREE if free else HELD
        work[i + at.PIVOT_CENTRIPETAL] = (
            reach.second_derivative * body.angular_velocity * body.angular_velocity
        )
        work[i + at.SPEED_X], work[i + at.SPEED_Y] = speed_x, speed_y
        angle += body.rotation
        if lowest and not part.body.small:
            sine, cosine = attitude.sine, attitude.cosine
        elif k > 0:
            sine, cosine = sine_cosine(angle)
        rate += body.angular_velocity
        below = system.row_value(k, at.TOP)


@kernel
def input_power(system: ChainArray, state: Vector, ground: Ground, work: Vector) -> float:
    """Return the power of the ground at the rates of a state, with `work` for its placement."""
    count, supplied, rate, speed_x, speed_y = system.body_count, 0.0, 0.0, 0.0, 0.0
    for k in range(count - 1, -1, -1):
        i, mass, body = k * BODY_STRIDE, system.row_value(k, at.MASS), system.state_of(k, state)
        sine, cosine = work[i + at.SINE], work[i + at.COSINE]
        sway = body.horizontal_velocity
        if work[i + at.HOLD_STATE] != FREE:
            sway = work[i + at.PIVOT_ARM] * body.angular_velocity
        along = sway + work[i + at.NORMAL] * rate
        normal = body.vertical_velocity - work[i + at.TANGENTIAL] * rate
        speed_x += along * cosine + normal * sine
        speed_y += normal * cosine - along * sine
        supplied -= mass * (ground.x * speed_x + ground.y * speed_y)
        rate += body.angular_velocity
    return supplied


@inlined
def set_inertia_loads(system: ChainArray, x: float, y: float, work: Vector) -> None:
    """Set the loads of all bodies to the inertia forces of an acceleration of the ground."""
    reset_elimination(system, work)
    for k in range(system.body_count):
        i, mass = k * BODY_STRIDE, system.row_value(k, at.MASS)
        work[i + at.LOAD_X], work[i + at.LOAD_Y] = -mass * x, -mass * y
        work[i + at.LOAD_MOMENT] = work[i + at.FRICTION_LOAD] = 0.0


@inlined
def add_base_load(system: ChainArray, k: int, press: float, moment: float, work: Vector) -> None:
    """Add normal force and moment of a base to the loads of its body, and the reaction below."""
    reset_elimination(system, work)
    i = k * BODY_STRIDE
    sine, cosine = work[i + at.SINE], work[i + at.COSINE]
    work[i + at.LOAD_X] += press * sine
    work[i + at.LOAD_Y] += press * cosine
    work[i + at.LOAD_MOMENT] += moment
    if k + 1 < system.body_count:
        j = i + BODY_STRIDE
        work[j + at.LOAD_X] -= press * sine
        work[j + at.LOAD_Y] -= press * cosine
        work[j + at.LOAD_MOMENT] += work[i + at.TANGENTIAL] * press - moment


@inlined
def add_tangential_load(system: ChainArray, k: int, thrust: float, work: Vector) -> None:
    """Add a force along a base at the slipping point of its body, and the reaction below."""
    reset_elimination(system, work)
    i = k * BODY_STRIDE
    x, y = thrust * work[i + at.COSINE], -thrust * work[i + at.SINE]
    work[i + at.LOAD_X] += x
    work[i + at.LOAD_Y] += y
    work[i + at.LOAD_MOMENT] -= thrust * work[i + at.PIVOT_ARM]
    if k + 1 < system.body_count:
        j = i + BODY_STRIDE
        work[j + at.LOAD_X] -= x
        work[j + at.LOAD_Y] -= y
        work[j + at.LOAD_MOMENT] += thrust * (work[i + at.PIVOT_ARM] - work[i + at.NORMAL])


@inlined
def tangential_coriolis(i: int, work: Vector) -> float:
    """Return the Coriolis and centripetal acceleration, from the body below, along the frame."""
    rate = work[i + at.FRAME_ROTATION_RATE]
    return 2.0 * work[i + at.NORMAL_RATE] * rate - work[i + at.TANGENTIAL] * rate * rate


@inlined
def normal_coriolis(i: int, work: Vector) -> float:
    """Return the Coriolis and centripetal acceleration along the inward normal of the frame."""
    rate = work[i + at.FRAME_ROTATION_RATE]
    return (2.0 * work[i + at.TANGENTIAL_RATE] + work[i + at.NORMAL] * rate) * rate


@kernel
def write_jacobian(
    system: ChainArray, k: int, along: float, normal: float, rotation: float, first: int,
    work: Vector, rows: Vector,
) -> None:  # fmt: skip
    """Write the weights of accelerations in a combination of a body's relative accelerations.

    In the axes of the ground, of the body, then of the one below. They are also the components
    of a generalized force on both.
    """
    i = k * BODY_STRIDE
    sine, cosine = work[i + at.SINE], work[i + at.COSINE]
    x, y = along * cosine + normal * sine, normal * cosine - along * sine
    rows[first], rows[first + 1], rows[first + 2] = x, y, rotation
    if k + 1 < system.body_count:
        angular = normal * work[i + at.TANGENTIAL] - along * work[i + at.NORMAL] - rotation
        rows[first + 3], rows[first + 4], rows[first + 5] = -x, -y, angular


@kernel
def write_relative_accelerations(system: ChainArray, work: Vector, out: Vector) -> None:
    """Write the accelerations of all coordinates by :eq:`eq-chain-kinematics`."""
    for k in range(system.body_count):
        i, first = k * BODY_STRIDE, BEFORE_HORIZONTAL * k
        sine, cosine = work[i + at.SINE], work[i + at.COSINE]
        x, y = work[i + at.ACCELERATION_X], work[i + at.ACCELERATION_Y]
        angular, below = work[i + at.ANGULAR_ACCELERATION], 0.0
        if k + 1 < system.body_count:
            j = i + BODY_STRIDE
            x, y = x - work[j + at.ACCELERATION_X], y - work[j + at.ACCELERATION_Y]
            below = work[j + at.ANGULAR_ACCELERATION]
        along = cosine * x - sine * y - work[i + at.NORMAL] * below
        normal = sine * x + cosine * y + work[i + at.TANGENTIAL] * below
        out[first + ROTATION] = angular - below
        out[first + VERTICAL] = normal + normal_coriolis(i, work)
        out[system.horizontal_of(k)] = along - tangential_coriolis(i, work)


@inlined
def add_constraint(
    system: ChainArray, which: int, k: int, along: float, normal: float, rotation: float,
    prescribed: float, work: Vector, rows: Vector,
) -> None:  # fmt: skip
    """Add a constraint on a combination of accelerations, with a force in its direction."""
    first = which * CONSTRAINT_STRIDE
    rows[first + at.CONSTRAINED_BODY], rows[first + at.PRESCRIBED] = k, prescribed
    write_jacobian(system, k, along, normal, rotation, first + at.JACOBIAN, work, rows)
    for i in range(6):
        rows[first + at.FORCE_DIRECTION + i] = rows[first + at.JACOBIAN + i]
    rows[first + at.UNSYMMETRIC] = 0.0


@inlined
def combined_acceleration(moving: int, k: int, direction: int, work: Vector, rows: Vector) -> float:
    """Return a combination of the accelerations of a body and, if it moves, of the one below."""
    i = k * BODY_STRIDE
    acceleration = (
        rows[direction] * work[i + at.ACCELERATION_X]
        + rows[direction + 1] * work[i + at.ACCELERATION_Y]
        + rows[direction + 2] * work[i + at.ANGULAR_ACCELERATION]
    )
    if k + 1 < moving:
        j = i + BODY_STRIDE
        acceleration += (
            rows[direction + 3] * work[j + at.ACCELERATION_X]
            + rows[direction + 4] * work[j + at.ACCELERATION_Y]
            + rows[direction + 5] * work[j + at.ANGULAR_ACCELERATION]
        )
    return acceleration


@inlined
def inverse_mass_product(
    system: ChainArray, k: int, first: int, second: int, rows: Vector
) -> float:
    """Return the product of two directions of one body over its mass and inertia."""
    per_mass = system.row_value(k, at.INVERSE_MASS)
    per_inertia = system.row_value(k, at.INVERSE_INERTIA)
    moved = rows[first] * rows[second] + rows[first + 1] * rows[second + 1]
    return per_mass * moved + per_inertia * rows[first + 2] * rows[second + 2]


@inlined
def matrix_entry(system: ChainArray, moving: int, row: int, column: int, rows: Vector) -> float:
    """Return the response of constraint `row` to a unit force of constraint `column`."""
    a, b = row * CONSTRAINT_STRIDE, column * CONSTRAINT_STRIDE
    row_body, column_body = int(rows[a + at.CONSTRAINED_BODY]), int(rows[b + at.CONSTRAINED_BODY])
    jacobian, direction, entry = a + at.JACOBIAN, b + at.FORCE_DIRECTION, 0.0
    if row_body == column_body:
        entry = inverse_mass_product(system, row_body, jacobian, direction, rows)
        if row_body + 1 < moving:
            entry += inverse_mass_product(system, row_body + 1, jacobian + 3, direction + 3, rows)
    elif row_body == column_body + 1:
        entry = inverse_mass_product(system, row_body, jacobian, direction + 3, rows)
    elif row_body + 1 == column_body:
        entry = inverse_mass_product(system, column_body, jacobian + 3, direction, rows)
    return entry


@inlined
def add_constraint_accelerations(
    system: ChainArray, moving: int, which: int, work: Vector, rows: Vector
) -> None:
    """Add the accelerations that a constraint's force causes."""
    first = which * CONSTRAINT_STRIDE
    k, force = int(rows[first + at.CONSTRAINED_BODY]), rows[first + at.FORCE]
    direction = first + at.FORCE_DIRECTION
    for body in range(k, min(k + 2, moving)):
        i, per_mass = body * BODY_STRIDE, force * system.row_value(body, at.INVERSE_MASS)
        per_inertia = system.row_value(body, at.INVERSE_INERTIA)
        work[i + at.ACCELERATION_X] += rows[direction] * per_mass
        work[i + at.ACCELERATION_Y] += rows[direction + 1] * per_mass
        work[i + at.ANGULAR_ACCELERATION] += rows[direction + 2] * force * per_inertia
        direction += 3


@inlined
def eliminate(
    system: ChainArray, moving: int, r: int, band: int, rows: Vector, matrix: Vector
) -> None:
    """Eliminate one more constraint behind those that have been eliminated.

    The matrix holds the factors below its diagonal, the inverses of the pivots on it.
    """
    stride, low = MAX_CONSTRAINTS * system.body_count, max(0, r - band)
    first = r * CONSTRAINT_STRIDE
    own, left = matrix_entry(system, moving, r, r, rows), rows[first + at.RIGHT_HAND_SIDE]
    unsymmetric = rows[first + at.UNSYMMETRIC] != 0.0
    if r > 0 and rows[first - CONSTRAINT_STRIDE + at.UNSYMMETRIC] != 0.0:
        unsymmetric, rows[first + at.UNSYMMETRIC] = True, 1.0
    for c in range(low, r):
        above = matrix_entry(system, moving, c, r, rows)
        for i in range(low, c):
            above -= matrix[c * stride + i] * matrix[i * stride + r]
        factor = above
        if unsymmetric:
            factor = matrix_entry(system, moving, r, c, rows)
            for i in range(low, c):
                factor -= matrix[r * stride + i] * matrix[i * stride + c]
        factor *= matrix[c * stride + c]
        matrix[c * stride + r], matrix[r * stride + c] = above, factor
        own -= factor * above
        left -= factor * rows[c * CONSTRAINT_STRIDE + at.RIGHT_HAND_SIDE]
    matrix[r * stride + r], rows[first + at.RIGHT_HAND_SIDE] = 1.0 / own, left


@kernel
def solve_motion(
    system: ChainArray, moving: int, start: int, count: int, band: int, work: Vector, rows: Vector,
    matrix: Vector,
) -> None:  # fmt: skip
    """Write the forces of `count` constraints, sorted by body, and the accelerations of all bodies.

    Equation :eq:`eq-chain-solution`.

    Elimination in the band about the diagonal, whose pivots are never zero. Constraints before
    `start` have been eliminated in the last call. Bodies from number `moving` on rest on the
    ground, and have no constraints here.
    """
    for k in range(system.body_count):
        i = k * BODY_STRIDE
        if k >= moving:
            work[i + at.ACCELERATION_X] = work[i + at.ACCELERATION_Y] = 0.0
            work[i + at.ANGULAR_ACCELERATION] = 0.0
            continue
        per_mass = system.row_value(k, at.INVERSE_MASS)
        per_inertia = system.row_value(k, at.INVERSE_INERTIA)
        work[i + at.ACCELERATION_X] = work[i + at.LOAD_X] * per_mass
        work[i + at.ACCELERATION_Y] = work[i + at.LOAD_Y] * per_mass
        work[i + at.ANGULAR_ACCELERATION] = work[i + at.LOAD_MOMENT] * per_inertia
    for r in range(start, count):
        first = r * CONSTRAINT_STRIDE
        body = int(rows[first + at.CONSTRAINED_BODY])
        free = combined_acceleration(moving, body, first + at.JACOBIAN, work, rows)
        rows[first + at.RIGHT_HAND_SIDE] = rows[first + at.PRESCRIBED] - free
        eliminate(system, moving, r, band, rows, matrix)
    stride = MAX_CONSTRAINTS * system.body_count
    for r in range(count - 1, -1, -1):
        force = rows[r * CONSTRAINT_STRIDE + at.RIGHT_HAND_SIDE]
        for c in range(
            min(count, r + band + 1) - 1, r, -1
        ):  # the force that was found last comes last
            force -= matrix[r * stride + c] * rows[c * CONSTRAINT_STRIDE + at.FORCE]
        rows[r * CONSTRAINT_STRIDE + at.FORCE] = force * matrix[r * stride + r]
    for r in range(count):
        add_constraint_accelerations(system, moving, r, work, rows)
