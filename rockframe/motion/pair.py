"""Both horizontal components of a record."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from os import PathLike
from typing import Any, Final

import numpy as np

from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import ComponentError, RecordError, RecordWarning, short_repr, warn
from rockframe.motion.constructors.records import motion_of_reading, warn_of_reading
from rockframe.motion.ground_motion import GroundMotion
from rockframe.motion.operations.derived import SAME_STEP
from rockframe.motion.operations.pulses import (
    LONGEST_PERIOD,
    SHORTEST_PERIOD,
    VelocityPulse,
    ground_velocity,
    search_periods,
)
from rockframe.motion.processing.samples import padded
from rockframe.motion.processing.velocity_pulses import strongest_wavelet
from rockframe.records import Reading, RecordLike, read_components, read_source, same_start
from rockframe.signals import Signal
from rockframe.signals.integrals import arias_path
from rockframe.signals.motion import knots_of
from rockframe.suggestions import SuggestingMeta, suggests_names
from rockframe.units import ANGLE, Quantity, QuantityLike, quantity

_RIGHT_ANGLE: Final = 90.0
_TOLERANCE: Final = 1.0  # degree; agencies round azimuths to whole degrees
_ROUNDING: Final = 1e-14
"""Share of the mean intensity below which a common one is rounding."""
_EXAMPLE: Final = "HorizontalPair(north, east)"


@suggests_names
@dataclass(frozen=True)
class HorizontalPair(metaclass=SuggestingMeta):
    """Two horizontal components at a right angle, and optionally the vertical one.

    Parameters
    ----------
    first, second : GroundMotion
        The horizontal components, of the same time step. Their starts, if both are known, agree
        to a tenth of the time step. The shorter one is padded with zeros, to the first
        of which a straight line leads from the last sample of a record. Vertical components in them
        are kept.
    vertical : GroundMotion, optional
        The vertical component, positive upwards.

    Raises
    ------
    ComponentError
        Not motions, of different time steps or starts, or with azimuths that are not at a right
        angle.

    Warns
    -----
    RecordWarning
        Only one of the two has a vertical component, so that only this one shakes vertically.

    Examples
    --------
    >>> from rockframe import GroundMotion
    >>> north = GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
    >>> east = GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    >>> pair = HorizontalPair(north, east)
    >>> print(pair.rotated("53.1301 deg").peak_acceleration.round(3))
    5.0 meter / second ** 2
    """

    first: GroundMotion
    second: GroundMotion
    vertical: GroundMotion | None = None

    def __post_init__(self) -> None:
        owner = type(self).__name__
        named: dict[str, Any] = {"first": self.first, "second": self.second}
        if self.vertical is not None:
            named["vertical"] = self.vertical
        for name, motion in named.items():
            if not isinstance(motion, GroundMotion):
                msg = (
                    f"{owner}: {name} needs a GroundMotion, got {short_repr(motion)}; write "
                    f"{_EXAMPLE}"
                )
                raise ComponentError(msg)
            _check_same_step_and_start(self.first, motion, name, owner)
        azimuths = [motion.metadata.get("azimuth") for motion in (self.first, self.second)]
        degrees = [float(value) for value in azimuths if isinstance(value, int | float)]
        if len(degrees) == 2:
            angle = abs((degrees[1] - degrees[0] + 180.0) % 360.0 - 180.0)
            if abs(angle - _RIGHT_ANGLE) > _TOLERANCE:
                msg = (
                    f"{owner}: the components point to {degrees[0]:g}° and {degrees[1]:g}°, "
                    "which are not at a right angle"
                )
                raise ComponentError(msg)
        has_vertical = [motion.si.vertical is not None for motion in (self.first, self.second)]
        if self.vertical is None and has_vertical[0] != has_vertical[1]:
            words = (
                f"{owner}: only the {'first' if has_vertical[0] else 'second'} component has a "
                "vertical one; give it as vertical= for both"
            )
            warn(words, RecordWarning)

    @classmethod
    def read(cls, path: RecordLike, format: str | None = None) -> HorizontalPair:  # noqa: A002
        """Read both horizontal components of one file, and the vertical one if the file has it.

        Parameters
        ----------
        path : str, path-like, bytes or file object
            A file with two horizontal components.
        format : str, optional
            As for :meth:`GroundMotion.read`.

        Returns
        -------
        HorizontalPair
            In the order of the file.

        Raises
        ------
        RecordError
            The file cannot be read, or does not contain two horizontal components and at most
            one vertical one.

        Examples
        --------
        >>> import tempfile
        >>> import rockframe as rf
        >>> path = f"{tempfile.mkdtemp()}/record.csv"
        >>> rows = [f"{0.01 * k:.2f}, {0.1 * k:.1f}, {0.2 * k:.1f}" for k in range(5)]
        >>> with open(path, "w") as file:
        ...     print("time [s], N [g], E [g]", *rows, sep=chr(10), file=file)
        >>> print(rf.HorizontalPair.read(path).principal_axis.to("deg").round(1))
        63.4 degree
        """
        source = read_source(path)
        readings: list[Reading] = []
        for component in read_components(source, format):
            if isinstance(component, RecordError):
                raise component
            readings.append(component)
        horizontal = [component for component in readings if not component.vertical]
        vertical = [component for component in readings if component.vertical]
        if len(horizontal) != 2 or len(vertical) > 1:
            found = f"{len(horizontal)} horizontal and {len(vertical)} vertical components"
            expected = "two horizontal ones and at most one vertical; read them one by one"
            raise RecordError(source.path, found=found, expected=expected)
        for reading in readings:
            warn_of_reading(reading)
        motions = [
            motion_of_reading(
                GroundMotion,
                component,
                f"{component.file} {component.metadata.get('component', '')}",
            )
            for component in (*horizontal, *vertical)
        ]
        return cls(*motions)

    @property
    def name(self) -> str:
        """Name for titles and messages."""
        return f"{self.first.name}, {self.second.name}"

    @property
    def components(self) -> tuple[GroundMotion, GroundMotion]:
        """Both horizontal components, each with the vertical one, if the pair has it."""
        if self.vertical is None:
            return self.first, self.second
        return self.first.with_vertical(self.vertical), self.second.with_vertical(self.vertical)

    @property
    def signals(self) -> tuple[Signal, Signal]:
        """Both components in SI units, of the same length."""
        count = max(len(self.first), len(self.second))
        first, second = (
            padded(motion.si.horizontal, count) for motion in (self.first, self.second)
        )
        return first, second

    @property
    def principal_axis(self) -> Quantity:
        """Direction of the major principal axis, from the first component to the second [rad]."""
        return quantity(principal_axis_and_intensities(self)[0], ANGLE)

    def rotated(
        self, angle: QuantityLike | None = None, *, azimuth: QuantityLike | None = None
    ) -> GroundMotion:
        """Compute the horizontal component in another direction.

        Parameters
        ----------
        angle : str or Quantity, optional
            Angle from the first component towards the second one [rad].
        azimuth : str or Quantity, optional
            Azimuth instead of `angle`, clockwise from north [rad].

        Returns
        -------
        GroundMotion
            With the vertical component, if the pair has one.

        Raises
        ------
        UnitsError, ComponentError
            As for :meth:`GroundMotion.rotated`.

        Examples
        --------
        >>> import rockframe as rf
        >>> north, east = (rf.GroundMotion.sine_pulse(f"{a} m/s^2", "1 Hz") for a in (3, 4))
        >>> print(rf.HorizontalPair(north, east).rotated("90 deg").peak_acceleration.round(3))
        4.0 meter / second ** 2
        """
        component = self.first.rotated(self.second, angle, azimuth=azimuth)
        return component if self.vertical is None else component.with_vertical(self.vertical)

    def velocity_pulse(
        self,
        *,
        shortest_period: QuantityLike = SHORTEST_PERIOD,
        longest_period: QuantityLike = LONGEST_PERIOD,
    ) -> VelocityPulse[GroundMotion]:
        """Find the strongest velocity pulse of all directions, extract it, and classify it.

        Parameters
        ----------
        shortest_period, longest_period : str or Quantity, optional
            Range of periods of the search [s].

        Returns
        -------
        VelocityPulse
            Pulse of the component in the direction `angle`, in which the wavelet transform of
            the velocity is greatest, :eq:`eq-pulse-direction` (Shahi and Baker 2014).

        Raises
        ------
        UnitsError, ComponentError
            As for :meth:`GroundMotion.velocity_pulse`.

        Examples
        --------
        >>> import rockframe as rf
        >>> north, east = (rf.GroundMotion.type_a_pulse(f"{v} m/s", "2 s") for v in (0.3, 0.4))
        >>> print(rf.HorizontalPair(north, east).velocity_pulse().angle.to("deg").round())
        53.0 degree
        """
        dt = self.first.si.time_step
        owner = f"{type(self).__name__}.velocity_pulse"
        periods = search_periods(shortest_period, longest_period, dt, owner=owner)
        velocities = np.array([ground_velocity(signal) for signal in self.signals])
        direction = strongest_wavelet(velocities, dt, periods).direction
        pulse = self.rotated(f"{direction!r} rad").velocity_pulse(
            shortest_period=shortest_period, longest_period=longest_period
        )
        return replace(pulse, angle=quantity(direction, ANGLE))

    def in_axes(self, angle: QuantityLike) -> HorizontalPair:
        """Compute the components along rotated axes.

        Parameters
        ----------
        angle : str or Quantity
            Angle of rotation, from the first component towards the second one [rad].

        Returns
        -------
        HorizontalPair

        Raises
        ------
        UnitsError
            Not an angle.

        Examples
        --------
        >>> import rockframe as rf
        >>> north, east = (rf.GroundMotion.sine_pulse(f"{a} m/s^2", "1 Hz") for a in (3, 4))
        >>> along, across = rf.HorizontalPair(north, east).in_axes("53.1301 deg").components
        >>> print(along.peak_acceleration.round(3))
        5.0 meter / second ** 2
        >>> print(across.peak_acceleration.round(3))
        0.0 meter / second ** 2
        """
        along = self.first.rotated(self.second, angle)
        # the second rotated axis lies between the second component and the reversed first one
        mirrored = self.first.scaled(-1.0)
        across = self.second.rotated(mirrored, angle)
        return HorizontalPair(along, across, self.vertical)


def principal_axis_and_intensities(pair: HorizontalPair) -> tuple[float, float, float]:
    """Compute :eq:`eq-principal-axes`: angle [rad], principal Arias intensities [m s^-1]."""
    # a record with a pulse at a right angle is a polynomial in every direction, also in its own
    first, both, second = (
        float(knots_of(arias_path(pair.rotated(angle).si.horizontal, STANDARD_GRAVITY))[-1])
        for angle in ("0 deg", "45 deg", "90 deg")
    )
    middle = 0.5 * (first + second)
    common = both - middle
    if abs(common) <= _ROUNDING * middle:
        common = 0.0  # a negative one would make 90 degrees -90 degrees
    angle = 0.5 * math.atan2(2.0 * common, first - second)
    spread = math.hypot(common, 0.5 * (first - second))
    return angle, middle + spread, max(middle - spread, 0.0)


def _check_same_step_and_start(
    first: GroundMotion, other: GroundMotion, name: str, owner: str
) -> None:
    steps = first.si.time_step, other.si.time_step
    if not math.isclose(*steps, rel_tol=SAME_STEP):
        msg = (
            f"{owner}: the time steps of first and {name} differ, {steps[0]!r} s and "
            f"{steps[1]!r} s; resample one"
        )
        raise ComponentError(msg)
    starts = first.metadata.get("record_time"), other.metadata.get("record_time")
    if not same_start(starts[0], starts[1], steps[0]):
        msg = f"{owner}: first starts at {starts[0]}, {name} at {starts[1]}; expected one start"
        raise ComponentError(msg)


def motion_hint(value: object) -> str:
    """Say how to make one motion of what was given in its place, if that is known."""
    if isinstance(value, str | PathLike):
        return f"; read the file first: GroundMotion.read({str(value)!r})"
    if hasattr(value, "shape") or isinstance(value, list):
        return "; build one: GroundMotion.from_arrays((samples, 'm/s^2'), '0.01 s')"
    if isinstance(value, HorizontalPair):
        return "; give its component in one direction: pair.first, or pair.rotated('30 deg')"
    return ""
