"""A folder with a scene, records and studies, and commands that are carried out in it."""

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
    """Return the environment of processes whose single short run is no matter for a compiler."""
    return os.environ | {"ROCKFRAME_COMPILE": "0"}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Stand in a folder with a scene and a record."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(TEMPLATES["block"])
    rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz").to_at2("record.AT2")
    return tmp_path


@pytest.fixture
def typed(capsys):
    """Carry out a command; give its exit code and what it wrote."""

    def carry_out(*words):
        code = main(list(words))
        told = capsys.readouterr()
        return code, told.out, told.err

    return carry_out


@pytest.fixture
def piped(capsysbinary, monkeypatch):
    """Carry out a command that is handed a file; give its exit code and what it wrote, in bytes."""

    def carry_out(handed, *words):
        monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(handed), closed=False))
        code = main(list(words))
        told = capsysbinary.readouterr()
        return code, told.out, told.err.decode()

    return carry_out
