"""Verdicts of the block on rigid ground that are proved, by ball arithmetic.

Section "Proved verdicts" of the theory manual. The modules below need python-flint; whoever asks
for a proof imports them then.
"""
