"""The code on the pages of the guide, the recipes and the README runs.

A block of text directly after a snippet is its expected output. Blocks of TOML that begin with
the name of a file in a comment are written to it, and commands of consoles are executed.
"""

import re
import shutil
from pathlib import Path

import pytest
from console_session import run_console
from records import record_path

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    ROOT / "README.md",
    ROOT / "docs" / "index.md",
    *sorted((ROOT / "docs/guide").glob("*.md")),
    *[
        page
        for page in sorted((ROOT / "docs/recipes").glob("*.md"))
        if "```python" in page.read_text()
    ],
]
SNIPPET = re.compile(r"```(python|console|toml)\n(.*?)```(?:\n+```text\n(.*?)```)?", re.DOTALL)
FILE = re.compile(r"# (\S+\.toml)\n")
RECORDS = {"record.AT2": "NIS090.AT2", "TCU128-N.AT2": "PEERSMD_CHICHI_TCU128-N.AT2"}


@pytest.mark.wide
@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize("page", PAGES, ids=[page.name for page in PAGES])
def test_all_snippets_of_page_run(page, tmp_path, monkeypatch, capsys, request):
    if page.stem != "reports":  # the page on reports draws their figures
        request.getfixturevalue("no_pictures")
    text = page.read_text(encoding="utf-8")
    snippets = SNIPPET.findall(text)
    # a page on an example includes the file itself
    assert snippets or "literalinclude} ../../examples/" in text, f"{page.name} shows no code"
    for name, source in RECORDS.items():
        if name in text:
            shutil.copy(record_path(source), tmp_path / name)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for language, snippet, expected in snippets:
        capsys.readouterr()
        if language == "toml":
            named = FILE.match(snippet)
            if named:
                Path(named[1]).write_text(snippet, encoding="utf-8")
            continue
        if language == "console":
            run_console(snippet, capsys, monkeypatch)
            continue
        exec(snippet, names)  # noqa: S102
        if expected:
            assert lines(capsys.readouterr().out) == lines(expected)


def lines(text):
    return [line.rstrip() for line in text.strip().splitlines()]
