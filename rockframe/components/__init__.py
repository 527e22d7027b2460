"""Components of a scene: immutable value objects, whose units are converted at construction."""

from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.bases import (
    CushionCap,
    RigidGround,
    Separation,
    TwoSpringSupport,
    WinklerSoil,
)
from rockframe.components.block import Block
from rockframe.components.frame import FrameEquivalent
from rockframe.components.frame_members import Member
from rockframe.components.frame_regular import RegularFrame
from rockframe.components.initial_state import InitialState
from rockframe.components.link import Link, Load, PointLink, RearWall, Restrainer, Tendon
from rockframe.components.parameters import DERIVED, Choice, Parameter, Ratio, Text
from rockframe.components.registry import component_from_dict
from rockframe.components.rocking_frame import RockingFrame
from rockframe.components.stack import Stack

__all__ = [
    "DERIVED",
    "Block",
    "Choice",
    "Component",
    "CushionCap",
    "FrameEquivalent",
    "InitialState",
    "Link",
    "Load",
    "Member",
    "OneOf",
    "Parameter",
    "PointLink",
    "Ratio",
    "RearWall",
    "RegularFrame",
    "Restrainer",
    "RigidGround",
    "RockingFrame",
    "Separation",
    "Stack",
    "Tendon",
    "Text",
    "TwoSpringSupport",
    "WinklerSoil",
    "component_from_dict",
]


def __dir__() -> list[str]:
    return __all__
