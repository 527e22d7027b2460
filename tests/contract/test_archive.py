"""The package in an archive that Python imports from: its own files are found there, too."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import rockframe as rf

pytestmark = pytest.mark.contract

PACKAGE = Path(rf.__file__).parent
PROGRAM = """
import sys, threading
from urllib.request import urlopen
import rockframe as rf
from rockframe.serve import Server

assert "archive.zip" in rf.__file__
system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
motion = rf.GroundMotion.example()
run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
assert "</script>" in rf.plot.player(run).to_html()
rf.export.to_opensees(system, motion, "model.py")
rf.report(run, "report.html")
with Server() as server:
    threading.Thread(target=server.serve_forever, daemon=True).start()
    for name in ("/", "/page.css", "/page.js"):
        assert urlopen(server.address.rstrip("/") + name).read()
    server.shutdown()
"""


def test_package_in_archive_finds_its_files(tmp_path):
    with zipfile.ZipFile(tmp_path / "archive.zip", "w") as archive:
        for path in PACKAGE.rglob("*"):
            if path.is_file() and path.suffix != ".pyc":
                archive.write(path, path.relative_to(PACKAGE.parent))
    environment = {
        **os.environ,
        "PYTHONPATH": str(tmp_path / "archive.zip"),
        "ROCKFRAME_COMPILE": "0",
    }
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
