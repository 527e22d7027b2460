"""Two rigid blocks, one upon the other, that slide on the ground and on one another.

Newton's equations of both bodies in their six places (x, y, rotation of the lower centre of mass,
then of the upper one, relative to the ground), with a normal force at each end that bears and
friction along each interface; patterns of what bears and what slips are found by trying all.
Nothing of ``rockframe`` is used but by ``compare``, and of ``rigid_pair`` only what a body is and
how the ground moves.

The upper base stands within the top of the lower body, and touches it with its own two ends.
"""
