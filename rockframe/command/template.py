"""``rockframe template``: files to begin with."""

import argparse

from rockframe.command.files.templates import TEMPLATES, every_key


def execute(arguments: argparse.Namespace) -> int:
    """Print a file to begin with."""
    text = every_key() if arguments.kind == "all" else TEMPLATES[arguments.kind]
    print(text, end="")
    return 0
