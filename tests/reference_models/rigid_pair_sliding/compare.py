"""Compare rockframe's two sliding rigid blocks with the reference model in random scenes.

python tests/reference_models/rigid_pair_sliding/compare.py --scenes 100 --seed 7
python tests/reference_models/rigid_pair_sliding/compare.py --seed 7 --replay 17
"""

import argparse
import json
import math
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve()
if __package__ in (None, ""):
    sys.path.insert(0, str(HERE.parents[2]))
    sys.path.append(str(HERE.parents[3]))

from reference_models.monoliths.slipping_block import Bed, Pads  # noqa: E402
from reference_models.rigid_pair import compare as held  # noqa: E402
from reference_models.rigid_pair_sliding.contacts import INTERFACES  # noqa: E402
from reference_models.rigid_pair_sliding.events import Event, OffTheTopError, Run  # noqa: E402
from reference_models.rigid_pair_sliding.random_scenes import (  # noqa: E402
    FREE,
    STEP,
    Scene,
    draw,
    draw_compliant,
)
from reference_models.rigid_pair_sliding.simulate import simulate  # noqa: E402

import rockframe as rf  # noqa: E402
from rockframe.dynamics.events import EventKind  # noqa: E402

OUTPUT = 0.01
"""Output step of the compared histories [s]."""
KINDS = {
    "uplift": "UPLIFT", "flight": "SEPARATION", "impact": "IMPACT", "rest": "REST", "slip": "SLIP",
    "stick": "STICK", "reversal": "SLIP_REVERSAL", "overturning": "OVERTURNING",
}  # fmt: skip
BODIES = {"ground": 2, "joint": 1, "lower": 2, "upper": 1}
"""The package counts bodies from the top."""
SOON, TOGETHER = 1e-9, 1e-6
"""Largest time between events of one instant, and between those of both programs [s]."""
SLIGHT = 1e-6
"""Impacts that lose less than this share of the greatest loss are not counted."""


@dataclass(frozen=True)
class Compared:
    """Both runs, up to the end of the shorter one or of unique motion.

    ``rotation`` is the largest difference over the largest rotation, ``slip`` that of slips over
    the largest slip; ``ours`` and ``theirs`` are the instants with their changes,
    ``ours`` without impacts that lose less than a millionth of the greatest loss.
    """

    reference: Run
    package: Any  # the dataset
    until: float
    rotation: float
    slip: float
    ours: list
    all_ours: list
    theirs: list
    off: bool  # the reference ended because the upper base left the top

    @property
    def same_verdict(self) -> bool:
        """Whether both overturn or neither does, or the reference ended early."""
        return self.off or bool(self.package["overturned"]) == self.reference.overturned

    @property
    def missing(self) -> list:
        """Changes of the reference that the package lacks at that time."""
        return [one for one in self.ours if not _changes_at(self.theirs, one)]

    @property
    def added(self) -> list:
        """Changes of the package that the reference lacks."""
        return [one for one in self.theirs if not _changes_at(self.all_ours, one)]

    @property
    def renamed(self) -> list:
        """Instants of both whose changes have no name in common."""
        both = [(one, _changes_at(self.theirs, one)) for one in self.ours]
        return [(*one, what) for one, what in both if what and not what & one[1]]


def _changes_at(instants: list, wanted) -> set:
    """Return all changes at a time."""
    return set().union(*(what for t, what in instants if abs(t - wanted[0]) < TOGETHER))


def ground_of(scene: Scene, key: str) -> Any:
    """Return the package's interface."""
    friction = scene.frictions[key]
    if key in scene.bases:
        arguments = {"friction": friction.static, "kinetic_friction": friction.kinetic}
        arguments |= scene.bases[key]
        return (rf.WinklerSoil if "stiffness" in arguments else rf.TwoSpringSupport)(**arguments)
    if friction.holds:
        return rf.RigidGround()
    return rf.RigidGround(
        friction=friction.static, kinetic_friction=friction.kinetic,
        impact="stick" if friction.stick else "coulomb",
    )  # fmt: skip


def system_of(scene: Scene) -> rf.System:
    """Return the package's scene."""
    pair = scene.pair
    stack = rf.Stack(
        held.block_of(pair.upper), held.block_of(pair.lower),
        interfaces=[ground_of(scene, "joint")], offsets=[f"{pair.offset!r} m"],
    )  # fmt: skip
    return rf.System(stack, ground_of(scene, "ground"), restraint=scene.rule)


def compliant_bases_of(scene: Scene, system: rf.System) -> dict[str, Any]:
    """Return the reference model's arguments for compliant bases."""
    pair, options = scene.pair, {}
    for key in scene.bases:
        support = system.setting.bases[BODIES[key] - 1]
        mass = pair.upper.mass + (pair.lower.mass if key == "ground" else 0.0)
        if "stiffness" in scene.bases[key]:
            width = 2.0 * (pair.lower if key == "ground" else pair.upper).half_width
            base = Bed(support.stiffness, support.damping, width)
            stiffness = width * support.stiffness
        else:
            base, stiffness = Pads(support.stiffness, support.damping, 1.0), 2.0 * support.stiffness
        base.sunk = mass * pair.gravity / stiffness
        options |= {"compliant": {key: base}, "rule": scene.rule}
        options["quickest"] = 12.0 * math.sqrt(pair.upper.mass / stiffness)
    return options


def motion_of(motion: dict[str, Any]) -> rf.GroundMotion:
    """Return the package's ground motion."""
    if motion["form"] != "noise":
        return held.motion_of(motion)
    vertical = {"vertical": (motion["up"], "m/s^2")} if any(motion["up"]) else {}
    return rf.GroundMotion.from_arrays((motion["across"], "m/s^2"), f"{STEP!r} s", **vertical)


def instants(events, until: float) -> list:
    """Group events, as pairs of time and change, by instants before a time."""
    gathered: list = []
    for time, what in events:
        if time > until:
            break
        if gathered and time - gathered[-1][0] < SOON:
            gathered[-1][1].add(what)
        else:
            gathered.append((time, {what}))
    return gathered


def changes_of(event: Event) -> list:
    """Return kind and body of an event, with all simultaneous changes."""
    changes = [(KINDS[event.kind], BODIES[key]) for key in event.where.split("+")]
    if event.kind == "overturning":
        return [("OVERTURNING", body) for body in (1, 2)]  # both may, at once
    for key, before, after in zip(INTERFACES, event.before, event.after, strict=True):
        if set(before.ends) - set(after.ends):
            changes.append(("UPLIFT" if after.ends else "SEPARATION", BODIES[key]))
        if after.ends and before.slip != after.slip:
            kind = "STICK" if not after.slip else "SLIP_REVERSAL" if before.slip else "SLIP"
            changes.append((kind, BODIES[key]))
    return changes


def compare_scene(scene: Scene, accuracy: str = "reference") -> Compared:
    """Run a scene by both programs."""
    off, system = False, system_of(scene)
    try:
        reference = simulate(scene, OUTPUT, **compliant_bases_of(scene, system))
    except OffTheTopError as fault:
        reference, off = fault.run, True
    package = system.simulate(
        motion_of(scene.motion), free_vibration=f"{FREE!r} s", accuracy=accuracy,
        output_step=f"{OUTPUT!r} s",
    )  # fmt: skip
    until = min(np.nextafter(reference.unique_until, 0.0), reference.end + TOGETHER)
    count = min(len(reference.time), package.sizes["time"])
    within = reference.time[:count] < until
    differences = []
    for ours, name in ((reference.rotation, "body_rotation"), (reference.slip, "body_slip")):
        if name not in package:  # nothing slips in the package's scene
            differences.append(float(np.max(np.abs(ours), initial=0.0)))
            continue
        ours = ours[:count, ::-1][within]
        theirs = package[name].transpose("time", "body").to_numpy()[:count][within]
        largest = max(float(np.max(np.abs(ours), initial=0.0)), 1e-5)  # less is no motion
        apart = float(np.max(np.abs(ours - theirs), initial=0.0)) / largest
        differences.append(math.inf if math.isnan(apart) else apart)
    named = [e for e in reference.events if e.kind in KINDS]
    ours = [(e.time, what) for e in named for what in changes_of(e)]
    strongest = max((e.lost for e in named), default=0.0)
    bounces = [e.time for e in named if e.kind in ("impact", "rest")]
    counted = [e.time for e in named if e.kind == "impact" and e.lost > SLIGHT * strongest]
    slight = set(bounces) - set(counted)
    theirs = zip(
        package["event_time"].to_numpy(),
        zip(
            (EventKind(int(k)).name for k in package["event_kind"]),
            (int(k) for k in package["event_body"]),
            strict=True,
        ),
        strict=True,
    )
    all_ours = instants(ours, until)
    return Compared(
        reference, package, until, *differences, [one for one in all_ours if one[0] not in slight],
        all_ours, instants(theirs, until), off,
    )  # fmt: skip


def print_scene(number: int, comparison: Compared) -> None:
    """Print a line on a scene."""
    run = comparison.reference
    print(
        number,
        f"rotation {comparison.rotation:.1e} of {run.peaks.max():.1e}",
        f"slip {comparison.slip:.1e} of {run.peak_slips.max():.1e}",
        f"instants {len(comparison.ours)}, missing {len(comparison.missing)}, "
        f"added {len(comparison.added)}, renamed {len(comparison.renamed)}",
        "" if math.isinf(run.unique_until) else f"unique until {run.unique_until:.6f}",
        "" if comparison.same_verdict else "OTHER VERDICT",
        flush=True,
    )


def table_of(seed: int, numbers, draw_scene=draw) -> dict:
    """Compare scenes and return counts."""
    comparisons, refused = {}, {}
    for number in numbers:
        scene = draw_scene([seed, number])
        try:
            comparisons[number] = compare_scene(scene)
        except rf.errors.RockframeError as fault:
            refused[number] = str(fault)
            print(number, f"refused: {fault}", flush=True)
            continue
        print_scene(number, comparisons[number])
    scenes = list(comparisons.values())
    beyond = [n for n, one in comparisons.items() if max(one.rotation, one.slip) > held.AGREES]
    return {
        "seed": seed,
        "scenes": len(scenes),
        "refused": len(refused),
        "agree": len(scenes) - len(beyond),
        "median": float(f"{np.median([max(one.rotation, one.slip) for one in scenes]):.1e}"),
        "same events": sum(not (o.missing or o.added or o.renamed) for o in scenes),
        "instants": sum(len(one.ours) for one in scenes),
        "missing": sum(len(one.missing) for one in scenes),
        "added": sum(len(one.added) for one in scenes),
        "renamed": sum(len(one.renamed) for one in scenes),
        "sliding": sum(bool(one.reference.peak_slips.max() > 1e-6) for one in scenes),
        "rocking": sum(bool(one.reference.peaks.max() > 1e-6) for one in scenes),
        "overturning": sum(one.reference.overturned for one in scenes),
        "left the top": sum(one.off for one in scenes),
        "in flight": sum(any(e.kind == "flight" for e in o.reference.events) for o in scenes),
        "unique to the end": sum(math.isinf(one.reference.unique_until) for one in scenes),
        "verdicts agree where unique": sum(
            one.same_verdict for one in scenes if math.isinf(one.reference.unique_until)
        ),
        "kinds": dict(Counter(e.kind for one in scenes for e in one.reference.events)),
        "worst energy balance": float(f"{max(o.reference.imbalance for o in scenes):.0e}"),
        "beyond": beyond,
    }


def main() -> None:
    """Run the comparison requested on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--replay", type=int, nargs="+", help="numbers of scenes to repeat")
    parser.add_argument("--compliant", action="store_true", help="one base on pads or on a bed")
    options = parser.parse_args()
    draw_scene = draw_compliant if options.compliant else draw
    if options.replay:
        for number in options.replay:
            comparison = compare_scene(draw_scene([options.seed, number]))
            print_scene(number, comparison)
            print("    missing", comparison.missing[:3], "added", comparison.added[:3])
            print("    renamed", comparison.renamed[:3])
        return
    print(json.dumps(table_of(options.seed, range(options.scenes), draw_scene), indent=1))


if __name__ == "__main__":
    main()
