"""Markers from the path: a test's kind is the folder it stands in."""

from pathlib import Path

import pytest

_ROOT = Path(__file__).parent


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    kept, timings = [], []
    for item in items:
        kind = item.path.relative_to(_ROOT).parts[0]
        item.add_marker(getattr(pytest.mark, kind))
        (timings if kind == "benchmarks" else kept).append(item)
    if timings and "benchmarks" not in config.option.markexpr:
        config.hook.pytest_deselected(items=timings)
        items[:] = kept
