"""Functions compiled only with their entries equal those that numba compiles by itself."""

import re

import numpy as np
import pytest

from rockframe.compiled import COMPILED, Vector, entry, inlined, kernel

pytestmark = [
    pytest.mark.unit,
    pytest.mark.skipif(not COMPILED, reason="compilation is off in this run"),
]


@kernel
def root_of(x: float) -> float:
    if x < 0.0:
        raise ValueError("below zero", x)  # noqa: EM101
    return x**0.5


@kernel
def left(x: float) -> float:
    return root_of(x) + 1.0


@inlined
def right(x: float) -> float:
    return root_of(x) * 3.0


@entry
def both(values: Vector) -> None:
    for i in range(len(values)):
        values[i] = left(values[i]) + right(values[i])


@kernel
def thrice(x: float) -> float:
    return 3.0 * root_of(x)


@entry
def again(values: Vector) -> None:
    values[0] = thrice(values[0]) + 3.0


@entry
def one(values: Vector) -> None:
    for i in range(len(values)):
        values[i] = left(values[i])


@entry
def alone(values: Vector) -> None:
    """Called by one test only, since compiled code remains between tests."""
    for i in range(len(values)):
        values[i] = left(values[i])


@entry
def many(values: Vector) -> None:
    for i in range(len(values)):
        values[i] *= values[i]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path))


@pytest.fixture
def compiled_names(monkeypatch):
    """Return the names of all functions that numba turns into machine code."""
    from numba.core.codegen import JITCodeLibrary

    names = []
    finish = JITCodeLibrary._finalize_specific
    monkeypatch.setattr(
        JITCodeLibrary, "_finalize_specific",
        lambda self: (names.append(self.name), finish(self)),
    )  # fmt: skip
    return names


def test_only_entries_become_machine_code(compiled_names):
    from rockframe.compiled import linking

    if not linking.IS_SUPPORTED:
        pytest.skip(f"this version of numba is none of {linking.TESTED}")
    values = np.array([9.0, 16.0])
    both(values)
    assert values.tolist() == [13.0, 17.0]
    alone(values)
    assert values.tolist() == [13.0**0.5 + 1.0, 17.0**0.5 + 1.0]
    # besides the runtime of numba, compiled once in a process
    assert [name for name in compiled_names if name != "nrt"] == ["run", "run"]


def test_an_entry_is_optimised_once(compiled_names, monkeypatch):
    from numba.core.codegen import CPUCodegen

    options, passes = [], CPUCodegen._module_pass_manager
    monkeypatch.setattr(
        CPUCodegen, "_module_pass_manager",
        lambda self, **words: (options.append(words), passes(self, **words))[1],
    )  # fmt: skip
    values = np.array([-9.0, 16.0])
    many(values)
    assert values.tolist() == [81.0, 256.0]
    assert options == [{}] * len(compiled_names) != []


def test_errors_of_deferred_functions_propagate():
    with pytest.raises(ValueError, match="below zero") as caught:
        one(np.array([-4.0]))
    assert caught.value.args == ("below zero", -4.0)


def test_user_njit_function_can_call_deferred_function(compiled_names):
    import numba

    one(np.array([4.0]))

    @numba.njit
    def own(x):
        return left(x) + 1.0

    assert own(9.0) == 5.0
    assert sum("left" in name for name in compiled_names) == 1


def test_unsupported_numba_compiles_normally(compiled_names, monkeypatch):
    from rockframe.compiled import linking

    monkeypatch.setattr(linking, "IS_SUPPORTED", False)
    values = np.array([9.0])
    again(values)
    assert values.tolist() == [12.0]
    assert any("thrice" in name for name in compiled_names)


@kernel
def listed(x: float) -> float:
    values = [root_of(x), x]
    values.append(2.0)
    room = np.zeros(3)
    for i in range(3):
        room[i] = values[i]
    return room.sum()


@entry
def summed(values: Vector) -> None:
    for i in range(len(values)):
        values[i] = right(listed(values[i]))


def test_allocating_functions_count_references():
    """Arrays that are returned or released need counts; functions of numbers alone do not."""
    from numba.core.runtime import _nrt_python, rtsys

    from rockframe.compiled.passes import makes_only_numbers

    counting = [
        function
        for function in (root_of, left, right, thrice, listed)
        if not makes_only_numbers(function)
    ]
    assert counting == [root_of, listed]
    values = np.array([9.0, 16.0])
    summed(values)
    assert values.tolist() == [3.0 * 14.0**0.5, 3.0 * 22.0**0.5]
    _nrt_python.memsys_enable_stats()
    before = rtsys.get_allocation_stats()
    summed(np.full(1000, 9.0))
    after = rtsys.get_allocation_stats()
    _nrt_python.memsys_disable_stats()
    assert after.alloc - before.alloc == after.free - before.free > 1000


def of_all_kinds(pair, x):
    total, (first, second) = 0.0, pair
    for i in range(len(pair)):
        total += pair[i] * x**2 if x > first else max(total, min(second, abs(x)))
    return bool(total > 1.0) & (x == x), (total, int(x))


def test_omitted_passes_do_not_change_generated_code():
    import numba

    from rockframe.compiled.passes import _OMITTED_PASSES, PlainPasses, makes_only_numbers

    assert makes_only_numbers(of_all_kinds)
    written = []
    for words in ({}, {"pipeline_class": PlainPasses}):
        code = numba.njit(error_model="numpy", _nrt=False, **words)(of_all_kinds)
        assert code((2.0, 3.0), 4.0) == of_all_kinds((2.0, 3.0), 4.0)
        (text,), ((_, done),) = code.inspect_asm().values(), code.get_metadata().items()
        # names contain counters and addresses
        text = re.sub(r'"[^"]*"|\S*_ZN\S*', "", text)
        written.append([line for line in text.splitlines() if re.match(r"\t[a-z]", line)])
        done = {name.partition("_")[2] for name in done["pipeline_times"]["nopython"]}
        assert done.isdisjoint(_OMITTED_PASSES) if words else done >= _OMITTED_PASSES
    assert written[0] == written[1] != []


def test_operator_lookup_is_cached_only_during_compilation():
    import numba

    from rockframe.compiled.jobs import cached_operators

    kind = numba.types.Function
    plain, lookups = kind.get_call_type, []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            numba.core.types.functions.BaseFunction, "get_call_type",
            lambda *words: (lookups.append(words[2]), plain(*words))[1],
        )  # fmt: skip
        with cached_operators():
            many = numba.njit(lambda x, n: (x + x) * (x + x) + (n + n) * (x + n))
            assert many(2.0, 3) == 46.0
    sums = [words for words in lookups if words == (numba.float64, numba.float64)]
    assert 1 <= len(sums) <= 2  # an addition, a multiplication
    assert kind.get_call_type is plain
    assert "get_call_type" not in vars(kind)
