"""A run: advance to an event, switch, continue."""

import numpy as np

from .bed import bed_energy
from .driver import advance, typical_sizes
from .events import fire
from .excitation import ground
from .forces import corner, has_lower, rooms
from .guards import noise_levels
from .impulses import note_places
from .kinematics import relative
from .layout import (
    CHATTER,
    FIRED,
    GRAVITY,
    GUARDS,
    KIND,
    LOWER_MASS,
    MASS,
    RIGID,
    SETTLEMENT,
    STATES,
    STIFFNESS,
)

MOST_EVENTS = 20000
AT_ONCE = 400


def run(stops, pieces, motion, z, contact, held, p, pace, longest):
    """Integrate a scene; see `driver.advance` for the arguments.

    Returns
    -------
    tuple
        Status, time of the end, states at the stops, number of stops reached, and the events:
        time, guard, contact before and after as decimal digits, energy lost, rotation and rate.
    """
    room = rooms(p)
    states = np.zeros((stops.size, STATES))
    note_places(z, held, p, room)
    states[0] = z
    largest = np.maximum(typical_sizes(p), np.abs(z))
    clock = np.array([stops[0], 0.02 / pace, 0.0, pace, longest])
    out, noise = np.zeros(10), np.zeros(GUARDS)
    events = []
    since, count = -1.0, 0
    while True:
        status, slot = advance(
            clock, stops, pieces, motion, z, contact, held, p, room, largest, states
        )
        t, i = clock[0], int(clock[2])
        if status != FIRED:
            break
        count = count + 1 if t - since < 1e-12 else 0
        since = t
        if count > AT_ONCE or len(events) == MOST_EVENTS:
            status = CHATTER
            break
        noise_levels(z, p, noise)
        gx, gy = ground(t, pieces[i], motion[0], motion[1], motion[2])
        before, energy = _digits(contact), kinetic(z, room[2])
        fire(slot, z, gx, gy, contact, held, p, room, out, noise)
        lost = energy - kinetic(z, room[2])
        events.append((t, slot, before, _digits(contact), lost, z[5], z[11]))
    log = np.array(events).reshape(-1, 7)
    return status, t, states, i + 1, log


def _digits(contact: np.ndarray) -> float:
    return float("".join(str(digit) for digit in contact))


def kinetic(z: np.ndarray, inverse: np.ndarray) -> float:
    """Return the kinetic energy relative to the ground."""
    there = inverse > 0.0
    return 0.5 * float(np.sum(z[6:12][there] ** 2 / inverse[there]))


def stored(z: np.ndarray, contact: np.ndarray, p: np.ndarray, room) -> float:
    """Return the energy of gravity and of all springs."""
    energy = p[GRAVITY] * (p[MASS] * z[4] + p[LOWER_MASS] * z[1])
    if has_lower(p):
        energy += bed_energy(contact, z, p)[0]
    if p[MASS] > 0.0 and int(p[KIND]) != RIGID:
        relative(z, p, room[0], room[1])
        for i in range(2):
            pressed = max(0.0, p[SETTLEMENT] - corner(p, room[0], i)[0])
            energy += 0.5 * p[STIFFNESS] * pressed**2
    return energy
