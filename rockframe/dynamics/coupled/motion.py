"""Kinematics of two bodies, one on the other, and their accelerations under given forces.

Kinematics :eq:`eq-coupled-kinematics` and the solution of the equations of motion. The upper
body is called the block and the lower one the cap; all is per unit mass of the block.
"""

from typing import NamedTuple

from rockframe.compiled import inlined
from rockframe.dynamics.body import Attitude, Reach
from rockframe.dynamics.on_base import OnBase
from rockframe.dynamics.stacked import Modes, States
from rockframe.dynamics.trigonometry import sine_cosine


class Pair(NamedTuple):
    """The bodies and bases of a stack."""

    upper: OnBase  # the block on its base, in the frame of the cap
    lower: OnBase  # the cap on the ground
    cap_mass: float  # m_c/m; the cap's inertia is I_c/m
    top: float  # of the cap above its centre of mass [m]
    beside: float  # block's centre of mass to the right of the cap's, both upright [m]


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

    press: float  # of the cap on the block, along the cap's normal
    moment: float  # on the block's rotation
    soil: float  # of the ground on the cap, upwards
    soil_moment: float  # on the cap's rotation


class KnownTerms(NamedTuple):
    """Known accelerations in the equations of motion, besides forces.

    `swing` is the part of the cap's horizontal acceleration, `drift` that of the block's along the
    cap, that does not depend on the unknowns; the loads are those on the cap per unit of its mass.
    """

    swing: float
    drift: float
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
    """Return the geometry of states, with each body held at its pivot or free as given."""
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
def along_rate(place: Configuration, states: States) -> float:
    """Return d xi/dt, the block's velocity along the cap."""
    if place.block_free:
        return states.upper.horizontal_velocity
    return place.block_reach.rate * states.upper.angular_velocity


@inlined
def cap_sway(place: Configuration, states: States) -> float:
    """Return the horizontal velocity of the cap's centre."""
    if place.cap_free:
        return states.lower.horizontal_velocity
    return place.cap_reach.rate * states.lower.angular_velocity


@inlined
def block_velocity(place: Configuration, states: States) -> tuple[float, float]:
    """Return the horizontal and vertical velocity of the block's centre of mass."""
    cap_rate = states.lower.angular_velocity
    s, c = place.sine, place.cosine
    along = along_rate(place, states) + place.arm * cap_rate
    normal = states.upper.vertical_velocity - place.across * cap_rate
    return (
        cap_sway(place, states) + along * c + normal * s,
        states.lower.vertical_velocity - along * s + normal * c,
    )


@inlined
def block_height(place: Configuration, states: States) -> float:
    """Return the rise of the block's centre of mass from rest, without cancellation [m]."""
    s, c = place.sine, place.cosine
    versine = s * s / (1.0 + c) if c > 0.0 else 1.0 - c
    normal = states.upper.vertical
    return states.lower.vertical + normal * c - place.across * s - (place.arm - normal) * versine


@inlined
def solve_motion(
    pair: Pair, place: Configuration, forces: Forces, given: KnownTerms
) -> CoupledMotion:
    """Solve the equations of motion, or of impulsive motion, :eq:`eq-coupled-solution`."""
    s, c = place.sine, place.cosine
    i, i_c, mass = pair.upper.body.inertia, pair.lower.body.inertia, pair.cap_mass
    slide, press, moment = place.block_reach.rate, forces.press, forces.moment
    tied = i + slide * slide
    share = 0.0 if place.block_free else i / tied
    lever = 0.0 if place.block_free else slide / tied
    arm = place.arm - slide
    if place.cap_free:
        angular = (place.across * press - moment) / i_c
        along = s * given.load_y - c * given.load_x + arm * angular + given.drift
        thrust = (share * along + lever * moment) / (1.0 + share / mass + share * arm * arm / i_c)
        x = -given.load_x - (c * thrust + s * press) / mass
        y = -given.load_y - (c * press - s * thrust) / mass
        angular -= arm * thrust / i_c
    else:
        reach = place.cap_reach.rate
        reaching = c * reach + arm
        known = share * (c * given.swing + given.drift) + lever * moment
        a11 = share * reaching * reaching + mass * reach * reach + i_c
        a12 = -share * reaching * s
        a22 = share * s * s + mass
        b1 = (
            forces.soil_moment
            - moment
            + (place.across - reach * s) * press
            - reach * mass * (given.swing + given.load_x)
            - reaching * known
        )
        b2 = forces.soil - mass * given.load_y - c * press + s * known
        determinant = a11 * a22 - a12 * a12
        angular = (a22 * b1 - a12 * b2) / determinant
        y = (a11 * b2 - a12 * b1) / determinant
        x = reach * angular + given.swing
        thrust = share * (reaching * angular - s * y) + known
    return CoupledMotion(x, y, angular, (moment - slide * thrust) / i - angular, thrust)


@inlined
def normal_change(place: Configuration, motion: CoupledMotion) -> float:
    """Return what the cap's motion adds to the block's relative acceleration normal to it."""
    s, c = place.sine, place.cosine
    lift = s * motion.cap_horizontal + c * motion.cap_vertical
    return place.across * motion.cap_angular - lift
