"""``rockframe template``: files to begin with."""

import argparse

from rockframe.command.files.every_key import every_key
from rockframe.command.files.templates import TEMPLATES


def execute(arguments: argparse.Namespace) -> int:
    """Print a file to begin with."""
    text = every_key() if arguments.kind == "all" else TEMPLATES[arguments.kind]
    print(text, end="")
    return 0
