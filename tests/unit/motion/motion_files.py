"""Synthetic record files."""

import numpy as np

G = 9.80665
TITLE = "PEER NGA STRONG MOTION DATABASE RECORD"
EVENT = "Made Up, 10/18/1989, Some Place, 67"
UNIT = "ACCELERATION TIME SERIES IN UNITS OF G"


def numbers(count: int) -> np.ndarray:
    """Samples that seven printed digits hold exactly."""
    k = np.arange(count)
    return np.round(0.2 * np.sin(0.7 * k) * np.exp(-0.01 * k) + 0.01, 7)


def rows(values, per_line: int = 5, form: str = "{:15.7E}", end: str = "\n") -> str:
    """Numbers in fixed width, `per_line` to a line."""
    printed = [form.format(value) for value in values]
    lines = ["".join(printed[k : k + per_line]) for k in range(0, len(printed), per_line)]
    return end.join(lines) + end


def at2(points_line: str, values, *, title=TITLE, event=EVENT, unit=UNIT, **layout) -> str:
    """A complete AT2 file."""
    end = layout.get("end", "\n")
    return end.join([title, event, unit, points_line]) + end + rows(values, **layout)
