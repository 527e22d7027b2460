"""The built manual: no page loads anything from elsewhere, and search finds common words.

The folder is ``docs/_build/html``, or that of the environment variable ``ROCKFRAME_SITE``.
"""

import json
import os
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SITE = Path(os.environ.get("ROCKFRAME_SITE", ROOT / "docs" / "_build" / "html"))
ELSEWHERE = re.compile(r"^(?:[a-z]+:)?//", re.IGNORECASE)
LOADED_BY = {"src", "srcset", "poster", "data"}
LOADING_LINKS = {"stylesheet", "icon", "preload", "modulepreload", "prefetch", "manifest"}

pytestmark = pytest.mark.skipif(
    not (SITE / "index.html").is_file(), reason=f"the manual has not been built in {SITE}"
)


class Loaded(HTMLParser):
    """Collects the addresses that a page loads when it is opened."""

    def __init__(self, text):
        super().__init__()
        self.addresses = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = {name: value or "" for name, value in attrs}
        if tag == "link":
            kinds = set(attributes.get("rel", "").lower().split())
            wanted = {"href"} if kinds & LOADING_LINKS else set()
        else:
            wanted = LOADED_BY
        self.addresses += [attributes[name] for name in wanted if name in attributes]
        self.addresses += urls_in_css(attributes.get("style", ""))


def urls_in_css(text):
    urls = re.findall(r"url\(\s*['\"]?([^'\")]+)", text)
    return urls + re.findall(r"@import\s+['\"]([^'\"]+)", text)


def pages():
    return sorted(SITE.rglob("*.html"))


def test_no_request_leaves_the_site():
    for page in pages():
        for address in Loaded(page.read_text(encoding="utf-8")).addresses:
            assert not ELSEWHERE.match(address), f"{page.relative_to(SITE)} loads {address}"
    for sheet in SITE.rglob("*.css"):
        for address in urls_in_css(sheet.read_text(encoding="utf-8")):
            assert not ELSEWHERE.match(address), f"{sheet.relative_to(SITE)} loads {address}"


def test_files_loaded_by_pages_exist():
    for page in pages():
        for address in Loaded(page.read_text(encoding="utf-8")).addresses:
            if address and not address.startswith(("data:", "#")):
                file = page.parent / re.split(r"[?#]", address)[0]
                assert file.exists(), f"{page.relative_to(SITE)} loads {address}"


def test_pages_do_not_reveal_build_machine():
    """A warning of a script appears with its file name; intended ones are printed as text."""
    sources = SITE.joinpath("_sources").rglob("*.txt")
    for page in [*pages(), *sources, *SITE.rglob("*.ipynb")]:
        text = page.read_text(encoding="utf-8")
        assert f"{ROOT}{os.sep}" not in text, page.relative_to(SITE)
        assert not re.search(r"\.py:\d+: \w*Warning: ", text), page.relative_to(SITE)
        if "gallery" in page.parts:  # messages about compilation depend on the machine
            assert "rockframe compiles what" not in text, page.relative_to(SITE)


def test_mathjax_is_served_from_the_site():
    page = (SITE / "theory" / "two_pads.html").read_text(encoding="utf-8")
    (script,) = re.findall(r'src="([^"]*mathjax[^"]*)"', page)
    folder = (SITE / "theory" / script).resolve().parent
    assert list(folder.rglob("*.woff"))
    assert 'class="eqno"' in page
    assert 'href="#equation-eq-pad-force"' in page


@pytest.fixture(scope="module")
def index():
    text = (SITE / "searchindex.js").read_text(encoding="utf-8")
    return json.loads(text.removeprefix("Search.setIndex(").removesuffix(")"))


@pytest.mark.parametrize(
    ("word", "page"),
    [
        ("statue", "recipes/statue"),
        ("notebook", "guide/notebooks"),
        ("csv", "recipes/csv_and_pandas"),
        ("fragility", "guide/fragility"),
        ("animation", "guide/plots"),
    ],
)
def test_search_finds(index, word, page):
    english = pytest.importorskip("sphinx.search.en")
    stem = english.SearchEnglish({}).stem(word)
    names = index["docnames"]
    found = set()
    for table in ("terms", "titleterms"):
        places = index[table].get(stem, [])
        found |= {names[place] for place in (places if isinstance(places, list) else [places])}
    assert page in found


def test_every_reference_object_has_page_and_link():
    links = (SITE / "reference" / "index.html").read_text(encoding="utf-8")
    lists = (ROOT / "docs" / "reference" / "index.md").read_text(encoding="utf-8")
    for name in re.findall(r"^   ([A-Za-z][\w.]+)$", lists, re.MULTILINE):
        found = re.search(rf'href="(generated/[^"#]+)#(rockframe\.{re.escape(name)})"', links)
        assert found, f"the reference has no link to rockframe.{name}"
        page = SITE / "reference" / found[1]
        assert f'id="{found[2]}"' in page.read_text(encoding="utf-8"), found[0]


def test_the_gallery_has_a_picture_of_every_script():
    scripts = [
        path
        for path in (ROOT / "examples" / "gallery").glob("*/*.py")
        if path.read_text(encoding="utf-8").startswith('"""\n')
    ]
    assert len(scripts) >= 30
    for path in scripts:
        page = SITE / "gallery" / path.parent.name / f"{path.stem}.html"
        assert f"sphx_glr_{path.stem}_001.png" in page.read_text(encoding="utf-8"), path.name
