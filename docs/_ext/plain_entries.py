"""Functions that Python calls and that run as machine code, documented as they are written."""

import sys
from importlib import import_module
from pkgutil import walk_packages

from sphinx.application import Sphinx

import rockframe
from rockframe.compiled.entries import Entry


def show_sources(app: Sphinx) -> None:
    """Put plain functions in the place of compiled ones, when all figures have been drawn."""
    for found in walk_packages(rockframe.__path__, "rockframe."):
        if "__main__" not in found.name:
            import_module(found.name)
    for name, module in list(sys.modules.items()):
        if name.startswith("rockframe."):
            for attribute, value in list(vars(module).items()):
                if isinstance(value, Entry):
                    setattr(module, attribute, value.__wrapped__)


def setup(app: Sphinx) -> dict[str, bool]:
    """Do so after the gallery, before the pages are read."""
    app.connect("builder-inited", show_sources, priority=900)
    return {"parallel_read_safe": True}
