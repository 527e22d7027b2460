"""Descriptions of scenes in words: their elements, how numbers are written, and the whole text."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import TYPE_CHECKING, Final

from rockframe.units.display import degrees_text

if TYPE_CHECKING:
    from rockframe.system.parts import Parts
    from rockframe.system.setting import Setting

SLIP_EQUATION = (
    "slip",
    "H = -s mu_k N at the point that would be held, s = sgn(slip'); held while |H| <= mu_s N",
)
"""Equation of slip on a base with friction, for :class:`Words`."""
HELD_BY_FRICTION = (
    "friction at the corner that bears, or on the whole base (the restraint options make no "
    "difference)"
)
"""Restraint of a block that slides on rigid ground, for :class:`Words`."""


@dataclass(frozen=True)
class Words:
    """The elements of the description of a scene.

    Parameters
    ----------
    equations : list of (str, str)
        Each contact state with the equation that governs it.
    restraint : str
        Which point of the base is held horizontally.
    numbers : list of (str, str)
        Names of numbers that a reader wants to see, with values and units; uplift comes first.
    left_out : list of str
        Effects that the model does not have.
    """

    equations: list[tuple[str, str]]
    restraint: str
    numbers: list[tuple[str, str]]
    left_out: list[str]


def sliding_words(held: Words, *frictions: tuple[str, str], restraint: str | None = None) -> Words:
    """Return description of a scene that slips from that of the held one, with its frictions."""
    return Words(
        equations=[*held.equations, SLIP_EQUATION],
        restraint=held.restraint if restraint is None else restraint,
        numbers=[*held.numbers, *frictions],
        left_out=[one for one in held.left_out if one != "sliding"],
    )


def angle_words(radians: float) -> str:
    """Write an angle in radians and degrees."""
    return f"{radians:.6g} rad ({degrees_text(radians)})"


def uplift_words(radians: float) -> str:
    """Write the angle at which contact is first lost; NaN if it never is."""
    if math.isnan(radians):
        return "never: the base stays in contact up to overturning"
    return angle_words(radians)


def vibration_words(symbol: str, frequency: float, damping_ratio: float) -> str:
    """Write a frequency, its period and its damping ratio."""
    return (
        f"{symbol} = {frequency:.6g} rad/s (period {2.0 * math.pi / frequency:.6g} s), "
        f"damping ratio {damping_ratio:.6g}"
    )


_WIDTH = 100


def describe(
    setting: "Setting", parts: "Parts", written: Sequence[tuple[str, str]] | None = None
) -> str:
    """Describe the model, its equations, its numbers and its limits.

    `written` has names and words for the parts, in place of their notation in Python.
    """
    words, theta = setting.words(), angle_words(setting.overturning_angle)
    angles = _asymmetric_rows(setting) if setting.leans else [(_OVERTURNING_ANGLE, theta)]
    whose = "body 1: " if setting.joined_bodies else ""
    sections = {
        "Parts": [("", repr(part)) for part in parts] if written is None else [*written],
        "Contact states and their equations": words.equations,
        "Horizontal restraint": [("", words.restraint)],
        "Numbers": [
            ("gravity", f"{setting.gravity:.6g} m s^-2"),
            *((f"{whose}{name}", value) for name, value in angles),
            *((name, f"{least:.6g}") for name, least in setting.friction_to_rock().items()),
            *words.numbers,
        ],
        "Left out": [("", ", ".join(words.left_out))],
    }
    lines = [line for title, rows in sections.items() for line in _section(title, rows)]
    return "\n".join([f"Model: {setting.model}", *lines])


_OVERTURNING_ANGLE: Final = "overturning angle theta, Eq. (1)"
FRICTION_TO_ROCK: Final = "friction to rock, at least"


def _asymmetric_rows(setting: "Setting") -> list[tuple[str, str]]:
    """Describe rotation at rest and overturning angles of a body whose sides differ."""
    body, slope, (left, right) = setting.body, setting.slope, setting.overturning_angles
    rows = [
        (_OVERTURNING_ANGLE, f"to the left {angle_words(left)}, to the right {angle_words(right)}")
    ]
    if not slope.level:
        higher = "right" if slope.inclination > 0.0 else "left"
        inclined = (
            f"{angle_words(abs(slope.inclination))}, higher on the {higher}; all else is along "
            "and normal to it"
        )
        least = f"{abs(math.tan(slope.inclination)):.6g}"
        rows += [
            ("inclination of the base", inclined), ("friction to stand, at least tan(i)", least)
        ]  # fmt: skip
    if body.eccentricity != 0.0:
        side = "right" if body.eccentricity > 0.0 else "left"
        beside = f"{abs(body.eccentricity):.6g} m to the {side} of its middle"
        rows.append(("centre of mass", f"{body.centre_height:.6g} m above the base, {beside}"))
    return [*rows, ("rotation at rest", angle_words(setting.rest_rotation))]


def _section(title: str, rows: list[tuple[str, str]]) -> list[str]:
    """Set names and words in two columns, the second as far right as the longest name needs.

    Lines are broken after commas and semicolons, so that numbers keep their names and units.
    """
    longest = max(len(name) for name, _ in rows)
    lines = [f"{title}:"]
    for name, words in rows:
        first = f"  {name:<{longest}}  " if name else "  "
        following = " " * (len(first) if name else 4)
        width, broken = _WIDTH - len(following), list[str]()
        for piece in re.split(r"(?<=[,;]) ", words):
            if broken and len(broken[-1]) + 1 + len(piece) <= width:
                broken[-1] += f" {piece}"
            else:
                broken += wrap(piece, width, break_long_words=False, break_on_hyphens=False) or [""]
        lines += [first + broken[0], *(following + line for line in broken[1:])]
    return lines
