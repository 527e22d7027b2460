"""The first page of the manual links to all others, and to the examples."""

import json
import re

from pages import DOCS, numbers_in, read, table

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


def test_example_fits_a_phone_screen():
    """At 400 pixels a line has room for 43 characters."""
    (snippet,) = re.findall(r"```python\n(.*?)```", read("index.md"), re.DOTALL)
    assert max(map(len, snippet.splitlines())) <= 43


def data(name):
    return json.loads((DOCS / "data" / f"{name}.json").read_text(encoding="utf-8"))


def test_numbers_match_other_pages_and_data():
    ((_, pads, *_),) = rows = table(
        "validation_speed.md", "| rigid ground | pads | soil | cascade | coupled |"
    )
    assert numbers_in("index.md", "{grid-item-card} # times faster") == [float(pads)]
    leads = [float(cell) for cell in rows[0]]
    assert numbers_in("index.md", "# to # times in five scenes") == [min(leads), max(leads)]
    (proved, of) = numbers_in("index.md", "{grid-item-card} # of # proved")
    proofs = data("proofs")
    assert of == proofs["blocks"]
    assert proved == sum(
        count for verdict, count in proofs["verdicts"].items() if verdict != "undecided"
    )
    assert proofs["contradicted by reference"] == proofs["fifty digits"]["outside"] == []
    (share,) = numbers_in("index.md", "{grid-item-card} # of verdicts")
    (held_out,) = numbers_in("validation_granite.md", "and # on tests held out (both specimens)")
    assert share == round(held_out, 2)


def test_readme_states_same_numbers():
    readme = (DOCS.parent / "README.md").read_text(encoding="utf-8")
    words = " ".join(readme.split())
    low, high = numbers_in("index.md", "# to # times in five scenes")
    (share,) = numbers_in("index.md", "{grid-item-card} # of verdicts")
    proved, of = numbers_in("index.md", "{grid-item-card} # of # proved")
    assert f"{low:g} to {high:g} times faster than SciPy" in words
    assert f"{share:g} of the verdicts" in words
    assert f"verdicts of {proved:g} of {of:g} random blocks" in words
