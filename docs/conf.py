"""Settings of the manual: ``python -m sphinx -W --keep-going -b html docs docs/_build/html``."""

import sys
from pathlib import Path

from rockframe.version import __version__

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "rockframe"
author = "The rockframe developers"
project_copyright = author
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # its files and fonts, copied into the site
    "numpydoc",
    "sphinx_design",  # cards of the first page
    "sphinx_gallery.gen_gallery",
    "code_tables",
    "figures",
    "object_pages",
    "plain_entries",
]
templates_path = ["_templates"]  # of the pages of objects
exclude_patterns = ["_build", "_ext", "_templates"]
html_theme = "furo"
html_title = f"rockframe {release}"
html_static_path = ["_static"]
html_css_files = ["manual.css"]
html_js_files = ["equations.js"]

myst_enable_extensions = ["amsmath", "deflist", "dollarmath"]
myst_heading_anchors = 3

numfig = True  # equations are numbered by page: 2.3 is the third of page 2
math_numfig = True
math_eqref_format = "equation {number}"

sphinx_gallery_conf = {
    "examples_dirs": "../examples/gallery",
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "ignore_pattern": r"^(parametric_study|worked_example|free_response|shaken)\.py$",  # shared
    "subsection_order": [
        f"../examples/gallery/{name}"
        for name in ("first", "paper", "mechanics", "motions", "studies", "structures")
    ],
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "capture_repr": ("_repr_html_",),
    "download_all_examples": False,
    "matplotlib_animations": (True, "jshtml"),
    "min_reported_time": 60,
    "remove_config_comments": True,
    "reset_modules": ("matplotlib", "figures.raise_warnings"),
    "reset_modules_order": "both",
    "show_memory": False,
    "write_computation_times": False,
}

autodoc_typehints = "none"
autodoc_member_order = "bysource"
autosummary_filename_map = {
    # names that differ by their case alone are one file on some systems
    f"rockframe.plot.{name}": f"rockframe.plot.{name}_class"
    for name in ("Animation", "Player")
}
numpydoc_show_class_members = False
