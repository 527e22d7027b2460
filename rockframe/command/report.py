"""``rockframe report``: a page on a run."""

import argparse
from pathlib import Path

from rockframe.command.given import check_folder, opened
from rockframe.reports import report


def execute(arguments: argparse.Namespace) -> int:
    """Write the page."""
    path = arguments.output or str(Path(arguments.dataset).with_suffix(".html"))
    check_folder(path)
    dataset = opened(arguments.dataset)
    report(dataset, path, title=arguments.title, certify=not arguments.no_certificate)
    print(f"Report: {path}")
    return 0
