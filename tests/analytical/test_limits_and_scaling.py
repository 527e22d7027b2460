"""Stiff pads approach rigid ground; responses of blocks of different size are similar."""

import itertools
import math

import numpy as np
import pytest
from analytical.pads import Pads
from overdamping import overdamped

import rockframe as rf

pytestmark = pytest.mark.analytical

RULES = ("contact-state", "leading-corner", "centre")


def deviation(slenderness, radius, beta, rule, pulse):
    """Return the largest difference of alpha/theta between stiff pads and rigid ground.

    The dashpots are strong: a pad of xi = 10 stops a landing corner without
    rebound. Weakly damped pads let the block bounce, however stiff they are,
    and have another limit.
    """
    pads = Pads(radius=radius, slenderness=slenderness, beta=beta, damping_ratio=10.0, gravity=9.81)
    block = rf.Block.from_size(
        radius=f"{radius} m", slenderness=slenderness, mass=f"{pads.mass} kg"
    )
    options = {"free_vibration": "4 s", "output_step": "10 ms"}
    soft = pads.system(restraint=rule).simulate(pulse, **options)
    hard = rf.System(block, gravity="9.81 m/s^2").simulate(pulse, **options)
    count = min(soft.sizes["time"], hard.sizes["time"]) - 1
    found = soft.relative_rotation.values[:count] - hard.relative_rotation.values[:count]
    peaks = soft.peak_relative_rotation.item() - hard.peak_relative_rotation.item()
    return np.abs(found).max(), abs(peaks), soft, hard


@overdamped
@pytest.mark.parametrize("rule", ["contact-state", "leading-corner"])
@pytest.mark.parametrize(
    ("slenderness", "radius", "amplitude"),
    [
        (2, 5, "-9.81 m/s^2"),
        pytest.param(4, 10, "-9.81 m/s^2", marks=pytest.mark.long),
        pytest.param(6, 10, "-9.81 m/s^2", marks=pytest.mark.long),
        (4, 5, "-3 m/s^2"),
    ],
)
def test_stiff_pads_tend_to_rigid_ground(slenderness, radius, amplitude, rule):
    pulse = rf.GroundMotion.sine_pulse(amplitude)
    stiffness = (100.0, 300.0, 1000.0, 3000.0)
    found = [deviation(slenderness, radius, beta, rule, pulse) for beta in stiffness]
    assert all(not row[2].overturned.item() for row in found)
    histories = [row[0] for row in found]
    for coarse, fine in itertools.pairwise(histories):
        assert fine < 0.6 * coarse
    # the time in which a pad stops a corner decreases with beta
    for beta, (history, peak, *_) in list(zip(stiffness, found, strict=True))[2:]:
        assert history < 5.0 / beta
        assert peak < 5.0 / beta


@overdamped
@pytest.mark.parametrize("rule", ["contact-state", "leading-corner"])
@pytest.mark.parametrize(
    ("slenderness", "radius", "impacts", "time"),
    [(2, 1, 1, 1.30946), (4, 1, 0, 0.40662), (4, 5, 1, 2.69659), (6, 1, 0, 0.32916),
     (6, 5, 1, 3.12423)],
)  # fmt: skip
def test_stiff_pads_overturn_as_rigid_ground(slenderness, radius, impacts, time, rule):
    pads = Pads(
        radius=float(radius), slenderness=slenderness, beta=3000.0, damping_ratio=10.0,
        gravity=9.81,
    )  # fmt: skip
    response = pads.system(restraint=rule).simulate(
        rf.GroundMotion.sine_pulse(), free_vibration="9 s", outputs=None
    )
    assert response.overturned.item()
    assert response.overturning_time.item() == pytest.approx(time, abs=2e-3)
    assert response.impact_count.item() >= impacts


@overdamped
@pytest.mark.parametrize("rule", RULES)
def test_energy_of_block_rolling_on_stiff_pads(rule):
    """Before any impact: a released block falls by the energy of its rule."""
    pads = Pads(beta=2000.0, damping_ratio=10.0)
    start = 0.15
    response = pads.system(restraint=rule).simulate(
        duration="0.8 s",
        initial=rf.InitialState(rotation=f"{start} rad"),
        accuracy="reference",
        output_step="10 ms",
    )
    alpha = response.rotation.values
    assert alpha[-1] < start - 0.02
    assert (alpha > 0.0).all()
    e = 0.0 if rule == "centre" else pads.b

    def height(a):
        return pads.b * np.sin(a) + pads.h * np.cos(a)

    sideways = pads.h * np.cos(alpha) + e * np.sin(alpha)
    upwards = pads.b * np.cos(alpha) - pads.h * np.sin(alpha)
    inertia = pads.inertia + sideways**2 + upwards**2
    rate = -np.sqrt(2.0 * pads.gravity * (height(start) - height(alpha)) / inertia)
    np.testing.assert_allclose(response.angular_velocity.values, rate, atol=2e-5)


# size ----------------------------------------------------------------------------------------


def scaled_run(system, size, noisy=False):
    """Shake with accelerations of one shape, slowed in proportion to the size of the block."""
    slower = math.sqrt(size)
    if noisy:
        rng = np.random.default_rng(8)
        samples = 5.0 * np.convolve(rng.normal(size=300), np.ones(5) / 3.0)
        motion = rf.GroundMotion.from_arrays(
            (samples, "m/s^2"), f"{0.01 * slower!r} s", vertical=(0.5 * samples[::-1], "m/s^2")
        )
        free = 1.0
    else:
        motion = rf.GroundMotion.sine_pulse("-5 m/s^2", f"{1.0 / slower!r} Hz")
        free = 2.0
    return system.simulate(
        motion,
        free_vibration=f"{free * slower!r} s",
        output_step=f"{0.01 * slower!r} s",
        accuracy="reference",
    )


@pytest.mark.parametrize("noisy", [False, True])
@pytest.mark.parametrize("size", [0.25, 3.0, 16.0])
@pytest.mark.parametrize("rule", ["rigid", *RULES])
def test_response_scales_with_block_size(rule, size, noisy):
    responses = []
    for factor in (1.0, size):
        pads = Pads(radius=5.0 * factor)
        if rule == "rigid":
            block = rf.Block.from_size(radius=f"{5.0 * factor} m", slenderness=4, mass="1 t")
            system = rf.System(block)
        else:
            system = pads.system(restraint=rule)
        responses.append(scaled_run(system, factor, noisy))
    one, other = responses
    slower = math.sqrt(size)
    assert one.sizes == other.sizes
    assert one.peak_rotation.item() > 0.02
    for name, scale in (
        ("rotation", 1.0),
        ("angular_velocity", 1.0 / slower),
        ("horizontal_displacement", size),
        ("vertical_displacement", size),
    ):
        np.testing.assert_allclose(
            other[name].values,
            scale * one[name].values,
            atol=1e-6 * scale * np.abs(one[name].values).max(),
            err_msg=name,
        )
    np.testing.assert_array_equal(other.event_kind.values, one.event_kind.values)
    np.testing.assert_allclose(other.event_time.values, slower * one.event_time.values, rtol=1e-6)
    assert other.impact_count.item() == one.impact_count.item()
    assert other.flight_time.item() == pytest.approx(slower * one.flight_time.item(), abs=1e-6)


@pytest.mark.parametrize("gravity", ["1.62 m/s^2", "39.2266 m/s^2"])
@pytest.mark.parametrize("rule", ["rigid", "contact-state"])
def test_gravity_changes_only_time_scale(rule, gravity):
    """With accelerations relative to gravity, only the time scale changes."""
    responses = []
    for value in ("9.80665 m/s^2", gravity):
        g = float(value.split()[0])
        slower = math.sqrt(9.80665 / g)
        if rule == "rigid":
            block = rf.Block.from_size(radius="5 m", slenderness=4, mass="1 t")
            system = rf.System(block, gravity=value)
        else:
            system = Pads(gravity=g).system(restraint=rule)
        responses.append(
            system.simulate(
                rf.GroundMotion.sine_pulse(f"{-0.5 * g!r} m/s^2", f"{1.0 / slower!r} Hz"),
                free_vibration=f"{2.0 * slower!r} s",
                output_step=f"{0.01 * slower!r} s",
                accuracy="reference",
            )
        )
    one, other = responses
    np.testing.assert_allclose(other.rotation.values, one.rotation.values, atol=1e-7)
    np.testing.assert_array_equal(other.event_kind.values, one.event_kind.values)
