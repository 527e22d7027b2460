"""A rocking frame with tendons: closed forms, limits, energies, symmetry, files and figures."""

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.command.files.scenes import read_scene
from rockframe.errors import ComponentError

PIER = rf.Block(width="1.6 m", height="9.6 m", mass="60 t")
BENT = rf.RockingFrame(PIER, columns=3, beam_mass="200 t", spacing="7 m", beam_height="1.5 m")
TENDON = rf.Tendon(stiffness="5 MN/m", preload="200 kN")
PULSE = rf.GroundMotion.sine_pulse("4 m/s^2", "0.7 Hz")
PLAN = {"free_vibration": "4 s", "accuracy": "reference", "outputs": ("energy", "reaction")}


def test_moments_and_uplift_match_closed_forms():
    angles = np.array([-0.12, -0.03, 0.01, 0.05, 0.15])
    with_tendons, without = (
        rf.System(*parts).moment_rotation((angles, "rad")).restoring_moment.values
        for parts in ((BENT, TENDON), (BENT,))
    )
    b, number, side, lean = 0.8, 3, np.sign(angles), np.abs(angles)
    force = 2e5 + 5e6 * 4.0 * b * np.sin(0.5 * lean)
    added = side * number * force * 2.0 * b * np.cos(0.5 * lean)
    np.testing.assert_allclose(with_tendons - without, added, rtol=1e-11)
    system = rf.System(BENT, TENDON)
    rest = system.equilibrium()
    weight = 380e3 * system.options.gravity
    np.testing.assert_allclose(rest.static_left_reaction, 0.5 * (weight + 6e5), rtol=1e-13)
    starts = system.setting.uplift_acceleration
    for share, rocks in ((0.999, False), (1.001, True)):
        level = share * starts
        motion = rf.GroundMotion.from_arrays(([0.0, level, level, 0.0], "m/s^2"), time_step="0.2 s")
        assert (float(system.simulate(motion).peak_rotation) > 0.0) is rocks


def test_tendon_without_stiffness_changes_nothing():
    weak = rf.Tendon(stiffness="1e-9 N/m")
    run = rf.System(BENT, weak).simulate(PULSE.scaled(0.7), **PLAN)
    bare = rf.System(BENT).simulate(PULSE.scaled(0.7), **PLAN)
    assert int(bare.impact_count) > 1
    np.testing.assert_allclose(run.rotation, bare.rotation, rtol=0.0, atol=1e-9)
    for name in ("base_shear", "left_reaction", "kinetic_energy", "base_overturning_moment"):
        scale = float(abs(bare[name]).max())
        np.testing.assert_allclose(run[name], bare[name], rtol=0.0, atol=1e-6 * scale)


def test_reactions_at_rest_shift_to_one_corner_at_uplift():
    system = rf.System(BENT, TENDON)
    starts, rest = system.setting.uplift_acceleration, system.equilibrium()
    shares = np.array([0.0, 0.25, 0.5, 0.999, 0.0])
    motion = rf.GroundMotion.from_arrays((-shares * starts, "m/s^2"), time_step="0.2 s")
    run = system.simulate(motion, outputs=("reaction",))
    assert float(run.peak_rotation) == 0.0
    press = 2.0 * float(rest.static_left_reaction)
    np.testing.assert_allclose(run.left_reaction, 0.5 * (1.0 - shares) * press, rtol=1e-9)
    np.testing.assert_allclose(run.right_reaction, 0.5 * (1.0 + shares) * press, rtol=1e-9)
    np.testing.assert_allclose(
        run.base_overturning_moment, shares * float(rest.uplift_moment), rtol=1e-9, atol=1e-3
    )


def test_base_moment_of_frame_is_that_of_bearing_corners():
    run = rf.System(BENT, TENDON).simulate(PULSE.scaled(1.5), **PLAN)
    lean = run.rotation.values
    assert abs(lean).max() > 0.01
    shift = (run.right_reaction - run.left_reaction).values * np.cos(lean)
    expected = 0.8 * (shift + run.horizontal_reaction.values * np.sin(np.abs(lean)))
    np.testing.assert_allclose(run.base_overturning_moment, expected, rtol=1e-12, atol=1e-3)
    risen = 0.8 * np.sin(abs(lean[-1]))  # of the middle of each foot
    assert float(run.residual_settlement) == pytest.approx(-risen, rel=1e-12)
    assert float(run.peak_settlement) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.long
def test_frame_without_beam_matches_block_with_equivalent_tendon():
    """Without a beam, a column with a tendon at half of its gaps is a block with that tendon."""
    frame = rf.RockingFrame(PIER, columns=2, beam_mass="0 t")
    twice = rf.Tendon(stiffness="20 MN/m", preload="0.8 MN")
    once = rf.Tendon(stiffness="5 MN/m", preload="0.4 MN")
    ours = rf.System(PIER, twice).simulate(PULSE, **PLAN)
    theirs = rf.System(frame, once).simulate(PULSE, **PLAN)
    assert int(ours.impact_count) > 1
    np.testing.assert_allclose(theirs.rotation, ours.rotation, rtol=0.0, atol=1e-8)
    scale = float(ours.peak_restrainer_force[0])
    np.testing.assert_allclose(
        2.0 * theirs.restrainer_force, ours.restrainer_force, rtol=0.0, atol=1e-7 * scale
    )


@pytest.mark.parametrize(
    ("options", "kinds"),
    [
        ({"preload": "200 kN"}, {2}),
        ({}, {2}),
        ({"preload": "200 kN", "strength": "0.5 MN"}, {2, 12, 13, 14, 15}),
        ({"preload": "200 kN", "strength": "0.5 MN", "brittle": True}, {2, 16}),
    ],
)
def test_energy_balances_and_mirrored_motion_mirrors_response(options, kinds):
    system = rf.System(BENT, rf.Tendon(stiffness="5 MN/m", **options))
    run = system.simulate(PULSE, **PLAN)
    assert float(run.energy_residual) < 1e-8
    assert kinds <= set(run.event_kind.values.tolist())
    mirrored = system.simulate(PULSE.scaled(-1.0), **PLAN)
    np.testing.assert_allclose(mirrored.rotation, -run.rotation, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(
        mirrored.left_reaction, run.right_reaction, rtol=0.0, atol=1e-5 * 4e6
    )


def test_frame_with_tendon_in_files_sweeps_certificates_and_figures(tmp_path):
    system = rf.System(BENT, TENDON)
    run = system.simulate(PULSE, free_vibration="2 s")
    run.to_netcdf(tmp_path / "bent.nc")
    with xr.open_dataset(tmp_path / "bent.nc") as read:
        assert rf.System.from_dataset(read).parts.links == (TENDON,)
        assert read.restrainer_force.dims == ("restrainer", "time")
    file = tmp_path / "bent.toml"
    file.write_text(
        "[frame]\ncolumns = 3\nbeam_mass = '200 t'\nspacing = '7 m'\nbeam_height = '1.5 m'\n"
        "[frame.column]\nwidth = '1.6 m'\nheight = '9.6 m'\nmass = '60 t'\n"
        "[[restrainer]]\ntype = 'Tendon'\nstiffness = '5 MN/m'\npreload = '200 kN'\n"
    )
    assert read_scene(file).system == system
    runs = rf.sweep(
        system, motions=[PULSE], axes={"preload": (["0.1 MN", "0.2 MN"])}, progress=False
    )
    assert runs.peak_rotation.size == 2
    assert "longer by 4 b sin" in system.describe()
    rf.plot.scene(system)
    rf.plot.state(run)
    with pytest.raises(ComponentError, match="proofs are of a Block on rigid ground"):
        rf.prove(system, rf.GroundMotion.example("loma-prieta"))
