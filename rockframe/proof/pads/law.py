"""The equations of a block on two pads in a proof, for balls and for balls with gradients.

Written independently of the equations of runs, from :eq:`eq-pad-force`, :eq:`eq-two-spring`,
:eq:`eq-guards`, :eq:`eq-repinning` and :eq:`eq-impact`. A state consists of rotation, its rate,
height, its rate, and the horizontal velocity of a block in flight, which is zero otherwise.
"""

from typing import Any, Final, NamedTuple

from rockframe.dynamics.body import PIVOT_CENTRE, pivot_of
from rockframe.dynamics.pads import CLEAR, ENGAGING, LEAVING, RELAXING, TOUCHING
from rockframe.proof.balls import ZERO, Ball, Row, ball
from rockframe.proof.problem import require

SIZE: Final = 5
"""Numbers of a state."""
_SAME_LANDING: Final = 1e-9
"""Share of the settlement within which runs take two landings as one; up to twice undecided."""
_SEPARATION: Final = 1e-11
"""Share of the settlement by which a corner that lifts off must be below its pad's own level."""


class Dual:
    """A ball with its gradient by the state (forward differentiation)."""

    __slots__ = ("slope", "value")

    def __init__(self, value: Ball, slope: Row) -> None:
        self.value, self.slope = value, slope

    def __add__(self, other: Any) -> "Dual":
        """Add a dual or a ball."""
        if isinstance(other, Dual):
            slope = [a + b for a, b in zip(self.slope, other.slope, strict=True)]
            return Dual(self.value + other.value, slope)
        return Dual(self.value + other, self.slope)

    __radd__ = __add__

    def __neg__(self) -> "Dual":
        """Return the opposite."""
        return Dual(-self.value, [-change for change in self.slope])

    def __sub__(self, other: Any) -> "Dual":
        """Take away."""
        return self + (-other)

    def __rsub__(self, other: Any) -> "Dual":
        """Take from a ball."""
        return -self + other

    def __mul__(self, other: Any) -> "Dual":
        """Multiply by a dual or a ball."""
        if isinstance(other, Dual):
            a, b = self.value, other.value
            slope = [x * b + a * y for x, y in zip(self.slope, other.slope, strict=True)]
            return Dual(a * b, slope)
        return Dual(self.value * other, [change * other for change in self.slope])

    __rmul__ = __mul__

    def __truediv__(self, other: "Dual") -> "Dual":
        """Divide by a dual."""
        value = self.value / other.value
        slope = [
            (x - value * y) / other.value for x, y in zip(self.slope, other.slope, strict=True)
        ]
        return Dual(value, slope)

    def sin(self) -> "Dual":
        """Return the sine."""
        cosine = self.value.cos()
        return Dual(self.value.sin(), [cosine * change for change in self.slope])

    def cos(self) -> "Dual":
        """Return the cosine."""
        sine = self.value.sin()
        return Dual(self.value.cos(), [-sine * change for change in self.slope])


def independent_duals(state: Row) -> list[Dual]:
    """Return a state as duals, the independent variables of gradients."""
    unit = [[ball(int(i == j)) for j in range(SIZE)] for i in range(SIZE)]
    return [Dual(value, unit[i]) for i, value in enumerate(state)]


class GroundAcceleration(NamedTuple):
    """Ground acceleration along the base, and gravity plus the normal one, at a time or several."""

    along: Ball
    normal: Ball


class PadBalls(NamedTuple):
    """Two pads and the block on them, per unit mass."""

    height: Ball  # h
    left: Ball  # from below the centre of mass to the left corner
    right: Ball  # likewise to the right corner
    inertia: Ball  # I_O/m
    middle: Ball  # middle of the base, to the right of the centre of mass
    stiffness: Ball  # of a pad
    damping: Ball
    restitutions: tuple[Ball, Ball]  # of a corner that lands on the left and on the right pad
    rest: Ball  # settlement of a pad under half the weight, height of its unloaded level
    rule: int  # rule of the restraint
    small: bool  # whether the kinematics are those of small rotation
    limits: tuple[Ball, Ball]  # rotations that count as overturning, to the left and to the right
    gravity: Ball


class Contacts(NamedTuple):
    """Contacts of both corners, by the constants of :mod:`rockframe.dynamics.pads`."""

    left: int
    right: int

    def of(self, left: bool) -> int:
        """Return the contact of a corner."""
        return self.left if left else self.right

    def with_corner(self, left: bool, contact: int) -> "Contacts":
        """Return the contacts with another one of a corner."""
        return Contacts(contact, self.right) if left else Contacts(self.left, contact)

    @property
    def in_flight(self) -> bool:
        """Whether no corner is held."""
        return self.left >= RELAXING and self.right >= RELAXING


class Guard(NamedTuple):
    """A function of the state that is positive as long as a contact lasts."""

    kind: str  # "press", "slack", "depth", "gap", "rise", "limit"
    left: bool  # whether it is of the left corner


_GUARDS: Final = {
    TOUCHING: ("press",),
    ENGAGING: ("depth", "slack"),
    RELAXING: ("depth", "slack"),
    CLEAR: ("gap",),
    LEAVING: ("depth", "press", "rise"),
}


def guards_of(contacts: Contacts) -> list[Guard]:
    """Return the guards of some contacts, :eq:`eq-guards`, and those of overturning."""
    guards = [Guard(kind, left) for left in (True, False) for kind in _GUARDS[contacts.of(left)]]
    return [*guards, Guard("limit", True), Guard("limit", False)]


class RotationTerms(NamedTuple):
    """Sine, cosine and rise of a rotation, or their forms at small rotation."""

    sine: Any
    cosine: Any
    rise: Any


def rotation_terms(pads: PadBalls, rotation: Any) -> RotationTerms:
    """Return sine, cosine and rise, :eq:`eq-kinematics`."""
    if pads.small:
        return RotationTerms(rotation, ball(1), rotation * rotation * (pads.height / 2))
    cosine = rotation.cos()
    return RotationTerms(rotation.sin(), cosine, pads.height * (1 - cosine))


class CornerMotion(NamedTuple):
    """Height of a corner above its place at rest, its speed upwards, its lever."""

    level: Any
    speed: Any
    lever: Any


def corner_motion(pads: PadBalls, left: bool, state: list[Any]) -> CornerMotion:
    """Return height, speed and lever of a corner in a state."""
    reach = pads.left if left else -pads.right
    at = rotation_terms(pads, state[0])
    lever = at.sine * pads.height + at.cosine * reach
    return CornerMotion(state[2] + at.rise + at.sine * reach, state[3] + lever * state[1], lever)


def reaction(pads: PadBalls, left: bool, at: CornerMotion) -> Any:
    """Return the force of a pad on a corner if they touched, :eq:`eq-pad-force`."""
    depth = pads.rest - at.level
    return depth * pads.stiffness - at.speed * pads.damping


def pivot(pads: PadBalls, contacts: Contacts) -> int:
    """Return the pivot: which point of the base is held."""
    left, right = (contacts.of(side) < RELAXING for side in (True, False))
    return pivot_of(pads.rule, left, right, 0.0, 0.0)


def pivot_offset(pads: PadBalls, contacts: Contacts) -> Ball:
    """Return e, from below the centre of mass to the held point."""
    held = pivot(pads, contacts)
    if held == PIVOT_CENTRE:
        return pads.middle
    return pads.right if contacts.left >= RELAXING else -pads.left


def arm(pads: PadBalls, contacts: Contacts, rotation: Any) -> Any:
    """Return x', the derivative of the centre's horizontal place by the rotation."""
    if pads.small:
        return pads.height
    at = rotation_terms(pads, rotation)
    return at.cosine * pads.height + at.sine * pivot_offset(pads, contacts)


def state_rates(
    pads: PadBalls, contacts: Contacts, state: list[Any], ground: GroundAcceleration
) -> list[Any]:
    """Return the rates of change of a state, :eq:`eq-two-spring`."""
    rotation, rate, _, speed, _ = state
    upward, moment = -ground.normal, ZERO
    for left in (True, False):
        if contacts.of(left) == TOUCHING:
            at = corner_motion(pads, left, state)
            force = reaction(pads, left, at)
            upward, moment = force + upward, force * at.lever + moment
    zero = rate * ZERO
    if contacts.in_flight:
        return [rate, zero, speed, zero + upward, zero - ground.along]
    sway = arm(pads, contacts, rotation)
    push = ground.along
    if not pads.small:
        at = rotation_terms(pads, rotation)
        push = (
            at.cosine * pivot_offset(pads, contacts) - at.sine * pads.height
        ) * rate * rate + push
    net_moment = zero + moment - zero - push * sway
    return [
        rate,
        net_moment / (zero + sway * sway + pads.inertia),
        speed,
        zero + upward,
        zero,
    ]


def guard_value(pads: PadBalls, guard: Guard, state: list[Any]) -> Any:
    """Return the value of a guard in a state."""
    if guard.kind == "limit":
        limit = pads.limits[not guard.left]
        return state[0] + limit if guard.left else limit - state[0]
    at = corner_motion(pads, guard.left, state)
    if guard.kind == "depth":
        return pads.rest - at.level
    if guard.kind == "gap":
        return at.level - pads.rest
    if guard.kind == "rise":
        return at.speed
    force = reaction(pads, guard.left, at)
    return force if guard.kind == "press" else -force


class ContactChange(NamedTuple):
    """A state after a change of contact; `zero_guards` are the guards that are zero then."""

    state: list[Dual]
    contacts: Contacts
    zero_guards: tuple[Guard, ...]
    impacts: int


def change_contact(
    pads: PadBalls, contacts: Contacts, guard: Guard, state: list[Dual], ground: GroundAcceleration
) -> ContactChange:
    """Return the state after the event of a guard that has fallen to zero.

    Raises `Undecided` if a sign that decides about the event is not known.
    """
    left, was = guard.left, contacts.of(guard.left)
    if guard.kind == "depth" and was in (RELAXING, LEAVING):
        zero_guards = (Guard("gap", left),)
        return ContactChange(state, contacts.with_corner(left, CLEAR), zero_guards, 0)
    if guard.kind == "press" and was == LEAVING:
        zero_guards = (Guard("slack", left),)
        return ContactChange(state, contacts.with_corner(left, RELAXING), zero_guards, 0)
    if guard.kind == "slack" and was == ENGAGING:
        zero_guards = (Guard("press", left),)
        return ContactChange(state, contacts.with_corner(left, TOUCHING), zero_guards, 0)
    if was < RELAXING:
        return _lift_off(pads, contacts, left, state, ground)
    return _land(pads, contacts, left, state)


def _lift_off(
    pads: PadBalls, contacts: Contacts, left: bool, state: list[Dual], ground: GroundAcceleration
) -> ContactChange:
    """Return the state after a corner has lifted off."""
    at, own_guard = corner_motion(pads, left, state), Guard("gap", left)
    contact = CLEAR
    if contacts.of(left) == TOUCHING and pads.damping > 0:
        depth = (pads.rest - at.level).value
        require(
            depth > pads.rest * _SEPARATION, "a corner that leaves its pad at the pad's own level"
        )
        contact, own_guard = RELAXING, Guard("slack", left)
    opposite = contacts.of(not left)
    if opposite == TOUCHING:
        require(
            reaction(pads, not left, corner_motion(pads, not left, state)).value > 0,
            "both corners lift off at once",
        )
    elif opposite in (ENGAGING, LEAVING):
        opposite = RELAXING
    after = Contacts(contact, opposite) if left else Contacts(opposite, contact)
    if after.in_flight:
        sway = arm(pads, contacts, state[0]) * state[1]
        state = [*state[:4], sway]
        if contact == RELAXING:
            rate = _guard_rate(pads, after, Guard("press", left), state, ground)
            require(rate < 0, "a corner that slides on its pad as it leaves")
        return ContactChange(state, after, (own_guard,), 0)
    if pivot(pads, after) == pivot(pads, contacts):
        return ContactChange(state, after, (own_guard,), 0)
    state = _project_momentum(pads, contacts, after, state)
    at = corner_motion(pads, left, state)
    require(at.speed.value > 0, "a corner that its restraint keeps from leaving")
    if contact == CLEAR:
        return ContactChange(state, after, (own_guard,), 0)
    force = reaction(pads, left, at).value
    if force > 0:
        return ContactChange(state, after.with_corner(left, LEAVING), (), 0)
    require(force < 0, "whether a pad still presses a corner that has left is not resolved")
    return ContactChange(state, after, (), 0)


def _land(pads: PadBalls, contacts: Contacts, left: bool, state: list[Dual]) -> ContactChange:
    """Return the state after a corner has landed, or is pressed again by its pad."""
    lands, opposite = contacts.of(left) == CLEAR, contacts.of(not left)
    if lands and opposite == CLEAR:
        level = guard_value(pads, Guard("gap", not left), state).value
        require(abs(level) > pads.rest * (2 * _SAME_LANDING), "both corners land at once")
    if opposite == LEAVING:
        opposite = RELAXING
    after = Contacts(TOUCHING, opposite) if left else Contacts(opposite, TOUCHING)
    before = corner_motion(pads, left, state).speed.value
    was_in_flight = contacts.in_flight
    changes_pivot = was_in_flight or pivot(pads, after) != pivot(pads, contacts)
    if changes_pivot:
        state = _project_momentum(pads, contacts, after, state)
    at = corner_motion(pads, left, state)
    slower = at.speed.value < 0 if lands else at.speed.value < before
    require(slower or not was_in_flight, "a corner that slides on its pad as it lands")
    if lands:
        zero_guards = () if pads.damping > 0 else (Guard("press", left),)
        return ContactChange(_apply_impact(pads, after, left, state), after, zero_guards, 1)
    force = reaction(pads, left, at).value
    if not changes_pivot and contacts.of(left) == RELAXING:
        return ContactChange(state, after, (Guard("press", left),), 0)
    if force < 0:
        return ContactChange(state, after.with_corner(left, ENGAGING), (), 0)
    require(force > 0, "whether a pad presses a corner that has come back is not resolved")
    return ContactChange(state, after, (), 0)


def _project_momentum(
    pads: PadBalls, before: Contacts, after: Contacts, state: list[Dual]
) -> list[Dual]:
    """Project the momentum on another held point, :eq:`eq-repinning`."""
    sway = state[4] if before.in_flight else arm(pads, before, state[0]) * state[1]
    reach = arm(pads, after, state[0])
    slip = sway - reach * state[1]
    answer = slip * reach / (state[0] * ZERO + reach * reach + pads.inertia)
    return [state[0], state[1] + answer, state[2], state[3], state[4] * ZERO]


def _apply_impact(pads: PadBalls, after: Contacts, left: bool, state: list[Dual]) -> list[Dual]:
    """Reduce the speed of a landing corner, :eq:`eq-impact`."""
    at, reach = corner_motion(pads, left, state), arm(pads, after, state[0])
    if at.speed.value > 0:
        return state
    require(at.speed.value < 0, "a landing that hardly touches its pad")
    unit = state[0] * ZERO + 1
    answer = unit * at.lever / (unit * (reach * reach) + pads.inertia)
    impulse = at.speed * (pads.restitutions[not left] - 1) / (at.lever * answer + 1)
    return [state[0], state[1] + impulse * answer, state[2], state[3] + impulse, state[4]]


def _guard_rate(
    pads: PadBalls, contacts: Contacts, guard: Guard, state: list[Dual], ground: GroundAcceleration
) -> Ball:
    """Return the rate of change of a guard in a state, as a ball."""
    at = independent_duals([component.value for component in state])
    return rate_of_change(guard_value(pads, guard, at), state_rates(pads, contacts, at, ground))


def rate_of_change(of: Dual, rates: list[Dual]) -> Ball:
    """Return the rate of change of a dual, from the rates of its state."""
    return sum((a * b.value for a, b in zip(of.slope, rates, strict=True)), ZERO)
