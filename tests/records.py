"""Paths of the recorded motions that some tests read; none is stored with the tests."""

import os
from pathlib import Path

import pytest

RECORDS_VARIABLE = "ROCKFRAME_RECORDS"
_BESIDE_THE_PROJECT = Path(__file__).resolve().parents[2] / "shared" / "records"


def records_folder() -> Path:
    """Return the folder of recorded motions."""
    return Path(os.environ.get(RECORDS_VARIABLE, _BESIDE_THE_PROJECT))


def record_path(name: str) -> Path:
    """Return the path of a recorded motion, or skip the test if it is missing.

    Parameters
    ----------
    name : str
        File name.

    Returns
    -------
    Path
    """
    folder = records_folder()
    path = folder / name
    if not path.is_file():
        pytest.skip(f"the record {name} is not in {folder} (set {RECORDS_VARIABLE})")
    return path
