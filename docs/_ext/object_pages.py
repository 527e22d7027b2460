"""A page for each public object, which autosummary writes from the lists of ``reference/index.md``.

Of a package all names are listed by the option ``:every:``, so that they are written there alone.

Docstrings and signatures are shown as people read and write them: defaults by their words, units
with raised exponents, and no member that is Python's own. The pages stand in no table of contents:
these some hundred names in the navigation of every page would take most of the time of a build.
"""

import re
from collections import Counter, namedtuple
from collections.abc import Callable
from importlib import import_module
from itertools import chain
from pathlib import Path
from types import BuiltinFunctionType, FunctionType, MethodDescriptorType
from typing import Any

from docutils import nodes
from docutils.parsers.rst import directives
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.ext.autosummary import Autosummary, autosummary_toc
from sphinx.ext.autosummary.generate import find_autosummary_in_files, generate_autosummary_docs

_FIELD = type(namedtuple("Pair", "field").field)
_INNER = {"assembly", "scene", "setting"}  # of a System, for the package
_EVERY = re.compile(r"^ +:every: (\w+)$", re.MULTILINE)
_UNIT = re.compile(r"\[[^\[\]`'\"]*\^-?\d[^\[\]`'\"]*\]")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def renew_pages(app: Sphinx) -> None:
    """Write pages of packages, and remove those of what is listed no more: Sphinx would warn."""
    _navigation.clear()
    index = Path(app.srcdir) / "reference" / "index.md"
    generated = index.parent / "generated"
    generated.mkdir(exist_ok=True)
    every = generated / "every.txt"
    names = map(_names_of, _EVERY.findall(index.read_text(encoding="utf-8")))
    lines = [f"   rockframe.{name}" for name in chain.from_iterable(names)]
    every.write_text("\n".join([".. autosummary::", "   :toctree: .", "", *lines]))
    generate_autosummary_docs([str(every)], app=app)
    renamed = app.config.autosummary_filename_map
    listed = {one.name for one in find_autosummary_in_files([str(index), str(every)])}
    files = {f"{renamed.get(name, name)}.rst" for name in listed}
    for path in generated.glob("*.rst"):
        if path.name not in files:
            path.unlink()


def _names_of(package: str) -> list[str]:
    return [f"{package}.{name}" for name in import_module(f"rockframe.{package}").__all__]


class ObjectList(Autosummary):
    """A list of objects, whose pages it leaves out of the table of contents."""

    option_spec = Autosummary.option_spec | {"every": directives.unchanged}

    def run(self) -> list[nodes.Node]:
        """Build the table."""
        if "every" in self.options:
            self.content = StringList(_names_of(self.options["every"]), "")
        return [one for one in super().run() if not isinstance(one, autosummary_toc)]


_navigation: dict[str, str] = {}


def share_navigation(
    app: Sphinx, pagename: str, templatename: str, context: dict[str, Any], doctree: object
) -> None:
    """Have the navigation of the first page of an object for all of them, as it is the same."""
    if pagename.startswith("reference/generated/") and "toctree" in context:
        whole: Callable[..., str] = context["toctree"]

        def once(**settings: object) -> str:
            key = repr(settings)
            if key not in _navigation:
                _navigation[key] = whole(**settings)
            return _navigation[key]

        context["toctree"] = once


_MOST_PAGES = 6
_CODE = re.compile(r"^```\{?(?:python|code-block)[^\n]*\n(.*?)^```", re.DOTALL | re.MULTILINE)
_USED = re.compile(r"\brf\.(\w+(?:\.\w+)?)")
_pages: dict[str, list[str]] = {}


def find_uses(app: Sphinx) -> None:
    """Find, for each name of the package, the pages of the manual whose code has it."""
    found: dict[str, Counter[str]] = {}
    manual, gallery = Path(app.srcdir), Path(app.srcdir).parent / "examples" / "gallery"
    codes = {
        f"/{folder}/{file.stem}": "\n".join(_CODE.findall(file.read_text(encoding="utf-8")))
        for folder in ("guide", "recipes")
        for file in (manual / folder).glob("*.md")
    }
    shared = re.compile(app.config.sphinx_gallery_conf["ignore_pattern"])
    for file in gallery.glob("*/*.py"):
        if shared.search(file.name):  # which has no page
            continue
        codes[f"/gallery/{file.parent.name}/{file.stem}"] = file.read_text(encoding="utf-8")
    for page, code in codes.items():
        for used in _USED.findall(code):
            first, _, second = used.partition(".")
            for name in {first, used if second else first}:
                found.setdefault(f"rockframe.{name}", Counter())[page] += 1
    _pages.clear()
    for name, counts in found.items():
        most = sorted(counts, key=lambda page: (-counts[page], page))[:_MOST_PAGES]
        _pages[name] = sorted(most, key=lambda page: (page.startswith("/gallery"), page))


def list_uses(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """List the pages that use what has a page of its own."""
    if isinstance(obj, type | FunctionType) and name in _pages:
        lines += ["", ".. rubric:: Pages that use it", ""]
        lines += [*(f"* :doc:`{page}`" for page in _pages[name]), ""]


def write_as_read(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """Raise exponents of units; keep |x| an absolute value, which would be a substitution."""
    for number, line in enumerate(lines):
        line = re.sub(r"\|(\w[\w ]*)\|", r"\\|\1\\|", line)
        if not line.lstrip().startswith((">>>", "...")):
            line = _UNIT.sub(lambda found: _raised(found[0]), line)
        lines[number] = line


def _raised(unit: str) -> str:
    return re.sub(r"\^(-?\d+)", lambda found: found[1].translate(_RAISED), unit)


def write_defaults(
    app: Sphinx, what: str, name: str, obj: object, options: object, signature: str | None,
    returned: str | None,
) -> tuple[str | None, str | None]:  # fmt: skip
    """Write defaults that are one of a few words by these, as users do."""
    if signature is not None:
        signature = re.sub(r"<\w+\.\w+: ('[^']*')>", r"\1", signature)
        signature = re.sub(
            r"(?<==)[A-Z]\w+\.([A-Z_]+)\b",
            lambda found: repr(found[1].lower().replace("_", "-")),
            signature,
        )
    return signature, returned


def skip_foreign(
    app: Sphinx, what: str, name: str, obj: object, skip: bool, options: object
) -> bool | None:
    """Leave out fields of named tuples, which signatures name, and what Python's classes have."""
    if isinstance(obj, _FIELD | MethodDescriptorType | BuiltinFunctionType) or name in _INNER:
        return True
    function = getattr(obj, "fget", obj)
    home = getattr(getattr(function, "__func__", function), "__module__", None)
    return True if isinstance(home, str) and not home.startswith("rockframe") else None


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the hooks; pages are renewed before autosummary writes the others."""
    app.connect("builder-inited", renew_pages, priority=50)
    app.add_directive("autosummary", ObjectList, override=True)
    app.connect("html-page-context", share_navigation, priority=400)
    app.connect("builder-inited", find_uses)
    app.connect("autodoc-process-docstring", write_as_read)
    app.connect("autodoc-process-docstring", list_uses)
    app.connect("autodoc-process-signature", write_defaults)
    app.connect("autodoc-skip-member", skip_foreign)
    return {"parallel_read_safe": True}
