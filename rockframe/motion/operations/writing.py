"""Export of ground motions to files for other programs."""

from __future__ import annotations

import os
from hashlib import sha256
from pathlib import Path
from typing import Final

import numpy as np

from rockframe.arguments import checked_choice
from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import ComponentError
from rockframe.motion.value import GroundComponent, MotionValue
from rockframe.suggestions import with_hints
from rockframe.writing import FileKind, checked_path, write_file

_TITLE: Final = "PEER FORMAT ACCELERATION FILE, WRITTEN BY ROCKFRAME"
AT2_KIND: Final = FileKind.marked("an acceleration file", (".at2",), _TITLE)
_UNIT: Final = "ACCELERATION TIME SERIES IN UNITS OF G"
_PER_LINE: Final = 5
_USUAL_DECIMALS: Final = 4
_SMALLEST: Final = 1e-99
"""Acceleration below which zero is written: three digits of an exponent leave no space [g]."""


@with_hints()
def to_at2(
    motion: MotionValue,
    path: str | os.PathLike[str],
    component: GroundComponent | str = GroundComponent.HORIZONTAL,
    *,
    overwrite: bool = False,
) -> None:
    """Write a PEER acceleration file (AT2), which most programs read.

    Parameters
    ----------
    path : str or path-like
        File, with a name that ends in ``.AT2``. A file that this method wrote is replaced.
    component : {"horizontal", "vertical"}, optional
        Component to write; the vertical one is positive upwards.
    overwrite : bool, optional
        Whether an existing file of another origin is replaced; the file from which the motion
        was read never is.

    Raises
    ------
    ComponentError
        Another component, or the motion has no vertical one.
    FileError
        The file cannot be written, its name has another ending, or it exists already and this
        method did not write it.

    Notes
    -----
    Four header lines have a title; event, station and component; the unit; number of samples and
    time step. The samples follow in g, five in a line, with eight digits, so that their relative
    rounding error is at most 5e-8. The time step has all its digits. For an analytic motion the
    samples are written, without the polynomials between them.

    Examples
    --------
    >>> import tempfile
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.sine_pulse("3 m/s^2", "2 Hz")
    >>> path = f"{tempfile.mkdtemp()}/pulse.AT2"
    >>> pulse.to_at2(path)
    >>> print(rf.GroundMotion.read(path).peak_acceleration.to("m/s^2").round(3))
    3.0 meter / second ** 2
    """
    owner = f"{type(motion).__name__}.to_at2"
    which = checked_choice(GroundComponent, component, owner=owner, name="component")
    signal = motion.si.horizontal
    named = str(motion.metadata.get("component", ""))
    if which is GroundComponent.VERTICAL:
        if motion.si.vertical is None:
            msg = f"{owner}: the motion has no vertical component"
            raise ComponentError(msg)
        signal, named = motion.si.vertical, "UP"
    step = motion.si.time_step
    usual = f"{step:.{_USUAL_DECIMALS}f}"
    printed_step = usual if float(usual) == step else repr(step)
    event = str(motion.metadata.get("event", motion.name))
    station = str(motion.metadata.get("station", ""))
    # not every program reads characters outside ASCII
    ascii_parts = (
        ascii_part.encode("ascii", "replace").decode() for ascii_part in (event, station, named)
    )
    parts = [" ".join(ascii_part.replace(",", " ").split()) for ascii_part in ascii_parts]
    values = signal.samples / STANDARD_GRAVITY
    values[np.abs(values) < _SMALLEST] = 0.0
    samples = [f"{value:15.7E}" for value in values.tolist()]
    rows = [samples[k : k + _PER_LINE] for k in range(0, len(samples), _PER_LINE)]
    lines = [
        _TITLE,
        ", ".join(parts),
        _UNIT,
        f"NPTS= {len(samples):6d}, DT= {printed_step:>7} SEC,",
        *("".join(row) for row in rows),
    ]
    text = "\n".join(lines) + "\n"
    content = text.encode("ascii")
    checked_path(path, AT2_KIND, overwrite=True)
    read = [path] if _is_source(motion, path, content) else []
    write_file(path, AT2_KIND, content, overwrite=overwrite, read=read)


def _is_source(motion: MotionValue, path: str | os.PathLike[str], content: bytes) -> bool:
    """Whether a motion was read from this file, and writing would change it."""
    digest = motion.metadata.get("source_sha256")
    place = Path(path).expanduser()
    if digest is None or not place.is_file():
        return False
    existing = place.read_bytes()
    return existing != content and sha256(existing).hexdigest() == digest
