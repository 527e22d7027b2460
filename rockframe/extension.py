"""Names for user-defined components and equations: declarations, supports, laws, columns.

A user-defined base needs a class derived from :class:`OwnBase`, a :class:`Support` that defines
how it carries a body, and a contact law at a point, :func:`point_law`. A user-defined scene needs
a class derived from :class:`OwnScene` and a :class:`System`: a named tuple of numbers with the
methods of :class:`~rockframe.dynamics.protocol.Equations`, in a :class:`ContactModel`.
:func:`rockframe.register` registers either.
"""

from typing import TYPE_CHECKING

from rockframe.compiled import Vector, inlined, kernel
from rockframe.components import Choice, Component, OneOf, Parameter, Ratio, Text
from rockframe.components.parameters import DampingRatio
from rockframe.dynamics.base import Base, BaseForce, EndEvent
from rockframe.dynamics.base_numbers import BaseNumbers, pads_over, springs_under
from rockframe.dynamics.bed import Bed
from rockframe.dynamics.body import BaseLine, Body
from rockframe.dynamics.events import SILENT, ContactState, EventKind
from rockframe.dynamics.links import LinkEvent, LinkNumbers, Stretch, link_law
from rockframe.dynamics.pads import Pads
from rockframe.dynamics.point_law import FREE, Point, point_law
from rockframe.dynamics.protocol import (
    BODY_COLUMNS,
    IMPACT_LOSS,
    IMPULSIVE_INPUT,
    LAST_EVENT,
    MEMORY,
    Column,
    ContactModel,
    Energies,
    Ground,
    Guards,
    Start,
)
from rockframe.dynamics.protocol import Equations as System
from rockframe.results.diagnostics import Diagnostic
from rockframe.results.variables.variable import EVENT, TIME, Variable
from rockframe.suggestions import public_names
from rockframe.system.bodies import BaseLoad
from rockframe.system.links import OwnLink
from rockframe.system.own_base import OwnBase
from rockframe.system.own_scene import OwnScene
from rockframe.system.setting import Words
from rockframe.system.statics import Statics
from rockframe.system.support import (
    BaseWords,
    BedSupport,
    PadSupport,
    Support,
    bed_under,
    pads_under,
)
from rockframe.units import NOT_NEGATIVE, POSITIVE, UNIT_INTERVAL, Measure, Unit

__all__ = [
    "BODY_COLUMNS",
    "EVENT",
    "FREE",
    "IMPACT_LOSS",
    "IMPULSIVE_INPUT",
    "LAST_EVENT",
    "MEMORY",
    "NOT_NEGATIVE",
    "POSITIVE",
    "SILENT",
    "TIME",
    "UNIT_INTERVAL",
    "Base",
    "BaseForce",
    "BaseLine",
    "BaseLoad",
    "BaseNumbers",
    "BaseWords",
    "Bed",
    "BedSupport",
    "Body",
    "Choice",
    "Column",
    "Component",
    "ContactModel",
    "ContactState",
    "DampingRatio",
    "Diagnostic",
    "EndEvent",
    "Energies",
    "EventKind",
    "Ground",
    "Guards",
    "LinkEvent",
    "LinkNumbers",
    "Measure",
    "OneOf",
    "OwnBase",
    "OwnLink",
    "OwnScene",
    "PadSupport",
    "Pads",
    "Parameter",
    "Point",
    "Ratio",
    "Start",
    "Statics",
    "Stretch",
    "Support",
    "System",
    "Text",
    "Unit",
    "Variable",
    "Vector",
    "Words",
    "bed_under",
    "inlined",
    "kernel",
    "link_law",
    "pads_over",
    "pads_under",
    "point_law",
    "springs_under",
]

if not TYPE_CHECKING:  # otherwise type checkers would accept any name
    __getattr__, __dir__ = public_names(__name__, __all__)
