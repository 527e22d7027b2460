from pathlib import Path

import pytest


@pytest.fixture
def write(tmp_path: Path):
    """Write text or bytes to a file and return its path."""

    def _write(content: str | bytes, name: str = "record.AT2") -> Path:
        path = tmp_path / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return _write
