"""Arguments that are one of a few words."""

from enum import StrEnum
from typing import TypeVar

from rockframe.errors import ComponentError

Choice = TypeVar("Choice", bound=StrEnum)


def choice(kind: type[Choice], given: object, *, owner: str, name: str) -> Choice:
    """Read an argument that is one of a few words.

    Parameters
    ----------
    kind : type of StrEnum
        The words.
    given : object
        What the user gave.
    owner, name : str
        Class or function, and argument, for the message.

    Returns
    -------
    StrEnum

    Raises
    ------
    ComponentError
        None of them.
    """
    try:
        return kind(str(given))
    except ValueError:
        known = " or ".join(repr(str(one)) for one in kind)
        msg = f"{owner}: {name} must be {known}, got {given!r}"
        raise ComponentError(msg) from None
