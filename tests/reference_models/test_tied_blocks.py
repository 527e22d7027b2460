"""A block on pads with ties against the hand-written monolith, in random scenes."""

import math
from collections import Counter

import numpy as np
import pytest

import rockframe as rf
from rockframe.dynamics.base_numbers import pads_numbers
from rockframe.dynamics.chain.link_rows import GROUND, ChainLink
from rockframe.dynamics.chain.model import chain_model
from rockframe.dynamics.events import EventKind
from rockframe.dynamics.links import LinkNumbers, Tie
from rockframe.dynamics.protocol import Start
from rockframe.dynamics.single_body import rigid_body
from rockframe.dynamics.starting import AtRest
from rockframe.dynamics.vibrations import ChainBody
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate

from .monoliths import ties, two_spring

pytestmark = pytest.mark.long

SCENES = 52
GRAVITY = 9.80665
TIME_STEP = 0.05
AGREES = 1e-6
SAME = {
    "slack": EventKind.RESTRAINER_SLACK,
    "taut": EventKind.RESTRAINER_TAUT,
    "yield": EventKind.RESTRAINER_YIELD,
    "press": EventKind.RESTRAINER_YIELD,
    "turn": EventKind.RESTRAINER_UNLOADING,
}


def draw(number: int) -> dict:
    """Draw a block, its pads, one to three ties, a start and a motion."""
    rng = np.random.default_rng([1101, number])
    width = rng.uniform(0.4, 1.5)
    half_height = 0.5 * width * rng.uniform(1.5, 5.0)
    radius = math.hypot(0.5 * width, half_height)
    size = 0.75 * GRAVITY / radius
    fast = math.sqrt(size) * rng.uniform(10.0, 40.0)
    some = []
    for _ in range(int(rng.integers(1, 4))):
        side = 1.0 if rng.random() < 0.5 else -1.0
        stiffness = fast**2 * 10.0 ** rng.uniform(-3.0, -0.5)
        lift = 0.1 * width * rng.uniform(0.2, 1.0)
        rod = rng.random() < 0.25
        kind = rng.integers(3)
        some.append(
            {
                "point": (side * 0.5 * width, half_height * rng.uniform(-1.0, 1.0)),
                "anchor": (side * width * rng.uniform(0.6, 1.5), half_height * rng.uniform(0, 2.0)),
                "stiffness": stiffness,
                "damping": rng.choice([0.0, 0.02]) * math.sqrt(stiffness),
                "slack": 0.0 if rod else lift * rng.choice([1e-3, 0.1]),
                "strength": math.inf if kind == 0 else stiffness * lift,
                "brittle": bool(kind == 2),
                "compression": bool(rod),
                "preload": 0.05 * GRAVITY * rng.random() if rng.random() < 0.3 and not rod else 0.0,
            }
        )
    motion = rng.normal(size=16) * rng.uniform(0.5, 2.0) * GRAVITY * width / (2.0 * half_height)
    return {
        "half_width": 0.5 * width,
        "half_height": half_height,
        "vertical_rate": fast,
        "damping_ratio": rng.uniform(0.02, 0.2),
        "restitution": rng.uniform(0.3, 0.95),
        "rotation": rng.uniform(-0.3, 0.3) * math.atan2(0.5 * width, half_height),
        "motion": [0.0, *motion, 0.0],
        "ties": some,
        "duration": 1.2,
    }  # fmt: skip


def by_package(scene: dict):
    """Run a scene by the chain of one body."""
    b, h = scene["half_width"], scene["half_height"]
    inertia, fast = (b * b + h * h) / 3.0, scene["vertical_rate"]
    body = rigid_body(
        left=b, right=b, height=h, inertia=inertia, restraint=0, small_rotation=False,
        gravity=GRAVITY,
    )  # fmt: skip
    eps = scene["restitution"]
    damping = scene["damping_ratio"] * fast
    base = pads_numbers(
        body, restitution=(eps, eps), stiffness=0.5 * fast**2, damping=damping, load=1.0
    )
    links = []
    for tie in scene["ties"]:
        (x, y), (anchor_x, anchor_y), k = tie["point"], tie["anchor"], tie["stiffness"]
        law = Tie(
            k, tie["damping"], tie["slack"] - tie["preload"] / k, tie["strength"] / k,
            float(tie["brittle"]), float(tie["compression"]),
        )  # fmt: skip
        links.append(
            ChainLink(
                0, (x, y), GROUND, (0.0, 0.0), (x - anchor_x, y + h - anchor_y),
                LinkNumbers(law, k, tie["damping"], (1e-3,)),
            )
        )  # fmt: skip
    model = chain_model([ChainBody(body, base, 1.0, h, 0.0)], 1.0, [AtRest(0.0, 0.0)], (), links)
    motion = rf.GroundMotion.from_arrays(
        (np.array(scene["motion"]), "m/s^2"), time_step=f"{TIME_STEP} s"
    )
    return integrate(
        model, Start(rotation=scene["rotation"]), motion.si, accuracy_of("reference"),
        duration=scene["duration"], output_step=0.01,
    )  # fmt: skip


def by_hand(scene: dict, height: float, times):
    """Run a scene by the monolith."""
    b, h = scene["half_width"], scene["half_height"]
    omega = math.sqrt(0.75 * GRAVITY / math.hypot(b, h))
    return two_spring.simulate(
        half_width=b, half_height=h, shape_factor=3.0, gravity=GRAVITY,
        frequency_ratio=scene["vertical_rate"] / omega, damping_ratio=scene["damping_ratio"],
        restitution=scene["restitution"], time_step=TIME_STEP, acceleration=scene["motion"],
        duration=scene["duration"], initial=(scene["rotation"], height, 0.0, 0.0),
        sample_times=times, steps_per_period=20.0, tied=[ties.Tie(**tie) for tie in scene["ties"]],
    )  # fmt: skip


@pytest.fixture(scope="module")
def compared() -> list:
    found = []
    for number in range(SCENES):
        scene = draw(number)
        run = by_package(scene)
        if EventKind.PIVOT_CHANGE in run.events.kind:
            continue  # the monolith lacks the rule by which an end slides out of flight
        theirs = by_hand(scene, float(run.state[0, 1]), run.time)
        found.append((number, run, theirs))
    return found


def test_rotations_match_monolith(compared):
    assert len(compared) >= SCENES - 5
    differences = {}
    for number, run, theirs in compared:
        ours = run.state[:, 0]
        count = min(len(ours), int(np.sum(~np.isnan(theirs.rotation))))
        gap = np.abs(ours[:count] - theirs.rotation[:count]).max() / np.abs(ours).max()
        differences[number] = float(gap)
    assert {tie: gap for tie, gap in differences.items() if gap > AGREES} == {}
    assert np.median(list(differences.values())) < 1e-9


def test_tie_events_match_monolith_and_energy_balances(compared):
    kinds = Counter()
    for number, run, theirs in compared:
        shown = run.events.kind[run.events.kind >= EventKind.RESTRAINER_SLACK]
        ours = Counter(EventKind(tie).name for tie in shown)
        their_counts = Counter(SAME[tie.kind].name for tie in theirs.events if tie.kind in SAME)
        assert theirs.energy_residual < 1e-10, number
        assert run.energy_residual < 1e-8, number
        broken = sum(tie.state == ties.BROKEN for tie in theirs.ties)
        kinds += ours + Counter(broken=broken)
        del ours["RESTRAINER_FRACTURE"]
        # a tie stretched beyond its strength at the start is unloaded, or broken, there
        for name in ("RESTRAINER_SLACK", "RESTRAINER_TAUT"):
            assert abs(ours[name] - their_counts[name]) <= 1, number
    assert min(kinds[tie] for tie in ("broken", *(SAME[k].name for k in SAME))) > 3
