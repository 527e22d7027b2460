"""The cascade against two hand-written integrations in sequence."""

import numpy as np
from benchmarks.five_scenes import OUTPUT_STEP, motion, scenes

import rockframe as rf

AGREEMENT = 1e-7  # of the peak rotation
SECONDS = 4.0


def test_cascade_under_strong_motion():
    scene, excitation = scenes()["cascade"], motion().window("0 s", f"{SECONDS} s")
    ours = scene.system.simulate(
        excitation, accuracy=rf.Accuracy(rtol=1e-12), output_step=f"{OUTPUT_STEP} s"
    )
    theirs = scene.by_hand(
        time_step=excitation.si.time_step, acceleration=excitation.si.horizontal.samples,
        duration=SECONDS, sample_times=ours["time"].to_numpy(),
    )  # fmt: skip
    assert int(ours["impact_count"]) > 0
    peak = float(ours["peak_rotation"])
    np.testing.assert_allclose(ours["rotation"], theirs, rtol=0.0, atol=AGREEMENT * peak)
