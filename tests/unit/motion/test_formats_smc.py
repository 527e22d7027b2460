"""USGS SMC: only evenly sampled accelerograms are read."""

import numpy as np
import pytest
from unit.motion.format_samples import VALUES, smc

from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion

NORTH = VALUES["N"]


def read(write, text, **options):
    return GroundMotion.read(write(text, "r.smc"), **options)


def test_metadata_are_read_from_header(write):
    metadata = read(write, smc()).metadata
    assert metadata["event"] == "Made Up, CA"
    assert metadata["event_time"] == "1989-10-18T00:04"
    assert metadata["station"] == "MADE"
    assert metadata["station_name"] == "Some Place, 1295 Street, F"
    assert (metadata["component"], metadata["azimuth"]) == ("360", 360.0)
    assert metadata["unit_as_read"] == "cm/sec/sec"


@pytest.mark.parametrize("kind", ["1 UNCORRECTED ACCELEROGRAM", "2 CORRECTED ACCELEROGRAM   "])
@pytest.mark.parametrize("rate", [50.0, 100.0, 200.0])
def test_accelerograms(write, kind, rate):
    motion = read(write, smc(kind=kind, rate=rate))
    np.testing.assert_allclose(motion.si.horizontal.samples, NORTH * 0.01, rtol=1e-13)
    assert motion.si.time_step == 1.0 / rate


@pytest.mark.parametrize(
    "kind",
    ["3 VELOCITY", "4 DISPLACEMENT", "5 RESPONSE SPECTRA", "6 FOURIER AMPLITUDE"],
)
@pytest.mark.parametrize("arguments", [{}, {"unit": "g"}, {"format": "smc"}])
def test_other_quantities_are_refused(write, kind, arguments):
    with pytest.raises(RecordError, match="no accelerogram; expected an acceleration") as caught:
        read(write, smc(kind=kind), **arguments)
    assert caught.value.line == 1


def test_unknown_quantity_is_read_as_accelerogram_with_warning(write):
    with pytest.warns(RecordWarning, match="line 1: the file does not state its quantity"):
        motion = read(write, smc(kind="0 UNKNOWN"))
    np.testing.assert_allclose(motion.si.horizontal.samples, NORTH * 0.01, rtol=1e-13)


@pytest.mark.filterwarnings("ignore:.*lie around an offset")
def test_numbers_without_a_blank_between_them(write):
    # as in the files: "-2.2223E+0-1.9234E+0"
    printed = [
        f"{mantissa:7.4f}E+0" for mantissa in np.where(NORTH < 0.0, -9.5, -2.5) + 0.001 * NORTH
    ]
    assert {len(text) for text in printed} == {10}
    lines = ["".join(printed[k : k + 8]) for k in range(0, len(printed), 8)]
    head = smc().split("|made up\n")[0] + "|made up\n" * 2
    motion = read(write, head + "\n".join(lines) + "\n")
    expected = np.array([float(text) for text in printed]) * 0.01
    np.testing.assert_allclose(motion.si.horizontal.samples, expected, rtol=1e-13)


def test_no_sampling_rate_means_uneven_times_and_is_refused(write):
    with pytest.raises(RecordError, match=r"no sampling rate.*unevenly sampled") as caught:
        read(write, smc(kind="1 UNCORRECTED ACCELEROGRAM", rate=1.7e38))
    assert caught.value.line == 18


@pytest.mark.parametrize("rate", [0.0, -100.0, 2e5, 1e30])
def test_absurd_sampling_rates_are_refused(write, rate):
    with pytest.raises(RecordError, match="a sampling rate of") as caught:
        read(write, smc(rate=rate))
    assert caught.value.line == 18


@pytest.mark.parametrize(
    ("name", "slope", "azimuth", "component", "direction"),
    [
        ("045", 90, 45, "045", 45.0),
        ("045", 0, 0, "045", 45.0),  # the text takes precedence over the integers
        ("", 90, 225, "225", 225.0),
        ("T", 90, 225, "T", 225.0),
        ("T", -32768, -32768, "T", None),
        ("T", 90, -32768, "T", None),
    ],
)
def test_horizontal_directions(write, name, slope, azimuth, component, direction):
    metadata = read(write, smc(name=name, slope=slope, azimuth=azimuth)).metadata
    assert (metadata["component"], metadata.get("azimuth")) == (component, direction)


@pytest.mark.parametrize(
    ("name", "slope", "sign"), [("UP", 0, 1.0), ("", 0, 1.0), ("DOWN", 180, -1.0), ("", 180, -1.0)]
)
def test_vertical_directions(write, name, slope, sign):
    text = smc(name=name, slope=slope, azimuth=-32768)
    with pytest.warns(RecordWarning, match="is vertical"):
        read(write, text)
    upwards = read(write, text, component="Z").si.horizontal.samples
    np.testing.assert_allclose(upwards, sign * 0.01 * NORTH, rtol=1e-13)


@pytest.mark.parametrize("comments", [0, 1, 7])
def test_comments_are_skipped(write, comments):
    assert len(read(write, smc(comments=comments))) == NORTH.size


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (smc().replace("|made up\n", "made up\n", 1), "begins with '|'"),
        (smc(count=70), "the end of the file after"),
        (smc(count=60), "characters"),
        (smc(count=999999999), "999999999 or more"),
        (smc(count=-5), "-5 samples announced"),
        (smc()[:1500], "2 comment lines announced in a file of 27 lines"),
        (smc()[:500], "a file of 14 lines"),
        (smc()[:-8], "characters"),
    ],
)
def test_files_that_are_refused(write, text, words):
    with pytest.raises(RecordError, match=words) as caught:
        read(write, text)
    assert caught.value.line is not None


@pytest.mark.parametrize("announced", [999999999, -3])
def test_absurd_numbers_of_comments_are_refused(write, announced):
    text = smc(comments=2)
    place = text.split("\n")[12]
    changed = place[:70] + f"{announced:10d}"
    with pytest.raises(RecordError, match="comment lines announced"):
        read(write, text.replace(place, changed))


def test_a_problem_that_the_file_marks_is_warned_about(write):
    with pytest.warns(RecordWarning, match="marks a problem"):
        read(write, smc(problem=1))
