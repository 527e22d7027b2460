"""The first page of the manual leads to all others, and to the examples."""

import re

from pages import DOCS, read

TREE = re.compile(r"```\{toctree\}\n(.*?)```", re.DOTALL)


def test_every_page_is_listed_and_described():
    text = read("index.md")
    listed = {
        line for tree in TREE.findall(text) for line in tree.splitlines() if line and line[0] != ":"
    }
    described = set(re.findall(r"\{doc\}`(?:[^`<]*<)?([\w/]+)>?`", TREE.sub("", text)))
    pages = {
        path.relative_to(DOCS).with_suffix("").as_posix()
        for path in DOCS.rglob("*.md")
        if not {"_build", "gallery"} & set(path.relative_to(DOCS).parts)
    } - {"index"} | {"gallery/index"}  # its pages are written when the manual is built
    assert listed == pages
    assert described == pages


def test_every_example_is_named():
    named = set(re.findall(r"`examples/(\w+\.py)`", read("index.md")))
    assert named == {path.name for path in (DOCS.parent / "examples").glob("*.py")}


def test_the_example_fits_a_phone():
    """At 400 pixels a line has room for 43 characters."""
    (snippet,) = re.findall(r"```python\n(.*?)```", read("index.md"), re.DOTALL)
    assert max(map(len, snippet.splitlines())) <= 43
