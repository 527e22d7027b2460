"""A block on pads, on a bed or on rigid ground as a file that runs OpenSees for comparison."""

import math
import pprint
from enum import StrEnum
from importlib import resources
from os import PathLike
from pathlib import Path
from textwrap import fill, indent
from typing import Any, Final, NamedTuple, cast

import numpy as np

from rockframe.arguments import checked_choice, checked_integer
from rockframe.components import Block, FrameEquivalent, RigidGround, TwoSpringSupport, WinklerSoil
from rockframe.errors import ComponentError, short_repr
from rockframe.motion import GroundMotion
from rockframe.motion.display import display_name
from rockframe.simulation.system import System
from rockframe.suggestions import with_hints
from rockframe.system.options import Restraint, Rotation
from rockframe.units import QuantityLike
from rockframe.version import __version__
from rockframe.writing import FileKind, checked_path, write_file

_OWNER: Final = "to_opensees"
_SIGNATURE: Final = "Written by rockframe "
_FILE_KIND: Final = FileKind.marked("a model for OpenSees", (".py",), _SIGNATURE)
_MODEL_FILE: Final = "_opensees_model.py"
_OUTPUT_STEP: Final = 0.01
_STEPS_PER_PERIOD: Final = 80
"""Steps in a period of the block bouncing on its springs; a quarter for rigid ground."""
_BAR_STIFFNESS_RATIO: Final = 1e5
_TOLERANCE: Final = 1e-9
_RIGID_GROUND_RATIOS: Final = (400.0, 0.7)
"""Frequency ratio and damping ratio of the springs that model rigid ground."""


class Dashpots(StrEnum):
    """Whether dashpots act while contact is lost."""

    LET_GO = "let go"
    ATTACHED = "attached"


class SpringsOfBase(NamedTuple):
    """The springs that model a base in OpenSees."""

    places: list[float]  # along the base [m]
    stiffness: float  # of one spring [N/m]
    damping: float  # of one dashpot [N s/m]
    note: str  # the model, and differences to expect


@with_hints()
def to_opensees(
    system: System,
    motion: GroundMotion,
    path: str | PathLike[str],
    *,
    free_vibration: QuantityLike | None = None,
    springs: int = 40,
    dashpots: str = Dashpots.LET_GO,
    overwrite: bool = False,
) -> Path:
    """Write a block and a motion as a Python file for OpenSees, with the result of rockframe.

    The file needs only numpy and openseespy. It builds the block on springs without tension, runs
    it, writes both histories of the rotation to a CSV file next to it, and prints both peaks. Its
    docstring states which laws differ, and by how much results then differ.

    Parameters
    ----------
    system : System
        A block on pads, on a bed of soil or on rigid ground, without eccentricity.
    motion : GroundMotion
        The motion, with its vertical component if it has one.
    path : str or Path
        The file; its name ends in ``.py``.
    free_vibration : str or Quantity, optional
        Time after the motion, as for :meth:`rockframe.System.simulate` [s].
    springs : int, optional
        Number of springs that model a bed of soil.
    dashpots : {"let go", "attached"}, optional
        Whether dashpots act only during contact, as in rockframe (``ViscoelasticGap``), or remain
        attached, as a ``Viscous`` parallel to an ``ENT`` does in many models.
    overwrite : bool, optional
        Whether to replace an existing file that this function did not write.

    Returns
    -------
    Path

    Raises
    ------
    ComponentError
        Not a system or a motion, parts or options without a counterpart in OpenSees, or another
        argument that cannot be read.
    FileError
        The name has another ending, or the file cannot be written or is not replaced.

    Notes
    -----
    The middle of the base is fixed horizontally, as by ``restraint="centre"``.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockframe as rf
    >>> pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"), pads)
    >>> pulse = rf.GroundMotion.sine_pulse("1.6 m/s^2", "1 Hz")
    >>> rf.export.to_opensees(system, pulse, Path(tempfile.mkdtemp()) / "model.py").name
    'model.py'
    """
    for value, kind in ((system, System), (motion, GroundMotion)):
        if not isinstance(cast("object", value), kind):
            msg = f"{_OWNER} needs a {kind.__name__}, got {short_repr(value)}"
            raise ComponentError(msg)
    _check_supported(system)
    spring_count = checked_integer(springs, owner=_OWNER, name="springs", lowest=2)
    dashpot_behaviour = checked_choice(Dashpots, dashpots, owner=_OWNER, name="dashpots")
    checked_path(path, _FILE_KIND, overwrite=overwrite)
    base = _base_springs(system, spring_count)
    run = system.simulate(
        motion, free_vibration=free_vibration, output_step=f"{_OUTPUT_STEP} s", outputs=()
    )
    body = system.setting.body
    # a run that overturns ends between two outputs; its last rotation is left out
    on_output_step = np.isclose(
        run["time"] / _OUTPUT_STEP, np.arange(run.sizes["time"]), rtol=0.0, atol=1e-6
    )
    period = 2.0 * math.pi / math.sqrt(len(base.places) * base.stiffness / body.mass)
    rigid = not system.setting.supports
    steps = _OUTPUT_STEP * (_STEPS_PER_PERIOD // (1 + 3 * rigid)) / period
    values = {
        "half_width": body.half_width,
        "centre_height": body.centre_height,
        "mass": body.mass,
        "inertia": body.inertia,
        "gravity": system.setting.gravity,
        "springs_at": base.places,
        "stiffness": base.stiffness,
        "damping": base.damping,
        "dashpots": dashpot_behaviour.value,
        "bars_over_springs": _BAR_STIFFNESS_RATIO,
        "tolerance": _TOLERANCE,
        "output_step": _OUTPUT_STEP,
        "outputs": run.sizes["time"],
        "steps_per_output": max(2, math.ceil(steps)),
        "overturning_angle": float(run["overturning_angle"]),
        "verdict": str(run.attrs["verdict"]),
        "peak": float(run["peak_rotation"]),
        "time_step": motion.si.time_step,
    }
    arrays = {
        "acceleration": (motion.si.horizontal.samples, 17),
        "vertical_acceleration": (
            None if motion.si.vertical is None else motion.si.vertical.samples,
            17,
        ),
        "rotation": (run["rotation"].to_numpy()[on_output_step], 9),
    }
    text = _file_text(_docstring(system, motion, base, dashpot_behaviour), values, arrays)
    return write_file(path, _FILE_KIND, text, overwrite=overwrite)


def _check_supported(system: System) -> None:
    """Raise on parts and options without a counterpart in the model of OpenSees."""
    others = [part for part in system.parts.structural() if type(part) not in _SUPPORTED_PARTS]
    faults = [f"a {type(part).__name__}" for part in others]
    if not faults:
        setting = system.setting
        faults += ["a centre of mass off the middle"] if setting.body.eccentricity else []
        faults += ["sloping ground"] if system.options.inclination else []
        faults += ["a base that slides"] if setting.slides else []
        faults += ["rotation='small'"] if system.rotation is Rotation.SMALL else []
    if faults:
        msg = (
            f"{_OWNER}: expected a block on pads, on a bed of soil or on rigid ground, found "
            f"{', '.join(faults)}, for which the model of OpenSees has no counterpart"
        )
        raise ComponentError(msg)


_SUPPORTED_PARTS: Final = (Block, FrameEquivalent, TwoSpringSupport, WinklerSoil, RigidGround)


def _base_springs(system: System, count: int) -> SpringsOfBase:
    """Return the springs that model the base."""
    setting: Any = system.setting
    body = setting.body
    corners = [-body.half_width, body.half_width]
    if system.parts.soil is not None:
        share = 2.0 * body.half_width / count
        places = [(k + 0.5) * share - body.half_width for k in range(count)]
        return SpringsOfBase(
            places, share * setting.support.stiffness, share * setting.support.damping,
            f"The bed is {count} springs. {_SOIL_NOTE}",
        )  # fmt: skip
    if system.parts.pads is not None:
        return SpringsOfBase(
            corners, setting.support.stiffness, setting.support.damping, _PADS_NOTE
        )
    ratio, damping_ratio = _RIGID_GROUND_RATIOS
    radius = math.hypot(body.half_width, body.centre_height)
    inertia = body.inertia + body.mass * (body.half_width**2 + body.centre_height**2)
    frequency = ratio * math.sqrt(body.mass * setting.gravity * radius / inertia)
    return SpringsOfBase(
        corners, 0.5 * body.mass * frequency**2, damping_ratio * body.mass * frequency, _GROUND_NOTE
    )


_SOIL_NOTE: Final = (
    "If dashpots let go, they do so as with separation='displacement' in rockframe, and both "
    "programs solve the same equations: in tests with restraint='centre' peaks differed by 0.2 % "
    "and histories by 1 % of the peak."
)
_PADS_NOTE: Final = (
    "A pad of rockframe lets go when its force, dashpot included, falls to zero, and its corner "
    "lands with a coefficient of restitution; OpenSees has neither. In tests in which dashpots let "
    "go, peaks differed by 0.3 % at most, and histories after many impacts by 25 % of the peak. "
    "Without damping, with restitution=1 and restraint='centre', both solve the same equations, "
    "and peaks under a pulse differed by 0.003 %."
)
_GROUND_NOTE: Final = (
    "OpenSees has no law of impacts: rigid ground is modelled by two stiff pads whose dashpots "
    "almost stop a corner that lands. The energy lost in an impact depends on them, and each "
    "impact adds an error: expect a few per cent of the peak under pulses, and a third of it after "
    "many impacts, when verdicts may differ. This is not a check of either program."
)
_ATTACHED_NOTE: Final = (
    "Dashpots remain attached to a base that lifts, and pull it down: expect peaks that are "
    "smaller by 5 to 20 % than those of rockframe, whose dashpots let go."
)
_RESTRAINT_NOTE: Final = (
    "OpenSees fixes the middle of the base horizontally; the system has restraint={!r}, which "
    "fixes the base at other points. Write System(..., restraint='centre') for the same in both."
)


def _docstring(
    system: System, motion: GroundMotion, base: SpringsOfBase, dashpots: Dashpots
) -> str:
    """Return the docstring of the file."""
    elsewhere = base.note is not _GROUND_NOTE and system.restraint is not Restraint.CENTRE
    name = display_name(motion.name, motion.history)
    rows = [
        f"{_SIGNATURE}{__version__}: {system.setting.model} under {name}, in OpenSees.",
        "Run it with numpy and openseespy installed. It writes both histories of the rotation "
        "to a CSV file of the same name, and prints both peaks.",
        base.note,
        _ATTACHED_NOTE if dashpots is Dashpots.ATTACHED and base.damping > 0.0 else "",
        _RESTRAINT_NOTE.format(str(system.restraint)) if elsewhere else "",
        "Steps of integration are fixed, and events within them are not located. After many "
        "impacts two runs that were close at first may differ: compare peaks before histories.",
    ]
    lines = "\n\n".join(fill(row, 96) for row in rows if row)
    return lines.replace("\\", "/").replace('"""', "'''")


def _file_text(head: str, arguments: dict[str, Any], arrays: dict[str, Any]) -> str:
    model = resources.files("rockframe.export").joinpath(_MODEL_FILE).read_text(encoding="utf-8")
    body = model.split('"""\n', 1)[1]
    numbers = pprint.pformat(arguments, width=95, sort_dicts=False)
    columns = "".join(
        f"PARAMETERS[{name!r}] = {_array_text(values, digits)}\n"
        for name, (values, digits) in arrays.items()
    )
    return (
        f'"""{head}\n"""\n{body}\n\nPARAMETERS: dict[str, Any] = {numbers}\n'
        f"# at every {arguments['time_step']:g} s, and at every "
        f"{arguments['output_step']:g} s\n{columns}\n"
        'if __name__ == "__main__":\n'
        '    compare_peaks(PARAMETERS, Path(__file__).with_suffix(".csv"))\n'
    )


def _array_text(values: np.ndarray | None, digits: int) -> str:
    if values is None:
        return "None"
    words = [f"{value:.{digits}g}" for value in values]
    lines = fill(", ".join(words), 95, break_on_hyphens=False)
    return f"np.array(\n    [\n{indent(lines, ' ' * 8)}\n    ], float\n)"
