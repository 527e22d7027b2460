"""CSMIP volumes 1 and 2: layouts, channels, skipped and refused data."""

import numpy as np
import pytest
from unit.motion.dialect_samples import pairs
from unit.motion.format_samples import VALUES, csmip, csmip_channel
from unit.motion.motion_files import G

from rockframe.errors import RecordError
from rockframe.motion import GroundMotion


def read(write, text, name="r.V2", **options):
    return GroundMotion.read(write(text, name), **options)


def test_metadata_are_read_from_header(write):
    metadata = read(write, csmip(2), component="E").metadata
    assert metadata["event"] == "MADE UP EARTHQUAKE"
    assert metadata["event_time"] == "15 OCT 1979 - 2317 UTC"
    assert metadata["station"] == "12345"
    assert metadata["station_name"] == "SOMEWHERE - SOME BRIDGE"
    assert metadata["sensor_location"] == "FOOTING"
    assert metadata["channel"] == 3
    assert metadata["azimuth"] == 90.0
    assert metadata["unit_as_read"] == "cm/sec2"
    assert metadata["description"] == "corrected"


def test_volume_1_is_in_g_and_nine_wide(write):
    motion = read(write, csmip(1), "r.V1", component="N")
    np.testing.assert_allclose(
        motion.si.horizontal.samples, np.round(1e-3 * VALUES["N"], 6) * G, rtol=1e-13
    )
    assert motion.metadata["description"] == "uncorrected"


def test_unstated_layout_is_inferred_from_full_line(write):
    text = csmip(2).replace(" (8f10.3)", "").replace(", in cm/sec2.", ".  (UNITS: CM/SEC/SEC)")
    motion = read(write, text, component="N")
    np.testing.assert_allclose(motion.si.horizontal.samples, VALUES["N"] * 0.01, rtol=1e-13)
    assert motion.metadata["unit_as_read"] == "CM/SEC/SEC"


def test_incomplete_line_of_unstated_layout_is_refused(write):
    text = csmip_channel(1, 1e-3 * VALUES["N"], channel=1, name="N")
    lines = text.split("\n")
    place = next(k for k, line in enumerate(lines) if "POINTS OF ACCEL" in line)
    lines[place + 1] = lines[place + 1][:-1]
    with pytest.raises(RecordError, match=r"71 characters.*8 numbers of one width") as caught:
        read(write, "\n".join(lines), "r.V1")
    assert caught.value.line == place + 2


def test_velocities_and_displacements_are_skipped(write):
    motion = read(write, csmip(2), component="U")
    np.testing.assert_allclose(motion.si.horizontal.samples, VALUES["U"] * 0.01, rtol=1e-13)


def test_spectra_are_refused(write):
    text = "RESPONSE AND FOURIER AMPLITUDE SPECTRA\n" + csmip(2)
    with pytest.raises(RecordError, match=r"response spectra \(volume 3\)"):
        read(write, text, "r.V3")


def test_a_file_of_time_and_acceleration_pairs_is_refused(write):
    # the oldest volume 1 has pairs at uneven times and no line that states equal steps
    text = "UNCORRECTED ACCELEROGRAM DATA\nMADE UP\n" + "  .0000  .0012  .0210 -.0021\n" * 9
    with pytest.raises(RecordError, match="no evenly sampled accelerations"):
        read(write, text, "r.V1")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("equally spaced at .010 sec", "equally spaced at .000 sec", "time step of 0.0 s"),
        ("equally spaced at .010 sec", "equally spaced at .0.1 sec", "an interval of '.0.1' s"),
        ("INTERVALS OF    .010", "INTERVALS OF    .020", r"0\.01 s and, in line \d+, of 0\.02 s"),
        ("in cm/sec2.", "in furlongs.", "unknown unit 'furlongs'"),
        ("in cm/sec2.", "in cm/sec.", "a velocity in cm/sec"),
        (" 61 points of accel", " 99999999 points of accel", "99999999 or more numbers"),
        (" 61 points of accel", " 0 points of accel", "0 samples announced"),
        (" 61 points of accel", " 70 points of accel", "characters"),
        ("(8f10.3)", "(0f0.0)", "a layout of 0 numbers"),
    ],
)
def test_headers_that_are_refused(write, old, new, words):
    text = csmip_channel(2, VALUES["N"], channel=1, name="360 DEG")
    assert old in text
    with pytest.raises(RecordError, match=words) as caught:
        read(write, text.replace(old, new, 1))
    assert caught.value.line is not None


def test_missing_unit_can_be_passed_as_argument(write):
    text = csmip(1).replace("(UNITS: G)", "")
    with pytest.raises(RecordError, match="no unit"):
        read(write, text, "r.V1", component="N")
    assert read(write, text, "r.V1", component="N", unit="g").si.peak > 0.0


def test_smc_header_is_not_read_as_csmip(write):
    with pytest.raises(RecordError, match=r"number of comment lines \(integer 16\)"):
        read(write, "2 CORRECTED ACCELEROGRAM   CHAN\n" + csmip(2))


@pytest.mark.parametrize("channel", [1, 2, 3])
def test_channel_without_data_announcement_is_not_skipped(write, channel):
    parts = csmip(1).split("UNCORRECTED")
    parts[channel] = parts[channel].replace("POINTS OF ACCEL", "POINTS")
    text = "UNCORRECTED".join(parts)
    other = {1: "E", 2: "N", 3: "N"}[channel]
    assert read(write, text, "r.V1", component=other).si.peak > 0.0
    with pytest.raises(RecordError, match="found 3 components"):
        read(write, text, "r.V1")
    with pytest.raises(RecordError, match="no evenly sampled accelerations below"):
        read(write, text, "r.V1", component=f"channel {channel}")


def test_channel_of_pairs_without_count_is_not_skipped(write):
    text = pairs().replace("NO. OF POINTS =", "NO. OF", 1)
    with pytest.raises(RecordError, match="found 3 components"):
        read(write, text, "r.v1")
    with pytest.raises(RecordError, match="no evenly sampled accelerations below"):
        read(write, text, "r.v1", component="channel 1")


def test_too_many_channels_are_refused(write):
    text = csmip_channel(1, [0.01] * 8, channel=1, name="N")
    with pytest.raises(RecordError, match="at most 500 channels"):
        read(write, text * 501, "r.V1")
