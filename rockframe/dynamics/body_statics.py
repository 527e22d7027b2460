"""Statics of one body on its base, or on a corner of a rigid base, at a given rotation.

Either the force on the base or the height is prescribed, too. Forces are those of the equations of
motion, :eq:`eq-static-chain`, per unit mass.
"""

import math
import sys
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.case_arrays import asin, sqrt
from rockframe.dynamics.base import BaseForce
from rockframe.dynamics.bed import both_contacts
from rockframe.dynamics.body import PIVOT_LEFT, PIVOT_RIGHT, Attitude, BaseLine, BodyState, Reach
from rockframe.dynamics.on_base import BodyOnBase, Mode

ROUNDING: Final = 4.0 * sys.float_info.epsilon
"""Rounding noise of heights over their sizes [1]."""
MAX_ITERATIONS: Final = 200
"""Largest number of iterations for a height."""
MAX_SECANTS: Final = 8
"""Iterations by secants alone; then every second one bisects, as contact may end in between."""
UPLIFT_TOLERANCE: Final = 1e-9
"""Accuracy of the uplift angle: full contact before it less this share, partial beyond [1]."""
MAX_BISECTIONS: Final = 60
"""Largest number of iterations for the uplift angle, then of bisections if these fail."""
DIFFERENCE_STEP: Final = 1e-3
"""Step of a coordinate, over its size, for derivatives of forces [1]."""
STENCIL: Final = ((1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0))
"""Numbers of steps to both sides, and weights, of a finite difference of fourth order."""
DISPLACEMENTS: Final = ("rotation", "vertical")
RATES: Final = ("angular_velocity", "vertical_velocity")


class StandingBody(NamedTuple):
    """A body on its base in a chain of bodies, with the numbers that are fixed for statics."""

    part: BodyOnBase
    mass: float  # over the reference mass [1]
    top: float  # height of its deck above its centre of mass [m]
    offset: float  # centre of mass to the right of that of the body beneath, upright [m]
    settlement: float  # of its base, a typical size [m]
    own: Any  # variables of its base's own, as they are before any run
    # on a rigid base: 1 if it has lifted and bears on its right corner, -1 on its left one, else 0
    corner: int = 0

    @property
    def allowed_rotation(self) -> float:
        """Estimate of the rotation at which an end lifts: settlement over half the width."""
        return 2.0 * self.settlement / (self.part.body.left + self.part.body.right)

    def corner_lever(self, pose: "Pose") -> float:
        """Return the derivative of the height of its bearing corner by the rotation [m]."""
        return pose.line.right_lever if self.corner > 0 else pose.line.left_lever

    def centre_on_deck(self, attitude: Attitude, pivot: int) -> tuple[Reach, float]:
        """Return the position of the centre of mass along the deck beneath, and its derivatives."""
        body = self.part.body
        pin = body.pin(pivot)
        across = self.offset + pin + body.about_pin(pin, attitude)
        return body.reach(pin, attitude), across

    def scaled(self, share: float) -> "StandingBody":
        """Return the body with a share of its eccentricity."""
        body = self.part.body
        if self.offset == 0.0 and body.left == body.right:
            return self
        half, off = 0.5 * (body.left + body.right), 0.5 * share * (body.left - body.right)
        part = BodyOnBase(body._replace(left=half + off, right=half - off), self.part.base)
        return self._replace(part=part, offset=share * self.offset)


class Pose(NamedTuple):
    """Position of a body on its base, with the forces on it, mostly in equilibrium."""

    state: BodyState
    mode: Mode
    reach: Reach
    across: float  # centre of mass from that of the body beneath, along the deck [m]
    line: BaseLine
    force: BaseForce
    normal_force: float  # load on its base, normal to it
    own: Any  # variables of its base's own, as at a start there
    arm: float = 0.0  # centre of mass from that of the body beneath, normal to the deck [m]


def standing_body(
    part: BodyOnBase, mass: float = 1.0, top: float = 0.0, offset: float = 0.0
) -> StandingBody:
    """Return a body on its base, with the base's variables as they are before any run."""
    body, base = part
    own = base.read(np.zeros(base.variables()), 0)
    rest = body.base_line_at(BodyState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    return StandingBody(part, mass, top, offset, base.level(True, rest, own), own)


def equilibrium_pose(standing: StandingBody, rotation: float, load: float) -> Pose:
    """Return the equilibrium of a body at a rotation on its base, which carries a normal load.

    The force of a base falls with the height of the body on it. The height at which the base
    carries the weight is a first guess, which a secant between bounds refines.
    """
    if standing.corner:
        return pose_on_corner(standing, rotation, load)
    body, base = standing.part
    own = standing.own if isinstance(standing.own, tuple) else np.array(standing.own)
    attitude = body.attitude(rotation)
    lift = body.left * attitude.sine, -body.right * attitude.sine
    height = base.resting_height(*lift, own) - attitude.rise
    noise = ROUNDING * (standing.settlement + abs(lift[0]) + abs(lift[1]) + abs(attitude.rise))
    stiffness = load / standing.settlement
    low, high, before = -math.inf, math.inf, (math.nan, math.nan)
    count = 0
    while True:
        state = BodyState(rotation, height, 0.0, 0.0, 0.0, 0.0)
        line = body.base_line(state, attitude)
        contact = base.starting(line, own)
        force = base.force(contact, line, own)
        excess = force.upward - load
        if (before[1] - excess) * (height - before[0]) > 0.0:
            stiffness = (before[1] - excess) / (height - before[0])
        step, before = excess / stiffness, (height, excess)
        count += 1
        if abs(step) <= noise or count == MAX_ITERATIONS:
            break
        low, high = (height, high) if excess > 0.0 else (low, height)
        height += step
        halved = count > MAX_SECANTS and count % 2 == 0 and low > -math.inf and high < math.inf
        if halved or not low < height < high:
            height = 0.5 * (low + high)
    mode = standing.part.mode_for_contact(contact, state)
    centre = standing.centre_on_deck(attitude, mode.pivot)
    return Pose(state, mode, *centre, line, force, load, own)


def pose_at_height(standing: StandingBody, rotation: float, height: float) -> Pose:
    """Return a body at a rotation and a height, at which links may have lifted it off its base."""
    body, base = standing.part
    own = standing.own if isinstance(standing.own, tuple) else np.array(standing.own)
    state, attitude = BodyState(rotation, height, 0.0, 0.0, 0.0, 0.0), body.attitude(rotation)
    line = body.base_line(state, attitude)
    contact = base.starting(line, own)
    force, mode = base.force(contact, line, own), standing.part.mode_for_contact(contact, state)
    centre = standing.centre_on_deck(attitude, mode.pivot)
    return Pose(state, mode, *centre, line, force, force.upward, own)


def pose_on_corner(standing: StandingBody, rotation: float, load: float) -> Pose:
    """Return a body at a rotation on a corner of a rigid base, which carries a force."""
    body, right = standing.part.body, standing.corner > 0
    attitude = body.attitude(rotation)
    level = attitude.rise + (-body.right if right else body.left) * attitude.sine
    state = BodyState(rotation, -level, 0.0, 0.0, 0.0, 0.0)
    line = body.base_line(state, attitude)
    force = BaseForce(load, load * (line.right_lever if right else line.left_lever), 0.0)
    contact = both_contacts(int(right), int(not right))
    mode = Mode(contact, PIVOT_RIGHT if right else PIVOT_LEFT, False)
    centre = standing.centre_on_deck(attitude, mode.pivot)
    return Pose(state, mode, *centre, line, force, load, standing.own)


def uplift_rotation(standing: StandingBody, load: float) -> float:
    """Return the least rotation to the right at which a base is no longer in full contact [rad].

    NaN if contact is full up to a right angle.
    """
    body, base = standing.part

    def is_full(rotation: float) -> bool:
        contact = equilibrium_pose(standing, rotation, load).mode.contact
        return base.is_held(contact, True) and base.is_held(contact, False)

    most = math.inf if body.small else 0.5 * math.pi
    if not body.small and is_full(most):
        return math.nan
    # first guess: the end has risen by the settlement; then secants
    guess = standing.allowed_rotation
    guess = guess if body.small else asin(min(guess, 1.0))
    last, left, slope = math.nan, math.nan, 1.0 / guess
    for _ in range(MAX_BISECTIONS):
        pose = equilibrium_pose(standing, guess, load)
        # depth of the higher end below its level of separation, over the settlement
        now = base.level(True, pose.line, pose.own) / standing.settlement
        if not abs(now) > ROUNDING or guess == last:
            break
        slope = (left - now) / (guess - last) if left > now or left < now else slope
        last, left = guess, now
        guess = min(max(guess + now / slope, 0.5 * guess), 2.0 * guess, most)
    low, high = (1.0 - UPLIFT_TOLERANCE) * guess, (1.0 + UPLIFT_TOLERANCE) * guess
    if is_full(low) and not is_full(min(high, most)):
        return guess
    low, high = 0.0, guess if body.small else most
    while is_full(high):
        high *= 2.0
    for _ in range(MAX_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_full(middle) else (low, middle)
    return high


def base_derivatives(
    standing: StandingBody, pose: Pose, name: str, *, from_rest: bool = False
) -> tuple[float, float]:
    """Return minus the derivatives of a base's moment and force by a coordinate or rate.

    The size of rates is that of a vibration with the settlement as its amplitude. The base's own
    variables keep their values, or are those of a load that has grown `from_rest`.
    """
    body, base = standing.part
    rotates = name in (DISPLACEMENTS[0], RATES[0])
    size = standing.allowed_rotation if rotates else standing.settlement
    frequency = sqrt(body.gravity / standing.settlement) if name in RATES else 1.0
    step = DIFFERENCE_STEP * size * frequency
    contact, own = pose.mode.contact, pose.own

    def force(by: float) -> BaseForce:
        state = pose.state._replace(**{name: getattr(pose.state, name) + by})
        line = body.base_line_at(state)
        if from_rest and base.variables() > 0:
            new = np.array(own)
            return base.force(base.starting(line, new), line, new)
        return base.force(contact, line, own)

    moment = upward = 0.0
    for steps, weight in STENCIL:
        before, after = force(steps * step), force(-steps * step)
        moment -= weight / step * (before.moment - after.moment)
        upward -= weight / step * (before.upward - after.upward)
    return moment, upward
