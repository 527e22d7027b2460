"""Timing, and the description of the machine."""

import os
import platform
import time
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PACKAGES = ("rockframe", "numpy", "scipy", "numba", "openseespy")


def cost(function: Callable[[], object], repeats: int) -> float:
    """Return the least processor time of several calls [s].

    Processor time excludes waiting for other work on the machine.
    """
    times = []
    for _ in range(repeats):
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
    return min(times)


def machine() -> dict[str, str | int]:
    """Describe the machine and the versions."""
    description: dict[str, str | int] = {
        "processor": _processor(),
        "cores": os.cpu_count() or 0,
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
    }
    for name in PACKAGES:
        try:
            description[name] = version(name)
        except PackageNotFoundError:
            if name == "rockframe":
                import rockframe

                description[name] = getattr(rockframe, "__version__", "of the working copy")
            else:
                description[name] = "not installed"
    return description


def _processor() -> str:
    table = Path("/proc/cpuinfo")
    if table.is_file():
        for line in table.read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or "unknown"
