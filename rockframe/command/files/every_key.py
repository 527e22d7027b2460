"""Every table and every key that files may have, with its meaning, from the declarations."""

import re
from collections.abc import Callable, Iterator, Mapping
from inspect import Parameter, getdoc, signature
from textwrap import wrap
from typing import Any, Final

from rockframe.command.files.calls import arguments_of
from rockframe.command.files.motions import motion_keys
from rockframe.command.files.scenes import (
    CONSTRUCTOR,
    classes_in,
    constructors,
    part_slots,
    run_keys,
)
from rockframe.command.files.studies import sweep_keys
from rockframe.components import Component, InitialState
from rockframe.components.parameters import REQUIRED, Choice, Declared
from rockframe.motion import GroundMotion
from rockframe.motion.description import CONSTRUCTORS, OPERATIONS
from rockframe.simulation.system import System
from rockframe.studies import sweep

_WIDTH: Final = 96
_HEAD: Final = """\
# Every table and every key of the files of scenes and studies.
# What must be given is marked so; all else may be left out.

modules = []      # files in which you declare parts of your own, such as ["mine.py"]
"""
_PARAMETERS: Final = re.compile(
    r"^Parameters\n-+\n(.*?)(?=^\w[\w ]*\n-{3,}|\Z)", re.DOTALL | re.MULTILINE
)
_ENTRY: Final = re.compile(
    r"^(\*{0,2}\w[\w, *]*?) : .*\n((?:[ ]{4}.*\n?|\n(?=[ ]{4}))+)", re.MULTILINE
)


def every_key() -> str:
    """Write a file with every key, as a comment with its meaning."""
    return "\n".join(_lines()) + "\n"


def _lines() -> Iterator[str]:
    yield from _HEAD.splitlines()
    for slot in part_slots():
        for name, kind in classes_in(slot).items():
            yield from _of_part(slot, name, kind)
    yield from _of_function("system", "options of the system", System.__init__, of=System)
    yield from _of_motion()
    yield from _of_function("run", "how it is simulated", System.simulate, names=run_keys())
    yield from _of_component("run.initial", "where the run starts", InitialState)
    yield from _of_study()


def _title(table: str, words: str) -> Iterator[str]:
    yield ""
    yield f"[{table}]".ljust(18) + f"# {words}"


def _of_part(slot: str, name: str, kind: type[Component]) -> Iterator[str]:
    yield from _of_component(slot, _summary(kind), kind, f'type = "{name}"')
    for way, function in constructors(kind).items():
        keys = arguments_of(function)
        if not keys:
            continue
        yield f'# or {CONSTRUCTOR} = "{way}": {_lowered(_summary(function))}'
        yield from _keys(", ".join(_marked(keys)))


def _of_component(
    table: str, words: str, kind: type[Component], first: str | None = None
) -> Iterator[str]:
    yield from _title(table, words)
    if first is not None:
        yield first
    for name, one in kind.declared().items():
        yield from _of_parameter(name, one)


def _of_parameter(name: str, one: Declared[Any, Any]) -> Iterator[str]:
    must = "must be given: " if one.default is REQUIRED else ""
    yield from _commented(f"# {name} = {_example(one)}", f"{must}{_plain(one.words)}")


def _example(one: Declared[Any, Any]) -> str:
    if isinstance(one, Choice):
        return f'"{one.default}"'
    if one.measure is None:
        return '"..."'
    if isinstance(one.default, int | float) and not isinstance(one.default, bool):
        return f"{one.default}"
    plain = one.unit == "1"
    return one.measure.example if plain else f'"{one.measure.example}"'


def _of_function(
    table: str,
    words: str,
    function: Callable[..., Any],
    *,
    names: Mapping[str, bool] | None = None,
    of: object = None,
) -> Iterator[str]:
    yield from _title(table, words)
    meanings = _meanings(function if of is None else of)
    names = arguments_of(function, without=("parts",)) if names is None else names
    for name in names:
        default = signature(function).parameters[name].default
        usual = "" if default in (Parameter.empty, None, ()) else f" = {_written(default)}"
        yield from _commented(f"# {name}{usual}", meanings.get(name, ""))


def _of_motion() -> Iterator[str]:
    yield from _title("motion", "of the ground; a record")
    meanings = _meanings(GroundMotion.read)
    for name, must in motion_keys().items():
        words = {"file": "path of the record", "operations": "list of what is done to it"}
        meaning = words.get(name, meanings.get(name, ""))
        yield from _commented(f"# {name}", f"{'must be given: ' if must else ''}{meaning}")
    yield f"# or {CONSTRUCTOR}, with its arguments:"
    for name in CONSTRUCTORS:
        keys = arguments_of(getattr(GroundMotion, name))
        yield from _keys(f"{name}: {', '.join(_marked(keys))}")
    yield "# operations, such as operations = [{ scaled = { factor = 1.5 } }]:"
    for name in OPERATIONS:
        keys = arguments_of(getattr(GroundMotion, name), without=("motion",))
        yield from _keys(f"{name}: {', '.join(_marked(keys))}")


def _of_study() -> Iterator[str]:
    yield ""
    yield "# A study has also, at the top:"
    for name, words in (
        ("scene", "path of the scene, unless its tables are in the file of the study"),
        ("motions", "list of files, folders, archives and patterns; or tables [[motions]]"),
        ("cases", "path of a table in CSV, with a row for each case and units in its heads"),
        ("store", "folder that keeps what has been run"),
        ("output", "file of the results"),
    ):
        yield from _commented(f"# {name}", words)
    yield from _title("axes", "what varies: parameters, options, scale; lists of values")
    yield from _of_function("sweep", "how all of it is simulated", sweep, names=sweep_keys())


def _marked(keys: Mapping[str, bool]) -> list[str]:
    return [f"{name} (needed)" if must else name for name, must in keys.items()]


def _keys(words: str) -> Iterator[str]:
    yield from wrap(words, _WIDTH, initial_indent="#   ", subsequent_indent="#     ")


def _commented(head: str, words: str) -> Iterator[str]:
    """Set a key, and its meaning behind it, broken into lines."""
    column = max(len(head) + 2, 34)
    pieces = wrap(words, max(_WIDTH - column, 40)) or [""]
    yield f"{head.ljust(column)}{pieces[0]}".rstrip()
    yield from (f"#{' ' * (column - 1)}{piece}" for piece in pieces[1:])


def _written(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else str(value)


def _lowered(words: str) -> str:
    return words[:1].lower() + words[1:]


def _summary(documented: object) -> str:
    text = (getdoc(documented) or "").split("\n\n")[0].replace("\n", " ")
    return text.rstrip(".")


def _meanings(documented: object) -> dict[str, str]:
    """Give what the docstring in numpydoc's style says of every argument."""
    section = _PARAMETERS.search(getdoc(documented) or "")
    found: dict[str, str] = {}
    for names, words in _ENTRY.findall(section[1] if section else ""):
        for name in names.split(","):
            found[name.strip(" *")] = _plain(" ".join(words.split()))
    return found


def _plain(words: str) -> str:
    """Take the marks of reStructuredText away."""
    return re.sub(r":\w+:`[~.]?([^`]*)`", r"\1", words).replace("``", "").replace("`", "")
