"""Floor motions against springs and masses, matrix exponentials and closed forms."""

import math

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigvals, expm

import rockframe as rf

pytestmark = [
    pytest.mark.analytical,
    pytest.mark.filterwarnings("ignore:.*departs from straight lines:rockframe.RecordWarning"),
]

DT = 0.01
NOISE = np.convolve(np.random.default_rng(12).normal(size=150), np.ones(3) / 2.0)


def motion(samples=NOISE, step=DT):
    return rf.GroundMotion.from_arrays((samples, "m/s^2"), f"{step!r} s")


def assert_close(found, expected, share):
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=share * np.abs(expected).max())


def ground_at_samples(floor, samples=NOISE):
    """Return the ground motion at the floor's samples, at rest after its end."""
    return np.append(samples, np.zeros(len(floor) - samples.size))


def integrate(slope, size, ground, dt=DT):
    """Integrate from rest under linear interpolation, restarted at every sample."""
    states = np.zeros((ground.size, size))
    for k in range(ground.size - 1):
        start, rise = ground[k], (ground[k + 1] - ground[k]) / dt
        run = solve_ivp(
            lambda t, y, start=start, rise=rise: slope(y, start + rise * t),
            (0.0, dt),
            states[k],
            "DOP853",
            rtol=1e-12,
            atol=1e-15,
        )
        states[k + 1] = run.y[:, -1]
    return states


def test_single_mode_floor_matches_integrated_oscillator():
    for period, damping in ((0.013, 0.02), (0.21, 0.0), (0.9, 0.05), (6.0, 1.0)):
        omega = 2.0 * math.pi / period

        def slope(y, a, omega=omega, damping=damping):
            return [y[1], -a - 2.0 * damping * omega * y[1] - omega**2 * y[0]]

        floor = motion().through_storeys([f"{period} s"], damping, free_vibration="0.3 s")
        states = integrate(slope, 2, ground_at_samples(floor))
        expected = -2.0 * damping * omega * states[:, 1] - omega**2 * states[:, 0]
        assert_close(floor.si.horizontal.samples, expected, 1e-9)


def test_three_storeys_of_masses_and_springs():
    """Dashpots proportional to masses and springs have a damping ratio for each mode."""
    masses, springs = np.array([30e3, 25e3, 12e3]), np.array([60e6, 35e6, 20e6])
    per_mass, per_spring = 0.6, 8e-4
    stiffness = np.array(
        [
            [springs[0] + springs[1], -springs[1], 0.0],
            [-springs[1], springs[1] + springs[2], -springs[2]],
            [0.0, -springs[2], springs[2]],
        ]
    )
    dashpots = per_mass * np.diag(masses) + per_spring * stiffness
    omegas = np.sqrt(np.sort(eigvals(stiffness / masses[:, None]).real))
    ratios = 0.5 * (per_mass / omegas + per_spring * omegas)

    def relative(y):
        return -(dashpots @ y[3:] + stiffness @ y[:3]) / masses

    def slope(y, a):
        return np.append(y[3:], relative(y) - a)

    building = {"masses": (masses / 1e3, "t"), "stiffnesses": (springs / 1e6, "MN/m")}
    for floor in (1, 2, 3):
        found = motion().through_storeys(
            **building, floor=floor, damping_ratio=ratios.tolist(), free_vibration="0.5 s"
        )
        if floor == 1:
            states = integrate(slope, 6, ground_at_samples(found))
        expected = np.array([relative(y)[floor - 1] for y in states])
        assert_close(found.si.horizontal.samples, expected, 1e-9)


def exact(ground, period, damping, dt=DT):
    """Integrate an oscillator under piecewise linear ground motion, with forty digits."""
    mpmath.mp.dps = 40
    omega = 2 * mpmath.pi / mpmath.mpf(period)
    # of u, du/dt/omega, the ground and its rise over a step
    generator = omega * mpmath.matrix([[0, 1, 0, 0], [-1, -2 * mpmath.mpf(damping), 0, 0]])
    generator = mpmath.matrix([*generator.tolist(), [0, 0, 0, 1 / mpmath.mpf(dt)], [0, 0, 0, 0]])
    generator[1, 2] = -1 / omega
    step = mpmath.expm(generator * mpmath.mpf(dt), method="taylor")[:2, :].tolist()
    u = v = mpmath.mpf(0)
    found = np.zeros(ground.size)
    for k in range(ground.size - 1):
        start, end = mpmath.mpf(ground[k]), mpmath.mpf(ground[k + 1])
        row = u, v, start, end - start
        u, v = (sum(a * b for a, b in zip(line, row, strict=True)) for line in step)
        found[k + 1] = -(omega**2) * (u + 2 * damping * v)
    return found


def test_floor_samples_match_exact_recurrence():
    for period in (0.02, 0.08, 0.5, 20.0):
        for damping, share in ((0.0, 1e-12), (0.05, 1e-13), (1.0, 1e-13)):
            floor = motion().through_storeys([f"{period} s"], damping, free_vibration="1 s")
            expected = exact(ground_at_samples(floor), period, damping)
            assert_close(floor.si.horizontal.samples, expected, share)


def test_finer_time_step_gives_same_floor_motion():
    coarse = motion().through_storeys(["0.15 s", "0.04 s"], floor_participations=[1.3, -0.4])
    for step, parts in (("0.0025 s", 4), ("0.0034 s", 3)):
        fine = motion().through_storeys(
            ["0.15 s", "0.04 s"], floor_participations=[1.3, -0.4], time_step=step
        )
        assert fine.si.time_step == DT / parts
        assert_close(fine.si.horizontal.samples[::parts], coarse.si.horizontal.samples, 1e-13)
    ground = ground_at_samples(coarse)
    expected = (
        0.1 * ground + 1.3 * exact(ground, 0.15, 0.05) - 0.4 * exact(ground, 0.04, 0.05)
    )  # fmt: skip
    assert_close(coarse.si.horizontal.samples, expected, 1e-13)


def test_a_harmonic_from_rest_in_closed_form():
    """A pulse is integrated by its polynomials, not by straight lines through its samples."""
    rate, omega, damping = 2.0 * math.pi, 2.0 * math.pi / 0.37, 0.04
    pulse = rf.GroundMotion.harmonic("1 m/s^2", "1 Hz", duration="5 s")
    floor = pulse.through_storeys(["0.37 s"], damping, time_step="0.002 s").si.horizontal
    time = floor.times[floor.times <= 5.0]
    gap, drag = omega**2 - rate**2, 2.0 * damping * omega * rate
    s, c = -gap / (gap**2 + drag**2), drag / (gap**2 + drag**2)
    root = -damping * omega + 1j * omega * math.sqrt(1.0 - damping**2)
    # u = s sin + c cos + Re(p e^(root t)), from rest
    p = -c + 1j * (rate * s - c * root.real) / root.imag
    free = p * np.exp(root * time)
    u = s * np.sin(rate * time) + c * np.cos(rate * time) + free.real
    v = rate * (s * np.cos(rate * time) - c * np.sin(rate * time)) + (root * free).real
    assert abs(u[0]) + abs(v[0]) < 1e-15
    assert_close(floor.samples[: time.size], -2.0 * damping * omega * v - omega**2 * u, 1e-11)


def test_jump_of_pulse_is_resolved_exactly():
    """Under a constant acceleration an undamped floor reaches twice that value."""
    pulse = rf.GroundMotion.cosine_pulse("1 m/s^2", "0.01 Hz", cycles=1)
    floor = pulse.through_storeys(
        ["0.5 s"], 0, free_vibration="0 s", time_step="0.001 s"
    ).si.horizontal
    time = floor.times[:500]
    slow, omega = 0.02 * math.pi, 4.0 * math.pi
    u = -(np.cos(slow * time) - np.cos(omega * time)) / (omega**2 - slow**2)
    assert_close(floor.samples[:500], -(omega**2) * u, 1e-11)
    assert floor.samples[250] == pytest.approx(2.0, rel=1e-3)


def test_the_spectrum_of_a_floor_is_that_of_an_oscillator_on_an_oscillator():
    below, above = 0.4, np.array([0.11, 0.39, 0.8])
    floor = motion().through_storeys([f"{below} s"], 0.03, time_step="0.0004 s")
    ground = np.append(NOISE, np.zeros(len(floor) // 25 + 1 - NOISE.size))
    found = rf.response_spectrum(floor, (above, "s"), 0.05).absolute_spectral_acceleration
    for period, peak in zip(above, found.values[0], strict=True):
        omega, second = 2.0 * math.pi / below, 2.0 * math.pi / period
        generator = np.zeros((6, 6))
        generator[0, 1] = generator[2, 3] = generator[4, 5] = 1.0
        generator[1, :2] = -(omega**2), -2.0 * 0.03 * omega
        generator[3, 2:4] = -(second**2), -2.0 * 0.05 * second
        generator[3, :2] = -generator[1, :2]  # less the floor's absolute acceleration
        generator[1, 4] = -1.0
        step = expm(generator * DT / 25)
        state, highest = np.zeros(6), 0.0
        for k in range(ground.size - 1):
            state[4:] = ground[k], (ground[k + 1] - ground[k]) / DT
            for _ in range(25):
                state = step @ state
                highest = max(highest, abs(generator[3, 2:4] @ state[2:4]))
        assert peak == pytest.approx(highest, rel=2e-4)


def test_transmissibilities_of_floor_and_oscillator_multiply():
    """For a long harmonic that fades in, transmissibilities of floor and oscillator multiply."""
    step, below, above, damping = 0.005, 0.6, 0.35, 0.05
    time = np.arange(12_001) * step
    swell = np.sin(0.5 * np.pi * np.minimum(1.0, np.minimum(time, time[-1] - time) / 20.0)) ** 2
    floor = motion(swell * np.sin(2.0 * np.pi * time), step).through_storeys([f"{below} s"])

    def transmitted(r):
        return math.sqrt(
            (1.0 + (2.0 * damping * r) ** 2) / ((1.0 - r * r) ** 2 + (2.0 * damping * r) ** 2)
        )

    assert floor.si.peak == pytest.approx(transmitted(below), rel=1e-3)
    spectrum = rf.response_spectrum(floor, [f"{above} s"], damping)
    found = spectrum.absolute_spectral_acceleration.item()
    assert found == pytest.approx(transmitted(below) * transmitted(above), rel=1e-3)


def test_stiff_floors_follow_ground_and_soft_floors_stand_still():
    smooth = np.convolve(NOISE, np.hanning(30), "full")
    for period, tolerance in (("0 s", 0.0), ("1e-5 s", 1e-4), ("0.001 s", 1e-2)):
        floor = motion(smooth).through_storeys([period], 0.05).si.horizontal.samples
        assert_close(floor, ground_at_samples(floor, smooth), tolerance)
    peak = np.abs(smooth).max()
    for period in (1e3, 1e5):
        floor = motion(smooth).through_storeys([f"{period} s"], 0.0, free_vibration="0 s")
        velocity = np.abs(DT * np.cumsum(smooth)).max()
        bound = (2.0 * math.pi / period) * velocity
        assert floor.si.peak <= 1.01 * bound < 0.1 * peak


def test_floor_motion_is_linear_and_mirrored():
    building = {"storeys": 5, "floor": 3, "period": "0.5 s"}
    one = motion().through_storeys(**building).si.horizontal.samples
    other = motion(NOISE[::-1]).through_storeys(**building).si.horizontal.samples
    both = motion(2.0 * NOISE - 0.5 * NOISE[::-1]).through_storeys(**building)
    assert_close(both.si.horizontal.samples, 2.0 * one - 0.5 * other, 1e-13)
    mirrored = motion(-NOISE).through_storeys(**building).si.horizontal.samples
    assert mirrored.tolist() == (-one).tolist()


def test_uniform_storeys_match_assembled_masses_and_stiffnesses():
    for storeys in (1, 2, 6, 15):
        mass, stiffness = 80e3, 120e6
        angle = math.pi / (2 * storeys + 1)
        first = math.pi / (math.sqrt(stiffness / mass) * math.sin(0.5 * angle))
        for floor in {1, storeys // 2 + 1, storeys}:
            uniform = motion().through_storeys(
                storeys=storeys, floor=floor, period=f"{first!r} s", free_vibration="1 s"
            )
            assembled = motion().through_storeys(
                masses=(storeys * [mass], "kg"),
                stiffnesses=(storeys * [stiffness], "N/m"),
                floor=floor,
                free_vibration="1 s",
            )
            assert_close(uniform.si.horizontal.samples, assembled.si.horizontal.samples, 1e-9)


def test_truncated_modes_move_with_ground():
    """The first mode alone suffices where the others are stiff relative to the motion."""
    smooth = motion(np.convolve(NOISE, np.hanning(40), "full") / 10.0)
    building = {"storeys": 4, "floor": 2, "period": "0.2 s", "time_step": "0.002 s"}
    all_modes = smooth.through_storeys(**building).si.horizontal.samples
    errors = []
    for modes in (1, 2, 3, 4):
        part = smooth.through_storeys(**building, modes=modes).si.horizontal.samples
        errors.append(np.abs(part - all_modes).max() / np.abs(all_modes).max())
    assert errors[0] < 0.1
    assert errors[3] == 0.0
    assert sorted(errors, reverse=True) == errors


def test_free_vibration_lasts_until_decay():
    for damping in (0.01, 0.05, 0.3, 1.0):
        pulse = motion([0.0, 1.0, 0.0]).through_storeys(["0.5 s"], damping)
        samples = np.abs(pulse.si.horizontal.samples)
        assert samples[-10:].max() < 0.01 * samples.max()
