"""A small synthetic file of every text format, and its expected contents."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from unit.motion import dialect_samples as dialects
from unit.motion.dialect_samples import COUNT, TENTHS, VALUES, peak
from unit.motion.motion_files import G, at2, numbers, rows

COUNTS = np.round(1e4 * numbers(COUNT)).astype(int) - 12085


@dataclass(frozen=True)
class Sample:
    """A file and its expected contents."""

    format: str
    name: str
    data: bytes
    time_step: float
    samples: np.ndarray  # m/s^2
    component: str | tuple[str, str] | None = None
    named: str | None = None

    def write(self, folder: Path) -> Path:
        path = folder / self.name
        path.write_bytes(self.data)
        return path


def cosmos_block(
    kind: str,
    values,
    *,
    chan: str = "  1: 360 Deg",
    azimuth: int = 360,
    quantity: int = 1,
    unit: str = "cm/sec2(04)",
    code: int = 4,
    milliseconds: float = 10.0,
    form: str = "{:10.3f}",
    layout: str = "8F10.3",
    scnl: str = "",
    length: float | None = None,
    count: int | None = None,
) -> str:
    """One channel and quantity of a COSMOS file."""
    per_line = int(layout.split("F")[0].split("E")[0].split("I")[0])
    integers = [-999] * 100
    integers[0:3] = [2, quantity, code]
    integers[53] = azimuth
    reals = [-999.0] * 100
    announced = len(values) if count is None else count
    reals[61:63] = [milliseconds, announced * milliseconds / 1e3 if length is None else length]
    text = [
        f"Corrected {kind}    (Format v01.20 with 13 text lines)",
        "Record of Made Up Earthquake of Fri Nov 30, 2018 17:29 UTC",
        "Hypocenter: 61.34640 -149.95520 H= 46km Mw=7.0",
        "Origin: 2018/11/30 17:29:29    UTC",
        "Statn No: 37-000011 Code:XX-MADE    XXXX  Made Up River",
        "Coords: 60.9677 -144.6051  Site geology:",
        "Recorder: (see cmnt)      ( 3 Chns of   3 at Sta) Sensor: (see comment)",
        "Rcrd start time: 2018/11/30 17:29:39.137 UTC (Q=5) RcrdId: (see comment)",
        f"Sta Chan {chan} (Rcrdr Chan  ?) Location:",
        "Raw record length = 210.000 sec, Uncor max =    101730, at  82.680 sec.",
        "Processed:2019-03-03 05:46:55 GMT, UNKN, Max =   -6.852 cm/sec2 at   76.215 sec",
        "Record filtered below  0.03 Hz (periods over 33.33 secs), and above 20.0 Hz",
        "Values used when parameter or data value is unknown/unspecified:   -999, -999.00",
    ]
    comments = ["| made up", *([f"|<SCNL>{scnl}    <AUTH> 2019/02/01"] if scnl else [])]
    return (
        "\n".join(text)
        + "\n 100 Integer-header values follow on  10 lines, Format= (10I8)\n"
        + rows(integers, 10, "{:8d}")
        + " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n"
        + rows(reals, 5, "{:15.6f}")
        + f'   {len(comments)} Comment line(s) follow, each starting with a "|":\n'
        + "\n".join(comments)
        + f"\n   {announced} {kind} pts, approx  210 secs, units={unit},Format=({layout})\n"
        + rows(values, per_line, form)
        + f"End-of-data for Chan  1 {kind}\n"
    )


def cosmos() -> str:
    """Two channels, the first with its velocity."""
    return (
        cosmos_block("acceleration", VALUES["N"])
        + cosmos_block("velocity", VALUES["E"], quantity=2, unit="cm/sec(05)", code=5)
        + cosmos_block("acceleration", VALUES["U"], chan="  2: Up", azimuth=400)
    )


def csmip_channel(volume: int, values, *, channel: int, name: str, step: str = ".010") -> str:
    """One channel of a CSMIP file."""
    count = len(values)
    head = [
        *(
            [f"CORRECTED ACCELEROGRAM   00000-A0000  CHAN  {channel}: {name:10} FROM"]
            * (volume == 2)
        ),
        "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 06/16/98, MADE UP",
        "MADE UP EARTHQUAKE",
        "15 OCT 1979 - 2317 UTC",
        "00000-A0000-79290.04",
        "STATION NO. 12345   32.773N, 115.448W     CRA-1  S/N 0164",
        "SOMEWHERE - SOME BRIDGE",
        f"CHAN  {channel}: {name:10}  (STA CHN:  1)     LOCATION: FOOTING",
        f"AT EQUALLY-SPACED INTERVALS OF    {step}  SEC.",
    ]
    if volume == 1:
        announced = f"{count} POINTS OF ACCEL DATA EQUALLY SPACED AT {step} SEC.  (UNITS: G)\n"
        body = announced + rows(values, 8, "{:9.6f}")
    else:
        body = "".join(
            f" {count} points of {kind} data equally spaced at {step} sec, in {unit}. (8f10.3)\n"
            + rows(data, 8, "{:10.3f}")
            for kind, unit, data in (
                ("accel", "cm/sec2", values),
                ("veloc", "cm/sec", VALUES["E"]),
                ("displ", "cm", VALUES["E"]),
            )
        )
    integers = rows([0] * 100, 16, "{:5d}")
    reals = rows([0.0] * (50 if volume == 1 else 100), 8, "{:10.3f}")
    end = f"/&  ----------  END OF DATA FOR CHANNEL  {channel}  ----------\n"
    return "\n".join(head) + "\n" + integers + reals + body + end


def csmip(volume: int) -> str:
    """Three channels."""
    scale = 1.0 if volume == 2 else 1e-3
    return "".join(
        csmip_channel(volume, scale * VALUES[key], channel=channel, name=name)
        for channel, (key, name) in enumerate((("N", "360 DEG"), ("U", "UP"), ("E", "90 DEG")), 1)
    )


def smc(
    values=VALUES["N"],
    *,
    kind: str = "2 CORRECTED ACCELEROGRAM",
    rate: float = 100.0,
    slope: int = 90,
    azimuth: int = 360,
    comments: int = 2,
    count: int | None = None,
    problem: int = -32768,
    name: str = "360",
) -> str:
    """A USGS SMC file."""
    integers = [-32768] * 48
    integers[12:18] = [
        slope,
        azimuth,
        101,
        comments,
        len(values) if count is None else count,
        problem,
    ]
    reals = [1.7e38] * 50
    reals[1] = rate
    text = [
        kind,
        "*",
        "MADE",
        "     1989  10  18    0004 Made Up, CA",
        "Moment Mag=      7.1 Ms=      7.1 Ml=      7.0",
        f"station = Some Place, 1295 Street, F component=    {name}",
        "epicentral dist =     89.0       pk     =    104.4",
        "inst type=SMA-1      data source = USGS",
        *["*"] * 3,
    ]
    return (
        "\n".join(text)
        + "\n"
        + rows(integers, 8, "{:10d}")
        + rows(reals, 5, "{:15.7E}")
        + "|made up\n" * comments
        + rows(values, 8, "{:10.3f}")
    )


def esm(values=VALUES["E"], **changed: str) -> str:
    """An ESM file."""
    header = {
        "EVENT_NAME": "MADE UP",
        "EVENT_ID": "XX-1",
        "EVENT_DATE_YYYYMMDD": "20190728",
        "EVENT_TIME_HHMMSS": "160908",
        "MAGNITUDE_W": "",
        "NETWORK": "XX",
        "STATION_CODE": "MADE",
        "STATION_NAME": "Some: Place",
        "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS": "20190728_160919.870",
        "SAMPLING_INTERVAL_S": "0.010000",
        "NDATA": str(len(values)),
        "DURATION_S": "0.6",
        "STREAM": "HNE",
        "UNITS": "cm/s^2",
        "BASELINE_CORRECTION": "BASELINE REMOVED",
        "DATABASE_VERSION": "DYNA 1.0",
        "HEADER_FORMAT": "DYNA 1.2",
        "DATA_TYPE": "ACCELERATION",
        **changed,
        "USER5": "",
    }
    head = "".join(f"{key}: {value}\n" for key, value in header.items())
    return head + "".join(f"{value:.6f}\n" for value in values)


def knet(counts=COUNTS, **changed: str) -> str:
    """A K-NET file."""
    calibrated = (counts - counts.mean()) * 3920.0 / 6182761.0
    header = {
        "Origin Time": "2018/01/24 19:51:00",
        "Lat.": "41.0",
        "Long.": "142.5",
        "Depth. (km)": "30",
        "Mag.": "6.2",
        "Station Code": "MADE01",
        "Station Lat.": "41.4087",
        "Station Long.": "141.4486",
        "Station Height(m)": "30",
        "Record Time": "2018/01/24 19:51:37",
        "Sampling Freq(Hz)": "100Hz",
        "Duration Time(s)": f"{len(counts) / 100}",
        "Dir.": "E-W",
        "Scale Factor": "3920(gal)/6182761",
        "Max. Acc. (gal)": f"{abs(calibrated).max():.3f}",
        "Last Correction": "2018/01/24 19:51:37",
        "Memo.": "",
        **changed,
    }
    head = "".join(f"{key:18}{value}\n" for key, value in header.items())
    lines = [counts[k : k + 8] for k in range(0, len(counts), 8)]
    return head + "".join(" ".join(f"{count:8d}" for count in line) + " \n" for line in lines)


def geonet_component(values, *, name: str, azimuth: int, corrected: bool = True, **layout) -> str:
    """One component of a GeoNet file."""
    count = layout.get("count", len(values))
    integers = [0] * 40
    integers[8:10] = [2018, 2]
    integers[18:20] = [12, 21]
    integers[26:36] = [
        196,
        azimuth,
        195,
        13,
        count,
        0,
        0,
        *([count, 5, 12] if corrected else [0] * 3),
    ]
    integers[38:40] = [15, 17000]
    reals = [0.0] * 60
    reals[24:26] = [0.005, layout.get("step", 0.02)]
    word = "Corrected" if corrected else "Uncorrected"
    text = [
        f"{word} accelerogram 20180212_211554_MADE_20 GNS Science",
        "Site MADE      39 56 38S  176 35 04E     Basalt file:  20180212_211557_MADE",
        "Made Up Council",
        "Instrument Basalt_2413",
        "Resolution: 24-bit   Instr Period: 0.0050 s   Damping: 0.700",
        "Accelerogram 20180212_211554_MADE_20                 Processed 2018 February 21",
        "6 km south of Nowhere",
        "2018 February 12         21:15:54 UT",
        "Epicentre  40 03 27S 176 32 45E  Bearing S15W  Dist   13km  Depth    9km M  4.17",
        f"Number of points  {count}    Duration 1.2 sec",
        "Instrument corrected data at 0.020 sec intervals",
        "Band-pass filter transition bands are .10-.25 Hz and 24.50-25.50 Hz",
        f"Component {name:5} Some Accelerometer Axis",
        f"Acceleration:  peak {layout.get('peak', peak(values)):8.1f} mm/s/s at  43.68 sec"
        "     rms      2.2 mm/s/s",
        "Velocity:      peak     1.65 mm/s   at  43.56 sec     rms     0.09 mm/s",
        "Displacement:  peak    0.131 mm     at  43.66 sec     rms    0.007 mm",
    ]
    rest = rows(range(5), 10, "{:8.2f}") + rows(range(12), 10, "{:8.3f}") if corrected else ""
    return (
        "\n".join(text)
        + "\n"
        + rows(integers, 10, "{:8d}")
        + rows(reals, 10, "{:8.4f}")
        + rows(values, 10, "{:8.1f}")
        + rest
    )


def geonet(*, corrected: bool = True) -> str:
    """Three components."""
    return "".join(
        geonet_component(
            np.round(10.0 * VALUES[key], 1), name=name, azimuth=azimuth, corrected=corrected
        )
        for key, name, azimuth in (("N", "S16W", 196), ("E", "S74E", 106), ("U", "Up", 0))
    )


def cwa(
    *, sequence: str = "Time U(+); N(+); E(+)", layout: str = "4F10.3", rate: str = "50"
) -> str:
    """A file of Taiwan's Central Weather Administration."""
    head = [
        "#Earthquake Information",
        "#Origin Time(GMT+08): 2018/02/06-23:50:42",
        "#Magnitude(Ml): 6.0",
        "",
        "#Station Information",
        "#StationCode: MADE",
        "#StationName: Made Up",
        "#InstrumentKind: FBA",
        "#StartTime(GMT+08): 2018/02/06-23:50:29.000",
        f"#RecordLength(sec): {COUNT / 50}",
        f"#SampleRate(Hz): {rate}",
        "#AmplitudeUnit:  gal. DCoffset(corr)",
        f"#AmplitudeMAX. U: {max(VALUES['U']):8.3f}~ {min(VALUES['U']):8.3f}",
        f"#DataSequence: {sequence}",
        f"#Data: {layout} ",
    ]
    table = np.column_stack([0.02 * np.arange(COUNT), VALUES["U"], VALUES["N"], VALUES["E"]])
    return "\n".join(head) + "\n" + rows(table.ravel(), 4, "{:10.3f}")


def _text_samples() -> dict[str, Sample]:
    values = numbers(COUNT)
    table = "time (s),acceleration (g)\n" + "".join(
        f"{k * 0.01:.2f},{value:.7f}\n" for k, value in enumerate(values)
    )
    north, east, up = (VALUES[key] * 0.01 for key in ("N", "E", "U"))
    calibrated = (COUNTS - COUNTS.mean()) * (3920.0 / 6182761.0) * 0.01
    tenths = {key: np.round(10.0 * value, 1) * 0.001 for key, value in VALUES.items()}
    files = {
        "at2": (
            "peer-at2",
            "s.AT2",
            at2(f"NPTS= {COUNT}, DT= .01 SEC", values),
            0.01,
            values * G,
            None,
            "67",
        ),
        "csv": ("text", "s.csv", table, 0.01, values * G),
        "cosmos": ("cosmos", "s.V2c", cosmos(), 0.01, north, None, "360 Deg"),
        "csmip2": ("csmip", "s.V2", csmip(2), 0.01, east, "E", "90"),
        "csmip1": (
            "csmip",
            "s.V1",
            csmip(1),
            0.01,
            np.round(1e-3 * VALUES["U"], 6) * G,
            "channel 2",
            "UP",
        ),
        "smc": ("smc", "s.smc", smc(), 0.01, north, None, "360"),
        "esm": ("esm", "s.ASC", esm(), 0.01, east, None, "HNE"),
        "knet": ("k-net", "s.EW", knet(), 0.01, calibrated, None, "E-W"),
        "kiknet": ("k-net", "s.UD2", knet(**{"Dir.": "6"}), 0.01, calibrated, "U", "UD2"),
        "geonet2": ("geonet", "s.V2A", geonet(), 0.02, tenths["E"], "S74E", "S74E"),
        "geonet1": ("geonet", "s.V1A", geonet(corrected=False), 0.02, tenths["N"], "196", "S16W"),
        "cwa": ("cwa", "s.dat", cwa(), 0.02, north, "N", "N"),
        "cwa pair": ("cwa", "p.dat", cwa(), 0.02, east, ("E", "U"), "E"),
    }
    tenths_of_g = {key: 0.1 * G * values for key, values in TENTHS.items()}
    thousandths = {key: np.round(1e-3 * values, 6) * G for key, values in VALUES.items()}
    marked = np.round(values, 5)
    files |= {
        "at2 marked": ("peer-at2", "m.AT2", dialects.marked_at2(marked), 0.01, marked * G),
        "cgs": ("csmip", "c.V1", dialects.cgs(), 0.01, thousandths["E"], "E", "90"),
        "usc": ("csmip", "u.s0a", dialects.usc(), 0.01, east, None, "N08W"),
        "usc no unit": ("csmip", "u.s0b", dialects.usc(unit=""), 0.01, east, None, "N08W"),
        "pairs": ("csmip", "p.v1", dialects.pairs(), 0.01, tenths_of_g["N"], "NS", "NS"),
        "itaca": ("esm", "i.DAT", dialects.itaca(), 0.01, east, None, "WE"),
        "afad": ("afad", "a.txt", dialects.afad(), 0.01, east, "E", "E-W"),
        "bhrc": ("bhrc", "b.V1", dialects.bhrc(), 0.01, tenths_of_g["E"], "140", "T3"),
        "csmnc": ("csmnc", "d.dat", dialects.csmnc(), 0.01, east, None, "EW"),
        "resorce": ("resorce", "r.cor.acc", dialects.resorce(), 0.01, north, None, "NS"),
        "unam": ("unam", "u.012", dialects.unam(), 0.01, north, "S", "S00E"),
        "columns": ("text", "3.csv", dialects.three_columns(), 0.01, east, "E", "E"),
    }
    assert up.size == COUNT
    return {
        key: Sample(entry[0], entry[1], entry[2].encode(), *entry[3:])
        for key, entry in files.items()
    }


SAMPLES = _text_samples()
