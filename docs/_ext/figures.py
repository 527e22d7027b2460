"""Figures that are drawn when the manual is built, into ``reference/generated``."""

import logging
import subprocess
import sys
import warnings
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from analysis_figures import office_contents
from free_bodies import coupled_forces, two_pads_forces, winkler_bed_forces
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
from sphinx.errors import ExtensionError
from stochastic_figure import stochastic_motions
from study_figures import size_and_pulse

import rockframe as rf

INK = "#1f3a5f"

_changed = ExitStack()
"""Gives Python's filters of warnings back."""


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
    _line(axes, place(0.0, h), place(b, 0.0), "$R_0$", (-0.33, -0.1))
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


def front_page(path: Path) -> None:
    """Animate the block of the first page on its pads."""
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
    block = rf.Block(width="4.85 m", height="19.4 m", mass="600 t")
    system = rf.System(block, pads)
    run = system.simulate(rf.GroundMotion.sine_pulse(), free_vibration="5 s")
    moving = rf.plot.animation(run, speed=1.25, frames_per_second=10.0, title=" ")
    moving.save(path, dpi=70)
    pyplot.close(moving.figure)


FIGURES = (
    response_with_events,
    compared_runs,
    scene_and_state,
    diagrams,
    suite_spectra,
    conventions,
    two_pads_forces,
    winkler_bed_forces,
    coupled_forces,
    cycloidal_pulses,
    wavelets,
    velocity_pulse,
    stochastic_motions,
    work_precision,
    cost_model,
    size_and_pulse,
    office_contents,
    granite_fit,
    granite_calibration,
)


def raise_warnings(gallery_conf: object = None, name: object = None, when: str = "before") -> None:
    """Make errors of the warnings of a script of the gallery, but for those that Python ignores.

    What it warns of would stand on its page, with the path of the file on this machine.
    """
    _changed.close()
    if when == "before":
        _changed.enter_context(warnings.catch_warnings())
        # last, so that the deprecations of other packages are left to their owners
        warnings.simplefilter("error", append=True)


def draw(app: Sphinx) -> None:
    """Draw all figures, in a process of their own, while the gallery is drawn in this one."""
    folder = Path(app.srcdir) / "reference" / "generated"
    folder.mkdir(parents=True, exist_ok=True)
    started = subprocess.Popen([sys.executable, __file__, str(folder)])

    def wait(*_: object) -> None:
        if started.wait() != 0:
            msg = "the figures of the manual could not be drawn"
            raise ExtensionError(msg)

    app.connect("env-before-read-docs", wait)


def setup(app: Sphinx) -> dict[str, bool]:
    """Draw before the pages are read."""
    # what is said of compiling goes to the terminal, and stands on no page of the gallery
    logging.getLogger("rockframe").addHandler(logging.StreamHandler())
    app.connect("builder-inited", draw, priority=100)
    return {"parallel_read_safe": True}


if __name__ == "__main__":
    raise_warnings()
    front_page(Path(sys.argv[1]) / "front_page.gif")
    write_card(Path(sys.argv[1]))
    for figure in FIGURES:
        # a function of rf.plot gives axes, which know their figure
        drawn = figure().figure
        drawn.savefig(Path(sys.argv[1]) / f"{figure.__name__}.png", dpi=130)
        pyplot.close(drawn)
