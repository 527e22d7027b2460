"""Cases that are assembled together equal cases assembled one by one, bit for bit.

Random studies of each kind of scene, with every axis that its numbers depend on.
"""

import numpy as np
import pytest

import rockframe as rf
from rockframe.compiled import COMPILED
from rockframe.studies.sweeps import chunk, study
from rockframe.studies.sweeps.lanes import FinishedGroup
from rockframe.studies.sweeps.planning import plan_study

pytestmark = [
    pytest.mark.wide,
    pytest.mark.skipif(not COMPILED, reason="lanes are compiled"),
    pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning"),
]

COUNT = 120
COMPILED_ANYWAY = (
    "pads",
    "pads by stiffness",
    "restitution on pads",
    "inertia on pads",
    "rigid ground",
    "restitution",
)  # by other tests in lanes
TWICE = "cascade", "fast"
BLOCK = rf.Block(width="2.4 m", height="9.7 m", mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
STIFF = rf.TwoSpringSupport(stiffness="40 MN/m", damping="200 kN*s/m")
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping="220 kPa*s")
CAP = rf.CushionCap(height="0.9 m", mass="36 t", width="3 m")
SIZE = {"Block.width": (1.5, 3.0, "m"), "Block.height": (5.0, 12.0, "m")}
SCALE = {"scale": (0.3, 2.5, None)}

STUDIES = {
    "pads": (
        rf.System(BLOCK, PADS),
        {"frequency_ratio": (8, 30, None), "damping_ratio": (0, 0.2, None)},
    ),
    "pads by stiffness": (
        rf.System(BLOCK, STIFF, restraint="leading-corner"),
        {"stiffness": (10, 90, "MN/m"), "mass": (20, 80, "t"), "gravity": (8, 11, "m/s^2")},
    ),
    "restitution on pads": (rf.System(BLOCK, PADS), {"restitution": (0.6, 0.85, None)}),
    "inertia on pads": (
        rf.System(BLOCK, PADS, rotation="small"),
        {"shape_factor": (2.2, 4, None)},
    ),
    "rigid ground": (rf.System(BLOCK), {"mass": (20, 80, "t")}),
    "restitution": (
        rf.System(BLOCK, rf.RigidGround(restitution=0.8)),
        {"restitution": (0.6, 0.85, None)},
    ),
    "sliding": (
        rf.System(BLOCK, rf.RigidGround(friction=0.4)),
        {"friction": (0.1, 0.9, None), "Block.width": (1.0, 2.0, "m")},
    ),
    "wall": (rf.System(BLOCK, rf.RearWall(side="left")), {"Block.mass": (20, 80, "t")}),
    "eccentric": (rf.System(BLOCK), {"eccentricity": (-0.2, 0.2, "m")}),
    "bed": (
        rf.System(BLOCK, SOIL),
        {"stiffness": (5, 20, "MPa"), "damping": (0, 300, "kPa*s")},
    ),
    "cap": (rf.System(BLOCK, CAP, SOIL), {"CushionCap.mass": (20, 50, "t")}),
    "cascade": (
        rf.System(BLOCK, PADS, CAP, SOIL, coupling="cascade"),
        {"frequency_ratio": (15, 30, None)},
    ),
}


def record(seed=5):
    x = np.convolve(np.random.default_rng(seed).normal(size=200), np.ones(4) / 4, "same")
    return rf.GroundMotion.from_arrays((6 * x, "m/s^2"), "0.02 s", name="drawn")


def table(spreads, rng, count=COUNT):
    return {
        name if unit is None else f"{name} [{unit}]": rng.uniform(low, high, count)
        for name, (low, high, unit) in spreads.items()
    }


def run_both_ways(monkeypatch, scene, cases, motion, **options):
    """Run a chunk assembled together and case by case; return also how many ran together."""
    monkeypatch.setattr(study, "MIN_CASES_IN_LANES", 1)
    monkeypatch.setattr(study, "COMPILING_SHARE", float("inf"))
    planned = plan_study(scene, motion, {}, cases, **options)
    job = planned.job(range(planned.grid.count))
    served, run_assembled_together = [0], chunk.run_assembled_together

    def counted(*arguments):
        for found in run_assembled_together(*arguments):
            served[0] += len(found.cases) if isinstance(found, FinishedGroup) else 1
            yield found

    monkeypatch.setattr(chunk, "run_assembled_together", counted)
    joint = chunk.run_chunk(job)
    monkeypatch.setattr(chunk, "run_assembled_together", lambda *_: iter(()))
    alone = chunk.run_chunk(job)
    monkeypatch.setattr(chunk, "run_assembled_together", run_assembled_together)
    return joint, alone, served[0]


def assert_same(joint, alone):
    assert joint.status.tolist() == alone.status.tolist()
    assert joint.scalars.keys() == alone.scalars.keys()
    for name, column in alone.scalars.items():
        assert joint.scalars[name].tobytes() == column.tobytes(), name
    messages = [[each.texts[k] for k in each.message] for each in (joint, alone)]
    assert messages[0] == messages[1]


@pytest.mark.parametrize(
    ("name", "accuracy"),
    # fixed steps of two bases in lanes are compared with single runs elsewhere
    [
        pytest.param(name, by, marks=[pytest.mark.long] * (name not in COMPILED_ANYWAY))
        for name in STUDIES
        for by in ("fast", "standard")
        if (name, by) != TWICE
    ],
)
def test_joint_assembly_is_bit_identical_to_single_assembly(monkeypatch, name, accuracy):
    scene, spreads = STUDIES[name]
    rng = np.random.default_rng([ord(letter) for letter in name])
    cases = table({**SIZE, **SCALE, **spreads}, rng)
    joint, alone, served = run_both_ways(monkeypatch, scene, cases, record(), accuracy=accuracy)
    assert_same(joint, alone)
    assert served > 0.5 * COUNT


def test_joint_assembly_handles_starts_options_and_motions(monkeypatch):
    rng = np.random.default_rng(11)
    cases = table({**SIZE, "initial_rotation": (0.001, 0.05, "rad")}, rng, 3 * COUNT)
    cases["restraint"] = rng.choice(["centre", "contact-state"], 3 * COUNT)
    cases["motion"] = rng.integers(0, 2, 3 * COUNT)
    motions = [record(5), rf.GroundMotion.sine_pulse("-3 m/s^2", "1.5 Hz")]
    joint, alone, served = run_both_ways(
        monkeypatch, rf.System(BLOCK, PADS), cases, motions, accuracy="fast"
    )
    assert_same(joint, alone)
    assert served > COUNT


def test_joint_assembly_scales_motions_to_intensity_targets(monkeypatch):
    rng = np.random.default_rng(12)
    cases = table({**SIZE, "peak_ground_acceleration": (1.0, 6.0, "m/s^2")}, rng)
    joint, alone, served = run_both_ways(
        monkeypatch, rf.System(BLOCK), cases, record(), accuracy="standard"
    )
    assert_same(joint, alone)
    assert served > 0.5 * COUNT


def test_screened_studies(monkeypatch):
    rng = np.random.default_rng(13)
    monkeypatch.setattr(chunk, "MIN_CASES_IN_LANES", 1)
    small = {"Block.width": (0.4, 0.8, "m"), "Block.height": (2.0, 5.0, "m")}
    cases = table({**small, "scale": (0.5, 3.0, None)}, rng, 2 * COUNT)
    joint, alone, served = run_both_ways(
        monkeypatch, rf.System(BLOCK, PADS), cases, record(), accuracy="screen"
    )
    assert_same(joint, alone)
    assert 0.0 < joint.scalars["repeated"].mean() < 1.0
    assert served > COUNT


def test_invalid_cases_have_the_same_messages_in_joint_assembly(monkeypatch):
    rng = np.random.default_rng(14)
    cases = table({**SIZE, **SCALE, "restitution": (0.5, 1.0, None)}, rng)
    heights = cases["Block.height [m]"]
    heights[::7] = 0.5  # too squat to rock
    heights[3] = 1e-200  # a vanishing inertia
    joint, alone, _ = run_both_ways(
        monkeypatch, rf.System(BLOCK, PADS), cases, record(), accuracy="fast"
    )
    assert_same(joint, alone)
    messages = {joint.texts[k] for k in joint.message}
    assert any("cannot rock" in text for text in messages)
    assert any("exceeds eps_max" in text for text in messages)


def test_user_functions_are_called_with_scalars(monkeypatch):
    def scene(height):
        assert isinstance(height.m_as("m"), float)
        return rf.System(rf.Block(width="1 m", height=height, mass="1 t"))

    cases = {"height [m]": np.linspace(3.0, 6.0, 40)}
    joint, alone, served = run_both_ways(monkeypatch, scene, cases, record(), accuracy="fast")
    assert_same(joint, alone)
    assert served == 0
