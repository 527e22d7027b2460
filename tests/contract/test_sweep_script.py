"""The example of a sweep: its output, its file, its errors, and its resumption."""

import runpy
import sys
from pathlib import Path

import pytest
import xarray as xr

SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "size_and_pulse.py"


def test_script_prints_verdict_and_saves_resumable_runs(monkeypatch, tmp_path, capsys):
    def run(*arguments):
        monkeypatch.setattr(sys, "argv", [str(SCRIPT), *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            runpy.run_path(str(SCRIPT), run_name="__main__")
        return left.value.code

    options = ("--amplitudes", 6, "--store", tmp_path / "study", "--folder", tmp_path / "new")
    assert run("--sizes", 5, *options) == 0
    told = capsys.readouterr().out
    with xr.open_dataset(tmp_path / "new" / "size_and_pulse.nc") as kept:
        assert kept.attrs["verdict"] in told
        assert dict(kept.status.sizes) == {"radius": 5, "peak_ground_acceleration": 6}
        # the larger of two blocks of one shape is the more stable one
        peaks = kept.peak_relative_rotation.to_numpy()
        assert peaks[0].max() > peaks[-1].max()
    assert (tmp_path / "new" / "size_and_pulse.png").stat().st_size > 10_000
    assert run("--sizes", 5, *options) == 0
    assert capsys.readouterr().out == told
    assert run("--sizes", 4, *options) == 1
    told = capsys.readouterr().err
    assert told.startswith("size_and_pulse: ")
    assert "found another study" in told
    assert told.count("\n") == 1
