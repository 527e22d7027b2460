"""Arguments of a run: refusals, durations, warnings."""

import itertools
import json
import math
import multiprocessing
import sys

import numpy as np
import pytest
from unit.usual_scenes import SCENES, assembled, block, cap, pads, pulse, soil

import rockframe as rf
from rockframe.errors import AssemblyError, ModelWarning, RockframeError, SolverError
from rockframe.solve.accuracy import accuracy_of

pytestmark = pytest.mark.unit


# simulate ----------------------------------------------------------------------------------------


def refusal(error=AssemblyError, system=None, **arguments):
    chosen = rf.System(block(), pads()) if system is None else system
    with pytest.raises(error) as caught:
        chosen.simulate(arguments.pop("motion", pulse()), **arguments)
    return str(caught.value)


class TestSimulateRefuses:
    def test_missing_motion_and_duration(self):
        with pytest.raises(AssemblyError, match="nothing to simulate"):
            rf.System(block()).simulate()
        with pytest.raises(AssemblyError, match="nothing to simulate"):
            rf.System(block()).simulate(initial=rf.InitialState(rotation="0.1 rad"))

    @pytest.mark.parametrize("bad", ["pulse", 3, [0.0, 1.0], rf.GroundMotion, np.zeros(3)])
    def test_invalid_motion(self, bad):
        assert "motion must be a GroundMotion" in refusal(motion=bad)

    @pytest.mark.parametrize("bad", ["0.1 rad", 0.1, {}, rf.InitialState])
    def test_invalid_initial_state(self, bad):
        assert "InitialState" in refusal(initial=bad)

    def test_duration_together_with_free_vibration(self):
        message = refusal(duration="1 s", free_vibration="2 s")
        assert "duration or free_vibration, not both" in message

    @pytest.mark.parametrize("name", ["duration", "free_vibration", "output_step"])
    @pytest.mark.parametrize("bad", ["0 s", "-1 s", "nan s", "inf s", "1 m", "1", 1.0])
    def test_invalid_durations_and_output_steps(self, name, bad):
        assert name in refusal(RockframeError, **{name: bad})

    @pytest.mark.parametrize("sign", ["", "-"])
    def test_an_initial_rotation_beyond_overturning(self, sign):
        for name in SCENES:
            system = assembled(name)
            theta = system.equilibrium().overturning_angle.item()
            inside = rf.InitialState(rotation=f"{sign}{theta * (1.0 - 1e-9)!r} rad")
            system.simulate(pulse(), initial=inside, outputs=None)
            for angle in (theta, theta * (1.0 + 1e-9), 1.0):
                start = rf.InitialState(rotation=f"{sign}{angle!r} rad")
                message = refusal(system=system, initial=start)
                assert "initial rotation" in message
                assert "overturning angle" in message

    def test_vertical_initial_state_on_rigid_ground(self):
        for start in (
            rf.InitialState(vertical_displacement="1 mm"),
            rf.InitialState(vertical_displacement="0 mm"),
            rf.InitialState(vertical_velocity="1 mm/s"),
        ):
            message = refusal(system=rf.System(block()), initial=start)
            assert "vertical_displacement" in message

    @pytest.mark.parametrize(
        "bad", ["x", ["rotations"], ["peak_rotation"], ["energy", "x"], [3], 3, [[]], [None], True]
    )
    def test_outputs_that_do_not_exist(self, bad):
        message = refusal(RockframeError, outputs=bad)
        assert "outputs" in message
        assert "kinetic_energy" in message

    @pytest.mark.parametrize("bad", ["Stop", "go on", None, True, 1, []])
    def test_unknown_overturning_options(self, bad):
        message = refusal(overturning=bad)
        assert "'stop', 'continue'" in message
        assert repr(bad) in message

    @pytest.mark.parametrize("bad", ["best", "", None, 1, True, []])
    def test_unknown_accuracies(self, bad):
        message = refusal(RockframeError, accuracy=bad)
        for word in ("fast", "standard", "reference", "Accuracy", repr(bad)):
            assert word in message

    @pytest.mark.parametrize("bad", [0.1, 1e-15, math.nan, -1e-6])
    def test_tolerances_out_of_range(self, bad):
        assert "rtol must lie from 1e-13 to 0.01" in refusal(SolverError, accuracy=bad)

    def test_several_faults_at_once(self):
        message = refusal(
            duration="1 s",
            free_vibration="1 s",
            overturning="x",
            outputs=["y"],
            initial=rf.InitialState(rotation="1 rad"),
        )
        for word in ("not both", "overturning must", "'y'", "initial rotation"):
            assert word in message

    def test_invalid_output_step_without_histories(self):
        assert "output_step" in refusal(RockframeError, outputs=None, output_step="5")


def _simulate(options):
    try:
        rf.System(block(), pads()).simulate(pulse(), **options)
    except RockframeError:
        sys.exit(7)
    sys.exit(0)


@pytest.mark.parametrize(
    "options", [{"duration": "1e12 s"}, {"output_step": "1e-13 s"}, {"free_vibration": "1e300 s"}]
)
def test_excessive_sample_counts_are_refused_quickly(options):
    worker = multiprocessing.get_context("fork").Process(target=_simulate, args=(options,))
    worker.start()
    worker.join(20.0)
    alive = worker.is_alive()
    if alive:
        worker.kill()
        worker.join()
    assert not alive
    assert worker.exitcode == 7


class TestAccuracy:
    @pytest.mark.parametrize("kind", [np.float64, np.float32])
    def test_a_tolerance_may_be_a_number_of_numpy(self, kind):
        assert accuracy_of(kind(1e-6)) == rf.Accuracy(rtol=float(kind(1e-6)))

    def test_is_an_immutable_value(self):
        accuracy = rf.Accuracy(rtol=1e-8)
        assert accuracy == rf.Accuracy(rtol=1e-8)
        assert hash(accuracy) == hash(rf.Accuracy(rtol=1e-8))
        with pytest.raises(AttributeError):
            accuracy.rtol = 1e-3

    @pytest.mark.parametrize(
        ("name", "bad"),
        [
            ("rtol", 0.0),
            ("rtol", -1e-7),
            ("rtol", 1.0),
            ("rtol", 1e-16),
            ("rtol", 0.9e-13),
            ("rtol", 1.1e-2),
            ("rtol", math.nan),
            ("rtol", math.inf),
            ("rtol", "1e-7"),
            ("rtol", None),
            ("rtol", True),
            ("steps_per_period", 0),
            ("steps_per_period", math.nan),
            ("max_steps", 0),
            ("max_steps", -5),
            ("max_steps", 10.5),
            ("floor", -0.1),
            ("floor", 2.0),
        ],
    )
    def test_settings_out_of_range_are_refused(self, name, bad):
        with pytest.raises(SolverError, match=name):
            rf.Accuracy(**{"rtol": 1e-7, name: bad})

    @pytest.mark.parametrize(
        ("name", "settings"),
        [
            ("fast", {"rtol": None, "substeps": "fewest", "steps_per_period": 10.0}),
            ("standard", {"rtol": 2e-8, "substeps": None, "steps_per_period": 8.0}),
            ("reference", {"rtol": 1e-11, "substeps": None, "steps_per_period": 8.0}),
        ],
    )
    def test_run_records_its_accuracy_settings(self, name, settings):
        response = rf.System(block(), pads()).simulate(pulse(), accuracy=name, outputs=None)
        assert settings.items() <= json.loads(response.run_json)["accuracy"].items()

    @pytest.mark.parametrize("name", ["fast", "standard", "reference"])
    def test_named_accuracies_equal_explicit_settings(self, name):
        response = rf.System(block(), pads()).simulate(pulse(), accuracy=name, outputs=None)
        assert response.attrs["accuracy"] == name
        if name == "fast":
            assert math.isnan(response.attrs["solver_rtol"])
            assert response.attrs["solver_substeps"] >= 1
            assert "order 3" in response.attrs["solver_method"]
            own = rf.Accuracy(substeps=response.attrs["solver_substeps"])
        else:
            assert response.attrs["solver_substeps"] == 0
            assert "5(4)" in response.attrs["solver_method"]
            own = rf.Accuracy(rtol=response.attrs["solver_rtol"])
        again = rf.System(block(), pads()).simulate(pulse(), accuracy=own, outputs=None)
        assert float(again.peak_rotation) == float(response.peak_rotation)

    @pytest.mark.parametrize("given", [{}, {"rtol": 1e-6, "substeps": 4}, {"floor": 0.1}])
    def test_a_tolerance_or_substeps_but_not_both(self, given):
        with pytest.raises(SolverError, match=r"rtol .* or substeps"):
            rf.Accuracy(**given)

    @pytest.mark.parametrize("bad", [0, -1, 1.5, 2.0, True, "4", "most", math.nan, 10**7])
    def test_substeps_out_of_range_are_refused(self, bad):
        with pytest.raises(SolverError, match="substeps"):
            rf.Accuracy(substeps=bad)

    def test_fixed_steps_require_more_steps_per_period(self):
        assert rf.Accuracy(rtol=1e-6, steps_per_period=6.0).steps_per_period == 6.0
        with pytest.raises(SolverError, match="steps_per_period"):
            rf.Accuracy(substeps="fewest", steps_per_period=6.0)

    def test_substeps_resolve_the_fastest_vibration(self):
        counts = []
        for frequency_ratio in (10, 20, 40, 80, 160):
            stiff = rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=0.1)
            response = rf.System(block(), stiff).simulate(
                rf.GroundMotion.from_arrays((np.zeros(11), "m/s^2"), "0.02 s"), accuracy="fast"
            )
            counts.append(response.attrs["solver_substeps"])
        assert counts[0] >= 1
        for count, following in itertools.pairwise(counts):
            assert 2 * count - 1 <= following <= 2 * count

    @pytest.mark.parametrize("substeps", [3, "fewest"])
    def test_substeps_apply_without_a_motion(self, substeps):
        response = rf.System(block(), pads()).simulate(
            duration="2 s", accuracy=rf.Accuracy(substeps=substeps)
        )
        expected = 200 * response.attrs["solver_substeps"]
        assert response.attrs["solver_steps"] == expected

    def test_own_settings_are_used(self):
        own = rf.Accuracy(rtol=3e-9)
        response = rf.System(block(), pads()).simulate(pulse(), accuracy=own, outputs=None)
        assert response.attrs["solver_rtol"] == 3e-9


# motion ------------------------------------------------------------------------------------------


def test_simulate_motion_overrides_motion_of_the_system():
    system = rf.System(block(), pads(), pulse())
    other = rf.GroundMotion.sine_pulse("-1 m/s^2")
    response = system.simulate(other)
    assert response.attrs["motion_sha256"] == other.sha256
    assert abs(response.ground_acceleration.values).max() == pytest.approx(1.0)


def test_run_duration_follows_duration_and_free_vibration():
    system = rf.System(block(), pads())
    for options, length in (
        ({}, 1.0),
        ({"free_vibration": "0.5 s"}, 1.5),
        ({"duration": "0.25 s"}, 0.25),
        ({"duration": "3 s"}, 3.0),
    ):
        response = system.simulate(pulse(), output_step="0.25 s", **options)
        np.testing.assert_array_equal(
            response.time.values, np.arange(round(length / 0.25) + 1) * 0.25
        )
        assert response.attrs["solver_end_time"] == pytest.approx(length, rel=1e-12)
    still = system.simulate(free_vibration="2 s", output_step="1 s")
    assert still.time.values.tolist() == [0.0, 1.0, 2.0]


def test_downward_acceleration_beyond_gravity_on_rigid_ground_warns():
    flat = np.zeros(101)
    for lowest, warned in ((-9.0, False), (-10.0, True)):
        upwards = flat.copy()
        upwards[40:60] = lowest
        motion = rf.GroundMotion.from_arrays((flat, "m/s^2"), "10 ms", vertical=(upwards, "m/s^2"))
        if not warned:
            rf.System(block()).simulate(motion)
            continue
        with pytest.warns(ModelWarning, match="leave the rigid ground") as caught:
            rf.System(block()).simulate(motion)
        assert caught[0].filename == __file__
        rf.System(block(), pads()).simulate(motion)


@pytest.mark.parametrize(
    ("option", "chosen", "useless", "useful"),
    [
        ("coupling", "cascade", (block(), cap(), soil()), (block(), pads(), cap(), soil())),
        ("restraint", "centre", (block(), rf.RigidGround()), (block(), pads())),
        ("sliding", "checked", (block(), pads()), (block(), pads(friction=0.3))),
    ],
)
def test_options_without_effect_warn(option, chosen, useless, useful):
    with pytest.warns(ModelWarning, match=f"{option}='{chosen}' changes nothing here") as caught:
        rf.System(*useless, **{option: chosen})
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert rf.System(*useful, **{option: chosen}).assembly.setting_cautions == []
    assert rf.System(*useless).assembly.setting_cautions == []


@pytest.mark.parametrize(
    "tie",
    [
        rf.Tendon(stiffness="5 MN/m", brittle=True),
        rf.Restrainer(on=("-0.5 m", "2 m"), to=("-1 m", "2 m"), stiffness="1 MN/m", brittle=False),
    ],
)
def test_brittle_option_without_strength_warns(tie):
    with pytest.warns(ModelWarning, match=f"brittle={tie.brittle} changes nothing") as caught:
        rf.System(block(), tie)
    assert len(caught) == 1
    assert rf.System(block(), tie.replace(strength="20 kN")).assembly.setting_cautions == []
    assert rf.System(block(), tie.replace(brittle=not tie.brittle)).assembly.setting_cautions == []
