"""The one table of variables: name, unit, dimension and meaning of everything in a result."""

from typing import Final

from rockframe.results.variables.comparison import COMPARISON
from rockframe.results.variables.motions import MEASURES
from rockframe.results.variables.runs import (
    CERTIFICATE,
    ENERGY_HISTORIES,
    EVENTS_AND_SCALARS,
    HISTORIES,
)
from rockframe.results.variables.statics import HELD, MODES, REST

_TABLES: Final = (
    HISTORIES,
    ENERGY_HISTORIES,
    EVENTS_AND_SCALARS,
    CERTIFICATE,
    HELD,
    REST,
    MODES,
    MEASURES,
    COMPARISON,
)

SCHEMA: Final = {row.name: row for table in _TABLES for row in table}
"""All variables by name, with those that users have registered."""

COORDINATES: Final = ("time", "angle", "mode")
"""Variables that label a dimension."""

ENERGIES: Final = tuple(row.name for row in ENERGY_HISTORIES)
"""Histories that are computed only on request."""

SCHEMA_VERSION: Final = 2
