"""Components of a scene: frozen value objects, units converted once at construction."""

from rockframe.components.base import Component as Component
from rockframe.components.base import component_from_dict as component_from_dict
from rockframe.components.block import Block as Block
from rockframe.components.ground import RigidGround as RigidGround
from rockframe.components.initial_state import InitialState as InitialState
from rockframe.components.pads import TwoSpringSupport as TwoSpringSupport
