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
from rockframe.results.schema import build_dataset, with_variables
from rockframe.results.variables.studies import Outcome
from rockframe.shared_arguments import with_shared_arguments
from rockframe.signals.motion import turning_points
from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.simulation.plan import Plan, plan_run
from rockframe.simulation.provenance import motion_attributes
from rockframe.simulation.run import run, summary_of
from rockframe.simulation.run_arguments import ScaleArguments
from rockframe.simulation.soundness import STILL_MOVING, has_limit
from rockframe.simulation.system import System, check_system
from rockframe.studies.flips import Followed, flips_sentence, follow, least_overturning, unfinished
from rockframe.studies.intensities import ScaledIntensity, of_study
from rockframe.studies.lines import read_resolution, read_width
from rockframe.studies.sweeps.execution import bar_of
from rockframe.system.rigid_ground import RigidGroundSetting
from rockframe.units import POSITIVE, QuantityLike, RatioLike, to_ratio

_OWNER: Final = "critical_scale"
MOST_RUNS: Final = 1_000_000
_OUTCOMES: Final = {
    False: Outcome.STANDS, True: Outcome.OVERTURNS, None: Outcome.UNDECIDED,
}  # fmt: skip


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
    share = read_width(bracket_width, owner=_OWNER)
    finest = read_resolution(resolution, owner=_OWNER)
    count = checked_integer(scales, owner=_OWNER, name="scales", lowest=2, highest=MOST_RUNS)
    most = checked_integer(runs, owner=_OWNER, name="runs", lowest=count, highest=MOST_RUNS)
    plan = plan_run(system.assembly, motion, outputs=None, **requested)
    measure = None
    if intensity is not None:
        measure = ScaledIntensity(
            system, motion, intensity, period=period, damping_ratio=damping_ratio, owner=_OWNER
        )
    elif period is not None:
        msg = f"{_OWNER}: period is that of an intensity; give intensity too"
        raise ComponentError(msg)

    at_rest_to = _uplift_scale(system, plan)
    least = 0.0 if math.isnan(at_rest_to) else min(at_rest_to, greatest_scale)
    row = np.unique(np.linspace(least, greatest_scale, count)).tolist()

    def plan_at(scale: float) -> Plan:
        return replace(plan, motion=motion.scaled(scale))

    # samples are needed here only for warnings of friction
    rubs = has_limit(system.assembly)
    step = plan.output_step if rubs else None

    with bar_of(progress, owner=_OWNER, unit="run") as bar:
        bar.expect(len(row))
        looks = itertools.count()

        def look(scale: float) -> RunSummary:
            number = next(looks)
            if number == len(row):
                bar.name("more scales")
            if number >= len(row):
                bar.expect(1)
            shown = summary_of(system.assembly, replace(plan_at(scale), output_step=step))
            bar.update(1)
            return shown

        found = follow(look, row, most=most, width=share, resolution=finest, may_slide=rubs)
    critical = least_overturning(found.shown)
    text = flips_sentence(found, width=share, resolution=finest)
    if not found.whole:
        warn(f"{_OWNER}: interrupted; {text}", SolverWarning)
    attributes = {
        "verdict": text,
        "largest_scale": greatest_scale,
        "first_scales": count,
        "most_runs": most,
        "resolution": finest,
        "bracket_width": share,
        "model": system.setting.model,
        "accuracy": plan.accuracy_name,
        **_cautions(system, plan_at, found, critical),
        **motion_attributes(motion),
        "system_json": system.assembly.json,
        "run_json": plan.to_json(),
    }
    dataset = _labelled(found, critical, at_rest_to, attributes)
    if measure is None:
        return dataset
    dataset = dataset.assign({measure.name: measure.at(critical)})
    return dataset.assign_attrs(of_study(measure.name, measure.period))


def _uplift_scale(system: System, plan: Plan) -> float:
    """Return the scale up to which a block at rest on rigid ground stays so; NaN otherwise."""
    setting, motion = system.setting, plan.motion
    if not isinstance(setting, RigidGroundSetting) or plan.initial != InitialState():
        return math.nan
    if motion is None or motion.si.vertical is not None:
        return math.nan
    pieces = motion.si.horizontal.pieces
    _, between = turning_points(pieces)
    values = np.concatenate([pieces[:, 0], pieces.sum(axis=1), between])
    # ground that is accelerated to the right tips the block to the left
    peaks = float(values.max()), -float(values.min())
    scales = zip(setting.moving_accelerations, peaks, strict=True)
    return min((uplift / peak for uplift, peak in scales if peak > 0.0), default=math.inf)


def _cautions(
    system: System, plan_at: Callable[[float], Plan], found: Followed, critical: float
) -> dict[str, str]:
    """Repeat the warnings of the run at the decisive scale; warn of runs without a verdict."""
    cautions: list[str] = []
    undecided = [scale for scale, shown in found.shown.items() if shown.overturned is None]
    if undecided:
        cautions.append(f"{_OWNER}: {unfinished(undecided)}")
        warn(cautions[0], SolverWarning)
    moving = [scale for scale, shown in found.shown.items() if shown.in_motion]
    if moving:
        cautions.append(
            f"{_OWNER}: at {len(moving)} of {len(found.shown)} scales, such as {moving[0]:.4g}, "
            f"{STILL_MOVING}"
        )
        warn(cautions[-1], SolverWarning)
    telling = critical
    if math.isnan(critical) and has_limit(system.assembly):
        telling = max(found.shown)  # if none falls, it needs the most friction
    if not math.isnan(telling):
        again = run(system.assembly, plan_at(telling))
        cautions += filter(None, [str(again.attrs.get("cautions", ""))])
    return {"cautions": "; ".join(cautions)} if cautions else {}


def _labelled(
    found: Followed, critical: float, at_rest_to: float, attributes: dict[str, str | float | int]
) -> xr.Dataset:
    flips, shown = found.flips(), list(found.shown.values())
    dataset = build_dataset(
        {
            "critical_scale": critical,
            "followed_scale": found.up_to,
            "largest_gap": found.largest_gap,
            "uplift_scale": at_rest_to,
            "scale_below": np.array([flip.below for flip in flips]),
            "scale_above": np.array([flip.above for flip in flips]),
            "overturns_above": np.array([flip.overturns_above for flip in flips], dtype=bool),
            "scale": np.array(list(found.shown)),
            "outcome": np.array([_OUTCOMES[one.overturned] for one in shown]),
        },
        attributes,
        title="Critical scale of a ground motion",
        source="scan and bisection of event-driven runs",
    )
    of_runs = {
        "peak_rotation": np.array([one.peak for one in shown]) + 0.0,  # no negative zeros
        "status": np.array([one.status for one in shown]),
    }
    return with_variables(dataset, of_runs, over=("scale",))
