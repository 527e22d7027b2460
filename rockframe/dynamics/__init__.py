"""Equations of rocking bodies: pure functions of numbers, in SI units and per unit mass."""
