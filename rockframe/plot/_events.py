"""Events, marked on histories of the rotation."""

from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.plot._axes import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILLION, key
from rockframe.plot._checks import overturning_angles
from rockframe.plot._runs import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rockframe.plot._units import Shown

MARKS: Final = {
    "uplift": ("^", GREEN),
    "separation": ("^", ORANGE),
    "impact": ("o", VERMILLION),
    "reengagement": ("v", BLUE),
    "rest": ("s", GREY),
    "overturning": ("X", VERMILLION),
    "toppled": ("X", GREY),
    "soil_separation": ("2", PURPLE),
    "soil_contact": ("1", PURPLE),
}
"""Marker and colour of each kind of event that is drawn, by its name in the schema. Changes of the
horizontal restraint are not drawn: they come with a separation or a contact."""


def draw_events(axes: "Axes", runs: list[Run], unit: "Shown | None") -> None:
    """Mark events where they happened on the rotation, and name them in the legend."""
    named: set[str] = set()
    for run in runs:
        dataset = run.dataset
        if "event_kind" not in dataset:
            continue
        rotation = dataset["event_rotation"].to_numpy()
        left, right = overturning_angles(dataset)
        drawn = rotation / np.where(rotation < 0.0, left, right)
        drawn = drawn if unit is None else unit.of(rotation)
        when = dataset["event_time"].to_numpy()
        for name, chosen in events_by_kind(run).items():
            marker, colour = MARKS[name]
            label = None if name in named else name.replace("_", " ")
            named.add(name)
            face = "none" if marker in "^v" else colour
            axes.plot(
                when[chosen], drawn[chosen], marker, color=colour, markerfacecolor=face,
                markersize=4.5, markeredgewidth=0.9, label=label, zorder=3,
            )  # fmt: skip
    if named:
        key(axes, ncols=2)


def events_by_kind(run: Run) -> "dict[str, np.ndarray]":
    """Give which events of a run are of each kind that is drawn."""
    kinds = run.dataset["event_kind"]
    values = kinds.to_numpy()
    meanings = str(kinds.attrs["flag_meanings"]).split()
    named = zip(kinds.attrs["flag_values"], meanings, strict=True)
    found = {name: values == value for value, name in named if name in MARKS}
    return {name: chosen for name, chosen in found.items() if chosen.any()}
