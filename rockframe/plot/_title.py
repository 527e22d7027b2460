"""The title of a figure, broken into lines that fit."""

from textwrap import wrap
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LETTERS_PER_INCH: Final = 12.0
"""At matplotlib's own size of letters, with a margin of about a fifteenth on both sides."""


def set_title(figure: "Figure", words: str) -> None:
    """Write a title above a figure, in as many lines as it needs."""
    width = int(_LETTERS_PER_INCH * figure.get_figwidth())
    lines = [line for given in words.splitlines() for line in _lines(given, width)]
    # matplotlib breaks lines that still do not fit, as those of larger letters
    figure.suptitle("\n".join(lines), fontsize="medium", wrap=True)


def _lines(words: str, width: int) -> list[str]:
    """Break first behind semicolons and sentences, and only then between words."""
    if len(words) <= width:
        return [words]
    for mark in ("; ", ". "):
        for place in range(width - 1, width // 3, -1):
            if words.startswith(mark, place):
                return [words[: place + 1], *_lines(words[place + 2 :], width)]
    return wrap(words, width)
