"""Floor motions: descriptions of buildings, history, invalid arguments."""

import json
import warnings

import numpy as np
import pint
import pytest

import rockframe as rf
from rockframe.errors import ComponentError, RecordWarning, UnitsError

NOISE = np.convolve(np.random.default_rng(3).normal(size=300), np.hanning(20), "same")
STEP = 0.01


def motion(vertical=None):
    up = None if vertical is None else (vertical, "m/s^2")
    return rf.GroundMotion.from_arrays((NOISE, "m/s^2"), f"{STEP} s", up, name="noise")


def test_floor_motion_is_described_and_survives_round_trips():
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "2 Hz")
    buildings = (
        {"periods": ["0.5 s"], "damping_ratio": 0.05},
        {
            "periods": ["0.6 s", "0.2 s", "0 s"],
            "floor_participations": [1.2, -0.3, 0.1],
            "damping_ratio": [0.05, 0.02, 0.0],
            "time_step": "0.001 s",
            "vertical": "omitted",
        },
        {"storeys": 40, "floor": 17, "period": "1.3 s", "modes": 12, "free_vibration": "0 s"},
        {
            "masses": ([80, 80, 50], "t"),
            "stiffnesses": ["120 MN/m", "100 MN/m", "0.07 GN/m"],
            "floor": 3,
            "damping_ratio": "5 %",
        },
    )
    for before in (pulse, pulse.with_vertical(pulse.scaled(0.5)), motion(NOISE)):
        for building in buildings:
            after = before.through_storeys(**building)
            assert after.name == before.name
            assert after.history[: len(before.history)] == before.history
            assert "absolute acceleration of a floor" in after.history[len(before.history)]
            assert rf.GroundMotion.from_dataset(after.to_dataset()) == after
            description = json.loads(json.dumps(after.to_dict(samples=True)))
            assert rf.GroundMotion.from_dict(description) == after
            assert ("operations" in description) == (before.recipe is not None)
    history = motion().through_storeys(**buildings[2]).history
    assert history[1].startswith(
        "absolute acceleration of a floor, floor 17 of a shear building of equal storeys, "
        "40 in number, of 40 modes the first 12: period 1.3 s, damping ratio 0.05, "
    )
    assert "; 2 further modes; participation " in history[1]


def test_floor_motion_includes_free_vibration():
    floor = motion().through_storeys(["0.5 s"], free_vibration="1.234 s")
    assert len(floor) == 300 + 124
    assert floor.history[2] == "with 1.24 s of free vibration after the ground motion"
    assert floor.acceleration[0].magnitude == 0.0
    # decay to one hundredth takes 4.61/(2 pi 0.05) periods; one more is added
    assert len(motion().through_storeys(["0.5 s"])) == 300 + 783
    softest = motion().through_storeys(
        ["0.5 s", "2 s", "9 s"], [0.05, 0.5, 0.05], floor_participations=[1, 0.3, 0]
    )
    assert len(softest) == 300 + 783
    with pytest.raises(
        ComponentError, match="without damping never comes to rest; give the duration"
    ):
        motion().through_storeys(["0.5 s"], 0)
    cut = motion().through_storeys(["0.5 s"], 0, free_vibration="0 s")
    assert len(cut) == 300


def test_vertical_component_of_floor_equals_ground():
    floor = motion(-NOISE).through_storeys(["0.5 s"], free_vibration="1 s")
    assert floor.si.vertical.samples.tolist() == [*(-NOISE), *np.zeros(100)]
    assert floor.history[-1] == "vertical component unchanged"
    finer = motion(-NOISE).through_storeys(["0.5 s"], time_step="0.005 s")
    assert finer.si.vertical.samples[:600:2].tolist() == (-NOISE).tolist()
    assert motion(NOISE).through_storeys(["0.5 s"], vertical="omitted").si.vertical is None
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "2 Hz")
    both = pulse.with_vertical(pulse).through_storeys(["0.5 s"], time_step="0.0013 s")
    time = np.linspace(-0.1, 0.7, 1001)
    np.testing.assert_allclose(both.si.vertical.at(time), pulse.si.at(time), atol=1e-14)
    assert both.si.vertical.analytic
    assert not both.si.horizontal.analytic


def test_short_periods_warn_and_suggest_time_step():
    stiff = ["0.06 s"]
    tone = np.sin(2.0 * np.pi * np.arange(300) * STEP / 0.06)
    shaken = rf.GroundMotion.from_arrays((tone, "m/s^2"), f"{STEP} s")
    words = r"0.01 s apart.*by up to 1[0-9] % of its peak; .* time_step='0.00333[0-9]* s'"
    with pytest.warns(RecordWarning, match=words) as caught:
        coarse = shaken.through_storeys(stiff)
    assert caught[0].filename == __file__
    assert "departs from that by up to 1" in coarse.history[3]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fine = shaken.through_storeys(stiff, time_step="0.00333 s")
        shaken.through_storeys(["0.6 s"])
    np.testing.assert_allclose(
        fine.si.horizontal.samples[:1200:4],
        coarse.si.horizontal.samples[:300],
        atol=1e-12 * fine.si.peak,
    )


def test_arguments_accept_equivalent_forms():
    expected = motion().through_storeys(["500 ms"], 0.05)
    for periods in ("0.5 s", ([0.5], "s"), pint.Quantity([0.5], "s"), pint.Quantity(0.5, "s")):
        for damping in (0.05, "5 %", np.float64(0.05), [0.05], np.array([0.05]), ("5 %",)):
            assert motion().through_storeys(periods, damping) == expected
    participations = np.array([1.2, -0.2])
    assert motion().through_storeys(
        ["0.5 s", "0.2 s"], floor_participations=participations
    ) == motion().through_storeys(["0.5 s", "0.2 s"], floor_participations=[1.2, -0.2])


def test_invalid_buildings_are_refused():
    uniform = {"storeys": 6, "floor": 4, "period": "0.6 s"}
    masses = {"masses": ([1, 2], "t"), "stiffnesses": ([3, 4], "MN/m"), "floor": 1}
    cases = (
        ({}, "give periods; or storeys, period and floor; or masses, .* got none of them"),
        ({"storeys": 6, "floor": 4}, "got storeys, floor; write for example periods="),
        ({**uniform, "periods": ["1 s"]}, "got periods, storeys, period, floor"),
        ({"periods": ["1 s"], "modes": 1}, "got periods, modes"),
        ({**uniform, "floor_participations": [1]}, "got floor_participations, storeys"),
        ({"periods": []}, "periods must be one or more values"),
        ({"periods": ["-1 s"]}, "each zero or more"),
        ({"periods": ["1 s", "0.3 s"]}, "2 periods need floor_participations"),
        (
            {"periods": ["1 s", "0.3 s"], "floor_participations": [1]},
            "one value for each of the 2 periods, got 1",
        ),
        ({"periods": ["nan s"]}, "periods must be finite"),
        ({**uniform, "floor": 7}, "floor must be a whole number from 1 to 6, got 7"),
        ({**uniform, "floor": 0}, "floor must be a whole number from 1 to 6, got 0"),
        ({**uniform, "storeys": 2.5}, "storeys must be a whole number"),
        ({**uniform, "storeys": 1001}, "storeys must be a whole number from 1 to 1000"),
        ({**uniform, "period": "0 s"}, "period must be greater than zero"),
        ({**uniform, "modes": 7}, "modes must be a whole number from 1 to 6"),
        ({**masses, "masses": ([1], "t")}, "one value for each storey.*; got 1 and 2"),
        ({**masses, "masses": ([1, 0], "t")}, "masses must be .* each greater than zero"),
        ({**masses, "stiffnesses": ([1e-25, 1e25], "MN/m")}, "too far apart"),
        ({**uniform, "damping_ratio": 1.2}, "damping_ratio must be from 0 to 1"),
        ({**uniform, "damping_ratio": [0.05, 5]}, r"damping_ratio\[1\] must be from 0 to 1"),
        ({**uniform, "damping_ratio": [0.05, 0.1]}, "one for each of the 6 modes, got 2"),
        ({**uniform, "damping_ratio": []}, "one for each of the 6 modes, got 0"),
        ({**uniform, "free_vibration": "-1 s"}, "free_vibration must be zero or more"),
        ({**uniform, "free_vibration": "1e9 s"}, "are more than .* samples; give a shorter"),
        ({**uniform, "damping_ratio": 1e-9}, "are more than .* samples; give a shorter"),
        ({**uniform, "time_step": "0.02 s"}, "longer than that of the motion, 0.01 s"),
        ({**uniform, "time_step": "1e-300 s"}, "more than .* samples"),
        ({**uniform, "time_step": "0 s"}, "time_step must be greater than zero"),
        ({**uniform, "vertical": "kept"}, "vertical must be 'unchanged' or 'omitted'"),
        ({"periods": ["1e-9 s"]}, "too short for the time step, 0.01 s; a rigid mode has"),
    )
    for arguments, words in cases:
        with pytest.raises(ComponentError, match=f"GroundMotion.through_storeys: .*{words}"):
            motion().through_storeys(**arguments)
    for arguments, words in (
        ({"periods": [0.5]}, "periods needs a time"),
        ({"periods": ["0.5 kg"]}, "periods needs a time"),
        ({**masses, "masses": ([1, 2], "kN")}, "masses needs a mass"),
        ({**uniform, "damping_ratio": "0.05 s"}, "damping_ratio needs a pure ratio"),
        ({**uniform, "free_vibration": 20}, "free_vibration needs a time"),
    ):
        with pytest.raises(UnitsError, match=words):
            motion().through_storeys(**arguments)


def test_floor_without_modal_response_moves_with_ground():
    for arguments in (
        {"periods": ["0 s"]},
        {"periods": ["0.5 s"], "floor_participations": 0},
    ):
        floor = motion().through_storeys(**arguments)
        assert floor.si.horizontal.samples.tolist() == NOISE.tolist()
    still = rf.GroundMotion.from_arrays(([0.0, 0.0], "m/s^2"), "0.01 s")
    assert still.through_storeys(["0.5 s"]).si.peak == 0.0
