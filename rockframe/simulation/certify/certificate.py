"""The certificate of a run: how sure its verdict is, in numbers and words.

It follows from runs of higher accuracy than the run itself ("finer"), from runs with slightly
changed ("nudged") parameters, and from runs with a scaled motion.
"""

import math
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rockframe.errors import ModelWarning, RockframeError, SolverError
from rockframe.simulation.certify.perturbations import (
    SHORTER,
    SceneAt,
    finer_plans,
    parameters,
    scaled_plan,
    scales,
    tolerance_words,
)
from rockframe.simulation.certify.run_summary import Run, RunSummary
from rockframe.simulation.certify.scan import NOT_TRIED, Scan, scan
from rockframe.simulation.plan import Plan
from rockframe.simulation.run_arguments import Certification
from rockframe.solve.accuracy import FEWEST
from rockframe.system.assembly import Assembly

SAFETY: Final = 3.0
"""Estimated error of a run, over its largest difference from a run of higher accuracy."""
RESOLUTION: Final = 0.004
"""Length of an interval of scales, over its distance from 1, below which it is not divided."""
NUDGE_RESOLUTION: Final = 0.06
"""Length of an interval of values of a parameter, over its distance from the parameter's own."""
FIRST_NUDGES: Final = (0.5, 1.0)
"""First changes of a parameter, as shares of the nudge."""
RUNS_PER_PARAMETER: Final = (4, 14)
"""Smallest and largest number of runs for one parameter."""
PARAMETER_SHARE: Final = 0.6
"""Largest share of all further runs that change parameters."""


@dataclass(frozen=True)
class Certificate:
    """A run and its further runs; without any if the run was not finished."""

    certification: Certification  # the further runs to make
    plan: Plan  # the run's arguments
    base: RunSummary  # the run
    finer: Sequence[tuple[str, RunSummary]] = ()  # runs of higher accuracy, each with what is finer
    nudged: Sequence[tuple[str, Scan]] = ()  # runs with a parameter changed, by its name
    along: Scan = NOT_TRIED  # runs with a scaled motion or start

    @property
    def finished(self) -> bool:
        """Whether the run has a verdict."""
        return self.base.overturned is not None

    @property
    def converged(self) -> bool:
        """Whether runs of higher accuracy have the same verdict, with a margin above the error."""
        return self.finished and all(confirms_verdict(self.base, other) for _, other in self.finer)

    @property
    def robust(self) -> bool:
        """Whether no change of a parameter or the scale up to the nudge has another verdict.

        Changes between those that were tried must be unlikely to have one, too.
        """
        followed = all(scan.flip is None and scan.followed for _, scan in self.nudged)
        least = min(self.certification.nudge, self.certification.reach)
        return self.finished and followed and not self.margin < least

    @property
    def margin(self) -> float:
        """Largest change of scale up to which no other verdict was found; NaN without runs [1]."""
        return self.along.margin if self.along.tried else math.nan

    @property
    def flip(self) -> float:
        """Scale nearest to 1 that was found to change the verdict; NaN if none [1]."""
        return math.nan if self.along.flip is None else 1.0 + self.along.flip

    @property
    def peak_error(self) -> float:
        """Largest difference of peaks from runs of higher accuracy, times a safety factor [rad]."""
        return SAFETY * self._largest_peak_difference([other for _, other in self.finer])

    @property
    def peak_sensitivity(self) -> float:
        """Largest difference of peak rotations with a nudged parameter [rad]."""
        return self._largest_peak_difference(
            [shown for _, found in self.nudged for shown in found.tried.values()]
        )

    def _largest_peak_difference(self, others: list[RunSummary]) -> float:
        """Return the largest difference of peak rotations; NaN if a run was not finished [rad]."""
        apart = [
            math.nan if summary.overturned is None else abs(summary.peak - self.base.peak)
            for summary in (self.base, *others)
        ]
        return float(np.max(apart))

    @property
    def runs(self) -> int:
        """Number of further runs."""
        return len(self.finer) + _number_of_runs(self.nudged) + len(self.along.tried)

    @property
    def sentence(self) -> str:
        """Which further runs were made and what they showed, in words."""
        if not self.finished:
            return "No certificate: the run was not finished."
        verdict = _verdict_words(self, self.base.overturned)
        near, flip = _scale_doubts(self), _nearest_flip_words(self)
        doubts = [*_accuracy_doubts(self), *_parameter_doubts(self), *near]
        if doubts:
            text = f"{NEAR_WORDS}: the body {verdict}, but {'; '.join(doubts)}."
            near_scale = near and _flip_is_near(self)
            return text if near_scale or not flip else f"{text} {flip.capitalize()}."
        means = [tolerance_words(self.plan.accuracy), f"steps {SHORTER:g} times shorter"]
        if self.plan.motion is not None:
            means.append("the intervals of the motion divided")
        body = "The body"
        if self.base.in_motion:
            body = "To the end of the run, where it can still overturn, the body"
        text = (
            f"{body} {verdict} also with {', '.join(means[:-1])} and {means[-1]}, and with "
            f"every parameter up to {100.0 * self.certification.nudge:g} % larger or smaller"
        )
        scales = "; ".join(filter(None, [_scanned_range_words(self), flip]))
        return f"{text}. {scales}." if scales else f"{text}."

    def values(self) -> dict[str, float | bool]:
        """Return the scalars by their names in the schema."""
        return {
            "verdict_converged": self.converged,
            "verdict_robust": self.robust,
            "verdict_margin": self.margin,
            "verdict_flip_scale": self.flip,
            "peak_error_estimate": self.peak_error,
            "peak_sensitivity": self.peak_sensitivity,
        }

    def attributes(self) -> dict[str, str | float | int]:
        """Return the attributes of a dataset that describe the certificate."""
        return {
            "certificate": self.sentence,
            "certificate_nudge": self.certification.nudge,
            "certificate_reach": self.certification.reach,
            "certificate_resolution": RESOLUTION,
            "certificate_runs": self.runs,
        }


def certify(
    system: Assembly, plan: Plan, base: RunSummary, certification: Certification, run: Run
) -> Certificate:
    """Make the certificate of a run."""
    if base.overturned is None:
        return Certificate(certification, plan, base)
    bare, limits = plan.without_outputs(), system.setting.overturning_angles

    def scaled(change: float) -> RunSummary | None:
        """Make the run with a scaled motion or, without one, with a scaled start."""
        other = scaled_plan(bare, 1.0 + change, limits)
        return None if other is None else run(system, other)

    with warnings.catch_warnings():
        # the run itself has given them
        warnings.simplefilter("ignore", ModelWarning)
        finer = [
            (words, run(system, other)) for words, other in finer_plans(system, bare, base.step)
        ]
        nudged = _nudged(system, bare, base, certification, run)
        most = max(
            certification.runs - len(finer) - _number_of_runs(nudged), certification.runs // 4
        )
        row = scales(certification.nudge, certification.reach)
        along = scan(scaled, base, row, most=most, resolution=RESOLUTION)
    return Certificate(certification, plan, base, finer, nudged, along)


def _nudged(
    system: Assembly, plan: Plan, base: RunSummary, certification: Certification, run: Run
) -> list[tuple[str, Scan]]:
    """Change every parameter up and down, at the nudge and inside it."""
    every = list(parameters(system))
    fewest, most = RUNS_PER_PARAMETER
    share = int(PARAMETER_SHARE * certification.runs) // max(len(every), 1)
    row = [share * certification.nudge for share in FIRST_NUDGES]
    count = min(max(share, fewest), most)

    def along(scene_at: SceneAt) -> Scan:
        def look(change: float) -> RunSummary | None:
            scene = scene_at(change)
            return None if scene is None else _perturbed_run(scene, plan, run)

        return scan(look, base, row, most=count, resolution=NUDGE_RESOLUTION, refine_flip=False)

    return [(words, along(scene_at)) for words, scene_at in every]


def _perturbed_run(system: Assembly, plan: Plan, run: Run) -> RunSummary | None:
    """Run a nudged scene, with more sub-steps where the given number is too small for it."""
    try:
        return run(system, plan)
    except SolverError:
        return run(system, replace(plan, accuracy=replace(plan.accuracy, substeps=FEWEST)))
    except RockframeError:  # the start does not fit the nudged scene
        return None


def confirms_verdict(base: RunSummary, finer: RunSummary) -> bool:
    """Whether a run of higher accuracy has the same verdict, with a margin above the error."""
    if not base.alike(finer):
        return False
    pairs = zip(base.clearances, finer.clearances, strict=True)
    return all(SAFETY * abs(a - b) < a for a, b in pairs)


def _number_of_runs(nudged: Sequence[tuple[str, Scan]]) -> int:
    return sum(len(found.tried) for _, found in nudged)


NEAR: Final = 0.01
"""Margin up to which a verdict is called near the boundary [1]."""
NEAR_WORDS: Final = "Near the boundary"
"""Beginning of the sentence about such a verdict."""


def _verdict_words(found: Certificate, overturned: bool | None) -> str:
    """Say how a run ends, with overturning as the run's arguments define it."""
    if found.plan.stop_at_overturning:
        return "overturns" if overturned else "stands"
    return "falls flat" if overturned else "does not fall flat"


def _ending(found: Certificate, shown: RunSummary) -> str:
    """Say how a further run ended."""
    if shown.overturned is None:
        return "the run cannot be finished"
    return f"it {_verdict_words(found, shown.overturned)}"


def _accuracy_doubts(found: Certificate) -> Iterator[str]:
    """Say which runs of higher accuracy have another verdict, or come too near to another one."""
    if found.converged:
        return
    verdict = found.base.overturned
    others = [(words, other) for words, other in found.finer if other.overturned != verdict]
    if others:
        words, other = others[0]
        yield f"with {words}{_and_more(others)} {_ending(found, other)}"
    elif not found.base.within_the_angle:
        flat = "fall flat" if verdict else "come back"
        ends = "overturn" if found.plan.stop_at_overturning else flat
        yield f"runs of higher accuracy {ends} in another way, or only just"
    else:
        yield (
            f"its peak rotation is uncertain by {found.peak_error:.2g} rad, about "
            "what is left to overturning"
        )


def _parameter_doubts(found: Certificate) -> Iterator[str]:
    """Say which parameters change the verdict."""
    changed = [(words, scan) for words, scan in found.nudged if scan.flip is not None]
    if changed:
        words, scan = changed[0]
        flip, ended = scan.flip or 0.0, scan.ended or found.base
        yield f"with the {words} {100.0 * flip:+.3g} %{_and_more(changed)} {_ending(found, ended)}"
        return
    lost = [words for words, scan in found.nudged if not scan.followed]
    if lost:
        yield f"the dependence of the verdict on the {lost[0]}{_and_more(lost)} was not resolved"


def _scale_doubts(found: Certificate) -> list[str]:
    """Say that a slightly different scale changes the verdict, or may change it."""
    margin, along, what = found.margin, found.along, _excitation(found.plan)
    if not margin <= _near_margin(found) or (along.followed and along.flip is None):
        return []
    if along.ended is not None and _flip_is_near(found):
        change = found.flip - 1.0
        way = "up" if change > 0.0 else "down"
        return [
            f"with {what} scaled {way} by {_percent(abs(change))} {_ending(found, along.ended)}"
        ]
    return [
        f"{found.certification.runs} runs were too few to resolve the dependence of the verdict on "
        f"the scale of {what} beyond {_percent(margin)}"
    ]


def _near_margin(certificate: Certificate) -> float:
    """Return the change of scale up to which a flip is near."""
    return max(NEAR, certificate.certification.nudge)


def _flip_is_near(certificate: Certificate) -> bool:
    """Whether the known change of the verdict is at a scale near to 1."""
    return abs(certificate.flip - 1.0) <= 2.0 * _near_margin(certificate)


def _scanned_range_words(certificate: Certificate) -> str:
    """Say at which scales no other verdict was found; empty where none was tried."""
    margin, along, what = certificate.margin, certificate.along, _excitation(certificate.plan)
    if math.isnan(margin):
        return ""
    low, high = (f"{1.0 + sign * margin:.6g}" for sign in (-1.0, 1.0))
    text = (
        f"No other verdict was found at the {along.within(margin)} scales of {what} tried from "
        f"{low} to {high}"
    )
    lost = f"; {certificate.certification.runs} runs were too few to extend this range"
    return text if along.followed else f"{text}{lost}"


def _nearest_flip_words(certificate: Certificate) -> str:
    """Say which is the nearest scale with another verdict; empty where none is known."""
    flip = certificate.flip
    if math.isnan(flip):
        return ""
    return (
        f"the nearest scale of {_excitation(certificate.plan)} with another verdict is {flip:.6g}"
    )


def _percent(change: float) -> str:
    return f"{100.0 * change:.3g} %"


def _and_more(all_of: Sequence[object]) -> str:
    return f" (and {len(all_of) - 1} more)" if len(all_of) > 1 else ""


def _excitation(plan: Plan) -> str:
    return "the motion" if plan.motion is not None else "the start"
