"""A block that slides on its cap, and a cap on its soil, as a stack of two bodies."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import rockframe as rf
from rockframe.dynamics.events import EventKind
from rockframe.results.points import Placement
from rockframe.system.geometry import geometry_of

pytestmark = pytest.mark.wide

BLOCK = rf.Block(width="1 m", height="4 m", mass="4 t")
CAP = rf.CushionCap(width="2 m", height="0.5 m", mass="2 t")
PLATE = rf.Block(width="2 m", height="0.5 m", mass="2 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2)
PUSH = rf.GroundMotion.sine_pulse("3.5 m/s^2", "2 Hz")
PLAN = {"duration": "1.5 s", "accuracy": "standard"}


def on_cap(pads, soil, **options):
    bases = PADS.replace(friction=pads), SOIL.replace(friction=soil)
    return rf.System(BLOCK, CAP, *bases, **options)


def stacked(pads, soil):
    joint = PADS.replace(friction=pads)
    return rf.System(rf.Stack(BLOCK, PLATE, interfaces=[joint]), SOIL.replace(friction=soil))


@pytest.mark.parametrize(("pads", "soil"), [(0.12, 0.15), (0.1, None), (None, 0.15)])
def test_block_and_cap_equal_a_two_body_stack(pads, soil):
    run = on_cap(pads, soil).simulate(PUSH, outputs=("energy", "cap_acceleration"), **PLAN)
    other = stacked(pads, soil).simulate(PUSH, outputs=("energy",), **PLAN)
    for name in ("rotation", "horizontal_displacement", "base_shear", "slip", "slip_velocity"):
        np.testing.assert_allclose(run[name], other[name], rtol=1e-9, atol=1e-9)
    lower = other.sel(body=2)
    np.testing.assert_allclose(run.cap_rotation, lower.body_rotation, atol=1e-12)
    np.testing.assert_allclose(
        run.cap_vertical_displacement, lower.body_vertical_displacement, atol=1e-12
    )
    np.testing.assert_allclose(run.event_time, other.event_time, rtol=1e-9)
    assert run.energy_residual < 1e-6
    assert float(run.peak_slip) == pytest.approx(float(other.peak_body_slip[0]), abs=1e-12)
    assert ("cap_slip" in run) is (soil is not None)
    if soil is not None:
        np.testing.assert_allclose(run.cap_slip, lower.body_slip, atol=1e-12)
        assert float(run.peak_cap_slip) == pytest.approx(float(lower.peak_body_slip), abs=1e-12)
        assert float(run.residual_cap_slip) == float(run.cap_slip[-1])
        assert float(run.peak_cap_slip) > 1e-4
    else:
        assert float(run.peak_slip) > 1e-3


def test_high_friction_prevents_sliding():
    # small slips remain: when the held point of one body changes, a force stops the other body's
    # slip, not the same impulse
    run, held = (on_cap(one, one).simulate(PUSH, **PLAN) for one in (1e6, None))
    assert held.attrs["model"] == "coupled"
    assert run.attrs["model"] == "coupled-sliding"
    np.testing.assert_allclose(run.rotation, held.rotation, atol=1e-4)
    np.testing.assert_allclose(run.cap_rotation, held.cap_rotation, atol=1e-4)
    assert float(run.peak_slip) < 1e-7
    assert float(run.peak_cap_slip) < 1e-7


@pytest.mark.parametrize(
    ("block", "options"),
    [(BLOCK, {"inclination": "3 deg"}), (BLOCK.replace(eccentricity="0.05 m"), {})],
)
def test_leaning_block_with_high_friction_equals_held_block(block, options):
    pads = (PADS.replace(friction=one) for one in (1e3, None))
    run, held = (rf.System(block, one, CAP, SOIL, **options).simulate(PUSH, **PLAN) for one in pads)
    assert held.rotation[0] != 0.0
    np.testing.assert_allclose(run.rotation, held.rotation, atol=1e-5)
    np.testing.assert_allclose(run.cap_rotation, held.cap_rotation, atol=1e-5)


def test_the_mirrored_motion_is_mirrored():
    system = on_cap(0.12, 0.15)
    run, other = system.simulate(PUSH, **PLAN), system.simulate(PUSH.scaled(-1.0), **PLAN)
    for name in ("rotation", "slip", "cap_slip", "cap_rotation"):
        np.testing.assert_allclose(run[name], -other[name], atol=1e-10)


def test_verdict_and_events_name_the_cap():
    run = on_cap(0.12, 0.15).simulate(PUSH, **PLAN)
    assert run.attrs["verdict"].startswith("The block slid ")
    assert ", the cap slid " in run.attrs["verdict"]
    assert {EventKind.SLIP, EventKind.STICK, EventKind.SOIL_CONTACT} <= set(run.event_kind.values)
    assert "would_slide" not in run


def test_checked_sliding_warns_for_block_and_cap():
    system = on_cap(0.12, 0.15, sliding="checked")
    with pytest.warns(rf.errors.ModelWarning) as caught:
        run = system.simulate(PUSH, **PLAN)
    words = " ".join(str(one.message) for one in caught)
    assert "the block would slide" in words
    assert "the cap would slide" in words
    assert bool(run.would_slide)
    assert "slip" not in run
    with pytest.warns(rf.errors.ModelWarning, match="would slide"):
        run = on_cap(0.12, 0.15, coupling="cascade").simulate(PUSH, **PLAN)
    assert bool(run.would_slide)


def test_sliding_with_small_rotations_is_refused():
    with pytest.raises(rf.errors.AssemblyError, match="sliding='checked'"):
        on_cap(0.12, 0.15, rotation="small").describe()


def test_cap_is_drawn_at_its_slip():
    system, joints = on_cap(None, 0.1), stacked(None, 0.1)
    run, other = system.simulate(PUSH, **PLAN), joints.simulate(PUSH, **PLAN)
    values = {
        name: float(run[name][-1])
        for name in ("cap_slip", "cap_rotation", "cap_angular_velocity", "soil_contact_state")
    }
    geometry = geometry_of(system.assembly)
    middle = Placement(geometry, values, system.restraint).cap(np.array([(0.0, 0.25)]))
    assert abs(values["cap_slip"]) > 5e-3
    assert middle[0, 0] == pytest.approx(float(other.body_horizontal_displacement[1, -1]), abs=5e-4)


def test_block_sliding_beyond_the_cap_edge_warns():
    short = CAP.replace(width="1.02 m")
    system = rf.System(BLOCK, PADS.replace(friction=0.05), short, SOIL)
    with pytest.warns(rf.errors.ModelWarning, match="the block slides .* beyond the edge of the c"):
        system.simulate(PUSH.scaled(1.5), **PLAN)


def test_cap_slip_is_reported_and_plotted():
    system = on_cap(None, 0.1)
    runs = rf.sweep(system, PUSH, duration="1.5 s", scale=[0.1, 1.0])
    assert "; 1 slid, by 0.0" in runs.attrs["verdict"]
    assert runs.peak_cap_slip.squeeze()[1] > 1e-3 > runs.peak_cap_slip.squeeze()[0]
    axes = rf.plot.response(system.simulate(PUSH, **PLAN))
    panel = next(one for one in axes if one.get_ylabel().startswith("slip"))
    assert [line.get_label() for line in panel.lines[:2]] == ["block", "cap"]
    plt.close("all")


def test_the_slips_of_all_bodies_of_a_stack_are_drawn():
    run = stacked(None, 0.1).simulate(PUSH, **PLAN)
    panel = next(one for one in rf.plot.response(run) if one.get_ylabel().startswith("body slip"))
    assert len([line for line in panel.lines if not line.get_label().startswith("_")]) == 2
    plt.close("all")
