"""The component of a ground motion that is looked at."""

from enum import StrEnum

from rockframe.errors import ComponentError, shown
from rockframe.motion import GroundMotion
from rockframe.shaking.shaking import Shaking
from rockframe.words import choice


class GroundComponent(StrEnum):
    """Which acceleration of a motion is looked at."""

    HORIZONTAL = "horizontal"
    VERTICAL = "vertical"


def shaking_of(motion: object, component: object, *, owner: str) -> Shaking:
    """Take one component of a motion.

    Parameters
    ----------
    motion : GroundMotion
        The motion.
    component : {"horizontal", "vertical"}
        Which acceleration.
    owner : str
        Function, for the message.

    Returns
    -------
    Shaking

    Raises
    ------
    ComponentError
        Not a motion, not a component, or the motion lacks it.
    """
    if not isinstance(motion, GroundMotion):
        msg = f"{owner}: motion needs a GroundMotion, got {shown(motion)}"
        raise ComponentError(msg)
    si = motion.si
    if component_of(component, owner=owner) is GroundComponent.HORIZONTAL:
        return Shaking.of(si.time_step, si.acceleration, si.pieces)
    if si.vertical is None:
        msg = f"{owner}: component='vertical', but {motion.name!r} has no vertical acceleration"
        raise ComponentError(msg)
    return Shaking.of(si.time_step, si.vertical, si.vertical_pieces)


def component_of(given: object, *, owner: str) -> GroundComponent:
    """Read the argument `component`.

    Parameters
    ----------
    given : {"horizontal", "vertical"}
        What the user gave.
    owner : str
        Function, for the message.

    Returns
    -------
    GroundComponent

    Raises
    ------
    ComponentError
        None of the two.
    """
    return choice(GroundComponent, given, owner=owner, name="component")
