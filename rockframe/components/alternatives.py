"""Alternative parameters, of which one is given."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from rockframe.errors import ComponentError
from rockframe.suggestions import with_hints


@lru_cache
def _displaced(ways: tuple[tuple[str, ...], ...], named: frozenset[str]) -> frozenset[str]:
    left = [way for way in ways if not named.intersection(way)]
    return frozenset(name for way in left for name in way) if len(left) < len(ways) else frozenset()


@dataclass(frozen=True, init=False)
class OneOf:
    """Alternative ways to give the same quantity, of which one is used.

    Parameters
    ----------
    *ways : str or tuple of str
        Names of parameters; those of a tuple are given together.
    required : bool
        Whether one way must be used.
    hint : str
        What a message adds where none is.

    Examples
    --------
    >>> stiffness = OneOf("stiffness", "frequency_ratio")
    >>> stiffness.check({"stiffness": "2 MN/m", "frequency_ratio": None}, owner="Pads")
    >>> stiffness.displaced({"frequency_ratio": 20})
    frozenset({'stiffness'})
    """

    ways: tuple[tuple[str, ...], ...]
    required: bool
    hint: str

    @with_hints()
    def __init__(self, *ways: str | tuple[str, ...], required: bool = True, hint: str = "") -> None:
        split = tuple((way,) if isinstance(way, str) else way for way in ways)
        object.__setattr__(self, "ways", split)
        object.__setattr__(self, "required", required)
        object.__setattr__(self, "hint", hint)

    def check(self, values: Mapping[str, object], owner: str) -> None:
        """Refuse arguments that give the quantity twice, or not at all.

        Parameters
        ----------
        values : mapping
            Arguments by name; None for those not given.
        owner : str
            Class, for the message.

        Raises
        ------
        ComponentError
            More than one way is used; none, although one is required; or one incompletely.
        """
        taken = [way for way in self.ways if values.get(way[0]) is not None]
        heads = " or ".join(way[0] for way in self.ways)
        pair = len(self.ways) == 2
        if len(taken) > 1:
            found = f"; {'both' if pair else 'several'} were given"
            if not self.required:
                found = ", not both; one follows from the other"
            msg = f"{owner}: give {heads}{found}"
            raise ComponentError(msg)
        if self.required and not taken:
            hint = f"; {self.hint}" if self.hint else ""
            msg = f"{owner}: give {heads}; {'neither' if pair else 'none'} was given{hint}"
            raise ComponentError(msg)
        for way in self.ways:
            present = [name for name in way if values.get(name) is not None]
            if 0 < len(present) < len(way):
                given = f"{' and '.join(present)} {'was' if len(present) == 1 else 'were'}"
                msg = f"{owner}: {' and '.join(way)} go together; only {given} given"
                raise ComponentError(msg)

    def displaced(self, changes: Mapping[str, object]) -> frozenset[str]:
        """Name the parameters that new arguments replace.

        Parameters
        ----------
        changes : mapping
            New arguments by name.

        Returns
        -------
        frozenset of str
        """
        named = frozenset(name for name, value in changes.items() if value is not None)
        return _displaced(self.ways, named)


def changed_arguments(
    arguments: Mapping[str, float | str],
    changes: Mapping[str, Any],
    alternatives: tuple[OneOf, ...],
) -> dict[str, Any]:
    """Return arguments with changes, without those that the changes replace."""
    removed = {name for alternative in alternatives for name in alternative.displaced(changes)}
    return {**{name: value for name, value in arguments.items() if name not in removed}, **changes}
