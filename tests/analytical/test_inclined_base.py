"""Inclined bases against programs in horizontal and vertical axes, and against closed forms."""

import math

import numpy as np
import pytest
from analytical.inclined import G, OnPads, Stone, rocking

import rockframe as rf
from rockframe.errors import AssemblyError, ModelWarning

pytestmark = pytest.mark.analytical

WIDTH, HEIGHT, MASS = 0.8, 2.4, 3e3
BLOCK = rf.Block(width="0.8 m", height="2.4 m", mass="3 t")
LOPSIDED = rf.Block(
    width="0.8 m", height="2.4 m", mass="3 t", eccentricity="0.05 m", inertia="1600 kg m^2"
)
THETA = math.atan(WIDTH / HEIGHT)
STEP = 0.02
END = 4.0


def reference_block(block):
    si = block.si
    return Stone(si.half_width, si.centre_height, si.mass, si.inertia, si.eccentricity)


def record(seed, horizontal, vertical):
    """Sample a smooth motion of 2 s; return it and its acceleration as a function of time."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, 2.0 + STEP / 2.0, STEP)
    taper = np.sin(np.pi * time / time[-1])
    both = [
        peak * taper * np.sin(2.0 * np.pi * (rate * time + phase))
        for peak, (rate, phase) in zip(
            (horizontal, vertical), rng.uniform(0.5, 2.0, (2, 2)), strict=True
        )
    ]
    motion = rf.GroundMotion.from_arrays((both[0], "m/s^2"), time_step=f"{STEP} s")
    up = rf.GroundMotion.from_arrays((both[1], "m/s^2"), time_step=f"{STEP} s")

    def ground(t):
        return np.array([np.interp(t, time, one, right=0.0) for one in both])

    return motion.with_vertical(up) if vertical else motion, ground


SCENES = {
    "uphill": (BLOCK, 4.0, record(1, 4.5, 0.0)),
    "downhill": (BLOCK, -4.0, record(2, -4.5, 0.0)),
    "both components": (BLOCK, 6.0, record(7, 3.5, 4.0)),
    "eccentric": (LOPSIDED, 5.0, record(4, -4.0, -3.0)),
    "eccentric, mirrored": (LOPSIDED, -5.0, record(4, 3.5, 5.0)),
}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.long] * (name in ("uphill", "eccentric")))
        for name in SCENES
    ],
)
def test_rigid_ground_against_true_axes(name):
    block, degrees, (motion, ground) = SCENES[name]
    system = rf.System(block, inclination=f"{degrees} deg")
    found = system.simulate(motion, duration=f"{END} s", accuracy=1e-12)
    assert found.impact_count.item() > 3
    assert not found.overturned.item()
    expected = rocking(
        reference_block(block), math.radians(degrees), ground, END, found.time.values
    )
    apart = np.abs(found.rotation.values - expected).max()
    assert apart < 1e-7 * THETA, apart / THETA


@pytest.mark.parametrize(
    "name",
    [pytest.param("both components", marks=pytest.mark.long), "eccentric, mirrored"],
)
def test_pads_against_true_axes(name):
    block, degrees, (motion, ground) = SCENES[name]
    stiffness, damping = 6e6, 3e4
    pads = rf.TwoSpringSupport(
        stiffness=f"{stiffness} N/m", damping=f"{damping} N s/m", restitution=1.0
    )
    with pytest.warns(ModelWarning, match="exceeds eps_max"):
        system = rf.System(block, pads, restraint="centre", inclination=f"{degrees} deg")
    found = system.simulate(motion, duration="1.2 s", accuracy=1e-12)
    reference = OnPads(reference_block(block), math.radians(degrees), stiffness, damping)
    rotation, along, off, switches = reference.response(ground, 1.2, found.time.values)
    assert switches > 4
    assert np.abs(found.rotation.values - rotation).max() < 1e-7 * THETA
    size = 1e-7 * THETA * HEIGHT
    for name, expected in (("horizontal_displacement", along), ("vertical_displacement", off)):
        moved = found[name].values - found[name].values[0]
        assert np.abs(moved - expected).max() < size, name


def test_block_falls_beyond_slope_of_its_downhill_corner():
    for block, side in ((BLOCK, 1.0), (BLOCK, -1.0), (LOPSIDED, 1.0), (LOPSIDED, -1.0)):
        si = block.si
        steepest = math.atan2(si.half_width + side * si.eccentricity, si.centre_height)
        angle = side * steepest
        system = rf.System(block, inclination=f"{angle * (1.0 - 1e-9)!r} rad")
        assert system.equilibrium().overturning_angle.item() < 1e-8
        falls = "left" if side > 0.0 else "right"
        with pytest.raises(AssemblyError, match=f"falls to the {falls} by its own weight"):
            rf.System(block, inclination=f"{angle * (1.0 + 1e-9)!r} rad")


def test_rocking_starts_at_the_acceleration_of_the_tilted_block():
    seconds, peak = 10.0, 8.0
    for degrees in (3.0, -7.0):
        i = math.radians(degrees)
        system = rf.System(BLOCK, inclination=f"{degrees} deg")
        for sign, angle in ((1.0, THETA - i), (-1.0, THETA + i)):
            ramp = rf.GroundMotion.from_arrays(([0.0, sign * peak], "m/s^2"), time_step="10 s")
            run = system.simulate(ramp, outputs=None)
            assert run.first_uplift_time.item() * peak / seconds == pytest.approx(
                G * math.tan(angle), rel=1e-9
            )
        least = system.setting.uplift_acceleration
        assert least == pytest.approx(G * math.tan(THETA - abs(i)), rel=1e-12)


@pytest.mark.parametrize("parts", [(), (rf.TwoSpringSupport(stiffness="1 GN/m", damping_ratio=1),)])
def test_overturning_angles_are_unstable_equilibria_of_slope(parts):
    i = math.radians(5.0)
    system = rf.System(BLOCK, *parts, inclination="5 deg")
    limits = {"left": -(THETA - i), "right": THETA + i}
    rest = system.equilibrium()
    for side, limit in limits.items():
        assert rest[f"{side}_overturning_angle"].item() == pytest.approx(abs(limit), rel=1e-12)
        for share in (0.999, 1.001):
            start = f"{share * limit!r} rad"
            if share > 1.0:
                with pytest.raises(AssemblyError, match="not below the overturning angle"):
                    system.simulate(duration="1 s", initial=rf.InitialState(rotation=start))
                continue
            run = system.simulate(duration="3 s", initial=rf.InitialState(rotation=start))
            assert not run.overturned.item()
            assert run[f"{side}_peak_rotation"].item() == pytest.approx(share * abs(limit))
            assert run.peak_relative_rotation.item() == pytest.approx(share)
            assert side in run.attrs["verdict"]
        held = system.moment_rotation(([limit], "rad")).restoring_moment.item()
        soft = 0.0 if not parts else 1e-4
        assert abs(held) <= (1e-12 + soft) * MASS * G * HEIGHT


def test_quarter_periods_of_small_free_rocking_about_each_corner():
    i, start = math.radians(4.0), 0.3 * THETA
    system = rf.System(BLOCK, inclination="4 deg", rotation="small")
    rate = math.sqrt(BLOCK.si.frequency_at(G) ** 2 * math.cos(i))
    for side, limit in ((1.0, THETA + math.tan(i)), (-1.0, THETA - math.tan(i))):
        run = system.simulate(
            duration="2 s",
            initial=rf.InitialState(rotation=f"{side * start!r} rad"),
            accuracy="reference",
        )
        quarter = math.acosh(1.0 / (1.0 - start / limit)) / rate
        assert run.event_time.values[0] == pytest.approx(quarter, rel=1e-10)


def test_rest_rotation_and_reactions_on_compliant_slopes():
    i, half = math.radians(3.0), 0.5 * WIDTH
    along, normal = MASS * G * math.sin(i), MASS * G * math.cos(i)
    pads = rf.TwoSpringSupport(stiffness="5 MN/m", damping_ratio=0.1)
    soil = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.1)
    for base, turning in ((pads, 2.0 * 5e6 * half**2), (soil, 20e6 * half**3 / 1.5)):
        system = rf.System(BLOCK, base, inclination="3 deg", rotation="small")
        rest = system.equilibrium()
        h = 0.5 * HEIGHT
        lean = -along * h / (turning - normal * h)
        assert rest.rest_rotation.item() == pytest.approx(lean, rel=1e-9)
        if base is pads:
            share = half * 5e6 * lean
            assert rest.static_left_reaction.item() == pytest.approx(0.5 * normal - share)
            assert rest.static_right_reaction.item() == pytest.approx(0.5 * normal + share)
        run = system.simulate(duration="1 s", outputs=("reaction", "friction_demand"))
        np.testing.assert_allclose(run.rotation, lean, rtol=1e-9)
        np.testing.assert_allclose(run.horizontal_reaction, along, rtol=1e-9)
        np.testing.assert_allclose(run.vertical_reaction, normal, rtol=1e-9)
        np.testing.assert_allclose(run.friction_demand, math.tan(i), rtol=1e-9)


@pytest.mark.filterwarnings("ignore:at rest the body leans")
@pytest.mark.parametrize("share", [0.3, 0.9, 0.99, 0.999])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_body_on_bed_rests_in_full_contact_up_to_uplift(share, side):
    """At rest K sin a cos a = m g h sin(i + a), until the held point moves."""
    b, h, stiffness = 0.5 * WIDTH, 0.5 * HEIGHT, 2e6
    rocking, weight = stiffness * b**3 / 1.5, MASS * G
    lean = inclination = 0.0
    for _ in range(60):
        uplift = math.asin(0.5 * weight * math.cos(inclination) / (b * b * stiffness))
        lean = share * uplift
        moment = rocking * math.sin(lean) * math.cos(lean)
        inclination = math.asin(moment / (weight * h)) - lean
    system = rf.System(
        BLOCK,
        rf.WinklerSoil(stiffness=f"{stiffness!r} Pa", damping_ratio=0.1),
        gravity=f"{G!r} m/s^2",
        inclination=f"{-side * inclination!r} rad",
    )
    assert inclination > 0.0
    assert system.equilibrium().rest_rotation.item() == pytest.approx(side * lean, rel=1e-9)
    run = system.simulate(duration="0.5 s")
    assert run.contact_state.values.tolist() == [0] * run.sizes["time"]
    assert np.ptp(run.rotation.values) < 1e-9


@pytest.mark.filterwarnings("ignore:at rest the body leans")
@pytest.mark.parametrize("inclination", [0.02, -0.03])
def test_restoring_moment_of_stack_vanishes_at_rest_on_slope(inclination):
    """Rest from zero accelerations, the holding moment from the balance of forces."""
    system = rf.System(
        rf.Block(width="2 m", height="5 m", mass="40 t"),
        rf.TwoSpringSupport(frequency_ratio=12, damping_ratio=0.1),
        rf.CushionCap(width="3.4 m", height="1.2 m", mass="20 t"),
        rf.WinklerSoil(stiffness="6 MPa", damping_ratio=0.2),
        inclination=f"{inclination} rad",
    )
    rest = system.equilibrium().rest_rotation.item()
    held = system.moment_rotation(([rest], "rad"))
    assert abs(rest) > 1e-3
    assert abs(held.restoring_moment.item()) < 1e-12 * 40e3 * 9.80665 * 2.5


def test_absolute_accelerations_exclude_gravity():
    motion, _ = record(3, 3.5, 4.0)
    system = rf.System(BLOCK, inclination="6 deg")
    run = system.simulate(motion, free_vibration="1 s", outputs=("acceleration", "reaction"))
    s, c = math.sin(math.radians(6.0)), math.cos(math.radians(6.0))
    for axis, part, gravity in (("horizontal", (c, s), s), ("vertical", (-s, c), c)):
        # Newton's law: the forces of the base and the weight
        force = run[f"{axis}_reaction"].values / MASS - G * gravity
        absolute = run[f"absolute_{axis}_acceleration"].values
        np.testing.assert_allclose(absolute, force, atol=1e-9)
        ground = part[0] * run.ground_acceleration + part[1] * run.vertical_ground_acceleration
        relative = run[f"{axis}_acceleration"].values
        np.testing.assert_allclose(absolute, relative + ground.values, atol=1e-12)
    np.testing.assert_array_equal(
        run.ground_acceleration.values[:101], motion.si.horizontal.samples
    )
