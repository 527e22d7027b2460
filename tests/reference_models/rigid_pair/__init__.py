"""Two rigid blocks, one on the other, on rigid ground.

Lagrange's equations in minimal coordinates for each pattern of contacts are integrated by SciPy;
impacts project the six velocities on the motions that a pattern allows. Bearing contacts do not
slide. Only ``compare`` uses ``rockframe``.

A pattern names the ends that bear, of the base of the lower block on the ground and of the base of
the upper one on the top of the lower one: "both", "left", "right" or "none". Rotations are absolute
and clockwise, the upper block's last: (x, y, rotation) of the lower centre of mass, then of the
upper one.
"""
