"""Checks by codes of practice, each formula with its clause, with the computed motion."""

from typing import TYPE_CHECKING

from rockframe.codes.asce import asce_7_22
from rockframe.codes.circolare import circolare_2019
from rockframe.reports.checks import CheckedLine, CheckedVerdict, CodeCheck
from rockframe.suggestions import public_names

__all__ = ["CheckedLine", "CheckedVerdict", "CodeCheck", "asce_7_22", "circolare_2019"]

if not TYPE_CHECKING:  # otherwise type checkers would accept any name
    __getattr__, __dir__ = public_names(__name__, __all__)
