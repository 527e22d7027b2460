"""Motions of the stochastic model: arguments, recipe, reproducibility."""

import json
import pickle

import numpy as np
import pytest

from rockframe.errors import ComponentError, ModelWarning, UnitsError
from rockframe.motion import GroundMotion
from rockframe.motion.stochastic import Site, exponential_window, fade_window, normal_numbers

ALL = {
    "stress_drop": "150 bar",
    "shear_wave_velocity": "3.2 km/s",
    "density": "2.6 t/m^3",
    "quality_factor": 200,
    "quality_exponent": 0.5,
    "kappa": "40 ms",
    "site": Site.ROCK_620,
    "vertical": 0.6,
    "time_step": "0.01 s",
}


def draw(magnitude=5.0, distance="20 km", seed=1, **others):
    return GroundMotion.stochastic(magnitude, distance, seed, **others)


# reproducibility ---------------------------------------------------------------------------------


def test_the_same_seed_gives_the_same_motion():
    assert draw(seed=7) == draw(seed=7)
    assert np.array_equal(draw(seed=7).si.horizontal.samples, draw(seed=7).si.horizontal.samples)


def test_another_seed_gives_another_motion():
    digests = {draw(seed=seed).sha256 for seed in (0, 1, 2, 2**40, 10**30)}
    assert len(digests) == 5


def test_random_numbers_are_reproducible_across_versions():
    numbers = [normal_numbers(4, seed=1, stream=stream) for stream in (0, 1)]
    expected = [
        [0.52162579, -0.93717015, 0.37217449, -0.46713293],
        [-0.06078676, 0.25487041, -0.69003457, -0.75411062],
    ]
    np.testing.assert_allclose(numbers, expected, atol=1e-8)


@pytest.mark.parametrize("others", [{}, {"vertical": 0.5}, ALL])
def test_description_rebuilds_motion(others):
    motion = draw(**others)
    description = json.loads(json.dumps(motion.to_dict()))
    assert description["constructor"] == "stochastic"
    rebuilt = GroundMotion.from_dict(description)
    assert rebuilt == motion
    assert rebuilt.to_dict() == motion.to_dict()


def test_description_rebuilds_processed_motion():
    motion = draw().scaled(peak="0.3 g_0").window("1 s", "9 s")
    assert GroundMotion.from_dict(motion.to_dict()) == motion


def test_motion_survives_dataset_and_pickle_round_trips():
    motion = draw(**ALL)
    stored = GroundMotion.from_dataset(motion.to_dataset())
    assert stored == motion
    assert stored.to_dict() == motion.to_dict()
    assert pickle.loads(pickle.dumps(motion)) == motion  # noqa: S301


def test_name_metadata_and_history_describe_motion():
    motion = draw(6.5, "15 km", 3, vertical=0.6)
    assert motion.name == "stochastic motion, magnitude 6.5 at 15 km, rock 760, seed 3"
    assert motion.metadata["magnitude"] == 6.5
    assert motion.metadata["distance"] == "15000.0 m"
    assert motion.metadata["seed"] == 3
    assert "Boore (2003)" in motion.metadata["model"]
    (sentence,) = motion.history
    for words in ("magnitude 6.5", "seed 3", "stress drop 10000000.0 Pa", "vertical 0.6"):
        assert words in sentence


# arguments ---------------------------------------------------------------------------------------


def test_units_of_the_arguments_do_not_matter():
    metric = draw(distance="20 km", stress_drop="10 MPa", kappa="0.035 s")
    other = draw(distance="20000 m", stress_drop="100 bar", kappa="35 ms")
    np.testing.assert_allclose(
        other.si.horizontal.samples, metric.si.horizontal.samples, rtol=1e-9, atol=1e-12
    )


def test_defaults_are_as_documented():
    assert draw() == draw(
        stress_drop="10 MPa",
        shear_wave_velocity="3500 m/s",
        density="2720 kg/m^3",
        quality_factor=180,
        quality_exponent=0.45,
        kappa="0.035 s",
        site="rock 760",
        source="one corner",
        time_step="0.005 s",
    )


@pytest.mark.parametrize("site", list(Site))
def test_site_accepts_enum_or_string(site):
    assert draw(site=site) == draw(site=str(site))


def test_time_step_argument_is_used():
    motion = draw(time_step="0.01 s")
    assert motion.si.time_step == 0.01
    assert motion.si.duration == pytest.approx(draw().si.duration, abs=0.03)


def test_vertical_component():
    motion = draw(vertical=0.5)
    assert draw().si.vertical is None
    assert np.array_equal(motion.si.horizontal.samples, draw().si.horizontal.samples)
    assert motion.si.vertical.samples.size == motion.si.horizontal.samples.size
    double = draw(vertical=1.0)
    np.testing.assert_allclose(
        double.si.vertical.samples, 2.0 * motion.si.vertical.samples, rtol=1e-14
    )
    assert not np.array_equal(double.si.vertical.samples, double.si.horizontal.samples)


def test_seed_accepts_numpy_integer():
    motion = draw(seed=np.int64(7))
    assert motion == draw(seed=7)
    assert type(motion.metadata["seed"]) is int


@pytest.mark.parametrize("seed", [-1, 1.0, True, "1", None])
def test_bad_seed(seed):
    with pytest.raises(ComponentError, match="seed must be a whole number, 0 or more"):
        draw(seed=seed)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"magnitude": 2.9}, "magnitude must be from 3 to 8.5"),
        ({"magnitude": 8.6}, "magnitude must be from 3 to 8.5"),
        ({"magnitude": float("nan")}, "magnitude must be finite"),
        ({"distance": "0 km"}, "distance must be above 0 and at most 1000 km"),
        ({"distance": "-3 km"}, "distance must be above 0"),
        ({"distance": "1001 km"}, "at most 1000 km"),
        ({"stress_drop": "0 MPa"}, "stress_drop must be greater than zero"),
        ({"shear_wave_velocity": "-1 km/s"}, "shear_wave_velocity must be greater than zero"),
        ({"density": "0 kg/m^3"}, "density must be greater than zero"),
        ({"quality_factor": 0}, "quality_factor must be greater than zero"),
        ({"quality_exponent": 1.1}, "quality_exponent must be from 0 to 1"),
        ({"kappa": "-1 ms"}, "kappa must be zero or more"),
        ({"vertical": 0.0}, "vertical must be greater than zero"),
        ({"time_step": "0.1 s"}, "time_step must be from 0.0005 s to 0.02 s"),
        ({"time_step": "1 us"}, "time_step must be from 0.0005 s to 0.02 s"),
        ({"site": "swamp"}, "site must be 'rock 760' or 'rock 620', got 'swamp'"),
        ({"stress_drop": "1 mPa"}, "implausible"),
    ],
)
def test_values_out_of_range(arguments, words):
    with pytest.raises(ComponentError, match=words):
        draw(**arguments)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"distance": 20.0}, "distance='15 km'"),
        ({"distance": "20 s"}, "distance needs a distance"),
        ({"magnitude": "6 m"}, "magnitude needs a pure ratio"),
        ({"magnitude": True}, "magnitude needs a pure ratio"),
        ({"stress_drop": 100}, "stress_drop='10 MPa'"),
        ({"shear_wave_velocity": "3500 m"}, "shear_wave_velocity needs a velocity"),
        ({"density": "2.7"}, "density needs a density"),
        ({"kappa": 0.035}, "kappa='0.035 s'"),
        ({"time_step": 0.005}, "time_step='0.005 s'"),
    ],
)
def test_wrong_units(arguments, words):
    with pytest.raises(UnitsError, match=words):
        draw(**arguments)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"magnitude": 8.2, "time_step": "0.02 s"}, "magnitude = 8.2 is beyond 8"),
        ({"distance": "300 km"}, "distance = 300 km is beyond 270 km"),
    ],
)
def test_arguments_beyond_calibration_warn(arguments, words):
    with pytest.warns(ModelWarning, match=words):
        draw(**arguments)


# parts -------------------------------------------------------------------------------------------


def test_exponential_window_has_specified_peak_and_end():
    window = exponential_window(10.0, 0.001)
    assert window[0] == 0.0
    assert window.max() == pytest.approx(1.0, abs=1e-12)
    assert window.argmax() == 2000
    assert window[-1] == pytest.approx(0.05, rel=1e-9)


def test_random_numbers_are_normal():
    numbers = normal_numbers(200_000, seed=5, stream=0)
    assert np.mean(numbers) == pytest.approx(0.0, abs=4.0 / np.sqrt(2e5))
    assert np.var(numbers) == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / 2e5))
    assert np.mean(numbers**4) == pytest.approx(3.0, abs=4.0 * np.sqrt(96.0 / 2e5))


def test_streams_are_independent():
    across, upwards, other = (
        normal_numbers(100_000, seed, stream) for seed, stream in ((3, 0), (3, 1), (4, 0))
    )
    bound = 4.0 / np.sqrt(1e5)
    assert abs(np.mean(across * upwards)) < bound
    assert abs(np.mean(across * other)) < bound
    assert abs(np.mean(across[1:] * across[:-1])) < bound


def test_fade_window_matches_its_derivatives():
    step, slope, curvature = fade_window(2001, 400, 0.01)
    for values in (step, slope, curvature):
        assert values[0] == values[-1] == 0.0
    assert np.all(step[400:-400] == 1.0)
    np.testing.assert_array_equal(step, step[::-1])
    np.testing.assert_allclose(np.gradient(step, 0.01)[1:-1], slope[1:-1], atol=2e-4)
    np.testing.assert_allclose(np.gradient(slope, 0.01)[1:-1], curvature[1:-1], atol=3e-3)
