"""Numbers of many cases at once, which go through the code of one.

What makes the numbers of a scene is written for one scene. Given :class:`Many` in the place of a
number, the same lines work out all cases: each sum, product and elementary function for all of
them, to the same bits as for each alone. Where the cases would go different ways, a comparison
raises :class:`Differ`, and :func:`each_way` divides them; what can be done for one case only, such
as writing a number into a message, raises :class:`OnlyAlone`. Then the cases are seen to one by
one, by whoever asked.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, Final, Never, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Places = NDArray[np.intp]
Found = TypeVar("Found")

FEWEST: Final = 16
"""Cases below which each alone takes no longer."""


class Differ(BaseException):
    """Cases go different ways.

    Parameters
    ----------
    some : ndarray of bool, shape (cases,)
        Those that go one of them.
    """

    def __init__(self, some: NDArray[np.bool_]) -> None:
        super().__init__()
        self.some = some


class OnlyAlone(BaseException):
    """What is asked for can be done for one case only."""


def _value(other: Any) -> Any:
    """Give what stands on the other side of an operation; None of what it is not made for."""
    if isinstance(other, Many):
        return other.values
    return other if isinstance(other, float | int) else None


def _agreed(some: NDArray[np.bool_]) -> bool:
    """Give what a comparison shows in all cases."""
    count = np.count_nonzero(some)
    if 0 < count < len(some):
        raise Differ(some)
    return bool(count > 0)


def _operation(work: Callable[[Any, Any], Any], *, turned: bool = False) -> Any:
    def operate(self: "Many", other: Any) -> Any:
        value = _value(other)
        if value is None:  # arrays of numbers see to each of theirs
            return NotImplemented
        return Many(work(value, self.values) if turned else work(self.values, value))

    return operate


def _comparison(work: Callable[[Any, Any], Any]) -> Any:
    def compare(self: "Many", other: Any) -> Any:
        value = _value(other)
        return NotImplemented if value is None else _agreed(work(self.values, value))

    return compare


class Many:
    """A number of many cases.

    Parameters
    ----------
    values : ndarray, shape (cases,)
        Of each; not to be changed.
    """

    __slots__ = ("values",)

    def __init__(self, values: Floats) -> None:
        self.values = values

    __add__ = _operation(np.add)
    __radd__ = _operation(np.add, turned=True)
    __sub__ = _operation(np.subtract)
    __rsub__ = _operation(np.subtract, turned=True)
    __mul__ = _operation(np.multiply)
    __rmul__ = _operation(np.multiply, turned=True)
    __truediv__ = _operation(np.divide)
    __rtruediv__ = _operation(np.divide, turned=True)

    __lt__ = _comparison(np.less)
    __le__ = _comparison(np.less_equal)
    __gt__ = _comparison(np.greater)
    __ge__ = _comparison(np.greater_equal)
    __eq__ = _comparison(np.equal)
    __ne__ = _comparison(np.not_equal)

    __hash__ = None  # type: ignore[assignment] # nothing is kept for numbers of many cases

    def __pow__(self, power: float) -> "Many":
        # powers of numpy have other bits than Python's
        return Many(np.array([value**power for value in self.values.tolist()]))

    def __neg__(self) -> "Many":
        return Many(-self.values)

    def __pos__(self) -> "Many":
        return self

    def __abs__(self) -> "Many":
        return Many(np.abs(self.values))

    def __bool__(self) -> bool:
        return _agreed(self.values != 0.0)

    def __int__(self) -> int:
        first = self.values[0]
        _agreed(self.values == first)
        return int(first)

    def _refuse(self, *_: object) -> Never:
        raise OnlyAlone

    __float__ = __str__ = __repr__ = __format__ = __round__ = __index__ = _refuse
    __floordiv__ = __rfloordiv__ = __mod__ = __rmod__ = __rpow__ = __reduce__ = _refuse


def each_way(
    work: Callable[[Places], Found], cases: Places, fewest: int = FEWEST
) -> Iterator[tuple[Places, Found]]:
    """Work out what cases give that go the same way.

    Parameters
    ----------
    work : callable
        ``work(cases)``, with :class:`Many` in the places of numbers.
    cases : ndarray, shape (cases,)
        By their numbers, in ascending order.
    fewest : int
        Cases of one way below which they are left out.

    Yields
    ------
    tuple
        Cases of one way, and what was found. Cases are missing where their way is rare, or cannot
        be gone by several.
    """
    waiting = [cases]
    while waiting:
        some = waiting.pop()
        if len(some) < fewest:
            continue
        try:
            # what is an error of one number, or may be, is seen to alone
            with np.errstate(divide="raise", invalid="raise", over="ignore", under="ignore"):
                found = work(some)
        except Differ as differ:
            waiting += [some[~differ.some], some[differ.some]]
        except OnlyAlone:
            continue
        except Exception:  # noqa: S112 - each case tells of it that has it
            continue
        else:
            yield some, found


def in_each(number: Any, count: int) -> Floats:
    """Give a number in each of some cases; one that is the same in all, too."""
    if isinstance(number, Many):
        return number.values
    return np.full(count, number, dtype=np.float64)


def plain(number: Any) -> Any:
    """Give a number of numpy as one of Python."""
    return number if isinstance(number, Many) else float(number)


def largest(first: Any, second: Any) -> Any:
    """Give the greater of two numbers, as ``max`` does."""
    if isinstance(first, Many) or isinstance(second, Many):
        one, other = _value(first), _value(second)
        return Many(np.where(np.greater(other, one), other, one))
    return max(first, second)


def _of_one(function: Callable[[float], float]) -> Callable[[Any], Any]:
    """Let a function of Python take many numbers."""

    def work(number: Any) -> Any:
        if isinstance(number, Many):
            # those of numpy have other bits
            return Many(np.array(list(map(function, number.values.tolist()))))
        return function(number)

    work.__doc__ = function.__doc__
    return work


def _of_two(function: Callable[[float, float], float]) -> Callable[[Any, Any], Any]:
    def work(first: Any, second: Any) -> Any:
        if isinstance(first, Many) or isinstance(second, Many):
            count = len(first.values if isinstance(first, Many) else second.values)
            both = in_each(first, count).tolist(), in_each(second, count).tolist()
            return Many(np.array(list(map(function, *both))))
        return function(first, second)

    work.__doc__ = function.__doc__
    return work


sin, cos, tan = _of_one(math.sin), _of_one(math.cos), _of_one(math.tan)
asin, atan = _of_one(math.asin), _of_one(math.atan)
atan2, hypot = _of_two(math.atan2), _of_two(math.hypot)


def sqrt(number: Any) -> Any:
    """Give the square root, which is rounded alike everywhere."""
    return Many(np.sqrt(number.values)) if isinstance(number, Many) else math.sqrt(number)


def ceil(number: Any) -> int:
    """Give the least whole number that is no less."""
    return int(Many(np.ceil(number.values))) if isinstance(number, Many) else math.ceil(number)


def isfinite(number: Any) -> bool:
    """Tell whether it is a number, and not infinite."""
    if isinstance(number, Many):
        return _agreed(np.isfinite(number.values))
    return math.isfinite(number)


def isnan(number: Any) -> bool:
    """Tell whether it is no number."""
    return _agreed(np.isnan(number.values)) if isinstance(number, Many) else math.isnan(number)
