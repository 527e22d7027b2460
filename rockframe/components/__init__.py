"""Components of a scene: frozen value objects, units converted once at construction."""

from rockframe.components.base import Component as Component
from rockframe.components.base import component_from_dict as component_from_dict
from rockframe.components.block import Block as Block
from rockframe.components.cap import CushionCap as CushionCap
from rockframe.components.frame import FrameEquivalent as FrameEquivalent
from rockframe.components.frame_members import Member as Member
from rockframe.components.frame_regular import RegularFrame as RegularFrame
from rockframe.components.ground import RigidGround as RigidGround
from rockframe.components.initial_state import InitialState as InitialState
from rockframe.components.pads import TwoSpringSupport as TwoSpringSupport
from rockframe.components.soil import Separation as Separation
from rockframe.components.soil import WinklerSoil as WinklerSoil
