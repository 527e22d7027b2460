"""Sweeps: a scene at all combinations of values, or at all rows of a table."""
