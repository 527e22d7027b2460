"""Proofs of the verdicts of a block on two pads.

Section "Proved verdicts" of the theory manual.
"""
