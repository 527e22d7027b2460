"""The damping ratio of a base."""

from typing import Final

from rockframe.components.parameters import Ratio
from rockframe.units import NOT_NEGATIVE

CRITICAL: Final = 1.0
"""Damping ratio beyond which nothing vibrates [1]."""


class DampingRatio(Ratio[None]):
    """A damping ratio that stands for a damping coefficient; a large one brings a warning.

    Parameters
    ----------
    doc : str
        What it is, in a sentence.
    """

    def __init__(self, *, doc: str) -> None:
        super().__init__(NOT_NEGATIVE, doc=doc, default=None)

    def caution(self, value: float) -> str | None:
        """Ask whether per cent were meant, above 1."""
        if value <= CRITICAL:
            return None
        return (
            f"{self.name} = {value:.6g} is {100.0 * value:.6g} % of critical; "
            f"was '{value:.6g} %' meant?"
        )
