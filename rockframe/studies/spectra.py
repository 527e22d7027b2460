"""Spectra of rocking and of overturning: motions and blocks of all sizes."""

import math
from collections.abc import Callable, Mapping, Sequence
from inspect import signature
from typing import Any, Final, Unpack

import numpy as np
import xarray as xr

from rockframe.components import Block
from rockframe.errors import ComponentError, collected_warnings
from rockframe.results.outcome import overturns
from rockframe.results.schema import build_dataset, with_variables
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.shared_arguments import with_shared_arguments
from rockframe.simulation.system import System, check_system
from rockframe.studies.dynamic_analysis import read_line_axes, unstack_cases
from rockframe.studies.intensities import (
    SCALE_EXPONENTS,
    Intensity,
    map_motions,
    measure_attributes,
)
from rockframe.studies.line_scan import (
    CAPACITY_DEFINITION,
    SCAN_SOURCE,
    VERDICT_DIM,
    LineScan,
    read_resolution,
    read_scales,
    read_sorted,
    read_width,
    table_of,
)
from rockframe.studies.sweeps.arguments import SweepArguments
from rockframe.studies.sweeps.motions import SCALE, MotionsLike
from rockframe.studies.sweeps.scenes import needed_motions, scene_of
from rockframe.studies.sweeps.sweep import sweep
from rockframe.units import LENGTH, PERIOD, Measure, QuantityLike, RatioLike, Unit

_SLENDERNESS: Final = Measure("a pure ratio", Unit.ONE, "4")
_NO_ECCENTRICITY: Final = 1e-9
"""Eccentricity of the centre of mass over the height that counts as none [1]."""


class BlockSizes:
    """A system, whose block is defined by its shape factor, with blocks of other sizes."""

    def __init__(
        self,
        system: System,
        periods: Any,
        slenderness: Any,
        axes: object = None,
        *,
        of: Callable[..., xr.Dataset],
    ) -> None:
        owner = of.__name__
        check_system(system, owner)
        self.system = _with_shape_factor(system, owner)
        si = self.system.parts.block_si
        periods = read_sorted(periods, PERIOD, "periods", owner=owner)
        entries = [si.height / si.width] if slenderness is None else slenderness
        slenderness = read_sorted(entries, _SLENDERNESS, "slenderness", owner=owner)
        # omega^2 = mu g / ((1 + mu) R0), Eq. (6)
        scale = si.frequency_at(system.options.gravity) ** 2 * si.radius
        radius = scale * (0.5 * periods / math.pi) ** 2
        angle = np.arctan(1.0 / slenderness)
        # in rows of a table: slenderness by slenderness
        width, height = (np.outer(2.0 * part(angle), radius).ravel() for part in (np.sin, np.cos))
        scene = scene_of(self.system)
        # a wall has a height, too
        parts = self.system.parts.structural()
        shared = {name for part in parts if not isinstance(part, Block) for name in part.varied()}
        sizes = {
            f"Block.{name}" if name in shared else name: (values, str(LENGTH.unit))
            for name, values in (("width", width), ("height", height))
        }
        own_axes = [scene.axis(name, values) for name, values in sizes.items()]
        other_axes = read_line_axes(
            axes, scene, owner=owner, argument_names=signature(of).parameters, own_axes=own_axes
        )
        self.columns = other_axes.columns(sizes)
        self._sizes = {"slenderness": len(slenderness), "rocking_period": len(periods)}
        self._sizes |= other_axes.sizes
        labels = build_dataset({"slenderness": slenderness, "rocking_period": periods}, {}).coords
        own = {str(name): values.variable for name, values in labels.items()}
        self._labels = own | other_axes.labels

    def unstack(self, runs: xr.Dataset) -> xr.Dataset:
        """Return the runs with the dimensions of the sizes instead of the rows of the table."""
        return unstack_cases(runs, self._sizes, self._labels)


def _with_shape_factor(system: System, owner: str) -> System:
    """Return a system whose block keeps its shape factor where width and height change."""
    block, fault = system.parts.block, ""
    if type(block) is not Block:
        fault = f"a {type(block or next(iter(system.parts.structural()))).__name__}"
    elif block.si.eccentricity != 0.0 or (
        abs(block.si.centre_height - block.si.half_height) > _NO_ECCENTRICITY * block.si.height
    ):
        fault = "a block whose centre of mass is not in its middle"
    elif system.parts.cap is not None:
        fault = "a scene with a cap"
    if fault or block is None:
        msg = f"{owner}: system needs a block of width and height on its base, got {fault}"
        raise ComponentError(msg)
    if block.given.inertia is None and block.given.centre_height is None:
        return system  # otherwise these would not change with width and height
    with collected_warnings():  # block and system already gave their warnings when they were made
        scaling = block.replace(shape_factor=block.shape_factor, centre_height=None)
        other_parts = [part for part in system.parts.structural() if part is not block]
        options: dict[str, Any] = system.options.to_dict()
        return System(scaling, *other_parts, **options)


_ROCKING: Final = "rocking_spectrum"
_OVERTURNING: Final = "overturning_spectrum"


@with_shared_arguments(SweepArguments, extra_into="axes")
def rocking_spectrum(
    system: System,
    motions: MotionsLike | None = None,
    *,
    periods: Any,
    slenderness: Any = None,
    axes: Mapping[str, Any] | None = None,
    **run: Unpack[SweepArguments],
) -> xr.Dataset:
    """Run blocks of many sizes under motions: the counterpart of a response spectrum.

    Parameters
    ----------
    system : System
        A block on its base. Its size is varied, and its slenderness if given; its shape factor, its
        mass and the parameters of the base stay unchanged.
    motions : GroundMotion, or sequence or mapping of them, optional
        Motions. By default the motion among the parts of the system.
    periods : values with a unit
        2 pi over the frequency parameter p of the block: ``([2, 4, 8], "s")`` [s].
    slenderness : values, optional
        Height over width [1]. The default is that of the block.
    axes : mapping of str to values, optional
        What else varies, as for :func:`rockframe.incremental_dynamic_analysis`.
    **more_axes : values
        Axes whose names a keyword can have.

    Returns
    -------
    xarray.Dataset
        The sweep over ``slenderness``, ``rocking_period`` [s], the axes and ``motion``, whose
        ``peak_relative_rotation`` is the rocking spectrum; with ``width`` and ``height`` [m] of the
        blocks (``Block.height`` if there is a wall, which also has a height).
        :func:`rockframe.case` returns any case.

    Raises
    ------
    UnitsError, ComponentError
        An argument is out of range, has a wrong unit or none; or the system is no block on a
        base.
    StudyError
        As for :func:`rockframe.sweep`.

    Notes
    -----
    Makris and Konstantinidis (2003). The period 2 pi / p grows with the square root of the size. It
    is not a period of free rocking, which depends on the amplitude.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    >>> found = rf.rocking_spectrum(system, pulse, periods=([2, 4, 8], "s"))
    >>> dict(found.peak_relative_rotation.sizes)
    {'slenderness': 1, 'rocking_period': 3, 'motion': 1}
    """
    sizes = BlockSizes(system, periods, slenderness, axes, of=rocking_spectrum)
    named = needed_motions(motions, scene_of(system), owner=_ROCKING)
    runs = sweep(sizes.system, named, cases=table_of(sizes.columns), **run)
    return sizes.unstack(runs).assign_attrs(title="Rocking spectrum")


@with_shared_arguments(SweepArguments, extra_into="axes")
def overturning_spectrum(
    system: System,
    motions: MotionsLike | None = None,
    *,
    periods: Any,
    slenderness: Any = None,
    scale: Sequence[float] | np.ndarray,
    intensity: str = "PGA",
    period: QuantityLike | None = None,
    resolution: RatioLike = 0.02,
    bracket_width: RatioLike = 1e-3,
    axes: Mapping[str, Any] | None = None,
    **run: Unpack[SweepArguments],
) -> xr.Dataset:
    """Find the least intensity of motions that overturns blocks of many sizes.

    Parameters
    ----------
    system, motions, periods, slenderness : optional
        As for :func:`rockframe.rocking_spectrum`.
    scale : sequence of float
        Positive factors of the motions at which all blocks are run first [1].
    intensity : str, optional
        An intensity measure, see :func:`rockframe.fragility`.
    period : str or Quantity, optional
        Period of the oscillator of a spectral intensity [s].
    resolution : float, optional
        As for :func:`rockframe.incremental_dynamic_analysis` [1].
    bracket_width : float, optional
        Width of a bracket, relative to its upper scale [1].
    axes : mapping of str to values, optional
        What else varies, as for :func:`rockframe.incremental_dynamic_analysis`.
    **more_axes : values
        Axes whose names a keyword can have.

    Returns
    -------
    xarray.Dataset
        Over ``slenderness``, ``rocking_period`` [s], the axes and ``motion``: ``capacity_scale``
        [1] and ``capacity_intensity``, the least found to overturn, infinite if none did, and
        ``capacity_resolution``; ``left_out_count``, the number of runs of the scan without a
        verdict; ``flip_count``. Also over ``flip``: ``scale_below``, ``scale_above`` and
        ``exceeds_above``.

    Raises
    ------
    UnitsError, ComponentError
        An argument is out of range, has a wrong unit or none; or the system is no block on a
        base.
    StudyError
        As for :func:`rockframe.sweep`.

    Notes
    -----
    The analysis is :func:`rockframe.incremental_dynamic_analysis` for blocks of many sizes.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> pulse = rf.GroundMotion.half_sine_pulse("1 m/s^2", "0.5 s")
    >>> found = rf.overturning_spectrum(
    ...     system, pulse, periods=([2, 4], "s"), scale=[3, 6, 12], free_vibration="5 s"
    ... )
    >>> found.capacity_intensity.units
    'm s^-2'
    """
    sizes = BlockSizes(system, periods, slenderness, axes, of=overturning_spectrum)
    scales = read_scales(scale, owner=_OVERTURNING)
    width = read_width(bracket_width, owner=_OVERTURNING)
    finest = read_resolution(resolution, owner=_OVERTURNING)
    measure = Intensity.read(intensity, period, owner=_OVERTURNING)
    named = needed_motions(motions, scene_of(system), owner=_OVERTURNING)
    lines = LineScan(
        sizes.system, named, sizes.columns, run, _OVERTURNING,
        lambda runs: overturns(runs).expand_dims(VERDICT_DIM),
    )  # fmt: skip
    result = lines.run_scan(scales, width=width, resolution=finest)
    scan = result.scan
    shape = (scan.sizes[CASE], scan.sizes[MOTION])
    verdicts = overturns(scan).transpose(CASE, MOTION, SCALE).to_numpy()
    capacities, flips = result.capacities(shape), result.flips(shape)
    capacity = capacities["capacity_scale"]
    unit_intensity = map_motions(scan, named, measure.compute)
    factors = capacity ** np.where(np.isinf(capacity), 1, SCALE_EXPONENTS[measure.name])
    values = {
        **capacities,
        "capacity_intensity": unit_intensity.to_numpy() * factors,
        "flip_count": flips["flip_count"],
        "left_out_count": np.isnan(verdicts).sum(axis=-1),
        **flips,
    }
    dataset = with_variables(scan.drop_dims(SCALE), values, over=(CASE, MOTION))
    dataset["capacity_intensity"].attrs["units"] = measure.attributes()["units"]
    return sizes.unstack(dataset).assign_attrs(
        title="Overturning spectrum",
        source=SCAN_SOURCE,
        **measure_attributes(measure),
        capacity=CAPACITY_DEFINITION,
        resolution=finest,
        bracket_width=width,
    )
