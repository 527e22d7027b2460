"""Rocking blocks and frames on rigid ground, viscoelastic pads and soil.

Assemble components into a :class:`System`, simulate it under a
:class:`GroundMotion`, and get a labelled :class:`xarray.Dataset` that netCDF
can hold.
"""

import os
import sys
from importlib import import_module
from itertools import pairwise
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rockframe import errors as errors
    from rockframe import extension as extension
    from rockframe import plot as plot
    from rockframe.comparison import Recommendation as Recommendation
    from rockframe.comparison import model_ladder as model_ladder
    from rockframe.comparison import recommend as recommend
    from rockframe.comparison import tradeoff as tradeoff
    from rockframe.components import Block as Block
    from rockframe.components import CushionCap as CushionCap
    from rockframe.components import FrameEquivalent as FrameEquivalent
    from rockframe.components import InitialState as InitialState
    from rockframe.components import Member as Member
    from rockframe.components import RegularFrame as RegularFrame
    from rockframe.components import Restrainer as Restrainer
    from rockframe.components import RigidGround as RigidGround
    from rockframe.components import RockingFrame as RockingFrame
    from rockframe.components import Stack as Stack
    from rockframe.components import TwoSpringSupport as TwoSpringSupport
    from rockframe.components import WinklerSoil as WinklerSoil
    from rockframe.errors import AssemblyError as AssemblyError
    from rockframe.errors import ComponentError as ComponentError
    from rockframe.errors import FileError as FileError
    from rockframe.errors import ModelWarning as ModelWarning
    from rockframe.errors import RecordError as RecordError
    from rockframe.errors import RecordWarning as RecordWarning
    from rockframe.errors import RockframeError as RockframeError
    from rockframe.errors import RockframeWarning as RockframeWarning
    from rockframe.errors import SchemaError as SchemaError
    from rockframe.errors import SolverError as SolverError
    from rockframe.errors import SolverWarning as SolverWarning
    from rockframe.errors import StudyError as StudyError
    from rockframe.errors import UnitsError as UnitsError
    from rockframe.identification import fit_free_decay as fit_free_decay
    from rockframe.measures import (
        average_spectral_acceleration as average_spectral_acceleration,
    )
    from rockframe.measures import fourier_spectrum as fourier_spectrum
    from rockframe.measures import intensity_measures as intensity_measures
    from rockframe.measures import principal_axes as principal_axes
    from rockframe.measures import response_spectrum as response_spectrum
    from rockframe.measures import rotated_spectrum as rotated_spectrum
    from rockframe.measures import velocity_and_displacement as velocity_and_displacement
    from rockframe.motion import GroundMotion as GroundMotion
    from rockframe.motion import HorizontalPair as HorizontalPair
    from rockframe.reports import report as report
    from rockframe.results.diagnostics import Diagnostic as Diagnostic
    from rockframe.results.joining import concat as concat
    from rockframe.results.table import table as table
    from rockframe.simulation.registration import register as register
    from rockframe.simulation.run_arguments import Certification as Certification
    from rockframe.simulation.system import System as System
    from rockframe.solve.accuracy import Accuracy as Accuracy
    from rockframe.studies import Case as Case
    from rockframe.studies import case as case
    from rockframe.studies import critical_scale as critical_scale
    from rockframe.studies import earthquake_sequences as earthquake_sequences
    from rockframe.studies import ensemble_statistics as ensemble_statistics
    from rockframe.studies import fragility as fragility
    from rockframe.studies import fragility_of_counts as fragility_of_counts
    from rockframe.studies import incremental_dynamic_analysis as incremental_dynamic_analysis
    from rockframe.studies import open_study as open_study
    from rockframe.studies import overturning_map as overturning_map
    from rockframe.studies import overturning_spectrum as overturning_spectrum
    from rockframe.studies import probability_of_overturning as probability_of_overturning
    from rockframe.studies import rocking_spectrum as rocking_spectrum
    from rockframe.studies import sweep as sweep
    from rockframe.studies import to_openquake as to_openquake
    from rockframe.studies import to_pelicun as to_pelicun
    from rockframe.suites import MotionSuite as MotionSuite
    from rockframe.suites import TargetSpectrum as TargetSpectrum
    from rockframe.suites import read_suite as read_suite
    from rockframe.suites import scale_to_target as scale_to_target
    from rockframe.suites import select_for_target as select_for_target
    from rockframe.version import __version__ as __version__


def _is_command_line() -> bool:
    """Whether this process is the command line, by its name or as ``python -m rockframe``."""
    program = "".join(sys.argv[:1])
    if program == "-m":  # what Python is to run is still looked for
        return ("-m", __name__) in pairwise(sys.orig_argv)
    return os.path.basename(program) in (__name__, f"{__name__}.exe")


# Every scene needs these two. They are most of what has to be loaded: here, so that the
# first simulation does not wait for them. The help of the command line needs neither.
if not _is_command_line():
    for _library in ("pint", "xarray"):
        import_module(_library)
    import_module(f"{__name__}.accessor")  # so that every dataset has it

_HOMES = {
    "rockframe.components": (
        "Block",
        "CushionCap",
        "FrameEquivalent",
        "InitialState",
        "Member",
        "RegularFrame",
        "Restrainer",
        "RigidGround",
        "RockingFrame",
        "Stack",
        "TwoSpringSupport",
        "WinklerSoil",
    ),
    "rockframe.errors": (
        "AssemblyError",
        "ComponentError",
        "FileError",
        "ModelWarning",
        "RecordError",
        "RecordWarning",
        "RockframeError",
        "RockframeWarning",
        "SchemaError",
        "SolverError",
        "SolverWarning",
        "StudyError",
        "UnitsError",
    ),
    "rockframe.comparison": ("Recommendation", "model_ladder", "recommend", "tradeoff"),
    "rockframe.identification": ("fit_free_decay",),
    "rockframe.measures": (
        "average_spectral_acceleration",
        "fourier_spectrum",
        "intensity_measures",
        "principal_axes",
        "response_spectrum",
        "rotated_spectrum",
        "velocity_and_displacement",
    ),
    "rockframe.motion": ("GroundMotion", "HorizontalPair"),
    "rockframe.reports": ("report",),
    "rockframe.results.diagnostics": ("Diagnostic",),
    "rockframe.results.joining": ("concat",),
    "rockframe.results.table": ("table",),
    "rockframe.simulation.run_arguments": ("Certification",),
    "rockframe.simulation.registration": ("register",),
    "rockframe.simulation.system": ("System",),
    "rockframe.solve.accuracy": ("Accuracy",),
    "rockframe.studies": (
        "Case",
        "case",
        "critical_scale",
        "earthquake_sequences",
        "ensemble_statistics",
        "fragility",
        "fragility_of_counts",
        "incremental_dynamic_analysis",
        "open_study",
        "overturning_map",
        "overturning_spectrum",
        "probability_of_overturning",
        "rocking_spectrum",
        "sweep",
        "to_openquake",
        "to_pelicun",
    ),
    "rockframe.suites": (
        "MotionSuite",
        "TargetSpectrum",
        "read_suite",
        "scale_to_target",
        "select_for_target",
    ),
    "rockframe.version": ("__version__",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "Accuracy",
    "AssemblyError",
    "Block",
    "Case",
    "Certification",
    "ComponentError",
    "CushionCap",
    "Diagnostic",
    "FileError",
    "FrameEquivalent",
    "GroundMotion",
    "HorizontalPair",
    "InitialState",
    "Member",
    "ModelWarning",
    "MotionSuite",
    "Recommendation",
    "RecordError",
    "RecordWarning",
    "RegularFrame",
    "Restrainer",
    "RigidGround",
    "RockframeError",
    "RockframeWarning",
    "SchemaError",
    "SolverError",
    "SolverWarning",
    "StudyError",
    "System",
    "TargetSpectrum",
    "TwoSpringSupport",
    "UnitsError",
    "WinklerSoil",
    "__version__",
    "average_spectral_acceleration",
    "case",
    "concat",
    "critical_scale",
    "earthquake_sequences",
    "ensemble_statistics",
    "errors",
    "extension",
    "fit_free_decay",
    "fourier_spectrum",
    "fragility",
    "fragility_of_counts",
    "incremental_dynamic_analysis",
    "intensity_measures",
    "model_ladder",
    "open_study",
    "overturning_map",
    "overturning_spectrum",
    "plot",
    "principal_axes",
    "probability_of_overturning",
    "read_suite",
    "recommend",
    "register",
    "report",
    "response_spectrum",
    "rocking_spectrum",
    "rotated_spectrum",
    "scale_to_target",
    "select_for_target",
    "sweep",
    "table",
    "to_openquake",
    "to_pelicun",
    "tradeoff",
    "velocity_and_displacement",
]


def __getattr__(name: str) -> Any:
    # The rest is imported on its first use: a script that only reads records
    # never waits for the integrator. A program of the same name as the command line
    # gets here too, and its datasets are to have the accessor like all others.
    if name in _HOME_OF:
        import_module(f"{__name__}.accessor")
        value = getattr(import_module(_HOME_OF[name]), name)
    elif name in ("errors", "extension", "plot"):
        value = import_module(f"{__name__}.{name}")
    else:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
