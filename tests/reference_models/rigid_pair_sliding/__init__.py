"""Two rigid blocks, one on the other, that slide on the ground and on each other.

Newton's equations of both bodies in their six places (x, y, rotation of the lower centre of mass,
then of the upper one, relative to the ground), with a normal force at each end that bears and
friction along each interface; patterns of bearing and slip are found by trying all.
Only ``compare`` uses ``rockframe``; bodies and ground motions are those of ``rigid_pair``.

The upper base lies within the top of the lower body, and touches it with its own two ends.
"""
