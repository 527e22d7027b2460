"""Compare the package's two sliding rigid blocks with the reference model in random scenes.

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

from reference_models.rigid_pair import compare as held  # noqa: E402
from reference_models.rigid_pair_sliding.contacts import Friction  # noqa: E402
from reference_models.rigid_pair_sliding.drawing import FREE, STEP, Scene, draw  # noqa: E402
from reference_models.rigid_pair_sliding.events import OffTheTopError, Run  # noqa: E402
from reference_models.rigid_pair_sliding.simulate import simulate  # noqa: E402

import rockframe as rf  # noqa: E402
from rockframe.dynamics.events import EventKind  # noqa: E402

OUTPUT = 0.01
"""Step of what is compared [s]."""
KINDS = {
    "uplift": "UPLIFT", "flight": "SEPARATION", "impact": "IMPACT", "rest": "REST", "slip": "SLIP",
    "stick": "STICK", "reversal": "SLIP_REVERSAL", "overturning": "OVERTURNING",
}  # fmt: skip
BODIES = {"ground": 2, "joint": 1, "lower": 2, "upper": 1}
"""The package counts bodies from the top."""
SOON = 1e-9
"""Events closer than this are one instant [s]."""


@dataclass(frozen=True)
class Compared:
    """Both runs, up to the end of the shorter one or the first motion that is not unique.

    ``rotation`` is the largest difference over the largest rotation, ``slip`` that of slips over
    the largest slip; ``ours`` and ``theirs`` are the instants, with all that happens at each.
    """

    reference: Run
    package: Any  # the dataset
    until: float
    rotation: float
    slip: float
    ours: list
    theirs: list

    @property
    def same_verdict(self) -> bool:
        """Whether both overturn or neither does."""
        return bool(self.package["overturned"]) == self.reference.overturned

    @property
    def same_events(self) -> bool:
        """Whether the same happens at the same times, in the same order."""
        return len(self.ours) == len(self.theirs) and all(
            abs(one[0] - two[0]) < 1e-6 and two[1] & one[1]
            for one, two in zip(self.ours, self.theirs, strict=True)
        )

    @property
    def found(self) -> tuple[int, int]:
        """How many instants of the reference there are, and how many the package has too."""
        theirs = np.array([one[0] for one in self.theirs] or [-1.0])
        return len(self.ours), sum(bool(np.min(np.abs(theirs - t)) < 1e-6) for t, _ in self.ours)


def ground_of(friction: Friction) -> rf.RigidGround:
    """Give the package's interface."""
    if friction.holds:
        return rf.RigidGround()
    return rf.RigidGround(
        friction=friction.static, kinetic_friction=friction.kinetic,
        impact="stick" if friction.stick else "coulomb",
    )  # fmt: skip


def system_of(scene: Scene) -> rf.System:
    """Give the package's scene."""
    pair = scene.pair
    stack = rf.Stack(
        held.block_of(pair.upper), held.block_of(pair.lower),
        interfaces=[ground_of(scene.frictions["joint"])], offsets=[f"{pair.offset!r} m"],
    )  # fmt: skip
    return rf.System(stack, ground_of(scene.frictions["ground"]))


def motion_of(motion: dict[str, Any]) -> rf.GroundMotion:
    """Give the package's ground motion."""
    if motion["form"] != "noise":
        return held.motion_of(motion)
    vertical = {"vertical": (motion["up"], "m/s^2")} if any(motion["up"]) else {}
    return rf.GroundMotion.from_arrays((motion["across"], "m/s^2"), f"{STEP!r} s", **vertical)


def instants(events, until: float) -> list:
    """Gather events, as time and what, by the instants before a time."""
    found: list = []
    for time, what in events:
        if time >= until:
            break
        if found and time - found[-1][0] < SOON:
            found[-1][1].add(what)
        else:
            found.append((time, {what}))
    return found


def compared(scene: Scene, accuracy: str = "reference") -> Compared:
    """Run a scene by both."""
    try:
        reference = simulate(scene, OUTPUT)
    except OffTheTopError as fault:
        reference = fault.run
    package = system_of(scene).simulate(
        motion_of(scene.motion), free_vibration=f"{FREE!r} s", accuracy=accuracy,
        output_step=f"{OUTPUT!r} s",
    )  # fmt: skip
    until = min(reference.unique_until, reference.end)
    count = min(len(reference.time), package.sizes["time"])
    within = reference.time[:count] < until
    differences = []
    for ours, name in ((reference.rotation, "body_rotation"), (reference.slip, "body_slip")):
        if name not in package:  # nothing slips in the package's scene
            differences.append(float(np.max(np.abs(ours), initial=0.0)))
            continue
        ours = ours[:count, ::-1][within]
        theirs = package[name].transpose("time", "body").to_numpy()[:count][within]
        largest = max(float(np.max(np.abs(ours), initial=0.0)), 1e-6)
        apart = float(np.max(np.abs(ours - theirs), initial=0.0)) / largest
        differences.append(math.inf if math.isnan(apart) else apart)
    ours = [(e.time, (KINDS[e.kind], BODIES[key]))
            for e in reference.events if e.kind in KINDS for key in e.where.split("+")]  # fmt: skip
    theirs = zip(
        package["event_time"].to_numpy(),
        zip(
            (EventKind(int(k)).name for k in package["event_kind"]),
            (int(k) for k in package["event_body"]),
            strict=True,
        ),
        strict=True,
    )
    return Compared(
        reference, package, until, *differences, instants(ours, until), instants(theirs, until)
    )


def tell(number: int, one: Compared) -> None:
    """Print a line on a scene."""
    run = one.reference
    print(
        number, f"rotation {one.rotation:.1e} of {run.peaks.max():.1e}",
        f"slip {one.slip:.1e} of {run.peak_slips.max():.1e}",
        "same events" if one.same_events else "instants {}, found {}".format(*one.found),
        "" if math.isinf(run.unique_until) else f"unique until {run.unique_until:.6f}",
        "" if one.same_verdict else "OTHER VERDICT", flush=True,
    )  # fmt: skip


def first_difference(one: Compared) -> list:
    """Give the instants of both from the last common one on, three of each."""
    same = 0
    for ours, theirs in zip(one.ours, one.theirs, strict=False):
        if abs(ours[0] - theirs[0]) > 1e-6 or not ours[1] & theirs[1]:
            break
        same += 1
    start = max(same - 1, 0)
    return [one.ours[start : start + 3], one.theirs[start : start + 3]]


def table_of(seed: int, numbers) -> dict:
    """Compare scenes and count."""
    found, refused = {}, {}
    for number in numbers:
        scene = draw([seed, number])
        try:
            found[number] = compared(scene)
        except rf.errors.RockframeError as fault:
            refused[number] = str(fault)
            print(number, f"refused: {fault}", flush=True)
            continue
        tell(number, found[number])
    scenes = list(found.values())
    instants = np.sum([one.found for one in scenes], axis=0)
    beyond = [n for n, one in found.items() if max(one.rotation, one.slip) > held.AGREES]
    return {
        "seed": seed,
        "scenes": len(scenes),
        "refused": len(refused),
        "agree": len(scenes) - len(beyond),
        "median": float(f"{np.median([max(one.rotation, one.slip) for one in scenes]):.1e}"),
        "same events": sum(one.same_events for one in scenes),
        "instants": int(instants[0]),
        "instants found in both": int(instants[1]),
        "sliding": sum(bool(one.reference.peak_slips.max() > 1e-6) for one in scenes),
        "rocking": sum(bool(one.reference.peaks.max() > 1e-6) for one in scenes),
        "overturning": sum(one.reference.overturned for one in scenes),
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
    """Run the comparison that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--replay", type=int, nargs="+", help="numbers of scenes to repeat")
    given = parser.parse_args()
    if given.replay:
        for number in given.replay:
            one = compared(draw([given.seed, number]))
            tell(number, one)
            for each in first_difference(one):
                print("   ", each)
        return
    print(json.dumps(table_of(given.seed, range(given.scenes)), indent=1))


if __name__ == "__main__":
    main()
