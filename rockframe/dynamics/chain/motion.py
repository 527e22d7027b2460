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

FREE: Final = 0.0  # in the column HELD of the workspace
HELD: Final = 1.0
NOT_ELIMINATED: Final = -1.0
"""Code of a trial for a body whose constraints have not been eliminated."""


@inlined
def reset_elimination(system: ChainArray, workspace: Vector) -> None:
    """Discard what was eliminated: the next solution starts from the beginning."""
    i = (system.body_count - 1) * BODY_STRIDE
    workspace[i + at.TRIAL_CODE], workspace[i + at.FORCES_VALID] = NOT_ELIMINATED, 0.0


@kernel
def write_kinematics(system: ChainArray, mode: int, state: Vector, workspace: Vector) -> None:
    """Write places and rates of all bodies relative to what they stand on, and velocities."""
    reset_elimination(system, workspace)
    count, angle, rate, speed_x, speed_y = system.body_count, 0.0, 0.0, 0.0, 0.0
    below = 0.0  # top of the body below above its centre of mass
    sine, cosine = 0.0, 1.0
    for k in range(count - 1, -1, -1):
        i = k * BODY_STRIDE
        part, standing = system.on_base(k), system.part_mode(mode, k)
        body = system.constrained_state(k, standing, state)
        attitude = part.body.attitude(body.rotation)
        reach = part.body.reach(part.body.pin(standing.pivot), attitude)
        free = part.is_free(standing)
        workspace[i + at.ATTITUDE], workspace[i + at.ATTITUDE + 1] = attitude.sine, attitude.cosine
        workspace[i + at.ATTITUDE + 2] = attitude.rise
        sway = body.horizontal_velocity if free else reach.rate * body.angular_velocity
        lowest = k == count - 1
        across = 0.0 if lowest else body.horizontal
        arm = 0.0 if lowest else below + part.body.height + body.vertical
        along, normal = sway + arm * rate, body.vertical_velocity - across * rate
        speed_x = speed_x + along * cosine + normal * sine
        speed_y = speed_y - along * sine + normal * cosine
        workspace[i + at.SINE], workspace[i + at.COSINE] = sine, cosine
        workspace[i + at.TANGENTIAL], workspace[i + at.NORMAL] = across, arm
        workspace[i + at.TANGENTIAL_RATE], workspace[i + at.NORMAL_RATE] = (
            sway,
            body.vertical_velocity,
        )
        workspace[i + at.PIVOT_ARM] = reach.rate
        workspace[i + at.FRAME_ROTATION_RATE], workspace[i + at.ROTATION_RATE] = (
            rate,
            body.angular_velocity,
        )
        workspace[i + at.HOLD_STATE] = FREE if free else HELD
        workspace[i + at.PIVOT_CENTRIPETAL] = (
            reach.bend * body.angular_velocity * body.angular_velocity
        )
        workspace[i + at.SPEED_X], workspace[i + at.SPEED_Y] = speed_x, speed_y
        angle += body.rotation
        if lowest and not part.body.small:
            sine, cosine = attitude.sine, attitude.cosine
        elif k > 0:
            sine, cosine = sine_cosine(angle)
        rate += body.angular_velocity
        below = system.row_value(k, at.TOP)


@kernel
def input_power(system: ChainArray, state: Vector, ground: Ground, workspace: Vector) -> float:
    """Return the power of the ground at the rates of a state, for the places in the workspace."""
    count, supplied, rate, speed_x, speed_y = system.body_count, 0.0, 0.0, 0.0, 0.0
    for k in range(count - 1, -1, -1):
        i, mass, body = k * BODY_STRIDE, system.row_value(k, at.MASS), system.state_of(k, state)
        sine, cosine = workspace[i + at.SINE], workspace[i + at.COSINE]
        sway = body.horizontal_velocity
        if workspace[i + at.HOLD_STATE] != FREE:
            sway = workspace[i + at.PIVOT_ARM] * body.angular_velocity
        along = sway + workspace[i + at.NORMAL] * rate
        normal = body.vertical_velocity - workspace[i + at.TANGENTIAL] * rate
        speed_x += along * cosine + normal * sine
        speed_y += normal * cosine - along * sine
        supplied -= mass * (ground.x * speed_x + ground.y * speed_y)
        rate += body.angular_velocity
    return supplied


@inlined
def set_inertia_loads(system: ChainArray, x: float, y: float, workspace: Vector) -> None:
    """Set the loads of all bodies to the inertia forces of an acceleration of the ground."""
    reset_elimination(system, workspace)
    for k in range(system.body_count):
        i, mass = k * BODY_STRIDE, system.row_value(k, at.MASS)
        workspace[i + at.LOAD_X], workspace[i + at.LOAD_Y] = -mass * x, -mass * y
        workspace[i + at.LOAD_MOMENT] = workspace[i + at.FRICTION_LOAD] = 0.0


@inlined
def add_base_load(
    system: ChainArray, k: int, press: float, moment: float, workspace: Vector
) -> None:
    """Add normal force and moment of a base to the loads of its body, and the reaction below."""
    reset_elimination(system, workspace)
    i = k * BODY_STRIDE
    sine, cosine = workspace[i + at.SINE], workspace[i + at.COSINE]
    workspace[i + at.LOAD_X] += press * sine
    workspace[i + at.LOAD_Y] += press * cosine
    workspace[i + at.LOAD_MOMENT] += moment
    if k + 1 < system.body_count:
        j = i + BODY_STRIDE
        workspace[j + at.LOAD_X] -= press * sine
        workspace[j + at.LOAD_Y] -= press * cosine
        workspace[j + at.LOAD_MOMENT] += workspace[i + at.TANGENTIAL] * press - moment


@inlined
def add_tangential_load(system: ChainArray, k: int, thrust: float, workspace: Vector) -> None:
    """Add a force along a base at the slipping point of its body, and the reaction below."""
    reset_elimination(system, workspace)
    i = k * BODY_STRIDE
    x, y = thrust * workspace[i + at.COSINE], -thrust * workspace[i + at.SINE]
    workspace[i + at.LOAD_X] += x
    workspace[i + at.LOAD_Y] += y
    workspace[i + at.LOAD_MOMENT] -= thrust * workspace[i + at.PIVOT_ARM]
    if k + 1 < system.body_count:
        j = i + BODY_STRIDE
        workspace[j + at.LOAD_X] -= x
        workspace[j + at.LOAD_Y] -= y
        workspace[j + at.LOAD_MOMENT] += thrust * (
            workspace[i + at.PIVOT_ARM] - workspace[i + at.NORMAL]
        )


@inlined
def tangential_coriolis(i: int, workspace: Vector) -> float:
    """Return the Coriolis and centripetal acceleration, from the body below, along the frame."""
    rate = workspace[i + at.FRAME_ROTATION_RATE]
    return 2.0 * workspace[i + at.NORMAL_RATE] * rate - workspace[i + at.TANGENTIAL] * rate * rate


@inlined
def normal_coriolis(i: int, workspace: Vector) -> float:
    """Return the Coriolis and centripetal acceleration along the inward normal of the frame."""
    rate = workspace[i + at.FRAME_ROTATION_RATE]
    return (2.0 * workspace[i + at.TANGENTIAL_RATE] + workspace[i + at.NORMAL] * rate) * rate


@kernel
def write_jacobian(
    system: ChainArray, k: int, along: float, normal: float, rotation: float, first: int,
    workspace: Vector, constraints: Vector,
) -> None:  # fmt: skip
    """Write a combination of a body's relative accelerations by weights in the axes of the ground.

    Those of the body, then of the one below: also its components as a generalized force on both.
    """
    i = k * BODY_STRIDE
    sine, cosine = workspace[i + at.SINE], workspace[i + at.COSINE]
    x, y = along * cosine + normal * sine, normal * cosine - along * sine
    constraints[first], constraints[first + 1], constraints[first + 2] = x, y, rotation
    if k + 1 < system.body_count:
        turning = (
            normal * workspace[i + at.TANGENTIAL] - along * workspace[i + at.NORMAL] - rotation
        )
        constraints[first + 3], constraints[first + 4], constraints[first + 5] = -x, -y, turning


@kernel
def write_relative_accelerations(system: ChainArray, workspace: Vector, out: Vector) -> None:
    """Write the accelerations of all coordinates by :eq:`eq-chain-kinematics`."""
    for k in range(system.body_count):
        i, first = k * BODY_STRIDE, BEFORE_HORIZONTAL * k
        sine, cosine = workspace[i + at.SINE], workspace[i + at.COSINE]
        x, y, turning, below = (
            workspace[i + at.ACCELERATION_X],
            workspace[i + at.ACCELERATION_Y],
            workspace[i + at.ANGULAR_ACCELERATION],
            0.0,
        )
        if k + 1 < system.body_count:
            j = i + BODY_STRIDE
            x, y, below = (
                x - workspace[j + at.ACCELERATION_X],
                y - workspace[j + at.ACCELERATION_Y],
                workspace[j + at.ANGULAR_ACCELERATION],
            )
        along = cosine * x - sine * y - workspace[i + at.NORMAL] * below
        normal = sine * x + cosine * y + workspace[i + at.TANGENTIAL] * below
        out[first + ROTATION] = turning - below
        out[first + VERTICAL] = normal + normal_coriolis(i, workspace)
        out[system.horizontal_of(k)] = along - tangential_coriolis(i, workspace)


@inlined
def add_constraint(
    system: ChainArray, which: int, k: int, along: float, normal: float, rotation: float,
    prescribed: float, workspace: Vector, constraints: Vector,
) -> None:  # fmt: skip
    """Add a constraint on a combination of accelerations, with a force in its direction."""
    first = which * CONSTRAINT_STRIDE
    constraints[first + at.CONSTRAINED_BODY], constraints[first + at.PRESCRIBED] = k, prescribed
    write_jacobian(system, k, along, normal, rotation, first + at.JACOBIAN, workspace, constraints)
    for i in range(6):
        constraints[first + at.FORCE_DIRECTION + i] = constraints[first + at.JACOBIAN + i]
    constraints[first + at.UNSYMMETRIC] = 0.0


@inlined
def combined_acceleration(
    moving: int, k: int, direction: int, workspace: Vector, constraints: Vector
) -> float:
    """Return a combination of the accelerations of a body and, if it moves, of the one below."""
    i = k * BODY_STRIDE
    found = (
        constraints[direction] * workspace[i + at.ACCELERATION_X]
        + constraints[direction + 1] * workspace[i + at.ACCELERATION_Y]
        + constraints[direction + 2] * workspace[i + at.ANGULAR_ACCELERATION]
    )
    if k + 1 < moving:
        j = i + BODY_STRIDE
        found += (
            constraints[direction + 3] * workspace[j + at.ACCELERATION_X]
            + constraints[direction + 4] * workspace[j + at.ACCELERATION_Y]
            + constraints[direction + 5] * workspace[j + at.ANGULAR_ACCELERATION]
        )
    return found


@inlined
def inverse_mass_product(
    system: ChainArray, k: int, one: int, other: int, constraints: Vector
) -> float:
    """Return the product of two directions of one body over its mass and inertia."""
    per_mass, per_inertia = (
        system.row_value(k, at.INVERSE_MASS),
        system.row_value(k, at.INVERSE_INERTIA),
    )
    moved = constraints[one] * constraints[other] + constraints[one + 1] * constraints[other + 1]
    return per_mass * moved + per_inertia * constraints[one + 2] * constraints[other + 2]


@inlined
def matrix_entry(
    system: ChainArray, moving: int, kept: int, force: int, constraints: Vector
) -> float:
    """Return response of constraint `kept` to a unit force of `force`: an entry of the matrix."""
    a, b = kept * CONSTRAINT_STRIDE, force * CONSTRAINT_STRIDE
    one, other = (
        int(constraints[a + at.CONSTRAINED_BODY]),
        int(constraints[b + at.CONSTRAINED_BODY]),
    )
    keeps, holds, found = a + at.JACOBIAN, b + at.FORCE_DIRECTION, 0.0
    if one == other:
        found = inverse_mass_product(system, one, keeps, holds, constraints)
        if one + 1 < moving:
            found += inverse_mass_product(system, one + 1, keeps + 3, holds + 3, constraints)
    elif one == other + 1:
        found = inverse_mass_product(system, one, keeps, holds + 3, constraints)
    elif one + 1 == other:
        found = inverse_mass_product(system, other, keeps + 3, holds, constraints)
    return found


@inlined
def add_constraint_accelerations(
    system: ChainArray, moving: int, which: int, workspace: Vector, constraints: Vector
) -> None:
    """Add the accelerations that a constraint's force causes."""
    first = which * CONSTRAINT_STRIDE
    k, force, holds = (
        int(constraints[first + at.CONSTRAINED_BODY]),
        constraints[first + at.FORCE],
        first + at.FORCE_DIRECTION,
    )
    for body in range(k, min(k + 2, moving)):
        i, per_mass = body * BODY_STRIDE, force * system.row_value(body, at.INVERSE_MASS)
        workspace[i + at.ACCELERATION_X] += constraints[holds] * per_mass
        workspace[i + at.ACCELERATION_Y] += constraints[holds + 1] * per_mass
        workspace[i + at.ANGULAR_ACCELERATION] += (
            constraints[holds + 2] * force * system.row_value(body, at.INVERSE_INERTIA)
        )
        holds += 3


@inlined
def eliminate(
    system: ChainArray, moving: int, r: int, band: int, constraints: Vector, matrix: Vector
) -> None:
    """Eliminate one more constraint behind those that have been eliminated.

    The matrix holds the factors below its diagonal, the inverses of the pivots on it.
    """
    stride, low, first = (
        MAX_CONSTRAINTS * system.body_count,
        max(0, r - band),
        r * CONSTRAINT_STRIDE,
    )
    own, left = (
        matrix_entry(system, moving, r, r, constraints),
        constraints[first + at.RIGHT_HAND_SIDE],
    )
    unsymmetric = constraints[first + at.UNSYMMETRIC] != 0.0
    if r > 0 and constraints[first - CONSTRAINT_STRIDE + at.UNSYMMETRIC] != 0.0:
        unsymmetric, constraints[first + at.UNSYMMETRIC] = True, 1.0
    for c in range(low, r):
        above = matrix_entry(system, moving, c, r, constraints)
        for i in range(low, c):
            above -= matrix[c * stride + i] * matrix[i * stride + r]
        factor = above
        if unsymmetric:
            factor = matrix_entry(system, moving, r, c, constraints)
            for i in range(low, c):
                factor -= matrix[r * stride + i] * matrix[i * stride + c]
        factor *= matrix[c * stride + c]
        matrix[c * stride + r], matrix[r * stride + c] = above, factor
        own -= factor * above
        left -= factor * constraints[c * CONSTRAINT_STRIDE + at.RIGHT_HAND_SIDE]
    matrix[r * stride + r], constraints[first + at.RIGHT_HAND_SIDE] = 1.0 / own, left


@kernel
def solve_motion(
    system: ChainArray, moving: int, start: int, count: int, band: int, workspace: Vector,
    constraints: Vector, matrix: Vector,
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
            workspace[i + at.ACCELERATION_X] = workspace[i + at.ACCELERATION_Y] = workspace[
                i + at.ANGULAR_ACCELERATION
            ] = 0.0
            continue
        per_mass = system.row_value(k, at.INVERSE_MASS)
        workspace[i + at.ACCELERATION_X] = workspace[i + at.LOAD_X] * per_mass
        workspace[i + at.ACCELERATION_Y] = workspace[i + at.LOAD_Y] * per_mass
        workspace[i + at.ANGULAR_ACCELERATION] = workspace[i + at.LOAD_MOMENT] * system.row_value(
            k, at.INVERSE_INERTIA
        )
    for r in range(start, count):
        first = r * CONSTRAINT_STRIDE
        kept = combined_acceleration(
            moving,
            int(constraints[first + at.CONSTRAINED_BODY]),
            first + at.JACOBIAN,
            workspace,
            constraints,
        )
        constraints[first + at.RIGHT_HAND_SIDE] = constraints[first + at.PRESCRIBED] - kept
        eliminate(system, moving, r, band, constraints, matrix)
    stride = MAX_CONSTRAINTS * system.body_count
    for r in range(count - 1, -1, -1):
        force = constraints[r * CONSTRAINT_STRIDE + at.RIGHT_HAND_SIDE]
        for c in range(min(count, r + band + 1) - 1, r, -1):  # the force found last comes last
            force -= matrix[r * stride + c] * constraints[c * CONSTRAINT_STRIDE + at.FORCE]
        constraints[r * CONSTRAINT_STRIDE + at.FORCE] = force * matrix[r * stride + r]
    for r in range(count):
        add_constraint_accelerations(system, moving, r, workspace, constraints)
