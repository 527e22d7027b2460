"""Commands as pages show them, carried out in this process."""

import io
import re
import shlex
import sys
from pathlib import Path

from rockframe.command.main import main

PROMPT = "$ "
LEFT_OUT = "..."


def type_in(console, capsys, monkeypatch):
    """Carry out the commands of a console, and compare what they write with what it shows.

    A line of three dots stands for any lines; what no line shows is not compared.
    """
    for shown in console.removeprefix(PROMPT).split(f"\n{PROMPT}"):
        command, *expected = shown.strip("\n").splitlines()
        *before, command = re.split(r" \| ", command)
        for earlier in before:
            main(shlex.split(earlier)[1:])
            handed = capsys.readouterr().out.encode()
            monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(handed)))
        words = shlex.split(command)
        target = None
        if ">" in words:
            place = words.index(">")
            target, words = words[place + 1], words[:place]
        assert words.pop(0) == "rockframe"
        main(words)
        told = capsys.readouterr()
        if target is not None:
            Path(target).write_text(told.out, encoding="utf-8")
        elif expected:
            compare(expected, (told.out + told.err).splitlines(), command)


def compare(expected, found, command):
    """Compare lines, of which three dots stand for any."""
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
