"""Two rigid blocks, one upon the other, on rigid ground.

Lagrange's equations in the fewest coordinates of each pattern of contacts, integrated by SciPy;
impacts by projection of the six velocities on the motions that a pattern allows. Contacts that
bear are held against sliding. Nothing of ``rockframe`` is used but by ``compare``.

A pattern names the ends that bear, of the base of the lower block on the ground and of the base of
the upper one on the top of the lower one: "both", "left", "right" or "none". Rotations are absolute
and clockwise, the upper block's last: (x, y, rotation) of the lower centre of mass, then of the
upper one.
"""
