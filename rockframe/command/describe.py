"""``rockframe describe``: the model of a scene."""

import argparse

from rockframe.command.answer import Answer
from rockframe.command.files.scenes import read_scene


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Describe the scene of a file."""
    found = read_scene(arguments.scene)
    described = found.system.describe()
    motion = "none" if found.motion is None else str(found.motion)
    answer.text(
        f"{described}\nMotion:\n  {motion}",
        model=found.system.setting.model,
        parts=[type(part).__name__ for part in found.system.parts.structural()],
        motion=motion,
        description=str(described),
    )
    return 0
