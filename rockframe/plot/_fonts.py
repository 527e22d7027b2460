"""Fallback fonts for letters that the fonts of a figure do not have, such as Chinese ones."""

from collections.abc import Callable, Iterable
from contextvars import ContextVar
from functools import lru_cache, wraps
from typing import TYPE_CHECKING, Any, Final, ParamSpec, TypeVar

from rockframe.errors import RockframeWarning, warn

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

_LAST_RESORT: Final = "Last Resort"
"""Fonts that have a box in the place of every letter."""
_MAX_LISTED: Final = 12
"""Letters that a warning lists."""
_P = ParamSpec("_P")
_T = TypeVar("_T")
_missing_letters: ContextVar[dict[str, None] | None] = ContextVar(
    "letters without a font", default=None
)
"""Letters that no font has, of several figures that are drawn together."""


def warn_of_letters_once(drawing: Callable[_P, _T]) -> Callable[_P, _T]:
    """Decorate a function of several figures, to warn once of letters that no font has."""

    @wraps(drawing)
    def wrapped(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        lost = dict[str, None]()
        token = _missing_letters.set(lost)
        try:
            figure = drawing(*args, **kwargs)
        finally:
            _missing_letters.reset(token)
        _warn(lost, "the figures")
        return figure

    return wrapped


def add_fallback_fonts(artists: "Iterable[Axes | Figure | SubFigure]") -> None:
    """Add fonts to texts for letters that theirs lack; those of no font become ``?``."""
    from matplotlib.font_manager import fontManager

    unsupported = dict[str, None]()
    for text in _non_ascii_texts(artists):
        words, families = str(text.get_text()), list(text.get_fontfamily())
        paths = _font_files(families)
        missing = frozenset(
            letter
            for letter in words
            if not letter.isspace() and not any(_has_glyph(p, letter) for p in paths)
        )
        if not missing:
            continue
        fonts = _fallback_fonts(missing, len(fontManager.ttflist))
        text.set_fontfamily([*families, *dict.fromkeys(fonts.values())])
        without = [letter for letter in words if letter in missing and letter not in fonts]
        text.set_text("".join("?" if letter in without else letter for letter in words))
        unsupported |= dict.fromkeys(without)
    collected = _missing_letters.get()
    if collected is None:
        _warn(unsupported, "the figure")
    else:
        collected |= unsupported


def _warn(unsupported: Iterable[str], where: str) -> None:
    """Warn of letters that no font has."""
    letters = [*unsupported]
    if not letters:
        return
    more = "" if len(letters) <= _MAX_LISTED else f" and {len(letters) - _MAX_LISTED} more"
    msg = (
        f"no installed font has {' '.join(letters[:_MAX_LISTED])}{more}, written as '?' in "
        f"{where}; install a font with these letters, such as Noto Sans CJK for Chinese, Japanese "
        "and Korean"
    )
    warn(msg, RockframeWarning)


def _non_ascii_texts(artists: "Iterable[Axes | Figure | SubFigure]") -> list[Any]:
    """Return the texts with letters beyond ASCII."""
    from matplotlib.text import Text

    texts: list[Any] = [text for artist in artists for text in artist.findobj(Text)]
    return [text for text in texts if not str(text.get_text()).isascii()]


def _font_files(families: Iterable[str]) -> list[str]:
    """Return the files of those fonts that are installed."""
    from matplotlib.font_manager import FontProperties, findfont

    files: list[str] = []
    for family in families:
        try:
            files.append(str(findfont(FontProperties(family=[family]), fallback_to_default=False)))
        except ValueError:
            continue
    return files


@lru_cache(maxsize=64)
def _fallback_fonts(letters: frozenset[str], installed: int) -> dict[str, str]:
    """Find installed fonts that have letters: upright, regular, without serifs if possible."""
    from matplotlib.font_manager import fontManager

    def rank(font: Any) -> tuple[bool, bool, bool, str]:
        regular = font.weight in (400, "normal", "regular", "book")
        return font.style != "normal", not regular, "serif" in font.name.lower(), font.name

    fonts: dict[str, str] = {}
    for font in sorted(fontManager.ttflist[:installed], key=rank):
        if font.name.startswith(_LAST_RESORT):
            continue
        fonts |= {
            letter: font.name
            for letter in letters
            if letter not in fonts and _has_glyph(font.fname, letter)
        }
        if len(fonts) == len(letters):
            break
    return fonts


@lru_cache(maxsize=4096)
def _has_glyph(path: str, letter: str) -> bool:
    from matplotlib.font_manager import get_font

    try:
        return bool(get_font(path).get_char_index(ord(letter)))
    except (OSError, RuntimeError):  # a font that is damaged, or was removed
        return False
