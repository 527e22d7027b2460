"""Elements of an HTML page that needs no other file and no network."""

import base64
import sys
from collections.abc import Callable, Iterable, Sequence
from html import escape
from importlib import resources
from io import BytesIO
from typing import TYPE_CHECKING, Any, Final, cast

from rockframe.version import __version__
from rockframe.writing import FileKind, generator_tag

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FILE_KIND: Final = FileKind.marked("a report", (".html", ".htm"), generator_tag("report"))
BANNERS: Final = {
    True: ("Overturned", "bad"),
    False: ("Did not overturn", "good"),
    None: ("Not finished", "doubt"),
}
"""Title and kind of the banner of a run, by its verdict."""
MAX_DRAWING_SIZE: Final = 1_500_000
"""Size of a vector drawing above which pixels replace it [bytes]."""
_MAX_VALUE_LENGTH: Final = 14
"""Longest content of a cell that is kept in one line [characters]."""
_POLICY: Final = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
_STYLE: Final = "page.css"


def html_page(title: str, body: Iterable[str]) -> str:
    """Return the whole page."""
    style = resources.files("rockframe.reports").joinpath(_STYLE).read_text(encoding="utf-8")
    head = (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"{generator_tag('report', __version__)}\n"
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">\n'
        f"<title>{escape(title)}</title>\n<style>\n{style}</style>\n</head>\n<body>\n"
    )
    return head + "\n".join(body) + "\n</body>\n</html>\n"


def section(title: str, pieces: Iterable[str]) -> str:
    """Return a section with its heading."""
    return "\n".join([f"<section>\n<h2>{escape(title)}</h2>", *pieces, "</section>"])


def subtitle(words: str) -> str:
    """Return a heading inside a section."""
    return f"<h3>{escape(words)}</h3>"


def paragraph(words: str, *, kind: str = "") -> str:
    """Return a paragraph, of a class of the style sheet."""
    return f"<p{_class_attribute(kind)}>{escape(words)}</p>"


def banner(title: str, words: str, kind: str) -> str:
    """Return a verdict with its sentence; `kind` is good, bad or doubt."""
    inner = f"<strong>{escape(title)}</strong>{escape(words)}"
    return f'<div class="verdict {kind}">{inner}</div>'


def care_banner(words: str) -> str:
    """Return why a result is to be used with care."""
    return banner("To be used with care", words, "doubt")


def parameter_table(values: Iterable[Sequence[str]], *, head: Sequence[str] = ()) -> str:
    """Return a table; the second column holds values."""
    return _table(values, head, "", lambda column, _: column == 1)


def number_table(values: Iterable[Sequence[str]], head: Sequence[str]) -> str:
    """Return a table in which all columns but the first hold values."""
    return _table(
        values, head, "many", lambda column, cell: column > 0 and len(cell) <= _MAX_VALUE_LENGTH
    )


def _table(
    values: Iterable[Sequence[str]],
    head: Sequence[str],
    kind: str,
    is_value: Callable[[int, str], bool],  # of a cell, by its column and its words
) -> str:
    names = "".join(f"<th>{escape(name)}</th>" for name in head)
    lines = [f'<div class="scroll"><table{_class_attribute(kind)}>']
    lines += [f"<thead><tr>{names}</tr></thead>"] if head else []
    lines.append("<tbody>")
    for row in values:
        cells = "".join(
            f"<td{_class_attribute('value' * is_value(column, cell))}>{escape(cell)}</td>"
            for column, cell in enumerate(row)
        )
        lines.append(f"<tr>{cells}</tr>")
    return "\n".join([*lines, "</tbody></table></div>"])


def numbered_list(values: Iterable[str | tuple[str, str]]) -> str:
    """Return a numbered list; of pairs, the first is a title."""
    inner = list[str]()
    for item in values:
        title, words = ("", item) if isinstance(item, str) else item
        strong = f"<strong>{escape(title)}.</strong> " if title else ""
        inner.append(f"<li>{strong}{escape(words)}</li>")
    return "<ol>\n" + "\n".join(inner) + "\n</ol>"


def preformatted(text: str) -> str:
    """Return preformatted text."""
    return f"<pre>{escape(text)}</pre>"


def captioned_figure(drawn: Any, words: str) -> str:
    """Return the figure of what was drawn with its caption, with the image inside the page."""
    figure = figure_of(drawn)
    data, kind = _rendered(figure, "svg"), "svg+xml"
    if len(data) > MAX_DRAWING_SIZE:
        data, kind = _rendered(figure, "png"), "png"
    close_figure(figure)
    source = f"data:image/{kind};base64,{base64.b64encode(data).decode()}"
    caption = f"<figcaption>{escape(words)}</figcaption>"
    return f'<figure><img src="{source}" alt="{escape(words)}">{caption}</figure>'


def figure_of(drawn: Any) -> "Figure":
    """Return the figure of what was drawn: itself, or that of an axes or of several."""
    while not hasattr(drawn, "savefig"):
        drawn = drawn.figure if hasattr(drawn, "figure") else next(iter(drawn))
    return cast("Figure", drawn)


def close_figure(figure: "Figure") -> None:
    """Close a figure, which pyplot would otherwise keep."""
    pyplot = sys.modules.get("matplotlib.pyplot")
    if pyplot is not None:
        pyplot.close(figure)


def _rendered(figure: "Figure", kind: str) -> bytes:
    import matplotlib as mpl

    store = BytesIO()
    # letters as outlines, so that no font is needed; a fixed salt for reproducible bytes
    with mpl.rc_context({"svg.fonttype": "path", "svg.hashsalt": "rockframe"}):
        metadata = {"Date": None} if kind == "svg" else {}
        figure.savefig(store, format=kind, dpi=160, metadata=metadata)
    return store.getvalue()


def _class_attribute(kind: str) -> str:
    return f' class="{kind}"' if kind else ""
