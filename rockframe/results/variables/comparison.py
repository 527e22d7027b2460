"""Variables of a comparison of models and accuracies."""

from typing import Final

from rockframe.results.variables.variable import Variable
from rockframe.units import Unit

COMPARISON: Final = (
    Variable("run_time", (), Unit.SECOND, "wall time of a run, median of the repetitions"),
    Variable("run_time_least", (), Unit.SECOND, "least wall time of a run"),
    Variable("run_time_greatest", (), Unit.SECOND, "greatest wall time of a run"),
    Variable(
        "numerical_peak_error",
        (),
        Unit.ONE,
        "relative error of the peak rotation, against the same model at a tight tolerance",
    ),
    Variable(
        "numerical_history_error",
        (),
        Unit.ONE,
        "largest error of the rotation over its peak, against the same model at a tight tolerance",
    ),
    Variable(
        "event_time_error",
        (),
        Unit.SECOND,
        "largest error of an event's time, NaN if the events are others",
    ),
    Variable(
        "peak_error", (), Unit.ONE, "relative error of the peak rotation, against the scene itself"
    ),
    Variable(
        "history_error",
        (),
        Unit.ONE,
        "largest error of the rotation over its peak, against the scene itself",
    ),
    Variable(
        "verdict_agrees",
        (),
        None,
        "whether the verdict is that of the scene itself",
        dtype="bool",
    ),
)
"""One for each rung."""
