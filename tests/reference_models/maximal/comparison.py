"""Compare both programs scene by scene."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

import rockframe as rf

from .layout import (
    BED_SETTLEMENT,
    CHATTER,
    ENGAGING,
    FREE,
    LEAVING,
    OVERTURNED,
    RELAXING,
    SETTLEMENT,
    SLIDES,
    TOO_SMALL,
)
from .motions import build_motions
from .program import TIGHT, rows_at, run_program, scaled_start
from .random_scenes import draw
from .scene import Scene, parameters
from .simulate import TOLERANCE, History, simulate


@dataclass(frozen=True)
class Level:
    """An accuracy of rockframe and the agreement required of it.

    `agrees` is the largest difference over the peak that counts as agreement. `changes` are
    relative changes of the motion that reveal chaos and sensitivity: as large as the errors of a
    few steps and of some hundred steps; None compares verdicts and peaks only. With each of the
    `tighter` tolerances a difference that comes from errors of steps shrinks to a third or less.
    """

    accuracy: rf.Accuracy | str
    agrees: float
    changes: tuple[float, float] | None
    tighter: tuple[rf.Accuracy, ...] = ()


LEVELS = {
    "tight": Level(TIGHT, 1e-6, (1e-10, 1e-9)),
    "standard": Level(
        "standard", 1e-5, (1e-7, 1e-6), (rf.Accuracy(rtol=2e-9), rf.Accuracy(rtol=2e-10))
    ),
    "fast": Level("fast", 5e-2, None),
}


@dataclass
class Outcome:
    """The differences between both programs in one scene at one accuracy."""

    kind: str
    seed: int
    number: int
    level: str
    label: str
    difference: float
    rise_difference: float
    peak: float
    peak_difference: float
    overturned: tuple[bool, bool]
    status: tuple[int, int]
    growth: tuple[float, ...] = ()
    first: float = -1.0
    note: str = ""
    seen: tuple[str, ...] = ()
    told: bool = False
    """Whether rockframe reports verdict or peak as unsure."""

    def plain(self) -> dict:
        """Return plain values."""
        return asdict(self)


def run_reference(scene: Scene, factor: float = 1.0, tolerance: float = TOLERANCE) -> History:
    """Run the scene with the reference model; `factor` multiplies motion and start."""
    return simulate(scaled_start(scene, factor), build_motions(scene.motion, factor)[1], tolerance)


def differences(history: History, run, scene: Scene) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times and differences of rotation and rise over their greatest values."""
    rows = rows_at(history.time, run)
    # a run that overturned has stopped between two output times
    common = rows >= 0
    common[-1] &= history.status != OVERTURNED or common.sum() < 2
    rows, t = rows[common], history.time[common]
    rotation, rise = history.rotation[common], history.rise[common]
    peak = max(np.max(np.abs(history.rotation)), 1e-9)
    off = np.abs(run.rotation.values[rows] - rotation) / peak
    if scene.kind == "rigid" and scene.small:
        return t, off, np.zeros_like(off)
    p = parameters(scene, TOLERANCE)
    scale = max(np.max(np.abs(history.rise)), p[SETTLEMENT], p[BED_SETTLEMENT], 1e-9)
    return t, off, np.abs(run.vertical_displacement.values[rows] - rise) / scale


def states_seen(history: History, scene: Scene) -> tuple[str, ...]:
    """Return the rarer contact states of a run."""
    states = set()
    pads = scene.kind in ("pads", "cascade", "coupled")
    for code in history.events[:, 3]:
        soil, ends, block, corners = _digits(code)
        if pads:
            states |= {_CORNERS[c] for c in corners if c in _CORNERS}
        if block == FREE and pads:
            states.add("flight")
        if soil == FREE and scene.kind in ("bed", "cascade", "coupled"):
            states.add("soil flight")
        if SLIDES in ends:
            states.add("soil sliding")
    return tuple(sorted(states))


_CORNERS = {RELAXING: "relaxing", LEAVING: "leaving", ENGAGING: "engaging", SLIDES: "sliding"}


def _digits(code: float) -> tuple[int, tuple[int, ...], int, tuple[int, ...]]:
    digits = [int(d) for d in f"{int(code):08d}"]
    return digits[0], tuple(digits[1:3]), digits[3], tuple(digits[4:6])


def compare(
    kind: str,
    seed: int,
    number: int,
    variant: str = "plain",
    levels: Sequence[str] = ("tight",),
    agrees: float | None = None,
) -> list[Outcome]:
    """Run a random scene with both programs and judge differences that exceed a limit.

    The limit is that of the level unless `agrees` states another.
    """
    scene = draw(kind, seed, number, variant)
    history = run_reference(scene)
    return [_compare(scene, history, (kind, seed, number), level, agrees) for level in levels]


def _compare(scene: Scene, history: History, which, name: str, agrees: float | None) -> Outcome:
    level = LEVELS[name] if agrees is None else replace(LEVELS[name], agrees=agrees)
    run = run_program(scene, accuracy=level.accuracy)
    t, off, rise = differences(history, run, scene)
    worst, worst_rise = float(np.max(off)), float(np.max(rise))
    peak = float(np.max(np.abs(history.rotation)))
    common = np.isin(history.time, t)
    ours = np.max(np.abs(run.rotation.values[rows_at(t, run)]))
    theirs = np.max(np.abs(history.rotation[common]))
    outcome = Outcome(
        *which,
        name,
        "agrees",
        worst,
        worst_rise,
        peak,
        float(abs(ours - theirs) / max(theirs, 1e-9)),
        (bool(run.overturned), history.status == OVERTURNED),
        (int(run.status), int(history.status)),
        told="not sure" in run.attrs.get("cautions", ""),
    )
    outcome.seen = states_seen(history, scene)
    if history.status in (CHATTER, TOO_SMALL):
        outcome.note = "the reference model did not finish"
    same = outcome.overturned[0] == outcome.overturned[1]
    if same and max(worst, worst_rise) <= level.agrees and not outcome.note:
        return outcome
    total = np.maximum(off, rise)
    beyond = np.flatnonzero(total > level.agrees)
    outcome.first = float(t[beyond[0]]) if beyond.size else float(t[-1])
    if level.changes is None:
        outcome.label = "apart"
    else:
        _judge(scene, outcome, t, total, history, level)
    return outcome


def _judge(scene: Scene, outcome: Outcome, t, total, history, level: Level) -> None:
    """Distinguish chaos from disagreement by the effect of a tiny change of the motion."""
    growth, spread = [], []
    tight = run_program(scene)
    for size in level.changes:
        other, again = run_reference(scene, 1.0 + size), run_program(scene, 1.0 + size)
        ours = _history_differences(history, other, t)
        theirs = _run_differences(tight, again, t, outcome.peak)
        grown = np.maximum.accumulate(np.maximum(ours, theirs))
        spread.append(grown)
        growth.append(float(grown[-1] / size))
        growth.append(float(np.max(ours)))
        growth.append(float(np.max(theirs)))
    outcome.growth = tuple(growth)
    beyond = total > level.agrees
    if not np.any(beyond):
        last = [float(s[-1]) for s in spread]
        outcome.label = "chaos" if max(last) > level.agrees else "disagrees"
    elif np.all(total[beyond] <= 3.0 * spread[0][beyond]):
        outcome.label = "chaos"
    elif np.all(total[beyond] <= 3.0 * spread[1][beyond]):
        outcome.label = "sensitive"
    else:
        outcome.label = "by tolerance" if _shrinks(scene, outcome, history, level) else "disagrees"


def _shrinks(scene: Scene, outcome: Outcome, history, level: Level) -> bool:
    """Tell whether a difference shrinks with the tolerance."""
    last = max(outcome.difference, outcome.rise_difference)
    for accuracy in level.tighter:
        _, off, rise = differences(history, run_program(scene, accuracy=accuracy), scene)
        difference = max(float(np.max(off)), float(np.max(rise)))
        if difference > last / 3.0:
            return False
        last = difference
    return bool(level.tighter)


def _history_differences(history: History, other: History, t: np.ndarray) -> np.ndarray:
    n = t.size
    peak = max(np.max(np.abs(history.rotation)), 1e-9)
    rise = max(np.max(np.abs(history.rise)), 1e-12)
    off = np.zeros(n)
    m = min(n, len(other.time))
    off[:m] = np.abs(other.rotation[:m] - history.rotation[:m]) / peak
    off[:m] = np.maximum(off[:m], np.abs(other.rise[:m] - history.rise[:m]) / rise)
    off[m:] = 1.0
    return off


def _run_differences(run, other, t: np.ndarray, peak: float) -> np.ndarray:
    first, second = rows_at(t, run), rows_at(t, other)
    common = (first >= 0) & (second >= 0)
    off = np.where(common, 0.0, 1.0)
    first, second = first[common], second[common]
    rise = max(float(np.max(np.abs(run.vertical_displacement.values))), 1e-12)
    off[common] = np.maximum(
        np.abs(other.rotation.values[second] - run.rotation.values[first]) / max(peak, 1e-9),
        np.abs(other.vertical_displacement.values[second] - run.vertical_displacement.values[first])
        / rise,
    )
    return off
