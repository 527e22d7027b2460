"""Metadata of a motion stay true after each operation: azimuth, start time, misfit."""

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import ComponentError, RecordWarning
from rockframe.motion import GroundMotion
from rockframe.motion.display import motion_words

RNG = np.random.default_rng(7)
NORTH, EAST = RNG.normal(size=(2, 400)) * np.sin(np.pi * np.arange(400) / 399.0)
STEP = 0.01
START = "2020-02-03T04:05:06"


def motion(values, name="one", **metadata):
    record = GroundMotion.from_arrays((values, "m/s^2"), f"{STEP} s")
    return GroundMotion(record.si, name=name, metadata=metadata)


@pytest.mark.parametrize(("own", "theirs", "sign"), [(0, 90, 1), (90, 0, -1), (360, 270, -1)])
def test_rotation_updates_azimuth(own, theirs, sign):
    one, other = motion(NORTH, azimuth=own), motion(EAST, azimuth=theirs)
    turned = one.rotated(other, "30 deg")
    assert turned.metadata["azimuth"] == pytest.approx((own + sign * 30.0) % 360.0)
    axes = rf.HorizontalPair(one, other).in_axes("30 deg")
    azimuths = [component.metadata["azimuth"] for component in (axes.first, axes.second)]
    assert azimuths == pytest.approx(
        [(component + sign * 30.0) % 360.0 for component in (own, theirs)]
    )
    back = axes.rotated(azimuth=f"{own} deg").si.horizontal.samples
    assert back == pytest.approx(NORTH, abs=1e-13)


def test_rotation_drops_unknown_azimuth():
    assert "azimuth" not in motion(NORTH, azimuth=0).rotated(motion(EAST), "30 deg").metadata


def test_rotation_of_non_orthogonal_components_by_angle_is_refused():
    with pytest.raises(ComponentError, match="are not at a right angle"):
        motion(NORTH, azimuth=0).rotated(motion(EAST, azimuth=45), "30 deg")


def test_negative_scaling_reverses_azimuth():
    southwards = motion(NORTH, azimuth=0).scaled(-2)
    assert southwards.metadata["azimuth"] == 180.0
    pair = rf.HorizontalPair(southwards, motion(EAST, azimuth=90))
    north_east = pair.rotated(azimuth="45 deg").si.horizontal.samples
    assert north_east == pytest.approx((2.0 * NORTH + EAST) / np.sqrt(2.0), abs=1e-13)


@pytest.mark.parametrize("factor", [0.5, 3.0])
def test_positive_scaling_keeps_directions(factor):
    own = {"azimuth": 30.0, "component": "N30E", "positive": "up"}
    found = motion(NORTH, **own).scaled(factor).metadata
    assert {name: found[name] for name in own} == own
    back = motion(NORTH, **own).scaled(-factor).metadata
    assert (back["azimuth"], back["component"], back["positive"]) == (210.0, "-N30E", "down")


@pytest.mark.parametrize(
    ("start", "later"),
    [
        (START, "2020-02-03T04:05:07.500000"),
        ("2020-02-03T04:05:06.000Z", "2020-02-03T04:05:07.500000Z"),
        ("2020-02-03T04:05:06+00:00", "2020-02-03T04:05:07.500000+00:00"),
        ("2020/02/03 04:05:06 (GMT+08)", "2020/02/03 04:05:06 (GMT+08), plus 1.5 s"),
        ("2020/02/03 04:05:06 JST, less 15 s", "2020/02/03 04:05:06 JST, less 13.5 s"),
    ],
)
def test_a_window_starts_later(start, later):
    whole = motion(NORTH, record_time=start, vertical_record_time=start)
    part = whole.window("1.5 s", "3 s")
    assert part.metadata.get("record_time") == later
    assert part.metadata.get("vertical_record_time") == later
    assert whole.window(None, "3 s").metadata["record_time"] == start


def test_pair_with_different_start_times_is_refused():
    one, other = motion(NORTH, record_time=START), motion(EAST, record_time=START)
    with pytest.raises(ComponentError, match="first starts at 2020-02-03T04:05:08, second at"):
        rf.HorizontalPair(one.window("2 s"), other)
    assert rf.HorizontalPair(one.window("2 s"), other.window("2 s")).first.duration.m == 1.99


@pytest.mark.parametrize("start", ["2020/02/03 04:05:06 (GMT+08)", "4 h 5 min"])
def test_start_times_in_any_format_are_compared_after_windows(start):
    one, other = motion(NORTH, record_time=start), motion(EAST, record_time=start)
    twice = one.window("0.3 s").window("1.7 s")
    assert twice.metadata["record_time"] == f"{start}, plus 2 s"
    assert rf.HorizontalPair(twice, other.window("2 s")).first.duration.m == 1.99
    with pytest.raises(ComponentError, match=r"first starts at .*, plus 2 s, second at"):
        rf.HorizontalPair(twice, other)
    cut = one.window("3 s").filtered(low="2 Hz", keep_padding=True)
    assert cut.metadata["record_time"] == start


def test_window_shifts_start_on_file_time_axis():
    whole = motion(NORTH, start_time=0.05, vertical_start_time=0.05)
    part = whole.window("1.5 s").metadata
    assert part["start_time"] == part["vertical_start_time"] == pytest.approx(1.55)


def test_filter_padding_shifts_start_time_back():
    filtered = motion(NORTH, record_time=START).filtered(low="2 Hz", keep_padding=True)
    assert len(filtered) == 400 + 2 * 300
    assert filtered.metadata["record_time"] == "2020-02-03T04:05:03"
    cut = motion(NORTH, record_time=START).filtered(low="2 Hz")
    assert cut.metadata["record_time"] == START


def test_velocity_pulse_motions_start_earlier_by_lead():
    pulse = GroundMotion.mavroeidis_papageorgiou_pulse("80 cm/s", "0.5 Hz", 2.2, "0 deg")
    record = GroundMotion(pulse.si, metadata={"record_time": START})
    result = record.velocity_pulse()
    lead = np.timedelta64(round(float(result.lead.m_as("us"))), "us")
    assert lead > np.timedelta64(0, "us")
    for part in (result.extracted, result.residual):
        assert np.datetime64(START) - np.datetime64(part.metadata["record_time"]) == lead


def test_joining_motions_with_different_start_times_warns():
    one, other = motion(NORTH, "a", record_time=START), motion(EAST, "b", record_time=START)
    for join in (one.with_vertical, lambda late: one.rotated(late, "10 deg")):
        join(other)
        with pytest.warns(RecordWarning, match=r"a starts at .*:06, b at .*:07; their first"):
            join(other.window("1 s"))


def test_scale_factors_accumulate():
    once = motion(NORTH).scaled(2.0)
    assert once.metadata["scale_factor"] == 2.0
    assert once.scaled(peak="1 g_0").scaled(-3.0).metadata["scale_factor"] == pytest.approx(
        -3.0 * 9.80665 / np.abs(NORTH).max()
    )
    target = rf.TargetSpectrum.eurocode_8("0.2 g_0")
    scaled = rf.MotionSuite({"a": once}).scaled_to(target, bounds=None)["a"]
    factor = scaled.metadata["scale_factor"]
    assert scaled.si.horizontal.samples == pytest.approx(factor * NORTH)


def test_metadata_of_vertical_component_are_replaced_with_it():
    first = motion(EAST, station="first", component="U")
    both = motion(NORTH, station="here").with_vertical(first)
    assert both.metadata["vertical_station"] == "first"
    other = both.with_vertical(motion(EAST, component="Z"))
    assert dict(other.metadata) == {"station": "here", "vertical_component": "Z"}
    for alone in (
        both.with_vertical(None),
        both.through_storeys(periods=["0.5 s"], vertical="omitted"),
        both.velocity_pulse().extracted,
    ):
        assert alone.si.vertical is None
        assert dict(alone.metadata) == {"station": "here"}
    assert both.velocity_pulse().residual.metadata["vertical_station"] == "first"


def test_rotating_differently_scaled_components_drops_scale_factor():
    once, twice = motion(NORTH).scaled(2.0), motion(EAST).scaled(4.0)
    assert "scale_factor" not in once.rotated(twice, "30 deg").metadata
    assert "scale_factor" not in once.rotated(motion(EAST), "30 deg").metadata
    # a sign is that of the component
    assert once.rotated(motion(EAST).scaled(-2), "30 deg").metadata["scale_factor"] == 2.0
    axes = rf.HorizontalPair(once, motion(EAST).scaled(2.0)).in_axes("30 deg")
    assert [component.metadata["scale_factor"] for component in (axes.first, axes.second)] == [
        2.0,
        2.0,
    ]
    plain = rf.HorizontalPair(motion(NORTH), motion(EAST)).in_axes("30 deg")
    assert "scale_factor" not in plain.second.metadata


@pytest.mark.parametrize(
    ("join", "across", "upwards"),
    [
        (lambda one, other: one.scaled(2).with_vertical(other), 2.0, None),
        (lambda one, other: one.with_vertical(other).scaled(2), 2.0, 2.0),
        (lambda one, other: one.with_vertical(other).scaled(2).scaled(-3), -6.0, -6.0),
        (lambda one, other: one.scaled(2).with_vertical(other).scaled(3), 6.0, 3.0),
        (lambda one, other: one.with_vertical(other.scaled(5)).scaled(3), 3.0, 15.0),
        (lambda one, other: one.scaled(2).with_vertical(other.scaled(5)).scaled(3), 6.0, 15.0),
        (lambda one, other: one.with_vertical(other.scaled(5)).with_vertical(other), None, None),
        (lambda one, other: one.with_vertical(other).scaled(2).with_vertical(None), 2.0, None),
        (lambda one, other: one.with_vertical(other.with_vertical(one.scaled(7))), None, None),
    ],
)
def test_scale_factors_accumulate_per_component(join, across, upwards):
    result = join(motion(NORTH), motion(EAST))
    assert result.metadata.get("scale_factor") == across
    assert result.si.horizontal.samples == pytest.approx((across or 1.0) * NORTH)
    assert result.metadata.get("vertical_scale_factor") == upwards
    if result.si.vertical is not None:
        assert result.si.vertical.samples == pytest.approx((upwards or 1.0) * EAST)
    assert not any(name.startswith("vertical_vertical") for name in result.metadata)


def test_the_misfit_of_a_scaled_vertical_component_is_dropped():
    both = motion(NORTH).with_vertical(motion(EAST, spectral_misfit=0.1))
    assert both.metadata["vertical_spectral_misfit"] == 0.1
    assert "vertical_spectral_misfit" not in both.scaled(2).metadata
    assert both.scaled(-1).metadata["vertical_spectral_misfit"] == 0.1


def test_history_states_what_was_done_to_another_component():
    changed = motion(EAST, name="other").filtered(high="20 Hz").scaled(0.5)
    digest = changed.sha256[:12]
    both = motion(NORTH).with_vertical(changed)
    assert both.history == (f"vertical component 0.5 times other, filtered (sha256 {digest})",)
    turned = motion(NORTH).rotated(changed, "30 deg").history[-1]
    assert turned == f"rotated by 30° towards 0.5 times other, filtered (sha256 {digest})"


@pytest.mark.parametrize(
    ("component", "metadata"), [("N", {"azimuth": 0.0}), ("DWN", {"positive": "down"})]
)
def test_mirrored_component_is_not_read_as_original(tmp_path, component, metadata):
    before = motion(NORTH, component=component, **metadata)
    mirrored = before.scaled(-1)
    assert mirrored.metadata["component"] == f"-{component}"
    assert mirrored.scaled(-2).metadata["component"] == component
    mirrored.to_at2(tmp_path / "mirrored.AT2")
    read = rf.GroundMotion.read(tmp_path / "mirrored.AT2", component=f"-{component}")
    assert read.si.horizontal.samples == pytest.approx(-NORTH, rel=1e-6, abs=1e-12)
    assert read.metadata.get("azimuth") != 0.0
    assert read.metadata.get("positive") != "down"


def test_only_steps_that_change_spectrum_drop_misfit():
    target = rf.TargetSpectrum.eurocode_8("0.2 g_0")
    scaled = rf.MotionSuite({"a": motion(NORTH)}).scaled_to(target, bounds=None)["a"]
    factor = scaled.metadata["scale_factor"]
    doubled = scaled.scaled(-2)
    assert doubled.metadata["scale_factor"] == pytest.approx(-2.0 * factor)
    assert doubled.si.horizontal.samples == pytest.approx(-2.0 * factor * NORTH)
    assert "spectral_misfit" not in doubled.metadata
    for changed in (
        scaled.filtered(low="1 Hz"),
        scaled.window("1 s"),
        scaled.baseline_corrected(),
        scaled.through_storeys(periods=["0.5 s"], time_step="0.01 s"),
        scaled.resampled("0.02 s"),
        scaled.resampled("0.005 s"),
        scaled.resampled("0.007 s", interpolation="linear"),
    ):
        assert "spectral_misfit" not in changed.metadata
        assert changed.metadata["scale_factor"] == factor
    lines = scaled.resampled("0.005 s", interpolation="linear")
    for same in (scaled.scaled(-1), lines, scaled.with_vertical(scaled)):
        assert same.metadata["spectral_misfit"] == scaled.metadata["spectral_misfit"]


@pytest.mark.parametrize(
    ("process", "name"),
    [
        (lambda m: m, "one"),
        (lambda m: m.scaled(0.5), "0.5 times one"),
        (lambda m: m.filtered(low="1 Hz").scaled(0.5), "0.5 times one, filtered"),
        (lambda m: m.window("1 s", taper="0.1 s").window("0.5 s"), "one, cut, tapered"),
        (lambda m: m.resampled("0.005 s").baseline_corrected(),
         "one, resampled, baseline corrected"),
        (lambda m: m.resampled("0.01 s"), "one"),
        (lambda m: m.rotated(motion(EAST), "30 deg"), "one, rotated"),
        (lambda m: m.with_vertical(m), "one"),
        (lambda m: m.through_storeys(periods=["0.5 s"], time_step="0.01 s"), "one, at a floor"),
        (lambda m: m.through_storeys(storeys=3, floor=2, period="0.5 s", time_step="0.01 s"),
         "one, at floor 2"),
        (lambda m: m.matched(rf.TargetSpectrum.eurocode_8("0.2 g_0"),
                                 periods=("0.1 s", "0.5 s"), tolerance=0.3), "one, matched"),
        (lambda m: m.velocity_pulse().extracted, "one, the pulse alone"),
        (lambda m: m.velocity_pulse().residual, "one, the pulse taken out"),
    ],
)  # fmt: skip
def test_title_and_labels_name_processing_steps(process, name):
    processed = process(motion(NORTH))
    system = rf.System(rf.Block(width="2 m", height="4 m", mass="2 t"))
    run = system.simulate(processed, duration="0.1 s", outputs=None)
    assert motion_words(run.attrs) == name
    assert rf.plot.motion(processed).figure.get_suptitle() == name
