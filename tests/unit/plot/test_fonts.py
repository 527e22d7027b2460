"""Names with letters that the default font of matplotlib lacks."""

import warnings
from io import BytesIO

import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from matplotlib import font_manager, pyplot, rc_context

import rockframe as rf
from rockframe.errors import RockframeWarning
from rockframe.plot import _fonts

NAME = "地震 Kōbe"
LETTERS = "地震神戸"
PULSE = rf.GroundMotion(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz").si, name=NAME)
SLIM = rf.Block(width="0.8 m", height="4 m", mass="2 t")
TIE = rf.Restrainer(on=("-0.4 m", "4 m"), to=("-1.4 m", "4 m"), stiffness="1 kN/m", name="神戸")
SYSTEM = rf.System(SLIM, TIE)


@pytest.fixture(scope="module")
def run():
    return SYSTEM.simulate(PULSE, duration="0.3 s")


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """Install a font with only the letters of the names besides the existing fonts."""
    pen = TTGlyphPen(None)
    for k, place in enumerate([(0, 0), (0, 700), (700, 700), (700, 0)]):
        pen.lineTo(place) if k else pen.moveTo(place)
    pen.closePath()
    names = [".notdef", *(f"u{ord(letter):X}" for letter in LETTERS)]
    font = FontBuilder(1000, isTTF=True)
    font.setupGlyphOrder(names)
    font.setupCharacterMap({ord(letter): f"u{ord(letter):X}" for letter in LETTERS})
    font.setupGlyf(dict.fromkeys(names, pen.glyph()))
    font.setupHorizontalMetrics(dict.fromkeys(names, (800, 0)))
    font.setupHorizontalHeader(ascent=800, descent=-200)
    font.setupNameTable({"familyName": "Letters of names", "styleName": "Regular"})
    font.setupOS2()
    font.setupPost()
    font.save(tmp_path / "letters.ttf")
    fonts = list(font_manager.fontManager.ttflist)
    monkeypatch.setattr(font_manager.fontManager, "ttflist", fonts)
    font_manager.fontManager.addfont(tmp_path / "letters.ttf")
    return "Letters of names"


DRAWN = {
    "motion": lambda run: rf.plot.motion(PULSE),
    "response": lambda run: rf.plot.response({NAME: run, "other": run}),
    "scene": lambda run: rf.plot.scene(SYSTEM),
    "animation": lambda run: rf.plot.animation(run, title=NAME),
    "own axes": lambda run: rf.plot.phase(run, ax=pyplot.figure().subplots(), title=NAME),
}
SOME_DRAWN = [
    pytest.param(name, marks=[pytest.mark.long] * (name in ("motion", "animation")))
    for name in DRAWN
]


def draw_to_file(name, run):
    """Save a figure; return its texts and the warnings."""
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always")
        axes = DRAWN[name](run)
        figure = axes.figure
        figure.savefig(BytesIO(), format="png")
    return list(_fonts._non_ascii_texts([figure])), [warning.message for warning in issued]


@pytest.mark.parametrize("name", SOME_DRAWN)
def test_missing_glyphs_warn_once(name, run, monkeypatch):
    fonts = [font for font in font_manager.fontManager.ttflist if font.name == "DejaVu Sans"]
    monkeypatch.setattr(font_manager.fontManager, "ttflist", fonts)
    _, issued = draw_to_file(name, run)
    assert [type(warning) for warning in issued] == [RockframeWarning]
    assert "no installed font has " in str(issued[0])
    assert "install a font with these letters, such as Noto Sans CJK" in str(issued[0])


def test_report_warns_once_of_missing_glyphs(run, monkeypatch, tmp_path):
    fonts = [font for font in font_manager.fontManager.ttflist if font.name == "DejaVu Sans"]
    monkeypatch.setattr(font_manager.fontManager, "ttflist", fonts)
    with pytest.warns(RockframeWarning, match="no installed font has") as issued:
        rf.report(run, tmp_path / "report.html", motion=PULSE, certify=False)
    assert [str(warning.message).partition(";")[0] for warning in issued] == [
        "no installed font has 神 戸 地 震, written as '?' in the figures"
    ]
    assert issued[0].filename == __file__


@pytest.mark.parametrize("name", SOME_DRAWN)
def test_text_uses_a_font_with_its_glyphs(name, run, installed):
    texts, issued = draw_to_file(name, run)
    assert issued == []
    foreign = [text for text in texts if set(text.get_text()) & set(LETTERS)]
    assert foreign
    assert all(text.get_fontfamily()[-1] == installed for text in foreign)


def test_user_selected_fonts_take_precedence(run, installed):
    with rc_context({"font.family": [installed, "DejaVu Sans"]}):
        texts, issued = draw_to_file("response", run)
    assert issued == []
    assert {tuple(text.get_fontfamily()) for text in texts} == {(installed, "DejaVu Sans")}
