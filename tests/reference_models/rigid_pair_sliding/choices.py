"""Forces of a pattern, and selection of the pattern after an event by trying all."""

import math
from itertools import combinations, product
from typing import NamedTuple

import numpy as np
from reference_models.rigid_pair.pair import Pair

from .contacts import INTERFACES, Bearing, Contact, Friction, Pattern, contact

SMALL = 1e-10
"""Impulses and speeds below this share of the largest count as zero in an impact."""
SLIGHT = 1e-9
"""Forces and accelerations below this share of gravity's count as zero."""

Frictions = dict[str, Friction]
Touching = dict[str, tuple[str, ...]]
"""The touching ends of the ground and of the joint."""


class Answer(NamedTuple):
    """Accelerations, or velocities after an impact, with their forces or impulses."""

    motion: np.ndarray
    normal: dict[tuple[str, str], float]
    friction: dict[str, float]

    def pressed(self, key: str) -> float:
        """Return the sum of the normal forces of an interface."""
        return sum(push for (one, _), push in self.normal.items() if one == key)


class Outcome(NamedTuple):
    """The selected pattern, the number of different admissible motions, and the energy lost.

    ``others`` are the admissible patterns not selected.
    """

    pattern: Pattern
    answer: Answer
    admissible: int
    lost: float = 0.0
    others: tuple[Pattern, ...] = ()


class Touch:
    """All touching ends, with their rows at one instant."""

    def __init__(self, pair: Pair, frictions: Frictions, place, speed, touching: Touching):
        self.pair, self.frictions, self.touching = pair, frictions, touching
        self.speed = np.asarray(speed, dtype=float)
        self.inverse = 1.0 / pair.masses
        self.contacts: dict[tuple[str, str], Contact] = {
            (key, end): contact(pair, place, speed, key, end)
            for key in INTERFACES
            for end in touching[key]
        }

    def solve(self, pattern: Pattern, motion, turning: bool, hooked=()) -> Answer:
        """Add forces to a motion so that bearing ends and held interfaces stay.

        Parameters
        ----------
        pattern : Pattern
        motion : numpy.ndarray
            Accelerations without contacts, or velocities before an impact.
        turning : bool
            Whether `motion` holds accelerations, which include terms of rotation rates.
        hooked : tuple of str
            Interfaces held tangentially although nothing may press there.
        """
        wanted, pushes, stays, names = [], [], [], []
        for key, bearing in zip(INTERFACES, pattern, strict=True):
            drag = bearing.slip * self.frictions[key].kinetic if bearing.slip else 0.0
            for end in bearing.ends:
                one = self.contacts[key, end]
                wanted.append(one.normal)
                stays.append(one.turns[1])
                pushes.append([n - drag * t for n, t in zip(one.normal, one.along, strict=True)])
                names.append((key, end))
            if bearing.slip == 0 and (bearing.ends or key in hooked):
                one = self.contacts[key, (bearing.ends or self.touching[key])[0]]
                wanted.append(one.along)
                stays.append(one.turns[0])
                pushes.append(one.along)
                names.append((key, ""))
        if not names:
            return Answer(motion, {}, {})
        rows, forces = np.array(wanted), np.array(pushes)
        offset = rows @ motion + (np.array(stays) if turning else 0.0)
        # scale rows of bodies of different mass
        size = 1.0 / np.sqrt((rows * rows) @ self.inverse)
        scaled, spread = rows * size[:, None], (forces * size[:, None]) * self.inverse
        multipliers = np.linalg.solve(scaled @ spread.T, -offset * size)
        answer = motion + spread.T @ multipliers
        multipliers = multipliers * size
        normal, friction = {}, {}
        for (key, end), force in zip(names, multipliers, strict=True):
            if end:
                normal[key, end] = float(force)
            else:
                friction[key] = float(force)
        one = Answer(answer, normal, friction)
        for key, bearing in zip(INTERFACES, pattern, strict=True):
            if bearing.slip:
                friction[key] = -bearing.slip * self.frictions[key].kinetic * one.pressed(key)
        return one

    def opening(self, name, motion, turning: bool) -> float:
        """Return the speed (or acceleration) of an end away from its surface."""
        one = self.contacts[name]
        return float(np.dot(one.normal, motion)) + (one.turns[1] if turning else 0.0)

    def along(self, key: str, end: str, motion, turning: bool) -> float:
        """Return the speed (or acceleration) of an end along its surface."""
        one = self.contacts[key, end]
        return float(np.dot(one.along, motion)) + (one.turns[0] if turning else 0.0)

    def fall(self, across: float, up: float) -> np.ndarray:
        """Return the accelerations without contact forces."""
        g = self.pair.gravity + up
        return np.array([-across, -g, 0.0, -across, -g, 0.0])


def patterns(touching: Touching, senses: dict[str, tuple[int, ...]]) -> list[Pattern]:
    """Return all patterns of touching ends and senses of slip of each interface."""
    bearings = []
    for key in INTERFACES:
        ends = touching[key]
        some = [one for count in (2, 1) for one in combinations(ends, count)]
        bearings.append(
            [Bearing(one, sense) for one in some for sense in senses[key]] + [Bearing()]
        )
    return [Pattern(*one) for one in product(*bearings)]


def strike(pair: Pair, frictions: Frictions, place, speed, touching: Touching) -> Outcome:
    """Return the outcome of a plastic impact in which all touching ends take part.

    Bearing ends stop, the others separate. Each interface is held if |T| <= mu_k N, or slips
    after the impact against T = mu_k N (Moreau 1988). Of several motions the one that loses
    least energy is selected. Without slip there may be none; then `hooked_strike` applies.
    """
    touch = Touch(pair, frictions, place, speed, touching)
    senses = {key: (0,) if frictions[key].sticks else (0, 1, -1) for key in INTERFACES}
    masses, speed = pair.masses, touch.speed
    before = 0.5 * float(masses @ speed**2)
    push, quick = _sizes(pair, speed, before)
    outcomes: list[tuple[float, Pattern, Answer]] = []
    for pattern in patterns(touching, senses):
        try:
            answer = touch.solve(pattern, speed, turning=False)
        except np.linalg.LinAlgError:
            continue
        if min(answer.normal.values(), default=0.0) < -push:
            continue
        if not _fits(touch, pattern, answer, push, quick):
            continue
        if not any(
            np.max(np.abs(answer.motion - outcome[2].motion)) < 100.0 * quick
            for outcome in outcomes
        ):
            outcomes.append((before - 0.5 * float(masses @ answer.motion**2), pattern, answer))
    if not outcomes:
        pattern, answer = hooked_strike(touch)
        return Outcome(pattern, answer, 0, before - 0.5 * float(masses @ answer.motion**2))
    outcomes.sort(key=lambda outcome: outcome[0])
    lost, pattern, answer = outcomes[0]
    return Outcome(
        pattern, answer, len(outcomes), lost, tuple(outcome[1] for outcome in outcomes[1:])
    )


def _sizes(pair: Pair, speed, energy: float) -> tuple[float, float]:
    """Return the impulse and the velocity that count as zero."""
    heavy, light = max(pair.masses[[0, 3]]), min(pair.masses[[0, 3]])
    quick = SMALL * math.sqrt(2.0 * energy / heavy) + 1e-300
    push = quick * light
    arm = math.hypot(pair.upper.half_width, pair.upper.below)
    return push, max(quick, SMALL * arm * float(np.max(np.abs(speed[[2, 5]]))))


def _fits(touch: Touch, pattern: Pattern, answer: Answer, push: float, quick: float) -> bool:
    """Tell whether ends that do not bear separate, and friction obeys Coulomb's law."""
    for key, bearing in zip(INTERFACES, pattern, strict=True):
        for end in touch.touching[key]:
            if end not in bearing.ends and touch.opening((key, end), answer.motion, False) < -quick:
                return False
        if not bearing.ends:
            continue
        if bearing.slip:
            if bearing.slip * touch.along(key, bearing.ends[0], answer.motion, False) < -quick:
                return False
        elif not touch.frictions[key].sticks:
            most = touch.frictions[key].kinetic * answer.pressed(key)
            if abs(answer.friction[key]) > most + push:
                return False
    return True


def hooked_strike(touch: Touch) -> tuple[Pattern, Answer]:
    """Return the impact in which sticking interfaces are held although nothing presses there."""
    hooked = tuple(k for k in INTERFACES if touch.frictions[k].sticks and touch.touching[k])
    senses = {key: (0,) if touch.frictions[key].sticks else (0, 1, -1) for key in INTERFACES}
    best = None
    speed = touch.speed
    for pattern in patterns(touch.touching, senses):
        try:
            answer = touch.solve(pattern, speed, turning=False, hooked=hooked)
        except np.linalg.LinAlgError:
            continue
        pushes = [*answer.normal.values(), *answer.friction.values()]
        size = max((abs(one) for one in pushes), default=0.0) + 1e-300
        quick = float(np.max(np.abs(speed)))
        faults = [-push / size for push in answer.normal.values()]
        for key, end in touch.contacts:
            bearing = pattern[INTERFACES.index(key)]
            if end not in bearing.ends:
                faults.append(-touch.opening((key, end), answer.motion, False) / quick)
        for key, bearing in zip(INTERFACES, pattern, strict=True):
            if bearing.slip:
                going = touch.along(key, bearing.ends[0], answer.motion, False)
                faults.append(-bearing.slip * going / quick)
            elif bearing.ends and not touch.frictions[key].sticks:
                most = touch.frictions[key].kinetic * answer.pressed(key)
                faults.append((abs(answer.friction[key]) - most) / size)
        fault = max(faults, default=0.0)
        if best is None or fault < best[0] - 1e-12:
            best = fault, pattern, answer
    assert best is not None
    if best[0] > 1e-8:
        msg = f"no impulses stop the bodies, {best[0]:.1e}"
        raise ArithmeticError(msg)
    return best[1], best[2]


class Ended(NamedTuple):
    """What an event has ended: the bearing of an end, or the hold of an interface."""

    key: str
    end: str = ""  # of an end that no longer bears


def follow(
    touch: Touch,
    before: Pattern,
    moving: dict[str, int],
    across: float,
    up: float,
    ended: Ended | None = None,
) -> Outcome | None:
    """Return the pattern whose accelerations and forces are consistent.

    Of several the one with the fewest changed ends, then the one with the most held interfaces.

    Parameters
    ----------
    touch : Touch
    before : Pattern
    moving : dict
        Senses in which interfaces slip already, 0 without slip.
    across, up : float
        Ground acceleration [m/s²].
    ended : Ended, optional

    Returns
    -------
    Outcome or None
        None if no pattern does that.
    """  # fmt: skip
    fall = touch.fall(across, up)
    size = touch.pair.gravity + math.hypot(across, up)
    push = SLIGHT * size * min(touch.pair.masses[[0, 3]])
    senses = {
        key: (0,) if touch.frictions[key].holds else (moving[key],) if moving[key] else (0, 1, -1)
        for key in INTERFACES
    }
    # if two interfaces cease to hold at the same time, either may slip first, or both
    loose = _loose(touch, before, fall, push)
    loose = loose if len(loose) == 2 else set()
    outcomes: list[tuple[tuple[int, int], Pattern, Answer]] = []
    for pattern in patterns(touch.touching, senses):
        if ended is not None and _again(pattern, ended, loose):
            continue
        try:
            answer = touch.solve(pattern, fall, turning=True)
        except np.linalg.LinAlgError:
            continue
        if min(answer.normal.values(), default=0.0) < -push:
            continue
        if _goes(touch, pattern, answer, moving, push, SLIGHT * size):
            changed = sum(
                len(set(one.ends) ^ set(two.ends)) for one, two in zip(before, pattern, strict=True)
            )
            starts = sum(one.slip != 0 for one in pattern)
            outcomes.append(((changed, starts), pattern, answer))
    if not outcomes:
        return None
    outcomes.sort(key=lambda one: one[0])
    kept: list[tuple[Pattern, Answer]] = []
    for _, pattern, answer in outcomes:
        # static friction exceeds kinetic friction: an interface that may stay held stays held
        if any(_freer(pattern, other, loose) for other, _ in kept):
            continue
        if not any(np.max(np.abs(answer.motion - one.motion)) < 1e-7 * size for _, one in kept):
            kept.append((pattern, answer))
    return Outcome(*kept[0], len(kept), others=tuple(one[0] for one in kept[1:]))


def _loose(touch: Touch, before: Pattern, fall, push: float) -> set[str]:
    """Return the held interfaces that static friction cannot hold, or only just."""
    try:
        answer = touch.solve(before, fall, turning=True)
    except np.linalg.LinAlgError:
        return set()
    return {
        key
        for key, bearing in zip(INTERFACES, before, strict=True)
        if bearing.ends and not bearing.slip and not touch.frictions[key].holds
        and abs(answer.friction[key]) >= touch.frictions[key].static * answer.pressed(key) - push
    }  # fmt: skip


def _again(pattern: Pattern, ended: Ended, loose: set[str]) -> bool:
    """Tell whether a pattern continues what has ended."""
    if ended.end:
        return ended.end in pattern[INTERFACES.index(ended.key)].ends
    held = [key for key, one in zip(INTERFACES, pattern, strict=True) if one.ends and not one.slip]
    return set(held) >= (loose or {ended.key})


def _freer(pattern: Pattern, other: Pattern, loose: set[str]) -> bool:
    """Tell whether a pattern slips where another one with the same ends holds."""
    both = list(zip(INTERFACES, pattern, other, strict=True))
    freed = {key for key, one, two in both if one.slip != two.slip}
    return (
        all(one.ends == two.ends and (one.slip == two.slip or not two.slip) for _, one, two in both)
        and pattern != other
        and not freed <= loose
    )


def _goes(touch: Touch, pattern, answer, moving, push: float, slight: float) -> bool:
    """Tell whether ends that do not bear separate and interfaces obey friction."""
    for key, bearing in zip(INTERFACES, pattern, strict=True):
        for end in touch.touching[key]:
            if end not in bearing.ends and touch.opening((key, end), answer.motion, True) < -slight:
                return False
        if not bearing.ends:
            continue
        if bearing.slip:
            going = touch.along(key, bearing.ends[0], answer.motion, True)
            if not moving[key] and bearing.slip * going < -slight:
                return False
        elif not touch.frictions[key].holds:
            most = touch.frictions[key].static * answer.pressed(key)
            if abs(answer.friction[key]) > most + push:
                return False
    return True
