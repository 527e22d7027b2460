"""Bound functions as compiled code sees them: an address, and the signature as its type.

numba's own type of functions asks Python for the address of each one in each call of an entry,
which takes longer than a short run. Made with numba's documented extension interface.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any, Final

# numba's own annotations are partial
numba: Final[Any] = import_module("numba")
extending: Final[Any] = import_module("numba.extending")
ir: Final[Any] = import_module("llvmlite.ir")


class CodeType(numba.types.Type):
    """numba's type of a function at an address."""

    def __init__(self, signature: Any) -> None:
        self.signature = signature
        super().__init__(name=f"code({signature})")


@extending.register_model(CodeType)
class _CodeModel(extending.models.PrimitiveModel):
    def __init__(self, manager: Any, kind: CodeType) -> None:
        super().__init__(manager, kind, ir.IntType(64))


def code_at(signature: Any) -> Any:
    """Make the function that takes a whole number for the address of a function."""
    kind = CodeType(signature)

    @extending.intrinsic
    def as_code(_: Any, address: Any) -> Any:
        def code(context: Any, builder: Any, given: Any, values: Any) -> Any:
            return values[0]

        return kind(numba.int64), code

    return as_code


@extending.intrinsic
def _call(_: Any, function: Any, arguments: Any) -> Any:
    """Call a function at an address with the elements of a tuple, in compiled code."""
    gives, takes = function.signature.return_type, function.signature.args

    def code(context: Any, builder: Any, given: Any, values: Any) -> Any:
        handed = [
            context.cast(builder, builder.extract_value(values[1], i), found, taken)
            for i, (found, taken) in enumerate(zip(arguments, takes, strict=True))
        ]
        kinds = [context.get_value_type(taken) for taken in takes]
        pointer = ir.FunctionType(context.get_value_type(gives), kinds).as_pointer()
        return builder.call(builder.inttoptr(values[0], pointer), handed)

    return gives(function, arguments), code


@extending.overload_method(
    CodeType,
    "call",
    strict=False,
    jit_options={"no_cpython_wrapper": True, "no_cfunc_wrapper": True},
)
def _method(function: Any, *arguments: Any) -> Callable[..., Any]:
    return lambda function, *arguments: _call(function, arguments)
