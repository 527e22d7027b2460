"""The steps from stop to stop, up to the next event."""

import math

import numpy as np

from .bed import cut_off
from .compiling import compiled
from .events import due
from .excitation import ground
from .forces import has_lower
from .guard_search import SAMPLES, earliest, sample_guards
from .guards import evaluate, noise_levels
from .impulses import tidy
from .layout import (
    COMPLETED,
    CUT_GUARDS,
    FIRED,
    GRAVITY,
    GUARDS,
    HALF_HEIGHT,
    HELD,
    HOLD,
    KIND,
    LIMIT,
    LIMIT_GUARD,
    LOWER_HEIGHT,
    OVERTURNED,
    RIGID,
    STATES,
    TOLERANCE,
    TOO_SMALL,
)
from .rigid_switches import place_hinged
from .runge_kutta import rates, step

TIME, STEP, STOP, PACE, LONGEST = range(5)


@compiled
def advance(clock, stops, pieces, motion, z, contact, held, p, room, largest, states):
    """Integrate until a switch is due or the run is over.

    Parameters
    ----------
    clock : ndarray, shape (5,)
        Time, step, number of the last stop, highest angular frequency, longest step; the first
        three are changed.
    stops : ndarray, shape (n,)
        Times at which steps end: output times and kinks of the motion.
    pieces : ndarray, shape (n - 1,)
        The part of the motion that applies between two stops.
    motion : tuple of ndarray
        See `excitation.ground`.
    z, contact, held, p : ndarray
        State, contact, held points, parameters; the state is changed.
    room : tuple of ndarray
        Work arrays of `forces.accelerate`.
    largest : ndarray
        Greatest size of each variable so far, changed.
    states : ndarray, shape (n, STATES)
        Filled with the states at the stops.

    Returns
    -------
    tuple
        Status of the end, and the guard if a switch is due.
    """
    out, guards, noise = np.zeros(10), np.zeros(GUARDS), np.zeros(GUARDS)
    armed = np.zeros(GUARDS, dtype=np.bool_)
    first, last, scale = np.zeros(STATES), np.zeros(STATES), np.ones(STATES)
    new, trial, inner = np.zeros(STATES), np.zeros(STATES), np.zeros(STATES)
    slopes, samples = np.zeros((13, STATES)), np.zeros((SAMPLES + 1, GUARDS))
    t, i, pace = clock[TIME], int(clock[STOP]), clock[PACE]
    h = min(clock[STEP], 0.05 / pace)
    restart = True
    fired_guard, where = -1, 0.0
    noise_levels(z, p, noise)
    if has_lower(p):
        cut_off(contact, z, p, noise[CUT_GUARDS])
    while i < stops.size - 1:
        piece, goal = pieces[i], stops[i + 1]
        if restart:
            gx, gy = ground(t, piece, motion[0], motion[1], motion[2])
            evaluate(z, gx, gy, contact, held, p, room, out, guards)
            slot = due(z, contact, p, room, guards, noise)
            if slot >= 0:
                clock[TIME], clock[STEP], clock[STOP] = t, h, i
                return FIRED, slot
            for j in range(GUARDS):
                armed[j] = armed[j] or guards[j] > noise[j]
            rates(t, z, piece, motion, contact, held, p, room, out, first)
            restart = False
        for j in range(STATES):
            largest[j] = max(largest[j], abs(z[j]))
            scale[j] = p[TOLERANCE] * largest[j]
        rest = goal - t
        h = min(h, clock[LONGEST])
        ends = h >= rest * (1.0 - 1e-12)
        take = rest if ends else min(h, 0.5 * rest)
        if fired_guard >= 0:
            take = where
        elif take < 1e-15 * max(1.0, t) and not ends:
            return TOO_SMALL, -1
        worst = step(
            t, take, z, first, piece, motion, contact, held, p, room, out, slopes, scale, new
        )
        if fired_guard >= 0:
            z[:] = new
            clock[TIME], clock[STEP], clock[STOP] = t + take, h, i
            if fired_guard == LIMIT_GUARD:
                states[i + 1] = z
                return OVERTURNED, fired_guard
            if int(p[KIND]) != RIGID:
                tidy(z, contact, held, p, room)
            return FIRED, fired_guard
        if not worst <= 1.0:
            h = take * (0.2 if not worst < 1e8 else max(0.2, 0.9 * worst ** (-0.125)))
            continue
        rates(t + take, new, piece, motion, contact, held, p, room, out, last)
        sample_guards(
            t, take, z, first, new, last, piece, motion, contact, held, p, room, out, inner, samples
        )
        fired_guard, where = earliest(
            t, take, z, first, piece, motion, contact, held, p, room, out, slopes, scale, trial,
            guards, armed, noise, samples,
        )  # fmt: skip
        if fired_guard == -2:
            # a guard that was zero is negative at the first sample: take shorter steps
            fired_guard = -1
            h = take / SAMPLES
            if take < 1e-9 / pace:
                clock[TIME], clock[STEP], clock[STOP] = t, h, i
                return FIRED, int(where)
            continue
        if fired_guard >= 0:
            continue
        z[:] = new
        t = goal if ends else t + take
        if int(p[KIND]) != RIGID:
            tidy(z, contact, held, p, room)
        elif contact[HOLD] == HELD:
            place_hinged(z, held, p)
        first[:] = last
        for j in range(GUARDS):
            armed[j] = armed[j] or samples[SAMPLES, j] > noise[j]
        grown = take * (5.0 if worst < 1e-6 else min(5.0, 0.9 * worst ** (-0.125)))
        h = max(h, grown) if ends else grown
        if ends:
            i += 1
            states[i] = z
            restart = True
            noise_levels(z, p, noise)
    clock[TIME], clock[STEP], clock[STOP] = t, h, i
    return COMPLETED, -1


@compiled
def typical_sizes(p):
    """Return the smallest reference sizes for the error of each variable."""
    sizes = np.ones(STATES)
    for k in range(2):
        level = p[HALF_HEIGHT] if k == 1 else p[LOWER_HEIGHT]
        level = max(level, 0.5 * p[HALF_HEIGHT])
        rate = math.sqrt(p[GRAVITY] / level)
        small = 1e-4 * p[LIMIT]
        sizes[3 * k] = sizes[3 * k + 1] = small * level
        sizes[3 * k + 2] = small
        sizes[6 + 3 * k] = sizes[7 + 3 * k] = small * level * rate
        sizes[8 + 3 * k] = small * rate
    return sizes
