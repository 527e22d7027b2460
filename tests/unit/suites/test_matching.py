"""A suite matched to a target spectrum."""

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import RecordWarning

pytestmark = pytest.mark.filterwarnings("ignore:(?s).*the wavelets have changed")

TARGET = rf.TargetSpectrum.eurocode_8("0.2 g_0", "C")
RANGE = ("0.3 s", "0.6 s")


def suite(**verticals):
    motions = {
        f"motion {k}": rf.GroundMotion.stochastic(6.5, "20 km", seed=k).window("0 s", "12 s")
        for k in (1, 2)
    }
    return rf.MotionSuite(
        motions, unread={"readme.txt": "no record"}, remarks=["look"], **verticals
    )


def test_all_motions_match_target_spectrum():
    upwards = {"up": rf.GroundMotion.stochastic(6.5, "20 km", seed=3)}
    matched = suite(verticals=upwards).matched(TARGET, periods=RANGE)
    periods = np.geomspace(0.3, 0.6, 80)
    spectra = matched.response_spectrum((periods, "s")).pseudo_spectral_acceleration.squeeze()
    assert np.abs(spectra.to_numpy() / TARGET.at((periods, "s")) - 1.0).max() < 0.051
    assert list(matched) == ["motion 1", "motion 2"]
    assert not matched.verticals
    assert (matched.unread, matched.remarks) == ({"readme.txt": "no record"}, ("look",))
    table = matched.table
    assert (table["largest_spectral_misfit"] <= 0.05).all()
    assert (table["mean_spectral_misfit"] < table["largest_spectral_misfit"]).all()
    assert (table["scale_factor"] > 0.0).all()
    assert table["target_reached"].tolist() == [1, 1]
    dataset = matched.to_dataset()
    assert dataset["largest_spectral_misfit"].attrs["units"] == "1"
    assert dataset["peak_ground_velocity_after_matching"].attrs["units"] == "m s^-1"
    assert "pulse_indicator_before_matching" in table
    restored = rf.MotionSuite.from_dataset(dataset)
    assert [restored[label].sha256 for label in restored] == [
        motion.sha256 for motion in matched.values()
    ]
    assert restored["motion 1"].metadata == matched["motion 1"].metadata
    axes = rf.plot.suite(matched, target=TARGET)
    assert "target" in axes.get_legend_handles_labels()[1]


@pytest.mark.long
def test_unreached_target_warns_once_for_all_motions():
    jump = rf.TargetSpectrum.from_table(
        (["0.1 s", "0.4 s", "0.401 s", "1 s"]), ([9, 9, 1, 1], "m/s^2")
    )
    with pytest.warns(RecordWarning) as caught:
        suite().matched(jump, periods=RANGE)
    assert len(caught) == 1
    for label in ("motion 1", "motion 2"):
        assert f"{label!r}: GroundMotion.matched" in str(caught[0].message)
