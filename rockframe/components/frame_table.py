"""The table of a building's members, for inspection."""

import math
from collections.abc import Callable, Sequence
from typing import Any, Final

import xarray as xr

from rockframe.components.frame_members import Member
from rockframe.constants import CONVENTIONS
from rockframe.units import Unit
from rockframe.version import __version__

_Column = tuple[str, str, str, Callable[[Member, float], float | None]]
_COLUMNS: Final[tuple[_Column, ...]] = (
    ("mass", Unit.KILOGRAM, "mass", lambda member, _: member.si.mass),
    ("volume", Unit.CUBIC_METRE, "volume", lambda member, _: member.si.volume),
    (
        "x",
        Unit.METRE,
        "horizontal position of the centre, from the middle of the base",
        lambda member, _: member.si.x,
    ),
    (
        "y",
        Unit.METRE,
        "height of the centre above the base",
        lambda member, _: member.si.y,
    ),
    (
        "width",
        Unit.METRE,
        "horizontal size in the plane of rocking",
        lambda member, _: member.si.width,
    ),
    ("height", Unit.METRE, "vertical size", lambda member, _: member.si.height),
    (
        "depth",
        Unit.METRE,
        "size perpendicular to the plane of rocking",
        lambda member, _: member.si.depth,
    ),
    (
        "inertia",
        Unit.KILOGRAM_METRE_SQUARED,
        "moment of inertia about the member's own centre",
        lambda member, _: member.si.inertia,
    ),
    (
        "distance",
        Unit.METRE,
        "distance of the centre from O, the middle of the building",
        lambda member, height: member.si.distance(height),
    ),
    (
        "inertia_about_middle",
        Unit.KILOGRAM_METRE_SQUARED,
        "moment of inertia about O, the middle of the building",
        lambda member, height: member.si.inertia + member.si.mass * member.si.distance(height) ** 2,
    ),
)


def members_table(
    members: Sequence[Member], height: float, attributes: dict[str, float | None]
) -> xr.Dataset:
    """Put members into a table, one row each.

    Parameters
    ----------
    members : sequence of Member
        Members with different names.
    height : float
        Height of the building [m].
    attributes : dict
        What the sums come to; None is left out.

    Returns
    -------
    xarray.Dataset
        Dimension ``member``, labelled by name and kind. What is unknown is NaN.
    """
    variables: dict[str, Any] = {}
    for name, unit, words, read in _COLUMNS:
        values = [read(member, height) for member in members]
        column = [math.nan if value is None else value for value in values]
        variables[name] = ("member", column, {"long_name": words, "units": str(unit)})
    labels = {
        "member": ("member", [member.name for member in members], {"long_name": "name"}),
        "kind": ("member", [member.kind or "" for member in members], {"long_name": "kind"}),
    }
    known = {name: value for name, value in attributes.items() if value is not None}
    return xr.Dataset(
        variables,
        coords=labels,
        attrs={
            "Conventions": CONVENTIONS,
            "title": "Members of a building and their part in its inertia",
            # without the time: equal frames have equal tables
            "history": f"computed by rockframe {__version__}",
            "source": f"rockframe {__version__}, geometry of the members",
            "comment": "Numbers in these attributes are in SI units.",
            **known,
        },
    )
