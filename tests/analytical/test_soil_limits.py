"""Limits of scenes for stiff soil, stiff pads and small caps."""

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import ModelWarning

pytestmark = pytest.mark.analytical

RULES = ("contact-state", "leading-corner", "centre")
SMOOTH = ("rotation", "horizontal_displacement")
"""Histories without jumps, and nearly without bends, at landings."""


def block():
    return rf.Block(width="2.4 m", height="9.6 m", mass="50 t")


def pads(beta=20, **changed):
    return rf.TwoSpringSupport(frequency_ratio=beta, damping_ratio=0.1, **changed)


def cap(width="3 m", height="0.5 m", mass="20 t"):
    return rf.CushionCap(width=width, height=height, mass=mass)


def soil(stiffness="9 MPa", **changed):
    return rf.WinklerSoil(**{"stiffness": stiffness, "damping_ratio": 0.2, **changed})


def run(*parts, peak=-3.0, duration="2.5 s", **options):
    return rf.System(*parts, **options).simulate(
        rf.GroundMotion.sine_pulse(f"{peak} m/s^2", "1 Hz"),
        duration=duration,
        accuracy="reference",
        output_step="10 ms",
    )


def largest_difference(one, other, name="rotation"):
    """Return the largest difference of two histories over the largest value."""
    scale = np.abs(other[name].values).max()
    return np.abs(one[name].values - other[name].values).max() / scale


# firm soil -----------------------------------------------------------------------------------


@pytest.mark.wide
@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("rule", RULES)
def test_coupled_stack_on_firm_soil_converges_to_block_on_pads(rule, rotation):
    """Error 1/k0 if landings have no impulse; the impulse of the cap's inertia would remain."""
    options = {"restraint": rule, "rotation": rotation}
    with pytest.warns(ModelWarning, match="eps_max"):
        exact = run(block(), pads(restitution=1), **options)
    assert exact.impact_count.item() > 0
    assert exact.peak_relative_rotation.item() > 0.2
    stiffness = np.array([1e9, 1e10, 1e11, 1e12])
    errors = []
    for k0 in stiffness:
        with pytest.warns(ModelWarning, match="eps_max"):
            response = run(block(), pads(restitution=1), cap(), soil(f"{k0} Pa"), **options)
        errors.append([largest_difference(response, exact, name) for name in SMOOTH])
        assert response.impact_count.item() == exact.impact_count.item()
    slopes = np.polyfit(np.log(stiffness[1:]), np.log(errors[1:]), 1)[0]
    np.testing.assert_allclose(slopes, -1.0, atol=0.05)
    assert max(errors[-1]) < 2e-5
    assert largest_difference(response, exact, "vertical_displacement") < 1e-3


def test_heavy_cap_on_firm_soil_converges_to_block_on_pads():
    """With eps_max the cap recoils at a landing on soil of any stiffness: error 1/m_c."""
    exact = run(block(), pads())
    assert exact.impact_count.item() > 0
    mass = np.array([1e6, 1e7, 1e8])
    errors = []
    for m_c in mass:
        heavy = cap(mass=f"{m_c} kg")
        errors.append(
            largest_difference(run(block(), pads(), heavy, soil(f"{1e7 * m_c} Pa")), exact)
        )
    slope = np.polyfit(np.log(mass), np.log(errors), 1)[0]
    assert slope == pytest.approx(-1.0, abs=0.05)
    assert errors[-1] < 1e-4


def test_cascade_on_firm_soil_converges_to_block_on_pads():
    exact = run(block(), pads())
    stiffness = np.array([1e9, 1e10, 1e11])
    errors = []
    for k0 in stiffness:
        response = run(block(), pads(), cap(), soil(f"{k0} Pa"), coupling="cascade")
        errors.append([largest_difference(response, exact, name) for name in SMOOTH])
    slopes = np.polyfit(np.log(stiffness), np.log(errors), 1)[0]
    np.testing.assert_allclose(slopes, -1.0, atol=0.05)
    assert max(errors[-1]) < 1e-3
    assert largest_difference(response, exact, "vertical_displacement") < 1e-3


# stiff pads ----------------------------------------------------------------------------------


@pytest.mark.parametrize("separation", ["displacement", "pressure"])
@pytest.mark.parametrize("rule", RULES)
def test_block_and_cap_on_stiff_pads_converge_to_one_body(rule, separation):
    """Error 1/beta^2, also while the cap lifts, as long as the block stays on its pads."""
    ground = soil("12 MPa", separation=separation)
    under = cap(width="2.4 m")
    exact = run(block(), under, ground, peak=-1.2, restraint=rule)
    assert int((exact.contact_state != 0).sum()) > 20
    beta = np.array([80.0, 160.0, 320.0, 640.0])
    errors = []
    for ratio in beta:
        response = run(block(), pads(ratio), under, ground, peak=-1.2, restraint=rule)
        assert (response.contact_state.values == 0).all()
        errors.append([
            largest_difference(response, exact, "rotation"),
            largest_difference(response, exact, "cap_rotation"),
            largest_difference(response, exact, "cap_vertical_displacement"),
            np.abs(response.rotation_on_cap.values).max() / exact.peak_rotation.item(),
        ])  # fmt: skip
    slopes = np.polyfit(np.log(beta), np.log(errors), 1)[0]
    np.testing.assert_allclose(slopes, -2.0, atol=0.05)
    assert max(errors[-1][0], errors[-1][1], errors[-1][3]) < 1e-3
    assert np.mean(response.soil_contact_state.values == exact.contact_state.values) > 0.99


def test_stack_frequencies_converge_to_those_of_its_parts():
    stiff = rf.System(block(), pads(2000), cap(), soil()).frequencies().angular_frequency[:2]
    body = rf.System(block(), cap(), soil()).frequencies().angular_frequency
    np.testing.assert_allclose(stiff, body, rtol=1e-4)
    firm = rf.System(block(), pads(), cap(), soil("1e14 Pa")).frequencies().angular_frequency[:2]
    alone = rf.System(block(), pads()).frequencies().angular_frequency
    np.testing.assert_allclose(firm, alone, rtol=1e-6)


# thin and light caps -------------------------------------------------------------------------


@pytest.mark.parametrize("rule", RULES)
def test_massless_plate_leaves_block_on_soil(rule):
    plate = cap(width="2.4 m", height="0 m", mass="0 kg")
    one, other = (
        run(block(), *parts, restraint=rule, peak=-3.0) for parts in ((soil(),), (plate, soil()))
    )
    for name in one.data_vars:
        if one[name].dtype.kind == "f":
            np.testing.assert_allclose(other[name], one[name], rtol=1e-9, atol=1e-12, err_msg=name)
    np.testing.assert_allclose(other.cap_rotation, one.rotation, rtol=1e-12)
    assert (other.peak_rotation > 2.0 * other.uplift_angle).item()


def test_massless_plate_can_be_given_by_density():
    thin = rf.CushionCap(height="0 m", density="2500 kg/m^3", depth="4 m")
    assert thin.si.mass_at(2.4) == 0.0
    response = run(block(), thin, soil())
    np.testing.assert_allclose(
        response.rotation, run(block(), soil()).rotation, rtol=1e-9, atol=1e-12
    )


@pytest.mark.parametrize("width", ["2.4 m", "3.2 m"])
@pytest.mark.parametrize("scene", ["body", "cascade"])
def test_response_is_smooth_down_to_zero_cap_mass(scene, width):
    parts = () if scene == "body" else (pads(),)
    options = {} if scene == "body" else {"coupling": scene}

    def light(mass):
        plate = cap(width=width, height="0 m", mass=mass)
        return run(block(), *parts, plate, soil(), peak=-1.2, **options)

    none = light("0 kg")
    for name, row in none.items():
        if row.dims == ("time",):
            assert np.isfinite(row.values).all(), name
    one, ten = largest_difference(light("1 kg"), none), largest_difference(light("10 kg"), none)
    assert 0.0 < one < 1e-4
    assert ten / one == pytest.approx(10.0, rel=0.01)


@pytest.mark.parametrize("mass", ["0 kg", "1 kg"])
def test_too_light_cap_in_coupled_equations_warns(mass):
    plate = cap(width="3.2 m", height="0 m", mass=mass)
    with pytest.warns(ModelWarning, match="coupled equations are solved with") as caught:
        light = run(block(), pads(), plate, soil())
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert "building" in str(caught[0].message)
    for name, row in light.items():
        if row.dims == ("time",):
            assert np.isfinite(row.values).all(), name
    assert light.energy_residual.item() < 1e-8
    # the meaning of the share
    share = cap(width="3.2 m", height="0 m", mass="50 kg")
    assert largest_difference(light, run(block(), pads(), share, soil())) < 1e-3
    heavier = cap(width="3.2 m", height="0 m", mass="500 kg")
    assert largest_difference(light, run(block(), pads(), heavier, soil())) < 0.05


def test_cap_above_least_mass_does_not_warn():
    rf.System(block(), pads(), cap(mass="50.1 kg"), soil())
    rf.System(block(), pads(), cap(mass="0 kg"), soil(), coupling="cascade")
    rf.System(block(), cap(mass="0 kg"), soil())


# both rules of separation --------------------------------------------------------------------


@pytest.mark.parametrize("rule", RULES)
def test_separation_rules_agree_without_damping(rule):
    one, other = (
        run(block(), soil(damping_ratio=0.0, separation=separation), restraint=rule)
        for separation in ("displacement", "pressure")
    )
    assert int((one.contact_state != 0).sum()) > 20
    for name in one.data_vars:
        # a duration is interpolated between ends of steps, which differ between the rules
        rtol = 1e-6 if name == "peak_friction_demand_duration" else 1e-9
        np.testing.assert_allclose(one[name], other[name], rtol=rtol, atol=1e-13, err_msg=name)


def test_separation_by_pressure_does_not_pull_with_damping():
    one, other = (
        run(block(), soil(damping_ratio=0.5, separation=separation), peak=-2.5)
        for separation in ("displacement", "pressure")
    )
    assert largest_difference(one, other) > 1e-3
    assert (other.contact_length.values <= 2.4 + 1e-12).all()
    least = 50e3 * 9.80665 * 1e-9
    assert other.soil_reaction.values.min() >= -least


# scaling -------------------------------------------------------------------------------------


@pytest.mark.parametrize("coupling", [None, "coupled", "cascade"])
@pytest.mark.parametrize("factor", [0.25, 4.0])
def test_response_scales_with_scene_size(factor, coupling):
    """All lengths times f, times by sqrt(f), stiffnesses as weights over lengths."""

    def scene(f):
        mass = 50e3 * f**3
        parts = [
            rf.Block(width=f"{2.4 * f!r} m", height=f"{9.6 * f!r} m", mass=f"{mass!r} kg"),
            rf.CushionCap(width=f"{3 * f!r} m", height=f"{0.5 * f!r} m", mass=f"{0.3 * mass!r} kg"),
            rf.WinklerSoil(
                stiffness=f"{9e6 * f!r} Pa", damping=f"{1.5e5 * f * f**0.5!r} Pa*s",
                separation="pressure",
            ),
        ]  # fmt: skip
        if coupling is not None:
            parts.append(pads())
        options = {} if coupling is None else {"coupling": coupling}
        pulse = rf.GroundMotion.sine_pulse("-3 m/s^2", f"{f**-0.5!r} Hz")
        return rf.System(*parts, **options).simulate(
            pulse,
            duration=f"{2.5 * f**0.5!r} s",
            accuracy="reference",
            output_step=f"{0.01 * f**0.5!r} s",
        )

    one, other = scene(1.0), scene(factor)
    assert one.sizes == other.sizes
    scales = {
        "rotation": 1.0,
        "cap_rotation": 1.0,
        "angular_velocity": factor**-0.5,
        "vertical_displacement": factor,
        "horizontal_displacement": factor,
        "contact_length": factor,
        "soil_reaction": factor**3,
    }
    for name, scale in scales.items():
        size = np.abs(one[name].values).max()
        np.testing.assert_allclose(
            other[name].values / scale / size, one[name].values / size, atol=1e-7, err_msg=name
        )
    np.testing.assert_allclose(other.event_time, factor**0.5 * one.event_time, rtol=1e-8)
