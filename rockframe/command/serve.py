"""``rockframe serve``: a page on this machine, on which a scene can be tried."""

import argparse
import webbrowser
from pathlib import Path
from typing import Any

from rockframe.command.answer import Answer
from rockframe.command.shared import motion_from, reading_options, refuse_reading_options
from rockframe.command.streams import STREAM, print_message
from rockframe.errors import FileError
from rockframe.serve import Server
from rockframe.serve.controls import NamedRecord


def execute_serve(arguments: argparse.Namespace, answer: Answer) -> int:
    """Serve the page until Ctrl-C."""
    if arguments.record is None:
        refuse_reading_options(arguments, "name one, too")
    record = None if arguments.record is None else _record(arguments)
    with Server(arguments.port, record) as server:
        words = f"the page is at {server.address}, for this machine alone; Ctrl-C ends it"
        print_message("rockframe serve", words, "label")
        if arguments.browse:
            webbrowser.open(server.address)
        server.serve_forever()
    answer.add_result("Page", "ended")
    return 0


def _record(arguments: argparse.Namespace) -> NamedRecord:
    if arguments.record == STREAM:
        words = "a scene's file names its record; give a file in the place of '-'"
        raise FileError(STREAM, words)
    keys: dict[str, Any] = {"file": str(Path(arguments.record).expanduser().resolve())}
    keys |= reading_options(arguments)
    return NamedRecord(motion_from(arguments.record, arguments), keys)
