"""Reads numbers and tables from pages of the manual."""

import re
from importlib import import_module
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1] / "docs"
DIGITS = 0.6  # relative error allowed for a number of one digit: 1.5 is written as 2


def read(page: str) -> str:
    """Return the text of a page."""
    return (DOCS / page).read_text(encoding="utf-8")


def numbers_in(page: str, sentence: str) -> list[float]:
    """Return the numbers in a sentence of a page.

    Each ``#`` in `sentence` stands for a number; line breaks do not matter.
    """
    words = r"\s+".join(re.escape(word) for word in sentence.split())
    found = re.findall(words.replace(r"\#", r"(\d[\d.]*(?:e-?\d+)?)"), read(page))
    assert len(found) == 1, f"{page} says {len(found)} times: {sentence}"
    groups = found[0] if isinstance(found[0], tuple) else (found[0],)
    return [float(group.rstrip(".")) for group in groups]


def tables(page: str, head: str) -> list[list[list[str]]]:
    """Return the cells of all tables of a page with the given head."""
    pattern = re.escape(head) + r"\n\|[-| ]+\|\n((?:\|.*\|\n)+)"
    found = re.findall(pattern, read(page))
    assert found, f"{page} has no table {head}"
    return [
        [[cell.strip() for cell in line[1:-1].split("|")] for line in body.splitlines()]
        for body in found
    ]


def table(page: str, head: str) -> list[list[str]]:
    """Return the cells of the only table of a page with the given head."""
    (rows,) = tables(page, head)
    return rows


def reference_names() -> list[str]:
    """Return the names listed in the reference, including all those of listed packages."""
    text = read("reference/index.md")
    names = re.findall(r"^   ([A-Za-z][\w.]+)$", text, re.MULTILINE)
    for package in re.findall(r"^   :every: (\w+)$", text, re.MULTILINE):
        names += [
            f"{package}.{name_in_package}"
            for name_in_package in import_module(f"rockframe.{package}").__all__
        ]
    return names
