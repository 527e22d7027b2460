"""Entries: what they take, what they give, and that their code outlives the process."""

import logging
import os
import subprocess
import sys
from typing import NamedTuple

import numpy as np
import pytest

from rockframe.compiled import (
    COMPILED,
    FrozenMatrix,
    Integers,
    Signature,
    Vector,
    callback,
    entry,
    kernel,
)

pytestmark = [
    pytest.mark.unit,
    pytest.mark.skipif(not COMPILED, reason="this run does without compilation"),
]

SHIFT = Signature("real", "real", "vector")
OTHER = Signature("real", "vector", "real")


class Pair(NamedTuple):
    values: Vector
    counts: Integers
    factor: float


@kernel
def times(a: float, b: float) -> float:
    return a * b


@callback(SHIFT)
def shift(value: float, by: Vector) -> float:
    by[0] += 1.0
    return times(value, 2.0) + by[1]


@callback(OTHER)
def other(by: Vector, value: float) -> float:
    return by[0] + value


@entry("real", SHIFT, Pair, "frozen_matrix", "integer")
def combine(function, pair: Pair, matrix: FrozenMatrix, row: int) -> float:
    total = 0.0
    for i in range(matrix.shape[1]):
        total += function(matrix[row, i], pair.values)
    pair.counts[0] += matrix.shape[0]
    return total * pair.factor


@entry("integer", "codes")
def tens(codes) -> int:
    for i in range(len(codes)):
        codes[i] = 10 * i
    return len(codes)


@entry("none", "vector")
def careless(values: Vector) -> None:
    if values[0] > 1.0:
        raise ValueError


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path / "code"))
    return tmp_path / "code"


def arguments():
    matrix = np.arange(12.0).reshape(3, 4)
    matrix.setflags(write=False)
    return [shift, Pair(np.array([0.0, 0.5]), np.array([5]), 3.0), matrix, 2]


def test_it_computes_what_python_computes():
    given = arguments()
    assert combine(*given) == 3.0 * (2.0 * (8 + 9 + 10 + 11) + 4 * 0.5)
    assert given[1].values.tolist() == [4.0, 0.5]
    assert given[1].counts.tolist() == [8]
    plain = arguments()
    assert combine.__wrapped__(*plain) == combine(*arguments())
    assert plain[1].values.tolist() == [4.0, 0.5]


def test_empty_arrays_and_small_integers():
    assert tens(np.empty(0, np.int16)) == 0
    codes = np.empty(4, np.int16)
    assert tens(codes) == 4
    assert codes.tolist() == [0, 10, 20, 30]


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ("values", np.zeros(2, np.float32)),
        ("values", np.zeros((2, 2))),
        ("values", np.zeros(4)[::2]),
        ("counts", np.zeros(1, np.int32)),
        ("counts", np.zeros(1)),
    ],
)
def test_arrays_of_another_type_are_refused(place, value):
    given = arguments()
    given[1] = given[1]._replace(**{place: value})
    with pytest.raises(TypeError, match=r"combine needs a (vector|integers): 1 dimensions of"):
        combine(*given)


def test_an_array_that_must_be_writeable_is_refused_when_it_is_not():
    given = arguments()
    given[1].values.setflags(write=False)
    with pytest.raises(TypeError, match="writeable"):
        combine(*given)


def test_a_matrix_in_another_order_is_refused():
    given = arguments()
    given[2] = np.zeros((3, 4), order="F")
    with pytest.raises(TypeError, match="not in C order"):
        combine(*given)


@pytest.mark.parametrize("function", [other, times, len])
def test_a_function_of_another_signature_is_refused(function):
    with pytest.raises(TypeError, match="is no callback of the signature"):
        combine(function, *arguments()[1:])


def test_too_few_or_too_many_arguments_are_refused():
    with pytest.raises(ValueError, match="zip"):
        combine(*arguments()[:-1])
    with pytest.raises(ValueError, match="zip"):
        combine(*arguments(), 1)
    function, pair, *rest = arguments()
    with pytest.raises(ValueError, match="zip"):
        combine(function, (*pair, 1.0), *rest)


def test_compilation_can_be_turned_off():
    told = "from rockframe.compiled import COMPILED; print(COMPILED)"
    done = subprocess.run(
        [sys.executable, "-c", told],
        env=os.environ | {"ROCKFRAME_COMPILE": "0"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "False"


def test_code_is_made_for_one_processor(monkeypatch):
    from rockframe.compiled import machine_code

    makers = set()
    for features in ("+some", "+some,+other"):
        monkeypatch.setattr(machine_code, "_features", lambda features=features: features)
        makers.add(machine_code._maker())
    assert len(makers) == 2


def test_functions_of_one_name_are_not_mixed_up(folder):
    def made(number):
        @entry("real", "vector")
        def first(values: Vector) -> float:
            return values[0] + number

        return first

    assert made(1.0)(np.ones(1)) == 2.0
    assert made(2.0)(np.ones(1)) == 3.0
    # their source is none of rockframe's: whether stored code is up to date could not be told
    assert not folder.exists()


def test_code_that_can_raise_is_refused():
    with pytest.raises(RuntimeError, match="careless could not be compiled") as caught:
        careless(np.zeros(1))
    assert "can raise an exception" in str(caught.value.__cause__)


SPECTRUM = """
import logging, sys
logging.basicConfig(stream=sys.stdout, format="%(message)s")
import rockframe as rf
spectrum = rf.response_spectrum(rf.GroundMotion.sine_pulse(), ([0.5, 1.0], "s"))
print("numba" in sys.modules, spectrum.spectral_displacement.values.tolist())
"""


def lines_of_a_process():
    done = subprocess.run(
        [sys.executable, "-c", SPECTRUM], capture_output=True, text=True, check=True
    )
    return done.stdout.splitlines()


def test_the_next_process_does_without_numba(folder):
    first, second = lines_of_a_process(), lines_of_a_process()
    assert first[0].startswith("rockframe compiles what this needs for this machine")
    assert first[1].startswith("True")
    assert second == [first[1].replace("True", "False")]
    for file in folder.iterdir():
        file.write_bytes(b"damaged")
    assert lines_of_a_process() == first


def test_the_announcement_is_a_message_of_rockframe(caplog):
    from rockframe.compiled import machine_code

    machine_code._announced.clear()
    with caplog.at_level(logging.WARNING, logger="rockframe"):
        times_two(np.ones(1))
    assert "compiles what this needs" in caplog.text


@entry("none", "vector")
def times_two(values: Vector) -> None:
    values[0] *= 2.0
