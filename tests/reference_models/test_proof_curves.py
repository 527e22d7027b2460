"""Curves and sets of proofs on pads contain what they enclose, computed with forty digits.

The functions within a curve's error are its polynomial plus or minus all of that error.
"""

import mpmath
import numpy as np
import pytest

pytest.importorskip("flint", reason="python-flint is not installed")

from rockframe.proof.balls import ball, working_precision
from rockframe.proof.pads.flow import DEGREE, Curve, StateSet
from rockframe.proof.pads.law import SIZE
from rockframe.proof.pads.prover import _positive

DIGITS = 40
ERRORS = (0.0, 1e-12, 1e-6, 1e-2)


def exact(number):
    return mpmath.mpf(float(number))


def value(curve, place, share=0):
    """Return the value of a function within a curve's error."""
    polynomial = mpmath.polyval([exact(a) for a in curve.coefficients[::-1]], exact(place))
    return polynomial + share * exact(curve.error)


def random_curve(rng):
    size = 10.0 ** rng.uniform(-6.0, 6.0)
    powers = rng.uniform(0.05, 1.0) ** np.arange(DEGREE + 1)
    return Curve(size * powers * rng.normal(size=DEGREE + 1), size * rng.choice(ERRORS))


def test_sums_and_products_of_curves_contain_those_of_functions():
    rng = np.random.default_rng(1)
    with mpmath.workdps(DIGITS):
        for _ in range(150):
            a, b, factor = random_curve(rng), random_curve(rng), float(rng.normal())
            place, (s, t) = rng.choice([0.0, rng.uniform(), 1.0]), rng.choice([-1, 1], size=2)
            x, y = value(a, place, s), value(b, place, t)
            assert abs(x) <= exact(a.size)
            for curve, of in (
                (a + b, x + y), (a - b, x - y), (a * b, x * y), (a.times(factor), x * factor)
            ):  # fmt: skip
                assert abs(value(curve, place) - of) <= exact(curve.error)


def test_reciprocals_of_curves_contain_those_of_functions():
    rng = np.random.default_rng(2)
    with mpmath.workdps(DIGITS):
        for _ in range(150):
            row = rng.normal(size=DEGREE + 1)
            row[1:] *= 0.3 * abs(row[0]) / np.abs(row[1:]).sum()
            curve = Curve(row, abs(row[0]) * rng.choice([0.0, 1e-10, 1e-2]))
            place, share = rng.choice([0.0, rng.uniform(), 1.0]), int(rng.choice([-1, 1]))
            inverse = curve.inverse()
            assert abs(value(inverse, place) - 1 / value(curve, place, share)) <= inverse.error


def test_image_of_a_set_contains_those_of_its_corners():
    rng = np.random.default_rng(3)
    for _ in range(80):
        weights = 2.0 ** rng.integers(-3, 8, size=SIZE)
        axes = np.linalg.qr(rng.normal(size=(SIZE, SIZE)))[0]
        spread = 10.0 ** rng.uniform(-30.0, -2.0, size=SIZE) * rng.integers(0, 2, size=SIZE)
        states = StateSet([ball(0)] * SIZE, axes, spread)
        middle = np.eye(SIZE) + 10.0 ** rng.uniform(-3.0, 1.0) * rng.normal(size=(SIZE, SIZE))
        error = 10.0 ** rng.uniform(-14.0, -3.0) * rng.random((SIZE, SIZE))
        middles, radii = rng.normal(size=SIZE), 10.0 ** rng.uniform(-35.0, -6.0, size=SIZE)
        with working_precision(106):
            image = [ball(float(a), float(b)) for a, b in zip(middles, radii, strict=True)]
            found = states.image(image, middle, error, weights)
        with mpmath.workdps(DIGITS):
            signs = [rng.choice([-1, 1], size=shape) for shape in (SIZE, SIZE, (SIZE, SIZE))]
            corner = mpmath.matrix(axes.tolist()) * mpmath.matrix((signs[0] * spread).tolist())
            slope = mpmath.matrix(middle.tolist()) + mpmath.matrix((signs[2] * error).tolist())
            end = slope * corner
            for i in range(SIZE):
                centre = exact(middles[i]) + int(signs[1][i]) * exact(radii[i])
                end[i] += (centre - exact(found.centre[i].mid())) / exact(weights[i])
            place = mpmath.lu_solve(mpmath.matrix(found.axes.tolist()), end)
            for i in range(SIZE):
                assert abs(place[i]) <= exact(found.spread[i])


def test_curves_proved_positive_have_no_root():
    """With roots at the start and the end where these are allowed, and near pairs of roots."""
    rng, proved = np.random.default_rng(4), 0
    polynomial = np.polynomial.polynomial
    for _ in range(1500):
        roots, until = rng.uniform(-0.5, 1.5, size=rng.integers(1, 5)), float(rng.uniform(0.3, 1.0))
        if rng.random() < 0.5:
            roots = np.append(roots, roots[0] + 10.0 ** rng.uniform(-6.0, -2.0))
        starts, ends = (rng.random(2) < 0.5).tolist()
        row = polynomial.polyfromroots([*roots, *[0.0][:starts], *[until][:ends]])
        row = np.pad(row * rng.choice([-1.0, 1.0]), (0, DEGREE + 1 - row.size))
        rates = np.append(polynomial.polyder(row), 0.0)
        error = 0.0 if starts or ends else float(rng.choice(ERRORS))
        options = {"starts_at_zero": starts, "ends_at_zero": ends}
        if _positive(Curve(row, error), Curve(rates, error), until, **options):
            proved += 1
            assert not ((roots > 0.0) & (roots < until)).any()
            inside = polynomial.polyval(np.linspace(0.0, until, 200)[1:-1], row)
            assert inside.min() > (0.0 if starts or ends else error)
    assert proved > 100
