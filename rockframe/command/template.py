"""``rockframe template``: prints files to begin with."""

import argparse

from rockframe.command.answer import Answer
from rockframe.command.files.templates import TEMPLATES, every_key


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Print a file to begin with."""
    text = every_key() if arguments.kind == "all" else TEMPLATES[arguments.kind]
    answer.text(text.removesuffix("\n"), text=text)
    return 0
