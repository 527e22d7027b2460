"""Which way a component points, from the names that record files give it."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Final, Literal

UPWARDS: Final = "up"
DOWNWARDS: Final = "down"
VERTICAL: Final = "vertical"

_FULL_CIRCLE: Final = 360.0
_COMPASS: Final = {
    **dict.fromkeys(("n", "ns", "n-s", "sn", "north"), 0.0),
    **dict.fromkeys(("e", "ew", "e-w", "we", "east"), 90.0),
    **dict.fromkeys(("s", "south"), 180.0),
    **dict.fromkeys(("w", "west"), 270.0),
}
_UPWARDS: Final = frozenset(("u", "up", "ud", "u-d", "updo", "updn", "updown", "up-down", "z"))
_DOWNWARDS: Final = frozenset(("d", "down", "dwn", "dn"))
_VERTICAL: Final = frozenset(("v", "vert", "ver", "vertical", "vrt"))
_DEGREES: Final = re.compile(r"(\d{1,3}(?:\.\d{0,3})?)\s*(?:deg(?:rees?)?\.?)?", re.ASCII)
_QUADRANT: Final = re.compile(r"([ns])\s*(\d{1,2})\s*([ew])", re.ASCII)
# band code, N for an accelerometer (or L, G, H: a mass or a seismometer), orientation; some write
# the code of the sensor's location behind them
_SEED: Final = re.compile(r"[fgdceshbml][nlgh]([nez])(?:[. _-]?(?:\d0|0\d|--))?", re.ASCII)
_NUMBERED: Final = re.compile(r"([a-z-]+?)[. _-]?\d{1,2}", re.ASCII)


@dataclass(frozen=True)
class Orientation:
    """Direction in which a component is positive."""

    azimuth: float | None = None  # of a horizontal component, clockwise from north [degree]
    # ``"up"``, ``"down"`` or, if the file does not say which, ``"vertical"``
    vertical: Literal["up", "down", "vertical"] | None = None

    def matches(self, other: Orientation) -> bool:
        """Tell whether two directions are the same, or both vertical."""
        if self.vertical is not None and other.vertical is not None:
            return True
        if self.azimuth is None or other.azimuth is None:
            return False
        turn = (self.azimuth - other.azimuth) % _FULL_CIRCLE
        return min(turn, _FULL_CIRCLE - turn) < 1e-6

    def __str__(self) -> str:
        if self.vertical is not None:
            return self.vertical
        return "" if self.azimuth is None else f"{self.azimuth:g} degrees"


UNKNOWN: Final = Orientation()


def orientation_of(name: str) -> Orientation:
    """Read a direction from the name of a component.

    Parameters
    ----------
    name : str
        ``N``, ``E-W``, ``UP``, ``V1``, ``090``, ``360 DEG``, ``S16W``, ``HNE``, ``HNZ.00``, ...

    Returns
    -------
    Orientation
        Without azimuth and vertical if the name tells neither.

    Notes
    -----
    Azimuths run clockwise from north; ``S16W`` is 16 degrees from south towards
    west, 196. In a SEED channel code the third letter is the direction, and Z is
    positive upwards (SEED Reference Manual 2.4, appendix A).
    """
    text = name.strip().casefold()
    if text in _COMPASS:
        return Orientation(azimuth=_COMPASS[text])
    if text in _UPWARDS:
        return Orientation(vertical=UPWARDS)
    if text in _DOWNWARDS:
        return Orientation(vertical=DOWNWARDS)
    if text in _VERTICAL:
        return Orientation(vertical=VERTICAL)
    degrees = _DEGREES.fullmatch(text)
    if degrees is not None:
        return azimuth_of(float(degrees.group(1)))
    quadrant = _QUADRANT.fullmatch(text)
    if quadrant is not None:
        from_pole, angle, towards = quadrant.groups()
        turn = float(angle) if (from_pole == "n") == (towards == "e") else -float(angle)
        return azimuth_of(((0.0 if from_pole == "n" else 180.0) + turn) % _FULL_CIRCLE)
    seed = _SEED.fullmatch(text)
    if seed is not None:
        return orientation_of(seed.group(1))
    numbered = _NUMBERED.fullmatch(text)
    base = text.lstrip("-").strip() if numbered is None else numbered.group(1)
    if base in _UPWARDS | _VERTICAL and base != text:
        # a stroke before the name parts it from another one, or turns it over
        upwards = base in _UPWARDS and not text.startswith("-")
        return Orientation(vertical=UPWARDS if upwards else VERTICAL)
    return UNKNOWN


def azimuth_of(degrees: float) -> Orientation:
    """Give a horizontal direction; unknown if the angle is none from 0 to 360."""
    if not (math.isfinite(degrees) and 0.0 <= degrees <= _FULL_CIRCLE):
        return UNKNOWN
    return Orientation(azimuth=degrees)
