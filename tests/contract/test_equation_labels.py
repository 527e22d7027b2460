"""Code and manual cite the same equations: no label is missing, defined twice or unused."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"

# a display equation's label, "$$ (label)", or that of a math directive, ":label: label"
DEFINITION = re.compile(r"^\s*\$\$\s*\(([\w-]+)\)\s*$|^\s*:label:\s*([\w-]+)\s*$", re.MULTILINE)
CITATION = re.compile(r"(?::eq:|\{eq\})`(?:[^`<]*<)?([\w-]+)>?`")


def read(folder: Path, pattern: str) -> dict[Path, str]:
    built = folder / "_build"
    return {
        path: path.read_text(encoding="utf-8")
        for path in sorted(folder.rglob(pattern))
        if not path.is_relative_to(built)
    }


PAGES = read(DOCS, "*.md")
CODE = read(ROOT / "rockframe", "*.py")
DEFINED = {
    page: [label or other for label, other in DEFINITION.findall(text)]
    for page, text in PAGES.items()
}
COUNT = Counter(label for labels in DEFINED.values() for label in labels)
CITED_BY_CODE = {
    label: path.relative_to(ROOT) for path, text in CODE.items() for label in CITATION.findall(text)
}
CITED_BY_PAGES = {
    label: page.relative_to(ROOT)
    for page, text in PAGES.items()
    for label in CITATION.findall(text)
}
THEORY = [
    (label, page)
    for page, labels in DEFINED.items()
    if page.is_relative_to(DOCS / "theory")
    for label in labels
]


def test_equation_labels_are_found():
    assert len(CITED_BY_CODE) >= 12
    assert len(THEORY) >= 12


def test_an_equation_that_is_cited_is_defined_once():
    for cited in (CITED_BY_CODE, CITED_BY_PAGES):
        for label, place in cited.items():
            assert COUNT[label] == 1, f"{place} cites {label}, defined {COUNT[label]} times"


def test_theory_equations_are_cited_elsewhere():
    for label, page in THEORY:
        elsewhere = any(
            label in CITATION.findall(text) for other, text in PAGES.items() if other != page
        )
        assert label in CITED_BY_CODE or elsewhere, (
            f"cite {label} of {page.relative_to(ROOT)} where it is computed, or on another page"
        )
