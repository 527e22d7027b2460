"""Two horizontal components as the motions of a study."""

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import AssemblyError, RockframeError

NORTH = rf.GroundMotion.stochastic(6.0, "10 km", seed=1).window("9 s", "15 s")
EAST = rf.GroundMotion.stochastic(6.0, "10 km", seed=2).window("9 s", "15 s")
PAIR = rf.HorizontalPair(NORTH, EAST)
SYSTEM = rf.System(rf.Block(width="0.4 m", height="2 m", mass="300 kg"))
OPTIONS = {"scale": [4.0, 6.0], "free_vibration": "1 s"}


def test_pair_is_run_as_its_two_components():
    runs = rf.sweep(SYSTEM, PAIR, **OPTIONS)
    apart = rf.sweep(SYSTEM, [NORTH, EAST], **OPTIONS)
    assert runs.motion.values.tolist() == apart.motion.values.tolist()
    np.testing.assert_array_equal(runs.peak_rotation, apart.peak_rotation)
    assert (runs.peak_rotation > 0.0).all()
    assert rf.fragility(runs, "PGA", limits=[0.1]).trial_count.values.tolist() == [4, 4]


@pytest.mark.parametrize("other", ["station first", "station second"])
def test_a_component_of_a_pair_replaces_no_motion(other):
    for motions in ({"station": PAIR, other: NORTH}, {other: NORTH, "station": PAIR}):
        with pytest.raises(RockframeError, match=f"two entries are called '{other}'"):
            rf.sweep(SYSTEM, motions, **OPTIONS)


def test_components_of_a_pair_are_labelled():
    runs = rf.sweep(SYSTEM, {"station": PAIR, "pulse": rf.GroundMotion.sine_pulse()}, **OPTIONS)
    assert runs.motion.values.tolist() == ["station first", "station second", "pulse"]
    pair = rf.HorizontalPair(
        *(
            rf.GroundMotion(one.si, name=one.name, metadata={"component": name})
            for one, name in ((NORTH, "N"), (EAST, "E"))
        )
    )
    runs = rf.sweep(SYSTEM, {"station": pair}, **OPTIONS)
    assert runs.motion.values.tolist() == ["station N", "station E"]
    found = rf.incremental_dynamic_analysis(SYSTEM, [pair], **OPTIONS, resolution=1.0)
    assert found.sizes["motion"] == 2


def test_vertical_component_accompanies_both_directions():
    pair = rf.HorizontalPair(NORTH, EAST, NORTH.scaled(0.3))
    runs = rf.sweep(SYSTEM, pair, **OPTIONS)
    alone = SYSTEM.simulate(EAST.with_vertical(NORTH.scaled(0.3)).scaled(6.0), free_vibration="1 s")
    assert runs.peak_rotation.values[1, 1] == alone.peak_rotation.item()


def test_simulate_refuses_a_pair():
    with pytest.raises(AssemblyError, match=r"pair\.rotated\('30 deg'\)"):
        SYSTEM.simulate(PAIR)


def test_a_pair_where_one_motion_is_needed_is_refused_with_advice():
    north = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    pair = rf.HorizontalPair(north, north)
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    for call in (
        lambda: system.simulate(pair),
        lambda: rf.earthquake_sequences(system, [[north, pair]]),
        lambda: rf.codes.circolare_2019(system, pair),
        lambda: rf.codes.circolare_2019(system, {"both": pair}),
        lambda: rf.intensity_measures(pair),
        lambda: rf.MotionSuite({"both": pair}),
    ):
        with pytest.raises(RockframeError, match=r"in one direction: pair.first, or pair.rotated"):
            call()
