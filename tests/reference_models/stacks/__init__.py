"""Stacks of rocking bodies by Newton and Euler in maximal coordinates.

Any number of bodies stand on one another, each on two pads or on a bed. A body has the coordinates
(x, y, angle) of its centre of mass; what holds it horizontally is a constraint with a Lagrange
multiplier, and contact forces follow from the places and speeds of the ends of its base. The laws
are those of the manual; nothing of ``rockframe`` is used. Ground motion, compiling and the
Runge-Kutta formula are those of ``maximal``.

After an edit of a compiled function remove ``__pycache__``: numba does not notice that a function
changed which another file calls.
"""
