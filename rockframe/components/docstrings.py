"""The section on parameters in a component's docstring, from their declarations."""

import re
from collections.abc import Iterable
from inspect import cleandoc
from textwrap import fill
from typing import Any, Final

from rockframe.components.parameters import REQUIRED, Declared

_SECTION: Final = re.compile(r"^\w[\w ]*\n-{3,}$", re.MULTILINE)
_WIDTH: Final = 79
_INDENT: Final = "    "


def with_parameters(text: str, declared: Iterable[Declared[Any, Any]]) -> str:
    """Insert the section "Parameters" where numpydoc has it."""
    rows = [_row(parameter) for parameter in declared]
    clean = cleandoc(text)
    found = _SECTION.search(clean)
    if not rows or (found and found[0].startswith("Parameters\n")):
        return text
    place = found.start() if found else len(clean)
    section = "\n".join(["Parameters", "----------", *rows])
    return f"{clean[:place].rstrip()}\n\n{section}\n\n{clean[place:]}".rstrip() + "\n"


def _row(parameter: Declared[Any, Any]) -> str:
    optional = "" if parameter.default is REQUIRED else ", optional"
    unit = f"[{parameter.unit}]"
    whole = parameter.words.replace(unit, unit.replace(" ", "~"))  # not broken between lines
    lines = fill(whole, _WIDTH, initial_indent=_INDENT, subsequent_indent=_INDENT)
    words = lines.replace(unit.replace(" ", "~"), unit)
    return f"{parameter.name} : {parameter.written_as}{optional}\n{words}"
