"""Outputs and points that are asked of a run, beyond what every run has."""

from collections.abc import Iterable, Mapping
from typing import Any, Final, cast

from rockframe.errors import RockframeError, shown
from rockframe.results.diagnostics import DIAGNOSTICS, Diagnostic
from rockframe.results.forces import OF_SOIL_FRICTION
from rockframe.results.points import BodyPoint
from rockframe.results.schema import GROUPS, ON_REQUEST, SCHEMA
from rockframe.results.variables.requests import POINT_TIME
from rockframe.results.variables.variable import TIME
from rockframe.system.assembly import Assembly
from rockframe.units import LENGTH, to_si

EXAMPLE: Final = 'points={"roof": ("0 m", "18 m")}'


def listed(outputs: object) -> list[object]:
    """Give what the argument ``outputs`` names, one by one."""
    if outputs is None:
        return []
    if isinstance(outputs, Iterable) and not isinstance(outputs, str):
        return list(cast("Iterable[object]", outputs))
    return [outputs]


def names_of(outputs: object, points: object, faults: list[str]) -> tuple[str, ...]:
    """Read the argument ``outputs``: names of variables and of groups; note what is unknown."""
    wanted: set[str] = set()
    for name in listed(outputs):
        if isinstance(name, str) and _has_dimensions(name, POINT_TIME):
            if not points:
                faults.append(f"{name!r} is of points, and there are none; give {EXAMPLE}")
        elif isinstance(name, str) and name in GROUPS:
            wanted.update(GROUPS[name])
        elif isinstance(name, str) and name in DIAGNOSTICS:
            continue  # see diagnostics_of
        elif isinstance(name, str) and (name in ON_REQUEST or _has_dimensions(name, TIME)):
            wanted.add(name)
        else:
            known = ", ".join(repr(other) for other in (*GROUPS, *ON_REQUEST, *DIAGNOSTICS))
            faults.append(
                f"outputs has no {shown(name)}; every run has its response, and on request {known}"
            )
    return tuple(name for name in ON_REQUEST if name in wanted)


def diagnostics_of(outputs: object) -> tuple[Diagnostic, ...]:
    """Give the diagnostics that the argument ``outputs`` names, in the order of registration."""
    named = [name for name in listed(outputs) if isinstance(name, str)]
    return tuple(one for name, one in DIAGNOSTICS.items() if name in named)


def _has_dimensions(name: str, dims: tuple[str, ...]) -> bool:
    return name in SCHEMA and SCHEMA[name].dims == dims


NEEDED: Final = {
    "toe_pressure": (("toe_pressure",), "a WinklerSoil"),
    "soil_friction_demand": (OF_SOIL_FRICTION, "a CushionCap between block and WinklerSoil"),
}
"""Columns of a model without which it has no such output, and what gives them."""


def lacking(system: Assembly, names: Iterable[str]) -> list[str]:
    """Give the faults of asking for outputs that the scene does not have."""
    depend = [name for name in names if name in NEEDED]
    if not depend:
        return []
    columns = {column.name for column in system.model.columns}
    of_stack = " and no Stack" if system.model.shows_bodies else ""
    return [
        f"there is no {name!r} in this scene; it needs {NEEDED[name][1]}{of_stack}"
        for name in depend
        if not columns.issuperset(NEEDED[name][0])
    ]


def points_of(given: object, faults: list[str]) -> tuple[BodyPoint, ...]:
    """Read the argument ``points``: names and places on the body; note what is wrong."""
    if given is None:
        return ()
    if not isinstance(given, Mapping):
        faults.append(f"points must name places, such as {EXAMPLE}, got {shown(given)}")
        return ()
    points: list[BodyPoint] = []
    for name, place in cast("Mapping[Any, Any]", given).items():
        if not (isinstance(name, str) and name.strip()):
            faults.append(f"points needs names, such as {EXAMPLE}, got {shown(name)}")
        elif not (isinstance(place, tuple | list) and len(cast("tuple[object]", place)) == 2):
            faults.append(
                f"point {name!r} needs two lengths, to the right of the middle of the base and "
                f"above it, such as {EXAMPLE}, got {shown(place)}"
            )
        else:
            try:
                x, y = (
                    to_si(each, LENGTH, owner="simulate", name=f"points[{name!r}]")
                    for each in cast("tuple[Any, Any]", place)
                )
                points.append(BodyPoint(name, x, y))
            except RockframeError as problem:
                faults.append(str(problem))
    return tuple(points)
