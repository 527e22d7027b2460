"""Rocking bodies by Newton and Euler in maximal coordinates, with an own treatment of events.

Each body has the coordinates (x, y, angle) of its centre of mass; what holds it horizontally is a
constraint with a Lagrange multiplier, and contact forces follow from the places and speeds of the
corners. The laws are those of the manual; nothing of ``rockframe`` is used to integrate them.

The functions are compiled by numba and kept beside the sources. Numba does not notice that a
function changed which another file calls: after an edit remove ``__pycache__``.
"""
