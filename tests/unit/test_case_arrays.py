"""Arithmetic of many cases equals that of single cases bit for bit."""

import math

import numpy as np
import pytest

from rockframe import case_arrays
from rockframe.case_arrays import (
    BranchesDiffer,
    CaseArray,
    SingleCaseOnly,
    run_by_branches,
    values_by_case,
)

RNG = np.random.default_rng(7)
X, Y = RNG.uniform(0.1, 0.9, 400), RNG.uniform(-3.0, 3.0, 400)


@pytest.mark.parametrize(
    "work",
    [
        lambda x, y: x + 2.0 * y - (1.0 - x) / 3.0 + x * y,
        lambda x, y: -x / abs(y) + x**2 - +(y**3),
        lambda x, y: (
            case_arrays.sqrt(x) * case_arrays.hypot(x, y)
            + case_arrays.atan2(x, y)
            + case_arrays.hypot(2.0, y)
        ),
        lambda x, y: (
            case_arrays.sin(y)
            + case_arrays.cos(y) * case_arrays.tan(x)
            + case_arrays.asin(x)
            - case_arrays.atan(y)
        ),
        lambda x, y: (
            case_arrays.maximum(x, y) + case_arrays.maximum(y, 0.5) + case_arrays.maximum(0.2, x)
        ),
        lambda x, y: sum(np.array([x, 1.0]) * np.array([2.0, 3.0]) + np.abs(np.array([y, x]))),
    ],
)
def test_case_arithmetic_is_bit_identical_to_scalars(work):
    together = work(CaseArray(X), CaseArray(Y)).values
    alone = np.array([work(x, y) for x, y in zip(X.tolist(), Y.tolist(), strict=True)])
    assert together.tobytes() == alone.tobytes()


def iterations_of(x):
    """Compute with branches that differ in their number of iterations, one of which fails."""
    if x > 0.85:
        msg = "too large"
        raise ValueError(msg)
    rounds = 0
    while x < 0.5:
        x, rounds = 1.5 * x, rounds + 1
    return x, rounds


def test_cases_are_split_at_differing_branches():
    found, rounds = np.full(400, np.nan), np.full(400, -1)
    for some, (values, count) in run_by_branches(
        lambda some: iterations_of(CaseArray(X[some])), np.arange(400)
    ):
        assert len(some) >= case_arrays.MIN_CASES
        found[some], rounds[some] = values.values, count
    assert len(set(rounds.tolist()) - {-1}) > 3
    assert (np.isnan(found) | (X <= 0.85)).all()
    assert np.isnan(found).sum() < (X > 0.85).sum() + 5 * case_arrays.MIN_CASES
    for k in np.flatnonzero(~np.isnan(found)).tolist():
        assert (found[k], rounds[k]) == iterations_of(float(X[k]))


def test_comparisons_agree_or_raise_branches_differ():
    number = CaseArray(np.array([1.0, 2.0, 3.0]))
    assert number > 0.5
    assert (number == 4.0) is False
    assert number != CaseArray(np.array([2.0, 3.0, 4.0]))
    with pytest.raises(BranchesDiffer) as differ:
        bool(number < 2.5)
    assert differ.value.truths.tolist() == [True, True, False]
    assert int(CaseArray(np.full(3, 2.0))) == 2
    assert case_arrays.ceil(CaseArray(np.array([1.2, 1.9]))) == 2
    assert case_arrays.isnan(CaseArray(np.full(2, np.nan)))
    with pytest.raises(BranchesDiffer):
        case_arrays.ceil(CaseArray(np.array([1.2, 2.9])))


@pytest.mark.parametrize(
    "work", [float, str, repr, "{:.3g}".format, math.sin, round, lambda x: x % 2.0]
)
def test_scalar_only_operations_raise_single_case_only(work):
    with pytest.raises(SingleCaseOnly):
        work(CaseArray(np.array([1.0, 2.0])))
    assert not issubclass(SingleCaseOnly, Exception)
    assert not issubclass(BranchesDiffer, Exception)


def test_division_by_zero_falls_back_to_single_cases():
    def divided(some):
        return 1.0 / CaseArray(np.where(some < 50, 0.0, 1.0))

    assert list(run_by_branches(divided, np.arange(100))) == []
    assert len(list(run_by_branches(divided, np.arange(50, 100)))) == 1


def test_shared_numbers_are_broadcast_to_cases():
    assert values_by_case(2, 3).tolist() == [2.0, 2.0, 2.0]
    assert values_by_case(CaseArray(X), 400) is X
    assert case_arrays.python_number(np.float64(2.0)) == 2.0
    assert type(case_arrays.python_number(np.float64(2.0))) is float
