"""Small synthetic files in the dialects of agencies, from their format descriptions."""

from __future__ import annotations

import struct

import numpy as np
from unit.motion.motion_files import numbers, rows

COUNT = 61
VALUES = {name: np.round(300.0 * numbers(COUNT)[::step], 3) for name, step in (("N", 1), ("U", -1))}
VALUES["E"] = np.round(0.5 * VALUES["N"] + 0.25 * VALUES["U"], 3)  # cm/s^2
TENTHS = {name: np.round(values / 98.0665, 3) for name, values in VALUES.items()}  # g/10


def peak(values) -> float:
    return float(np.abs(values).max())


def cgs(*, points: str = "{count} Accelerogram points at 100 pts/sec in units of g .") -> str:
    """A CSMIP file of volume 1 as the California Geological Survey writes it."""
    channels: list[str] = []
    for channel, (key, name) in enumerate((("N", "360 Deg"), ("U", "Up"), ("E", "90 Deg")), 1):
        values = np.round(1e-3 * VALUES[key], 6)
        head = [
            "Uncorrected Accelerogram Data             Processed: 02/13/12, CGS  146be002",
            "Record of Mon Feb 13, 2012 13:06:45.0 PST             (Avol1 v9.2,12/11 CSMIP)",
            "CSMIP Preliminary Processing            (Origin:  To be determined)",
            "89146-L2500-12044.02                 Start time:  2/13/12, 21:06:45.0 UTC (GPS)",
            "Station No. 89146   40.941N, 123.633W      Etna  s/n 2500  (3 Chns of  3 at Sta)",
            "Willow Creek                              CGS",
            f"Chan  {channel}: {name}",
            "Made Up Earthquake of 13 Feb 2012",
            "No. of Points =     61  Record Length =   .610 sec   at 100 Samples/sec",
            "Units of uncor data are sec and g .        "
            f"Max  ={peak(values):7.3f} g , at   .5 sec.",
        ]
        channels.append(
            "\n".join(head)
            + "\n"
            + rows([0] * 100, 16, "{:5d}")
            + rows([0.0] * 50, 8, "{:9.6f} ")
            + f" {points.format(count=COUNT)}      Format: (8f9.6)\n"
            + rows(values, 8, "{:9.6f}")
            + f"/&  ----------  End of Data for Channel  {channel}  ----------\n"
        )
    return "".join(channels)


def usc(*, unit: str = "IN UNITS CM/SEC/SEC", stated: float | None = None) -> str:
    """A file of the University of Southern California, volume 2."""
    values = VALUES["E"]
    stated = peak(values) if stated is None else stated
    head = [
        "CORRECTED ACCELEROGRAM  IIBB127  94.610.0 COMP N08W   FILE   0  CORRESPONDING TO",
        "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:",
        "MADE UP EARTHQUAKE                                                      21",
        "JAN 17, 1994 -1230 GMT                                                  22",
        "IBB127  94.610.0 N                                                      18",
        "STATION USC# 0061   34 17 11N, 118 13 31W                               39",
        "SOME STATION, SOME FOREST, CA                                           29",
        "COMP N08W                                                               9",
        "NO. OF POINTS =    999      DURATION =    .600 SEC                      50",
        "AT EQUALLY-SPACED INTERVALS OF    .010  SEC.",
        f"PEAK ACCELERATION = {stated:10.5f}  CMS/SEC/SEC AT    4.580   SEC.",
    ]
    blocks = "".join(
        f"{COUNT:6d} POINTS OF {kind} DATA EQUALLY SPACED AT   .010 SEC.  {unit_text}\n"
        + rows(data, 8, "{:10.3f}")
        for kind, unit_text, data in (
            ("ACC", unit, values),
            ("VEL", "IN UNITS CM/SEC", VALUES["N"]),
        )
    )
    reals = rows([0.0] * 100, 8, "{:10.3f}")
    return "\n".join(head) + "\n" + rows([0] * 100, 16, "{:5d}") + reals + blocks


def pairs(
    *,
    times=None,
    event: str = "MADE UP EARTHQUAKE",
    first: str = "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 06/30/2011",
    indent: str = "",
) -> str:
    """Volume 1 as pairs of time and acceleration, as of RENADIC."""
    times = 0.01 * np.arange(COUNT) if times is None else times
    channels: list[str] = []
    for channel, (key, name) in enumerate((("E", "EW"), ("U", "UP"), ("N", "NS")), 1):
        values = TENTHS[key]
        head = [
            first,
            event,
            "11/12/2009 23:09:53 (GMT)               (ORIGIN: 11/12/2009 23:09:53 GMT)",
            "STATION NO. 77       0.000N    0.000E  QDR       S/N  673 (3  CHNS OF 3  AT STA)",
            "QDR S/N 673",
            f"CHAN  {channel}: {name}",
            f"NO. OF POINTS =   {COUNT}  RECORD LENGTH =  0.600 SEC",
            "UNITS OF UNCOR ACCEL ARE SEC AND G/10.     "
            f"MAX  ={0.1 * peak(values):7.4f} G, AT   1.0",
            "RMS ACCEL OF COMPLETE RECORD = 0.010 G",
        ]
        table = rows(np.column_stack([times, values]).ravel(), 10, "{:7.3f}")
        channels.append(
            "\n".join(head)
            + "\n"
            + rows([0] * 100, 16, "{:5d}")
            + rows([0.0] * 50, 8, "{:10.3f}")
            + "".join(f"{indent}{line}\n" for line in table.splitlines())
            + f"/&  ----------  END OF DATA FOR CHANNEL {channel}  ----------\n"
        )
    return "".join(channels)


def itaca(**changed: str) -> str:
    """A file of ITACA before DYNA 1.0."""
    values = VALUES["E"]
    header = {
        "EVENT_NAME": "MADE UP",
        "EVENT_DATE_YYYYMMDD": "19971014",
        "EVENT_TIME_HHMMSS": "152309",
        "STATION_CODE": "MADE",
        "STATION_NAME": "SOME PLACE",
        "SAMPLING_INTERVAL_S": "0.010000",
        "NDATA": str(COUNT),
        "DURATION_S": "0.600",
        "COMPONENT": "WE",
        "UNITS": "cm/s^2",
        "PGA_CM/S^2": f"{-peak(values):.6f}",
        "TIME_PGA_S": "0.1",
        "DATA_VERSION": "ITACA 1.1",
        "DATA_TYPE": "UNPROCESSED ACCELERATION",
        **changed,
    }
    head = "".join(f"{key}: {value}\n" for key, value in header.items())
    return head + "".join(f"{value:.6f}\n" for value in values)


def marked_at2(values, *, end: str = "*** End Data ***\n\n") -> str:
    """An AT2 file with markers around header and data."""
    return (
        "Made up\nThe units are (g)\n*** Begin data ***\n"
        f"NPTS= {len(values)}, DT= .01000 SEC\n" + rows(values, 8, "{:10.5f}") + end
    )


def afad(**changed: str) -> str:
    """A file of AFAD, Turkey, in three columns."""
    tops = [f"({name}) {peak(VALUES[key]):.6f}" for key, name in zip("NEU", NAMES, strict=True)]
    header = {
        "PLACE": "SOMEWHERE",
        "EARTHQUAKE DATE": "2017/07/20 22:31:09 (GMT)",
        "STATION ID": "4801",
        "RECORDER TYPE": "made up",
        "RECORD TIME": "20/07/2017 22:31:14.000000 (GMT)",
        "NUMBER OF DATA": str(COUNT),
        "SAMPLING INTERVAL (sec)": "0.01",
        "RAW PGA VALUES (gal)": " ".join(tops),
        **changed,
    }
    head = "".join(f"{key:24}: {value}\n" for key, value in header.items())
    table = np.column_stack([VALUES[key] for key in "NEU"])
    body = rows(table.ravel(), 3, "{:14.6f}")
    return f"STRONG GROUND MOTION RECORDS\n{head}Copyright\n       N-S   E-W   U-D\n{body}"


NAMES = ("N-S", "E-W", "U-D")


def bhrc(*, rate: float = 100.0, volume: int = 1) -> str:
    """A file of BHRC, Iran."""
    channels: list[str] = []
    for key, name in (("N", "L1"), ("U", "V2"), ("E", "T3")):
        reals = [0.02, 0.64, 0.61, 0.0, 0.1, 0.0, rate, *[0.0] * 31]
        head = [
            f"* VOL{volume}DS FILE:  5526/01",
            "Inst Type = SSA-2",
            "Origin Time : 2012/08/11   12:23:16",
            "",
            name[0],
            "",
            f"COMP {name}",
            "Made Up                   Station   37.734 N 47.801 E   Azimuth L 50    T 140",
            "Epicenter 38.520 N 46.860 E",
            "INSTR PERIOD =  .020 SEC   DAMPING =  .640",
            f"NO. OF POINTS =   {COUNT}      DURATION =    .610",
            "UNITS ARE SECONDS AND G/10",
            "",
        ]
        channels.append(
            "\n".join(head)
            + "\n"
            + rows([0] * 94, 14, "{:5d}")
            + "".join(f"{line[:70]}\n" for line in rows(reals, 6, "{:13.6E}").splitlines())
            + rows(TENTHS[key], 10, "{:13.6E}")
            + "/&\n"
        )
    return "".join(channels)


def csmnc(*, kind: str = "UNCORRECTED ACCELERATION", unit: str = "CM/SEC/SEC") -> str:
    """A file of the China Strong Motion Networks Centre."""
    values = VALUES["E"]
    head = [
        "065XYZ120103153901",
        "0120103153957 2012-01-03 15:39:57 BTM",
        "MADE UP EARTHQUAKE, SOMEWHERE,CHN",
        "EPICENTER  39.939N 77.339E DEPTH 9 KM",
        "MAGNITUDE  4.0(Ms)",
        "STATION: 65XYZ 39.700N 77.599E",
        "SITE CONDITION: SOIL",
        "COMP. EW",
        f"{kind}          UNIT: {unit}",
        f"NO. OF POINTS:  {COUNT}  EQUALLY SPACED INTERVALS OF:  0.01  SEC",
        f"PEAK VALUE:    {-peak(values):.3f}   AT   27.06 SEC    DURATION:  0.61 SEC",
        "PRE-EVENT TIME:  20  SEC  RECORDER TIME:  2012-01-3 15:39:44.000 BTM",
        "CSMNC",
        "",
    ]
    return "\n".join(head) + "\n" + rows(values, 8, "{: .6E} ")


def resorce(*, count: int = COUNT, unit: str = "m/s/s") -> str:
    """A file of RESORCE, with adjoining numbers."""
    values = 0.01 * VALUES["N"]
    head = [
        "Event Date & Time             : 2009-04-06 01:32:39",
        "Station Code / Name           : 3623 / Some Place, Italy",
        "Network                       : Made Up",
        "Orientation                   : NS",
        "Processing Info               : none",
        "Time Increment (s)            : 0.01",
        f"Number of Data                : {count}",
        f"PGA (m/s/s)                   : {peak(values):.7E}",
        f"Accelaration time series in {unit}",
    ]
    return "\n".join(head) + "\n" + rows(values, 5, "{:14.7E}")


def unam(*, orientations: str = "/V/N90E/S00E", step: str = "0.01") -> str:
    """A standard acceleration file (ASA), Mexico."""
    order = ("U", "E", "N")
    tops = "".join(f"/{peak(VALUES[key]):.3f}" for key in order)
    keys = {
        "VERSION DEL FORMATO": "2.0",
        "NOMBRE DE LA ESTACION": "SOME PLACE",
        "CLAVE DE LA ESTACION": "MADE",
        "MODELO DEL ACELEROGRAFO": "MADE UP",
        "ORIENTACION C1-C6 (rumbo;orientacion)": orientations,
        "ORIENTACION C7-C12 (rumbo;orientacion)": "",
        "INTERVALO DE MUESTREO, C1-C6 (s)": f"/{step}" * 3,
        "FECHA DEL SISMO [GMT]": "2004/01/01",
        "HORA EPICENTRO (GMT)": "23:58:02.7",
        "HORA DE LA PRIMERA MUESTRA (GMT)": "00:00:01",
        "DURACION DEL REGISTRO (s), C1-C6": "/0.61" * 3,
        "NUM. TOTAL DE MUESTRAS, C1-C6": f"/{COUNT}" * 3,
        "ACEL. MAX.(Gal), C1-C6": tops,
        "ACEL. MAX., C1-C6, EN LA MUESTRA": "/1/1/1",
        "UNIDADES DE LOS DATOS": "Gal (cm/s/s)",
        "FORMATO DATOS (FORTRAN,10 campos/dato)": "3F10.3",
    }
    rule = "---------+" * 8
    title = "   CANAL-1   CANAL-2   CANAL-3\n         V      N90E      S00E"
    table = np.column_stack([VALUES[key] for key in order])
    return (
        "ARCHIVO ESTANDAR DE ACELERACION:\n"
        + "".join(f"{key:39}: {value}\n" for key, value in keys.items())
        + f"DATOS DE ACELERACION:\n{rule}\n{title}\n{rule}\n"
        + rows(table.ravel(), 3, "{:10.3f}")
    )


def three_columns(separator: str = ",") -> str:
    """A table of three components in two units and a velocity."""
    names = separator.join(("time (s)", "N (mm/s^2)", "E (cm/s^2)", "U (cm/s^2)", "vN (cm/s)"))
    lines = [
        separator.join(
            (
                f"{0.01 * k:.2f}",
                f"{10.0 * VALUES['N'][k]:.2f}",
                f"{VALUES['E'][k]:.3f}",
                f"{VALUES['U'][k]:.3f}",
                "0.1",
            )
        )
        for k in range(COUNT)
    ]
    return "\n".join([names, *lines]) + "\n"


def sac(
    values=VALUES["E"],
    *,
    order: str = "<",
    kind: int = 8,
    step: float = 0.01,
    azimuth: float = 90.0,
    incidence: float = 90.0,
    even: int = 1,
    count: int | None = None,
    channel: str = "HNE",
) -> bytes:
    """A SAC file: 70 floats, 40 integers, 192 characters, then the samples."""
    floats = [-12345.0] * 70
    floats[0:3] = [step, float(min(values)), float(max(values))]
    floats[5:7] = [0.0, (len(values) - 1) * step]
    floats[57:59] = [azimuth, incidence]
    integers = [-12345] * 40
    integers[0:6] = [2018, 24, 10, 51, 0, 0]
    integers[6] = 6
    integers[9] = len(values) if count is None else count
    integers[15:17] = [1, kind]
    integers[35] = even
    words = [b"-12345".ljust(8)] * 24
    words[0], words[20], words[21] = b"MADE\x00   ", channel.encode().ljust(8), b"XX".ljust(8)
    return (
        struct.pack(f"{order}70f40i", *floats, *integers)
        + b"".join(words)
        + struct.pack(f"{order}{len(values)}f", *np.asarray(values).tolist())
    )
