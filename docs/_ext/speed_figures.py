"""Figures of speed, drawn from measurements that are kept in ``docs/data``."""

import json
import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

DATA = Path(__file__).parents[1] / "data"
INK = "#1f3a5f"
COLOURS = {"RK45": "#cc6677", "DOP853": "#ddaa33", "LSODA": "#44aa99", "Radau": "#aa4499"}
WAYS = {
    "begun anew at samples": ("restarted at samples", "-", "o"),
    "through the samples": ("through the samples", ":", "^"),
}
"""How SciPy takes the samples: the name in the data, that in the figure, line and marker."""
TITLES = {
    "rigid ground": "rigid ground",
    "pads": "two pads",
    "soil": "soil",
    "cascade": "pads, cap and soil by cascade",
    "coupled": "pads, cap and soil coupled",
}
LEVELS = {"fast": "#44aa99", "standard": INK, "reference": "#cc6677"}


def _read(name: str) -> dict:
    return json.loads((DATA / f"{name}.json").read_text())


def _line(axes: Axes, points: list[dict], colour: str, style: str, marker: str) -> None:
    rows = [one for one in points if one["error"] is not None and math.isfinite(one["error"])]
    rows.sort(key=lambda one: one["time"])
    axes.plot(
        [one["error"] for one in rows],
        [one["time"] for one in rows],
        ls=style,
        marker=marker,
        ms=4,
        lw=1.2,
        color=colour,
    )


def _ours(axes: Axes, points: list[dict]) -> None:
    rows = [one for one in points if one["program"] == "rockframe"]
    swept = [one for one in rows if one["setting"].startswith("rtol")]
    axes.plot(
        [one["error"] for one in swept],
        [one["time"] for one in swept],
        ls="-",
        lw=1.8,
        color=INK,
        alpha=0.5,
    )
    for one in rows:
        if one["setting"] in LEVELS:
            axes.plot(one["error"], one["time"], "s", ms=5.5, color=INK)


def work_precision() -> Figure:
    """Draw time against error in the five scenes, and that of OpenSees."""
    data = _read("work_precision")
    figure = Figure(figsize=(9.0, 9.6), layout="constrained")
    grid = figure.subplots(3, 2)
    for axes, (name, title) in zip(grid.flat, TITLES.items(), strict=False):
        points = data["scenes"][name]["points"]
        for method, colour in COLOURS.items():
            for way, (_, style, marker) in WAYS.items():
                chosen = [
                    one for one in points if one.get("method") == method and one["way"] == way
                ]
                _line(axes, chosen, colour, style, marker)
        _ours(axes, points)
        axes.set_title(title, fontsize="medium")
    last = grid.flat[5]
    points = data["opensees"]["undamped, with uplift"]["points"]
    cheapest: dict[str, dict] = {}  # of the tests of convergence, at each step
    for one in points:
        step = one["setting"].split(",")[0]
        if one["program"] == "OpenSees" and one["time"] is not None:
            cheapest[step] = min(cheapest.get(step, one), one, key=lambda point: point["time"])
    _line(last, list(cheapest.values()), "0.35", "-", "D")
    _ours(last, points)
    last.set_title("two pads without dashpots, and OpenSees", fontsize="medium")
    for axes in grid.flat:
        axes.set(xscale="log", yscale="log", xlim=(3.0, 1e-14), ylim=(1.5e-3, 300.0))
        axes.grid(visible=True, lw=0.4, color="0.88")
        axes.set_axisbelow(True)
    for axes in grid[:, 0]:
        axes.set_ylabel("time of a run [s]")
    for axes in grid[2]:
        axes.set_xlabel("largest error of the rotation over its peak [1]")
    handles = [Line2D([], [], color=INK, marker="s", ms=5.5, lw=1.8, label="rockframe")]
    handles += [Line2D([], [], color=c, lw=1.6, label=f"SciPy {m}") for m, c in COLOURS.items()]
    handles += [
        Line2D([], [], color="0.35", marker="D", ms=4, lw=1.2, label="OpenSees"),
        *(
            Line2D([], [], color="0.5", ls=style, marker=marker, ms=4, label=f"SciPy {words}")
            for words, style, marker in WAYS.values()
        ),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
    return figure


def cost_model() -> Figure:
    """Draw what time and steps depend on."""
    data = _read("cost_model")
    figure = Figure(figsize=(9.0, 7.4), layout="constrained")
    (lengths, impacts), (stiffness, damping) = figure.subplots(2, 2)
    colours = dict(zip(TITLES, ("0.4", INK, "#44aa99", "#ddaa33", "#cc6677"), strict=True))
    for name, rows in data["lengths"].items():
        lengths.loglog(
            [one["length"] for one in rows], [one["time"] for one in rows],
            "o-", ms=4, lw=1.2, color=colours[name], label=TITLES[name],
        )  # fmt: skip
    span = np.array([10.0, 3600.0])
    lengths.loglog(span, 3e-5 * span, ls="--", lw=0.9, color="0.6", label="proportional")
    lengths.set(xlabel="length of the motion [s]", ylabel="time of a run [s]")
    lengths.set_title("length and model", fontsize="medium")
    lengths.set_ylim(2e-4, 30.0)
    lengths.legend(frameon=False, fontsize="x-small", loc="upper left")
    for name in ("rigid ground", "pads"):
        rows = data["impacts"][name]
        impacts.plot(
            [one["events"] for one in rows],
            [one["steps"] / one["samples"] for one in rows],
            "o", ms=4.5, color=colours[name], label=TITLES[name],
        )  # fmt: skip
    impacts.set(xlabel="events in 31 s", ylabel="steps per sample", ylim=(0.0, 2.1))
    impacts.set_title("impacts and other events", fontsize="medium")
    impacts.legend(frameon=False, fontsize="small", loc="lower right")
    for axes, key, variable, words in (
        (stiffness, "stiffness", "frequency_ratio", r"frequency ratio $\beta$"),
        (damping, "damping", "damping_ratio", r"damping ratio $\xi$, $\beta=1000$"),
    ):
        rows = [one for one in data[key] if one["block"] == "rocks"]
        for level, colour in LEVELS.items():
            chosen = [one for one in rows if one["level"] == level]
            axes.loglog(
                [one[variable] for one in chosen],
                [one["steps"] + one["rejected"] for one in chosen],
                "o-", ms=4, lw=1.2, color=colour, label=level,
            )  # fmt: skip
        fast = [one for one in rows if one["level"] == "fast"]
        axes.loglog(
            [one[variable] for one in fast], [one["stable_steps"] for one in fast],
            "--", lw=1.4, color="0.5", label="required for stability",
        )  # fmt: skip
        axes.set(xlabel=words, ylabel="steps in 8 s")
    stiffness.set_title("hard pads", fontsize="medium")
    damping.set_title("strong dashpots", fontsize="medium")
    stiffness.legend(frameon=False, fontsize="small")
    for axes in (lengths, impacts, stiffness, damping):
        axes.grid(visible=True, lw=0.4, color="0.88")
        axes.set_axisbelow(True)
    return figure
