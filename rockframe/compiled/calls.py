"""How compiled code calls marked functions, methods of named tuples, and bound functions.

Made with numba's documented extension interface; imported only where numba is installed. A bound
function is an address, and its signature is its type: with numba's own type for functions each
call of an entry would ask Python for all addresses, which takes longer than a short run.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any, Final

from rockframe.compiled.language import KERNELS, is_method
from rockframe.compiled.passes import PlainPasses, makes_only_numbers

# numba's own annotations are partial
numba: Final[Any] = import_module("numba")
extending: Final[Any] = import_module("numba.extending")
ir: Final[Any] = import_module("llvmlite.ir")
imputils: Final[Any] = import_module("numba.core.imputils")
templates: Final[Any] = import_module("numba.core.typing.templates")

OPTIONS: Final = {"error_model": "numpy"}
HELPER_OPTIONS: Final = OPTIONS | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Options of helper functions. Division by zero gives infinity or NaN as in numpy, unchecked."""

_registered: Final[dict[Callable[..., Any], Any]] = {}
"""Functions and methods registered with numba, and their compiled counterparts, to which numba
itself holds weak references only."""
_ANYTHING: Final = numba.types.VarArg(numba.types.Any)
_methods: Final[dict[Callable[..., Any], Any]] = {}
"""Templates by which numba finds the types in the call of a method."""


def register_kernels() -> None:
    """Register all functions and methods with numba that were marked since the last time."""
    for function, into_caller in list(KERNELS.items()):
        if function not in _registered:
            _register(function, into_caller)
            if is_method(function):
                _register_method(function)


def register_inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """Register one more function with numba, which is compiled into its callers."""
    _register(function, True)
    return function


class _Compiled(numba.types.Dispatcher):
    """numba's type of a compiled function that is not compiled again for constant arguments."""

    def get_call_type(self, context: Any, arguments: Any, keywords: Any) -> Any:
        """Return the types of a call; a constant argument has the type of its kind of number."""
        alike = [numba.types.unliteral(argument) for argument in arguments]
        named = {name: numba.types.unliteral(argument) for name, argument in keywords.items()}
        return super().get_call_type(context, alike, named)


extending.register_model(_Compiled)(extending.models.OpaqueModel)


@imputils.lower_constant(_Compiled)
def _no_value(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """Pass no value for a function that is an argument: its type identifies it."""
    return context.get_dummy_value()


def _register(function: Callable[..., Any], into_caller: bool) -> None:
    """Let calls of a function mean its compiled counterpart, one for all callers.

    numba's ``register_jitable`` compiles it again for callers with other options.
    """
    plain = makes_only_numbers(function)  # and has nothing whose references numba would count
    options: dict[str, Any] = HELPER_OPTIONS | {"forceinline": into_caller, "_nrt": not plain}
    if plain:
        options["pipeline_class"] = PlainPasses
    _registered[function] = numba.njit(**options)(function)
    templates.infer_global(function, _Compiled(_registered[function]))


def _register_method(function: Callable[..., Any]) -> None:
    """Let numba call a method as a function whose first argument is the object."""
    name = f"{function.__module__}.{function.__qualname__}"

    class Call(templates.AbstractTemplate):
        key = (name, function)

        def generic(self, arguments: Any, keywords: Any) -> Any:
            kind = self.context.resolve_value_type(function)
            call_type = kind.get_call_type(self.context, (self.this, *arguments), keywords)
            return call_type and call_type.as_method()

    @extending.lower_builtin(Call.key, numba.types.BaseNamedTuple, _ANYTHING)
    def call(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        kind = context.typing_context.resolve_value_type(function)
        call_type = kind.get_call_type(context.typing_context, signature.args, {})
        code = context.get_function(kind, call_type)
        context.add_linking_libs(getattr(code, "libs", ()))
        return code(builder, values)

    _methods[function] = Call


@templates.infer_getattr
class _MethodsOfTuples(templates.AttributeTemplate):
    """Lets numba find methods of a named tuple in its class, after its fields."""

    key = numba.types.BaseNamedTuple

    def generic_resolve(self, kind: Any, name: str) -> Any:
        attribute = None if name in kind.fields else getattr(kind.instance_class, name, None)
        call = _methods.get(attribute) if callable(attribute) else None
        return call and numba.types.BoundFunction(call, kind)


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
    """Make the function by which compiled code turns an integer into a callable address."""
    kind = CodeType(signature)

    @extending.intrinsic
    def as_code(_: Any, address: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            return values[0]

        return kind(numba.int64), code

    return as_code


@extending.intrinsic
def _call(_: Any, function: Any, arguments: Any) -> Any:
    """Call a function at an address with the elements of a tuple, in compiled code."""
    result_type, argument_types = function.signature.return_type, function.signature.args

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        converted = [
            context.cast(builder, builder.extract_value(values[1], i), kind, expected)
            for i, (kind, expected) in enumerate(zip(arguments, argument_types, strict=True))
        ]
        types = [context.get_value_type(expected) for expected in argument_types]
        pointer = ir.FunctionType(context.get_value_type(result_type), types).as_pointer()
        return builder.call(builder.inttoptr(values[0], pointer), converted)

    return result_type(function, arguments), code


@extending.overload_method(
    CodeType,
    "call",
    strict=False,
    jit_options={"no_cpython_wrapper": True, "no_cfunc_wrapper": True},
)
def _method(function: Any, *arguments: Any) -> Callable[..., Any]:
    return lambda function, *arguments: _call(function, arguments)
