"""Reports: what stands in them, and that they need no other file."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest
import xarray as xr
from pages import read

import rockframe as rf
from rockframe.errors import RecordWarning, SchemaError
from rockframe.reports import sections
from rockframe.reports.limits import LIMITS

pytestmark = pytest.mark.unit


class Page(HTMLParser):
    """Tags, what they refer to, and all text."""

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


def test_a_report_has_all_and_asks_for_nothing(response, tmp_path):
    path = rf.report(response, tmp_path / "r.html", title="Tower & bell")
    text = path.read_text(encoding="utf-8")
    page = Page(text)
    assert page.open == []
    assert page.addresses
    assert all(one.startswith("data:image/") for one in page.addresses)
    assert not {"script", "link", "iframe", "object"} & page.tags
    assert not re.search(r"url\(|@import", text)
    words = " ".join(page.text.split())
    for said in (
        "Tower & bell",
        response.attrs["verdict"],
        "Certificate: the verdict holds",
        "The body stands also with",  # the run has no certificate: it is made for the report
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
        assert said in words, said
    assert "springs of the bed" not in words  # there is no soil


def test_what_cannot_be_had_is_said(response, tmp_path):
    bare = rf.report(response, tmp_path / "bare.html", certify=False).read_text()
    assert "No certificate" in bare
    record = rf.GroundMotion.from_arrays(([0.0, 3.0, -3.0, 0.0] * 40, "m/s^2"), "0.01 s")
    system = rf.System.from_dict({**rf.System.from_dataset(response).to_dict(), "motion": None})
    short = system.simulate(record, outputs=None)
    text = rf.report(short, tmp_path / "short.html").read_text()
    assert "does not hold its motion" in text
    assert "kept no histories" in text
    unknown = response.assign_attrs(system_json="{}")
    assert "does not describe its system" in rf.report(unknown, tmp_path / "u.html").read_text()


def test_a_run_by_a_record_has_its_certificate_though_it_overturned(tmp_path):
    system = rf.System(rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"))
    shaking = 8.0 * np.sin(np.linspace(0.0, 30.0, 400)) * np.linspace(0.0, 1.0, 400)
    level = rf.GroundMotion.from_arrays((shaking, "m/s^2"), "0.02 s", name="a record")
    both = rf.GroundMotion.from_arrays(
        (shaking, "m/s^2"), "0.02 s", vertical=(0.5 * shaking, "m/s^2")
    )
    for motion in (level, both):
        run = system.simulate(motion)
        assert bool(run.overturned)
        assert float(run.time[-1]) < 7.9  # and the motion goes on
        run.to_netcdf(tmp_path / "out.nc")
        with xr.open_dataset(tmp_path / "out.nc") as kept:
            assert rf.System.from_dataset(kept).motion == rf.GroundMotion.from_arrays(
                (shaking, "m/s^2"), "0.02 s", name=motion.name,
                **({"vertical": (0.5 * shaking, "m/s^2")} if motion is both else {}),
            )  # fmt: skip
            rf.report(kept, tmp_path / "out.html")
        assert "No certificate" not in (tmp_path / "out.html").read_text()
    assert rf.concat([run, run]).sizes == {"run": 2}
    assert "ground_acceleration_after_end [m s^-2]" not in rf.table(run)
    # other samples are no other motion: the digest tells
    changed = run.assign(ground_acceleration_after_end=0.0 * run.ground_acceleration_after_end)
    with pytest.warns(RecordWarning, match="not what the run had"):
        assert rf.System.from_dataset(changed).motion is None


@pytest.mark.parametrize("doubted", ["verdict_converged", "verdict_robust"])
def test_a_certificate_holds_only_where_it_is_sure_in_every_way(response, doubted):
    told = response.assign(dict.fromkeys(("verdict_converged", "verdict_robust"), True))
    told.attrs["certificate"] = "The body stands."
    assert "the verdict holds" in "".join(sections.verdict_section(told, ""))
    assert "the verdict is in doubt" in "".join(
        sections.verdict_section(told.assign({doubted: False}), "")
    )


def test_only_results_of_one_run_are_reported(response, tmp_path):
    runs = rf.concat([response, response], "run")
    for given, words in (
        ("out.nc", "xr.open_dataset"),
        (runs, "several runs over run"),
        (response.drop_vars("overturned"), "no result of a run"),
    ):
        with pytest.raises(SchemaError, match=words):
            rf.report(given, tmp_path / "x.html")
    assert not (tmp_path / "x.html").exists()


def test_the_limits_are_those_of_the_manual():
    left_out = read("theory/validity.md").split("## Left out")[1].split("\n## ")[0]
    assert re.findall(r"^(\w.*)\n: ", left_out, re.MULTILINE) == [one.title for one in LIMITS]
