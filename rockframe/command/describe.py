"""``rockframe describe``: which model a scene makes."""

import argparse

from rockframe.command.files.scenes import read_scene


def execute(arguments: argparse.Namespace) -> int:
    """Describe the scene of a file."""
    found = read_scene(arguments.scene)
    print(found.system.describe())
    print(f"Motion:\n  {'none' if found.motion is None else found.motion}")
    return 0
