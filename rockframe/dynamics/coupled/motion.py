"""Kinematics of two bodies, one on the other, and their accelerations under forces.

Kinematics :eq:`eq-coupled-kinematics` and the solution of the equations of motion. The upper
body is called the block and the lower one the cap; all is per unit mass of the block.
"""

from typing import NamedTuple

from rockframe.compiled import inlined
from rockframe.dynamics.body import Attitude, Reach
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.stacked import Modes, States
from rockframe.dynamics.trigonometry import sine_cosine, versine


class Pair(NamedTuple):
    """The bodies and bases of a stack."""

    upper: BodyOnBase  # the block on its base, in the frame of the cap
    lower: BodyOnBase  # the cap on the ground
    cap_mass: float  # m_c/m; the cap's inertia is I_c/m
    top: float  # of the cap above its centre of mass [m]
    offset: float  # block's centre of mass to the right of the cap's, both upright [m]


class Configuration(NamedTuple):
    """Places of cap and block, and the derivatives of these by the rotations.

    The sine and cosine are those of the cap's frame. `cap_reach`: x_c' and x_c'', the cap's
    centre about the point that the ground holds; `block_reach`: xi' and xi'', the block's
    centre along the cap about the point that the cap holds. arm = top + h + r, along the
    cap's normal.
    """

    sine: float
    cosine: float
    cap_reach: Reach
    block_reach: Reach
    arm: float
    across: float  # xi
    block_free: bool
    cap_free: bool


class Forces(NamedTuple):
    """Forces, or impulses, of both bases, and generalised forces on the bodies' rotations."""

    normal: float  # of the cap on the block, along the cap's normal
    moment: float  # on the block's rotation
    soil: float  # of the ground on the cap, upwards
    soil_moment: float  # on the cap's rotation


class KnownTerms(NamedTuple):
    """Known accelerations in the equations of motion, other than forces.

    `cap_horizontal` and `block_along` are the parts of the cap's horizontal acceleration, and of
    the block's along the cap, that do not depend on the unknowns; loads are those on the cap, per
    unit of its mass.
    """

    cap_horizontal: float
    block_along: float
    load_x: float
    load_y: float


class CoupledMotion(NamedTuple):
    """Accelerations, or changes of velocities, and the force of the cap on the block."""

    cap_horizontal: float
    cap_vertical: float
    cap_angular: float
    angular: float
    thrust: float  # along the cap, per unit mass


@inlined
def configuration(
    pair: Pair, modes: Modes, states: States, upper: Attitude, lower: Attitude, block_free: bool,
    cap_free: bool,
) -> Configuration:  # fmt: skip
    """Return the geometry of states, with each body held at its pivot or free."""
    block, cap = pair.upper.body, pair.lower.body
    sine, cosine = lower.sine, lower.cosine
    if cap.small:  # the frame's rotation is exact even with small-rotation kinematics on the bases
        sine, cosine = sine_cosine(states.lower.rotation)
    return Configuration(
        sine,
        cosine,
        cap.reach(cap.pin(modes.lower.pivot), lower),
        block.reach(block.pin(modes.upper.pivot), upper),
        pair.top + block.height + states.upper.vertical,
        states.upper.horizontal,
        block_free,
        cap_free,
    )


@inlined
def velocity_along_cap(geometry: Configuration, states: States) -> float:
    """Return d xi/dt, the block's velocity along the cap."""
    if geometry.block_free:
        return states.upper.horizontal_velocity
    return geometry.block_reach.derivative * states.upper.angular_velocity


@inlined
def cap_horizontal_velocity(geometry: Configuration, states: States) -> float:
    """Return the horizontal velocity of the cap's centre."""
    if geometry.cap_free:
        return states.lower.horizontal_velocity
    return geometry.cap_reach.derivative * states.lower.angular_velocity


@inlined
def block_velocity(geometry: Configuration, states: States) -> tuple[float, float]:
    """Return the horizontal and vertical velocity of the block's centre of mass."""
    cap_rate = states.lower.angular_velocity
    s, c = geometry.sine, geometry.cosine
    along = velocity_along_cap(geometry, states) + geometry.arm * cap_rate
    normal = states.upper.vertical_velocity - geometry.across * cap_rate
    return (
        cap_horizontal_velocity(geometry, states) + along * c + normal * s,
        states.lower.vertical_velocity - along * s + normal * c,
    )


@inlined
def block_rise(geometry: Configuration, states: States) -> float:
    """Return the rise of the block's centre of mass from rest, without cancellation [m]."""
    s, c = geometry.sine, geometry.cosine
    normal = states.upper.vertical
    drop = (geometry.arm - normal) * versine(s, c)
    return states.lower.vertical + normal * c - geometry.across * s - drop


@inlined
def solve_motion(
    pair: Pair, geometry: Configuration, forces: Forces, known: KnownTerms
) -> CoupledMotion:
    """Solve the equations of motion, or of impulsive motion, :eq:`eq-coupled-solution`."""
    s, c = geometry.sine, geometry.cosine
    i, i_c, mass = pair.upper.body.inertia, pair.lower.body.inertia, pair.cap_mass
    block_slope, normal, moment = geometry.block_reach.derivative, forces.normal, forces.moment
    effective_inertia = i + block_slope * block_slope
    share = 0.0 if geometry.block_free else i / effective_inertia
    lever = 0.0 if geometry.block_free else block_slope / effective_inertia
    arm = geometry.arm - block_slope
    if geometry.cap_free:
        angular = (geometry.across * normal - moment) / i_c
        along = s * known.load_y - c * known.load_x + arm * angular + known.block_along
        thrust = (share * along + lever * moment) / (1.0 + share / mass + share * arm * arm / i_c)
        x = -known.load_x - (c * thrust + s * normal) / mass
        y = -known.load_y - (c * normal - s * thrust) / mass
        angular -= arm * thrust / i_c
    else:
        reach = geometry.cap_reach.derivative
        total_arm = c * reach + arm
        known_thrust = share * (c * known.cap_horizontal + known.block_along) + lever * moment
        a11 = share * total_arm * total_arm + mass * reach * reach + i_c
        a12 = -share * total_arm * s
        a22 = share * s * s + mass
        b1 = (
            forces.soil_moment
            - moment
            + (geometry.across - reach * s) * normal
            - reach * mass * (known.cap_horizontal + known.load_x)
            - total_arm * known_thrust
        )
        b2 = forces.soil - mass * known.load_y - c * normal + s * known_thrust
        determinant = a11 * a22 - a12 * a12
        angular = (a22 * b1 - a12 * b2) / determinant
        y = (a11 * b2 - a12 * b1) / determinant
        x = reach * angular + known.cap_horizontal
        thrust = share * (total_arm * angular - s * y) + known_thrust
    return CoupledMotion(x, y, angular, (moment - block_slope * thrust) / i - angular, thrust)


@inlined
def normal_change(geometry: Configuration, motion: CoupledMotion) -> float:
    """Return what the cap's motion adds to the block's relative acceleration normal to it."""
    s, c = geometry.sine, geometry.cosine
    lift = s * motion.cap_horizontal + c * motion.cap_vertical
    return geometry.across * motion.cap_angular - lift
