"""Names of version 0.1 that have moved; they remain for one version, with a warning."""

import warnings
from collections.abc import Callable, Iterable, Mapping
from importlib import import_module
from typing import Any, Final

from rockframe import errors

MOVED: Final = {
    **{name: f"rockframe.errors.{name}" for name in dir(errors)},
    "Case": "rockframe.studies.SweepCase",
    "Diagnostic": "rockframe.extension.Diagnostic",
    "Recommendation": "rockframe.comparison.Recommendation",
    "principal_axes": "rockframe.measures.principal_axes",
    "to_openquake": "rockframe.export.to_openquake",
    "to_pelicun": "rockframe.export.to_pelicun",
    "velocity_and_displacement": "rockframe.measures.velocity_and_displacement",
}
_ALTERNATIVES: Final = {
    "principal_axes": "; the direction alone is HorizontalPair.principal_axis",
    "velocity_and_displacement": "; the numbers alone are velocity and displacement of the motion",
}


def _fragility_of_counts(
    intensity: Any, exceeded: Any, trials: Any, *, measure: str = "PGA", **arguments: Any
) -> Any:
    from rockframe.studies import fragility

    counts = {"intensity": intensity, "exceeded": exceeded, "trials": trials}
    return fragility(counts, measure, **arguments)


def _scale_to_target(suite: Any, target: Any, **arguments: Any) -> Any:
    return _suite(suite).scaling_to(target, **arguments)


def _select_for_target(suite: Any, target: Any, count: int, **arguments: Any) -> Any:
    return _suite(suite).selection_for(target, count, **arguments)


def _suite(value: Any) -> Any:
    from rockframe.suites import MotionSuite

    plain = isinstance(value, Mapping) and not isinstance(value, MotionSuite)
    return MotionSuite(value) if plain else value  # pyright: ignore[reportUnknownArgumentType]


_REPLACED: Final[dict[str, tuple[Callable[..., Any], str]]] = {
    "fragility_of_counts": (_fragility_of_counts, "rockframe.fragility(counts)"),
    "scale_to_target": (_scale_to_target, "rockframe.MotionSuite.scaling_to"),
    "select_for_target": (_select_for_target, "rockframe.MotionSuite.selection_for"),
}


def deprecated_object(name: str, known: Iterable[str]) -> Any:
    """Return the object of an old name, and warn with the new one; else propose a similar name."""
    if name in _REPLACED:
        target, new_name = _REPLACED[name]
    elif name in MOVED:
        new_name = MOVED[name]
        home, _, attribute = new_name.rpartition(".")
        target = getattr(import_module(home), attribute)
    else:
        owner = "module 'rockframe'"
        raise errors.unknown_attribute(owner, name, known)
    text = f"rockframe.{name} is now {new_name}{_ALTERNATIVES.get(name, '')}"
    warnings.warn(text, DeprecationWarning, stacklevel=3)
    return target
