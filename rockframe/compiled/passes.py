"""numba's compiler passes for plain functions, without passes that only other functions need.

A plain function raises no errors, makes no lists, arrays or functions, and uses no names of numpy
or numba.
"""

from dis import get_instructions
from importlib import import_module
from typing import Any, Final

# numba's own annotations are partial
_compiler: Final[Any] = import_module("numba.core.compiler")

_EXCLUDED_OPCODES: Final = {
    "RAISE_VARARGS",
    "BUILD_LIST",
    "BUILD_SET",
    "BUILD_MAP",
    "MAKE_FUNCTION",
}
"""Bytecode instructions that no plain function has."""

_OMITTED_PASSES: Final = {
    "with_lifting", "inline_closure_likes", "make_function_op_code_to_jit_function",
    "inline_inlinables", "Rewrite dynamic raises", "find_literally", "literal_unroll",
    "LiteralPropagation", "nopython_rewrites", "dump_parfor_diagnostics",
}  # fmt: skip
"""numba's passes over constructs that no plain function has."""


def makes_only_numbers(function: Any) -> bool:
    """Whether a function makes only numbers and tuples."""
    code = function.__code__
    named = (function.__globals__.get(name) for name in code.co_names)
    return _EXCLUDED_OPCODES.isdisjoint(
        instruction.opname for instruction in get_instructions(code)
    ) and not any(
        str(getattr(value, name, "")).startswith(("numpy", "numba"))
        for value in named
        for name in ("__name__", "__module__")
    )


def raises_exceptions(function: Any) -> bool:
    """Whether a function has statements that raise exceptions."""
    return any(instruction.opname == "RAISE_VARARGS" for instruction in get_instructions(function))


class PlainPasses(_compiler.CompilerBase):
    """The passes over a plain function; they give the same result as all passes of numba."""

    def define_pipelines(self) -> list[Any]:
        """Return the passes, in numba's order."""
        passes = _compiler.DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.passes = [
            compiler_pass
            for compiler_pass in passes.passes
            if compiler_pass[0].name() not in _OMITTED_PASSES
        ]
        passes.finalize()
        return [passes]
