"""Columns under a beam: the part, the scene, runs, figures and files."""

import json
import pickle

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.command.files.scenes import read_scene
from rockframe.errors import AssemblyError, ComponentError, ModelWarning
from rockframe.plot._layout import LayoutBuilder
from rockframe.plot._scene import SceneHistory
from rockframe.reports.limits import model_limits
from rockframe.results.points import UPRIGHT, Placement
from rockframe.simulation.certify.perturbations import parameters
from rockframe.system.geometry import geometry_of
from rockframe.system.options import Restraint

PIER = rf.Block(width="1.6 m", height="9.6 m", mass="60 t")
BENT = rf.RockingFrame(PIER, columns=3, beam_mass="200 t", spacing="7 m", beam_height="1.5 m")
PULSE = rf.GroundMotion.sine_pulse("4 m/s^2", "0.7 Hz")


def test_rocking_frame_attributes_and_round_trips():
    assert BENT.column == PIER
    assert BENT.columns == 3
    assert BENT.beam_mass.m_as("t") == pytest.approx(200.0)
    described = json.loads(json.dumps(BENT.to_dict()))
    assert rf.RockingFrame.from_dict(described) == BENT
    assert pickle.loads(pickle.dumps(BENT)) == BENT  # noqa: S301
    assert len({BENT, BENT.replace(columns=4), BENT.replace(columns=3)}) == 2
    assert eval(repr(BENT), vars(rf)) == BENT  # noqa: S307
    assert "<svg" in BENT._repr_html_()


@pytest.mark.parametrize(
    ("column", "arguments", "words"),
    [
        (PIER, {"columns": 1}, "columns must be 2 or more, got 1"),
        (PIER, {"columns": 2.5}, "whole number"),
        (PIER, {"beam_mass": "-1 t"}, "beam_mass"),
        ("1.6 m", {}, "column must be a Block"),
        (PIER.replace(eccentricity="0.1 m"), {}, "eccentricity of 0.1 m"),
    ],
)
def test_invalid_rocking_frame_is_refused(column, arguments, words):
    with pytest.raises(ComponentError, match=words):
        rf.RockingFrame(column, **({"columns": 3, "beam_mass": "200 t"} | arguments))


@pytest.mark.parametrize(
    ("parts", "ends"),
    [
        ((BENT,), "which this model cannot show$"),
        ((PIER, rf.RearWall()), "; give the wall a stiffness to follow its flight$"),
        ((PIER,), "; put it on a TwoSpringSupport to follow its flight$"),
    ],
    ids=["frame", "wall", "pier"],
)
def test_flight_warning_suggests_a_remedy(parts, ends):
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    with pytest.warns(ModelWarning, match=ends):
        rf.System(*parts).simulate(pulse.with_vertical(pulse.scaled(11.0)), outputs=None)


def test_tendon_preload_prevents_flight():
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    motion = pulse.with_vertical(pulse.scaled(11.0))
    pressed = rf.System(BENT, rf.Tendon(stiffness="1 MN/m", preload="5 MN"))
    run = pressed.simulate(motion)  # warnings are errors
    assert float((run.left_reaction + run.right_reaction).min()) > 0.0
    hardly = rf.System(BENT, rf.Tendon(stiffness="1 kN/m", preload="1 kN"))
    with pytest.warns(ModelWarning, match="have to pull at the bearing corner"):
        hardly.simulate(motion)
    with pytest.warns(ModelWarning, match="beyond gravity: unless links press it on, the block"):
        pressed.simulate(motion, outputs=None)


def test_unsupported_parts_with_a_rocking_frame_are_refused():
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    with pytest.raises(AssemblyError, match="a RockingFrame stands on rigid ground"):
        rf.System(BENT, pads)
    for changes in ({"at": "0.1 m"}, {"depth": "1 m"}):
        with pytest.raises(AssemblyError, match="goes along the axis of each column"):
            rf.System(BENT, rf.Tendon(stiffness="1 MN/m", **changes))
    load = rf.Load(at=("0 m", "1 m"), vertical="1 kN")
    with pytest.raises(AssemblyError, match="nothing else but tendons"):
        rf.System(BENT, load)
    with pytest.raises(AssemblyError, match="rotation='finite'"):
        rf.System(BENT, rf.Tendon(stiffness="1 MN/m"), rotation="small")
    with pytest.raises(AssemblyError, match="RockingFrame and Block are both given"):
        rf.System(BENT, PIER)
    tendon = rf.Tendon(stiffness="1 MN/m", name="one")
    with pytest.raises(AssemblyError, match="two links are called 'one'"):
        rf.System(BENT, tendon, tendon)
    squat = rf.Block(width="1 m", height="0.9 m", mass="1 t")
    with pytest.raises(AssemblyError, match="so squat that the frame cannot rock"):
        rf.System(rf.RockingFrame(squat, columns=2, beam_mass="50 t"))


@pytest.mark.parametrize(
    ("gamma", "frequency", "restitution"),
    [
        (0, 1.0, 0.911765), (1, 0.866025, 0.889706), (4, 0.832050, 0.884615),
        (10, 0.823055, 0.883302),
    ],
)  # fmt: skip
def test_frame_frequency_and_restitution_match_closed_form(gamma, frequency, restitution):
    column = rf.Block(width="1 m", height="4 m", mass="1 t")
    frame = rf.RockingFrame(column, columns=2, beam_mass=f"{2 * gamma} t")
    setting = rf.System(frame).setting
    assert setting.overturning_angle == pytest.approx(np.arctan(0.25), rel=1e-15)
    ratio = setting.body.frequency_at(9.81) / column.si.frequency_at(9.81)
    exact = np.sqrt((1 + 2 * gamma) / (1 + 3 * gamma))
    assert ratio == pytest.approx(exact, rel=1e-14)
    assert ratio == pytest.approx(frequency, abs=6e-7)
    angle = np.arctan(0.25)
    closed = 1 - 1.5 * np.sin(angle) ** 2 + 3 * gamma * np.cos(2 * angle)
    assert setting.restitution.left == pytest.approx(closed / (1 + 3 * gamma), rel=1e-14)
    assert setting.restitution.left == pytest.approx(restitution, abs=6e-7)


def test_frame_with_massless_beam_equals_a_single_column():
    plan = {"free_vibration": "6 s", "outputs": ("reaction", "acceleration", "energy")}
    frame = rf.RockingFrame(PIER, columns=3, beam_mass="0 t")
    pulse = PULSE.scaled(0.6)
    several = rf.System(frame).simulate(pulse, **plan)
    alone = rf.System(PIER).simulate(pulse, **plan)
    assert int(alone.impact_count) == 3
    np.testing.assert_allclose(several.rotation, alone.rotation, rtol=0.0, atol=1e-11)
    shared = ("vertical_reaction", "base_shear", "base_overturning_moment", "kinetic_energy")
    for name in shared:
        scale = float(abs(alone[name]).max())
        np.testing.assert_allclose(several[name], 3.0 * alone[name], rtol=0.0, atol=1e-9 * scale)


def test_point_acceleration_peaks_match_histories_at_zero_rotation():
    column = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
    run = rf.System(rf.RockingFrame(column, columns=3, beam_mass="5 t")).simulate(
        rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz"), output_step="0.5 ms",
        outputs=("point_vertical_acceleration",),
        points={"foot": ("-0.4 m", "0 m"), "top": ("0.1 m", "2.5 m"), "beam": ("0 m", "3.5 m")},
    )  # fmt: skip
    sampled = abs(run.point_vertical_acceleration).max("time")
    np.testing.assert_allclose(run.peak_point_vertical_acceleration, sampled, rtol=2e-3)


def test_frame_run_balances_energy_and_survives_netcdf_round_trip(tmp_path):
    system = rf.System(BENT)
    run = system.simulate(
        PULSE, free_vibration="6 s", accuracy="reference", outputs=("energy", "reaction")
    )
    assert float(run.energy_residual) < 1e-8
    assert "rocking frame" in run.attrs["model"]
    run.to_netcdf(tmp_path / "bent.nc")
    with xr.open_dataset(tmp_path / "bent.nc") as read:
        again = rf.System.from_dataset(read)
        assert again.parts.frame == BENT
        np.testing.assert_array_equal(
            again.simulate(free_vibration="6 s", accuracy="reference").rotation, read.rotation
        )
    text = system.describe()
    for words in ("Makris and Vassiliou", "gamma = m_b/(N m)  1.11111", "6.54421 m"):
        assert words in text
    assert "<svg" in system._repr_html_()
    assert "Rocking frames" in [one.title for one in model_limits(system.parts)]


def test_frame_statics_match_closed_form():
    system = rf.System(BENT)
    weight, half = 380e3 * system.options.gravity, 0.8
    at = system.moment_rotation(["0.05 rad"])
    # the beam rises twice as fast as the centres of the columns
    lever = (180.0 + 2.0 * 200.0) / 380.0 * np.hypot(0.8, 4.8)
    angle = np.arctan(1.0 / 6.0)
    assert at.restoring_moment.item() == pytest.approx(weight * lever * np.sin(angle - 0.05))
    assert at.base_moment.item() == pytest.approx(weight * half * np.cos(0.05))
    assert system.equilibrium().uplift_moment.item() == pytest.approx(weight * half)


def test_columns_and_beam_are_drawn_at_their_positions():
    run = rf.System(BENT).simulate(
        PULSE, free_vibration="3 s", points={"deck": ("0 m", "11 m"), "head": ("0.8 m", "9.6 m")}
    )
    for place in (0, run.sizes["time"] // 3, int(np.abs(run.rotation.to_numpy()).argmax())):
        moving = SceneHistory(run, "state", 1.0)
        at = moving.placement_at(place)
        found = moving.builder.layout_at(at)
        first, others, beam = found.block, found.frame_parts[:-1], found.frame_parts[-1]
        assert len(others) == 2
        for k, one in enumerate(others, 1):
            np.testing.assert_allclose(one, first + np.array([7.0 * k, 0.0]), atol=1e-12)
        assert np.ptp(beam[:2, 1]) == pytest.approx(0.0, abs=1e-12)
        # the beam rests on the higher of the upper corners
        assert beam[0, 1] == pytest.approx(first[2:, 1].max(), abs=1e-12)
        deck, head = (run.isel(point=k, time=place) for k in (0, 1))
        for name, point, rest in (("deck", deck, (0.0, 11.0)), ("head", head, (-6.2, 9.6))):
            shown = [point.point_horizontal_displacement, point.point_vertical_displacement]
            points = moving.builder.points_at(at, np.array([moving.points[name]]))[0]
            np.testing.assert_allclose(points - rest, shown, atol=1e-9)
    upright = Placement(geometry_of(rf.System(BENT).assembly), UPRIGHT, Restraint.CONTACT_STATE)
    assert len(LayoutBuilder(upright.geometry).layout_at(upright).contacts) == 3
    rf.plot.scene(rf.System(BENT))
    rf.plot.state(run, "1 s")


def test_sweeps_certificates_and_files(tmp_path):
    runs = rf.sweep(
        rf.System(BENT), motions=[PULSE], beam_mass=["0 t", "200 t"], columns=[2, 3],
        accuracy="fast", progress=False,
    )  # fmt: skip
    assert runs.peak_rotation.shape == (2, 2, 1)
    one = rf.System(BENT.replace(columns=2)).simulate(PULSE, accuracy="fast", outputs=None)
    assert float(runs.peak_rotation[1, 0, 0]) == float(one.peak_rotation)
    names = [name for name, _ in parameters(rf.System(BENT).assembly)]
    assert names == [
        "width of column of the frame", "height of column of the frame",
        "mass of column of the frame", "beam mass of the frame",
    ]  # fmt: skip
    assert all(at(0.01) is not None for _, at in parameters(rf.System(BENT).assembly))
    assert list(rf.model_ladder(rf.System(BENT))) == [
        "rigid ground, small rotations",
        "rigid ground",
    ]
    file = tmp_path / "bent.toml"
    file.write_text(
        "[frame]\ncolumns = 3\nbeam_mass = '200 t'\nspacing = '7 m'\nbeam_height = '1.5 m'\n"
        "[frame.column]\nwidth = '1.6 m'\nheight = '9.6 m'\nmass = '60 t'\n"
    )
    assert read_scene(file).system == rf.System(BENT)
