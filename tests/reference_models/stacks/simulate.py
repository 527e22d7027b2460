"""A run of a stack: advance to an event, switch, continue."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from reference_models.maximal.excitation import RECORD, ground
from reference_models.maximal.simulate import Excitation

from .contact import BASE_GUARDS, CHATTER, FIRED, OVERTURNED, ContactState, Room
from .driver import STOP, TIME, Course, advance
from .forces import base_force
from .guards import noise_levels
from .impulses import kinetic, relate
from .scene import Scene, Stack, stack_of
from .starting import start
from .stepping import Motion, path_of
from .switches import Events

TOLERANCE = 1e-13
MOST_EVENTS = 50000
AT_ONCE = 400


class Event(NamedTuple):
    """A switch at a base; bases are numbered from the top down."""

    time: float
    base: int
    kind: str
    lost: float  # kinetic energy


@dataclass(frozen=True)
class History:
    """Histories at the output times, up to the end of the run; bodies are from the top down."""

    time: np.ndarray
    place: np.ndarray  # (n, bodies, 3): x and y of the centre of mass from rest, rotation
    rates: np.ndarray
    dissipated: np.ndarray  # without the losses at events
    supplied: np.ndarray
    events: list[Event]
    status: int
    end: float
    start_energy: float
    end_energy: float

    @property
    def rotation(self) -> np.ndarray:
        """Rotations of all bodies."""
        return self.place[:, :, 2]

    @property
    def peaks(self) -> np.ndarray:
        """Greatest rotation of each body at the output times."""
        return np.abs(self.rotation).max(axis=0)

    @property
    def overturned(self) -> bool:
        """Whether a body reached its limit."""
        return self.status == OVERTURNED

    @property
    def lost(self) -> float:
        """Kinetic energy lost at events."""
        return math.fsum(event.lost for event in self.events)

    @property
    def imbalance(self) -> float:
        """Error of the energy balance, over the largest energy exchanged."""
        lost, supplied = self.lost + self.dissipated[-1], self.supplied[-1]
        residual = self.end_energy + lost - self.start_energy - supplied
        return residual / max(abs(lost), abs(supplied), abs(self.start_energy))


def simulate(scene: Scene, motion: Excitation, tolerance: float = TOLERANCE) -> History:
    """Run a scene.

    Parameters
    ----------
    scene : Scene
    motion : Excitation
    tolerance : float
        Of one step, relative to the largest value so far.

    Returns
    -------
    History
    """
    stack = stack_of(scene, tolerance)
    z, contact, room = start(scene, stack)
    stops, pieces = _stops(motion, scene.free)
    states = np.zeros((stops.size, z.size))
    states[0] = z
    initial_energy = energy(z, stack, contact, room)
    course = Course(
        np.array([0.0, 0.02 / stack.pace, 0.0, 0.0, 0.0]), stops, pieces, states,
        np.maximum(_typical_sizes(stack), np.abs(z)), motion.longest,
    )  # fmt: skip
    shaking = Motion(motion.shape, motion.across, motion.upwards)
    status, events = _run(course, z, shaking, stack, contact, room)
    reached = int(course.clock[STOP]) + 1
    n, count = stack.mass.size, stack.inverse.size
    states = states[:reached]
    return History(
        time=stops[:reached],
        place=states[:, : 3 * n].reshape(-1, n, 3),
        rates=states[:, count : count + 3 * n].reshape(-1, n, 3),
        dissipated=np.append(states[:, 2 * count], z[2 * count]),
        supplied=np.append(states[:, 2 * count + 1], z[2 * count + 1]),
        events=events,
        status=status,
        end=float(course.clock[TIME]),
        start_energy=initial_energy,
        end_energy=energy(z, stack, contact, room),
    )


def _run(course, z, motion, stack, contact, room) -> tuple[int, list[Event]]:
    n, clock = stack.mass.size, course.clock
    guards = BASE_GUARDS * n + len(stack.ties) + 1
    path, noise = path_of(z.size, guards), np.zeros(guards)
    events: list[Event] = []
    since, count = -1.0, 0
    while True:
        status, slot = advance(course, z, motion, stack, contact, room, path)
        if status != FIRED:
            return status, events
        t = float(clock[TIME])
        count = count + 1 if t - since < 1e-12 else 0
        since = t
        if count > AT_ONCE or len(events) == MOST_EVENTS:
            return CHATTER, events
        if slot >= BASE_GUARDS * n:  # the force of a tie has a kink
            contact.taut[slot - BASE_GUARDS * n] *= -1.0
            continue
        noise_levels(z, stack, noise)
        shaken = ground(t, course.pieces[int(clock[STOP])], *motion)
        before = kinetic(z, stack)
        kind = Events(z, shaken, stack, contact, room, noise).fire(slot)
        events.append(Event(t, slot // BASE_GUARDS, kind, before - kinetic(z, stack)))


def _stops(motion: Excitation, free: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the times at which steps end, and the parts of the motion between them."""
    total = motion.intervals * motion.step + free
    count = math.ceil(total / motion.step * (1.0 - 1e-12))
    stops = motion.step * np.arange(count + 1)
    stops[-1] = total
    pieces = np.arange(count)
    if int(motion.shape[0]) != RECORD:
        pieces = np.zeros(count, dtype=np.int64)
    pieces[motion.intervals :] = -1
    return stops, pieces


def _typical_sizes(stack: Stack) -> np.ndarray:
    """Return the smallest reference sizes for the error of each variable."""
    n = stack.mass.size
    small = 1e-4 * min(0.5, np.abs(stack.limits).min())
    sizes = []
    for k in range(n):
        length = max(stack.height[k], 0.5 * stack.height[0])
        sizes.append((small * length, small * length, small, math.sqrt(stack.gravity / length)))
    places = [each for one in sizes for each in one[:3]] + [1.0] * 3
    rates = [each * one[3] for one in sizes for each in one[:3]] + [1.0] * 3
    return np.array(places + rates + [1.0, 1.0])


def energy(z: np.ndarray, stack: Stack, contact: ContactState, room: Room) -> float:
    """Return the sum of kinetic energy and of the energies of gravity and springs."""
    relate(z, stack, room)
    total = kinetic(z, stack)
    for k in range(stack.mass.size):
        total += stack.mass[k] * stack.gravity * z[3 * k + 1]
        total += base_force(k, stack, contact.ends, room)[3]
    return total
