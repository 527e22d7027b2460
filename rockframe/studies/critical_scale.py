"""The critical scale: the least factor of a motion that overturns a block."""

import itertools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Final, Unpack

import numpy as np
import xarray as xr

from rockframe.arguments import checked_integer
from rockframe.components import InitialState
from rockframe.errors import ComponentError, SolverWarning, warn
from rockframe.motion import GroundMotion
from rockframe.results.forces import has_friction_limit
from rockframe.results.schema import build_dataset, with_variables
from rockframe.results.variables.studies import Outcome
from rockframe.shared_arguments import with_shared_arguments
from rockframe.signals.motion import extrema_of
from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.simulation.plan import Plan, plan_run
from rockframe.simulation.provenance import motion_attributes
from rockframe.simulation.run import NONE, compute_summary, run
from rockframe.simulation.run_arguments import ScaleArguments
from rockframe.simulation.soundness import STILL_MOVING
from rockframe.simulation.system import System, check_system
from rockframe.studies.flips import (
    ScaleScan,
    flips_sentence,
    least_overturning_scale,
    scan_scales,
    unfinished_words,
)
from rockframe.studies.intensities import ScaledIntensity, measure_attributes
from rockframe.studies.line_scan import read_resolution, read_width
from rockframe.studies.sweeps.execution import progress_bar
from rockframe.system.rigid_ground import RigidGroundSetting
from rockframe.units import POSITIVE, QuantityLike, RatioLike, to_ratio

_OWNER: Final = "critical_scale"
MOST_RUNS: Final = 1_000_000
_OUTCOMES: Final = {False: Outcome.STANDS, True: Outcome.OVERTURNS, None: Outcome.UNDECIDED}


@with_shared_arguments(ScaleArguments)
def critical_scale(
    system: System,
    motion: GroundMotion | None = None,
    *,
    largest: RatioLike = 4.0,
    scales: int = 80,
    runs: int = 400,
    resolution: RatioLike = 0.01,
    bracket_width: RatioLike = 1e-3,
    intensity: str | None = None,
    period: QuantityLike | None = None,
    damping_ratio: RatioLike = 0.05,
    progress: bool | None = None,
    **requested: Unpack[ScaleArguments],
) -> xr.Dataset:
    """Find the least factor of a ground motion that overturns a block, and every flip above.

    Parameters
    ----------
    system : System
        The scene.
    motion : GroundMotion, optional
        The motion to be scaled, both components alike. By default the motion among the parts.
    largest : float, optional
        Largest scale [1].
    scales : int, optional
        Number of equally spaced scales that are tried first.
    runs : int, optional
        Maximum number of runs of the scan, not counting those that narrow brackets. Runs beyond
        `scales` are spent on intervals in which flips may hide.
    resolution : float, optional
        Relative width, over the upper scale, down to which gaps between runs below the least scale
        that overturns are halved, as far as `runs` suffice [1].
    bracket_width : float, optional
        Width of a bracket, relative to its upper scale [1].
    intensity : str, optional
        Intensity measure whose value at the critical scale is returned: ``"PGA"`` and other
        abbreviations of :func:`rockframe.fragility`, or a name of
        :func:`rockframe.intensity_measures`, such as ``"peak_ground_acceleration"``, or of
        :func:`rockframe.response_spectrum`, such as ``"pseudo_spectral_acceleration"``.
    period : str or Quantity, optional
        Period of the oscillator of a spectral value [s].
    damping_ratio : float, optional
        Damping ratio of that oscillator, or of the spectra from which a measure is computed [1].
    progress : bool, optional
        Whether to show a progress bar (needs tqdm); by default only where it is visible. Its total
        grows beyond `scales` as intervals are halved.

    Returns
    -------
    xarray.Dataset
        Scalars: ``critical_scale``, the least scale found to overturn, NaN if none did;
        ``followed_scale``, up to which no gap between runs is wider than `resolution`;
        ``largest_gap``, the largest distance between neighbouring scales; ``uplift_scale``, up to
        which nothing happens on rigid ground [1]; and the intensity measure, by its name. Over
        ``flip``, for each change of the verdict: ``scale_below``, ``scale_above`` [1], and
        ``overturns_above``. Over ``scale``, for each run: ``outcome``, ``peak_rotation`` [rad] and
        ``status``. The attribute ``verdict`` is a summary in words.

    Raises
    ------
    UnitsError
        An argument has the wrong unit, or none.
    ComponentError
        The argument is no System, there is no motion to scale, a measure is unknown, or an argument
        is out of range.
    AssemblyError, SolverError
        As for :meth:`rockframe.System.simulate`.

    Warns
    -----
    SolverWarning
        Some runs could not be finished. They have no verdict, and count neither as standing nor as
        overturned. Warnings of the run at the critical scale are repeated; if a base has a
        coefficient of friction and nothing overturns, those of the run at the largest scale. Also
        warns after an interrupt (Ctrl-C): the result then covers the completed runs, up to
        ``followed_scale``.

    Notes
    -----
    Rocking is not monotone in the scale: above the critical scale the verdict may flip back many
    times. An even number of flips, and with them a smaller critical scale, may hide between two
    scales of the same verdict. Up to ``followed_scale`` all ranges of scales that overturn have
    been found, except ranges narrower than `resolution` times their upper end, and those that end
    below `resolution` times `largest`. After that, the criteria by which certificates search for
    flips (``rf.Certification``) select the intervals to be halved, first below the least scale that
    overturns, down to 0.2 % of the scale.

    A block at rest on rigid ground, without vertical motion, does not move before the peak ground
    acceleration exceeds g tan(theta), where the scan begins.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"))
    >>> pulse = rf.GroundMotion.half_sine_pulse("3 m/s^2", "1 s")
    >>> found = rf.critical_scale(system, pulse, free_vibration="10 s", scales=20)
    >>> round(float(found.critical_scale), 2)
    1.13
    """
    check_system(system, _OWNER)
    motion = system.motion if motion is None else motion
    if motion is None:
        msg = f"{_OWNER}: there is no motion to scale; give one"
        raise ComponentError(msg)
    greatest_scale = to_ratio(
        largest, owner=_OWNER, name="largest", condition=POSITIVE, example="4"
    )
    width = read_width(bracket_width, owner=_OWNER)
    finest = read_resolution(resolution, owner=_OWNER)
    count = checked_integer(scales, owner=_OWNER, name="scales", lowest=2, highest=MOST_RUNS)
    max_runs = checked_integer(runs, owner=_OWNER, name="runs", lowest=count, highest=MOST_RUNS)
    plan = plan_run(system.assembly, motion, outputs=None, **requested)
    if intensity is None and period is not None:
        msg = f"{_OWNER}: period is that of an intensity; give intensity too"
        raise ComponentError(msg)
    measure = None if intensity is None else ScaledIntensity(
        system, motion, intensity, period=period, damping_ratio=damping_ratio, owner=_OWNER
    )  # fmt: skip

    uplift_scale = _uplift_scale(system, plan)
    least = 0.0 if math.isnan(uplift_scale) else min(uplift_scale, greatest_scale)
    first_scales = np.unique(np.linspace(least, greatest_scale, count)).tolist()

    def plan_at(scale: float) -> Plan:
        return replace(plan, motion=motion.scaled(scale))

    # samples are needed here only for warnings of friction
    may_slide = has_friction_limit(system.assembly)
    step = plan.output_step if may_slide else None

    with progress_bar(progress, owner=_OWNER, unit="run") as bar:
        bar.expect(len(first_scales))
        run_numbers = itertools.count()

        def run_at(scale: float) -> RunSummary:
            number = next(run_numbers)
            if number == len(first_scales):
                bar.name("more scales")
            if number >= len(first_scales):
                bar.expect(1)
            shown = compute_summary(system.assembly, replace(plan_at(scale), output_step=step))
            bar.update(1)
            return shown

        scan = scan_scales(
            run_at,
            first_scales,
            max_runs=max_runs,
            width=width,
            resolution=finest,
            may_slide=may_slide,
        )
    critical = least_overturning_scale(scan.runs)
    text = flips_sentence(scan, width=width, resolution=finest)
    if not scan.completed:
        warn(f"{_OWNER}: interrupted; {text}", SolverWarning)
    attributes = {
        "verdict": text,
        "largest_scale": greatest_scale,
        "first_scales": count,
        "most_runs": max_runs,
        "resolution": finest,
        "bracket_width": width,
        "model": system.setting.model,
        "accuracy": plan.accuracy_name,
        **_cautions(system, plan_at, scan, critical),
        **motion_attributes(motion),
        "system_json": system.assembly.json,
        "run_json": plan.to_json(),
    }
    dataset = _scale_dataset(scan, critical, uplift_scale, attributes)
    if measure is None:
        return dataset
    dataset = dataset.assign({measure.name: measure.at_scale(critical)})
    return dataset.assign_attrs(measure_attributes(measure))


def _uplift_scale(system: System, plan: Plan) -> float:
    """Return the scale up to which a block at rest on rigid ground stays so; NaN otherwise."""
    setting, motion = system.setting, plan.motion
    if not isinstance(setting, RigidGroundSetting) or plan.initial != InitialState():
        return math.nan
    if motion is None or motion.si.vertical is not None:
        return math.nan
    pieces = motion.si.horizontal.pieces
    _, between = extrema_of(pieces)
    values = np.concatenate([pieces[:, 0], pieces.sum(axis=1), between])
    # ground that is accelerated to the right tips the block to the left
    peaks = float(values.max()), -float(values.min())
    scales = zip(setting.onset_accelerations, peaks, strict=True)
    return min((uplift / peak for uplift, peak in scales if peak > 0.0), default=math.inf)


def _cautions(
    system: System, plan_at: Callable[[float], Plan], scan: ScaleScan, critical: float
) -> dict[str, str]:
    """Repeat the warnings of the run at the decisive scale; warn of runs without a verdict."""
    cautions: list[str] = []
    if undecided := scan.undecided:
        cautions.append(f"{_OWNER}: {unfinished_words(undecided)}")
        warn(cautions[0], SolverWarning)
    moving = [scale for scale, outcome in scan.runs.items() if outcome.in_motion]
    if moving:
        cautions.append(
            f"{_OWNER}: at {len(moving)} of {len(scan.runs)} scales, such as {moving[0]:.4g}, "
            f"{STILL_MOVING}"
        )
        warn(cautions[-1], SolverWarning)
    # if none falls, the largest scale needs the most friction
    decisive = max(scan.runs) if math.isnan(critical) else critical
    if decisive == critical or has_friction_limit(system.assembly):
        repeated = run(system.assembly, plan_at(decisive))
        cautions += {repeated.attrs["cautions"]} - {NONE}
    return {"cautions": "; ".join(cautions)} if cautions else {}


def _scale_dataset(
    scan: ScaleScan, critical: float, uplift_scale: float, attributes: dict[str, str | float | int]
) -> xr.Dataset:
    flips, runs = scan.flips(), list(scan.runs.values())
    dataset = build_dataset(
        {
            "critical_scale": critical,
            "followed_scale": scan.resolved_up_to,
            "largest_gap": scan.largest_gap,
            "uplift_scale": uplift_scale,
            "scale_below": np.array([flip.below for flip in flips]),
            "scale_above": np.array([flip.above for flip in flips]),
            "overturns_above": np.array([flip.overturns_above for flip in flips], dtype=bool),
            "scale": np.array(list(scan.runs)),
            "outcome": np.array([_OUTCOMES[outcome.overturned] for outcome in runs]),
        },
        attributes,
        title="Critical scale of a ground motion",
        source="scan and bisection of event-driven runs",
    )
    of_runs = {
        "peak_rotation": np.array([outcome.peak for outcome in runs]) + 0.0,  # no negative zeros
        "status": np.array([outcome.status for outcome in runs]),
    }
    return with_variables(dataset, of_runs, over=("scale",))
