"""Made-up record files, and what is read from them."""

import numpy as np

from rockframe.motion import GroundMotion

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


def check_same(found: GroundMotion, motion: GroundMotion) -> None:
    """Check that a motion is another one, bit for bit."""
    assert found == motion
    assert found.si.time_step == motion.si.time_step
    assert (found.si.vertical is None) == (motion.si.vertical is None)
    for name in ("horizontal", "vertical"):
        ours, theirs = getattr(motion.si, name), getattr(found.si, name)
        if ours is not None:
            assert ours.analytic == theirs.analytic
            assert ours.samples.tobytes() == theirs.samples.tobytes()
            assert ours.pieces.tobytes() == theirs.pieces.tobytes()
    assert found.history == motion.history
    assert dict(found.metadata) == dict(motion.metadata)
    assert found.name == motion.name
    assert found.to_dict() == motion.to_dict()
