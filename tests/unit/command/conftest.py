"""Fixtures: a folder with a scene and a record, and commands run in it."""

import io
import os
import sys
from types import SimpleNamespace

import pytest

import rockframe as rf
from rockframe.command.files.templates import TEMPLATES
from rockframe.command.main import main


@pytest.fixture
def uncompiled():
    """Return the environment of processes whose short run needs no compilation."""
    return os.environ | {"ROCKFRAME_COMPILE": "0"}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Change to a folder with a scene and a record."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(TEMPLATES["block"])
    rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz").to_at2("record.AT2")
    return tmp_path


@pytest.fixture
def run_command(capsys):
    """Run a command; return exit code, output and error output."""

    def run(*words):
        code = main(list(words))
        output = capsys.readouterr()
        return code, output.out, output.err

    return run


@pytest.fixture
def run_with_input(capsysbinary, monkeypatch):
    """Run a command with standard input; return exit code, output in bytes and error output."""

    def run(data, *words):
        monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(data), closed=False))
        code = main(list(words))
        output = capsysbinary.readouterr()
        return code, output.out, output.err.decode()

    return run
