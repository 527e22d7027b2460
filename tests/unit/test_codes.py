"""Checks by codes: worked examples, comparisons with motions, and their pages."""

import math

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import ComponentError, FileError

WALL = rf.Block(width="0.5 m", height="6 m", mass="5.7 t")
LOW = rf.System(WALL, rf.RearWall(side="right"), gravity="9.81 m/s^2")
CABINET = rf.Block(width="0.6 m", height="1.8 m", mass="300 kg")
PULSES = {f"{v} m/s": rf.GroundMotion.type_a_pulse(f"{v} m/s", "1 s") for v in (0.3, 0.6)}


def spectrum(damping_ratio=0.08, acceleration=0.3):
    return rf.TargetSpectrum.from_table(
        (["0.1 s", "6 s"]), ([acceleration] * 2, "m/s^2"), damping_ratio=damping_ratio
    )


def test_circolare_reproduces_worked_example_of_a_wall():
    check = rf.codes.circolare_2019(LOW, spectrum(), confidence_factor=1)
    worked = {
        "alpha_0": 0.0833333, "e*": 1.0, "d_0": 0.25, "a_0*": 0.8175, "d_SLV": 0.10,
        "T_SLV": 2.383086, "d_SLC": 0.15, "T_SLC": 3.319298,
    }  # fmt: skip
    for symbol, value in worked.items():
        assert check.value(symbol) == pytest.approx(value, abs=6e-7), symbol
    demand = 0.3 * check.value("T_SLV") ** 2 / (4.0 * math.pi**2)
    assert check.value("d_demand") == pytest.approx(demand, rel=1e-12)
    assert check.passed == {"kinematic, SLV": True}
    later = rf.codes.circolare_2019(LOW, spectrum(0.1), confidence_factor=1, limit_state="SLC")
    demand = 0.3 * check.value("T_SLC") ** 2 / (4.0 * math.pi**2)
    assert later.value("d_demand") == pytest.approx(demand, rel=1e-12)
    strict = rf.codes.circolare_2019(LOW, spectrum(acceleration=1.2))
    assert strict.value("a_0*") == pytest.approx(0.8175 / 1.35)
    assert strict.passed == {"kinematic, SLV": False}
    sources = {one.symbol: one.source for one in check.lines["Mechanism and capacity"]}
    assert sources["alpha_0"] == "C8.7.1.1"
    assert sources["T_SLC"] == "C8.7.1.11"


def test_damage_limit_state_compares_activation_acceleration():
    for acceleration, passes in ((0.8, True), (0.83, False)):
        check = rf.codes.circolare_2019(
            LOW, spectrum(0.05, acceleration), confidence_factor=1, limit_state="SLD",
            elastic_period="0.5 s",
        )  # fmt: skip
        assert check.passed == {"kinematic, SLD": passes}
        assert check.value("S_e(T_0)") == pytest.approx(acceleration)
    motions = rf.codes.circolare_2019(LOW, PULSES, limit_state="SLD", elastic_period="0.5 s")
    found = rf.response_spectrum(PULSES, ["0.5 s"], 0.05).pseudo_spectral_acceleration
    assert motions.value("S_e(T_0)") == pytest.approx(float(found.mean()))


def test_circolare_includes_overburden_mass():
    """By hand: a floor of 2 t at the top, 0.1 m from the face towards which the wall falls."""
    floor = rf.Load(at=("-0.15 m", "6 m"), moving_mass="2 t")
    system = rf.System(WALL, rf.RigidGround(), floor, gravity="9.81 m/s^2")
    check = rf.codes.circolare_2019(system, spectrum(), confidence_factor=1)
    moment, level, square = 5.7 * 0.25 + 2 * 0.1, 5.7 * 3.0 + 2 * 6.0, 5.7 * 9.0 + 2 * 36.0
    assert check.value("alpha_0") == pytest.approx(moment / level)
    assert check.value("e*") == pytest.approx(level**2 / (7.7 * square))
    assert check.value("d_0") == pytest.approx(moment * square / level**2)
    with pytest.raises(ComponentError, match="which may carry loads that are masses"):
        rf.codes.circolare_2019(
            rf.System(WALL, rf.Load(at=("0 m", "6 m"), vertical="1 kN")), spectrum()
        )


def test_circolare_considers_the_weaker_or_free_side():
    eccentric = WALL.replace(eccentricity="0.05 m")
    free = rf.codes.circolare_2019(rf.System(eccentric), spectrum())
    assert free.value("d_0") == pytest.approx(0.2)  # to the right, the weaker side
    before = rf.System(eccentric, rf.RearWall(side="right"))
    assert rf.codes.circolare_2019(before, spectrum()).value("d_0") == pytest.approx(0.3)


def test_circolare_with_motions_matches_simulated_displacements():
    check = rf.codes.circolare_2019(rf.System(WALL), PULSES)
    moved = []
    for label, pulse in PULSES.items():
        run = rf.System(WALL).simulate(
            pulse, free_vibration="20 s", points={"centre": ("0 m", "3 m")}, outputs=None
        )
        found = check.value(f"d, {label}")
        if bool(run.overturned):
            assert found == pytest.approx(0.25)
        else:
            shown = float(run.peak_point_horizontal_displacement[0])
            assert found == pytest.approx(shown, rel=1e-6)  # the accuracy of peaks
        moved.append(found)
    assert check.value("mean of d") == pytest.approx(np.mean(moved))
    assert 0.0 < min(moved) < max(moved) == 0.25
    assert check.passed["dynamic, no run beyond d_0"] is False
    assert check.passed["dynamic, SLV"] is False
    for words in ("1 of 2 overturned: 0.6 m/s", "40 % of d_0", "60 % of d_0"):
        assert words in str(check)
    # one run that overturns is too many, however small the mean
    diluted = {f"gentle {k}": PULSES["0.3 m/s"].scaled(0.5) for k in range(5)}
    check = rf.codes.circolare_2019(WALL, {**diluted, "0.6 m/s": PULSES["0.6 m/s"]})
    assert check.value("mean of d") < check.value("d_SLV")
    assert check.passed["dynamic, SLV"] is False
    # one of them has its greatest spectral displacement at a short period
    pulses = {"a": rf.GroundMotion.type_c_pulse("0.2 m/s", "0.5 s", order=3)}
    pulses["b"] = PULSES["0.3 m/s"].scaled(0.1)
    gentle = rf.codes.circolare_2019(WALL, pulses)
    assert gentle.passed["dynamic, SLV"]
    wide = rf.codes.circolare_2019(WALL, rf.GroundMotion.type_a_pulse("0.4 m/s", "1 s"))
    assert wide.value("d_SLV") < wide.value("mean of d") < wide.value("d_0")
    assert wide.passed["dynamic, no run beyond d_0"]
    assert not wide.passed["dynamic, SLV"]
    displacement = rf.response_spectrum(
        pulses, (np.geomspace(0.2, gentle.value("T_SLV"), 80), "s"), 0.08
    ).spectral_displacement
    demand = float(displacement.mean("motion").max())
    assert gentle.value("d_demand") == pytest.approx(demand, rel=1e-9)


def test_displacement_to_the_stronger_side_is_not_capped():
    """The peak was once limited to d_0 of the weaker side, so that the wall seemed to pass."""
    eccentric = WALL.replace(eccentricity="0.15 m")
    system = rf.System(eccentric, rf.RigidGround(restitution=0.05))
    pulse = rf.GroundMotion.type_a_pulse("1.5 m/s", "1.5 s")
    run = system.simulate(pulse, free_vibration="20 s", points={"centre": ("0.15 m", "3 m")})
    assert not bool(run.overturned)
    check = rf.codes.circolare_2019(system, pulse)
    moved = float(abs(run.point_horizontal_displacement).max())
    assert moved > 2.5 * check.value("d_0")
    assert check.value("mean of d") == pytest.approx(moved, rel=1e-3)
    assert not check.passed["dynamic, no run beyond d_0"]
    assert not check.passed["dynamic, SLV"]
    assert "0 of 1 overturned, d_0 = 0.1 m; 1 beyond d_0 to the other side" in str(check)


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        ((rf.System(WALL), spectrum(0.05)), "must be of a damping ratio of 0.08, got 0.05"),
        (("wall.toml", spectrum()), "system needs a System"),
        ((rf.System(WALL), {}), "no motions"),
        ((rf.System(WALL), "record.AT2"), "expected a GroundMotion"),
        (
            (rf.System(WALL, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)), PULSES),
            r"got Block, TwoSpringSupport, two-spring; check the block alone, rf.System\(block\)",
        ),
    ],
)
def test_scenes_that_cannot_be_checked_are_refused(scene, words):
    with pytest.raises(ComponentError, match=words):
        rf.codes.circolare_2019(*scene)
    loaded = rf.System(CABINET, rf.Load(at=("0 m", "1.8 m"), moving_mass="20 kg"))
    with pytest.raises(ComponentError, match="block on level rigid ground, got Block, Load"):
        rf.codes.asce_7_22(loaded, spectral_acceleration=1.0)


def test_invalid_check_arguments_are_refused():
    with pytest.raises(ComponentError, match="'SLV', 'SLC', 'SLD', got 'SLO'"):
        rf.codes.circolare_2019(LOW, spectrum(), limit_state="SLO")
    with pytest.raises(ComponentError, match="elastic_period goes with limit_state='SLD'"):
        rf.codes.circolare_2019(LOW, spectrum(), limit_state="SLD")
    with pytest.raises(ComponentError, match="1 or more"):
        rf.codes.circolare_2019(LOW, spectrum(), confidence_factor=0.9)
    with pytest.raises(ComponentError, match="got 'T_SLD'; was 'T_SLV'"):
        rf.codes.circolare_2019(LOW, spectrum()).value("T_SLD")


def test_asce_check_of_a_component_matches_formulas():
    given = {"spectral_acceleration": 1.2, "importance": 1.5, "height_factor": 2.5}
    factors = {"ductility_factor": 1.3, "resonance_factor": 1.4, "strength_factor": 1.5}
    check = rf.codes.asce_7_22(CABINET, PULSES, **given, **factors, friction=0.6)
    weight = 300.0 * 9.80665
    force = 0.4 * 1.2 * 1.5 * weight * (2.5 / 1.3) * (1.4 / 1.5)
    assert check.value("F_p, formula") == pytest.approx(force)
    assert check.value("F_p") == pytest.approx(force)
    assert check.value("F_v") == pytest.approx(0.2 * 1.2 * weight)
    assert check.value("M_OT") == pytest.approx(force * 0.9)
    lifted = 0.9 * weight - 0.2 * 1.2 * weight  # by the simultaneous vertical force
    assert check.value("M_R") == pytest.approx(0.9 * weight * 0.3)
    assert check.value("M_R, with F_v") == pytest.approx(lifted * 0.3)
    assert check.value("M_anchors") == pytest.approx(force * 0.9 - lifted * 0.3)
    assert check.value("mu") == pytest.approx(force / (0.9 * weight))
    assert check.value("mu, with F_v") == pytest.approx(force / lifted)
    assert check.passed == {"tipping": False, "sliding": False, "motion": True}
    most = rf.codes.asce_7_22(CABINET, **(given | {"height_factor": 30.0}))
    assert most.value("F_p") == pytest.approx(1.6 * 1.2 * 1.5 * weight)
    least = rf.codes.asce_7_22(CABINET, **(given | {"height_factor": 0.1}))
    assert least.value("F_p") == pytest.approx(0.3 * 1.2 * 1.5 * weight)
    lifted = rf.codes.asce_7_22(CABINET, spectral_acceleration=5, friction=1)
    assert (lifted.value("M_R, with F_v"), lifted.value("mu, with F_v")) == (0.0, math.inf)
    assert lifted.passed == {"tipping": False, "sliding": False}
    squat = rf.Block(width="2 m", height="1.6 m", mass="1 t")
    firm = rf.codes.asce_7_22(squat, spectral_acceleration=0.5)
    assert firm.passed == {"tipping": True}
    assert firm.value("M_anchors") == 0.0
    # omitted factors are one
    assert firm.value("F_p, formula") == pytest.approx(0.4 * 0.5 * firm.value("W_p"), rel=1e-12)
    needed = firm.value("mu, with F_v")
    enough = rf.codes.asce_7_22(squat, spectral_acceleration=0.5, friction=needed)
    assert enough.passed == {"tipping": True, "sliding": True}


def test_asce_check_reports_overturning_under_floor_motion():
    floor = rf.GroundMotion.sine_pulse("9 m/s^2", "0.5 Hz")
    check = rf.codes.asce_7_22(CABINET, floor, spectral_acceleration=1.0)
    assert not check.passed["motion"]
    assert "1 of 1 overturned" in str(check)
    assert "overturned" in [line.words for line in check.lines["Motion on the floor"]]


def test_asce_check_moves_a_block_on_the_friction_that_is_given():
    floor = rf.GroundMotion.sine_pulse("9 m/s^2", "0.5 Hz")
    by_argument = rf.codes.asce_7_22(CABINET, floor, spectral_acceleration=1.0, friction=0.3)
    scene = rf.System(CABINET, rf.RigidGround(friction=0.3))
    by_ground = rf.codes.asce_7_22(scene, floor, spectral_acceleration=1.0)
    assert by_argument.passed == by_ground.passed
    assert by_argument.passed["motion"]  # held in place it overturns
    assert by_argument.scene == by_ground.scene


def test_anchors_carry_net_uplift_of_the_vertical_force():
    check = rf.codes.asce_7_22(CABINET, spectral_acceleration=5.0)
    values = {name: check.value(name) for name in ("M_OT", "W_p", "F_v", "M_R, with F_v")}
    net = 0.9 * values["W_p"] - values["F_v"]
    assert net < 0.0 == values["M_R, with F_v"]
    assert check.value("M_anchors") == pytest.approx(values["M_OT"] - 0.3 * net, rel=1e-12)


@pytest.mark.parametrize(("side", "arm"), [("left", 0.4), ("right", 0.2)])
def test_a_component_before_a_wall_tips_away_from_it(side, arm):
    body = CABINET.replace(centre_of_mass=("0.9 m", "-0.1 m"))
    system = rf.System(body, rf.RearWall(side=side))
    check = rf.codes.asce_7_22(system, spectral_acceleration=1.0)
    assert check.value("M_R") == pytest.approx(0.9 * check.value("W_p") * arm, rel=1e-12)


def test_checks_use_ground_friction_and_refuse_sliding_blocks():
    tiles = rf.System(CABINET, rf.RigidGround(friction=0.3))
    check = rf.codes.asce_7_22(tiles, spectral_acceleration=1.2)
    assert check.passed == {"tipping": False, "sliding": False}
    assert "there is 0.3" in str(check)
    with pytest.raises(ComponentError, match="or with sliding='checked', which holds it"):
        rf.codes.circolare_2019(tiles, spectrum())
    held = rf.System(CABINET, rf.RigidGround(friction=0.3), sliding="checked")
    assert rf.codes.circolare_2019(held, spectrum()).value("alpha_0") == pytest.approx(1 / 3)


def test_check_text_and_report_contain_sources(tmp_path):
    check = rf.codes.circolare_2019(LOW, PULSES)
    text = str(check)
    for words in ("T_SLV", "C8.7.1.10", "C8.7.1.2.1.9", "d, 0.3 m/s", "Left out: interlocking"):
        assert words in text
    assert "kinematic, SLV" in check._repr_html_()
    page = check.report(tmp_path / "facade.html")
    written = page.read_text(encoding="utf-8")
    for words in ("C8.7.1.11", "1.56 pi", "Left out", "Circolare"):
        assert words in written
    with pytest.raises(FileError):
        check.report(tmp_path / "facade.pdf")
