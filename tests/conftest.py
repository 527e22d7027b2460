"""Markers from the path: a test's kind is the folder it stands in; and what is left out."""

import logging
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

os.environ.setdefault("MPLBACKEND", "agg")
# so that machine code is what is tested, from the first run on; and all of what is timed
os.environ.setdefault("ROCKFRAME_COMPILE", "wait" if "benchmarks" in sys.argv else "often")
# each worker has a core: threads of linear algebra would only wait for one another
os.environ.setdefault("OMP_NUM_THREADS", "1")
_ROOT = Path(__file__).parent
# the same random scenes in every run, so that what fails has to do with what was changed;
# with ROCKFRAME_RANDOM in the environment, new ones
settings.register_profile(
    "rockframe", derandomize="ROCKFRAME_RANDOM" not in os.environ, database=None
)
settings.load_profile("rockframe")


class _Fallbacks(logging.Handler):
    """Keeps what is said of functions that could not be compiled."""

    def __init__(self) -> None:
        super().__init__()
        self.said: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        if "could not be compiled" in record.msg:
            self.said.append(record.getMessage())


_fallbacks = _Fallbacks()
logging.getLogger("rockframe").addHandler(_fallbacks)


@pytest.fixture(autouse=True)
def fallbacks() -> Iterator[list[str]]:
    """Fail where something was not compiled and ran as plain Python, unless a test clears this."""
    yield _fallbacks.said
    said = "; ".join(_fallbacks.said)
    _fallbacks.said.clear()
    assert not said, said


@pytest.fixture(autouse=True)
def closed_figures() -> Iterator[None]:
    """Close the figures of a test, of which pyplot would keep and warn of more than twenty."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave figures of reports undrawn, most of the time of one, where a test reads its words."""
    from rockframe.plot import _panels
    from rockframe.reports import page

    monkeypatch.setattr(page, "_rendered", lambda figure, kind: b"<svg/>")
    # it makes all ticks of a figure, to look for letters that their font lacks
    monkeypatch.setattr(_panels, "add_fallback_fonts", lambda artists: None)


def pytest_configure(config: pytest.Config) -> None:
    from rockframe.compiled import COMPILED

    if COMPILED and hasattr(config, "workerinput"):
        from rockframe.compiled import parallel

        # each worker has a core: a second process that compiles loads all libraries once more
        parallel.processors = lambda: 1


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Have a worker that is done take what waits in another's queue behind a long test."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log) if config.getvalue("dist") == "load" else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    left_out = {"benchmarks"} if config.option.markexpr else {"benchmarks", "long", "wide"}
    # a file, folder or test that is named is run with all that it holds
    if any(Path(argument).resolve() != _ROOT for argument in config.args):
        left_out -= {"long", "wide"}
    kept, others = [], []
    for item in items:
        item.add_marker(getattr(pytest.mark, item.path.relative_to(_ROOT).parts[0]))
        names = {marker.name for marker in item.iter_markers()}
        asked = any(name in config.option.markexpr for name in names & left_out)
        (kept if asked or not names & left_out else others).append(item)
    if others:
        config.hook.pytest_deselected(items=others)
        items[:] = kept
