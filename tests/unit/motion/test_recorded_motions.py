"""The reader against real records, as published."""

import time

import pytest
from records import record_path

from rockframe.errors import RecordError
from rockframe.motion import GroundMotion

STANDARD_GRAVITY = 9.80665

AT2 = [
    # name, time step [s], samples, peak [g]
    ("PEERSMD_CHICHI_TCU128-N.AT2", 0.005, 18000, 0.17024),
    ("ElCentro1940_Peknold.AT2", 0.02, 1559, 0.31882),
    ("PEERSMD_IMPVALL_IELC180.AT2", 0.01, 4000, 0.31288),
    ("NIS090.AT2", 0.01, 4096, 0.50275),
    ("RSN763_LOMAP_GIL067.AT2", 0.005, 7999, 0.35853),
]


@pytest.mark.parametrize(("name", "time_step", "count", "peak"), AT2)
def test_at2_records_have_their_published_step_count_and_peak(name, time_step, count, peak):
    motion = GroundMotion.read(record_path(name))
    assert motion.si.time_step == time_step
    assert len(motion) == count
    # the index prints five decimals: half a digit of the last one
    assert abs(motion.si.peak / STANDARD_GRAVITY - peak) <= 5.0e-6 + 1e-9
    assert motion.metadata["source_file"] == name


def test_single_column_record():
    path = record_path("SLAMMER_CHICHI_TCU128-090.txt")
    motion = GroundMotion.read(path, unit="g", time_step="0.005 s")
    assert (motion.si.time_step, len(motion)) == (0.005, 13125)
    assert motion.si.peak / STANDARD_GRAVITY == pytest.approx(0.13933, rel=1e-5)


@pytest.mark.parametrize(
    ("name", "component", "station"),
    [
        ("PEERSMD_CHICHI_TCU128-N.AT2", "N", "TCU128"),
        ("NIS090.AT2", "090", "NISHI-AKASHI"),
        ("RSN763_LOMAP_GIL067.AT2", "67", "Gilroy - Gavilan Coll."),
        ("PEERSMD_IMPVALL_IELC180.AT2", "180", "EL CENTRO ARRAY #9"),
    ],
)
def test_records_name_station_and_component(name, component, station):
    motion = GroundMotion.read(record_path(name), component=component)
    assert motion.metadata["component"] == component
    assert motion.metadata["station"] == station


def test_component_of_another_name_is_refused():
    with pytest.raises(RecordError, match="component 'N'; expected the component 'E'"):
        GroundMotion.read(record_path("PEERSMD_CHICHI_TCU128-N.AT2"), component="E")


def test_component_number_may_have_leading_zeros():
    motion = GroundMotion.read(record_path("RSN763_LOMAP_GIL067.AT2"), component="067")
    assert motion.metadata["component"] == "67"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("COSMOS_AK.BMR.BNZ_2018_us1000hyfh.V2c", "COSMOS"),
        ("CSMIP_IV1979_ce01336p_CHAN01.V2", "CSMIP"),
        ("SMC_LomaPrieta1989_0111a.smc", "SMC"),
        ("ESM_HI.ARS1..HNE.D.20190728.160908.C.ACC.ASC", "ESM"),
        ("CWA_20180206_1-EAS.dat", "Taiwan"),
        ("GEONET_20180212_211557_WPWS_20.V2A", "GeoNet"),
        ("MSEED_TA.M04C..HNE_20140824.mseed", "binary data"),
        ("MSEED_TA.M04C.StationXML.xml", "markup"),
    ],
)
@pytest.mark.parametrize("given", [{}, {"unit": "g", "time_step": "0.01 s"}])
def test_other_formats_are_refused_by_name_and_never_misread(name, words, given):
    with pytest.raises(RecordError, match=words):
        GroundMotion.read(record_path(name), **given)


@pytest.mark.parametrize("given_format", ["text", "peer-at2"])
@pytest.mark.parametrize(
    "name",
    [
        "COSMOS_AK.BMR.BNZ_2018_us1000hyfh.V2c",
        "CSMIP_IV1979_ce01336p_CHAN01.V2",
        "SMC_LomaPrieta1989_0111a.smc",
        "ESM_HI.ARS1..HNE.D.20190728.160908.C.ACC.ASC",
        "CWA_20180206_1-EAS.dat",
        "GEONET_20180212_211557_WPWS_20.V2A",
        "INDEX.md",
    ],
)
def test_a_forced_wrong_format_is_refused(name, given_format):
    with pytest.raises(RecordError):
        GroundMotion.read(record_path(name), format=given_format, unit="g", time_step="0.01 s")


def test_half_a_record_is_refused_and_says_how_much_is_there(tmp_path):
    data = record_path("PEERSMD_CHICHI_TCU128-N.AT2").read_bytes()
    path = tmp_path / "half.AT2"
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(RecordError, match="18000"):
        GroundMotion.read(path)


@pytest.mark.parametrize("cut", range(1, len("-.5906549E-05")))
def test_a_record_cut_inside_its_last_number_is_refused(tmp_path, cut):
    # "-.5906549E-05" without its exponent would be half the acceleration of gravity
    data = record_path("PEERSMD_CHICHI_TCU128-N.AT2").read_bytes().rstrip()
    path = tmp_path / "cut.AT2"
    path.write_bytes(data[:-cut])
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(path)
    assert caught.value.line == 3604


def test_reading_18000_samples_takes_well_under_30_milliseconds():
    path = record_path("PEERSMD_CHICHI_TCU128-N.AT2")
    durations = []
    for _ in range(10):
        start = time.perf_counter()
        GroundMotion.read(path)
        durations.append(time.perf_counter() - start)
    assert min(durations) < 0.030
