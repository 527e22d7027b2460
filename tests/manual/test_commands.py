"""The commands of the manual and of the README are tested before each change."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

from pages import DOCS

ROOT = DOCS.parent
TRIED = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"```sh\n(.*?)```", re.DOTALL)
ASK_THE_NETWORK = ("pip download", "pip wheel", "pip install --no-index")
SETTING_UP = ("python3 -m venv .venv", "pip install")


def commands():
    """Return all commands of shell blocks, with their page."""
    for page in [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]:
        for block in BLOCK.findall(page.read_text(encoding="utf-8")):
            for line in block.splitlines():
                for command in line.split(" && "):
                    yield page.name, command.strip().replace(".venv/bin/", "")


def spoken(command):
    """Return program and first words of a command, without options."""
    return [word for word in shlex.split(command) if not word.startswith("-")]


def test_every_command_is_tried():
    """By .ci/run, which reads those of the README from there, or by these tests."""
    tried = f"{TRIED}\n{README}".replace(".venv/bin/", "")
    all_commands = list(commands())
    assert len(all_commands) > 10
    for page, command in all_commands:
        if command.startswith(("python -c", *ASK_THE_NETWORK, *SETTING_UP)):
            continue
        program, *words = spoken(command)
        module = re.search(r"-m (\w+)", command)
        name = program if program != "python" else module[1] if module else words[0]
        assert re.search(rf"(?<!\w){re.escape(name)}(?!\w)", tried), f"{page}: {command}"


def test_short_programs_run():
    lines = [command for _, command in commands() if command.startswith("python -c")]
    assert lines
    for line in lines:
        program = shlex.split(line)[2]
        done = subprocess.run(
            [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT
        )
        assert done.stdout.strip()


def test_documented_extras_exist():
    declared = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    table = declared.split("[project.optional-dependencies]")[1].split("\n[tool")[0]
    extras = set(re.findall(r"^(\w+) = \[", table, re.MULTILINE))
    for page, command in commands():
        for group in re.findall(r"\[([\w,]+)\]", command):
            assert set(group.split(",")) <= extras, f"{page}: {command}"


def test_cited_version_is_current():
    import rockframe

    for name in ("data/citation.cff", "development/citing.md", "development/changelog.md"):
        text = Path(DOCS / name).read_text(encoding="utf-8")
        assert rockframe.__version__ in text, name
