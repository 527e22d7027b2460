"""Errors and warnings raised by rockframe.

Every error derives from :class:`RockframeError`, so that a script can distinguish an input that
rockframe refused from its own faults.
"""

import sys
import warnings
from collections.abc import Generator, Iterable, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from difflib import get_close_matches
from functools import partial
from inspect import currentframe
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, NoReturn

MAX_SHOWN_LENGTH = 100
"""A message shows a value up to this number of characters."""


class RockframeError(Exception):
    """Base class of every error that rockframe raises on purpose."""

    def _render_traceback_(self) -> list[str]:
        """Return the traceback for IPython and Jupyter, without the frames of rockframe."""
        console: Any = sys.modules["IPython"]
        shown_by = console.get_ipython().InteractiveTB
        before = (self.__cause__, self.__context__)
        self.__cause__ = self.__context__ = None  # their tracebacks would be shown, too, and first
        try:
            return shown_by.structured_traceback(
                type(self), self, _user_traceback(self.__traceback__)
            )
        finally:
            self.__context__, self.__cause__ = before[1], before[0]


def _user_traceback(trace: TracebackType | None) -> TracebackType | None:
    """Return a traceback without the frames of rockframe and of its context managers."""
    if trace is None:
        return None
    below = _user_traceback(trace.tb_next)
    if str(trace.tb_frame.f_globals.get("__name__", "")).partition(".")[0] in _HIDDEN:
        return below
    return TracebackType(below, trace.tb_frame, trace.tb_lasti, trace.tb_lineno)


_PACKAGE: Final = __name__.partition(".")[0]
_HIDDEN: Final = {_PACKAGE, "contextlib"}


class UnitsError(RockframeError, ValueError):
    """A value has no unit, an unknown unit, or a unit of the wrong kind."""


class ComponentError(RockframeError, ValueError):
    """The values of one component or argument are not valid (negative size, NaN, ...)."""


class AssemblyError(RockframeError, ValueError):
    """The parts do not form a supported scene, or do not fit one another.

    Parameters
    ----------
    faults : sequence of str
        Every fault found; all of them are listed in the message.
    supported : sequence of str, optional
        One line per scene that can be assembled.
    """

    def __init__(self, faults: Sequence[str], supported: Sequence[str] = ()) -> None:
        self.faults = tuple(faults)
        self.supported = tuple(supported)
        lines = ["the parts do not make a system:"] if len(self.faults) > 1 else []
        lines += [f"- {fault}" for fault in faults] if lines else list(faults)
        if supported:
            lines.append("Supported scenes:")
            lines += [f"  {scene}" for scene in supported]
        super().__init__("\n".join(lines))

    def __reduce__(self) -> tuple[object, ...]:
        return (type(self), (self.faults, self.supported))


class RecordError(RockframeError, ValueError):
    """A ground-motion file cannot be read in its format.

    Parameters
    ----------
    path : str
        File that was read.
    found, expected : str
        Contents of the file at the fault, and the contents that were expected.
    line : int, optional
        Line number, counted from 1.
    """

    def __init__(self, path: str, *, found: str, expected: str, line: int | None = None) -> None:
        self.path = path
        self.line = line
        self.found = found
        self.expected = expected
        where = path if line is None else f"{path}, line {line}"
        super().__init__(f"{where}: found {found}; expected {expected}")

    def __reduce__(self) -> tuple[object, ...]:
        rebuild = partial(type(self), found=self.found, expected=self.expected, line=self.line)
        return (rebuild, (self.path,))


class FileError(RockframeError, ValueError):
    """A file of a scene, study or result cannot be read or must not be written.

    Parameters
    ----------
    path : str
        File that was read or to be written.
    faults : str, or sequence of (int or None, str)
        The fault; or every fault found, with its line number, counted from 1, where it has one.
    """

    def __init__(self, path: str, faults: str | Sequence[tuple[int | None, str]]) -> None:
        self.path = path
        self.faults = ((None, faults),) if isinstance(faults, str) else tuple(faults)
        lines = [
            f"{path}: {words}" if line is None else f"{path}, line {line}: {words}"
            for line, words in self.faults
        ]
        super().__init__("\n".join(lines))

    def __reduce__(self) -> tuple[object, ...]:
        return (type(self), (self.path, self.faults))


class SolverError(RockframeError, RuntimeError):
    """The integration cannot start or continue; the message gives the state."""


class StudyError(RockframeError, ValueError):
    """A study cannot be planned, run, stored or read.

    Parameters
    ----------
    *faults : str
        Every fault found; all of them are listed in the message.
    """

    def __init__(self, *faults: str) -> None:
        self.faults = faults
        lines = ["the study cannot be planned:", *(f"- {fault}" for fault in faults)]
        super().__init__("\n".join(lines) if len(faults) > 1 else "".join(faults))

    def __reduce__(self) -> tuple[object, ...]:
        return (type(self), self.faults)


class SchemaError(RockframeError, ValueError):
    """A dataset does not follow the schema of rockframe, or a name is not in it."""


class ArgumentError(RockframeError, TypeError):
    """A function does not accept an argument, or a required argument is missing."""


class AccessError(RockframeError, AttributeError):
    """An attribute does not exist, or cannot be changed."""


class LabelError(RockframeError, KeyError):
    """A mapping has no such label."""

    __str__ = Exception.__str__  # str() of a KeyError gives the repr of the message


class RockframeWarning(UserWarning):
    """Base class of the warnings of rockframe."""


class ModelWarning(RockframeWarning):
    """The run continues, but the model is used near or beyond its limits of validity."""


class SolverWarning(RockframeWarning):
    """A run could not be finished, or its energy balance shows that it is not a solution."""


class RecordWarning(RockframeWarning):
    """A ground-motion file contradicts itself, or a motion is sampled too coarsely."""


def short_repr(value: object) -> str:
    """Return a value for a message: its repr if that is short, else a shorter text."""
    text = repr(value)
    if len(text) <= MAX_SHOWN_LENGTH and "\n" not in text:
        return text
    kind = f"a {type(value).__name__}"
    if hasattr(value, "shape"):
        return f"{kind} of shape {value.shape}"  # type: ignore[attr-defined]
    if hasattr(value, "data_vars"):
        return kind
    line = " ".join(text.split())
    return line if len(line) <= MAX_SHOWN_LENGTH else f"{line[: MAX_SHOWN_LENGTH - 3]}..."


_SYMBOLS: Final = {
    "m": ("mass",),
    "e": ("restitution",),
    "epsilon": ("restitution",),
    "mu": ("friction",),
    "mu_s": ("friction",),
    "mu_k": ("kinetic_friction",),
    "beta": ("frequency_ratio",),
    "xi": ("damping_ratio",),
    "zeta": ("damping_ratio",),
    "dt": ("time_step",),
    "pga": ("peak_ground_acceleration", "peak_acceleration", "peak"),
    "pgv": ("peak_ground_velocity", "peak_velocity"),
    "im": ("intensity",),
    "ida": ("incremental_dynamic_analysis",),
    "prestress": ("preload",),
    "pretension": ("preload",),
    "friction_coefficient": ("friction",),
    "run": ("simulate",),
    "solve": ("simulate", "run"),
    "simulate": ("run",),
    "sweep": ("study",),
}
"""Symbols and words of the literature for arguments, parameters and functions. The symbols b and h
are left out: in papers they are half the width and half the height."""
_ELSEWHERE: Final = {
    "simulate": "; write rf.System(block, ...).simulate(motion)",
    "plot": "; the functions of rf.plot draw",
}
"""Where functions are that are looked for as attributes of other objects."""


def did_you_mean(value: object, known: Iterable[str]) -> str:
    """Ask whether a similar word was meant, at the end of a message; empty if none is similar."""
    words = {name.casefold(): name for name in known}
    key = "" if value is None else str(value).casefold()
    near = [symbol for symbol in _SYMBOLS.get(key, ()) if symbol in words]
    near = near or get_close_matches(key, words, n=3)
    return f"; was {' or '.join(repr(words[match]) for match in near)} meant?" if near else ""


def first_along(dataset: str, dim: str) -> str:
    """Write how the first of the values along a dimension is picked, whatever its name is."""
    return f"{dataset}.isel({dim}=0)" if dim.isidentifier() else f"{dataset}.isel({{{dim!r}: 0}})"


OWNERS_BY_ARGUMENT: Final = {
    option: {"System": None}
    for option in ("restraint", "rotation", "coupling", "gravity", "inclination", "sliding")
}
"""Names of classes and of methods by each argument that they take. Classes add theirs; a system's
options stand here, as its class may not be loaded yet."""


def unexpected_argument(call: str, name: str, known: Iterable[str]) -> ArgumentError:
    """Return Python's error of an unexpected argument, with who takes it, or a similar one."""
    names, owners = list(known), OWNERS_BY_ARGUMENT.get(name, {})
    kind, is_of_class, _ = call.partition(".")
    siblings = [owner for owner in owners if is_of_class and owner.startswith(f"{kind}.")]
    classes = [owner for owner in owners if is_of_class and "." not in owner]
    others = ", ".join(siblings or classes)
    hint = f", which {others} can take." if others else did_you_mean(name, names) or "."
    words = f"{call} got an unexpected keyword argument {name!r}{hint}"
    return ArgumentError(f"{words} It takes {', '.join(names) or 'none'}")


def unknown_attribute(owner: str, name: str, known: Iterable[str]) -> AccessError:
    """Return Python's error of a missing attribute, and propose a similar one."""
    words = f"{owner} has no attribute {name!r}"
    if not name.startswith("_"):  # programs look up those with an underscore
        near = did_you_mean(name, (public for public in known if not public.startswith("_")))
        words += near or _ELSEWHERE.get(name, "")
    return AccessError(words, name=name)


def raise_faults(owner: str, faults: Sequence[str]) -> None:
    """Raise an error with all faults of the arguments of a class or function, if there are any."""
    if faults:
        msg = f"{owner}: {'; '.join(faults)}"
        raise ComponentError(msg)


PLEASE_REPORT: Final = "this is an error in rockframe; please report it"
"""Text of errors that no argument can cause."""

_collected: Final[ContextVar[list[str] | None]] = ContextVar("collected_warnings", default=None)


@contextmanager
def collected_warnings() -> Generator[list[str]]:
    """Collect the texts of warnings in this thread, instead of issuing the warnings."""
    texts: list[str] = []
    before = _collected.set(texts)
    try:
        yield texts
    finally:
        _collected.reset(before)


def warn(message: str, category: type[RockframeWarning]) -> None:
    """Issue a warning at the line that called rockframe, from any depth of calls."""
    texts = _collected.get()
    if texts is not None:
        texts.append(message)
        return
    level, frame = 1, currentframe()
    while frame and str(frame.f_globals.get("__name__")).partition(".")[0] == _PACKAGE:
        level, frame = level + 1, frame.f_back
    warnings.warn(message, category, stacklevel=level)


if not TYPE_CHECKING:  # or no name would be unknown to type checkers

    def __getattr__(name: str) -> NoReturn:
        owner = "module 'rockframe.errors'"
        raise unknown_attribute(owner, name, __dir__())


def named_by_own_part(problem: Exception) -> Exception:
    """Return an error that names the method of a user's own part, or law, in which it arose.

    The same error if it arose elsewhere, or is one of rockframe.
    """
    method, trace = None, problem.__traceback__
    while trace is not None:
        frame, trace = trace.tb_frame, trace.tb_next
        kind, module = type(frame.f_locals.get("self")), str(frame.f_globals.get("__name__"))
        modules = {str(base.__module__).partition(".")[0] for base in kind.__mro__}
        # a component or a support derives from one of rockframe, laws and equations from a tuple
        is_own = _PACKAGE in modules or issubclass(kind, tuple)
        if is_own and module.partition(".")[0] != _PACKAGE:
            method = f"{kind.__name__}.{frame.f_code.co_name}"
    if method is None or isinstance(problem, RockframeError | Warning):
        return problem
    return ComponentError(f"{method} raised {type(problem).__name__}: {problem}")


def words_of(problem: Exception) -> str:
    """Return the text of an error, with its kind if it is none of rockframe."""
    named = named_by_own_part(problem)
    words = str(named) if isinstance(named, RockframeError) else ""
    return words or f"{type(named).__name__}: {named}"


def __dir__() -> list[str]:
    kinds = RockframeError | RockframeWarning
    known = globals().items()
    return [name for name, value in known if isinstance(value, type) and issubclass(value, kinds)]
