"""Written AT2 files have the layout of PEER and survive the round trip."""

import numpy as np
import pytest

from rockframe.errors import ComponentError, FileError
from rockframe.motion import GroundMotion

VALUES = np.random.default_rng(7).standard_normal(203) * np.geomspace(1e-9, 3.0, 203)
METADATA = {"event": "Somewhere, Some Day", "station": "Gilroy, Gavilan", "component": "067"}


def record(step="0.005 s"):
    motion = GroundMotion.from_arrays((VALUES, "m/s^2"), step, (-2.0 * VALUES, "m/s^2"))
    return GroundMotion(motion.si, name="made up", metadata=METADATA)


@pytest.mark.parametrize("component", ["horizontal", "vertical"])
@pytest.mark.parametrize("step", ["0.005 s", "0.00390625 s", "0.02 s", "0.0033333333333333335 s"])
def test_motion_survives_at2_round_trip(tmp_path, component, step):
    motion = record(step)
    path = tmp_path / "w.AT2"
    motion.to_at2(path, component)
    reread = GroundMotion.read(path, component="067" if component == "horizontal" else "UP")
    own = motion.si.horizontal if component == "horizontal" else motion.si.vertical
    np.testing.assert_allclose(reread.si.horizontal.samples, own.samples, rtol=5.1e-8)
    assert reread.si.time_step == motion.si.time_step
    assert reread.metadata["event"] == "Somewhere Some Day"
    assert reread.metadata["station"] == "Gilroy Gavilan"


def test_the_layout_is_that_of_peer(tmp_path):
    path = tmp_path / "w.AT2"
    record().to_at2(path)
    text = path.read_bytes()
    assert b"\r" not in text
    lines = text.decode("ascii").split("\n")
    assert lines[2] == "ACCELERATION TIME SERIES IN UNITS OF G"
    assert lines[3] == "NPTS=    203, DT=  0.0050 SEC,"
    assert {len(line) for line in lines[4:44]} == {75}
    assert float(lines[44][30:45]) == pytest.approx(VALUES[202] / 9.80665, rel=5.1e-8)
    assert lines[45:] == [""]
    fields = [float(field) for line in lines[4:] for field in line.split()]
    assert len(fields) == 203


def test_columns_stay_apart_where_samples_are_tiny(tmp_path):
    """The tails of a Gaussian, typed by a user."""
    tails = -np.exp(-(np.linspace(-40.0, 40.0, 203) ** 2))
    GroundMotion.from_arrays((tails, "m/s^2"), "0.01 s").to_at2(tmp_path / "w.AT2")
    lines = (tmp_path / "w.AT2").read_text().splitlines()[4:]
    fields = [float(field) for line in lines for field in line.split()]
    assert fields == pytest.approx(tails / 9.80665, rel=5.1e-8, abs=1e-99)


def test_non_ascii_letters_are_replaced(tmp_path):
    motion = GroundMotion(record().si, metadata={"event": "İzmir", "station": "Muğla"})
    motion.to_at2(tmp_path / "w.AT2")
    assert GroundMotion.read(tmp_path / "w.AT2").metadata["station"] == "Mu?la"


def test_invalid_at2_output_is_refused(tmp_path):
    level = GroundMotion.from_arrays((VALUES, "m/s^2"), "0.01 s")
    with pytest.raises(ComponentError, match="no vertical component"):
        level.to_at2(tmp_path / "w.AT2", "vertical")
    with pytest.raises(ComponentError, match="component must be 'horizontal' or 'vertical'"):
        level.to_at2(tmp_path / "w.AT2", "up")
    with pytest.raises(FileError, match=r"w\.AT2: there is no folder"):
        level.to_at2(tmp_path / "nowhere" / "w.AT2")


def test_samples_of_analytic_motion_are_written(tmp_path):
    pulse = GroundMotion.sine_pulse()
    pulse.to_at2(tmp_path / "w.AT2")
    reread = GroundMotion.read(tmp_path / "w.AT2")
    samples = pulse.si.horizontal.samples
    np.testing.assert_allclose(reread.si.horizontal.samples, samples, rtol=5.1e-8, atol=1e-15)
