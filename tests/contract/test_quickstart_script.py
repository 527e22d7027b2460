"""The script of the quick start: its folder, its components, its errors."""

import runpy
import sys
from pathlib import Path

import pytest

import rockframe as rf

SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "quickstart.py"


@pytest.fixture
def script(monkeypatch):
    def run(*arguments):
        monkeypatch.setattr(sys, "argv", [str(SCRIPT), *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            runpy.run_path(str(SCRIPT), run_name="__main__")
        return left.value.code

    return run


@pytest.fixture
def record(tmp_path):
    pulse = rf.GroundMotion.sine_pulse("0.5 m/s^2")
    path = tmp_path / "record.nc"
    pulse.with_vertical(pulse.scaled(0.5)).to_dataset().to_netcdf(path)
    return path


def test_a_missing_folder_is_made(script, record, tmp_path):
    folder = tmp_path / "not" / "there"
    assert script(record, "--folder", folder) == 0
    assert {path.name for path in folder.iterdir()} == {"quickstart.nc", "quickstart.png"}


def test_invalid_folder_is_reported_before_simulation(script, record, capsys):
    assert script(record, "--folder", record) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("quickstart: ")
    assert captured.err.count("\n") == 1


def test_errors_are_one_line(script, record, tmp_path, capsys):
    assert script(record, "--component", "XYZ", "--folder", tmp_path) == 1
    assert "'XYZ'" in capsys.readouterr().err
    assert script(tmp_path / "none.AT2", "--folder", tmp_path) == 1
    stderr = capsys.readouterr().err
    assert "none.AT2" in stderr
    assert stderr.count("\n") == 1


def test_component_option_requires_a_record(script, capsys):
    assert script("--component", "NS") == 2
    assert "--component" in capsys.readouterr().err
