"""Reports in display units: no value is left in another unit."""

import re
from html import unescape

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import ComponentError, UnitsError
from rockframe.units import Unit
from rockframe.units.display import display_units

pytestmark = [pytest.mark.unit, pytest.mark.usefixtures("no_pictures")]

UNITS = {
    "length": "mm", "mass": "t", "angle": "deg", "angular_velocity": "deg/s", "velocity": "cm/s",
    "acceleration": "g", "force": "kN", "moment": "kN*m", "energy": "kJ", "stiffness": "kN/mm",
}  # fmt: skip
UNCHANGED = ("s", "Hz", "N s m^-1", "kg m^2", "kg m^-3", "m^3")
"""Units of which none is chosen, of those that begin with one of which one is."""
SPELLED = [str(one) for one in Unit if one not in (*UNCHANGED, "1")] + [
    "m/s^2",
    "m/s",
    "N/m",
    "rad/s",
]
RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
SI = re.compile(
    rf"\d (?!(?:{'|'.join(map(re.escape, UNCHANGED))}|N s/m)(?![\w^/]))"
    rf"(?:{'|'.join(map(re.escape, sorted(SPELLED, key=len, reverse=True)))})(?![\w^/])"
)
BLOCK = rf.Block(width="0.6 m", height="2.4 m", mass="1 t")
WALL = rf.System(rf.Block(width="0.6 m", height="6 m", mass="5 t"), rf.RearWall(side="left"))
PULSE = rf.GroundMotion(rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz").si, name="pulse")


def text_of_report(path):
    """Return the text of a report without the code that rebuilds its scene."""
    html = path.read_text(encoding="utf-8").split("</style>", 1)[1].split("<h2>Provenance</h2>")[0]
    return unescape(re.sub(r"<[^>]*>", " ", html))


def numbers_in_si(words):
    """Return numbers in SI units for which other units were chosen, with the text around them."""
    words = re.sub(
        r"(?<=[A-Za-z])[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda one: f"^{one[0].translate(RAISED)}", words
    )
    return [words[max(0, one.start() - 30) : one.end() + 20] for one in SI.finditer(words)]


def test_helper_finds_si_units_left_in_text():
    assert len(numbers_in_si("0.6 m wide, 3 m s⁻², 4 N m, 5 N/m; '2 kg'")) == 5
    assert numbers_in_si("3 mm, 5 kN m, 2 s, 4 N s/m, 5 kg m², 3 months") == []


def test_report_of_a_sliding_run_uses_display_units(tmp_path):
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1, friction=0.2)
    tie = rf.Restrainer(on=("-0.3 m", "2 m"), to=("-1 m", "2 m"), stiffness="20 kN/m", slack="1 cm")
    run = rf.System(BLOCK, pads, tie).simulate(PULSE, outputs=("base_shear", "energy"))
    assert re.search(r"Slid [\d.]+ m to the \w+", run.attrs["verdict"])
    words = text_of_report(rf.report(run, tmp_path / "r.html", units=UNITS, certify=False))
    assert numbers_in_si(words) == []
    slid = 1e3 * abs(float(run.residual_slip))
    assert f"Slid {slid:.3g} mm to the" in words
    turned = np.degrees(float(run.peak_rotation))
    assert re.search(rf"peak rotation {turned:.3g}0*°", words)
    assert "600 mm" in words  # the block
    assert (
        len(numbers_in_si(text_of_report(rf.report(run, tmp_path / "r.html", certify=False)))) > 20
    )


def test_code_checks_use_display_units(tmp_path):
    demands = {"limit_state": "SLD", "elastic_period": "0.2 s"}
    spectrum = rf.TargetSpectrum.eurocode_8("0.25 g_0", "B")
    checks = [
        rf.codes.circolare_2019(WALL, PULSE),
        rf.codes.circolare_2019(WALL, spectrum, **demands),
        rf.codes.asce_7_22(BLOCK, PULSE, spectral_acceleration=1.0, friction=0.3),
    ]
    run = WALL.simulate(PULSE)
    path = rf.report(run, tmp_path / "r.html", units=UNITS, checks=checks, certify=False)
    words = text_of_report(path)
    assert numbers_in_si(words) == []
    needed, available = (checks[0].value(name) for name in ("d_demand", "d_SLV"))
    assert f"demand {1e3 * needed:.4g} mm, capacity {1e3 * available:.4g} mm" in words
    tipping = 1e-3 * checks[2].value("M_OT")
    assert f"M_OT {tipping:.4g} kN m" in words
    for one in checks:
        alone = text_of_report(one.report(tmp_path / "c.html", units=UNITS))
        assert numbers_in_si(alone) == []
        assert numbers_in_si(text_of_report(one.report(tmp_path / "c.html")))
    assert checks[2].lines["Forces"][0].written() == "9.80665 kN"
    with pytest.raises(
        ComponentError, match=r"CodeCheck\.report: units belong to kinds of quantities"
    ):
        checks[0].report(tmp_path / "c.html", units={"weight": "kN"})


def test_sweep_report_uses_display_units(tmp_path):
    system = rf.System(BLOCK, rf.RigidGround(friction=0.15))
    runs = rf.sweep(system, PULSE, width=["0.6 m", "0.7 m"], progress=False)
    target = rf.TargetSpectrum.eurocode_8("0.25 g_0", "B")
    path = rf.report(runs, tmp_path / "r.html", units=UNITS, target=target)
    words = text_of_report(path)
    assert numbers_in_si(words) == []
    most = 1e3 * float(runs.peak_slip.max())
    assert f"slid, by {most:.3g} mm at most" in words
    assert re.search(r"Simulated again: width [67]00 mm", words)


def test_histories_of_a_report_are_drawn_in_the_unit_of_angles(tmp_path, monkeypatch):
    """Degrees were drawn, whichever unit of angles the reader chose."""
    drawn, draw = [], rf.plot.response
    monkeypatch.setattr("rockframe.plot.response", lambda *a, **k: drawn.append(draw(*a, **k)))
    monkeypatch.setattr("rockframe.reports.page.captioned_figure", lambda *_: "")
    run = rf.System(BLOCK).simulate(PULSE)
    rf.report(run, tmp_path / "r.html", certify=False, units={"angle": "mrad"})
    assert drawn[0][1].get_ylabel() == "rotation [mrad]"


def test_titles_of_figures_follow_the_units(tmp_path):
    run = rf.System(BLOCK).simulate(PULSE, free_vibration="1 s", outputs=("energy",))
    turned = f"{np.degrees(float(run.peak_rotation)):.3g}"
    for draw in (rf.plot.response, rf.plot.phase, rf.plot.energies):
        panels = draw(run, units=UNITS)
        figure = panels.figure
        assert f"peak rotation {turned}°" in " ".join(figure.get_suptitle().split())
    assert f"peak rotation {turned}°" in rf.plot.player(run, units=UNITS).to_html()


@pytest.mark.parametrize("unit", ["gal", "kN", "quux"])
def test_wrong_unit_is_quoted_as_typed(unit):
    with pytest.raises(UnitsError) as caught:
        display_units({"acceleration": unit}, owner="report")
    words = str(caught.value)
    assert f"got '{unit}'" in words
    assert "m s^-2" in words
    assert "9.81" not in words  # the value of g, not the unit


@pytest.mark.parametrize(
    ("unit", "chosen", "factor"),
    [
        ("cm", "mm", 10.0),
        ("mrad", "°", 0.18 / np.pi),
        ("g_0", "g", 1.0),
        ("MJ", "kJ", 1e3),
        ("N cm", "kN m", 1e-5),
        ("km/h", "cm s^-1", 1e2 / 3.6),
        ("mm", "mm", 1.0),  # shown already
        ("g", "g", 1.0),  # of gravity, not a thousandth of a kilogram
        ("%", "%", 1.0),
        ("min", "min", 1.0),
    ],
)
def test_values_in_the_unit_of_a_user_are_shown_in_the_chosen_one(unit, chosen, factor):
    shown = display_units(UNITS, owner="a test").of(unit)
    assert shown.words == chosen
    assert shown.of(1.0) == pytest.approx(factor, rel=1e-12)


def test_converted_runs_have_tables_in_the_chosen_unit():
    run = rf.System(BLOCK).simulate(PULSE, outputs=None)
    turned = run.assign(peak_rotation=np.rad2deg(run.peak_rotation).assign_attrs(units="deg"))
    heads = [rf.table(one, units={"angle": "mrad"}) for one in (run, turned)]
    values = [table["peak_rotation [mrad]"].item() for table in heads]
    assert values[1] == pytest.approx(values[0], rel=1e-12)
