"""Hints of messages in the notation of Python, rewritten in that of a file."""

import re
from typing import Final

from rockframe.components.registry import registered_classes
from rockframe.system.parts import default_class, slot_of_class

_TEXT: Final = r"(?:'[^']*'|\"[^\"]*\")"
_TUPLE: Final = re.compile(rf"(?<!\w)\((?P<values>{_TEXT}(?:, {_TEXT})+)\)")
_VALUE: Final = re.compile(rf"\b(?P<name>[a-z]\w*)=(?P<value>{_TEXT}|\[)")
_CALL: Final = re.compile(r"\b(?:an? )?(?P<kind>[A-Z]\w+)(?:\.(?P<way>\w+))?\((?P<values>[^()]*)\)")
_GIVEN: Final = re.compile(rf"\b(?P<name>[a-z]\w*) ?= ?(?P<value>{_TEXT}|\[[^\]]*\]|[^,\s]+)")
_OPERATION: Final = re.compile(r"simulate\(motion\.(?P<name>\w+)\((?P<value>[\d.]+)\)\)")
_OBJECTS: Final = {"InitialState": "initial", "Accuracy": "accuracy"}
"""Keys of the run whose values are tables, by the class of the objects."""
_ONE_FILE_EACH: Final = "no file of a study varies it: write a scene for each of its values"
_SYSTEM: Final = {"System": "system"}


def in_toml(words: str) -> str:
    """Rewrite arguments, points, parts and operations in a message as a file has them."""
    from rockframe.studies.sweeps.scenes import FUNCTION_ADVICE  # only where there is a message

    words = words.replace(FUNCTION_ADVICE, _ONE_FILE_EACH)
    words = _OPERATION.sub(
        r"operations = [{ \g<name> = { factor = \g<value> } }] in [motion]", words
    )
    words = _TUPLE.sub(lambda found: f"[{_quoted(found['values'])}]", words)
    words = _VALUE.sub(lambda found: f"{found['name']} = {_quoted(found['value'])}", words)
    return _CALL.sub(_table, words)


def _quoted(text: str) -> str:
    return text.replace("'", '"')


def _table(call: re.Match[str]) -> str:
    """Rewrite a call of the class of a part, of a system, or of an object of the run."""
    kind = call["kind"]
    given = [f"{one['name']} = {one['value']}" for one in _GIVEN.finditer(call["values"])]
    if kind in _OBJECTS:
        return f"{_OBJECTS[kind]} = {{ {', '.join(given) or '...'} }}"
    slot = _SYSTEM.get(kind)
    if kind in registered_classes():
        slot = slot_of_class(registered_classes()[kind])
    if slot is None:
        return call[0]
    if call["way"] is not None:
        given.insert(0, f'constructor = "{call["way"]}"')
    if kind in registered_classes() and default_class(slot).__name__ != kind:
        given.insert(0, f'type = "{kind}"')
    return f"[{slot}] with {', '.join(given)}" if given else f"[{slot}]"
