"""Figures of analyses of many runs, drawn when the manual is built."""

import runpy
from pathlib import Path

from matplotlib.figure import Figure

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def office_contents() -> Figure:
    """Draw the medians of the example."""
    example = runpy.run_path(str(EXAMPLES / "office_contents.py"))
    return example["draw"](
        example["comparison_table"](example["fragilities"](example["synthetic_motions"](6), None))
    )
