"""The one table of variables: name, unit, dimension and meaning of everything in a result."""

from typing import Final

from rockframe.errors import SchemaError
from rockframe.results.variables.analyses import (
    CLOUD,
    DYNAMIC_ANALYSIS,
    ENSEMBLE,
    FRACTILES,
    FRAGILITY,
    HAZARD,
    MEASURE_COMPARISON,
    OVERTURNING_MAP,
    PROBABILITY,
    SEQUENCES,
    SPECTRA,
    SUBSETS,
)
from rockframe.results.variables.bodies import BODIES, RESTRAINER_SCALARS, RESTRAINERS
from rockframe.results.variables.motions import DIRECTIONS, MEASURES
from rockframe.results.variables.requests import (
    ACCELERATIONS,
    FORCE_SCALARS,
    IMPULSES,
    OTHERS,
    POINT_PEAKS,
    POINTS,
    REACTIONS,
    SLIPS,
)
from rockframe.results.variables.runs import (
    CERTIFICATE,
    ENERGY_HISTORIES,
    EVENTS_AND_SCALARS,
    HELD,
    HISTORIES,
    MODES,
    MOTION_AFTER_END,
    PROOF,
    REST,
)
from rockframe.results.variables.studies import (
    CASE,
    COMPARISON,
    CRITICAL_SCALE,
    FREE_DECAY,
    MESSAGE,
    MOTION,
    SWEEP,
)
from rockframe.results.variables.suites import RECORDS, TARGETS
from rockframe.results.variables.variable import Variable

_TABLES: Final = (
    HISTORIES,
    MOTION_AFTER_END,
    ENERGY_HISTORIES,
    BODIES,
    RESTRAINERS,
    RESTRAINER_SCALARS,
    ACCELERATIONS,
    REACTIONS,
    OTHERS,
    IMPULSES,
    POINTS,
    POINT_PEAKS,
    SLIPS,
    EVENTS_AND_SCALARS,
    FORCE_SCALARS,
    CERTIFICATE,
    PROOF,
    HELD,
    REST,
    MODES,
    MEASURES,
    DIRECTIONS,
    RECORDS,
    TARGETS,
    COMPARISON,
    CRITICAL_SCALE,
    SWEEP,
    CLOUD,
    DYNAMIC_ANALYSIS,
    FRACTILES,
    FRAGILITY,
    HAZARD,
    MEASURE_COMPARISON,
    OVERTURNING_MAP,
    SPECTRA,
    PROBABILITY,
    SUBSETS,
    ENSEMBLE,
    SEQUENCES,
    FREE_DECAY,
)

SCHEMA: Final = {row.name: row for table in _TABLES for row in table}
"""All variables by name, with those that users have registered."""


def schema_row(name: str) -> Variable:
    """Give the row of a variable."""
    row = SCHEMA.get(name)
    if row is None:
        msg = f"{name!r} is not in the schema of results"
        raise SchemaError(msg)
    return row


COORDINATES: Final = (
    "time",
    "angle",
    "mode",
    "point",
    "point_x",
    "point_y",
    "body",
    "restrainer",
    "scale",
    CASE,
    MOTION,
    MESSAGE,
    "limit_state",
    "rotation_limit",
    "coefficient",
    "amplitude",
    "rocking_period",
    "slenderness",
    "parameter",
    "quantile",
    "response_level",
    "measure",
    "covariate",
    "contributing_intensity",
    "sequence",
    "earthquake",
    "sampling_level",
)
"""Variables that label a dimension, or a case: arithmetic and means leave them alone."""

ENERGIES: Final = tuple(row.name for row in ENERGY_HISTORIES)
"""Histories that are integrated only on request."""

GROUPS: Final = {
    "energy": ENERGIES,
    "acceleration": tuple(row.name for row in ACCELERATIONS),
    "reaction": tuple(row.name for row in REACTIONS),
    "impulse": tuple(row.name for row in IMPULSES),
}
"""Names that ask for several variables."""

ON_REQUEST: Final = (
    *(name for group in GROUPS.values() for name in group),
    *(row.name for row in OTHERS),
)
"""All variables that are given only on request."""

SCHEMA_VERSION: Final = 3
