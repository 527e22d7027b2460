"""Results do not depend on units, mass, output step, order or omitted outputs."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from property.checks import check_output_step
from property.scenarios import CASE, GRAVITY, RULES, Scenario, scenarios

import rockframe as rf

pytestmark = [pytest.mark.wide, pytest.mark.property]


# output ------------------------------------------------------------------------------------


@given(scenarios(), st.sampled_from(["0.3 ms", "3 ms", "10 ms", "0.7 s", "100 s"]))
@settings(max_examples=60, deadline=None)
def test_the_output_step_changes_nothing_but_the_samples(scenario, step):
    check_output_step(scenario, step)


@given(scenarios())
@settings(max_examples=30, deadline=None)
def test_common_samples_agree_for_any_output_step(scenario):
    coarse = scenario.run(output_step="20 ms", overturning="continue")
    fine = scenario.run(output_step="5 ms", overturning="continue")
    count = (fine.sizes["time"] - 1) // 4
    for name in ("rotation", "vertical_displacement", "horizontal_displacement"):
        a, b = coarse[name].values[:count], fine[name].values[::4][:count]
        np.testing.assert_allclose(a, b, rtol=1e-12, atol=1e-14)


@given(scenarios())
@settings(max_examples=30, deadline=None)
def test_running_again_gives_the_same_bits(scenario):
    one, other = scenario.run(), scenario.run()
    assert one.drop_attrs().identical(other.drop_attrs())


@given(scenarios())
@settings(max_examples=30, deadline=None)
def test_the_peak_is_not_below_any_sample(scenario):
    response = scenario.run(output_step="1 ms")
    largest = np.abs(response.rotation.values).max()
    peak = response.peak_rotation.item()
    assert peak >= largest * (1.0 - 1e-9)
    # and not far above the highest sample, as rotation is a parabola between samples
    speed = np.abs(response.angular_velocity.values).max()
    assert peak <= largest + 1e-3 * speed + 1e-15


# mass ---------------------------------------------------------------------------------------


@given(scenarios(), st.integers(-6, 6))
@settings(max_examples=60, deadline=None)
def test_rotations_do_not_depend_on_the_mass(scenario, power):
    heavier = Scenario(**{**vars(scenario), "mass": scenario.mass * 2.0**power})
    one, other = scenario.run(outputs="energy"), heavier.run(outputs="energy")
    assert one.sizes == other.sizes
    for name in one.variables:
        scaled = name.endswith(("_energy", "_reaction", "_shear"))
        expected = one[name].values * 2.0**power if scaled else one[name].values
        np.testing.assert_array_equal(other[name].values, expected, err_msg=name)


@pytest.mark.parametrize("base", ["rigid", *RULES])
@pytest.mark.parametrize("mass", [1e-3, 777.0, 1e9])
def test_rotations_agree_for_extreme_masses(base, mass):
    one = Scenario(**{**vars(CASE), "base": base}).run()
    other = Scenario(**{**vars(CASE), "base": base, "mass": mass}).run()
    np.testing.assert_allclose(other.rotation.values, one.rotation.values, atol=1e-9)
    assert other.peak_rotation.item() == pytest.approx(one.peak_rotation.item(), rel=1e-9)
    assert one.peak_relative_rotation.item() > 0.1


# units ----------------------------------------------------------------------------------------


@given(
    st.floats(0.5, 20.0),
    st.floats(1.0, 8.0),
    st.floats(1.0, 1e6),
    st.floats(0.01, 3.0),
    st.floats(0.5, 4.0),
)
@settings(max_examples=100, deadline=None)
def test_sizes_are_equal_in_other_units(width, slenderness, mass, angle, hertz):
    height = width * slenderness
    metric = rf.Block(width=f"{width!r} m", height=f"{height!r} m", mass=f"{mass!r} kg")
    tiny = {"rel": 5e-16, "abs": 0.0}
    for other in (
        rf.Block(
            width=f"{width * 1e3!r} mm", height=f"{height * 100.0!r} cm", mass=f"{mass / 1e3!r} t"
        ),
        rf.Block(
            width=f"{width / 0.3048!r} ft",
            height=f"{height / 0.0254!r} inch",
            mass=f"{mass / 0.45359237!r} lb",
        ),
        rf.Block(width=metric.width.to("km"), height=metric.height.to("yd"),
                 mass=metric.mass.to("g")),
    ):  # fmt: skip
        for name in ("width", "height", "mass"):
            assert getattr(other.si, name) == pytest.approx(getattr(metric.si, name), **{
                **tiny, "rel": 1e-15})  # fmt: skip
    half = 0.5 * angle
    one = rf.InitialState(rotation=f"{half!r} rad") if half < 1.5 else rf.InitialState()
    if half < 1.5:
        degrees = rf.InitialState(rotation=f"{math.degrees(half)!r} deg")
        assert degrees.si.rotation == pytest.approx(one.si.rotation, rel=1e-15)
    per_minute = rf.GroundMotion.sine_pulse("-0.3 g_0", f"{hertz * 60.0!r} / min")
    per_second = rf.GroundMotion.sine_pulse(f"{-0.3 * GRAVITY!r} m/s^2", f"{hertz!r} Hz")
    assert per_minute.si.time_step == pytest.approx(per_second.si.time_step, rel=1e-14)
    np.testing.assert_allclose(
        per_minute.si.horizontal.samples, per_second.si.horizontal.samples, rtol=1e-13, atol=1e-14
    )


@pytest.mark.parametrize("rule", ["rigid", *RULES])
def test_response_is_equal_in_other_units(rule):
    def base(**pads):
        return () if rule == "rigid" else (rf.TwoSpringSupport(**pads),)

    options = {} if rule == "rigid" else {"restraint": rule}
    metric = rf.System(
        rf.Block(width="2.4 m", height="9.6 m", mass="50 t"),
        *base(stiffness="15 MN/m", damping="120 kN*s/m"),
        gravity="9.80665 m/s^2",
        **options,
    )
    imperial = rf.System(
        rf.Block(
            width=f"{2.4 / 0.3048!r} ft",
            height=f"{9.6 / 0.0254!r} inch",
            mass=f"{5e4 / 0.45359237!r} lb",
        ),
        *base(
            stiffness=f"{15e6 / 4448.2216152605 * 0.3048!r} kip/ft",
            damping=f"{120e3 / 4448.2216152605 * 0.0254!r} kip*s/inch",
        ),
        gravity="1 g_0",
        **options,
    )
    one = metric.simulate(
        rf.GroundMotion.sine_pulse(f"{-0.5 * GRAVITY!r} m/s^2", "0.5 Hz"),
        free_vibration="2 s",
        initial=rf.InitialState(rotation="0.01 rad", angular_velocity="-0.02 rad/s"),
        output_step="10 ms",
    )
    other = imperial.simulate(
        rf.GroundMotion.sine_pulse("-0.5 g_0", "30 / min"),
        free_vibration=f"{2.0 / 60.0!r} min",
        initial=rf.InitialState(
            rotation=f"{math.degrees(0.01)!r} deg",
            angular_velocity=f"{-0.02 * 30.0 / math.pi!r} rpm",
        ),
        output_step="0.01 s",
    )
    assert one.peak_relative_rotation.item() > 0.1
    assert one.sizes == other.sizes
    for name in one.data_vars:
        if one[name].dtype.kind == "f":
            scale = max(np.nanmax(np.abs(one[name].values), initial=0.0), 1e-300)
            np.testing.assert_allclose(
                other[name].values / scale, one[name].values / scale, atol=1e-6, err_msg=name
            )
        else:
            np.testing.assert_array_equal(other[name].values, one[name].values, err_msg=name)
