"""Codes of the COSMOS format that decide how a file is read.

Reference: "COSMOS Strong Motion Data Format", version 1.20, August 15, 2001: the
tables of physical parameters, units and sensor orientations.
"""

from __future__ import annotations

from typing import Final

from rockframe.records.orientation import DOWNWARDS, UPWARDS, VERTICAL, Orientation

MILLISECOND: Final = 1e-3

ACCELERATION: Final = 1
"""Integer header 2 of an acceleration."""

QUANTITIES: Final = {
    2: "a velocity",
    3: "a displacement",
    4: "a relative displacement",
    10: "an angular acceleration",
    11: "an angular velocity",
    12: "an angular displacement",
    20: "a pressure",
    21: "a pressure",
    30: "a strain",
    31: "a strain",
}
"""Integer header 2: what else a series can be."""

UNITS: Final = {
    2: "g",
    4: "cm/sec^2",
    5: "cm/sec",
    6: "cm",
    7: "in/sec^2",
    8: "in/sec",
    9: "in",
    10: "gal",
    11: "mg",
    12: "micro g",
    50: "counts",
    51: "volts",
}
"""Integer header 3, and the number behind ``units=``."""

ORIENTATIONS: Final = {
    400: Orientation(vertical=UPWARDS),
    401: Orientation(vertical=DOWNWARDS),
    402: Orientation(vertical=VERTICAL),
}
"""Integer header 54, where it is no azimuth from 1 to 360 degrees."""
