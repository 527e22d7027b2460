"""Shared by analyses of a scene under many motions: reads the arguments that were typed."""

import argparse
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from rockframe.command.files.studies import AXES, DescribedStudy, read_study
from rockframe.command.shared import (
    refuse_of_record,
    run_from,
    store_from,
    suite_from,
    taken_by,
    typed_options,
    values_of,
)
from rockframe.errors import ComponentError, FileError
from rockframe.results.schema import SCHEMA

SCALE: Final = "scale"
_NO_MOTIONS: Final = (
    "there are no motions; name records, archives or folders after the scene, or describe motions "
    "in the file"
)
_NUMBER: Final = re.compile(r"[-+]?\.?\d")


def scene_and_motions(arguments: argparse.Namespace) -> DescribedStudy:
    """Read a scene or a study; motions, scales and runs that were typed replace those in it."""
    found = read_study(arguments.scene, varied=False)
    if not arguments.records:
        refuse_of_record(arguments, "name records after the scene")
    else:
        suite = suite_from(arguments.records, arguments)
        files = (*found.files, *map(Path, arguments.records))
        found = replace(found, motions=dict(suite.items()), files=files)
    if found.motions is None:
        raise FileError(arguments.scene, _NO_MOTIONS)
    values = run_from(found.arguments, arguments)
    if arguments.scales is not None:
        scales, _ = values_of(arguments.scales, "--scales", "0.25:4:0.25")
        values[AXES] = {**values.get(AXES, {}), SCALE: scales}
    return replace(found, arguments=values, store=store_from(arguments) or found.store)


def typed_intensity(arguments: argparse.Namespace, function: Callable[..., Any]) -> dict[str, Any]:
    """Return the intensity and the limit states that were typed."""
    options = typed_options(arguments, "intensity", "period")
    if arguments.limits is not None:
        options["limits"] = [_limit(word.strip()) for word in arguments.limits.split(",")]
    return taken_by(function, options)


def _limit(word: str) -> object:
    """Read a limit state: a rotation, a name, or a variable and its limit."""
    if _NUMBER.match(word):
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
