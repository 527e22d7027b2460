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
        with pytest.raises(SystemExit) as exited:
            runpy.run_path(str(SCRIPT), run_name="__main__")
        return exited.value.code

    options = ("--amplitudes", 6, "--store", tmp_path / "study", "--folder", tmp_path / "new")
    assert run("--sizes", 5, *options) == 0
    stdout = capsys.readouterr().out
    with xr.open_dataset(tmp_path / "new" / "size_and_pulse.nc") as stored:
        assert stored.attrs["verdict"] in stdout
        assert dict(stored.status.sizes) == {"radius": 5, "peak_ground_acceleration": 6}
        # of two similar blocks the larger is more stable
        peaks = stored.peak_relative_rotation.to_numpy()
        assert peaks[0].max() > peaks[-1].max()
    assert (tmp_path / "new" / "size_and_pulse.png").stat().st_size > 10_000
    assert run("--sizes", 5, *options) == 0
    assert capsys.readouterr().out == stdout
    assert run("--sizes", 4, *options) == 1
    stderr = capsys.readouterr().err
    assert stderr.startswith("size_and_pulse: ")
    assert "found another study" in stderr
    assert stderr.count("\n") == 1
