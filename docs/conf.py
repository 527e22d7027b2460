"""Settings of the manual: ``python -m sphinx -W --keep-going -b html docs docs/_build/html``."""

import os
import re
import sys
from collections import namedtuple
from pathlib import Path

from rockframe.version import __version__

# The kernels are documented as the plain Python that they are written in.
os.environ["ROCKFRAME_COMPILE"] = "0"
sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "rockframe"
author = "The rockframe developers"
project_copyright = author
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "numpydoc",
    "code_tables",
    "figures",
]
exclude_patterns = ["_build", "_ext"]
html_theme = "furo"
html_title = f"rockframe {release}"

myst_enable_extensions = ["amsmath", "deflist", "dollarmath"]
myst_heading_anchors = 3

numfig = True  # equations are numbered by page: 2.3 is the third of page 2
math_numfig = True
math_eqref_format = "equation {number}"

autodoc_typehints = "none"
autodoc_member_order = "bysource"
numpydoc_show_class_members = False


_FIELD = type(namedtuple("Pair", "field").field)


def _keep_bars(app, what, name, obj, options, lines):
    """Keep |x| in docstrings an absolute value: reStructuredText would substitute it."""
    lines[:] = [re.sub(r"\|(\w[\w ]*)\|", r"\\|\1\\|", line) for line in lines]


def _leave_out_fields(app, what, name, obj, skip, options):
    """Leave out the fields of named tuples: the class's signature names them."""
    return True if isinstance(obj, _FIELD) else None


def setup(app):
    """Register the hooks."""
    app.connect("autodoc-process-docstring", _keep_bars)
    app.connect("autodoc-skip-member", _leave_out_fields)
