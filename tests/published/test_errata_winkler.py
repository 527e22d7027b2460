"""Eq. (19) of the paper, printed and corrected, against Newton and Euler at random states.

Heights and levers are of first order in the rotation, as in the paper, and the right end
of the base is held. The soil's resultants are integrated numerically.
"""

import math
from dataclasses import dataclass

import numpy as np
import pytest

G = 9.80665
STATES = 200
EXACT = 1e-12
NODES, WEIGHTS = np.polynomial.legendre.leggauss(5)


@dataclass(frozen=True)
class State:
    """A body of mass 1 on a bed, its left end raised."""

    b: float
    h: float
    inertia: float
    k: float
    c: float
    a: float  # rotation
    y: float
    spin: float
    speed: float
    ground_x: float
    ground_y: float

    @property
    def delta(self):
        return G / (2.0 * self.b * self.k)

    @property
    def reach(self):
        return self.h + self.b * self.a

    def accelerations(self):
        """Return vertical and angular acceleration by integration of the pressure."""
        start = -(self.delta - self.y) / self.a
        half = 0.5 * (self.b - start)
        s, weights = 0.5 * (self.b + start) + half * NODES, half * WEIGHTS
        pressure = self.k * (self.delta - self.y + s * self.a) - self.c * (
            self.speed - s * self.spin
        )
        lift = float(weights @ pressure) - G - self.ground_y
        moment = float(weights @ (pressure * (self.h * self.a - s)))
        push = self.reach * (self.ground_x + self.b * self.spin**2)
        return lift, (moment - push) / (self.inertia + self.reach**2)


def states():
    rng = np.random.default_rng(7)
    states_found = []
    while len(states_found) < STATES:
        theta, radius, mu = rng.uniform(0.15, 0.46), rng.uniform(2, 12), rng.uniform(1.5, 3.5)
        b, h = radius * math.sin(theta), radius * math.cos(theta)
        omega = rng.uniform(10, 40) * math.sqrt(mu / (1 + mu) * G / radius)
        k = omega**2 / (2 * b)
        c = rng.uniform(0.05, 0.4) * math.sqrt(2 * b * k) / b
        delta, a = G / (2 * b * k), rng.uniform(0.2, 0.9) * theta
        if a * b <= delta:
            continue
        rest = delta + a * b - 2 * math.sqrt(delta * a * b)
        y = rest + rng.uniform(-0.5, 0.5) * delta
        if not -b < -(delta - y) / a < b:
            continue
        spin, speed = rng.uniform(-0.2, 0.2) * theta, rng.uniform(-0.15, 0.15) * omega * delta
        states_found.append(
            State(b, h, radius**2 / mu, k, c, a, y, spin, speed, *rng.uniform(-3, 3, 2))
        )
    return states_found


def psi(q):
    """Return the corrected sums, Psi_1 to Psi_6."""
    b, h, a, y, d = q.b, q.h, q.a, q.y, q.delta
    gap = d - y
    return {
        1: b + gap / a,
        2: -(b**2) / 2 + gap**2 / (2 * a**2),
        3: b * y - b**2 * a / 2 - gap**2 / (2 * a),
        4: b**3 / 3 - b**2 * h * a / 2 + h * gap**2 / (2 * a) + gap**3 / (3 * a**3),
        5: -(b**2) / 2 + h * d + h * b * a - h * y + gap**2 / (2 * a**2),
        6: b * (b**2 / 3 - h * d) * a + h * b * y * a - (b**2 / 2 - h * d) * y
        - gap**3 / (6 * a**2) - h * y**2 / 2 - b**2 * h * a**2 / 2 + b**2 * d / 2
        - h * d**2 / 2,
    }  # fmt: skip


def vertical(q, sums):
    """Terms of (19a), all on one side."""
    lift, _ = q.accelerations()
    return [
        lift, q.c * sums[1] * q.speed, q.c * sums[2] * q.spin, q.k * sums[3], G / 2, q.ground_y,
    ]  # fmt: skip


def turning(q, sums):
    """Terms of (19b), all on one side."""
    _, turn = q.accelerations()
    return {
        "inertia": (q.inertia + q.reach**2) * turn,
        "rate": q.b * q.reach * q.spin**2,
        "damping": q.c * (sums[4] * q.spin + sums[5] * q.speed),
        "stiffness": q.k * sums[6],
        "ground": q.reach * q.ground_x,
    }


def imbalance(terms):
    return abs(sum(terms)) / max(map(abs, terms))


def test_corrected_equations_hold():
    for q in states():
        sums = psi(q)
        assert imbalance(vertical(q, sums)) < EXACT
        assert imbalance(list(turning(q, sums).values())) < EXACT


def printed_19b_inertia(q, sums):
    """I_M + m b h a: the first-order part is half of the right value."""
    terms = turning(q, sums)
    terms["inertia"] *= (q.inertia + q.h**2 + q.b * q.h * q.a) / (q.inertia + q.reach**2)
    return list(terms.values())


def printed_19b_rate(q, sums):
    """No term of the squared rate."""
    return list((turning(q, sums) | {"rate": 0.0}).values())


def printed_19e(q, sums):
    """-b y instead of +b y."""
    return vertical(q, sums | {3: sums[3] - 2 * q.b * q.y})


def printed_19f(q, sums):
    """Inconsistent terms of delta and y."""
    h, a, y, d = q.h, q.a, q.y, q.delta
    gap = d - y
    printed = (h * d**2 + 2 * h * d * y) / (2 * a) + h * y**2 / (2 * a**2)
    printed += (y + d) ** 3 / (3 * a**3)
    right = h * gap**2 / (2 * a) + gap**3 / (3 * a**3)
    return list(turning(q, sums | {4: sums[4] + printed - right}).values())


def printed_19h(q, sums):
    """The rocking stiffness of the whole bed instead of half of it."""
    extra = q.b * (q.b**2 / 3 - q.h * q.delta) * q.a
    return list(turning(q, sums | {6: sums[6] + extra}).values())


@pytest.mark.parametrize(
    ("printed", "largest"),
    [
        (printed_19b_inertia, 0.05),
        (printed_19b_rate, 1e-3),
        (printed_19e, 0.5),
        (printed_19f, 0.2),
        (printed_19h, 0.5),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_printed_equations_do_not_hold(printed, largest):
    found = [imbalance(printed(q, psi(q))) for q in states()]
    assert max(found) > largest
    assert np.median(found) > 1e5 * EXACT
