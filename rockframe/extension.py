"""What a file with a part of your own needs: declarations, supports, laws, and columns.

A base of your own is a class derived from :class:`OwnBase`, a :class:`Support` that says how
it carries a body, and a law of a point, :func:`point_law`. :func:`rockframe.register`
makes it known.
"""

from rockframe.compiled import Vector, inlined, kernel
from rockframe.components import Choice, Component, OneOf, Parameter, Ratio, Text
from rockframe.components.damping import DampingRatio
from rockframe.dynamics.base import Base, BaseForce, EndEvent, Guards
from rockframe.dynamics.base_numbers import BaseNumbers, pads_over, springs_under
from rockframe.dynamics.bed import Bed
from rockframe.dynamics.body import BaseLine, Body
from rockframe.dynamics.events import SILENT, EventKind
from rockframe.dynamics.pads import Pads
from rockframe.dynamics.point_law import FREE, Point, point_law
from rockframe.dynamics.protocol import Column
from rockframe.results.variables.variable import TIME, Variable
from rockframe.system.load import Load
from rockframe.system.own_base import OwnBase
from rockframe.system.pads import PadSupport, pads_under
from rockframe.system.soil import BedSupport, bed_under
from rockframe.system.support import BaseWords, Support
from rockframe.units import NOT_NEGATIVE, POSITIVE, UNIT_INTERVAL, Measure, Unit

__all__ = [
    "FREE",
    "NOT_NEGATIVE",
    "POSITIVE",
    "SILENT",
    "TIME",
    "UNIT_INTERVAL",
    "Base",
    "BaseForce",
    "BaseLine",
    "BaseNumbers",
    "BaseWords",
    "Bed",
    "BedSupport",
    "Body",
    "Choice",
    "Column",
    "Component",
    "DampingRatio",
    "EndEvent",
    "EventKind",
    "Guards",
    "Load",
    "Measure",
    "OneOf",
    "OwnBase",
    "PadSupport",
    "Pads",
    "Parameter",
    "Point",
    "Ratio",
    "Support",
    "Text",
    "Unit",
    "Variable",
    "Vector",
    "bed_under",
    "inlined",
    "kernel",
    "pads_over",
    "pads_under",
    "point_law",
    "springs_under",
]


def __dir__() -> list[str]:
    return __all__
