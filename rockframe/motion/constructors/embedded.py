"""Constructor of records that come with the package."""

from __future__ import annotations

import io
import tomllib
from importlib import resources
from typing import TYPE_CHECKING, Any, Final, cast

from rockframe.errors import ComponentError, shown
from rockframe.motion.constructors.records import read

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

    from rockframe.motion.value import Made

_PROVENANCE: Final = "provenance.toml"


def example(
    kind: type[Made],
    name: str = "loma-prieta",
    component: str | tuple[str, str] | None = None,
) -> Made:
    """Read a recorded motion that comes with rockframe.

    Parameters
    ----------
    name : {"loma-prieta", "waipukurau"}, optional
        The record: San Francisco, 1295 Shafter Avenue, in the Loma Prieta earthquake of 1989,
        0.11 g; or Waipawa in a small earthquake near Waipukurau, New Zealand, in 2018, 0.02 g.
    component : str or pair of str, optional
        As for :meth:`read`, where the file has several: ``"S16W"``, ``"S74E"`` and ``"Up"`` of
        Waipukurau, of which the second is taken unless given.

    Returns
    -------
    GroundMotion
        As published, neither scaled nor corrected. Its metadata tell `source`, `processing`,
        `licence`, `attribution` and `reference`, and its history the attribution.

    Raises
    ------
    ComponentError
        No such record; the message lists them.
    RecordError
        The record has no such component.

    Examples
    --------
    >>> import rockframe as rf
    >>> motion = rf.GroundMotion.example("loma-prieta")
    >>> motion.peak_acceleration.to("g_0").round(3)
    <Quantity(0.106, 'standard_gravity')>
    """
    folder = resources.files("rockframe.motion") / "embedded"
    records = record_sources(folder)
    record = records.get(name) if isinstance(cast("object", name), str) else None
    if record is None:
        known = ", ".join(repr(one) for one in records)
        msg = f"{kind.__name__}.example: name must be one of {known}, got {shown(name)}"
        raise ComponentError(msg)
    file = io.BytesIO((folder / record["file"]).read_bytes())
    file.name = record["file"]
    motion = read(kind, file, component=component or record["component"])
    told: dict[str, Any] = record["metadata"]
    return kind(
        motion.si,
        name=record["name"],
        metadata={**motion.metadata, **told},
        history=(*motion.history, f"source: {told['attribution']}; {told['licence']}"),
    )


def record_sources(folder: Traversable) -> dict[str, Any]:
    """Read where the records of a folder are from, by their names."""
    return tomllib.loads((folder / _PROVENANCE).read_text(encoding="utf-8"))
