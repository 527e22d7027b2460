"""Suites from folders, archives and lists: whatever is not read causes a warning."""

import io
import os
import tarfile

import numpy as np
import pytest
from records import record_path, records_folder
from unit.motion.format_samples import SAMPLES
from unit.suites.downloads import STATIONS, download, noise, packed, table

import rockframe as rf
from rockframe.errors import ComponentError, RecordError, RecordWarning, UnitsError
from rockframe.records import peer_table, read_source

FILES = download()
HORIZONTAL = [name[:-4] for station in STATIONS for name in station.files[:2]]


@pytest.fixture
def folder(tmp_path):
    for name, data in FILES.items():
        (tmp_path / name).write_bytes(data)
    return tmp_path


def check_download(suite) -> None:
    assert sorted(suite) == sorted(HORIZONTAL)
    assert sorted(suite.verticals) == ["RSN14_MADE_S14-UP", "RSN6_MADE_S6-UP"]
    for station in STATIONS:
        for place, name in enumerate(station.files[:2]):
            motion = suite[name[:-4]]
            samples = motion.si.horizontal.samples
            np.testing.assert_allclose(samples, 9.80665 * noise(10 * station.number + place))
            metadata = motion.metadata
            assert metadata["record"] == f"RSN{station.number}"
            assert metadata["axis"] == ("H1", "H2")[place]
            assert metadata["magnitude"] == station.magnitude
            assert metadata["joyner_boore_distance"] == pytest.approx(1e3 * station.distance)
            assert metadata.get("shear_wave_velocity_30", -999) == station.velocity
            assert metadata["station"] == f"Station {station.number}"
    assert suite["RSN14_MADE_S14000"].metadata["stated_pulse_period"] == 4.4
    assert set(suite.pairs) == {"RSN6", "RSN14", "RSN78"}
    assert suite.pairs["RSN78"].vertical is None
    assert suite.pairs["RSN6"].vertical == suite.verticals["RSN6_MADE_S6-UP"]
    left = {path.rsplit("/", 1)[-1]: reason for path, reason in suite.unread.items()}
    others = [name for name in FILES if name.endswith((".VT2", ".pdf"))]
    assert sorted(left) == sorted(others)
    assert "a velocity" in left["RSN6_MADE_S6000.VT2"]


def test_peer_download_is_read_from_folders_archives_and_lists(folder, tmp_path_factory):
    place = tmp_path_factory.mktemp("packed")
    (place / "download.zip").write_bytes(packed(FILES))
    with tarfile.open(place / "download.tar.gz", "w:gz") as archive:
        for name in FILES:
            archive.add(folder / name, f"download/{name}")
    below = place / "folder" / "of" / "downloads"
    below.mkdir(parents=True)
    (below / "download.zip").write_bytes(packed(FILES))
    (below / ".hidden.AT2").write_bytes(b"hidden")
    sources = [
        folder,
        str(folder),
        place / "download.zip",
        place / "download.tar.gz",
        place / "folder",
        packed(FILES),
        io.BytesIO(packed(FILES)),
        sorted(folder.iterdir()),
        [below],
    ]
    for source in sources:
        check_download(rf.read_suite(source))
    with (place / "download.zip").open("rb") as file:
        check_download(rf.read_suite(file))


def test_missing_files_of_table_warn(folder):
    (folder / "RSN6_MADE_S6090.AT2").unlink()
    with pytest.warns(RecordWarning, match=r"1 file not read \(.*RSN6_MADE_S6090.AT2: found no"):
        suite = rf.read_suite(folder)
    assert "RSN6" not in suite.pairs
    assert suite["RSN6_MADE_S6000"].metadata["axis"] == "H1"
    assert any("S6090" in path for path in suite.unread)


def test_record_numbers_in_file_names_replace_missing_table(folder):
    (folder / "_SearchResults.csv").unlink()
    suite = rf.read_suite(folder)
    assert set(suite.pairs) == {"RSN6", "RSN14", "RSN78"}
    assert suite["RSN6_MADE_S6090"].metadata["record_sequence_number"] == 6
    assert "magnitude" not in suite["RSN6_MADE_S6090"].metadata
    assert suite["RSN6_MADE_S6090"].metadata["event"] == "Valley-02"


def test_components_of_same_station_and_event_form_pair(tmp_path):
    for name, data in FILES.items():
        if name.startswith("RSN") and name.endswith("AT2"):
            (tmp_path / name.split("_", 1)[1]).write_bytes(data)
    suite = rf.read_suite(tmp_path)
    assert set(suite.pairs) == {
        "Valley-02, 5/19/1940, Station 6",
        "County North, 5/19/1940, Station 14",
        "Valley-02, 5/19/1940, Station 78",
    }


def test_three_component_file_is_read_completely(tmp_path):
    sample = SAMPLES["cwa"] if "cwa" in SAMPLES else SAMPLES["cwa pair"]
    suite = rf.read_suite(sample.write(tmp_path))
    stem = sample.name.rsplit(".", 1)[0]
    assert set(suite) == {f"{stem} N", f"{stem} E"}
    assert set(suite.verticals) == {f"{stem} U"}
    ((_, pair),) = suite.pairs.items()
    assert pair.vertical is not None
    both = rf.HorizontalPair.read(tmp_path / sample.name)
    assert both.first.sha256 == pair.first.sha256
    assert both.second.sha256 == pair.second.sha256
    upright = suite.with_verticals()
    assert all(motion.si.vertical is not None for motion in upright.values())
    expected = rf.GroundMotion.read(tmp_path / sample.name, component=("N", "U"))
    assert upright[f"{stem} N"].sha256 == expected.sha256


def test_every_sample_file_is_read_or_listed_as_unread(tmp_path):
    for sample in SAMPLES.values():
        sample.write(tmp_path)
    with pytest.warns(RecordWarning):
        suite = rf.read_suite(tmp_path, unit="g", time_step="0.01 s")
    files = {
        motion.metadata["source_file"] for motion in (*suite.values(), *suite.verticals.values())
    }
    left = {path.rsplit("/", 1)[-1] for path in suite.unread}
    assert files | left == {sample.name for sample in SAMPLES.values()}
    assert not files & left


TEXT = "time (s),acc (g)\n0,0\n0.01,{}\n0.02,0\n"


def test_files_with_same_name_get_distinct_labels(tmp_path):
    # the folders show two earthquakes, so the components form no pair
    for place, peak in (("a", 0.1), ("b", 0.2)):
        (tmp_path / place).mkdir()
        (tmp_path / place / "x.csv").write_text(TEXT.format(peak))
    suite = rf.read_suite(tmp_path)
    assert list(suite) == ["x", "x (2)"]
    assert [motion.metadata["record"] for motion in suite.values()] == ["x.csv", "x.csv (2)"]
    assert suite.pairs == {}


def test_bytes_without_a_name_are_no_pair():
    suite = rf.read_suite([TEXT.format(peak).encode() for peak in (0.1, 0.2)])
    assert len(suite) == 2
    assert suite.pairs == {}


def test_copies_of_a_file_are_read_once(tmp_path):
    for name in ("x.csv", "x (1).csv"):
        (tmp_path / name).write_text(TEXT.format(0.1))
    for source in (tmp_path, [tmp_path / "x.csv"] * 2, [TEXT.format(0.1).encode()] * 2):
        with pytest.warns(RecordWarning, match="1 file not read .*a copy of "):
            suite = rf.read_suite(source)
        assert len(suite) == 1
        (reason,) = suite.unread.values()
        assert "expected each record once" in reason


def test_components_that_form_no_pair_warn(tmp_path):
    from unit.motion.motion_files import at2

    for name in ("10", "90"):
        text = at2("NPTS= 400, DT= .01", noise(1), event=f"Quake, 1/1/2000, Here, {name}")
        (tmp_path / f"{name}.AT2").write_text(text)
    with pytest.warns(RecordWarning, match="1 worth a look .*not at a right angle"):
        suite = rf.read_suite(tmp_path)
    assert suite.pairs == {}
    assert len(suite) == 2
    for name in ("20", "110"):
        text = at2("NPTS= 400, DT= .01", noise(1), event=f"Quake, 1/1/2000, Here, {name}")
        (tmp_path / f"{name}.AT2").write_text(text)
    with pytest.warns(RecordWarning, match="4 horizontal and 0 vertical components"):
        assert len(rf.read_suite(tmp_path)) == 4


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("nowhere", "no such file or folder"),
        ([], "no horizontal component in 0 files"),
        ([b"nothing"], "no horizontal component in 1 file;"),
        (3.5, "names no file|no such file"),
        (packed({"a.VT2": b"x"}), "a velocity"),
        (packed({"RSN6_A-UP.AT2": FILES["RSN6_MADE_S6-UP.AT2"]}), "1 vertical ones"),
        (table(), "no horizontal component"),
    ],
)
def test_input_without_motions_is_refused(source, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RecordError, match=words):
        rf.read_suite(source)


def test_arguments_are_checked(folder):
    with pytest.raises(UnitsError, match="unit needs the unit of an acceleration, got 'm'"):
        rf.read_suite(folder, unit="m")
    with pytest.raises(ComponentError, match=r"^the format of .* one of .* got 'xls'"):
        rf.read_suite(folder, format="xls")
    with pytest.raises(ComponentError, match="time_step must be greater than zero, got '0 s'"):
        rf.read_suite(folder, time_step="0 s")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a pipe")
def test_pipes_and_broken_links_are_skipped(folder):
    os.mkfifo(folder / "pipe.AT2")
    (folder / "link.AT2").symlink_to(folder / "nowhere.AT2")
    check_download(rf.read_suite(folder))


@pytest.mark.skipif(os.name == "nt", reason="file names there are text")
def test_a_file_name_that_is_no_text_gives_a_label_that_can_be_written(tmp_path):
    name = os.fsdecode(b"citt\xe0.AT2")
    (tmp_path / name).write_bytes(FILES[f"{HORIZONTAL[0]}.AT2"])
    (tmp_path / os.fsdecode(b"citt\xe8.AT2")).write_bytes(FILES[f"{HORIZONTAL[1]}.AT2"])
    suite = rf.read_suite([tmp_path / name, tmp_path / os.fsdecode(b"citt\xe8.AT2")])
    assert list(suite) == ["citt", "citt (2)"]
    suite.to_dataset().to_netcdf(tmp_path / "suite.nc")
    assert list(rf.read_suite(tmp_path / "suite.nc")) == list(suite)


def test_damaged_table_warns(folder):
    intact = table().decode()
    row = next(line for line in intact.splitlines() if line.startswith("6,"))
    for changed, words in {
        intact.replace("Result ID", "Result"): "no line that begins with 'Result ID'",
        intact.replace(row, row[:60]): r"line 9: found \d+ fields",
        intact.replace(row, row.replace('"Station 6"', "Station 6, A")): "line 9: found 23 fields",
        intact.replace("6.95", "strong"): "'strong' in the column 'magnitude'",
        intact.replace("Filename", "File"): "no column with the names of files",
    }.items():
        (folder / "_SearchResults.csv").write_text(changed)
        with pytest.warns(RecordWarning, match="_SearchResults.csv"):
            suite = rf.read_suite(folder)
        assert len(suite) == len(HORIZONTAL)
        (reason,) = [message for path, message in suite.unread.items() if path.endswith(".csv")]
        import re

        assert re.search(words, reason)


def test_the_published_records():
    record_path("NIS090.AT2")
    with pytest.warns(RecordWarning):
        suite = rf.read_suite(sorted(records_folder().glob("*.*")))
    assert {"NIS090", "PEERSMD_CHICHI_TCU128-N", "RSN763_LOMAP_GIL067"} <= set(suite)
    assert len(suite.pairs) >= 2
    for pair in suite.pairs.values():
        assert pair.vertical is not None
    names = {path.rsplit("/", 1)[-1] for path in suite.unread}
    read = {
        motion.metadata["source_file"] for motion in (*suite.values(), *suite.verticals.values())
    }
    assert read | names == {path.name for path in records_folder().glob("*.*")}


def test_the_published_table():
    path = record_path("more/PEER_SearchResults.csv")
    entries = peer_table(read_source(path))
    assert entries is not None
    assert len(entries) == 3 * 30 - 1  # one record has no vertical component
    first = entries["RSN6_IMPVALL.I_I-ELC180.AT2"]
    assert first == {
        "axis": "H1",
        "event": "Imperial Valley-02",
        "joyner_boore_distance": 6090.0,
        "lowest_usable_frequency": 0.25,
        "magnitude": 6.95,
        "mechanism": "strike slip",
        "record_sequence_number": 6,
        "rupture_distance": 6090.0,
        "shear_wave_velocity_30": 213.44,
        "station": "El Centro Array #9",
        "year": 1940,
    }
    assert entries["RSN138_TABAS_BOS-V1.AT2"]["axis"] == "V"
