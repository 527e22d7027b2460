"""Formats that are recognised, so as to say that they cannot be read."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from rockframe.motion.formats.source import Source

_TOP_LINES: Final = 4
_SIGNS: Final = (
    (r"\(Format v0?1\.\d+ with \d+ text lines\)", "a COSMOS file"),
    (r"^(UN)?CORRECTED ACCELEROGRAM\s.*CHAN", "a CSMIP volume file"),
    (r"^\d (UN)?CORRECTED ACCELEROGRAM", "a USGS SMC file"),
    (r"^EVENT_NAME:", "an ESM (DYNA) file"),
    (r"^#Earthquake Information", "a file of the Central Weather Administration, Taiwan"),
    (r"\bGNS Science\b", "a GeoNet file"),
    (r"^Origin Time\s+\d{4}/", "a K-NET or KiK-net file"),
)


def foreign_format(source: Source) -> str | None:
    """Name the format of a file that cannot be read, if its first lines tell.

    Parameters
    ----------
    source : Source
        File.

    Returns
    -------
    str or None
    """
    for line in source.lines[:_TOP_LINES]:
        for sign, name in _SIGNS:
            if re.search(sign, line):
                return name
    return None
