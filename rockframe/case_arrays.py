"""Vectors of numbers, one for each case, that pass through code written for a single case.

The parameters of a scene are computed by code for one scene. With :class:`CaseArray` in place of a
number the same code computes all cases at once: each sum, product and elementary function is
identical bit for bit to that of the case alone. Where a comparison differs between the cases it
raises :class:`BranchesDiffer`, and :func:`run_by_branches` splits them into groups. What can be
done for one case only, such as writing a number into a message, raises :class:`SingleCaseOnly`;
the caller then computes these cases one by one.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, Final, Never, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
CaseIndices = NDArray[np.intp]
Result = TypeVar("Result")

MIN_CASES: Final = 16
"""Below this number of cases it takes no longer to compute them one by one."""


class BranchesDiffer(BaseException):
    """A comparison has different results in the cases."""

    def __init__(self, truths: NDArray[np.bool_]) -> None:
        super().__init__()
        self.truths = truths  # the result in each case


class SingleCaseOnly(BaseException):
    """An operation is possible only for a single case."""


def _operand_values(other: Any) -> Any:
    """Return the other operand as numbers; None if it is of another type."""
    if isinstance(other, CaseArray):
        return other.values
    return other if isinstance(other, float | int) else None


def _common_truth(truths: NDArray[np.bool_]) -> bool:
    """Return the result of a comparison if it is the same in all cases."""
    count = np.count_nonzero(truths)
    if 0 < count < len(truths):
        raise BranchesDiffer(truths)
    return bool(count > 0)


def _operation(function: Callable[[Any, Any], Any], *, reflected: bool = False) -> Any:
    def operate(self: "CaseArray", other: Any) -> Any:
        value = _operand_values(other)
        if value is None:  # arrays carry out the operation for each of their elements
            return NotImplemented
        return CaseArray(
            function(value, self.values) if reflected else function(self.values, value)
        )

    return operate


def _comparison(function: Callable[[Any, Any], Any]) -> Any:
    def compare(self: "CaseArray", other: Any) -> Any:
        value = _operand_values(other)
        return NotImplemented if value is None else _common_truth(function(self.values, value))

    return compare


class CaseArray:
    """A number that has a value in each of many cases; the values must not be changed."""

    __slots__ = ("values",)

    def __init__(self, values: Floats) -> None:
        self.values = values

    __add__ = _operation(np.add)
    __radd__ = _operation(np.add, reflected=True)
    __sub__ = _operation(np.subtract)
    __rsub__ = _operation(np.subtract, reflected=True)
    __mul__ = _operation(np.multiply)
    __rmul__ = _operation(np.multiply, reflected=True)
    __truediv__ = _operation(np.divide)
    __rtruediv__ = _operation(np.divide, reflected=True)

    __lt__ = _comparison(np.less)
    __le__ = _comparison(np.less_equal)
    __gt__ = _comparison(np.greater)
    __ge__ = _comparison(np.greater_equal)
    __eq__ = _comparison(np.equal)
    __ne__ = _comparison(np.not_equal)

    __hash__ = None  # type: ignore[assignment] # caches hold numbers of one case only

    def __pow__(self, power: float) -> "CaseArray":
        # powers of NumPy differ in the last bits from those of Python
        return CaseArray(np.array([value**power for value in self.values.tolist()]))

    def __neg__(self) -> "CaseArray":
        return CaseArray(-self.values)

    def __pos__(self) -> "CaseArray":
        return self

    def __abs__(self) -> "CaseArray":
        return CaseArray(np.abs(self.values))

    def __bool__(self) -> bool:
        return _common_truth(self.values != 0.0)

    def __int__(self) -> int:
        first = self.values[0]
        _common_truth(self.values == first)
        return int(first)

    def _refuse(self, *_: object) -> Never:
        raise SingleCaseOnly

    __float__ = __str__ = __repr__ = __format__ = __round__ = __index__ = _refuse
    __floordiv__ = __rfloordiv__ = __mod__ = __rmod__ = __rpow__ = __reduce__ = _refuse


def run_by_branches(
    function: Callable[[CaseIndices], Result], cases: CaseIndices
) -> Iterator[tuple[CaseIndices, Result]]:
    """Split cases into groups with the same branches of the code, and compute each group.

    Cases of groups that are too small are left out, and those that can only be computed one by one.
    """
    groups = [cases]
    while groups:
        group = groups.pop()
        if len(group) < MIN_CASES:
            continue
        try:
            # cases with an error, or a possible one, are computed one by one
            with np.errstate(divide="raise", invalid="raise", over="ignore", under="ignore"):
                result = function(group)
        except BranchesDiffer as differ:
            groups += [group[~differ.truths], group[differ.truths]]
        except (SingleCaseOnly, Exception):  # noqa: S112 - each such case, alone, raises it again
            continue
        else:
            yield group, result


def values_by_case(number: Any, count: int) -> Floats:
    """Return the values of a number in each case; a single number is repeated."""
    if isinstance(number, CaseArray):
        return number.values
    return np.full(count, number, dtype=np.float64)


def python_number(number: Any) -> Any:
    """Convert a number of NumPy to one of Python."""
    return number if isinstance(number, CaseArray) else float(number)


def maximum(first: Any, second: Any) -> Any:
    """Return the greater of two numbers, as ``max`` does."""
    if isinstance(first, CaseArray) or isinstance(second, CaseArray):
        left, right = _operand_values(first), _operand_values(second)
        return CaseArray(np.where(np.greater(right, left), right, left))
    return max(first, second)


def _elementwise(function: Callable[..., float]) -> Callable[..., Any]:
    """Extend a function of numbers to many cases."""

    def wrapped(*numbers: Any) -> Any:
        for number in numbers:
            if isinstance(number, CaseArray):
                count = len(number.values)
                break
        else:
            return function(*numbers)
        # functions of NumPy differ in the last bits
        operands = (values_by_case(number, count).tolist() for number in numbers)
        return CaseArray(np.array(list(map(function, *operands))))

    wrapped.__doc__ = function.__doc__
    return wrapped


sin, cos, tan = map(_elementwise, (math.sin, math.cos, math.tan))
asin, atan = map(_elementwise, (math.asin, math.atan))
atan2, hypot = map(_elementwise, (math.atan2, math.hypot))


def sqrt(number: Any) -> Any:
    """Return the square root; NumPy and Python round it alike."""
    return CaseArray(np.sqrt(number.values)) if isinstance(number, CaseArray) else math.sqrt(number)


def ceil(number: Any) -> int:
    """Round up to a whole number."""
    if isinstance(number, CaseArray):
        return int(CaseArray(np.ceil(number.values)))
    return math.ceil(number)


def isfinite(number: Any) -> bool:
    """Tell whether a number is finite: neither infinite nor NaN."""
    if isinstance(number, CaseArray):
        return _common_truth(np.isfinite(number.values))
    return math.isfinite(number)


def isnan(number: Any) -> bool:
    """Tell whether a number is NaN."""
    if isinstance(number, CaseArray):
        return _common_truth(np.isnan(number.values))
    return math.isnan(number)
