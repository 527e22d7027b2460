"""Proofs of the verdicts of a block on rigid ground or on pads, by ball arithmetic.

Section "Proved verdicts" of the theory manual. The modules need python-flint, and are imported when
a proof is requested (`simulation/proving.py`).
"""
