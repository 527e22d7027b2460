"""Counts of a digitiser, made accelerations by the overall sensitivity of the instrument."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rockframe.records.source import Metadata, Record, Source

if TYPE_CHECKING:
    from rockframe.records.source import Request
    from rockframe.records.station_xml import InstrumentResponse
    from rockframe.signals.arrays import Array


def record_of_counts(
    source: Source,
    request: Request,
    values: Array,
    time_step: float,
    metadata: Metadata,
    response: InstrumentResponse | None,
) -> Record:
    """Build the record of one channel of a file that states no unit.

    The counts less their mean are divided by the sensitivity: the response is taken as
    flat, which that of an accelerometer is from zero to near its corner.
    """
    if request.unit is not None and request.unit_name is not None:
        about: Metadata = {**metadata, "unit_as_read": request.unit_name}
        history = (f"the samples taken as accelerations in {request.unit_name}, as asked for",)
        return Record(time_step, values, request.unit, about, history)
    if response is None:
        found = "counts, and no response of the instrument"
        expected = (
            "StationXML beside the file or as the argument response, or the argument unit if "
            "the samples are accelerations"
        )
        raise source.refuse(found=found, expected=expected)
    offset = float(math.fsum(values) / values.size)
    about = {
        **metadata,
        "unit_as_read": "counts",
        "sensitivity": response.sensitivity,
        "offset_removed": offset,
        "response_file": response.file,
        "response_sha256": response.sha256,
    }
    history = (
        f"counts less their mean of {offset:.9g}, divided by the sensitivity of "
        f"{response.sensitivity:.9g} counts per {response.unit.spelling} ({response.file}); "
        "the response of the instrument is taken as flat",
    )
    return Record(
        time_step, (values - offset) / response.sensitivity, response.unit, about, history
    )
