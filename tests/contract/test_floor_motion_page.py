"""The pages on floor motions agree with the code and the example."""

import re
import runpy
import sys

import numpy as np
import pytest
from pages import DOCS, numbers_in, table

import rockframe as rf

PAGE = "theory/floor_motion.md"
HEAD = "| samples per period | harmonic of that period | white noise | earthquake |"


def deviation(motion, period):
    """Return the deviation from straight lines stated in the history [%]."""
    floor = motion.through_storeys([f"{period!r} s"], 0.05)
    matches = [re.search(r"departs from that by up to (\S+) % of", line) for line in floor.history]
    (value,) = [float(match[1]) for match in matches if match]
    return value


@pytest.mark.filterwarnings("ignore:.*departs from straight lines:rockframe.RecordWarning")
def test_deviations_from_straight_lines():
    step = 0.005
    time = np.arange(4000) * step
    noise = np.random.default_rng(0).normal(size=time.size)
    earthquake = rf.GroundMotion.stochastic(7, "10 km", seed=3)
    assert earthquake.si.time_step == step
    rows = table(PAGE, HEAD)
    assert len(rows) == 5
    for samples, *cells in rows:
        period = float(samples) * step
        tone = np.sin(2.0 * np.pi * time / period)
        motions = [rf.GroundMotion.from_arrays((a, "m/s^2"), f"{step} s") for a in (tone, noise)]
        for motion, cell in zip([*motions, earthquake], cells, strict=True):
            assert deviation(motion, period) == pytest.approx(float(cell), rel=0.06)
        if float(samples) >= 10:
            rule = 100.0 * (2.0 * np.pi / float(samples)) ** 2 / 8.0
            assert float(cells[0]) == pytest.approx(rule, rel=0.06)


def test_the_default_length_of_free_vibration():
    (periods,) = numbers_in(PAGE, r"every mode is at most a hundredth: # periods with $\zeta=0.05$")
    still = rf.GroundMotion.from_arrays(([0.0, 1.0, 0.0], "m/s^2"), "0.01 s")
    floor = still.through_storeys(["2 s"], 0.05)
    assert (len(floor) - 3) * 0.01 == pytest.approx(2.0 * periods, abs=0.1)


def test_the_museum_case(monkeypatch, tmp_path, capsys):
    script = DOCS.parent / "examples" / "floor_motion.py"
    monkeypatch.setattr(sys, "argv", [str(script), "--folder", str(tmp_path)])
    with pytest.raises(SystemExit) as exited:
        runpy.run_path(str(script), run_name="__main__")
    assert exited.value.code == 0
    lines = capsys.readouterr().out.splitlines()
    fates = ["Overturned" in line for line in lines if line.startswith("  on ")]
    assert fates == [False, False, False, True, True, True, True]
    assert "On the ground the case stays up; on floors 3, 4, 5 and 6 the same" in lines[8]
    files = {path.name for path in tmp_path.iterdir()}
    assert files == {"floor_motion.nc", "floor_motion.png", "case_on_floor_4.png"}
    assert len(rf.GroundMotion.read(tmp_path / "floor_motion.nc")) > 4000
