"""Reports: contents, and independence from other files."""

import datetime
import inspect
import re
import subprocess
from html.parser import HTMLParser
from shutil import which

import numpy as np
import pytest
import xarray as xr
from pages import read

import rockframe as rf
from rockframe.errors import (
    ComponentError,
    ModelWarning,
    RecordWarning,
    SchemaError,
    SolverWarning,
)
from rockframe.reports import cases, sections
from rockframe.reports.limits import LIMITS
from rockframe.reports.values import format_value
from rockframe.results.schema import SCHEMA
from rockframe.simulation.certify import certificate
from rockframe.simulation.run_arguments import MIN_RUNS
from rockframe.units.display import DisplayUnits

pytestmark = [pytest.mark.unit, pytest.mark.usefixtures("no_pictures")]


@pytest.fixture(autouse=True)
def short_certificates(monkeypatch):
    """Limit certificates of reports to the least number of runs."""
    defaults = inspect.unwrap(rf.Certification.__init__).__kwdefaults__
    monkeypatch.setitem(defaults, "runs", MIN_RUNS)


class Page(HTMLParser):
    """The tags of a page, their addresses, and its text."""

    def __init__(self, text):
        super().__init__()
        self.open, self.text, self.addresses, self.tags = [], "", [], set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)
        if tag not in ("meta", "img"):
            self.open.append(tag)
        self.addresses += [value for name, value in attrs if name in ("src", "href", "data")]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data if not self.open or self.open[-1] != "style" else ""


@pytest.fixture(scope="module")
def response():
    system = rf.System(rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"))
    pulse = rf.GroundMotion.sine_pulse("-5 m/s^2", "2 Hz")
    return system.simulate(pulse, free_vibration="5 s")


def test_report_is_complete_and_self_contained(response, tmp_path):
    path = rf.report(response, tmp_path / "r.html", title="Tower & bell")
    text = path.read_text(encoding="utf-8")
    page = Page(text)
    assert page.open == []
    assert page.addresses
    assert all(one.startswith("data:image/") for one in page.addresses)
    assert not {"script", "link", "iframe", "object"} & page.tags
    assert not re.search(r"url\(|@import", text)
    words = " ".join(page.text.split())
    for phrase in (
        "Tower & bell",
        response.attrs["verdict"],
        "Certificate: the verdict holds",
        "The body stands also with",  # the report certifies a run without a certificate
        "0.8 m",
        "5500 kg",
        "greatest absolute ground acceleration",
        "5 m s⁻²",
        "0.08213 rad (4.71°)",
        "Sliding",
        "Flight on rigid ground",
        response.attrs["motion_sha256"],
        f"rockframe {rf.__version__}",
    ):
        assert phrase in words, phrase
    assert "springs of the bed" not in words  # there is no soil


def test_report_states_missing_information(response, tmp_path):
    bare = rf.report(response, tmp_path / "bare.html", certify=False).read_text()
    assert "No certificate" in bare
    record = rf.GroundMotion.from_arrays(([0.0, 3.0, -3.0, 0.0] * 40, "m/s^2"), "0.01 s")
    system = rf.System.from_dict({**rf.System.from_dataset(response).to_dict(), "motion": None})
    short = system.simulate(record, outputs=None)
    text = rf.report(short, tmp_path / "short.html").read_text()
    assert "does not hold the samples of its motion" in text
    assert "has no histories" in text
    unknown = response.assign_attrs(system_json="{}")
    assert "does not describe its system" in rf.report(unknown, tmp_path / "u.html").read_text()


def test_overturned_run_under_a_record_is_certified_from_file(tmp_path):
    system = rf.System(rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"))
    shaking = 8.0 * np.sin(np.linspace(0.0, 30.0, 400)) * np.linspace(0.0, 1.0, 400)
    level = rf.GroundMotion.from_arrays((shaking, "m/s^2"), "0.02 s", name="a record")
    both = rf.GroundMotion.from_arrays(
        (shaking, "m/s^2"), "0.02 s", vertical=(0.5 * shaking, "m/s^2")
    )
    for motion in (level, both):
        run = system.simulate(motion)
        assert bool(run.overturned)
        assert float(run.time[-1]) < 7.9  # and the motion continues
        run.to_netcdf(tmp_path / "out.nc")
        with xr.open_dataset(tmp_path / "out.nc") as stored:
            assert rf.System.from_dataset(stored).motion == rf.GroundMotion.from_arrays(
                (shaking, "m/s^2"), "0.02 s", name=motion.name,
                **({"vertical": (0.5 * shaking, "m/s^2")} if motion is both else {}),
            )  # fmt: skip
            rf.report(stored, tmp_path / "out.html")
        assert "No certificate" not in (tmp_path / "out.html").read_text()
    assert rf.concat([run, run]).sizes == {"run": 2}
    assert "ground_acceleration_after_end [m s^-2]" not in rf.table(run)
    # a motion with other samples has another digest
    changed = run.assign(ground_acceleration_after_end=0.0 * run.ground_acceleration_after_end)
    with pytest.warns(RecordWarning, match="not what the run had"):
        assert rf.System.from_dataset(changed).motion is None


LONGER, BEYOND = {"free_vibration": "9 s"}, {"overturning": "continue"}


@pytest.mark.parametrize(
    ("parts", "options"),
    [
        ("rigid", LONGER),
        ("pads", BEYOND),
        pytest.param("sliding", LONGER, marks=pytest.mark.wide),
        pytest.param("rigid", BEYOND, marks=pytest.mark.long),
        pytest.param("sliding", BEYOND, marks=pytest.mark.long),
        pytest.param("pads", LONGER, marks=pytest.mark.long),
        pytest.param("stack", LONGER, marks=pytest.mark.long),
        pytest.param("stack", BEYOND, marks=pytest.mark.long),
    ],
)
def test_runs_that_overturned_under_a_record_are_certified(parts, options, tmp_path):
    scenes = {
        "rigid": (BLOCK,), "sliding": (BLOCK, rf.RigidGround(friction=0.5)), "pads": (BLOCK, PADS),
        "stack": (rf.Stack(BLOCK, rf.Block(width="1.2 m", height="1.2 m", mass="1 t"),
                           interfaces=[rf.RigidGround()]), PADS),
    }  # fmt: skip
    shaking = 9.0 * np.sin(np.linspace(0.0, 30.0, 400)) * np.linspace(0.2, 1.0, 400)
    record = rf.GroundMotion.from_arrays((shaking, "m/s^2"), "0.02 s", name="a record")
    run = rf.System(*scenes[parts]).simulate(record, **options)
    assert bool(run.overturned)
    run.to_netcdf(tmp_path / "out.nc")
    with xr.open_dataset(tmp_path / "out.nc") as stored:
        words = text_of_report(rf.report(stored, tmp_path / "out.html"))
    assert "verturned" in words  # a block that may slide "did not slide, overturned"
    assert "Certificate: the verdict" in words
    assert "No certificate" not in words


def test_report_of_a_coarsely_sampled_run_requests_its_motion(tmp_path):
    shaking = 9.0 * np.sin(np.linspace(0.0, 30.0, 400)) * np.linspace(0.2, 1.0, 400)
    record = rf.GroundMotion.from_arrays((shaking, "m/s^2"), "0.02 s", name="a record")
    coarse = rf.System(BLOCK, PADS).simulate(record, free_vibration="9 s", output_step="0.1 s")
    text = text_of_report(rf.report(coarse, tmp_path / "out.html"))
    assert "does not hold the samples of its motion; pass it by motion=" in text


ROUGH = {"frequency_ratio": 20, "damping_ratio": 0.1, "friction": 0.2}
SQUAT = rf.Block(width="0.8 m", height="1.6 m", mass="1 t")
PLINTH = rf.Block(width="1.2 m", height="1 m", mass="1 t")
TIE = rf.Restrainer(on=("-0.4 m", "1 m"), to=("-1.4 m", "1 m"), stiffness="20 kN/m", slack="5 mm")
SLIDING = {
    "rigid ground": (SQUAT, rf.RigidGround(friction=0.2)),
    "rigid ground, tied": (SQUAT, rf.RigidGround(friction=0.2), TIE),
    "pads": (SQUAT, rf.TwoSpringSupport(**ROUGH)),
    "pads, tied": (SQUAT, rf.TwoSpringSupport(**ROUGH), TIE),
    "soil": (SQUAT, rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2, friction=0.2)),
    "soil, tied": (SQUAT, rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2, friction=0.2), TIE),
    "stack": (rf.Stack(SQUAT, PLINTH, interfaces=[rf.TwoSpringSupport(**ROUGH)]),
              rf.TwoSpringSupport(**ROUGH)),
}  # fmt: skip


@pytest.mark.wide
@pytest.mark.parametrize("name", SLIDING)
def test_sliding_leads_the_verdict_of_runs_and_sweeps(name, tmp_path):
    system = rf.System(*SLIDING[name])
    pulse = rf.GroundMotion.sine_pulse("6 m/s^2", "1 Hz")
    run = system.simulate(pulse, free_vibration="3 s", output_step="0.02 s")
    text = rf.report(run, tmp_path / "r.html", certify=False).read_text()
    (banner,) = re.findall(
        r'<div class="verdict (\w+)"><strong>([^<]*did not [^<]*)</strong>', text
    )
    slid = r"[Ss]lid [\d.]+ m to the (left|right)( \([\d.]+ m( to the (left|right))? at most\))?"
    of_each = rf"Body 1 {slid}, body 2 {slid}" if name == "stack" else slid
    assert banner[0] == "doubt"
    assert re.fullmatch(rf"{of_each}, did not overturn", banner[1])
    assert run.attrs["verdict"].startswith(f"{banner[1]}: peak rotation ")
    assert "at the end" not in banner[1]
    residual = float(run.residual_slip)
    side = "right" if residual > 0.0 else "left"
    assert f"lid {abs(residual):.3g} m to the {side}" in banner[1]
    figure = np.atleast_1d(rf.plot.response(run))[0].figure
    title = figure.get_suptitle() or next(one.get_title() for one in figure.axes)
    assert title.replace("\n", " ").startswith(banner[1].split(" (")[0])
    runs = rf.sweep(system, pulse, scale=[0.05, 1.0], free_vibration="3 s", progress=False)
    farthest = float(run.get("peak_body_slip", run.peak_slip).max())
    assert runs.attrs["verdict"].endswith(f"; 1 slid, by {farthest:.3g} m at most.")
    text = rf.report(runs, tmp_path / "r.html").read_text()
    assert '<div class="verdict doubt"><strong>No case overturned, some slid</strong>' in text


@pytest.mark.wide
def test_report_states_overturning_after_sliding_and_would_slide(tmp_path):
    slim = rf.Block(width="0.5 m", height="2 m", mass="1 t")
    pulse = rf.GroundMotion.sine_pulse("9 m/s^2", "0.5 Hz")
    run = rf.System(slim, rf.RigidGround(friction=0.3)).simulate(pulse)
    text = rf.report(run, tmp_path / "r.html", certify=False).read_text()
    pattern = r'<div class="verdict bad"><strong>Slid [^<]*, overturned to the \w+ at [\d.]+ s<'
    assert re.search(pattern, text)
    held = rf.System(SQUAT, rf.RigidGround(friction=0.2), sliding="checked")
    with pytest.warns(rf.errors.ModelWarning, match="would slide"):
        run = held.simulate(pulse.scaled(0.5))
    text = rf.report(run, tmp_path / "r.html", certify=False).read_text()
    assert '<div class="verdict doubt"><strong>Did not overturn, but would slide<' in text


def test_a_certificate_near_a_boundary_is_shown_as_such(response):
    certified = response.assign(dict.fromkeys(("verdict_converged", "verdict_robust"), True))
    certified.attrs["certificate"] = certificate.NEAR_WORDS + ": the body stands, but ..."
    (shown,) = [
        one
        for one in sections.verdict_section(certified, "", DisplayUnits())
        if "Certificate" in one
    ]
    assert "the verdict holds, but near a boundary" in shown
    assert 'class="verdict doubt"' in shown


@pytest.mark.parametrize("doubted", ["verdict_converged", "verdict_robust"])
def test_certificate_holds_only_if_converged_and_robust(response, doubted):
    certified = response.assign(dict.fromkeys(("verdict_converged", "verdict_robust"), True))
    certified.attrs["certificate"] = "The body stands."
    assert "the verdict holds" in "".join(sections.verdict_section(certified, "", DisplayUnits()))
    assert "the verdict is in doubt" in "".join(
        sections.verdict_section(certified.assign({doubted: False}), "", DisplayUnits())
    )


def test_only_results_are_reported(response, tmp_path):
    measures = rf.measures.intensity_measures(rf.GroundMotion.sine_pulse())
    for value, words in (
        ("out.nc", "xr.open_dataset"),
        (measures, "no result of a run or of a study"),
        (response.drop_vars("overturned"), "no result of a run"),
    ):
        with pytest.raises(SchemaError, match=words):
            rf.report(value, tmp_path / "x.html")
    runs = rf.sweep(rf.System(BLOCK), SUITE, scale=[0.5, 3.0], duration="3 s", progress=False)
    with xr.set_options(keep_attrs=True), pytest.raises(SchemaError, match="found means of runs"):
        rf.report(runs.mean("scale"), tmp_path / "x.html")
    assert not (tmp_path / "x.html").exists()


UNITS = {"force": "kN", "angle": "deg", "length": "mm", "acceleration": "g_0", "moment": "kN m"}
PROJECT = {
    "object": "Bell <tower>",
    "checked_by": "C. Rossi",
    "date": datetime.date(2026, 11, 24),
    "conclusion": "It stands.",
    "assumptions": ["Sound masonry.", "A level floor."],
}
BLOCK = rf.Block(width="0.6 m", height="2.4 m", mass="1 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SUITE = {
    "long": rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz"),
    "short": rf.GroundMotion.sine_pulse("4 m/s^2", "3 Hz"),
}


def text_of_report(path):
    spaced = re.sub(r"</(td|th|strong|li)>", r" \g<0>", path.read_text(encoding="utf-8"))
    page = Page(spaced)
    assert page.open == []
    assert all(one.startswith("data:image/") for one in page.addresses)
    return " ".join(page.text.split())


def test_requested_outputs_are_reported_in_display_units(tmp_path):
    run = rf.System(BLOCK, PADS).simulate(
        SUITE["long"], outputs=("base_shear", "base_overturning_moment"),
        points={"bell": ("0 m", "2 m")},
    )  # fmt: skip
    words = text_of_report(rf.report(run, tmp_path / "r.html", certify=False, units=UNITS))
    largest = float(run.peak_base_shear) / 1e3
    assert f"largest absolute base shear up to overturning {largest:.4g} kN" in words
    top = run.point_horizontal_acceleration.sel(point="bell") / 9.80665
    row = f"point horizontal acceleration (bell) g {float(top.min()):.4g} {float(top.max()):.4g}"
    assert row in words
    moment = run.base_overturning_moment / 1e3
    assert f"base overturning moment kN m {float(moment.min()):.4g}" in words
    assert f"largest absolute rotation {np.degrees(float(run.peak_rotation)):.4g}°" in words


def test_nested_parts_have_separate_tables():
    block = rf.Block(width="0.6 m", height="2 m", mass="500 kg")
    plinth = rf.Block(width="1 m", height="1 m", mass="900 kg")
    stack = rf.Stack(block, plinth, interfaces=[rf.RigidGround()], offsets=["1 cm"])
    for part, words in (
        (stack, ("Body 1: Block", "Body 2: Block", "Interface 1: RigidGround", "0.01 m")),
        (rf.RockingFrame(block, columns=3, beam_mass="2 t"), ("Column: Block", "500 kg")),
    ):
        shown = Page("".join(sections._part_tables("part", part, DisplayUnits()))).text
        assert all(each in shown for each in words)
        assert "{" not in shown


def test_report_contains_project_and_conclusion(response, tmp_path):
    path = rf.report(response, tmp_path / "r.html", certify=False, project=PROJECT)
    words = text_of_report(path)
    for phrase in ("Object Bell <tower>", "Checked by C. Rossi", "Date 2026-11-24",
                 "Conclusion It stands.", "Assumptions Sound masonry. A level floor."):  # fmt: skip
        assert phrase in words, phrase
    assert path.read_text().count("<ol>") == 2  # assumptions and limitations
    for wrong, message in (
        ({"objekt": "x"}, "project has no entry 'objekt'; was 'object' meant?"),
        ({"object": 3.5}, "object of the project must be text"),
        ({"assumptions": "one"}, "assumptions must be a list"),
        ("Tower", "project must be a mapping with any of object"),
    ):
        with pytest.raises(ComponentError, match=message):
            rf.report(response, tmp_path / "x.html", project=wrong)
    with pytest.raises(ComponentError, match="was 'force' meant"):
        rf.report(response, tmp_path / "x.html", units={"forces": "kN"})


def test_sweep_report_lists_all_cases_and_the_worst_in_full(tmp_path):
    forces = ("friction_demand", "base_shear")
    runs = rf.sweep(
        rf.System(BLOCK, PADS), motions=SUITE, scale=[0.5, 2.0], outputs=forces, output_step="5 ms"
    )
    words = text_of_report(rf.report(runs, tmp_path / "r.html", units=UNITS, project=PROJECT))
    assert "Some cases overturned Of all 4 cases" in words
    for motion in SUITE:
        for scale in (0.5, 2.0):
            one = runs.sel(motion=motion, scale=scale)
            fate = "overturned" if bool(one.overturned) else "did not overturn"
            peak = np.degrees(float(one.peak_rotation))
            assert f"{scale:g} {motion} {fate} {peak:.4g}" in words
    standing = runs.sel(scale=0.5)
    shown = [np.degrees(standing.peak_rotation), standing.peak_relative_rotation,
             standing.impact_count, standing.first_uplift_time]  # fmt: skip
    peaks = {name: " ".join(f"{float(one.sel(motion=name)):.4g}" for one in shown).replace(
        "nan", "-") for name in SUITE}  # fmt: skip
    friction = float(runs.peak_friction_demand.sel(motion="short", scale=0.5))
    shear = float(runs.peak_base_shear.sel(motion="short", scale=0.5)) / 1e3
    assert "peak friction demand" in words
    assert "peak base shear [kN]" in words
    assert f"0.5 short did not overturn {peaks['short']} {friction:.4g}" in words
    assert f"0.5 short {shear:.4g} " in words
    mean = np.degrees(float(runs.peak_rotation.mean()))
    assert f"mean of 4 {mean:.4g}" in words
    # the worst case overturns first, with the verdict of the single run
    alone = rf.case(runs, motion="long", scale=2.0).simulate()
    assert "Simulated again: scale 2, motion long." in words
    assert alone.attrs["verdict"] in words
    assert "History of the ground acceleration" in words
    assert "2 sine pulse" not in words


@pytest.mark.wide
def test_sweep_report_shows_forces_and_slips_in_display_units(tmp_path):
    rough = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1, friction=0.25)
    tie = {"on": ("-0.3 m", "2 m"), "to": ("-1.3 m", "2 m"), "slack": "5 mm"}
    ties = [rf.Restrainer(**tie, stiffness=k, name=name)
            for name, k in (("soft", "50 kN/m"), ("hard", "200 kN/m"))]  # fmt: skip
    runs = rf.sweep(
        rf.System(BLOCK, rough, *ties), motions=SUITE, scale=[0.5, 1.0], output_step="5 ms",
        outputs=("left_reaction", "vertical_reaction"), points={"top": ("0 m", "2.4 m")},
    )  # fmt: skip
    words = text_of_report(rf.report(runs, tmp_path / "r.html", units={**UNITS, "force": "kN"}))
    for head in (
        "peak slip [mm]", "residual slip [mm]", "peak base shear [kN]",
        "peak restrainer force (soft) [kN]", "peak restrainer force (hard) [kN]",
        "broken restrainer count", "largest left reaction [kN]", "largest vertical reaction [kN]",
        "peak point horizontal displacement (top) [mm]",
        "peak point horizontal acceleration (top) [g]",
    ):  # fmt: skip
        assert head in words, head
    assert "right reaction" not in words.split("The worst case in full")[0]  # not requested
    for motion in SUITE:
        one = runs.sel(motion=motion, scale=1.0)
        numbers = [
            float(one.peak_base_shear) / 1e3,
            *(one.peak_restrainer_force.sel(restrainer=["soft", "hard"]).to_numpy() / 1e3),
            float(one.broken_restrainer_count),
            float(abs(one.left_reaction).max()) / 1e3,
            float(abs(one.vertical_reaction).max()) / 1e3,
            float(one.peak_point_horizontal_displacement.squeeze()) * 1e3,
        ]
        # two tables that fit on a page
        for table in (numbers[:5], numbers[5:]):
            assert f"1 {motion} " + " ".join(f"{number:.4g}" for number in table) in words
    largest = float(runs.peak_slip.max()) * 1e3
    assert f"{largest:.4g}" in words
    assert "slid, by" in words


def test_sweep_report_names_the_options_of_its_cases(tmp_path):
    block = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    pulse = rf.GroundMotion.sine_pulse("-2 m/s^2", "2 Hz")
    runs = rf.sweep(
        rf.System(block, pads), pulse, restraint=["contact-state", "centre"], progress=False
    )
    page = Page(rf.report(runs, tmp_path / "runs.html", certify=False).read_text())
    assert "contact-state" in page.text
    assert "centre" in page.text


def test_report_columns_exist_in_the_schema():
    assert {*cases.COLUMNS, *sections._DRAWN_HISTORIES} <= set(SCHEMA)


def test_report_lists_the_worst_of_many_cases(tmp_path, monkeypatch):
    monkeypatch.setattr(cases, "MAX_ROWS", 3)
    runs = rf.sweep(rf.System(BLOCK), SUITE["long"], scale=[0.4, 0.7, 2.0, 3.0, 4.0])
    words = text_of_report(rf.report(runs, tmp_path / "r.html"))
    assert "The 3 worst of 5 cases." in words
    assert "mean of 5" in words
    first = float(runs.overturning_time.squeeze().idxmin("scale"))
    assert f"Simulated again: scale {first:g}, motion " in words
    fallen = [float(one) for one in runs.scale[runs.overturned.squeeze()]]
    assert len(fallen) == 3
    assert all(re.search(rf"\b{scale:g} .{{0,40}}overturned", words) for scale in fallen)


def test_reports_of_studies_show_the_cautions_of_their_cases(tmp_path):
    system = rf.System(rf.Block(width="1 m", height="4 m", mass="4 t"))
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    options = {"scale": [0.01, 1.0, 1.5, 9.0], "progress": False}
    with pytest.warns(ModelWarning, match="3 of 8 cases have a result to be careful with"):
        runs = rf.sweep(system, {"a": pulse, "b": pulse.scaled(-0.2)}, **options)
    with pytest.warns(SolverWarning, match="still has the energy"):
        critical = rf.critical_scale(system, pulse, scales=20, runs=20)
    words = "3 of 8 cases: the run ends while the body, which counts as standing, still has the"
    fit = rf.fragility(runs, "PGA", limits=[])
    assert fit.attrs["cautions"].startswith(words)
    for result, stated in ((runs, words), (critical, critical.attrs["cautions"]), (fit, words)):
        page = Page(rf.report(result, tmp_path / "page.html", overwrite=True).read_text())
        assert f"To be used with care{stated}" in page.text
        assert stated in result.rockframe.summary
    page = Page(rf.report(runs, tmp_path / "page.html", overwrite=True).read_text())
    assert page.text.count("did not overturn, with care") == 3


def test_every_analysis_has_a_report(tmp_path):
    system = rf.System(BLOCK, PADS)
    runs = rf.sweep(system, motions=SUITE, scale=[0.5, 1.0, 2.0])
    for name, result, phrase in (
        ("fragility", rf.fragility(runs, intensity="PGA"), "Limit states"),
        ("critical", rf.critical_scale(system, SUITE["long"], largest=3.0), "Figure"),
        ("joined", rf.concat([system.simulate(one) for one in SUITE.values()], "run"), "Cases"),
    ):
        words = text_of_report(rf.report(result, tmp_path / f"{name}.html"))
        assert phrase in words, name
        assert "Provenance" in words
        assert "not described" not in words
        assert "s^-" not in words.split("Scene")[0]  # powers are superscripts


def test_a_dynamic_analysis_has_its_capacities(tmp_path, monkeypatch):
    found = rf.incremental_dynamic_analysis(
        rf.System(BLOCK), SUITE, scale=[0.5, 1.0, 2.0], intensity="PGA"
    )
    capacities = found.capacity_scale.sel(limit_state="overturning")
    words = text_of_report(rf.report(found, tmp_path / "all.html"))
    for name, one in zip(capacities.motion.to_numpy(), capacities.to_numpy(), strict=True):
        written = f"{one:.4g}" if np.isfinite(one) else "infinite"
        assert f"overturning {name} {written}" in words.split("Capacities")[1]
    assert "capacity scale: least scale of the motion that was found to exceed" in words
    fit = rf.fragility(found, "PGA", trials="capacities")
    fit = fit.squeeze()
    assert int(fit.fragility_status) == 0
    assert f"Fit Capacity against overturning: median {float(fit.median_intensity):.4g}" in (
        words.replace("median peak ground acceleration", "median")
    )
    monkeypatch.setattr(cases, "MAX_ROWS", 1)
    words = text_of_report(rf.report(found, tmp_path / "least.html"))
    least = str(capacities.motion[int(np.argmin(capacities.to_numpy()))].item())
    assert "The 1 least of 2 capacities." in words
    assert f"flip count overturning {least} " in words


def test_missing_motion_can_be_passed_to_the_report(tmp_path):
    record = rf.GroundMotion.from_arrays(([0.0, 3.0, -3.0, 0.0] * 40, "m/s^2"), "0.01 s")
    run = rf.System(BLOCK).simulate(record, outputs=None)
    words = text_of_report(rf.report(run, tmp_path / "r.html", motion=record))
    assert "Certificate: the verdict" in words
    assert "No certificate" not in words
    with pytest.raises(SchemaError, match="whose samples are not those of the run"):
        rf.report(run, tmp_path / "x.html", motion=record.scaled(2.0))


def test_report_refuses_a_motion_for_a_run_without_one(tmp_path):
    system = rf.System(rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"))
    run = system.simulate(duration="2 s", initial=rf.InitialState(rotation="5 deg"))
    with pytest.raises(SchemaError, match=r"not those of the run \(none\)"):
        rf.report(run, tmp_path / "report.html", motion=rf.GroundMotion.sine_pulse())


def test_certificate_of_a_different_run_is_rejected(tmp_path):
    """Motions of joined runs are unknown: another motion may have the same verdict."""
    system = rf.System(rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"))
    pulses = [rf.GroundMotion.sine_pulse(f"{peak} m/s^2", "2 Hz") for peak in (3.0, 4.0)]
    joined = rf.concat([system.simulate(one, outputs=None) for one in pulses], "run")
    for place, words in enumerate(("Certificate: the verdict", "a repeated run differs")):
        path = tmp_path / f"{place}.html"
        assert words in rf.report(joined.isel(run=place), path, motion=pulses[0]).read_text("utf-8")


def test_browser_prints_report_on_a4(response, tmp_path):
    browser = which("chromium") or which("google-chrome")
    if browser is None:
        pytest.skip("neither chromium nor google-chrome is installed")
    path = rf.report(response, tmp_path / "r.html", certify=False, project=PROJECT)
    usual = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}/profile"]
    sheets = tmp_path / "r.pdf"
    subprocess.run(
        [browser, *usual, "--no-pdf-header-footer", f"--print-to-pdf={sheets}", path.as_uri()],
        capture_output=True, timeout=120, check=True,
    )  # fmt: skip
    content = sheets.read_bytes()
    assert 4 <= len(re.findall(rb"/Type\s*/Page\b", content)) <= 9
    boxes = re.findall(rb"/MediaBox\s*\[0 0 ([\d.]+) ([\d.]+)\]", content)
    assert {(round(float(x)), round(float(y))) for x, y in boxes} == {(595, 842)}  # A4, in points


def test_tables_with_long_names_stay_on_the_sheet(tmp_path):
    browser, reader = which("chromium") or which("google-chrome"), which("pdftotext")
    if browser is None or reader is None:
        pytest.skip("chromium or google-chrome, or pdftotext, is not installed")
    named = {f"{'a' * 110}{name}": motion for name, motion in SUITE.items()}
    runs = rf.sweep(
        rf.System(BLOCK), named, scale=[0.5, 1.0], outputs=("friction_demand",), output_step="5 ms"
    )
    path = rf.report(runs, tmp_path / "r.html")
    usual = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}/profile"]
    sheets, places = tmp_path / "r.pdf", tmp_path / "r.xml"
    printed = [browser, *usual, "--no-pdf-header-footer", f"--print-to-pdf={sheets}", path.as_uri()]
    subprocess.run(printed, capture_output=True, timeout=120, check=True)
    subprocess.run([reader, "-bbox", sheets, places], timeout=120, check=True)
    words = re.findall(r'xMax="([\d.]+)" yMax="[\d.]+">([^<]*)<', places.read_text())
    last = [f"{one:.4g}" for one in runs.peak_friction_demand.to_numpy().ravel()]
    assert {*last} <= {word for right, word in words if float(right) < 595.0 - 40.0}


def test_report_mean_states_case_count_and_infinity_is_written_out(tmp_path):
    runs = rf.sweep(rf.System(BLOCK), SUITE, scale=[0.1, 2.0])
    times = runs.first_uplift_time.to_numpy()
    known = times[np.isfinite(times)]
    assert 0 < known.size < times.size
    words = text_of_report(rf.report(runs, tmp_path / "r.html"))
    assert f"{known.mean():.4g} (of {known.size})" in words
    assert format_value(xr.DataArray(np.inf)) == "infinite"


def test_measures_state_component_and_threshold(tmp_path):
    across = SUITE["long"]
    for motion, words in (
        (across, "Measures greatest"),
        (across.with_vertical(across.scaled(0.5)), "Measures of the horizontal component greatest"),
    ):
        run = rf.System(BLOCK).simulate(motion)
        units = {"acceleration": "g"}
        text = text_of_report(rf.report(run, tmp_path / "r.html", certify=False, units=units))
        assert words in text
        assert "last exceedance of 0.05 g" in text


def test_limitations_mention_the_certificate_only_if_present(tmp_path):
    system, pulse = rf.System(BLOCK), rf.GroundMotion.sine_pulse("-3 m/s^2", "2 Hz")

    def limits(found, **arguments):
        return text_of_report(rf.report(found, tmp_path / "r.html", **arguments)).split(
            "Limits of"
        )[1]

    run = system.simulate(pulse)
    assert "The certificate shows how near" in limits(run)
    told = limits(run, certify=False)
    assert "The certificate shows" not in told
    assert "which this page does not have" in told
    runs = rf.sweep(system, pulse, scale=[0.5, 1.0])
    for study in (runs, rf.critical_scale(system, pulse), rf.fragility(runs, "PGA")):
        told = limits(study)
        assert "The certificate shows" not in told
        assert "Studies have no certificates" in told
        assert "The verdict on a case holds only if" in told


def test_report_limitations_match_the_manual():
    left_out = read("theory/validity.md").split("## Omitted effects")[1].split("\n## ")[0]
    assert re.findall(r"^(\w.*)\n: ", left_out, re.MULTILINE) == [one.title for one in LIMITS]


def test_report_of_a_sweep_case_shows_its_own_system(tmp_path):
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    runs = rf.sweep(system, pulse, width=["0.5 m", "0.62 m"], scale=[1.0, 1.5], progress=False)
    one = runs.isel(width=1, scale=1, motion=0)
    page = Page(rf.report(one, tmp_path / "case.html").read_text("utf-8"))
    assert "0.62 m" in page.text
    assert "0.5 m" not in page.text
    assert "1.5 times sine pulse" in page.text
    assert "Certificate" in page.text
    with pytest.raises(SchemaError, match=r"sweep over width.*rf\.case\(dataset\)\.system"):
        rf.System.from_dataset(one)
    assert rf.System.from_dataset(runs) == system


def test_toppled_cases_are_reported_as_overturned(tmp_path):
    pulse = rf.GroundMotion.sine_pulse("6 m/s^2", "0.5 Hz")
    runs = rf.sweep(rf.System(BLOCK), pulse, scale=[0.1, 1.0], overturning="continue",
                    free_vibration="5 s")  # fmt: skip
    assert bool(runs.overturned.sel(scale=1.0).item())
    cases = text_of_report(rf.report(runs, tmp_path / "r.html")).split("Cases")[1]
    table = cases.split("mean of")[0]
    assert "toppled" not in table
    assert table.count("did not overturn") == 1
    assert table.count("overturned") == 1
