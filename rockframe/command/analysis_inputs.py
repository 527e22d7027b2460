"""Shared by analyses of a scene under many motions: reads the arguments that were typed."""

import argparse
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from rockframe.command.files.studies import AXES, StudyDescription, read_study
from rockframe.command.shared import (
    arguments_accepted_by,
    parse_numbers,
    refuse_reading_options,
    run_from,
    store_from,
    suite_from,
    typed_options,
)
from rockframe.errors import ComponentError, FileError
from rockframe.results.schema import SCHEMA

SCALE: Final = "scale"
_NO_MOTIONS: Final = (
    "there are no motions; name records, archives or folders after the scene, or describe motions "
    "in the file"
)
_NUMBER_START: Final = re.compile(r"[-+]?\.?\d")


def scene_and_motions(arguments: argparse.Namespace) -> StudyDescription:
    """Read a scene or a study; motions, scales and runs that were typed replace those in it."""
    found = read_study(arguments.scene, needs_axes=False)
    if not arguments.records:
        refuse_reading_options(arguments, "name records after the scene")
    else:
        suite = suite_from(arguments.records, arguments)
        files = (*found.files, *map(Path, arguments.records))
        found = replace(found, motions=dict(suite.items()), files=files)
    if found.motions is None:
        raise FileError(arguments.scene, _NO_MOTIONS)
    values = run_from(found.arguments, arguments)
    if arguments.scales is not None:
        scales, _ = parse_numbers(arguments.scales, "--scales", "0.25:4:0.25")
        values[AXES] = {**values.get(AXES, {}), SCALE: scales}
    return replace(found, arguments=values, store=store_from(arguments) or found.store)


def typed_intensity(arguments: argparse.Namespace, function: Callable[..., Any]) -> dict[str, Any]:
    """Return the intensity and the limit states that were typed."""
    options = typed_options(arguments, "intensity", "period")
    if arguments.limits is not None:
        options["limits"] = [
            _read_limit_state(word.strip()) for word in arguments.limits.split(",")
        ]
    return arguments_accepted_by(function, options)


def _read_limit_state(word: str) -> object:
    """Read a limit state: a rotation, a name, or a variable and its limit."""
    if _NUMBER_START.match(word):
        try:
            return float(word)
        except ValueError:
            msg = f"--limits: expected a number, a name or NAME=VALUE, got {word!r}"
            raise ComponentError(msg) from None
    name, equals, value = word.partition("=")
    if not equals and name in SCHEMA:
        msg = f"--limits: {name} needs a limit, as in 'peak_slip=5 cm'"
        raise ComponentError(msg)
    if not equals:
        return word
    return name.strip(), float(value) if re.fullmatch(r"[\d.]+", value.strip()) else value.strip()
