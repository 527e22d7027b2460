"""Arrays as compiled functions see them: an address and a shape, without reference counting.

Indices are not checked, and none counts from the end.

numba counts the references to its own arrays, which takes nanoseconds each time one is taken
out of a tuple: that would be most of the time of a step. A buffer belongs to the caller.
Made with numba's documented extension interface; imported only where numba is installed.
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
templates: Final[Any] = import_module("numba.core.typing.templates")


_INLINED: Final = {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


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
    """Return the buffer of an array that the caller keeps, in compiled code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        struct = context.make_array(signature.args[0])(context, builder, values[0])
        result = cgutils.create_struct_proxy(signature.return_type)(context, builder)
        result.address, result.shape = struct.data, struct.shape
        return result._getvalue()

    return BufferType(array.dtype, array.ndim, array.mutable)(array), code


@extending.intrinsic
def _new_view(_: Any, buffer: Any, first: Any, count: Any) -> Any:
    """Return a buffer of some elements, or rows, of another, in compiled code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        proxy = cgutils.create_struct_proxy(buffer)(context, builder, value=values[0])
        result = cgutils.create_struct_proxy(buffer)(context, builder)
        offset = builder.mul(values[1], context.get_constant(numba.intp, buffer.stride))
        for i in range(1, buffer.dimensions):
            offset = builder.mul(offset, builder.extract_value(proxy.shape, i))
        result.address = builder.gep(proxy.address, [offset])
        result.shape = builder.insert_value(proxy.shape, values[2], 0)
        return result._getvalue()

    return buffer(buffer, numba.intp, numba.intp), code


@extending.intrinsic
def _with_number(_: Any, numbers: Any, index: Any, number: Any) -> Any:
    """Return a tuple with another number at a place, in compiled code."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        slot = cgutils.alloca_once_value(builder, values[0])
        zero = context.get_constant(numba.intp, 0)
        builder.store(values[2], builder.gep(slot, [zero, values[1]]))
        return builder.load(slot)

    return numbers(numbers, numba.intp, numbers.dtype), code


@extending.intrinsic
def _strided(_: Any, buffer: Any, first: Any) -> Any:
    """Return a buffer with stride `LANES` from an index on, in compiled code."""
    strided = BufferType(buffer.dtype, 1, buffer.writeable, language.LANES)

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        proxy = cgutils.create_struct_proxy(buffer)(context, builder, value=values[0])
        result = cgutils.create_struct_proxy(strided)(context, builder)
        result.address, result.shape = builder.gep(proxy.address, [values[1]]), proxy.shape
        return result._getvalue()

    return strided(buffer, numba.intp), code


@extending.intrinsic
def _as_integers(_: Any, buffer: Any) -> Any:
    """Return a buffer of numbers as one of whole numbers of the same memory, in compiled code."""
    kind = BufferType(numba.int64, 1, buffer.writeable, buffer.stride)

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        proxy = cgutils.create_struct_proxy(buffer)(context, builder, value=values[0])
        result = cgutils.create_struct_proxy(kind)(context, builder)
        pointer = context.get_value_type(numba.types.CPointer(numba.int64))
        result.address, result.shape = builder.bitcast(proxy.address, pointer), proxy.shape
        return result._getvalue()

    return kind(buffer), code


@extending.intrinsic
def _use_widest_registers(_: Any) -> Any:
    """Let LLVM use the widest registers in the calling function, in compiled code.

    Where registers have 512 bits, LLVM by default uses 256 of them, which suits programs that need
    wide ones only now and then. llvmlite does not know this attribute, but writes any text.
    """

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')
        return context.get_dummy_value()

    return numba.void(), code


@extending.overload(language.widest_registers, strict=False, inline="always")
def _widest_registers() -> Callable[..., Any]:
    return lambda: _use_widest_registers()


@extending.overload(language.view_from, strict=False, jit_options=_INLINED)
def _view_from(array: Any, first: Any) -> Callable[..., Any]:
    return lambda array, first: _new_view(array, first, len(array) - first)


@extending.overload(language.view_of, strict=False, jit_options=_INLINED)
def _view_of(array: Any, first: Any, count: Any) -> Callable[..., Any]:
    return lambda array, first, count: _new_view(array, first, count)


@extending.overload(language.lane_of, strict=False, jit_options=_INLINED)
def _lane_of(array: Any, field: Any, lane: Any) -> Callable[..., Any]:
    return lambda array, field, lane: _strided(array, field * language.LANES + lane)


@extending.overload(language.as_integers, strict=False, jit_options=_INLINED)
def _integers_of(array: Any) -> Callable[..., Any]:
    return lambda array: _as_integers(array)


@templates.infer_global(operator.getitem)
class _Get(templates.AbstractTemplate):
    """The type of an element of a buffer."""

    def generic(self, arguments: Any, keywords: Any) -> Any:
        buffer, index = arguments
        if isinstance(buffer, BufferType) and (index_type := _index_type(buffer, index)):
            return buffer.dtype(buffer, index_type)
        return None


@extending.lower_builtin(operator.getitem, BufferType, numba.types.Any)
def _load(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    return builder.load(_address_of(context, builder, signature, values))


@templates.infer_global(operator.setitem)
class _Set(templates.AbstractTemplate):
    """What may be written to an element of a buffer."""

    def generic(self, arguments: Any, keywords: Any) -> Any:
        buffer, index, _ = arguments
        if (
            isinstance(buffer, BufferType)
            and buffer.writeable
            and (index_type := _index_type(buffer, index))
        ):
            return numba.void(buffer, index_type, buffer.dtype)
        return None


@extending.lower_builtin(operator.setitem, BufferType, numba.types.Any, numba.types.Any)
def _store(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    builder.store(values[2], _address_of(context, builder, signature, values))
    return context.get_dummy_value()


@templates.infer_global(len)
class _Length(templates.AbstractTemplate):
    """The type of the number of elements, or rows, of a buffer."""

    def generic(self, arguments: Any, keywords: Any) -> Any:
        (buffer,) = arguments
        return numba.intp(buffer) if isinstance(buffer, BufferType) else None


@extending.lower_builtin(len, BufferType)
def _length(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    proxy = cgutils.create_struct_proxy(signature.args[0])(context, builder, value=values[0])
    return builder.extract_value(proxy.shape, 0)


def _address_of(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    """Return the address of an element of a buffer."""
    buffer = signature.args[0]
    proxy = cgutils.create_struct_proxy(buffer)(context, builder, value=values[0])
    if buffer.dimensions == 1:
        offset = builder.mul(values[1], context.get_constant(numba.intp, buffer.stride))
    else:
        row, column = (builder.extract_value(values[1], i) for i in range(2))
        offset = builder.add(builder.mul(row, builder.extract_value(proxy.shape, 1)), column)
    return builder.gep(proxy.address, [offset])


def _index_type(buffer: BufferType, index: Any) -> Any:
    """Return the type of an index of an element; None for slices, which are not supported."""
    if buffer.dimensions == 1:
        return numba.intp if isinstance(index, numba.types.Integer) else None
    numbers = index if isinstance(index, numba.types.BaseTuple) else ()
    is_element = len(numbers) == buffer.dimensions and all(
        isinstance(number, numba.types.Integer) for number in numbers
    )
    return numba.types.UniTuple(numba.intp, buffer.dimensions) if is_element else None


@extending.overload(language.constant, strict=False, jit_options=_INLINED)
def _constant(value: Any, like: Any) -> Callable[..., Any]:
    return _function_from_source("value, like", f"return ({'value, ' * len(like)})")


@extending.overload(language.with_numbers, strict=False, jit_options=_INLINED)
def _with_numbers(numbers: Any, first: Any, others: Any) -> Callable[..., Any]:
    result = "numbers"
    for i in range(len(others)):
        result = f"with_number({result}, first + {i}, others[{i}])"
    return _function_from_source("numbers, first, others", f"return {result}")


@extending.overload(language.filled, strict=False, jit_options=_INLINED)
def _filled(like: Any, numbers: Any) -> Callable[..., Any]:
    some = ", ".join(f"numbers[{i}]" for i in range(len(like)))
    return _function_from_source("like, numbers", f"return kind({some})", kind=like.instance_class)


@extending.overload(language.put, strict=False, jit_options=_INLINED)
def _put(numbers: Any, first: Any, out: Any) -> Callable[..., Any]:
    if isinstance(numbers, BufferType):
        return _function_from_source(
            "numbers, first, out", "for i in range(len(numbers)): out[first + i] = numbers[i]"
        )
    lines = [f"out[first + {i}] = numbers[{i}]" for i in range(len(numbers))]
    return _function_from_source("numbers, first, out", "; ".join(lines) or "pass")


def _function_from_source(arguments: str, line: str, **names: Any) -> Callable[..., Any]:
    """Make a function from a line of source, whose length depends on that of a tuple."""
    scope: dict[str, Any] = {"with_number": _with_number, **names}
    exec(f"def written({arguments}):\n    {line}\n", scope)  # noqa: S102
    return scope["written"]
