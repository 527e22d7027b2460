"""Elements of an HTML page that needs no other file and no network."""

import base64
import sys
from collections.abc import Callable, Iterable, Sequence
from html import escape
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
STYLE: Final = """\
:root { color-scheme: light dark; --ink: #1c2430; --soft: #5a6675; --paper: #ffffff;
  --line: #d7dce2; --band: #f3f5f8; --good: #1b6b3a; --bad: #a3261f; --doubt: #8a5a00; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e8ee; --soft: #9aa6b5; --paper: #14181e; --line: #343c47; --band: #1d232b;
    --good: #6fcf97; --bad: #ff8a80; --doubt: #f2c14e; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem 1rem 4rem; max-width: 56rem; color: var(--ink);
  background: var(--paper); font: 1rem/1.5 system-ui, sans-serif; overflow-wrap: break-word; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 .6rem; border-bottom: 1px solid var(--line);
  padding-bottom: .2rem; }
h3 { font-size: 1rem; margin: 1.2rem 0 .3rem; }
p { margin: .5rem 0; }
.soft, figcaption { color: var(--soft); font-size: .9rem; }
.verdict { border-left: .4rem solid var(--soft); background: var(--band); padding: .6rem .9rem;
  margin: 1rem 0; }
.verdict strong { display: block; font-size: 1.15rem; }
.good { border-color: var(--good); } .good strong { color: var(--good); }
.bad { border-color: var(--bad); } .bad strong { color: var(--bad); }
.doubt { border-color: var(--doubt); } .doubt strong { color: var(--doubt); }
.scroll { overflow-x: auto; } .scroll + .scroll { margin-top: 1.4rem; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; }
th, td { text-align: left; vertical-align: top; padding: .28rem .6rem .28rem 0;
  border-bottom: 1px solid var(--line); }
.many { font-size: .84rem; }
.many td:not(.value) { overflow-wrap: anywhere; min-width: 3.5rem; }
td.value { white-space: nowrap; font-variant-numeric: tabular-nums; }
figure { margin: 1rem 0; }
figure img { width: 100%; height: auto; background: #ffffff; border: 1px solid var(--line);
  border-radius: .3rem; }
pre { overflow-x: auto; background: var(--band); padding: .7rem .9rem; font-size: .8rem;
  line-height: 1.4; }
li { margin: .25rem 0; }
.sheet { margin: 1rem 0; }
code { overflow-wrap: anywhere; }
@media (max-width: 30rem) { td.value { white-space: normal; } }
@page { size: A4; margin: 18mm 16mm; }
@media print {
  :root { --ink: #000000; --soft: #444444; --paper: #ffffff; --line: #bbbbbb; --band: #f4f4f4;
    --good: #1b6b3a; --bad: #a3261f; --doubt: #8a5a00; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  figure, tr, .verdict, .sheet { break-inside: avoid; }
  thead { display: table-header-group; }
  .scroll { overflow: visible; } table { font-size: 9pt; }
  td.value { white-space: normal; overflow-wrap: anywhere; min-width: 5.5rem; }
  .many { font-size: 8pt; } .many td.value { min-width: 0; }
  h2, h3, dt { break-after: avoid; }
  figure img { width: auto; max-width: 100%; max-height: 8cm; }
  pre { white-space: pre-wrap; } details > summary { display: none; } }
"""


def html_page(title: str, body: Iterable[str]) -> str:
    """Return the whole page."""
    head = (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"{generator_tag('report', __version__)}\n"
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">\n'
        f"<title>{escape(title)}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n"
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
