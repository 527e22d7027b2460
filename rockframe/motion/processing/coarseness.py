"""Records that are sampled too coarsely for a period."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from rockframe.errors import RecordWarning, warn

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rockframe.signals import Signal

FEWEST: Final = 10
"""Samples per period below which straight lines lower an ordinate by more than 3 %."""

_ROUNDING: Final = 1e-9


def say_coarse(
    signals: Iterable[Signal], shortest: float, *, owner: str, remedy: str | None = None
) -> None:
    """Warn of records that are too coarse for the shortest of the periods asked for."""
    steps = [one.time_step for one in signals if not one.analytic]
    coarse = [step for step in steps if shortest < FEWEST * step * (1.0 - _ROUNDING)]
    if not coarse:
        return
    which = f"{len(coarse)} of {len(steps)} records are" if len(steps) > 1 else "the record is"
    helps = remedy or f"resampled('{finer(max(coarse), shortest):.4g} s') refines a record"
    msg = (
        f"{owner}: {which} sampled every {max(coarse):.4g} s, which is coarse for periods "
        f"from {shortest:.4g} s: straight lines between samples lower ordinates by 3 % at ten "
        f"samples per period and 13 % at five; {helps}"
    )
    warn(msg, RecordWarning)


def finer(time_step: float, shortest: float) -> float:
    """Give the whole part of a time step that is fine enough for a period [s]."""
    return time_step / math.ceil(FEWEST * time_step / shortest * (1.0 - _ROUNDING))
