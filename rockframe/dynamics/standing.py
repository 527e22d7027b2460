"""Statics of one body on its base, or on a corner of a rigid base, at a given rotation.

The force that the base carries, or the height, is given too. Forces are those of the equations of
motion, :eq:`eq-static-chain`, per unit mass.
"""

import math
import sys
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.case_arrays import asin, sqrt
from rockframe.dynamics.base import BaseForce
from rockframe.dynamics.bed import both_contacts
from rockframe.dynamics.body import (
    PIVOT_LEFT,
    PIVOT_RIGHT,
    Attitude,
    BaseLine,
    BodyState,
    Reach,
)
from rockframe.dynamics.on_base import Mode, OnBase

ROUNDING: Final = 4.0 * sys.float_info.epsilon
"""Rounding noise of heights over their sizes [1]."""
TRIES: Final = 200
"""Most iterations for a height."""
SECANTS: Final = 8
"""Iterations by secants alone; then every second one bisects, as contact may end in between."""
SHARP: Final = 1e-9
"""Accuracy of the uplift angle: full contact before it less this share, partial beyond [1]."""
HALVINGS: Final = 60
"""Most iterations for the uplift angle, and bisections where these do not find it."""
STEP: Final = 1e-3
"""Step of a coordinate, over its size, for derivatives of forces [1]."""
STENCIL: Final = ((1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0))
"""Steps to both sides, and weights, of a finite difference of fourth order."""
PLACES: Final = ("rotation", "vertical")
RATES: Final = ("angular_velocity", "vertical_velocity")


class StandingBody(NamedTuple):
    """A body on its base in a chain of bodies, with the numbers that are fixed for statics."""

    part: OnBase
    mass: float  # over the reference mass [1]
    top: float  # height of its deck above its centre of mass [m]
    beside: float  # centre of mass to the right of that of the body beneath, upright [m]
    settlement: float  # of its base, a typical size [m]
    own: Any  # variables of its base's own, as they are before any run
    # on a rigid base: 1 if it has lifted and bears on its right corner, -1 on its left one, else 0
    corner: int = 0

    @property
    def allowed_rotation(self) -> float:
        """Rotation at which an end of the base lifts, about: settlement over half the width."""
        return 2.0 * self.settlement / (self.part.body.left + self.part.body.right)

    def corner_lever(self, stand: "Stand") -> float:
        """Return the derivative of the height of its bearing corner by the rotation [m]."""
        return stand.line.right_lever if self.corner > 0 else stand.line.left_lever

    def way(self, attitude: Attitude, pivot: int) -> tuple[Reach, float]:
        """Return the place of the centre of mass along the deck beneath, and its derivatives."""
        body = self.part.body
        pin = body.pin(pivot)
        across = self.beside + pin + (body.height * attitude.sine - pin * attitude.cosine)
        return body.reach(pin, attitude), across

    def with_share(self, share: float) -> "StandingBody":
        """Return the body with a share of its eccentricity."""
        body = self.part.body
        if self.beside == 0.0 and body.left == body.right:
            return self
        half, off = 0.5 * (body.left + body.right), 0.5 * share * (body.left - body.right)
        part = OnBase(body._replace(left=half + off, right=half - off), self.part.base)
        return self._replace(part=part, beside=share * self.beside)


class Stand(NamedTuple):
    """Equilibrium of a body at a rotation on its base, which carries the load on it."""

    state: BodyState
    mode: Mode
    reach: Reach
    across: float  # centre of mass from that of the body beneath, along the deck [m]
    line: BaseLine
    force: BaseForce
    press: float  # load on its base, normal to it
    own: Any  # variables of its base's own, as at a start there
    arm: float = 0.0  # centre of mass from that of the body beneath, normal to the deck [m]


def standing_body(
    part: OnBase, mass: float = 1.0, top: float = 0.0, beside: float = 0.0, own: Any = None
) -> StandingBody:
    """Return a body on its base; `own`: the base's variables, by default those before any run."""
    body, base = part
    if own is None:
        own = base.read(np.zeros(base.variables()), 0)
    rest = body.base_line_at(BodyState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    return StandingBody(part, mass, top, beside, base.level(True, rest, own), own)


def settled(standing: StandingBody, rotation: float, press: float) -> Stand:
    """Return the equilibrium of a body at a rotation on its base, which carries a force `press`.

    The force of a base falls with the height of the body on it. The height at which the base
    carries the weight is a first guess, which a secant between bounds refines.
    """
    if standing.corner:
        return on_corner(standing, rotation, press)
    body, base = standing.part
    own = standing.own if isinstance(standing.own, tuple) else np.array(standing.own)
    attitude = body.attitude(rotation)
    lift = body.left * attitude.sine, -body.right * attitude.sine
    height = base.resting_height(*lift, own) - attitude.rise
    noise = ROUNDING * (standing.settlement + abs(lift[0]) + abs(lift[1]) + abs(attitude.rise))
    hardness = press / standing.settlement
    low, high, before = -math.inf, math.inf, (math.nan, math.nan)
    tries = 0
    while True:
        state = BodyState(rotation, height, 0.0, 0.0, 0.0, 0.0)
        line = body.base_line(state, attitude)
        contact = base.starting(line, own)
        force = base.force(contact, line, own)
        excess = force.upward - press
        if (before[1] - excess) * (height - before[0]) > 0.0:
            hardness = (before[1] - excess) / (height - before[0])
        step, before = excess / hardness, (height, excess)
        tries += 1
        if abs(step) <= noise or tries == TRIES:
            break
        low, high = (height, high) if excess > 0.0 else (low, height)
        height += step
        halved = tries > SECANTS and tries % 2 == 0 and low > -math.inf and high < math.inf
        if halved or not low < height < high:
            height = 0.5 * (low + high)
    mode = standing.part.standing(contact, state)
    return Stand(state, mode, *standing.way(attitude, mode.pivot), line, force, press, own)


def lifted(standing: StandingBody, rotation: float, height: float) -> Stand:
    """Return a body at a rotation and a height, at which links may have lifted it off its base."""
    body, base = standing.part
    own = standing.own if isinstance(standing.own, tuple) else np.array(standing.own)
    state, attitude = BodyState(rotation, height, 0.0, 0.0, 0.0, 0.0), body.attitude(rotation)
    line = body.base_line(state, attitude)
    contact = base.starting(line, own)
    force, mode = base.force(contact, line, own), standing.part.standing(contact, state)
    return Stand(state, mode, *standing.way(attitude, mode.pivot), line, force, force.upward, own)


def on_corner(standing: StandingBody, rotation: float, press: float) -> Stand:
    """Return a body at a rotation on a corner of a rigid base, which carries a force."""
    body, right = standing.part.body, standing.corner > 0
    attitude = body.attitude(rotation)
    level = attitude.rise + (-body.right if right else body.left) * attitude.sine
    state = BodyState(rotation, -level, 0.0, 0.0, 0.0, 0.0)
    line = body.base_line(state, attitude)
    force = BaseForce(press, press * (line.right_lever if right else line.left_lever), 0.0)
    contact = both_contacts(int(right), int(not right))
    mode = Mode(contact, PIVOT_RIGHT if right else PIVOT_LEFT, False)
    return Stand(state, mode, *standing.way(attitude, mode.pivot), line, force, press, standing.own)


def uplift_rotation(standing: StandingBody, press: float) -> float:
    """Return the least rotation to the right at which a base is no longer in full contact [rad].

    NaN if contact is full up to a right angle.
    """
    body, base = standing.part

    def is_full(rotation: float) -> bool:
        contact = settled(standing, rotation, press).mode.contact
        return base.is_held(contact, True) and base.is_held(contact, False)

    most = math.inf if body.small else 0.5 * math.pi
    if not body.small and is_full(most):
        return math.nan
    # first guess: the end has risen by the settlement; then secants
    guess = standing.allowed_rotation
    guess = guess if body.small else asin(min(guess, 1.0))
    last, left, slope = math.nan, math.nan, 1.0 / guess
    for _ in range(HALVINGS):
        stand = settled(standing, guess, press)
        # depth of the higher end below its level of separation, over the settlement
        now = base.level(True, stand.line, stand.own) / standing.settlement
        if not abs(now) > ROUNDING or guess == last:
            break
        slope = (left - now) / (guess - last) if left > now or left < now else slope
        last, left = guess, now
        guess = min(max(guess + now / slope, 0.5 * guess), 2.0 * guess, most)
    low, high = (1.0 - SHARP) * guess, (1.0 + SHARP) * guess
    if is_full(low) and not is_full(min(high, most)):
        return guess
    low, high = 0.0, guess if body.small else most
    while is_full(high):
        high *= 2.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_full(middle) else (low, middle)
    return high


def of_base(
    standing: StandingBody, stand: Stand, name: str, *, from_rest: bool = False
) -> tuple[float, float]:
    """Return minus the derivatives of a base's moment and force by a coordinate or rate.

    The size of rates is that of a vibration with the settlement as its amplitude. The base's own
    variables keep their values, or are those of a load that has grown `from_rest`.
    """
    body, base = standing.part
    size = standing.allowed_rotation if name in (PLACES[0], RATES[0]) else standing.settlement
    step = STEP * size * (sqrt(body.gravity / standing.settlement) if name in RATES else 1.0)
    contact, own = stand.mode.contact, stand.own

    def force(by: float) -> BaseForce:
        state = stand.state._replace(**{name: getattr(stand.state, name) + by})
        line = body.base_line_at(state)
        if from_rest and base.variables() > 0:
            moved = np.array(own)
            return base.force(base.starting(line, moved), line, moved)
        return base.force(contact, line, own)

    moment = upward = 0.0
    for place, weight in STENCIL:
        before, behind = force(place * step), force(-place * step)
        moment -= weight / step * (before.moment - behind.moment)
        upward -= weight / step * (before.upward - behind.upward)
    return moment, upward
