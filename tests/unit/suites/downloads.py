"""Synthetic downloads: records of several stations, with the table that PEER adds."""

import io
import zipfile
from dataclasses import dataclass

import numpy as np
from unit.motion.motion_files import at2

HEAD = (
    "Result ID, Spectral Ordinate, Record Sequence Number, Mean Squared Error, Scale Factor, "
    "Tp-Pulse Period (sec), 5-75% Duration (sec), 5-95% Duration (sec), Arias Intensity (m/sec), "
    "Earthquake Name, Year, Station Name, Magnitude, Mechanism, Rjb (km), Rrup (km), Vs30 (m/sec), "
    "Lowest Useable Frequency (Hz), Initial-search Scale Factor, Horizontal-1 Acc. Filename, "
    "Horizontal-2 Acc. Filename, Vertical Acc. Filename"
)


@dataclass(frozen=True)
class Station:
    """A record of three components in a download."""

    number: int
    event: str
    magnitude: float
    distance: float  # km
    velocity: float  # m/s
    pulse: str = "-"
    vertical: bool = True

    @property
    def stem(self) -> str:
        return f"RSN{self.number}_MADE_S{self.number}"

    @property
    def files(self) -> tuple[str, ...]:
        ends = ("000", "090", "-UP")[: 3 if self.vertical else 2]
        return tuple(f"{self.stem}{end}.AT2" for end in ends)

    @property
    def row(self) -> str:
        upwards = f"{self.files[2]}  " if self.vertical else " -----   "
        return (
            f"{self.number}, SRSS, {self.number}, 0.4768, 1.0, {self.pulse}, 17.7, 24.2, 1.6, "
            f'"{self.event}", 1940, "Station {self.number}", {self.magnitude}, strike slip, '
            f"{self.distance}, {self.distance + 1}, {self.velocity}, 0.25, 1.0, {self.files[0]}, "
            f"{self.files[1]} , {upwards}"
        )


STATIONS = (
    Station(6, "Valley-02", 6.95, 6.09, 213.44),
    Station(14, "County, North", 7.36, 81.3, 514.99, pulse="4.4"),
    Station(78, "Valley-02", 5.6, 24.16, -999, vertical=False),
)


def noise(seed: int, count: int = 400) -> np.ndarray:
    """Samples that seven printed digits hold exactly [g]."""
    values = np.random.default_rng(seed).normal(size=count)
    fade = np.exp(-(((np.arange(count) - 0.3 * count) / (0.2 * count)) ** 2))
    return np.round(0.1 * fade * np.convolve(values, np.ones(3), mode="same"), 7)


def record(station: Station, place: int) -> bytes:
    """The AT2 file of a component."""
    component = ("0", "90", "UP")[place]
    event = f"{station.event.replace(',', '')}, 5/19/1940, Station {station.number}, {component}"
    values = noise(10 * station.number + place)
    return at2(f"NPTS=   {values.size}, DT=   .0100 SEC,", values, event=event).encode()


def table(stations=STATIONS) -> bytes:
    """``_SearchResults.csv``."""
    lines = [
        "",
        " PEER Ground Motion Database, Time Series Search Report -- NGA-West2 -- 2025-12-30",
        "",
        " -- Summary of PEER Ground Motion Database Search Criteria --",
        "Magnitude Min:, 0.0",
        "",
        " -- Summary of Metadata of Selected Records --",
        HEAD,
        *(station.row for station in stations),
        "",
        " These records are UNSCALED, AS RECORDED",
        " -- Scaled Spectra used in Search & Scaling --",
        "Period (sec),Target pSa (g)",
        "0.1,0.5",
    ]
    return "\n".join(lines).encode()


def download(stations=STATIONS) -> dict[str, bytes]:
    """The files of a download, by their names."""
    files = {"_SearchResults.csv": table(stations), "Disclaimer.pdf": b"%PDF-1.4\x00\xff"}
    for station in stations:
        for place, name in enumerate(station.files):
            files[name] = record(station, place)
            files[name.replace(".AT2", ".VT2")] = b"velocity"
    return files


def packed(files: dict[str, bytes]) -> bytes:
    """Files as a zip archive."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return buffer.getvalue()
