"""Motions that are drawn: one, or several to compare."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast

from rockframe.motion.shown_name import shown_name
from rockframe.plot._axes import colour_of, style_of
from rockframe.plot._checks import check_motion

if TYPE_CHECKING:
    from rockframe.motion import GroundMotion

    MotionsLike: TypeAlias = GroundMotion | Sequence[GroundMotion] | Mapping[Any, GroundMotion]


_LETTERS: Final = 90
"""That a row of a legend has room for."""


@dataclass(frozen=True)
class Drawn:
    """A motion with its label, colour and dashes; without a label where there is but one."""

    motion: "GroundMotion"
    label: str | None
    colour: str
    style: Any


def columns_of(given: list[Drawn]) -> int:
    """Give the columns of a legend that names motions below a figure."""
    longest = max(len(one.label or "") for one in given)
    return max(1, min(len(given), _LETTERS // (longest + 6)))


def motions_title(given: list[Drawn]) -> str:
    """Give the title of a figure: the name of the one motion that it shows."""
    if len(given) != 1:
        return ""
    (one,) = given
    return shown_name(one.motion.name, one.motion.history)


def drawn_motions(given: object, function: str) -> list[Drawn]:
    """Read one or several motions."""
    from rockframe.motion import GroundMotion

    labelled: dict[str, Any] = {}
    if isinstance(given, Mapping):
        labelled = {str(key): one for key, one in cast("Mapping[Any, Any]", given).items()}
    elif isinstance(given, list | tuple):
        several = cast("Sequence[Any]", given)
        names = [
            shown_name(str(getattr(one, "name", "")), getattr(one, "history", ()))
            for one in several
        ]
        alike = len(set(names)) < len(names)
        labelled = {
            f"{name} ({number})" if alike else name: one
            for number, (name, one) in enumerate(zip(names, several, strict=True), start=1)
        }
    if labelled and all(isinstance(one, GroundMotion) for one in labelled.values()):
        return [
            Drawn(one, label, colour_of(number), style_of(number))
            for number, (label, one) in enumerate(labelled.items())
        ]
    check_motion(given, function)
    return [Drawn(cast("GroundMotion", given), None, colour_of(0), "-")]
