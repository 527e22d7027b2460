"""Signals: one function of time per component, evaluated at any time."""

import copy
import hashlib
import math
import pickle
import struct

import numpy as np
import pytest

from rockframe.errors import ComponentError
from rockframe.signals import Motion, Signal
from rockframe.signals.motion import Incline

pytestmark = pytest.mark.unit

STEP = 0.01
VALUES = np.array([0.0, 1.5, -2.25, 0.5, 0.125])
QUINTICS = np.random.default_rng(7).normal(size=(4, 6))
RECORD = Signal(STEP, VALUES)
ANALYTIC = Signal(STEP, np.append(QUINTICS[:, 0], 0.75), QUINTICS)


def test_record_has_linear_pieces():
    assert not RECORD.analytic
    assert RECORD.polynomials is None
    assert RECORD.pieces.tolist() == [[0.0, 1.5], [1.5, -3.75], [-2.25, 2.75], [0.5, -0.375]]
    assert RECORD.pieces is RECORD.pieces


def test_polynomials_of_an_analytic_signal():
    assert ANALYTIC.analytic
    assert ANALYTIC.pieces.tolist() == QUINTICS.tolist()


@pytest.mark.parametrize("signal", [RECORD, ANALYTIC])
def test_arrays_are_read_only_and_contiguous(signal):
    for array in (signal.samples, signal.pieces):
        assert array.dtype == np.float64
        assert array.flags.c_contiguous
        assert not array.flags.writeable


@pytest.mark.parametrize("signal", [RECORD, ANALYTIC])
def test_values_at_sample_times_equal_samples(signal):
    assert signal.at(signal.times).tolist() == signal.samples.tolist()
    late, early = signal.times * (1.0 + 1e-15), signal.times * (1.0 - 1e-15)
    assert signal.at(late).tolist() == signal.at(early).tolist() == signal.samples.tolist()
    shifts = np.array([-1e-11, 1e-11]) * STEP
    assert signal.at(shifts).tolist() == [signal.samples[0]] * 2
    assert signal.at(signal.duration + shifts).tolist() == [signal.samples[-1]] * 2


def test_jump_between_pieces_gives_sample_or_later_piece():
    steps = np.zeros((2, 6))
    steps[:, 0] = [1.0, 3.0]
    jumping = Signal(STEP, [1.0, 2.0, 3.0], steps)
    assert jumping.at([0.009, 0.01, 0.011]).tolist() == [1.0, 2.0, 3.0]
    assert jumping.at_place(np.array([0.9, 1.0, 1.1])).tolist() == [1.0, 3.0, 3.0]


def test_polynomials_between_samples():
    place = np.array([0.25, 1.5, 3.75])
    exact = [np.polynomial.Polynomial(QUINTICS[k])(u) for k, u in ((0, 0.25), (1, 0.5), (3, 0.75))]
    assert ANALYTIC.at(place * STEP) == pytest.approx(exact, rel=1e-12)
    assert ANALYTIC.at_place(place) == pytest.approx(exact, rel=1e-14)
    assert RECORD.at(place * STEP) == pytest.approx([0.375, -0.375, 0.21875], rel=1e-12)


@pytest.mark.parametrize("signal", [RECORD, ANALYTIC])
def test_zero_outside(signal):
    end = signal.duration
    assert signal.at([-1.0, -1e-8, end * (1.0 + 1e-6), 7.0]).tolist() == [0.0] * 4


def test_a_time_that_is_no_number_is_refused():
    with pytest.raises(ComponentError, match="times must be numbers, got nan"):
        RECORD.at([0.0, np.nan])


@pytest.mark.parametrize("signal", [RECORD, ANALYTIC])
@pytest.mark.parametrize("shape", [(), (1,), (2, 3), (0,)])
def test_values_have_the_shape_of_the_times(signal, shape):
    assert signal.at(np.full(shape, 0.013)).shape == shape


def test_the_vertical_component_has_its_own_pieces():
    motion = Motion(ANALYTIC, RECORD)
    assert motion.analytic
    assert motion.duration == RECORD.duration
    assert motion.time_step == STEP
    assert motion.at([0.013]).tolist() == ANALYTIC.at([0.013]).tolist()
    assert Motion(RECORD, ANALYTIC).analytic
    assert not Motion(RECORD, RECORD).analytic
    assert Motion(RECORD, ANALYTIC).digest != motion.digest


@pytest.mark.parametrize("size", [3.0, -3.0])
def test_the_peak_is_between_samples_also_where_the_slope_is_zero_twice(size):
    """x (x - 1/2) (x - 1) rises at both ends, with extrema of sqrt(3)/36 between them."""
    cubic = size * np.array([0.0, 0.5, -1.5, 1.0, 0.0, 0.0])
    signal = Signal(STEP, np.zeros(4), np.array([0.0 * cubic, cubic, 0.5 * cubic]))
    assert signal.peak == pytest.approx(3.0 * math.sqrt(3.0) / 36.0, rel=1e-12)


def test_motions_are_resolved_along_a_slope_until_the_end_of_the_run():
    """The motion ends at 2 s with a jump, gravity acts on to the end."""
    sine, cosine = math.sin(0.1), math.cos(0.1)
    motion = Motion.of_samples(1.0, np.array([0.0, 2.0, -1.0]), np.array([0.0, 0.5, 3.0]))
    base = Incline(0.1, 9.81).resolved(motion, duration=3.0, interval=0.1)
    assert base.duration >= 3.0
    times = np.array([0.5, 1.0, 1.5, 2.5, base.duration])
    across, up = np.array([1.0, 2.0, 0.5, 0.0, 0.0]), np.array([0.25, 0.5, 1.75, 0.0, 0.0])
    along = across * cosine + up * sine + 9.81 * sine
    np.testing.assert_allclose(base.horizontal.at(times), along, rtol=1e-14)
    np.testing.assert_allclose(base.vertical.at(times), up * cosine - across * sine, atol=1e-15)
    before_its_end = base.horizontal.at(2.0 - 1e-6)
    assert before_its_end == pytest.approx(-cosine + 3.0 * sine + 9.81 * sine, abs=1e-5)


def test_the_digest_is_that_of_all_numbers():
    """By hand: step, horizontal and vertical samples, and polynomials, each after its size."""
    samples = np.array([0.0, 2.0, -1.0])
    content = b"rockframe motion 1" + struct.pack("<dq3d", 0.5, 3, *samples)
    missing = struct.pack("<q", -1)
    expected = hashlib.sha256(content + 3 * missing).hexdigest()
    assert Motion.of_samples(0.5, samples).digest == expected
    content += struct.pack("<q3d", 3, *-samples) + 2 * missing
    expected = hashlib.sha256(content).hexdigest()
    assert Motion.of_samples(0.5, samples, -samples).digest == expected


def test_both_components_are_changed_alike():
    def doubled(signal):
        return Signal(signal.time_step, 2.0 * signal.samples)

    motion = Motion.of_samples(STEP, VALUES, -VALUES).each(doubled)
    assert motion.horizontal.samples.tolist() == (2.0 * VALUES).tolist()
    assert motion.vertical.samples.tolist() == (-2.0 * VALUES).tolist()
    assert Motion(RECORD).each(doubled).vertical is None


@pytest.mark.parametrize(
    "twin",
    [copy.copy, copy.deepcopy, lambda motion: pickle.loads(pickle.dumps(motion))],  # noqa: S301
)
def test_copies_are_equal_and_read_only(twin):
    motion = Motion(ANALYTIC, RECORD)
    copied = twin(motion)
    assert copied.digest == motion.digest
    for signal in (copied.horizontal, copied.vertical):
        assert not signal.samples.flags.writeable
        assert not signal.pieces.flags.writeable


def test_nothing_can_be_assigned():
    with pytest.raises(AttributeError):
        RECORD.time_step = 1.0
    with pytest.raises(AttributeError):
        Motion(RECORD).vertical = RECORD
