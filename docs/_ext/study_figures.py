"""Figures of studies, drawn when the manual is built."""

import runpy
from pathlib import Path

from matplotlib.figure import Figure

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def size_and_pulse() -> Figure:
    """Draw the map of the example."""
    example = runpy.run_path(str(EXAMPLES / "size_and_pulse.py"))
    return example["draw"](example["study"](50, 60, None))
