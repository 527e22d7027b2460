"""Marks tests by their folder, and deselects benchmarks and long tests by default."""

import logging
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

os.environ.setdefault("MPLBACKEND", "agg")
# tests run machine code from the first run on; benchmarks wait for all of it
os.environ.setdefault("ROCKFRAME_COMPILE", "wait" if "benchmarks" in sys.argv else "often")
# each worker has one core: threads of linear algebra would only compete
os.environ.setdefault("OMP_NUM_THREADS", "1")
_ROOT = Path(__file__).parent
# the same random scenes in every run, so that failures come from changes of the code;
# new ones with ROCKFRAME_RANDOM in the environment
settings.register_profile(
    "rockframe", derandomize="ROCKFRAME_RANDOM" not in os.environ, database=None
)
settings.load_profile("rockframe")


class _Fallbacks(logging.Handler):
    """Collects messages about functions that could not be compiled."""

    def __init__(self) -> None:
        super().__init__()
        self.messages: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        if "could not be compiled" in record.msg:
            self.messages.append(record.getMessage())


_fallbacks = _Fallbacks()
logging.getLogger("rockframe").addHandler(_fallbacks)


@pytest.fixture(autouse=True)
def fallbacks() -> Iterator[list[str]]:
    """Fail where a function could not be compiled, unless the test clears this list."""
    yield _fallbacks.messages
    message = "; ".join(_fallbacks.messages)
    _fallbacks.messages.clear()
    assert not message, message


@pytest.fixture(autouse=True)
def closed_figures() -> Iterator[None]:
    """Close the figures of a test; pyplot warns when more than twenty are open."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Skip drawing of figures in reports, most of their time, for tests of the text."""
    from rockframe.plot import _panels
    from rockframe.reports import page

    monkeypatch.setattr(page, "_rendered", lambda figure, kind: b"<svg/>")
    # it makes all ticks of a figure, to find letters missing in their font
    monkeypatch.setattr(_panels, "add_fallback_fonts", lambda artists: None)


def pytest_configure(config: pytest.Config) -> None:
    from rockframe.compiled import COMPILED

    if COMPILED and hasattr(config, "workerinput"):
        from rockframe.compiled import parallel

        # each worker has one core: a second compiling process would load all libraries again
        parallel.processors = lambda: 1


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Let idle workers take tests that wait behind a long one."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log) if config.getvalue("dist") == "load" else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    left_out = {"benchmarks"} if config.option.markexpr else {"benchmarks", "long", "wide"}
    # named files, folders and tests run completely
    if any(Path(argument).resolve() != _ROOT for argument in config.args):
        left_out -= {"long", "wide"}
    kept, others = [], []
    for item in items:
        item.add_marker(getattr(pytest.mark, item.path.relative_to(_ROOT).parts[0]))
        names = {marker.name for marker in item.iter_markers()}
        requested = any(name in config.option.markexpr for name in names & left_out)
        (kept if requested or not names & left_out else others).append(item)
    if others:
        config.hook.pytest_deselected(items=others)
        items[:] = kept
