"""``rockframe describe``: the model of a scene."""

import argparse

from rockframe.command.answer import Answer
from rockframe.command.files.scenes import read_scene
from rockframe.command.files.written import toml_tables
from rockframe.command.motion import motion_summary
from rockframe.system.setting import describe


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Describe the scene of a file."""
    found = read_scene(arguments.scene)
    assembly = found.system.assembly
    tables = [(head, ", ".join(keys)) for head, keys in toml_tables(assembly.parts.structural())]
    described = describe(assembly.setting, assembly.parts, tables)
    motion = "none"
    if found.motion is not None:
        vertical = "" if found.motion.si.vertical is None else ", with vertical"
        motion = f"{found.motion.name}: {motion_summary(found.motion)}{vertical}"
    answer.add_text(
        f"{described}\nMotion:\n  {motion}",
        model=assembly.setting.model,
        parts=[type(part).__name__ for part in assembly.parts.structural()],
        motion=motion,
        description=described,
    )
    return 0
