"""Number of files and functions of the package used by one run: a block on pads, uncompiled.

``python tests/benchmarks/walk.py`` counts each function once; with ``list`` it names them, with
the number of calls of each. Bodies of modules, classes and comprehensions are not counted.
"""

import os
import sys
from collections import Counter
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

os.environ["ROCKFRAME_COMPILE"] = "0"

import rockframe as rf
import rockframe.simulation.run  # imports come before the run, so that they are not counted

PACKAGE = str(Path(rf.__file__).parent) + os.sep
CALLS: Counter[CodeType] = Counter()
FUNCTION = 3  # flags of code of functions


def count(frame: FrameType, event: str, _: Any) -> None:
    """Count a call of the package."""
    code = frame.f_code
    if event == "call" and code.co_filename.startswith(PACKAGE):
        CALLS[code] += 1


def main() -> None:
    """Count calls from ``System(...)`` to the dataset."""
    block = rf.Block(width="1 m", height="4 m", mass="1 t")
    pads = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
    motion = rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz")
    system = rf.System  # imported beforehand, not counted
    sys.setprofile(count)
    system(block, pads).simulate(motion, duration="3 s")
    sys.setprofile(None)
    functions = sorted(
        (code.co_filename.removeprefix(PACKAGE), code.co_firstlineno, code.co_qualname, often)
        for code, often in CALLS.items()
        if code.co_flags & FUNCTION == FUNCTION and not code.co_name.startswith("<")
    )
    if sys.argv[1:] == ["list"]:
        for file, line, name, often in functions:
            print(f"{file}:{line} {name} {often}")
    print(f"{len({file for file, *_ in functions})} files, {len(functions)} functions")


if __name__ == "__main__":
    main()
