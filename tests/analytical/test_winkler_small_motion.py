"""Full contact with a bed is linear: Eq. (18), frequencies, and equivalent two-spring supports."""

import math
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from analytical.pads import oscillator, rough_record
from analytical.soil import Bed
from overdamping import overdamped
from scipy.linalg import expm

import rockframe as rf
from rockframe.errors import ModelWarning
from rockframe.system.statics import SmallMotion, vibration_modes

pytestmark = pytest.mark.analytical

STEP = 0.005
RULES = ("contact-state", "leading-corner", "centre")
SEPARATIONS = ("displacement", "pressure")
BEDS = [
    Bed(),
    Bed(damping_ratio=0.0),
    Bed(half_width=0.9, half_height=1.1, stiffness=400.0, damping_ratio=0.5, mu=2.6),
    Bed(half_width=3.0, half_height=12.0, stiffness=90.0, damping_ratio=0.05, gravity=1.62),
]


def relative_error(found, expected):
    return np.abs(found - expected).max() / np.abs(expected).max()


# frequencies --------------------------------------------------------------------------------


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("bed", BEDS)
def test_frequencies_and_damping_ratios(bed, rotation):
    modes = bed.system(rotation=rotation).frequencies()
    slow, fast = bed.omega_r, bed.omega_v
    ratios = [0.5 * bed.rocking_damping / slow, bed.damping_ratio]
    np.testing.assert_allclose(modes.angular_frequency, [slow, fast], rtol=1e-12)
    np.testing.assert_allclose(modes.frequency * modes.period, 1.0, rtol=1e-15)
    np.testing.assert_allclose(modes.damping_ratio, ratios, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(modes.rotation_shape, [1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(modes.vertical_displacement_shape, [0.0, 1.0], atol=1e-12)


@overdamped
def test_an_overdamped_mode_has_the_frequency_of_the_undamped_one():
    bed = Bed(damping_ratio=1.5)
    modes = bed.system().frequencies()
    np.testing.assert_allclose(modes.angular_frequency, [bed.omega_r, bed.omega_v], rtol=1e-9)
    assert modes.damping_ratio.values[1] == pytest.approx(1.5, rel=1e-9)


def test_soil_too_soft_to_hold_the_block_has_no_rocking_frequency():
    limit = 1.5 * 9.80665 * 4.8 / 1.2**3
    Bed(stiffness=limit * (1.0 + 1e-9)).system()
    with pytest.warns(ModelWarning, match="too soft"):
        system = Bed(stiffness=limit * 0.9).system()
    modes = system.frequencies()
    assert math.isnan(modes.angular_frequency.values[0])
    assert math.isnan(modes.period.values[0])
    assert modes.angular_frequency.values[1] == pytest.approx(Bed(stiffness=limit * 0.9).omega_v)
    response = system.simulate(
        duration="100 s", initial=rf.InitialState(rotation="1e-6 rad"), outputs=None
    )
    assert response.overturned.item()


def test_overdamped_modes_are_separated():
    """With damping proportional to stiffness each mode is an oscillator."""
    rng = np.random.default_rng(4)
    shapes = np.linalg.qr(rng.normal(size=(4, 4)))[0]
    frequencies = np.array([1.0, 2.0, 3.0, 5.0])
    ratios = np.array([5.0, 1.01, 0.3, 5.0])
    mass = np.diag([1.0, 2.0, 0.5, 3.0])
    root = np.sqrt(mass)
    stiffness = root @ shapes @ np.diag(frequencies**2) @ shapes.T @ root
    damping = root @ shapes @ np.diag(2.0 * ratios * frequencies) @ shapes.T @ root
    modes = vibration_modes(SmallMotion(("a", "b", "c", "d"), mass, damping, stiffness))
    np.testing.assert_allclose([mode.angular_frequency for mode in modes], frequencies, rtol=1e-9)
    np.testing.assert_allclose([mode.damping_ratio for mode in modes], ratios, rtol=1e-9)


@overdamped
def test_a_strongly_damped_bed_has_the_frequencies_of_its_springs():
    bed = {"stiffness": "20 MPa"}
    block = rf.Block(width="1 m", height="1 m", mass="1 t")
    free = rf.System(block, rf.WinklerSoil(**bed, damping_ratio=0.0)).frequencies()
    damped = rf.System(block, rf.WinklerSoil(**bed, damping_ratio=3.0)).frequencies()
    np.testing.assert_allclose(damped.angular_frequency, free.angular_frequency, rtol=1e-9)
    assert damped.damping_ratio.values.max() == pytest.approx(3.0, rel=1e-9)


def test_mode_without_stiffness_has_no_frequency():
    """Neither stable nor unstable: stiffness and gravity balance exactly."""
    one = np.eye(1)
    (mode,) = vibration_modes(SmallMotion(("rotation",), one, 0.5 * one, 0.0 * one))
    assert math.isnan(mode.angular_frequency)
    assert math.isnan(mode.damping_ratio)


def test_cap_mass_from_density_uses_its_own_width():
    block = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
    soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.15)
    dense, heavy = (
        rf.System(
            block, rf.CushionCap(width="3.2 m", height="0.7 m", **options), soil
        ).frequencies()
        for options in ({"density": "2500 kg/m^3", "depth": "4 m"}, {"mass": "22.4 t"})
    )
    assert dense.angular_frequency.values == pytest.approx(heavy.angular_frequency.values)


def test_frequencies_of_block_and_cap_as_one_body():
    block = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
    cap = rf.CushionCap(width="3.2 m", height="0.7 m", mass="16 t")
    soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.15)
    modes = rf.System(block, cap, soil).frequencies()
    total, width = 66e3, 1.6
    about_base = (
        50e3 * (2.4**2 + 9.6**2) / 12.0 + 50e3 * 5.5**2
        + 16e3 * (3.2**2 + 0.7**2) / 12.0 + 16e3 * 0.35**2
    )  # fmt: skip
    lifting = 9.80665 * (50e3 * 5.5 + 16e3 * 0.35)
    vertical = math.sqrt(2.0 * width * 9e6 / total)
    rocking = math.sqrt((9e6 * width**3 / 1.5 - lifting) / about_base)
    np.testing.assert_allclose(modes.angular_frequency, [rocking, vertical], rtol=1e-12)
    damping = 0.15 * total * vertical / width
    expected = [0.5 * damping * width**3 / 1.5 / about_base / rocking, 0.15]
    np.testing.assert_allclose(modes.damping_ratio, expected, rtol=1e-9)


# histories in full contact --------------------------------------------------------------------


@pytest.mark.parametrize("separation", SEPARATIONS)
@pytest.mark.parametrize("bed", BEDS)
def test_tiny_free_rocking_is_one_damped_oscillator(bed, separation):
    # the accompanying vertical motion is of second order
    start = (2e-8, -3e-8)
    response = (
        replace(bed, separation=separation)
        .system(rotation="small")
        .simulate(
            duration="3 s",
            initial=rf.InitialState(
                rotation=f"{start[0]} rad", angular_velocity=f"{start[1]} rad/s"
            ),
            output_step=f"{STEP} s",
            accuracy="reference",
        )
    )
    angle, turn = oscillator(bed.omega_r, bed.rocking_damping, np.zeros(601), STEP, start)
    assert (response.contact_state.values == 0).all()
    assert relative_error(response.rotation.values, angle) < 1e-9
    assert relative_error(response.angular_velocity.values, turn) < 1e-9
    assert np.abs(response.vertical_displacement.values).max() < 1e-13


@pytest.mark.parametrize("separation", SEPARATIONS)
@pytest.mark.parametrize("bed", BEDS)
def test_free_vertical_vibration_is_one_damped_oscillator(bed, separation):
    start = (0.3 * bed.delta, -0.2 * bed.delta * bed.omega_v)
    response = (
        replace(bed, separation=separation)
        .system()
        .simulate(
            duration="3 s",
            initial=rf.InitialState(
                vertical_displacement=f"{start[0]!r} m", vertical_velocity=f"{start[1]!r} m/s"
            ),
            output_step=f"{STEP} s",
            accuracy="reference",
        )
    )
    decay = 2.0 * bed.damping_ratio * bed.omega_v
    rise, speed = oscillator(bed.omega_v, decay, np.zeros(601), STEP, start)
    assert (response.contact_state.values == 0).all()
    assert relative_error(response.vertical_displacement.values, rise) < 1e-9
    assert relative_error(response.vertical_velocity.values, speed) < 1e-9


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("bed", BEDS)
def test_vertical_motion_alone_is_one_damped_oscillator(bed, rotation):
    """In all of full contact, not only near rest."""
    peak = 0.1 * bed.gravity if bed.damping_ratio == 0.0 else 0.4 * bed.gravity
    upwards = rough_record(401, STEP, peak, seed=11)
    motion = rf.GroundMotion.from_arrays(
        (np.zeros(401), "m/s^2"), f"{STEP} s", vertical=(upwards, "m/s^2")
    )
    response = bed.system(rotation=rotation).simulate(motion, accuracy="reference")
    decay = 2.0 * bed.damping_ratio * bed.omega_v
    rise, speed = oscillator(bed.omega_v, decay, -upwards, STEP)
    assert np.abs(rise).max() > 0.02 * bed.delta
    assert (response.contact_state.values == 0).all()
    assert relative_error(response.vertical_displacement.values, rise) < 1e-9
    assert relative_error(response.vertical_velocity.values, speed) < 1e-9
    assert (response.rotation.values == 0.0).all()
    pressed = bed.omega_v**2 * (bed.delta - rise) - decay * speed
    assert relative_error(response.soil_reaction.values, bed.mass * pressed) < 1e-9
    assert (response.contact_length.values == 2.0 * bed.half_width).all()


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("bed", BEDS)
def test_weak_horizontal_motion_is_one_damped_oscillator(bed, rotation, rule):
    # the neglected terms are of second order in the rotation, and of first order where the
    # leading corner is held (x' = h + b |a|): both are negligible in so weak a motion
    across = rough_record(401, STEP, 1e-5 if rule == "leading-corner" else 1e-4, seed=12)
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), f"{STEP} s")
    response = bed.system(rotation=rotation, restraint=rule).simulate(motion, accuracy="reference")
    force = -bed.half_height * across / bed.base_inertia
    angle, turn = oscillator(bed.omega_r, bed.rocking_damping, force, STEP)
    assert 1e-10 < np.abs(angle).max() < 1e-5
    assert relative_error(response.rotation.values, angle) < 3e-8
    assert relative_error(response.angular_velocity.values, turn) < 3e-8
    assert relative_error(response.horizontal_displacement.values, bed.half_height * angle) < 1e-6
    assert (response.contact_state.values == 0).all()


# two springs --------------------------------------------------------------------------------


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("rule", ["contact-state", "centre"])
@pytest.mark.parametrize("damping_ratio", [0.0, 0.2])
def test_springs_at_gauss_points_match_bed(damping_ratio, rule, rotation):
    """k = b k0 and c = b c0 at b/sqrt(3): the same resultants in full contact."""
    bed = Bed(damping_ratio=damping_ratio)
    apart = bed.half_width / math.sqrt(3.0)
    narrow = rf.Block(
        width=f"{2.0 * apart!r} m",
        height=f"{2.0 * bed.half_height!r} m",
        mass=f"{bed.mass!r} kg",
        inertia=f"{bed.mass * bed.inertia!r} kg*m^2",
    )
    pads = rf.TwoSpringSupport(
        stiffness=f"{bed.mass * bed.stiffness * bed.half_width!r} N/m",
        damping=f"{bed.mass * bed.damping * bed.half_width!r} N*s/m",
    )
    options = {"restraint": rule, "rotation": rotation}
    on_pads = rf.System(narrow, pads, gravity=f"{bed.gravity!r} m/s^2", **options)
    on_soil = bed.system(**options)
    np.testing.assert_allclose(
        on_pads.frequencies().angular_frequency, on_soil.frequencies().angular_frequency, rtol=1e-12
    )
    motion = rf.GroundMotion.from_arrays(
        (rough_record(401, STEP, 2.5, seed=13), "m/s^2"),
        f"{STEP} s",
        vertical=(rough_record(401, STEP, 1.0 if damping_ratio else 0.5, seed=14), "m/s^2"),
    )
    one, other = (system.simulate(motion, accuracy="reference") for system in (on_pads, on_soil))
    for response in (one, other):
        assert (response.contact_state.values == 0).all()
    assert np.abs(other.rotation.values).max() > 1e-3
    for name in ("rotation", "angular_velocity", "vertical_displacement", "vertical_velocity",
                 "horizontal_displacement"):  # fmt: skip
        assert relative_error(one[name].values, other[name].values) < 1e-9, name
    both = one.left_reaction.values + one.right_reaction.values
    assert relative_error(both, other.soil_reaction.values) < 1e-9


# block, pads, cap and soil --------------------------------------------------------------------

STACK = {
    "b": 1.2, "h": 4.8, "m": 5e4, "i": 5e4 * (1.2**2 + 4.8**2) / 3.0, "k": 2e7, "c": 3e5,
    "bc": 1.6, "hc": 0.4, "mc": 1.5e4, "ic": 1.5e4 * (1.6**2 + 0.4**2) / 3.0, "k0": 9e6,
    "c0": 2e5, "g": 9.80665,
}  # fmt: skip


def stack(**options):
    n = STACK
    return rf.System(
        rf.Block(width=f"{2 * n['b']} m", height=f"{2 * n['h']} m", mass=f"{n['m']} kg"),
        rf.TwoSpringSupport(stiffness=f"{n['k']} N/m", damping=f"{n['c']} N*s/m"),
        rf.CushionCap(
            width=f"{2 * n['bc']} m", height=f"{2 * n['hc']} m", mass=f"{n['mc']} kg"
        ),
        rf.WinklerSoil(stiffness=f"{n['k0']} Pa", damping=f"{n['c0']} Pa*s"),
        **options,
    )  # fmt: skip


def linearised():
    """Return mass, damping and stiffness of (Y, phi, r, psi) at rest, from a Lagrangian."""
    names = "b h m i k c bc hc mc ic k0 c0 g"
    b, h, m, i, k, c, bc, hc, mc, ic, k0, c0, g = sp.symbols(names, positive=True)
    q = sp.Matrix(sp.symbols("Y phi r psi"))
    v = sp.Matrix(sp.symbols("vY vphi vr vpsi"))
    rise, phi, r, psi = q
    s = sp.symbols("s")
    normal = sp.Matrix([sp.sin(phi), sp.cos(phi)])
    tangent = sp.Matrix([sp.cos(phi), -sp.sin(phi)])
    cap = sp.Matrix([hc * sp.sin(phi), hc + rise])
    block = cap + (hc + h + r) * normal + h * sp.sin(psi) * tangent
    speeds = [place.jacobian(q) * v for place in (cap, block)]
    kinetic = (
        mc * speeds[0].dot(speeds[0]) + m * speeds[1].dot(speeds[1])
        + ic * v[1] ** 2 + i * (v[1] + v[3]) ** 2
    ) / 2  # fmt: skip
    corners = [r + h * (1 - sp.cos(psi)) + side * b * sp.sin(psi) for side in (1, -1)]
    sunk, soft = m * g / (2 * k), (m + mc) * g / (2 * bc * k0)
    ground = rise + hc * (1 - sp.cos(phi)) - s * sp.sin(phi)
    potential = mc * g * cap[1] + m * g * block[1]
    potential += sum(k * (sunk - w) ** 2 / 2 for w in corners)
    potential += sp.integrate(sp.expand(k0 * (soft - ground) ** 2 / 2), (s, -bc, bc))
    rates = [sp.Matrix([w]).jacobian(q).dot(v) for w in corners]
    sinking = sp.Matrix([ground]).jacobian(q).dot(v)
    dissipated = sum(c * rate**2 / 2 for rate in rates)
    dissipated += sp.integrate(sp.expand(c0 * sinking**2 / 2), (s, -bc, bc))
    at_rest = {**dict.fromkeys(q, 0), **dict.fromkeys(v, 0)}
    numbers = {symbol: STACK[name] for name, symbol in zip(
        names.split(), (b, h, m, i, k, c, bc, hc, mc, ic, k0, c0, g), strict=True)}  # fmt: skip
    gradient = [sp.diff(potential, one).subs(at_rest).subs(numbers) for one in q]
    assert max(abs(float(one)) for one in gradient) < 1e-6
    return tuple(
        np.array(sp.hessian(f, list(x)).subs(at_rest).subs(numbers).tolist(), dtype=float)
        for f, x in ((kinetic, v), (dissipated, v), (potential, q))
    )


@pytest.fixture(scope="module")
def linear():
    return linearised()


def companion(linear):
    mass, damping, stiffness = linear
    return np.block([
        [np.zeros((4, 4)), np.eye(4)],
        [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)],
    ])  # fmt: skip


@pytest.mark.parametrize("coupling", ["coupled", "cascade"])
@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_modes_of_block_and_cap_are_those_of_their_lagrangian(linear, rotation, coupling):
    rates = np.linalg.eigvals(companion(linear))
    rates = rates[rates.imag > 0.0]
    rates = rates[np.argsort(np.abs(rates))]
    assert rates.size == 4
    modes = stack(rotation=rotation, coupling=coupling).frequencies()
    np.testing.assert_allclose(modes.angular_frequency, np.abs(rates), rtol=1e-9)
    np.testing.assert_allclose(modes.damping_ratio, -rates.real / np.abs(rates), rtol=1e-9)
    assert list(modes.mode) == [1, 2, 3, 4]


def test_shapes_of_the_modes_without_damping(linear):
    """Heights and rotations of block and cap, with the largest of each mode scaled to 1."""
    mass, _, stiffness = linear
    rates, shapes = np.linalg.eigh(np.linalg.solve(np.linalg.cholesky(mass), np.linalg.solve(
        np.linalg.cholesky(mass), stiffness).T))  # fmt: skip
    shapes = np.linalg.solve(np.linalg.cholesky(mass).T, shapes)
    undamped = rf.System(
        rf.Block(width="2.4 m", height="9.6 m", mass="50 t"),
        rf.TwoSpringSupport(stiffness="20 MN/m", damping_ratio=0),
        rf.CushionCap(width="3.2 m", height="0.8 m", mass="15 t"),
        rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0),
    ).frequencies()
    np.testing.assert_allclose(undamped.angular_frequency, np.sqrt(rates), rtol=1e-9)
    np.testing.assert_allclose(undamped.damping_ratio, 0.0, atol=1e-9)
    own = np.array([shapes[0], shapes[1], shapes[0] + shapes[2], shapes[1] + shapes[3]])
    own /= own[np.argmax(np.abs(own), axis=0), np.arange(4)]
    names = ("cap_vertical_displacement", "cap_rotation", "vertical_displacement", "rotation")
    for row, name in zip(own, names, strict=True):
        np.testing.assert_allclose(undamped[f"{name}_shape"], row, atol=1e-8, err_msg=name)


@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_a_tiny_free_vibration_of_block_and_cap_is_linear(linear, rotation):
    start = 1e-7
    response = stack(rotation=rotation, restraint="centre").simulate(
        duration="2 s",
        initial=rf.InitialState(
            rotation=f"{start} rad", vertical_displacement="1e-7 m", vertical_velocity="2e-6 m/s"
        ),
        output_step=f"{STEP} s",
        accuracy="reference",
    )
    ahead = expm(companion(linear) * STEP)
    states = np.empty((401, 8))
    states[0] = [0.0, 0.0, 1e-7, start, 0.0, 0.0, 2e-6, 0.0]
    for i in range(400):
        states[i + 1] = ahead @ states[i]
    rise, tilt, lift, turn = states[:, :4].T
    for name, expected in {
        "rotation": tilt + turn,
        "cap_rotation": tilt,
        "rotation_on_cap": turn,
        "cap_vertical_displacement": rise,
        "vertical_displacement_on_cap": lift,
        "vertical_displacement": rise + lift,
        "angular_velocity": states[:, 5] + states[:, 7],
    }.items():
        assert relative_error(response[name].values, expected) < 1e-6, name
    assert (response.contact_state.values == 0).all()
    assert (response.soil_contact_state.values == 0).all()


def test_weak_motion_of_block_and_cap_is_linear(linear):
    """The ground enters through the heights of both masses above the soil."""
    mass, _, _ = linear
    across, upwards = (rough_record(401, STEP, 1e-4, seed=seed) for seed in (15, 16))
    motion = rf.GroundMotion.from_arrays(
        (across, "m/s^2"), f"{STEP} s", vertical=(upwards, "m/s^2")
    )
    response = stack(restraint="centre").simulate(motion, accuracy="reference")
    n = STACK
    levers = [0.0, n["mc"] * n["hc"] + n["m"] * (2 * n["hc"] + n["h"]), 0.0, n["m"] * n["h"]]
    weights = [n["m"] + n["mc"], 0.0, n["m"], 0.0]
    forces = -np.linalg.solve(mass, np.outer(levers, across) + np.outer(weights, upwards))
    whole = np.zeros((16, 16))
    whole[:8, :8] = companion(linear)
    whole[4:8, 8:12] = np.eye(4)
    whole[8:12, 12:16] = np.eye(4)
    ahead = expm(whole * STEP)[:8]
    states = np.zeros((401, 8))
    for i in range(400):
        slope = (forces[:, i + 1] - forces[:, i]) / STEP
        states[i + 1] = ahead @ np.concatenate([states[i], forces[:, i], slope])
    assert relative_error(response.cap_rotation.values, states[:, 1]) < 1e-6
    assert relative_error(response.rotation_on_cap.values, states[:, 3]) < 1e-6
    assert relative_error(response.cap_vertical_displacement.values, states[:, 0]) < 1e-6
    assert relative_error(response.vertical_displacement_on_cap.values, states[:, 2]) < 1e-6
