"""Any bytes give a motion or a RecordError, quickly and with little memory.

``ROCKFRAME_FUZZ=20`` runs twenty times as many examples; with
``--hypothesis-show-statistics`` pytest says how many were read and how many refused.
"""

import importlib.util
import os
import re
import sys
import tracemalloc
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st
from processor_time import processor_time
from property.damaged_files import DAMAGE, damaged
from records import record_path
from unit.motion.binary_samples import BINARY, miniseed, netcdf, station_xml
from unit.motion.format_samples import SAMPLES, cosmos, knet

from rockframe.errors import RecordError
from rockframe.motion import GroundMotion, formats

if sys.platform != "win32":
    import resource

pytestmark = [
    pytest.mark.wide,
    pytest.mark.filterwarnings("ignore::rockframe.errors.RecordWarning"),
]

TIMES = float(os.environ.get("ROCKFRAME_FUZZ", "1"))
LONGEST = 1.0  # s of processor time for one file
MOST_MEMORY = 200e6  # byte
MOST_NUMBERS = 60
REAL = {  # and the arguments of reading it
    "NIS090.AT2": {},
    "COSMOS_AK.BMR.BNZ_2018_us1000hyfh.V2c": {},
    "CSMIP_IV1979_ce01336p_CHAN01.V2": {},
    "SMC_LomaPrieta1989_0111a.smc": {},
    "ESM_HI.ARS1..HNE.D.20190728.160908.C.ACC.ASC": {},
    "CWA_20180206_1-EAS.dat": {"component": ("E", "U")},
    "GEONET_20180212_211557_WPWS_20.V2A": {"component": ("S16W", "Up")},
    "MSEED_TA.M04C..HNE_20140824.mseed": {"unit": "gal"},
    "MSEED_TA.M04C.StationXML.xml": {},
    "more/AFAD_20170720223109_4801.txt": {"component": ("N", "U")},
    "more/BHRC_5526-1.V1": {"component": ("L1", "V2")},
    "more/COSMOS_CE23837.V1C": {"component": "channel 1"},
    "more/CSMIP_CE89146.V1": {"component": "90"},
    "more/CSMNC_ua0001.dat": {},
    "more/OPENSEES_elCentro.at2": {},
    "more/RENADIC_altohospicio0911131.v1": {"component": "NS"},
    "more/RESORCE_16840_H1.cor.acc": {},
    "more/SAC_20190706031952.CJ.T001230.HNE.sac": {"unit": "m/s^2"},
    "more/UNAM_CUP50401.012": {"component": ("N90E", "V")},
    "more/USC_017m30bt.s0a": {},
}
NAMES = sorted(entry.name for entry in formats())
ODD_ARGUMENTS = st.fixed_dictionaries(
    {},
    optional={
        "format": st.sampled_from(NAMES),
        "unit": st.sampled_from(["g", "gal"]),
        "component": st.sampled_from(
            ["N", "E", "U", "2", "channel 1", "HNE", ("N", "U"), ("E", "Up")]
        ),
        "time_step": st.just("0.01 s"),
    },
)
# half of the files with their right arguments, so that the reader reaches the numbers
ARGUMENTS = st.just({}) | ODD_ARGUMENTS


def examples(count: int) -> settings:
    return settings(
        max_examples=int(count * TIMES), deadline=None, suppress_health_check=list(HealthCheck)
    )


def resident_peak() -> float:
    """Return the peak memory of the process [byte]; 0 where the system does not report it."""
    if sys.platform == "win32":
        return 0.0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return float(peak) if sys.platform == "darwin" else 1024.0 * peak


def check(path, data: bytes, *, packed: bool = False, **given) -> str:
    """Check that reading gives only a motion or a RecordError; return which."""
    path.write_bytes(data)
    before = resident_peak()
    error = motion = None

    def read():
        nonlocal error, motion
        try:
            motion = GroundMotion.read(path, **given)
        except RecordError as refusal:
            error = refusal

    assert processor_time(read, LONGEST) < LONGEST
    assert resident_peak() - before < MOST_MEMORY
    if error is not None:
        assert str(path.parent) in str(
            error
        )  # of the record, or of the response in the same folder
        assert len(str(error)) < 2_500
        lines = data.count(b"\n") + data.count(b"\r") + 1
        assert error.line is None or error.path != str(path) or 1 <= error.line <= lines
        return "refused"
    assert len(motion) >= 2
    assert abs(motion.si.horizontal.samples).max() < float("inf")
    assert motion.history
    if path.suffix != ".nc":  # the round trip preserves the data
        assert 1e-6 <= motion.si.time_step <= 10.0
        assert packed or motion.metadata["source_file"] == path.name
    return "read"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder after loading the libraries, which takes longer than any file."""
    path = tmp_path_factory.mktemp("fuzz")
    (path / "s.xml").write_text(station_xml(), encoding="utf-8")
    for name, data in (("s.nc", netcdf(path)), ("s.mseed", miniseed())):
        (path / name).write_bytes(data)
        if name == "s.nc" or importlib.util.find_spec("obspy") is not None:
            GroundMotion.read(path / name)
    return path


class Files(dict):
    """Files by a short name, so that a failing example shows no bytes."""

    def __repr__(self) -> str:
        return f"<{len(self)} files>"


@pytest.fixture(scope="module")
def undamaged(folder):
    """Return name, bytes and arguments of a file of every format."""
    held = Files(
        {key: (one.name, one.data, {"component": one.component}) for key, one in SAMPLES.items()}
    )
    for key, (name, make, arguments) in BINARY.items():
        held[key] = (name, make(folder), arguments)
    return held


@pytest.mark.long
@pytest.mark.parametrize("key", [*SAMPLES, *BINARY])
@examples(150)
@given(damage=DAMAGE, arguments=ARGUMENTS)
def test_damaged_files_of_every_format(folder, undamaged, key, damage, arguments):
    name, data, given = undamaged[key]
    asked = {**given, **arguments}
    event(check(folder / name, damaged(data, damage), **asked))


@pytest.mark.parametrize("name", REAL)
@examples(25)
@given(damage=DAMAGE, arguments=ARGUMENTS)
def test_damaged_files_as_published(folder, name, damage, arguments):
    asked = {**REAL[name], **arguments}
    data = record_path(name).read_bytes()
    event(check(folder / Path(name).name, damaged(data, damage), **asked))


@examples(150)
@given(
    data=st.one_of(st.binary(max_size=300), st.text(max_size=300).map(str.encode)),
    name=st.sampled_from(["r.AT2", "r.csv", "r.V2", "r.nc", "r.mseed", "r.sac", "r"]),
    arguments=ARGUMENTS,
)
def test_any_bytes(folder, data, name, arguments):
    event(check(folder / name, data, **arguments))


@pytest.mark.skipif(importlib.util.find_spec("obspy") is None, reason="ObsPy is not installed")
@examples(100)
@given(damage=DAMAGE)
def test_damaged_responses(folder, damage):
    response = folder / "response"
    response.write_bytes(damaged(station_xml().encode(), damage))
    event(check(folder / "r.mseed", miniseed(), response=response))


KINDS = st.sampled_from(["f8", "f4", "i1", "i8", "S1", str])
SHAPES = st.sampled_from(
    [(), ("time",), ("time", "power"), ("interval", "power"), ("power",), ("time", "time")]
)
ATTRIBUTES = st.dictionaries(
    st.sampled_from(
        [
            *("units", "time_step", "motion_name", "motion_sha256", "metadata"),
            *("history", "recipe", "scale_factor", "calendar"),
        ]
    ),
    st.sampled_from(["m s^-2", "s", "", "{}", "[]", "x\ny", "nan", 0.01, -1, 0, 1e308])
    | st.just(np.arange(3.0)),
    max_size=4,
)


@examples(80)
@given(
    sizes=st.tuples(*[st.integers(0, 9)] * 3),
    variables=st.dictionaries(
        st.sampled_from(["time", "acceleration", "vertical_acceleration", "acceleration_pieces"]),
        st.tuples(KINDS, SHAPES, ATTRIBUTES),
    ),
    attributes=ATTRIBUTES,
)
def test_arbitrary_netcdf_files_are_read_or_refused(folder, sizes, variables, attributes):
    path = folder / "made.nc"
    with netCDF4.Dataset(path, "w") as file:
        for name, size in zip(("time", "interval", "power"), sizes, strict=True):
            file.createDimension(name, size)  # none is unlimited
        file.setncatts(attributes)
        for name, (kind, shape, about) in variables.items():
            variable = file.createVariable(name, kind, shape)
            variable.setncatts(about)
            variable.set_auto_maskandscale(False)
            if kind in ("f8", "f4", "i1", "i8") and variable.size:
                variable[...] = np.arange(variable.size).reshape(variable.shape) % 100
    event(check(path, path.read_bytes()))


@pytest.mark.parametrize(
    "key",
    # every third of the formats, and all in the long run
    [
        pytest.param(key, marks=[pytest.mark.long] * (place % 3 > 0))
        for place, key in enumerate(key for key in SAMPLES if key != "cwa pair")
    ],
)
def test_huge_header_numbers_allocate_little_memory(folder, key):
    # the numbers of the header in turn become as large as their field allows
    sample = SAMPLES[key]
    head = sample.data[:3_500]
    path = folder / sample.name
    numbers = list(re.finditer(rb"\d+", head))
    tracemalloc.start()
    try:
        for match in numbers[:: max(1, len(numbers) // MOST_NUMBERS)]:
            width = max(len(match.group()), 8)
            data = sample.data[: match.start()] + b"9" * width + sample.data[match.end() :]
            check(path, data, component=sample.component)
        assert tracemalloc.get_traced_memory()[1] < MOST_MEMORY / 10
    finally:
        tracemalloc.stop()


COSMOS_FIRST = cosmos().encode().split(b"\n")[0]
LONG = {
    "line ends": b"\n" * 2**21,
    "blanks": b" " * 2**22,
    "long lines": (b" " * 999_999 + b"\n") * 4,
    "samples": b"1\n" * 350_000,
    "comments": b"# comment\n" * 300_000,
    "brackets": b"(" * 2**20,
    "zeros": b"\x00" * 2**22,
    "one number": b"1" * 2**22,
    "units": b"units of " * 2**17,
    "numbers in a line": SAMPLES["at2"].data + b"11 " * 2**20,
    "numbers run together": SAMPLES["at2"].data + b"-1.0" * 2**16,
    "first lines in a line": COSMOS_FIRST * 2**12,
    "first lines": (COSMOS_FIRST + b"\n") * 2**16,
    "channels": SAMPLES["csmip2"].data * 2**9,
    "components": SAMPLES["geonet2"].data * 2**8,
    "counts": knet().encode() + b" 1" * 2**19,
    "columns": b"0.01,2.0,3.0,4.0\n" * 300_000,
    "columns of numbers": b"1 2 3\n" * 299_999,
    "a leading count": b"999999 0.01\n" + b"1 2 3 4 5 6 7 8\n" * 300_000,
    "a leading count of all": b"2400000 0.01\n" + b"1 2 3 4 5 6 7 8\n" * 300_000,
    "pairs": SAMPLES["pairs"].data * 2**9,
    "first lines of channels": b"UNCORRECTED ACCELEROGRAM DATA\n" * 2**18,
    "rows of three columns": SAMPLES["afad"].data + b"1 2 3\n" * 300_000,
    "rows of two columns": SAMPLES["afad"].data + b"1 2\n" * 300_000,
    "rows of wide columns": SAMPLES["unam"].data + b"     1.000     1.000     1.000\n" * 300_000,
    "blocks": SAMPLES["bhrc"].data * 2**7,
    "keys": b"Time Increment (s) : 0.01\nNumber of Data : 7\n" + b"a : b\n" * 300_000,
    "numbers behind": SAMPLES["resorce"].data + b" 1.0000000E+00" * 2**18,
    "marks": SAMPLES["at2 marked"].data * 2**10,
}


@pytest.mark.long
@pytest.mark.parametrize("data", LONG.values(), ids=LONG)
def test_long_files_are_refused_quickly_with_little_memory(folder, data):
    path = folder / "long"
    path.write_bytes(data)
    tracemalloc.start()
    try:
        with pytest.raises(RecordError):
            GroundMotion.read(path, unit="g", time_step="0.01 s")
        assert tracemalloc.get_traced_memory()[1] < MOST_MEMORY
    finally:
        tracemalloc.stop()
    check(path, data)
