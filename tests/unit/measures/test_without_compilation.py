"""Spectra with and without compilation agree."""

import os
import subprocess
import sys

import numpy as np
import pytest

RUN = """
import sys
import numpy as np
import rockframe as rf
from rockframe.measures import response_spectrum

rng = np.random.default_rng(3)
record = rf.GroundMotion.from_arrays(
    (np.convolve(rng.normal(size=100), np.ones(3)), "m/s^2"), "0.02 s"
)
pulse = rf.GroundMotion.harmonic("1 m/s^2", "1.5 Hz", duration="3.1 s", phase="50 deg")
periods = (np.concatenate([[0.0], np.geomspace(0.003, 20.0, 15)]), "s")
found = {}
for name, motion in (("record", record), ("pulse", pulse)):
    answer = response_spectrum(motion, periods, (0.0, 0.05, 1.0))
    found |= {f"{name} {key}": value.values for key, value in answer.data_vars.items()}
np.savez(sys.argv[1], **found)
"""


@pytest.mark.wide
@pytest.mark.skipif(
    os.environ.get("ROCKFRAME_COMPILE") == "0", reason="compilation is off in this run"
)
@pytest.mark.filterwarnings("ignore:response_spectrum. the record is sampled")
def test_compiled_and_plain_agree(tmp_path, monkeypatch):
    pytest.importorskip("numba")
    files = {compiled: tmp_path / f"{compiled}.npz" for compiled in ("wait", "0")}
    monkeypatch.setattr(sys, "argv", ["", str(files["wait"])])
    exec(RUN, {})  # noqa: S102
    subprocess.run(
        [sys.executable, "-c", RUN, str(files["0"])],
        env=os.environ | {"ROCKFRAME_COMPILE": "0"},
        check=True,
    )
    results = {compiled: np.load(file) for compiled, file in files.items()}
    assert set(results["wait"].files) == set(results["0"].files)
    for name in results["wait"].files:
        one, other = results["wait"][name], results["0"][name]
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-10 * one.max(), err_msg=name)


def test_a_long_motion_is_filtered_in_pieces(monkeypatch):
    from rockframe.compiled import COMPILED

    if COMPILED:
        pytest.skip("the filter is for runs without compilation")
    from rockframe.signals import filtering

    pieces = np.random.default_rng(1).normal(size=(500, 2))
    periods = np.array([0.05, 0.3, 4.0])
    expected = filtering.filter_all(pieces, 0.02, 0.05, periods)
    monkeypatch.setattr(filtering, "_STEPS_IN_PART", 64)
    np.testing.assert_allclose(
        filtering.filter_all(pieces, 0.02, 0.05, periods), expected, rtol=1e-10
    )
