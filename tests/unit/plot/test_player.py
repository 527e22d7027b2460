"""Pages that play a run: their numbers are those of the run, and browsers draw them."""

import base64
import json
import re
import subprocess
import zlib
from contextlib import nullcontext
from shutil import which

import matplotlib.pyplot as plt
import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError
from rockframe.plot._response import CONTACT_COLOURS
from rockframe.plot._scene import SceneHistory

BLOCK = rf.Block(width="1 m", height="4 m", mass="8 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
CAP = rf.CushionCap(height="0.5 m", width="1.6 m", mass="3 t")
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
PULSE = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
PLINTH = rf.Block(width="1.5 m", height="1.5 m", mass="4 t")
TIE = rf.Restrainer(on=("0.5 m", "3 m"), to=("2 m", "3 m"), stiffness="10 kN/m")
SCENES = {
    "rigid ground": [BLOCK],
    "pads": [BLOCK, PADS],
    "soil": [BLOCK, SOIL],
    "pads, cap and soil": [BLOCK, PADS, CAP, SOIL],
    "stack": [rf.Stack(BLOCK, PLINTH, interfaces=[rf.RigidGround()]), rf.RigidGround()],
    "wall": [BLOCK, rf.RearWall(side="left")],
    "ties": [BLOCK, PADS, TIE],
}


def run_of(scene, **options):
    with plain_python() if scene == "stack" else nullcontext():
        return rf.System(*SCENES[scene]).simulate(PULSE, free_vibration="1 s", **options)


def read(page):
    """Read a page's numbers, as its script does."""
    data = json.loads(re.search(r"^const run = (.*);$", page, re.MULTILINE)[1])
    packed = zlib.decompress(base64.b64decode(data["numbers"]))
    low, high = np.frombuffer(packed, np.uint8).reshape(2, -1).astype(int)
    numbers = np.cumsum((low | high << 8).astype(np.uint16), dtype=np.uint16).view(np.int16)
    return data, numbers


def points_of(data, numbers, name):
    """Return where a layer is at all instants [m]."""
    drawn, instants = data["layers"], len(data["times"])
    (layer,) = [one for one in drawn["list"] if one["name"] == name]
    size = 2 * layer["points"] * instants
    columns = numbers[layer["first"] : layer["first"] + size].reshape(-1, 2, instants)
    step = max(drawn["width"], drawn["height"]) / data["levels"]
    places = np.where(columns == data["nowhere"], np.nan, step * columns).transpose(2, 0, 1)
    return places + np.array([drawn["left"], drawn["bottom"]]), step


@pytest.mark.parametrize(
    "scene", [pytest.param(name, marks=[pytest.mark.long] * (name == "stack")) for name in SCENES]
)
def test_the_numbers_of_a_page_are_where_the_parts_are(scene):
    run = run_of(scene, points={"top": ("0 m", "4 m")} if scene == "pads" else None)
    data, numbers = read(rf.plot.player(run).to_html())
    moving = SceneHistory(run, "player", 1.0)
    times = run.time.to_numpy()
    assert (data["times"][0], data["times"][-1]) == pytest.approx(times[[0, -1]])
    names = {one["name"] for one in data["layers"]["list"]}
    assert {"block", "centre of mass", "contact"} <= names
    block, step = points_of(data, numbers, "block")
    cross, _ = points_of(data, numbers, "centre of mass")
    for place, when in list(enumerate(data["times"]))[::7]:
        there = moving.builder.layout_at(moving.placement_at(int(np.argmin(abs(times - when)))))
        np.testing.assert_allclose(block[place], there.block, atol=0.51 * step)
        np.testing.assert_allclose(cross[place], there.centres, atol=0.51 * step)
    rest = [one for one in data["layers"]["list"] if one["name"] == "at rest"]
    assert len(rest) == (2 if scene in ("stack", "pads, cap and soil") else 1)
    box = data["layers"]
    assert (np.nanmin(block, axis=(0, 1)) >= (box["left"], box["bottom"])).all()
    if scene == "pads":
        top, _ = points_of(data, numbers, "top")
        np.testing.assert_allclose(top[:, 0], block[:, 2:].mean(axis=1), atol=2.0 * step)


def test_traces_and_strips_are_those_of_the_run():
    run = run_of("pads")
    data, numbers = read(rf.plot.player(run, rotation="mrad").to_html())
    rotation, ground = data["traces"]
    assert rotation["label"] == "rotation [mrad]"
    assert rotation["high"] == pytest.approx(1e3 * float(run.rotation.max()))
    assert ground["low"] == pytest.approx(float(run.ground_acceleration.min()))
    size = rotation["parts"]
    both = numbers[rotation["first"] : rotation["first"] + 2 * size].reshape(2, size)
    reach = rotation["high"] - rotation["low"]
    least, most = rotation["low"] + both / data["levels"] * reach
    assert (least <= most).all()
    assert most.max() == pytest.approx(rotation["high"], abs=1e-4 * reach)
    (strip,) = data["strips"]
    assert strip["states"][0] == "full"
    changes = int((np.diff(run.contact_state.to_numpy()) != 0).sum())
    assert len(strip["times"]) == len(strip["states"]) == 1 + changes
    assert {"left", "right"} <= set(strip["states"])
    slid = run.assign(slip=run.vertical_displacement)
    label = read(rf.plot.player(slid, units={"length": "mm"}).to_html())[0]["traces"][1]["label"]
    assert label == "slip [mm]"
    panels = rf.plot.response(slid)
    assert [one.get_ylabel() for one in panels][3:] == ["slip\n[m]", "contact"]
    plt.close(panels.figure)


@pytest.mark.wide
def test_the_slips_of_all_bodies_that_slide_are_traced():
    stone = rf.RigidGround(friction=0.2)
    stack = rf.Stack(
        rf.Block(width="0.8 m", height="1 m", mass="1 t"),
        rf.Block(width="1 m", height="0.6 m", mass="2 t"), interfaces=[stone],
    )  # fmt: skip
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    run = rf.System(stack, stone.replace(friction=0.3)).simulate(pulse, free_vibration="0.5 s")
    labels = [one["label"] for one in read(rf.plot.player(run).to_html())[0]["traces"]]
    assert labels[1:-1] == ["slip of body 1 [m]", "slip of body 2 [m]"]
    still = run.assign(body_slip=run.body_slip.where(run.body == 2, 0.0))
    labels = [one["label"] for one in read(rf.plot.player(still).to_html())[0]["traces"]]
    assert labels[1:-1] == ["slip of body 2 [m]"]


def test_pages_are_small_whole_and_ask_for_nothing(tmp_path):
    run = run_of("pads")
    page = rf.plot.player(run)
    text = page.to_html()
    assert not re.search(r"<link|src=|@\w+@|https?://", text)
    assert len(text) < 40_000
    length = float(run.time[-1])
    assert repr(page) == f"<player of {length:.1f} s, {len(text) / 1e3:.0f} kB; save('run.html')>"
    # words are text, whatever they hold
    odd = rf.plot.player(run.assign_attrs(motion="</script><b>5"), title="a</script>").to_html()
    assert odd.count("</script>") == 1
    assert "<b>" not in odd
    long = rf.System(BLOCK, PADS).simulate(PULSE, free_vibration="50 s")
    assert len(rf.plot.player(long).to_html()) < 50_000
    cut = read(rf.plot.player(run, window=("0.5 s", "1 s"), title="a part").to_html())[0]
    assert (cut["times"][0], cut["times"][-1]) == pytest.approx((0.5, 1.0), abs=0.01)
    written = run.rockframe.player(tmp_path / "run.html", magnify=3).save(tmp_path / "run.html")
    assert written.read_text().startswith("<!doctype html>")


def test_what_cannot_be_played_is_refused():
    run = run_of("rigid ground")
    with pytest.raises(ComponentError, match=r"rf\.plot\.player: magnify must be greater than"):
        rf.plot.player(run, magnify=0)
    with pytest.raises(SchemaError, match=r"player"):
        rf.plot.player(run_of("rigid ground", outputs=None))


def test_states_of_contact_differ_as_shades_of_grey():
    def lightness(colour):
        linear = [
            one / 12.92 if one <= 0.04045 else ((one + 0.055) / 1.055) ** 2.4
            for one in (int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
        ]
        return 116.0 * float(np.dot([0.2126, 0.7152, 0.0722], linear)) ** (1 / 3) - 16.0

    shades = sorted(lightness(colour) for colour in CONTACT_COLOURS.values())
    assert np.diff(shades).min() > 9.0


def test_a_browser_draws_it(tmp_path):
    """Of which no part asks for anything, and whose script ends without a fault."""
    browser = which("chromium") or which("google-chrome")
    if browser is None:
        pytest.skip("neither chromium nor google-chrome is installed")
    path = rf.plot.player(run_of("pads, cap and soil")).save(tmp_path / "run.html")
    usual = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000"]
    seen = subprocess.run(
        [browser, *usual, f"--user-data-dir={tmp_path}/profile", "--dump-dom", path.as_uri()],
        capture_output=True, text=True, timeout=120, check=True,
    ).stdout  # fmt: skip
    assert 'data-ready="yes"' in seen
    assert "flight" in seen or "left" in seen


def written_by_a_browser(page, tmp_path, height=640, canvas="traces"):
    """Return what a page writes on a canvas, with its place [pixels]."""
    browser = which("chromium") or which("google-chrome")
    if browser is None:
        pytest.skip("neither chromium nor google-chrome is installed")
    listens = """<script>
    const plain = CanvasRenderingContext2D.prototype.fillText, told = [];
    CanvasRenderingContext2D.prototype.fillText = function (words, x, y) {
      if (this.canvas.id === "CANVAS") told.push(words + "@" + x + "@" + y);
      document.body.dataset.told = told.join("|");
      plain.call(this, words, x, y);
    };</script><script>"""
    path = tmp_path / "run.html"
    path.write_text(page.to_html().replace("<script>", listens.replace("CANVAS", canvas), 1))
    usual = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000"]
    seen = subprocess.run(
        [browser, *usual, f"--window-size=800,{height}", f"--user-data-dir={tmp_path}/profile",
         "--dump-dom", path.as_uri()],
        capture_output=True, text=True, timeout=120, check=True,
    ).stdout  # fmt: skip
    told = re.search(r'data-told="([^"]*)"', seen)[1].split("|")
    return [(words, float(x), float(y)) for words, x, y in (one.split("@") for one in told)]


@pytest.mark.parametrize("longer", [1.0, 1e-3, 2000.0])
def test_times_below_the_traces_do_not_run_into_one_another(tmp_path, longer):
    run = run_of("rigid ground")
    stretched = run.assign_coords(time=run.time * longer)
    written = written_by_a_browser(rf.plot.player(stretched), tmp_path)
    places = sorted({x for words, x, _ in written if words.endswith(" s")})
    assert 4 <= len(places) <= 11
    assert np.diff(places).min() > 40.0


@pytest.mark.parametrize(
    ("unit", "bar"), [(None, "0.5 m"), ("ft", "2 ft"), ("in", "20 in"), ("mm", "500 mm")]
)
def test_the_scale_bar_has_the_unit_of_lengths(tmp_path, unit, bar):
    units = None if unit is None else {"length": unit}
    page = rf.plot.player(run_of("rigid ground"), units=units)
    written = written_by_a_browser(page, tmp_path, canvas="scene")
    assert {words for words, _, _ in written} == {bar}


def test_numbers_beside_low_traces_do_not_overlap(tmp_path):
    run = run_of("rigid ground")
    run = run.assign(slip=run.vertical_displacement)
    page = rf.plot.player(run, title="a long title " * 60)
    written = written_by_a_browser(page, tmp_path, 480)
    assert "slip [m]" in [words for words, _, _ in written]
    heights = sorted({y for _, x, y in written if x < 52.0})
    assert np.diff(heights).min(initial=99.0) > 9.0
