"""Arrays as compiled functions see them: an address and a shape, and nothing to keep count of.

Indices are not checked, and none counts from the end.

numba counts the references to its own arrays, a matter of nanoseconds each time one is taken
out of a tuple, which is most of the time of a step. A buffer belongs to whoever called.
Made with numba's documented extension interface; imported only where numba is.
"""

import operator
from collections.abc import Callable
from importlib import import_module
from typing import Any, Final

from rockframe.compiled import language

# numba's own annotations are partial
numba: Final[Any] = import_module("numba")
extending: Final[Any] = import_module("numba.extending")
cgutils: Final[Any] = import_module("numba.core.cgutils")


_INTO_CALLERS: Final = {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


class BufferType(numba.types.Type):
    """numba's type of a buffer."""

    def __init__(self, dtype: Any, dimensions: int, writeable: bool, stride: int = 1) -> None:
        self.dtype = dtype
        self.dimensions = dimensions
        self.writeable = writeable
        self.stride = stride
        super().__init__(name=f"buffer({dtype}, {dimensions}, {writeable}, {stride})")


@extending.register_model(BufferType)
class _BufferModel(extending.models.StructModel):
    def __init__(self, manager: Any, kind: BufferType) -> None:
        members = [
            ("address", numba.types.CPointer(kind.dtype)),
            ("shape", numba.types.UniTuple(numba.int64, kind.dimensions)),
        ]
        super().__init__(manager, kind, members)


extending.make_attribute_wrapper(BufferType, "address", "address")
extending.make_attribute_wrapper(BufferType, "shape", "shape")


@extending.intrinsic
def buffer_of(_: Any, array: Any) -> Any:
    """Give the buffer of an array that somebody else keeps, in compiled code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        given = context.make_array(signature.args[0])(context, builder, values[0])
        made = cgutils.create_struct_proxy(signature.return_type)(context, builder)
        made.address, made.shape = given.data, given.shape
        return made._getvalue()

    return BufferType(array.dtype, array.ndim, array.mutable)(array), code


@extending.intrinsic
def _load(_: Any, address: Any, offset: Any) -> Any:
    """Read the element at an offset, in compiled code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return builder.load(builder.gep(values[0], [values[1]]))

    return address.dtype(address, numba.intp), code


@extending.intrinsic
def _store(_: Any, address: Any, offset: Any, value: Any) -> Any:
    """Write the element at an offset, in compiled code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        builder.store(values[2], builder.gep(values[0], [values[1]]))
        return context.get_dummy_value()

    return numba.void(address, numba.intp, address.dtype), code


@extending.intrinsic
def _shifted(_: Any, kept: Any, first: Any) -> Any:
    """Give a buffer from an index on, in compiled code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        given = cgutils.create_struct_proxy(kept)(context, builder, value=values[0])
        made = cgutils.create_struct_proxy(kept)(context, builder)
        made.address = builder.gep(given.address, [values[1]])
        length = builder.sub(builder.extract_value(given.shape, 0), values[1])
        made.shape = builder.insert_value(given.shape, length, 0)
        return made._getvalue()

    return kept(kept, numba.intp), code


@extending.intrinsic
def _stretch(_: Any, kept: Any, first: Any, count: Any) -> Any:
    """Give a buffer of some elements, or rows, of another, in compiled code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        given = cgutils.create_struct_proxy(kept)(context, builder, value=values[0])
        made = cgutils.create_struct_proxy(kept)(context, builder)
        offset = builder.mul(values[1], context.get_constant(numba.intp, kept.stride))
        for i in range(1, kept.dimensions):
            offset = builder.mul(offset, builder.extract_value(given.shape, i))
        made.address = builder.gep(given.address, [offset])
        made.shape = builder.insert_value(given.shape, values[2], 0)
        return made._getvalue()

    return kept(kept, numba.intp, numba.intp), code


@extending.intrinsic
def _with_number(_: Any, numbers: Any, place: Any, number: Any) -> Any:
    """Give a tuple with another number at a place, in compiled code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        room = cgutils.alloca_once_value(builder, values[0])
        zero = context.get_constant(numba.intp, 0)
        builder.store(values[2], builder.gep(room, [zero, values[1]]))
        return builder.load(room)

    return numbers(numbers, numba.intp, numbers.dtype), code


@extending.intrinsic
def _strided(_: Any, kept: Any, first: Any) -> Any:
    """Give the buffer of every element that is some lanes further, in compiled code."""
    strided = BufferType(kept.dtype, 1, kept.writeable, language.LANES)

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        given = cgutils.create_struct_proxy(kept)(context, builder, value=values[0])
        made = cgutils.create_struct_proxy(strided)(context, builder)
        made.address, made.shape = builder.gep(given.address, [values[1]]), given.shape
        return made._getvalue()

    return strided(kept, numba.intp), code


@extending.intrinsic
def _as_integers(_: Any, kept: Any) -> Any:
    """Give a buffer of numbers as one of whole numbers of the same memory, in compiled code."""
    kind = BufferType(numba.int64, 1, kept.writeable, kept.stride)

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        given = cgutils.create_struct_proxy(kept)(context, builder, value=values[0])
        made = cgutils.create_struct_proxy(kind)(context, builder)
        pointer = context.get_value_type(numba.types.CPointer(numba.int64))
        made.address, made.shape = builder.bitcast(given.address, pointer), given.shape
        return made._getvalue()

    return kind(kept), code


@extending.intrinsic
def _widen(_: Any) -> Any:
    """Let LLVM use the widest registers in the function that calls, in compiled code.

    Where they are 512 bits wide it prefers half of them, for programs that use them now and
    then. llvmlite names no such attribute of functions, but prints any.
    """

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')
        return context.get_dummy_value()

    return numba.void(), code


@extending.overload(language.widest_registers, strict=False, inline="always")
def _widest_registers() -> Callable[..., Any]:
    return lambda: _widen()


@extending.overload(language.part_of, strict=False, jit_options=_INTO_CALLERS)
def _part_of(array: Any, first: Any) -> Callable[..., Any]:
    return lambda array, first: _shifted(array, first)


@extending.overload(language.stretch, strict=False, jit_options=_INTO_CALLERS)
def _stretch_of(array: Any, first: Any, count: Any) -> Callable[..., Any]:
    return lambda array, first, count: _stretch(array, first, count)


@extending.overload(language.lane_of, strict=False, jit_options=_INTO_CALLERS)
def _lane_of(array: Any, field: Any, lane: Any) -> Callable[..., Any]:
    return lambda array, field, lane: _strided(array, field * language.LANES + lane)


@extending.overload(language.as_integers, strict=False, jit_options=_INTO_CALLERS)
def _integers_of(array: Any) -> Callable[..., Any]:
    return lambda array: _as_integers(array)


@extending.overload(operator.getitem, strict=False, jit_options=_INTO_CALLERS)
def _get(kept: Any, place: Any) -> Callable[..., Any] | None:
    if not (isinstance(kept, BufferType) and _is_place(place)):
        return None
    if kept.dimensions == 1:
        stride = kept.stride
        return lambda kept, place: _load(kept.address, place * stride)
    return lambda kept, place: _load(kept.address, place[0] * kept.shape[1] + place[1])


@extending.overload(operator.setitem, strict=False, jit_options=_INTO_CALLERS)
def _set(kept: Any, place: Any, value: Any) -> Callable[..., Any] | None:
    if not (isinstance(kept, BufferType) and kept.writeable and _is_place(place)):
        return None
    if kept.dimensions == 1:
        stride = kept.stride
        return lambda kept, place, value: _store(kept.address, place * stride, value)
    return lambda kept, place, value: _store(
        kept.address, place[0] * kept.shape[1] + place[1], value
    )


@extending.overload(len, strict=False, jit_options=_INTO_CALLERS)
def _length(kept: Any) -> Callable[..., Any] | None:
    if not isinstance(kept, BufferType):
        return None
    return lambda kept: kept.shape[0]


@extending.overload(language.constant, strict=False, jit_options=_INTO_CALLERS)
def _constant(value: Any, like: Any) -> Callable[..., Any]:
    return _written("value, like", f"return ({'value, ' * len(like)})")


@extending.overload(language.with_numbers, strict=False, jit_options=_INTO_CALLERS)
def _with_numbers(numbers: Any, first: Any, others: Any) -> Callable[..., Any]:
    made = "numbers"
    for i in range(len(others)):
        made = f"with_number({made}, first + {i}, others[{i}])"
    return _written("numbers, first, others", f"return {made}")


@extending.overload(language.filled, strict=False, jit_options=_INTO_CALLERS)
def _filled(like: Any, numbers: Any) -> Callable[..., Any]:
    some = ", ".join(f"numbers[{i}]" for i in range(len(like)))
    return _written("like, numbers", f"return kind({some})", kind=like.instance_class)


@extending.overload(language.put, strict=False, jit_options=_INTO_CALLERS)
def _put(numbers: Any, first: Any, out: Any) -> Callable[..., Any]:
    if isinstance(numbers, BufferType):
        return _written(
            "numbers, first, out", "for i in range(len(numbers)): out[first + i] = numbers[i]"
        )
    lines = [f"out[first + {i}] = numbers[{i}]" for i in range(len(numbers))]
    return _written("numbers, first, out", "; ".join(lines) or "pass")


def _is_place(place: Any) -> bool:
    """Whether an index is a number, or one for each dimension; slices are not known."""
    numbers = place if isinstance(place, numba.types.BaseTuple) else (place,)
    return all(isinstance(number, numba.types.Integer) for number in numbers)


def _written(arguments: str, line: str, **names: Any) -> Callable[..., Any]:
    """Make a function of one line, as long as some tuple is."""
    scope: dict[str, Any] = {"with_number": _with_number, **names}
    exec(f"def written({arguments}):\n    {line}\n", scope)  # noqa: S102
    return scope["written"]
