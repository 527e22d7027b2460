"""From the values of a case to the scene, and to where its run starts."""

import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, Final, TypeAlias

import numpy as np

from rockframe.arguments import call_signature, checked_choice
from rockframe.components import Component, InitialState, RockingFrame, Stack
from rockframe.components.parameters import Choice, Count, Declared, Flag, Text
from rockframe.errors import ModelWarning, StudyError, did_you_mean, short_repr, warn
from rockframe.motion import GroundMotion
from rockframe.results.schema import SCHEMA
from rockframe.shared_arguments import suggestion
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.system import System, system_hint
from rockframe.studies.sweeps.arguments import SWEEP_ARGUMENT_NAMES
from rockframe.studies.sweeps.axes import (
    OWNER,
    Axis,
    Changes,
    as_list,
    read_free_values,
    read_numbers,
    read_words,
)
from rockframe.studies.sweeps.identity import name_of_function
from rockframe.studies.sweeps.motions import MOTION_AXES, full_name, named_motions
from rockframe.system.assembly import Assembly, assemble_parts
from rockframe.system.links import axis_name
from rockframe.system.options import NUMERIC_OPTIONS, Coupling, Restraint, Rotation, Sliding
from rockframe.units import Measure, Unit, quantity

START_AXES: Final = {
    f"initial_{name}": (name, field.measure)
    for name, field in InitialState.declared().items()
    if field.measure is not None
}
"""Axes by their names: which parameter of an initial state each changes, and its kind."""
FUNCTION_ADVICE: Final = "instead of the system give a function of the axis that returns a System"
"""Advice for axes that no parameter of a scene's own parts has."""
IN_AXES: Final = ", in axes={...} or cases"
"""Where to write the name of an axis with a dot."""


Values: TypeAlias = Mapping[Axis, Any]
"""Values of one case, by the axes that change the scene."""

_CHOICES: Final[dict[str, tuple[type[StrEnum], str]]] = {
    "restraint": (Restraint, "point of the base that the ground holds horizontally"),
    "rotation": (Rotation, "kinematics"),
    "coupling": (Coupling, "how block, pads, cap and soil are joined"),
    "sliding": (Sliding, "what friction does"),
}
_OPTIONS: Final = (*_CHOICES, *NUMERIC_OPTIONS)
_SYSTEM: Final = System.__name__


@dataclass(frozen=True)
class SystemScene:
    """A system whose parameters axes name."""

    assembly: Assembly  # its parts and options, as they are where no axis changes them

    def axis(self, name: str, value: object) -> Axis:
        """Read an axis that names the motion's scale, an option, or a parameter of a part."""
        name = full_name(name)
        if (of_run := _run_axis(name, value)) is not None:
            return of_run
        kind, _, parameter = name.rpartition(".")
        if parameter in _OPTIONS and kind in ("", _SYSTEM):
            return _option_axis(name, parameter, value)
        matches = self._parts_with(parameter, kind, self.assembly.parts.components)
        matches = matches or self._parts_with(parameter, kind, self._parts())
        if len(matches) != 1:
            having = [part for _, part, _ in matches]
            raise StudyError(self._ambiguity_fault(name, parameter, having))
        ((slot, part, declared),) = matches
        fault = "" if declared.single else " is neither a number nor a word"
        if not fault and getattr(part, "members", ()):
            fault = f": this {type(part).__name__} was built from its members"
        if fault:
            msg = f"axis {name!r}{fault}; give a function of the axes that returns a System"
            raise StudyError(msg)
        values, unit = _declared_values(value, declared, name)
        _warn_of_unusual_values(declared, values, type(part).__name__)
        words = declared.__doc__ or parameter
        long_name = words.split(" [")[0].rstrip(".")
        return Axis(name, values, unit, long_name, Changes.PART, parameter, slot)

    def faults(self, axes: Iterable[Axis]) -> list[str]:
        """Say which axes change the same parameter, or are alternatives to one another."""
        faults: list[str] = []
        seen: dict[tuple[str, str, str], str] = {}
        for axis in axes:
            what = (axis.changes, axis.slot, axis.parameter)
            if what in seen:
                faults.append(f"{seen[what]!r} and {axis.name!r} are the same parameter")
            seen[what] = axis.name
        for slot, part in self._parts().items():
            values = {what: name for (_, place, what), name in seen.items() if place == slot}
            for alternative in part.alternatives:
                ways = [name for way in alternative.ways for name in way if name in values]
                heads = {way for way in alternative.ways if set(way) & set(values)}
                if len(heads) > 1:
                    names = " and ".join(repr(values[name]) for name in ways)
                    faults.append(f"axes {names} stand for one another; give one of them")
            if twice := part.too_many(values):
                names = " and ".join(repr(values[name]) for name in twice)
                faults.append(f"axes {names} of {type(part).__name__} determine its size twice")
            if behind := part.left_behind([*values]):
                faults.append(_unchanged_parameter_fault(part, behind, values))
        return faults

    def with_parts_of(self, axes: Iterable[Axis]) -> "SystemScene":
        """Return the scene with the rigid ground as a part, where axes name its parameters."""
        parts = self.assembly.parts
        if all(axis.slot in ("", *parts.components) for axis in axes):
            return self
        return SystemScene(assemble_parts(parts.with_ground(), self.assembly.options))

    def _parts(self) -> dict[str, Component]:
        """Return the parts whose parameters axes may name, by their slots."""
        return self.assembly.parts.with_ground().components

    def assembled(self, values: Values) -> Assembly:
        """Return the system with the values of a case in the place of its own."""
        parts, options = self.assembly.parts, self.assembly.options
        by_slot: dict[str, dict[str, Any]] = {}
        for axis, value in values.items():
            if axis.changes is Changes.PART:
                by_slot.setdefault(axis.slot, {})[axis.parameter] = value
        changed = {slot: parts[slot].with_si(changes) for slot, changes in by_slot.items()}
        changed_options = {
            axis.parameter: _option_value(axis.parameter, value)
            for axis, value in values.items()
            if axis.changes is Changes.OPTION
        }
        # options that no axis changes stay the same object, by which loads are shared
        options = replace(options, **changed_options) if changed_options else options
        assembly = assemble_parts(parts.replace(**changed, motion=None), options)
        for caution in assembly.setting.cautions():
            warn(caution, ModelWarning)
        return assembly

    def system(self, values: Values) -> System:
        """Return the same as users have it."""
        assembly = self.assembled(values)
        options: dict[str, Any] = assembly.options.to_dict()
        return System(*assembly.parts.structural(), **options)

    def _parts_with(
        self, parameter: str, kind: str, parts: Mapping[str, Component]
    ) -> list[tuple[str, Component, Declared[Any, Any, Any]]]:
        """Return the parts that have a parameter, with their slots and its declaration."""
        return [
            (slot, part, part.varied()[parameter])
            for slot, part in parts.items()
            if parameter in part.varied() and kind in ("", *self._names_of(part))
        ]

    def _names_of(self, part: Component) -> list[str]:
        """Return what axes may call a part: its class, and those that it is derived from."""
        # a link first what results call it, in one word: "restrainer 1" is restrainer_1
        link_names = [name for name, link in self.assembly.parts.named_links if link is part]
        kinds = [kind for kind in type(part).__mro__ if issubclass(kind, Component)]
        words = map(axis_name, link_names)
        return [*words, *link_names, *(kind.__name__ for kind in kinds if kind != Component)]

    def _ambiguity_fault(self, name: str, parameter: str, having: list[Component]) -> str:
        if having:
            kinds = [type(part).__name__ for part in having]
            if len(set(kinds)) < len(kinds):  # several links
                kinds = [self._names_of(part)[0] for part in having]
            ways = " or ".join(f"'{kind}.{parameter}'" for kind in kinds)
            return (
                f"axis {name!r} is a parameter of {' and '.join(kinds)}; name one: {ways}{IN_AXES}"
            )
        parts = self._parts().values()
        known = [
            f"{self._names_of(part)[0]}.{parameter}"
            for part in parts
            if "." in name and parameter in part.varied()
        ]
        if known:
            return (
                f"axis {name!r} names no part that has {parameter!r}{suggestion(name, known)} "
                f"There are {', '.join(known)}"
            )
        known = [*MOTION_AXES, *_OPTIONS, *START_AXES]
        known += [label for part in parts for label, field in part.varied().items() if field.single]
        listed = ", ".join(dict.fromkeys(known))
        if parameter in SWEEP_ARGUMENT_NAMES:
            return f"axis {name!r} is an argument of the runs, alike in all; axes are {listed}"
        for part in parts:
            if any(parameter in inner.varied() for inner in _inner_parts(part)):
                kind = type(part).__name__
                return f"axis {name!r} is a parameter of a part of the {kind}; {FUNCTION_ADVICE}"
        question = suggestion(parameter, [*known, *SWEEP_ARGUMENT_NAMES])
        return f"axis {name!r} names no parameter{question} There are {listed}"


def _inner_parts(part: Component) -> list[Component]:
    """Return the parts within a part, whose parameters no axis names."""
    if isinstance(part, Stack):
        return [*part.bodies, *part.interfaces]
    return [part.column] if isinstance(part, RockingFrame) else []


@dataclass(frozen=True)
class FunctionScene:
    """A function of the axes that returns a system."""

    # takes values by the names of axes: floats, whole numbers, truth values, words, and quantities
    # with units
    function: Callable[..., object]

    def axis(self, name: str, value: object) -> Axis:
        """Read an axis that names an argument, or else the motion's scale."""
        kinds = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
        argument = call_signature(self.function).parameters.get(name)
        if argument is None or argument.kind not in kinds:
            name = full_name(name)
            if (of_run := _run_axis(name, value)) is not None:
                return of_run
        values, unit = read_free_values(value, name)
        return Axis(name, values, unit, name.replace("_", " "), Changes.ARGUMENT, name)

    def faults(self, axes: Iterable[Axis]) -> list[str]:
        """Tell whether the function takes the axes, and all that it needs is among them."""
        values = {axis.name: None for axis in axes if axis.changes is Changes.ARGUMENT}
        signature = call_signature(self.function)
        try:
            signature.bind(**values)
        except TypeError as problem:
            unknown = [name for name in values if name not in signature.parameters]
            question = did_you_mean(unknown[0], SWEEP_ARGUMENT_NAMES) if unknown else ""
            return [f"the axes do not fit the arguments of {self.name}: {problem}{question}"]
        return []

    def assembled(self, values: Values) -> Assembly:
        """Call the function."""
        return self.system(values).assembly

    def system(self, values: Values) -> System:
        """Call the function; give its system."""
        arguments = {
            axis.name: value
            if axis.unit in (None, Unit.ONE)
            else quantity(value, Measure("a quantity", Unit(axis.unit), ""))
            for axis, value in values.items()
        }
        system = self.function(**arguments)
        if not isinstance(system, System):
            msg = f"{self.name} must return a System, got {short_repr(system)}"
            raise StudyError(msg)
        return system

    @property
    def name(self) -> str:
        """Name of the function."""
        return name_of_function(self.function)


SweptScene: TypeAlias = SystemScene | FunctionScene
"""What is simulated at the values of a case."""


def scene_of(value: object) -> SweptScene:
    """Read the argument ``scene``."""
    if isinstance(value, System):
        return SystemScene(value.assembly)
    if callable(value) and not isinstance(value, type):
        return FunctionScene(value)
    msg = (
        "scene must be a System, or a function of the axes that returns one, got "
        f"{short_repr(value)}{system_hint(value)}"
    )
    raise StudyError(msg)


def motions_of_study(value: object, scene: SweptScene) -> dict[str, GroundMotion] | None:
    """Read the argument ``motions``; by default that of the scene, None if it has none."""
    if value is None and isinstance(scene, SystemScene):
        value = scene.assembly.parts.motion
    return None if value is None else named_motions(value)


def needed_motions(value: object, scene: SweptScene, *, owner: str) -> dict[str, GroundMotion]:
    """Read the same, and refuse a scene without a motion if no motion is given."""
    named = motions_of_study(value, scene)
    if named is None:
        msg = f"{owner}: there is no motion; give one"
        raise StudyError(msg)
    return named


def _unchanged_parameter_fault(
    part: Component, behind: tuple[str, ...], values: Mapping[str, str]
) -> str:
    """Say which axes would leave unchanged a parameter that depends on theirs."""
    names = [name for parameter, name in values.items() if part.left_behind([parameter])]
    axes = f"{'axis' if len(names) == 1 else 'axes'} {' and '.join(map(repr, names))}"
    kind = type(part).__name__
    left = " and ".join(behind)
    scaling = behind == ("inertia",)
    alternative = f"a {kind} with shape_factor in the place of its inertia, " if scaling else ""
    return (
        f"{axes} would leave {left} of this {kind} as given; give a function of the axes that "
        f"returns a System, {alternative}or axes of {left} too"
    )


def _run_axis(name: str, value: object) -> Axis | None:
    """Read an axis that scales the motion, or changes where runs start; None of any other."""
    if name in MOTION_AXES:
        words = SCHEMA[name].long_name
        return _number_axis(name, value, MOTION_AXES[name].measure, words, Changes.MOTION, name)
    if name in START_AXES:
        parameter, measure = START_AXES[name]
        words = name.replace("_", " ")
        return _number_axis(name, value, measure, words, Changes.START, parameter)
    return None


def _number_axis(
    name: str, value: object, measure: Measure, words: str, changes: Changes, parameter: str
) -> Axis:
    values = read_numbers(value, measure, name)
    return Axis(name, values, str(measure.unit), words, changes, parameter)


def _option_axis(name: str, option: str, value: object) -> Axis:
    if option in NUMERIC_OPTIONS:
        entry = NUMERIC_OPTIONS[option]
        return _number_axis(name, value, entry.measure, entry.description, Changes.OPTION, option)
    kind, words = _CHOICES[option]
    values = read_words(value, lambda word: checked_choice(kind, word, owner=OWNER, name=name))
    return Axis(name, values, None, words, Changes.OPTION, option)


def _option_value(name: str, value: Any) -> Any:
    if name in _CHOICES:
        return _CHOICES[name][0](value)
    entry = NUMERIC_OPTIONS[name]
    if not entry.condition.holds(value):
        msg = f"{name} must be {entry.condition.words}, got {value!r} {entry.measure.unit}"
        raise StudyError(msg)
    return value + 0.0  # no negative zero


def _declared_values(
    value: object, field: Declared[Any, Any, Any], name: str
) -> tuple[AnyArray, str | None]:
    if isinstance(field, Count):
        numbers = read_numbers(value, Measure("a whole number", Unit.ONE, "2"), name)
        return np.array([field.read(number, OWNER) for number in numbers.tolist()]), str(Unit.ONE)
    if isinstance(field, Flag):
        return np.array([field.read(word, OWNER) for word in as_list(value)]), None
    if field.measure is None:
        return read_words(value, lambda word: field.read(word, OWNER)), None
    return read_numbers(value, field.measure, name), str(field.measure.unit)


def _warn_of_unusual_values(field: Declared[Any, Any, Any], values: AnyArray, owner: str) -> None:
    """Warn of unusual values, as the part itself would."""
    if isinstance(field, Choice | Text) or type(field).caution is Declared.caution:
        return
    words = next(filter(None, map(field.caution, values.tolist())), None)
    if words is not None:
        warn(f"{OWNER}: {owner}: {words}", ModelWarning)
