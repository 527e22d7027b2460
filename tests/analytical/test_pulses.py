"""Analytic pulses: acceleration, velocity and displacement against closed forms."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
import sympy as sp

from rockframe.motion import GroundMotion
from rockframe.motion.constructors.analytic import PULSES
from rockframe.motion.pulses import ANTISYMMETRIC, type_c_phase

pytestmark = pytest.mark.analytical

TIME = sp.Symbol("t", real=True)
VELOCITY, PERIOD = 0.7, 1.3
ACCELERATION, FREQUENCY = -3.1, 0.8
OMEGA = 2.0 * math.pi / PERIOD
CENTRE = 2.5 * PERIOD
EXACT = 1e-12
"""Of the amplitude, which a sampled motion may be off."""


@dataclass(frozen=True)
class Case:
    """A motion and the displacement whose second derivative is its acceleration."""

    motion: GroundMotion
    displacement: sp.Expr

    def formula(self, derivative):
        function = sp.lambdify(TIME, sp.diff(self.displacement, TIME, derivative), "numpy")
        return lambda time: function(time) * np.ones_like(time)


def type_c(order):
    phi = type_c_phase(order)
    turned = OMEGA * TIME + phi
    return VELOCITY * ((sp.cos(phi) - sp.cos(turned)) / OMEGA - sp.sin(phi) * TIME)


def sines(frequency=FREQUENCY, phase=0.0):
    omega = 2.0 * math.pi * frequency
    angle = omega * TIME + phase
    return ACCELERATION / omega**2 * (omega * sp.cos(phase) * TIME - sp.sin(angle) + sp.sin(phase))


def ricker(degree):
    """Return the displacement of the derivative of degree `degree` of the Gaussian."""
    scale = 2.0 * math.pi / PERIOD / math.sqrt(degree)
    place = scale * (TIME - CENTRE)
    bell = sp.exp(-(place**2) / 2)
    if degree == 2:
        return -ACCELERATION * bell / scale**2
    return ACCELERATION / ANTISYMMETRIC.peak * place * bell / scale**2


def enveloped(cycles, phase):
    """Integrate v = A/2 [1 + cos(2 pi f t/gamma)] cos(2 pi f t + nu) about the middle."""
    middle = TIME - cycles / FREQUENCY / 2.0
    omega = 2.0 * math.pi * FREQUENCY
    parts = [(1.0, 0.5), (1.0 + 1.0 / cycles, 0.25), (1.0 - 1.0 / cycles, 0.25)]
    total = sp.Integer(0)
    for ratio, share in parts:
        if ratio == 0.0:
            total += share * math.cos(phase) * middle
        else:
            total += share * sp.sin(ratio * omega * middle + phase) / (ratio * omega)
    return VELOCITY * total


def mavroeidis(cycles, degrees):
    return GroundMotion.mavroeidis_papageorgiou_pulse(
        f"{VELOCITY} m/s", f"{FREQUENCY} Hz", cycles, f"{degrees} deg"
    )


V, T = f"{VELOCITY} m/s", f"{PERIOD} s"
A, F = f"{ACCELERATION} m/s^2", f"{FREQUENCY} Hz"
ENVELOPED = [(1.0, 0.0), (1.0, 90.0), (1.7, 30.0), (2.0, -75.0), (3.4, 90.0), (12.3, 215.0)]

CASES = {
    "sine": Case(GroundMotion.sine_pulse(A, F, 1.3), sines()),
    "cosine": Case(GroundMotion.cosine_pulse(A, F, 0.7), sines(phase=0.5 * math.pi)),
    "half sine": Case(GroundMotion.half_sine_pulse(A, T), sines(0.5 / PERIOD)),
    "harmonic": Case(GroundMotion.harmonic(A, F, "4.1 s", "40 deg"), sines(phase=2 * math.pi / 9)),
    "type A": Case(
        GroundMotion.type_a_pulse(V, T), VELOCITY / 2 * (TIME - sp.sin(OMEGA * TIME) / OMEGA)
    ),
    "type B": Case(GroundMotion.type_b_pulse(V, T), VELOCITY / OMEGA * (1 - sp.cos(OMEGA * TIME))),
    **{
        f"type C{order}": Case(GroundMotion.type_c_pulse(V, T, order), type_c(order))
        for order in (1, 2, 3, 7)
    },
    "Ricker, symmetric": Case(GroundMotion.ricker_wavelet(A, T), ricker(2)),
    "Ricker, antisymmetric": Case(GroundMotion.ricker_wavelet(A, T, antisymmetric=True), ricker(3)),
    **{
        f"Mavroeidis {cycles:g}, {degrees:g} deg": Case(
            mavroeidis(cycles, degrees), enveloped(cycles, math.radians(degrees))
        )
        for cycles, degrees in ENVELOPED
    },
}

RETURNING = [
    name
    for name in CASES
    if name.startswith(("type B", "type C", "Ricker"))
    or name in ("Mavroeidis 1, 90 deg", "Mavroeidis 2, -75 deg", "Mavroeidis 3.4, 90 deg")
]
STOPPING = [*RETURNING, "type A", *(name for name in CASES if name.startswith("Mavroeidis"))]


def path(motion):
    """Integrate the polynomials of a motion from rest; give times, velocity, displacement."""
    dt, pieces = motion.si.time_step, motion.si.horizontal.pieces
    powers = np.arange(pieces.shape[1])
    gained = dt * (pieces / (powers + 1)).sum(axis=1)
    velocity = np.concatenate([[0.0], np.cumsum(gained)])
    moved = dt * velocity[:-1] + dt**2 * (pieces / ((powers + 1) * (powers + 2))).sum(axis=1)
    return dt * np.arange(len(velocity)), velocity, np.concatenate([[0.0], np.cumsum(moved)])


@pytest.fixture(params=CASES)
def case(request):
    return CASES[request.param]


def test_every_pulse_has_a_case():
    tested = {case.motion.recipe["constructor"] for case in CASES.values()}
    missing = set(PULSES) - tested - {"double_impulse"}  # it is tested below
    assert not missing, f"add the paths of {missing} to CASES"


def test_acceleration_between_samples(case):
    time = np.linspace(0.0, case.motion.si.duration, 20011)
    exact = case.formula(2)(time)
    assert np.max(np.abs(case.motion.si.at(time) - exact)) <= EXACT * np.max(np.abs(exact))


def test_velocity_and_displacement(case):
    time, velocity, displacement = path(case.motion)
    for derivative, found in ((1, velocity), (0, displacement)):
        exact = case.formula(derivative)(time)
        exact = exact - exact[0]
        assert found == pytest.approx(exact, rel=0.0, abs=5e-12 * np.max(np.abs(exact)))


@pytest.mark.parametrize("name", dict.fromkeys(STOPPING))
def test_final_ground_velocity_is_zero(name):
    _, velocity, _ = path(CASES[name].motion)
    assert abs(velocity[-1]) <= 5e-15 * len(velocity) ** 0.5 * np.max(np.abs(velocity))


@pytest.mark.parametrize("name", RETURNING)
def test_final_ground_displacement_is_zero(name):
    _, _, displacement = path(CASES[name].motion)
    assert abs(displacement[-1]) <= EXACT * np.max(np.abs(displacement))


@pytest.mark.parametrize(("cycles", "degrees"), ENVELOPED)
def test_residual_displacement_of_mavroeidis_pulse(cycles, degrees):
    _, _, displacement = path(mavroeidis(cycles, degrees))
    share = (
        0.25 if cycles == 1.0 else math.sin(math.pi * cycles) / (2.0 * math.pi * (1.0 - cycles**2))
    )
    left = VELOCITY / FREQUENCY * math.cos(math.radians(degrees)) * share
    assert displacement[-1] == pytest.approx(left, abs=1e-13)


PEAK_VELOCITY = {
    "type A": VELOCITY,
    "type B": VELOCITY,
    "type C1": 1.2172 * VELOCITY,
    "type C2": 1.1284 * VELOCITY,
    "Mavroeidis 1, 0 deg": VELOCITY,
    "Ricker, symmetric": 0.136517 * abs(ACCELERATION) * PERIOD,
    "Ricker, antisymmetric": 0.199741 * abs(ACCELERATION) * PERIOD,
}


@pytest.mark.parametrize(("name", "peak"), PEAK_VELOCITY.items())
def test_peak_velocity(name, peak):
    _, velocity, _ = path(CASES[name].motion)
    assert np.max(np.abs(velocity)) == pytest.approx(peak, rel=4e-4)


@pytest.mark.parametrize("name", ["type A", "type B", "Mavroeidis 1, 0 deg"])
def test_requested_peak_velocity_is_reached_at_a_sample(name):
    _, velocity, _ = path(CASES[name].motion)
    assert np.max(velocity) == pytest.approx(VELOCITY, rel=1e-13)


@pytest.mark.parametrize("name", ["Ricker, symmetric", "Ricker, antisymmetric"])
def test_peak_acceleration_of_wavelets(name):
    assert CASES[name].motion.si.peak == pytest.approx(abs(ACCELERATION), rel=1e-12)


# type C ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("order", "phase", "length"), [(1, 0.0697, 1.430297), (2, 0.0410, 2.459024)]
)
def test_published_phases_of_type_c(order, phase, length):
    assert type_c_phase(order) / math.pi == pytest.approx(phase, abs=5e-5)
    motion = GroundMotion.type_c_pulse("1 m/s", "1 s", order)
    assert motion.si.duration == pytest.approx(length, abs=5e-7)


@pytest.mark.parametrize("order", [1, 2, 3, 10, 1000])
def test_phase_of_type_c_solves_its_equation(order):
    phase = type_c_phase(order)
    turned = (2 * order + 1) * math.pi - phase
    rest = math.cos(turned) + (turned - phase) * math.sin(phase) - math.cos(phase)
    assert abs(rest) <= 1e-15 * turned
    # the half length in radians is a root of tan x = x
    half = 0.5 * (turned - phase)
    assert math.sin(half) - half * math.cos(half) == pytest.approx(0.0, abs=1e-15 * half**2)


# printed formulas -------------------------------------------------------------------------------


@pytest.mark.parametrize(("cycles", "degrees"), ENVELOPED)
def test_printed_acceleration_of_mavroeidis_is_the_derivative_of_the_velocity(cycles, degrees):
    motion = mavroeidis(cycles, degrees)
    time = np.linspace(0.0, motion.si.duration, 20011)
    fast = 2.0 * np.pi * FREQUENCY * (time - 0.5 * cycles / FREQUENCY)
    slow, fast = fast / cycles, fast + math.radians(degrees)
    printed = -(VELOCITY * np.pi * FREQUENCY / cycles) * (
        np.sin(slow) * np.cos(fast) + cycles * np.sin(fast) * (1.0 + np.cos(slow))
    )
    assert motion.si.at(time) == pytest.approx(printed, abs=EXACT * np.max(np.abs(printed)))


def test_printed_ricker_wavelets():
    time = np.linspace(0.0, 5.0 * PERIOD, 20011)
    u = np.pi * (time - CENTRE) / PERIOD
    symmetric = (1.0 - 2.0 * u**2) * np.exp(-(u**2))
    antisymmetric = (4.0 / 3.0 * u**2 - 3.0) * (2.0 / 3.0**0.5 * u) * np.exp(-2.0 / 3.0 * u**2)
    for name, shape, peak, size in (
        ("Ricker, symmetric", symmetric, 1.0, EXACT),
        ("Ricker, antisymmetric", antisymmetric, 1.380119, 5e-7),  # as many digits are printed
    ):
        found = CASES[name].motion.si.at(time) / ACCELERATION * peak
        assert found == pytest.approx(shape, abs=size)


@pytest.mark.parametrize("antisymmetric", [False, True])
def test_ricker_wavelet_period_is_that_of_its_spectral_peak(antisymmetric):
    motion = GroundMotion.ricker_wavelet("1 m/s^2", "1 s", antisymmetric=antisymmetric)
    time = np.arange(len(motion)) * motion.si.time_step

    def amplitude(frequency):
        return abs(np.sum(motion.si.horizontal.samples * np.exp(-2j * np.pi * frequency * time)))

    assert amplitude(1.0) > max(amplitude(0.999), amplitude(1.001))


@pytest.mark.parametrize("antisymmetric", [False, True])
def test_truncation_of_ricker_wavelet_is_negligible(antisymmetric):
    samples = GroundMotion.ricker_wavelet(
        "1 m/s^2", "1 s", antisymmetric=antisymmetric
    ).si.horizontal.samples
    assert np.max(np.abs(samples[[0, -1]])) < 8e-16


# two impulses ------------------------------------------------------------------------------------

IMPULSES = [("0.4 s", None), ("0.4 s", "0.01 s"), ("0.37 s", "0.1 s"), ("2 s", "2 s")]


@pytest.mark.parametrize(("interval", "length"), IMPULSES)
def test_double_impulse(interval, length):
    motion = GroundMotion.double_impulse("0.9 m/s", interval, length)
    apart = float(interval.split()[0])
    time, velocity, displacement = path(motion)
    each = motion.si.duration - apart
    assert each <= (0.01 * apart if length is None else float(length.split()[0])) * (1.0 + 1e-12)
    assert apart / each == pytest.approx(round(apart / each), rel=1e-9)
    between = (time > each * (1.0 - 1e-9)) & (time < apart * (1.0 + 1e-9))
    assert velocity[between] == pytest.approx(0.9, rel=1e-13)
    assert velocity[-1] == pytest.approx(0.0, abs=1e-13)
    assert displacement[-1] == pytest.approx(0.9 * apart, rel=1e-12)
    assert motion.si.peak == pytest.approx(1.875 * 0.9 / each, rel=1e-12)


def test_shape_of_an_impulse():
    motion = GroundMotion.double_impulse("1 m/s", "1 s", "0.25 s")
    time = np.linspace(0.0, 1.25, 10001)
    first, second = time / 0.25, (time - 1.0) / 0.25
    exact = sum(
        sign * np.where((u > 0.0) & (u < 1.0), 30.0 * (u * (1.0 - u)) ** 2, 0.0) / 0.25
        for sign, u in ((1.0, first), (-1.0, second))
    )
    assert motion.si.at(time) == pytest.approx(exact, abs=1e-12 * 7.5)


def fourier(motion, frequencies, until):
    """Return Fourier amplitudes of the acceleration up to a time, by the rule of midpoints."""
    step = until / 20000
    time = step * (np.arange(20000) + 0.5)
    values = motion.si.at(time)
    return [step * abs(np.exp(-2j * np.pi * one * time) @ values) for one in frequencies]


def test_spectral_reduction_of_short_impulse():
    """By the variance 1/28 of its shape: 1 - (omega tau)^2/56."""
    motion, turned = GroundMotion.double_impulse("1 m/s", "1 s", "0.25 s"), 0.2
    (amplitude,) = fourier(motion, [turned / (2.0 * np.pi * 0.25)], 0.25)
    assert (1.0 - amplitude) / turned**2 == pytest.approx(1.0 / 56.0, rel=1e-3)


def test_velocity_ratio_of_equivalent_one_cycle_sine():
    impulses = GroundMotion.double_impulse("1 m/s", "1 s", "0.001 s")
    assert fourier(impulses, [0.5], impulses.si.duration)[0] == pytest.approx(2.0, rel=1e-5)
    sine = GroundMotion.type_a_pulse("1 m/s", "2 s")
    greatest = max(fourier(sine, np.linspace(0.25, 0.5, 201), 2.0))
    assert greatest == pytest.approx(1.636, abs=5e-4)
    assert 2.0 / greatest == pytest.approx(1.222, abs=5e-4)  # v_p/V
