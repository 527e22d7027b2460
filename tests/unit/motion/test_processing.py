"""Processing steps: their effect on the function of time, and their history entries."""

import numpy as np
import pytest
from scipy import signal

from rockframe.errors import ComponentError, UnitsError
from rockframe.measures import velocity_and_displacement
from rockframe.motion import GroundMotion

RNG = np.random.default_rng(20)
NOISE = RNG.normal(size=400)
STEP = 0.01


def motion(values=NOISE, vertical=None, step=STEP):
    up = None if vertical is None else (vertical, "m/s^2")
    return GroundMotion.from_arrays((values, "m/s^2"), f"{step!r} s", up, name="noise")


def tone(frequency, step=STEP, count=4001):
    """A tone with a smooth envelope, so that end effects vanish."""
    time = np.arange(count) * step
    swell = np.sin(np.pi * time / time[-1]) ** 2
    return swell * np.sin(2.0 * np.pi * frequency * time)


ALL_STEPS = {
    "window": lambda m: m.window("1 s", "2 s"),
    "scaled": lambda m: m.scaled(0.5),
    "scaled to a peak": lambda m: m.scaled(peak="0.1 g_0"),
    "refined": lambda m: m.resampled("0.0025 s"),
    "coarsened": lambda m: m.resampled("0.02 s"),
    "tapered": lambda m: m.window(taper="0.5 s"),
    "scaled to a velocity": lambda m: m.scaled(peak_velocity="0.1 m/s"),
    "causal": lambda m: m.filtered(low="0.5 Hz", causal=True),
    "drift": lambda m: m.baseline_corrected(2, fit="velocity"),
    "rotated": lambda m: m.rotated(m, "30 deg"),
    "filtered": lambda m: m.filtered(low="0.5 Hz", high="20 Hz"),
    "baseline": lambda m: m.baseline_corrected(),
    "vertical": lambda m: m.with_vertical(m),
    "through storeys": lambda m: m.through_storeys(["0.5 s"]),
}


@pytest.mark.parametrize("step", ALL_STEPS)
@pytest.mark.parametrize("vertical", [None, NOISE[::-1]])
def test_every_step_returns_a_new_motion_and_adds_to_the_history(step, vertical):
    before = motion(vertical=vertical)
    copy = motion(vertical=vertical)
    after = ALL_STEPS[step](before)
    assert before == copy
    assert isinstance(after, GroundMotion)
    assert after.history[: len(before.history)] == before.history
    assert len(after.history) > len(before.history)
    assert after.name == before.name
    assert (after.si.vertical is None) == (vertical is None and step != "vertical")
    assert not after.si.horizontal.samples.flags.writeable


@pytest.mark.parametrize(
    "step",
    [
        "window",
        "tapered",
        "scaled",
        "refined",
        "coarsened",
        "filtered",
        "causal",
        "baseline",
        "drift",
    ],
)
def test_the_vertical_component_is_processed_alike(step):
    both = ALL_STEPS[step](motion(NOISE, NOISE))
    assert both.si.vertical.samples.tolist() == both.si.horizontal.samples.tolist()


def test_window_cuts_samples_and_restarts_time():
    part = motion(vertical=-NOISE).window("1 s", "2.5 s")
    assert part.si.horizontal.samples.tolist() == NOISE[100:251].tolist()
    assert part.si.vertical.samples.tolist() == (-NOISE[100:251]).tolist()
    assert part.si.time_step == STEP
    assert part.history[-1] == "window from 1 s to 2.5 s"


def test_window_snaps_to_samples_and_records_it_in_history():
    part = motion().window("1.004 s", "1506 ms")
    assert part.si.horizontal.samples.tolist() == NOISE[100:152].tolist()
    assert part.history[-1] == (
        "window from 1 s to 1.51 s, the samples nearest to 1.004 s and 1.506 s"
    )


def test_window_of_everything():
    assert motion().window("0 s", "3.99 s").sha256 == motion().sha256


def test_window_may_end_one_step_after_the_last_sample():
    part = motion().window("3 s", "4 s")
    assert part.si.horizontal.samples.tolist() == NOISE[300:].tolist()
    assert "nearest to" in part.history[-1]


@pytest.mark.parametrize(
    ("start", "end", "words"),
    [
        ("-1 s", "2 s", "start = -1 s is outside the motion, which lasts from 0 s to 3.99 s"),
        ("1 s", "5 s", "end = 5 s is outside the motion"),
        ("1 s", "4.01 s", "end = 4.01 s is outside the motion"),
        ("6 s", "7 s", "start = 6 s is outside"),
        ("2 s", "1 s", "end = 1 s must be at least one time step"),
        ("2 s", "2 s", "end = 2 s must be at least one time step"),
        ("2 s", "2.004 s", "at least one time step"),
        ("nan s", "1 s", "start must be finite"),
        ("0 s", "inf s", "end must be finite"),
    ],
)
def test_windows_out_of_range(start, end, words):
    with pytest.raises(ComponentError, match=words):
        motion().window(start, end)


@pytest.mark.parametrize("end", [2.0, "2", "2 m"])
def test_window_needs_times(end):
    with pytest.raises(UnitsError, match="end needs a time"):
        motion().window("1 s", end)


def test_a_taper_is_half_a_cosine_at_both_ends():
    ones = motion(np.ones(401), vertical=np.ones(401)).window("1 s", "3 s", taper="0.5 s")
    time = np.arange(201) * STEP
    from_end = np.minimum(time, 2.0 - time)
    share = 0.5 * (1.0 - np.cos(np.pi * np.minimum(from_end / 0.5, 1.0)))
    assert ones.si.horizontal.samples == pytest.approx(share, abs=1e-12)
    assert ones.si.vertical.samples == pytest.approx(share, abs=1e-12)
    assert ones.si.horizontal.samples[[0, -1]].tolist() == [0.0, 0.0]
    assert ones.history[-2:] == (
        "window from 1 s to 3 s",
        "tapered over 0.5 s at both ends, half a cosine",
    )


def test_tapers_may_meet_in_the_middle():
    bell = motion(np.ones(401)).window(taper="2 s").si.horizontal.samples
    assert bell.argmax() == 200
    assert bell[200] == 1.0
    assert len(bell) == 401


@pytest.mark.parametrize(
    ("taper", "error", "words"),
    [
        ("2.1 s", ComponentError, "two tapers of 2.1 s are longer than the window, 3.99 s"),
        ("0 s", ComponentError, "taper must be greater than zero"),
        (0.5, UnitsError, "taper needs a time"),
    ],
)
def test_tapers_that_are_refused(taper, error, words):
    with pytest.raises(error, match=words):
        motion().window(taper=taper)


def test_tapers_longer_than_window_raise():
    with pytest.raises(ComponentError, match="longer than the window, 1 s"):
        motion().window("1 s", "2 s", taper="0.6 s")


@pytest.mark.parametrize("factor", [2, -0.5, "50 %", 0])
def test_scaled_by_a_factor(factor):
    number = 0.5 if factor == "50 %" else float(factor)
    scaled = motion(vertical=NOISE[::-1]).scaled(factor)
    assert scaled.si.horizontal.samples.tolist() == (NOISE * number).tolist()
    assert scaled.si.vertical.samples.tolist() == (NOISE[::-1] * number).tolist()


def test_scaled_to_a_peak():
    scaled = motion(vertical=NOISE * 0.5).scaled(peak="0.3 g_0")
    assert scaled.si.peak == pytest.approx(0.3 * 9.80665, rel=1e-15)
    assert scaled.si.vertical.peak == pytest.approx(0.15 * 9.80665, rel=1e-15)
    assert "to a peak of 2.941995 m s^-2" in scaled.history[-1]


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({}, ComponentError, "give one of factor, peak"),
        ({"factor": 1, "peak": "1 m/s^2"}, ComponentError, "give one of factor, peak"),
        ({"peak": "0 m/s^2"}, ComponentError, "peak must be greater than zero"),
        ({"peak": 3.0}, UnitsError, "peak needs an acceleration"),
        ({"factor": "3 m/s^2"}, UnitsError, "factor needs a pure ratio"),
        ({"factor": float("nan")}, ComponentError, "factor must be finite"),
        ({"factor": 1e308 * 1.7}, ComponentError, "finite"),
    ],
)
def test_scaling_that_is_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        motion(NOISE * 10.0).scaled(**arguments)


def test_a_still_ground_has_no_peak_to_scale():
    with pytest.raises(ComponentError, match="no horizontal acceleration"):
        motion(np.zeros(5)).scaled(peak="1 m/s^2")


@pytest.mark.parametrize(
    ("corners", "passes", "stops"),
    [
        ({"high": "5 Hz"}, [0.5, 1.0, 2.0], [12.0, 30.0]),
        ({"low": "5 Hz"}, [12.0, 30.0], [0.5, 1.0, 2.0]),
        ({"low": "2 Hz", "high": "10 Hz"}, [4.5], [0.4, 0.8, 25.0, 40.0]),
    ],
)
def test_filters_pass_and_stop_without_delay(corners, passes, stops):
    for frequency in passes:
        filtered = motion(tone(frequency)).filtered(**corners)
        assert filtered.si.horizontal.samples == pytest.approx(tone(frequency), abs=0.03)
    for frequency in stops:
        assert motion(tone(frequency)).filtered(**corners).si.peak < 0.03


def test_amplitude_at_a_corner_is_halved():
    assert motion(tone(5.0)).filtered(high="5 Hz").si.peak == pytest.approx(0.5, rel=0.01)


def test_a_higher_order_is_steeper():
    peaks = [motion(tone(8.0)).filtered(high="5 Hz", order=order).si.peak for order in (1, 2, 4, 8)]
    assert peaks == sorted(peaks, reverse=True)
    assert peaks[0] > 10.0 * peaks[-1]


def test_causal_filter_does_not_precede_input():
    values = np.zeros(400)
    values[150] = 1.0
    causal = motion(values).filtered(high="10 Hz", causal=True).si.horizontal.samples
    both = motion(values).filtered(high="10 Hz").si.horizontal.samples
    assert np.abs(causal[:150]).max() == 0.0
    assert np.abs(both[:150]).max() > 1e-3
    assert causal[150] > 0.0


def test_a_causal_filter_has_the_amplitude_of_one_pass():
    through = motion(tone(5.0)).filtered(low="5 Hz", causal=True)
    assert through.si.peak == pytest.approx(np.sqrt(0.5), rel=5e-3)
    assert "forwards only" in through.history[-1]


def test_default_filter_order_is_four():
    assert motion().filtered(high="5 Hz") == motion().filtered(high="5 Hz", order=4)


def test_default_baseline_order_is_one():
    assert motion().baseline_corrected() == motion().baseline_corrected(1)


def test_filter_records_padding_in_history():
    filtered = motion().filtered(low="0.1 Hz", order=4)
    assert len(filtered) == len(motion())
    assert "low corner 0.1 Hz, padded with 6000 zeros" in filtered.history[-1]


def test_band_pass_padding_depends_on_lower_corner():
    band = motion().filtered(low="0.1 Hz", high="20 Hz")
    assert "padded with 6000 zeros" in band.history[-1]
    sos, rest = signal.butter(4, [0.1, 20.0], "bandpass", fs=100.0, output="sos"), np.zeros(6000)
    padded = signal.sosfiltfilt(sos, np.concatenate([rest, NOISE, rest]), padtype=None)
    assert band.si.horizontal.samples == pytest.approx(padded[6000:6400], abs=1e-12)


@pytest.mark.parametrize("order", [1, 4, 8])
@pytest.mark.parametrize(
    ("kind", "corners"),
    [
        ("bandpass", {"low": 1.0, "high": 1.2}),
        ("bandpass", {"low": 0.95, "high": 1.05}),
        ("bandpass", {"low": 1.0, "high": 2.0}),
        ("bandpass", {"low": 40.0, "high": 49.0}),
        ("lowpass", {"high": 45.0}),
        ("highpass", {"low": 47.0}),
    ],
)
def test_narrow_filter_padding_avoids_end_effects(kind, corners, order):
    """Narrow filters decay slowly, as do filters with a corner close to the Nyquist frequency."""
    options = {name: f"{value} Hz" for name, value in corners.items()}
    filtered = motion().filtered(**options, order=order).si.horizontal.samples
    sos = signal.butter(order, np.squeeze([*corners.values()]), kind, fs=100.0, output="sos")
    rest = np.zeros(60_000)
    expected = signal.sosfiltfilt(sos, np.concatenate([rest, NOISE, rest]), padtype=None)
    expected = expected[rest.size : -rest.size]
    assert np.abs(filtered - expected).max() < 1e-7 * np.abs(expected).max()


@pytest.mark.parametrize("causal", [False, True])
@pytest.mark.parametrize("arguments", [{"low": "0.1 Hz"}, {"low": "0.2 Hz", "high": "25 Hz"}])
def test_filtered_motion_with_padding_ends_at_rest(causal, arguments):
    """The window begins and ends during strong shaking, so that the motion drifts."""
    record = GroundMotion.example("loma-prieta").window("5 s", "15 s")
    cut = record.filtered(**arguments, causal=causal)
    padded = record.filtered(**arguments, causal=causal, keep_padding=True)
    before = round((len(padded) - len(cut)) / 2) if not causal else 1
    within = padded.si.horizontal.samples[before : before + len(cut)]
    np.testing.assert_allclose(within, cut.si.horizontal.samples, rtol=0.0, atol=1e-15)
    ends = {}
    for name, filtered in (("cut", cut), ("padded", padded)):
        path = velocity_and_displacement(filtered)
        ends[name] = [
            abs(float(values[-1])) / float(np.abs(values).max())
            for values in (path.ground_velocity, path.ground_displacement)
        ]
    assert max(ends["cut"]) > (0.02 if causal else 0.5)
    assert max(ends["padded"]) < 1e-4
    assert "padding kept: " in padded.history[-1]


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({}, ComponentError, "give low, high or both"),
        ({"low": "5 Hz", "high": "1 Hz"}, ComponentError, "must be below high"),
        ({"low": "5 Hz", "high": "5 Hz"}, ComponentError, "must be below high"),
        ({"high": "50 Hz"}, ComponentError, "below the Nyquist frequency, 50 Hz"),
        ({"low": "0 Hz"}, ComponentError, "low must be greater than zero"),
        ({"low": "1e-9 Hz"}, ComponentError, "too low"),
        ({"low": 1.0}, UnitsError, "low needs a cyclic frequency"),
        ({"high": "1 rad/s"}, UnitsError, "high needs a cyclic frequency"),
        ({"high": "5 Hz", "order": 0}, ComponentError, "order must be a whole number"),
        (
            {"high": "5 Hz", "order": 13},
            ComponentError,
            "order must be a whole number from 1 to 12",
        ),
        ({"high": "5 Hz", "order": 2.0}, ComponentError, "order must be a whole number"),
        ({"high": "5 Hz", "order": True}, ComponentError, "order must be a whole number"),
        ({"high": "5 Hz", "causal": 1}, ComponentError, "causal must be True or False, got 1"),
        ({"high": "5 Hz", "keep_padding": "y"}, ComponentError, "keep_padding must be True or"),
    ],
)
def test_filters_that_are_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        motion().filtered(**arguments)


@pytest.mark.parametrize(("order", "power"), [(0, 0), (1, 0), (1, 1), (2, 2), (5, 5)])
def test_baseline_correction_removes_its_polynomial(order, power):
    time = np.arange(400) * STEP
    assert motion(3.0 * time**power).baseline_corrected(order).si.peak < 1e-9
    plain = motion().baseline_corrected(order).si.horizontal.samples
    shifted = motion(NOISE + 7.0 * time**power).baseline_corrected(order).si.horizontal.samples
    assert shifted == pytest.approx(plain, abs=1e-9)


def test_baseline_correction_leaves_higher_powers():
    time = np.arange(400) * STEP
    assert motion(time**2).baseline_corrected(1).si.peak > 1.0


@pytest.mark.parametrize("order", [1, 2, 4])
def test_a_drift_of_the_velocity_is_removed(order):
    time = np.arange(401) * STEP
    drifting = motion(0.3 * time ** (order - 1) - 0.1)
    corrected = drifting.baseline_corrected(order, fit="velocity").si.horizontal.samples
    velocity = np.concatenate([[0.0], np.cumsum(corrected[1:] + corrected[:-1]) * 0.5 * STEP])
    assert np.abs(velocity).max() < 1e-12
    recorded = drifting.baseline_corrected(order, fit="velocity")
    assert recorded.history[-1].startswith("baseline corrected: slope of the polynomial of degree")


def test_velocity_fit_is_independent_of_added_drift():
    time = np.arange(401) * STEP
    clean = motion(np.sin(2.0 * np.pi * time))
    drifting = motion(np.sin(2.0 * np.pi * time) + 0.2 + 0.1 * time)
    one, other = (m.baseline_corrected(2, fit="velocity") for m in (clean, drifting))
    assert other.si.horizontal.samples == pytest.approx(one.si.horizontal.samples, abs=1e-12)
    # a fit of the acceleration leaves a velocity at the end
    left = drifting.baseline_corrected(1).si.horizontal.samples
    assert one.si.peak > 0.9
    assert left != pytest.approx(one.si.horizontal.samples, abs=1e-3)


@pytest.mark.parametrize(
    ("order", "fit", "words"),
    [
        (0, "velocity", "order must be a whole number from 1 to 20"),
        (1, "displacement", "fit must be 'acceleration' or 'velocity', got 'displacement'"),
    ],
)
def test_fits_that_are_refused(order, fit, words):
    with pytest.raises(ComponentError, match=words):
        motion().baseline_corrected(order, fit=fit)


@pytest.mark.parametrize("order", [-1, 21, 1.0, True, "1"])
def test_baseline_orders_that_are_refused(order):
    with pytest.raises(ComponentError, match="order must be a whole number from 0 to 20"):
        motion().baseline_corrected(order)


def test_baseline_order_is_below_the_number_of_samples():
    with pytest.raises(ComponentError, match="from 0 to 2"):
        motion(NOISE[:3]).baseline_corrected(3)


@pytest.mark.parametrize(("across", "up"), [(400, 400), (400, 300), (300, 400)])
def test_with_vertical_pads_the_shorter(across, up):
    other = motion(NOISE[::-1][:up])
    both = motion(NOISE[:across]).with_vertical(other)
    count = max(across, up)
    assert both.si.horizontal.samples.tolist() == [*NOISE[:across], *[0.0] * (count - across)]
    assert both.si.vertical.samples.tolist() == [*NOISE[::-1][:up], *[0.0] * (count - up)]
    padded = [sentence for sentence in both.history if "padded with 100 zeros" in sentence]
    assert len(padded) == (across != up)
    assert other.sha256[:12] in " ".join(both.history)


def test_with_vertical_of_another_step():
    with pytest.raises(ComponentError, match=r"0\.01 s and 0\.02 s; resample.*'0\.01 s'"):
        motion().with_vertical(motion(step=0.02))


@pytest.mark.parametrize(("off", "same"), [(1e-12, True), (1e-6, False)])
def test_time_steps_are_the_same_up_to_rounding(off, same):
    """An error of one millionth would be a tenth of a millisecond after 100 s."""
    other = motion(step=STEP * (1.0 + off))
    if same:
        assert motion().with_vertical(other).si.time_step == STEP
    else:
        with pytest.raises(ComponentError, match="time steps differ"):
            motion().with_vertical(other)


def test_with_vertical_preserves_metadata_of_vertical_component():
    record = motion()
    upwards = GroundMotion(record.si, name="up", metadata={"station": "A"}, history=record.history)
    assert motion().with_vertical(upwards).metadata["vertical_station"] == "A"


@pytest.mark.parametrize("other", [NOISE, 3, "vertical"])
def test_with_vertical_of_something_else(other):
    with pytest.raises(ComponentError, match="needs a GroundMotion"):
        motion().with_vertical(other)


def test_replaced_vertical_component_is_recorded_in_history():
    both = motion(vertical=NOISE).with_vertical(motion(-NOISE))
    assert "replaced" in both.history[-1]
    assert both.si.vertical.samples.tolist() == (-NOISE).tolist()


def test_pieces_survive_scaling_and_windows():
    pulse = GroundMotion.sine_pulse("1 m/s^2", "1 Hz", 2)
    part = pulse.scaled(3).window("0.25 s", "1.5 s")
    time = np.linspace(0.0, 1.25, 5001)
    assert part.si.at(time) == pytest.approx(3.0 * np.cos(2.0 * np.pi * time), abs=3e-12)


def test_window_after_a_pulse_is_still():
    """The pulse jumps at its end, where zeros follow."""
    pulse = GroundMotion.cosine_pulse("3 m/s^2", "1 Hz")
    longer = pulse.with_vertical(GroundMotion.cosine_pulse("1 m/s^2", "1 Hz", cycles=2))
    first, second = longer.window(end="1 s"), longer.window(start="1 s")
    assert first.si.horizontal.samples.tolist() == pulse.si.horizontal.samples.tolist()
    assert second.peak_acceleration.m == 0.0
    assert second.si.vertical.peak == pytest.approx(1.0)


def test_pieces_of_the_vertical_component_survive_scaling_and_windows():
    pulse = GroundMotion.sine_pulse("1 m/s^2", "1 Hz", 2)
    part = pulse.with_vertical(pulse.scaled(2)).scaled(3).window("0.25 s", "1.5 s")
    time = np.linspace(0.0, 1.25, 5001)
    assert part.si.vertical.at(time) == pytest.approx(6.0 * np.cos(2.0 * np.pi * time), abs=6e-12)


def test_recorded_vertical_of_analytic_pulse_is_refined_linearly():
    pulse = GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    count = len(pulse)
    both = pulse.with_vertical(motion(NOISE[:count], step=pulse.si.time_step))
    fine = both.resampled(f"{pulse.si.time_step / 3.0!r} s", interpolation="linear")
    assert fine.si.vertical.samples[::3] == pytest.approx(NOISE[:count], abs=1e-12)


def test_pieces_of_both_components_survive_with_vertical():
    pulse = GroundMotion.sine_pulse("1 m/s^2", "1 Hz", 1)
    other = GroundMotion.sine_pulse("2 m/s^2", "1 Hz", 1.25)
    both = pulse.with_vertical(other)
    time = np.linspace(0.0, 1.25, 5001)
    across = np.where(time <= 1.0, np.sin(2.0 * np.pi * time), 0.0)
    assert both.si.at(time) == pytest.approx(across, abs=1e-12)
    assert both.si.vertical.at(time) == pytest.approx(2.0 * np.sin(2.0 * np.pi * time), abs=2e-12)


def test_a_pulse_that_ends_abruptly_still_does_when_padded():
    abrupt = GroundMotion.sine_pulse("1 m/s^2", "1 Hz", 0.25)
    both = abrupt.with_vertical(GroundMotion.sine_pulse("1 m/s^2", "1 Hz", 1))
    dt = both.si.time_step
    assert both.si.horizontal.samples[32:34].tolist() == [1.0, 0.0]
    assert both.si.at([0.25 - 1e-9, 0.25 + 1e-9, 0.25 + dt, 0.5]) == pytest.approx(
        [1.0, 0.0, 0.0, 0.0], abs=1e-10
    )


@pytest.mark.parametrize(
    "step", ["refined", "coarsened", "tapered", "filtered", "causal", "baseline", "drift"]
)
def test_other_steps_replace_pieces_and_record_it_in_history(step):
    changed = ALL_STEPS[step](GroundMotion.sine_pulse("1 m/s^2", "1 Hz", 3))
    assert not changed.si.horizontal.analytic
    assert "straight lines" in changed.history[-1]


def test_replaced_vertical_pieces_are_recorded_in_history():
    both = motion().with_vertical(GroundMotion.sine_pulse().resampled(f"{STEP} s"))
    assert "straight lines" not in both.baseline_corrected().history[-1]
    pulse = GroundMotion.sine_pulse()
    both = motion(step=pulse.si.time_step).with_vertical(pulse)
    assert "straight lines" in both.baseline_corrected().history[-1]
