"""Incremental dynamic analysis: motions are scaled until limit states are exceeded.

Also the axes of analyses along scales of motions: each combination of their values is a line.
"""

import math
from collections.abc import Callable, Collection, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from inspect import signature
from types import MappingProxyType
from typing import Any, Final, Unpack, cast

import numpy as np
import xarray as xr

from rockframe.errors import (
    ModelWarning,
    RockframeError,
    StudyError,
    did_you_mean,
    short_repr,
    warn,
)
from rockframe.results.forces import share_words, slip_words
from rockframe.results.outcome import overturns
from rockframe.results.schema import with_labels, with_variables
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.shared_arguments import with_shared_arguments
from rockframe.signals.arrays import AnyArray, Array
from rockframe.simulation.system import System
from rockframe.studies.intensities import Intensity, intensity_of_runs, measure_attributes
from rockframe.studies.limit_states import (
    LIMITS_ATTRIBUTE,
    OVERTURNING,
    exceeds,
    labels_of_states,
    limit_states,
    states_json,
)
from rockframe.studies.line_scan import (
    CAPACITY_DEFINITION,
    INTERRUPTED_ENDING,
    SCAN_SOURCE,
    VERDICT_DIM,
    LineScan,
    read_resolution,
    read_scales,
    read_width,
)
from rockframe.studies.sweeps.arguments import SWEEP_ARGUMENT_NAMES, SweepArguments
from rockframe.studies.sweeps.axes import Axis, Changes, faults_of_values
from rockframe.studies.sweeps.labelling import cases_verdict, slips_of_cases
from rockframe.studies.sweeps.motions import SCALE, MotionsLike
from rockframe.studies.sweeps.scenes import SweptScene, needed_motions, scene_of
from rockframe.system.options import PointsLike
from rockframe.units import QuantityLike, RatioLike, Unit

_OWNER: Final = "incremental_dynamic_analysis"
_SCALES: Final = tuple(0.1 * k for k in range(1, 41))


@with_shared_arguments(SweepArguments, extra_into="axes")
def incremental_dynamic_analysis(
    system: System | Callable[..., System],
    motions: MotionsLike | None = None,
    *,
    scale: Sequence[float] | np.ndarray = _SCALES,
    limits: Iterable[object] = (),
    intensity: str | None = None,
    period: QuantityLike | None = None,
    resolution: RatioLike = 0.02,
    bracket_width: RatioLike = 1e-3,
    axes: Mapping[str, Any] | None = None,
    output_step: QuantityLike | None = None,
    outputs: Sequence[str] | None = None,
    points: PointsLike | None = None,
    **run: Unpack[SweepArguments],
) -> xr.Dataset:
    """Scale motions, and find all scales between which limit states begin or cease to be exceeded.

    Parameters
    ----------
    system : System or callable
        The scene; or a function that takes the axes by name and returns a System.
    motions : GroundMotion, or sequence or mapping of them, optional
        Motions. By default the motion among the parts of the system.
    scale : sequence of float, optional
        Positive factors at which all motions are run first. The default is 0.1 to 4 in steps of 0.1
        [1].
    limits : iterable, optional
        Limit states before overturning, in order: ``"uplift"``, and peak rotations relative to the
        overturning angle, such as 0.5; or variables of runs, as for :func:`rockframe.fragility`
        [1].
    intensity : str, optional
        An intensity measure that is added to the result, such as ``"PGA"``; see
        :func:`rockframe.fragility`.
    period : str or Quantity, optional
        Period of the oscillator of a spectral intensity [s].
    resolution : float, optional
        Relative width, over the upper scale, down to which gaps between runs below a capacity are
        halved, for all motions together; 1 leaves the scales as they are [1].
    bracket_width : float, optional
        Width of a bracket, relative to its upper scale [1].
    axes : mapping of str to values, optional
        Further axes, as for :func:`rockframe.sweep`. Each combination of their values is a
        structure with its own capacities.
    **more_axes : values
        Axes whose names are valid keywords. `width` is the width of a block.
    output_step : str or Quantity, optional
        Spacing of the histories, as for :func:`rockframe.sweep` [s].
    outputs : sequence of str, optional
        Histories of the runs at `scale`, as for :func:`rockframe.sweep`; None keeps none.
    points : mapping of str to (str or Quantity, str or Quantity), optional
        Points of the body, whose peaks can be used as limit states, as for :func:`rockframe.sweep`
        [m].

    Returns
    -------
    xarray.Dataset
        The sweep over the axes, ``scale`` and ``motion``, with the intensity measure. Over
        ``limit_state``, the axes and ``motion``: ``capacity_scale``, the least scale found to
        exceed the limit state, infinite if none, and an upper bound if it is the least scale of the
        scan; ``capacity_resolution``; ``flip_count``. Also over ``flip``: ``scale_below``,
        ``scale_above`` [1] and ``exceeds_above``, NaN beyond the last flip. Over ``limit_state``
        and the axes: ``censored_count``, the number of motions that did not exceed it. The
        attribute ``verdict`` is a summary in words.

    Raises
    ------
    UnitsError, ComponentError
        An argument is out of range, has a wrong unit or none, or names an unknown intensity
        measure.
    StudyError
        As for :func:`rockframe.sweep`.

    Warns
    -----
    SolverWarning, ModelWarning
        As :func:`rockframe.sweep` does.
    ModelWarning
        Some motions overturn the block at the least scale already: the scan starts too high for
        them.

    Notes
    -----
    Vamvatsikos and Cornell (2002). Rocking is not monotone in the scale: above the first exceedance
    a block may stand again, many times. Each change that the runs show is bracketed. A capacity is
    the least scale found to exceed the limit state. Below it, down to the least scale of the scan,
    only ranges of scales narrower than ``capacity_resolution`` times their upper end may exceed.
    The share of runs that exceed does not depend on such a resolution: :func:`rockframe.fragility`
    is fitted to all runs of the scan unless capacities are requested.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"))
    >>> pulse = rf.GroundMotion.half_sine_pulse("3 m/s^2", "1 s")
    >>> found = rf.incremental_dynamic_analysis(
    ...     system, pulse, scale=[0.5, 1.0, 1.5], free_vibration="10 s"
    ... )
    >>> round(found.capacity_scale.item(), 2)
    1.13
    """
    scene = scene_of(system)
    arguments = signature(incremental_dynamic_analysis).parameters
    line_axes = read_line_axes(axes, scene, owner=_OWNER, argument_names=arguments)
    states = limit_states(limits, owner=_OWNER)
    scales = read_scales(scale, owner=_OWNER)
    width = read_width(bracket_width, owner=_OWNER)
    finest = read_resolution(resolution, owner=_OWNER)
    measure = None if intensity is None else Intensity.read(intensity, period, owner=_OWNER)
    by_name = needed_motions(motions, scene, owner=_OWNER)
    requested: Any = {**run, "points": points}

    def verdicts(runs: xr.Dataset) -> xr.DataArray:
        return xr.concat([exceeds(runs, state) for state in states], VERDICT_DIM)

    lines = LineScan(system, by_name, line_axes.columns(), requested, _OWNER, verdicts)
    result = lines.run_scan(
        scales, width=width, resolution=finest, outputs=outputs, output_step=output_step
    )
    scan = line_axes.unstack(result.scan)
    sizes = {"limit_state": len(states), **line_axes.sizes, MOTION: scan.sizes[MOTION]}
    shape, over = tuple(sizes.values()), tuple(sizes)
    capacities = result.capacities(shape)
    dataset = with_variables(scan, {**capacities, **result.flips(shape)}, over=over)
    censored = np.isinf(capacities["capacity_scale"]).sum(axis=-1)
    dataset = with_variables(dataset, {"censored_count": censored}, over=over[:-1])
    dataset = with_variables(dataset, labels_of_states(states))
    if measure is not None:
        values = intensity_of_runs(scan, measure, by_name, owner=_OWNER)
        dataset = dataset.assign({measure.name: values}).assign_attrs(measure_attributes(measure))
    below, least = _overturned_at_least_scale(dataset), float(dataset[SCALE].min())
    if below.any():
        which = "motions" if below.ndim == 1 else "lines"
        warn(
            f"{_OWNER}: the scan starts too high: {int(below.sum())} of {below.size} {which} "
            f"overturn at its least scale, {least:.4g}, already, and their capacities lie at or "
            "below it; give lesser scales",
            ModelWarning,
        )
    dataset.attrs |= {
        "title": "Incremental dynamic analysis of a rocking system",
        "source": SCAN_SOURCE,
        "capacity": CAPACITY_DEFINITION,
        LIMITS_ATTRIBUTE: states_json(states),
        "resolution": finest,
        "bracket_width": width,
        "verdict": _sentence(dataset, line_axes.sizes),
    }
    return dataset


def _overturned_at_least_scale(dataset: xr.Dataset) -> Array:
    """Find the motions that overturned at the least scale: their capacities may lie below it."""
    capacity = dataset["capacity_scale"].isel(limit_state=-1).to_numpy()
    return capacity == float(dataset[SCALE].min())


def verdict_of_analysis(dataset: xr.Dataset) -> str:
    """Say under how many motions a dynamic analysis, or a part of it, overturned."""
    capacity = dataset["capacity_scale"]
    is_complete = {"limit_state", MOTION} <= set(capacity.dims) and SCALE in dataset.dims
    if not is_complete or str(capacity["limit_state"][-1].item()) != OVERTURNING:
        return cases_verdict(dataset)
    lines = capacity.sizes.items()
    return _sentence(dataset, {str(n): k for n, k in lines if n not in ("limit_state", MOTION)})


def _sentence(dataset: xr.Dataset, structures: Mapping[str, int]) -> str:
    """Return the verdict in words: how many motions overturned, and from which scale on."""
    of_overturning = dataset.isel(limit_state=-1)
    capacity = of_overturning["capacity_scale"].to_numpy()
    count, finite = capacity.size, np.isfinite(capacity)
    motions = dataset.sizes[MOTION]
    subject = f"{motions} motion{'s' if motions > 1 else ''}"
    if structures:
        combined = f"{math.prod(structures.values())} structures by {', '.join(structures)}"
        subject = f"{count} lines, of {combined} under {subject},"
    text = f"Of {subject} {int(finite.sum())} overturned"
    below = _overturned_at_least_scale(dataset)
    if finite.any() and below.all():
        text += f", at or below {capacity[finite].min():.4g} times the motion"
    elif finite.any():
        least = f"{'at or below ' if below.any() else ''}{capacity[finite].min():.4g}"
        most = f"{capacity[finite].max():.4g}"
        text += f", from {least}{'' if most == least else f' to {most}'} times the motion on"
    repeated = int((of_overturning["flip_count"].to_numpy() > 1).sum())
    if repeated:
        text += f"; under {repeated} the verdict changed more than once"
    of_scan = str(dataset.attrs.get("verdict", ""))
    interrupted = of_scan.endswith(INTERRUPTED_ENDING)
    missing = int(overturns(dataset).isnull().sum())
    if missing and not interrupted:
        text += f"; {missing} of {dataset['status'].size} runs of the scan have no verdict"
    slides = dataset["would_slide"].to_numpy() if "would_slide" in dataset else np.empty(0)
    for words, values in ((share_words, slides), (slip_words, slips_of_cases(dataset))):
        shown = words(values, runs="runs of the scan")
        text += f"; {shown}" if shown else ""
    return f"{text}{INTERRUPTED_ENDING if interrupted else '.'}"


@dataclass(frozen=True, eq=False)
class LineAxes:
    """Axes other than the scale of the motions."""

    axes: tuple[Axis, ...] = ()

    @property
    def sizes(self) -> dict[str, int]:
        """The dimensions of the axes, in order, and their lengths."""
        return {axis.name: len(axis.values) for axis in self.axes}

    def columns(
        self, rows: Mapping[str, tuple[AnyArray, str]] = MappingProxyType({})
    ) -> dict[str, tuple[AnyArray, str]]:
        """Return a table of all combinations of values for each of some rows; last axis fastest."""
        places = np.indices(tuple(self.sizes.values()))
        count = math.prod(self.sizes.values())
        repeats = max((len(values) for values, _ in rows.values()), default=1)
        table = {name: (np.repeat(values, count), unit) for name, (values, unit) in rows.items()}
        return table | {
            axis.name: (np.tile(axis.values[place.ravel()], repeats), axis.unit or str(Unit.ONE))
            for axis, place in zip(self.axes, places, strict=True)
        }

    @property
    def labels(self) -> dict[str, xr.Variable]:
        """Their values, by their names."""
        return {one.name: xr.Variable(one.name, one.values, one.attributes()) for one in self.axes}

    def unstack(self, runs: xr.Dataset) -> xr.Dataset:
        """Return the runs with the dimensions of the axes instead of the rows of the table."""
        return unstack_cases(runs, self.sizes, self.labels) if self.axes else runs


def unstack_cases(
    runs: xr.Dataset, sizes: Mapping[str, int], labels: Mapping[str, xr.Variable]
) -> xr.Dataset:
    """Return a dataset with several dimensions in place of the rows of a table."""
    variables: dict[Hashable, xr.Variable] = {}
    for name, variable in runs.drop_vars([CASE, *labels], errors="ignore").variables.items():
        wide = variable.unstack({CASE: dict(sizes)}) if CASE in variable.dims else variable
        other_dims = [dim for dim in wide.dims if dim not in sizes]
        variables[name] = wide.transpose(*(dim for dim in sizes if dim in wide.dims), *other_dims)
    made = xr.Dataset(variables, attrs=runs.attrs)
    made = made.set_coords([name for name in runs.coords if name in variables])
    return with_labels(made, labels)


def read_line_axes(
    value: object,
    scene: SweptScene,
    *,
    owner: str,
    argument_names: Collection[str],
    own_axes: Sequence[Axis] = (),
) -> LineAxes:
    """Read the axes of an analysis; argument names are for proposals."""
    if value is None:
        return LineAxes()
    if not isinstance(value, Mapping):
        msg = f"{owner}: axes must be a mapping of names to values, got {short_repr(value)}"
        raise StudyError(msg)
    line_axes, faults = list[Axis](), list[str]()
    for name, values in cast("Mapping[Any, Any]", value).items():
        if name in SWEEP_ARGUMENT_NAMES:
            faults.append(f"{owner} takes no {name!r}, as rf.sweep does")
            continue
        try:
            line_axes.append(scene.axis(str(name), values))
        except RockframeError as problem:
            reasons = problem.faults if isinstance(problem, StudyError) else (str(problem),)
            argument = did_you_mean(name, argument_names)
            faults += [f"{why}{argument if argument not in why else ''}" for why in reasons]
    for axis in line_axes:
        if axis.changes is Changes.MOTION:
            advice = (
                "as scale does; give scale alone"
                if SCALE in argument_names
                else f"which {owner} runs as it is; scale the motion itself, motion.scaled(2)"
            )
            faults.append(f"axis {axis.name!r} scales the motion, {advice}")
        faults += faults_of_values(axis.name, axis.values)
    faults += scene.faults([*own_axes, *line_axes])
    if faults:
        raise StudyError(*faults)
    return LineAxes(tuple(line_axes))
