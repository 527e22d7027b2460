"""Rocking bodies by Newton and Euler in maximal coordinates, with an independent event search.

Each body has the coordinates (x, y, angle) of its centre of mass; it is held horizontally by a
constraint with a Lagrange multiplier, and contact forces follow from the places and speeds of the
corners. The laws are those of the manual; nothing of ``rockframe`` is used to integrate them.

The functions are compiled by numba and cached beside the sources. Numba does not notice changes of
functions called from other files: remove ``__pycache__`` after an edit.
"""
