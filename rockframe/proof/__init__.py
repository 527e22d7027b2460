"""Verdicts of a block on rigid ground or on pads that are proved, by ball arithmetic.

Section "Proved verdicts" of the theory manual. The modules below need python-flint; whoever asks
for a proof imports them then.
"""
