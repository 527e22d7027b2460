"""Machine code and plain Python call each other until compilation pays, with equal results."""

from typing import Annotated, Any, NamedTuple

import numpy as np
import pytest

from rockframe.compiled import (
    COMPILED,
    BoundFunction,
    Integers,
    ReadOnlyMatrix,
    Vector,
    after_each_call,
    background_entry,
    bind,
    entry,
    is_worth_calling,
    kernel,
    numbers_in,
)
from rockframe.compiled.callbacks import _raised, run_and_raise
from rockframe.compiled.entries import Entry
from rockframe.compiled.parallel import compile_all
from rockframe.compiled.sources import bound_source

pytestmark = [
    pytest.mark.unit,
    pytest.mark.skipif(not COMPILED, reason="compilation is off in this run"),
]


class Scale(NamedTuple):
    factor: float
    table: Any


@kernel
def gathered(
    scale: Scale, row: int, x: float, out: Vector, counts: Integers, table: ReadOnlyMatrix,
    y: float, more: Vector, last: int,
) -> int:  # fmt: skip
    """Take more arguments than registers hold."""
    out[0] = scale.factor * (x + 10.0 * y) * scale.table[row] + table[row, last]
    out[1] = float(len(out) + len(more)) + more[1]
    counts[0] += 7 * row
    return last + counts[0]


class Handed(NamedTuple):
    function: BoundFunction
    numbers: Vector


@background_entry
def through(
    handed: Handed, row: int, out: Vector, counts: Integers, table: ReadOnlyMatrix, more: Vector
) -> int:
    result = 0
    for _ in range(2):
        result = handed.function.call(row, 0.5, out, counts, table, -0.25, more, 1, handed.numbers)
    return result


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path / "code"))
    bound_source.cache_clear()  # together with their references to another folder


def arguments(row, own=0.0):
    scale = Scale(3.0 + own, np.array([1.0, 2.0, 4.0]))
    (function,) = bind((gathered,), scale, rarely_called=True)
    table = np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 7.0]])
    table.setflags(write=False)
    handed = Handed(function, numbers_in(scale))
    return handed, row, np.zeros(3), np.array([5, 6]), table, np.array([0.25, 0.75])


def result_of(inputs):
    code = through(*inputs)
    return code, inputs[2].tolist(), inputs[3].tolist()


EXPECTED = (1 + 5 + 28, [3.0 * (0.5 - 2.5) * 4.0 + 7.0, 5.75, 0.0], [33, 6])


def test_python_machine_code_and_callbacks_agree():
    inputs = arguments(2)
    source = inputs[0].function.source
    source.code, source.address, source.fallback_seconds = None, 0, 0.0
    assert result_of(inputs) == EXPECTED
    assert source.address == 0
    assert source.fallback_seconds > 0.0
    # the passed numbers are used, not those at binding
    handed, *others = arguments(2)
    other = Handed(handed.function, numbers_in(Scale(-3.0, np.array([1.0, 2.0, 8.0]))))
    through(other, *others)
    assert others[1][0] == -3.0 * (0.5 - 2.5) * 8.0 + 7.0
    assert source.address == 0
    source.fallback_seconds = 1e9
    assert result_of(arguments(2)) == EXPECTED
    assert source.address != 0
    # stored machine code is used at once
    source.code, source.address, source.fallback_seconds = None, 0, 0.0
    assert result_of(arguments(2)) == EXPECTED
    assert source.address != 0


def test_caller_is_told_of_each_call_of_a_function_in_python():
    inputs, calls = arguments(2), []
    source = inputs[0].function.source
    with after_each_call(lambda: calls.append(source.address)):
        assert result_of(inputs) == EXPECTED  # called back by machine code
        assert calls == [0, 0]
        through._plain(*arguments(2))
        assert calls == [0, 0, 0, 0]
        source.fallback_seconds = 1e9
        result_of(arguments(2))  # compiled by now
        assert len(calls) == 4
    assert result_of(arguments(2)) == EXPECTED


class Nested(NamedTuple):
    first: Annotated[BoundFunction, gathered]
    handed_numbers: Vector


class Outer(NamedTuple):
    share: float
    inner: Nested
    places: Integers


@kernel
def weighted(
    scale: Scale, outer: Outer, row: int, out: Vector, counts: Integers, table: ReadOnlyMatrix,
    more: Vector,
) -> float:  # fmt: skip
    """Take a tuple in which there are arrays, and a function to call."""
    code = outer.inner.first.call(
        row, outer.share, out, counts, table, -0.25, more, 1, outer.inner.handed_numbers
    )
    outer.places[0] += code
    return scale.factor * (code + outer.share)


class Weighing(NamedTuple):
    function: BoundFunction
    numbers: Vector


@background_entry
def weigh(
    weighing: Weighing, outer: Outer, row: int, out: Vector, counts: Integers,
    table: ReadOnlyMatrix, more: Vector, results: Vector,
) -> None:  # fmt: skip
    for i in range(len(results)):
        results[i] = weighing.function.call(outer, row, out, counts, table, more, weighing.numbers)


@pytest.mark.parametrize("inner_is_compiled", [True, False])
def test_python_calls_machine_code(inner_is_compiled, monkeypatch):
    handed, row, *arrays = arguments(2)
    scale = Scale(0.5, np.zeros(1))
    (function,) = bind((weighted,), scale)

    def call(run):
        places, results = np.array([1]), np.zeros(3)
        own = arrays[0].copy(), arrays[1].copy(), *arrays[2:]
        outer = Outer(0.5, Nested(handed.function, handed.numbers), places)
        run(Weighing(function, numbers_in(scale)), outer, row, *own, results)
        return places.tolist(), results.tolist(), own[0].tolist(), own[1].tolist()

    in_python = call(weigh._plain)
    if inner_is_compiled:
        handed.function.source.fallback_seconds = 1e9
        through(*arguments(2))
    call(weigh)
    assert function.source.address != 0
    assert (handed.function.source.address != 0) is inner_is_compiled
    assert call(weigh._plain) == in_python
    monkeypatch.setattr(function.source, "function", None)  # is not called
    assert call(weigh._plain) == in_python


def test_loop_runs_as_python_until_it_pays_to_compile_it(monkeypatch):
    monkeypatch.setattr("rockframe.compiled.parallel.START_AFTER", 0.0)  # no entry is a moment
    loop = Entry(weigh.source, waits=False, calls_back=True)
    handed, row, *arrays = arguments(2)
    scale = Scale(0.5, np.zeros(1))
    (function,) = bind((weighted,), scale)

    def call():
        results, own = np.zeros(3), (arrays[0].copy(), arrays[1].copy(), *arrays[2:])
        outer = Outer(0.5, Nested(handed.function, handed.numbers), np.array([1]))
        loop(Weighing(function, numbers_in(scale)), outer, row, *own, results)
        return results.tolist()

    in_python = call()
    (routine,) = loop._routines.values()
    function.source.take(compile_all([function.source.job])[0])
    assert call() == in_python
    assert routine.code is None
    assert routine.fallback_seconds > 0.0
    compile_all([routine.job])  # as another process
    assert call() == in_python
    assert routine.code is not None


@kernel
def interrupted(scale: Scale, out: Vector) -> int:
    """Be interrupted by the keyboard."""
    raise KeyboardInterrupt("by hand")  # noqa: EM101


def test_exceptions_of_callbacks_propagate():
    (function,) = bind((interrupted,), Scale(1.0, np.zeros(1)), rarely_called=True)
    with pytest.raises(KeyboardInterrupt, match="by hand"):
        call(Handed(function, np.zeros(2)), np.zeros(1))
    # and is raised only once
    assert result_of(arguments(2)) == EXPECTED


def test_entry_that_compiles_in_a_moment_is_compiled_at_once():
    loop = Entry(call.source, waits=False, calls_back=True)
    scale = Scale(2.0, np.zeros(1))
    (function,) = bind((plain,), scale)
    function.source.take(compile_all([function.source.job])[0])
    assert loop(Handed(function, numbers_in(scale)), np.zeros(1)) == 5
    (routine,) = loop._routines.values()
    assert routine.code is not None


def uncompilable_loop(handed: Handed, out: Vector) -> int:
    return eval("1") * handed.function.call(out, handed.numbers)  # noqa: S307


def test_uncompilable_loop_runs_as_python_around_machine_code(monkeypatch, fallbacks):
    monkeypatch.setattr("rockframe.compiled.parallel.START_AFTER", 0.0)
    loop = Entry(uncompilable_loop, waits=False, calls_back=True)
    scale = Scale(2.0, np.zeros(1))
    (function,) = bind((plain,), scale)
    function.source.take(compile_all([function.source.job])[0])
    for _ in range(3):
        assert loop(Handed(function, numbers_in(scale)), np.zeros(1)) == 5
        (routine,) = loop._routines.values()
        routine.fallback_seconds = 1e9
        monkeypatch.setattr("rockframe.compiled.entries.WAITS", True)  # compile in this process
    assert routine.failed
    assert len(fallbacks) == 1
    fallbacks.clear()


def test_call_inside_a_callback_keeps_exceptions_of_the_call_around_it():
    def raising_then_calling():
        _raised.first = ValueError("of the call around")
        assert run_and_raise(lambda: 3, []) == 3
        return 0

    with pytest.raises(ValueError, match="of the call around"):
        run_and_raise(raising_then_calling, [])
    assert run_and_raise(lambda: 3, []) == 3


@kernel
def hopeless(scale: Scale, out: Vector) -> int:
    """Do what numba cannot compile."""
    out[0] = eval("1.0") * scale.factor  # noqa: S307
    return 3


@background_entry
def call(handed: Handed, out: Vector) -> int:
    return handed.function.call(out, handed.numbers)


def test_uncompilable_callback_runs_as_python(fallbacks):
    scale = Scale(1.0, np.zeros(1))
    (function,) = bind((hopeless,), scale, rarely_called=True)
    function.source.fallback_seconds = 1e9
    out = np.zeros(1)
    for _ in range(3):
        assert call(Handed(function, numbers_in(scale)), out) == 3
    assert out[0] == 1.0
    assert len(fallbacks) == 1
    fallbacks.clear()


@entry
def at_length(handed: Handed, out: Vector) -> int:
    return handed.function.call(out, handed.numbers)


@kernel
def plain(scale: Scale, out: Vector) -> int:
    """Do little work."""
    out[0] = scale.factor
    return 5


def test_long_running_call_compiles_instead_of_calling_back():
    scale = Scale(2.0, np.zeros(1))
    (function,) = bind((plain,), scale, rarely_called=True)
    out = np.zeros(1)
    assert at_length(Handed(function, numbers_in(scale)), out) == 5
    assert out[0] == 2.0
    assert function.source.address != 0
    assert function.source.fallback_seconds == 0.0


def test_function_is_compiled_once_fallback_exceeds_compilation_time(monkeypatch):
    scale = Scale(2.0, np.zeros(1))
    (own,) = bind((plain,), scale)
    source = own.source
    assert not is_worth_calling(own)
    source.fallback_seconds = 0.5 * source.job.seconds
    assert not is_worth_calling(own)
    assert source.address == 0
    monkeypatch.setattr("rockframe.compiled.parallel.START_AFTER", 0.0)
    source.fallback_seconds = 2.0 * source.job.seconds
    assert is_worth_calling(own)
    assert source.address != 0
    # another process, without these timings, finds it stored
    bound_source.cache_clear()
    (rebound,) = bind((plain,), scale)
    assert rebound.source is not source
    assert is_worth_calling(rebound)
    assert rebound.source.address != 0


def test_uncompilable_function_is_not_retried(fallbacks):
    (own,) = bind((hopeless,), Scale(1.0, np.zeros(1)))
    own.source.fallback_seconds = 1e9
    for _ in range(3):
        assert not is_worth_calling(own)
    assert own.source.failed
    assert len(fallbacks) == 1
    fallbacks.clear()
