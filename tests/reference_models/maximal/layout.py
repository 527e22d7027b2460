"""Indices of the arrays that describe a scene, its state and its contact.

Body 0 is the lower one (a body or a cap on soil), body 1 the block on pads or on rigid ground.
The state has twelve numbers: x, y, angle of body 0, of body 1, and their rates; then two works,
the dissipated energy and the work of the ground. Angles are clockwise, y is up, and all is
zero at rest.
"""

# kinds of scene
PADS, BED, CASCADE, COUPLED, RIGID = 0, 1, 2, 3, 4

# restraint rules
CONTACT_STATE, LEADING_CORNER, CENTRE = 0, 1, 2
RULES = ("contact-state", "leading-corner", "centre")

# parameters
(
    MASS,  # of the block
    INERTIA,  # about its centre of mass
    HALF_WIDTH,
    HALF_HEIGHT,
    STIFFNESS,  # of one pad
    DAMPING,  # of one pad
    SETTLEMENT,  # of the pads
    LOWER_MASS,
    LOWER_INERTIA,
    LOWER_HALF_WIDTH,
    LOWER_HEIGHT,  # of its centre of mass above its base
    BED_STIFFNESS,  # per length
    BED_DAMPING,
    BED_SETTLEMENT,
    GRAVITY,
    RULE,
    SMALL,  # 1 for small rotation
    KIND,
    NO_SUCTION,  # 1 for separation by pressure
    LIMIT,  # overturning angle, the lesser one
    TOP,  # height of the middle of the lower body's top above its centre of mass
    TOLERANCE,
    ECCENTRICITY,  # of the block: its centre of mass to the right of the middle of its base
    LOWER_ECCENTRICITY,
    LEFT_RESTITUTION,  # of a corner that lands there
    RIGHT_RESTITUTION,
    LEFT_LIMIT,  # overturning angles to either side
    RIGHT_LIMIT,
) = range(28)
PARAMETERS = 28

# contact: indices in the array of integers
LOWER_HOLD, BED_LEFT, BED_RIGHT, HOLD, LEFT, RIGHT, CUT_START, CUT_END = range(8)
CONTACTS = 8
# how a body is held
FREE, HELD, SLIDING, RESTING = 0, 1, 2, 3
# states of a corner or an end of a base
CLEAR, RELAXING, TOUCHING, LEAVING, ENGAGING, SLIDES = 0, 1, 2, 3, 4, 5

# held points: indices in the array of floats
LOWER_POINT, LOWER_PLACE, LOWER_SENSE, LOWER_LEAD, POINT, PLACE, SENSE, LEAD = range(8)

# guards
LEFT_GUARDS, RIGHT_GUARDS, LEAD_GUARD = 0, 3, 6
BED_LEFT_GUARD, BED_RIGHT_GUARD, BED_SLIP_GUARD, BED_LEVER_GUARD = 7, 8, 9, 10
LOWER_LEAD_GUARD, LIMIT_GUARD, CUT_GUARDS = 11, 12, 13
GUARDS = 15

# how a run ended
COMPLETED, OVERTURNED, CHATTER, TOO_SMALL, FIRED = 0, 1, 2, 3, 4

LEAST_LEVER = 1e-7
STATES = 14
