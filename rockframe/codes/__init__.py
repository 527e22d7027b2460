"""Checks by codes of practice, each formula with its clause, with the computed motion."""

from typing import TYPE_CHECKING

from rockframe.codes.asce import asce_7_22
from rockframe.codes.circolare import circolare_2019
from rockframe.reports.checks import CheckedLine, CheckedVerdict, CodeCheck
from rockframe.suggestions import module_getattr

__all__ = ["CheckedLine", "CheckedVerdict", "CodeCheck", "asce_7_22", "circolare_2019"]

if not TYPE_CHECKING:  # or no name would be unknown to type checkers
    __getattr__ = module_getattr(__name__, __all__)


def __dir__() -> list[str]:
    return __all__
