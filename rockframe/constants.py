"""Physical and bibliographic constants, each with its source."""

from typing import Final

STANDARD_GRAVITY: Final = 9.80665
"""Standard acceleration of free fall [m s^-2] (3rd CGPM, 1901; exact by definition)."""

PAPER_TITLE: Final = "Analysis of a Simplified Model of a Rigid Rocking Block on Winkler Foundation"
"""Title of the paper whose equation numbers are cited throughout."""

CONVENTIONS: Final = "CF-1.11"
"""Metadata conventions that datasets follow (cfconventions.org)."""
