"""Compiled functions give the results of Python, or report that they run as Python."""

import importlib
import os
import subprocess
import sys
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
import pytest

from rockframe.compiled import (
    COMPILED,
    Integers,
    Matrix,
    Vector,
    bind,
    constant,
    entry,
    inlined,
    kernel,
    numbers_in,
    put,
    view_from,
    view_of,
)

pytestmark = [
    pytest.mark.unit,
    pytest.mark.skipif(not COMPILED, reason="compilation is off in this run"),
]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path / "code"))
    return tmp_path / "code"


@kernel
def cubed(x: float) -> float:
    return x * x * x


class Linear(NamedTuple):
    slope: float

    @inlined
    def force_at(self, x: float) -> float:
        return self.slope * x

    @inlined
    def own(self) -> tuple[float, ...]:
        return ()


class Hardening(NamedTuple):
    slope: float
    share: float
    order: int
    turned: bool

    @inlined
    def force_at(self, x: float) -> float:
        force = self.slope * x + self.share * cubed(x) * self.order
        return -force if self.turned else force

    @inlined
    def own(self) -> tuple[float, ...]:
        return self.slope, self.share


class Pair(NamedTuple):
    first: Any
    second: Any

    @kernel
    def total_at(self, x: float) -> float:
        return self.first.force_at(x) - self.second.force_at(-x)

    @kernel
    def all_own(self) -> tuple[float, ...]:
        return self.first.own() + constant(0.5, self.second.own()) + self.second.own()


class Arrays(NamedTuple):
    values: Vector
    counts: Integers


PAIRS = (
    Pair(Linear(2.0), Hardening(3.0, 0.25, 2, False)),
    Pair(Hardening(1.0, 4.0, 3, True), Linear(-1.5)),
    Pair(Linear(2.0), Linear(0.5)),
)


@entry
def tabulate(
    pair: Pair, rows: Matrix, row: int, arrays: Arrays, codes: Integers, out: Vector
) -> int:
    found = 0
    for i in range(rows.shape[1]):
        arrays.values[i] += pair.total_at(rows[row, i])
        codes[i] = 10 * i - arrays.counts[0]
        if arrays.values[i] < 0.0:
            found += 1
    put(pair.all_own(), 2, out)
    out[0] = float(len(view_of(out, 2, 3))) + view_from(out, 3)[0]
    out[1] = view_of(out, 2, 3)[1]
    arrays.counts[0] += len(out)
    return found


def test_callees_include_all_called_functions():
    from rockframe.compiled.jobs import callees_of

    callees = callees_of(Pair.total_at, {Pair, Linear, Hardening})
    assert callees == {Pair.total_at, Linear.force_at, Hardening.force_at, cubed}
    assert callees_of(Pair.total_at, {Pair, Linear}) == {Pair.total_at, Linear.force_at}


def arguments(pair):
    rows = np.linspace(-2.0, 1.7, 12).reshape(3, 4)
    rows.setflags(write=False)
    arrays = Arrays(np.array([1.0, -0.5, 0.25, 0.0]), np.array([5]))
    return pair, rows, 1, arrays, np.zeros(4, np.int16), np.full(6, -7.0)


def contents(call_arguments):
    _, _, _, arrays, codes, out = call_arguments
    return [part.tolist() for part in (*arrays, codes, out)]


def test_kernels_and_methods_agree_with_python():
    """Methods are chosen by the class of the tuple, whatever its contents."""
    for pair in PAIRS:
        compiled, plain = arguments(pair), arguments(pair)
        assert tabulate(*compiled) == tabulate.__wrapped__(*plain)
        assert contents(compiled) == contents(plain)
    assert all(routine.code for routine in tabulate._routines.values())


@kernel
def force_of(pair: Pair, x: float, out: Vector) -> float:
    out[0] += 1.0
    return pair.total_at(x)


@kernel
def count_in(pair: Pair, number: int, out: Vector) -> int:
    out[1] = pair.total_at(float(number))
    return number + 1


@entry
def call_all(forces: Any, counting: Any, numbers: Vector, values: Vector, out: Vector) -> None:
    for i in range(len(values)):
        values[i] = forces.call(values[i], out, numbers)
    out[2] = counting.call(len(values), out, numbers)


def test_one_compiled_function_serves_all_bound_ones():
    for pair in PAIRS:
        functions, numbers = bind((force_of, count_in), pair), numbers_in(pair)
        values, out = np.array([0.5, -1.25, 2.0]), np.zeros(3)
        expected = [pair.total_at(value) for value in values]
        call_all(*functions, numbers, values, out)
        assert values.tolist() == expected
        assert out.tolist() == [3.0, pair.total_at(3.0), 4.0]
    assert numbers_in(PAIRS[1]).tolist() == [1.0, 4.0, 3.0, 1.0, -1.5]
    assert len([routine for routine in call_all._routines.values() if routine.code]) == 1


class Noted(NamedTuple):
    number: float
    notes: Vector


class Around(NamedTuple):
    noted: Noted


@kernel
def note(around: Around, x: float) -> float:
    around.noted.notes[0] += x
    return around.noted.notes[0]


def test_functions_bound_to_one_tuple_share_no_array_inside_it():
    around = Around(Noted(1.0, np.zeros(1)))
    (one,), (other,) = bind((note,), around), bind((note,), around)
    assert one.call(2.0, np.zeros(2)) == 2.0
    assert other.call(3.0, np.zeros(2)) == 3.0
    assert around.noted.notes[0] == 0.0


@kernel
def import_bound(pair: Pair, x: float, out: Vector) -> float:
    from math import floor

    return floor(x) + pair.total_at(x)


def test_uncompilable_bound_function_does_not_affect_others(fallbacks):
    pair = PAIRS[0]
    numbers = numbers_in(pair)
    forces, broken, counting = bind((force_of, import_bound, count_in), pair)
    values, out = np.array([0.5]), np.zeros(3)
    for _ in range(2):
        values[0] = 0.5
        call_all(broken, counting, numbers, values, out)
        assert values.tolist() == [pair.total_at(0.5)]
    assert len(fallbacks) == 1
    assert "import_bound could not be compiled" in fallbacks[0]
    fallbacks.clear()
    count = out[0]
    call_all(forces, counting, numbers, values, out)
    assert out[0] == count + 1.0
    assert forces.source.address != 0 != counting.source.address
    assert not any(routine.failed for routine in call_all._routines.values())


def test_unsupported_arguments_are_refused():
    _, _, row, arrays, codes, out = arguments(PAIRS[0])
    for rows, array_fields, words in (
        (np.zeros((3, 4), order="F"), arrays, "arrays in C order"),
        (np.zeros((3, 8))[:, ::2], arrays, "arrays in C order"),
        (np.zeros((3, 4)), arrays._replace(values=np.zeros(8)[::2]), "arrays in C order"),
        (np.zeros((3, 4)), arrays._replace(counts=[5]), "numbers, arrays and tuples"),
        ("a word", arrays, "numbers, arrays and tuples"),
        (len, arrays, "numbers, arrays and tuples"),
    ):
        with pytest.raises(TypeError, match=words):
            tabulate(PAIRS[0], rows, row, array_fields, codes, out)


@entry
def import_inside(values: Vector) -> int:
    from math import floor

    values[1] = values[0]
    return floor(2.5)


def test_uncompilable_function_runs_as_python_with_one_message(caplog, fallbacks):
    for first in (3.0, 4.0):
        values = np.array([first, 0.0])
        assert import_inside(values) == 2
        assert values.tolist() == [first, first]
    messages = [text for text in caplog.messages if "could not" in text]
    assert len(messages) == 1
    assert messages[0].startswith(
        f"{__name__}.import_inside could not be compiled, and runs as plain"
    )
    assert len(messages[0].splitlines()) == 1
    assert fallbacks == messages
    fallbacks.clear()


class Shade(IntEnum):
    DARK = 4


class Shaded(NamedTuple):
    slope: float

    @kernel
    def force_at(self, x: float) -> float:
        return self.slope * x + int(Shade.DARK)


def test_compilation_failure_reports_innermost_reason_and_line(fallbacks):
    pair = Pair(Shaded(2.0), Linear(0.5))
    values, out = np.array([0.5]), np.zeros(3)
    functions, numbers = bind((force_of, count_in), pair), numbers_in(pair)
    call_all(*functions, numbers, values, out)
    assert values.tolist() == [pair.total_at(0.5)]
    assert "int(IntEnum<int64>(Shade)); test_entries.py, line " in fallbacks[0]
    fallbacks.clear()


class Refusing(NamedTuple):
    slope: float

    @kernel
    def force_at(self, x: float) -> float:
        if x > 1.0:
            raise ValueError
        return self.slope * x


def test_exception_of_a_law_ends_the_call(fallbacks):
    pair = Pair(Refusing(2.0), Linear(0.5))
    functions, numbers = bind((force_of, count_in), pair), numbers_in(pair)
    for _ in range(2):
        call_all(*functions, numbers, np.array([0.5]), np.zeros(3))
        with pytest.raises(ValueError):  # noqa: PT011
            call_all(*functions, numbers, np.array([1.5]), np.zeros(3))
    assert len(fallbacks) == 1
    assert "Refusing.force_at raises an exception" in fallbacks[0]
    fallbacks.clear()


def test_methods_belong_to_their_classes(fallbacks):
    """Fields and methods of other classes with equal names are not used."""

    class One(NamedTuple):
        size: float  # a method of bodies

        @kernel
        def state(self, factor: float) -> float:  # a field of the integrator's named tuples
            return factor * self.size

    class Other(NamedTuple):
        state: float

        @kernel
        def size(self) -> float:
            return 2.0 * self.state

    class Derived(Other):
        __slots__ = ()

        @kernel
        def size(self) -> float:
            return 3.0 * self.state

    @entry
    def of_all(one: One, other: Other, derived: Derived) -> int:
        return int(one.state(10.0) + one.size + other.size() + other.state + derived.size())

    importlib.import_module("rockframe.solve.workspace")
    importlib.import_module("rockframe.dynamics.single_body")
    assert of_all(One(1.0), Other(100.0), Derived(1000.0)) == 10 + 1 + 200 + 100 + 3000


def test_writing_to_read_only_array_raises(fallbacks):
    @entry
    def write(out: Vector) -> None:
        out[0] = 5.0

    values = np.zeros(2)
    values.flags.writeable = False
    with pytest.raises(TypeError, match="read-only"):
        write(values)
    assert len(fallbacks) == 1
    fallbacks.clear()


@pytest.mark.long
def test_damaged_machine_code_is_made_anew(tmp_path):
    program = "from rockframe.compiled import entry\nimport own\nprint(own.twice(4))\n"
    (tmp_path / "own.py").write_text(
        "from rockframe.compiled import entry\n"
        "@entry\n"
        "def twice(number: int) -> int:\n"
        "    return 2 * number\n"
    )
    environment = {**os.environ, "ROCKFRAME_CACHE_DIR": str(tmp_path / "code")}
    environment["PYTHONPATH"] = os.pathsep.join([str(tmp_path), *sys.path])

    def run() -> str:
        done = subprocess.run(
            [sys.executable, "-c", program], env=environment, capture_output=True, text=True,
            check=True,
        )  # fmt: skip
        assert "plain Python" not in done.stderr
        return done.stdout.strip()

    assert run() == "8"
    stored = list((tmp_path / "code").rglob("*.nb[ci]"))
    assert len(stored) == 2
    for file in stored:
        file.write_bytes(b"damaged")
    assert run() == "8"
    assert all(file.read_bytes() != b"damaged" for file in stored)


def test_compilation_can_be_turned_off():
    program = (
        "from rockframe.compiled import COMPILED, entry\n"
        "def function(): pass\n"
        "print(COMPILED, entry(function).__wrapped__ is function)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=os.environ | {"ROCKFRAME_COMPILE": "0"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "False True"
