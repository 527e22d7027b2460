"""Scripts of users pass mypy as strictly as pyright."""

import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.contract, pytest.mark.long]

SCRIPT = Path(__file__).parents[1] / "strictly_typed.py"


def test_script_of_user_passes_mypy(tmp_path):
    api = pytest.importorskip("mypy.api", reason="mypy is not installed")
    words = ["--strict", "--python-executable", sys.executable, "--cache-dir", str(tmp_path)]
    found, problems, code = api.run([*words, str(SCRIPT)])
    assert not code, found + problems
