"""Computing time against error, over models and accuracies, and the choice among these."""

import json
import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Final, TypeAlias, Unpack, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_integer, checked_list
from rockframe.comparison.models import model_ladder
from rockframe.errors import (
    ComponentError,
    ModelWarning,
    SchemaError,
    SolverWarning,
    did_you_mean,
    short_repr,
)
from rockframe.motion import GroundMotion
from rockframe.results.outcome import MIN_REPORTED_SLIP, PEAK_SLIPS, verdict_of
from rockframe.results.schema import build_dataset
from rockframe.shared_arguments import with_shared_arguments
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.plan import Plan, plan_run
from rockframe.simulation.provenance import motion_attributes
from rockframe.simulation.run import compute_response, run
from rockframe.simulation.run_arguments import ComparedArguments
from rockframe.simulation.system import System, check_system
from rockframe.solve.accuracy import Accuracy, AccuracyLevel, accuracy_of
from rockframe.solve.equations import (
    compile_in_next_run,
    equations_of,
    is_fully_compiled,
    runs_as_python,
)
from rockframe.suggestions import suggests_names, with_hints
from rockframe.system.options import AccuracyLike
from rockframe.units import POSITIVE, to_ratio


def verdicts_agree(run: xr.Dataset, reference: xr.Dataset) -> bool:
    """Tell whether two runs both reached a verdict, and the same one."""
    return verdict_of(run) is not None and verdict_of(run) == verdict_of(reference)


def relative_peak_error(run: xr.Dataset, reference: xr.Dataset) -> float:
    """Return the greater of the relative errors of peak rotation and of peak slip [1]."""
    if _without_verdict(run, reference):
        return float("nan")
    peak, slips = float(reference["peak_rotation"]), _slips(reference)
    error = _relative(abs(float(run["peak_rotation"]) - peak), peak)
    slip = float(np.max(slips))
    if slip < MIN_REPORTED_SLIP:
        return error
    return max(error, float(np.max(np.abs(_slips(run) - slips))) / slip)


def _slips(run: xr.Dataset) -> AnyArray:
    """Return the peak slips of all bodies of a run, or zero if its model has no sliding [m]."""
    slips = [np.atleast_1d(run[name].to_numpy()) for name in PEAK_SLIPS if name in run]
    return np.concatenate(slips) if slips else np.zeros(1)


def history_error(run: xr.Dataset, reference: xr.Dataset) -> float:
    """Return the largest difference of both histories of rotation over the reference's peak [1]."""
    if _without_verdict(run, reference):
        return float("nan")
    rotation, expected = (data["rotation"].to_numpy() for data in (run, reference))
    times = [data["time"].to_numpy() for data in (run, reference)]
    count = min(rotation.size, expected.size)
    while count > 0 and times[0][count - 1] != times[1][count - 1]:
        count -= 1  # a run that overturned ends between two samples of the other
    peak = float(np.max(np.abs(expected), initial=0.0))
    return _relative(float(np.max(np.abs(rotation[:count] - expected[:count]), initial=0.0)), peak)


def event_time_error(run: xr.Dataset, reference: xr.Dataset) -> float:
    """Return the largest difference of the times of events [s]; NaN if their kinds differ."""
    alike = np.array_equal(run["event_kind"].to_numpy(), reference["event_kind"].to_numpy())
    if _without_verdict(run, reference) or not alike:
        return float("nan")
    difference = run["event_time"].to_numpy() - reference["event_time"].to_numpy()
    return float(np.max(np.abs(difference), initial=0.0))


def _without_verdict(*runs: xr.Dataset) -> bool:
    return any(verdict_of(run) is None for run in runs)


def _relative(difference: float, scale: float) -> float:
    if difference == 0.0:
        return 0.0
    return difference / scale if scale > 0.0 else float("inf")


BENCHMARK_TOLERANCE: Final = 1e-12
BENCHMARK: Final = Accuracy(rtol=BENCHMARK_TOLERANCE)
"""Accuracy of the runs against which errors are measured; their own errors are about `TIGHT`."""

Outcome: TypeAlias = dict[str, float | int | bool]

_COPIED_SCALARS: Final = ("peak_rotation", "overturned", "energy_residual", "status")
_OWNER: Final = "tradeoff"
_MAX_REPEATS: Final = 1000
_COMPILE_TIMEOUT: Final = 60.0
"""Longest wait for machine code before a model is timed [s]."""


@with_shared_arguments(ComparedArguments)
def tradeoff(
    system: System,
    motion: GroundMotion | None = None,
    *,
    models: Sequence[str] | str | None = None,
    accuracies: Sequence[AccuracyLike] | AccuracyLike = tuple(AccuracyLevel),
    repeats: int = 5,
    **arguments: Unpack[ComparedArguments],
) -> xr.Dataset:
    """Measure computing time and error of each model of a scene at each accuracy.

    Parameters
    ----------
    system : System
        The scene, whose own model is the reference for errors of the models.
    motion : GroundMotion, optional
        Motion of the ground. By default it is the one among the parts.
    models : str or sequence of str, optional
        Names of :func:`rockframe.model_ladder`. By default all are compared.
    accuracies : str, float or Accuracy, or sequence of them, optional
        Levels, tolerances (``rtol``), or own settings.
    repeats : int, optional
        Number of runs that are timed, for each model and accuracy.

    Returns
    -------
    xarray.Dataset
        Over ``model`` and ``accuracy``:

        - ``run_time`` (median), ``run_time_least`` and ``run_time_greatest`` of runs that keep
          no histories [s];
        - the outcome: ``peak_rotation``, ``overturned``, ``energy_residual``, ``status``, and
          ``peak_slip`` of a scene that slides [m];
        - errors against the same model at a tolerance of 1e-12: ``numerical_peak_error``,
          ``numerical_history_error`` [1] and ``event_time_error`` [s];
        - errors against the scene itself at that tolerance: ``peak_error``, ``history_error``
          [1] and ``verdict_agrees``.

        Where the scene slides, the error of peaks is the greater of those of rotation and of
        slip. If a run was cut off before its verdict, errors of it and against it are NaN, and
        its verdict agrees with none.

    Raises
    ------
    ComponentError
        If `system` is not a System, models are unknown, or `repeats` is out of range.
    UnitsError, AssemblyError, SolverError
        As for :meth:`rockframe.System.simulate`.

    Notes
    -----
    Each model is run before it is timed, until its machine code is compiled. Times are wall
    times on this machine and can only be compared with one another. Histories are compared at
    the output times, until one of both runs ends because its body overturns. Their largest
    difference is divided by the peak of the whole history of the reference; it is more than 1
    where both rotate to opposite sides, or one of them much further.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> found = rf.tradeoff(
    ...     system, pulse, models="rigid ground", accuracies=["fast", "standard"], repeats=1
    ... )
    >>> found.verdict_agrees.values.tolist()
    [[True, True]]
    """
    check_system(system, _OWNER)
    repeats = checked_integer(repeats, owner=_OWNER, name="repeats", lowest=1, highest=_MAX_REPEATS)
    models_of_scene = model_ladder(system)
    chosen = _select_models(models_of_scene, models)
    one = isinstance(accuracies, float | int | Accuracy)
    given: object = [accuracies] if one else accuracies
    entries = checked_list(given, owner=_OWNER, name="accuracies", of="accuracies")
    if not entries:
        msg = f"{_OWNER}: accuracies must be one or more, got {short_repr(accuracies)}"
        raise ComponentError(msg)
    settings = {_label(accuracy): accuracy_of(accuracy, owner=_OWNER) for accuracy in entries}
    record = system.motion if motion is None else motion

    def plan(scene: System, accuracy: Accuracy) -> Plan:
        return plan_run(scene.assembly, record, accuracy=accuracy, **arguments)

    with warnings.catch_warnings():
        # a simpler model may warn of effects that it leaves out; the errors measure these
        warnings.simplefilter("ignore", ModelWarning)
        warnings.simplefilter("ignore", SolverWarning)
        reference = run(system.assembly, plan(system, BENCHMARK))
        rows: list[list[Outcome]] = []
        for scene in chosen.values():
            plans = [plan(scene, setting) for setting in settings.values()]
            converged = run(scene.assembly, plan(scene, BENCHMARK))
            rows.append([measure_run(scene, p, converged, reference, repeats) for p in plans])
    names = rows[0][0]
    settings_of_labels = {label: vars(setting) for label, setting in settings.items()}
    dataset = build_dataset(
        {name: np.array([[cell[name] for cell in row] for row in rows]) for name in names},
        {
            "scene": list(models_of_scene)[-1],
            "benchmark_rtol": BENCHMARK_TOLERANCE,
            "repeats": repeats,
            "settings": json.dumps(settings_of_labels),
            "system_json": system.assembly.json,
            **motion_attributes(record),
        },
        over=DIMENSIONS,
        title="Speed against accuracy",
        source="repeated runs",
    )
    dataset = dataset.assign_coords(
        model=("model", list(chosen), {"long_name": "model"}),
        accuracy=("accuracy", list(settings), {"long_name": "accuracy of the integration"}),
    )
    return dataset.assign_attrs(verdict=recommend(dataset).sentence)


def measure_run(
    scene: System, plan: Plan, converged: xr.Dataset, reference: xr.Dataset, repeats: int
) -> Outcome:
    """Run a model at an accuracy, time it, and compare it with both references."""
    response = run(scene.assembly, plan)
    bare = replace(plan, output_step=None)
    _run_until_compiled(scene, bare)
    times = [_time_of_run(scene, bare) for _ in range(repeats)]
    return {
        "run_time": float(np.median(times)),
        "run_time_least": min(times),
        "run_time_greatest": max(times),
        "numerical_peak_error": relative_peak_error(response, converged),
        "numerical_history_error": history_error(response, converged),
        "event_time_error": event_time_error(response, converged),
        "peak_error": relative_peak_error(response, reference),
        "history_error": history_error(response, reference),
        "verdict_agrees": verdicts_agree(response, reference),
        **{name: response[name].item() for name in _COPIED_SCALARS},
        **{name: float(response.get(name, 0.0)) for name in ("peak_slip",) if name in reference},
    }


def _run_until_compiled(scene: System, plan: Plan) -> None:
    """Run a model until its machine code is compiled, so that no run in plain Python is timed."""
    system = scene.assembly.model.system
    equations = equations_of(
        system, fixed_steps=plan.accuracy.rtol is None, with_work=bool(plan.energies),
        compiled_in=True,
    )  # fmt: skip
    compile_in_next_run(equations)
    deadline = time.perf_counter() + _COMPILE_TIMEOUT
    while not (is_fully_compiled(equations) or runs_as_python(equations)):
        if time.perf_counter() > deadline:
            return
        compute_response(scene.assembly, plan)


def _time_of_run(scene: System, plan: Plan) -> float:
    start = time.perf_counter()
    compute_response(scene.assembly, plan)
    return time.perf_counter() - start


def _select_models(known: dict[str, System], models: object) -> dict[str, System]:
    if models is None:
        return known
    requested = checked_list(models, owner=_OWNER, name="models", of="models")
    unknown = [name for name in requested if not isinstance(name, str) or name not in known]
    if unknown or not requested:
        names = ", ".join(repr(name) for name in known)
        near = did_you_mean(unknown[0], known) if unknown else ""
        msg = f"{_OWNER}: models must be some of {names}, got {short_repr(requested)}{near}"
        raise ComponentError(msg)
    return {name: known[name] for name in requested}


def _label(value: AccuracyLike) -> str:
    if isinstance(value, float):
        return f"rtol {float(value)!r}"
    if isinstance(value, Accuracy):
        every = ((field.name, getattr(value, field.name), field.default) for field in fields(value))
        return ", ".join(f"{name} {one}" for name, one, usual in every if one != usual)
    return str(value)


_RECOMMEND: Final = "recommend"
_MIN_PERCENTAGE: Final = 1e-4
"""Smallest error written as a percentage; a percentage with an exponent is easily misread."""
DIMENSIONS: Final = ("model", "accuracy")
_NEEDED: Final = ("run_time", "verdict_agrees", *DIMENSIONS)
_ERRORS: Final = {"peak_error": "the peak rotation", "history_error": "the rotation along time"}


@suggests_names
@dataclass(frozen=True)
class Recommendation:
    """The cheapest model and accuracy that meet a tolerance; ``str`` gives it as a sentence.

    Parameters
    ----------
    model, accuracy : str
        Labels of model and accuracy. If none meets the tolerance, those of the least error.
    met : bool
        Whether they meet the tolerance.
    sentence : str
        The recommendation in words.

    Examples
    --------
    >>> import rockframe as rf
    >>> best = Recommendation("rigid ground", "fast", met=True, sentence="Take 'rigid ground'.")
    >>> print(best)
    Take 'rigid ground'.
    """

    model: str
    accuracy: str
    met: bool
    sentence: str

    def __str__(self) -> str:
        return self.sentence


@with_hints()
def recommend(
    dataset: xr.Dataset, tolerance: float = 0.01, *, error: str = "peak_error"
) -> Recommendation:
    """Choose the cheapest model and accuracy with the right verdict and an admissible error.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset of :func:`rockframe.tradeoff`.
    tolerance : float, optional
        Admissible error of model and integration together, at most 1: 0.05 or ``"5 %"`` for
        five per cent [1].
    error : {"peak_error", "history_error"}, optional
        Error to which the tolerance applies.

    Returns
    -------
    Recommendation
        ``str`` of it is a sentence, and its ``model`` a key of :func:`rockframe.model_ladder`.

    Raises
    ------
    SchemaError
        If the dataset is no comparison of models, or has no such error.
    UnitsError, ComponentError
        If `tolerance` is not dimensionless, or not above 0 and at most 1.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> found = rf.tradeoff(system, pulse, models="rigid ground", accuracies="standard", repeats=1)
    >>> rf.recommend(found, "1 %").accuracy
    'standard'
    """
    limit = to_ratio(tolerance, owner=_RECOMMEND, name="tolerance", condition=POSITIVE)
    if limit > 1.0:
        msg = (
            f"{_RECOMMEND}: tolerance must be at most 1, the whole peak, got "
            f"{short_repr(tolerance)}; for {_plain_number(limit, 3)} % write "
            f"{_plain_number(0.01 * limit, 3)}"
        )
        raise ComponentError(msg)
    if not isinstance(cast("object", dataset), xr.Dataset):
        msg = (
            f"{_RECOMMEND}: found {short_repr(dataset)}; expected a comparison of models, "
            "as rockframe.tradeoff(system, motion) gives it"
        )
        raise SchemaError(msg)
    if not isinstance(cast("object", error), str) or error not in _ERRORS:
        known, near = " or ".join(map(repr, _ERRORS)), did_you_mean(error, _ERRORS)
        msg = f"{_RECOMMEND}: error must be {known}, got {short_repr(error)}{near}"
        raise SchemaError(msg)
    missing = [name for name in (error, *_NEEDED) if name not in dataset]
    if missing:
        msg = f"{_RECOMMEND}: found a dataset without {missing[0]!r}; expected one of tradeoff()"
        raise SchemaError(msg)
    # a part of a comparison may have lost a dimension, or have them in another order
    lost = [dim for dim in DIMENSIONS if dim not in dataset.dims]
    dataset = dataset.expand_dims(lost).transpose(*DIMENSIONS, ...)
    agrees = dataset["verdict_agrees"].to_numpy()
    errors = np.where(agrees, dataset[error], np.inf)
    times = dataset["run_time"].to_numpy()
    admissible = errors <= limit
    # an error relative to no rotation at all is infinite, though the verdict is right
    nearness = np.where(agrees, np.minimum(errors, np.finfo(float).max), np.inf)
    ranking = np.where(admissible, times, np.inf) if admissible.any() else nearness
    row, column = np.unravel_index(int(np.argmin(ranking)), ranking.shape)
    model = str(dataset["model"].to_numpy()[row])
    accuracy = str(dataset["accuracy"].to_numpy()[column])
    met = bool(admissible.any())
    choice = f"{model!r} at accuracy {accuracy!r}"
    cost = f"{_plain_number(1e3 * times[row, column], 3)} ms a run"
    quantity = _ERRORS[error] + " or slip" * (error == "peak_error" and "peak_slip" in dataset)
    distance = f"off by {_error_words(errors[row, column], 2)} in {quantity}"
    if met:
        slowest = float(np.max(times)) / float(times[row, column])
        gain = f", {_plain_number(slowest, 3)} times faster than the slowest rung"
        sentence = (
            f"For an error of at most {_error_words(limit, 3)}, take {choice}: {distance}, "
            f"{cost}{gain * (slowest > 1.0)}."
        )
        if error == "peak_error" and "overturned" in dataset and dataset["overturned"][row, column]:
            sentence += (
                " It overturns, and its peak is where that ends the run, in any model: "
                "error='history_error' compares them along time."
            )
    elif agrees[row, column]:
        sentence = f"No rung tried comes within {_error_words(limit, 3)}"
        if np.isfinite(errors[row, column]):
            sentence += f"; the nearest is {choice}: {distance}."
        else:
            sentence += ": the scene itself does not rotate, but all rungs with its verdict do."
    elif bool(dataset[error].isnull().all()):
        sentence = "There is no error: the scene itself or all rungs ended before their verdict."
    else:
        sentence = "No rung tried has the verdict of the scene itself."
    return Recommendation(model, accuracy, met, sentence)


def _error_words(value: float, digits: int) -> str:
    """Write an error as a percentage, or a very small one as a share of the peak."""
    if 0.0 < value < _MIN_PERCENTAGE:
        text = np.format_float_scientific(value, digits - 1, trim="-", exp_digits=1)
        return f"{text.replace('.e', 'e')} of the peak"
    return f"{_plain_number(100.0 * value, digits)} %"


def _plain_number(value: float, digits: int) -> str:
    """Write a number without an exponent, to `digits` digits or to the decimal point."""
    if value >= 10.0 ** (digits - 1):
        return f"{value:.0f}"
    return np.format_float_positional(value, digits, unique=False, fractional=False, trim="-")
