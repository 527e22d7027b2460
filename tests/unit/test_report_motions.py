"""Reports: spectra of motions and their target, records, and checks by codes."""

import re
import warnings
from html import unescape

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, RecordWarning, RockframeWarning
from rockframe.reports import motions as in_reports
from rockframe.results.schema import SCHEMA
from rockframe.units.display import display_units

pytestmark = [pytest.mark.unit, pytest.mark.usefixtures("no_pictures")]

BLOCK = rf.System(rf.Block(width="0.6 m", height="2.4 m", mass="1 t"))
TARGET = rf.TargetSpectrum.eurocode_8("0.2 g_0", "B")
KNOWN = {"event": "Irpinia <1980>", "station": "Sturno", "component": "N270", "magnitude": 6.9}


def record(seed):
    """Return a sampled motion with some metadata."""
    motion = rf.GroundMotion.stochastic(6.5, "15 km", seed=seed).window("4 s", "16 s")
    known = {} if seed == 0 else {**KNOWN, "station": f"Sturno {seed}"}
    return rf.GroundMotion(motion.si, name=f"record {seed}", metadata=known)


@pytest.fixture(scope="module")
def suite():
    motions = rf.MotionSuite({f"record {seed}": record(seed) for seed in range(4)})
    return motions.scaled_to(TARGET, bounds=None)


@pytest.fixture(scope="module")
def runs(suite):
    return rf.sweep(BLOCK, motions=suite, accuracy="fast")


def text_of(path):
    html = path.read_text(encoding="utf-8").split("</style>", 1)[1]
    return " ".join(unescape(re.sub(r"<[^>]*>", " ", html)).split())


def section_cells(path, section):
    """Return the cells of the tables of a section."""
    inner = path.read_text(encoding="utf-8").split(f"<h2>{section}</h2>", 1)[1].split("<h2>")[0]
    lines = re.findall(r"<tr>(.*?)</tr>", inner, re.DOTALL)
    return [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", line) for line in lines]


def test_scaled_suite_carries_its_target(suite):
    seconds = np.geomspace(0.1, 4.0, 40)
    with pytest.warns(RecordWarning, match="no motion has a vertical component"):
        level = suite.with_verticals()
    for one in (suite, suite.only(["record 1"]), suite.sort("station"), level):
        assert one.target.name == TARGET.name
        assert one.target.limits == pytest.approx((0.1, 4.0))
        target = TARGET.at((seconds, "s"))
        assert one.target.at((seconds, "s")) == pytest.approx(target, rel=1e-12)
    assert suite.changed(lambda motion: motion.scaled(2.0)).target is None
    assert rf.MotionSuite(dict(suite)).target is None
    chosen = suite.chosen_for(TARGET, 2, bounds=None, periods=["0.3 s", "0.5 s", "1 s"])
    assert chosen.target.limits == (0.3, 1.0)
    near = suite.only(["record 1"]).matched(TARGET, periods=("0.2 s", "1 s"), tolerance=0.2)
    assert near.target.limits == (0.2, 1.0)
    assert near.target.at(["0.7 s"]) == TARGET.at(["0.7 s"])


def test_report_compares_records_with_their_target(runs, suite, tmp_path):
    path = rf.report(runs, tmp_path / "r.html", motions=suite, units={"acceleration": "g_0"})
    words = text_of(path)
    assert TARGET.name.endswith("ground B, 1.961 m/s^2")
    assert "ground B, 0.2 g. Compared at 40 periods from 0.1 s" in words
    assert "Response spectra of the motions at 5 % damping, their mean, and the target" in words
    head, *rows = section_cells(path, "Ground motions")
    assert head == ["motion", "event", "magnitude", "station", "component", "scale factor",
                    "peak ground acceleration [g]", "spectral misfit"]  # fmt: skip
    for row, (label, motion) in zip(rows, suite.items(), strict=True):
        peak = motion.si.peak / 9.80665
        known = motion.metadata
        of_record = ["-"] * 4
        if label != "record 0":
            of_record = ["Irpinia &lt;1980&gt;", "6.9", f"Sturno {label[-1]}", "N270"]
        # the misfit is computed anew from the current motions
        numbers = [f"{known['scale_factor']:.4g}", f"{peak:.4g}", f"{known['spectral_misfit']:.4g}"]
        assert row == [label, *of_record, *numbers]
    seconds = (np.geomspace(0.1, 4.0, 40), "s")
    spectra = suite.response_spectrum(seconds).pseudo_spectral_acceleration.squeeze()
    over = spectra.mean("motion") / TARGET.at(seconds)
    sentence = (
        f"The mean of the motions is {float(over.min()):.3g} to {float(over.max()):.3g} times"
    )
    assert sentence in words


@pytest.mark.wide
def test_report_target_is_accepted_in_three_forms(runs, suite, tmp_path):
    raw = rf.MotionSuite(dict(suite))
    found = raw.scaling_to(TARGET, periods=["0.5 s", "1 s", "2 s"], bounds=None)
    path = tmp_path / "r.html"
    assert "Compared at 3 periods from 0.5 s to 2 s" in text_of(rf.report(runs, path, target=found))
    assert "Compared at 40 periods from 0.1 s" in text_of(rf.report(runs, path, target=TARGET))
    without = text_of(rf.report(runs, path))
    assert "Target:" not in without
    assert "Response spectra of the motions at 5 % damping, their mean." in without
    assert "spectral misfit" not in without
    for wrong in ("Eurocode 8", raw.response_spectrum(["1 s"])):
        with pytest.raises(ComponentError, match="target must be a TargetSpectrum, or the result"):
            rf.report(runs, path, target=wrong)
    scale = rf.critical_scale(BLOCK, record(9), largest=1.0, runs=2, scales=2)
    with pytest.warns(RockframeWarning, match="no motion is available to compare with the target"):
        rf.report(scale, path, target=TARGET)
    with pytest.raises(ComponentError, match="motions must be a GroundMotion, or several"):
        rf.report(runs, path, motions=3.5)
    with pytest.raises(ComponentError, match="no motion with the samples of 'record 9'"):
        rf.report(runs, path, motions=[record(9)])
    with pytest.raises(ComponentError, match="a study takes motions="):
        rf.report(runs, path, motion=record(9))
    run = BLOCK.simulate(record(9))
    with pytest.raises(ComponentError, match="a run takes motion="):
        rf.report(run, path, motions=[record(9)])


@pytest.mark.long
def test_records_of_a_reopened_study_can_be_passed_to_the_report(suite, tmp_path, monkeypatch):
    gravity = ["9.8 m/s^2"]
    runs = rf.sweep(BLOCK, motions=suite, gravity=gravity, accuracy="fast", store=tmp_path / "kept")
    runs.to_netcdf(tmp_path / "runs.nc")
    forgotten = {}
    monkeypatch.setattr("rockframe.studies.sweeps.study._cache", forgotten)
    with xr.open_dataset(tmp_path / "runs.nc") as read:
        read.load()
    path = tmp_path / "r.html"
    bare = text_of(rf.report(read, path))
    assert "Ground motions" not in bare
    assert "The worst case in full" not in bare
    assert re.search("The worst case Not simulated again; .* must be given, as motions=", bare)
    assert "Scene Values of the scene from which the cases differ in: gravity." in bare
    assert "as motions= or, in a shell, by --motions." in bare
    expected = text_of(rf.report(read, path, motions=suite))
    assert "Compared at 40 periods" in expected
    assert "The worst case in full" in expected
    few = text_of(rf.report(read, path, motions=suite.only(["record 2"])))
    assert "Sturno 2" in few
    assert "Sturno 3" not in few
    text = text_of(rf.report(rf.open_study(tmp_path / "kept"), path))  # with its records
    assert "Sturno 3" in text
    assert "The worst case in full" in text


def test_records_of_unlike_time_steps_are_reported_with_their_forces(tmp_path):
    steps = ("0.01 s", "0.02 s", "0.015 s")
    motions = {f"R{k}": record(k).resampled(step) for k, step in enumerate(steps)}
    sentence = "time steps from 0.01 s to 0.02 s; histories are kept every 0.01 s for all of them"
    with pytest.warns(RecordWarning, match=sentence):
        runs = rf.sweep(BLOCK, motions, scale=[3.0], outputs=["base_shear"])
    assert np.diff(runs.time) == pytest.approx(0.01, rel=1e-9)
    for name, motion in motions.items():
        alone = BLOCK.simulate(motion.scaled(3.0), outputs=["base_shear"], output_step="0.01 s")
        case = runs.sel(motion=name, scale=3.0)
        shear = case.base_shear.to_numpy()
        assert shear[: alone.time.size] == pytest.approx(alone.base_shear.to_numpy(), rel=1e-9)
        assert float(case.peak_base_shear) == float(alone.peak_base_shear)
    with pytest.warns(RecordWarning, match=r"3 of 3 records are sampled every 0\.01 s to 0\.02 s"):
        path = rf.report(runs, tmp_path / "r.html", motions=motions, units={"force": "kN"})
    html = text_of(path)
    assert "peak base shear [kN]" in html
    assert "The worst case in full Simulated again: scale 3, motion R" in html
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rf.sweep(BLOCK, motions, outputs=["base_shear"], output_step="0.02 s")


def test_a_run_has_its_record_and_its_target(suite, tmp_path):
    run = BLOCK.simulate(suite["record 3"])
    path = rf.report(run, tmp_path / "r.html", motion=suite["record 3"], target=TARGET,
                     certify=False)  # fmt: skip
    words = text_of(path)
    for phrase in ("Spectrum and target", "station Sturno 3", "component N270",
                 f"scale factor {suite['record 3'].metadata['scale_factor']:.4g}"):  # fmt: skip
        assert phrase in words, phrase


def test_report_of_joined_runs_accepts_motions(suite, tmp_path):
    runs = rf.concat([BLOCK.simulate(one, outputs=None) for one in suite.values()], "motion",
                     list(suite))  # fmt: skip
    assert "Sturno 2" in text_of(rf.report(runs, tmp_path / "r.html", motions=suite))


def test_record_columns_exist_in_the_schema():
    assert set(in_reports.RECORD_COLUMNS) <= set(SCHEMA)


@pytest.fixture(scope="module")
def check():
    return rf.codes.circolare_2019(BLOCK, rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz"))


def test_report_includes_code_checks(check, tmp_path):
    run = BLOCK.simulate(rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz"))
    cabinet = rf.codes.asce_7_22(rf.Block(width="0.6 m", height="1.8 m", mass="300 kg"),
                                 spectral_acceleration=1.0)  # fmt: skip
    units = {"force": "kN", "length": "mm"}
    path = rf.report(run, tmp_path / "r.html", checks=[check, cabinet], certify=False, units=units)
    convert = display_units(units, owner="a test").convert_text
    words = text_of(path)
    above = words.split("Response")[0]
    assert "Did not overturn" in above
    for one in (*check.verdicts, *cabinet.verdicts):
        result = "satisfied" if one.passed else "not satisfied"
        assert f"{one.title}: {result} {convert(one.words)} [{one.source}]" in above
    rows = {row[0]: row for row in section_cells(path, "Check by Circolare C.S.LL.PP. 21 January"
            " 2019") if row}  # fmt: skip
    assert rows["alpha_0"][1:] == ["0.25", "activation multiplier, sum(P d_Py)/sum((P + Q) d_PQx)",
                                   "C8.7.1.1"]  # fmt: skip
    assert rows["d_SLV"][1] == f"{1e3 * check.value('d_SLV'):.6g} mm"
    assert rows["T_SLC"][3] == "C8.7.1.11"
    assert "Checked: Block(width='600 mm', height='2400 mm', mass='1000.0 kg')" in words
    force = {row[0]: row for row in section_cells(path, "Check by ASCE/SEI 7-22") if row}["F_p"]
    assert force[1] == f"{cabinet.value('F_p') / 1e3:.6g} kN"
    for wrong in ("circolare_2019", [3.5], 3.5):
        with pytest.raises(ComponentError, match=r"checks must be of rf\.codes"):
            rf.report(run, path, checks=wrong)


def test_study_report_includes_code_checks(runs, check, tmp_path):
    words = text_of(rf.report(runs, tmp_path / "r.html", checks=check))
    above = words.split("Cases")[0]
    assert "No case overturned" in above
    assert "kinematic, SLV: " in above
    assert "C8.7.1.2.1.9" in words
