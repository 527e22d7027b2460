"""Figures and the card of the pages on figures and on notebooks."""

from pathlib import Path

import xarray as xr
from matplotlib import pyplot
from matplotlib.figure import Figure

import rockframe as rf
from rockframe.plot import Panels

BLOCK = rf.Block(width="0.8 m", height="4 m", mass="2 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
PULSE = rf.GroundMotion.sine_pulse("1.6 m/s^2", "1 Hz")


def _run() -> xr.Dataset:
    system = rf.System(BLOCK, PADS)
    return system.simulate(PULSE, free_vibration="6 s", outputs=("energy", "reaction"))


def response_with_events() -> Panels:
    """Draw the response of a block on pads."""
    units = {"angle": "deg", "length": "mm", "acceleration": "g"}
    return rf.plot.response(_run(), units=units, events=True)


def compared_runs() -> Panels:
    """Draw rotations and contact of two runs."""
    runs = {
        f"frequency ratio {ratio}": rf.System(BLOCK, PADS.replace(frequency_ratio=ratio)).simulate(
            PULSE, free_vibration="3 s"
        )
        for ratio in (10, 40)
    }
    return rf.plot.response(runs, panels=("rotation", "contact"))


def scene_and_state() -> Figure:
    """Draw a frame at rest and at its largest rotation."""
    system = rf.System(
        rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=2.92),
        rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10),
        rf.CushionCap(height="0.9 m", mass="36 t"),
        rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20),
    )
    motion = rf.GroundMotion.stochastic(7.5, "5 km", seed=29, stress_drop="20 MPa")
    run = system.simulate(motion.scaled(2.0), points={"roof": ("0 m", "18 m")})
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9.4, 5.2), layout="constrained")
    rf.plot.scene(system, ax=left)
    rf.plot.state(run, ax=right, title="at the largest rotation")
    return figure


def diagrams() -> Figure:
    """Draw phases, moments and energies."""
    run = _run()
    figure, axes = pyplot.subplots(1, 3, figsize=(12.0, 4.0), layout="constrained")
    rf.plot.phase(run, ax=axes[0])
    rf.plot.moment_rotation(run, ax=axes[1])
    rf.plot.energies(run, energy="J", ax=axes[2])
    return figure


def suite_spectra() -> Figure:
    """Draw the spectra of a set and a target."""
    suite = {f"seed {k}": rf.GroundMotion.stochastic(6.6, "5 km", seed=k) for k in range(8)}
    axes = rf.plot.suite(suite, target=rf.TargetSpectrum.eurocode_8("0.3 g_0"))
    return axes.get_figure(root=True)


def write_card(folder: Path) -> None:
    """Write what a notebook shows of a system."""
    block = rf.Block(width="0.8 m", height="4 m", mass="2 t", centre_of_mass=("1.8 m", "0.05 m"))
    html = rf.System(block, PADS)._repr_html_()  # as notebooks call it
    (folder / "card.html").write_text(html, encoding="utf-8")
