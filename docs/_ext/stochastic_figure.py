"""The figure of the stochastic motions, drawn when the manual is built."""

import numpy as np
from matplotlib.figure import Figure

import rockframe as rf
from rockframe.motion.stochastic import Corners, PointSource

COLOURS = {5.0: "#88aacc", 6.0: "#cc6677", 7.0: "#1f3a5f"}
SEEDS = range(1, 21)


def stochastic_motions() -> Figure:
    """Draw spectra of three earthquakes at 20 km, and one motion of each."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    layout = figure.add_gridspec(3, 2)
    spectra = figure.add_subplot(layout[:, 0])
    target = np.geomspace(0.03, 50.0, 400)
    histories = [figure.add_subplot(layout[row, 1]) for row in range(len(COLOURS))]
    for history, (magnitude, colour) in zip(histories, COLOURS.items(), strict=True):
        motions = [rf.GroundMotion.stochastic(magnitude, "20 km", seed) for seed in SEEDS]
        drawn = [rf.fourier_spectrum(motion) for motion in motions]
        frequency = drawn[0].frequency.values[1:]
        powers = [one.fourier_amplitude.values.ravel()[1:] ** 2 for one in drawn]
        mean = np.sqrt(np.mean(powers, axis=0))
        spectra.loglog(frequency, mean, color=colour, lw=0.5, alpha=0.6)
        corners = Corners(motions[0].metadata["source"])
        curve = PointSource(magnitude, 20e3, corners=corners).acceleration_spectrum(target)
        spectra.loglog(target, curve, color=colour, lw=1.8, label=f"magnitude {magnitude:g}")
        samples = motions[0].si.horizontal.samples
        time = motions[0].si.time_step * np.arange(samples.size)
        history.plot(time, samples, color=colour, lw=0.6)
    for history in histories:  # the motion of the strongest earthquake is the longest
        history.set_xlim(0.0, time[-1])
        history.tick_params(labelbottom=history is histories[-1])
    histories[1].set_ylabel("ground acceleration [m/s²]")
    histories[-1].set_xlabel("time [s]")
    spectra.set(
        xlim=(0.03, 50.0),
        ylim=(1e-4, 1.0),
        xlabel="frequency [Hz]",
        ylabel="Fourier amplitude [m/s]",
    )
    spectra.legend(frameon=False)
    return figure
