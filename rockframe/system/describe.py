"""The assembled system in words."""

import math
import re
from textwrap import wrap

from rockframe.system.parts import Parts
from rockframe.system.setting import Setting
from rockframe.system.words import angle_words

_WIDTH = 100


def describe(setting: Setting, parts: Parts) -> str:
    """Tell the model, its equations, its numbers and its limits."""
    words = setting.words()
    lines = [f"Model: {setting.model}"]
    lines += _section("Parts", [("", repr(part)) for part in parts.given()])
    lines += _section("Contact states and their equations", words.equations)
    lines += _section("Horizontal restraint", [("", words.restraint)])
    lines += _section(
        "Numbers",
        [
            ("gravity", f"{setting.gravity:.6g} m s^-2"),
            *_overturning(setting),
            ("friction to rock, at least b/h", f"{setting.body.least_friction:.6g}"),
            *words.numbers,
        ],
    )
    lines += _section("Left out", [("", ", ".join(words.left_out))])
    return "\n".join(lines)


def _overturning(setting: Setting) -> list[tuple[str, str]]:
    body, slope, title = setting.body, setting.slope, "overturning angle theta, Eq. (1)"
    if not setting.leans:
        return [(title, angle_words(setting.overturning_angle))]
    left, right = setting.overturning_angles
    rows = [(title, f"to the left {angle_words(left)}, to the right {angle_words(right)}")]
    if not slope.level:
        higher = "right" if slope.inclination > 0.0 else "left"
        rows += [
            (
                "inclination of the base",
                f"{angle_words(abs(slope.inclination))}, higher on the {higher}; all else is along "
                "and normal to it",
            ),
            ("friction to stand, at least tan(i)", f"{abs(math.tan(slope.inclination)):.6g}"),
        ]
    if body.eccentricity != 0.0:
        side = "right" if body.eccentricity > 0.0 else "left"
        beside = f"{abs(body.eccentricity):.6g} m to the {side} of its middle"
        rows.append(("centre of mass", f"{body.centre_height:.6g} m above the base, {beside}"))
    return [*rows, ("rotation at rest", angle_words(setting.rest_rotation))]


def _section(title: str, rows: list[tuple[str, str]]) -> list[str]:
    """Set names and words in two columns, the second as far right as the longest name needs."""
    longest = max(len(name) for name, _ in rows)
    lines = [f"{title}:"]
    for name, words in rows:
        first = f"  {name:<{longest}}  " if name else "  "
        following = " " * (len(first) if name else 4)
        broken = _broken(words, _WIDTH - len(following))
        lines += [first + broken[0], *(following + line for line in broken[1:])]
    return lines


def _broken(words: str, width: int) -> list[str]:
    """Break behind commas and semicolons, so that numbers keep their names and units."""
    lines: list[str] = []
    for piece in re.split(r"(?<=[,;]) ", words):
        if lines and len(lines[-1]) + 1 + len(piece) <= width:
            lines[-1] += f" {piece}"
        else:
            lines += wrap(piece, width, break_long_words=False, break_on_hyphens=False) or [""]
    return lines
