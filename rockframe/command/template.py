"""``rockframe template``: prints files to begin with."""

import argparse

from rockframe.command.answer import Answer
from rockframe.command.files.templates import TEMPLATES, all_keys_template


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Print a file to begin with."""
    text = all_keys_template() if arguments.kind == "all" else TEMPLATES[arguments.kind]
    answer.add_text(text.removesuffix("\n"), text=text)
    return 0
