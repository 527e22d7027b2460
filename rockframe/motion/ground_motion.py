"""The ground motion: where it comes from, and how it is kept."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from rockframe.errors import ComponentError, RecordWarning, SchemaError
from rockframe.motion.formats import read_record
from rockframe.motion.formats.source import Request
from rockframe.motion.operations import MotionOperations
from rockframe.motion.pulses import sine
from rockframe.motion.quantities import accelerations_to_si, argument_unit, declared_step
from rockframe.motion.samples import MotionSI
from rockframe.motion.value import UNNAMED
from rockframe.units import ACCELERATION, ANGLE, FREQUENCY, POSITIVE, TIME, to_ratio, to_si

if TYPE_CHECKING:
    import xarray as xr

    from rockframe.motion.formats.source import PathLike
    from rockframe.motion.quantities import ArrayLike, QuantityLike, RatioLike

_ANALYTIC = ("sine_pulse", "harmonic")
_OPERATIONS = (
    "window",
    "scaled",
    "resampled",
    "filtered",
    "baseline_corrected",
    "with_vertical",
)
_SAME_STEP = 1e-6


class GroundMotion(MotionOperations):
    """Acceleration of the ground over time; immutable.

    Build one with :meth:`read`, :meth:`from_arrays`, :meth:`sine_pulse`,
    :meth:`harmonic` or :meth:`from_dataset`. Every processing step returns a
    new motion and adds a sentence to its `history`.

    Parameters
    ----------
    si : MotionSI
        Samples in SI units, for those who have them.
    name : str, optional
        For titles and messages.
    metadata : mapping, optional
        Strings and numbers.
    history : tuple of str, optional
        One sentence per step.
    recipe : mapping, optional
        Constructor and arguments of an analytic motion.

    Examples
    --------
    >>> pulse = GroundMotion.sine_pulse()
    >>> round(pulse.peak_acceleration.m_as("m/s^2"), 12)
    9.81
    """

    __slots__ = ()

    @classmethod
    def read(
        cls,
        path: PathLike,
        format: str | None = None,  # noqa: A002
        component: str | None = None,
        unit: str | None = None,
        *,
        time_step: QuantityLike | None = None,
    ) -> Self:
        """Read a record file.

        Parameters
        ----------
        path : str or path-like
            File.
        format : str, optional
            A name of :func:`rockframe.motion.formats`; recognised from the
            file unless given.
        component : str, optional
            Component that is expected; a file of another one is refused.
        unit : str, optional
            Unit of the samples, where the file does not say: ``"g"``,
            ``"gal"``, ``"cm/s^2"``, ... Here ``g`` is the acceleration of gravity.
        time_step : str or Quantity, optional
            For a column of samples without times [s].

        Returns
        -------
        GroundMotion

        Raises
        ------
        RecordError
            The file cannot be read as a ground-motion record.
        UnitsError
            `unit` is not an acceleration, or `time_step` not a time.
        ComponentError
            `format` is unknown, or `time_step` is not positive.

        Warns
        -----
        RecordWarning
            The file contradicts itself or an argument a little, or its peak or
            time step is unusual.
        """
        owner = f"{cls.__name__}.read"
        request = Request(
            unit=None if unit is None else argument_unit(unit, owner=owner),
            unit_name=None if unit is None else str(unit),
            time_step=None
            if time_step is None
            else to_si(time_step, TIME, owner=owner, name="time_step", condition=POSITIVE),
            component=None if component is None else str(component),
        )
        reading = read_record(path, format, request)
        for message in reading.warnings:
            warnings.warn(message, RecordWarning, stacklevel=2)
        return cls(
            reading.si,
            name=PurePath(path).stem,
            metadata=reading.metadata,
            history=reading.history,
        )

    @classmethod
    def from_arrays(
        cls,
        acceleration: ArrayLike,
        time_step: QuantityLike,
        vertical: ArrayLike | None = None,
        *,
        name: str | None = None,
    ) -> Self:
        """Build a motion from arrays with a unit.

        Parameters
        ----------
        acceleration : Quantity, (sequence, unit) or DataArray, shape (n,)
            Horizontal acceleration; a DataArray needs the attribute ``units``
            [m s^-2].
        time_step : str or Quantity
            Time between samples [s].
        vertical : Quantity, (sequence, unit) or DataArray, shape (n,), optional
            Vertical acceleration, upwards [m s^-2].
        name : str, optional
            For titles and messages.

        Returns
        -------
        GroundMotion

        Raises
        ------
        UnitsError
            An array or the time step has no unit, or a wrong one.
        ComponentError
            Not finite, not one-dimensional, or of different lengths.
        """
        owner = f"{cls.__name__}.from_arrays"
        step = to_si(time_step, TIME, owner=owner, name="time_step", condition=POSITIVE)
        across = accelerations_to_si(acceleration, owner=owner, name="acceleration")
        upwards = None
        if vertical is not None:
            upwards = accelerations_to_si(vertical, owner=owner, name="vertical")
            if upwards.size != across.size:
                msg = (
                    f"{owner}: acceleration has {across.size} samples, vertical {upwards.size}; "
                    "give both the same length, or use with_vertical, which pads"
                )
                raise ComponentError(msg)
        for label, array in (("acceleration", acceleration), ("vertical", vertical)):
            declared = declared_step(array)
            if declared is not None and not np.isclose(declared, step, rtol=_SAME_STEP, atol=0.0):
                msg = (
                    f"{owner}: the time axis of {label} has the step {declared:.9g} s, "
                    f"but time_step is {step:.9g} s"
                )
                raise ComponentError(msg)
        words = f"built from arrays: {across.size} samples at {step!r} s"
        si = MotionSI(time_step=step, acceleration=across, vertical=upwards)
        return cls(si, name=name or UNNAMED, history=(words,))

    @classmethod
    def sine_pulse(
        cls,
        amplitude: QuantityLike = "-9.81 m/s^2",
        frequency: QuantityLike = "1 Hz",
        cycles: RatioLike = 1,
    ) -> Self:
        """Build ``amplitude sin(2 pi frequency t)`` over some cycles, then nothing.

        Parameters
        ----------
        amplitude : str or Quantity, optional
            Amplitude; the defaults are those of Eq. (17) [m s^-2].
        frequency : str or Quantity, optional
            Cyclic frequency [Hz].
        cycles : float, optional
            Length over the period [1].

        Returns
        -------
        GroundMotion
            With polynomial pieces between samples: exact to 3e-13 of the amplitude.

        Raises
        ------
        UnitsError
            A wrong unit, or none.
        ComponentError
            Not finite, or a frequency or length that is not positive.
        """
        owner = f"{cls.__name__}.sine_pulse"
        peak = to_si(amplitude, ACCELERATION, owner=owner, name="amplitude")
        hertz = to_si(frequency, FREQUENCY, owner=owner, name="frequency", condition=POSITIVE)
        count = to_ratio(cycles, owner=owner, name="cycles", condition=POSITIVE)
        return cls(
            sine(amplitude=peak, frequency=hertz, cycles=count, owner=owner),
            name=f"sine pulse, {peak:.6g} m/s^2, {hertz:.6g} Hz, cycles: {count:.6g}",
            history=(f"sine pulse: {peak!r} m/s^2, {hertz!r} Hz, cycles: {count!r}",),
            recipe={
                "constructor": "sine_pulse",
                "amplitude": f"{peak!r} {ACCELERATION.unit}",
                "frequency": f"{hertz!r} {FREQUENCY.unit}",
                "cycles": count,
            },
        )

    @classmethod
    def harmonic(
        cls,
        amplitude: QuantityLike,
        frequency: QuantityLike,
        duration: QuantityLike,
        phase: QuantityLike | None = None,
    ) -> Self:
        """Build ``amplitude sin(2 pi frequency t + phase)`` for some time.

        Parameters
        ----------
        amplitude : str or Quantity
            Amplitude [m s^-2].
        frequency : str or Quantity
            Cyclic frequency [Hz].
        duration : str or Quantity
            Length [s].
        phase : str or Quantity, optional
            Phase at the start; zero unless given [rad].

        Returns
        -------
        GroundMotion
            With polynomial pieces between samples: exact to 3e-13 of the amplitude.

        Raises
        ------
        UnitsError
            A wrong unit, or none.
        ComponentError
            Not finite, or a frequency or duration that is not positive.
        """
        owner = f"{cls.__name__}.harmonic"
        peak = to_si(amplitude, ACCELERATION, owner=owner, name="amplitude")
        hertz = to_si(frequency, FREQUENCY, owner=owner, name="frequency", condition=POSITIVE)
        length = to_si(duration, TIME, owner=owner, name="duration", condition=POSITIVE)
        shift = 0.0 if phase is None else to_si(phase, ANGLE, owner=owner, name="phase")
        start = "" if phase is None else f", phase {shift!r} rad"
        return cls(
            sine(amplitude=peak, frequency=hertz, cycles=length * hertz, phase=shift, owner=owner),
            name=f"harmonic motion, {peak:.6g} m/s^2, {hertz:.6g} Hz, {length:.6g} s",
            history=(f"harmonic motion: {peak!r} m/s^2, {hertz!r} Hz, {length!r} s{start}",),
            recipe={
                "constructor": "harmonic",
                "amplitude": f"{peak!r} {ACCELERATION.unit}",
                "frequency": f"{hertz!r} {FREQUENCY.unit}",
                "duration": f"{length!r} {TIME.unit}",
                **({} if phase is None else {"phase": f"{shift!r} {ANGLE.unit}"}),
            },
        )

    def to_dataset(self) -> xr.Dataset:
        """Write the motion as a dataset that plain xarray can store.

        Returns
        -------
        xarray.Dataset
            ``acceleration`` (and ``vertical_acceleration``) over ``time``, with
            units, name, metadata and history.
        """
        from rockframe.motion.dataset import to_dataset

        return to_dataset(self, self._recipe)

    @classmethod
    def from_dataset(cls, dataset: xr.Dataset) -> Self:
        """Read what :meth:`to_dataset` wrote, bit for bit.

        Parameters
        ----------
        dataset : xarray.Dataset
            With ``acceleration`` over ``time``.

        Returns
        -------
        GroundMotion

        Raises
        ------
        SchemaError
            Not such a dataset, or its samples were changed since.
        """
        from rockframe.motion.dataset import from_dataset

        return cls(**from_dataset(dataset))

    def to_dict(self) -> dict[str, Any]:
        """Describe the motion: an analytic one completely, a record by its digest.

        Returns
        -------
        dict
            Plain values, fit for JSON: constructor and arguments of an analytic motion,
            with the ``operations`` done to it since; ``constructor`` is None for a
            motion that only its samples describe.
        """
        kind = {"type": type(self).__name__}
        if self._recipe is not None:
            return {**kind, **self._recipe}
        return {**kind, "constructor": None, "name": self.name, "sha256": self.sha256}

    @classmethod
    def from_dict(cls, description: Mapping[str, Any]) -> Self:
        """Build the analytic motion that :meth:`to_dict` described.

        Parameters
        ----------
        description : mapping
            As written by :meth:`to_dict`.

        Returns
        -------
        GroundMotion

        Raises
        ------
        SchemaError
            The motion is a record, which must be supplied, or the description
            fits no constructor.
        """
        arguments = {key: value for key, value in description.items() if key != "type"}
        constructor = arguments.pop("constructor", None)
        operations = arguments.pop("operations", ())
        if constructor is None:
            known = " and ".join(
                f"{key} {arguments[key]}" for key in ("name", "sha256") if key in arguments
            )
            msg = f"found only {known or 'a description'} of a record; supply the record itself"
            raise SchemaError(msg)
        if constructor not in _ANALYTIC:
            msg = f"found the constructor {constructor!r}; expected one of {', '.join(_ANALYTIC)}"
            raise SchemaError(msg)
        try:
            motion = getattr(cls, constructor)(**arguments)
            for operation in operations:
                ((name, given),) = operation.items()
                if name not in _OPERATIONS:
                    msg = f"found the operation {name!r}; expected one of {', '.join(_OPERATIONS)}"
                    raise SchemaError(msg)
                if name == "with_vertical":
                    given = {"other": cls.from_dict(given["other"])}
                motion = getattr(motion, name)(**given)
        except TypeError as problem:
            msg = f"found arguments that do not fit {constructor} or what was done to it: {problem}"
            raise SchemaError(msg) from problem
        return motion
