"""The bodies, their kinematics in the coordinates of a pattern, and their contact forces."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

GRAVITY = 9.80665
ENDS = ("left", "right")
MEMBERS = {"both": ENDS, "left": ("left",), "right": ("right",), "none": ()}
SIGN = {"left": -1.0, "right": 1.0}


class Body(NamedTuple):
    """A body with a straight base and a straight top, both as wide.

    Parameters
    ----------
    mass : float
        [kg]
    inertia : float
        About the centre of mass [kg m²].
    half_width : float
        Of base and top [m].
    below, above : float
        From the centre of mass down to the base, and up to the top [m].
    beside : float
        Distance of the centre of mass to the right of the middle [m].
    """

    mass: float
    inertia: float
    half_width: float
    below: float
    above: float
    beside: float = 0.0

    @classmethod
    def uniform(cls, width: float, height: float, mass: float) -> "Body":
        """Return a homogeneous rectangle."""
        inertia = mass * (width**2 + height**2) / 12.0
        return cls(mass, inertia, 0.5 * width, 0.5 * height, 0.5 * height)

    def from_centre(self, across: float, up: float) -> tuple[float, float]:
        """Return a point, measured from the middle of the width, from the centre of mass."""
        return across - self.beside, up


class Pattern(NamedTuple):
    """The bearing ends of the lower body on the ground and of the upper one on the lower one."""

    ground: str
    joint: str


@dataclass(frozen=True)
class Pair:
    """Two bodies; the upper middle is `offset` to the right of the lower one."""

    lower: Body
    upper: Body
    offset: float = 0.0
    gravity: float = GRAVITY

    @property
    def masses(self) -> np.ndarray:
        """Inertia of each of the six coordinates."""
        lower, upper = self.lower, self.upper
        return np.array(
            [lower.mass, lower.mass, lower.inertia, upper.mass, upper.mass, upper.inertia]
        )

    @property
    def weights(self) -> np.ndarray:
        """Vertical masses, as a vector of the six coordinates."""
        return np.array([0.0, self.lower.mass, 0.0, 0.0, self.upper.mass, 0.0])

    @property
    def limits(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Rotations to the left and right at which the lower and the upper body overturn.

        The lower one together with the upright upper one as one body; the upper one alone.
        """
        lower, upper = self.lower, self.upper
        total = lower.mass + upper.mass
        foot = (lower.mass * lower.beside + upper.mass * (self.offset + upper.beside)) / total
        level = lower.mass * lower.below + upper.mass * (lower.below + lower.above + upper.below)
        level /= total
        sides = []
        for half, across, up in (
            (lower.half_width, foot, level),
            (upper.half_width, upper.beside, upper.below),
        ):
            sides.append((-math.atan((half + across) / up), math.atan((half - across) / up)))
        return sides[0], sides[1]

    @property
    def slowness(self) -> float:
        """Shortest characteristic time of rotation: sqrt(size over gravity) [s]."""
        sizes = (math.hypot(one.half_width, one.below) for one in (self.lower, self.upper))
        return math.sqrt(min(sizes) / self.gravity)

    def mirrored(self) -> "Pair":
        """Return the mirror image of the pair."""
        return replace(
            self,
            lower=self.lower._replace(beside=-self.lower.beside),
            upper=self.upper._replace(beside=-self.upper.beside),
            offset=-self.offset,
        )

    def energy(self, place, speed) -> float:
        """Return kinetic energy and that of gravity [J]."""
        return float(0.5 * self.masses @ speed**2 + self.gravity * self.weights @ place)


def turned(angle: float, across: float, up: float) -> tuple[float, float]:
    """Turn a vector clockwise."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return across * cosine + up * sine, up * cosine - across * sine


class Seats(NamedTuple):
    """Contact points at each end, from the centres of mass."""

    ground: dict  # of the lower body
    below: dict  # of the lower body, at the joint
    above: dict  # of the upper body, at the joint
    edge: dict  # whether the upper base bears on an edge of the lower top


def seats_of(pair: Pair, shift: float) -> Seats:
    """Return the points of contact when the upper body is shifted by `shift` on the lower one."""
    lower, upper = pair.lower, pair.upper
    ground, below, above, edge = {}, {}, {}, {}
    for end, way in SIGN.items():
        ground[end] = lower.from_centre(way * lower.half_width, -lower.below)
        own = shift + way * upper.half_width
        edge[end] = way * own > lower.half_width * (1.0 + 1e-12)
        across = way * lower.half_width if edge[end] else own
        below[end] = lower.from_centre(across, lower.above)
        above[end] = upper.from_centre(across - shift, -upper.below)
    return Seats(ground, below, above, edge)


class Phase:
    """A pair in one pattern, with minimal coordinates.

    A body on an edge has its rotation as coordinate; one on its whole base has none; one in flight
    has three.

    Parameters
    ----------
    pair : Pair
    pattern : Pattern
    shift : float
        Of the upper body on the lower one [m].
    anchor : float
        Position of the middle of the lower base on the ground if it were upright [m].
    """

    def __init__(self, pair: Pair, pattern: Pattern, shift: float, anchor: float = 0.0):
        self.pair, self.pattern, self.shift, self.anchor = pair, pattern, shift, anchor
        self.seats = seats_of(pair, shift)
        counts = {"both": 0, "left": 1, "right": 1, "none": 3}
        self.of_lower = counts[pattern.ground]
        self.size = self.of_lower + counts[pattern.joint]
        self.masses, self.weights = pair.masses, pair.weights

    def placed(self, q) -> np.ndarray:
        """Return the six places from the coordinates."""
        ground, joint = self.pattern
        x1, y1, turn = q[:3] if ground == "none" else (0.0, 0.0, q[0] if self.of_lower else 0.0)
        if ground != "none":
            end = "left" if ground == "both" else ground
            across, up = self.seats.ground[end]
            lever = turned(turn, across, up)
            x1 = self.anchor + SIGN[end] * self.pair.lower.half_width - lever[0]
            y1 = -lever[1]
        if joint == "none":
            return np.array([x1, y1, turn, *q[self.of_lower :]])
        other = turn if joint == "both" else q[self.of_lower]
        end = "left" if joint == "both" else joint
        base = turned(turn, *self.seats.below[end])
        lever = turned(other, *self.seats.above[end])
        x2, y2 = x1 + base[0] - lever[0], y1 + base[1] - lever[1]
        return np.array([x1, y1, turn, x2, y2, other])

    def coordinates(self, place) -> np.ndarray:
        """Return the coordinates from the six places, or their rates from the six velocities."""
        ground, joint = self.pattern
        first = () if ground == "both" else place[:3] if ground == "none" else place[2:3]
        second = () if joint == "both" else place[3:6] if joint == "none" else place[5:6]
        return np.array([*first, *second])

    def motions(self, first: float, second: float, rate: float = 0.0, other: float = 0.0):
        """Return the velocities per rate, and the accelerations at constant rates.

        Parameters
        ----------
        first, second : float
            Rotations [rad].
        rate, other : float
            Their rates [rad/s].

        Returns
        -------
        tuple of numpy.ndarray
            Shapes (6, coordinates) and (6,).
        """
        ground, joint = self.pattern
        jac, bend = np.zeros((6, self.size)), np.zeros(6)
        ax = ay = 0.0  # the lower centre of mass, from the bearing end on the ground
        if ground in SIGN:
            ax, ay = turned(first, *self.seats.ground[ground])
            ax, ay = -ax, -ay
            jac[:3, 0] = ay, -ax, 1.0
            bend[:2] = -(rate**2) * ax, -(rate**2) * ay
        elif ground == "none":
            jac[0, 0] = jac[1, 1] = jac[2, 2] = 1.0
        k = self.of_lower
        if joint == "none":
            jac[3, k] = jac[4, k + 1] = jac[5, k + 2] = 1.0
            return jac, bend
        end = "left" if joint == "both" else joint
        px, py = turned(first, *self.seats.below[end])
        cx, cy = turned(second, *self.seats.above[end])
        arm = (px - cx, py - cy) if joint == "both" else (px, py)
        if k:  # the upper body moves with the lower one
            jac[3, :k], jac[4, :k] = jac[0, :k], jac[1, :k]
            jac[3, k - 1] += arm[1]
            jac[4, k - 1] -= arm[0]
            bend[3] = bend[0] - rate**2 * arm[0]
            bend[4] = bend[1] - rate**2 * arm[1]
        if joint != "both":
            jac[3:, k] = -cy, cx, 1.0
            bend[3] += other**2 * cx
            bend[4] += other**2 * cy
        elif k:
            jac[5, k - 1] = 1.0
        return jac, bend

    def accelerate(self, first, second, rate, other, across, up):
        """Solve Lagrange's equations.

        Parameters
        ----------
        first, second, rate, other : float
            Rotations and their rates.
        across, up : float
            Ground acceleration [m/s²].

        Returns
        -------
        tuple of numpy.ndarray
            Second derivatives of the coordinates, and accelerations of the six places.
        """
        jac, bend = self.motions(first, second, rate, other)
        if not self.size:
            return np.zeros(0), bend
        g = self.pair.gravity + up
        virtual = jac.T * self.masses
        fall = np.array([-across, -g, 0.0, -across, -g, 0.0])
        second_rates = np.linalg.solve(virtual @ jac, virtual @ (fall - bend))
        return second_rates, jac @ second_rates + bend

    def needed(self, acceleration, across, up) -> np.ndarray:
        """Return the resultants of contact forces on each body required by accelerations."""
        g = self.pair.gravity + up
        lift = np.array([across, g, 0.0, across, g, 0.0])
        return self.masses * (acceleration + lift)

    def pressures(self, place, resultants) -> dict:
        """Return the normal force of each bearing end.

        Under a full base the two ends share the force so that its moment is right.

        Parameters
        ----------
        place : numpy.ndarray
            The six places.
        resultants : numpy.ndarray
            Force and clockwise moment about the centre of mass on each body, or impulses [N, N m].

        Returns
        -------
        dict
            By interface and end.
        """
        pair, pressures = self.pair, {}
        x2, y2, moment = (float(one) for one in resultants[3:])
        if self.pattern.joint != "none":
            shares = _shared(
                self.pattern.joint, (x2, y2, moment), place[5], pair.upper.below,
                {end: point[0] for end, point in self.seats.above.items()},
            )  # fmt: skip
            for end, share in shares.items():
                if self.pattern.joint != "both" and not self.seats.edge[end]:
                    normal = turned(place[2], 0.0, 1.0)
                    share = normal[0] * x2 + normal[1] * y2
                pressures["joint", end] = share
        if self.pattern.ground != "none":
            rx, ry = place[3] - place[0], place[4] - place[1]
            x1, y1 = resultants[0] + x2, resultants[1] + y2
            turn = resultants[2] + moment + ry * x2 - rx * y2
            shares = _shared(
                self.pattern.ground, (x1, y1, turn), 0.0, pair.lower.below,
                {end: point[0] for end, point in self.seats.ground.items()},
            )  # fmt: skip
            pressures.update({("ground", end): share for end, share in shares.items()})
        return pressures


def _shared(ends, resultant, angle, below, seats) -> dict:
    """Share a force and its moment about the centre of mass between the ends of a base."""
    tangent, normal = turned(angle, 1.0, 0.0), turned(angle, 0.0, 1.0)
    along = tangent[0] * resultant[0] + tangent[1] * resultant[1]
    push = normal[0] * resultant[0] + normal[1] * resultant[1]
    if ends != "both":
        return {ends: push}
    at = -below * along - resultant[2]  # force times its position
    width = seats["right"] - seats["left"]
    return {
        "left": (seats["right"] * push - at) / width,
        "right": (at - seats["left"] * push) / width,
    }
