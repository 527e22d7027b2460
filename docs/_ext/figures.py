"""Figures that are drawn when the manual is built, into ``reference/generated``."""

import os
import subprocess
import sys
import warnings
from itertools import product
from pathlib import Path

import numpy as np
import xarray as xr
from analysis_figures import (
    cabinet_analysis,
    cabinet_fragility,
    office_contents,
    overturning_spectrum,
    sine_map,
)
from granite_figures import granite_calibration, granite_fit
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Polygon, Rectangle
from plot_figures import (
    compared_runs,
    diagrams,
    response_with_events,
    scene_and_state,
    suite_spectra,
    write_card,
)
from pulse_figures import cycloidal_pulses, velocity_pulse, wavelets
from speed_figures import cost_model, work_precision
from sphinx.application import Sphinx
from stochastic_figure import stochastic_motions
from study_figures import critical_scale, size_and_pulse

import rockframe as rf
from rockframe.plot import Panels

INK = "#1f3a5f"


def _six_storeys() -> rf.System:
    return rf.System(
        rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=2.92),
        rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10),
        rf.CushionCap(height="0.9 m", mass="36 t"),
        rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20),
    )


def quickstart() -> Panels:
    """Draw the response of the quick start."""
    system = _six_storeys()
    motion = rf.GroundMotion.stochastic(6.8, "5 km", seed=29, stress_drop="20 MPa")
    return rf.plot.response(system.simulate(motion, free_vibration="10 s"))


def rungs() -> Panels:
    """Draw time and error of all models of the quick start's scene."""
    motion = rf.GroundMotion.stochastic(6.8, "5 km", seed=29, stress_drop="20 MPa")
    return rf.plot.tradeoff(rf.tradeoff(_six_storeys(), motion, repeats=3))


def conventions() -> Figure:
    """Draw a block that leans to the right, with the symbols of the notation."""
    b, h, alpha = 1.0, 2.2, 0.2
    rotation = np.array([[np.cos(alpha), np.sin(alpha)], [-np.sin(alpha), np.cos(alpha)]])
    right = np.array([b, 0.0])

    def place(s: float, height: float) -> np.ndarray:
        return right + rotation @ (np.array([s, height]) - right)

    figure = Figure(figsize=(4.6, 5.0), layout="constrained")
    axes = figure.subplots()
    corners = [(-b, 0.0), (b, 0.0), (b, 2 * h), (-b, 2 * h)]
    axes.add_patch(Rectangle((-b, 0.0), 2 * b, 2 * h, fill=False, ls=":", color="0.6"))
    outline = [place(*corner) for corner in corners]
    axes.add_patch(Polygon(outline, facecolor="#e8eef5", edgecolor=INK, lw=1.6))
    for s in (-b, b):
        axes.add_patch(Rectangle((s - 0.12, -0.3), 0.24, 0.3, color="0.75"))
    axes.axhline(-0.3, color="0.3", lw=1.2)
    points = {"L": (-b, 0.0), "R": (b, 0.0), "M": (0.0, 0.0), "O": (0.0, h)}
    shifts = {"L": (-0.28, 0.05), "R": (0.14, -0.18), "M": (0.06, -0.3), "O": (0.12, 0.05)}
    for name, spot in points.items():
        at = place(*spot)
        axes.plot(*at, "o", color=INK, ms=4)
        axes.text(*(at + shifts[name]), name, color=INK)
    _line(axes, place(0.0, 0.0), place(0.0, h), "h", (-0.25, 0.0))
    _line(axes, place(0.0, h), place(b, 0.0), "$R_0$", (0.1, 0.1))
    _line(axes, place(0.0, 0.0), place(-b, 0.0), "b", (0.0, 0.1))
    axes.plot([1.0, 1.0], [0.0, 2.0], color="0.6", lw=0.8)
    axes.plot(*np.array([right, place(b, 2.0)]).T, color="0.6", lw=0.8)
    axes.add_patch(Arc((b, 0.0), 3.4, 3.4, theta1=90 - np.degrees(alpha), theta2=90))
    axes.text(1.07, 1.8, r"$\alpha$")
    axes.annotate("", (-2.0, 0.5), (-2.0, -0.3), arrowprops={"arrowstyle": "->"})
    axes.annotate("", (-1.2, -0.3), (-2.0, -0.3), arrowprops={"arrowstyle": "->"})
    axes.text(-2.15, 0.55, "$y$")
    axes.text(-1.35, -0.55, "$x$")
    axes.set(xlim=(-2.4, 2.4), ylim=(-0.8, 4.9), aspect="equal")
    axes.axis("off")
    return figure


def _line(
    axes: Axes, start: np.ndarray, end: np.ndarray, text: str, shift: tuple[float, float]
) -> None:
    axes.plot(*np.array([start, end]).T, color=INK, lw=0.9, ls="--")
    axes.text(*((start + end) / 2 + shift), text, color=INK)


def _released(
    height: float, mass: float, shape_factor: float, beta: int, k0: int, coupling: str, seconds: int
) -> xr.Dataset:
    """Let a frame of the paper's Table 2 go from 0.10 rad."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rf.ModelWarning)  # the page is about the printed mu
        frame = rf.FrameEquivalent(
            width="4 m", height=f"{height} m", mass=f"{mass} t", shape_factor=shape_factor
        )
    system = rf.System(
        frame,
        rf.TwoSpringSupport(frequency_ratio=beta, damping_ratio=0.10),
        rf.CushionCap(height=f"{height / 20} m", density="2500 kg/m^3", depth="4 m"),
        rf.WinklerSoil(stiffness=f"{k0} MPa", damping_ratio=0.20),
        coupling=coupling,
        gravity="9.81 m/s^2",
    )
    start = rf.InitialState(rotation="0.1 rad")
    return system.simulate(
        duration=f"{seconds} s", initial=start, output_step="0.02 s", accuracy="fast"
    )


def _free_response(height: float, mass: float, shape_factor: float, seconds: int) -> Figure:
    figure = Figure(figsize=(9.0, 4.6), layout="constrained")
    axes = figure.subplots(2, 3, sharex=True, sharey="row")
    runs = {("coupled", 3): "#cc6677", ("coupled", 12): INK, ("cascade", 9): "0.55"}
    names = ("rotation", "vertical_displacement")
    for (column, beta), ((coupling, k0), colour) in product(enumerate((20, 40, 60)), runs.items()):
        run = _released(height, mass, shape_factor, beta, k0, coupling, seconds)
        label = "cascade, any $k_0$" if coupling == "cascade" else f"coupled, $k_0={k0}$ MPa"
        style = "--" if coupling == "cascade" else "-"
        for row, name in enumerate(names):
            axes[row, column].plot(run.time, run[name], style, color=colour, lw=1.0, label=label)
    for column, beta in enumerate((20, 40, 60)):
        axes[0, column].set_title(rf"$\beta={beta}$", fontsize="medium")
        axes[1, column].set_xlabel("time [s]")
    for row, text in enumerate((r"rotation $\alpha$ [rad]", "vertical $y$ [m]")):
        axes[row, 0].set_ylabel(text)
    for place in axes.flat:
        place.axhline(0.0, color="0.8", lw=0.5, zorder=0)
    axes[0, 0].set_xlim(0.0, seconds)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    return figure


def three_storeys_released() -> Figure:
    """Draw the free response of the three-storey frame, as in Fig. 19."""
    return _free_response(9.0, 45.8, 1.153, 12)


def six_storeys_released() -> Figure:
    """Draw the free response of the six-storey frame, as in Fig. 20."""
    return _free_response(18.0, 99.0, 0.380, 20)


FIGURES = (
    quickstart,
    response_with_events,
    compared_runs,
    scene_and_state,
    diagrams,
    suite_spectra,
    rungs,
    conventions,
    three_storeys_released,
    six_storeys_released,
    cycloidal_pulses,
    wavelets,
    velocity_pulse,
    stochastic_motions,
    work_precision,
    cost_model,
    critical_scale,
    size_and_pulse,
    cabinet_fragility,
    cabinet_analysis,
    sine_map,
    overturning_spectrum,
    office_contents,
    granite_fit,
    granite_calibration,
)


def draw(app: Sphinx) -> None:
    """Draw all figures, in a process of their own that may compile."""
    folder = Path(app.srcdir) / "reference" / "generated"
    folder.mkdir(parents=True, exist_ok=True)
    environment = {name: value for name, value in os.environ.items() if name != "ROCKFRAME_COMPILE"}
    subprocess.run([sys.executable, __file__, str(folder)], check=True, env=environment)


def setup(app: Sphinx) -> dict[str, bool]:
    """Draw before the pages are read."""
    app.connect("builder-inited", draw)
    return {"parallel_read_safe": True}


if __name__ == "__main__":
    write_card(Path(sys.argv[1]))
    for figure in FIGURES:
        # a function of rf.plot gives axes, which know their figure
        drawn = figure().figure
        drawn.savefig(Path(sys.argv[1]) / f"{figure.__name__}.png", dpi=130)
        pyplot.close(drawn)
