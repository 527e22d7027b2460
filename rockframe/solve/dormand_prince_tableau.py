"""Coefficients of the Dormand-Prince pair of orders 5 and 4.

Source: J. R. Dormand, P. J. Prince, "A family of embedded Runge-Kutta formulae",
J. Comput. Appl. Math. 6 (1980) 19-26, table 2. The last stage of a step stands at its end, and
is the first of the next.
"""

from typing import Final

from rockframe.compiled import table

ORDER: Final = 5
STAGES: Final = 7

NODES: Final = table([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
"""Share of the step at which each stage stands."""

# weights of the stages before, by which each is made; the last makes the step
STAGE_1: Final = (1 / 5,)
STAGE_2: Final = (3 / 40, 9 / 40)
STAGE_3: Final = (44 / 45, -56 / 15, 32 / 9)
STAGE_4: Final = (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729)
STAGE_5: Final = (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656)
STAGE_6: Final = (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84)

STAGE_WEIGHTS: Final = table([*STAGE_1, *STAGE_2, *STAGE_3, *STAGE_4, *STAGE_5, *STAGE_6])
"""The same, one after the other: those of stage s, which has s stages before, from s(s-1)/2 on."""

WEIGHTS: Final = table([*STAGE_6, 0.0])
"""Weights of the fifth order."""

ERROR_WEIGHTS: Final = table(
    [71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]
)
"""Weights of the fifth order less those of the fourth."""
