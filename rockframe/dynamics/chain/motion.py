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
from rockframe.dynamics.chain.rows import CONSTRAINT, MOST_CONSTRAINTS, PLACES, Rows
from rockframe.dynamics.protocol import Ground
from rockframe.dynamics.trigonometry import sine_cosine

FREE: Final = 0.0  # in the column HELD of the workspace
HELD: Final = 1.0
UNKNOWN: Final = -1.0
"""Code of a trial for a body whose constraints have not been eliminated."""


@inlined
def forget_trial(system: Rows, room: Vector) -> None:
    """Discard what was eliminated: the next solution starts from the beginning."""
    i = (system.body_count - 1) * PLACES
    room[i + at.TRIED], room[i + at.SOLVED] = UNKNOWN, 0.0


@kernel
def place_bodies(system: Rows, mode: int, state: Vector, room: Vector) -> None:
    """Write places and rates of all bodies relative to what they stand on, and velocities."""
    forget_trial(system, room)
    count, angle, rate, speed_x, speed_y = system.body_count, 0.0, 0.0, 0.0, 0.0
    below = 0.0  # top of the body below above its centre of mass
    sine, cosine = 0.0, 1.0
    for k in range(count - 1, -1, -1):
        i = k * PLACES
        part, standing = system.on_base(k), system.body_mode(mode, k)
        body = system.standing_state(k, standing, state)
        attitude = part.body.attitude(body.rotation)
        reach = part.body.reach(part.body.pin(standing.pivot), attitude)
        free = part.is_free(standing)
        room[i + at.ATTITUDE], room[i + at.ATTITUDE + 1] = attitude.sine, attitude.cosine
        room[i + at.ATTITUDE + 2] = attitude.rise
        sway = body.horizontal_velocity if free else reach.derivative * body.angular_velocity
        lowest = k == count - 1
        across = 0.0 if lowest else body.horizontal
        arm = 0.0 if lowest else below + part.body.height + body.vertical
        along, normal = sway + arm * rate, body.vertical_velocity - across * rate
        speed_x = speed_x + along * cosine + normal * sine
        speed_y = speed_y - along * sine + normal * cosine
        room[i + at.SINE], room[i + at.COSINE] = sine, cosine
        room[i + at.ACROSS], room[i + at.ARM] = across, arm
        room[i + at.SWAY], room[i + at.RISE] = sway, body.vertical_velocity
        room[i + at.REACH] = reach.derivative
        room[i + at.FRAME_RATE], room[i + at.RATE] = rate, body.angular_velocity
        room[i + at.HELD] = FREE if free else HELD
        room[i + at.DRIFT] = reach.second_derivative * body.angular_velocity * body.angular_velocity
        room[i + at.SPEED_X], room[i + at.SPEED_Y] = speed_x, speed_y
        angle += body.rotation
        if lowest and not part.body.small:
            sine, cosine = attitude.sine, attitude.cosine
        elif k > 0:
            sine, cosine = sine_cosine(angle)
        rate += body.angular_velocity
        below = system.number(k, at.TOP)


@kernel
def input_power(system: Rows, state: Vector, ground: Ground, room: Vector) -> float:
    """Return the power of the ground at the rates of a state, for the places in the workspace."""
    count, supplied, rate, speed_x, speed_y = system.body_count, 0.0, 0.0, 0.0, 0.0
    for k in range(count - 1, -1, -1):
        i, mass, body = k * PLACES, system.number(k, at.MASS), system.state_of(k, state)
        sine, cosine = room[i + at.SINE], room[i + at.COSINE]
        sway = body.horizontal_velocity
        if room[i + at.HELD] != FREE:
            sway = room[i + at.REACH] * body.angular_velocity
        along = sway + room[i + at.ARM] * rate
        normal = body.vertical_velocity - room[i + at.ACROSS] * rate
        speed_x += along * cosine + normal * sine
        speed_y += normal * cosine - along * sine
        supplied -= mass * (ground.x * speed_x + ground.y * speed_y)
        rate += body.angular_velocity
    return supplied


@inlined
def load_bodies(system: Rows, x: float, y: float, room: Vector) -> None:
    """Set the loads of all bodies to the inertia forces of an acceleration of the ground."""
    forget_trial(system, room)
    for k in range(system.body_count):
        i, mass = k * PLACES, system.number(k, at.MASS)
        room[i + at.LOAD_X], room[i + at.LOAD_Y] = -mass * x, -mass * y
        room[i + at.LOAD_MOMENT] = room[i + at.DRAG] = 0.0


@inlined
def press_at(system: Rows, k: int, press: float, moment: float, room: Vector) -> None:
    """Add normal force and moment of a base to the loads of its body, and the reaction below."""
    forget_trial(system, room)
    i = k * PLACES
    sine, cosine = room[i + at.SINE], room[i + at.COSINE]
    room[i + at.LOAD_X] += press * sine
    room[i + at.LOAD_Y] += press * cosine
    room[i + at.LOAD_MOMENT] += moment
    if k + 1 < system.body_count:
        j = i + PLACES
        room[j + at.LOAD_X] -= press * sine
        room[j + at.LOAD_Y] -= press * cosine
        room[j + at.LOAD_MOMENT] += room[i + at.ACROSS] * press - moment


@inlined
def load_along(system: Rows, k: int, thrust: float, room: Vector) -> None:
    """Add a force along a base at the slipping point of its body, and the reaction below."""
    forget_trial(system, room)
    i = k * PLACES
    x, y = thrust * room[i + at.COSINE], -thrust * room[i + at.SINE]
    room[i + at.LOAD_X] += x
    room[i + at.LOAD_Y] += y
    room[i + at.LOAD_MOMENT] -= thrust * room[i + at.REACH]
    if k + 1 < system.body_count:
        j = i + PLACES
        room[j + at.LOAD_X] -= x
        room[j + at.LOAD_Y] -= y
        room[j + at.LOAD_MOMENT] += thrust * (room[i + at.REACH] - room[i + at.ARM])


@inlined
def coriolis_along(i: int, room: Vector) -> float:
    """Return the Coriolis and centripetal acceleration, from the body below, along the frame."""
    rate = room[i + at.FRAME_RATE]
    return 2.0 * room[i + at.RISE] * rate - room[i + at.ACROSS] * rate * rate


@inlined
def coriolis_normal(i: int, room: Vector) -> float:
    """Return the Coriolis and centripetal acceleration along the inward normal of the frame."""
    rate = room[i + at.FRAME_RATE]
    return (2.0 * room[i + at.SWAY] + room[i + at.ARM] * rate) * rate


@kernel
def write_direction(
    system: Rows, k: int, along: float, normal: float, rotation: float, first: int, room: Vector,
    rows: Vector,
) -> None:  # fmt: skip
    """Write a combination of a body's relative accelerations by weights in the axes of the ground.

    Those of the body, then of the one below: also its components as a generalized force on both.
    """
    i = k * PLACES
    sine, cosine = room[i + at.SINE], room[i + at.COSINE]
    x, y = along * cosine + normal * sine, normal * cosine - along * sine
    rows[first], rows[first + 1], rows[first + 2] = x, y, rotation
    if k + 1 < system.body_count:
        turning = normal * room[i + at.ACROSS] - along * room[i + at.ARM] - rotation
        rows[first + 3], rows[first + 4], rows[first + 5] = -x, -y, turning


@kernel
def write_relative(system: Rows, room: Vector, out: Vector) -> None:
    """Write the accelerations of all coordinates by :eq:`eq-chain-kinematics`."""
    for k in range(system.body_count):
        i, first = k * PLACES, BEFORE_HORIZONTAL * k
        sine, cosine = room[i + at.SINE], room[i + at.COSINE]
        x, y, turning, below = room[i + at.X], room[i + at.Y], room[i + at.ROTATION], 0.0
        if k + 1 < system.body_count:
            j = i + PLACES
            x, y, below = x - room[j + at.X], y - room[j + at.Y], room[j + at.ROTATION]
        along = cosine * x - sine * y - room[i + at.ARM] * below
        normal = sine * x + cosine * y + room[i + at.ACROSS] * below
        out[first + ROTATION] = turning - below
        out[first + VERTICAL] = normal + coriolis_normal(i, room)
        out[system.horizontal_of(k)] = along - coriolis_along(i, room)


@inlined
def add_constraint(
    system: Rows, which: int, k: int, along: float, normal: float, rotation: float, wanted: float,
    room: Vector, rows: Vector,
) -> None:  # fmt: skip
    """Add a constraint on a combination of accelerations, with a force in its direction."""
    first = which * CONSTRAINT
    rows[first + at.BODY], rows[first + at.VALUE] = k, wanted
    write_direction(system, k, along, normal, rotation, first + at.KEEPS, room, rows)
    for i in range(6):
        rows[first + at.HOLDS + i] = rows[first + at.KEEPS + i]
    rows[first + at.UNSYMMETRIC] = 0.0


@inlined
def of_both(moving: int, k: int, direction: int, room: Vector, rows: Vector) -> float:
    """Return a combination of the accelerations of a body and, if it moves, of the one below."""
    i = k * PLACES
    found = (
        rows[direction] * room[i + at.X]
        + rows[direction + 1] * room[i + at.Y]
        + rows[direction + 2] * room[i + at.ROTATION]
    )
    if k + 1 < moving:
        j = i + PLACES
        found += (
            rows[direction + 3] * room[j + at.X]
            + rows[direction + 4] * room[j + at.Y]
            + rows[direction + 5] * room[j + at.ROTATION]
        )
    return found


@inlined
def through(system: Rows, k: int, one: int, other: int, rows: Vector) -> float:
    """Return the product of two directions of one body over its mass and inertia."""
    per_mass, per_inertia = system.number(k, at.PER_MASS), system.number(k, at.PER_INERTIA)
    moved = rows[one] * rows[other] + rows[one + 1] * rows[other + 1]
    return per_mass * moved + per_inertia * rows[one + 2] * rows[other + 2]


@inlined
def answer(system: Rows, moving: int, kept: int, force: int, rows: Vector) -> float:
    """Return response of constraint `kept` to a unit force of `force`: an entry of the matrix."""
    a, b = kept * CONSTRAINT, force * CONSTRAINT
    one, other = int(rows[a + at.BODY]), int(rows[b + at.BODY])
    keeps, holds, found = a + at.KEEPS, b + at.HOLDS, 0.0
    if one == other:
        found = through(system, one, keeps, holds, rows)
        if one + 1 < moving:
            found += through(system, one + 1, keeps + 3, holds + 3, rows)
    elif one == other + 1:
        found = through(system, one, keeps, holds + 3, rows)
    elif one + 1 == other:
        found = through(system, other, keeps + 3, holds, rows)
    return found


@inlined
def push(system: Rows, moving: int, which: int, room: Vector, rows: Vector) -> None:
    """Add the accelerations that a constraint's force causes."""
    first = which * CONSTRAINT
    k, force, holds = int(rows[first + at.BODY]), rows[first + at.FORCE], first + at.HOLDS
    for body in range(k, min(k + 2, moving)):
        i, per_mass = body * PLACES, force * system.number(body, at.PER_MASS)
        room[i + at.X] += rows[holds] * per_mass
        room[i + at.Y] += rows[holds + 1] * per_mass
        room[i + at.ROTATION] += rows[holds + 2] * force * system.number(body, at.PER_INERTIA)
        holds += 3


@inlined
def eliminate(system: Rows, moving: int, r: int, band: int, rows: Vector, matrix: Vector) -> None:
    """Eliminate one more constraint behind those that have been eliminated.

    The matrix holds the factors below its diagonal, the inverses of the pivots on it.
    """
    stride, low, first = MOST_CONSTRAINTS * system.body_count, max(0, r - band), r * CONSTRAINT
    own, left = answer(system, moving, r, r, rows), rows[first + at.LEFT]
    unsymmetric = rows[first + at.UNSYMMETRIC] != 0.0
    if r > 0 and rows[first - CONSTRAINT + at.UNSYMMETRIC] != 0.0:
        unsymmetric, rows[first + at.UNSYMMETRIC] = True, 1.0
    for c in range(low, r):
        above = answer(system, moving, c, r, rows)
        for i in range(low, c):
            above -= matrix[c * stride + i] * matrix[i * stride + r]
        factor = above
        if unsymmetric:
            factor = answer(system, moving, r, c, rows)
            for i in range(low, c):
                factor -= matrix[r * stride + i] * matrix[i * stride + c]
        factor *= matrix[c * stride + c]
        matrix[c * stride + r], matrix[r * stride + c] = above, factor
        own -= factor * above
        left -= factor * rows[c * CONSTRAINT + at.LEFT]
    matrix[r * stride + r], rows[first + at.LEFT] = 1.0 / own, left


@kernel
def solve_motion(
    system: Rows, moving: int, start: int, count: int, band: int, room: Vector, rows: Vector,
    matrix: Vector,
) -> None:  # fmt: skip
    """Write the forces of `count` constraints, sorted by body, and the accelerations of all bodies.

    Equation :eq:`eq-chain-solution`.

    Elimination in the band about the diagonal, whose pivots are never zero. Constraints before
    `start` have been eliminated in the last call. Bodies from number `moving` on rest on the
    ground, and have no constraints here.
    """
    for k in range(system.body_count):
        i = k * PLACES
        if k >= moving:
            room[i + at.X] = room[i + at.Y] = room[i + at.ROTATION] = 0.0
            continue
        per_mass = system.number(k, at.PER_MASS)
        room[i + at.X] = room[i + at.LOAD_X] * per_mass
        room[i + at.Y] = room[i + at.LOAD_Y] * per_mass
        room[i + at.ROTATION] = room[i + at.LOAD_MOMENT] * system.number(k, at.PER_INERTIA)
    for r in range(start, count):
        first = r * CONSTRAINT
        kept = of_both(moving, int(rows[first + at.BODY]), first + at.KEEPS, room, rows)
        rows[first + at.LEFT] = rows[first + at.VALUE] - kept
        eliminate(system, moving, r, band, rows, matrix)
    stride = MOST_CONSTRAINTS * system.body_count
    for r in range(count - 1, -1, -1):
        force = rows[r * CONSTRAINT + at.LEFT]
        for c in range(min(count, r + band + 1) - 1, r, -1):  # the force found last comes last
            force -= matrix[r * stride + c] * rows[c * CONSTRAINT + at.FORCE]
        rows[r * CONSTRAINT + at.FORCE] = force * matrix[r * stride + r]
    for r in range(count):
        push(system, moving, r, room, rows)
