"""Tables and texts that are read from the code when the manual is built.

``{code-table} <name>`` and ``{code-text} <name>``; ``.. module-map::`` of all modules.
"""

import ast
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

import rockframe as rf
from rockframe.command.files.templates import all_keys_template
from rockframe.dynamics.events import ContactState, EventKind
from rockframe.motion import formats
from rockframe.plot._checks import KINDS
from rockframe.results.variables.analyses import (
    CLOUD,
    DYNAMIC_ANALYSIS,
    ENSEMBLE,
    FRACTILES,
    FRAGILITY,
    HAZARD,
    MEASURE_COMPARISON,
    OVERTURNING_MAP,
    PROBABILITY,
    SEQUENCES,
    SPECTRA,
    SUBSETS,
    FragilityStatus,
)
from rockframe.results.variables.requests import (
    ACCELERATIONS,
    FORCE_SCALARS,
    IMPULSES,
    OTHERS,
    POINT_PEAKS,
    POINTS,
    REACTIONS,
    SLIPS,
)
from rockframe.results.variables.runs import (
    CERTIFICATE,
    ENERGY_HISTORIES,
    EVENTS_AND_SCALARS,
    HELD,
    HISTORIES,
    MODES,
    PROOF,
    REST,
    Direction,
    RunStatus,
)
from rockframe.results.variables.studies import (
    COMPARISON,
    CRITICAL_SCALE,
    FREE_DECAY,
    SWEEP,
    FitStatus,
    Outcome,
)
from rockframe.results.variables.variable import EVENT, Variable
from rockframe.solve.accuracy import LEVELS
from rockframe.system.assembly import scenes
from rockframe.system.options import Restraint, Rotation
from rockframe.units import Unit

Rows = Iterable[tuple[str, ...]]

_PARTS = {
    "block": rf.Block(width="1 m", height="4 m", mass="10 t"),
    "pads": rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),
    "cap": rf.CushionCap(height="0.5 m", mass="5 t"),
    "soil": rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2),
}
_PARTS["wall"] = rf.RearWall(side="left")
_PARTS["frame"] = rf.RockingFrame(_PARTS["block"], columns=2, beam_mass="20 t")
_PARTS["restrainer"] = rf.Restrainer(on=("-0.5 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="2 MN/m")
_PARTS["stack"] = rf.Stack(_PARTS["block"], _PARTS["block"], interfaces=[_PARTS["pads"]])


def _variables(rows: Iterable[Variable], dims: tuple[str, ...] | None = None) -> Rows:
    yield "name", "unit", "type", "meaning"
    for row in rows:
        if dims is None or row.dims == dims:
            unit = "flag" if row.flags else "" if row.unit is None else str(row.unit)
            yield row.name, unit, row.dtype, row.long_name


def _flags(kind: type) -> Rows:
    yield "value", "meaning"
    yield from ((str(int(member)), member.name.lower()) for member in sorted(kind))


def _scenes() -> Rows:
    yield "parts", "model"
    for scene in scenes():
        coupling = {} if scene.coupling is None else {"coupling": scene.coupling}
        given = _PARTS
        if "frame" in scene.signature:
            given = given | {"restrainer": rf.Tendon(stiffness="2 MN/m")}
        system = rf.System(*(given[slot] for slot in scene.signature), **coupling)
        yield scene.title, system.setting.model


def _options(kind: type) -> Rows:
    yield (kind.__name__.lower(),)
    yield from ((str(option),) for option in kind)


def _accuracy() -> Rows:
    yield "level", "substeps", "rtol", "floor", "steps_per_period"
    for name, level in LEVELS.items():
        tolerance = (f"{level.rtol:g}", f"{level.floor:g}") if level.rtol else ("", "")
        yield str(name), str(level.substeps or ""), *tolerance, f"{level.steps_per_period:g}"


def _units() -> Rows:
    yield "in results", "quantity"
    words = (name.replace("_", " ").lower() for name in Unit.__members__)
    yield from zip(map(str, Unit), words, strict=True)


def _figures() -> Rows:
    yield "of rf.plot", "draws", "which is given by"
    yield from ((name, kind.name, kind.call) for name, kind in KINDS.items())


def _formats() -> Rows:
    yield "name", "files", "usual endings", "components in a file", "unit of the samples"
    for one in formats():
        yield one.name, one.title, " ".join(one.suffixes), one.holds, one.unit


TABLES: dict[str, Callable[[], Rows]] = {
    "free-decay": lambda: _variables(FREE_DECAY),
    "fit-statuses": lambda: _flags(FitStatus),
    "histories": lambda: _variables(HISTORIES),
    "energies": lambda: _variables(ENERGY_HISTORIES),
    "accelerations": lambda: _variables(ACCELERATIONS),
    "reactions": lambda: _variables(REACTIONS),
    "others": lambda: _variables(OTHERS),
    "impulses": lambda: _variables(IMPULSES),
    "points": lambda: _variables((*POINTS, *POINT_PEAKS)),
    "force-scalars": lambda: _variables(FORCE_SCALARS),
    "slips": lambda: _variables(SLIPS),
    "events": lambda: _variables(EVENTS_AND_SCALARS, EVENT),
    "scalars": lambda: _variables(EVENTS_AND_SCALARS, ()),
    "certificate": lambda: _variables((*CERTIFICATE, *PROOF)),
    "comparison": lambda: _variables(COMPARISON),
    "critical-scale": lambda: _variables(CRITICAL_SCALE),
    "sweep": lambda: _variables(SWEEP),
    "dynamic-analysis": lambda: _variables(DYNAMIC_ANALYSIS),
    "fractiles": lambda: _variables(FRACTILES),
    "cloud": lambda: _variables(CLOUD),
    "measure-comparison": lambda: _variables(MEASURE_COMPARISON),
    "hazard": lambda: _variables(HAZARD),
    "fragility": lambda: _variables(FRAGILITY),
    "fragility-statuses": lambda: _flags(FragilityStatus),
    "overturning-map": lambda: _variables(OVERTURNING_MAP),
    "spectra": lambda: _variables(SPECTRA),
    "probability": lambda: _variables(PROBABILITY),
    "subset-simulation": lambda: _variables(SUBSETS),
    "sequences": lambda: _variables(SEQUENCES),
    "ensemble": lambda: _variables(ENSEMBLE),
    "outcomes": lambda: _flags(Outcome),
    "rest": lambda: _variables(REST),
    "held": lambda: _variables(HELD),
    "modes": lambda: _variables(MODES),
    "contact-states": lambda: _flags(ContactState),
    "event-kinds": lambda: _flags(EventKind),
    "directions": lambda: _flags(Direction),
    "statuses": lambda: _flags(RunStatus),
    "scenes": _scenes,
    "figures": _figures,
    "formats": _formats,
    "restraints": lambda: _options(Restraint),
    "rotations": lambda: _options(Rotation),
    "accuracy": _accuracy,
    "units": _units,
}


TEXTS: dict[str, Callable[[], str]] = {"every-key": all_keys_template}


class CodeTable(SphinxDirective):
    """A table of `TABLES`; the first row is the head, the first column literal."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Build the table."""
        head, *body = TABLES[self.arguments[0]]()
        group = nodes.tgroup(cols=len(head))
        group += [nodes.colspec(colwidth=1) for _ in head]
        group += nodes.thead("", self._row(head, literal=False))
        group += nodes.tbody("", *(self._row(row, literal=True) for row in body))
        return [nodes.table("", group, classes=["colwidths-auto", "align-left"])]

    def _row(self, cells: tuple[str, ...], *, literal: bool) -> nodes.row:
        row = nodes.row()
        for place, text in enumerate(cells):
            words = nodes.literal if literal and place == 0 else nodes.inline
            row += nodes.entry("", nodes.paragraph("", "", words(text, text)))
        return row


class CodeText(SphinxDirective):
    """A text of `TEXTS`, as it is."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Build the block."""
        text = TEXTS[self.arguments[0]]()
        return [nodes.literal_block(text, text, language="toml")]


class ModuleMap(SphinxDirective):
    """All modules, by their folders, with the first lines of their docstrings."""

    def run(self) -> list[nodes.Node]:
        """Build the lists."""
        whole = nodes.container()
        lines = list(self._lines(Path(rf.__file__).parent))
        self.state.nested_parse(StringList(lines, "modules"), self.content_offset, whole)
        return whole.children

    def _lines(self, folder: Path, level: str = "") -> Iterator[str]:
        for path in sorted(folder.iterdir(), key=lambda one: (one.is_dir(), one.name)):
            inner = path / "__init__.py"
            if path.suffix == ".py" and path.name != "__init__.py":
                yield from (f"{level}* ``{path.name}``: {_duty(path)}", "")
            elif inner.is_file():
                yield from (f"{level}* ``{path.name}/``: {_duty(inner)}", "")
                yield from self._lines(path, f"{level}  ")


def _duty(path: Path) -> str:
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return text.splitlines()[0]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directives."""
    app.add_directive("code-table", CodeTable)
    app.add_directive("code-text", CodeText)
    app.add_directive("module-map", ModuleMap)
    return {"parallel_read_safe": True}
