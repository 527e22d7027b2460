"""Stacks of rocking bodies by Newton and Euler in maximal coordinates.

Any number of stacked bodies stand on two pads or on a bed each. A body has the coordinates
(x, y, angle) of its centre of mass; it is held horizontally by a constraint with a Lagrange
multiplier, and contact forces follow from the positions and speeds of the ends of its base. The
laws are those of the manual; nothing of ``rockframe`` is used. Ground motion, compilation and the
Runge-Kutta formula are those of ``maximal``.

Numba does not notice changes of functions called from other files: remove ``__pycache__`` after an
edit.
"""
