"""Selects the pattern after an impact or a change of the forces by trying all patterns."""

import math
from itertools import combinations, product
from typing import NamedTuple

import numpy as np

from .pair import ENDS, MEMBERS, Pattern, Phase, Seats, turned

SMALL = 1e-10
"""Forces and speeds below this share of the largest count as zero."""

Touching = dict[str, tuple[str, ...]]
"""The touching ends of the ground and of the joint."""


class Outcome(NamedTuple):
    """The selected pattern, with the six velocities or accelerations.

    ``admissible`` counts the patterns whose released ends open and whose bearing ends press;
    ``lost`` is the energy lost [J]; ``others`` are the admissible ones not selected.
    """

    pattern: Pattern
    motion: np.ndarray
    admissible: int
    lost: float = 0.0
    others: tuple = ()


def name_of(ends) -> str:
    """Return the name of a set of ends."""
    return "both" if len(ends) == 2 else ends[0] if ends else "none"


def patterns(touching: Touching) -> list[Pattern]:
    """Return all patterns in which some of the touching ends bear."""
    subsets = {
        key: [name_of(some) for count in (2, 1, 0) for some in combinations(ends, count)]
        for key, ends in touching.items()
    }
    return [Pattern(*one) for one in product(subsets["ground"], subsets["joint"])]


def normal_rows(seats: Seats, place, touching: Touching) -> tuple[list, np.ndarray]:
    """Return the rows that give opening speeds of all touching ends from six velocities."""
    names, rows = [], []
    for end in touching["ground"]:
        _, row = _rows(place, seats.ground[end], None, 0.0)
        names.append(("ground", end))
        rows.append(row)
    for end in touching["joint"]:
        slope = place[5] if seats.edge[end] else place[2]
        _, row = _rows(place, seats.below[end], seats.above[end], slope)
        names.append(("joint", end))
        rows.append(row)
    return names, np.array(rows).reshape(len(rows), 6)


def tangent_rows(seats: Seats, place, touching: Touching) -> np.ndarray:
    """Return the rows that give slip speeds, one for each touching interface."""
    rows = []
    if touching["ground"]:
        rows.append(_rows(place, seats.ground[touching["ground"][0]], None, 0.0)[0])
    if touching["joint"]:
        end = touching["joint"][0]
        slope = place[5] if seats.edge[end] else place[2]
        rows.append(_rows(place, seats.below[end], seats.above[end], slope)[0])
    return np.array(rows).reshape(len(rows), 6)


def _rows(place, point, other_point, slope):
    """Rows along and normal to a slope; of one point on the ground, or of two bodies' points."""
    rows = []
    for direction in (turned(slope, 1.0, 0.0), turned(slope, 0.0, 1.0)):
        x, y = turned(place[2], *point)
        row = np.zeros(6)
        row[:3] = direction[0], direction[1], direction[0] * y - direction[1] * x
        if other_point is not None:
            x, y = turned(place[5], *other_point)
            row = -row
            row[3:] = direction[0], direction[1], direction[0] * y - direction[1] * x
        rows.append(row)
    return rows


def strike(pair, shift, place, speed, touching: Touching, anchor=0.0) -> Outcome:
    """Return the outcome of a plastic impact without sliding.

    This is the only admissible pattern; of several the one that loses least energy; for none the
    result of `complementary`.

    Parameters
    ----------
    pair : Pair
    shift : float
        Of the upper body on the lower one [m].
    place, speed : numpy.ndarray
        Of the six coordinates, before.
    touching : dict
        Which ends touch.
    """
    seats = Phase(pair, Pattern("both", "both"), shift).seats
    names, rows = normal_rows(seats, place, touching)
    masses = pair.masses
    before = 0.5 * float(masses @ speed**2)
    arms = math.hypot(pair.upper.half_width, pair.upper.below)
    quick = SMALL * math.sqrt(2.0 * before / masses[[0, 3]].max()) + 1e-300
    push = quick * masses[[0, 3]].min()
    quick = max(quick, SMALL * arms * float(np.max(np.abs(speed[[2, 5]]))))
    outcomes: list[tuple] = []
    for pattern in patterns(touching):
        phase = Phase(pair, pattern, shift, anchor)
        after = projected(phase, place, speed)
        pressures = phase.pressures(place, masses * (after - speed))
        if not _is_admissible(pressures, names, rows @ after, push, quick):
            continue
        lost = before - 0.5 * float(masses @ after**2)
        if not any(np.max(np.abs(after - outcome[1])) < 100.0 * quick for outcome in outcomes):
            outcomes.append((pattern, after, lost))
    if not outcomes:
        pattern, after = complementary(seats, masses, place, speed, touching)
        return Outcome(pattern, after, 0, before - 0.5 * float(masses @ after**2))
    outcomes.sort(key=lambda outcome: outcome[2])
    pattern, after, lost = outcomes[0]
    return Outcome(pattern, after, len(outcomes), lost, tuple(outcomes[1:]))


def projected(phase: Phase, place, speed) -> np.ndarray:
    """Return the six velocities after all contacts of a pattern close at once: (B'MB)^-1 B'M v."""
    jac, _ = phase.motions(place[2], place[5])
    if not phase.size:
        return np.zeros(6)
    virtual = jac.T * phase.masses
    return jac @ np.linalg.solve(virtual @ jac, virtual @ speed)


def _is_admissible(pressures, names, openings, push, quick) -> bool:
    for name, opening in zip(names, openings, strict=True):
        if name in pressures:
            if pressures[name] < -push:
                return False
        elif opening < -quick:
            return False
    return True


def complementary(seats, masses, place, speed, touching: Touching):
    """Hold all touching interfaces against slip, with normal impulses that only push.

    A linear complementarity problem, solved by trying all sets of ends that press. An interface
    may be held along itself although no end of it presses.

    Returns
    -------
    tuple
        Pattern and six velocities.
    """
    names, rows = normal_rows(seats, place, touching)
    slips = tangent_rows(seats, place, touching)
    best, quick = None, 1e-6 * float(np.max(np.abs(rows) @ np.abs(speed))) + 1e-300
    quick += float(np.max(np.abs(rows @ speed)))
    for count in range(len(names) + 1):
        for active in combinations(range(len(names)), count):
            holds = np.vstack([slips, rows[list(active)]])
            answer = holds / masses
            impulses = np.linalg.solve(holds @ answer.T, -holds @ speed)
            after = speed + answer.T @ impulses
            pushes = impulses[len(slips) :]
            size = quick * masses[[0, 3]].min()
            size += float(np.max(np.abs(impulses), initial=0.0))
            fault = -min(pushes.min(initial=0.0) / size, (rows @ after).min(initial=0.0) / quick)
            if best is None or fault < best[0] - 1e-12:
                best = fault, active, after
    fault, active, after = best
    if fault > 1e-8:
        msg = f"the impulses are not complementary, {fault:.1e}"
        raise ArithmeticError(msg)
    ends = {key: tuple(names[i][1] for i in active if names[i][0] == key) for key in touching}
    return Pattern(name_of(ends["ground"]), name_of(ends["joint"])), after


def choose_pattern(phase: Phase, place, speed, touching, across, up, apart=None) -> Outcome | None:
    """Return the pattern whose released ends open and whose bearing ends press.

    Parameters
    ----------
    phase : Phase
        Before.
    place, speed : numpy.ndarray
        Of the six coordinates; touching ends have no relative motion.
    touching : dict
        Which ends touch.
    across, up : float
        Ground acceleration [m/s²].
    apart : tuple, optional
        Interface and end that no longer bears.

    Returns
    -------
    Outcome or None
        None if no pattern does that.
    """
    pair, outcomes = phase.pair, []
    names, rows = normal_rows(phase.seats, place, touching)
    size = pair.gravity + math.hypot(across, up)
    push = 1e-9 * size * phase.masses[[0, 3]].min()
    for pattern in patterns(touching):
        ends = {"ground": MEMBERS[pattern.ground], "joint": MEMBERS[pattern.joint]}
        if apart is not None and apart[1] in ends[apart[0]]:
            continue
        one = Phase(pair, pattern, phase.shift, phase.anchor)
        _, after = one.accelerate(place[2], place[5], speed[2], speed[5], across, up)
        pressures = one.pressures(place, one.needed(after, across, up))
        opening = rows @ after + _turning(phase.seats, place, speed, names)
        if _is_admissible(pressures, names, opening, push, 1e-9 * size):
            outcomes.append((pattern, after))
    if not outcomes:
        return None
    kept = []
    for one in outcomes:
        if not any(np.max(np.abs(one[1] - other[1])) < 1e-7 * size for other in kept):
            kept.append(one)
    return Outcome(*kept[0], len(kept), others=tuple(kept[1:]))


def _turning(seats: Seats, place, speed, names) -> np.ndarray:
    """Return the opening accelerations from rotation at constant rates."""
    openings = []
    for key, end in names:
        if key == "ground":
            y = turned(place[2], *seats.ground[end])[1]
            openings.append(-(speed[2] ** 2) * y)
            continue
        normal = turned(place[5] if seats.edge[end] else place[2], 0.0, 1.0)
        p, c = turned(place[2], *seats.below[end]), turned(place[5], *seats.above[end])
        openings.append(
            sum(
                n * (speed[2] ** 2 * a - speed[5] ** 2 * b)
                for n, a, b in zip(normal, p, c, strict=True)
            )
        )
    return np.array(openings)


def touching_of(pattern: Pattern) -> Touching:
    """Return the ends that touch while a pattern lasts."""
    return {"ground": MEMBERS[pattern.ground], "joint": MEMBERS[pattern.joint]}


ALL: Touching = {"ground": ENDS, "joint": ENDS}
