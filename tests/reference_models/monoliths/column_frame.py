"""Columns and a beam as separate bodies joined by constraints.

Each column has three coordinates, x, y and a clockwise rotation, and so has the beam. While they
rock to the right (side 1) constraints hold the lower right corner of each column to the ground, and
its upper left one to the beam. A singular value decomposition finds the remaining freedom, and
the equations are projected on it. Nothing here knows of an equivalent column.
"""

import numpy as np


class Bodies:
    """N columns of half width b, height H, centre at h, mass m and inertia I; a beam of mass M."""

    def __init__(self, columns, b, height, centre, mass, inertia, beam):
        self.count, self.b, self.height, self.centre = columns, b, height, centre
        self.places = 3.0 * height * np.arange(columns)
        # the beam stays level, so that its inertia has no effect
        weights = [mass, mass, inertia] * columns + [beam, beam, 7.0 * mass]
        self.mass = np.array(weights)

    def places_of(self, angle, side):
        """Centres of all columns and rotation, then of the beam, at a rotation."""
        places = []
        for x in self.places:
            pivot = np.array([x + side * self.b, 0.0])
            places += [*(pivot + turned([-side * self.b, self.centre], angle)), angle]
        top = turned([-2.0 * side * self.b, self.height], angle)
        return np.array([*places, top[0] + side * self.b, top[1], 0.0])

    def jacobian(self, angle, side):
        """Rows of the velocities of all held points, per rates of all coordinates."""
        size = len(self.mass)
        rows = []
        for k, x in enumerate(self.places):
            foot = turned([side * self.b, -self.centre], angle)
            head = turned([-side * self.b, self.height - self.centre], angle)
            arm = [x - side * self.b, 0.0]  # of the beam's point, from the beam's own
            for axis in (0, 1):
                row = np.zeros(size)
                row[3 * k + axis] = 1.0
                row[3 * k + 2] = across(foot)[axis]
                rows.append(row)
                row = np.zeros(size)
                row[3 * k + axis] = 1.0
                row[3 * k + 2] = across(head)[axis]
                row[size - 3 + axis] = -1.0
                row[size - 1] = -across(arm)[axis]
                rows.append(row)
        return np.array(rows)

    def velocities(self, angle, rate, side):
        """Rates of all coordinates per unit of the one freedom that the constraints leave."""
        free = np.linalg.svd(self.jacobian(angle, side))[2][-1]
        return free * (rate / free[2])

    def tied(self, angle, side, force):
        """Loads of a tendon along the axis of each column, and its elongation.

        It goes from the ground, at the middle of the foot, to a hole there, and from a hole in the
        middle of the head to one in the beam above it.
        """
        places, size = self.places_of(angle, side), len(self.mass)
        loads, longer = np.zeros(size), 0.0
        for k, x in enumerate(self.places):
            centre, beam = places[3 * k : 3 * k + 2], places[size - 3 : size - 1]
            foot, head = (
                turned([0.0, -self.centre], angle),
                turned([0.0, self.height - self.centre], angle),
            )
            first = centre + foot - np.array([x, 0.0])
            second = beam + np.array([x + side * self.b, 0.0]) - (centre + head)
            lengths = np.hypot(*first), np.hypot(*second)
            longer += sum(lengths) / self.count
            below, above = force * first / lengths[0], force * second / lengths[1]
            loads[3 * k : 3 * k + 2] += above - below
            loads[3 * k + 2] += across(head) @ above - across(foot) @ below
            loads[size - 3 : size - 1] -= above
        return loads, longer

    def acceleration(self, angle, rate, side, ground, gravity, loads=0.0):
        """Angular acceleration of the columns, and all forces at their feet."""
        jacobian = self.jacobian(angle, side)
        bend = np.zeros(len(jacobian))
        row = 0
        for _ in self.places:
            foot = turned([side * self.b, -self.centre], angle)
            head = turned([-side * self.b, self.height - self.centre], angle)
            for axis in (0, 1):
                bend[row] = -foot[axis] * rate * rate
                bend[row + 1] = -head[axis] * rate * rate
                row += 2
        applied = np.zeros(len(self.mass))
        applied[0::3] = -self.mass[0::3] * ground[0]
        applied[1::3] = -self.mass[1::3] * (gravity + ground[1])
        applied += loads
        free = self.velocities(angle, 1.0, side)
        bent = (
            np.linalg.pinv(jacobian, rcond=1e-10) @ -bend
        )  # the minimum-norm solution of the constraints
        swing = free @ (applied - self.mass * bent) / (free @ (self.mass * free))
        accelerations = bent + swing * free
        feet = (self.mass * accelerations - applied).reshape(-1, 3)[:, :2].sum(axis=0)
        return accelerations[2], feet

    def after_impact(self, rate, side):
        """Rate after the columns land: the momentum along the new freedom is conserved."""
        before, free = self.velocities(0.0, rate, side), self.velocities(0.0, 1.0, -side)
        return free @ (self.mass * before) / (free @ (self.mass * free))


def turned(arm, angle):
    """Turn an arm clockwise."""
    sine, cosine = np.sin(angle), np.cos(angle)
    return np.array([arm[0] * cosine + arm[1] * sine, arm[1] * cosine - arm[0] * sine])


def across(arm):
    """Velocity of the end of an arm per clockwise rate."""
    return np.array([arm[1], -arm[0]])
