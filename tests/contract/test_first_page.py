"""The first page of the manual leads to all others, and to the examples."""

import re

from pages import DOCS, read

TREE = re.compile(r"```\{toctree\}\n(.*?)```", re.DOTALL)


def test_every_page_is_listed_and_described():
    text = read("index.md")
    listed = {
        line for tree in TREE.findall(text) for line in tree.splitlines() if line and line[0] != ":"
    }
    described = set(re.findall(r"\{doc\}`([\w/]+)`", TREE.sub("", text)))
    pages = {
        path.relative_to(DOCS).with_suffix("").as_posix()
        for path in DOCS.rglob("*.md")
        if "_build" not in path.parts
    } - {"index"}
    assert listed == pages
    assert described == pages


def test_every_example_is_named():
    named = set(re.findall(r"`examples/(\w+\.py)`", read("index.md")))
    assert named == {path.name for path in (DOCS.parent / "examples").glob("*.py")}
