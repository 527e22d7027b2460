"""How many files and functions of the package one run goes through: a block on pads, uncompiled.

``python tests/benchmarks/walk.py`` counts each function once; with ``list`` it names them, with how
often each is called. What modules, classes and comprehensions do when they are made is not counted.
"""

import os
import sys
from collections import Counter
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

os.environ["ROCKFRAME_COMPILE"] = "0"

import rockframe as rf
import rockframe.simulation.run  # what a run imports is there before it is walked through

PACKAGE = str(Path(rf.__file__).parent) + os.sep
CALLS: Counter[CodeType] = Counter()
FUNCTION = 3  # flags of code that is optimised and has names of its own


def count(frame: FrameType, event: str, _: Any) -> None:
    """Count a call, where it is one of the package."""
    code = frame.f_code
    if event == "call" and code.co_filename.startswith(PACKAGE):
        CALLS[code] += 1


def main() -> None:
    """Walk from ``System(...)`` to the dataset."""
    block = rf.Block(width="1 m", height="4 m", mass="1 t")
    pads = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
    motion = rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz")
    system = rf.System  # imported before it is walked through
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
