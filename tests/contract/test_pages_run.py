"""The snippets of every page of the guide, and of the README, run as they stand.

A block of text right after a snippet is what the snippet prints.
"""

import re
import shutil
from pathlib import Path

import pytest
from records import record_path

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    ROOT / "README.md",
    ROOT / "docs" / "index.md",
    *sorted((ROOT / "docs/guide").glob("*.md")),
]
SNIPPET = re.compile(r"```python\n(.*?)```(?:\n+```text\n(.*?)```)?", re.DOTALL)
RECORDS = {"record.AT2": "NIS090.AT2", "TCU128-N.AT2": "PEERSMD_CHICHI_TCU128-N.AT2"}


@pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_snippets_run_from_first_to_last(page, tmp_path, monkeypatch, capsys):
    text = page.read_text(encoding="utf-8")
    snippets = SNIPPET.findall(text)
    # a page on an example shows the file itself, which runs as it stands
    assert snippets or "literalinclude} ../../examples/" in text, f"{page.name} shows no code"
    for name, source in RECORDS.items():
        if name in text:
            shutil.copy(record_path(source), tmp_path / name)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for snippet, shown in snippets:
        capsys.readouterr()
        exec(snippet, names)  # noqa: S102
        if shown:
            assert lines(capsys.readouterr().out) == lines(shown)


def lines(text):
    return [line.rstrip() for line in text.strip().splitlines()]
