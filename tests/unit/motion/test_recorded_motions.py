"""Real records are read with their published properties."""

import hashlib
import sys
import warnings

import numpy as np
import pytest
from records import record_path

from rockframe.errors import RecordError, RecordWarning
from rockframe.motion import GroundMotion, formats

STANDARD_GRAVITY = 9.80665
TEXT = {"unit": "g", "time_step": "0.005 s"}

COSMOS = "COSMOS_AK.BMR.BNZ_2018_us1000hyfh.V2c"
CSMIP = "CSMIP_IV1979_ce01336p_CHAN01.V2"
SMC = "SMC_LomaPrieta1989_0111a.smc"
ESM = "ESM_HI.ARS1..HNE.D.20190728.160908.C.ACC.ASC"
GEONET = "GEONET_20180212_211557_WPWS_20.V2A"
CWA = "CWA_20180206_1-EAS.dat"
MINISEED = "MSEED_TA.M04C..HNE_20140824.mseed"
MORE = "more/"
RENADIC = MORE + "RENADIC_altohospicio0911131.v1"
UNAM = MORE + "UNAM_CUP50401.012"
SAC = MORE + "SAC_20190706031952.CJ.T001230.HNE.sac"
STATION_XML = "MSEED_TA.M04C.StationXML.xml"
TCU128 = "PEERSMD_CHICHI_TCU128-N.AT2"
TCU128_EAST = "SLAMMER_CHICHI_TCU128-090.txt"

RECORDS = [
    # name, arguments, format, time step [s], samples, peak [g], unit as read
    (TCU128, {}, "peer-at2", 0.005, 18000, 0.17024, "G"),
    ("ElCentro1940_Peknold.AT2", {}, "peer-at2", 0.02, 1559, 0.31882, "g"),
    ("PEERSMD_IMPVALL_IELC180.AT2", {}, "peer-at2", 0.01, 4000, 0.31288, "G"),
    ("NIS090.AT2", {}, "peer-at2", 0.01, 4096, 0.50275, "G"),
    ("RSN763_LOMAP_GIL067.AT2", {}, "peer-at2", 0.005, 7999, 0.35853, "G"),
    (TCU128_EAST, TEXT, "text", 0.005, 13125, 0.13933, "g"),
    (SMC, {}, "smc", 0.005, 6001, 0.10647, "cm/sec/sec"),
    (CSMIP, {"component": "UP"}, "csmip", 0.02, 1138, 0.17497, "CM/SEC/SEC"),
    # not in the index: the peak is that of the file header
    (COSMOS, {"component": "BNZ"}, "cosmos", 0.005, 42000, 6.851512 / 980.665, "cm/sec2"),
    (ESM, {}, "esm", 0.005, 19128, 0.300022 / 980.665, "cm/s^2"),
    (GEONET, {"component": "S74E"}, "geonet", 0.02, 5800, 0.01978, "mm/s^2"),
    (CWA, {"component": "N"}, "cwa", 0.02, 6000, 0.00231, "gal"),
    # peaks as stated in the files
    (
        MORE + "AFAD_20170720223109_4801.txt",
        {"component": "E"},
        "afad",
        *(0.01, 13494),
        0.02656,
        "gal",
    ),
    (MORE + "BHRC_5526-1.V1", {"component": "L1"}, "bhrc", *(0.005, 9472), 0.00592, "G/10"),
    (MORE + "COSMOS_CE23837.V1C", {"component": "HNN"}, "cosmos", *(0.005, 13400), 0.10543, "g"),
    (MORE + "CSMIP_CE89146.V1", {"component": "360"}, "csmip", *(0.005, 13200), 0.07918, "g"),
    (MORE + "CSMNC_ua0001.dat", {}, "csmnc", *(0.005, 12800), 16.986 / 980.665, "CM/SEC/SEC"),
    (MORE + "DYNA_dyna10_head_only.ASC", {}, "esm", *(0.005, 20), 134.7 / 980.665, "cm/s^2"),
    (MORE + "DYNA_itaca11_head_only.DAT", {}, "esm", *(0.005, 20), 134.7 / 980.665, "cm/s^2"),
    (MORE + "MATLAB_Hollister.dat", {"unit": "m/s^2"}, "text", *(0.02, 601), 0.13733, "m/s^2"),
    (MORE + "OPENSEES_elCentro.at2", {}, "peer-at2", *(0.02, 1559), 0.31882, "g"),
    (RENADIC, {"component": "EW"}, "csmip", *(0.01, 3500), 0.0506, "G/10"),
    (MORE + "RESORCE_16840_H1.cor.acc", {}, "resorce", *(0.005, 12400), 0.00102, "m/s/s"),
    (UNAM, {"component": "N90E"}, "unam", *(0.004, 17502), 1.19 / 980.665, "Gal"),
    (MORE + "USC_017m30bt.s0a", {}, "csmip", *(0.02, 1887), 242.3945 / 980.665, "CM/SEC/SEC"),
    (MORE + "USC_274o42pv.s0b", {"component": "UP"}, "csmip", *(0.02, 574), 0.00968, "cm/sec/sec"),
    (SAC, {"unit": "m/s^2"}, "sac", *(0.02, 15001), 0.043384 / 9.80665, "m/s^2"),
]


@pytest.mark.filterwarnings("ignore:.*(declares 17500 samples|lie around an offset)")
@pytest.mark.parametrize(
    ("name", "arguments", "kind", "time_step", "count", "peak", "unit"), RECORDS
)
def test_records_have_their_published_step_count_and_peak(
    name, arguments, kind, time_step, count, peak, unit
):
    path = record_path(name)
    motion = GroundMotion.read(path, **arguments)
    assert motion.si.time_step == time_step
    assert len(motion) == count
    assert motion.si.peak / STANDARD_GRAVITY == pytest.approx(peak, abs=1e-5)
    assert motion.metadata["format"] == kind
    assert motion.metadata["unit_as_read"] == unit
    assert motion.metadata["source_file"] == path.name
    assert motion.metadata["source_sha256"] == hashlib.sha256(path.read_bytes()).hexdigest()
    assert GroundMotion.read(path, format=kind, **arguments) == motion


@pytest.mark.parametrize(
    ("name", "component", "peak", "unit"),
    [
        # peaks as printed in the headers, to half of their last digit
        (GEONET, "S16W", 41.6, 1e-3),
        (GEONET, "S74E", 194.0, 1e-3),
        (GEONET, "Up", 27.3, 1e-3),
        (CWA, "U", 0.837, 1e-2),
        (CWA, "N", 2.273, 1e-2),
        (CWA, "E", 1.017, 1e-2),
        (CSMIP, "UP", 171.589, 1e-2),
        (COSMOS, "BNZ", 6.852, 1e-2),
        (SMC, "360", 104.4078, 1e-2),
        (MORE + "AFAD_20170720223109_4801.txt", "N-S", 21.838512, 1e-2),
        (MORE + "AFAD_20170720223109_4801.txt", "U-D", 9.799439, 1e-2),
        (RENADIC, "NS", 0.838, 0.980665),
    ],
)
def test_every_component_has_the_peak_that_its_header_prints(name, component, peak, unit):
    motion = GroundMotion.read(record_path(name), component=component)
    assert motion.si.peak / unit == pytest.approx(peak, abs=5.1e-4 if peak < 100 else 0.051)


@pytest.mark.parametrize(
    ("name", "component", "station", "event"),
    [
        (TCU128, "N", "TCU128", "CHI-CHI 09/20/99"),
        ("NIS090.AT2", "090", "NISHI-AKASHI", "KOBE 01/16/95 2046"),
        ("RSN763_LOMAP_GIL067.AT2", "67", "Gilroy - Gavilan Coll.", "Loma Prieta"),
        (
            "PEERSMD_IMPVALL_IELC180.AT2",
            "180",
            "EL CENTRO ARRAY #9",
            "IMPERIAL VALLEY 5/19/40 0439",
        ),
        (SMC, "360", "SAF0A", "Loma Prieta, CA"),
        (CSMIP, "UP", "1336", "IMPERIAL VALLEY, CA EARTHQUAKE"),
        (COSMOS, "BNZ", "AK-BMR", "Point MacKenzie Earthquake of Fri Nov 30, 2018 17:29 UTC"),
        (ESM, "HNE", "ARS1", "GREECE"),
        (GEONET, "Up", "WPWS", "6 km south of Waipukurau"),
        (CWA, "E", "EAS", "earthquake of 2018/02/06-23:50:42 (GMT+08)"),
    ],
)
def test_records_name_event_station_and_component(name, component, station, event):
    metadata = GroundMotion.read(record_path(name), component=component).metadata
    assert metadata["component"] == component
    assert metadata["station"] == station
    assert metadata["event"] == event


def test_component_of_another_name_is_refused():
    with pytest.raises(RecordError, match="component 'N'; expected the component 'E'"):
        GroundMotion.read(record_path(TCU128), component="E")


def test_component_number_may_have_leading_zeros():
    motion = GroundMotion.read(record_path("RSN763_LOMAP_GIL067.AT2"), component="067")
    assert motion.metadata["component"] == "67"


@pytest.mark.parametrize("name", [GEONET, CWA])
def test_files_of_three_components_need_component_argument(name):
    with pytest.raises(RecordError, match=r"3 components: .*the argument component"):
        GroundMotion.read(record_path(name))


@pytest.mark.parametrize("name", [CSMIP, COSMOS])
def test_files_of_vertical_component_warn(name):
    with pytest.warns(RecordWarning, match="is vertical"):
        GroundMotion.read(record_path(name))


@pytest.mark.parametrize(("name", "pair"), [(GEONET, ("S16W", "Up")), (CWA, ("E", "U"))])
def test_a_horizontal_component_with_the_vertical_one(name, pair):
    both = GroundMotion.read(record_path(name), component=pair)
    across, upwards = (GroundMotion.read(record_path(name), component=part) for part in pair)
    assert both.sha256 == across.with_vertical(upwards).sha256


def test_the_other_file_of_tcu128_holds_the_other_component():
    """The envelopes agree at a lag of 20.4 s, its start; the samples agree at no lag.

    The text file, named 090, is the east component of the motion whose north
    component is the AT2 file: no sign, scale or lag turns one into the other.
    """
    north = GroundMotion.read(record_path(TCU128)).si.horizontal.samples
    east = GroundMotion.read(record_path(TCU128_EAST), **TEXT).si.horizontal.samples
    window = np.hanning(401)
    envelopes = [np.sqrt(np.convolve(x**2, window / window.sum(), "same")) for x in (north, east)]
    lags = range(0, north.size - east.size + 1, 5)

    def correlation(whole, part):
        views = (whole[lag : lag + part.size] for lag in lags)
        return np.array([np.corrcoef(view, part)[0, 1] for view in views])

    fit = correlation(*envelopes)
    assert fit.max() > 0.85
    assert lags[int(fit.argmax())] * 0.005 == pytest.approx(20.35, abs=0.5)
    assert abs(correlation(north, east)).max() < 0.3
    # the same motion in the same unit: energies of similar size
    assert 0.5 < np.sum(east**2) / np.sum(north**2) < 1.0


def test_miniseed_is_read_or_requires_obspy(monkeypatch):
    path = record_path(MINISEED)
    record_path(STATION_XML)
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "obspy", None)
        with pytest.raises(RecordError, match=r"rockframe\[records\]"):
            GroundMotion.read(path)
    pytest.importorskip("obspy")
    with pytest.warns(RecordWarning, match="peak acceleration is 9.028e-05 g"):
        motion = GroundMotion.read(path, component="E")
    assert (motion.si.time_step, len(motion)) == (0.01, 15000)
    assert motion.metadata["sensitivity"] == 427894.0
    assert motion.metadata["response_file"] == STATION_XML


def test_station_xml_is_no_record():
    with pytest.raises(RecordError, match="StationXML"):
        GroundMotion.read(record_path(STATION_XML))


OWN_FORMATS = {entry[0]: entry[2] for entry in RECORDS} | {MINISEED: "miniseed"}


@pytest.mark.parametrize(
    ("name", "given_format"),
    [
        (name, entry.name)
        for name in (*OWN_FORMATS, "INDEX.md")
        for entry in formats()
        if entry.name != OWN_FORMATS.get(name)
    ],
)
def test_a_forced_wrong_format_is_refused(name, given_format):
    with pytest.raises(RecordError):
        GroundMotion.read(record_path(name), format=given_format, **TEXT)


def test_truncated_record_raises_with_expected_count(tmp_path):
    data = record_path(TCU128).read_bytes()
    path = tmp_path / "half.AT2"
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(RecordError, match="18000"):
        GroundMotion.read(path)


@pytest.mark.parametrize("cut", range(1, len("-.5906549E-05")))
def test_a_record_cut_inside_its_last_number_is_refused(tmp_path, cut):
    # "-.5906549E-05" without its exponent would be half the acceleration of gravity
    data = record_path(TCU128).read_bytes().rstrip()
    path = tmp_path / "cut.AT2"
    path.write_bytes(data[:-cut])
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(path)
    assert caught.value.line == 3604


@pytest.mark.parametrize(("name", "arguments"), [entry[:2] for entry in RECORDS])
def test_record_survives_netcdf_round_trip(name, arguments, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RecordWarning)
        motion = GroundMotion.read(record_path(name), **arguments)
    path = tmp_path / "motion.nc"
    motion.to_dataset().to_netcdf(path)
    assert GroundMotion.read(path) == motion
