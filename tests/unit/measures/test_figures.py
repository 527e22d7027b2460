"""Figures of motions and spectra."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import rockframe as rf

PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "2 Hz")


def test_a_motion_is_drawn_in_three_rows(tmp_path):
    figure = rf.plot.motion(PULSE).figure
    assert isinstance(figure, Figure)
    labels = [axes.get_ylabel().split("\n")[0] for axes in figure.axes]
    assert labels == ["acceleration", "velocity", "displacement"]
    assert figure.axes[-1].get_xlabel() == "time [s]"
    plotted = figure.axes[0].get_lines()[0].get_ydata()
    np.testing.assert_array_equal(plotted, PULSE.si.horizontal.samples)
    assert figure.get_suptitle() == PULSE.name
    figure.savefig(tmp_path / "motion.png")


def test_a_vertical_component_is_drawn_too():
    figure = rf.plot.motion(PULSE.with_vertical(PULSE.scaled(0.5)), title="both").figure
    texts = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert texts == ["vertical", "horizontal"]
    assert figure.get_suptitle() == "both"


@pytest.mark.parametrize("component", ["horizontal", "vertical"])
def test_spectra_are_drawn_below_history(component, tmp_path):
    motion = PULSE.with_vertical(PULSE.scaled(0.5))
    periods = (["0", "0.1", "0.5", "1"], "s")
    figure = rf.plot.spectra(motion, periods, (0.02, 0.05), component=component).figure
    history, response, fourier = figure.axes
    factor = 1.0 if component == "horizontal" else 0.5
    assert history.get_lines()[0].get_ydata().max() == pytest.approx(2.0 * factor)
    lines = [line for line in response.get_lines() if len(line.get_xdata()) == 3]
    assert [line.get_label() for line in lines] == ["2 %", "5 %"]
    assert response.get_xscale() == "log"
    assert fourier.get_xlabel() == "frequency [Hz]"
    figure.savefig(tmp_path / "spectra.png")


def test_still_ground_can_be_drawn(tmp_path):
    still = rf.GroundMotion.from_arrays((np.zeros(50), "m/s^2"), "0.01 s")
    rf.plot.motion(still).figure.savefig(tmp_path / "motion.png")
    rf.plot.spectra(still, (["0.1", "1"], "s")).figure.savefig(tmp_path / "spectra.png")
