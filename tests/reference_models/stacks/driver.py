"""The steps from stop to stop, up to the next event."""

from typing import NamedTuple

import numpy as np
from reference_models.maximal.compiling import compiled, within
from reference_models.maximal.excitation import ground
from reference_models.maximal.guard_search import SAMPLES

from .contact import COMPLETED, FIRED, OVERTURNED, SUSPECT, TOO_SMALL
from .guard_search import earliest
from .guards import due, evaluate, noise_levels
from .impulses import tidy
from .stepping import may_fall, rates, sample_guards, step

# time, next step, number of the last stop, the step that was taken, whether it ends at a stop
TIME, STEP, STOP, TAKEN, ENDS = range(5)


class Course(NamedTuple):
    """Times at which steps end, and the states there."""

    clock: np.ndarray  # see above
    stops: np.ndarray  # output times and kinks of the motion
    pieces: np.ndarray  # which part of the motion holds between two stops
    states: np.ndarray  # at the stops
    largest: np.ndarray  # greatest size of each variable so far
    longest: float  # step


def advance(course, z, motion, stack, contact, room, path):
    """Integrate until a switch is due or the run is over.

    Returns
    -------
    tuple
        Status of the end, and the guard if a switch is due.
    """
    clock = course.clock
    clock[STEP] = min(clock[STEP], 0.05 / stack.pace)
    path.armed[:] = False
    restart = True
    while True:
        status, slot = take_steps(restart, course, z, motion, stack, contact, room, path)
        if status != SUSPECT:
            return status, slot
        restart = False
        t, take = clock[TIME], clock[TAKEN]
        piece = course.pieces[int(clock[STOP])]
        slot_found, where = earliest(t, take, z, piece, motion, stack, contact, room, path)
        if slot_found == -1:
            accept(course, z, stack, contact, room, path)
            restart = clock[ENDS] > 0.0
        elif slot_found == -2:
            # a guard that was zero is negative at the first sample: take shorter steps
            clock[STEP] = take / SAMPLES
            if take < 1e-9 / stack.pace:
                return FIRED, int(where)
        else:
            step(t, where, z, piece, motion, stack, contact, room, path, path.new)
            z[:] = path.new
            clock[TIME] = t + where
            if slot_found == path.noise.size - 1:
                return OVERTURNED, slot_found
            tidy(z, stack, contact, room)
            return FIRED, slot_found


@compiled
def take_steps(restart, course, z, motion, stack, contact, room, path):
    """Take steps until a switch is due or may be due within a step, or the run is over.

    With `restart` guards and derivatives are evaluated before the first step.
    """
    clock, stops, largest = course.clock, course.stops, course.largest
    while int(clock[STOP]) < stops.size - 1:
        i, t = int(clock[STOP]), clock[TIME]
        piece, goal = course.pieces[i], stops[i + 1]
        if restart:
            noise_levels(z, stack, path.noise)
            gx, gy = ground(t, piece, motion.shape, motion.across, motion.upwards)
            evaluate(z, gx, gy, stack, contact, room, path.guards)
            slot = due(stack, contact, room, path.guards, path.noise)
            if slot >= 0:
                return FIRED, slot
            _arm(path, path.guards)
            rates(t, z, piece, motion, stack, contact, room, path.first)
            restart = False
        for j in range(z.size):
            largest[j] = max(largest[j], abs(z[j]))
            path.scale[j] = stack.tolerance * largest[j]
        rest = goal - t
        h = min(clock[STEP], course.longest)
        ends = h >= rest * (1.0 - 1e-12)
        take = rest if ends else min(h, 0.5 * rest)
        if take < 1e-15 * max(1.0, t) and not ends:
            return TOO_SMALL, -1
        worst = step(t, take, z, piece, motion, stack, contact, room, path, path.new)
        if not worst <= 1.0:
            clock[STEP] = take * (0.2 if not worst < 1e8 else max(0.2, 0.9 * worst ** (-0.125)))
            continue
        rates(t + take, path.new, piece, motion, stack, contact, room, path.last)
        sample_guards(t, take, z, piece, motion, stack, contact, room, path)
        grown = take * (5.0 if worst < 1e-6 else min(5.0, 0.9 * worst ** (-0.125)))
        clock[TAKEN], clock[ENDS] = take, 1.0 if ends else 0.0
        clock[STEP] = max(h, grown) if ends else grown
        if may_fall(path):
            return SUSPECT, -1
        accept(course, z, stack, contact, room, path)
        restart = ends
    return COMPLETED, -1


@compiled
def accept(course, z, stack, contact, room, path):
    """Continue from the end of a step."""
    clock = course.clock
    z[:] = path.new
    tidy(z, stack, contact, room)
    path.first[:] = path.last
    _arm(path, path.samples[SAMPLES])
    clock[TIME] += clock[TAKEN]
    if clock[ENDS] > 0.0:
        clock[STOP] += 1.0
        i = int(clock[STOP])
        clock[TIME] = course.stops[i]
        course.states[i] = z


@within
def _arm(path, guards):
    """Record which guards have been positive."""
    for j in range(guards.size):
        path.armed[j] = path.armed[j] or guards[j] > path.noise[j]
