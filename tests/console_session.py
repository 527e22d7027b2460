"""Runs console commands of pages in this process."""

import io
import re
import shlex
import sys
from pathlib import Path

from rockframe.command.main import main

PROMPT = "$ "
LEFT_OUT = "..."


def run_console(console, capsys, monkeypatch):
    """Run the commands of a console, and compare their output with the output shown.

    A line of three dots stands for any lines; a command without output shown is not compared.
    """
    for shown in console.removeprefix(PROMPT).split(f"\n{PROMPT}"):
        command, *expected = shown.strip("\n").splitlines()
        *before, command = re.split(r" \| ", command)
        for earlier in before:
            main(shlex.split(earlier)[1:])
            piped = capsys.readouterr().out.encode()
            monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(piped)))
        words = shlex.split(command)
        target = None
        if ">" in words:
            place = words.index(">")
            target, words = words[place + 1], words[:place]
        assert words.pop(0) == "rockframe"
        main(words)
        written = capsys.readouterr()
        if target is not None:
            Path(target).write_text(written.out, encoding="utf-8")
        elif expected:
            compare(expected, (written.out + written.err).splitlines(), command)


def compare(expected, found, command):
    """Compare lines; three dots stand for any lines."""
    found = [line.rstrip() for line in found]
    place = 0
    skipping = False
    for line in expected:
        if line.strip() == LEFT_OUT:
            skipping = True
            continue
        rest = found[place:]
        assert line.rstrip() in (rest if skipping else rest[:1]), (command, line, found)
        place += rest.index(line.rstrip()) + 1
        skipping = False
    assert skipping or place == len(found), (command, found[place:])
