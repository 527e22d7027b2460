"""The one table of variables: name, unit, dimension and meaning of everything in a result."""

from typing import Final

from rockframe.results.variables.motions import MEASURES
from rockframe.results.variables.runs import (
    CERTIFICATE,
    ENERGY_HISTORIES,
    EVENTS_AND_SCALARS,
    HISTORIES,
)
from rockframe.results.variables.statics import HELD, MODES, REST

SCHEMA: Final = {
    row.name: row
    for rows in (
        HISTORIES,
        ENERGY_HISTORIES,
        EVENTS_AND_SCALARS,
        CERTIFICATE,
        HELD,
        REST,
        MODES,
        MEASURES,
    )
    for row in rows
}
"""All variables by name."""

COORDINATES: Final = ("time", "angle", "mode")
"""Variables that label a dimension."""

ENERGIES: Final = tuple(row.name for row in ENERGY_HISTORIES)
"""Histories that are computed only on request."""

SCHEMA_VERSION: Final = 1
