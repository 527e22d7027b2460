"""Parameters that stand for one another."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from rockframe.errors import ComponentError
from rockframe.proposals import hinted


@lru_cache
def _displaced(ways: tuple[tuple[str, ...], ...], named: frozenset[str]) -> frozenset[str]:
    left = [way for way in ways if not named.intersection(way)]
    return frozenset(name for way in left for name in way) if len(left) < len(ways) else frozenset()


@dataclass(frozen=True, init=False)
class OneOf:
    """Ways to give the same thing, of which one is taken.

    Parameters
    ----------
    *ways : str or tuple of str
        Names of parameters; those of a tuple go together.
    required : bool
        Whether one must be given.

    Examples
    --------
    >>> stiffness = OneOf("stiffness", "frequency_ratio")
    >>> stiffness.check({"stiffness": "2 MN/m", "frequency_ratio": None}, owner="Pads")
    >>> stiffness.displaced({"frequency_ratio": 20})
    frozenset({'stiffness'})
    """

    ways: tuple[tuple[str, ...], ...]
    required: bool

    @hinted()
    def __init__(self, *ways: str | tuple[str, ...], required: bool = True) -> None:
        split = tuple((way,) if isinstance(way, str) else way for way in ways)
        object.__setattr__(self, "ways", split)
        object.__setattr__(self, "required", required)

    def check(self, given: Mapping[str, object], owner: str) -> None:
        """Refuse arguments that give the thing twice, or not at all.

        Parameters
        ----------
        given : mapping
            Arguments by their names; None for those not given.
        owner : str
            Class, for the message.

        Raises
        ------
        ComponentError
            More than one way was taken; none, although one is required; or half of one.
        """
        taken = [way for way in self.ways if given.get(way[0]) is not None]
        heads = " or ".join(way[0] for way in self.ways)
        pair = len(self.ways) == 2
        if len(taken) > 1 and not self.required:
            msg = f"{owner}: give {heads}, not both; one follows from the other"
            raise ComponentError(msg)
        if len(taken) > 1:
            msg = f"{owner}: give {heads}; {'both were' if pair else 'several were'} given"
            raise ComponentError(msg)
        if self.required and not taken:
            msg = f"{owner}: give {heads}; {'neither' if pair else 'none'} was given"
            raise ComponentError(msg)
        for way in self.ways:
            there = [name for name in way if given.get(name) is not None]
            if 0 < len(there) < len(way):
                found = f"only {' and '.join(there)} {'was' if len(there) == 1 else 'were'} given"
                msg = f"{owner}: {' and '.join(way)} go together; {found}"
                raise ComponentError(msg)

    def displaced(self, changes: Mapping[str, object]) -> frozenset[str]:
        """Name the parameters that are given no longer where others are given instead.

        Parameters
        ----------
        changes : mapping
            New arguments by their names.

        Returns
        -------
        frozenset of str
        """
        named = frozenset(name for name, value in changes.items() if value is not None)
        return _displaced(self.ways, named)
