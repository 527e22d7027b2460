"""Metadata of a file are compared with its data; contradictions warn."""

import re

import numpy as np
import pytest
from unit.motion import dialect_samples as dialects
from unit.motion import format_samples as formats
from unit.motion.dialect_samples import VALUES, peak

from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion

COSMOS = formats.cosmos_block("acceleration", VALUES["E"])
REAL_64 = re.compile(r"(?<=Format= \(5F15\.6\)\n)((?:.*\n){12})(.{45})(.{15})")


def cosmos(stated: float) -> str:
    """A COSMOS file with a peak in real 64, the fourth of the thirteenth line."""
    return REAL_64.sub(lambda m: f"{m.group(1)}{m.group(2)}{stated:15.6f}", COSMOS)


def smc(stated: float) -> str:
    """An SMC file with peaks in reals 30 and 32."""
    lines = formats.smc(VALUES["E"]).split("\n")
    for line, field in ((22, 4), (23, 1)):
        start = 15 * field
        lines[line] = f"{lines[line][:start]}{stated:15.7E}{lines[line][start + 15 :]}"
    return "\n".join(lines)


def geonet(stated: float) -> str:
    values = np.round(10.0 * VALUES["E"], 1)
    return formats.geonet_component(values, name="S74E", azimuth=106, peak=10.0 * stated)


# for every format that states a peak: a file with that peak, and reading arguments
STATED = {
    "cosmos": (cosmos, {}),
    "csmip": (lambda stated: dialects.usc(stated=stated), {}),
    "smc": (smc, {}),
    "esm": (lambda stated: formats.esm(**{"PGA_CM/S^2": f"{-stated:.6f}"}), {}),
    "itaca": (lambda stated: dialects.itaca(**{"PGA_CM/S^2": f"{stated:.6f}"}), {}),
    "geonet": (geonet, {}),
    "cwa": (
        lambda stated: formats.cwa().replace(
            "#DataSequence", f"#AmplitudeMAX. E: 0.0~ {-stated:.3f}\n#DataSequence"
        ),
        {"component": "E"},
    ),
    "afad": (
        lambda stated: dialects.afad(**{"RAW PGA VALUES (gal)": f"(E-W) {stated:.6f}"}),
        {"component": "E"},
    ),
    "csmnc": (
        lambda stated: re.sub(r"PEAK VALUE: *\S+", f"PEAK VALUE: {stated:.3f}", dialects.csmnc()),
        {},
    ),
    "unam": (
        lambda stated: re.sub(
            r"(Gal\), C1-C6 *: /.*?/).*?/", rf"\g<1>{-stated:.3f}/", dialects.unam()
        ),
        {"component": "E"},
    ),
    "text": (
        lambda stated: (
            f"# PGA = {stated:.3f} cm/s^2, dt = 0.01 s, unit: gal\n"
            + "".join(f"{value:.3f}\n" for value in VALUES["E"])
        ),
        {},
    ),
}


@pytest.mark.parametrize("key", STATED)
def test_contradicting_stated_peak_warns(key, write):
    text, arguments = STATED[key]
    truth = peak(VALUES["E"])
    for share in (1.0, 1.005, 0.995):
        GroundMotion.read(write(text(share * truth), "record"), **arguments)
    for share in (1.05, 0.95, 0.1, 9.81):
        path = write(text(share * truth), "record")
        with pytest.warns(RecordWarning, match=r"line \d+: the header states a peak of") as caught:
            motion = GroundMotion.read(path, **arguments)
        assert len(caught) == 1
        line = int(re.search(r"line (\d+)", str(caught[0].message)).group(1))
        stated = re.search(r"a peak of (\S+)", str(caught[0].message)).group(1)
        digits = re.sub(r"[^0-9]", "", stated)[:3]
        assert digits in re.sub(r"[^0-9]", "", path.read_text().split("\n")[line - 1])
        assert motion.si.peak == pytest.approx(0.01 * truth, rel=1e-3)


def test_zero_or_non_numeric_stated_peak_is_ignored(write):
    for printed in ("0.0", "", "unknown", "1e999"):
        GroundMotion.read(write(formats.esm(**{"PGA_CM/S^2": printed}), "r.ASC"))


@pytest.mark.parametrize(
    ("text", "arguments"),
    [
        (formats.esm(DURATION_S="1.2"), {}),
        (dialects.pairs().replace("RECORD LENGTH =  0.600", "RECORD LENGTH =  1.200"), {}),
        (dialects.csmnc().replace("DURATION:  0.61", "DURATION:  1.2"), {}),
        (dialects.unam().replace("/0.61/0.61/0.61", "/1.2/1.2/1.2"), {"component": "E"}),
        (formats.geonet().replace("Duration 1.2 sec", "Duration 2.4 sec"), {"component": "S74E"}),
    ],
    ids=["esm", "csmip", "csmnc", "unam", "geonet"],
)
def test_contradicting_stated_length_warns(text, arguments, write):
    component_arguments = {"component": "EW"} if "RENADIC" in text or "G/10" in text else arguments
    with pytest.warns(RecordWarning, match=r"line \d+: the header states a length of"):
        GroundMotion.read(write(text, "record"), **component_arguments)


@pytest.mark.parametrize(
    ("text", "mark", "arguments"),
    [
        (dialects.cgs(), "/&", {"component": "360"}),
        (COSMOS, "End-of-data", {}),
        (formats.smc(), None, {}),
        (dialects.pairs(), "/&", {"component": "EW"}),
        (dialects.bhrc(), "/&", {"component": "L1"}),
        (dialects.resorce(), None, {}),
    ],
    ids=["csmip", "cosmos", "smc", "pairs", "bhrc", "resorce"],
)
def test_rows_after_announced_samples_are_ignored_with_warning(text, mark, arguments, write):
    own = GroundMotion.read(write(text, "record"), **arguments)
    lines = text.rstrip("\n").split("\n")
    end = next((k for k, line in enumerate(lines) if mark and line.startswith(mark)), len(lines))
    # the last full row of the samples, once more and twice
    extra = [lines[end - 2]] * 2
    path = write("\n".join([*lines[:end], *extra, *lines[end:]]) + "\n", "record")
    with pytest.warns(RecordWarning, match=rf"line {end + 1}: 2 rows of numbers after"):
        assert GroundMotion.read(path, **arguments).sha256 == own.sha256


@pytest.mark.parametrize(
    "text", [formats.smc() * 2, dialects.resorce() * 2], ids=["smc", "resorce"]
)
def test_second_record_in_file_is_ignored_with_warning(text, write):
    with pytest.warns(RecordWarning, match="rows of numbers after the last sample"):
        GroundMotion.read(write(text, "record"))


@pytest.mark.parametrize(
    ("text", "mark", "words"),
    [
        (formats.cosmos(), "(Format v", "acceleration pts.*the second in this block"),
        (dialects.bhrc(), "* VOL", "'COMP T3', the second below one first line"),
    ],
    ids=["cosmos", "bhrc"],
)
def test_component_with_damaged_first_line_is_not_skipped(text, mark, words, write):
    before, _, after = text.rpartition(mark)
    with pytest.raises(RecordError, match=words):
        GroundMotion.read(write(before + after, "record"))


@pytest.mark.parametrize(
    ("text", "rows"),
    [(formats.cosmos(), -1), (formats.cosmos(), 5), (formats.csmip(2), 0), (formats.csmip(2), 5)],
)
def test_file_truncated_inside_velocities_warns(text, rows, write):
    lines = text.split("\n")
    announced = [k for k, line in enumerate(lines) if "velocity pts" in line or "of vel" in line]
    path = write("\n".join([*lines[: announced[0] + 1 + rows], ""]), "record")
    with pytest.warns(RecordWarning, match="the file ends inside what line .* announces"):
        GroundMotion.read(path)


def column(values, unit="gal") -> str:
    return f"# unit: {unit}, dt = 0.01 s\n" + "".join(f"{value:.6f}\n" for value in values)


RANDOM = np.random.default_rng(3)
SHAKING = 200.0 * np.exp(-(((np.arange(2000) - 700.0) / 300.0) ** 2)) * RANDOM.standard_normal(2000)


@pytest.mark.parametrize("mark", [-999.0, 9999.0, -99999.0, -12345.0, -999999.0, -999.9, 9999.99])
@pytest.mark.parametrize("places", [[400], [0], [1999], [50, 51, 52], [10, 900]])
def test_marks_of_missing_samples_are_refused(write, mark, places):
    values = 0.5 * SHAKING
    values[places] = mark
    with pytest.raises(RecordError, match=rf"{mark:.9g} as sample {places[0] + 1}, alone"):
        GroundMotion.read(write(column(values), "r.txt"))


def test_missing_sample_marker_among_similar_values_is_accepted(write):
    values = 900.0 * np.sin(0.3 * np.arange(500))
    values[100:103] = (990.0, 999.0, 980.0)
    GroundMotion.read(write(column(values), "r.txt"))


@pytest.mark.parametrize("offset", [0.3, -0.3, 0.1])
def test_a_constant_offset_is_mentioned(write, offset):
    path = write(column(SHAKING / 980.665 + offset, "g"), "r.txt")
    with pytest.warns(RecordWarning, match="lie around an offset of") as caught:
        motion = GroundMotion.read(path)
    reported = float(re.search(r"offset of (\S+) g", str(caught[0].message)).group(1))
    assert reported == pytest.approx(offset, abs=0.01)
    assert abs(motion.baseline_corrected(order=0).si.horizontal.samples.mean()) < 1e-9
    GroundMotion.read(write(column(SHAKING / 980.665, "g"), "r.txt"))


def test_metres_mistaken_for_g_warn_above_0_15_g(write):
    shaking = SHAKING / np.abs(SHAKING).max()
    for peak_in_g in (0.16, 0.3, 0.5, 1.0):
        path = write(column(9.80665 * peak_in_g * shaking, "g"), "r.txt")
        with pytest.warns(RecordWarning, match="is the unit g_0 right"):
            GroundMotion.read(path)
    GroundMotion.read(write(column(1.4 * shaking, "g"), "r.txt"))
