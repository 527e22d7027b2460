"""The example of the critical scale: its output, its file and its errors."""

import runpy
import sys
from pathlib import Path

import pytest
import xarray as xr

import rockframe as rf

SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "critical_scale.py"


def test_script_prints_verdict_and_saves_result(monkeypatch, tmp_path, capsys):
    rf.GroundMotion.sine_pulse("2 m/s^2", "0.5 Hz").to_dataset().to_netcdf(tmp_path / "record.nc")

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", [str(SCRIPT), *map(str, arguments)])
        with pytest.raises(SystemExit) as exited:
            runpy.run_path(str(SCRIPT), run_name="__main__")
        return exited.value.code

    folder = tmp_path / "not" / "there"
    assert run(tmp_path / "record.nc", "--folder", folder) == 0
    with xr.open_dataset(folder / "critical_scale.nc") as stored:
        assert stored.attrs["verdict"] in capsys.readouterr().out
        assert stored.critical_scale.notnull()
    assert run(tmp_path / "record.nc", "--largest", -1, "--folder", folder) == 1
    stderr = capsys.readouterr().err
    assert stderr.startswith("critical_scale: ")
    assert stderr.count("\n") == 1
