"""Player pages contain the numbers of the run, and browsers draw them."""

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
    "ties": [BLOCK, PADS, TIE, rf.Load(at=("-0.2 m", "3 m"), vertical="1 kN")],
}


def run_of(scene, **options):
    with plain_python() if scene == "stack" else nullcontext():
        return rf.System(*SCENES[scene]).simulate(PULSE, free_vibration="1 s", **options)


def read(page):
    """Read the numbers of a page as its script does."""
    data = json.loads(re.search(r"^const run = (.*);$", page, re.MULTILINE)[1])
    packed = zlib.decompress(base64.b64decode(data["numbers"]))
    low, high = np.frombuffer(packed, np.uint8).reshape(2, -1).astype(int)
    numbers = np.cumsum((low | high << 8).astype(np.uint16), dtype=np.uint16).view(np.int16)
    return data, numbers


def points_of(data, numbers, name):
    """Return the points of a layer at all instants [m]."""
    layers, instants = data["layers"], len(data["times"])
    (layer,) = [layer for layer in layers["list"] if layer["name"] == name]
    size = 2 * layer["points"] * instants
    columns = numbers[layer["first"] : layer["first"] + size].reshape(-1, 2, instants)
    step = max(layers["width"], layers["height"]) / data["levels"]
    places = np.where(columns == data["nowhere"], np.nan, step * columns).transpose(2, 0, 1)
    return places + np.array([layers["left"], layers["bottom"]]), step


@pytest.mark.parametrize(
    "scene", [pytest.param(name, marks=[pytest.mark.long] * (name == "stack")) for name in SCENES]
)
def test_player_coordinates_match_the_scene(scene):
    run = run_of(scene, points={"top": ("0 m", "4 m")} if scene == "pads" else None)
    data, numbers = read(rf.plot.player(run).to_html())
    moving = SceneHistory(run, "player", 1.0)
    times = run.time.to_numpy()
    assert (data["times"][0], data["times"][-1]) == pytest.approx(times[[0, -1]])
    names = {layer["name"] for layer in data["layers"]["list"]}
    assert {"block", "centre of mass", "contact"} <= names
    block, step = points_of(data, numbers, "block")
    cross, _ = points_of(data, numbers, "centre of mass")
    for place, time in list(enumerate(data["times"]))[::7]:
        layout = moving.builder.layout_at(moving.placement_at(int(np.argmin(abs(times - time)))))
        np.testing.assert_allclose(block[place], layout.block, atol=0.51 * step)
        np.testing.assert_allclose(cross[place], layout.centres, atol=0.51 * step)
    if scene == "ties":
        load, _ = points_of(data, numbers, "load")
        distances = [np.linalg.norm(load[:, 0] - block[:, k], axis=1) for k in (0, 1)]
        np.testing.assert_allclose(distances[0], np.hypot(0.3, 3.0), atol=2 * step)
        np.testing.assert_allclose(distances[1], np.hypot(0.7, 3.0), atol=2 * step)
    rest = [layer for layer in data["layers"]["list"] if layer["name"] == "at rest"]
    assert len(rest) == (2 if scene in ("stack", "pads, cap and soil") else 1)
    box = data["layers"]
    assert (np.nanmin(block, axis=(0, 1)) >= (box["left"], box["bottom"])).all()
    if scene == "pads":
        top, _ = points_of(data, numbers, "top")
        np.testing.assert_allclose(top[:, 0], block[:, 2:].mean(axis=1), atol=2.0 * step)


def test_player_traces_and_strips_match_the_run():
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
    sliding = run.assign(slip=run.vertical_displacement)
    label = read(rf.plot.player(sliding, units={"length": "mm"}).to_html())[0]["traces"][1]["label"]
    assert label == "slip [mm]"
    panels = rf.plot.response(sliding)
    assert [panel.get_ylabel() for panel in panels][3:] == ["slip\n[m]", "contact"]
    plt.close(panels.figure)


@pytest.mark.wide
def test_slip_is_traced_for_every_sliding_body():
    stone = rf.RigidGround(friction=0.2)
    stack = rf.Stack(
        rf.Block(width="0.8 m", height="1 m", mass="1 t"),
        rf.Block(width="1 m", height="0.6 m", mass="2 t"), interfaces=[stone],
    )  # fmt: skip
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    run = rf.System(stack, stone.replace(friction=0.3)).simulate(pulse, free_vibration="0.5 s")
    labels = [trace["label"] for trace in read(rf.plot.player(run).to_html())[0]["traces"]]
    assert labels[1:-1] == ["slip of body 1 [m]", "slip of body 2 [m]"]
    still = run.assign(body_slip=run.body_slip.where(run.body == 2, 0.0))
    labels = [trace["label"] for trace in read(rf.plot.player(still).to_html())[0]["traces"]]
    assert labels[1:-1] == ["slip of body 2 [m]"]


def test_player_pages_are_small_and_self_contained(tmp_path):
    run = run_of("pads")
    page = rf.plot.player(run)
    text = page.to_html()
    assert not re.search(r"<link|src=|@\w+@|https?://", text)
    assert len(text) < 40_000
    length = float(run.time[-1])
    assert repr(page) == f"<player of {length:.1f} s, {len(text) / 1e3:.0f} kB; save('run.html')>"
    # titles are escaped
    odd = rf.plot.player(run.assign_attrs(motion="</script><b>5"), title="a</script>").to_html()
    assert odd.count("</script>") == 1
    assert "<b>" not in odd
    long = rf.System(BLOCK, PADS).simulate(PULSE, free_vibration="50 s")
    assert len(rf.plot.player(long).to_html()) < 50_000
    cut = read(rf.plot.player(run, window=("0.5 s", "1 s"), title="a part").to_html())[0]
    assert (cut["times"][0], cut["times"][-1]) == pytest.approx((0.5, 1.0), abs=0.01)
    written = run.rockframe.player(tmp_path / "run.html", magnify=3).save(tmp_path / "run.html")
    assert written.read_text().startswith("<!doctype html>")


def test_invalid_player_arguments_are_refused():
    run = run_of("rigid ground")
    with pytest.raises(ComponentError, match=r"rf\.plot\.player: magnify must be greater than"):
        rf.plot.player(run, magnify=0)
    with pytest.raises(SchemaError, match=r"player"):
        rf.plot.player(run_of("rigid ground", outputs=None))


def test_browser_renders_the_player(tmp_path):
    """No part is loaded from elsewhere, and the script ends without a fault."""
    browser = which("chromium") or which("google-chrome")
    if browser is None:
        pytest.skip("neither chromium nor google-chrome is installed")
    page = rf.plot.player(run_of("pads, cap and soil"))
    path = page.save(tmp_path / "run.html")
    usual = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000"]
    output = subprocess.run(
        [browser, *usual, f"--user-data-dir={tmp_path}/profile", "--dump-dom", path.as_uri()],
        capture_output=True, text=True, timeout=120, check=True,
    ).stdout  # fmt: skip
    assert 'data-ready="yes"' in output
    states = {state for strip in read(page.to_html())[0]["strips"] for state in strip["states"]}
    assert len(states) > 1
    # the key, which the script makes
    assert sorted(re.findall(r"</i>([^<]+)</span>", output)) == sorted(states)


def texts_in_browser(page, tmp_path, height=640, canvas="traces"):
    """Return the texts that a page writes on a canvas, with their places [pixels]."""
    browser = which("chromium") or which("google-chrome")
    if browser is None:
        pytest.skip("neither chromium nor google-chrome is installed")
    listens = """<script>
    const plain = CanvasRenderingContext2D.prototype.fillText, texts = [];
    CanvasRenderingContext2D.prototype.fillText = function (words, x, y) {
      if (this.canvas.id === "CANVAS") texts.push(words + "@" + x + "@" + y);
      document.body.dataset.texts = texts.join("|");
      plain.call(this, words, x, y);
    };</script><script>"""
    path = tmp_path / "run.html"
    path.write_text(page.to_html().replace("<script>", listens.replace("CANVAS", canvas), 1))
    usual = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000"]
    output = subprocess.run(
        [browser, *usual, f"--window-size=800,{height}", f"--user-data-dir={tmp_path}/profile",
         "--dump-dom", path.as_uri()],
        capture_output=True, text=True, timeout=120, check=True,
    ).stdout  # fmt: skip
    texts = re.search(r'data-texts="([^"]*)"', output)[1].split("|")
    return [(words, float(x), float(y)) for words, x, y in (text.split("@") for text in texts)]


@pytest.mark.parametrize("longer", [1.0, 1e-3, 2000.0])
def test_time_labels_do_not_overlap(tmp_path, longer):
    run = run_of("rigid ground")
    stretched = run.assign_coords(time=run.time * longer)
    texts = texts_in_browser(rf.plot.player(stretched), tmp_path)
    places = sorted({x for words, x, _ in texts if words.endswith(" s")})
    assert 4 <= len(places) <= 11
    assert np.diff(places).min() > 40.0


@pytest.mark.parametrize(
    ("unit", "bar"), [(None, "0.5 m"), ("ft", "2 ft"), ("in", "20 in"), ("mm", "500 mm")]
)
def test_the_scale_bar_has_the_unit_of_lengths(tmp_path, unit, bar):
    units = None if unit is None else {"length": unit}
    page = rf.plot.player(run_of("rigid ground"), units=units)
    written = texts_in_browser(page, tmp_path, canvas="scene")
    assert {words for words, _, _ in written} == {bar}


@pytest.mark.parametrize(
    ("height", "title", "fewest"), [(480, "a long title " * 60, 1), (900, "a title", 6)]
)
def test_numbers_beside_low_traces_do_not_overlap(tmp_path, height, title, fewest):
    """The lowest traces have none; high ones have those of both ends, but no zeros."""
    run = run_of("rigid ground")
    run = run.assign(slip=run.vertical_displacement)
    texts = texts_in_browser(rf.plot.player(run, title=title), tmp_path, height)
    assert "slip [m]" in [words for words, _, _ in texts]
    heights = sorted({y for _, x, y in texts if x < 52.0})
    assert len(heights) >= fewest
    assert not (np.diff(heights) <= 9.0).any()
