"""The ground motion with its constructors and operations."""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING

from rockframe.errors import ArgumentError, ComponentError, short_repr
from rockframe.motion import description
from rockframe.motion.constructors import records, synthetic, tables
from rockframe.motion.constructors.analytic import AnalyticMotion
from rockframe.motion.operations import (
    combining,
    correcting,
    matching,
    pulses,
    scaling,
    storeys,
    timing,
    writing,
)
from rockframe.motion.value import MotionValue
from rockframe.signals import Motion
from rockframe.suggestions import Constructor, suggests_names


@suggests_names
class GroundMotion(AnalyticMotion):
    """Acceleration of the ground over time; immutable.

    A record comes from :meth:`read`, :meth:`example`, :meth:`from_arrays`, :meth:`from_times`,
    :meth:`from_frame`, :meth:`from_trace` or :meth:`from_dataset`; an analytic pulse from
    :meth:`sine_pulse`, :meth:`type_a_pulse`, :meth:`ricker_wavelet` and others; a synthetic
    earthquake from :meth:`stochastic`. Every operation returns a new motion and adds a sentence to
    its `history`.

    Parameters
    ----------
    si : Motion
        The motion in SI units.
    name : str, optional
        Name for titles and messages.
    metadata : mapping, optional
        Strings and numbers.
    history : tuple of str, optional
        One sentence per processing step.
    recipe : mapping, optional
        Constructor and arguments of an analytic motion, and the operations on it since.

    Examples
    --------
    >>> pulse = GroundMotion.sine_pulse()
    >>> round(pulse.peak_acceleration.m_as("m/s^2"), 12)
    9.81
    """

    __slots__ = ()

    if not TYPE_CHECKING:  # the arguments that count are those of the constructor

        @wraps(MotionValue.__init__, assigned=())
        def __new__(cls, *values, **named):
            """Refuse arguments other than a motion, and name the constructors."""
            if cls.__init__ is not MotionValue.__init__:
                return super().__new__(cls)
            usage = (
                f"{cls.__name__}.read(path), {cls.__name__}.from_arrays(acceleration, time_step) "
                f"or a pulse such as {cls.__name__}.sine_pulse()"
            )
            if not values and "si" not in named:
                msg = f"{cls.__name__}: it is not built by calling the class; write {usage}"
                raise ArgumentError(msg)
            si = values[0] if values else named["si"]
            if not isinstance(si, Motion):
                msg = f"{cls.__name__}: found {short_repr(si)}; write {usage}"
                raise ComponentError(msg)
            return super().__new__(cls)

    # Other constructors and operations are functions with their own documentation; their first
    # argument is the class, or the motion.

    read = Constructor(records.read)
    example = Constructor(records.example)
    from_arrays = Constructor(records.from_arrays)
    from_times = Constructor(tables.from_times)
    from_frame = Constructor(tables.from_frame)
    from_trace = Constructor(tables.from_trace)
    stochastic = Constructor(synthetic.stochastic)

    to_dataset = description.to_dataset
    from_dataset = Constructor(description.from_dataset)
    to_at2 = writing.to_at2
    to_dict = description.to_dict
    from_dict = Constructor(description.from_dict)

    window = timing.window
    resampled = timing.resampled
    scaled = scaling.scaled
    matched = matching.matched
    filtered = correcting.filtered
    baseline_corrected = correcting.baseline_corrected
    with_vertical = combining.with_vertical
    rotated = combining.rotated
    through_storeys = storeys.through_storeys

    velocity_pulse = pulses.velocity_pulse
