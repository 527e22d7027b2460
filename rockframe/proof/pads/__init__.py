"""Verdicts of the block on two pads that are proved.

Section "Proved verdicts" of the theory manual.
"""
