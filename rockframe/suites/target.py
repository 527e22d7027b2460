"""Target spectra: from tables, from spectra of motions, and of codes."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from numbers import Real
from typing import Any, Final, Self

import numpy as np
import xarray as xr

from rockframe.arguments import checked_dataset, checked_function, checked_list, checked_text
from rockframe.errors import ComponentError, SchemaError, short_repr
from rockframe.motion.quantities import ArrayLike
from rockframe.results.schema import labels_in_unit
from rockframe.signals.arrays import Array
from rockframe.signals.spectra import DAMPING_RATIO
from rockframe.suggestions import SuggestingMeta, suggests_names
from rockframe.suites.codes import GroundType, Shape, asce_7, eurocode_8
from rockframe.units import (
    ACCELERATION,
    NOT_NEGATIVE,
    PERIOD,
    POSITIVE,
    Condition,
    QuantityLike,
    RatioLike,
    to_ratio,
    to_si_values,
)

_DEVIATION: Final = Condition("from 0 to 3", lambda value: 0.0 <= value <= 3.0)
_DEFAULT_DAMPING: Final = 0.05
_ROUNDING: Final = 1e-9


@suggests_names
@dataclass(frozen=True)
class TargetSpectrum(metaclass=SuggestingMeta):
    """A target pseudo-spectral acceleration for motions, optionally with its spread.

    Created by :meth:`from_table`, :meth:`from_spectrum`, :meth:`eurocode_8` or :meth:`asce_7`.

    Parameters
    ----------
    name : str
        For titles and messages.
    shape : callable
        Accelerations [m s^-2] at periods [s].
    deviation : callable, optional
        Standard deviations of the logarithm at periods [1].
    damping_ratio : float
        Of the oscillators [1].
    limits : tuple of float
        Periods between which the target is defined [s].

    Examples
    --------
    >>> target = TargetSpectrum("flat", lambda periods: 0.0 * periods + 2.0, limits=(0.1, 4.0))
    >>> target.at(["0.1 s", "1 s"]).tolist()
    [2.0, 2.0]
    >>> periods = np.array([0.2, 1.0])
    >>> target.at_seconds(periods, owner="mine").tolist(), target.deviations_at(periods).tolist()
    ([2.0, 2.0], [0.0, 0.0])
    """

    name: str
    shape: Shape = field(repr=False)
    deviation: Shape | None = field(default=None, repr=False)
    damping_ratio: float = _DEFAULT_DAMPING
    limits: tuple[float, float] = (0.0, math.inf)

    def __post_init__(self) -> None:
        owner = type(self).__name__
        checked_text(self.name, owner=owner, name="name")
        checked_function(self.shape, "periods", owner=owner, name="shape")
        if self.deviation is not None:
            checked_function(self.deviation, "periods", owner=owner, name="deviation")
        to_ratio(self.damping_ratio, owner=owner, name="damping_ratio", condition=NOT_NEGATIVE)
        limits = checked_list(self.limits, owner=owner, name="limits", of="periods")
        rising = len(limits) == 2 and all(isinstance(limit, Real) for limit in limits)
        if not rising or not 0.0 <= limits[0] <= limits[1]:
            msg = (
                f"{owner}: limits must be two periods in seconds that rise, got "
                f"{short_repr(limits)}"
            )
            raise ComponentError(msg)

    @classmethod
    def from_table(
        cls,
        periods: ArrayLike | Iterable[QuantityLike],
        accelerations: ArrayLike | Iterable[QuantityLike],
        *,
        standard_deviations: Sequence[float] | None = None,
        damping_ratio: RatioLike = _DEFAULT_DAMPING,
        name: str = "table",
    ) -> Self:
        """Take a target from a table.

        Parameters
        ----------
        periods : (sequence, unit), Quantity or sequence of str, k values
            Increasing positive periods [s].
        accelerations : (sequence, unit), Quantity or sequence of str, k values
            Pseudo-spectral accelerations; for a set of motions, their median [m s^-2].
        standard_deviations : sequence of float, k values, optional
            Standard deviations of the natural logarithm: the target spread of a set [1].
        damping_ratio : float, optional
            Of the oscillators [1].
        name : str, optional
            For titles and messages.

        Returns
        -------
        TargetSpectrum
            Interpolated linearly on logarithmic axes between the periods of the table; undefined
            outside.

        Raises
        ------
        UnitsError
            Values without a unit, or with one of another kind.
        ComponentError
            Fewer than two periods, columns of different lengths, or values out of range.

        Examples
        --------
        >>> target = TargetSpectrum.from_table(["0.1 s", "1 s"], ([2.0, 0.2], "m/s^2"))
        >>> target.at(["0.2 s"]).round(3).tolist()
        [1.0]
        """
        owner = f"{cls.__name__}.from_table"
        seconds = np.array(to_si_values(periods, PERIOD, owner=owner, name="periods"))
        values = np.array(
            to_si_values(accelerations, ACCELERATION, owner=owner, name="accelerations")
        )
        if seconds.size < 2 or seconds[0] <= 0.0 or not (np.diff(seconds) > 0.0).all():
            msg = f"{owner}: periods must be two or more, above zero and increasing"
            raise ComponentError(msg)
        if values.shape != seconds.shape or not (values > 0.0).all():
            msg = f"{owner}: accelerations must be {seconds.size}, as the periods, and above zero"
            raise ComponentError(msg)
        logarithms, spread = tuple(np.log(seconds).tolist()), None
        if standard_deviations is not None:
            named = {"owner": owner, "name": "standard_deviations"}
            listed = checked_list(standard_deviations, **named, of="numbers")
            deviations = [to_ratio(each, **named, condition=_DEVIATION) for each in listed]
            if len(deviations) != seconds.size:
                msg = f"{owner}: standard_deviations must be {seconds.size}, as the periods"
                raise ComponentError(msg)
            spread = _Interpolated(logarithms, tuple(deviations))
        return cls(
            name,
            _Exponential(logarithms, tuple(np.log(values).tolist())),
            spread,
            to_ratio(damping_ratio, owner=owner, name="damping_ratio", condition=DAMPING_RATIO),
            (float(seconds[0]), float(seconds[-1])),
        )

    @classmethod
    def from_spectrum(cls, dataset: xr.Dataset, *, name: str = "spectrum") -> Self:
        """Create a target from the response spectrum of one motion, or the median of several.

        Parameters
        ----------
        dataset : xarray.Dataset
            Result of :func:`rockframe.response_spectrum` for one damping ratio; for several motions
            the standard deviation of the logarithm becomes the spread.
        name : str, optional
            For titles and messages.

        Returns
        -------
        TargetSpectrum

        Raises
        ------
        SchemaError
            The dataset is not a result of :func:`rockframe.response_spectrum`.

        Examples
        --------
        >>> import rockframe as rf
        >>> pulse = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
        >>> spectrum = rf.response_spectrum(pulse, ["0.5 s", "1 s"])
        >>> TargetSpectrum.from_spectrum(spectrum).at(["1 s"]).round(2).tolist()
        [5.4]
        """
        owner = f"{cls.__name__}.from_spectrum"
        data = checked_dataset(dataset, owner=owner)
        spectrum = data.get("pseudo_spectral_acceleration")
        if spectrum is None or spectrum.sizes.get("damping_ratio") != 1:
            msg = f"{owner}: expected a dataset of rf.response_spectrum with one damping ratio"
            raise SchemaError(msg)
        spectrum = labels_in_unit(spectrum, ACCELERATION.unit, owner=owner)
        periods = labels_in_unit(spectrum["period"], PERIOD.unit, owner=owner).to_numpy()
        moving = spectrum.isel(damping_ratio=0, period=periods > 0.0)
        other_dims = [dim for dim in moving.dims if dim != "period"]
        logarithm: Any = np.log(moving)
        spread = None
        if other_dims and math.prod(moving.sizes[dim] for dim in other_dims) > 1:
            spread = logarithm.std(other_dims, ddof=1).to_numpy().tolist()
        return cls.from_table(
            (periods[periods > 0.0], str(PERIOD.unit)),
            (np.exp(logarithm.mean(other_dims)).to_numpy(), str(ACCELERATION.unit)),
            standard_deviations=spread,
            damping_ratio=float(spectrum["damping_ratio"][0]),
            name=name,
        )

    @classmethod
    def eurocode_8(
        cls,
        ground_acceleration: QuantityLike,
        ground_type: str = GroundType.A,
        *,
        spectrum_type: int = 1,
        soil_factor: RatioLike | None = None,
        corner_periods: Sequence[QuantityLike] | None = None,
        damping_ratio: RatioLike = _DEFAULT_DAMPING,
    ) -> Self:
        """Take the horizontal elastic spectrum of Eurocode 8.

        Parameters
        ----------
        ground_acceleration : str or Quantity
            Design ground acceleration on rock, a_g [m s^-2].
        ground_type : {"A", "B", "C", "D", "E"}, optional
            Ground type, which determines the soil factor and corner periods.
        spectrum_type : {1, 2}, optional
            1 for strong and distant earthquakes, 2 if no magnitude above 5.5 contributes.
        soil_factor : float, optional
            Soil factor S, if a national annex specifies another value [1].
        corner_periods : sequence of three str or Quantity, optional
            T_B, T_C and T_D, if a national annex specifies other values [s].
        damping_ratio : float, optional
            Of the oscillators [1].

        Returns
        -------
        TargetSpectrum
            :eq:`eq-eurocode-8`, EN 1998-1:2004, 3.2.2.2.

        Raises
        ------
        UnitsError
            An argument has no unit, or one of another kind.
        ComponentError
            Out of range.

        Examples
        --------
        >>> target = TargetSpectrum.eurocode_8("0.2 g_0", "B")
        >>> (target.at(["0 s", "0.3 s", "1 s"]) / 9.80665).round(3).tolist()
        [0.24, 0.6, 0.3]
        """
        words, shape, damping = eurocode_8(
            ground_acceleration, ground_type, spectrum_type, soil_factor, corner_periods,
            damping_ratio, owner=f"{cls.__name__}.eurocode_8",
        )  # fmt: skip
        return cls(words, shape, None, damping)

    @classmethod
    def asce_7(
        cls,
        short_period_acceleration: QuantityLike,
        one_second_acceleration: QuantityLike,
        *,
        long_period: QuantityLike = "8 s",
    ) -> Self:
        """Take the design response spectrum of ASCE 7.

        Parameters
        ----------
        short_period_acceleration : str or Quantity
            S_DS [m s^-2].
        one_second_acceleration : str or Quantity
            S_D1 [m s^-2].
        long_period : str or Quantity, optional
            T_L [s].

        Returns
        -------
        TargetSpectrum
            :eq:`eq-asce-7`, ASCE/SEI 7-16, 11.4.6; of 5 % of critical damping.

        Raises
        ------
        UnitsError
            An argument has no unit, or one of another kind.
        ComponentError
            Out of range.

        Examples
        --------
        >>> target = TargetSpectrum.asce_7("1 g_0", "0.6 g_0")
        >>> (target.at(["0 s", "0.5 s", "2 s", "10 s"]) / 9.80665).round(3).tolist()
        [0.4, 1.0, 0.3, 0.048]
        """
        return cls(
            *asce_7(
                short_period_acceleration, one_second_acceleration, long_period,
                owner=f"{cls.__name__}.asce_7",
            )
        )  # fmt: skip

    def at(self, periods: ArrayLike | Iterable[QuantityLike]) -> Array:
        """Return the accelerations at periods.

        Parameters
        ----------
        periods : (sequence, unit), Quantity or sequence of str
            Zero or more [s].

        Returns
        -------
        ndarray, shape (n,)
            [m s^-2]

        Raises
        ------
        UnitsError
            Periods without a unit, or with one of another kind.
        ComponentError
            Periods at which it is not known.

        Examples
        --------
        >>> TargetSpectrum.eurocode_8("0.2 g_0").at(["0 s", "0.2 s"]).round(3).tolist()
        [1.961, 4.903]
        """
        owner = f"{type(self).__name__}.at"
        return self.at_seconds(
            np.array(to_si_values(periods, PERIOD, owner=owner, name="periods")), owner=owner
        )

    def at_seconds(self, seconds: Array, *, owner: str) -> Array:
        """Return the accelerations at periods.

        Parameters
        ----------
        seconds : ndarray, shape (n,)
            Periods [s].
        owner : str
            Name of the caller, for messages.

        Returns
        -------
        ndarray, shape (n,)
            [m s^-2]

        Raises
        ------
        ComponentError
            Periods at which it is not known.
        """
        low, high = self.limits
        _check_array(seconds, owner)
        if seconds.min() < low * (1.0 - _ROUNDING) or seconds.max() > high * (1.0 + _ROUNDING):
            msg = (
                f"{owner}: periods from {seconds.min():.4g} s to {seconds.max():.4g} s, but the "
                f"target {self.name!r} is known from {low:.4g} s to {high:.4g} s"
            )
            raise ComponentError(msg)
        return self.shape(seconds)

    def deviations_at(self, seconds: Array) -> Array:
        """Return the standard deviations of the logarithm at periods.

        Parameters
        ----------
        seconds : ndarray, shape (n,)
            Periods [s].

        Returns
        -------
        ndarray, shape (n,)
            Zero where the target has no spread [1].
        """
        _check_array(seconds, f"{type(self).__name__}.deviations_at")
        return np.zeros(seconds.size) if self.deviation is None else self.deviation(seconds)

    def scaled(self, factor: RatioLike) -> Self:
        """Multiply the accelerations, as by an importance factor.

        Parameters
        ----------
        factor : float
            [1]

        Returns
        -------
        TargetSpectrum

        Raises
        ------
        UnitsError, ComponentError
            Not a ratio above zero.

        Examples
        --------
        >>> TargetSpectrum.eurocode_8("0.2 g_0").scaled(1.5).at(["0 s"]).round(3).tolist()
        [2.942]
        """
        owner = f"{type(self).__name__}.scaled"
        ratio = to_ratio(factor, owner=owner, name="factor", condition=POSITIVE)
        return replace(
            self, name=f"{self.name}, times {ratio:g}", shape=_Multiple(ratio, self.shape)
        )

    def with_deviation(self, standard_deviation: RatioLike) -> Self:
        """Set the same target of the spread at all periods.

        Parameters
        ----------
        standard_deviation : float
            Of the natural logarithm [1].

        Returns
        -------
        TargetSpectrum

        Raises
        ------
        UnitsError, ComponentError
            Not a ratio from 0 to 3.

        Examples
        --------
        >>> import numpy as np
        >>> TargetSpectrum.eurocode_8("0.2 g_0").with_deviation(0.4).deviations_at(np.array([1.0]))
        array([0.4])
        """
        owner = f"{type(self).__name__}.with_deviation"
        value = to_ratio(
            standard_deviation, owner=owner, name="standard_deviation", condition=_DEVIATION
        )
        return replace(self, deviation=_Constant(value))


# Functions as classes with values, so that targets can be compared and pickled.


@dataclass(frozen=True)
class _Interpolated:
    """Linear interpolation between values at logarithms of periods."""

    logarithms: tuple[float, ...]
    values: tuple[float, ...]

    def __call__(self, at: Array) -> Any:
        return np.interp(np.log(at), self.logarithms, self.values)


class _Exponential(_Interpolated):
    """Exponential function of values that are interpolated."""

    def __call__(self, at: Array) -> Any:
        return np.exp(super().__call__(at))


@dataclass(frozen=True)
class _Multiple:
    factor: float
    shape: Shape

    def __call__(self, at: Array) -> Array:
        return self.factor * self.shape(at)


@dataclass(frozen=True)
class _Constant:
    value: float

    def __call__(self, at: Array) -> Array:
        return np.full(at.size, self.value)


def _check_array(seconds: object, owner: str) -> None:
    if not isinstance(seconds, np.ndarray) or seconds.size == 0 or seconds.dtype.kind not in "fiu":
        msg = (
            f"{owner}: seconds must be an array of periods, one or more, got {short_repr(seconds)}"
        )
        raise ComponentError(msg)


def check_target(value: object, *, owner: str) -> TargetSpectrum:
    """Refuse anything but a target."""
    if isinstance(value, TargetSpectrum):
        return value
    msg = (
        f"{owner}: target needs a TargetSpectrum, got {short_repr(value)}; write for example "
        "rf.TargetSpectrum.eurocode_8('0.2 g_0', 'B')"
    )
    raise ComponentError(msg)
