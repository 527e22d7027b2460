"""Scenes and a study to begin with, and a file of all keys made from their declarations."""

import re
from collections.abc import Callable, Iterator, Mapping
from inspect import Parameter, getdoc, signature
from textwrap import wrap
from typing import Any, Final

from rockframe.command.files.parts import (
    CONSTRUCTOR,
    classes_in,
    constructors,
    inner_parts,
    part_slots,
    toml_value,
)
from rockframe.command.files.scenes import MOTIONS, motion_keys, run_keys
from rockframe.command.files.studies import sweep_keys
from rockframe.command.files.tables import arguments_of
from rockframe.components import Component, InitialState
from rockframe.components.parameters import REQUIRED, Choice, Count, Declared, Flag
from rockframe.motion import GroundMotion
from rockframe.motion.description import OPERATIONS
from rockframe.reports.project import ASSUMPTIONS, CHECKS, CONCLUSION, ENTRIES
from rockframe.shared_arguments import parameter_rows
from rockframe.simulation.system import System
from rockframe.studies import sweep

_MOTION: Final = """\
[motion]                         # or --motion record.AT2 on the command line
constructor = "sine_pulse"       # or file = "record.AT2"
amplitude = "{amplitude}"
frequency = "{frequency}"

[run]
free_vibration = "{free}"          # time after the motion, with the ground at rest
accuracy = "standard"            # or "fast", "reference"
"""

_BLOCK: Final = """\
# A freestanding block on rigid ground.
# Every quantity has its unit. 'rockframe template all' lists every key.

[block]
width = "0.8 m"                  # in the plane of rocking
height = "3.2 m"
mass = "5.5 t"

"""

_PADS: Final = """\
# A block on two viscoelastic pads, one under each corner.

[block]
width = "4.85 m"
height = "19.4 m"
mass = "600 t"

[pads]
frequency_ratio = 20             # or stiffness = "12 MN/m", of one pad
damping_ratio = 0.10             # or damping = "80 kN*s/m"

"""

_SOIL: Final = """\
# A block on soil, a bed of springs and dashpots that take no tension.

[block]
width = "4 m"
height = "18 m"
mass = "99 t"

[soil]
constructor = "from_subgrade_modulus"   # or stiffness = "80 MPa" alone
modulus = "20 MN/m^3"
depth = "4 m"                    # of the base, out of the plane of rocking
damping_ratio = 0.20

"""

_STACK: Final = """\
# A frame building on pads, on a cap, on soil.

[block]
type = "FrameEquivalent"         # the equivalent rigid block of the frame
width = "4 m"
height = "18 m"
mass = "99 t"
shape_factor = 2.92

[pads]
frequency_ratio = 40
damping_ratio = 0.10

[cap]
height = "0.9 m"
mass = "36 t"

[soil]
stiffness = "9 MPa"              # per length of base in the plane of rocking
damping_ratio = 0.20

[system]
coupling = "coupled"             # or "cascade", as in the paper

"""

_STATUE: Final = """\
# A statue on a plinth, each with a base of its own: bodies and bases from the top down.

[[stack.bodies]]                 # the statue, by its outline in the plane of rocking
constructor = "from_outline"
points = [[0.05, 0], [0.65, 0], [0.55, 0.8], [0.60, 1.5], [0.35, 2.0], [0.15, 1.4]]
unit = "m"
density = "2600 kg/m^3"
depth = "0.5 m"

[[stack.bodies]]                 # the plinth
width = "1.0 m"
height = "1.1 m"
mass = "2600 kg"

[[stack.interfaces]]             # between the two
type = "TwoSpringSupport"        # or "WinklerSoil", "RigidGround"
frequency_ratio = 40
damping_ratio = 0.10

[pads]                           # below the plinth
frequency_ratio = 40
damping_ratio = 0.10

"""

_STUDY: Final = """\
# A study: a scene at all combinations of the values of its axes.

scene = "scene.toml"             # or the tables of the scene in this file
# motions = ["records/*.AT2"]    # files, folders and archives, instead of the scene's motion
# cases = "cases.csv"            # a table with one row for each case, instead of axes
store = "study"                  # a folder: an interrupted study continues
output = "study.nc"

[axes]
scale = [0.5, 1.0, 1.5, 2.0]     # of the motion
width = ["0.7 m", "0.8 m", "0.9 m"]    # a parameter of the scene's parts

[sweep]
accuracy = "fast"
"""

TEMPLATES: Final = {
    "block": _BLOCK + _MOTION.format(amplitude="-5 m/s^2", frequency="2 Hz", free="5 s"),
    "pads": _PADS + _MOTION.format(amplitude="-9.81 m/s^2", frequency="1 Hz", free="5 s"),
    "soil": _SOIL + _MOTION.format(amplitude="-6 m/s^2", frequency="1 Hz", free="8 s"),
    "stack": _STACK + _MOTION.format(amplitude="-4 m/s^2", frequency="1 Hz", free="9 s"),
    "statue": _STATUE + _MOTION.format(amplitude="-3 m/s^2", frequency="1.5 Hz", free="5 s"),
    "study": _STUDY,
}
"""Texts by the kind of scene."""


_OWN_TABLES: Final = ("initial",)
"""Arguments of runs that have a table of their own."""
_WIDTH: Final = 96
_UNIT: Final = re.compile(r"\[[^\]]*\]")
_NO_BREAK: Final = "\N{NO-BREAK SPACE}"
"""In place of spaces within units, where no line ends."""
_HEAD: Final = """\
# Every table and every key of the files of scenes and studies.
# All keys are optional but those marked "must be given".

modules = []      # files in which you declare parts of your own, such as ["mine.py"]
"""
_SAMPLES: Final = {
    # of the system
    "gravity": '"9.81 m/s^2"', "inclination": '"2 deg"',
    # of motions
    "file": '"record.AT2"', "format": '"peer-at2"', "component": '"NS"', "unit": '"g"',
    "time_step": '"0.01 s"', "response": '"station.xml"',
    "operations": "[{ scaled = { factor = 1.5 } }]",
    # of runs and sweeps
    "duration": '"20 s"', "free_vibration": '"5 s"', "output_step": '"0.01 s"',
    "outputs": '["energy"]', "points": '{ top = ["0 m", "3.2 m"] }', "period": '"0.5 s"',
    "chunk": "100", "known": '["other_study"]',
    # of studies
    "scene": '"scene.toml"', "motions": '["records/*.AT2"]', "cases": '"cases.csv"',
    "store": '"study"', "output": '"study.nc"',
}  # fmt: skip
"""Values of keys that have no default to show."""


def all_keys_template() -> str:
    """Write a file with every key, as a comment with its meaning."""
    return "\n".join(_lines()) + "\n"


def _lines() -> Iterator[str]:
    yield from _HEAD.splitlines()
    for slot in part_slots():
        for name, kind in classes_in(slot).items():
            yield from _part_lines(slot, name, kind)
    yield from _function_lines("system", "options of the system", System.__init__, of=System)
    yield from _motion_lines()
    yield from _function_lines("run", "how it is simulated", System.simulate, names=run_keys())
    yield from _component_lines(
        "run.initial",
        "state at the start of the run, at rest unless given; of a study [sweep.initial]",
        InitialState,
    )
    yield from _table_header("project", "for reports")
    yield from (f'{name} = ""' for name in ENTRIES)
    yield f'{CONCLUSION} = ""'.ljust(18) + "# a sentence"
    yield f"{ASSUMPTIONS} = []".ljust(18) + "# a list of texts"
    yield f"{CHECKS} = []".ljust(18) + '# such as "circolare_2019 confidence_factor=1.35"'
    yield from _study_lines()


def _table_header(table: str, words: str) -> Iterator[str]:
    yield ""
    yield f"[{table}]".ljust(18) + f"# {words}"


def _part_lines(slot: str, name: str, kind: type[Component]) -> Iterator[str]:
    yield from _component_lines(slot, _summary(kind), kind, f'type = "{name}"')
    for key, inner in inner_parts(kind).items():
        words = " or ".join(f"[{table}]" for table in inner.slots)
        header = f"[[{slot}.{key}]]" if inner.several else f"[{slot}.{key}]"
        yield from _commented_key(f"# {header}", f"must be given: as {words}")
    if not kind.declared():
        yield from _wrapped_keys(", ".join(arguments_of(kind, without=tuple(inner_parts(kind)))))
    for way, function in constructors(kind).items():
        keys = arguments_of(function)
        if not keys:
            continue
        words = _summary(function)
        yield f'# or {CONSTRUCTOR} = "{way}": {words[:1].lower()}{words[1:]}'
        yield from _wrapped_keys(_keys_with_needed(keys))


def _component_lines(
    table: str, words: str, kind: type[Component], first: str | None = None
) -> Iterator[str]:
    yield from _table_header(table, words)
    if first is not None:
        yield first
    for name, field in kind.declared().items():
        if name not in inner_parts(kind):
            must = "must be given: " if field.default is REQUIRED else ""
            meaning = f"{must}{_without_markup(field.words)}"
            yield from _commented_key(f"# {name} = {_example(field)}", meaning)


def _example(field: Declared[Any, Any, Any]) -> str:
    if isinstance(field, Choice):
        return f'"{field.default}"'
    if field.measure is None:
        return (
            "true" if isinstance(field, Flag) else "2" if isinstance(field, Count) else '"anchor"'
        )
    if isinstance(field.default, int | float) and not isinstance(field.default, bool):
        return f"{field.default}"
    if field.measure.example.startswith("("):  # a point
        return f"[{field.measure.example[1:-1]}]"
    plain = field.unit == "1"
    return field.measure.example if plain else f'"{field.measure.example}"'


def _function_lines(
    table: str,
    words: str,
    function: Callable[..., Any],
    *,
    names: Mapping[str, bool] | None = None,
    of: object = None,
) -> Iterator[str]:
    yield from _table_header(table, words)
    meanings = _meanings(function if of is None else of)
    names = arguments_of(function, without=("parts",)) if names is None else names
    for name in names:
        if name in _OWN_TABLES:
            continue
        default = signature(function).parameters[name].default
        bare = default in (Parameter.empty, None, ())
        value = _SAMPLES[name] if bare else toml_value(default)
        yield from _commented_key(f"# {name} = {value}", meanings.get(name, ""))


def _motion_lines() -> Iterator[str]:
    yield from _table_header("motion", "motion of the ground, from a record")
    meanings = _meanings(GroundMotion.read)
    for name, must in motion_keys().items():
        words = {"file": "path of the record", "operations": "list of operations on the motion"}
        meaning = words.get(name, meanings.get(name, ""))
        must_be = "must be given: " if must else ""
        yield from _commented_key(f"# {name} = {_SAMPLES[name]}", f"{must_be}{meaning}")
    yield f"# or {CONSTRUCTOR}, with its arguments:"
    for name in MOTIONS:
        keys = arguments_of(getattr(GroundMotion, name))
        yield from _wrapped_keys(f"{name}: {_keys_with_needed(keys)}")
    yield "# operations, such as operations = [{ scaled = { factor = 1.5 } }]:"
    for name in OPERATIONS:
        keys = arguments_of(getattr(GroundMotion, name), without=("motion",))
        yield from _wrapped_keys(f"{name}: {_keys_with_needed(keys)}")


def _study_lines() -> Iterator[str]:
    yield ""
    yield "# A study has also, at the top:"
    for name, words in (
        ("scene", "path of the scene, unless its tables are in the file of the study"),
        ("motions", "list of files, folders, archives and patterns; or tables [[motions]]"),
        ("cases", "path of a table in CSV, with one row for each case and units in its heads"),
        ("store", "folder that keeps finished cases"),
        ("output", "file of the results"),
    ):
        yield from _commented_key(f"# {name} = {_SAMPLES[name]}", words)
    yield from _table_header("axes", "lists of values of what varies: parameters, options, scale")
    yield from _commented_key("# scale = [0.5, 1.0, 2.0]", "factors of the motion")
    yield from _commented_key('# width = ["0.7 m", "0.8 m"]', "a parameter of a part")
    yield from _function_lines("sweep", "how the cases are simulated", sweep, names=sweep_keys())


def _keys_with_needed(keys: Mapping[str, bool]) -> str:
    return ", ".join(f"{name} (needed)" if must else name for name, must in keys.items())


def _wrapped_keys(words: str) -> Iterator[str]:
    yield from wrap(words, _WIDTH, initial_indent="#   ", subsequent_indent="#     ")


def _commented_key(head: str, words: str) -> Iterator[str]:
    """Write a key, followed by its meaning in wrapped lines."""
    column = max(len(head) + 2, 34)
    unbroken = _UNIT.sub(lambda unit: unit[0].replace(" ", _NO_BREAK), words)
    lines = wrap(unbroken, max(_WIDTH - column, 40), break_on_hyphens=False) or [""]
    pieces = [line.replace(_NO_BREAK, " ") for line in lines]
    yield f"{head.ljust(column)}{pieces[0]}".rstrip()
    yield from (f"#{' ' * (column - 1)}{piece}" for piece in pieces[1:])


def _summary(documented: object) -> str:
    text = (getdoc(documented) or "").split("\n\n")[0].replace("\n", " ")
    return text.rstrip(".")


def _meanings(documented: object) -> dict[str, str]:
    """Return the description of each parameter in a numpydoc docstring."""
    rows = parameter_rows(getdoc(documented) or "").items()
    return {name: _without_markup(" ".join(row.splitlines()[1:])) for name, row in rows}


def _without_markup(words: str) -> str:
    """Remove the markup of reStructuredText."""
    words = re.sub(r", :eq:`[^`]*`", "", " ".join(words.split()))  # equations of the manual
    return re.sub(r":\w+:`[~.]?([^`]*)`", r"\1", words).replace("``", "").replace("`", "")
