"""The ground motion: where it comes from, and how it is kept."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import xarray as xr

from rockframe.calls import public_names
from rockframe.errors import ComponentError, RecordWarning, SchemaError, shown
from rockframe.motion.analytic import ANALYTIC, AnalyticMotions
from rockframe.motion.operations import OPERATIONS
from rockframe.motion.quantities import accelerations_to_si, argument_unit, declared_step
from rockframe.motion.readers.components import component_names
from rockframe.motion.readers.reading import read_record
from rockframe.motion.readers.source import Request
from rockframe.motion.samples import MotionSI
from rockframe.motion.synthetic import SYNTHETIC, SyntheticMotions
from rockframe.motion.value import UNNAMED
from rockframe.units import POSITIVE, TIME_STEP, to_si
from rockframe.words import dataset as checked_dataset

if TYPE_CHECKING:
    from rockframe.motion.quantities import ArrayLike, QuantityLike
    from rockframe.motion.readers.source import PathLike

_CONSTRUCTORS = (*ANALYTIC, *SYNTHETIC)
_SAME_STEP = 1e-6


@public_names
class GroundMotion(AnalyticMotions, SyntheticMotions):
    """Acceleration of the ground over time; immutable.

    Build one with :meth:`read`, :meth:`from_arrays`, :meth:`from_dataset`, or as
    an analytic pulse: :meth:`sine_pulse`, :meth:`type_a_pulse`,
    :meth:`ricker_wavelet` and others, or as a synthetic earthquake with
    :meth:`stochastic`. Every processing step returns a new motion
    and adds a sentence to its `history`.

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
        component: str | tuple[str, str] | None = None,
        unit: str | None = None,
        *,
        time_step: QuantityLike | None = None,
        response: PathLike | None = None,
    ) -> Self:
        """Read a record file.

        Parameters
        ----------
        path : str or path-like
            File.
        format : str, optional
            A name of :func:`rockframe.motion.formats`; recognised from the
            file unless given.
        component : str or pair of str, optional
            Component by its name in the file (``"HNE"``, ``"S16W"``), by its
            direction (``"N"``, ``"090"``, ``"U"``) or by its number
            (``"channel 3"``); a pair takes a horizontal component and sets the
            vertical one beside it. Needed where a file has more than one
            horizontal component.
        unit : str, optional
            Unit of the samples, where the file does not say: ``"g"``,
            ``"gal"``, ``"cm/s^2"``, ... Here ``g`` is the acceleration of gravity.
        time_step : str or Quantity, optional
            For a column of samples without times [s].
        response : str or path-like, optional
            StationXML with the response of the instrument, for counts in
            miniSEED; looked for beside the file unless given.

        Returns
        -------
        GroundMotion
            Its metadata name the file and its digest, and what the file says of
            event, station, component and unit; what was done is in its history.

        Raises
        ------
        RecordError
            The file cannot be read as a ground-motion record, or has no such
            component; the message lists those that it has.
        UnitsError
            `unit` is not an acceleration, or `time_step` not a time.
        ComponentError
            `format` is unknown, `component` neither a name nor a pair of names,
            or `time_step` is not positive.

        Warns
        -----
        RecordWarning
            The file contradicts itself or an argument a little, its peak or time
            step is unusual, or its only component is vertical.
        """
        owner = f"{cls.__name__}.read"
        horizontal, vertical = component_names(component, owner=owner)
        request = Request(
            unit=None if unit is None else argument_unit(unit, owner=owner),
            unit_name=None if unit is None else str(unit),
            time_step=None
            if time_step is None
            else to_si(time_step, TIME_STEP, owner=owner, name="time_step", condition=POSITIVE),
            component=horizontal,
            vertical=vertical,
            response=None if response is None else str(response),
        )
        reading = read_record(path, format, request)
        for message in reading.warnings:
            warnings.warn(message, RecordWarning, stacklevel=2)
        return cls(
            reading.si,
            name=reading.name or PurePath(path).stem,
            metadata=reading.metadata,
            history=reading.history,
            recipe=reading.recipe,
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
        step = to_si(time_step, TIME_STEP, owner=owner, name="time_step", condition=POSITIVE)
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

        return cls(**from_dataset(checked_dataset(dataset, owner=f"{cls.__name__}.from_dataset")))

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
        if constructor not in _CONSTRUCTORS:
            known = ", ".join(_CONSTRUCTORS)
            msg = f"found the constructor {shown(constructor)}; expected one of {known}"
            raise SchemaError(msg)
        try:
            motion = getattr(cls, constructor)(**arguments)
            for operation in operations:
                ((name, given),) = operation.items()
                if name not in OPERATIONS:
                    known = ", ".join(OPERATIONS)
                    msg = f"found the operation {shown(name)}; expected one of {known}"
                    raise SchemaError(msg)
                if "other" in given:
                    given = {**given, "other": cls.from_dict(given["other"])}
                motion = getattr(motion, name)(**given)
        except TypeError as problem:
            msg = f"found arguments that do not fit {constructor} or what was done to it: {problem}"
            raise SchemaError(msg) from problem
        return motion
