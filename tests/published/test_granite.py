"""Granite blocks on a shake table: the fit, and the numbers of the page."""

import json

import numpy as np
import pytest
from benchmarks import granite_fit as fit
from benchmarks.granite_blocks import ANGLES, Shaking, Shape, overturns, verdicts
from benchmarks.granite_programme import SPECIMENS, VARIABLE, programme_path, read_programme
from pages import DOCS, numbers_in, table
from scipy.special import expit

import rockframe as rf

PAGE = "validation_granite.md"
TABLES = "validation_granite.txt"
CONFUSION = (
    "| specimen | by | fell, as predicted | fell, predicted to stand | stood, predicted to fall "
    "| stood, as predicted | accuracy | balanced accuracy |"
)


def test_probability_of_blocks_below_one_angle_in_closed_form():
    falls = np.arange(len(ANGLES)) <= 7
    bound = 0.5 * np.log(ANGLES[7] * ANGLES[8])
    for median, spread in ((0.08, 0.1), (0.2, 0.3)):
        expected = expit((bound - np.log(median)) / spread)
        assert fit.shares(median, spread) @ falls == pytest.approx(expected, rel=1e-12)


@pytest.mark.long
def test_fit_recovers_known_block_from_its_verdicts():
    generator = np.random.default_rng(4)
    motions = [
        rf.GroundMotion.sine_pulse(f"{peak} m/s^2", f"{hertz} Hz", cycles)
        for peak, hertz, cycles in zip(
            9.80665 * np.geomspace(0.06, 0.8, 60)[generator.permutation(60)],
            generator.uniform(0.7, 4.0, 60),
            generator.integers(1, 4, 60).astype(float),
            strict=True,
        )
    ]
    shakings = [Shaking.by(motion) for motion in motions]
    pairs = np.array([(radius, eps) for radius in (0.15, 0.3) for eps in (0.75, 0.93)])
    truth = Shape(0.3, 0.11, 0.93)
    fell = overturns(truth, shakings)
    assert 15 < fell.sum() < 45
    tried = np.array([verdicts(tuple(pair), shakings) for pair in pairs.tolist()])
    groups = np.arange(60) // 3
    fitted = fit.Search.of(pairs, tried, groups, fell).best()
    assert fitted.shape.radius == truth.radius
    assert fitted.shape.restitution == truth.restitution
    assert fitted.shape.angle == pytest.approx(truth.angle, rel=0.06)
    assert fitted.spread < 0.06


def confusion():
    return {(row[0], row[1]): row[2:] for row in table(TABLES, CONFUSION)}


def test_sentences_agree_with_tables_and_data():
    confusions = confusion()
    for cells in confusions.values():
        hits, missed, false, stood = map(int, cells[:4])
        right = (hits + stood) / (hits + missed + false + stood)
        assert cells[4].split()[0] == f"{right:.3f}"
        balanced = 0.5 * (hits / (hits + missed) + stood / (false + stood))
        assert cells[5].split()[0] == f"{balanced:.3f}"
    reached = numbers_in(
        PAGE, "The blocks reach # on the tests that they were fitted to, and # on tests held out"
    )
    names = ("block, all tests", "block, held out")
    assert reached == [float(confusions["both", name][4].split()[0]) for name in names]
    falls = numbers_in(PAGE, "the first did # times, the second # times")
    assert falls == [sum(map(int, confusions[one, names[0]][:2])) for one in ("1", "2")]
    stored = json.loads((DOCS / "data" / "granite.json").read_text(encoding="utf-8"))
    middle = {
        name: sum(one["tests"] for one in stored[name] if 0.1 <= one["predicted"] < 0.9)
        for name in ("ensemble", "regressed")
    }
    tests = sum(one["tests"] for one in stored["ensemble"])
    sentence = "They leave # of # outcomes between 0.1 and 0.9, the regression #."
    assert numbers_in(PAGE, sentence) == [middle["ensemble"], tests, middle["regressed"]]
    for name in middle:
        assert all(one["low"] < one["predicted"] < one["high"] for one in stored[name])


def test_documented_verdicts_of_fitted_blocks_are_reproduced():
    path = programme_path()
    if not path.is_file():
        pytest.skip(f"the shake-table tests are not at {path} (set {VARIABLE})")
    programme = read_programme(path)
    shakings = [Shaking.by(motion) for motion in programme.motions]
    peak, velocity = programme.peaks()
    features = np.column_stack([np.log(peak), np.log(velocity / peak)])
    stored = json.loads((DOCS / "data" / "granite.json").read_text(encoding="utf-8"))["specimens"]
    confusions = confusion()
    for specimen in SPECIMENS:
        fell = programme.fell[specimen]
        coefficients = fit.regression(features, fell)
        by = {
            "block, all tests": overturns(Shape(**stored[str(specimen)]["shape"]), shakings),
            "regression, all tests": fit.regressed(coefficients, features) > 0.5,
        }
        for name, verdict in by.items():
            cells = confusions[str(specimen), name]
            assert list(map(str, fit.Confusion.of(verdict, fell))) == cells[:4]
            assert f"{fit.accuracy(verdict, fell):.3f}" == cells[4].split()[0]
            assert f"{fit.balanced_accuracy(verdict, fell):.3f}" == cells[5].split()[0]
