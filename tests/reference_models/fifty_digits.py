"""Housner's block by Taylor polynomials with fifty digits, without any enclosure."""

import mpmath
import numpy as np

DIGITS = 50


class ExactRun:
    """A Housner block from rest under a motion that is linear between samples.

    Small bounces do not end in rest: runs are compared up to a sample before them.
    """

    def __init__(self, block, across, up=None, step=0.0625, degree=30, until=None):
        self.block, self.degree = block, degree
        self.across = [float(value) for value in across]
        self.up = [0.0] * len(self.across) if up is None else [float(v) for v in up]
        self.until = len(self.across) - 1 if until is None else until
        self.step = float(step)
        self.states, self.sides, self.impacts = [], [], 0

    def corner(self, side):
        return self.block.right if side > 0 else self.block.left

    def run(self):
        """Run and store the state at every sample."""
        with mpmath.workdps(DIGITS):
            across, up = ([mpmath.mpf(v) for v in row] for row in (self.across, self.up))
            state, side, gravity = [mpmath.mpf(0)] * 2, 0, mpmath.mpf(self.block.gravity)
            end = mpmath.mpf(self.step)
            for k in range(self.until):
                self.states.append(state)
                self.sides.append(side)
                now = mpmath.mpf(0)
                x, y = ((row[k + 1] - row[k]) / end for row in (across, up))
                while now < end:
                    along = [across[k] + x * now, x]
                    weight = [gravity + up[k] + y * now, y]
                    if side == 0:
                        now, side = self.lift(along, weight, now, end)
                        continue
                    now, side, state = self.rock(side, state, along, weight, now, end)
        return self

    def lift(self, along, weight, now, end):
        times = []
        for side in (1, -1):
            tangent = mpmath.tan(mpmath.mpf(self.corner(side).angle))
            value, rate = (w * tangent + side * a for w, a in zip(weight, along, strict=True))
            if value < 0:  # from the first sample on
                times.append((now, side))
            elif rate < 0 and value + rate * (end - now) < 0:
                times.append((now - value / rate, side))
        return min(times, default=(end, 0))

    def polynomial(self, side, state, along, weight):
        """Taylor coefficients of the rotation, by those of sine and cosine of theta s - a."""
        corner = self.corner(side)
        ratio = mpmath.mpf(corner.radius) / mpmath.mpf(corner.inertia)
        lean = mpmath.mpf(corner.angle) * side - state[0]
        sine, cosine, a, rates = [mpmath.sin(lean)], [mpmath.cos(lean)], list(state), [state[1]]
        for k in range(self.degree):
            moment = weight[0] * sine[k] + along[0] * cosine[k]
            if k:
                moment += weight[1] * sine[k - 1] + along[1] * cosine[k - 1]
            a.append(-ratio * moment / ((k + 1) * (k + 2)))
            back = rates[::-1]
            new = -mpmath.fdot(cosine, back) / (k + 1)
            cosine.append(mpmath.fdot(sine, back) / (k + 1))
            sine.append(new)
            rates.append((k + 2) * a[k + 2])
        return a, rates

    def rock(self, side, state, along, weight, now, end):
        a, rates = self.polynomial(side, state, along, weight)
        left = end - now
        # leave out leading zeros: the block has just left the ground
        skipped = next(k for k, coefficient in enumerate(a) if coefficient)
        row = [float(coefficient * left**k) for k, coefficient in enumerate(a)][skipped:]
        while abs(row[-1]) < 1e-25 * max(abs(coefficient) for coefficient in row) and len(row) > 2:
            row.pop()
        roots = np.roots(row[::-1])
        real = [r.real for r in roots if abs(r.imag) < 1e-9 * abs(r) and 0.0 < r.real <= 1.0]
        if not real:
            return (
                end,
                side,
                [mpmath.polyval(coefficient[::-1], left) for coefficient in (a, rates)],
            )
        root = mpmath.mpf(min(real)) * left
        for _ in range(6):
            root -= mpmath.polyval(a[::-1], root) / mpmath.polyval(rates[::-1], root)
        rate = mpmath.polyval(rates[::-1], root)
        self.impacts += 1
        restitution = mpmath.mpf(self.corner(-side).restitution)
        return now + root, -side, [mpmath.mpf(0), rate * restitution]
