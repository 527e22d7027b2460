"""The steps from stop to stop, up to the next event."""

from typing import NamedTuple

import numpy as np
from reference_models.maximal.compiling import compiled
from reference_models.maximal.excitation import ground
from reference_models.maximal.watching import SAMPLES

from .guards import due, evaluate, noise_levels
from .impulses import tidy
from .standing import COMPLETED, FIRED, OVERTURNED, TOO_SMALL
from .stepping import earliest, rates, sample_guards, step

TIME, STEP, STOP = 0, 1, 2


class Course(NamedTuple):
    """Times at which steps end, and what is noted there."""

    clock: np.ndarray  # time, step, number of the last stop
    stops: np.ndarray  # output times and kinks of the motion
    pieces: np.ndarray  # which part of the motion holds between two stops
    states: np.ndarray  # at the stops
    largest: np.ndarray  # greatest size of each variable so far
    longest: float  # step


@compiled
def advance(course, z, motion, stack, standing, room, path):
    """Integrate until a switch is due or the run is over.

    Returns
    -------
    tuple
        How it ended, and the guard if a switch is due.
    """
    clock, stops = course.clock, course.stops
    t, i = clock[TIME], int(clock[STOP])
    h = min(clock[STEP], 0.05 / stack.pace)
    look_afresh, found, where = True, -1, 0.0
    path.armed[:] = False
    noise_levels(z, stack, path.noise)
    while i < stops.size - 1:
        piece, goal = course.pieces[i], stops[i + 1]
        if look_afresh:
            gx, gy = ground(t, piece, motion.shape, motion.across, motion.upwards)
            evaluate(z, gx, gy, stack, standing, room, path.guards)
            slot = due(stack, standing, room, path.guards, path.noise)
            if slot >= 0:
                clock[TIME], clock[STEP], clock[STOP] = t, h, i
                return FIRED, slot
            _arm(path, path.guards)
            rates(t, z, piece, motion, stack, standing, room, path.first)
            look_afresh = False
        for j in range(z.size):
            course.largest[j] = max(course.largest[j], abs(z[j]))
            path.scale[j] = stack.tolerance * course.largest[j]
        rest = goal - t
        h = min(h, course.longest)
        ends = h >= rest * (1.0 - 1e-12)
        take = rest if ends else min(h, 0.5 * rest)
        if found >= 0:
            take = where
        elif take < 1e-15 * max(1.0, t) and not ends:
            return TOO_SMALL, -1
        worst = step(t, take, z, piece, motion, stack, standing, room, path, path.new)
        if found >= 0:
            z[:] = path.new
            clock[TIME], clock[STEP], clock[STOP] = t + take, h, i
            if found == path.noise.size - 1:
                course.states[i + 1] = z
                return OVERTURNED, found
            tidy(z, stack, standing, room)
            return FIRED, found
        if not worst <= 1.0:
            h = take * (0.2 if not worst < 1e8 else max(0.2, 0.9 * worst ** (-0.125)))
            continue
        rates(t + take, path.new, piece, motion, stack, standing, room, path.last)
        sample_guards(t, take, z, piece, motion, stack, standing, room, path)
        found, where = earliest(t, take, z, piece, motion, stack, standing, room, path)
        if found == -2:
            # a guard that stood at zero is negative at the first look: look closer
            found = -1
            h = take / SAMPLES
            if take < 1e-9 / stack.pace:
                clock[TIME], clock[STEP], clock[STOP] = t, h, i
                return FIRED, int(where)
            continue
        if found >= 0:
            continue
        z[:] = path.new
        t = goal if ends else t + take
        tidy(z, stack, standing, room)
        path.first[:] = path.last
        _arm(path, path.samples[SAMPLES])
        grown = take * (5.0 if worst < 1e-6 else min(5.0, 0.9 * worst ** (-0.125)))
        h = max(h, grown) if ends else grown
        if ends:
            i += 1
            course.states[i] = z
            look_afresh = True
            noise_levels(z, stack, path.noise)
    clock[TIME], clock[STEP], clock[STOP] = t, h, i
    return COMPLETED, -1


@compiled
def _arm(path, guards):
    """Note which guards have been positive."""
    for j in range(guards.size):
        path.armed[j] = path.armed[j] or guards[j] > path.noise[j]
