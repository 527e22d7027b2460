"""Properties required of every format."""

import hashlib
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from unit.motion.binary_samples import BINARY
from unit.motion.format_samples import SAMPLES

from rockframe.errors import RecordError
from rockframe.motion import GroundMotion, formats

KNOWN = [entry.name for entry in formats()]


@pytest.fixture(params=SAMPLES)
def sample(request):
    return SAMPLES[request.param]


def test_sample_file_is_recognised_and_read(sample, tmp_path):
    motion = GroundMotion.read(sample.write(tmp_path), component=sample.component)
    assert motion.metadata["format"] == sample.format
    assert motion.si.time_step == sample.time_step
    np.testing.assert_allclose(motion.si.horizontal.samples, sample.samples, rtol=1e-12, atol=1e-12)
    assert motion.metadata.get("component") == sample.named
    assert motion.name == Path(sample.name).stem


def test_format_is_recognised_regardless_of_file_name(sample, tmp_path):
    path = tmp_path / "record"
    path.write_bytes(sample.data)
    assert GroundMotion.read(path, component=sample.component).metadata["format"] == sample.format


def test_metadata_describe_source(sample, tmp_path):
    path = sample.write(tmp_path)
    motion = GroundMotion.read(path, component=sample.component)
    assert motion.metadata["source_file"] == sample.name
    assert motion.metadata["source_sha256"] == hashlib.sha256(sample.data).hexdigest()
    assert motion.metadata["unit_as_read"]
    assert motion.history[0].startswith(f"read {sample.name} (")
    if sample.format not in {"text", "peer-at2"}:
        assert motion.metadata["event"]
        assert motion.metadata["station"]


def test_naming_its_format_changes_nothing(sample, tmp_path):
    path = sample.write(tmp_path)
    named = GroundMotion.read(path, format=sample.format, component=sample.component)
    assert named == GroundMotion.read(path, component=sample.component)


@pytest.mark.parametrize("change", [b"\r\n", b"\r", b"\xef\xbb\xbf"])
def test_line_ends_and_byte_order_marks_do_not_matter(sample, change, tmp_path):
    changed = sample.data.replace(b"\n", change) if b"\r" in change else change + sample.data
    path = tmp_path / sample.name
    path.write_bytes(changed)
    motion = GroundMotion.read(path, component=sample.component)
    np.testing.assert_allclose(motion.si.horizontal.samples, sample.samples, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    ("key", "other"),
    [(key, other) for key, one in SAMPLES.items() for other in KNOWN if other != one.format],
)
def test_any_other_format_is_refused(key, other, tmp_path):
    sample = SAMPLES[key]
    path = sample.write(tmp_path)
    if (sample.format, other) == ("afad", "text"):  # three columns with names, unit and step
        read = GroundMotion.read(path, format=other, component=sample.component)
        assert read.sha256 == GroundMotion.read(path, component=sample.component).sha256
    else:
        with pytest.raises(RecordError):
            GroundMotion.read(path, format=other, component=sample.component)


def test_missing_component_is_refused(sample, tmp_path):
    with pytest.raises(RecordError, match="the component 'nowhere'"):
        GroundMotion.read(sample.write(tmp_path), component="nowhere")


def test_contradicting_time_step_argument_is_refused(sample, tmp_path):
    path = sample.write(tmp_path)
    GroundMotion.read(path, component=sample.component, time_step=f"{sample.time_step} s")
    with pytest.raises(RecordError, match=r"expected the 0\.5 s given by"):
        GroundMotion.read(path, component=sample.component, time_step="0.5 s")


def test_unit_argument_overrides_file_unit_with_warning(sample, tmp_path):
    path = sample.write(tmp_path)
    own = GroundMotion.read(path, component=sample.component)
    words = r"(, line \d+)?: the unit of the file is '.*', but unit='mm/s\^2' was requested"
    if sample.format == "geonet":
        assert GroundMotion.read(path, component=sample.component, unit="mm/s^2") == own
        return
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        other = GroundMotion.read(path, component=sample.component, unit="mm/s^2")
    assert re.search(re.escape(str(path)) + words, str(caught[0].message))
    assert other.metadata["unit_as_read"] == "mm/s^2"
    ratios = own.si.horizontal.samples[1:] / other.si.horizontal.samples[1:]
    np.testing.assert_allclose(ratios, ratios[0], rtol=1e-9)
    assert ratios[0] > 5.0


# shares of a file that contain the whole requested component
WHOLE = {
    "cosmos": (0.5, 0.95), "csmip1": (0.8, 0.95), "csmip2": (0.95,), "usc": (0.95,),
    "usc no unit": (0.95,),
}  # fmt: skip


@pytest.mark.filterwarnings("ignore:.*the file ends inside what line")
@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 0.8, 0.95])
@pytest.mark.parametrize("key", SAMPLES)
def test_truncated_file_never_gives_wrong_samples(key, share, tmp_path):
    sample = SAMPLES[key]
    path = tmp_path / sample.name
    path.write_bytes(sample.data[: int(share * len(sample.data))])
    if share in WHOLE.get(key, ()):
        found = GroundMotion.read(path, component=sample.component).si.horizontal.samples
        np.testing.assert_allclose(found, sample.samples, rtol=1e-12, atol=1e-12)
    else:
        with pytest.raises(RecordError):
            GroundMotion.read(path, component=sample.component)


def test_there_is_a_sample_of_every_format():
    missing = set(KNOWN) - {sample.format for sample in SAMPLES.values()} - set(BINARY)
    assert not missing, f"add files of {missing} to SAMPLES or BINARY in tests/unit/motion/"
