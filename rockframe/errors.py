"""Errors and warnings raised by rockframe.

Every error derives from :class:`RockframeError`, so that a script can tell
"rockframe refused this" from a fault of its own.
"""

from collections.abc import Sequence


class RockframeError(Exception):
    """Base class of every error that rockframe raises on purpose."""


class UnitsError(RockframeError, ValueError):
    """A value has no unit, an unknown unit, or a unit of the wrong kind."""


class ComponentError(RockframeError, ValueError):
    """A component's own values do not make sense (negative size, NaN, ...)."""


class AssemblyError(RockframeError, ValueError):
    """Parts do not assemble into a supported scene, or do not fit one another.

    Parameters
    ----------
    faults : sequence of str
        Every fault found; all of them are listed in the message.
    supported : sequence of str, optional
        One line per scene that can be assembled.
    """

    def __init__(self, faults: Sequence[str], supported: Sequence[str] = ()) -> None:
        self.faults = tuple(faults)
        lines = ["the parts do not make a system:"] if len(self.faults) > 1 else []
        lines += [f"- {fault}" for fault in faults] if lines else list(faults)
        if supported:
            lines.append("Supported scenes:")
            lines += [f"  {scene}" for scene in supported]
        super().__init__("\n".join(lines))


class RecordError(RockframeError, ValueError):
    """A ground-motion file cannot be read as what it claims to be.

    Parameters
    ----------
    path : str
        File that was read.
    found, expected : str
        What stands in the file, and what should have stood there.
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
        return (_rebuild_record_error, (self.path, self.found, self.expected, self.line))


def _rebuild_record_error(path: str, found: str, expected: str, line: int | None) -> RecordError:
    return RecordError(path, found=found, expected=expected, line=line)


class SolverError(RockframeError, RuntimeError):
    """The integration cannot start or go on; the message gives the state."""


class SchemaError(RockframeError, ValueError):
    """A dataset does not follow rockframe's schema, or a name is not in it."""


class RockframeWarning(UserWarning):
    """Base class of rockframe's warnings."""


class ModelWarning(RockframeWarning):
    """The run goes on, but the model is used near or beyond its validity."""


class SolverWarning(RockframeWarning):
    """A run could not be finished; what was computed until then is in the result."""


class RecordWarning(RockframeWarning):
    """A ground-motion file was read, but something in it disagrees."""
