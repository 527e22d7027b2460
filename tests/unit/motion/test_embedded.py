"""Records included in the package equal the published ones and name their sources."""

import gzip
import hashlib
from importlib import resources

import numpy as np
import pytest
from records import record_path

from rockframe.errors import ComponentError, RecordError
from rockframe.motion import GroundMotion
from rockframe.motion.constructors.records import record_sources

FOLDER = resources.files("rockframe.motion") / "embedded"
MOST_BYTES = 300_000
STANDARD_GRAVITY = 9.80665
RECORDS = {
    # samples, time step [s], peak [m/s^2] stated in the file, first and last sample in
    # the unit of the file [mm/s^2], file among the recorded motions
    "loma-prieta": (6001, 0.005, 1.044078, (15.057, -2.8745), "SMC_LomaPrieta1989_0111a.smc"),
    "waipukurau": (5800, 0.02, 0.1940, None, "GEONET_20180212_211557_WPWS_20.V2A"),
}
REQUIRED = ("magnitude", "source", "processing", "licence", "attribution", "reference")


def test_all_files_have_a_source_and_are_small():
    sources = record_sources(FOLDER)
    assert set(sources) == set(RECORDS)
    packed = {file.name for file in FOLDER.iterdir() if file.name.endswith(".gz")}
    assert packed == {record["file"] for record in sources.values()}
    assert sum(len((FOLDER / name).read_bytes()) for name in packed) < MOST_BYTES
    for record in sources.values():
        assert all(record["metadata"][key] for key in REQUIRED)
    assert "CC BY" in sources["waipukurau"]["metadata"]["licence"]
    assert "GeoNet" in sources["waipukurau"]["metadata"]["attribution"]


@pytest.mark.parametrize("name", RECORDS)
def test_example_has_published_samples_and_attribution(name):
    samples, step, peak, ends, _ = RECORDS[name]
    motion = GroundMotion.example(name)
    assert (len(motion), motion.si.time_step) == (samples, step)
    assert motion.si.peak == pytest.approx(peak, rel=1e-3)
    if ends is not None:
        end_samples = motion.si.horizontal.samples[[0, -1]] * 1e3
        assert end_samples == pytest.approx(ends, rel=1e-12)
    assert motion.metadata["attribution"] in motion.history[-1]
    assert motion.metadata["licence"] in motion.history[-1]


@pytest.mark.parametrize("name", RECORDS)
def test_embedded_file_equals_published_file(name):
    published = record_path(RECORDS[name][-1]).read_bytes()
    embedded = (FOLDER / record_sources(FOLDER)[name]["file"]).read_bytes()
    assert gzip.decompress(embedded) == published
    digest = GroundMotion.example(name).metadata["source_sha256"]
    assert digest == hashlib.sha256(published).hexdigest()


def test_example_component_can_be_chosen():
    both = GroundMotion.example("waipukurau", component=("S74E", "Up"))
    assert both.si.vertical is not None
    alone = GroundMotion.example("waipukurau")
    assert np.array_equal(both.si.horizontal.samples, alone.si.horizontal.samples)
    other = GroundMotion.example("waipukurau", component="S16W")
    assert other.si.peak == pytest.approx(0.0416, rel=1e-3)
    with pytest.raises(RecordError, match="S16W"):
        GroundMotion.example("waipukurau", component="north-east")


@pytest.mark.parametrize("name", ["", "el-centro", 3, None])
def test_unknown_example_name_lists_available_ones(name):
    with pytest.raises(ComponentError, match="'loma-prieta', 'waipukurau', got "):
        GroundMotion.example(name)
