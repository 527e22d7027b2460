"""Arguments that several functions share: declared, documented and checked in one place."""

import inspect
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import wraps
from textwrap import fill
from typing import Any, Final, TypeVar, cast, get_type_hints

from rockframe.errors import ArgumentError, did_you_mean
from rockframe.suggestions import raise_call_error

Function = TypeVar("Function", bound=Callable[..., Any])

_WIDTH: Final = 92
_INDENT: Final = "    "
_PARAMETERS: Final = re.compile(
    r"(?<=^Parameters\n----------\n).*?(?=^\S[^\n]*\n---|\Z)", re.M | re.S
)
_ROW: Final = re.compile(r"^(?=\S)", re.M)


@dataclass(frozen=True)
class Argument:
    """Default and documentation of an argument: the metadata of ``Annotated``."""

    default: object  # value if the argument is left out
    kind: str  # type, as the documentation writes it
    description: str  # description, with its unit


def declared_arguments(kind: type) -> dict[str, Argument]:
    """Return the arguments of a typed dictionary by name."""
    hints = get_type_hints(kind, include_extras=True)
    return {name: hint.__metadata__[0] for name, hint in hints.items()}


def with_documented_arguments(kind: type) -> Callable[[Function], Function]:
    """Add the shared arguments to the docstring of a function that takes them by name."""

    def decorate(function: Function) -> Function:
        names = inspect.signature(function).parameters
        function.__doc__ = completed_docstring(
            function.__doc__ or "", names, declared_arguments(kind)
        )
        return function

    return decorate


def with_shared_arguments(
    kind: type, *, extra_into: str | None = None, **defaults: object
) -> Callable[[Function], Function]:
    """Make a function take shared arguments, which it declares as ``**run: Unpack[kind]``.

    An argument of any other name goes into the mapping argument `extra_into`, if that is set.
    """
    declared = declared_arguments(kind)

    def decorate(function: Function) -> Function:
        signature = inspect.signature(function)
        first = [
            parameter
            for parameter in signature.parameters.values()
            if parameter.kind is not parameter.VAR_KEYWORD
        ]
        shared = [
            inspect.Parameter(
                name, inspect.Parameter.KEYWORD_ONLY, default=defaults.get(name, argument.default)
            )
            for name, argument in declared.items()
        ]
        complete = signature.replace(parameters=[*first, *shared])
        more = inspect.Parameter(
            f"more_{extra_into}", inspect.Parameter.VAR_KEYWORD, annotation=Any
        )
        shown = complete.replace(parameters=[*first, *shared, *([more] if extra_into else [])])

        @wraps(function)
        def call(*values: Any, **named: Any) -> Any:
            unknown = [name for name in named if name not in complete.parameters]
            if unknown and extra_into is None:
                raise ArgumentError(
                    _unknown_argument(function.__qualname__, unknown[0], complete.parameters)
                )
            if unknown and extra_into is not None:
                more_named = {name: named.pop(name) for name in unknown}
                mapping = {} if named.get(extra_into) is None else named[extra_into]
                if isinstance(mapping, Mapping):  # the function refuses anything else
                    twice = [name for name in unknown if name in mapping]
                    if twice:
                        msg = (
                            f"{function.__qualname__}() got {twice[0]!r} twice, also in "
                            f"{extra_into!r}"
                        )
                        raise ArgumentError(msg)
                    named[extra_into] = {**mapping, **more_named}
            try:
                return function(*values, **{**defaults, **named})
            except TypeError as problem:
                raise_call_error(problem, complete.parameters)
                raise

        cast("Any", call).__signature__ = shown
        cast("Any", call).hints = {}  # so that `with_hints` does not wrap it again
        call.__doc__ = completed_docstring(function.__doc__ or "", shown.parameters, declared)
        return cast("Function", call)

    return decorate


def _unknown_argument(function: str, name: str, known: Iterable[str]) -> str:
    names = list(known)
    # axes are named like parameters, so `width` would be the width of a block
    if f"bracket_{name}" in names:
        return (
            f"{function}() takes no {name!r}; the width of a bracket is 'bracket_{name}', and "
            "incremental_dynamic_analysis takes axes such as that of a block"
        )
    if name == "axes":
        return (
            f"{function}() takes no 'axes': it is about one system; incremental_dynamic_analysis "
            "takes them, and finds the critical scale of each combination as capacity_scale"
        )
    return f"{function}() takes no {name!r}{suggestion(name, names)} It takes {', '.join(names)}"


def suggestion(name: str, known: Iterable[str]) -> str:
    """Ask whether a similar name was meant; a full stop if there is none."""
    return did_you_mean(name, known) or "."


def completed_docstring(text: str, names: Iterable[str], declared: Mapping[str, Argument]) -> str:
    """Insert rows for declared arguments into the section on parameters of a docstring."""
    if not text:  # if Python runs without docstrings
        return text
    clean = with_section(text, "Parameters", "", ("Returns", "Raises", "Notes", "Examples"))
    section = cast("re.Match[str]", _PARAMETERS.search(clean))
    rows = parameter_rows(clean)
    ordered = dict.fromkeys(
        rows[name] if name in rows else _parameter_row(name, declared[name])
        for name in names
        if name in rows or name in declared
    )
    before, after = clean[: section.start()], clean[section.end() :]
    return before + "\n".join(ordered) + f"\n\n{after}".rstrip() + "\n"


def parameter_rows(text: str) -> dict[str, str]:
    """Return the rows on parameters in a docstring without indent, by their names."""
    section = _PARAMETERS.search(text)
    return {
        name.strip().lstrip("*"): row.rstrip()
        for row in _ROW.split(section[0] if section else "")
        if row.strip()
        for name in row.split(" :")[0].split("\n")[0].split(",")
    }


def _parameter_row(name: str, argument: Argument) -> str:
    words = fill(
        argument.description, _WIDTH, initial_indent=_INDENT, subsequent_indent=_INDENT,
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip
    return f"{name} : {argument.kind}\n{words}"


def with_raises_section(text: str, raises: str) -> str:
    """Insert a section Raises before Notes and Examples, unless there is one."""
    return with_section(text, "Raises", raises, ("See Also", "Notes", "Examples"))


def with_section(text: str, title: str, words: str, following: Iterable[str]) -> str:
    """Insert a section before others into a docstring, unless it has one of that title."""
    clean = inspect.cleandoc(text)
    if not clean or f"\n{title}\n---" in clean:
        return clean
    places = (clean.find(f"\n\n{head}\n---") for head in following)
    end = min((place for place in places if place >= 0), default=len(clean))
    return f"{clean[:end]}\n\n{title}\n{'-' * len(title)}\n{words}{clean[end:]}"
