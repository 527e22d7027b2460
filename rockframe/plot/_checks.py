"""What a figure is drawn from, and what is said of anything else."""

import json
import warnings
from os import PathLike
from typing import TYPE_CHECKING, Final, cast

import xarray as xr

from rockframe.errors import ComponentError, RockframeWarning, SchemaError

if TYPE_CHECKING:
    from rockframe.simulation.system import System

_NEEDED: Final = {
    "response": "the result of one run with histories, as system.simulate(motion) gives it",
    "scene": "a System",
    "tradeoff": "a comparison of models, as rf.tradeoff(system, motion) gives it",
    "selection": (
        "a set of motions beside its target, as rf.select_for_target(suite, target, 11) gives it"
    ),
    "motion": "a GroundMotion",
    "spectra": "a GroundMotion",
    "fragility": "a fragility, as rf.fragility(runs) gives it",
    "dynamic_analysis": (
        "a dynamic analysis, as rf.incremental_dynamic_analysis(system, motions) gives it"
    ),
    "overturning_map": "a map, as rf.overturning_map(system, pulse, ...) gives it",
    "rocking_spectrum": "a spectrum, as rf.rocking_spectrum(system, motions, ...) gives it",
    "overturning_spectrum": "a spectrum, as rf.overturning_spectrum(system, ...) gives it",
    "probability": "a sample, as rf.probability_of_overturning(system, motions, ...) gives it",
    "ensemble": "an ensemble, as rf.ensemble_statistics(runs) gives it",
    "critical_scale": "a critical scale, as rf.critical_scale(system, motion) gives it",
    "free_decay": "a fit, as rf.fit_free_decay(system, measured) gives it",
    "suite": "a set of GroundMotions",
}
_STUDIES: Final = {
    "fragility": ("exceedance_probability", "fragility_status"),
    "dynamic_analysis": ("capacity_scale", "flip_count", "peak_relative_rotation", "scale"),
    "overturning_map": ("impacts_before_overturning", "amplitude_above", "amplitude"),
    "rocking_spectrum": ("peak_relative_rotation", "rocking_period"),
    "overturning_spectrum": ("capacity_intensity", "rocking_period"),
    "probability": ("overturning_probability", "first_order_index"),
    "ensemble": ("ordered_value", "cumulative_probability"),
    "critical_scale": ("critical_scale", "scale_above", "outcome", "peak_rotation"),
    "free_decay": ("fitted_value", "parameter", "initial_rotation"),
}
"""Variables by which the results of studies are known, by what draws them."""
_RUN: Final = (
    "ground_acceleration",
    "relative_rotation",
    "contact_state",
    "overturning_angle",
    "uplift_angle",
    "overturned",
)
_RUNGS: Final = (
    "run_time",
    "numerical_history_error",
    "history_error",
    "verdict_agrees",
    "model",
    "accuracy",
)
_SELECTION: Final = (
    "scaled_spectral_acceleration",
    "target_spectral_acceleration",
    "target_standard_deviation",
    "set_median_acceleration",
    "set_standard_deviation",
    "scale_factor",
    "spectral_misfit",
)
_KNOWN: Final = {
    **_STUDIES,
    "tradeoff": ("run_time", "verdict_agrees"),
    "selection": ("scaled_spectral_acceleration", "target_spectral_acceleration"),
    "response": ("relative_rotation", "time", "contact_state"),
}
"""Variables by which a dataset is known, by what draws it."""
_DRAWN_BY: Final = (
    # (variables, what they are, what draws them), the first that fits
    *(
        (names, _NEEDED[function].partition(",")[0], f"rf.plot.{function} draws it")
        for function, names in _STUDIES.items()
    ),
    (("run_time", "verdict_agrees"), "a comparison of models", "rf.plot.tradeoff draws it"),
    (
        ("scaled_spectral_acceleration", "target_spectral_acceleration"),
        "a set of motions beside its target",
        "rf.plot.selection draws it",
    ),
    (("rotation", "time", "overturned"), "the result of a run", "rf.plot.response draws it"),
    (
        ("overturned", "peak_rotation"),
        "the result of a run without histories",
        "simulate with outputs=() instead of None",
    ),
    (
        ("pseudo_spectral_acceleration",),
        "response spectra",
        "rf.plot.spectra draws them from the motion itself",
    ),
    (
        ("fourier_amplitude",),
        "a Fourier spectrum",
        "rf.plot.spectra draws it from the motion itself",
    ),
    (
        ("ground_velocity",),
        "velocity and displacement of the ground",
        "rf.plot.motion draws them from the motion itself",
    ),
)


def drawn_by(given: xr.Dataset) -> str:
    """Give the function that draws a dataset."""
    for function, names in _KNOWN.items():
        if _holds(given, names):
            return function
    if "peak_relative_rotation" in given and given["peak_relative_rotation"].ndim > 0:
        return "sweep"
    for names, what, way in _DRAWN_BY:
        if _holds(given, names):
            msg = f"no function of rf.plot draws a Dataset with {what}; {way}"
            raise SchemaError(msg)
    msg = (
        "no function of rf.plot draws this dataset; known are results of runs, sweeps, studies "
        "and comparisons"
    )
    raise SchemaError(msg)


def check_run(given: object, function: str) -> None:
    """Refuse what is not the result of one run with histories."""
    if not isinstance(given, xr.Dataset) or not _holds(given, ("rotation", "time", "overturned")):
        raise SchemaError(refuse(function, given))
    _check_complete(function, given, _RUN)
    more = [str(name) for name in given["relative_rotation"].dims if name != "time"]
    if more:
        msg = (
            f"rf.plot.{function} needs {_needed(function)}, got several runs over "
            f"{', '.join(more)}; pick one, for example with dataset.isel({more[0]}=0)"
        )
        raise SchemaError(msg)
    if given.sizes["time"] < 2:
        msg = (
            f"rf.plot.{function} needs {_needed(function)}, got one of a single instant; "
            "simulate for longer, or with a shorter output_step"
        )
        raise SchemaError(msg)


def check_rungs(given: object) -> None:
    """Refuse what is not a comparison of models and accuracies."""
    if not isinstance(given, xr.Dataset) or not _holds(given, ("run_time", "verdict_agrees")):
        raise SchemaError(refuse("tradeoff", given))
    _check_complete("tradeoff", given, _RUNGS)


def check_study(given: object, function: str) -> xr.Dataset:
    """Refuse what is not the result of a study."""
    if not isinstance(given, xr.Dataset) or not _holds(given, _STUDIES[function]):
        raise SchemaError(refuse(function, given))
    return given


def check_selection(given: object) -> None:
    """Refuse what is not a set of motions beside a target."""
    wanted = ("scaled_spectral_acceleration", "target_spectral_acceleration")
    if not isinstance(given, xr.Dataset) or not _holds(given, wanted):
        raise SchemaError(refuse("selection", given))
    _check_complete("selection", given, _SELECTION)


def check_motion(given: object, function: str) -> None:
    """Refuse what is not a ground motion."""
    from rockframe.motion import GroundMotion

    if not isinstance(given, GroundMotion):
        raise ComponentError(refuse(function, given))


def require_system(given: object, function: str) -> None:
    """Refuse what is not a system."""
    from rockframe.simulation.system import System

    if not isinstance(given, System):
        raise ComponentError(refuse(function, given))


def system_of_run(run: xr.Dataset, function: str) -> "System":
    """Build the system of a run, without its motion."""
    from rockframe.simulation.system import System

    text = run.attrs.get("system_json")
    if not isinstance(text, str):
        msg = (
            f"rf.plot.{function}: the dataset has no attribute 'system_json'; expected the result "
            "of simulate() with its attributes"
        )
        raise SchemaError(msg)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RockframeWarning)  # they were said when it ran
        return System.from_dict(json.loads(text))


def _check_complete(function: str, given: xr.Dataset, names: tuple[str, ...]) -> None:
    missing = [repr(name) for name in names if name not in given.variables]
    if missing:
        msg = (
            f"rf.plot.{function} needs {_needed(function)}, got one that lacks "
            f"{', '.join(missing)}; give it the whole dataset"
        )
        raise SchemaError(msg)


def refuse(function: str, given: object) -> str:
    """Say what a function draws, what was given, and which way leads to a figure."""
    what, way = _words(function, given)
    return f"rf.plot.{function} needs {_needed(function)}, got {what}" + (f"; {way}" if way else "")


def _words(function: str, given: object) -> tuple[str, str]:
    """Say what was given, and which way leads to a figure."""
    from rockframe.motion import GroundMotion
    from rockframe.simulation.system import System

    if isinstance(given, str | PathLike):
        name = str(cast("object", given))
        of_motions = function in ("motion", "spectra")
        opened = "rf.GroundMotion.read" if of_motions else "xr.open_dataset"
        return f"{name!r}", f"open the file first: rf.plot.{function}({opened}({name!r}))"
    if isinstance(given, GroundMotion):
        return f"a GroundMotion, {given.name!r}", "rf.plot.motion and rf.plot.spectra draw it"
    if isinstance(given, System):
        way = "rf.plot.scene draws it, rf.plot.response(system.simulate(motion)) what becomes of it"
        return "a System", way
    if isinstance(given, xr.DataArray):
        return f"a DataArray, {given.name!r}", "a figure is drawn from the whole Dataset"
    if not isinstance(given, xr.Dataset):
        return f"{given!r}" if given is None else f"a value of type {type(given).__name__}", ""
    for names, what, way in _DRAWN_BY:
        if _holds(given, names):
            return f"a Dataset with {what}", way
    title = given.attrs.get("title")
    return "a Dataset" + (f" with the title {title!r}" if title else " of another kind"), ""


def _needed(function: str) -> str:
    """Say what a function draws; what is not listed draws runs."""
    return _NEEDED.get(function, _NEEDED["response"])


def _holds(given: xr.Dataset, names: tuple[str, ...]) -> bool:
    return all(name in given.variables for name in names)


def overturning_angles(dataset: xr.Dataset) -> tuple[float, float]:
    """Give the overturning angles to the left and to the right [rad]."""
    least = dataset["overturning_angle"]
    left, right = (dataset.get(f"{side}_overturning_angle", least) for side in ("left", "right"))
    return float(left), float(right)
