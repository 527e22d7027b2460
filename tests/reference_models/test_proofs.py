"""Proofs of verdicts beside an independent program with fifty digits, and with planted faults."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest

flint = pytest.importorskip("flint")
mpmath = pytest.importorskip("mpmath")

import rockframe as rf  # noqa: E402
from rockframe.proof import flow, impact, march, verdict  # noqa: E402

mp = mpmath.mp
STEP, GRAVITY = 0.01, 9.81
SECONDS = np.arange(120) * STEP
RECORD = np.round(4.0 * np.sin(5.0 * SECONDS), 6)
BLOCK = rf.Block(width="0.9 m", height="3 m", mass="1 t", centre_of_mass=("1.4 m", "0.06 m"))
SYSTEM = rf.System(BLOCK, gravity="9.81 m/s^2")


def series(sign, corner, start, ground, order=21):
    """Give Taylor's series of the rotation about a point, by the definition of its coefficients."""
    at, slope = ground
    rate = mp.mpf(corner.radius) / mp.mpf(corner.inertia)
    lean = sign * mp.mpf(corner.angle) - start[0]
    sine, cosine, angle = [mp.sin(lean)], [mp.cos(lean)], [start[0], start[1]]
    for k in range(order):
        turned = GRAVITY_MP * sine[k] + at * cosine[k] + (slope * cosine[k - 1] if k else 0)
        angle.append(-rate * turned / ((k + 1) * (k + 2)))
        change = [-(j + 1) * angle[j + 1] for j in range(k + 1)]
        sine.append(mp.fsum(change[j] * cosine[k - j] for j in range(k + 1)) / (k + 1))
        cosine.append(-mp.fsum(change[j] * sine[k - j] for j in range(k + 1)) / (k + 1))
    return angle[::-1]


GRAVITY_MP = mpmath.mpf(GRAVITY)


def fifty_digits(system=SYSTEM, record=RECORD, step=STEP):
    """Integrate from knot to knot, with impacts; give rotation and rate at the knots."""
    with mp.workdps(50):
        law = system.assembly.model.system
        dt, values = mp.mpf(step), [mp.mpf(float(one)) for one in record]
        found, sign, state = [], 0, (mp.mpf(0), mp.mpf(0))
        for k in range(len(values) - 1):
            slope, now = (values[k + 1] - values[k]) / dt, mp.mpf(0)
            if sign == 0:
                for side, corner in ((1, law.right), (-1, law.left)):
                    level = GRAVITY_MP * mp.tan(mp.mpf(corner.angle))
                    if -side * values[k + 1] > level:
                        sign, now = side, (-side * level - values[k]) / slope
            while sign and now < dt:
                corner = law.right if sign > 0 else law.left
                angle = series(sign, corner, state, (values[k] + slope * now, slope))
                left = dt - now
                places = [left * j / 12 for j in range(1, 13)]
                below = [x for x in places if sign * mp.polyval(angle, x) < 0]
                if not below:
                    value, rate = mp.polyval(angle, left, derivative=True)
                    state, now = (value, rate), dt
                    break
                root = below[0]
                for _ in range(9):  # Newton's steps from beyond
                    value, rate = mp.polyval(angle, root, derivative=True)
                    root -= value / rate
                rate = mp.polyval(angle, root, derivative=True)[1]
                sign, now = -sign, now + root
                kept = (law.right if sign > 0 else law.left).restitution
                state = (mp.mpf(0), mp.mpf(kept) * rate)
            found.append(state)
        return found


@pytest.fixture(scope="module")
def exact():
    return fifty_digits()


class Enough(Exception):  # noqa: N818
    """The last knot is reached."""


def enclosures():
    """Give the enclosures at the knots, as far as there are any."""
    found, assembly = {}, SYSTEM.assembly
    motion = rf.GroundMotion.from_arrays((RECORD, "m/s^2"), f"{STEP} s")

    def watch(k, sign, box):
        found[k] = (sign, box)
        if k == len(RECORD) - 1:
            raise Enough

    given = (
        assembly.model.system, motion.si, assembly.options.slope,
        assembly.setting.overturning_angles, (0.0, 0.0), 1.0, 0.0, watch, 106,
    )  # fmt: skip
    with flint.ctx.workprec(106), suppress(Enough, ZeroDivisionError, ValueError, OverflowError):
        verdict._tried(*given)
    return found


def missed(exact):
    """Count the knots whose enclosure does not hold the exact state; all, if it was given up."""
    found = enclosures()
    count = 0
    for k, (_, box) in found.items():
        if k <= len(exact):
            held = [
                abs(mp.mpf(one.mid().str(60, radius=False)) - value)
                <= mp.mpf(float(one.rad())) * (1 + 1e-9) + mp.mpf(10) ** -47
                for one, value in zip(box, exact[k - 1], strict=True)
            ]
            count += not all(held)
    return found, count


def test_every_enclosure_holds_the_run_of_fifty_digits(exact):
    with mp.workdps(50):
        found, count = missed(exact)
    sides = [sign for sign, _ in found.values()]
    assert len(found) == len(exact)
    assert {-1, 1} <= set(sides)
    assert all(box[0].rad() < 1e-18 for _, box in found.values())
    assert count == 0


def sign_of_gravity(monkeypatch):
    given = flow.product
    monkeypatch.setattr(flow, "product", lambda a, b: given(a, b) * (1 if len(a) != 3 else -1))


def dropped_remainder(monkeypatch):
    given = flow.majorants

    def short(speed, force, rise, precision):
        bounds, waves, _ = given(speed, force, rise, precision)
        return [0 * one for one in bounds], waves, 7

    monkeypatch.setattr(flow, "majorants", short)


def missed_impact(monkeypatch):
    def blind(self, h, *, to_ground):
        self.states = flow.stepped(self.side, self._line(), self.states, h)[0]
        self._to_next_knot()
        return True

    monkeypatch.setattr(march.March, "_step", blind)


def restitution_off(monkeypatch):
    given = impact._reset

    def off(problem, *rest):
        left = problem.left._replace(restitution=problem.left.restitution + 1e-12)
        return given(replace(problem, left=left), *rest)

    monkeypatch.setattr(impact, "_reset", off)


def rounded_inwards(monkeypatch):
    given = flow.StateSet.mapped

    def inwards(self, image, slope):
        after = given(self, image, slope)
        return after._replace(spread=[one.mid() for one in after.spread])

    monkeypatch.setattr(flow.StateSet, "mapped", inwards)


@pytest.mark.parametrize(
    "fault",
    [sign_of_gravity, dropped_remainder, missed_impact, restitution_off, rounded_inwards],
)
def test_a_planted_fault_is_caught(fault, monkeypatch, exact):
    fault(monkeypatch)
    with mp.workdps(50):
        _, count = missed(exact)
    assert count > 0
