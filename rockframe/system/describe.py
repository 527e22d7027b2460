"""The assembled system in words."""

import math

from rockframe.system.parts import Parts
from rockframe.system.scenes import Scene, Setting

_WIDTH = 34


def describe(scene: Scene, setting: Setting, parts: Parts) -> str:
    """Tell the model, its equations, its numbers and its limits.

    Parameters
    ----------
    scene : Scene
        Row of the table of scenes.
    setting : Setting
        The scene's numbers.
    parts : Parts
        The parts as given.

    Returns
    -------
    str
    """
    theta = setting.overturning_angle
    uplift = setting.uplift_angle
    never = "never: the base stays in contact up to overturning"
    lines = [f"Model: {scene.model}"]
    lines += _section("Parts", [("", repr(part)) for part in parts.given()])
    lines += _section("Contact states and their equations", setting.equations())
    lines += _section("Horizontal restraint", [("", setting.restraint_rule())])
    lines += _section(
        "Numbers",
        [
            ("gravity", f"{setting.gravity:.6g} m s^-2"),
            ("overturning angle theta, Eq. (1)", _angle(theta)),
            (
                f"uplift angle, {setting.uplift_source}",
                never if math.isnan(uplift) else _angle(uplift),
            ),
            *setting.numbers(),
        ],
    )
    lines += _section("Left out", [("", ", ".join(setting.left_out()))])
    return "\n".join(lines)


def _section(title: str, rows: list[tuple[str, str]]) -> list[str]:
    return [f"{title}:"] + [f"  {name:<{_WIDTH}} {words}" if name else f"  {words}"
                            for name, words in rows]  # fmt: skip


def _angle(radians: float) -> str:
    return f"{radians:.6g} rad ({math.degrees(radians):.4g} deg)"
