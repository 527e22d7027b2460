"""Verdicts of parts of a sweep, and summaries of messages of many cases."""

import numpy as np
import pytest
import xarray as xr
from stored_sweep import assert_identical

import rockframe as rf
from rockframe.errors import ModelWarning
from rockframe.studies.sweeps.labelling import (
    MAX_SIMILAR_TEXTS,
    merge_similar_texts,
    warn_of_missing_results,
)
from rockframe.units.display import with_superscripts

BLOCK = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
PULSE = rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
MOTIONS = {"weak": PULSE, "strong": PULSE.scaled(3)}


@pytest.fixture(scope="module")
def runs():
    return rf.sweep(rf.System(BLOCK), MOTIONS, scale=[0.5, 1.0, 2.0, 4.0], free_vibration="3 s")


def test_subset_of_a_sweep_has_its_own_verdict(runs, tmp_path):
    falls = int(runs.overturned.sum())
    assert 0 < falls < 8
    sentence = f"Of all 8 cases of the sweep {falls} overturned and {8 - falls} did not."
    assert runs.verdict == runs.rockframe.verdict == sentence
    runs.to_netcdf(tmp_path / "runs.nc")
    with xr.open_dataset(tmp_path / "runs.nc") as read:
        for study in (runs, read.load()):
            for part in (
                study.isel(scale=[0, 1]), study.sel(motion="strong"), study.isel(scale=0, motion=1),
                study.sortby("scale", ascending=False).isel(scale=slice(0, 3)),
            ):  # fmt: skip
                down = int(part.overturned.sum())
                count = part.overturned.size
                own = f"Of {count} of the 8 cases of the sweep {down} overturned and {count - down}"
                assert part.rockframe.verdict == f"{own} did not."
                assert part.rockframe.verdict in part.rockframe.summary
                assert part.attrs["verdict"] == sentence  # it is still true
    assert runs.transpose().rockframe.verdict == sentence
    assert runs.mean("motion", keep_attrs=True).rockframe.verdict == sentence
    twice = rf.concat([runs, runs], "run")
    assert twice.rockframe.verdict == ""
    assert "case_count" not in twice.attrs


def test_cases_that_were_masked_are_not_counted(runs):
    selected = runs.isel(scale=slice(3))
    for masked in (runs.where(runs.scale < 3), runs.reindex(scale=[0.5, 1.0, 2.0, 3.0])):
        assert masked.rockframe.verdict == selected.rockframe.verdict
        assert (
            masked.isel(scale=[1, 3]).rockframe.verdict
            == selected.isel(scale=[1]).rockframe.verdict
        )
    assert runs.where(runs.scale > 0).rockframe.verdict == runs.verdict


def test_figure_of_a_subset_is_titled_with_its_verdict():
    axes = pytest.importorskip("matplotlib.pyplot")
    sample = rf.probability_of_overturning(
        rf.System(BLOCK), MOTIONS, spread={"scale": ("lognormal", 1.0, 0.4)}, cases=20
    )
    for part, words in ((sample, sample.verdict), (sample.isel(case=slice(15)), "Of 15 of the 20")):
        panels = part.rockframe.plot()
        assert words[:30] in " ".join(panels[0].figure.get_suptitle().split())
        axes.close(panels[0].figure)


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
def test_messages_of_many_cases_are_merged(tmp_path):
    system = rf.System(BLOCK, rf.RigidGround(friction=0.1), sliding="checked")
    scales = np.linspace(0.5, 1.3, 6 * MAX_SIMILAR_TEXTS)

    def swept(**how):
        return rf.sweep(system, PULSE, scale=scales, free_vibration="5 s", **how)

    with pytest.warns(ModelWarning, match=r"message of \d\d of them: .* 0\.1"):
        many = swept()
    assert len(set(many.message.values.ravel())) <= 1 + MAX_SIMILAR_TEXTS
    few = rf.sweep(system, PULSE, scale=scales[:3], free_vibration="5 s")
    assert len(set(few.message.values.ravel())) == 3
    one = few.message.values[0, 0]
    text = many.message.values[-1, 0]
    assert " to " in text
    for message in (text, one):
        assert message.startswith("the block would slide from ")
        assert ", has 0.1, too little for " in message
    for rows in (many.to_dataframe(), rf.table(many)):
        assert len(rows) == len(scales)
        assert rows["message"].tolist() == many.message.values.ravel().tolist()
    assert "message" not in many.mean("scale").variables  # texts have no mean
    assert_identical(swept(chunk=5), many)
    assert_identical(swept(chunk=7, store=tmp_path / "study"), many)


def test_warning_quotes_the_most_frequent_caution():
    for texts, caution in (
        (["none", "slides beyond", "soft", "soft", "none"], "3 .*; message of 2 of them: soft"),
        (["soft", "slides 3 m", "slides 1 m", "none", "soft 1"], "4 .* of 2 .* slides 1 to 3 m$"),
        (["soft", "slides 3 m", "none", "none", "none"], "2 of 5 .* message of 1 of them: soft"),
    ):
        values = {"status": np.zeros(5), "peak_rotation": np.zeros(5), "message": np.array(texts)}
        runs = xr.Dataset({name: ("case", some) for name, some in values.items()})
        with pytest.warns(ModelWarning, match=caution):
            warn_of_missing_results(runs, ())


def test_similar_messages_are_merged_into_ranges():
    texts = [
        "none",
        *(f"x2: {k / 10} m at {9 - k:.1e} s, Eq. (6)" for k in range(MAX_SIMILAR_TEXTS + 1)),
    ]
    message = np.array([3, 0, 5, 1, len(texts) - 1])
    few, places = merge_similar_texts(texts, message)
    assert few == ("none", "x2: 0.0 to 1.6 m at -7.0e+00 to 9.0e+00 s, Eq. (6)")
    assert places.tolist() == [1, 0, 1, 1, 1]
    assert merge_similar_texts(texts[:-1], message[:-1])[0] == tuple(texts[:-1])


def test_subset_of_a_fragility_has_its_own_verdict():
    runs = rf.sweep(
        rf.System(BLOCK), MOTIONS, scale=[1.0, 2.0, 4.0, 6.0], width=["0.5 m", "0.8 m"],
        free_vibration="2 s",
    )  # fmt: skip
    found = rf.fragility(runs, "PGA", limits=[0.3])
    assert found.rockframe.verdict == found.verdict
    assert "(2 structures by width)" in found.verdict
    one = found.isel(width=0)
    assert "structures" not in one.rockframe.verdict
    assert one.isel(limit_state=0).rockframe.verdict.count("rotation 0.3") == 1
    assert found.verdict in found.rockframe.summary


def test_figure_and_report_of_a_part_of_annual_rates_have_its_verdict(tmp_path):
    motions = [rf.GroundMotion.stochastic(6.5, "10 km", seed=k).scaled(2) for k in range(4)]
    runs = rf.sweep(rf.System(BLOCK), motions, scale=[1, 2, 3, 4], width=["0.5 m", "0.6 m"])
    hazard = {"intensity": ([0.1, 1.0, 10.0, 100.0], "m/s^2"), "rate": [1.0, 1e-2, 1e-5, 1e-9]}
    found = rf.fragility(runs, "PGA", limits=[0.3])
    rates = rf.annual_rate(found, hazard)
    assert rates.rockframe.verdict == rates.verdict
    for part, alone in (
        (rates.isel(width=0), found.isel(width=0)),
        (rates.isel(width=[1]), found.isel(width=1)),
        (rates.isel(width=1, limit_state=0), found.isel(width=1, limit_state=[0])),
    ):
        expected = rf.annual_rate(alone, hazard).verdict
        assert part.rockframe.verdict == expected != rates.verdict
        title = rf.plot.annual_rate(part).figure.get_suptitle()
        assert " ".join(title.split()) == with_superscripts(expected)
    assert with_superscripts(expected) in rf.report(part, tmp_path / "rates.html").read_text()
    without = rates.isel(width=0, quantile=0)  # what the verdict states
    assert without.rockframe.verdict == rates.verdict


def test_tradeoff_verdict_equals_the_recommendation():
    rungs = rf.tradeoff(rf.System(BLOCK), MOTIONS["strong"], accuracies=["fast"], repeats=1)
    assert rungs.verdict == rf.recommend(rungs).sentence == rungs.rockframe.verdict


def test_verdict_states_slips_in_metres_whatever_their_unit():
    system = rf.System(BLOCK, rf.RigidGround(friction=0.2))
    runs = rf.sweep(system, PULSE, scale=[1.0, 2.0], free_vibration="1 s", progress=False)
    shown = runs.assign(peak_slip=(1e3 * runs.peak_slip).assign_attrs(units="mm"))
    part = runs.isel(scale=[1]).rockframe.verdict
    assert "1 slid, by 0." in part
    assert shown.isel(scale=[1]).rockframe.verdict == part
    joined = rf.concat([shown.isel(scale=[k]) for k in (0, 1)], "scale")
    assert joined.rockframe.verdict == runs.attrs["verdict"]
