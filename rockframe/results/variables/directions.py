"""Variables of both horizontal components of a record."""

from typing import Final

from rockframe.results.variables.variable import OSCILLATOR, Variable
from rockframe.units import Unit

DIRECTIONS: Final = (
    Variable(
        "median_rotated_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "median over all directions of the pseudo-spectral acceleration (RotD50)",
    ),
    Variable(
        "greatest_rotated_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "greatest over all directions of the pseudo-spectral acceleration (RotD100)",
    ),
    Variable(
        "geometric_mean_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "geometric mean of the pseudo-spectral accelerations of the components",
    ),
    Variable(
        "direction_of_greatest",
        OSCILLATOR,
        Unit.RADIAN,
        "direction of the greatest pseudo-spectral acceleration, from the first component on",
    ),
    Variable(
        "vertical_spectral_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "pseudo-spectral acceleration of the vertical component",
    ),
    Variable(
        "vertical_to_horizontal_ratio",
        OSCILLATOR,
        Unit.ONE,
        "vertical over median horizontal pseudo-spectral acceleration",
    ),
    Variable(
        "major_axis_angle", (), Unit.RADIAN, "direction of the major axis, from the first component"
    ),
    Variable(
        "major_arias_intensity", (), Unit.METRE_PER_SECOND, "Arias intensity along the major axis"
    ),
    Variable(
        "minor_arias_intensity", (), Unit.METRE_PER_SECOND, "Arias intensity along the minor axis"
    ),
    Variable(
        "average_spectral_acceleration",
        (),
        Unit.METRE_PER_SECOND_SQUARED,
        "geometric mean over periods of the pseudo-spectral acceleration",
    ),
    Variable(
        "average_geometric_mean_acceleration",
        (),
        Unit.METRE_PER_SECOND_SQUARED,
        "geometric mean over periods of the geometric mean of both components",
    ),
    Variable(
        "average_median_rotated_acceleration",
        (),
        Unit.METRE_PER_SECOND_SQUARED,
        "geometric mean over periods of the median over all directions",
    ),
)
"""Of two horizontal components."""
