"""Vectors of numbers, one for each case, that pass through code written for a single case.

The parameters of a scene are computed by code for one scene. With :class:`Many` in place of a
number the same code computes all cases at once: each sum, product and elementary function is
identical bit for bit to that of the case alone. Where a comparison differs between the cases it
raises :class:`Differ`, and :func:`each_way` splits them into groups. What can be done for one case
only, such as writing a number into a message, raises :class:`OnlyAlone`; the caller then computes
these cases one by one.
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
"""Below this number of cases it takes no longer to compute them one by one."""


class Differ(BaseException):
    """A comparison has different results in the cases.

    Parameters
    ----------
    some : ndarray of bool, shape (cases,)
        The result in each case.
    """

    def __init__(self, some: NDArray[np.bool_]) -> None:
        super().__init__()
        self.some = some


class OnlyAlone(BaseException):
    """An operation is possible only for a single case."""


def _value(other: Any) -> Any:
    """Return the other operand as numbers; None if it is of another type."""
    if isinstance(other, Many):
        return other.values
    return other if isinstance(other, float | int) else None


def _agreed(some: NDArray[np.bool_]) -> bool:
    """Return the result of a comparison if it is the same in all cases."""
    count = np.count_nonzero(some)
    if 0 < count < len(some):
        raise Differ(some)
    return bool(count > 0)


def _operation(work: Callable[[Any, Any], Any], *, turned: bool = False) -> Any:
    def operate(self: "Many", other: Any) -> Any:
        value = _value(other)
        if value is None:  # arrays carry out the operation for each of their elements
            return NotImplemented
        return Many(work(value, self.values) if turned else work(self.values, value))

    return operate


def _comparison(work: Callable[[Any, Any], Any]) -> Any:
    def compare(self: "Many", other: Any) -> Any:
        value = _value(other)
        return NotImplemented if value is None else _agreed(work(self.values, value))

    return compare


class Many:
    """A number that has a value in each of many cases.

    Parameters
    ----------
    values : ndarray, shape (cases,)
        The values; they must not be changed.
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

    __hash__ = None  # type: ignore[assignment] # caches hold numbers of one case only

    def __pow__(self, power: float) -> "Many":
        # powers of NumPy differ in the last bits from those of Python
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
    """Split cases into groups with the same branches of the code, and compute each group.

    Parameters
    ----------
    work : callable
        ``work(cases)``, which computes with :class:`Many` in place of numbers.
    cases : ndarray, shape (cases,)
        Numbers of the cases, in ascending order.
    fewest : int
        Smallest group that is computed.

    Yields
    ------
    tuple
        Cases of one group, and the result of `work`. Cases of smaller groups are left out, and
        those that can only be computed one by one.
    """
    waiting = [cases]
    while waiting:
        some = waiting.pop()
        if len(some) < fewest:
            continue
        try:
            # cases with an error, or a possible one, are computed one by one
            with np.errstate(divide="raise", invalid="raise", over="ignore", under="ignore"):
                found = work(some)
        except Differ as differ:
            waiting += [some[~differ.some], some[differ.some]]
        except OnlyAlone:
            continue
        except Exception:  # noqa: S112 - computed alone, each such case raises it again
            continue
        else:
            yield some, found


def in_each(number: Any, count: int) -> Floats:
    """Return the values of a number in each case; a single number is repeated."""
    if isinstance(number, Many):
        return number.values
    return np.full(count, number, dtype=np.float64)


def python_number(number: Any) -> Any:
    """Convert a number of NumPy to one of Python."""
    return number if isinstance(number, Many) else float(number)


def largest(first: Any, second: Any) -> Any:
    """Return the greater of two numbers, as ``max`` does."""
    if isinstance(first, Many) or isinstance(second, Many):
        one, other = _value(first), _value(second)
        return Many(np.where(np.greater(other, one), other, one))
    return max(first, second)


def _of_one(function: Callable[[float], float]) -> Callable[[Any], Any]:
    """Extend a function of one number to many cases."""

    def work(number: Any) -> Any:
        if isinstance(number, Many):
            # functions of NumPy differ in the last bits
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
    """Return the square root; NumPy and Python round it alike."""
    return Many(np.sqrt(number.values)) if isinstance(number, Many) else math.sqrt(number)


def ceil(number: Any) -> int:
    """Round up to a whole number."""
    return int(Many(np.ceil(number.values))) if isinstance(number, Many) else math.ceil(number)


def isfinite(number: Any) -> bool:
    """Tell whether a number is finite: neither infinite nor NaN."""
    if isinstance(number, Many):
        return _agreed(np.isfinite(number.values))
    return math.isfinite(number)


def isnan(number: Any) -> bool:
    """Tell whether a number is NaN."""
    return _agreed(np.isnan(number.values)) if isinstance(number, Many) else math.isnan(number)
