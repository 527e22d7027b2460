"""Small synthetic files of the binary formats, and StationXML for them."""

import itertools
import json
import struct
from pathlib import Path

import netCDF4
import numpy as np
from unit.motion.dialect_samples import sac
from unit.motion.format_samples import COUNTS, VALUES

from rockframe.motion import GroundMotion


def miniseed(
    counts=COUNTS,
    *,
    channel: str = "HNE",
    rate: int = 100,
    start: int = 0,
    tenths: int = 0,
    location: str = "  ",
) -> bytes:
    """One 512-byte record of 32-bit integers (SEED manual 2.4, chapter 8)."""
    head = b"000001D " + b"MADE " + location.encode() + channel.encode() + b"XX"
    head += struct.pack(">HHBBBBH", 2018, 24, 10, 51, start, 0, tenths)
    head += struct.pack(">HhhBBBBiHH", len(counts), rate, 1, 0, 0, 0, 1, 0, 64, 48)
    head += struct.pack(">HHBBBB", 1000, 0, 3, 1, 9, 0)
    body = head.ljust(64, b"\x00") + struct.pack(f">{len(counts)}i", *counts.tolist())
    return body.ljust(512, b"\x00")


def station_xml(units: str = "M/S**2", sensitivity: float = 4e5, channels=(("HNE", 90, 0),)) -> str:
    """The response of some channels."""
    described = "".join(
        f'<Channel code="{code}" locationCode="" startDate="2010-01-01T00:00:00">'
        "<Latitude>0</Latitude><Longitude>0</Longitude><Elevation>0</Elevation><Depth>0</Depth>"
        f"<Azimuth>{azimuth}</Azimuth><Dip>{dip}</Dip><SampleRate>100</SampleRate>"
        f"<Response><InstrumentSensitivity><Value>{sensitivity}</Value><Frequency>1</Frequency>"
        f"<InputUnits><Name>{units}</Name></InputUnits>"
        "<OutputUnits><Name>COUNTS</Name></OutputUnits>"
        "</InstrumentSensitivity></Response></Channel>"
        for code, azimuth, dip in channels
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<FDSNStationXML xmlns="http://www.fdsn.org/xml/station/1" schemaVersion="1.1">'
        "<Source>made up</Source><Created>2020-01-01T00:00:00</Created>"
        '<Network code="XX"><Station code="MADE" startDate="2010-01-01T00:00:00">'
        "<Latitude>0</Latitude><Longitude>0</Longitude><Elevation>0</Elevation>"
        f"<Site><Name>made up</Name></Site>{described}</Station></Network></FDSNStationXML>\n"
    )


def netcdf(folder: Path) -> bytes:
    """A stored motion."""
    path = folder / "stored.nc"
    level, upwards = (VALUES[key] / 100.0 for key in ("N", "U"))
    motion = GroundMotion.from_arrays((level, "m/s^2"), "0.01 s", (upwards, "m/s^2"), name="stored")
    motion.scaled(0.5).to_dataset().to_netcdf(path)
    return path.read_bytes()


def asdf(
    folder: Path,
    *,
    unit: str | None = "cm/s^2",
    xml: str | None = None,
    tag: str = "made_default",
    rate: float = 100.0,
    channels=(("HNE", "E"), ("HNN", "N"), ("HNZ", "U")),
    pieces: int = 1,
) -> bytes:
    """An HDF5 workspace of one event in the layout of gmprocess."""
    path = folder / "made.h5"
    with netCDF4.Dataset(path, "w") as file:
        file.setncatts({"file_format": "ASDF", "file_format_version": "1.0.3"})
        group = file.createGroup("Waveforms").createGroup("XX.MADE")
        for (code, key), piece in itertools.product(channels, range(1, pieces + 1)):
            times = f"2018-01-24T10:51:00__2018-01-24T10:51:0{piece}"
            _array(group, f"XX.MADE.--.{code}__{times}__{tag}", VALUES[key]).setncatts(
                {"sampling_rate": rate, "starttime": np.int64(1516791060 * 10**9)}
            )
        if xml is not None:
            _array(group, "StationXML", np.frombuffer(xml.encode(), np.int8))
        if unit is not None:
            supplement = json.dumps({"standard": {"units": unit}}).encode()
            statistics = file.createGroup("AuxiliaryData").createGroup("StreamSupplementalStats")
            name = f"XX.MADE.--.HN_{tag}"
            _array(statistics.createGroup("XX.MADE"), name, np.frombuffer(supplement, np.uint8))
    return path.read_bytes()


def _array(group, name: str, values):
    dimension = f"n{len(group.variables)}"
    group.createDimension(dimension, len(values))
    variable = group.createVariable(name, values.dtype, (dimension,))
    variable[:] = values
    return variable


BINARY = {
    "netcdf": ("d.nc", netcdf, {}),
    "miniseed": ("s.mseed", lambda _: miniseed(), {}),
    "sac": ("s.sac", lambda _: sac(), {"unit": "gal"}),
    "asdf": ("w.h5", asdf, {"component": ("N", "Z")}),
}
"""For each format: file name, function that makes its bytes in a folder, reading arguments."""
